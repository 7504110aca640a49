"""Steps to the capacity by each method, as a ground acceleration and as a return period."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from rocking_cli.codes.italian import formulas as F
from rocking_cli.codes.italian.demand import DAMPING, DemandSpectrum, FloorSpectrum, GroundSpectrum
from rocking_cli.codes.italian.ground import SiteGround
from rocking_cli.codes.italian.results import ItalianMethod, ItalianVerified
from rocking_cli.codes.italian.rules import DAMAGE, FIRST, LINEAR, NONLINEAR, OF_STATE, RULES, Rule
from rocking_cli.codes.italian.sheet import spectra
from rocking_cli.codes.italian.sheet.site import hazard_at, is_close
from rocking_cli.codes.italian.sheet.states import LINE
from rocking_cli.studies.verification.working import Formula, Working
from rocking_cli.views.sheet.document import Item, Sentence, SheetPart, Steps
from rocking_cli.views.sheet.language import Language

STATE = {key: state for state, pair in OF_STATE.items() for key in pair} | {LINEAR: FIRST, "SLD": "SLD"}
RULE = {OF_STATE[rule.state][1]: rule for rule in RULES}


TITLES = {
    DAMAGE: "Onset of rocking at {state}", "SLD": "Onset of rocking at {state}",
    NONLINEAR: "Nonlinear method at {state}", LINEAR: "Linear method: behaviour factor q",
}  # fmt: skip


def title(say: Language, key: str) -> str:
    """Return the name of a method."""
    return say(TITLES[_kind(key)], state=STATE[key])


def _kind(key: str) -> str:
    return key.removesuffix(f"_{STATE[key]}")


@dataclass(frozen=True)
class MethodComparison:
    """The capacity and the demand that a method compares.

    Parameters
    ----------
    state : str
        Limit state whose ground gives the demand.
    name, capacity : str, float
        Symbol and value of the capacity.
    demand : str
        The demand of the ground, in symbols.
    at : At or None
        The period of the displacement demand; None if the demand is an acceleration.
    """

    state: str
    name: str
    capacity: float
    demand: str
    at: spectra.At | None = None


@dataclass(frozen=True)
class Methods:
    """The methods of a direction, written in a language."""

    say: Language
    ground: SiteGround
    found: ItalianVerified

    def parts(self, key: str) -> Iterator[SheetPart]:
        """Yield a part for each method whose limit state the site gives."""
        for name, method in self.found.methods.items():
            if method.a_g is None:
                continue
            if name == "linear":
                heading = self.say("linear_at", state=self.ground.state_of_activation)
                yield SheetPart(f"{key}-{name}", heading, list(self._linear(method)))
                continue
            heading = title(self.say, name)
            yield SheetPart(
                f"{key}-{name}", heading, list(self._items(name, method, self._asked(name, "", line=False)))
            )
            if name in RULE:
                line = self.found.straight_methods[name]
                asked = self._asked(name, f",{LINE}", line=True)
                items = list(self._items(name, line, asked, f",{LINE}"))
                yield SheetPart(f"{key}-{name}-line", f"{heading}, {self.say('on the straight line')}", items)

    def _asked(self, name: str, more: str, *, line: bool) -> MethodComparison:
        if name in RULE:
            rule: Rule = RULE[name]
            s, states = rule.state, self.found.straight_states if line else self.found.states
            at = spectra.At(f"T_[{s}{more}]", states[s].T, rule.damping)
            return MethodComparison(s, f"d_[{s}]", states[s].d, f"S_[De](T_[{s}{more}])", at)
        return self._activation(STATE[name])

    def _activation(self, state: str) -> MethodComparison:
        """Return capacity and demand of the onset of rocking, under the ground of a limit state."""
        return MethodComparison(state, "a_[0]^[*]", self.found.a0, self._peak())

    def _peak(self) -> str:
        on_floor = self.ground.site.floor is not None
        if self.ground.site.own_period is not None:
            return "S_[eZ](T_[0])" if on_floor else "S_[e](T_[0])"
        return "S_[Z]" if on_floor else "a_[g] S"

    def _demand(self, spectrum: DemandSpectrum, asked: MethodComparison) -> float:
        if asked.at is not None:
            return spectrum.displacement(asked.at.T, asked.at.damping)
        T0 = self.ground.site.own_period
        return spectrum.peak if T0 is None else spectrum.acceleration(T0, DAMPING)

    def _items(self, name: str, method: ItalianMethod, asked: MethodComparison, more: str = "") -> Iterator[Item]:
        """Yield the capacity a_g, its check, zeta_E, and the return period."""
        spectrum = self.ground.spectrum(asked.state)
        assert spectrum is not None and method.a_g is not None  # its state is given
        symbol = f"a_[g,{_kind(name)}{more}]"
        names = {"symbol": symbol, "state": asked.state, "asked": "a_[g]", "more": more}
        yield from self._solved(F.CAPACITY, names, spectrum, asked, method.a_g, method.clause)
        yield Steps([self._zeta(method, names)])
        yield from self._lasts(method, asked, more)

    def _zeta(self, method: ItalianMethod, names: Mapping[str, str]) -> Working:
        return self.say.step(F.ZETA, method.zeta or 0.0, names, a=method.a_g, b=method.demand)

    def _solved(
        self, formula: Formula, names: Mapping[str, str], spectrum: DemandSpectrum, asked: MethodComparison,
        a_g: float, clause: str,
    ) -> Iterator[Item]:  # fmt: skip
        """Yield the a_g at which a demand equals a capacity, and its check if it was found by iteration."""
        say, own, found = self.say, self._demand(spectrum, asked), {**names, "capacity": asked.name}
        if is_close(a_g, spectrum.ag * asked.capacity / own):
            under = f"({asked.demand})" if " " in asked.demand else asked.demand
            numbers = {"ag": spectrum.ag, "c": asked.capacity, "d": own}
            yield Steps([say.step(replace(formula, clause=clause), a_g, {**found, "demand": under}, **numbers)])
            return
        by_iteration = replace(F.CAPACITY_FOUND, clause=clause, meaning=f"{formula.meaning}_iterated")
        yield Steps([say.step(by_iteration, a_g, {**found, "demand": asked.demand})])
        yield Sentence(say("check", state=asked.state))
        yield Steps(list(self._checked(spectrum.with_ag(a_g), asked)))

    def _linear(self, method: ItalianMethod) -> Iterator[Item]:
        """Yield q times the a_g at which rocking starts at SLD, and its zeta_E and return period at SLV."""
        say, ground, q = self.say, self.ground, self.ground.site.q
        assert method.a_g is not None  # SLV is always given
        asked = self._activation(ground.state_of_activation)
        if ground.of_activation != ground.spectrum(asked.state):  # the ground of SLV under the mode of SLD
            yield Sentence(say("T_[1] and ξ_[1] are here those of SLD."))
            yield Steps(list(self._checked(ground.of_activation, asked)))
        start, damage = method.a_g / q, self.found.methods["damage"]
        names = {"symbol": "a_[g,0]", "state": asked.state}
        yield from self._solved(F.START, names, ground.of_activation, asked, start, damage.clause)
        by_code = F.LINEAR if asked.state == "SLD" else replace(F.LINEAR, standing="ours")
        linear = say.step(by_code, method.a_g, q=q, a=start)
        names = {"symbol": "a_[g,linear]", "asked": "a_[g,SLV]", "state": "SLV", "more": ""}
        yield Steps([linear, self._zeta(method, names)])
        yield from self._lasts(method, MethodComparison("SLV", "a_[g,linear]", method.a_g, "a_[g]"), "")

    def _checked(self, spectrum: DemandSpectrum, asked: MethodComparison) -> Iterator[Working]:
        """Yield the steps to the demand for the a_g or TR found by iteration, as a check against the capacity."""
        say = self.say
        ground = spectrum.ground if isinstance(spectrum, FloorSpectrum) else spectrum
        if asked.at is None or isinstance(spectrum, FloorSpectrum):
            yield from spectra.peaks(say, spectrum, asked.state)
        elif isinstance(ground, GroundSpectrum):
            yield from list(spectra.peaks(say, ground, asked.state))[:2]
        if asked.at is not None:
            yield from spectra.displacement(say, spectrum, asked.at)
        elif self.ground.site.own_period is not None:
            yield from spectra.at_own_period(say, spectrum, self.ground.site.own_period, DAMPING)

    def _lasts(self, method: ItalianMethod, asked: MethodComparison, more: str) -> Iterator[Item]:
        """Yield the capacity as a return period, and its check."""
        say, TR, hazard = self.say, method.return_period, self.ground.hazard
        if TR is None or hazard is None:
            return
        if method.beyond:
            yield Sentence(say("beyond_long" if (method.zeta or 0) >= 1 else "beyond_short", TR=say.number(TR)))
            return
        yield Steps([say.step(F.LASTS, TR, {"more": more, "demand": asked.demand, "capacity": asked.name})])
        yield Sentence(say("Check, with the ground of this return period:"))
        spectrum = self.ground.at_return_period(TR, asked.state)
        rows = list(hazard_at(say, hazard, TR))
        by_ground = asked.demand == "a_[g]"  # r and a_g say it all
        yield Steps(rows[:2] if by_ground else [*rows, *self._checked(spectrum, asked)])

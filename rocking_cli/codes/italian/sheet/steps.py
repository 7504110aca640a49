"""The steps of a verification in each direction: in a language for the sheet, in plain characters for `workings`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from rocking_cli.codes.italian import formulas as F
from rocking_cli.codes.italian.capacity import ExactCurve, StraightCurve
from rocking_cli.codes.italian.demand import REFERENCE_DAMPING, DemandSpectrum, FloorSpectrum, GroundSpectrum
from rocking_cli.codes.italian.displaced import DisplacedChain, pulls
from rocking_cli.codes.italian.ground import SiteGround
from rocking_cli.codes.italian.results import ItalianMethod, ItalianVerified, LimitState
from rocking_cli.codes.italian.rules import DAMAGE, FIRST_STATE, LINEAR, NONLINEAR, OF_STATE, RULES, Rule
from rocking_cli.codes.italian.sheet import chain as chains
from rocking_cli.codes.italian.sheet import site, spectra
from rocking_cli.codes.italian.sheet.chain import Scale
from rocking_cli.codes.italian.sheet.site import hazard_at, is_close
from rocking_cli.core.hung.attached import Spot
from rocking_cli.verification.results import Formula, Working
from rocking_cli.views.sheet.document import Item, Sentence, SheetPart, Steps, workings
from rocking_cli.views.sheet.language import Language, texts_of
from rocking_cli.views.view import Table

LINE_SUBSCRIPT = "lin"  # subscript of quantities on the straight line
ENGLISH = Language("en", texts_of("rocking_cli.codes.italian", "en"))
TERMINAL = replace(ENGLISH, is_plain=True)
STATE_OF_METHOD = {key: state for state, pair in OF_STATE.items() for key in pair} | {LINEAR: FIRST_STATE, "SLD": "SLD"}
RULE_OF_METHOD = {OF_STATE[rule.state][1]: rule for rule in RULES}
TITLES = {
    DAMAGE: "Onset of rocking at {state}", "SLD": "Onset of rocking at {state}",
    NONLINEAR: "Nonlinear method at {state}", LINEAR: "Linear method: behaviour factor q",
}  # fmt: skip


def title(say: Language, key: str) -> str:
    """Return the name of a method."""
    return say(TITLES[_kind(key)], state=STATE_OF_METHOD[key])


def _kind(key: str) -> str:
    return key.removesuffix(f"_{STATE_OF_METHOD[key]}")


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
class DirectionSteps:
    """The steps of a direction at a site, written in a language."""

    say: Language
    ground: SiteGround
    found: ItalianVerified

    @property
    def curve(self) -> ExactCurve:
        """The exact capacity curve."""
        return self.found.exact

    @property
    def scale(self) -> Scale:
        """Unit of printed weights."""
        return Scale.of(self.curve.chain)

    def parts(self) -> Iterator[SheetPart]:
        """Yield the parts on the chain, the ends of the curve, each limit state and each method."""
        say, key = self.say, self.found.direction.label
        yield chains.part(say, self.curve, key)
        yield SheetPart(f"{key}-curve", say("Capacity curve"), list(self._ends()))
        for rule in RULES:
            items = list(self._state(rule))
            yield SheetPart(f"{key}-{rule.state}", say("{state}, on the exact capacity curve", state=rule.state), items)
            line = list(self._on_line(rule))
            heading = say("{state}, on the straight line", state=rule.state)
            steps: list[Item] = [Sentence(say("line_is")), Steps(line)]
            yield SheetPart(f"{key}-{rule.state}-line", heading, steps)
        yield from self._methods(key)

    def _ends(self) -> Iterator[Item]:
        """Yield the steps to a0* and d0*."""
        say, curve = self.say, self.curve
        a0 = say.step(F.A0, curve.a0, **self._accelerated(curve.chain.alpha0))
        yield Steps([a0, self._control()])
        end = DisplacedChain(curve, curve.end)
        yield Steps([say.step(F.PHI_0, curve.end)])
        yield chains.at_work(say, end, self.scale)
        yield from chains.held(say, end, self.scale)
        rows = list(chains.multiplier(say, end, self.scale, "α(φ_[0])"))
        yield Steps([*rows, *self._moved(end, {"at": "φ_[0]", "symbol": "d_[0]^[*]"}, "d0")])

    def _accelerated(self, alpha: float) -> dict[str, float]:
        """Return values for the slots of the formula of a*, for a multiplier."""
        chain, FC = self.curve.chain, self.curve.confidence
        return {"alpha": alpha, "g": chain.mechanism.gravity, "e": chain.e_star, "FC": FC}

    def _control(self) -> Working:
        """Return the step for x_C' of the control point."""
        say, scale, control = self.say, self.scale, self.curve.control
        chain = self.curve.chain
        dx = chain.sideways(control)
        if control.body is None:
            return say.step(F.X_C, dx, first=scale.weight(chain.first), PQ=scale.weight(chain.inertial))
        names = {"body": control.body, "x": say.number(control.at.real), "y": say.number(control.at.imag)}
        moved = next(each for each in DisplacedChain(self.curve, 0.0).blocks if control.body in each.block.bodies)
        if moved.centre is None:
            return say.step(F.X_C_STRAIGHT, dx, names, x=moved.dx)
        return say.step(F.X_C_TURNS, dx, names, turns=moved.turns, y=control.at.imag, O=scale.near(moved.centre.imag))

    def _moved(self, position: DisplacedChain, names: Mapping[str, str], meaning: str) -> Iterator[Working]:
        """Yield the steps to d_C and d in a position."""
        say, curve, scale = self.say, self.curve, self.scale
        chain, control = curve.chain, curve.control
        d_C, total = chain.displacement_of_control(position.phi, control), scale.weight(chain.inertial)
        if control.body is None:
            weights, ways = (
                [scale.weight(each.block.PQ) for each in position.blocks],
                [scale.near(b.gone) for b in position.blocks],
            )
            yield say.step(F.D_C, d_C, names, P=weights, x=ways, PQ=total)
        else:
            follow = chain.mechanism.followed(np.array([position.phi]), chain.direction)
            x = float(follow(Spot(control.body, control.at)).z[0].real)
            one, other = (x, control.at.real) if chain.direction > 0 else (control.at.real, x)
            yield say.step(F.D_C_POINT, d_C, names, one=scale.near(one), other=scale.near(other))
        first, second = scale.weight(chain.first), scale.weight(chain.second)
        d = curve.displacement_at(position.phi)
        yield say.step(
            replace(F.D, meaning=meaning), d, names, d=d_C, second=second, x=chain.sideways(control), first=first
        )

    def _state(self, rule: Rule) -> Iterator[Item]:
        """Yield the steps of a limit state on the exact curve."""
        say, s, at = self.say, rule.state, self.found.states[rule.state]
        names = {"state": s, "on": s, "at": f"φ_[{s}]", "symbol": f"d(φ_[{s}])"}
        yield Steps([self._allowed(rule, at)])
        broken = rule.at_breaks and self.curve.broken is not None and at.d == self.curve.broken
        phi = self.curve.torn if broken and self.curve.torn is not None else self.curve.rotation(at.d)
        position = DisplacedChain(self.curve, phi)
        yield Steps([say.step(F.PHI, phi, names)])
        yield chains.at_work(say, position, self.scale)
        yield from chains.held(say, position, self.scale)
        yield from ties(say, self.curve, {s: at})
        rows = list(self._moved(position, names, "d_again"))
        rows += chains.multiplier(say, position, self.scale, f"α(φ_[{s}])")
        here = self.curve.acceleration_at(phi)
        rows.append(say.step(F.A_THERE, here, names, **self._accelerated(position.alpha)))
        yield Steps([*rows, *self._period_and_demand(rule, at, s, here)])

    def _allowed(self, rule: Rule, at: LimitState) -> Working:
        """Return the step for the displacement capacity at a limit state."""
        curve = self.curve
        ends = {"t": curve.broken if rule.at_breaks else None, "a": curve.seat.d if curve.seat is not None else None}
        known = {f"d_[{name}]": d for name, d in ends.items() if d is not None}
        names = {"state": rule.state, "share": f"{rule.share:g}", "ends": "; ".join(known)}
        formula = F.ALLOWED_LEAST if known else F.ALLOWED
        return self.say.step(formula, at.d, names, share=rule.share, d0=curve.d0, d=[*known.values()])

    def _period_and_demand(self, rule: Rule, at: LimitState, name: str, a: float) -> Iterator[Working]:
        """Yield the steps for T, S_De and the ratio; `a` is a* of the curve that `name` denotes [m/s2]."""
        say, s, T0 = self.say, rule.state, self.ground.site.own_period
        names = {"state": s, "on": name, "a": f"a^[*]_[{name}]" if T0 is None else f"a_[{name}]"}
        if T0 is not None:
            yield say.step(F.A_ELASTIC, at.a, names, a=a, d=at.d, T0=T0)
        yield say.step(F.PERIOD[s], at.T, names, d=at.d, a=at.a)
        spectrum = self.ground.spectrum(s)
        if spectrum is None or at.demand is None or at.ratio is None:
            return
        yield from spectra.displacement(say, spectrum, spectra.At(f"T_[{name}]", at.T, rule.damping))
        still = self.found.passes(s) and not at.passes and LINE_SUBSCRIPT not in name
        meaning = "passes" if at.passes else "passes_still" if still else "fails"
        yield say.step(replace(F.RHO, meaning=meaning), at.ratio, names, d=at.d, demand=at.demand)

    def _on_line(self, rule: Rule) -> Iterator[Working]:
        """Yield the steps of a limit state on the straight line."""
        s, at, curve = rule.state, self.found.straight_states[rule.state], self.curve
        a, name = StraightCurve(curve.a0, curve.d0).acceleration(at.d), f"{rule.state},{LINE_SUBSCRIPT}"
        yield self.say.step(F.A_LINE, a, {"state": s, "on": name}, a0=curve.a0, d=at.d, d0=curve.d0)
        yield from self._period_and_demand(rule, at, name, a)

    def _methods(self, key: str) -> Iterator[SheetPart]:
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
            if name in RULE_OF_METHOD:
                line = self.found.straight_methods[name]
                comparison = self._asked(name, f",{LINE_SUBSCRIPT}", line=True)
                items = list(self._items(name, line, comparison, f",{LINE_SUBSCRIPT}"))
                yield SheetPart(f"{key}-{name}-line", f"{heading}, {self.say('on the straight line')}", items)

    def _asked(self, name: str, more: str, *, line: bool) -> MethodComparison:
        if name in RULE_OF_METHOD:
            rule: Rule = RULE_OF_METHOD[name]
            s, states = rule.state, self.found.straight_states if line else self.found.states
            at = spectra.At(f"T_[{s}{more}]", states[s].T, rule.damping)
            return MethodComparison(s, f"d_[{s}]", states[s].d, f"S_[De](T_[{s}{more}])", at)
        return self._activation(STATE_OF_METHOD[name])

    def _activation(self, state: str) -> MethodComparison:
        """Return capacity and demand of the onset of rocking, under the ground of a limit state."""
        return MethodComparison(state, "a_[0]^[*]", self.found.a0, self._peak())

    def _peak(self) -> str:
        on_floor = self.ground.site.floor is not None
        if self.ground.site.own_period is not None:
            return "S_[eZ](T_[0])" if on_floor else "S_[e](T_[0])"
        return "S_[Z]" if on_floor else "a_[g] S"

    def _demand(self, spectrum: DemandSpectrum, comparison: MethodComparison) -> float:
        if comparison.at is not None:
            return spectrum.displacement(comparison.at.T, comparison.at.damping)
        T0 = self.ground.site.own_period
        return spectrum.peak if T0 is None else spectrum.acceleration(T0, REFERENCE_DAMPING)

    def _items(self, name: str, method: ItalianMethod, comparison: MethodComparison, more: str = "") -> Iterator[Item]:
        """Yield the capacity a_g, its check, zeta_E, and the return period."""
        spectrum = self.ground.spectrum(comparison.state)
        assert spectrum is not None and method.a_g is not None  # the site gives its limit state
        symbol = f"a_[g,{_kind(name)}{more}]"
        names = {"symbol": symbol, "state": comparison.state, "asked": "a_[g]", "more": more}
        yield from self._solved(F.CAPACITY, names, spectrum, comparison, method.a_g, method.clause)
        yield Steps([self._zeta(method, names)])
        yield from self._lasts(method, comparison, more)

    def _zeta(self, method: ItalianMethod, names: Mapping[str, str]) -> Working:
        return self.say.step(F.ZETA, method.zeta or 0.0, names, a=method.a_g, b=method.demand)

    def _solved(
        self, formula: Formula, names: Mapping[str, str], spectrum: DemandSpectrum, comparison: MethodComparison,
        a_g: float, clause: str,
    ) -> Iterator[Item]:  # fmt: skip
        """Yield the a_g at which a demand equals a capacity, and its check if it was found by iteration."""
        say, demand, symbols = self.say, self._demand(spectrum, comparison), {**names, "capacity": comparison.name}
        if is_close(a_g, spectrum.ag * comparison.capacity / demand):
            under = f"({comparison.demand})" if " " in comparison.demand else comparison.demand
            numbers = {"ag": spectrum.ag, "c": comparison.capacity, "d": demand}
            yield Steps([say.step(replace(formula, clause=clause), a_g, {**symbols, "demand": under}, **numbers)])
            return
        by_iteration = replace(F.CAPACITY_FOUND, clause=clause, meaning=f"{formula.meaning}_iterated")
        yield Steps([say.step(by_iteration, a_g, {**symbols, "demand": comparison.demand})])
        yield Sentence(say("check", state=comparison.state))
        yield Steps(list(self._checked(spectrum.with_ag(a_g), comparison)))

    def _linear(self, method: ItalianMethod) -> Iterator[Item]:
        """Yield q times the a_g at which rocking starts at SLD, and its zeta_E and return period at SLV."""
        say, ground, q = self.say, self.ground, self.ground.site.q
        assert method.a_g is not None  # every site file has SLV
        comparison = self._activation(ground.state_of_activation)
        if ground.of_activation != ground.spectrum(comparison.state):  # the mode of SLD may differ from that of SLV
            yield Sentence(say("T_[1] and ξ_[1] are here those of SLD."))
            yield Steps(list(self._checked(ground.of_activation, comparison)))
        start, damage = method.a_g / q, self.found.methods["damage"]
        names = {"symbol": "a_[g,0]", "state": comparison.state}
        yield from self._solved(F.START, names, ground.of_activation, comparison, start, damage.clause)
        by_code = F.LINEAR if comparison.state == "SLD" else replace(F.LINEAR, standing="ours")
        linear = say.step(by_code, method.a_g, q=q, a=start)
        names = {"symbol": "a_[g,linear]", "asked": "a_[g,SLV]", "state": "SLV", "more": ""}
        yield Steps([linear, self._zeta(method, names)])
        yield from self._lasts(method, MethodComparison("SLV", "a_[g,linear]", method.a_g, "a_[g]"), "")

    def _checked(self, spectrum: DemandSpectrum, comparison: MethodComparison) -> Iterator[Working]:
        """Yield the steps to the demand for the a_g or TR found by iteration, as a check against the capacity."""
        say = self.say
        ground = spectrum.ground if isinstance(spectrum, FloorSpectrum) else spectrum
        if comparison.at is None or isinstance(spectrum, FloorSpectrum):
            yield from spectra.peaks(say, spectrum, comparison.state)
        elif isinstance(ground, GroundSpectrum):
            yield from list(spectra.peaks(say, ground, comparison.state))[:2]
        if comparison.at is not None:
            yield from spectra.displacement(say, spectrum, comparison.at)
        elif self.ground.site.own_period is not None:
            yield from spectra.at_own_period(say, spectrum, self.ground.site.own_period, REFERENCE_DAMPING)

    def _lasts(self, method: ItalianMethod, comparison: MethodComparison, more: str) -> Iterator[Item]:
        """Yield the capacity as a return period, and its check."""
        say, TR, hazard = self.say, method.return_period, self.ground.hazard
        if TR is None or hazard is None:
            return
        if method.beyond:
            yield Sentence(say("beyond_long" if (method.zeta or 0) >= 1 else "beyond_short", TR=say.number(TR)))
            return
        yield Steps([say.step(F.LASTS, TR, {"more": more, "demand": comparison.demand, "capacity": comparison.name})])
        yield Sentence(say("Check, with the ground of this return period:"))
        spectrum = self.ground.at_return_period(TR, comparison.state)
        rows = list(hazard_at(say, hazard, TR))
        by_ground = comparison.demand == "a_[g]"  # the steps for r and a_g suffice
        yield Steps(rows[:2] if by_ground else [*rows, *self._checked(spectrum, comparison)])


def ties(say: Language, curve: ExactCurve, states: Mapping[str, LimitState]) -> list[Table]:
    """Return a table of ties, and of forces against the motion, at limit states; empty if there are none."""
    rows = [
        [pull.name, f"d_[{state}]" if not say.is_plain else f"d_{state}", say.number(pull.force / 1e3),
         say.number(pull.elongation), say.number(None if pull.strain is None else 100 * pull.strain, 3)]
        for state, at in states.items() for pull in pulls(curve, at.d)
    ]  # fmt: skip
    heads = [say("tie"), "", "N [kN]", *map(say, ("ΔL [m]", "ΔL/L [%]"))]
    return [Table(say("ties_at", state=list(states)), heads, rows, (2, 3, 4))] if rows else []


def workings_of_direction(ground: SiteGround, found: ItalianVerified) -> list[Working]:
    """Return the calculation steps of the verification in one direction, as text in plain characters."""
    return list(workings(DirectionSteps(ENGLISH, ground, found).parts()))


def workings_of_site(ground: SiteGround) -> list[Working]:
    """Return the values of the site file and the steps to the ground at each limit state, in plain characters."""
    whole = site.part(ENGLISH, ground)
    rows = [each.in_plain(whole.heading) for each in site.given(ENGLISH, ground)]
    for part in whole.parts:
        state = part.key.removeprefix("site-")
        rows += [replace(each, state=state) for each in workings([part])]
    return rows + [each.in_plain(whole.heading) for each in site.amplifications(ENGLISH, ground)]

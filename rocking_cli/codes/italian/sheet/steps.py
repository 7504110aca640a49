"""Lines of the calculation in each direction, for the templates of the sheet, and in plain characters for views."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np
from markupsafe import Markup

from rocking_cli.codes.italian import formulas as F
from rocking_cli.codes.italian.capacity import BREAK, SEAT, DisplacedChain, ExactCurve, StraightCurve, ends, pulls
from rocking_cli.codes.italian.demand import REFERENCE_DAMPING, DemandSpectrum, FloorSpectrum, GroundSpectrum
from rocking_cli.codes.italian.ground import SiteGround
from rocking_cli.codes.italian.results import ItalianMethod, ItalianVerified, LimitState
from rocking_cli.codes.italian.rules import DAMAGE, LINEAR, NONLINEAR, OF_STATE, RULES, STATE_OF_METHOD, STATES, Rule
from rocking_cli.codes.italian.sheet import chain as chains
from rocking_cli.codes.italian.sheet import site
from rocking_cli.codes.italian.sheet.chain import ChainSteps, Rows
from rocking_cli.codes.italian.sheet.site import hazard_at, is_close
from rocking_cli.core.hung.attached import Spot
from rocking_cli.core.hung.element import INTERLOCK_NAME
from rocking_cli.core.hung.ties import MAX_STRAIN
from rocking_cli.studies.remark import Remark
from rocking_cli.verification.results import Evaluated, Formula, Working
from rocking_cli.views.sheet.document import sections, tables, workings
from rocking_cli.views.sheet.language import Language, as_subscript, texts_of
from rocking_cli.views.view import Table

LINE_SUBSCRIPT = "lin"  # subscript of quantities on the straight line
PACKAGE = "rocking_cli.codes.italian"
ENGLISH = Language("en", texts_of(PACKAGE, "en"))
TERMINAL = replace(ENGLISH, is_plain=True)
OF_END = {BREAK: F.BROKEN, SEAT: F.SEAT}
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


WithCheck = tuple[list[Evaluated], list[Evaluated]]
"""Lines to a result, and those that check it."""


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
    at: site.At | None = None


@dataclass(frozen=True)
class StateSteps:
    """The lines to a limit state on the exact capacity curve, in order, and those on the straight line.

    Parameters
    ----------
    state : str
        The limit state.
    position : DisplacedChain
        The chain where its displacement capacity is reached.
    capacity, multiplier, on_line : sequence of Evaluated
        Lines to that position, those from it to the ratio of capacity to demand, and all on the straight line.
    """

    state: str
    position: DisplacedChain
    capacity: Sequence[Evaluated]
    multiplier: Sequence[Evaluated]
    on_line: Sequence[Evaluated]


@dataclass(frozen=True)
class MethodSteps:
    """The lines to the capacity by a method as a_g and as a return period.

    Parameters
    ----------
    key : str
        Key of the method.
    state : str
        Limit state whose ground gives the demand.
    on_line : bool
        Whether the method is on the straight line.
    damage : sequence of Evaluated
        Lines to the demand at SLD, if its ground differs from that of SLV.
    capacity, check : sequence of Evaluated
        Lines to a_g; those that check it, if it is found by iteration.
    zeta, lasts, lasts_check : sequence of Evaluated
        Lines to zeta_E and to the return period, and those that check the latter; empty without a hazard.
    beyond : str
        "long" or "short" if the return period is outside the hazard.
    return_period : float or None
        The return period [years].
    """

    key: str
    state: str
    on_line: bool
    damage: Sequence[Evaluated]
    capacity: Sequence[Evaluated]
    check: Sequence[Evaluated]
    zeta: Sequence[Evaluated]
    lasts: Sequence[Evaluated]
    lasts_check: Sequence[Evaluated]
    beyond: str
    return_period: float | None

    @property
    def is_nonlinear(self) -> bool:
        """Whether the method compares displacements."""
        return self.key in RULE_OF_METHOD


@dataclass(frozen=True)
class DirectionSteps:
    """The lines of the calculation in a direction at a site, and rows of its tables, for the templates of a sheet.

    Parameters
    ----------
    ground : SiteGround
        The site.
    found : ItalianVerified
        The verification in the direction.
    where : str
        Name of the direction, or of both, in the language of the sheet.
    state : str
        "existing" or "strengthened" if two structures are compared; otherwise empty.
    counts : str
        The limit state whose lines on the exact curve are shown; if empty, all are, on the straight line too.
    """

    ground: SiteGround
    found: ItalianVerified
    where: str = ""
    state: str = ""
    counts: str = ""

    @property
    def key(self) -> str:
        """Key of the sections of the direction."""
        return "-".join(filter(None, (self.state, self.found.direction.label)))

    @property
    def curve(self) -> ExactCurve:
        """The exact capacity curve."""
        return self.found.exact

    @cached_property
    def of_chain(self) -> ChainSteps:
        """Lines and rows of the chain."""
        return ChainSteps(self.curve)

    @cached_property
    def end(self) -> DisplacedChain:
        """The chain where its capacity vanishes."""
        return DisplacedChain(self.curve, self.curve.end)

    @property
    def is_clockwise(self) -> bool:
        """Whether the direction is the positive one."""
        return self.found.direction > 0

    def ties(self, states: Sequence[str]) -> Rows:
        """Return a row for each tie at limit states."""
        return tie_rows(self.curve, {state: self.found.states[state] for state in states})

    @property
    def start(self) -> list[Evaluated]:
        """Lines to a0* and the control point, and the rotation at which the capacity vanishes."""
        a0 = F.A0.line(self.curve.a0, **self._accelerated(self.curve.chain.alpha0))
        return [a0, self._control(), F.PHI_0.line(self.curve.end)]

    @property
    def to_end(self) -> list[Evaluated]:
        """Lines to d0* from the position in which the capacity vanishes."""
        names = {"at": "φ_[0]", "symbol": "d_[0]^[*]"}
        return [*self.of_chain.multiplier(self.end, "(φ_[0])"), *self._moved(self.end, names, "d0")]

    @property
    def states(self) -> list[StateSteps]:
        """The lines to each limit state."""
        return [self._state(rule) for rule in RULES if self.counts in ("", rule.state)]

    @property
    def methods(self) -> list[MethodSteps]:
        """The lines of each method whose limit state the site gives, on the curve and on the straight line."""
        if not self.counts:
            return list(self._methods())
        return [
            each for each in self._methods()
            if STATE_OF_METHOD[each.key] == self.counts and each.key != LINEAR and not each.on_line
        ]  # fmt: skip

    def _accelerated(self, alpha: float) -> dict[str, float]:
        """Return values for the slots of the formula of a*, for a multiplier."""
        chain, FC = self.curve.chain, self.curve.confidence
        return {"alpha": alpha, "g": chain.mechanism.gravity, "e": chain.e_star, "FC": FC}

    def _control(self) -> Evaluated:
        """Return the step for x_C' of the control point."""
        scale, control = self.of_chain.scale, self.curve.control
        chain = self.curve.chain
        dx = chain.sideways(control)
        if control.body is None:
            return F.X_C.line(dx, first=scale.weight(chain.first), PQ=scale.weight(chain.inertial))
        names = {"body": control.body, "x": control.at.real, "y": control.at.imag}
        moved = next(each for each in self.of_chain.rest.blocks if control.body in each.block.bodies)
        if moved.centre is None:
            return F.X_C_STRAIGHT.line(dx, names, x=moved.dx)
        return F.X_C_TURNS.line(dx, names, turns=moved.turns, y=control.at.imag, O=scale.near(moved.centre.imag))

    def _moved(self, position: DisplacedChain, names: Mapping[str, str], meaning: str) -> Iterator[Evaluated]:
        """Yield the steps to d_C and d in a position."""
        curve, scale = self.curve, self.of_chain.scale
        chain, control = curve.chain, curve.control
        d_C, total = float(chain.moved(np.array([position.phi]), control)[0]), scale.weight(chain.inertial)
        if control.body is None:
            weights, ways = (
                [scale.weight(each.block.PQ) for each in position.blocks],
                [scale.near(b.gone) for b in position.blocks],
            )
            yield F.D_C.line(d_C, names, P=weights, x=ways, PQ=total)
        else:
            follow = chain.mechanism.followed(np.array([position.phi]), chain.direction)
            x = float(follow(Spot(control.body, control.at)).z[0].real)
            one, other = (x, control.at.real) if chain.direction > 0 else (control.at.real, x)
            yield F.D_C_POINT.line(d_C, names, one=scale.near(one), other=scale.near(other))
        first, second = scale.weight(chain.first), scale.weight(chain.second)
        d = curve.displacement_at(position.phi)
        to_d = replace(F.D, meaning=meaning)
        yield to_d.line(d, names, d=d_C, second=second, x=chain.sideways(control), first=first)

    def _state(self, rule: Rule) -> StateSteps:
        s, at = rule.state, self.found.states[rule.state]
        names = {"state": s, "on": s, "at": f"φ_[{s}]", "symbol": f"d(φ_[{s}])"}
        phi = self.curve.rotation(at.d)
        position = DisplacedChain(self.curve, phi)
        lines = [*self._moved(position, names, "d_again"), *self.of_chain.multiplier(position, f"(φ_[{s}])")]
        here = self.curve.acceleration_at(phi)
        lines.append(F.A_THERE.line(here, names, **self._accelerated(position.alpha)))
        lines += self._period_and_demand(rule, at, s, here)
        on_line = [] if self.counts else list(self._on_line(rule))
        to_position = [*self._ends(rule), self._allowed(rule, at), F.PHI.line(phi, names)]
        return StateSteps(s, position, to_position, [*self._seat_at(phi, at, s), *lines], on_line)

    def _ends(self, rule: Rule) -> Iterator[Evaluated]:
        """Yield the lines to what may end the displacement capacity besides a share of d0*: a break, or a lost seat."""
        others, seat = ends(self.curve, rule), self.curve.seat
        if (lost := self.curve.last_break) is not None and BREAK in others:
            for tie in [tie for tie in self.curve.chain.mechanism.ties or [] if tie.name == lost.name]:
                known = F.TIE_KNOWN if tie.elongation else replace(F.TIE_KNOWN, meaning="tie_assumed")
                strain, L = tie.elongation or MAX_STRAIN, tie.length or tie.span
                yield known.line(lost.length, {"tie": tie.name}, strain=strain, L=L)
            name = Remark.of(lost.name) if lost.name == INTERLOCK_NAME else lost.name
            yield F.BROKEN.line(others[BREAK], {"name": name, "length": f"{lost.length:.6g}"})
        if seat is not None:
            yield F.SEAT.line(seat.d, {"name": as_subscript(seat.load), "load": seat.load, "length": seat.length})

    def _seat_at(self, phi: float, at: LimitState, state: str) -> Iterator[Evaluated]:
        """Yield the displacement of the load whose seat limits a state, if it does."""
        seat, chain = self.curve.seat, self.curve.chain
        if seat is None or at.by != SEAT:
            return
        spot = next(mass.spot for mass in chain.mechanism.hung.masses if mass.name == seat.load)
        x = [float(chain.mechanism.followed(np.array([each]), chain.direction)(spot).z[0].real) for each in (0.0, phi)]
        low, high = map(self.of_chain.scale.near, sorted(x))
        names = {"name": as_subscript(seat.load), "load": seat.load, "state": state}
        yield F.SEAT_MOVED.line(abs(x[1] - x[0]), names, one=high, other=low)

    def _allowed(self, rule: Rule, at: LimitState) -> Evaluated:
        """Return the step for the displacement capacity at a limit state."""
        others = {OF_END[by].symbol: d for by, d in ends(self.curve, rule).items() if by in OF_END}
        names = {"state": rule.state, "share": f"{rule.share:g}", "ends": "; ".join(others)}
        formula = F.ALLOWED_LEAST if others else F.ALLOWED
        return formula.line(at.d, names, share=rule.share, d0=self.curve.d0, d=[*others.values()])

    def _period_and_demand(self, rule: Rule, at: LimitState, name: str, a: float) -> Iterator[Evaluated]:
        """Yield the steps for T, S_De and the ratio; `a` is a* of the curve that `name` denotes [m/s2]."""
        s, T0 = rule.state, self.ground.site.own_period
        names = {"state": s, "on": name, "a": f"a^[*]_[{name}]" if T0 is None else f"a_[{name}]"}
        if T0 is not None:
            yield F.A_ELASTIC.line(at.a, names, a=a, d=at.d, T0=T0)
        yield F.PERIOD[s].line(at.T, names, d=at.d, a=at.a)
        spectrum = self.ground.spectrum(s)
        if spectrum is None or at.demand is None or at.ratio is None:
            return
        yield from site.displacement(spectrum, site.At(f"T_[{name}]", at.T, rule.damping))
        yield F.RHO.line(at.ratio, names, d=at.d, demand=at.demand)

    def _on_line(self, rule: Rule) -> Iterator[Evaluated]:
        """Yield the steps of a limit state on the straight line."""
        s, at, curve = rule.state, self.found.straight_states[rule.state], self.curve
        a, name = StraightCurve(curve.a0, curve.d0).acceleration(at.d), f"{rule.state},{LINE_SUBSCRIPT}"
        yield F.A_LINE.line(a, {"state": s, "on": name}, a0=curve.a0, d=at.d, d0=curve.d0)
        yield from self._period_and_demand(rule, at, name, a)

    def _methods(self) -> Iterator[MethodSteps]:
        for name, method in self.found.methods.items():
            if method.a_g is None:
                continue
            if name == LINEAR:
                yield self._linear(method)
                continue
            yield self._steps(name, method, self._asked(name, "", line=False))
            if name in RULE_OF_METHOD:
                line, subscript = self.found.straight_methods[name], f",{LINE_SUBSCRIPT}"
                yield self._steps(name, line, self._asked(name, subscript, line=True), subscript)

    def _asked(self, name: str, more: str, *, line: bool) -> MethodComparison:
        if name in RULE_OF_METHOD:
            rule: Rule = RULE_OF_METHOD[name]
            s, states = rule.state, self.found.straight_states if line else self.found.states
            at = site.At(f"T_[{s}{more}]", states[s].T, rule.damping)
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

    def _steps(self, name: str, method: ItalianMethod, comparison: MethodComparison, more: str = "") -> MethodSteps:
        spectrum = self.ground.spectrum(comparison.state)
        assert spectrum is not None and method.a_g is not None  # the site gives its limit state
        symbol = f"a_[g,{'nl' if name in RULE_OF_METHOD else 0}{more}]"
        names = {"symbol": symbol, "state": comparison.state, "asked": "a_[g]", "more": more}
        capacity = self._solved(F.CAPACITY, names, spectrum, comparison, method.a_g, method.clause)
        return self._with_period(name, method, comparison, capacity, [self._zeta(method, names)], more)

    def _with_period(
        self, name: str, method: ItalianMethod, comparison: MethodComparison, capacity: WithCheck,
        zeta: list[Evaluated], more: str = "", damage: Sequence[Evaluated] = (),
    ) -> MethodSteps:  # fmt: skip
        beyond = ("long" if (method.zeta or 0) >= 1 else "short") if method.beyond else ""
        lasts = ([], []) if beyond else self._lasts(method, comparison, more)
        is_on_line = LINE_SUBSCRIPT in more
        return MethodSteps(
            name, comparison.state, is_on_line, damage, *capacity, zeta, *lasts, beyond, method.return_period
        )

    def _zeta(self, method: ItalianMethod, names: Mapping[str, str]) -> Evaluated:
        return F.ZETA.line(method.zeta or 0.0, names, a=method.a_g, b=method.demand)

    def _solved(
        self, formula: Formula, names: Mapping[str, str], spectrum: DemandSpectrum, comparison: MethodComparison,
        a_g: float, clause: str,
    ) -> WithCheck:  # fmt: skip
        """Return the lines to the a_g at which a demand equals a capacity, and its check if it is by iteration."""
        demand, symbols = self._demand(spectrum, comparison), {**names, "capacity": comparison.name}
        if is_close(a_g, spectrum.ag * comparison.capacity / demand):
            under = f"({comparison.demand})" if " " in comparison.demand else comparison.demand
            numbers = {"ag": spectrum.ag, "c": comparison.capacity, "d": demand}
            return [replace(formula, clause=clause).line(a_g, {**symbols, "demand": under}, **numbers)], []
        by_iteration = replace(F.CAPACITY_FOUND, clause=clause, meaning=f"{formula.meaning}_iterated")
        line = by_iteration.line(a_g, {**symbols, "demand": comparison.demand})
        return [line], list(self._checked(spectrum.with_ag(a_g), comparison))

    def _linear(self, method: ItalianMethod) -> MethodSteps:
        """Return q times the a_g at which rocking starts at SLD, and its zeta_E and return period at SLV."""
        ground, q = self.ground, self.ground.site.q
        assert method.a_g is not None  # every site file has SLV
        comparison = self._activation(ground.state_of_activation)
        differs = ground.of_activation != ground.spectrum(comparison.state)  # the mode of SLD may not be that of SLV
        damage = list(self._checked(ground.of_activation, comparison)) if differs else []
        start, onset = method.a_g / q, self.found.methods["damage"]
        names = {"symbol": "a_[g,0]", "state": comparison.state}
        capacity = self._solved(F.START, names, ground.of_activation, comparison, start, onset.clause)
        by_code = F.LINEAR if comparison.state == "SLD" else replace(F.LINEAR, standing="ours")
        names = {"symbol": F.LINEAR.symbol, "asked": "a_[g,SLV]", "state": "SLV", "more": ""}
        zeta = [by_code.line(method.a_g, q=q, a=start), self._zeta(method, names)]
        of_rock = MethodComparison(comparison.state, F.LINEAR.symbol, method.a_g, "a_[g]")
        return self._with_period(LINEAR, method, of_rock, capacity, zeta, damage=damage)

    def _checked(self, spectrum: DemandSpectrum, comparison: MethodComparison) -> Iterator[Evaluated]:
        """Yield the steps to the demand for the a_g or TR found by iteration, as a check against the capacity."""
        ground = spectrum.ground if isinstance(spectrum, FloorSpectrum) else spectrum
        if comparison.at is None or isinstance(spectrum, FloorSpectrum):
            yield from site.peaks(spectrum, comparison.state)
        elif isinstance(ground, GroundSpectrum):
            yield from list(site.peaks(ground, comparison.state))[:2]
        if comparison.at is not None:
            yield from site.displacement(spectrum, comparison.at)
        elif self.ground.site.own_period is not None:
            yield from site.ordinate_at_own_period(spectrum, self.ground.site.own_period, REFERENCE_DAMPING)

    def _lasts(self, method: ItalianMethod, comparison: MethodComparison, more: str) -> WithCheck:
        """Return the line to the capacity as a return period, and its check; empty without a hazard."""
        TR, hazard = method.return_period, self.ground.hazard
        if TR is None or hazard is None:
            return [], []
        lasts = F.LASTS.line(TR, {"more": more, "demand": comparison.demand, "capacity": comparison.name})
        by_ground = comparison.demand == "a_[g]"  # the lines for r and a_g suffice
        rows = list(hazard_at(hazard, TR))
        if by_ground:
            return [lasts], rows[:2]
        return [lasts], [*rows, *self._checked(self.ground.at_return_period(TR, comparison.state), comparison)]


def tie_rows(curve: ExactCurve, states: Mapping[str, LimitState]) -> Rows:
    """Return a row for each tie, and each force against the motion, at limit states: state, kN, m and per cent."""
    return [
        [pull.name, Markup(f"d_[{state}]"), pull.force / 1e3, pull.elongation,
         None if pull.strain is None else 100 * pull.strain]
        for state, at in states.items() for pull in pulls(curve, at.d)
    ]  # fmt: skip


def ties(say: Language, curve: ExactCurve, states: Mapping[str, LimitState]) -> list[Table]:
    """Return a table of ties, and of forces against the motion, at limit states; empty if there are none."""
    return tables(say, PACKAGE, "ties", {"states": list(states), "pulls": tie_rows(curve, states)})


def workings_of_direction(ground: SiteGround, found: ItalianVerified) -> list[Working]:
    """Return the calculation steps of the verification in one direction, as text in plain characters."""
    context = {"side": DirectionSteps(ground, found), "named": partial(chains.named, ENGLISH)}
    return list(workings(sections(ENGLISH, PACKAGE, "direction", context)))


def workings_of_site(ground: SiteGround) -> list[Working]:
    """Return the values of the site file and the steps to the ground at each limit state, in plain characters."""
    parts = sections(ENGLISH, PACKAGE, "site", {"ground": ground, "site": site, "counts": STATES})
    rows = [ENGLISH.written(each).in_plain("Site") for each in site.given(ground)]
    for state, part in zip(site.states(ground), parts, strict=True):
        rows += [replace(each, state=state) for each in workings([part])]
    return rows + [ENGLISH.written(each).in_plain("Site") for each in site.amplifications(ground)]

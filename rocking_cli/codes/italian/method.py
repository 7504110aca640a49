"""The three methods of the Italian code for mechanisms of masonry: damage, linear, nonlinear.

Clauses that begin with C are of Circolare 7/2019, the others of NTC 2018: see `clauses`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from math import pi, sqrt
from operator import itemgetter
from typing import Any

from rocking_cli.codes.italian import clauses, remarks
from rocking_cli.codes.italian.capacity import CapacityCurve, ExactCurve, StraightCurve, ends, with_elastic_branch
from rocking_cli.codes.italian.chain import Chain
from rocking_cli.codes.italian.demand import REFERENCE_DAMPING, DemandSpectrum
from rocking_cli.codes.italian.displaced import elastic, lasting
from rocking_cli.codes.italian.ground import SiteGround
from rocking_cli.codes.italian.results import ItalianMethod, ItalianVerification, ItalianVerified, LimitState
from rocking_cli.codes.italian.rules import DAMAGE, FIRST_STATE, LINEAR, NONLINEAR, OF_STATE, RULES, Rule
from rocking_cli.codes.italian.sheet.steps import workings_of_direction, workings_of_site
from rocking_cli.codes.italian.site import ItalianSite, of_structure
from rocking_cli.core import Direction, Mechanism
from rocking_cli.errors import InputError, MechanismError
from rocking_cli.studies.conclusion import LeftOut
from rocking_cli.verification.results import Control, Later, Remark

KEY, NAME = "NTC2018", "Italian code"
EDITION = "NTC 2018 and Circolare 7/2019"


@dataclass(frozen=True)
class _Case:
    """A direction of rocking at a site, with one of its capacity curves."""

    ground: SiteGround
    curve: CapacityCurve

    def state(self, rule: Rule) -> LimitState:
        """Return capacity and demand in displacement at a limit state [§C8.7.1.2.1.6, C8.7.1.10-12]."""
        site, curve = self.ground.site, self.curve
        by, d = min(ends(curve, rule).items(), key=itemgetter(1))
        a = with_elastic_branch(curve.acceleration(d), d, site.own_period)
        T = rule.factor * pi * sqrt(d / a)
        spectrum = self.ground.verified(rule.state)
        return LimitState(d, by, a, T, None if spectrum is None else spectrum.displacement(T, rule.damping))

    def method(
        self, title: str, clause: str, state: str, demand: Callable[[DemandSpectrum], float], capacity: float
    ) -> ItalianMethod:
        """Return the capacity a_g by one method."""
        spectrum = self.ground.verified(state)
        if spectrum is None:
            return ItalianMethod(title, None, None, clause)
        a_g = self.ground.capacity(spectrum, demand, capacity)
        return ItalianMethod(title, a_g, spectrum.ag, clause, *self.ground.lasts(state, demand, capacity))

    def linear(self) -> ItalianMethod:
        """Return the capacity by the linear method: q times the a_g at which rocking starts at SLD [§C8.7.1.2.1.7]."""
        start = self.ground.capacity(self.ground.of_activation, self.forces, self.curve.a0)
        a_g = self.ground.site.q * start
        shaking = self.ground.on_ground("SLV")
        assert shaking is not None  # every site file has SLV
        lasts = self.ground.lasts("SLV", lambda spectrum: spectrum.ag, a_g)
        return ItalianMethod("linear (q times onset) at SLV", a_g, shaking.ag, clauses.LINEAR, *lasts)

    @property
    def of_damage(self) -> str:
        """The clause of the formula for the onset of rocking."""
        return clauses.DAMAGE if self.ground.site.own_period is None else clauses.DAMAGE_VIBRATING

    def forces(self, spectrum: DemandSpectrum) -> float:
        """Acceleration demand on the element [m/s2]: the peak of the ground or floor, or the ordinate at its own T0."""
        T0 = self.ground.site.own_period
        return spectrum.peak if T0 is None else spectrum.acceleration(T0, REFERENCE_DAMPING)

    def methods(self, states: Mapping[str, LimitState]) -> dict[str, ItalianMethod]:
        """Return the methods, by key."""
        a0 = self.curve.a0
        methods = {
            DAMAGE: self.method("onset of rocking at SLV", self.of_damage, "SLV", self.forces, a0),
            LINEAR: self.linear(),
        }
        for rule in RULES:
            at, (damage, nonlinear) = states[rule.state], OF_STATE[rule.state]
            title = f"onset of rocking at {rule.state}"
            methods.setdefault(damage, self.method(title, self.of_damage, rule.state, self.forces, a0))

            def asked(spectrum: DemandSpectrum, T: float = at.T, damping: float = rule.damping) -> float:
                return spectrum.displacement(T, damping)

            title = f"nonlinear at {rule.state}"
            methods[nonlinear] = self.method(title, clauses.NONLINEAR, rule.state, asked, at.d)
        methods["SLD"] = self.method("onset of rocking at SLD", self.of_damage, "SLD", self.forces, a0)
        return methods


def verify(mechanism: Mechanism, site: ItalianSite, control: Control | None = None) -> ItalianVerification:
    """Verify a structure at a site.

    Parameters
    ----------
    mechanism : Mechanism
        The structure.
    site : ItalianSite
        The site.
    control : Control, optional
        The control point; by default the barycentre of P + Q.

    Raises
    ------
    InputError
        If a* vanishes nowhere, the control point does not move, or a spectrum ends too early.
    MechanismError
        If the structure does not stand.
    """
    ground, taken = SiteGround(of_structure(site, mechanism)), lasting(mechanism)
    directions = {direction: _verified(taken, direction, ground, control) for direction in taken.directions}
    otherwise = elastic(mechanism) if taken is not mechanism else []
    notes = [Remark.of("at_rest", names=[tie.name for tie in otherwise])] if otherwise else []
    return ItalianVerification(
        taken, KEY, NAME, EDITION, directions,
        workings=Later(partial(workings_of_site, ground)),
        variants=partial(_variants, taken, site, control),
        relies_on=remarks.relied_on(directions.values()),
        remarks=[*notes, *remarks.of_site(ground, list(directions.values()))],
        left_out=[
            LeftOut("tie", tie.name, "elastic", f"ties.{tie.name}.steel" if tie.bed is None else "")
            for tie in otherwise
        ],
    )  # fmt: skip


def _variants(mechanism: Mechanism, site: ItalianSite, control: Control | None) -> dict[str, ItalianVerified]:
    """Return the direction that decides, without the ties, and by the letter of the code with every P in P + Q.

    A variant that does not stand, or has no capacity, is left out.
    """
    changes = dict[str, dict[str, Any]]()
    if mechanism.ties:
        changes["without_ties"] = {"ties": None}
    shares = {
        each.name: {
            "floor": None, "weight": each.weight, "vertical": each.vertical,
            "horizontal": max(each.weight, each.horizontal),
        }
        for each in mechanism.hung.masses if each.weight > each.horizontal
    }  # fmt: skip
    if shares:
        changes["by_letter"] = {
            "loads": [load.model_copy(update=shares.get(load.name, {})) for load in mechanism.loads or []]
        }
    variants = {}
    for key, update in changes.items():
        with suppress(InputError, MechanismError):
            side = verify(mechanism.model_copy(update=update), site, control).deciding
            if key != "by_letter" or side.chain.is_by_the_letter:  # weights among the fields of a mechanism stay
                variants[key] = side
    return variants


def _verified(
    mechanism: Mechanism, direction: Direction, ground: SiteGround, control: Control | None
) -> ItalianVerified:
    chain = Chain(mechanism, direction)
    exact = ExactCurve(chain, control or chain.barycentre, ground.site.FC)
    straight = StraightCurve(exact.a0, exact.d0, exact.broken, exact.seat)
    case, line = _Case(ground, exact), _Case(ground, straight)
    states = {rule.state: case.state(rule) for rule in RULES}
    on_line = {rule.state: line.state(rule) for rule in RULES}
    methods = case.methods(states)
    notes = remarks.of_direction(exact, states, ground)
    if control is not None:
        usual = ExactCurve(chain, chain.barycentre, ground.site.FC)
        by_it = _Case(ground, usual)
        others = by_it.methods({rule.state: by_it.state(rule) for rule in RULES})
        notes.append(remarks.of_control(methods[NONLINEAR], others[NONLINEAR], exact.d0, usual.d0))
    verified = ItalianVerified(
        direction=direction,
        first=FIRST_STATE,
        exact=exact,
        lambda_=mechanism.uplift(direction),
        a0=exact.a0,
        d0=exact.d0,
        M=chain.e_star * chain.inertial / mechanism.gravity if mechanism.has_mass else None,
        states=states,
        straight_states=on_line,
        methods=methods,
        straight_methods=line.methods(on_line),
        governing={state: _governs(methods, *pair) for state, pair in OF_STATE.items()},
        governs=_governs(methods, DAMAGE, NONLINEAR),
        T0=ground.site.own_period,
        remarks=notes,
    )
    return replace(verified, workings=Later(partial(workings_of_direction, ground, verified)))


def _governs(methods: Mapping[str, ItalianMethod], damage: str, nonlinear: str) -> str:
    """Return the key of the method that governs at a limit state, the damage method or the nonlinear one.

    The damage method governs if its a_g, at which rocking starts, exceeds that of the nonlinear method.
    """
    start, moved = methods[damage].a_g, methods[nonlinear].a_g
    return damage if start is not None and moved is not None and start > moved else nonlinear

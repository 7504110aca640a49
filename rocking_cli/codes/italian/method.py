"""The three methods of the Italian code for mechanisms of masonry: damage, linear, nonlinear.

Clauses that begin with C are of Circolare 7/2019, the others of NTC 2018: see `clauses`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from math import inf, pi, sqrt
from operator import attrgetter, itemgetter

from pydantic import ValidationError

from rocking_cli.codes.italian import capacity, clauses, remarks
from rocking_cli.codes.italian.capacity import (
    CapacityCurve,
    ExactCurve,
    StraightCurve,
    elastic,
    ends,
    lasting,
    with_elastic_branch,
)
from rocking_cli.codes.italian.chain import Chain
from rocking_cli.codes.italian.demand import REFERENCE_DAMPING, DemandSpectrum
from rocking_cli.codes.italian.ground import SiteGround
from rocking_cli.codes.italian.results import ItalianMethod, ItalianVerification, ItalianVerified, LimitState
from rocking_cli.codes.italian.rules import DAMAGE, LINEAR, OF_STATE, RULES, THRESHOLDS, Rule
from rocking_cli.codes.italian.sheet.steps import workings_of_direction, workings_of_site
from rocking_cli.codes.italian.site import ItalianSite, of_structure
from rocking_cli.core import Direction, Mechanism
from rocking_cli.core.hung.element import INTERLOCK_NAME
from rocking_cli.errors import InputError, MechanismError
from rocking_cli.studies.conclusion import LeftOut
from rocking_cli.studies.remark import Remark
from rocking_cli.verification.results import CAPACITY_TOLERANCE, Control, Later

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
        spectrum = self.ground.spectrum(rule.state)
        return LimitState(d, by, a, T, None if spectrum is None else spectrum.displacement(T, rule.damping))

    def method(
        self, title: str, clause: str, state: str, demand: Callable[[DemandSpectrum], float], capacity: float
    ) -> ItalianMethod:
        """Return the capacity a_g by one method."""
        spectrum = self.ground.spectrum(state)
        if spectrum is None:
            return ItalianMethod(title, None, None, clause)
        a_g = self.ground.capacity(spectrum, demand, capacity)
        return ItalianMethod(title, a_g, spectrum.ag, clause, partial(self.ground.lasts, state, demand, capacity))

    def linear(self) -> ItalianMethod:
        """Return the capacity by the linear method: q times the a_g at which rocking starts at SLD [§C8.7.1.2.1.7]."""
        title, shaking = "linear (q times onset) at SLV", self.ground.on_ground("SLV")
        if shaking is None:
            return ItalianMethod(title, None, None, clauses.LINEAR)
        a_g = self.ground.site.q * self.ground.capacity(self.ground.of_activation, self.forces, self.curve.a0)
        lasts = partial(self.ground.lasts, "SLV", attrgetter("ag"), a_g)
        return ItalianMethod(title, a_g, shaking.ag, clauses.LINEAR, lasts)

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
    taken, otherwise = lasting(mechanism), elastic(mechanism)
    letter = by_letter(taken)
    verification = _by(letter, site, control)
    notes: list[str | Remark] = []
    if taken is not mechanism and otherwise:
        notes.append(Remark.of("at_rest", names=[tie.name for tie in otherwise]))
    others = dict[str, ItalianVerified]()
    if letter is not taken:
        ours = _by(taken, site, control)
        notes.append(remarks.of_letter(verification, ours))
        others["our_reading"] = ours.deciding
    verification = replace(
        verification,
        variants=partial(_variants, letter, site, control, others),
        remarks=[*notes, *verification.remarks],
        left_out=[
            LeftOut("tie", tie.name, "elastic", f"ties.{tie.name}.steel" if tie.bed is None else "")
            for tie in (otherwise if taken is not mechanism else ())
        ],
    )  # fmt: skip
    return judged(verification, site, {}) if letter is not taken else verification


def judged(found: ItalianVerification, site: ItalianSite, before: Mapping[str, float | None]) -> ItalianVerification:
    """Return a verification by what is required at a site, with the zeta_E before its intervention as far as known."""
    required = {state: THRESHOLDS[site.rule].at(state, before) for state in site.asked}
    sides = {direction: replace(each, required=required) for direction, each in found.directions.items()}
    of_reading = {"line_fails", "line_passes", "carried"}  # by what was required before
    directions = {
        direction: replace(each, remarks=[
            *remarks.of_reading(each),
            *(one for one in each.remarks if not (isinstance(one, Remark) and one.key in of_reading)),
        ])
        for direction, each in sides.items()
    }  # fmt: skip
    notes = [one for one in found.remarks if not (isinstance(one, Remark) and one.key == "ours_fails")]
    for letter in (one for one in notes[:] if isinstance(one, Remark) and one.key == "letter"):
        ours = inf if letter.values["ratio"] is None else letter.values["ratio"]
        fails = [state for state, least in required.items() if ours < (least or 0.0) * (1 - CAPACITY_TOLERANCE)]
        notes += [Remark("ours_fails", {"ratio": ours}, fails)] if fails else []
    rules = remarks.of_rules(site, found.mechanism, before)
    return replace(found, directions=directions, remarks=notes, rules=rules)


def strengthened(found: ItalianVerification, other: ItalianVerification, site: ItalianSite) -> ItalianVerification:
    """Return a verification, as without an intervention, beside that of the strengthened structure, judged by both."""
    known = {state: [side.zeta_at(state) for side in found.directions.values()] for state in site.asked}
    before = {state: None if None in zetas else min(filter(None, zetas)) for state, zetas in known.items()}
    existing = judged(found, site.model_copy(update={"intervention": None}), {})
    return replace(existing, strengthened=judged(other, site, before))


def _by(mechanism: Mechanism, site: ItalianSite, control: Control | None) -> ItalianVerification:
    """Return the verification of a structure as it is taken."""
    ground = SiteGround(of_structure(site, mechanism))
    directions = {direction: _stronger(mechanism, direction, ground, control) for direction in mechanism.directions}
    verification = ItalianVerification(
        mechanism, KEY, NAME, EDITION, directions,
        workings=Later(partial(workings_of_site, ground)),
        effects=remarks.EFFECTS,
        remarks=remarks.of_site(ground, list(directions.values()), site.FC),
    )  # fmt: skip
    return judged(verification, site, {})


def by_letter(mechanism: Mechanism) -> Mechanism:
    """Return a structure in which every weight that a load puts on it also moves sideways [C8.7.1.1].

    Weights among the fields of the mechanism stay; without other ones it is the structure itself.
    """
    shares = {
        each.name: {"floor": None, "weight": each.weight, "vertical": each.vertical, "horizontal": each.weight}
        for each in mechanism.hung.masses if each.weight > each.horizontal
    }  # fmt: skip
    if not any(load.name in shares for load in mechanism.loads or []):
        return mechanism
    loads = [load.model_copy(update=shares.get(load.name, {})) for load in mechanism.loads or []]
    return mechanism.model_copy(update={"loads": loads})


def _variants(
    mechanism: Mechanism, site: ItalianSite, control: Control | None, others: Mapping[str, ItalianVerified]
) -> dict[str, ItalianVerified]:
    """Return the direction that decides without the ties, if it stands and has a capacity, before others."""
    with suppress(InputError, MechanismError, ValidationError):
        if mechanism.ties:
            bare = _by(mechanism.model_copy(update={"ties": None}), site, control)
            return {"without_ties": bare.deciding, **others}
    return {**others}


def _stronger(
    mechanism: Mechanism, direction: Direction, ground: SiteGround, control: Control | None
) -> ItalianVerified:
    """Return the result in a direction, without ties that end d_SLV early if the capacity is larger without them."""
    tied = _verified(mechanism, direction, ground, control)
    names = [lost.name for lost in tied.exact.lost if lost.name != INTERLOCK_NAME]
    if tied.states[tied.first].by != capacity.BREAK or not names:
        return tied
    bare = _verified(tied.exact.without(names), direction, ground, control)
    if not (bare.ratio or 0.0) > (tied.ratio or 0.0):
        return tied
    ties = remarks.elongations(tied.exact)
    values = {"names": names, "ratio": tied.ratio, "ties": ties}
    return replace(bare, remarks=[Remark("stronger_without", values), *bare.remarks])


def _verified(
    mechanism: Mechanism, direction: Direction, ground: SiteGround, control: Control | None, *, whole: bool = False
) -> ItalianVerified:
    chain = Chain(mechanism, direction, whole)
    exact = ExactCurve(chain, control or chain.barycentre, ground.site.FC)
    straight = StraightCurve(exact.a0, exact.d0, exact.broken, exact.seat)
    case, line = _Case(ground, exact), _Case(ground, straight)
    states = {rule.state: case.state(rule) for rule in RULES}
    on_line = {rule.state: line.state(rule) for rule in RULES}
    methods = case.methods(states)
    governing = {}
    for state, (damage, nonlinear) in OF_STATE.items():  # the onset of rocking, if that takes more
        start, far = methods[damage].a_g, methods[nonlinear].a_g
        governing[state] = damage if start is not None and far is not None and start > far else nonlinear
    moved = [
        state for state in states if state in ground.site.asked and states[state].demand is not None
        and governing[state] == OF_STATE[state][1]
    ]  # fmt: skip
    notes = remarks.of_reach(exact, states, methods, moved)
    governing |= {state: OF_STATE[state][0] for each in notes for state in each.states or ()}
    moved = [state for state in moved if governing[state] == OF_STATE[state][1]]
    notes += remarks.of_direction(exact, states, ground, moved)
    if control is not None:
        usual = ExactCurve(chain, chain.barycentre, ground.site.FC)
        by_it = _Case(ground, usual)
        others = by_it.methods({rule.state: by_it.state(rule) for rule in RULES})
        _, nonlinear = OF_STATE[ground.site.asked[0]]
        notes.append(remarks.of_control(methods[nonlinear], others[nonlinear], exact.d0, usual.d0))
    first, letter = ground.site.asked[0], None
    if not (chain.whole or chain.is_by_the_letter):
        letter = _verified(mechanism, direction, ground, control, whole=True)
    verified = ItalianVerified(
        direction=direction,
        first=first,
        required=dict.fromkeys(ground.site.asked),
        exact=exact,
        lambda_=mechanism.uplift(direction),
        a0=exact.a0,
        d0=exact.d0,
        M=chain.e_star * chain.inertial / mechanism.gravity if mechanism.has_mass else None,
        states=states,
        straight_states=on_line,
        methods=methods,
        straight_methods=line.methods(on_line),
        governing=governing | {"SLD": "SLD"},
        governs=governing[first],
        T0=ground.site.own_period,
        remarks=notes,
        letter=letter,
    )
    return replace(verified, workings=Later(partial(workings_of_direction, ground, verified)))

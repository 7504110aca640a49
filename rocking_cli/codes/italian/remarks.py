"""Remarks on a verification by the Italian code: which of them hold, and their numbers."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from math import isclose

from rocking_cli.codes.italian.capacity import BREAK, SEAT, ExactCurve
from rocking_cli.codes.italian.chain import Chain
from rocking_cli.codes.italian.demand import FloorSpectrum, GroundSpectrum
from rocking_cli.codes.italian.displaced import (
    MAX_OVERHANG_SHARE,
    MAX_STRAIN,
    carried,
    elastic,
    furthest,
    pulls,
    strengths,
)
from rocking_cli.codes.italian.grid import EARTH_RADIUS
from rocking_cli.codes.italian.ground import SiteGround, bounded, return_period
from rocking_cli.codes.italian.results import ItalianMethod, ItalianVerified, LimitState
from rocking_cli.codes.italian.rules import (
    DAMAGE,
    FIRST_STATE,
    FURTHER_STATES,
    LINEAR,
    NONLINEAR,
    OF_STATE,
    RULES,
    STATES,
)
from rocking_cli.core import Mechanism
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.names import digits_apart
from rocking_cli.verification.results import Remark

LONG_PERIOD = 4.0  # s; above it the code requires a study of the site, or records
LARGEST_FC = 1.35  # confidence factor of the lowest knowledge level, LC1
ROUNDING_RATIO = 1e-9
SAME_RATIO = 0.005  # relative difference of a_g below which two methods agree
MAX_LINE_DEVIATION = 0.01  # share of a* by which the straight line may be off without a remark


def _capacities(states: Iterable[str]) -> list[Remark]:
    """Return the symbols of the displacement capacities of limit states."""
    return [Remark.of(f"d_[{state}]") for state in states]


def of_site(ground: SiteGround, directions: Collection[ItalianVerified]) -> list[Remark]:
    """Return remarks on the site and on both directions."""
    remarks: list[Remark] = [*of_ground(ground), *_of_spectrum(ground), *_of_lives(ground)]
    periods = [state.T for each in directions for state in each.states.values() if state.demand is not None]
    long = max(periods, default=0.0)
    if long > LONG_PERIOD:
        remarks.append(Remark.of("long", T=long, most=LONG_PERIOD))
    missing = [state for state in FURTHER_STATES if ground.spectrum(state) is None]
    if missing:
        remarks.append(Remark.of("missing", states=missing))
    if left_out := [state for state in FURTHER_STATES if state not in missing and ground.verified(state) is None]:
        remarks.append(Remark.of("states_left_out", states=left_out))
    crushes = any(each.chain.mechanism.crushing is not None for each in directions)
    if ground.site.FC < LARGEST_FC and not crushes:
        remarks.append(Remark.of("confidence", FC=ground.site.FC, least=LARGEST_FC))
    loads = [load for each in directions for load in each.chain.mechanism.loads or [] if load.force is None]
    if any(load.seat is None for load in loads):
        remarks.append(Remark.of("seats", limited=_capacities(rule.state for rule in RULES)))
    return remarks


def _of_spectrum(ground: SiteGround) -> list[Remark]:
    spectrum = ground.spectrum("SLV")
    remarks: list[Remark] = []
    on_ground = spectrum.ground if isinstance(spectrum, FloorSpectrum) else spectrum
    if isinstance(on_ground, GroundSpectrum) and on_ground.soil is None:
        remarks.append(Remark.of("no_soil"))
    if ground.state_of_activation != "SLD":
        remarks.append(Remark.of("linear_SLV"))
    if isinstance(spectrum, FloorSpectrum):
        remarks += [Remark.of("floor"), Remark.of("one_mode"), *_of_modes(ground)]
        if spectrum.peak < spectrum.ground.peak:
            floor, under = (peak / STANDARD_GRAVITY for peak in (spectrum.peak, spectrum.ground.peak))
            remarks.append(Remark.of("low_floor", floor=floor, ground=under))
    return remarks


def _of_modes(ground: SiteGround) -> list[Remark]:
    """Return a remark on a floor whose T1 and xi1 are the same at several limit states."""
    floor = ground.site.floor
    same = [state for state in FURTHER_STATES if floor is not None and getattr(floor, state) is None]
    if floor is None or not same:
        return []
    values = {"T1": floor.T1, "xi1": floor.xi1}
    if "SLD" in same:
        return [Remark.of("same_mode", **values)]
    states = [state for state in same if ground.spectrum(state) is not None]
    return [Remark.of("same_mode_further", **values, states=states)] if states else []


def _of_lives(ground: SiteGround) -> list[Remark]:
    life = ground.site.life
    if ground.hazard is None or life is None:
        return []
    exact = {state: return_period(life, state) for state in STATES}
    return [
        Remark.of("bound", state=state, TR=TR, bound=bounded(TR)) for state, TR in exact.items() if bounded(TR) != TR
    ]


def of_ground(ground: SiteGround) -> list[Remark]:
    """Return remarks on how the ground follows from what the site file gives."""
    site, remarks = ground.site, list[Remark]()
    if site.TC_star is not None:
        remarks.append(Remark.of("without_state", state=FIRST_STATE))
    if (cell := site.cell) is not None:
        way = Remark.of("on_node") if len(cell.corners) == 1 else Remark.of("between_nodes", radius=EARTH_RADIUS)
        remarks.append(Remark.of("by_grid", way=way, unit=Remark.of(cell.unit)))
    if site.VN is not None and site.use is not None and site.life != site.VN * site.use:
        remarks.append(Remark.of("short_life", VR=site.VN * site.use, least=site.life))
    if ground.hazard is not None and site.life is not None and (rows := ground.hazard.rounded(site.life)):
        exact = {state: bounded(return_period(site.life, state)) for state in rows}
        each = [Remark.of("row", state=state, row=row, TR=exact[state]) for state, row in rows.items()]
        remarks.append(Remark.of("rows", rows=each))
    return remarks


def of_direction(curve: ExactCurve, states: Mapping[str, LimitState], ground: SiteGround) -> list[Remark]:
    """Return remarks on one direction."""
    remarks = [*_of_line(curve, states), *_of_ties(curve, states), *_of_break(curve, states), *_of_seat(curve, states)]
    remarks += [*_of_stretch(curve, states), *_of_letter(curve.chain, curve)]
    T0 = ground.site.own_period
    if T0 is not None:
        on = [rule.state for rule in RULES if states[rule.state].a < curve.acceleration(states[rule.state].d)]
        if on:
            remarks.append(Remark.of("elastic", states=_capacities(on), T0=T0))
    return remarks


def _of_line(curve: ExactCurve, states: Mapping[str, LimitState]) -> list[Remark]:
    d, a = curve.points()
    off = max(abs(curve.a0 * (1 - d / curve.d0) - a)) / curve.a0
    if off <= MAX_LINE_DEVIATION:
        return []
    at = states["SLV"]
    there = curve.a0 * (1 - at.d / curve.d0) / at.a - 1
    side = Remark.of("above" if there > 0 else "below")
    return [Remark.of("line", most=100 * float(off), there=100 * abs(there), side=side)]


def _of_ties(curve: ExactCurve, states: Mapping[str, LimitState]) -> list[Remark]:
    remarks: list[Remark] = [*_of_strength(curve.chain.mechanism)]
    if remarks and len(curve.chain.mechanism.bodies()) == 1:
        remarks.append(Remark.of("bends"))
    if not elastic(curve.chain.mechanism):
        return remarks
    remarks += [Remark.of("ties", largest=curve.largest, over=curve.largest / curve.a0)]
    for name, force in carried(curve, states["SLV"].d).items():
        remarks.append(Remark.of("carries", name=name, force=force / 1e3))
    return remarks


def _of_strength(mechanism: Mechanism) -> Iterator[Remark]:
    """Yield remarks on the strength of each tie of steel, and on what its formulas rest on."""
    for name, strength in strengths(mechanism).items():
        force = {key: value / 1e3 for key, value in strength.limits.items()}
        key = "strength" if "bearing" in force else "strength_alone"
        yield Remark(key, {"name": name, "N": strength.force / 1e3, "governs": Remark.of(strength.governs), **force})


def _of_stretch(curve: ExactCurve, states: Mapping[str, LimitState]) -> list[Remark]:
    """Return remarks on ties of too large elongation, forces with large displacements, and blocks that move far."""
    remarks: dict[str, Remark] = {}
    for state, at in sorted(states.items(), key=lambda pair: -pair[1].d):  # largest displacements first
        if state != "SLV" and at.demand is None:
            continue
        held = pulls(curve, at.d)
        for pull in held:
            e = pull.elongation
            if pull.strain is None and e > 0:
                far = {"most": 100 * MAX_STRAIN, "length": e / MAX_STRAIN}
                remarks.setdefault(pull.name, Remark.of("follows", state=state, name=pull.name, e=e, **far))
            elif pull.strain is not None and pull.strain > MAX_STRAIN:
                strain = {"strain": 100 * pull.strain, "most": 100 * MAX_STRAIN}
                remarks.setdefault(pull.name, Remark.of("stretched", state=state, name=pull.name, e=e, **strain))
        moved, thickness = furthest(curve, at.d)
        if held and moved > MAX_OVERHANG_SHARE * thickness / 2:
            remarks.setdefault("", Remark.of("wide", state=state, moved=moved, thickness=thickness))
    return list(remarks.values())


def relied_on(directions: Iterable[ItalianVerified]) -> list[Remark]:
    """Return the remarks on ties that stretch and on blocks that move too far, in their form beside the conclusion.

    If rocking starts at no limit state, the conclusion relies on no displacement.
    """
    key_of = {"stretched": "end_stretched", "wide": "end_wide"}
    return [
        Remark(key_of[each.key], each.values)
        for verified in directions if _rocks(verified) for each in verified.remarks
        if isinstance(each, Remark) and each.key in key_of
    ]  # fmt: skip


def _rocks(verified: ItalianVerified) -> bool:
    """Return whether rocking starts at a limit state that the site gives."""
    starts = (verified.methods[damage].zeta for damage, _ in OF_STATE.values())
    return any(zeta is not None and zeta < 1 for zeta in starts)


def _of_break(curve: ExactCurve, states: Mapping[str, LimitState]) -> list[Remark]:
    if curve.torn is None or not curve.lost_on_the_way:
        return []
    d = curve.displacement_at(curve.torn)
    remarks: list[Remark] = [Remark.of("torn", d=d)]
    if states["SLV"].by == BREAK:
        remarks.append(Remark.of("ends"))
    return remarks


def _of_seat(curve: ExactCurve, states: Mapping[str, LimitState]) -> list[Remark]:
    seat = curve.seat
    limited = [state for state, at in states.items() if at.by == SEAT]
    if seat is None or not limited:
        return []
    return [Remark.of("seat", name=seat.load, length=seat.length, d=seat.d, limited=_capacities(limited))]


def _of_letter(chain: Chain, curve: ExactCurve) -> list[Remark]:
    remarks: list[Remark] = []
    alpha0, lambda_ = chain.alpha0, chain.mechanism.uplift(chain.direction)
    if abs(alpha0 / lambda_ - 1) > ROUNDING_RATIO:
        remarks.append(Remark.of("own_formula", alpha0=alpha0, lambda_=lambda_))
    if not chain.is_by_the_letter:
        a_letter = curve.a0 * chain.start_by_the_letter
        same = isclose(chain.by_the_letter, alpha0, rel_tol=ROUNDING_RATIO)
        alpha = Remark("alpha0_same" if same else "alpha0_by_letter", _apart(chain.by_the_letter, alpha0))
        remarks.append(Remark.of("letter", alpha0=alpha, **_apart(a_letter, curve.a0)))
    return remarks


def _apart(letter: float, own: float) -> dict[str, float | int]:
    return {"letter": letter, "own": own, "digits": digits_apart(letter, own, 4)}


def of_control(chosen: ItalianMethod, usual: ItalianMethod, d0: float, usual_d0: float) -> Remark:
    """Return a remark on the effect of a chosen control point on d0* [m] and the nonlinear method."""
    change = d0 / usual_d0 - 1
    if abs(change) < ROUNDING_RATIO:
        return Remark.of("control_same", d0=d0)
    side = Remark.of("more" if change > 0 else "less")
    values = {"d0": d0, "change": 100 * abs(change), "side": side, "own": usual_d0}
    if chosen.a_g is None or usual.a_g is None:
        return Remark("control", values)
    return Remark("control_a_g", {**values, "a_g": chosen.a_g, "usual": usual.a_g})


def differences(verified: ItalianVerified, first: str) -> Iterator[Remark]:
    """Explain why the linear method and the straight line differ from the method and curve that govern."""
    linear, counts, at = verified.methods[LINEAR].a_g, verified.counts.a_g, verified.states[first]
    if linear is None or counts is None:
        return
    ratio, begins = linear / counts, verified.methods[DAMAGE].a_g or 0.0
    key = "linear_same" if abs(ratio - 1) <= SAME_RATIO else "linear_less" if ratio < 1 else "linear_more"
    values = {"linear": linear, "ratio": ratio, "share": 100 * ratio, "times": linear / begins, "T": at.T, "d": at.d}
    yield Remark(key, {**values, "state": first})
    line, exact = verified.straight_methods[NONLINEAR].a_g, verified.methods[NONLINEAR].a_g
    if line is not None and exact is not None and abs(line / exact - 1) > SAME_RATIO:
        side = Remark.of("more" if line > exact else "less")
        yield Remark.of("straight", line=line, change=100 * abs(line / exact - 1), side=side)

"""Remarks on a verification by the Italian code, as sentences that depend on its numbers."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from math import isclose
from typing import Any

from rocking_cli.codes.italian.capacity import ExactCurve
from rocking_cli.codes.italian.chain import Chain
from rocking_cli.codes.italian.demand import FloorSpectrum, GroundSpectrum
from rocking_cli.codes.italian.ground import SiteGround
from rocking_cli.codes.italian.remarks import TEXTS
from rocking_cli.codes.italian.results import ItalianMethod, ItalianVerified, LimitState
from rocking_cli.codes.italian.rules import FURTHER, RULES, STATES
from rocking_cli.codes.italian.site_hazard import LONGEST, SHORTEST, return_period
from rocking_cli.codes.italian.ties import STRETCHED, WIDE, carried, elastic, furthest, pulls
from rocking_cli.core.hung.ties import Tie
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.names import digits_apart
from rocking_cli.studies.verification.told import Told

LONG = 4.0  # s: above it the code requires a study of the site, or records
LEAST_CONFIDENT = 1.35  # FC of the least knowledge, LC1
ROUNDING = 1e-9
CURVED = 0.01  # of a*: how far the straight line may be off before it is stated


def _told(key: str, **values: Any) -> Told:
    return Told.of(TEXTS, key, **values)


def _named(states: Sequence[str]) -> str:
    """Join names as a list in a sentence."""
    *before, last = states
    return _told("and", one=", ".join(before), other=last) if before else last


def of_site(ground: SiteGround, found: Collection[ItalianVerified]) -> list[str]:
    """Return remarks on the site and on both directions."""
    said: list[str] = [*_of_spectrum(ground), *_of_lives(ground)]
    periods = [state.T for each in found for state in each.states.values() if state.demand is not None]
    long = max(periods, default=0.0)
    if long > LONG:
        said.append(_told("long", T=long, most=LONG))
    missing = [state for state in FURTHER if ground.spectrum(state) is None]
    if missing:
        said.append(_told("missing", states=_named(missing)))
    crushes = any(each.chain.mechanism.crushing is not None for each in found)
    if ground.site.FC < LEAST_CONFIDENT and not crushes:
        said.append(_told("confidence", FC=ground.site.FC, least=LEAST_CONFIDENT))
    loads = [load for each in found for load in each.chain.mechanism.loads or [] if load.mass is not None]
    if any(load.seat is None for load in loads):
        said.append(_told("seats", limited=_named([f"d_{rule.state}" for rule in RULES])))
    return said


def _of_spectrum(ground: SiteGround) -> list[str]:
    spectrum = ground.spectrum("SLV")
    said: list[str] = []
    on_ground = spectrum.ground if isinstance(spectrum, FloorSpectrum) else spectrum
    if isinstance(on_ground, GroundSpectrum) and on_ground.soil is None:
        said.append(_told("no_soil"))
    if ground.state_of_activation != "SLD":
        said.append(_told("linear_SLV"))
    if isinstance(spectrum, FloorSpectrum):
        said += [_told("floor"), _told("one_mode"), *_of_modes(ground)]
        if spectrum.peak < spectrum.ground.peak:
            floor, under = (peak / STANDARD_GRAVITY for peak in (spectrum.peak, spectrum.ground.peak))
            said.append(_told("low_floor", floor=floor, ground=under))
    return said


def _of_modes(ground: SiteGround) -> list[str]:
    """Return a remark on a floor whose T1 and xi1 are the same at several limit states."""
    floor = ground.site.floor
    same = [state for state in FURTHER if floor is not None and getattr(floor, state) is None]
    if floor is None or not same:
        return []
    values = {"T1": floor.T1, "xi1": floor.xi1}
    if "SLD" in same:
        return [_told("same_mode", **values)]
    given = [state for state in same if ground.spectrum(state) is not None]
    return [_told("same_mode_further", **values, states=_named(given))] if given else []


def _of_lives(ground: SiteGround) -> list[str]:
    site = ground.site
    if ground.hazard is None or site.VN is None or site.CU is None:
        return []
    said: list[str] = []
    for state in STATES:
        TR = return_period(site.VN * site.CU, state)
        if not SHORTEST <= TR <= LONGEST:
            bound = SHORTEST if TR < SHORTEST else LONGEST
            said.append(_told("bound", state=state, TR=TR, bound=bound))
    return said


def of_direction(curve: ExactCurve, states: Mapping[str, LimitState], ground: SiteGround) -> list[str]:
    """Return remarks on one direction."""
    said = [*_of_line(curve, states), *_of_ties(curve, states), *_of_break(curve, states), *_of_seat(curve, states)]
    said += [*_of_stretch(curve, states), *_of_letter(curve.chain, curve)]
    T0 = ground.site.own_period
    if T0 is not None:
        on = [rule.state for rule in RULES if states[rule.state].a < curve.acceleration(states[rule.state].d)]
        if on:
            said.append(_told("elastic", states=_named([on[0], *(f"d_{state}" for state in on[1:])]), T0=T0))
    return said


def _of_line(curve: ExactCurve, states: Mapping[str, LimitState]) -> list[str]:
    d, a = curve.points()
    off = max(abs(curve.a0 * (1 - d / curve.d0) - a)) / curve.a0
    if off <= CURVED:
        return []
    at = states["SLV"]
    there = curve.a0 * (1 - at.d / curve.d0) / at.a - 1
    side = _told("above" if there > 0 else "below")
    return [_told("line", most=100 * float(off), there=100 * abs(there), side=side)]


def _of_ties(curve: ExactCurve, states: Mapping[str, LimitState]) -> list[str]:
    if not elastic(curve.chain.mechanism):
        return []
    said: list[str] = [_told("ties", largest=curve.largest, over=curve.largest / curve.a0)]
    for name, force in carried(curve, states["SLV"].d).items():
        said.append(_told("carries", name=name, force=force / 1e3))
    return said


def _of_stretch(curve: ExactCurve, states: Mapping[str, LimitState]) -> list[str]:
    """Return remarks on ties of too large elongation, forces with large displacements, and blocks that move far."""
    said: dict[str, str] = {}
    for state, at in sorted(states.items(), key=lambda pair: -pair[1].d):  # the largest displacement verified
        if state != "SLV" and at.demand is None:
            continue
        held = pulls(curve, at.d)
        for pull in held:
            e = pull.elongation
            if pull.strain is None and e > 0:
                text = _told("follows", state=state, name=pull.name, e=e, most=100 * STRETCHED, length=e / STRETCHED)
                said.setdefault(pull.name, text)
            elif pull.strain is not None and pull.strain > STRETCHED:
                strain = {"strain": 100 * pull.strain, "most": 100 * STRETCHED}
                said.setdefault(pull.name, _told("stretched", state=state, name=pull.name, e=e, **strain))
        moved, thickness = furthest(curve, at.d)
        if held and moved > WIDE * thickness / 2:
            said.setdefault("", _told("wide", state=state, moved=moved, thickness=thickness))
    return list(said.values())


def of_ties_at_rest(ties: Sequence[Tie]) -> str:
    """Return the remark that ties count with their force at rest."""
    return _told("at_rest", names=", ".join(tie.name for tie in ties))


def _of_break(curve: ExactCurve, states: Mapping[str, LimitState]) -> list[str]:
    if curve.torn is None or not curve.lost_on_the_way:
        return []
    d = curve.displacement_at(curve.torn)
    said: list[str] = [_told("torn", d=d)]
    if curve.broken is not None and states["SLV"].d == curve.broken:
        said.append(_told("ends"))
    return said


def _of_seat(curve: ExactCurve, states: Mapping[str, LimitState]) -> list[str]:
    seat = curve.seat
    limited = [f"d_{state}" for state, at in states.items() if seat is not None and at.d == seat.d]
    if seat is None or not limited:
        return []
    return [_told("seat", name=seat.load, length=seat.length, d=seat.d, limited=_named(limited))]


def _of_letter(chain: Chain, curve: ExactCurve) -> list[str]:
    said: list[str] = []
    alpha0, lambda_ = chain.alpha0, chain.mechanism.uplift(chain.direction)
    if abs(alpha0 / lambda_ - 1) > ROUNDING:
        said.append(_told("own_formula", alpha0=alpha0, lambda_=lambda_))
    if not chain.is_by_the_letter:
        a_letter = curve.a0 * chain.start_by_the_letter
        same = isclose(chain.by_the_letter, alpha0, rel_tol=ROUNDING)
        alpha = _told("alpha0_same") if same else _told("alpha0_by_letter", **_apart(chain.by_the_letter, alpha0))
        said.append(_told("letter", alpha0=alpha, **_apart(a_letter, curve.a0)))
    return said


def _apart(letter: float, own: float) -> dict[str, float | int]:
    return {"letter": letter, "own": own, "digits": digits_apart(letter, own, 4)}


def of_control(chosen: ItalianMethod, usual: ItalianMethod, d0: float, usual_d0: float) -> str:
    """Return a remark on the effect of a chosen control point on d0* [m] and the nonlinear method."""
    change = d0 / usual_d0 - 1
    if abs(change) < ROUNDING:
        return _told("control_same", d0=d0)
    given = {"d0": d0, "change": 100 * abs(change), "side": _told("more" if change > 0 else "less"), "own": usual_d0}
    if chosen.a_g is None or usual.a_g is None:
        return _told("control", **given)
    return _told("control_a_g", **given, a_g=chosen.a_g, usual=usual.a_g)

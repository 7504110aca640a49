"""What to know of a verification by the Italian code, in sentences that its numbers decide."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.studies.verification.capacity import ExactCurve
from rocking_cli.studies.verification.chain import Chain
from rocking_cli.studies.verification.codes.italian.demand import FloorSpectrum, GroundSpectrum
from rocking_cli.studies.verification.codes.italian.ground import Ground
from rocking_cli.studies.verification.codes.italian.hazard import LONGEST, SHORTEST, return_period
from rocking_cli.studies.verification.codes.italian.rules import RULES
from rocking_cli.studies.verification.results import Method, State, Verified

LONG = 4.0  # s: above it the code asks for a study of the site, or records
LEAST_CONFIDENT = 1.35  # FC of the least knowledge, LC1
ROUNDING = 1e-9
CURVED = 0.01  # of a*: how far the straight line may be off before it is said


def of_site(ground: Ground, found: Collection[Verified]) -> list[str]:
    """Of the site and of both directions."""
    said = [*_of_spectrum(ground), *_of_lives(ground)]
    periods = [state.T for each in found for state in each.states.values() if state.demand is not None]
    long = max(periods, default=0.0)
    if long > LONG:
        said.append(
            f"A period of {long:.3g} s is above {LONG:g} s, where the code asks for a study of the site or for records."
        )
    missing = [state for state in ("SLC", "SLD") if ground.spectrum(state) is None]
    if missing:
        said.append(f"The site file does not give {' and '.join(missing)}: nothing is held against it.")
    crushes = any(each.chain.mechanism.crushing is not None for each in found)
    if ground.site.FC < LEAST_CONFIDENT and not crushes:
        said.append(
            f"FC = {ground.site.FC:g}: it is {LEAST_CONFIDENT:g}, that of LC1, as long as no compressive strength is "
            "taken into account."
        )
    said.append("The code ends d_SLC also where parts lose their seat, such as beams: that is not looked at here.")
    return said


def _of_spectrum(ground: Ground) -> list[str]:
    spectrum, said = ground.spectrum("SLV"), []
    on_ground = spectrum.ground if isinstance(spectrum, FloorSpectrum) else spectrum
    if isinstance(on_ground, GroundSpectrum) and on_ground.soil is None:
        said.append(
            "No soil is given: displacements at long periods do not go down to those of the ground, which is on the "
            "safe side."
        )
    if isinstance(spectrum, FloorSpectrum):
        said.append(
            "The floor amplifies by A = 1.1 xi1^-1/2 eta(xi) with xi1 as a ratio: our reading; in per cent, as the "
            "code prints, A would reduce."
        )
        if spectrum.peak < spectrum.ground.peak:
            said.append(
                f"The peak of the floor, S_Z = {spectrum.peak / STANDARD_GRAVITY:.4g} g, is below that of the ground, "
                f"a_g S = {spectrum.ground.peak / STANDARD_GRAVITY:.4g} g: one mode says too little so far down."
            )
    return said


def _of_lives(ground: Ground) -> list[str]:
    site = ground.site
    if ground.hazard is None or site.VN is None or site.CU is None:
        return []
    said = []
    for state in ("SLD", "SLV", "SLC"):
        TR = return_period(site.VN * site.CU, state)
        if not SHORTEST <= TR <= LONGEST:
            bound = SHORTEST if TR < SHORTEST else LONGEST
            said.append(f"The return period of {state}, {TR:.4g} years, is taken as {bound:g} years.")
    return said


def of_direction(curve: ExactCurve, states: Mapping[str, State], ground: Ground) -> list[str]:
    """Of one direction."""
    said = [*_of_line(curve, states), *_of_ties(curve), *_of_break(curve, states), *_of_letter(curve.chain, curve)]
    T0 = ground.site.T0
    if T0 is not None:
        on = [rule.state for rule in RULES if states[rule.state].a < curve.acceleration(states[rule.state].d)]
        if on:
            said.append(f"d_{' and d_'.join(on)} lie on the elastic branch of T0 = {T0:g} s.")
    return said


def _of_line(curve: ExactCurve, states: Mapping[str, State]) -> list[str]:
    d, a = curve.points()
    off = max(abs(curve.a0 * (1 - d / curve.d0) - a)) / curve.a0
    if off <= CURVED:
        return []
    at = states["SLV"]
    there = curve.a0 * (1 - at.d / curve.d0) / at.a - 1
    return [
        f"The straight line leaves the exact curve by up to {100 * off:.2g} % of a0*; at d_SLV it is "
        f"{100 * abs(there):.2g} % {'above' if there > 0 else 'below'} it. The exact curve counts."
    ]


def _of_ties(curve: ExactCurve) -> list[str]:
    if not any(spring.stiffness > 0 for spring in curve.chain.mechanism.springs):
        return []
    over = curve.largest / curve.a0
    return [
        "A tie is in alpha0 by its force at rest: the rigid-plastic tie of the code is one with its yield force as "
        f"prestress, or a force. What is elastic here brings a* to {curve.largest:.4g} m/s2 at most, "
        f"{over:.3g} times a0*."
    ]


def _of_break(curve: ExactCurve, states: Mapping[str, State]) -> list[str]:
    if curve.torn is None or not curve.lost_on_the_way:
        return []
    d = curve.displacement_at(curve.torn)
    said = [
        f"The courses of the crossing walls have slid apart at d = {d:.4g} m: d0* is that of the curve without them, "
        "which alone is there up to collapse."
    ]
    if curve.broken is not None and states["SLV"].d == curve.broken:
        said.append("That takes more than half of the largest a*, so that d_SLV ends there.")
    return said


def _of_letter(chain: Chain, curve: ExactCurve) -> list[str]:
    said = []
    alpha0, lambda_ = chain.alpha0, chain.mechanism.uplift(chain.direction)
    if abs(alpha0 / lambda_ - 1) > ROUNDING:
        said.append(
            f"alpha0 = {alpha0:.6g} is not lambda = {lambda_:.6g}: the mechanism has its own formula of the latter."
        )
    if not chain.is_by_the_letter:
        said.append(
            "What is carried without horizontal inertia is in P y' only, our choice; by the letter every P is in "
            f"P + Q: alpha0 would be {chain.by_the_letter:.4g} (here {alpha0:.4g}) and a0* "
            f"{curve.a0 * chain.start_by_the_letter:.4g} m/s2 (here {curve.a0:.4g})."
        )
    return said


def of_control(chosen: Method, usual: Method, d0: float, usual_d0: float) -> str:
    """What a chosen control point changes: d0* [m] and the nonlinear method, against the barycentre of P + Q."""
    change = d0 / usual_d0 - 1
    if abs(change) < ROUNDING:
        return f"With this control point d0* is that of the barycentre of P + Q, {d0:.4g} m."
    said = (
        f"With this control point d0* is {d0:.4g} m, {100 * abs(change):.3g} % {'more' if change > 0 else 'less'} than "
        f"{usual_d0:.4g} m by the barycentre of P + Q"
    )
    if chosen.a_g is None or usual.a_g is None:
        return f"{said}."
    return f"{said}; the nonlinear method allows {chosen.a_g:.4g} g, by the barycentre {usual.a_g:.4g} g."

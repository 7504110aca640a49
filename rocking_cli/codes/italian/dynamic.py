"""Time histories of the mechanism for a verification, with the confidence factor and without.

FC divides the restoring forces: I phi.. + J phi.^2 + V'/FC = -s B u_g''. In the time t sqrt(FC), this is the structure
itself under a motion with FC times the acceleration and a time axis shorter by sqrt(FC), so that only the motion has to
be changed; without FC it is the structure's own history. The inertia is that of the mechanism, without e*: our choice.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from math import sqrt

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.codes.italian.capacity import ExactCurve
from rocking_cli.codes.italian.demand import REFERENCE_DAMPING
from rocking_cli.codes.italian.ground import site_demand
from rocking_cli.codes.italian.results import Dynamic, ItalianVerification, RecordPeak
from rocking_cli.codes.italian.site import ItalianSite, floor_at, of_structure
from rocking_cli.core import Direction
from rocking_cli.dynamics.history import History
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.processing.oscillator import response_spectrum
from rocking_cli.structure import Structure
from rocking_cli.studies.engines import follow
from rocking_cli.studies.remark import Remark
from rocking_cli.verification.demand import SiteDemand
from rocking_cli.verification.results import Histories, MotionPlace, where_it_stands

MIN_RECORDS_FOR_MEAN = 7
LEAST_MEAN = 0.9  # share of the spectrum of the site that the mean of records reaches [NTC 2018, 3.2.3.6]


def with_confidence(motion: GroundMotion, FC: float) -> GroundMotion:
    """Return a motion with the same effect as the given one on a structure with 1/FC of its restoring forces."""
    quick = sqrt(FC)
    vertical = motion.vertical and replace(motion.vertical, dt=motion.vertical.dt / quick)
    return replace(motion, dt=motion.dt / quick, acceleration=FC * motion.acceleration, vertical=vertical)


def peaks(
    structure: Structure, curves: Mapping[Direction, ExactCurve], motion: GroundMotion, signs: Sequence[int]
) -> dict[Direction, RecordPeak]:
    """Return the peak displacement in each direction under one record, in the worse of several polarities.

    The outcome is unknown if that of any polarity is, unless another polarity overturns the structure in this
    direction.

    Parameters
    ----------
    structure : Structure
        The structure.
    curves : mapping
        The capacity curve of each direction, with its FC.
    motion : GroundMotion
        The scaled record.
    signs : sequence of int
        The polarities: 1, -1 or both.

    Raises
    ------
    SolverError
        If a motion cannot be followed to its end.
    """
    under = [motion.scaled(sign) if sign != 1 else motion for sign in signs]
    histories = [follow(structure, curve) for curve in under]
    factors = {curve.confidence for curve in curves.values()}
    weaker = {
        FC: histories if FC == 1 else [follow(structure, with_confidence(curve, FC)) for curve in under]
        for FC in factors
    }
    of_direction = {}
    for direction, curve in curves.items():
        d, known_to, last = _largest(curve, direction, histories)
        d_FC, known_to_FC, history = _largest(curve, direction, weaker[curve.confidence])
        slow = None if known_to_FC is None else sqrt(curve.confidence) * known_to_FC
        ends = history if known_to_FC is not None else last if known_to is not None else None
        of_direction[direction] = RecordPeak(
            motion.name, d_FC, d, slow, known_to, why=None if ends is None else _why(ends),
            history=history if known_to_FC is None else None,
        )  # fmt: skip
    return of_direction


def with_histories(
    verification: ItalianVerification, structure: Structure, site: ItalianSite, histories: Histories
) -> ItalianVerification:
    """Return a verification with time histories under a set of records; see `check.with_histories`."""
    counted = verification.mechanism.at_strength(on=False)
    taken = structure if counted == structure.mechanism else structure.of(counted)
    unchecked = taken.mechanism.unchecked if taken.model("nonlinear").joints is None else None
    curves = {direction: each.exact for direction, each in verification.directions.items()}
    state = _state_of_records(verification, histories.state)
    what, moved = where_it_stands(histories, floor_at(site, state))
    every = []
    for motion in moved:
        every.append(peaks(taken, curves, motion, histories.signs))
        histories.progress(1)
    directions = {}
    for direction, each in verification.directions.items():
        records = [
            replace(peak[direction], scale_factor=one.scale_factor)
            for peak, one in zip(every, histories.records, strict=True)
        ]
        of_state = Dynamic(
            state, records, each.d0, each.states[state].d, MIN_RECORDS_FOR_MEAN, unchecked, what, histories.motions,
            histories.refused,
        )  # fmt: skip
        directions[direction] = replace(each, dynamic={**each.dynamic, state: of_state})
    remarks: list[str | Remark] = [
        each._replace(states=[one for one in each.states or () if one != state])
        if isinstance(each, Remark) and each.key == "long" and len(histories.records) >= MIN_RECORDS_FOR_MEAN
        else each
        for each in verification.remarks
    ]
    if unchecked is not None:
        remarks.append(Remark("unchecked", {}, [state]))
    if len(histories.records) >= MIN_RECORDS_FOR_MEAN:
        demand = site_demand(of_structure(site, verification.mechanism))
        T = max(each.states[state].T for each in directions.values())
        remarks += _below_target(demand, what, histories.motions, state, T)
    return replace(verification, directions=directions, remarks=remarks)


def _below_target(
    demand: SiteDemand, what: MotionPlace, motions: Sequence[GroundMotion], state: str, T: float
) -> Iterator[Remark]:
    """Yield that the mean spectrum of records is below that of the site at the period that decides [s]."""
    at, of_floor = demand.states[state], what.kind == "of_floor"
    target = at.floor if of_floor and at.floor is not None else at.ground
    if at.last > T:
        sa = [float(response_spectrum(each.of_ground, [T], REFERENCE_DAMPING).sa[0]) for each in motions]
        share = STANDARD_GRAVITY * sum(sa) / len(sa) / target.acceleration(T, REFERENCE_DAMPING)
        if share < LEAST_MEAN:
            values = {"share": 100 * share, "T": T, "state": state, "least": 100 * LEAST_MEAN}
            yield Remark("below_target", values, [state])


def _state_of_records(verification: ItalianVerification, state: str | None) -> str:
    """Return the limit state of a set of records. Raises `InputError` if the site does not give it."""
    if state is None:
        return verification.first
    states = next(iter(verification.directions.values())).states
    if state not in states:
        hint = f"time histories verify {' or '.join(states)}"
        raise InputError(Problem(f"{state!r} is not a limit state of displacement", field=named("state"), hint=hint))
    if states[state].demand is None:
        hint = f"give {state} in the site file: the records must match its spectrum"
        raise InputError(Problem(f"{state} is not given by the site", field=named("state"), hint=hint))
    return state


def _largest(
    curve: ExactCurve, direction: Direction, histories: Sequence[History]
) -> tuple[float | None, float | None, History | None]:
    """Return the largest d of several histories in a direction [m], until when they are known [s], and which decides.

    There is no d if a history overturned in this direction, or has an unknown outcome.
    """
    if any(history.fell and history.fell_to == direction for history in histories):
        return None, None, None
    unknown = [history for history in histories if history.unknown]
    if unknown:
        first = min(unknown, key=lambda history: history.known_to)
        return None, first.known_to, first
    rotations = [history.peak_positive if direction > 0 else history.peak_negative for history in histories]
    phi = max(rotations)
    return float(displacement(curve, np.array([phi]))[0]), None, histories[rotations.index(phi)]


def _why(history: History) -> Remark:
    """Return why an unknown outcome is not known longer, a clause."""
    if history.bound is not None and history.bound.kind == "yields":
        return Remark.of("unknown_yields", name=history.bound.name)
    joint = history.bound is None and history.check is not None and history.check.reason in ("opens", "slides")
    return Remark.of("unknown_joint" if joint else "unknown_other")


def displacement(curve: ExactCurve, phi: Reals) -> Reals:
    """Return d at rotations, shape (n,) [m]; where the control point may move back, past d0*, at least d0*."""
    d = curve.chain.displacement(phi, curve.control)
    return np.where(phi >= curve.end, np.maximum(d, curve.d0), d)


def displacement_history(curve: ExactCurve, direction: Direction, history: History) -> tuple[Reals, Reals]:
    """Return the times of a history with FC [s], as those of the record, and d in a direction [m], shape (n,) each.

    d is 0 while the structure rocks in the other direction; samples after it overturns there are left out.
    """
    phi = direction * history.phi[np.isfinite(history.phi)]
    return sqrt(curve.confidence) * history.time[: len(phi)], displacement(curve, np.maximum(phi, 0.0))

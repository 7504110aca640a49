"""Time histories: run the kernel and say what happened."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from rocking_cli.core import Direction, Equivalence, Mechanism, equivalent_block
from rocking_cli.dynamics.model import MODELS, Model, ModelName, build_model
from rocking_cli.errors import InputError, SolverError
from rocking_cli.excitation.base import GroundMotion

Reals = NDArray[np.float64]
RTOL = 1e-10  # local error of a nonlinear step
TAIL = 10.0  # s of motion kept after the record
MOST_IMPACTS = 20_000  # after the record and its tail, to call it still rocking; eta = 0.999 rests in 14 000
MOST_SAMPLES = 20_000_000
RELEASE_DT = 0.005  # s between samples of a free motion without a record


class Outcome(Enum):
    """How a motion ended; the value says it in words."""

    AT_REST = "came to rest"
    OVERTURNED = "overturned"
    STILL_ROCKING = "still rocking long after the record, and not going to overturn"


@dataclass(frozen=True, eq=False)
class History:
    """The motion of one model of a structure.

    Parameters
    ----------
    model : str
        `"nonlinear"`, `"linear1"` or `"linear2"`.
    outcome : Outcome
        How the motion ended.
    time : ndarray, shape (n,)
        Times of the samples [s].
    phi, rate : ndarray, shape (n,)
        Signed rotation [rad] and its rate [rad/s]; NaN after overturning.
    ratio : ndarray, shape (n,)
        Signed rotation over the critical rotation of its direction.
    peak_positive, peak_negative : float or None
        Largest rotation in either direction [rad], >= 0; None in a direction in which it overturned.
    peak_ratio : float or None
        Largest rotation over the critical rotation; None if overturned.
    overturning_time : float or None
        When the rotation passed the critical one for good [s].
    uplift_time : float or None
        First uplift from rest [s].
    fell_to : Direction or None
        The direction in which it overturned.
    impact_count : int
        Number of impacts, those of the chatter to rest included.
    impacts : ndarray, shape (k, 3)
        Time [s], sign of the direction that ends, and rate before [rad/s] of each impact.
    end_time : float
        When it came to rest for good, or was certain to overturn [s].
    """

    model: ModelName
    outcome: Outcome
    time: Reals
    phi: Reals
    rate: Reals
    ratio: Reals
    peak_positive: float | None
    peak_negative: float | None
    peak_ratio: float | None
    overturning_time: float | None
    uplift_time: float | None
    fell_to: Direction | None
    impact_count: int
    impacts: Reals
    end_time: float

    @property
    def overturned(self) -> bool:
        """Whether the structure overturned."""
        return self.outcome is Outcome.OVERTURNED


def respond(
    mechanism: Mechanism,
    motion: GroundMotion | None = None,
    *,
    models: tuple[ModelName, ...] = MODELS,
    release: float | None = None,
    tail: float = TAIL,
    rtol: float = RTOL,
) -> dict[ModelName, History]:
    """The rocking response of a structure to a ground motion, a release from a tilt, or both.

    Parameters
    ----------
    mechanism : Mechanism
        The structure.
    motion : GroundMotion, optional
        Horizontal ground acceleration, straight between its samples and zero after the last.
    models : tuple of {"nonlinear", "linear1", "linear2"}
        Which equations of motion to follow.
    release : float, optional
        Start at rest from this fraction of phi_cr, between -1 and 1; negative in the negative direction.
    tail : float
        How long the samples go on after the record [s]. The motion itself is always followed to its end.
    rtol : float
        Relative local error of a step of the nonlinear motion.

    Returns
    -------
    dict of str to History
        In the order of `models`.

    Raises
    ------
    InputError
        If there is neither a motion nor a release, or a value is out of range, or the restitution from kinematics
        is not positive.
    SolverError
        If the motion cannot be followed to its end.

    Notes
    -----
    Nonlinear: Eq. 8 by an error-controlled Runge-Kutta pair. Linear: Eq. 16, exact on every ramp of the record.
    """
    if motion is None and release is None:
        raise InputError("nothing to respond to: give a ground motion, a release, or both")
    unknown = [name for name in models if name not in MODELS]
    if unknown or not models:
        raise InputError(f"models must be of {', '.join(MODELS)}, got {', '.join(unknown) or 'none'}")
    if release is not None and not 0 < abs(release) < 1:
        raise InputError(f"release must be a fraction of phi_cr between 0 and 1 (or 0 and -1), got {release:g}")
    if not (np.isfinite(tail) and tail >= 0):
        raise InputError(f"tail must be a time in seconds, 0 or more, got {tail:g}")
    if not 0 < rtol < 1:
        raise InputError(f"rtol must be between 0 and 1, got {rtol:g}")
    equivalence = equivalent_block(mechanism)
    built = [build_model(mechanism, equivalence, name) for name in models]
    return {model.name: _follow(model, equivalence, motion, release or 0.0, tail, rtol) for model in built}


def _follow(
    model: Model, equivalence: Equivalence, motion: GroundMotion | None, release: float, tail: float, rtol: float
) -> History:
    from rocking_cli.dynamics import kernels  # numba, only when a history is asked for

    accelerations = motion.acceleration if motion is not None else np.zeros(0)
    dt = motion.dt if motion is not None else RELEASE_DT
    start = Direction.NEGATIVE if release < 0 else Direction.POSITIVE
    samples = max(accelerations.size, 1) + round(tail / dt)
    if samples > MOST_SAMPLES:
        raise InputError(f"dt = {dt:g} s makes {samples:,} samples with a tail of {tail:g} s: is dt in seconds?")
    phi, rate = np.empty(samples), np.empty(samples)
    impacts, marks = np.empty((MOST_IMPACTS, 3)), np.empty(kernels.MARKS)
    strongest = np.maximum.accumulate(np.abs(accelerations[::-1]))[::-1].copy()
    slow = 0.5 / max(equivalence.positive.p, equivalence.negative.p)
    status = kernels.follow(
        model.kind,
        model.cells,
        model.certain,
        model.numbers,
        accelerations,
        strongest,
        dt,
        0 if start > 0 else 1,
        abs(release) * equivalence[start].phi_cr,
        rtol,
        slow,
        MOST_IMPACTS,
        phi,
        rate,
        impacts,
        marks,
    )
    if status == kernels.STALLED:
        raise SolverError(
            f"the {model.name} history cannot be followed past t = {marks[kernels.ENDED]:.6g} s: too small steps"
        )
    outcome = (Outcome.AT_REST, Outcome.OVERTURNED, Outcome.STILL_ROCKING)[status]
    fallen = outcome is Outcome.OVERTURNED
    fell_to = None if not fallen else Direction.POSITIVE if marks[kernels.SIDE] == 0 else Direction.NEGATIVE
    peaks = {Direction.POSITIVE: marks[kernels.PEAK], Direction.NEGATIVE: marks[kernels.PEAK + 1]}
    count = int(marks[kernels.IMPACTS])
    first = marks[kernels.FIRST_UPLIFT]
    # The samples end with the record or with the motion, whichever is later.
    kept = min(samples, max(accelerations.size, int(marks[kernels.ENDED] / dt) + 3))
    return History(
        model=model.name,
        outcome=outcome,
        time=np.arange(kept, dtype=np.float64) * dt,
        phi=phi[:kept],
        rate=rate[:kept],
        ratio=phi[:kept] / np.where(phi[:kept] < 0, model.phi_cr[1], model.phi_cr[0]),
        peak_positive=None if fell_to is Direction.POSITIVE else float(peaks[Direction.POSITIVE]),
        peak_negative=None if fell_to is Direction.NEGATIVE else float(peaks[Direction.NEGATIVE]),
        peak_ratio=None if fallen else float(max(peaks[d] / equivalence[d].phi_cr for d in Direction)),
        overturning_time=float(marks[kernels.CROSSED]) if fallen else None,
        uplift_time=float(first) if np.isfinite(first) else None,
        fell_to=fell_to,
        impact_count=count,
        impacts=impacts[: min(count, MOST_IMPACTS)],
        end_time=float(marks[kernels.ENDED]),
    )

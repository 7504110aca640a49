"""Time histories: run the kernel and say what happened."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import NDArray

from rocking_cli.dynamics import kernels
from rocking_cli.dynamics.deck import MOST_IMPACTS, RELEASE_DT, read_marks
from rocking_cli.dynamics.dispatch import KERNELS
from rocking_cli.dynamics.joints import JointCheck, check_of
from rocking_cli.dynamics.model import Model, ModelName
from rocking_cli.dynamics.outcome import OUTCOME, Outcome
from rocking_cli.dynamics.vertical import contact_lost
from rocking_cli.errors import InputError, SolverError
from rocking_cli.excitation.base import GroundMotion

Reals = NDArray[np.float64]
FINEST_RTOL = 1e-14  # below it rounding refuses steps
RTOL = 1e-9  # local error of a step, of the lower order of the pair: peaks are then right to 1e-11
TAIL = 10.0  # s of motion kept after the record
MOST_SAMPLES = 20_000_000


@dataclass(frozen=True, eq=False, kw_only=True)
class History(Outcome[bool, int, float]):
    """The motion of one model of a structure: what became of it, see `Outcome`, and its samples.

    Parameters
    ----------
    model : str
        `"nonlinear"`, `"linear1"` or `"linear2"`.
    time : ndarray, shape (n,)
        Times of the samples [s]: those of the ground motion, or every so many-th of them, see its `every`.
    phi, rate : ndarray, shape (n,)
        Signed rotation [rad] and its rate [rad/s]; NaN after overturning, and where nothing is known any longer.
    ratio : ndarray, shape (n,)
        Signed rotation over the critical rotation of its direction.
    impacts : ndarray, shape (k, 3)
        Time [s], sign of the direction that ends, and rate before [rad/s] of each impact, of the first 20,000 at most.
    contact_lost : float or None
        When v_g'' first came down to -g [s]: the structure may leave the ground then, which no model here follows.
    uplift_error : float
        By how much the uplift acceleration of the model is off that of the structure, relative; see `Model`.
    p : float
        Frequency parameter [rad/s]: 1/p is the time in which a tilt near the critical one grows.
    ends_at_limit : tuple of bool
        Whether the positive and the negative direction have no critical rotation: ratios are then over the kinematic
        limit, and overturning is reaching it.
    check : JointCheck, optional
        What its joints do; None if they are not known, so that nothing was checked.
    """

    model: ModelName
    time: Reals
    phi: Reals
    rate: Reals
    ratio: Reals
    impacts: Reals
    contact_lost: float | None = None
    uplift_error: float = 0.0
    p: float = float("nan")
    ends_at_limit: tuple[bool, bool] = (False, False)
    check: JointCheck | None = None

    @property
    def reference(self) -> str:
        """What its largest ratio is over, the critical rotation or the kinematic limit."""
        return "kinematic limit" if self.ends_at_limit[self._side] else "critical rotation"

    @property
    def furthest(self) -> float:
        """The largest rotation of the direction in which the ratio is largest [rad]."""
        return self.peak_negative if self._side else self.peak_positive

    @property
    def _side(self) -> int:
        """The direction in which its ratio is largest: 0 for positive, 1 for negative."""
        known = self.ratio[np.isfinite(self.ratio)]
        return int(known[np.abs(known).argmax()] < 0)

    @property
    def first_impact(self) -> float:
        """When the first impact comes [s]; NaN if there is none."""
        return float(self.impacts[0, 0]) if len(self.impacts) else float("nan")


def check_rtol(rtol: float) -> None:
    """Refuse a relative local error that is none."""
    if not FINEST_RTOL <= rtol < 1:
        raise InputError(f"rtol must be at least {FINEST_RTOL:g} and below 1, got {rtol:g}: rounding allows no less")


def follow(
    model: Model,
    motion: GroundMotion | None,
    *,
    release: float = 0.0,
    tail: float = TAIL,
    rtol: float = RTOL,
    most_kept: int = MOST_IMPACTS,
    eta: float = float("nan"),
) -> History:
    """The history of one model; for the arguments see `Engine.follow` of `rocking_cli.engines`.

    `release` is 0 without one; `most_kept` is how many impacts are kept; `eta` the restitution of both directions, NaN:
    that of the model.
    """
    every = motion.every if motion is not None else 1
    dt = every * motion.dt if motion is not None else RELEASE_DT  # between the samples that are kept
    npts = _samples(motion) if motion is not None else 0
    samples = max(npts, 1) + round(min(tail / dt, 2.0 * MOST_SAMPLES))
    if samples > MOST_SAMPLES:
        many = f"{samples:,}" if samples < MOST_SAMPLES + npts else f"more than {MOST_SAMPLES:,}"
        what = "the period" if motion is not None and motion.format == "pulse" else "dt"
        raise InputError(f"dt = {dt:g} s makes {many} samples with a tail of {tail:g} s: is {what} in seconds?")
    phi, rate, impacts = np.empty(samples), np.empty(samples), np.empty((most_kept, 3))
    runs, marks = np.zeros((1, kernels.RUN_COLUMNS)), np.empty((1, kernels.MARKS))
    runs[0, [kernels.FACTOR, kernels.V_FACTOR, kernels.SIZE, kernels.SLENDER]] = 1.0
    runs[0, [kernels.ETA_POSITIVE, kernels.ETA_NEGATIVE]] = eta
    runs[0, kernels.START] = model.q(release)
    kernel = KERNELS[model.kernel]
    deck = kernel.lay_out([model], [motion])
    kernel.run(deck, runs, marks, rtol=rtol, every=every, phi=phi, rate=rate, impacts=impacts)
    found = read_marks(marks, np.array([model.phi_cr]), np.array([model.reach]))
    end = float(marks[0, kernels.ENDED])
    if found.failed[0]:
        raise SolverError(
            f"the {model.name} time history could not be simulated past t = {end:.6g} s: the steps became too small"
        )
    if found.unknown[0]:  # nothing from there on is a result
        until = float(found.known_to[0])
        beyond = np.arange(samples) * dt > until
        phi[beyond] = rate[beyond] = np.nan
        end = min(end, until)
    # The samples end with the record or with the motion, whichever is later; after overturning they are NaN.
    kept = min(samples, max(npts, int(end / dt) + (1 if marks[0, kernels.STATUS] == kernels.STILL_ROCKING else 3)))
    return History(
        **{name: getattr(found, name)[0].item() for name in OUTCOME},
        model=model.name,
        time=np.arange(kept, dtype=np.float64) * dt,
        phi=phi[:kept],
        rate=rate[:kept],
        ratio=phi[:kept] / np.where(phi[:kept] < 0, model.phi_cr[1], model.phi_cr[0]),
        impacts=impacts[: min(int(found.impact_count[0]), len(impacts))],
        contact_lost=contact_lost(motion, model.gravity),
        uplift_error=model.uplift_error,
        p=model.p,
        ends_at_limit=model.ends_at_limit,
        check=check_of(model.joints, marks[0]),
    )


def _samples(motion: GroundMotion) -> int:
    """Samples of the horizontal component that are kept and cover both components."""
    longest = motion.vertical.duration if motion.vertical is not None else 0.0
    return (max(motion.npts, ceil(longest / motion.dt) + 1) - 1) // motion.every + 1

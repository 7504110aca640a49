"""Time histories: run the kernel for one model and one motion, and read its results."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import ceil, isfinite
from typing import NamedTuple

import numpy as np

from rocking_cli import names
from rocking_cli.arrays import Bools, Reals
from rocking_cli.core.bounds import Bound
from rocking_cli.dynamics import kernels, openings, stepping
from rocking_cli.dynamics.deck import MAX_IMPACTS, RELEASE_DT, check_rtol, lay_out, read_marks, run_deck
from rocking_cli.dynamics.joints import JointCheck, check_of
from rocking_cli.dynamics.model import Model, ModelName
from rocking_cli.dynamics.outcome import OUTCOME_FIELDS, Outcome
from rocking_cli.dynamics.parallel import in_parts
from rocking_cli.dynamics.sliding import Slid, settle, slid_of
from rocking_cli.errors import InputError, SolverError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.short_repr import short_repr

MOST_SAMPLES = 20_000_000
COLUMNS_PER_TASK = 256  # number of histories that a thread computes at a time
MIN_COLUMN_ETA = 1e-3  # lower bound on the restitution of a single column, which shifts with that of the structure
MIN_IMPACT_RATE = 0.02  # least rate of a counted impact, over that of the strongest one; weaker impacts are chatter


class BlockPeaks(NamedTuple):
    """What free blocks do in a history.

    Parameters
    ----------
    fell : str
        The block that falls first; empty if none does.
    off : str
        The block, or the part of the ground, off whose edge it falls; empty if it falls otherwise.
    turned, moved, left : (float, str)
        Largest rotation [rad] and displacement [m] of the centroid of any block, and the largest displacement at rest
        [m], each with the block; the last is NaN if they do not come to rest.
    least_turn, least : float
        Rotation [rad] and displacement [m] below which theirs are not resolved, as contacts are soft.
    """

    fell: str
    off: str
    turned: tuple[float, str]
    moved: tuple[float, str]
    left: tuple[float, str]
    least_turn: float = 0.0
    least: float = 0.0


@short_repr
@dataclass(frozen=True, eq=False, kw_only=True)
class History(Outcome[bool, int, float]):
    """Time history of one model of a structure: its outcome, see `Outcome`, and its samples.

    Parameters
    ----------
    model : str
        `"nonlinear"`, `"linear1"` or `"linear2"`; `"blocks"` for free blocks.
    time : ndarray, shape (n,)
        Times of the samples [s]: those of the ground motion, or every k-th of them, with k its `every`.
    phi, rate : ndarray, shape (n,)
        Signed rotation [rad] and its rate [rad/s]; NaN after overturning, after the motion becomes unknown, and for
        free blocks of a structure whose mechanism has no rotation, as one that slides.
    ratio : ndarray, shape (n,)
        Signed rotation over the critical rotation of its direction.
    impacts : ndarray, shape (k, 3)
        Time [s], sign of the direction that ends, and rate before [rad/s] of each impact, of at most the first 20,000.
    contact_lost : float or None
        First time at which v_g'' reaches -g [s]: the structure may then leave the ground, which the models do not
        simulate.
    uplift_error : float
        Relative error of the uplift acceleration of the model, see `Model`.
    p : float
        Frequency parameter [rad/s]: 1/p is the time scale on which a rotation near the critical one diverges.
    ends_at_limit : tuple of bool
        Whether the positive and the negative direction have no critical rotation: ratios are then over the kinematic
        limit, and reaching this limit is overturning.
    check : JointCheck, optional
        Check of the joints; None if they are not known, so that they were not checked.
    apart : bool
        Whether the motion is unknown from its first impact on because columns may fall out of step there.
    bound : Bound, optional
        The bound of the motion that it has reached, from which on it is unknown; None if it has not.
    unmeasured : bool
        Whether it is unknown from there on because the restitution is not known.
    slid : Slid, optional
        The slip of a body that never rocks under the motion, or of the block that slides farthest; None for others.
    blocks : BlockPeaks, optional
        What free blocks do; None for one degree of freedom.
    witness : bool
        Whether free blocks can simulate the structure, so that they tell what follows where it is unknown.
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
    apart: bool = False
    bound: Bound | None = None
    unmeasured: bool = False
    slid: Slid | None = None
    blocks: BlockPeaks | None = None
    witness: bool = False

    @property
    def rotates(self) -> bool:
        """Whether the mechanism has a rotation: free blocks are simulated without one too."""
        return isfinite(self.ratio[0])

    @property
    def crushes(self) -> bool:
        """Whether the motion is unknown because a joint crushes."""
        return bool(self.unknown) and self.check is not None and self.check.reason == "crushes"

    @property
    def words(self) -> str:
        """Outcome in the words of `rocking_cli.names`."""
        if self.blocks is not None and self.blocks.off:
            return f"{names.FALLS_OFF} {self.blocks.off}"
        if not self.rotates and self.at_rest:
            return names.COMES_TO_REST
        return super().words

    @property
    def reference(self) -> str:
        """Name of the rotation by which the peak rotation is divided, the critical rotation or the kinematic limit."""
        return "kinematic limit" if self.ends_at_limit[self._side] else "critical rotation"

    @property
    def furthest(self) -> float:
        """Largest rotation in the direction in which the ratio is largest [rad]."""
        return self.peak_negative if self._side else self.peak_positive

    @property
    def _side(self) -> int:
        """Direction in which the ratio is largest: 0 for positive, 1 for negative."""
        known = self.ratio[np.isfinite(self.ratio)]
        return int(known[np.abs(known).argmax()] < 0)

    @property
    def felt(self) -> Reals:
        """Impacts that are counted, listed and marked, as rows of `impacts`; the chatter before rest is left out.

        They are as fast as `MIN_IMPACT_RATE` times the fastest one or more.
        """
        rate = self.impacts[:, 2]
        felt: Reals = self.impacts[rate >= MIN_IMPACT_RATE * rate.max(initial=0.0)]
        return felt

    @property
    def first_impact(self) -> float:
        """Time of the first impact [s]; NaN if there is none."""
        return float(self.impacts[0, 0]) if len(self.impacts) else float("nan")


def follow(
    model: Model,
    motion: GroundMotion | None,
    *,
    release: float = 0.0,
    tail: float = names.TAIL_SECONDS,
    rtol: float = names.RTOL,
    most_kept: int = MAX_IMPACTS,
    eta: float = float("nan"),
) -> History:
    """Simulate the time history of one model; most arguments are those of `rocking_cli.studies.engines.follow`.

    `release` is 0 without a release; `most_kept` is the number of impacts to keep; `eta` is the restitution of both
    directions, NaN for that of the model.
    """
    check_rtol(rtol)
    every = motion.every if motion is not None else 1
    dt = every * motion.dt if motion is not None else RELEASE_DT  # interval of the recorded samples
    npts = 0
    if motion is not None:  # the recorded samples cover both components
        longest = motion.vertical.duration if motion.vertical is not None else 0.0
        npts = (max(motion.npts, ceil(longest / motion.dt) + 1) - 1) // every + 1
    samples = max(npts, 1) + round(min(tail / dt, 2.0 * MOST_SAMPLES))
    if samples > MOST_SAMPLES:
        many = f"{samples:,}" if samples < MOST_SAMPLES + npts else f"more than {MOST_SAMPLES:,}"
        what = "the period" if motion is not None and motion.format == "pulse" else "dt"
        raise InputError(f"dt = {dt:g} s makes {many} samples with a tail of {tail:g} s: is {what} in seconds?")
    phi, rate, impacts = np.empty(samples), np.empty(samples), np.empty((most_kept, 3))
    runs, marks = np.zeros((1, kernels.RUN_COLUMNS)), np.empty((1, stepping.MARKS))
    runs[0, [kernels.FACTOR, kernels.V_FACTOR, kernels.SIZE, kernels.SLENDER]] = 1.0
    runs[0, [kernels.ETA_POSITIVE, kernels.ETA_NEGATIVE]] = eta
    runs[0, kernels.START] = model.q(release)
    recorded = kernels.Samples(every, phi, rate, impacts, np.empty(stepping.MARKS))
    run = partial(run_deck, lay_out([model], [motion]), runs, marks, rtol=rtol, samples=recorded)
    run()
    tilts = np.array([release])
    loose = out_of_step([model], [motion], runs, marks, tilts, rtol=rtol, most_impacts=MAX_IMPACTS)
    if model.to_first_impact or loose[0]:
        runs[0, kernels.LOOSE] = 1.0
        run()
    slips: list[tuple[float, float, float]] = []  # along the motion
    largest, slip = settle(marks, [model.sliding], [motion], runs, slips)
    if slip is not None:  # it only slides
        phi[:] = rate[:] = 0.0
    outcome = replace(read_marks(marks, np.array([model.phi_cr]), np.array([model.reach])), slip=largest)
    end = float(marks[0, stepping.ENDED])
    if outcome.failed[0]:
        raise SolverError(
            f"the {model.name} time history could not be simulated past t = {end:.6g} s: the steps became too small"
        )
    for samples_of in (phi, rate):
        samples_of += 0.0  # turns -0 into 0
    if outcome.unknown[0]:  # samples after `known_to` are not valid
        until = float(outcome.known_to[0])
        beyond = np.arange(samples) * dt > until
        phi[beyond] = rate[beyond] = np.nan
        end = min(end, until)
    # The samples end with the record or with the motion, whichever is later; after overturning they are NaN.
    kept = min(samples, max(npts, int(end / dt) + (1 if marks[0, stepping.STATUS] == kernels.STILL_ROCKING else 3)))
    time = np.arange(kept, dtype=np.float64) * dt
    return History(
        **{name: getattr(outcome, name)[0].item() for name in OUTCOME_FIELDS},
        model=model.name,
        time=time,
        phi=phi[:kept],
        rate=rate[:kept],
        ratio=phi[:kept] / np.where(phi[:kept] < 0, model.phi_cr[1], model.phi_cr[0]),
        impacts=impacts[: min(int(outcome.impact_count[0]), len(impacts))],
        contact_lost=contact_lost(motion, model.gravity),
        uplift_error=model.uplift_error,
        p=model.p,
        ends_at_limit=model.ends_at_limit,
        bound=model.bounds[int(marks[0, stepping.SIDE])] if marks[0, openings.REASON] == openings.BOUND else None,
        check=check_of(model.joints, marks[0], float(outcome.overturning_time[0])),
        apart=bool(marks[0, openings.REASON] == openings.APART) and not model.to_first_impact,
        unmeasured=bool(marks[0, openings.REASON] == openings.APART) and model.to_first_impact,
        slid=slid_of(model.sliding, slip, slips, time) if model.sliding is not None and slip is not None else None,
    )


def out_of_step(
    models: Sequence[Model],
    motions: Sequence[GroundMotion | None],
    rows: Reals,
    marks: Reals,
    tilts: Reals,
    *,
    rtol: float,
    most_impacts: int,
    threads: int | None = None,
) -> Bools:
    """Return for each run whether a column alone ends otherwise than the structure after a first impact, shape (n,).

    From the first impact of three or more columns under one beam, statics does not determine which of them carries it.
    The least favourable distribution leaves one without any load, so that it rocks alone. Where its outcome differs
    from that of the structure in step, the outcome is unknown from the first impact on.

    Parameters
    ----------
    models : sequence of Model
        Models of the runs; only those with models of columns alone are simulated again.
    motions : sequence of GroundMotion or None
        The ground motions.
    rows, marks : ndarray, shape (n, ...)
        Runs of the kernel, and what it found.
    tilts : ndarray, shape (n,)
        Signed rotation from which each run starts, over phi_cr.
    rtol, most_impacts, threads
        As in `respond_many`.
    """
    differs = np.zeros(len(rows), bool)
    structure_of_run = rows[:, kernels.STRUCTURE].astype(np.int64)
    for k, model in enumerate(models):
        mine = np.flatnonzero((structure_of_run == k) & (marks[:, stepping.IMPACTS] > 0))
        for column in model.columns if mine.size else ():
            there, column_marks = rows[mine].copy(), np.full((mine.size, stepping.MARKS), np.nan)
            there[:, kernels.STRUCTURE] = 0
            there[:, kernels.START] = [column.q(tilt) for tilt in tilts[mine].tolist()]
            for place, eta, of in zip((kernels.ETA_POSITIVE, kernels.ETA_NEGATIVE), column.eta, model.eta, strict=True):
                there[:, place] = np.clip(eta + there[:, place] - of, MIN_COLUMN_ETA, 1.0)  # `clip` keeps NaN
            deck = lay_out([column], motions)
            run = partial(run_deck, deck, there, column_marks, rtol=rtol, most_impacts=most_impacts)
            in_parts(run, len(there), COLUMNS_PER_TASK, threads, None)
            alone, whole = (
                read_marks(each, np.array([of.phi_cr]), np.array([of.reach]))
                for each, of in ((column_marks, column), (marks[mine], model))
            )
            differs[mine] |= alone.unknown | (alone.fell != whole.fell)
    return differs


def contact_lost(motion: GroundMotion | None, gravity: float) -> float | None:
    """Return the first time at which the vertical ground acceleration reaches -g [s], when the weight vanishes.

    Parameters
    ----------
    motion : GroundMotion or None
        The ground motion.
    gravity : float
        Acceleration of gravity [m/s2].

    Returns
    -------
    float or None
        The time; None if -g is never reached, or there is no vertical component.
    """
    if motion is None or motion.vertical is None:
        return None
    weight = gravity + motion.vertical.acceleration
    lost = np.flatnonzero(weight <= 0)
    if not lost.size:
        return None
    k = int(lost[0])
    if k == 0:
        return 0.0
    return motion.vertical.dt * float(k - 1 + weight[k - 1] / (weight[k - 1] - weight[k]))

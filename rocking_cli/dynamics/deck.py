"""Structures and ground motions as the arrays of the kernel, which runs any selection of them in one call."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil
from typing import TYPE_CHECKING, TypeVar

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Bools, Integers, Reals
from rocking_cli.dynamics import kernels, lanes, openings, stepping, ways
from rocking_cli.dynamics.calling import HISTORIES, LANES, STEPS, TIED
from rocking_cli.dynamics.joints import laid_out
from rocking_cli.dynamics.model import Model
from rocking_cli.dynamics.outcome import Outcome
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.names import FINEST_RTOL

if TYPE_CHECKING:
    from rocking_cli.dynamics.outcome import Outcomes

Number = TypeVar("Number", np.float64, np.int64)

NO_VALUES = np.empty(0)
RELEASE_DT = 0.005  # s, for a free motion without a record
MAX_IMPACTS = 20_000  # impacts after the record; with more, a structure is still rocking (eta = 0.999 takes 14,000)
NEVER_LIFTED = np.full(stepping.MARKS, np.nan)  # marks of a run that ends as it began, at rest
NEVER_LIFTED[[stepping.PEAK, stepping.PEAK + 1, stepping.IMPACTS, stepping.ENDED, stepping.SIDE]] = 0.0
NEVER_LIFTED[stepping.RATE_PEAK : stepping.RATE_PEAK + 2] = 0.0
NEVER_LIFTED[[openings.LARGEST, openings.LONGEST]] = 0.0
NEVER_LIFTED[stepping.STATUS] = kernels.AT_REST


def run_deck(
    deck: kernels.Deck,
    runs: Reals,
    marks: Reals,
    first: int = 0,
    stop: int | None = None,
    *,
    rtol: float,
    most_impacts: int = MAX_IMPACTS,
    samples: kernels.Samples | None = None,
) -> None:
    """Run the kernel; it fills `marks` and, if given, the samples of the last history.

    Without samples, a history ends as soon as its outcome is unknown.
    """
    run = ways.kernel(TIED if deck.forces.ndim == 4 else HISTORIES)
    brief = samples is None
    if samples is None:
        samples = kernels.Samples(1, NO_VALUES, NO_VALUES, np.empty((0, 3)), np.empty(stepping.MARKS))
    joint_count = int(deck.joints.sizes[:, 1].max(initial=0))
    room = kernels.Room(
        np.empty((2, stepping.COLUMNS)),
        np.empty((joint_count, openings.KEPT)),
        np.empty(openings.NOTES),
        np.empty(4 * joint_count, np.int64),
    )
    run(first, len(runs) if stop is None else stop, runs, deck, rtol, most_impacts, brief, samples, marks, room)


def fit_lanes(deck: kernels.Deck, runs: Reals) -> Bools:
    """Return the runs that lanes can follow: of structures with smooth forces, without vertical motion, shape (n,)."""
    if ways.lanes(STEPS) is None or deck.forces.ndim == 4:
        return np.zeros(len(runs), np.bool_)
    smooth = np.all(deck.numbers[:, :, stepping.PAIRS] > 0, axis=1)
    level = deck.records[:, kernels.V_SIZE] == 0
    structure, record = (runs[:, column].astype(np.int64) for column in (kernels.STRUCTURE, kernels.RECORD))
    return np.asarray(smooth[structure] & level[record])


def run_lanes(
    deck: kernels.Deck, runs: Reals, marks: Reals, first: int, stop: int, *, rtol: float, most_impacts: int
) -> None:
    """Run histories that fit lanes as `run_deck` does, with the same bits, several at a time."""
    joint_count = int(deck.joints.sizes[:, 1].max(initial=0))
    memory = lanes.Lanes(
        np.zeros(lanes.ROWS * lanes.LANES),
        np.zeros((lanes.LANES, lanes.INTEGERS), np.int64),
        np.zeros((lanes.LANES, lanes.REALS)),
        np.zeros((lanes.LANES, 2, stepping.COLUMNS)),
        np.zeros((lanes.LANES, joint_count, openings.KEPT)),
        np.zeros((lanes.LANES, openings.NOTES)),
        np.zeros((lanes.LANES, 4 * joint_count), np.int64),
    )
    samples = kernels.Samples(1, NO_VALUES, NO_VALUES, np.empty((0, 3)), np.empty(stepping.MARKS))
    pairs = int(deck.numbers[runs[first:stop, kernels.STRUCTURE].astype(np.int64), :, stepping.PAIRS].max())
    prepare = ways.lanes(STEPS)
    assert prepare is not None
    step, alive = prepare(memory.rows, pairs, rtol)
    ways.kernel(LANES)(first, stop, runs, deck, step, pairs, rtol, most_impacts, True, samples, marks, memory)
    del alive  # the arguments of the step, until here


def check_rtol(rtol: float) -> None:
    """Raise `InputError` if the relative error of a step is out of range."""
    if not FINEST_RTOL <= rtol < 1:
        raise InputError(f"rtol must be at least {FINEST_RTOL:g} and below 1, got {rtol:g}: rounding allows no less")


@np.errstate(over="ignore", invalid="ignore")  # what is beyond the range of numbers is left to the kernel
def never_lifts(deck: kernels.Deck, runs: Reals) -> Bools:
    """Return the runs that end at rest without uplift, and without a joint that fails, shape (n,).

    The kernel passes over a record while `stays` and `steady` hold at its samples. Both bound u_g'', and rounding keeps
    the order of products: they hold at all samples if they hold at the extreme ones, in the same arithmetic. Runs with
    a vertical component or a release are left to the kernel.
    """
    structure, record = (runs[:, column].astype(np.int64) for column in (kernels.STRUCTURE, kernels.RECORD))
    size, slender = runs[:, kernels.SIZE], runs[:, kernels.SLENDER]
    places = deck.records[:, [kernels.U_FIRST, kernels.U_SIZE]].astype(np.int64)
    samples = [deck.u[first : first + count] for first, count in places]
    extremes = np.array([[each.min(initial=0.0), each.max(initial=0.0)] for each in samples])
    push = extremes.T[:, record] * (runs[:, kernels.FACTOR] / size)
    low, high = np.minimum(*push), np.maximum(*push)
    gravity, *_, steady_from, steady_to = deck.joints.numbers.T[:, structure]
    weight = deck.numbers[:, 0, stepping.GRAVITY][structure] / size
    to_left, to_right = deck.numbers[:, :, stepping.LAMBDA].T[:, structure] * (weight * (1 + kernels.MARGIN))
    stays = (-to_left <= low) & (high <= to_right)
    low, high = low / (weight / gravity), high / (weight / gravity)
    steady = (steady_from <= np.minimum(low, low * slender)) & (np.maximum(high, high * slender) <= steady_to)
    unchecked = deck.joints.sizes[structure, 1] == 0
    level = (runs[:, kernels.START] == 0) & (deck.records[record, kernels.V_SIZE] == 0)
    return np.asarray(level & stays & (steady | unchecked))


def read_marks(marks: Reals, phi_cr: Reals, reach: Reals) -> Outcomes:
    """Return the outcomes of runs from the marks of the kernel.

    Parameters
    ----------
    marks : ndarray, shape (n, MARKS)
        Marks of the finished runs, as the kernel fills them; NaN for a run that was never computed.
    phi_cr : ndarray, shape (n, 2)
        Critical rotations of the positive and the negative direction [rad].
    reach : ndarray, shape (n,)
        Displacement by which openings of joints are divided [m]; NaN if the joints are not known.
    """
    status = marks[:, stepping.STATUS]
    passed, crossed = marks[:, openings.PASSED], marks[:, stepping.CROSSED]
    # A structure past its critical rotation for good has overturned, whatever joint opens later.
    overturned = (status == kernels.OVERTURNED) & ~(passed < np.where(np.isnan(crossed), np.inf, crossed))
    failed = (status == kernels.STALLED) | np.isnan(status)
    unknown = np.isfinite(passed) & ~overturned & ~failed
    fell_to = np.where(overturned, 1 - 2 * marks[:, stepping.SIDE], 0).astype(np.int64)
    peaks = np.take_along_axis(
        marks, np.where(unknown[:, None], openings.PASSED_PEAK, stepping.PEAK) + np.arange(2), axis=1
    )
    end = np.where(unknown, passed, np.where(overturned & ~np.isnan(crossed), crossed, np.inf))
    warned = np.where(marks[:, openings.WARNED] <= end, marks[:, openings.WARNED], np.nan)
    ratio = np.maximum(*(peaks / phi_cr).T)
    bound = np.maximum(*(marks[:, openings.WARNED_PEAK : openings.WARNED_PEAK + 2] / phi_cr).T)
    uplift = marks[:, stepping.FIRST_UPLIFT]
    impacts = np.where(unknown, marks[:, openings.PASSED_IMPACTS], marks[:, stepping.IMPACTS])
    return Outcome(
        still_rocking=(status == kernels.STILL_ROCKING) & ~unknown,
        failed=failed,
        fell_to=fell_to,
        peak_positive=np.where(fell_to == 1, np.nan, peaks[:, 0]),
        peak_negative=np.where(fell_to == -1, np.nan, peaks[:, 1]),
        peak_ratio=np.where(overturned, np.nan, ratio),
        peak_rate_positive=np.where(fell_to == 1, np.nan, marks[:, stepping.RATE_PEAK]),
        peak_rate_negative=np.where(fell_to == -1, np.nan, marks[:, stepping.RATE_PEAK + 1]),
        overturning_time=np.where(overturned, marks[:, stepping.CROSSED], np.nan),
        uplift_time=np.where(unknown & (uplift > passed), np.nan, uplift),
        impact_count=np.nan_to_num(impacts).astype(np.int64),
        end_time=np.where(unknown, np.nan, marks[:, stepping.ENDED]),
        unknown=unknown,
        known_to=np.where(unknown, passed, np.nan),
        warned=warned,
        lower_bound=np.where(np.isnan(warned), np.where(unknown, ratio, np.nan), bound),
        opening=marks[:, openings.LARGEST] / reach,
        by_blocks=np.zeros(len(marks), np.bool_),
        slip=np.zeros(len(marks)),
        off_edge=np.zeros(len(marks), np.bool_),
    )


def lay_out(models: Sequence[Model], motions: Sequence[GroundMotion | None]) -> kernels.Deck:
    """Return models and ground motions (None: no ground motion) as the arrays of the kernel."""
    structures, records = [], []
    cells = 0
    for model in models:
        structures.append((cells, len(model.forces), model.is_linear))
        cells += len(model.forces)
    us, vs, aheads, blocks, v_aheads, v_aboves = _Row(), _Row(), _Row(), _Row(), _Row(), _Row()
    any_vertical = any(motion is not None and motion.vertical is not None for motion in motions)
    tied = any_vertical and any(len(model.held) for model in models)
    for motion in motions:
        up = motion.vertical if motion is not None else None
        u, dt = (motion.acceleration, motion.dt) if motion is not None else (NO_VALUES, RELEASE_DT)
        v, v_dt = (up.acceleration, up.dt) if up is not None else (NO_VALUES, 1.0)
        length = max(u.size, ceil((v.size - 1) * v_dt / dt) + 1)
        ahead = _strongest_to_come(np.abs(u), 1.0, length)
        places = (*us.add(u), *vs.add(v), *aheads.add(ahead), *blocks.add(_strongest_in_blocks(np.abs(u))))
        if any_vertical:
            for row, strength in ((v_aheads, -v), (v_aboves, v)):  # downward and upward ground acceleration
                row.add(_strongest_to_come(np.maximum(strength, 0.0), dt / v_dt, length))
        records.append((*places, dt, v_dt))
    return kernels.Deck(
        np.array(structures, dtype=np.int64),
        np.array([model.numbers for model in models]),
        _joined([_three_forces(model) if tied else model.forces for model in models]),
        np.array([model.smooth for model in models]),
        _joined([model.angles for model in models]),
        _joined([model.certain for model in models]),
        _joined([model.held[..., 4] if len(model.held) else np.zeros(model.forces.shape[:2]) for model in models])
        if tied
        else np.empty((0, 2)),
        _corners(models),
        np.array(records),
        us.joined(),
        vs.joined(),
        aheads.joined(),
        blocks.joined(),
        v_aheads.joined(),
        v_aboves.joined(),
        openings.Joints(*laid_out([model.joints for model in models])),
    )


def _three_forces(model: Model) -> Reals:
    """Return the forces of a model, followed by the part of them that vertical motion leaves unchanged."""
    cells = len(model.forces)
    held = model.held[..., :4] if len(model.held) else np.zeros((cells, 2, 4))
    return np.concatenate([model.forces.reshape(cells, 2, 2, 4), held[:, :, None, :]], axis=2)


def _corners(models: Sequence[Model]) -> Integers:
    """Return the number of corners below each cell for all models; an array without rows if no model has any."""
    if not any(len(model.corners) for model in models):
        return np.zeros((0, 2), np.int64)
    alone = (np.zeros((len(model.forces), 2), np.int64) for model in models)
    return _joined([model.corners if len(model.corners) else no for model, no in zip(models, alone, strict=True)])


class _Row:
    """Array that grows as other arrays are joined to its end."""

    def __init__(self) -> None:
        self.arrays: list[Reals] = []
        self.size = 0

    def add(self, array: Reals) -> tuple[int, int]:
        """Add an array to the end; return its start and its size."""
        self.arrays.append(array)
        self.size += array.size
        return self.size - array.size, array.size

    def joined(self) -> Reals:
        return _joined(self.arrays or [NO_VALUES])


def _strongest_to_come(strength: Reals, stride: float, length: int) -> Reals:
    """Return the largest strength after each of `length` samples; zero at and after the last.

    These samples are `stride` samples of `strength` apart.
    """
    result = np.zeros(length)
    if strength.size:
        ahead = np.maximum.accumulate(strength[::-1])[::-1]
        ahead[-1] = 0.0
        if stride == 1:
            result[: ahead.size] = ahead
        else:
            places = np.floor(np.arange(length) * stride).astype(np.int64)
            result = ahead[np.minimum(places, ahead.size - 1)]
    return result


def _strongest_in_blocks(strength: Reals) -> Reals:
    """Return the largest strength of every `BLOCK` samples together with the next one."""
    starts = np.arange(0, strength.size, kernels.BLOCK)
    if not starts.size:
        return NO_VALUES
    first_of_next = np.append(strength[starts[1:]], 0.0)
    return np.asarray(np.maximum(np.maximum.reduceat(strength, starts), first_of_next))


def _joined(arrays: Sequence[NDArray[Number]]) -> NDArray[Number]:
    only = arrays[0] if len(arrays) == 1 else np.concatenate(arrays)
    # The kernels are compiled for writable arrays, and those of a motion are read-only.
    return np.ascontiguousarray(only) if only.flags.writeable else only.copy()

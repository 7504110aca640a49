"""The runs of a structure, counted while they are read: what a study keeps of them does not grow with its runs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from copy import deepcopy
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rocking_cli.studies.fragility.definition import OVERTURNING, SLIDING, Limit
from rocking_cli.studies.fragility.displacements import kept
from rocking_cli.studies.fragility.intensity import of_the_motion, proportional
from rocking_cli.studies.fragility.likelihood import Bools, Integers, Reals
from rocking_cli.studies.fragility.plan import Plan
from rocking_cli.studies.fragility.store import FAILED, STANDS, Endings, Store
from rocking_cli.studies.fragility.study import RESTITUTION

Places = NDArray[np.int32]
UNSEEN = float(np.finfo(np.float64).max)
"""The peak of a run of unknown outcome: more than any that was seen, less than that of one that overturns."""
ROUNDING = 1e-9  # of a rotation
Counted = Callable[[int], None]
"""Called with how many numbers of runs have been looked at since the last call."""


@dataclass(frozen=True, eq=False)
class Tally:
    """How many runs of a structure there are, and how many exceed, under each record at each level.

    Parameters
    ----------
    plan : Plan
        The study's runs.
    samples : range
        The places of the structure's samples.
    runs : ndarray of int, shape (s, records, levels)
        How many can be used, of each sample; of all together (s is 1) where the measures do not tell them apart.
    exceeding : dict of limit state to ndarray of int, shape (s, records, levels)
        How many of them exceed, if all do of which it is not known.
    ladders : Ladders or None
        Where each ladder of levels first exceeds; of incremental dynamic analysis.
    unknown : int
        How many runs are of unknown outcome.
    checked : bool
        Whether the joints of all runs are known; if not, none is said to be unknown for what they do.
    lower : Tally or None
        The same runs, of which only those exceed that are known to; None if no outcome is unknown.
    """

    plan: Plan
    samples: range
    runs: Integers
    exceeding: dict[Limit, Integers]
    ladders: Ladders | None
    unknown: int = 0
    checked: bool = True
    lower: Tally | None = None

    @property
    def unknown_if_checked(self) -> int | None:
        """How many runs are of unknown outcome; None if that is none, and not all joints are known."""
        return self.unknown if self.unknown or self.checked else None

    def one(self, record: Integers) -> Integers:
        """The record that each is one with: the same may be in the sets of several levels."""
        return np.asarray(self.plan.of_sets.one[record])

    def weight(self, record: Integers) -> Reals | None:
        """Weight of each run; None if all weights are equal."""
        sets = self.plan.of_sets
        return np.asarray(sets.weight[record]) if sets.weighted else None

    def over(self, *measures: str) -> Cells:
        """The cells of runs that are alike in some measures, without the empty ones."""
        together = not any(_differs_between_samples(self.plan, self.samples, measure) for measure in measures)
        runs = self.runs.sum(axis=0, keepdims=True) if together else self.runs
        there = np.nonzero(runs)
        return Cells(self, there, runs[there], together)

    def decided_by_level(self, measure: str) -> bool:
        """Whether all runs of a level have one intensity: whatever was scaled to it, and drawn of the structure."""
        if measure == self.plan.measure:
            return True
        return proportional(measure, self.plan.measure) and not _drawn_otherwise(self.plan, self.samples)


@dataclass(frozen=True, eq=False)
class Ladders:
    """Runs that differ in their level alone, for each sample, record, restitution and polarity.

    Parameters
    ----------
    first : dict of limit state to ndarray of int, shape (samples, records, etas, polarities)
        The level at which each first exceeds; the number of levels if it does not.
    there : ndarray of bool, shape (samples, records, etas, levels, polarities)
        The runs that can be used.
    """

    first: dict[Limit, Places]
    there: Bools

    def below(self, limit: Limit) -> Integers:
        """The last level of each ladder that does not exceed, before the first that does; -1 if there is none."""
        levels = np.arange(self.there.shape[3])[:, None]
        lower = self.there & (levels < self.first[limit][..., None, :])
        return np.asarray(np.where(lower, levels, -1).max(axis=3))

    def above(self, limit: Limit) -> Integers:
        """How many runs of each sample, record and level are at the first that exceeds or above it."""
        levels = np.arange(self.there.shape[3])[:, None]
        return np.asarray((self.there & (levels >= self.first[limit][..., None, :])).sum(axis=(2, 4)))


@dataclass(frozen=True, eq=False)
class Cells:
    """Runs that are alike, counted: those of one record, level and, where it matters, sample.

    Parameters
    ----------
    tally : Tally
        What they are of.
    place : tuple of ndarray of int, each of shape (n,)
        Which sample of the structure, record and level each cell is of; where samples are together the first stands for
        all.
    runs : ndarray of int, shape (n,)
        How many there are.
    together : bool
        Whether samples are.
    """

    tally: Tally
    place: tuple[Integers, ...]
    runs: Integers
    together: bool

    @property
    def record(self) -> Integers:
        """The record of each."""
        return self.place[1]

    @property
    def level(self) -> Integers:
        """The level of each."""
        return self.place[2]

    def of(self, table: Integers) -> Integers:
        """Look up the entries of the cells in a table indexed by sample, record and level."""
        summed = table.sum(axis=0, keepdims=True) if self.together else table
        return np.asarray(summed[self.place])

    def exceeding(self, limit: Limit) -> Integers:
        """How many runs of each exceed."""
        return self.of(self.tally.exceeding[limit])

    def intensities(self, measure: str) -> Reals:
        """The intensity of each."""
        return intensities(self.tally.plan, measure, self.place[0] + self.tally.samples.start, self.record, self.level)


def intensities(plan: Plan, measure: str, sample: Integers, record: Integers, level: Integers) -> Reals:
    """The intensity of runs; where the levels are of it, to the last digit."""
    if measure == plan.measure:
        return np.asarray(np.array(plan.levels)[level])
    return plan.intensities(measure, sample, record, level, plan.factors(sample, record, level))


def samples_of(plan: Plan, structure: str) -> range:
    """The places of a structure's samples."""
    places = [k for k, trial in enumerate(plan.trials) if trial.structure == structure]
    return range(places[0], places[-1] + 1)


def count(
    store: Store,
    plan: Plan,
    structure: str,
    limits: Sequence[Limit],
    measures: Sequence[str],
    *,
    ladders: bool = False,
    counted: Counted = lambda numbers: None,
) -> Tally:
    """Count the finished runs of a structure.

    Parameters
    ----------
    store : Store
        Open to read.
    plan : Plan
        Its runs.
    structure : str
        Which structure.
    limits : sequence of limit states
        What is asked of the runs.
    measures : sequence of str
        Measures in which their intensities will be requested; `Tally.over` gives no others.
    ladders : bool
        Whether to find where ladders of levels first exceed.
    counted : callable, optional
        Told how far it is.
    """
    samples = samples_of(plan, structure)
    reach = {limit: table[samples.start : samples.stop] for limit, table in kept(store.fact, limits).items()}
    trials = plan.trials[samples.start : samples.stop]
    phi_cr = np.array([(each.phi_cr_positive, each.phi_cr_negative) for each in trials])
    _, records, etas, levels, polarities = plan.shape
    apart = any(_differs_between_samples(plan, samples, measure) for measure in measures)
    shape = (len(samples) if apart else 1, records, levels)
    runs, unknown = np.zeros(shape, dtype=np.int64), 0
    there = np.zeros((len(samples), records, etas, levels, polarities) if ladders else 0, dtype=bool)
    rungs = (len(samples), records, etas, polarities)
    upper, lower = _Counts(limits, shape, rungs if ladders else None, levels), None
    checked = True
    each = records * plan.block
    start = samples.start * each
    for found in store.endings(start, samples.stop * each, counted):
        found = found.select(found.outcome != FAILED)
        sample, record, eta, level, polarity = plan.places(found.id)
        sample = sample - samples.start
        cell = np.ravel_multi_index((sample if apart else np.zeros_like(sample), record, level), shape)
        ladder = np.ravel_multi_index((sample, record, eta, polarity), rungs)
        _add(runs, cell)
        if ladders:
            there.ravel()[found.id - start] = True
        checked &= bool(found.checked.all())
        doubtful = int(found.unknown.sum())
        unknown += doubtful
        if doubtful and lower is None:  # so far the two are the same
            lower = deepcopy(upper)
        for limit in limits:
            rotations = reach[limit][sample] if limit in reach else None
            upper.add(limit, exceeds(found, limit, rotations), cell, ladder, level)
            if lower is not None:
                known = known_to_exceed(found, limit, rotations, phi_cr[sample])
                lower.add(limit, known, cell, ladder, level)

    def tally(counts: _Counts, of_known: Tally | None) -> Tally:
        found = Ladders(counts.first, there) if ladders else None
        return Tally(plan, samples, runs, counts.exceeding, found, unknown, checked, of_known)

    checked |= store.fact("description")["model"] != "nonlinear"  # of an equivalent block there are no joints
    return tally(upper, tally(lower, None) if lower is not None else None)


class _Counts:
    """How many runs exceed, and where ladders first do, while they are counted; see `Tally` and `Ladders`."""

    def __init__(
        self, limits: Sequence[Limit], shape: tuple[int, ...], rungs: tuple[int, ...] | None, levels: int
    ) -> None:
        self.exceeding = {limit: np.zeros(shape, dtype=np.int64) for limit in limits}
        self.first = {limit: np.full(rungs, levels, dtype=np.int32) for limit in limits if rungs is not None}

    def add(self, limit: Limit, beyond: Bools, cell: Integers, ladder: Integers, level: Integers) -> None:
        """Count the runs of a block that exceed a limit state."""
        _add(self.exceeding[limit], cell[beyond])
        if self.first:
            np.minimum.at(self.first[limit].ravel(), ladder[beyond], level[beyond].astype(np.int32))


def exceeds(found: Endings, limit: Limit, reach: Reals | None = None) -> Bools:
    """Return which runs exceed a limit state, or may: of unknown outcome, all that are not known to.

    Parameters
    ----------
    found : Endings
        n runs.
    limit : limit state
        Which.
    reach : ndarray, shape (n, 2), optional
        Of a displacement, the rotations of each run [rad].
    """
    return np.asarray(found.unknown | _exceeds(found, limit, reach, found.peak_ratio))


def known_to_exceed(found: Endings, limit: Limit, reach: Reals | None, phi_cr: Reals) -> Bools:
    """Return which runs are known to exceed a limit state: of unknown outcome, by what was seen of them.

    That is uplift, a first slip, or the peak until the first joint would not bear.

    Parameters
    ----------
    found, limit, reach
        See `exceeds`.
    phi_cr : ndarray, shape (n, 2)
        Critical rotations of each run [rad].
    """
    known = _exceeds(found, limit, reach, np.where(found.unknown, found.lower_bound, found.peak_ratio))
    if reach is None:
        return known
    # The bound is of one direction, which must have come as far later on, too.
    bound = found.lower_bound[:, None] * phi_cr
    with np.errstate(invalid="ignore"):
        could = found.peaks >= bound * (1 - ROUNDING)
        surely = (bound > reach) | ~could
    return np.asarray(np.where(found.unknown, could.any(axis=1) & surely.all(axis=1), known))


def _exceeds(found: Endings, limit: Limit, reach: Reals | None, ratio: Reals) -> Bools:
    """Whether runs exceed a limit state, by their peaks over phi_cr if it is a ratio."""
    if limit == SLIDING:
        return found.slides
    overturned = found.overturned
    if reach is not None:
        return np.asarray(overturned | (found.peaks > reach).any(axis=1))  # NaN, where it overturned, exceeds nothing
    if isinstance(limit, str):
        return overturned if limit == OVERTURNING else found.uplifts
    with np.errstate(invalid="ignore"):
        return np.asarray(overturned | (ratio > limit))


def peaks(store: Store, plan: Plan, structure: str) -> Reals:
    """Peak phi/phi_cr of each ladder that is complete, shape (m, levels); NaN where it overturns.

    Infinite where the outcome is unknown.
    """
    table = endings_of(store, plan, structure)
    ladders = np.moveaxis(table, 3, -1).reshape(-1, table.shape[3])
    complete = ladders[~np.isnan(ladders).any(axis=1)]
    return np.where(np.isinf(complete), np.nan, np.where(complete == UNSEEN, np.inf, complete))


def endings_of(store: Store, plan: Plan, structure: str) -> Reals:
    """How the runs of a structure end, shape (samples, records, etas, levels, polarities).

    The peak phi/phi_cr; 0 without uplift, infinite where it overturns, `UNSEEN` where the outcome is unknown, NaN where
    no run is that could be followed.
    """
    samples = samples_of(plan, structure)
    table = np.full((len(samples), *plan.shape[1:]), np.nan)
    start = samples.start * len(plan.records) * plan.block
    for found in store.endings(start, start + table.size):
        found = found.select(found.outcome != FAILED)
        rocks = np.where(found.uplifts, np.maximum(found.peak_ratio, np.finfo(np.float64).tiny), 0.0)
        ends = np.where(found.unknown, UNSEEN, np.inf)
        table.ravel()[found.id - start] = np.where(found.outcome == STANDS, rocks, ends)
    return table


def _differs_between_samples(plan: Plan, samples: range, measure: str) -> bool:
    """Whether samples under one record at one level differ in a measure."""
    of_motion = of_the_motion(measure) and of_the_motion(plan.measure)
    return measure != plan.measure and not of_motion and _drawn_otherwise(plan, samples)


def _drawn_otherwise(plan: Plan, samples: range) -> bool:
    """Whether samples differ in more than their restitution, so that one motion is not one intensity for all."""
    return any(set(plan.trials[k].drawn) - {RESTITUTION} for k in samples)


def _add(table: Integers, cell: Integers) -> None:
    """Count cells into a table; those of one call lie together in it."""
    if cell.size:
        low = int(cell.min())
        found = np.bincount(cell - low)
        table.ravel()[low : low + found.size] += found

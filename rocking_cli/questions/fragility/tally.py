"""Counts of the runs of a structure, made while runs are read, so that memory does not increase with their number.

Thresholds of a structure are the PGA at which it uplifts, and the rotations at which its top has moved a distance.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import isclose
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Bools, Integers, Reals
from rocking_cli.core import Direction, Mechanism, both_statics, equivalent_block
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.processing.intensity import parse_measure
from rocking_cli.questions.fragility.definition import OVERTURNING, RESTITUTION, SLIDING, UPLIFT, Definition, Limit
from rocking_cli.questions.fragility.observed import INTENSITY_TOLERANCE
from rocking_cli.questions.fragility.plan import Plan, Trial
from rocking_cli.questions.fragility.store import FAILED, STANDS, RunRows, Store
from rocking_cli.questions.fragility.study import Sample, Study
from rocking_cli.studies.fragility.quantities import PGA, displacement_limits, kept, metres, of_the_motion, proportional
from rocking_cli.studies.movements import is_held, top
from rocking_cli.studies.under_pulses import uplift

Places = NDArray[np.int32]
UNKNOWN_PEAK = float(np.finfo(np.float64).max)
"""Peak of a run of unknown outcome, for sorting: above every known peak, below that of overturning runs."""
ROTATION_TOLERANCE = 1e-9  # relative difference of rotations that counts as rounding
Counted = Callable[[int], None]
"""Called with the number of run numbers examined since the last call."""


@dataclass(frozen=True, eq=False)
class Tally:
    """Number of runs of a structure, and of those that exceed limit states, under each record at each level.

    Parameters
    ----------
    plan : Plan
        The plan of the study's runs.
    samples : range
        Indices of the structure's samples.
    runs : ndarray of int, shape (s, records, levels)
        Number of usable runs of each sample; of all samples together (s is 1) if the measures do not differ between
        them.
    exceeding : dict of limit state to ndarray of int, shape (s, records, levels)
        Number of these runs that exceed, with undecided runs counted as exceeding.
    ladders : Ladders or None
        The level at which each ladder first exceeds; only in incremental dynamic analysis.
    unknown : int
        Number of runs of unknown outcome.
    checked : bool
        Whether the joints of all runs are known; if not, no outcome is unknown because of a joint.
    by_blocks, off_edge : int
        Number of runs that were simulated with free blocks, and of those in which a block falls off an edge.
    slides : bool
        Whether a body only slides in some run: it may then exceed displacements without uplift.
    finished, failed : int
        Number of all runs in the store, and of those that could not be simulated.
    lower : Tally or None
        The counts with undecided runs as not exceeding; None if no outcome is unknown.
    uplift : (float or None, float or None), optional
        Uplift accelerations over g of both directions, if the PGA of the motions decides whether they uplift.
    """

    plan: Plan
    samples: range
    runs: Integers
    exceeding: dict[Limit, Integers]
    ladders: Ladders | None
    unknown: int = 0
    checked: bool = True
    by_blocks: int = 0
    off_edge: int = 0
    slides: bool = False
    finished: int = 0
    failed: int = 0
    lower: Tally | None = None
    uplift: Pair | None = None

    @property
    def least(self) -> Tally:
        """The counts with undecided runs as not exceeding; these ones if no outcome is unknown."""
        return self.lower or self

    @property
    def usable(self) -> int:
        """Number of runs that can be used."""
        return int(self.runs.sum())

    @property
    def unknown_if_checked(self) -> int | None:
        """Number of runs of unknown outcome; None if there are none because joints were not checked."""
        return self.unknown if self.unknown or self.checked else None

    @property
    def unknown_share(self) -> float | None:
        """Share of the usable runs that have an unknown outcome; None if nothing was checked."""
        return None if self.unknown_if_checked is None else self.unknown / self.usable

    def clusters(self, record: Integers) -> tuple[Integers, Reals | None]:
        """Return the cluster and the weight of each run, from its record; no weights if all are equal.

        Sets of several levels may share a record: the cluster is the first entry that is the same record.
        """
        sets = self.plan.sets
        return np.asarray(sets.one[record]), np.asarray(sets.weight[record]) if sets.weighted else None

    def over(self, *measures: str) -> Cells:
        """Return the non-empty cells of runs that have the same intensity in some measures."""
        together = not any(_differs_between_samples(self.plan, self.samples, measure) for measure in measures)
        runs = self.runs.sum(axis=0, keepdims=True) if together else self.runs
        there = np.nonzero(runs)
        return Cells(self, there, runs[there], together)

    def add(self, limit: Limit, beyond: Bools, cell: Integers, ladder: Integers, level: Integers) -> None:
        """Count the runs of a block that exceed a limit state, given the cell, the ladder and the level of each run."""
        _add(self.exceeding[limit], cell[beyond])
        if self.ladders is not None:
            np.minimum.at(self.ladders.first[limit].ravel(), ladder[beyond], level[beyond].astype(np.int32))

    def decided_by_level(self, measure: str) -> bool:
        """Return whether all runs of a level have the same intensity in a measure."""
        if measure == self.plan.measure:
            return True
        return proportional(measure, self.plan.measure) and not _drawn_otherwise(self.plan, self.samples)


@dataclass(frozen=True, eq=False)
class Ladders:
    """Ladders: for each sample, record, restitution and polarity, the runs that differ only in their level.

    Parameters
    ----------
    first : dict of limit state to ndarray of int, shape (samples, records, etas, polarities)
        Index of the level at which the ladder first exceeds; the number of levels if it never does.
    there : ndarray of bool, shape (samples, records, etas, levels, polarities)
        The runs that can be used.
    """

    first: dict[Limit, Places]
    there: Bools

    def below(self, limit: Limit) -> Integers:
        """Return the last level of each ladder that does not exceed, below the first that does; -1 if there is none."""
        levels = np.arange(self.there.shape[3])[:, None]
        lower = self.there & (levels < self.first[limit][..., None, :])
        return np.asarray(np.where(lower, levels, -1).max(axis=3))

    def above(self, limit: Limit) -> Integers:
        """Return the number of runs of each sample, record and level at or above the first level that exceeds."""
        levels = np.arange(self.there.shape[3])[:, None]
        return np.asarray((self.there & (levels >= self.first[limit][..., None, :])).sum(axis=(2, 4)))


class Onset(NamedTuple):
    """Intensity up to which no motion uplifts a structure, and whether every motion uplifts it beyond."""

    at: float
    exact: bool


@dataclass(frozen=True, eq=False)
class Cells:
    """Cells of equal runs: those of one record, one level and, if samples differ, one sample.

    Parameters
    ----------
    tally : Tally
        The counts from which the cells are made.
    place : tuple of ndarray of int, each of shape (n,)
        Indices of sample, record and level of each cell; if samples are counted together, the first stands for all.
    runs : ndarray of int, shape (n,)
        Number of runs in each cell.
    together : bool
        Whether samples are counted together.
    """

    tally: Tally
    place: tuple[Integers, ...]
    runs: Integers
    together: bool

    @property
    def record(self) -> Integers:
        """Index of the record of each cell."""
        return self.place[1]

    @property
    def level(self) -> Integers:
        """Index of the level of each cell."""
        return self.place[2]

    def only(self, which: Bools) -> Cells:
        """Return some of the cells."""
        return replace(self, place=tuple(each[which] for each in self.place), runs=self.runs[which])

    def of(self, table: Integers) -> Integers:
        """Look up the entries of the cells in a table indexed by sample, record and level."""
        summed = table.sum(axis=0, keepdims=True) if self.together else table
        return np.asarray(summed[self.place])

    def intensities(self, measure: str) -> Reals:
        """Return the intensity of each cell in a measure."""
        return self._intensities(measure, *self.place)

    def _intensities(self, measure: str, sample: Integers, record: Integers, level: Integers) -> Reals:
        """Return the intensity of runs; exactly the level if the levels are of this measure."""
        plan = self.tally.plan
        if measure == plan.measure:
            return np.asarray(np.array(plan.levels)[level])
        sample = sample + self.tally.samples.start
        return plan.intensities(measure, sample, record, level, plan.factors(sample, record, level))

    def capacities(self, ladders: Ladders, limit: Limit, measure: str) -> tuple[Reals, Reals, Integers]:
        """Return the bounds of the capacity of each ladder, 0 or infinity if no level bounds it, and its record."""
        first, last, levels = ladders.first[limit], ladders.below(limit), len(self.tally.plan.levels)
        known = (first < levels) | (last >= 0)  # a ladder without a simulated run gives no information
        sample, record, _, _ = np.nonzero(known)
        sample = np.zeros_like(sample) if self.together else sample
        last, first = last[known], first[known].astype(np.int64)
        at_last = self._intensities(measure, sample, record, np.clip(last, 0, levels - 1))
        at_first = self._intensities(measure, sample, record, np.clip(first, 0, levels - 1))
        lower, upper = np.where(last >= 0, at_last, 0.0), np.where(first < levels, at_first, np.inf)
        sound = lower < upper  # otherwise the peak decreases with the level, or is unknown
        return lower[sound], upper[sound], record[sound]

    def onset(self, measure: str) -> Onset | None:
        """Return the intensity at which the structure uplifts: PGA, or PGA over the uplift acceleration.

        None if that is not known over this measure, or if runs contradict it.
        """
        plan, pair, parsed = self.tally.plan, self.tally.uplift, parse_measure(measure)
        if pair is None or str(parsed.base) != PGA or parsed.power != 1:
            return None
        usable = [k for k in self.tally.samples if plan.trials[k].reason is None]
        accelerations = plan.mechanics[usable, 1] * plan.mechanics[usable, 2]
        # If the accelerations differ, the uplift depends on a property that varies, and there is no single onset.
        if np.ptp(accelerations) > INTENSITY_TOLERANCE * accelerations.max():
            return None
        pga = accelerations[:1] / STANDARD_GRAVITY
        at = float(parsed.relative(pga, plan.reference(np.array(usable[:1])))[0])
        one, other = pair
        exact = one is not None and other is not None and isclose(one, other, rel_tol=INTENSITY_TOLERANCE)
        if UPLIFT in self.tally.exceeding:
            x, uplifted = self.intensities(measure), self.of(self.tally.exceeding[UPLIFT])
            early = (x < at * (1 - INTENSITY_TOLERANCE)) & (uplifted > 0)
            late = (x > at * (1 + INTENSITY_TOLERANCE)) & (uplifted < self.runs)
            if early.any() or (exact and late.any()):
                return None
        return Onset(at, exact)


def samples_of(plan: Plan, structure: str) -> range:
    """Return the indices of a structure's samples."""
    places = [k for k, trial in enumerate(plan.trials) if trial.structure == structure]
    return range(places[0], places[-1] + 1)


def count(
    store: Store, plan: Plan, structure: str, definition: Definition, counted: Counted = lambda numbers: None
) -> Tally:
    """Count the finished runs of a structure.

    Parameters
    ----------
    store : Store
        Open to read.
    plan : Plan
        The plan of its runs.
    structure : str
        Name of the structure.
    definition : Definition
        The definition of its study: the limit states to count, and the measures in which intensities will be requested,
        as `Tally.over` gives no others; by incremental dynamic analysis, also the level at which each ladder exceeds.
    counted : callable, optional
        Called with the number of runs read since the last call.
    """
    measures = [*definition.fitted_measures, *(one for pair in definition.bivariate for one in pair)]
    limits, ladders, samples = definition.limit_states, definition.method == "ida", samples_of(plan, structure)
    reach = {limit: table[samples.start : samples.stop] for limit, table in kept(store.facts, limits).items()}
    trials = plan.trials[samples.start : samples.stop]
    phi_cr = np.array([(each.phi_cr_positive, each.phi_cr_negative) for each in trials])
    _, records, etas, levels, polarities = plan.shape
    apart = any(_differs_between_samples(plan, samples, measure) for measure in measures)
    shape = (len(samples) if apart else 1, records, levels)
    rungs = (len(samples), records, etas, polarities)
    runs = np.zeros(shape, dtype=np.int64)
    there = np.zeros((len(samples), records, etas, levels, polarities) if ladders else 0, dtype=bool)

    def empty() -> Tally:
        first = {limit: np.full(rungs, levels, dtype=np.int32) for limit in (limits if ladders else ())}
        exceeding = {limit: np.zeros(shape, dtype=np.int64) for limit in limits}
        return Tally(plan, samples, runs, exceeding, Ladders(first, there) if ladders else None)

    upper, lower, many, checked, slides = empty(), empty(), Counter[str](), True, False
    start = samples.start * records * plan.block
    for rows in store.rows(start, samples.stop * records * plan.block, counted):
        endings = rows.select(rows.outcome != FAILED)
        sample, record, eta, level, polarity = plan.places(endings.run)
        sample = sample - samples.start
        cell = np.ravel_multi_index((sample if apart else np.zeros_like(sample), record, level), shape)
        ladder = np.ravel_multi_index((sample, record, eta, polarity), rungs)
        _add(runs, cell)
        if ladders:
            there.ravel()[endings.run - start] = True
        checked &= bool((np.isfinite(endings.opening) | endings.by_blocks).all())  # free blocks move in every joint
        slides |= bool((endings.slip > 0).any())
        many.update({name: int(getattr(endings, name).sum()) for name in ("unknown", "by_blocks", "off_edge")})
        many.update(finished=len(rows), failed=rows.failed)
        for limit in limits:
            rotations = reach[limit][sample] if limit in reach else None
            beyond = surely = exceeds(endings, limit, rotations)
            if endings.unknown.any():
                surely = known_to_exceed(endings, limit, rotations, phi_cr[sample])
            upper.add(limit, beyond, cell, ladder, level)
            lower.add(limit, surely, cell, ladder, level)
    # Free blocks may move in other ways than the mechanism, from other accelerations; a body that slides never uplifts.
    uplifts = store.facts.get(UPLIFT_FACT, {}).get(structure) if not (many["by_blocks"] or slides) else None
    checked |= store.facts["description"]["model"] != "nonlinear"  # equivalent blocks have no joints
    known = lower if many["unknown"] else None
    told: dict[str, Any] = {**many, "checked": checked, "slides": slides, "lower": known, "uplift": uplifts}
    return replace(upper, **told)


def exceeds(found: RunRows, limit: Limit, reach: Reals | None = None) -> Bools:
    """Return which runs exceed a limit state or may exceed it because their outcome is unknown.

    Parameters
    ----------
    found : RunRows
        n runs.
    limit : limit state
        The limit state.
    reach : ndarray, shape (n, 2), optional
        For a displacement, the positive and the negative rotation of each run at which the top reaches it [rad].
    """
    return np.asarray(found.unknown | _exceeds(found, limit, reach, found.peak_ratio))


def known_to_exceed(found: RunRows, limit: Limit, reach: Reals | None, phi_cr: Reals) -> Bools:
    """Return which runs are known to exceed a limit state, even if their outcome is unknown.

    A run of unknown outcome is known by its uplift, its first slip, or its peak until the first joint would fail.

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
    # The lower bound was reached in one direction, the peak of which cannot be smaller.
    bound = found.lower_bound[:, None] * phi_cr
    with np.errstate(invalid="ignore"):
        could = found.peaks >= bound * (1 - ROTATION_TOLERANCE)
        surely = could.any(axis=1) & ((bound > reach) | ~could).all(axis=1)
    return np.asarray(np.where(found.unknown, surely | (found.slip > (metres(limit) or np.inf)), known))


def _exceeds(found: RunRows, limit: Limit, reach: Reals | None, ratio: Reals) -> Bools:
    """Return which runs exceed a limit state, by their peaks over phi_cr if the limit state is a ratio."""
    if limit == SLIDING:
        return np.isfinite(found.slide_time)
    overturned = found.overturned
    if reach is not None:
        # A NaN, of a run that overturned, exceeds nothing.
        return np.asarray(overturned | (found.peaks > reach).any(axis=1) | (found.slip > (metres(limit) or np.inf)))
    if isinstance(limit, str):
        return overturned if limit == OVERTURNING else found.uplifts
    with np.errstate(invalid="ignore"):
        return np.asarray(overturned | (ratio > limit))


def peaks(store: Store, plan: Plan, structure: str) -> Reals:
    """Return the peak phi/phi_cr of each complete ladder, shape (m, levels); NaN where a run overturns.

    Peaks of unknown outcome are infinite.
    """
    table = endings_of(store, plan, structure)
    ladders = np.moveaxis(table, 3, -1).reshape(-1, table.shape[3])
    complete = ladders[~np.isnan(ladders).any(axis=1)]
    return np.where(np.isinf(complete), np.nan, np.where(complete == UNKNOWN_PEAK, np.inf, complete))


def endings_of(store: Store, plan: Plan, structure: str) -> Reals:
    """Return how the runs of a structure end, shape (samples, records, etas, levels, polarities).

    Each entry is the peak phi/phi_cr; 0 without uplift, infinite if the run overturns, `UNKNOWN_PEAK` if the outcome is
    unknown, NaN if there is no run that could be simulated.
    """
    samples = samples_of(plan, structure)
    table = np.full((len(samples), *plan.shape[1:]), np.nan)
    start = samples.start * len(plan.records) * plan.block
    for rows in store.rows(start, start + table.size):
        endings = rows.select(rows.outcome != FAILED)
        rocks = np.where(endings.uplifts, np.maximum(endings.peak_ratio, np.finfo(np.float64).tiny), 0.0)
        ends = np.where(endings.unknown, UNKNOWN_PEAK, np.inf)
        table.ravel()[endings.run - start] = np.where(endings.outcome == STANDS, rocks, ends)
    return table


def _differs_between_samples(plan: Plan, samples: range, measure: str) -> bool:
    """Return whether samples under one record at one level have different values of a measure."""
    of_motion = of_the_motion(measure) and of_the_motion(plan.measure)
    return measure != plan.measure and not of_motion and _drawn_otherwise(plan, samples)


def _drawn_otherwise(plan: Plan, samples: range) -> bool:
    """Return whether samples differ in more than restitution, which alone changes no relative intensity."""
    return any(set(plan.trials[k].drawn) - {RESTITUTION} for k in samples)


def _add(table: Integers, cell: Integers) -> None:
    """Add one to a table for each cell given; the cells of one call lie close together in the table."""
    if cell.size:
        low = int(cell.min())
        runs = np.bincount(cell - low)
        table.ravel()[low : low + runs.size] += runs


Pair = tuple[float | None, float | None]
"""Values in the positive and the negative direction; None if a structure does not reach the displacement."""

TOP_POINTS = 512  # rotations between rest and the end of a mechanism at which the displacement of its top is computed
REFINEMENT = 32  # parts of a step in each refinement
MAX_REFINEMENTS = 10  # number of refinements, after which only rounding is left


def rotations(
    samples: Sequence[Sample], trials: Sequence[Trial], limits: Sequence[str], known: Mapping[str, Sequence[Pair]]
) -> dict[str, Sequence[Pair]]:
    """Return the rotations of each sample at which its top reaches the displacements of limit states.

    Parameters
    ----------
    samples : sequence of Sample
        The structures.
    trials : sequence of Trial
        The trials of these samples; samples that cannot be simulated are skipped.
    limits : sequence of str
        Limit states such as `25 mm`.
    known : mapping of str to sequence of pair
        Rotations found before, which are kept.

    Returns
    -------
    dict of str to sequence of pair
        The rotations of all samples, by limit state, including the known ones.
    """
    missing = [limit for limit in limits if limit not in known]
    wanted = [value for value in map(metres, missing) if value is not None]
    pairs: dict[tuple[object, ...], list[Pair]] = {}
    table: list[list[Pair]] = []
    for sample, trial in zip(samples, trials, strict=True) if missing else ():
        key = (sample.structure, *sample.geometry)
        if trial.reason is None and key not in pairs:
            pairs[key] = of_a_structure(sample.mechanism, wanted)
        table.append(pairs.get(key, [(None, None)] * len(wanted)))
    return {**known, **{limit: [row[k] for row in table] for k, limit in enumerate(missing)}}


def held(study: Study) -> list[str]:
    """Return a sentence on each structure whose top is held sideways although limit states are on its displacement."""
    limits = displacement_limits(study.definition.limit_states)
    return [
        f"{structure.name or structure.mechanism}: its top is held to the side and a hinge moves more, but limits "
        f"such as {limits[0]} are of the top: use a ratio of rotations instead"
        for structure in (study.structures if limits else ())
        if is_held(structure)
    ]


def of_a_structure(mechanism: Mechanism, displacements: Sequence[float]) -> list[Pair]:
    """Return, for each displacement [m], the rotations of either sign at which the top first reaches it."""
    _, spot = top(mechanism)
    sides: list[list[float | None]] = []
    for direction in (Direction.POSITIVE, Direction.NEGATIVE):
        if direction not in mechanism.directions:  # the mechanism does not rotate in this direction
            sides.append([None] * len(displacements))
            continue

        def moved(phi: Reals, side: Direction = direction) -> Reals:
            return np.abs((mechanism.followed(phi, side)(spot).z - spot.at).real)

        phi = np.linspace(0.0, float(np.nextafter(mechanism.limit(direction), 0.0)), TOP_POINTS + 1)
        at = moved(phi)
        sides.append([first_reached(moved, phi, at, each) for each in displacements])
    return list(zip(*sides, strict=True))


def first_reached(moved: Callable[[Reals], Reals], phi: Reals, at: Reals, wanted: float) -> float | None:
    """Return the first rotation at which a displacement is reached, even if it decreases again; None if it never is.

    Parameters
    ----------
    moved : callable
        The displacement [m] over rotations (n,).
    phi, at : ndarray, shape (n,)
        Rotations from rest on [rad], and the displacements there.
    wanted : float
        The displacement [m].
    """
    for k in range(1, len(phi)):
        there = bool(at[k] >= wanted)
        turns_back = k + 1 < len(phi) and at[k - 1] <= at[k] > at[k + 1]
        if there or turns_back:
            reached = _refined(moved, phi[k - 1], phi[k if there else k + 1], wanted, there=there)
            if reached is not None:
                return reached
    return None


def _refined(moved: Callable[[Reals], Reals], low: float, high: float, wanted: float, *, there: bool) -> float | None:
    """Return where between two rotations a displacement is first reached; None if it is not.

    It is reached `there`, at the higher rotation; otherwise it may be at a peak between the two.
    """
    start = low
    for _ in range(MAX_REFINEMENTS):
        fine = np.linspace(low, high, REFINEMENT + 1)
        at = moved(fine)
        k = max(int(np.argmax(at >= wanted if there else at)), 1)
        if at[k] >= wanted and not there:
            return _refined(moved, start, float(fine[k]), wanted, there=True)
        low, high = float(fine[k - 1]), float(fine[k if there else min(k + 1, REFINEMENT)])
    return high if there else None


UPLIFT_FACT = "uplift"
"""Name under which a store keeps the uplift accelerations of its structures."""


def accelerations(study: Study, plan: Plan) -> dict[str, Pair]:
    """Return the uplift accelerations over g of each structure, in its first sample that can be simulated.

    Empty if a motion has a vertical component or is that of a floor: its horizontal PGA then does not decide.
    """
    if not all(source.is_simple for source in study.sources):
        return {}
    ranges: dict[str, Pair] = {}
    for sample, trial in zip(study.samples, plan.trials, strict=True):
        if trial.reason is not None or trial.structure in ranges:
            continue
        mechanism, model = sample.mechanism, study.definition.model
        if model == "nonlinear":
            one, other = (side.lambda_ for side in both_statics(mechanism))
        else:
            block = equivalent_block(mechanism)
            one, other = uplift(block.positive, model), uplift(block.negative, model)
        ranges[trial.structure] = (one, other) if mechanism.rocks_both_ways else (max(one, other), None)
    return ranges

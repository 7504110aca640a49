"""Fit the runs of a study: fragility curves, surfaces and annual rates."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TypeVar

import numpy as np

from rocking_cli.arrays import Bools, Integers, Reals
from rocking_cli.processing.intensity import parse_measure
from rocking_cli.questions.fragility.curves import (
    FragilityCurve,
    Surface,
    exact_step,
    fit_capacities,
    fit_curve,
    fit_surface,
)
from rocking_cli.questions.fragility.definition import UPLIFT, UPLIFT_MEASURE, Definition, Limit, implies
from rocking_cli.questions.fragility.hazard_curve import HazardCurve, Rate, annual_rate
from rocking_cli.questions.fragility.observed import Observations
from rocking_cli.questions.fragility.plan import Plan
from rocking_cli.questions.fragility.store import Store
from rocking_cli.questions.fragility.tally import Cells, Counted, Ladders, Onset, Tally, count, intensities
from rocking_cli.short_repr import short_repr
from rocking_cli.studies.fit import Estimate

MAX_UNKNOWN_SHARE = 0.02  # share of unknown runs above which a second curve counts them the other way


@dataclass(frozen=True)
class UnknownRuns:
    """Number of runs of a structure with unknown outcome.

    Parameters
    ----------
    structure : str
        Name of the structure.
    runs : int
        Number of runs that can be used.
    unknown : int or None
        Number of those with unknown outcome; None if the joints are not known, so that nothing was checked.
    checked : bool
        Whether the joints are known in all runs.
    by_blocks, off_edge : int
        Number of runs that were simulated with free blocks, and of those in which a block falls off an edge.
    """

    structure: str
    runs: int
    unknown: int | None
    checked: bool
    by_blocks: int = 0
    off_edge: int = 0

    @property
    def share(self) -> float | None:
        """Share of the runs that have an unknown outcome; None if nothing was checked."""
        return None if self.unknown is None else self.unknown / self.runs


@dataclass(frozen=True, eq=False)
class _FittedTwice:
    """A fit in which undecided runs count as exceeding, with a second fit in which they count as not exceeding."""

    structure: str
    limit: Limit
    left_out: int = field(default=0, kw_only=True)
    unknown: int | None = field(default=0, kw_only=True)

    @property
    def fitted(self) -> FragilityCurve | Surface:
        """The fit, of either kind."""
        raise NotImplementedError

    @property
    def total(self) -> int:
        """Number of runs, or of capacities, that were fitted."""
        return self.fitted.runs

    @property
    def share(self) -> float | None:
        """Share of undecided runs, not known to exceed the limit state or not; None if nothing was checked."""
        return None if self.unknown is None else self.unknown / max(self.total, 1)

    @property
    def is_band(self) -> bool:
        """Whether so many runs are undecided that the result is the band between both fits, not one of them."""
        return self.share is not None and self.share > MAX_UNKNOWN_SHARE


@short_repr
@dataclass(frozen=True, eq=False)
class Fragility(_FittedTwice):
    """Fragility of one structure for one limit state, as a function of one intensity measure.

    Parameters
    ----------
    structure, measure : str
        Names of the structure and of the measure.
    limit : str or float
        The limit state: a word, or a ratio of rotations.
    seen : Observations
        The runs; in incremental dynamic analysis all levels above the first that exceeds count as exceeding.
    curve : FragilityCurve
        The fit.
    rate : Rate or None
        Annual rate of exceeding the limit state; None if the hazard is not known.
    left_out : int
        Number of runs left out because their intensity is not positive, or not known, so that it has no logarithm.
    unknown : int or None
        Number of undecided runs (in incremental dynamic analysis: capacities). Here they count as exceeding. None if
        the joints of the structure are not known, so that nothing was checked.
    lower : Fragility or None
        The fit in which undecided runs count as not exceeding; None if there are none.
    """

    measure: str
    seen: Observations
    curve: FragilityCurve
    rate: Rate | None
    lower: Fragility | None = None

    @property
    def fitted(self) -> FragilityCurve:
        """The curve."""
        return self.curve

    @property
    def median(self) -> Estimate | None:
        """Intensity of probability one half, with its interval; None without a curve."""
        return self.curve.median

    @property
    def dispersion(self) -> Estimate | None:
        """Standard deviation of the logarithm of the capacity, with its interval; None as for `FragilityCurve`."""
        return self.curve.dispersion


@short_repr
@dataclass(frozen=True, eq=False)
class Bivariate(_FittedTwice):
    """Fragility of one structure for one limit state, as a function of two measures; other fields as in `Fragility`.

    Runs are counted in cells: `runs` and `exceeding` are the numbers of runs, and of those that exceed, at `x1` and
    `x2`.
    """

    measures: tuple[str, str]
    x1: Reals
    x2: Reals
    runs: Integers
    exceeding: Integers
    surface: Surface
    lower: Bivariate | None = None

    @property
    def fitted(self) -> Surface:
        """The surface."""
        return self.surface


Fitted = TypeVar("Fitted", Fragility, Bivariate)


def counted(store: Store, plan: Plan, definition: Definition, progress: Counted) -> dict[str, Tally]:
    """Count the finished runs of each structure of a store, for the limit states and measures of its study.

    Parameters
    ----------
    store : Store
        Open to read.
    plan : Plan
        The plan of its runs.
    definition : Definition
        The definition of its study.
    progress : callable
        Called with the number of runs read since the last call.
    """
    measures = [*definition.fitted_measures, *(one for pair in definition.bivariate for one in pair)]
    limits, ladders = definition.limit_states, definition.method == "ida"
    return {
        name: count(store, plan, name, limits, measures, ladders=ladders, counted=progress) for name in plan.structures
    }


def fitted(
    found: Mapping[str, Tally], definition: Definition, hazard: HazardCurve | None, progress: Callable[[int], None]
) -> tuple[list[Fragility], list[Bivariate]]:
    """Fit all curves and surfaces that a study requests, for the structures that have runs.

    Parameters
    ----------
    found : mapping of str to Tally
        The runs of each structure.
    definition : Definition
        The definition of the study.
    hazard : HazardCurve or None
        Annual rates at which intensities are exceeded.
    progress : callable
        Called with the number of fits made since the last call.
    """
    lines: list[Fragility] = []
    planes: list[Bivariate] = []
    for structure, runs in found.items():
        if not runs.runs.any():
            continue
        for curve in curves(runs, structure, definition, hazard):
            lines.append(curve)
            progress(1)
        for surface in surfaces(runs, structure, definition):
            planes.append(surface)
            progress(1)
    return lines, planes


def unknown_runs(found: Mapping[str, Tally]) -> list[UnknownRuns]:
    """Return the number of runs of unknown outcome of each structure that has runs."""
    return [
        UnknownRuns(name, int(of.runs.sum()), of.unknown_if_checked, of.checked, of.by_blocks, of.off_edge)
        for name, of in found.items()
        if of.runs.any()
    ]


def curves(tally: Tally, structure: str, definition: Definition, hazard: HazardCurve | None) -> Iterator[Fragility]:
    """Yield the fragility curves of a structure: each limit state over each measure that is positive in some run."""
    over = definition.hazard.measure if definition.hazard is not None else None
    for measure in definition.fitted_measures:
        cells = tally.over(measure)
        x = cells.intensities(measure)
        if not (x > 0).any():  # all intensities are zero, or none is known
            continue
        fits = _curves_over(cells, x, structure, measure, definition)
        for each in _consistent(list(fits), cells.onset(measure), slides=tally.slides):
            yield _with_rate(each, hazard) if hazard is not None and measure == over else each


def _curves_over(
    cells: Cells, x: Reals, structure: str, measure: str, definition: Definition
) -> Iterator[Fragility]:  # fmt: skip
    """Yield the curve of each limit state over one measure as it is fitted; `x` holds the intensities of the cells."""
    tally, confidence, there = cells.tally, definition.confidence, x > 0
    x, runs, left_out = x[there], cells.runs[there], int(cells.runs[~there].sum())
    level = cells.level[there] if tally.decided_by_level(measure) else None
    record, weight = tally.one(cells.record[there]), tally.weight(cells.record[there])

    def fit(tally: Tally, limit: Limit) -> Fragility:
        ladders = tally.ladders
        exceeding = cells.of(tally.exceeding[limit] if ladders is None else ladders.above(limit))[there]
        seen = Observations.of(x, exceeding, record, level=level, runs=runs, weight=weight)
        if ladders is None:
            curve = fit_curve(seen, confidence=confidence)
        elif parse_measure(measure).power == 0:
            why = f"{measure} is the same at every level, so that no record has a capacity in it"
            curve = FragilityCurve("none", why, confidence, seen.runs, seen.exceedances, records=seen.records)
        else:
            tried = np.unique(x) if level is not None else None
            lower, upper, of = _capacities(tally, ladders, measure, limit, together=cells.together)
            one, each = tally.one(of), tally.weight(of)
            curve = fit_capacities(lower, upper, one, levels=tried, confidence=confidence, weight=each)
        return Fragility(structure, limit, measure, seen, curve, None, left_out=left_out)

    for limit in definition.limit_states:
        unknown = _undecided_runs(cells, limit, there) if tally.ladders is None else _undecided_ladders(tally, limit)
        yield _twice(partial(fit, limit=limit), tally, unknown)


def _twice(fit: Callable[[Tally], Fitted], tally: Tally, unknown: int) -> Fitted:
    """Return a fit with undecided runs counted as exceeding, and as its `lower` the one in which they do not."""
    upper = fit(tally)
    if unknown:
        assert tally.lower is not None
        upper = replace(upper, unknown=unknown, lower=fit(tally.lower))
    return upper if tally.unknown_if_checked is not None else replace(upper, unknown=None)


def _consistent(fits: Sequence[Fragility], onset: Onset | None, *, slides: bool) -> Iterator[Fragility]:
    """Yield the curves of one structure over one measure, corrected so that none lies above a curve that it implies.

    Parameters
    ----------
    fits : sequence of Fragility
        The curves as fitted, one for each limit state.
    onset : Onset, optional
        The intensity at which the structure uplifts, if it is known.
    """
    floor: dict[Limit, FragilityCurve] = {}
    if onset is not None and onset.exact and any(each.limit == UPLIFT for each in fits):
        fits = [_exact(each, onset.at) if each.limit == UPLIFT else each for each in fits]
    elif onset is not None:
        floor = {UPLIFT_MEASURE: exact_step(FragilityCurve("none", "", 1.0, 0, 0), onset.at, "")}

    def below(found: Fragility, weaker: Iterable[Fragility]) -> Fragility:
        known = floor | {other.limit: other.curve for other in weaker if other.curve.kind != "none"}
        return found if found.curve.kind == "none" else replace(found, curve=replace(found.curve, implied=known))

    for each in fits:
        weaker = [other for other in fits if implies(each.limit, other.limit, slides=slides)]
        lower = None if each.lower is None else below(each.lower, (other.lower or other for other in weaker))
        yield replace(below(each, weaker), lower=lower)


def _exact(found: Fragility, at: float) -> Fragility:
    """Return the uplift curve as a step at the exactly known intensity."""
    place = f"{at:.4g} {parse_measure(found.measure).unit}".strip()
    why = f"a motion uplifts the structure exactly if its {found.measure} exceeds {place}, so no curve is fitted"
    return replace(found, curve=exact_step(found.curve, at, why))


def _with_rate(found: Fragility, hazard: HazardCurve) -> Fragility:
    """Return a result and its lower fit with their annual rates."""
    lower = None if found.lower is None else _with_rate(found.lower, hazard)
    rate = annual_rate(found.curve, hazard) if found.curve.kind != "none" else None
    return replace(found, rate=rate, lower=lower)


def _undecided_runs(cells: Cells, limit: Limit, there: Bools) -> int:
    """Return the number of runs in some cells that are not known to exceed a limit state or not."""
    upper, lower = cells.tally, cells.tally.lower
    return 0 if lower is None else int(cells.of(upper.exceeding[limit] - lower.exceeding[limit])[there].sum())


def _undecided_ladders(tally: Tally, limit: Limit) -> int:
    """Return the number of ladders (levels of one record) whose first exceeding level is not known."""
    if tally.lower is None:
        return 0
    assert tally.ladders is not None and tally.lower.ladders is not None
    return int((tally.ladders.first[limit] != tally.lower.ladders.first[limit]).sum())


def _capacities(
    tally: Tally, ladders: Ladders, measure: str, limit: Limit, *, together: bool
) -> tuple[Reals, Reals, Integers]:
    """Return the bounds of the capacity of each ladder, 0 or infinity if no level bounds it, and its record."""
    first, last = ladders.first[limit], ladders.below(limit)
    levels = len(tally.plan.levels)
    known = (first < levels) | (last >= 0)  # a ladder without a simulated run gives no information
    sample, record, _, _ = np.nonzero(known)
    began, last = first[known].astype(np.int64), last[known]
    if together:
        sample = np.zeros_like(sample)

    def at(level: Integers) -> Reals:
        return intensities(tally.plan, measure, sample + tally.samples.start, record, np.clip(level, 0, levels - 1))

    lower, upper = np.where(last >= 0, at(last), 0.0), np.where(began < levels, at(began), np.inf)
    sound = lower < upper  # otherwise the peak decreases with the level, or is unknown
    return lower[sound], upper[sound], record[sound]


def surfaces(tally: Tally, structure: str, definition: Definition) -> Iterator[Bivariate]:
    """Yield the fragility surfaces of a structure."""
    for one, other in definition.bivariate:
        yield from _surfaces_over(tally, structure, (one, other), definition)


def _surfaces_over(
    tally: Tally, structure: str, measures: tuple[str, str], definition: Definition
) -> Iterator[Bivariate]:
    """Yield the surface of each limit state over two measures that are both positive in some run."""
    cells = tally.over(*measures)
    x1, x2 = (cells.intensities(measure) for measure in measures)
    there = (x1 > 0) & (x2 > 0)
    x1, x2, runs, left_out = x1[there], x2[there], cells.runs[there], int(cells.runs[~there].sum())
    record, weight = tally.one(cells.record[there]), tally.weight(cells.record[there])

    def fit(tally: Tally, limit: Limit) -> Bivariate:
        exceeding = cells.of(tally.exceeding[limit])[there]
        surface = fit_surface(x1, x2, exceeding, record, runs=runs, confidence=definition.confidence, weight=weight)
        return Bivariate(structure, limit, measures, x1, x2, runs, exceeding, surface, left_out=left_out)

    for limit in definition.limit_states if there.any() else []:
        yield _twice(partial(fit, limit=limit), tally, _undecided_runs(cells, limit, there))

"""Fit the runs of a study: fragility curves, surfaces and annual rates."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from rocking_cli.arrays import Integers, Reals
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
from rocking_cli.questions.fragility.tally import Cells, Counted, Ladders, Tally, count
from rocking_cli.short_repr import short_repr
from rocking_cli.studies.fit import Estimate

CURVE_POINTS = 101  # of a curve in a table
MIN_LOG_RATIO = 30.0  # ratio of largest to least intensity, from which intensities are spaced by a factor
MAX_UNKNOWN_SHARE = 0.02  # share of unknown runs above which a second curve counts them the other way


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
    def points(self) -> Reals:
        """Intensities at which tables list the curve, with the steps and the ends of their intervals."""
        least, most = float(self.seen.x.min()), float(self.seen.x.max())
        between = np.geomspace if most > MIN_LOG_RATIO * least else np.linspace
        steps = [step for curve in (self.curve, (self.lower or self).curve) for step in curve.steps]
        ends = [end for step in steps for end in (step.low, step.value, step.high)]
        return np.union1d(between(least, most, CURVE_POINTS), ends)

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
    return {name: count(store, plan, name, definition, progress) for name in plan.structures}


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


def curves(tally: Tally, structure: str, definition: Definition, hazard: HazardCurve | None) -> Iterator[Fragility]:
    """Yield the fragility curves of a structure: each limit state over each measure that is positive in some run."""
    for measure in definition.fitted_measures:
        of_measure = definition.hazard is not None and definition.hazard.measure == measure
        yield from _curves_over(measure, tally, structure, definition, hazard if of_measure else None)


def _curves_over(
    measure: str, tally: Tally, structure: str, definition: Definition, hazard: HazardCurve | None
) -> Iterator[Fragility]:
    """Yield the curve of each limit state over one measure, corrected so that none lies above one that it implies."""
    cells, confidence, unit = tally.over(measure), definition.confidence, parse_measure(measure).unit
    there = cells.intensities(measure) > 0  # False for unknown values, too
    if not there.any():
        return
    onset, left_out, cells = cells.onset(measure), int(cells.runs[~there].sum()), cells.only(there)
    x, (record, weight) = cells.intensities(measure), tally.clusters(cells.record)
    level = cells.level if tally.decided_by_level(measure) else None

    def fit(counts: Tally, limit: Limit) -> Fragility:
        ladders = counts.ladders
        exceeding = cells.of(counts.exceeding[limit] if ladders is None else ladders.above(limit))
        seen = Observations.of(x, exceeding, record, level=level, runs=cells.runs, weight=weight)
        if ladders is None:
            curve = fit_curve(seen, confidence=confidence)
        elif parse_measure(measure).power == 0:
            why = f"{measure} is the same at every level, so that no record has a capacity in it"
            curve = FragilityCurve("none", why, confidence, seen.runs, seen.exceedances, records=seen.counts.records)
        else:
            tried = np.unique(x) if level is not None else None
            lower, upper, of = cells.capacities(ladders, limit, measure)
            which, each = tally.clusters(of)
            curve = fit_capacities(lower, upper, which, levels=tried, confidence=confidence, weight=each)
        return Fragility(structure, limit, measure, seen, curve, None, left_out=left_out)

    unknown = {limit: _undecided(tally, limit, cells, tally.ladders) for limit in definition.limit_states}
    upper = {limit: fit(tally, limit) for limit in unknown}
    floor: dict[Limit, FragilityCurve] = {}
    if onset is not None and onset.exact and UPLIFT in upper:
        place = f"{onset.at:.4g} {unit}".strip()
        why = f"a motion uplifts the structure exactly if its {measure} exceeds {place}, so no curve is fitted"
        upper[UPLIFT] = replace(upper[UPLIFT], curve=exact_step(upper[UPLIFT].curve, onset.at, why))
    elif onset is not None:
        floor = {UPLIFT_MEASURE: exact_step(FragilityCurve("none", "", 1.0, 0, 0), onset.at, "")}
    lower = upper | {limit: fit(tally.least, limit) for limit, runs in unknown.items() if runs}

    def below(limit: Limit, fits: Mapping[Limit, Fragility]) -> Fragility:
        uncut = fits[limit]
        if uncut.curve.kind == "none":
            return uncut
        weaker = {other: fits[other].curve for other in fits if implies(limit, other, slides=tally.slides)}
        known = floor | {other: curve for other, curve in weaker.items() if curve.kind != "none"}
        curve = replace(uncut.curve, implied=known)
        return replace(uncut, curve=curve, rate=None if hazard is None else annual_rate(curve, hazard))

    for limit, runs in unknown.items():
        yield replace(below(limit, upper), unknown=runs, lower=below(limit, lower) if runs else None)


def _undecided(tally: Tally, limit: Limit, cells: Cells, ladders: Ladders | None = None) -> int | None:
    """Return how many runs, or ladders, may or may not exceed a limit state; None if nothing was checked."""
    if tally.unknown_if_checked is None:
        return None
    if ladders is None or tally.least.ladders is None:
        return int(cells.of(tally.exceeding[limit] - tally.least.exceeding[limit]).sum())
    return int((ladders.first[limit] != tally.least.ladders.first[limit]).sum())


def surfaces(tally: Tally, structure: str, definition: Definition) -> Iterator[Bivariate]:
    """Yield the surfaces of a structure: each limit state over each two measures that are both positive in some run."""
    for one, other in definition.bivariate:
        cells = tally.over(one, other)
        there = np.all([cells.intensities(measure) > 0 for measure in (one, other)], axis=0)
        left_out, cells = int(cells.runs[~there].sum()), cells.only(there)
        x = cells.intensities(one), cells.intensities(other)
        record, weight = tally.clusters(cells.record)
        for limit in definition.limit_states if there.any() else []:
            unknown, fits = _undecided(tally, limit, cells), []
            for counts in (tally, tally.least) if unknown else (tally,):
                beyond = cells.of(counts.exceeding[limit])
                confidence, runs = definition.confidence, cells.runs
                surface = fit_surface(*x, beyond, record, runs=runs, confidence=confidence, weight=weight)
                fits.append(Bivariate(structure, limit, (one, other), *x, runs, beyond, surface, left_out=left_out))
            yield replace(fits[0], unknown=unknown, lower=fits[1] if unknown else None)

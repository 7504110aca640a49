"""From the runs of a study to its fragility curves, surfaces and annual rates."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rocking_cli.studies.fragility.curves import (
    Curve,
    Observations,
    Surface,
    fit_capacities,
    fit_curve,
    fit_surface,
)
from rocking_cli.studies.fragility.definition import OVERTURNING, Definition, Limit
from rocking_cli.studies.fragility.hazard import HazardCurve, Rate, annual_rate
from rocking_cli.studies.fragility.intensity import intensity, proportional
from rocking_cli.studies.fragility.plan import Plan
from rocking_cli.studies.fragility.store import FAILED, STANDS, Rows, Store
from rocking_cli.studies.fragility.study import RESTITUTION

Reals = NDArray[np.float64]
Integers = NDArray[np.int64]
Bools = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Found:
    """What runs of one structure give: each an ndarray of one length.

    Parameters
    ----------
    plan : Plan
        The study's runs.
    rows : Rows
        The finished runs of the structure, without those that could not be followed.
    sample, record, eta, level, polarity : ndarray of int
        Their places.
    """

    plan: Plan
    rows: Rows
    sample: Integers
    record: Integers
    eta: Integers
    level: Integers
    polarity: Integers

    def intensities(self, measure: str) -> Reals:
        """The intensity of each run; where the levels are of it, to the last digit."""
        if measure == self.plan.measure:
            return np.array(self.plan.levels)[self.level]
        peaks = np.array([(each.pga, each.pgv) for each in self.plan.records])[self.record]
        factors = self.rows.scale
        return intensity(measure, factors * peaks[:, 0], factors * peaks[:, 1], self.plan.scales(self.sample))

    def decided_by_level(self, measure: str) -> bool:
        """Whether all runs of a level have one intensity: whatever was scaled to it, and drawn of the structure."""
        if measure == self.plan.measure:
            return True
        drawn = {name for k in np.unique(self.sample) for name in self.plan.trials[k].drawn}
        return proportional(measure, self.plan.measure) and drawn <= {RESTITUTION}

    def observations(self, measure: str, exceeded: Bools) -> Observations:
        """The runs over a measure, those of a level together where it decides their intensity."""
        level = self.level if self.decided_by_level(measure) else None
        return Observations(self.intensities(measure), exceeded, self.record, level)

    def exceeds(self, limit: Limit) -> Bools:
        """Which runs exceed a limit state."""
        overturned: Bools = self.rows.outcome != STANDS
        if isinstance(limit, str):
            return overturned if limit == OVERTURNING else np.isfinite(self.rows.uplift_time)
        with np.errstate(invalid="ignore"):
            beyond: Bools = overturned | (self.rows.peak_ratio > limit)
        return beyond


@dataclass(frozen=True, eq=False)
class Fragility:
    """How likely one structure is to exceed one limit state, over one measure.

    Parameters
    ----------
    structure, measure : str
        What it is of.
    limit : str or float
        The limit state: a word, or a ratio of rotations.
    seen : Observations
        The runs; in incremental dynamic analysis all above the first that exceeds count as exceeding.
    curve : Curve
        The fit.
    rate : Rate or None
        How often it is exceeded a year, where the hazard is known.
    """

    structure: str
    limit: Limit
    measure: str
    seen: Observations
    curve: Curve
    rate: Rate | None


@dataclass(frozen=True, eq=False)
class Bivariate:
    """How likely one structure is to exceed one limit state, over two measures; the fields as of `Fragility`."""

    structure: str
    limit: Limit
    measures: tuple[str, str]
    x1: Reals
    x2: Reals
    exceeded: Bools
    surface: Surface


def structures(plan: Plan) -> list[str]:
    """Names of the structures, in the order of the study."""
    return list(dict.fromkeys(trial.structure for trial in plan.trials))


def find(store: Store, plan: Plan, structure: str) -> Found:
    """The finished runs of a structure."""
    places = [k for k, trial in enumerate(plan.trials) if trial.structure == structure]
    each = len(plan.records) * plan.block
    rows = store.runs(places[0] * each, (places[-1] + 1) * each)
    rows = rows.select(rows.outcome != FAILED)
    return Found(plan, rows, *plan.places(rows.id))


def curves(
    found: Found, structure: str, definition: Definition, hazard: HazardCurve | None
) -> list[Fragility]:  # fmt: skip
    """The fragility curves of a structure: each limit state over each measure."""
    made = []
    for measure in definition.fitted_measures:
        for limit in definition.limit_states:
            seen = found.observations(measure, found.exceeds(limit))
            if definition.method == "ida":
                each = ladders(found, seen.x, seen.exceeded)
                curve = fit_capacities(each.lower, each.upper, each.record, confidence=definition.confidence)
                seen = replace(seen, exceeded=found.level >= each.first[each.which])
            else:
                curve = fit_curve(seen, confidence=definition.confidence)
            rate = None
            if hazard is not None and curve.kind != "none" and definition.hazard_measure == measure:
                rate = annual_rate(curve, hazard)
            made.append(Fragility(structure, limit, measure, seen, curve, rate))
    return made


def surfaces(found: Found, structure: str, definition: Definition) -> list[Bivariate]:
    """The fragility surfaces of a structure."""
    made = []
    for one, other in definition.bivariate:
        x1, x2 = found.intensities(one), found.intensities(other)
        for limit in definition.limit_states:
            exceeded = found.exceeds(limit)
            surface = fit_surface(x1, x2, exceeded, found.record, confidence=definition.confidence)
            made.append(Bivariate(structure, limit, (one, other), x1, x2, exceeded, surface))
    return made


@dataclass(frozen=True, eq=False)
class Ladders:
    """The runs of a record that differ in their level alone, for each sample, restitution and polarity.

    Parameters
    ----------
    which : ndarray of int, shape (n,)
        The ladder of each run.
    record : ndarray of int, shape (m,)
        The record of each ladder.
    first : ndarray of int, shape (m,)
        The level at which it first exceeds; the number of levels if it does not.
    lower, upper : ndarray, shape (m,)
        Between which intensities it first exceeds: the last below the first that exceeds, 0 if that is the lowest; and
        the first that exceeds, infinite if none does.
    """

    which: Integers
    record: Integers
    first: Integers
    lower: Reals
    upper: Reals


def ladders(found: Found, x: Reals, exceeded: Bools) -> Ladders:
    """Sort runs of some intensities, which exceed a limit state or do not, into ladders."""
    keys = np.stack([found.sample, found.record, found.eta, found.polarity])
    each, which = np.unique(keys, axis=1, return_inverse=True)
    first = np.full(each.shape[1], len(found.plan.levels))
    np.minimum.at(first, which[exceeded], found.level[exceeded])
    lower, upper = np.zeros(each.shape[1]), np.full(each.shape[1], np.inf)
    below, there = found.level < first[which], found.level == first[which]
    np.maximum.at(lower, which[below], x[below])
    upper[which[there]] = x[there]
    return Ladders(which, each[1], first, lower, upper)


def peaks(found: Found) -> Reals:
    """Peak phi/phi_cr of each ladder that is complete, shape (m, levels); NaN where it overturns."""
    each = ladders(found, np.array(found.plan.levels)[found.level], found.rows.outcome != STANDS)
    table = np.full((len(each.record), len(found.plan.levels)), np.nan)
    there = np.zeros(table.shape, dtype=bool)
    table[each.which, found.level] = found.rows.peak_ratio
    there[each.which, found.level] = True
    return table[there.all(axis=1)]

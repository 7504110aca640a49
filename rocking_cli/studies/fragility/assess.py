"""From the runs of a study to its fragility curves, surfaces and annual rates."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from rocking_cli.processing.intensity import parse_measure
from rocking_cli.studies.fragility.curves import (
    Curve,
    Observations,
    Surface,
    fit_capacities,
    fit_curve,
    fit_surface,
)
from rocking_cli.studies.fragility.definition import Definition, Limit
from rocking_cli.studies.fragility.hazard import HazardCurve, Rate, annual_rate
from rocking_cli.studies.fragility.likelihood import Integers, Reals
from rocking_cli.studies.fragility.plan import Plan
from rocking_cli.studies.fragility.store import Store
from rocking_cli.studies.fragility.tally import Cells, Counted, Tally, count, intensities


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
    left_out : int
        Runs whose intensity is not above zero, or not known, and which no curve over its logarithm can hold.
    """

    structure: str
    limit: Limit
    measure: str
    seen: Observations
    curve: Curve
    rate: Rate | None
    left_out: int = 0


@dataclass(frozen=True, eq=False)
class Bivariate:
    """How likely one structure is to exceed one limit state, over two measures; the fields as of `Fragility`.

    Runs are counted in cells: `runs` and `exceeding` are how many there are and how many exceed at `x1` and `x2`.
    """

    structure: str
    limit: Limit
    measures: tuple[str, str]
    x1: Reals
    x2: Reals
    runs: Integers
    exceeding: Integers
    surface: Surface
    left_out: int = 0


def structures(plan: Plan) -> list[str]:
    """Names of the structures, in the order of the study."""
    return list(dict.fromkeys(trial.structure for trial in plan.trials))


def counted(store: Store, plan: Plan, definition: Definition, progress: Counted) -> dict[str, Tally]:
    """The finished runs of each structure of a store, counted for what its study asks for.

    Parameters
    ----------
    store : Store
        Open to read.
    plan : Plan
        Its runs.
    definition : Definition
        What its study asks for.
    progress : callable
        Told how many numbers of runs have been gone through since the last call.
    """
    measures = [*definition.fitted_measures, *(one for pair in definition.bivariate for one in pair)]
    limits, ladders = definition.limit_states, definition.method == "ida"
    return {
        name: count(store, plan, name, limits, measures, ladders=ladders, counted=progress) for name in structures(plan)
    }


def fitted(
    found: Mapping[str, Tally], definition: Definition, hazard: HazardCurve | None, progress: Callable[[int], None]
) -> tuple[list[Fragility], list[Bivariate]]:
    """All curves and surfaces that a study asks for, of the structures that have runs.

    Parameters
    ----------
    found : mapping of str to Tally
        The runs of each structure.
    definition : Definition
        What the study asks for.
    hazard : HazardCurve or None
        How often intensities are exceeded.
    progress : callable
        Told how many fits were made since the last call.
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


def curves(
    tally: Tally, structure: str, definition: Definition, hazard: HazardCurve | None
) -> Iterator[Fragility]:  # fmt: skip
    """The fragility curves of a structure: each limit state over each measure that is above zero in any run."""
    confidence = definition.confidence
    for measure in definition.fitted_measures:
        cells = tally.over(measure)
        x = cells.intensities(measure)
        there = x > 0  # not of those that are not known, either
        if not there.any():
            continue
        x, runs = x[there], cells.runs[there]
        record, weight = tally.one(cells.record[there]), tally.weight(cells.record[there])
        level = cells.level[there] if tally.decided_by_level(measure) else None
        for limit in definition.limit_states:
            exceeding = cells.exceeding(limit) if tally.ladders is None else cells.of(tally.ladders.above(limit))
            seen = Observations.of(x, exceeding[there], record, level=level, runs=runs, weight=weight)
            if tally.ladders is None:
                curve = fit_curve(seen, confidence=confidence)
            elif parse_measure(measure).power == 0:
                why = f"{measure} is the same at every level, so that no record has a capacity in it"
                curve = Curve("none", why, confidence, seen.runs, seen.exceedances, records=seen.records)
            else:
                tried = np.unique(x) if level is not None else None
                lower, upper, of = _capacities(tally, measure, limit, cells)
                curve = fit_capacities(
                    lower, upper, tally.one(of), levels=tried, confidence=confidence, weight=tally.weight(of)
                )
            rate = None
            if hazard is not None and curve.kind != "none" and definition.hazard_measure == measure:
                rate = annual_rate(curve, hazard)
            yield Fragility(structure, limit, measure, seen, curve, rate, int(cells.runs[~there].sum()))


def _capacities(tally: Tally, measure: str, limit: Limit, cells: Cells) -> tuple[Reals, Reals, Integers]:
    """Between which intensities each ladder first exceeds, and its record; 0 and infinity where no level bounds it."""
    assert tally.ladders is not None
    first, last = tally.ladders.first[limit], tally.ladders.below(limit)
    levels = len(tally.plan.levels)
    known = (first < levels) | (last >= 0)  # a ladder none of whose runs could be followed says nothing
    sample, record, _, _ = np.nonzero(known)
    began, last = first[known].astype(np.int64), last[known]
    if cells.together:
        sample = np.zeros_like(sample)

    def at(level: Integers) -> Reals:
        return intensities(tally.plan, measure, sample + tally.samples.start, record, np.clip(level, 0, levels - 1))

    lower, upper = np.where(last >= 0, at(last), 0.0), np.where(began < levels, at(began), np.inf)
    sound = lower < upper  # else it does not grow with the level, or is not known
    return lower[sound], upper[sound], record[sound]


def surfaces(tally: Tally, structure: str, definition: Definition) -> Iterator[Bivariate]:
    """The fragility surfaces of a structure."""
    for one, other in definition.bivariate:
        cells = tally.over(one, other)
        x1, x2 = cells.intensities(one), cells.intensities(other)
        there = (x1 > 0) & (x2 > 0)
        x1, x2, runs = x1[there], x2[there], cells.runs[there]
        record, weight = tally.one(cells.record[there]), tally.weight(cells.record[there])
        for limit in definition.limit_states if there.any() else []:
            exceeding = cells.exceeding(limit)[there]
            surface = fit_surface(x1, x2, exceeding, record, runs=runs, confidence=definition.confidence, weight=weight)
            left_out = int(cells.runs[~there].sum())
            yield Bivariate(structure, limit, (one, other), x1, x2, runs, exceeding, surface, left_out)

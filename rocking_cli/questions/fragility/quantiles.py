"""Quantiles of the peak rotation over the runs at an intensity.

Runs that do not uplift and runs that overturn are counted apart, as they have no peak of rocking. A second set of
quantiles ranks all runs: without uplift as zero, overturned or of unknown outcome as beyond every number.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking_cli import names
from rocking_cli.arrays import Integers, Reals
from rocking_cli.questions.fragility.definition import Definition
from rocking_cli.questions.fragility.observed import Observations
from rocking_cli.questions.fragility.plan import Plan
from rocking_cli.questions.fragility.store import Store
from rocking_cli.questions.fragility.tally import UNKNOWN_PEAK, Tally, endings_of, samples_of
from rocking_cli.short_repr import short_repr

QUANTILES = (0.16, 0.5, 0.84)
MIN_RECORDS = (names.MIN_MOTIONS, names.MIN_MOTIONS_OF_MEDIAN, names.MIN_MOTIONS)
"""Smallest number of records with which each quantile is given: their lowest and highest peak enclose it with 95 %."""
COUNT_TOLERANCE = 1e-9  # difference of numbers of runs that counts as rounding


@short_repr
@dataclass(frozen=True)
class Group:
    """The runs of one intensity, or of a tenth by intensity.

    Parameters
    ----------
    x : float
        Mean intensity.
    low, high : float
        The least and the largest intensity.
    runs, records : int
        Number of runs, and of their records.
    no_uplift, overturned : int
        Number of runs that do not uplift, and of runs that overturn.
    rocking : tuple of float
        Peak phi/phi_cr not exceeded by 16, 50 and 84 % of the runs that rock without overturning; NaN without any, or
        if too few records rock (`MIN_RECORDS`).
    every : tuple of float
        Peak phi/phi_cr not exceeded by these shares of all runs: 0 without uplift, infinite if a run overturns or its
        outcome is unknown, NaN if there are too few records.
    unknown : int
        Number of runs of unknown outcome.
    doubtful : tuple of bool
        Whether each value of `every` belongs to a run of unknown outcome; runs that overturn rank higher.
    """

    x: float
    low: float
    high: float
    runs: int
    records: int
    no_uplift: int
    overturned: int
    rocking: tuple[float, ...]
    every: tuple[float, ...]
    unknown: int = 0
    doubtful: tuple[bool, ...] = (False,) * len(QUANTILES)


@short_repr
@dataclass(frozen=True)
class Quantiles:
    """Quantiles of the peak rotation of one structure, as a function of one measure.

    Parameters
    ----------
    structure, measure : str
        Names of the structure and of the measure.
    stripes : bool
        Whether each group is one intensity; otherwise it is a tenth of the runs in order of intensity.
    groups : sequence of Group
        The groups, from the lowest intensity.
    """

    structure: str
    measure: str
    stripes: bool
    groups: Sequence[Group]

    @property
    def unknown(self) -> int:
        """Number of runs of unknown outcome."""
        return sum(each.unknown for each in self.groups)


def all_quantiles(store: Store, plan: Plan, definition: Definition) -> Iterator[Quantiles]:
    """Yield the quantiles of every structure of a study over every measure of its curves."""
    for structure in plan.structures:
        yield from quantiles(store, plan, structure, definition.fitted_measures)


def quantiles(store: Store, plan: Plan, structure: str, measures: Sequence[str]) -> Iterator[Quantiles]:
    """Yield the quantiles of a structure over several measures, in the groups in which observed shares are counted.

    Parameters
    ----------
    store : Store
        Open to read.
    plan : Plan
        The plan of its runs.
    structure : str
        Name of the structure.
    measures : sequence of str
        Names of the measures.

    Yields
    ------
    Quantiles
        One for each measure; none if no run is finished.
    """
    table = np.moveaxis(endings_of(store, plan, structure), 2, 3)  # sample, record, level; restitution and polarity
    runs: NDArray[Any] = (~np.isnan(table)).sum(axis=(3, 4), dtype=np.int32)  # the table of many samples is large
    counted = Tally(plan, samples_of(plan, structure), runs, {}, None)
    for measure in measures if runs.any() else ():
        cells = counted.over(measure)
        x = cells.intensities(measure)
        there = x > 0  # False for unknown values, too
        if not there.any():
            continue
        x, record = x[there], cells.record[there]
        level = cells.level[there] if counted.decided_by_level(measure) else None
        seen = Observations.of(x, np.zeros(x.size), record, level=level, runs=cells.runs[there])
        of_cell = seen.group_of(x, record, level)
        groups = np.full((1, *runs.shape[1:]) if cells.together else runs.shape, -1, dtype=np.int16)
        groups[tuple(each[there] for each in cells.place)] = of_cell
        whole = np.broadcast_to(groups, runs.shape)
        parts = seen.parts(0.95)
        yield Quantiles(structure, measure, seen.stripes, [
            _group(
                table[whole == k], np.nonzero(whole == k)[1], x[of_cell == k], float(parts.x[k]), int(parts.records[k])
            )
            for k in range(parts.x.size)
        ])  # fmt: skip


def _group(peaks: Reals, record: Integers, x: Reals, mean: float, records: int) -> Group:
    ranked = np.sort(peaks[~np.isnan(peaks)])
    rocks = (peaks > 0) & (peaks < UNKNOWN_PEAK)
    rocking = np.sort(peaks[rocks])
    every = not_exceeded(ranked, records)
    low, high = float(x.min()), float(x.max())
    return Group(
        min(max(mean, low), high),  # the mean lies between them, except for rounding
        low,
        high,
        ranked.size,
        records,
        int((ranked == 0).sum()),
        int(np.isinf(ranked).sum()),
        not_exceeded(rocking, np.unique(record[rocks.any(axis=(1, 2))]).size),
        tuple(np.inf if value == UNKNOWN_PEAK else value for value in every),
        int((ranked == UNKNOWN_PEAK).sum()),
        tuple(value == UNKNOWN_PEAK for value in every),
    )


def not_exceeded(ranked: Reals, records: int) -> tuple[float, ...]:
    """Return for each share the lowest of increasing observed values that it does not exceed; NaN if too few."""
    return tuple(
        float(ranked[int(np.ceil(share * ranked.size - COUNT_TOLERANCE)) - 1])
        if ranked.size and records >= fewest
        else np.nan
        for share, fewest in zip(QUANTILES, MIN_RECORDS, strict=True)
    )

"""How far structures rock at an intensity: quantiles of the peak rotation over the runs that are observed there.

Runs that do not uplift and runs that overturn are kept apart, as neither has a peak of rocking; beside it all runs are
ranked, without uplift as zero and overturned as beyond every number. Runs of unknown outcome count as overturned there.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking_cli.studies.fragility.definition import Definition
from rocking_cli.studies.fragility.observed import Observations
from rocking_cli.studies.fragility.plan import Plan
from rocking_cli.studies.fragility.store import Store
from rocking_cli.studies.fragility.tally import UNSEEN, Tally, endings_of, samples_of

Reals = NDArray[np.float64]
SHARES = (0.16, 0.5, 0.84)
ROUNDING = 1e-9  # of a number of runs


@dataclass(frozen=True)
class Group:
    """The runs of one intensity, or of a tenth by intensity.

    Parameters
    ----------
    x : float
        Mean intensity.
    low, high : float
        The least and the largest of them.
    runs, records : int
        How many runs there are, and of how many records.
    no_uplift, overturned : int
        How many of the runs do not uplift, and how many overturn.
    rocking : tuple of float
        Peak phi/phi_cr that 16, 50 and 84 % of those that rock and stand do not exceed; NaN where there is none.
    every : tuple of float
        The same of all runs: 0 without uplift, infinite where it overturns or the outcome is unknown.
    unknown : int
        How many of the runs are of unknown outcome.
    doubtful : tuple of bool
        Whether each of `every` is the peak of such a run: all that overturn are beyond it.
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
    doubtful: tuple[bool, ...] = (False,) * len(SHARES)


@dataclass(frozen=True)
class Quantiles:
    """Quantiles of one structure over one measure.

    Parameters
    ----------
    structure, measure : str
        What they are of.
    stripes : bool
        Whether a group is one intensity, else it is a tenth of the records' intensities.
    groups : sequence of Group
        From the lowest intensity.
    """

    structure: str
    measure: str
    stripes: bool
    groups: Sequence[Group]

    @property
    def unknown(self) -> int:
        """How many runs are of unknown outcome."""
        return sum(each.unknown for each in self.groups)


def all_quantiles(store: Store, plan: Plan, definition: Definition) -> Iterator[Quantiles]:
    """Those of every structure of a study over every measure that it asks for, a structure at a time."""
    for structure in dict.fromkeys(trial.structure for trial in plan.trials):
        yield from quantiles(store, plan, structure, definition.fitted_measures)


def quantiles(store: Store, plan: Plan, structure: str, measures: Sequence[str]) -> Iterator[Quantiles]:
    """The quantiles of a structure over measures, in the groups in which observed parts are counted.

    Parameters
    ----------
    store : Store
        Open to read.
    plan : Plan
        Its runs.
    structure : str
        Which structure.
    measures : sequence of str
        What they are over.

    Yields
    ------
    Quantiles
        One a measure; none if no run is finished.
    """
    table = np.moveaxis(endings_of(store, plan, structure), 2, 3)  # sample, record, level; restitution and polarity
    runs: NDArray[Any] = (~np.isnan(table)).sum(axis=(3, 4), dtype=np.int32)  # of many samples there are many
    counted = Tally(plan, samples_of(plan, structure), runs, {}, None)
    for measure in measures if runs.any() else ():
        cells = counted.over(measure)
        x = cells.intensities(measure)
        there = x > 0  # not of those that are not known, either
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
            _group(table[whole == k], x[of_cell == k], float(parts.x[k]), int(parts.records[k]))
            for k in range(parts.x.size)
        ])  # fmt: skip


def _group(peaks: Reals, x: Reals, mean: float, records: int) -> Group:
    ranked = np.sort(peaks[~np.isnan(peaks)])
    rocking = ranked[(ranked > 0) & (ranked < UNSEEN)]
    every = _not_exceeded(ranked)
    low, high = float(x.min()), float(x.max())
    return Group(
        min(max(mean, low), high),  # rounding aside it is between them
        low,
        high,
        ranked.size,
        records,
        int((ranked == 0).sum()),
        int(np.isinf(ranked).sum()),
        _not_exceeded(rocking),
        tuple(np.inf if value == UNSEEN else value for value in every),
        int((ranked == UNSEEN).sum()),
        tuple(value == UNSEEN for value in every),
    )


def _not_exceeded(ranked: Reals) -> tuple[float, ...]:
    """The lowest of some values, growing, that these shares of them do not exceed: always one that was observed."""
    if not ranked.size:
        return (np.nan,) * len(SHARES)
    return tuple(float(ranked[int(np.ceil(share * ranked.size - ROUNDING)) - 1]) for share in SHARES)

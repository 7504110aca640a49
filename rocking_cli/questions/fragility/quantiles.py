"""Quantiles of the peak rotation over the runs at an intensity, as numbers, tables and data.

Runs that do not uplift and runs that overturn are counted apart, as they have no peak of rocking. A second set of
quantiles ranks all runs: without uplift as zero, overturned or of unknown outcome as beyond every number.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import isinf
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Integers, Reals
from rocking_cli.io.tables import Columns, stacked
from rocking_cli.names import MIN_MOTIONS, MIN_MOTIONS_OF_MEDIAN, OVERTURNS, UNKNOWN, percent
from rocking_cli.processing.intensity import parse_measure
from rocking_cli.questions.fragility.definition import Definition
from rocking_cli.questions.fragility.observed import Observations
from rocking_cli.questions.fragility.plan import Plan
from rocking_cli.questions.fragility.store import Store
from rocking_cli.questions.fragility.tally import UNKNOWN_PEAK, Tally, endings_of, samples_of
from rocking_cli.short_repr import short_repr
from rocking_cli.studies.fragility.quantities import label
from rocking_cli.views.column import Column, data_of, frame_of, of, only_shown, table_of
from rocking_cli.views.view import ABSENT, Table, number

QUANTILES = (0.16, 0.5, 0.84)
MIN_RECORDS = (MIN_MOTIONS, MIN_MOTIONS_OF_MEDIAN, MIN_MOTIONS)
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

    @property
    def ranks(self) -> list[float | str]:
        """The quantiles of all runs, in words if a run overturns or is unknown."""
        pairs = zip(self.every, self.doubtful, strict=True)
        return [UNKNOWN if doubtful else OVERTURNS if isinf(value) else value for value, doubtful in pairs]


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
    """Yield the quantiles of every structure that has runs, over every measure of the curves of a study.

    They are those of the groups in which observed shares are counted.
    """
    for structure in plan.structures:
        table = np.moveaxis(endings_of(store, plan, structure), 2, 3)  # sample, record, level; restitution and polarity
        runs: NDArray[Any] = (~np.isnan(table)).sum(axis=(3, 4), dtype=np.int32)  # the table of many samples is large
        counted = Tally(plan, samples_of(plan, structure), runs, {}, None)
        for measure in definition.fitted_measures if runs.any() else ():
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
            whole, parts = np.broadcast_to(groups, runs.shape), seen.parts(0.95)
            of_groups = [
                _group(table[whole == k], np.nonzero(whole == k)[1], x[of_cell == k], float(mean), int(records))
                for k, (mean, records) in enumerate(zip(parts.x, parts.records, strict=True))
            ]
            yield Quantiles(structure, measure, seen.stripes, of_groups)


def _group(peaks: Reals, record: Integers, x: Reals, mean: float, records: int) -> Group:
    ranked = np.sort(peaks[~np.isnan(peaks)])
    rocks = (peaks > 0) & (peaks < UNKNOWN_PEAK)
    every = not_exceeded(ranked, records)
    low, high = float(x.min()), float(x.max())
    return Group(
        x=min(max(mean, low), high),  # the mean lies between them, except for rounding
        low=low,
        high=high,
        runs=ranked.size,
        records=records,
        no_uplift=int((ranked == 0).sum()),
        overturned=int(np.isinf(ranked).sum()),
        rocking=not_exceeded(np.sort(peaks[rocks]), np.unique(record[rocks.any(axis=(1, 2))]).size),
        every=tuple(np.inf if value == UNKNOWN_PEAK else value for value in every),
        unknown=int((ranked == UNKNOWN_PEAK).sum()),
        doubtful=tuple(value == UNKNOWN_PEAK for value in every),
    )


def not_exceeded(ranked: Reals, records: int) -> tuple[float, ...]:
    """Return for each share the lowest of increasing observed values that it does not exceed; NaN if too few."""
    return tuple(
        float(ranked[int(np.ceil(share * ranked.size - COUNT_TOLERANCE)) - 1])
        if ranked.size and records >= fewest
        else np.nan
        for share, fewest in zip(QUANTILES, MIN_RECORDS, strict=True)
    )


def data_of_quantiles(found: Sequence[Quantiles], tallies: Mapping[str, Tally]) -> list[dict[str, Any]]:
    """Return quantiles as plain data."""
    return [
        {
            "structure": each.structure,
            "measure": each.measure,
            "unit": parse_measure(each.measure).unit,
            "groups": "stripes" if each.stripes else "tenths",
            "shares": list(QUANTILES),
            "intensities": [data_of(_columns(each, tallies[each.structure]), group) for group in each.groups],
        }
        for each in found
    ]


def quantile_rows(found: Sequence[Quantiles], tallies: Mapping[str, Tally]) -> Columns:
    """Return a row for each group of intensities, with the shares of its runs and the quantiles of their peaks."""
    return stacked(
        {
            "structure": each.structure,
            "measure": each.measure,
            **frame_of([*_columns(each, tallies[each.structure]), *FILED], each.groups),
        }
        for each in found
    )


def tables_of_quantiles(found: Sequence[Quantiles]) -> list[Table | str]:
    """Return tables of quantiles, and what they mean."""
    parts = [part for each in found for part in _tables(each)]
    if parts:
        note = (
            "Quantiles of the peak phi/phi_cr. For all runs, a run without uplift counts as 0 and an overturning run "
            f"ranks above every finite peak; '{OVERTURNS}' marks quantiles that are such runs. The median needs "
            f"{min(MIN_RECORDS)} distinct records, the others {max(MIN_RECORDS)}: then the lowest and the highest peak "
            f"enclose the quantile with a confidence of 95 %. Of fewer records, they are '{ABSENT}'."
        )
        if any(each.unknown for each in found):
            note += (
                f" Runs of {UNKNOWN} outcome have no peak: they are left out of the runs that rock, and rank above "
                f"every finite peak among all runs; '{UNKNOWN}' marks quantiles that are such runs."
            )
        parts.append(note)
    return parts


def _tables(found: Quantiles) -> Iterator[Table | str]:
    """Yield two tables: runs that rock without overturning, with the shares of the others; and all runs."""
    over = f"against {label(found.measure)}{'' if found.stripes else ', in tenths'}"
    columns = _columns(found)
    rocking, every = (
        [only_shown(f"{head}{100 * share:g} %", _entry(name, k), _form) for k, share in enumerate(QUANTILES)]
        for name, head in (("rocking", "rocking\n"), ("ranks", ""))
    )
    yield ""
    yield table_of(f"{found.structure}: peaks of the runs that rock, {over}", [*columns, *rocking], found.groups)
    yield ""
    yield table_of(f"{found.structure}: all runs, {over}", [columns[0], *every], found.groups)


def _entry(name: str, k: int) -> Callable[[Group], Any]:
    """Return a function that reads one of the quantiles that groups have under a name."""
    return lambda group: getattr(group, name)[k]


def _form(value: float | str) -> str:
    return value if isinstance(value, str) else number(value, 3)


FILED: tuple[Column[Group], ...] = tuple(
    Column(None, _entry(name, k), name=f"{word}_{100 * share:g}")
    for name, word in (("rocking", "rocking"), ("every", "all"))
    for k, share in enumerate(QUANTILES)
)
"""The quantiles, a column each, as files and frames have them."""


def _columns(found: Quantiles, tally: Tally | None = None) -> list[Column[Group]]:
    """Return the columns of an intensity; the share of unknown outcomes does not exist if nothing was checked."""
    checked = tally is None or tally.unknown_if_checked is not None

    def share(name: str) -> Callable[[Group], float]:
        return lambda group: getattr(group, name) / group.runs

    head = "un-\nknown" if found.unknown else None
    return [
        Column("x", of("x"), head=label(found.measure)),
        Column("from", of("low")),
        Column("to", of("high")),
        Column("runs", of("runs"), head="runs"),
        Column("distinct_records", of("records"), name="records"),
        Column("no_uplift", share("no_uplift"), head="no\nuplift", form=percent),
        Column("overturned", share("overturned"), head="over-\nturned", form=percent),
        Column("unknown", share("unknown") if checked else lambda group: None, head=head, form=percent),
        Column("rocking", lambda group: list(group.rocking), name=None),
        Column("all", of("ranks"), name=None),
    ]

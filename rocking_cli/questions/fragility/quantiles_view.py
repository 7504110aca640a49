"""View of the quantiles of peak rotations, as text and as data."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from math import isinf
from typing import Any

from rocking_cli.names import OVERTURNS, UNKNOWN, percent
from rocking_cli.processing.intensity import parse_measure
from rocking_cli.questions.fragility.assess import UnknownRuns
from rocking_cli.questions.fragility.quantiles import MIN_RECORDS, QUANTILES, Group, Quantiles
from rocking_cli.studies.fragility.quantities import label
from rocking_cli.views.column import Column, data_of, of, only_shown, table_of
from rocking_cli.views.view import ABSENT, Table, View, number


def with_quantiles(shown: View, found: Sequence[Quantiles], outcomes: Sequence[UnknownRuns], *, in_words: bool) -> View:
    """Add quantiles to the view of a study: always as data, as tables only if `in_words`."""
    assert isinstance(shown.data, Mapping)
    unchecked = {each.structure for each in outcomes if each.unknown is None}
    data = [_data(each, checked=each.structure not in unchecked) for each in found]
    parts = [part for each in found for part in _tables(each)] if in_words else []
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
    return View({**shown.data, "quantiles": data}, [*shown.parts, *parts])


def _tables(found: Quantiles) -> Iterator[Table | str]:
    """Yield two tables: runs that rock without overturning, with the shares of the others; and all runs."""
    over = f"against {label(found.measure)}{'' if found.stripes else ', in tenths'}"
    shares = [f"{100 * share:g} %" for share in QUANTILES]
    columns = _columns(found, checked=True)
    peaks = [_quantile(k, f"rocking\n{share}", of("rocking")) for k, share in enumerate(shares)]
    every = [_quantile(k, share, lambda group: list(_ranks(group))) for k, share in enumerate(shares)]
    yield ""
    yield table_of(f"{found.structure}: peaks of the runs that rock, {over}", [*columns, *peaks], found.groups)
    yield ""
    yield table_of(f"{found.structure}: all runs, {over}", [columns[0], *every], found.groups)


def _quantile(k: int, head: str, values: Callable[[Group], Sequence[float | str]]) -> Column[Group]:
    return only_shown(head, lambda group: values(group)[k], _ratio)


def _ranks(group: Group) -> Iterator[float | str]:
    """Yield the quantiles of all runs, in words if a run overturns or is unknown."""
    for value, doubtful in zip(group.every, group.doubtful, strict=True):
        yield UNKNOWN if doubtful else OVERTURNS if isinf(value) else value


def _ratio(value: float | str) -> str:
    return value if isinstance(value, str) else number(value, 3)


def _data(found: Quantiles, *, checked: bool) -> dict[str, Any]:
    return {
        "structure": found.structure,
        "measure": found.measure,
        "unit": parse_measure(found.measure).unit,
        "groups": "stripes" if found.stripes else "tenths",
        "shares": list(QUANTILES),
        "intensities": [data_of(_columns(found, checked=checked), each) for each in found.groups],
    }


def _columns(found: Quantiles, *, checked: bool) -> list[Column[Group]]:
    """Return the columns of an intensity; the share of unknown outcomes does not exist if nothing was checked."""
    return [
        Column("x", of("x"), head=label(found.measure)),
        Column("from", of("low")),
        Column("to", of("high")),
        Column("runs", of("runs"), head="runs"),
        Column("distinct_records", of("records")),
        Column("no_uplift", lambda group: group.no_uplift / group.runs, head="no\nuplift", form=percent),
        Column("overturned", lambda group: group.overturned / group.runs, head="over-\nturned", form=percent),
        Column(
            "unknown",
            lambda group: group.unknown / group.runs if checked else None,
            head="un-\nknown" if found.unknown else None,
            form=percent,
        ),
        Column("rocking", lambda group: list(group.rocking)),
        Column("all", lambda group: list(_ranks(group))),
    ]

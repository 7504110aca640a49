"""View of the quantiles of peak rotations, as text and as data."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import isinf, isnan
from typing import Any

from rocking_cli.names import OVERTURNS, UNKNOWN, percent
from rocking_cli.processing.intensity import parse_measure
from rocking_cli.studies.fragility.intensity import label
from rocking_cli.studies.fragility.quantiles import SHARES, Group, Quantiles
from rocking_cli.views.view import ABSENT, Table, View, number


def with_quantiles(shown: View, found: Sequence[Quantiles], *, in_words: bool) -> View:
    """Add quantiles to the view of a study: always as data, as tables only if `in_words`."""
    assert isinstance(shown.data, Mapping)
    unchecked = {each["structure"] for each in shown.data.get("outcomes", ()) if each["unknown"] is None}
    tables = [part for each in found for part in _tables(each)] if in_words else []
    note = (
        "Quantiles of the peak phi/phi_cr. For all runs, a run without uplift counts as 0 and an overturning run "
        f"ranks above every finite peak; '{OVERTURNS}' marks quantiles that are such runs."
    )
    if any(each.unknown for each in found):
        note += (
            f" Runs of {UNKNOWN} outcome have no peak: they are left out of the runs that rock, and rank above every "
            f"finite peak among all runs; '{UNKNOWN}' marks quantiles that are such runs."
        )
    parts = [*shown.parts, *tables, *([note] if tables else [])]
    data = [_data(each, checked=each.structure not in unchecked) for each in found]
    return View({**shown.data, "quantiles": data}, parts)


def _tables(found: Quantiles) -> Iterator[Table | str]:
    """Yield two tables: runs that rock without overturning, with the shares of the others; and all runs."""
    over = f"against {label(found.measure)}{'' if found.stripes else ', in tenths'}"
    shares = [f"{100 * share:g} %" for share in SHARES]
    doubtful = bool(found.unknown)
    rocking = [
        [
            number(each.x, 4),
            f"{each.runs}",
            percent(each.no_uplift / each.runs),
            percent(each.overturned / each.runs),
            *([percent(each.unknown / each.runs)] if doubtful else []),
            *(number(value, 3) for value in each.rocking),
        ]
        for each in found.groups
    ]
    names = [label(found.measure), "runs", "no\nuplift", "over-\nturned", *(["un-\nknown"] if doubtful else [])]
    names += [f"rocking\n{share}" for share in shares]
    yield ""
    yield Table(f"{found.structure}: peaks of the runs that rock, {over}", names, rocking, numbers=range(len(names)))
    every = [[number(each.x, 4), *map(_ratio, _ranks(each))] for each in found.groups]
    names = [label(found.measure), *shares]
    yield ""
    yield Table(f"{found.structure}: all runs, {over}", names, every, numbers=range(len(names)))


def _ranks(group: Group) -> Iterator[float | str]:
    """Yield the quantiles of all runs, in words if a run overturns or is unknown."""
    for value, doubtful in zip(group.every, group.doubtful, strict=True):
        yield UNKNOWN if doubtful else OVERTURNS if isinf(value) else value


def _ratio(value: float | str) -> str:
    return value if isinstance(value, str) else ABSENT if isnan(value) else f"{value:.3g}"


def _data(found: Quantiles, *, checked: bool) -> dict[str, Any]:
    return {
        "structure": found.structure,
        "measure": found.measure,
        "unit": parse_measure(found.measure).unit,
        "groups": "stripes" if found.stripes else "tenths",
        "shares": list(SHARES),
        "intensities": [_group(each, checked=checked) for each in found.groups],
    }


def _group(each: Group, *, checked: bool) -> dict[str, Any]:
    return {
        "x": each.x,
        "from": each.low,
        "to": each.high,
        "runs": each.runs,
        "distinct_records": each.records,
        "no_uplift": each.no_uplift / each.runs,
        "overturned": each.overturned / each.runs,
        "unknown": each.unknown / each.runs if checked else None,
        "rocking": list(each.rocking),
        "all": list(_ranks(each)),
    }

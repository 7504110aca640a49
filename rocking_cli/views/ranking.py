"""Ranking of intensity measures by how well they predict the response, as tables and as data."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from textwrap import wrap
from typing import TYPE_CHECKING, Any

from rocking_cli.views.fragility import limit_name
from rocking_cli.views.view import Table, View, number

if TYPE_CHECKING:
    from rocking_cli.studies.fragility.ranking import Ranked, Ranking

NARROW = 12  # characters of a heading


def added(shown: View, rankings: Sequence[Ranking]) -> View:
    """Add the rankings of the measures to the view of a study."""
    given = shown.data() if callable(shown.data) else shown.data
    data: Mapping[str, Any] = {**given, "ranking": [_data(each) for each in rankings]}
    return View(data, [*shown.parts, *(part for each in rankings for part in parts(each))])


def parts(ranking: Ranking) -> Iterator[Table | str]:
    """Yield a table of the measures of a structure, and sentences on it."""
    from rocking_cli.studies.fragility.ranking import judge

    limits = list(ranking.measures[0].dispersions) if ranking.measures else []
    columns = ["measure", "efficiency", "practicality", "proficiency"]
    columns += [f"p\n{name}" for name in ranking.against]
    columns += ["\n".join(["dispersion", *wrap(limit_name(limit), NARROW)]) for limit in limits]
    rows = [_row(each) for each in ranking.measures]
    yield ""
    if rows:
        yield Table(f"{ranking.structure}: which measure predicts best", columns, rows, numbers=range(1, len(columns)))
    yield " ".join(judge(ranking))
    if ranking.alike:
        yield "; ".join(f"{name} ranks equal to {other}" for name, other in ranking.alike.items()) + "."
    for name, why in ranking.left_out.items():
        yield f"{name} is left out: {why}."


def _row(each: Ranked) -> list[str]:
    of = (each.efficiency, each.practicality, each.proficiency)
    return [
        each.measure,
        *(number(value, 3) for value in of),
        *(number(value, 2) for value in each.trends.values()),
        *(number(value, 3) for value in each.dispersions.values()),
    ]


def _data(ranking: Ranking) -> dict[str, Any]:
    from rocking_cli.studies.fragility.ranking import judge

    return {
        "structure": ranking.structure,
        "against": list(ranking.against),
        "measures": [
            {
                "measure": each.measure,
                "efficiency": each.efficiency,
                "practicality": each.practicality,
                "proficiency": each.proficiency,
                "sufficient": each.sufficient,
                "p_values": dict(each.trends),
                "dispersions": [
                    {"limit_state": limit, "dispersion": value} for limit, value in each.dispersions.items()
                ],
                "runs": each.runs,
                "records": each.records,
            }
            for each in ranking.measures
        ],
        "alike": dict(ranking.alike),
        "left_out": dict(ranking.left_out),
        "unknown": ranking.unknown,
        "verdict": judge(ranking),
    }

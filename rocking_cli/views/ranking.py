"""Ranking of intensity measures by how well they predict the response, as tables and as data."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from textwrap import wrap
from typing import TYPE_CHECKING, Any

from rocking_cli.views.column import Column, data_of, of, rounded, table_of
from rocking_cli.views.fragility import limit_name
from rocking_cli.views.view import Table, View

if TYPE_CHECKING:
    from rocking_cli.studies.fragility.definition import Limit
    from rocking_cli.studies.fragility.ranking import Ranked, Ranking

NARROW = 12  # characters of a heading


COLUMNS: tuple[Column[Ranked], ...] = (
    Column("measure", of("measure"), head="measure", text=True),
    Column("efficiency", of("efficiency"), head="efficiency", form=rounded(3)),
    Column("practicality", of("practicality"), head="practicality", form=rounded(3)),
    Column("proficiency", of("proficiency"), head="proficiency", form=rounded(3)),
    Column("sufficient", of("sufficient")),
    Column("p_values", lambda each: dict(each.trends)),
    Column(
        "dispersions",
        lambda each: [{"limit_state": limit, "dispersion": value} for limit, value in each.dispersions.items()],
    ),
    Column("runs", of("runs")),
    Column("records", of("records")),
)


def added(shown: View, rankings: Sequence[Ranking]) -> View:
    """Add the rankings of the measures to the view of a study."""
    given = shown.data() if callable(shown.data) else shown.data
    data: Mapping[str, Any] = {**given, "ranking": [_data(each) for each in rankings]}
    return View(data, [*shown.parts, *(part for each in rankings for part in parts(each))])


def parts(ranking: Ranking) -> Iterator[Table | str]:
    """Yield a table of the measures of a structure, and sentences on it."""
    from rocking_cli.studies.fragility.ranking import judge

    limits = ranking.measures[0].dispersions if ranking.measures else ()
    shown = [
        *COLUMNS,
        *(_entry("trends", name, f"p\n{name}", 2) for name in ranking.against),
        *(_entry("dispersions", limit, _dispersion(limit), 3) for limit in limits),
    ]
    yield ""
    if ranking.measures:
        yield table_of(f"{ranking.structure}: which measure predicts best", shown, ranking.measures)
    yield " ".join(judge(ranking))
    if ranking.alike:
        yield "; ".join(f"{name} ranks equal to {other}" for name, other in ranking.alike.items()) + "."
    for name, why in ranking.left_out.items():
        yield f"{name} is left out: {why}."


def _entry(field: str, key: Limit, head: str, digits: int) -> Column[Ranked]:
    """Return the column of one entry of a mapping of each measure."""
    return Column("", lambda each: getattr(each, field)[key], head=head, form=rounded(digits))


def _dispersion(limit: Limit) -> str:
    """Return the heading of the dispersions of a limit state."""
    return "\n".join(["dispersion", *wrap(limit_name(limit), NARROW)])


def _data(ranking: Ranking) -> dict[str, Any]:
    from rocking_cli.studies.fragility.ranking import judge

    return {
        "structure": ranking.structure,
        "against": list(ranking.against),
        "measures": [data_of(COLUMNS, each) for each in ranking.measures],
        "alike": dict(ranking.alike),
        "left_out": dict(ranking.left_out),
        "unknown": ranking.unknown,
        "verdict": judge(ranking),
    }

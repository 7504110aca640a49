"""Ranking of intensity measures by how well they predict the response, as tables and as data."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from textwrap import wrap
from typing import Any

from rocking_cli.names import UNKNOWN
from rocking_cli.questions.fragility.definition import Limit
from rocking_cli.questions.fragility.ranking import MIN_P_VALUE, MIN_RUNS, Ranked, Ranking
from rocking_cli.questions.fragility.view import limit_name
from rocking_cli.views.column import Column, data_of, of, only_shown, rounded, table_of
from rocking_cli.views.view import Table, View

MAX_HEADING_WIDTH = 12  # characters


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
    assert isinstance(shown.data, Mapping)
    data = {**shown.data, "ranking": [_data(each) for each in rankings]}
    return View(data, [*shown.parts, *(part for each in rankings for part in parts(each))])


def parts(ranking: Ranking) -> Iterator[Table | str]:
    """Yield a table of the measures of a structure, and sentences on it."""
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
    return only_shown(head, lambda each: getattr(each, field)[key], rounded(digits))


def _dispersion(limit: Limit) -> str:
    """Return the heading of the dispersions of a limit state."""
    return "\n".join(["dispersion", *wrap(limit_name(limit), MAX_HEADING_WIDTH)])


def _data(ranking: Ranking) -> dict[str, Any]:
    return {
        "structure": ranking.structure,
        "against": list(ranking.against),
        "measures": [data_of(COLUMNS, each) for each in ranking.measures],
        "alike": dict(ranking.alike),
        "left_out": dict(ranking.left_out),
        "unknown": ranking.unknown,
        "verdict": judge(ranking),
    }


def judge(ranking: Ranking) -> list[str]:
    """Return sentences on a ranking: the most efficient measure, the runs left out, and trends of the residuals."""
    if not ranking.measures:
        none = f"{ranking.structure}: no measure can be ranked: fewer than three runs rock and stand."
        return [none, *_left_out(ranking)]
    best = ranking.measures[0]
    of = f"{best.runs:,} runs of {best.records} record{'s' * (best.records != 1)} that rock and stand"
    first = (
        f"Of {len(ranking.measures)} measures {best.measure} is the most efficient over the {of}: "
        f"ln(phi/phi_cr) scatters by {best.efficiency:.2g} about its line."
    )
    return [first, *_left_out(ranking), *_of_trends(ranking), "Other records may give another order."]


def _left_out(ranking: Ranking) -> list[str]:
    if not ranking.unknown:
        return []
    runs = f"{ranking.unknown:,} run{'s' * (ranking.unknown != 1)}"
    return [f"{runs} of {UNKNOWN} outcome {'are' if ranking.unknown != 1 else 'is'} left out."]


def _of_trends(ranking: Ranking) -> list[str]:
    """Return a sentence on the most efficient measure among those whose residuals have no trend."""
    if not ranking.against:
        return ["What its residuals depend on is not tested: the store has no data to test them against."]
    tested = [each for each in ranking.measures if each.sufficient is not None]
    if not tested:
        return [f"With fewer than {MIN_RUNS} records no trend with {' and '.join(ranking.against)} can be told."]
    free = [each for each in tested if each.sufficient]
    over = " or ".join(ranking.against)
    if not free:
        return [f"The residuals of each have a trend with {over}: none is sufficient."]
    best = free[0]
    which = "It" if best is ranking.measures[0] else f"{best.measure}, with {best.efficiency:.2g},"
    return [
        f"{which} is the most efficient of the {len(free)} whose residuals show no trend with {over} "
        f"(p of {MIN_P_VALUE:g} or more); the absence of a detected trend does not prove that there is none."
    ]

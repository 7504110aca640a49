"""A survey as a single HTML page with a sortable table; it needs no other file and no network."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import partial

from markupsafe import Markup, escape

from rocking_cli.documents.figures import dark_figures, inline_svg, template
from rocking_cli.errors import InputError
from rocking_cli.plotting.language import in_language
from rocking_cli.plotting.moving import asset
from rocking_cli.questions.survey.coordinates import coordinates
from rocking_cli.questions.survey.map_picture import draw_map
from rocking_cli.questions.survey.picture import draw_survey
from rocking_cli.questions.survey.study import Survey
from rocking_cli.questions.survey.view import counts, sentences, table
from rocking_cli.text import printable
from rocking_cli.views.sheet.language import ENGLISH, Language, translated
from rocking_cli.views.view import Table, View

MAX_PAGE_ROWS = 10_000  # browsers need many seconds to lay out more
SUBSCRIPT = re.compile(r"([φθλωψ]|\b[A-Za-z])_([A-Za-z]+(?:,\d)?)")
SYMBOLS = {"zeta": "ζ", "lambda": "λ", "phi_cr": "φ_cr", "kappa2": "κ₂", "eta": "η"}


def render(found: Survey, source: str, about: Sequence[str], say: Language = ENGLISH) -> str:
    """Return the page of a survey.

    Parameters
    ----------
    found : Survey
        The survey; every text in it is escaped.
    source : str
        Source of the structures.
    about : sequence of str
        Further lines of the heading: date and command.
    say : Language
        The language.
    """
    parts: list[Table | str] = [
        table(found, MAX_PAGE_ROWS, longest=None, say=say),
        *counts(found),
        *sentences(found, say=say),
    ]
    rows, *lines = translated(say, View({}, parts)).parts
    assert isinstance(rows, Table)  # the first of them
    left_out = max(0, len(found.rows) - MAX_PAGE_ROWS)
    page = template("survey.html", symbols=symbols).render(
        source=source,
        about=about,
        say=say,
        title=rows.title,
        said=[str(each).replace("`", "") for each in lines],
        picture=inline_svg(in_language(say, partial(draw_survey, found, "")), "survey") if found.rows else None,
        map=_map(found, say),
        columns=[_symbolic(each) for each in rows.columns],
        words=[k for k in range(len(rows.columns)) if k not in rows.numbers],
        rows=rows.rows,
        left_out=left_out
        and say.recognised("shown", f"The table lists the first {MAX_PAGE_ROWS:,} of {len(found.rows):,} structures."),
        bad=[
            (each.line if each.line is not None else "", each.name, each.reason) for each in found.bad[:MAX_PAGE_ROWS]
        ],
        bad_count=len(found.bad),
        style=Markup(asset("motion.css")),
        dark_figures=dark_figures(),
    )
    return printable(page)  # a table may have characters that a page cannot hold


def symbols(text: str) -> Markup:
    """Return a text of this package as HTML, with an underscore after a symbol turned into a subscript."""
    return Markup(SUBSCRIPT.sub(r"\1<sub>\2</sub>", str(escape(text))))


def _map(found: Survey, say: Language) -> Markup | None:
    """Return the map of a survey; None if no structure has coordinates."""
    try:
        where = coordinates(found)
    except InputError:
        return None
    return inline_svg(in_language(say, partial(draw_map, found, where, "")), "map")


def _symbolic(heading: str) -> str:
    for word, symbol in SYMBOLS.items():
        heading = heading.replace(word, symbol)
    return heading.replace("\n", " ")

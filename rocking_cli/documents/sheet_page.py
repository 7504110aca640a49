"""A calculation sheet as a single HTML page that needs no other file and no network."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import count

from markupsafe import Markup, escape
from matplotlib.figure import Figure
from matplotlib.text import Text

from rocking_cli.core import Mechanism
from rocking_cli.documents.figures import inline_svg, template
from rocking_cli.plotting.moving import asset
from rocking_cli.plotting.structure import draw_structure
from rocking_cli.studies.picture import picture
from rocking_cli.text import printable
from rocking_cli.verification.results import MARK
from rocking_cli.views.sheet.document import Drawing, Sheet
from rocking_cli.views.sheet.language import Language

ORIGIN_MARKS = {"print": "", "transcription": "*", "code": "†", "ours": "‡", "plain": ""}
"""Marks beside formulas, by how far these were checked."""
SIGNATURE_FIELDS = ("Place and date", "Name", "Signature", "Stamp")


def render(sheet: Sheet) -> str:
    """Return the page of a calculation sheet.

    Parameters
    ----------
    sheet : Sheet
        The sheet; every text in it is escaped.
    """
    page = template("sheet.html").render(
        sheet=sheet,
        say=sheet.language,
        parts=parts(sheet, alone=True),
        motion_style=Markup(asset("motion.css")),
    )
    return printable(page)


def parts(sheet: Sheet, level: int = 2, *, alone: bool = False) -> Markup:
    """Return the sections of a sheet as HTML, with headings from a given level, such as for a report.

    A sheet that stands `alone` has a place for the signature and its contents after the first section.
    """
    steps, pictures = count(1), count(1)

    def svg(item: Drawing) -> Markup:
        return inline_svg(figure_of(item, sheet.language), f"sheet-{next(pictures)}")

    text = template("sheet_parts.html", formula=formula, svg=svg).render(
        sheet=sheet, say=sheet.language, level=level, step=lambda: next(steps), number=sheet.language.number,
        marks=ORIGIN_MARKS, alone=alone, signed=SIGNATURE_FIELDS,
    )  # fmt: skip
    return Markup(text)


def figure_of(item: Drawing, say: Language) -> Figure:
    """Return a picture of a sheet; the drawing of a structure is in the language of the sheet."""
    if not isinstance(item.figure, Mechanism):
        return item.figure()
    mechanism = item.figure
    title = f"{mechanism.name}: {say.mechanism(mechanism.mechanism, mechanism.title)}"
    figure = draw_structure(picture(mechanism), title)
    for each in figure.findobj(Text):
        assert isinstance(each, Text)  # as selected above
        first, *rest = each.get_text().split("\n")
        each.set_text(say.formula("\n".join([say.texts.get(f"drawing {first}", first), *rest])))
    return figure


def runs(text: str) -> Iterator[tuple[str, str]]:
    """Yield the pieces of a text, each with its place: "sub", "sup" or neither."""
    end = 0
    for mark in MARK.finditer(text):
        yield text[end : mark.start()], ""
        yield mark[2], "sub" if mark[1] == "_" else "sup"
        end = mark.end()
    yield text[end:], ""


def formula(text: str) -> Markup:
    """Return a text with its sub- and superscripts as HTML."""
    pieces = (Markup(f"<{place}>{escape(text)}</{place}>") if place else escape(text) for text, place in runs(text))
    return Markup("").join(pieces)

"""A calculation sheet as a single HTML page that needs no other file and no network."""

from __future__ import annotations

from itertools import count

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup, escape
from matplotlib.figure import Figure

from rocking_cli.core import Mechanism
from rocking_cli.documents.figures import inline_svg
from rocking_cli.documents.translated import translate
from rocking_cli.plotting.moving import asset
from rocking_cli.plotting.structure import draw_structure
from rocking_cli.studies.picture import picture
from rocking_cli.text import printable
from rocking_cli.views.sheet.document import Drawing, Sheet
from rocking_cli.views.sheet.markup import runs

MARKS = {"print": "", "transcription": "*", "code": "†", "ours": "‡", "plain": ""}
"""What stands beside a formula, by how far it was checked."""


def render(sheet: Sheet, mechanism: Mechanism) -> str:
    """Return the page of a calculation sheet.

    Parameters
    ----------
    sheet : Sheet
        The sheet; every text in it is escaped.
    mechanism : Mechanism
        The mechanism to draw.
    """
    page = (
        _environment()
        .get_template("sheet.html")
        .render(
            sheet=sheet, say=sheet.language.say, parts=parts(sheet, mechanism), motion_style=Markup(asset("motion.css"))
        )
    )
    return printable(page)


def parts(sheet: Sheet, mechanism: Mechanism, level: int = 2) -> Markup:
    """Return the sections of a sheet alone as HTML, with headings from a given level, such as for a report."""
    template = _environment().get_template("sheet_parts.html")
    has_drawing = any(isinstance(item, Drawing) for each in sheet.parts for item in each.items)
    steps = count(1)
    text = template.render(
        sheet=sheet, level=level, drawing=_drawing(sheet, mechanism) if has_drawing else "", step=lambda: next(steps),
        number=sheet.language.number, marks=MARKS,
    )  # fmt: skip
    return Markup(text)


def figure_of(sheet: Sheet, mechanism: Mechanism) -> Figure:
    """Return the drawing of the structure, in the language of a sheet."""
    title = f"{mechanism.name}: {sheet.language.mechanism(mechanism.mechanism, mechanism.title)}"
    return translate(draw_structure(picture(mechanism), title), sheet.language)


def _drawing(sheet: Sheet, mechanism: Mechanism) -> Markup:
    return Markup(inline_svg(figure_of(sheet, mechanism), "sheet-drawing"))


def formula(text: str) -> Markup:
    """Return a text with its sub- and superscripts as HTML."""
    return Markup("").join(
        Markup(f"<{run.place}>{escape(run.text)}</{run.place}>") if run.place else escape(run.text)
        for run in runs(text)
    )


def _environment() -> Environment:
    environment = Environment(
        loader=PackageLoader("rocking_cli", "documents/templates"), autoescape=True, undefined=StrictUndefined,
        trim_blocks=True, lstrip_blocks=True,
    )  # fmt: skip
    environment.filters["formula"] = formula
    return environment

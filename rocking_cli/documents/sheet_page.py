"""A calculation sheet as a single HTML page that needs no other file and no network."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from itertools import count

from markupsafe import Markup, escape
from matplotlib.figure import Figure
from matplotlib.text import Text

from rocking_cli.core import Mechanism
from rocking_cli.documents.figures import dark_figures, inline_svg, template
from rocking_cli.documents.mathematics import BRACKETS, Node, Unreadable, formulas_of, pieces, width
from rocking_cli.plotting.moving import asset
from rocking_cli.plotting.structure import draw_structure
from rocking_cli.studies.picture import picture
from rocking_cli.text import printable
from rocking_cli.verification.results import MARK
from rocking_cli.views.sheet.document import Drawing, Sheet
from rocking_cli.views.sheet.language import Language

ORIGIN_MARKS = {"print": "", "transcription": "*", "code": "†", "ours": "‡", "plain": ""}
"""Marks beside formulas, by how far these were checked."""
LEAVES = {"number": "mn", "letter": "mi", "word": "mi", "sign": "mo", "bracket": "mo"}
SCREEN_WIDTH = 25  # characters of a formula that fit on any screen
TEXT_WIDTH = 17.0  # cm of an A4 page, between margins of 2 cm
OWN_PAGES = ("workings", "inputs")  # keys of the sections that begin a page
MAX_FIGURE_HEIGHT = 11.0  # cm
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
        dark_figures=dark_figures(),
    )
    return printable(page)


def parts(sheet: Sheet, level: int = 2, *, alone: bool = False) -> Markup:
    """Return the sections of a sheet as HTML, with headings from a given level, such as for a report.

    A sheet that stands `alone` has a place for the signature and its contents after the first section.
    """
    steps, pictures = count(1), count(1)

    def svg(item: Drawing) -> Markup:
        return inline_svg(lambda: figure_of(item, sheet.language), f"sheet-{next(pictures)}")

    page = template(
        "sheet_parts.html", formula=formula, math=math, is_wide=is_wide, formulas=formulas_of, svg=svg
    )  # fmt: skip
    text = page.render(
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
    translated = partial(say.recognised, "drawing")
    figure = draw_structure(picture(mechanism).in_language(translated), title, say=translated)
    for axes in figure.axes:
        first, end, rest = axes.get_title().partition("\n")
        axes.title.set_text(f"{translated(first)}{end}{rest}")
    for each in figure.findobj(Text):
        assert isinstance(each, Text)  # as selected above
        each.set_text(say.formula(each.get_text()))
    return figure


def printed_width(figure: Figure) -> float:
    """Return the width of a figure on paper, in cm: that of the text, or less if it would be too high."""
    width, height = map(float, figure.get_size_inches())
    return min(TEXT_WIDTH, MAX_FIGURE_HEIGHT * width / height)


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


def math(text: str) -> Markup:
    """Return a formula as MathML, which every current browser draws, or what is no formula as `formula` does."""
    try:
        rows = pieces(text)
    except Unreadable:
        return formula(text)
    return Markup(" ").join(Markup(f'<math displaystyle="true">{_row(each.parts)}</math>') for each in rows)


def is_wide(text: str) -> bool:
    """Return whether a formula may be wider than a narrow screen, so that it is scrolled there."""
    try:
        return any(width(each) > SCREEN_WIDTH for each in pieces(text))
    except Unreadable:
        return False


def _row(nodes: Sequence[Node]) -> Markup:
    """Return the elements of a row; a sign that begins it, or follows another one, is that of a number."""
    begins = (k == 0 or nodes[k - 1].kind == "sign" or nodes[k - 1].text in BRACKETS for k in range(len(nodes)))
    return Markup("").join(_element(node, at_start) for node, at_start in zip(nodes, begins, strict=True))


def _element(node: Node, at_start: bool = False) -> Markup:
    """Return the element of MathML of a piece of a formula."""
    if node.kind in LEAVES:
        name, more = LEAVES[node.kind], ""
        if node.kind == "bracket":
            more = ' stretchy="false"'
        elif node.kind == "sign" and at_start:
            more = ' form="prefix"'
        elif node.kind == "word" and len(node.text) == 1:
            more = ' mathvariant="normal"'
        return Markup(f"<{name}{more}>{escape(node.text)}</{name}>")
    if node.kind == "gap":
        return Markup('<mspace width="0.17em"/>')
    if node.kind == "fence":
        opening, closing = (Markup(f"<mo>{sign}</mo>") for sign in node.text)
        return Markup(f"<mrow>{opening}{_row(node.parts)}{closing}</mrow>")
    if node.kind == "script":
        base, *scripts = node.parts
        name = "m" + "".join(tag for tag, each in zip(("sub", "sup"), scripts, strict=True) if each.parts)
        return Markup(f"<{name}>{''.join(map(_element, [base, *(each for each in scripts if each.parts)]))}</{name}>")
    name = {"row": "mrow", "root": "msqrt", "fraction": "mfrac"}[node.kind]
    inside = _row(node.parts) if node.kind == "row" else "".join(map(_element, node.parts))
    return Markup(f"<{name}>{inside}</{name}>")

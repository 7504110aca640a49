"""A document as a single HTML page that needs no other file and no network."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from functools import partial
from itertools import count

from markupsafe import Markup, escape
from matplotlib.figure import Figure
from matplotlib.text import Text

from rocking_cli.core import Mechanism
from rocking_cli.documents.figures import dark_figures, inline_svg, template
from rocking_cli.documents.mathematics import BRACKETS, Node, Unreadable, formulas_of, pieces, width
from rocking_cli.plotting.moving import as_script, asset
from rocking_cli.plotting.structure import draw_structure
from rocking_cli.studies.picture import picture
from rocking_cli.studies.remark import MARK
from rocking_cli.text import printable
from rocking_cli.views.sheet.document import Drawing, Moving, Sheet, SheetPart
from rocking_cli.views.sheet.language import WORD_JOINER, Language

ORIGIN_MARKS = {"print": "", "transcription": "*", "code": "†", "ours": "‡", "plain": ""}
"""Marks beside formulas, by how far these were checked."""
SCRIPT_TEXT = "script "  # begins the keys of texts of data/motion.js
LEAVES = {"number": "mn", "letter": "mi", "word": "mi", "sign": "mo", "bracket": "mo"}
SCREEN_WIDTH = 25  # characters of a formula that fit on any screen
TEXT_WIDTH = 17.0  # cm of an A4 page, between margins of 2 cm


def render(sheet: Sheet, *, still: bool = False) -> str:
    """Return the page of a document.

    Parameters
    ----------
    sheet : Sheet
        The document; every text in it is escaped.
    still : bool
        Whether moving pictures are replaced by still ones, as for paper.
    """
    steps, pictures = count(1), count(1)

    def svg(item: Drawing) -> Markup:
        return inline_svg(lambda: figure_of(item, sheet.language), f"figure-{next(pictures)}")

    moving = [] if still else [each for part in sheet.parts for each in _moving(part)]
    page = template(
        "document.html",
        css=css_text,
        formula=formula,
        math=math,
        is_wide=is_wide,
        formulas=formulas_of,
        svg=svg,
        as_script=lambda data: Markup(as_script(data)),
    ).render(
        sheet=sheet,
        say=sheet.language,
        step=lambda: next(steps),
        number=sheet.language.number,
        marks=ORIGIN_MARKS,
        moving=moving,
        motion_style=Markup(asset("motion.css")),
        script=Markup(_script(sheet.language)) if moving else "",
        dark_figures=dark_figures(),
    )
    return printable(page)  # names and contents of files may have characters that a page cannot hold


def _script(say: Language) -> str:
    """Return the script of moving pictures, with the texts of its buttons and hints in a language."""
    script = asset("motion.js")
    for key, text in say.texts.items():
        if key.startswith(SCRIPT_TEXT):
            script = script.replace(key.removeprefix(SCRIPT_TEXT), text)
    return script


def _moving(part: SheetPart) -> list[Moving]:
    here = [each for each in part.items if isinstance(each, Moving)]
    return here + [each for below in part.parts for each in _moving(below)]


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


def printed_width(figure: Figure, tallest: float) -> float:
    """Return the width of a figure on paper, in cm: that of the text, or less if it would be higher than `tallest`."""
    width, height = map(float, figure.get_size_inches())
    return min(TEXT_WIDTH, tallest * width / height)


def runs(text: str) -> Iterator[tuple[str, str]]:
    """Yield the pieces of a text, each with its kind: "sub", "sup", "code" (between backticks), or "" for none."""
    end = 0
    for mark in re.finditer(f"`(?!{WORD_JOINER})([^`]+)`|{MARK.pattern}", text):
        yield _unescaped(text[end : mark.start()]), ""
        yield (mark[1], "code") if mark[1] else (mark[3], "sub" if mark[2] == "_" else "sup")
        end = mark.end()
    yield _unescaped(text[end:]), ""


def _unescaped(text: str) -> str:
    return text.replace(f"`{WORD_JOINER}", "`")


def formula(text: str) -> Markup:
    """Return a text with its sub- and superscripts as HTML."""
    pieces = (Markup(f"<{place}>{escape(text)}</{place}>") if place else escape(text) for text, place in runs(text))
    return Markup("").join(pieces)


def css_text(text: str) -> Markup:
    """Return a text as it stands between quotes in CSS: whatever is no letter or digit by its number."""
    return Markup(re.sub(r"[^\w ]", lambda sign: f"\\{ord(sign[0]):x} ", text))


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

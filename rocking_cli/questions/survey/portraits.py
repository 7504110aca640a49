"""Pictures of the objects of a list to scale, in the colours of their classes: rooms, and cards for the stores."""

from __future__ import annotations

from collections.abc import Sequence
from typing import IO, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_pdf import PdfPages
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Polygon, Rectangle

from rocking_cli import names
from rocking_cli.plotting import style
from rocking_cli.questions.survey.inventory import ListedObject
from rocking_cli.questions.survey.study import Survey
from rocking_cli.questions.survey.wording import SurveyedObject, advice, objects
from rocking_cli.text import printable
from rocking_cli.views.sheet.language import Language

LOOKS: dict[str, dict[str, Any]] = {
    "falls": {"facecolor": style.REGIONS[f"{names.OVERTURNS} after two or more"], "hatch": "xx"},
    "may fall": {"facecolor": style.REGIONS[f"{names.OVERTURNS} after one impact"], "hatch": "//"},
    "stands": {"facecolor": style.REGIONS[names.ROCKS], "hatch": ""},
}
"""The look of each class: readers without a cone, and paper without colour, tell them apart."""
SUPPORT: dict[str, Any] = {"facecolor": style.SHADE, "edgecolor": style.FAINT}
DRAWN_TOGETHER = 8  # objects in a picture
SHADOW = style.REGIONS[names.UNKNOWN]
BODY = ((-3, 0), (-3, 34), (-5.5, 34), (-5.5, 60), (-3.5, 62), (3.5, 62), (5.5, 60), (5.5, 34), (3, 34), (3, 0))
"""Corners of a person of a height of 74, without the head."""
MEASURES = (1.7, 0.1, 0.01)  # m: heights of a person, and of bars beside objects that are much smaller
TALLEST, SLOT, GAP = 2.2, 0.74, 0.16  # inches: highest object, least width of an object with its words, between two
MAX_EXTRA = 0.7  # inches: added to the width of each object if there is room
A4 = (210.0, 297.0)  # mm
COLUMNS, ROWS, CARD = 2, 5, (95.0, 55.0)  # cards of a page, and the size of one [mm]
SCALES = (1, 2, 5, 10, 20, 50, 100, 200, 500)  # of which a card takes the largest drawing that fits
SIDES = ("height", "diameter", "width", "depth")
CODE = 18.0  # points of the number on a card
DRAWN = (26.0, 38.0)  # mm: room of a drawing on a card
MM = 1 / 25.4  # inches


def _width(item: ListedObject) -> float:
    return max(max(each.widths()) for each in item.chain)


def _top(item: ListedObject) -> float:
    return sum(each.height for each in item.chain)


def _draw(axes: Axes, one: SurveyedObject, middle: float, floor: float, scale: float) -> None:
    """Draw an object from the front, what it stands on in grey."""
    base = 0.0
    for each in one.item.chain:
        corners = np.array(each.silhouette(*each.widths(), base))
        look = LOOKS[one.danger] | {"edgecolor": style.INK} if each is one.item else SUPPORT
        axes.add_patch(Polygon(corners * scale + (middle, floor), linewidth=style.THIN, zorder=3, **look))
        base += each.height


def _page(width: float, height: float, unit: float = 1.0) -> tuple[Figure, Axes]:
    """Return a figure and axes that are all of it; sizes in a unit of so many inches."""
    figure = Figure(figsize=(width * unit, height * unit), dpi=style.DPI)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(0, width), ylim=(0, height))
    axes.set_axis_off()
    return figure, axes


def _write(axes: Axes, x: float, y: float, text: str, points: float, **look: Any) -> None:
    usual: dict[str, Any] = {"color": style.INK, "parse_math": False}
    axes.text(x, y, printable(text), fontsize=points, **usual | look)


def _shortened(text: str, width: float, points: float, *, keep_end: bool = False, **look: str) -> str:
    """Cut a text, a word too, to a width [inches], at its end or, of a number, at its beginning."""
    short = printable(" ".join(text.split()))
    while len(short) > 2 and style.size_of(style.plain(short), points, **look).real > width:
        short = "…" + short.removeprefix("…")[1:] if keep_end else short.removesuffix("…")[:-1].rstrip() + "…"
    return short


def scale_of(objects: Sequence[SurveyedObject]) -> float:
    """Return inches of a picture for a metre, so that objects fit side by side."""
    scale = TALLEST / max(*(_top(each.item) for each in objects), _measure(objects))
    while sum(_slot(each, scale) for each in objects) + SLOT > style.page_width():
        scale *= 0.97
    return scale


def _slot(one: SurveyedObject, scale: float) -> float:
    return max(_width(one.item) * scale + GAP, SLOT)


def draw_first(found: Survey, say: Language) -> Figure:
    """Draw the first objects of a list, the worst class first."""
    some = objects(found)[: min(DRAWN_TOGETHER, int(style.page_width() / SLOT) - 1)]
    return draw_room(some, say, scale_of(some))


def draw_room(some: Sequence[SurveyedObject], say: Language, scale: float) -> Figure:
    """Draw objects side by side to one scale, each with its number and the word of its class, beside a person.

    Parameters
    ----------
    some : sequence of SurveyedObject
        The objects, from left to right.
    say : Language
        The language.
    scale : float
        Inches of the picture for a metre.
    """
    highest, below = max(*(_top(each.item) for each in some), _measure(some)), 0.36
    figure, axes = _page(style.page_width(), below + scale * highest + 0.06)
    x = _draw_measure(axes, _measure(some), below, scale, say)
    left = style.page_width() - x - sum(_slot(each, scale) for each in some)
    for each in some:
        slot = _slot(each, scale) + min(left / len(some), MAX_EXTRA)
        _draw(axes, each, x + slot / 2, below, scale)
        code = _shortened(each.number(say), slot - 0.04, style.TICK, keep_end=True, weight="bold")
        _write(axes, x + slot / 2, below - 0.15, code, style.TICK, ha="center", fontweight="bold")
        _write(axes, x + slot / 2, below - 0.28, say(each.danger), style.SMALL, ha="center")
        x += slot
    axes.plot([0, x], [below, below], color=style.EARTH, linewidth=style.MEDIUM, zorder=2)
    return figure


def _measure(objects: Sequence[SurveyedObject]) -> float:
    """Return the height of what shows the scale [m]: a person, or a bar beside small objects."""
    largest = max(max(_top(each.item), _width(each.item)) for each in objects)
    return next((each for each in MEASURES if largest >= 0.5 * each), MEASURES[-1])


def _draw_measure(axes: Axes, measure: float, floor: float, scale: float, say: Language) -> float:
    """Draw a person, or a bar beside small objects, and return where the first object begins."""
    height = measure * scale
    if measure == MEASURES[0]:
        axes.add_patch(Polygon(np.array(BODY) * height / 74 + (0.35, floor), color=SHADOW, linewidth=0, zorder=3))
        axes.add_patch(Circle((0.35, floor + height * 68.5 / 74), height * 5.5 / 74, color=SHADOW, linewidth=0))
    else:
        axes.plot([0.35, 0.35], [floor, floor + height], color=style.INK, linewidth=2.5, solid_capstyle="butt")
    text = say.formula(f"{measure:g} m")
    _write(axes, 0.35, floor - 0.15, text, style.SMALL, ha="center", color=style.WORDS[style.STONE])
    return SLOT


def write_cards(stream: IO[bytes], objects: Sequence[SurveyedObject], say: Language) -> None:
    """Write a PDF with a card for each object, in the order of the list, ten a page, with lines to cut along."""
    each_page = COLUMNS * ROWS
    with PdfPages(stream, metadata={"CreationDate": None}) as pages:  # the same bytes each day
        for start in range(0, len(objects), each_page):
            figure = draw_cards(objects[start : start + each_page], say)
            style.save(figure, pages, format="pdf")


def draw_cards(objects: Sequence[SurveyedObject], say: Language) -> Figure:
    """Draw the cards of a page."""
    figure, axes = _page(*A4, MM)
    left, low = (A4[0] - COLUMNS * CARD[0]) / 2, (A4[1] - ROWS * CARD[1]) / 2
    cuts: dict[str, Any] = {"color": style.FAINT, "linewidth": style.HAIR, "linestyle": (0, (6, 4))}
    for k in range(COLUMNS + 1):
        axes.plot([left + k * CARD[0]] * 2, [0, A4[1]], **cuts)
    for k in range(ROWS + 1):
        axes.plot([0, A4[0]], [low + k * CARD[1]] * 2, **cuts)
    for k, each in enumerate(objects):
        _draw_card(axes, each, left + k % COLUMNS * CARD[0], A4[1] - low - (k // COLUMNS + 1) * CARD[1], say)
    return figure


def _draw_card(axes: Axes, one: SurveyedObject, x: float, y: float, say: Language) -> None:
    """Draw a card whose lower left corner is given [mm]."""
    item, wide = one.item, CARD[0] - DRAWN[0] - 11
    part = next((each for each in SCALES if 1000 * max(_width(item) / DRAWN[0], _top(item) / DRAWN[1]) <= each), 1000)
    _draw(axes, one, x + 4 + DRAWN[0] / 2, y + 10, 1000 / part)
    axes.plot([x + 4, x + 4 + DRAWN[0]], [y + 10] * 2, color=style.EARTH, linewidth=style.MEDIUM)
    sides = {key: say.formula(f"{100 * item.sizes[key]:.3g}") for key in SIDES if key in item.sizes}
    size = " x ".join(f"Ø {side}" if key == "diameter" else side for key, side in sides.items())
    _write(axes, x + 4, y + 5.5, _shortened(f"{size} cm", DRAWN[0] * MM, style.SMALL), style.SMALL)
    _write(axes, x + 4, y + 2.5, f"1:{part}", style.SMALL, color=style.WORDS[style.STONE])
    x += DRAWN[0] + 8
    number = printable(one.number(say))
    length = max(style.size_of(style.plain(number), CODE, "bold").real, 0.01) / MM  # of large type
    points = max(CODE * min(1, 0.97 * wide / length), style.SMALL)
    number = _shortened(number, wide * MM, points, keep_end=True, weight="bold")
    _write(axes, x, y + 44, number, points, fontweight="bold")
    titled = _lines(item.title, wide, style.LABEL, 2)
    _write(axes, x, y + 41.5, titled, style.LABEL, va="top", linespacing=1.2)
    room = _shortened(item.room, wide * MM, style.TICK)
    _write(axes, x, y + 37 - 4.5 * titled.count("\n"), room, style.TICK, va="top", color=style.WORDS[style.STONE])
    axes.add_patch(Rectangle((x, y + 22), 5, 5, edgecolor=style.INK, linewidth=style.THIN, **LOOKS[one.danger]))
    _write(axes, x + 7, y + 22.7, say(one.danger), 12, fontweight="bold")
    _write(axes, x, y + 19.5, _lines(advice(one, say, 1), wide, 7.5, 5), 7.5, va="top", linespacing=1.25)


def _lines(text: str, width: float, points: float, most: int) -> str:
    """Break a text into lines of a width [mm], `most` at most."""
    lines = style.folded(style.plain(printable(text)), width * MM, points).replace(r"\$", "$").split("\n")
    lines = [*lines[: most - 1], " ".join(lines[most - 1 :])] if len(lines) > most else lines
    return "\n".join(_shortened(line, width * MM, points) for line in lines)

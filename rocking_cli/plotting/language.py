"""Plots in another language: their texts are recognised, and their numbers have its decimal marks."""

from __future__ import annotations

from collections.abc import Callable

from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.ticker import Formatter

from rocking_cli.plotting import style
from rocking_cli.views.sheet.language import Language


class _Numbers(Formatter):
    """Labels along an axis, with the decimal marks of a language."""

    def __init__(self, say: Language, own: Formatter) -> None:
        self.say, self.own = say, own

    def __call__(self, value: float, pos: int | None = None) -> str:
        return self.say.formula(self.own(value, pos))

    def format_ticks(self, values: list[float]) -> list[str]:
        return [*map(self.say.formula, self.own.format_ticks(values))]


def in_language(say: Language, draw: Callable[[], Figure]) -> Callable[[], Figure]:
    """Return what draws a plot in a language; a text that is not recognised stays in English.

    Parameters
    ----------
    say : Language
        The language, whose texts of the family `figure` are those of plots.
    draw : callable
        Draws the plot in English.
    """
    if say.key == "en":
        return draw

    def translated() -> Figure:
        figure = draw()
        for axis in (axis for axes in figure.axes for axis in (axes.xaxis, axes.yaxis)):
            axis.set_major_formatter(_Numbers(say, axis.get_major_formatter()))
        for each in figure.findobj(Text):
            assert isinstance(each, Text)  # as selected above
            each.set_text(say.formula(_translated(say, each.get_text().split("\n"), float(each.get_fontsize()))))
        return figure

    return translated


def _translated(say: Language, lines: list[str], points: float) -> str:
    """Return a text of a plot in a language; one sentence in several lines is broken anew, into no wider lines."""
    if len(lines) > 1 and (whole := say.matched("figure", " ".join(lines))) is not None:
        return style.folded(whole, max(style.size_of(line, points).real for line in lines), points)
    return "\n".join(say.recognised("figure", line) for line in lines)

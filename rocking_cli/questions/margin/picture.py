"""Plot of margins: the share of neighbours that overturns against the scale factor on each motion."""

from __future__ import annotations

from collections.abc import Mapping
from textwrap import shorten

from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from rocking_cli.plotting import style
from rocking_cli.questions.margin.study import SHARE_LEVELS, Margin

MAX_NAME_LENGTH = 40  # characters of a motion's name in the legend
FACTOR_TICKS = (0.2, 0.5, 1, 2, 5)


def draw_margins(margins: Mapping[str, Margin], title: str) -> Figure:
    """Plot the shares of overturning against the factor on one or more motions; a star marks a factor of 1.

    A hatched band goes from the share that overturns to the share that overturns or is of unknown outcome.

    Parameters
    ----------
    margins : mapping of str to Margin
        The margins, by the name of the motion.
    title : str
        Heading.
    """
    figure, axes = style.one_panel(3.6 + 0.16 * ((len(margins) + 1) // 2 if len(margins) > 1 else 0), title)
    for level in SHARE_LEVELS:
        axes.axhline(level, color=style.FAINT, linewidth=style.THIN, linestyle=":")
    axes.axvline(1.0, color=style.FAINT, linewidth=style.CURVE)
    beyond = False
    for k, (name, each) in enumerate(margins.items()):
        look = style.distinct(k) | {"marker": "", "linewidth": style.BOLD}
        axes.plot(
            each.factors, each.overturned, label=style.plain(shorten(name, MAX_NAME_LENGTH, placeholder=" ...")), **look
        )
        axes.plot(1.0, each.share.lowest, color=look["color"], clip_on=False, **style.STAR)
        if each.unknown.any():
            between = style.UNKNOWN | {"edgecolor": look["color"]}
            axes.fill_between(each.factors, each.overturned, each.at_most, alpha=0.4, **between)
            axes.plot(
                each.factors, each.at_most, color=look["color"], linestyle=look["linestyle"], linewidth=style.CURVE
            )
        if each.uplift is not None:
            # The uplift factor may lie beyond the axis: an arrowhead at that end points to it.
            low, high = each.factors[0], each.factors[-1]
            mark = "<" if each.uplift < low else ">" if each.uplift > high else "|"
            beyond |= mark != "|"
            axes.plot(
                min(max(each.uplift, low), high), 0.0, color=look["color"], clip_on=False, marker=mark,
                markersize=12 if mark == "|" else 7, linestyle="none",
            )  # fmt: skip
    axes.set_xscale("log")
    axes.xaxis.set_major_locator(FixedLocator(FACTOR_TICKS))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.set_ylim(-0.03, 1.03)
    style.in_percent(axes.yaxis)
    doubtful = any(each.unknown.any() for each in margins.values())
    arrow = ", arrowhead: beyond the axis" if beyond else ""
    axes.margins(x=0.01)
    if doubtful:
        axes.fill_between([], [], [], label="hatched: unknown, the share is between the lines", **style.UNKNOWN)
    x = f"scale factor of the motion (star: as given; tick: uplift{arrow})"
    style.tidy(axes, x, "share of neighbours that overturn")
    if len(margins) > 1 or doubtful:
        style.legend_below(figure, handlelength=3.5)
    return figure

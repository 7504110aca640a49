"""Plot of margins: the share of neighbours that overturns against the scale factor on each motion."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from rocking_cli.plotting import style
from rocking_cli.questions.margin.study import SHARE_LEVELS, Margin
from rocking_cli.text import cut

MAX_NAME_LENGTH = 40  # characters of a motion's name
FACTOR_TICKS = (0.2, 0.5, 1, 2, 5)
SHARE_TICKS = (0.0, *sorted({*SHARE_LEVELS, 0.3, 0.7}), 1.0)
POLARITIES = {(1, -1): "worse of both polarities", (-1,): "motion reversed"}


def draw_margins(margins: Mapping[str, Margin], title: str) -> Figure:
    """Plot the shares of overturning against the factor on one or more motions; a star marks a factor of 1.

    A shaded band is the interval of each share, as the neighbours are few. A hatched one goes from the share that
    overturns to the share that overturns or is of unknown outcome. If there is one motion, a second axis has its PGA.

    Parameters
    ----------
    margins : mapping of str to Margin
        The margins, by the name of the motion.
    title : str
        Heading.
    """
    first, alone = next(iter(margins.values())), len(margins) == 1
    height = 3.9 + (0.22 * len(margins) if style.is_narrow() and not alone else 0.0)  # with a legend below
    figure, axes = style.one_panel(height, ", ".join(filter(None, [title, *(margins if alone else ())])))
    axes.axvline(1.0, color=style.FAINT, linewidth=style.CURVE)
    curves = []
    for k, (name, each) in enumerate(margins.items()):
        look = style.distinct(k) | {"marker": "", "linewidth": style.BOLD}
        colour = look["color"]
        axes.fill_between(each.factors, *each.interval, color=colour, alpha=0.15, linewidth=0)
        label = style.plain(f"{cut(name, MAX_NAME_LENGTH)}, {each.of_pga} {each.pga_g:.3g} g{_uplift(each, ', ')}")
        curves += axes.plot(each.factors, each.overturned, label=label, **look)
        axes.plot(1.0, each.share.lowest, color=colour, clip_on=False, **style.STAR)
        if each.unknown.any():
            between = style.UNKNOWN | {"edgecolor": colour}
            axes.fill_between(each.factors, each.overturned, each.at_most, alpha=0.4, **between)
            axes.plot(each.factors, each.at_most, color=colour, linestyle=look["linestyle"], linewidth=style.CURVE)
        _mark_uplift(axes, each, colour, named=alone)
    axes.set_xscale("log")
    axes.xaxis.set_major_locator(FixedLocator(FACTOR_TICKS))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.set_yticks(SHARE_TICKS)
    axes.set_ylim(-0.12 if alone else -0.03, 1.03)
    style.in_percent(axes.yaxis)
    axes.margins(x=0.01)
    if alone and first.pga_g > 0:
        top = axes.secondary_xaxis(
            "top", functions=(partial(np.multiply, first.pga_g), partial(np.multiply, 1 / first.pga_g))
        )
        style.plain_numbers(top.xaxis)
        top.tick_params(labelsize=style.TICK, colors=style.INK)
        top.set_xlabel(f"{first.of_pga} [g]", fontsize=style.LABEL)
    legend = ["star: as given", "" if alone else "tick: uplift"]
    legend += [f"shaded: 5 to 95 % interval of a share of {first.around.count} neighbours"]
    legend += ["hatched: unknown outcomes" if any(each.unknown.any() for each in margins.values()) else ""]
    polarities = POLARITIES.get(tuple(first.polarities))
    y = f"share of neighbours that overturn{f', {polarities}' if polarities else ''}"
    style.tidy(axes, f"scale factor ({'; '.join(filter(None, legend))})", style.folded(y, 2.6, style.LABEL))
    if not alone:
        style.legend_below(figure, curves, handlelength=3.5)
    return figure


def _uplift(found: Margin, before: str = "") -> str:
    return "" if found.uplift is None else f"{before}uplift at {found.uplift:.3g}"


def _mark_uplift(axes: Axes, found: Margin, colour: str, *, named: bool) -> None:
    """Put a tick at the factor of uplift, with its name; if it is beyond the axis, an arrowhead at that end."""
    if found.uplift is None:
        return
    low, high = found.factors[0], found.factors[-1]
    mark = "<" if found.uplift < low else ">" if found.uplift > high else "|"
    at = min(max(found.uplift, low), high)
    size = 12 if mark == "|" else 7
    axes.plot(at, 0.0, color=colour, clip_on=False, marker=mark, markersize=size, linestyle="none")
    if named:
        side = "left" if at < 1.5 * low else "right" if at > high / 1.5 else "center"
        axes.annotate(
            _uplift(found), (at, 0.0), (0, -9), textcoords="offset points", ha=side, va="top", fontsize=style.TICK
        )

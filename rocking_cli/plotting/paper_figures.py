"""Plots of the paper's figures: panels with families of curves that differ also in grey, by dash and darkness."""

from __future__ import annotations

from textwrap import fill
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import ScalarFormatter
from numpy.typing import NDArray

from rocking_cli.plotting import style
from rocking_cli.plotting.structure import draw_at_rest
from rocking_cli.studies.paper_figures import PaperFigure, PaperPanel
from rocking_cli.studies.picture import picture

Reals = NDArray[np.float64]
CAPTION = 115  # characters a line
PANEL, DRAWN = 2.6, 1.4  # inches high
FLAT = 0.01  # what differs by less is shown flat
MOST = 1.5  # ratios beyond are cut off, and the caption says so
LEGEND = 0.3  # inches of a legend above all panels


def draw_paper_figure(paper: PaperFigure) -> Figure:
    """Plot a figure of the paper with its caption below.

    Parameters
    ----------
    paper : PaperFigure
        The figure to plot.

    Returns
    -------
    matplotlib.figure.Figure
    """
    rows, columns = len(paper.panels), len(paper.panels[0])
    cut = any(_is_ratio(panel) and _values(panel).max() > MOST for row in paper.panels for panel in row)
    said = f"Figure {paper.number} of DeJong and Dimitrakopoulos (2014), recomputed. {paper.caption}"
    caption = fill(said + (f" Curves are cut off at a ratio of {MOST:g}." if cut else ""), CAPTION)
    drawn = DRAWN if paper.structures else 0.0
    families = {
        tuple(curve.label for curve in panel.curves) for row in paper.panels for panel in row if len(panel.curves) > 1
    }
    above_all = LEGEND if len(families) == 1 else 0.0
    figure = style.new_figure(PANEL * rows + drawn + above_all + 0.5 + 0.14 * (caption.count("\n") + 1))
    below: Any = figure
    if paper.structures:
        parts: Any = figure.subfigures(2, 1, height_ratios=[drawn, PANEL * rows])
        above, below = parts
        places = above.subplots(1, len(paper.structures), squeeze=False)[0]
        for place, (name, structure) in zip(places, paper.structures.items(), strict=True):
            draw_at_rest(place, picture(structure), name)
    axes = below.subplots(rows, columns, squeeze=False)
    for panel, each in zip((p for row in paper.panels for p in row), axes.flat, strict=True):
        for k, curve in enumerate(panel.curves):
            width = 0.7 if curve.thin else 1.6 - 0.15 * k
            each.plot(curve.x, curve.y, label=curve.label, linewidth=width, **style.family(k))
        if panel.log:
            each.set_xscale("log")
            each.set_xticks([1, 2, 5, 10])
            each.xaxis.set_major_formatter(ScalarFormatter())
            each.minorticks_off()
        each.ticklabel_format(axis="y", useOffset=False)
        values = _values(panel)
        if _is_ratio(panel):
            each.axhline(1.0, color=style.FAINT, linewidth=style.THIN)
            low, high = values.min(), min(values.max(), MOST)
            margin = 0.05 * max(high - low, FLAT)
            each.set_ylim(min(low - margin, 1 - margin), max(high + margin, 1 + margin))
        elif np.ptp(values) < FLAT:
            each.set_ylim(values.mean() - FLAT, values.mean() + FLAT)
        each.set_title(panel.title, fontsize=style.TICK, loc="left")
        each.set_xlabel(panel.xlabel, fontsize=style.TICK)
        each.set_ylabel(panel.ylabel, fontsize=style.TICK)
        style.tidy(each)
    if above_all:  # one for all panels, on none of their curves
        handles = max((each.get_lines() for each in axes.flat), key=len)
        handles = [line for line in handles if not line.get_label().startswith("_")]
        look = style.LEGEND | {"fontsize": style.TICK, "handlelength": 3.0}
        below.legend(handles=handles, loc="outside upper center", ncols=len(handles), **look)
        families.clear()
    labels: list[str] = []
    for panel, each in zip((p for row in paper.panels for p in row), axes.flat, strict=True):
        if families and [curve.label for curve in panel.curves] != labels and len(panel.curves) > 1:  # where it changes
            labels = [curve.label for curve in panel.curves]
            each.legend(**style.LEGEND | {"fontsize": style.SMALL})
    below.supxlabel(caption, fontsize=style.SMALL, x=0.01, ha="left", color=style.INK)
    return figure


def _values(panel: PaperPanel) -> Reals:
    """Return all finite values of a panel."""
    return np.concatenate([curve.y[np.isfinite(curve.y)] for curve in panel.curves])


def _is_ratio(panel: PaperPanel) -> bool:
    """Return whether a panel shows ratios of the block's times to the structure's."""
    return panel.ylabel.startswith(("$T", "$t"))

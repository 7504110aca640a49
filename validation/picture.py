"""Reliability diagram: observed shares of overturning against stated ones, and how often each is stated."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from rocking_cli.errors import InputError
from rocking_cli.plotting import style
from validation.rules import Scored

HISTOGRAM_BINS = 20
MAX_LINEAR_COUNT = 10  # tests in a bin: with more, the axis of counts is logarithmic


def draw_reliability(found: Scored) -> Figure:
    """Draw observed against stated shares in five bins with their intervals, and below the number of tests.

    Parameters
    ----------
    found : Scored
        The scores, of at least one test with an observed outcome.

    Raises
    ------
    InputError
        If no outcome was observed.
    """
    bins = [each for each in found.bins if each.tests]
    if not bins:
        raise InputError("a reliability diagram needs tests with an observed outcome, which none of these have")
    figure, ((axes,), (below,)) = style.panels(6.6, 2, sharex=True, height_ratios=(3, 1))
    tests = len(found.observed)
    style.heading(axes, f"Stated and observed shares of overturning: {tests} tests in {found.clusters} clusters")
    axes.plot([0, 1], [0, 1], color=style.FAINT, linewidth=style.MEDIUM, linestyle="--", label="stated = observed")
    stated, observed = [each.stated for each in bins], np.array([each.observed for each in bins])
    value, low, high = observed.T
    ends = [np.maximum(value - low, 0.0), np.maximum(high - value, 0.0)]
    axes.errorbar(
        stated, value, ends, color=style.INK, marker="o", markersize=7, linestyle="none", capsize=4,
        label="observed, 5 to 95 % of draws of clusters",
    )  # fmt: skip
    lone = [each for each in bins if each.clusters == 1]
    if lone:
        axes.plot(
            [each.stated for each in lone], [each.observed.value for each in lone], linestyle="none",
            label="observed in one cluster: no interval", **(style.MARKED | {"markersize": 7}),
        )  # fmt: skip
    for each in bins:
        right = each.stated < 0.8
        axes.annotate(
            f"{each.tests}", (each.stated, each.observed.value), (9 if right else -9, -9), textcoords="offset points",
            ha="left" if right else "right", va="top", fontsize=style.TICK,
        )  # fmt: skip
    axes.set_ylim(-0.08, 1.04)
    shares = [
        [each.share or 0.0 for each in found.observed if bool(each.test.overturned) is overturned]
        for overturned in (False, True)
    ]
    counts, _, _ = below.hist(
        shares, bins=np.linspace(0, 1, HISTOGRAM_BINS + 1),
        color=[style.SHADE, style.EXCEEDED], edgecolor=style.INK, linewidth=style.HAIR, label=["stood", "overturned"],
    )  # fmt: skip
    if np.max(counts) > MAX_LINEAR_COUNT:
        below.set_yscale("symlog", linthresh=MAX_LINEAR_COUNT)
        below.yaxis.set_major_formatter(lambda count, _: f"{count:g}")
    else:
        below.yaxis.set_major_locator(MaxNLocator(integer=True, nbins=4))
    below.set_xlim(-0.02, 1.02)
    for panel in (axes, below):
        style.in_percent(panel.xaxis)
    style.in_percent(axes.yaxis)
    style.tidy(axes, y="observed share")
    style.tidy(below, "stated share of neighbours that overturn (numbers: tests in the bin)", "tests")
    style.legend_below(figure)
    return figure

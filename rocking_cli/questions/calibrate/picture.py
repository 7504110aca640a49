"""Plots of a calibration: a trace with its fit and residuals, and the likelihood over slenderness and restitution."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from rocking_cli.arrays import Reals
from rocking_cli.names import percent
from rocking_cli.plotting import style
from rocking_cli.questions.calibrate.region import EDGE_DROP, REGION_PROBABILITY, JointRegion
from rocking_cli.questions.calibrate.study import MIN_GAP_RATIO, TraceFit

LOWER = (-20.0, -15.0, -10.0, -7.0, -5.0)  # log-likelihood, less the largest, of the lines outside the joint region


def draw_trace(found: TraceFit, name: str) -> Figure:
    """Draw a trace of free rocking, its fit and impacts, and below the residuals of both fits.

    Parameters
    ----------
    found : TraceFit
        The fit.
    name : str
        Name of the structure.
    """
    figure, ((axes,), (below,)) = style.panels(5.6, 2, sharex=True, height_ratios=(2.2, 1))
    style.heading(axes, f"{name}: free rocking, eta = {found.eta.value:.4f}, scatter {found.scatter:.2g}")
    times, degrees = found.trace.times, np.degrees
    start, end = found.part
    # Lifting and holding may take much longer than rocking.
    axes.set_xlim(start - 0.15 * (end - start), end + 0.02 * (end - start))
    axes.plot(
        times,
        degrees(found.trace.angles),
        color=style.RECORD_COLOUR,
        marker=".",
        markersize=3,
        linestyle="none",
        label="trace",
    )
    axes.plot(*_broken(times, degrees(found.fitted)), color=style.INK, linewidth=style.MEDIUM, label="fit with one eta")
    rest = degrees(found.offset.value + found.drift.value * times)
    axes.plot(times, rest, color=style.FAINT, linewidth=style.THIN, linestyle="--", label="at rest")
    at_impact = degrees(found.offset.value + found.drift.value * found.impacts)
    axes.plot(found.impacts, at_impact, label="impacts", linestyle="none", **{**style.MARKED, "markersize": 5})
    for values, look, label in (
        (found.fitted, {"color": style.INK, "linewidth": style.THIN}, "one eta"),
        (found.own, {"color": style.EXCEEDED, "linewidth": style.THIN, "linestyle": "--"}, "an eta for each impact"),
    ):
        below.plot(*_broken(times, degrees(found.trace.angles - values)), label=label, **look)
    noise = degrees(found.noise)
    below.axhspan(-2 * noise, 2 * noise, color=style.SHADE, zorder=0, label="twice the noise")
    style.tidy(axes, y="angle [deg]")
    style.tidy(below, "time [s]", "residual [deg]")
    style.legends_below(figure, [(each, each.get_legend_handles_labels()[0]) for each in (axes, below)], ncols=4)
    return figure


def _broken(times: Reals, values: Reals) -> tuple[Reals, Reals]:
    """Return a curve with breaks where the trace has gaps."""
    steps = np.diff(times)
    gaps = np.flatnonzero(steps > MIN_GAP_RATIO * np.median(steps)) + 1
    return np.insert(times, gaps, np.nan), np.insert(values, gaps, np.nan)


def draw_region(found: JointRegion, name: str) -> Figure:
    """Draw the likelihood over slenderness and restitution, and the edge of the joint region.

    Parameters
    ----------
    found : JointRegion
        The likelihood.
    name : str
        Name of the structure.
    """
    figure, axes = style.one_panel(
        4.6, f"{name}: slenderness and restitution from {found.tests} tests in {found.clusters} clusters"
    )
    across, up = found.restitution, found.slenderness
    below = np.maximum(found.likelihood - found.likelihood.max(), -20.0)
    inside: dict[str, Any] = {"facecolor": style.SATISFIED, "edgecolor": style.INK, "linewidth": style.BOLD}
    axes.contourf(across, up, below, levels=[-EDGE_DROP, 1.0], colors=[style.SATISFIED])
    for level in (*LOWER, -EDGE_DROP):
        edge = level == -EDGE_DROP
        look: dict[str, Any] = {
            "colors": [style.INK if edge else style.FAINT],
            "linewidths": style.BOLD if edge else style.THIN,
        }
        if below.min() < level:
            line = axes.contour(across, up, below, levels=[level], linestyles="solid", **look)
            if not edge:
                axes.clabel(line, fmt="%g", fontsize=style.SMALL, colors=style.INK)
    points = axes.plot(*(each.ravel() for each in np.meshgrid(across, up)), ".", color=style.FAINT, markersize=2)
    best = axes.plot(*found.best[::-1], color=style.CURSOR, label="likeliest", **style.STAR)
    region = Patch(label=f"joint region of {percent(REGION_PROBABILITY)}", **inside)
    (less,) = axes.plot([], [], color=style.FAINT, linewidth=style.THIN, label="log-likelihood less the largest")
    points[0].set_label("points computed")
    style.legend_below(figure, [*best, region, less, *points])
    style.tidy(axes, "restitution eta", "factor on slenderness")
    return figure

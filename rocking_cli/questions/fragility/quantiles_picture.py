"""Plot of the quantiles of a structure's peak rotation against intensity, and of the shares of runs without any."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rocking_cli import names
from rocking_cli.arrays import Bools, Reals
from rocking_cli.plotting import style
from rocking_cli.plotting.curve_names import name_curves
from rocking_cli.questions.fragility.quantiles import MIN_RECORDS, QUANTILES, Quantiles

MIN_LOG_RATIO = 30.0  # ratio of the ends of an axis from which it is logarithmic
BAND_OPACITY = 0.16  # opacity of the area between the lowest quantile and the highest
DASHES = ("--", "-", "-.")
ORDER = (names.NO_UPLIFT, names.ROCKS, names.UNKNOWN, names.OVERTURNS)


def draw_quantiles(found: Quantiles, label: str) -> Figure:
    """Plot the quantiles of the peak rotation, and below them the shares that do not uplift, rock, and overturn.

    The share of unknown outcome is hatched.

    Parameters
    ----------
    found : Quantiles
        The quantiles of one structure over one measure.
    label : str
        The measure, with its unit in brackets.

    Returns
    -------
    matplotlib.figure.Figure
        The quantiles are those of all runs. They end with a mark in the band of overturning, or of unknown outcome.
    """
    figure, ((above,), (below,)) = style.panels(4.7, 2, sharex=True, height_ratios=(3, 1.3))
    style.heading(above, f"{found.structure}: peak rotation")
    x = np.array([each.x for each in found.groups])
    if x[-1] > MIN_LOG_RATIO * x[0]:
        style.logarithmic(below.xaxis)
    else:
        below.set_xlim(0.0, 1.03 * x[-1])
    style.tidy(above, y=r"peak rotation $\phi/\phi_{cr}$")
    style.tidy(below, label + ("" if found.stripes else ", means of tenths of the runs"), "runs")
    shares = _draw_shares(below, x, found)
    handles = _draw_peaks(above, x, found)
    style.legend_below(figure, [*shares, *handles], 4, grows=True)
    return figure


def _draw_peaks(axes: Axes, x: Reals, found: Quantiles) -> list[Any]:
    """Draw the quantiles of all runs; return the entries of the legend."""
    every = np.array([each.every for each in found.groups]).T
    beyond = np.isinf(every)
    largest = float(np.max(every, initial=0.0, where=np.isfinite(every)))
    floor = 1.06 * max(1.0, largest) if beyond.any() or largest > 0.5 else 1.15 * max(largest, 1e-3)
    top = 1.12 * floor if beyond.any() else floor
    ticks = np.arange(0.0, floor, 0.2 if floor > 0.5 else floor / 5).tolist()
    if beyond.any():
        axes.axhspan(floor, top, color=style.SHADE, linewidth=0)
        known = not any(any(each.doubtful) for each in found.groups)
        word = names.OVERTURNS if known else f"{names.OVERTURNS}\nor {names.UNKNOWN}"
        axes.set_yticks([*ticks, (floor + top) / 2], [*(f"{y:.2g}" for y in ticks), word])
    axes.set_ylim(0.0, top)
    return draw_fractiles(axes, x, np.where(beyond, (floor + top) / 2, every), beyond)


def draw_fractiles(axes: Axes, x: Reals, peaks: Reals, beyond: Bools) -> list[Line2D]:
    """Draw the quantiles of peak rotations, named at the curves if there is room.

    Parameters
    ----------
    axes : Axes
        The panel, with its final limits.
    x : ndarray, shape (m,)
        Intensities, ascending.
    peaks : ndarray, shape (3, m)
        The quantiles of `QUANTILES`; NaN of those that too few records give. The label of the axis then says
        how many are needed.
    beyond : ndarray of bool, shape (3, m)
        Whether the quantile is a run that overturns or of unknown outcome. From where this lasts to the largest
        intensity, the line ends with a mark.

    Returns
    -------
    list
        The lines for a legend; empty if they are named.
    """
    axes.fill_between(x, peaks[0], peaks[2], color=style.INK, alpha=BAND_OPACITY, linewidth=0.0)
    lines: list[Line2D] = []
    for share, line, outside, dash in zip(QUANTILES, peaks, beyond, DASHES, strict=True):
        known = ~np.isnan(line)
        if not known.any():
            continue
        at, y, out = x[known], line[known], outside[known]
        end = min(int(np.flatnonzero(~out).max(initial=-1)) + 2, at.size)
        weight = style.BOLD if share == 0.5 else style.MEDIUM
        lines += axes.plot(
            at[:end], y[:end], color=style.INK, linestyle=dash, linewidth=weight, marker=".", markersize=3, zorder=4,
            label="median" if share == 0.5 else f"{100 * share:g} % of runs below",
        )  # fmt: skip
        if out[end - 1]:
            axes.plot(at[end - 1], y[end - 1], color=style.INK, marker="^", markersize=6, zorder=5)
    if np.isnan(peaks).any():
        needs = f"records needed: {min(MIN_RECORDS)} for the median, {max(MIN_RECORDS)} for 16 and 84 %"
        needs = style.folded(needs, style.page_width() - style.MAX_SIDE_MARGIN, style.TICK)
        axes.set_xlabel(f"{axes.get_xlabel()}\n{needs}".strip(), fontsize=style.TICK)
    return [] if lines and name_curves(axes, lines) else lines


def _draw_shares(axes: Axes, x: Reals, found: Quantiles) -> list[Any]:
    """Draw the shares of the runs, stacked; return the legend entries."""
    runs = np.array([each.runs for each in found.groups])
    still, unknown, fallen = (
        np.array([getattr(each, of) for each in found.groups]) / runs for of in ("no_uplift", "unknown", "overturned")
    )  # fmt: skip
    colors = (style.REGIONS[names.NO_UPLIFT], style.REGIONS[names.ROCKS], style.SHADE, style.OVERTURNED)
    shares = [still, 1 - still - unknown - fallen, unknown, fallen]
    those = [k for k in range(len(ORDER)) if ORDER[k] != names.UNKNOWN or found.unknown]
    drawn = axes.stackplot(
        x, *(shares[k] for k in those), labels=[ORDER[k] for k in those], colors=[colors[k] for k in those],
        edgecolor=style.INK, linewidth=style.THIN,
    )  # fmt: skip
    for each in drawn:
        if each.get_label() == names.UNKNOWN:
            each.set_hatch(style.UNKNOWN["hatch"])
            each.set_edgecolor(style.UNKNOWN["edgecolor"])
    axes.set_ylim(0.0, 1.0)
    style.in_percent(axes.yaxis)
    return list(drawn)

"""Plot of the quantiles of a structure's peak rotation against intensity, and of the shares of runs without any."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from rocking_cli import names
from rocking_cli.plotting import style
from rocking_cli.questions.fragility.quantiles import Quantiles

Reals = NDArray[np.float64]
MIN_LOG_RATIO = 30.0  # ratio of the ends of an axis from which it is logarithmic
BAND_OPACITY = 0.16  # opacity of the area between the lowest quantile and the highest
LINE_END = 0.85  # height in the band of overturning at which the lines end
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
        Lines with marks, over a shade: runs that rock without overturning. Black lines: all runs; they end in the band
        of overturning, or of unknown outcome.
    """
    figure, ((above,), (below,)) = style.panels(5.2, 2, sharex=True, height_ratios=(3, 1.3))
    style.heading(above, f"{found.structure}: peak rotation")
    x = np.array([each.x for each in found.groups])
    handles = _peaks(above, x, found) + _shares(below, x, found)
    if x[-1] > MIN_LOG_RATIO * x[0]:
        style.logarithmic(below.xaxis)
    else:
        below.set_xlim(0.0, 1.03 * x[-1])
    style.tidy(above, y=r"peak rotation $\phi/\phi_{cr}$")
    style.tidy(below, label + ("" if found.stripes else ", means of tenths of the runs"), "runs")
    style.legend_below(figure, handles, 3)
    return figure


def _peaks(axes: Axes, x: Reals, found: Quantiles) -> list[Any]:
    """Draw the quantiles of the runs that rock without overturning, and of all; return the legend entries."""
    rocking, every = (np.array([getattr(each, of) for each in found.groups]).T for of in ("rocking", "every"))
    largest = np.concatenate([rocking[np.isfinite(rocking)], every[np.isfinite(every)], [0.0]]).max()
    falls = bool(np.isinf(every).any())
    floor = 1.06 * max(1.0, largest) if falls or largest > 0.5 else 1.15 * max(largest, 1e-3)
    top = 1.12 * floor if falls else floor
    color = style.distinct(2)["color"]
    shade = axes.fill_between(x, rocking[0], rocking[2], color=color, alpha=BAND_OPACITY, linewidth=0.0)
    shade.set_label("runs that rock, 16 to 84 %")
    blank = Line2D([], [], linestyle="none", label="")  # so that each column of the legend has one kind
    handles: list[Any] = [shade if np.isfinite(rocking[0]).any() else blank]
    handles += axes.plot(x, rocking[1], color=color, linewidth=style.BOLD, marker="o", markersize=3.5,
                         label="runs that rock, median", zorder=4)  # fmt: skip
    handles += [blank, blank] if found.unknown else [blank]
    for line, dash, name in zip(every, ("--", "-", "-."), ("16 %", "median", "84 %"), strict=True):
        end = np.where(np.isinf(line), floor + LINE_END * (top - floor), line)
        end[1:][np.isinf(line[1:]) & np.isinf(line[:-1])] = np.nan
        (drawn,) = axes.plot(x, end, color=style.INK, linestyle=dash, linewidth=style.MEDIUM, label=f"all runs, {name}")
        handles.append(blank if np.isnan(line).all() else drawn)  # too few records give no line
    handles += [blank] if found.unknown else []
    ticks = np.arange(0.0, floor, 0.2 if floor > 0.5 else floor / 5).tolist()
    if falls:
        axes.axhspan(floor, top, color=style.SHADE, linewidth=0)
        middle = (floor + top) / 2
        known = not any(any(each.doubtful) for each in found.groups)
        word = names.OVERTURNS if known else f"{names.OVERTURNS}\nor {names.UNKNOWN}"
        axes.set_yticks([*ticks, middle], [*(f"{y:.2g}" for y in ticks), word])
    axes.set_ylim(0.0, top)
    return handles


def _shares(axes: Axes, x: Reals, found: Quantiles) -> list[Any]:
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

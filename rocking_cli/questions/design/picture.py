"""Plot of a design: the metric against the field that varies, and the required level."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from rocking_cli.plotting import style
from rocking_cli.questions.design.study import Design

HEADROOM = 0.12  # share of the height above the curve
MAX_MARKED_VALUES = 60  # largest number of values of the scan that are marked one by one


def draw_design(found: Design) -> Figure:
    """Draw the scan, the level, the ranges in which the requirement holds and the answer.

    Parameters
    ----------
    found : Design
        The result of the search to plot.
    """
    figure, axes = style.one_panel(3.8, f"{found.structure}: {found.field} for {found.aim}")
    finite = np.isfinite(found.metric)
    shown = np.where(finite, found.metric, np.nan)
    for k, (low, high) in enumerate(found.holds):
        axes.axvspan(low, high, color=style.SATISFIED, linewidth=0, label=f"{found.aim} holds" if k == 0 else None)
    axes.axhline(found.aim.level, color=style.EXCEEDED, linewidth=style.BOLD, linestyle="--", label="required level")
    few = finite.sum() <= MAX_MARKED_VALUES
    axes.plot(
        found.values, shown, color=style.INK, linewidth=style.BOLD, marker="o" if few else "", markersize=3,
        label=f"{found.aim.metric.name}, {len(found.values)} values tried",
    )  # fmt: skip
    _mark_unknown(axes, found)
    _mark_missing(axes, found)
    if found.value is not None:
        at = _height(found)
        axes.plot(
            found.value, at, color=style.CURSOR, label=f"answer: {found.value:.5g} {found.unit}".rstrip(), **style.STAR
        )
    axes.set_xlim(float(found.values[0]), float(found.values[-1]))
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + HEADROOM * (high - low))
    unit = f" [{found.unit}]" if found.unit else ""
    of_metric = f" [{found.aim.metric.unit}]" if found.aim.metric.unit else ""
    axes.set_xlabel(style.fitted(f"{found.field}{unit}", 5, style.LABEL), fontsize=style.LABEL, parse_math=False)
    style.tidy(axes, y=f"{found.aim.metric.name}{of_metric}")
    style.legend_below(figure)
    return figure


def _height(found: Design) -> float:
    """Return the height at which the answer is drawn: the level, or the metric if it jumps past the level."""
    assert found.value is not None
    finite = np.isfinite(found.metric)
    if not finite.any():
        return found.aim.level
    if found.aim.metric.shaken:
        return float(np.interp(found.value, found.values[finite], found.metric[finite]))
    return found.aim.level


def _unknown(found: Design) -> NDArray[np.bool_]:
    """Return a mask of the values at which some neighbours have an unknown outcome."""
    return np.array([neighbours is not None and bool(neighbours.unknown) for neighbours in found.behind], dtype=bool)


def _mark_unknown(axes: Axes, found: Design) -> None:
    """Put open symbols at values at which some neighbours are of unknown outcome."""
    here = _unknown(found) & np.isfinite(found.metric)
    if here.any():
        axes.plot(
            found.values[here], found.metric[here], linestyle="none", marker="D", markersize=5, color=style.PAPER,
            markeredgecolor=style.INK, label="open: some neighbours of unknown outcome, counted as overturning",
        )  # fmt: skip


def _mark_missing(axes: Axes, found: Design) -> None:
    """Mark values without a metric by crosses, and those at which most neighbours overturn by triangles."""
    across, doubtful = axes.get_xaxis_transform(), _unknown(found)
    for values, height, marker, label in (
        (found.values[np.isnan(found.metric)], 0.03, "x", "could not be computed"),
        (found.values[np.isinf(found.metric) & ~doubtful], 0.97, "^", "at least half of the neighbours overturn"),
        (found.values[np.isinf(found.metric) & doubtful], 0.97, "D", "at least half overturn or are unknown"),
    ):
        if values.size:
            axes.plot(
                values,
                np.full(values.size, height),
                marker,
                transform=across,
                color=style.FAINT,
                markerfacecolor=style.PAPER if marker == "D" else style.FAINT,
                markersize=5,
                label=label,
            )

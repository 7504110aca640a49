"""Polar plot of the peak rotations over all directions of a structure's plane."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import shorten
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from rocking_cli import names
from rocking_cli.plotting import style
from rocking_cli.questions.respond.azimuths import AzimuthResponses

# Ratio phi/phi_cr at which directions that overturn are marked; motions that come back rarely reach it.
OVERTURNED_RADIUS = 1.08
MAX_NAME_LENGTH = 32  # characters


def draw_azimuths(found: AzimuthResponses, title: str, free: Sequence[bool]) -> Figure:
    """Plot the peak rotation in each direction.

    Parameters
    ----------
    found : AzimuthResponses
        The responses: a closed curve for each model, crosses outside for overturning, circles for an unknown outcome.
    title : str
        Heading.
    free : sequence of bool
        Whether each direction has no critical rotation.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, ((axes,),) = style.panels(6.4, projection="polar")
    axes.set_theta_zero_location("N")
    axes.set_theta_direction(-1)
    style.heading(axes, title)
    angles = np.radians(np.append(found.azimuths, found.azimuths[0]))
    peaks = {name: np.where(each.unknown, np.nan, each.peak_ratio) for name, each in found.outcomes.items()}
    reach = max((float(np.nanmax(each)) for each in peaks.values() if np.isfinite(each).any()), default=0.0)
    falls = any(each.fell.any() for each in found.outcomes.values())
    doubtful = any(each.unknown.any() for each in found.outcomes.values())
    marked = falls or doubtful
    outside = max(OVERTURNED_RADIUS, reach * OVERTURNED_RADIUS)
    for k, (name, each) in enumerate(found.outcomes.items()):
        look: Any = style.LINES[name]
        axes.plot(angles, np.append(peaks[name], peaks[name][0]), label=style.LABELS[name], **look)
        ring = outside * (1 + 0.07 * k)
        for flags, marker in ((each.fell, "x"), (each.unknown, "o")):
            at = np.radians(found.azimuths[flags])
            axes.plot(
                at, np.full(at.size, ring), linestyle="none", marker=marker, markersize=5, color=look["color"],
                markerfacecolor="white",
            )  # fmt: skip
    if marked or reach > 0.5:
        around = np.linspace(0.0, 2 * np.pi, 361)
        axes.plot(around, np.ones(around.size), color=style.FAINT, linewidth=style.MEDIUM, linestyle=":")
    axes.set_ylim(0.0, outside * (1 + 0.07 * len(found.outcomes)) if marked else max(1.1 * reach, 1e-3))
    one, other = (shorten(name, MAX_NAME_LENGTH, placeholder=" ...") for name in found.names)
    axes.set_xticks(np.radians(np.arange(0, 360, 30)))
    axes.tick_params(labelsize=style.TICK, colors=style.INK)
    axes.set_rlabel_position(67)
    axes.grid(True, color=style.GRID, linewidth=style.THIN)
    label = f"peak {style.over(free, math=True)}; 0° is {style.plain(one)}, 90° {style.plain(other)}"
    crosses = f"; crosses: {names.OVERTURNS}" if falls else ""
    circles = f"; circles: {names.UNKNOWN}" if doubtful else ""
    axes.set_xlabel(label + crosses + circles, fontsize=style.LABEL)
    axes.legend(loc="upper left", bbox_to_anchor=(1.02, 1.0), **style.LEGEND)
    return figure

"""Polar plot of the peak rotations over all directions of a structure's plane."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import shorten
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from rocking_cli import names
from rocking_cli.arrays import Bools, Reals
from rocking_cli.plotting import style
from rocking_cli.questions.respond.azimuths import AZIMUTH_STEP, AzimuthResponses

HEIGHT, SPARE = 6.6, 1.4  # inches of the figure at most, and more than its width
# Radius over the peaks, and phi/phi_cr, at which the first arc is drawn; motions that come back rarely reach it.
FIRST_ARC, NEXT_ARC = 1.1, 0.07
ARCS = {names.OVERTURNS: "-", names.UNKNOWN: (0, (0.5, 0.5))}
ARC_WEIGHT = 4.0  # pt
MAX_NAME_LENGTH = 32  # characters


def draw_azimuths(found: AzimuthResponses, title: str, free: Sequence[bool]) -> Figure:
    """Plot the peak rotation in each direction.

    Parameters
    ----------
    found : AzimuthResponses
        The responses: a closed curve for each model, and arcs outside where it overturns or its outcome is unknown.
    title : str
        Heading.
    free : sequence of bool
        Whether each direction has no critical rotation: rotations are then plotted in degrees or mrad.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, ((axes,),) = style.panels(min(HEIGHT, style.page_width() + SPARE), projection="polar")
    axes.set_theta_zero_location("N")
    axes.set_theta_direction(-1)
    if isinstance(style.given(), Axes):
        style.heading(axes, title)
    else:
        style.heading_of_all(figure, title)
    turned = {name: np.fmax(each.peak_positive, each.peak_negative) for name, each in found.outcomes.items()}
    size = {name: turned[name] if any(free) else each.peak_ratio for name, each in found.outcomes.items()}
    peaks = {name: np.where(each.unknown | each.fell, np.nan, size[name]) for name, each in found.outcomes.items()}
    reach = max((float(np.nanmax(each)) for each in peaks.values() if np.isfinite(each).any()), default=0.0)
    factor, unit = style.angle_unit(reach) if any(free) else (1.0, "")
    reach *= factor
    angles = np.radians(np.append(found.azimuths, found.azimuths[0]))
    curves = [
        axes.plot(angles, factor * np.append(each, each[0]), label=style.LABELS[name], **style.LINES[name])[0]
        for name, each in peaks.items()
    ]
    flags = {
        names.OVERTURNS: {name: each.fell for name, each in found.outcomes.items()},
        names.UNKNOWN: {name: each.unknown for name, each in found.outcomes.items()},
    }
    shown = [what for what, each in flags.items() if any(where.any() for where in each.values())]
    critical = not any(free) and (bool(shown) or reach > 0.5)
    first = FIRST_ARC * max(reach, float(critical))
    for what in shown:
        look: dict[str, Any] = {"linewidth": ARC_WEIGHT, "linestyle": ARCS[what], "solid_capstyle": "butt"}
        for k, (name, where) in enumerate(flags[what].items()):
            arcs, radius = _arcs(found.azimuths, where), first * (1 + NEXT_ARC * k)
            axes.plot(arcs, np.full(arcs.size, radius), **look, color=style.LINES[name]["color"])
        curves += axes.plot([], [], label=what, color=style.INK, **look)
    if critical:
        around = np.linspace(0.0, 2 * np.pi, 361)
        look = {"color": style.INK, "linewidth": style.CURVE, "linestyle": ":", "label": "critical rotation"}
        curves += axes.plot(around, np.ones(around.size), **look)
    axes.set_ylim(0.0, first * (1 + NEXT_ARC * len(peaks)) if shown else max(1.1 * reach, 1e-3))
    one, other = (shorten(name, MAX_NAME_LENGTH, placeholder=" ...") for name in found.names)
    axes.set_xticks(np.radians(np.arange(0, 360, 30)))
    axes.tick_params(labelsize=style.TICK, colors=style.INK)
    axes.set_rlabel_position(67)
    axes.yaxis.set_major_locator(MaxNLocator(4))
    for each in axes.get_yticklabels():
        each.set_path_effects(style.HALO)
    axes.grid(True, color=style.GRID, linewidth=style.THIN)
    over = f"rotation [{unit.strip()}]" if any(free) else style.over(free, math=True)
    label = f"peak {over}; 0° is {style.plain(one)}, 90° is {style.plain(other)}"
    axes.set_xlabel(style.folded(label, style.page_width() - style.MAX_SIDE_MARGIN, style.LABEL), fontsize=style.LABEL)
    style.legend_below(figure, curves, ncols=3)
    return figure


def _arcs(azimuths: Reals, where: Bools) -> Reals:
    """Return arcs over flagged directions [deg], half a step before and after each, with NaN between them [rad]."""
    around = np.append(np.linspace(-0.5, 0.5, 5), np.nan) * AZIMUTH_STEP
    return np.asarray(np.radians(azimuths[where, None] + around).ravel())

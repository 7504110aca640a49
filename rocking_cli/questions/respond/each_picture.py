"""A quantity of many runs against another, such as the peak rotation against the PGA."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from textwrap import shorten
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from rocking_cli import names
from rocking_cli.arrays import Bools, Reals
from rocking_cli.ask.answer import parted
from rocking_cli.dynamics.model import ModelName
from rocking_cli.dynamics.outcome import Outcomes
from rocking_cli.errors import InputError, Problem
from rocking_cli.plotting import style
from rocking_cli.questions.respond.azimuths import AZIMUTH_STEP, AzimuthResponses
from rocking_cli.questions.respond.each import RunGrid, columns
from rocking_cli.text import did_you_mean

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LABELS = {
    "pga_g": "PGA [g]",
    "pgv": "PGV [m/s]",
    "scale": "scale factor of the motion",
    "restitution": r"restitution $\eta$",
}
BAND = 0.08  # height of the band of runs without a value, over that of the plane
WIDEST_SPREAD = 20.0  # ratio of the largest and the smallest positive value from which an axis is logarithmic
MARK_SIZE = 18.0  # pt2
HEIGHT, SPARE = 6.6, 1.4  # inches of the figure at most, and more than its width
# Radius over the peaks, and phi/phi_cr, at which the first arc is drawn; motions that come back rarely reach it.
FIRST_ARC, NEXT_ARC = 1.1, 0.07
ARCS = {names.OVERTURNS: "-", names.UNKNOWN: (0, (0.5, 0.5))}
ARC_WEIGHT = 4.0  # pt
MAX_NAME_LENGTH = 32  # characters


def draw_each(grid: RunGrid, outcomes: Mapping[ModelName, Outcomes], x: str, y: str) -> Figure:
    """Plot a column of the frame against another, with a mark for each run of the first model.

    Runs whose value is infinite, as the peak of one that overturns, are crosses above the line; runs of unknown outcome
    are open marks, at their value until `known_to`.

    Parameters
    ----------
    grid : RunGrid
        What was combined.
    outcomes : mapping of str to Outcome
        The outcomes by model.
    x, y : str
        Columns of numbers.

    Raises
    ------
    InputError
        If there is no such column of numbers.
    """
    model = next(iter(outcomes))
    values, units = parted(columns(grid, {model: outcomes[model]}))
    numbers = [name for name, each in values.items() if each.dtype != object]
    for argument, asked in (("x", x), ("y", y)):
        if asked not in numbers:
            what = f"must be a column of numbers, got {asked!r}"
            raise InputError(Problem(what, field=f"`{argument}`", hint=did_you_mean(asked, numbers)))
    figure, axes = style.one_panel(4.4, f"{grid.count:,} runs, {model} model")
    across, up = (np.asarray(values[each], dtype=np.float64) for each in (x, y))
    unknown = values["outcome"] == names.UNKNOWN
    above = np.isinf(up)
    top = 1.05 * float(np.nanmax(up[~above], initial=0.0)) or 1.0
    marks = []
    for k, name in enumerate(grid.axes["structure"]):
        mine, look = values["structure"] == name, style.distinct(k)
        dots: dict[str, Any] = {"s": MARK_SIZE, "color": look["color"], "marker": look["marker"], "linewidth": 0.8}
        known = mine & ~unknown & ~above
        marks.append(axes.scatter(across[known], up[known], label=style.plain(str(name)), **dots))
        open_look = dots | {"color": "none", "edgecolor": look["color"]}
        axes.scatter(across[mine & unknown], up[mine & unknown], **open_look)
        high = np.full(int((mine & above).sum()), top * (1 + BAND * (0.25 + 0.5 * _share(k, grid.shape[0]))))
        axes.scatter(across[mine & above], high, **dots | {"marker": "x"})
    peaks = style.over([side.phi_cr is None for each in grid.structures for side in each.statics], math=True)
    labels = LABELS | {"peak_ratio": f"peak {peaks}"}
    style.tidy(axes, *(labels.get(each) or _label(each, units) for each in (x, y)))
    if above.any():
        axes.axhline(top, color=style.FAINT, linewidth=style.THIN)
        above_it = f"above the line: {names.OVERTURNS}"
        marks.append(axes.scatter([], [], marker="x", color=style.INK, s=MARK_SIZE, label=above_it))
        axes.set_ylim(top=top * (1 + BAND))
    if unknown.any():
        open_one = f"open: {names.UNKNOWN}, value until known_to"
        marks.append(axes.scatter([], [], s=MARK_SIZE, color="none", edgecolor=style.INK, label=open_one))
    positive = across[across > 0]
    if positive.size == across.size and positive.max() > WIDEST_SPREAD * positive.min():
        style.logarithmic(axes.xaxis)
    style.legend_below(figure, marks)
    return figure


def _share(k: int, count: int) -> float:
    return k / (count - 1) if count > 1 else 0.5


def _label(name: str, units: Mapping[str, str]) -> str:
    return name.replace("_", " ") + (f" [{units[name]}]" if name in units else "")


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

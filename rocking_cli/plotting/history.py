"""The response of a structure: the record above, the rotations below."""

from __future__ import annotations

from collections.abc import Mapping
from textwrap import shorten

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.model import ModelName
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.plotting import style

TALLEST = 1.6  # phi/phi_cr shown at most: beyond, the structure is falling
FELT = 0.02  # of the strongest impact: weaker ones, of a chatter to rest, are not marked
LONGEST = 95  # characters of a heading
SHORTEST = 0.1  # s of the time axis
LANE = 0.025  # of the panel's height: where the impacts of each model are marked


def draw_history(histories: Mapping[ModelName, History], motion: GroundMotion | None, title: str) -> Figure:
    """Draw histories over time.

    Parameters
    ----------
    histories : mapping of str to History
        One curve each: signed rotation over the critical rotation of its direction, impacts marked.
    motion : GroundMotion, optional
        Drawn above, in g.
    title : str
        Heading.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = style.new_figure(4.8 if motion is not None else 3.4)
    if motion is not None:
        above, below = figure.subplots(2, 1, sharex=True, height_ratios=[1, 1.8])
        _draw_motion(above, motion)
    else:
        above = below = figure.subplots()
    heading = shorten(title, LONGEST, placeholder=" ...")
    above.set_title(heading, loc="left", fontsize=10, color=style.INK, parse_math=False)  # a $ in a name is a $
    for lane, (name, run) in enumerate(histories.items()):
        _draw_run(below, name, run, (len(histories) - lane) * LANE)
    for level in (-1.0, 1.0):
        below.axhline(level, color=style.FAINT, linewidth=0.8, linestyle=":")
    below.axhline(0.0, color=style.FAINT, linewidth=0.6)
    ends = [1.1 * run.end_time if run.overturned else run.time[-1] for run in histories.values()]
    below.set_xlim(0.0, max(*ends, SHORTEST))
    reach = max(float(np.nanmax(np.abs(run.ratio))) for run in histories.values())
    tall = min(max(1.1 * reach, 1e-3), TALLEST)
    below.set_ylim(-1.2 * tall, tall)  # room for the impacts below
    below.set_xlabel("time [s]", fontsize=9)
    below.set_ylabel(r"rotation $\phi/\phi_{cr}$, clockwise up", fontsize=9)
    below.annotate(
        "impacts", (0.005, (len(histories) + 1.2) * LANE), xycoords="axes fraction", fontsize=7, color=style.FAINT
    )
    below.legend(loc="upper right", fontsize=8, frameon=True, framealpha=0.9, edgecolor="none")
    style.tidy(below)
    return figure


def _draw_motion(axes: Axes, motion: GroundMotion) -> None:
    time = np.arange(motion.npts) * motion.dt
    axes.plot(time, motion.acceleration / STANDARD_GRAVITY, color=style.INK, linewidth=0.7)
    axes.set_ylabel("ground [g]", fontsize=9)
    axes.annotate(
        f"{motion.name}, PGA {motion.pga:.3g} g",
        (1.0, 0.96),
        xycoords="axes fraction",
        ha="right",
        va="top",
        fontsize=8,
        parse_math=False,
        bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1},
    )
    style.tidy(axes)


def _draw_run(axes: Axes, name: str, run: History, height: float) -> None:
    look = style.LINES[name]
    fate = ", overturns" if run.overturned else ""
    axes.plot(run.time, run.ratio, label=style.LABELS[name] + fate, **look)  # type: ignore[arg-type]
    if run.overturned:
        last = np.flatnonzero(np.isfinite(run.ratio) & (np.abs(run.ratio) <= TALLEST))[-1]
        axes.plot(run.time[last], run.ratio[last], marker="x", markersize=6, color=look["color"])
    if len(run.impacts):
        felt = run.impacts[run.impacts[:, 2] >= FELT * run.impacts[:, 2].max(), 0]
        axes.plot(
            felt,
            np.full(felt.size, height),
            transform=axes.get_xaxis_transform(),
            linestyle="none",
            marker="|",
            markersize=4,
            markeredgewidth=0.8,
            color=look["color"],
        )

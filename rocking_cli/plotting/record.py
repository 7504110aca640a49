"""Plot of a ground motion: acceleration, velocity, displacement and the build-up of its Arias intensity."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.measures import Measures, arias_build_up
from rocking_cli.plotting import style
from rocking_cli.plotting.thinning import visible


def draw_record(motion: GroundMotion, measures: Measures) -> Figure:
    """Plot a ground motion against time.

    Parameters
    ----------
    motion : GroundMotion
        The scaled motion.
    measures : Measures
        Its measures: the peaks are written on the curves, the significant duration is shaded.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = style.new_figure(7.0)
    panels = figure.subplots(4, 1, sharex=True)
    style.heading(panels[0], motion.name)
    _draw_curve(panels[0], motion, motion.acceleration / STANDARD_GRAVITY, "acceleration [g]")
    _draw_curve(panels[1], motion, motion.velocity, "velocity [m/s]")
    _draw_curve(panels[2], motion, motion.displacement, "displacement [m]")
    for axes in panels[:3]:
        style.make_room(axes)
    style.note(panels[0], f"PGA {measures.pga:.3g} g")
    style.note(panels[1], f"PGV {measures.pgv:.3g} m/s")
    style.note(panels[2], f"PGD {measures.pgd:.3g} m")
    _draw_build_up(panels[3], motion, measures)
    for axes in panels:
        if measures.t_5 is not None and measures.t_95 is not None:
            axes.axvspan(measures.t_5, measures.t_95, color=style.SHADE, linewidth=0, zorder=0)
        style.tidy(axes)
    panels[-1].set_xlim(0.0, motion.duration)
    panels[-1].set_xlabel("time [s]", fontsize=style.LABEL)
    figure.align_ylabels()
    return figure


def _draw_curve(axes: Axes, motion: GroundMotion, values: NDArray[np.float64], label: str) -> None:
    shown = visible(values)
    axes.plot(shown * motion.dt, values[shown], color=style.INK, linewidth=style.CURVE)
    axes.axhline(0.0, color=style.FAINT, linewidth=style.THIN)
    axes.set_ylabel(label, fontsize=style.LABEL)


def _draw_build_up(axes: Axes, motion: GroundMotion, measures: Measures) -> None:
    """Draw the Husid plot, with 5 and 95 % marked unless the motion is zero."""
    axes.set_ylabel("Arias intensity [%]", fontsize=style.LABEL)
    axes.set_ylim(-15.0, 105.0)  # room for a word below 5 %
    if measures.t_5 is None or measures.t_95 is None:
        return
    built = 100 * arias_build_up(motion) / measures.arias
    shown = visible(built)
    axes.plot(shown * motion.dt, built[shown], color=style.INK, linewidth=style.MEDIUM)
    for time, level in ((measures.t_5, 5), (measures.t_95, 95)):
        axes.plot(time, level, marker="o", markersize=4.5, color=style.INK)
        text = f"{level} % at {time:.4g} s"
        # Below and to the right: a curve that only grows leaves that corner free.
        axes.annotate(text, (time, level), (6, -3), textcoords="offset points", va="top", fontsize=style.TICK)
    style.note(axes, f"{measures.arias:.3g} m/s; 5 to 95 % in {measures.t_95 - measures.t_5:.4g} s", height=0.5)

"""Plot of a ground motion before and after its corrections: acceleration, velocity, displacement and spectra."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.plotting import style
from rocking_cli.plotting.thinning import visible
from rocking_cli.processing.oscillator import DAMPING, response_spectrum

PERIODS = np.geomspace(0.02, 10.0, 120)  # s
WITHIN = 3.0  # times the peak after: what was there before may be far beyond, and is cut off
BEFORE = {"color": style.RECORD, "linewidth": style.CURVE}
AFTER = {"color": style.INK, "linewidth": style.MEDIUM}


def draw_before_and_after(before: GroundMotion, after: GroundMotion, shift: float) -> Figure:
    """Plot a motion as read and as corrected.

    Parameters
    ----------
    before, after : GroundMotion
        The motion as read, grey, and as it is used, dark.
    shift : float
        Start of the corrected motion on the time axis of the motion as read [s].

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = style.new_figure(9.2)
    panels = figure.subplots(4, 1, height_ratios=[1, 1, 1, 1.3])
    style.heading(panels[0], after.name)
    quantities = (
        ("acceleration [g]", before.acceleration / STANDARD_GRAVITY, after.acceleration / STANDARD_GRAVITY),
        ("velocity [m/s]", before.velocity, after.velocity),
        ("displacement [m]", before.displacement, after.displacement),
    )
    for axes, (label, old, new) in zip(panels, quantities, strict=False):
        _draw(axes, before, old, 0.0, label="as read", **BEFORE)
        _draw(axes, after, new, shift, label="processed", **AFTER)
        _set_height(axes, old, new)
        axes.set_ylabel(label, fontsize=style.LABEL)
        axes.set_xlim(0.0, max(before.duration, shift + after.duration))
        style.tidy(axes)
    panels[0].legend(loc="upper right", ncols=2, **style.LEGEND)
    panels[2].set_xlabel(f"time [s]; {', '.join(after.processing)}", fontsize=style.LABEL)
    _draw_spectra(panels[3], before, after)
    figure.align_ylabels()
    return figure


def _draw(axes: Axes, motion: GroundMotion, values: NDArray[np.float64], shift: float, **look: object) -> None:
    shown = visible(values)
    axes.plot(shift + shown * motion.dt, values[shown], **look)  # type: ignore[arg-type]


def _set_height(axes: Axes, old: NDArray[np.float64], new: NDArray[np.float64]) -> None:
    """Set the height so that the corrected curve is shown whole, and the curve as read as far as both stay legible."""
    most, all_ = float(np.abs(new).max()), float(np.abs(old).max())
    top = max(min(all_, WITHIN * most), most) * 1.05 or 1.0
    axes.set_ylim(-top, top)
    if all_ > top:
        style.note(axes, f"as read up to {all_:.3g}", height=0.14)


def _draw_spectra(axes: Axes, before: GroundMotion, after: GroundMotion) -> None:
    for motion, look in ((before, BEFORE), (after, AFTER)):
        found = response_spectrum(motion, PERIODS[2 * motion.dt < PERIODS])
        axes.plot(found.periods, found.sa, **look)  # type: ignore[arg-type]
    axes.set_xscale("log")
    axes.set_yscale("log")
    style.plain_numbers(axes.xaxis)
    axes.set_xlabel("period [s]", fontsize=style.LABEL)
    axes.set_ylabel(f"Sa at {100 * DAMPING:g} % [g]", fontsize=style.LABEL)
    style.tidy(axes)

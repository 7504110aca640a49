"""Plot of a ground motion with its pulse, bold over the thin record, in acceleration and in velocity."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.pulse_fit import PulseFit
from rocking_cli.plotting import style
from rocking_cli.plotting.thinning import visible

AROUND = 2.0  # durations of the pulse that are shown after it, at least
POINTS = 2000  # of a pulse


def draw_pulses(motion: GroundMotion, fits: Sequence[PulseFit], end: float) -> Figure:
    """Plot a record with the pulses over it.

    Parameters
    ----------
    motion : GroundMotion
        The record to which the pulses were fitted.
    fits : sequence of PulseFit
        At most three; each is drawn in both panels, whatever it was fitted in.
    end : float
        Time up to which the record is shown [s]; later if a pulse ends later.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = style.new_figure(4.8)
    above, below = figure.subplots(2, 1, sharex=True)
    style.heading(above, motion.name)
    for axes, values in ((above, motion.acceleration / STANDARD_GRAVITY), (below, motion.velocity)):
        shown = visible(values)
        axes.plot(shown * motion.dt, values[shown], color=style.RECORD, linewidth=style.CURVE)
        axes.axhline(0.0, color=style.FAINT, linewidth=style.THIN)
        style.tidy(axes)
    for fit, look in zip(fits, style.PULSES, strict=False):
        t = fit.start + np.linspace(0.0, fit.pulse.duration, POINTS)
        label = f"{fit.pulse.title}, fitted in {fit.criterion}: {100 * fit.captured:.0f} % of its energy"
        above.plot(t, fit.acceleration(t) / STANDARD_GRAVITY, label=label, **look)
        below.plot(t, fit.velocity(t), **look)
        end = max(end, fit.start + (1 + AROUND) * fit.pulse.duration)
    above.set_ylabel("acceleration [g]", fontsize=style.LABEL)
    below.set_ylabel("velocity [m/s]", fontsize=style.LABEL)
    below.set_xlabel("time [s]", fontsize=style.LABEL)
    below.set_xlim(min([0.0, *(fit.start for fit in fits)]), min(end, motion.duration))
    figure.legend(loc="outside lower center", ncols=1, fontsize=style.TICK, frameon=False)
    figure.align_ylabels()
    return figure

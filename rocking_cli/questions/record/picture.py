"""Plots of a ground motion: by itself, before and after its corrections, and with its pulses."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.measures import Measures, arias_build_up
from rocking_cli.excitation.pulse_fit import PulseFit
from rocking_cli.plotting import style
from rocking_cli.processing.oscillator import DAMPING, ResponseSpectrum, response_spectrum

SPECTRUM_PERIODS = np.geomspace(0.02, 10.0, 120)  # s; periods of a spectrum
MAX_BEFORE_RATIO = 3.0  # the series before processing is cut off at this multiple of the peak after it
BEFORE_STYLE: dict[str, Any] = {"color": style.RECORD_COLOUR, "linewidth": style.CURVE}
AFTER_STYLE: dict[str, Any] = {"color": style.INK, "linewidth": style.MEDIUM}
POINT: dict[str, Any] = {"marker": "o", "markersize": 4.5, "color": style.INK, "linestyle": "none"}
ROOM = 0.25  # margin above and below a curve, over its height, for the legend of its peak
MIN_PULSE_DURATIONS = 2.0  # time shown after a pulse, over its duration
PULSE_POINTS = 2000


def draw_record(motion: GroundMotion, measures: Measures) -> Figure:
    """Plot a ground motion against time.

    Parameters
    ----------
    motion : GroundMotion
        The scaled motion.
    measures : Measures
        Its measures: the peaks are marked on the curves, the significant duration is shaded.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, every = style.panels(7.0, 4, sharex=True)
    panels = every[:, 0]
    style.heading(panels[0], motion.name)
    style.time_axis(panels[3], 0.0, motion.duration)
    peaks = f"PGA {measures.pga_g:.3g} g", f"PGV {measures.pgv:.3g} m/s", f"PGD {measures.pgd:.3g} m"
    for axes, (label, values), peak in zip(panels, _quantities(motion), peaks, strict=False):
        style.draw_samples(axes, values, motion.dt, color=style.INK, linewidth=style.CURVE)
        axes.axhline(0.0, color=style.FAINT, linewidth=style.THIN)
        axes.margins(y=ROOM)
        k = int(np.abs(values).argmax())
        axes.plot(k * motion.dt, values[k], label=peak, **POINT)
        axes.legend(loc="upper right", borderaxespad=0.1, **style.LEGEND)
        style.tidy(axes, y=label)
    _draw_build_up(panels[3], motion, measures)
    style.tidy(panels[3], "time [s]", f"Arias intensity\n[% of {measures.arias:.3g} m/s]")
    if measures.t_5 is not None and measures.t_95 is not None:
        shade = {"color": style.SHADE, "linewidth": 0, "zorder": 0}
        spans = [axes.axvspan(measures.t_5, measures.t_95, **shade) for axes in panels]
        spans[0].set_label(f"from 5 to 95 % of the Arias intensity: {measures.t_95 - measures.t_5:.4g} s")
        style.legend_below(figure, spans[:1])
    figure.align_ylabels(panels)
    return figure


def _quantities(motion: GroundMotion) -> list[tuple[str, NDArray[np.float64]]]:
    return [
        ("acceleration [g]", motion.acceleration / STANDARD_GRAVITY),
        ("velocity [m/s]", motion.velocity),
        ("displacement [m]", motion.displacement),
    ]


def _draw_build_up(axes: Axes, motion: GroundMotion, measures: Measures) -> None:
    """Draw the Husid plot with marks at 5 and 95 %, none if the motion is zero."""
    axes.set_ylim(-20.0, 120.0)  # room for labels
    axes.set_yticks([0, 50, 100])
    if measures.t_5 is None or measures.t_95 is None:
        return
    built = 100 * arias_build_up(motion) / measures.arias
    style.draw_samples(axes, built, motion.dt, color=style.INK, linewidth=style.MEDIUM)
    times = {5: measures.t_5, 95: measures.t_95}
    for share, time in times.items():
        axes.plot(time, share, label=f"{share} % at {time:.4g} s", **POINT)
    axes.legend(loc="lower right", **style.LEGEND)


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
    figure, every = style.panels(9.2, 4, height_ratios=[1, 1, 1, 1.3])
    panels = every[:, 0]
    style.heading(panels[0], after.name)
    for axes, (label, old), (_, new) in zip(panels, _quantities(before), _quantities(after), strict=False):
        style.draw_samples(axes, old, before.dt, label="as read", **BEFORE_STYLE)
        style.draw_samples(axes, new, after.dt, shift, label="processed", **AFTER_STYLE)
        _set_height(axes, old, new)
        style.time_axis(axes, 0.0, max(before.duration, shift + after.duration))
        style.tidy(axes, y=label)
    style.tidy(panels[2], f"time [s]; {', '.join(after.processing)}")
    for motion, look in ((before, BEFORE_STYLE), (after, AFTER_STYLE)):
        spectrum = response_spectrum(motion, SPECTRUM_PERIODS[2 * motion.dt < SPECTRUM_PERIODS])
        panels[3].plot(spectrum.periods, spectrum.sa, **look)
    style.logarithmic(panels[3].xaxis)
    style.logarithmic(panels[3].yaxis, (1.0,))
    style.tidy(panels[3], "period [s]", f"Sa, {100 * DAMPING:g} % damping [g]")
    style.legend_below(figure, panels[0].get_lines())
    figure.align_ylabels()
    return figure


def _set_height(axes: Axes, old: NDArray[np.float64], new: NDArray[np.float64]) -> None:
    """Set the height so that the corrected curve is shown whole, and the curve as read as far as both stay legible."""
    peak, all_ = float(np.abs(new).max()), float(np.abs(old).max())
    top = max(min(all_, MAX_BEFORE_RATIO * peak), peak) * 1.05 or 1.0
    axes.set_ylim(-top, top)
    if all_ > top:
        style.note(axes, f"as read up to {all_:.3g}", height=0.14)


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
    figure, ((above,), (below,)) = style.panels(4.8, 2, sharex=True)
    style.heading(above, motion.name)
    for axes, values in ((above, motion.acceleration / STANDARD_GRAVITY), (below, motion.velocity)):
        style.draw_samples(axes, values, motion.dt, color=style.RECORD_COLOUR, linewidth=style.CURVE)
        axes.axhline(0.0, color=style.FAINT, linewidth=style.THIN)
    for fit, look in zip(fits, style.PULSES, strict=False):
        t = fit.start + np.linspace(0.0, fit.pulse.duration, PULSE_POINTS)
        label = f"{fit.pulse.title}, fitted in {fit.criterion}: {100 * fit.captured:.0f} % of its energy"
        above.plot(t, fit.acceleration(t) / STANDARD_GRAVITY, label=label, **look)
        below.plot(t, fit.velocity(t), **look)
        end = max(end, fit.start + (1 + MIN_PULSE_DURATIONS) * fit.pulse.duration)
    style.tidy(above, y="acceleration [g]")
    style.tidy(below, "time [s]", "velocity [m/s]")
    style.time_axis(below, min([0.0, *(fit.start for fit in fits)]), min(end, motion.duration))
    style.legend_below(figure, ncols=1)
    figure.align_ylabels()
    return figure


MAX_NAMED_CURVES = 6  # more curves are all drawn in one style
QUANTITIES = (("sa", "Sa, pseudo [g]"), ("sv", "Sv, pseudo [m/s]"), ("sd", "Sd [m]"))


def draw_response_spectra(spectra: Mapping[str, ResponseSpectrum]) -> Figure:
    """Plot the spectra of motions, all of one damping ratio.

    Parameters
    ----------
    spectra : mapping of str to ResponseSpectrum
        The spectra, by the name of the motion.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, every = style.panels(6.6, 3, sharex=True)
    panels = every[:, 0]
    first = next(iter(spectra.values()))
    names = list(spectra)
    title = names[0] if len(names) == 1 else f"{len(names)} motions"
    style.heading(panels[0], f"{title}: response spectra, {100 * first.damping:g} % damping")
    for axes, (quantity, label) in zip(panels, QUANTITIES, strict=True):
        for k, (name, each) in enumerate(spectra.items()):
            look = (
                style.distinct(k) | {"marker": ""}
                if len(names) <= MAX_NAMED_CURVES
                else {"color": style.INK, "alpha": 0.5}
            )
            width = {"linewidth": style.CURVE if len(names) == 1 else style.MEDIUM}
            axes.plot(each.periods, getattr(each, quantity), **look | width, label=style.plain(style.fitted(name, 3.2)))
        axes.set_ylim(bottom=0.0)
        axes.margins(x=0.01)
        style.logarithmic(axes.xaxis)
        style.tidy(axes, y=label)
    panels[-1].set_xlabel("period [s]", fontsize=style.LABEL)
    figure.align_ylabels()
    if 1 < len(names) <= MAX_NAMED_CURVES:
        style.legend_below(figure, panels[0].get_lines())
    return figure

"""Plot of a set of records against its target: the spectra, their mean, and the limits on it."""

from __future__ import annotations

from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from rocking_cli.plotting import style
from rocking_cli.questions.select.study import RecordSet

MAX_TICKED_RATIO = 8.0  # ratio of the ends of the band up to which its axis has more ticks
MAX_OPAQUE_LINES = 12  # with more records, their lines are transparent


def draw_record_set(found: RecordSet, title: str) -> Figure:
    """Draw the spectra of a set over the band: each record thin, the mean bold, the target, and the limits shaded.

    Parameters
    ----------
    found : RecordSet
        The set of records to plot.
    title : str
        Heading.
    """
    periods, target, mean = found.candidates.periods, found.candidates.target, found.mean
    low, high = found.wanted.within
    figure, axes = style.one_panel(4.4, title)
    axes.fill_between(periods, low * target, high * target, color=style.SATISFIED, linewidth=0, zorder=0)
    faint = min(1.0, max(MAX_OPAQUE_LINES / len(found.chosen), 0.2))
    axes.plot(periods, found.spectra.T, color=style.FAINT, linewidth=style.CURVE, alpha=faint, zorder=1.5)
    axes.plot(periods, target, color=style.TARGET, linestyle="--", linewidth=style.BOLD, zorder=2.5)
    axes.plot(periods, mean, color=style.MEAN, linewidth=2.2, zorder=3)
    missed = found.too_low | found.too_high
    if missed.any():
        axes.plot(
            periods[missed], mean[missed], linestyle="none", marker="x", markersize=5, color=style.MISSED, zorder=4
        )
    short = periods[-1] / periods[0] <= MAX_TICKED_RATIO
    style.logarithmic(axes.xaxis, (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0) if short else (1.0, 2.0, 5.0))
    axes.set_xlim(periods[0], periods[-1])
    axes.set_ylim(0.0, 1.05 * max(float(found.spectra.max()), float((high * target).max())))
    damping = f"{100 * found.wanted.damping:g} % damping"
    style.tidy(axes, "period [s]", f"pseudo-acceleration [g], {damping}")
    handles: list[Line2D | Patch] = [
        Line2D([], [], color=style.MEAN, linewidth=2.2, label="mean"),
        Line2D([], [], color=style.TARGET, linestyle="--", linewidth=style.BOLD, label="target"),
        Patch(color=style.SATISFIED, linewidth=0, label=f"{low:g} to {high:g} times the target"),
        Line2D([], [], color=style.FAINT, linewidth=style.CURVE, label="each record, scaled"),
    ]
    if missed.any():
        handles.append(Line2D([], [], linestyle="none", marker="x", color=style.MISSED, label="outside the limits"))
    style.legend_below(figure, handles, len(handles))
    return figure

"""Plot of structures under equivalent pulses: the pulses in their units above, the responses together below."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.plotting import style
from rocking_cli.questions.equivalent_pulses.study import EquivalentResponses

CUT_RATIO = 1.5  # phi/phi_cr at which a curve that overturns is cut off, with a cross
SHOWN_AFTER_PULSE = 8.0  # p times the duration that is shown


def draw_equivalent(found: EquivalentResponses, title: str) -> Figure:
    """Plot pulses above, responses below.

    Parameters
    ----------
    found : EquivalentResponses
        The responses to plot.
    title : str
        Heading.
    """
    figure, ((above,), (below,)) = style.panels(5.8 + 0.2 * len(found.members), 2, height_ratios=[1, 1.8])
    style.heading(above, title)
    for k, each in enumerate(found.members):
        t = np.linspace(0.0, each.pulse.duration, 400)
        ground = found.polarity * each.pulse.acceleration(t) / STANDARD_GRAVITY
        edges = np.concatenate([[0.0], t, [t[-1]]]), np.concatenate([[0.0], ground, [0.0]])
        above.plot(*edges, markevery=(20 + 7 * k, 80), **style.distinct(k))
        ratio = found.turned(each.history)
        seen = np.flatnonzero(np.abs(ratio) > CUT_RATIO)
        if seen.size or not np.isfinite(ratio).all():
            ratio = ratio[: seen[0] if seen.size else int(np.isfinite(ratio).sum())]
        tau = found.tau[: ratio.size]
        known_to = each.history.known_to
        unknown = f", unknown after {known_to:.3g} s (open circle)" if each.history.unknown else ""
        fate = ", overturns" if each.history.fell else unknown
        below.plot(tau, ratio, label=style.plain(f"{each.name}{fate}"), markevery=_spaced(tau, k), **style.distinct(k))
        if each.history.fell and ratio.size:
            below.plot(tau[-1], ratio[-1], marker="x", markersize=7, color=style.distinct(k)["color"])
        if unknown and ratio.size:
            colour = style.distinct(k)["color"]
            below.plot(
                tau[-1], ratio[-1], marker="o", markersize=9, color=colour, markerfacecolor=style.PAPER, zorder=3
            )
    _draw_linear(below, found)
    end = found.pulse_end + SHOWN_AFTER_PULSE
    below.set_xlim(0.0, min(end, float(found.tau[-1])))
    above.set_xlim(left=0.0)
    below.axvline(found.pulse_end, color=style.FAINT, linewidth=style.CURVE, linestyle=":")
    below.annotate(
        "end of the pulses", (found.pulse_end, 1.0), (3, -3), xycoords=("data", "axes fraction"),
        textcoords="offset points", va="top", fontsize=style.SMALL, color=style.FAINT,
    )  # fmt: skip
    style.make_room(below, 0.1)
    below.axhline(0.0, color=style.FAINT, linewidth=style.THIN)
    style.tidy(above, "time [s]", "pulse of each [g]")
    style.tidy(below, r"dimensionless time $p\,t$", r"$\phi/\phi_{cr}$, first lifted side up")
    style.legend_below(figure, below.get_legend_handles_labels()[0], handlelength=4)
    return figure


def _spaced(tau: Any, k: int) -> tuple[int, int]:
    """Return first index and spacing of the marks of curve `k`, so that marks of different curves do not overlap."""
    per_unit = max(1, round(1 / float(tau[1] - tau[0]))) if len(tau) > 1 else 1
    return (1 + k * per_unit // 3) % max(1, len(tau)), 2 * per_unit


def _draw_linear(axes: Any, found: EquivalentResponses) -> None:
    ratio = found.turned(found.linear)
    ratio = ratio[np.isfinite(ratio)]
    beyond = np.flatnonzero(np.abs(ratio) > CUT_RATIO)
    ratio = ratio[: beyond[0]] if beyond.size else ratio
    fate = ", overturns" if found.alone.fell else ""
    axes.plot(
        found.tau[: ratio.size], ratio, color=style.FAINT, linewidth=3.5, alpha=0.6, zorder=1,
        label=f"linear block of all{fate}",
    )  # fmt: skip

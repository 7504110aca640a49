"""Plot of both engines over time: the ground motion above, both rotations below."""

from __future__ import annotations

from collections.abc import Iterator
from math import isnan
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rocking_cli import names
from rocking_cli.arrays import Reals
from rocking_cli.dynamics.history import History
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.names import percent
from rocking_cli.plotting import style
from rocking_cli.questions.crosscheck.study import PARTED, Crosscheck
from rocking_cli.studies.engines.free import MOVED
from rocking_cli.studies.film import SECONDS_AFTER, SECONDS_BEFORE

MAX_SHOWN_RATIO = 1.3  # phi/phi_cr at which curves that overturn are cut off
STILL_SHARE = 0.02  # distance from the last rotation, over the peak, that counts as rest
ROOM = 0.2  # height of the panel above and below the curves, over that of the curves
EXACT, BLOCKS = style.LINES["nonlinear"], style.LINES["blocks"]
UNKNOWN: dict[str, Any] = {"color": style.FAINT, "linestyle": "--"}


def draw_crosscheck(found: Crosscheck, title: str) -> Figure:
    """Plot the rotation by both engines against time, as long as something moves.

    The exact history ends where its outcome becomes unknown, at a vertical line. Another line marks when both have
    parted.

    Parameters
    ----------
    found : Crosscheck
        The motion by both engines.
    title : str
        Heading.

    Returns
    -------
    matplotlib.figure.Figure
    """
    motion, runs = found.motion, (found.exact, found.of_blocks)
    heights = [1.5, 3.2] if motion is not None else [3.2]
    figure, every = style.panels(sum(heights), len(heights), sharex=True, height_ratios=heights)
    panels = list(every[:, 0])
    axes = panels[-1]
    style.heading(panels[0], title)
    _, end = style.time_axis(axes, *_span(found))
    if motion is not None:
        kept = motion.kept
        ground = kept.acceleration[: int(min(end, kept.duration) / kept.dt) + 2] / STANDARD_GRAVITY
        style.draw_samples(panels[0], ground, kept.dt, color=style.INK, linewidth=style.CURVE)
        style.tidy(panels[0], y="ground [g]")
    axes.axhline(0.0, color=style.FAINT, linewidth=style.THIN)
    curves = [_draw(axes, *each) for each in zip(runs, ("exact engine", "free blocks"), (EXACT, BLOCKS), strict=True)]
    values = np.concatenate([np.asarray(each.get_ydata()) for each in curves])
    low, high = float(values.min()), float(values.max())
    room = ROOM * (high - low or 1.0)
    axes.set_ylim(low - room, high + room)
    marks = [mark for run, look in zip(runs, (EXACT, BLOCKS), strict=True) for mark in _marks(axes, run, look)]
    for level in (-1.0, 1.0):
        if low - room < level < high + room:
            axes.axhline(level, color=style.INK, linewidth=style.CURVE, linestyle=":")
    free = found.exact.ends_at_limit
    style.tidy(axes, "time [s]", f"rotation {style.over(free, math=True)}, clockwise up")
    lines = list(_times(panels, found))
    style.legend_below(figure, [*curves, *lines, *marks])
    return figure


def _span(found: Crosscheck) -> tuple[float, float]:
    """Return the times between which something moves [s], with some time before and after."""
    first, last = [], []
    for run in (found.exact, found.of_blocks):
        ratio = run.ratio[np.isfinite(run.ratio)]
        least = max(MOVED, STILL_SHARE * float(np.abs(ratio).max()))
        first += run.time[: ratio.size][np.abs(ratio) > MOVED][:1].tolist()
        last += run.time[: ratio.size][np.abs(ratio - ratio[-1]) > least][-1:].tolist()
    if not (first and last):
        return 0.0, float(found.of_blocks.time[-1])
    end = max(last) + (0.0 if found.of_blocks.fell else SECONDS_AFTER)
    return max(0.0, min(first) - SECONDS_BEFORE), min(end, float(found.of_blocks.time[-1]))


def _draw(axes: Axes, run: History, label: str, look: dict[str, Any]) -> Line2D:
    """Draw a history as far as it is shown."""
    ratio = _shown(run)
    points = style.visible(ratio)
    return axes.plot(run.time[points], ratio[points], label=label, **look)[0]


def _shown(run: History) -> Reals:
    """Return the first samples of phi/phi_cr of a history: as far as it is known, and not far beyond overturning."""
    ratio = run.ratio[np.isfinite(run.ratio)]
    beyond = np.abs(ratio) > MAX_SHOWN_RATIO
    return ratio[: beyond.argmax()] if run.fell and beyond.any() else ratio


def _marks(axes: Axes, run: History, look: dict[str, Any]) -> Iterator[Line2D]:
    """Mark where a history overturns, or its peak, with a label."""
    if run.unknown or not run.lifted:
        return
    ratio = _shown(run)
    k, shape = int(np.abs(ratio).argmax()), "o"
    label = f"peak {run.peak_ratio:.4g} at {run.time[k]:.4g} s"
    if run.fell:  # at the time of overturning, or at the edge, beyond which the curve goes on
        k = min(int(np.searchsorted(run.time, run.overturning_time)), ratio.size - 1)
        shape = "x" if k < ratio.size - 1 else "^" if ratio[k] > 0 else "v"
        label = f"{names.OVERTURNS} at {run.overturning_time:.4g} s"
    mark = {"marker": shape, "markersize": 4.5, "linestyle": "none", "color": look["color"]}
    yield axes.plot(run.time[k], ratio[k], label=label, zorder=6, **mark)[0]


def _times(panels: list[Axes], found: Crosscheck) -> Iterator[Line2D]:
    """Draw the times at which both part, and at which the exact outcome becomes unknown, through all panels."""
    over = f"differ by more than {percent(PARTED)} of the larger peak"
    for time, what, look in (
        (found.exact.known_to if found.exact.unknown else float("nan"), "exact outcome unknown", UNKNOWN),
        (found.parted, over, {"color": style.CURSOR, "linestyle": (0, (1, 1.5))}),
    ):
        if not isnan(time):
            drawn = [axes.axvline(time, linewidth=style.MEDIUM, **look) for axes in panels]
            drawn[0].set_label(f"{what} from {time:.4g} s")
            yield drawn[0]

"""Plots of overturning maps, and of the least pulses that overturn several structures."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from itertools import chain
from textwrap import shorten
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path

from rocking_cli.arrays import Points, Reals
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.plotting import style
from rocking_cli.questions.overturning.study import CONTOUR_LEVELS, Comparison, OutcomeKind, OverturningMap

LABELS, FILLS = list(style.REGIONS), list(style.REGIONS.values())  # by `OutcomeKind`
GRID_POINTS = 250  # number of points along either axis on which boundaries are traced
EQUAL_RATIOS = 1e-6  # relative difference of the steps of a logarithmic axis
TICKS = (1.0, 2.0, 3.0, 5.0, 7.0)  # multiples of powers of ten along logarithmic axes
INSET, MAX_PLACES = 0.06, 100  # places for the number of a contour: share of the panel from its edge, and their number


def draw_map(
    found: OverturningMap, title: str, *, dimensionless: bool, marks: Sequence[tuple[str, float, float]] = ()
) -> Figure:
    """Plot a map, with contours of the peak and the boundaries that are known in closed form.

    Axes are logarithmic if the points of the map are at equal ratios.

    Parameters
    ----------
    found : OverturningMap
        The map to plot.
    title : str
        Heading.
    dimensionless : bool
        Whether to plot against omega and a, or against the period [s] and the amplitude [g].
    marks : sequence of (str, float, float)
        Pulses to mark: name and coordinates on the axes.
    """
    figure, axes = style.one_panel(6.0, title)
    across, up = (found.omega, found.a) if dimensionless else (found.periods, found.ag)
    for axis, values in ((axes.xaxis, across), (axes.yaxis, up)):
        steps = np.diff(np.log(values))
        if np.ptp(steps) < EQUAL_RATIOS * np.abs(steps).max():
            style.logarithmic(axis, TICKS)
    axes.set_xlim(float(across.min()), float(across.max()))
    axes.set_ylim(float(up.min()), float(up.max()))
    place = partial(_place, found, dimensionless=dimensionless)
    for kind, outlines in found.edges.outlines.items():
        path = Path.make_compound_path(*(Path(place(np.append(each, each[0])), closed=True) for each in outlines))
        axes.add_patch(PathPatch(path, facecolor=FILLS[kind], linewidth=0.0, zorder=1 + kind / 10))
        if kind == OutcomeKind.UNKNOWN:  # a patch of its own: the colour under a hatch would be the same on a dark page
            axes.add_patch(PathPatch(path, zorder=1 + kind / 10, **style.UNKNOWN))
    handles = _draw_peaks(axes, found, place)
    handles += _draw_boundaries(axes, found, dimensionless=dimensionless)
    if found.edges.stepped:
        handles.append(Line2D([], [], linestyle="none", label="stepped edges: known only to the grid"))
    for name, x, y in marks:
        axes.plot(x, y, linestyle="none", zorder=6, **style.MARKED)
        right = (axes.transData - axes.transAxes).transform((x, y))[0] > 0.5
        axes.annotate(
            shorten(name, 30, placeholder=" ..."), (x, y), (-9 if right else 9, 7), textcoords="offset points",
            ha="right" if right else "left", fontsize=style.TICK, fontweight="bold", color=style.INK, zorder=7,
            parse_math=False, path_effects=style.HALO,
        )  # fmt: skip
    if dimensionless:
        style.tidy(axes, *_dimensionless_labels(found))
    else:
        style.tidy(axes, "period of the pulse [s]", "amplitude of the pulse [g]")
    axes.grid(False)
    keys = [
        Patch(
            facecolor=FILLS[kind], edgecolor=style.FAINT, label=LABELS[kind],
            hatch=style.UNKNOWN["hatch"] if kind == OutcomeKind.UNKNOWN else None,
        )
        for kind in OutcomeKind if (found.kinds == kind).any()
    ]  # fmt: skip
    style.legend_below(figure, [*keys, *handles])
    return figure


def _place(found: OverturningMap, line: Points, *, dimensionless: bool) -> Reals:
    """Return the coordinates of a line of the map on the axes, shape (k, 2)."""
    omega, a = found.at(line)
    if dimensionless:
        return np.column_stack([omega, a])
    return np.column_stack([found.structure.period(omega), a * found.structure.unit / STANDARD_GRAVITY])


def _dimensionless_labels(found: OverturningMap) -> tuple[str, str]:
    """Return the labels of dimensionless axes, which say what the symbols mean."""
    shaken = found.structure
    of_block = shaken.gravity == 1  # its p and lambda are 1
    p, uplift = ("", "") if of_block else (f" = {shaken.p:.3g} rad/s", f", {shaken.lambda_:.3g} g")
    x = (
        r"frequency $\omega_g/p$ ($\omega_g$: circular frequency of the pulse, "
        rf"$p${p}: frequency parameter of the structure)"
    )
    y = rf"amplitude $a_g/(g\lambda)$ of the pulse ($g\lambda$: uplift acceleration{uplift})"
    return style.folded(x, style.page_width() - 1.3 * style.MAX_SIDE_MARGIN, style.LABEL), y


def _draw_peaks(axes: Axes, found: OverturningMap, place: Callable[[Points], Reals]) -> list[Line2D]:
    """Draw the contours of the peak under the regions that overturn, and number the longest of each level."""
    look: dict[str, Any] = {"color": style.MEASURE, "linewidth": style.CURVE}
    lines = [[place(each) for each in pieces] for pieces in found.edges.contours]
    for line in chain.from_iterable(lines):
        axes.plot(*line.T, zorder=1 + (OutcomeKind.ROCKS + 0.5) / 10, **look)
    apart = [np.concatenate([np.empty((0, 2)), *(_inside(axes, line) for line in each)]) for each in lines]
    for k, (level, points) in enumerate(zip(CONTOUR_LEVELS, apart, strict=True)):
        others = np.concatenate([*apart[:k], *apart[k + 1 :]])
        if points.size:
            nearest = [np.hypot(*(others - each).T).min(initial=1.0) for each in points]
            axes.annotate(
                f"{level:g}", points[int(np.argmax(nearest))], xycoords="axes fraction", ha="center", va="center",
                fontsize=style.SMALL, color=style.MEASURE, path_effects=style.HALO,
            )  # fmt: skip
    words = r"peak rotation over critical rotation $\phi/\phi_{cr}$"
    return [Line2D([], [], label=words, **look)] if any(found.edges.contours) else []


def _inside(axes: Axes, line: Reals) -> Reals:
    """Return points of a line that are off its ends and those of the panel, as shares of its width and height."""
    ends = len(line) // 10
    points = (axes.transData - axes.transAxes).transform(line[ends : len(line) - ends])
    inside: Reals = points[((points > INSET) & (points < 1 - INSET)).all(axis=1)]
    return inside[:: 1 + len(inside) // MAX_PLACES]


def _draw_boundaries(axes: Axes, found: OverturningMap, *, dimensionless: bool) -> list[Line2D]:
    along = np.linspace(0, 1, GRID_POINTS)
    grid = (found.omega.size - 1) * along + 1j * ((found.a.size - 1) * along)
    omega, a = found.at(grid)
    x, y = _place(found, grid, dimensionless=dimensionless).T
    drawn = []
    for boundary in found.boundaries:
        level = boundary.level(*np.meshgrid(omega, a))
        finite = level[np.isfinite(level)]
        if not finite.size or finite.min() >= 0 or finite.max() <= 0:
            continue
        look = style.BOUNDARIES[boundary.name]
        axes.contour(
            x, y, np.ma.masked_invalid(level), levels=[0.0],
            colors=look["color"], linestyles=[look["linestyle"]], linewidths=look["linewidth"],
        )  # fmt: skip
        drawn.append(Line2D([], [], label=f"{boundary.title} (closed form)", **look))
    return drawn


def draw_comparison(found: Comparison, title: str) -> Figure:
    """Plot the least amplitude that overturns each structure against the period of the pulse.

    If outcomes are unknown below this amplitude, a hatched band goes down to the least amplitude of unknown outcome.

    Parameters
    ----------
    found : Comparison
        The comparison to plot.
    title : str
        Heading.
    """
    figure, axes = style.one_panel(4.6, f"{title}, up to {found.top:.4g} g")
    every = max(1, found.periods.size // 8)
    curves = []
    for k, (structure, least) in enumerate(zip(found.structures, found.least, strict=True)):
        look = style.distinct(k) | {"label": style.plain(structure.name), "markevery": (k * every // 4, every)}
        curves += axes.plot(found.periods, least, **look)
        _draw_doubt(axes, found, k)
    for axis in (axes.xaxis, axes.yaxis):  # logarithmic, as the curve is steep for short pulses
        style.logarithmic(axis)
    if np.isnan(found.possible).all():
        axes.set_ylim(found.top / 10, found.top)  # without a curve, limits must be set
        style.note(axes, "no structure overturns")
    axes.set_xlim(float(found.periods[0]), float(found.periods[-1]))
    style.tidy(axes, "period of the pulse [s]", "least amplitude that overturns [g]")
    handles: list[Line2D | Patch] = [*curves]
    if found.doubtful.any():
        handles.append(Patch(label="hatched down to the thin line: unknown outcome", **style.UNKNOWN))
    style.legend_below(figure, handles, handlelength=4)
    return figure


def _draw_doubt(axes: Axes, found: Comparison, k: int) -> None:
    """Hatch the amplitudes between which a structure starts to overturn, if unknown outcomes leave this open."""
    if not found.doubtful[k].any():
        return
    look = style.distinct(k)
    possible = found.possible[k]
    end = np.where(np.isnan(found.least[k]) & np.isfinite(possible), found.top, found.least[k])
    axes.fill_between(found.periods, possible, end, alpha=0.4, **(style.UNKNOWN | {"edgecolor": look["color"]}))
    axes.plot(found.periods, possible, color=look["color"], linestyle=look["linestyle"], linewidth=style.CURVE)

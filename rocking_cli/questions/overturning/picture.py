"""Plots of overturning maps, and of the least pulses that overturn several structures."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import shorten

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke
from numpy.typing import NDArray

from rocking_cli import names
from rocking_cli.plotting import style
from rocking_cli.questions.overturning.study import Comparison, OverturningMap, Region

Reals = NDArray[np.float64]
GRID_POINTS = 500  # number of points along either axis on which boundaries are traced
CONTOUR_LEVELS = (0.1, 0.25, 0.5, 0.75)  # phi/phi_cr of the contours


def draw_map(
    found: OverturningMap, title: str, *, dimensionless: bool, marks: Sequence[tuple[str, float, float]] = ()
) -> Figure:
    """Plot a map, with contours of the peak and the boundaries that are known in closed form.

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
    across, up = (found.omega, found.a) if dimensionless else (found.periods, found.accelerations)
    kinds = _kinds(found)
    axes.pcolormesh(
        across, up, kinds, cmap=ListedColormap(list(style.REGIONS.values())), vmin=-0.5, vmax=len(style.REGIONS) - 0.5,
        shading="nearest", rasterized=True,
    )  # fmt: skip
    _hatch(axes, across, up, found.outcome.unknown)
    contours = _draw_peaks(axes, across, up, np.where(found.outcome.unknown, np.nan, found.outcome.peak_ratio))
    handles: list[Line2D | Patch] = [
        Patch(
            facecolor=fill, edgecolor=style.FAINT, label=label,
            hatch=style.UNKNOWN["hatch"] if label == names.UNKNOWN else None,
        )
        for k, (label, fill) in enumerate(style.REGIONS.items())
        if (kinds == k).any()
    ]  # fmt: skip
    handles += contours
    handles += _draw_boundaries(axes, found, dimensionless=dimensionless)
    style.legend_below(figure, handles)
    for name, x, y in marks:
        axes.plot(x, y, linestyle="none", zorder=6, **style.MARKED)
        right = x > (across.min() + across.max()) / 2
        axes.annotate(
            shorten(name, 30, placeholder=" ..."), (x, y), (-9 if right else 9, 7), textcoords="offset points",
            ha="right" if right else "left", fontsize=style.TICK, fontweight="bold", color=style.INK, zorder=7,
            parse_math=False, path_effects=[withStroke(linewidth=2.5, foreground="white")],
        )  # fmt: skip
    if dimensionless:
        style.tidy(axes, r"frequency $\omega_g/p$", r"amplitude $a_g/(g\lambda)$")
    else:
        style.tidy(axes, "period of the pulse [s]", "amplitude of the pulse [g]")
    axes.grid(False)
    return figure


def _hatch(axes: Axes, across: Reals, up: Reals, unknown: NDArray[np.bool_]) -> None:
    """Hatch the region of unknown outcome."""
    if unknown.any():
        region = axes.contourf(
            across, up, unknown.astype(np.float64), [0.5, 1.5], hatches=[style.UNKNOWN["hatch"]], colors="none"
        )
        region.set(edgecolor=style.UNKNOWN["edgecolor"], linewidth=0.0)


def _draw_peaks(axes: Axes, across: Reals, up: Reals, peaks: Reals) -> list[Line2D]:
    """Draw the longest contour of each level; the many short ones are islands of a point or two near overturning."""
    if not (peaks > CONTOUR_LEVELS[0]).any():
        return []
    traced = axes.contour(across, up, np.ma.masked_invalid(peaks), levels=CONTOUR_LEVELS, linewidths=0)
    pieces = [[piece for piece in each if len(piece) > 1] for each in traced.allsegs]
    traced.remove()
    for level, each in zip(CONTOUR_LEVELS, pieces, strict=True):
        if not each:
            continue
        line = max(each, key=len)
        axes.plot(*line.T, color=style.MEASURE, linewidth=style.CURVE)
        # Put the label at half of the height, where the lines are farther apart.
        place = line[np.abs(line[:, 1] - line[:, 1].mean()).argmin()]
        axes.annotate(
            f"{level:g}", place, ha="center", va="center", fontsize=style.SMALL, color=style.MEASURE,
            bbox={"facecolor": style.REGIONS[names.ROCKS], "edgecolor": "none", "pad": 0.5},
        )  # fmt: skip
    return [Line2D([], [], color=style.MEASURE, linewidth=style.CURVE, label=r"peak $\phi/\phi_{cr}$")]


def _kinds(found: OverturningMap) -> NDArray[np.int64]:
    """Return for each point the index of its fill colour."""
    kinds = found.regions + (found.regions >= Region.WITHOUT_IMPACT)
    return np.where((found.regions == Region.AFTER_IMPACT) & (found.outcome.impact_count > 1), 3, kinds)


def _draw_boundaries(axes: Axes, found: OverturningMap, *, dimensionless: bool) -> list[Line2D]:
    omega = np.linspace(found.omega.min(), found.omega.max(), GRID_POINTS)
    a = np.linspace(found.a.min(), found.a.max(), GRID_POINTS)
    if not dimensionless:  # space the points evenly along the drawn axis of periods
        omega = 2 * np.pi / np.linspace(2 * np.pi / omega[-1], 2 * np.pi / omega[0], GRID_POINTS)
    across, up = np.meshgrid(omega, a)
    drawn = []
    for boundary in found.boundaries:
        level = boundary.level(across, up)
        finite = level[np.isfinite(level)]
        if not finite.size or finite.min() >= 0 or finite.max() <= 0:
            continue
        scale_x = omega if dimensionless else found.structure.period(omega)
        scale_y = a if dimensionless else a * found.accelerations[0] / found.a[0]
        look = style.BOUNDARIES[boundary.name]
        axes.contour(
            scale_x, scale_y, np.ma.masked_invalid(level), levels=[0.0],
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
    for k, (structure, least) in enumerate(zip(found.structures, found.least, strict=True)):
        name = style.plain(structure.name)
        axes.plot(found.periods, least, label=name, markevery=(k * every // 4, every), **style.distinct(k))
        _draw_doubt(axes, found, k)
    if found.doubtful.any():
        axes.fill_between([], [], [], label="hatched down to the thin line: unknown outcome", **style.UNKNOWN)
    for axis in (axes.xaxis, axes.yaxis):  # logarithmic, as the curve is steep for short pulses
        style.logarithmic(axis)
    if np.isnan(found.possible).all():
        axes.set_ylim(found.top / 10, found.top)  # without a curve, limits must be set
        style.note(axes, "no structure overturns")
    axes.set_xlim(float(found.periods[0]), float(found.periods[-1]))
    axes.legend(**style.LEGEND, handlelength=4)
    style.tidy(axes, "period of the pulse [s]", "least amplitude that overturns [g]")
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

"""Plots of many structures: uplift acceleration against frequency parameter with the outcomes, and a map of them."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, floor, log10, radians
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from rocking_cli.arrays import Reals
from rocking_cli.plotting import style
from rocking_cli.plotting.labels import name_marks
from rocking_cli.questions.survey.structure_table import Coordinates
from rocking_cli.questions.survey.study import Survey

MAX_RANKED_LABELS = 10  # structures whose rank stands beside their mark
MAX_VECTOR_MARKS = 2000  # more are drawn as one image
MARKS: dict[str, dict[str, Any]] = {
    "does not uplift": {"marker": "o", "color": style.PAPER, "markeredgecolor": style.SPARED},
    "rocks": {"marker": "o", "color": style.SPARED, "markeredgecolor": style.PAPER},
    "unknown under at least one motion": {"marker": "D", "color": style.PAPER, "markeredgecolor": style.FAINT},
    "overturns under at least one motion": {"marker": "^", "color": style.EXCEEDED, "markeredgecolor": style.PAPER},
    "structure": {"marker": "o", "color": style.SPARED, "markeredgecolor": style.PAPER},
}


def draw_survey(found: Survey, title: str) -> Figure:
    """Plot the structures that have an equivalent block, with the ranks of the most vulnerable.

    Parameters
    ----------
    found : Survey
        The survey to plot.
    title : str
        Heading.
    """
    figure, axes = style.one_panel(4.2, title)
    p = np.array([each.p for each in found.rows])
    uplift = np.array([each.uplift for each in found.rows])
    there = np.isfinite(p)
    for look, here in _groups(found).items():
        here = here & there
        if here.any():
            label = f"{look} ({here.sum():,})" if found.motions else None
            edge = 0.8 if MARKS[look]["color"] == style.PAPER else 0.3
            axes.plot(
                p[here], uplift[here], linestyle="none", markersize=5 if len(p) <= MAX_VECTOR_MARKS else 3, label=label,
                markeredgewidth=edge, rasterized=len(p) > MAX_VECTOR_MARKS, **MARKS[look],
            )  # fmt: skip
    first = np.flatnonzero(there)[:MAX_RANKED_LABELS]
    size = 7 if len(p) <= MAX_VECTOR_MARKS else 4.5
    axes.plot(p[first], uplift[first], "o", color="none", markeredgecolor=style.INK, markersize=size)
    axes.margins(0.08)
    axes.set_ylim(bottom=0.0)
    x = "frequency parameter p [rad/s]: large structures left, small ones right"
    style.tidy(axes, x, "ground acceleration at uplift [g]")
    if missing := int((~there).sum()):
        label = f"not drawn: {missing:,} without an equivalent block (no p)"
        axes.plot([], [], linestyle="none", label=label)
    if axes.get_legend_handles_labels()[1]:
        style.legend_below(figure)
    ranked = [(float(p[k]), float(uplift[k]), str(k + 1)) for k in first]
    name_marks(axes, ranked, np.column_stack([p[there], uplift[there]]))
    return figure


def _groups(found: Survey) -> dict[str, NDArray[np.bool_]]:
    """Return masks of the structures by outcome, the worst drawn last."""
    if not found.motions:
        return {"structure": np.ones(len(found.rows), dtype=bool)}
    falls = np.array([each.under is not None and each.under.overturned > 0 for each in found.rows])
    doubtful = np.array([each.under is not None and bool(each.under.unknown) for each in found.rows]) & ~falls
    lifts = np.array([each.under is not None and each.under.peak_ratio > 0 for each in found.rows])
    known = ~falls & ~doubtful
    return {
        "does not uplift": known & ~lifts,
        "rocks": known & lifts,
        "unknown under at least one motion": doubtful,
        "overturns under at least one motion": falls,
    }


METRES_PER_DEGREE = 6_371_008.8 * np.pi / 180  # m per degree of latitude, on a sphere of the mean radius of the earth
LEAST_EXTENT = 100.0  # m; extent of a map of one place
BORDER_SHARE = 0.08  # border around the marks, over the extent of the map
SLIMMEST = 0.6  # least ratio of the shorter side of a map to the longer one
SCALE_SHARE = 0.3  # longest scale bar over the width of the map
SAME_PLACE_SHARE = 0.02  # distance over the width of the map within which structures share a label
RANKS = LinearSegmentedColormap.from_list("ranks", style.RANKS)
"""Colours of the ranks, from dark for the first to pale, so that the order is visible in grey."""


def draw_map(found: Survey, where: Coordinates, title: str) -> Figure:
    """Draw the structures that have coordinates, the most vulnerable on top, with the ranks of the first.

    Parameters
    ----------
    found : Survey
        The survey.
    where : Coordinates
        Where its structures are.
    title : str
        Heading.
    """
    there = np.flatnonzero(np.isfinite(where.longitude))  # by rank
    x, y, ranks = where.longitude[there], where.latitude[there], there + 1
    (west, east), (south, north), narrower = _extent(x, y)
    shape = (north - south) / ((east - west) * narrower)
    narrow = style.is_narrow()
    wide, other = (2.85, 1.8) if narrow else (5.4, 1.2)  # inches: width of the map, height of all else
    figure, axes = style.one_panel(min(8.0, other + wide * shape), title)
    axes.set_xlim(west, east)
    axes.set_ylim(south, north)
    axes.set_aspect(1 / narrower)
    norm = Normalize(1, max(len(found.rows), 2))
    sizes = np.where(np.arange(len(x)) < MAX_RANKED_LABELS, 40.0, 22.0 if len(x) <= MAX_VECTOR_MARKS else 9.0)
    edges = np.where(np.arange(len(x)) < MAX_RANKED_LABELS, style.MEDIUM, style.HAIR)
    axes.scatter(
        x[::-1], y[::-1], c=ranks[::-1], cmap=RANKS, norm=norm, s=sizes[::-1],
        edgecolors=style.INK, linewidths=edges[::-1].tolist(), rasterized=len(x) > MAX_VECTOR_MARKS, zorder=3,
    )  # fmt: skip
    style.tidy(axes, "longitude [deg]", "latitude [deg]")
    axes.ticklabel_format(useOffset=False, style="plain")
    for axis, most in ((axes.xaxis, 3 if narrow else 4), (axes.yaxis, 6)):
        axis.set_major_locator(MaxNLocator(most))
    _scale_bar(axes, narrower)
    if len(found.rows) > 1:
        _bar_of_ranks(figure, axes, norm, len(found.rows))
    if missing := len(found.rows) - len(there):
        axes.plot([], [], linestyle="none", label=f"not on the map: {missing:,} without coordinates")
        style.legend_below(figure)
    first = slice(MAX_RANKED_LABELS)
    ranked = _in_places(axes, x[first], y[first], ranks[first].tolist(), narrower)
    name_marks(axes, ranked, np.column_stack([x, y]))
    return figure


def _extent(x: Reals, y: Reals) -> tuple[tuple[float, float], tuple[float, float], float]:
    """Return the limits of longitude and latitude, and the length of a degree of longitude over one of latitude."""
    middle = (float(x.min() + x.max()) / 2, float(y.min() + y.max()) / 2)
    narrower = max(cos(radians(middle[1])), 0.01)  # at a pole longitudes have no length
    least, bordered = LEAST_EXTENT / METRES_PER_DEGREE, 1 + 2 * BORDER_SHARE
    sizes = [max(size, least) * bordered for size in (float(np.ptp(x)) * narrower, float(np.ptp(y)))]
    wide, high = (max(size, SLIMMEST * max(sizes)) for size in sizes)
    (west, east), (south, north) = (
        (at - size / 2, at + size / 2) for at, size in zip(middle, (wide / narrower, high), strict=True)
    )
    return (west, east), (south, north), narrower


def _in_places(axes: Axes, x: Reals, y: Reals, ranks: Sequence[int], narrower: float) -> list[tuple[float, float, str]]:
    """Return longitude, latitude and ranks of each place; those of structures in almost the same place in one."""
    same_place = SAME_PLACE_SHARE * float(np.ptp(axes.get_xlim())) * narrower
    labels: dict[complex, list[str]] = {}
    for longitude, latitude, rank in zip(x, y, ranks, strict=True):
        point = complex(longitude * narrower, latitude)
        place = next((each for each in labels if abs(each - point) < same_place), point)
        labels.setdefault(place, []).append(str(rank))
    return [(place.real / narrower, place.imag, ", ".join(names)) for place, names in labels.items()]


def scale_length(width: float) -> float:
    """Return the length of a scale bar for a map of a width [m]: 1, 2 or 5 times a power of ten.

    Examples
    --------
    >>> scale_length(2300.0), scale_length(160.0)
    (500.0, 20.0)
    """
    most = SCALE_SHARE * width
    power = 10.0 ** floor(log10(most))
    return max(step * power for step in (1, 2, 5) if step * power <= most)


def _scale_bar(axes: Axes, narrower: float) -> None:
    """Draw the scale bar in the lower left corner, of the length at the middle latitude."""
    west, east = axes.get_xlim()
    metres = (east - west) * narrower * METRES_PER_DEGREE
    length = scale_length(metres)
    left, low = 0.03, 0.035
    axes.plot(
        [left, left + length / metres], [low, low], transform=axes.transAxes, color=style.INK, linewidth=2.5,
        solid_capstyle="butt", zorder=5,
    )  # fmt: skip
    axes.text(
        left, low + 0.012, f"{length:g} m" if length < 1000 else f"{length / 1000:g} km", transform=axes.transAxes,
        fontsize=style.TICK, color=style.INK, va="bottom", zorder=5,
        path_effects=style.HALO,
    )  # fmt: skip


def _bar_of_ranks(figure: Figure, axes: Axes, norm: Normalize, last: int) -> None:
    below = style.is_narrow()
    look: dict[str, Any] = {"location": "bottom", "shrink": 0.9, "pad": 0.02} if below else {"shrink": 0.7, "pad": 0.02}
    bar = figure.colorbar(ScalarMappable(norm, RANKS), ax=axes, aspect=25, **look)
    if not below:
        bar.ax.invert_yaxis()
    bar.locator = MaxNLocator(4 if below else 6, integer=True)
    bar.set_ticks([1, *(each for each in bar.get_ticks() if 1 < each < 0.9 * last), last])
    bar.ax.tick_params(labelsize=style.TICK)
    bar.set_label("rank; 1 is the most vulnerable", fontsize=style.LABEL)

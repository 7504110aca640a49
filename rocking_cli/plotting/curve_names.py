"""Names of curves and marks beside them, instead of in a legend: where each is on a curve and on no other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise, product
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.text import Text
from numpy.typing import NDArray

from rocking_cli.plotting import style

Points = NDArray[np.complex128]
GAPS = (0.03, 0.09)  # inches from a curve to its name
POINT_GAPS = (0.05, 0.12, 0.22)  # inches from a mark to its name
PLACES = 60  # places that are tried along a curve
SPACING = 0.04  # inches between the points of a curve that names keep off
CLEARANCE = 0.03  # inches around a name
EDGE = 0.04  # inches from a name to the edge of the panel


def name_curves(axes: Axes, curves: Sequence[Line2D]) -> bool:
    """Write the label of each curve of a finished panel beside it; return whether all fit.

    If one does not, or if the user gave the axes, nothing is written: the plot needs a legend. Limits and scales of the
    axes must be final.
    """
    _lay_out(axes)
    places = _places(axes, curves)
    if None in places:
        return False
    _write(axes, curves, places)
    return True


def name_points(panels: Mapping[Axes, Sequence[Line2D]]) -> dict[Axes, list[Line2D]]:
    """Write the label of each mark or line of finished panels of a figure beside it, joined to a mark farther away.

    Returns those that do not fit, all of them if the user gave the axes: the plot needs a legend of these.
    """
    _lay_out(next(iter(panels)))
    left: dict[Axes, list[Line2D]] = {}
    for axes, points in panels.items():
        places = _places(axes, points)
        _write(axes, points, places)
        left[axes] = [point for point, place in zip(points, places, strict=True) if place is None]
    return left


def _lay_out(axes: Axes) -> None:
    """Place the panels of a new figure."""
    if style.given() is None and isinstance(axes.figure, Figure):
        style.lay_out(axes.figure)


def _places(axes: Axes, curves: Sequence[Line2D]) -> list[complex | None]:
    """Return the middle of the name of each curve [inches from the lower left corner]; None if it does not fit."""
    if style.given() is not None or not curves:
        return [None] * len(curves)
    size = style.inches(axes)
    along = [_in_inches(axes, each) for each in curves]
    besides = [_in_inches(axes, each) for each in axes.lines if each not in curves]
    taken = [_box(axes, text) for text in axes.texts]  # middle and size of each name
    places: list[complex | None] = []
    for k, (curve, points) in enumerate(zip(curves, along, strict=True)):
        extent = style.size_of(str(curve.get_label()), style.TICK)
        others = np.concatenate([np.empty(0, np.complex128), *along[:k], *along[k + 1 :], *besides])
        places.append(place := _place(points, extent, others, taken, size))
        if place is not None:
            taken.append((place, extent))
    return places


def _box(axes: Axes, text: Text) -> tuple[complex, complex]:
    """Return middle and size of a text [inches], the middle from the lower left corner of the panel."""
    box = text.get_window_extent()
    low, high = (complex(x - axes.bbox.x0, y - axes.bbox.y0) / axes.figure.dpi for x, y in (box.min, box.max))
    return (low + high) / 2, high - low


def _write(axes: Axes, curves: Sequence[Line2D], places: Sequence[complex | None]) -> None:
    size = style.inches(axes)
    look: dict[str, Any] = {"ha": "center", "va": "center", "zorder": 8, "path_effects": style.HALO}
    look["fontsize"] = style.TICK
    for curve, place in zip(curves, places, strict=True):
        if place is None:
            continue
        at = (place.real / size.real, place.imag / size.imag)
        x, y = np.asarray(curve.get_xdata()), np.asarray(curve.get_ydata())
        look["color"] = style.WORDS.get(str(curve.get_color()), curve.get_color())
        if x.size > 1:
            axes.text(*at, str(curve.get_label()), transform=axes.transAxes, **look)
            continue
        line = {"arrowstyle": "-", "color": style.FAINT, "linewidth": style.THIN, "shrinkA": 1, "shrinkB": 3}
        axes.annotate(str(curve.get_label()), (x[0], y[0]), at, textcoords="axes fraction", arrowprops=line, **look)


def _in_inches(axes: Axes, curve: Line2D) -> Points:
    """Return points along a curve, close together, from the lower left corner of the panel [inches]."""
    x, y = (np.asarray(each, np.float64) for each in (curve.get_xdata(orig=False), curve.get_ydata(orig=False)))
    if x.size == 0:
        return np.empty(0, np.complex128)
    with np.errstate(invalid="ignore", divide="ignore"):
        pixels = curve.get_transform().transform(np.column_stack(np.broadcast_arrays(x, y)))
    z = (pixels @ np.array([1, 1j]) - complex(axes.bbox.x0, axes.bbox.y0)) / axes.figure.dpi
    known = np.isfinite(z.real) & np.isfinite(z.imag)
    pieces = [z[known]]
    for start, end in pairwise(z):
        if np.isfinite(abs(end - start)) and SPACING < abs(end - start) < 50:
            pieces.append(start + (end - start) * np.linspace(0, 1, 2 + int(abs(end - start) / SPACING)))
    points: Points = np.concatenate(pieces)
    return points[np.argsort(points.real, kind="stable")]


def _place(
    points: Points, extent: complex, others: Points, taken: Sequence[tuple[complex, complex]], size: complex
) -> complex | None:
    """Return the middle of a name [inches]: of the places that cover nothing, the one farthest from other curves."""
    inside = points[(points.real > 0) & (points.real < size.real) & (points.imag > 0) & (points.imag < size.imag)]
    if not inside.size:
        return None
    anchors = inside[np.linspace(0, inside.size - 1, min(PLACES, inside.size)).astype(int)]
    every, gaps = np.concatenate([points, others]), GAPS if points.size > 1 else POINT_GAPS
    best: tuple[float, complex] | None = None
    for anchor, gap, up, aside in product(anchors, gaps, (1, -1), (0, 1, -1)):
        middle = anchor + 1j * up * (gap + extent.imag / 2) + aside * (gap + extent.real / 2)
        if not (_within(middle.real, extent.real, size.real) and _within(middle.imag, extent.imag, size.imag)):
            continue
        if _covers(middle, extent, every) or any(_covers(middle, extent + each, np.array([at])) for at, each in taken):
            continue
        free = float(np.abs(others - middle).min()) if others.size else 1.0
        score = min(free, 0.6) - gap * (1 if points.size > 1 else 5)  # near a mark
        if best is None or score > best[0]:
            best = score, middle
    return None if best is None else best[1]


def _within(middle: float, extent: float, size: float) -> bool:
    return extent / 2 + EDGE <= middle <= size - extent / 2 - EDGE


def _covers(middle: complex, extent: complex, points: Points) -> bool:
    away = points - middle
    reach = extent / 2 + CLEARANCE * (1 + 1j)
    return bool(((np.abs(away.real) < reach.real) & (np.abs(away.imag) < reach.imag)).any())

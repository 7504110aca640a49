"""Names of curves beside them, instead of in a legend: where each is on a curve and on no other."""

from __future__ import annotations

from collections.abc import Sequence
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
PLACES = 60  # places that are tried along a curve
SPACING = 0.04  # inches between the points of a curve that names keep off
CLEARANCE = 0.03  # inches around a name
EDGE = 0.04  # inches from a name to the edge of the panel


def name_curves(axes: Axes, curves: Sequence[Line2D]) -> bool:
    """Write the label of each curve of a finished panel beside it; return whether all fit.

    If one does not, or if the user gave the axes, nothing is written: the plot needs a legend. Limits and scales of the
    axes must be final.
    """
    figure = axes.figure
    if style.given() is not None or not isinstance(figure, Figure):
        return False
    figure.draw_without_rendering()  # places the panel
    size = style.inches(axes)
    along = [_in_inches(axes, each) for each in curves]
    every = np.concatenate([*along, *(_in_inches(axes, each) for each in axes.lines if each not in curves)])
    taken = [_middle_and_size(axes, each) for each in axes.texts]
    placed = []
    for curve, points in zip(curves, along, strict=True):
        text = str(curve.get_label())
        extent = style.size_of(text, style.TICK)
        place = _place(points, extent, every, taken, size)
        if place is None:
            return False
        taken.append((place, extent))
        placed.append((text, place, curve.get_color()))
    look: dict[str, Any] = {"fontsize": style.TICK, "ha": "center", "va": "center", "zorder": 8}
    for text, place, colour in placed:
        at = (place.real / size.real, place.imag / size.imag)
        axes.text(*at, text, transform=axes.transAxes, color=colour, path_effects=style.HALO, **look)
    return True


def _middle_and_size(axes: Axes, text: Text) -> tuple[complex, complex]:
    """Return where a text is, from the lower left corner of the panel, and how large it is [inches]."""
    box = text.get_window_extent()
    middle = complex(box.x0 + box.x1, box.y0 + box.y1) / 2 - complex(axes.bbox.x0, axes.bbox.y0)
    return middle / axes.figure.dpi, complex(box.width, box.height) / axes.figure.dpi


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
    points: Points, extent: complex, every: Points, taken: Sequence[tuple[complex, complex]], size: complex
) -> complex | None:
    """Return the middle of a name [inches]: of the places that cover nothing, the one farthest from other curves."""
    inside = points[(points.real > 0) & (points.real < size.real) & (points.imag > 0) & (points.imag < size.imag)]
    if not inside.size:
        return None
    anchors = inside[np.linspace(0, inside.size - 1, min(PLACES, inside.size)).astype(int)]
    others = every[~np.isin(every, points)]
    best: tuple[float, complex] | None = None
    for anchor, gap, up, aside in product(anchors, GAPS, (1, -1), (0, 1, -1)):
        middle = anchor + 1j * up * (gap + extent.imag / 2) + aside * (gap + extent.real / 2)
        if not (_within(middle.real, extent.real, size.real) and _within(middle.imag, extent.imag, size.imag)):
            continue
        if _covers(middle, extent, every) or any(_covers(middle, extent + each, np.array([at])) for at, each in taken):
            continue
        free = float(np.abs(others - middle).min()) if others.size else 1.0
        score = min(free, 0.6) - gap
        if best is None or score > best[0]:
            best = score, middle
    return None if best is None else best[1]


def _within(middle: float, extent: float, size: float) -> bool:
    return extent / 2 + EDGE <= middle <= size - extent / 2 - EDGE


def _covers(middle: complex, extent: complex, points: Points) -> bool:
    away = points - middle
    reach = extent / 2 + CLEARANCE * (1 + 1j)
    return bool(((np.abs(away.real) < reach.real) & (np.abs(away.imag) < reach.imag)).any())

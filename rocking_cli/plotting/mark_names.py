"""Names of points beside them: none on another, few on marks, and a line to a point that is farther off."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from rocking_cli.plotting import style

GAPS = (0.08, 0.16, 0.28, 0.42, 0.6, 0.8)  # inches from a point to its name
LEAST_LINE = 0.1  # inches from which a line leads from a name to its point
TURNS = np.arange(16)
DIRECTIONS = np.exp(1j * np.pi * (0.25 + TURNS / 8))  # the upper right first
MARK_COST, LINE_COST, POINT_COST, NAME_COST = 0.1, 0.3, 0.4, 100.0  # of what a name covers, in inches farther off
CLEARANCE, CLEARANCE_OF_POINTS = 0.03, 0.1  # inches around a name; a name close to another point would be taken for its


def name_marks(axes: Axes, points: Sequence[tuple[float, float, str]], marks: NDArray[np.float64]) -> None:
    """Write a name beside each of some points of a finished panel.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        The panel; its limits and scales must be final.
    points : sequence of (float, float, str)
        Place [data] and name of each point, the most important first.
    marks : ndarray, shape (n, 2)
        Places of all marks [data].
    """
    if style.given() is None and isinstance(axes.figure, Figure):
        style.lay_out(axes.figure)
    size, dpi, corner = style.inches(axes), axes.figure.dpi, complex(axes.bbox.x0, axes.bbox.y0)
    named = _inches(axes, np.array([each[:2] for each in points]).reshape(-1, 2))
    boxes = [each.get_window_extent() for each in axes.texts]
    texts = [
        _spread(
            (complex(each.x0 + each.x1, each.y0 + each.y1) / 2 - corner) / dpi, complex(each.width, each.height) / dpi
        )
        for each in boxes
    ]
    taken = np.concatenate([_inches(axes, marks), named, *texts])
    counts = [len(marks), len(named), taken.size - len(marks) - len(named)]
    costs = np.repeat([MARK_COST, POINT_COST, NAME_COST], counts)
    clear = np.repeat([CLEARANCE, CLEARANCE_OF_POINTS, CLEARANCE], counts)
    for k, ((x, y, name), at) in enumerate(zip(points, named, strict=True)):
        extent = style.size_of(name, style.TICK)
        # From the point to the edge of the name, then to its middle.
        half = np.minimum(
            extent.real / 2 / np.maximum(np.abs(DIRECTIONS.real), 1e-9),
            extent.imag / 2 / np.maximum(np.abs(DIRECTIONS.imag), 1e-9),
        )
        moves = np.concatenate([(gap + half) * DIRECTIONS for gap in GAPS])
        away = taken[:, None] - (at + moves)
        excess = [np.abs(each).T - clear for each in (away.real, away.imag)]
        covered = (excess[0] < extent.real / 2) & (excess[1] < extent.imag / 2)
        covered[:, len(marks) + k] = False
        off = at + moves - size / 2
        beyond = np.maximum(np.abs(off.real) - (size - extent).real / 2, 0)
        beyond += np.maximum(np.abs(off.imag) - (size - extent).imag / 2, 0)
        farther = np.add.outer(GAPS, 0.005 * TURNS).ravel()
        best = int((farther + covered @ costs + NAME_COST * beyond).argmin())
        move, leads = complex(moves[best]), GAPS[best // TURNS.size] > LEAST_LINE
        line = {"arrowstyle": "-", "color": style.INK, "linewidth": style.THIN, "shrinkA": 0, "shrinkB": 3}
        axes.annotate(
            name, (x, y), (style.POINTS_PER_INCH * move.real, style.POINTS_PER_INCH * move.imag), ha="center",
            textcoords="offset points", va="center", fontsize=style.TICK, color=style.INK, zorder=7,
            bbox={"facecolor": style.PAPER, "edgecolor": "none", "alpha": 0.85, "pad": 0.6},
            arrowprops=line | {"path_effects": style.HALO, "zorder": 6} if leads else None,
        )  # fmt: skip
        box = _spread(at + move, extent)
        between = at + move * np.linspace(0, 1, 12)[1:-1] if leads else np.empty(0)
        taken = np.concatenate([taken, box, between])
        costs = np.concatenate([costs, np.full(box.size, NAME_COST), np.full(between.size, LINE_COST)])
        clear = np.concatenate([clear, np.full(box.size + between.size, CLEARANCE)])


def _spread(middle: complex, extent: complex) -> NDArray[np.complex128]:
    """Return points all over a text [inches]."""
    grid = np.linspace(-0.5, 0.5, 7)
    points: NDArray[np.complex128] = middle + (extent.real * grid[:, None] + 1j * extent.imag * grid).ravel()
    return points


def _inches(axes: Axes, data: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Return places from the lower left corner of a panel [inches]."""
    pixels = axes.transData.transform(data)
    inches: NDArray[np.complex128] = (
        pixels @ np.array([1, 1j]) - complex(axes.bbox.x0, axes.bbox.y0)
    ) / axes.figure.dpi
    return inches

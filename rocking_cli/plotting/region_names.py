"""Names of the regions of a plane, written in them where they fit."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.path import Path

from rocking_cli.arrays import Bools, Integers, Reals
from rocking_cli.plotting import style

RASTER = 0.03  # inches between the places that are tried
LINE_HEIGHT = 1.25  # of the size of type
ROOMS = (2.5, 1.8, 1.3)  # room around a name, in sizes of the name; the last leaves some for a legend below the panel


def name_regions(
    axes: Axes, region: Callable[[Reals, Reals], Integers], names: Mapping[int, str], dark: Collection[int] = ()
) -> set[int]:
    """Write the name of each region of a panel in it, off lines and words, and return the regions in which it fits.

    In axes of the user, whose size may change, none is written. Limits and scales of the axes must be final.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        The panel.
    region : callable
        Returns the numbers of the regions at every combination of some x (columns) and y (rows).
    names : mapping of int to str
        Names, by number of the region.
    dark : collection of int
        Regions whose colour is dark: their names are in a box.
    """
    figure = axes.figure
    if style.given() is not None or not isinstance(figure, Figure):
        return set()
    style.lay_out(figure)
    size = style.inches(axes)
    x, y = (np.arange(RASTER / 2, length, RASTER) / length for length in (size.real, size.imag))
    along = [(axes.transAxes - axes.transData).transform(np.column_stack([each, each])) for each in (x, y)]
    regions = region(along[0][:, 0], along[1][:, 1])
    covered = _covered(axes, regions.shape)
    box = {"facecolor": style.PAPER, "edgecolor": "none", "boxstyle": "round,pad=0.25"}
    look: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": style.TICK, "color": style.INK, "zorder": 5}
    named = set()
    for number, name in names.items():
        for count in range(1, len(name.split()) + 1):
            lines = style.folded(name, style.size_of(name, style.TICK).real / count, style.TICK)
            middle = _middle((regions == number) & ~covered, lines)
            if middle is not None:
                at = middle * RASTER / (size.imag, size.real)
                axes.text(at[1], at[0], lines, transform=axes.transAxes, bbox=box if number in dark else None, **look)
                named.add(number)
                break
    return named


def _covered(axes: Axes, shape: tuple[int, ...]) -> Bools:
    """Return which places of the raster of a panel are under lines or words."""
    covered = np.zeros(shape, np.bool_)
    paths = [each.get_transform().transform_path(each.get_path()) for each in axes.lines]
    paths += [axes.transData.transform_path(path) for each in axes.collections for path in each.get_paths()]
    paths += [Path(each.get_window_extent().corners()[[0, 1, 3, 2]]) for each in axes.texts]
    for path in paths:
        points = np.asarray(path.interpolated(20).vertices) - np.array([axes.bbox.x0, axes.bbox.y0])
        places = np.floor(points[np.isfinite(points).all(axis=1)] / (RASTER * axes.figure.dpi)).astype(int)
        column, row = places[((places >= 0) & (places < shape[::-1])).all(axis=1)].T
        covered[row, column] = True
    return covered


def _middle(free: Bools, lines: str) -> Reals | None:
    """Return row and column of the middle of the best place for a name in a region; None if it does not fit."""
    each = lines.split("\n")
    extent = np.array(
        [
            LINE_HEIGHT * style.TICK / style.POINTS_PER_INCH * len(each),
            max(style.size_of(line, style.TICK).real for line in each),
        ]
    )
    total = np.pad(np.cumsum(np.cumsum(free, axis=0), axis=1), ((1, 0), (1, 0)))
    for room in ROOMS:
        height, width = np.ceil(room * extent / RASTER).astype(int)
        if height >= free.shape[0] or width >= free.shape[1]:
            continue
        inside = total[height:, width:] - total[:-height, width:] - total[height:, :-width] + total[:-height, :-width]
        middles = np.argwhere(inside == height * width) + np.array([height, width]) / 2
        if middles.size:
            away = np.hypot(*(middles - np.argwhere(free).mean(axis=0)).T)
            best: Reals = middles[away.argmin()]
            return best
    return None

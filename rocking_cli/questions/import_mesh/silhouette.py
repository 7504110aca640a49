"""The silhouette of a body in the plane in which it rocks, as the left and right end of it at each height."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Points, Reals
from rocking_cli.core.polygons import POINT_DISTANCE, size_of
from rocking_cli.questions.import_mesh.solid import Triangles

MAX_HEIGHTS = 80  # heights at which the ends are taken; those of the corners if they are fewer
LEAST_WIDTH = 1e-6  # over the size, so that its two sides do not touch
FLAT = 1e-4  # distance of a corner from the line of its neighbours, over the size, from which it is kept


def sides_of(triangles: Triangles) -> Triangles:
    """Return the sides of triangles, each once, shape (k, 2)."""
    start, end = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    return np.stack([start[start < end], end[start < end]], axis=1)


def silhouette(points: Reals, sides: Triangles, azimuth: float) -> Points:
    """Return the silhouette of a body as a polygon x + iy [m], anticlockwise; hollows that show sideways are filled.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        Points of the body, from below its centre of mass [m].
    sides : ndarray of int, shape (k, 2)
        Sides of its triangles.
    azimuth : float
        Direction of x in plan [rad].
    """
    x = points[:, 0] * np.cos(azimuth) + points[:, 1] * np.sin(azimuth)
    z = points[:, 2]
    upwards = z[sides[:, 0]] <= z[sides[:, 1]]
    low, high = np.where(upwards, sides.T, sides.T[::-1])
    heights = np.unique(z)
    if heights.size > MAX_HEIGHTS:
        heights = np.linspace(heights[0], heights[-1], MAX_HEIGHTS)
    below = _ends(x, z, low, high, heights, "right")
    above = _ends(x, z, low, high, heights, "left")
    level = np.repeat(heights, 2)[1:-1]  # above the lowest, below and above the next, ..., below the highest
    left, right = (np.stack([below[k], above[k]], axis=1).ravel()[1:-1] for k in range(2))
    gap = np.isinf(left)  # between parts that do not touch
    for each in (left, right):
        each[gap] = np.interp(level[gap], level[~gap], each[~gap])
    size = float(np.ptp(x) + np.ptp(z))
    middle, half = (left + right) / 2, np.maximum(right - left, LEAST_WIDTH * size) / 2
    outline = np.concatenate([middle + half + 1j * level, (middle - half + 1j * level)[::-1]])
    return _plain(outline)


def _ends(
    x: Reals, z: Reals, low: NDArray[np.int64], high: NDArray[np.int64], heights: Reals, side: Literal["left", "right"]
) -> Reals:  # fmt: skip
    """Return the least and the greatest x of sides at some heights, shape (2, heights).

    The sides are those that come up to a height ("right": low < height <= high), or leave it ("left").
    """
    first, last = (np.searchsorted(heights, z[each], side=side) for each in (low, high))
    count = np.maximum(last - first, 0)
    which = np.repeat(np.arange(len(low)), count)
    at = np.arange(which.size) - np.repeat(np.cumsum(count) - count, count) + np.repeat(first, count)
    one, other = low[which], high[which]
    share = (heights[at] - z[one]) / (z[other] - z[one])
    across = x[one] + share * (x[other] - x[one])
    ends = np.stack([np.full(heights.size, np.inf), np.full(heights.size, -np.inf)])
    np.minimum.at(ends[0], at, across)
    np.maximum.at(ends[1], at, across)
    return ends


def _plain(outline: Points) -> Points:
    """Return an outline without corners that repeat or lie on the line of their neighbours."""
    size, turn, idle = size_of(outline), 0, 0
    while idle < 2 and outline.size > 3:  # of neighbours not both at a time
        before, after = np.roll(outline, 1), np.roll(outline, -1)
        along = after - before
        off = np.abs((along.conj() * (outline - before)).imag) / np.maximum(np.abs(along), POINT_DISTANCE * size)
        ahead = ((outline - before).conj() * (after - outline)).real >= 0
        drop = (np.abs(outline - before) <= POINT_DISTANCE * size) | ((off <= FLAT * size) & ahead)
        drop &= np.arange(outline.size) % 2 == turn
        turn, idle = 1 - turn, 0 if drop.any() else idle + 1
        outline = outline[~drop]
    return outline

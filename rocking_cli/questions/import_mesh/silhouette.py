"""The silhouette of a body in the plane in which it rocks, as the left and right end of it at each height."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rocking_cli.arrays import Points, Reals
from rocking_cli.questions.import_mesh.solid import Triangles

MAX_HEIGHTS = 80  # heights at which the ends are taken; those of the corners if they are fewer
BESIDE = 1e-6  # distance from these heights to the cuts below and above them, over the size
LEAST_WIDTH = 1e-6  # over the size, so that its two sides do not touch
FLAT = 1e-4  # distance of the polygon from the silhouette, over the size


@dataclass(frozen=True, eq=False)
class Cuts:
    """Level cuts through a body: their heights [m], the ends of their lines, shape (n, 3) each, and the size [m]."""

    heights: Reals
    ends: Sequence[Reals]
    size: float


def cuts_of(points: Reals, triangles: Triangles) -> Cuts:
    """Return cuts above the lowest corner, below and above the next, ..., below the highest."""
    from trimesh import Trimesh
    from trimesh.intersections import mesh_plane

    size = float(np.ptp(points, axis=0).max())
    body = Trimesh(points / size, triangles, process=False)
    z: Reals = points[:, 2] / size
    heights = np.unique(z)
    heights = heights[np.diff(heights, prepend=-1) > 4 * BESIDE]
    if heights.size > MAX_HEIGHTS:
        heights = np.linspace(heights[0], heights[-1], MAX_HEIGHTS)
    heights = np.repeat(heights, 2)[1:-1]
    ends = [
        size * mesh_plane(body, [0, 0, 1], [0, 0, height], cached_dots=z - height).reshape(-1, 3)
        for height in heights + BESIDE * (-1) ** np.arange(len(heights))
    ]
    return Cuts(size * heights, ends, size)


def silhouette(cuts: Cuts, azimuth: float) -> Points:
    """Return the silhouette of a body as a polygon x + iy [m], anticlockwise; hollows that show sideways are filled.

    Parameters
    ----------
    cuts : Cuts
        Cuts through it.
    azimuth : float
        Direction of x in plan [rad].
    """
    import shapely

    along, level = np.array([np.cos(azimuth), np.sin(azimuth), 0]), cuts.heights
    spans = [((x := each @ along).min(), x.max()) if len(each) else (np.nan, np.nan) for each in cuts.ends]
    left, right = np.array(spans).T
    gap = np.isnan(left)  # between parts that do not touch
    for each in (left, right):
        each[gap] = np.interp(level[gap], level[~gap], each[~gap])
    middle, half = (left + right) / 2, np.maximum(right - left, LEAST_WIDTH * cuts.size) / 2
    ring = np.stack([[*(middle + half), *(middle - half)[::-1]], [*level, *level[::-1]]], axis=1)
    plain = shapely.simplify(shapely.linearrings(ring), FLAT * cuts.size, preserve_topology=False)
    outline: Points = shapely.get_coordinates(plain)[:-1] @ np.array([1, 1j])
    return outline

"""Area of a polygon, and where points are relative to it.

Corners are complex numbers x + iy [m], in order around the polygon, the last joined to the first.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from rocking_cli.core.kinematics import Points, Reals


def area_of(corners: Sequence[complex] | Points) -> float:
    """Return the area of a polygon [m2], negative if its corners are clockwise."""
    z = np.asarray(corners) - corners[0]
    return float((z.conj() * np.roll(z, -1)).imag.sum() / 2)


def distance(points: Points, z: Points) -> Reals:
    """Return the distances of points from the sides of a polygon [m]."""
    side = np.roll(z, -1) - z
    away = points[:, None] - z
    along = np.clip((away * side.conj()).real / squared(side), 0.0, 1.0)
    return np.asarray(np.abs(away - along * side).min(axis=1))


def inside(points: Points, z: Points) -> NDArray[np.bool_]:
    """Return whether points are inside a polygon; for points on a side, either result is possible."""
    w = np.roll(z, -1)
    y = points.imag[:, None]
    spans = (z.imag > y) != (w.imag > y)
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = z.real + (y - z.imag) / (w - z).imag * (w - z).real
    return np.asarray(np.count_nonzero(spans & (points.real[:, None] < crossing), axis=1) % 2 == 1)


def squared(side: Points) -> Reals:
    """Return the squared lengths of sides, with 1 for sides so short that the square vanishes."""
    found = np.abs(side) ** 2
    return np.where(found == 0, 1.0, found)

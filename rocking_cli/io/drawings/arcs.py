"""Arcs by their ends and their bulge, tan(turn/4): their circles, and points along them."""

from __future__ import annotations

from collections.abc import Callable
from math import atan, cbrt, ceil, pi, sin, sqrt, tan

import numpy as np

from rocking_cli.arrays import Points

SIDES_PER_HALF_TURN = 128  # with the area kept: 1e-6 in lambda, phi_cr and inertia, even if all sides are arcs
STRAIGHT_BULGE = 1e-9  # bulge up to which a side counts as straight
Sides = Callable[[float, float], int]
"""Function that gives the number of straight sides of an arc from its radius and its turn [rad]."""


def arc_circle(start: complex, end: complex, bulge: float) -> tuple[complex, float]:
    """Return the centre and the radius of an arc."""
    centre = (start + end) / 2 + 1j * (end - start) * (1 - bulge**2) / (4 * bulge)
    return centre, abs(start - centre)


def level_count(_: float, turn: float) -> int:
    """Return the number of sides of an arc that keep its area: 128 a half turn, and more for flat arcs."""
    share = min(cbrt(abs(tan(turn / 4))), 1.0)
    return max(ceil(SIDES_PER_HALF_TURN * abs(turn) / pi), ceil(SIDES_PER_HALF_TURN * share), 2)


def inner_points(start: complex, end: complex, bulge: float, count: Sides, *, keeps_area: bool = False) -> Points:
    """Return points along an arc between its ends; `count` gives the number of sides from radius and turn."""
    turn = 4 * atan(bulge)
    centre, radius = arc_circle(start, end, bulge)
    n = count(radius, turn)
    out = _area_kept(abs(turn), n) if keeps_area else 1.0
    points: Points = centre + out * (start - centre) * np.exp(1j * turn * np.arange(1, n) / n)
    return points


def _area_kept(turn: float, n: int) -> float:
    """Return q, the distance of the inner points over the radius at which n sides have the area of the arc."""
    right = turn / sin(turn / n)
    return right / 2 if n == 2 else (sqrt(1 + (n - 2) * right) - 1) / (n - 2)  # (n - 2) q^2 + 2 q = right

"""Closed lines with arcs: their exact area, centroid and moment, and polygons in their place."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import acos, ceil, pi
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Points, Reals
from rocking_cli.io.drawings.contract import STRAIGHT_BULGE, Sides, arc_circle, inner_points, level_count

Number = TypeVar("Number", bound=np.generic)
CHORD = 0.1  # share of the closing distance to which arcs are compared
ROOT = 3**-0.5
GAUSS = tuple((x + k) / 2 for k, x in zip((1, 0), np.polynomial.legendre.leggauss(20), strict=True))
"""Places along a side from 0 to 1 and their weights; exact for arcs of less than a full turn."""
TWO_POINTS = np.array([(1 - ROOT) / 2, (1 + ROOT) / 2]), np.array([0.5, 0.5])
"""Those that are exact for straight sides."""
MAX_ARC_SIDES = 2000
SAME_DIRECTION = 1e-6  # sine between two sides of one line
SAME_CIRCLE = 1e-6  # distance of the centres of arcs of one circle, over its radius
MAX_TURN = 2 * pi - 0.1  # of one arc [rad]


def _sides(z: Points) -> Points:
    """Return the vector from each corner to the next."""
    return following(z) - z


def following(values: NDArray[Number]) -> NDArray[Number]:
    """Return the value at the next corner of each corner; `np.roll` takes five times as long."""
    return np.concatenate((values[1:], values[:1]))


class PlaneMoments(NamedTuple):
    """Area [m2], centroid x + iy [m] and polar moment about the centroid [m4] of a plane shape."""

    area: float
    centroid: complex
    polar: float

    @classmethod
    def of_sum(cls, parts: Sequence[PlaneMoments]) -> PlaneMoments:
        """Return the moments of a sum; areas and polar moments of openings are negative."""
        area = sum(each.area for each in parts)
        centroid = sum(each.area * each.centroid for each in parts) / area
        polar = sum(each.polar + each.area * abs(each.centroid - centroid) ** 2 for each in parts)
        return cls(area, centroid, polar)

    def negative(self) -> PlaneMoments:
        """Return the moments of an opening of this shape."""
        return PlaneMoments(-self.area, self.centroid, -self.polar)


@dataclass(frozen=True, eq=False)
class ArcRing:
    """A closed line that runs anticlockwise.

    Parameters
    ----------
    z : ndarray of complex, shape (n,)
        Corners, x + iy [m].
    bulges : ndarray, shape (n,)
        tan(turn/4) of the arc from each corner to the next; 0 is a straight side.
    """

    z: Points
    bulges: Reals

    @classmethod
    def of(cls, z: Points, bulges: Reals) -> ArcRing:
        """Return the ring of a closed line in either sense."""
        ring = cls(z, np.where(np.abs(bulges) > STRAIGHT_BULGE, bulges, 0.0))
        return ring if ring.moments.area >= 0 else ring._around(z[::-1], -following(ring.bulges[::-1]), -1)

    @cached_property
    def arcs(self) -> int:
        """Number of sides that are arcs."""
        return int(np.count_nonzero(self.bulges))

    @cached_property
    def moments(self) -> PlaneMoments:
        """Exact moments, by integrals along the sides."""
        middle = complex(self.z.mean())  # as drawings may be far from their origin
        share, weight = GAUSS if self.arcs else TWO_POINTS
        start, chord, turn = (self.z - middle)[:, None], _sides(self.z)[:, None], 4 * np.arctan(self.bulges)[:, None]
        over = chord / np.sinc(turn / (2 * pi))
        z = start + over * share * np.exp(0.5j * turn * (share - 1)) * np.sinc(turn * share / (2 * pi))
        swept = (z.conj() * over * np.exp(1j * turn * (share - 0.5))).imag * weight
        area, first, polar = swept.sum() / 2, (z * swept).sum() / 3, (np.abs(z) ** 2 * swept).sum() / 4
        if not area:
            return PlaneMoments(0.0, middle, 0.0)
        centroid = complex(first / area)
        return PlaneMoments(float(area), middle + centroid, float(polar - area * abs(centroid) ** 2))

    def moved(self, shift: complex) -> ArcRing:
        """Return the ring shifted."""
        return self._around(self.z + shift, self.bulges, shift=shift)

    def _around(self, z: Points, bulges: Reals, sign: int = 1, shift: complex = 0j) -> ArcRing:
        """Return a ring around the same shape, shifted or in the other sense, whose moments are known."""
        made, (area, centroid, polar) = ArcRing(z, bulges), self.moments
        made.__dict__["moments"] = PlaneMoments(sign * area, centroid + shift, sign * polar)
        return made

    def tidied(self, close: float) -> ArcRing:
        """Return the ring without corners between two parts of one side, from its lower left corner on.

        So a file does not depend on where its lines were cut, and in which order they were drawn.
        """
        side, is_straight = _sides(self.z), self.bulges == 0
        before, was_straight = (np.concatenate((each[-1:], each[:-1])) for each in (side, is_straight))
        across = before.conj() * side
        ahead = (across.real > 0) & (np.abs(across.imag) < SAME_DIRECTION * np.abs(across))
        ring = self._merged(is_straight & was_straight & ahead)
        x, y = ring.z.real, ring.z.imag
        low = y <= y.min() + close
        first = int(np.where(low & (x <= x[low].min() + close), y, np.inf).argmin())
        order = [*range(first, len(x)), *range(first)]
        return self._around(ring.z[order], ring.bulges[order])

    def _merged(self, spare: NDArray[np.bool_]) -> ArcRing:
        """Return the ring without spare corners, and with consecutive arcs of one circle as one."""
        z, b, spare = self.z, self.bulges, spare.copy()
        if not (spare.any() or self.arcs):
            return self
        turn = 4 * np.arctan(b)
        for k in np.flatnonzero((b != 0) & (np.roll(b, 1) != 0)).tolist():  # each arc takes the turn of the next one
            (centre, radius), (other, _) = (arc_circle(*self._arc(j)) for j in (k, (k - 1) % len(z)))
            if b[k] * b[k - 1] > 0 and abs(centre - other) < SAME_CIRCLE * radius:  # of one circle and one sense
                previous = next(j % len(z) for j in range(k - 1, k - 1 - len(z), -1) if not spare[j % len(z)])
                if abs(turn[previous] + turn[k]) < MAX_TURN:
                    turn[previous] += turn[k]
                    spare[k] = True
        if np.count_nonzero(~spare) < 2 or (np.count_nonzero(~spare) == 2 and not b.any()):
            return self  # it encloses nothing
        return ArcRing(z[~spare], np.tan(turn / 4)[~spare]) if spare.any() else self

    def _arc(self, k: int) -> tuple[complex, complex, float]:
        return complex(self.z[k]), complex(self.z[(k + 1) % len(self.z)]), float(self.bulges[k])

    def level(self) -> Points:
        """Return a polygon of the same area, whose arcs have 128 sides to a half turn, and flat arcs more."""
        return self._with(level_count, keeps_area=True)

    def chords(self, tolerance: float) -> Points:
        """Return a polygon whose corners are on the arcs, and no side farther from them than a tolerance [m]."""
        return self._with(lambda radius, turn: chord_count(radius, turn, tolerance), keeps_area=False)

    def _with(self, count: Sides, *, keeps_area: bool) -> Points:
        if not self.arcs:
            return self.z
        parts = []
        for start, end, bulge in zip(self.z, following(self.z), self.bulges, strict=True):
            parts.append(np.array([start]))
            if bulge:
                parts.append(inner_points(complex(start), complex(end), float(bulge), count, keeps_area=keeps_area))
        return np.concatenate(parts)


def polygons_of(rings: Sequence[ArcRing], close: float) -> Any:
    """Return rings as polygons of shapely, their arcs as chords; an array of objects, shape (n,)."""
    import shapely

    if not rings:
        return np.array([], dtype=object)
    corners = [ring.chords(CHORD * close) for ring in rings]
    z = np.concatenate(corners)
    of = np.repeat(np.arange(len(corners)), [len(each) for each in corners])
    return shapely.polygons(shapely.linearrings(np.stack([z.real, z.imag], axis=1), indices=of))


def chord_count(radius: float, turn: float, tolerance: float) -> int:
    """Return the number of chords of an arc that keep within a tolerance of it."""
    step = 2 * acos(1 - tolerance / radius) if tolerance < radius else pi / 2
    return min(max(ceil(abs(turn) / step - 1e-9), 2), MAX_ARC_SIDES)

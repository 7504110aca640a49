"""Closed lines with arcs: their exact area, centroid and moment, and polygons in their place."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import acos, ceil, pi
from typing import Any, NamedTuple, Self, TypeVar

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Points, Reals
from rocking_cli.io.drawings.arcs import STRAIGHT_BULGE, Sides, arc_circle, inner_points, level_count

Number = TypeVar("Number", bound=np.generic)
CHORD = 0.1  # share of the closing distance to which arcs are compared
SMALL_TURN = 0.3  # turn below which differences of sines are taken from their series
MAX_ARC_SIDES = 2000
SAME_DIRECTION = 1e-6  # sine between two sides of one line
SAME_CIRCLE = 1e-6  # distance of the centres of arcs of one circle, over its radius
MAX_TURN = 2 * pi - 0.1  # of one arc [rad]


def following(values: NDArray[Number]) -> NDArray[Number]:
    """Return the value at the next corner of each corner; `np.roll` takes five times as long."""
    return np.concatenate((values[1:], values[:1]))


def preceding(values: NDArray[Number]) -> NDArray[Number]:
    """Return the value at the corner before each corner."""
    return np.concatenate((values[-1:], values[:-1]))


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
        return anticlockwise([cls(z, bulges)])[0]

    def turned(self) -> ArcRing:
        """Return the ring in the other sense."""
        return ArcRing(self.z[::-1], -np.roll(self.bulges[::-1], -1))

    @cached_property
    def arcs(self) -> int:
        """Number of sides that are arcs."""
        return int(np.count_nonzero(self.bulges))

    @cached_property
    def moments(self) -> PlaneMoments:
        """Exact moments: those of the polygon of the corners, and of the segment between each arc and its chord."""
        return _moments(RingsInRow(self.z, self.bulges, np.array([0])))[0]

    def placed(self, factor: float, shift: complex) -> ArcRing:
        """Return the ring shifted and then scaled."""
        return ArcRing((self.z + shift) * factor, self.bulges)

    def merged(self, spare: NDArray[np.bool_]) -> ArcRing:
        """Return the ring without spare corners, and with consecutive arcs of one circle as one."""
        z, b, spare = self.z, self.bulges, spare.copy()
        turn = 4 * np.arctan(b)
        for k in np.flatnonzero((b != 0) & (preceding(b) != 0)).tolist():  # each arc takes the turn of the next one
            if self._goes_on(k):
                previous = next(j % len(z) for j in range(k - 1, k - 1 - len(z), -1) if not spare[j % len(z)])
                if abs(turn[previous] + turn[k]) < MAX_TURN:
                    turn[previous] += turn[k]
                    spare[k] = True
        if np.count_nonzero(~spare) < 2 or (np.count_nonzero(~spare) == 2 and not b.any()):
            return self  # it encloses nothing
        return ArcRing(z[~spare], np.tan(turn / 4)[~spare]) if spare.any() else self

    def _goes_on(self, k: int) -> bool:
        """Return whether the arc from a corner has the circle and the sense of the one before."""
        n = len(self.z)
        (centre, radius), (other, _) = (arc_circle(*self._arc(j)) for j in (k, (k - 1) % n))
        return bool(self.bulges[k] * self.bulges[k - 1] > 0 and abs(centre - other) < SAME_CIRCLE * radius)

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


@dataclass(frozen=True, eq=False)
class RingsInRow:
    """The corners of many rings one after another, as numpy takes as long for one ring as for hundreds.

    Parameters
    ----------
    z, bulges : ndarray, shape (n,)
        Their corners and bulges, see `ArcRing`.
    begins : ndarray of int, shape (m,)
        First corner of each ring.
    """

    z: Points
    bulges: Reals
    begins: NDArray[np.intp]

    @classmethod
    def of(cls, rings: Sequence[ArcRing]) -> Self:
        """Return rings as a row."""
        begins = np.cumsum([0, *(len(ring.z) for ring in rings[:-1])])
        return cls(np.concatenate([ring.z for ring in rings]), np.concatenate([ring.bulges for ring in rings]), begins)

    @cached_property
    def ring(self) -> NDArray[np.intp]:
        """Number of the ring of each corner."""
        return np.repeat(np.arange(len(self.begins)), np.diff(self.begins, append=len(self.z)))

    @cached_property
    def after(self) -> NDArray[np.intp]:
        """Number of the next corner of each corner."""
        after = np.arange(1, len(self.z) + 1)
        after[np.append(self.begins[1:], len(self.z)) - 1] = self.begins
        return after

    def rings(self) -> list[ArcRing]:
        """Return the rings, whose moments are known."""
        made = []
        for first, last, moments in zip(self.begins, [*self.begins[1:], len(self.z)], _moments(self), strict=True):
            ring = ArcRing(self.z[first:last], self.bulges[first:last])
            ring.__dict__["moments"] = moments
            made.append(ring)
        return made


def anticlockwise(rings: Sequence[ArcRing]) -> list[ArcRing]:
    """Return rings that run in either sense as such that run anticlockwise."""
    if not rings:
        return []
    row = RingsInRow.of(rings)
    row = RingsInRow(row.z, np.where(np.abs(row.bulges) > STRAIGHT_BULGE, row.bulges, 0.0), row.begins)
    return [ring if ring.moments.area >= 0 else ring.turned() for ring in row.rings()]


def polygons_of(rings: Sequence[ArcRing], close: float) -> Any:
    """Return rings as polygons of shapely, their arcs as chords; an array of objects, shape (n,)."""
    import shapely

    if not rings:
        return np.array([], dtype=object)
    corners = [ring.chords(CHORD * close) for ring in rings]
    z = np.concatenate(corners)
    of = np.repeat(np.arange(len(corners)), [len(each) for each in corners])
    return shapely.polygons(shapely.linearrings(np.stack([z.real, z.imag], axis=1), indices=of))


def tidied(rings: Sequence[ArcRing], close: float) -> list[ArcRing]:
    """Return rings without corners between two parts of one side, from their lower left corners on.

    So a file does not depend on where its lines were cut, and in which order they were drawn.
    """
    if not rings:
        return []
    row = RingsInRow.of(rings)
    side = row.z[row.after] - row.z
    before, was_straight = np.empty_like(side), np.empty(len(side), bool)
    before[row.after], was_straight[row.after] = side, row.bulges == 0
    with np.errstate(divide="ignore", invalid="ignore"):
        sine = np.abs((before.conj() * side).imag) / (np.abs(before) * np.abs(side))
    ahead = (before.conj() * side).real > 0
    spare = (row.bulges == 0) & was_straight & ahead & (sine < SAME_DIRECTION)
    merges = set(row.ring[spare | ((row.bulges != 0) & ~was_straight)].tolist())
    ends = row.begins + [len(ring.z) for ring in rings]
    row = RingsInRow.of([
        ring.merged(spare[row.begins[k] : ends[k]]) if k in merges else ring for k, ring in enumerate(rings)
    ])  # fmt: skip
    first = row.begins.copy()
    low = row.z.imag <= (np.minimum.reduceat(row.z.imag, row.begins) + close)[row.ring]
    x = np.where(low, row.z.real, np.inf)
    left = x <= (np.minimum.reduceat(x, row.begins) + close)[row.ring]
    y = np.where(left, row.z.imag, np.inf)
    lowest = np.flatnonzero(y == np.minimum.reduceat(y, row.begins)[row.ring])
    first[row.ring[lowest[::-1]]] = lowest[::-1]  # of equal ones the first
    count = np.diff(row.begins, append=len(row.z))
    order = (
        row.begins[row.ring] + (np.arange(len(row.z)) - 2 * row.begins[row.ring] + first[row.ring]) % count[row.ring]
    )
    return RingsInRow(row.z[order], row.bulges[order], row.begins).rings()


def _moments(row: RingsInRow) -> list[PlaneMoments]:
    """Return the exact moments of each ring."""
    count = np.diff(row.begins, append=len(row.z))
    middle = np.add.reduceat(row.z, row.begins) / count  # first, as drawings may be far from their origin
    z = row.z - middle[row.ring]
    w = z[row.after]
    area = (z.conj() * w).imag / 2
    first = area * (z + w) / 3
    polar = area * (np.abs(z) ** 2 + np.abs(w) ** 2 + (z.conj() * w).real) / 6
    curved = row.bulges != 0
    if curved.any():
        start, chord, b = z[curved], (w - z)[curved], row.bulges[curved]
        turn, radius = 4 * np.arctan(b), np.abs(chord) * (1 + b**2) / (4 * np.abs(b))
        centre = start + chord / 2 + 1j * chord * (1 - b**2) / (4 * b)
        to_middle = (start + chord / 2 - 1j * chord * b / 2 - centre) / radius
        segment = radius**2 * _less_sine(turn) / 2
        # 4 r sin^3(t/2)/[3 (t - sin t)] times the area: the first moment has no difference of sines.
        along = 2 / 3 * radius**3 * np.sin(np.abs(turn) / 2) ** 3 * np.sign(turn)
        area[curved] += segment
        first[curved] += segment * centre + along * to_middle
        polar[curved] += (
            radius**4 * _polar(turn) + 2 * along * (centre.conj() * to_middle).real + segment * np.abs(centre) ** 2
        )
    total, sums, squares = (np.add.reduceat(each, row.begins) for each in (area, first, polar))
    centroid = np.divide(sums, total, out=np.zeros_like(sums), where=total != 0)
    about = np.where(total != 0, squares - total * np.abs(centroid) ** 2, 0.0)
    return list(map(PlaneMoments, total.tolist(), (middle + centroid).tolist(), about.tolist()))


def chord_count(radius: float, turn: float, tolerance: float) -> int:
    """Return the number of chords of an arc that keep within a tolerance of it."""
    step = 2 * acos(1 - tolerance / radius) if tolerance < radius else pi / 2
    return min(max(ceil(abs(turn) / step - 1e-9), 2), MAX_ARC_SIDES)


def _less_sine(turn: Reals) -> Reals:
    """Return t - sin t."""
    series = turn**3 / 6 * (1 - turn**2 / 20 * (1 - turn**2 / 42 * (1 - turn**2 / 72)))
    return np.where(np.abs(turn) < SMALL_TURN, series, turn - np.sin(turn))


def _polar(turn: Reals) -> Reals:
    """Return t/4 - sin t (2 + cos t)/12."""
    t = turn
    series = t**3 / 12 - t**5 / 80 + t**7 * 11 / 10080 - t**9 * 43 / 725760
    return np.where(np.abs(t) < SMALL_TURN, series, t / 4 - np.sin(t) * (2 + np.cos(t)) / 12)

"""Faces of bodies that do not quite meet: sides move to the middle of mortar joints, small gaps and overlaps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, radians
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Points, Reals
from rocking_cli.core.polygons import nearby
from rocking_cli.io.drawings.arcs import arc_circle
from rocking_cli.questions.import_drawing.rings import ArcRing, following, polygons_of

PARALLEL = cos(radians(3.0))
LEAST_SHARE = 0.02  # of the length of a side, over which it must face another one
NO_GAP = 1e-9  # gap that needs no mending [m]
SAME_GAP = 1e-6  # difference of gaps up to which they count as equal [m]
JOINT_GAP = 2e-3  # gap across which faces are a joint, over width plus height of the smaller body
IN_GAP = 0.01  # share of a gap from its sides within which nothing is looked for between them
LEAST_SINE = 0.02  # sine between sides below which they count as one line
Integers = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Sides:
    """Straight sides of rings: start, vector, outward normal, and the ring and the place in it of each."""

    start: Points
    along: Points
    normal: Points
    ring: Integers
    place: Integers

    @classmethod
    def from_rings(cls, rings: Sequence[ArcRing]) -> Sides:
        """Take the straight sides of rings, in their order."""
        start = np.concatenate([ring.z for ring in rings])
        along = np.concatenate([following(ring.z) - ring.z for ring in rings])
        of = np.concatenate([np.full(len(ring.z), k, np.intp) for k, ring in enumerate(rings)])
        place = np.concatenate([np.arange(len(ring.z), dtype=np.intp) for ring in rings])
        straight = (np.concatenate([ring.bulges for ring in rings]) == 0) & (np.abs(along) > NO_GAP)
        start, along, of, place = start[straight], along[straight], of[straight], place[straight]
        return cls(start, along, -1j * along / np.abs(along), of, place)


@dataclass(frozen=True, eq=False)
class Facing:
    """Pairs of sides that face each other: the sides, the gap [m], and both ends of the common part on the first."""

    one: Integers
    other: Integers
    gap: Reals
    ends: NDArray[np.complex128]


def facing(sides: Sides, least: float, most: float) -> Facing:
    """Return the sides that face a parallel side of another ring across a gap between two bounds [m]."""
    low = np.minimum(sides.start.real, (sides.start + sides.along).real) + 1j * np.minimum(
        sides.start.imag, (sides.start + sides.along).imag
    )
    high = np.maximum(sides.start.real, (sides.start + sides.along).real) + 1j * np.maximum(
        sides.start.imag, (sides.start + sides.along).imag
    )
    room = max(-least, most) * (1 + 1j) / 2
    ones, others, gaps, ends = [], [], [], []
    for first, second in nearby(low - room, high + room):
        for i, j in ((first, second), (second, first)):
            keep = (sides.ring[i] != sides.ring[j]) & ((sides.normal[i].conj() * sides.normal[j]).real < -PARALLEL)
            i, j = i[keep], j[keep]
            length = np.abs(sides.along[i])
            unit = sides.along[i] / length
            at = [((z - sides.start[i]) * unit.conj()).real for z in (sides.start[j], sides.start[j] + sides.along[j])]
            start, end = np.maximum(np.minimum(*at), 0.0), np.minimum(np.maximum(*at), length)
            middle = sides.start[i] + unit * (start + end) / 2
            across = (sides.normal[i].conj() * sides.normal[j]).real
            gap = ((sides.start[j] - middle).conj() * sides.normal[j]).real / across
            keep = (end - start > LEAST_SHARE * length) & (gap >= least) & (gap <= most)
            ones.append(i[keep])
            others.append(j[keep])
            gaps.append(gap[keep])
            ends.append(np.stack([sides.start[i] + unit * start, sides.start[i] + unit * end], axis=1)[keep])
    if not ones:
        return Facing(np.zeros(0, np.intp), np.zeros(0, np.intp), np.zeros(0), np.zeros((0, 2), np.complex128))
    return Facing(np.concatenate(ones), np.concatenate(others), np.concatenate(gaps), np.concatenate(ends))


@dataclass(frozen=True)
class Closed:
    """Result of closing gaps: the rings, how many sides moved, their gaps [m] and middles, and sides of two gaps."""

    rings: Sequence[ArcRing]
    gaps: Sequence[float]
    at: Sequence[complex]
    uneven: Sequence[complex]


def close_gaps(rings: Sequence[ArcRing], ground: Sequence[ArcRing], most: float, overlap: float) -> Closed:
    """Move the sides of bodies that face each other to the middle between them.

    Parameters
    ----------
    rings : sequence of ArcRing
        Outlines of the bodies.
    ground : sequence of ArcRing
        Those of the ground, which stay: a side that faces the ground moves by the whole gap.
    most : float
        Largest gap that is closed [m]; 0 for none.
    overlap : float
        Largest depth of an overlap that is mended [m].
    """
    sides = Sides.from_rings([*rings, *ground])
    pairs = facing(sides, -overlap, most + SAME_GAP if most else 0.0)
    across = _across_others(sides, pairs, polygons_of([*rings, *ground], overlap))
    moved = (sides.ring[pairs.one] < len(rings)) & ~across
    one, gap = pairs.one[moved], pairs.gap[moved]
    with_ground = sides.ring[pairs.other[moved]] >= len(rings)
    wide = np.abs(gap) > NO_GAP
    one, gap, with_ground = one[wide], gap[wide], with_ground[wide]
    if not one.size:
        return Closed(rings, [], [], [])
    by = np.where(with_ground, gap, gap / 2)
    order = np.lexsort((np.abs(by), one))
    last = np.append(one[order][1:] != one[order][:-1], True)
    chosen, step = one[order][last], by[order][last]
    least = np.full(len(sides.start), np.inf)
    most_of = np.full(len(sides.start), -np.inf)
    np.minimum.at(least, one, by)
    np.maximum.at(most_of, one, by)
    uneven = chosen[most_of[chosen] - least[chosen] > SAME_GAP]
    shifts: dict[int, dict[int, float]] = {}
    for side, distance in zip(chosen.tolist(), step.tolist(), strict=True):
        shifts.setdefault(int(sides.ring[side]), {})[int(sides.place[side])] = distance
    closed = [_shifted(ring, shifts[k]) if k in shifts else ring for k, ring in enumerate(rings)]
    middles = sides.start + sides.along / 2
    return Closed(closed, np.abs(gap).tolist(), middles[chosen].tolist(), middles[uneven].tolist())


def _across_others(sides: Sides, pairs: Facing, polygons: Any) -> NDArray[np.bool_]:
    """Return which pairs of sides have another ring between them."""
    import shapely

    middle = pairs.ends.mean(axis=1)
    way = sides.normal[pairs.one] * pairs.gap
    z = np.stack([middle + IN_GAP * way, middle + (1 - IN_GAP) * way], axis=1)
    lines = shapely.linestrings(np.stack([z.real, z.imag], axis=2))
    pair, ring = shapely.STRtree(polygons).query(lines, predicate="intersects")
    other = (ring != sides.ring[pairs.one[pair]]) & (ring != sides.ring[pairs.other[pair]]) & (pairs.gap[pair] > NO_GAP)
    between = np.zeros(len(middle), bool)
    between[pair[other]] = True
    return between


def _shifted(ring: ArcRing, by: dict[int, float]) -> ArcRing:
    """Return a ring whose sides have moved outwards; corners are where the moved lines, or arcs, meet."""
    n, z = len(ring.z), ring.z
    along = following(z) - z
    corners = np.empty(n, complex)
    for k in range(n):
        before, after = (k - 1) % n, k
        shifts = {side: by.get(side, 0.0) for side in (before, after)}
        if not any(shifts.values()):
            corners[k] = z[k]
            continue
        lines = []
        for side in (before, after):
            if not ring.bulges[side]:
                unit = along[side] / abs(along[side])
                lines.append((z[side] - 1j * unit * shifts[side], unit))
        if len(lines) == 2:
            corners[k] = _crossing(*lines[0], *lines[1], z[k])
        else:  # one is an arc, which stays
            arc = after if ring.bulges[after] else before
            corners[k] = _on_circle(*lines[0], *_circle(ring, arc), z[k])
    bulges = ring.bulges.copy()
    for k in np.flatnonzero(ring.bulges).tolist():
        centre, _ = _circle(ring, k)
        start, end = corners[k] - centre, corners[(k + 1) % n] - centre
        old = 4 * np.arctan(ring.bulges[k])
        turn = float(np.angle(end / start))
        turn += 2 * np.pi * round((old - turn) / (2 * np.pi))
        bulges[k] = np.tan(turn / 4)
    return ArcRing(corners, bulges)


def _crossing(p: complex, u: complex, q: complex, v: complex, near: complex) -> complex:
    """Return where two lines meet; for lines in one direction, the mean of the feet of a corner."""
    across = (u.conjugate() * v).imag
    if abs(across) < LEAST_SINE:
        feet = [a + w * ((near - a) * w.conjugate()).real for a, w in ((p, u), (q, v))]
        return sum(feet) / 2
    return p + u * ((q - p).conjugate() * v).imag / across


def _circle(ring: ArcRing, k: int) -> tuple[complex, float]:
    """Return the centre and radius of an arc."""
    return arc_circle(complex(ring.z[k]), complex(ring.z[(k + 1) % len(ring.z)]), float(ring.bulges[k]))


def _on_circle(p: complex, u: complex, centre: complex, radius: float, near: complex) -> complex:
    """Return where a line meets a circle next to a point; the nearest point of the line if it does not."""
    along = ((centre - p) * u.conjugate()).real
    foot = p + along * u
    half = radius**2 - abs(foot - centre) ** 2
    if half <= 0:
        return foot
    meets = [foot + sign * np.sqrt(half) * u for sign in (1, -1)]
    return complex(min(meets, key=lambda z: abs(z - near)))

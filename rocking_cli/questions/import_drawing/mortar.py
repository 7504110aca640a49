"""Faces of bodies that do not quite meet: sides move to the middle of mortar joints, small gaps and overlaps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, radians
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Points
from rocking_cli.core.polygons import nearby
from rocking_cli.io.drawings.contract import arc_circle
from rocking_cli.questions.import_drawing.loops import edges_of
from rocking_cli.questions.import_drawing.rings import ArcRing, following, polygons_of

PARALLEL = cos(radians(3.0))
LEAST_SHARE = 0.02  # of the length of a side, over which it must face another one
NO_GAP = 1e-9  # gap that needs no mending [m]
SAME_GAP = 1e-6  # difference of gaps up to which they count as equal [m]
JOINT_GAP = 2e-3  # gap across which faces are a joint, over width plus height of the smaller body
IN_GAP = 0.01  # share of a gap from its sides within which nothing is looked for between them
LEAST_SINE = 0.02  # sine between sides below which they count as one line
PAIR = np.dtype([("one", int), ("other", int), ("gap", float), ("start", complex), ("end", complex)])
"""Two sides that face each other, the gap [m], and both ends of the common part on the first."""


def sides_of(rings: Sequence[ArcRing]) -> Any:
    """Return the straight sides of rings, in their order, as an array of `EDGE`."""
    edges = edges_of(rings)
    return edges[(edges["bulge"] == 0) & (np.abs(edges["b"] - edges["a"]) > NO_GAP)]


def normals_of(sides: Any) -> Points:
    """Return the outward normals of sides."""
    along = sides["b"] - sides["a"]
    normals: Points = -1j * along / np.abs(along)
    return normals


def facing(sides: Any, least: float, most: float) -> Any:
    """Return the sides that face a parallel side of another ring across a gap between two bounds [m], as `PAIR`.

    The gap is taken at the middle of their common part; it is negative where rings overlap.
    """
    ends, normal = np.stack([sides["a"], sides["b"]]), normals_of(sides)
    room, opposite = max(-least, most) * (1 + 1j) / 2, [np.zeros(0, PAIR)]
    low, high = (bound(ends.real, axis=0) + 1j * bound(ends.imag, axis=0) for bound in (np.min, np.max))
    for first, second in nearby(low - room, high + room):
        for i, j in ((first, second), (second, first)):
            cosine = (normal[i].conj() * normal[j]).real
            keep = (sides["of"][i] != sides["of"][j]) & (cosine < -PARALLEL)
            i, j, cosine = i[keep], j[keep], cosine[keep]
            origin, length, unit = sides["a"][i], np.abs(ends[1, i] - ends[0, i]), 1j * normal[i]
            along = ((ends[:, j] - origin) * unit.conj()).real  # where both ends of j are along i
            start, end = np.maximum(along.min(axis=0), 0.0), np.minimum(along.max(axis=0), length)
            middle = origin + unit * (start + end) / 2
            gap = ((sides["a"][j] - middle).conj() * normal[j]).real / cosine
            pairs = np.zeros(len(i), PAIR)
            pairs["one"], pairs["other"], pairs["gap"] = i, j, gap
            pairs["start"], pairs["end"] = origin + unit * start, origin + unit * end
            opposite.append(pairs[(end - start > LEAST_SHARE * length) & (gap >= least) & (gap <= most)])
    return np.concatenate(opposite)


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
    sides = sides_of([*rings, *ground])
    pairs = facing(sides, -overlap, most + SAME_GAP if most else 0.0)
    pairs = pairs[~_across_others(sides, pairs, polygons_of([*rings, *ground], overlap))]
    pairs = pairs[(sides["of"][pairs["one"]] < len(rings)) & (np.abs(pairs["gap"]) > NO_GAP)]
    share = np.where(sides["of"][pairs["other"]] >= len(rings), 1.0, 0.5)
    steps: dict[int, list[float]] = {}
    for side, step in zip(pairs["one"].tolist(), (share * pairs["gap"]).tolist(), strict=True):
        steps.setdefault(side, []).append(step)
    by: dict[int, dict[int, float]] = {}
    for side, each in sorted(steps.items()):
        by.setdefault(int(sides["of"][side]), {})[int(sides["start"][side])] = max(each, key=abs)
    closed = [_shifted(ring, by[k]) if k in by else ring for k, ring in enumerate(rings)]
    middles = (sides["a"] + sides["b"]) / 2
    uneven = [side for side, each in sorted(steps.items()) if max(each) - min(each) > SAME_GAP]
    return Closed(closed, np.abs(pairs["gap"]).tolist(), middles[sorted(steps)].tolist(), middles[uneven].tolist())


def _across_others(sides: Any, pairs: Any, polygons: Any) -> NDArray[np.bool_]:
    """Return which pairs of sides have another ring between them."""
    import shapely

    middle, way = (pairs["start"] + pairs["end"]) / 2, normals_of(sides)[pairs["one"]] * pairs["gap"]
    z = np.stack([middle + IN_GAP * way, middle + (1 - IN_GAP) * way], axis=1)
    lines = shapely.linestrings(np.stack([z.real, z.imag], axis=2))
    pair, ring = shapely.STRtree(polygons).query(lines, predicate="intersects")
    of = pairs[pair]
    other = (ring != sides["of"][of["one"]]) & (ring != sides["of"][of["other"]]) & (of["gap"] > NO_GAP)
    return np.isin(np.arange(len(pairs)), pair[other])


def _shifted(ring: ArcRing, by: dict[int, float]) -> ArcRing:
    """Return a ring whose sides have moved outwards; corners are where the moved lines, or arcs, meet."""
    n, z = len(ring.z), ring.z
    along = following(z) - z
    corners = np.empty(n, complex)
    for k in range(n):
        beside = [side for side in ((k - 1) % n, k) if not ring.bulges[side]]
        units = [along[side] / abs(along[side]) for side in beside]
        lines = [(z[k] - 1j * u * by.get(side, 0.0), u) for side, u in zip(beside, units, strict=True)]
        if not any(by.get(side) for side in beside):
            corners[k] = z[k]
        elif len(lines) == 2:
            corners[k] = _crossing(*lines[0], *lines[1], z[k])
        else:  # one is an arc, which stays
            corners[k] = _on_circle(*lines[0], *_circle(ring, k if ring.bulges[k] else (k - 1) % n), z[k])
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

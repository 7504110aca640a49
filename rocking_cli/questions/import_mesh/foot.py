"""The foot of a body: the hull of what is near the ground, its edges, and how the body starts to rock over each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import atan2, cos, degrees, hypot, radians, sqrt

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.questions.import_mesh.solid import Moments

STRAIGHT = 1e-6  # distance of a corner of the foot from the line of its neighbours, over the size, that is none
SINGLE = 2.0**-23  # relative precision of coordinates in single precision
EQUAL_WAYS = 1e-6  # relative difference of the ways to two edges that meet in the corner towards which a body goes
LEVEL_TURN = 1e-9  # sine of a turn that is none
LEVELS = (0.0, 0.001, 0.002, 0.005, 0.010, 0.020)
"""Heights above the ground [m] up to which points count as standing on it, in the table of feet."""


@dataclass(frozen=True)
class FootEdge:
    """An edge of the foot, about which the body rocks.

    Parameters
    ----------
    number : int
        Its number, from 1, anticlockwise.
    start, end : complex
        Its ends in plan, from below the centre of mass [m].
    azimuth : float
        Direction of its outward normal, anticlockwise from the x axis [deg].
    c : float
        Distance from below the centre of mass [m].
    lambda_ : float
        Ground acceleration over g along the normal that starts rocking about it.
    phi_cr : float
        Critical rotation about it [rad].
    inertia : float
        Moment of inertia about the axis through the centre of mass along it, over the mass [m2].
    p : float
        Frequency parameter [rad/s].
    """

    number: int
    start: complex
    end: complex
    azimuth: float
    c: float
    lambda_: float
    phi_cr: float
    inertia: float
    p: float

    @property
    def along(self) -> float:
        """Length [m]."""
        return abs(self.end - self.start)


@dataclass(frozen=True)
class AzimuthRow:
    """How a body starts to rock under a motion in one direction.

    Parameters
    ----------
    azimuth : float
        Direction in which the body goes, anticlockwise from the x axis [deg].
    lambda_ : float
        Ground acceleration over g that starts rocking.
    edge : FootEdge
        The edge about which it rocks.
    drive : float
        Share of the motion that is normal to the edge.
    way, back : float
        Ways from below the centre of mass to the rim of the foot: along the azimuth, and opposite to the normal of the
        edge [m].
    """

    azimuth: float
    lambda_: float
    edge: FootEdge
    drive: float
    way: float
    back: float


@dataclass(frozen=True)
class LevelRow:
    """What a height up to which points count as standing on the ground gives.

    Parameters
    ----------
    level : float
        The height [m].
    corners : int
        Corners of the foot.
    lambda_ : float or None
        Least uplift acceleration over g; None if the body does not stand on such a foot.
    azimuth : float or None
        Direction of the edge of the least [deg].
    """

    level: float
    corners: int
    lambda_: float | None
    azimuth: float | None


def foot_of(points: Reals, level: float) -> Sequence[complex]:
    """Return the corners of the convex hull of all points up to a height, anticlockwise.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        Points of the body above the ground, from below its centre of mass [m].
    level : float
        Height [m].
    """
    size = float(np.abs(points).max())
    low = points[points[:, 2] <= level + SINGLE * size]
    return _convex(np.unique(low[:, 0] + 1j * low[:, 1]).tolist(), STRAIGHT * size)


def _convex(z: Sequence[complex], tolerance: float) -> list[complex]:
    """Return the corners of the convex hull of points sorted by x and y, without those that hardly stand out."""

    def chain(each: Sequence[complex]) -> list[complex]:
        corners: list[complex] = []
        for point in each:
            while len(corners) > 1 and not _turns(corners[-2], corners[-1], point) > 0:
                corners.pop()
            corners.append(point)
        return corners

    corners = list(z) if len(z) < 3 else chain(z)[:-1] + chain(z[::-1])[:-1]
    k = 0
    while len(corners) > 2 and k < len(corners):
        before, after = corners[k - 1], corners[(k + 1) % len(corners)]
        if _turns(before, corners[k], after) <= tolerance * max(abs(after - before), tolerance):
            del corners[k]
            k = max(k - 1, 0)
        else:
            k += 1
    return corners


def _turns(a: complex, b: complex, c: complex) -> float:
    return ((b - a).conjugate() * (c - a)).imag


def edges_of(corners: Sequence[complex], height: float, whole: Moments, gravity: float) -> list[FootEdge]:
    """Return the edges of a foot whose corners are given from below the centre of mass, at a height above it [m]."""
    edges = []
    for number, (start, end) in enumerate(zip(corners, [*corners[1:], *corners[:1]], strict=True), 1):
        along = (end - start) / abs(end - start)
        normal = -1j * along
        c = (normal.conjugate() * (start + end)).real / 2
        u = np.array([along.real, along.imag, 0.0])
        inertia = float(u @ whole.inertia @ u) / whole.volume
        p = sqrt(gravity * hypot(c, height) / (c**2 + height**2 + inertia))
        azimuth = round(degrees(atan2(normal.imag, normal.real)), 9) % 360
        edges.append(FootEdge(number, start, end, azimuth, c, c / height, atan2(c, height), inertia, p))
    return edges


def weakest_of(edges: Sequence[FootEdge]) -> FootEdge:
    """Return the edge with the lowest critical rotation; the first of equal ones."""
    least = min(each.c for each in edges)
    return next(each for each in edges if each.c <= least * (1 + EQUAL_WAYS))


def towards(edges: Sequence[FootEdge], azimuth: float, height: float) -> AzimuthRow:
    """Return how a body starts to rock towards an azimuth [deg]; in a corner of its foot, over the weaker edge."""
    ways = {each.number: _way(each, azimuth) for each in edges}
    least = min(ways.values())
    edge = weakest_of([each for each in edges if ways[each.number] <= least * (1 + EQUAL_WAYS)])
    way = ways[edge.number]
    back = min(_way(each, edge.azimuth + 180) for each in edges)
    return AzimuthRow(azimuth % 360, way / height, edge, edge.c / way, way, back)


def _way(edge: FootEdge, azimuth: float) -> float:
    """Return the way from below the centre of mass to the line of an edge [m]; infinite if it leads away from it."""
    share = cos(radians(azimuth - edge.azimuth))
    return edge.c / share if share > EQUAL_WAYS else np.inf


def levels_of(points: Reals, height: float, whole: Moments, gravity: float) -> list[LevelRow]:
    """Return what each height of `LEVELS` gives for points from below the centre of mass."""
    rows = []
    for level in LEVELS:
        corners = foot_of(points, level)
        edges = edges_of(corners, height, whole, gravity) if len(corners) > 2 else []
        weakest = weakest_of(edges) if edges and min(each.c for each in edges) > 0 else None
        row = (None, None) if weakest is None else (weakest.lambda_, weakest.azimuth)
        rows.append(LevelRow(level, len(corners), *row))
    return rows


def settled(planes: Reals, centroid: Reals) -> tuple[Reals, float]:
    """Return the turn, shape (3, 3), that lays a body down on the facet of its hull below its centre of mass.

    Parameters
    ----------
    planes : ndarray, shape (m, 4)
        The planes of the facets of the convex hull, from `hull_of` [m].
    centroid : ndarray, shape (3,)
        Centre of mass [m].

    Returns
    -------
    ndarray
        The least turn to that facet, or to a further one over which it rolls if it does not lie still on the first.
    float
        Its angle [deg].
    """
    normals = planes[:, :3]
    far = -planes[:, 3] - normals @ centroid
    down, height = np.array([0.0, 0.0, -1.0]), np.inf
    while True:  # the centre of mass comes down with every turn
        with np.errstate(divide="ignore", invalid="ignore"):
            below = int(np.where(normals @ down > 0, far / (normals @ down), np.inf).argmin())
        if far[below] >= height * (1 - LEVEL_TURN):
            break
        down, height = normals[below], far[below]
    x, y, cosine = -down[1], down[0], -down[2]
    sine = hypot(x, y)
    if sine < LEVEL_TURN:
        return np.diag([1.0, np.sign(cosine), np.sign(cosine)]), 0.0 if cosine > 0 else 180.0
    turn = np.array([[0.0, 0.0, y], [0.0, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + turn + (1 - cosine) / sine**2 * turn @ turn, degrees(atan2(sine, cosine))

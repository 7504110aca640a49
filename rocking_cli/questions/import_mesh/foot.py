"""The foot of a body: the hull of what is near the ground, its edges, and how the body starts to rock over each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import atan2, cos, degrees, hypot, radians, sqrt

import numpy as np

from rocking_cli.arrays import Integers, Points, Reals
from rocking_cli.questions.import_mesh.solid import TOUCH, MeshNote, Moments, Triangles, encloses, moments
from rocking_cli.units import STANDARD_GRAVITY

GRAVITY = float(STANDARD_GRAVITY)
STRAIGHT = 1e-6  # distance of a corner of the foot from the line of its neighbours, over the size, that is none
SINGLE = 2.0**-23  # relative precision of coordinates in single precision
EQUAL_WAYS = 1e-6  # relative difference of the ways to two edges that meet in the corner towards which a body goes
INWARDS = 0.99  # of the corners of a foot from its middle, below which what carries it is looked for
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
    import shapely

    size = float(np.abs(points).max())
    low = points[points[:, 2] <= level + SINGLE * size, :2]
    hull = shapely.convex_hull(shapely.multipoints(low))
    plain = shapely.simplify(shapely.orient_polygons(hull), STRAIGHT * size, preserve_topology=False)
    corners: Points = shapely.get_coordinates(hull if plain.is_empty else plain) @ np.array([1, 1j])
    if plain.is_empty:  # all of the foot lies along a line
        corners = corners[[0, np.abs(corners - corners[0]).argmax()]]
    return (corners[:-1] if plain.area else corners).tolist()  # type: ignore[no-any-return]


def edges_of(corners: Sequence[complex], whole: Moments) -> list[FootEdge]:
    """Return the edges of a foot whose corners are given from below the centre of mass of a body [m]."""
    edges, height = list[FootEdge](), float(whole.centroid[2])
    for number, (start, end) in enumerate(zip(corners, [*corners[1:], *corners[:1]], strict=True), 1):
        along = (end - start) / abs(end - start)
        normal = -1j * along
        c = (normal.conjugate() * (start + end)).real / 2
        u = np.array([along.real, along.imag, 0.0])
        inertia = float(u @ whole.inertia @ u) / whole.volume
        p = sqrt(GRAVITY * hypot(c, height) / (c**2 + height**2 + inertia))
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


def levels_of(points: Reals, whole: Moments) -> list[LevelRow]:
    """Return what each height of `LEVELS` gives for points from below the centre of mass."""
    feet = [(level, corners := foot_of(points, level), weakest_on(corners, whole)) for level in LEVELS]
    rows = [(level, len(foot), (edge.lambda_, edge.azimuth) if edge else (None, None)) for level, foot, edge in feet]
    return [LevelRow(level, count, *least) for level, count, least in rows]


def weakest_on(corners: Sequence[complex], whole: Moments) -> FootEdge | None:
    """Return the weakest edge of a foot; None if the body does not stand on it."""
    edges = edges_of(corners, whole) if len(corners) > 2 else []
    return weakest_of(edges) if edges and min(each.c for each in edges) > 0 else None


def glued(points: Reals, triangles: Triangles, part: Integers, level: float) -> list[MeshNote]:
    """Return a note on the parts of a body that rest on others, as the weakest of them would be alone.

    Parameters
    ----------
    points, triangles, part : ndarray
        The body as it stands, from the ground, and the part to which each triangle belongs.
    level : float
        Height up to which points of a part bear, and up to which it touches what is below [m].
    """
    bodies = [triangles[part == each] for each in np.unique(part)]
    within = max(level, TOUCH * float(np.ptp(points, axis=0).max()))
    carries, feet = np.eye(len(bodies), dtype=bool), list[tuple[float, Points]]()
    for k, body in enumerate(bodies):
        corners = points[np.unique(body)]
        base = float(corners[:, 2].min())
        foot = np.array(foot_of(corners - [0, 0, base], within))
        under = [*(INWARDS * foot + (1 - INWARDS) * foot.mean()), foot.mean()]
        probes = np.array([[z.real, z.imag, base - within] for z in under])
        carries[:, k] |= [bool(encloses(points[other], probes).any()) for other in bodies]
        feet.append((base, foot))
    above, alone = np.linalg.matrix_power(carries, len(bodies)), []
    for k in np.flatnonzero(carries.sum(axis=0) > 1).tolist():
        whole = moments(points, np.concatenate([body for body, on in zip(bodies, above[k], strict=True) if on]))
        (base, foot), (x, y, _) = feet[k], whole.centroid
        moved = Moments(whole.volume, whole.centroid - [x, y, base], whole.inertia)
        edge = weakest_on((foot - complex(x, y)).tolist(), moved)
        alone.append((0.0 if edge is None else edge.lambda_, whole.volume, base))
    if not alone:
        return []
    least, volume, base = min(alone)
    rests = "1 part rests on another and counts as glued to it: alone, it"
    if len(alone) > 1:
        rests = f"{len(alone)} parts rest on others and count as glued to them: the weakest alone, with all it carries,"
    would = f"would have lambda = {least:.3g}" if least else "would not stand"
    return [MeshNote("glued", len(alone), f"{rests} {would} ({volume:.3g} m3 from {base:.3g} m above the ground)")]


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
    from scipy.spatial.transform import Rotation

    normals = planes[:, :3]
    far = -planes[:, 3] - normals @ centroid
    down, height = np.array([0.0, 0.0, -1.0]), np.inf
    while True:  # the centre of mass comes down with every turn
        with np.errstate(divide="ignore", invalid="ignore"):
            below = int(np.where(normals @ down > 0, far / (normals @ down), np.inf).argmin())
        if far[below] >= height * (1 - LEVEL_TURN):
            break
        down, height = normals[below], far[below]
    turn, _ = Rotation.align_vectors([0, 0, -1], down)
    return turn.as_matrix(), degrees(turn.magnitude())

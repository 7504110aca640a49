"""The body that a mesh encloses, its moments, and the foot on which it stands."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import atan2, cos, degrees, hypot, radians, sqrt

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Bools, Integers, Points, Reals
from rocking_cli.errors import named
from rocking_cli.io.drawings.contract import DrawingError
from rocking_cli.units import STANDARD_GRAVITY

Triangles = NDArray[np.int64]
CRUMB = 1e-3  # volume of a shell over that of the largest, below which it is left out
MAX_SHELLS = 100  # larger ones
PROBED, PASSES = 10_000, 5_000_000  # triangles of shells that are looked for in others, and times theirs
TOUCH = 1e-5  # depth to which shells that touch may overlap, over the size
NEAR_CORNER = np.array([[1, 1, 1], [2.9, 0.05, 0.05], [0.05, 2.9, 0.05], [0.05, 0.05, 2.9]]) / 3
MAX_HULL_POINTS, MAX_HULL_CORNERS = 1_000_000, 100_000  # which take seconds
LEAST_VOLUME = 1e-9  # volume over the cube of the size, below which there is no inside
ANGLE_DIGITS = 6  # of the angle between triangles that lie on each other [rad]


@dataclass(frozen=True)
class MeshNote:
    """What was done to a mesh, or left out of it.

    Parameters
    ----------
    kind : str
        A word for it.
    count : int
        How many times.
    words : str
        A sentence without a full stop.
    at : sequence of sequence of float
        Where, [x, y, z] [m], in the coordinates of the file.
    """

    kind: str
    count: int
    words: str
    at: Sequence[Sequence[float]] = ()


@dataclass(frozen=True, eq=False)
class Moments:
    """Volume [m3], its centroid [m], and its inertia about this point over the density [m5], shape (3, 3)."""

    volume: float
    centroid: Reals
    inertia: Reals


def merged(points: Reals, triangles: Triangles) -> tuple[Reals, Triangles, int]:
    """Return corners that lie apart, the triangles with an area that join them, and how many were repeated."""
    from trimesh import Trimesh
    from trimesh.grouping import unique_rows

    mesh = Trimesh(points, triangles, process=False)
    mesh.merge_vertices(merge_tex=True, merge_norm=True)
    a, b, c = mesh.faces.T
    triangles = np.asarray(mesh.faces)[(a != b) & (b != c) & (c != a)]
    kept = np.sort(unique_rows(turned_to_least(triangles))[0])
    return np.asarray(mesh.vertices), triangles[kept], len(triangles) - len(kept)


def turned_to_least(triangles: Triangles) -> Triangles:
    """Return triangles that start with their least corner, in the same sense."""
    least = triangles.argmin(axis=1)[:, None]
    return np.take_along_axis(triangles, (least + np.arange(3)) % 3, axis=1)


def sides_of(triangles: Triangles) -> tuple[Triangles, Integers, Bools]:
    """Return the sides of triangles, three each, from the lesser to the greater corner.

    With them comes a number of each side, equal for those with the same ends, and whether it is passed that way.
    """
    from trimesh.grouping import unique_rows

    sides = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    ends = np.sort(sides, axis=1)
    return ends, unique_rows(ends)[1], sides[:, 0] < sides[:, 1]


def shells_of(points: Reals, triangles: Triangles) -> Integers:
    """Return for each triangle of a closed surface that faces outwards the number of its shell, from 0.

    Where more than two triangles meet in a side, those with matter between them belong together.
    """
    from trimesh.graph import connected_component_labels

    ends, name, forward = sides_of(triangles)
    angle, many = np.zeros(len(ends)), np.bincount(name)[name] > 2
    start = points[ends[many, 0]]
    along = points[ends[many, 1]] - start
    x = np.cross(along, np.eye(3)[np.abs(along).argmin(axis=1)])
    y = np.cross(along, x) / np.linalg.norm(along, axis=1)[:, None]
    away = points[triangles[:, [2, 0, 1]].ravel()[many]] - start
    turn = np.arctan2((away * y).sum(axis=1), (away * x).sum(axis=1))
    angle[many] = np.round(np.mod(turn + 1, 2 * np.pi), ANGLE_DIGITS)
    order = np.lexsort((~forward, angle, name))  # matter begins at a side that is passed backwards
    first = np.flatnonzero(np.diff(name[order], prepend=-1))
    following = np.roll(order, -1)
    following[np.append(first[1:], len(order)) - 1] = order[first]
    links = np.stack([order, following], axis=1)[~forward[order]] // 3
    shells: Integers = connected_component_labels(links, len(triangles))
    return shells


def moments(points: Reals, triangles: Triangles) -> Moments:
    """Return the moments of the volume that a closed surface encloses."""
    from trimesh.triangles import mass_properties

    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    mass = mass_properties((points - middle)[triangles])
    return Moments(float(mass.volume), mass.center_mass + middle, np.asarray(mass.inertia))


def closed(points: Reals, triangles: Triangles, file: str) -> None:
    """Raise `DrawingError` if not every side of the triangles is passed as often there as back."""
    from trimesh.graph import connected_component_labels

    ends, name, forward = sides_of(triangles)
    loose = np.bincount(name, np.where(forward, 1.0, -1.0)) != 0
    if not loose.any():
        return
    first, count = np.unique(name, return_index=True)[1][loose], int(loose.sum())
    ends = ends[first]
    at = [points[ends[0, 0]].tolist()]
    if (np.bincount(name)[loose] % 2 == 0).all():  # passed twice in one sense
        what = f"its surface is closed, but {count:,} edges join triangles that face opposite ways"
        raise DrawingError(
            "open", what, file, at, f"orient its faces outwards, or give {named('hull')} for the convex hull"
        )
    labels = connected_component_labels(ends, len(points))[ends[:, 0]]
    holes = [np.ptp(points[ends[labels == each]].reshape(-1, 3), axis=0) for each in np.unique(labels)[:MAX_SHELLS]]
    _, wide, long = np.sort(max(holes, key=np.linalg.norm))
    what = f"its surface is not closed: {count:,} loose sides, the largest hole {long:.3g} x {wide:.3g} m"
    raise DrawingError(
        "open", what, file, at, f"close its holes, or give {named('hull')} for the convex hull, which is heavier"
    )


def hull_of(points: Reals, file: str) -> tuple[Reals, Triangles, Reals]:
    """Return the convex hull of points: corners, triangles that face outwards, and the plane of each triangle.

    A plane is a row [n, d], n . x + d = 0, n outwards. The points are joggled by 1e-11 of their size, as the time for
    faces of many corners grows with the square of their number otherwise. Raises `DrawingError`.
    """
    from scipy.spatial import ConvexHull, QhullError

    what = f"has more than {MAX_HULL_POINTS:,} points, or {MAX_HULL_CORNERS:,} corners of its convex hull"
    if len(points) > MAX_HULL_POINTS:
        raise DrawingError("too_large", what, file, hint="leave out points")
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    try:
        hull = ConvexHull(points - middle, qhull_options=f"QJ TA{MAX_HULL_CORNERS}")
    except (QhullError, ValueError):
        raise DrawingError("thin", "encloses nothing: all its points lie in one plane", file) from None
    if len(hull.vertices) >= MAX_HULL_CORNERS:
        raise DrawingError("too_large", what, file, hint="leave out points")
    triangles, planes = hull.simplices.astype(np.int64), hull.equations
    a, b, c = (hull.points[triangles[:, k]] for k in range(3))
    inwards = np.einsum("ij,ij->i", np.cross(b - a, c - a), planes[:, :3]) < 0
    triangles[inwards] = triangles[inwards, ::-1]
    planes[:, 3] -= planes[:, :3] @ middle
    return points, triangles, planes


def solid(points: Reals, triangles: Triangles, file: str) -> tuple[Triangles, Integers, list[MeshNote]]:
    """Return the triangles of one body: outer surfaces face outwards, cavities inwards, and crumbs are left out.

    With them come the numbers of the parts of the body that they belong to. Raises `DrawingError` if they enclose
    nothing, or have too many shells, or two that cross.
    """
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    a, b, c = np.moveaxis((points - middle)[triangles], 1, 0)
    pieces = (a * np.cross(b, c)).sum(axis=1) / 6
    if not abs(pieces.sum()) > LEAST_VOLUME * float(np.ptp(points, axis=0).max()) ** 3:
        raise DrawingError("thin", "encloses nothing: its surface has no inside", file)
    if inside_out := bool(pieces.sum() < 0):
        triangles, pieces = triangles[:, ::-1], -pieces
    shell = shells_of(points, triangles)
    volumes = np.bincount(shell, pieces).astype(float)
    size = float(np.abs(volumes).max())
    notes = list[MeshNote]()

    def note(kind: str, which: Bools, one: str, many: str) -> None:
        count = int(which.sum())
        if count:
            at = [points[triangles[(shell == k).argmax(), 0]].tolist() for k in np.flatnonzero(which)[:MAX_SHELLS]]
            words = f"{one if count == 1 else many.format(count)}, {np.abs(volumes[which]).sum():.3g} m3"
            notes.append(MeshNote(kind, count, words, at))

    counts = np.abs(volumes) >= CRUMB * size
    if counts.sum() > MAX_SHELLS:
        raise DrawingError("shells", f"has {counts.sum():,} closed surfaces", file, hint="keep those of one body")
    lies_in = _nested(points, triangles, shell, volumes, counts, file)
    if (lies_in[counts] & lies_in[counts].T).any():
        raise DrawingError("shells", "two of its surfaces lie on each other", file, hint="leave one of them out")
    within = lies_in.sum(axis=1) % 2 == 1
    turned = counts & ~within & (volumes < 0)
    note("crumbs", ~counts, "1 crumb is left out", "{} crumbs are left out")
    note("cavities", counts & within & (volumes < 0), "1 cavity is cut out", "{} cavities are cut out")
    swallowed = counts & within & (volumes > 0)
    note("within", swallowed, "1 part inside the body is left out: its faces point outwards, unlike those of a cavity",
         "{} parts inside the body are left out: their faces point outwards, unlike those of cavities")  # fmt: skip
    others = counts & ~within & (np.arange(len(volumes)) != np.abs(volumes).argmax())
    note("parts", others, "1 separate part counts as part of the body",
         "{} separate parts count as parts of the body")  # fmt: skip
    note("turned", turned | inside_out & counts, "1 surface is turned outwards", "{} surfaces are turned outwards")
    triangles = np.where(turned[shell, None], triangles[:, ::-1], triangles)
    holder = np.where(lies_in, np.abs(volumes[counts]), np.inf).argmin(axis=1)  # of a cavity
    part = np.where(within, np.flatnonzero(counts)[holder], np.arange(len(volumes)))
    kept = (counts & ~swallowed)[shell]
    return triangles[kept], part[shell][kept], notes


def _nested(points: Reals, triangles: Triangles, shell: Integers, volumes: Reals, counts: Bools, file: str) -> Bools:
    """Return which shells lie in which of those that count, by points just within their surface.

    Raises `DrawingError` if only some of these points lie in another shell.
    """
    which = np.flatnonzero(counts)
    nested = np.zeros((len(volumes), len(which)), bool)
    corners = {k: points[triangles[shell == k]] for k in which.tolist()}
    touch = TOUCH * float(np.ptp(points, axis=0).max())
    share = max(min(PROBED, PASSES // len(triangles)) // len(which), 1)
    for k, mine in corners.items():
        some = mine[np.linspace(0, len(mine) - 1, min(share, len(mine))).astype(np.intp)]
        normals = np.cross(some[:, 1] - some[:, 0], some[:, 2] - some[:, 0])
        lengths = np.linalg.norm(normals, axis=1)
        plain = lengths > touch * np.ptp(some, axis=1).max(axis=1)  # the normal of a sliver leads anywhere
        inwards = -np.sign(volumes[k]) * touch * normals[plain] / lengths[plain, None]
        probes = (NEAR_CORNER @ some[plain] + inwards[:, None]).reshape(-1, 3)
        for j in np.flatnonzero(which != k).tolist():
            within = encloses(corners[which[j]], probes)
            if within.any() and not within.all():
                at = probes[within.argmax()].tolist()
                place = ", ".join(f"{x:.4g}" for x in at)
                what = f"two of its surfaces cross: one is partly inside the other, at ({place}) m"
                advice = (
                    f"join them in the program that made them, or give {named('hull')} for the convex hull, "
                    "which is heavier"
                )
                raise DrawingError("shells", what, file, [at], advice)
            nested[k, j] = within.any()
    return nested


def encloses(corners: Reals, probes: Reals) -> Bools:
    """Return which of some points lie within the closed surface of triangles, shape (m, 3, 3), by its solid angle."""
    inside = ((corners.min(axis=(0, 1)) <= probes) & (probes <= corners.max(axis=(0, 1)))).all(axis=1)
    for k in np.flatnonzero(inside):
        a, b, c = np.moveaxis(corners - probes[k], 1, 0)
        p, q, r = (np.linalg.norm(each, axis=1) for each in (a, b, c))
        cosine = p * q * r + (a * b).sum(axis=1) * r + (b * c).sum(axis=1) * p + (c * a).sum(axis=1) * q
        inside[k] = abs(np.arctan2((a * np.cross(b, c)).sum(axis=1), cosine).sum()) > np.pi
    return np.asarray(inside)


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

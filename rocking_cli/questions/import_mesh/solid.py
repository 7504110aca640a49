"""The body that a mesh encloses: its corners merged, its shells sorted, its volume, centre of mass and inertia."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Bools, Reals
from rocking_cli.io.drawings.contract import DrawingError

Triangles = NDArray[np.int64]
Names = NDArray[np.intp]
CRUMB = 1e-3  # volume of a shell over that of the largest, below which it is left out
MAX_SHELLS = 100  # larger ones
PROBED, PASSES = 10_000, 25_000_000  # triangles of shells that are looked for in others, and times theirs
TOUCH = 1e-5  # depth to which shells that touch may overlap, over the size
NEAR_CORNER = np.array([[1, 1, 1], [2.9, 0.05, 0.05], [0.05, 2.9, 0.05], [0.05, 0.05, 2.9]]) / 3
MAX_HULL_POINTS, MAX_HULL_CORNERS = 1_000_000, 100_000  # which take seconds
PER_BATCH = 1 << 18  # triangles whose integrals are summed at once
LEAST_VOLUME = 1e-9  # volume over the cube of the size, below which there is no inside
MIX, HALF = np.uint64(0x9E3779B97F4A7C15), np.uint64(32)  # of the keys by which equal points are found


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


def merged(points: Reals, triangles: Triangles) -> tuple[Reals, Triangles]:
    """Return corners without those at one place, and triangles that name these; triangles without area are dropped."""
    points = np.ascontiguousarray(points + 0.0)  # turns -0 into 0
    key = np.zeros(len(points), np.uint64)
    for bits in points.view(np.uint64).T:  # of numbers in single precision, the lower half is zero
        key = (key ^ (bits >> HALF) ^ bits) * MIX
        key ^= key >> HALF
    order = key.argsort()
    new = np.append(True, np.diff(key[order]) != 0)
    names, first = np.empty(len(key), np.intp), np.minimum.reduceat(order, np.flatnonzero(new))
    names[order] = np.cumsum(new) - 1
    # In the order of the file, neighbours are near in memory, so that all that follows takes half the time.
    kept = np.argsort(first)
    first, names = first[kept], np.argsort(kept)[names]
    if (points[first][names] != points).any():  # two places have one key
        _, first, names = np.unique(points, axis=0, return_index=True, return_inverse=True)
    triangles = names.ravel()[triangles]
    a, b, c = triangles.T
    return points[first], triangles[(a != b) & (b != c) & (c != a)]


def turned_to_least(triangles: Triangles) -> Triangles:
    """Return triangles that start with their least corner, in the same sense."""
    least = triangles.argmin(axis=1)[:, None]
    return np.take_along_axis(triangles, (least + np.arange(3)) % 3, axis=1)


def once(triangles: Triangles, count: int) -> Triangles:
    """Return triangles without those that repeat one in the same sense; `count` is the number of corners."""
    a, b, c = turned_to_least(triangles).T
    sides = a * count + b
    order = np.lexsort((c, sides))
    again = (np.diff(sides[order]) == 0) & (np.diff(c[order]) == 0)
    return np.delete(triangles, order[1:][again], axis=0)


def loose_sides(triangles: Triangles, count: int) -> tuple[Triangles, int]:
    """Return the sides of triangles that are not passed as often there as back, and how many of them lie in pairs.

    Parameters
    ----------
    triangles : ndarray of int, shape (m, 3)
        Corners of the triangles, below `count`.
    count : int
        Number of corners.

    Returns
    -------
    ndarray of int, shape (k, 2)
        The sides, in the sense in which they are passed once too often.
    int
        How many of these are passed twice in one sense: there, a triangle is turned over.
    """
    start, end = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    there, back = (
        np.sort(np.minimum(start, end)[way] * count + np.maximum(start, end)[way]) for way in (start < end, start > end)
    )
    if np.array_equal(there, back):
        return np.zeros((0, 2), np.int64), 0
    sides, names = np.unique(np.concatenate([there, back]), return_inverse=True)
    of_each = np.bincount(names, np.repeat([1.0, -1.0], [there.size, back.size])).astype(np.int64)
    passes = np.bincount(names)[of_each != 0]
    ends = np.stack(np.divmod(sides, count), axis=1)[of_each != 0]
    ends = np.where(of_each[of_each != 0, None] > 0, ends, ends[:, ::-1])
    return ends, int((passes % 2 == 0).sum())


def joined(sides: Triangles, count: int) -> NDArray[np.int32]:
    """Return a number for each of `count` corners: the same for those that sides, or triangles, join."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    pairs = np.concatenate([sides[:, [k, k + 1]] for k in range(sides.shape[1] - 1)])
    graph = coo_array((np.ones(len(pairs), np.int8), (pairs[:, 0], pairs[:, 1])), (count, count))
    labels: NDArray[np.int32] = connected_components(graph, directed=False)[1]
    return labels


def six_volumes(points: Reals, triangles: Triangles) -> Reals:
    """Return six times the signed volume between each triangle and the origin [m3]."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.asarray(np.einsum("ij,ij->i", a, np.cross(b, c)))


def moments(points: Reals, triangles: Triangles) -> Moments:
    """Return the moments of the volume that a closed surface encloses."""
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    points = points - middle
    volume, first, second = 0.0, np.zeros(3), np.zeros((3, 3))
    for k in range(0, len(triangles), PER_BATCH):
        some = triangles[k : k + PER_BATCH]
        six = six_volumes(points, some)
        corners = [points[some[:, j]] for j in range(3)]
        total = corners[0] + corners[1] + corners[2]
        volume += six.sum() / 6
        first += six @ total / 24
        for each in (*corners, total):
            second += (each * six[:, None]).T @ each / 120
    centroid = first / volume
    second -= volume * np.outer(centroid, centroid)
    return Moments(float(volume), centroid + middle, np.trace(second) * np.eye(3) - second)


def closed(points: Reals, triangles: Triangles, file: str) -> None:
    """Raise `DrawingError` if a surface has holes."""
    ends, turned = loose_sides(triangles, len(points))
    if not len(ends):
        return
    at = [points[ends[0, 0]].tolist()]
    if turned == len(ends):
        what = f"its surface is closed, but {turned:,} edges join triangles that face opposite ways"
        raise DrawingError("open", what, file, at, "orient its faces outwards, or give `hull` for the convex hull")
    labels = joined(ends, len(points))[ends[:, 0]]
    holes = [np.ptp(points[ends[labels == each]].reshape(-1, 3), axis=0) for each in np.unique(labels)[:MAX_SHELLS]]
    _, wide, long = np.sort(max(holes, key=np.linalg.norm))
    what = f"its surface is not closed: {len(ends):,} loose sides, the largest hole {long:.3g} x {wide:.3g} m"
    raise DrawingError("open", what, file, at, "close its holes, or give `hull` for the convex hull, which is heavier")


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


def solid(points: Reals, triangles: Triangles, file: str) -> tuple[Triangles, list[MeshNote]]:
    """Return the triangles of one body: outer surfaces face outwards, cavities inwards, and crumbs are left out.

    Raises `DrawingError` if they enclose nothing, or have too many shells, or two that cross.
    """
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    points = points - middle
    shell = joined(triangles, len(points))[triangles[:, 0]].astype(np.intp)
    shell = np.unique(shell, return_inverse=True)[1]
    volumes = np.bincount(shell, six_volumes(points, triangles)) / 6
    size = float(np.abs(volumes).max())
    if not size > LEAST_VOLUME * float(np.ptp(points, axis=0).max()) ** 3:
        raise DrawingError("thin", "encloses nothing: its surface has no inside", file)
    notes = list[MeshNote]()

    def note(kind: str, which: Bools, one: str, many: str) -> None:
        count = int(which.sum())
        if count:
            at = [
                (points[triangles[(shell == k).argmax(), 0]] + middle).tolist()
                for k in np.flatnonzero(which)[:MAX_SHELLS]
            ]
            words = f"{one if count == 1 else many.format(count)}, {np.abs(volumes[which]).sum():.3g} m3"
            notes.append(MeshNote(kind, count, words, at))

    if inside_out := bool(volumes[np.abs(volumes).argmax()] < 0):
        triangles, volumes = triangles[:, ::-1], -volumes
    counts = np.abs(volumes) >= CRUMB * size
    if counts.sum() > MAX_SHELLS:
        raise DrawingError("shells", f"has {counts.sum():,} closed surfaces", file, hint="keep those of one body")
    within = _depths(points, triangles, shell, volumes, counts, middle, file) % 2 == 1
    turned = counts & ~within & (volumes < 0)
    note("crumbs", ~counts, "1 crumb is left out", "{} crumbs are left out")
    note("cavities", counts & within & (volumes < 0), "1 cavity is cut out", "{} cavities are cut out")
    swallowed = counts & within & (volumes > 0)
    note("within", swallowed, "1 part inside the body is left out: its faces point outwards, unlike those of a cavity",
         "{} parts inside the body are left out: their faces point outwards, unlike those of cavities")  # fmt: skip
    note("parts", counts & ~within & (np.abs(volumes) < size), "1 separate part counts as part of the body",
         "{} separate parts count as parts of the body")  # fmt: skip
    note("turned", turned | inside_out & counts, "1 surface is turned outwards", "{} surfaces are turned outwards")
    triangles = np.where(turned[shell, None], triangles[:, ::-1], triangles)
    return triangles[(counts & ~swallowed)[shell]], notes


def _depths(
    points: Reals, triangles: Triangles, shell: Names, volumes: Reals, counts: Bools, middle: Reals, file: str
) -> Names:  # fmt: skip
    """Return in how many of some shells each of them lies, by rays upwards from points just within its surface.

    Raises `DrawingError` if only some of these points lie in another shell.
    """
    depths, which = np.zeros(len(volumes), np.intp), np.flatnonzero(counts)
    if len(which) == 1:
        return depths
    corners = points[triangles]
    low, high, of_which = corners.min(axis=1), corners.max(axis=1), counts[shell]
    touch = TOUCH * float(np.ptp(points, axis=0).max())
    for k in which:
        mine = np.flatnonzero(shell == k)
        beside = of_which & (shell != k) & (low[:, :2] <= high[mine, :2].max(axis=0)).all(axis=1)
        beside &= (high >= low[mine].min(axis=0)).all(axis=1)
        count = max(min(PROBED, PASSES // max(int(beside.sum()), 1)) // len(which), 1)
        some = corners[mine[np.linspace(0, len(mine) - 1, min(count, len(mine))).astype(np.intp)]]
        normals = np.cross(some[:, 1] - some[:, 0], some[:, 2] - some[:, 0])
        lengths = np.linalg.norm(normals, axis=1)
        plain = lengths > touch * np.ptp(some, axis=1).max(axis=1)  # the normal of a sliver leads anywhere
        if not beside.any() or not plain.any():
            continue
        inwards = -np.sign(volumes[k]) * touch * normals[plain] / lengths[plain, None]
        probes = (NEAR_CORNER @ some[plain] + inwards[:, None]).reshape(-1, 3)
        within = np.zeros((len(probes), len(volumes)), bool)
        floor, roof, others, surface = low[beside, :2], high[beside], corners[beside], shell[beside]
        for each, p in zip(within, probes, strict=True):
            over = np.flatnonzero((floor <= p[:2]).all(axis=1) & (roof >= p).all(axis=1))
            each[:] = np.bincount(surface[over], _crossings(others[over], p), minlength=len(volumes)) != 0
        crossed = within.any(axis=0) & ~within.all(axis=0)
        if crossed.any():
            at = probes[within[:, crossed.argmax()].argmax()] + middle
            what = (
                f"two of its surfaces cross: one is partly inside the other, at ({', '.join(f'{x:.4g}' for x in at)}) m"
            )
            advice = "join the two in the program that made them, or give `hull` for the convex hull, which is heavier"
            raise DrawingError("shells", what, file, [at.tolist()], advice)
        depths[k] = within[0].sum()
    return depths


def _crossings(corners: Reals, p: Reals) -> Reals:
    """Return for each triangle whether a ray upwards from a point crosses it: 1 on the way out, -1 on the way in."""
    ends = np.roll(corners, -1, axis=1)
    swap = (corners[..., 1] > ends[..., 1])[..., None]
    a, b = np.where(swap, ends, corners), np.where(swap, corners, ends)  # a side crosses alike in both its triangles
    spans = (a[..., 1] > p[1]) != (b[..., 1] > p[1])
    with np.errstate(divide="ignore", invalid="ignore"):
        share = (p[1] - a[..., 1]) / (b[..., 1] - a[..., 1])
        right = spans & (a[..., 0] + share * (b[..., 0] - a[..., 0]) > p[0])
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        z = corners[:, 0, 2] - ((p - corners[:, 0])[:, :2] * normal[:, :2]).sum(axis=1) / normal[:, 2]
    return np.asarray(np.where((right.sum(axis=1) % 2 == 1) & (z > p[2]), np.sign(normal[:, 2]), 0.0))

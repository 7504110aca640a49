"""Polygons of the plane: whether they are simple, touch, overlap or contain one another; their convex pieces.

Corners are complex numbers x + iy [m], in order around the polygon, the last joined to the first.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cache
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Bools, Points, Reals
from rocking_cli.core.kinematics import area_of, distance, following, inside, squared

POINT_DISTANCE = 1e-9  # distance below which points coincide, over the size of the polygon
BOXES_PER_BATCH = 256
Indices = NDArray[np.intp]


def size_of(z: Points) -> float:
    """Return the sum of width and height of a polygon [m]."""
    return float(np.ptp(z.real) + np.ptp(z.imag))


def thickness_of(z: Points) -> float:
    """Return the least extent of a polygon perpendicular to one of its sides [m]."""
    side = following(z) - z
    across = (z[None, :] * (1j * side / np.abs(side))[:, None].conj()).real
    return float(np.ptp(across, axis=1).min())


def fault_of(z: Points) -> str | None:
    """Return why corners do not form a simple polygon, a sentence without a full stop; None if they do."""
    size = size_of(z)
    if any_alike(z, POINT_DISTANCE * size):
        return "two corners are the same point; the last need not repeat the first"
    if abs(area_of(z)) <= POINT_DISTANCE * size**2 or any_meet(z):
        return "its sides cross or enclose nothing: list the corners in order around the outline"
    return None


def overlap(one: Points, other: Points, tolerance: float) -> bool:
    """Return whether two polygons have more in common than sides and corners, to a tolerance [m].

    If they have, the middle of a piece of a side, or a point inside of one, lies deeper in the other.
    """
    if not _boxes_meet(one, other, -tolerance) or _beside(one, other, tolerance):
        return False
    for first, second in ((one, other), (other, one)):
        middles = np.append(_middles(first, second), _within(first))
        if (inside(middles, second) & (distance(middles, second) > tolerance)).any():
            return True
    return False


def lies_within(inner: Points, outer: Points, tolerance: float) -> bool:
    """Return whether a polygon lies within another, to a tolerance [m]; they may share sides."""
    points = np.append(_middles(inner, outer), inner)
    return bool((inside(points, outer) | (distance(points, outer) <= tolerance)).all())


def gap(one: Points, other: Points) -> float:
    """Return the distance of two polygons that do not overlap [m]."""
    return float(min(distance(one, other).min(), distance(other, one).min()))


def pierced(outline: Points, holes: Sequence[Points]) -> Points:
    """Return an outline with holes as one closed line, which goes to each hole and back on the same path."""
    outline = outline if area_of(outline) > 0 else outline[::-1]
    remaining = [hole if area_of(hole) < 0 else hole[::-1] for hole in holes]
    while remaining:
        # Start with the nearest hole, as the path to it crosses no other hole.
        nearest = min(range(len(remaining)), key=lambda k: gap(outline, remaining[k]))
        outline = _joined(outline, remaining.pop(nearest))
    return outline


def _joined(outline: Points, hole: Points) -> Points:
    """Return two closed lines as one, joined where they are nearest."""
    if distance(outline, hole).min() < distance(hole, outline).min():
        k, other, at = _nearest(outline, hole)
        return np.concatenate([outline[: k + 1], [at], np.roll(hole, -other - 1), [at], outline[k:]])
    k, other, at = _nearest(hole, outline)
    there = np.append(np.roll(hole, -k), hole[k])
    return np.concatenate([outline[: other + 1], [at], there, [at], outline[other + 1 :]])


def _nearest(corners: Points, z: Points) -> tuple[int, int, complex]:
    """Return the corner nearest to a polygon, the side nearest to this corner, and the point on this side."""
    k = int(distance(corners, z).argmin())
    side = following(z) - z
    along = np.clip(((corners[k] - z) * side.conj()).real / squared(side), 0.0, 1.0)
    on = z + along * side
    nearest_side = int(np.abs(corners[k] - on).argmin())
    return k, nearest_side, complex(on[nearest_side])


def _boxes_meet(one: Points, other: Points, margin: float) -> bool:
    return all(
        getattr(a, part).min() <= getattr(b, part).max() + margin
        for a, b in ((one, other), (other, one))
        for part in ("real", "imag")
    )


def _beside(one: Points, other: Points, tolerance: float) -> bool:
    """Return whether a line along a side of either polygon separates the two, to a tolerance."""
    for first, second in ((one, other), (other, one)):
        side = np.roll(first, -1) - first
        across = (1j * side / np.where(side == 0, 1.0, np.abs(side)))[:, None].conj()
        ours, theirs = (across * first).real, (across * second).real
        apart = np.maximum(theirs.min(axis=1) - ours.max(axis=1), ours.min(axis=1) - theirs.max(axis=1))
        if (apart >= -tolerance).any():
            return True
    return False


def _middles(z: Points, other: Points) -> Points:
    """Return the midpoints of the pieces into which another polygon cuts the sides of a polygon."""
    middles = []
    far = following(other) - other
    for start, end in zip(z, following(z), strict=True):
        side, away = end - start, other - start
        area = (side.conjugate() * far).imag
        with np.errstate(divide="ignore", invalid="ignore"):
            cuts = (away.conj() * far).imag / area
        corners = (away * side.conjugate()).real / abs(side) ** 2
        places = np.concatenate([cuts[area != 0], corners, [0.0, 1.0]])
        places = np.unique(places[(places >= 0) & (places <= 1)])
        middles.append(start + side * (places[:-1] + places[1:]) / 2)
    return np.concatenate(middles)


def _within(z: Points) -> complex:
    """Return a point inside a polygon: the midpoint of its longest chord on a horizontal line between two corners."""
    heights = np.unique(z.imag)
    k = int(np.diff(heights).argmax())
    y, w = (heights[k] + heights[k + 1]) / 2, following(z)
    spans = (z.imag > y) != (w.imag > y)
    z, w = z[spans], w[spans]
    x = np.sort(z.real + (y - z.imag) / (w - z).imag * (w - z).real)
    long = int((x[1::2] - x[::2]).argmax())
    return complex((x[2 * long] + x[2 * long + 1]) / 2, y)


def nearby(low: Points, high: Points) -> Iterator[tuple[Indices, Indices]]:
    """Yield pairs of boxes that overlap or touch, from their lower left and upper right corners, in batches.

    The boxes are swept along the axis on which fewer of them overlap.
    """
    axes = []
    for a, b in ((low.real, high.real), (low.imag, high.imag)):
        order = np.argsort(a, kind="stable")
        # For each box, the boxes that begin after its start and before its end.
        axes.append((order, np.searchsorted(a[order], b[order], side="right")))
    order, until = min(axes, key=lambda way: int(way[1].sum()))
    low, high = low[order], high[order]
    for first in range(0, len(order), BOXES_PER_BATCH):
        last = min(first + BOXES_PER_BATCH, len(order))
        count = np.maximum(until[first:last] - np.arange(first + 1, last + 1), 0)
        one = np.repeat(np.arange(first, last), count)
        other = one + 1 + np.arange(len(one)) - np.repeat(np.cumsum(count) - count, count)
        meet = (low.real[other] <= high.real[one]) & (low.real[one] <= high.real[other])
        meet &= (low.imag[other] <= high.imag[one]) & (low.imag[one] <= high.imag[other])
        if meet.any():
            yield order[one[meet]], order[other[meet]]


def any_alike(z: Points, tolerance: float) -> bool:
    """Return whether any two points are within a tolerance of each other."""
    around = tolerance * (1 + 1j)
    return any((np.abs(z[i] - z[j]) <= tolerance).any() for i, j in nearby(z, z + around))


def any_meet(z: Points) -> bool:
    """Return whether two sides of a polygon cross or touch, other than neighbours at their common corner."""
    w = following(z)
    low = np.minimum(z.real, w.real) + 1j * np.minimum(z.imag, w.imag)
    high = np.maximum(z.real, w.real) + 1j * np.maximum(z.imag, w.imag)
    for i, j in nearby(low, high):
        apart = (z[i] != z[j]) & (z[i] != w[j]) & (w[i] != z[j]) & (w[i] != w[j])
        if _meet(z[i][apart], w[i][apart], z[j][apart], w[j][apart]).any():
            return True
    return False


def _meet(a: Points, b: Points, c: Points, d: Points) -> Bools:
    """Return whether sides ab and cd, which share no corner, cross or touch."""

    def side(p: Points, q: Points, r: Points) -> Reals:
        u, v = q - p, r - p
        turns: Reals = np.sign(u.real * v.imag - u.imag * v.real)
        return turns

    def within(p: Points, q: Points, r: Points, where: Reals) -> Bools:
        u, v = r - p, r - q
        return np.asarray((where == 0) & (u.real * v.real + u.imag * v.imag <= 0))

    of_c, of_d, of_a, of_b = side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b)
    touch = within(a, b, c, of_c) | within(a, b, d, of_d) | within(c, d, a, of_a) | within(c, d, b, of_b)
    crosses: Bools = (of_c != of_d) & (of_a != of_b)
    return crosses | touch


SHALLOW_SHARE = 0.1  # a hollow that is no deeper than this share of the polygon's size may be filled
TOUCHING_SHARE = 1e-3  # distance from its sides up to which a point touches it, as a share of its size
ZERO_TURN = 1e-12  # turn of a side, over the product of the lengths of both, that counts as straight


def convex_pieces(corners: Sequence[complex] | Points, others: Sequence[Points] | None = None) -> list[Points]:
    """Return convex polygons that together are a simple polygon.

    Parameters
    ----------
    corners : sequence of complex
        Corners of the polygon in either order [m].
    others : sequence of ndarray of complex, optional
        Polygons beside it: if they are given, a shallow hollow into which none of them reaches is filled, as under the
        soffit of a voussoir: fewer pieces, the same contacts.

    Returns
    -------
    list of ndarray of complex
        Corners of each piece, anticlockwise.
    """
    z = np.asarray(corners, np.complex128)
    z = z[np.abs(z - np.roll(z, 1)) > 0]
    z = z if area_of(z) > 0 else z[::-1]
    if all(_turn(z[k - 2], z[k - 1], z[k]) >= 0 for k in range(len(z))):
        return [z]
    if others is not None and (whole := _filled(z, others)) is not None:
        return [whole]
    return _merged(_triangles(z), z)


def _filled(z: Points, others: Sequence[Points]) -> Points | None:
    """Return the convex hull of a polygon if its hollows are shallow and nothing reaches into them, or None."""
    hull = hull_of(z)
    size = float(np.abs(z - z.mean()).max())
    if distance(z, hull).max() > SHALLOW_SHARE * size:
        return None
    beside = np.concatenate([*others, z[:0]])
    beside = beside[inside(beside, hull)]
    reaching = beside[~inside(beside, z) | (distance(beside, z) < TOUCHING_SHARE * size)]
    return hull if (distance(reaching, hull) <= TOUCHING_SHARE * size).all() else None


def hull_of(z: Points) -> Points:
    """Return the convex hull of some points, anticlockwise."""
    hull: list[complex] = []
    there = sorted(z.tolist(), key=lambda at: (at.real, at.imag))
    for side in (there, there[::-1]):
        start = len(hull)
        for at in side:
            while len(hull) > start + 1 and _turn(hull[-2], hull[-1], at) <= 0:
                hull.pop()
            hull.append(at)
        hull.pop()
    return np.array(hull)


def _turn(a: complex, b: complex, c: complex) -> float:
    """Return the turn from the side ab to bc, over their lengths: positive anticlockwise, 0 if straight."""
    one, other = b - a, c - b
    turn = (one.conjugate() * other).imag / (abs(one) * abs(other) or 1.0)
    return 0.0 if abs(turn) < ZERO_TURN else turn


def _triangles(z: Points) -> list[list[int]]:
    """Cut a simple anticlockwise polygon into triangles, by cutting ears off; corners by their places."""
    left, triangles = list(range(len(z))), list[list[int]]()
    while len(left) > 3:
        for k, middle in enumerate(left):
            a, c = left[k - 1], left[(k + 1) % len(left)]
            turn = _turn(z[a], z[middle], z[c])
            rest = z[[other for other in left if z[other] not in (z[a], z[middle], z[c])]]
            if turn > 0 and not _any_in_triangle(rest, z[a], z[middle], z[c]):
                triangles.append([a, middle, c])
                break
        else:  # nothing but straight corners is left
            break
        left.pop(k)
    return [*triangles, left]


def _any_in_triangle(points: Points, a: complex, b: complex, c: complex) -> bool:
    """Return whether any of some points is in a triangle or on its sides."""
    sides = [((end - start).conjugate() * (points - start)).imag for start, end in ((a, b), (b, c), (c, a))]
    return bool((np.array(sides) >= 0).all(axis=0).any())


def _merged(pieces: list[list[int]], z: Points) -> list[Points]:
    """Join pieces along common sides for as long as they stay convex."""

    @cache  # pairs that do not fit are tried again after each join
    def union(one: tuple[int, ...], other: tuple[int, ...]) -> tuple[int, ...]:
        """Return two pieces as one, empty if they share no side or would not be convex."""
        for k, start in enumerate(one):
            end = one[(k + 1) % len(one)]
            if start in other and other[other.index(start) - 1] == end:
                m = other.index(start)
                further = (other[(m + n) % len(other)] for n in range(1, len(other) - 1))
                whole = (*one[: k + 1], *further, *one[k + 1 :])
                convex = all(_turn(z[whole[n - 2]], z[whole[n - 1]], z[whole[n]]) >= 0 for n in range(len(whole)))
                return whole if convex else ()
        return ()

    left = [tuple(piece) for piece in pieces]
    while fitting := next((pair for pair in combinations(left, 2) if union(*pair)), None):
        one, other = fitting
        left[left.index(one)] = union(one, other)
        left.remove(other)
    return [z[list(piece)] for piece in left]

"""Polygons as convex pieces, which are what an engine of contacts takes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rocking_cli.arrays import Points
from rocking_cli.core.kinematics import area_of, distance, inside

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
    hull = _hull(z)
    size = float(np.abs(z - z.mean()).max())
    if distance(z, hull).max() > SHALLOW_SHARE * size:
        return None
    for other in others:
        reaching = other[inside(other, hull) & (~inside(other, z) | (distance(other, z) < TOUCHING_SHARE * size))]
        if reaching.size and distance(reaching, hull).max() > TOUCHING_SHARE * size:
            return None
    return hull


def _hull(z: Points) -> Points:
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
            if turn > 0 and not _within(rest, z[a], z[middle], z[c]):
                triangles.append([a, middle, c])
                break
        else:  # nothing but straight corners is left
            break
        left.pop(k)
    return [*triangles, left]


def _within(points: Points, a: complex, b: complex, c: complex) -> bool:
    """Return whether any of some points is in a triangle or on its sides."""
    sides = [((end - start).conjugate() * (points - start)).imag for start, end in ((a, b), (b, c), (c, a))]
    return bool((np.array(sides) >= 0).all(axis=0).any())


def _merged(pieces: list[list[int]], z: Points) -> list[Points]:
    """Join pieces along common sides for as long as they stay convex."""
    joined = True
    while joined:
        joined = False
        for i, one in enumerate(pieces):
            for j in range(i + 1, len(pieces)):
                union = _union(one, pieces[j])
                if union is not None and all(
                    _turn(z[union[k - 2]], z[union[k - 1]], z[union[k]]) >= 0 for k in range(len(union))
                ):
                    pieces[i] = union
                    pieces.pop(j)
                    joined = True
                    break
            if joined:
                break
    return [z[piece] for piece in pieces]


def _union(one: list[int], other: list[int]) -> list[int] | None:
    """Return two pieces as one, if they share a side."""
    for k, start in enumerate(one):
        end = one[(k + 1) % len(one)]
        if start in other and other[other.index(start) - 1] == end:
            m = other.index(start)
            return [*one[: k + 1], *(other[(m + n) % len(other)] for n in range(1, len(other) - 1)), *one[k + 1 :]]
    return None

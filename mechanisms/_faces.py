"""The face on which two bodies bear at a point: which way it looks, how far it goes, and which of them is borne."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from mechanisms._polygons import Points, area_of
from rocking_cli.core import Outline

NEAR = 1e-6  # of the size of both: how far beside a side a point may be and be on it
PARALLEL = 1e-3  # sine of the angle between two sides that lie on one another


class BearingFace(NamedTuple):
    """What bears at a point.

    Parameters
    ----------
    normal : complex
        Out of the first body, into the other; of one body alone, into it.
    far : complex
        The other end of what both have in common; the point itself where a corner stands on a side.
    inside : int or None
        Of which of them the point is inside a side, 0 or 1: the other has a corner there.
    """

    normal: complex
    far: complex
    inside: int | None


def between(one: Sequence[Outline], other: Sequence[Outline], at: complex) -> BearingFace | None:
    """The face between two bodies at a point; None where they do not touch there, or a shape is not known."""
    size = _size([*one, *other])
    best: BearingFace | None = None
    for p, q in _sides_at(one, at, size):
        along = (q - p) / abs(q - p)
        for r, s in _sides_at(other, at, size):
            way = (s - r) / abs(s - r)
            if abs((along.conjugate() * way).imag) > PARALLEL or (along.conjugate() * way).real > 0:
                continue
            places = [((z - p) / along).real for z in (r, s)]
            ends = [p + along * max(0.0, min(places)), p + along * min(abs(q - p), max(places))]
            far = max(ends, key=lambda end: abs(end - at))
            if best is None or abs(far - at) > abs(best.far - at):
                inside = next((k for k, (a, b) in enumerate(((p, q), (r, s))) if _is_inside(a, b, at, size)), None)
                best = BearingFace(-1j * along, far, inside)
    return best or _on_a_side(one, other, at, size)


def under(body: Sequence[Outline], at: complex) -> BearingFace | None:
    """The side on which a body stands at a point; None where its shape is not known or has no corner there."""
    size, best = _size(body), None
    for p, q in _sides_at(body, at, size):
        inwards = 1j * (q - p) / abs(q - p)
        far = max((p, q), key=lambda end: abs(end - at))
        if best is None or inwards.imag > best.normal.imag:
            best = BearingFace(inwards, far, None)
    return best


def _on_a_side(one: Sequence[Outline], other: Sequence[Outline], at: complex, size: float) -> BearingFace | None:
    """A corner of one body on a side of the other."""
    for k, shapes in enumerate((one, other)):
        for p, q in _sides_at(shapes, at, size):
            if _is_inside(p, q, at, size):
                outwards = -1j * (q - p) / abs(q - p)
                return BearingFace(outwards if k == 0 else -outwards, at, k)
    return None


def _size(shapes: Sequence[Outline]) -> float:
    z = np.concatenate([np.asarray(shape) for shape in shapes]) if shapes else np.zeros(1)
    return float(np.abs(z - z.mean()).max())


def _sides_at(shapes: Sequence[Outline], at: complex, size: float) -> Iterator[tuple[complex, complex]]:
    """The sides that a point is on, anticlockwise: the body is on their left."""
    for shape in shapes:
        z: Points = np.asarray(shape, dtype=np.complex128)
        z = z if area_of(z) > 0 else z[::-1]
        for p, q in zip(z.tolist(), np.roll(z, -1).tolist(), strict=True):
            if p == q:
                continue
            along = min(max(((at - p) / (q - p)).real, 0.0), 1.0)
            if abs(at - p - along * (q - p)) <= NEAR * size:
                yield p, q


def _is_inside(p: complex, q: complex, at: complex, size: float) -> bool:
    return min(abs(at - p), abs(at - q)) > NEAR * size

"""The faces at which bodies touch, and checks that the joints of a linkage are there and open as it rocks."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np

from mechanisms._linkage_sides import Connection, PlacedSide
from mechanisms._shapes import Member
from rocking_cli.core import Direction, Outline, Pin, RigidMotion
from rocking_cli.core.kinematics import Points, area_of, distance, inside
from rocking_cli.core.polygons import size_of

SIDE_DISTANCE = 1e-6  # distance from a side that counts as on the side, over the size of both bodies
MAX_SINE = 1e-3  # sine of the largest angle between two sides in contact

Side = tuple[complex, complex]


class BearingFace(NamedTuple):
    """The face between two bodies at a point, or between a body and the ground.

    Parameters
    ----------
    normal : complex
        Unit normal out of the first body into the other; for one body alone, into this body.
    far : complex
        The other end of the common part of both sides; the point itself if a corner stands on a side.
    inside : int or None
        The body, 0 or 1, in one of whose sides the point is; the other body has a corner there.
    """

    normal: complex
    far: complex
    inside: int | None


def face_between(one: Sequence[Outline], other: Sequence[Outline], at: complex) -> BearingFace | None:
    """Return the face between two bodies at a point; None if they do not touch there, or a shape is not known."""
    size = _size([*one, *other])
    best: BearingFace | None = None
    for (p, q), (r, s), low, high in _facing(_sides_at(one, at, size), list(_sides_at(other, at, size))):
        along = (q - p) / abs(q - p)
        far = max((p + along * low, p + along * high), key=lambda end: abs(end - at))
        if best is None or abs(far - at) > abs(best.far - at):
            inside = next((k for k, side in enumerate(((p, q), (r, s))) if _is_inside(*side, at, size)), None)
            best = BearingFace(-1j * along, far, inside)
    return best or _on_a_side(one, other, at, size)


def face_under(body: Sequence[Outline], at: complex) -> BearingFace | None:
    """Return the side on which a body stands at a point; None if its shape is not known or has no corner there."""
    size, best = _size(body), None
    for p, q in _sides_at(body, at, size):
        inwards = 1j * (q - p) / abs(q - p)
        far = max((p, q), key=lambda end: abs(end - at))
        if best is None or inwards.imag > best.normal.imag:
            best = BearingFace(inwards, far, None)
    return best


def shared_sides(one: Sequence[Outline], other: Sequence[Outline]) -> list[tuple[complex, tuple[complex, complex]]]:
    """Return the faces on which two bodies lie on one another: unit normals out of the first, and both ends."""
    size = _size([*one, *other])
    faces = []
    for (p, q), other_side, low, high in _facing(_sides(one), list(_sides(other))):
        along = (q - p) / abs(q - p)
        if (
            high - low > SIDE_DISTANCE * size
            and max(abs(((z - p) / along).imag) for z in other_side) <= SIDE_DISTANCE * size
        ):
            faces.append((-1j * along, (p + low * along, p + high * along)))
    return faces


def lowest_side(body: Sequence[Outline]) -> tuple[complex, complex] | None:
    """Return the ends of the base of a body: of its level sides at its lowest point; None if it has none there."""
    size, sides = _size(body), list(_sides(body))
    bottom = min((z.imag for side in sides for z in side), default=0.0)
    level = [z for side in sides if all(z.imag - bottom <= SIDE_DISTANCE * size for z in side) for z in side]
    return (min(level, key=lambda z: z.real), max(level, key=lambda z: z.real)) if level else None


def _facing(one: Iterable[Side], other: Sequence[Side]) -> Iterator[tuple[Side, Side, float, float]]:
    """Yield sides of two bodies that run against each other, and from where to where on the first both extend [m]."""
    for (p, q), (r, s) in product(one, other):
        along, back = (q - p) / abs(q - p), (s - r) / abs(s - r)
        turn = along.conjugate() * back
        if abs(turn.imag) <= MAX_SINE and turn.real <= 0:
            # Along the first side, the second one extends from its end s to its start r.
            yield (p, q), (r, s), max(0.0, ((s - p) / along).real), min(abs(q - p), ((r - p) / along).real)


def _on_a_side(one: Sequence[Outline], other: Sequence[Outline], at: complex, size: float) -> BearingFace | None:
    """Return the face of a corner of one body on a side of the other; None if there is none."""
    for k, shapes in enumerate((one, other)):
        for p, q in _sides_at(shapes, at, size):
            if _is_inside(p, q, at, size):
                outwards = -1j * (q - p) / abs(q - p)
                return BearingFace(outwards if k == 0 else -outwards, at, k)
    return None


def _size(shapes: Sequence[Outline]) -> float:
    z = np.concatenate([np.asarray(shape) for shape in shapes]) if shapes else np.zeros(1)
    return float(np.abs(z - z.mean()).max())


def _sides_at(shapes: Sequence[Outline], at: complex, size: float) -> Iterator[Side]:
    """Yield the sides on which a point lies."""
    for p, q in _sides(shapes):
        along = min(max(((at - p) / (q - p)).real, 0.0), 1.0)
        if abs(at - p - along * (q - p)) <= SIDE_DISTANCE * size:
            yield p, q


def _sides(shapes: Sequence[Outline]) -> Iterator[Side]:
    """Yield all sides in anticlockwise order, so that the body is on their left."""
    for shape in shapes:
        z: Points = np.asarray(shape, dtype=np.complex128)
        z = z if area_of(z) > 0 else z[::-1]
        yield from ((p, q) for p, q in zip(z.tolist(), np.roll(z, -1).tolist(), strict=True) if p != q)


def _is_inside(p: complex, q: complex, at: complex, size: float) -> bool:
    return min(abs(at - p), abs(at - q)) > SIDE_DISTANCE * size


MAX_JOINT_DISTANCE = 1e-2  # largest distance of a joint from its body, over width plus height of the body
ZERO_CLOSING_RATE = 1e-9  # closing rates of faces that count as zero, over the fastest velocity


def face_at(members: Mapping[str, Member], bodies: Sequence[str], at: complex) -> BearingFace | None:
    """Return the face between two bodies, or one body and the ground; None if it does not follow from their shapes."""
    shapes: list[Sequence[Outline]] = [members[name].outlines for name in bodies]
    return face_under(shapes[0], at) if len(shapes) == 1 else face_between(shapes[0], shapes[1], at)


def face_of(members: Mapping[str, Member], joint: Pin, given: Mapping[str, Connection]) -> BearingFace | None:
    """Return the face of a hinge: that given in the file, or else as the shapes have it."""
    connection = given[joint.name]
    if connection.ends is None:
        return face_at(members, joint.bodies, joint.at)
    far = max(connection.ends, key=lambda end: abs(end - joint.at))
    return BearingFace(connection.normal, far, 0 if len(joint.bodies) > 1 else None)


def beside(members: Mapping[str, Member], held: PlacedSide) -> tuple[str, str] | None:
    """Return a joint outside a body that it joins, and the reason in words; None if all joints are on their bodies."""
    for joint in held.joints:
        at = np.array([joint.at])
        for name in joint.bodies if isinstance(joint, Pin) else joint.bodies[:1]:
            shapes = [np.array(shape) for shape in members[name].outlines]
            away = min((float(distance(at, z)[0]) for z in shapes), default=0.0)
            if away > MAX_JOINT_DISTANCE * max((size_of(z) for z in shapes), default=1.0) and not any(
                inside(at, z)[0] for z in shapes
            ):
                where = f"[{joint.at.real:g}, {joint.at.imag:g}]"
                return joint.name, f"{where} is {away:.4g} m outside {name}: a joint must lie on the bodies it joins"
    return None


def closing(
    members: Mapping[str, Member], held: PlacedSide, motions: Mapping[str, RigidMotion]
) -> tuple[str, str] | None:
    """Return a joint whose face closes as rocking begins, and the reason in words; None if there is none."""
    fastest = max(
        float(abs(motions[name].carry(z)[1][0])) for name, each in members.items()
        for z in (each.body.centroid, *(z for shape in each.outlines for z in shape))
    )  # fmt: skip
    for joint in held.joints:
        face = face_of(members, joint, held.given) if isinstance(joint, Pin) else None
        if face is None:
            continue
        velocities = [motions[name].carry(face.far)[1][0] for name in joint.bodies]
        rate = (velocities[1] - velocities[0] if len(velocities) > 1 else velocities[0]) * np.conj(face.normal)
        if rate.real < -ZERO_CLOSING_RATE * fastest:
            names = " and ".join([*joint.bodies, *(["the ground"] if len(velocities) == 1 else [])])
            return joint.name, (
                f"{joint.name} closes: there {names} would go into one another at "
                f"[{face.far.real:.4g}, {face.far.imag:.4g}]; hinge at the other end of the face"
            )
    return None


def turns_the_wrong_way(
    members: Mapping[str, Member], lead: str, motions: Mapping[str, RigidMotion], direction: Direction
) -> str | None:
    """Return why a lead turns the wrong way, so that the structure descends, in words; None if it does not."""
    velocities = [(each.body.mass, complex(motions[n].carry(each.body.centroid)[1][0])) for n, each in members.items()]
    lifted = sum(mass * dz.imag for mass, dz in velocities)
    driven = direction * sum(mass * dz.real for mass, dz in velocities)
    if not (lifted < 0 and driven < 0):
        return None
    able = [name for name, motion in motions.items() if motion.dpsi[0] * motions[lead].dpsi[0] < 0]
    sense = "clockwise" if direction > 0 else "anticlockwise"
    why = f"let another body lead, of {', '.join(able)}" if able else f"nothing in it turns {sense} as it is thrown"
    return f"{lead} turns the wrong way: {why}"

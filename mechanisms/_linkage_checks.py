"""Checks that the joints of a linkage are where bodies touch, and open as the structure rocks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from mechanisms import _faces as faces
from mechanisms._linkage_sides import Connection, PlacedSide
from mechanisms._shapes import Member
from rocking_cli.core import Direction, Outline, Pin, RigidMotion
from rocking_cli.core.kinematics import distance, inside
from rocking_cli.core.polygons import size_of

MAX_JOINT_DISTANCE = 1e-2  # largest distance of a joint from its body, over width plus height of the body
ZERO_CLOSING_RATE = 1e-9  # closing rates of faces that count as zero, over the fastest velocity


def face_at(members: Mapping[str, Member], bodies: Sequence[str], at: complex) -> faces.BearingFace | None:
    """Return the face between two bodies, or one body and the ground; None if it does not follow from their shapes."""
    shapes: list[Sequence[Outline]] = [members[name].outlines for name in bodies]
    return faces.under(shapes[0], at) if len(shapes) == 1 else faces.between(shapes[0], shapes[1], at)


def face_of(members: Mapping[str, Member], joint: Pin, given: Mapping[str, Connection]) -> faces.BearingFace | None:
    """Return the face of a hinge: that given in the file, or else as the shapes have it."""
    connection = given[joint.name]
    if connection.ends is None:
        return face_at(members, joint.bodies, joint.at)
    far = max(connection.ends, key=lambda end: abs(end - joint.at))
    return faces.BearingFace(connection.normal, far, 0 if len(joint.bodies) > 1 else None)


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

"""A wall that bends out of plane: two equal blocks that form a slider-crank [paper, Section 4]."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import acos, atan2, hypot, pi
from typing import ClassVar

import numpy as np

from rocking_cli.core import (
    Angle,
    Body,
    Contact,
    Direction,
    Joint,
    Length,
    Mechanism,
    Reals,
    RigidMotion,
    Sketch,
    box,
    length,
    of_joints,
    rectangle,
    rotation,
)
from rocking_cli.core.fields import along_wall


class Wall(Mechanism):
    """A one-way spanning wall hinged at its foot and at mid-height, its top held sideways."""

    mechanism: ClassVar[str] = "wall"
    title: ClassVar[str] = "masonry wall bending out of plane, top held sideways"
    suits: ClassVar[str] = "wall held sideways at its top, which cracks at mid-height"
    source: ClassVar[str] = "DeJong and Dimitrakopoulos (2014), Eqs. 21-23"
    verified: ClassVar[str] = "closed forms phi_cr = alpha, kappa1 = 1/2, lambda = 2 tan(alpha), p^2 = 3g/(2R); Eq. 21"
    caution: ClassVar[str] = (
        "Unconservative without a load on top: the hinge is fixed at mid-height, where lambda = 2 tan(alpha). Under "
        "self-weight alone, the weakest hinge of a wall lies higher, where both lambda and the displacement capacity "
        "are smaller."
    )

    thickness: float = length("thickness", symbol="2b", example=0.3)
    height: float = length("height between foot and top support", symbol="4h", example=3.0)
    depth: float | None = along_wall("length along the wall, out of plane; `length` is read too")

    def bodies(self) -> Sequence[Body]:
        h = self.height / 4
        return (
            box("lower block", 0.5, self.thickness, 2 * h, 1j * h),
            box("upper block", 0.5, self.thickness, 2 * h, 3j * h),
        )

    def motion(self, phi: Reals, direction: Direction) -> Sequence[RigidMotion]:
        return slider_crank(phi, direction, *self.hinges(direction))

    def hinges(self, direction: Direction) -> tuple[complex, complex, complex]:
        """Return the positions of the foot pivot A, the mid hinge B and the top support C at rest [m]."""
        face, h = direction * self.thickness / 2, self.height / 4
        a, b = (face - direction * self.inwards(direction, joint) for joint in ("foot", "hinge"))
        return a + 0j, complex(-b, 2 * h), complex(face, 4 * h)

    def bearing(self, direction: Direction) -> Mapping[str, float]:
        return {"foot": self.borne(direction), "hinge": self.borne(direction, "upper block")}

    def limit(self, direction: Direction) -> float:
        return slider_crank_limit(direction, *self.hinges(direction))  # the two blocks lie folded

    def joints(self, direction: Direction) -> Sequence[Joint]:
        lower, upper = (body.name for body in self.bodies())
        a, b, c = self.hinges(direction)
        return (
            Joint("A" + direction.prime, a, (lower,)),
            Joint("B" + direction.prime, b, (lower, upper), face=lower),
            Joint("C" + direction.prime, c, (upper,), slide=1j),
        )

    def contacts(self, direction: Direction) -> Sequence[Contact]:
        return of_joints(self.joints(direction), self.friction)

    def critical_rotation_alone(self, direction: Direction) -> float:
        return atan2(2 * self.thickness, self.height)  # alpha: both pivots and the mid hinge are in line

    def sketch(self) -> Sketch:
        lower, upper = self.bodies()
        right, pivot = complex(self.thickness / 2), self.hinges(Direction.POSITIVE)[0]
        left, h = -right, self.height / 4
        return Sketch(
            outlines={body.name: [rectangle(body.centroid, self.thickness, 2 * h)] for body in (lower, upper)},
            uniform=True,
            hinges={direction: self.joints(direction) for direction in Direction},
            lengths=[
                Length("2b", left, right),
                Length("4h", left, left + 4j * h),
                Length("R", pivot, lower.centroid, Direction.POSITIVE, derived=True),
            ],
            angles=[Angle("α", pivot, pivot + 1j, lower.centroid, Direction.POSITIVE)],
        )


def slider_crank(
    phi: Reals, direction: Direction, a: complex, b: complex, c: complex
) -> tuple[RigidMotion, RigidMotion]:
    """Return the motions of the links AB, which turns by -s phi about A, and BC, whose C moves vertically only.

    Parameters
    ----------
    phi : ndarray, shape (n,)
        Rotations of AB in this direction [rad], from 0 to less than `slider_crank_limit`.
    direction : Direction
        Clockwise (positive) or anticlockwise (negative) rotation of AB.
    a, b, c : complex
        Rest positions of the hinges [m]; A is fixed and C above B.

    Returns
    -------
    tuple of RigidMotion
        Motions of AB and BC.

    Notes
    -----
    With d = C - B, d_x is known and |d| constant: its derivatives are those of d_y = sqrt(|d|^2 - d_x^2).
    """
    crank = rotation(phi, a, -direction)
    at_b, db, ddb = crank.carry(b)
    x, dx, ddx = c.real - at_b.real, -db.real, -ddb.real
    y = np.sqrt(abs(c - b) ** 2 - x**2)
    dy = -x * dx / y
    turn = -dx / y  # d' = i theta' d
    bend = (-ddx + dx * dy / y) / y
    turned = np.arctan2(y, x) - atan2((c - b).imag, (c - b).real)
    return crank, RigidMotion(b, at_b, db, ddb, turned, turn, bend)


def slider_crank_limit(direction: Direction, a: complex, b: complex, c: complex) -> float:
    """Return the rotation of AB at which AB lies flat, or BC does so that the linkage locks [rad]."""
    s = int(direction)
    crank, span = hypot(s * (b - a).real, (b - a).imag), abs(c - b)
    # In the positive direction B goes to the right until it is |BC| away from the line on which C is held.
    start = atan2((b - a).imag, s * (b - a).real)
    reach = (s * (c - a).real + span) / crank
    return min(pi / 2, start - acos(reach)) if reach < 1 else pi / 2

"""A wall that bends out of plane: two equal blocks, a slider-crank [paper, Section 4]."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, hypot, pi
from typing import ClassVar

import numpy as np

from rocking_cli.core import (
    Angle,
    Body,
    Direction,
    Joint,
    Length,
    Mechanism,
    Reals,
    RigidMotion,
    Sketch,
    box,
    length,
    rectangle,
    rotation,
)


class Wall(Mechanism):
    """A one-way spanning wall hinged at its foot and at mid-height, its top held sideways."""

    mechanism: ClassVar[str] = "wall"
    title: ClassVar[str] = "masonry wall bending out of plane, top held sideways"
    source: ClassVar[str] = "DeJong and Dimitrakopoulos (2014), Eqs. 21-23"
    verified: ClassVar[str] = "closed forms phi_cr = alpha, kappa1 = 1/2, lambda = 2 tan(alpha), p^2 = 3g/(2R); Eq. 21"
    caution: ClassVar[str] = (
        "Not on the safe side without a load on top: the hinge is held at mid-height, where lambda = 2 tan(alpha). "
        "Under its own weight alone the weakest hinge of a wall lies higher, and there both lambda and the room to "
        "move are smaller."
    )

    thickness: float = length("thickness", symbol="2b", example=0.3)
    height: float = length("height between foot and top support", symbol="4h", example=3.0)

    @property
    def _alpha(self) -> float:
        return atan2(2 * self.thickness, self.height)

    def bodies(self) -> Sequence[Body]:
        h = self.height / 4
        return (
            box("lower block", 0.5, self.thickness, 2 * h, 1j * h),
            box("upper block", 0.5, self.thickness, 2 * h, 3j * h),
        )

    def motion(self, phi: Reals, direction: Direction) -> Sequence[RigidMotion]:
        foot = complex(direction * self.thickness / 2)
        R = hypot(self.thickness, self.height / 2) / 2
        tilt = self._alpha - phi
        top = foot + 4j * R * np.cos(tilt)  # it stays above the foot pivot
        upper = RigidMotion(
            foot + 1j * self.height,
            top,
            4j * R * np.sin(tilt),
            -4j * R * np.cos(tilt),
            direction * phi,
            np.full_like(phi, direction),
            np.zeros_like(phi),
        )
        return rotation(phi, foot, -direction), upper

    def limit(self, direction: Direction) -> float:
        return pi / 2  # the two blocks lie folded

    def joints(self, direction: Direction) -> Sequence[Joint]:
        lower, upper = (body.name for body in self.bodies())
        foot, h = complex(direction * self.thickness / 2), self.height / 4
        return (
            Joint("A" + direction.prime, foot, (lower,)),
            Joint("B" + direction.prime, -foot + 2j * h, (lower, upper), face=lower),
            Joint("C" + direction.prime, foot + 4j * h, (upper,), slide=1j),
        )

    def critical_rotation(self, direction: Direction) -> float:
        return self._alpha  # both pivots and the mid hinge are in line

    def sketch(self) -> Sketch:
        lower, upper = self.bodies()
        h, right = self.height / 4, complex(self.thickness / 2)
        left = -right
        return Sketch(
            outlines={body.name: [rectangle(body.centroid, self.thickness, 2 * h)] for body in (lower, upper)},
            uniform=True,
            hinges={direction: self.joints(direction) for direction in Direction},
            lengths=[
                Length("2b", left, right),
                Length("4h", left, left + 4j * h),
                Length("R", right, lower.centroid, Direction.POSITIVE),
            ],
            angles=[Angle("α", right, right + 1j, lower.centroid, Direction.POSITIVE)],
        )

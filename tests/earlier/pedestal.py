"""A pedestal with a statue and a floor, which uses all that a mechanism could say and ask of itself."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import pi
from typing import ClassVar

import numpy as np

from rocking_cli.core import (
    Attached,
    Body,
    Contact,
    Direction,
    Extra,
    Joint,
    Mechanism,
    PointMass,
    Reals,
    RigidMotion,
    Spot,
    box,
    geometry_error,
    length,
    of_joints,
    quantity,
    rotation,
)
from rocking_cli.core.coefficients import Coefficients


class Pedestal(Mechanism):
    """Two boxes that turn as one, with a floor of its own on the upper one."""

    mechanism: ClassVar[str] = "pedestal"
    title: ClassVar[str] = "pedestal with a statue"
    source: ClassVar[str] = "none"
    caution: ClassVar[str] = "It is of use in tests only."

    width: float = length("width", symbol="2b", example=0.8)
    height: float = length("height", symbol="2h", example=2.0)
    tall: float = length("height of the statue", example=1.0)
    floor: float = quantity("mass of the floor on the statue", unit="kg", example=100.0, default=0.0, ge=0)

    def model_post_init(self, _):
        if self.tall > 10 * self.height:
            raise geometry_error("tall", "is too tall")

    @property
    def has_mass(self) -> bool:
        return self.mass is not None or self.density is not None

    @property
    def bends(self) -> bool:
        return True

    @property
    def smooth(self) -> bool:
        return super().smooth and self.floor >= 0

    def total_mass(self) -> float | None:
        return super().total_mass()

    def volume(self) -> float:
        return self.width * (self.height + self.tall / 2) * (self.depth or 1.0)

    def bodies(self) -> Sequence[Body]:
        pedestal = box("pedestal", 1.0, self.width, self.height, 0.5j * self.height)
        return (pedestal, box("statue", 0.3, self.width / 2, self.tall, 1j * (self.height + self.tall / 2)))

    def foot(self, direction: Direction) -> float:
        return self.width / 2 - self.inwards(direction, "foot")

    def motion(self, phi: Reals, direction: Direction) -> Sequence[RigidMotion]:
        return [rotation(phi, complex(direction * self.foot(direction)), -direction)] * 2

    def limit(self, direction: Direction) -> float:
        return pi / 2

    def carries(self) -> Sequence[Attached]:
        if not self.floor:
            return ()
        return (PointMass("floor", Spot("statue", 1j * (self.height + self.tall)), self.floor, horizontal=0.5),)

    def bearing(self, direction: Direction) -> Mapping[str, float]:
        return {"foot": self.borne(direction, "pedestal", "statue")}

    def extras(self, direction: Direction) -> Sequence[Extra]:
        top = self.followed(np.zeros(1), direction)(Spot("statue", 1j * (self.height + self.tall)))
        weight = sum(body.mass for body in self.weighed()) + sum(
            thing.mass for thing in self.attached if isinstance(thing, PointMass)
        )
        return [
            Extra("lever", float(top.dz[0].real), "m", "lever of the top"),
            Extra("weight", weight, "kg", "all mass"),
        ]

    def joints(self, direction: Direction) -> Sequence[Joint]:
        return [Joint("O" + direction.prime, complex(direction * self.foot(direction)), ("pedestal",))]

    def contacts(self, direction: Direction) -> Sequence[Contact]:
        top, half = 1j * self.height, self.width / 4
        under = Contact(("pedestal", "statue"), (top - half, top + half), face="pedestal", friction=self.friction)
        return [*of_joints(self.joints(direction), self.friction), under]

    def coefficients(self, phi: Reals, direction: Direction) -> Coefficients:
        return super().coefficients(phi, direction)

    def uplift(self, direction: Direction) -> float:
        rest = self.coefficients(np.zeros(1), direction)
        return float(rest.restoring(self.gravity)[0] / rest.B[0])

    def eta(self, direction: Direction) -> float:
        return super().eta(direction)

    def own_caution(self) -> str:
        return "The floor slides." if self.floor else ""

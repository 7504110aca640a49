"""A rectangular block with a point mass fixed on the middle of its top, such as a bust on a pedestal."""

from __future__ import annotations

from collections.abc import Sequence
from math import pi
from typing import ClassVar

from rocking_cli.core import (
    Body,
    Direction,
    Hinge,
    Length,
    Mechanism,
    Reals,
    RigidMotion,
    Sketch,
    box,
    disc,
    length,
    quantity,
    rotation,
)


class CappedBlock(Mechanism):
    """All a plugin says is where its bodies are; uplift, critical rotation and restitution follow."""

    mechanism: ClassVar[str] = "capped_block"
    title: ClassVar[str] = "block with a point mass on its top"
    source: ClassVar[str] = "the plugin guide of rocking-cli"
    verified: ClassVar[str] = "the plain block for cap_mass = 0"

    width: float = length("width of the base", symbol="2b", example=0.8)
    height: float = length("height of the block", symbol="2h", example=2.0)
    cap_mass: float = quantity("mass on the top over that of the block", example=0.5, ge=0, le=1e6)

    def bodies(self) -> Sequence[Body]:
        """The block of 1 kg, and the mass."""
        return (
            box("block", 1.0, self.width, self.height, 0.5j * self.height),
            Body("cap", self.cap_mass, 0.0, 1j * self.height),
        )

    def motion(self, phi: Reals, direction: Direction) -> Sequence[RigidMotion]:
        """Both turn about the foot corner on the side they rock to."""
        turn = rotation(phi, complex(direction * self.width / 2), -direction)
        return turn, turn

    def limit(self, direction: Direction) -> float:
        """The block lies on its side."""
        return pi / 2

    def sketch(self) -> Sketch:
        """Pivots with a letter, the size, and a bust that is not to scale; the block has its shape already."""
        b, top = self.width / 2, 1j * self.height
        return Sketch(
            outlines={"cap": [disc(top + 0.5j * b, b / 2)]},
            hinges={direction: [Hinge("O", complex(direction * b), ("block",))] for direction in Direction},
            lengths=[Length("2b", complex(-b), complex(b)), Length("2h", complex(-b), -b + top)],
            notes=["the cap is a point: not to scale"],
        )

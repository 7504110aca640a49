"""Working mechanism for rocking-cli: a block with a point mass on its top, such as a bust on a pedestal.

A mechanism defines the places of its rigid bodies, at rest and in motion. Uplift, critical rotation, equivalent block,
restitution, time histories and drawings follow from them. Points of the plane are complex numbers x + iy [m], x to the
right and y up; the structure stands on y = 0. Rotations of bodies are anticlockwise [rad].
"""

from __future__ import annotations

from collections.abc import Sequence
from math import pi
from typing import ClassVar

from rocking_cli.core import (
    Body,
    Direction,
    Joint,
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
    """Block with a point mass fixed on the middle of its top."""

    # Shown by `rocking mechanisms`. The first is the name in structure files and in pyproject.toml.
    mechanism: ClassVar[str] = "capped_block"
    title: ClassVar[str] = "block with a point mass on its top"
    source: ClassVar[str] = "the plugin guide of rocking-cli"  # the publication and its equations
    # How the numbers were checked. If this is empty, rocking warns the users of the mechanism.
    verified: ClassVar[str] = ""

    # The fields of a structure file. `length` is a size in metres, `quantity` anything else: unit, bounds, default. A
    # field without a default must be in the file, and needs an example, which `rocking new` prints.
    width: float = length("width of the base", symbol="2b", example=0.8)
    height: float = length("height of the block", symbol="2h", example=2.0)
    cap_mass: float = quantity("mass on the top over that of the block", example=0.5, ge=0, le=1e6)

    def bodies(self) -> Sequence[Body]:
        """Return mass, inertia and centroid of each body at rest: the block of 1 kg, and the mass.

        No field gives a mass in kg, so numbers are shown per unit mass. `box` and `polygon` compute the inertia; use
        `Body(name, mass, inertia, centroid)` for a body of any shape.
        """
        return (
            box("block", 1.0, self.width, self.height, 0.5j * self.height),
            Body("cap", self.cap_mass, 0.0, 1j * self.height),
        )

    def motion(self, phi: Reals, direction: Direction) -> Sequence[RigidMotion]:
        """Return the motion of each body, in the order of `bodies`, at an array of rotations `phi` >= 0.

        Both bodies turn about the corner on the side to which they rock: clockwise (-1) in the positive direction.
        `four_bar` moves a linkage. Derivatives must be exact: differences of positions are too coarse.
        """
        turn = rotation(phi, self._foot(direction), -direction)
        return turn, turn

    def limit(self, direction: Direction) -> float:
        """Return the kinematic limit: here the block lies on its side; a linkage locks [rad]."""
        return pi / 2

    def joints(self, direction: Direction) -> Sequence[Joint]:
        """Return the joints with the ground, at which time histories are checked for sliding. Optional.

        A joint between two bodies that separate is `("lower", "upper")`, the supported one last. The cap stays on the
        block and needs no joint.
        """
        return (Joint("O" + direction.prime, self._foot(direction), ("block",)),)

    def sketch(self) -> Sketch:
        """Return what the drawing shows in addition to `box`: sizes, hinges, a cap that is not to scale. Optional."""
        left, right, top = complex(-self.width / 2), complex(self.width / 2), 1j * self.height
        return Sketch(
            outlines={"cap": [disc(top + 0.25j * self.width, self.width / 4)]},
            hinges={direction: self.joints(direction) for direction in Direction},
            lengths=[Length("2b", left, right), Length("2h", left, left + top)],
            notes=["the cap is a point: not to scale"],
        )

    def _foot(self, direction: Direction) -> complex:
        """Return the corner about which the block rocks: the right one in the positive direction, whose value is 1."""
        return complex(direction * self.width / 2)

"""Free-standing equal columns capped by a freely supported beam [paper, Table I; Makris and Vassiliou 2013]."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import atan2, pi
from typing import ClassVar

import numpy as np

from mechanisms.block import Block
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
    quantity,
    rectangle,
    rotation,
)

DRAWN = 6  # columns of a picture, at most


class SymmetricFrame(Mechanism):
    """Columns that all rotate equally about their corners while the beam stays level."""

    mechanism: ClassVar[str] = "symmetric_frame"
    title: ClassVar[str] = "equal columns under a freely supported beam"
    source: ClassVar[str] = "DeJong and Dimitrakopoulos (2014), Table I; Makris and Vassiliou (2013)"
    verified: ClassVar[str] = "closed forms p^2 = 3g/(4R) (1+2 gamma)/(1+3 gamma), lambda = tan(alpha), eta"

    column_width: float = length("width of a column", symbol="2b", example=1.0)
    column_height: float = length("height of a column", symbol="2h", example=6.0)
    columns: int = quantity(
        "number of columns (mass_ratio is to all of them; three or more may fall out of step)",
        symbol="N",
        example=2,
        default=2,
        ge=1,
        le=10_000,
    )
    mass_ratio: float = quantity("mass of the beam over that of all columns", symbol="gamma", example=2.0, ge=0, le=1e6)

    def bodies(self) -> Sequence[Body]:
        # All columns move alike: one body with the mass of all of them stands for them. The beam only moves
        # sideways and up: where in it the centroid is changes nothing.
        of_columns = 1 / (1 + self.mass_ratio)
        h = self.column_height / 2
        return (
            box("columns", of_columns, self.column_width, self.column_height, 1j * h),
            Body("beam", 1 - of_columns, 0.0, self._axes[-1] / 2 + 2j * h + 0.5j * self.column_width),
        )

    def own_caution(self) -> str:
        if self.columns < 3:
            return ""
        return (
            "Three or more columns may fall out of step at an impact: a column that carries nothing then rocks alone. "
            "If that column ends otherwise than the frame, the outcome is unknown from the first impact; if not, peaks "
            "are those of columns in step."
        )

    def columns_alone(self) -> Sequence[Mechanism]:
        if self.columns < 3:
            return ()
        return (
            Block(
                width=self.column_width, height=self.column_height, gravity=self.gravity, restitution=self.restitution,
                friction=self.friction, density=self.density, depth=self.depth,
            ),
        )  # fmt: skip

    def alike(self) -> Mapping[str, int]:
        return {"columns": self.columns}

    def volume(self) -> float:
        """Return the volume [m3] of columns with depth `depth`, and of a beam of the same density."""
        return self.given_depth * self.column_width * self.column_height * self.columns * (1 + self.mass_ratio)

    def motion(self, phi: Reals, direction: Direction) -> Sequence[RigidMotion]:
        foot = complex(direction * self.column_width / 2)
        top = complex(-foot.real, self.column_height)
        column = rotation(phi, foot, -direction)
        none = np.zeros_like(phi)
        return column, RigidMotion(top, *column.carry(top), none, none, none)

    def limit(self, direction: Direction) -> float:
        return pi / 2  # the columns lie flat

    def joints(self, direction: Direction) -> Sequence[Joint]:
        columns, beam = (body.name for body in self.bodies())
        b = complex(direction * self.column_width / 2)
        return (
            Joint("A" + direction.prime, b, (columns,)),
            Joint("B" + direction.prime, -b + 1j * self.column_height, (columns, beam), face=beam, level=True),
        )

    def contacts(self, direction: Direction) -> Sequence[Contact]:
        return of_joints(self.joints(direction), self.friction)

    def critical_rotation(self, direction: Direction) -> float:
        return atan2(self.column_width, self.column_height)  # Eq. 37

    @property
    def _axes(self) -> list[complex]:
        """Positions of the columns in drawings [m]; their spacing is not given, and has no effect."""
        spacing = max(3 * self.column_width, 0.6 * self.column_height)
        return [complex(k * spacing) for k in range(min(self.columns, DRAWN))]

    def sketch(self) -> Sketch:
        columns, beam = self.bodies()
        b, top = self.column_width / 2, 1j * self.column_height
        right = complex(b)
        few = f", {DRAWN} of {self.columns} columns" if self.columns > DRAWN else ""
        return Sketch(
            outlines={
                columns.name: [rectangle(columns.centroid, 2 * b, self.column_height)],
                beam.name: [rectangle(beam.centroid, self._axes[-1].real + 2 * b, 2 * b)],
            },
            copies={columns.name: self._axes},
            hinges={direction: self.joints(direction) for direction in Direction},
            lengths=[
                Length("2b", complex(-b), right),
                Length("2h", complex(-b), -b + top),
                Length("R", right, columns.centroid, Direction.POSITIVE),
            ],
            angles=[Angle("α", right, right + 1j, columns.centroid, Direction.POSITIVE)],
            at_will=[beam.name],
            notes=[f"spacing and depth of the beam are not to scale: they are not given and change nothing{few}"],
        )

"""Free-standing equal columns capped by a freely supported beam [paper, Table I; Makris and Vassiliou 2013]."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from math import atan2, pi
from typing import ClassVar, Self

import numpy as np
from pydantic import model_validator

from mechanisms._linked_bodies import OUT_OF_STEP
from mechanisms.block import Block
from rocking_cli.core import (
    Angle,
    Body,
    Contact,
    Direction,
    Joint,
    Length,
    Mechanism,
    Piece,
    Reals,
    RigidMotion,
    Sketch,
    Solid,
    box,
    geometry_error,
    length,
    of_joints,
    quantity,
    rectangle,
    rotation,
)
from rocking_cli.core.reactions import at_uplift

MAX_DRAWN_COLUMNS = 6  # drawings with more columns are not to scale
MAX_CHECKED_COLUMNS = 20  # checks of more columns take seconds
LIGHT_BEAM = 1e-8  # mass of a beam that loads no column, over the mass of the columns


class SymmetricFrame(Mechanism):
    """Columns that all rotate equally about their corners while the beam stays level."""

    mechanism: ClassVar[str] = "symmetric_frame"
    title: ClassVar[str] = "equal columns under a freely supported beam"
    suits: ClassVar[str] = "colonnade or bridge on equal columns"
    source: ClassVar[str] = "DeJong and Dimitrakopoulos (2014), Table I; Makris and Vassiliou (2013)"
    verified: ClassVar[str] = "closed forms p^2 = 3g/(4R) (1+2 gamma)/(1+3 gamma), lambda = tan(alpha), eta"

    starter: ClassVar[tuple[str, ...]] = ("spacing", "beam_depth")

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

    spacing: float | None = length(
        "distance between the column axes; with beam_depth, the joints are checked",
        symbol="L", example=5.0, default=None,
    )  # fmt: skip
    beam_depth: float | None = length(
        "depth of the beam, flush with the outer columns; required with spacing", example=1.0, default=None
    )

    @model_validator(mode="after")
    def _fits(self) -> Self:
        if (self.spacing is None) != (self.beam_depth is None):
            missing = "spacing" if self.spacing is None else "beam_depth"
            raise geometry_error(missing, "is missing: give spacing and beam_depth, or neither")
        if self.spacing is not None and (not 1 < self.columns <= MAX_CHECKED_COLUMNS or self._is_unloaded):
            raise geometry_error("spacing", f"has no effect, as {self.unchecked}: leave out spacing and beam_depth")
        if self.spacing is not None and self.spacing <= self.column_width:
            raise geometry_error(
                "spacing",
                f"the columns overlap: the distance between their axes ({self.spacing:g} m) must be more than "
                f"their width ({self.column_width:g} m)",
            )
        return self

    def bodies(self) -> Sequence[Body]:
        # All columns move alike: one body with the mass of all of them stands for them. The beam only moves
        # sideways and up: its shape has an effect on its joints alone.
        of_columns = 1 / (1 + self.mass_ratio)
        h, last = self.column_height / 2, self._axes[-1]
        columns = box("columns", of_columns, self.column_width, self.column_height, 1j * h)
        if self.beam_depth is None:
            return columns, Body("beam", 1 - of_columns, 0.0, last / 2 + 2j * h + 0.5j * self.column_width)
        middle = last / 2 + 1j * (2 * h + self.beam_depth / 2)
        return columns, box("beam", 1 - of_columns, last.real + self.column_width, self.beam_depth, middle)

    def own_caution(self) -> str:
        """Return the caution that columns may fall out of step, if three or more carry one beam."""
        return OUT_OF_STEP if self.columns_alone() else ""

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

    def solids(self) -> Mapping[str, Sequence[Solid]]:
        if self.density is None or self.mass is not None:
            return {}
        sizes = (self.column_width, self.column_height)
        # The beam has the mass of so many columns.
        counts = {"columns": self.columns, "beam": self.columns * self.mass_ratio}
        return {
            name: [Solid("rectangle", sizes, self.density, self.given_depth, count=count)]
            for name, count in counts.items()
        }

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

    def pieces(self, direction: Direction) -> Sequence[Piece]:
        if self.spacing is None:
            return super().pieces(direction)
        columns, beam = self.weighed()
        mass, inertia = columns.mass / self.columns, columns.inertia / self.columns
        return [
            *(
                Piece(Body(_column(k), mass, inertia, columns.centroid + shift), columns.name, shift)
                for k, shift in enumerate(self._axes)
            ),
            Piece(beam, beam.name),
        ]

    def piece_at(self, body: str, at: complex, direction: Direction) -> str:
        return _column(0) if self.spacing is not None and body == "columns" else body

    def contacts(self, direction: Direction) -> Sequence[Contact] | None:
        foot, top = self.joints(direction)
        if self.spacing is None:
            return of_joints([foot, top], self.friction) if self._slides_first else None
        outer = self._axes[0 if direction > 0 else -1]  # outer column, whose corner bears on the corner of the beam
        joints = []
        for k, shift in enumerate(self._axes):
            column = _column(k)
            joints.append(Joint("", foot.point + shift, (column,)))
            face = column if shift == outer else "beam"
            joints.append(Joint("", top.point + shift, (column, "beam"), face=face))
        return of_joints(joints, self.friction)

    @cached_property
    def _slides_first(self) -> bool:
        """Whether the feet slide before the frame rocks either way, which the sum of their forces decides."""
        if self.friction is None:
            return False
        feet = [at_uplift(self, direction) for direction in self.directions]
        return all(abs(each.shear[0, 0]) > self.friction * each.normal[0, 0] for each in feet)

    @property
    def _is_unloaded(self) -> bool:
        return self.columns > 2 and self.mass_ratio < LIGHT_BEAM

    @property
    def unchecked(self) -> str:
        if self.columns == 1:
            return "the file does not say what keeps the beam on a single column level"
        if self.columns > MAX_CHECKED_COLUMNS:
            return f"it has more than {MAX_CHECKED_COLUMNS} columns"
        if self._is_unloaded:
            return "its beam has no mass and loads no column"
        return "give spacing and beam_depth"

    def critical_rotation_alone(self, direction: Direction) -> float:
        return atan2(self.column_width, self.column_height)  # Eq. 37

    @property
    def _axes(self) -> list[complex]:
        """Positions of the columns, those of the drawing if their spacing is not given [m]."""
        if self.spacing is not None:
            return [complex(k * self.spacing) for k in range(self.columns)]
        spacing = max(3 * self.column_width, 0.6 * self.column_height)
        return [complex(k * spacing) for k in range(min(self.columns, MAX_DRAWN_COLUMNS))]

    def sketch(self) -> Sketch:
        columns, beam = self.bodies()
        b, top = self.column_width / 2, 1j * self.column_height
        right = complex(b)
        lengths = [
            Length("2b", complex(-b), right),
            Length("2h", complex(-b), -b + top),
            Length("R", right, columns.centroid, Direction.POSITIVE, derived=True),
        ]
        outlines = {columns.name: [columns.outline], beam.name: [beam.outline]}
        notes = []
        if self.spacing is not None:
            lengths.append(Length("L", 0j, complex(self.spacing)))
        else:
            outlines[beam.name] = [rectangle(beam.centroid, self._axes[-1].real + 2 * b, 2 * b)]
            few = f", {MAX_DRAWN_COLUMNS} of {self.columns} columns" if self.columns > MAX_DRAWN_COLUMNS else ""
            notes.append(f"spacing and depth of the beam are not to scale: they are not given{few}")
        return Sketch(
            outlines=outlines,
            uniform=self.spacing is not None,
            copies={columns.name: self._axes},
            hinges={direction: self.joints(direction) for direction in Direction},
            lengths=lengths,
            angles=[Angle("α", right, right + 1j, columns.centroid, Direction.POSITIVE)],
            at_will=[beam.name] if notes else [],
            notes=notes,
        )


def _column(k: int) -> str:
    return f"column {k + 1}"

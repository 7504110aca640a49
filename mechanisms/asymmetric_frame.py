"""A beam on two columns of different height: a four-bar linkage [paper, Section 5.1]."""

from __future__ import annotations

from collections.abc import Sequence
from math import isclose, pi
from typing import ClassVar, Self

import numpy as np
from pydantic import model_validator

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
    four_bar,
    four_bar_limit,
    geometry_error,
    length,
    of_joints,
    quantity,
    rectangle,
)


class AsymmetricFrame(Mechanism):
    """Two columns with level tops and feet at different levels, under a freely supported beam."""

    mechanism: ClassVar[str] = "asymmetric_frame"
    title: ClassVar[str] = "beam on two columns of different height"
    suits: ClassVar[str] = "bridge or portal on columns of different height"
    source: ClassVar[str] = "DeJong and Dimitrakopoulos (2014), Eqs. 26-38, corrected"
    verified: ClassVar[str] = "Eqs. 32-34 and 38 written out (32, 33 corrected); the symmetric frame for equal columns"

    starter: ClassVar[tuple[str, ...]] = ("density", "depth")

    column_width: float = length("width of both columns", symbol="2b", example=1.0)
    left_height: float = length("height of the left column", symbol="2H", example=6.0)
    right_height: float = length("height of the right column", symbol="2H1", example=7.5)
    spacing: float = length("distance between the column axes", symbol="L", example=8.0)
    beam_depth: float = length("depth of the beam, which is L + 2b long", symbol="2h", example=1.0)
    density: float | None = quantity(
        "density of columns and beam", unit="kg/m3", example=2400.0, default=None, gt=0, le=1e6
    )
    depth: float | None = length("size out of plane", example=1.0, default=None)
    left_mass: float | None = quantity(
        "mass of the left column", unit="kg", symbol="m_AB", example=14400.0, default=None, gt=0, le=1e12
    )
    beam_mass: float | None = quantity(
        "mass of the beam", unit="kg", symbol="m_BC", example=21600.0, default=None, ge=0, le=1e12
    )
    right_mass: float | None = quantity(
        "mass of the right column", unit="kg", symbol="m_CD", example=18000.0, default=None, gt=0, le=1e12
    )

    @model_validator(mode="after")
    def _fits(self) -> Self:
        if self.spacing <= self.column_width:
            raise geometry_error(
                "spacing",
                f"the columns overlap: the distance between their axes ({self.spacing:g} m) must be more than "
                f"their width ({self.column_width:g} m)",
            )
        by_density = [self.density, self.depth]
        by_mass = [self.left_mass, self.beam_mass, self.right_mass]
        is_given = [value is not None for value in by_density + by_mass]
        if self.mass is None and is_given not in ([True] * 2 + [False] * 3, [False] * 2 + [True] * 3):
            raise geometry_error(
                "density",
                "give density and depth, or left_mass, beam_mass and right_mass: all of one set, none of the other",
            )
        if self.mass is not None and any(is_given):
            raise geometry_error(
                "mass", "cannot be combined with other masses: leave out density, depth and the three masses"
            )
        return self

    def total_mass(self) -> float | None:
        """Return the given mass of the structure; None if its bodies have their own masses, or masses by density."""
        return self.mass

    def bodies(self) -> Sequence[Body]:
        width, top, span = self.column_width, self.left_height, self.spacing
        areas = (width * self.left_height, (span + width) * self.beam_depth, width * self.right_height)
        if self.left_mass is not None and self.beam_mass is not None and self.right_mass is not None:
            masses = (self.left_mass, self.beam_mass, self.right_mass)
        else:
            per_area = (self.density or 1.0) * (self.depth or 1.0)
            masses = (per_area * areas[0], per_area * areas[1], per_area * areas[2])
        return (
            box("left column AB", masses[0], width, self.left_height, 1j * top / 2),
            box("beam BC", masses[1], span + width, self.beam_depth, span / 2 + 1j * (top + self.beam_depth / 2)),
            box("right column CD", masses[2], width, self.right_height, span + 1j * (top - self.right_height / 2)),
        )

    def hinges(self, direction: Direction) -> tuple[complex, complex, complex, complex]:
        """Return the positions of A, B, C and D at rest [m]; the left column's axis is x = 0, its foot y = 0."""
        sb, top, span = direction * self.column_width / 2, 1j * self.left_height, self.spacing
        return sb + 0j, -sb + top, span - sb + top, span + sb + top - 1j * self.right_height

    def joints(self, direction: Direction) -> Sequence[Joint]:
        left, beam, right = (body.name for body in self.bodies())
        a, b, c, d = self.hinges(direction)
        return (
            Joint("A" + direction.prime, a, (left,)),
            Joint("B" + direction.prime, b, (left, beam), face=beam),
            Joint("C" + direction.prime, c, (right, beam), face=beam),
            Joint("D" + direction.prime, d, (right,)),
        )

    def contacts(self, direction: Direction) -> Sequence[Contact]:
        return of_joints(self.joints(direction), self.friction)

    def motion(self, phi: Reals, direction: Direction) -> Sequence[RigidMotion]:
        return four_bar(phi, direction, *self.hinges(direction))

    def limit(self, direction: Direction) -> float:
        a, b, c, d = self.hinges(direction)
        end = min(four_bar_limit(direction, a, b, c, d), pi / 2)  # the linkage locks, or AB lies flat
        if four_bar_limit(direction, d, c, b, a) > pi / 2:  # CD lies flat: the same linkage driven from D
            turn = -direction * float(four_bar(np.array([pi / 2]), direction, d, c, b, a)[2].psi[0])
            # Driven from D, AB may turn back at its lock: only a turn that AB reaches by itself counts.
            if 0 < turn < end and isclose(
                abs(self.motion(np.array([turn]), direction)[2].psi[0]), pi / 2, rel_tol=1e-6
            ):
                end = turn
        return end

    def sketch(self) -> Sketch:
        left, beam, right = bodies = self.bodies()
        b, top, span = self.column_width / 2, 1j * self.left_height, self.spacing
        deep = top - 1j * self.right_height  # height of the right foot
        lower = span + deep if deep.imag < 0 else 0j  # the lower foot
        base = 1j * lower.imag
        sizes = [(2 * b, self.left_height), (span + 2 * b, self.beam_depth), (2 * b, self.right_height)]
        lengths = [
            Length("2b", lower - b, lower + b),
            Length("2H", complex(-b), -b + top),
            Length("2H₁", span + b + deep, span + b + top),
            Length("L", base, base + span),
            Length("2h", span + b + top, span + b + top + 1j * self.beam_depth),
        ]
        angles = []
        for direction in Direction:
            A, B, C, D = self.hinges(direction)
            lengths += [
                Length("R₀", A, left.centroid, direction, derived=True),
                Length("R₁", D, right.centroid, direction, derived=True),
                Length("r_BC", B, beam.centroid, direction, derived=True),
            ]
            angles += [Angle("φ₀", A, A + 1, B, direction), Angle("ψ_BC", B, C, beam.centroid, direction)]
        return Sketch(
            outlines={body.name: [rectangle(body.centroid, *size)] for body, size in zip(bodies, sizes, strict=True)},
            uniform=True,
            hinges={direction: self.joints(direction) for direction in Direction},
            lengths=lengths,
            angles=angles,
            ground=[(-4 * b + 0j, span / 2 + 0j, span / 2 + deep, span + 4 * b + deep)],
        )

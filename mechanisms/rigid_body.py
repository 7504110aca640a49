"""Any rigid body, given by its numbers, as a uniform polygon, or as the sum of its parts [paper, Section 2.2]."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from math import asin, pi, radians
from typing import ClassVar, Self

import numpy as np
from pydantic import model_validator

from mechanisms._shapes import ROUNDING_OVERLAP, BodyPart, Fillet, Plate, fillet, foot_is_cut, plates, united
from mechanisms.block import SingleBody
from rocking_cli.arrays import Bools
from rocking_cli.core import (
    Body,
    Contact,
    Direction,
    Length,
    Outline,
    Reals,
    Sketch,
    Solid,
    Vertex,
    geometry_error,
    length,
    polygon,
    quantity,
)
from rocking_cli.core.kinematics import Points
from rocking_cli.core.polygons import POINT_DISTANCE, fault_of, size_of

LEVEL_DIFFERENCE = 1e-6  # height difference of corners that count as level, over the smaller of width and height
MAX_CORNERS = 10_000
SHAPE_OPTIONS = (
    ("R", "alpha_deg", "inertia_ratio"),
    ("polygon",),
    ("parts",),
    ("mass", "centroid", "inertia", "left_foot", "right_foot"),
)
"""Alternative descriptions of the body, each with the fields that it requires."""


class RigidBody(SingleBody):
    """A rigid body; if its centroid is not above the middle of its feet, its two directions differ."""

    mechanism: ClassVar[str] = "rigid_body"
    title: ClassVar[str] = "any rigid body: by its inertia, as a polygon, or of parts"
    suits: ClassVar[str] = "one body of any shape: statue, boulder, gable, pinnacle"
    source: ClassVar[str] = "DeJong and Dimitrakopoulos (2014), Section 2.2"
    verified: ClassVar[str] = (
        "p^2 = m g R/I_O, eta = 1 - 2 m R^2 sin^2(alpha)/I_O; polygons against the block; rounded feet by Lagrange"
    )

    starter: ClassVar[tuple[str, ...]] = ("R", "alpha_deg", "inertia_ratio")

    R: float | None = length("distance from pivot to centroid", symbol="R", example=1.5, default=None)
    alpha_deg: float | None = quantity(
        "angle of R from the vertical", unit="deg", symbol="alpha", example=14.0, default=None, gt=0, lt=90
    )
    inertia_ratio: float | None = quantity(
        "moment of inertia about the pivot over m R^2 (4/3: a block, 1: a point mass)",
        symbol="I_O/(m R^2)",
        example=1.3333,
        default=None,
        ge=1,
        le=1e6,
    )
    polygon: list[Vertex] | None = quantity(
        "corners [x, y] in order around it; it stands on the two lowest, or is the silhouette of a body given by its "
        "mass, centroid, inertia and feet",
        unit="m",
        example=[[0.0, 0.0], [1.0, 0.0], [0.8, 3.0], [0.0, 3.0]],
        default=None,
        min_length=3,
        max_length=MAX_CORNERS,
    )
    parts: list[BodyPart] | None = quantity(
        "plates that make it, each {polygon, density, depth}, or an opening in one: {polygon, opening: true}",
        example=[
            {"polygon": [[0.0, 0.0], [1.0, 0.0], [1.0, 3.0], [0.0, 3.0]]},
            {"polygon": [[0.0, 3.0], [1.0, 3.0], [0.5, 4.0]]},
        ],
        default=None,
        min_length=1,
        max_length=100,
    )
    centroid: Vertex | None = quantity(
        "where its centroid is, [x, y]; with mass, inertia and both feet",
        unit="m",
        example=[0.0, 1.4],
        default=None,
    )
    inertia: float | None = quantity(
        "moment of inertia about the centroid", unit="kg m2", symbol="I_G", example=700.0, default=None, ge=0, le=1e21
    )
    left_foot: Vertex | None = quantity(
        "where it turns to the left, [x, y]", unit="m", example=[-0.35, 0.0], default=None
    )
    right_foot: Vertex | None = quantity(
        "where it turns to the right, [x, y]; on a step at another height", unit="m", example=[0.35, 0.0], default=None
    )
    drive: float = quantity(
        "share of the horizontal ground motion that acts in its plane: the cosine of the angle between the two",
        example=0.866,
        default=1.0,
        gt=0,
        le=1,
    )
    corner_radius: float | None = length(
        "radius of its rounded feet, on which it rolls", symbol="r", example=0.02, default=None
    )

    @model_validator(mode="after")
    def _one_description(self) -> Self:
        description = self._way
        if description in ("polygon", "parts"):
            self._check_shape(description)
        elif description == "centroid":
            self._check_feet()
        self._check_radius(description)
        for key in ("friction", "strength"):
            if self.drive < 1 and getattr(self, key) is not None:
                why = "the ground motion along the edge shears its foot too, so that its foot is not checked"
                raise geometry_error(key, f"cannot be combined with a drive below 1: {why}")
        return self

    @cached_property
    def _way(self) -> str:
        """Name of the field that describes the body."""
        begun = [keys for keys in SHAPE_OPTIONS if any(getattr(self, key) is not None for key in keys if key != "mass")]
        if not begun:
            raise geometry_error(
                "inertia_ratio",
                "is missing: give R, alpha_deg and inertia_ratio, or a polygon, or parts, or mass, centroid, inertia, "
                "left_foot and right_foot",
            )
        if begun == [("polygon",), SHAPE_OPTIONS[-1]]:
            begun = begun[1:]  # the polygon is then its silhouette
        if len(begun) > 1:
            second = next(key for key in begun[1] if getattr(self, key) is not None and key != "mass")
            raise geometry_error(
                second, f"cannot be combined with {begun[0][0]}: describe the body in one of the two ways"
            )
        missing = [key for key in begun[0] if getattr(self, key) is None]
        if missing:
            raise geometry_error(missing[0], f"give all of {', '.join(begun[0])}; {missing[0]} is missing")
        return begun[0][0] if begun[0][0] != "mass" else "centroid"

    def _check_shape(self, description: str) -> None:
        if description == "polygon" and (fault := fault_of(self._corners)):
            raise geometry_error("polygon", fault)
        holes = [hole for plate in self._plates for hole in plate.holes]
        if not self._feet[1].real > self._feet[0].real:
            second = np.sort(self._corners.imag)[1] - self._corners.imag.min()
            raise geometry_error(
                description,
                f"it stands on one corner, the next is {second:.4g} m higher: its two lowest corners must be level "
                f"with each other, to {self._level:.2g} m",
            )
        for foot in self._feet:
            if foot_is_cut(foot, holes, ROUNDING_OVERLAP * size_of(self._corners)):
                raise geometry_error(description, f"an opening takes away its foot at x = {foot.real:.4g} m")
        self._check_centroid(description)
        for direction in self.directions:
            if self.limit(direction) <= self.alpha(direction):
                raise geometry_error(
                    description,
                    f"in the {direction.label} direction another corner meets the ground before it can overturn",
                )

    def _check_feet(self) -> None:
        if self.polygon and (fault := fault_of(self._corners)):
            raise geometry_error("polygon", fault)
        left, right = self._feet
        if not right.real > left.real:
            raise geometry_error("right_foot", "is not to the right of left_foot")
        self._check_centroid("centroid")
        if not self._body.centroid.imag > max(left.imag, right.imag):
            raise geometry_error("centroid", "is not above both feet")

    def _check_centroid(self, field: str) -> None:
        (left, right), centroid = self._feet, self._body.centroid
        if not left.real < centroid.real < right.real:
            raise geometry_error(
                field,
                f"it cannot stand: its centroid (x = {centroid.real:.4g} m) is not above its foot "
                f"(x = {left.real:.4g} to {right.real:.4g} m)",
            )

    def _check_radius(self, description: str) -> None:
        if self.corner_radius is None:
            return
        if self.crushing is not None:
            raise geometry_error(
                "corner_radius", "cannot be combined with crushing: a foot is either rounded or crushes at its edge"
            )
        for direction in Direction:
            arm = self.arm(direction)
            if not (direction * arm.real < 0 < arm.imag):
                raise geometry_error(
                    "corner_radius",
                    f"is too large: in the {direction.label} direction the centroid is not between the centres of both "
                    "rounded feet, above them",
                )
            if description in ("polygon", "parts") and self.limit(direction) <= self.alpha(direction):
                raise geometry_error("corner_radius", "another corner meets the ground before it can overturn")

    @property
    def has_mass(self) -> bool:
        return self.total_mass() is not None

    def total_mass(self) -> float | None:
        """Return the mass of the structure: as given, or by densities and depths of its parts; None if not known."""
        weighed = self.parts is not None and all(
            each is not None for each in (*self._of_parts("density"), *self._of_parts("depth"))
        )
        if self.mass is None and weighed:
            return sum(sign * piece.mass for sign, piece in self._pieces)
        return super().total_mass()

    def volume(self) -> float:
        """Return the volume [m3]; the arcs of rounded feet of a polygon are exact, as in its inertia."""
        if self._way != "polygon":
            return super().volume()
        return self.given_depth * sum(sign * piece.mass for sign, piece in self._pieces)

    def solids(self) -> Mapping[str, Sequence[Solid]]:
        if self.mass is not None or not self.has_mass:
            return {}
        keys = ("density", "depth")
        density, depth = ([getattr(self, key)] if self.parts is None else self._of_parts(key) for key in keys)
        solids: list[Solid] = []
        for plate, rho, deep in zip(self._plates, density, depth, strict=True):
            solids += plate.solids(rho or 0.0, deep or 0.0)
            for cut in (cut for other, cut in self._fillets.values() if other is plate):
                solids += cut.solids(rho or 0.0, deep or 0.0)
        return {self._body.name: solids}

    def _of_parts(self, key: str) -> list[float | None]:
        """Return density or depth of every plate among the parts: its own, or else that of the body."""
        values = [getattr(part, key) for part in self.parts or () if not part.opening]
        return [each if each is not None else getattr(self, key) for each in values]

    @cached_property
    def _plates(self) -> list[Plate]:
        if self.parts is None:
            return [Plate(self._corners, (), 1.0)]
        per_area = np.ones(sum(not part.opening for part in self.parts))
        for key in ("density", "depth"):
            values = self._of_parts(key)
            given_values = [each for each in values if each is not None]
            if given_values and len(given_values) < len(values):
                solids = [k for k, part in enumerate(self.parts) if not part.opening]
                k = solids[values.index(None)]
                raise geometry_error(("parts", k, key), f"is missing: give {key} to all parts, or to the body")
            if given_values:
                per_area = per_area * np.array(given_values)
        return plates(self.parts, per_area.tolist())

    @cached_property
    def _fillets(self) -> dict[Direction, tuple[Plate, Fillet]]:
        """Rounded feet of the plates, by direction."""
        fillets: dict[Direction, tuple[Plate, Fillet]] = {}
        for direction, foot in zip(Direction, reversed(self._feet), strict=True):
            if self.corner_radius is None:
                continue
            (plate, *others) = [each for each in self._plates if np.abs(each.corners - foot).min() == 0]
            if others:
                raise geometry_error("corner_radius", f"two parts share the foot at x = {foot.real:.4g} m")
            try:
                fillets[direction] = plate, fillet(plate.corners, foot, -direction, self.corner_radius)
            except ValueError as error:
                raise geometry_error("corner_radius", str(error)) from None
        return fillets

    @cached_property
    def _pieces(self) -> list[tuple[int, Body]]:
        """Signed pieces whose sum is the body."""
        pieces = [piece for plate in self._plates for piece in plate.pieces]
        return pieces + [piece for plate, cut in self._fillets.values() for piece in cut.pieces(plate.per_area)]

    @cached_property
    def _corners(self) -> Points:
        if self.parts is not None:
            return np.concatenate(
                [part.corners for part in self.parts if not part.opening] or [np.zeros(1, np.complex128)]
            )
        return np.array([complex(*vertex) for vertex in self.polygon or []])

    @property
    def _stands(self) -> Bools:
        """Whether each corner is on the ground at rest."""
        level: Bools = self._corners.imag <= self._corners.imag.min() + self._level
        return level

    @property
    def _level(self) -> float:
        """Height up to which a corner counts as on the ground [m]."""
        narrow = min(np.ptp(self._corners.real), np.ptp(self._corners.imag))
        return float(max(LEVEL_DIFFERENCE * narrow, POINT_DISTANCE * size_of(self._corners)))

    @cached_property
    def _body(self) -> Body:
        if self._way == "polygon" and self.corner_radius is None:
            return polygon("body", 1.0, self._corners.tolist())
        if self._way in ("polygon", "parts"):
            whole = united("body", self._pieces)
            return replace(whole, mass=1.0, inertia=whole.inertia / whole.mass)
        if self._way == "centroid":
            assert self.mass is not None and self.inertia is not None and self.centroid is not None
            return Body("body", self.mass, self.inertia, complex(*self.centroid))
        assert self.R is not None and self.alpha_deg is not None and self.inertia_ratio is not None
        return Body("body", 1.0, (self.inertia_ratio - 1) * self.R**2, 1j * self.R * np.cos(radians(self.alpha_deg)))

    @cached_property
    def _feet(self) -> tuple[complex, complex]:
        if self._way in ("polygon", "parts"):
            low = self._corners[self._stands]
            return complex(low[low.real.argmin()]), complex(low[low.real.argmax()])
        if self.left_foot is not None and self.right_foot is not None:
            return complex(*self.left_foot), complex(*self.right_foot)
        assert self.R is not None and self.alpha_deg is not None
        b = self.R * np.sin(radians(self.alpha_deg))
        return complex(-b), complex(b)

    def bodies(self) -> Sequence[Body]:
        return (self._body,)

    def feet(self) -> tuple[complex, complex]:
        return self._feet

    def rolls(self, direction: Direction) -> float:
        return self.corner_radius or 0.0

    def pivot(self, direction: Direction) -> complex:
        """Return the end of the flat base [m]; if the sides of a rounded foot are not known, one radius inside it."""
        if self.corner_radius is not None and self._way in ("polygon", "parts"):
            return self._fillets[direction][1].start
        return super().pivot(direction) - direction * self.rolls(direction)

    def limit(self, direction: Direction) -> float:
        if self._way in ("polygon", "parts"):
            return float(self._meets_the_ground(self._corners[~self._stands], direction).min())
        # The centroid meets the ground, or before it a corner of the silhouette, after the body has overturned.
        meets = self._meets_the_ground(np.append(self._corners, self._body.centroid), direction)
        return float(meets[meets > self.alpha(direction)].min())

    def _meets_the_ground(self, points: Points, direction: Direction) -> Reals:
        """Return the rotations at which some points reach the ground [rad]."""
        away = points - self.centre(direction)
        turns = np.angle(away) if direction > 0 else pi - np.angle(away)
        if r := self.rolls(direction):
            turns = turns + np.array([asin(min(r / abs(each), 1.0)) for each in away])
        return np.asarray(turns)

    @property
    def driven(self) -> float:
        return self.drive

    def contacts(self, direction: Direction) -> Sequence[Contact] | None:
        return super().contacts(direction) if self.drive == 1 else None

    @property
    def unchecked(self) -> str:
        return "the ground motion along the edge, which `drive` leaves out, shears its foot too"

    def outlines(self) -> Sequence[Outline]:
        if self._way not in ("polygon", "parts"):
            return [self._corners.tolist()] if self.polygon else ()
        outlines = []
        for plate in self._plates:
            outline = plate.outline
            for cut in (cut for home, cut in self._fillets.values() if home is plate):
                outline = cut.rounded(outline)
            outlines.append(outline)
        return outlines

    def own_caution(self) -> str:
        if self._way != "centroid" or self.polygon is None:
            return ""
        early: dict[Direction, float] = {}
        for side in self.directions:
            ahead = side * (self._corners - self.centre(side)).real > self._level
            first = self._meets_the_ground(self._corners[ahead], side).min(initial=pi)
            if first <= self.alpha(side):
                early[side] = max(float(first), 0.0)
        if not early:
            return ""
        when = " and ".join(f"at {phi:.3g} rad in the {side.label} direction" for side, phi in early.items())
        return (
            f"its polygon reaches the ground beyond its foot {when}, before the critical rotation: it is taken to turn "
            "on about the same foot, although it would roll on to the next point."
        )

    def lengths(self) -> Sequence[Length]:
        if self.polygon is None and self.parts is None:
            return ()
        # Label only size and foot, as there may be many corners.
        z = self._corners
        (left, right), low, high = self._feet, z.imag.min(), z.imag.max()
        return (
            Length("foot", left, right),
            Length("height", complex(z.real.min(), low), complex(z.real.min(), high)),
            Length("width", complex(z.real.min(), high), complex(z.real.max(), high)),
        )

    def sketch(self) -> Sketch:
        if self._way == "centroid" and self.polygon:
            low = self._corners[self._stands]
            ends = low[low.real.argmin()], low[low.real.argmax()]
            elsewhere = np.abs(np.subtract(ends, self._feet)).max() > self._level
            note = f"drawn as its silhouette{', which stands elsewhere than on its feet' if elsewhere else ''}"
            return replace(super().sketch(), notes=[note], at_will=["body"] if elsewhere else [])
        if self._way not in ("polygon", "parts"):
            return replace(super().sketch(), notes=["its shape is not given: a disc of the same mass and inertia"])
        per_area = [plate.per_area for plate in self._plates]
        return replace(super().sketch(), uniform=max(per_area) == min(per_area))

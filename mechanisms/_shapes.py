"""The bodies of a linkage as users give them: a polygon, plates, a disc, point masses, or numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import pi
from typing import Self

import numpy as np
from pydantic import Field, model_validator

from mechanisms._plates import BodyPart, plates, united
from mechanisms._polygons import fault_of
from rocking_cli.core import Body, Outline, Vertex, disc, geometry_error, point, polygon, quantity
from rocking_cli.core.fields import Described
from rocking_cli.core.kinematics import area_of

SHAPES = ("polygon", "parts", "disc", "masses")


class Disc(Described):
    """A circular plate."""

    centre: Vertex = point("its centre")
    radius: float = quantity("its radius", unit="m", example=0.5, gt=0, le=1e6)


class Mass(Described):
    """A point mass."""

    mass: float = quantity("its mass", unit="kg", example=100.0, gt=0, le=1e15)
    at: Vertex = point("where it is")


@dataclass(frozen=True)
class Member:
    """A body with its shapes, and whether its mass is in kilograms or relative to those of other bodies."""

    body: Body
    outlines: Sequence[Outline]
    weighs: bool


class Shape(Described):
    """A rigid body, given by a shape, or by mass, centroid and inertia."""

    polygon: list[Vertex] | None = quantity(
        "corners [x, y] in order around it", unit="m", example=[[0.0, 0.0], [1.0, 0.0], [1.0, 3.0], [0.0, 3.0]],
        default=None, min_length=3, max_length=10_000,
    )  # fmt: skip
    parts: list[BodyPart] | None = quantity(
        "plates that make it, each {polygon, density, depth}, or an opening in one: {polygon, opening: true}",
        unit="m", default=None, min_length=1, max_length=100,
    )  # fmt: skip
    disc: Disc | None = Field(None, description="a round plate: {centre, radius}")
    masses: list[Mass] | None = Field(
        None, min_length=1, max_length=1000, description="masses at points, {mass, at} each, on a frame without mass"
    )
    density: float | None = quantity(
        "its density; if omitted, that of the structure", unit="kg/m3", default=None, gt=0, le=1e6
    )
    depth: float | None = quantity("its depth; if omitted, that of the structure", unit="m", default=None, gt=0, le=1e6)
    mass: float | None = quantity("its mass, instead of density and depth", unit="kg", default=None, gt=0, le=1e15)
    centroid: Vertex | None = point("its centroid, with mass and inertia", default=None)
    inertia: float | None = quantity("moment of inertia about the centroid", unit="kg m2", default=None, ge=0, le=1e21)

    @model_validator(mode="after")
    def _one_description(self) -> Self:
        given = [key for key in SHAPES if getattr(self, key) is not None]
        numbers = [key for key in ("centroid", "inertia") if getattr(self, key) is not None]
        if numbers:
            for key in ("mass", "centroid", "inertia"):
                if getattr(self, key) is None:
                    raise geometry_error(key, "is missing: give mass, centroid and inertia, all of them")
            if given and given != ["polygon"]:
                raise geometry_error(
                    given[0], "cannot be combined with centroid and inertia: only `polygon` can, for the drawing"
                )
        elif len(given) != 1:
            what = "give one of them" if given else "is missing: give a polygon, parts, a disc, masses, or numbers"
            raise geometry_error(given[1] if given else "polygon", what)
        if self.masses is not None:
            for key in ("mass", "density", "depth"):
                if getattr(self, key) is not None:
                    raise geometry_error(key, "cannot be combined with masses, which give their own values")
        if self.mass is not None and (self.density is not None or self.depth is not None):
            raise geometry_error("mass", "cannot be combined with density and depth: give one or the other")
        if self.polygon is not None and (fault := fault_of(np.array(self.corners))):
            raise geometry_error("polygon", fault)
        return self

    @property
    def corners(self) -> Outline:
        """Corners of the polygon, x + iy [m]; empty for other shapes."""
        return [complex(*vertex) for vertex in self.polygon or []]

    def member(self, name: str, density: float | None, depth: float | None) -> Member:
        """Return the body, with the density and depth of the structure unless the body has its own."""
        if self.inertia is not None and self.mass is not None and self.centroid is not None:
            body = Body(name, self.mass, self.inertia, complex(*self.centroid), tuple(self.corners))
            return Member(body, [self.corners] if self.polygon else [], True)
        if self.masses is not None:
            points = [(1, Body("", each.mass, 0.0, complex(*each.at))) for each in self.masses]
            return Member(united(name, points), [], True)
        own = self.density or density, self.depth or depth
        body, outlines = self._plate(name, own)
        if self.mass is not None:
            body = replace(body, mass=self.mass, inertia=body.inertia * self.mass / body.mass)
        return Member(body, outlines, self.mass is not None or self._is_weighed(own))

    def _plate(self, name: str, own: Sequence[float | None]) -> tuple[Body, Sequence[Outline]]:
        density, depth = (each or 1.0 for each in own)
        if self.polygon is not None:
            flat = polygon(name, 1.0, self.corners)
            mass = density * depth * abs(area_of(np.array(self.corners)))
            return replace(flat, mass=mass, inertia=mass * flat.inertia), [self.corners]
        if self.disc is not None:
            centre, radius = complex(*self.disc.centre), self.disc.radius
            mass = density * depth * pi * radius**2
            return Body(name, mass, mass * radius**2 / 2, centre), [disc(centre, radius)]
        per_area = [(part.density or density) * (part.depth or depth) for part in self._solids]
        found = plates(self.parts or [], per_area)
        whole = united(name, [piece for plate in found for piece in plate.pieces])
        return whole, [plate.outline for plate in found]

    @property
    def _solids(self) -> list[BodyPart]:
        return [part for part in self.parts or [] if not part.opening]

    def _is_weighed(self, own: Sequence[float | None]) -> bool:
        """Return whether density and depth are known, for the body or for all of its parts."""
        parts = [(part.density or own[0], part.depth or own[1]) for part in self._solids] or [(own[0], own[1])]
        return all(None not in each for each in parts)

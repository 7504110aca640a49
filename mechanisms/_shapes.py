"""Bodies as users give them: a polygon, plates with openings and rounded feet, a disc, point masses, or numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf, pi
from typing import Self

import numpy as np
from pydantic import Field, model_validator

from rocking_cli.core import (
    Body,
    Outline,
    Solid,
    Vertex,
    annular_sector,
    disc,
    geometry_error,
    point,
    polygon,
    quantity,
)
from rocking_cli.core.fields import Described
from rocking_cli.core.kinematics import Points, area_of, distance, inside
from rocking_cli.core.polygons import fault_of, gap, lies_within, overlap, pierced, size_of

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
        descriptions = [key for key in SHAPES if getattr(self, key) is not None]
        numbers = [key for key in ("centroid", "inertia") if getattr(self, key) is not None]
        if numbers:
            for key in ("mass", "centroid", "inertia"):
                if getattr(self, key) is None:
                    raise geometry_error(key, "is missing: give mass, centroid and inertia, all of them")
            if descriptions and descriptions != ["polygon"]:
                raise geometry_error(
                    descriptions[0], "cannot be combined with centroid and inertia: only `polygon` can, for the drawing"
                )
        elif len(descriptions) != 1:
            what = (
                "give one of them" if descriptions else "is missing: give a polygon, parts, a disc, masses, or numbers"
            )
            raise geometry_error(descriptions[1] if descriptions else "polygon", what)
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
        density_and_depth = self.density or density, self.depth or depth
        body, outlines = self._plate(name, density_and_depth)
        if self.mass is not None:
            body = replace(body, mass=self.mass, inertia=body.inertia * self.mass / body.mass)
        return Member(body, outlines, self.mass is not None or self._is_weighed(density_and_depth))

    def solids(self, density: float | None, depth: float | None) -> list[Solid]:
        """Return the uniform parts, with the density and depth of the structure unless the body has its own.

        There are none if the body has a mass, or if a density or depth is not known.
        """
        density_and_depth = self.density or density, self.depth or depth
        if self.mass is not None or self.masses is not None or not self._is_weighed(density_and_depth):
            return []
        own_density, own_depth = (each or 1.0 for each in density_and_depth)
        if self.polygon is not None:
            return [Solid.of_outline(self.corners, own_density, own_depth)]
        if self.disc is not None:
            return [Solid("disc", (self.disc.radius,), own_density, own_depth)]
        pairs = [(part.density or own_density, part.depth or own_depth) for part in self._solids]
        all_plates = plates(self.parts or [], [1.0] * len(pairs))
        return [solid for plate, pair in zip(all_plates, pairs, strict=True) for solid in plate.solids(*pair)]

    def _plate(self, name: str, density_and_depth: Sequence[float | None]) -> tuple[Body, Sequence[Outline]]:
        density, depth = (each or 1.0 for each in density_and_depth)
        if self.polygon is not None:
            flat = polygon(name, 1.0, self.corners)
            mass = density * depth * abs(area_of(np.array(self.corners)))
            return replace(flat, mass=mass, inertia=mass * flat.inertia), [self.corners]
        if self.disc is not None:
            centre, radius = complex(*self.disc.centre), self.disc.radius
            mass = density * depth * pi * radius**2
            return Body(name, mass, mass * radius**2 / 2, centre), [disc(centre, radius)]
        per_area = [(part.density or density) * (part.depth or depth) for part in self._solids]
        all_plates = plates(self.parts or [], per_area)
        whole = united(name, [piece for plate in all_plates for piece in plate.pieces])
        return whole, [plate.outline for plate in all_plates]

    @property
    def _solids(self) -> list[BodyPart]:
        return [part for part in self.parts or [] if not part.opening]

    def _is_weighed(self, density_and_depth: Sequence[float | None]) -> bool:
        """Return whether density and depth are known, for the body or for all of its parts."""
        parts = [
            (part.density or density_and_depth[0], part.depth or density_and_depth[1]) for part in self._solids
        ] or [(density_and_depth[0], density_and_depth[1])]
        return all(None not in each for each in parts)


MAX_TOUCHING_GAP = 1e-3  # largest distance of parts that touch, over the size of the body
ROUNDING_OVERLAP = 1e-6  # overlap of parts by rounding, over the size of the body
CORNER_SIDES = 24  # sides with which a rounded corner is drawn


class BodyPart(Described):
    """A plate of a body, or an opening in a plate."""

    polygon: list[Vertex] = quantity(
        "corners [x, y] in order around it", unit="m", example=[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], min_length=3,
        max_length=10_000,
    )  # fmt: skip
    density: float | None = quantity(
        "its density; if omitted, that of the body", unit="kg/m3", default=None, gt=0, le=1e6
    )
    depth: float | None = quantity("its depth; if omitted, that of the body", unit="m", default=None, gt=0, le=1e6)
    opening: bool = Field(False, description="whether it is cut out of the part that it lies in")

    @model_validator(mode="after")
    def _is_a_plate(self) -> Self:
        if fault := fault_of(self.corners):
            raise geometry_error("polygon", fault)
        if self.opening and (self.density is not None or self.depth is not None):
            key = "density" if self.density is not None else "depth"
            raise geometry_error(key, "an opening goes through the part it lies in: it has no density or depth")
        return self

    @property
    def corners(self) -> Points:
        """Corners of the part, x + iy [m]."""
        return np.array([complex(*vertex) for vertex in self.polygon])


@dataclass(frozen=True)
class Plate:
    """A part with its openings, and its mass per area [kg/m2]."""

    corners: Points
    holes: Sequence[Points]
    per_area: float

    @property
    def outline(self) -> Outline:
        """Outline as one closed line, which includes the openings [m]."""
        closed: list[complex] = pierced(self.corners, self.holes).tolist()
        return closed

    def solids(self, density: float, depth: float) -> list[Solid]:
        """Return the part and its openings as plates of a density [kg/m3] and depth [m]."""
        openings = [Solid.of_outline(hole.tolist(), density, depth, sign=-1) for hole in self.holes]
        return [Solid.of_outline(self.corners.tolist(), density, depth), *openings]

    @property
    def pieces(self) -> list[tuple[int, Body]]:
        """Signed pieces whose sum is the plate: the part (+1) and its openings (-1)."""
        return [(sign, _weighed(z, self.per_area)) for sign, z in [(1, self.corners), *((-1, z) for z in self.holes)]]


def plates(parts: Sequence[BodyPart], per_area: Sequence[float]) -> list[Plate]:
    """Return the plates of a body, each with its openings. Raises a geometry error if parts do not fit together."""
    solids = [k for k, part in enumerate(parts) if not part.opening]
    openings = [k for k, part in enumerate(parts) if part.opening]
    z = [part.corners for part in parts]
    size = size_of(np.concatenate([z[k] for k in solids])) if solids else 0.0
    if not solids:
        raise geometry_error("parts", "all of them are openings: nothing is left")
    for kind in (solids, openings):
        for at, k in enumerate(kind):
            for j in kind[:at]:
                if overlap(z[k], z[j], ROUNDING_OVERLAP * size):
                    why = f"it overlaps part {j + 1}: what both have in common would count twice"
                    raise geometry_error(("parts", k, "polygon"), why)
    _check_joined([z[k] for k in solids], solids, MAX_TOUCHING_GAP * size)
    holes: dict[int, list[Points]] = {k: [] for k in solids}
    for k in openings:
        home = next((j for j in solids if lies_within(z[k], z[j], ROUNDING_OVERLAP * size)), None)
        if home is None:
            why = "this opening lies in no part: it must be within one; cut it where parts meet"
            raise geometry_error(("parts", k, "polygon"), why)
        holes[home].append(z[k])
    return [Plate(z[k], holes[k], per_area[k]) for k in solids]


def _check_joined(z: Sequence[Points], names: Sequence[int], touch: float) -> None:
    """Raise a geometry error if a part is not connected to the others."""
    touching, nearest = {0}, dict.fromkeys(range(1, len(z)), inf)
    while nearest:
        for k, apart in nearest.items():
            nearest[k] = min(apart, *(gap(z[k], z[j]) for j in touching))
        touching = {k for k, apart in nearest.items() if apart <= touch}
        if not touching:
            k = min(nearest)
            why = f"it is joined to no other part: the nearest is {nearest[k]:.4g} m away"
            raise geometry_error(("parts", names[k], "polygon"), why)
        nearest = {k: apart for k, apart in nearest.items() if k not in touching}


def united(name: str, pieces: Sequence[tuple[int, Body]]) -> Body:
    """Return one body as the sum of pieces, of which those of sign -1 are subtracted."""
    mass = sum(sign * piece.mass for sign, piece in pieces)
    centroid = sum(sign * piece.mass * piece.centroid for sign, piece in pieces) / mass
    inertia = sum(sign * (piece.inertia + piece.mass * abs(piece.centroid - centroid) ** 2) for sign, piece in pieces)
    return Body(name, mass, max(inertia, 0.0), centroid)


@dataclass(frozen=True)
class Fillet:
    """A corner of a plate rounded by a circle that touches both of its sides.

    Parameters
    ----------
    corner, start, end : complex
        The corner, and the points at which the circle touches the base and the other side [m].
    centre : complex
        Centre of the circle [m].
    radius : float
        Radius of the circle [m].
    """

    corner: complex
    start: complex
    end: complex
    centre: complex
    radius: float

    @property
    def arc(self) -> Points:
        """Points of the circle, starting at the base [m]."""
        turn = np.angle((self.end - self.centre) / (self.start - self.centre))
        points: Points = self.centre + (self.start - self.centre) * np.exp(
            1j * turn * np.linspace(0, 1, CORNER_SIDES + 1)
        )
        return points

    def pieces(self, per_area: float) -> list[tuple[int, Body]]:
        """Return the pieces cut off the plate: the kite between both sides and the centre, less the sector."""
        kite = np.array([self.corner, self.start, self.centre, self.end])
        angles = np.angle(self.start - self.centre), np.angle((self.end - self.centre) / (self.start - self.centre))
        start, turn = (float(angle) for angle in angles)
        sector = annular_sector("", per_area, 0.0, self.radius, start, start + turn)
        moved = Body("", sector.mass, sector.inertia, sector.centroid + self.centre)
        return [(-1, _weighed(kite, per_area)), (1, moved)]

    def solids(self, density: float, depth: float) -> list[Solid]:
        """Return what is cut off a plate of a density [kg/m3] and depth [m]: the kite, less the sector."""
        kite = (self.corner, self.start, self.centre, self.end)
        angle = abs(float(np.angle((self.end - self.centre) / (self.start - self.centre))))
        sector = Solid("sector", (0.0, self.radius, angle), density, depth)
        return [Solid.of_outline(kite, density, depth, sign=-1), sector]

    def rounded(self, outline: Outline) -> Outline:
        """Return an outline with the arc in place of the corner."""
        z = np.asarray(outline)
        k = int(np.abs(z - self.corner).argmin())
        from_base, from_side = (
            abs(np.angle((z[k - 1] - z[k]) / (end - self.corner))) for end in (self.start, self.end)
        )
        arc = self.arc if from_base < from_side else self.arc[::-1]
        corners: list[complex] = np.concatenate([z[:k], arc, z[k + 1 :]]).tolist()
        return corners


def fillet(z: Points, foot: complex, inwards: int, radius: float) -> Fillet:
    """Return the fillet of a foot corner of a polygon. Raises `ValueError` if the radius does not fit.

    `inwards` is the sign of x towards the other foot.
    """
    k = int(np.abs(z - foot).argmin())
    sides = z[k - 1] - z[k], z[(k + 1) % len(z)] - z[k]
    base, other = sorted(sides, key=lambda side: abs(side.imag) - inwards * side.real)
    if not (inwards * base.real > 0 and abs(base.imag) <= ROUNDING_OVERLAP * abs(base)):
        raise ValueError("there is no level base at this foot to roll off")
    half = abs(np.angle(other / base)) / 2
    inset = radius / np.tan(half)
    if inset > min(abs(base), abs(other)):
        raise ValueError(f"is larger than the sides at the foot have room for, {min(abs(base), abs(other)):.4g} m")
    start = foot + inwards * inset
    return Fillet(
        foot, complex(start), complex(foot + inset * other / abs(other)), complex(start + 1j * radius), radius
    )


def foot_is_cut(foot: complex, holes: Sequence[Points], tolerance: float) -> bool:
    """Return whether an opening removes the foot of a body."""
    at = np.array([foot])
    return any(bool(inside(at, z)[0]) or distance(at, z)[0] <= tolerance for z in holes)


def _weighed(z: Points, per_area: float) -> Body:
    return polygon("", per_area * abs(area_of(z)), z.tolist())

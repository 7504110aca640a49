"""Plates that make one rigid body: what they weigh together, what is cut out of them, and their rounded feet."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from pydantic import Field, model_validator

from mechanisms._polygons import (
    Points,
    area_of,
    distance,
    fault_of,
    gap,
    inside,
    lies_within,
    overlap,
    pierced,
    size_of,
)
from rocking_cli.core import Body, Outline, Vertex, annular_sector, geometry_error, polygon, quantity
from rocking_cli.core.fields import Described

TOUCH = 1e-3  # of the size of the body: parts that are nearer touch
EXACT = 1e-6  # of it: how far one may reach into another by rounding
ARC = 24  # sides of a rounded corner as it is drawn


class BodyPart(Described):
    """A plate of a body, or an opening in one."""

    polygon: list[Vertex] = quantity(
        "corners [x, y] in order around it", unit="m", example=[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], min_length=3,
        max_length=1000,
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
        """Its corners, x + iy [m]."""
        return np.array([complex(*vertex) for vertex in self.polygon])

    def enlarged(self, factor: float) -> BodyPart:
        """The same part of a body of another size."""
        moved = [[factor * each for each in vertex] for vertex in self.polygon]
        depth = None if self.depth is None else factor * self.depth
        return self.model_copy(update={"polygon": moved, "depth": depth})


@dataclass(frozen=True)
class Plate:
    """A part with what is cut out of it, and its mass per area [kg/m2]."""

    corners: Points
    holes: Sequence[Points]
    per_area: float

    @property
    def outline(self) -> Outline:
        """Its shape as one line [m]."""
        found: list[complex] = pierced(self.corners, self.holes).tolist()
        return found

    @property
    def pieces(self) -> list[tuple[int, Body]]:
        """What it is the sum of: itself, less its openings."""
        return [(sign, _weighed(z, self.per_area)) for sign, z in [(1, self.corners), *((-1, z) for z in self.holes)]]


def plates(parts: Sequence[BodyPart], per_area: Sequence[float]) -> list[Plate]:
    """The parts of a body, each with the openings in it. Raises the error of a field where they do not fit together."""
    solids = [k for k, part in enumerate(parts) if not part.opening]
    openings = [k for k, part in enumerate(parts) if part.opening]
    z = [part.corners for part in parts]
    size = size_of(np.concatenate([z[k] for k in solids])) if solids else 0.0
    if not solids:
        raise geometry_error("parts", "all of them are openings: nothing is left")
    for kind in (solids, openings):
        for at, k in enumerate(kind):
            for j in kind[:at]:
                if overlap(z[k], z[j], EXACT * size):
                    why = f"it overlaps part {j + 1}: what both have in common would count twice"
                    raise geometry_error(("parts", k, "polygon"), why)
    _check_joined([z[k] for k in solids], solids, TOUCH * size)
    holes: dict[int, list[Points]] = {k: [] for k in solids}
    for k in openings:
        home = next((j for j in solids if lies_within(z[k], z[j], EXACT * size)), None)
        if home is None:
            why = "this opening lies in no part: it must be within one; cut it where parts meet"
            raise geometry_error(("parts", k, "polygon"), why)
        holes[home].append(z[k])
    return [Plate(z[k], holes[k], per_area[k]) for k in solids]


def _check_joined(z: Sequence[Points], names: Sequence[int], touch: float) -> None:
    """Refuse parts that hang on nothing."""
    joined, left = {0}, set(range(1, len(z)))
    while left:
        gaps = {k: min(gap(z[k], z[j]) for j in joined) for k in left}
        near = {k for k, apart in gaps.items() if apart <= touch}
        if not near:
            k = min(left)
            why = f"it is joined to no other part: the nearest is {gaps[k]:.4g} m away"
            raise geometry_error(("parts", names[k], "polygon"), why)
        joined, left = joined | near, left - near


def united(name: str, pieces: Sequence[tuple[int, Body]], outline: Outline = ()) -> Body:
    """One body of others, some of which are taken away (sign -1)."""
    mass = sum(sign * piece.mass for sign, piece in pieces)
    centroid = sum(sign * piece.mass * piece.centroid for sign, piece in pieces) / mass
    inertia = sum(sign * (piece.inertia + piece.mass * abs(piece.centroid - centroid) ** 2) for sign, piece in pieces)
    return Body(name, mass, max(inertia, 0.0), centroid, outline)


@dataclass(frozen=True)
class Fillet:
    """A corner of a plate rounded by a circle that touches both of its sides.

    Parameters
    ----------
    corner, start, end : complex
        The corner, and where the circle leaves the base and joins the other side [m].
    centre : complex
        Of the circle [m].
    radius : float
        [m].
    """

    corner: complex
    start: complex
    end: complex
    centre: complex
    radius: float

    @property
    def arc(self) -> Points:
        """Points of the circle, from the base on."""
        turn = np.angle((self.end - self.centre) / (self.start - self.centre))
        found: Points = self.centre + (self.start - self.centre) * np.exp(1j * turn * np.linspace(0, 1, ARC + 1))
        return found

    def pieces(self, per_area: float) -> list[tuple[int, Body]]:
        """What the plate loses: the kite between both sides and the centre, less the sector of the circle."""
        kite = np.array([self.corner, self.start, self.centre, self.end])
        angles = np.angle(self.start - self.centre), np.angle((self.end - self.centre) / (self.start - self.centre))
        start, turn = (float(angle) for angle in angles)
        sector = annular_sector("", per_area, 0.0, self.radius, start, start + turn)
        moved = Body("", sector.mass, sector.inertia, sector.centroid + self.centre)
        return [(-1, _weighed(kite, per_area)), (1, moved)]

    def rounded(self, outline: Outline) -> Outline:
        """An outline that has the corner, with the arc in its place."""
        z = np.asarray(outline)
        k = int(np.abs(z - self.corner).argmin())
        from_base, from_side = (
            abs(np.angle((z[k - 1] - z[k]) / (end - self.corner))) for end in (self.start, self.end)
        )
        arc = self.arc if from_base < from_side else self.arc[::-1]
        found: list[complex] = np.concatenate([z[:k], arc, z[k + 1 :]]).tolist()
        return found


def fillet(z: Points, foot: complex, inwards: int, radius: float) -> Fillet:
    """The rounded foot corner of a polygon; `inwards` is the sign of x towards its other foot. Raises `ValueError`."""
    k = int(np.abs(z - foot).argmin())
    sides = z[k - 1] - z[k], z[(k + 1) % len(z)] - z[k]
    base, other = sorted(sides, key=lambda side: abs(side.imag) - inwards * side.real)
    if not (inwards * base.real > 0 and abs(base.imag) <= EXACT * abs(base)):
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
    """Whether an opening takes the foot of a body away."""
    at = np.array([foot])
    return any(bool(inside(at, z)[0]) or distance(at, z)[0] <= tolerance for z in holes)


def _weighed(z: Points, per_area: float) -> Body:
    return polygon("", per_area * abs(area_of(z)), z.tolist())

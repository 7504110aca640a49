"""Rigid bodies: mass, moment of inertia about the centroid and position at rest, for common shapes.

`Solid` is a uniform part of a body, from whose sizes and density a mass follows: what a calculation sheet writes out.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf, pi
from typing import Literal

import numpy as np

from rocking_cli.core.kinematics import area_of
from rocking_cli.core.sketch import Outline
from rocking_cli.short_repr import short_repr


@short_repr
@dataclass(frozen=True)
class Body:
    """One rigid body of a mechanism.

    Parameters
    ----------
    name : str
        Name of the body.
    mass : float
        Mass [kg].
    inertia : float
        Moment of inertia about the centroid [kg m2].
    centroid : complex
        Position of the centroid at rest, x + iy [m].
    outline : sequence of complex
        Corners of the body at rest [m], for drawings only; empty if the shape is not known.

    Raises
    ------
    ValueError
        If mass or inertia is negative, infinite or not a number, or the centroid is not finite.
    """

    name: str
    mass: float
    inertia: float
    centroid: complex
    outline: Sequence[complex] = ()

    def __post_init__(self) -> None:
        for what, value, unit in (("mass", self.mass, "kg"), ("inertia", self.inertia, "kg m2")):
            if not 0 <= value < inf:
                raise ValueError(
                    f"the {what} of body {self.name!r} is {value:g} {unit}: it must be finite, and at least 0"
                )
        if not abs(self.centroid) < inf:
            raise ValueError(f"the centroid of body {self.name!r} is at {self.centroid:g} m: it must be finite")

    def shapes(self, drawn: Mapping[str, Sequence[Sequence[complex]]]) -> Sequence[Sequence[complex]]:
        """Return the outline of the body, or else the polygons in `drawn` under its name; empty if it has neither."""
        return [self.outline] if self.outline else drawn.get(self.name, ())


def weighed(bodies: Sequence[Body], factor: float) -> Sequence[Body]:
    """Return the bodies with all masses and inertias multiplied by a factor."""
    if factor == 1.0:
        return bodies
    return [replace(body, mass=factor * body.mass, inertia=factor * body.inertia) for body in bodies]


def box(name: str, mass: float, width: float, height: float, centroid: complex) -> Body:
    """Return a uniform rectangle of `width` by `height` [m] as a body."""
    across, up = width / 2, 1j * height / 2
    outline = tuple(centroid + corner for corner in (-across - up, across - up, across + up, up - across))
    return Body(name, mass, mass * (width**2 + height**2) / 12, centroid, outline)


def polygon(name: str, mass: float, vertices: Sequence[complex]) -> Body:
    """Return a uniform simple polygon as a body.

    `vertices` x + iy [m] are in either order; the area must not be zero.
    """
    # Triangles from one vertex rather than from the origin: no cancellation for a polygon far away.
    origin = vertices[0]
    z = np.asarray(vertices) - origin
    w = np.roll(z, -1)
    twice_area = (z.conj() * w).imag
    area = twice_area.sum() / 2
    centroid = (twice_area * (z + w)).sum() / (6 * area)
    polar = (twice_area * (abs(z) ** 2 + abs(w) ** 2 + (z.conj() * w).real)).sum() / (12 * area)
    inertia = max(float(mass * (polar - abs(centroid) ** 2)), 0.0)  # rounding could make it negative
    return Body(name, mass, inertia, complex(origin + centroid), tuple(vertices))


def annular_sector(name: str, density: float, inner: float, outer: float, start: float, end: float) -> Body:
    """Return a sector of a ring about the origin, between two polar angles, as a body.

    Parameters
    ----------
    name : str
        Name of the body.
    density : float
        Mass per area [kg/m2].
    inner, outer : float
        Radii [m].
    start, end : float
        Polar angles [rad] in either order.

    Returns
    -------
    Body
        The sector, with exact mass, inertia and centroid.
    """
    half = abs(end - start) / 2
    mass = density * (outer**2 - inner**2) * half
    reach = 2 / 3 * (outer**3 - inner**3) / (outer**2 - inner**2) * np.sinc(half / np.pi)
    centroid = complex(reach * np.exp(1j * (start + end) / 2))
    inertia = max(mass * ((outer**2 + inner**2) / 2 - float(reach) ** 2), 0.0)  # rounding could make it negative
    return Body(name, mass, inertia, centroid)


LEVEL_SHARE = 1e-9  # share of the size of a rectangle by which its corners may be off

SolidKind = Literal["rectangle", "polygon", "sector", "disc", "cone"]


@dataclass(frozen=True)
class Solid:
    """A uniform part of a body.

    Parameters
    ----------
    kind : {"rectangle", "polygon", "sector", "disc", "cone"}
        The shape: all but a cone are plates of a depth.
    sizes : tuple of float
        Width and height of a rectangle [m]; inner and outer radius [m] and angle [rad] of a sector of a ring; radius of
        a disc [m]; radius and height of a cone [m], and the scale of the similar cone that is taken out of it.
    density : float
        Density [kg/m3].
    depth : float
        Size out of plane [m]; 1 for a cone.
    corners : sequence of complex
        Corners of a polygon or a level rectangle, anticlockwise [m]; empty if its place is not known.
    sign : int
        1, or -1 for a part that is taken out.
    count : float
        Number of equal parts.
    """

    kind: SolidKind
    sizes: tuple[float, ...]
    density: float
    depth: float = 1.0
    corners: Sequence[complex] = ()
    sign: int = 1
    count: float = 1

    @classmethod
    def of_outline(cls, outline: Outline, density: float, depth: float, *, sign: int = 1) -> Solid:
        """Return a plate with these corners [m]: a level rectangle, or a polygon."""
        corners = tuple(complex(corner) for corner in outline)
        corners = corners if area_of(corners) > 0 else corners[::-1]
        x, y = (sorted(getattr(corner, part) for corner in corners) for part in ("real", "imag"))
        width, height = x[-1] - x[0], y[-1] - y[0]
        if len(corners) == 4 and abs(area_of(corners) - width * height) <= LEVEL_SHARE * width * height:
            return cls("rectangle", (width, height), density, depth, corners, sign)
        return cls("polygon", (), density, depth, corners, sign)

    @property
    def area(self) -> float:
        """Area in the plane [m2]; of a cone, its volume [m3]."""
        if self.kind == "polygon":
            return area_of(np.array(self.corners))
        if self.kind == "rectangle":
            return self.sizes[0] * self.sizes[1]
        if self.kind == "sector":
            inner, outer, angle = self.sizes
            return (outer**2 - inner**2) * angle / 2
        if self.kind == "disc":
            return pi * self.sizes[0] ** 2
        radius, height, removed = self.sizes
        return pi * radius**2 * height / 3 * (1 - removed**3)

    @property
    def mass(self) -> float:
        """Mass of all equal parts [kg], negative for a part that is taken out."""
        return self.sign * self.count * self.density * self.area * self.depth

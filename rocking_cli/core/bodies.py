"""Rigid bodies: mass, central moment of inertia and rest centroid of the shapes structures are made of."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf

import numpy as np


@dataclass(frozen=True)
class Body:
    """One rigid body of a mechanism, rigid in both directions of rocking.

    Parameters
    ----------
    name : str
        What it is.
    mass : float
        Mass [kg].
    inertia : float
        Moment of inertia about its centroid [kg m2].
    centroid : complex
        Rest position of its centroid, x + iy [m].
    outline : sequence of complex
        Its corners in that position [m], for pictures only; empty if its shape is not known.

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
        """Its outline, else the polygons that are drawn for it, by its name; none if its shape is not known."""
        return [self.outline] if self.outline else drawn.get(self.name, ())


def area_of(corners: Sequence[complex]) -> float:
    """Signed area of a polygon [m2]."""
    z = np.asarray(corners) - corners[0]
    return float((z.conj() * np.roll(z, -1)).imag.sum() / 2)


def weighed(bodies: Sequence[Body], factor: float) -> Sequence[Body]:
    """The same bodies with all masses and inertias multiplied."""
    if factor == 1.0:
        return bodies
    return [replace(body, mass=factor * body.mass, inertia=factor * body.inertia) for body in bodies]


def box(name: str, mass: float, width: float, height: float, centroid: complex) -> Body:
    """A uniform rectangle `width` by `height` [m]."""
    across, up = width / 2, 1j * height / 2
    outline = tuple(centroid + corner for corner in (-across - up, across - up, across + up, up - across))
    return Body(name, mass, mass * (width**2 + height**2) / 12, centroid, outline)


def polygon(name: str, mass: float, vertices: Sequence[complex]) -> Body:
    """A uniform simple polygon with `vertices` x + iy [m] in either order; its area must not be zero."""
    # Triangles from one vertex rather than from the origin: no cancellation for a polygon far away.
    origin = vertices[0]
    z = np.asarray(vertices) - origin
    w = np.roll(z, -1)
    twice_area = (z.conj() * w).imag
    area = twice_area.sum() / 2
    centroid = (twice_area * (z + w)).sum() / (6 * area)
    polar = (twice_area * (abs(z) ** 2 + abs(w) ** 2 + (z.conj() * w).real)).sum() / (12 * area)
    inertia = max(float(mass * (polar - abs(centroid) ** 2)), 0.0)  # rounding must not take it below
    return Body(name, mass, inertia, complex(origin + centroid), tuple(vertices))


def annular_sector(name: str, density: float, inner: float, outer: float, start: float, end: float) -> Body:
    """A sector of a ring about the origin between two polar angles.

    Parameters
    ----------
    name : str
        What it is.
    density : float
        Mass per area [kg/m2].
    inner, outer : float
        Radii [m].
    start, end : float
        Polar angles [rad] in either order.

    Returns
    -------
    Body
        With exact mass, inertia and centroid.
    """
    half = abs(end - start) / 2
    mass = density * (outer**2 - inner**2) * half
    reach = 2 / 3 * (outer**3 - inner**3) / (outer**2 - inner**2) * np.sinc(half / np.pi)
    centroid = complex(reach * np.exp(1j * (start + end) / 2))
    inertia = max(mass * ((outer**2 + inner**2) / 2 - float(reach) ** 2), 0.0)  # rounding must not take it below
    return Body(name, mass, inertia, centroid)

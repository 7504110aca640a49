"""Rigid bodies: mass, moment of inertia about the centroid and position at rest, for common shapes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf

import numpy as np

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

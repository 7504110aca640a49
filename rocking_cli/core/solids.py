"""Uniform parts of bodies, from whose sizes and density a mass follows: what a calculation sheet writes out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi
from typing import Literal

import numpy as np

from rocking_cli.core.kinematics import area_of
from rocking_cli.core.sketch import Outline

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

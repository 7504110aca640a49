"""A point mass on a massless rigid strut with a rigid base [paper, Table I]."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import pi
from typing import ClassVar

from mechanisms.block import SingleBody
from rocking_cli.core import Body, Direction, Length, Outline, Sketch, disc, length, rectangle


class PointMass(SingleBody):
    """A mass held above the middle of a rigid base: the simplest rocking structure."""

    mechanism: ClassVar[str] = "point_mass"
    title: ClassVar[str] = "point mass on a massless strut with a rigid base"
    suits: ClassVar[str] = "heavy top on a light support: lantern, tank"
    source: ClassVar[str] = "DeJong and Dimitrakopoulos (2014), Table I"
    verified: ClassVar[str] = "closed forms p^2 = g/R, lambda = tan(alpha), eta = cos(2 alpha)"

    base_width: float = length("width of the base", symbol="2b", example=1.0)
    height: float = length("height of the mass", symbol="h", example=4.0)

    def bodies(self) -> Sequence[Body]:
        return (Body("mass", 1.0, 0.0, 1j * self.height),)

    def feet(self) -> tuple[complex, complex]:
        return -self.base_width / 2 + 0j, self.base_width / 2 + 0j

    def limit(self, direction: Direction) -> float:
        return pi / 2 + self.alpha(direction)  # the mass is on the ground

    def outlines(self) -> Sequence[Outline]:
        thin = self._thin
        base = rectangle(0.5j * thin, self.base_width, thin)
        strut = rectangle(0.5j * (thin + self.height), 0.6 * thin, self.height - thin)
        return base, strut, disc(1j * self.height, 2.5 * thin)

    @property
    def _thin(self) -> float:
        """Thickness of the base in drawings [m]; the disc of the mass is five times as wide, and above the ground."""
        return min(0.02 * max(self.height, self.base_width), 0.3 * self.height)

    def lengths(self) -> Sequence[Length]:
        left, right = self.feet()
        edge = complex(min(left.real, -2.5 * self._thin))
        return Length("2b", left, right), Length("h", edge, edge + 1j * self.height)

    def sketch(self) -> Sketch:
        return replace(
            super().sketch(),
            notes=["the mass is a point, strut and base have none: not to scale"],
            at_will=["mass"],
        )

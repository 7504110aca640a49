"""A point mass on a massless rigid strut with a rigid base [paper, Table I]."""

from __future__ import annotations

from collections.abc import Sequence
from math import pi
from typing import ClassVar

from mechanisms._single_body import SingleBody
from rocking_cli.core import Body, Direction, length


class PointMass(SingleBody):
    """A mass held above the middle of a rigid base: the simplest rocking structure."""

    mechanism: ClassVar[str] = "point_mass"
    title: ClassVar[str] = "point mass on a massless strut with a rigid base"
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

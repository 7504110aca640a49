"""The rectangular rocking block [paper, Section 2.1; Housner 1963]."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import cos, pi, sin
from typing import ClassVar

from mechanisms._single_body import SingleBody
from rocking_cli.core import Body, Direction, Length, Outline, Sketch, box, length, rectangle


class Block(SingleBody):
    """A uniform rectangle on its base."""

    mechanism: ClassVar[str] = "block"
    title: ClassVar[str] = "rectangular block"
    suits: ClassVar[str] = "pedestal, pillar, cabinet, parapet, facade free at its top"
    source: ClassVar[str] = "DeJong and Dimitrakopoulos (2014), Eqs. 1-6; Housner (1963)"
    verified: ClassVar[str] = "closed forms p^2 = 3g/(4R), lambda = tan(alpha), eta = 1 - 1.5 sin^2(alpha)"

    width: float = length("width of the base", symbol="2b", example=0.7)
    height: float = length("height", symbol="2h", example=2.8)

    def bodies(self) -> Sequence[Body]:
        return (box("block", 1.0, self.width, self.height, 0.5j * self.height),)

    def feet(self) -> tuple[complex, complex]:
        return -self.width / 2 + 0j, self.width / 2 + 0j

    def limit(self, direction: Direction) -> float:
        return pi / 2  # the block lies on its side

    def rebound_from_impacts(self) -> float | None:
        """Return the rebound by Housner's impacts in sequence; None with masses on the block.

        See Sorrentino, Al Shawa and Decanini (2011).
        """
        if self.crushing is not None or any(load.force is None for load in self.loads or ()):
            return None
        sine, cosine = sin(self.alpha(Direction.POSITIVE)), cos(self.alpha(Direction.POSITIVE))
        return (1 - 1.5 * sine**2) ** 2 * abs(1 - 1.5 * cosine**2)

    def outlines(self) -> Sequence[Outline]:
        return (rectangle(0.5j * self.height, self.width, self.height),)

    def lengths(self) -> Sequence[Length]:
        left, right = self.feet()
        return Length("2b", left, right), Length("2h", left, left + 1j * self.height)

    def sketch(self) -> Sketch:
        return replace(super().sketch(), uniform=True)

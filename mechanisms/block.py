"""The rectangular rocking block [paper, Section 2.1; Housner 1963]."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import cos, pi, sin
from typing import ClassVar, Literal

from mechanisms._single_body import SingleBody
from rocking_cli.core import Body, Direction, Length, Mechanism, Outline, Sketch, box, length, quantity, rectangle


class Block(SingleBody):
    """A uniform rectangle on its base."""

    mechanism: ClassVar[str] = "block"
    title: ClassVar[str] = "rectangular block"
    suits: ClassVar[str] = "pedestal, pillar, cabinet, parapet, facade free at its top"
    source: ClassVar[str] = "DeJong and Dimitrakopoulos (2014), Eqs. 1-6; Housner (1963)"
    verified: ClassVar[str] = "closed forms p^2 = 3g/(4R), lambda = tan(alpha), eta = 1 - 1.5 sin^2(alpha)"

    width: float = length("width of the base", symbol="2b", example=0.7)
    height: float = length("height", symbol="2h", example=2.8)
    plane: Literal["width"] | None = quantity(
        "`width` if it cannot rock about its depth, as a part of a wall or held by what the file does not name",
        example="width",
        default=None,
    )

    def bodies(self) -> Sequence[Body]:
        return (box("block", 1.0, self.width, self.height, 0.5j * self.height),)

    def feet(self) -> tuple[complex, complex]:
        return -self.width / 2 + 0j, self.width / 2 + 0j

    def limit(self, direction: Direction) -> float:
        return pi / 2  # the block lies on its side

    def weaker_side(self) -> Mechanism | None:
        """Return the block as it rocks about its depth, if that is the weaker side; None if it is not, or not free.

        A block is taken to be alone, and not a part of a wall, if it leans on nothing, has no ties and no interlock,
        carries nothing but masses (no floor, no force, no mass per metre of wall), and `plane` is not given. Its masses
        are then above the middle of its depth. A wall given by the metre is at least as deep as it is thick, so that
        this never applies to it. With `crushing` the strip at its foot is known for the given side only.
        """
        masses = self.loads or ()
        alone = self.plane is None and self.one_sided is None and not (self.ties or self.interlock or self.crushing)
        if not alone or self.depth is None or not self.depth < self.width:
            return None
        if any(load.mass is None or load.floor is not None for load in masses):
            return None
        centred = [{**load.model_dump(exclude_unset=True), "at": [0.0, load.at[1]]} for load in masses]
        return self.model_copy(update={"width": self.depth, "depth": self.width, "loads": centred or None})

    def own_caution(self) -> str:
        """Return a caution if the block may rock about its depth, with the lambda of this side, and about a corner."""
        weaker = self.weaker_side()
        if weaker is None:
            return ""
        lambda_, other = (min(map(each.uplift, Direction)) for each in (self, weaker))
        return (
            f"Its depth, {self.depth:.4g} m, is less than its width: about its depth lambda is {other:.4g} instead of "
            f"{lambda_:.4g}, and that side governs unless something holds it. Exchange the two to analyse it, or give "
            "`plane: width`. Under motion oblique to its sides it rocks about a corner, which is not modelled."
        )

    def rebound_from_impacts(self) -> float | None:
        """Return the rebound by Housner's impacts in sequence; None with masses on the block.

        See Sorrentino, Al Shawa and Decanini (2011).
        """
        if self.crushing is not None or any(not load.is_force for load in self.loads or ()):
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

"""Cones, from thin shell to solid: the model of a masonry spire [paper, Table I; DeJong 2012]."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import atan2, pi
from typing import ClassVar, Literal, Self

from pydantic import model_validator

from mechanisms.block import ROUND_FOOT, SingleBody
from rocking_cli.core import Body, Direction, Length, Outline, Solid, geometry_error, length, quantity

SHELL_SCALE = 0.97  # size of the inner cone with which a thin shell is drawn


class Cone(SingleBody):
    """A circular cone on its base: a thin shell, solid, or hollow with a similar inner cone."""

    mechanism: ClassVar[str] = "cone"
    title: ClassVar[str] = "conical spire (shell, solid or hollow)"
    suits: ClassVar[str] = "spire, pinnacle"
    source: ClassVar[str] = "DeJong and Dimitrakopoulos (2014), Table I; DeJong (2012), Engineering Structures 40"
    verified: ClassVar[str] = "closed forms of shell and solid; the hollow cone tends to both"

    caution: ClassVar[str] = ROUND_FOOT
    starter: ClassVar[tuple[str, ...]] = ("kind",)

    base_radius: float = length("outer radius of the base", symbol="r", example=1.5)
    height: float = length("height of the apex", symbol="h", example=12.0)
    kind: Literal["shell", "solid", "hollow"] = quantity(
        "shell (thin lateral surface), solid or hollow", example="shell", default="shell"
    )
    inner_ratio: float | None = quantity(
        "size of the similar inner cone of a hollow one over the outer's", example=0.9, default=None, gt=0, lt=1
    )

    @model_validator(mode="after")
    def _ratio_belongs_to_hollow(self) -> Self:
        if self.kind == "hollow" and self.inner_ratio is None:
            raise geometry_error("inner_ratio", "a hollow cone needs inner_ratio, the size of its inner cone")
        if self.kind != "hollow" and self.inner_ratio is not None:
            raise geometry_error("inner_ratio", f"requires kind: hollow, got kind: {self.kind}")
        return self

    def bodies(self) -> Sequence[Body]:
        r, h = self.base_radius, self.height
        if self.kind == "shell":
            level, about_base = h / 3, r**2 / 4 + h**2 / 6
        else:
            k = self.inner_ratio or 0.0  # the inner cone, scaled by k, is taken out
            level = h / 4 * (1 - k**4) / (1 - k**3)
            about_base = (3 * r**2 / 20 + h**2 / 10) * (1 - k**5) / (1 - k**3)
        return (Body("cone", 1.0, about_base - level**2, 1j * level),)

    def round_foot(self) -> tuple[float, float] | None:
        k = self.inner_ratio or 0.0
        solid = 0.3 * (1 - k**5) / (1 - k**3)
        return self.base_radius, self.base_radius**2 * (0.5 if self.kind == "shell" else solid)

    def volume(self) -> float:
        """Return the volume of a solid or hollow cone [m3], without regard to `depth`; a thin shell has none."""
        if self.kind == "shell":
            return super().volume()
        return pi * self.base_radius**2 * self.height / 3 * (1 - (self.inner_ratio or 0.0) ** 3)

    def solids(self) -> Mapping[str, Sequence[Solid]]:
        if self.density is None or self.mass is not None:
            return {}
        sizes = (self.base_radius, self.height, self.inner_ratio or 0.0)
        return {"cone": [Solid("cone", sizes, self.density)]}

    def feet(self) -> tuple[complex, complex]:
        return -self.base_radius + 0j, self.base_radius + 0j

    def limit(self, direction: Direction) -> float:
        return pi - atan2(self.height, self.base_radius)  # the cone lies on its flank

    def outlines(self) -> Sequence[Outline]:
        left, right = self.feet()
        apex = 1j * self.height
        if self.kind == "solid":
            return ((left, right, apex),)
        k = self.inner_ratio or SHELL_SCALE  # k: size of the inner cone over the outer one; a shell is drawn thicker
        return ((left, k * left, k * apex, k * right, right, apex),)

    def lengths(self) -> Sequence[Length]:
        left, right = self.feet()
        return Length("r", 0j, right), Length("h", left, left + 1j * self.height)

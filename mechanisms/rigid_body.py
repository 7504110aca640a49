"""Any rigid body: by its R, alpha and inertia, or as a uniform polygon [paper, Section 2.2]."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from itertools import combinations
from math import pi, radians
from typing import Annotated, ClassVar, Self

import numpy as np
from pydantic import Field, model_validator

from mechanisms._single_body import SingleBody
from rocking_cli.core import Body, Direction, Length, Outline, Sketch, geometry_error, length, polygon, quantity

Coordinate = Annotated[float, Field(ge=-1e6, le=1e6)]
Vertex = Annotated[list[Coordinate], Field(min_length=2, max_length=2)]
LEVEL = 1e-9  # of the polygon's size: how level two corners must be to stand on both


class RigidBody(SingleBody):
    """A rigid body; as a polygon it may lean, and then its two directions differ."""

    mechanism: ClassVar[str] = "rigid_body"
    title: ClassVar[str] = "any rigid body, by its inertia or as a uniform polygon"
    source: ClassVar[str] = "DeJong and Dimitrakopoulos (2014), Section 2.2"
    verified: ClassVar[str] = "p^2 = m g R/I_O, eta = 1 - 2 m R^2 sin^2(alpha)/I_O; polygons against the block"

    starter: ClassVar[tuple[str, ...]] = ("R", "alpha_deg", "inertia_ratio")

    R: float | None = length("distance from pivot to centroid", symbol="R", example=1.5, default=None)
    alpha_deg: float | None = quantity(
        "angle of R from the vertical", unit="deg", symbol="alpha", example=14.0, default=None, gt=0, lt=90
    )
    inertia_ratio: float | None = quantity(
        "moment of inertia about the pivot over m R^2 (4/3: a block, 1: a point mass)",
        symbol="I_O/(m R^2)",
        example=1.3333,
        default=None,
        ge=1,
        le=1e6,
    )
    polygon: list[Vertex] | None = quantity(
        "corners [x, y] in order around it; it stands on the two lowest",
        unit="m",
        example=[[0.0, 0.0], [1.0, 0.0], [0.8, 3.0], [0.0, 3.0]],
        default=None,
        min_length=3,
    )

    @model_validator(mode="after")
    def _one_description(self) -> Self:
        numbers = {"R": self.R, "alpha_deg": self.alpha_deg, "inertia_ratio": self.inertia_ratio}
        missing = [key for key, value in numbers.items() if value is None]
        if self.polygon is None:
            if missing:
                raise geometry_error(
                    missing[0], f"give R, alpha_deg and inertia_ratio, or a polygon; {missing[0]} is missing"
                )
            return self
        if len(missing) < len(numbers):
            raise geometry_error("polygon", "a polygon needs no R, alpha_deg or inertia_ratio: give one or the other")
        self._check_polygon(np.array([complex(*vertex) for vertex in self.polygon]))
        return self

    def _check_polygon(self, z: np.ndarray) -> None:
        size = np.ptp(z.real) + np.ptp(z.imag)
        edges = list(zip(z, np.roll(z, -1), strict=True))
        if any(abs(one - other) <= LEVEL * size for one, other in combinations(z, 2)):
            raise geometry_error("polygon", "two corners are the same point; the last need not repeat the first")
        if abs((z.conj() * np.roll(z, -1)).imag.sum()) / 2 <= LEVEL * size**2 or any(
            _meet(*one, *other) for one, other in combinations(edges, 2)
        ):
            raise geometry_error(
                "polygon", "its sides cross or enclose nothing: list the corners in order around the outline"
            )
        if not self._feet[1].real > self._feet[0].real:
            raise geometry_error(
                "polygon", "it stands on one corner: its two lowest corners must be level with each other"
            )
        if not self._feet[0].real < self._body.centroid.real < self._feet[1].real:
            raise geometry_error(
                "polygon",
                f"it cannot stand: its centroid (x = {self._body.centroid.real:.4g} m) is not above its foot "
                f"(x = {self._feet[0].real:.4g} to {self._feet[1].real:.4g} m)",
            )
        for direction in Direction:
            if self.limit(direction) <= self.alpha(direction):
                raise geometry_error(
                    "polygon",
                    f"in the {direction.label} direction another corner meets the ground before it can overturn",
                )

    @cached_property
    def _body(self) -> Body:
        if self.polygon is not None:
            return polygon("body", 1.0, [complex(*vertex) for vertex in self.polygon])
        assert self.R is not None and self.alpha_deg is not None and self.inertia_ratio is not None
        return Body("body", 1.0, (self.inertia_ratio - 1) * self.R**2, 1j * self.R * np.cos(radians(self.alpha_deg)))

    @cached_property
    def _feet(self) -> tuple[complex, complex]:
        if self.polygon is not None:
            z = np.array([complex(*vertex) for vertex in self.polygon])
            low = z[z.imag <= z.imag.min() + LEVEL * (np.ptp(z.real) + np.ptp(z.imag))]
            return complex(low[low.real.argmin()]), complex(low[low.real.argmax()])
        assert self.R is not None and self.alpha_deg is not None
        b = self.R * np.sin(radians(self.alpha_deg))
        return complex(-b), complex(b)

    def bodies(self) -> Sequence[Body]:
        return (self._body,)

    def feet(self) -> tuple[complex, complex]:
        return self._feet

    def limit(self, direction: Direction) -> float:
        if self.polygon is None:
            return pi / 2 + self.alpha(direction)  # no outline: until the centroid is on the ground
        left, right = self._feet
        arms = np.array([complex(*vertex) for vertex in self.polygon]) - (right if direction > 0 else left)
        above = arms[arms.imag > LEVEL * abs(arms).max()]
        turns = np.angle(above) if direction > 0 else pi - np.angle(above)
        return float(turns.min())  # the next corner meets the ground

    def outlines(self) -> Sequence[Outline]:
        return ([complex(*vertex) for vertex in self.polygon],) if self.polygon is not None else ()

    def lengths(self) -> Sequence[Length]:
        if self.polygon is None:
            return ()
        # Its size, and its foot: the corners themselves are too many to be written on it.
        x, y = zip(*self.polygon, strict=True)
        left, right = self._feet
        return (
            Length("foot", left, right),
            Length("height", complex(min(x), min(y)), complex(min(x), max(y))),
            Length("width", complex(min(x), max(y)), complex(max(x), max(y))),
        )

    def sketch(self) -> Sketch:
        if self.polygon is not None:
            return replace(super().sketch(), uniform=True)
        return replace(super().sketch(), notes=["its shape is not given: a disc of the same mass and inertia"])


def _meet(a: complex, b: complex, c: complex, d: complex) -> bool:
    """Whether two sides ab and cd cross or touch; neighbours share a corner, and only neighbours do."""
    if len({a, b, c, d}) < 4:
        return False

    def side(p: complex, q: complex, r: complex) -> float:
        return float(np.sign(((q - p).conjugate() * (r - p)).imag))

    def within(p: complex, q: complex, r: complex) -> bool:
        return side(p, q, r) == 0 and ((r - p) * (r - q).conjugate()).real <= 0

    crosses = side(a, b, c) != side(a, b, d) and side(c, d, a) != side(c, d, b)
    return crosses or within(a, b, c) or within(a, b, d) or within(c, d, a) or within(c, d, b)

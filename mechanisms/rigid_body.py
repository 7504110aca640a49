"""Any rigid body: by its R, alpha and inertia, or as a uniform polygon [paper, Section 2.2]."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from math import pi, radians
from typing import ClassVar, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator

from mechanisms._single_body import SingleBody
from rocking_cli.core import (
    Body,
    Direction,
    Length,
    Outline,
    Reals,
    Sketch,
    Vertex,
    geometry_error,
    length,
    polygon,
    quantity,
)

SAME = 1e-9  # of the polygon's size: points that are nearer are one
LEVEL = 1e-6  # of its width or height, the smaller: nobody measures finer how level two corners are
MOST = 10_000  # corners
Points = NDArray[np.complex128]
Indices = NDArray[np.intp]
Bools = NDArray[np.bool_]


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
        max_length=MOST,
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
        self._check_polygon()
        return self

    def _check_polygon(self) -> None:
        z, size = self._corners, self._size
        if _any_alike(z, SAME * size):
            raise geometry_error("polygon", "two corners are the same point; the last need not repeat the first")
        if abs((z.conj() * np.roll(z, -1)).imag.sum()) / 2 <= SAME * size**2 or _any_meet(z):
            raise geometry_error(
                "polygon", "its sides cross or enclose nothing: list the corners in order around the outline"
            )
        if not self._feet[1].real > self._feet[0].real:
            second = np.sort(z.imag)[1] - z.imag.min()
            raise geometry_error(
                "polygon",
                f"it stands on one corner, the next is {second:.4g} m higher: its two lowest corners must be level "
                f"with each other, to {self._level:.2g} m",
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
    def _corners(self) -> Points:
        return np.array([complex(*vertex) for vertex in self.polygon or []])

    @property
    def _size(self) -> float:
        return float(np.ptp(self._corners.real) + np.ptp(self._corners.imag))

    @property
    def _stands(self) -> Bools:
        """Which corners are on the ground at rest."""
        level: Bools = self._corners.imag <= self._corners.imag.min() + self._level
        return level

    @property
    def _level(self) -> float:
        """Height up to which a corner is on the ground [m]."""
        narrow = min(np.ptp(self._corners.real), np.ptp(self._corners.imag))
        return float(max(LEVEL * narrow, SAME * self._size))

    @cached_property
    def _body(self) -> Body:
        if self.polygon is not None:
            return polygon("body", 1.0, self._corners.tolist())
        assert self.R is not None and self.alpha_deg is not None and self.inertia_ratio is not None
        return Body("body", 1.0, (self.inertia_ratio - 1) * self.R**2, 1j * self.R * np.cos(radians(self.alpha_deg)))

    @cached_property
    def _feet(self) -> tuple[complex, complex]:
        if self.polygon is not None:
            low = self._corners[self._stands]
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
        above = self._corners[~self._stands] - (right if direction > 0 else left)
        turns = np.angle(above) if direction > 0 else pi - np.angle(above)
        return float(turns.min())  # the next corner meets the ground

    def outlines(self) -> Sequence[Outline]:
        return (self._corners.tolist(),) if self.polygon is not None else ()

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


def _nearby(low: Points, high: Points) -> Iterator[tuple[Indices, Indices]]:
    """Pairs of boxes that overlap or touch, given their lower left and upper right corners, many at a time."""
    order = np.argsort(low.real, kind="stable")
    low, high = low[order], high[order]
    for step in range(1, len(order)):
        first = np.flatnonzero(low.real[step:] <= high.real[:-step])
        if first.size == 0:
            return  # boxes that are further apart in this order begin even further to the right
        second = first + step
        meet = (low.imag[second] <= high.imag[first]) & (low.imag[first] <= high.imag[second])
        if meet.any():
            yield order[first[meet]], order[second[meet]]


def _any_alike(z: Points, tolerance: float) -> bool:
    """Whether two points are within a tolerance of each other."""
    around = tolerance * (1 + 1j)
    return any((np.abs(z[i] - z[j]) <= tolerance).any() for i, j in _nearby(z, z + around))


def _any_meet(z: Points) -> bool:
    """Whether two sides of a polygon cross or touch; neighbours share a corner, and only neighbours do."""
    w = np.roll(z, -1)
    low = np.minimum(z.real, w.real) + 1j * np.minimum(z.imag, w.imag)
    high = np.maximum(z.real, w.real) + 1j * np.maximum(z.imag, w.imag)
    for i, j in _nearby(low, high):
        apart = (z[i] != z[j]) & (z[i] != w[j]) & (w[i] != z[j]) & (w[i] != w[j])
        if _meet(z[i][apart], w[i][apart], z[j][apart], w[j][apart]).any():
            return True
    return False


def _meet(a: Points, b: Points, c: Points, d: Points) -> Bools:
    """Whether sides ab and cd, which share no corner, cross or touch."""

    def side(p: Points, q: Points, r: Points) -> Reals:
        u, v = q - p, r - p
        turns: Reals = np.sign(u.real * v.imag - u.imag * v.real)
        return turns

    def within(p: Points, q: Points, r: Points, where: Reals) -> Bools:
        u, v = r - p, r - q
        return np.asarray((where == 0) & (u.real * v.real + u.imag * v.imag <= 0))

    of_c, of_d, of_a, of_b = side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b)
    touch = within(a, b, c, of_c) | within(a, b, d, of_d) | within(c, d, a, of_a) | within(c, d, b, of_b)
    crosses: Bools = (of_c != of_d) & (of_a != of_b)
    return crosses | touch

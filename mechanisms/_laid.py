"""Blocks laid by a rule: the voussoirs of a circular arch, and the bricks of a wall in running bond with openings."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import atan2, pi
from typing import Annotated, Any, Self

import numpy as np
from pydantic import Field, model_validator

from rocking_cli.arrays import Integers, Points, Reals
from rocking_cli.core import Outline, Vertex, geometry_error, point, quantity
from rocking_cli.core.fields import Described

SIDES_OF_CURVE = 4  # straight sides of each curved face of a voussoir
MAX_BRICKS = 10_000
FLOOR_MARGIN = 1.0  # distance by which the floor reaches beyond a wall [m]
OPENING, BRICK = -1, 0  # codes of what fills half a brick of a course; lintels count from 1

Box = Annotated[list[Annotated[float, Field(ge=-1e6, le=1e6)]], Field(min_length=4, max_length=4)]
Size = Annotated[float, Field(gt=0, le=1e6)]


class Voussoirs(Described):
    """Equal voussoirs of a circular arch between radial springings."""

    span: float = quantity("clear span between the springings", unit="m", example=6.0, gt=0, le=1e6)
    rise: float = quantity(
        "rise of the intrados above the springings, up to half the span", unit="m", example=2.0, gt=0, le=1e6
    )
    thickness: float = quantity("thickness of the ring", unit="m", example=0.5, gt=0, le=1e6)
    count: int = Field(description="number of voussoirs", examples=[11], ge=1, le=1000)
    at: Vertex = point("midpoint between the springings; if omitted, [0, 0]", default=[0.0, 0.0])

    @model_validator(mode="after")
    def _is_an_arc(self) -> Self:
        if self.rise > (1 + 1e-9) * self.span / 2:
            raise geometry_error("rise", f"is {self.rise:g} m, but must be at most half the span, {self.span / 2:g} m")
        return self

    @property
    def _half_angle(self) -> float:
        return 2 * atan2(2 * self.rise, self.span)

    def _point(self, radius: float, angle: float | Reals) -> Any:
        """Return points at a distance from the intrados [m] and an angle from the horizontal."""
        intrados = self.span**2 / (8 * self.rise) + self.rise / 2
        return complex(*self.at) + 1j * (self.rise - intrados) + (intrados + radius) * np.exp(1j * angle)

    def blocks(self) -> dict[str, Outline]:
        """Return the corners of each voussoir, from the left."""
        joints = pi / 2 + self._half_angle * np.linspace(1, -1, self.count + 1)
        turns = [np.linspace(start, end, SIDES_OF_CURVE + 1) for start, end in pairwise(joints)]
        rings = [np.concatenate([self._point(self.thickness, t), self._point(0.0, t)[::-1]]) for t in turns]
        return {f"v{k}": _rounded(ring) for k, ring in enumerate(rings, 1)}

    def ground(self) -> dict[str, Outline]:
        """Return the corners of the two springings, as thick as the ring."""
        sides = {"left": 1, "right": -1}
        return {name: self._springing(sign) for name, sign in sides.items()}

    def _springing(self, sign: int) -> Outline:
        angle = pi / 2 + sign * self._half_angle
        joint = np.array([self._point(0.0, angle), self._point(self.thickness, angle)])
        below = joint + sign * self.thickness * 1j * np.exp(1j * angle)
        return _rounded(np.concatenate([joint, below[::-1]]))


class Bricks(Described):
    """A wall of bricks or stones in running bond, from its lower left corner at [0, 0]."""

    wall: Annotated[list[Size], Field(min_length=2, max_length=2)] = quantity(
        "length and height of the wall", unit="m", example=[6.0, 4.0]
    )
    length: float = quantity("length of a brick", unit="m", example=0.5, gt=0, le=1e6)
    height: float = quantity("height of a course", unit="m", example=0.25, gt=0, le=1e6)
    openings: Annotated[list[Box], Field(max_length=100)] = quantity(
        "openings [x0, y0, x1, y1], from the lower left to the upper right corner, each with a lintel of one course "
        "that bears half a brick", unit="m", default=[], example=[[2.0, 0.0, 3.0, 2.0]],
    )  # fmt: skip

    @model_validator(mode="after")
    def _fits(self) -> Self:
        count = self.wall[0] * self.wall[1] / (self.length * self.height)
        if count > MAX_BRICKS:
            raise geometry_error("length", f"makes about {count:.3g} bricks: at most {MAX_BRICKS} can be analysed")
        for k, (x0, y0, x1, y1) in enumerate(self.openings):
            where, (length, height) = ("openings", k), self.wall
            if not (x0 < x1 and y0 < y1):
                raise geometry_error(where, "is not [x0, y0, x1, y1] with x0 < x1 and y0 < y1")
            if x0 < 0 or y0 < 0 or x1 > length or y1 > height:
                raise geometry_error(where, f"reaches beyond the wall, {length:g} m long and {height:g} m high")
            left, low, right, high = self._cells(k)
            if left == right or low == high:
                least = f"{self.length / 2:g} m long and {self.height:g} m high"
                raise geometry_error(where, f"is smaller than half a brick: an opening must be at least {least}")
        return self

    @property
    def _edges(self) -> tuple[Reals, Reals]:
        """Places of the half bricks along the wall, and of the courses up it [m].

        The last half brick takes what is left of the length; courses share the height equally.
        """
        halves = max(1, round(2 * self.wall[0] / self.length))
        courses = max(1, round(self.wall[1] / self.height))
        along = np.append(np.arange(halves) * self.length / 2, self.wall[0])
        return along, np.linspace(0.0, self.wall[1], courses + 1)

    def _cells(self, k: int) -> tuple[int, int, int, int]:
        """Return the half bricks and courses between which an opening lies: those nearest to its edges."""
        x, y = self._edges
        box = self.openings[k]
        left, right = (int(np.abs(x - each).argmin()) for each in box[::2])
        low, high = (int(np.abs(y - each).argmin()) for each in box[1::2])
        return left, low, right, high

    def _cut(self, k: int) -> list[float]:
        """Return an opening moved to the edges of bricks: left, bottom, right and top [m]."""
        left, low, right, high = self._cells(k)
        x, y = self._edges
        return [float(each) for each in (x[left], y[low], x[right], y[high])]

    def notes(self) -> Iterator[str]:
        """Yield what differs from what is given: the height of courses, and openings cut at the edges of bricks."""
        courses = self._edges[1]
        if abs(courses[1] - self.height) > 1e-9 * self.height:
            yield f"bricks: {len(courses) - 1} courses of {courses[1]:.4g} m fill the height of {self.wall[1]:g} m"
        for k, given in enumerate(self.openings):
            if np.abs(np.subtract(cut := self._cut(k), given)).max() > 1e-9 * max(self.wall):
                shown = ", ".join(f"{each:.4g}" for each in cut)
                yield f"bricks: opening {k + 1} is cut at the edges of bricks, [{shown}] m"

    def _filled(self) -> Integers:
        """Return what fills each half brick of each course, shape (courses, half bricks)."""
        x, y = self._edges
        cells = np.full((len(y) - 1, len(x) - 1), BRICK)
        boxes = [self._cells(k) for k in range(len(self.openings))]
        for left, low, right, high in boxes:
            cells[low:high, left:right] = OPENING
        for k, (left, _, right, high) in enumerate(boxes):
            if high == len(cells):
                continue
            lintel = cells[high, max(left - 1, 0) : right + 1]
            if (lintel != BRICK).any():
                what = "leaves no place for its lintel: keep a course above it and a brick beside it"
                raise geometry_error(("bricks", "openings", k), what)
            lintel[:] = k + 1
        return cells

    def blocks(self) -> dict[str, Outline]:
        """Return the corners of bricks, `COURSE.NUMBER` from the lower left, and lintels. Raises a geometry error."""
        x, y = self._edges
        blocks: dict[str, Outline] = {}
        for course, row in enumerate(self._filled()):
            low, high = float(y[course]), float(y[course + 1])
            for number, (start, end) in enumerate(_pieces(course, row), 1):
                name = f"{course + 1}.{number}" if row[start] == BRICK else f"lintel {row[start]}"
                left, right = float(x[start]), float(x[end])
                blocks[name] = _box(left, low, right, high)
        return blocks

    def ground(self) -> dict[str, Outline]:
        """Return the corners of the floor."""
        return {"floor": _box(-FLOOR_MARGIN, -FLOOR_MARGIN / 2, self.wall[0] + FLOOR_MARGIN, 0.0)}


def _pieces(course: int, row: Integers) -> Iterator[tuple[int, int]]:
    """Yield the first half brick of each piece of a course and the one after its last, without openings."""
    changes = [0, *(np.flatnonzero(np.diff(row)) + 1).tolist(), len(row)]
    for start, end in pairwise(changes):
        if row[start] == BRICK:
            # Upright joints are above the middles of the bricks below.
            joints = [k for k in range(start + 1, end) if (k - course) % 2 == 0]
            yield from pairwise([start, *joints, end])
        elif row[start] != OPENING:
            yield start, end


def _rounded(corners: Points) -> Outline:
    """Return corners to the nanometre, so that a level joint is level in print."""
    return [complex(z) for z in np.round(corners, 9) + 0.0]


def _box(left: float, low: float, right: float, high: float) -> Outline:
    return [complex(left, low), complex(right, low), complex(right, high), complex(left, high)]

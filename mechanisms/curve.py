"""A structure given by its capacity curve, as from a discrete or finite element analysis."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import cached_property
from itertools import pairwise
from math import hypot, pi, sqrt
from pathlib import Path
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationInfo, model_validator

from rocking_cli.core import (
    Body,
    Direction,
    Mechanism,
    Reals,
    RigidMotion,
    Sketch,
    geometry_error,
    length,
    quantity,
)
from rocking_cli.errors import InputError
from rocking_cli.io.files import read_bytes

Points = NDArray[np.complex128]
GAUSS_NODES, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(5)
LIMIT_PIECES = 100  # pieces of the integration to the limit, beside those between the points of the curve
FILE_FIELDS = {"points": "file", "negative_points": "negative_file"}
"""Field with the name of the file from which each list of points may be read."""


class Curve(Mechanism):
    """One rigid body that represents the structure: its centroid moves in the direction that the curve gives.

    With the ratio r(phi), G = m R sin(beta), B = m R cos(beta), tan(beta) = r, R constant: G/B is the curve, and the
    inertia is constant, in both directions. This is exact for a single rigid body on two feet. If R differs between the
    directions, the body rotates less in the direction of the larger R, so that the inertia is the given one in both.
    """

    mechanism: ClassVar[str] = "curve"
    title: ClassVar[str] = "structure given by its capacity curve"
    suits: ClassVar[str] = "structure whose capacity curve comes from another program"
    source: ClassVar[str] = "DeJong and Dimitrakopoulos (2014), Eqs. 8-10, with G/B from another analysis"
    verified: ClassVar[str] = "the block from its own curve"
    caution: ClassVar[str] = (
        "The inertia is held constant, and restitution from kinematics is that of one rigid body on two feet: of a "
        "structure of several bodies give a measured one."
    )

    jumps: ClassVar[str] = (
        "its capacity curve, at phi times control_height, is as steep as a step there, and no history can follow it. "
        "Let the ratio change over more displacement"
    )

    starter: ClassVar[tuple[str, ...]] = ("points",)

    points: list[list[float]] | None = quantity(
        "curve: [displacement of the control point in m, ratio V'/(g B)], from uplift at rest to zero or beyond",
        example=[[0.0, 0.25], [0.35, 0.123], [0.69, 0.0], [1.0, -0.112]],
        default=None,
        min_length=2,
        max_length=10_000,
    )
    file: str | None = quantity(
        "instead: a CSV file of these two columns, in the folder of this file", example="pushover.csv", default=None
    )
    negative_points: list[list[float]] | None = quantity(
        "the same of the negative direction, away from rest; if omitted, that of the positive",
        default=None,
        min_length=2,
        max_length=10_000,
    )
    negative_file: str | None = quantity("instead: its file", example="pushover_back.csv", default=None)
    control_height: float = length("height of the control point: phi is its displacement over it", example=2.8)
    centroid_height: float = length("drive of the ground at rest over the mass, B(0)/m", symbol="h_c", example=1.4)
    mass: float = quantity("mass of what moves", unit="kg", symbol="m", example=1000.0, gt=0, le=1e15)
    inertia: float = quantity(
        "kinetic inertia I(0) at rest; of a rigid body, about its pivot", unit="kg m2", symbol="I", example=2780.0,
        gt=0, le=1e21,
    )  # fmt: skip

    @model_validator(mode="before")
    @classmethod
    def _read_files(cls, data: Any, info: ValidationInfo) -> Any:
        """Replace the files of curves by their points, so that the structure does not depend on the files."""
        if not isinstance(data, dict):
            return data
        data = dict(data)
        for key, from_file in FILE_FIELDS.items():
            if not isinstance(name := data.get(from_file), str):
                continue
            if data.get(key) is not None:
                raise geometry_error(from_file, f"cannot be combined with {key}: give the curve in one of the two")
            folder = (info.context or {}).get("folder") or Path()
            try:
                points, lines = read_curve(folder / name)
                if fault := fault_of(points):
                    raise ValueError(f"line {lines[fault[0]]}: the curve {fault[1]}")
            except InputError as error:
                raise geometry_error(from_file, f"{name}: {error.problems[0].message}") from None
            except ValueError as error:
                raise geometry_error(from_file, f"{name}: {error}") from None
            data = {**data, key: points, from_file: None}
        return data

    @model_validator(mode="after")
    def _fits(self) -> Self:
        if self.points is None:
            raise geometry_error("points", "is missing: give the points of the curve, or a file that has them")
        for key in FILE_FIELDS:
            self._check_points(key, getattr(self, key) or [])
        for key in ("loads", "ties", "interlock", "density"):
            if getattr(self, key) is not None:
                raise geometry_error(key, "all that acts on the structure is in its curve: have it in the analysis")
        arm = max(self._arm(direction) for direction in Direction)
        if self.inertia < self.mass * arm**2:
            raise geometry_error(
                "inertia",
                f"is less than a point mass would have: at least m h_c^2 (1 + r(0)^2) = {self.mass * arm**2:.6g} kg m2",
            )
        return self

    def _check_points(self, key: str, points: Sequence[Point]) -> None:
        for k, point in enumerate(points):
            if len(point) != 2:
                raise geometry_error((key, k), "must be two numbers: displacement and ratio")
        if points and (fault := fault_of(points)):
            raise geometry_error((key, fault[0]), f"the curve {fault[1]}")
        if points and points[-1][0] >= pi / 2 * self.control_height:
            raise geometry_error(
                "control_height", f"the curve continues to {points[-1][0]:g} m, beyond a quarter turn about the foot"
            )

    @cached_property
    def _ratios(self) -> dict[Direction, MonotoneCubic]:
        """The ratio r as a function of phi, for each direction."""
        curves = [np.array(points) for points in (self.points, self.negative_points or self.points)]
        return {
            direction: MonotoneCubic(curve[:, 0] / self.control_height, curve[:, 1])
            for direction, curve in zip(Direction, curves, strict=True)
        }

    def _arm(self, direction: Direction) -> float:
        """Return R, the displacement of the centroid per rad [m]."""
        return self.centroid_height * hypot(1.0, float(self._ratios[direction].y[0]))

    @property
    def bends(self) -> bool:
        return True

    @property
    def smooth(self) -> bool:
        return all(len(ratio.x) == 2 for ratio in self._ratios.values())

    def bodies(self) -> Sequence[Body]:
        central = max(self._central(direction) for direction in Direction)
        return (Body("structure", self.mass, central, 1j * self.centroid_height),)

    def _central(self, direction: Direction) -> float:
        """Return the moment of inertia about the centroid that gives the total inertia [kg m2]."""
        return max(self.inertia - self.mass * self._arm(direction) ** 2, 0.0)

    def _turning(self, direction: Direction) -> float:
        """Return the ratio of the body's rotation to phi: 1, or less in the direction with the larger R."""
        largest = max(self._central(each) for each in Direction)
        return sqrt(self._central(direction) / largest) if largest > 0 else 1.0

    def motion(self, phi: Reals, direction: Direction) -> Sequence[RigidMotion]:
        ratio, arm = self._ratios[direction], self._arm(direction)
        r, slope = ratio(phi)
        bend = slope / (1 + r**2)  # derivative of beta by phi
        path = self._way(phi, direction)
        speed: Points = arm * _along(r, direction)
        change: Points = 1j * direction * bend * speed
        rest, none, turns = 1j * self.centroid_height, np.zeros_like(phi), -direction * self._turning(direction)
        return (RigidMotion(rest, rest + arm * path, speed, change, turns * phi, none + turns, none),)

    def _way(self, phi: Reals, direction: Direction) -> Points:
        """Return the integral of s cos(beta) + i sin(beta) over phi, starting at rest."""
        ratio = self._ratios[direction]

        def between(start: Reals, end: Reals) -> Points:
            half = (end - start)[:, None] / 2
            r, _ = ratio((start + end)[:, None] / 2 + half * GAUSS_NODES)
            integral: Points = (half * GAUSS_WEIGHTS * _along(r, direction)).sum(axis=1)
            return integral

        knots = np.union1d(ratio.x, np.linspace(0.0, self.limit(direction), LIMIT_PIECES + 1))
        sums = np.concatenate([[0.0], np.cumsum(between(knots[:-1], knots[1:]))])
        k = np.clip(np.searchsorted(knots, phi, side="right") - 1, 0, len(knots) - 1)
        return sums[k] + between(knots[k], phi)

    def enlarged(self, factor: float) -> Self:
        """Return a structure of another size: displacements of the curve are multiplied, ratios stay."""
        moved = {
            key: [[factor * d, r] for d, r in points]
            for key in FILE_FIELDS
            if (points := getattr(self, key)) is not None
        }
        sizes = {key: factor * getattr(self, key) for key in ("control_height", "centroid_height")}
        return self.model_copy(update={**moved, **sizes, "inertia": factor**2 * self.inertia})

    def limit(self, direction: Direction) -> float:
        return pi / 2  # the body lies flat

    def sketch(self) -> Sketch:
        return Sketch(notes=["the body stands for the structure: its centroid moves as the capacity curve says"])


def _along(r: Reals, direction: Direction) -> Points:
    """Return the unit vector of the centroid's motion: sideways in the direction of rocking, upwards r times as far."""
    return np.asarray((direction + 1j * r) * (1 / np.sqrt(1 + r**2)), np.complex128)


MAX_FILE_BYTES = 10_000_000
Point = list[float]


def read_curve(path: Path) -> tuple[list[Point], list[int]]:
    """Return the two columns of a file, and the line of each row. Raises `InputError`, or `ValueError` with a line."""
    text = read_bytes(path, "capacity curve", MAX_FILE_BYTES).decode("utf-8-sig", "replace")
    points: list[Point] = []
    lines: list[int] = []
    for number, line in enumerate(text.splitlines(), 1):
        cells = [cell for cell in re.split(r"[,;\s]+", line.partition("#")[0].strip()) if cell]
        if not cells:
            continue
        try:
            row = [float(cell) for cell in cells]
        except ValueError:
            if not points and not any(re.match(r"[-+.\d]", cell) for cell in cells):
                continue  # names of the columns
            raise ValueError(f"line {number} is not two numbers, displacement and ratio: write 0.05, 0.21") from None
        if len(row) != 2:
            hint = "; write a decimal point, not a comma" if "," in line else ""
            raise ValueError(f"line {number} has {len(row)} numbers, not two: displacement and ratio{hint}")
        points.append(row)
        lines.append(number)
    if len(points) < 2:
        raise ValueError("has fewer than two rows of displacement and ratio")
    return points, lines


MAX_VALUE = 1e6  # largest displacement [m] and largest ratio
MIN_VALUE = 1e-12  # least number other than zero: slopes of smaller values overflow


def fault_of(points: Sequence[Point]) -> tuple[int, str] | None:
    """Return why points [displacement, ratio] are not a capacity curve, and the index of the first bad one.

    None if they are a capacity curve.
    """
    if not np.isfinite(points).all():
        return int(np.argmin(np.isfinite(points).all(axis=1))), "must be finite numbers"
    for k, values in enumerate(points):
        if any(0 < abs(value) < MIN_VALUE for value in values):
            return k, f"has a value closer to zero than {MIN_VALUE:g}: write 0"
        if any(abs(value) > MAX_VALUE for value in values):
            return k, f"has a value beyond {MAX_VALUE:g}: displacements are in m, ratios over g"
    if points[0][0] != 0:
        return 0, f"begins at {points[0][0]:g} m: the first point is at rest, with the ratio at uplift"
    for k, ((d, _), (after, _)) in enumerate(pairwise(points), 1):
        if after == d:
            return k, f"has two ratios at {d:g} m: give one ratio per displacement"
        if after < d:
            return k, f"goes back from {d:g} to {after:g} m: displacements must increase"
    if points[0][1] <= 0:
        return 0, (
            f"has the ratio {points[0][1]:g} at zero displacement, but a rocking structure resists before it moves. "
            "Leave out the elastic branch: the curve starts with the ratio at uplift"
        )
    last = len(points) - 1
    if points[last][1] > 0:
        return last, (
            f"ends at the ratio {points[last][1]:g}: continue to zero, where the critical rotation is, or beyond"
        )
    if points[last][1] >= points[last - 1][1]:
        return last, "does not decrease at its end: beyond the critical rotation the structure must overturn"
    return None


class MonotoneCubic:
    """A cubic interpolation that rises and falls only where its points do, and is linear after the last.

    Parameters
    ----------
    x, y : ndarray, shape (n,)
        The points; x increases.

    Notes
    -----
    Fritsch and Butland (1984): slopes are weighted harmonic means of those of both sides, zero at a turn.
    """

    def __init__(self, x: Reals, y: Reals) -> None:
        self.x, self.y = x, y
        h, s = np.diff(x), np.diff(y) / np.diff(x)
        one, other = 2 * h[1:] + h[:-1], h[1:] + 2 * h[:-1]
        with np.errstate(divide="ignore", invalid="ignore"):
            mean = (one + other) / (one / s[:-1] + other / s[1:])
        self.slope = np.concatenate([[s[0]], np.where(s[:-1] * s[1:] > 0, mean, 0.0), [s[-1]]])
        if len(s) > 1:
            for end, beside, next_ in ((0, 0, 1), (-1, -1, -2)):
                three = ((2 * h[beside] + h[next_]) * s[beside] - h[beside] * s[next_]) / (h[beside] + h[next_])
                self.slope[end] = s[beside] * np.clip(three / s[beside], 0.1, 3.0) if s[beside] else 0.0

    def __call__(self, x: Reals) -> tuple[Reals, Reals]:
        """Return value and slope at `x`, an array of any shape."""
        k = np.clip(np.searchsorted(self.x, x, side="right") - 1, 0, len(self.x) - 2)
        h = self.x[k + 1] - self.x[k]
        u = np.minimum((x - self.x[k]) / h, 1.0)
        a, b, da, db = self.y[k], self.y[k + 1], h * self.slope[k], h * self.slope[k + 1]
        value = a + u * (da + u * (3 * (b - a) - 2 * da - db + u * (2 * (a - b) + da + db)))
        slope = (da + u * (2 * (3 * (b - a) - 2 * da - db) + 3 * u * (2 * (a - b) + da + db))) / h
        return value + self.slope[-1] * np.maximum(x - self.x[-1], 0.0), slope

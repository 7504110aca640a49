"""Capacity curves: points read from a file, checked, and interpolated by a monotone cubic."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np

from rocking_cli.core import Reals
from rocking_cli.io.files import read_bytes

LARGEST = 10_000_000  # size of a file, at most [bytes]
Point = list[float]


def read_curve(path: Path) -> tuple[list[Point], list[int]]:
    """Return the two columns of a file, and the line of each row. Raises `InputError`, or `ValueError` with a line."""
    text = read_bytes(path, "capacity curve", LARGEST).decode("utf-8-sig", "replace")
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


MOST = 1e6  # displacements [m] and ratios, at most
LEAST = 1e-12  # least displacement or ratio other than zero: slopes of smaller ones overflow


def fault_of(points: Sequence[Point]) -> tuple[int, str] | None:
    """Return why points [displacement, ratio] are not a capacity curve, and the index of the first bad one.

    None if they are a capacity curve.
    """
    if not np.isfinite(points).all():
        return int(np.argmin(np.isfinite(points).all(axis=1))), "must be finite numbers"
    for k, values in enumerate(points):
        if any(0 < abs(value) < LEAST for value in values):
            return k, f"has a value closer to zero than {LEAST:g}: write 0"
        if any(abs(value) > MOST for value in values):
            return k, f"has a value beyond {MOST:g}: displacements are in m, ratios over g"
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
            for end, near, next_ in ((0, 0, 1), (-1, -1, -2)):
                three = ((2 * h[near] + h[next_]) * s[near] - h[near] * s[next_]) / (h[near] + h[next_])
                self.slope[end] = s[near] * np.clip(three / s[near], 0.1, 3.0) if s[near] else 0.0

    def __call__(self, x: Reals) -> tuple[Reals, Reals]:
        """Return value and slope at `x`, an array of any shape."""
        k = np.clip(np.searchsorted(self.x, x, side="right") - 1, 0, len(self.x) - 2)
        h = self.x[k + 1] - self.x[k]
        u = np.minimum((x - self.x[k]) / h, 1.0)
        a, b, da, db = self.y[k], self.y[k + 1], h * self.slope[k], h * self.slope[k + 1]
        value = a + u * (da + u * (3 * (b - a) - 2 * da - db + u * (2 * (a - b) + da + db)))
        slope = (da + u * (2 * (3 * (b - a) - 2 * da - db) + 3 * u * (2 * (a - b) + da + db))) / h
        return value + self.slope[-1] * np.maximum(x - self.x[-1], 0.0), slope

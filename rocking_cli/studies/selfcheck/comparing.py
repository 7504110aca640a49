"""How far numbers are apart: by their values, or by their bits."""

from __future__ import annotations

from math import inf
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray


def largest_difference(found: ArrayLike, expected: ArrayLike) -> float:
    """Return the largest difference between two rows of numbers; infinity if any is missing or not a number."""
    one, other = np.asarray(found, dtype=np.float64), np.asarray(expected, dtype=np.float64)
    if one.shape != other.shape or not np.isfinite([one, other]).all():
        return inf
    return float(np.abs(one - other).max(initial=0.0))


def different_values(one: NDArray[Any], other: NDArray[Any]) -> int:
    """Return how many values of two arrays of one shape and type differ in any bit; NaN has one value."""
    first, second = (np.ascontiguousarray(each).view(np.uint8).reshape(each.size, -1) for each in (one, other))
    neither = np.isnan(one).ravel() & np.isnan(other).ravel()
    return int(((first != second).any(axis=1) & ~neither).sum())

"""Median without `numpy.median`, which imports masked arrays and so takes as long as a short time history."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FEWEST, FEWEST_OF_MEDIAN = 20, 5
"""Motions from which on a quantile is told, and the median: of fewer, a single motion decides it."""


def median(values: NDArray[np.float64]) -> float:
    """Return the median of one or more numbers, equal to that of `numpy.median` to the last bit."""
    ordered = np.sort(values)
    if np.isnan(ordered[-1]):  # they come last
        return np.nan
    return float(ordered[(ordered.size - 1) // 2] + ordered[ordered.size // 2]) / 2

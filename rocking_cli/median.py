"""The median; that of numpy imports its masked arrays, which takes as long as a short history."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def median(values: NDArray[np.float64]) -> float:
    """Return what `numpy.median` would, to the last bit, of one or more numbers."""
    ordered = np.sort(values)
    if np.isnan(ordered[-1]):  # they come last
        return np.nan
    return float(ordered[(ordered.size - 1) // 2] + ordered[ordered.size // 2]) / 2

"""Types of arrays, by the type of their entries; and the median of one."""

import numpy as np
from numpy.typing import NDArray

Reals = NDArray[np.float64]
Integers = NDArray[np.int64]
Bools = NDArray[np.bool_]
Points = NDArray[np.complex128]
"""Points of the plane, as complex numbers x + iy [m]."""


def median(values: Reals) -> float:
    """Return the median of an array that is not empty; NaN if an entry is. That of numpy imports its masked arrays."""
    ordered, half = np.sort(values, axis=None), values.size // 2
    return float(ordered[-1] if np.isnan(ordered[-1]) else (ordered[half] + ordered[half - 1 + values.size % 2]) / 2)

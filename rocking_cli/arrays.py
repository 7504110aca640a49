"""Types of arrays, by the type of their entries."""

import numpy as np
from numpy.typing import NDArray

Reals = NDArray[np.float64]
Integers = NDArray[np.int64]
Bools = NDArray[np.bool_]
Points = NDArray[np.complex128]
"""Points of the plane, as complex numbers x + iy [m]."""

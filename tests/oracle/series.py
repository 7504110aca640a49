"""Derivatives of analytic functions from their values on a small circle around a point (Cauchy's integral)."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Complexes = NDArray[np.complex128]
Reals = NDArray[np.float64]
Booleans = NDArray[np.bool_]

POINTS = 16
RADIUS = 0.02  # [rad]; (radius/distance to the next singularity)^16 is lost, and eps/radius to rounding
_K = np.arange(POINTS)
CIRCLE: Complexes = np.exp(2j * np.pi * (_K + 0.5) / POINTS)  # no point of it is real: nothing there is 0/0
_TO_COEFFICIENTS = CIRCLE[None, :] ** -_K[:, None] / POINTS
_DIFFERENTIATE = (CIRCLE[:, None] ** (_K[None, :] - 1) * _K[None, :]) @ _TO_COEFFICIENTS


def around(centre: float, radius: float = RADIUS) -> Complexes:
    """The points of the circle."""
    return centre + radius * CIRCLE


def differentiated(values: Any, radius: float = RADIUS) -> Complexes:
    """The derivative at the points of the circle of a function given there along the last axis."""
    return np.asarray(values) @ _DIFFERENTIATE.T / radius


def derivatives(values: Any, order: int, radius: float = RADIUS) -> Reals:
    """Value and first `order` derivatives at the centre, along the first axis, of a function real on the real axis."""
    values = np.asarray(values)
    factorial, result = 1.0, []
    for k in range(order + 1):
        factorial *= max(k, 1) / (radius if k else 1.0)
        result.append((values @ _TO_COEFFICIENTS[k]).real * factorial)
    return np.array(result)

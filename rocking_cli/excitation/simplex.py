"""Maximum of a function of a few variables, without derivatives, by the simplex method of Nelder and Mead."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

Reals = NDArray[np.float64]


def maximise(
    f: Callable[[Reals], float], start: Reals, steps: Sequence[float], *, within: float, most: int = 600
) -> tuple[float, Reals]:
    """Return the largest value of a function near a start, and its point.

    Parameters
    ----------
    f : callable
        Function of a point, shape (n,); minus infinity where it is not defined.
    start : ndarray, shape (n,)
        Point to start from, where f is finite.
    steps : sequence of float
        Size of the first simplex along each coordinate, which is the scale of the coordinate.
    within : float
        Size of the last simplex along each coordinate, over `steps`.
    most : int
        Largest number of steps.

    Notes
    -----
    Nelder and Mead (1965): reflect the worst corner, and expand or contract the simplex according to the result.
    """
    scale = np.asarray(steps, dtype=np.float64)
    corners = start + np.vstack([np.zeros(scale.size), np.diag(scale)])
    values = np.array([f(corner) for corner in corners])
    for _ in range(most):
        order = np.argsort(-values, kind="stable")
        corners, values = corners[order], values[order]
        if (np.ptp(corners, axis=0) < within * scale).all():
            break
        middle, worst = corners[:-1].mean(axis=0), corners[-1]
        trial = 2 * middle - worst
        value = f(trial)
        if value > values[0]:
            further = 3 * middle - 2 * worst
            if (far := f(further)) > value:
                trial, value = further, far
        elif value <= values[-2]:
            nearer = middle + (0.5 if value > values[-1] else -0.5) * (middle - worst)
            if (near := f(nearer)) > max(value, values[-1]):
                trial, value = nearer, near
        if value > values[-1]:
            corners[-1], values[-1] = trial, value
        else:
            corners[1:] = (corners[0] + corners[1:]) / 2
            values[1:] = [f(corner) for corner in corners[1:]]
    best = int(values.argmax())
    return float(values[best]), corners[best]

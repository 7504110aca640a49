"""The maximum of a function of a few numbers, without derivatives: Nelder and Mead's simplex."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

Reals = NDArray[np.float64]


def maximise(
    f: Callable[[Reals], float], start: Reals, steps: Sequence[float], *, within: float, most: int = 600
) -> tuple[float, Reals]:
    """The largest value near a start, and where it is.

    Parameters
    ----------
    f : callable
        Of a point, shape (n,); minus infinity where there is no value.
    start : ndarray, shape (n,)
        Where to begin; f is finite there.
    steps : sequence of float
        How far the first simplex reaches along each coordinate, and the scale of each.
    within : float
        The simplex ends smaller than this in each coordinate, over `steps`.
    most : int
        Steps, at most.

    Notes
    -----
    Nelder and Mead (1965): reflect the worst corner, and stretch or shrink as it pays.
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

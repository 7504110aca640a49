"""Thinning of curves with millions of samples to those that are visible."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

BINS = 4000  # across a picture: more than its pixels, so that nothing visible is lost even enlarged in print


def visible(values: NDArray[np.float64], bins: int = BINS) -> NDArray[np.intp]:
    """Return the indices of the samples to draw: all of a short curve, lowest and highest of each bin of a long one.

    Parameters
    ----------
    values : ndarray, shape (n,)
        Finite values at even times.
    bins : int
        Number of bins.

    Returns
    -------
    ndarray of int
        Increasing indices, including the first and the last sample and the extremes.
    """
    size = values.size // bins
    if size <= 2:
        return np.arange(values.size)
    whole = values[: bins * size].reshape(bins, size)
    starts = np.arange(bins) * size
    rest = np.arange(bins * size, values.size)  # fewer than bins
    return np.unique(
        np.concatenate([[0, values.size - 1], starts + whole.argmin(axis=1), starts + whole.argmax(axis=1), rest])
    )

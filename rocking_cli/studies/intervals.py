"""Intervals of counted shares."""

from __future__ import annotations

import numpy as np

from rocking_cli.arrays import Reals


def wilson(share: Reals, trials: float | Reals, quantile: float | Reals) -> tuple[Reals, Reals]:
    """Return the lower and the upper end of Wilson's interval of a share counted in a number of trials.

    Parameters
    ----------
    share : ndarray
        The shares, from 0 to 1.
    trials : float or ndarray
        Number of trials of each share.
    quantile : float or ndarray
        Quantile of the standard normal distribution at the upper end.

    Examples
    --------
    >>> [each.round(4).tolist() for each in wilson(np.array([0.0, 0.5]), 200, 1.645)]
    [[0.0, 0.4422], [0.0133, 0.5578]]
    """
    z2 = quantile**2 / trials
    middle = (share + z2 / 2) / (1 + z2)
    half = np.sqrt(z2 * (share * (1 - share) + z2 / 4)) / (1 + z2)
    return np.clip(middle - half, 0.0, share), np.clip(middle + half, share, 1.0)


def fractile(peaks: Reals, q: float) -> Reals:
    """Return the q-fractile of peaks under several motions; overturning ranks above any peak.

    Parameters
    ----------
    peaks : ndarray, shape (m, n)
        Peaks under m motions, inf for overturning; NaN values are left out.
    q : float
        Fractile in [0, 1]; 0.5 for the median.

    Returns
    -------
    ndarray, shape (n,)
        By linear interpolation between the ordered peaks, of which the k-th has the fractile (k - 1)/(m - 1); inf if a
        neighbour in the order overturns, NaN if there is no peak.
    """
    ordered = np.sort(peaks, axis=0)  # NaNs come last
    last = np.maximum(np.count_nonzero(~np.isnan(peaks), axis=0) - 1, 0)
    place = np.round(q * last, 9)  # so that rounding gives no weight to a neighbour
    k = np.floor(place).astype(int)
    below, above = (np.take_along_axis(ordered, row[None], axis=0)[0] for row in (k, np.ceil(place).astype(int)))
    with np.errstate(invalid="ignore"):  # inf - inf is NaN, which is replaced
        between: Reals = below + (place - k) * (above - below)
    return np.where(below == above, below, between)

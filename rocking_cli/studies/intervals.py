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

"""Effect of a vertical ground motion on results: it changes the weight, down to zero."""

from __future__ import annotations

import numpy as np

from rocking_cli.excitation.base import GroundMotion


def contact_lost(motion: GroundMotion | None, gravity: float) -> float | None:
    """Return the first time at which the vertical ground acceleration reaches -g [s], when the weight vanishes.

    Parameters
    ----------
    motion : GroundMotion or None
        The ground motion.
    gravity : float
        Acceleration of gravity [m/s2].

    Returns
    -------
    float or None
        The time; None if -g is never reached, or there is no vertical component.
    """
    if motion is None or motion.vertical is None:
        return None
    weight = gravity + motion.vertical.acceleration
    lost = np.flatnonzero(weight <= 0)
    if not lost.size:
        return None
    k = int(lost[0])
    if k == 0:
        return 0.0
    return motion.vertical.dt * float(k - 1 + weight[k - 1] / (weight[k - 1] - weight[k]))

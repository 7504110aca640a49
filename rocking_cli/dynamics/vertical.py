"""Effect of a vertical ground motion on results: it changes the weight, down to zero."""

from __future__ import annotations

from math import sqrt

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


def vertical_notes(motion: GroundMotion, gravity: float) -> list[str]:
    """Return sentences on what the vertical component of a motion means for results; empty without one.

    Parameters
    ----------
    motion : GroundMotion
        The ground motion, as scaled.
    gravity : float
        Acceleration of gravity [m/s2].

    Returns
    -------
    list of str
        Range over which g changes, its effect on the equivalent block, and the time at which contact is lost, if any.
    """
    if motion.vertical is None:
        return []
    v = motion.vertical.acceleration / gravity
    low, high = 1 + min(float(v.min()), 0.0), 1 + max(float(v.max()), 0.0)
    swing = f"{sqrt(low):.2f} to {sqrt(high):.2f} times" if low > 0 else f"nothing to {sqrt(high):.2f} times"
    said = [
        f"Vertical ground motion: gravity as the structure feels it, g + v_g'', goes from {low:.3g} g to {high:.3g} g. "
        "All histories take it into account, at uplift and in the restoring force. The parameters of the equivalent "
        f"block are those of constant g: its frequency parameter p would go from {swing} the value given, which closed "
        "forms and spectra over p leave out."
    ]
    lost = contact_lost(motion, gravity)
    if lost is not None:
        said.append(
            f"Contact is lost: at {lost:.4g} s v_g'' comes down to -g and nothing holds the structure to the ground. "
            "It may fly, which no model here follows: do not trust the response from then on."
        )
    return said

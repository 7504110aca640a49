"""Check of the law of an element: the force is the derivative of the energy, and the slope that of the force."""

from __future__ import annotations

import numpy as np

from rocking_cli.core.hung import Element
from rocking_cli.testing.mechanism import _demand

ELONGATION_POINTS = 20_001
MAX_RELATIVE_ERROR = 1e-6  # error of the differences over the largest value


def check_law(element: Element, shortest: float, longest: float) -> None:
    """Check the law of an element for consistency over a range of elongations.

    Parameters
    ----------
    element : Element
        Any element without memory or rate dependence.
    shortest, longest : float
        The range [m]; 0 need not be in it.

    Raises
    ------
    AssertionError
        If its energy at rest is not 0, its energy is not the integral of its force, or its slope not the derivative of
        its force.

    Examples
    --------
    >>> from rocking_cli.core import Spot
    >>> from rocking_cli.core.hung.element import Spring
    >>> check_law(Spring("bar", (Spot(None, 0j), Spot("block", 3j)), 1e6, 2e4, only="tension"), -0.05, 0.05)
    """
    e = np.linspace(shortest, longest, ELONGATION_POINTS)
    force, energy, slope = element.force(e), element.energy(e), element.slope(e, np.ones(ELONGATION_POINTS))
    _demand(abs(float(element.energy(np.zeros(1))[0])) == 0, f"{element.name}: its energy is not 0 at rest")
    step = e[1] - e[0]
    # Compare changes between points without a corner in between to the slopes at these points.
    for value, rate, fault in ((energy, force, "its energy is not the integral of its force"),
                              (force, slope, "its slope is not the derivative of its force")):  # fmt: skip
        change, mean = np.diff(value), step / 2 * (rate[1:] + rate[:-1])
        off = np.abs(change - mean) > np.abs(np.diff(rate)) * step + MAX_RELATIVE_ERROR * np.abs(mean).max()
        _demand(not off.any(), f"{element.name}: {fault}, at e = {e[int(off.argmax())]:.4g} m")

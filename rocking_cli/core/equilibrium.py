"""The two static answers of a mechanism: when it uplifts and where it is in unstable equilibrium."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from rocking_cli.core.coefficients import Coefficients
from rocking_cli.core.kinematics import Reals
from rocking_cli.errors import MechanismError

SCAN_POINTS = 513  # where the first sign change of G is looked for; far finer than any linkage turns


def uplift_acceleration(at: Callable[[Reals], Coefficients]) -> float:
    """Uplift acceleration over g, lambda = G(0)/B(0) [paper, Eq. 10].

    Parameters
    ----------
    at : callable
        Coefficients over an array of rotations.

    Raises
    ------
    MechanismError
        If the structure does not stand (G(0) <= 0) or the ground cannot start the mechanism (B(0) <= 0).
    """
    rest = at(np.zeros(1))
    if not rest.G[0] > 0:
        raise MechanismError("the structure cannot stand: its weight does not hold this mechanism closed at rest")
    if not rest.B[0] > 0:
        raise MechanismError("no horizontal ground acceleration starts this mechanism in this direction")
    return float(rest.G[0] / rest.B[0])  # Eq. 10


def critical_rotation(at: Callable[[Reals], Coefficients], limit: float) -> float:
    """First rotation of unstable equilibrium: G = 0 with G' < 0 [rad; paper, Eq. 9].

    Parameters
    ----------
    at : callable
        Coefficients over an array of rotations.
    limit : float
        Kinematic limit of the mechanism [rad].

    Raises
    ------
    MechanismError
        If the mechanism reaches its limit before it is in unstable equilibrium.
    """
    grid = np.linspace(0.0, limit, SCAN_POINTS)[:-1]
    falls = np.flatnonzero(at(grid).G <= 0)
    if falls.size == 0 or falls[0] == 0:
        raise MechanismError(
            f"no unstable equilibrium (G = 0) between rest and the kinematic limit of {limit:.4g} rad: "
            "the mechanism does not overturn by its own weight"
        )
    low, high = float(grid[falls[0] - 1]), float(grid[falls[0]])
    phi = (low + high) / 2
    for _ in range(100):  # Newton kept inside the bracket
        here = at(np.array([phi]))
        value, slope = float(here.G[0]), float(here.dG[0])
        low, high = (phi, high) if value > 0 else (low, phi)
        step = phi - value / slope if slope else low
        step = step if low < step < high else (low + high) / 2
        if abs(step - phi) <= 4 * np.finfo(float).eps * phi:
            break
        phi = step
    return phi

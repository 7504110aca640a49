"""Static properties of a mechanism: uplift acceleration and critical rotation."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from rocking_cli.core.coefficients import Coefficients
from rocking_cli.core.kinematics import Reals
from rocking_cli.errors import StructureError

SCAN_POINTS = 513  # where the first sign change of G is looked for; far finer than any linkage turns


class NoCriticalRotation(StructureError):
    """Error: the mechanism reaches its kinematic limit before unstable equilibrium."""


def uplift_acceleration(at: Callable[[Reals], Coefficients], gravity: float) -> float:
    """Return the uplift acceleration over g, lambda = V'(0)/(g B(0)) [paper, Eq. 10, where V' = g G].

    Parameters
    ----------
    at : callable
        Function that gives the coefficients at an array of rotations [rad].
    gravity : float
        Gravitational acceleration [m/s2].

    Raises
    ------
    StructureError
        If the structure does not stand (V'(0) <= 0) or the ground cannot start the mechanism (B(0) <= 0).
    """
    rest = at(np.zeros(1))
    restoring = float(rest.restoring(gravity)[0])
    if not restoring > 0:
        raise StructureError("the structure cannot stand: at rest, its weight does not keep this mechanism closed")
    if not rest.B[0] > 0:
        raise StructureError("no horizontal ground acceleration starts this mechanism in this direction")
    return float(restoring / rest.B[0])  # Eq. 10


def critical_rotation(at: Callable[[Reals], Coefficients], limit: float, gravity: float) -> float:
    """Return the first rotation of unstable equilibrium, V' = 0 with V'' < 0 [rad; paper, Eq. 9].

    Parameters
    ----------
    at : callable
        Function that gives the coefficients at an array of rotations [rad].
    limit : float
        Kinematic limit of the mechanism [rad].
    gravity : float
        Gravitational acceleration [m/s2].

    Raises
    ------
    NoCriticalRotation
        If the mechanism reaches its limit before it is in unstable equilibrium.
    """
    grid = np.linspace(0.0, limit, SCAN_POINTS)[:-1]
    falls = np.flatnonzero(at(grid).restoring(gravity) <= 0)
    if falls.size == 0 or falls[0] == 0:
        raise NoCriticalRotation(
            f"no unstable equilibrium (G = 0) between rest and the kinematic limit of {limit:.4g} rad: "
            "the mechanism does not overturn by its own weight"
        )
    low, high = float(grid[falls[0] - 1]), float(grid[falls[0]])
    phi = (low + high) / 2
    for _ in range(100):  # Newton kept inside the bracket
        here = at(np.array([phi]))
        value, slope = float(here.restoring(gravity)[0]), float(here.stiffness(gravity)[0])
        low, high = (phi, high) if value > 0 else (low, phi)
        step = phi - value / slope if slope else low
        step = step if low < step < high else (low + high) / 2
        if abs(step - phi) <= 4 * np.finfo(float).eps * phi:
            break
        phi = step
    return phi

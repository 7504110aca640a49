"""Static properties of a mechanism from its coefficients: uplift acceleration and critical rotation."""

from __future__ import annotations

import numpy as np

from rocking_cli.core.coefficients import Coefficients
from rocking_cli.errors import StructureError

SCAN_POINTS = 513  # rotations up to the limit at which the sign of G is evaluated


class NoCriticalRotation(StructureError):
    """Error: the mechanism reaches its kinematic limit before unstable equilibrium."""


def uplift_acceleration(rest: Coefficients, gravity: float) -> float:
    """Return the uplift acceleration over g, lambda = V'(0)/(g B(0)) [paper, Eq. 10, where V' = g G].

    Parameters
    ----------
    rest : Coefficients
        The coefficients at phi = 0.
    gravity : float
        Gravitational acceleration [m/s2].

    Raises
    ------
    StructureError
        If the structure does not stand (V'(0) <= 0) or the ground cannot start the mechanism (B(0) <= 0).
    """
    restoring = float(rest.restoring(gravity)[0])
    if not restoring > 0:
        raise StructureError("the structure cannot stand: at rest, its weight does not keep this mechanism closed")
    if not rest.B[0] > 0:
        raise StructureError("no horizontal ground acceleration starts this mechanism in this direction")
    return float(restoring / rest.B[0])  # Eq. 10


def first_fall(table: Coefficients, limit: float, gravity: float) -> tuple[float, float]:
    """Return the rotations of a table between which the restoring moment V' first falls to zero [rad].

    Parameters
    ----------
    table : Coefficients
        The coefficients at increasing rotations from rest.
    limit : float
        Kinematic limit of the mechanism [rad].
    gravity : float
        Gravitational acceleration [m/s2].

    Raises
    ------
    NoCriticalRotation
        If the mechanism reaches its limit before it is in unstable equilibrium.
    """
    falls = np.flatnonzero(table.restoring(gravity) <= 0)
    if falls.size == 0 or falls[0] == 0:
        raise NoCriticalRotation(
            f"no unstable equilibrium (G = 0) between rest and the kinematic limit of {limit:.4g} rad: "
            "the mechanism does not overturn by its own weight"
        )
    return float(table.phi[falls[0] - 1]), float(table.phi[falls[0]])


def narrowed(here: Coefficients, low: float, high: float, gravity: float) -> tuple[float, float, float]:
    """Return a smaller interval in which V' falls to zero, and the next guess in it, by Newton's method [rad].

    Parameters
    ----------
    here : Coefficients
        The coefficients at the present guess, one rotation.
    low, high : float
        The interval [rad].
    gravity : float
        Gravitational acceleration [m/s2].
    """
    phi = float(here.phi[0])
    value, slope = float(here.restoring(gravity)[0]), float(here.stiffness(gravity)[0])
    low, high = (phi, high) if value > 0 else (low, phi)
    guess = phi - value / slope if slope else low
    return low, high, guess if low < guess < high else (low + high) / 2

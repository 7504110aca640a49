"""Statics of a structure: uplift, critical rotation and restoring moment, with or without an equivalent block."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rocking_cli.core.coefficients import check_continuous
from rocking_cli.core.equilibrium import NoCriticalRotation
from rocking_cli.core.kinematics import Direction
from rocking_cli.core.mechanism import Mechanism

STEPS = 128  # steps to the critical rotation, between which jumps of the motion are searched
STRAIGHT = 0.25  # departure from the straight line 1 - phi/phi_cr, over V'(0), beyond which linear models mislead


@dataclass(frozen=True)
class Statics:
    """Statics of a structure in one direction of rocking.

    Parameters
    ----------
    lambda_ : float
        Uplift acceleration over g.
    phi_cr : float or None
        Critical rotation [rad]; None if there is none before the kinematic limit.
    limit : float
        Kinematic limit of the motion [rad].
    stiffening : float
        V''(0)/V'(0), relative slope of the restoring moment at rest [1/rad]; negative if the moment decreases, as that
        of a free block does.
    departure : float
        Largest difference of V'/V'(0) from the straight line 1 - phi/phi_cr; NaN without a critical rotation.
    why_no_block : str or None
        Why no single block is equivalent to the structure, a sentence without a full stop; None if one is.
    """

    lambda_: float
    phi_cr: float | None
    limit: float
    stiffening: float
    departure: float
    why_no_block: str | None

    @property
    def reference(self) -> float:
        """Rotation by which rotations are divided [rad]: the critical one, or else the kinematic limit."""
        return self.limit if self.phi_cr is None else self.phi_cr


def statics(mechanism: Mechanism, direction: Direction) -> Statics:
    """Return the statics of a structure in one direction of rocking.

    Parameters
    ----------
    mechanism : Mechanism
        Any mechanism, with its loads and ties.
    direction : Direction
        Direction of rocking.

    Raises
    ------
    MechanismError
        If the structure does not stand, no ground motion starts it, or a body jumps.

    Notes
    -----
    DeJong and Dimitrakopoulos (2014), Eqs. 9-10, with V' = g G + Q in place of g G. A block is equivalent only if
    there is a critical rotation and V'' < 0 at all smaller rotations.
    """
    lam = mechanism.uplift(direction)  # Eq. 10
    limit = mechanism.limit(direction)
    try:
        phi_cr: float | None = mechanism.critical_rotation(direction)  # Eq. 9
    except NoCriticalRotation:
        if not mechanism.attached:
            raise
        phi_cr, why = None, f"its restoring moment does not vanish before the kinematic limit of {limit:.4g} rad"
    way = np.linspace(0.0, limit if phi_cr is None else phi_cr, STEPS + 1)
    here = mechanism.coefficients(way if phi_cr is not None else way[:-1], direction)
    check_continuous(mechanism.mechanism, direction, here, mechanism.jumps)
    moment, slope = here.restoring(mechanism.gravity), here.stiffness(mechanism.gravity)
    departure = float("nan")
    if phi_cr is not None:
        departure = float(np.abs(moment / moment[0] - (1 - way / phi_cr)).max())
        rises = mechanism.bends and (slope >= 0).any()
        cause = ": what ties it stiffens it" if mechanism.attached else ""
        why = f"its restoring moment does not fall all the way from rest{cause}" if rises else ""
    why = mechanism.hung.fault("equivalent block") or why
    return Statics(lam, phi_cr, limit, float(slope[0] / moment[0]), departure, why or None)

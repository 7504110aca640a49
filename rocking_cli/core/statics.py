"""What a structure does at rest and on the way from there, with or without a block that it is equivalent to."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rocking_cli.core.coefficients import check_continuous
from rocking_cli.core.equilibrium import NoCriticalRotation
from rocking_cli.core.kinematics import Direction
from rocking_cli.core.mechanism import Mechanism

STEPS = 128  # to the critical rotation, between which a mechanism is held to move without jumps
STRAIGHT = 0.25  # of V'(0): further from the straight line 1 - phi/phi_cr the linear models mislead


@dataclass(frozen=True)
class Statics:
    """One direction of rocking of a structure, by its moments alone.

    Parameters
    ----------
    lambda_ : float
        Uplift acceleration over g.
    phi_cr : float or None
        Critical rotation [rad]; None if there is none before the kinematic limit.
    limit : float
        The kinematic limit, at which the motion ends if at all [rad].
    stiffening : float
        V''(0)/V'(0), how fast the restoring moment grows from rest, over itself [1/rad]; negative where it falls, as
        that of a free block does.
    departure : float
        How far V'/V'(0) is from the straight line 1 - phi/phi_cr, at most; NaN without a critical rotation.
    why_no_block : str or None
        Why no single block is equivalent to it, a sentence without a full stop; None if there is one.
    """

    lambda_: float
    phi_cr: float | None
    limit: float
    stiffening: float
    departure: float
    why_no_block: str | None

    @property
    def reference(self) -> float:
        """What rotations are compared with [rad]: the critical one, or the limit where there is none."""
        return self.limit if self.phi_cr is None else self.phi_cr


def statics(mechanism: Mechanism, direction: Direction) -> Statics:
    """The moments of a direction of rocking.

    Parameters
    ----------
    mechanism : Mechanism
        Any plugin, with what is attached to it.
    direction : Direction
        Which way it rocks.

    Raises
    ------
    MechanismError
        If the structure does not stand, the ground cannot start it, or a body jumps.

    Notes
    -----
    DeJong and Dimitrakopoulos (2014), Eqs. 9-10, with V' = g G + Q in place of g G. A block is equivalent only where
    there is a critical rotation and V'' < 0 all the way to it.
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
    check_continuous(mechanism.mechanism, direction, here)
    moment, slope = here.restoring(mechanism.gravity), here.stiffness(mechanism.gravity)
    departure = float("nan")
    if phi_cr is not None:
        departure = float(np.abs(moment / moment[0] - (1 - way / phi_cr)).max())
        rises = mechanism.bends and (slope >= 0).any()
        cause = ": what ties it stiffens it" if mechanism.attached else ""
        why = f"its restoring moment does not fall all the way from rest{cause}" if rises else ""
    why = mechanism.hung.fault("equivalent block") or why
    return Statics(lam, phi_cr, limit, float(slope[0] / moment[0]), departure, why or None)

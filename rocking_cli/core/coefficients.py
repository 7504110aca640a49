"""The coefficients of the equation of motion of any mechanism, from its bodies and their motions.

I phi.. + J phi.^2 + g G = -s B u_g''        [paper, Eq. 8, with the signs of Lagrange's equation]
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rocking_cli.core.bodies import Body
from rocking_cli.core.kinematics import Direction, Reals, RigidMotion
from rocking_cli.errors import MechanismError


@dataclass(frozen=True)
class Coefficients:
    """Coefficients over an array of rotations, each an ndarray of shape (n,).

    Parameters
    ----------
    phi : ndarray
        Rocking rotations [rad].
    I : ndarray
        Kinetic inertia [kg m2]: T = I phi.^2 / 2.
    J : ndarray
        I' / 2 [kg m2/rad].
    G : ndarray
        V' / g [kg m]: restoring while positive.
    B : ndarray
        Inertial drive of the ground acceleration [kg m].
    dG, dB : ndarray
        Derivatives of G and B [kg m/rad].
    V : ndarray
        Potential energy over g, from rest [kg m].
    """

    phi: Reals
    I: Reals  # noqa: E741 - the paper's symbol
    J: Reals
    G: Reals
    B: Reals
    dG: Reals
    dB: Reals
    V: Reals


def coefficients(
    phi: Reals, direction: Direction, bodies: Sequence[Body], motions: Sequence[RigidMotion]
) -> Coefficients:
    """Sum the bodies' shares of T and V over the rotations `phi`, shape (n,) [rad].

    Parameters
    ----------
    phi : ndarray, shape (n,)
        Rocking rotations [rad].
    direction : Direction
        The direction of rocking, whose sign enters B.
    bodies, motions : sequence
        The bodies and the motion of each over `phi`.

    Returns
    -------
    Coefficients

    Raises
    ------
    MechanismError
        If there is not one motion for each body.
    """
    if len(bodies) != len(motions):
        raise MechanismError(f"the plugin gives {len(motions)} motions for {len(bodies)} bodies")
    total = Coefficients(phi, *(np.zeros_like(phi) for _ in range(7)))
    for body, motion in zip(bodies, motions, strict=True):
        z, dz, ddz = motion.carry(body.centroid)
        m, inertia = body.mass, body.inertia
        total.I[:] += m * abs(dz) ** 2 + inertia * motion.dpsi**2
        total.J[:] += m * (dz.conj() * ddz).real + inertia * motion.dpsi * motion.ddpsi
        total.G[:] += m * dz.imag
        total.B[:] += direction * m * dz.real
        total.dG[:] += m * ddz.imag
        total.dB[:] += direction * m * ddz.real
        total.V[:] += m * (z.imag - body.centroid.imag)
    return total

"""Coefficients of the equation of motion of a mechanism, from its bodies and their motions.

I phi.. + J phi.^2 + g G + Q = -s B u_g''        [paper, Eq. 8, with the signs of Lagrange's equation]

Q is the moment of the forces that do not scale with g, such as those of ties; it is zero for a bare mechanism.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from rocking_cli.arrays import median
from rocking_cli.core.bodies import Body
from rocking_cli.core.kinematics import Direction, Reals, RigidMotion
from rocking_cli.errors import MechanismError, StructureError
from rocking_cli.short_repr import short_repr

MAX_JUMP = 1e-5  # largest unexplained change of a coefficient between two rotations, over its size


@short_repr
@dataclass(frozen=True)
class Coefficients:
    """Coefficients of the equation of motion over an array of rotations, each an ndarray of shape (n,).

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
    Q, dQ, U : ndarray, optional
        Moment of forces that do not scale with g, restoring while positive [N m], its derivative, and their energy
        from rest [J]; zero unless given.
    """

    phi: Reals
    I: Reals  # noqa: E741 - the paper's symbol
    J: Reals
    G: Reals
    B: Reals
    dG: Reals
    dB: Reals
    V: Reals
    Q: Reals = field(default_factory=lambda: np.zeros(0))
    dQ: Reals = field(default_factory=lambda: np.zeros(0))
    U: Reals = field(default_factory=lambda: np.zeros(0))

    def __post_init__(self) -> None:
        for name in ("Q", "dQ", "U"):
            if getattr(self, name).shape != self.phi.shape:
                object.__setattr__(self, name, np.zeros_like(self.phi))

    def restoring(self, gravity: float) -> Reals:
        """Return the restoring moment over g, V'/g = G + Q/g [kg m]."""
        return self.G + self.Q / gravity

    def stiffness(self, gravity: float) -> Reals:
        """Return the derivative of the restoring moment over g, V''/g = G' + Q'/g [kg m/rad]."""
        return self.dG + self.dQ / gravity


def coefficients(
    phi: Reals, direction: Direction, bodies: Sequence[Body], motions: Sequence[RigidMotion]
) -> Coefficients:
    """Sum the kinetic energy T and the potential energy V of the bodies, over rotations `phi` [rad].

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
    total = Coefficients(phi, *np.zeros((10, *phi.shape)))
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


def check_continuous(mechanism: str, direction: Direction, at: Coefficients, in_file: str = "") -> None:
    """Raise `MechanismError` if the positions or velocities of the bodies jump between two rotations.

    Parameters
    ----------
    mechanism : str
        Name of the mechanism.
    direction : Direction
        The direction of rocking.
    at : Coefficients
        Coefficients at increasing rotations, so close that slopes change evenly between them.
    in_file : str
        The `jumps` of the mechanism: what in the file of the structure gives its motion, or an empty text.

    Raises
    ------
    MechanismError
        If V, G, B or I changes between two rotations by what its derivative there does not explain; a `StructureError`
        if the file of the structure gives its motion.
    """
    moment = median(np.abs(at.G) + np.abs(at.B))  # typical size of G and B, of the order of m R, in the unit of V
    pairs = {"V": (at.V, at.G, moment), "G": (at.G, at.dG, moment), "B": (at.B, at.dB, moment)}
    pairs["I"] = (at.I, 2 * at.J, median(at.I))
    jumps = {name: jump(at.phi, *pair) for name, pair in pairs.items()}
    first = min((phi, name) for name, phi in jumps.items())
    where = f"jumps at phi = {first[0]:.4g} rad in the {direction.label} direction"
    if first[0] < np.inf and in_file:
        raise StructureError(f"it {where}: {in_file}")
    if first[0] < np.inf:
        raise MechanismError(
            f"the mechanism {mechanism} {where}: its {first[1]} changes there as its derivative does not. "
            "Its bodies must move without jumps"
        )


def jump(phi: Reals, value: Reals, slope: Reals, size: float) -> float:
    """Return the rotation [rad] after which a value first changes by more than its slope explains; infinity if none.

    If a value has no jump and its slope changes evenly over a step, its change lies between the changes that the slopes
    at both ends of the step give.
    """
    step = np.diff(phi)
    missed = np.abs(np.diff(value) - step / 2 * (slope[:-1] + slope[1:])) - step * np.abs(np.diff(slope))
    allowed = MAX_JUMP * (size + np.abs(value[:-1]) + np.abs(value[1:]))
    places = np.flatnonzero(~(missed <= allowed))  # NaN counts as a jump
    return float(phi[places[0]]) if places.size else np.inf


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

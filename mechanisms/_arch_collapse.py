"""Collapse mechanism of a circular arch under horizontal ground acceleration: its hinges and its multiplier.

The least multiplier lambda of horizontal inertia over all admissible mechanisms (kinematic theorem) is the greatest for
which a line of thrust stays inside the ring (static theorem). The search uses both theorems: for each mechanism it
finds the line of thrust through the hinges, and moves a hinge to the joint where this line is furthest outside the
ring, until the line stays inside. As both theorems then hold, the result is the global minimum.

Everything is per unit radius, weight density and depth; angles run from the left springing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rocking_cli.errors import MechanismError

Reals = NDArray[np.float64]
Hinges = tuple[float, float, float, float]
SCAN_JOINTS = 721  # joints of the first search if hinges may be anywhere
MAX_LAMBDA = 100.0  # lambda beyond which an arch counts as too thick to hinge
MAX_START_REACTION = 1e4  # bound on the reactions at the start of the search, over the weight
LINE_TOLERANCE = 1e-12  # moment by which the line of thrust may leave the ring, over the moment of its weight
MAX_ITERATIONS = 200
FACE_OF_HINGE = np.array([-1.0, 1.0, -1.0, 1.0])  # faces of the hinges A, B, C and D: intrados -1, extrados 1


class ArchCannotStand(Exception):
    """Error: no line of thrust of the arch's own weight stays inside the arch."""


@dataclass(frozen=True)
class Ring:
    """A circular ring of centre-line radius 1, with its thickness over the radius and its inclusion angle [rad]."""

    thickness: float
    beta: float

    def joint(self, angle: Reals, face: int) -> tuple[NDArray[np.complex128], Reals, NDArray[np.complex128]]:
        """Return a point of the joint at `angle`, and the area and first moment of area of the ring left of the joint.

        The point is on the intrados (face -1) or the extrados (face 1), or on the centre line (face 0).
        """
        inner, outer = 1 - self.thickness / 2, 1 + self.thickness / 2
        left = np.exp(1j * (np.pi + self.beta) / 2)
        point = (1 + face * self.thickness / 2) * left * np.exp(-1j * angle)
        moment = (outer**3 - inner**3) / 3 * 1j * left * (np.exp(-1j * angle) - 1)
        return point, (outer**2 - inner**2) / 2 * angle, moment

    def balance(self, angle: Reals, face: int) -> tuple[Reals, Reals]:
        """Return the moment of all loads left of a joint, about its point on a face, in terms of the unknowns.

        The unknowns are (M0, Fx, Fy, lambda): the moment about the centre and the components of the reaction at the
        left springing, and the multiplier lambda of the horizontal inertia, which acts to the right.

        Returns
        -------
        rows : ndarray, shape (..., 4)
            Factors of the unknowns.
        weight : ndarray
            Moment of the weight. The moment of all loads is rows . (M0, Fx, Fy, lambda) - weight.
        """
        point, area, moment = self.joint(angle, face)
        lever = moment - point * area  # about the point: weight has the moment -Re, inertia to the right -lambda Im
        rows = np.stack([np.ones_like(angle), point.imag, -point.real, -lever.imag], axis=-1)
        return rows, lever.real

    def thrust_radius(self, angle: Reals, state: Reals) -> Reals:
        """Return the radius at which the line of thrust crosses the radial joints at `angle`."""
        M0, Fx, Fy, lam = state
        point, area, moment = self.joint(angle, 0)
        return np.asarray(
            (moment.real + lam * moment.imag - M0) / (point.imag * (Fx + lam * area) - point.real * (Fy - area))
        )

    def excess(self, angle: Reals, face: int, state: Reals) -> Reals:
        """Return how far the line of thrust is outside a face of the joints, as a moment; negative inside."""
        rows, weight = self.balance(angle, face)
        return -face * np.asarray(rows @ state - weight)

    def worst(self, angle: Reals, face: int, state: Reals) -> Reals:
        """Return the angle of the local maximum of `excess` nearest to each `angle`, within the ring."""
        inner, outer = 1 - self.thickness / 2, 1 + self.thickness / 2
        force, pull = complex(state[1], -state[2]), 1 - 1j * state[3]
        for _ in range(3):  # Newton on the derivative; angles start within a scan step of the maximum
            point, area, _ = self.joint(angle, face)
            growth = (outer**2 - inner**2) / 2
            load = (outer**3 - inner**3) / 3 * point / abs(point)
            first = (-1j * point * force).imag - ((load + 1j * point * area - point * growth) * pull).real
            second = (-point * force).imag - ((-1j * load + point * area + 2j * point * growth) * pull).real
            step = np.where(-face * second < 0, -first / np.where(second == 0, 1.0, second), 0.0)
            reach = self.beta / (SCAN_JOINTS - 1)
            angle = np.clip(angle + np.clip(step, -reach, reach), 0.0, self.beta)
        return angle


def collapse_hinges(ring: Ring, voussoirs: int | None) -> Hinges:
    """Return the angles of the hinges A (intrados), B (extrados), C (intrados) and D (extrados) [rad].

    Parameters
    ----------
    ring : Ring
        The arch, of centre-line radius 1.
    voussoirs : int or None
        Number of equal voussoirs, whose joints are the only places for a hinge; None if hinges may be anywhere.

    Raises
    ------
    ArchCannotStand
        If the arch is too thin to stand under its own weight.
    MechanismError
        If the arch does not collapse on four hinges, because it is too thick.
    """
    joints = np.linspace(0.0, ring.beta, (voussoirs or SCAN_JOINTS - 1) + 1)
    multiplier, hinges, faces = _collapse(ring, joints)
    if not (np.array_equal(faces, FACE_OF_HINGE) and (np.diff(hinges) > 0).all()):
        raise MechanismError(
            "the arch is too thick for a four-hinge mechanism: "
            + (
                f"at {multiplier:.3g} g it lifts off a springing instead"
                if multiplier < MAX_LAMBDA
                else "none can open"
            )
        )
    if voussoirs is None:
        hinges = _settle(ring, hinges, joints)
    a, b, c, d = (float(angle) for angle in hinges)
    return a, b, c, d


def _collapse(ring: Ring, joints: Reals) -> tuple[float, Reals, Reals]:
    """Return the least lambda with hinges at given joints, and the angles and faces of these hinges, in order.

    Dual simplex: four constraints a . v >= c carry the state v = (M0, Fx, Fy, lambda), and their multipliers y >= 0 are
    the rotations of the hinges, so that every step leads to another mechanism whose hinges open.
    """
    a: list[Reals] = []
    c: list[Reals] = []
    for face in (-1, 1):
        rows, weights = ring.balance(joints, face)
        a.append(face * rows)
        c.append(face * weights)
    # Start with bounds that no arch reaches: lambda <= MAX_LAMBDA, and three on the reactions.
    weight = ring.beta * ring.thickness
    A = np.vstack([*a, -np.eye(4)])
    C = np.concatenate([*c, [-MAX_START_REACTION * weight] * 3, [-MAX_LAMBDA]])
    n = joints.size
    basis = np.arange(2 * n, 2 * n + 4)
    for _ in range(MAX_ITERATIONS):
        hinge_rows = A[basis]
        state = np.linalg.solve(hinge_rows, C[basis])
        if state[3] <= 0:
            raise ArchCannotStand
        slack = A @ state - C
        slack[basis] = 0.0
        worst = int(slack.argmin())
        if slack[worst] >= -LINE_TOLERANCE * max(weight, float(np.abs(state).max())):
            break
        turns = np.linalg.solve(hinge_rows.T, np.array([0.0, 0.0, 0.0, -1.0]))
        share = np.linalg.solve(hinge_rows.T, A[worst])
        closing = share > 1e-12 * np.abs(share).max()
        if not closing.any():
            raise ArchCannotStand  # no state satisfies all constraints: the dual is unbounded
        ratio = np.where(closing, np.maximum(turns, 0.0) / np.where(closing, share, 1.0), np.inf)
        basis[int(ratio.argmin())] = worst
    else:
        raise MechanismError("the search for the arch's hinges did not settle")
    order = basis[np.argsort(np.append(np.tile(joints, 2), [np.inf] * 4)[basis], kind="stable")]
    if order[-1] >= 2 * n:  # a bound of the start is still active: fewer than four hinges carry the state
        return float(state[3]), np.zeros(4), np.zeros(4)
    return float(state[3]), joints[order % n], np.where(order < n, -1.0, 1.0)


def _settle(ring: Ring, hinges: Reals, joints: Reals) -> Reals:
    """Return the hinges moved from the joints of a scan to where the line of thrust touches the ring."""
    for _ in range(MAX_ITERATIONS):
        state = thrust(ring, hinges)
        moved = np.array(
            [float(ring.worst(np.array(h), int(f), state)) for h, f in zip(hinges, FACE_OF_HINGE, strict=True)]
        )
        settled = np.abs(moved - hinges).max() <= 1e-14 * ring.beta
        hinges = moved
        if settled:
            break
    state = thrust(ring, hinges)
    furthest = max(float(ring.excess(ring.worst(joints, face, state), face, state).max()) for face in (-1, 1))
    if furthest > 1e-9 * ring.thickness * ring.beta:
        raise MechanismError("the search for the arch's hinges did not settle")
    return hinges


def least_thickness(beta: float, voussoirs: int | None) -> float:
    """Return the least t/r with which the arch stands under its own weight, rounded up."""
    low, high = 0.0, 1.0
    while high - low > 1e-6:
        middle = (low + high) / 2
        try:
            collapse_hinges(Ring(middle, beta), voussoirs)
            high = middle
        except ArchCannotStand:
            low = middle
        except MechanismError:  # the arch stands, but is too thick for hinges
            high = middle
    return high


def thrust(ring: Ring, hinges: Reals | Hinges) -> Reals:
    """Return the state (M0, Fx, Fy, lambda) of the line of thrust through the hinges.

    (Fx, Fy) and M0 are force and moment of the reaction at the left springing.
    """
    balances = [ring.balance(np.array(angle), int(face)) for angle, face in zip(hinges, FACE_OF_HINGE, strict=True)]
    return np.linalg.solve(np.stack([rows for rows, _ in balances]), np.array([weight for _, weight in balances]))

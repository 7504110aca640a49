"""Where a circular arch hinges when the ground throws it to the right: the quasi-static collapse mechanism.

The least multiplier lambda of horizontal inertia over all admissible four-hinge mechanisms (kinematic theorem) is
the greatest for which a line of thrust stays inside the ring (static theorem). The search uses both: it takes the
best mechanism on a few candidate joints, draws its line of thrust, adds the joints where that line leaves the ring
most, and stops when it stays inside. The result is then proven, not only found: false minima cannot pass.

Everything is per unit radius, weight density and depth; angles run from the left springing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from rocking_cli.errors import MechanismError

Reals = NDArray[np.float64]
START_JOINTS = 13  # first candidates
SCAN_JOINTS = 721  # where the line of thrust is looked at when hinges may be anywhere
TOLERANCE = 1e-13  # moment by which the line of thrust may leave the ring, over that of the ring's weight
SETTLED = 1e-9  # the same once rounding keeps lambda from falling any further
ROUNDS = 60


class ArchCannotStand(Exception):
    """No line of thrust of the arch's own weight stays inside it."""


@dataclass(frozen=True)
class Ring:
    """A circular ring of centre-line radius 1: thickness over radius, and inclusion angle [rad]."""

    thickness: float
    beta: float

    def joint(self, angle: Reals, face: int) -> tuple[NDArray[np.complex128], Reals, NDArray[np.complex128]]:
        """Point on a face (-1 intrados, +1 extrados) of the joint at `angle`; area and first moment left of it."""
        inner, outer = 1 - self.thickness / 2, 1 + self.thickness / 2
        left = np.exp(1j * (np.pi + self.beta) / 2)
        point = (1 + face * self.thickness / 2) * left * np.exp(-1j * angle)
        moment = (outer**3 - inner**3) / 3 * 1j * left * (np.exp(-1j * angle) - 1)
        return point, (outer**2 - inner**2) / 2 * angle, moment

    def balance(self, angle: Reals, face: int) -> tuple[Reals, Reals]:
        """Moment about a joint's face of all that acts left of it, as rows . (M0, Fx, Fy, lambda) - weight.

        (Fx, Fy, M0) is the reaction at the left springing, its moment about the centre; lambda times the weight
        acts to the right.
        """
        point, area, moment = self.joint(angle, face)
        lever = moment - point * area
        rows = np.stack([np.ones_like(angle), point.imag, -point.real, -lever.imag], axis=-1)
        return rows, lever.real

    def excess(self, angle: Reals, face: int, state: Reals) -> Reals:
        """How far the line of thrust passes outside a face of the joints, as a moment; negative inside."""
        rows, weight = self.balance(angle, face)
        return -face * np.asarray(rows @ state - weight)

    def worst(self, angle: Reals, face: int, state: Reals) -> Reals:
        """The local maximum of `excess` nearest to each of `angle`, inside the ring."""
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


def collapse_hinges(ring: Ring, voussoirs: int | None) -> tuple[float, float, float, float]:
    """Angles of the hinges A (intrados), B (extrados), C (intrados) and D (extrados) [rad].

    Parameters
    ----------
    ring : Ring
        The arch, of centre-line radius 1.
    voussoirs : int or None
        Number of equal voussoirs, whose joints are the only places for a hinge; None: anywhere.

    Raises
    ------
    ArchCannotStand
        If the arch is too thin to stand under its own weight.
    MechanismError
        If the arch forms no such mechanism (it is too thick to hinge).
    """
    joints = np.linspace(0.0, ring.beta, (voussoirs or SCAN_JOINTS - 1) + 1)
    start = joints[np.unique(np.linspace(0, joints.size - 1, START_JOINTS).round().astype(int))]
    inside, outside = start, start
    lowest = np.inf
    for _ in range(ROUNDS):
        multiplier, hinges = _best_mechanism(ring, inside, outside)
        if multiplier <= 0:
            raise ArchCannotStand
        state = _thrust(ring, hinges)
        scale = TOLERANCE * ring.thickness * ring.beta
        stalled = multiplier >= lowest * (1 - 4 * np.finfo(float).eps)
        lowest = multiplier
        leaves, furthest = [], 0.0
        for face in (-1, 1):
            beyond = ring.excess(joints, face, state)
            padded = np.concatenate([[-np.inf], beyond, [-np.inf]])
            peaks = joints[(beyond >= padded[:-2]) & (beyond >= padded[2:]) & (beyond > -1e-6)]
            if voussoirs is None:
                peaks = ring.worst(peaks, face, state)
            excess = ring.excess(peaks, face, state)
            leaves.append(peaks[excess > scale])
            furthest = max(furthest, float(excess.max(initial=0.0)))
        if furthest <= scale or (stalled and furthest < SETTLED * ring.thickness * ring.beta):
            return hinges
        if stalled:
            break
        inside = np.union1d(leaves[0], [hinges[0], hinges[2]])
        outside = np.union1d(leaves[1], [hinges[1], hinges[3]])
    raise MechanismError("the search for the arch's hinges did not settle")


def least_thickness(beta: float, voussoirs: int | None) -> float:
    """The least t/r with which the arch stands under its own weight, rounded up."""
    low, high = 0.0, 1.0
    while high - low > 1e-6:
        middle = (low + high) / 2
        try:
            collapse_hinges(Ring(middle, beta), voussoirs)
            high = middle
        except ArchCannotStand:
            low = middle
    return high


def _best_mechanism(ring: Ring, inside: Reals, outside: Reals) -> tuple[float, tuple[float, float, float, float]]:
    """The admissible mechanism of least lambda with hinges at the candidate angles of the two faces."""
    quads = np.array(
        [(a, b, c, d) for a, c in combinations(inside, 2) for b, d in combinations(outside, 2) if a < b < c < d]
    )
    if quads.size == 0:
        raise MechanismError("the arch has too few joints for four hinges")
    balances = [ring.balance(quads[:, k], (-1, 1)[k % 2]) for k in range(4)]
    rows = np.stack([rows for rows, _ in balances], axis=1)  # (mechanism, hinge, unknown)
    weights = np.stack([weight for _, weight in balances], axis=1)
    # Hinge rotations for which the inertia does unit work and the reactions none: virtual work gives lambda.
    unit_work = np.broadcast_to([[0.0], [0.0], [0.0], [-1.0]], (len(quads), 4, 1))
    turns = np.linalg.solve(rows.transpose(0, 2, 1), unit_work)[:, :, 0]
    admissible = (turns * [-1, 1, -1, 1] >= 0).all(axis=1)  # every hinge opens
    if not admissible.any():
        raise MechanismError("the arch is too thick to rock on four hinges: none of its mechanisms can open")
    multipliers = np.where(admissible, -(turns * weights).sum(axis=1), np.inf)
    best = int(multipliers.argmin())
    a, b, c, d = (float(angle) for angle in quads[best])
    return float(multipliers[best]), (a, b, c, d)


def _thrust(ring: Ring, hinges: Sequence[float]) -> Reals:
    """Reaction at the left springing and lambda (M0, Fx, Fy, lambda) of the line of thrust through the hinges."""
    balances = [ring.balance(np.array(angle), (-1, 1)[k % 2]) for k, angle in enumerate(hinges)]
    return np.linalg.solve(np.stack([rows for rows, _ in balances]), np.array([weight for _, weight in balances]))

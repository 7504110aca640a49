"""Loads on each block of an assembly: weight and inertia of the block and of the loads and ties on it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rocking_cli.core import Attached, Body, Direction, PointMass, Reals, RigidMotion, Spot
from rocking_cli.core.hung.attached import Follow, Path
from rocking_cli.core.hung.attachments import followed
from rocking_cli.core.kinematics import Points


@dataclass(frozen=True, eq=False)
class Going:
    """State of motion of a mechanism at n instants, each array of shape (n,).

    Parameters
    ----------
    turning : ndarray
        Rotation acceleration phi.. [rad/s2].
    rate : ndarray
        Rotation rate phi. [rad/s].
    ground : ndarray of complex
        Ground acceleration u_g'' + i v_g'' [m/s2].
    """

    turning: Reals
    rate: Reals
    ground: Points


def at_rest(
    bodies: Sequence[Body], attached: Sequence[Attached], direction: Direction, gravity: float
) -> tuple[Reals, Reals]:
    """Return permanent forces and moments about the centroids, and those of 1 g horizontally, each (bodies, 3)."""

    def follow(spot: Spot) -> Path:
        still = np.zeros(1, np.complex128)
        return Path(still + spot.at, still, still)

    still = Going(np.zeros(1), np.zeros(1), np.zeros(1, np.complex128))
    resting = {body.name: _Resting() for body in bodies}
    dead = _forces(bodies, resting, attached, direction, gravity, still, follow)[0]
    pushed = Going(np.zeros(1), np.zeros(1), np.full(1, -int(direction) * gravity + 0j))
    both = _forces(bodies, resting, attached, direction, gravity, pushed, follow)[0]
    return dead, both - dead


def under_way(
    bodies: Sequence[Body], motions: Sequence[RigidMotion], attached: Sequence[Attached], direction: Direction,
    gravity: float, going: Going,
) -> Reals:  # fmt: skip
    """Return forces and moments on the bodies of a mechanism in motion, including inertia, shape (n, bodies, 3).

    They are weights, inertia forces, and the forces of ties, each about the displaced centroid of its body. `motions`
    are the motions of the bodies by phi, and `going` has the rotation rates, rotation accelerations and ground
    accelerations.
    """
    by_name: Mapping[str, RigidMotion | _Resting] = {b.name: m for b, m in zip(bodies, motions, strict=True)}
    follow = followed(bodies, motions, going.rate.shape)
    return _forces(bodies, by_name, attached, direction, gravity, going, follow)


class _Resting:
    """Motion of a body at rest."""

    dpsi = ddpsi = 0.0

    def carry(self, point: complex) -> tuple[complex, complex, complex]:
        """Return the position of a point, and its first two derivatives, which are zero."""
        return point, 0j, 0j


def _forces(
    bodies: Sequence[Body], motions: Mapping[str, RigidMotion | _Resting], attached: Sequence[Attached],
    direction: Direction, gravity: float, going: Going, follow: Follow,
) -> Reals:  # fmt: skip
    index = {body.name: k for k, body in enumerate(bodies)}
    weight = going.ground + 1j * gravity
    found = np.zeros((len(going.rate), len(bodies), 3))
    centres = []
    for k, body in enumerate(bodies):
        motion = motions[body.name]
        z, dz, ddz = motion.carry(body.centroid)
        centres.append(z)
        force = -body.mass * (dz * going.turning + ddz * going.rate**2 + weight)
        found[:, k, 0], found[:, k, 1] = force.real, force.imag
        found[:, k, 2] = -body.inertia * (motion.dpsi * going.turning + motion.ddpsi * going.rate**2)

    def add(body: str | None, at: Points, force: Points) -> None:
        if body is not None:
            k = index[body]
            found[:, k, 0] += force.real
            found[:, k, 1] += force.imag
            found[:, k, 2] += (np.conj(at - centres[k]) * force).imag

    for thing in attached:
        if isinstance(thing, PointMass):
            z, dz, ddz = follow(thing.spot)
            moved = dz * going.turning + ddz * going.rate**2
            across = thing.mass * thing.horizontal * (moved.real + weight.real)
            up = thing.mass * (thing.vertical * moved.imag + thing.weight * weight.imag)
            add(thing.spot.body, z, -(across + 1j * up))
        for push in thing.forces(direction, follow):
            add(push.spot.body, follow(push.spot).z, push.force)
    return found

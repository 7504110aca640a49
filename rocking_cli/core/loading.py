"""Loads on each body of a mechanism in motion: weight, inertia, and the loads and ties on it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rocking_cli.core.bodies import Body
from rocking_cli.core.hung.attached import Attached, PointMass
from rocking_cli.core.hung.attachments import followed
from rocking_cli.core.kinematics import Direction, Points, Reals, RigidMotion


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


def loading(
    bodies: Sequence[Body], motions: Sequence[RigidMotion], attached: Sequence[Attached], direction: Direction,
    gravity: float, going: Going,
) -> Reals:  # fmt: skip
    """Return forces [N] and moments about the displaced centroid [N m] on each body, shape (n, bodies, 3).

    They are weights, inertia forces, and the forces of loads and ties; the forces at the joints balance them.

    Parameters
    ----------
    bodies, motions : sequence
        The bodies, and the motion of each by phi.
    attached : sequence of Attached
        Loads and ties.
    direction : Direction
        Direction of rocking.
    gravity : float
        Gravitational acceleration [m/s2].
    going : Going
        The state of motion.
    """
    index = {body.name: k for k, body in enumerate(bodies)}
    follow = followed(bodies, motions, going.rate.shape)
    weight = going.ground + 1j * gravity
    found = np.zeros((len(going.rate), len(bodies), 3))
    centres = []
    for k, (body, motion) in enumerate(zip(bodies, motions, strict=True)):
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

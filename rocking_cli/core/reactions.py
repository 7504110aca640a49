"""What bodies exert on one another and on the ground while a mechanism rocks, and at its impacts.

The accelerations are known from the equation of motion, so that Newton's and Euler's equations of each moving body give
the forces at its joints. Bodies that move as one are one; those at rest are ground.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isclose

import numpy as np

from rocking_cli.core.contacts import Contact
from rocking_cli.core.hung.attached import PointMass, Spot
from rocking_cli.core.hung.attachments import followed
from rocking_cli.core.joints import Joint
from rocking_cli.core.kinematics import Direction, Points, Reals
from rocking_cli.core.mechanism import Mechanism
from rocking_cli.core.released import Pieces

LOOKED_AT = (0.21, 0.47)  # of the kinematic limit: where it is seen which bodies move as one
AS_ONE = 1e-9  # of the largest displacement there
BALANCED = 1e-6  # of the largest force needed: what no forces at the joints balance
COUPLE = 0j  # among the forces of a joint: no force at all
WHOLE = Joint("", 0j, ())
"""Stands for all joints together where the forces at each are not known."""


@dataclass(frozen=True, eq=False)
class Reactions:
    """Forces at the joints, or impulses.

    Parameters
    ----------
    joints : sequence of Joint
        Where they act; `WHOLE` alone where the forces at the joints are not known, only their sum.
    force : ndarray of complex, shape (k, n)
        Fx + i Fy on the last of the bodies of each joint [N].
    across : ndarray of complex, shape (k, n)
        The normal of the face of each, of length 1.
    shared : bool
        Whether there are too many joints for statics alone: then the forces are the smallest ones, in the sense of
        least squares, of all that balance the bodies.
    """

    joints: Sequence[Joint]
    force: Points
    across: Points
    shared: bool = False

    @property
    def normal(self) -> Reals:
        """N, positive where the joint presses [N], shape (k, n); NaN at guides."""
        return self._where_faced((self.across.conj() * self.force).real)

    @property
    def shear(self) -> Reals:
        """T along the face, to the right where the normal is up [N], shape (k, n); NaN at guides."""
        return self._where_faced(-(self.across.conj() * self.force).imag)

    @property
    def is_whole(self) -> bool:
        """Whether only the sum over all joints is known."""
        return self.joints[0] is WHOLE

    @property
    def total(self) -> Points:
        """Fx + i Fy of the ground, and of what rests, on all that moves [N], shape (n,)."""
        alone = [self.is_whole or len(joint.bodies) == 1 for joint in self.joints]
        return np.asarray(self.force[alone].sum(axis=0))

    def _where_faced(self, of: Reals) -> Reals:
        guides = np.array([joint.is_guide for joint in self.joints])
        return np.where(guides[:, None], np.nan, of)


def reactions(
    mechanism: Mechanism, direction: Direction, phi: Reals, rate: Reals, ground: Points | complex = 0j
) -> Reactions:
    """The forces at the joints in any number of states of motion.

    Parameters
    ----------
    mechanism : Mechanism
        Any plugin, with what is attached to it.
    direction : Direction
        Which way it rocks.
    phi, rate : ndarray, shape (n,)
        Rotations inside the direction [rad], >= 0, and their rates [rad/s].
    ground : ndarray of complex, shape (n,)
        Ground acceleration u_g'' + i v_g'' [m/s2].

    Notes
    -----
    The acceleration is that of Eq. 8, I phi.. + J phi.^2 + (g + v_g'') G + Q = -s B u_g''. Of a body: the sum of the
    forces on it is m (z'' + u_g'' + i (g + v_g'')), their moment about its centroid I psi''.
    """
    ground = np.broadcast_to(np.asarray(ground, np.complex128), phi.shape)
    weight = ground + 1j * mechanism.gravity
    turning = acceleration(mechanism, direction, phi, rate, ground)
    moving = _Moving(mechanism, direction, phi)

    for body, motion in zip(mechanism.weighed(), moving.motions, strict=True):
        z, dz, ddz = motion.carry(body.centroid)
        force = body.mass * (dz * turning + ddz * rate**2 + weight)
        moving.demand(body.name, z, force, body.inertia * (motion.dpsi * turning + motion.ddpsi * rate**2))
    for thing in mechanism.attached:
        if isinstance(thing, PointMass):
            z, dz, ddz = moving.follow(thing.spot)
            moved = dz * turning + ddz * rate**2
            across, up = thing.horizontal * (moved.real + weight.real), thing.vertical * moved.imag
            moving.demand(
                thing.spot.body, z, _point(thing.mass * across, thing.mass * (up + thing.weight * weight.imag))
            )
        for push in thing.forces(direction, moving.follow):
            moving.demand(push.spot.body, moving.follow(push.spot).z, -push.force)
    found = moving.at_joints()
    if found is None and (contacts := _instead_of_joints(mechanism, direction)):
        pieces = Pieces(mechanism, direction, phi)
        terms = np.stack([np.ones_like(phi), ground.real, rate**2, ground.imag], axis=-1)
        found = _at_contacts(pieces, contacts, np.einsum("nqk,nk->nq", pieces.demands(), terms))
    return found or moving.over_the_whole()


def acceleration(
    mechanism: Mechanism, direction: Direction, phi: Reals, rate: Reals, ground: Points | complex = 0j
) -> Reals:
    """phi.. in any number of states of motion [rad/s2]; the arguments are those of `reactions`."""
    ground = np.broadcast_to(np.asarray(ground, np.complex128), phi.shape)
    at = mechanism.coefficients(phi, direction)
    weight = mechanism.gravity + ground.imag
    return np.asarray(-(at.J * rate**2 + weight * at.G + at.Q + direction * at.B * ground.real) / at.I)  # Eq. 8


def at_uplift(mechanism: Mechanism, direction: Direction) -> Reactions:
    """The forces at the joints at rest while the ground is about to start rocking in a direction, n = 1."""
    push = -direction * mechanism.uplift(direction) * mechanism.gravity
    return reactions(mechanism, direction, np.zeros(1), np.zeros(1), push)


def impulses(mechanism: Mechanism, ended: Direction) -> Reactions | None:
    """The impulses at the joints at an impact, over the rate before it [N s per rad/s], n = 1.

    Parameters
    ----------
    mechanism : Mechanism
        Any plugin, with what is attached to it.
    ended : Direction
        The direction that the impact ends.

    Returns
    -------
    Reactions or None
        At the joints of the mechanism that follows. With a restitution that is not that of the kinematics only their
        sum is known, where there is more than one; and where that says nothing of friction, on faces that are not level
        or beside a guide or a wall that it is thrown back by, None.

    Notes
    -----
    The momentum of a body jumps from m t_s to -m eta t_-s, t the velocity over the rate: the impulse at one joint is
    sum m (eta t_-s + t_s), and |dP_x|/dP_y = (1 - eta)/((1 + eta) tan alpha) of a block.
    """
    if not mechanism.rocks_both_ways:
        return None
    eta, rest = mechanism.eta(ended), np.zeros(1)
    moving = _Moving(mechanism, ended.opposite, rest)
    bodies = mechanism.weighed()
    before = mechanism.motion(rest, ended)
    for body, old, new in zip(bodies, before, moving.motions, strict=True):
        z, dz, _ = new.carry(body.centroid)
        turned = body.inertia * (eta * new.dpsi + old.dpsi)
        moving.demand(body.name, z, body.mass * (eta * dz + old.carry(body.centroid)[1]), turned)
    came = followed(bodies, before, rest.shape)
    for thing in mechanism.attached:
        if isinstance(thing, PointMass):
            jump = eta * moving.follow(thing.spot).dz + came(thing.spot).dz
            impulse = _point(thing.mass * thing.horizontal * jump.real, thing.mass * thing.vertical * jump.imag)
            moving.demand(thing.spot.body, moving.follow(thing.spot).z, impulse)
    if contacts := _instead_of_joints(mechanism, ended.opposite):
        pieces = Pieces(mechanism, ended.opposite, rest)
        before_it = Pieces(mechanism, ended, rest)
        found = _at_contacts(pieces, contacts, eta * pieces.momentum(pieces.dq) + before_it.momentum(before_it.dq))
        if found is not None:
            return found
    joints = mechanism.joints(ended.opposite)
    if len(joints) == 1 or isclose(eta, mechanism.restitution_from_kinematics(ended), rel_tol=1e-9):
        found = moving.at_joints()
        if found is not None:
            return found
    level = all(abs(joint.normal - 1j) < AS_ONE for joint in joints if len(joint.bodies) == 1)
    return moving.over_the_whole() if level and not any(joint.is_guide for joint in joints) else None


def _instead_of_joints(mechanism: Mechanism, direction: Direction) -> Sequence[Contact]:
    """The contacts of a mechanism that names no joints, as bodies slide on others or a joint is too many."""
    return () if mechanism.joints(direction) else mechanism.contacts(direction) or ()


def _at_contacts(pieces: Pieces, contacts: Sequence[Contact], demand: Reals) -> Reactions | None:
    """The forces at the contacts from three equations for each piece; None where they do not balance what is needed."""
    rates, rows = pieces.rates(contacts)
    jacobian = rates.dense()
    balance, needed = (jacobian / pieces.scale).swapaxes(1, 2), demand / pieces.scale
    values = np.einsum("nrq,nq->nr", np.linalg.pinv(balance), needed)
    off = np.abs(np.einsum("nqr,nr->nq", balance, values) - needed)
    if off.max(initial=0.0) > BALANCED * np.abs(needed).max(initial=0.0):
        return None
    joints: list[Joint] = []
    force: list[Points] = []
    across: list[Points] = []
    for contact, (normal, shear) in zip(contacts, rows, strict=True):
        if not contact.letter or shear is None:
            continue
        names = tuple(name for name in contact.pieces if name is not None)
        joints.append(Joint(contact.letter, contact.points[0], names, normal=contact.normal, face=contact.face))
        across.append(pieces.normal(contact))
        force.append((values[:, list(normal)].sum(axis=1) - 1j * values[:, shear]) * across[-1])
    if not joints:
        return None
    redundant = jacobian.shape[1] >= jacobian.shape[2]
    return Reactions(joints, np.stack(force), np.stack(across), redundant)


def parts(mechanism: Mechanism, direction: Direction) -> Mapping[str, int]:
    """Which bodies move as one in a direction: a number for each, by their names; 0 of those that stay at rest."""
    bodies = mechanism.bodies()
    motions = mechanism.motion(np.array(LOOKED_AT) * mechanism.limit(direction), direction)
    middle = sum(body.centroid for body in bodies) / len(bodies)
    size = max(abs(body.centroid - middle) for body in bodies) or 1.0
    two = (middle - size, middle + size)  # points of a plane that moves say all of its motion
    ways = [np.concatenate([motion.carry(point)[0] - point for point in two]) for motion in motions]
    close = AS_ONE * max(float(np.abs(way).max()) for way in ways)
    kinds = [np.zeros_like(ways[0])]
    found: dict[str, int] = {}
    for body, way in zip(bodies, ways, strict=True):
        k = next((k for k, kind in enumerate(kinds) if np.abs(way - kind).max() <= close), len(kinds))
        if k == len(kinds):
            kinds.append(way)
        found[body.name] = k
    return found


@dataclass(frozen=True, eq=False)
class _Part:
    """Bodies that move as one, and what its joints must exert on it: a force, and a moment about a point of it."""

    path: tuple[Points, Points, Points]  # of that point
    dpsi: Reals
    force: Points
    moment: Reals


class _Moving:
    """The parts of a mechanism that move, and its joints."""

    def __init__(self, mechanism: Mechanism, direction: Direction, phi: Reals) -> None:
        bodies = mechanism.bodies()
        self.motions = mechanism.motion(phi, direction)
        self.follow = followed(bodies, self.motions, phi.shape)
        self._joints = mechanism.joints(direction)
        self._number = parts(mechanism, direction)
        self._by_name = dict(zip(self._number, self.motions, strict=True))
        self._parts: list[_Part] = []
        for k in range(1, 1 + max(self._number.values())):
            name = next(name for name, number in self._number.items() if number == k)
            points = [joint.point for joint in self._joints if k in self._numbers(joint)] or [0j]
            path = self._by_name[name].carry(sum(points) / len(points))
            force = np.zeros(phi.shape, np.complex128)
            self._parts.append(_Part(path, self._by_name[name].dpsi, force, np.zeros(phi.shape)))

    def demand(self, body: str | None, at: Points, force: Points, couple: Reals | float = 0.0) -> None:
        """A point of a body needs a force, and the body a couple; the ground and what is at rest need none."""
        if body is not None and (k := self._number[body]):
            part = self._parts[k - 1]
            part.force[:] += force
            part.moment[:] += _cross(at - part.path[0], force) + couple

    def over_the_whole(self) -> Reactions:
        """The sum over all joints, on level ground."""
        total = np.sum([part.force for part in self._parts], axis=0)[None]
        return Reactions((WHOLE,), total, np.full(total.shape, 1j))

    def at_joints(self) -> Reactions | None:
        """The forces at the joints; None where they do not follow from the motion."""
        if len(self._joints) == len(self._parts) == 1 and not self._joints[0].is_guide:
            force = self._parts[0].force[None]
        else:
            unknown = [(k, each) for k, joint in enumerate(self._joints) for each in _unknown(joint)]
            if not self._joints or len(unknown) + 1 != 3 * len(self._parts):
                return None
            solved = self._solved(unknown)
            if solved is None:
                return None
            force = solved
        turned = [self._by_name[joint.face].psi if joint.face else 0.0 for joint in self._joints]
        across = [joint.normal * np.exp(1j * psi) for joint, psi in zip(self._joints, turned, strict=True)]
        return Reactions(self._joints, force, np.stack([np.broadcast_to(each, force.shape[1:]) for each in across]))

    def _solved(self, unknown: Sequence[tuple[int, complex]]) -> Points | None:
        """The forces at the joints from three equations for each part.

        Forces that balance those needed, plus as much of those that balance one another as the moments ask for: the
        first never change with the rotation, and what is solved at each is one equation a part. There, one more unknown
        turns the parts as they turn: none is needed where the accelerations are those of the equation of motion.
        """
        count, samples = len(self._parts), self._parts[0].force.size
        size = max(abs(a.point - b.point) for a in self._joints for b in self._joints) or 1.0  # for the moments
        balance, turns = np.zeros((2 * count, len(unknown))), np.zeros((samples, count, len(unknown)))
        for column, (j, force) in enumerate(unknown):
            joint = self._joints[j]
            at = self.follow(Spot(next(name for name in joint.bodies[::-1] if self._number[name]), joint.point)).z
            for k, sign in zip(self._numbers(joint)[::-1], (1, -1), strict=False):  # on the last body, and back
                if not k:
                    continue
                if force == COUPLE:
                    turns[:, k - 1, column] = 1.0
                    break  # what keeps the last body level is several, and turns none of them
                balance[2 * k - 2 : 2 * k, column] = sign * force.real, sign * force.imag
                turns[:, k - 1, column] = sign * _cross((at - self._parts[k - 1].path[0]) / size, force)
        if np.linalg.matrix_rank(balance) < 2 * count:
            return None
        needed = np.stack([each for part in self._parts for each in (part.force.real, part.force.imag)])
        balanced = np.linalg.pinv(balance) @ needed
        among = np.linalg.svd(balance)[2][2 * count :].T
        matrix = np.concatenate(
            [turns @ among, np.stack([part.dpsi for part in self._parts], axis=1)[..., None]], axis=2
        )
        moment = np.stack([part.moment / size for part in self._parts], axis=1)
        moment -= np.einsum("nkc,cn->nk", turns, balanced)
        try:
            more = np.linalg.solve(matrix, moment[..., None])[:, :-1, 0]
        except np.linalg.LinAlgError:
            return None
        values = balanced + among @ more.T
        force_at = np.zeros((len(self._joints), samples), np.complex128)
        for column, (j, force) in enumerate(unknown):
            force_at[j] += values[column] * force
        return force_at

    def _numbers(self, joint: Joint) -> list[int]:
        """The parts that a joint joins; 0: the ground, or what is at rest."""
        return [self._number[name] for name in joint.bodies]


def _unknown(joint: Joint) -> list[complex]:
    """The forces that a joint can exert, each along a direction, and a couple."""
    if joint.is_guide:
        return [1j * joint.slide / abs(joint.slide)]
    return [1 + 0j, 1j, *([COUPLE] if joint.level else [])]


def _point(x: Reals, y: Reals) -> Points:
    return np.asarray(x + 1j * y)


def _cross(u: Points, v: Points | complex) -> Reals:
    return np.asarray((np.conj(u) * v).imag)

"""Forces of bodies on one another and on the ground during rocking, and impulses at impacts.

The accelerations follow from the equation of motion, so that Newton's and Euler's equations of each moving body give
the forces at its joints. Bodies that move as one count as one body; bodies at rest count as ground.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isclose

import numpy as np

from rocking_cli.core.bodies import Body
from rocking_cli.core.contacts import Contact, Joint
from rocking_cli.core.hung.attached import Attached, PointMass, Spot
from rocking_cli.core.hung.attachments import followed
from rocking_cli.core.kinematics import Direction, Points, Reals, RigidMotion
from rocking_cli.core.mechanism import Mechanism
from rocking_cli.core.released import Pieces
from rocking_cli.short_repr import short_repr

COMPARED_ROTATIONS = (0.21, 0.47)  # rotations at which motions are compared, over the kinematic limit
EQUAL_MOTION = 1e-9  # largest difference of two motions that count as equal, over the largest displacement
MAX_SHARED_FORCES = 200  # forces up to which their distribution is estimated; with more it takes minutes
MAX_IMBALANCE = 1e-6  # largest imbalance at a joint, over the largest force
UNIT_COUPLE = 0j  # stands for a couple among the unit forces of a joint
WHOLE_JOINT = Joint("", 0j, ())
"""Stands for all joints together if the force at each is not known."""


@short_repr
@dataclass(frozen=True, eq=False)
class Reactions:
    """Forces [N] or impulses at the joints, at n states of motion.

    Parameters
    ----------
    joints : sequence of Joint
        Joints at which the forces act; only `WHOLE_JOINT` if only the sum of the forces is known.
    force : ndarray of complex, shape (k, n)
        Fx + i Fy on the last of the bodies of each joint [N].
    across : ndarray of complex, shape (k, n)
        Unit normal of the face of each joint.
    shared : bool
        Whether the joints are redundant, so that statics alone does not determine the forces: then they are the
        least-squares solution of the equations of equilibrium with the smallest norm.
    """

    joints: Sequence[Joint]
    force: Points
    across: Points
    shared: bool = False

    @property
    def normal(self) -> Reals:
        """Normal force N, positive in compression [N], shape (k, n); NaN at guides."""
        return self._where_faced((self.across.conj() * self.force).real)

    @property
    def shear(self) -> Reals:
        """Shear force T along the face, positive to the right on a level face [N], shape (k, n); NaN at guides."""
        return self._where_faced(-(self.across.conj() * self.force).imag)

    @property
    def is_whole(self) -> bool:
        """Whether only the sum of the forces at all joints is known."""
        return self.joints[0] is WHOLE_JOINT

    @property
    def total(self) -> Points:
        """Sum Fx + i Fy of the forces of the ground, and of bodies at rest, on all moving bodies [N], shape (n,)."""
        alone = [self.is_whole or len(joint.bodies) == 1 for joint in self.joints]
        return np.asarray(self.force[alone].sum(axis=0))

    def _where_faced(self, of: Reals) -> Reals:
        guides = np.array([joint.is_guide for joint in self.joints])
        return np.where(guides[:, None], np.nan, of)


def reactions(
    mechanism: Mechanism, direction: Direction, phi: Reals, rate: Reals, ground: Points | complex = 0j
) -> Reactions:
    """Return the forces at the joints in any number of states of motion.

    Parameters
    ----------
    mechanism : Mechanism
        Any mechanism, with its loads and ties.
    direction : Direction
        Direction of rocking.
    phi, rate : ndarray, shape (n,)
        Rotations in this direction [rad], >= 0, and their rates [rad/s].
    ground : ndarray of complex, shape (n,)
        Ground acceleration u_g'' + i v_g'' [m/s2], of which the plane of motion takes the share `driven` sideways.

    Notes
    -----
    The acceleration is that of Eq. 8, I phi.. + J phi.^2 + (g + v_g'') G + Q = -s B u_g''. The sum of the forces on a
    body is m (z'' + u_g'' + i (g + v_g'')), and their moment about its centroid is I psi''.
    """
    ground = np.broadcast_to(np.asarray(ground, np.complex128), phi.shape)
    turning = acceleration(mechanism, direction, phi, rate, ground)
    ground = mechanism.driven * ground.real + 1j * ground.imag
    going = Going(turning, rate, ground)
    moving = _Moving(mechanism, direction, phi)
    bodies = mechanism.weighed()
    loads = loading(bodies, moving.motions, mechanism.attached, direction, mechanism.gravity, going)
    for body, motion, load in zip(bodies, moving.motions, loads.swapaxes(0, 1), strict=True):
        moving.demand(body.name, motion.carry(body.centroid)[0], -_point(load[:, 0], load[:, 1]), -load[:, 2])
    forces = moving.at_joints()
    if forces is None and (contacts := _instead_of_joints(mechanism, direction)):
        pieces = Pieces(mechanism, direction, phi)
        terms = np.stack([np.ones_like(phi), ground.real, rate**2, ground.imag], axis=-1)
        forces = _at_contacts(pieces, contacts, np.einsum("nqk,nk->nq", pieces.demands(), terms))
    return forces or moving.over_the_whole()


def acceleration(
    mechanism: Mechanism, direction: Direction, phi: Reals, rate: Reals, ground: Points | complex = 0j
) -> Reals:
    """Return phi.. in any number of states of motion [rad/s2]; the arguments are those of `reactions`."""
    ground = np.broadcast_to(np.asarray(ground, np.complex128), phi.shape)
    at = mechanism.coefficients(phi, direction)
    weight = mechanism.gravity + ground.imag
    return np.asarray(-(at.J * rate**2 + weight * at.G + at.Q + direction * at.B * ground.real) / at.I)  # Eq. 8


def at_uplift(mechanism: Mechanism, direction: Direction) -> Reactions:
    """Return the forces at the joints at rest, under the ground acceleration that starts rocking; n = 1."""
    push = -direction * mechanism.uplift(direction) * mechanism.gravity
    return reactions(mechanism, direction, np.zeros(1), np.zeros(1), push)


def impulses(mechanism: Mechanism, ended: Direction) -> Reactions | None:
    """Return the impulses at the joints at an impact, over the rotation rate before it [N s per rad/s], n = 1.

    Parameters
    ----------
    mechanism : Mechanism
        Any mechanism, with its loads and ties.
    ended : Direction
        The direction that the impact ends.

    Returns
    -------
    Reactions or None
        Impulses at the joints of the direction that begins. If there are several joints and the restitution is not that
        of the kinematics, only their sum is known. None if friction does not follow from this sum: on faces that are
        not level, with a guide, or at a side wall.

    Notes
    -----
    The momentum of a body jumps from m t_s to -m eta t_-s, with t the velocity over the rotation rate. The impulse at a
    single joint is the sum of m (eta t_-s + t_s); for a block, |dP_x|/dP_y = (1 - eta)/((1 + eta) tan alpha).
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
    for attachment in mechanism.attached:
        if isinstance(attachment, PointMass):
            jump = eta * moving.follow(attachment.spot).dz + came(attachment.spot).dz
            impulse = _point(
                attachment.mass * attachment.horizontal * jump.real, attachment.mass * attachment.vertical * jump.imag
            )
            moving.demand(attachment.spot.body, moving.follow(attachment.spot).z, impulse)
    if contacts := _instead_of_joints(mechanism, ended.opposite):
        pieces = Pieces(mechanism, ended.opposite, rest)
        before_it = Pieces(mechanism, ended, rest)
        at_joints = _at_contacts(pieces, contacts, eta * pieces.momentum(pieces.dq) + before_it.momentum(before_it.dq))
        if at_joints is not None:
            return at_joints
    joints = mechanism.joints(ended.opposite)
    if len(joints) == 1 or isclose(eta, mechanism.restitution_from_kinematics(ended), rel_tol=1e-9):
        at_joints = moving.at_joints()
        if at_joints is not None:
            return at_joints
    level = all(abs(joint.normal - 1j) < EQUAL_MOTION for joint in joints if len(joint.bodies) == 1)
    return moving.over_the_whole() if level and not any(joint.is_guide for joint in joints) else None


def _instead_of_joints(mechanism: Mechanism, direction: Direction) -> Sequence[Contact]:
    """Return the contacts of a mechanism that gives no joints, because bodies slide or joints are redundant.

    Empty if there are too many.
    """
    contacts = () if mechanism.joints(direction) else mechanism.contacts(direction) or ()
    return contacts if sum(contact.forces for contact in contacts) <= MAX_SHARED_FORCES else ()


def _at_contacts(pieces: Pieces, contacts: Sequence[Contact], demand: Reals) -> Reactions | None:
    """Return the forces at the contacts from three equations for each piece; None if no forces balance `demand`.

    Subscripts of the sums: n are the states, q the equations, r the components of the forces.
    """
    rates, rows = pieces.rates(contacts)
    jacobian = rates.dense()
    balance, needed = (jacobian / pieces.scale).swapaxes(1, 2), demand / pieces.scale
    values = np.einsum("nrq,nq->nr", np.linalg.pinv(balance), needed)
    imbalance = np.abs(np.einsum("nqr,nr->nq", balance, values) - needed)
    if imbalance.max(initial=0.0) > MAX_IMBALANCE * np.abs(needed).max(initial=0.0):
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
        # The normal forces along the unit normal, the shear force across it.
        force.append((values[:, list(normal)].sum(axis=1) - 1j * values[:, shear]) * across[-1])
    if not joints:
        return None
    redundant = jacobian.shape[1] >= jacobian.shape[2]
    return Reactions(joints, np.stack(force), np.stack(across), redundant)


def parts(mechanism: Mechanism, direction: Direction) -> Mapping[str, int]:
    """Return a number for each body, by name: the same number for bodies that move as one, 0 for those at rest."""
    bodies = mechanism.bodies()
    motions = mechanism.motion(np.array(COMPARED_ROTATIONS) * mechanism.limit(direction), direction)
    middle = sum(body.centroid for body in bodies) / len(bodies)
    size = max(abs(body.centroid - middle) for body in bodies) or 1.0
    points = (middle - size, middle + size)  # two points define a plane motion
    displacements = [np.concatenate([motion.carry(point)[0] - point for point in points]) for motion in motions]
    close = EQUAL_MOTION * max(float(np.abs(displacement).max()) for displacement in displacements)
    kinds = [np.zeros_like(displacements[0])]
    part_of: dict[str, int] = {}
    for body, displacement in zip(bodies, displacements, strict=True):
        k = next((k for k, kind in enumerate(kinds) if np.abs(displacement - kind).max() <= close), len(kinds))
        if k == len(kinds):
            kinds.append(displacement)
        part_of[body.name] = k
    return part_of


@dataclass(frozen=True, eq=False)
class _Part:
    """Bodies that move as one, with the force and the moment about a point that its joints must exert on them."""

    path: tuple[Points, Points, Points]  # position of the point, and its first and second derivative
    dpsi: Reals
    force: Points
    moment: Reals


class _Moving:
    """The moving parts of a mechanism, and its joints."""

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
        """Add a force at a point of a body, and a couple, to what its joints must balance; the ground needs none."""
        if body is not None and (k := self._number[body]):
            part = self._parts[k - 1]
            part.force[:] += force
            part.moment[:] += _cross(at - part.path[0], force) + couple

    def over_the_whole(self) -> Reactions:
        """Return the sum of the forces at all joints, for level ground."""
        total = np.sum([part.force for part in self._parts], axis=0)[None]
        return Reactions((WHOLE_JOINT,), total, np.full(total.shape, 1j))

    def at_joints(self) -> Reactions | None:
        """Return the forces at the joints; None if they do not follow from the motion."""
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
        """Solve three equations for each part for the forces at the joints; None if the system is singular.

        The forces are a particular solution of the balance of forces plus its null space: both are the same at all
        rotations, so that only the moment equation of each part is solved at each rotation. One more unknown there, a
        moment that acts along the rotation of the parts, is zero if the accelerations are those of the equation of
        motion.
        """
        count, samples = len(self._parts), self._parts[0].force.size
        size = max(abs(a.point - b.point) for a in self._joints for b in self._joints) or 1.0  # unit of the moments
        balance, turns = np.zeros((2 * count, len(unknown))), np.zeros((samples, count, len(unknown)))
        for column, (j, force) in enumerate(unknown):
            joint = self._joints[j]
            at = self.follow(Spot(next(name for name in joint.bodies[::-1] if self._number[name]), joint.point)).z
            # The force acts on the last body, and its reaction on the other one.
            for k, sign in zip(self._numbers(joint)[::-1], (1, -1), strict=False):
                if not k:
                    continue
                if force == UNIT_COUPLE:
                    turns[:, k - 1, column] = 1.0
                    break  # several bodies keep the last one level, and none of them is turned
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
        """Return the numbers of the parts that a joint joins; 0 for the ground, or a body at rest."""
        return [self._number[name] for name in joint.bodies]


def _unknown(joint: Joint) -> list[complex]:
    """Return the unknown forces of a joint as unit vectors, and a couple if it keeps a body level."""
    if joint.is_guide:
        return [1j * joint.slide / abs(joint.slide)]
    return [1 + 0j, 1j, *([UNIT_COUPLE] if joint.level else [])]


def _point(x: Reals, y: Reals) -> Points:
    return np.asarray(x + 1j * y)


def _cross(u: Points, v: Points | complex) -> Reals:
    return np.asarray((np.conj(u) * v).imag)


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
    loads = np.zeros((len(going.rate), len(bodies), 3))
    centres = []
    for k, (body, motion) in enumerate(zip(bodies, motions, strict=True)):
        z, dz, ddz = motion.carry(body.centroid)
        centres.append(z)
        force = -body.mass * (dz * going.turning + ddz * going.rate**2 + weight)
        loads[:, k, 0], loads[:, k, 1] = force.real, force.imag
        loads[:, k, 2] = -body.inertia * (motion.dpsi * going.turning + motion.ddpsi * going.rate**2)

    def add(body: str | None, at: Points, force: Points) -> None:
        if body is not None:
            k = index[body]
            loads[:, k, 0] += force.real
            loads[:, k, 1] += force.imag
            loads[:, k, 2] += (np.conj(at - centres[k]) * force).imag

    for attachment in attached:
        if isinstance(attachment, PointMass):
            z, dz, ddz = follow(attachment.spot)
            moved = dz * going.turning + ddz * going.rate**2
            across = attachment.mass * attachment.horizontal * (moved.real + weight.real)
            up = attachment.mass * (attachment.vertical * moved.imag + attachment.weight * weight.imag)
            add(attachment.spot.body, z, -(across + 1j * up))
        for push in attachment.forces(direction, follow):
            add(push.spot.body, follow(push.spot).z, push.force)
    return loads

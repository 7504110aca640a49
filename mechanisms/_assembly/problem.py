"""An assembly as a linear programme: the forces of its joints, and the loads on its blocks.

A joint exerts normal forces at its points, and a shear force along its face. Each row of `Bearings.rates` is the
relative velocity of the two bodies on which one such unit force does work, as a combination of the velocities of all
blocks; the transpose gives the forces and moments on the blocks. With friction, the force at a point lies between two
edges of a cone, which are rays. Rays and normal forces are at least zero, and so are their velocities; all other forces
are free, and their velocities are zero.

Unknowns have no units: velocities (vx, vy, omega size) of each block about its centroid, moments over `size`. All
matrices are sparse, because a row has entries of two blocks at most.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from mechanisms._assembly.blocks import AssemblyBlock, AssemblyContact, NothingMoves
from mechanisms._assembly.programme import Sparse, beside, from_entries, least, unit_columns
from rocking_cli.core import Direction, Guide, Reals
from rocking_cli.core.kinematics import Points

MAX_MULTIPLIER = 1e4  # above it the assembly counts as immovable
ZERO_LOAD = 1e-9  # forces, over the weight, and multipliers that count as zero


@dataclass(frozen=True, eq=False)
class AssemblyProblem:
    """An assembly and its loads without units: moments over the size, forces over the weight.

    The live forces are divided by the sum of their sizes, `strength`, so that their unit does not matter. `inertia` is
    that of the blocks alone, as forces and moments per unit of their accelerations over gravity.
    """

    frame: Frame
    bearings: Bearings
    dead: Reals
    live: Reals
    weight: float
    strength: float
    inertia: Reals

    @classmethod
    def of(
        cls,
        blocks: Sequence[AssemblyBlock],
        contacts: Sequence[AssemblyContact],
        guides: Sequence[Guide] = (),
        direction: Direction = Direction.POSITIVE,
        *,
        dead: Reals | None = None,
        live: Reals | None = None,
        gravity: float = 9.80665,
    ) -> AssemblyProblem:
        """Return the linear programme of an assembly; arguments are those of `collapse`."""
        weights = np.array([block.mass for block in blocks]) * gravity
        nothing = np.zeros_like(weights)
        frame = Frame.of(blocks)
        dead = np.column_stack([nothing, -weights, nothing]) if dead is None else dead
        live = np.column_stack([int(direction) * weights, nothing, nothing]) if live is None else live
        weight = float(np.abs(dead[:, :2]).sum())
        if weight == 0:
            raise NothingMoves("the blocks have no weight", frame.names)
        pull = scaled(live, frame, weight)
        strength = float(np.abs(pull).sum())
        if strength == 0:
            raise NothingMoves("nothing acts on the blocks but what is always there", frame.names)
        bearings = Bearings.of(frame, contacts, guides)
        turns = np.array([block.inertia for block in blocks]) * gravity / frame.size
        inertia = scaled(np.column_stack([weights, weights, turns]), frame, weight)
        return cls(frame, bearings, scaled(dead, frame, weight), pull / strength, weight, strength, inertia)

    def greatest(self, rays: Rays, *, exact: bool = False) -> tuple[float, Reals, Reals]:
        """Return the greatest multiplier of `live`, the forces of the rays that carry it, and the velocities."""
        optimum = least(
            np.append(np.zeros(rays.count), -1.0),
            beside([rays.rates.T, self.live]),
            -self.dead,
            np.append(rays.low, 0.0),
            np.append(np.full(rays.count, np.inf), MAX_MULTIPLIER),
            exact=exact,
        )
        if optimum is None:
            return -np.inf, np.zeros(rays.count), np.zeros(len(self.dead))
        return -optimum.value, optimum.x[:-1], -optimum.prices

    def why_not(self, rays: Rays) -> tuple[str, ...]:
        """Return the names of the blocks that no forces hold at rest; empty if the assembly stands."""
        unbounded = np.full(rays.count, np.inf)
        if least(np.zeros(rays.count), rays.rates.T.tocsc(), -self.dead, rays.low, unbounded) is not None:
            return ()
        missing, names = self.unheld(rays)
        return names if missing > ZERO_LOAD else ()

    def unheld(self, rays: Rays) -> tuple[float, tuple[str, ...]]:
        """Return the least additional forces that hold all blocks at rest, and the blocks that need them."""
        n = len(self.dead)
        extra = unit_columns(np.arange(n), n)
        optimum = least(
            np.append(np.zeros(rays.count), np.ones(2 * n)),
            beside([rays.rates.T, extra, -extra]),
            -self.dead,
            np.append(rays.low, np.zeros(2 * n)),
            np.full(rays.count + 2 * n, np.inf),
        )
        assert optimum is not None  # the extra forces balance anything
        return optimum.value, moving(self.frame.names, optimum.prices, 1e-6)

    def by_contact(self, values: Reals) -> tuple[Reals, Reals, Reals]:
        """Split a value for each force into those of both ends of each joint, of its shear, and of the guides."""
        n = len(self.bearings.contact)
        joints = values[: 3 * n].reshape(n, 3)
        return joints[:, :2], joints[:, 2], values[3 * n :]


Bools = NDArray[np.bool_]
Indices = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class VelocityRows:
    """Relative velocities, one in each row: of a point of one body relative to another body, along a direction.

    Parameters
    ----------
    one, other : ndarray of int
        Numbers of the two bodies, -1 for the ground; the velocity is that of `other` relative to `one`.
    points : ndarray of complex
        The points [m].
    ways : ndarray of complex
        The directions.
    """

    one: Indices
    other: Indices
    points: Points
    ways: Points


@dataclass(frozen=True, eq=False)
class Frame:
    """The blocks in the order of the unknowns, with their centroids [m] and the size of the assembly [m]."""

    names: tuple[str, ...]
    centroids: tuple[complex, ...]
    size: float

    @classmethod
    def of(cls, blocks: Sequence[AssemblyBlock]) -> Frame:
        """Build the frame of blocks at rest."""
        corners = np.array([corner for block in blocks for corner in block.corners])
        size = float(np.ptp(corners.real) + np.ptp(corners.imag))
        return cls(tuple(block.name for block in blocks), tuple(block.centroid for block in blocks), size)

    @cached_property
    def index(self) -> Mapping[str, int]:
        """Number of each block in the order of the unknowns."""
        return {name: k for k, name in enumerate(self.names)}

    def rates(self, rows: VelocityRows) -> Sparse:
        """Build the matrix of relative velocities, shape (rows, 3 blocks)."""
        block, along = np.concatenate([rows.other, rows.one]), np.tile(rows.ways, 2)
        moves = block >= 0
        row = np.tile(np.arange(len(rows.one)), 2)[moves]
        sign = np.repeat([1.0, -1.0], len(rows.one))[moves]
        block, along, points = block[moves], along[moves], np.tile(rows.points, 2)[moves]
        arm = (points - np.array(self.centroids, np.complex128)[block]) / self.size
        values = sign * np.array([along.real, along.imag, (arm.conj() * along).imag])
        columns = 3 * block + np.arange(3)[:, None]
        return from_entries(np.tile(row, 3), columns.ravel(), values.ravel(), (len(rows.one), 3 * len(self.names)))


@dataclass(frozen=True, eq=False)
class Bearings:
    """Forces of all joints and guides, by points; the rows of `rates` are the velocities on which they do work.

    Parameters
    ----------
    frame : Frame
        The blocks.
    rows : VelocityRows
        Normal at each point and shear of each joint, joint after joint; then the guides.
    carried, turned : ndarray of int
        For each row, the body that carries its point, and the body with which its direction turns.
    contact : ndarray of int
        Number of the contact, for each joint that bears.
    count : ndarray of int
        Number of points at which each joint bears.
    friction : ndarray
        Coefficient of friction of each joint; NaN if it never slides.
    """

    frame: Frame
    rows: VelocityRows
    carried: Indices
    turned: Indices
    contact: Indices
    count: Indices
    friction: Reals

    @classmethod
    def of(
        cls,
        frame: Frame,
        contacts: Sequence[AssemblyContact],
        guides: Sequence[Guide],
        ends: Sequence[tuple[int, ...]] | None = None,
    ) -> Bearings:
        """Return the forces of guides, and of joints that bear at the given `ends`; by default at both ends."""
        rows: list[tuple[int, int, complex, complex, int, int]] = []
        bear = [(k, (0, 1) if ends is None else ends[k]) for k in range(len(contacts)) if ends is None or ends[k]]
        number = frame.index
        for k, at in bear:
            contact = contacts[k]
            a, b = number.get(contact.a, -1), number.get(contact.b, -1)
            # A hinge turns with the face that the corner bears on; both bodies of a closed joint turn alike.
            face = number.get(contact.face_at(at[0]) if len(at) == 1 else contact.a, -1)
            rows += [(a, b, contact.ends[end], contact.normal, a, face) for end in at]
            rows.append((a, b, contact.ends[at[0]], -1j * contact.normal, a, face))
        for guide in guides:
            body = number[guide.bodies[0]]
            rows.append((-1, body, guide.at, 1j * guide.along / abs(guide.along), body, -1))
        one, other, points, along, carried, turned = zip(*rows, strict=True) if rows else ((),) * 6
        return cls(
            frame,
            VelocityRows(
                _indices(one), _indices(other), np.array(points, np.complex128), np.array(along, np.complex128)
            ),
            _indices(carried),
            _indices(turned),
            _indices([k for k, _ in bear]),
            _indices([len(at) for _, at in bear]),
            np.array([contacts[k].friction for k, _ in bear], np.float64),
        )

    def moved(self, centroids: Points, turns: Points) -> Bearings:
        """Return the forces of joints in a displaced position: centroids [m], and rotations as unit complex factors."""
        # Index -1 is the ground, appended as the last entry.
        before, after = (np.append(np.asarray(z, np.complex128), 0) for z in (self.frame.centroids, centroids))
        turn, by = np.append(turns, 1), self.carried
        points = after[by] + turn[by] * (self.rows.points - before[by])
        rows = replace(self.rows, points=points, ways=self.rows.ways * turn[self.turned])
        return replace(self, frame=replace(self.frame, centroids=tuple(centroids.tolist())), rows=rows)

    @cached_property
    def rates(self) -> Sparse:
        """Velocities on which the forces do work, shape (forces, 3 blocks); see the module."""
        return self.frame.rates(self.rows)

    @cached_property
    def shears(self) -> Indices:
        """Index of the row with the shear of each joint, which follows the rows of its normals."""
        return np.asarray(np.cumsum(self.count + 1) - 1, np.intp)

    def rays(self, max_friction: float | None = None, *, usual: float | None = None) -> Rays:
        """Return the rays of the forces.

        The friction of joints is limited to `max_friction`; joints without given friction have `usual`.
        """
        mu = self.friction if usual is None else np.where(np.isnan(self.friction), usual, self.friction)
        mu = mu if max_friction is None else np.fmin(mu, max_friction)
        # Two edges of a cone at each point with friction, else its normal alone.
        joint = np.repeat(np.arange(len(mu)), self.count)
        normal = np.arange(len(joint)) + joint
        edges = np.where(mu[joint] > 0, 2, 1)
        of = np.repeat(np.arange(len(joint)), edges)
        second = np.diff(of, prepend=-1) == 0
        share = np.where(edges[of] == 2, np.where(second, -1.0, 1.0) * mu[joint[of]], 0.0)
        glued = np.flatnonzero(np.isnan(mu))
        guides = np.arange(len(joint) + len(mu), self.rates.shape[0])
        force = np.concatenate([normal[of], self.shears[glued], guides])
        ray, slips = np.arange(len(force)), np.flatnonzero(share)
        mix = from_entries(
            np.append(ray, slips),
            np.append(force, self.shears[joint[of[slips]]]),
            np.append(np.ones(len(ray)), share[slips]),
            (len(ray), self.rates.shape[0]),
        )
        owner = np.concatenate([self.contact[joint[of]], self.contact[glued], np.full(len(guides), -1)])
        return Rays(mix @ self.rates, mix, ray < len(of), owner)


def _indices(numbers: Sequence[int]) -> Indices:
    return np.array(numbers, np.intp)


@dataclass(frozen=True, eq=False)
class Rays:
    """Forces that each joint can exert, as multiples of rays: normal forces, edges of friction cones, or free forces.

    Parameters
    ----------
    rates : sparse array, shape (rays, 3 blocks)
        Velocity on which each ray does work.
    mix : sparse array, shape (rays, forces)
        Forces of each ray.
    one_sided : ndarray of bool
        Which multipliers must be at least zero.
    contact : ndarray of int
        Contact of each ray, -1 for guides.
    """

    rates: Sparse
    mix: Sparse
    one_sided: Bools
    contact: Indices

    @property
    def count(self) -> int:
        """Number of rays."""
        return len(self.one_sided)

    @property
    def low(self) -> Reals:
        """Lower bound of each ray multiplier."""
        return np.where(self.one_sided, 0.0, -np.inf)


def scaled(forces: Reals, frame: Frame, weight: float) -> Reals:
    """Return forces and moments (Fx, Fy, M) of all blocks without units, as a vector."""
    return np.asarray(forces / np.array([1.0, 1.0, frame.size]) / weight).ravel()


def moving(names: Sequence[str], velocity: Reals, tolerance: float) -> tuple[str, ...]:
    """Return the names of the blocks whose speed exceeds a tolerance, given as a fraction of the largest speed."""
    fast = np.abs(velocity.reshape(-1, 3)).max(axis=1)
    return tuple(name for name, speed in zip(names, fast, strict=True) if speed > tolerance * fast.max())

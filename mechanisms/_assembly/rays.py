"""The forces that joints can exert, and the velocities that they resist: one matrix for both theorems.

A joint bears at its points along its normal and along itself. Each row of `Bearings.rates` is the velocity of the
second body relative to the first that one such unit force does work on, as a combination of the velocities of all
blocks: its transpose gives the forces and moments on the blocks. With friction the forces of a point lie between two
edges of a cone; such a ray, as every normal force, is at least zero, and its velocity too. All other forces are free,
and their velocities zero.

Unknowns have no units: velocities (vx, vy, omega size) of each block about its centroid, moments over `size`. All
matrices are sparse, because a row has entries of two blocks at most.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from mechanisms._assembly.blocks import AssemblyBlock, AssemblyContact, AssemblyGuide
from mechanisms._assembly.sparse import Sparse, from_entries
from mechanisms._polygons import Points
from rocking_cli.core import Reals

Bools = NDArray[np.bool_]
Indices = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class VelocityRows:
    """Relative velocities, one a row: that of a point of one body relative to another, along a direction.

    Parameters
    ----------
    one, other : ndarray of int
        The two bodies by their numbers, -1 for what does not move; it is the other that moves relative to the one.
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
    """The blocks in the order of the unknowns, where their centroids are [m], and the size of the whole [m]."""

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
        block, ways = np.concatenate([rows.other, rows.one]), np.tile(rows.ways, 2)
        moves = block >= 0
        row = np.tile(np.arange(len(rows.one)), 2)[moves]
        sign = np.repeat([1.0, -1.0], len(rows.one))[moves]
        block, ways, points = block[moves], ways[moves], np.tile(rows.points, 2)[moves]
        arm = (points - np.array(self.centroids, np.complex128)[block]) / self.size
        values = sign * np.array([ways.real, ways.imag, (arm.conj() * ways).imag])
        columns = 3 * block + np.arange(3)[:, None]
        return from_entries(np.tile(row, 3), columns.ravel(), values.ravel(), (len(rows.one), 3 * len(self.names)))


@dataclass(frozen=True, eq=False)
class Bearings:
    """The forces of all joints and guides, by points: rows of `rates` are their velocities.

    Parameters
    ----------
    frame : Frame
        The blocks.
    rows : VelocityRows
        The normals of the points of each joint and its shear, joint after joint; then the guides.
    carried, turned : ndarray of int
        Of each row the body that its point is carried by, and the one that its direction turns with.
    contact : ndarray of int
        Of each joint that bears the contact that it is.
    count : ndarray of int
        At how many points each bears.
    friction : ndarray
        Their coefficients of friction; not a number if they never slide.
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
        guides: Sequence[AssemblyGuide],
        ends: Sequence[tuple[int, ...]] | None = None,
    ) -> Bearings:
        """Of joints that bear at some of their ends, or not at all, and of guides; without `ends`, at both."""
        rows: list[tuple[int, int, complex, complex, int, int]] = []
        bear = [(k, (0, 1) if ends is None else ends[k]) for k in range(len(contacts)) if ends is None or ends[k]]
        number = frame.index
        for k, at in bear:
            each = contacts[k]
            a, b = number.get(each.a, -1), number.get(each.b, -1)
            # Of a hinge the face that the corner bears on; both bodies of a closed joint turn alike.
            face = number.get(each.face_at(at[0]) if len(at) == 1 else each.a, -1)
            rows += [(a, b, each.ends[end], each.normal, a, face) for end in at]
            rows.append((a, b, each.ends[at[0]], -1j * each.normal, a, face))
        for guide in guides:
            body = number[guide.body]
            rows.append((-1, body, guide.at, 1j * guide.along / abs(guide.along), body, -1))
        one, other, points, ways, carried, turned = zip(*rows, strict=True) if rows else ((),) * 6
        return cls(
            frame,
            VelocityRows(
                _indices(one), _indices(other), np.array(points, np.complex128), np.array(ways, np.complex128)
            ),
            _indices(carried),
            _indices(turned),
            _indices([k for k, _ in bear]),
            _indices([len(at) for _, at in bear]),
            np.array([contacts[k].friction for k, _ in bear], np.float64),
        )

    def moved(self, centroids: Points, turns: Points) -> Bearings:
        """The same where the blocks have moved: their centroids [m], and how far each has turned as a factor."""
        # What does not move is the last of each, which -1 finds.
        before, after = (np.append(np.asarray(z, np.complex128), 0) for z in (self.frame.centroids, centroids))
        turn, by = np.append(turns, 1), self.carried
        points = after[by] + turn[by] * (self.rows.points - before[by])
        rows = replace(self.rows, points=points, ways=self.rows.ways * turn[self.turned])
        return replace(self, frame=replace(self.frame, centroids=tuple(centroids.tolist())), rows=rows)

    @cached_property
    def rates(self) -> Sparse:
        """Velocities that the forces do work on, shape (forces, 3 blocks)."""
        return self.frame.rates(self.rows)

    @cached_property
    def shears(self) -> Indices:
        """Of each joint the row of its shear, after those of its normals."""
        return np.asarray(np.cumsum(self.count + 1) - 1, np.intp)

    def rays(self, most: float | None = None, *, usual: float | None = None) -> Rays:
        """The rays of its forces; no joint may have more friction than `most`, and one without has `usual`."""
        mu = self.friction if usual is None else np.where(np.isnan(self.friction), usual, self.friction)
        mu = mu if most is None else np.fmin(mu, most)
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
    """What each joint can exert, as multiples of rays.

    Parameters
    ----------
    rates : sparse array, shape (rays, 3 blocks)
        The velocity that each does work on.
    mix : sparse array, shape (rays, forces)
        The forces of each.
    one_sided : ndarray of bool
        Which are at least zero.
    contact : ndarray of int
        The contact of each, -1 for guides.
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
    """Forces and moments (Fx, Fy, M) of each block without units, in one row."""
    return np.asarray(forces / np.array([1.0, 1.0, frame.size]) / weight).ravel()


def moving(names: Sequence[str], velocity: Reals, tolerance: float) -> tuple[str, ...]:
    """The blocks whose velocities are more than nothing, of one row of all."""
    fast = np.abs(velocity.reshape(-1, 3)).max(axis=1)
    return tuple(name for name, speed in zip(names, fast, strict=True) if speed > tolerance * fast.max())

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
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from mechanisms._assembly.blocks import Block, Contact, Guide
from mechanisms._assembly.sparse import Sparse, from_entries
from rocking_cli.core import Reals

Bools = NDArray[np.bool_]
Indices = NDArray[np.intp]
Row = tuple[str | None, str, complex, complex]
Entry = tuple[int, float, int, int]  # force, its share of the shear, the shear, contact


@dataclass(frozen=True)
class Bearing:
    """Where and how a joint bears: at rest at its two ends, displaced perhaps at one alone."""

    contact: int
    a: str
    b: str
    points: tuple[complex, ...]
    normal: complex
    friction: float | None


@dataclass(frozen=True, eq=False)
class Frame:
    """The blocks in the order of the unknowns, where their centroids are [m], and the size of the whole [m]."""

    names: tuple[str, ...]
    centroids: tuple[complex, ...]
    size: float

    @classmethod
    def of(cls, blocks: Sequence[Block]) -> Frame:
        """Build the frame of blocks at rest."""
        corners = np.array([corner for block in blocks for corner in block.corners])
        size = float(np.ptp(corners.real) + np.ptp(corners.imag))
        return cls(tuple(block.name for block in blocks), tuple(block.centroid for block in blocks), size)

    @cached_property
    def index(self) -> Mapping[str, int]:
        """Number of each block in the order of the unknowns."""
        return {name: k for k, name in enumerate(self.names)}

    def rates(self, rows: Sequence[Row]) -> Sparse:
        """Build the matrix of relative velocities, shape (rows, 3 blocks).

        Parameters
        ----------
        rows : sequence of (str or None, str, complex, complex)
            Bodies `a` and `b`, a point [m] and a direction: the velocity along it of that point of `b` relative to
            `a`. What is not a block does not move.
        """
        sides = [
            (k, self.index[name], sign, point, way)
            for k, (a, b, point, way) in enumerate(rows) for name, sign in ((b, 1.0), (a, -1.0))
            if name is not None and name in self.index
        ]  # fmt: skip
        if not sides:
            return from_entries([], [], [], (len(rows), 3 * len(self.names)))
        row, block, signs, points, ways = (np.array(each) for each in zip(*sides, strict=True))
        arm = (points - np.array(self.centroids)[block]) / self.size
        values = signs * np.array([ways.real, ways.imag, (arm.conj() * ways).imag])
        columns = 3 * block + np.arange(3)[:, None]
        return from_entries(np.tile(row, 3), columns.ravel(), values.ravel(), (len(rows), 3 * len(self.names)))


@dataclass(frozen=True, eq=False)
class Bearings:
    """The forces of all joints and guides, by points: rows of `rates` are their velocities.

    Parameters
    ----------
    bearings : tuple of Bearing
        The joints.
    rates : sparse array, shape (forces, 3 blocks)
        The normals of the points of each joint and its shear, joint after joint; then the guides.
    starts : tuple of int
        Of each joint the row of its first normal.
    """

    bearings: tuple[Bearing, ...]
    rates: Sparse
    starts: tuple[int, ...]

    @classmethod
    def of(cls, frame: Frame, bearings: Sequence[Bearing], guides: Sequence[Guide]) -> Bearings:
        """Of joints and guides where they are."""
        rows: list[Row] = []
        starts = []
        for each in bearings:
            starts.append(len(rows))
            rows += [(each.a, each.b, point, each.normal) for point in each.points]
            rows.append((each.a, each.b, each.points[0], -1j * each.normal))
        rows += [(None, guide.body, guide.at, 1j * guide.along / abs(guide.along)) for guide in guides]
        return cls(tuple(bearings), frame.rates(rows), tuple(starts))

    def rays(self, most: float | None = None, *, usual: float | None = None) -> Rays:
        """The rays of its forces; no joint may have more friction than `most`, and one without has `usual`."""
        sided: list[Entry] = []
        free: list[Entry] = []
        last = 0
        for each, start in zip(self.bearings, self.starts, strict=True):
            shear = start + len(each.points)
            own = usual if each.friction is None else each.friction
            limits = [mu for mu in (own, most) if mu is not None]
            mu = min(limits) if limits else None
            for k in range(start, shear):
                if mu is None or mu <= 0:
                    sided.append((k, 0.0, shear, each.contact))
                else:
                    sided += [(k, mu, shear, each.contact), (k, -mu, shear, each.contact)]
            if mu is None:
                free.append((shear, 0.0, shear, each.contact))
            last = shear + 1
        free += [(k, 0.0, k, -1) for k in range(last, self.rates.shape[0])]
        entries = np.array([*sided, *free], np.float64).reshape(-1, 4).T
        share, (force, shear_of, owner) = entries[1], entries[[0, 2, 3]].astype(np.intp)
        ray = np.arange(len(force))
        slips = share != 0
        mix = from_entries(
            np.append(ray, ray[slips]),
            np.append(force, shear_of[slips]),
            np.append(np.ones(len(ray)), share[slips]),
            (len(ray), self.rates.shape[0]),
        )
        return Rays(mix @ self.rates, mix, ray < len(sided), owner)


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


def at_rest(contacts: Sequence[Contact]) -> list[Bearing]:
    """Joints that bear at both ends."""
    return [Bearing(k, c.a, c.b, c.ends, c.normal, c.friction) for k, c in enumerate(contacts)]


def scaled(forces: Reals, frame: Frame, weight: float) -> Reals:
    """Forces and moments (Fx, Fy, M) of each block without units, in one row."""
    return np.asarray(forces / np.array([1.0, 1.0, frame.size]) / weight).ravel()


def moving(names: Sequence[str], velocity: Reals, tolerance: float) -> tuple[str, ...]:
    """The blocks whose velocities are more than nothing, of one row of all."""
    fast = np.abs(velocity.reshape(-1, 3)).max(axis=1)
    return tuple(name for name, speed in zip(names, fast, strict=True) if speed > tolerance * fast.max())

"""The forces that joints can exert, and the velocities that they resist: one matrix for both theorems.

A joint bears at its points along its normal and along itself. Each row of `Bearings.rates` is the velocity of the
second body relative to the first that one such unit force does work on, as a combination of the velocities of all
blocks: its transpose gives the forces and moments on the blocks. With friction the forces of a point lie between two
edges of a cone; such a ray, as every normal force, is at least zero, and its velocity too. All other forces are free,
and their velocities zero.

Unknowns have no units: velocities (vx, vy, omega size) of each block about its centroid, moments over `size`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mechanisms._assembly.blocks import Block, Contact, Guide
from rocking_cli.core import Reals

Bools = NDArray[np.bool_]
Indices = NDArray[np.intp]


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

    def rate(self, a: str | None, b: str, point: complex, way: complex) -> Reals:
        """The velocity along `way` of a point of `b` relative to `a`, as a row over the velocities of all blocks."""
        row = np.zeros((len(self.names), 3))
        for name, sign in ((b, 1.0), (a, -1.0)):
            if name in self.names:  # the ground does not move
                k = self.names.index(name)
                arm = (point - self.centroids[k]) / self.size
                row[k] = sign * np.array([way.real, way.imag, (arm.conjugate() * way).imag])
        return row.ravel()


@dataclass(frozen=True, eq=False)
class Bearings:
    """The forces of all joints and guides, by points: rows of `rates` are their velocities.

    Parameters
    ----------
    bearings : tuple of Bearing
        The joints.
    rates : ndarray, shape (forces, 3 blocks)
        The normals of the points of each joint and its shear, joint after joint; then the guides.
    starts : tuple of int
        Of each joint the row of its first normal.
    """

    bearings: tuple[Bearing, ...]
    rates: Reals
    starts: tuple[int, ...]

    @classmethod
    def of(cls, frame: Frame, bearings: Sequence[Bearing], guides: Sequence[Guide]) -> Bearings:
        """Of joints and guides where they are."""
        rows: list[Reals] = []
        starts = []
        for each in bearings:
            starts.append(len(rows))
            rows += [frame.rate(each.a, each.b, point, each.normal) for point in each.points]
            rows.append(frame.rate(each.a, each.b, each.points[0], -1j * each.normal))
        rows += [frame.rate(None, guide.body, guide.at, 1j * guide.along / abs(guide.along)) for guide in guides]
        return cls(tuple(bearings), np.array(rows).reshape(-1, 3 * len(frame.names)), tuple(starts))

    def rays(self, most: float | None = None, *, usual: float | None = None) -> Rays:
        """The rays of its forces; no joint may have more friction than `most`, and one without has `usual`."""
        rows: list[tuple[int, float, int | None]] = []  # force, friction, shear
        free: list[int] = []
        for each, start in zip(self.bearings, self.starts, strict=True):
            shear = start + len(each.points)
            own = usual if each.friction is None else each.friction
            limits = [mu for mu in (own, most) if mu is not None]
            mu = min(limits) if limits else None
            for k in range(start, shear):
                if mu is None or mu <= 0:
                    rows.append((k, 0.0, None))
                else:
                    rows += [(k, mu, shear), (k, -mu, shear)]
            if mu is None:
                free.append(shear)
        last = self.starts[-1] + len(self.bearings[-1].points) + 1 if self.bearings else 0
        free += range(last, len(self.rates))
        mix = np.zeros((len(rows) + len(free), len(self.rates)))
        for r, (force, mu, shear_of) in enumerate(rows):
            mix[r, force] = 1.0
            if shear_of is not None:
                mix[r, shear_of] = mu
        mix[range(len(rows), len(mix)), free] = 1.0
        owner = np.full(len(self.rates), -1)
        for each, start in zip(self.bearings, self.starts, strict=True):
            owner[start : start + len(each.points) + 1] = each.contact
        one_sided = np.arange(len(mix)) < len(rows)
        return Rays(mix @ self.rates, mix, one_sided, owner[np.abs(mix).argmax(axis=1)])


@dataclass(frozen=True, eq=False)
class Rays:
    """What each joint can exert, as multiples of rays.

    Parameters
    ----------
    rates : ndarray, shape (rays, 3 blocks)
        The velocity that each does work on.
    mix : ndarray, shape (rays, forces)
        The forces of each.
    one_sided : ndarray of bool
        Which are at least zero.
    contact : ndarray of int
        The contact of each, -1 for guides.
    """

    rates: Reals
    mix: Reals
    one_sided: Bools
    contact: Indices

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

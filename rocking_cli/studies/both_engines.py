"""One motion by both engines: the mechanism with one degree of freedom, and the same bodies as free blocks."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from math import nan
from typing import Literal

import numpy as np

from rocking_cli.arrays import Bools, Points, Reals
from rocking_cli.core import Contact, Direction, Mechanism
from rocking_cli.dynamics.history import History
from rocking_cli.short_repr import short_repr
from rocking_cli.studies.engines.blocks import BlockMotion
from rocking_cli.studies.engines.free import MOVED
from rocking_cli.studies.engines.free_blocks import FreeBlocks

SAME_PEAKS = 0.05  # largest relative difference of peaks that agree
PARTED = 0.05  # difference of two rotations, over the larger of both peaks, from which they have parted
Finding = Literal["agree", "peaks_differ", "outcomes_differ", "exact_unknown"]


@dataclass(frozen=True)
class BlockJoint:
    """A joint that the mechanism keeps closed, in a motion of free blocks.

    Parameters
    ----------
    name : str
        Name of the joint.
    opening, slip : float
        Largest distance that its faces open, and that they slide along each other from rest [m], while the structure
        rocks in a direction in which the mechanism keeps it closed.
    passed : float
        First time at which either is more than the limit of the exact engine [s]; NaN if never, or without a limit.
    friction : float
        Largest shear over normal force of its blocks at any time; NaN if they do not press against each other.
    """

    name: str
    opening: float
    slip: float
    passed: float
    friction: float


@short_repr
@dataclass(frozen=True, eq=False, kw_only=True)
class BothEngines:
    """The motion of a structure by both engines.

    Parameters
    ----------
    exact, of_blocks : History
        The history by the exact engine, and that of the same rotation by free blocks.
    moved : BlockMotion
        The motion of the free blocks.
    free : FreeBlocks
        The blocks.
    joints : sequence of BlockJoint
        The joints that the mechanism keeps closed, those that open or slide most first; empty if they are not known.
    """

    exact: History
    of_blocks: History
    moved: BlockMotion
    free: FreeBlocks
    joints: list[BlockJoint]

    @property
    def friction(self) -> tuple[tuple[str, str], float]:
        """The pair of free blocks with the largest shear over normal force ("" is the ground), and this ratio."""
        pairs = self.moved.friction
        pair = max(pairs, key=lambda each: pairs[each], default=("", ""))
        return pair, float(pairs.get(pair, nan))

    @cached_property
    def compared(self) -> int:
        """Number of samples at which both are known: until a structure overturns, or the exact outcome is unknown."""
        return min(self.of_blocks.time.size, int(np.isfinite(self.extended(self.exact.phi)).sum()))

    @property
    def compared_to(self) -> float:
        """Time until which both are compared [s]."""
        return float(self.of_blocks.time[self.compared - 1])

    @property
    def peaks(self) -> tuple[float, float]:
        """Largest rotation over the critical one of each until `compared_to`."""
        exact, blocks = (
            np.abs(each[: self.compared]) for each in (self.extended(self.exact.ratio), self.of_blocks.ratio)
        )
        return float(exact.max()), float(blocks.max())

    @property
    def peak_quotient(self) -> float:
        """The peak of free blocks over that of the exact engine, both until `compared_to`.

        NaN if either overturns by then, or if the exact one does not rotate.
        """
        exact, blocks = self.peaks
        ended = self.exact.fell or (self.of_blocks.fell and self.of_blocks.time.size == self.compared)
        return nan if ended or not exact else blocks / exact

    @property
    def parted(self) -> float:
        """First time at which both rotations differ by more than `PARTED` of the larger peak [s]; NaN if never.

        Both are those until `compared_to`. Smaller differences than free blocks turn by without uplift do not count.
        """
        exact, blocks = self.extended(self.exact.ratio)[: self.compared], self.of_blocks.ratio[: self.compared]
        apart = np.abs(exact - blocks) > max(PARTED * max(self.peaks), MOVED)
        return _first(self.of_blocks.time[: self.compared], apart)

    @property
    def finding(self) -> Finding:
        """Whether both engines agree: on whether the structure overturns, and on its peak within `SAME_PEAKS`."""
        if self.exact.unknown:
            return "exact_unknown"
        if self.exact.fell != self.of_blocks.fell:
            return "outcomes_differ"
        exact, blocks = self.exact.peak_ratio, self.of_blocks.peak_ratio
        far = not self.exact.fell and abs(blocks - exact) > max(SAME_PEAKS * exact, MOVED)
        return "peaks_differ" if far else "agree"

    def extended(self, values: Reals) -> Reals:
        """Return samples of the exact history at the times of the free blocks: it stays at rest if it came to rest."""
        after = 0.0 if self.exact.at_rest else nan
        return np.append(values, np.full(max(0, self.of_blocks.time.size - values.size), after))


def compare(
    mechanism: Mechanism, exact: History, of_blocks: History, moved: BlockMotion, free: FreeBlocks
) -> BothEngines:
    """Return the comparison of a nonlinear history with the motion of free blocks; parameters as of `BothEngines`."""
    limit = exact.check.limit * exact.check.reach if exact.check is not None else nan
    joints = joints_of(mechanism, free, moved, limit)
    return BothEngines(exact=exact, of_blocks=of_blocks, moved=moved, free=free, joints=joints)


def joints_of(mechanism: Mechanism, free: FreeBlocks, moved: BlockMotion, limit: float) -> list[BlockJoint]:
    """Return the joints that a mechanism keeps closed, in a motion of its free blocks.

    Parameters
    ----------
    mechanism : Mechanism
        The structure.
    free : FreeBlocks
        Its blocks.
    moved : BlockMotion
        Their motion.
    limit : float
        Opening or slip of interest [m].
    """
    phi = free.rotation(moved.moved)
    joints: dict[str, tuple[Reals, Reals, float]] = {}
    for direction, contact in _closed(mechanism, free):
        opening, slip = _gaps(contact, free, moved.moved)
        rocks = np.sign(phi) == direction
        opening, slip = np.where(rocks, opening, 0.0), np.where(rocks, slip, 0.0)
        if (before := joints.get(contact.label)) is not None:
            opening, slip = np.maximum(opening, before[0]), np.maximum(slip, before[1])
        one, other = sorted(free.block_of[name] if name else "" for name in contact.pieces)
        joints[contact.label] = opening, slip, float(moved.friction.get((one, other), nan))
    seen = []
    for name, (opening, slip, friction) in joints.items():
        passed = _first(moved.time, np.maximum(opening, slip) > limit)
        seen.append(BlockJoint(name, float(opening.max()), float(slip.max()), passed, friction))
    return sorted(seen, key=lambda joint: -max(joint.opening, joint.slip))


def _closed(mechanism: Mechanism, free: FreeBlocks) -> Iterator[tuple[Direction, Contact]]:
    """Yield the joints of each direction that stay closed in it, between different blocks."""
    for direction in mechanism.directions:
        for contact in mechanism.contacts(direction) or ():
            known = all(name is None or name in free.block_of for name in contact.pieces)
            if len(contact.points) > 1 and contact.held is None and known:
                yield direction, contact


def _gaps(contact: Contact, free: FreeBlocks, moved: Reals) -> tuple[Reals, Reals]:
    """Return how far a joint opens, and how far it has slid, at each sample [m]."""
    normal = contact.normal * np.exp(1j * _motion(contact.face, free, moved)[2])
    gaps = []
    for point in contact.points:
        bears, borne = (_carried(name, point, free, moved) for name in contact.pieces)
        gaps.append((borne - bears) * normal.conjugate())
    opening, slip = np.max(np.real(gaps), axis=0), np.max(np.abs(np.imag(gaps)), axis=0)
    return opening, slip


def _carried(piece: str | None, point: complex, free: FreeBlocks, moved: Reals) -> Points:
    """Return the positions of a point that a piece carries; None is the ground, shape (n,)."""
    centroid, shift, turn = _motion(piece, free, moved)
    return np.asarray(centroid + shift + np.exp(1j * turn) * (point - centroid))


def _motion(piece: str | None, free: FreeBlocks, moved: Reals) -> tuple[complex, Points, Reals]:
    """Return the centroid at rest of the block of a piece, its displacement [m], and its rotation [rad]."""
    if piece is None:
        return 0j, np.zeros(len(moved), np.complex128), np.zeros(len(moved))
    k = [body.name for body in free.bodies].index(free.block_of[piece])
    return free.bodies[k].centroid, moved[:, k, 0] + 1j * moved[:, k, 1], moved[:, k, 2]


def _first(time: Reals, where: Bools) -> float:
    return float(time[where.argmax()]) if where.any() else nan

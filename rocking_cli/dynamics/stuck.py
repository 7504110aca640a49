"""Join pieces that cannot move relative to one another in a mode, so that fewer unknowns are left.

Each row is a relative velocity at a contact that stays closed, and therefore is zero. Two parts are joined if the rows
between them allow no relative motion at any rotation. This is repeated until no more parts can be joined. Joining
fewer parts than possible costs time, but is never wrong.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rocking_cli.core.rates import GROUND, Rates

Reals = NDArray[np.float64]
Points = NDArray[np.complex128]
Integers = NDArray[np.intp]
ACROSS = 1e-6  # square of the sine of the angle between directions that count as two
APART = 1e-10  # square of the distance of lines of action that do not pass one point, over that of their arms


@dataclass(frozen=True, eq=False)
class Stuck:
    """Pieces joined to rigid parts, at n rotations.

    Parameters
    ----------
    count : int
        Number of parts that are not stuck to the ground.
    part : ndarray of int, shape (pieces,)
        The part of each piece, -1 for pieces fixed to the ground.
    arm : ndarray of complex, shape (n, pieces)
        From the reference point of its part to the centroid of each piece [m].
    """

    count: int
    part: Integers
    arm: Points

    def spread(self, parts: Reals) -> Reals:
        """Return the velocities of the pieces, shape (n, 3 pieces), from those of the parts, shape (n, 3 parts)."""
        n = len(parts)
        moved = np.concatenate([parts.reshape(n, self.count, 3), np.zeros((n, 1, 3))], axis=1)[:, self.part]
        x, y, turn = np.moveaxis(moved, 2, 0)
        return np.stack([x - turn * self.arm.imag, y + turn * self.arm.real, turn], axis=2).reshape(n, -1)

    def gathered(self, pieces: Reals) -> Reals:
        """Return the momenta of the parts, shape (n, 3 parts), from those of the pieces, shape (n, 3 pieces)."""
        n = len(pieces)
        found = np.zeros((n, self.count + 1, 3))
        each = _about(pieces.reshape(n, -1, 3), self.arm)
        for k, part in enumerate(self.part):
            found[:, part] += each[:, k]
        return found[:, :-1].reshape(n, -1)

    def contracted(self, rates: Rates) -> Rates:
        """Return the rates as functions of the velocities of the parts.

        Rows between two pieces of the same part are left out, because they are always zero.
        """
        part = np.append(self.part, GROUND)[rates.pieces]
        apart = np.flatnonzero(part[:, 0] != part[:, 1])
        arm = np.where(part == GROUND, 0j, np.append(self.arm, np.zeros_like(self.arm[:, :1]), axis=1)[:, rates.pieces])
        factors = np.where(part[..., None] == GROUND, 0.0, _about(rates.factors, arm))
        return Rates(self.count, part[apart], factors[:, apart])


def _about(force: Reals, arm: Points) -> Reals:
    """Return forces and moments, shape (..., 3), about points at the distance `arm` from their points of action."""
    x, y, moment = np.moveaxis(force, -1, 0)
    return np.stack([x, y, moment + arm.real * y - arm.imag * x], axis=-1)


def stuck(held: Rates, centres: Points) -> Stuck:
    """Join the pieces among which the given rows, whose velocities are zero, allow no relative motion.

    Parameters
    ----------
    held : Rates
        Rows whose velocities are zero.
    centres : ndarray of complex, shape (n, pieces)
        Centroids of the pieces [m].
    """
    from scipy.sparse import coo_array  # slow to import, and only redundant joints need it
    from scipy.sparse.csgraph import connected_components

    count = held.count
    ends = np.where(held.pieces == GROUND, count, held.pieces)  # the ground comes after all
    first = np.where(ends[:, 0] == count, 1, 0)  # of a row: a side that is a piece
    row = np.arange(len(ends))
    wrench, place = held.factors[:, row, first], centres[:, np.minimum(ends[row, first], count - 1)]
    label = np.arange(count + 1)
    while True:
        low, high = np.sort(label[ends], axis=1).T
        apart = np.flatnonzero(low != high)
        pairs, first, number = np.unique(
            np.array([low[apart], high[apart]]), axis=1, return_index=True, return_inverse=True
        )
        # Their wrenches about one point for each pair, near its joints.
        number = number.ravel()
        about = _about(wrench[:, apart], place[:, apart] - place[:, apart[first[number]]])
        joined = pairs[:, _leave_nothing(number, about)]
        if not joined.size:
            break
        graph = coo_array((np.ones(joined.shape[1]), (joined[0], joined[1])), shape=(count + 1, count + 1))
        label = connected_components(graph, directed=False)[1][label]
    free = label[:-1] != label[-1]
    _, leader, part_of_free = np.unique(label[:-1][free], return_index=True, return_inverse=True)
    part = np.full(count, GROUND, np.intp)
    part[free] = part_of_free
    reference = np.append(centres[:, free][:, leader], np.zeros_like(centres[:, :1]), axis=1)
    return Stuck(len(leader), part, centres - reference[:, part])


def _leave_nothing(number: Integers, wrench: Reals) -> NDArray[np.bool_]:
    """Return which pairs of parts have no relative motion: their wrenches span two translations and a rotation."""
    order = np.argsort(number, kind="stable")
    starts = np.flatnonzero(np.diff(number[order], prepend=-1))
    each = np.moveaxis(wrench[:, order], 1, 0)
    gram = np.add.reduceat(each[..., :, None] * each[..., None, :], starts, axis=0)
    xx, yy, xy = gram[..., 0, 0], gram[..., 1, 1], gram[..., 0, 1]
    across = xx * yy - xy**2
    two = across > ACROSS * (xx + yy) ** 2
    mx, my, mm = gram[..., 0, 2], gram[..., 1, 2], gram[..., 2, 2]
    left = mm - (mx**2 * yy + my**2 * xx - 2 * mx * my * xy) / np.where(two, across, 1.0)
    return np.asarray((two & (left > APART * mm)).all(axis=1))

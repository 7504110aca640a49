"""Velocities at the contacts of a mechanism as linear functions of those of its pieces, two for each contact."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rocking_cli.core.kinematics import Reals

Integers = NDArray[np.intp]
GROUND = -1


class VelocityTerm(NamedTuple):
    """Contribution of one piece to a velocity: its number, and the factors of its x, y and rotation, shape (n, 3)."""

    piece: int
    factors: Reals


@dataclass(frozen=True, eq=False)
class Rates:
    """Rows of velocities, each a linear function of the velocities of at most two pieces, at several rotations.

    Parameters
    ----------
    count : int
        Number of pieces.
    pieces : ndarray of int, shape (rows, 2)
        Numbers of the two pieces of each row, -1 for the ground.
    factors : ndarray, shape (n, rows, 2, 3)
        Factors of the velocities in x, y and rotation of both pieces; zero for the ground.
    """

    count: int
    pieces: Integers
    factors: Reals

    @classmethod
    def of(cls, rows: Sequence[Sequence[VelocityTerm]], count: int, rotations: int) -> Rates:
        """Make rates from rows of contributions of at most two pieces each."""
        pieces = np.full((len(rows), 2), GROUND, np.intp)
        factors = np.zeros((rotations, len(rows), 2, 3))
        for k, shares in enumerate(rows):
            for side, share in enumerate(shares):
                pieces[k, side] = share.piece
                factors[:, k, side] += share.factors  # 0 + -0 is 0
        return cls(count, pieces, factors)

    def dense(self) -> Reals:
        """Return the factors of all rows as one matrix per rotation, shape (n, rows, 3 count)."""
        n, rows = self.factors.shape[:2]
        found = np.zeros((n, rows, self.count + 1, 3))
        for side in (0, 1):
            found[:, np.arange(rows), self.pieces[:, side]] += self.factors[:, :, side]
        return found[:, :, :-1].reshape(n, rows, 3 * self.count)  # the last is the ground

    def at(self, velocity: Reals) -> Reals:
        """Return the velocities of all rows, shape (n, rows), from those of the pieces, shape (n, 3 count)."""
        moved = velocity.reshape(len(velocity), self.count, 3)
        moved = np.concatenate([moved, np.zeros_like(moved[:, :1])], axis=1)  # the ground
        return np.asarray((self.factors * moved[:, self.pieces]).sum(axis=(2, 3)))

    def rotations(self, chosen: Integers | Sequence[int]) -> Rates:
        """Return the rates at a selection of the rotations."""
        return Rates(self.count, self.pieces, self.factors[chosen])

    def rows(self, chosen: Integers | NDArray[np.bool_]) -> Rates:
        """Return the rates of a selection of the rows."""
        return Rates(self.count, self.pieces[chosen], self.factors[:, chosen])

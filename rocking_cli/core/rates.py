"""Velocities at the contacts of a mechanism over those of its pieces: each is of two pieces at most."""

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
    """What one piece adds to a velocity: its number, and the factors of its x, y and rotation, shape (n, 3)."""

    piece: int
    factors: Reals


@dataclass(frozen=True, eq=False)
class Rates:
    """Rows of velocities at some rotations.

    Parameters
    ----------
    count : int
        Number of pieces.
    pieces : ndarray of int, shape (rows, 2)
        The pieces that each row is of, -1 where it is the ground.
    factors : ndarray, shape (n, rows, 2, 3)
        Factors of the x, y and rotation of both; zero of the ground.
    """

    count: int
    pieces: Integers
    factors: Reals

    @classmethod
    def of(cls, rows: Sequence[Sequence[VelocityTerm]], count: int, rotations: int) -> Rates:
        """Lay out rows of at most two pieces each."""
        pieces = np.full((len(rows), 2), GROUND, np.intp)
        factors = np.zeros((rotations, len(rows), 2, 3))
        for k, shares in enumerate(rows):
            for side, share in enumerate(shares):
                pieces[k, side] = share.piece
                factors[:, k, side] += share.factors  # 0 + -0 is 0
        return cls(count, pieces, factors)

    def dense(self) -> Reals:
        """All factors, shape (n, rows, 3 count)."""
        n, rows = self.factors.shape[:2]
        found = np.zeros((n, rows, self.count + 1, 3))
        for side in (0, 1):
            found[:, np.arange(rows), self.pieces[:, side]] += self.factors[:, :, side]
        return found[:, :, :-1].reshape(n, rows, 3 * self.count)  # the last is the ground

    def at(self, velocity: Reals) -> Reals:
        """The velocities of all rows, shape (n, rows), at those of the pieces, shape (n, 3 count)."""
        moved = velocity.reshape(len(velocity), self.count, 3)
        moved = np.concatenate([moved, np.zeros_like(moved[:, :1])], axis=1)  # the ground
        return np.asarray((self.factors * moved[:, self.pieces]).sum(axis=(2, 3)))

    def rotations(self, chosen: Integers | Sequence[int]) -> Rates:
        """The rows at some of the rotations."""
        return Rates(self.count, self.pieces, self.factors[chosen])

    def rows(self, chosen: Integers | NDArray[np.bool_]) -> Rates:
        """Some of the rows."""
        return Rates(self.count, self.pieces[chosen], self.factors[:, chosen])

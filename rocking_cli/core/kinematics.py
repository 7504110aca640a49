"""Rigid plane motions over the rocking rotation phi, with exact first and second derivatives.

Points of the plane are complex numbers x + iy, x to the right, y up [m]. Rotations psi of a body are
anticlockwise [rad], so a structure that rocks in the positive (clockwise) direction turns by -phi.
A prime is a derivative with respect to phi. Corners of a polygon are in order around it, the last joined to the first.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import IntEnum
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Points as Points
from rocking_cli.arrays import Reals as Reals
from rocking_cli.short_repr import short_repr


class Direction(IntEnum):
    """Direction of rocking; its value is the sign s of the signed rotation."""

    POSITIVE = 1  # clockwise
    NEGATIVE = -1  # anticlockwise

    @property
    def label(self) -> str:
        """Name of the direction, `"positive"` or `"negative"`."""
        return self.name.lower()

    @property
    def prime(self) -> str:
        """Mark after the letter of a hinge, empty in the positive direction and ' in the negative one (A and A')."""
        return "" if self > 0 else "'"

    @property
    def opposite(self) -> Direction:
        """The opposite direction."""
        return Direction(-self)


@short_repr
@dataclass(frozen=True)
class RigidMotion:
    """Motion of one rigid body, or of the link of which it is a part, over an array of rotations phi.

    Parameters
    ----------
    rest : complex
        Rest position of a reference point of the link [m].
    q, dq, ddq : ndarray of complex, shape (n,)
        Position of the reference point [m] and its first two derivatives in phi.
    psi, dpsi, ddpsi : ndarray, shape (n,)
        Rotation of the link [rad, anticlockwise] and its first two derivatives in phi.
    """

    rest: complex
    q: Points
    dq: Points
    ddq: Points
    psi: Reals
    dpsi: Reals
    ddpsi: Reals

    def carry(self, point: complex) -> tuple[Points, Points, Points]:
        """Return position, first and second derivative of the point that is at `point` at rest, each shape (n,)."""
        arm = self._turned * (point - self.rest)
        return (
            self.q + arm,
            self.dq + 1j * self.dpsi * arm,
            self.ddq + (1j * self.ddpsi - self.dpsi**2) * arm,
        )

    def shifted(self, by: complex) -> RigidMotion:
        """Return the same motion of an equal link that is `by` beside this one [m]."""
        return replace(self, rest=self.rest + by, q=self.q + by)

    @cached_property
    def _turned(self) -> Points:
        return np.asarray(np.exp(1j * self.psi))


def rotation(phi: Reals, pivot: complex, rate: float) -> RigidMotion:
    """Return the rotation by `rate` * phi about a fixed `pivot`; rate 0 is a body at rest."""
    zero, still = np.zeros_like(phi), np.zeros(phi.shape, np.complex128)
    return RigidMotion(pivot, still + pivot, still, still, rate * phi, zero + rate, zero)


def four_bar(
    phi: Reals, direction: Direction, a: complex, b: complex, c: complex, d: complex
) -> tuple[RigidMotion, RigidMotion, RigidMotion]:
    """Return the motions of the links AB, BC and CD of a four-bar linkage whose AB turns by -s phi about A.

    Parameters
    ----------
    phi : ndarray, shape (n,)
        Rotations of AB in this direction [rad], from 0 to less than `four_bar_limit`.
    direction : Direction
        Clockwise (positive) or anticlockwise (negative) rotation of AB.
    a, b, c, d : complex
        Rest positions of the hinges [m]; A and D are fixed.

    Returns
    -------
    tuple of RigidMotion
        Motions of AB, BC and CD, on the branch of the linkage that contains the position at rest.

    Notes
    -----
    Positions from the closed form, derivatives from the loop closure AB + BC = AD + DC differentiated once
    and twice, so that all are exact [paper, Eqs. 27-29].
    """
    s = int(direction)
    w1 = -s  # psi_AB', the rotation of AB by phi; psi_AB'' = 0
    ab = np.exp(1j * w1 * phi) * (b - a)
    bd = d - (a + ab)
    span, length_bc, length_cd = np.abs(bd), abs(c - b), abs(d - c)
    cosine = (span**2 + length_bc**2 - length_cd**2) / (2 * span * length_bc)
    side = np.sign(_cross(np.complex128(d - b), np.complex128(c - b)))
    bc = bd / span * length_bc * np.exp(1j * side * np.arccos(np.clip(cosine, -1.0, 1.0)))  # Eq. 27
    dc = bc - bd

    w2 = -w1 * _cross(ab, dc) / _cross(bc, dc)  # Eq. 28
    w3 = w1 * _cross(ab, bc) / _cross(dc, bc)  # Eq. 28
    pull = w1**2 * ab + w2**2 * bc - w3**2 * dc
    e2 = _cross(1j * dc, pull) / _cross(dc, bc)  # Eq. 29: i e2 bc - i e3 dc = pull
    e3 = _cross(1j * bc, pull) / _cross(dc, bc)  # Eq. 29
    link_ab = rotation(phi, a, w1)
    link_bc = RigidMotion(b, a + ab, 1j * w1 * ab, -(w1**2) * ab, _angle(bc / (c - b)), w2, e2)
    still = np.zeros(phi.shape, np.complex128)
    link_cd = RigidMotion(d, still + d, still, still, _angle(dc / (c - d)), w3, e3)
    return link_ab, link_bc, link_cd


def four_bar_limit(direction: Direction, a: complex, b: complex, c: complex, d: complex) -> float:
    """Return the rotation of AB at which B, C and D are in line and the linkage locks [rad]; 2 pi if it never does."""
    ab, ad = abs(b - a), abs(d - a)
    start = float(np.angle((b - a) / (d - a)))
    turns = [2 * np.pi]
    for span in (abs(c - b) + abs(d - c), abs(abs(c - b) - abs(d - c))):
        cosine = (ab**2 + ad**2 - span**2) / (2 * ab * ad)
        if abs(cosine) <= 1:
            turns += [float(direction * (start - end) % (2 * np.pi)) for end in (np.arccos(cosine), -np.arccos(cosine))]
    return min(turns)


def _angle(ratio: Points) -> Reals:
    """Return the continuous angle [rad] of a rotating complex number, without jumps of 2 pi."""
    angle: Reals = np.angle(ratio)
    jumps = np.abs(np.diff(angle)).max(initial=0.0) >= np.pi
    return np.unwrap(angle) if jumps else angle  # unwrapping takes as long as all other steps


def _cross(u: Points | np.complex128, v: Points | np.complex128) -> Reals:
    return np.asarray((np.conj(u) * v).imag)


def area_of(corners: Sequence[complex] | Points) -> float:
    """Return the area of a polygon [m2], negative if its corners are clockwise."""
    z = np.asarray(corners) - corners[0]
    return float((z.conj() * following(z)).imag.sum() / 2)


def following(z: Points) -> Points:
    """Return the corner that follows each corner of a polygon; `numpy.roll` takes ten times as long."""
    return np.concatenate((z[1:], z[:1]))


def distance(points: Points, z: Points) -> Reals:
    """Return the distances of points from the sides of a polygon [m]."""
    side = following(z) - z
    away = points[:, None] - z
    along = np.clip((away * side.conj()).real / squared(side), 0.0, 1.0)
    return np.asarray(np.abs(away - along * side).min(axis=1))


def inside(points: Points, z: Points) -> NDArray[np.bool_]:
    """Return whether points are inside a polygon; for points on a side, either result is possible."""
    w = following(z)
    y = points.imag[:, None]
    spans = (z.imag > y) != (w.imag > y)
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = z.real + (y - z.imag) / (w - z).imag * (w - z).real
    return np.asarray(np.count_nonzero(spans & (points.real[:, None] < crossing), axis=1) % 2 == 1)


def squared(side: Points) -> Reals:
    """Return the squared lengths of sides, with 1 for sides so short that the square vanishes."""
    squares = np.abs(side) ** 2
    return np.where(squares == 0, 1.0, squares)


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
                factors[:, k, side] += share.factors  # adding to 0 turns -0 into 0
        return cls(count, pieces, factors)

    def dense(self) -> Reals:
        """Return the factors of all rows as one matrix per rotation, shape (n, rows, 3 count)."""
        n, rows = self.factors.shape[:2]
        matrix = np.zeros((n, rows, self.count + 1, 3))
        for side in (0, 1):
            matrix[:, np.arange(rows), self.pieces[:, side]] += self.factors[:, :, side]
        return matrix[:, :, :-1].reshape(n, rows, 3 * self.count)  # without the ground, which is the last piece

    def at(self, velocity: Reals) -> Reals:
        """Return the velocities of all rows, shape (n, rows), from those of the pieces, shape (n, 3 count)."""
        moved = velocity.reshape(len(velocity), self.count, 3)
        moved = np.concatenate([moved, np.zeros_like(moved[:, :1])], axis=1)  # zeros for the ground, as last piece
        return np.asarray((self.factors * moved[:, self.pieces]).sum(axis=(2, 3)))

    def rotations(self, chosen: Integers | Sequence[int]) -> Rates:
        """Return the rates at a selection of the rotations."""
        return Rates(self.count, self.pieces, self.factors[chosen])

    def rows(self, chosen: Integers | NDArray[np.bool_]) -> Rates:
        """Return the rates of a selection of the rows."""
        return Rates(self.count, self.pieces[chosen], self.factors[:, chosen])

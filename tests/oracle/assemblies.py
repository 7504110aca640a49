"""Blocks that stand on each other: their joints, the weakest mechanism of each direction, and where it takes them.

A row is the velocity at which two blocks part at a point of their joint, by the velocities of all blocks; transposed it
is what a force there does to them. The same rows make the statics at rest and keep joints shut on the way.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations, product
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import chebyshev
from scipy.optimize import linprog

from tests.reference_mechanics import HIGHS, cross, polygon_moments

from .series import Complexes, Reals
from .structures import SIDES, WHOLE, Mode, Piece, Rigid, Slips, Structure, Terms

FLUSH = 1e-9  # [m]; edges so near each other touch
SHUT = 1e-6  # [m/rad]; joints that part so slowly stay shut
FROM, TO = -0.05, 0.4  # [rad]; beyond phi_cr, and derivatives at rest look to both sides of it
DEGREE = 32
EARTH = -1  # as the number of a block


def series(values: Callable[[Reals], Any]) -> Reals:
    """The coefficients of a function of the rotation, along the first axis."""
    shape: list[int] = []

    def flat(x: Reals) -> Reals:
        found = np.array(values(FROM + (TO - FROM) * (1 + x) / 2))
        shape[:] = found.shape[1:]
        return found.reshape(len(x), -1)

    coefficients = chebyshev.chebinterpolate(flat, DEGREE)
    return coefficients.reshape(-1, *shape)


def summed(coefficients: Reals, phi: Any) -> Any:
    """The values of a series, beside the real axis too."""
    x = (2 * np.asarray(phi) - TO - FROM) / (TO - FROM)
    waves = np.cos(np.multiply.outer(np.arccos(x), np.arange(DEGREE + 1)))
    return (waves @ coefficients.reshape(DEGREE + 1, -1)).reshape(*x.shape, *coefficients.shape[1:])


class Contact(NamedTuple):
    """A joint: the block that bears, the one that it bears, and of each end whose face goes on beyond it."""

    below: int
    above: int
    ends: tuple[complex, complex]
    normal: complex  # into the one above
    faces: tuple[int, int]  # where neither goes on, the one below


class Row(NamedTuple):
    """How fast a contact opens at one of its ends, or (end None) slips along its face, which turns with a block."""

    contact: int
    end: int | None
    at: complex
    way: complex
    face: int


@dataclass(frozen=True, eq=False)
class Assembly(Structure):
    """An assembly by the fields of its file; phi is the rotation of the block that turns fastest at uplift."""

    file: Mapping[str, Any]

    def pieces(self) -> Sequence[Piece]:
        surface = self.file["density"] * self.file["depth"]
        moments = [polygon_moments(outline) for outline in self.outlines]
        return [
            Piece(name, surface * area, surface * moment, centre)
            for name, (area, centre, moment) in zip(self.file["blocks"], moments, strict=False)
        ]

    def joints(self) -> Sequence[str]:
        return [f"{contact.below} and {contact.above}" for contact in self.contacts]

    def locks(self, s: int) -> float:
        return TO

    def place(self, s: int, phi: Any, slips: Slips = WHOLE) -> Sequence[Rigid]:
        assert not slips, "joints that part are not followed"
        moved = summed(self.paths[s][:, 0], phi)
        return [
            Rigid(centre, centre.real + moved[..., 3 * k], centre.imag + moved[..., 3 * k + 1], moved[..., 3 * k + 2])
            for k, centre in enumerate(self.centres[:-1])
        ]

    def terms(self, s: int, phi: float, mode: Mode | None = None) -> Terms:
        """As `Structure` has them, in a twentieth of the time: there are no springs."""
        of_all = summed(self.paths[s], phi)
        _, speed, bend = of_all
        blocks = self.mass[::3]
        heights = of_all[:, 1::3] @ blocks
        energy = self.mass @ speed**2, 2 * self.mass @ (speed * bend)
        return Terms(*energy, *(self.gravity * heights), heights[1], speed[::3] @ blocks)

    @cached_property
    def outlines(self) -> list[Complexes]:
        """Those of the blocks, and then of the ground, anticlockwise."""
        bodies = (self.file["blocks"] | self.file["ground"]).values()
        found = [np.array([complex(*corner) for corner in body["polygon"]]) for body in bodies]
        return [z if cross(z, np.roll(z, -1)).sum() > 0 else z[::-1] for z in found]

    @property
    def numbers(self) -> list[int]:
        """Of the bodies whose outlines these are."""
        return [*range(len(self.file["blocks"])), *[EARTH] * len(self.file["ground"])]

    @cached_property
    def mass(self) -> Reals:
        """Of x, y and rotation of each block in turn."""
        return np.array([m for piece in self.pieces() for m in (piece.mass, piece.mass, piece.inertia)])

    @cached_property
    def centres(self) -> Complexes:
        """Of the blocks, and the earth's."""
        return np.array([*(piece.centre for piece in self.pieces()), 0j])

    def all_along(self, x: float, y: float) -> Reals:
        """Every block shifted by (x, y)."""
        return np.tile([x, y, 0.0], len(self.mass) // 3)

    @cached_property
    def contacts(self) -> list[Contact]:
        """Where an edge of a block lies on one of another body."""
        found = []
        for (i, one), (j, other) in combinations(zip(self.numbers, self.outlines, strict=True), 2):
            for start, end in _edges(one) if i != EARTH else ():
                along, length = (end - start) / abs(end - start), abs(end - start)
                for last, first in _edges(other):
                    # Seen along the edge of i, that of j runs backwards.
                    a, b = (first - start) / along, (last - start) / along
                    low, high = max(0.0, a.real), min(length, b.real)
                    if high - low < FLUSH or max(abs(a.imag), abs(b.imag)) > FLUSH:
                        continue
                    lies = j == EARTH or along.real > FLUSH  # i on j
                    below, above, upwards = (j, i, 1j) if lies else (i, j, -1j)
                    sooner, later = (
                        below if abs(longer) < FLUSH else i if longer > 0 else j for longer in (a.real, length - b.real)
                    )
                    ends = start + low * along, start + high * along
                    found.append(Contact(below, above, ends, upwards * along, (sooner, later)))
        return found

    def rows(self, bearing: Iterable[Sequence[int]]) -> list[Row]:
        """Of each contact one at each of the ends at which it bears, and one along its face in the middle of them."""
        found = []
        for k, (contact, ends) in enumerate(zip(self.contacts, bearing, strict=True)):
            if ends:
                face = contact.faces[ends[0]] if len(ends) == 1 else contact.below
                points = [contact.ends[end] for end in ends]
                found += [Row(k, end, at, contact.normal, face) for end, at in zip(ends, points, strict=True)]
                found.append(Row(k, None, sum(points) / len(points), -1j * contact.normal, face))
        return found

    def parted(self, rows: Sequence[Row], moved: Reals) -> tuple[Reals, Reals]:
        """How far each row has parted where blocks have `moved`, and the row."""
        moved = np.append(moved, np.zeros(3)).reshape(-1, 3)
        centres, turn = self.centres + moved[:, 0] + 1j * moved[:, 1], np.exp(1j * moved[:, 2])
        gaps, slopes = np.zeros(len(rows)), np.zeros((len(rows), *moved.shape))
        for r, row in enumerate(rows):
            way, contact = row.way * turn[row.face], self.contacts[row.contact]
            for block, sign in ((contact.above, 1), (contact.below, -1)):
                arm = (row.at - self.centres[block]) * turn[block]
                gaps[r] += sign * ((centres[block] + arm) / way).real
                slopes[r, block] = sign * way.real, sign * way.imag, sign * cross(arm, way)
        return gaps, slopes[:, :EARTH].reshape(len(rows), -1)

    @cached_property
    def weakest(self) -> Mapping[int, tuple[list[Row], Reals]]:
        """Of each direction the rows that stay shut at uplift, and the velocities of the blocks."""
        return {s: self._weakest(s) for s in SIDES}

    def _weakest(self, s: int) -> tuple[list[Row], Reals]:
        """Find the greatest push that forces in the joints can bear; its dual solution is how the blocks set out."""
        both_ends = [(0, 1)] * len(self.contacts)
        rows, friction = self.rows(both_ends), self.file.get("friction")
        _, slopes = self.parted(rows, 0 * self.mass)
        push, weight = (self.gravity * self.mass * self.all_along(*way) for way in ((s, 0.0), (0.0, 1.0)))
        cone = [
            [(row.contact == k) * (sense if row.end is None else -friction) for row in rows] + [0.0]
            for k, sense in product(range(len(both_ends)), (1, -1) if friction is not None else ())
        ]
        answer = linprog(
            [0.0] * len(rows) + [-1.0],
            cone or None,
            [0.0] * len(cone) or None,
            np.column_stack([slopes.T, push]),
            weight,
            [(None if row.end is None else 0.0, None) for row in rows] + [(None, None)],
            options=HIGHS,
        )
        assert answer.status == 0, answer.message
        velocity = -answer.eqlin.marginals
        velocity /= abs(velocity[2::3]).max()
        parts = {(row.contact, row.end) for row, rate in zip(rows, slopes @ velocity, strict=True) if abs(rate) > SHUT}
        assert not any((k, None) in parts for k in range(len(both_ends))), "a joint slides or comes off"
        return self.rows([[end for end in ends if (k, end) not in parts] for k, ends in enumerate(both_ends)]), velocity

    @cached_property
    def paths(self) -> Mapping[int, Reals]:
        """Of each direction how far each block has moved, with first and second derivatives, as series."""
        return {s: self._path(*self.weakest[s]) for s in SIDES}

    def _path(self, rows: Sequence[Row], velocity: Reals) -> Reals:
        leads = np.zeros(len(velocity))
        leads[2 + 3 * abs(velocity[2::3]).argmax()] = 1.0

        def followed(rotations: Reals) -> Reals:
            """By Newton's method, each from the one before."""
            found, moved, before = [], 0 * velocity, 0.0
            for phi in rotations:
                moved, before = moved + (phi - before) * velocity, phi
                for _ in range(8):
                    gaps, slopes = self.parted(rows, moved)
                    missed = np.append(-gaps, phi * (leads @ velocity) - leads @ moved)
                    moved = moved + np.linalg.solve(np.vstack([slopes, leads]), missed)
                found.append(moved)
            return np.array(found)

        orders = [series(followed)]
        for _ in range(2):
            slope = chebyshev.chebder(orders[-1], scl=2 / (TO - FROM))
            orders.append(np.vstack([slope, np.zeros(len(velocity))]))
        return np.stack(orders, axis=1)


def _edges(outline: Complexes) -> list[tuple[complex, complex]]:
    return list(zip(outline, np.roll(outline, -1), strict=True))

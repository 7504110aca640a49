"""Blocks that kept joints make rigid: they move as one, so that only a few parts are left.

Two parts are joined if the kept rates between them allow no relative motion. This is repeated until no more parts can
be joined; parts joined to the ground are at rest. A part that three others hold as a triangle is not detected: joining
fewer parts than possible costs time, but is never wrong.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mechanisms._assembly.rays import Bools, Frame, Indices
from mechanisms._assembly.sparse import Sparse, components, from_entries
from rocking_cli.core import Reals
from rocking_cli.core.kinematics import Points

ACROSS = 1e-3  # least sine of the angle between two different directions
APART = 1e-9  # least distance of two different lines of action, over the size of the assembly


@dataclass(frozen=True, eq=False)
class RigidParts:
    """Blocks joined to rigid parts.

    Parameters
    ----------
    of : ndarray of int, shape (blocks,)
        Part of each block; -1 for blocks at rest.
    count : int
        Number of parts that are not at rest.
    basis : sparse array, shape (3 blocks, 3 count)
        Velocities of the blocks by those of the parts.
    between : ndarray of bool
        Rows that are rates between two parts; all other rates are zero.
    """

    of: Indices
    count: int
    basis: Sparse
    between: Bools


def rigid_parts(rates: Sparse, frame: Frame) -> RigidParts:
    """Join the blocks that move as one if all of the given rates are zero.

    Parameters
    ----------
    rates : sparse array, shape (rows, 3 blocks)
        Rates between two blocks each, or a block and the ground.
    frame : Frame
        The blocks.
    """
    ground = len(frame.names)
    one, other, wrench = _wrenches(rates, ground)
    place = np.array([*frame.centroids, 0j], np.complex128) / frame.size
    part = np.arange(ground + 1)
    while True:
        low, high = np.sort([part[one], part[other]], axis=0)
        open_ = low != high
        if not open_.any():
            break
        pairs, number = np.unique(np.array([low[open_], high[open_]]), axis=1, return_inverse=True)
        held = _holds(number.ravel(), pairs.shape[1], wrench[open_], place[one[open_]])
        if not held.any():
            break
        part = components(pairs[0, held], pairs[1, held], ground + 1)[part]
    return _parts(part, place, part[one] != part[other])


def _wrenches(rates: Sparse, ground: int) -> tuple[Indices, Indices, Reals]:
    """Return the two bodies of each row, and the direction and moment of its unit force about the first's centroid."""
    entries = rates.tocoo()
    block, component = np.divmod(entries.col, 3)
    one = np.full(rates.shape[0], -1)
    np.maximum.at(one, entries.row, block)
    lowest = np.full(rates.shape[0], ground)
    np.minimum.at(lowest, entries.row, block)
    other = np.where(lowest == one, ground, lowest)
    wrench = np.zeros((rates.shape[0], 3))
    of_one = block == one[entries.row]
    wrench[entries.row[of_one], component[of_one]] = entries.data[of_one]
    return np.where(one < 0, ground, one), other, wrench  # a row without entries is of the ground alone


def _holds(number: Indices, count: int, wrench: Reals, place: Points) -> Bools:
    """Return for each pair of parts whether the rows between them prevent every relative motion, including rotation."""
    first = np.zeros(count, np.intp)
    first[number[::-1]] = np.arange(len(number))[::-1]
    arm = place - place[first[number]]  # moments about one point for each pair, near its joints

    def dot(one: Reals, two: Reals) -> Reals:
        return np.asarray(np.bincount(number, one * two, count), np.float64)

    def without(one: Reals, two: Reals) -> Reals:
        """Return the component of a column orthogonal to another, pair by pair."""
        square = dot(two, two)
        return one - (dot(one, two) / np.where(square > 0, square, 1.0))[number] * two

    x, y, moment = wrench.T
    moment = moment + arm.real * y - arm.imag * x
    swap = (dot(x, x) < dot(y, y))[number]
    main, minor = np.where(swap, y, x), np.where(swap, x, y)
    minor = without(minor, main)
    for _ in range(2):  # once more, for what rounding left
        moment = without(without(moment, main), minor)
    length = np.sqrt(dot(main, main))
    return (np.sqrt(dot(minor, minor)) > ACROSS * length) & (np.sqrt(dot(moment, moment)) > APART * length)


def _parts(label: Indices, place: Points, between: Bools) -> RigidParts:
    """Return the parts, numbered in the order of their first blocks, with their velocities."""
    label, ground = label[:-1], label[-1]
    moves = np.flatnonzero(label != ground)
    _, first, number = np.unique(label[moves], return_index=True, return_inverse=True)
    rank = np.argsort(np.argsort(first))
    of = np.full(len(label), -1)
    of[moves] = rank[number]
    about = place[moves[np.sort(first)]]
    arm = place[moves] - about[of[moves]]
    rows, columns = 3 * moves, 3 * of[moves]
    ones = np.ones(len(moves))
    basis = from_entries(
        np.concatenate([rows, rows, rows + 1, rows + 1, rows + 2]),
        np.concatenate([columns, columns + 2, columns + 1, columns + 2, columns + 2]),
        np.concatenate([ones, -arm.imag, ones, arm.real, ones]),
        (3 * len(label), 3 * len(about)),
    )
    return RigidParts(of, len(about), basis, between)

"""The smallest of several mechanisms with the same multiplier that differ only in idle blocks.

A linear programme may find many mechanisms with the same multiplier that are one and the same collapse: a few blocks
move, and others may or may not move with them. The blocks that need not move are idle. Mechanisms count as the same
motion under three conditions: a set of blocks moves in proportion in all of them; these blocks can also move alone; and
every other block is idle. A block is idle if the forces do no work on it, or if it can only turn with one of the moving
blocks, about the same point. The smallest mechanism moves only the blocks that are not idle, and its hinges are also
hinges of the larger ones.

Two equal towers side by side are a counter-example: either can overturn alone, at the same multiplier. So is a stack
that can turn about its own foot or about that of its plinth, at the same multiplier.
"""

from __future__ import annotations

import numpy as np

from mechanisms._assembly.problem import NOTHING, AssemblyProblem
from mechanisms._assembly.programme import least
from mechanisms._assembly.rays import Bools, Indices, Rays
from mechanisms._assembly.sparse import from_blocks
from rocking_cli.core import Reals

SAME = 1e-6  # relative difference of equal velocities
MOST = 30  # dimensions of the space of velocities up to which one motion is searched


def smallest(problem: AssemblyProblem, rays: Rays, kept: Bools, space: Reals) -> tuple[Reals, tuple[str, ...]] | None:
    """Return the mechanism that moves the fewest blocks, and the idle blocks.

    Parameters
    ----------
    problem : AssemblyProblem
        The assembly.
    rays : Rays
        Forces that its joints can exert.
    kept : ndarray of bool
        The rays that no mechanism opens.
    space : ndarray, shape (3 blocks, dimensions)
        Columns that span the velocities of all mechanisms of the multiplier: those that open none of the kept rays.

    Returns
    -------
    (ndarray, tuple of str) or None
        The velocities of all blocks, zero for idle blocks, and the names of the idle blocks. None if the mechanisms are
        not the same motion, or `space` has fewer than 2 or more than 30 dimensions.
    """
    if not 2 <= space.shape[1] <= MOST:
        return None
    space = np.linalg.qr(space)[0]
    by_block = space.reshape(-1, 3, space.shape[1])
    ways, sizes, shares = np.linalg.svd(by_block, full_matrices=False)
    able = sizes[:, 0] > NOTHING
    works = able & _does_work(problem, by_block)
    if not works.any() or (sizes[works, 1] > SAME * sizes[works, 0]).any():
        return None  # a block that can move in two ways
    share = shares[:, 0]  # how much of its one way a block moves, by coordinates of the space
    opening = rays.rates[~kept] @ space
    for k in _candidates(share, np.flatnonzero(works)):
        alike = works & (np.abs(share @ share[k]) > 1 - SAME**2)
        others = _candidates(share, np.flatnonzero(works & ~alike))
        if any(_reaches(opening, share[k], sign * share[j]) for j in others for sign in (1, -1)):
            continue  # others move without these
        field = _least_motion(opening, space, by_block, able, share[k])
        if field is None:
            continue
        moves = np.abs(field.reshape(-1, 3)).max(axis=1) > SAME * np.abs(field).max()
        if (moves & works & ~alike).any() or not all(
            _turns_with(problem, field, moves & works, j, ways[j, :, 0])
            for j in np.flatnonzero(works & ~alike).tolist()
        ):
            return None
        names = problem.frame.names
        return np.where(np.repeat(moves, 3), field, 0.0), tuple(names[j] for j in np.flatnonzero(able & ~moves))
    return None


def _does_work(problem: AssemblyProblem, by_block: Reals) -> Bools:
    """Return on which blocks the forces do work, in any of the velocities."""
    work = [np.abs(np.einsum("bi,bid->bd", each.reshape(-1, 3), by_block)).max(axis=1)
            for each in (problem.dead, problem.live)]  # fmt: skip
    return np.asarray(np.maximum(*work) > NOTHING * np.abs(by_block).max(axis=(1, 2)))


def _candidates(share: Reals, blocks: Indices) -> list[int]:
    """Return one block of each set of blocks that move in proportion, the largest set first."""
    found: dict[int, int] = {}
    for j in blocks.tolist():
        same = next((k for k in found if abs(share[k] @ share[j]) > 1 - SAME**2), j)
        found[same] = found.get(same, 0) + 1
    return sorted(found, key=lambda k: (-found[k], k))


def _reaches(opening: Reals, still: Reals, moves: Reals) -> bool:
    """Return whether some velocity closes no ray, keeps one set of blocks at rest and moves another."""
    n, d = opening.shape
    equal = from_blocks([[opening, -np.eye(n)], [still[None, :], None]])
    found = least(
        np.append(-moves, np.zeros(n)), equal, np.zeros(n + 1),
        np.append(np.full(d, -1.0), np.zeros(n)), np.append(np.ones(d), np.full(n, np.inf)),
    )  # fmt: skip
    return found is not None and -found.value > SAME


def _least_motion(opening: Reals, space: Reals, by_block: Reals, able: Bools, share: Reals) -> Reals | None:
    """Return velocities in which one set of blocks moves and the sum of all absolute velocities is least.

    None if this set cannot move.
    """
    rows = space[np.repeat(able, 3)]
    (n, d), m = opening.shape, len(rows)
    for sign in (1.0, -1.0):
        equal = from_blocks(
            [[opening, -np.eye(n), None, None], [rows, None, -np.eye(m), np.eye(m)], [share[None, :], None, None, None]]
        )
        found = least(
            np.concatenate([np.zeros(d + n), np.ones(2 * m)]), equal, np.append(np.zeros(n + m), sign),
            np.concatenate([np.full(d, -np.inf), np.zeros(n + 2 * m)]), np.full(d + n + 2 * m, np.inf),
        )  # fmt: skip
        if found is not None:
            return np.asarray(space @ found.x[:d])
    return None


def _turns_with(problem: AssemblyProblem, field: Reals, moves: Bools, block: int, way: Reals) -> bool:
    """Return whether the only motion of a block is to move as a part of some moving block."""
    place = np.array(problem.frame.centroids) / problem.frame.size
    for k in np.flatnonzero(moves):
        vx, vy, turn = field[3 * k : 3 * k + 3]
        if abs(turn) <= SAME * np.abs(field).max():
            continue  # what slides has no point about which to turn: it is another joint that slides
        arm = place[block] - place[k]
        along = np.array([vx - turn * arm.imag, vy + turn * arm.real, turn])
        if np.linalg.norm(along - way * (along @ way)) <= SAME * np.linalg.norm(along):
            return True
    return False

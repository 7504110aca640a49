"""Check whether a weakest mechanism is unique, and find the others with the same multiplier.

A vertex of the linear programme always has one degree of freedom. Rays that can carry force in *any* state of the
greatest multiplier keep their contact in every mechanism of that multiplier, and each other ray opens in some mechanism
(strict complementarity). The velocities that keep these contacts are a vector space; if its dimension is one, the
mechanism is unique.

Kept joints make blocks rigid: they move as one, so that only a few parts are left.

Two parts are joined if the kept rates between them allow no relative motion. This is repeated until no more parts can
be joined; parts joined to the ground are at rest. A part that three others hold as a triangle is not detected: joining
fewer parts than possible costs time, but is never wrong.

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

from dataclasses import dataclass

import numpy as np

from mechanisms._assembly.blocks import NoAnswer
from mechanisms._assembly.problem import ZERO_LOAD, AssemblyProblem, Bools, Frame, Indices, Rays
from mechanisms._assembly.programme import Sparse, beside, components, from_blocks, from_entries, least
from rocking_cli.core import Reals
from rocking_cli.core.kinematics import Points

OPENING_RATE = 1e-7  # opening velocity from which a ray opens, over the fastest opening velocity
CARRIED_FORCE = 1e-9  # force from which a ray counts as loaded, over the weight
MAX_COUNTED_FORCE = 1e-3  # largest force of a ray that counts in the cost, over the weight
MAX_STATE_FACTOR = 1e3  # largest factor on a state, so that small forces are found
RANK_TOLERANCE = 1e-10  # singular values below this share of the largest one count as zero
VELOCITY_ROUNDING = 1e-12  # velocities below this share of the fastest one are set to zero
MAX_MECHANISMS = 8


def kept_rays(rays: Rays, dead: Reals, live: Reals, raw: Reals) -> Bools:
    """Return the rays whose contact stays closed in every mechanism of the greatest multiplier.

    A ray is an extreme direction of the force at one point of a joint, see `Rays`. The contact of a ray stays closed in
    every such mechanism if the ray carries force in any state of the greatest multiplier. Two-sided rays always stay
    closed.

    Parameters
    ----------
    rays : Rays
        Forces that the joints can exert.
    dead, live : ndarray
        Permanent loads, and loads that the multiplier scales.
    raw : ndarray
        Velocities of one mechanism of the greatest multiplier. A state has the greatest multiplier if its forces do no
        work on this mechanism, so that the multiplier itself need not be exact.

    Returns
    -------
    ndarray of bool
        Whether each ray stays closed.

    Notes
    -----
    States may be scaled up freely, so that one linear programme finds all rays with force at once (Freund, Roundy and
    Todd, 1985). Another one is solved only if the scale reaches its bound, as rays with very small forces may be left.
    """
    rate = rays.rates @ raw
    shut = np.abs(rate) <= OPENING_RATE * np.abs(rate).max()
    kept = ~rays.one_sided
    undecided = rays.one_sided & shut
    by_ray = rays.rates.T.tocsc()
    while undecided.any():
        # Unknowns: the counted force and the surplus of each undecided ray, the forces of rays known to be kept, the
        # multiplier, and the size of the state.
        k, known = np.flatnonzero(undecided), np.flatnonzero(kept)
        count, rest = len(k), len(known)
        optimum = least(
            np.concatenate([np.full(count, -1.0), np.zeros(count + rest + 2)]),
            beside([by_ray[:, k], by_ray[:, k], by_ray[:, known], live, dead]),
            np.zeros(len(dead)),
            np.concatenate([np.zeros(2 * count), rays.low[known], [-np.inf, 1.0]]),
            np.concatenate([np.full(count, MAX_COUNTED_FORCE), np.full(count + rest + 1, np.inf), [MAX_STATE_FACTOR]]),
        )
        if optimum is None:
            raise NoAnswer("no forces belong to the mechanism that was found: the joints are too short, or too many")
        size = optimum.x[-1]
        more = optimum.x[:count] + optimum.x[count : 2 * count] > CARRIED_FORCE * size
        kept[k[more]] = True
        undecided[k[more]] = False
        if not more.any() or size < MAX_STATE_FACTOR / 2:
            break
    return kept


def velocity_space(rates: Sparse, frame: Frame) -> Reals:
    """Return columns that span the velocities of the blocks at which the given rates are zero.

    Their shape is (3 blocks, dimensions).
    """
    parts = rigid_parts(rates, frame)
    part_rates = (rates[parts.between] @ parts.basis).tocsr()
    # Parts between which no row gives a relative velocity are independent of each other.
    entries = part_rates.tocoo()
    part = entries.col // 3
    of_row = np.zeros(part_rates.shape[0], np.intp)
    of_row[entries.row] = part
    label = components(of_row[entries.row], part, parts.count)
    rows, columns = _members(label[of_row]), _members(np.repeat(label, 3))
    spans = []
    for k, these in columns.items():
        chosen = rows.get(k, np.zeros(0, np.intp))
        spans.append(parts.basis[:, these] @ null_space(part_rates[chosen][:, these].toarray()))
    return np.column_stack([np.zeros((rates.shape[1], 0)), *spans])


def _members(label: Indices) -> dict[int, Indices]:
    """Return the indices of the nodes with each label, in order."""
    order = np.argsort(label, kind="stable")
    names, starts = np.unique(label[order], return_index=True)
    return dict(zip(names.tolist(), np.split(order, starts[1:]), strict=True)) if len(names) else {}


def null_space(rows: Reals) -> Reals:
    """Return orthonormal columns that span the null space of a matrix."""
    if len(rows) == 0:
        return np.eye(rows.shape[1])
    if len(rows) > rows.shape[1]:
        rows = np.asarray(np.linalg.qr(rows, mode="r"))  # a matrix of fewer rows has the same null space
    _, values, basis = np.linalg.svd(rows)
    rank = int(np.count_nonzero(values > RANK_TOLERANCE * values[0]))
    return np.asarray(basis[rank:].T)


def mechanisms_of(rays: Rays, kept: Bools, space: Reals, raw: Reals) -> list[Reals]:
    """Return the mechanism of a space of one dimension, or extreme mechanisms of a larger one.

    In each of these mechanisms, every ray that is not kept either opens or stays shut, and none closes.
    """
    if space.shape[1] == 0:
        return [_clean(raw)]
    if space.shape[1] == 1:
        return [_clean(space[:, 0] * np.sign(space[:, 0] @ raw))]
    return _extremes(rays.rates[~kept] @ space, space) or [_clean(raw), _clean(raw)]


def _extremes(opening: Reals, space: Reals) -> list[Reals]:
    """Return extreme rays of the cone of z with opening z >= 0, and last the motions that open nothing.

    The component of one velocity of one block at a time decides which ray is found.
    """
    neutral = null_space(opening)
    both_ways = [_clean(space @ z) for z in neutral.T]
    if neutral.shape[1]:
        across = null_space(neutral.T)
        opening, space = opening @ across, space @ across
    n, d = opening.shape
    equal = np.column_stack([opening, -np.eye(n)])
    total = np.append(np.zeros(d), np.ones(n))
    low, high = np.append(np.full(d, -1e6), np.zeros(n)), np.append(np.full(d, 1e6), np.full(n, np.inf))
    fields: list[Reals] = []
    wanted = np.vstack([space, -space])
    tried = np.zeros((0, d))
    for row in wanted[np.abs(wanted).max(axis=1) > VELOCITY_ROUNDING]:
        unit = row / np.linalg.norm(row)
        if (tried @ unit > 1 - VELOCITY_ROUNDING).any():
            continue  # blocks that move in proportion give the same mechanism
        tried = np.vstack([tried, unit])
        best = least(np.append(row, np.zeros(n)), np.vstack([equal, total]), np.append(np.zeros(n), 1.0), low, high)
        if best is None:
            continue
        field = _clean(space @ best.x[:d])
        field /= np.linalg.norm(field)
        if all(np.abs(field - other).max() > 1e-6 for other in fields):
            fields.append(field)
        if len(fields) == MAX_MECHANISMS:
            break
    return fields + both_ways


def _clean(field: Reals) -> Reals:
    return np.where(np.abs(field) > VELOCITY_ROUNDING * np.abs(field).max(), field, 0.0)


MIN_SINE = 1e-3  # least sine of the angle between two different directions
MIN_LINE_DISTANCE = 1e-9  # least distance of two different lines of action, over the size of the assembly


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
    for _ in range(2):  # the second pass removes the rounding error
        moment = without(without(moment, main), minor)
    length = np.sqrt(dot(main, main))
    return (np.sqrt(dot(minor, minor)) > MIN_SINE * length) & (
        np.sqrt(dot(moment, moment)) > MIN_LINE_DISTANCE * length
    )


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


EQUAL_VELOCITY = 1e-6  # relative difference of equal velocities
MAX_DIMENSIONS = 30  # dimensions of the space of velocities up to which one motion is searched


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
    if not 2 <= space.shape[1] <= MAX_DIMENSIONS:
        return None
    space = np.linalg.qr(space)[0]
    by_block = space.reshape(-1, 3, space.shape[1])
    motions, sizes, shares = np.linalg.svd(by_block, full_matrices=False)
    able = sizes[:, 0] > ZERO_LOAD
    works = able & _does_work(problem, by_block)
    if not works.any() or (sizes[works, 1] > EQUAL_VELOCITY * sizes[works, 0]).any():
        return None  # a block has two independent motions
    share = shares[:, 0]  # amount of the single motion of a block, by coordinates of the space
    opening = rays.rates[~kept] @ space
    for k in _candidates(share, np.flatnonzero(works)):
        alike = works & (np.abs(share @ share[k]) > 1 - EQUAL_VELOCITY**2)
        others = _candidates(share, np.flatnonzero(works & ~alike))
        if any(_reaches(opening, share[k], sign * share[j]) for j in others for sign in (1, -1)):
            continue  # other blocks can move while these stay at rest
        field = _least_motion(opening, space, by_block, able, share[k])
        if field is None:
            continue
        moves = np.abs(field.reshape(-1, 3)).max(axis=1) > EQUAL_VELOCITY * np.abs(field).max()
        if (moves & works & ~alike).any() or not all(
            _turns_with(problem, field, moves & works, j, motions[j, :, 0])
            for j in np.flatnonzero(works & ~alike).tolist()
        ):
            return None
        names = problem.frame.names
        return np.where(np.repeat(moves, 3), field, 0.0), tuple(names[j] for j in np.flatnonzero(able & ~moves))
    return None


def _does_work(problem: AssemblyProblem, by_block: Reals) -> Bools:
    """Return a mask of the blocks on which loads do work in any of the given velocities."""
    work = [np.abs(np.einsum("bi,bid->bd", each.reshape(-1, 3), by_block)).max(axis=1)
            for each in (problem.dead, problem.live)]  # fmt: skip
    return np.asarray(np.maximum(*work) > ZERO_LOAD * np.abs(by_block).max(axis=(1, 2)))


def _candidates(share: Reals, blocks: Indices) -> list[int]:
    """Return one block of each set of blocks that move in proportion, the largest set first."""
    set_sizes: dict[int, int] = {}
    for j in blocks.tolist():
        same = next((k for k in set_sizes if abs(share[k] @ share[j]) > 1 - EQUAL_VELOCITY**2), j)
        set_sizes[same] = set_sizes.get(same, 0) + 1
    return sorted(set_sizes, key=lambda k: (-set_sizes[k], k))


def _reaches(opening: Reals, still: Reals, moves: Reals) -> bool:
    """Return whether one set of blocks can move, without closing any ray, while another set stays at rest."""
    n, d = opening.shape
    equal = from_blocks([[opening, -np.eye(n)], [still[None, :], None]])
    optimum = least(
        np.append(-moves, np.zeros(n)), equal, np.zeros(n + 1),
        np.append(np.full(d, -1.0), np.zeros(n)), np.append(np.ones(d), np.full(n, np.inf)),
    )  # fmt: skip
    return optimum is not None and -optimum.value > EQUAL_VELOCITY


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
        optimum = least(
            np.concatenate([np.zeros(d + n), np.ones(2 * m)]), equal, np.append(np.zeros(n + m), sign),
            np.concatenate([np.full(d, -np.inf), np.zeros(n + 2 * m)]), np.full(d + n + 2 * m, np.inf),
        )  # fmt: skip
        if optimum is not None:
            return np.asarray(space @ optimum.x[:d])
    return None


def _turns_with(problem: AssemblyProblem, field: Reals, moves: Bools, block: int, motion: Reals) -> bool:
    """Return whether the only motion of a block is to move as a part of some moving block."""
    place = np.array(problem.frame.centroids) / problem.frame.size
    for k in np.flatnonzero(moves):
        vx, vy, turn = field[3 * k : 3 * k + 3]
        if abs(turn) <= EQUAL_VELOCITY * np.abs(field).max():
            continue  # a block that slides without rotation has no point to turn about
        arm = place[block] - place[k]
        along = np.array([vx - turn * arm.imag, vy + turn * arm.real, turn])
        if np.linalg.norm(along - motion * (along @ motion)) <= EQUAL_VELOCITY * np.linalg.norm(along):
            return True
    return False

"""Check whether a weakest mechanism is unique, and find the others with the same multiplier.

A vertex of the linear programme always has one degree of freedom. Rays that can carry force in *any* state of the
greatest multiplier keep their contact in every mechanism of that multiplier, and each other ray opens in some mechanism
(strict complementarity). The velocities that keep these contacts are a vector space; if its dimension is one, the
mechanism is unique.
"""

from __future__ import annotations

import numpy as np

from mechanisms._assembly.faults import NoAnswer
from mechanisms._assembly.programme import least
from mechanisms._assembly.rays import Bools, Frame, Indices, Rays
from mechanisms._assembly.rigid import rigid_parts
from mechanisms._assembly.sparse import Sparse, beside, components
from rocking_cli.core import Reals

OPENS = 1e-7  # rate from which a ray opens, over the fastest rate
CARRIES = 1e-9  # force from which a ray carries, over the weight
ENOUGH = 1e-3  # most of the force of one ray that counts in the cost, over the weight
LARGER = 1e3  # largest factor on a state, so that small forces are found
RANK = 1e-10  # singular values below this share of the largest one count as zero
CLEAN = 1e-12  # velocities below this share of the fastest one are set to zero
MOST = 8  # mechanisms that are returned, at most


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
    shut = np.abs(rate) <= OPENS * np.abs(rate).max()
    kept = ~rays.one_sided
    asked = rays.one_sided & shut
    by_ray = rays.rates.T.tocsc()
    while asked.any():
        # Unknown: of each ray asked after what counts of it and the surplus, then the rays known to be kept, the
        # multiplier, and the size of the state.
        k, known = np.flatnonzero(asked), np.flatnonzero(kept)
        count, rest = len(k), len(known)
        found = least(
            np.concatenate([np.full(count, -1.0), np.zeros(count + rest + 2)]),
            beside([by_ray[:, k], by_ray[:, k], by_ray[:, known], live, dead]),
            np.zeros(len(dead)),
            np.concatenate([np.zeros(2 * count), rays.low[known], [-np.inf, 1.0]]),
            np.concatenate([np.full(count, ENOUGH), np.full(count + rest + 1, np.inf), [LARGER]]),
        )
        if found is None:
            raise NoAnswer("no forces belong to the mechanism that was found: the joints are too short, or too many")
        size = found.x[-1]
        more = found.x[:count] + found.x[count : 2 * count] > CARRIES * size
        kept[k[more]] = True
        asked[k[more]] = False
        if not more.any() or size < LARGER / 2:
            break
    return kept


def velocity_space(rates: Sparse, frame: Frame) -> Reals:
    """Return columns that span the velocities of the blocks at which the given rates are zero.

    Their shape is (3 blocks, dimensions).
    """
    parts = rigid_parts(rates, frame)
    left = (rates[parts.between] @ parts.basis).tocsr()
    # Parts that no rate ties to each other are independent.
    entries = left.tocoo()
    part = entries.col // 3
    of_row = np.zeros(left.shape[0], np.intp)
    of_row[entries.row] = part
    label = components(of_row[entries.row], part, parts.count)
    rows, columns = _members(label[of_row]), _members(np.repeat(label, 3))
    found = []
    for k, these in columns.items():
        chosen = rows.get(k, np.zeros(0, np.intp))
        found.append(parts.basis[:, these] @ null_space(left[chosen][:, these].toarray()))
    return np.column_stack([np.zeros((rates.shape[1], 0)), *found])


def _members(label: Indices) -> dict[int, Indices]:
    """Return the indices of the nodes with each label, in order."""
    order = np.argsort(label, kind="stable")
    names, starts = np.unique(label[order], return_index=True)
    return dict(zip(names.tolist(), np.split(order, starts[1:]), strict=True)) if len(names) else {}


def null_space(rows: Reals) -> Reals:
    """Return orthonormal columns that span the null space of some rows."""
    if len(rows) == 0:
        return np.eye(rows.shape[1])
    if len(rows) > rows.shape[1]:
        rows = np.asarray(np.linalg.qr(rows, mode="r"))  # the same squares of lengths in fewer rows
    _, values, ways = np.linalg.svd(rows)
    rank = int(np.count_nonzero(values > RANK * values[0]))
    return np.asarray(ways[rank:].T)


def mechanisms_of(rays: Rays, kept: Bools, space: Reals, raw: Reals) -> list[Reals]:
    """Return the mechanism of a space of one dimension, or extreme mechanisms of a larger one.

    All rays that are not kept open, or stay shut, in each of them.
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
    found: list[Reals] = []
    wanted = np.vstack([space, -space])
    tried = np.zeros((0, d))
    for row in wanted[np.abs(wanted).max(axis=1) > CLEAN]:
        unit = row / np.linalg.norm(row)
        if (tried @ unit > 1 - CLEAN).any():
            continue  # blocks that move in proportion ask the same
        tried = np.vstack([tried, unit])
        best = least(np.append(row, np.zeros(n)), np.vstack([equal, total]), np.append(np.zeros(n), 1.0), low, high)
        if best is None:
            continue
        field = _clean(space @ best.x[:d])
        field /= np.linalg.norm(field)
        if all(np.abs(field - other).max() > 1e-6 for other in found):
            found.append(field)
        if len(found) == MOST:
            break
    return found + both_ways


def _clean(field: Reals) -> Reals:
    return np.where(np.abs(field) > CLEAN * np.abs(field).max(), field, 0.0)

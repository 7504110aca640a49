"""Whether a weakest mechanism is the only one, and which others share its multiplier.

A vertex of the programme always looks like one degree of freedom. So ask which rays can carry force in *any* state of
the greatest multiplier: those must keep their contact in every mechanism of that multiplier, and each other one opens
in some (strict complementarity). The velocities that keep the first are a space; one dimension is one mechanism.
"""

from __future__ import annotations

import numpy as np

from mechanisms._assembly.faults import NoAnswer
from mechanisms._assembly.programme import least
from mechanisms._assembly.rays import Bools, Rays
from rocking_cli.core import Reals

OPENS = 1e-7  # of the fastest rate: a ray that opens
CARRIES = 1e-9  # of the weight: a ray that carries force
ENOUGH = 1e-3  # of the weight: more of one force is no use where others are looked for
RANK = 1e-10  # of the largest singular value
CLEAN = 1e-12  # of the fastest velocity
MOST = 8  # mechanisms that are named


def kept_rays(rays: Rays, dead: Reals, live: Reals, raw: Reals) -> Bools:
    """The rays that keep their contact in every mechanism of the greatest multiplier; the free ones among them.

    `raw` is one such mechanism. Forces that do no work on it are those of the states of the greatest multiplier, so
    the multiplier need not be prescribed to its last digit.
    """
    rate = rays.rates @ raw
    shut = np.abs(rate) <= OPENS * np.abs(rate).max()
    kept = ~rays.one_sided
    asked = rays.one_sided & shut
    n = len(rate)
    while asked.any():
        # Unknown: rays, multiplier, and of each ray asked after how much of it counts, f = counted + surplus.
        k = np.flatnonzero(asked)
        pick = np.zeros((len(k), n))
        pick[range(len(k)), k] = 1.0
        count, none = len(k), np.zeros((len(k), 1))
        found = least(
            np.concatenate([np.zeros(n + 1), -np.ones(count), np.zeros(count)]),
            np.block(
                [
                    [rays.rates.T, live[:, None], np.zeros((len(dead), 2 * count))],
                    [pick, none, -np.eye(count), -np.eye(count)],
                ]
            ),
            np.concatenate([-dead, np.zeros(count)]),
            np.concatenate([rays.low, [-np.inf], np.zeros(2 * count)]),
            np.concatenate(
                [
                    np.where(shut | ~rays.one_sided, np.inf, 0.0),
                    [np.inf],
                    np.full(count, ENOUGH),
                    np.full(count, np.inf),
                ]
            ),
        )
        if found is None:
            raise NoAnswer("no forces belong to the mechanism that was found: the joints are too short, or too many")
        more = asked & (found.x[:n] > CARRIES)
        if not more.any():
            break
        kept |= more
        asked &= ~more
    return kept


def velocity_space(rates: Reals) -> Reals:
    """Columns that span the velocities without any of some rates."""
    if len(rates) == 0:
        return np.eye(rates.shape[1])
    if len(rates) > rates.shape[1]:
        rates = np.asarray(np.linalg.qr(rates, mode="r"))  # the same squares of lengths in fewer rows
    _, values, ways = np.linalg.svd(rates)
    rank = int(np.count_nonzero(values > RANK * values[0]))
    return np.asarray(ways[rank:].T)


def mechanisms_of(rays: Rays, kept: Bools, space: Reals, raw: Reals) -> list[Reals]:
    """The mechanism in a space of one dimension, or extreme ones of a larger space, in which no ray closes."""
    if space.shape[1] == 0:
        return [_clean(raw)]
    if space.shape[1] == 1:
        return [_clean(space[:, 0] * np.sign(space[:, 0] @ raw))]
    return _extremes(rays.rates[~kept] @ space, space) or [_clean(raw), _clean(raw)]


def _extremes(opening: Reals, space: Reals) -> list[Reals]:
    """Extreme rays of the cone of z with opening z >= 0, and last what moves both ways and opens nothing.

    One velocity of one block at a time decides which ray is looked for.
    """
    neutral = velocity_space(opening)
    both_ways = [_clean(space @ z) for z in neutral.T]
    if neutral.shape[1]:
        across = velocity_space(neutral.T)
        opening, space = opening @ across, space @ across
    n, d = opening.shape
    equal = np.column_stack([opening, -np.eye(n)])
    total = np.append(np.zeros(d), np.ones(n))
    low, high = np.append(np.full(d, -1e6), np.zeros(n)), np.append(np.full(d, 1e6), np.full(n, np.inf))
    found: list[Reals] = []
    wanted = np.vstack([space, -space])
    for row in wanted[np.abs(wanted).max(axis=1) > CLEAN]:
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

"""How much friction a multiplier needs, and a state of the forces that needs no more.

Where friction is not given a joint never slides, which glues it: its shear is free even where it carries no normal
force. Such a joint is named, because no friction at all would do.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mechanisms._assembly.blocks import Contact
from mechanisms._assembly.limit import Collapse
from mechanisms._assembly.problem import Problem
from mechanisms._assembly.programme import least
from mechanisms._assembly.rays import Rays
from rocking_cli.core import Reals
from rocking_cli.core.contacts import MASONRY

MOST = 10.0  # a coefficient of friction that no joint has
SAME = 1e-9  # of the multiplier: what is left as it is
FINE = 1e-6  # of the coefficient of friction


@dataclass(frozen=True, eq=False)
class Friction:
    """The least friction of all joints that leaves a multiplier as it is.

    Parameters
    ----------
    needed : float or None
        The coefficient, rounded up by less than 1e-6 of itself; None: none up to 10 does.
    glued : tuple of int
        Joints that carry shear without a normal force in the state shown, if there is no such coefficient.
    normal, shear, guide : ndarray
        The state shown, which needs no more: as of `Collapse`.
    """

    needed: float | None
    glued: tuple[int, ...]
    normal: Reals
    shear: Reals
    guide: Reals


def friction(found: Collapse) -> Friction:
    """The friction that a mechanism needs, by bisection of its programme with less and less in every joint."""
    problem, multiplier = found.problem, found.multiplier * found.problem.strength

    def carries(mu: float) -> Reals | None:
        rays = problem.bearings.rays(mu)
        reached, forces, _ = problem.greatest(rays)
        return forces @ rays.mix if reached >= multiplier * (1 - SAME) else None

    state = carries(MOST)
    if state is None:
        state, glued = _glued(problem, multiplier)
        return Friction(None, glued, *problem.by_contact(problem.weight * state))
    low, high = 0.0, MOST
    frictionless = carries(0.0)
    if frictionless is not None:
        return Friction(0.0, (), *problem.by_contact(problem.weight * frictionless))
    while high - low > FINE * high:
        middle = (low + high) / 2
        less = carries(middle)
        if less is None:
            low = middle
        else:
            state, high = less, middle
    return Friction(high, (), *problem.by_contact(problem.weight * state))


def with_usual(found: Collapse) -> float | None:
    """The multiplier with the usual friction in joints without any; None if there are none, 0 if it does not stand."""
    problem = found.problem
    if all(each.friction is not None for each in problem.bearings.bearings):
        return None
    reached, _, _ = problem.greatest(problem.bearings.rays(usual=MASONRY))
    return max(reached, 0.0) / problem.strength


def sheared(found: Friction, contacts: Sequence[Contact]) -> tuple[int, ...]:
    """Joints without friction that carry more shear in the state shown than the usual friction would let them."""
    least = SAME * float(np.abs(found.normal).max(initial=0.0))
    beyond = np.abs(found.shear) > MASONRY * np.maximum(found.normal.sum(axis=1), 0.0) + least
    return tuple(k for k, each in enumerate(contacts) if each.friction is None and beyond[k])


def _glued(problem: Problem, multiplier: float) -> tuple[Reals, tuple[int, ...]]:
    """A state with as little shear beyond the greatest friction as there can be, and the joints that have it."""
    rays = problem.bearings.rays(MOST)
    free: Rays = problem.bearings.rays()
    joints = [k for k, each in enumerate(problem.bearings.bearings) if each.friction is None]
    rows = [problem.bearings.starts[k] + len(problem.bearings.bearings[k].points) for k in joints]
    extra = problem.bearings.rates[rows].T
    count, n = len(rows), len(rays.rates)
    # Less than the multiplier by a hair, lest rounding leave no state at all.
    found = least(
        np.concatenate([np.zeros(n), np.ones(2 * count)]),
        np.column_stack([rays.rates.T, extra, -extra]),
        -problem.dead - multiplier * (1 - SAME / 10) * problem.live,
        np.concatenate([rays.low, np.zeros(2 * count)]),
        np.full(n + 2 * count, np.inf),
    )
    if found is None:  # rounding took even that
        _, forces, _ = problem.greatest(free)
        return forces @ free.mix, ()
    state = found.x[:n] @ rays.mix
    beyond = found.x[n : n + count] - found.x[n + count :]
    state[rows] += beyond
    return state, tuple(k for k, value in zip(joints, beyond, strict=True) if abs(value) > SAME)

"""Friction required by a multiplier, and a state of forces that requires no more.

A joint without a given coefficient of friction never slides, as if it were glued: it may carry shear without a normal
force. Joints that do so are reported, because no coefficient of friction would suffice.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from mechanisms._assembly.blocks import AssemblyContact
from mechanisms._assembly.confined import undilated
from mechanisms._assembly.limit import Collapse
from mechanisms._assembly.mechanism import ZERO_VELOCITY
from mechanisms._assembly.problem import AssemblyProblem, Rays
from mechanisms._assembly.programme import beside, least
from rocking_cli.core import Reals
from rocking_cli.core.contacts import MASONRY_FRICTION

MAX_FRICTION = 10.0
EQUAL_MULTIPLIERS = 1e-8  # relative difference of multipliers that count as equal
FRICTION_ACCURACY = 1e-6  # relative error of the required coefficient of friction


@dataclass(frozen=True, eq=False)
class Friction:
    """The least coefficient of friction of all joints at which a multiplier stays the same.

    Parameters
    ----------
    needed : float or None
        The coefficient, rounded up by less than 1e-6 of its value; None if it is larger than 10.
    glued : tuple of int
        Joints that carry shear without a normal force in this state, if there is no such coefficient.
    normal, shear, guide : ndarray
        Forces of a state that requires no more friction, as in `Collapse`.
    """

    needed: float | None
    glued: tuple[int, ...]
    normal: Reals
    shear: Reals
    guide: Reals


def friction(collapsed: Collapse) -> Friction:
    """Return the friction that a mechanism requires: the root of its multiplier as a function of friction.

    By Newton's method: the derivative of the multiplier by the friction follows from the work that the mechanism with
    too little friction dissipates in sliding. Each guess is a linear programme that carries the multiplier or does not,
    so that the root is always bracketed.
    """
    problem, multiplier = collapsed.problem, collapsed.multiplier * collapsed.problem.strength
    search = _FrictionSearch(problem, multiplier)
    if collapsed.associated is not None:  # mechanism without dilation: the shown state defines the friction
        state = (
            np.concatenate([np.column_stack([collapsed.normal, collapsed.shear]).ravel(), collapsed.guide])
            / problem.weight
        )
        used = search.uses(state)
        return Friction(used if used <= MAX_FRICTION else None, (), collapsed.normal, collapsed.shear, collapsed.guide)
    given_friction = float(
        np.nan_to_num(problem.bearings.friction, nan=MAX_FRICTION).clip(max=MAX_FRICTION).max(initial=0.0)
    )
    shown_state = (
        np.concatenate([np.column_stack([collapsed.normal, collapsed.shear]).ravel(), collapsed.guide]) / problem.weight
    )
    limit = search.uses(shown_state)
    if given_friction < MAX_FRICTION:
        search.bound(given_friction, shown_state)  # no joint has a larger coefficient of friction
    elif limit < MAX_FRICTION:
        search.bound(limit, shown_state)
    elif not search.carries(MAX_FRICTION):
        # Find the state with the least shear beyond the largest friction, and the joints that have such shear.
        shown_state, beyond, _ = _beyond(
            problem, multiplier, MAX_FRICTION, _most(collapsed, problem.bearings.rays(MAX_FRICTION))
        )
        glued = tuple(int(k) for k in np.flatnonzero(np.abs(beyond) > EQUAL_MULTIPLIERS))
        return Friction(None, glued, *problem.by_contact(problem.weight * shown_state))
    if not (given_friction < MAX_FRICTION and not _may_carry(collapsed, search)) and not search.carries(0.0):
        while search.high - search.low > FRICTION_ACCURACY * search.high:
            search.carries(search.guess)
    return Friction(search.high, (), *problem.by_contact(problem.weight * search.state))


def _roots(known: Sequence[tuple[float, float, float]]) -> Iterator[float]:
    """Yield estimates of the least coefficient of friction that balances a multiplier, the better one first.

    Each entry of `known` is a coefficient of friction that is too low, the shortfall with it (of the multiplier, or of
    shear force), and how fast this shortfall decreases with friction. The first estimate extrapolates the last two
    entries by a cubic to a shortfall of zero, the second is a Newton step from the last entry. Both are rounded up
    slightly, so that the estimate is likely to suffice.
    """
    mu, lacks, growth = known[-1]
    if len(known) > 1 and growth > 0 and known[-2][2] > 0 and known[-2][1] > lacks:
        # Friction as a cubic of the shortfall, extrapolated to a shortfall of zero.
        before, more, slower = known[-2]
        width, start, end = more - lacks, -1 / growth, -1 / slower
        chord = (before - mu) / width
        bend, twist = (chord - start) / width, (start + end - 2 * chord) / width**2
        yield (mu - start * lacks + bend * lacks**2 - twist * lacks**2 * more) * (1 + FRICTION_ACCURACY / 3)
    if growth > 0:
        yield (mu + lacks / growth) * (1 + FRICTION_ACCURACY / 3)


class _FrictionSearch:
    """Bracket of the friction that a multiplier requires: `high`, with its `state`, suffices, and `low` does not."""

    def __init__(self, problem: AssemblyProblem, multiplier: float) -> None:
        self.problem, self.multiplier = problem, multiplier
        self.low, self.high = 0.0, MAX_FRICTION
        self.state: Reals = np.zeros(0)
        # Values that are too low: friction, shortfall, and rate at which the shortfall decreases with friction.
        self._lows: list[tuple[float, float, float]] = []
        self._stood = True
        self._carried = 0  # number of consecutive guesses of friction that were sufficient

    def bound(self, mu: float, state: Reals) -> None:
        """Set the upper end of the bracket to `mu`, with a state that carries the multiplier with this friction."""
        self.high, self.state = mu, state

    def carries(self, mu: float) -> bool:
        """Return whether joints with at most the friction `mu` carry the multiplier; narrows the bracket."""
        rays = self.problem.bearings.rays(mu)
        reached, forces, raw = self.problem.greatest(rays, exact=True)
        state = rays.mix.T @ forces
        if reached >= self.multiplier * (1 - EQUAL_MULTIPLIERS):
            self._carried += 1
            self.bound(mu, state)
            return True
        self.low, self._carried = mu, 0
        lacks, stands = self.multiplier - reached, True
        if not np.isfinite(reached):  # use the missing shear as the shortfall if the assembly does not stand
            state, beyond, raw = _beyond(self.problem, self.multiplier, mu)
            lacks = float(np.abs(beyond).sum())
            stands = False
        if stands != self._stood:
            self._lows.clear()  # the shortfall is now measured in another way
        self._stood = stands
        self._lows.append((mu, lacks, self._growth(mu, state, raw)))
        return False

    @property
    def below(self) -> float:
        """A value just below the upper end of the bracket, near enough to end the search."""
        return self.high * (1 - 0.9 * FRICTION_ACCURACY)

    @property
    def guess(self) -> float:
        """Next coefficient of friction to try."""
        middle = (self.low + self.high) / 2
        if self._carried == 1:
            return max(self.below, middle)
        if self._carried > 1:  # two guesses sufficed in a row: the root is well below the last one
            return middle
        return next(
            (min(root, self.below) for root in _roots(self._lows) if root > self.low * (1 + FRICTION_ACCURACY / 2)),
            middle,
        )

    def uses(self, state: Reals) -> float:
        """Return the largest ratio of shear to normal force over all joints of a state; infinite for a glued joint."""
        normal, shear, _ = self.problem.by_contact(state)
        pressed = np.maximum(normal.sum(axis=1), 0.0)
        slipping = np.abs(shear) > EQUAL_MULTIPLIERS * np.abs(normal).max(initial=0.0)
        with np.errstate(divide="ignore"):
            return float((np.abs(shear)[slipping] / pressed[slipping]).max(initial=0.0))

    def _growth(self, mu: float, state: Reals, raw: Reals) -> float:
        """Return the derivative of the greatest multiplier by the friction of the joints that are limited to `mu`."""
        bearings = self.problem.bearings
        normal, _, _ = self.problem.by_contact(state)
        slides = np.abs(self.problem.by_contact(bearings.rates @ raw)[1])
        return float((normal.sum(axis=1) * slides)[~(bearings.friction <= mu)].sum())


def with_usual(collapsed: Collapse) -> float | None:
    """Return the multiplier if joints without given friction have the usual one; 0 if the assembly then falls.

    None if all joints have a given friction.
    """
    problem = collapsed.problem
    if not np.isnan(problem.bearings.friction).any():
        return None
    mu = problem.bearings.friction
    usual = replace(problem, bearings=replace(problem.bearings, friction=np.where(np.isnan(mu), MASONRY_FRICTION, mu)))
    reached, _, _ = usual.greatest(usual.bearings.rays())
    confined = undilated(usual, reached)
    if confined is not None and confined.multiplier is not None:
        reached = confined.multiplier
    return max(reached, 0.0) / problem.strength


def sheared(required: Friction, contacts: Sequence[AssemblyContact]) -> tuple[int, ...]:
    """Return the joints without given friction whose shear, in the shown state, exceeds the usual friction."""
    least = EQUAL_MULTIPLIERS * float(np.abs(required.normal).max(initial=0.0))
    beyond = np.abs(required.shear) > MASONRY_FRICTION * np.maximum(required.normal.sum(axis=1), 0.0) + least
    return tuple(k for k, each in enumerate(contacts) if each.friction is None and beyond[k])


def _may_carry(collapsed: Collapse, search: _FrictionSearch) -> bool:
    """Return whether the multiplier may stay the same with slightly less friction than that of the sliding joints.

    With less friction, joints open faster than they slide along the cone, and so carry no force. Mostly there is no
    equilibrium without them, which is found quickly; otherwise a linear programme decides.
    """
    problem, rays = collapsed.problem, collapsed.problem.bearings.rays(search.below)
    low, high = np.append(rays.low, -np.inf), np.append(_most(collapsed, rays), np.inf)
    balance = least(np.zeros(rays.count + 1), beside([rays.rates.T, problem.live]), -problem.dead, low, high)
    return balance is not None and search.carries(search.below)


def _most(collapsed: Collapse, rays: Rays) -> Reals:
    """Return upper bounds of the forces along the rays in the collapse state: 0 if the joint opens along the ray."""
    field = (collapsed.velocity * np.array([1.0, 1.0, collapsed.problem.frame.size])).ravel()
    return np.where(rays.one_sided & (rays.rates @ field > ZERO_VELOCITY * np.abs(field).max()), 0.0, np.inf)


def _beyond(
    problem: AssemblyProblem, multiplier: float, mu: float, upper: Reals | None = None
) -> tuple[Reals, Reals, Reals]:
    """Find the state of forces that needs the least shear in excess of a given coefficient of friction.

    Parameters
    ----------
    problem : AssemblyProblem
        The assembly.
    multiplier : float
        Multiplier that the forces must carry.
    mu : float
        The coefficient of friction. Only joints with a larger coefficient, or none given, may carry more shear.
    upper : ndarray, optional
        Upper bounds of the ray multipliers.

    Returns
    -------
    ndarray
        Forces of the state.
    ndarray, shape (contacts,)
        Shear of each joint in excess of `mu` times its normal force.
    ndarray
        Velocities of the blocks: the dual solution of the linear programme.
    """
    rays = problem.bearings.rays(mu)
    free: Rays = problem.bearings.rays()
    # Joints with more friction than mu, also those that never slide: their friction is NaN.
    joints = np.flatnonzero(~(problem.bearings.friction <= mu))
    rows = problem.bearings.shears[joints]
    extra = problem.bearings.rates[rows].T
    count, n = len(rows), rays.count
    # Allow a slightly smaller multiplier, or rounding may leave no state at all.
    least_, greatest = (
        (EQUAL_MULTIPLIERS / 10, EQUAL_MULTIPLIERS / 10) if upper is None else (EQUAL_MULTIPLIERS, -EQUAL_MULTIPLIERS)
    )
    optimum = least(
        np.concatenate([np.zeros(n + 1), np.ones(2 * count)]),
        beside([rays.rates.T, problem.live, extra, -extra]),
        -problem.dead,
        np.concatenate([rays.low, [multiplier * (1 - least_)], np.zeros(2 * count)]),
        np.concatenate([np.full(n, np.inf) if upper is None else upper, [multiplier * (1 - greatest)],
                        np.full(2 * count, np.inf)]),
    )  # fmt: skip
    beyond = np.zeros(len(problem.bearings.contact))
    if optimum is None:  # rounding left no feasible state
        _, forces, raw = problem.greatest(free)
        return free.mix.T @ forces, beyond, raw
    state = rays.mix.T @ optimum.x[:n]
    beyond[joints] = optimum.x[n + 1 : n + 1 + count] - optimum.x[n + 1 + count :]
    state[rows] += beyond[joints]
    return state, beyond, optimum.prices

"""Check whether the remaining joints of a displaced mechanism can carry the forces.

A joint that stays closed bears at both ends, a hinge at one, and an open joint at none. Normal forces of at least zero,
and shear forces, must balance the forces on the blocks, which include inertia. If this is not possible, another joint
would open, and the mechanism is no longer valid.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from mechanisms._assembly.blocks import AssemblyBlock, AssemblyContact, NoAnswer
from mechanisms._assembly.mechanism import Opening
from mechanisms._assembly.problem import Bearings, Frame, scaled
from mechanisms._assembly.programme import TOLERANCE, beside, least, solved, solver, weighted_squares
from mechanisms._assembly.unique import velocity_space
from rocking_cli.core import Guide, Reals

MAX_IMBALANCE = 1e-6  # largest imbalance of given forces, over the weight
ZERO_TENSION = 1e-9  # tension that counts as zero, over the weight
VIOLATION_ACCURACY = 1e-8  # accuracy of the first violation, over the range searched
MAX_CORRECTIONS = 6  # number of corrections that are tried to remove tension from a similar state
TENSION_CUT = 0.3  # factor on a multiplier that would be tension
SEARCH_STEPS = 32  # steps in which the first violation is searched

BEARING_ENDS = {Opening.CLOSED: (0, 1), Opening.START: (0,), Opening.END: (1,), Opening.LIFTED: ()}


def remaining(
    blocks: Sequence[AssemblyBlock],
    contacts: Sequence[AssemblyContact],
    guides: Sequence[Guide],
    states: Sequence[Opening],
) -> Bearings:
    """Return the joints that bear in a mechanism, in their position at rest, from the state of each; none may slide."""
    for contact, state in zip(contacts, states, strict=True):
        if state is Opening.SLIDES:
            raise ValueError(f"the joint of {contact.a!r} and {contact.b!r} slides")
    return Bearings.of(Frame.of(blocks), contacts, guides, [BEARING_ENDS[state] for state in states])


@dataclass(frozen=True)
class Admissible:
    """Result of the check whether joints can carry forces.

    Parameters
    ----------
    margin : float
        Largest value that all normal forces over the weight (with friction, all edges of cones) can exceed at once, at
        most 1. If negative, its size is the tension required.
    contact : int or None
        The joint that limits the margin, and would open first; None if there is none.
    forces : ndarray or None
        Multipliers of the rays with this margin; None if statics alone determines them.
    """

    margin: float
    contact: int | None
    forces: Reals | None = field(default=None, repr=False, compare=False)

    @property
    def holds(self) -> bool:
        """Whether no tension is required."""
        return self.margin >= -ZERO_TENSION


@dataclass(frozen=True, eq=False)
class DisplacedAssembly:
    """An assembly in a displaced position of its mechanism.

    Parameters
    ----------
    bearings : Bearings
        The remaining joints in the displaced position; see `remaining`.
    weight : float
        Force by which margins are divided [N].
    """

    bearings: Bearings
    weight: float

    @property
    def frame(self) -> Frame:
        """The blocks in the displaced position."""
        return self.bearings.frame

    @cached_property
    def _free(self) -> Reals:
        """Velocities that the joints allow, as orthonormal columns; forces that do work on them cannot be balanced."""
        return np.linalg.qr(velocity_space(self.bearings.rates, self.frame))[0]

    def admissible(self, forces: Reals) -> list[Admissible]:
        """Check whether the joints can carry forces on the blocks, for several cases.

        Parameters
        ----------
        forces : ndarray, shape (..., blocks, 3)
            Forces [N] and moments about the displaced centroid [N m] on each block, with inertia, for each case.

        Returns
        -------
        list of Admissible
            Result of each case.

        Raises
        ------
        NoAnswer
            If the forces do work on the mechanism, so that they are not in equilibrium.
        """
        n = len(self.frame.names)
        cases = np.array([scaled(on_blocks, self.frame, self.weight) for on_blocks in forces.reshape(-1, n, 3)])
        free = self._free
        largest = np.maximum(np.abs(cases).max(axis=1), 1.0)
        off = np.abs(cases @ free).max(axis=1, initial=0.0) / largest
        if (off > MAX_IMBALANCE).any():
            raise NoAnswer(f"forces on the displaced blocks are off their balance by {off.max():.2g} of the weight")
        cases = cases - cases @ free @ free.T
        rays = self.bearings.rays()
        if rays.count == 3 * n - free.shape[1]:  # statically determinate: the forces follow without a linear programme
            values = -solved(beside([rays.rates.T, free]), cases.T)[: rays.count].T[:, rays.one_sided]
            if values.shape[1] == 0:
                return [Admissible(1.0, None)] * len(cases)
            at = values.argmin(axis=1)
            owner = rays.contact[rays.one_sided]
            return [Admissible(min(float(v[k]), 1.0), int(owner[k])) for v, k in zip(values, at, strict=True)]
        # The multiplier of each one-sided ray is the margin plus a variable of at least zero.
        equal = beside([rays.rates.T, rays.rates.T @ rays.one_sided.astype(np.float64)])
        cost, low = np.append(np.zeros(rays.count), -1.0), np.append(rays.low, -np.inf)
        high = np.append(np.full(rays.count, np.inf), 1.0)
        answers = []
        for case in cases:
            optimum = least(cost, equal, -case, low, high)
            if optimum is None:
                raise NoAnswer("no forces in the joints balance those on the displaced blocks")
            blame = np.where(rays.one_sided, optimum.at_lower[:-1], 0.0)
            decides = int(rays.contact[blame.argmax()]) if blame.max(initial=0.0) > ZERO_TENSION else None
            answers.append(Admissible(-optimum.value, decides, optimum.x[:-1] - optimum.value * rays.one_sided))
        return answers

    def near(self, forces: Reals, state: Reals) -> Reals | None:
        """Return joint forces that balance forces on the blocks, by correcting the joint forces of a similar state.

        Joint forces are multipliers of rays, see `Rays`. This is faster than `admissible`, because it solves systems of
        equations and no linear programme. The correction is the smallest one if each multiplier is weighted by the
        inverse square of its value, so that small multipliers hardly change and stay positive. None if a multiplier
        becomes negative, which means tension; another method may still find joint forces without tension.

        Parameters
        ----------
        forces : ndarray, shape (blocks, 3)
            Forces and moments as in `admissible`.
        state : ndarray, shape (rays,)
            Positive multipliers of the similar state.
        """
        rays = self.bearings.rays()
        case = scaled(forces, self.frame, self.weight)
        case = case - self._free @ (self._free.T @ case)
        free = float(np.abs(state).max())
        for _ in range(MAX_CORRECTIONS):
            share = np.where(rays.one_sided, state, free) ** 2
            solve = solver(weighted_squares(rays.rates, share))
            balanced = state
            for _ in range(2):  # the second pass removes the rounding error
                balanced = balanced - share * (rays.rates @ solve(rays.rates.T @ balanced + case))
            off = rays.rates.T @ balanced + case
            if (balanced[rays.one_sided] >= 0).all() and np.abs(off).max() <= TOLERANCE:
                return balanced
            # Reduce the multipliers that would be tension; the next correction balances that.
            state = np.where(rays.one_sided, np.maximum(balanced, TENSION_CUT * state), balanced)
        return None


def first_violation(
    margin: Callable[[float], float], steps: Reals, *, holds: Callable[[float], bool] | None = None
) -> float | None:
    """Return the step at which a margin first falls below zero, to 1e-8 of the last step; None if it does not.

    The margin is evaluated at increasing steps from rest, unless `holds` shows without it that there is no tension;
    then the secant method or bisection finds the root. A violation that begins and ends between two steps is not found.
    """
    low, missing = 0.0, 0.0
    high: float
    for high in steps.tolist():
        if not (holds is not None and holds(high)) and (missing := -margin(high) - ZERO_TENSION) > 0:
            break
        low = high
    else:
        return None
    close, root = VIOLATION_ACCURACY * float(steps[-1]), None
    width = np.inf
    while high - low > close:
        # Bisect unless the secant step has just more than halved the interval.
        guess = (low + high) / 2
        if root is not None and high - low <= width / 2:
            guess = min(max(root, low + 0.9 * close), high - 0.9 * close)
        width = high - low
        less = -margin(guess) - ZERO_TENSION
        if less > 0:
            slope = (missing - less) / (high - guess)
            high, missing = guess, less
            root = high - missing / slope - 0.4 * close if slope > 0 else None
        else:
            low = guess
            root = root + 0.8 * close if root is not None else None
    return high

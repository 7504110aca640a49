"""The subset of curves whose mean, with a common factor, stays within limits about 1 and is nearest to 1.

If there are few enough subsets, all are tried. Otherwise searches from several starts add the best curve until there
are enough, and then exchange one curve for another as long as this improves the subset.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import combinations, islice, product
from math import inf, log
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Reals

Integers = NDArray[np.intp]
MAX_SETS = 200_000  # number of sets up to which all are tried
MAX_MEMBERS = 3_000_000  # limit on the curves of all these sets together
MEMBERS_PER_BLOCK = 30_000  # curves of the sets that are judged at once
SEARCH_STARTS = 20
MISFIT_TOLERANCE = 1e-9  # difference of logarithms within which sets are equal; the earlier one is chosen
LIMIT_MARGIN = 1e-12  # relative margin that keeps a mean at a limit within it in spite of rounding
MAX_EXCHANGES = 1000  # exchanges of a curve in one search


@dataclass(frozen=True, eq=False)
class SubsetProblem:
    """A selection problem: the curves, and the limits on their mean and factors.

    Parameters
    ----------
    curves : ndarray, shape (curves, n)
        Positive ordinates over the target, each curve already multiplied by its own factor.
    weights : ndarray, shape (n,)
        Weights of the points, with the sum 1.
    log_factors : ndarray, shape (curves,)
        Logarithms of the curves' own factors.
    groups : ndarray of int, shape (curves,)
        Group of each curve, from 0; a set may have one curve of each group.
    count : int
        Number of curves in a set.
    within : (float, float)
        Limits on the mean.
    factors : (float, float)
        Limits on the own factor times the common one.
    """

    curves: Reals
    weights: Reals
    log_factors: Reals
    groups: Integers
    count: int
    within: tuple[float, float]
    factors: tuple[float, float]

    @property
    def steps(self) -> int:
        """Number of steps of which `best` reports the progress: sets or searches."""
        return count_sets(self.groups, self.count) if all_tried(self.groups, self.count) else SEARCH_STARTS


class Judged(NamedTuple):
    """Quality of sets, in arrays: ln of the excess over the limits, rms of ln(mean), ln of the common factor."""

    excess: Reals
    rms: Reals
    common: Reals


class Best(NamedTuple):
    """A set: its curves in their order, its excess and rms as in `Judged`, and the common factor."""

    members: Integers
    excess: float
    rms: float
    common: float

    def better(self, other: Best | None) -> bool:
        """Return whether this set is better than another: by excess, then rms, then the order of the curves."""
        if other is None:
            return True
        for mine, theirs in ((self.excess, other.excess), (self.rms, other.rms)):
            if abs(mine - theirs) > MISFIT_TOLERANCE:
                return mine < theirs
        return tuple(self.members.tolist()) < tuple(other.members.tolist())


def count_sets(groups: Integers, count: int) -> int:
    """Return the number of sets of `count` curves with at most one of each group."""
    counts = [1] + [0] * count
    for size in np.bincount(groups).tolist():
        for k in range(count, 0, -1):
            counts[k] += size * counts[k - 1]
    return counts[count]


def all_tried(groups: Integers, count: int) -> bool:
    """Return whether the sets are so few and so small that `best` tries all."""
    sets = count_sets(groups, count)
    return sets <= MAX_SETS and sets * count <= MAX_MEMBERS


def best(problem: SubsetProblem, seed: int, progress: Callable[[int], object] = lambda done: None) -> Best:
    """Return the best of all sets, or the best that searches find.

    Parameters
    ----------
    problem : SubsetProblem
        A problem with at least `count` groups.
    seed : int
        Seed of the starts of the searches.
    progress : callable, optional
        Called with the number of `steps` done since the last call.
    """
    if all_tried(problem.groups, problem.count):
        return _best_of_all(problem, progress)
    best_set: Best | None = None
    rng = np.random.default_rng(seed)
    for start in range(SEARCH_STARTS):
        members = [] if start == 0 else [int(rng.integers(len(problem.curves)))]
        while len(members) < problem.count:
            members.append(_added(problem, members)[0])
        one = _exchanged(problem, members)
        if one.better(best_set):
            best_set = one
        progress(1)
    assert best_set is not None
    return best_set


def judge(problem: SubsetProblem, sums: Reals, count: int, least: Reals, most: Reals) -> Judged:
    """Return the quality of sets, each with the best permitted common factor.

    Parameters
    ----------
    problem : SubsetProblem
        The limits and weights.
    sums : ndarray, shape (sets, n)
        Sum of the curves of each set.
    count : int
        Number of curves in each set.
    least, most : ndarray, shape (sets,)
        Smallest and largest logarithm of the own factors in each set.
    """
    logs = np.log(sums / count)
    low, high = logs.min(axis=1), logs.max(axis=1)
    floor, roof = log(problem.within[0]), log(problem.within[1])
    # Bounds of the common factor by the limits on factors; they contain zero, as each curve's own factor obeys them.
    down, up = log(problem.factors[0]) - least, log(problem.factors[1]) - most
    balanced = np.clip((floor - low + roof - high) / 2, down, up)
    excess = np.maximum(floor - low - balanced, balanced + high - roof)
    fits = excess <= MISFIT_TOLERANCE
    centre = logs @ problem.weights
    nearest = np.clip(
        -centre,
        np.minimum(np.maximum(floor - low, down) + LIMIT_MARGIN, balanced),
        np.maximum(np.minimum(roof - high, up) - LIMIT_MARGIN, balanced),
    )
    common = np.where(fits, nearest, balanced)
    rms = np.sqrt(((logs + common[:, None]) ** 2) @ problem.weights)
    return Judged(np.where(fits, 0.0, excess), rms, common)


def _judge_members(problem: SubsetProblem, members: Integers) -> Judged:
    """Return the quality of sets given by the indices of their curves, shape (sets, count)."""
    factors = problem.log_factors[members]
    sums = problem.curves[members].sum(axis=1)
    return judge(problem, sums, members.shape[1], factors.min(axis=1), factors.max(axis=1))


def _best_of_all(problem: SubsetProblem, progress: Callable[[int], object]) -> Best:
    blocks, judged = [], []
    sets = _all_sets(problem)
    while block := list(islice(sets, max(MEMBERS_PER_BLOCK // problem.count, 1))):
        members = np.sort(np.array(block, dtype=np.intp), axis=1)
        blocks.append(members)
        judged.append(_judge_members(problem, members))
        progress(len(block))
    members = np.concatenate(blocks)
    order = np.lexsort(members.T[::-1])
    members = members[order]
    every = Judged(*(np.concatenate(parts)[order] for parts in zip(*judged, strict=True)))
    return _picked(members, every)


def _all_sets(problem: SubsetProblem) -> Iterator[tuple[int, ...]]:
    """Yield every set: for every choice of groups, every choice of one curve from each."""
    of_group = [np.flatnonzero(problem.groups == k).tolist() for k in range(int(problem.groups.max()) + 1)]
    for groups in combinations(of_group, problem.count):
        yield from product(*groups)


def _picked(members: Integers, judged: Judged) -> Best:
    """Return the first of the best sets, shape (sets, count), ignoring differences due to rounding."""
    kept = np.flatnonzero(judged.excess <= judged.excess.min() + MISFIT_TOLERANCE)
    kept = kept[judged.rms[kept] <= judged.rms[kept].min() + MISFIT_TOLERANCE]
    k = int(kept[0])
    return Best(members[k], float(judged.excess[k]), float(judged.rms[k]), float(np.exp(judged.common[k])))


def _exchanged(problem: SubsetProblem, members: list[int]) -> Best:
    """Improve a set by exchanging one curve at a time, always in the best way, until no exchange improves it."""
    now = _picked(every := np.sort(np.array([members], dtype=np.intp)), _judge_members(problem, every))
    for _ in range(MAX_EXCHANGES):
        tried = now
        for member in now.members.tolist():
            kept = [each for each in now.members.tolist() if each != member]
            added, excess, rms, common = _added(problem, kept)
            one = Best(np.sort(np.array([*kept, added], dtype=np.intp)), excess, rms, common)
            tried = one if one.better(tried) else tried
        if tried is now:
            break
        now = tried
    return now


def _added(problem: SubsetProblem, members: list[int]) -> tuple[int, float, float, float]:
    """Return the curve that is best added to a set, and excess, rms and common factor of the result."""
    free = np.flatnonzero(~np.isin(problem.groups, problem.groups[members]))
    sums = problem.curves[members].sum(axis=0) + problem.curves[free]
    log_factors, those = problem.log_factors[members], problem.log_factors[free]
    least, most = np.minimum(those, log_factors.min(initial=inf)), np.maximum(those, log_factors.max(initial=-inf))
    chosen = _picked(free[:, None], judge(problem, sums, len(members) + 1, least, most))
    return int(chosen.members[0]), chosen.excess, chosen.rms, chosen.common

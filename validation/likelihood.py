"""Slenderness and restitution of a structure from outcomes of shake-table tests: the likelihood over a grid of both."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from rocking_cli.arrays import Bools, Reals
from rocking_cli.dynamics.parallel import in_parts
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.short_repr import short_repr
from rocking_cli.structure import Structure
from rocking_cli.studies.neighbours import Draws, Neighbourhood, simulate_neighbours
from validation.rules import in_time, surprise
from validation.table import ObservedTest

REGION_PROBABILITY = 0.9  # probability of the joint region, by the likelihood ratio
EDGE_DROP = -float(np.log(1 - REGION_PROBABILITY))  # drop of the log-likelihood at its edge (chi-square, 2 degrees)


@short_repr
@dataclass(frozen=True, eq=False)
class JointRegion:
    """Likelihood of the outcomes of tests over slenderness and restitution.

    Parameters
    ----------
    around : Neighbourhood
        How the neighbours of each test were drawn.
    slenderness : ndarray, shape (n,)
        Factors on the slenderness of the structure.
    restitution : ndarray, shape (m,)
        Coefficients of restitution.
    likelihood : ndarray, shape (n, m)
        Log-likelihood of the outcomes, times clusters over tests.
    tests, clusters : int
        Number of tests with an observed outcome, and of the clusters they belong to.
    unknown : float
        Mean share of the neighbours of unknown outcome, at the best point.
    """

    around: Neighbourhood
    slenderness: Reals
    restitution: Reals
    likelihood: Reals
    tests: int
    clusters: int
    unknown: float

    @property
    def best(self) -> tuple[float, float]:
        """Slenderness and restitution of the largest likelihood."""
        i, k = np.unravel_index(int(np.argmax(self.likelihood)), self.likelihood.shape)
        return float(self.slenderness[i]), float(self.restitution[k])

    @property
    def inside(self) -> Bools:
        """Mask of the points of the grid in the joint region of 90 %, shape (n, m)."""
        return np.asarray(self.likelihood >= self.likelihood.max() - EDGE_DROP)

    @property
    def ranges(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Least and largest slenderness, and restitution, of the points in the joint region."""
        rows, columns = np.nonzero(self.inside)
        one, other = self.slenderness[rows], self.restitution[columns]
        return (float(one.min()), float(one.max())), (float(other.min()), float(other.max()))


def joint_region(
    tests: Sequence[ObservedTest],
    structure: Structure,
    motion_of: Callable[[str], GroundMotion],
    around: Neighbourhood,
    slenderness: Reals,
    restitution: Reals,
    *,
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
) -> JointRegion:
    """Compute the likelihood of the outcomes of tests over a grid of slenderness and restitution.

    Parameters
    ----------
    tests : sequence of ObservedTest
        The tests, of one structure; those without an observed outcome do not count.
    structure : Structure
        The structure.
    motion_of : callable
        Returns the motion that a test names. Called from several threads.
    around : Neighbourhood
        How to draw the neighbours of each test at each point of the grid.
    slenderness, restitution : ndarray
        The grid: factors on the slenderness, and coefficients of restitution, increasing.
    threads : int, optional
        Number of threads; by default, one for each processor.
    progress : callable, optional
        Called with the number of tests done since the last call.

    Raises
    ------
    InputError
        If no outcome was observed, or the best point lies on an edge of the grid.
    """
    kept = [each for each in tests if each.overturned is not None]
    if not kept or not around.count:
        raise InputError("a joint region needs tests with an observed outcome, and at least one neighbour of each")
    around = around.of(structure.model("nonlinear"))
    models = [structure.under(restitution=float(eta)).model("nonlinear") for eta in restitution]
    shape = (len(kept), slenderness.size, restitution.size)
    overturned, unknown = np.empty(shape), np.empty(shape)

    def work(start: int, stop: int) -> None:
        for k in range(start, stop):
            test = kept[k]
            motion = in_time(motion_of(test.record).scaled(test.scale), test.time_scale)
            signs = (1, -1) if test.polarity == "both" else (int(test.polarity),)
            for place, model in enumerate(models):
                drawn = _scaled(around.drawn(model), slenderness, model.weight_share)
                histories = [simulate_neighbours(model, motion, drawn, polarity=sign, threads=1) for sign in signs]
                for shares, of in ((overturned, "overturned"), (unknown, "unknown")):
                    runs = np.stack([getattr(each, of) for each in histories]).reshape(
                        -1, slenderness.size, around.count
                    )
                    shares[k, :, place] = runs.mean(axis=(0, 2))

    in_parts(work, len(kept), 1, threads, progress)
    seen = np.array([float(each.overturned or 0) for each in kept])[:, None, None]
    clusters = len({each.cluster for each in kept})
    likelihood = -surprise(overturned, seen, around.count).sum(axis=0) * clusters / len(kept)
    best = np.unravel_index(int(np.argmax(likelihood)), likelihood.shape)
    region = JointRegion(
        around, slenderness, restitution, likelihood, len(kept), clusters, float(unknown[:, best[0], best[1]].mean())
    )
    _check(region, best)
    return region


def _scaled(drawn: Draws, slenderness: Reals, weight_share: float) -> Draws:
    """Return the neighbours with each factor on the slenderness, one factor after the other."""
    wide = 1 + (drawn.slender - 1) / weight_share if weight_share else np.ones_like(drawn.slender)
    slender = 1 + weight_share * (slenderness[:, None] * wide - 1)
    count = slenderness.size
    return Draws(np.tile(drawn.amplitude, count), slender.ravel(), np.tile(drawn.eta, (count, 1)))


def _check(region: JointRegion, best: Sequence[np.intp]) -> None:
    """Raise `InputError` if the best point lies on an edge of the grid."""
    on_edge = [
        f"{name} {values[k]:.4g}"
        for name, values, k in zip(
            ("slenderness", "restitution"), (region.slenderness, region.restitution), best, strict=True
        )
        if k in (0, values.size - 1)
    ]
    if on_edge:
        raise InputError(
            f"the best point of the grid lies on its edge ({' and '.join(on_edge)}): the likelihood may be larger "
            "outside. Widen the range, or fit the restitution to a free-rocking trace"
        )

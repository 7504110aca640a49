"""The margin of a ground motion: scale factors at which it uplifts a structure, and at which it overturns it.

Overturning comes and goes as the factor on a motion increases, so that no least factor would be the same in two
computations. Instead, the share of neighbouring motions that overturn is computed at each factor.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from math import inf
from statistics import NormalDist
from typing import NamedTuple

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.outcome import Outcomes
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.short_repr import short_repr
from rocking_cli.studies.conclusion import LEAST_SHARE, Conclusion, NeighbourShare
from rocking_cli.studies.engines import EngineName, follow
from rocking_cli.studies.fit import wilson
from rocking_cli.studies.neighbours import Conditions, Draws, Neighbourhood, least_uplift, simulate_neighbours
from rocking_cli.studies.response import concluded, histories

SHARE_LEVELS = (LEAST_SHARE, 0.5, 0.9)
FACTOR_TOLERANCE = 1e-9  # relative difference of equal factors
FACTORS: Reals = np.geomspace(0.2, 5.0, 60)
FEW_FACTORS: Reals = np.geomspace(0.2, 5.0, 15)  # of free blocks


class Limits(NamedTuple):
    """What decides besides rocking whether a body falls, for a motion at a factor of 1.

    Parameters
    ----------
    clearance : float
        Slip from which it has fallen off an edge [m].
    held_to : float or ndarray
        Factor up to which something holds it at rest, over its slenderness.
    ends_from : float or ndarray
        Factor from which nothing is known of the motion of what it stands on, and it counts as unknown.
    """

    clearance: float = inf
    held_to: Reals | float = 0.0
    ends_from: Reals | float = inf


@short_repr
@dataclass(frozen=True, eq=False)
class Margin:
    """The share of neighbours that overturn, as a function of the scale factor on a ground motion.

    Parameters
    ----------
    around : Neighbourhood
        How the neighbours of each factor were drawn.
    uplift : float or None
        The least factor that uplifts the structure, exact except for the vertical component; None if none does.
    factors : ndarray, shape (n,)
        Scale factors, increasing; 1, the motion itself, is one of them.
    overturned : ndarray, shape (n,)
        The share of the neighbours at each factor that overturns; of two polarities, the larger.
    unknown : ndarray, shape (n,)
        The additional share of unknown outcome: at most the sum of both overturns, under the worse polarity.
    checked : bool
        Whether the joints of the structure are known; if not, no outcome is unknown.
    engine : {"exact", "blocks", "auto"}
        Who simulated them.
    by_blocks : int
        Number of neighbours, of all factors and polarities, that were simulated with free blocks.
    off_edge : int
        Number of those of them in which a block falls off an edge; they count as overturned.
    pga_g : float
        Peak ground acceleration of the motion at a factor of 1 [standard gravity].
    polarities : sequence of int
        The polarities that were simulated.
    on_floor : bool
        Whether the structure stands on a floor, below which the ground has this peak.
    """

    around: Neighbourhood
    uplift: float | None
    factors: Reals
    overturned: Reals
    unknown: Reals
    checked: bool = True
    engine: EngineName = "exact"
    by_blocks: int = 0
    off_edge: int = 0
    pga_g: float = field(kw_only=True)
    polarities: Sequence[int] = field(kw_only=True)
    on_floor: bool = False

    @property
    def of_pga(self) -> str:
        """The name of the peak acceleration."""
        return "PGA of the ground" if self.on_floor else "PGA"

    @property
    def at_most(self) -> Reals:
        """The share that overturns if all neighbours of unknown outcome do, shape (n,)."""
        return self.overturned + self.unknown

    @property
    def share(self) -> NeighbourShare:
        """The share of neighbours that overturns at a factor of 1."""
        one = np.searchsorted(self.factors, 1.0)
        return NeighbourShare(float(self.overturned[one]), float(self.at_most[one]), self.around.count)

    @property
    def interval(self) -> tuple[Reals, Reals]:
        """Range of the shares that so few neighbours are known to within: its ends from 5 to 95 %, each shape (n,).

        The lower end is that of the share that overturns, the upper that of the share that may overturn.
        """
        quantile = NormalDist().inv_cdf(0.95)
        (low, _), (_, high) = (wilson(each, self.around.count, quantile) for each in (self.overturned, self.at_most))
        return low, high

    @property
    def known_to(self) -> float | None:
        """The largest factor up to which all outcomes are known; None if that is at no factor, or at all of them."""
        first = np.flatnonzero(self.unknown > 0)[:1]
        return float(self.factors[first[0] - 1]) if first.any() else None

    def first(self, level: float, *, unknown: bool = False) -> float | None:
        """Return the least factor at which a share `level` overturns (or is unknown); None without one."""
        reached = self._shares(unknown) >= level
        return float(self.factors[reached.argmax()]) if reached.any() else None

    def last_below(self, level: float, *, unknown: bool = False) -> float | None:
        """Return the largest factor at which less than a share `level` overturns (or is unknown); None without one."""
        below = self._shares(unknown) < level
        return float(self.factors[np.flatnonzero(below)[-1]]) if below.any() else None

    def always(self, level: float, *, unknown: bool = False) -> float | None:
        """Return the least factor from which on a share of `level` or more overturns (or is unknown), or None."""
        last = self.last_below(level, unknown=unknown)
        above = self.factors if last is None else self.factors[self.factors > last]
        return float(above[0]) if above.size else None

    def _shares(self, unknown: bool) -> Reals:
        return self.at_most if unknown else self.overturned

    def islands(self, level: float) -> list[tuple[float, float]]:
        """Return the first and last factor of each range in which at least a share `level` overturns."""
        edges = np.diff(np.concatenate([[False], self.overturned >= level, [False]]).astype(np.int8))
        starts, ends = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1) - 1
        return [(float(self.factors[i]), float(self.factors[j])) for i, j in zip(starts, ends, strict=True)]


def margin(
    conditions: Conditions,
    motion: GroundMotion,
    *,
    factors: Reals = FACTORS,
    limits: Limits | None = None,
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
) -> Margin:
    """Compute the share of overturning as a function of the factor on a motion.

    Parameters
    ----------
    conditions : Conditions
        The structure, how to draw the neighbours of each factor, and the polarities; of both, the worse governs.
    motion : GroundMotion
        The ground motion at a factor of 1.
    factors : ndarray, shape (n,)
        Factors on the motion, positive and increasing; 1 is added.
    limits : Limits, optional
        What else decides whether a neighbour falls.
    threads : int, optional
        Number of threads; by default one for each processor.
    progress : callable, optional
        Called with the number of histories done since the last call; their total is the product of the numbers of
        factors (with 1), neighbours and polarities.

    Raises
    ------
    InputError
        If the number of neighbours is 0, or the factors are not positive and increasing.
    SolverError
        If a motion cannot be followed.
    """
    model, polarities = conditions.model, conditions.signs
    around = conditions.around.of(model)
    if not around.count:
        raise InputError(Problem("neighbouring motions are needed: at least 1", field=named("neighbours")))
    if not (factors.ndim == 1 and factors.size and np.isfinite(factors).all() and (np.diff([0.0, *factors]) > 0).all()):
        raise InputError("scale factors must be positive and in ascending order")
    factors = np.union1d(factors[np.abs(factors - 1) > FACTOR_TOLERANCE], 1.0)
    # The same neighbours at every factor, so that differences come from the factor alone.
    draws, overturned, at_most = around.drawn(model), np.zeros(factors.size), np.zeros(factors.size)
    by_blocks = off_edge = 0
    for k, sign in enumerate(polarities):
        # Neighbours that always overturn cannot do so more often; a symmetric structure has the same shares under the
        # motion reversed.
        undecided = overturned < (0.0 if k and model.symmetric else 1.0)
        if progress is not None:
            progress(int((~undecided).sum()) * around.count)
        some = factors[undecided]
        repeated = Draws(*(np.concatenate([values] * some.size) if some.size else values[:0] for values in draws))
        outcomes = simulate_neighbours(
            model, motion, repeated, scale=some.repeat(around.count), polarity=sign, progress=progress,
            engine=conditions.by, threads=threads,
        )  # fmt: skip
        by_blocks, off_edge = by_blocks + int(outcomes.by_blocks.sum()), off_edge + int(outcomes.off_edge.sum())
        if limits is not None:
            strength = some.repeat(around.count) * repeated.amplitude
            outcomes = limited(outcomes, limits, strength, repeated.slender)
        fell, doubtful = (of.reshape(some.size, around.count).mean(axis=1) for of in (outcomes.fell, outcomes.unknown))
        overturned[undecided] = np.maximum(overturned[undecided], fell)
        at_most[undecided] = np.maximum(at_most[undecided], fell + doubtful)
    at_most = np.maximum(at_most, overturned)
    uplifts = [least_uplift(model, motion.scaled(sign)) for sign in polarities]
    least = min((uplift for uplift in uplifts if uplift is not None), default=None)
    return Margin(
        around, least, factors, overturned, at_most - overturned, engine=conditions.by.name, by_blocks=by_blocks,
        off_edge=off_edge, checked=model.joints is not None or conditions.engine == "blocks",
        pga_g=motion.of_ground.pga_g, polarities=tuple(polarities),
        on_floor=motion.ground is not None,
    )  # fmt: skip


def limited(outcomes: Outcomes, limits: Limits, strength: Reals, slender: Reals | float = 1.0) -> Outcomes:
    """Return outcomes of a body where something else decides too, each at a factor on the motion and slenderness."""
    ends = strength >= limits.ends_from
    held = (strength < limits.held_to * slender) & ~ends
    off_edge = (outcomes.slip >= limits.clearance) & ~outcomes.fell
    fell_to = np.where(held | ends, 0, np.where(off_edge, 1, outcomes.fell_to))
    return replace(
        outcomes, fell_to=fell_to, unknown=((outcomes.unknown & ~off_edge) | ends) & ~held,
        peak_ratio=np.where(held, 0.0, np.where(fell_to | ends, np.nan, outcomes.peak_ratio)),
        slip=np.where(held, 0.0, outcomes.slip),
    )  # fmt: skip


def first_unknown(conditions: Conditions, motion: GroundMotion, found: Margin) -> History | None:
    """Return the first history of unknown outcome of the structure itself, over the factors with unknown neighbours.

    None if there is none, or if free blocks simulate the neighbours.
    """
    for factor in found.factors[found.unknown > 0].tolist() if conditions.engine == "exact" else ():
        for sign in conditions.signs:
            history = follow(conditions.structure, motion.scaled(sign * factor))
            if history.unknown:
                return history
    return None


def conclusion(conditions: Conditions, motion: GroundMotion, found: Margin) -> Conclusion:
    """Return the conclusion at a factor of 1, with the share, and the factor from which a tenth may overturn.

    Parameters
    ----------
    conditions : Conditions
        The structure and the conditions of the margin.
    motion : GroundMotion
        The ground motion at a factor of 1.
    found : Margin
        The margin.
    """
    runs = {sign: histories(conditions, motion.scaled(sign))[0] for sign in conditions.signs}
    from_factor = found.first(LEAST_SHARE, unknown=True)
    ratio = inf if from_factor is None else from_factor
    return replace(concluded(runs, {}, motion.name).told, share=found.share, ratio=ratio)

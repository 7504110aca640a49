"""What becomes of the motions next to one: rocking near overturning is fractal, and a single history one sample of it.

Two nearly identical boulders on one shake table fell together in 88 of 100 tests only. So a history is judged by the
company it keeps: the same motion a little stronger or weaker, with a little more or less restitution.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rocking_cli.core import Direction
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.history import RTOL, History
from rocking_cli.dynamics.model import Model, ModelName
from rocking_cli.dynamics.outcome import Outcomes
from rocking_cli.errors import InputError, Problem, SolverError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.names import percent

Reals = NDArray[np.float64]

FRACTILES = (0.16, 0.50, 0.84)
AGREEMENT = 0.9  # share that must end as the history itself, else its answer is sensitive
ALIKE = 1e-6  # relative difference below which no motion is the worse
LEAST_ETA = 1e-3  # a restitution drawn below that is this: an impact leaves some motion
MOST = 1_000_000  # neighbours; more take minutes
SEED = 1963


@dataclass(frozen=True)
class Around:
    """How many neighbours a motion has, and how far they may be.

    Parameters
    ----------
    count : int
        How many; 0 for none.
    amplitude : float
        Half the width of the factors on the motion, which are uniform about 1. Accelerographs and their processing
        leave a per cent or two.
    restitution : float
        Half the width of what is added to the restitution of each direction, uniform about 0, the same for both.
        Repeated impacts of one specimen scatter by about as much.

    Raises
    ------
    InputError
        If a number is out of range.
    """

    count: int = 200
    amplitude: float = 0.02
    restitution: float = 0.02

    def __post_init__(self) -> None:
        if not 0 <= self.count <= MOST:
            raise InputError(Problem(f"must be from 0 to {MOST}, got {self.count}", field="neighbours"))
        for field in ("amplitude", "restitution"):
            value = getattr(self, field)
            if not 0 <= value < 1:
                raise InputError(Problem(f"must be from 0 to below 1, got {value:g}", field=field))

    @property
    def words(self) -> str:
        """How far the neighbours are from the motion, after a noun."""
        eta = f"a coefficient of restitution up to {self.restitution:g} higher or lower"
        return f"with amplitudes up to {percent(self.amplitude)} higher or lower and {eta}"

    def factors(self) -> Reals:
        """Factors on the motion, shape (count,), one from each of as many equal parts of their range."""
        return 1 + self.amplitude * (2 * self._drawn()[0] - 1)

    def etas(self, model: Model) -> Reals:
        """Restitution of both directions of a model, shape (count, 2), within what no impact may exceed."""
        added = self.restitution * (2 * self._drawn()[1] - 1)
        clipped: Reals = np.clip(np.add.outer(added, model.eta), LEAST_ETA, model.most_eta)
        return clipped

    def _drawn(self) -> tuple[Reals, Reals]:
        """Two uniform numbers of each neighbour: a Latin hypercube, which has less scatter than independent ones."""
        random = np.random.default_rng(SEED)
        one, other = (np.arange(self.count) + random.random((2, self.count))) / max(self.count, 1)
        return one, random.permutation(other)


@dataclass(frozen=True)
class Neighbours:
    """What became of the neighbours of a motion.

    Parameters
    ----------
    around : Around
        How they were drawn.
    model : str
        Which model followed them.
    overturned : float
        The share that overturns.
    peak_ratio : tuple of float
        The peak rotation over the critical one that 16, 50 and 84 % of them do not exceed; infinite where that many
        do not stay up.
    as_itself : float
        The share that ends as the motion itself does, overturned or not.
    lifted : bool
        Whether any of them could lift the structure.
    over : str
        What the peaks are over: "phi_cr", or "of the limit" where a direction has no critical rotation.
    """

    around: Around
    model: ModelName
    overturned: float
    peak_ratio: tuple[float, float, float]
    as_itself: float
    lifted: bool = True
    over: str = "phi_cr"

    @property
    def sensitive(self) -> bool:
        """Whether the answer of the history itself owes something to chance."""
        return self.as_itself < AGREEMENT

    def __str__(self) -> str:
        near = f"{self.around.count} neighbouring motions ({self.around.words})"
        if not self.lifted:
            return f"None of {near} uplifts the structure."
        said = f"Of {near} {_share(self.overturned)}"
        if self.peak_ratio[-1] == 0:
            return f"{said}; at most one in six uplifts it."
        peaks = list(zip(("16 %", "half", "84 %"), self.peak_ratio, strict=True))
        still = [f"{who} do not uplift it" for who, peak in peaks if peak == 0][-1:]
        within = [f"{who} within {peak:.2g}" for who, peak in peaks if 0 < peak < np.inf]
        if within:
            within[0] = f"{within[0].replace(' within', ' keep its peak rotation within')} {self.over}"
        reached = ", ".join(still + within)
        return f"{said}; {reached}." if reached else f"{said}."


def neighbours(
    model: Model,
    motion: GroundMotion | None,
    around: Around | None = None,
    *,
    release: float | None = None,
    rtol: float = RTOL,
    threads: int | None = None,
) -> Neighbours:
    """Follow the neighbours of a motion.

    Parameters
    ----------
    model : Model
        Of the structure; the nonlinear one is the structure itself.
    motion : GroundMotion or None
        As in the history, scaled and reversed; None for a release alone.
    around : Around, optional
        How to draw them.
    release : float, optional
        Start at rest, tilted by this fraction of the critical rotation; it is varied as the motion is.
    rtol, threads
        See `respond_many`.

    Raises
    ------
    InputError
        If there are to be none.
    SolverError
        If one of them cannot be followed.
    """
    around = around or Around()
    if not around.count:
        raise InputError(Problem("must be at least 1", field="neighbours"))
    if release is None and motion is not None and not can_lift(model, motion, 1 + around.amplitude):
        return Neighbours(around, model.name, 0.0, (0.0, 0.0, 0.0), 1.0, lifted=False)
    factors = np.concatenate([[1.0], around.factors()])
    etas = np.concatenate([np.full((1, 2), np.nan), around.etas(model)])  # itself, with its own
    runs, tilts = Runs.of(0, 0, scale=factors, eta=etas), None if release is None else release * factors
    found = follow([model], [motion], runs, release=tilts, rtol=rtol, threads=threads)
    itself, others = found.overturned[0], found.overturned[1:]
    peaks = np.where(others, np.inf, found.peak_ratio[1:])
    # A value that was reached, never one between two: half of infinity is no rotation.
    low, middle, high = (float(peak) for peak in np.quantile(peaks, FRACTILES, method="inverted_cdf"))
    free = model.ends_at_limit
    over = "of the limit" if all(free) else "of phi_cr or the limit" if any(free) else "phi_cr"
    as_itself = float((others == itself).mean())
    return Neighbours(around, model.name, float(others.mean()), (low, middle, high), as_itself, over=over)


Severity = tuple[float, float, float]


def severity(history: History, near: Neighbours | None = None) -> Severity:
    """What motions are compared by: the share of neighbours that overturn, their median peak, the peak of the history.

    Without neighbours the first two are 0; a peak is that over the critical rotation, infinite if it overturns.
    """
    itself = np.inf if history.overturned else history.peak_ratio
    return (near.overturned, near.peak_ratio[1], itself) if near is not None else (0.0, 0.0, itself)


def governing(severities: Mapping[str, Severity], over: str = "phi_cr") -> str:
    """A sentence on the motion that is the worst, if one is.

    Parameters
    ----------
    severities : mapping of str to tuple
        That of each motion by its name, at least one.
    over : str
        What peaks are over.
    """
    worst = max(severities.values())
    if not any(worst):
        return "No motion lifts it."
    which = [name for name, each in severities.items() if np.allclose(each, worst, rtol=ALIKE, atol=0)]
    if len(which) > 1:
        return f"No motion governs: {', '.join(which)} have the same effect."
    share, median, itself = worst
    if share:
        why = f"{percent(share)} of its neighbours overturn"
    elif median:
        why = f"the median peak of its neighbours is {median:.3g} {over}"
    else:
        why = "it overturns" if np.isinf(itself) else f"it reaches {itself:.3g} {over}"
    return f"{which[0]} governs: {why}."


def follow(
    models: list[Model], motions: list[GroundMotion | None], runs: Runs, *, release: Reals | None = None, **how: object
) -> Outcomes:
    """`respond_many`, to the final peaks; a motion that cannot be followed is an error."""
    found = respond_many(models, motions, runs, release=release, only_peaks=True, **how)  # type: ignore[arg-type]
    if found.failed.any():
        k = int(found.failed.argmax())
        raise SolverError(f"{models[0].structure}: the motion scaled by {runs.scale[k]:.6g} could not be simulated")
    return found


def can_lift(model: Model, motion: GroundMotion, factor: float) -> bool:
    """Whether so many times a motion may lift a structure; with a vertical component it always may."""
    least = least_uplift(model, motion)
    return motion.vertical is not None or (least is not None and factor >= least)


def least_uplift(model: Model, motion: GroundMotion) -> float | None:
    """The least positive factor on a motion that lifts a structure, its vertical component apart; None if none does."""
    pushes = (
        (-s * motion.acceleration).max() / (model.gravity * lam)
        for s, lam in zip(Direction, model.lambda_, strict=True)
    )
    push = float(max(pushes))
    return 1 / push if push > 0 else None


def _share(share: float) -> str:
    if share in (0, 1):
        return "all overturn the structure" if share else "none overturns the structure"
    return f"{percent(share)} overturn the structure"

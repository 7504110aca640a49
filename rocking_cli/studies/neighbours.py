"""The conditions of a run, and its neighbours: rocking near overturning is fractal, so that one history is one sample.

Two nearly identical boulders on one shake table overturned together in only 88 of 100 tests. So a history is judged
together with its neighbours: the same motion a little stronger or weaker, with a little more or less restitution.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import pi
from statistics import NormalDist
from typing import NamedTuple, Self

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.core import Direction
from rocking_cli.dynamics.batch import Runs
from rocking_cli.dynamics.model import MODELS, Model, ModelName
from rocking_cli.dynamics.outcome import Outcomes
from rocking_cli.errors import InputError, Problem, SolverError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.names import MAX_NEIGHBOURS, RTOL, TAIL_SECONDS, peaks_over
from rocking_cli.short_repr import short_repr
from rocking_cli.structure import Structure
from rocking_cli.studies.engines import EXACT, Engine, EngineName, engine_of
from rocking_cli.units import UnitError, read, split

FRACTILES = (0.16, 0.50, 0.84)
MIN_AGREEMENT = 0.9  # share of neighbours with the outcome of the history; below it the outcome is sensitive
LEAST_ETA = 1e-3  # lower restitutions are raised to it, as an impact leaves some motion
SEED = 1963
STANDARD_NORMAL = NormalDist()
MIN_PROBABILITY = 1e-300  # replaces 0, which has no normal quantile
TILT_EXAMPLE = "give a fraction of phi_cr such as 0.5, or an angle such as 0.05rad"


class Draws(NamedTuple):
    """Random factors that turn a time history into its neighbours, one entry for each neighbour.

    Parameters
    ----------
    amplitude : ndarray, shape (n,)
        Factor on the ground motion.
    slender : ndarray, shape (n,)
        Factor on the slenderness, of which only the part that is due to weight scatters. A neighbour with a factor of
        zero or less overturns at rest.
    eta : ndarray, shape (n, 2)
        Coefficients of restitution in both directions.
    """

    amplitude: Reals  # factor on the motion
    slender: Reals  # factor on the part of the slenderness due to weight; at or below zero, overturned
    eta: Reals  # restitution of both directions, shape (n, 2)


@dataclass(frozen=True)
class Neighbourhood:
    """Number of neighbours of a motion, and the distributions from which they are drawn.

    Parameters
    ----------
    count : int
        Number of neighbours; 0 for none.
    amplitude : float
        Standard deviation of ln amplitude of the motion.
    restitution : float, optional
        Standard deviation of the coefficient of restitution; by default that of the structure.
    slenderness : float, optional
        Standard deviation of ln slenderness; by default that of the structure.

    Raises
    ------
    InputError
        If a number is out of range.

    Notes
    -----
    Amplitude and slenderness are lognormal. The restitution is normal, truncated at the value with which an impact
    keeps all energy; if it were clipped to that value instead, a third of all neighbours would never lose energy. With
    these deviations, computed shares agree with those observed in shake-table tests of two boulders, see
    docs/how_far_to_trust_it.md.
    """

    count: int = 200
    amplitude: float = 0.04
    restitution: float | None = None
    slenderness: float | None = None

    def __post_init__(self) -> None:
        if not 0 <= self.count <= MAX_NEIGHBOURS:
            raise InputError(Problem(f"must be from 0 to {MAX_NEIGHBOURS}, got {self.count}", field="neighbours"))
        for key in ("amplitude", "restitution", "slenderness"):
            value = getattr(self, key)
            if value is not None and not 0 <= value < 1:
                raise InputError(Problem(f"must be from 0 to below 1, got {value:g}", field=f"{key}_deviation"))

    def of(self, model: Model) -> Neighbourhood:
        """Return these neighbours with the standard deviations of a structure where none are given."""
        restitution, slenderness = model.scatter
        return replace(
            self,
            restitution=restitution if self.restitution is None else self.restitution,
            slenderness=slenderness if self.slenderness is None else self.slenderness,
        )

    def uniform(self) -> tuple[Reals, Reals, Reals]:
        """Return the uniform numbers of amplitude, slenderness and restitution by which neighbours are drawn."""
        # A Latin hypercube, with less scatter than random numbers.
        random = np.random.default_rng(SEED)
        amplitude, one, other = (np.arange(self.count) + random.random((3, self.count))) / max(self.count, 1)
        restitution, slenderness = random.permutation(one), random.permutation(other)
        return amplitude, slenderness, restitution

    def drawn(self, model: Model) -> Draws:
        """Draw the neighbours of a model."""
        settled = self.of(model)
        assert settled.restitution is not None and settled.slenderness is not None
        amplitude, slenderness, restitution = self.uniform()
        wide = np.exp(settled.slenderness * _normal(slenderness))
        etas = [
            _below(restitution, eta, settled.restitution, most)
            for eta, most in zip(model.eta, model.most_eta, strict=True)
        ]
        return Draws(
            np.exp(self.amplitude * _normal(amplitude)), 1 + model.weight_share * (wide - 1), np.stack(etas, axis=-1)
        )


def _normal(uniform: Reals) -> Reals:
    """Convert uniform numbers to standard normal ones."""
    return np.array([STANDARD_NORMAL.inv_cdf(max(u, MIN_PROBABILITY)) for u in uniform.tolist()])


def _below(uniform: Reals, mean: float, deviation: float, upper: float) -> Reals:
    """Convert uniform numbers to normal ones that are at most `upper` and at least the least restitution."""
    if deviation == 0:
        return np.full(uniform.size, mean)
    share = STANDARD_NORMAL.cdf((upper - mean) / deviation)
    return np.clip(mean + deviation * _normal(uniform * share), LEAST_ETA, upper)


@short_repr
@dataclass(frozen=True)
class Neighbours:
    """Outcomes of the neighbours of a motion.

    Parameters
    ----------
    around : Neighbourhood
        How the neighbours were drawn.
    model : str
        The model that was simulated.
    overturned : float
        The share that overturns.
    peak_ratio : tuple of float
        Peak rotation over the critical one that 16, 50 and 84 % of them do not exceed; infinite if it belongs to a
        neighbour that overturns or has an unknown outcome.
    as_itself : float
        The share that has the outcome of the motion itself: overturned, not overturned, or unknown.
    lifted : bool
        Whether any of them could uplift the structure.
    over : str
        Reference of the peaks: "phi_cr", or "of the limit" if a direction has no critical rotation.
    unknown : float or None
        The share of unknown outcome, because joints open or slide that the model keeps closed; None if the joints are
        not known, so that nothing was checked.
    slides : float
        The share that slides and is known not to overturn.
    slips : ndarray, shape (n,)
        Largest slip of each of them [m], 0 if it does not only slide; infinite if it overturns or has an unknown
        outcome.
    rotations : ndarray, shape (n, 2)
        Peak rotation of each of them in the positive and in the negative direction [rad]; infinite if it overturns or
        has an unknown outcome.
    """

    around: Neighbourhood
    model: ModelName
    overturned: float
    peak_ratio: tuple[float, float, float]
    as_itself: float
    lifted: bool = True
    over: str = "phi_cr"
    unknown: float | None = None
    slides: float = 0.0
    slips: Reals = field(default_factory=lambda: np.zeros(0), compare=False, repr=False)
    rotations: Reals = field(default_factory=lambda: np.zeros((0, 2)), compare=False, repr=False)

    @property
    def sensitive(self) -> bool | None:
        """Whether the outcome of the motion is partly chance: under 90 % share it. None if not known."""
        unknown = self.unknown or 0.0
        if unknown >= MIN_AGREEMENT or self.as_itself < MIN_AGREEMENT <= self.as_itself + unknown:
            return None
        return self.as_itself < MIN_AGREEMENT

    @property
    def slip(self) -> Sequence[float]:
        """The 16, 50 and 84 % of the largest slips [m]; infinite where neighbours overturn or are unknown."""
        return [float(slip) for slip in np.quantile(self.slips, FRACTILES, method="inverted_cdf")]

    @property
    def half_overturn(self) -> bool:
        """Whether more than half are known to overturn, so that there is no median peak."""
        return self.overturned > 0.5

    @property
    def at_most(self) -> float:
        """The share that overturns if all neighbours of unknown outcome do."""
        return self.overturned + (self.unknown or 0.0)


def neighbours(
    conditions: Conditions,
    motion: GroundMotion | None,
    *,
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
) -> Neighbours:
    """Simulate the neighbours of a motion.

    Parameters
    ----------
    conditions : Conditions
        The structure, the conditions of the motion itself, and how to draw the neighbours.
    motion : GroundMotion or None
        The motion as in the history, scaled and reversed; None for a release alone.
    threads, progress
        See `respond_many`.

    Raises
    ------
    InputError
        If the number of neighbours is 0.
    SolverError
        If one of them cannot be followed.
    """
    model, engine, release = conditions.model, conditions.by, conditions.release
    around = conditions.around.of(model)
    if not around.count:
        raise InputError(Problem("must be at least 1", field="neighbours"))
    draws = around.drawn(model)
    unchecked = model.joints is None and engine.name != "blocks"
    able = draws.slender > 0
    largest_factor = float((draws.amplitude[able] / draws.slender[able]).max(initial=1.0))
    rests = engine.name != "blocks"  # of free blocks, other joints may open first
    rests &= model.sliding is None and release is None and bool(able.all())
    if rests and motion is not None and not can_lift(model, motion, largest_factor):
        unknown = None if unchecked else 0.0
        still = np.zeros((around.count, 2))
        none = (0.0, 0.0, 0.0)
        return Neighbours(
            around, model.name, 0.0, none, 1.0, lifted=False, unknown=unknown, slips=still[:, 0], rotations=still
        )
    itself = Draws(np.ones(1), np.ones(1), np.full((1, 2), np.nan))  # NaN keeps the restitution of the model
    all_draws = Draws(*(np.concatenate(pair) for pair in zip(itself, draws, strict=True)))
    tilts = None
    if release is not None:
        slender = np.where(all_draws.slender > 0, all_draws.slender, 1.0)
        tilts = release / slender if conditions.release_is_angle else release
    outcomes = simulate_neighbours(
        model, motion, all_draws, release=tilts, rtol=conditions.rtol, engine=engine, threads=threads, progress=progress
    )
    outcome = np.where(outcomes.unknown, 2, outcomes.fell)
    peaks = np.where(outcome[1:] > 0, np.inf, outcomes.peak_ratio[1:])
    # Quantiles are values of the sample, as interpolation with infinity has no meaning.
    low, middle, high = (float(peak) for peak in np.quantile(peaks, FRACTILES, method="inverted_cdf"))
    slips = np.where(outcome[1:] > 0, np.inf, outcomes.slip[1:])
    rotations = np.stack([outcomes.peak_positive[1:], outcomes.peak_negative[1:]], axis=-1)
    rotations[outcome[1:] > 0] = np.inf
    return Neighbours(
        around,
        model.name,
        float(outcomes.fell[1:].mean()),
        (low, middle, high),
        float((outcome[1:] == outcome[0]).mean()),
        over=peaks_over(model.ends_at_limit),
        unknown=None if unchecked and not outcomes.unknown.any() else float(outcomes.unknown[1:].mean()),
        slides=float(((slips > 0) & (slips < np.inf)).mean()),
        slips=slips,
        rotations=rotations,
    )


def simulate_neighbours(
    model: Model,
    motion: GroundMotion | None,
    draws: Draws,
    *,
    scale: Reals | float = 1.0,
    polarity: int = 1,
    release: Reals | float | None = None,
    engine: Engine = EXACT,
    **how: object,
) -> Outcomes:
    """Simulate neighbours of a motion until their final peaks are known.

    Parameters
    ----------
    model, motion
        See `neighbours`.
    draws : Draws
        The neighbours.
    scale : float or ndarray, shape (n,)
        Factor on the motion of each neighbour, in addition to its drawn amplitude.
    polarity : int
        1, or -1 to reverse the motion.
    release : float or ndarray, shape (n,), optional
        Start at rest, tilted by this fraction of the critical rotation.
    engine : Engine
        Who simulates them.
    **how
        See `respond_many`.

    Raises
    ------
    SolverError
        If one of them cannot be followed.
    """
    stands = draws.slender > 0
    runs = Runs.of(
        0,
        0,
        scale=scale * draws.amplitude,
        polarity=polarity,
        eta=draws.eta,
        slender=np.where(stands, draws.slender, 1.0),
    )
    outcomes = engine.outcomes([model], [motion], runs, release=release, only_peaks=True, **how)  # type: ignore[arg-type]
    if outcomes.failed.any():
        k = int(outcomes.failed.argmax())
        raise SolverError(f"{model.structure}: the motion scaled by {runs.scale[k]:.6g} could not be simulated")
    if stands.all():
        return outcomes
    return replace(
        outcomes,
        fell_to=np.where(stands | outcomes.fell, outcomes.fell_to, 1),  # the direction 1 is a placeholder
        unknown=outcomes.unknown & stands,
        peak_ratio=np.where(stands, outcomes.peak_ratio, np.nan),
        slip=outcomes.slip * stands,
    )


def can_lift(model: Model, motion: GroundMotion, factor: float) -> bool:
    """Return whether a motion times a factor may uplift a structure; always True with a vertical component."""
    least = least_uplift(model, motion)
    return motion.vertical is not None or (least is not None and factor >= least)


def least_uplift(model: Model, motion: GroundMotion) -> float | None:
    """Return the least positive factor on a motion that uplifts a structure (vertical component ignored), or None."""
    if model.sliding is not None and model.sliding.holds(np.ones(1), *np.zeros((2, 1)))[0]:
        return None  # it only slides
    pushes = (
        (-s * motion.acceleration).max() / (model.gravity * lam)
        for s, lam in zip(Direction, model.lambda_, strict=True)
    )
    push = float(max(pushes))
    return 1 / push if push > 0 else None


@short_repr
@dataclass(frozen=True, eq=False)
class Conditions:
    """All on which a run depends, besides its ground motion.

    Parameters
    ----------
    structure : Structure
        The structure as the run has it: restitution and opening of its joints are those given for the run.
    models : sequence of {"nonlinear", "linear1", "linear2"}
        The models that are simulated.
    signs : sequence of int
        The polarities: 1, -1 or both.
    release : float or None
        Fraction of phi_cr at which the structure starts at rest; None: phi = 0.
    release_is_angle : bool
        Whether the release was given as an angle, which stays the same if the slenderness of neighbours varies.
    tail : float
        Duration of the history after the end of the record [s].
    rtol : float
        Relative local error of a step.
    with_pulse : str or None
        Shape of the pulse under which the response is computed as well, or "best"; None for no pulse.
    around : Neighbourhood
        The neighbours of every motion; a count of 0 for none.
    engine : {"exact", "blocks", "auto"}
        Who simulates the motions: one degree of freedom, free blocks, or these where the former tells no outcome. Under
        a single motion the former is simulated beside free blocks, as far as it can be.
    goes_on : bool
        Whether free blocks go on unasked where the outcome of a single motion is unknown, within `MOST_UNASKED_STEPS`.
    """

    structure: Structure
    models: Sequence[ModelName] = MODELS
    signs: Sequence[int] = (1,)
    release: float | None = None
    release_is_angle: bool = False
    tail: float = TAIL_SECONDS
    rtol: float = RTOL
    with_pulse: str | None = None
    around: Neighbourhood = field(default_factory=Neighbourhood)
    engine: EngineName = "exact"
    goes_on: bool = False

    @cached_property
    def by(self) -> Engine:
        """Who simulates the motions. Raises `InputError` as `engine_of`."""
        return engine_of(self.engine, [self.structure.mechanism])

    @property
    def model(self) -> Model:
        """The model whose neighbours are simulated: the structure itself, or else the first of its blocks."""
        return self.structure.model("nonlinear" if "nonlinear" in self.models else self.models[0])

    @property
    def polarity(self) -> str:
        """The polarities as users give them: "1", "-1" or "both"."""
        return "both" if len(self.signs) > 1 else f"{self.signs[0]}"


@dataclass(frozen=True)
class Release:
    """A tilt at rest; negative tilts are anticlockwise.

    Parameters
    ----------
    text : str
        The tilt as it was written.
    size : float
        Fraction of the critical rotation, or angle [rad].
    is_angle : bool
        Whether `size` is an angle.
    """

    text: str
    size: float
    is_angle: bool

    def __str__(self) -> str:
        return self.text

    @classmethod
    def of(cls, tilt: float | str) -> Self:
        """Read a fraction between -1 and 1, or a text such as `0.5`, `0.05rad` or `3 deg`. Raises `InputError`."""
        text = tilt.strip() if isinstance(tilt, str) else f"{tilt:g}"
        parts = split(tilt) if isinstance(tilt, str) else (repr(float(tilt)), "")
        if parts is None:
            raise InputError(Problem(f"{text!r} is not a valid tilt: {TILT_EXAMPLE}", field="release"))
        if not parts[1]:
            fraction = float(parts[0])
            if not 0 < abs(fraction) < 1:
                message = f"must be a fraction of phi_cr between 0 and 1 (or 0 and -1), got {text}"
                raise InputError(Problem(message, field="release"))
            return cls(text, fraction, is_angle=False)
        try:
            angle = read(text, "rad")
        except UnitError as error:
            raise InputError(Problem(error.message, field="release", hint=TILT_EXAMPLE)) from None
        if not 0 < abs(angle) < pi:
            raise InputError(Problem(f"{text!r} is not an angle between 0 and half a turn", field="release"))
        return cls(text, angle, is_angle=True)

    def ratio(self, structure: Structure) -> float:
        """Return the tilt as a fraction of phi_cr of a structure, or of the kinematic limit if there is no phi_cr.

        Raises
        ------
        InputError
            If the structure does not rock in this direction, the tilt exceeds this rotation, or a fraction has no
            reference.
        """
        direction = Direction.NEGATIVE if self.size < 0 else Direction.POSITIVE
        if direction not in structure.mechanism.directions:
            side = structure.mechanism.one_sided
            raise InputError(Problem(f"it rocks in the {side} direction only, got {self.text}", field="release"))
        statics = structure.statics[0 if direction > 0 else 1]
        if not self.is_angle:
            if statics.phi_cr is None:
                why = "a fraction needs a critical rotation, and this direction has none"
                raise InputError(Problem(f"{self.text}: {why}", field="release", hint="give an angle, such as 0.05rad"))
            return self.size
        if not abs(self.size) < statics.reference:
            end = "its kinematic limit" if statics.phi_cr is None else "its critical rotation"
            raise InputError(Problem(f"{self.text} is beyond {end}, {statics.reference:.4g} rad", field="release"))
        return self.size / statics.reference

"""Rocking response spectra: peak rotation and angular velocity under ground motions over the size of a structure."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import cos, exp, inf, isclose, log, nan, pi, sin

import numpy as np
from pydantic import ValidationError

from rocking_cli.arrays import Bools, Integers, Reals
from rocking_cli.core import Direction, Equivalence, EquivalentBlock, Mechanism, equivalent_block
from rocking_cli.core.registry import Registry
from rocking_cli.core.structure_fields import Strength
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.model import Model, ModelName
from rocking_cli.dynamics.outcome import Outcomes
from rocking_cli.errors import InputError, MechanismError, Problem, named, of_structure
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.io.field_problems import of_arguments
from rocking_cli.names import MIN_MOTIONS, OPENING
from rocking_cli.short_repr import short_repr
from rocking_cli.structure import Structure
from rocking_cli.studies.fit import fractile
from rocking_cli.studies.under_pulses import Progress, PulsedModel, parse_shape, pulsed_model, uplift

Respond = Callable[[Sequence[Model], Sequence[GroundMotion], Runs], Outcomes]
"""Simulates histories, as `respond_many`."""
SIZE_TOLERANCE = 1e-9  # relative difference below which a size is that of the structure as given
MAX_SCALE = 10.0  # default largest scale of a structure; the least is its inverse
BLOCK_PERIODS = (1.0, 10.0)  # range of 2 pi/p of blocks [s]: R from 0.19 to 19 m
SIZES_PER_CALL = 50  # the tables of all of them are in memory at once


@short_repr
@dataclass(frozen=True, eq=False)
class SpectrumShape:
    """The structure of a spectrum, or a block of given slenderness, to be scaled to other sizes.

    Parameters
    ----------
    structure : PulsedModel
        The model at scale 1. Its direction is the one with the smaller uplift acceleration; sizes are expressed as 2
        pi/p of this direction.
    slenderness : float, optional
        Slenderness alpha [rad] of a block whose R is 1 m at scale 1, so that its scale is R in m; None for a given
        structure.
    own : Sizes, optional
        The structures of other sizes, if loads that do not scale make them rock differently; None if shape alone
        decides.
    hung : bool
        Whether there are loads or ties, of which only the positions scale with the structure.
    bodies : int
        Number of bodies of the structure.
    caution : str
        A caution about the lambda of the structure; empty if there is none.
    height : float, optional
        Height of the structure at scale 1 [m]; None if the shape of a body is not known.
    """

    structure: PulsedModel
    slenderness: float | None = None
    own: Sizes | None = None
    hung: bool = False
    bodies: int = 1
    caution: str = ""
    height: float | None = None

    @property
    def period(self) -> float:
        """2 pi/p at scale 1 [s]."""
        return 2 * pi / self.structure.p

    def scales(self, periods: Reals) -> Reals:
        """Return the scales at which 2 pi/p has given values [s].

        If the shape alone decides how the structure rocks, the scale is proportional to 1/p^2.
        """
        if self.own is not None:
            return np.array([self.own.scale(period) for period in periods.tolist()])
        return np.square(periods / self.period)

    def periods(self, scales: Reals) -> Reals:
        """Return 2 pi/p at some scales [s]."""
        if self.own is not None:
            return np.array([self.own.period(scale) for scale in scales.tolist()])
        return self.period * np.sqrt(scales)


def radius(periods: Reals, gravity: float) -> Reals:
    """Return R of rectangular blocks, half of their diagonal [m], from their 2 pi/p [s]: p^2 = 3 g/(4 R)."""
    return 3 * gravity / 4 * (periods / (2 * pi)) ** 2


def shape_of(structure: Structure, model: ModelName) -> SpectrumShape:
    """Prepare a structure for scaling to other sizes.

    Parameters
    ----------
    structure : Structure
        The structure.
    model : {"nonlinear", "linear1", "linear2"}
        The equation of motion.

    Raises
    ------
    InputError, MechanismError
        If the structure does not stand, or its restitution is not known.
    """
    # A full sine is equal in both directions, so that the one with the smaller uplift acceleration uplifts first.
    pulsed = pulsed_model(structure, model, parse_shape("sine"))
    mechanism = structure.mechanism
    sizes = Sizes(mechanism, model, pulsed.direction, structure.opening)
    rebuilt = None if sizes.are_alike() else sizes
    return SpectrumShape(
        pulsed,
        own=rebuilt,
        hung=bool(mechanism.attached),
        bodies=len(mechanism.bodies()),
        caution=mechanism.own_caution(),
        height=_height(mechanism),
    )


def _height(mechanism: Mechanism) -> float | None:
    """Return the height of a structure at rest [m]; None if the shape of a body is not known."""
    carrier = mechanism.carrier
    if set(carrier.outlines) < set(carrier.bodies):
        return None
    return float(np.ptp([point.imag for each in carrier.outlines.values() for line in each for point in line]))


def blocks_of(slenderness: float, model: ModelName, restitution: float | None = None) -> SpectrumShape:
    """Return rectangular blocks of one slenderness alpha = atan(b/h) [rad] and any size. Raises as `shape_of`."""
    if not 0 < slenderness < pi / 2:
        raise InputError(
            Problem(
                f"a slenderness is an angle in rad between 0 and pi/2, alpha = atan(b/h), got {slenderness:g}",
                hint="a block 0.7 m wide and 2.8 m high has alpha = atan(0.7/2.8) = 0.245",
            )
        )
    name = f"alpha = {slenderness:g}"
    sides = {"width": 2 * sin(slenderness), "height": 2 * cos(slenderness)}  # R = 1 m
    block = Registry()["block"].model_validate({"name": name, **sides})
    kinematic_eta = block.eta(Direction.POSITIVE)
    if restitution is None and kinematic_eta <= 0:
        message = (
            f"blocks of {name}: the kinematics give {kinematic_eta:.3g} for an impact: too stocky to rock the other way"
        )
        raise InputError(
            Problem(message, hint=f"give a measured {named('restitution')} in (0, 1], or a smaller slenderness")
        )
    return SpectrumShape(shape_of(Structure(block, restitution=restitution), model).structure, slenderness)


@short_repr
@dataclass(frozen=True, eq=False)
class Spectrum:
    """Responses of a shape at several sizes to ground motions.

    Parameters
    ----------
    shape : SpectrumShape
        The shape.
    scales : ndarray, shape (n,)
        Factors on every length, increasing; 1 is among them for a given structure.
    peak_ratio : ndarray, shape (m, n)
        Peak rotation over the critical one under each of m motions: 0 without uplift, inf if the structure overturns or
        the outcome is unknown, NaN if the motion could not be simulated.
    peak_rate : ndarray, shape (m, n)
        Peak angular velocity under each motion [rad/s]: 0, inf and NaN as for `peak_ratio`.
    lower_bound : ndarray, shape (m, n), or nan
        Lower bound of the peak ratio if the outcome is unknown because a joint opens or slides that the model keeps
        closed; NaN if the outcome is known.
    """

    shape: SpectrumShape
    scales: Reals
    peak_ratio: Reals
    peak_rate: Reals
    lower_bound: Reals | float = nan

    @property
    def unknown(self) -> Bools:
        """Mask of unknown outcomes, shape (m, n)."""
        return np.broadcast_to(~np.isnan(self.lower_bound), self.peak_ratio.shape)

    @property
    def checked(self) -> bool:
        """Whether outcomes are checked against the joints of the structure."""
        return self.shape.structure.checked

    @property
    def periods(self) -> Reals:
        """2 pi/p of the sizes, shape (n,) [s]."""
        return self.shape.periods(self.scales)

    @property
    def radii(self) -> Reals:
        """R of the rectangular block with the same p at each size, half of its diagonal, shape (n,) [m]."""
        return radius(self.periods, self.shape.structure.gravity)

    @property
    def uplifts(self) -> Reals:
        """Uplift acceleration over g at each size, shape (n,), in the direction with the smaller one at scale 1."""
        sizes, model = self.shape.own, self.shape.structure.model.name
        if sizes is None:
            return np.full(self.scales.size, self.shape.structure.lambda_)
        return np.array([uplift(sizes.block(scale), model) for scale in self.scales.tolist()])

    @property
    def given(self) -> int | None:
        """Index of the structure as given among the sizes; None for blocks of a given slenderness."""
        return None if self.shape.slenderness is not None else int(np.flatnonzero(self.scales == 1.0)[0])

    @property
    def followed(self) -> Integers:
        """Number of motions that were simulated at each size, shape (n,)."""
        counts: Integers = np.sum(~np.isnan(self.peak_ratio), axis=0)
        return counts

    @property
    def overturned(self) -> Integers:
        """Number of motions that are known to overturn the structure at each size, shape (n,)."""
        counts: Integers = np.sum(np.isinf(self.peak_ratio) & ~self.unknown, axis=0)
        return counts

    @property
    def doubtful(self) -> Integers:
        """Number of motions with an unknown outcome at each size, shape (n,)."""
        counts: Integers = np.sum(self.unknown, axis=0)
        return counts

    @property
    def share(self) -> Reals:
        """Share of the simulated motions that overturn the structure at each size, shape (n,); NaN without motions."""
        return self._share(self.overturned)

    @property
    def share_at_most(self) -> Reals:
        """Share that overturns if all motions of unknown outcome do, shape (n,); NaN without motions."""
        return self._share(self.overturned + self.doubtful)

    def _share(self, counts: Integers) -> Reals:
        return np.where(self.followed > 0, counts / np.maximum(self.followed, 1), np.nan)

    @property
    def rate_over_p(self) -> Reals:
        """Peak angular velocity over p, the ordinate of its spectrum, shape (m, n) [rad]."""
        return self.peak_rate * self.periods / (2 * pi)

    def fractile(self, q: float, of: Reals | None = None) -> Reals:
        """Return the q-fractile of the peak ratio, or `of` other peaks; unknown outcomes count as overturning.

        It is NaN at sizes with too few motions, except for the median.
        """
        peaks = fractile(self.peak_ratio if of is None else of, q)
        return peaks if q == 0.5 else np.where(self.followed < MIN_MOTIONS, np.nan, peaks)

    def fractile_overturns(self, q: float) -> Bools:
        """Return whether the q-fractile overturns even if no unknown outcome does, shape (n,)."""
        return np.isinf(fractile(np.where(self.unknown, self.lower_bound, self.peak_ratio), q))


def spectra(
    shapes: Sequence[SpectrumShape],
    periods: Reals,
    motions: Sequence[GroundMotion],
    *,
    polarities: Sequence[int] = (1,),
    threads: int | None = None,
    progress: Progress | None = None,
) -> list[Spectrum]:
    """Simulate every size of several shapes under ground motions.

    Parameters
    ----------
    shapes : sequence of SpectrumShape
        See `shape_of` and `blocks_of`.
    periods : ndarray, shape (n,)
        Sizes, as 2 pi/p [s].
    motions : sequence of GroundMotion
        The ground motions.
    polarities : sequence of int
        The polarities, 1, -1 or both; of both, the worse governs for each motion.
    threads : int, optional
        Number of threads; by default one for each processor.
    progress : callable, optional
        Called with the number of histories done since the last call; `count_histories(...)` is their total.

    Returns
    -------
    list of Spectrum
        One for each shape. A given structure is also simulated at scale 1, whatever the sizes.

    Notes
    -----
    Every length of the structure is multiplied by the scale: slenderness, uplift, critical rotation and restitution
    stay the same, and p is inverse to the square root of the scale. If they change, because masses or loads are given
    that do not scale, every size is built and simulated as a structure of its own. Makris and Konstantinidis (2003)
    plot the spectrum of a block of given slenderness against 2 pi/p.
    """
    if not motions:
        raise InputError("no ground motion was given")
    run = partial(respond_many, threads=threads, only_peaks=True, progress=progress)
    results = []
    for shape in shapes:
        scales, signs = _scales(shape, periods), _signs(shape, polarities)
        follow = _of_one_shape if shape.own is None else _each_its_own
        results.append(Spectrum(shape, scales, *_worst(follow(shape, scales, motions, signs, run))))
    return results


def _worst(found: Outcomes) -> tuple[Reals, Reals, Reals]:
    """Return peak ratios and rates, each of the worse polarity (axis 1 of the outcomes), and bounds of unknown ones."""
    peak, rate = (
        np.where(found.failed, nan, np.where(found.fell, inf, np.where(found.unknown, 0.0, each))).max(axis=1)
        for each in (found.peak_ratio, found.peak_rate)
    )
    unknown = found.unknown.any(axis=1) & np.isfinite(peak)
    least = np.where(found.unknown, found.lower_bound, found.peak_ratio)
    bound = np.max(least, axis=1, initial=0.0, where=~(found.fell | found.failed))
    return np.where(unknown, inf, peak), np.where(unknown, inf, rate), np.where(unknown, bound, nan)


def _of_one_shape(
    shape: SpectrumShape, scales: Reals, motions: Sequence[GroundMotion], signs: Sequence[int], run: Respond
) -> Outcomes:
    """Simulate every motion, polarity and scale with one model.

    This is possible if sizes differ only in their time scale, because the kernel scales the model to each size.
    """
    runs = Runs.every(1, len(motions), polarities=signs, sizes=scales.tolist())
    outcomes = run([shape.structure.model], motions, runs)
    return outcomes.by_field(lambda values: values.reshape(-1, len(signs), scales.size))


def _each_its_own(
    shape: SpectrumShape, scales: Reals, motions: Sequence[GroundMotion], signs: Sequence[int], run: Respond
) -> Outcomes:
    """Simulate every motion, polarity and scale, with a model for every scale."""
    assert shape.own is not None
    parts = []
    for start in range(0, scales.size, SIZES_PER_CALL):
        models = [shape.own.build(scale) for scale in scales[start : start + SIZES_PER_CALL].tolist()]
        runs = Runs.every(len(models), len(motions), polarities=signs)
        parts.append((len(models), run(models, motions, runs)))
    placed = [
        outcomes.by_field(lambda values, many=many: np.moveaxis(values.reshape(many, -1, len(signs)), 0, -1))
        for many, outcomes in parts
    ]
    return placed[0].by_field(lambda *values: np.concatenate(values, axis=-1), *placed[1:])


def count_histories(shapes: Sequence[SpectrumShape], periods: Reals, motions: int, polarities: Sequence[int]) -> int:
    """Return the number of histories that `spectra` simulates."""
    return motions * sum(_scales(each, periods).size * len(_signs(each, polarities)) for each in shapes)


def _scales(shape: SpectrumShape, periods: Reals) -> Reals:
    scales = np.sort(shape.scales(periods))
    if shape.slenderness is not None:
        return scales
    # Scales found by a search are less precise.
    tolerance = SIZE_TOLERANCE if shape.own is None else 10 * SIZE_TOLERANCE
    return np.union1d([scale for scale in scales if not isclose(scale, 1.0, rel_tol=tolerance)], 1.0)


def _signs(shape: SpectrumShape, polarities: Sequence[int]) -> Sequence[int]:
    # A reversed motion has the same effect on a symmetric structure.
    return polarities[:1] if shape.structure.symmetric else polarities


SHAPE_TOLERANCE = 1e-7  # relative error, by solvers and rounding, of quantities that depend on shape alone
# Scales at which quantities of shape are compared: in each row, the first that can be built.
CHECKED_SCALES = ((0.1, 0.5, 0.9), (10.0, 2.0, 1.1))
PERIOD_TOLERANCE = 1e-10  # relative error of 2 pi/p of a size that is searched for
MAX_SEARCH_STEPS = 50


class Sizes:
    """The versions of a structure with all lengths multiplied by a scale.

    Parameters
    ----------
    mechanism : Mechanism
        The structure at scale 1, with the restitution that is used.
    model : {"nonlinear", "linear1", "linear2"}
        The equation of motion.
    direction : Direction
        The direction whose frequency parameter p expresses the size: users give sizes as 2 pi/p.
    opening : float
        Largest opening of a joint up to which a history is valid, over D_cr.
    """

    def __init__(
        self, mechanism: Mechanism, model: ModelName, direction: Direction, opening: float = OPENING
    ) -> None:  # fmt: skip
        self.mechanism, self.model, self.direction, self.opening = mechanism, model, direction, opening
        self._known: dict[float, Equivalence] = {}

    def at(self, scale: float) -> Mechanism:
        """Return the structure with every length multiplied by a scale. Raises `InputError` if it cannot be built."""
        try:
            return self.mechanism.enlarged(scale)
        except ValidationError as error:
            first, *_ = of_arguments(type(self.mechanism), error.errors(include_url=False), self.mechanism.mechanism)
            message = f"{self._named(scale)} cannot be built: {replace(first, hint=None)}"
            raise InputError(Problem(message, hint="choose other sizes")) from None

    def equivalence(self, scale: float) -> Equivalence:
        """Return the equivalent blocks at a scale. Raises as `at`, or `MechanismError` if it does not stand."""
        if scale not in self._known:
            try:
                self._known[scale] = equivalent_block(self.at(scale))
            except MechanismError as error:
                raise of_structure(error, self._named(scale)) from error
        return self._known[scale]

    def block(self, scale: float) -> EquivalentBlock:
        """Return the equivalent block at a scale, in the direction that expresses sizes. Raises as `equivalence`."""
        return self.equivalence(scale)[self.direction]

    def build(self, scale: float) -> Model:
        """Return the model at a scale. Raises as `equivalence`, or if the restitution is not known."""
        mechanism = self.at(scale)
        named = mechanism.model_copy(update={"name": self._named(scale)})
        return Structure(named, opening=self.opening).model(self.model)

    def period(self, scale: float) -> float:
        """Return 2 pi/p at a scale [s]."""
        return 2 * pi / self.block(scale).p

    def scale(self, period: float) -> float:
        """Return the scale at which 2 pi/p has a value [s]. Raises as `equivalence`, or if there is none."""
        # Secant search in logarithms, where 2 pi/p has a slope of about one half.
        one, off = 0.0, log(period / self.period(1.0))
        two = 2 * off
        for _ in range(MAX_SEARCH_STEPS):
            missing = log(period / self.period(exp(two)))
            if abs(missing) < PERIOD_TOLERANCE:
                return exp(two)
            slope = (off - missing) / (two - one) if two != one else 0.5
            one, off, two = two, missing, two + missing / (slope if 0.1 < slope < 2 else 0.5)
        message = f"{self.mechanism.name}: no size of it was found with 2 pi/p = {period:.4g} s"
        if self.mechanism.ties:
            hint = "its ties do not scale with it, so 2 pi/p need not increase with its size: choose other sizes"
            raise InputError(Problem(message, hint=hint))
        raise InputError(message)

    def are_alike(self) -> bool:
        """Return whether all sizes rock alike, in different time only: no load or mass is given that does not scale.

        A strength against which joints are checked also excludes this: the weight increases faster than the strength.
        """
        if self.model == "nonlinear" and isinstance(self.mechanism.strength, Strength):
            return False
        shape = _shape_of(self.equivalence(1.0), 1.0)
        for scales in CHECKED_SCALES:
            for scale in scales:
                try:
                    other = _shape_of(self.equivalence(scale), scale)
                except InputError:  # a field is out of bounds at this scale
                    continue
                except MechanismError:
                    return False
                if not all(isclose(a, b, rel_tol=SHAPE_TOLERANCE) for a, b in zip(shape, other, strict=True)):
                    return False
                break
        return True

    def _named(self, scale: float) -> str:
        return f"{self.mechanism.name or self.mechanism.mechanism} at scale {scale:.4g}"


def _shape_of(equivalence: Equivalence, scale: float) -> list[float]:
    """Return parameters that do not change with size if shape alone decides how a structure rocks."""
    return [
        value
        for block in (equivalence[direction] for direction in Direction)
        for value in (block.lambda_, block.phi_cr, block.lambda_lin, block.eta, block.p * scale**0.5)
    ]

"""A structure under pulses: the quantities that make pulses dimensionless, and the outcomes of many pulses."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from functools import partial
from math import isclose, pi

import numpy as np

from rocking_cli.arrays import Bools, Reals
from rocking_cli.core import Direction, Equivalence, EquivalentBlock
from rocking_cli.dynamics.batch import Runs
from rocking_cli.dynamics.exact_batch import exact_many
from rocking_cli.dynamics.model import Model, ModelName, linear_model
from rocking_cli.dynamics.outcome import Outcomes
from rocking_cli.errors import InputError, SolverError
from rocking_cli.excitation.pulses import COARSE_POINTS_PER_PERIOD, Pulse, parse_pulse
from rocking_cli.short_repr import short_repr
from rocking_cli.structure import Structure
from rocking_cli.studies.engines import EXACT, Engine

Progress = Callable[[int], None]
SAME_AMPLITUDE = 1e-9  # relative difference below which both directions uplift together


@short_repr
@dataclass(frozen=True, eq=False)
class PulsedModel:
    """A model of a structure, with the quantities that make pulses dimensionless.

    Parameters
    ----------
    name : str
        Name of the structure.
    model : Model
        Its equation of motion.
    equivalence : Equivalence
        Its equivalent blocks.
    direction : Direction
        The direction in which the weakest pulse uplifts; its p, lambda and eta make pulses dimensionless.
    restitution_source : str
        Where the restitution comes from, see `Structure.restitution_source`.
    engine : Engine
        Who simulates its nonlinear motions.
    """

    name: str
    model: Model
    equivalence: Equivalence
    direction: Direction
    restitution_source: str = "given"
    engine: Engine = EXACT

    @property
    def block(self) -> EquivalentBlock:
        """The equivalent block of `direction`."""
        return self.equivalence[self.direction]

    @property
    def p(self) -> float:
        """Frequency parameter [rad/s]."""
        return self.block.p

    @property
    def lambda_(self) -> float:
        """Uplift acceleration over g of the scaling: lambda_lin for `linear1`, otherwise lambda."""
        return uplift(self.block, self.model.name)

    @property
    def gravity(self) -> float:
        """Gravitational acceleration of the structure [m/s2]."""
        return self.model.gravity

    @property
    def eta(self) -> float:
        """Coefficient of restitution of an impact that ends motion in `direction`."""
        return self.block.eta

    @property
    def checked(self) -> bool:
        """Whether outcomes are checked against the joints; an equivalent block has none."""
        return self.model.is_linear or self.model.joints is not None

    @property
    def may_open(self) -> bool:
        """Whether outcomes may be unknown, as the structure has joints that could open or slide, or a bound."""
        joints = self.model.joints is not None and bool(self.model.joints.labels)
        return joints or self.model.bounds != (None, None)

    @property
    def symmetric(self) -> bool:
        """Whether both directions are equal, so that a reversed pulse has the same effect."""
        return self.equivalence.symmetric and self.model.one_sided is None

    @property
    def unit(self) -> float:
        """Amplitude of the pulse with a = 1, which only just uplifts the structure [m/s2]."""
        return self.lambda_ * self.gravity

    def period(self, omega: Reals) -> Reals:
        """Return pulse periods [s] from omega = omega_g/p, or omega from periods: each is 2 pi/p over the other."""
        return 2 * pi / (self.p * omega)


def parse_shape(text: str) -> Pulse:
    """Return a pulse of amplitude 1 m/s2 and period 1 s from the name and the further parameters of its shape.

    Raises
    ------
    InputError
        If the shape is unknown, or an amplitude or a period is given with it.
    """
    name, *further = text.split(":")
    if any(word.strip()[-1:].isalpha() and not word.strip().endswith("deg") for word in further):
        raise InputError(f"pulse '{text}': give only the shape, {name}: amplitude and period are set separately")
    return replace(parse_pulse(":".join([name, "1m/s2", "1s", *further])), amplitude=1.0, period=1.0)


def linear_block(eta: float) -> PulsedModel:
    """Return the dimensionless linear block, p = g = lambda = 1: pulses have amplitude a and period 2 pi/omega."""
    check_eta(eta)
    block = EquivalentBlock(**{**dict.fromkeys((each.name for each in fields(EquivalentBlock)), 1.0), "eta": eta})
    model = linear_model("linear block", "linear2", (block, block), 1.0)
    return PulsedModel(model.structure, model, Equivalence(block, block), Direction.NEGATIVE)


def check_eta(eta: float, argument: str = "restitution") -> None:
    """Raise `InputError` if a number is not a coefficient of restitution."""
    if not 0 < eta <= 1:
        raise InputError(f"`{argument}` must be in (0, 1], got {eta:g}")


def pulsed_model(structure: Structure, model: ModelName, shape: Pulse, polarities: Sequence[int] = (1,)) -> PulsedModel:
    """Prepare a structure for pulses.

    Parameters
    ----------
    structure : Structure
        The structure.
    model : {"nonlinear", "linear1", "linear2"}
        The equation of motion.
    shape : Pulse
        Any pulse of the shape.
    polarities : sequence of int
        The polarities, 1, -1 (reversed pulses) or both.

    Raises
    ------
    InputError, MechanismError
        If the structure does not stand, or its restitution is not known.
    """
    structure.ask("sizes")
    direction = weakest_direction(structure.equivalence, shape, polarities)
    if not structure.mechanism.rocks_both_ways:
        direction = structure.mechanism.directions[0]
    return PulsedModel(
        structure.name, structure.model(model), structure.equivalence, direction, structure.restitution_source
    )


def uplift(block: EquivalentBlock, model: ModelName) -> float:
    """Return the uplift acceleration over g of a scaling, lambda in a = a_g/(g lambda)."""
    return block.lambda_lin if model == "linear1" else block.lambda_


def weakest_direction(equivalence: Equivalence, shape: Pulse, polarities: Sequence[int] = (1,)) -> Direction:
    """Return the direction in which the weakest pulse of a shape uplifts; if both are equal, the one pushed first."""
    ground = shape.sampled().acceleration / shape.amplitude
    pushes = {d: np.max([-d * polarity * ground for polarity in polarities], axis=0) for d in Direction}
    needed = {d: equivalence[d].lambda_ / max(float(push.max()), 1e-300) for d, push in pushes.items()}
    if isclose(*needed.values(), rel_tol=SAME_AMPLITUDE):
        return min(Direction, key=lambda d: int(pushes[d].argmax()))
    return min(Direction, key=needed.__getitem__)


def outcomes(
    structure: PulsedModel,
    shape: Pulse,
    periods: Reals,
    amplitudes: Reals,
    *,
    polarities: Sequence[int] = (1,),
    progress: Progress | None = None,
) -> Outcomes:
    """Simulate a structure under pulses.

    Parameters
    ----------
    structure : PulsedModel
        The model of the structure.
    shape : Pulse
        The shape of the pulses.
    periods, amplitudes : ndarray, shape (n,)
        Period [s] and amplitude [m/s2] of each pulse.
    polarities : sequence of int
        The polarities, 1, -1 or both. Of both, the worse governs: overturning (after fewer impacts), then an unknown
        outcome, then the larger peak. The lower bound of an unknown peak covers both polarities.
    progress : callable, optional
        Called with the number of motions done since the last call.

    Returns
    -------
    Outcomes
        Outcomes of shape (n,).

    Notes
    -----
    A linear model under a chain of sines and constants is exact. Any other model is simulated under the pulse sampled
    with 400 points to a period: amplitudes of overturning have a relative error of some 1e-8, the peaks of motions that
    only just uplift one of 1e-4.
    """
    free = structure.model.one_sided is None and structure.model.bounds == (None, None)
    exact = structure.model.is_linear and shape.segments() and free
    follow = _exactly if exact else _by_histories
    # The reversed pulse has the same effect on a symmetric structure.
    first, *others = polarities[:1] if structure.symmetric else polarities
    worst = follow(structure, shape, periods, amplitudes, first, progress)
    for polarity in others:
        other = follow(structure, shape, periods, amplitudes, polarity, progress)
        bound = np.fmax(_known_peak(worst), _known_peak(other))
        worst = other.by_field(partial(np.where, _badness(other) > _badness(worst)), worst)
        worst = replace(worst, lower_bound=np.where(worst.unknown, bound, worst.lower_bound))
    return worst


def _exactly(
    structure: PulsedModel, shape: Pulse, periods: Reals, amplitudes: Reals, polarity: int, progress: Progress | None
) -> Outcomes:
    result = exact_many(
        structure.equivalence,
        shape,
        amplitudes,
        periods,
        kappa=1 if structure.model.name == "linear1" else 2,
        gravity=structure.gravity,
        polarity=polarity,
        progress=progress,
    )
    _check(structure, result.failed, periods, amplitudes)
    return result


def _by_histories(
    structure: PulsedModel, shape: Pulse, periods: Reals, amplitudes: Reals, polarity: int, progress: Progress | None
) -> Outcomes:
    different, which = np.unique(periods, return_inverse=True)
    motions = [replace(shape, period=float(period)).sampled(COARSE_POINTS_PER_PERIOD) for period in different]
    runs = Runs.of(0, which, scale=amplitudes / shape.amplitude, polarity=polarity)
    result = structure.engine.outcomes([structure.model], motions, runs, only_peaks=True, progress=progress)
    _check(structure, result.failed, periods, amplitudes)
    return result


def _check(structure: PulsedModel, failed: Bools, periods: Reals, amplitudes: Reals) -> None:
    if failed.any():
        k = int(failed.argmax())
        raise SolverError(
            f"{structure.name}: the motion under a pulse of {amplitudes[k]:.4g} m/s2 and {periods[k]:.4g} s could not "
            "be simulated: so slow a pulse needs a lower restitution"
        )


def _badness(each: Outcomes) -> Reals:
    """Return a number that increases from small peaks to unknown outcomes to overturning without impact."""
    stands = np.where(each.unknown, 1e6 + np.nan_to_num(each.lower_bound), np.nan_to_num(each.peak_ratio))
    return np.where(each.fell, 1e9 - each.impact_count, stands)


def _known_peak(each: Outcomes) -> Reals:
    """Return the lower bounds of the peaks over phi_cr."""
    return np.where(each.unknown, each.lower_bound, each.peak_ratio)

"""Restitution from a trace of free rocking: the whole trace is fitted at once.

The start of the fit comes from the times of the impacts, with the frequency parameter known: the time between two
impacts gives the peak between them, and this the energy. The fit itself uses every sample: rates before and after
impacts, and peaks, would be biased by noise and drift.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, least_squares

from rocking_cli.core import Direction
from rocking_cli.errors import InputError
from rocking_cli.structure import Structure
from rocking_cli.studies.experiments.free_rocking import (
    BlockSide,
    FreeRocking,
    MechanismSide,
    RockingSide,
    free_rocking,
    quarter_cycles,
)
from rocking_cli.studies.experiments.trace import Trace

Reals = NDArray[np.float64]

LEAST_IMPACTS = 3
LEAST_SAMPLES = 30
LEAST_ALPHA = 0.07  # rad: for smaller slenderness, p and alpha cannot be told apart
LEAST_ANGLE = 1e-6  # of the rotation at which the structure overturns: no instrument sees less
LONGEST = 1e6  # s of a trace
SEEN = 3.0  # times the noise: half-cycles with larger peaks are seen
ABOVE = 5.0  # times the noise: the least largest angle of a trace
FARTHEST = 0.98  # of the critical rotation: the largest release
GAP = 3.0  # times the usual interval: what is longer is a gap
STARTS = (0.6, 0.75, 0.85, 0.9, 0.94, 0.97, 0.985)  # restitutions, where the times of impacts do not lead to a fit
FITS = 0.05  # of the largest angle: a residual up to which no other start is tried; a missed impact gives more
WINDOWS = (3, 6, 12, 24, 48, 1_000_000)  # impacts up to which the trace is fitted, one after the other
NEAR = 0.03  # of the largest angle: levels of rest that are nearer lead to the same fit
FURTHER = 3  # further starts, if the residual of the first is large
POOR = 0.2  # of the largest angle: a residual with which the trace is no free rocking of the structure
RELEASE, START, OFFSET, DRIFT, ETA = range(5)  # the parameters; further etas, or ln p and ln alpha, follow


class Estimated(NamedTuple):
    """A fitted number and its standard deviation due to noise."""

    value: float
    deviation: float


@dataclass(frozen=True, eq=False)
class TraceFit:
    """Restitution of a structure, fitted to a trace of free rocking.

    Parameters
    ----------
    trace : Trace
        The trace.
    eta : Estimated
        Coefficient of restitution of all impacts.
    etas : sequence of Estimated
        That of each impact that is seen, each fitted on its own.
    release : float
        Angle at which the structure was let go, in the sense of the trace [rad]; like all that follows but `fitted`, it
        is that of the fit with a restitution for each impact, which a scatter does not disturb.
    release_time : float
        Time at which it was let go [s].
    offset, drift : float
        Angle of the trace at time zero with the structure at rest [rad], and its rate [rad/s].
    impacts : ndarray, shape (k,)
        Times of the impacts that are seen [s].
    fitted, own : ndarray, shape (n,)
        Angle at each sample [rad], with one restitution for all impacts and with one for each.
    noise : float
        Noise of the trace, from the differences of neighbouring samples [rad].
    p, alpha : Estimated, optional
        Frequency parameter [rad/s] and slenderness [rad], if they were fitted.
    """

    trace: Trace
    eta: Estimated
    etas: Sequence[Estimated]
    release: float
    release_time: float
    offset: float
    drift: float
    impacts: Reals
    fitted: Reals
    own: Reals
    noise: float
    p: Estimated | None = None
    alpha: Estimated | None = None

    @property
    def scatter(self) -> float:
        """Standard deviation of the restitution from impact to impact, beyond what noise makes of it.

        It is that by which the etas scatter as much as they do (Paule and Mandel 1982); 0 if noise alone suffices. The
        last impact is too uncertain to count.
        """
        etas = np.array(self.etas[:-1])

        def excess(variance: float) -> float:
            weights = 1 / (etas[:, 1] ** 2 + variance)
            mean = (weights @ etas[:, 0]) / weights.sum()
            return float(weights @ (etas[:, 0] - mean) ** 2) - (len(etas) - 1)

        return 0.0 if excess(0.0) <= 0 else float(np.sqrt(brentq(excess, 0.0, 1.0)))

    @property
    def residual(self) -> float:
        """Root mean square of the residual with one restitution [rad]."""
        return _rms(self.trace.angles - self.fitted)

    @property
    def own_residual(self) -> float:
        """Root mean square of the residual with a restitution for each impact [rad]."""
        return _rms(self.trace.angles - self.own)


@dataclass(frozen=True, eq=False)
class _Problem:
    """The samples to fit, and the structure; angles are in units of the largest, `scale`, times from `origin`."""

    times: Reals
    angles: Reals
    scale: float
    sides_of: Callable[[Reals], Mapping[Direction, RockingSide]]
    first: Direction
    rebounds: bool
    sense: float  # of the trace, that of a positive rotation of the structure
    more: int = 0  # parameters of the geometry

    def motion(self, x: Reals) -> FreeRocking:
        """Return the rotation over the time from the release, for parameters."""
        etas, sides = x[ETA : x.size - self.more], self.sides_of(x[x.size - self.more :])
        release = min(x[RELEASE] * self.scale, 0.9999 * sides[self.first].end)
        until = float(self.times[-1] - x[START])
        return free_rocking(sides, int(self.first) * release, etas, rebounds=self.rebounds, until=until)

    def model(self, x: Reals, times: Reals) -> Reals:
        """Return the angle at times for parameters."""
        rotation = self.sense * self.motion(x).at(times - x[START]) / self.scale
        return np.asarray(rotation + x[OFFSET] + x[DRIFT] * times / self.times[-1])

    def distance(self, x: Reals) -> float:
        """Return the root mean square of the residual with parameters."""
        return _rms(self.model(x, self.times) - self.angles)

    def fit(self, x: Reals, until: float = np.inf) -> tuple[Reals, Reals, float]:
        """Return the fitted parameters, their covariance and the root mean square of the residual, up to a time."""
        inside = self.times <= until
        times, angles = self.times[inside], self.angles[inside]
        low, high = np.full(x.size, -np.inf), np.full(x.size, np.inf)
        low[RELEASE], low[ETA : x.size - self.more], high[ETA : x.size - self.more] = 1e-6, 0.02, 1.2
        found = least_squares(
            lambda each: self.model(each, times) - angles, np.clip(x, low, high), bounds=(low, high),
            x_scale="jac", diff_step=1e-6, xtol=1e-10, ftol=1e-10, gtol=1e-10, max_nfev=20,
        )  # fmt: skip
        free = max(angles.size - x.size, 1)
        covariance = np.linalg.pinv(found.jac.T @ found.jac) * (2 * found.cost / free)
        return found.x, covariance, float(np.sqrt(2 * found.cost / angles.size))


def fit_trace(structure: Structure, trace: Trace, *, free_geometry: bool = False) -> TraceFit:
    """Fit the restitution of a structure to a trace of free rocking.

    Parameters
    ----------
    structure : Structure
        The structure; its geometry is held.
    trace : Trace
        Angle over time, of either sense, with any sampling and gaps; it may begin before the release.
    free_geometry : bool
        Whether p and alpha are fitted as well; only of a free-standing block.

    Returns
    -------
    TraceFit
        One restitution for all impacts, and one for each.

    Raises
    ------
    InputError
        If the trace, or the structure, does not allow a fit; the reason is given.
    MechanismError
        If the structure has no critical rotation.
    """
    sides_of, more = _geometry(structure, free_geometry)
    noise, kept = _from_peak(trace)
    scale = float(np.abs(kept.angles - np.median(kept.angles)).max())
    if not scale > ABOVE * noise:
        raise InputError(
            f"{trace.name}: the noise, {np.degrees(noise):.2g} deg, is not below a fifth of the largest angle, "
            f"{np.degrees(scale):.2g} deg: there is no motion to fit"
        )
    most = max(side.end for side in sides_of(np.array(more)).values())
    if scale > 2 * most:
        raise InputError(
            f"{trace.name}: the largest angle, {np.degrees(scale):.3g} deg, is more than twice the rotation at which "
            f"the structure overturns, {np.degrees(most):.3g} deg: check the unit of the angles, and the structure"
        )
    if scale < LEAST_ANGLE * most:
        raise InputError(
            f"{trace.name}: the largest angle, {np.degrees(scale):.3g} deg, is below {LEAST_ANGLE:g} times the "
            f"rotation at which the structure overturns, {np.degrees(most):.3g} deg: check the unit of the angles"
        )
    both = structure.mechanism.rocks_both_ways
    origin = float(kept.times[0])
    base = _Problem(
        kept.times - origin, kept.angles / scale, scale, sides_of, Direction.POSITIVE, not both, 1.0, len(more)
    )
    count = max(len(_crossings(base.times, base.angles - level, _held_off(noise / scale))) for level in _levels(base))
    if both and count < LEAST_IMPACTS:
        raise InputError(_too_few(trace, count))
    tries = [
        problem
        for problem in (replace(base, first=first, sense=sense) for first in Direction for sense in (1.0, -1.0))
        if both or problem.first in structure.mechanism.directions
    ]
    if structure.model("nonlinear").symmetric:
        tries = [each for each in tries if each.first is Direction.POSITIVE]
    try:
        with np.errstate(all="ignore"):  # a trial far off has no finite residual, and is no best fit
            fits = [fit for each in tries for fit in [_common(each, np.array(more), noise / scale)] if fit is not None]
            if not fits:
                raise InputError(_too_few(trace, 0))
            problem, x, covariance, _ = min(fits, key=lambda each: each[3])
            return _each(problem, x, covariance, trace, noise, origin, free_geometry)
    except (ArithmeticError, np.linalg.LinAlgError):
        what = "no motion of this structure fits: check its size, and the units of times and angles"
        raise InputError(f"{trace.name}: {what}") from None


def _geometry(
    structure: Structure, free: bool
) -> tuple[Callable[[Reals], Mapping[Direction, RockingSide]], list[float]]:
    """Return how both directions follow from the parameters of the geometry, and the start of these."""
    mechanism = structure.mechanism
    structure.ask("trace")
    if not free:
        sides: dict[Direction, RockingSide] = {
            direction: MechanismSide(mechanism, direction, each.reference)
            for direction, each in zip(Direction, structure.statics, strict=True)
            if direction in mechanism.directions
        }
        return lambda _: sides, []
    if mechanism.mechanism != "block" or not mechanism.is_bare:
        raise InputError(
            f"{structure.name}: p and alpha can be fitted of a free-standing block (mechanism: block) only"
        )
    block = structure.equivalence.positive
    if block.phi_cr < LEAST_ALPHA:
        raise InputError(
            f"{structure.name}: alpha is {block.phi_cr:.3g} rad. Below {LEAST_ALPHA:g} rad, a trace does not tell p "
            "and alpha apart: hold the geometry"
        )

    def sides_of(geometry: Reals) -> Mapping[Direction, RockingSide]:
        side = BlockSide(block.p * float(np.exp(geometry[0])), block.phi_cr * float(np.exp(geometry[1])))
        return dict.fromkeys(Direction, side)

    return sides_of, [0.0, 0.0]


def _from_peak(trace: Trace) -> tuple[float, Trace]:
    """Return the noise of a trace, and the trace without samples in which it rises to its first peak.

    Raises `InputError` if it is too short or too long, or if nothing moves.
    """
    if trace.times.size < LEAST_SAMPLES:
        raise InputError(f"{trace.name}: a trace needs at least {LEAST_SAMPLES} samples, got {trace.times.size}")
    length = float(trace.times[-1] - trace.times[0])
    if length > LONGEST:
        raise InputError(f"{trace.name}: the trace lasts {length:.3g} s: check the unit of the times")
    third = np.diff(trace.angles, 3)  # has 20 times the variance of white noise
    noise = float(np.median(np.abs(third)) / 0.6745 / np.sqrt(20))
    size = np.abs(trace.angles - np.median(trace.angles))
    most = float(size.max())
    if not most > 0:
        raise InputError(f"{trace.name}: the angle is the same in all samples: there is no motion to fit")
    start = int(np.argmax(size > most / 2))
    end = start + int(np.argmax(np.append(size[start:], 0.0) < most / 2))
    peak = start + int(np.argmax(size[start:end]))
    rises = size[0] < size[peak] - max(SEEN * 2 * noise, 0.02 * most)
    return noise, Trace(trace.name, trace.times[peak:], trace.angles[peak:]) if rises else trace


def _rms(values: Reals) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _too_few(trace: Trace, count: int) -> str:
    return (
        f"{trace.name}: {count or 'no'} impact{'s' * (count != 1)} can be seen above the noise, and a fit needs "
        f"{LEAST_IMPACTS}: release the structure from a larger angle, or record longer"
    )


def _levels(problem: _Problem) -> list[float]:
    """Return what the angle at rest may be: zero, the end of the trace, the middle between its extremes."""
    angles = problem.angles
    tail = angles[-max(angles.size // 10, 5) :]
    levels = [0.0]
    for level in (float(np.median(tail)), float((angles.max() + angles.min()) / 2)):
        if min(abs(level - each) for each in levels) > NEAR:
            levels.append(level)
    return levels


def _held_off(noise: float) -> float:
    """Return how far an angle must be from rest to have a sign, in units of the largest."""
    return max(4 * noise, 0.01)


def _crossings(times: Reals, angles: Reals, hold: float) -> list[tuple[float, bool]]:
    """Return when the angle changes its sign by more than `hold` on both sides, and whether that is in a gap."""
    usual = float(np.median(np.diff(times)))
    found: list[tuple[float, bool]] = []
    far = np.flatnonzero(np.abs(angles) > hold)
    for one, other in pairwise(far):
        if angles[one] * angles[other] < 0:
            part = slice(one, other + 1)
            when = float(np.interp(0.0, *_increasing(angles[part], times[part])))
            found.append((when, bool(np.diff(times[part]).max() > GAP * usual)))
    return found


def _increasing(values: Reals, times: Reals) -> tuple[Reals, Reals]:
    """Return the ends of a part of a trace, in order of the values."""
    pair = np.array([values[0], values[-1]]), np.array([times[0], times[-1]])
    return pair if values[0] < values[-1] else (pair[0][::-1], pair[1][::-1])


def _starts(problem: _Problem, geometry: Reals, level: float, noise: float) -> list[Reals]:
    """Return where a fit may start, best first: the restitution by the times of impacts, then given ones."""
    angles = problem.angles - level
    crossings = _crossings(problem.times, angles, _held_off(noise))
    if problem.rebounds:
        crossings = []
    before = angles[problem.times <= (crossings[0][0] if crossings else np.inf)]
    if not before.size:
        return []
    extreme = float(before[int(np.argmax(np.abs(before)))])
    if extreme * problem.sense * int(problem.first) <= 0:
        return []
    release = min(abs(extreme), FARTHEST * problem.sides_of(geometry)[problem.first].end / problem.scale)
    sides = problem.sides_of(geometry)
    sizes = np.linspace(0.002, 0.98, 80) * sides[problem.first].end
    table = quarter_cycles(sides[problem.first], sizes)
    quarter = float(np.interp(release * problem.scale, sizes, table))
    if crossings:
        start = crossings[0][0] - quarter
    else:
        start = float(problem.times[int(np.argmax(np.abs(angles) < 0.95 * abs(extreme)))]) - 0.3 * quarter
    etas = list(STARTS)
    spans = [
        (k, (after - when) / 2)
        for k, ((when, hidden), (after, also)) in enumerate(pairwise(crossings), 1)
        if not hidden and not also
    ]
    if len(spans) > 1:
        peaks = np.interp([each[1] for each in spans], table, sizes)
        heights = np.log(peaks * sides[problem.first].lift(peaks))
        slope = float(np.polyfit([each[0] for each in spans], heights, 1)[0])
        etas.insert(0, float(np.clip(np.exp(slope / 2), 0.3, 0.995)))
    return [np.array([release, start, level, 0.0, eta, *geometry]) for eta in etas]


def _common(problem: _Problem, geometry: Reals, noise: float) -> tuple[_Problem, Reals, Reals, float] | None:
    """Fit one restitution for all impacts; None if no start of this sense is possible."""
    best: tuple[_Problem, Reals, Reals, float] | None = None
    held = replace(problem, sides_of=partial(_held, problem.sides_of, geometry), more=0)
    starts = [start[: ETA + 1] for level in _levels(problem) for start in _starts(problem, geometry, level, noise)]
    # Those by the times of impacts first, then those that are nearest to the trace.
    first = [each for each in starts if each[ETA] not in STARTS]
    rest = sorted((each for each in starts if each[ETA] in STARTS), key=held.distance)
    for x in [*first, *rest[:FURTHER]]:
        for count in WINDOWS:  # over ever longer parts of the trace, so that no impact is missed or added
            impacts = held.motion(x).impacts + x[START]
            until = impacts[count - 1] if count <= impacts.size else np.inf
            x, covariance, rms = held.fit(x, until)
            if until >= held.times[-1] or rms > POOR:
                break
        if best is None or rms < best[3]:
            best = held, x, covariance, rms
        if best[3] < FITS:
            break
    if best is None or not problem.more:
        return best
    x, covariance, rms = problem.fit(np.append(best[1], geometry))
    return problem, x, covariance, rms


def _held(
    sides_of: Callable[[Reals], Mapping[Direction, RockingSide]], geometry: Reals, _: Reals
) -> Mapping[Direction, RockingSide]:
    """Return both directions of a geometry that is held."""
    return sides_of(geometry)


def _each(
    problem: _Problem, x: Reals, covariance: Reals, trace: Trace, noise: float, origin: float, free: bool
) -> TraceFit:
    """Fit a restitution for each impact, and return both fits in the units of the trace. Raises `InputError`."""
    fitted = problem.model(x, trace.times - origin) * problem.scale
    if not _rms(trace.angles - fitted) < POOR * problem.scale:
        share = _rms(trace.angles - fitted) / problem.scale
        raise InputError(
            f"{trace.name}: the best fit is off by {100 * share:.2g} % of the largest angle (root mean square): this "
            "is not free rocking of this structure. Check its size, and the unit of the angles"
        )
    motion = problem.motion(x)
    inside = motion.impacts[:-1] + x[START] < problem.times[-1]
    count = int(np.count_nonzero(inside & (motion.peaks[1:] > SEEN * noise)))
    if count < LEAST_IMPACTS:
        raise InputError(_too_few(trace, count))
    split = np.concatenate([x[:ETA], np.full(count, x[ETA]), x[ETA + 1 :]])
    own, own_covariance, _ = problem.fit(split)
    total = float(problem.times[-1])
    deviation, own_deviation = np.sqrt(np.diag(covariance)), np.sqrt(np.diag(own_covariance))
    p = alpha = None
    if free:
        side = problem.sides_of(x[-2:])[problem.first]
        assert isinstance(side, BlockSide)
        p, alpha = Estimated(side.p, side.p * deviation[-2]), Estimated(side.end, side.end * deviation[-1])
    drift = float(own[DRIFT]) * problem.scale / total
    return TraceFit(
        trace,
        Estimated(float(x[ETA]), float(deviation[ETA])),
        [Estimated(float(own[ETA + k]), float(own_deviation[ETA + k])) for k in range(count)],
        problem.sense * int(problem.first) * float(own[RELEASE]) * problem.scale,
        float(own[START]) + origin,
        float(own[OFFSET]) * problem.scale - drift * origin,
        drift,
        problem.motion(own).impacts[:count] + float(own[START]) + origin,
        fitted,
        problem.model(own, trace.times - origin) * problem.scale,
        noise,
        p,
        alpha,
    )

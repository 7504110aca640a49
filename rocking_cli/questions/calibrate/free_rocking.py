"""Free rocking from a release, by the first integral of its energy: exact between impacts, at any sampling.

Between two impacts the energy is constant, so that the rate follows from the rotation, phi.^2 = 2 (E - V)/I, and the
time from its integral. An impact multiplies the rate by eta, each by its own if wanted.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import CubicSpline

from rocking_cli.arrays import Integers, Reals
from rocking_cli.core import Direction, Mechanism

SPLINE_PIECES = 400  # pieces of the splines of energy and inertia over the rotation
KNOTS_PER_QUARTER_CYCLE = 16
COARSE_KNOTS = 2  # knots of a first integration: enough to count the half-cycles
MIN_RATE_SHARE = 2e-3  # rate over that of the first impact, below which the structure is at rest
MAX_HALF_CYCLES = 1000
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(4)


@dataclass(frozen=True, eq=False)
class MechanismSide:
    """Energy and inertia of one direction of a mechanism.

    Parameters
    ----------
    mechanism : Mechanism
        The mechanism, with loads and ties that depend on its rotation alone.
    direction : Direction
        The direction.
    end : float
        Critical rotation, or the kinematic limit if there is none [rad].
    """

    mechanism: Mechanism
    direction: Direction
    end: float

    def lift(self, phi: Reals) -> Reals:
        """Return the potential energy over the rotation, divided by the rotation [J/rad]."""
        return np.asarray(self._splines[0](phi))

    def inertia(self, phi: Reals) -> Reals:
        """Return the inertia [kg m2]."""
        return np.asarray(self._splines[1](phi))

    @cached_property
    def _splines(self) -> tuple[CubicSpline, CubicSpline]:
        phi = np.linspace(0, self.end, SPLINE_PIECES + 1)[1:]
        lift = self.mechanism.potential_energy(phi, self.direction) / phi
        return CubicSpline(phi, lift), CubicSpline(phi, self.mechanism.kinetic_inertia(phi, self.direction))


@dataclass(frozen=True, eq=False)
class ScaledSide:
    """A direction of rocking with the frequency parameter and the slenderness of a given one, each times a factor.

    Parameters
    ----------
    side : RockingSide
        The given direction.
    p, alpha : float
        Factors on both.
    """

    side: RockingSide
    p: float = 1.0
    alpha: float = 1.0

    @property
    def end(self) -> float:
        """Largest rotation [rad]."""
        return self.alpha * self.side.end

    def lift(self, phi: Reals) -> Reals:
        """Return the potential energy over the rotation, divided by the rotation."""
        return self.alpha * self.side.lift(phi / self.alpha)

    def inertia(self, phi: Reals) -> Reals:
        """Return the inertia."""
        return self.side.inertia(phi / self.alpha) / self.p**2


RockingSide = MechanismSide | ScaledSide
"""One direction of rocking: energy and inertia over the rotation, and the rotation up to which they are known."""


@dataclass(frozen=True, eq=False)
class FreeRocking:
    """A rotation over time: held at the release until it is let go, then rocking.

    Parameters
    ----------
    times : ndarray, shape (n,)
        Times from the release [s].
    rotations, before, after : ndarray, shape (n,)
        Rotation [rad], and its rates before and after that time [rad/s]; they differ at impacts.
    impacts : ndarray, shape (k,)
        Time at which each half-cycle ends; after the last, the structure is taken to be at rest.
    peaks : ndarray, shape (k,)
        Size of the peak of each half-cycle [rad], the release first.
    """

    times: Reals
    rotations: Reals
    before: Reals
    after: Reals
    impacts: Reals
    peaks: Reals

    def at(self, times: Reals) -> Reals:
        """Return the rotation at times from the release [rad], shape as `times`; at rest after the last half-cycle."""
        k = np.clip(np.searchsorted(self.times, times, side="right") - 1, 0, self.times.size - 2)
        step = np.maximum(self.times[k + 1] - self.times[k], np.finfo(float).tiny)
        x = np.clip((times - self.times[k]) / step, 0.0, 1.0)
        one, other = self.rotations[k], self.rotations[k + 1]
        return np.asarray(
            one + x * x * (3 - 2 * x) * (other - one)
            + step * x * (1 - x) * (self.after[k] * (1 - x) - self.before[k + 1] * x)
        )  # fmt: skip


def free_rocking(
    sides: Mapping[Direction, RockingSide],
    release: float,
    etas: Reals | float,
    *,
    rebounds: bool = False,
    until: float = np.inf,
) -> FreeRocking:
    """Follow free rocking from a release until it has all but died out.

    Parameters
    ----------
    sides : mapping of Direction to RockingSide
        Both directions; only that of the release if the structure rebounds.
    release : float
        Rotation at which it is let go, signed [rad]; smaller than `end` of its side.
    etas : float or ndarray, shape (m,)
        Coefficient of restitution of all impacts, or of each; the last holds for those that follow.
    rebounds : bool
        Whether the structure rebounds into the direction from which it came.
    until : float
        Time after which the motion is not needed [s].

    Returns
    -------
    FreeRocking
        The rotation over time.
    """
    first = Direction.POSITIVE if release > 0 else Direction.NEGATIVE
    factors = np.atleast_1d(np.asarray(etas, dtype=np.float64))
    mean = float(np.mean(factors))
    count = int(min(MAX_HALF_CYCLES, max(2.0, np.log(MIN_RATE_SHARE) / np.log(min(mean, 0.9999)) + factors.size)))
    factors = np.concatenate([factors, np.full(max(0, count - factors.size), factors[-1])])[:count]
    turns = [first if rebounds or k % 2 == 0 else first.opposite for k in range(count + 1)]
    kinds = list(dict.fromkeys(turns))
    which = np.array([kinds.index(each) for each in turns])
    rest = np.array([float(sides[each].inertia(np.zeros(1))[0]) for each in kinds])
    # Energy after an impact over that before: eta^2 I'(0)/I(0).
    gain = np.concatenate([[1.0], factors**2 * rest[which[1:]] / rest[which[:-1]]])
    peak = abs(release)
    energy = float(peak * sides[first].lift(np.array([peak]))[0]) * np.cumprod(gain)
    peaks, quarter = np.empty(count + 1), np.empty(count + 1)
    for k, each in enumerate(kinds):
        inside = which == k
        peaks[inside] = _peaks(sides[each], energy[inside])
        quarter[inside] = _quarter(sides[each], peaks[inside], COARSE_KNOTS)[0][:, -1]
    begins = np.cumsum(2 * quarter) - quarter[0]  # times at which the next half-cycle begins
    count = min(int(np.searchsorted(0.99 * begins, until)) + 1, count + 1)  # half-cycles up to `until`
    peaks, which = peaks[:count], which[:count]
    spans, rates = np.empty((count, KNOTS_PER_QUARTER_CYCLE + 1)), np.empty((count, KNOTS_PER_QUARTER_CYCLE + 1))
    for k, each in enumerate(kinds):
        inside = which == k
        spans[inside], rates[inside] = _quarter(sides[each], peaks[inside], KNOTS_PER_QUARTER_CYCLE)
    return _joined(first, which, kinds, peaks, spans, rates)


def quarter_cycles(side: RockingSide, peaks: Reals) -> Reals:
    """Return the time from each peak to the impact [s], shape as `peaks` [rad]."""
    return _quarter(side, peaks, KNOTS_PER_QUARTER_CYCLE)[0][:, -1]


def _peaks(side: RockingSide, energy: Reals) -> Reals:
    """Return the rotations at which the potential energy reaches values, by Newton's method from below."""
    phi = np.minimum(energy / side.lift(np.zeros(1))[0], side.end)
    for _ in range(60):
        lift = side.lift(phi)
        slope = (phi * (1 + 1e-6) * side.lift(phi * (1 + 1e-6)) - phi * lift) / (1e-6 * phi)
        step = (energy - phi * lift) / np.maximum(slope, 1e-6 * lift)
        phi = np.clip(phi + step, 0.1 * phi, side.end)
        if np.all(np.abs(step) < 1e-13 * phi):
            break
    return np.asarray(phi)


def _quarter(side: RockingSide, peaks: Reals, knots: int) -> tuple[Reals, Reals]:
    """Return times from the peak and sizes of the rates at peak (1 - u^2), u from 0 to 1, shapes (n, knots + 1)."""
    edges = np.linspace(0.0, 1.0, knots + 1)
    u = (edges[:-1, None] + (1 + _POINTS) / 2 / knots).ravel()
    height = (peaks * side.lift(peaks))[:, None]

    def rate(at: Reals) -> Reals:
        phi = peaks[:, None] * (1 - at * at)
        return np.sqrt(np.maximum(2 * (height - phi * side.lift(phi)) / side.inertia(phi), 0.0))

    slowness = 2 * peaks[:, None] * u / rate(u)
    parts = (slowness.reshape(peaks.size, knots, _POINTS.size) * _WEIGHTS).sum(axis=-1) / (2 * knots)
    return np.concatenate([np.zeros((peaks.size, 1)), np.cumsum(parts, axis=1)], axis=1), rate(edges)


def _joined(
    first: Direction, which: Integers, kinds: list[Direction], peaks: Reals, spans: Reals, rates: Reals
) -> FreeRocking:
    """Join the quarters of all half-cycles to one motion."""
    quarter = spans[:, -1]
    impacts = quarter[0] + np.concatenate([[0.0], np.cumsum(2 * quarter[1:])])
    shape = 1 - np.linspace(0.0, 1.0, KNOTS_PER_QUARTER_CYCLE + 1) ** 2
    times, rotations, before, after = [spans[0]], [int(first) * peaks[0] * shape], [-int(first) * rates[0]], []
    after.append(before[0].copy())
    for k in range(1, peaks.size):
        sign = int(kinds[which[k]])
        middle = impacts[k - 1] + quarter[k]
        rise, fall = middle - spans[k, ::-1], middle + spans[k, 1:]
        times.append(np.concatenate([rise[1:], fall]))
        rotations.append(sign * peaks[k] * np.concatenate([shape[::-1][1:], shape[1:]]))
        both = sign * np.concatenate([rates[k, ::-1][1:], -rates[k, 1:]])
        after[-1][-1] = sign * rates[k, -1]  # the rate after the impact
        before.append(both)
        after.append(both.copy())
    after[-1][-1] = 0.0
    return FreeRocking(
        np.concatenate(times), np.concatenate(rotations), np.concatenate(before), np.concatenate(after),
        impacts, peaks,
    )  # fmt: skip

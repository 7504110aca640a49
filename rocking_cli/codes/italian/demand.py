"""Seismic demand on an oscillator on the ground or on a floor: elastic spectra of the Italian code, or from tables.

Formulas are those of NTC 2018, 3.2.3, and Circolare 7/2019, C7.2.3, checked against a transcription of both, not yet
against the printed text.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf, pi, sqrt

import numpy as np

from rocking_cli.core.kinematics import Reals
from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import STANDARD_GRAVITY

REFERENCE_DAMPING = 0.05  # ratio at which a spectrum needs no correction
LONG_PERIOD_START = {"A": 4.5, "B": 5.0, "C": 6.0, "D": 6.0, "E": 6.0}
"""T_E [s] by the soil, from which displacements go down to those of the ground."""
GROUND_PERIOD = 10.0  # T_F [s]: from here on, displacements are those of the ground
LEVEL_FROM, LEVEL_TO = 0.8, 1.1  # a and b of the spectrum of a floor, which is level between a T_1 and b T_1
AMPLIFICATION_COEFFICIENT = 1.1  # factor in the amplification A by a floor
EXPONENT_BELOW, EXPONENT_ABOVE = 1.6, 1.2  # exponents of the spectrum of a floor below and above its level part


def correction(damping: float) -> float:
    """Return the damping correction eta = sqrt(10/(5 + xi)), at least 0.55, for a damping ratio xi/100 [NTC 3.2.4]."""
    return max(sqrt(10 / (5 + 100 * damping)), 0.55)


@dataclass(frozen=True)
class GroundSpectrum:
    """Elastic response spectrum of the ground.

    Parameters
    ----------
    ag : float
        Ground acceleration a_g on rock [g].
    F0, S : float
        Maximum spectral amplification F0, and factor S of soil and topography.
    TC : float
        End of the level part of the spectrum, T_C [s].
    soil : str or None
        Soil class A to E, which sets T_E; without it the displacement spectrum has no change of form at T_E.
    """

    ag: float
    F0: float
    TC: float
    S: float
    soil: str | None = None

    @property
    def TB(self) -> float:
        """Start of the level part of the spectrum, T_B [s]."""
        return self.TC / 3

    @property
    def TD(self) -> float:
        """Start of the part of constant displacement, T_D [s]."""
        return 4.0 * self.ag + 1.6

    @property
    def peak(self) -> float:
        """Peak ground acceleration a_g S [m/s2]."""
        return self.ag * self.S * STANDARD_GRAVITY

    def with_ag(self, ag: float) -> GroundSpectrum:
        """Return the spectrum for another a_g [g]."""
        return replace(self, ag=ag)

    def acceleration(self, period: float, damping: float) -> float:
        """Return the spectral acceleration S_e [m/s2; NTC 3.2.2]."""
        eta, T = correction(damping), period
        level = self.peak * eta * self.F0
        if T < self.TB:
            return level * (T / self.TB + (1 - T / self.TB) / (eta * self.F0))
        if T < self.TC:
            return level
        # For very large a_g, T_C may exceed T_D; the spectrum then has only the branch beyond T_D.
        return level * self.TC / T if T < self.TD else level * self.TC * self.TD / T**2

    def displacement(self, period: float, damping: float) -> float:
        """Return the spectral displacement S_De [m; NTC 3.2.10-12]."""
        start = LONG_PERIOD_START[self.soil] if self.soil is not None else inf
        if period <= start:
            return self.acceleration(period, damping) * (period / (2 * pi)) ** 2
        level = self.F0 * correction(damping)
        share = min((period - start) / (GROUND_PERIOD - start), 1.0)
        return 0.025 * self.peak * self.TC * self.TD * (level + (1 - level) * share)


@dataclass(frozen=True)
class TableSpectrum:
    """A spectrum given as ordinates at 5 % damping, linear between them; corrected for other damping ratios.

    The correction increases from none at T = 0 to its full value at the period of the largest ordinate.

    Parameters
    ----------
    points : sequence of (float, float)
        Periods [s], starting at 0, and accelerations [g].
    factor : float
        Factor on all accelerations.
    start : float
        T0, the shortest period considered for displacements [s]: 0 for an element that is rigid before it rocks.
    field : str
        Field of the site file, for messages.
    """

    points: Sequence[tuple[float, float]]
    factor: float = 1.0
    start: float = 0.0
    field: str = "spectrum"

    @property
    def ag(self) -> float:
        """Ordinate at T = 0 [g], which is a_g S."""
        return self.factor * self.points[0][1]

    @property
    def peak(self) -> float:
        """Ordinate at T = 0 [m/s2], which is a_g S."""
        return self.ag * STANDARD_GRAVITY

    @property
    def S(self) -> float:
        """Factor of soil and topography: 1, as the ordinates include it."""
        return 1.0

    @cached_property
    def _known(self) -> tuple[Reals, Reals]:
        """Periods [s] and accelerations [m/s2] of the table, with the factor."""
        T, a = np.array(self.points, dtype=np.float64).T
        return T, self.factor * STANDARD_GRAVITY * a

    @cached_property
    def ramp(self) -> float:
        """Period at which the correction for damping reaches its full value [s]."""
        return max(self.points, key=lambda each: each[1])[0]

    def with_ag(self, ag: float) -> TableSpectrum:
        """Return a spectrum of the same shape with another ordinate at T = 0 [g]."""
        return replace(self, factor=ag / self.points[0][1])

    def acceleration(self, period: float, damping: float) -> float:
        """Return the spectral acceleration S_e [m/s2]. Raises `InputError` beyond the table."""
        self._check(period)
        return float(self._at(np.array([period]), damping)[0])

    def displacement(self, period: float, damping: float) -> float:
        """Return the largest S_e (t/2 pi)^2 for t from T0 to a period [m; §C8.7.1.2.1.8]. Raises `InputError`."""
        t = self.governing(period, damping)
        return self.acceleration(t, damping) * (t / (2 * pi)) ** 2

    def governing(self, period: float, damping: float) -> float:
        """Return the t at which S_e (t/2 pi)^2 is largest, up to a period [s]. Raises `InputError` beyond the table."""
        self._check(period)
        start = min(self.start, period)
        knots = np.union1d(self._known[0], self.ramp)
        t = np.concatenate([[start, period], knots, self._turns(knots, damping)])
        t = t[(t >= start) & (t <= period)]
        return float(t[(self._at(t, damping) * t**2).argmax()])

    def _at(self, T: Reals, damping: float) -> Reals:
        return np.asarray(self.undamped(T) * self.corrected(T, damping))

    def undamped(self, T: Reals) -> Reals:
        """Return the ordinates of the table at periods, interpolated linearly, shape (n,) [m/s2]."""
        return np.asarray(np.interp(T, *self._known))

    def corrected(self, T: Reals, damping: float) -> Reals:
        """Return the correction for damping at periods, shape (n,)."""
        share = np.minimum(T / self.ramp, 1.0) if self.ramp > 0 else np.ones_like(T)
        return np.asarray(1 - (1 - correction(damping)) * share)

    def _turns(self, knots: Reals, damping: float) -> Reals:
        """Return the periods at which S_e t^2 has an extreme between points, where S_e is (p + q t)(r + s t)."""
        low, high = knots[:-1], knots[1:]
        a, b = np.interp(low, *self._known), np.interp(high, *self._known)
        q = (b - a) / (high - low)
        p, s = a - q * low, np.where(high <= self.ramp, (correction(damping) - 1) / (self.ramp or 1.0), 0.0)
        r = np.where(high <= self.ramp, 1.0, correction(damping))
        square, linear, constant = 4 * q * s, 3 * (p * s + q * r), 2 * p * r
        with np.errstate(divide="ignore", invalid="ignore"):
            root = np.sqrt(linear**2 - 4 * square * constant)
            roots = [(-linear + sign * root) / (2 * square) for sign in (1, -1)]
            roots = [*roots, -constant / linear]  # root of an equation that is linear, or nearly so
        return np.concatenate([turns[(turns > low) & (turns < high)] for turns in roots])

    def _check(self, period: float) -> None:
        last = self.points[-1][0]
        if period > last:
            raise InputError(
                Problem(
                    f"ends at {last:g} s, but the ordinate at {period:.4g} s is needed",
                    field=self.field,
                    hint="add ordinates up to that period: at long periods the displacement governs",
                )
            )


@dataclass(frozen=True)
class FloorSpectrum:
    """The spectrum of a floor, from the first mode of its building [C7.2.5-7, C7.2.10].

    Parameters
    ----------
    ground : DemandSpectrum
        The spectrum of the ground.
    z, H : float
        Heights of the floor and of the building above its foundation [m].
    T1 : float
        First period of the building [s].
    xi1 : float
        Damping ratio of the building.
    n : int
        Number of storeys.
    """

    ground: GroundSpectrum | TableSpectrum
    z: float
    H: float
    T1: float
    xi1: float
    n: int

    @property
    def ag(self) -> float:
        """a_g of the ground [g]."""
        return self.ground.ag

    def with_ag(self, ag: float) -> FloorSpectrum:
        """Return the spectrum for another a_g of the ground [g]."""
        return replace(self, ground=self.ground.with_ag(ag))

    @property
    def gamma(self) -> float:
        """Participation factor of the first mode, 3n/(2n + 1)."""
        return 3 * self.n / (2 * self.n + 1)

    @property
    def psi(self) -> float:
        """Shape of the first mode, z/H."""
        return self.z / self.H

    @property
    def peak(self) -> float:
        """Peak acceleration of the floor, S_Z [m/s2]."""
        shape = self.gamma * self.psi * sqrt(1 + 4 * self.xi1**2)
        return self.ground.acceleration(self.T1, self.xi1) * shape

    def amplification(self, damping: float) -> float:
        """Return the amplification A = 1.1 xi_1^-1/2 eta(xi), with xi_1 as a ratio: our interpretation."""
        return AMPLIFICATION_COEFFICIENT * correction(damping) / sqrt(self.xi1)

    def alone(self, period: float, damping: float) -> float:
        """Return the floor spectrum S_eZ without the lower bound by the ground spectrum [m/s2]."""
        A, low, high = self.amplification(damping), LEVEL_FROM * self.T1, LEVEL_TO * self.T1
        if period < low:
            return A * self.peak / (1 + (A - 1) * float((1 - period / low) ** EXPONENT_BELOW))
        if period <= high:
            return A * self.peak
        return A * self.peak / (1 + (A - 1) * float((period / high - 1) ** EXPONENT_ABOVE))

    def acceleration(self, period: float, damping: float) -> float:
        """Return S_eZ [m/s2]; above T1 at least that of the ground."""
        of_floor = self.alone(period, damping)
        return of_floor if period <= self.T1 else max(of_floor, self.ground.acceleration(period, damping))

    def displacement(self, period: float, damping: float) -> float:
        """Return the displacement demand [m; C8.7.1.12].

        Above T1 it is at least that of the ground, and above b T1 at least its value at b T1.
        """
        return max(self.bounds(period, damping))

    def bounds(self, period: float, damping: float) -> list[float]:
        """Return the lower bounds of a displacement demand [m]: the floor's own, the ground's, and that at b T1."""
        bounds = [self.alone(period, damping) * (period / (2 * pi)) ** 2]
        if period > self.T1:
            bounds.append(self.ground.displacement(period, damping))
        if period > LEVEL_TO * self.T1:
            bounds.append(self.acceleration(self.T1, damping) * (LEVEL_TO * self.T1 / (2 * pi)) ** 2)
        return bounds


DemandSpectrum = GroundSpectrum | TableSpectrum | FloorSpectrum
"""Elastic response spectrum at the support of an oscillator, on the ground or on a floor."""


def ordinates(spectrum: DemandSpectrum, periods: Reals, damping: float) -> Reals:
    """Return S_e at many periods [m/s2], for plots and tests."""
    return np.array([spectrum.acceleration(float(T), damping) for T in periods])

"""Measures of intensity of this package, found by entry points as those of other packages are.

They are exact for linear interpolation between samples, except the mean period, which is defined by the samples.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.measures import measure, time_of_share
from rocking_cli.processing.intensity import MotionMeasure, Reference, RelativeMeasure, RunMeasure
from rocking_cli.processing.oscillator import DAMPING, check_oscillator, response_spectrum

MIN_FREQUENCY, MAX_FREQUENCY = 0.25, 20.0  # Hz; bounds of the frequencies of the mean period
MAX_FREQUENCY_STEP = 0.05  # Hz
HOUSNER_PERIODS = (0.1, 2.5)  # s; bounds of the integral of the Housner intensity
HOUSNER_POINTS = 241  # periods, one every 0.01 s
AVERAGED_PERIODS = 100


class PeakAcceleration(MotionMeasure):
    """Peak ground acceleration."""

    name, title, unit, power = "PGA", "peak ground acceleration", "g", 1.0

    def of(self, motion: GroundMotion) -> float:
        """Return the peak acceleration [standard gravity]."""
        return motion.pga_g


class PeakVelocity(MotionMeasure):
    """Peak ground velocity."""

    name, title, unit, power = "PGV", "peak ground velocity", "m/s", 1.0

    def of(self, motion: GroundMotion) -> float:
        """Return the peak velocity [m/s]."""
        return measure(motion).pgv


class PeakDisplacement(MotionMeasure):
    """Peak ground displacement."""

    name, title, unit, power = "PGD", "peak ground displacement", "m", 1.0

    def of(self, motion: GroundMotion) -> float:
        """Return the peak displacement [m]."""
        return measure(motion).pgd


class VelocityOverAcceleration(MotionMeasure):
    """Ratio of peak velocity to peak acceleration, a measure of how long the motion acts in one direction."""

    name, title, unit, power = "PGV/PGA", "peak velocity over peak acceleration", "s", 0.0
    source = "Zhu et al. (1988), of the inverse"

    def of(self, motion: GroundMotion) -> float | None:
        """Return the ratio [s]; None for a motion that is zero throughout."""
        measures = measure(motion)
        return measures.pgv / (measures.pga_g * STANDARD_GRAVITY) if measures.pga_g else None


class Arias(MotionMeasure):
    """Arias intensity, pi/(2 g) times the integral of the squared acceleration."""

    name, title, unit, power = "Arias", "Arias intensity", "m/s", 2.0
    source = "Arias (1970)"

    def of(self, motion: GroundMotion) -> float:
        """Return the Arias intensity [m/s]."""
        return measure(motion).arias


class CumulativeVelocity(MotionMeasure):
    """Cumulative absolute velocity, the integral of the absolute acceleration."""

    name, title, unit, power = "CAV", "cumulative absolute velocity", "m/s", 1.0
    source = "EPRI (1988)"

    def of(self, motion: GroundMotion) -> float:
        """Return the cumulative absolute velocity [m/s]."""
        a, b = motion.acceleration[:-1], motion.acceleration[1:]
        ends = np.abs(a) + np.abs(b)
        # At a change of sign the area is two triangles: (a^2 + b^2) over twice the difference.
        crossing = np.signbit(a) != np.signbit(b)
        with np.errstate(divide="ignore", invalid="ignore"):
            areas = np.where(crossing & (ends > 0), (a * a + b * b) / (2 * ends), ends / 2)
        return float(motion.dt * areas.sum())


class _Duration(MotionMeasure):
    """Time from 5 % of the Arias intensity to another share of it."""

    share: ClassVar[float]

    def of(self, motion: GroundMotion) -> float | None:
        """Return the duration [s]; None for a motion that is zero throughout."""
        start, end = time_of_share(motion, 0.05), time_of_share(motion, self.share)
        return None if start is None or end is None else end - start


class Duration75(_Duration):
    """Significant duration from 5 to 75 % of the Arias intensity."""

    name, title, unit, power = "D5-75", "time from 5 to 75 % of the Arias intensity", "s", 0.0
    source = "Somerville et al. (1997)"
    share = 0.75


class Duration95(_Duration):
    """Significant duration from 5 to 95 % of the Arias intensity."""

    name, title, unit, power = "D5-95", "time from 5 to 95 % of the Arias intensity", "s", 0.0
    source = "Trifunac and Brady (1975)"
    share = 0.95


class MeanPeriod(MotionMeasure):
    """Mean of the periods of the Fourier spectrum, weighted with the squared amplitudes."""

    name, title, unit, power = "Tm", "mean period of the Fourier spectrum", "s", 0.0
    source = "Rathje, Abrahamson and Bray (1998)"

    def of(self, motion: GroundMotion) -> float | None:
        """Return the mean period [s]; None for a motion without content between 0.25 and 20 Hz."""
        largest = float(np.abs(motion.acceleration).max())
        if largest == 0:
            return None
        # Zeros after the record refine the frequencies at which the spectrum is computed.
        points = max(2 * motion.npts, int(np.ceil(1 / (MAX_FREQUENCY_STEP * motion.dt))))
        points = 1 << (points - 1).bit_length()
        amplitudes = np.abs(np.fft.rfft(motion.acceleration / largest, points)) ** 2
        frequencies = np.fft.rfftfreq(points, motion.dt)
        taken = (frequencies >= MIN_FREQUENCY) & (frequencies <= MAX_FREQUENCY)
        weights = amplitudes[taken]
        return float((weights / frequencies[taken]).sum() / weights.sum()) if weights.sum() > 0 else None


class SpectrumIntensity(MotionMeasure):
    """Integral of the pseudo-velocity at 5 % damping over periods from 0.1 to 2.5 s."""

    name, title, unit, power = "SI", "Housner's spectrum intensity, 5 %", "m", 1.0
    source = "Housner (1952), of the pseudo-velocity"

    def of(self, motion: GroundMotion) -> float:
        """Return the spectrum intensity [m]."""
        periods = np.linspace(*HOUSNER_PERIODS, HOUSNER_POINTS)
        sv = response_spectrum(motion, periods, DAMPING).sv
        return float(((sv[1:] + sv[:-1]) / 2 * np.diff(periods)).sum())


@dataclass(frozen=True)
class _Spectral(MotionMeasure):
    """A measure read from a response spectrum at one period."""

    period: float = field(metadata={"unit": "s"})
    damping: float = field(default=DAMPING, metadata={"unit": "%"})

    def __post_init__(self) -> None:
        check_oscillator(self.period, self.damping)


class SpectralAcceleration(_Spectral):
    """Spectral pseudo-acceleration at a period."""

    name, title, unit, power = "Sa", "pseudo-acceleration of an oscillator", "g", 1.0
    usual = ("Sa(0.3)", "Sa(1.0)", "Sa(3.0)")

    def of(self, motion: GroundMotion) -> float:
        """Return the pseudo-acceleration [standard gravity]."""
        return float(response_spectrum(motion, self.period, self.damping).sa[0])


class SpectralDisplacement(_Spectral):
    """Spectral displacement at a period."""

    name, title, unit, power = "Sd", "displacement of an oscillator", "m", 1.0
    usual = ("Sd(1.0)",)

    def of(self, motion: GroundMotion) -> float:
        """Return the displacement of the oscillator relative to the ground [m]."""
        return float(response_spectrum(motion, self.period, self.damping).sd[0])


@dataclass(frozen=True)
class AverageSpectralAcceleration(MotionMeasure):
    """Geometric mean of the pseudo-accelerations at a hundred evenly spaced periods."""

    low: float = field(metadata={"unit": "s"})
    high: float = field(metadata={"unit": "s", "after": ":"})
    damping: float = field(default=DAMPING, metadata={"unit": "%"})

    name, title, unit, power = "Sa_avg", "geometric mean of Sa over a range of periods", "g", 1.0
    usual = ("Sa_avg(0.2:2.0)",)
    source = "Eads, Miranda and Lignos (2015)"

    def __post_init__(self) -> None:
        for period in (self.low, self.high):
            check_oscillator(period, self.damping)
        if not self.low < self.high:
            raise InputError(f"{self.name} goes from a shorter to a longer period, got {self.low:g} and {self.high:g}")

    def of(self, motion: GroundMotion) -> float:
        """Return the mean pseudo-acceleration [standard gravity]."""
        accelerations = response_spectrum(motion, np.linspace(self.low, self.high, AVERAGED_PERIODS), self.damping).sa
        return float(np.exp(np.log(accelerations).mean())) if accelerations.all() else 0.0


class AccelerationOverUplift(RelativeMeasure):
    """Peak acceleration over the uplift acceleration, a of a pulse [paper, Eq. 40]; uplift requires 1."""

    name, title, to = "PGA/(g lambda)", "peak acceleration over that at uplift", "PGA"
    source = "DeJong and Dimitrakopoulos (2014), Eq. 40"

    def relative(self, value: Any, structure: Reference) -> Any:
        """Return the ratio for a peak acceleration [standard gravity]."""
        return value * STANDARD_GRAVITY / structure.uplift


class VelocityOverUplift(RelativeMeasure):
    """Peak velocity over the velocity that the uplift acceleration gives in the time 1/p."""

    name, title, to, needs = "p PGV/(g lambda)", "p times the peak velocity over g lambda", "PGV", ("p",)

    def relative(self, value: Any, structure: Reference) -> Any:
        """Return the ratio for a peak velocity [m/s]."""
        return structure.p * value / structure.uplift


class VelocityOverImpulse(RelativeMeasure):
    """Peak velocity over the velocity step of the ground that just overturns the structure from rest."""

    name, title, to, needs = "PGV/v_imp", "peak velocity over the step that overturns", "PGV", ("v_imp",)

    def relative(self, value: Any, structure: Reference) -> Any:
        """Return the ratio for a peak velocity [m/s]."""
        return value / structure.v_imp


class UniformDuration(RunMeasure):
    """Total time during which the absolute acceleration is at least the uplift acceleration, g lambda."""

    name, title, unit = "Du", "time with an acceleration of g lambda or more", "s"
    source = "Bolt (1973), of the acceleration at uplift"

    def of(self, motion: GroundMotion, structure: Reference) -> float:
        """Return the duration [s]."""
        return motion.dt * float(_share_above(motion.acceleration, float(structure.uplift)).sum())


def _share_above(acceleration: Reals, level: float) -> Reals:
    """Return the fraction of each sampling interval in which the absolute acceleration is at least `level`."""
    low = np.minimum(acceleration[:-1], acceleration[1:])
    high = np.maximum(acceleration[:-1], acceleration[1:])
    width = high - low
    with np.errstate(divide="ignore", invalid="ignore"):
        above = np.where(low >= level, 1.0, np.clip((high - level) / width, 0.0, 1.0))
        below = np.where(high <= -level, 1.0, np.clip((-level - low) / width, 0.0, 1.0))
    flat = width == 0
    return np.asarray(np.where(flat, np.abs(low) >= level, above + below), dtype=np.float64)

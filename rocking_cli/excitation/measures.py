"""Intensity measures of a ground motion, exact for linear interpolation, also for peaks between samples.

Velocity and displacement start from zero; between samples they are the parabolas and cubics that follow by integration.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite, pi

import numpy as np

from rocking_cli.arrays import Bools, Reals
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion, from_zero
from rocking_cli.short_repr import short_repr

SIGNIFICANT_SHARES = (0.05, 0.95)  # Arias intensity at the start and end of the significant duration


@short_repr
@dataclass(frozen=True)
class Measures:
    """Intensity measures of a ground motion.

    Parameters
    ----------
    pga, mean, rms : float
        Peak, mean and root-mean-square acceleration [standard gravity].
    pgv, final_velocity : float
        Peak velocity, and velocity at the last sample [m/s].
    pgd, final_displacement : float
        Peak displacement, and displacement at the last sample [m].
    arias : float
        Arias intensity, pi/(2 g) times the integral of the squared acceleration [m/s].
    t_5, t_95 : float or None
        Times at which 5 and 95 % of the Arias intensity are reached [s]; None if it is zero.
    mean_period : float or None
        2 pi times the rms acceleration over the rms of its rate [s]; None if the acceleration is constant. Its inverse
        is the root mean square of the frequencies, so that it is shorter than the mean period `Tm` of
        `processing.intensity`, a mean of periods over the Fourier spectrum.
    """

    pga_g: float
    pgv: float
    pgd: float
    arias: float
    t_5: float | None
    t_95: float | None
    mean: float
    rms: float
    final_velocity: float
    final_displacement: float
    mean_period: float | None

    @property
    def significant_duration(self) -> float | None:
        """Time from 5 to 95 % of the Arias intensity [s]."""
        return None if self.t_5 is None or self.t_95 is None else self.t_95 - self.t_5


def arias_build_up(motion: GroundMotion) -> Reals:
    """Return the Arias intensity up to each sample [m/s]; divided by its last value, this is a Husid plot."""
    a, b = motion.acceleration[:-1], motion.acceleration[1:]
    squared = motion.dt / 3 * (a * a + a * b + b * b)  # integral over each sampling interval [m2/s3]
    return from_zero(squared) * (pi / (2 * STANDARD_GRAVITY))


def time_of_share(motion: GroundMotion, share: float) -> float | None:
    """Return the time at which a share of the Arias intensity is reached [s]; None if the motion is zero."""
    built = arias_build_up(motion)
    return _time_of(motion, built, share * float(built[-1])) if built[-1] > 0 else None


def measure(motion: GroundMotion) -> Measures:
    """Return all measures of a ground motion.

    Parameters
    ----------
    motion : GroundMotion
        The ground motion, linear between its samples.

    Returns
    -------
    Measures

    Raises
    ------
    InputError
        If the accelerations are so large that their measures are beyond the range of numbers.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        v, u, built = motion.velocity, motion.displacement, arias_build_up(motion)
        steepness = float(np.sum(np.diff(motion.acceleration) ** 2)) / motion.dt
        total = float(built[-1])
        squared = total * (2 * STANDARD_GRAVITY) / pi
        times = [_time_of(motion, built, share * total) if total > 0 else None for share in SIGNIFICANT_SHARES]
        measures = Measures(
            pga_g=motion.pga_g,
            pgv=_peak_velocity(motion, v),
            pgd=_peak_displacement(motion, v, u),
            arias=total,
            t_5=times[0],
            t_95=times[1],
            mean=float(v[-1]) / motion.duration / STANDARD_GRAVITY,
            rms=(squared / motion.duration) ** 0.5 / STANDARD_GRAVITY,
            final_velocity=float(v[-1]),
            final_displacement=float(u[-1]),
            mean_period=2 * pi * (squared / steepness) ** 0.5 if steepness > 0 else None,
        )
    if not all(isfinite(value) for value in (measures.pgv, measures.pgd, measures.arias)):
        raise InputError(f"{motion.name}: accelerations of {motion.pga_g:.3g} g are beyond the range of numbers")
    return measures


def _peak_velocity(motion: GroundMotion, v: Reals) -> float:
    """Return the peak velocity [m/s], at a sample or where the acceleration is zero between two samples."""
    k = np.flatnonzero(_changes_sign(motion.acceleration))
    a, b = motion.acceleration[k], motion.acceleration[k + 1]
    between = v[k] + motion.dt * a * (a / (a - b)) / 2
    return float(max(np.abs(v).max(), np.abs(between).max(initial=0.0)))


def _peak_displacement(motion: GroundMotion, v: Reals, u: Reals) -> float:
    """Return the peak displacement [m], at a sample or where the velocity is zero between two samples."""
    dt = motion.dt
    # A parabola has a root between two samples only if its sign, or that of its slope, changes there.
    k = np.flatnonzero(_changes_sign(v) | _changes_sign(motion.acceleration))
    a, jump = motion.acceleration[k], motion.acceleration[k + 1] - motion.acceleration[k]
    c, b, d = v[k], dt * a, dt * jump / 2  # v = c + b s + d s^2 for s from 0 to 1
    with np.errstate(divide="ignore", invalid="ignore"):
        w = -(b + np.copysign(np.sqrt(b * b - 4 * d * c), b)) / 2  # this form avoids cancellation
        roots = np.stack([w / d, c / w])
    inside = (roots > 0) & (roots < 1)  # false for NaN, which stands for no root
    s = np.where(inside, roots, 0.0)
    between = u[k] + dt * s * (c + s * (b / 2 + s * d / 3))
    return float(max(np.abs(u).max(), np.abs(between).max(initial=0.0)))


def _changes_sign(values: Reals) -> Bools:
    """Return for each sampling interval whether the values at its ends have opposite signs."""
    signs = np.sign(values)
    return signs[:-1] * signs[1:] < 0


def _time_of(motion: GroundMotion, built: Reals, level: float) -> float:
    """Return the time at which the Arias intensity reaches a level [s]."""
    k = int(np.searchsorted(built, level)) - 1
    ends = motion.acceleration[k : k + 2]
    largest = float(np.abs(ends).max())
    a, b = (float(end) / largest for end in ends)
    missing = (level - float(built[k])) * (2 * STANDARD_GRAVITY / pi) / motion.dt / largest / largest
    # The integral of (a + (b - a) s)^2 is cubic in s. It equals `missing` where the acceleration equals `there`.
    there = float(np.cbrt(a**3 + 3 * (b - a) * missing))
    return (k + min(3 * missing / (a * a + a * there + there * there), 1.0)) * motion.dt

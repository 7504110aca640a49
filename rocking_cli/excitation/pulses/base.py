"""Base class of pulses: a shape in time, an amplitude and a period."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, fields
from math import isfinite
from typing import Any, ClassVar, NamedTuple

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.plugins.errors import failed, guard

POINTS_PER_PERIOD = 4000
"""Samples per period for a single history: its peak has an error of 1e-6 from 1.01 times uplift on."""
COARSE_POINTS_PER_PERIOD = 400
"""Samples per period for batches and stored histories: peaks have an error of 1e-4 near uplift, 1e-7 elsewhere."""
MAX_DIGITS = 17  # enough to tell any two floating-point numbers apart
SAMPLING = "chords with the impulse of the curve"
"""Name of the sampling, for checksums of stored results: if samples are made in another way, it must change."""
GAUSS_POINTS = 48


class Segment(NamedTuple):
    """A piece of a pulse, sine or (omega = 0) constant: a = amplitude sin(omega (t - start) + phase).

    Parameters
    ----------
    start, stop : float
        Times [s] from the start of the pulse.
    amplitude : float
        Amplitude [m/s2].
    omega : float
        Angular frequency [rad/s].
    phase : float
        Phase at `start` [rad].
    """

    start: float
    stop: float
    amplitude: float
    omega: float
    phase: float


@dataclass(frozen=True)
class Pulse(ABC):
    """A pulse of the ground acceleration, positive to the right.

    A shape is a subclass, found by its entry point in `rocking.pulses`, that gives `span` and `shape`, and `segments`
    if it consists of sines and constants. Further parameters are fields with defaults, and the subclass is then a
    frozen dataclass; the metadata of a field may have its "unit". The sign is as in the publication of the shape: the
    first large lobe is positive, unless a phase changes this.

    Parameters
    ----------
    amplitude : float
        Largest acceleration of the pulse [m/s2], > 0.
    period : float
        Period [s], > 0.

    Raises
    ------
    InputError
        If a number is not positive and finite.
    """

    amplitude: float
    period: float

    name: ClassVar[str]
    """Name of the shape in a specification, such as `sine`."""
    title: ClassVar[str]
    """Title of the shape, in a few words."""
    form: ClassVar[str] = "AMPLITUDE:PERIOD"
    """Form of what follows the name in a specification."""
    source: ClassVar[str] = ""
    """Publication of the shape."""

    def __init_subclass__(cls, **named: Any) -> None:
        """Wrap the methods of a shape, so that any failure in them is reported as an error of the plugin."""
        super().__init_subclass__(**named)
        guard(cls, ("__post_init__", "shape", "velocity_shape", "segments"), failed("pulse", "name"))

    def __post_init__(self) -> None:
        for what in ("amplitude", "period"):
            value = getattr(self, what)
            if not (isfinite(value) and value > 0):
                raise InputError(f"{self.name} pulse: the {what} must be positive, got {value:g}")

    @property
    @abstractmethod
    def span(self) -> float:
        """Duration of the pulse in periods."""

    @abstractmethod
    def shape(self, x: Reals) -> Reals:
        """Return the acceleration over the amplitude, at times x in [0, span] in periods; its peak is 1."""

    def segments(self) -> tuple[Segment, ...]:
        """Return the consecutive segments of the pulse; empty if it does not consist of sines and constants."""
        return ()

    def velocity_shape(self, x: Reals) -> Reals:
        """Return the velocity over amplitude times period, at times x in [0, span] in periods, starting from zero.

        It is integrated by Gauss quadrature, exact to rounding for a smooth shape of a few cycles; a subclass may give
        its closed form.
        """
        nodes, weights = np.polynomial.legendre.leggauss(GAUSS_POINTS)
        half = np.asarray(x, dtype=np.float64)[..., None] / 2
        velocity: Reals = (self.shape(half * (1 + nodes)) * half) @ weights
        return velocity

    @property
    def duration(self) -> float:
        """Duration of the pulse [s]."""
        return self.span * self.period

    def acceleration(self, t: Reals) -> Reals:
        """Return the ground acceleration [m/s2] at times t [s], an array of any shape; zero outside [0, duration]."""
        x = np.asarray(t, dtype=np.float64) / self.period
        inside = (x >= 0) & (x <= self.span)
        return self.amplitude * np.where(inside, self.shape(np.clip(x, 0.0, self.span)), 0.0)

    def velocity(self, t: Reals) -> Reals:
        """Return the ground velocity [m/s] at times t [s], an array of any shape; constant after the pulse."""
        x = np.clip(np.asarray(t, dtype=np.float64) / self.period, 0.0, self.span)
        return self.amplitude * self.period * self.velocity_shape(x)

    def sampled(self, per_period: int = POINTS_PER_PERIOD) -> GroundMotion:
        """Return the pulse as a ground motion, linear between samples and zero after the last.

        Parameters
        ----------
        per_period : int
            Samples per period; a few more are used if the pulse would otherwise not end at a sample that time histories
            keep.

        Notes
        -----
        Linear interpolation of a curve lies on its inner side, so that impulse is lost. Samples shifted by a twelfth of
        the second difference keep the impulse of the curve in every interval, so that the error of motions is of fourth
        order in the interval, not of second order.
        """
        every = max(per_period // COARSE_POINTS_PER_PERIOD, 1)
        steps = every * int(np.ceil(self.span * per_period / every - 1e-9))
        curve = self.shape(np.linspace(0.0, self.span, steps + 1))
        samples = self.amplitude * _with_its_impulse(curve)
        return GroundMotion(str(self), self.duration / steps, samples, source_unit="g", format="pulse", every=every)

    @property
    def specification(self) -> str:
        """Text from which `parse_pulse` makes this pulse, to the last bit.

        Examples
        --------
        >>> from rocking_cli.excitation.pulses import parse_pulse
        >>> parse_pulse("sine:0.6g:0.8s").specification
        'sine:0.6g:0.8s'
        """
        further = [
            f"{_shortest(getattr(self, field.name))}{field.metadata.get('unit', '')}" for field in fields(self)[2:]
        ]
        return ":".join([self.name, _amplitude(self.amplitude), f"{_shortest(self.period)}s", *further])

    def __str__(self) -> str:
        return f"{self.name}:{self.amplitude / STANDARD_GRAVITY:.6g}g:{self.period:.6g}s"


def _shortest(value: float) -> str:
    """Return the shortest text that is read as this number."""
    return repr(float(value)).removesuffix(".0")


def _amplitude(value: float) -> str:
    """Return the shortest text in g or m/s2 that is read as this amplitude [m/s2].

    Some amplitudes are not a multiple of g.
    """
    texts = (f"{value / STANDARD_GRAVITY:.{digits}g}" for digits in range(1, MAX_DIGITS + 1))
    in_g = [f"{text}g" for text in texts if float(text) * STANDARD_GRAVITY == value]
    return min([*in_g[:1], f"{_shortest(value)}m/s2"], key=len)


def _with_its_impulse(curve: Reals) -> Reals:
    """Return samples between -1 and 1 whose linear interpolation has the impulse of the curve through those given."""
    if curve.size < 5:
        return curve
    bend = np.empty_like(curve)
    bend[1:-1] = np.diff(curve, 2)
    bend[0], bend[-1] = 2 * bend[1] - bend[2], 2 * bend[-2] - bend[-3]
    smooth = bend.copy()
    # The median of three removes the outliers at kinks and jumps, where plain chords are right.
    smooth[1:-1] = np.median([bend[:-2], bend[1:-1], bend[2:]], axis=0)
    samples = curve - smooth / 12
    peak = max(1.0, float(np.abs(curve).max()))
    over = samples - np.clip(samples, -peak, peak)  # samples above the peak would uplift more structures
    over[[0, -1]] = (samples - curve)[[0, -1]]  # both ends stay on the curve
    samples -= over
    over[[0, -1]] /= 2  # an end belongs to half an interval
    inner = over[1:-1] / 2
    samples[:-2] += inner
    samples[2:] += inner
    samples[[1, -2]] += over[[0, -1]]
    samples = np.clip(samples, -peak, peak)
    samples[[0, -1]] = curve[[0, -1]]
    return samples

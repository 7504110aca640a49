"""Installed pulse shapes, found by the entry points `rocking.pulses`, and the parser of pulse specifications."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, fields
from importlib.metadata import EntryPoint
from math import isfinite
from typing import Any, ClassVar, NamedTuple

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.errors import InputError, MechanismError
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.plugins.errors import failed, guard
from rocking_cli.plugins.registry import Plugins, origin
from rocking_cli.units import QUANTITY, UNITS

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
        # The shortest text of the amplitude, in g or m/s2: some amplitudes are not a multiple of g.
        texts = (f"{self.amplitude / STANDARD_GRAVITY:.{digits}g}" for digits in range(1, MAX_DIGITS + 1))
        in_g = [f"{text}g" for text in texts if float(text) * STANDARD_GRAVITY == self.amplitude]
        amplitude = min([*in_g[:1], f"{_shortest(self.amplitude)}m/s2"], key=len)
        further = [
            f"{_shortest(getattr(self, field.name))}{field.metadata.get('unit', '')}" for field in fields(self)[2:]
        ]
        return ":".join([self.name, amplitude, f"{_shortest(self.period)}s", *further])

    def __str__(self) -> str:
        return f"{self.name}:{self.amplitude / STANDARD_GRAVITY:.6g}g:{self.period:.6g}s"


def _shortest(value: float) -> str:
    """Return the shortest text that is read as this number."""
    return repr(float(value)).removesuffix(".0")


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


__all__ = ["COARSE_POINTS_PER_PERIOD", "Pulse", "PulseShapes", "Segment", "parse_pulse"]

_TIMES = {"": 1.0, "s": 1.0, "ms": 1e-3}


class PulseShapes(Plugins[type[Pulse]]):
    """Pulse shapes by name. Listing names loads nothing; looking one up loads it.

    Raises
    ------
    InputError
        On looking up an unknown name.
    MechanismError
        On looking up a plugin that cannot be loaded, is no pulse shape, or has a name that two packages claim.
    """

    group = "rocking.pulses"
    kind = "pulse"

    @staticmethod
    def accept(loaded: object, point: EntryPoint) -> type[Pulse]:
        """Return the loaded object if it is a complete pulse shape with the name of its entry point."""
        if not (isinstance(loaded, type) and issubclass(loaded, Pulse)) or loaded.__abstractmethods__:
            raise MechanismError(f"{origin(point)} is not a pulse shape: it must derive from Pulse and be complete")
        if getattr(loaded, "name", None) != point.name or not isinstance(getattr(loaded, "title", None), str):
            raise MechanismError(f"{origin(point)} is not a pulse shape: it needs name = {point.name!r} and a title")
        return loaded


def parse_pulse(text: str) -> Pulse:
    """Return the pulse of a specification such as `sine:0.6g:0.8s`.

    Parameters
    ----------
    text : str
        Name, amplitude with its unit (g, m/s2, cm/s2, mm/s2, gal, mg or %g), period in s or ms (or a frequency in Hz),
        and further parameters of the shape, as numbers or with their unit: for `mavroeidis` the phase in deg and the
        number of cycles.

    Raises
    ------
    InputError
        If the shape is unknown, a number or a unit is missing or out of range; the message has the expected form.
    """
    name, *words = (word.strip() for word in text.split(":"))
    shape = PulseShapes()[name]
    further = fields(shape)[2:]
    form = f"expected {name}:{shape.form}, such as {shape(0.6 * STANDARD_GRAVITY, 0.8)}"
    if not 2 <= len(words) <= 2 + len(further):
        raise InputError(f"malformed pulse '{text}': {form}")
    amplitude, unit = _quantity(text, words[0], "amplitude", form, tuple(UNITS))
    period, time = _quantity(text, words[1], "period", form, (*_TIMES, "Hz"))
    if time == "Hz" and period == 0:
        raise InputError(f"pulse '{text}': the frequency must not be zero")
    seconds = 1 / period if time == "Hz" else period * _TIMES[time]
    rest = {}
    for field, word in zip(further, words[2:], strict=False):
        rest[field.name], _ = _quantity(text, word, field.name, form, ("", field.metadata.get("unit", "")))
    return shape(amplitude * UNITS[unit], seconds, **rest)


def _quantity(text: str, word: str, what: str, form: str, units: tuple[str, ...]) -> tuple[float, str]:
    match = QUANTITY.fullmatch(word)
    if match is None:
        raise InputError(f"pulse '{text}': '{word}' is not a valid {what}: {form}")
    unit = next((each for each in units if each.lower() == (match[2] or "").strip().lower()), None)
    if unit is None:
        stated = f"unknown unit '{match[2].strip()}'" if match[2] else "no unit"
        known = ", ".join(filter(None, units))
        raise InputError(f"pulse '{text}': {stated} of {what}, {f'give {known}' if known else 'it takes none'}: {form}")
    return float(match[1]), unit

"""Corrections of a ground motion, each a separate step; nothing is corrected unless requested.

Filters are Butterworth filters of order 4, applied forwards and backwards (scipy.signal.sosfiltfilt), so that they have
zero phase and leave half of the amplitude at the corner frequency.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import floor, inf
from typing import Any, ClassVar, Self

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.text import did_you_mean, exact
from rocking_cli.units import UnitError, number_of

FILTER_ORDER = 4
POLYNOMIAL_DEGREES = {"constant": 0, "linear": 1, "quadratic": 2}


@dataclass(frozen=True)
class Step:
    """One correction of a ground motion; `str` returns it as written in a request, such as `highpass 0.1`."""

    name: ClassVar[str]
    example: ClassVar[str]
    unit: ClassVar[str] = ""
    what: ClassVar[str] = ""
    """Unit and kind of its positive number, if it takes one."""

    @property
    def value(self) -> str:
        """Parameter of the step, as text."""
        (number,) = vars(self).values()
        return exact(number)

    def __str__(self) -> str:
        return f"{self.name} {self.value}"

    @classmethod
    def parse(cls, text: str) -> Self:
        """Return the step with parameters from a text. Raises `InputError`."""
        return cls(_positive(cls, text, cls.unit, cls.what))  # type: ignore[call-arg]  # a subclass has one field

    def of(self, motion: GroundMotion) -> GroundMotion:
        """Return the corrected motion, with its vertical component unchanged. Raises `InputError` if not possible."""
        raise NotImplementedError

    def refused(self, motion: GroundMotion, message: str, hint: str | None = None) -> InputError:
        """Return the error to raise if the correction is not possible."""
        return InputError(Problem(message, motion.name, field=named(self.name), hint=hint))


@dataclass(frozen=True)
class Baseline(Step):
    """Subtract the least-squares polynomial of the samples: `constant`, `linear` or `quadratic`."""

    name = "baseline"
    example = "linear"
    kind: str

    @property
    def value(self) -> str:
        """Kind of polynomial."""
        return self.kind

    @classmethod
    def parse(cls, text: str) -> Self:
        """Return the step for a kind of polynomial."""
        word = text.strip().lower()
        if word not in POLYNOMIAL_DEGREES:
            hint = did_you_mean(word, list(POLYNOMIAL_DEGREES))
            raise _wrong(cls, f"{text!r} is not one of {', '.join(POLYNOMIAL_DEGREES)}", hint)
        return cls(word)

    def of(self, motion: GroundMotion) -> GroundMotion:
        """Return the motion without the polynomial."""
        degree = POLYNOMIAL_DEGREES[self.kind]
        if motion.npts <= degree + 1:
            raise self.refused(motion, f"{motion.npts} samples lie on such a line: nothing would be left")
        t = np.linspace(-1.0, 1.0, motion.npts)
        fitted = np.polynomial.polynomial.polyval(t, np.polynomial.polynomial.polyfit(t, motion.acceleration, degree))
        return _of_samples(motion, motion.acceleration - fitted)


@dataclass(frozen=True)
class Filter(Step):
    """A filter with its corner frequency [Hz]."""

    example, unit, what = "0.1", "Hz", "a frequency in Hz"
    kind: ClassVar[str]
    frequency: float

    def of(self, motion: GroundMotion) -> GroundMotion:
        """Return the motion, filtered forwards and backwards."""
        from scipy import signal

        nyquist, slowest = 0.5 / motion.dt, 1 / motion.duration
        if self.frequency >= nyquist:
            message = (
                f"{self.frequency:g} Hz is not below the Nyquist frequency, {nyquist:.4g} Hz for samples "
                f"every {motion.dt:g} s"
            )
            raise self.refused(motion, message, "give a lower frequency, or leave out the filter")
        if slowest >= nyquist:
            raise self.refused(motion, f"{motion.npts} samples are too few for a filter")
        if self.frequency < slowest * (1 - 1e-9):
            message = f"the record, {motion.duration:.4g} s long, is shorter than one period of {self.frequency:g} Hz"
            raise self.refused(motion, message, f"give {1.01 * slowest:.3g} Hz at least")
        sections = signal.butter(FILTER_ORDER, self.frequency, self.kind, fs=1 / motion.dt, output="sos")
        try:
            return _of_samples(motion, signal.sosfiltfilt(sections, motion.acceleration))
        except ValueError:
            raise self.refused(motion, f"{motion.npts} samples are too few for a filter") from None


@dataclass(frozen=True)
class Highpass(Filter):
    """Remove frequencies below a corner frequency [Hz]."""

    name = "highpass"
    kind = "highpass"


@dataclass(frozen=True)
class Lowpass(Filter):
    """Remove frequencies above a corner frequency [Hz]."""

    name = "lowpass"
    example = "25"
    kind = "lowpass"


@dataclass(frozen=True)
class Taper(Step):
    """Reduce both ends to zero by a half cosine, each over a fraction of the duration (scipy's Tukey window)."""

    name = "taper"
    example = "0.05"
    share: float

    @classmethod
    def parse(cls, text: str) -> Self:
        """Return the taper for a fraction, a number or a percentage."""
        share = _positive(cls, text, "%", "a share")
        if share > 0.5:
            raise _wrong(cls, f"{text} at each end is more than half of the record", "5 % at each end is 0.05")
        return cls(share)

    def of(self, motion: GroundMotion) -> GroundMotion:
        """Return the tapered motion."""
        from scipy.signal import windows

        return _of_samples(motion, motion.acceleration * windows.tukey(motion.npts, 2 * self.share))


@dataclass(frozen=True)
class Trim(Step):
    """Keep the samples from one time to another [s], to the nearest sample; the first becomes time zero."""

    name = "trim"
    example = "2:20"
    start: float
    end: float

    @property
    def value(self) -> str:
        """The two times, as text."""
        return f"{exact(self.start)}:{exact(self.end)}" if self.end < inf else f"{exact(self.start)}:"

    @classmethod
    def parse(cls, text: str) -> Self:
        """Return the step for two times, either of which may be left out: `2:20`, `2:`, `:20`."""
        first, colon, last = (part.strip() for part in text.partition(":"))
        if not colon or not (first or last):
            raise _wrong(cls, f"{text!r} is not a range of times")
        start, end = (
            _number(cls, each, "s", "a time") if each else default for each, default in ((first, 0.0), (last, inf))
        )
        if start < 0 or end <= start:
            raise _wrong(cls, f"{text!r} ends before it begins")
        return cls(start, end)

    def of(self, motion: GroundMotion) -> GroundMotion:
        """Return the motion between the two times."""
        dt = motion.dt
        first = round(self.start / dt) if self.start <= motion.duration else motion.npts
        last = round(min(self.end, motion.duration) / dt)
        if self.end < inf and self.end > motion.duration + dt:
            message = f"the record ends at {motion.duration:.6g} s, before {self.end:g} s"
            raise self.refused(motion, message, f"leave the end open: {self.start:g}:")
        if last - first < 1:
            message = f"of {motion.duration:.4g} s at intervals of {dt:g} s fewer than two samples would be left"
            raise self.refused(motion, message)
        return _of_samples(motion, motion.acceleration[first : last + 1])


@dataclass(frozen=True)
class Resample(Step):
    """Change the sampling interval [s]: interpolate linearly to a finer one; filter and resample to a coarser one."""

    name = "resample"
    example, unit, what = "0.005", "s", "a time"
    dt: float

    MAX_PARTS: ClassVar[int] = 1000
    MAX_MERGED: ClassVar[int] = 100_000
    MAX_SAMPLES: ClassVar[int] = 50_000_000
    MAX_DENOMINATOR: ClassVar[int] = 20_000
    MAX_NUMERATOR: ClassVar[int] = 1_000_000  # scipy's filter is twenty times as long

    def of(self, motion: GroundMotion) -> GroundMotion:
        """Return the motion at the new sampling interval."""
        ratio = self.dt / motion.dt
        if abs(ratio - 1) < 1e-9:
            return motion
        if not ratio >= 1 / self.MAX_PARTS:
            message = f"{self.dt:g} s is less than a {self.MAX_PARTS}th of the {motion.dt:g} s between its samples"
            raise self.refused(motion, message)
        if self.dt > motion.duration:
            message = f"of {motion.duration:.4g} s fewer than two samples would be left"
            raise self.refused(motion, message)
        if ratio > self.MAX_MERGED:
            message = f"{self.dt:g} s is more than {self.MAX_MERGED} of the {motion.dt:g} s between its samples"
            raise self.refused(motion, message)
        if ratio < 1:
            if motion.npts / ratio > self.MAX_SAMPLES:
                message = (
                    f"this would make {motion.npts / ratio:.3g} samples; at most {self.MAX_SAMPLES:.3g} are allowed"
                )
                raise self.refused(motion, message)
            time = self.dt * np.arange(floor(motion.duration / self.dt * (1 + 1e-12)) + 1)
            return _of_samples(motion, np.interp(time, motion.time, motion.acceleration), self.dt)
        return self._coarser(motion, ratio)

    def _coarser(self, motion: GroundMotion, ratio: float) -> GroundMotion:
        """Return the motion at a coarser interval by scipy.signal.resample_poly, which applies a low-pass filter.

        The ratio of the intervals is rounded to the fraction that this function takes.
        """
        from fractions import Fraction

        from scipy import signal

        steps = max(min(self.MAX_DENOMINATOR, int(self.MAX_NUMERATOR / ratio)), 1)
        taken = Fraction(ratio).limit_denominator(steps)
        samples = signal.resample_poly(motion.acceleration, taken.denominator, taken.numerator, padtype="line")
        dt = motion.dt * float(taken)
        if abs(dt / self.dt - 1) < 1e-9:
            dt = self.dt
        inside = floor(motion.duration / dt * (1 + 1e-9)) + 1  # no sample lies beyond the end of the motion
        return _of_samples(motion, samples[:inside], dt)


@dataclass(frozen=True)
class Factor(Step):
    """Multiply the accelerations by a factor, such as that of a set of records."""

    name = "factor"
    example = "1.5"
    by: float

    @classmethod
    def parse(cls, text: str) -> Self:
        """Return the step for a factor, which must not be zero."""
        factor = _number(cls, text, "", "a factor")
        if factor == 0:
            raise _wrong(cls, f"{text!r} is not a factor")
        return cls(factor)

    def of(self, motion: GroundMotion) -> GroundMotion:
        """Return the multiplied motion."""
        return replace(motion.scaled(self.by), name=motion.name, vertical=motion.vertical)


STEPS: Mapping[str, type[Step]] = {
    each.name: each for each in (Baseline, Highpass, Lowpass, Taper, Trim, Resample, Factor)
}


def parse_step(name: str, parameters: object) -> Step:
    """Return a step from its name and parameters, as in a study file: `highpass: 0.1`, `trim: [2, 20]`.

    Raises
    ------
    InputError
        If there is no such step, or its parameters are not valid.
    """
    step = STEPS.get(name)
    if step is None:
        hint = did_you_mean(name, list(STEPS)) or f"the steps are {', '.join(STEPS)}"
        raise InputError(Problem(f"{name!r} is not a processing step", hint=hint))
    if isinstance(parameters, list | tuple) and len(parameters) == 2:
        parameters = f"{parameters[0]}:{parameters[1]}"
    if isinstance(parameters, bool) or not isinstance(parameters, str | int | float):
        raise _wrong(step, f"cannot be {parameters!r}")
    return step.parse(str(parameters))


def parse_steps(entries: Sequence[Mapping[str, Any] | str]) -> tuple[Step, ...]:
    """Return steps in their order, from a list of `{highpass: 0.1}` or of `highpass 0.1`. Raises `InputError`."""
    steps = []
    for entry in entries:
        if isinstance(entry, str):
            name, _, parameters = entry.strip().partition(" ")
            steps.append(parse_step(name, parameters))
        elif len(entry) == 1:
            steps.append(parse_step(*next(iter(entry.items()))))
        else:
            hint = "such as `- highpass: 0.1`"
            raise InputError(Problem("one step an entry: a name and what it is given", hint=hint))
    return tuple(steps)


def process(motion: GroundMotion, steps: Sequence[Step], *, accelerations: bool = True) -> GroundMotion:
    """Return a motion after some steps; its vertical component is processed too, but never reversed.

    Parameters
    ----------
    motion : GroundMotion
        The motion as read.
    steps : sequence of Step
        Steps in the order of application.
    accelerations : bool
        Whether the samples are accelerations, and not values that are differentiated later.

    Returns
    -------
    GroundMotion
        The processed motion. Its `processing` has the steps, and its `remarks` the doubts about single samples before
        them.

    Raises
    ------
    InputError
        If a step cannot be done.
    """
    if not steps:
        return motion
    from rocking_cli.excitation.doubts import of_samples

    slowest = max((step.frequency for step in steps if isinstance(step, Highpass)), default=0.0)
    fastest = min((step.frequency for step in steps if isinstance(step, Lowpass)), default=inf)
    if slowest >= fastest:
        message = f"{slowest:g} Hz is not below the lowpass of {fastest:g} Hz: nothing is left of the motion"
        raise InputError(Problem(message, field=Highpass.name, hint="exchange the two frequencies"))

    raw = motion
    vertical = process(motion.vertical, of_vertical(steps)) if motion.vertical is not None else None
    ground = process(motion.ground, steps) if motion.ground is not None else None
    for step in steps:
        motion = step.of(motion)
    if not np.isfinite(motion.acceleration).all():
        raise InputError(Problem("is beyond the range of numbers after its corrections", raw.name))
    remarks = (*raw.remarks, *of_samples(raw, accelerations=accelerations))
    if any(isinstance(step, Lowpass) for step in steps):
        remarks = tuple(each for each in remarks if each.kind != "resolution")
    done = (*raw.processing, *map(str, steps))
    return replace(motion, vertical=vertical, ground=ground, remarks=remarks, processing=done)


def multiplied(motion: GroundMotion, by: float) -> GroundMotion:
    """Return a motion multiplied by a factor, which is one of its processing steps unless it is 1."""
    return process(motion, [Factor(by)] if by != 1 else [])


def of_vertical(steps: Sequence[Step]) -> tuple[Step, ...]:
    """Return the steps for the vertical component, in which a negative factor becomes positive."""
    return tuple(replace(step, by=abs(step.by)) if isinstance(step, Factor) else step for step in steps)


def _of_samples(motion: GroundMotion, samples: Reals, dt: float | None = None) -> GroundMotion:
    dt = motion.dt if dt is None else dt
    every = max(round(motion.every * motion.dt / dt), 1)  # the shown samples of a history keep their spacing
    return replace(motion, acceleration=samples, dt=dt, every=every, points=None)


def _number(step: type[Step], text: str, unit: str, what: str) -> float:
    try:
        return number_of(text, unit)
    except UnitError as error:
        raise _wrong(step, f"{text!r} is not {what}: {error.message}", error.hint) from None


def _positive(step: type[Step], text: str, unit: str, what: str) -> float:
    number = _number(step, text, unit, what)
    if number <= 0:
        raise _wrong(step, f"{text!r} is not {what} above zero")
    return number


def _wrong(step: type[Step], message: str, hint: str | None = None) -> InputError:
    return InputError(Problem(message, field=named(step.name), hint=hint or f"such as {step.example}"))

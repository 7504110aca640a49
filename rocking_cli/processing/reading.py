"""How a record is read and processed, in one object: from a file to the motion that excites a structure."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import cos, isclose, isfinite, prod, radians, sin
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.excitation.base import STANDARD_GRAVITY, Doubt, GroundMotion
from rocking_cli.excitation.doubts import of_samples
from rocking_cli.excitation.records import read_measured
from rocking_cli.excitation.records.record_units import Quantity
from rocking_cli.excitation.records.statements import name as plain_name
from rocking_cli.processing.reading_options import ALL_AZIMUTHS, PREPARING, READING
from rocking_cli.processing.steps import Factor, Lowpass, Resample, Step, of_vertical, process
from rocking_cli.short_repr import short_repr
from rocking_cli.text import exact

OF_FILES = ("dt", "units", "channel", "quantity", "gain", "run_on", "despite_header")
OF_PAIRS = ("other", "other_channel", "azimuth")


@dataclass(frozen=True)
class Reading:
    """How a record is read and processed; each option of `ReadingArguments` is an attribute, None if it is not given.

    Parameters
    ----------
    options : mapping of str to object
        Values of the options that are given, without the corrections.
    steps : tuple of Step
        Corrections in their order, applied to the recorded values, before differentiation.
    """

    options: Mapping[str, Any] = field(default_factory=dict)
    steps: tuple[Step, ...] = ()

    def __getattr__(self, name: str) -> Any:
        """Return the value of an option."""
        if name not in READING:
            raise AttributeError(name)
        return self.options.get(name)

    def over(self, common: Reading) -> Reading:
        """Return this reading, completed by the `common` reading of all records, whose corrections come last."""
        return Reading({**common.options, **self.options}, (*self.steps, *common.steps))

    def without(self, *names: str) -> Reading:
        """Return this reading without some options."""
        return replace(self, options={name: each for name, each in self.options.items() if name not in names})

    def check(self) -> Reading:
        """Return this reading. Raises `InputError` if an azimuth has no second component, or the reverse."""
        for name in ("azimuth", "other_channel") if self.other is None else ():
            if self.options.get(name) is not None:
                message, hint = "requires a second component", f"give the file of the second with {named('other')}"
                raise InputError(Problem(message, field=named(name), hint=hint))
        if self.other is not None and self.azimuth is None:
            hint = "0 is the direction of the record, 90 that of the second component"
            raise InputError(Problem("is missing for two components", field=named("azimuth"), hint=hint))
        return self

    def read(self, file: str | Path) -> GroundMotion:
        """Return the motion that excites a structure.

        Raises
        ------
        InputError
            If a file cannot be read, a correction cannot be made, or two components do not fit together.
        """
        if self.azimuth == ALL_AZIMUTHS:
            raise InputError(Problem("can be all for `respond` only", field=named("azimuth"), hint="give one angle"))
        measured, quantity = self._measured(file, self.channel)
        step = smallest_step(measured)
        if self.other is not None:
            second, _ = self._measured(self.other, self._channel_of_other(file))
            step = max(step, smallest_step(second))
            measured = turned(measured, second, self.azimuth)
        corrected = process(measured, self.steps, accelerations=quantity == "acceleration")
        for each in self.steps:  # the corrections also scale the smallest step of the values
            step *= 0.0 if isinstance(each, Lowpass) else abs(each.by) if isinstance(each, Factor) else 1.0
        return self.on_floor(as_acceleration(corrected, quantity, step))

    def pair(self, file: str | Path) -> tuple[GroundMotion, GroundMotion]:
        """Return the two components, each processed by itself before their rotation, which is linear.

        Raises
        ------
        InputError
            As `read`.
        """
        alone, channel = self.without(*OF_PAIRS), self._channel_of_other(file)
        second = (
            alone.without("channel")
            if channel is None
            else replace(alone, options={**alone.options, "channel": channel})
        )
        return alone.read(file), second.read(self.other)

    def _channel_of_other(self, file: str | Path) -> str | None:
        if self.other_channel is None and _same(self.other, file):
            hint = f"give the channel of the second with {named('other_channel')}"
            raise InputError(Problem("is the first component too", str(file), field=named("other"), hint=hint))
        channel: str | None = self.channel if self.other_channel is None else self.other_channel
        return channel

    def on_floor(self, motion: GroundMotion) -> GroundMotion:
        """Return the motion of the floor for a ground motion; without a floor, the ground motion."""
        floor_motion: GroundMotion = motion if self.floor is None else self.floor.of(motion)
        return floor_motion

    def vertical(self, file: str | Path, dt: float | None = None, channel: str | None = None) -> GroundMotion:
        """Return the vertical component from a file of its own, read in the same way and with the same corrections.

        Raises
        ------
        InputError
            As `read`.
        """
        own_options = {name: each for name, each in (("dt", dt), ("channel", channel)) if each is not None}
        bare = self.without("channel", "floor", *OF_PAIRS)
        return Reading({**bare.options, **own_options}, of_vertical(self.steps)).read(file)

    def _measured(self, file: str | Path, channel: str | None) -> tuple[GroundMotion, Quantity]:
        uneven = any(isinstance(step, Resample) for step in self.steps)
        of_file = {name: self.options[name] for name in OF_FILES if name in self.options} | {"channel": channel}
        return read_measured(file, uneven=uneven, **of_file)


def reading_of(options: Mapping[str, Any]) -> Reading:
    """Return how to read a record, from the keyword arguments of a verb, or what the fields of a file say.

    Parameters
    ----------
    options : mapping of str to object
        Options by name; corrections are made in the order in which they are given.

    Raises
    ------
    InputError
        If a value is not valid.
    """
    given = {name: each for name, each in options.items() if name in PREPARING and each is not None}
    parsed = {name: PREPARING[name].parse(each) for name, each in given.items()}
    steps = tuple(each for each in parsed.values() if isinstance(each, Step))
    plain_options = {name: each for name, each in parsed.items() if not isinstance(each, Step)}
    return Reading(plain_options, steps)


def _same(one: str | Path, other: str | Path) -> bool:
    """Return whether two paths are those of one file, however they are written."""
    try:
        return Path(one) == Path(other) or Path(one).samefile(other)
    except OSError:  # a missing file is reported when it is read
        return False


DT_TOLERANCE = 1e-6  # relative difference of equal intervals; files print the same interval differently


def turned(one: GroundMotion, other: GroundMotion, azimuth: float) -> GroundMotion:
    """Return the motion in a direction between two components at right angles.

    Parameters
    ----------
    one, other : GroundMotion
        The components: the first is at 0 degrees, the second at 90.
    azimuth : float
        Angle of the direction, from the first component towards the second [deg].

    Returns
    -------
    GroundMotion
        one cos(azimuth) + other sin(azimuth).

    Raises
    ------
    InputError
        If the components differ in length or sampling interval.
    """
    if not isclose(one.dt, other.dt, rel_tol=DT_TOLERANCE):
        message = f"its interval is {other.dt:.9g} s, that of {one.name} {one.dt:.9g} s"
        raise _unlike(other, message, "resample both alike")
    if one.npts != other.npts:
        message = f"it has {other.npts} samples, {one.name} has {one.npts}"
        raise _unlike(other, message, "trim both to the same times; they must begin at the same moment")
    apart = f" ({', '.join(other.processing)})" if other.processing not in ((), one.processing) else ""
    ground = None
    if one.ground is not None and other.ground is not None:
        ground = turned(one.ground, other.ground, azimuth)
    c, s = (of(radians(azimuth)) for of in (cos, sin))
    c, s = (round(each) if abs(each - round(each)) < 1e-15 else each for each in (c, s))  # exact for right angles
    return replace(
        one,
        acceleration=c * one.acceleration + s * other.acceleration,
        points=None,
        ground=ground,
        remarks=(*one.remarks, *other.remarks),
        processing=(*one.processing, f"with {other.name}{apart}", f"azimuth {exact(azimuth)}"),
    )


def _unlike(other: GroundMotion, message: str, hint: str) -> InputError:
    return InputError(
        Problem(f"{message}: two components go sample by sample", other.name, field=named("other"), hint=hint)
    )


MAX_STEP_OVER_PEAK = 0.05  # acceleration of one step of the last digit over the peak


def smallest_step(measured: GroundMotion) -> float:
    """Return the smallest non-zero difference of consecutive samples, usually one last digit; 0 if there is none."""
    steps = np.abs(np.diff(measured.acceleration))
    smallest = float(steps[steps > 0].min(initial=np.inf))
    return smallest if isfinite(smallest) else 0.0


def as_acceleration(measured: GroundMotion, quantity: Quantity, step: float | None = None) -> GroundMotion:
    """Return the ground acceleration from measured displacements, velocities or accelerations.

    Parameters
    ----------
    measured : GroundMotion
        Motion whose "accelerations" are the measured values, in m, m/s or m/s2; accelerations are returned unchanged.
    quantity : str
        Quantity of the measured values.
    step : float, optional
        `smallest_step` of the values before corrections, which hide it; 0 to raise no doubt about the resolution.

    Returns
    -------
    GroundMotion
        Motion by central differences, zero at the first and the last sample. At a frequency f they reduce the amplitude
        by sinc^2(f dt) for displacements and sinc(2 f dt) for velocities, with sinc(x) = sin(pi x)/(pi x).
    """
    if quantity == "acceleration":
        return measured
    dt, values = measured.dt, measured.acceleration
    step = smallest_step(measured) if step is None else step
    inner = np.diff(values, 2) / dt**2 if quantity == "displacement" else (values[2:] - values[:-2]) / (2 * dt)
    acceleration = np.pad(inner, 1)
    if not np.isfinite(acceleration).all():
        raise InputError(Problem("its differences are beyond the range of numbers", measured.name))
    remarks = (
        *measured.remarks,
        *of_samples(measured, accelerations=False),
        *_resolution(step, acceleration, dt, quantity),
    )
    return replace(
        measured,
        acceleration=acceleration,
        remarks=remarks,
        processing=(*measured.processing, f"from {quantity}"),
    )


def in_words(quantity: Quantity, dt: float) -> str:
    """Return a description of the differentiation as a filter, for users."""
    twice, half = ("twice ", 0.44295 / dt) if quantity == "displacement" else ("", 0.30168 / dt)
    return f"differentiated {twice}by central differences, which leave half of what is at {half:.3g} Hz"


def _resolution(smallest: float, acceleration: Reals, dt: float, quantity: Quantity) -> tuple[Doubt, ...]:
    """Return a doubt if one step of the last digit, differentiated, is a large part of the peak acceleration."""
    power, unit = (2, "m") if quantity == "displacement" else (1, "m/s")
    noise = smallest / dt**power
    peak = float(np.abs(acceleration).max())
    if not (isfinite(noise) and noise > MAX_STEP_OVER_PEAK * peak):
        return ()
    text = (
        f"its smallest step, {smallest:.3g} {unit}, is {noise / STANDARD_GRAVITY:.2g} g once differentiated, of a peak "
        f"of {peak / STANDARD_GRAVITY:.2g} g: noise, unless a low-pass filter takes it out"
    )
    return (Doubt("resolution", noise / STANDARD_GRAVITY, text),)


if TYPE_CHECKING:  # pydantic is slow to import, and only lists need it
    from rocking_cli.excitation.pulses import Pulse


LIST_SUFFIXES = (".yaml", ".yml")
LIST_FILE = "set.yaml"
"""The list in a folder of records that `rocking select` writes."""


class Listed(NamedTuple):
    """A record file, with its entry in a list of records; the entry is None if the user named the file itself."""

    path: Path
    entry: Any = None  # an `Entry` of `record_list`, which imports pydantic
    folder: Path = Path()

    def reading(self, common: Reading) -> Reading:
        """Return how to read the record, with the items of `common` for all records.

        Raises `InputError` if its items contradict one another.
        """
        if self.entry is None:
            return common
        try:
            reading: Reading = self.entry.reading(self.folder, common)
            return reading
        except InputError as error:
            raise InputError(*(replace(each, file=str(self.path)) for each in error.problems)) from None

    def settled(self, common: Reading) -> tuple[GroundMotion, Reading]:
        """Return the motion of the record, and how it was read. Raises `InputError` if it cannot be read.

        Earthquake and station of the list take the place of those of the file.
        """
        reading = self.reading(common)
        motion = reading.read(self.path)
        if self.entry is not None:
            file_origin = motion.origin
            event, station = (
                plain_name(self.entry.event) or file_origin.event,
                plain_name(self.entry.station) or file_origin.station,
            )
            motion = replace(motion, origin=file_origin._replace(event=event, station=station))
        return motion, reading


def is_list(path: Path) -> bool:
    """Return whether a file is a list of records, by its name."""
    return path.suffix.lower() in LIST_SUFFIXES


@short_repr
class Scaled(NamedTuple):
    """A ground motion as read, its scale factor, and its pulse, or its record and how that was read."""

    motion: GroundMotion
    factor: float
    pulse: Pulse | None = None
    record: Listed | None = None
    reading: Reading | None = None

    @property
    def scale_factor(self) -> float:
        """The factor on the accelerations of the record, with those of its list."""
        steps = self.reading.steps if self.reading is not None else ()
        return self.factor * prod(step.by for step in steps if isinstance(step, Factor))

    @property
    def file(self) -> Path | None:
        """The file of the record, if there is one."""
        return self.record.path if self.record is not None else None

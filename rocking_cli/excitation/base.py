"""Ground motions: acceleration samples at a constant interval, linear in between."""

from __future__ import annotations

from dataclasses import KW_ONLY, InitVar, dataclass, replace
from math import isfinite
from numbers import Real
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking_cli.arrays import Reals
from rocking_cli.errors import InputError, Problem
from rocking_cli.text import one_line
from rocking_cli.units import UnitError, read

STANDARD_GRAVITY = 9.80665  # m/s2
MOST_SAMPLES = 20_000_000  # more than a day at 200 samples a second
ARRAY = "array"  # format of a motion that was not read from a file


class Doubt(NamedTuple):
    """A reason to doubt a ground motion or its file.

    Parameters
    ----------
    kind : str
        Keyword for programs, see the notes.
    value : float
        The number that gives rise to the doubt; the notes list its meaning or unit for each keyword.
    text : str
        A sentence for users.

    Notes
    -----
    Keywords for a motion: dt, mean_period, spike and dropout [s]; pga, offset and start [g]; final_velocity [m/s];
    final_displacement [m]; clipped [number of samples]; p_dt [1].

    Keywords that a reader sets for a file: columns [number of rows; the line number in free text], digits [line
    number], count [number of points], run_on [columns], header_peak [unit of the header], header_time, header_length
    and uneven [s], resolution [g].
    """

    kind: str
    value: float
    text: str


class Origin(NamedTuple):
    """The earthquake and the station of a record, as far as its file states them unambiguously.

    Parameters
    ----------
    event : str or None
        The earthquake: its name, or its time.
    station : str or None
        Name or code of the station.
    magnitude : float or None
        Magnitude; the moment magnitude if the file has several.
    distance : float or None
        Distance from the epicentre, or as the file defines it [km].
    """

    event: str | None = None
    station: str | None = None
    magnitude: float | None = None
    distance: float | None = None


NOT_SAID = Origin()


@dataclass(frozen=True, eq=False, repr=False)
class GroundMotion:
    """A ground acceleration history, positive to the right.

    Parameters
    ----------
    name : str
        Name of the motion.
    dt : float
        Interval between samples [s], > 0.
    acceleration : ndarray, shape (npts,)
        Ground acceleration at t = 0, dt, 2 dt, ..., in `unit`; the motion keeps a read-only copy in m/s2.
    unit : str
        Unit in which the acceleration is given, such as "g", "m/s2" or "gal", which is never guessed. The motion itself
        is always in m/s2.
    source_unit : str
        Unit of the source, such as that of a record's file, for information only: `unit` by default. With it, the
        acceleration may be given in m/s2 without a `unit`.
    format : str
        Source of the motion: a record format, or `"array"`.
    vertical : GroundMotion, optional
        The vertical component of the same motion, positive upwards, with the same start and its own sampling interval.
    points : ndarray of int, optional
        Indices of the recorded samples, if the others are interpolated linearly between these; by default all are
        recorded.
    every : int
        Time histories keep one of this many samples: pulses are sampled more finely than their histories are shown.
    remarks : tuple of Doubt, optional
        Doubts of the reader about the file.
    processing : tuple of str, optional
        Processing steps applied to the record, in order, written as in a request: `"highpass 0.1"`.
    prepared_from : str, optional
        For a prepared record, the file, with its channel, to which the steps were applied.
    ground : GroundMotion, optional
        For the motion of a floor, the motion of the ground, whose peaks are used for scaling.
    origin : Origin, optional
        The earthquake and the station, as far as the file states them.

    Raises
    ------
    InputError
        If there are fewer than two samples, they are complex or have several dimensions, a sample or dt is not finite,
        dt is not positive, `every` is below 1, or `unit` is missing or not that of an acceleration.

    Examples
    --------
    >>> from rocking_cli import GroundMotion
    >>> GroundMotion("mine", 0.01, [0.0, 0.3, -0.1], unit="g")
    <GroundMotion mine: 3 samples, dt = 0.01 s, 0.02 s, PGA = 0.3 g>
    """

    name: str
    dt: float
    acceleration: Reals
    _: KW_ONLY
    unit: InitVar[str | None] = None
    source_unit: str = ""
    format: str = ARRAY
    vertical: GroundMotion | None = None
    points: NDArray[np.intp] | None = None
    every: int = 1
    remarks: tuple[Doubt, ...] = ()
    processing: tuple[str, ...] = ()
    prepared_from: str = ""
    ground: GroundMotion | None = None
    origin: Origin = NOT_SAID

    def __post_init__(self, unit: str | None) -> None:
        if unit is None and not self.source_unit:
            hint = "give it, such as unit='g' or unit='m/s2'"
            raise InputError(
                Problem("is missing: samples in an array need their unit", self.name, field="`unit`", hint=hint)
            )
        if np.iscomplexobj(self.acceleration):
            raise InputError(Problem("must be real numbers", self.name, field="`acceleration`"))
        given: Any = self.acceleration  # a masked array, perhaps: numpy imports those when they are named
        samples = _own(given.filled(np.nan) if hasattr(given, "filled") else given, np.float64)
        if unit not in (None, "m/s2"):
            try:
                samples = _own(samples * read(f"1 {unit}", "m/s2"), np.float64)
            except UnitError as error:
                hint = "give one of acceleration, such as g, m/s2, cm/s2 or gal"
                raise InputError(Problem(error.message, self.name, field="`unit`", hint=hint)) from None
        if not self.source_unit:
            object.__setattr__(self, "source_unit", unit)
        if samples.ndim != 1:
            raise InputError(f"{self.name}: samples must have one dimension, got an array of shape {samples.shape}")
        if samples.size < 2:
            raise InputError(f"{self.name}: a ground motion needs at least two samples, this has {samples.size}")
        if not np.isfinite(samples).all():
            raise InputError(f"{self.name}: sample {int(np.flatnonzero(~np.isfinite(samples))[0]) + 1} is not a number")
        if not (isinstance(self.dt, Real) and isfinite(self.dt) and self.dt > 0):
            raise InputError(f"{self.name}: the sample interval must be a positive number of seconds, got {self.dt!r}")
        if self.every < 1:
            raise InputError(f"{self.name}: a history keeps one of at least 1 sample, got {self.every}")
        object.__setattr__(self, "acceleration", samples)
        object.__setattr__(self, "unit", "m/s2")  # of the copy, also for `replace`
        if self.points is not None:
            object.__setattr__(self, "points", _own(self.points, np.intp))

    def __repr__(self) -> str:
        floor = "" if self.ground is None else ", of a floor"
        vertical = "" if self.vertical is None else ", with a vertical component"
        size = f"{self.npts} samples, dt = {self.dt:.4g} s, {self.duration:.4g} s, PGA = {self.pga_g:.4g} g"
        return f"<GroundMotion {one_line(self.name)}: {size}{floor}{vertical}>"

    @property
    def npts(self) -> int:
        """Number of samples."""
        return int(self.acceleration.size)

    @property
    def duration(self) -> float:
        """Time of the last sample [s]."""
        return (self.npts - 1) * self.dt

    @property
    def time(self) -> Reals:
        """Times of the samples [s]."""
        return np.arange(self.npts, dtype=np.float64) * self.dt

    @property
    def velocity(self) -> Reals:
        """Ground velocity at the samples [m/s], starting from zero, exact for linear interpolation."""
        a = self.acceleration
        return from_zero(self.dt * (a[:-1] + a[1:]) / 2)

    @property
    def displacement(self) -> Reals:
        """Ground displacement at the samples [m], starting from zero, exact for linear interpolation."""
        a, v, dt = self.acceleration, self.velocity, self.dt
        return from_zero(dt * (v[:-1] + dt * (2 * a[:-1] + a[1:]) / 6))

    @property
    def pga_g(self) -> float:
        """Peak ground acceleration, in units of standard gravity."""
        # Rounded to 15 digits, as the conversion to m/s2 and back changes the last bit of values in g.
        return float(f"{np.abs(self.acceleration).max() / STANDARD_GRAVITY:.15g}")

    @property
    def of_ground(self) -> GroundMotion:
        """The motion of the ground below, if this is the motion of a floor; otherwise this motion."""
        return self if self.ground is None else self.ground

    @property
    def kept(self) -> GroundMotion:
        """The motion at the samples that time histories keep, to be shown beside them."""
        if self.every == 1:
            return self
        return replace(self, dt=self.every * self.dt, acceleration=self.acceleration[:: self.every], every=1)

    def scaled(self, factor: float) -> GroundMotion:
        """Return the motion with every acceleration multiplied by `factor`, and the factor in its name.

        A negative factor reverses the horizontal component; the vertical one is multiplied by the factor's absolute
        value.
        """
        name = self.name if factor == 1 else f"{self.name} x {factor:g}"
        if not np.isfinite(factor * float(np.abs(self.acceleration).max())):
            raise InputError(f"{self.name}: a factor of {factor:g} makes accelerations beyond the range of numbers")
        vertical = self.vertical.scaled(abs(factor)) if self.vertical is not None else None
        ground = self.ground.scaled(factor) if self.ground is not None else None
        return replace(self, name=name, acceleration=factor * self.acceleration, vertical=vertical, ground=ground)


def _own(values: ArrayLike, kind: type[np.generic]) -> NDArray[Any]:
    """Return a read-only copy of values; values that are such a copy already are returned themselves."""
    if isinstance(values, np.ndarray) and values.base is None and not values.flags.writeable and values.dtype == kind:
        return values
    copied = np.array(values, dtype=kind, order="C")
    copied.flags.writeable = False
    return copied


def from_zero(steps: Reals) -> Reals:
    """Return the running sums of steps, with zero before the first step."""
    total = np.zeros(steps.size + 1)
    np.cumsum(steps, out=total[1:])
    return total

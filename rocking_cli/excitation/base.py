"""A ground motion: acceleration samples at a constant interval, straight lines between them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking_cli.errors import InputError

STANDARD_GRAVITY = 9.80665  # m/s2
MOST_SAMPLES = 20_000_000  # of a record: more than a day at 200 samples a second


class Doubt(NamedTuple):
    """Something to be careful about.

    Parameters
    ----------
    kind : str
        A word for programs: dt, mean_period, pga, offset, start, final_velocity, final_displacement, clipped, spike,
        dropout or p_dt; of what a reader found in a file, columns, digits, count, header_peak, header_time,
        header_length, uneven or resolution.
    value : float
        The number that raised it: in s, s, g, g, g, m/s, m, samples, s, s and 1; rows (of free text the line), the
        line, points, in the unit of the header, s, s, s and g.
    text : str
        A sentence for people.
    """

    kind: str
    value: float
    text: str


class Origin(NamedTuple):
    """Which earthquake a record is of, and where it was taken, as far as its file says so for sure.

    Parameters
    ----------
    event : str or None
        The earthquake: its name, or when it was.
    station : str or None
        Name or code.
    magnitude : float or None
        Of the moment where the file gives several.
    distance : float or None
        From the epicentre, or as the file says [km].
    """

    event: str | None = None
    station: str | None = None
    magnitude: float | None = None
    distance: float | None = None


NOT_SAID = Origin()


@dataclass(frozen=True, eq=False)
class GroundMotion:
    """A ground acceleration history, positive to the right.

    Parameters
    ----------
    name : str
        What to call it.
    dt : float
        Interval between samples [s], > 0.
    acceleration : ndarray, shape (npts,)
        Ground acceleration [m/s2] at t = 0, dt, 2 dt, ...; a copy is kept, which cannot be written to.
    unit : str
        Unit the acceleration was recorded in, for the reader's eyes only.
    format : str
        Where it came from: a record format, or `"array"`.
    vertical : GroundMotion, optional
        The vertical component of the same motion, positive upwards and from the same moment on, at its own interval.
    points : ndarray of int, optional
        Indexes of the samples that were recorded, where the others lie on straight lines between these; without it
        all were.
    every : int
        Of how many samples a history keeps one: a pulse is sampled more finely than its history need be shown.
    remarks : tuple of Doubt, optional
        What its reader found doubtful in the file.
    processing : tuple of str, optional
        Steps applied to it since it was read, in order, as they would be requested again: `"highpass 0.1"`.
    ground : GroundMotion, optional
        Of the motion of a floor, that of the ground below: its peaks are what a motion is scaled to.
    origin : Origin, optional
        The earthquake and the station, as far as its file says.

    Raises
    ------
    InputError
        If there are fewer than two samples, a sample or dt is not finite, dt is not positive, or `every` is below 1.
    """

    name: str
    dt: float
    acceleration: NDArray[np.float64]
    unit: str = "m/s2"
    format: str = "array"
    vertical: GroundMotion | None = None
    points: NDArray[np.intp] | None = None
    every: int = 1
    remarks: tuple[Doubt, ...] = ()
    processing: tuple[str, ...] = ()
    ground: GroundMotion | None = None
    origin: Origin = NOT_SAID

    def __post_init__(self) -> None:
        samples = _own(self.acceleration, np.float64)
        if samples.ndim != 1 or samples.size < 2:
            raise InputError(f"{self.name}: a ground motion needs at least two samples, this has {samples.size}")
        if not np.isfinite(samples).all():
            raise InputError(f"{self.name}: sample {int(np.flatnonzero(~np.isfinite(samples))[0]) + 1} is not a number")
        if not (np.isfinite(self.dt) and self.dt > 0):
            raise InputError(f"{self.name}: the sample interval must be positive, got {self.dt} s")
        if self.every < 1:
            raise InputError(f"{self.name}: a history keeps one of at least 1 sample, got {self.every}")
        object.__setattr__(self, "acceleration", samples)
        if self.points is not None:
            object.__setattr__(self, "points", _own(self.points, np.intp))

    @property
    def npts(self) -> int:
        """Number of samples."""
        return int(self.acceleration.size)

    @property
    def duration(self) -> float:
        """Time of the last sample [s]."""
        return (self.npts - 1) * self.dt

    @property
    def time(self) -> NDArray[np.float64]:
        """Times of the samples [s]."""
        return np.arange(self.npts, dtype=np.float64) * self.dt

    @property
    def velocity(self) -> NDArray[np.float64]:
        """Ground velocity at the samples [m/s], from zero, exact for straight lines between them."""
        a = self.acceleration
        return from_zero(self.dt * (a[:-1] + a[1:]) / 2)

    @property
    def displacement(self) -> NDArray[np.float64]:
        """Ground displacement at the samples [m], from zero, exact for straight lines between them."""
        a, v, dt = self.acceleration, self.velocity, self.dt
        return from_zero(dt * (v[:-1] + dt * (2 * a[:-1] + a[1:]) / 6))

    @property
    def pga_g(self) -> float:
        """Peak ground acceleration, in units of standard gravity."""
        # To 15 digits: the way through m/s2 and back has changed the last bit of what a record in g says.
        return float(f"{np.abs(self.acceleration).max() / STANDARD_GRAVITY:.15g}")

    @property
    def of_ground(self) -> GroundMotion:
        """The motion of the ground, which this is unless it is that of a floor."""
        return self if self.ground is None else self.ground

    @property
    def kept(self) -> GroundMotion:
        """The motion at the samples that a history keeps, to be shown beside it."""
        if self.every == 1:
            return self
        return replace(self, dt=self.every * self.dt, acceleration=self.acceleration[:: self.every], every=1)

    def plot(self, file: str | Path | None = None) -> Any:
        """Draw it as `rocking_cli.record` does: acceleration, velocity, displacement and Arias intensity over time.

        Parameters
        ----------
        file : str or Path, optional
            Where to write the picture too: .png, .svg or .pdf.

        Returns
        -------
        matplotlib.figure.Figure
        """
        from rocking_cli import record  # by its public name: a motion knows nothing of pictures

        return record(self).plot(file)

    def response_spectrum(self, periods: ArrayLike | None = None, damping: float = 0.05) -> Any:
        """Its response spectrum, as `rocking_cli.response_spectrum` gives it.

        Parameters
        ----------
        periods : array_like, shape (n,), optional
            Of the oscillators [s]; 200 from 0.02 to 10 s at equal ratios, unless given.
        damping : float
            Their damping ratio.

        Returns
        -------
        Answer of ResponseSpectrum
        """
        from rocking_cli import response_spectrum  # by its public name: a motion knows nothing of oscillators

        return response_spectrum(self, periods, damping=damping)

    def scaled(self, factor: float) -> GroundMotion:
        """The same motion with every acceleration multiplied by `factor`, named so.

        A negative factor reverses the horizontal component; the vertical one is multiplied by its size.
        """
        name = self.name if factor == 1 else f"{self.name} x {factor:g}"
        if not np.isfinite(factor * float(np.abs(self.acceleration).max())):
            raise InputError(f"{self.name}: a factor of {factor:g} makes accelerations beyond the range of numbers")
        vertical = self.vertical.scaled(abs(factor)) if self.vertical is not None else None
        ground = self.ground.scaled(factor) if self.ground is not None else None
        return replace(self, name=name, acceleration=factor * self.acceleration, vertical=vertical, ground=ground)


def _own(values: ArrayLike, kind: type[np.generic]) -> NDArray[Any]:
    """A copy of values that nobody can write to; no second one of what is such a copy already."""
    if isinstance(values, np.ndarray) and values.base is None and not values.flags.writeable and values.dtype == kind:
        return values
    copied = np.array(values, dtype=kind, order="C")
    copied.flags.writeable = False
    return copied


def from_zero(steps: NDArray[np.float64]) -> NDArray[np.float64]:
    """Running sums of steps, zero before the first."""
    total = np.zeros(steps.size + 1)
    np.cumsum(steps, out=total[1:])
    return total

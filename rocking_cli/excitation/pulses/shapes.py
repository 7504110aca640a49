"""The pulse shapes of the literature on rocking."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache
from math import ceil, isfinite, pi
from typing import ClassVar

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.errors import InputError
from rocking_cli.excitation.pulses import Pulse, Segment


class _OneSine(Pulse):
    """A pulse of one sine or constant, from a phase [rad] on; `turns` are its cycles in a period."""

    turns: ClassVar[float] = 1.0
    first: ClassVar[float] = 0.0

    def segments(self) -> tuple[Segment, ...]:
        """Return the segment of the pulse, as `Pulse.segments`."""
        return (Segment(0.0, self.duration, self.amplitude, 2 * pi * self.turns / self.period, self.first),)


class Sine(_OneSine):
    """One full cycle of a sine."""

    name = "sine"
    title = "full sine"
    source = "DeJong and Dimitrakopoulos (2014), Eq. 40; Zhang and Makris (2001), type A"
    span = 1.0

    def shape(self, x: Reals) -> Reals:
        """Return the normalised acceleration, as `Pulse.shape`."""
        return np.sin(2 * pi * x)

    def velocity_shape(self, x: Reals) -> Reals:
        """Return the normalised velocity, as `Pulse.velocity_shape`."""
        curve: Reals = (1 - np.cos(2 * pi * x)) / (2 * pi)
        return curve


class Cosine(_OneSine):
    """One full cycle of a cosine, which begins and ends at its peak."""

    name = "cosine"
    title = "full cosine"
    source = "Zhang and Makris (2001), type B"
    span = 1.0
    first = pi / 2

    def shape(self, x: Reals) -> Reals:
        """Return the normalised acceleration, as `Pulse.shape`."""
        return np.cos(2 * pi * x)


class HalfSine(_OneSine):
    """The first half of a sine of the given period; its duration is half the period."""

    name = "half_sine"
    title = "half sine, of half the period"
    source = "Housner (1963)"
    span = 0.5

    def shape(self, x: Reals) -> Reals:
        """Return the normalised acceleration, as `Pulse.shape`."""
        return np.sin(2 * pi * x)


class Rectangular(_OneSine):
    """A constant acceleration; its duration is the period."""

    name = "rectangular"
    title = "constant, for one period"
    source = "Housner (1963)"
    span = 1.0
    turns, first = 0.0, pi / 2

    def shape(self, x: Reals) -> Reals:
        """Return the normalised acceleration, as `Pulse.shape`."""
        return np.ones_like(x)


class Ricker(Pulse):
    """Symmetric Ricker wavelet, the negative second derivative of a Gaussian, truncated below 1e-5 of its peak.

    Its period is that of the peak of its Fourier spectrum.
    """

    name = "ricker"
    title = "symmetric Ricker wavelet"
    source = "Ricker (1943); Vassiliou and Makris (2011)"
    span = 2.6

    def shape(self, x: Reals) -> Reals:
        """Return the normalised acceleration, as `Pulse.shape`."""
        z = 2 * pi**2 * (x - self.span / 2) ** 2
        curve: Reals = (1 - z) * np.exp(-z / 2)
        return curve

    def velocity_shape(self, x: Reals) -> Reals:
        """Return the normalised velocity, as `Pulse.velocity_shape`."""
        middle = self.span / 2
        from_middle = np.asarray(x) - middle
        curve: Reals = from_middle * np.exp(-((pi * from_middle) ** 2)) + middle * np.exp(-((pi * middle) ** 2))
        return curve


class AntisymmetricRicker(Pulse):
    """Antisymmetric Ricker wavelet, the negative third derivative of a Gaussian, truncated below 1e-5 of its peak.

    Its period is that of the peak of its Fourier spectrum. The first of its two large lobes is positive.
    """

    name = "ricker_antisymmetric"
    title = "antisymmetric Ricker wavelet"
    source = "Vassiliou and Makris (2011)"
    span = 3.6
    PEAK: ClassVar[float] = float(np.sqrt(3 - np.sqrt(6)) * np.sqrt(6) * np.exp(-(3 - np.sqrt(6)) / 2))  # 1.38

    def shape(self, x: Reals) -> Reals:
        """Return the normalised acceleration, as `Pulse.shape`."""
        z = 2 * pi / np.sqrt(3) * (x - self.span / 2)
        curve: Reals = (z**2 - 3) * z * np.exp(-(z**2) / 2) / self.PEAK
        return curve


@dataclass(frozen=True)
class MavroeidisPapageorgiou(Pulse):
    """Near-fault pulse of one to a few cycles: its velocity is a cosine times a bell-shaped envelope.

    Parameters
    ----------
    phase : float
        Phase nu [deg]: 0 gives a velocity symmetric about the middle and positive there, 90 an antisymmetric one that
        is negative after the middle.
    cycles : float
        Length of the envelope in periods, gamma > 1 in the publication.
    """

    phase: float = field(default=0.0, metadata={"unit": "deg"})
    cycles: float = 2.0

    name = "mavroeidis"
    title = "Mavroeidis and Papageorgiou's near-fault pulse"
    form = "AMPLITUDE:PERIOD[:PHASE[:CYCLES]]"
    source = "Mavroeidis and Papageorgiou (2003), Eq. 3"

    def __post_init__(self) -> None:
        super().__post_init__()
        if not isfinite(self.phase):
            raise InputError(f"{self.name} pulse: the phase must be a number of degrees, got {self.phase:g}")
        if not 1 < self.cycles <= 20:
            raise InputError(
                f"{self.name} pulse: the number of cycles must be above 1 and at most 20, got {self.cycles:g}"
            )

    @property
    def span(self) -> float:
        """Duration of the pulse in periods."""
        return self.cycles

    @property
    def velocity_amplitude(self) -> float:
        """A of the publication, half the height of the velocity's envelope [m/s]."""
        return self.amplitude * self.period / (pi * self.peak)

    def shape(self, x: Reals) -> Reals:
        """Return the normalised acceleration, as `Pulse.shape`."""
        return _raw(x - self.span / 2, self.phase, self.cycles) / self.peak

    def velocity_shape(self, x: Reals) -> Reals:
        """Return the normalised velocity, as `Pulse.velocity_shape`."""
        z = 2 * pi * (x - self.span / 2)
        curve: Reals = (1 + np.cos(z / self.cycles)) * np.cos(z + np.radians(self.phase)) / (2 * pi * self.peak)
        return curve

    @property
    def peak(self) -> float:
        """Largest acceleration divided by pi A/T."""
        return _peak(self.phase, self.cycles)

    def __str__(self) -> str:
        return f"{super().__str__()}:{self.phase:.6g}deg:{self.cycles:.6g}"


def _raw(x: Reals, phase: float, cycles: float) -> Reals:
    """Return the acceleration of a near-fault pulse over pi A/T, at times x from its middle, in periods."""
    z, nu = 2 * pi * x, np.radians(phase)
    bell = z / cycles
    curve: Reals = -(np.sin(bell) * np.cos(z + nu) / cycles + np.sin(z + nu) * (1 + np.cos(bell)))
    return curve


@lru_cache(maxsize=256)
def _peak(phase: float, cycles: float) -> float:
    """Return the largest absolute acceleration over pi A/T: by ever finer grids, and finally by a parabola."""
    grid = np.linspace(-cycles / 2, cycles / 2, ceil(100 * cycles) + 1)
    coarse = np.abs(_raw(grid, phase, cycles))
    # Some point of the grid lies within 1/200 period of the peak, so within 0.2 % of its value.
    candidates = grid[coarse > 0.995 * coarse.max(), None]
    y = np.abs(_raw(candidates + (grid[1] - grid[0]) * np.linspace(-1.0, 1.0, 41), phase, cycles))
    row, k = np.unravel_index(int(y[:, 1:-1].argmax()), (len(candidates), 39))
    a, b, c = y[row, k : k + 3].tolist()
    return float(b + (a - c) ** 2 / (8 * (2 * b - a - c)))

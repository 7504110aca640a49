"""Fit of a pulse (sine, Ricker or near-fault) to a record, by the share of the record's energy that it captures.

A pulse s is fitted to a record r, both in acceleration or both in velocity, by least squares: the fit maximises the
captured share of the record's energy, 1 - sum (r - s)^2 / sum r^2 over the samples. For a start and a period, the best
amplitude follows from linear least squares, and so does the phase of a near-fault pulse, which is a sum of its phases 0
and 90. Start, period and number of cycles are searched on a grid, by cross-correlation, and refined from the best
points by a simplex method. The ground is at rest before the record and after it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import ceil, floor, hypot, log
from typing import Literal, NamedTuple

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.pulses import Pulse
from rocking_cli.excitation.pulses.shapes import MavroeidisPapageorgiou, Ricker, Sine

Criterion = Literal["acceleration", "velocity"]

CRITERIA: tuple[Criterion, ...] = ("acceleration", "velocity")
FITTED: dict[str, type[Pulse]] = {"sine": Sine, "ricker": Ricker, "mavroeidis": MavroeidisPapageorgiou}
MIN_SAMPLES_PER_PERIOD = 10  # samples in the shortest period that is tried; the longest one is the length of the record
PERIODS_PER_OCTAVE = 10  # periods tried in an octave: they are 7 % apart
TRIED_CYCLES = (1.25, 1.7, 2.3, 3.1, 4.2)  # starting values for near-fault pulses
CYCLES_RANGE = (1.01, 6.0)  # the source defines no pulse of one cycle
MIN_DISTANCE = 0.25  # share of a period; starting points further apart are refined separately
MAX_REFINED = 4
# Tolerances of the refinement of every starting point, and of the best one, over a step of the grid.
ROUGH_TOLERANCE, FINE_TOLERANCE = 2e-2, 1e-6
SAMPLES_PER_PERIOD = (10, 40, 500)  # steps of the search: grid, every starting point, best starting point


@dataclass(frozen=True)
class PulseFit:
    """A pulse fitted to a record.

    Parameters
    ----------
    pulse : Pulse
        The pulse, with its shape, amplitude [m/s2] and period [s]; the phase of a near-fault pulse is above -90 and at
        most 90 degrees.
    start : float
        Start of the pulse [s] after the first sample of the record; the pulse may start before, and end after, the
        record.
    sign : int
        Sign of the pulse: 1 as given, -1 reversed.
    criterion : {"acceleration", "velocity"}
        Quantity in which the pulse was fitted.
    captured : float
        Share of the record's energy that the pulse captures, 1 - sum (r - s)^2 / sum r^2.
    """

    pulse: Pulse
    start: float
    sign: int
    criterion: Criterion
    captured: float

    @property
    def centre(self) -> float:
        """Middle of the pulse [s] after the first sample of the record."""
        return self.start + self.pulse.duration / 2

    def acceleration(self, t: Reals) -> Reals:
        """Return the ground acceleration of the pulse [m/s2] at times t [s] of the record."""
        return self.sign * self.pulse.acceleration(t - self.start)

    def velocity(self, t: Reals) -> Reals:
        """Return the ground velocity of the pulse [m/s] at times t [s] of the record."""
        return self.sign * self.pulse.velocity(t - self.start)

    def alone(self, motion: GroundMotion) -> GroundMotion:
        """Return the pulse as a ground motion at the samples of the record, without a vertical component."""
        name = f"{self.pulse} of {motion.name}"
        a = self.acceleration(np.arange(motion.npts, dtype=np.float64) * motion.dt)
        return replace(motion, name=name, acceleration=a, format="pulse", vertical=None, points=None)


def fit_pulse(motion: GroundMotion, shape: str, criterion: Criterion) -> PulseFit:
    """Return the pulse of a shape that captures the most energy of a record.

    Parameters
    ----------
    motion : GroundMotion
        The record.
    shape : {"sine", "ricker", "mavroeidis"}
        The family of pulses: any amplitude, sign, start, and period from ten samples to the length of the record; for
        `mavroeidis` any phase, and 1.01 to 6 cycles.
    criterion : {"acceleration", "velocity"}
        Whether the energy is that of the acceleration or that of the velocity. The velocity of a record starts from
        zero; if it drifts, the pulse is fitted to the drift too.

    Returns
    -------
    PulseFit

    Raises
    ------
    InputError
        If the record is zero throughout, or shorter than the shortest pulse.
    """
    return next(fit_pulses(motion, (shape,), (criterion,)))


def fit_pulses(
    motion: GroundMotion,
    shapes: Sequence[str] = tuple(FITTED),
    criteria: Sequence[Criterion] = CRITERIA,
) -> Iterator[PulseFit]:
    """Yield the best pulse for each criterion and shape, as soon as it is found.

    The arguments are those of `fit_pulse`.
    """
    for criterion in criteria:
        values = motion.velocity if criterion == "velocity" else motion.acceleration
        peak = float(np.abs(values).max())
        if peak == 0:
            raise InputError(Problem("the record is zero throughout, so it contains no pulse", motion.name))
        if motion.npts <= 2 * MIN_SAMPLES_PER_PERIOD:
            raise InputError(Problem(f"{motion.npts} samples are too few to find a pulse in", motion.name))
        search = _PulseSearch(values / peak, motion.dt, criterion == "velocity")
        for shape in shapes:
            place = search.best(shape)
            captured, weights = search.fit(shape, place)
            pulse, sign = _as_pulse(shape, place, peak * weights)
            yield PulseFit(pulse, place.start, sign, criterion, min(captured, 1.0))  # rounding may exceed 1


class _Place(NamedTuple):
    """Start [s] and period [s] of a pulse, and the number of cycles of a near-fault pulse."""

    start: float
    period: float
    cycles: float


def _parts(shape: str, period: float, cycles: float) -> list[Pulse]:
    """Return the pulses of unit amplitude whose sum, with weights, is a pulse of the shape."""
    if shape == "mavroeidis":
        return [MavroeidisPapageorgiou(1.0, period, phase, cycles) for phase in (0.0, 90.0)]
    return [FITTED[shape](1.0, period)]


def _as_pulse(shape: str, place: _Place, weights: Reals) -> tuple[Pulse, int]:
    """Return the pulse that is the weighted sum of its parts, with a positive amplitude, and its sign."""
    if shape != "mavroeidis":
        return FITTED[shape](abs(float(weights[0])), place.period), 1 if weights[0] > 0 else -1
    even, odd = (
        float(weight) / MavroeidisPapageorgiou(1.0, place.period, phase, place.cycles).peak
        for weight, phase in zip(weights, (0.0, 90.0), strict=True)
    )
    sign = 1 if even > 0 or (even == 0 and odd > 0) else -1
    phase = float(np.degrees(np.arctan2(sign * odd, sign * even)))
    amplitude = hypot(even, odd) * MavroeidisPapageorgiou(1.0, place.period, phase, place.cycles).peak
    return MavroeidisPapageorgiou(amplitude, place.period, phase, place.cycles), sign


class _PulseSearch:
    """Search for pulses in one record.

    Parameters
    ----------
    values : ndarray, shape (n,)
        Acceleration or velocity of the record, divided by its peak.
    dt : float
        Sampling interval [s].
    as_velocity : bool
        Whether the values are velocities.
    """

    def __init__(self, values: Reals, dt: float, as_velocity: bool) -> None:
        self.dt, self.as_velocity = dt, as_velocity
        self.energy = float(values @ values)
        self.shortest, self.longest = MIN_SAMPLES_PER_PERIOD * dt, (values.size - 1) * dt
        self.levels = [values]  # each level smooths the previous one and keeps every second sample
        while self.levels[-1].size > 2 * MIN_SAMPLES_PER_PERIOD:
            self.levels.append(np.convolve(self.levels[-1], [0.25, 0.5, 0.25])[1:-1:2])

    def level(self, period: float, enough: int) -> int:
        """Return the coarsest level of resampling with at least `enough` samples in a period."""
        return min(max(floor(log(period / self.dt / enough, 2) + 1e-9), 0), len(self.levels) - 1)

    def curve(self, pulse: Pulse, x: Reals) -> Reals:
        """Return the acceleration or velocity, as fitted, of a pulse at times x in periods."""
        return pulse.period * pulse.velocity_shape(x) if self.as_velocity else pulse.shape(x)

    def fit(self, shape: str, place: _Place, level: int = 0) -> tuple[float, Reals]:
        """Return the captured share of the energy, and the amplitudes of the parts over the record's peak."""
        values, dt = self.levels[level], self.dt * 2**level
        parts = _parts(shape, place.period, place.cycles)
        first, last = ceil(place.start / dt), floor((place.start + parts[0].duration) / dt)
        x: Reals = (np.arange(first, last + 1, dtype=np.float64) * dt - place.start) / place.period
        curves: Reals = np.stack([self.curve(part, np.clip(x, 0.0, parts[0].span)) for part in parts])
        inside = slice(max(-first, 0), max(values.size - first, 0))
        seen: Reals = curves[:, inside] @ values[max(first, 0) : max(last + 1, 0)]
        weights = np.linalg.solve(curves @ curves.T, seen).astype(np.float64)
        return float(seen @ weights) * 2**level / self.energy, weights

    def best(self, shape: str) -> _Place:
        """Return start, period and cycles at which the pulse captures the most energy."""
        _, place = max(
            self._refine(shape, place, 1.0, ROUGH_TOLERANCE, SAMPLES_PER_PERIOD[1]) for place in self._places(shape)
        )
        return self._refine(shape, place, ROUGH_TOLERANCE, FINE_TOLERANCE, SAMPLES_PER_PERIOD[2])[1]

    def _refine(self, shape: str, place: _Place, size: float, within: float, enough: int) -> tuple[float, _Place]:
        """Refine start, period and cycles by the simplex method; return the captured share and the result.

        The variables are the middle of the pulse and the logarithms of period and cycles, in steps of the grid. `size`
        is the size of the first simplex and `within` that of the last.
        """
        from scipy.optimize import minimize

        steps = np.array([1 / SAMPLES_PER_PERIOD[0] / 2, log(2) / PERIODS_PER_OCTAVE, 0.15])
        steps = steps[: 3 if shape == "mavroeidis" else 2]
        middle = _middle(shape, place)
        level = self.level(place.period, enough)

        def there(u: Reals) -> _Place:
            u = u * steps
            period, cycles = place.period * float(np.exp(u[1])), place.cycles * float(np.exp(u[2:].sum()))
            start = middle + float(u[0]) * place.period - _span(shape, cycles) * period / 2
            return _Place(start, period, cycles)

        def missed(u: Reals) -> float:
            here = there(u)
            # The pulse must lie on the record and be resolved by its samples.
            is_on_record = abs(u[1] * steps[1]) <= 1 and 0 <= _middle(shape, here) <= self.longest
            is_resolved = self.shortest <= here.period <= self.longest
            if not (is_on_record and is_resolved and CYCLES_RANGE[0] <= here.cycles <= CYCLES_RANGE[1]):
                return np.inf
            return -self.fit(shape, here, level)[0]

        corners = size * np.eye(steps.size + 1, steps.size, -1)
        options = {"initial_simplex": corners, "xatol": within, "fatol": np.inf}
        optimum = minimize(missed, corners[0], method="Nelder-Mead", options=options)
        return -float(optimum.fun), there(optimum.x)

    def _places(self, shape: str) -> list[_Place]:
        """Return the best points of a grid of start, period and cycles, without points near better ones."""
        periods = self.shortest * 2 ** np.arange(0.0, log(self.longest / self.shortest, 2), 1 / PERIODS_PER_OCTAVE)
        tried = TRIED_CYCLES if shape == "mavroeidis" else (2.0,)
        grid = [self._best_start(shape, period, cycles) for period in periods.tolist() for cycles in tried]
        chosen: list[_Place] = []
        for _, place in sorted(grid, reverse=True):
            if len(chosen) < MAX_REFINED and not any(_near(shape, place, other) for other in chosen):
                chosen.append(place)
        return chosen

    def _best_start(self, shape: str, period: float, cycles: float) -> tuple[float, _Place]:
        """Return the approximate captured share and the start of the best pulse of a period and cycles."""
        level = self.level(period, SAMPLES_PER_PERIOD[0])
        values, dt = self.levels[level], self.dt * 2**level
        parts = _parts(shape, period, cycles)
        half = floor(parts[0].duration / 2 / dt)
        x = parts[0].span / 2 + np.arange(-half, half + 1, dtype=np.float64) * (dt / period)
        captured = np.zeros(values.size)
        for part in parts:  # the even and the odd part are orthogonal
            curve = self.curve(part, x)
            captured += np.correlate(values, curve, "full")[half:-half] ** 2 / (curve @ curve)
        k = int(captured.argmax())  # the middle of the best pulse
        return float(captured[k]) * dt, _Place(k * dt - parts[0].duration / 2, period, cycles)


def _span(shape: str, cycles: float) -> float:
    """Return the duration of a pulse in periods."""
    return cycles if shape == "mavroeidis" else _parts(shape, 1.0, cycles)[0].span


def _middle(shape: str, place: _Place) -> float:
    """Return the time of the middle of a pulse [s]."""
    return place.start + _span(shape, place.cycles) * place.period / 2


def _near(shape: str, one: _Place, other: _Place) -> bool:
    """Return whether two points of the grid may belong to the same maximum."""
    between = abs(_middle(shape, one) - _middle(shape, other))
    return abs(log(one.period / other.period)) < MIN_DISTANCE and between < MIN_DISTANCE * max(one.period, other.period)

"""The response to pulses of every amplitude and period: a map of outcomes, and the least amplitude that overturns.

The boundaries of the map in closed form are those of the linear block.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import IntEnum
from functools import cached_property
from itertools import count
from math import pi

import numpy as np

from rocking_cli import names
from rocking_cli.arrays import Bools, Integers, Points, Reals
from rocking_cli.dynamics.outcome import Outcomes
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.excitation.pulses import Pulse
from rocking_cli.questions.overturning.edges import Edges, edges_of
from rocking_cli.short_repr import short_repr
from rocking_cli.studies.engines import EXACT
from rocking_cli.studies.under_pulses import Progress, PulsedModel, outcomes

SCAN_AMPLITUDES = 200  # amplitudes simulated together, as overturning has islands below amplitudes that do not overturn
MIN_SCAN_EXCESS = 1e-3  # a - 1 at the start of the scan
RESCAN_RATIO = 4  # a scan is repeated from the least a - 1 over this: islands crowd just below it
HALVINGS = 25  # halvings of the interval left by the scan, which has some thousandths of a - 1
USUAL_PASSES = 2  # scans that a search usually takes, for the estimate of progress
TIE_TOLERANCE = 1e-6  # relative difference of least amplitudes below which structures overturn together
USUAL_AMPLITUDES = 0.7, 10.0  # default range of a of logarithmic axes: from below uplift to far above it
LINEAR_AMPLITUDES = 0.5, 10.0  # that of linear axes
TRIED_OMEGAS, TRIED_AMPLITUDES = np.geomspace(1.0, 40.0, 24), 1 + np.geomspace(0.03, USUAL_AMPLITUDES[1] - 1, 40)
NEAR_UPLIFT = 1.2  # the longest period of a map is one at which the structure overturns from this a on
USUAL_OMEGAS = 1.0, 10.0  # range of omega_g/p of a map if no pulse tried overturns the structure
CONTOUR_LEVELS = (0.1, 0.25, 0.5, 0.75)  # phi/phi_cr of the contours
MAX_PARAMETER = 1e6  # largest a, omega and 1/omega: slower pulses would be simulated for ever


class Region(IntEnum):
    """Outcome of a structure under a pulse."""

    NO_UPLIFT = 0
    ROCKS = 1
    AFTER_IMPACT = 2
    WITHOUT_IMPACT = 3
    UNKNOWN = 4

    @property
    def label(self) -> str:
        """The outcome in words."""
        return (
            names.NO_UPLIFT,
            names.ROCKS,
            f"{names.OVERTURNS} after impact",
            f"{names.OVERTURNS} without impact",
            names.UNKNOWN,
        )[self]


FALLS = Region.AFTER_IMPACT, Region.WITHOUT_IMPACT


class OutcomeKind(IntEnum):
    """A region of a plotted map, in which overturning after one impact is apart; the worse, the higher."""

    NO_UPLIFT = 0
    ROCKS = 1
    AFTER_ONE = 2
    AFTER_MORE = 3
    WITHOUT_IMPACT = 4
    UNKNOWN = 5


def _kinds(found: Outcomes) -> Integers:
    """Return the `OutcomeKind` of outcomes, as integers."""
    stays = np.where(found.peak_ratio > 0, OutcomeKind.ROCKS, OutcomeKind.NO_UPLIFT)
    falls = np.array([OutcomeKind.WITHOUT_IMPACT, OutcomeKind.AFTER_ONE, OutcomeKind.AFTER_MORE])[
        np.minimum(found.impact_count, 2)
    ]
    return np.where(found.fell, falls, np.where(found.unknown, OutcomeKind.UNKNOWN, stays))


@short_repr
@dataclass(frozen=True, eq=False)
class OverturningMap:
    """Outcomes of a structure in a plane of pulses: rows of one amplitude, columns of one period.

    Parameters
    ----------
    structure : PulsedModel
        The model of the structure.
    shape : Pulse
        The shape of the pulses.
    polarities : tuple of int
        The polarities, 1, -1 or both; of both, the worse governs.
    omega : ndarray, shape (n,)
        Dimensionless frequency omega_g/p of each column.
    a : ndarray, shape (m,)
        Dimensionless amplitude a_g/(g lambda) of each row.
    outcome : Outcome
        The outcomes at each point, shape (m, n).
    """

    structure: PulsedModel
    shape: Pulse
    polarities: tuple[int, ...]
    omega: Reals
    a: Reals
    outcome: Outcomes

    @property
    def periods(self) -> Reals:
        """Pulse periods of the columns [s]; for the dimensionless block, p times the period."""
        return self.structure.period(self.omega)

    @property
    def ag(self) -> Reals:
        """Pulse amplitudes of the rows [standard gravity]."""
        return self.a * self.structure.unit / STANDARD_GRAVITY

    @cached_property
    def regions(self) -> Integers:
        """The `Region` of each point, as integers, shape (m, n)."""
        return self.kinds - (self.kinds >= OutcomeKind.AFTER_MORE)

    @cached_property
    def kinds(self) -> Integers:
        """The `OutcomeKind` of each point, as integers, shape (m, n)."""
        return _kinds(self.outcome)

    @cached_property
    def edges(self) -> Edges:
        """Edges between the kinds, and contours of the peak; the first use simulates further pulses near the edges.

        With free blocks, which take long, edges are half way between the points.
        """

        def simulated(places: Points) -> Integers:
            if self.structure.engine is not EXACT:
                nearest: Integers = self.kinds[np.rint(places.imag).astype(int), np.rint(places.real).astype(int)]
                return nearest
            omega, a = self.at(places)
            return _kinds(
                outcomes(
                    self.structure, self.shape, self.structure.period(omega), a * self.structure.unit,
                    polarities=self.polarities,
                )
            )  # fmt: skip

        return edges_of(
            self.kinds,
            simulated,
            self.outcome.peak_ratio,
            CONTOUR_LEVELS,
            falls=OutcomeKind.AFTER_ONE,
            unknown=OutcomeKind.UNKNOWN,
        )  # fmt: skip

    def at(self, places: Points) -> tuple[Reals, Reals]:
        """Return omega and a at columns u and rows v, fractions included, given as u + iv."""
        columns, rows = np.arange(self.omega.size), np.arange(self.a.size)
        return np.interp(places.real, columns, self.omega), np.interp(places.imag, rows, self.a)

    @property
    def shares(self) -> dict[Region, float]:
        """The share of the points in each region, which depends on the axes; the shares add up to 1."""
        counts = np.bincount(self.regions.ravel(), minlength=len(Region))
        return {region: float(counts[region] / self.regions.size) for region in Region}

    def least(self, *regions: Region) -> Reals:
        """Return the least a of a point in some regions, for each column; NaN if there is none."""
        mask = np.isin(self.regions, regions)
        return np.where(mask.any(axis=0), self.a[mask.argmax(axis=0)], np.nan)

    @property
    def safe_again(self) -> Reals:
        """The largest a that is known not to overturn above one that does, for each column; NaN if there is none."""
        falls = self.outcome.fell
        above = np.maximum.accumulate(falls, axis=0) & ~falls & ~self.outcome.unknown
        last = len(self.a) - 1 - above[::-1].argmax(axis=0)
        return np.where(above.any(axis=0), self.a[last], np.nan)

    @property
    def boundaries(self) -> list[Boundary]:
        """Boundaries known in closed form: uplift, and further ones of the pulse for a symmetric linear model."""
        if self.structure.model.is_linear and self.structure.symmetric:
            return boundaries(self.shape, self.structure.eta)
        return [UPLIFT]


def overturning_map(
    structure: PulsedModel,
    shape: Pulse,
    omega: Reals,
    a: Reals,
    *,
    polarities: Sequence[int] = (1,),
    progress: Progress | None = None,
) -> OverturningMap:
    """Simulate a structure under pulses of every combination of omega and a.

    Parameters
    ----------
    structure : PulsedModel
        The model of the structure; see `linear_block` and `pulsed_model`.
    shape : Pulse
        The shape of the pulses; see `parse_shape`.
    omega, a : ndarray
        Dimensionless frequencies and amplitudes [paper, Eq. 40], a increasing.
    polarities : sequence of int
        The polarities, 1, -1 or both; of both, the worse governs.
    progress : callable, optional
        Called with the number of histories done since the last call; `count_histories(...)` is their total.

    Raises
    ------
    InputError
        If a number is not positive.
    """
    if not ((omega > 0).all() and (a > 0).all()):
        raise InputError("omega and a must be positive")
    _check_range(structure, structure.period(omega), float(a.max()))
    periods, amplitudes = (each.ravel() for each in np.meshgrid(structure.period(omega), a * structure.unit))
    simulated = outcomes(structure, shape, periods, amplitudes, polarities=polarities, progress=progress)
    plane = a.size, omega.size
    return OverturningMap(
        structure,
        shape,
        tuple(polarities),
        omega,
        a,
        simulated.by_field(lambda values: values.reshape(plane)),
    )


def usual_omegas(structure: PulsedModel, shape: Pulse, polarities: Sequence[int] = (1,)) -> tuple[float, float]:
    """Return the default range of omega_g/p for a structure, found by simulating a few pulses of all frequencies.

    The fastest pulses of the range are just too fast to overturn the structure at the largest default amplitude; the
    slowest overturn it soon above uplift. If none overturns, this is the range of unknown outcomes.
    """
    omega, a = (each.ravel() for each in np.meshgrid(TRIED_OMEGAS, TRIED_AMPLITUDES))
    tried = outcomes(structure, shape, structure.period(omega), a * structure.unit, polarities=polarities)
    falls = (tried.fell if tried.fell.any() else tried.unknown).reshape(TRIED_AMPLITUDES.size, -1)
    if not falls.any():
        return USUAL_OMEGAS
    least = np.where(falls.any(axis=0), TRIED_AMPLITUDES[falls.argmax(axis=0)], np.inf)
    last = int(np.flatnonzero(np.isfinite(least))[-1])
    first = min(int((least > NEAR_UPLIFT).argmax()), last)
    return _round(TRIED_OMEGAS[first]), _round(TRIED_OMEGAS[min(last + 1, TRIED_OMEGAS.size - 1)])


def usual_periods(
    structures: Sequence[PulsedModel], shape: Pulse, polarities: Sequence[int] = (1,)
) -> tuple[float, float]:
    """Return the default range of pulse periods for some structures [s]; see `usual_omegas`."""
    periods = [each.period(np.array(usual_omegas(each, shape, polarities))).tolist() for each in structures]
    slowest, fastest = zip(*periods, strict=True)
    return _round(min(fastest)), _round(max(slowest))


def usual_amplitudes(structures: Sequence[PulsedModel]) -> tuple[float, float]:
    """Return the default range of pulse amplitudes, from below uplift to far above it [standard gravity]."""
    units = [each.unit / STANDARD_GRAVITY for each in structures]
    return _round(USUAL_AMPLITUDES[0] * min(units)), _round(USUAL_AMPLITUDES[1] * max(units))


def _round(value: float) -> float:
    return float(f"{value:.2g}")


def _check_range(structure: PulsedModel, periods: Reals, a: float) -> None:
    """Raise `InputError` if pulses are beyond the range of omega or of a that can be computed."""
    low, high = (structure.period(np.array(omega)).item() for omega in (MAX_PARAMETER, 1 / MAX_PARAMETER))
    if not (low <= periods.min() and periods.max() <= high):
        raise InputError(
            f"{structure.name}: pulses from {periods.min():.4g} to {periods.max():.4g} s have omega = omega_g/p from "
            f"{structure.period(periods.max()):.4g} to {structure.period(periods.min()):.4g}: it must be from "
            f"{1 / MAX_PARAMETER:g} to {MAX_PARAMETER:g}, periods from {low:.4g} to {high:.4g} s"
        )
    if a > MAX_PARAMETER:
        raise InputError(f"{structure.name}: a = a_g/(g lambda) up to {a:.4g}: it must be at most {MAX_PARAMETER:g}")


@short_repr
@dataclass(frozen=True, eq=False)
class Comparison:
    """The least pulse amplitude that overturns each of several structures, at each period.

    Parameters
    ----------
    structures : tuple of PulsedModel
        The models of the structures.
    shape : Pulse
        The shape of the pulses.
    polarities : tuple of int
        The polarities, 1, -1 or both; of both, either may overturn.
    periods : ndarray, shape (n,)
        Periods of the pulses [s].
    least : ndarray, shape (k, n)
        The least amplitude known to overturn each structure [standard gravity]; NaN if there is none up to `top`.
    possible : ndarray, shape (k, n)
        The least amplitude that overturns each structure or has an unknown outcome; equal to `least` if none is unknown
        below.
    top : float
        The largest amplitude tried [standard gravity].
    """

    structures: tuple[PulsedModel, ...]
    shape: Pulse
    polarities: tuple[int, ...]
    periods: Reals
    least: Reals
    possible: Reals
    top: float

    @property
    def doubtful(self) -> Bools:
        """Whether outcomes are unknown between `possible` and `least`, so that `least` is not certain, shape (k, n)."""
        doubtful: Bools = np.isfinite(self.possible) & ~(self.possible >= self.least)
        return doubtful

    @property
    def firsts(self) -> Bools:
        """Whether a structure is known to overturn first at a period, shape (k, n); several if they are equal."""
        least, possible = (np.where(np.isnan(each), np.inf, each) for each in (self.least, self.possible))
        lowest = [np.delete(possible, k, axis=0).min(axis=0, initial=np.inf) for k in range(len(least))]
        first: Bools = np.isfinite(least) & (least <= np.array(lowest) * (1 + TIE_TOLERANCE))
        return first

    @property
    def undecided(self) -> Bools:
        """Whether it is unknown which structure overturns first at a period, or whether any does, shape (n,)."""
        may, known = np.isfinite(self.possible), self.firsts
        return np.array([each.any() and not sure.any() for each, sure in zip(may.T, known.T, strict=True)], np.bool_)


def compare(
    structures: Sequence[PulsedModel],
    shape: Pulse,
    periods: Reals,
    top: float,
    *,
    polarities: Sequence[int] = (1,),
    progress: Progress | None = None,
) -> Comparison:
    """Find the least amplitude that overturns each structure, for each period.

    Parameters
    ----------
    structures : sequence of PulsedModel
        The models of the structures.
    shape : Pulse
        The shape of the pulses.
    periods : ndarray
        Periods of the pulses [s].
    top : float
        The largest amplitude to try [standard gravity].
    polarities : sequence of int
        The polarities: 1, -1 or both.
    progress : callable, optional
        Called with the number of histories done since the last call; `count_scans(...)` estimates their total.

    Notes
    -----
    The search tries amplitudes from uplift to the largest at equal ratios of a - 1, then as many just below the least
    that overturns, until it finds no lower one; it then bisects the remaining interval. An island of overturning
    narrower than a step, 0.7 % of a - 1, may be missed. If joints may open, a second search below the amplitude found
    looks for the least amplitude that overturns or has an unknown outcome.
    """
    for structure in structures:
        _check_range(structure, periods, top * STANDARD_GRAVITY / structure.unit)
    amplitudes = [_least(structure, shape, periods, top, polarities, progress) for structure in structures]
    least, possible = (np.array(rows) / STANDARD_GRAVITY for rows in zip(*amplitudes, strict=True))
    return Comparison(tuple(structures), shape, tuple(polarities), periods, least, possible, top)


def _least(
    structure: PulsedModel,
    shape: Pulse,
    periods: Reals,
    top: float,
    polarities: Sequence[int],
    progress: Progress | None,
) -> tuple[Reals, Reals]:
    """Return for each period the least amplitude known to overturn, and the least that may overturn [m/s2]."""
    beyond = np.full(periods.size, top * STANDARD_GRAVITY / structure.unit - 1)  # a - 1 at the end of the search
    search = _OverturningSearch(structure, shape, periods, polarities, progress)
    least = search.least(beyond, np.full(periods.size, np.nan), lambda tried: tried.fell)
    possible = least
    if structure.may_open:
        possible = search.least(np.fmin(least, beyond), least, lambda tried: tried.fell | tried.unknown)
        possible = np.where(possible >= least * (1 - TIE_TOLERANCE), least, possible)
    return (1 + least) * structure.unit, (1 + possible) * structure.unit


@dataclass(frozen=True, eq=False)
class _OverturningSearch:
    """The search for least amplitudes of pulses on a structure."""

    structure: PulsedModel
    shape: Pulse
    periods: Reals
    polarities: Sequence[int]
    progress: Progress | None

    def least(self, beyond: Reals, high: Reals, counts: Callable[[Outcomes], Bools]) -> Reals:
        """Return for each period the least a - 1 whose outcome the function `counts` accepts; NaN if there is none.

        The search goes up to `beyond`; `high` is an a - 1 that is known to be accepted, equal to `beyond`, or NaN.
        """
        beyond, high, low = beyond.copy(), high.copy(), np.zeros(self.periods.size)
        open_periods = np.flatnonzero(beyond > 0)
        for turn in count():
            if not open_periods.size:
                break
            nearest = beyond[open_periods] / RESCAN_RATIO
            start = (np.minimum(MIN_SCAN_EXCESS, nearest) if turn == 0 else nearest)[:, None]
            scan = start * (beyond[open_periods, None] / start) ** np.linspace(0, 1, SCAN_AMPLITUDES)
            shaken = self._shaken(
                np.repeat(self.periods[open_periods], SCAN_AMPLITUDES), scan.ravel(), report=turn < USUAL_PASSES
            )
            falls = counts(shaken).reshape(scan.shape).copy()
            falls[:, -1] |= np.isfinite(high[open_periods])  # an amplitude known to overturn
            some = falls.any(axis=1)
            open_periods, scan, first = open_periods[some], scan[some], falls[some].argmax(axis=1)
            row = np.arange(open_periods.size)
            low[open_periods] = np.where(first > 0, scan[row, np.maximum(first - 1, 0)], 0.0)
            high[open_periods] = beyond[open_periods] = scan[row, first]
            open_periods = open_periods[
                (first < SCAN_AMPLITUDES - 1) & (high[open_periods] > TIE_TOLERANCE)
            ]  # no amplitude below uplift overturns
        some = np.isfinite(high)
        for _ in range(HALVINGS if some.any() else 0):
            middle = (low + high) / 2
            fell = np.zeros(self.periods.size, dtype=np.bool_)
            fell[some] = counts(self._shaken(self.periods[some], middle[some]))
            high, low = np.where(fell, middle, high), np.where(fell, low, middle)
        return high

    def _shaken(self, periods: Reals, above: Reals, *, report: bool = False) -> Outcomes:
        """Simulate the structure under pulses of given periods [s] and a - 1."""
        return outcomes(
            self.structure,
            self.shape,
            periods,
            (1 + above) * self.structure.unit,
            polarities=self.polarities,
            progress=self.progress if report else None,
        )


def count_histories(structures: Sequence[PulsedModel], pulses: int, polarities: Sequence[int]) -> int:
    """Return the number of histories that a number of pulses on each structure takes."""
    return pulses * sum(1 if each.symmetric else len(polarities) for each in structures)


def count_scans(structures: Sequence[PulsedModel], periods: int, polarities: Sequence[int]) -> int:
    """Estimate the number of histories that `compare` takes: two scans of each period for each search."""
    scans = SCAN_AMPLITUDES * USUAL_PASSES * periods
    return sum(count_histories([each], scans * (1 + each.may_open), polarities) for each in structures)


@short_repr
@dataclass(frozen=True)
class Boundary:
    """A boundary in the plane of omega and a.

    Parameters
    ----------
    name : str
        `uplift`, `without_impact`, `after_one_impact` or `impact_at_end`.
    title : str
        The outcomes that the boundary separates, in words.
    level : callable
        Function of omega and a, arrays of one shape: zero on the boundary, positive above it, NaN where it is not
        valid.
    """

    name: str
    title: str
    level: Callable[[Reals, Reals], Reals]


UPLIFT = Boundary("uplift", "uplift", lambda omega, a: a - 1 + 0 * omega)


def boundaries(shape: Pulse, eta: float) -> list[Boundary]:
    """Return the boundaries of the linear block that are known in closed form for a pulse shape.

    Uplift is known for every shape, the others only for a shape that is a single sine or a single constant.

    Parameters
    ----------
    shape : Pulse
        Any pulse of the shape.
    eta : float
        Coefficient of restitution.
    """
    pieces = shape.segments()
    if len(pieces) != 1:
        return [UPLIFT]
    end = _end_of(shape)

    def without_impact(omega: Reals, a: Reals) -> Reals:
        y, _, _ = end(omega, a)
        return y

    def impact_at_end(omega: Reals, a: Reals) -> Reals:
        y, _, x = end(omega, a)
        return np.where(y < 0, x, np.nan)

    def after_one_impact(omega: Reals, a: Reals) -> Reals:
        y, yz, x = end(omega, a)
        level: Reals = np.where((y < 0) & (x >= 0), eta**2 * (1 + yz) - 1, np.nan)  # Eqs. 41-42
        return level

    return [
        UPLIFT,
        Boundary("without_impact", "overturning without impact", without_impact),
        Boundary("after_one_impact", "overturning after one impact", after_one_impact),
        Boundary("impact_at_end", "first impact at the end of the pulse", impact_at_end),
    ]


def _end_of(shape: Pulse) -> Callable[[Reals, Reals], tuple[Reals, Reals, Reals]]:
    """Return the motion of the linear block at the end of a pulse, ignoring impacts before it.

    It is a function of omega and a, which returns y exp(-tau_e), y z and x at the end of the pulse, tau_e, with y and z
    as in the module; NaN if the block does not uplift.
    """
    (piece,) = shape.segments()
    turns, periods = piece.omega * shape.duration, shape.duration / shape.period  # phase [rad] and number of periods

    def end(omega: Reals, a: Reals) -> tuple[Reals, Reals, Reals]:
        with np.errstate(invalid="ignore", over="ignore", divide="ignore"):
            a = np.where(a > 1, a, np.nan)
            theta_0 = np.maximum(np.arcsin(1 / a), piece.phase)
            theta_e = piece.phase + turns
            rate = omega if turns > 0 else np.zeros_like(omega)
            tau_e = (theta_e - theta_0) / omega if turns > 0 else 2 * pi * periods / omega
            c = a / (1 + rate**2)
            sin_0, cos_0, sin_e, cos_e = np.sin(theta_0), np.cos(theta_0), np.sin(theta_e), np.cos(theta_e)
            y = c * (sin_0 + rate * cos_0 - np.exp(-tau_e) * (sin_e + rate * cos_e)) - 1
            z = np.exp(-tau_e) * (1 - c * (sin_0 - rate * cos_0)) + c * (sin_e - rate * cos_e)
            grown = np.exp(tau_e) * y
            return y, grown * z, 1 + (grown - z) / 2

    return end

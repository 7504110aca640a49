"""Selection of a set of records, each with a factor, whose mean spectrum lies within limits about a target in a band.

Each record has the factor that makes it equal to the target on logarithmic average over the band, times a common
factor. The best set is the one that exceeds the limits least; of sets within the limits, the one whose mean is nearest
to the target: least root mean square of ln(mean/target). `subsets` finds it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import ceil, log

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Bools, Reals
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.processing.oscillator import DAMPING, response_spectrum
from rocking_cli.questions.select import subsets
from rocking_cli.questions.select.asked import FACTOR_LIMITS, MEAN_LIMITS
from rocking_cli.questions.select.target_spectrum import TargetSpectrum
from rocking_cli.short_repr import short_repr

PERIOD_SPACING = (0.01, 0.05)  # bounds of the step of ln T: the damping ratio is half the width of a resonance
MIN_BAND_PERIODS = 50
MAX_TARGET_PERIODS = 100  # periods of the target within the band that are added, if there are no more
PERIOD_TOLERANCE = 1e-6  # relative difference of equal periods
MIN_SAMPLES_PER_PERIOD = 4  # samples of a record in a period, for the record to resolve it


@dataclass(frozen=True)
class SetRequirements:
    """Requirements on a set of records.

    Parameters
    ----------
    count : int
        Number of records.
    band : (float, float)
        Shortest and longest period of the band [s].
    within : (float, float)
        Limits on mean/target.
    damping : float
        Damping ratio of the spectra: that of the target.
    factors : (float, float)
        Limits on the factor of each record.
    one_per : {"event", "station", "none"}
        The kind of origin from which there may be at most one record.
    same_factor : bool
        Whether all records have the same factor.
    seed : int
        Seed of the random searches, used if there are too many sets to try all.
    """

    count: int
    band: tuple[float, float]
    within: tuple[float, float] = MEAN_LIMITS
    damping: float = DAMPING
    factors: tuple[float, float] = FACTOR_LIMITS
    one_per: str = "event"
    same_factor: bool = False
    seed: int = 0


@short_repr
@dataclass(frozen=True, eq=False)
class Candidates:
    """Records to choose from, and their spectra.

    Parameters
    ----------
    motions : sequence of GroundMotion
        The records as read.
    periods : ndarray, shape (n,)
        Periods at equal ratios over the band, and those of the target inside it [s].
    target : ndarray, shape (n,)
        Ordinates of the target at these periods [standard gravity].
    spectra : ndarray, shape (motions, n)
        Pseudo-accelerations of the motions at these periods [standard gravity].
    """

    motions: Sequence[GroundMotion]
    periods: Reals
    target: Reals
    spectra: Reals


@short_repr
@dataclass(frozen=True, eq=False)
class RecordSet:
    """The best set of records that was found, whether or not it fits.

    Parameters
    ----------
    wanted : SetRequirements
        The requirements.
    candidates : Candidates
        The candidates.
    chosen : ndarray of int, shape (count,)
        Indices of the chosen candidates, increasing.
    factors : ndarray, shape (count,)
        Scale factor of each chosen record.
    left_out : mapping of int to (float or None)
        Candidates that could not be chosen, with the factor that they need; None if they do not move in the band.
    silent : int
        Number of candidates without event, or station: each counts as an event, or station, of its own.
    sets : int
        Number of possible sets.
    exact : bool
        Whether all sets were tried; otherwise this is the best set of several searches.
    """

    wanted: SetRequirements
    candidates: Candidates
    chosen: NDArray[np.intp]
    factors: Reals
    left_out: dict[int, float | None]
    silent: int
    sets: int
    exact: bool

    @property
    def motions(self) -> list[GroundMotion]:
        """The records of the set, scaled."""
        return [
            self.candidates.motions[k].scaled(factor)
            for k, factor in zip(self.chosen.tolist(), self.factors.tolist(), strict=True)
        ]

    @property
    def spectra(self) -> Reals:
        """Pseudo-accelerations of the scaled records, shape (count, n) [standard gravity]."""
        return self.factors[:, None] * self.candidates.spectra[self.chosen]

    @property
    def mean(self) -> Reals:
        """Mean of the spectra, shape (n,) [standard gravity]."""
        return np.asarray(self.spectra.mean(axis=0))

    @property
    def ratio(self) -> Reals:
        """Ratio of the mean spectrum to the target, shape (n,)."""
        return self.mean / self.candidates.target

    @property
    def too_low(self) -> Bools:
        """Mask of the periods at which the mean is below the lower limit by more than rounding, shape (n,)."""
        return self.ratio < self.wanted.within[0] * (1 - subsets.MISFIT_TOLERANCE)

    @property
    def too_high(self) -> Bools:
        """Mask of the periods at which the mean is above the upper limit by more than rounding, shape (n,)."""
        return self.ratio > self.wanted.within[1] * (1 + subsets.MISFIT_TOLERANCE)

    @property
    def fits(self) -> bool:
        """Whether the mean lies within the limits over the whole band."""
        return not (self.too_low | self.too_high).any()


def candidates(
    motions: Sequence[GroundMotion],
    target: TargetSpectrum,
    wanted: SetRequirements,
    progress: Callable[[int], object] = lambda done: None,
) -> Candidates:
    """Compute the spectra of records over the band of a target.

    Parameters
    ----------
    motions : sequence of GroundMotion
        The records, as read.
    target : TargetSpectrum
        The target.
    wanted : SetRequirements
        The band and the damping.
    progress : callable, optional
        Called with 1 after each record.

    Raises
    ------
    InputError
        If the target does not cover the band, or vanishes in it, or there are too few records of different events or
        stations.
    """
    target.check(wanted.band)
    names = [key_of(motion, wanted.one_per) for motion in motions]
    # Check the numbers of records before long computations.
    _check_enough(len(motions), len(motions), int(_groups(names).max(initial=-1)) + 1, wanted)
    periods = periods_of(wanted.band, target, wanted.damping)
    spectra = np.zeros((len(motions), periods.size))
    for k, motion in enumerate(motions):
        spectra[k] = response_spectrum(motion, periods, wanted.damping).sa
        progress(1)
    return Candidates(motions, periods, target.at(periods), spectra)


def periods_of(band: tuple[float, float], target: TargetSpectrum, damping: float = DAMPING) -> Reals:
    """Return periods [s] at equal ratios over a band, with those of the target inside it unless they are too many."""
    spacing = min(max(damping, PERIOD_SPACING[0]), PERIOD_SPACING[1])
    count = max(MIN_BAND_PERIODS, ceil(log(band[1] / band[0]) / spacing) + 1)
    periods = np.geomspace(*band, count)
    periods[[0, -1]] = band
    target_periods = target.periods[(target.periods > band[0]) & (target.periods < band[1])]
    if target_periods.size > MAX_TARGET_PERIODS:
        count += MAX_TARGET_PERIODS
        return np.concatenate([band[:1], np.geomspace(*band, count)[1:-1], band[1:]])
    # Of equal periods that of the target is kept, as its slope changes there, but the ends of the band stay.
    away = np.abs(periods[1:-1, None] / target_periods - 1).min(axis=1, initial=1.0) > PERIOD_TOLERANCE
    target_periods = target_periods[
        (target_periods > band[0] * (1 + PERIOD_TOLERANCE)) & (target_periods < band[1] * (1 - PERIOD_TOLERANCE))
    ]
    return np.sort(np.concatenate([periods[:1], periods[1:-1][away], target_periods, periods[-1:]]))


def choose(
    found: Candidates,
    wanted: SetRequirements,
    begin: Callable[[int], Callable[[int], object]] = lambda steps: lambda done: None,
) -> RecordSet:
    """Choose the records and their factors.

    Parameters
    ----------
    found : Candidates
        The candidates.
    wanted : SetRequirements
        The requirements on the set.
    begin : callable, optional
        Called with the number of sets, or of searches; returns a function that is called with the number of those done
        since its last call.

    Returns
    -------
    RecordSet
        The best of all sets, or the best that was found; it may violate the limits.

    Raises
    ------
    InputError
        If there are not as many records that can be chosen, of different events or stations.
    """
    factors, left_out = own_factors(found, wanted)
    usable = np.array([k for k in range(len(found.motions)) if k not in left_out], dtype=np.intp)
    names = [key_of(motion, wanted.one_per) for motion in found.motions]
    groups = _groups([names[k] for k in usable.tolist()])
    _check_enough(len(found.motions), usable.size, int(groups.max(initial=-1)) + 1, wanted)
    problem = subsets.SubsetProblem(
        factors[usable, None] * found.spectra[usable] / found.target,
        log_weights(found.periods),
        np.log(factors[usable]),
        groups,
        wanted.count,
        wanted.within,
        wanted.factors,
    )
    best = subsets.best(problem, wanted.seed, begin(problem.steps))
    chosen = usable[best.members]
    silent = sum(name is None for name in names) if wanted.one_per != "none" else 0
    sets, exact = subsets.count_sets(groups, wanted.count), subsets.all_tried(groups, wanted.count)
    return RecordSet(wanted, found, chosen, factors[chosen] * best.common, left_out, silent, sets, exact)


def own_factors(found: Candidates, wanted: SetRequirements) -> tuple[Reals, dict[int, float | None]]:
    """Return the factor that scales each record to the target on logarithmic average, and what others would need.

    All factors are 1 if the records must have the same factor.
    """
    left_out: dict[int, float | None] = {}
    factors = np.ones(len(found.motions))
    low, high = wanted.factors
    for k, spectrum in enumerate(found.spectra):
        if not (spectrum > 0).all():
            left_out[k] = None
        elif not wanted.same_factor:
            factor = float(np.exp(log_weights(found.periods) @ np.log(found.target / spectrum)))
            if low * (1 - subsets.MISFIT_TOLERANCE) <= factor <= high * (1 + subsets.MISFIT_TOLERANCE):
                factors[k] = min(max(factor, low), high)
            else:
                left_out[k] = factor
    return factors, left_out


def log_weights(periods: Reals) -> Reals:
    """Return trapezoidal weights of a mean over ln T, of sum 1, so that close points of the target weigh no more."""
    steps = np.diff(np.log(periods))
    weights = np.zeros(periods.size)
    weights[:-1] += steps / 2
    weights[1:] += steps / 2
    return np.asarray(weights / weights.sum())


def key_of(motion: GroundMotion, one_per: str) -> str | None:
    """Return the event or station of which a set may have only one record; None if the file does not state it."""
    origin = {"event": motion.origin.event, "station": motion.origin.station}.get(one_per)
    return " ".join(origin.casefold().split()) if origin is not None else None


def coarse(found: Candidates) -> list[GroundMotion]:
    """Return the records whose sampling interval is too long for the shortest period of the band."""
    return [motion for motion in found.motions if found.periods[0] < MIN_SAMPLES_PER_PERIOD * motion.dt * (1 - 1e-9)]


def _groups(names: Sequence[str | None]) -> NDArray[np.intp]:
    """Return a number for each record, equal for records of one name; numbers count from 0 in order of appearance."""
    numbers: dict[object, int] = {}
    return np.array(
        [numbers.setdefault(name if name is not None else k, len(numbers)) for k, name in enumerate(names)],
        dtype=np.intp,
    )


def _check_enough(given: int, usable: int, groups: int, wanted: SetRequirements) -> None:
    if wanted.count <= groups:
        return
    one = f", and one per {wanted.one_per} leaves {groups}" if groups < usable else ""
    out = f", of which {usable} can be scaled to the target within {wanted.factors[0]:g} to {wanted.factors[1]:g}"
    there = f"{given} {'record is' if given == 1 else 'records are'} available"
    sentence = f"a set of {wanted.count} was requested, but {there}"
    message = f"{sentence}{out if usable < given else ''}{one}"
    hints = [f"give more records, or a smaller {named('count')}"]
    hints += [f"wider limits with {named('factors')}"] if usable < given and usable < wanted.count else []
    hints += [f"{named('one_per')} none"] if groups < usable and wanted.count <= usable else []
    raise InputError(Problem(message, field=named("count"), hint=", or ".join(hints)))

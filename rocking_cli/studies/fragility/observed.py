"""Runs as they were observed: which have one intensity, what part of them exceeds, and how many records say so."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rocking_cli.errors import InputError
from rocking_cli.studies.fragility.likelihood import Bools, Integers, Reals

SAME = 1e-9  # relative difference of intensities that are one: rounding is far below it, shaking far above
A_STRIPE = 5  # records at one intensity, on average, from which on intensities are looked at one by one
GROUPS = 10  # of runs otherwise
FEW = 20  # records below which intervals may hold less often than they say; docs/fragility.md has the trials


@dataclass(frozen=True, eq=False)
class Observations:
    """Which runs exceed a limit state.

    Parameters
    ----------
    x : ndarray, shape (n,)
        Intensity of each run, positive. Those that differ by rounding alone are made one.
    exceeded : ndarray of bool, shape (n,)
        Whether it exceeds the limit state.
    record : ndarray of int, shape (n,)
        The record it belongs to: runs of one record are not independent.
    level : ndarray of int, shape (n,), optional
        The level to which it was scaled, where that decides its intensity.

    Raises
    ------
    InputError
        If an intensity is not a positive number, runs of one level have several, or there are no runs.
    """

    x: Reals
    exceeded: Bools
    record: Integers
    level: Integers | None = None

    def __post_init__(self) -> None:
        if not self.x.size == self.exceeded.size == self.record.size:
            raise InputError(f"{self.x.size} intensities, {self.exceeded.size} outcomes, {self.record.size} records")
        if not self.x.size:
            raise InputError("a fragility curve needs runs, and there are none")
        wrong = ~((self.x > 0) & np.isfinite(self.x))
        if wrong.any():
            k = int(wrong.argmax())
            raise InputError(
                f"the intensity of run {k} (record {self.record[k]}) is {self.x[k]:g}: a curve over its logarithm "
                "needs positive ones; leave out records without shaking"
            )
        x = self.x if self.level is None else _of_levels(self.x, self.level)
        object.__setattr__(self, "x", one_of_each(x))

    @cached_property
    def place(self) -> Integers:
        """The place of each run's intensity among the different ones, from the lowest."""
        return np.unique(self.x, return_inverse=True)[1].astype(np.int64)

    @cached_property
    def who(self) -> Integers:
        """The record of each run, numbered from 0."""
        return np.unique(self.record, return_inverse=True)[1].astype(np.int64)

    @property
    def records(self) -> int:
        """How many different records there are."""
        return int(self.who.max()) + 1

    @property
    def repeated(self) -> bool:
        """Whether a record has several runs."""
        return self.records < self.x.size

    @cached_property
    def _told(self) -> Integers:
        """The place of each record at each of its intensities: its further runs there tell no new record."""
        return np.unique(self.place * self.records + self.who) // self.records

    @property
    def stripes(self) -> bool:
        """Whether records share intensities often enough for these to be looked at one by one."""
        return bool(A_STRIPE * (int(self.place.max()) + 1) <= self._told.size)

    @cached_property
    def group(self) -> Integers:
        """The group of each run, from the lowest: a stripe, or a tenth of the records' intensities in their order."""
        if self.stripes:
            return self.place
        tenth = np.searchsorted(self._told, self.place) * GROUPS // self._told.size  # one intensity stays together
        return np.unique(tenth, return_inverse=True)[1].astype(np.int64)

    def parts(self, confidence: float) -> Parts:
        """The part of the runs that exceeds, in each group.

        Parameters
        ----------
        confidence : float
            Of the intervals.

        Returns
        -------
        Parts

        Notes
        -----
        Wilson's interval with as many trials as there are records: whatever the runs of a record have in common, their
        mean scatters from record to record by p(1 - p) at most, the scatter of one trial. Records of unlike numbers of
        runs count as (sum n)^2/sum n^2. As for bands, the quantile is Student's with one degree of freedom less than
        records where these repeat, so that a single record bounds nothing; else it is the normal one.
        """
        from scipy.special import ndtri, stdtrit

        runs = np.bincount(self.group)
        exceeding = np.bincount(self.group, weights=self.exceeded)
        keys, each = np.unique(self.group * self.records + self.who, return_counts=True)
        records = np.bincount(keys // self.records)
        trials = runs**2 / np.bincount(keys // self.records, weights=each**2)
        level = (1 + confidence) / 2
        several = np.maximum(records - 1, 1)
        quantile = stdtrit(several, level) if self.repeated else np.full(runs.size, ndtri(level))
        part = exceeding / runs
        z2 = quantile**2 / trials
        middle = (part + z2 / 2) / (1 + z2)
        half = np.sqrt(z2 * (part * (1 - part) + z2 / 4)) / (1 + z2)
        alone = self.repeated & (records == 1)
        return Parts(
            np.bincount(self.group, weights=self.x) / runs,
            part,
            np.where(alone, 0.0, np.clip(middle - half, 0.0, part)),
            np.where(alone, 1.0, np.clip(middle + half, part, 1.0)),
            runs,
            exceeding.astype(np.int64),
            records,
        )


@dataclass(frozen=True, eq=False)
class Parts:
    """Observed parts that exceed, each an ndarray of one length, a place for each group of runs.

    Parameters
    ----------
    x : ndarray
        Mean intensity.
    part, low, high : ndarray
        The part that exceeds, and its confidence interval.
    runs, exceeding, records : ndarray of int
        How many runs there are, how many of them exceed, and of how many records they are.
    """

    x: Reals
    part: Reals
    low: Reals
    high: Reals
    runs: Integers
    exceeding: Integers
    records: Integers


def one_of_each(x: Reals) -> Reals:
    """Intensities of any size, where those that differ by rounding alone are all the least of them."""
    order = np.argsort(x, kind="stable")
    rising = x[order]
    new = np.concatenate([[True], ~(rising[1:] <= rising[:-1] * (1 + SAME))])
    result = np.empty_like(rising)
    result[order] = rising[new][np.cumsum(new) - 1]
    return result


def _of_levels(x: Reals, level: Integers) -> Reals:
    """The intensity of each run's level, as the first run of it has it."""
    _, first, which = np.unique(level, return_index=True, return_inverse=True)
    of_level: Reals = x[first][which]
    wrong = np.abs(x - of_level) > SAME * of_level
    if wrong.any():
        k = int(wrong.argmax())
        raise InputError(f"runs of level {level[k]} have the intensities {of_level[k]:g} and {x[k]:g}: a level has one")
    return of_level


def few_records(records: int, confidence: float) -> str:
    """What to say of intervals and bands that rest on few records; empty if there are enough."""
    if records >= FEW:
        return ""
    return (
        f"only {records} distinct record{'s' * (records != 1)}: below {FEW} or so, intervals and bands of "
        f"{100 * confidence:g} % are a rough guide"
    )

"""Observed runs, grouped by intensity: the share that exceeds a limit state, and the number of different records."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rocking_cli.arrays import Bools, Integers, Reals
from rocking_cli.short_repr import short_repr
from rocking_cli.studies.fit import Counts, totals, wilson

# Relative difference of equal intensities: far above rounding, far below a change of shaking.
INTENSITY_TOLERANCE = 1e-9
MIN_STRIPE_RECORDS = 5  # average number of records at one intensity, from which each intensity is a group
MAX_STRIPES = 50  # with more intensities, they are grouped in tenths
RUN_GROUPS = 10  # number of groups, if intensities are not groups themselves
MIN_RELIABLE_RECORDS = 20  # with fewer, the coverage of intervals may differ from the nominal one
# Measured coverage [%] of 95 % intervals, by number of records: docs/make_coverage.py.
MEASURED_COVERAGE = {5: (89, 100), 10: (90, 98)}


@short_repr
@dataclass(frozen=True, eq=False)
class Observations:
    """Number of runs that exceed a limit state, by record and intensity; `of` counts them.

    Parameters
    ----------
    x : ndarray, shape (m,)
        The different intensities, positive and increasing.
    counts : Counts
        Number of runs of each record at each intensity: n cells.
    exceeding : ndarray, shape (n,)
        Number of runs of each cell that exceed.
    whole : (int, int), optional
        Number of runs and of those that exceed, without weights, if the cells hold weighted numbers.
    """

    x: Reals
    counts: Counts
    exceeding: Reals
    whole: tuple[int, int] | None = None

    @classmethod
    def of(
        cls,
        x: Reals,
        exceeding: Bools | Reals | Integers,
        record: Integers,
        *,
        level: Integers | None = None,
        runs: Reals | Integers | None = None,
        weight: Reals | None = None,
    ) -> Observations:
        """Count runs, given one by one or as numbers of equal runs.

        Parameters
        ----------
        x : ndarray, shape (n,)
            Intensities, positive. Those that differ only by rounding are merged.
        exceeding : ndarray, shape (n,)
            Whether the run exceeds the limit state, or the number of equal runs that do.
        record : ndarray of int, shape (n,)
            The record of each run: runs of one record are not independent.
        level : ndarray of int, shape (n,), optional
            The level to which the record was scaled, if the level alone decides the intensity.
        runs : ndarray, shape (n,), optional
            Number of equal runs; one unless given.
        weight : ndarray, shape (n,), optional
            Relative weight of each run; equal unless given. Weights are scaled to an average of one.
        """
        levels, place = np.unique(one_of_each(x if level is None else _of_levels(x, level)), return_inverse=True)
        names, who = np.unique(record, return_inverse=True)
        cells, cell = np.unique(place * names.size + who, return_inverse=True)
        alike = np.ones(x.size) if runs is None else runs.astype(np.float64)
        beyond = exceeding.astype(np.float64)
        each = even(alike, weight)
        counts = Counts(cells % names.size, cells // names.size, totals(cell, alike * each), weight is not None)
        whole = None if weight is None else (int(alike.sum()), int(beyond.sum()))
        return cls(levels, counts, totals(cell, beyond * each), whole)

    @property
    def runs(self) -> int:
        """Number of runs."""
        return self.whole[0] if self.whole is not None else int(self.counts.number.sum())

    @property
    def exceedances(self) -> int:
        """Number of runs that exceed the limit state."""
        return self.whole[1] if self.whole is not None else int(self.exceeding.sum())

    @property
    def records(self) -> int:
        """Number of different records."""
        return self.counts.records

    @property
    def repeated(self) -> bool:
        """Whether a record has several runs."""
        return self.counts.repeated

    @cached_property
    def sides(self) -> tuple[Reals, Reals]:
        """The intensities of runs that do not exceed the limit state, and those of runs that do."""
        place = self.counts.term
        below, above = self.exceeding < self.counts.number, self.exceeding > 0
        return self.x[np.unique(place[below])], self.x[np.unique(place[above])]

    @property
    def stripes(self) -> bool:
        """Whether so many records share each intensity that every intensity can be a group of its own."""
        return self.x.size <= MAX_STRIPES and MIN_STRIPE_RECORDS * self.x.size <= self.counts.record.size

    @cached_property
    def group(self) -> Integers:
        """The group of each cell, from the lowest: a stripe, or a tenth of the cells in order of intensity."""
        place = self.counts.term
        if self.stripes:
            return place
        tenth = np.searchsorted(place, place) * RUN_GROUPS // place.size  # runs of equal intensity stay in one group
        return np.unique(tenth, return_inverse=True)[1].astype(np.int64)

    def group_of(self, x: Reals, record: Integers, level: Integers | None = None) -> Integers:
        """Return the group of each run that `of` counted, from its intensity, record and level."""
        place = np.searchsorted(self.x, one_of_each(x if level is None else _of_levels(x, level)))
        who = np.unique(record, return_inverse=True)[1]
        cells = self.counts.term * self.records + self.counts.record  # cells are sorted, so that they can be searched
        return np.asarray(self.group[np.searchsorted(cells, place * self.records + who)])

    def parts(self, confidence: float, joined: Integers | None = None) -> ObservedParts:
        """Return the share of the runs that exceeds, in each group.

        Parameters
        ----------
        confidence : float
            Confidence level of the intervals.
        joined : ndarray of int, optional
            Number of the larger group to which each group belongs, from 0, to count those.

        Returns
        -------
        ObservedParts

        Notes
        -----
        Wilson's interval with as many trials as records: the variance between records of the mean of their runs is at
        most p(1 - p), that of one trial. Records with different numbers n of runs count as (sum n)^2/sum n^2 records.
        As for bands, the quantile is Student's with one degree of freedom less than records if records repeat, so that
        a single record bounds nothing; otherwise it is the normal one.
        """
        from scipy.special import ndtri, stdtrit

        number = self.counts.number
        group = self.group if joined is None else joined[self.group]
        runs = np.bincount(group, number)
        exceeding = np.bincount(group, self.exceeding)
        keys, which = np.unique(group * self.records + self.counts.record, return_inverse=True)
        records = np.bincount(keys // self.records)
        trials = runs**2 / np.bincount(keys // self.records, weights=np.bincount(which, number) ** 2)
        level = (1 + confidence) / 2
        several = np.maximum(records - 1, 1)
        quantile = stdtrit(several, level) if self.repeated else np.full(runs.size, ndtri(level))
        part = exceeding / runs
        low, high = wilson(part, trials, quantile)
        alone = self.repeated & (records == 1)
        return ObservedParts(
            np.bincount(group, self.x[self.counts.term] * number) / runs,
            part,
            np.where(alone, 0.0, low),
            np.where(alone, 1.0, high),
            np.rint(runs).astype(np.int64),
            np.rint(exceeding).astype(np.int64),
            records,
        )


@dataclass(frozen=True, eq=False)
class ObservedParts:
    """Observed shares of runs that exceed, each an ndarray with one entry for each group of runs.

    Parameters
    ----------
    x : ndarray
        Mean intensity of the group.
    part, low, high : ndarray
        The share that exceeds, and its confidence interval.
    runs, exceeding, records : ndarray of int
        Number of runs, of those that exceed, and of different records.
    """

    x: Reals
    part: Reals
    low: Reals
    high: Reals
    runs: Integers
    exceeding: Integers
    records: Integers


def even(runs: Reals, weight: Reals | None) -> Reals:
    """Return the weights of numbers of runs with an average of one; ones if they are equal."""
    return np.ones(runs.size) if weight is None else weight * runs.sum() / (weight * runs).sum()


def one_of_each(x: Reals) -> Reals:
    """Replace intensities that differ only by rounding by the least of them."""
    order = np.argsort(x, kind="stable")
    rising = x[order]
    new = np.concatenate([[True], ~(rising[1:] <= rising[:-1] * (1 + INTENSITY_TOLERANCE))])
    result = np.empty_like(rising)
    result[order] = rising[new][np.cumsum(new) - 1]
    return result


def _of_levels(x: Reals, level: Integers) -> Reals:
    """Return the intensity of the level of each run, taken from the first run of that level."""
    _, first, which = np.unique(level, return_index=True, return_inverse=True)
    return np.asarray(x[first][which])


def few_records(records: int) -> str:
    """Return a warning that intervals and bands rest on few records; empty if there are enough."""
    if records >= MIN_RELIABLE_RECORDS:
        return ""
    trials = max([each for each in MEASURED_COVERAGE if each <= records], default=min(MEASURED_COVERAGE))
    low, high = MEASURED_COVERAGE[trials]
    return (
        f"only {records} distinct record{'s' * (records != 1)}: intervals and bands are a rough guide: in trials with "
        f"{trials} records those that should hold in 95 % of cases held in {low} to {high} %"
    )

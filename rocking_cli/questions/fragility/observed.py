"""Observed runs, grouped by intensity: the share that exceeds a limit state, and the number of different records.

The tests of goodness of fit compare observed numbers of exceedances with the numbers that a curve predicts.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rocking_cli.arrays import Bools, Integers, Reals
from rocking_cli.short_repr import short_repr
from rocking_cli.studies.fit import MAX_ETA, Brackets, Counts, Fit, cumulative, density, standardised, totals, wilson

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
        counts = self.counts
        cells = counts.term * counts.records + counts.record  # cells are sorted, so that they can be searched
        return np.asarray(self.group[np.searchsorted(cells, place * counts.records + who)])

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

        number, repeated = self.counts.number, self.counts.repeated
        group = self.group if joined is None else joined[self.group]
        runs = np.bincount(group, number)
        exceeding = np.bincount(group, self.exceeding)
        keys, which = np.unique(group * self.counts.records + self.counts.record, return_inverse=True)
        records = np.bincount(keys // self.counts.records)
        trials = runs**2 / np.bincount(keys // self.counts.records, weights=np.bincount(which, number) ** 2)
        level = (1 + confidence) / 2
        several = np.maximum(records - 1, 1)
        quantile = stdtrit(several, level) if repeated else np.full(runs.size, ndtri(level))
        part = exceeding / runs
        low, high = wilson(part, trials, quantile)
        alone = repeated & (records == 1)
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
    nearest = f" ({'the next smaller' if trials < records else 'the smallest'} number tried)" * (trials != records)
    return (
        f"only {records} distinct record{'s' * (records != 1)}: intervals and bands are a rough guide: in trials with "
        f"{trials} records{nearest} those that should hold in 95 % of cases held in {low} to {high} %"
    )


MIN_EXPECTED = 2.0 - 1e-6  # expected records on either side in a group or cell: two, less rounding
BY_RECORD = ", corrected for repeated records"


@short_repr
@dataclass(frozen=True)
class Goodness:
    """Result of a goodness-of-fit test of a curve.

    Parameters
    ----------
    name : str
        Name of the test.
    statistic, degrees, p_value : float or None
        The statistic, its degrees of freedom, and the probability of one as large if the curve is right; None if there
        are too few data.
    why : str
        Why the curve was not tested; empty if it was.
    """

    name: str
    statistic: float | None = None
    degrees: float | None = None
    p_value: float | None = None
    why: str = ""


def goodness_of_runs(fit: Fit, design: Reals, seen: Observations) -> Goodness:
    """Test a curve that was fitted to runs: compare observed with predicted numbers of exceedances in groups of runs.

    Parameters
    ----------
    fit : Fit
        The curve.
    design : ndarray, shape (m, 2)
        Rows of the linear predictor at the m different intensities, see `Fit`.
    seen : Observations
        The runs to which the curve was fitted, in groups of similar intensity.

    Notes
    -----
    The statistic is Pearson's: T, the sum over the groups of (observed - predicted)^2/variance. Its distribution
    depends on the covariance V of the standardised differences, which accounts for two facts: the coefficients were
    fitted to the same runs, and runs of one record depend on each other. T is a sum of chi-squares of one degree of
    freedom, weighted by the eigenvalues of V. The test replaces this sum by one chi-square of equal mean and variance:
    T tr(V)/tr(V^2) has tr(V)^2/tr(V^2) degrees of freedom [Rao & Scott 1984, Annals of Statistics 12, 46-60]. For
    stripes of independent runs at m intensities, V has m - 2 eigenvalues of one, and the test is the usual one with m -
    2 degrees of freedom.
    """
    counts = seen.counts
    place, record, number = counts.term, counts.record, counts.number
    eta = np.clip(design @ fit.coefficients, -MAX_ETA, MAX_ETA)[place]
    p, q, slope = cumulative(fit.link, eta), cumulative(fit.link, -eta), density(fit.link, eta)
    name = "Pearson chi-square over the intensities" if seen.stripes else "Hosmer-Lemeshow"
    table = np.zeros((int(seen.group.max()) + 1, counts.records))
    np.add.at(table, (seen.group, record), number)
    part = totals(seen.group, number * p) / totals(seen.group, number)
    groups, count = _merged(table, part)
    if count < 3:
        of = "two or more records expected to exceed the limit and two or more not"
        return _untested(name, f"three groups of runs, each with {of}", count)
    group = groups[seen.group]
    rest, weight = seen.exceeding - number * p, slope / (p * q)
    variance = totals(group, number * p * q)
    rows = standardised(design)[0][place]
    information = (rows * (number * slope * weight)[:, None]).T @ rows
    by_coefficients = _sums(group, number * slope, rows, count)
    through = by_coefficients @ np.linalg.inv(information)
    if counts.repeated:
        adds = np.zeros((counts.records, count))
        np.add.at(adds, (record, group), rest)
        adds -= _sums(record, weight * rest, rows, counts.records) @ through.T
        covariance = adds.T @ adds
        name += BY_RECORD
    else:
        covariance = np.diag(variance) - through @ by_coefficients.T
    return _weighted(name, totals(group, rest), variance, covariance)


def goodness_of_brackets(fit: Fit, lower: Reals, upper: Reals, seen: Counts, levels: Reals | None) -> Goodness:
    """Test a distribution fitted to capacities: compare observed with predicted numbers in ranges of intensity.

    Each capacity is known only to lie in a bracket, between two levels that were simulated. The ranges are therefore
    bounded by those levels that lie strictly inside no bracket, so that every capacity belongs to one range.

    Parameters
    ----------
    fit : Fit
        The distribution of u, the logarithm of the capacity.
    lower, upper : ndarray, shape (n,)
        The different brackets of u; minus and plus infinity if open.
    seen : Counts
        Number of capacities of each record in each bracket.
    levels : ndarray, shape (m,), optional
        All finite levels of u that were simulated. None if they differ between capacities: there is no test then, as
        the ranges would depend on the capacities.

    Notes
    -----
    The statistic is that of `goodness_of_runs`. If every record has one capacity, V is the covariance of the
    multinomial counts minus the part that the fit absorbs; if no two brackets overlap, V has as many eigenvalues of one
    as there are ranges less three.
    """
    name = "chi-square of the capacities"
    if levels is None:
        return Goodness(name, why="the levels that were tried are not the same for all capacities")
    total = seen.number.sum()
    begun, ended = np.searchsorted(np.sort(lower), levels, "left"), np.searchsorted(np.sort(upper), levels, "right")
    whole = levels[begun == ended]  # levels that lie within no bracket
    # P and its derivatives with respect to the coefficients, at the bounds of the cells; 0 and 1 at infinity.
    eta = fit.coefficients[0] + fit.coefficients[1] * whole
    expected = total * np.diff(cumulative(fit.link, eta), prepend=0.0, append=1.0)
    slope = density(fit.link, eta)
    slopes = np.pad(np.column_stack([slope, slope * whole]), ((1, 1), (0, 0)))
    of_records = totals(seen.record, seen.number)
    cell, count = _merged(np.outer(expected / total, of_records))
    if count < 4:
        return _untested(name, "four ranges of levels, each with the capacities of two or more records expected", count)
    by_coefficients = _sums(cell, np.full(cell.size, total), np.diff(slopes, axis=0), count)
    expected = totals(cell, expected)
    among = cell[np.searchsorted(whole, lower, side="right")][seen.term]
    rest = totals(among, seen.number, count) - expected
    if seen.repeated:
        terms = Brackets(lower, upper)
        coefficients = terms.at(np.linalg.solve(terms.back, fit.coefficients), slice(None))
        information = np.einsum("n,nkl->kl", totals(seen.term, seen.number), coefficients.information)
        adds = -np.outer(of_records, expected / total)
        np.add.at(adds, (seen.record, among), seen.number)
        scores = _sums(seen.record, seen.number, coefficients.score[seen.term], seen.records)
        adds -= scores @ np.linalg.solve(information, (by_coefficients @ terms.back).T)
        covariance = adds.T @ adds
        name += BY_RECORD
    else:
        covariance = np.diag(expected) - np.outer(expected, expected) / total
        covariance -= by_coefficients @ fit.covariance @ by_coefficients.T
    return _weighted(name, rest, expected, covariance)


def _untested(name: str, takes: str, count: int) -> Goodness:
    return Goodness(name, why=f"that takes {takes}, and there {'is' if count == 1 else 'are'} {count}")


def _sums(group: Integers, weights: Reals, rows: Reals, count: int) -> Reals:
    """Return weighted sums of the rows of each group, shape (count, k)."""
    return np.column_stack([totals(group, weights * column, count) for column in rows.T])


def _weighted(name: str, rest: Reals, variance: Reals, covariance: Reals) -> Goodness:
    """Test differences of known covariance: Pearson's statistic against a chi-square of equal mean and variance."""
    from scipy.special import chdtrc

    standard, deviation = rest / np.sqrt(variance), np.sqrt(variance)
    covariance = covariance / np.outer(deviation, deviation)
    first, second = np.trace(covariance), (covariance**2).sum()
    if first <= 0:
        return Goodness(name, why="the fit takes up all the scatter that there could be")
    statistic, degrees = float(standard @ standard * first / second), float(first**2 / second)
    return Goodness(name, statistic, degrees, float(chdtrc(degrees, statistic)))


def _merged(table: Reals, part: Reals | None = None) -> tuple[Integers, int]:
    """Merge neighbouring groups, from the lowest, until each expects enough records on either side of the limit state.

    Parameters
    ----------
    table : ndarray, shape (groups, records)
        Number of runs of each record in each group. As runs of a record depend on each other, n runs count as (sum
        n)^2/sum n^2 records.
    part : ndarray, shape (groups,), optional
        The share of each group that is expected to exceed. Without it, only one side is counted.

    Returns
    -------
    ndarray of int, shape (groups,)
        Number of the merged group to which each group belongs.
    int
        Number of merged groups.
    """
    new = np.zeros(len(table), dtype=np.int64)
    number, gathered, there = 0, np.zeros(table.shape[1]), 0.0
    for k, row in enumerate(table):
        new[k] = number
        gathered = gathered + row
        there += row.sum() * (1.0 if part is None else part[k])
        runs, squares = gathered.sum(), (gathered**2).sum()
        sides = (there,) if part is None else (there, runs - there)
        if squares > 0 and min(sides) * runs / squares >= MIN_EXPECTED:
            number, gathered, there = number + 1, np.zeros(table.shape[1]), 0.0
    return np.minimum(new, max(number - 1, 0)), number  # the last group takes the remainder

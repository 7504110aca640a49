"""Goodness-of-fit tests of fragility curves: observed numbers of exceedances against the numbers a curve predicts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rocking_cli.arrays import Integers, Reals
from rocking_cli.questions.fragility.observed import Observations
from rocking_cli.short_repr import short_repr
from rocking_cli.studies.fit import MAX_ETA, Brackets, Counts, Fit, cumulative, density, standardised, totals

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
    place, record, number = seen.counts.term, seen.counts.record, seen.counts.number
    eta = np.clip(design @ fit.coefficients, -MAX_ETA, MAX_ETA)[place]
    p, q, slope = cumulative(fit.link, eta), cumulative(fit.link, -eta), density(fit.link, eta)
    name = "Pearson chi-square over the intensities" if seen.stripes else "Hosmer-Lemeshow"
    table = np.zeros((int(seen.group.max()) + 1, seen.records))
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
    if seen.repeated:
        adds = np.zeros((seen.records, count))
        np.add.at(adds, (record, group), rest)
        adds -= _sums(record, weight * rest, rows, seen.records) @ through.T
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

"""Goodness-of-fit tests of curves: observed counts in groups against the counts that the curve expects."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rocking_cli.studies.fragility.fit import Counts, Fit
from rocking_cli.studies.fragility.likelihood import (
    FARTHEST,
    Brackets,
    Integers,
    Reals,
    cumulative,
    density,
    standardised,
    totals,
)
from rocking_cli.studies.fragility.observed import Observations

LEAST = 2.0 - 1e-6  # records expected on either side in a group, or in a cell: two less rounding are two
BY_RECORD = ", corrected for repeated records"


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
    """Test a curve against the number of runs that exceed, in each group of the runs.

    Parameters
    ----------
    fit : Fit
        The curve.
    design : ndarray, shape (m, 2)
        X at the different intensities.
    seen : Observations
        The runs, as fitted.

    Notes
    -----
    Pearson's statistic T = sum (observed - expected)^2/variance over the groups is a sum of chi-squares of one degree
    of freedom, weighted by the eigenvalues of the covariance V of the standardised differences. V counts that the
    coefficients were fitted to the same runs, and that runs of one record are alike. T tr(V)/tr(V^2) is then a
    chi-square of tr(V)^2/tr(V^2) degrees of freedom [Rao & Scott 1984, Annals of Statistics 12, 46-60]. For stripes of
    independent runs V has m - 2 eigenvalues, all one: this is the usual test with m - 2 degrees of freedom.
    """
    place, record, number = seen.counts.term, seen.counts.record, seen.counts.number
    eta = np.clip(design @ fit.coefficients, -FARTHEST, FARTHEST)[place]
    p, q, slope = cumulative(fit.link, eta), cumulative(fit.link, -eta), density(fit.link, eta)
    name = "Pearson chi-square over the intensities" if seen.stripes else "Hosmer-Lemeshow"
    table = np.zeros((int(seen.group.max()) + 1, seen.records))
    np.add.at(table, (seen.group, record), number)
    part = totals(seen.group, number * p) / totals(seen.group, number)
    groups, count = _merged(table, part)
    if count < 3:
        why = (
            "that takes three groups of runs, each with two or more records expected to exceed the limit and two or "
            f"more not, and there {'is' if count == 1 else 'are'} {count}"
        )
        return Goodness(name, why=why)
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
    """Test a distribution of capacities against their number in cells whose bounds lie inside no bracket.

    Parameters
    ----------
    fit : Fit
        The distribution, over u.
    lower, upper : ndarray, shape (n,)
        The different brackets of u; minus and plus infinity where open.
    seen : Counts
        Number of capacities of each record in each bracket.
    levels : ndarray, shape (m,), optional
        All levels that were simulated, finite: the bounds of cells must not depend on the capacities.

    Notes
    -----
    As in `goodness_of_runs`. If every record has one capacity, V is the covariance of the counts minus the part that
    the fit absorbs; if the cells are the brackets, V has m - 3 eigenvalues, all one.
    """
    name = "chi-square of the capacities"
    if levels is None:
        return Goodness(name, why="the levels that were tried are not the same for all capacities")
    total = seen.number.sum()
    begun, ended = np.searchsorted(np.sort(lower), levels, "left"), np.searchsorted(np.sort(upper), levels, "right")
    whole = levels[begun == ended]  # no bracket has them within
    # P and its derivatives by the coefficients at the bounds of the cells, 0 and 1 at infinity.
    eta = fit.coefficients[0] + fit.coefficients[1] * whole
    expected = total * np.diff(cumulative(fit.link, eta), prepend=0.0, append=1.0)
    slope = density(fit.link, eta)
    slopes = np.pad(np.column_stack([slope, slope * whole]), ((1, 1), (0, 0)))
    of_records = totals(seen.record, seen.number)
    cell, count = _merged(np.outer(expected / total, of_records))
    if count < 4:
        why = (
            "that takes four ranges of levels, each with the capacities of two or more records expected, and "
            f"there {'is' if count == 1 else 'are'} {count}"
        )
        return Goodness(name, why=why)
    by_coefficients = _sums(cell, np.full(cell.size, total), np.diff(slopes, axis=0), count)
    expected = totals(cell, expected)
    among = cell[np.searchsorted(whole, lower, side="right")][seen.term]
    rest = totals(among, seen.number, count) - expected
    if seen.repeated:
        terms = Brackets(lower, upper)
        found = terms.at(np.linalg.solve(terms.back, fit.coefficients), slice(None))
        information = np.einsum("n,nkl->kl", totals(seen.term, seen.number), found.information)
        adds = -np.outer(of_records, expected / total)
        np.add.at(adds, (seen.record, among), seen.number)
        scores = _sums(seen.record, seen.number, found.score[seen.term], seen.records)
        adds -= scores @ np.linalg.solve(information, (by_coefficients @ terms.back).T)
        covariance = adds.T @ adds
        name += BY_RECORD
    else:
        covariance = np.diag(expected) - np.outer(expected, expected) / total
        covariance -= by_coefficients @ fit.covariance @ by_coefficients.T
    return _weighted(name, rest, expected, covariance)


def _sums(group: Integers, weights: Reals, rows: Reals, count: int) -> Reals:
    """Return weighted sums of the rows of each group, shape (count, k)."""
    return np.column_stack([totals(group, weights * column, count) for column in rows.T])


def _weighted(name: str, rest: Reals, variance: Reals, covariance: Reals) -> Goodness:
    """Test a sum of squared differences with a given covariance, by a chi-square of equal mean and variance."""
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
        if squares > 0 and min(sides) * runs / squares >= LEAST:
            number, gathered, there = number + 1, np.zeros(table.shape[1]), 0.0
    return np.minimum(new, max(number - 1, 0)), number  # what is left over joins the last

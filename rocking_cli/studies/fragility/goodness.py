"""Whether a fitted curve agrees with the data: counts in groups against what the curve expects there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rocking_cli.studies.fragility.likelihood import (
    FARTHEST,
    Fit,
    Integers,
    Reals,
    cumulative,
    density,
    standardised,
)
from rocking_cli.studies.fragility.observed import Observations

LEAST = 2.0 - 1e-6  # runs expected on either side in a group, or records in a cell: two less rounding are two


@dataclass(frozen=True)
class Goodness:
    """A test of a curve against its data.

    Parameters
    ----------
    name : str
        Which test.
    statistic, degrees, p_value : float or None
        The statistic, its degrees of freedom, and how likely one as large is if the curve is right; None if there
        are too few data.
    why : str
        Why it was not tested; empty if it was.
    """

    name: str
    statistic: float | None = None
    degrees: float | None = None
    p_value: float | None = None
    why: str = ""


def goodness_of_runs(fit: Fit, design: Reals, seen: Observations) -> Goodness:
    """Test a curve against the numbers that exceed, in each group of the runs.

    Parameters
    ----------
    fit : Fit
        The curve.
    design : ndarray, shape (n, 2)
        X of the fit.
    seen : Observations
        The runs, as fitted.

    Notes
    -----
    Pearson's statistic T = sum (observed - expected)^2/variance over the groups is a sum of chi-squares of one degree
    of freedom, weighted by the eigenvalues of the covariance V of the standardised differences. V counts that the
    coefficients were fitted to the same runs, and that runs of one record are alike. T tr(V)/tr(V^2) is then a
    chi-square of tr(V)^2/tr(V^2) degrees of freedom [Rao & Scott 1984, Annals of Statistics 12, 46-60]. For stripes
    of independent runs V has m - 2 eigenvalues, all one: this is the usual test with m - 2 degrees of freedom.
    """
    eta = np.clip(design @ fit.coefficients, -FARTHEST, FARTHEST)
    p, q, slope = cumulative(fit.link, eta), cumulative(fit.link, -eta), density(fit.link, eta)
    name = "Pearson chi-square over the intensities" if seen.stripes else "Hosmer-Lemeshow"
    member = _membership(_merged(seen.group, p, q))
    count = member.shape[1]
    if count < 3:
        why = f"{count} group{'s' * (count > 1)} with two or more expected on either side, three are needed"
        return Goodness(name, why=why)
    deviation = np.sqrt(member.T @ (p * q))
    standard = member.T @ (seen.exceeded - p) / deviation
    # What one run adds to the standardised differences, less what it takes off them through the coefficients.
    weight = slope / (p * q)
    design, _ = standardised(design)
    information = (design * (slope * weight)[:, None]).T @ design
    through = np.linalg.solve(information, (design * slope[:, None]).T @ member)
    adds = (member - (design * weight[:, None]) @ through) / deviation
    if seen.repeated:
        sums = np.zeros((seen.records, count))
        np.add.at(sums, seen.who, adds * (seen.exceeded - p)[:, None])
        covariance = sums.T @ sums
        name += ", corrected for repeated records"
    else:
        covariance = (adds * (p * q)[:, None]).T @ adds
    return _weighted(name, standard, covariance)


def goodness_of_brackets(fit: Fit, lower: Reals, upper: Reals, record: Integers) -> Goodness:
    """Test a distribution of capacities against their number in cells whose bounds cut no bracket.

    Parameters
    ----------
    fit : Fit
        The distribution, over u.
    lower, upper : ndarray, shape (n,)
        The brackets of u; minus and plus infinity where open.
    record : ndarray of int, shape (n,)
        The record of each: where one has several nothing is tested.

    Notes
    -----
    As `goodness_of_runs`, with V the covariance of the counts less what the fit takes up of it; where the cells are
    the brackets V has m - 3 eigenvalues, all one.
    """
    name = "chi-square of the capacities"
    if np.unique(record).size < record.size:
        return Goodness(name, why="there are several capacities of a record, which are alike")
    ends = np.unique(np.concatenate([lower, upper]))
    ends = ends[np.isfinite(ends)]
    whole = np.array([end for end in ends if not ((lower < end) & (end < upper)).any()])
    # P and its derivatives by the coefficients at the bounds of the cells, 0 and 1 at infinity.
    eta = fit.coefficients[0] + fit.coefficients[1] * whole
    expected = lower.size * np.diff(cumulative(fit.link, eta), prepend=0.0, append=1.0)
    slope = density(fit.link, eta)
    slopes = np.pad(np.column_stack([slope, slope * whole]), ((1, 1), (0, 0)))
    by_coefficients = lower.size * np.diff(slopes, axis=0)
    member = _membership(_merged(np.arange(expected.size), expected, expected))
    expected, by_coefficients = member.T @ expected, member.T @ by_coefficients
    count = expected.size
    if count < 4:
        why = f"{count} cell{'s' * (count > 1)} with two or more capacities expected, four are needed"
        return Goodness(name, why=why)
    observed = member.T @ np.bincount(np.searchsorted(whole, lower, side="right"), minlength=whole.size + 1)
    covariance = np.diag(expected) - np.outer(expected, expected) / lower.size
    covariance -= by_coefficients @ fit.covariance @ by_coefficients.T
    deviation = np.sqrt(expected)
    return _weighted(name, (observed - expected) / deviation, covariance / np.outer(deviation, deviation))


def _weighted(name: str, standard: Reals, covariance: Reals) -> Goodness:
    """The test of a sum of squares of differences with this covariance, by a chi-square of equal mean and variance."""
    from scipy.special import chdtrc

    first, second = np.trace(covariance), (covariance**2).sum()
    if first <= 0:
        return Goodness(name, why="the fit takes up all the scatter that there could be")
    statistic, degrees = float(standard @ standard * first / second), float(first**2 / second)
    return Goodness(name, statistic, degrees, float(chdtrc(degrees, statistic)))


def _membership(group: Integers) -> Reals:
    """One where a run, or a cell, belongs to a group."""
    return np.eye(int(group.max()) + 1)[group]


def _merged(group: Integers, p: Reals, q: Reals) -> Integers:
    """Join neighbouring groups, from the lowest, until each expects enough on either side."""
    expected = np.array([np.bincount(group, weights=each) for each in (p, q)])
    new = np.zeros(expected.shape[1], dtype=np.int64)
    number, gathered = 0, np.zeros(2)
    for k, each in enumerate(expected.T):
        new[k] = number
        gathered = gathered + each
        if (gathered >= LEAST).all():
            number, gathered = number + 1, np.zeros(2)
    return np.minimum(new, max(number - 1, 0))[group]  # what is left over joins the last

"""Log-likelihoods of observations under a linear predictor eta = X c, and its maximum-likelihood coefficients c.

Each record is a cluster of runs.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Literal, NamedTuple

import numpy as np

from rocking_cli.arrays import Bools, Integers, Reals
from rocking_cli.short_repr import short_repr

Link = Literal["probit", "logit"]

MAX_ETA = 30.0  # probabilities beyond it are 0 or 1, but their ratios are still finite
MIN_SEPARATION = 1e-9  # margin per run above which a line separates the runs


@dataclass(frozen=True, eq=False)
class Slopes:
    """Log-likelihoods of n terms and their derivatives by k coefficients.

    Parameters
    ----------
    value : ndarray, shape (n,)
        Minus infinity where the coefficients are impossible.
    score : ndarray, shape (n, k)
        The gradients.
    information : ndarray, shape (n, k, k)
        Minus the Hessians.
    """

    value: Reals
    score: Reals
    information: Reals


class ExceedanceTerms:
    """Terms of the likelihood of a curve: one for each run, which exceeds the limit state or does not.

    Parameters
    ----------
    link : str
        `probit`, P = Phi(eta), or `logit`, P = 1/(1 + exp(-eta)).
    design : ndarray, shape (n, k)
        The design X, with ones in the first column.
    exceeds : ndarray of bool, shape (n,)
        Whether each term is of a run that exceeds.
    """

    def __init__(self, link: Link, design: Reals, exceeds: Bools) -> None:
        self._link = link
        self._design, self.back = standardised(design)
        self._sign = np.where(exceeds, 1.0, -1.0)

    def __len__(self) -> int:
        return self._sign.size

    def at(self, coefficients: Reals, part: slice) -> Slopes:
        """Return log-likelihoods and derivatives of some of the terms at given coefficients."""
        from scipy.special import expit, log_expit, log_ndtr

        design, sign = self._design[part], self._sign[part]
        eta = sign * (design @ coefficients)
        if self._link == "probit":
            value = log_ndtr(eta)
            ratio = np.exp(-eta * eta / 2 - value) / np.sqrt(2 * np.pi)  # phi/Phi: normal density over probability
            weight = ratio * (ratio + eta)
        else:
            value, ratio = log_expit(eta), expit(-eta)
            weight = ratio * expit(eta)
        score = (sign * ratio)[..., None] * design
        return Slopes(value, score, weight[..., None, None] * (design[:, :, None] * design[:, None, :]))


class Brackets:
    """The terms of capacities u in brackets; u is normal with mean -a/b and deviation 1/b, eta = a + b u.

    Parameters
    ----------
    lower, upper : ndarray, shape (n,)
        The brackets; minus and plus infinity where open.
    """

    def __init__(self, lower: Reals, upper: Reals) -> None:
        ends = np.concatenate([lower[np.isfinite(lower)], upper[np.isfinite(upper)]])
        mean, deviation = ends.mean(), ends.std()
        self.back = np.array([[1.0, -mean / deviation], [0.0, 1 / deviation]])
        self._lower, self._upper = (lower - mean) / deviation, (upper - mean) / deviation

    def __len__(self) -> int:
        return int(self._lower.size)

    def at(self, coefficients: Reals, part: slice) -> Slopes:
        """Return log-likelihoods ln[Phi(a + b upper) - Phi(a + b lower)] and derivatives."""
        from scipy.special import log_ndtr

        a, b = coefficients
        lower, upper = self._lower[part], self._upper[part]
        if b <= 0:  # the bounds would be swapped
            n = lower.size
            return Slopes(np.full(n, -np.inf), np.zeros((n, 2)), np.broadcast_to(np.eye(2), (n, 2, 2)))
        u, v = (np.where(np.isfinite(end), end, 0.0) for end in (lower, upper))
        low = np.where(np.isfinite(lower), a + b * u, -np.inf)
        high = np.where(np.isfinite(upper), a + b * v, np.inf)
        flip = low > 0  # the difference of small numbers is accurate in the lower tail
        top, bottom = log_ndtr(np.where(flip, -low, high)), log_ndtr(np.where(flip, -high, low))
        value = top + np.log(-np.expm1(bottom - top))
        # phi/[Phi(high) - Phi(low)] at either end.
        at_low, at_high = (np.exp(-end * end / 2 - value) / np.sqrt(2 * np.pi) for end in (low, high))
        low, high = (np.where(np.isfinite(end), end, 0.0) for end in (low, high))
        score = np.stack([at_high - at_low, at_high * v - at_low * u], axis=-1)
        # Written in this way, the information is accurate for narrow brackets.
        information = score[:, :, None] * score[:, None, :]
        for weight, end in ((high * at_high, v), (-low * at_low, u)):
            row = np.stack([np.ones_like(end), end], axis=-1)
            information += weight[:, None, None] * row[:, :, None] * row[:, None, :]
        return Slopes(value, score, information)


Terms = ExceedanceTerms | Brackets
"""The observations of a fit, each with a log-likelihood that is concave in the coefficients.

Their `back` converts coefficients of the standardised design to the caller's units."""


def totals(group: Integers, weights: Reals, count: int = 0) -> Reals:
    """Return the sums of weights in groups numbered from 0; at least `count` groups."""
    return np.asarray(np.bincount(group, weights, count), dtype=np.float64)


def cumulative(link: Link, eta: Reals) -> Reals:
    """Return the probability P at eta."""
    from scipy.special import expit, ndtr

    result: Reals = ndtr(eta) if link == "probit" else expit(eta)
    return result


def density(link: Link, eta: Reals) -> Reals:
    """Return the derivative dP/d eta."""
    if link == "probit":
        return np.asarray(np.exp(-eta * eta / 2) / np.sqrt(2 * np.pi))
    return cumulative(link, eta) * cumulative(link, -eta)


def standardised(design: Reals) -> tuple[Reals, Reals]:
    """Standardise the columns of a design after its first, of ones: mean 0, standard deviation 1.

    The fit then depends neither on the unit of an intensity nor on its magnitude.

    Returns
    -------
    design : ndarray, shape (n, k)
        The standardised design.
    back : ndarray, shape (k, k)
        Matrix that converts coefficients of the standardised design to those of the given one.
    """
    mean, deviation = design[:, 1:].mean(axis=0), design[:, 1:].std(axis=0)
    back = np.diag(np.concatenate([[1.0], 1 / deviation]))
    back[0, 1:] = -mean / deviation
    return np.column_stack([design[:, :1], (design[:, 1:] - mean) / deviation]), back


def separable(design: Reals, exceeded: Bools) -> bool:
    """Return whether some linear function of the design separates the runs that exceed from the runs that do not.

    Runs on the boundary may be of either kind. If such a function exists, the likelihood has no maximum: it increases
    without bound as the curve becomes steeper [Albert & Anderson 1984, Biometrika 71, 1-10]. A linear programme
    decides; the columns of the design should be of the order of one.
    """
    from scipy.optimize import linprog

    signed = np.where(exceeded, 1.0, -1.0)[:, None] * design
    solution = linprog(-signed.sum(axis=0), A_ub=-signed, b_ub=np.zeros(exceeded.size), bounds=(-1, 1))
    return bool(-solution.fun > MIN_SEPARATION * exceeded.size)


MAX_NEWTON_STEPS = 100  # largest number of steps; six are usual
MIN_DECREMENT = 1e-12  # log-likelihood per run that the last step must gain
MIN_STEP_SHARE = 1e-10
MIN_EIGENVALUE_RATIO = 1e-13  # smallest over largest; with less, the information says nothing in one direction
TERMS_PER_BLOCK = 1 << 16  # terms computed at once, in some ten megabytes
NO_MAXIMUM = "the likelihood found no maximum: the data hardly tell a slope"
NO_ERRORS = "the errors of the fit cannot be told: without one record, or at all, the data hardly tell a slope"


@dataclass(frozen=True)
class Estimate:
    """A number with its confidence interval.

    Parameters
    ----------
    value : float
        The estimate.
    low, high : float
        The interval; an end that the data leave open is 0 or infinite.
    """

    value: float
    low: float
    high: float


@short_repr
@dataclass(frozen=True, eq=False)
class Fit:
    """Maximum-likelihood estimate of a curve: the probability of exceedance is a function of eta = X c.

    X is the design: a row for each observation, such as (1, ln intensity). c are the coefficients.

    Parameters
    ----------
    link : str
        Function of eta: `probit`, P = Phi(eta), or `logit`, P = 1/(1 + exp(-eta)).
    coefficients : ndarray, shape (k,)
        The coefficients c.
    covariance : ndarray, shape (k, k)
        Covariance of the coefficients.
    log_likelihood : float
        Maximum of the log-likelihood.
    confidence : float
        Confidence level of the intervals.
    degrees : float
        Degrees of freedom of Student's distribution, on which the intervals are based; infinite: normal distribution.
    ladders : bool
        Whether the fit is to capacities from ladders of increasing intensity, and not to single runs. A curve of
        capacities increases by definition.
    """

    link: Link
    coefficients: Reals
    covariance: Reals
    log_likelihood: float
    confidence: float
    degrees: float = np.inf
    ladders: bool = False

    @property
    def aic(self) -> float:
        """Akaike's criterion: the smaller, the better."""
        return 2 * self.coefficients.size - 2 * self.log_likelihood

    @property
    def quantile(self) -> float:
        """Half-width of a confidence interval in standard errors."""
        from scipy.special import ndtri, stdtrit

        level = (1 + self.confidence) / 2
        return float(ndtri(level) if np.isinf(self.degrees) else stdtrit(self.degrees, level))

    @property
    def intervals(self) -> list[Estimate]:
        """The coefficients with their confidence intervals."""
        reach = self.quantile * np.sqrt(np.diag(self.covariance))
        return [Estimate(float(c), float(c - r), float(c + r)) for c, r in zip(self.coefficients, reach, strict=True)]

    def probability(self, design: Reals) -> Reals:
        """Return the probability of each row of the design, shape (n,)."""
        return cumulative(self.link, design @ self.coefficients)

    def band(self, design: Reals) -> tuple[Reals, Reals]:
        """Return confidence limits of the probability of each row; those of eta, so that they stay within 0 and 1."""
        eta = design @ self.coefficients
        variance = np.einsum("ij,jk,ik->i", design, self.covariance, design)
        reach = self.quantile * np.sqrt(np.maximum(variance, 0.0))  # rounding may make a variance of zero negative
        return cumulative(self.link, eta - reach), cumulative(self.link, eta + reach)


@short_repr
@dataclass(frozen=True, eq=False)
class Counts:
    """Number of runs by record and by observation (such as "exceeds at an intensity"), each an ndarray of one length.

    Parameters
    ----------
    record : ndarray of int
        Number of the record, from 0.
    term : ndarray of int
        The observation: its place among the terms of a likelihood.
    number : ndarray
        Number of runs of this record with this observation.
    weighted : bool
        Whether records have different weights, so that `number` holds weighted sums.
    """

    record: Integers
    term: Integers
    number: Reals
    weighted: bool = False

    @property
    def records(self) -> int:
        """Number of records."""
        return int(self.record.max()) + 1

    @property
    def repeated(self) -> bool:
        """Whether any record has several runs or a weight: records are then treated as clusters."""
        return self.weighted or bool(self.records < self.number.sum())


def too_few(seen: Counts, coefficients: int, what: str = "runs") -> str:
    """Return a message if records repeat and are too few to estimate the dependence within a record; else empty."""
    if not seen.repeated or seen.records > coefficients:
        return ""
    return (
        f"the {seen.number.sum():.0f} {what} are of {seen.records} record{'s' * (seen.records > 1)}: "
        f"{coefficients + 1} are needed at least"
    )


class Sums(NamedTuple):
    """Log-likelihood, its gradient (k,) and the information (k, k), summed over all observations."""

    value: float
    gradient: Reals
    information: Reals


def fit_outcomes(link: Link, design: Reals, seen: Counts, exceeding: Reals, confidence: float) -> Fit | str:
    """Fit a predictor to runs that exceed a limit state or do not.

    Parameters
    ----------
    link : str
        `probit` or `logit`.
    design : ndarray, shape (n, k)
        Rows of X, one for each observation, with ones in the first column. The caller has made sure that no column
        after it is constant, and that no plane separates the outcomes.
    seen : Counts
        Number of runs of each record in each row.
    exceeding : ndarray
        Number of these runs that exceed.
    confidence : float
        Confidence level of the intervals.

    Returns
    -------
    Fit or str
        The fit, or a message why there is none.
    """
    # Every place stands for two terms: a run that exceeds, and one that does not.
    term = np.concatenate([seen.term, seen.term + len(design)])
    number = np.concatenate([exceeding, seen.number - exceeding])
    record = np.tile(seen.record, 2)
    there = number > 0
    told, term = np.unique(term[there], return_inverse=True)
    terms = ExceedanceTerms(link, design[told % len(design)], told < len(design))
    start, degrees = np.zeros(design.shape[1]), seen.records - 1.0 if seen.repeated else np.inf
    return _fitted(link, terms, Counts(record[there], term, number[there], seen.weighted), start, confidence, degrees)


def fit_brackets(lower: Reals, upper: Reals, seen: Counts, confidence: float) -> Fit | str:
    """Fit eta = a + b u to capacities u that are normal with mean -a/b and deviation 1/b, and known to within brackets.

    Parameters
    ----------
    lower, upper : ndarray, shape (n,)
        The different brackets; minus and plus infinity where open. The caller has made sure that no point lies in all.
    seen : Counts
        Number of capacities of each record in each bracket.
    confidence : float
        Confidence level of the intervals, which follow Student's distribution with one degree of freedom less than
        records, as for the mean of capacities known exactly.

    Returns
    -------
    Fit or str
        The fit, or a message why there is none.
    """
    start, degrees = np.array([0.0, 1.0]), seen.records - 1.0
    result = _fitted("probit", Brackets(lower, upper), seen, start, confidence, degrees)
    return result if isinstance(result, str) else replace(result, ladders=True)


def _fitted(
    link: Link, terms: Terms, seen: Counts, start: Reals, confidence: float, degrees: float
) -> Fit | str:  # fmt: skip
    """Return the maximum-likelihood coefficients with their covariance, or a message why there are none."""
    number = totals(seen.term, seen.number, len(terms))
    with np.errstate(all="ignore"):  # probabilities of extreme terms are exactly 0 or 1
        maximum = _maximum(terms, number, start)
        if maximum is None:
            return NO_MAXIMUM
        coefficients, at = maximum
        covariance = _covariance(terms, seen, coefficients, at.information)
    if covariance is None:
        return NO_ERRORS
    covariance = terms.back @ covariance @ terms.back.T
    if not (np.isfinite(covariance).all() and (np.diag(covariance) > 0).all()):
        return NO_ERRORS
    return Fit(link, terms.back @ coefficients, covariance, at.value, confidence, degrees)


def _sums(terms: Terms, number: Reals, coefficients: Reals) -> Sums:
    """Return log-likelihood, gradient and information, summed over all terms times the number of runs of each."""
    k = coefficients.size
    value, gradient, information = 0.0, np.zeros(k), np.zeros((k, k))
    for part in _parts(len(terms)):
        slopes, often = terms.at(coefficients, part), number[part]
        value += float(often @ slopes.value)
        gradient += often @ slopes.score
        information += np.einsum("n,nkl->kl", often, slopes.information)
    return Sums(value, gradient, information)


def _parts(count: int) -> Iterator[slice]:
    for first in range(0, count, TERMS_PER_BLOCK):
        yield slice(first, min(first + TERMS_PER_BLOCK, count))


def _maximum(terms: Terms, number: Reals, start: Reals) -> tuple[Reals, Sums] | None:
    """Return the coefficients that maximise a concave log-likelihood, and its sums there; None if there is no maximum.

    Newton's method with halved steps.
    """
    at, sums = start, _sums(terms, number, start)
    for _ in range(MAX_NEWTON_STEPS):
        if not _tells(sums.information):
            return None
        step = np.linalg.solve(sums.information, sums.gradient)
        if float(sums.gradient @ step) < MIN_DECREMENT * number.sum():
            last = _sums(terms, number, at + step)
            return (at + step, last) if np.isfinite(last.value) else None
        part = 1.0
        while not (new := _sums(terms, number, at + part * step)).value >= sums.value and part > MIN_STEP_SHARE:
            part /= 2
        at, sums = at + part * step, new
    return None


def _tells(information: Reals) -> bool:
    """Return whether an information matrix, or each of several, bounds the coefficients in every direction."""
    if not np.isfinite(information).all():
        return False
    values = np.linalg.eigvalsh(information)
    return bool(((values[..., -1] > 0) & (values[..., 0] > MIN_EIGENVALUE_RATIO * values[..., -1])).all())


def _covariance(terms: Terms, seen: Counts, coefficients: Reals, information: Reals) -> Reals | None:
    """Return the covariance of the coefficients; None if the data do not determine it.

    If every record has one run, the covariance is the inverse of the information matrix. Otherwise runs of one record
    depend on each other, and a jackknife over the G records estimates it: each record is left out in turn, and the
    covariance is (G - 1)/G times the sum of the squared changes of the coefficients. Each change is approximated by one
    Newton step with the information matrix of the other records [MacKinnon, Nielsen & Webb 2023, J. Appl. Econometrics
    38, 671-694]. Complete refits instead leave the slope unbounded in one of two studies of seven records, and the
    usual sandwich estimator gives intervals that are too narrow; docs/fragility.md has trials.
    """
    if not seen.repeated:
        return np.asarray(np.linalg.inv(information)) if _tells(information) else None
    score, own_information = _by_record(terms, seen, coefficients)
    rest = information - own_information
    if not _tells(rest):
        return None
    moved = np.linalg.solve(rest, score[:, :, None])[:, :, 0]
    return np.asarray(moved.T @ moved * (seen.records - 1) / seen.records)


def _by_record(terms: Terms, seen: Counts, coefficients: Reals) -> tuple[Reals, Reals]:
    """Return gradient (g, k) and information (g, k, k) of the runs of each record."""
    k = coefficients.size
    score, information = np.zeros((seen.records, k)), np.zeros((seen.records, k, k))
    order = np.argsort(seen.term, kind="stable")
    ends = np.searchsorted(seen.term[order], np.arange(0, len(terms) + TERMS_PER_BLOCK, TERMS_PER_BLOCK))
    for part, (start, stop) in zip(_parts(len(terms)), pairwise(ends), strict=True):
        slopes, those = terms.at(coefficients, part), order[start:stop]
        which, often, record = seen.term[those] - part.start, seen.number[those], seen.record[those]
        for i in range(k):
            score[:, i] += totals(record, often * slopes.score[which, i], seen.records)
            for j in range(k):
                information[:, i, j] += totals(record, often * slopes.information[which, i, j], seen.records)
    return score, information


def wilson(share: Reals, trials: float | Reals, quantile: float | Reals) -> tuple[Reals, Reals]:
    """Return the lower and the upper end of Wilson's interval of a share counted in a number of trials.

    Parameters
    ----------
    share : ndarray
        The shares, from 0 to 1.
    trials : float or ndarray
        Number of trials of each share.
    quantile : float or ndarray
        Quantile of the standard normal distribution at the upper end.

    Examples
    --------
    >>> [each.round(4).tolist() for each in wilson(np.array([0.0, 0.5]), 200, 1.645)]
    [[0.0, 0.4422], [0.0133, 0.5578]]
    """
    z2 = quantile**2 / trials
    middle = (share + z2 / 2) / (1 + z2)
    half = np.sqrt(z2 * (share * (1 - share) + z2 / 4)) / (1 + z2)
    return np.clip(middle - half, 0.0, share), np.clip(middle + half, share, 1.0)


def fractile(peaks: Reals, q: float) -> Reals:
    """Return the q-fractile of peaks under several motions; overturning ranks above any peak.

    Parameters
    ----------
    peaks : ndarray, shape (m, n)
        Peaks under m motions, inf for overturning; NaN values are left out.
    q : float
        Fractile in [0, 1]; 0.5 for the median.

    Returns
    -------
    ndarray, shape (n,)
        By linear interpolation between the ordered peaks, of which the k-th has the fractile (k - 1)/(m - 1); inf if a
        neighbour in the order overturns, NaN if there is no peak.
    """
    ordered = np.sort(peaks, axis=0)  # NaNs come last
    last = np.maximum(np.count_nonzero(~np.isnan(peaks), axis=0) - 1, 0)
    place = np.round(q * last, 9)  # so that rounding gives no weight to a neighbour
    k = np.floor(place).astype(int)
    below, above = (np.take_along_axis(ordered, row[None], axis=0)[0] for row in (k, np.ceil(place).astype(int)))
    with np.errstate(invalid="ignore"):  # inf - inf is NaN, which is replaced
        between: Reals = below + (place - k) * (above - below)
    return np.where(below == above, below, between)

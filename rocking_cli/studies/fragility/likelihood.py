"""Maximum likelihood of a linear predictor eta = X c, from runs that exceed or do not, or from bracketed capacities."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Reals = NDArray[np.float64]
Bools = NDArray[np.bool_]
Integers = NDArray[np.int64]
Link = Literal["probit", "logit"]

FARTHEST = 30.0  # of eta: probabilities beyond are 0 or 1, and their ratios are still numbers
STEPS = 100  # of Newton's method, which takes about six
DECREMENT = 1e-12  # of the log-likelihood per record, before the last of them
SHORTEST = 1e-10  # part of a step
SEPARABLE = 1e-9  # per run, of the margin by which a line separates
ROUNDING = 1e-9  # of the largest eigenvalue of a covariance: a negative one beyond it is no rounding
NO_MAXIMUM = "the likelihood found no maximum: the data hardly tell a slope"
NO_ERRORS = "the errors of the fit cannot be told: its covariance is not positive semi-definite"


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


@dataclass(frozen=True, eq=False)
class Fit:
    """The likeliest coefficients of a linear predictor.

    Parameters
    ----------
    link : str
        `probit`, P = Phi(eta), or `logit`, P = 1/(1 + exp(-eta)).
    coefficients : ndarray, shape (k,)
        c.
    covariance : ndarray, shape (k, k)
        Of the coefficients.
    log_likelihood : float
        Its maximum.
    confidence : float
        Of the intervals.
    degrees : float
        Of freedom of Student's distribution, on which the intervals are based; infinite: the normal one.
    """

    link: Link
    coefficients: Reals
    covariance: Reals
    log_likelihood: float
    confidence: float
    degrees: float = np.inf

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
        """P of each row of the design, shape (n,)."""
        return cumulative(self.link, design @ self.coefficients)

    def band(self, design: Reals) -> tuple[Reals, Reals]:
        """Confidence limits of P of each row: those of eta, through the link, so that they stay within 0 and 1."""
        eta = design @ self.coefficients
        variance = np.einsum("ij,jk,ik->i", design, self.covariance, design)
        reach = self.quantile * np.sqrt(np.maximum(variance, 0.0))  # what rounding leaves of a variance of zero
        return cumulative(self.link, eta - reach), cumulative(self.link, eta + reach)


def cumulative(link: Link, eta: Reals) -> Reals:
    """P at eta."""
    from scipy.special import expit, ndtr

    result: Reals = ndtr(eta) if link == "probit" else expit(eta)
    return result


def density(link: Link, eta: Reals) -> Reals:
    """dP/d eta."""
    if link == "probit":
        return _normal(eta)
    return cumulative(link, eta) * cumulative(link, -eta)


def _normal(u: Reals) -> Reals:
    """Density of the standard normal distribution; 0 where u is infinite."""
    result: Reals = np.exp(-u * u / 2) / np.sqrt(2 * np.pi)
    return result


def standardised(design: Reals) -> tuple[Reals, Reals]:
    """A design whose columns after the first, of ones, are about their mean, in units of their deviation.

    Neither the unit of an intensity nor how far from one it lies then matters to a fit.

    Returns
    -------
    design : ndarray, shape (n, k)
        The new one.
    back : ndarray, shape (k, k)
        Coefficients of the new one times this are those of the old one.
    """
    mean, deviation = design[:, 1:].mean(axis=0), design[:, 1:].std(axis=0)
    back = np.diag(np.concatenate([[1.0], 1 / deviation]))
    back[0, 1:] = -mean / deviation
    return np.column_stack([design[:, :1], (design[:, 1:] - mean) / deviation]), back


def _returned(back: Reals, coefficients: Reals, covariance: Reals) -> tuple[Reals, Reals] | None:
    """What was fitted to a standardised design, in terms of the old one; None if the covariance is none."""
    covariance = (covariance + covariance.T) / 2
    if not (np.isfinite(covariance).all() and np.isfinite(coefficients).all()):
        return None
    values = np.linalg.eigvalsh(covariance)
    if values[0] < -ROUNDING * values[-1]:
        return None
    covariance = back @ covariance @ back.T
    return (back @ coefficients, covariance) if (np.diag(covariance) > 0).all() else None


def fit_binomial(link: Link, design: Reals, exceeded: Bools, record: Integers, confidence: float) -> Fit | str:
    """Fit a predictor to runs that exceed or do not.

    Parameters
    ----------
    link : str
        `probit` or `logit`.
    design : ndarray, shape (n, k)
        X, a row a run, ones first. The caller has made sure that no column after it is constant, and that no plane
        separates the outcomes.
    exceeded : ndarray of bool, shape (n,)
        Whether the run exceeds.
    record : ndarray of int, shape (n,)
        The record of the run. Where one occurs twice the covariance allows for runs of one record being alike
        (cluster-robust), with Student's distribution of one degree of freedom less than there are records.
    confidence : float
        Of the intervals.

    Returns
    -------
    Fit or str
        Why there is none: the iteration does not settle, or its covariance is not positive semi-definite.
    """
    from statsmodels.genmod.families import Binomial
    from statsmodels.genmod.families.links import Logit, Probit
    from statsmodels.genmod.generalized_linear_model import GLM

    family = Binomial(link=Probit() if link == "probit" else Logit())
    standard, back = standardised(design)
    model = GLM(exceeded.astype(np.float64), standard, family=family)
    records = np.unique(record).size
    clustered = records < record.size
    options = {"cov_type": "cluster", "cov_kwds": {"groups": record}} if clustered else {}
    try:
        with np.errstate(all="ignore"):  # of a run far out, whose probability is 0 or 1 to the last bit
            found = model.fit(**options)
            coefficients, covariance = np.asarray(found.params), np.asarray(found.cov_params())
            log_likelihood = float(found.llf)
    except np.linalg.LinAlgError:
        return NO_MAXIMUM
    if not found.converged:
        return NO_MAXIMUM
    returned = _returned(back, coefficients, covariance)
    if returned is None:
        return NO_ERRORS
    return Fit(link, *returned, log_likelihood, confidence, records - 1.0 if clustered else np.inf)


def too_few(record: Integers, coefficients: int) -> str:
    """What to say if records repeat and are too few to tell how runs of one record are alike; else empty."""
    records = np.unique(record).size
    if records == record.size or records > coefficients:
        return ""
    return (
        f"the {record.size} runs are of {records} record{'s' * (records > 1)}: {coefficients + 1} are needed at least"
    )


def fit_brackets(lower: Reals, upper: Reals, record: Integers, confidence: float) -> Fit | str:
    """Fit eta = a + b u to capacities u that are normal with mean -a/b and deviation 1/b, and known to within brackets.

    Parameters
    ----------
    lower, upper : ndarray, shape (n,)
        The brackets; minus and plus infinity where open. The caller has made sure that no point lies in all of them.
    record : ndarray of int, shape (n,)
        The record that a capacity is of. Where one has several the covariance is cluster-robust, as in `fit_binomial`.
    confidence : float
        Of the intervals.

    Returns
    -------
    Fit or str
        Why there is none, as of `fit_binomial`. The covariance is that of the observed information; intervals are by
        Student's distribution of one degree of freedom less than there are records, as they are for the mean of
        capacities known exactly.

    Notes
    -----
    The log-likelihood, sum ln[Phi(a + b upper) - Phi(a + b lower)], is concave in a and b: Newton's method with halved
    steps finds its one maximum.
    """
    ends = np.concatenate([lower[np.isfinite(lower)], upper[np.isfinite(upper)]])
    mean, deviation = ends.mean(), ends.std()
    back = np.array([[1.0, -mean / deviation], [0.0, 1 / deviation]])
    lower, upper = (lower - mean) / deviation, (upper - mean) / deviation
    coefficients = np.array([0.0, 1.0])
    value, scores, hessian = _bracketed(coefficients, lower, upper)
    for _ in range(STEPS):
        gradient = scores.sum(axis=0)
        try:
            step = np.linalg.solve(-hessian, gradient)
        except np.linalg.LinAlgError:
            return NO_MAXIMUM
        gain = float(gradient @ step)
        if gain < DECREMENT * lower.size:
            covariance, records = _clustered(np.linalg.inv(-hessian).astype(np.float64), scores, record)
            returned = _returned(back, coefficients + step, covariance)
            return Fit("probit", *returned, value, confidence, records - 1.0) if returned is not None else NO_ERRORS
        part = 1.0
        while _bracketed(coefficients + part * step, lower, upper)[0] < value and part > SHORTEST:
            part /= 2
        coefficients = coefficients + part * step
        value, scores, hessian = _bracketed(coefficients, lower, upper)
    return NO_MAXIMUM


def _clustered(covariance: Reals, scores: Reals, record: Integers) -> tuple[Reals, int]:
    """The covariance that allows for records that repeat to be alike, and how many records there are."""
    which, group = np.unique(record, return_inverse=True)
    if which.size == record.size:
        return covariance, which.size
    sums = np.zeros((which.size, scores.shape[1]))
    np.add.at(sums, group, scores)
    sums -= sums.mean(axis=0)  # what the last step of the iteration left
    return covariance @ (sums.T @ sums) @ covariance * which.size / (which.size - 1), which.size


def _bracketed(coefficients: Reals, lower: Reals, upper: Reals) -> tuple[float, Reals, Reals]:
    """Log-likelihood of brackets, its gradient bracket by bracket, and its Hessian; minus infinity if one is turned."""
    from scipy.special import log_ndtr

    a, b = coefficients
    u, v = (np.where(np.isfinite(end), end, 0.0) for end in (lower, upper))
    low = np.where(np.isfinite(lower), a + b * u, -np.inf)
    high = np.where(np.isfinite(upper), a + b * v, np.inf)
    if (low >= high).any():
        return -np.inf, np.zeros((lower.size, 2)), np.eye(2)
    flip = low > 0  # the tail in which a difference of small numbers loses nothing
    top, bottom = log_ndtr(np.where(flip, -low, high)), log_ndtr(np.where(flip, -high, low))
    log_part = top + np.log(-np.expm1(bottom - top))
    # phi/[Phi(high) - Phi(low)] at either end, and the derivatives of the logarithm by high and low.
    at_low, at_high = (np.exp(-end * end / 2 - log_part) / np.sqrt(2 * np.pi) for end in (low, high))
    low, high = (np.where(np.isfinite(end), end, 0.0) for end in (low, high))
    by_high, by_low = -high * at_high - at_high**2, low * at_low - at_low**2
    both = at_high * at_low
    scores = np.column_stack([at_high - at_low, at_high * v - at_low * u])
    mixed = (by_high * v + by_low * u + both * (u + v)).sum()
    hessian = np.array(
        [
            [(by_high + by_low + 2 * both).sum(), mixed],
            [mixed, (by_high * v * v + by_low * u * u + 2 * both * u * v).sum()],
        ]
    )
    return float(log_part.sum()), scores, hessian


def separable(design: Reals, exceeded: Bools) -> bool:
    """Whether a plane has all that exceed on or above it and all others on or below, not all on it.

    Then the likelihood has no maximum: it grows for ever as the predictor is made steeper [Albert & Anderson 1984,
    Biometrika 71, 1-10]. Found by linear programming; the columns of the design should be of the order of one.
    """
    from scipy.optimize import linprog

    signed = np.where(exceeded, 1.0, -1.0)[:, None] * design
    found = linprog(-signed.sum(axis=0), A_ub=-signed, b_ub=np.zeros(exceeded.size), bounds=(-1, 1))
    return bool(-found.fun > SEPARABLE * exceeded.size)

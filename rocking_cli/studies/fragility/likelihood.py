"""Log-likelihood of each observation under a linear predictor eta = X c, with its derivatives."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

Reals = NDArray[np.float64]
Bools = NDArray[np.bool_]
Integers = NDArray[np.int64]
Link = Literal["probit", "logit"]

FARTHEST = 30.0  # of eta: probabilities beyond are 0 or 1, and their ratios are still numbers
SEPARABLE = 1e-9  # per run, of the margin by which a line separates


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


class Terms(Protocol):
    """The different observations of a fit, each with a log-likelihood that is concave in the coefficients.

    Parameters
    ----------
    back : ndarray, shape (k, k)
        Matrix that converts coefficients of the standardised design to the caller's units.
    """

    back: Reals

    def __len__(self) -> int: ...

    def at(self, coefficients: Reals, part: slice) -> Slopes:
        """Return log-likelihoods and derivatives of some of the terms at given coefficients."""
        ...


class ExceedanceTerms:
    """The terms of runs: for each row of a design, a run that exceeds or one that does not.

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
        """Return log-likelihoods and derivatives, as `Terms.at`."""
        from scipy.special import expit, log_expit, log_ndtr

        design, sign = self._design[part], self._sign[part]
        eta = sign * (design @ coefficients)
        if self._link == "probit":
            value = log_ndtr(eta)
            ratio = np.exp(-eta * eta / 2 - value) / np.sqrt(2 * np.pi)  # phi/Phi
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
        """Return log-likelihoods ln[Phi(a + b upper) - Phi(a + b lower)] and derivatives, as `Terms.at`."""
        from scipy.special import log_ndtr

        a, b = coefficients
        lower, upper = self._lower[part], self._upper[part]
        if b <= 0:  # the bounds would change places
            n = lower.size
            return Slopes(np.full(n, -np.inf), np.zeros((n, 2)), np.broadcast_to(np.eye(2), (n, 2, 2)))
        u, v = (np.where(np.isfinite(end), end, 0.0) for end in (lower, upper))
        low = np.where(np.isfinite(lower), a + b * u, -np.inf)
        high = np.where(np.isfinite(upper), a + b * v, np.inf)
        flip = low > 0  # the tail in which a difference of small numbers loses nothing
        top, bottom = log_ndtr(np.where(flip, -low, high)), log_ndtr(np.where(flip, -high, low))
        value = top + np.log(-np.expm1(bottom - top))
        # phi/[Phi(high) - Phi(low)] at either end.
        at_low, at_high = (np.exp(-end * end / 2 - value) / np.sqrt(2 * np.pi) for end in (low, high))
        low, high = (np.where(np.isfinite(end), end, 0.0) for end in (low, high))
        score = np.stack([at_high - at_low, at_high * v - at_low * u], axis=-1)
        # In this form little cancels where a bracket is narrow.
        information = score[:, :, None] * score[:, None, :]
        for weight, end in ((high * at_high, v), (-low * at_low, u)):
            row = np.stack([np.ones_like(end), end], axis=-1)
            information += weight[:, None, None] * row[:, :, None] * row[:, None, :]
        return Slopes(value, score, information)


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
    found = linprog(-signed.sum(axis=0), A_ub=-signed, b_ub=np.zeros(exceeded.size), bounds=(-1, 1))
    return bool(-found.fun > SEPARABLE * exceeded.size)

"""Fragility as a function of two intensity measures at once."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from rocking_cli.errors import InputError
from rocking_cli.studies.fragility.fit import Counts, Estimate, Fit, fit_outcomes, too_few
from rocking_cli.studies.fragility.likelihood import Bools, Integers, Reals, separable, standardised
from rocking_cli.studies.fragility.observed import SAME, few_records

ADDS = 0.05  # p-value below which a second measure adds something
PARALLEL = 1e-4  # 1 - |correlation| of two measures that are one


@dataclass(frozen=True, eq=False)
class Surface:
    """Probability of exceedance as a function of two intensities, P = Phi(c0 + c1 ln x1 + c2 ln x2).

    Parameters
    ----------
    kind : str
        `lognormal` or `none`.
    why : str
        A sentence on why there is no surface, or on how the two measures compare.
    confidence : float
        Confidence level of the intervals.
    runs, exceedances : int
        Number of runs, and how many exceed.
    fit : Fit or None
        The coefficients, with their covariance.
    aic : dict of str to float or None
        Akaike's criterion with `both`, and with the `first` and the `second` measure alone.
    p_values : tuple of float or None
        P-values of the gain from adding the first measure to the second, and the second to the first: by the likelihood
        ratio, or if records repeat by the robust standard error.
    records : int
        Number of different records.
    """

    kind: Literal["lognormal", "none"]
    why: str
    confidence: float
    runs: int
    exceedances: int
    fit: Fit | None = None
    aic: dict[str, float] | None = None
    p_values: tuple[float, float] | None = None
    records: int = 0

    @property
    def warning(self) -> str:
        """Warning that there are too few records for reliable intervals; empty if there are enough."""
        return few_records(self.records) if self.fit is not None else ""

    @property
    def coefficients(self) -> list[Estimate] | None:
        """The coefficients c0, c1 and c2 with their confidence intervals; None without a fit."""
        return None if self.fit is None else self.fit.intervals

    def probability(self, x1: Reals, x2: Reals) -> Reals:
        """Return the probability of exceedance at positive intensities of one shape; NaN without a fit."""
        x1, x2 = np.broadcast_arrays(x1, x2)
        if self.fit is None:
            return np.full(x1.shape, np.nan)
        return self.fit.probability(_design(x1.ravel(), x2.ravel())).reshape(x1.shape)


def fit_surface(
    x1: Reals,
    x2: Reals,
    exceeding: Bools | Reals | Integers,
    record: Integers,
    *,
    runs: Integers | None = None,
    confidence: float = 0.95,
    weight: Reals | None = None,
) -> Surface:
    """Fit the probability of exceedance as a function of two intensity measures.

    Parameters
    ----------
    x1, x2 : ndarray, shape (n,)
        Intensities, positive.
    exceeding : ndarray, shape (n,)
        Whether the run exceeds the limit state, or the number of equal runs that do.
    record : ndarray of int, shape (n,)
        The record of each run.
    runs : ndarray of int, shape (n,), optional
        Number of equal runs; one unless given.
    confidence : float
        Confidence level of the intervals.
    weight : ndarray, shape (n,), optional
        Relative weight of each run; equal unless given.

    Returns
    -------
    Surface
        Of kind `none` if a line in the plane of the logarithms separates the outcomes, or the measures are
        proportional.

    Raises
    ------
    InputError
        If an intensity is not a positive number.
    """
    for name, x in (("first", x1), ("second", x2)):
        if not ((x > 0) & np.isfinite(x)).all():
            raise InputError(f"the {name} intensity of a run is not a positive number: leave out what is not shaken")
    who = np.unique(record, return_inverse=True)[1]
    number = np.ones(x1.size) if runs is None else runs.astype(np.float64)
    seen, beyond = Counts(who, np.arange(x1.size), number), np.asarray(exceeding, dtype=np.float64)
    bare = Surface("none", "", confidence, int(number.sum()), int(beyond.sum()), records=seen.records)
    if not 0 < bare.exceedances < bare.runs:
        return replace(bare, why=f"{'none' if not bare.exceedances else 'all'} of the {bare.runs} runs exceed")
    if weight is not None:
        each = weight * number.sum() / (weight * number).sum()
        number, beyond = number * each, beyond * each
        seen = Counts(seen.record, seen.term, number, weighted=True)
    design = _design(x1, x2)
    if (np.ptp(design[:, 1:], axis=0) < SAME).any():
        return replace(bare, why="one of the measures is the same in all runs: take a curve over the other one")
    if bare.runs <= design.shape[1]:
        return replace(bare, why=f"{bare.runs} runs cannot tell {design.shape[1]} coefficients")
    correlation = float(np.corrcoef(design[:, 1], design[:, 2])[0, 1])
    if 1 - abs(correlation) < PARALLEL:
        return replace(
            bare, why="the two measures are in proportion (of their logarithms): take a curve over either one"
        )
    if _separable(design, number, beyond):
        why = "a line in the plane of the two measures separates what exceeds from what does not"
        return replace(bare, why=f"{why}: the likelihood has no maximum, more runs near the line are needed")
    if few := too_few(seen, 3):
        return replace(bare, why=few)
    fits = [
        fit_outcomes("probit", design[:, columns], seen, beyond, confidence) for columns in ([0, 1, 2], [0, 1], [0, 2])
    ]
    for fit in fits:
        if isinstance(fit, str):
            return replace(bare, why=fit)
    both, first, second = (fit for fit in fits if isinstance(fit, Fit))
    if (both.coefficients[1:] <= 0).all():
        return replace(bare, why="no surface increases: fewer runs exceed the limit as either measure increases")
    p_values = (_gain(both, second, 1, seen.repeated), _gain(both, first, 2, seen.repeated))
    aic = {"both": both.aic, "first": first.aic, "second": second.aic}
    why = _words(both, p_values, aic)
    return replace(bare, kind="lognormal", why=why, fit=both, aic=aic, p_values=p_values)


def _design(x1: Reals, x2: Reals) -> Reals:
    return np.column_stack([np.ones(x1.size), np.log(x1), np.log(x2)])


def _separable(design: Reals, number: Reals, exceeding: Reals) -> bool:
    """Return whether a line separates the runs that exceed from the others; mixed outcomes at one place only."""
    standard = standardised(design)[0]
    some, none = exceeding > 0, exceeding < number
    return separable(np.concatenate([standard[some], standard[none]]), np.arange(some.sum() + none.sum()) < some.sum())


def _gain(both: Fit, alone: Fit, column: int, clustered: bool) -> float:
    """Return the p-value of adding a measure; with repeated records by the standard error, as no chi-square holds."""
    from scipy.special import chdtrc, stdtr

    if clustered:
        error = float(np.sqrt(both.covariance[column, column]))
        return 2 * float(stdtr(both.degrees, -abs(both.coefficients[column]) / error))
    return float(chdtrc(1, 2 * (both.log_likelihood - alone.log_likelihood)))


def _words(both: Fit, p_values: tuple[float, float], aic: dict[str, float]) -> str:
    said = [
        f"the {name} measure {'adds to' if p < ADDS else 'adds nothing detectable to'} the {other} (p = {p:.2g})"
        for name, other, p in (("second", "first", p_values[1]), ("first", "second", p_values[0]))
    ]
    if max(p_values) >= ADDS:
        alike = min(p_values) >= ADDS  # neither adds to the other: then the likelier one
        better = "first" if (aic["first"] <= aic["second"] if alike else p_values[0] < ADDS) else "second"
        said.append(f"a curve over the {better} measure alone is sufficient")
    falls = [name for name, c in zip(("first", "second"), both.coefficients[1:], strict=True) if c < 0]
    said += [
        f"at a fixed value of the other measure, fewer runs exceed the limit as the {name} one increases"
        for name in falls
    ]
    return "; ".join(said)

"""Fragility curves and surfaces: the probability that a limit state is exceeded, as a function of intensity."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from rocking_cli.arrays import Bools, Integers, Reals
from rocking_cli.questions.fragility.observed import (
    INTENSITY_TOLERANCE,
    Goodness,
    Observations,
    even,
    few_records,
    goodness_of_brackets,
    goodness_of_runs,
    one_of_each,
)
from rocking_cli.short_repr import short_repr
from rocking_cli.studies.fit import (
    Counts,
    Estimate,
    Fit,
    Link,
    fit_brackets,
    fit_outcomes,
    separable,
    standardised,
    too_few,
    totals,
)

Kind = Literal["lognormal", "logit", "logistic", "step", "none"]
LINKS: dict[Kind, Link] = {"lognormal": "probit", "logit": "logit", "logistic": "logit"}
CHOICE: tuple[Kind, ...] = ("lognormal", "logistic")  # kinds from which a study chooses
# Standard deviation of the logarithm of the capacity times the slope, of the kinds that are fitted in ln x.
DEVIATIONS: dict[Kind, float] = {"lognormal": 1.0, "logit": float(np.pi / np.sqrt(3))}
MIN_P_VALUE = 0.05  # least p-value of a curve that is not rejected
MAX_DISPERSION = 5.0  # dispersion above which the limit state does not depend on the measure: exp(5) is 150
LIKELIHOOD_TOLERANCE = 1e-6  # smaller differences of log-likelihoods are rounding
_DECREASING = (
    "no increasing curve exists: fewer runs count as exceeding the limit at higher intensities, so no curve fits this "
    "measure"
)
ZERO_INTENSITY = 1e-300  # replaces zero, which has no logarithm
MIN_CUT = 0.001  # change of a probability: smaller cuts of a curve are not reported


@dataclass(frozen=True)
class Cut:
    """Limit state that cuts a curve, the largest change of the curve or its band, and its intensity."""

    by: str | float
    most: float
    at: float


@dataclass(frozen=True, eq=False)
class FittedToRuns:
    """A fit to runs by maximum likelihood, or the reason why there is none.

    Parameters
    ----------
    kind : str
        The form of the fit; `none` without one.
    why : str
        A sentence on why this kind was chosen, or why there is no fit.
    confidence : float
        Confidence level of all intervals and bands.
    runs, exceedances : int
        Number of runs, or of capacities, and how many of them exceed.
    fit : Fit or None
        The coefficients, with their covariance.
    records : int
        Number of different records.
    """

    kind: Kind
    why: str
    confidence: float
    runs: int
    exceedances: int
    fit: Fit | None = None
    records: int = 0

    @property
    def warning(self) -> str:
        """Warning that there are too few records for reliable intervals; empty if there are enough."""
        return few_records(self.records) if self.fit is not None else ""


@short_repr
@dataclass(frozen=True, eq=False)
class FragilityCurve(FittedToRuns):
    """A fragility curve, or the reason why none could be fitted; other fields as in `FittedToRuns`.

    Parameters
    ----------
    kind : str
        `lognormal`: P = Phi(ln(x/median)/dispersion), fitted in 1 and ln x. `logit`: P = 1/(1 + (median/x)^b), fitted
        in 1 and ln x; its dispersion is pi/(sqrt(3) b). `logistic`: P = 1/(1 + exp(-(x - median)/scale)), fitted in 1
        and x. `step`: no run exceeds up to one intensity, all exceed from another one on. `none`: no curve.
    step : Estimate or None
        Intensity at which the step is placed, and the interval in which it lies.
    goodness : Goodness or None
        Goodness-of-fit test of the kind that was chosen.
    aic : dict of str to float, or None
        Akaike's criterion of the kinds that were fitted; it ignores the dependence between runs of one record.
    implied : mapping of limit state to FragilityCurve
        Curves of limit states that are exceeded whenever this one is. Probability, band and median are cut by them: no
        structure overturns that does not uplift.
    """

    step: Estimate | None = None
    goodness: Goodness | None = None
    aic: dict[Kind, float] | None = None
    implied: Mapping[str | float, FragilityCurve] = field(default_factory=dict)

    @property
    def own(self) -> FragilityCurve:
        """The curve as it was fitted, without its cuts."""
        return replace(self, implied={})

    @property
    def is_exact(self) -> bool:
        """Whether the curve is a step at an exactly known intensity, which a motion must exceed."""
        return self.step is not None and self.step.low == self.step.high

    @property
    def steps(self) -> list[Estimate]:
        """The step of this curve and those of the curves that cut it: below each, the probability is zero."""
        return [each.step for each in (self, *self.implied.values()) if each.step is not None]

    @property
    def p_value(self) -> float | None:
        """P-value of the goodness-of-fit test; None if there is no curve or test."""
        return None if self.goodness is None else self.goodness.p_value

    @property
    def rejected(self) -> bool:
        """Whether the goodness-of-fit test rejects this kind of curve at 5 %."""
        return self.p_value is not None and self.p_value < MIN_P_VALUE

    @property
    def median(self) -> Estimate | None:
        """Intensity of probability one half, in the unit of x; its interval is where the band crosses one half."""
        median = self.step
        if self.fit is not None:
            a, b = self.fit.coefficients
            with np.errstate(over="ignore"):  # the data may hardly bound an end
                ends = [float(u if self.kind == "logistic" else np.exp(u)) for u in (-a / b, *_root_interval(self.fit))]
            median = Estimate(*ends)
        if median is None:
            return None
        known = [median, *filter(None, (each.median for each in self.implied.values()))]
        # The minimum of increasing curves crosses one half at the largest of their medians.
        return Estimate(*(max(getattr(each, end) for each in known) for end in ("value", "low", "high")))

    @property
    def dispersion(self) -> Estimate | None:
        """Standard deviation of the logarithm of the capacity; None unless it is fitted in ln x, or above 5."""
        spread = self._inverse_slope(DEVIATIONS[self.kind]) if self.kind in DEVIATIONS else None
        return spread if spread is None or spread.value <= MAX_DISPERSION else None

    @property
    def scale(self) -> Estimate | None:
        """Scale of a logistic curve, in the unit of x; None for other kinds."""
        return self._inverse_slope() if self.kind == "logistic" else None

    @property
    def unbounded(self) -> bool:
        """Whether the upper confidence limit of the median is infinite: the band then covers nearly everything."""
        median = self.own.median
        return self.fit is not None and median is not None and not np.isfinite(median.high)

    def _inverse_slope(self, times: float = 1.0) -> Estimate:
        assert self.fit is not None
        slope = self.fit.intervals[1]
        return Estimate(times / slope.value, times / slope.high, times / slope.low if slope.low > 0 else np.inf)

    def probability(self, x: Reals) -> Reals:
        """Return the probability of exceedance at intensities of any shape; NaN if there is no curve."""
        return np.asarray(self.lines(x)[0])

    def band(self, x: Reals) -> tuple[Reals, Reals]:
        """Return pointwise confidence limits of the probability at intensities; 0 and 1 within a step's interval."""
        _, low, high = self.lines(x)
        return low, high

    def lines(self, x: Reals) -> Reals:
        """Return the probability at intensities of any shape and the limits of its band, shape (3, ...)."""
        x = np.asarray(x, dtype=np.float64)
        uncut = np.full((3, *x.shape), np.nan)
        if self.fit is not None:
            design = _design(self.kind, x)
            uncut = np.reshape([self.fit.probability(design), *self.fit.band(design)], uncut.shape)
        elif self.step is not None:
            step = np.heaviside(x - self.step.value, 0.0 if self.is_exact else 0.5)
            within = x > self.step.low
            uncut = np.array([step, (x >= self.step.high) & within, within], dtype=np.float64)
        return np.asarray(np.min([uncut, *(each.lines(x) for each in self.implied.values())], axis=0))

    def cut(self, x: Reals) -> Cut | None:
        """Return the largest cut of the curve or its band at some intensities (n,); None if it is nowhere noticeable.

        Parameters
        ----------
        x : ndarray, shape (n,)
            The intensities.
        """
        if not self.implied:
            return None
        above = self.own.lines(x) - np.array([each.lines(x) for each in self.implied.values()])
        if above.max() <= MIN_CUT:
            return None
        k, line, place = (int(each) for each in np.unravel_index(above.argmax(), above.shape))
        return Cut(list(self.implied)[k], float(above[k, line, place]), float(x[place]))


def fit_curve(observations: Observations, *, confidence: float = 0.95, only: Kind | None = None) -> FragilityCurve:
    """Fit a fragility curve to runs at any intensities: a cloud, or stripes.

    Parameters
    ----------
    observations : Observations
        The runs.
    confidence : float
        Confidence level of the intervals and the band.
    only : {"lognormal", "logit", "logistic"}, optional
        The kind of curve to fit, without a choice between lognormal and logistic.

    Returns
    -------
    FragilityCurve
        Of kind `none` if there is nothing to fit. Of kind `step` if all runs that exceed lie above all that do not, as
        the likelihood then increases without bound with the slope. Of kind `logistic` if the lognormal curve does not
        increase, or if it is rejected at 5 % and the logistic curve is likelier. Otherwise of kind `lognormal`. The
        logistic curve is a function of the intensity itself: as a function of its logarithm, it would differ by less
        than 0.01 from the lognormal curve and be rejected with it.
    """
    seen = observations
    bare = FragilityCurve("none", "", confidence, seen.runs, seen.exceedances, records=seen.counts.records)
    if why := _all_alike(bare):
        return replace(bare, why=why)
    if (special := _step_or_none(bare, *seen.sides, too_few(seen.counts, 2))) is not None:
        return special
    kinds = CHOICE if only is None else (only,)
    designs = {kind: _design(kind, seen.x) for kind in kinds}
    tried = {kind: fit_outcomes(LINKS[kind], designs[kind], seen.counts, seen.exceeding, confidence) for kind in kinds}
    fits = {kind: fit for kind, fit in tried.items() if isinstance(fit, Fit)}
    bare = replace(bare, aic={kind: fit.aic for kind, fit in fits.items()})
    first = tried[kinds[0]]
    if isinstance(first, str):
        return replace(bare, why=first)
    rising = {
        kind: replace(bare, kind=kind, fit=fit, goodness=goodness_of_runs(fit, designs[kind], seen))
        for kind, fit in fits.items()
        if fit.coefficients[1] > 0
    }
    if not rising:
        return replace(bare, why=_DECREASING)
    kind: Kind = "lognormal"
    reason = "lognormal is the default; "
    if only is not None:
        kind, reason = only, ""
    elif "lognormal" not in rising:
        kind, reason = "logistic", "the lognormal does not increase; "
    elif rising["lognormal"].rejected:
        reason = "lognormal is the default, and logistic is no likelier; "
        if "logistic" in rising and fits["logistic"].log_likelihood >= first.log_likelihood + LIKELIHOOD_TOLERANCE:
            p = rising["lognormal"].p_value
            kind, reason = "logistic", f"the lognormal is rejected (p = {p:.2g}) and logistic is likelier; "
    return replace(rising[kind], why=reason + _tested(rising[kind]))


def fit_capacities(
    lower: Reals,
    upper: Reals,
    record: Integers | None = None,
    *,
    levels: Reals | None = None,
    confidence: float = 0.95,
    weight: Reals | None = None,
) -> FragilityCurve:
    """Fit a lognormal curve to the capacities of records: incremental dynamic analysis.

    Parameters
    ----------
    lower, upper : ndarray, shape (n,)
        For each record the last level that does not exceed the limit state, 0 if the first one does; and the first that
        does, infinite if none does. All that is known of the capacity is that it lies between them.
    record : ndarray of int, shape (n,), optional
        The record of each capacity, if a record has several (two polarities, several samples), which are not
        independent.
    levels : ndarray, shape (m,), optional
        The levels that were simulated, if they are the same for all; without them the goodness of fit is not tested.
    confidence : float
        Confidence level of the intervals and the band.
    weight : ndarray, shape (n,), optional
        Relative weight of each capacity; equal unless given.

    Returns
    -------
    FragilityCurve
        Lognormal by maximum likelihood of the brackets; a step if one capacity agrees with all of them; or none.
    """
    ends = one_of_each(np.concatenate([lower, upper, np.zeros(0) if levels is None else levels]))
    lower, upper, tried = np.split(ends, [lower.size, 2 * lower.size])
    who = np.unique(np.arange(lower.size) if record is None else record, return_inverse=True)[1]
    pairs, place = np.unique(np.column_stack([lower, upper]), axis=0, return_inverse=True)
    cells, cell = np.unique(who * len(pairs) + place.ravel(), return_inverse=True)
    number = totals(cell, even(np.ones(lower.size), weight))
    seen = Counts(cells // len(pairs), cells % len(pairs), number, weight is not None)
    below, above = lower[lower > 0], upper[np.isfinite(upper)]
    bare = FragilityCurve("none", "", confidence, lower.size, above.size, records=seen.records)
    if not above.size:
        return replace(bare, why=f"none of the {_capacities(bare)} exceeds at any level")
    if not below.size:
        return replace(bare, why=f"all of the {_capacities(bare)} exceed at their first level: take lower ones")
    if above.max() <= below.min():  # no capacity is known to lie between two levels
        why = f"every capacity lies below {above.max():.4g} or above {below.min():.4g}: levels beyond these are needed"
        return replace(bare, why=why)
    if (special := _step_or_none(bare, below, above, too_few(seen, 2, "capacities"))) is not None:
        return special
    with np.errstate(divide="ignore"):
        low, high = np.log(pairs.T)
    fit = fit_brackets(low, high, seen, confidence)
    if isinstance(fit, str):
        return replace(bare, why=fit)
    goodness = goodness_of_brackets(fit, low, high, seen, None if levels is None else np.log(np.unique(tried)))
    curve = replace(bare, kind="lognormal", fit=fit, goodness=goodness, aic={"lognormal": fit.aic})
    return replace(curve, why=f"capacities are taken as lognormal; {_tested(curve)}")


def _all_alike(bare: FittedToRuns) -> str:
    """Return a sentence if all runs exceed the limit state, or none does; else empty."""
    if 0 < bare.exceedances < bare.runs:
        return ""
    return f"{'none' if not bare.exceedances else 'all'} of the {bare.runs} runs exceed"


def _capacities(bare: FragilityCurve) -> str:
    """Describe the capacities of a curve: the number of ladders and of records."""
    return f"{bare.runs} ladders of {bare.records} records" if bare.runs > bare.records else f"{bare.runs} records"


def _design(kind: Kind, x: Reals) -> Reals:
    x = x.ravel()
    return np.column_stack([np.ones(x.size), x if kind == "logistic" else np.log(np.maximum(x, ZERO_INTENSITY))])


def _step_or_none(bare: FragilityCurve, below: Reals, above: Reals, few: str) -> FragilityCurve | None:
    """Return a step, or kind `none`, if runs that exceed and others share at most one intensity, or records are few."""
    if below.min() == above.max() == below.max() == above.min():
        return replace(bare, why=f"all runs have the intensity {above[0]:.4g}: other levels are needed")
    if above.max() <= below.min():
        return replace(bare, why=_DECREASING)
    if below.max() > above.min():
        return replace(bare, why=few) if few else None
    low, high = float(below.max()), float(above.min())
    if low < high:
        step = Estimate(float(np.sqrt(low * high)), low, high)
        why = f"no run exceeds the limit up to {low:.4g} and all runs do from {high:.4g}"
        why += ", so the dispersion cannot be estimated; add levels between these two"
        return replace(bare, kind="step", step=step, why=why)
    under, over = below[below < low], above[above > low]
    if not (under.size and over.size):
        side = "none exceeds below" if under.size else "all exceed above"
        why = f"both outcomes occur at {low:.4g} only and {side} it: a slope needs levels on either side"
        return replace(bare, why=why)
    step = Estimate(low, float(under.max()), float(over.min()))
    why = f"both outcomes occur at {low:.4g} only, none exceeds up to {step.low:.4g} and all do from {step.high:.4g} on"
    return replace(bare, kind="step", step=step, why=f"{why}: estimating the dispersion needs levels between them")


def _tested(curve: FragilityCurve) -> str:
    """Describe the result of the goodness-of-fit test of a curve."""
    assert curve.goodness is not None and curve.fit is not None
    p = curve.p_value
    if p is None:
        sentence = f"whether the data fit a {curve.kind} curve is not tested: {curve.goodness.why}"
    elif curve.rejected:
        sentence = f"do not rely on this curve: the goodness-of-fit test rejects a {curve.kind} curve (p = {p:.2g})"
    else:
        sentence = f"the goodness-of-fit test does not reject a {curve.kind} curve (p = {p:.2g})"
    if curve.fit.intervals[1].low <= 0:
        sentence += f"; at {100 * curve.confidence:g} % {_why_open(curve)}"
    return sentence


def _why_open(curve: FragilityCurve) -> str:
    """Say why the standard errors do not bound the slope of a curve."""
    from scipy.special import chdtrc

    assert curve.fit is not None
    if curve.fit.ladders:
        return f"{curve.records} records are too few to bound it"
    part = curve.exceedances / curve.runs
    flat = curve.runs * (part * np.log(part) + (1 - part) * np.log1p(-part))
    if curve.records == curve.runs and chdtrc(1, 2 * (curve.fit.log_likelihood - flat)) < 1 - curve.confidence:
        return "its bounds are open: the outcomes are all but separate, and standard errors fail there"
    return "its increase cannot be told from none"


def _root_interval(fit: Fit) -> tuple[float, float]:
    """Return the u at which the band of a + b u contains one half [Fieller 1954, J. R. Statist. Soc. B 16, 175-185]."""
    a, b = fit.coefficients
    squared = fit.quantile**2 * fit.covariance
    leading, middle, constant = b * b - squared[1, 1], a * b - squared[0, 1], a * a - squared[0, 0]
    if leading <= 0:  # the slope may be zero: the band then contains one half up to infinity, on one or both sides
        return -np.inf, np.inf
    root = np.sqrt(max(middle * middle - leading * constant, 0.0))
    return float((-middle - root) / leading), float((-middle + root) / leading)


def exact_step(fitted: FragilityCurve, at: float, why: str) -> FragilityCurve:
    """Return a curve as a step whose place is known exactly, whatever was fitted."""
    step = Estimate(at, at, at)
    return replace(fitted, kind="step", why=why, fit=None, step=step, goodness=None, aic=None)


MAX_P_VALUE_TO_ADD = 0.05  # p-value below which a second measure improves the fit
MAX_PARALLEL_DISTANCE = 1e-4  # 1 - |correlation| up to which two measures count as one


@short_repr
@dataclass(frozen=True, eq=False)
class Surface(FittedToRuns):
    """Probability of exceedance as a function of two intensities, P = Phi(c0 + c1 ln x1 + c2 ln x2); `lognormal`.

    Other fields are as in `FittedToRuns`; `why` also says how the two measures compare.

    Parameters
    ----------
    aic : dict of str to float or None
        Akaike's criterion with `both`, and with the `first` and the `second` measure alone.
    p_values : tuple of float or None
        P-values of the gain from adding the first measure to the second, and the second to the first: by the likelihood
        ratio, or if records repeat by the robust standard error.
    """

    aic: dict[str, float] | None = None
    p_values: tuple[float, float] | None = None

    @property
    def coefficients(self) -> list[Estimate] | None:
        """The coefficients c0, c1 and c2 with their confidence intervals; None without a fit."""
        return None if self.fit is None else self.fit.intervals

    def probability(self, x1: Reals, x2: Reals) -> Reals:
        """Return the probability of exceedance at positive intensities of one shape; NaN without a fit."""
        x1, x2 = np.broadcast_arrays(x1, x2)
        if self.fit is None:
            return np.full(x1.shape, np.nan)
        return self.fit.probability(_plane(x1.ravel(), x2.ravel())).reshape(x1.shape)


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
    """
    who = np.unique(record, return_inverse=True)[1]
    number = np.ones(x1.size) if runs is None else runs.astype(np.float64)
    seen, beyond = Counts(who, np.arange(x1.size), number), np.asarray(exceeding, dtype=np.float64)
    bare = Surface("none", "", confidence, int(number.sum()), int(beyond.sum()), records=seen.records)
    if why := _all_alike(bare):
        return replace(bare, why=why)
    each = even(number, weight)
    number, beyond = number * each, beyond * each
    seen = Counts(who, seen.term, number, weight is not None)
    design = _plane(x1, x2)
    if (np.ptp(design[:, 1:], axis=0) < INTENSITY_TOLERANCE).any():
        return replace(bare, why="one of the measures is the same in all runs: take a curve over the other one")
    if bare.runs <= design.shape[1]:
        return replace(bare, why=f"{bare.runs} runs cannot tell {design.shape[1]} coefficients")
    correlation = float(np.corrcoef(design[:, 1], design[:, 2])[0, 1])
    if 1 - abs(correlation) < MAX_PARALLEL_DISTANCE:
        why = "the two measures are in proportion (of their logarithms): take a curve over either one"
        return replace(bare, why=why)
    standard, some, none = standardised(design)[0], beyond > 0, beyond < number  # cells of mixed outcomes are in both
    rows = np.concatenate([standard[some], standard[none]])
    if separable(rows, np.arange(len(rows)) < some.sum()):
        why = "a line in the plane of the two measures separates what exceeds from what does not"
        return replace(bare, why=f"{why}: the likelihood has no maximum, more runs near the line are needed")
    if few := too_few(seen, 3):
        return replace(bare, why=few)
    terms = [0, 1, 2], [0, 1], [0, 2]
    fits = [fit_outcomes("probit", design[:, columns], seen, beyond, confidence) for columns in terms]
    if refused := [fit for fit in fits if isinstance(fit, str)]:
        return replace(bare, why=refused[0])
    both, first, second = (fit for fit in fits if isinstance(fit, Fit))
    if (both.coefficients[1:] <= 0).all():
        return replace(bare, why="no surface increases: fewer runs exceed the limit as either measure increases")
    p_values = (_gain(both, second, 1, seen.repeated), _gain(both, first, 2, seen.repeated))
    aic = {"both": both.aic, "first": first.aic, "second": second.aic}
    return replace(bare, kind="lognormal", why=_words(both, p_values, aic), fit=both, aic=aic, p_values=p_values)


def _plane(x1: Reals, x2: Reals) -> Reals:
    return np.column_stack([np.ones(x1.size), np.log(x1), np.log(x2)])


def _gain(both: Fit, alone: Fit, column: int, clustered: bool) -> float:
    """Return the p-value of adding a measure; with repeated records by the standard error, as no chi-square holds."""
    from scipy.special import chdtrc, stdtr

    if clustered:
        error = float(np.sqrt(both.covariance[column, column]))
        return 2 * float(stdtr(both.degrees, -abs(both.coefficients[column]) / error))
    return float(chdtrc(1, 2 * (both.log_likelihood - alone.log_likelihood)))


def _words(both: Fit, p_values: tuple[float, float], aic: dict[str, float]) -> str:
    clauses = [
        f"the {name} measure {'adds to' if p < MAX_P_VALUE_TO_ADD else 'adds nothing detectable to'} the {other} "
        f"(p = {p:.2g})"
        for name, other, p in (("second", "first", p_values[1]), ("first", "second", p_values[0]))
    ]
    if max(p_values) >= MAX_P_VALUE_TO_ADD:
        alike = min(p_values) >= MAX_P_VALUE_TO_ADD  # neither measure adds to the other: take the likelier
        better = "first" if (aic["first"] <= aic["second"] if alike else p_values[0] < MAX_P_VALUE_TO_ADD) else "second"
        clauses.append(f"a curve over the {better} measure alone is sufficient")
    falls = [name for name, c in zip(("first", "second"), both.coefficients[1:], strict=True) if c < 0]
    fewer = "at a fixed value of the other measure, fewer runs exceed the limit as the"
    clauses += [f"{fewer} {name} one increases" for name in falls]
    return "; ".join(clauses)

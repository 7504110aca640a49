"""A fragility curve of data of one's own: the fit of a study, with an interval by the likelihood and a robust one."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from math import nan

import numpy as np

from rocking_cli.arrays import Bools, Integers, Reals
from rocking_cli.questions.fragility.assess import Fragility
from rocking_cli.questions.fragility.curves import FragilityCurve, Kind, fit_curve
from rocking_cli.questions.fragility.observed import Observations
from rocking_cli.short_repr import short_repr

EXCEEDANCE = "exceedance"  # name of the limit state, which only the data's owner knows
Ends = tuple[float, float]


@short_repr
@dataclass(frozen=True, eq=False)
class FittedFragility(Fragility):
    """A fragility curve of your own data; other fields as in `Fragility`.

    Its `curve` has the intervals of the likelihood, which are right if the curve is, and if runs are independent.

    Parameters
    ----------
    robust : FragilityCurve
        The same curve with intervals that require only independent clusters: each is left out in turn (the
        jackknife). Of kind
        `none`, with the reason, if there are too few clusters.
    lower : FittedFragility or None
        The fit in which unknown runs count as not exceeding; None if there are none.
    """

    robust: FragilityCurve = field(kw_only=True)
    lower: FittedFragility | None = None

    @property
    def interval(self) -> dict[str, Ends]:
        """Intervals of the `median` and the `dispersion` by the likelihood; NaN where there is no such number."""
        return _intervals(self.curve)

    @property
    def robust_interval(self) -> dict[str, Ends]:
        """Robust intervals of the `median` and the `dispersion`; NaN where there is no such number."""
        return _intervals(self.robust)

    @property
    def robustly(self) -> FittedFragility:
        """The fit and its lower edge with the robust interval, where there is one."""
        lower = None if self.lower is None else self.lower.robustly
        return replace(self, curve=self.curve if self.robust.fit is None else self.robust, lower=lower)


def _intervals(curve: FragilityCurve) -> dict[str, Ends]:
    both = {"median": curve.median, "dispersion": curve.dispersion}
    return {name: (nan, nan) if each is None else (each.low, each.high) for name, each in both.items()}


def fit_known(x: Reals, known: Reals, record: Integers, kind: Kind, confidence: float, label: str) -> FittedFragility:
    """Fit the curve of some runs, and if runs are unknown also its lower edge.

    Parameters
    ----------
    x : ndarray, shape (n,)
        Intensities, positive.
    known : ndarray, shape (n,)
        1 if a run exceeds, 0 if it does not, NaN if that is unknown.
    record : ndarray of int, shape (n,)
        The cluster of each run.
    kind : {"lognormal", "logit"}
        Kind of the curve.
    confidence : float
        Confidence level of intervals and bands.
    label : str
        Name of the intensity.
    """
    unknown = np.isnan(known)
    upper = _fitted(x, (known == 1) | unknown, record, kind, confidence, label)
    if not unknown.any():
        return upper
    lower = _fitted(x, known == 1, record, kind, confidence, label)
    return replace(upper, unknown=int(unknown.sum()), lower=lower)


def _fitted(
    x: Reals, exceeds: Bools, record: Integers, kind: Kind, confidence: float, label: str
) -> FittedFragility:  # fmt: skip
    """Fit one curve with both of its intervals: as if all runs were independent, and leaving out each cluster.

    A study takes the second if records repeat, and the first otherwise. Its choice tests the curve here.
    """
    seen = Observations.of(x, exceeds, record)
    if seen.repeated:
        other = Observations.of(x, exceeds, np.arange(x.size))
    else:  # equal weights change no estimate, but have each run left out
        other = Observations.of(x, exceeds, record, weight=np.ones(x.size))
    study, beside = (fit_curve(each, confidence=confidence, only=kind) for each in (seen, other))
    beside = replace(beside, records=seen.records)
    if study.fit is not None and beside.fit is not None:
        beside = replace(beside, why=study.why, goodness=study.goodness)
    plain, robust = (beside, study) if seen.repeated else (study, beside)
    return FittedFragility("", EXCEEDANCE, label, seen, plain, None, robust=robust)

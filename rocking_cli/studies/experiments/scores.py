"""Scores of stated shares of overturning against outcomes, with intervals by drawing clusters of tests."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import cached_property
from typing import NamedTuple

import numpy as np

from rocking_cli.arrays import Bools, Integers, Reals
from rocking_cli.studies.fragility.fit import Counts, fit_outcomes

SEED = 1963
DRAWS = 2000
RANGE = (0.05, 0.95)  # of the draws, between which an interval lies
BINS = 5  # of stated shares, equally wide


class ScoreEstimate(NamedTuple):
    """A number and its interval, 5 to 95 % of the draws of clusters; NaN where it does not exist.

    Tests of a single cluster have no interval, as all draws of them are equal.
    """

    value: float
    low: float
    high: float


class RuleScore(NamedTuple):
    """Scores of one rule that states shares of overturning.

    Parameters
    ----------
    tests : int
        Number of tests for which the rule states a share.
    brier : ScoreEstimate
        Mean squared difference of share and outcome: 0 is perfect, .25 is a coin.
    log_loss : ScoreEstimate
        Mean of -ln of the share stated for what was observed; shares are held off 0 and 1 by .5/(N + 1).
    right : ScoreEstimate
        Share of tests in which the more likely outcome was observed; a share of exactly one half counts as standing.
    auc : ScoreEstimate
        Probability that a test that overturned has the larger share than one that did not; equal ones count half.
    """

    tests: int
    brier: ScoreEstimate
    log_loss: ScoreEstimate
    right: ScoreEstimate
    auc: ScoreEstimate


class CalibrationBin(NamedTuple):
    """Tests with a stated share from `low` to below `high`; in the last bin, to `high`.

    Parameters
    ----------
    low, high : float
        Edges of the bin.
    tests, clusters : int
        Number of tests, and of the clusters they belong to.
    stated : float
        Mean stated share; NaN if the bin is empty.
    observed : ScoreEstimate
        Share of the tests that overturned.
    """

    low: float
    high: float
    tests: int
    clusters: int
    stated: float
    observed: ScoreEstimate

    @property
    def outside(self) -> bool:
        """Whether the mean stated share lies outside the interval of the observed one; False without either."""
        return self.stated < self.observed.low or self.stated > self.observed.high


class ClusterDraws:
    """Draws of clusters with replacement, as many in each draw as there are; the same for every score.

    Parameters
    ----------
    names : sequence of str
        Cluster of each test.
    """

    def __init__(self, names: Sequence[str]) -> None:
        clusters = list(dict.fromkeys(names))
        places = {name: k for k, name in enumerate(clusters)}
        self.of = np.array([places[name] for name in names], dtype=np.int64)  # the cluster of each test
        self.count = len(clusters)

    @cached_property
    def weights(self) -> Reals:
        """How often each draw has each cluster, shape (draws, clusters)."""
        drawn = np.random.default_rng(SEED).integers(self.count, size=(DRAWS, self.count))
        return np.stack([np.bincount(row, minlength=self.count) for row in drawn]).astype(np.float64)

    def mean(self, values: Reals, inside: Bools | None = None) -> ScoreEstimate:
        """Return the mean of a value of each test, of those `inside` only, with its interval."""
        kept = np.isfinite(values) if inside is None else inside & np.isfinite(values)
        if not kept.any():
            return ScoreEstimate(np.nan, np.nan, np.nan)
        sums = np.bincount(self.of[kept], values[kept], self.count)
        counts = np.bincount(self.of[kept], minlength=self.count).astype(np.float64)
        return _estimate(float(values[kept].mean()), counts, lambda: (self.weights @ sums, self.weights @ counts))

    def area(self, stated: Reals, seen: Reals) -> ScoreEstimate:
        """Return the area under the curve of hits against false alarms, with its interval."""
        kept = np.isfinite(stated)
        fell, stood = kept & (seen == 1), kept & (seen == 0)
        if not (fell.any() and stood.any()):
            return ScoreEstimate(np.nan, np.nan, np.nan)
        above = np.zeros((self.count, self.count))  # pairs that are in order, by the clusters of both
        one, other = stated[fell][:, None], stated[stood][None, :]
        np.add.at(above, (self.of[fell][:, None], self.of[stood][None, :]), (one > other) + 0.5 * (one == other))
        fallen, standing = (np.bincount(self.of[part], minlength=self.count).astype(float) for part in (fell, stood))

        def drawn() -> tuple[Reals, Reals]:
            w = self.weights
            return np.einsum("dk,kl,dl->d", w, above, w, optimize=True), (w @ fallen) * (w @ standing)

        return _estimate(float(above.sum() / (fallen.sum() * standing.sum())), fallen + standing, drawn)


def _estimate(value: float, counts: Reals, drawn: Callable[[], tuple[Reals, Reals]]) -> ScoreEstimate:
    """Return a ratio with the interval of its draws; draws in which it does not exist are left out.

    `counts` are the tests of each cluster behind the ratio.
    """
    if np.count_nonzero(counts) == 1:
        return ScoreEstimate(value, np.nan, np.nan)
    above, below = drawn()
    there = below > 0
    low, high = np.quantile(above[there] / below[there], RANGE)
    return ScoreEstimate(value, float(low), float(high))


def squared(stated: Reals, seen: Reals) -> Reals:
    """Return the squared difference of share and outcome of each test."""
    return (stated - seen) ** 2


def surprise(stated: Reals, seen: Reals, count: int) -> Reals:
    """Return -ln of the share stated for what was observed in each test, with shares of `count` neighbours."""
    off = 0.5 / (count + 1)
    held = np.clip(stated, off, 1 - off)
    return np.asarray(-(seen * np.log(held) + (1 - seen) * np.log(1 - held)))


def score(stated: Reals, seen: Reals, draws: ClusterDraws, count: int) -> RuleScore:
    """Score the shares of one rule.

    Parameters
    ----------
    stated : ndarray, shape (n,)
        Stated shares of overturning; NaN where the rule states none.
    seen : ndarray, shape (n,)
        1 for tests that overturned, 0 for others.
    draws : ClusterDraws
        Draws of the clusters of these tests.
    count : int
        Number of neighbours behind a share, by which shares are held off 0 and 1.
    """
    right = np.where(np.isnan(stated), np.nan, (stated > 0.5) == (seen == 1))
    return RuleScore(
        int(np.isfinite(stated).sum()),
        draws.mean(squared(stated, seen)),
        draws.mean(surprise(stated, seen, count)),
        draws.mean(right),
        draws.area(stated, seen),
    )


def difference(one: Reals, other: Reals, seen: Reals, draws: ClusterDraws) -> ScoreEstimate:
    """Return the Brier score of one rule less that of another, on the tests for which both state a share."""
    return draws.mean(squared(one, seen) - squared(other, seen))


def calibration(stated: Reals, places: Integers, seen: Reals, draws: ClusterDraws) -> list[CalibrationBin]:
    """Return stated and observed shares in bins of the stated share.

    Parameters
    ----------
    stated, seen
        As for `score`, without NaN.
    places : ndarray of int, shape (n,)
        The bin of each test, from 0.
    draws : ClusterDraws
        Draws of the clusters of these tests.
    """
    bins = []
    for k in range(BINS):
        inside = places == k
        mean = float(stated[inside].mean()) if inside.any() else np.nan
        clusters = len(np.unique(draws.of[inside]))
        observed = draws.mean(seen, inside)
        bins.append(CalibrationBin(k / BINS, (k + 1) / BINS, int(inside.sum()), clusters, mean, observed))
    return bins


def mean_gap(bins: Sequence[CalibrationBin]) -> float:
    """Return the mean absolute difference of stated and observed shares over bins, weighted by tests."""
    total = sum(each.tests for each in bins)
    return sum(each.tests * abs(each.stated - each.observed.value) for each in bins if each.tests) / total


def distance_from_uniform(ranks: Reals) -> float:
    """Return the largest distance of the distribution of ranks from a uniform one on 0 to 1 (Kolmogorov)."""
    ordered, count = np.sort(ranks), ranks.size
    steps = np.arange(count + 1) / count
    return float(max((steps[1:] - ordered).max(), (ordered - steps[:-1]).max()))


def base_rates(seen: Reals, clusters: Sequence[str], halves: Sequence[str]) -> Reals:
    """Return the share of tests that overturned among those of the other half, or of all other clusters.

    Parameters
    ----------
    seen : ndarray, shape (n,)
        1 for tests that overturned, 0 for others.
    clusters, halves : sequence of str
        Cluster and half of each test; a half may be empty.

    Returns
    -------
    ndarray, shape (n,)
        NaN for tests without any other.
    """
    rates = np.full(seen.size, np.nan)
    for own, others in _apart(clusters, halves):
        if others.any():
            rates[own] = seen[others].mean()
    return rates


def fitted_shares(measure: Reals, seen: Reals, clusters: Sequence[str], halves: Sequence[str]) -> Reals:
    """Return the shares of a logistic curve over ln of a measure, fitted to the tests of which `base_rates` are.

    Parameters
    ----------
    measure : ndarray, shape (n,)
        Intensity measure of each test; a test whose measure is not positive has no part in a fit.
    seen, clusters, halves
        As for `base_rates`.

    Returns
    -------
    ndarray, shape (n,)
        NaN for tests without a measure, and if the others determine no curve.
    """
    x = np.log(np.where(measure > 0, measure, np.nan))
    shares = np.full(seen.size, np.nan)
    for own, others in _apart(clusters, halves):
        told = others & np.isfinite(x)
        shares[own] = _logistic(x[told], seen[told], x[own])
    return shares


def _logistic(x: Reals, seen: Reals, at: Reals) -> Reals:
    """Fit a logistic curve to outcomes, and return its shares at other places; NaN if there is no fit."""
    fell, stood = x[seen == 1], x[seen == 0]
    if not (fell.size and stood.size):
        return np.full(at.size, np.nan)
    if stood.max() <= fell.min():  # the curve is ever steeper: a step in the middle of the gap
        return np.where(np.isnan(at), np.nan, np.heaviside(at - (stood.max() + fell.min()) / 2, 0.5))
    each = np.arange(x.size)
    fit = fit_outcomes("logit", _design(x), Counts(each, each, np.ones(x.size)), seen, 0.9)
    return np.full(at.size, np.nan) if isinstance(fit, str) else fit.probability(_design(at))


def _design(x: Reals) -> Reals:
    return np.column_stack([np.ones(x.size), x])


def _apart(clusters: Sequence[str], halves: Sequence[str]) -> Iterator[tuple[Bools, Bools]]:
    """Yield masks of tests, and of the others that a rule for them may learn from: of other halves, or clusters."""
    names, parts = np.array(clusters, dtype=object), np.array(halves, dtype=object)
    for cluster, half in dict.fromkeys(zip(clusters, halves, strict=True)):
        others = (parts != half) & (parts != "") if half else names != cluster
        yield (names == cluster) & (parts == half), others

"""Stated shares of overturning, and those of simpler rules, against what shake-table tests showed.

Intervals of the scores are by drawing clusters of tests.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf, isnan, nan
from typing import NamedTuple

import numpy as np

from rocking_cli.arrays import Bools, Integers, Reals
from rocking_cli.dynamics.outcome import Outcomes
from rocking_cli.dynamics.parallel import in_parts
from rocking_cli.errors import InputError, Problem, RockingError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.measures import measure
from rocking_cli.processing.steps import parse_step, process
from rocking_cli.short_repr import short_repr
from rocking_cli.structure import Structure
from rocking_cli.studies.fit import Counts, fit_outcomes
from rocking_cli.studies.neighbours import Neighbourhood, simulate_neighbours
from validation.table import OWN_PREDICTORS, ObservedTest

SEED = 1963
DRAWS = 2000
INTERVAL_QUANTILES = (0.05, 0.95)  # quantiles of the draws that bound an interval
SHARE_BINS = 5  # number of bins of equal width for the stated shares


class ScoreEstimate(NamedTuple):
    """A number and its interval, 5 to 95 % of the draws of clusters; NaN where it does not exist.

    Tests of a single cluster have no interval, as all draws of them are equal.
    """

    value: float
    low: float
    high: float


@short_repr
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
        self.of = np.array([places[name] for name in names], dtype=np.int64)  # cluster of each test
        self.count = len(clusters)

    @cached_property
    def weights(self) -> Reals:
        """Number of times that each draw contains each cluster, shape (draws, clusters)."""
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
        above = np.zeros((self.count, self.count))  # correctly ordered pairs, by their clusters
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
    low, high = np.quantile(above[there] / below[there], INTERVAL_QUANTILES)
    return ScoreEstimate(value, float(low), float(high))


def squared(stated: Reals, seen: Reals) -> Reals:
    """Return the squared difference of share and outcome of each test."""
    return (stated - seen) ** 2


def surprise(stated: Reals, seen: Reals, count: int) -> Reals:
    """Return -ln of the share stated for what was observed in each test, with shares of `count` neighbours."""
    off = 0.5 / (count + 1)
    held = np.clip(stated, off, 1 - off)
    return np.asarray(-(seen * np.log(held) + (1 - seen) * np.log(1 - held)))


def score_rule(stated: Reals, seen: Reals, draws: ClusterDraws, count: int) -> RuleScore:
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
        As for `score_rule`, without NaN.
    places : ndarray of int, shape (n,)
        The bin of each test, from 0.
    draws : ClusterDraws
        Draws of the clusters of these tests.
    """
    bins = []
    for k in range(SHARE_BINS):
        inside = places == k
        mean = float(stated[inside].mean()) if inside.any() else np.nan
        clusters = len(np.unique(draws.of[inside]))
        observed = draws.mean(seen, inside)
        bins.append(CalibrationBin(k / SHARE_BINS, (k + 1) / SHARE_BINS, int(inside.sum()), clusters, mean, observed))
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
    for tests, others in _apart(clusters, halves):
        if others.any():
            rates[tests] = seen[others].mean()
    return rates


def fitted_shares(measure: Reals, seen: Reals, clusters: Sequence[str], halves: Sequence[str]) -> Reals:
    """Return the shares of a logistic curve over ln of a measure, fitted to the same tests as `base_rates` counts.

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
    for tests, others in _apart(clusters, halves):
        told = others & np.isfinite(x)
        shares[tests] = _logistic(x[told], seen[told], x[tests])
    return shares


def _logistic(x: Reals, seen: Reals, at: Reals) -> Reals:
    """Fit a logistic curve to outcomes, and return the shares that it gives at values `at`; NaN if there is no fit."""
    fell, stood = x[seen == 1], x[seen == 0]
    if not (fell.size and stood.size):
        return np.full(at.size, np.nan)
    if stood.max() <= fell.min():  # the slope is unbounded: use a step in the middle of the gap
        return np.where(np.isnan(at), np.nan, np.heaviside(at - (stood.max() + fell.min()) / 2, 0.5))
    each = np.arange(x.size)
    fit = fit_outcomes("logit", _design(x), Counts(each, each, np.ones(x.size)), seen, 0.9)
    return np.full(at.size, np.nan) if isinstance(fit, str) else fit.probability(_design(at))


def _design(x: Reals) -> Reals:
    return np.column_stack([np.ones(x.size), x])


def _apart(clusters: Sequence[str], halves: Sequence[str]) -> Iterator[tuple[Bools, Bools]]:
    """Yield masks of tests, and of the tests to which a rule for them may be fitted: of other halves or clusters."""
    names, parts = np.array(clusters, dtype=object), np.array(halves, dtype=object)
    for cluster, half in dict.fromkeys(zip(clusters, halves, strict=True)):
        others = (parts != half) & (parts != "") if half else names != cluster
        yield (names == cluster) & (parts == half), others


TOOL, WITH_UNKNOWN, BASE_RATE, WEST, VELOCITY, FITTED_PGV = OWN_PREDICTORS
DRIFT_CORNER = "0.1"  # Hz: below it, the velocity of a record is drift


class PeakRank(NamedTuple):
    """Rank of an observed peak rotation among those of the neighbours.

    Parameters
    ----------
    line : int
        Line of the test.
    rank : float
        Share of the neighbours with a smaller peak; equal peaks count half, and neighbours that overturn or whose
        outcome is unknown have larger ones.
    censored : bool
        Whether the rank is at least this large.
    """

    line: int
    rank: float
    censored: bool


@short_repr
@dataclass(frozen=True)
class Stated:
    """Predictions for one test.

    Parameters
    ----------
    test : ObservedTest
        The test.
    overturned, unknown : int
        Number of neighbours that overturn, and of those whose outcome is unknown.
    count : int
        Number of neighbours, under one polarity or, if the two differ, under both; 0 if the test could not be
        simulated.
    west, velocity : float
        1 if the rule states that the structure overturns, 0 if it stands; NaN if it states neither.
    rank : float
        Rank of the observed peak among the neighbours; NaN without one.
    pgv : float
        Peak velocity [m/s]: the one of the table or, without it, that of the record.
    doubtful : bool
        Whether the structure is said not to have overturned, but its peak lies beyond the critical rotations.
    around : Neighbourhood, optional
        How the neighbours were drawn, with the standard deviations of the structure.
    error : RockingError, optional
        Why the test could not be simulated.
    """

    test: ObservedTest
    overturned: int = 0
    unknown: int = 0
    count: int = 0
    west: float = nan
    velocity: float = nan
    rank: float = nan
    pgv: float = nan
    doubtful: bool = False
    around: Neighbourhood | None = None
    error: RockingError | None = None

    @property
    def share(self) -> float | None:
        """Share of the neighbours that overturn; None if the test could not be simulated."""
        return self.overturned / self.count if self.count else None

    @property
    def unknown_share(self) -> float | None:
        """Share of the neighbours whose outcome is unknown; None if the test could not be simulated."""
        return self.unknown / self.count if self.count else None


@short_repr
@dataclass(frozen=True)
class Scored:
    """Stated shares of tests, and their scores.

    Parameters
    ----------
    around : Neighbourhood
        How the neighbours were drawn.
    tests : sequence of Stated
        One entry for each row of the table, in its order.
    scores : mapping of str to RuleScore
        Scores by the name of the rule; empty if no outcome was observed.
    differences : mapping of str to ScoreEstimate
        Brier score of the tool less that of each other rule: negative if the tool is better.
    bins : sequence of CalibrationBin
        Stated and observed shares of the tool in five equal bins.
    mean_gap : float
        Mean absolute difference of stated and observed shares over the bins, weighted by tests; NaN without outcomes.
    bias : ScoreEstimate
        Mean stated share less the observed one.
    clusters : int
        Number of clusters of the scored tests.
    ranks : sequence of PeakRank
        Ranks of the observed peaks.
    distance : float
        Largest distance of the distribution of uncensored ranks from a uniform one; NaN without any.
    """

    around: Neighbourhood
    tests: Sequence[Stated]
    scores: Mapping[str, RuleScore]
    differences: Mapping[str, ScoreEstimate]
    bins: Sequence[CalibrationBin]
    mean_gap: float
    bias: ScoreEstimate
    clusters: int
    ranks: Sequence[PeakRank]
    distance: float

    @property
    def failed(self) -> Sequence[Stated]:
        """The tests that could not be simulated."""
        return [each for each in self.tests if each.error is not None]

    @property
    def observed(self) -> Sequence[Stated]:
        """The tests that are scored: simulated, and with an observed outcome."""
        return [each for each in self.tests if each.error is None and each.test.overturned is not None]

    @property
    def drawn(self) -> Mapping[Neighbourhood, Sequence[str]]:
        """Standard deviations of the neighbours, each with the names of the structures to which they apply."""
        drawn: dict[Neighbourhood, list[str]] = {}
        for each in self.tests:
            if each.around is not None and each.test.structure not in drawn.setdefault(each.around, []):
                drawn[each.around].append(each.test.structure)
        return drawn


def score_tests(
    tests: Sequence[ObservedTest],
    structure_of: Callable[[str], Structure],
    motion_of: Callable[[str], GroundMotion],
    around: Neighbourhood | None = None,
    *,
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
) -> Scored:
    """Simulate the neighbours of each test, and score the shares that they predict.

    Parameters
    ----------
    tests : sequence of ObservedTest
        The tests.
    structure_of, motion_of : callable
        Return the structure and the motion that a test names. They may raise `RockingError`; the test then enters no
        score. Called from several threads.
    around : Neighbourhood, optional
        How to draw the neighbours.
    threads : int, optional
        Number of threads; by default, one for each processor.
    progress : callable, optional
        Called with the number of tests done since the last call.

    Raises
    ------
    InputError
        If the number of neighbours is 0.
    """
    around = around or Neighbourhood()
    if not around.count:
        raise InputError(Problem("must be at least 1", field="neighbours"))
    first = {test.record: k for k, test in reversed(list(enumerate(tests)))}
    # Sorted so that each record is read once.
    order = sorted(range(len(tests)), key=lambda k: (first[tests[k].record], k))
    stated: dict[int, Stated] = {}

    def work(start: int, stop: int) -> None:
        for k in order[start:stop]:
            try:
                stated[k] = state(tests[k], structure_of(tests[k].structure), motion_of(tests[k].record), around)
            except RockingError as error:
                stated[k] = Stated(tests[k], error=error)

    in_parts(work, len(tests), 1, threads, progress)
    return scored([stated[k] for k in range(len(tests))], around)


def state(test: ObservedTest, structure: Structure, motion: GroundMotion, around: Neighbourhood) -> Stated:
    """Return what the neighbours of a test, and the simpler rules, predict for it.

    Parameters
    ----------
    test : ObservedTest
        The test.
    structure : Structure
        Its structure.
    motion : GroundMotion
        Its motion as recorded, before it is scaled in amplitude or time.
    around : Neighbourhood
        How to draw the neighbours.

    Raises
    ------
    InputError, MechanismError, SolverError
        If the structure has no model, or the motion cannot be simulated.
    """
    model = structure.model("nonlinear")
    shaking = in_time(motion.scaled(test.scale), test.time_scale)
    signs = (1, -1) if test.polarity == "both" else (int(test.polarity),)
    if model.symmetric:  # a reversed motion has the same effect
        signs = signs[:1]
    drawn = around.drawn(model)
    histories = [simulate_neighbours(model, shaking, drawn, polarity=sign, threads=1) for sign in signs]
    peaks = np.concatenate([_peaks(each) for each in histories])
    rank = nan
    if test.peak is not None:
        rank = float(((peaks < test.peak).sum() + 0.5 * (peaks == test.peak).sum()) / peaks.size)
    pgv = _pgv(shaking) if test.pgv is None else test.pgv
    return Stated(
        test,
        sum(int(each.fell.sum()) for each in histories),
        sum(int(each.unknown.sum()) for each in histories),
        len(signs) * around.count,
        float(shaking.pga_g > min(structure.uplift)),
        _by_velocity(pgv, structure),
        rank,
        pgv,
        test.overturned is False and test.peak is not None and test.peak > max(model.phi_cr),
        around.of(model),
    )


def in_time(motion: GroundMotion, factor: float) -> GroundMotion:
    """Return a motion with a factor on its times, and on those of its other components."""
    vertical, ground = (None if each is None else in_time(each, factor) for each in (motion.vertical, motion.ground))
    return replace(motion, dt=factor * motion.dt, vertical=vertical, ground=ground)


def _peaks(found: Outcomes) -> Reals:
    """Return the peak rotation of each neighbour [rad]; infinite if it overturns or its outcome is unknown."""
    peaks = np.fmax(found.peak_positive, found.peak_negative)
    return np.where(found.fell | found.unknown, inf, peaks)


def _pgv(motion: GroundMotion) -> float:
    """Return the peak velocity of a record [m/s], without its drift."""
    with suppress(InputError):  # the record is too short to be filtered, or to drift
        motion = process(motion, [parse_step("highpass", DRIFT_CORNER)])
    return measure(motion).pgv


def _by_velocity(pgv: float, structure: Structure) -> float:
    """Return 1 if the peak velocity exceeds the step that overturns, 0 if not, and NaN if there is no such step."""
    if structure.why_no_block is not None:
        return nan
    step = min(structure.equivalence.positive.v_imp, structure.equivalence.negative.v_imp)
    return nan if isnan(step) else float(pgv > step)


def scored(stated: Sequence[Stated], around: Neighbourhood) -> Scored:
    """Score the predictions for tests.

    Parameters
    ----------
    stated : sequence of Stated
        What is stated of each test.
    around : Neighbourhood
        How the neighbours were drawn.
    """
    kept = [each for each in stated if each.count and each.test.overturned is not None]
    ranks = [
        PeakRank(each.test.line, each.rank, each.test.censored)
        for each in stated
        if each.count and not isnan(each.rank)
    ]
    certain = np.array([each.rank for each in ranks if not each.censored])
    distance = distance_from_uniform(certain) if certain.size else nan
    if not kept:
        return Scored(around, stated, {}, {}, [], nan, ScoreEstimate(nan, nan, nan), 0, ranks, distance)
    seen = np.array([float(each.test.overturned or 0) for each in kept])
    rules = stated_by(kept, seen)
    draws = ClusterDraws([each.test.cluster for each in kept])
    tool = rules[TOOL]
    places = np.array([min(SHARE_BINS * each.overturned // each.count, SHARE_BINS - 1) for each in kept])
    bins = calibration(tool, places, seen, draws)
    return Scored(
        around,
        stated,
        {name: score_rule(shares, seen, draws, around.count) for name, shares in rules.items()},
        {name: difference(tool, shares, seen, draws) for name, shares in rules.items() if name != TOOL},
        bins,
        mean_gap(bins),
        draws.mean(tool - seen),
        draws.count,
        ranks,
        distance,
    )


def stated_by(tests: Sequence[Stated], seen: Reals) -> dict[str, Reals]:
    """Return the share of overturning that each rule states for each test, by the name of the rule; NaN without one.

    Parameters
    ----------
    tests : sequence of Stated
        The tests, all with an observed outcome.
    seen : ndarray, shape (n,)
        1 for tests that overturned, 0 for others.
    """
    apart = [each.test.cluster for each in tests], [each.test.half for each in tests]
    rules = {
        TOOL: [each.overturned / each.count for each in tests],
        WITH_UNKNOWN: [(each.overturned + each.unknown) / each.count for each in tests],
        BASE_RATE: base_rates(seen, *apart),
        WEST: [each.west for each in tests],
        VELOCITY: [each.velocity for each in tests],
        FITTED_PGV: fitted_shares(np.array([each.pgv for each in tests]), seen, *apart),
    }
    for name in dict.fromkeys(name for each in tests for name in each.test.forecasts):
        rules[name] = [each.test.forecasts.get(name, nan) for each in tests]
    return {name: np.array(shares, dtype=np.float64) for name, shares in rules.items()}

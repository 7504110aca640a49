"""Fragility curves against synthetic truth, independent optimisation, and a block whose step is known."""

import runpy
from collections import Counter
from typing import NamedTuple

import numpy as np
import pytest
from scipy.optimize import brentq, minimize
from scipy.special import log_ndtr, ndtr
from scipy.stats import binom, chi2, norm
from scipy.stats import t as student
from statsmodels.discrete.discrete_model import Logit, Probit

from rocking_cli.questions.fragility import curves
from rocking_cli.questions.fragility.curves import fit_capacities, fit_surface
from rocking_cli.questions.fragility.observed import MEASURED_COVERAGE, Observations, goodness_of_runs
from rocking_cli.studies import fit as fitting
from rocking_cli.studies.fit import NO_ERRORS, fit_outcomes, separable
from rocking_cli.studies.under_pulses import linear_block, outcomes, parse_shape
from tests.conftest import PROJECT

COVERAGE = runpy.run_path(str(PROJECT / "docs" / "make_coverage.py"))
CASES, RECORDS, held = (COVERAGE[name] for name in ("CASES", "RECORDS", "held"))
MEDIAN, DISPERSION = 0.4, 0.5
LEVELS = np.geomspace(0.15, 1.1, 6)


class Runs(NamedTuple):
    """Runs one by one."""

    x: np.ndarray
    exceeded: np.ndarray
    record: np.ndarray

    @property
    def seen(self):
        return Observations.of(*self)


def fit_curve(runs, **options):
    return curves.fit_curve(runs.seen, **options)


def fit(runs, confidence=0.95):
    """The lognormal fit of runs, whatever their test says."""
    seen = runs.seen
    return fit_outcomes("probit", design(seen.x), seen.counts, seen.exceeding, confidence)


def cloud(random, runs):
    x = MEDIAN * np.exp(0.7 * random.normal(size=runs))
    return Runs(x, x > MEDIAN * np.exp(DISPERSION * random.normal(size=runs)), np.arange(runs))


def stripes(random, records, shared, levels=LEVELS):
    """Runs of each record at every level; `shared` of the dispersion belongs to the record."""
    x = np.tile(levels, (records, 1))
    rest = np.sqrt(DISPERSION**2 - shared**2)
    scatter = shared * random.normal(size=(records, 1)) + rest * random.normal(size=x.shape)
    exceeded = x > MEDIAN * np.exp(scatter)
    return Runs(x.ravel(), exceeded.ravel(), np.repeat(np.arange(records), levels.size))


def brackets(random, records, levels=LEVELS):
    capacity = MEDIAN * np.exp(DISPERSION * random.normal(size=records))
    bounds = np.concatenate([[0.0], levels, [np.inf]])
    place = np.searchsorted(levels, capacity)
    return bounds[place], bounds[place + 1]


def design(x):
    return np.column_stack([np.ones(x.size), np.log(x)])


class TestAgainstAnIndependentOptimum:
    def test_logistic_in_the_intensity_itself(self):
        random = np.random.default_rng(2)
        x = random.uniform(0.02, 3.0, 3000)  # wide below: there the lognormal has no tail
        seen = Runs(x, random.random(x.size) < 1 / (1 + np.exp(-(x - 0.8) / 0.4)), np.arange(x.size))
        curve = fit_curve(seen)

        def cost(z):
            sign = np.where(seen.exceeded, 1, -1)
            return np.logaddexp(0, -sign * (x - z[0]) / z[1]).sum()

        best = minimize(cost, [1.0, 1.0], method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-12})
        assert curve.kind == "logistic" and curve.dispersion is None
        assert "rejected" in curve.why and "likelier" in curve.why
        assert "the goodness-of-fit test does not reject a logistic curve" in curve.why
        np.testing.assert_allclose([curve.median.value, curve.scale.value], best.x, rtol=1e-6)
        assert curve.aic["logistic"] == pytest.approx(4 + 2 * best.fun, abs=1e-7)
        assert curve.median.low < 0.8 < curve.median.high and curve.scale.low < 0.4 < curve.scale.high
        assert curve.probability(np.array([0.8]))[0] == pytest.approx(0.5, abs=0.05)

    @pytest.mark.parametrize(("link", "at_once"), [("probit", 7), ("logit", 1 << 16)])
    def test_without_each_record_by_the_slopes_of_statsmodels(self, monkeypatch, link, at_once):
        monkeypatch.setattr(fitting, "TERMS_PER_BLOCK", at_once)  # terms: there are twelve
        raw, model = stripes(np.random.default_rng(3), 30, 0.4), {"probit": Probit, "logit": Logit}[link]
        seen, X, y = raw.seen, design(raw.x), raw.exceeded.astype(float)
        found = fit_outcomes(link, design(seen.x), seen.counts, seen.exceeding, 0.95)
        best = model(y, X).fit(disp=0).params
        np.testing.assert_allclose(found.coefficients, best, rtol=1e-6)
        moved = []
        for k in range(30):
            own = model(y[raw.record == k], X[raw.record == k])
            moved.append(np.linalg.solve(model(y, X).hessian(best) - own.hessian(best), own.score(best)))
        np.testing.assert_allclose(found.covariance, 29 / 30 * np.transpose(moved) @ moved, rtol=1e-5)
        assert found.quantile == pytest.approx(student.ppf(0.975, 29))

    def test_capacities(self):
        lower, upper = brackets(np.random.default_rng(4), 40)
        assert (lower == 0).any() and np.isinf(upper).any()
        curve = fit_capacities(lower, upper)

        def cost(z):
            with np.errstate(divide="ignore"):
                high, low = ((np.log(end) - z[0]) / z[1] for end in (upper, lower))
            return -np.log(ndtr(high) - ndtr(low)).sum()

        best = minimize(cost, [-1.0, 0.5], method="Nelder-Mead", options={"xatol": 1e-10, "fatol": 1e-13})
        assert (curve.kind, curve.runs, curve.exceedances) == ("lognormal", 40, np.isfinite(upper).sum())
        assert curve.median.value == pytest.approx(np.exp(best.x[0]), rel=1e-6)
        assert curve.dispersion.value == pytest.approx(best.x[1], rel=1e-6)
        assert curve.aic["lognormal"] == pytest.approx(4 + 2 * best.fun, abs=1e-8)
        assert curve.fit.quantile == pytest.approx(student.ppf(0.975, 39))
        # The information by differences, in a = -mean/deviation and b = 1/deviation.
        at, h = np.array([-best.x[0], 1.0]) / best.x[1], 1e-4

        def value(da, db):
            a, b = at + h * np.array([da, db])
            return cost([-a / b, 1 / b])

        mixed = (value(1, 1) - value(1, -1) - value(-1, 1) + value(-1, -1)) / 4
        plain = [value(*each) + value(*-each) - 2 * value(0, 0) for each in np.eye(2)]
        information = np.array([[plain[0], mixed], [mixed, plain[1]]]) / h**2
        np.testing.assert_allclose(curve.fit.covariance, np.linalg.inv(information), rtol=1e-4)

    @pytest.mark.parametrize("width", [1e-3, 1e-8])
    def test_narrow_brackets_are_capacities_known_exactly(self, width):
        u = np.random.default_rng(7).normal(np.log(MEDIAN), DISPERSION, 60)
        curve = fit_capacities(np.exp(u), np.exp(u + width))
        n, deviation = 60, u.std()
        # The inverse information of a normal sample: of mean deviation^2/n, of the deviation deviation^2/2n.
        b = 1 / deviation
        slopes = np.array([[-b, u.mean() * b**2], [0.0, -(b**2)]])  # of a and b by mean and deviation
        expected = slopes @ np.diag([deviation**2 / n, deviation**2 / (2 * n)]) @ slopes.T
        np.testing.assert_allclose(curve.fit.covariance, expected, rtol=max(5 * width, 1e-5))

    def test_several_capacities_of_a_record_refitted_without_each(self):
        lower, upper = brackets(np.random.default_rng(4), 400, np.geomspace(0.1, 2.0, 12))
        record = np.arange(400) // 4
        curve = fit_capacities(lower, upper, record)

        def best(which):
            with np.errstate(divide="ignore"):
                ends = np.log(upper[which]), np.log(lower[which])

            def cost(c):
                high, low = (c[0] + c[1] * end for end in ends)
                return -np.log(ndtr(high) - ndtr(low)).sum()

            return minimize(cost, curve.fit.coefficients, method="Nelder-Mead", options={"xatol": 1e-9}).x

        moved = np.array([best(record != k) for k in range(100)]) - best(record >= 0)
        np.testing.assert_allclose(curve.fit.covariance, 99 / 100 * moved.T @ moved, rtol=0.03)
        assert curve.fit.quantile == pytest.approx(student.ppf(0.975, 99))

    def test_surface(self):
        random = np.random.default_rng(6)
        x1, x2 = np.exp(random.normal(size=(2, 300)))
        exceeded = 0.3 + 1.5 * np.log(x1) + 0.8 * np.log(x2) > random.normal(size=300)
        surface = fit_surface(x1, x2, exceeded, np.arange(300))

        def cost(c, columns):
            eta = np.column_stack([np.ones(300), np.log(x1), np.log(x2)])[:, columns] @ c
            return -np.where(exceeded, log_ndtr(eta), log_ndtr(-eta)).sum()

        best = {
            name: minimize(cost, np.zeros(len(columns)), (columns,), method="BFGS", options={"gtol": 1e-8})
            for name, columns in (("both", [0, 1, 2]), ("first", [0, 1]), ("second", [0, 2]))
        }
        np.testing.assert_allclose([each.value for each in surface.coefficients], best["both"].x, rtol=1e-4)
        for name, found in best.items():
            assert surface.aic[name] == pytest.approx(2 * found.x.size + 2 * found.fun, abs=1e-6)
        ratio = 2 * (best["first"].fun - best["both"].fun)
        assert surface.p_values[1] == pytest.approx(chi2.sf(ratio, 1), rel=1e-4)
        c = best["both"].x
        expected = norm.cdf(c[0] + c[1] * np.log(1.5) + c[2] * np.log(0.7))
        assert surface.probability(np.array([1.5]), np.array([0.7]))[0] == pytest.approx(expected, rel=1e-4)
        for each, true in zip(surface.coefficients, (0.3, 1.5, 0.8), strict=True):
            assert each.low < true < each.high


def coverage_table():
    """The rates of median and dispersion for each number of records, by the words of the case."""
    page = (PROJECT / "docs" / "fragility.md").read_text(encoding="utf-8")
    rows = [line.strip("| ").split(" | ") for line in page.splitlines() if line.startswith("| ")]
    known = {each.words for each in CASES}
    return {row[0]: [tuple(map(int, cell.split(", "))) for cell in row[1:]] for row in rows if row[0] in known}


@pytest.mark.rest
class TestCoverageOfFewRecords:
    """The table of docs/fragility.md, and the words of the warning."""

    TABLE = coverage_table()

    @pytest.mark.parametrize("case", CASES, ids=lambda case: case.words)
    def test_is_what_the_table_says(self, case):
        for records, said in zip(RECORDS, self.TABLE[case.words], strict=True):
            fitted, *counts = held(case, records, 120, seed=2)
            for count, rate in zip(counts, said, strict=True):
                least, most = max(rate - 0.7, 0) / 100, min(rate + 0.7, 100) / 100  # of 2000 trials, in whole percents
                assert binom.ppf(1e-4, fitted, least) <= count <= binom.ppf(1 - 1e-4, fitted, most)

    def test_is_what_the_warning_says(self):
        for records, (low, high) in MEASURED_COVERAGE.items():
            rates = [rate for said in self.TABLE.values() for rate in said[RECORDS.index(records)]]
            assert (min(rates), max(rates)) == (low, high)
        assert len(self.TABLE) == len(CASES)


class TestBand:
    def test_stays_within_0_and_1_around_the_curve_and_crosses_one_half_at_the_ends_of_the_median(self):
        curve = fit_curve(cloud(np.random.default_rng(21), 60), confidence=0.9)
        x = np.concatenate([[0.0], np.geomspace(1e-6, 1e6, 200)])
        low, high = curve.band(x)
        assert (low >= 0).all() and (high <= 1).all()
        assert ((low <= curve.probability(x)) & (curve.probability(x) <= high)).all()
        assert (curve.probability(x)[0], high[0]) == (0, 0)
        ends = np.array([curve.median.low, curve.median.high])
        assert curve.band(ends)[1][0] == pytest.approx(0.5, abs=1e-9)
        assert curve.band(ends)[0][1] == pytest.approx(0.5, abs=1e-9)
        assert curve.probability(np.array([[curve.median.value]])).shape == (1, 1)

    def test_a_weak_trend_leaves_the_intervals_open_and_is_said(self):
        random = np.random.default_rng(23)
        x = np.exp(random.normal(size=40))
        curve = fit_curve(Runs(x, random.random(40) < 0.4 + 0.1 * (x > 1), np.arange(40)))
        assert curve.kind == "lognormal" and "cannot be told from none" in curve.why
        assert (curve.median.low, curve.median.high, curve.dispersion.high) == (0, np.inf, np.inf)


def one_each(x, exceeded):
    x = np.asarray(x, dtype=float)
    return Runs(x, np.asarray(exceeded, dtype=bool), np.arange(x.size))


class TestKinds:
    @pytest.mark.parametrize(
        ("x", "exceeded", "words"),
        [
            ([1, 2, 3], [1, 1, 1], "all of the 3 runs"),
            ([2, 2, 2], [1, 0, 1], "the intensity 2"),
            ([1, 2, 3, 4, 5, 6], [1, 1, 0, 1, 0, 0], "no increasing curve exists"),
            ([1, 1, 2, 2], [0, 0, 0, 1], "none exceeds below"),
        ],
    )
    def test_none(self, x, exceeded, words):
        curve = fit_curve(one_each(x, exceeded))
        assert curve.kind == "none" and words in curve.why
        assert curve.median is curve.dispersion is curve.scale is None
        assert np.isnan(curve.probability(np.array([1.0]))).all() and np.isnan(curve.band(np.array([1.0]))).all()

    def test_step(self):
        curve = fit_curve(one_each([1, 2, 3, 4], [0, 0, 1, 1]))
        assert (curve.kind, curve.step.low, curve.step.high) == ("step", 2, 3)
        assert curve.median.value == pytest.approx(np.sqrt(6)) and curve.dispersion is None
        x = np.array([2.0, 2.1, 2.9, 3.0])
        np.testing.assert_array_equal(curve.probability(x), [0, 0, 1, 1])
        np.testing.assert_array_equal(curve.band(x), [[0, 0, 0, 1], [0, 1, 1, 1]])

    def test_runs_of_two_records_tell_no_scatter(self):
        x = np.array([1, 2, 3, 4, 1, 2, 3, 4.0])
        seen = Runs(x, np.array([0, 1, 0, 1, 0, 0, 1, 1], dtype=bool), np.repeat([7, 9], 4))
        curve = fit_curve(seen)
        assert curve.kind == "none" and "2 records" in curve.why

    @pytest.mark.parametrize(
        ("lower", "upper", "kind", "words"),
        [
            ([1, 1, 1], [2, 2, 2], "step", "all runs do from 2"),
            ([1, 1.5, 0], [2, 3, np.inf], "step", "up to 1.5"),
            ([1, 2, 1], [2, 3, 2], "step", "both outcomes occur at 2"),
            ([0, 0], [1, 1], "none", "at their first level"),
            ([0, 2], [1, np.inf], "none", "below 1 or above 2: levels beyond these"),
        ],
    )
    def test_capacities_without_scatter_or_bounds(self, lower, upper, kind, words):
        curve = fit_capacities(np.array(lower, dtype=float), np.array(upper, dtype=float))
        assert curve.kind == kind and words in curve.why

    def test_no_data_of_any_size_and_scale_breaks_a_fit(self):
        random = np.random.default_rng(32)
        fine = np.geomspace(1e-9, 1e9, 30)
        kinds: Counter[str] = Counter()
        for k in range(40):
            n = int(random.integers(1, 25))
            x = np.exp(random.normal(size=n) * random.choice([1e-3, 0.5, 4])) * random.choice([1e-4, 1, 1e4])
            exceeded = x > np.median(x) * np.exp(random.choice([0.01, 0.5, 5]) * random.normal(size=n))
            if k % 5 == 0:
                exceeded[0] = ~exceeded[0]
            curve = fit_curve(Runs(x, exceeded, np.arange(n) if k % 2 else random.integers(0, n, n)))
            kinds[curve.kind] += 1
            low, high = curve.band(fine)
            if curve.fit is not None:
                assert (low <= curve.probability(fine)).all() and (curve.probability(fine) <= high).all()
            fit_surface(x, x * np.exp(random.normal(size=n)), exceeded, np.arange(n))
        assert set(kinds) >= {"lognormal", "step", "none"}


def rounded(x, seed):
    """Intensities as another processor may round them."""
    return x * (1 + np.random.default_rng(seed).integers(-2, 3, x.size) * np.finfo(float).eps)


def wide_logistic(random):
    x = random.uniform(0.02, 3.0, 1500)
    return Runs(x, random.random(x.size) < 1 / (1 + np.exp(-(x - 0.8) / 0.4)), np.arange(x.size))


def narrow(random):
    """A cloud far from an intensity of one for its width: what is not centred loses its digits."""
    x = np.exp(0.005 * random.normal(size=150))
    return Runs(x, x > np.exp(0.004 * random.normal(size=150)), np.arange(150))


def level_with_both_outcomes(random):
    x = np.tile([0.1, 0.2, 0.3], 8)
    return Runs(x, (x > 0.25) | ((x > 0.15) & (random.random(24) < 0.5)), np.repeat(np.arange(8), 3))


class TestUnits:
    """A measure times a constant is the same measure: whatever the constant, and however it is rounded."""

    @pytest.mark.parametrize(
        ("made", "c"),
        [
            (lambda random: stripes(random, 6, 0.4), 3.7), (lambda random: cloud(random, 100), 1e6),
            (wide_logistic, 1e-3), (narrow, 3.7), (level_with_both_outcomes, 3.7),
        ],
    )  # fmt: skip
    def test_curves_and_tests_do_not_depend_on_them(self, made, c):
        seen = made(np.random.default_rng(61))
        one, other = fit_curve(seen), fit_curve(seen._replace(x=rounded(c * seen.x, 62)))
        assert (other.kind, other.goodness and other.goodness.name) == (one.kind, one.goodness and one.goodness.name)
        for name in ("median", "scale", "dispersion"):
            before, after = getattr(one, name), getattr(other, name)
            assert (before is None) == (after is None)
            if before is not None:
                factor = 1.0 if name == "dispersion" else c
                expected = [factor * value for value in (before.value, before.low, before.high)]
                assert [after.value, after.low, after.high] == pytest.approx(expected, rel=1e-8)
        if one.goodness is not None:
            assert other.goodness.why == one.goodness.why
            if one.goodness.p_value is not None:
                assert other.goodness.p_value == pytest.approx(one.goodness.p_value, rel=1e-7)
                assert other.goodness.degrees == pytest.approx(one.goodness.degrees, rel=1e-8)
        fine = np.geomspace(0.01, 10, 50)
        np.testing.assert_allclose(other.probability(c * fine), one.probability(fine), atol=1e-9)
        np.testing.assert_allclose(other.band(c * fine), one.band(fine), atol=1e-8)

    def test_a_level_that_is_rounded_otherwise_for_each_record_is_one(self):
        # None exceeds at 0.1, one half at 0.2, all at 0.3: over each float of 0.2 by itself these are two steps.
        x, record = np.tile([0.1, 0.2, 0.3], 12), np.repeat(np.arange(12), 3)
        seen = Runs(rounded(x, 68), (x > 0.25) | ((x > 0.15) & (record % 2 == 0)), record)
        curve = fit_curve(seen)
        assert curve.kind == "step" and "both outcomes occur at 0.2 only" in curve.why
        assert (curve.step.low, curve.step.value, curve.step.high) == pytest.approx((0.1, 0.2, 0.3))


class TestCovariance:
    @pytest.mark.parametrize("covariance", [None, np.array([[np.nan, 1.0], [1.0, 1.0]])])
    def test_that_is_none_is_refused_with_the_reason(self, monkeypatch, covariance):
        monkeypatch.setattr(fitting, "_covariance", lambda *given: covariance)
        curve = fit_curve(cloud(np.random.default_rng(72), 60))
        assert (curve.kind, curve.why, curve.fit) == ("none", NO_ERRORS, None)

    def test_a_record_that_holds_all_levels_but_one_tells_no_errors(self):
        x = np.concatenate([LEVELS, np.repeat(0.4, 8)])
        exceeded = np.concatenate([[0, 0, 1, 0, 1, 1], np.arange(8) % 2]).astype(bool)
        curve = fit_curve(Runs(x, exceeded, np.concatenate([np.zeros(6, dtype=int), 1 + np.arange(8)])))
        assert (curve.kind, curve.why, curve.fit) == ("none", NO_ERRORS, None)


class TestFewRecords:
    @pytest.mark.parametrize(("records", "said"), [(6, "only 6 distinct records"), (20, "")])
    def test_carry_a_warning(self, records, said):
        seen = stripes(np.random.default_rng(75), records, 0.3)
        lower, upper = brackets(np.random.default_rng(76), 2 * records)
        surface = fit_surface(seen.x, seen.x * np.exp(seen.record % 5), seen.exceeded, seen.record)
        for found in (fit_curve(seen), fit_capacities(lower, upper, np.repeat(np.arange(records), 2)), surface):
            assert found.records == records
            assert found.warning.startswith(said) and bool(found.warning) == bool(said)


class TestWords:
    def test_of_outcomes_that_are_all_but_separate(self):
        x, exceeded = np.geomspace(0.5, 2, 400), np.arange(400) >= 200
        exceeded[[199, 200]] = exceeded[[200, 199]]
        why = fit_curve(one_each(x, exceeded)).why
        assert "all but separate" in why and "cannot be told from none" not in why

    def test_of_few_capacities_whose_increase_nobody_doubts(self):
        records = 3
        levels = np.geomspace(0.1, 2, 200)
        ends = np.concatenate([[0.0], levels, [np.inf]])
        place = np.searchsorted(levels, MEDIAN * np.exp(DISPERSION * np.linspace(-1, 1, records)))
        curve = fit_capacities(ends[place], ends[place + 1], levels=levels)
        assert f"at 95 % {records} records are too few to bound it" in curve.why

    def test_of_several_capacities_of_a_record(self):
        never = fit_capacities(np.full(6, 2.0), np.full(6, np.inf), np.arange(6) // 2)
        assert "none of the 6 ladders of 3 records" in never.why
        two = fit_capacities(np.array([1.0, 2, 1, 3]), np.array([2.0, 3, 3, 4]), np.array([0, 0, 1, 1]))
        assert "the 4 capacities are of 2 records" in two.why


class TestGoodness:
    def test_of_stripes_is_pearsons_with_two_degrees_less_than_levels(self):
        random = np.random.default_rng(41)
        x = np.repeat(LEVELS, 150)
        seen = one_each(x, x > MEDIAN * np.exp(DISPERSION * random.normal(size=x.size)))
        goodness = fit_curve(seen).goodness
        p = fit_curve(seen).probability(LEVELS)
        over = seen.exceeded.reshape(LEVELS.size, 150).sum(axis=1)
        expected = np.array([150 * p, 150 * (1 - p)])
        assert expected.min() > 2
        statistic = ((np.array([over, 150 - over]) - expected) ** 2 / expected).sum()
        assert goodness.name.startswith("Pearson")
        assert (goodness.statistic, goodness.degrees) == pytest.approx((statistic, 4), rel=1e-6)
        assert goodness.p_value == pytest.approx(chi2.sf(statistic, 4), rel=1e-6)

    def test_of_brackets_is_pearsons_with_three_degrees_less_than_cells(self):
        lower, upper = brackets(np.random.default_rng(42), 200)
        curve = fit_capacities(lower, upper, levels=LEVELS)
        bounds = np.concatenate([[0.0], LEVELS, [np.inf]])
        cells = np.diff(np.concatenate([[0.0], curve.probability(LEVELS), [1.0]])) * 200
        observed = np.array([(lower == low).sum() for low in bounds[:-1]])
        assert cells.min() > 2
        statistic = ((observed - cells) ** 2 / cells).sum()
        assert curve.goodness.degrees == pytest.approx(4, rel=0.02)  # observed information stands for the expected one
        assert curve.goodness.statistic == pytest.approx(statistic, rel=0.02)

    def test_repeated_records_are_allowed_for(self):
        # On average T/tr(V) is one; taken as independent the runs of a record give too good an agreement.
        random = np.random.default_rng(43)
        found, naive = [], []
        for _ in range(200):
            seen = stripes(random, 60, 0.47)
            alone, fitted = seen._replace(record=np.arange(seen.x.size)), fit(seen)
            for kept, runs in ((found, seen.seen), (naive, alone.seen)):
                goodness = goodness_of_runs(fitted, design(runs.x), runs)
                kept.append(goodness.statistic / goodness.degrees)
        error = 3 * np.std(found) / np.sqrt(len(found))
        assert abs(np.mean(found) - 1) < error < 0.2
        assert np.mean(naive) < 1 - error

    def test_a_cloud_is_tested_in_tenths_and_rejects_what_is_wrong(self):
        random = np.random.default_rng(44)
        p_values = [fit_curve(cloud(random, 200)).goodness.p_value for _ in range(60)]
        assert sum(p < 0.05 for p in p_values) <= binom.ppf(0.999, 60, 0.05)
        assert min(p_values) < 0.3 and max(p_values) > 0.7
        x = MEDIAN * np.exp(0.7 * random.normal(size=400))
        wrong = fit_curve(one_each(x, (x > 0.25) & ((x < 0.4) | (x > 0.9))))
        assert wrong.goodness.name == "Hosmer-Lemeshow" and wrong.goodness.p_value < 1e-6

    @pytest.mark.parametrize(("each", "below"), [(1, 1e-6), (3, 1e-4)])
    def test_of_brackets_that_belong_to_another_distribution(self, each, below):
        random = np.random.default_rng(45)
        levels, low = np.geomspace(0.1, 10, 25), np.repeat(random.random(120 // each) < 0.5, each)
        capacity = np.where(low, 0.3, 3.0) * np.exp(0.1 * random.normal(size=120))
        bounds = np.concatenate([[0.0], levels, [np.inf]])
        place = np.searchsorted(levels, capacity)
        curve = fit_capacities(bounds[place], bounds[place + 1], np.arange(120) // each, levels=levels)
        assert curve.goodness.p_value < below and "do not rely on this curve" in curve.why

    def test_what_is_not_tested_says_the_same_reason_everywhere(self):
        x = np.repeat([1.0, 2, 3, 4], 4)
        curve = fit_curve(one_each(x, [0] * 4 + [0, 0, 0, 1] + [0, 1, 1, 1] + [1] * 4))
        assert curve.goodness.p_value is None and "takes three groups" in curve.goodness.why
        assert curve.why.endswith(f"whether the data fit a lognormal curve is not tested: {curve.goodness.why}")

    @pytest.mark.rest
    @pytest.mark.parametrize(("records", "each", "count"), [(50, 4, 12), (30, 1, 40)])
    def test_of_brackets_rejects_what_is_right_at_its_rate(self, records, each, count):
        random, levels = np.random.default_rng([47, records, each]), np.geomspace(0.1, 2, count)
        ends = np.concatenate([[0.0], levels, [np.inf]])
        p_values = []
        for _ in range(150):
            scatter = 0.8 * random.normal(size=(records, 1)) + 0.6 * random.normal(size=(records, each))
            place = np.searchsorted(ends, MEDIAN * np.exp(DISPERSION * scatter.ravel()))
            record = np.repeat(np.arange(records), each)
            found = fit_capacities(ends[place - 1], ends[place], record, levels=levels).goodness
            p_values += [found.p_value] if found.p_value is not None else []
            assert found.name.endswith("repeated records") == (each > 1)
        p_values = np.array(p_values)
        assert p_values.size > 100 and (p_values < 0.05).sum() <= binom.ppf(0.999, p_values.size, 0.05)
        assert p_values.min() < 0.2 and p_values.max() > 0.8

    def test_capacities_between_levels_of_their_own_are_not_tested(self):
        lower, upper = np.array([1.0, 1.5, 2.0, 2.5, 4.0]), np.array([1.8, 2.2, 2.8, 4.5, 5.0])
        curve = fit_capacities(lower, upper)
        assert curve.kind == "lognormal" and curve.goodness.p_value is None
        assert "not the same for all capacities" in curve.goodness.why
        tried = np.unique(np.concatenate([lower, upper]))  # and with these no cell has two
        assert "takes four ranges" in fit_capacities(lower, upper, levels=tried).goodness.why


class TestSurface:
    def test_what_a_line_separates_is_no_fit(self):
        random = np.random.default_rng(51)
        x1, x2 = np.exp(random.normal(size=(2, 80)))
        exceeded = np.log(x1) + 0.5 * np.log(x2) > 0.1
        assert fit_curve(one_each(x1, exceeded)).kind == fit_curve(one_each(x2, exceeded)).kind == "lognormal"
        surface = fit_surface(x1, x2, exceeded, np.arange(80))
        assert surface.kind == "none" and "separates" in surface.why
        assert np.isnan(surface.probability(x1, x2)).all() and surface.coefficients is None

    def test_separation_against_lines_of_every_direction(self):
        random = np.random.default_rng(52)
        angles = np.linspace(0, 2 * np.pi, 3600, endpoint=False)
        across = np.column_stack([np.cos(angles), np.sin(angles)])
        seen = set()
        for _ in range(60):
            points = random.normal(size=(10, 2))
            exceeded = points @ [1, 1] + random.normal(size=10) > 0
            if 0 < exceeded.sum() < 10:
                heights = points @ across.T
                apart = bool((heights[exceeded].min(axis=0) >= heights[~exceeded].max(axis=0)).any())
                assert separable(np.column_stack([np.ones(10), points]), exceeded) == apart
                seen.add(apart)
        assert seen == {True, False}

    def test_measures_in_proportion_and_measures_that_are_constant(self):
        random = np.random.default_rng(53)
        x = np.exp(random.normal(size=60))
        exceeded = np.log(x) > random.normal(size=60)
        assert "proportion" in fit_surface(x, 3 * x**0.7, exceeded, np.arange(60)).why
        assert "the same in all runs" in fit_surface(x, rounded(np.full(60, 2.0), 67), exceeded, np.arange(60)).why
        y = np.exp(random.normal(size=60))
        falls = -np.log(x) - np.log(y) > random.normal(size=60)
        assert "no surface increases" in fit_surface(x, y, falls, np.arange(60)).why

    @pytest.mark.parametrize("clustered", [False, True])
    def test_whether_the_second_measure_adds_anything(self, clustered):
        random = np.random.default_rng(54)
        record = np.arange(400) // (5 if clustered else 1)
        x1, x2 = np.exp(random.normal(size=(2, 400)))
        adds = fit_surface(x1, x2, np.log(x1) + np.log(x2) > random.normal(size=400), record)
        assert max(adds.p_values) < 1e-6 and "second measure adds to the first" in adds.why
        alone = fit_surface(x1, x2, np.log(x1) > random.normal(size=400), record)
        assert alone.p_values[1] > 0.05 and "adds nothing" in alone.why
        assert "the first measure alone is sufficient" in alone.why
        other = fit_surface(x1, x2, np.log(x2) > random.normal(size=400), record)
        assert other.p_values[0] > 0.05 and "the second measure alone is sufficient" in other.why
        falls = fit_surface(x1, x2, np.log(x1) - np.log(x2) > random.normal(size=400), record)
        assert "fewer runs exceed the limit as the second one increases" in falls.why


@pytest.mark.parametrize("omega", [3.0])
def test_the_step_of_a_linear_block_under_half_sines_is_recovered(omega):
    def margin(a):  # y at the end of the pulse, from y' = y + a sin(omega tau + asin(1/a)), y(0) = -1
        s = np.sqrt(a * a - 1)
        return (s - omega) * np.exp((np.pi - np.arcsin(1 / a)) / omega) + a

    known = brentq(margin, 1.0 + 1e-9, 50.0)
    block = linear_block(0.9)
    a = np.geomspace(1.01, 10.0, 400)
    found = outcomes(block, parse_shape("half_sine"), block.period(np.full(a.size, omega)), a)
    curve = fit_curve(one_each(a, found.overturned))
    assert curve.kind == "step" and curve.step.low < known < curve.step.high
    assert curve.step.high / curve.step.low == pytest.approx((10 / 1.01) ** (1 / 399))
    assert curve.median.value == pytest.approx(known, rel=0.006)
    uplift = fit_curve(one_each(np.concatenate([[0.99], a]), np.concatenate([[0], found.peak_ratio != 0])))
    assert uplift.step.low < 1 < uplift.step.high

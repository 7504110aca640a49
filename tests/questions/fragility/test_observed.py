"""What was observed: which runs have one intensity, which are looked at together, and what intervals say of records."""

import numpy as np
import pytest
from scipy.stats import binom, binomtest

from rocking_cli.questions.fragility.observed import (
    MAX_STRIPES,
    MEASURED_COVERAGE,
    MIN_RELIABLE_RECORDS,
    RUN_GROUPS,
    Observations,
    few_records,
    one_of_each,
)

LEVELS = np.array([0.2, 0.4, 0.6])


def jittered(x, seed=0, ulps=3):
    """Intensities as another processor may round them."""
    return x + np.random.default_rng(seed).integers(-ulps, ulps + 1, x.size) * np.spacing(x)


def scaled(records, each, levels=LEVELS, **options):
    """`each` runs of every record at every level, none of which exceeds."""
    x = np.repeat(np.tile(levels, records), each)
    record = np.repeat(np.arange(records), levels.size * each)
    return Observations.of(x, np.zeros(x.size, dtype=bool), record, **options)


class TestOneIntensity:
    def test_what_differs_by_rounding_alone_is_one(self):
        x = np.repeat(LEVELS, 50) * 9.80665
        found = one_of_each(jittered(x))
        assert np.unique(found).size == 3
        np.testing.assert_allclose(found, x, rtol=1e-14)

    def test_what_differs_by_more_is_left_as_it_is(self):
        x = np.random.default_rng(1).permutation(0.3 * (1 + 1e-6 * np.arange(100)))
        np.testing.assert_array_equal(one_of_each(x), x)
        np.testing.assert_array_equal(one_of_each(np.array([np.inf, 0.0, 1.0, np.inf, 0.0])), [np.inf, 0, 1, np.inf, 0])

    def test_runs_of_a_level_have_the_intensity_of_the_level(self):
        level = np.tile(np.arange(3), 40)
        seen = Observations.of(jittered(LEVELS[level]), np.zeros(120, dtype=bool), np.arange(120) // 3, level=level)
        assert seen.x.size == 3 and seen.counts.number.tolist() == [1] * 120
        np.testing.assert_array_equal(seen.counts.term, np.sort(level))


class TestGroups:
    def test_stripes_are_of_many_records_not_of_many_runs(self):
        assert not scaled(4, 60).stripes
        assert scaled(5, 1).stripes

    def test_a_cloud_run_over_and_over_is_looked_at_in_tenths(self):
        # 12 records of unlike intensity at 10 factors, each 60 times: 120 intensities, and none of them is a stripe.
        x = np.outer(np.geomspace(0.1, 0.9, 12), np.geomspace(0.5, 4, 10)).ravel()
        seen = Observations.of(np.repeat(x, 60), np.zeros(7200, dtype=bool), np.repeat(np.arange(12), 600))
        assert not seen.stripes and seen.group.max() == 9
        assert np.bincount(seen.group, seen.counts.number).tolist() == [720] * 10
        assert np.bincount(seen.group).tolist() == [12] * 10

    def test_one_intensity_stays_together(self):
        seen = Observations.of(np.repeat([1.0, 2.0], [9, 3]), np.zeros(12, dtype=bool), np.arange(12) % 3)
        assert (seen.group.tolist(), seen.counts.number.tolist()) == ([0] * 3 + [1] * 3, [3.0] * 3 + [1.0] * 3)

    def test_runs_counted_beforehand_are_the_same_runs(self):
        random = np.random.default_rng(2)
        x, record = LEVELS[random.integers(0, 3, 500)], random.integers(0, 9, 500)
        exceeding, runs = random.integers(0, 3, 500), random.integers(2, 5, 500)
        once = Observations.of(x, exceeding, record, runs=runs)
        each = np.repeat(np.arange(500), runs)
        nth = np.arange(each.size) - np.repeat(np.cumsum(runs) - runs, runs)
        one_by_one = Observations.of(x[each], nth < exceeding[each], record[each])
        for name in ("record", "term", "number"):
            np.testing.assert_array_equal(getattr(once.counts, name), getattr(one_by_one.counts, name))
        np.testing.assert_array_equal(once.exceeding, one_by_one.exceeding)
        assert (once.runs, once.exceedances) == (runs.sum(), exceeding.sum())

    def test_more_intensities_than_can_be_looked_at_are_looked_at_in_tenths(self):
        assert scaled(5, 1, np.linspace(0.1, 1, MAX_STRIPES)).stripes
        many = scaled(5, 1, np.linspace(0.1, 1, MAX_STRIPES + 1))
        assert not many.stripes and many.group.max() == RUN_GROUPS - 1


class TestIntervals:
    def test_of_records_that_occur_once_are_wilsons(self):
        x = np.repeat(LEVELS, 20)
        exceeded = np.concatenate([np.arange(20) < k for k in (0, 7, 20)])
        found = Observations.of(x, exceeded, np.arange(60)).parts(0.95)
        expected = [binomtest(k, 20).proportion_ci(0.95, method="wilson") for k in (0, 7, 20)]
        np.testing.assert_allclose(np.column_stack([found.low, found.high]), [[ci.low, ci.high] for ci in expected])
        assert found.runs.tolist() == found.records.tolist() == [20] * 3
        assert found.exceeding.tolist() == [0, 7, 20]

    def test_more_runs_of_the_same_records_say_no_more(self):
        def of(each):
            exceeded = np.repeat(np.repeat([True, False], 6), each)
            record = np.repeat(np.arange(12), each)
            level = np.zeros(12 * each, dtype=int)
            return Observations.of(np.ones(12 * each), exceeded, record, level=level).parts(0.95)

        two, many = of(2), of(60)
        assert (two.low[0], two.high[0]) == pytest.approx((many.low[0], many.high[0]), rel=1e-12)
        wilson = binomtest(360, 720).proportion_ci(0.95, method="wilson")
        assert many.high[0] - many.low[0] > 5 * (wilson.high - wilson.low)

    def test_one_record_says_nothing_of_others(self):
        found = Observations.of(np.ones(60), np.ones(60, dtype=bool), np.zeros(60, dtype=int)).parts(0.95)
        assert (found.part[0], found.low[0], found.high[0]) == (1, 0, 1)

    @pytest.mark.rest
    @pytest.mark.parametrize("records", [3, 20])
    @pytest.mark.parametrize("alike", [0.1, 0.9, 1.0])
    @pytest.mark.parametrize("true", [0.03, 0.5])
    def test_hold_at_their_rate_however_alike_the_runs_of_a_record_are(self, records, alike, true):
        # Each record has a probability of its own, scattered as a beta distribution of this correlation of its runs.
        random, repetitions, each = np.random.default_rng([records, int(10 * alike), int(100 * true)]), 400, 20
        held = 0
        for _ in range(repetitions):
            if alike == 1:
                own = (random.random(records) < true).astype(float)
            else:
                own = random.beta(true * (1 / alike - 1), (1 - true) * (1 / alike - 1), records)
            exceeded = random.random((records, each)) < own[:, None]
            seen = Observations.of(np.ones(exceeded.size), exceeded.ravel(), np.repeat(np.arange(records), each))
            found = seen.parts(0.95)
            held += bool(found.low[0] <= true <= found.high[0])
        assert held >= binom.ppf(1e-4, repetitions, 0.95)


def test_few_records_are_said():
    assert few_records(MIN_RELIABLE_RECORDS) == ""
    said = (
        "intervals and bands are a rough guide: in trials with {} records{} those that should hold in 95 % of cases "
        "held in {} to {} %"
    )
    smaller = " (the next smaller number tried)"
    assert few_records(6) == f"only 6 distinct records: {said.format(5, smaller, *MEASURED_COVERAGE[5])}"
    assert few_records(10) == f"only 10 distinct records: {said.format(10, '', *MEASURED_COVERAGE[10])}"
    assert few_records(19) == f"only 19 distinct records: {said.format(10, smaller, *MEASURED_COVERAGE[10])}"
    least = said.format(5, " (the smallest number tried)", *MEASURED_COVERAGE[5])
    assert few_records(1) == f"only 1 distinct record: {least}"

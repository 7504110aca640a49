"""Distributions of a study against scipy's, and samples of them."""

import numpy as np
import pytest
from scipy import stats

from rocking_cli.questions.fragility.definition import Distribution, draw

P = np.array([1e-6, 0.01, 0.2, 0.5, 0.77, 0.99, 1 - 1e-6])
CASES = {
    "normal": ({"normal": {"mean": 2.0, "deviation": 0.5}}, stats.norm(2.0, 0.5)),
    "truncated": (
        {"normal": {"mean": 2.0, "deviation": 0.5, "low": 1.8, "high": 2.6}},
        stats.truncnorm(-0.4, 1.2, 2.0, 0.5),
    ),
    "in the upper tail": ({"normal": {"mean": 0.0, "deviation": 1.0, "low": 9.0}}, stats.truncnorm(9.0, np.inf)),
    "where no number holds what lies between": (
        {"normal": {"mean": 0.0, "deviation": 1.0, "low": -39.0, "high": -38.0}},
        stats.truncnorm(-39.0, -38.0),
    ),
    "lognormal": ({"lognormal": {"median": 3.0, "dispersion": 0.4}}, stats.lognorm(0.4, scale=3.0)),
    "uniform": ({"uniform": {"low": -1.0, "high": 3.0}}, stats.uniform(-1.0, 4.0)),
    "triangular": ({"triangular": {"low": 1.0, "mode": 1.5, "high": 4.0}}, stats.triang(0.5 / 3, 1.0, 3.0)),
}


@pytest.mark.parametrize("name", CASES)
def test_quantiles_are_those_of_scipy(name):
    given, reference = CASES[name]
    found = Distribution.model_validate(given).quantile(P)
    assert found == pytest.approx(reference.ppf(P), rel=1e-9)


def test_truncated_lognormal_by_its_distribution_function():
    shape = Distribution.model_validate({"lognormal": {"median": 3.0, "dispersion": 0.4, "low": 2.0, "high": 5.0}})
    whole = stats.lognorm(0.4, scale=3.0)
    below, above = whole.cdf(2.0), whole.cdf(5.0)
    assert (whole.cdf(shape.quantile(P)) - below) / (above - below) == pytest.approx(P, rel=1e-9)
    # A bound that no positive number is below changes nothing.
    free = Distribution.model_validate({"lognormal": {"median": 3.0, "dispersion": 0.4, "low": -1.0}})
    assert free.quantile(P) == pytest.approx(whole.ppf(P), rel=1e-9)


def test_values_are_equally_likely():
    found = draw(Distribution(values=[1.0, 5.0, 7.0]), 300, seed=1, stream="x", method="latin hypercube")
    assert [int((found == each).sum()) for each in (1.0, 5.0, 7.0)] == [100, 100, 100]


def test_a_latin_hypercube_has_one_sample_in_each_range():
    shape = Distribution.model_validate({"normal": {"mean": 0.0, "deviation": 1.0}})
    found = draw(shape, 50, seed=3, stream="width", method="latin hypercube")
    assert sorted(np.floor(50 * stats.norm.cdf(found)).astype(int)) == list(range(50))
    assert list(found) != sorted(found)


def test_samples_belong_to_their_seed_and_stream():
    shape = Distribution.model_validate({"uniform": {"low": 0.0, "high": 1.0}})

    def drawn(seed, stream, method="random"):
        return draw(shape, 20, seed=seed, stream=stream, method=method).tolist()

    assert drawn(1, "a") == drawn(1, "a")
    assert len({tuple(drawn(*each)) for each in ((1, "a"), (2, "a"), (1, "b"), (1, "a", "latin hypercube"))}) == 4


def test_random_samples_follow_the_distribution():
    shape = Distribution.model_validate({"triangular": {"low": 1.0, "mode": 1.5, "high": 4.0}})
    found = draw(shape, 4000, seed=5, stream="x", method="random")
    assert stats.kstest(found, stats.triang(0.5 / 3, 1.0, 3.0).cdf).pvalue > 0.001

"""A curve of data of one's own against statsmodels, closed forms, and copies of the same data."""

import pickle

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.stats import norm
from scipy.stats import t as student
from statsmodels.genmod import families
from statsmodels.genmod.generalized_linear_model import GLM

import rocking_cli as rk

LINKS = {"lognormal": families.links.Probit(), "logit": families.links.Logit()}
DEVIATION = {"lognormal": 1.0, "logit": np.pi / np.sqrt(3)}


def cloud(seed, runs=150):
    random = np.random.default_rng(seed)
    x = 0.4 * np.exp(0.7 * random.normal(size=runs))
    return x, x > 0.4 * np.exp(0.5 * random.normal(size=runs))


def model(x, exceeded, curve):
    design = np.column_stack([np.ones(x.size), np.log(x)])
    return GLM(exceeded.astype(float), design, family=families.Binomial(LINKS[curve]))


def ends(a, b, covariance, quantile, deviation):
    """The intervals of median and dispersion: where the band crosses one half, and from the ends of the slope."""

    def beyond(u, sign):
        row = np.array([1.0, u])
        return a + b * u + sign * quantile * np.sqrt(row @ covariance @ row)

    median = tuple(np.exp(brentq(beyond, -a / b - 3, -a / b + 3, args=(sign,))) for sign in (1, -1))
    reach = quantile * np.sqrt(covariance[1, 1])
    return {"median": median, "dispersion": (deviation / (b + reach), deviation / (b - reach))}


def agree(found, expected):
    for name, interval in expected.items():
        np.testing.assert_allclose(found[name], interval, rtol=1e-5)


@pytest.mark.parametrize("curve", LINKS)
def test_refitted_by_statsmodels(curve):
    x, exceeded = cloud(1)
    fit = rk.fit_fragility(x, exceeded, curve=curve, confidence=0.8)
    other = model(x, exceeded, curve).fit()
    a, b = other.params
    assert fit.median.value == pytest.approx(np.exp(-a / b), rel=1e-6)
    assert fit.dispersion.value == pytest.approx(DEVIATION[curve] / b, rel=1e-6)
    assert fit.curve.aic[curve] == pytest.approx(other.aic, rel=1e-9)
    observed = np.linalg.inv(-model(x, exceeded, curve).hessian(other.params, scale=1.0))
    agree(fit.interval, ends(a, b, observed, norm.ppf(0.9), DEVIATION[curve]))
    frame = fit.to_frame()
    predicted = other.predict(np.column_stack([np.ones(101), np.log(frame["intensity"])]))
    np.testing.assert_allclose(frame["probability"], predicted, rtol=1e-4)


@pytest.mark.parametrize(("curve", "size"), [("lognormal", 5), ("logit", 1)])
def test_robust_interval_leaves_out_each_cluster(curve, size):
    x, exceeded = cloud(2)
    names = [f"record {k // size}" for k in range(x.size)]
    fit = rk.fit_fragility(x, exceeded, curve=curve, clusters=names if size > 1 else None)
    best = model(x, exceeded, curve).fit().params
    moved = []
    for k in range(x.size // size):
        rest = model(np.delete(x, np.s_[k * size : (k + 1) * size]),
                     np.delete(exceeded, np.s_[k * size : (k + 1) * size]), curve)  # fmt: skip
        moved.append(np.linalg.solve(-rest.hessian(best, scale=1.0), rest.score(best, scale=1.0)))
    count = len(moved)
    covariance = np.array(moved).T @ np.array(moved) * (count - 1) / count
    agree(fit.robust_interval, ends(*best, covariance, student.ppf(0.975, count - 1), DEVIATION[curve]))


def test_two_shares_give_the_curve_through_them():
    x, exceeded = [1.0] * 4 + [np.e] * 4, [1, 0, 0, 0, 1, 1, 1, 0]
    probit, logit = (rk.fit_fragility(x, exceeded, curve=curve) for curve in LINKS)
    assert probit.median.value == pytest.approx(1.6487212707) and logit.median.value == pytest.approx(1.6487212707)
    assert probit.dispersion.value == pytest.approx(0.7413011093)  # 1/(2 x 0.6744897502)
    assert logit.dispersion.value == pytest.approx(0.8254956653)  # pi/(sqrt(3) 2 ln 3)
    assert probit.curve.fit.log_likelihood == logit.curve.fit.log_likelihood == pytest.approx(-4.4986811569)


def test_copies_of_a_run_say_nothing_new_if_they_are_one_cluster():
    x, exceeded = cloud(3)
    once = rk.fit_fragility(x, exceeded)
    again = rk.fit_fragility(np.repeat(x, 4), np.repeat(exceeded, 4), clusters=np.repeat(np.arange(x.size), 4))
    assert again.median.value == pytest.approx(once.median.value)
    agree(again.robust_interval, once.robust_interval)
    spread = [np.diff(np.log(fit.interval["median"])) for fit in (once, again)]
    assert spread[1] == pytest.approx(spread[0] / 2, rel=0.05)
    assert once.curve.goodness.p_value == pytest.approx(again.curve.goodness.p_value, abs=0.1)


def test_unknown_runs_are_counted_both_ways():
    x, exceeded = cloud(4)
    known = np.where(np.arange(x.size) % 30 == 0, np.nan, exceeded)
    fit = rk.fit_fragility(x, known)
    upper, lower = (rk.fit_fragility(x, np.where(np.isnan(known), value, known)) for value in (1, 0))
    assert fit.median == upper.median and fit.lower.median == lower.median and fit.median.value < lower.median.value
    assert fit.lower.robust_interval == lower.robust_interval
    assert (fit.unknown, fit.is_band) == (5, True)
    assert fit.sentences[0].endswith(
        f"95 % robust intervals; {int(np.nansum(known))} of 150 runs exceed; the outcome of 5 is unknown."
    )
    assert any("whether 5 of 150 runs (3.3 %) exceed the limit is unknown; the result is the band" in each
               for each in fit.sentences)  # fmt: skip
    assert (fit.to_frame()["lower_probability"] < fit.to_frame()["probability"]).all()
    assert any("if unknown runs do not" in text.get_text() for text in fit.plot().legends[0].get_texts())
    assert rk.fit_fragility(x[1:121], known[1:121]).sentences[1].startswith("Upper: ")
    assert not rk.fit_fragility(x[:100], np.where(np.arange(100) > 0, exceeded[:100], np.nan)).is_band


def test_what_has_no_logarithm_is_left_out_and_counted():
    x, exceeded = cloud(5)
    fit = rk.fit_fragility(np.r_[x, 0.0, -1.0, np.nan], np.r_[exceeded, 1, 0, 1], label="Sa [g]")
    assert fit.median == rk.fit_fragility(x, exceeded).median and fit.left_out == 3
    assert "3 runs have no Sa [g] above zero and are left out of this fit." in fit.sentences


N = np.arange(1, 41)


@pytest.mark.parametrize(
    "x, exceeded, clusters, kind, sentence",
    [
        (N, N > 20, None, "step", "No run exceeds the limit up to 20 and all runs do from 21, so the dispersion"),
        (N, N < 20.5 + (-1.0) ** N * 3, None, "none", "No increasing curve exists"),
        (N, N > 0, None, "none", "All of the 40 runs exceed."),
        (N, (N > 37) + (N == 12), None, "lognormal", "Only 4 of 40 runs exceed: with fewer than 10 the median may"),
        (N, (N > 8) & (N < 30), None, "lognormal", "Do not rely on this curve: the goodness-of-fit test rejects"),
        (N, (N - 9 * np.sin(N)) > 20, N // 21, "lognormal", "There is no robust interval: the 40 runs are of 2 clu"),
        (N[:12], (N - 4 * np.sin(N))[:12] > 6, None, "lognormal", "Warning: only 12 distinct clusters"),
    ],
)  # fmt: skip
def test_what_cannot_be_trusted_is_said(x, exceeded, clusters, kind, sentence):
    fit = rk.fit_fragility(x, exceeded, clusters=clusters)
    assert fit.curve.kind == kind
    assert any(each.startswith(sentence) for each in fit.sentences), fit.sentences
    assert (fit.median is None) == (kind == "none") and fit.plot() and len(fit.to_frame())
    assert fit.to_dict()["kind"] == kind and not any(sign in repr(fit) for sign in "\r\n")


GOOD = [0.1, 0.2, 0.3, 0.4], [0, 1, 0, 1]


@pytest.mark.parametrize(
    "given, options, message",
    [
        (([1, 2], [1]), {}, "`exceeded` must have one value for each intensity: there are 1 and 2"),
        (([1, np.inf], [1, 0]), {}, r"`intensity\[1\]` must be finite"),
        (([[1, 2]], [1, 0]), {}, "`intensity` must have one dimension, has 2"),
        (([1, 2], ["yes", "no"]), {}, "`exceeded` must be an array of numbers"),
        (([1, 2], [1, 0.5]), {}, r"`exceeded\[1\]` must be 1, 0 or NaN, got 0.5"),
        (GOOD, {"clusters": ["a"]}, "`clusters` must have one name for each intensity: there are 1 and 4"),
        (GOOD, {"clusters": ["a", None, "b", "c"]}, r"`clusters\[1\]` is missing"),
        (GOOD, {"clusters": [[1], [2], [3], [4]]}, "`clusters` must be a sequence of names"),
        (GOOD, {"label": "lower_high"}, "`label` must not be 'lower_high', the name of another column"),
    ],
)
def test_a_wrong_argument_is_named(given, options, message):
    with pytest.raises(rk.InputError, match=message):
        rk.fit_fragility(*given, **options)


def test_few_that_exceed_are_counted_as_the_fit_counts_them():
    fit = rk.fit_fragility(N, np.where(N == 15, np.nan, (N > 37) + (N == 12)))
    assert "; 4 of 40 runs exceed; the outcome of 1 is unknown." in fit.sentences[0]
    assert any("nly 5 of 40 runs count as exceeding" in each for each in fit.sentences)


def test_columns_of_frames_are_of_the_same_rows():
    pandas = pytest.importorskip("pandas")
    x, exceeded = (pandas.Series(each) for each in cloud(6))
    assert rk.fit_fragility(x, exceeded).median == rk.fit_fragility(x.to_numpy(), exceeded).median
    for other in (x.sort_values(), x.iloc[::-1]):
        with pytest.raises(rk.InputError, match="have different rows, or rows in a different order"):
            rk.fit_fragility(other, exceeded)


def test_several_fits_are_drawn_in_one_plot():
    fits = [rk.fit_fragility(*cloud(seed)) for seed in (4, 6)]
    figure = fits[0].plot(name="slender", beside={"stocky": fits[1]})
    said = [text.get_text() for text in figure.legends[0].get_texts()]
    assert said[0].startswith("slender") and said[1].startswith("stocky")
    colours = {line.get_color() for line in figure.axes[0].lines if len(line.get_xdata()) > 50}
    assert len(colours) == 2


def test_an_answer_of_any_name_is_kept_and_drawn(tmp_path):
    x, exceeded = cloud(6)
    fit = rk.fit_fragility(x, exceeded, label="$S_a\n{\\x}$ [g]", clusters=[k % 25 for k in range(150)])
    again = pickle.loads(pickle.dumps(fit))
    assert again.to_frame().equals(fit.to_frame()) and again.robust_interval == fit.robust_interval
    assert repr(fit).startswith("<fit_fragility: lognormal, median 0.")
    fit.plot(tmp_path / "fit.png")
    assert (tmp_path / "fit.png").stat().st_size > 10_000
    assert list(fit.to_frame())[1:6] == ["probability", "low", "high", "robust_low", "robust_high"]

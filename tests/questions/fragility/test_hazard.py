"""Annual rates against Cornell's closed form, plain sums and steps; hazard files and what is wrong in them."""

from math import exp, inf, log

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.stats import norm

from rocking_cli.errors import DoubtWarning, InputError
from rocking_cli.questions.fragility.curves import FragilityCurve
from rocking_cli.questions.fragility.hazard_curve import HazardCurve, annual_rate, read_hazard
from rocking_cli.questions.fragility.study import load_study
from rocking_cli.studies.fit import Estimate, Fit
from tests.conftest import EXAMPLES

COVARIANCE = np.array([[0.02, 0.015], [0.015, 0.03]])


def lognormal(median, dispersion, covariance=COVARIANCE):
    coefficients = np.array([-log(median), 1.0]) / dispersion
    return FragilityCurve("lognormal", "", 0.95, 100, 50, fit=Fit("probit", coefficients, covariance, -1.0, 0.95))


def step(at, low, high):
    return FragilityCurve("step", "", 0.95, 100, 50, step=Estimate(at, low, high))


def power_law(k, start=1e-4, stop=1e4, k0=1e-3):
    x = np.geomspace(start, stop, 7)
    return HazardCurve(x, k0 * x**-k)


BENT = HazardCurve(np.array([0.05, 0.1, 0.3, 1.0, 2.0]), np.array([2e-2, 9e-3, 9e-4, 9e-4, 1e-5]))


class TestRate:
    @pytest.mark.parametrize(("k", "dispersion"), [(1.0, 0.5), (2.5, 0.05)])
    def test_of_a_lognormal_curve_and_one_power_law_is_cornells(self, k, dispersion):
        found = annual_rate(lognormal(0.6, dispersion), power_law(k))
        expected = 1e-3 * 0.6**-k * exp((k * dispersion) ** 2 / 2)
        assert found.rate == pytest.approx(expected, rel=1e-9)
        assert found.return_period == pytest.approx(1 / expected, rel=1e-9)
        assert found.in_50_years == pytest.approx(1 - exp(-50 * expected), rel=1e-9)
        assert found.above < 1e-12 * expected and found.below < 1e-9 * expected

    def test_of_a_bent_hazard_curve_is_a_plain_sum(self):
        dispersion = 0.6
        curve = lognormal(0.7, dispersion)
        x = np.exp(np.linspace(log(0.05), log(2.0), 400_001))
        logs = np.log(BENT.intensity), np.log(BENT.annual_rate)
        rates = np.exp(np.interp(np.log(x), *logs))
        middle = np.sqrt(x[1:] * x[:-1])

        def summed(probability):
            return (probability(middle) * -np.diff(rates)).sum() + probability(x[-1:])[0] * rates[-1]

        found = annual_rate(curve, BENT)
        assert found.rate == pytest.approx(summed(curve.probability), rel=1e-6)
        assert found.low == pytest.approx(summed(lambda x: curve.band(x)[0]), rel=1e-6)
        assert found.high == pytest.approx(summed(lambda x: curve.band(x)[1]), rel=1e-6)
        assert found.low < found.rate < found.high
        assert found.above == pytest.approx(norm.sf(log(2 / 0.7) / dispersion) * 1e-5, rel=1e-9)

    def test_of_a_logistic_curve_is_a_plain_sum_and_open_below(self):
        fit = Fit("logit", np.array([-4.0, 6.0]), COVARIANCE, -1.0, 0.95)
        curve = FragilityCurve("logistic", "", 0.95, 100, 50, fit=fit)
        hazard = power_law(2.0, 0.1, 5.0)
        found = annual_rate(curve, hazard)
        inside = quad(lambda x: 1 / (1 + exp(4 - 6 * x)) * 2e-3 * x**-3, 0.1, 5.0, epsabs=0, epsrel=1e-10)[0]
        end = 1 / (1 + exp(-26)) * 1e-3 / 25
        assert found.rate == pytest.approx(inside + end, rel=1e-9)
        assert found.below == inf

    def test_what_lies_below_the_first_point_is_what_the_power_law_goes_on_to_add(self):
        curve, k = lognormal(0.3, 0.6), 2.2
        found = annual_rate(curve, power_law(k, 0.2, 50.0))
        added = quad(lambda s: norm.cdf((s - log(0.3)) / 0.6) * k * 1e-3 * exp(-k * s), -30, log(0.2), epsrel=1e-11)[0]
        assert found.below == pytest.approx(added, rel=1e-8)
        assert found.rate + found.below == pytest.approx(1e-3 * 0.3**-k * exp((k * 0.6) ** 2 / 2), rel=1e-6)
        flat = HazardCurve(np.array([0.1, 0.2, 1.0]), np.array([1e-3, 1e-3, 1e-5]))
        assert annual_rate(curve, flat).below == 0

    def test_of_a_step_is_the_rate_at_the_step(self):
        found = annual_rate(step(0.3, 0.1, 1.0), BENT)
        assert (found.rate, found.low, found.high) == pytest.approx((9e-4, 9e-4, 9e-3))
        assert (found.above, found.below) == (0, 0)
        found = annual_rate(step(0.2, 0.15, 0.25), power_law(2.0))
        assert (found.rate, found.low, found.high) == pytest.approx((1e-3 / 0.04, 1e-3 / 0.0625, 1e-3 / 0.0225))

    def test_of_a_step_outside_the_hazard_curve(self):
        beyond = annual_rate(step(3.0, 1.5, 4.0), BENT)
        assert (beyond.rate, beyond.low, beyond.above) == (0, 0, 1e-5) and beyond.return_period == inf
        assert beyond.high == pytest.approx(float(BENT.rate(np.array([1.5]))[0]))
        under = annual_rate(step(0.025, 0.01, 0.04), BENT)
        k = log(2e-2 / 9e-3) / log(2)
        assert under.rate == pytest.approx(2e-2)
        assert under.rate + under.below == pytest.approx(2e-2 * 2**k)


class TestFile:
    def test_heading_comments_blanks_and_line_ends(self, tmp_path):
        path = tmp_path / "hazard.csv"
        path.write_bytes("\ufeff# site A\r\nPGA [g], rate [1/year]\r\n\r\n0.05, 2e-2\r\n0.1,9e-3 \r\n".encode())
        found = read_hazard(path, "PGA")
        np.testing.assert_array_equal(found.intensity, [0.05, 0.1])
        np.testing.assert_array_equal(found.annual_rate, [2e-2, 9e-3])

    @pytest.mark.parametrize(
        ("text", "place", "words"),
        [
            ("0.1,1e-2,3\n", ":1", "3 columns"),
            ("x,y\n\n0.1,1e-2\n0.2,high\n", ":4", "'high' is not a number"),
            ("x,y\n0.1,1e-2\n\n0.05,1e-3\n", ":4", "does not exceed"),
            ("0.1,1e-3\n0.2,1e-2\n", ":2", "above"),
            ("0,1e-2\n0.2,1e-3\n", ":1", "it must be positive"),
            ("0.1,1e-3\n0.2,0\n", ":2", "it must be positive"),
            ("", "", "0 points: at least two"),
        ],
    )
    def test_what_is_wrong_is_placed_at_its_line(self, tmp_path, text, place, words):
        path = tmp_path / "hazard.csv"
        path.write_text(text, encoding="utf-8")
        with pytest.raises(InputError) as caught:
            read_hazard(path, "PGA")
        assert f"hazard.csv{place}: " in str(caught.value) and words in str(caught.value)


COMMENT = (
    """#,,,,"generated_by='OpenQuake engine 3.20.0', checksum=1, kind='mean', investigation_time=50.0, imt='{}'"\n"""
)
SITE = "1.5,42.0,0.0,9.5E-01,2.0E-01,1.0E-02\n"


class TestFileOfOpenQuake:
    def written(self, folder, imt="PGA", site=SITE, heading="lon,lat,depth,poe-0.0100000,poe-1.00000e-01,poe-0.5\n"):
        (folder / "curve.csv").write_text(COMMENT.format(imt) + heading + site, encoding="utf-8")
        return folder / "curve.csv"

    def test_probabilities_in_the_investigation_time_become_annual_rates(self, tmp_path):
        found = read_hazard(self.written(tmp_path), "PGA")
        np.testing.assert_allclose(found.intensity, [0.01, 0.1, 0.5])
        np.testing.assert_allclose(1 - np.exp(-50 * found.annual_rate), [0.95, 0.2, 0.01])

    @pytest.mark.parametrize(
        ("imt", "measure", "factor"), [("SA(1.0)", "Sa(1 s)", 1), ("PGV", "PGV", 100), ("CAV", "CAV", 1 / 9.80665)]
    )
    def test_intensities_are_in_the_unit_of_the_measure(self, tmp_path, imt, measure, factor):
        found = read_hazard(self.written(tmp_path, imt), measure)
        np.testing.assert_allclose(factor * found.intensity, [0.01, 0.1, 0.5])

    def test_probabilities_of_zero_and_one_are_cut_and_named(self, tmp_path):
        heading = "custom_site_id,lon,lat,depth,poe-0.01,poe-0.1,poe-0.5,poe-1,poe-2\n"
        path = self.written(tmp_path, "PGV", "A1,0,0,0,1.000000E+00,2E-01,1E-02,0.000000E+00,0.000000E+00\n", heading)
        with pytest.warns(DoubtWarning, match=r"no annual rate: left out at PGV = 0.01, 1, 2$"):
            found = read_hazard(path, "PGV")
        np.testing.assert_allclose(found.intensity, [0.001, 0.005])

    @pytest.mark.parametrize(
        ("given", "place", "words"),
        [
            (
                {"imt": "SA(0.2)"},
                ":1",
                r"intensities are SA\(0.2\), but the hazard is in PGA\n  export the curve of PGA",
            ),
            ({"site": SITE * 3}, "", "3 sites, one is needed"),
            ({"site": SITE[:-9]}, ":3", "5 columns, but the heading has 6"),
            ({"site": SITE.replace("2.0E-01", "1.2")}, ":3", "rate is nan"),
            ({"site": "0,0,0,0,0,0\n"}, ":3", "at least two"),
        ],
    )
    def test_what_is_wrong_is_placed(self, tmp_path, given, place, words):
        with pytest.raises(InputError, match=words) as caught:
            read_hazard(self.written(tmp_path, **given), "PGA")
        assert f"curve.csv{place}: " in str(caught.value)

    def test_without_its_comment_nothing_is_known_of_it(self, tmp_path):
        path = self.written(tmp_path)
        path.write_text("".join(path.read_text(encoding="utf-8").splitlines(keepends=True)[1:]), encoding="utf-8")
        with pytest.raises(InputError, match=":1: investigation_time or imt is missing"):
            read_hazard(path, "PGA")

    def test_a_study_reads_it_in_its_measure(self, tmp_path):
        self.written(tmp_path, "PGV", heading="lon,lat,depth,poe-1,poe-10,poe-50\n")
        text = (EXAMPLES / "study" / "pedestal.yaml").read_text(encoding="utf-8").replace("../", f"{EXAMPLES}/")
        for measure in ("PGV", "PGA"):
            (tmp_path / "study.yaml").write_text(f"{text}hazard: {{measure: {measure}, file: curve.csv}}\n")
            if measure == "PGV":
                found = load_study(tmp_path / "study.yaml").hazard
                np.testing.assert_allclose(found.intensity, [0.01, 0.1, 0.5])
            else:
                with pytest.raises(InputError, match="intensities are PGV, but the hazard is in PGA"):
                    load_study(tmp_path / "study.yaml")

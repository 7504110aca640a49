"""Intensity measures against closed forms, polynomials and quadrature; doubts against motions made doubtful."""

import itertools
import re
from math import pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.polynomial import Polynomial
from scipy.integrate import quad

from rocking_cli.ask.read import read_record
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import STANDARD_GRAVITY as G
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.doubts import coarse_for, doubts
from rocking_cli.excitation.measures import arias_build_up, measure
from tests.conftest import EXAMPLES, NEEDS_RECORDS, RECORDS

MOTIONS = arrays(np.float64, st.integers(2, 30), elements=st.floats(-10, 10).map(lambda x: round(x, 3)))
NOISE = GroundMotion("noise", 0.02, np.random.default_rng(5).normal(size=400), unit="m/s2")


def kinds(motion):
    return [doubt.kind for doubt in doubts(motion, measure(motion))]


def clean():
    """Ten seconds that begin and end at rest: the second derivative of a displacement that does."""
    t = np.linspace(0, 10, 1001)
    bell, turn = np.sin(pi * t / 10) ** 4, 2 * pi * 1.5 * t
    return np.gradient(np.gradient(bell * np.sin(turn), t), t) / 50


class TestClosedForms:
    def test_a_constant_acceleration(self):
        found = measure(GroundMotion("constant", 0.01, np.full(201, 3.0), unit="m/s2"))
        assert (found.pgv, found.pgd) == (pytest.approx(6), pytest.approx(6))
        assert found.arias == pytest.approx(pi / (2 * G) * 9 * 2)
        assert (found.t_5, found.t_95) == (pytest.approx(0.1), pytest.approx(1.9))
        assert found.significant_duration == pytest.approx(1.8)
        assert (found.mean * G, found.rms * G) == (pytest.approx(3), pytest.approx(3))
        assert found.mean_period is None

    @pytest.mark.parametrize("samples", [2, 3, 50])
    def test_a_ramp_whatever_the_number_of_samples(self, samples):
        found = measure(GroundMotion("ramp", 4 / (samples - 1), np.linspace(0, 2, samples), unit="m/s2"))
        assert (found.pgv, found.pgd) == (pytest.approx(4), pytest.approx(2 * 4**2 / 6))
        assert found.arias == pytest.approx(pi / (2 * G) * 4 * 4 / 3)
        assert (found.t_5, found.t_95) == (pytest.approx(4 * 0.05 ** (1 / 3)), pytest.approx(4 * 0.95 ** (1 / 3)))

    def test_a_velocity_that_peaks_between_two_samples(self):
        found = measure(GroundMotion("descent", 1.0, np.array([1.0, -1.0]), unit="m/s2"))
        assert found.pgv == pytest.approx(0.25) and found.final_velocity == 0
        assert found.pgd == found.final_displacement == pytest.approx(1 / 6)

    def test_a_displacement_that_peaks_between_two_samples(self):
        found = measure(
            GroundMotion("descent", 1.0, np.array([1.0, -2.0]), unit="m/s2")
        )  # v = t - 1.5 t^2, zero at 2/3
        assert found.pgd == pytest.approx((2 / 3) ** 2 / 2 - (2 / 3) ** 3 / 2)
        assert abs(found.final_displacement) < 1e-15

    @pytest.mark.parametrize("samples", [101, 201, 401])
    def test_a_sine_pulse_to_second_order(self, samples):
        a, omega = 2.0, pi  # a full sine of 2 s
        t = np.linspace(0, 2, samples)
        found = measure(GroundMotion("sine", t[1], a * np.sin(omega * t), unit="m/s2"))
        error = (omega * t[1]) ** 2
        assert found.pgv == pytest.approx(2 * a / omega, rel=error)
        assert found.pgd == pytest.approx(2 * pi * a / omega**2, rel=error)
        assert found.arias == pytest.approx(pi / (2 * G) * a * a, rel=error)
        assert found.mean_period == pytest.approx(2, rel=error)


class TestAgainstPolynomials:
    @given(MOTIONS)
    def test_peaks_and_ends(self, a):
        """Every interval integrated as a polynomial, its extremes at the roots of the derivative."""
        dt = 0.5
        v = u = top_v = top_u = 0.0
        for start, end in itertools.pairwise(a):
            line = Polynomial([start, (end - start) / dt])
            parabola = line.integ(1, k=v)
            cubic = parabola.integ(1, k=u)
            for curve, slope, tops in ((parabola, line, "v"), (cubic, parabola, "u")):
                roots = slope.trim().roots() if slope.trim().degree() > 0 else np.zeros(0)
                inner = [root.real for root in roots if abs(root.imag) < 1e-12 and 0 < root.real < dt]
                top = max(abs(curve(t)) for t in (0.0, dt, *inner))
                top_v, top_u = (max(top_v, top), top_u) if tops == "v" else (top_v, max(top_u, top))
            v, u = parabola(dt), cubic(dt)
        found = measure(GroundMotion("any", dt, a, unit="m/s2"))
        near = {"rel": 1e-6, "abs": 1e-9}
        assert found.pgv == pytest.approx(top_v, **near) and found.pgd == pytest.approx(top_u, **near)
        assert found.final_velocity == pytest.approx(v, **near)
        assert found.final_displacement == pytest.approx(u, **near)


class TestAgainstQuadrature:
    @staticmethod
    def arias(motion, end):
        t = np.arange(motion.npts) * motion.dt
        inner = t[(t > 0) & (t < end)]
        edges = np.array([0.0, *inner, end])
        pieces = [
            quad(lambda x: np.interp(x, t, motion.acceleration) ** 2, a, b)[0] for a, b in itertools.pairwise(edges)
        ]
        return pi / (2 * G) * sum(pieces)

    def test_arias_intensity_and_the_times_of_5_and_95_percent(self):
        found = measure(NOISE)
        assert found.arias == pytest.approx(self.arias(NOISE, NOISE.duration), rel=1e-9)
        assert self.arias(NOISE, found.t_5) == pytest.approx(0.05 * found.arias, rel=1e-9)
        assert self.arias(NOISE, found.t_95) == pytest.approx(0.95 * found.arias, rel=1e-9)

    def test_the_mean_and_the_rms(self):
        t = np.arange(NOISE.npts) * NOISE.dt
        found = measure(NOISE)
        assert found.mean * G == pytest.approx(np.trapezoid(NOISE.acceleration, t) / t[-1])
        assert found.rms * G == pytest.approx((self.arias(NOISE, t[-1]) * 2 * G / pi / t[-1]) ** 0.5)

    def test_curves_end_where_the_measures_do(self):
        found = measure(NOISE)
        assert NOISE.velocity[-1] == found.final_velocity
        assert NOISE.displacement[-1] == found.final_displacement
        assert arias_build_up(NOISE)[-1] == found.arias
        assert NOISE.velocity[0] == NOISE.displacement[0] == arias_build_up(NOISE)[0] == 0


class TestScaling:
    @pytest.mark.parametrize("factor", [-1.0, 3.0, 1e-100, 1e120])
    def test_measures_follow_a_factor(self, factor):
        one, other = measure(NOISE), measure(NOISE.scaled(factor))
        for name in ("pga_g", "pgv", "pgd", "rms"):
            assert getattr(other, name) == pytest.approx(abs(factor) * getattr(one, name))
        assert other.mean == pytest.approx(factor * one.mean)
        assert other.arias == pytest.approx(factor * factor * one.arias)
        assert (other.t_5, other.t_95) == (pytest.approx(one.t_5), pytest.approx(one.t_95))

    def test_no_motion_has_no_duration(self):
        found = measure(GroundMotion("nothing", 0.01, np.zeros(10), unit="m/s2"))
        assert found.pga_g == found.pgv == found.pgd == found.arias == 0
        assert found.significant_duration is None and found.mean_period is None

    def test_beyond_the_range_of_numbers(self):
        with pytest.raises(InputError, match="beyond the range"):
            measure(NOISE.scaled(1e200))


class TestDoubts:
    def test_none_of_a_clean_motion(self):
        assert kinds(GroundMotion("clean", 0.01, clean(), unit="m/s2")) == []
        assert kinds(read_record(EXAMPLES / "accel.csv")) == []

    def test_an_offset_also_drifts(self):
        motion = GroundMotion("offset", 0.01, clean() + 0.02, unit="m/s2")
        assert kinds(motion)[0] == "offset" and "final_velocity" in kinds(motion)
        offset = doubts(motion, measure(motion))[0]
        assert offset.value == pytest.approx(0.02 / G, rel=1e-3) and "0.002 g" in offset.text

    def test_a_start_that_is_not_at_rest(self):
        motion = GroundMotion("cut", 0.01, clean()[400:], unit="m/s2")
        assert "start" in kinds(motion)
        start = next(d for d in doubts(motion, measure(motion)) if d.kind == "start")
        assert start.value * G == clean()[400]

    def test_a_velocity_that_drifts(self):
        motion = GroundMotion("drift", 0.01, clean() + np.where(np.arange(1001) > 500, 0.004, 0.0), unit="m/s2")
        drift = next(d for d in doubts(motion, measure(motion)) if d.kind == "final_velocity")
        assert drift.value == pytest.approx(0.02, rel=0.01) and "drifts" in drift.text and "0.02 m/s" in drift.text

    def test_a_displacement_that_stays(self):
        t = np.linspace(0, 10, 1001)
        step = np.where((t > 4) & (t < 6), 0.5 * np.sin(pi * (t - 4)), 0.0)  # there and not back: 0.318 m
        assert kinds(GroundMotion("fling", 0.01, clean() + step, unit="m/s2")) == ["final_displacement"]

    @pytest.mark.parametrize("share", [0.9, 0.6])
    def test_clipped_peaks(self, share):
        a = clean()
        limit = share * np.abs(a).max()
        motion = GroundMotion("clipped", 0.01, np.clip(a, -limit, limit), unit="m/s2")
        found = [d for d in doubts(motion, measure(motion)) if d.kind == "clipped"]
        assert len(found) == 2  # above and below
        longest = max(map(len, "".join("x" if x == limit else " " for x in motion.acceleration).split()))
        assert found[0].value == longest >= 3 and f"{longest} samples" in found[0].text

    def test_the_zeros_that_a_one_sided_pulse_never_goes_below_are_not_clipping(self):
        pulse = np.concatenate([np.zeros(50), np.sin(np.linspace(0, pi, 100)), np.zeros(50)])
        assert "clipped" not in kinds(GroundMotion("one-sided", 0.01, pulse, unit="m/s2"))

    def test_a_few_equal_samples_elsewhere_are_not_clipping(self):
        a = clean()
        a[300:320] = a[300]
        assert "clipped" not in kinds(GroundMotion("flat", 0.01, a, unit="m/s2"))

    def test_a_coarse_interval(self):
        assert kinds(GroundMotion("seconds?", 1.0, clean(), unit="m/s2"))[0] == "dt"

    def test_fewer_than_five_samples_to_a_mean_period(self):
        t = np.arange(2000) * 0.02
        for period, doubted in ((0.2, False), (0.08, True)):
            motion = GroundMotion("sine", 0.02, np.sin(pi * t / 40) ** 2 * np.sin(2 * pi * t / period), unit="m/s2")
            assert ("mean_period" in kinds(motion)) is doubted

    @pytest.mark.parametrize("pga", [0.001, 5.0])
    def test_an_odd_pga(self, pga):
        motion = GroundMotion("odd", 0.01, clean() / np.abs(clean()).max() * pga * G, source_unit="gal", format="text")
        (found,) = doubts(motion, measure(motion))
        assert found.kind == "pga" and found.value == pytest.approx(pga) and "really gal" in found.text

    def test_an_interval_too_coarse_for_a_structure(self):
        motion = GroundMotion("clean", 0.02, clean(), unit="m/s2")
        assert coarse_for(motion, 4.9) == []
        (found,) = coarse_for(motion, 10.0)
        assert found.kind == "p_dt" and found.value == pytest.approx(0.2) and "p dt = 0.2" in found.text

    @NEEDS_RECORDS
    def test_corrected_records_of_strong_motion_raise_none(self):
        for name in ("Rinaldi228", "Rinaldi318", "RinaldiUP", "RSN6_IMPVALL.I_I-ELC180", "RSN77_SFERN_PUL164"):
            assert kinds(read_record(RECORDS / f"{name}.AT2")) == []

    @NEEDS_RECORDS
    @pytest.mark.parametrize("channel", [1, 2, 3])
    def test_peaks_that_a_data_centre_found(self, channel):
        """CSMIP prints the peaks of its own integration in the header; its velocity does not start from zero."""
        file = RECORDS / "formats" / "ce36456p_CE36456.V2"
        text = file.read_text(encoding="latin-1")
        speeds = re.findall(r"PEAK +VELOCITY += +(\S+) +CM/SEC", text)
        lengths = re.findall(r"PEAK +DISPLACEMENT += +(\S+) +CM", text)
        found = measure(read_record(file, channel=str(channel)))
        assert 100 * found.pgv == pytest.approx(abs(float(speeds[channel - 1])), rel=0.03)
        assert 100 * found.pgd == pytest.approx(abs(float(lengths[channel - 1])), rel=0.15)

"""The response of a linear oscillator, against closed forms and integrations of others."""

from math import cos, exp, pi, sin, sqrt

import numpy as np
import pytest
from scipy import signal

from rocking_cli.errors import InputError
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.processing.oscillator import _turning_point, relative_response, response_spectrum


@pytest.fixture(scope="module")
def rough() -> GroundMotion:
    samples = np.random.default_rng(0).normal(size=2000).cumsum()
    return GroundMotion("rough", 0.01, np.concatenate([[0.0], samples - samples.mean(), [0.0]]), unit="m/s2")


@pytest.mark.parametrize("damping", [0.0, 0.05, 0.6])
@pytest.mark.parametrize("period", [0.02, 0.3, 8.0])
def test_it_is_exact_for_straight_lines(rough: GroundMotion, period: float, damping: float) -> None:
    x, v, parts = relative_response(rough, period, damping)
    w = 2 * pi / period
    system = ([[0.0, 1.0], [-w * w, -2 * damping * w]], [[0.0], [-1.0]], np.eye(2), np.zeros((2, 1)))
    time = np.arange(x.size) * rough.dt / parts
    _, other, _ = signal.lsim(system, np.interp(time, rough.time, rough.acceleration), time)
    for found, wanted in ((x, other[:, 0]), (v, other[:, 1])):
        assert np.abs(found - wanted).max() < 1e-9 * np.abs(wanted).max()


def test_a_step_of_the_ground() -> None:
    """A constant acceleration a from rest: x = -(a/w^2) (1 - e^(-xi w t) (cos w_d t + xi w/w_d sin w_d t))."""
    period, xi, a = 0.8, 0.1, 2.0
    w = 2 * pi / period
    w_d = w * sqrt(1 - xi**2)
    motion = GroundMotion("step", 0.013, np.full(200, a), unit="m/s2")
    x, _, parts = relative_response(motion, period, xi)
    t = np.arange(x.size) * motion.dt / parts
    decay = np.exp(-xi * w * t)
    assert x == pytest.approx(-a / w**2 * (1 - decay * (np.cos(w_d * t) + xi * w / w_d * np.sin(w_d * t))), abs=1e-14)
    peak = a / w**2 * (1 + exp(-pi * xi / sqrt(1 - xi**2)))  # between two samples
    assert response_spectrum(motion, [period], xi).sd[0] == pytest.approx(peak, rel=1e-5)


def test_what_comes_after_the_motion_counts() -> None:
    """A short pulse of impulse J leaves an undamped oscillator swinging by J/w."""
    motion = GroundMotion("knock", 1e-4, np.array([0.0, 3.0, 0.0]), unit="m/s2")
    assert response_spectrum(motion, [2.0], 0.0).sd[0] == pytest.approx(3e-4 * 2.0 / (2 * pi), rel=1e-6)
    for xi in (0.02, 0.3):  # the peak of e^(-xi w t) sin(w_d t)/w_d
        w, d = pi, pi * sqrt(1 - xi**2)
        t = np.arctan2(d, xi * w) / d
        wanted = 3e-4 * exp(-xi * w * t) * sin(d * t) / d
        assert response_spectrum(motion, [2.0], xi).sd[0] == pytest.approx(wanted, rel=1e-3)


def test_resonance_builds_up_as_it_must() -> None:
    """Undamped, under sin(w t): x = (sin w t - w t cos w t)/(2 w^2), times -1."""
    period, dt = 1.0, 0.002
    t = np.arange(0, 5.0 + dt / 2, dt)
    motion = GroundMotion("sine", dt, np.sin(2 * pi * t), unit="m/s2")
    w = 2 * pi / period
    x, _, _ = relative_response(motion, period, 0.0)
    assert x == pytest.approx(-(np.sin(w * t) - w * t * np.cos(w * t)) / (2 * w**2), abs=2e-5 * np.abs(x).max())
    assert cos(w * t[-1]) == pytest.approx(1.0)


def test_the_ends_of_a_spectrum(rough: GroundMotion) -> None:
    stiff = response_spectrum(rough, [2e-4])
    assert stiff.sa[0] == pytest.approx(rough.pga_g, rel=1e-2)
    soft = response_spectrum(rough, [1e4], 0.0)  # the mass stays where it is
    assert soft.sd[0] == pytest.approx(np.abs(rough.displacement).max(), rel=1e-3)


def test_peaks_between_samples_are_seen() -> None:
    coarse = GroundMotion("coarse", 0.05, np.array([0.0, 1.0, -1.5, 2.0, -0.3, 0.0]), unit="m/s2")
    parts = 400
    t = np.arange(5 * parts + 1) / parts
    fine = GroundMotion("fine", 0.05 / parts, np.interp(t, np.arange(6), coarse.acceleration), unit="m/s2")
    for period in (0.06, 0.11, 0.4):
        x, _, _ = relative_response(fine, period, 0.05)
        assert response_spectrum(coarse, [period], 0.05).sd[0] == pytest.approx(np.abs(x).max(), rel=3e-5)


@pytest.mark.parametrize(
    ("b", "c", "s", "peak"),
    [(-1.5, 0.0, 1 / 3, 1 / 6), (0.0, -1.0, 3**-0.5, 2 / 3 * 3**-0.5), (0.5, -1.0, (1 + 13**0.5) / 6, None)],
)
@pytest.mark.parametrize("sign", [1, -1])
def test_the_turning_point_between_samples_is_that_of_the_cubic(b, c, s, peak, sign) -> None:
    """x = s + b s^2 + c s^3 turns where 1 + 2 b s + 3 c s^2 = 0; values and slopes at 0 and 1 say which cubic it is."""
    ends = (np.array([sign * each]) for each in (0.0, 1 + b + c, 1.0, 1 + 2 * b + 3 * c))
    wanted = s + b * s**2 + c * s**3
    assert peak is None or wanted == pytest.approx(peak)
    assert _turning_point(*ends) == pytest.approx([sign * wanted], rel=1e-12)


def test_pseudo_acceleration_and_velocity_are_those_of_the_displacement(rough: GroundMotion) -> None:
    found = response_spectrum(rough, [0.5, 2.0])
    w = 2 * pi / found.periods
    assert found.sv == pytest.approx(w * found.sd)
    assert found.sa * STANDARD_GRAVITY == pytest.approx(w**2 * found.sd)


@pytest.mark.parametrize(("period", "damping"), [(0.0, 0.05), (-1.0, 0.05), (1.0, 1.0), (1.0, -0.1), (np.nan, 0.05)])
def test_what_is_no_oscillator_is_refused(rough: GroundMotion, period: float, damping: float) -> None:
    with pytest.raises(InputError):
        response_spectrum(rough, [period], damping)

"""Histories under sampled pulses against the pulses themselves: DOP853 on the formula, and the exact linear answers."""

from dataclasses import dataclass, replace
from math import atan, cos, hypot, pi, sin, sqrt, tan

import numpy as np
import pytest
from pytest import approx
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from mechanisms.block import Block
from rocking_cli.core import equivalent_block
from rocking_cli.dynamics.exact import exact_response
from rocking_cli.dynamics.history import follow
from rocking_cli.excitation.pulses import COARSE_POINTS_PER_PERIOD, POINTS_PER_PERIOD, Pulse, parse_pulse
from rocking_cli.questions.pulse.on_structure import sampled_history
from rocking_cli.structure import Structure
from rocking_cli.studies.under_pulses import parse_shape
from tests.following import build_model

BLOCK = Block(width=0.9, height=3.4, gravity=9.81)
ALPHA, R = atan(0.9 / 3.4), hypot(0.9, 3.4) / 2
P = sqrt(3 * 9.81 / (4 * R))
ETA = 1 - 1.5 * sin(ALPHA) ** 2
SHAPES = ("sine", "cosine", "half_sine", "ricker", "ricker_antisymmetric", "mavroeidis:30:2.5")


def pulse_of(shape: str, times_uplift: float, omega: float) -> Pulse:
    return replace(parse_shape(shape), amplitude=times_uplift * 9.81 * tan(ALPHA), period=2 * pi / (omega * P))


def peak_by_formula(pulse: Pulse) -> float:
    """Peak phi/alpha of the block by Housner's equation under the formula of the pulse; inf if it overturns."""

    def u(t):
        return float(pulse.acceleration(np.array(t)))

    def beyond(t, s):
        return -s * u(t) - 9.81 * tan(ALPHA)

    grid = np.linspace(0, pulse.duration, 4001)
    ground = pulse.acceleration(grid)
    t, y, s, peak, end = 0.0, None, 1, 0.0, pulse.duration
    while True:
        if y is None:  # at rest: on to where the ground lifts it
            lifting = []
            for sign in (1, -1):
                for b in grid[(grid > t) & (-sign * ground > 9.81 * tan(ALPHA))][:1]:
                    a = max(b - grid[1], t)
                    at = a if beyond(a, sign) >= 0 else brentq(beyond, a, b, args=(sign,), xtol=1e-15)
                    lifting.append((at, sign))
            if not lifting:
                return peak
            t, s = min(lifting)
            y = [0.0, 0.0]

        def slopes(x, z, s=s, shaken=t < end):
            push = s * u(min(x, end)) / 9.81 if shaken else 0.0
            return [z[1], -(P**2) * (sin(ALPHA - z[0]) + push * cos(ALPHA - z[0]))]

        def lands(x, z):
            return z[0] if z[1] < 0 else 1.0

        def turns(x, z):
            return z[1]

        def falls(x, z):
            return z[0] - 1.5

        lands.terminal = falls.terminal = True
        turns.direction = -1
        stop = end if t < end else t + 60 / P
        found = solve_ivp(
            slopes,
            (t, stop),
            y,
            "DOP853",
            rtol=1e-12,
            atol=1e-16,
            events=(lands, turns, falls),
            max_step=(stop - t) / 50,
        )
        peak = max([peak, *(z[0] / ALPHA for z in found.y_events[1]), found.y[0, -1] / ALPHA])
        if found.t_events[2].size:
            return float("inf")
        t, y = float(found.t[-1]), found.y[:, -1].tolist()
        if found.t_events[0].size:
            rate = -ETA * y[1]
            y, s = [0.0, rate], -s
            if rate < 1e-7 * P * ALPHA and all(beyond(t, sign) < 0 for sign in (1, -1)):
                y = None
                if t >= end:
                    return peak


@pytest.mark.every(6)
@pytest.mark.parametrize("omega", [3.0, 8.0])
@pytest.mark.parametrize("shape", SHAPES)
def test_the_peak_of_a_history_is_that_under_the_formula(shape, omega):
    model = build_model(BLOCK, "nonlinear")
    for times in (1.01, 1.05, 2.0):
        pulse = pulse_of(shape, times, omega)
        history = follow(model, pulse.sampled())
        wanted = peak_by_formula(pulse)
        assert history.overturned == (wanted == float("inf")), times
        if not history.overturned:
            assert history.peak_ratio == approx(wanted, rel=1e-6), times


@pytest.mark.parametrize(("shape", "polarity"), [("sine", -1), ("cosine", 1), ("half_sine", -1), ("rectangular", 1)])
def test_linear_histories_are_the_exact_answers(shape, polarity):
    model, equivalence = build_model(BLOCK, "linear2"), equivalent_block(BLOCK)
    rocked = 0
    for times in (1.01, 1.05, 1.4, 3.0):
        for omega in (1.5, 9.0):
            pulse = pulse_of(shape, times, omega)
            exact = exact_response(equivalence, pulse, kappa=2, gravity=9.81, polarity=polarity)
            history = follow(model, pulse.sampled().scaled(polarity))
            assert history.overturned == exact.overturned
            if not exact.overturned:
                assert history.peak_ratio == approx(exact.peak_ratio, rel=1e-6), (times, omega)
                rocked += 1
    assert rocked > 3


@pytest.mark.parametrize(
    ("structure", "pulse", "peak"),
    [
        (BLOCK, "sine:2.7265m/s2:1.536s", 0.0032702463),
        (None, "cosine:5.168m/s2:0.839s", 0.0592159800),
    ],
)
def test_peaks_that_came_out_wrong_near_uplift(structure, pulse, peak):
    from mechanisms.wall import Wall

    model = build_model(structure or Wall(thickness=0.45, height=4.1, gravity=9.81), "nonlinear")
    assert follow(model, parse_pulse(pulse).sampled()).peak_ratio == approx(peak, rel=1e-6)


@pytest.mark.parametrize("shape", SHAPES)
def test_even_coarse_samples_have_the_impulse_of_the_pulse(shape):
    pulse = replace(parse_shape(shape), amplitude=3.0, period=0.8)
    for count in (COARSE_POINTS_PER_PERIOD, POINTS_PER_PERIOD):
        motion = pulse.sampled(count)
        a = motion.acceleration
        gained = np.append(0.0, np.cumsum((a[1:] + a[:-1]) / 2) * motion.dt)
        wanted = pulse.velocity(motion.dt * np.arange(motion.npts))
        assert np.abs(gained - wanted).max() < 2e-7 * (COARSE_POINTS_PER_PERIOD / count) ** 3 * np.abs(wanted).max()
        chords = pulse.acceleration(motion.dt * np.arange(motion.npts))
        lost = np.append(0.0, np.cumsum((chords[1:] + chords[:-1]) / 2) * motion.dt) - wanted
        assert np.abs(lost).max() > 10 * np.abs(gained - wanted).max()


@dataclass(frozen=True)
class Steps(Pulse):
    """Up, down and up again at once, with straight lines between."""

    name, title, span = "steps", "corners and jumps", 1.0

    def shape(self, x):
        return np.where(x < 0.3, x / 0.3, np.where(x < 0.62, -1.0, 0.5))


def test_corners_and_jumps_keep_their_chords():
    pulse = Steps(3.0, 0.8)
    motion = pulse.sampled()
    at_samples = pulse.acceleration(motion.dt * np.arange(motion.npts))
    np.testing.assert_allclose(motion.acceleration, at_samples, rtol=0, atol=1e-12)


def test_a_history_keeps_one_of_so_many_samples():
    model, pulse = build_model(BLOCK, "nonlinear"), pulse_of("ricker", 2.0, 8.0)
    motion = pulse.sampled()
    assert (motion.every, motion.kept.npts - 1) == (
        POINTS_PER_PERIOD // COARSE_POINTS_PER_PERIOD,
        round(2.6 * COARSE_POINTS_PER_PERIOD),
    )
    thin, whole = (follow(model, each, tail=3.0) for each in (motion, replace(motion, every=1)))
    assert thin.peak_ratio == whole.peak_ratio and thin.impact_count == whole.impact_count
    both = min(thin.time.size, -(-whole.time.size // motion.every))
    assert both > 2.6 * COARSE_POINTS_PER_PERIOD and np.abs(thin.phi).max() > 0.01
    for one, other in ((thin.time, whole.time), (thin.phi, whole.phi), (thin.rate, whole.rate)):
        np.testing.assert_allclose(one[:both], other[:: motion.every][:both], rtol=0, atol=1e-10)
    assert (motion.kept.acceleration == motion.acceleration[:: motion.every]).all()


@pytest.mark.rest
def test_samples_are_refined_until_nothing_changes():
    for shape in SHAPES:
        pulse = pulse_of(shape, 1.04, 5.0)
        found = sampled_history(Structure(BLOCK), "nonlinear", pulse)
        assert found.converged
        assert found.history.peak_ratio == approx(peak_by_formula(pulse), rel=1e-6)

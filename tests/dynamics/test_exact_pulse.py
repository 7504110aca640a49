"""The exact response to pulses: against 50 digits, the histories, and the conditions that can be derived by hand.

The reference below knows only phi.. = p^2 (phi - phi_cr - s kappa u_g''/g), in seconds and radians, and eta. Between
impacts phi is the sum of a sine, e^pt and e^-pt. It walks in small steps and looks for changes of sign.
"""

from dataclasses import replace
from itertools import pairwise, product
from math import exp, isnan, log, pi

import mpmath
import numpy as np
import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st
from pytest import approx

from mechanisms.block import Block
from rocking_cli import load_structure
from rocking_cli.core import Equivalence, equivalent_block
from rocking_cli.dynamics.exact import SHAPE_CYCLES, closed_form, exact_response
from rocking_cli.dynamics.exact_batch import exact_many
from rocking_cli.errors import InputError, SolverError
from rocking_cli.excitation.pulses import Pulse, PulseShapes, Segment
from tests.conftest import EXAMPLES
from tests.following import respond
from tests.pulses import exact_pulse

MP = mpmath.mp.clone()
MP.dps = 50
FRAME = load_structure(EXAMPLES / "frame.yaml")
BLOCK = Block(width=0.7, height=2.8)
G = BLOCK.gravity


def lopsided(p=1.6, phi_cr=0.5, kappa=0.7, eta=0.8):
    """An equivalence whose negative direction has these times the p, phi_cr and kappa2 of the positive, and eta."""
    one = equivalent_block(replaced(BLOCK, restitution=0.9)).positive
    other = replace(
        one, p=p * one.p, phi_cr=phi_cr * one.phi_cr, lambda_=one.lambda_ * phi_cr / kappa, kappa2=kappa, eta=eta
    )
    return Equivalence(one, other)


def known(value):
    """A number of an outcome; None where there is none."""
    return None if isnan(value) else value


def replaced(block, **changes):
    return type(block)(**{**block.model_dump(exclude={"mechanism"}, exclude_none=True), **changes})


class Zigzag(Pulse):
    """Pieces of sines and constants that do not even meet."""

    name = "zigzag"
    title = "for the tests"
    span = 1.0

    def shape(self, x):
        raise NotImplementedError

    def segments(self):
        a, T = self.amplitude, self.period
        return (
            Segment(0.0, 0.3 * T, a, 5 / T, 0.4),
            Segment(0.3 * T, 0.4 * T, -0.9 * a, 0.0, 1.2),
            Segment(0.4 * T, 0.9 * T, 0.8 * a, 17 / T, -2.0),
            Segment(0.9 * T, T, 0.5 * a, 0.0, pi / 2),
        )


class Longer(Pulse):
    """A cosine of one and a half cycles."""

    name = "longer"
    title = "for the tests"
    span = 1.5

    def shape(self, x):
        raise NotImplementedError

    def segments(self):
        return (Segment(0.0, 1.5 * self.period, self.amplitude, 2 * pi / self.period, pi / 2),)


SHAPE = {**{name: PulseShapes()[name] for name in SHAPE_CYCLES}, "zigzag": Zigzag}


def near(value, **tolerance):
    return None if value is None else approx(float(value), **tolerance)


# The reference


class Reference:
    """What happens under a pulse, in 50 digits; `peaks` are phi/phi_cr in both directions, `rates` |phi.| [rad/s]."""

    def __init__(self, equivalence, pulse, polarity):
        self.blocks = {1: equivalence.positive, -1: equivalence.negative}
        self.pieces = [
            (*(MP.mpf(each) for each in piece[:2]), polarity * MP.mpf(piece.amplitude), *(MP.mpf(x) for x in piece[3:]))
            for piece in pulse.segments()
        ]
        self.pieces.append((self.pieces[-1][1], MP.mpf(1e3), MP.zero, MP.zero, MP.zero))
        self.pulse_end = self.pieces[-1][0]
        self.peaks, self.rates = {1: MP.zero, -1: MP.zero}, {1: MP.zero, -1: MP.zero}
        self.excursions, self.impacts, self.uplift = [], [], None
        self.overturned, self.fell_to = False, 0
        self.margin = MP.mpf(1)
        self.follow()

    def ground(self, t, side):
        """-s u_g'' over that of uplift."""
        for start, stop, a, w, phase in self.pieces:
            if start <= t < stop:
                block = self.blocks[side]
                return -side * a * MP.sin(w * (t - start) + phase) / (MP.mpf(G) * MP.mpf(block.lambda_))
        return MP.zero

    def lift(self, t):
        step = self.pulse_end / 2000
        while t < self.pulse_end:
            for side in (1, -1):
                if self.ground(t, side) > 1 + MP.mpf(10) ** -40:
                    return t, side
            for side in (1, -1):
                if t + step < self.pulse_end and self.ground(t + step, side) > 1:
                    low, high = t, t + step
                    for _ in range(150):
                        middle = (low + high) / 2
                        low, high = (low, middle) if self.ground(middle, side) > 1 else (middle, high)
                    return high, side
            t += step
        return None

    def follow(self):
        t, v, side, resting = MP.zero, MP.zero, 1, True
        while len(self.impacts) < 400:
            if resting:
                lifted = self.lift(t)
                if lifted is None:
                    return
                t, side = lifted
                v, resting = MP.zero, False
                self.uplift = t if self.uplift is None else self.uplift
            t, v, peak = self.fly(t, v, side)
            if t is None:
                self.overturned, self.fell_to = True, side
                return
            self.peaks[side] = max(self.peaks[side], peak)
            self.excursions.append(peak)
            self.impacts.append((t, side, -v))
            block = self.blocks[side]
            v, side = -MP.mpf(block.eta) * v, -side
            other = self.blocks[side]
            resting = v < 1e-10 * other.p * other.phi_cr
            if t > self.pulse_end and v < 1e-2 * other.p * other.phi_cr:
                return

    def fly(self, t, v, side):
        block = self.blocks[side]
        p, phi_cr, kappa = MP.mpf(block.p), MP.mpf(block.phi_cr), MP.mpf(block.phi_cr) / MP.mpf(block.lambda_)
        phi, peak = MP.zero, MP.zero
        for start, stop, a, w, phase in self.pieces:
            if stop <= t:
                continue
            angle = w * (t - start) + phase
            D = p**2 * side * kappa * a / MP.mpf(G) / (p**2 + w**2)
            rest, rate = phi - phi_cr - D * MP.sin(angle), (v - D * w * MP.cos(angle)) / p
            P, Q = (rest + rate) / 2, (rest - rate) / 2
            if a == 0:  # after the pulse
                self.margin = min(self.margin, abs(P) / phi_cr)
                if P >= 0:
                    return None, None, None
                T = MP.log((phi_cr + MP.sqrt(phi_cr**2 - 4 * P * Q)) / (-2 * P)) / p
                if v > 0:
                    peak = max(peak, 1 - 2 * MP.sqrt(P * Q) / phi_cr)
                hit = p * (P * MP.exp(p * T) - Q * MP.exp(-p * T))
                self.rates[side] = max(self.rates[side], abs(v), abs(hit))
                return t + T, hit, peak

            def x(s, angle=angle, D=D, P=P, Q=Q, w=w):
                e = MP.exp(p * s)
                return phi_cr + D * MP.sin(angle + w * s) + P * e + Q / e

            def dx(s, angle=angle, D=D, P=P, Q=Q, w=w):
                e = MP.exp(p * s)
                return D * w * MP.cos(angle + w * s) + p * (P * e - Q / e)

            def ddx(s, angle=angle, D=D, P=P, Q=Q, w=w):
                e = MP.exp(p * s)
                return p * p * (P * e + Q / e) - D * w * w * MP.sin(angle + w * s)

            def gather(low, high):
                turns = [bisect(ddx, low, high)] if ddx(low) * ddx(high) < 0 else []
                self.rates[side] = max(self.rates[side], *(abs(dx(s)) for s in (low, *turns, high)))

            whole = stop - t
            n = 60 + int(40 * whole * (p + w))
            low, low_v = MP.zero, v
            for high in [whole * k / n for k in range(1, n + 1)]:
                high_x, high_v = x(high), dx(high)
                if low == 0 and phi == 0 and high_x <= 0:  # a hop within one step
                    low = high / 2
                    while x(low) <= 0:
                        low /= 2
                    low_v = dx(low)
                    peak = max(peak, x(bisect(dx, low / 1000, high)) / phi_cr)
                if high_x <= 0:
                    hit = bisect(x, low, high)
                    gather(low, hit)
                    return t + hit, dx(hit), peak
                gather(low, high)
                if low_v > 0 >= high_v:
                    peak = max(peak, x(bisect(dx, low, high)) / phi_cr)
                peak = max(peak, high_x / phi_cr)
                low, low_v = high, high_v
                if high_x > 1e6 * phi_cr:
                    return None, None, None
            t, phi, v = stop, x(whole), dx(whole)
        raise AssertionError


def bisect(f, low, high):
    """Where f falls through zero (Illinois)."""
    f_low, f_high = f(low), f(high)
    for _ in range(100):
        middle = high - f_high * (high - low) / (f_high - f_low)
        value = f(middle)
        if value == 0 or high - low < MP.mpf(10) ** -45:
            return middle
        if (value > 0) == (f_low > 0):
            low, f_low, f_high = middle, value, f_high / 2
        else:
            high, f_high, f_low = middle, value, f_low / 2
    return middle


def points():
    rng = np.random.default_rng(514)
    found = []
    for shape in SHAPE:
        for k in range(12):  # a third of them weak and slow, with many impacts
            a, w = (7, 0.6) if k % 3 else (1.3, 0.4)
            a, w = exp(rng.uniform(log(1.02), log(a))), exp(rng.uniform(log(w), log(w) + 2.6))
            found.append((shape, a, w, int(rng.choice([1, -1])), lopsided() if rng.integers(2) else None))
    return found


SINES = [
    (1.011186, 0.15, 0.05), (1.0111868, 0.15, 0.1), (1.0111865, 0.15, 0.08),  # it rests, and overturns later
    (1.679, 2.048, 0.642), (1.529, 1.241, 0.828), (1.088, 0.589, 0.859), (1.069, 0.594, 0.926),  # after impacts
    (1.33, 1.9, 1e-4), (1.4, 1.9, 3e-5),  # lifted with a faint rate
    # An impact soon after another, and just before the next lift; of the first it decides about overturning.
    (1.0931, 0.4526, 0.001), (1.2999, 1.9, 0.003), (1.319, 3.27, 0.0036), (1.1588, 0.655, 0.0011), (1.229, 1.0, 0.002),
    (1.0541258547174834, 1.6044540341208628, 0.8781819258892375),
    (1.1145369772101248, 1.1617213402089153, 0.6065501695307708),
    (1.1537171372718127, 2.37711819342948, 0.4455922506664635),
    (1.003, 1.0, 0.5), (1.003, 1.5, 0.7), (1.002, 5.0, 0.9),  # the smallest first excursions
]  # fmt: skip
"""Amplitude, frequency and eta of sines to the left that are hard to follow."""


def hard():
    for a, w, eta in SINES:
        one = equivalent_block(replaced(BLOCK, restitution=eta)).positive
        yield "sine", a, w, -1, Equivalence(one, one)


@pytest.mark.every(9)
@pytest.mark.parametrize(("shape", "a", "w", "polarity", "equivalence"), [*points(), *hard()])
def test_exact_answer_agrees_with_50_digits(shape, a, w, polarity, equivalence):
    equivalence = equivalence or equivalent_block(BLOCK)
    one = equivalence.positive
    pulse = SHAPE[shape](a * one.lambda_ * G, 2 * pi / (w * one.p))
    wanted = Reference(equivalence, pulse, polarity)
    got = exact_response(equivalence, pulse, kappa=2, gravity=G, polarity=polarity)
    assert wanted.margin > 1e-7  # no point is on a boundary
    assert got.overturned == wanted.overturned
    assert got.fell_to == wanted.fell_to
    assert known(got.uplift_time) == near(wanted.uplift, abs=1e-12)
    if wanted.overturned:
        assert got.impact_count == len(wanted.impacts)
    else:
        assert got.peak_ratio == approx(float(max(wanted.peaks.values())), abs=1e-10)
        assert got.peak_positive / one.phi_cr == approx(float(wanted.peaks[1]), abs=1e-10)
        assert got.peak_negative / equivalence.negative.phi_cr == approx(float(wanted.peaks[-1]), abs=1e-10)
        rates = float(wanted.rates[1]), float(wanted.rates[-1])
        assert (got.peak_rate_positive, got.peak_rate_negative) == approx(rates, rel=1e-9, abs=1e-10)
    assert known(got.first_excursion) == near(next(iter(wanted.excursions), None), abs=1e-10)
    assert known(got.first_excursion) == near(next(iter(wanted.excursions), None), rel=1e-6)
    for found, peak in zip((got.first_excursion, got.first_rebound), wanted.excursions, strict=False):
        assert found == near(peak, abs=1e-9)
    assert len(got.impacts) >= len(wanted.impacts)
    for (t, side, rate), (time, ended, before) in zip(got.impacts, wanted.impacts, strict=False):
        assert side == ended
        assert t == approx(float(time), abs=1e-9)
        assert rate == approx(float(before), abs=1e-9)


def test_a_peak_between_two_turning_points_close_to_each_other_is_seen():
    """x' has one sign at both ends of a quarter cycle here, and the other in between."""
    one = equivalent_block(replaced(BLOCK, restitution=0.8333147)).positive
    equivalence, a, w = Equivalence(one, one), 2.2388361497902536, 3.0459332686900837
    pulse = Longer(a * one.lambda_ * G, 2 * pi / (w * one.p))
    got = exact_response(equivalence, pulse, kappa=2, gravity=G, polarity=-1)
    assert got.peak_ratio == approx(0.9633, abs=1e-3)
    assert got.peak_ratio == approx(float(max(Reference(equivalence, pulse, -1).peaks.values())), abs=1e-10)


def test_the_points_hold_every_kind_of_end():
    ends = set()
    for shape, a, w, polarity, equivalence in points():
        asymmetric, equivalence = equivalence is not None, equivalence or equivalent_block(BLOCK)
        pulse = SHAPE[shape](a * equivalence.positive.lambda_ * G, 2 * pi / (w * equivalence.positive.p))
        got = exact_response(equivalence, pulse, kappa=2, gravity=G, polarity=polarity)
        during = sum(t < pulse.duration for t, _, _ in got.impacts)
        ends |= {(asymmetric, "overturns", min(got.impact_count, 2))} if got.overturned else set()
        ends |= {(asymmetric, "rocks", min(during, 3))} if not got.overturned and got.impacts else set()
    for asymmetric in (False, True):
        assert {what[1:] for what in ends if what[0] == asymmetric} >= {
            ("overturns", 0),
            ("overturns", 1),
            ("rocks", 0),
            ("rocks", 1),
            ("rocks", 2),
        }


# The engine of the histories


@pytest.mark.parametrize("polarity", [1, -1])
@pytest.mark.parametrize(("kappa", "name"), [(1, "linear1"), (2, "linear2")])
@pytest.mark.parametrize("shape", SHAPE_CYCLES)
def test_histories_tend_to_it(shape, kappa, name, polarity):
    pulse = SHAPE[shape](0.45 * G if shape != "rectangular" else 0.3 * G, 0.5)
    got = exact_response(equivalent_block(FRAME), pulse, kappa=kappa, gravity=FRAME.gravity, polarity=polarity)
    assert not got.overturned
    assert len(got.impacts) > 10
    values = []
    for n in (100, 16_000):
        history = respond(FRAME, pulse.sampled(n).scaled(polarity), models=(name,), tail=0.0)[name]
        values.append(
            np.array([history.peak_positive, history.peak_negative, history.uplift_time, *history.impacts[:4, 0]])
        )
    coarse, wanted = values
    assert np.abs(coarse - wanted).max() > 1e-9 or shape == "rectangular"
    found = [got.peak_positive, got.peak_negative, got.uplift_time, *(t for t, _, _ in got.impacts[:4])]
    assert found[:2] == approx(wanted[:2], abs=1e-10)
    assert found[2:] == approx(wanted[2:], abs=1e-9)


# What can be derived by hand


def overturns(shape, a, w, eta=0.9):
    """Impacts before overturning, None if it does not."""
    return exact_pulse(a, w, eta, shape).impacts_before_overturning


@pytest.mark.parametrize("a", [1.0001, 1.3, 2.0, 5.0, 40.0])
def test_a_constant_push_overturns_from_a_known_duration_on(a):
    """x = (a - 1)(cosh tau - 1): at the boundary x - 1 + x' = (a - 1) e^tau - a is zero."""
    duration = log(a / (a - 1))
    assert overturns("rectangular", a, 2 * pi / (duration * (1 + 1e-11))) == 0
    assert overturns("rectangular", a, 2 * pi / (duration * (1 - 1e-11))) is None
    assert exact_pulse(a, 2 * pi / (duration * (1 - 1e-11)), 0.9, "rectangular").max_ratio == approx(1, abs=1e-4)


def boundary(condition, low, high):
    """Where a condition on a number changes, in 40 digits."""
    with mpmath.workdps(40):
        low, high = mpmath.mpf(low), mpmath.mpf(high)
        at_low = condition(low)
        assert at_low != condition(high)
        for _ in range(120):
            middle = (low + high) / 2
            low, high = (middle, high) if condition(middle) == at_low else (low, middle)
        return float(low)


def test_the_outgoing_part_at_the_end_of_a_half_sine():
    """y = x - 1 + x' obeys y' = y + a sin(.): it ends >= 0 if a int e^-tau sin(.) d tau >= 1, from lift to end."""
    a, w, tau = sympy.symbols("a omega tau", positive=True)
    phase, root = sympy.asin(1 / a), sympy.sqrt(a**2 - 1)
    end = (sympy.pi - phase) / w
    whole = a * sympy.integrate(sympy.exp(-tau) * sympy.sin(w * tau + phase), (tau, 0, end)) - 1
    by_hand = w * (root + a * sympy.exp(-end) - w) / (1 + w**2)
    for numbers in ({a: 1.3, w: 0.7}, {a: 3, w: 4.2}, {a: 9, w: 2.5}):
        difference = (whole - by_hand).subs(numbers)
        assert abs(sympy.N(difference, 30)) < 1e-13


@pytest.mark.parametrize("a", [1.05, 1.5, 3.0, 8.0])
def test_a_half_sine_overturns_up_to_a_known_frequency(a):
    """omega <= sqrt(a^2 - 1) + a e^-te, te from lift to end, by the integral above: Housner's condition."""

    def holds(w):
        a_ = mpmath.mpf(a)
        return w <= mpmath.sqrt(a_**2 - 1) + a_ * mpmath.exp(-(mpmath.pi - mpmath.asin(1 / a_)) / w)

    limit = boundary(holds, 0.05, 30)
    assert overturns("half_sine", a, limit * (1 - 1e-11)) == 0
    assert overturns("half_sine", a, limit * (1 + 1e-11)) is None


@pytest.mark.parametrize("a", [1.5, 3.0, 6.0, 12.0])
def test_a_full_sine_overturns_without_impact_up_to_a_known_frequency(a):
    """Zhang and Makris's second mode: (s - omega) e^te >= a."""

    def holds(w):
        a_ = mpmath.mpf(a)
        end = (2 * mpmath.pi - mpmath.asin(1 / a_)) / w
        return (mpmath.sqrt(a_**2 - 1) - w) * mpmath.exp(end) >= a_

    limit = boundary(holds, 0.2, a)
    assert overturns("sine", a, limit * (1 - 1e-11)) == 0
    assert overturns("sine", a, limit * (1 + 1e-11)) != 0


def one_impact(a, w, eta):
    """eta^2 (1 - D0) >= 1 by Eq. 42, in 40 digits."""
    a, w, eta = mpmath.mpf(a), mpmath.mpf(w), mpmath.mpf(eta)
    root = mpmath.sqrt(a**2 - 1)
    end = (2 * mpmath.pi - mpmath.asin(1 / a)) / w
    grown, decayed = (root - w) * a * mpmath.exp(end), (root + w) * a * mpmath.exp(-end)
    D0 = (w / (w**2 + 1)) ** 2 * (w**2 - 2 * a**2 + 1 + grown + decayed)  # Eq. 42
    return eta**2 * (1 - D0) >= 1


@pytest.mark.parametrize(("a", "eta"), [(4.0, 0.9), (5.0, 0.9), (6.0, 0.9), (8.0, 1.0)])
def test_a_full_sine_overturns_after_one_impact_up_to_a_known_frequency(a, eta):
    """Zhang and Makris's first mode, where the impact comes after the pulse: eta^2 (1 - D0*) >= 1."""
    no_impact = boundary(lambda w: overturns("sine", a, float(w), eta) == 0, 0.2, a)
    candidates = np.linspace(no_impact * 1.001, 3 * a, 400)
    holds = [closed_form(a, w, eta).valid and closed_form(a, w, eta).overturns for w in candidates]
    changes = [
        (low, high) for (low, was), (high, now) in pairwise(zip(candidates, holds, strict=True)) if was and not now
    ]
    assert changes
    limit = boundary(lambda w: one_impact(a, w, eta), *changes[-1])
    assert closed_form(a, limit * (1 - 1e-9), eta).valid
    assert overturns("sine", a, limit * (1 - 1e-10), eta) == 1
    assert overturns("sine", a, limit * (1 + 1e-10), eta) is None


def test_between_the_two_modes_a_stronger_sine_may_be_safe():
    """Zhang and Makris: the overturning region with one impact lies below that without, with a safe gap between."""
    one, w = equivalent_block(replaced(BLOCK, restitution=0.9)).positive, 6.0
    a = np.linspace(1.01, 12, 3000)
    found = exact_many(
        Equivalence(one, one), SHAPE["sine"](1.0, 1.0), a * one.lambda_ * G, 2 * pi / (w * one.p), kappa=2, gravity=G
    )
    before = np.where(found.fell, found.impact_count, -1)
    runs = [before[0]]
    for each in before:
        if each != runs[-1]:
            runs.append(each)
    assert runs == [-1, 1, -1, 0]


def test_free_motion_keeps_its_energy_between_impacts():
    got = exact_pulse_impacts()
    rates = [rate for t, _, rate in got.impacts if t > got.pulse_end]
    assert len(rates) > 50
    for one, other in pairwise(rates):
        assert other == approx(0.9 * one, rel=1e-12)


def exact_pulse_impacts():
    equivalence = equivalent_block(replaced(BLOCK, restitution=0.9))
    return exact_response(equivalence, SHAPE["sine"](0.5 * G, 0.4), kappa=2, gravity=G)


def test_an_impact_hands_the_rate_and_not_its_scale_to_the_other_direction():
    equivalence = lopsided()
    got = exact_response(equivalence, SHAPE["sine"](0.5 * G, 0.4), kappa=2, gravity=G)
    after_pulse = [(side, rate) for t, side, rate in got.impacts if t > got.pulse_end]
    assert len(after_pulse) > 20
    for (side, one), (_, other) in pairwise(after_pulse):
        assert other == approx(equivalence[side].eta * one, rel=1e-12)


# Symmetries


PULSES = st.tuples(st.sampled_from(list(SHAPE)), st.floats(0.7, 8), st.floats(0.4, 10))


@settings(max_examples=25, deadline=None)
@given(PULSES, st.floats(0.5, 2), st.floats(0.3, 3), st.floats(0.3, 3), st.floats(0.3, 1))
def test_a_structure_seen_from_behind_moves_the_other_way(pulse, p, phi_cr, kappa, eta):
    equivalence = lopsided(p, phi_cr, kappa, eta)
    one = equivalence.positive
    shaking = SHAPE[pulse[0]](pulse[1] * one.lambda_ * G, 2 * pi / (pulse[2] * one.p))
    got = exact_response(equivalence, shaking, kappa=2, gravity=G)
    mirrored = exact_response(Equivalence(equivalence.negative, one), shaking, kappa=2, gravity=G, polarity=-1)
    assert known(mirrored.peak_ratio) == known(got.peak_ratio)
    assert [known(mirrored.peak_positive), known(mirrored.peak_negative)] == [
        known(got.peak_negative),
        known(got.peak_positive),
    ]
    assert [t for t, _, _ in mirrored.impacts] == [t for t, _, _ in got.impacts]
    assert known(mirrored.overturning_time) == known(got.overturning_time)


@settings(max_examples=25, deadline=None)
@given(PULSES, st.floats(0.3, 1))
def test_what_follows_a_pulse_is_within_reason(pulse, eta):
    one = equivalent_block(replaced(BLOCK, restitution=eta)).positive
    shaking = SHAPE[pulse[0]](pulse[1] * one.lambda_ * G, 2 * pi / (pulse[2] * one.p))
    got = exact_response(Equivalence(one, one), shaking, kappa=2, gravity=G)
    times = [t for t, _, _ in got.impacts]
    assert times == sorted(times)
    assert [-side for _, side, _ in got.impacts[:-1]] == [side for _, side, _ in got.impacts[1:]] or got.peak_ratio != 0
    assert got.overturned == isnan(got.peak_ratio) == (got.fell_to != 0)
    assert isnan(got.uplift_time) == (got.peak_ratio == 0)
    if got.overturned and not isnan(got.overturning_time):
        assert got.overturning_time >= max([got.uplift_time, *times])


@pytest.mark.parametrize("shape", SHAPE_CYCLES)
def test_the_dimensionless_shapes_are_those_of_the_plugins(shape):
    equivalence = equivalent_block(replaced(BLOCK, restitution=0.85))
    one = equivalence.positive
    for a, w in product((1.2, 2.0, 4.5), (0.8, 3.0, 7.0)):
        pulse = SHAPE[shape](a * one.lambda_lin * G, 2 * pi / (w * one.p))
        got = exact_response(equivalence, pulse, kappa=1, gravity=G, polarity=-1)
        bare = exact_pulse(a, w, 0.85, shape)
        assert got.overturned == bare.overturns
        assert (got.impact_count if got.overturned else None) == bare.impacts_before_overturning
        assert known(got.peak_ratio) == near(bare.max_ratio, rel=1e-9)
        assert known(got.first_rebound) == near(bare.first_rebound, rel=1e-9)
        assert got.uplift_time * one.p == approx(bare.uplift, rel=1e-12, abs=1e-15)


# Overturning time


@pytest.mark.parametrize(("shape", "a", "w"), [("rectangular", 1.5, 1.0), ("half_sine", 4.0, 3.9), ("sine", 6.0, 5.0)])
def test_it_is_when_phi_cr_is_passed_for_good(shape, a, w):
    equivalence = equivalent_block(BLOCK)
    one = equivalence.positive
    pulse = SHAPE[shape](a * one.lambda_ * G, 2 * pi / (w * one.p))
    got = exact_response(equivalence, pulse, kappa=2, gravity=G)
    assert got.overturned
    times = [
        respond(BLOCK, pulse.sampled(n), models=("linear2",), tail=0.0)["linear2"].overturning_time
        for n in (4000, 8000)
    ]
    assert got.overturning_time == approx((4 * times[1] - times[0]) / 3, abs=1e-8)
    if shape == "rectangular":
        assert got.overturning_time * one.p == approx(np.arccosh(1 + 1 / (a - 1)), rel=1e-12)  # Eq. 25


# Many


def grid(n=24):
    a, w = np.meshgrid(np.geomspace(0.9, 12, n), np.geomspace(0.2, 12, n))
    one = equivalent_block(FRAME).positive
    return a.ravel() * one.lambda_ * G, 2 * pi / (w.ravel() * one.p)


@pytest.mark.parametrize("shape", [*SHAPE_CYCLES, "zigzag"])
def test_many_are_each_as_one(shape):
    equivalence, (amplitudes, periods) = equivalent_block(FRAME), grid()
    many = exact_many(equivalence, SHAPE[shape](2.0, 3.0), amplitudes, periods, kappa=2, gravity=G, polarity=-1)
    assert not many.failed.any()
    count = set()
    for k in range(0, many.overturned.size, 5):
        one = exact_response(equivalence, SHAPE[shape](amplitudes[k], periods[k]), kappa=2, gravity=G, polarity=-1)
        assert many.overturned[k] == one.overturned
        assert many.lifted[k] == one.lifted
        assert (many.fell_to[k], many.impact_count[k] if one.overturned else 0) == (
            one.fell_to,
            one.impact_count if one.overturned else 0,
        )
        if not one.overturned:
            for name in ("peak_ratio", "peak_positive", "peak_negative"):
                assert getattr(many, name)[k] == approx(getattr(one, name), rel=1e-11, abs=1e-13)
        count.add((one.overturned, one.lifted))
    assert count == {(True, True), (False, True), (False, False)}


# Wrong input


def test_what_cannot_be_answered_is_said():
    equivalence, sine = equivalent_block(BLOCK), SHAPE["sine"](4.0, 1.0)
    with pytest.raises(InputError, match=r"ricker is not a chain of sines and constants: .*sampled"):
        exact_response(equivalence, PulseShapes()["ricker"](4.0, 1.0), kappa=1, gravity=G)
    with pytest.raises(InputError, match="kappa must be 1 or 2, got 3"):
        exact_response(equivalence, sine, kappa=3, gravity=G)
    with pytest.raises(InputError, match="polarity must be 1 or -1, got 0"):
        exact_response(equivalence, sine, kappa=1, gravity=G, polarity=0)
    with pytest.raises(InputError, match="gravity must be positive, got 0"):
        exact_response(equivalence, sine, kappa=1, gravity=0.0)
    with pytest.raises(InputError, match="eta must be positive"):
        exact_response(equivalent_block(Block(width=3, height=1)), sine, kappa=1, gravity=G)
    for amplitudes, periods, words in (
        ([1.0, -1.0], 1.0, "pulse 1: the amplitude must be positive, got -1"),
        ([1.0], [np.nan], "pulse 0: the period must be positive, got nan"),
        ([1.0, 2.0], [1.0, 2.0, 3.0], "amplitudes and periods differ in length"),
        ([[1.0, 2.0]], 1.0, "must be a row of numbers"),
    ):
        with pytest.raises(InputError, match=words):
            exact_many(equivalence, sine, amplitudes, periods, kappa=1, gravity=G)
    with pytest.raises(InputError, match="threads must be 1 or more, got 0"):
        exact_many(equivalence, sine, [1.0], 1.0, kappa=1, gravity=G, threads=0)
    with pytest.raises(InputError, match="shape must be one of sine, cosine"):
        exact_pulse(2, 3, 0.9, "ricker")
    assert exact_many(equivalence, sine, [], [], kappa=1, gravity=G).overturned.size == 0


def test_progress_is_told_and_adds_up():
    told, (amplitudes, periods) = [], grid(40)
    sine = SHAPE["sine"](1.0, 1.0)
    exact_many(equivalent_block(FRAME), sine, amplitudes, periods, kappa=2, gravity=G, progress=told.append)
    assert sum(told) == len(amplitudes) and len(told) > 1


def test_bouncing_all_through_a_slow_pulse_is_refused_by_one_and_marked_by_many():
    equivalence = equivalent_block(replaced(BLOCK, restitution=1.0))
    one = equivalence.positive
    amplitude, period = 1.0000036 * one.lambda_ * G, 2 * pi / (0.003 * one.p)
    with pytest.raises(SolverError, match="needs a smaller restitution"):
        exact_response(equivalence, SHAPE["sine"](amplitude, period), kappa=2, gravity=G)
    many = exact_many(equivalence, SHAPE["sine"](1.0, 1.0), [amplitude, 0.1], period, kappa=2, gravity=G)
    assert many.failed.tolist() == [True, False]

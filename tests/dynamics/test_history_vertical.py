"""Vertical ground motion: against an independent integration, its limits, and what must never happen without weight."""

from functools import cache
from math import ceil

import numpy as np
import pytest
from mpmath import mp, mpf

from mechanisms.asymmetric_frame import AsymmetricFrame
from mechanisms.block import Block
from mechanisms.wall import Wall
from rocking_cli.core import Direction, equivalent_block
from rocking_cli.excitation.base import GroundMotion
from tests.following import respond
from tests.reference_history import Equivalent, Nonlinear
from tests.unchecked import UncheckedArch

MODELS = ("nonlinear", "linear1", "linear2")
STRUCTURES = {
    "block": Block(width=0.7, height=2.8),
    "wall": Wall(thickness=0.3, height=3.0),
    "frame": AsymmetricFrame(
        column_width=1.0, left_height=6.0, right_height=7.5, spacing=8.0, beam_depth=1.0, density=2400.0, depth=1.0
    ),
    "arch": UncheckedArch(radius=10.0, thickness=1.5, inclusion_angle_deg=157.5),
}
BLOCK = STRUCTURES["block"]
G = BLOCK.gravity
every_model = pytest.mark.parametrize("model", MODELS)
every_side = pytest.mark.parametrize("side", [1, -1])


@cache
def blocks(name):
    return equivalent_block(STRUCTURES[name])


@cache
def equation(name, model):
    if model == "nonlinear":
        return Nonlinear(STRUCTURES[name])
    return Equivalent(blocks(name), int(model[-1]), G)


def uplift(name, model):
    """The ground acceleration that lifts a structure in the positive direction under its own weight [m/s2]."""
    block = blocks(name).positive
    return G * (block.lambda_lin if model == "linear1" else block.lambda_)


def shaken(dt, samples, v_dt, v):
    vertical = GroundMotion("up", v_dt, np.asarray(v, float), unit="m/s2")
    return GroundMotion("test", dt, np.asarray(samples, float), vertical=vertical, unit="m/s2")


def both(name, model, dt, samples, v_dt, v, release=None, **options):
    """The engine's history and the independent one."""
    motion = shaken(dt, samples, v_dt, v)
    history = respond(STRUCTURES[name], motion, models=(model,), release=release)[model]
    expected = equation(name, model).follow(dt, samples, release or 0.0, vertical=(v_dt, v), **options)
    return history, expected


def agree(history, expected, phi_cr=0.2):
    """Impacts to 1e-9 s, peaks to 1e-9 of themselves and uplift to 1e-12 s are those of the reference.

    Of a history that is not known to its end this is so of the impacts until then.
    """
    assert history.unknown or history.overturned == (expected.ended == "fallen")
    impacts = np.array(expected.impacts).reshape(-1, 3)
    if history.unknown:
        impacts = impacts[impacts[:, 0] <= history.known_to]
        assert len(history.impacts) == len(impacts) == history.impact_count
    got = history.impacts[: len(impacts)]
    assert got.shape == impacts.shape
    np.testing.assert_array_equal(got[:, 1], impacts[:, 1])
    np.testing.assert_allclose(got[:, 0], impacts[:, 0], rtol=0, atol=1e-9)
    np.testing.assert_allclose(got[:, 2], impacts[:, 2], rtol=0, atol=1e-9 * impacts[:, 2].max(initial=1e-3))
    for s, peak in ((1, history.peak_positive), (-1, history.peak_negative)):
        if history.unknown:
            assert peak <= expected.peaks[s] * (1 + 1e-9)
        else:
            assert np.isnan(peak) or peak == pytest.approx(expected.peaks[s], rel=1e-9, abs=1e-12 * phi_cr)
            rate = history.peak_rate_positive if s > 0 else history.peak_rate_negative
            assert np.isnan(rate) or rate == pytest.approx(expected.rates[s], rel=1e-8, abs=1e-12)
    if history.overturned:
        assert history.overturning_time == pytest.approx(expected.crossings[-1], abs=1e-9)
    if expected.uplift is None:
        assert np.isnan(history.uplift_time)
    else:
        assert history.uplift_time == pytest.approx(expected.uplift, abs=1e-12)


def is_gone_at(history, model, time):
    """Whether a history ends where nothing holds the structure down; that of an equivalent block goes on."""
    assert history.contact_lost == pytest.approx(time, abs=1e-14)
    if model == "nonlinear":
        assert history.unknown and history.known_to == pytest.approx(time, abs=1e-12)
        assert history.check.reason == "weightless" and history.words == "unknown"
        assert np.isfinite(history.phi[history.time <= time]).all()
        assert np.isnan(history.phi[history.time > history.known_to]).all()
        assert (history.impacts[:, 0] <= history.known_to).all() and np.isfinite(history.impacts).all()
        assert np.isnan(history.overturning_time) and np.isnan(history.end_time) and history.fell_to == 0
    else:
        assert not history.unknown
    return history.unknown


def noise(name, model, seed, amplitude, npts):
    """Random samples, in multiples of the uplift acceleration."""
    return amplitude * uplift(name, model) * np.random.default_rng(seed).normal(size=npts)


# --- against an independent integration

# Interval in 1/p, samples, seed, amplitude in uplift accelerations; interval of the vertical component over the
# horizontal one, samples, and its strength over g; release.
CASES = {
    "same dt": ((0.1, 20, 3, 1.5), (1.0, 20, 0.5), None),
    "finer": ((0.15, 12, 2, 1.8), (0.25, 45, 0.4), None),
    "coarser": ((0.06, 30, 5, 1.5), (3.0, 9, 0.5), 0.3),
    "all but the same dt": ((0.15, 16, 3, 1.5), (1.0004, 16, 0.5), None),
    "incommensurate": ((0.1, 16, 5, 1.5), (0.37, 43, 0.4), None),
    "incommensurate and coarser": ((0.1, 16, 5, 1.5), (1.7, 10, 0.4), -0.4),
    "longer than the horizontal": ((0.1, 8, 5, 1.8), (0.7, 40, 0.3), None),
    "shorter than the horizontal": ((0.1, 20, 3, 1.5), (1.0, 7, 0.6), None),
}


@pytest.mark.every(6)
@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize(
    ("name", "model"),
    [(name, model) for name in ("block", "frame") for model in MODELS] + [("wall", "nonlinear"), ("arch", "nonlinear")],
)
def test_uplift_impacts_and_peaks_are_those_of_an_independent_integration(name, model, case):
    (step, npts, seed, amplitude), (stride, v_npts, strength), release = CASES[case]
    dt = step / blocks(name).positive.p
    samples = noise(name, model, seed, amplitude, npts)
    v = strength * G * np.clip(np.random.default_rng(seed + 100).normal(size=v_npts), -1.9, 1.9)
    history, expected = both(name, model, dt, samples, stride * dt, v, release)
    assert release is not None or expected.uplift is not None
    assert not history.unknown
    agree(history, expected)
    level = respond(STRUCTURES[name], GroundMotion("test", dt, samples, unit="m/s2"), models=(model,), release=release)[
        model
    ]
    assert abs(level.impacts[0, 0] - history.impacts[0, 0]) > 1e-4


@pytest.mark.every(3)
@every_model
@pytest.mark.parametrize("v_dt", [0.01, 0.0037, 0.025])
def test_an_overturning_motion_agrees_at_the_sample_intervals_of_real_records(model, v_dt):
    samples = 2.5 * uplift("block", model) * np.sin(np.arange(61) * 0.01 * 2 * np.pi / 1.2)
    v = 0.5 * G * np.sin(np.arange(ceil(0.8 / v_dt)) * v_dt * 17.0 + 0.4)
    history, expected = both("block", model, 0.01, samples, v_dt, v)
    assert history.overturned
    agree(history, expected)


def test_one_straight_piece_of_the_linear_model_is_its_equation_in_25_digits():
    model = equation("block", "linear2")
    p, phi_cr, kappa, g = (mpf(x) for x in (model.p[1], model.phi_cr[1], model.kappa[1], G))
    u, v, dt = (-2.0, -1.0), (3.0, -5.0), 0.3

    def slopes(t, y):
        up, across = (a + (b - a) * t / dt for a, b in (v, u))
        return [y[1], p**2 * ((1 + up / g) * (y[0] - phi_cr) - kappa * across / g)]

    with mp.workdps(25):
        phi, rate = mp.odefun(slopes, 0, [phi_cr / 2, mpf(0)])(mpf(dt))
    history = respond(BLOCK, shaken(dt, [*u, 0.0], dt, [*v, 0.0]), models=("linear2",), release=0.5)["linear2"]
    assert history.phi[1] == pytest.approx(float(phi), rel=1e-11)
    assert history.rate[1] == pytest.approx(float(rate), rel=1e-11)


# --- uplift


@every_model
@every_side
def test_uplift_is_where_the_ramps_of_both_components_cross(model, side):
    # Over its own uplift acceleration the ground gives 2 t, while lambda (g + v) is 1 + 0.6 - 2.4 (t - 0.5).
    samples = -side * uplift("block", model) * np.array([0.0, 2.0, 0.0, 0.0])
    motion = shaken(1.0, samples, 0.5, 0.6 * G * np.array([0.0, 1.0, -1.0, 0.0]))
    assert respond(BLOCK, motion, models=(model,))[model].uplift_time == pytest.approx(2.8 / 4.4, abs=1e-14)


@every_model
def test_the_vertical_component_may_lift_a_structure_between_two_samples_of_the_horizontal_one(model):
    # Never beyond the uplift acceleration, but for a moment there is too little weight.
    samples = -0.5 * uplift("block", model) * np.ones(4)
    motion = shaken(0.5, samples, 0.1, G * np.array([0.0, 0.0, 0.0, -0.8, 0.0, 0.0]))
    history = respond(BLOCK, motion, models=(model,))[model]
    assert history.uplift_time == pytest.approx(0.2 + 0.1 * 0.5 / 0.8, abs=1e-14)
    assert history.impact_count > 0
    assert respond(BLOCK, GroundMotion("level", 0.5, samples, unit="m/s2"), models=(model,))[model].impact_count == 0


@every_model
def test_more_weight_keeps_down_what_the_horizontal_component_would_lift(model):
    samples = 1.5 * uplift("block", model) * np.array([0.0, 1.0, -1.0, 1.0, 0.0])
    history = respond(BLOCK, shaken(0.1, samples, 0.05, 0.6 * G * np.ones(12)), models=(model,))[model]
    assert history.at_rest
    assert np.isnan(history.uplift_time)
    assert not history.phi.any()


@every_model
def test_a_vertical_component_that_begins_at_once_lifts_at_once(model):
    samples = -0.9 * uplift("block", model) * np.array([1.0, 1.0, 0.0, 0.0, 0.0])
    history, expected = both("block", model, 0.1, samples, 0.1, -0.5 * G * np.ones(3))
    assert history.uplift_time == 0.0
    agree(history, expected)


# --- limits


@pytest.mark.every(6)
@every_model
@pytest.mark.parametrize("name", STRUCTURES)
@pytest.mark.parametrize("c", [3.0, -6.0, 0.0])
def test_a_constant_vertical_acceleration_is_another_gravity(model, name, c):
    dt = 0.1 / blocks(name).positive.p
    samples = noise(name, model, 3, 1.5 * (1 + c / G), 24)
    vertical = c * np.ones(400)  # longer than the motion
    history = respond(STRUCTURES[name], shaken(dt, samples, 0.5, vertical), models=(model,))[model]
    other = STRUCTURES[name].model_copy(update={"gravity": G + c})
    expected = respond(other, GroundMotion("test", dt, samples, unit="m/s2"), models=(model,))[model]
    assert history.at_rest and expected.at_rest
    assert history.uplift_time == pytest.approx(expected.uplift_time, abs=1e-12)
    early = np.count_nonzero(expected.impacts[:, 2] > 1e-4 * expected.impacts[:, 2].max())
    assert early > 5
    np.testing.assert_allclose(history.impacts[:early, 0], expected.impacts[:early, 0], rtol=0, atol=1e-9)
    assert history.peak_ratio == pytest.approx(expected.peak_ratio, rel=1e-9)


@every_model
@pytest.mark.parametrize("v_dt", [0.3, 0.05])
def test_a_vertical_component_resampled_on_its_own_straight_lines_gives_the_same_motion(model, v_dt):
    samples = noise("block", model, 3, 1.5, 24)
    v = 0.5 * G * np.sin(np.arange(20))
    fine = np.interp(np.arange(3 * 19 + 1) / 3, np.arange(20), v)
    one, two = (
        respond(BLOCK, shaken(0.05, samples, step, up), models=(model,))[model]
        for step, up in ((v_dt, v), (v_dt / 3, fine))
    )
    early = np.count_nonzero(one.impacts[:, 2] > 1e-4 * one.impacts[:, 2].max())
    np.testing.assert_allclose(two.impacts[:early, 0], one.impacts[:early, 0], rtol=0, atol=1e-9)
    assert two.peak_ratio == pytest.approx(one.peak_ratio, rel=1e-9)
    assert two.uplift_time == pytest.approx(one.uplift_time, abs=1e-12)


@every_model
def test_ever_so_many_vertical_samples_between_two_horizontal_ones_are_all_followed(model):
    # 20 000 of them; the quiet horizontal component is the same at any interval.
    v = 0.3 * G * np.sin(np.arange(20_000) * 0.005)
    coarse, fine = (
        respond(BLOCK, shaken(dt, np.zeros(npts), 0.001, v), models=(model,), release=0.5)[model]
        for dt, npts in ((20.0, 2), (0.01, 2001))
    )
    assert coarse.at_rest
    early = np.count_nonzero(fine.impacts[:, 2] > 1e-4 * fine.impacts[:, 2].max())
    assert early > 50
    np.testing.assert_allclose(coarse.impacts[:early, 0], fine.impacts[:early, 0], rtol=0, atol=1e-8)
    assert coarse.peak_ratio == pytest.approx(fine.peak_ratio, rel=1e-9)


@every_model
def test_samples_go_on_to_the_end_of_the_longer_component(model):
    samples = noise("block", model, 3, 1.5, 24)
    history = respond(BLOCK, shaken(0.05, samples, 0.3, 0.4 * G * np.sin(np.arange(20.0))), models=(model,), tail=0.0)
    assert history[model].time[-1] == pytest.approx(5.7, abs=1e-12)
    assert np.isfinite(history[model].phi).all()
    # They are those of the motion with both components at one interval.
    finer = np.interp(np.arange(115) * 0.05, np.arange(20) * 0.3, 0.4 * G * np.sin(np.arange(20.0)))
    padded = np.concatenate([samples, np.zeros(115 - 24)])
    padded[23] = 0.0
    samples[23] = 0.0
    one, two = (
        respond(BLOCK, motion, models=(model,), tail=0.0)[model]
        for motion in (
            shaken(0.05, samples, 0.3, 0.4 * G * np.sin(np.arange(20.0))),
            shaken(0.05, padded, 0.05, finer),
        )
    )
    np.testing.assert_allclose(one.phi, two.phi, rtol=0, atol=1e-9)


# --- overturning


def outward_and_slow(model, side):
    """Samples that bring a block beyond phi_cr and so far that the brake, 0.45 of uplift, would not stop it."""
    push = np.concatenate([[0.0], np.full(12, 1.05), np.full(40, -0.45)])
    return -side * uplift("block", model) * np.concatenate([push, np.full(40, -0.45), np.zeros(3)])


@every_model
@every_side
@pytest.mark.every(2)
def test_overturning_is_not_certain_while_the_ground_may_still_take_the_weight_away(model, side):
    # The brake turns it back as soon as its weight falls to a fifth; without that it overturns.
    p = blocks("block").positive.p
    dt, samples = 0.05 / p, outward_and_slow(model, side)
    v = np.zeros(samples.size)
    v[53:-3] = -0.8 * G
    history, expected = both("block", model, dt, samples, dt, v, 0.8 * side, impacts_after=2)
    assert expected.impacts[0][1] == side
    assert max(expected.peaks[side], 0) > 1.45 * blocks("block").positive.phi_cr
    agree(history, expected)
    level = respond(BLOCK, GroundMotion("test", dt, samples, unit="m/s2"), models=(model,), release=0.8 * side)[model]
    assert level.overturned
    assert level.fell_to == Direction(side)
    assert level.end_time < 53 * dt  # which was certain before the vertical component would have begun


@every_model
def test_overturning_is_certain_at_once_where_the_ground_only_adds_weight(model):
    p = blocks("block").positive.p
    dt, samples = 0.05 / p, outward_and_slow(model, 1)
    ends = {}
    for name, strength in (("level", 0.0), ("heavy", 0.8), ("light", -0.5)):
        v = np.zeros(samples.size)
        v[80:] = strength * G
        motion = shaken(dt, samples * np.where(np.arange(samples.size) < 13, 1.3, 1.0), dt, v)
        history = respond(BLOCK, motion, models=(model,), release=0.8)[model]
        assert history.overturned
        ends[name] = history.end_time
    assert ends["level"] == ends["heavy"] < ends["light"]


@every_model
def test_a_structure_beyond_phi_cr_is_thrown_back_by_a_ground_that_drops_faster_than_it_falls(model):
    # -3 g for a second, long after it would have been certain to overturn.
    v = np.zeros(150)
    v[20:120] = -3.0 * G
    samples = -uplift("block", model) * np.concatenate([[0.0], np.full(12, 1.5), np.zeros(10)])
    history, expected = both("block", model, 0.01, samples, 0.01, v, 0.95)
    assert expected.peaks[1] > 1.01 * blocks("block").positive.phi_cr
    agree(history, expected)
    if is_gone_at(history, model, 0.19 + 0.01 / 3):
        assert history.peak_ratio > 1.01  # and yet it has not overturned: it is thrown back, or not


# --- without weight


def test_contact_is_lost_by_the_gravity_of_the_structure_and_not_without_a_vertical_component():
    moon = Block(width=0.7, height=2.8, gravity=1.62)
    motion = shaken(0.1, np.zeros(3), 0.5, [0.0, -3.24, 0.0])
    assert respond(moon, motion, models=("nonlinear",))["nonlinear"].contact_lost == pytest.approx(0.25, abs=1e-14)
    assert respond(BLOCK, motion, models=("nonlinear",))["nonlinear"].contact_lost is None
    assert respond(BLOCK, release=0.5, models=("nonlinear",))["nonlinear"].contact_lost is None


@every_model
@every_side
def test_a_structure_without_weight_lifts_the_way_that_opens_first(model, side):
    # g + v falls through lambda (g + v) = -s u, then through zero, then through the other direction's.
    samples = -side * 0.2 * np.array([1.0, 1.0, 0.0])
    history = respond(BLOCK, shaken(1.0, samples, 1.0, G * np.array([0.0, -3.0, 0.0])), models=(model,))[model]
    assert history.uplift_time == pytest.approx((1 - 0.2 / uplift("block", model)) / 3, abs=1e-14)
    if is_gone_at(history, model, 1 / 3):
        peaks = {1: history.peak_positive, -1: history.peak_negative}
        assert peaks[side] > 0 == peaks[-side]
    else:
        assert history.fell_to == Direction(side)
    # From the first sample on both are open: it goes where it is pushed.
    history = respond(BLOCK, shaken(1.0, samples, 1.0, G * np.array([-2.0, -2.0, 0.0])), models=(model,))[model]
    if is_gone_at(history, model, 0.0):
        assert history.peak_ratio == 0 and not history.impact_count
    else:
        assert history.uplift_time == 0.0
        assert history.fell_to == Direction(side)


@pytest.mark.every(6)
@every_model
@pytest.mark.parametrize("release", [None, 0.5, -0.99])
@pytest.mark.parametrize("depth", [-1.0, -1.0000001, -1.5, -40.0])
@pytest.mark.parametrize("later", [0.0, 0.9, -0.9, 30.0])
def test_weight_that_is_gone_for_a_while_neither_fails_nor_hangs(model, release, depth, later):
    v = G * np.concatenate([[0.0, 0.0], np.full(12, depth), np.full(20, later), [0.0]])
    for strength in (0.0, 0.5, 3.0):
        samples = strength * uplift("block", model) * np.sin(np.arange(30))
        history = respond(BLOCK, shaken(0.02, samples, 0.013, v), models=(model,), release=release)[model]
        if is_gone_at(history, model, 0.013 * (1 + 1 / -depth)):
            continue
        assert np.isfinite(history.end_time)
        assert history.at_rest or history.overturned
        assert np.isfinite(history.impacts).all()


@pytest.mark.parametrize("model", ["linear1", "linear2"])
def test_a_linear_block_that_fell_long_before_its_weight_is_gone_has_fallen(model):
    # Nothing is certain as long as that is to come, and meanwhile its rotation grows by e^(p t).
    v = np.zeros(200_000)
    v[-3] = -2 * G
    samples = -3.0 * uplift("block", model) * np.concatenate([[0.0], np.ones(100), [0.0]])
    history = respond(BLOCK, shaken(0.01, samples, 0.01, v), models=(model,))[model]
    assert history.overturned
    assert history.overturning_time < 1.0

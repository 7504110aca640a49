"""The linear engine against its equation in 50 digits, and against what that says of uplift and overturning."""

from functools import cache

import numpy as np
import pytest

from mechanisms.asymmetric_frame import AsymmetricFrame
from mechanisms.block import Block
from mechanisms.rigid_body import RigidBody
from rocking_cli.core import equivalent_block
from rocking_cli.excitation.base import GroundMotion
from tests.following import respond
from tests.reference_history import Linear

MODELS = ["linear1", "linear2"]
RATE = 1e-8  # what is left of a peak rate where its turning point is found


@cache
def structure(name):
    if name == "block":
        return Block(width=0.7, height=2.8)
    if name == "leaning":
        return RigidBody(polygon=[[0.0, 0.0], [1.0, 0.0], [1.1, 3.0], [0.3, 3.2]])
    return AsymmetricFrame(
        column_width=1.0, left_height=6.0, right_height=7.5, spacing=8.0, beam_depth=1.0, density=2400.0, depth=1.0
    )


@cache
def equivalence(name):
    return equivalent_block(structure(name))


def noise(name, seed, amplitude, npts=80):
    block = equivalence(name).positive
    threshold = block.lambda_ * structure(name).gravity
    return 0.1 / block.p, amplitude * threshold * np.random.default_rng(seed).normal(size=npts)


def both(name, model, dt, samples, release=None, **options):
    """The engine's history and the 50-digit one."""
    history = respond(
        structure(name), GroundMotion("test", dt, samples, unit="m/s2"), models=(model,), release=release
    )[model]
    exact = Linear(equivalence(name), int(model[-1]), structure(name).gravity)
    return history, exact.follow(dt, samples, release or 0.0, **options)


def agree(name, history, reference, tolerance=1e-12):
    impacts = reference.impacts
    assert history.impact_count >= len(impacts)
    for (time, s, rate), got in zip(impacts, history.impacts, strict=False):
        assert abs(float(time - got[0])) < tolerance
        assert got[1] == s
        p_phi_cr = equivalence(name).positive.p * equivalence(name).positive.phi_cr
        assert abs(float(rate - got[2])) < tolerance * p_phi_cr
    for s, peak in ((1, history.peak_positive), (-1, history.peak_negative)):
        phi_cr = (equivalence(name).positive if s > 0 else equivalence(name).negative).phi_cr
        if not np.isnan(peak):
            assert abs(float(reference.peaks[s] - peak)) < tolerance * phi_cr
            rate = history.peak_rate_positive if s > 0 else history.peak_rate_negative
            assert rate == pytest.approx(float(reference.rates[s]), rel=RATE, abs=tolerance)
    if reference.uplift is None:
        assert np.isnan(history.uplift_time)
    else:
        assert abs(float(reference.uplift - history.uplift_time)) < tolerance
    assert history.overturned == (reference.ended == "fallen")
    if history.overturned:
        assert abs(float(reference.crossings[-1] - history.overturning_time)) < tolerance


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize(
    ("name", "seed", "amplitude", "release"),
    [
        ("block", 1, 2.0, None),
        ("block", 3, 1.5, -0.3),
        ("frame", 2, 2.0, None),
        ("frame", 1, 2.0, 0.4),
        ("leaning", 1, 1.5, None),
        ("leaning", 2, 1.5, None),
        ("block", 0, 2.0, None),  # overturns
        ("frame", 0, 3.0, None),  # overturns
    ],
)
def test_impacts_peaks_and_outcome_are_those_of_the_fifty_digit_solution(model, name, seed, amplitude, release):
    history, reference = both(name, model, *noise(name, seed, amplitude), release)
    agree(name, history, reference)


@pytest.mark.parametrize("model", MODELS)
def test_a_whole_free_motion_down_to_rest_is_the_fifty_digit_solution(model):
    # From the release to the last faint impact: the count is that of the exact motion.
    history, reference = both("leaning", model, 0.05, np.zeros(2), 0.7, impacts_after=10**6)
    agree("leaning", history, reference)
    assert history.impact_count == len(reference.impacts) > 50
    assert history.at_rest


@pytest.mark.parametrize("name", ["block", "frame", "leaning"])
@pytest.mark.parametrize("s", [1, -1])
def test_uplift_is_at_lambda_lin_with_kappa_1_and_at_lambda_with_kappa_2(name, s):
    block = equivalence(name).positive if s > 0 else equivalence(name).negative
    for model, multiplier in (("linear1", block.lambda_lin), ("linear2", block.lambda_), ("nonlinear", block.lambda_)):
        uplift = multiplier * structure(name).gravity
        for factor, lifts in ((1 - 1e-11, False), (1 + 1e-11, True)):
            samples = -s * factor * uplift * np.array([0.0, 1.0, 0.0])
            history = respond(structure(name), GroundMotion("test", 0.5, samples, unit="m/s2"), models=(model,))[model]
            assert (not np.isnan(history.uplift_time)) == lifts, (model, factor)


def test_the_two_models_lift_at_different_moments():
    block = equivalence("frame").positive
    assert abs(block.lambda_lin / block.lambda_ - 1) > 1e-3
    samples = -2 * block.lambda_ * structure("frame").gravity * np.array([0.0, 1.0, 0.0])
    histories = respond(structure("frame"), GroundMotion("test", 1.0, samples, unit="m/s2"))
    assert histories["linear1"].uplift_time == pytest.approx(block.lambda_lin / block.lambda_ / 2, rel=1e-13)
    assert histories["linear2"].uplift_time == pytest.approx(1 / 2, rel=1e-13)
    assert histories["nonlinear"].uplift_time == pytest.approx(1 / 2, rel=1e-13)


@pytest.mark.parametrize("model", MODELS)
def test_a_peak_between_two_coarse_samples_is_found(model):
    # 0.8 s between samples: half a dozen of them describe the motion, and none is at a peak.
    samples = equivalence("block").positive.lambda_ * 9.80665 * np.array([0.0, 1.6, -1.4, 0.6, 0.0, 0.0])
    history, reference = both("block", model, 0.3, samples)
    agree("block", history, reference)
    assert history.peak_ratio > 1.001 * abs(history.ratio).max()


@pytest.mark.parametrize("model", MODELS)
def test_a_ramp_of_thousands_of_1_over_p_overflows_nothing(model):
    # It lifts half-way up a ramp of 1000 s and overturns within seconds: phi = slope/p (sinh pt - pt).
    block = equivalence("block").positive
    multiplier = {"linear1": block.lambda_lin, "linear2": block.lambda_}[model]
    motion = GroundMotion("test", 1000.0, -multiplier * 9.80665 * np.array([0.0, 2.0, 0.0, 0.0]), unit="m/s2")
    history = respond(structure("block"), motion, models=(model,), tail=0.0)[model]
    assert history.uplift_time == pytest.approx(500.0, rel=1e-14)
    slope = block.phi_cr * 2 / 1000.0
    t = block.p * (history.overturning_time - 500.0)
    assert slope / block.p * (np.sinh(t) - t) == pytest.approx(block.phi_cr, rel=1e-9)


@pytest.mark.parametrize("model", MODELS)
def test_overturning_is_certain_only_beyond_the_strongest_acceleration_to_come(model):
    # The same push; a stronger reversal later keeps the outcome open for longer, and the strongest one saves the block.
    block = equivalence("block").positive
    uplift = {"linear1": block.lambda_lin, "linear2": block.lambda_}[model] * 9.80665
    push = np.concatenate([[0.0], np.full(4, -3.0)])
    ends, outcomes = [], []
    for strength in (0.0, 1.0, 2.0, 5.0):
        samples = uplift * np.concatenate([push, np.full(2, strength), [0.0]])
        history, reference = both("block", model, 0.1, samples)
        agree("block", history, reference)
        outcomes.append(history.overturned)
        ends.append(history.end_time)
        if history.overturned and history.end_time < 0.1 * (samples.size - 1):
            k = round(history.end_time / 0.1) - 1
            # The sample before was not yet certain, or it would have ended there.
            later = abs(samples[k:]).max() / uplift
            assert not (history.rate[k] >= 0 and history.ratio[k] >= 1 + later)
    assert outcomes == [True, True, True, False]
    assert ends[0] < ends[2]


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("side", [1, -1])
def test_after_the_record_the_motion_overturns_exactly_where_its_energy_suffices(model, side):
    # Free motion is (phi - phi_cr) +- phi./p times an exponential: it overturns if phi./p > phi_cr - phi.
    block = equivalence("frame").positive if side > 0 else equivalence("frame").negative
    uplift = {"linear1": block.lambda_lin, "linear2": block.lambda_}[model] * 9.80665
    lobe = -side * uplift * np.sin(np.linspace(0, np.pi, 12))

    def at_the_end(scale):
        history, reference = both("frame", model, 0.05, scale * lobe, impacts_after=3)
        phi, rate = side * history.phi[11], side * history.rate[11]
        return history, reference, phi + rate / block.p - block.phi_cr

    low, high = 1.0, 20.0
    for _ in range(36):
        middle = (low + high) / 2
        motion = GroundMotion("test", 0.05, middle * lobe, unit="m/s2")
        fell = respond(structure("frame"), motion, models=(model,))[model].overturned
        low, high = (low, middle) if fell else (middle, high)
    for scale, fell in ((low * (1 - 1e-9), False), (high * (1 + 1e-9), True)):
        history, reference, energy = at_the_end(scale)
        agree("frame", history, reference, tolerance=1e-6)  # a saddle: 1e-9 off grows by 1e4 on the way
        assert history.overturned == fell == (energy > 0)
        assert abs(energy) < 1e-7
        if fell:
            assert history.overturning_time > 0.05 * 11

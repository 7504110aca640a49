"""The nonlinear engine against an independent integration, the energy integral, and laws it must obey."""

from functools import cache
from itertools import pairwise
from math import acosh, pi, sqrt

import numpy as np
import pytest
from scipy.optimize import brentq

from mechanisms.arch import Arch
from mechanisms.asymmetric_frame import AsymmetricFrame
from mechanisms.block import Block
from mechanisms.rigid_body import RigidBody
from mechanisms.wall import Wall
from rocking_cli.core import Direction, equivalent_block
from rocking_cli.core.structure_fields import DirectionalRestitution
from rocking_cli.excitation.base import GroundMotion
from tests.conftest import record
from tests.following import respond
from tests.reference_history import Nonlinear
from tests.unchecked import UncheckedArch

# What the tables and a local error of 1e-10 allow; most structures come ten times closer.
TIME, PEAK, RATE = 5e-10, 5e-10, 1e-8

LEANING = [[0.0, 0.0], [1.0, 0.0], [1.1, 3.0], [0.3, 3.2]]


@cache
def structure(name):
    if name == "block":
        return Block(width=0.7, height=2.8)
    if name == "wall":
        return Wall(thickness=0.3, height=3.0)
    if name == "leaning":
        return RigidBody(polygon=LEANING)
    if name == "arch":
        return UncheckedArch(radius=10.0, thickness=1.5, inclusion_angle_deg=157.5)  # of all its motion
    return AsymmetricFrame(
        column_width=1.0, left_height=6.0, right_height=7.5, spacing=8.0, beam_depth=1.0, density=2400.0, depth=1.0
    )


@cache
def scales(name):
    """Uplift acceleration [m/s2] and frequency parameter [rad/s], to choose records with."""
    block = equivalent_block(structure(name)).positive
    return block.lambda_ * structure(name).gravity, block.p


def pulse(name, amplitude=3.0, frequency=6.0):
    """One full sine in 24 samples that lifts the structure but does not overturn it."""
    threshold, p = scales(name)
    phase = np.linspace(0, 2 * pi, 25)
    return 2 * pi / (frequency * p) / 24, np.append(amplitude * threshold * np.sin(phase), 0.0)


def noise(name, seed, amplitude, npts=36):
    threshold, p = scales(name)
    return 0.1 / p, amplitude * threshold * np.random.default_rng(seed).normal(size=npts)


def nonlinear(mechanism, dt, samples, **options):
    motion = None if samples is None else GroundMotion("test", dt, np.asarray(samples, float), unit="m/s2")
    return respond(mechanism, motion, models=("nonlinear",), **options)["nonlinear"]


def agree(history, reference, phi_cr, time=TIME, peak=PEAK):
    """Impacts, in time and rate, and peaks of a history are those of the reference."""
    assert history.overturned == (reference.ended == "fallen")
    expected = np.array(reference.impacts).reshape(-1, 3)
    got = history.impacts[: len(expected)]
    assert got.shape == expected.shape
    np.testing.assert_array_equal(got[:, 1], expected[:, 1])
    np.testing.assert_allclose(got[:, 0], expected[:, 0], rtol=0, atol=time)
    fastest = expected[:, 2].max() if len(expected) else 1.0
    np.testing.assert_allclose(got[:, 2], expected[:, 2], rtol=0, atol=peak * fastest)
    for s, value in ((1, history.peak_positive), (-1, history.peak_negative)):
        if not np.isnan(value):
            assert value == pytest.approx(reference.peaks[s], rel=peak, abs=1e-13 * phi_cr)
    for s, value in ((1, history.peak_rate_positive), (-1, history.peak_rate_negative)):
        if not np.isnan(value):
            assert value == pytest.approx(reference.rates[s], rel=RATE)
    if history.overturned:
        assert history.overturning_time == pytest.approx(reference.crossings[-1], abs=time)
    if reference.uplift is None:
        assert np.isnan(history.uplift_time)
    else:
        assert history.uplift_time == pytest.approx(reference.uplift, abs=1e-14)


CASES = {
    "block, pulse": ("block", *pulse("block"), 0.0),
    "block, noise": ("block", *noise("block", 2, 2.0), 0.0),
    "block, noise from a release": ("block", *noise("block", 2, 1.5), -0.3),
    "block, overturning": ("block", *pulse("block", 1.6, 2.0), 0.0),
    "wall, noise": ("wall", *noise("wall", 3, 1.5), 0.0),
    "wall, pulse": ("wall", *pulse("wall", 2.5, 4.0), 0.0),
    "frame, pulse": ("frame", *pulse("frame"), 0.0),
    "frame, pulse the other way": ("frame", *pulse("frame", -3.0), 0.0),
    "frame, noise from a release": ("frame", *noise("frame", 2, 1.5, 24), 0.4),
    "frame, noise from a negative release": ("frame", *noise("frame", 2, 1.5, 24), -0.4),
    "arch, pulse": ("arch", *pulse("arch", 2.5, 4.0), 0.0),
    "arch, noise": ("arch", *noise("arch", 3, 1.5, 16), 0.2),
}


@pytest.mark.every(3)
@pytest.mark.parametrize("case", CASES)
def test_impacts_and_peaks_are_those_of_an_independent_integration(case):
    name, dt, samples, release = CASES[case]
    history = nonlinear(structure(name), dt, samples, release=release or None)
    reference = Nonlinear(structure(name)).follow(dt, samples, release)
    agree(history, reference, structure(name).critical_rotation(Direction.POSITIVE))


def test_a_smaller_tolerance_brings_the_block_to_rounding_error():
    # The tables of a block are exact to rounding, so only the steps are left.
    dt, samples = noise("block", 2, 2.0)
    history = nonlinear(structure("block"), dt, samples, rtol=1e-13)
    agree(history, Nonlinear(structure("block")).follow(dt, samples), 0.2, time=2e-12, peak=2e-12)


@pytest.mark.parametrize("polarity", [1, -1])
def test_the_frame_under_the_strong_part_of_a_real_record(polarity):
    samples = (
        np.array(record("Rinaldi228.AT2").read_text().split("\n", 4)[4].split(), float)[200:350]
        * 9.80665
        * polarity
        * 0.4
    )
    agree(nonlinear(structure("frame"), 0.01, samples), Nonlinear(structure("frame")).follow(0.01, samples), 0.1)


def released_amplitudes(equation, release, count):
    """Energy alone: the amplitude of each excursion after a release, with its direction."""
    s, amplitude = (1, release * equation.phi_cr[1]) if release > 0 else (-1, -release * equation.phi_cr[-1])
    found = [(s, amplitude)]
    for _ in range(count):
        rate = equation.eta[s] * sqrt(2 * equation.energy(amplitude, 0.0, s) / equation.inertia[s])
        s = -s
        kinetic = equation.inertia[s] * rate**2 / 2
        amplitude = brentq(
            lambda phi, s=s, kinetic=kinetic: equation.energy(phi, 0.0, s) - kinetic,
            0, equation.phi_cr[s], xtol=1e-16, rtol=1e-14,
        )  # fmt: skip
        found.append((s, amplitude))
    return found


@pytest.mark.parametrize("name", ["block", "wall", "frame", "leaning", "arch"])
@pytest.mark.parametrize("release", [0.8, -0.3])
def test_free_rocking_takes_the_quarter_periods_of_the_energy_integral(name, release):
    equation = Nonlinear(structure(name))
    history = nonlinear(structure(name), None, None, release=release)
    quarters = [equation.quarter(amplitude, s) for s, amplitude in released_amplitudes(equation, release, 3)]
    expected = np.cumsum([quarters[0], *(2 * quarter for quarter in quarters[1:])])
    np.testing.assert_allclose(history.impacts[:4, 0], expected, rtol=0, atol=TIME)


@pytest.mark.parametrize("model", ["linear1", "linear2"])
def test_free_rocking_of_the_linear_block_has_the_period_of_eq_24(model):
    slender = Block(width=0.2, height=4.0)
    block = equivalent_block(slender).positive
    history = respond(slender, models=(model,), release=0.7)[model]
    slack, expected, time = 0.3, [], 0.0
    for k in range(6):
        time += (1 if k == 0 else 2) * acosh(1 / slack) / block.p
        expected.append(time)
        slack = sqrt(1 - block.eta**2 * (1 - slack**2))  # 1 - phi/phi_cr of the next excursion
    np.testing.assert_allclose(history.impacts[:6, 0], expected, rtol=1e-13)


def test_a_slender_nonlinear_block_tends_to_eq_24():
    slender = Block(width=0.02, height=4.0)
    first = respond(slender, release=0.7)
    nonlinear_time, linear_time = first["nonlinear"].impacts[0, 0], first["linear1"].impacts[0, 0]
    assert nonlinear_time == pytest.approx(linear_time, rel=1e-5)
    assert nonlinear_time != pytest.approx(linear_time, rel=1e-8)


@pytest.mark.parametrize("name", ["block", "wall", "frame", "leaning", "arch"])
def test_energy_stays_between_impacts_and_drops_by_eta_at_each(name):
    equation = Nonlinear(structure(name))
    history = nonlinear(structure(name), None, None, release=0.9, tail=60.0)
    flight = np.searchsorted(history.impacts[:6, 0], history.time)
    levels = []
    for k in range(6):
        inside = np.flatnonzero(flight == k)[:: max(1, np.count_nonzero(flight == k) // 25)]
        s = 1 if k % 2 == 0 else -1
        assert (s * history.phi[inside] >= 0).all()
        energy = [
            equation.energy(phi, rate, s)
            for phi, rate in zip(abs(history.phi[inside]), history.rate[inside], strict=True)
        ]
        levels.append((s, np.array(energy)))
    start = levels[0][1][0]
    for s, energy in levels:
        np.testing.assert_allclose(energy, energy[0], rtol=0, atol=PEAK * start, err_msg=f"direction {s}")
    for (s, before), (after_s, after) in pairwise(levels):
        lost = equation.eta[s] ** 2 * equation.inertia[after_s] / equation.inertia[s]
        assert after[0] / before[0] == pytest.approx(lost, rel=20 * PEAK)


def test_restitution_acts_on_the_rate_of_rotation_not_on_theta():
    # Free flight gives back the rate it started with, so rates before successive impacts are in the ratio eta. The
    # two inertias and kappas differ, so eta on the energy or on theta would show.
    eta = DirectionalRestitution(positive_to_negative=0.9, negative_to_positive=0.6)
    frame = structure("frame").model_copy(update={"restitution": eta})
    equation = Nonlinear(frame)
    assert abs(equation.inertia[1] / equation.inertia[-1] - 1) > 1e-3
    for model, history in respond(frame, release=0.5).items():
        rates, sides = history.impacts[:8, 2], history.impacts[:8, 1]
        eta = np.where(sides[:-1] > 0, 0.9, 0.6)
        np.testing.assert_allclose(rates[1:] / rates[:-1], eta, rtol=1e-8, err_msg=model)


def arch(kind=Arch, **fields):
    return kind(radius=10.0, thickness=1.5, inclusion_angle_deg=157.5, **fields)


@pytest.mark.every(3)
@pytest.mark.parametrize(("amplitude", "release"), [(2.5, None), (1.4, None), (1.2, 0.1)])
def test_the_joints_that_are_checked_change_nothing_of_the_motion(amplitude, release):
    dt, samples = pulse("arch", amplitude, 5.0)
    free = nonlinear(arch(UncheckedArch, voussoirs=9), dt, samples, release=release)
    assert free.check is None and not free.unknown and np.isnan(free.opening)
    for opening in (1.0, 0.005, 0.0):
        history = nonlinear(arch(voussoirs=9), dt, samples, release=release, opening=opening)
        until = history.known_to if history.unknown else np.inf
        known = free.time <= until
        np.testing.assert_array_equal(history.phi[known[: history.time.size]], free.phi[known])
        np.testing.assert_array_equal(history.rate[known[: history.time.size]], free.rate[known])
        np.testing.assert_array_equal(history.impacts, free.impacts[free.impacts[:, 0] <= until])
        assert np.isnan(history.phi[history.time > until]).all()
        if history.unknown:
            assert history.lower_bound <= history.peak_ratio <= free.peak_ratio
        if not history.unknown:
            assert (history.peak_ratio, history.end_time, history.words) == (free.peak_ratio, free.end_time, free.words)


@pytest.mark.every(3)
@pytest.mark.parametrize(("amplitude", "limit"), [(2.5, 0.05), (1.4, 0.05), (1.1, 1.0)])
def test_joints_of_a_symmetric_structure_open_alike_under_the_reversed_record(amplitude, limit):
    dt, samples = pulse("arch", amplitude, 5.0)
    one, other = (nonlinear(arch(), dt, sign * samples, opening=limit) for sign in (1, -1))
    assert one.unknown == other.unknown == (limit < 1)
    assert other.warned == pytest.approx(one.warned, abs=1e-9) and np.isfinite(one.warned)
    assert other.known_to == pytest.approx(one.known_to, abs=1e-9, nan_ok=True)
    assert other.lower_bound == pytest.approx(one.lower_bound, rel=1e-6)
    assert other.opening == pytest.approx(one.opening, rel=1e-6) and one.opening > 0


@pytest.mark.parametrize("model", ["nonlinear", "linear1", "linear2"])
def test_a_mirrored_structure_answers_a_reversed_record_with_the_mirror_image(model):
    dt, samples = pulse("leaning", 2.5, 6.0)
    mirrored = RigidBody(polygon=[[-x, y] for x, y in reversed(LEANING)])
    one = respond(structure("leaning"), GroundMotion("test", dt, samples, unit="m/s2"), models=(model,), release=0.2)[
        model
    ]
    other = respond(mirrored, GroundMotion("test", dt, -samples, unit="m/s2"), models=(model,), release=-0.2)[model]
    assert not one.overturned
    assert other.peak_positive == pytest.approx(one.peak_negative, rel=1e-9)
    assert other.peak_negative == pytest.approx(one.peak_positive, rel=1e-9)
    np.testing.assert_allclose(other.impacts[:6, 0], one.impacts[:6, 0], rtol=0, atol=1e-9)
    # Both peaks mean something: the body leans, and its two directions differ.
    unmirrored = respond(
        structure("leaning"), GroundMotion("test", dt, -samples, unit="m/s2"), models=(model,), release=-0.2
    )[model]
    assert np.isnan(unmirrored.peak_positive) or unmirrored.peak_positive != pytest.approx(one.peak_negative, rel=1e-3)


@pytest.mark.parametrize("model", ["nonlinear", "linear1", "linear2"])
@pytest.mark.parametrize("k", [3.0, 0.1])
def test_a_block_k_times_larger_is_slower_by_the_root_of_k_and_otherwise_alike(model, k):
    dt, samples = noise("block", 2, 2.0)
    large = Block(width=0.7 * k, height=2.8 * k)
    one = respond(structure("block"), GroundMotion("test", dt, samples, unit="m/s2"), models=(model,))[model]
    other = respond(large, GroundMotion("test", dt * sqrt(k), samples, unit="m/s2"), models=(model,))[model]
    assert other.peak_ratio == pytest.approx(one.peak_ratio, rel=1e-8)
    np.testing.assert_allclose(other.impacts[:8, 0], sqrt(k) * one.impacts[:8, 0], rtol=1e-8)

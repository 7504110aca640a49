"""Histories in lock step are what each is alone, to the last bit, in any lane, beside any others."""

import os
from functools import cache

import numpy as np
import pytest
from numpy.polynomial import chebyshev

import rocking_cli as rk
from rocking_cli.dynamics import kernels, openings, stepping, ways
from rocking_cli.dynamics.calling import STEPS
from rocking_cli.dynamics.deck import fit_lanes, lay_out, run_deck, run_lanes
from rocking_cli.dynamics.tables import SMOOTH
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.names import RTOL
from rocking_cli.structure import build_models
from tests.conftest import PROJECT

SMOOTH_EXAMPLES = (
    "arch", "assembly", "block", "cone", "frame", "linkage", "point_mass", "rigid_body", "symmetric_frame", "wall",
    "linkages/beam_on_pier", "linkages/two_storeys", "masonry/portal", "masonry/wall_of_three", "walls/floor_wall",
)  # fmt: skip
ROUGH_EXAMPLES = ("curve", "verify/tied_facade", "walls/facade")
RUNS = int(os.environ.get("ROCKING_LANES", "400"))
"""How many random histories are compared; ROCKING_LANES is another number."""

pytestmark = pytest.mark.skipif(ways.lanes(STEPS) is None, reason="no lanes here: kernels run one by one")


@cache
def model_of(name):
    return build_models(rk.load_structure(PROJECT / "examples" / f"{name}.yaml"), ("nonlinear",))[0]


@cache
def motions():
    """A record, noise that keeps on, a pulse, and a short one that ends while all rock."""
    rng = np.random.default_rng(8)
    noise = np.convolve(rng.normal(size=900), np.hanning(12), "same")
    return (
        rk.read_record(PROJECT / "examples" / "accel.csv"),
        GroundMotion("noise", 0.02, 1.5 * noise, unit="m/s2"),
        rk.parse_pulse("sine:0.4g:0.8s").sampled(),
        GroundMotion("short", 0.01, np.array([0.0, 9.0, -9.0, 3.0]), unit="m/s2"),
    )


def random_runs(rng, models, count):
    """Rows of the kernel: any structure and record, strengths about that which lifts and far beyond, any size."""
    rows = np.zeros((count, kernels.RUN_COLUMNS))
    rows[:, kernels.STRUCTURE] = rng.integers(len(models), size=count)
    rows[:, kernels.RECORD] = rng.integers(len(motions()), size=count)
    lambdas = np.array([model.numbers[:, stepping.LAMBDA].min() for model in models])
    strongest = np.array([np.abs(motion.acceleration).max() for motion in motions()])
    uplift = lambdas[rows[:, kernels.STRUCTURE].astype(int)] * 9.80665 / strongest[rows[:, kernels.RECORD].astype(int)]
    rows[:, kernels.FACTOR] = (
        uplift * np.exp(rng.uniform(np.log(1.0001), np.log(12), count)) * rng.choice([-1, 1], count)
    )
    rows[:, kernels.SIZE] = np.where(rng.random(count) < 0.5, 1.0, np.exp(rng.uniform(-1, 2, count)))
    rows[:, kernels.SLENDER] = np.where(rng.random(count) < 0.7, 1.0, rng.uniform(0.8, 1.2, count))
    etas = np.where(rng.random(count) < 0.5, np.nan, rng.uniform(0.5, 0.99, count))
    rows[:, kernels.ETA_POSITIVE] = rows[:, kernels.ETA_NEGATIVE] = etas
    q_cr = np.array([model.numbers[0, stepping.Q_CR] for model in models])[rows[:, kernels.STRUCTURE].astype(int)]
    rows[:, kernels.START] = np.where(rng.random(count) < 0.9, 0.0, rng.uniform(-0.9, 0.9, count)) * q_cr
    rows[:, kernels.LOOSE] = rng.random(count) < 0.05
    return rows


def marks_of(run, deck, rows, most_impacts=20_000):
    marks = np.full((len(rows), stepping.MARKS), np.nan)
    run(deck, rows, marks, 0, len(rows), rtol=RTOL, most_impacts=most_impacts)
    return marks


@pytest.mark.parametrize("most_impacts", [2, 20_000])
def test_any_mixture_has_the_bits_of_each_history_alone(most_impacts):
    models = [model_of(name) for name in SMOOTH_EXAMPLES]
    deck, rows = lay_out(models, motions()), random_runs(np.random.default_rng(1), models, RUNS)
    assert fit_lanes(deck, rows).all()
    alone = marks_of(run_deck, deck, rows, most_impacts)
    assert np.array_equal(marks_of(run_lanes, deck, rows, most_impacts), alone, equal_nan=True)
    order = np.random.default_rng(2).permutation(len(rows))
    assert np.array_equal(marks_of(run_lanes, deck, rows[order], most_impacts), alone[order], equal_nan=True)
    status = alone[:, stepping.STATUS]
    kinds = {kernels.AT_REST, kernels.OVERTURNED, kernels.LEFT} | (
        {kernels.STILL_ROCKING} if most_impacts == 2 else set()
    )
    assert kinds <= {*status} and 0.1 < (status == kernels.OVERTURNED).mean() < 0.9
    assert (alone[:, stepping.IMPACTS] > 5).mean() > 0.3


@pytest.mark.parametrize("level", [each for each in ways.usable() if each.startswith("v")])
def test_all_levels_of_processors_have_the_same_bits(level):
    models = [model_of(name) for name in SMOOTH_EXAMPLES]
    deck, rows = lay_out(models, motions()), random_runs(np.random.default_rng(3), models, 40)
    with ways.forced(level):
        assert np.array_equal(marks_of(run_lanes, deck, rows), marks_of(run_deck, deck, rows), equal_nan=True)


def test_hops_far_below_a_millionth_and_dips_inside_a_step_are_those_of_each_alone():
    """A ground that hardly lifts: peaks that are nearly rounding, and steps in which q goes below rest and back."""
    model = model_of("block")
    deck, rows = lay_out([model], motions()), random_runs(np.random.default_rng(4), [model], 200)
    rows[:, kernels.START], rows[:, kernels.SLENDER], rows[:, kernels.SIZE], rows[:, kernels.LOOSE] = 0, 1, 1, 0
    strongest = np.array([np.abs(motion.acceleration).max() for motion in motions()])
    uplift = model.numbers[0, stepping.LAMBDA] * 9.80665 / strongest[rows[:, kernels.RECORD].astype(int)]
    rows[:, kernels.FACTOR] = uplift * (1 + np.exp(np.random.default_rng(5).uniform(-18, -3, len(rows))))
    alone = marks_of(run_deck, deck, rows)
    assert np.array_equal(marks_of(run_lanes, deck, rows), alone, equal_nan=True)
    ratios = alone[:, stepping.PEAK : stepping.PEAK + 2].max(axis=1) / model.phi_cr[0]
    assert (ratios < 1e-6).sum() > 20 and (ratios > 0).mean() > 0.5


def test_joints_that_open_beyond_phi_cr_close_at_an_impact_of_a_loose_structure_as_alone():
    """An impact that presses all joints together is none of theirs, though the outcome is unknown from it on."""
    model, rng, pulse, count = model_of("masonry/portal"), np.random.default_rng(4), 2, 800
    deck, rows = lay_out([model], motions()), random_runs(np.random.default_rng(9), [model], count)
    rows[:, kernels.LOOSE], rows[:, kernels.START], rows[:, kernels.RECORD] = 1, 0, pulse
    uplift = model.numbers[:, stepping.LAMBDA].min() * 9.80665 / np.abs(motions()[pulse].acceleration).max()
    rows[:, kernels.FACTOR] = uplift * np.random.default_rng(3).uniform(3, 9, count) * rng.choice([-1, 1], count)
    alone = marks_of(run_deck, deck, rows)
    assert np.array_equal(marks_of(run_lanes, deck, rows), alone, equal_nan=True)
    assert (alone[:, openings.WARNED] < alone[:, openings.PASSED]).any()  # it opens before it comes down


@pytest.mark.parametrize("name", SMOOTH_EXAMPLES)
def test_polynomials_are_the_forces(name):
    """Between the places that they were fitted at, and by the mechanism, not by the tables."""
    model = model_of(name)
    mechanism = rk.load_structure(PROJECT / "examples" / f"{name}.yaml")
    for d, (direction, table) in enumerate(zip(mechanism.sides, model.tables, strict=True)):
        pairs, per_reach = int(model.numbers[d, stepping.PAIRS]), model.numbers[d, stepping.PER_REACH]
        q = np.random.default_rng(6).uniform(0, 2 / per_reach, 300)
        at = mechanism.coefficients(table.phi(q), direction)
        exact = np.array([at.restoring(mechanism.gravity), at.B]) / np.sqrt(at.I)
        y, powers = q * per_reach - 1, model.smooth[d].reshape(-1, 2, 2)[:pairs].transpose(1, 0, 2).reshape(2, -1)
        values = np.array([np.polynomial.polynomial.polyval(y, each) for each in powers])
        missed = np.abs(values - exact).max(axis=1) / np.abs(exact).max(axis=1)
        assert pairs > 0 and (missed <= 2 * SMOOTH).all()


@pytest.mark.parametrize("name", ROUGH_EXAMPLES)
def test_what_no_polynomial_follows_keeps_its_tables(name):
    model = model_of(name)
    deck = lay_out([model], motions()[:1])
    rows = random_runs(np.random.default_rng(7), [model], 4)
    rows[:, kernels.RECORD] = 0
    assert not model.numbers[:, stepping.PAIRS].any() and not fit_lanes(deck, rows).any()


def test_coefficients_that_are_zero_are_powers_that_are_zero(monkeypatch):
    """By the rounding of a processor the last ones may be; it ended with an error."""
    fit = chebyshev.chebfit
    monkeypatch.setattr(chebyshev, "chebfit", lambda *of: np.where(abs(made := fit(*of)) > 1e-13, made, 0.0))
    one, other = build_models(rk.Block(width=0.7, height=2.8), ("nonlinear",))[0], model_of("block")
    np.testing.assert_allclose(one.smooth, other.smooth, atol=1e-9)
    assert one.numbers[0, stepping.PAIRS] == other.numbers[0, stepping.PAIRS] > 0

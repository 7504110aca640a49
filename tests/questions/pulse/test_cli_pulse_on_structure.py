"""`rocking pulse` on a structure, and its messages if it cannot do what is requested."""

import re
from functools import partial

import pytest
from pytest import approx

from rocking_cli import load_structure
from rocking_cli.core import equivalent_block
from rocking_cli.dynamics.exact import closed_form, exact_response
from rocking_cli.excitation.pulses import parse_pulse
from tests.cli.test_cli import run as command
from tests.cli.test_cli import run_json as command_json
from tests.conftest import EXAMPLES
from tests.following import respond
from tests.pulses import exact_pulse

FRAME = str(EXAMPLES / "frame.yaml")


@pytest.fixture
def block(tmp_path):
    path = tmp_path / "block.yaml"
    path.write_text("mechanism: block\nname: tower\nwidth: 0.7\nheight: 2.8\nrestitution: 0.9\n")
    return str(path)


run, run_json = partial(command, "pulse"), partial(command_json, "pulse")


def test_every_answer_is_that_of_the_library(block):
    got, structure = run_json(block, "--ag", "392gal", "--period", 0.5), load_structure(block)
    one, pulse = equivalent_block(structure).positive, parse_pulse("sine:3.92m/s2:0.5s")
    for k, lam in ((1, one.lambda_lin), (2, one.lambda_)):
        direction, found = got["directions"]["positive"], got["responses"][f"linear{k}"]
        assert direction[f"a{k}"] == approx(3.92 / (structure.gravity * lam))
        exact = exact_response(equivalent_block(structure), pulse, kappa=k, gravity=structure.gravity)
        bare = exact_pulse(direction[f"a{k}"], direction["omega"], 0.9)
        for name in ("peak_ratio", "peak_positive", "first_excursion", "first_rebound", "first_impact"):
            assert found[name] == approx(getattr(exact, name), rel=1e-12)
        assert found["peak_ratio"] == approx(bare.max_ratio, rel=1e-10)
        closed, said = closed_form(direction[f"a{k}"], direction["omega"], 0.9), got["closed_form"][f"linear{k}"]
        assert said["conditions"] == closed.conditions
        assert said["max_ratio"] == closed.max_ratio
        assert said["off_first_rebound"] == approx(closed.printed_ratio - bare.first_rebound, abs=1e-10)
        assert said["off_peak_ratio"] == approx(closed.printed_ratio - bare.max_ratio, abs=1e-10)
        assert found["over_nonlinear"] == found["peak_ratio"] / got["responses"]["nonlinear"]["peak_ratio"]
    assert not got["responses"]["nonlinear"]["exact"]
    words = " ".join(run(block, "--ag", "392gal", "--period", 0.5).stdout.split())
    for name in ("linear1", "linear2"):
        way = "higher" if got["responses"][name]["over_nonlinear"] > 1 else "lower"
        assert re.search(rf"By {name} its peak is [\d.]+ % {way}", words)
    fine = respond(structure, pulse.sampled(20_000), models=("nonlinear",), tail=0.0)["nonlinear"]
    assert got["responses"]["nonlinear"]["peak_ratio"] == approx(fine.peak_ratio, rel=1e-6)


def test_where_the_closed_form_holds_it_is_the_first_rebound(block):
    one = equivalent_block(load_structure(block)).positive
    period = 6.283185307179586 / (6 * one.p)
    got = run_json(block, "--ag", f"{4 * one.lambda_ * 9.80665!r}m/s2", "--period", period)
    closed = got["closed_form"]["linear2"]
    assert closed["valid"]
    assert closed["off_first_rebound"] == approx(0, abs=1e-12)
    said = run(block, "--ag", f"{4 * one.lambda_ * 9.80665!r}m/s2", "--period", period, "--all").stdout
    assert "linear2: all conditions are met, so the closed form can be used" in said


def test_where_it_fails_the_condition_and_the_difference_are_said(block):
    said = " ".join(run(block, "--ag", "0.4g", "--period", 0.5, "--all").stdout.split())
    assert "do not use the closed form here, because it holds only where the first impact comes after the pulse" in said
    got = run_json(block, "--ag", "0.4g", "--period", 0.5)["closed_form"]["linear1"]
    assert got["max_ratio"] is None and got["reason"] in said
    assert f"Eq. 41 gives {got['printed_ratio']:.4g}" in said
    assert f"{got['off_peak_ratio']:.3g}" in said


def test_both_directions_of_an_asymmetric_structure_and_both_polarities():
    got = run_json(FRAME, "--ag", "0.4g", "--period", 0.8, "--polarity", "both")
    assert got["closed_form"] is None
    assert got["directions"]["positive"]["omega"] != got["directions"]["negative"]["omega"]
    assert set(got["polarities"]) == {"1", "-1"}
    for polarity in (1, -1):
        alone = run_json(FRAME, "--ag", "0.4g", "--period", 0.8, "--polarity", polarity)
        assert alone["responses"] == got["polarities"][str(polarity)]["responses"]
    first, other = (got["polarities"][sign]["responses"]["linear2"]["peak_ratio"] for sign in ("1", "-1"))
    assert first != other
    said = run(FRAME, "--ag", "0.4g", "--period", 0.8, "--polarity", "both", "--all").stdout
    nonlinear = [got["polarities"][sign]["responses"]["nonlinear"]["peak_ratio"] for sign in ("1", "-1")]
    for line, words, peak in zip(said.splitlines(), ("1: as given", "-1: reversed"), nonlinear, strict=False):
        assert line.startswith(f"Polarity {words}. The structure rocks to {peak:.4g} of its critical rotation")
    assert "No closed form: Eqs. 41-42 apply to a structure with the same properties in both directions." in said


def test_a_shape_that_is_no_chain_of_sines_is_sampled_and_that_is_said(block):
    arguments = (block, "--ag", "0.5g", "--period", 0.6, "--shape", "ricker")
    got = run_json(*arguments)
    assert [each["exact"] for each in got["responses"].values()] == [False] * 3
    assert got["closed_form"] is None
    assert (
        "no exact solution either: the linear models are simulated under the sampled pulse."
        in run(*arguments, "--all").stdout
    )
    fine = respond(load_structure(block), parse_pulse("ricker:0.5g:0.6s").sampled(20_000), tail=0.0)
    for name, history in fine.items():
        assert got["responses"][name]["peak_ratio"] == approx(history.peak_ratio, rel=1e-4)


def test_too_weak_a_pulse_is_an_answer(block):
    said = run(block, "--ag", "0.1g", "--period", 0.8, "--all").stdout
    assert said.startswith("The structure does not uplift.\n")
    assert "No closed form: by the equivalent blocks, the structure does not uplift (a <= 1)." in said
    got = run_json(block, "--ag", "0.1g", "--period", 0.8)
    assert {each["peak_ratio"] for each in got["responses"].values()} == {0.0}


def test_overturning_is_an_answer(block):
    got = run_json(block, "--ag", "1g", "--period", 1.5)["responses"]
    for each in got.values():
        assert each["overturned"]
        assert each["peak_ratio"] is None
        assert each["over_nonlinear"] is None
    assert "The structure overturns anticlockwise, without impact." in run(block, "--ag", "1g", "--period", 1.5).stdout


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((), "--ag is missing for a pulse on a structure such as 0.6g"),
        (("--a", 2, "--omega", 3, "--ag", "0.4g"), "--ag has no effect on the dimensionless block, which --a"),
        (
            (EXAMPLES / "block.yaml", "--a", 2, "--omega", 3),
            "for a structure, give --ag = a lambda g and --period = 2 pi/(omega p)",
        ),
        (("--ag", "0.6", "--period", 0.8), "'0.6' has no unit: give one of g, m/s2"),
        (("--ag=-0.6g", "--period", 0.8), "--polarity -1 reverses the pulse"),
        (("--ag", "0.6g", "--period", 1, "--shape", "sine:3"), "expected sine:AMPLITUDE:PERIOD"),
        (("--a", 2, "--omega", 3, "--shape", "ricker"), "for other shapes, give a structure, --ag and --period"),
        (("--a", 2, "--omega", -3), "-3 is not a positive number"),
    ],
)
def test_wrong_input_is_refused_with_the_way_out(arguments, words):
    assert words in " ".join(run(*arguments, code=2).stderr.split())


def test_too_stocky_a_structure_is_refused_with_the_reason(tmp_path):
    path = tmp_path / "stocky.yaml"
    path.write_text("mechanism: block\nwidth: 3\nheight: 1\n")
    assert "give a measured value as restitution" in run(path, "--ag", "9g", "--period", 1, code=2).stderr


@pytest.mark.parametrize("shape", ["cosine", "rectangular"])
def test_the_dimensionless_block_takes_other_shapes_without_a_closed_form(shape):
    got = run_json("--a", 2, "--omega", 8, "--shape", shape)
    assert got["shape"] == shape
    assert got["closed_form"] is None
    assert got["exact"]["max_ratio"] == exact_pulse(2, 8, 0.9, shape).max_ratio
    assert "No closed form exists for this shape" in run("--a", 2, "--omega", 8, "--shape", shape).stdout

"""Equivalent pulses: similar structures do the same, others nearly."""

import json
from functools import partial

import numpy as np
import pytest

from mechanisms.block import Block
from mechanisms.symmetric_frame import SymmetricFrame
from rocking_cli.core import Direction, equivalent_block
from rocking_cli.core.structure_file import load_structure, parse_structure
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.excitation.pulses import parse_pulse
from rocking_cli.names import OPENING
from rocking_cli.plotting import style
from rocking_cli.questions.equivalent_pulses.verb import draw, judge, under_equivalent_pulses
from rocking_cli.structure import Structure
from tests.cli.test_cli import run as command
from tests.conftest import EXAMPLES, rows_of
from tests.following import respond
from tests.pulses import exact_pulse

PULSE = parse_pulse("sine:0.6g:0.5s")


def equivalent(mechanisms, *given, opening=OPENING, **more):
    return under_equivalent_pulses([Structure(each, opening=opening) for each in mechanisms], *given, **more)


SMALL, LARGE = Block(name="small", width=0.7, height=2.8), Block(name="large", width=7.0, height=28.0)
BLOCK, WALL, FRAME = (str(EXAMPLES / f"{name}.yaml") for name in ("block", "wall", "frame"))
run = partial(command, "equivalent_pulses")


def test_similar_blocks_do_the_same_over_p_t():
    found = equivalent([SMALL, LARGE], PULSE)
    one, other = (each.history for each in found.members)
    size = min(one.ratio.size, other.ratio.size)
    np.testing.assert_allclose(one.ratio[:size], other.ratio[:size], atol=1e-7)
    assert found.spread < 1e-9
    assert found.members[1].pulse.amplitude == pytest.approx(0.6 * STANDARD_GRAVITY)
    assert found.members[1].pulse.period == pytest.approx(0.5 * np.sqrt(10))
    assert "they are equivalent." in " ".join(judge(found))


def test_a_symmetric_frame_does_what_the_block_of_its_alpha_and_p_does():
    frame = SymmetricFrame(name="frame", column_width=0.7, column_height=2.8, mass_ratio=1.5)
    found = equivalent([SMALL, frame], PULSE)
    block, of_frame = (each.block for each in found.members)
    assert of_frame.p != pytest.approx(block.p, rel=0.01) and of_frame.lambda_ == pytest.approx(block.lambda_)
    assert found.spread == pytest.approx(0, abs=1e-8)


def test_each_pulse_has_the_same_a_and_omega():
    structures = [load_structure(file) for file in (BLOCK, WALL, FRAME)]
    found = equivalent(structures, PULSE)
    for structure, each in zip(structures, found.members, strict=True):
        block = equivalent_block(structure)[found.direction]
        assert each.pulse.amplitude / (structure.gravity * block.lambda_) == pytest.approx(found.a)
        assert 2 * np.pi / (each.pulse.period * block.p) == pytest.approx(found.omega)
    assert found.members[0].pulse == PULSE


def test_a_response_is_that_of_respond_under_its_own_pulse():
    found = equivalent([load_structure(BLOCK), load_structure(WALL)], PULSE, eta="own")
    wall = found.members[1]
    alone = respond(load_structure(WALL), wall.pulse.sampled(), models=("nonlinear",))["nonlinear"]
    assert wall.history.peak_ratio == alone.peak_ratio
    assert wall.eta == wall.block.eta == equivalent_block(load_structure(WALL))[found.direction].eta


def test_the_linear_answer_is_the_exact_one():
    found = equivalent([SMALL, LARGE], PULSE)
    exact = exact_pulse(found.a, found.omega, found.members[0].eta)
    assert found.alone.peak_ratio == pytest.approx(exact.max_ratio, rel=1e-9)
    assert found.linear.peak_ratio == pytest.approx(exact.max_ratio, rel=1e-3)  # on samples
    assert found.relative_spread == pytest.approx(found.spread / exact.max_ratio)


def test_kappa1_keeps_the_other_lambda():
    found = equivalent([SMALL, load_structure(FRAME)], PULSE, kappa=1)
    frame = found.members[1]
    assert frame.block.lambda_lin != pytest.approx(frame.block.lambda_, rel=1e-3)
    assert frame.pulse.amplitude == pytest.approx(found.a * frame.block.lambda_lin * load_structure(FRAME).gravity)


class TestRestitution:
    def test_all_have_that_of_the_first_unless_told_otherwise(self):
        wall = load_structure(WALL)
        first, own, given = (equivalent([SMALL, wall], PULSE, eta=eta) for eta in ("first", "own", 0.8))
        assert [each.eta for each in first.members] == [equivalent_block(SMALL).positive.eta] * 2
        assert own.members[1].eta == equivalent_block(wall).positive.eta
        assert [each.eta for each in given.members] == [0.8, 0.8]
        assert "same value for all" in " ".join(judge(own))
        assert "same value for all" not in " ".join(judge(first))
        assert len({each.members[1].history.peak_ratio for each in (first, own, given)}) == 3

    def test_one_that_cannot_be_used_is_refused(self):
        stocky = Block(width=4.0, height=2.0)
        with pytest.raises(InputError, match="`restitution`"):
            equivalent([stocky, SMALL], parse_pulse("sine:3g:0.5s"))
        equivalent([stocky, SMALL], parse_pulse("sine:3g:0.5s"), eta=0.7)
        with pytest.raises(InputError, match=r"eta. must be in"):
            equivalent([SMALL, LARGE], PULSE, eta=1.5)


class TestDirection:
    def test_it_is_the_one_that_the_pulse_lifts_first(self):
        frame = load_structure(FRAME)
        assert equivalent([frame, SMALL], PULSE).direction is Direction.NEGATIVE
        found = equivalent([frame, SMALL], PULSE, polarity=-1)
        assert found.direction is Direction.POSITIVE
        assert found.members[0].block == equivalent_block(frame).positive
        assert found.turned(found.members[0].history)[80] > 0

    def test_a_weak_pulse_may_lift_the_other_one_only(self):
        frame = load_structure(FRAME)
        blocks = equivalent_block(frame)
        weaker, other = sorted((blocks.positive.lambda_, blocks.negative.lambda_))
        between = parse_pulse(f"sine:{(weaker + other) / 2}g:1s")
        expected = Direction.POSITIVE if blocks.positive.lambda_ == weaker else Direction.NEGATIVE
        assert all(equivalent([frame, SMALL], between, polarity=sign).direction is expected for sign in (1, -1))


class TestVerdict:
    def test_where_some_overturn_and_others_do_not_it_breaks(self):
        found = equivalent([load_structure(file) for file in (BLOCK, WALL)], parse_pulse("sine:0.5g:0.65s"))
        assert {each.history.fell for each in found.members} == {True, False}
        assert np.isnan(found.spread)
        text = " ".join(judge(found))
        assert "the equivalence breaks" in text and "overturn" in text

    def test_where_all_overturn_that_is_said(self):
        found = equivalent([SMALL, LARGE], parse_pulse("sine:2g:1s"))
        assert judge(found) == ["The linear block overturns, and so do all structures."]

    def test_far_apart_is_a_break(self):
        found = equivalent([load_structure(BLOCK), load_structure(WALL)], PULSE, eta="own")
        assert found.relative_spread > 0.2
        assert "storey wall is the farthest" in " ".join(judge(found))


class TestCommand:
    def test_json_and_csv(self):
        result = run(BLOCK, WALL, "--ag", "0.6g", "--period", 0.5, "--json", "--out", "e.csv")
        (line,) = result.stdout.splitlines()
        data = json.loads(line)
        assert set(data) == {
            "pulse", "polarity", "kappa", "a", "omega", "direction", "structures", "linear_peak_ratio", "spread",
            "relative_spread", "verdict", "given",
        }  # fmt: skip
        assert set(data["structures"][1]) == {
            "mechanism", "name", "p", "lambda", "lambda_lin", "ag", "period", "eta", "own_eta", "peak_ratio",
            "overturned", "unknown", "known_to", "known_to_reason", "peak_lower_bound", "opening", "caution",
        }  # fmt: skip
        assert data["structures"][0]["ag"] == pytest.approx(0.6)
        rows = rows_of("e.csv")
        by_name = {
            name: [row for row in rows if row["structure"] == name] for name in {each["structure"] for each in rows}
        }
        assert "linear block" in by_name and len(by_name) == 3
        for each in data["structures"]:
            row = by_name[each["name"]][100]
            assert float(row["t [s]"]) * each["p"] == pytest.approx(float(row["p_t"]))
        peaks = [max(abs(float(row["phi_ratio"] or 0)) for row in by_name[each["name"]]) for each in data["structures"]]
        assert peaks == pytest.approx([each["peak_ratio"] for each in data["structures"]], rel=1e-3)

    def test_pulses_too_weak_to_lift_are_a_result(self, tmp_path):
        arguments = [BLOCK, FRAME, "--ag", "0.1g", "--period", "1"]
        data = json.loads(run(*arguments, "--plot", "weak.png", "--out", "weak.csv", "--json").stdout)
        assert data["a"] == pytest.approx(0.1 / 0.25) and data["linear_peak_ratio"] == 0
        assert [each["peak_ratio"] for each in data["structures"]] == [0, 0] and data["relative_spread"] is None
        assert "does not uplift (a = 0.4, uplift needs a > 1), nor does any structure" in data["verdict"]
        assert "does not uplift" in run(*arguments).stdout

    @pytest.mark.parametrize(
        ("arguments", "complaint"),
        [
            ([BLOCK, "--ag", "1g", "--period", "1"], "FILE must have at least 2 entries, has 1"),
            ([BLOCK, WALL, "--period", "1"], "--ag is missing for a pulse"),
            ([BLOCK, WALL, "--ag", "1g"], "--period is missing for a pulse"),
            (
                [BLOCK, WALL, "--ag", "0.6g", "--period", "1", "--restitution", "0"],
                "is not valid: give a number above 0",
            ),
        ],
    )
    def test_wrong_input_is_told_and_nothing_is_written(self, arguments, complaint, tmp_path):
        assert complaint in " ".join(run(*arguments, "--plot", "left.png", "--out", "left.csv", code=2).stderr.split())
        assert list(tmp_path.iterdir()) == []


def test_the_picture_has_the_pulses_above_and_the_responses_below():
    wall = parse_structure("mechanism: wall\nheight: 1\nthickness: 0.2\n", "w", "w")
    found = equivalent([SMALL, LARGE, wall], PULSE, opening=1.0)
    above, below = draw(found).axes
    assert "[g]" in above.get_ylabel() and "time [s]" in above.get_xlabel()
    curves = {line.get_label(): line for line in below.get_lines() if not line.get_label().startswith("_")}
    assert list(curves) == ["small", "large", "w", "linear block of all", "end of the pulses"]
    np.testing.assert_array_equal(curves["small"].get_ydata(), found.turned(found.members[0].history))
    assert len({line.get_linestyle() for line in above.get_lines()}) == 3
    assert not below.get_legend()  # it would lie on the curves
    (key,) = below.figure.legends
    assert [each.get_text() for each in key.get_texts()] == list(curves)


def test_what_is_not_known_is_not_drawn_as_if_it_were():
    wall = parse_structure("mechanism: wall\nheight: 1\nthickness: 0.2\n", "w", "w")
    found = equivalent([SMALL, wall], PULSE)
    history = found.members[1].history
    assert history.unknown
    _, below = draw(found).axes
    curves = {line.get_label(): line for line in below.get_lines()}
    curve = curves[f"w, unknown after {history.known_to:.3g} s (open circle)"]
    drawn = np.asarray(curve.get_xdata(), float)[np.isfinite(np.asarray(curve.get_ydata(), float))]
    assert drawn.size and drawn.max() <= equivalent_block(wall).positive.p * history.known_to * (1 + 1e-9)
    (end,) = [line for line in below.get_lines() if line.get_marker() == "o" and len(line.get_xdata()) == 1]
    assert end.get_markerfacecolor() == style.PAPER and end.get_xdata()[0] == pytest.approx(drawn.max())


def test_a_fall_is_cut_off_with_a_cross():
    found = equivalent([SMALL, LARGE], parse_pulse("sine:2g:1s"))
    _, below = draw(found).axes
    assert sum(line.get_marker() == "x" for line in below.get_lines()) == 2
    assert "small, overturns" in [line.get_label() for line in below.get_lines()]
    assert max(abs(np.asarray(line.get_ydata())).max() for line in below.get_lines()) <= 1.5

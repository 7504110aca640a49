"""Shares of overturning over the factor: against histories followed one by one, and what is said against the shares."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest

from rocking_cli.dynamics.history import respond
from rocking_cli.dynamics.model import build_model, build_models
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.pulses import parse_pulse
from rocking_cli.plotting.margin import draw_margins
from rocking_cli.structure import load_structure, parse_structure
from rocking_cli.studies import margin as margins
from rocking_cli.studies.margin import FACTORS, LEVELS, Margin, in_words, margin
from rocking_cli.studies.neighbours import Around
from tests.conftest import EXAMPLES
from tests.test_cli import run, run_json

BLOCK = parse_structure("mechanism: block\nwidth: 0.7\nheight: 2.8\n", "block", "block")
CORNERS = "mechanism: rigid_body\npolygon: [[0, 0], [0.7, 0], [0.69, 2.8], [0, 2.8]]\n"
FRAME = load_structure(EXAMPLES / "frame.yaml")
AROUND = Around(20)


def falls(mechanism, motion, factor, etas):
    given = {"positive_to_negative": etas[0], "negative_to_positive": etas[1]}
    alone = type(mechanism).model_validate({**mechanism.model_dump(), "restitution": given})
    return respond(alone, motion.scaled(factor), models=("nonlinear",))["nonlinear"].overturned


def share(mechanism, motion, factor, polarities):
    """The share next to one factor, of the worse polarity, each neighbour followed alone."""
    model = build_model(mechanism, "nonlinear")
    etas, polarities = AROUND.etas(model), polarities[:1] if model.symmetric else polarities
    draws = list(zip(factor * AROUND.factors(), etas, strict=True))
    return max(np.mean([falls(mechanism, motion, sign * each, eta) for each, eta in draws]) for sign in polarities)


@pytest.mark.parametrize("polarities", [(-1,), (1, -1)])
@pytest.mark.parametrize(
    ("mechanism", "pulse"), [(BLOCK, "sine:0.8g:0.5s"), (FRAME, "sine:0.3g:3s")], ids=["block", "frame"]
)
def test_the_shares_are_those_of_neighbours_followed_alone(mechanism, pulse, polarities):
    motion = parse_pulse(pulse).sampled()
    found = margin(build_model(mechanism, "nonlinear"), motion, polarities, around=AROUND)
    partly = np.flatnonzero((found.overturned > 0) & (found.overturned < 1))
    assert found.factors.tolist() == sorted([*FACTORS, 1.0]) and partly.size
    for k in [0, *partly[:2], partly[-1], FACTORS.size]:
        assert found.overturned[k] == share(mechanism, motion, found.factors[k], polarities)
    assert found.itself == share(mechanism, motion, 1.0, polarities)


def test_a_reversed_motion_is_followed_only_where_it_can_add_something(monkeypatch):
    followed, done = [], []
    follow = margins.follow
    monkeypatch.setattr(margins, "follow", lambda *a, **k: followed.append(len(a[2])) or follow(*a, **k))
    motion = parse_pulse("sine:0.8g:0.5s").sampled()
    every = 61 * AROUND.count
    # A little heavier at one side, so that a reversed motion is another one.
    leaning = parse_structure(CORNERS, "leaning", "leaning")
    model = build_model(leaning, "nonlinear")
    one = margin(model, motion, (1,), around=AROUND)
    certain = int((one.overturned == 1).sum())
    for each, again in ((BLOCK, 0), (leaning, 61 - certain)):
        followed.clear()
        done.clear()
        margin(build_model(each, "nonlinear"), motion, (1, -1), around=AROUND, progress=done.append)
        assert followed == [every, again * AROUND.count]
        assert sum(done) == 2 * every
    assert certain > 10


@pytest.mark.parametrize(
    ("name", "alike"), [("block", True), ("arch", True), ("wall", True), ("frame", False), ("rigid_body", False)]
)
def test_symmetric_structures_are_known(name, alike):
    models = build_models(load_structure(EXAMPLES / f"{name}.yaml"))
    assert {each.name: each.symmetric for each in models} == dict.fromkeys(("nonlinear", "linear1", "linear2"), alike)


def test_sixty_factors_from_a_fifth_to_five():
    assert FACTORS.size == 60 and FACTORS[0] == pytest.approx(0.2) and FACTORS[-1] == pytest.approx(5)


def made(*shares) -> Margin:
    return Margin(AROUND, 0.5, np.arange(1.0, len(shares) + 1), np.array(shares, dtype=float))


class TestLevels:
    def test_first_and_last(self):
        found = made(0.0, 0.2, 0.6, 0.3, 0.6, 1.0)
        assert [found.first(level) for level in LEVELS] == [2.0, 3.0, 6.0]
        assert [found.last_below(level) for level in LEVELS] == [1.0, 4.0, 5.0]
        assert found.islands(0.5) == [(3.0, 3.0), (5.0, 6.0)]

    def test_none_and_all(self):
        assert made(0, 0).first(0.1) is None and made(0, 0).last_below(0.1) == 2.0
        assert made(1, 1).first(0.9) == 1.0 and made(1, 1).last_below(0.9) is None
        assert made(1, 1).islands(0.9) == [(1.0, 2.0)] and made(0, 0).islands(0.1) == []


class TestWords:
    def test_no_factor_overturns(self):
        assert in_words(made(0, 0.05, 0), 0.5) == (
            "At no scale factor from 1 to 3 (PGA from 0.5 g to 1.5 g) do 10 % or more of the neighbouring motions "
            "overturn the structure."
        )

    def test_each_level_in_turn(self):
        assert in_words(made(0, 0.2, 0.6), 0.4) == (
            "At least 10 % of the neighbouring motions first overturn the structure at a factor of 2 (PGA 0.8 g), "
            "50 % at 3 (1.2 g) and 90 % at none up to 3; the factors tried are 75 % apart."
        )

    def test_islands_are_told(self):
        assert in_words(made(0, 0.2, 0.0, 1.0), 0.5).endswith(
            "A stronger motion is not always worse: at a factor of 3 (1.5 g) none does."
        )
        assert in_words(made(0, 0.6, 0.3, 1.0), 0.5).endswith("always worse: at a factor of 3 (1.5 g) only 30 % do.")
        assert in_words(made(0, 0.6, 1.0, 0.7, 0.8), 0.5).endswith("always worse: at a factor of 4 (2 g) only 70 % do.")
        assert "always worse" not in in_words(made(0, 0.2, 0.6, 1.0), 0.5)

    def test_the_numbers_are_those_of_the_shares(self):
        motion = parse_pulse("ricker:0.7g:0.9s").sampled()
        found = margin(build_model(BLOCK, "nonlinear"), motion, around=AROUND)
        words = in_words(found, motion.pga).split("; the factors")[0]
        said = re.findall(
            r"(\d+) % (?:[a-z ]* first overturn the structure )?at (?:a factor of )?([\d.]+) \((?:PGA )?([\d.]+) g\)",
            words,
        )
        assert [level for level, *_ in said] == ["10", "50", "90"]
        for level, factor, pga in said:
            k = int(np.abs(found.factors - float(factor)).argmin())
            assert float(pga) == pytest.approx(0.7 * found.factors[k], rel=5e-3)
            assert found.overturned[k] >= int(level) / 100 > found.overturned[:k].max()


@pytest.mark.parametrize("polarities", [(1,), (-1,), (1, -1)])
def test_uplift_is_a_quotient(polarities):
    """A ground acceleration to the left lifts a block clockwise, at tan(alpha) g."""
    motion = GroundMotion("two pushes", 0.1, np.array([0.0, 4.0, 0.0, -2.0, 0.0]))
    found = margin(build_model(BLOCK, "nonlinear"), motion, polarities, around=Around(1))
    assert found.uplift == pytest.approx(0.25 * BLOCK.gravity / 4.0, rel=1e-12)
    still = margin(build_model(BLOCK, "nonlinear"), motion.scaled(0), polarities, around=Around(1))
    assert still.uplift is None and not still.overturned.any()


@pytest.mark.parametrize("wrong", [[], [0.0, 1.0], [1.0, 1.0], [2.0, 1.0], [1.0, np.inf], [[1.0]]])
def test_factors_must_ascend(wrong):
    with pytest.raises(InputError, match="ascending"):
        margin(build_model(BLOCK, "nonlinear"), parse_pulse("sine:1g:1s").sampled(), factors=np.array(wrong))


class TestCommand:
    BLOCK = EXAMPLES / "block.yaml"
    ACCEL = EXAMPLES / "accel.csv"

    def test_json_is_the_study(self):
        data = run_json("margin", self.BLOCK, "--record", self.ACCEL, "--pulse", "sine:0.5g:0.8s", "--neighbours", 20)
        assert data["neighbours"] == {"count": 20, "amplitude": 0.02, "restitution": 0.02}
        assert len(data["motions"]) == 2 and data["motions"][0]["name"] == "accel.csv"
        model = build_model(load_structure(self.BLOCK), "nonlinear")
        found = margin(model, parse_pulse("sine:0.5g:0.8s").sampled(), around=AROUND)
        theirs = data["motions"][1]
        assert theirs["shares"] == found.overturned.tolist() and theirs["factors"] == sorted([*FACTORS.tolist(), 1.0])
        assert theirs["overturned"] == found.itself and theirs["uplift"] == found.uplift
        assert set(theirs["levels"]) == {"10", "50", "90"}
        assert theirs["levels"]["50"]["first"] == found.first(0.5)
        assert theirs["verdict"] == in_words(found, 0.5)

    def test_a_scaled_motion_is_the_motion(self):
        one, two = (
            run_json("margin", self.BLOCK, "--pulse", f"sine:{ag}g:0.8s", *scale, "--neighbours", 5, "--polarity", 1)
            for ag, scale in ((0.6, ()), (0.3, ("--scale", 2)))
        )
        np.testing.assert_allclose(one["motions"][0]["shares"], two["motions"][0]["shares"])

    @pytest.mark.parametrize("width", ["40", "80", "200"])
    def test_the_table_has_a_row_each(self, width, monkeypatch):
        monkeypatch.setenv("COLUMNS", width)
        text = " ".join(run("margin", self.BLOCK, "--record", self.ACCEL, "--neighbours", 5).stdout.split())
        assert "accel.csv" in text and "At each factor, 5 neighbouring motions are simulated" in text

    def test_a_picture(self, tmp_path):
        run("margin", self.BLOCK, "--record", self.ACCEL, "--neighbours", 5, "--plot", tmp_path / "m.png")
        assert (tmp_path / "m.png").read_bytes()[:4] == b"\x89PNG"

    @pytest.mark.parametrize(
        ("words", "fragment"),
        [
            ((), "--record PLACE or --pulse PULSE"),
            (("--record", "x", "--neighbours", 0), "at least 1"),
            (("--record", "x", "--within-amplitude", 1), "from 0 up to, but not including, 1"),
            (("--record", "x", "--within-restitution", -1), "from 0"),
            (("--record", "no.AT2"), "no such file"),
        ],
    )
    def test_wrong_input(self, words, fragment):
        assert fragment in run("margin", self.BLOCK, *words, code=2).stderr


def test_a_missing_record_of_several_leaves_the_others():
    from click.testing import CliRunner

    from rocking_cli.cli.main import main

    words = [
        "margin",
        EXAMPLES / "block.yaml",
        "--record",
        EXAMPLES / "accel.csv",
        "--record",
        "no.AT2",
        "--neighbours",
        "5",
        "--json",
    ]
    result = CliRunner().invoke(main, [str(word) for word in words])
    assert result.exit_code == 5 and "no.AT2" in result.stderr
    assert len(json.loads(result.stdout)["motions"]) == 1


@pytest.mark.parametrize(("uplift", "mark"), [(0.05, "<"), (0.5, "|"), (9.0, ">")])
def test_where_it_uplifts_is_marked_on_the_axis_or_pointed_to(uplift, mark):
    (axes,) = draw_margins({"a": Margin(AROUND, uplift, FACTORS, np.zeros(FACTORS.size))}, "title").axes
    (drawn,) = (line for line in axes.get_lines() if line.get_marker() in ("<", "|", ">"))
    assert drawn.get_marker() == mark
    assert axes.get_xlim()[0] <= drawn.get_xdata()[0] <= axes.get_xlim()[1]
    assert ("arrowhead" in axes.get_xlabel()) == (mark != "|")

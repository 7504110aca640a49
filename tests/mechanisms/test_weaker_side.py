"""A block that is alone rocks about the smaller of its two sides, and what rolls on a rim says so."""

import json
import re
from math import sqrt

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.core import Direction, equivalent_block
from rocking_cli.views.cautions import cautions_of
from tests.cli.test_cli import run, run_json
from tests.conftest import record

STELE = {"width": 0.6, "height": 2.4, "depth": 0.18}
MASS = {"name": "head", "mass": 200.0, "at": [0.2, 2.0]}
SITE = {"FC": 1.35, "ag": 0.2, "F0": 2.5, "TC": 0.4, "S": 1.2}


def sentence(block):
    return " ".join(each for each in cautions_of(block) if "its depth lambda is" in each)


@pytest.mark.parametrize("ratio", [0.1, 0.3, 0.999])
def test_the_weaker_side_is_the_block_turned_by_a_right_angle(ratio):
    """lambda = b/h and p^2 = 3 g/(4 R), of the depth."""
    block = rk.Block(**STELE | {"depth": 0.6 * ratio})
    turned = block.weaker_side()
    depth, height = 0.6 * ratio, 2.4
    assert turned.uplift(Direction.POSITIVE) == pytest.approx(depth / height, rel=1e-12)
    p = equivalent_block(turned).positive.p
    assert p == pytest.approx(sqrt(3 * 9.80665 / (2 * np.hypot(depth, height))), rel=1e-12)
    assert f"its depth lambda is {depth / height:.4g} instead of 0.25" in sentence(block)
    assert turned.weaker_side() is None and sentence(turned) == ""


def test_masses_on_it_are_above_the_middle_of_its_depth():
    block = rk.Block(**STELE, mass=500.0, loads=[MASS])
    turned = block.weaker_side()
    least = (500 * 0.09 + 200 * 0.09) / (500 * 1.2 + 200 * 2.0)  # overturning moments about an edge of the depth
    for direction in Direction:
        assert turned.uplift(direction) == pytest.approx(least, rel=1e-12)
    assert f"{least:.4g} instead of" in sentence(block) and turned.total_mass() == block.total_mass()
    lighter = rk.Block(**STELE, density=2500)
    assert lighter.weaker_side().total_mass() == pytest.approx(lighter.total_mass(), rel=1e-12)


@pytest.mark.parametrize(
    "held",
    [
        {"depth": None},
        {"depth": 0.6},
        {"depth": 1.0},
        {"plane": "width"},
        {"one_sided": "positive", "rebound": 0.4},
        {"mass": 500.0, "loads": [{**MASS, "floor": "sliding"}]},
        {"mass": 500.0, "loads": [{"name": "push", "force": [0.0, -10.0], "at": [0.0, 2.4]}]},
        {"mass": 500.0, "loads": [{"name": "roof", "mass_per_metre": 100.0, "at": [0.0, 2.4]}]},
        {"mass": 500.0, "ties": [{"name": "bar", "from": {"ground": [-3, 2]}, "to": {"at": [0, 2]}, "stiffness": 1e6}]},
        {"density": 2000.0, "interlock": {"courses": 8, "overlap": 0.2, "thickness": 0.5, "walls": 1, "height": 2.0}},
        {"density": 2000.0, "crushing": {"strength": 1e7}},
    ],
    ids=lambda each: "-".join(each),
)
def test_what_is_deep_or_held_or_part_of_a_wall_has_no_weaker_side(held):
    block = rk.Block(**STELE | held)
    assert block.weaker_side() is None and sentence(block) == ""


def test_commands_with_cautions_say_it(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "stele.yaml").write_text("mechanism: block\nwidth: 60 cm\nheight: 240 cm\ndepth: 18 cm\n")
    (tmp_path / "site.yaml").write_text("".join(f"{key}: {value}\n" for key, value in SITE.items()))
    said = "Its depth, 0.18 m, is less than its width: about its depth lambda is 0.075 instead of 0.25"
    for asked in (
        ("equiv", "stele.yaml"),
        ("respond", "stele.yaml", "--pulse", "sine:0.3g:0.6s", "--neighbours", "2"),
        ("verify", "stele.yaml", "--site", "site.yaml"),
    ):
        assert said in " ".join(run(*asked).stdout.split()), asked
        assert said in json.dumps(run_json(*asked)), asked


def test_a_round_foot_is_said():
    (text,) = [each for each in cautions_of(rk.Cone(base_radius=0.5, height=3.0)) if "rim" in each]
    assert re.search(r"may roll on its rim, out of the plane of motion, which is not modelled\.$", text)


def test_a_bookcase_that_does_not_uplift_rocks_about_its_depth():
    motion = record("RSN6_IMPVALL.I_I-ELC180.AT2")
    bookcase = rk.Block(width=0.9, height=2.2, depth=0.35)
    as_given, turned = (
        rk.respond(each, motion, model="nonlinear", neighbours=0)["nonlinear"]
        for each in (bookcase, bookcase.weaker_side())
    )
    assert as_given.words == "does not uplift" and turned.peak_ratio == pytest.approx(0.57, abs=0.005)


@pytest.mark.parametrize(("aside", "weaker"), [(0.05, True), (0.25, False)])
def test_masses_off_the_middle_of_its_width_may_make_that_the_weaker_side(aside, weaker):
    """By moments about the edge towards which the mass is moved, and about an edge of the depth."""
    block = rk.Block(width=0.6, depth=0.4, height=0.1, mass=100.0, loads=[{**MASS, "at": [aside, 1.0]}])
    about_width = (100 * 0.3 + 200 * (0.3 - aside)) / (100 * 0.05 + 200 * 1.0)
    about_depth = (100 * 0.2 + 200 * 0.2) / (100 * 0.05 + 200 * 1.0)
    assert (about_depth < about_width) == weaker == (block.weaker_side() is not None)
    assert min(map(block.uplift, Direction)) == pytest.approx(about_width, rel=1e-12)

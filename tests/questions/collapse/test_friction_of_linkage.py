"""Verdicts and reports of a linkage that `collapse` writes say what it says of friction."""

import re

import pytest
import yaml

import rocking_cli as rk
from rocking_cli.dynamics.resting import glued
from tests.cli.test_cli import run
from tests.conftest import EXAMPLES

WALL = [[0, 0], [0.9, 0], [0.9, 9], [0, 9]]
BUTTRESS = [[0.9, 0], [2.1, 0], [2.1, 2.5], [1.7, 3], [1.7, 5], [0.9, 6]]
GROUND = {"polygon": [[-3, -1], [5, -1], [5, 0], [-3, 0]]}
SITE = EXAMPLES / "verify" / "site.yaml"
GIVEN = {"name": "facade", "density": 1800.0, "depth": 1.0}
A, X, Y = 5.5, 1.4090909090909092, 2.481818181818182  # of the buttress, by hand
TOGETHER = (8.1 * 0.45 + A * X) / (8.1 + A), (8.1 * 4.5 + A * Y) / (8.1 + A)
LAMBDA = {rk.Direction.POSITIVE: (2.1 - TOGETHER[0]) / TOGETHER[1], rk.Direction.NEGATIVE: TOGETHER[0] / TOGETHER[1]}


def facade(**fields):
    blocks = {"wall": {"polygon": WALL}, "buttress": {"polygon": BUTTRESS}}
    return rk.Assembly(blocks=blocks, ground={"ground": GROUND}, **GIVEN, **fields)


@pytest.fixture(scope="module")
def linkage():
    return facade().as_linkage()


def text_of(page):
    shown = re.sub(r"<(style|script|svg).*?</\1>", "", page, flags=re.DOTALL)
    return " ".join(re.sub(r"<[^>]+>", " ", shown).split())


def test_friction_by_hand_and_by_limit_analysis(linkage):
    """One leaf carries the other: its weight is the shear of their face, lambda times it the force that presses."""
    found = {each.direction: each for each in glued(linkage)}
    searched = rk.collapse(facade())
    assert found.keys() == LAMBDA.keys()
    for direction, each in found.items():
        assert each.lambda_ == pytest.approx(LAMBDA[direction], rel=1e-9)
        assert each.needed == pytest.approx(1 / LAMBDA[direction], rel=2e-4)
        assert each.needed == pytest.approx(searched[direction].friction_needed, rel=2e-4)
        assert each.failure.push / linkage.gravity == pytest.approx(searched[direction].with_usual, rel=1e-6)


def test_nothing_is_said_where_friction_is_known_or_enough(linkage):
    fields = yaml.safe_load(linkage.model_dump_json(exclude_unset=True, by_alias=True))
    assert glued(linkage.replace(friction=0.6)) == [] == glued(rk.Block(width=0.59, height=1.0))
    for side in ("positive", "negative"):
        for joint in fields[side]["joints"].values():
            joint.update({"bonded": True} if "fixed" in joint else {})
    assert glued(rk.Linkage(**fields)) == [] == glued(facade())


def test_a_squat_block_slides_and_does_not_overturn():
    """lambda = .8, and it slides at .6: nothing is said of it."""
    assert glued(rk.Block(width=0.8, height=1.0)) == []


@pytest.mark.rest
@pytest.mark.usefixtures("small_maps")
def test_verdict_and_report_say_it(tmp_path):
    blocks = {"wall": {"polygon": WALL}, "buttress": {"polygon": BUTTRESS}}
    fields = {"mechanism": "assembly", **GIVEN, "blocks": blocks, "ground": {"ground": GROUND}}
    (tmp_path / "facade.yaml").write_text(yaml.safe_dump(fields), "utf-8")
    assert run("collapse", "facade.yaml", "-o", "linkage.yaml").exit_code == 0
    answer = rk.verify("linkage.yaml", SITE)
    remark = answer.remarks[0]
    assert remark.key == "glued" and remark.values["usual"] == 0.6
    assert remark.values["needed"] == pytest.approx(1 / LAMBDA[rk.Direction.NEGATIVE], rel=2e-4)
    needs = "a friction of 2.92 in the positive direction and 4.4 in the negative"
    starts = "0.1446 g instead of 0.2274 g"
    told = " ".join(run("verify", "linkage.yaml", "--site", str(SITE)).stdout.split())
    assert needs in told and starts in told and "need a coefficient of friction of 4.4," in told
    assert run("report", "linkage.yaml", "-o", "r.html").exit_code == 0
    page = text_of((tmp_path / "r.html").read_text("utf-8"))
    first = page[: page.index("What to do next")]
    assert needs in first and starts in first and "section on joints" not in page
    assert run("report", "linkage.yaml", "--language", "it", "-o", "i.html").exit_code == 0
    page = text_of((tmp_path / "i.html").read_text("utf-8"))
    assert "attrito di 2,92 nel verso positivo e 4,4 nel verso negativo" in page and "sezione sui giunti" not in page

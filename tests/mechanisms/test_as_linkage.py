"""The weakest mechanism of an assembly as the file of a linkage: the same motion, joints and histories."""

import json
from pathlib import Path

import numpy as np
import pytest
from pytest import approx

import rocking_cli as rk
from rocking_cli.core import Direction, equivalent_block
from rocking_cli.core.reactions import reactions
from rocking_cli.core.structure_file import load_structure, parse_structure, structure_text
from rocking_cli.errors import InputError, MechanismError
from tests.cli.test_cli import run, some
from tests.conftest import EXAMPLES, SHARED
from tests.mechanisms.test_assembly import assembly, rectangle

BLOCKS = SHARED / "blocks" / "assemblies.json"
ACCEL = EXAMPLES / "accel.csv"
PORTAL = EXAMPLES / "masonry" / "portal.yaml"
FILES = sorted(each for each in EXAMPLES.rglob("*.yaml") if "\nmechanism: assembly" in each.read_text("utf-8"))
IDS = sorted(json.loads(BLOCKS.read_text())) if BLOCKS.exists() else ["none"]
TOWER = {"low": rectangle(0.0, 0.0, 1.0, 4.0), "high": rectangle(0.0, 4.0, 1.0, 6.0)}


def written(found):
    """The linkage of an assembly, by way of its file."""
    return parse_structure(structure_text(found.as_linkage(), "a comment"), "linkage.yaml", "linkage")


def bearing(structure, direction):
    """Contacts and guides as plain numbers, each seen from the first of its pieces by name."""
    seen = []
    for each in structure.contacts(direction):
        pieces = [name or "" for name in each.pieces]
        normal = each.normal * (1 if pieces == sorted(pieces) else -1)
        points = sorted((round(at.real, 5) + 0.0, round(at.imag, 5) + 0.0) for at in each.points)
        face = each.face if len(points) == 1 else None
        seen.append(
            (sorted(pieces), points, np.round([normal.real, normal.imag], 6) + 0.0, each.held, face, each.friction)
        )
    return sorted(map(repr, seen))


def the_same(found):
    """Check the linkage of an assembly against the assembly, and return the linkage."""
    linkage = written(found)
    assert linkage.directions == found.directions
    ours, theirs = equivalent_block(found), equivalent_block(linkage)
    for d in found.directions:
        assert linkage.uplift(d) == approx(found.uplift(d), rel=1e-9)
        for key in ("p", "phi_cr", "eta", "lambda_lin", "kappa2"):
            assert getattr(theirs[d], key) == approx(getattr(ours[d], key), rel=1e-9), key
        assert bearing(linkage, d) == bearing(found, d)
    return linkage


@pytest.mark.parametrize(
    "file",
    [pytest.param(each, marks=[pytest.mark.rest] * (each.stem not in ("assembly", "wall_of_three"))) for each in FILES],
    ids=lambda file: file.stem,
)
def test_the_examples(file):
    the_same(load_structure(file))


@pytest.mark.skipif(not BLOCKS.exists(), reason=f"no assemblies in {BLOCKS}")
@pytest.mark.rest
@pytest.mark.parametrize("name", IDS)
def test_of_many_assemblies(name):
    fields = json.loads(BLOCKS.read_text())[name]["structure"]
    the_same(rk.Assembly(**{key: value for key, value in fields.items() if key != "mechanism"}))


@pytest.mark.rest
@pytest.mark.parametrize(("name", "scale"), [("assembly", 1.0), ("masonry/wall_of_three", 3.0)])
def test_histories_and_checks_of_joints_are_those_of_the_assembly(name, scale):
    # The springings of the first are drawn to whole millimetres: without their faces, joints would be taken as level.
    found = load_structure(EXAMPLES / f"{name}.yaml")
    ours, theirs = (
        rk.respond(each, ACCEL, model="nonlinear", neighbours=0, scale=scale).to_dict()["responses"]["nonlinear"]
        for each in (found, written(found))
    )
    ours, theirs = ({**each, **each["contact"]} for each in (ours, theirs))
    assert ours["peak_ratio"] > 0
    for key, value in ours.items():
        if isinstance(value, float):
            assert theirs[key] == approx(value, rel=1e-6), key
        elif not isinstance(value, dict | list):
            assert theirs[key] == value, key


def test_a_command_and_a_verb_write_a_file_that_others_take(tmp_path):
    (tmp_path / "portal.yaml").write_bytes(PORTAL.read_bytes())
    shown = run("collapse", "portal.yaml", "-o", "linkage.yaml")
    assert "wrote linkage.yaml" in shown.stderr and "lambda = 0.261808 g" in shown.stdout
    assert load_structure("linkage.yaml").uplift(Direction.POSITIVE) == approx(0.261808, abs=5e-7)
    rk.collapse("portal.yaml", out="again.yaml")
    text = [Path(each).read_text("utf-8") for each in ("linkage.yaml", "again.yaml")]
    assert text[0] == text[1]
    assert "\n    A: {hinge: [left high, lintel], at: [0.05, 3.4]}\n" in text[0]
    assert "\n    left low and left high: {fixed: [left low, left high]}\n" in text[0]
    with pytest.raises(InputError, match="`out` would overwrite an input file"):
        rk.collapse("portal.yaml", out="portal.yaml")
    assert (tmp_path / "portal.yaml").read_bytes() == PORTAL.read_bytes()


def test_all_fields_go_along_whatever_the_names():
    names = ["1e3", "on", "né, [b]: 'c' \"d\" # e", "<<", "- x", "\U0001f600 and"]
    blocks = {name: rectangle(0.0, k, 0.6, k + 1.0) for k, name in enumerate(names)}
    blocks["<<"]["mass"] = 900.0
    loads = [
        {"name": "null", "mass": "5 kN", "at": [0.3, 6.0], "body": names[5]},
        {"name": "tiles", "force": [100.0, 0.0], "at": [0.3, 1.5], "body": "on"},
    ]
    end = {"body": names[2], "at": [0.0, 3.0]}
    ties = [{"name": "bar: #1", "from": {"ground": [-3.0, 3.0]}, "to": end, "stiffness": 1e5, "only": "tension"}]
    more = {"uncertainty": {"slenderness": 0.05}, "strength": {"stress": 3e6, "width": 0.05}, "friction": 0.7}
    eta = {"positive_to_negative": 0.85, "negative_to_positive": 0.9}
    found = assembly(blocks, name="a: {b} # c", loads=loads, ties=ties, gravity=9.8, restitution=eta, **more)
    linkage = written(found)
    for key in ("name", "gravity", "restitution", "density", "depth", "loads", "ties", *more):
        assert getattr(linkage, key) == getattr(found, key), key
    for d in Direction:
        assert linkage.uplift(d) == approx(found.uplift(d), rel=1e-9)
        assert bearing(linkage, d) == bearing(found, d)


def test_one_that_leans_and_one_with_its_own_leads():
    leans = the_same(assembly(TOWER, one_sided="negative", rebound=0.3))
    assert (leans.positive, leans.one_sided, leans.rebound) == ("none", "negative", 0.3)
    portal = load_structure(PORTAL).replace(lead={"positive": "right low", "negative": "right high"})
    leads = portal.as_linkage()
    assert (leads.positive.lead, leads.negative.lead) == ("right low", "right high")


def test_supports_have_their_names_also_those_of_hinges():
    blocks = {"a": rectangle(0, 0, 0.4, 1.2), "b": rectangle(0, 1.2, 0.35, 2.3), "c": rectangle(0, 2.3, 0.3, 3.2)}
    held = {"A": {"slide": "c", "at": [0.15, 3.2], "along": [0.0, 1.0]}}
    linkage = assembly(blocks, joints=held).as_linkage()
    assert list(linkage.positive.joints) == ["A", "B", "A-2", "a and b"]


def test_friction_of_single_joints():
    blocks = {"left": rectangle(0, 0, 0.8, 3), "right": rectangle(3.2, 0, 4, 3), "top": rectangle(0, 3, 4, 3.6)}
    linkage = the_same(assembly(blocks, friction=0.6, friction_of={"left and top": 0.4, "floor and right": 0.5}))
    assert [each.friction for each in linkage.positive.joints.values()] == [0.4, None, None, 0.5]
    fixed = the_same(assembly(TOWER, friction_of={"low and high": 0.4}))
    assert fixed.positive.joints["low and high"].friction == 0.4


@pytest.mark.parametrize(
    "found",
    [
        # On springings as steep as these a pivot would be taken to bear on the intrados.
        rk.Assembly(density=2e3, depth=1.0, voussoirs={"span": 18.0, "rise": 3.0, "thickness": 1.5, "count": 7}),
        assembly({"a": {"polygon": [[-1, 0.002], [2, 0.002], [1, 3], [0, 3]]}, "b": rectangle(-0.1, 3.001, 1.1, 8)}),
        assembly(
            {"plinth": {"polygon": [[0, 0], [3, 0.5], [3, 1.5], [0, 1.5]]}, "pier": rectangle(1, 1.5, 1.5, 4)},
            {"rock": {"polygon": [[-1, -1], [6, -1], [6, 1], [-0.6, -0.1]]}},
        ),
    ],
    ids=["steep springings", "gaps of millimetres", "rests on a slope"],
)
def test_faces_that_do_not_follow_from_the_polygons_are_given(found):
    linkage = the_same(found)
    assert any(each.face for each in linkage.positive.joints.values())


SLIDES = {"low": rectangle(0.0, 0.0, 1.0, 1.0), "high": rectangle(0.0, 1.0, 0.5, 3.0)}


def test_a_mechanism_without_a_model_is_shown_and_not_written(tmp_path):
    found = assembly(SLIDES, friction_of={"low and high": 0.1}, name="stool")
    (tmp_path / "stool.yaml").write_text(structure_text(found, "slides"), "utf-8")
    shown = some("collapse", "stool.yaml", "-o", "linkage.yaml")
    assert "The mechanism slides between low and high" in shown.stdout
    assert "linkage.yaml: cannot be written: in the positive direction the mechanism slides" in shown.stderr
    assert [each.name for each in tmp_path.iterdir()] == ["stool.yaml"]
    assert json.loads(some("collapse", "stool.yaml", "--json", "-o", "linkage.yaml").stdout)["directions"]
    with pytest.raises(InputError, match="cannot be written: in the positive"):
        rk.collapse(found, out="linkage.yaml")
    with pytest.raises(MechanismError, match="no rocking model exists for sliding"):
        found.as_linkage()


def test_a_name_that_linkages_reserve_is_refused():
    with pytest.raises(InputError, match="ground is what joints call the ground"):
        assembly({"ground": rectangle(0, 0, 1, 4)}).as_linkage()


def test_forces_of_many_redundant_joints_are_not_shared_out():
    def portico(count):
        bodies = {f"c{k}": rectangle(2 * k, 0, 2 * k + 0.8, 5) for k in range(count)}
        joints = {f"foot {k}": {"pivot": f"c{k}", "at": [2 * k + 0.8, 0.0]} for k in range(count)}
        joints |= {f"head {k}": {"hinge": [f"c{k}", "beam"], "at": [2.0 * k, 5.0]} for k in range(count)}
        bodies["beam"] = rectangle(0, 5, 2 * count, 6)
        side = {"lead": "c0", "joints": joints}
        return rk.Linkage(bodies=bodies, positive=side, negative="none", one_sided="positive", density=2e3, depth=1.0)

    at = np.array([0.01])
    assert reactions(portico(3), Direction.POSITIVE, at, np.zeros(1), np.zeros(1)).shared
    assert not reactions(portico(60), Direction.POSITIVE, at, np.zeros(1), np.zeros(1)).shared

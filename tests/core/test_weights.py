"""Weights where masses are meant, and loads per metre of wall: values by hand, and what is said of them."""

import json

import pytest
import yaml

import rocking_cli as rk
from rocking_cli.core.plausible import doubts
from rocking_cli.core.structure_file import parse_structure
from rocking_cli.errors import InputError
from rocking_cli.units import mass_of_weight
from tests.cli.test_cli import run

FACADE = """mechanism: block
width: 60 cm
height: 8
density: 19 kN/m3
depth: 5
loads:
  - {name: roof, mass: 30 kN, at: [0, 8], floor: sliding}
  - {name: slab, mass: 12 kN/m, at: [0, 4]}
"""


def made(text):
    return parse_structure(text, "f.yaml", "f")


def refused(text):
    with pytest.raises(InputError) as caught:
        made(text)
    return str(caught.value)


def test_a_weight_over_standard_gravity_by_hand():
    assert mass_of_weight("19 kN/m3", "kg/m3") == pytest.approx(1937.46, abs=5e-3)  # 19000/9.80665
    assert mass_of_weight("96 kN", "kg") == pytest.approx(9789.28, abs=5e-3)  # 96000/9.80665
    assert mass_of_weight("12 kN/m", "kg/m") == pytest.approx(1223.66, abs=5e-3)  # 12000/9.80665
    assert mass_of_weight("1 lbf/ft3", "kg/m3") == pytest.approx(0.45359237 / 0.3048**3, rel=1e-12)
    for text, unit in (("19 kg/m3", "kg/m3"), ("19 kN", "N"), ("19 smoot", "kg"), ("19", "kg"), ("19 kN", "4")):
        assert mass_of_weight(text, unit) is None


def test_equiv_has_the_masses_and_says_each(tmp_path):
    (tmp_path / "f.yaml").write_text(FACADE)
    shown = run("equiv", "f.yaml", "--json")
    masses = {each["name"]: each["mass"] for each in json.loads(shown.stdout)["hung"]}
    assert masses["roof"] == pytest.approx(3059.15, abs=5e-3)  # 30000/9.80665
    assert masses["slab"] == pytest.approx(6118.30, abs=5e-3)  # 5 * 12000/9.80665
    said = shown.stderr.splitlines()
    assert said == [
        "f: 19 kN/m3 is a weight, taken as a mass: 1937.46 kg/m3 (divided by 9.80665 m/s2)",
        "f: 30 kN is a weight, taken as a mass: 3059.15 kg (divided by 9.80665 m/s2)",
        "f: 12 kN/m is a weight, taken as a mass: 1223.66 kg/m (divided by 9.80665 m/s2)",
        "f: slab: 1223.66 kg/m over a depth of 5 m is 6118.3 kg",
    ]


def test_a_floor_per_metre_says_how_much_of_it_the_structure_carries():
    floor = {"name": "roof", "mass": "24 kN/m", "at": [0.0, 2.0], "floor": "sliding"}
    block = rk.Block(width=0.5, height=2.0, depth=5.0, density=1800.0, loads=[floor])
    (carried,) = (each for each in block.attached if each.name == "roof")
    assert carried.weight * carried.mass * 9.80665 == pytest.approx(0.5 * 24e3 * 5)
    assert block.remarks[-1].endswith("is 12236.6 kg, of which the structure carries 50 % (floor: sliding)")


def test_the_same_in_kilograms_says_nothing_and_is_the_same_block(tmp_path):
    by_weight = rk.equiv(made(FACADE)).to_dict()
    kilograms = FACADE.replace("19 kN/m3", repr(19000 / 9.80665)).replace("30 kN", repr(30000 / 9.80665))
    (tmp_path / "f.yaml").write_text(kilograms.replace("12 kN/m", repr(5 * 12000 / 9.80665)))
    shown = run("equiv", "f.yaml", "--json")
    assert shown.stderr == ""
    found = json.loads(shown.stdout)
    for key in ("p", "phi_cr", "lambda", "eta", "I_eq", "G_eq", "B_eq"):
        assert found["directions"]["positive"][key] == pytest.approx(
            by_weight["directions"]["positive"][key], rel=1e-12
        )
    assert made(FACADE.replace("12 kN/m", f"{12000 / 9.80665!r} kg/m")).loads[1].whole(5.0) == pytest.approx(
        6118.30, abs=5e-3
    )


def test_remarks_do_not_count_where_structures_are_compared():
    assert made(FACADE) == made(FACADE.replace("19 kN/m3", repr(made(FACADE).density)))
    assert "weights" not in "".join(made(FACADE).model_dump())


def test_a_study_that_names_a_structure_notes_its_weights_too(tmp_path):
    (tmp_path / "f.yaml").write_text(FACADE)
    study = "structures: [{file: f.yaml, name: front, vary: {NAME: {uniform: {low: 0.5, high: 0.7}}}}]\n" + (
        'records: [{pulse: "sine:1g:0.8s"}]\nmethod: stripes\nlevels: {measure: PGA, values: [0.1, 0.2, 0.3]}\n'
        "limit_states: [uplift]\nsamples: 2\n"
    )
    (tmp_path / "s.yaml").write_text(study.replace("NAME", "width"))
    shown = run("fragility", "s.yaml", "--check")
    assert "front: 19 kN/m3 is a weight, taken as a mass: 1937.46 kg/m3" in shown.stderr
    (tmp_path / "s.yaml").write_text(study.replace("NAME", "length"))
    assert "its length is given by depth" in run("fragility", "s.yaml", "--check", code=2).stderr
    assert made(FACADE).model_copy(update={"density": 1000.0})._weights == []


def test_a_plain_number_stays_in_kilograms():
    plain = made(FACADE.replace("30 kN", "30").replace("19 kN/m3", "1900").replace("12 kN/m", "12"))
    assert (plain.density, plain.loads[0].mass, plain.loads[1].mass, plain.remarks) == (1900.0, 30.0, 12.0, [])


def test_a_density_of_nineteen_is_doubted():
    assert doubts(made(FACADE.replace("19 kN/m3", "19"))) == ["density is 19 kg/m3: did you mean 19 kN/m3?"]
    assert doubts(made(FACADE.replace("19 kN/m3", "1.9"))) == ["density is 1.9 kg/m3: did you mean 1.9 t/m3?"]
    assert doubts(made(FACADE)) == []


def test_a_density_of_no_material_is_doubted_in_the_unit_that_it_was_meant_in():
    """1800 kN/m3 over 9.80665 m/s2 is 183549 kg/m3, and 25.5 kN/m3 or 22.6 t/m3 are below 25000 kg/m3."""
    said = "density is 183549 kg/m3: did you mean 1800 kg/m3?"
    for text in ("1800 kN/m3", "1800 kN/mc", "1800000 N/m3"):
        assert doubts(made(FACADE.replace("19 kN/m3", text))) == [said]
    (said_of_tonnes,) = doubts(made(FACADE.replace("19 kN/m3", "180 t/m3")))
    assert said_of_tonnes == "density is 180000 kg/m3: are the units right?"
    for text in ("25.5 kN/m3", "22.6 t/m3"):
        assert doubts(made(FACADE.replace("19 kN/m3", text))) == []


def test_a_load_per_metre_follows_the_depth_and_keeps_its_mass_at_another_size():
    wall = made(FACADE.replace("  - {name: roof, mass: 30 kN, at: [0, 8], floor: sliding}\n", ""))
    deeper = rk.design(wall, ("depth", 1.0, 10.0), "lambda >= 0.01").result.metric
    assert deeper == pytest.approx(deeper[0], rel=1e-12)  # all masses grow alike
    twice = wall.enlarged(2.0)
    assert twice.loads[0].whole(twice.depth) == pytest.approx(wall.loads[0].whole(wall.depth), rel=1e-15)
    again = type(wall).from_fields(wall.model_dump(exclude_unset=True))
    assert again.loads == wall.loads


def test_a_load_per_metre_needs_a_depth():
    text = FACADE.replace("density: 19 kN/m3\ndepth: 5", "mass: 456 kN")
    assert (
        "f.yaml:7:24: loads[2].mass is per metre of wall: give the `depth` of the structure over which it acts, or the "
        "whole mass" in refused(text)
    )
    assert made(text.replace("12 kN/m", "60 kN")).mass == pytest.approx(456000 / 9.80665)


@pytest.mark.parametrize("field", ["force", "weight"])
def test_kilonewtons_of_two_meanings_are_asked_for(field):
    message = refused(FACADE.replace("mass: 30 kN, at: [0, 8], floor: sliding", f"{field}: 30 kN, at: [0, 8]"))
    assert f"loads[1].{field} has two meanings in 30 kN" in message
    assert "write `mass: 30 kN` for a weight that moves with the structure" in message
    assert "`force: [0, -30 kN]` for a force without inertia" in message
    for meant in ("mass: 30 kN", "force: [0, -30 kN]"):
        assert made(FACADE.replace("mass: 30 kN, at: [0, 8], floor: sliding", f"{meant}, at: [0, 8]"))


def test_weights_of_other_kinds_say_what_they_are():
    assert "12 kN/m is a load per metre, not a mass" in refused(FACADE.replace("density: 19 kN/m3", "mass: 12 kN/m"))
    assert "loads[1].span belongs to a load per area" in refused(FACADE.replace("30 kN", "3 kN/m2"))
    assert "3 kN/m2 is a pressure, not a mass" in refused(FACADE.replace("density: 19 kN/m3", "mass: 3 kN/m2"))
    assert "give one of `mass` and `force`" in refused(FACADE.replace("mass: 30 kN", "mass: 30 kN, mass_per_metre: 1"))


def test_a_table_takes_weights_in_headings_and_cells_and_notes_each_once(tmp_path):
    (tmp_path / "t.csv").write_text(
        "mechanism,name,width [cm],height,density [kN/m3],depth,loads.roof.mass [kN/m],loads.roof.at\n"
        "block,a,60,8,19,5,12,0;8\nblock,b,50,8,18 kN/m3,5,12 kg/m,0;8\nblock,c,50,8,19,5,,\n"
    )
    shown = run("survey", "t.csv", "--json")
    *first, rest = shown.stderr.splitlines()
    assert rest == "further remarks on how fields were read: 2" and len(set(first)) == 3
    assert "18 kN/m3 is a weight, taken as a mass: 1835.49 kg/m3 (divided by 9.80665 m/s2)" in first
    alone = yaml.safe_load(FACADE)
    alone["loads"] = [{"name": "roof", "mass": "60 kN", "at": [0, 8]}]
    alone["density"] = "19 kN/m3"
    row = next(each for each in json.loads(shown.stdout)["rows"] if each["name"] == "a")
    assert row["lambda"] == pytest.approx(rk.equiv(made(yaml.safe_dump(alone))).positive.lambda_, rel=1e-12)

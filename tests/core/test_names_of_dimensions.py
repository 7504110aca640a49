"""Thickness, length and height: read where a wall is meant, and elsewhere refused with the field that holds them."""

import json

import pytest

import rocking_cli as rk
from rocking_cli.core.structure_file import parse_structure
from rocking_cli.errors import InputError
from tests.cli.test_cli import run

WALLS = {
    "wall": "mechanism: wall\nthickness: 0.3\nheight: 3\ndensity: 1800\n",
    "spanning_wall": "mechanism: spanning_wall\nthickness: 0.3\nheight: 3\ndensity: 1800\noverburden: 20 kN\n"
    "hinge: weakest\n",
}


def refused(text):
    with pytest.raises(InputError) as caught:
        parse_structure(text, "f.yaml", "f")
    return str(caught.value)


@pytest.mark.parametrize("text", WALLS.values(), ids=WALLS)
def test_the_length_of_a_wall_is_its_depth(text):
    by_length, by_depth = (parse_structure(f"{text}{name}: 250 cm\n", "f", "f") for name in ("length", "depth"))
    assert by_length == by_depth and by_length.depth == 2.5
    assert by_length.total_mass() == pytest.approx(0.3 * 3 * 2.5 * 1800)
    assert by_length.model_copy(update={"name": "g"}).depth == 2.5


@pytest.mark.parametrize("text", WALLS.values(), ids=WALLS)
def test_both_names_are_refused_and_a_wrong_value_by_the_name_in_the_file(text):
    said = refused(f"{text}length: 2\ndepth: 2\n")
    assert "length is the same field as depth: give one of the two" in said
    assert "length must be more than 0 m, got -2" in refused(f"{text}length: -2 m\n")
    with pytest.raises(InputError, match="length is the same field as depth"):
        rk.Wall(thickness=0.3, height=3.0, length=2.0, depth=2.0)


def test_a_load_per_metre_acts_over_the_length(tmp_path):
    loads = "length: 4\nloads: [{name: roof, mass: 6 kN/m, body: upper block, at: [0, 3]}]\n"
    (tmp_path / "w.yaml").write_text(WALLS["wall"] + loads)
    shown = json.loads(run("equiv", "w.yaml", "--json").stdout)
    assert shown["hung"][0]["mass"] == pytest.approx(2447.32, abs=5e-3)  # 4 * 6000/9.80665


def test_commands_that_vary_a_field_take_either_name(tmp_path):
    (tmp_path / "w.yaml").write_text(WALLS["wall"] + "length: 4\n")
    found = [
        json.loads(run("design", "w.yaml", "--vary", f"{name}=2:6", "--until", "lambda >= 0.1", "--json").stdout)
        for name in ("length", "depth")
    ]
    assert found[0]["in_file"] == found[1]["in_file"] == 4.0
    (tmp_path / "t.csv").write_text("mechanism,name,thickness,height,length\nwall,a,0.3,3,4\n")
    assert json.loads(run("survey", "t.csv", "--json").stdout)["bad"] == []


@pytest.mark.parametrize(
    ("text", "hints"),
    [
        ("mechanism: block\nthickness: 0.6\nlength: 5\nheight: 8\n",
         {"thickness": "its thickness is given by width: width of the base",
          "length": "its length is given by depth: size out of plane"}),
        ("mechanism: wall\nwidth: 0.3\nheight: 3\n", {"width": "its width is given by thickness"}),
        ("mechanism: symmetric_frame\nmass_ratio: 1\nthickness: 1\nheight: 6\nweight: 30 kN\n",
         {"thickness": "its thickness is given by column_width", "height": "its height is given by column_height",
          "weight": "its weight is given by mass"}),
        ("mechanism: rigid_body\nthickness: 1\nheight: 6\nunit_weight: 18 kN/m3\n",
         {"thickness": "its thickness is given by polygon", "height": "its height is given by polygon",
          "unit_weight": "its unit weight is given by density"}),
        ("mechanism: block\nwidth: 1\nheigth: 8\n", {"heigth": "did you mean height?"}),
    ],
)  # fmt: skip
def test_elsewhere_the_field_that_holds_it_is_named(text, hints):
    said = refused(text)
    for word, hint in hints.items():
        assert f"{word} is not a field of {text.split()[1]}\n" in said and hint in said


def test_tables_and_varied_fields_name_it_too(tmp_path):
    (tmp_path / "b.yaml").write_text("mechanism: block\nwidth: 0.6\nheight: 3\n")
    said = run("design", "b.yaml", "--vary", "thickness=0.2:1", "--until", "lambda >= 0.1", code=2).stderr
    assert "its thickness is given by width" in said
    (tmp_path / "t.csv").write_text("mechanism,name,thickness,height\nblock,a,0.3,3\n")
    assert "its thickness is given by width" in run("survey", "t.csv", code=2).stderr

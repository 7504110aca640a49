"""Numbers that cannot be are refused in verifications of masonry, unusual ones questioned; what is meant is let be."""

import json

import pytest
import yaml

import rocking_cli as rk
from rocking_cli import Registry
from rocking_cli.ask.inputs import site_of
from rocking_cli.core.plausible import doubts, questions
from rocking_cli.core.structure_file import load_structure, parse_structure
from rocking_cli.errors import InputError
from rocking_cli.io.starters import STARTERS, starter
from rocking_cli.structure import Structure
from rocking_cli.verification.check import questioned
from rocking_cli.views.mechanisms import template
from tests.cli.test_cli import run
from tests.conftest import EXAMPLES

WALL = {
    "mechanism": "block", "name": "wall", "width": "0.6 m", "height": "8 m", "depth": "5 m", "density": "18 kN/m3",
    "one_sided": "positive", "loads": [{"name": "roof", "mass": "12 kN/m", "at": [0.0, 8.0], "floor": "borne"}],
}  # fmt: skip
SITE = {"FC": "LC1", "soil": "C", "ag": 0.21, "F0": 2.42, "TC_star": 0.31}
TIE = {"name": "bar", "from": {"ground": [-5.0, 7.5]}, "to": {"at": [-0.3, 7.5]}}
STEEL = {**TIE, "bars": 1, "diameter": "24 mm", "steel": "S235"}
PLATE = {"plate": {"width": 0.25, "height": 0.25}, "wall": {"thickness": 0.6, "compression": 1e6, "shear": 5e4}}
ELEMENT = {"kind": "cantilever", "w": "18 kN/m3", "E": "1200 MPa"}
FLOOR = {"z": 6.0, "H": 9.0, "T1": 0.3, "xi1": 0.05, "n": 3}


def load(**fields):
    """A structure with one load."""
    return {"loads": [{"name": "roof", "at": [0.0, 8.0], **fields}]}


def steel(part, **fields):
    """A structure with a tie of steel, one part of which is otherwise."""
    return {"ties": [{**STEEL, **PLATE, part: {**PLATE[part], **fields}}]}


def interlock(**fields):
    """A structure with crossing walls."""
    return {"interlock": {"courses": 40, "overlap": 0.2, "thickness": 0.5, "height": 8.0, **fields}}


ERROR, CAUTION, NOTHING = "error", "caution", "nothing"
OF_MASONRY = ", which is unusual of masonry"
CASES = [
    # those that were verified without a word
    ({}, {}, NOTHING, ""),
    ({"width": 60}, {}, ERROR,
     "width is 60 m, more than the height of 8 m" + OF_MASONRY + ": did you mean 60 cm?"),
    ({"width": 8, "height": 0.6}, {}, ERROR, "or are the two exchanged?"),
    ({"width": 5, "depth": 0.6}, {}, CAUTION,
     "more than the length of 0.6 m" + OF_MASONRY + ": are the two exch"),
    # sizes
    ({"width": 600}, {}, ERROR, "did you mean 600 mm?"),
    ({"width": 2.5}, {}, CAUTION, "width is 2.5 m, more than 2 m"),
    ({"width": 0.04}, {}, CAUTION, "width is 0.04 m, less than 0.01 times the height of 8 m"),
    ({"width": "0.6 mm"}, {}, ERROR, "did you mean 0.6 m?"),
    ({"width": 1.9}, {}, NOTHING, ""),
    ({"width": 0.7, "height": 2.2, "depth": 1, "loads": None}, {}, NOTHING, ""),
    ({"height": 800, "loads": None}, {}, ERROR,
     "height is 800 m, more than 25 m" + OF_MASONRY + ": did you mean 800 mm or 800 cm?"),
    ({"height": 60, "loads": None}, {}, CAUTION, "height is 60 m"),
    ({"depth": 500}, {}, CAUTION,
     "depth is 500 m, more than 50 m" + OF_MASONRY + ": did you mean 500 mm or 500 cm?"),
    ({"depth": 600}, {}, ERROR, "did you mean 600 mm or 600 cm?"),
    ({"depth": 12}, {}, NOTHING, ""),
    # materials and gravity
    ({"density": 18}, {}, ERROR,
     "density is 18 kg/m3, less than 1000 kg/m3" + OF_MASONRY + ": did you mean 18 kN/m3?"),
    ({"density": 1.8}, {}, ERROR, "did you mean 1.8 t/m3?"),
    ({"density": 18000}, {}, CAUTION, "density is 18000 kg/m3, more than 3000 kg/m3"),
    ({"density": 600}, {}, CAUTION, "less than 1000 kg/m3"),
    ({"density": 7850}, {}, CAUTION, "more than 3000 kg/m3"),
    ({"density": 2700}, {}, NOTHING, ""),
    ({"gravity": 981}, {}, ERROR, "did you mean 981 cm/s2?"),
    ({"gravity": 9.81}, {}, NOTHING, ""),
    ({"friction": 5}, {}, CAUTION, "friction is 5, more than 1.5"),
    ({"strength": {"stress": 2, "width": 0.05}}, {}, ERROR, "did you mean 2 MPa?"),
    ({"crushing": {"strength": "2 MPa"}}, {}, NOTHING, ""),
    # loads
    (load(mass=12), {}, CAUTION,
     "loads.roof.mass is 12 kg, less than 0.01 times the mass of 44051.7 kg" + OF_MASONRY + ": did you mean 12 kN?"),
    (load(mass=1200), {}, NOTHING, ""),
    (load(mass_per_metre=2.5), {}, CAUTION, "did you mean 2.5 kN/m?"),
    (load(mass_per_area=2.5, span=5.0), {}, CAUTION,
     "loads.roof.mass_per_area is 2.5 kg/m2, less than 20 kg/m2" + OF_MASONRY + ": did you mean 2.5 kN/m2?"),
    (load(mass="2.5 kN/m2", span=500), {}, ERROR, "did you mean 500 mm or 500 cm?"),
    (load(mass="2.5 kN/m2", span=5), {}, NOTHING, ""),
    (load(force=[6, 0], at=[0.0, 5.0]), {}, CAUTION,
     "loads.roof.force is 6 N, less than 0.001 times the weight of 432000 N" + OF_MASONRY + ": did you mean 6 kN?"),
    (load(force=["6 kN", 0], at=[0.0, 5.0]), {}, NOTHING, ""),
    (load(force=[0, "12 kN"]), {}, CAUTION, "loads.roof.force has 12000 upwards"),
    (load(force=["1 kN/m", "2 kN/m"]), {}, CAUTION, "has 2000 upwards"),
    (load(force=[0, "-12 kN"]), {}, NOTHING, ""),
    (load(mass="12 kN/m", at=[0.5, 8.0], floor="sliding"), {}, CAUTION,
     "loads.roof.at is [0.5, 8] m, 0.025 times the size of block away"),
    (load(mass="12 kN/m", at=[0.3, 8.0], floor="sliding"), {}, NOTHING, ""),
    (load(mass="12 kN", at=[0.0, 9.0]), {}, NOTHING, ""),
    (load(mass="12 kN/m", at=[0.0, 800.0]), {}, ERROR, "are its coordinates those of `rocking draw`?"),
    (load(mass="12 kN/m", seat=0.25), {}, NOTHING, ""),
    (load(mass="12 kN/m", seat=0.7), {}, CAUTION, "loads.roof.seat is 0.7 m, more than the thickness of 0.6 m"),
    (load(mass="12 kN/m", seat=25), {}, ERROR, "did you mean 25 cm?"),
    # ties
    ({"ties": [STEEL]}, {}, NOTHING, ""),
    ({"ties": [{**STEEL, "diameter": 0.24, "steel": None, "yield": "235 MPa"}]}, {}, CAUTION,
     "ties.bar.diameter is 0.24 m"),
    ({"ties": [{**TIE, "area": 452, "modulus": "210 GPa"}]}, {}, ERROR, "did you mean 452 mm2?"),
    ({"ties": [{**TIE, "area": "452 mm2", "modulus": 210}]}, {}, ERROR, "did you mean 210 MPa or 210 GPa?"),
    ({"ties": [{**TIE, "stiffness": 0, "prestress": 1}]}, {}, CAUTION, "did you mean 1 kN?"),
    (steel("plate", width=2.0, height=0.25), {}, CAUTION, "ties.bar.plate.width is 2 m"),
    (steel("wall", compression=1e4), {}, CAUTION, "ties.bar.wall.compression"),
    (interlock(overlap=2.0), {}, CAUTION, "interlock.overlap is 2 m"),
    (interlock(), {}, NOTHING, ""),
    # sites
    ({}, {"ag": 2.06}, ERROR,
     "ag is 2.06 g, more than 0.6 g" + OF_MASONRY + ": did you mean 2.06 m/s2?"),
    ({}, {"ag": "2.06 m/s2"}, NOTHING, ""),
    ({}, {"ag": 0.7}, CAUTION, "ag is 0.7 g, more than 0.6 g"),
    ({}, {"F0": 1.5}, CAUTION, "F0 is 1.5, less than 2.2"),
    ({}, {"TC_star": 3.1}, ERROR, "TC_star is 3.1 s"),
    ({}, {"SLC": {"ag": 2.6, "F0": 2.42, "TC_star": 0.33}}, ERROR, "SLC.ag is 2.6 g"),
    ({}, {"floor": FLOOR}, NOTHING, ""),
    ({}, {"floor": {**FLOOR, "z": 600, "H": 900}}, ERROR, "did you mean 600 mm or 600 cm?"),
    ({}, {"floor": {**FLOOR, "T1": 5}}, CAUTION, "floor.T1 is 5 s"),
    ({}, {"floor": {**FLOOR, "xi1": 0.4}}, CAUTION, "floor.xi1 is 0.4"),
    ({}, {"element": ELEMENT}, NOTHING, ""),
    ({}, {"element": {**ELEMENT, "w": 18}}, ERROR,
     "element.w is 18 N/m3, less than 10000 N/m3" + OF_MASONRY + ": did you mean 18 kN/m3?"),
    ({}, {"element": {**ELEMENT, "E": 1200}}, ERROR, "did you mean 1200 MPa?"),
    ({}, {"element": {**ELEMENT, "t": 60}}, ERROR, "did you mean 60 cm?"),
    # what is meant
    ({"width": 60, "unusual": ["width"]}, {}, NOTHING, ""),
    ({"density": 600, "unusual": ["density"]}, {}, NOTHING, ""),
    ({**load(mass=12), "unusual": ["loads.roof.mass"]}, {}, NOTHING, ""),
    ({**load(mass="12 kN/m", seat=25), "unusual": ["width"]}, {}, ERROR, "loads.roof.seat is 25 m"),
    ({}, {"ag": 2.06, "unusual": ["ag"]}, NOTHING, ""),
    ({"unusual": ["ag"]}, {"ag": 2.06}, NOTHING, ""),
]  # fmt: skip


@pytest.mark.parametrize(("fields", "ground", "kind", "words"), CASES, ids=range(len(CASES)))
def test_a_number_is_refused_questioned_or_let_be(tmp_path, fields, ground, kind, words):
    file, where = tmp_path / "wall.yaml", tmp_path / "site.yaml"
    file.write_text(yaml.safe_dump({key: value for key, value in {**WALL, **fields}.items() if value is not None}))
    where.write_text(yaml.safe_dump({**SITE, **ground}))
    structure, site = Structure(load_structure(file), str(file)), site_of(where)
    try:
        said = [f"{each.name} {each.words}" for each in questioned(structure, site)]
        assert bool(said) == (kind == CAUTION)
        assert not words or words in said[0]
    except InputError as error:
        assert kind == ERROR
        (problem, *_) = error.problems
        assert words in f"{problem.field} {problem.message}"
        assert problem.file in map(str, (file, where)) and problem.line is not None
        assert problem.hint.startswith("if it is meant, add `unusual: [")


SLIPS = [
    (rk.Block(width=60, height=2.4), "width is 60 m: did you mean 60 cm?"),
    (rk.Block(width=0.4, height=0.4), None),  # a cube
    (rk.Block(width=0.3, height=2.0, depth=0.8, mass=60.0, gravity=1.62), None),  # a bookcase on the moon
    (rk.Block(width=3.0, height=2.0, depth=1.0, density=400.0), None),  # a crate
    (rk.Block(width=0.5, height=2.0, depth=0.1, density=18.0), "density is 18 kg/m3: did you mean 18 kN/m3?"),
    (rk.Block(width=0.5, height=2.0, density=18.0, depth=1.0, unusual=["density"]), None),
    (rk.Block(width=0.5, height=2.0, depth=1.0, mass=80.0, loads=[{"name": "pot", "mass": 0.2, "at": [0, 2]}]), None),
]


@pytest.mark.parametrize(("structure", "words"), SLIPS)
def test_elsewhere_only_slips_of_units_are_questioned(structure, words):
    assert doubts(structure) == ([] if words is None else [words])


SHIPPED = {
    **{path.name: load_structure(path) for path in sorted(EXAMPLES.rglob("*.yaml"))
       if "mechanism:" in path.read_text(encoding="utf-8") and not {"plugin", "survey"} & {*path.parts}},
    **{name: parse_structure(starter(name), name, name) for name in STARTERS},
    **{name: parse_structure(template(cls), name, name) for name, cls in Registry().items()},
}  # fmt: skip


@pytest.mark.parametrize("name", SHIPPED)
def test_what_is_shipped_is_usual_but_for_a_wall_between_floors_on_the_ground(name):
    site, structure = site_of(EXAMPLES / "verify" / "site.yaml").site, SHIPPED[name]
    assert doubts(structure) == []
    assert {each.name for each in questions(structure, site)} <= {"floor"}
    assert questions(structure, site_of(EXAMPLES / "verify" / "roof.yaml").site) == []


def test_the_floor_of_a_wall_between_floors_is_asked_for():
    site = site_of(EXAMPLES / "verify" / "site.yaml").site
    (asked,) = questions(SHIPPED["floor_wall.yaml"], site)
    assert asked.name == "floor" and asked.words.startswith("is missing, but the wall spans between floors")
    assert questions(SHIPPED["floor_wall.yaml"], site.model_copy(update={"unusual": ["floor"]})) == []


def test_what_cannot_be_is_refused_by_verify_survey_and_design(tmp_path):
    site, wall = tmp_path / "site.yaml", tmp_path / "wall.yaml"
    site.write_text(yaml.safe_dump(SITE))
    wall.write_text(yaml.safe_dump({**WALL, "width": 60}))
    table = "mechanism,name,width,height,depth\nblock,a,60,8,5\nblock,b,2.5,8,5\n"
    (tmp_path / "t.csv").write_text(table)
    said = "width is 60 m, more than the height of 8 m, which is unusual of masonry: did you mean 60 cm?"
    for asked in (["verify"], ["design", "--vary", "height=4:8", "--until", "ratio >= 1"]):
        refused = run(*asked[:1], str(wall), *asked[1:], "--site", str(site), code=2)
        assert said in " ".join(refused.stderr.split()) and f"{wall}:" in refused.stderr
        assert "add `unusual: [width]`" in refused.stderr
    ranked = json.loads(run("survey", str(tmp_path / "t.csv"), "--site", str(site), "--json", code=5).stdout)
    assert "width is 60 m" in json.dumps(ranked["bad"]) and [each["name"] for each in ranked["rows"]] == ["b"]
    assert ranked["rows"][0]["doubt"] == "width is 2.5 m, more than 2 m, which is unusual of masonry"
    slips = json.loads(run("survey", str(tmp_path / "t.csv"), "--json").stdout)["rows"]
    assert {each["name"]: each["doubt"] for each in slips} == {"a": "width is 60 m: did you mean 60 cm?", "b": None}


def test_what_is_unusual_is_in_the_answer_and_on_the_terminal(tmp_path):
    site, wall = tmp_path / "site.yaml", tmp_path / "wall.yaml"
    site.write_text(yaml.safe_dump(SITE))
    wall.write_text(yaml.safe_dump({**WALL, "width": 5, "depth": 0.6}))
    shown = run("verify", str(wall), "--site", str(site))
    assert "wall: width is 5 m, more than the length of 0.6 m" in " ".join(shown.stderr.split())
    assert "The value of `width:` is unusual of masonry: have it checked." in " ".join(shown.stdout.split())
    wall.write_text(yaml.safe_dump({**WALL, "width": 5, "depth": 0.6, "unusual": ["width"]}))
    shown = run("verify", str(wall), "--site", str(site))
    assert "unusual" not in shown.stderr and "unusual of masonry" not in shown.stdout

"""Ties of steel bars with anchor plates: strengths by hand, and files in which they are wrong."""

from math import pi

import numpy as np
import pytest
import yaml

import rocking_cli as rk
from rocking_cli.core import Direction
from rocking_cli.core.hung.ties import STEELS
from rocking_cli.core.structure_file import parse_structure
from rocking_cli.errors import InputError
from tests.cli.test_cli import run, run_json
from tests.core.test_laden_files import BAR, BARE, FRAME, HEAVY, tie

PLACED = {"name": "bar", "from": {"ground": [-6.0, 7.5]}, "to": {"at": [-0.3, 7.5]}}
BARS = {"bars": 2, "diameter": "24 mm", "steel": "S235"}
PLATE = {"width": 0.3, "height": 0.25}
WALL = {"thickness": 0.6, "compression": "1.5 MPa", "shear": "0.05 MPa"}
SITE = {"FC": 1.35, "ag": 0.2, "F0": 2.5, "TC": 0.4, "S": 1.2}
MASS, G = 0.6 * 8.0 * 5.0 * 1800.0, 9.80665


def facade(**fields):
    return rk.Block(
        name="facade", width=0.6, height=8.0, depth=5.0, density=1800.0, one_sided="positive", rebound=0.4,
        ties=[{**PLACED, **fields}],
    )  # fmt: skip


def force_of(structure):
    """The force that codes count of the only tie, from the moment that it adds: the tie is 7.5 m above the foot."""
    bare = structure.model_copy(update={"ties": None})
    both = (each.uplift(Direction.POSITIVE) for each in (structure.at_strength(), bare))
    return (next(both) - next(both)) * MASS * G * 4.0 / 7.5


YIELD = 2 * pi * 0.024**2 / 4 * 235e6
PUNCHING = 2 * 2 * 0.6 * (0.3 + 0.25 + 2 * 0.6) * 0.05e6
BEARING = 2 * 0.3 * 0.25 * 1.5e6


@pytest.mark.every(3)
@pytest.mark.parametrize(
    ("changed", "force", "governs"),
    [
        ({}, PUNCHING, "punching"),
        ({"wall": {**WALL, "shear": "0.06 MPa"}}, YIELD, "yield"),
        ({"wall": {**WALL, "shear": "0.06 MPa", "compression": "1.2 MPa"}}, BEARING * 1.2 / 1.5, "bearing"),
        ({"plate": {"width": 0.2, "height": 0.2}}, 2 * 0.2 * 0.2 * 1.5e6, "bearing"),
        ({"wall": {**WALL, "thickness": 0.3}}, 2 * 2 * 0.3 * (0.3 + 0.25 + 0.6) * 0.05e6, "punching"),
        ({"bars": 1}, PUNCHING / 2, "punching"),
        ({"bars": None, "spacing": "2 m"}, PUNCHING * 2.5 / 2, "punching"),
    ],
)
def test_the_least_strength_governs_and_acts_as_a_constant_force(changed, force, governs):
    fields = {**BARS, "plate": PLATE, "wall": WALL, **changed}
    structure = facade(**{key: value for key, value in fields.items() if value is not None})
    assert force_of(structure) == pytest.approx(force, rel=1e-9)
    found = rk.verify(structure, SITE)
    ties = found.to_dict()["directions"]["positive"]["ties"]["bar"]
    assert ties["strength_governs"] == governs and ties["strength"][governs] == pytest.approx(force, rel=1e-12)
    assert ties["force_SLV"] == ties["strength"][governs] == min(ties["strength"].values())
    assert (ties["force_SLC"] == 0) == (ties["strain_SLC"] > 0.02)
    names = {"yield": "yield of the bars", "punching": "punching of the plates", "bearing": "bearing of the plates"}
    limits = ", ".join(f"{key} {value / 1e3:.4g} kN" for key, value in ties["strength"].items())
    said = (
        f"The tie bar acts with its strength of {force / 1e3:.4g} kN as a constant force: {names[governs]} governs "
        f"({limits}). These formulas have not been checked against a printed source."
    )
    assert said in " ".join(found.sentences) and "Strengths of bar are as given" in " ".join(found.sentences)
    lines = {line.symbol: line for line in found.directions[Direction.POSITIVE].workings if line.symbol.startswith("N")}
    assert lines["N"].value == pytest.approx(force / 1e3)
    assert {key: lines[f"N_{key[0]}"].value * 1e3 for key in names} == pytest.approx(ties["strength"])
    assert all(lines[f"N_{key[0]}"].standing == "code" for key in names)  # not checked
    assert found.conclusion.left_out == []


@pytest.mark.parametrize(
    ("steel", "stress"),
    [
        ("S235", 235), ("S275", 275), ("S355", 355), ("B450C", 450), ("FeB22k", 215), ("FeB32k", 315), ("FeB38k", 375),
        ("FeB44k", 430),
    ],
)  # fmt: skip
def test_named_steels(steel, stress):
    by_name = force_of(facade(bars=3, diameter=0.012, steel=steel))
    assert by_name == pytest.approx(3 * pi * 0.012**2 / 4 * stress * 1e6, rel=1e-9)
    assert by_name == pytest.approx(force_of(facade(bars=3, diameter=0.012, **{"yield": f"{stress} MPa"})), rel=1e-12)
    assert len(STEELS) == 8


def test_area_and_yield_alone():
    structure = facade(area="452 mm2", **{"yield": "200 MPa"})
    assert force_of(structure) == pytest.approx(452e-6 * 200e6, rel=1e-9)
    said = " ".join(rk.verify(structure, SITE).sentences)
    assert "The tie bar acts with its strength of 90.4 kN as a constant force, that at which its steel yields. " in said
    assert "Without `plate` and `wall`, its anchorages are not checked." in said and "Not counted" not in said


def test_each_of_equal_columns_may_have_one_by_its_area():
    def lambda_(more):
        text = tie(
            f"from: {{ground: [-3, 5]}}, to: {{at: [-0.5, 5], body: columns}}, area: 1e-4, yield: 2e8{more}", FRAME
        )
        return parse_structure(text, "f.yaml", "f").at_strength().uplift(Direction.POSITIVE)

    none = parse_structure(FRAME, "f.yaml", "f").uplift(Direction.POSITIVE)
    assert lambda_(", each: true") - none == pytest.approx(2 * (lambda_("") - none), rel=1e-9)


@pytest.mark.parametrize("number", [{"bars": 2}, {"spacing": 2.0}])
def test_on_a_structure_of_another_size_the_force_stays(number):
    structure = facade(diameter=0.02, steel="S275", plate=PLATE, wall=WALL, **number)
    for factor in (0.2, 3.0):
        larger = structure.enlarged(factor)
        bare = larger.model_copy(update={"ties": None})
        added = (
            (larger.at_strength().uplift(Direction.POSITIVE) - bare.uplift(Direction.POSITIVE))
            * larger.total_mass()
            * G
        )
        assert added * 4.0 / 7.5 == pytest.approx(force_of(structure), rel=1e-9)
        (bar,), (given,) = larger.hung.bars, structure.hung.bars
        assert (bar.stiffness, bar.strength) == pytest.approx((given.stiffness, given.strength), rel=1e-12)


def test_a_report_does_not_call_it_elastic(tmp_path):
    rk.report(facade(**BARS), out=tmp_path / "r.html")
    page = (tmp_path / "r.html").read_text(encoding="utf-8")
    assert "tension only, up to 213 kN" in page and "assumed elastic" not in page


def test_a_tie_of_zero_length_at_rest_needs_the_length_over_which_it_stretches():
    tendon = {"name": "bar", "path": [{"ground": [0.0, 0.0]}, {"at": [0.0, 0.0]}], **BARS}
    with pytest.raises(InputError, match="its ends are together at rest: give the length over which it stretches"):
        rk.Block(width=1.0, height=5.0, mass=12_000.0, ties=[tendon])
    block = rk.Block(width=1.0, height=5.0, mass=12_000.0, ties=[{**tendon, "length": 5.0}])
    assert block.at_strength().uplift(Direction.POSITIVE) == pytest.approx(0.2 * (1 + YIELD / (12_000 * G)), rel=1e-9)
    (bar,) = block.hung.bars
    assert bar.stiffness == pytest.approx(210e9 * 2 * pi * 0.024**2 / 4 / 5.0) and bar.strength == pytest.approx(YIELD)


BOTH = "plate: {width: 0.3, height: 0.3}, wall: {thickness: 0.6, compression: 1e6, shear: 5e4}"
CASES = [
    ("bars: 2, diameter: 0.02", "steel", "is missing: name one of S235, S275, .*, or give the yield stress as `yield`"),
    ("bars: 2, diameter: 0.02, steel: S999", "steel", "must be S235, S275, .*got the text S999"),
    ("bars: 2, diameter: 0.02, steel: S235, yield: 2e8", "yield", "cannot be combined with `steel`"),
    ("bars: 2, diameter: 0.02, yield: 235", "yield", r"must be at least 1e.07 Pa, got 235\n(.|\n)*mean 235 MPa\?"),
    ("bars: 2, diameter: 0.02, yield: 2400", "yield", r"must be at least 1e.07 Pa(.|\n)*did you mean 2400 kg/cm2\?"),
    ("bars: 2, diameter: 0.02, yield: 235000", "yield", r"must be at least 1e.07(.|\n)*did you mean 235000 kPa\?"),
    ("bars: 2, diameter: 0.02, yield: 47 kN", "yield", "a force, not a pressure"),
    ("bars: 2, steel: S235", "diameter", "is missing: give `diameter` with `bars` or `spacing`, or the `area`"),
    ("diameter: 0.02, steel: S235", "bars", "is missing: give the number in .*, or their `spacing`"),
    ("bars: 0, diameter: 0.02, steel: S235", "bars", "must be at least 1, got 0"),
    ("bars: 1.5, diameter: 0.02, steel: S235", "bars", "must be a whole number, got 1.5"),
    ("bars: 2, spacing: 3, diameter: 0.02, steel: S235", "spacing", "cannot be combined with `bars`: give the number"),
    ("area: 1e-4, bars: 2, steel: S235", "bars", "requires `diameter` instead of `area`"),
    ("area: 1e-4, diameter: 0.02, steel: S235", "area", "cannot be combined with `diameter`"),
    (f"area: 1e-4, steel: S235, {BOTH}", "plate", "requires `diameter` instead of `area`"),
    ("bars: 2, diameter: 24, steel: S235", "diameter", "must be at most 1 m, got 24"),
    ("bars: 2, diameter: 0.05, steel: S235", "steel", "thicker bars than 40 mm yield at less than this steel: give"),
    ("bars: 2, diameter: 0.02, steel: S235, stiffness: 1", "stiffness", "stiffness from its section: leave it out"),
    ("bars: 2, diameter: 0.02, steel: S235, prestress: 1", "prestress", "has no force at rest: leave it out"),
    ("bars: 2, diameter: 0.02, steel: S235, each: true", "each", "which count all: leave it out"),
    ("bars: 2, diameter: 0.02, steel: S235, only: compression", "only", "acts in tension"),
    ("bars: 2, diameter: 0.02, steel: S235, plate: {width: 0.3, height: 0.3}", "wall",
     "is missing, which `plate` requires"),
    ("bars: 2, diameter: 0.02, steel: S235, wall: {thickness: 0.6, compression: 1e6, shear: 5e4}", "plate",
     "is missing, which `wall` requires: give both, or leave out `wall`"),
    (f"bars: 2, diameter: 0.02, steel: S235, {BOTH.replace(', shear: 5e4', '')}", "wall.shear", "is missing: shear"),
    (f"bars: 2, diameter: 0.02, steel: S235, {BOTH.replace('1e6', '1')}", "wall.compression", "at least 10000 Pa"),
    (f"bars: 1, diameter: 0.02, steel: S235, {BOTH.replace('width: 0.3', 'width: 1.2')}", "plate.width",
     "1.2 m is more than the 1 m that the structure is deep: reduce it"),
    (f"spacing: 0.25, diameter: 0.02, steel: S235, {BOTH}", "plate.width", "more than the 0.25 m that bars are apart"),
    (f"bars: 2, diameter: 0.02, steel: S235, {BOTH.replace('height: 0.3', 'height: 6')}", "plate.height",
     "6 m is more than the 5 m that block is high"),
    (f"bars: 2, diameter: 0.02, steel: S235, {BOTH.replace('thickness: 0.6', 'thickness: 1.1')}", "wall.thickness",
     "1.1 m is more than the 1 m that block is wide"),
    (f"bars: 4, diameter: 0.02, steel: S235, {BOTH}", "plate.width",
     "1.2 m is more than the 1 m that the structure is deep, where 4 plates stand beside each other"),
    (f"bars: 2, diameter: 0.02, steel: S235, {BOTH.replace('height: 0.3', 'height: 3')}", "plate.height",
     "ends at y = 5.5 m, above the top of block at 5 m: lower the tie or reduce the plate"),
    ("stiffness: 1, bars: 2", "steel", "is missing"),
]  # fmt: skip


@pytest.mark.parametrize(("fields", "field", "said"), CASES)
def test_a_wrong_tie_gets_one_message_at_its_line(tmp_path, fields, field, said):
    with pytest.raises(InputError, match=said) as raised:
        parse_structure(tie(f"{BAR}, {fields}", HEAVY + "one_sided: positive\n"), "s.yaml", "s")
    (problem,) = raised.value.problems
    assert (problem.file, problem.line, problem.field) == ("s.yaml", 8, f"ties[1].{field}")


def test_a_spacing_requires_the_depth_of_the_structure():
    text = tie(f"{BAR}, spacing: 3, diameter: 0.02, steel: S235", BARE + "mass: 1e4\none_sided: positive\n")
    with pytest.raises(InputError, match="requires the `depth` of the structure: give it, or give `bars`"):
        parse_structure(text, "s.yaml", "s")


def test_a_bed_and_a_tie_with_neither():
    text = tie("bed: {from: [-0.5, 0], to: [-0.5, 4]}, modulus: 5e4, yield: 2e8")
    with pytest.raises(InputError, match=r"ties\[1\]\.yield: a bed has a modulus and nothing else"):
        parse_structure(text, "s.yaml", "s")
    with pytest.raises(InputError, match="or steel bars by `bars`, `diameter` and `steel`"):
        parse_structure(tie(BAR), "s.yaml", "s")


@pytest.mark.every(3)
@pytest.mark.parametrize(("name", "force"), [
    ("facade", 2 * pi * 0.012**2 / 4 * 235e6), ("gable", 0.12**2 * 1e6), ("corner", 0.2**2 * 1e6),
])  # fmt: skip
def test_ties_of_templates_count(name, force, tmp_path):
    (tmp_path / "s.yaml").write_text(run("new", name).stdout, encoding="utf-8")
    (tmp_path / "site.yaml").write_text(yaml.safe_dump(SITE), encoding="utf-8")
    files = (tmp_path / "s.yaml", "--site", tmp_path / "site.yaml")
    data = run_json("verify", *files)
    assert data["conclusion"]["left_out"] == [] and "Not counted" not in run("verify", *files).stdout
    (held,) = data["directions"]["positive"]["ties"].values()
    assert held["force_SLV"] == pytest.approx(force) and np.isfinite(held["strain_SLV"])
    free = yaml.safe_load((tmp_path / "s.yaml").read_text(encoding="utf-8"))
    del free["ties"]
    (tmp_path / "s.yaml").write_text(yaml.safe_dump(free), encoding="utf-8")
    assert run_json("verify", *files)["conclusion"]["ratio"] < data["conclusion"]["ratio"]


def test_a_verdict_relies_on_no_tie_beyond_what_is_known_of_it():
    """Hand: the end of a tie 7.5 m above the foot of a block that has turned by phi; 5.7 m long at rest."""
    found = rk.verify(facade(bars=2, diameter=0.012, steel="S235"), SITE)
    side = found.directions[Direction.POSITIVE]
    phi = side.exact.rotation(side.states["SLV"].d)
    turned = 0.3 + (-0.6 + 7.5j) * np.exp(-1j * phi)  # about the right foot
    strain = abs(turned + 6 - 7.5j) / 5.7 - 1
    assert found.to_dict()["directions"]["positive"]["ties"]["bar"]["strain_SLV"] == pytest.approx(strain, rel=1e-9)
    assert strain == pytest.approx(0.02, rel=1e-6) and side.states["SLV"].by == "break"
    said = f"The tie bar is not known to hold beyond d = {side.states['SLV'].d:.4g} m, where it is 0.114 m longer than"
    assert said in " ".join(found.sentences) and "Caution" not in found.sentences[0]


def test_a_facade_that_does_not_rock_relies_on_no_elongation():
    """Strong bars: a_g S is below a0*, so that rocking does not start and nothing moves."""
    found = rk.verify(facade(bars=2, diameter=0.024, steel="S235"), SITE)
    side = found.directions[Direction.POSITIVE]
    assert side.a0 > 0.2 * 1.2 * G and side.methods["damage"].zeta > 1
    assert found.to_dict()["directions"]["positive"]["ties"]["bar"]["strain_SLV"] == pytest.approx(0.02)
    assert not found.conclusion.limits or "Caution" not in found.sentences[0]


def test_a_tied_wall_is_told_to_be_verified_in_bending_too():
    said = "may bend between its foot and the tie"
    assert any(said in each for each in rk.verify(facade(**BARS), SITE).sentences)
    alone = rk.Block(width=0.6, height=8.0, depth=5.0, density=1800.0, one_sided="positive", rebound=0.4)
    assert not any(said in each for each in rk.verify(alone, SITE).sentences)


def test_a_force_that_stands_for_a_tie_says_how_far_its_block_moves():
    """The centroid of a facade 0.6 m thick that turns about its foot; at 0.3 m a free one falls."""
    load = {"name": "tie", "force": [-5e4, 0.0], "at": [-0.3, 7.5]}
    held = rk.Block(
        name="facade", width=0.6, height=8.0, depth=5.0, density=1800.0, one_sided="positive", rebound=0.4, loads=[load]
    )
    found = rk.verify(held, SITE)
    side = found.directions[Direction.POSITIVE]
    phi = side.exact.rotation(side.states["SLV"].d)
    moved = 0.3 * (1 - np.cos(phi)) + 4.0 * np.sin(phi)
    assert moved > 0.3
    said = f"Caution: at d_SLV the centroid of a block moves {moved:.3g} m sideways, and the block is 0.6 m thick."
    assert any(each.startswith(said) for each in found.sentences)
    assert [each.key for each in found.conclusion.limits] in (["onset_alone"], ["unsupported"])

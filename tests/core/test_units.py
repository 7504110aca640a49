"""Quantities with units, and what is said of sizes that look like a slip of the unit."""

import re
from fractions import Fraction
from math import degrees, pi

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mechanisms.block import Block
from mechanisms.rigid_body import RigidBody
from mechanisms.wall import Wall
from rocking_cli import Registry
from rocking_cli.core.mechanism import extent
from rocking_cli.core.plausible import doubts
from rocking_cli.core.structure_file import parse_structure
from rocking_cli.units import KINDS, UnitError, kind_of, read, units_of
from rocking_cli.views.mechanisms import template
from tests.cli.test_cli import run
from tests.conftest import PROJECT

# What the units are by definition, written down apart from the table.
KNOWN = [
    ("800 mm", "m", 0.8), ("80cm", "m", 0.8), ("12 ft", "m", 12 * 0.3048), ("12 in", "m", 12 * 0.0254),
    ("3km", "m", 3000.0), ("1.8 t", "kg", 1800.0), ("500 g", "kg", 0.5), ("1 lb", "kg", 0.45359237),
    ("40 kN", "N", 40e3), ("1 kip", "N", 1000 * 0.45359237 * 9.80665), ("2 MPa", "Pa", 2e6), ("2 N/mm2", "Pa", 2e6),
    ("1 psi", "Pa", 0.45359237 * 9.80665 / 0.0254**2), ("1 ksi", "Pa", 1000 * 0.45359237 * 9.80665 / 0.0254**2),
    ("2.1 t/m3", "kg/m3", 2100.0), ("2.1 t/m^3", "kg/m3", 2100.0), ("2.1 t / m³", "kg/m3", 2100.0),
    ("1 lb/ft3", "kg/m3", 0.45359237 / 0.3048**3), ("1 lbf/ft3", "N/m3", 0.45359237 * 9.80665 / 0.3048**3),
    ("981 gal", "m/s2", 9.81), ("1 g", "m/s2", 9.80665), ("10 deg", "deg", 10.0), ("10°", "rad", pi / 18),
    ("0.2 rad", "deg", degrees(0.2)), ("1e3 mm", "m", 1.0), ("-.5 m", "m", -0.5), ("4 kg m2", "kg m2", 4.0),
    ("18 kN/mc", "N/m3", 18e3), ("1800 kg/mc", "kg/m3", 1800.0), ("2 mq", "m2", 2.0), ("3 cmq", "m2", 3e-4),
    ("3 daN", "N", 30.0), ("3 daN/m", "N/m", 30.0), ("3 daN/m2", "Pa", 30.0), ("3 daN/m3", "N/m3", 30.0),
    ("3 daN/cm2", "Pa", 3e5), ("1 kg/cm2", "Pa", 98066.5), ("2 kgf/cmq", "Pa", 196133.0), ("1 kgf", "N", 9.80665),
    ("2 kgf/m", "N/m", 19.6133), ("2 kgf/m3", "N/m3", 19.6133),
]  # fmt: skip


@pytest.mark.parametrize(("text", "unit", "value"), KNOWN, ids=[each[0] for each in KNOWN])
def test_a_number_with_a_unit_is_what_its_definition_says(text, unit, value):
    assert read(text, unit) == pytest.approx(value, rel=1e-15)


@given(st.decimals(-1000, 1000, places=6), st.sampled_from(["m", "mm", "cm", "km", "in", "ft"]))
def test_a_length_is_the_number_nearest_to_what_is_written(number, unit):
    exact = Fraction(number) * Fraction(KINDS["length"][unit])
    assert read(f"{number} {unit}", "m") == float(exact)


WRONG = [
    ("5 kg", "m", "5 kg is a mass, not a length"), ("5 m", "kg/m3", "is a length, not a density"),
    ("5 mmm", "m", "did you mean mm?"), ("5 MM", "m", "did you mean mm?"), ("5 smoot", "m", "known: m, mm"),
    ("18 kN/m3", "kg/m3", "1835.49 kg/m3"), ("96 kN", "kg", "a weight, not a mass (divided by 9.80665"),
    ("0,8 m", "m", "decimal point"), ("5", "m", "without a unit"),
    ("5 m", "", "give a number without one"), ("m", "m", "is not a number"), ("", "m", "is not a number"),
    ("12 kN/m", "kg", "is a load per metre, not a mass"), ("12 kN/m", "N", "is a load per metre, not a force"),
    ("5 KN", "kg", "did you mean kN?"), ("5 KN/m", "kg", "did you mean kN/m?"), ("5 KN/m", "kg/m", "mean kN/m?"),
    ("5 KN/mc", "kg/m3", "did you mean kN/m3?"), ("5 Kg/m3", "kg/m3", "did you mean kg/m3?"),
    ("5 Kg", "kg", "did you mean kg?"), ("5 MT", "kg", "did you mean t?"), ("5 MT", "m", "did you mean m?"),
    ("5 DaN", "N", "did you mean daN?"), ("5 mpa", "Pa", "did you mean MPa?"), ("5 mN", "N", "known: N, daN"),
    ("5 mg", "kg", "is an acceleration, not a mass (units: kg, g"),
    ("5 hPa", "Pa", "known: Pa"), ("5 dN", "N", "known: N"), ("5 kp", "N", "known: N"),
    ("5 N/cm2", "Pa", "known: Pa"), ("5 kg/cm3", "kg/m3", "known: kg/m3"), ("5 kg/cm2", "kg/m3", "is a pressure"),
    ("5 \x1b[31m", "m", r"\x1b[31m"), ("5 m", "kg m2", "is a length, not in kg m2"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "unit", "words"), WRONG, ids=[each[2] for each in WRONG])
def test_a_wrong_unit_says_what_would_be_right(text, unit, words):
    with pytest.raises(UnitError) as caught:
        read(text, unit)
    assert words in str(caught.value)


@given(st.text(max_size=30), st.sampled_from(["m", "deg", "kg/m3", "", "N m"]))
def test_no_text_makes_more_than_a_unit_error(text, unit):
    for each in (text, f"1{text}", f"9e{text}", f"{text} m"):
        try:
            assert isinstance(read(each, unit), float)
        except UnitError as error:
            assert error.message


def test_numbers_beyond_all_bounds_end_in_a_message():
    with pytest.raises(ValueError, match="finite"):
        Block(width="1e999999999999 mm", height=1.0)
    assert read("9" * 5000 + " mm", "m") == float("inf")


def test_every_unit_has_one_kind_and_no_table_is_behind():
    first = [next(iter(units)) for units in KINDS.values()]
    assert [kind_of(unit) for unit in first] == list(KINDS)
    page = (PROJECT / "docs" / "structures.md").read_text(encoding="utf-8")
    table = dict(re.findall(r"^\| ([a-z ]+) \| (`.*`) \|$", page, re.M))
    for kind, units in KINDS.items():
        assert table[kind] == ", ".join(f"`{unit}`" for unit in units)


def test_units_need_neither_numpy_nor_pydantic():
    import subprocess
    import sys

    code = "import sys, rocking_cli.units; sys.exit(bool({'numpy', 'pydantic'} & set(sys.modules)))"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_mechanisms_lists_the_units_that_are_taken():
    found = run("mechanisms", "asymmetric_frame").stdout
    for unit in ("m", "kg/m3", "kg", "m/s2"):
        assert ", ".join(units_of(unit)) in " ".join(found.split())


@pytest.mark.parametrize("name", ["linkage", "spanning_wall", "symmetric_frame"])
def test_a_starting_file_in_millimetres_is_the_same_structure(name):
    text = template(Registry()[name])
    metres = re.compile(r"^(\w+: )([\d.]+)( +# .*\[m\])", re.M)
    changed = metres.sub(lambda line: f"{line[1]}{1000 * float(line[2]):g} mm{line[3]}", text)
    assert "mm  " in changed
    assert parse_structure(changed, "f", "f") == parse_structure(text, "f", "f")


@pytest.mark.parametrize("name", Registry())
def test_nothing_is_said_of_structures_of_the_usual_size(name):
    assert doubts(parse_structure(template(Registry()[name]), "f", "f")) == []


@pytest.mark.parametrize(
    ("structure", "words"),
    [
        (Wall(thickness=800.0, height=12000.0),
         "thickness is 800 m: did you mean 800 mm?; height is 12000 m: did you mean 12000 mm?"),
        (Block(width=0.7, height=2800.0), "height is 2800 m: did you mean 2800 mm?"),
        (Block(width=0.0007, height=0.0028),
         "width is 0.0007 m: did you mean 0.7 m?; height is 0.0028 m: did you mean 2.8 m?"),
        (RigidBody(polygon=[[0.0, 0.0], [800.0, 0.0], [800.0, 50.0], [0.0, 50.0]]),
         "polygon is 800 m: did you mean 800 mm or 800 cm?"),
        (RigidBody(R=150.0, alpha_deg=10.0, inertia_ratio=1.3), "R is 150 m"),
    ],
)  # fmt: skip
def test_sizes_that_look_like_a_slip_are_named(structure, words):
    assert words in "; ".join(doubts(structure))


def test_the_extent_needs_no_outline():
    assert extent(RigidBody(R=150.0, alpha_deg=10.0, inertia_ratio=1.3)) == pytest.approx(150.0)
    assert extent(Block(width=3.0, height=4.0)) == pytest.approx(5.0)


def test_a_plugin_that_fails_is_judged_by_its_fields_alone():
    class Broken(Block):
        def bodies(self):
            raise ZeroDivisionError

    assert doubts(Broken(width=1.0, height=0.1)) == []


@pytest.mark.usefixtures("small_maps")
@pytest.mark.parametrize("command", [["equiv"], ["overturning", "--points", "3"], ["report", "-o", "r.html"]])
def test_commands_warn_of_millimetres(command, tmp_path):
    (tmp_path / "w.yaml").write_text("mechanism: block\nwidth: 800\nheight: 12000\n")
    found = run(*command, "w.yaml")
    for said in ("width is 800 m: did you mean 800 mm?", "height is 12000 m: did you mean 12000 mm?"):
        assert f"warning: w: {said}" in found.stderr
    assert all("width is 800 m" in page.read_text(encoding="utf-8") for page in tmp_path.glob("*.html"))


def test_a_slenderness_is_an_angle(tmp_path):
    import json

    asked = "--pulse", "sine:0.5g:0.8s", "--sizes", "1:3", "--count", "2"
    spectra = json.loads(run("spectrum", "--slenderness", "0.2,18 deg", *asked, "--json").stdout)["spectra"]
    assert [each["slenderness"] for each in spectra] == [0.2, pytest.approx(pi / 10, rel=1e-15)]
    assert "is a mass, not an angle" in run("spectrum", "--slenderness", "5kg", *asked, code=2).stderr
    assert (
        "a slenderness is an angle in rad between 0 and pi/2"
        in run("spectrum", "--slenderness", "95deg", *asked, code=2).stderr
    )

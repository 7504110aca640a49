"""Site files in other units, loads per area and forces per metre: as converted by hand; and what is refused."""

import pytest
import yaml

import rocking_cli as rk
from rocking_cli.ask.inputs import site_of
from rocking_cli.core.structure_file import load_structure
from rocking_cli.errors import InputError

G = 9.80665
FLOOR = {"z": 6.0, "H": 9.0, "T1": 0.3, "xi1": 0.05, "n": 3, "SLD": {"T1": 0.2, "xi1": 0.03}}
IN_UNITS = {"z": "600 cm", "H": "9000 mm", "T1": "300 ms", "xi1": "5 %", "n": 3, "SLD": {"T1": "200 ms", "xi1": "3%"}}
GROUND = {"FC": "LC1", "soil": "C", "F0": 2.42}
PAIRS = [
    ({"ag": 2.06 / G, "TC_star": 0.31, "floor": FLOOR}, {"ag": "2.06 m/s2", "TC_star": "310 ms", "floor": IN_UNITS}),
    (
        {"ag": 0.206, "TC_star": 0.31, "SLC": {"ag": 2.6 / G, "F0": 2.4, "TC_star": 0.33}, "T0": 0.1},
        {"ag": "20.6 %g", "TC_star": "0.31 s", "SLC": {"ag": "260 cm/s2", "F0": 2.4, "TC_star": "330 ms"},
         "T0": "100 ms"},
    ),
    (
        {"ag": 0.2, "TC_star": 0.31, "element": {"kind": "cantilever", "L": 1.2, "t": 0.3, "w": 18e3, "E": 1.2e9}},
        {"ag": "0.2 g", "TC_star": 0.31,
         "element": {"kind": "cantilever", "L": "120 cm", "t": "300 mm", "w": "18 kN/m3", "E": "1200 MPa"}},
    ),
    (
        {"VN": 50, "class": "II", "hazard": [[30, 0.6 / G, 2.4, 0.27], [475, 0.2, 2.42, 0.31], [2475, 0.3, 2.5, 0.33]]},
        {"VN": "50 years", "class": "II",
         "hazard": [["30 years", "0.6 m/s2", 2.4, "270 ms"], [475, "0.2 g", 2.42, 0.31],
                    [2475, "30 %g", 2.5, "0.33 s"]]},
    ),
]  # fmt: skip


@pytest.mark.parametrize(("plain", "in_units"), PAIRS)
def test_a_site_in_other_units_is_the_same_site(plain, in_units):
    if "hazard" in plain:
        both = [{"FC": "LC1", "soil": "C", **each} for each in (plain, in_units)]
    else:
        both = [{**GROUND, **each} for each in (plain, in_units)]
    expected, found = (site_of(each).site.model_dump(exclude_none=True) for each in both)
    assert _flat(found) == pytest.approx(_flat(expected), rel=1e-15)


def _flat(data, name=""):
    """The numbers of nested data, by their paths."""
    if isinstance(data, dict | list):
        entries = data.items() if isinstance(data, dict) else enumerate(data)
        return {key: value for k, each in entries for key, value in _flat(each, f"{name}.{k}").items()}
    return {name: data} if isinstance(data, float) else {}


def test_the_ordinates_of_a_spectrum_have_the_units_of_their_columns():
    site = site_of({"FC": 1.35, "spectrum": [["0 s", "2.4 m/s2"], ["130 ms", "0.6 g"], [0.4, "60 %g"]]}).site
    assert site.spectrum == [[0.0, pytest.approx(2.4 / G, rel=1e-15)], [0.13, 0.6], [0.4, 0.6]]


@pytest.mark.parametrize(
    ("text", "line", "field", "words"),
    [
        ("FC: 1.35\nag: 2.06 kN\nF0: 2.5\nTC: 0.4\nS: 1.2\n", 2, "ag", "2.06 kN is a force, not an acceleration"),
        ("FC: 1.35\nag: 0.2\nF0: 2.5\nTC: 400 mm\nS: 1.2\n", 4, "TC", "400 mm is a length, not a time"),
        ("FC: 1.35\nag: 0.2\nF0: 2.5\nTC: 0.4\nS: 1.2\nT0: 1 Hz\n", 6, "T0", "'Hz' is not a unit of time"),
        ("FC: 1.35\nsoil: B\nVN: 50\nclass: II\nhazard:\n  - [30, 0.06, 2.4, 0.27]\n  - [475, 2 m, 2.4, 0.3]\n",
         7, "hazard[2][2]", "2 m is a length, not an acceleration"),
        ("FC: 1.35\nag: 0.2\nF0: 2.5\nTC: 0.4\nS: 1.2\nfloor: {z: 9 m, H: 600 cm, T1: 0.3, xi1: 5 %, n: 3}\n",
         6, "floor.z", "is above the roof: got 9 m, but the building is 6 m high"),
        ("FC: 1.35\nsoil: B\nag: 2 m/s2\nF0: 2.4\nTC_star: 0.3\nSLC: {ag: 180 gal, F0: 2.4, TC_star: 0.3}\n",
         6, "SLC.ag", "must be more than that of SLV"),
        ("FC: 1.35\nag: 2 m/s2\nF0: 2.5\nTC: 4000 ms\nS: 1.2\n", 4, "TC", "is above T_D"),
        ("FC: 1.35\nag: 0.2\nF0: 2.5\nTC: 0.4\nS: 1.2\nfloor: {z: 3, H: 6, T1: 0.3, xi1: 5 s, n: 3}\n",
         6, "floor.xi1", "must be a number"),
    ],
)  # fmt: skip
def test_a_wrong_unit_is_refused_with_its_line_and_field(tmp_path, text, line, field, words):
    file = tmp_path / "site.yaml"
    file.write_text(text)
    with pytest.raises(InputError) as refused:
        site_of(file)
    (problem,) = refused.value.problems
    assert (problem.file, problem.line, problem.field) == (str(file), line, field) and words in problem.message


def test_all_that_is_wrong_between_fields_is_found_though_one_has_a_unit(tmp_path):
    file = tmp_path / "site.yaml"
    file.write_text("FC: 1.35\nag: 2 m/s2\nF0: 2.5\nTC: 0.4\nS: 1.2\nT0: x\nspectrum: [[0, 0.2], [1, 0.1]]\n")
    with pytest.raises(InputError) as refused:
        site_of(file)
    assert [each.field for each in refused.value.problems] == ["T0", "spectrum"]


WALL = {"width": 0.6, "height": 8.0, "depth": 5.0, "density": 1800.0, "one_sided": "positive"}


@pytest.mark.parametrize(
    ("given", "whole"),
    [
        ({"mass": "2.5 kN/m2", "span": "4 m", "floor": "borne"}, {"mass": 2500 / G * 4 * 5, "floor": "borne"}),
        ({"mass": "300 kg/m2", "span": 6}, {"mass": 300 * 6 * 5.0}),
        ({"mass_per_area": 250.0, "span": 4.0, "seat": 0.2}, {"mass": 250 * 4 * 5.0, "seat": 0.2}),
        ({"force": ["4 kN/m", "-9 kN/m"]}, {"force": [20e3, -45e3]}),
        ({"force": ["4 kN/m", 0]}, {"force": [20e3, 0.0]}),
        ({"force_per_metre": [100.0, -200.0]}, {"force": [500.0, -1000.0]}),
    ],
)
def test_a_load_per_area_or_metre_is_the_whole_load(tmp_path, given, whole):
    file = tmp_path / "wall.yaml"
    file.write_text(yaml.safe_dump({"mechanism": "block", **WALL, "loads": [{"name": "a", "at": [0.0, 5.0], **given}]}))
    wall, other = load_structure(file), rk.Block(**WALL, loads=[{"name": "a", "at": [0.0, 5.0], **whole}])
    assert wall.uplift(wall.directions[0]) == pytest.approx(other.uplift(other.directions[0]), rel=1e-14)
    twice = wall.enlarged(2.0)
    assert twice.loads[0].whole(twice.depth) == pytest.approx(wall.loads[0].whole(wall.depth), rel=1e-15)


def test_the_span_of_a_floor_can_be_designed():
    wall = rk.Block(**WALL, loads=[{"name": "a", "mass": "2.5 kN/m2", "span": 4.0, "at": [0.2, 5.0]}])
    wide = rk.design(wall, ("loads.a.span", 1.0, 12.0), "lambda >= 0.07").value
    m, q = 0.6 * 8 * 1800, 2500 / G * wide  # of a metre of wall
    lambda_ = (m * 0.3 + q * (0.3 - 0.2)) / (m * 4 + q * 5)
    assert lambda_ == pytest.approx(0.07, rel=1e-6)


@pytest.mark.parametrize(
    ("load", "words"),
    [
        ("mass: 2.5 kN/m2", "loads[1].span belongs to a load per area, such as `mass: 2.5 kN/m2`: give both"),
        ("mass: 2.5 kN, span: 4", "loads[1].span belongs to a load per area"),
        ("force: [4 kN/m, 2 kg]", "2 kg is a mass, not a stiffness"),
        ("force: [4 kN/m2, 0]", "4 kN/m2 is a pressure, not a force"),
        ("force: [4 kN/m, 0], floor: borne", "a force has no mass to share"),
        ("force: [4 kN/m, 0], mass: 3", "give one of `mass` and `force`"),
    ],
)
def test_a_load_that_is_not_one_is_refused(tmp_path, load, words):
    file = tmp_path / "wall.yaml"
    file.write_text(yaml.safe_dump({"mechanism": "block", **WALL}) + f"loads: [{{name: a, at: [0, 5], {load}}}]\n")
    with pytest.raises(InputError, match=r"wall\.yaml:7:") as refused:
        load_structure(file)
    assert words in str(refused.value)
    file.write_text(yaml.safe_dump({"mechanism": "block", "width": 0.6, "height": 8.0, "mass": 1e4})
                    + "loads: [{name: a, at: [0, 5], force: [4 kN/m, 0]}]\n")  # fmt: skip
    with pytest.raises(InputError, match="is per metre of wall: give the `depth`"):
        load_structure(file)

"""The church of the examples, drawn with mortar and mirrored blocks, is the structure that formulas give."""

import re
import runpy
from cmath import exp
from math import pi, sin

import pytest
from pytest import approx

import rocking_cli as rk
from rocking_cli import Registry
from rocking_cli.ask.read import is_mesh
from rocking_cli.core import Direction
from rocking_cli.questions.import_drawing.legend import Role, role_of
from tests.conftest import EXAMPLES, PROJECT

CHURCH = EXAMPLES / "drawings" / "church.dxf"
OPTIONS = {"merge_gap": "12 mm", "density": {"MURATURA": 1800, "CONCI": 2200}, "depth": "2 m"}
INNER, OUTER, COUNT, SPRINGING = 3.0, 3.6, 13, 4.5


@pytest.fixture(scope="module")
def church():
    return rk.import_drawing(CHURCH, **OPTIONS)


def voussoir(k):
    """Return a sector of a ring between two radii: no mortar, its arcs as chords, its mass by formula."""
    half = pi / COUNT / 2
    ends, middle = [pi - 2 * half * each for each in (k, k + 1)], pi - half * (2 * k + 1)
    corners = [r * exp(1j * a) for r, a in ((INNER, ends[0]), (OUTER, ends[0]), (OUTER, ends[1]), (INNER, ends[1]))]
    away = 2 / 3 * (OUTER**3 - INNER**3) / (OUTER**2 - INNER**2) * sin(half) / half
    mass = 2200 * 2 * half * (OUTER**2 - INNER**2)
    z = away * exp(1j * middle)
    inertia = mass * ((OUTER**2 + INNER**2) / 2 - away**2)
    points = [[each.real, each.imag + SPRINGING] for each in corners]
    return {"polygon": points, "mass": mass, "centroid": [z.real, z.imag + SPRINGING], "inertia": inertia}


def by_formulas():
    """Return the church in metres from its axis, without mortar."""
    left = {
        "M1": [[-4.6, 0], [-3, 0], [-3, 1.5], [-4.6, 1.5]],
        "M2": [[-4.4, 1.5], [-3, 1.5], [-3, 3], [-4.4, 3]],
        "M3": [[-4.4, 3], [-3, 3], [-3, 4.5], [-4, 4.5], [-4, 3.706], [-4.4, 3.506]],
    }
    right = {f"{name}d": [[-x, y] for x, y in reversed(corners)] for name, corners in left.items()}
    blocks = {name: {"polygon": corners, "density": 1800, "depth": 2.0} for name, corners in (left | right).items()}
    ends = {"from": {"body": "M3", "at": [-3, 4.2]}, "to": {"body": "M3d", "at": [3, 4.2]}}
    return Registry()["assembly"](
        depth=2.0,
        blocks=blocks | {f"C{k + 1}": voussoir(k) for k in range(COUNT)},
        ground={"floor": {"polygon": [[-9, -1], [9, -1], [9, 0], [-9, 0]]}},
        joints={"S": {"slide": "M3", "at": [-3.85, 3.9], "along": [0, 1]}},
        loads=[
            {"name": "left roof", "mass": 3000, "at": [-3.75, 4.494], "body": "M3"},
            {"name": "right roof", "mass": 3000, "at": [3.75, 4.494], "body": "M3d"},
        ],
        ties=[{"name": "bar", **ends, "area": 113e-6, "yield": 235e6}],
    )


def test_it_is_what_formulas_give(church):
    expected = by_formulas()
    masses = [sum(body.mass for body in each.weighed()) for each in (church.structure, expected)]
    assert masses[0] == approx(masses[1], rel=1e-9)
    for side in Direction:
        assert church.structure.uplift(side) == approx(expected.uplift(side), rel=1e-6)
        assert church.structure.critical_rotation(side) == approx(expected.critical_rotation(side), rel=1e-6)


def test_a_drawing_is_no_mesh():
    assert not is_mesh(CHURCH) and not is_mesh(CHURCH.with_name("wall.svg"))


def test_what_is_not_the_structure_is_left_out_and_said(church):
    words = " / ".join(note.words for note in church.notes)
    assert "drawn: 1 support, 2 loads, 1 tie" in words
    for left in ("HATCH on RETINO", "LWPOLYLINE on SQUADRATURA", "DIMENSION on QUOTE", "LINE on ASSI"):
        assert f"left out: {2 if 'DIM' in left else 1} {left}" in words


@pytest.mark.rest
def test_the_drawing_is_what_its_script_makes(church, tmp_path, monkeypatch):
    monkeypatch.setattr("sys.argv", ["church.py", str(tmp_path / "church.dxf")])
    runpy.run_path(str(CHURCH.with_suffix(".py")), run_name="__main__")
    made = rk.import_drawing(tmp_path / "church.dxf", **OPTIONS)
    assert made.fields == church.fields
    assert [note.words for note in made.notes] == [note.words for note in church.notes]


def test_the_page_knows_all_roles_and_refusals():
    page = (PROJECT / "docs" / "import.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `(\w+)` \| ([\w, ]+) \| [^|]+ \|$", page, re.M)
    roles = {role: words.split(", ") for role, words in rows if role in {*Role}}
    assert {*roles} == {*Role}
    assert {word: role_of(word) for words in roles.values() for word in words} == {
        word: role for role, words in roles.items() for word in words
    }
    folders = [
        PROJECT / "rocking_cli" / each for each in ("io/drawings", "questions/import_drawing", "questions/import_mesh")
    ]
    code = "".join(file.read_text(encoding="utf-8") for folder in folders for file in folder.glob("*.py"))
    classes = set(re.findall(r'(?:DrawingError|refused|refusal)\(\s*"(\w+)"', code))
    assert len(classes) > 25 and classes == {each for each in classes if f"`{each}`" in page}

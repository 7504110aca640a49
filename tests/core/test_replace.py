"""Structures are made by the names of fields, and with other values of some of them."""

import copy
import sys

import pytest

import rocking_cli as rk
from rocking_cli.core.registry import Registry
from rocking_cli.core.structure_file import parse_structure
from tests.conftest import EXAMPLES

BLOCK = rk.Block(
    name="pillar", width=0.7, height=2.8, depth=1.0, density=1800.0, restitution=0.9,
    loads=[{"name": "floor", "mass": "12 kN", "at": [0.0, 2.0]}],
)  # fmt: skip
FILES = sorted(EXAMPLES.glob("*.yaml"))


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_a_replaced_field_gives_the_structure_of_a_file_with_it(file, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    made = rk.load_structure(file)
    before = made.model_dump()
    replaced = made.replace(gravity="3.7 m/s2")
    assert replaced == parse_structure(file.read_text("utf-8") + "\ngravity: 3.7\n", str(file), file.stem)
    assert type(replaced) is type(made) and replaced.name == made.name and made.model_dump() == before
    assert made.replace() == made


def test_nothing_is_left_of_what_was_derived_before():
    one = rk.Block(width=0.7, height=2.8)
    assert rk.equiv(one).positive.lambda_ == pytest.approx(0.25)
    assert rk.equiv(one.replace(height=3.5)).positive.lambda_ == pytest.approx(0.2)
    laden = one.replace(mass=900.0, loads=[{"name": "floor", "mass": "12 kN", "at": [0.0, 2.0]}])
    assert "12 kN is a weight" in laden.remarks[0] and not laden.replace(loads=None).remarks


def test_all_other_fields_are_kept():
    higher = BLOCK.replace(height="300 cm")
    assert (
        higher.height == 3.0 and higher.loads == BLOCK.loads and higher.loads[0].mass == pytest.approx(12e3 / 9.80665)
    )
    assert higher.model_dump(exclude={"height"}) == BLOCK.model_dump(exclude={"height"})
    assert BLOCK.replace(name=None).name is None and rk.Block(width=0.7, height=2.8).replace(width=0.5).name is None


def test_a_file_named_by_a_field_is_sought_beside_that_of_the_structure(tmp_path, monkeypatch):
    curve = rk.load_structure(EXAMPLES / "curve.yaml")
    monkeypatch.chdir(tmp_path)
    assert curve.replace(points=None, file="curves/capacity.csv").replace(mass=curve.mass) == curve
    with pytest.raises(rk.InputError, match="file cannot be combined with points"):
        curve.replace(file="curves/capacity.csv")


def test_a_field_may_be_replaced_by_its_other_name():
    wall = rk.Wall(thickness=0.3, height=3.0, depth=2.0)
    assert wall.replace(length=4.0) == wall.replace(depth=4.0) == rk.Wall(thickness=0.3, height=3.0, depth=4.0)
    with pytest.raises(rk.InputError, match="length is the same field as depth: give one of the two"):
        wall.replace(length=4.0, depth=4.0)
    linkage = rk.load_structure(EXAMPLES / "linkage.yaml")
    assert linkage.replace(bodies=linkage.model_dump(by_alias=True)["bodies"]) == linkage


def test_python_replaces_fields_too():
    replace = copy.replace if sys.version_info >= (3, 13) else lambda block, **fields: block.__replace__(**fields)
    assert replace(BLOCK, height=3.0) == BLOCK.replace(height=3.0)
    with pytest.raises(rk.InputError, match="height must be more than 0 m, got -3"):
        replace(BLOCK, height=-3)


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"heigth": 3.0}, "heigth is not a field of block\n  did you mean height?"),
        ({"thickness": 0.3}, "thickness is not a field of block\n  its thickness is given by width"),
        ({"eta": 0.9}, "eta is not a field of block\n  did you mean restitution?"),
        ({"mu": 0.9}, "mu is not a field of block\n  did you mean friction?"),
        ({"damping": 0.05}, "damping has no meaning: a structure that rocks loses energy at its impacts"),
        ({"height": "3 kg"}, "height: 3 kg is a mass, not a length"),
        ({"height": float("nan")}, "height must be a finite number"),
        ({"height": None}, "height must be a number in m, got nothing"),
        ({"depth": None}, "depth is missing: density needs the size out of plane"),
        ({"rebound": 0.5}, "rebound requires one_sided"),
        ({"loads": [{"name": "a", "mass": 1.0}]}, "loads[1].at is missing"),
        ({"\x1b[31m": 1}, r"\x1b[31m is not a field of block"),
        ({"self": 1}, "self is not a field of block"),
    ],
)
def test_wrong_fields_are_an_input_error(fields, words):
    with pytest.raises(rk.InputError) as caught:
        BLOCK.replace(**fields)
    assert words in str(caught.value)


@pytest.mark.parametrize("name", Registry())
def test_fields_without_names_are_told_their_names(name):
    cls = Registry()[name]
    fields = {key: info for key, info in cls.model_fields.items() if key not in rk.Mechanism.model_fields}
    required = [info.alias or key for key, info in (fields | cls.model_fields).items() if info.is_required()]
    with pytest.raises(rk.InputError) as caught:
        cls(0.5, 2.2)
    first, hint = str(caught.value).splitlines()
    named, _, others = first.removeprefix(f"{cls.__name__} takes its fields by name: ").partition("; also ")
    assert [each.partition(" [")[0] for each in named.split(", ")][: len(required)] == required
    assert "gravity [m/s2]" in (others if required else named)
    assert hint == f"  such as {cls.__name__}({', '.join(f'{each}=...' for each in required)})"

"""The files that `rocking new` prints for what people have: each is a structure, stands, and moves."""

import json
from importlib.resources import files

import numpy as np
import pytest

from rocking_cli.core import both_statics
from rocking_cli.core.structure_file import load_structure, parse_structure
from rocking_cli.dynamics.history import follow
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.io.starters import STARTERS
from rocking_cli.io.yaml_file import parse
from rocking_cli.questions.building.description import building_of
from rocking_cli.questions.new.command import BUILDING, EDIFICIO, STUDY
from tests.cli.test_cli import run
from tests.conftest import EXAMPLES
from tests.following import build_model

WORKED = ("facade", "floor_wall", "gable", "statue", "column_with_tendon")
SHAKING = GroundMotion("sine", 0.01, 10 * np.sin(2 * np.pi * np.arange(201) / 100), unit="m/s2")


@pytest.mark.parametrize("name", STARTERS)
def test_a_starter_is_a_structure_that_rocks(name):
    text = run("new", name).stdout
    structure = parse_structure(text, f"{name}.yaml", name)
    assert text.startswith("# ") and structure.name == f"my {name.replace('_', ' ')}".replace(" with tendon", "")
    assert structure.has_mass
    assert all(side.lambda_ > 0.02 for side in both_statics(structure))
    assert follow(build_model(structure, "nonlinear"), SHAKING).lifted


def test_every_starter_is_a_file_of_the_package_and_none_is_forgotten():
    there = {entry.name.removesuffix(".yaml") for entry in (files("rocking_cli") / "data" / "starters").iterdir()}
    assert there == {*STARTERS, STUDY, BUILDING, EDIFICIO}
    assert json.loads(run("new", "facade", "--json").stdout)["starter"] == "facade"


@pytest.mark.parametrize("name", WORKED)
def test_a_worked_example_is_a_structure_that_rocks(name):
    structure = load_structure(EXAMPLES / "walls" / f"{name}.yaml")
    assert follow(build_model(structure, "nonlinear"), SHAKING).lifted


def test_the_building_of_both_languages_is_one():
    english, italian = (
        building_of(parse(run("new", *words).stdout, "house.yaml", "building", ""))
        for words in (["building"], ["edificio", "--language", "it"])
    )
    names = dict(zip([each.name for each in italian.walls], [each.name for each in english.walls], strict=True))
    assert names == {"facciata": "front", "retro": "back", "sinistra": "left", "destra": "right"}
    assert (english.language, italian.language) == (None, "it")
    assert english.levels == italian.levels and english.masonry.density == italian.masonry.density
    assert [each.thickness for each in english.walls] == [each.thickness for each in italian.walls]
    assert [each.connection for each in english.walls] == [each.connection for each in italian.walls]
    assert [each.openings for each in english.walls] == [each.openings for each in italian.walls]
    assert [each.diameter for each in english.ties] == [each.diameter for each in italian.ties] == [0.02]

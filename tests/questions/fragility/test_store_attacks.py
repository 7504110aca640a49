"""A store under attack loses nothing, and never gives other results without a word."""

import random
import shutil

import pytest

from tests.stores import RUNS, Sound, attack, race, sql

pytestmark = pytest.mark.rest


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    return Sound(tmp_path_factory.mktemp("sound"))


@pytest.mark.parametrize("number", range(13))  # each kind once; `make soak` tries hundreds
def test_damage_is_told(sound, tmp_path, number):
    attack(sound, tmp_path / "attacked", number)


@pytest.mark.parametrize("statement", RUNS[::4])
def test_changes_by_another_program_are_told(sound, tmp_path, statement):
    attack(sound, tmp_path / "attacked", 0, statement)


@pytest.mark.parametrize("statement", RUNS)
def test_each_of_these_changes_can_be_made(sound, tmp_path, statement):
    place = tmp_path / "store.db"
    shutil.copyfile(sound.store, place)
    assert sql(place, random.Random(0), sound, statement)


@pytest.mark.parametrize("options", [[], ["--restart"]])
def test_of_three_that_begin_together_none_loses_the_store_of_another(sound, tmp_path, options):
    race(sound, tmp_path / "raced", *options)  # `make soak` has fifty of them

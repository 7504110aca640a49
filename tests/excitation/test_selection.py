"""Which record files are meant by names and patterns."""

from pathlib import Path

import pytest

from rocking_cli.errors import InputError
from rocking_cli.excitation.records.opening import matching_files


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "deep" / "er").mkdir(parents=True)
    for name in ("b.AT2", "a.AT2", ".hidden.AT2", "deep/c.AT2", "deep/er/d.AT2", "odd[1].AT2"):
        (tmp_path / name).write_text("x")
    return tmp_path


def names(paths):
    return [each.name for each in paths]


def test_a_file_is_itself(folder):
    assert matching_files("a.AT2", folder) == [folder / "a.AT2"]
    assert matching_files(str(folder / "a.AT2")) == [folder / "a.AT2"]


def test_without_a_folder_it_is_relative_to_the_process(folder, monkeypatch):
    monkeypatch.chdir(folder)
    assert matching_files("deep/*.AT2") == [Path("deep/c.AT2")]


def test_a_pattern_gives_files_in_order_without_hidden_ones(folder):
    assert names(matching_files("*.AT2", folder)) == ["a.AT2", "b.AT2", "odd[1].AT2"]
    assert names(matching_files(str(folder / "?.AT2"))) == ["a.AT2", "b.AT2"]
    assert names(matching_files("deep/**/*.AT2", folder)) == ["c.AT2", "d.AT2"]


def test_a_name_that_looks_like_a_pattern_is_a_name_first(folder):
    assert names(matching_files("odd[1].AT2", folder)) == ["odd[1].AT2"]


@pytest.mark.parametrize(
    ("place", "said"),
    [("none.AT2", "no such file"), ("deep", "this is a folder"), ("*.csv", "no file matches"), ("a**b*", "pattern")],
)
def test_what_is_not_there_is_refused(folder, place, said):
    with pytest.raises(InputError, match=said):
        matching_files(place, folder)

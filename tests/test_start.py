"""What makes a command start fast, and must not change what it says."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from importlib import metadata

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rocking_cli import cache
from rocking_cli.median import median
from rocking_cli.patterns import regex
from rocking_cli.plugins import points
from rocking_cli.plugins.points import OURS, Point, entry_points

GROUP = "rocking.laws"
DECLARED = f"[{GROUP}]\nodd = elsewhere.law:Odd\n"


@pytest.fixture
def kept(tmp_path, monkeypatch):
    """The file of a cache folder of its own, in a process that has read nothing yet."""
    monkeypatch.setattr(cache, "folder", lambda: tmp_path / "cache")
    monkeypatch.setattr(points, "_POINTS", {})
    return tmp_path / "cache" / points.FILE


@pytest.fixture
def site(tmp_path, monkeypatch):
    """A folder that Python imports from."""
    folder = tmp_path / "site"
    folder.mkdir()
    monkeypatch.syspath_prepend(folder)
    return folder


def declare(site, text=DECLARED, version="1.0"):
    folder = site / "odd-1.0.dist-info"
    folder.mkdir(exist_ok=True)
    (folder / "METADATA").write_text(f"Metadata-Version: 2.1\nName: odd\nVersion: {version}\n", encoding="utf-8")
    (folder / "entry_points.txt").write_text(text, encoding="utf-8")
    return folder


def of_odd():
    points._POINTS.clear()  # as another process would begin
    return [point for point in entry_points(GROUP) if point.package.startswith("odd ")]


ODD = Point("odd", "elsewhere.law:Odd", GROUP, "odd 1.0")


class TestEntryPoints:
    def test_they_are_those_that_python_finds(self, kept):
        found = [
            Point(point.name, point.value, point.group, f"{point.dist.name} {point.dist.version}")
            for group in metadata.entry_points().groups
            if group.startswith(OURS)
            for point in metadata.entry_points(group=group)
        ]
        assert len(found) > 20
        for _ in range(2):  # searched for, and from the file
            points._POINTS.clear()
            told = [point for group in {each.group for each in found} for point in entry_points(group)]
            assert sorted(told, key=repr) == sorted(found, key=repr)
        assert kept.is_file()

    def test_the_second_process_does_not_search(self, kept, monkeypatch):
        found = entry_points("rocking.mechanisms")
        points._POINTS.clear()
        monkeypatch.setattr(points, "_read", lambda: pytest.fail("searched"))
        assert found and entry_points("rocking.mechanisms") == found

    def test_a_package_that_comes_changes_and_goes_is_noticed(self, kept, site):
        assert of_odd() == []
        folder = declare(site)
        assert of_odd() == [ODD]
        declare(site, DECLARED.replace("Odd", "Other"))
        assert [point.value for point in of_odd()] == ["elsewhere.law:Other"]
        declare(site, version="1.1")
        os.utime(folder / "METADATA", ns=(1, 1))  # whatever the clock of the file system
        assert [point.package for point in of_odd()] == ["odd 1.1"]
        (folder / "entry_points.txt").unlink()
        assert of_odd() == []

    def test_a_package_of_other_plugins_alone_is_none_of_ours(self, kept, site):
        declare(site, "[console_scripts]\nodd = elsewhere.law:run\n")
        assert of_odd() == []

    def test_of_two_versions_the_one_that_is_imported_counts(self, kept, site, tmp_path, monkeypatch):
        declare(site, DECLARED.replace("Odd", "Hidden"))
        first = tmp_path / "first"
        first.mkdir()
        monkeypatch.syspath_prepend(first)
        declare(first)
        assert [point.value for point in of_odd()] == ["elsewhere.law:Odd"]

    @pytest.mark.rest
    @pytest.mark.parametrize(
        "content",
        [
            b"",
            b"{",
            b"[]",
            b"[1]",
            b"\xff",
            b'{"%s": 3}',
            b'{"%s": [["a"]]}',
            b'{"%s": [[1, 2, 3, 4, 5]]}',
            b"[" * 10_000,
        ],
    )
    def test_a_damaged_file_costs_time_alone(self, kept, site, content):
        declare(site)
        assert of_odd() == [ODD]
        whole = kept.read_bytes()
        state = next(iter(json.loads(whole)))
        kept.write_bytes(content.replace(b"%s", state.encode()))
        assert of_odd() == [ODD]
        assert state in json.loads(kept.read_bytes())

    def test_where_nothing_can_be_kept_they_are_found(self, kept, site):
        kept.parent.write_text("a file where the folder should be", encoding="utf-8")
        declare(site)
        assert of_odd() == [ODD]

    def test_a_full_disk_leaves_nothing_behind(self, kept, site, monkeypatch):
        def full(*given):
            raise OSError(28, "No space left on device")

        monkeypatch.setattr(cache.os, "fdopen", full)
        declare(site)
        assert of_odd() == [ODD] and list(kept.parent.iterdir()) == []

    def test_packages_that_only_their_finder_knows_are_found(self, kept, site, monkeypatch):
        class Finder:
            @staticmethod
            def find_spec(*given):
                return None

            @staticmethod
            def find_distributions(context):
                return [metadata.PathDistribution(folder)]

        folder = declare(site)
        sys.path.remove(str(site))
        assert of_odd() == []
        monkeypatch.setattr(sys, "meta_path", [*sys.meta_path, Finder])
        assert of_odd() == [ODD]

    def test_few_environments_are_kept(self, kept, tmp_path, monkeypatch):
        monkeypatch.setattr(points, "MOST", 3)
        for k in range(5):
            monkeypatch.setattr(sys, "path", [*sys.path, str(tmp_path / str(k))])
            entry_points(GROUP)
        assert len(json.loads(kept.read_bytes())) == 3

    def test_a_value_may_have_extras_and_deep_attributes(self):
        assert Point("a", "collections.abc:Mapping.get [more]", GROUP).load() is metadata.EntryPoint(
            "a", "collections.abc:Mapping.get [more]", GROUP
        ).load()  # fmt: skip
        assert Point("a", "json", GROUP).load() is json


@given(st.lists(st.floats(allow_nan=False, allow_infinity=False, width=32), min_size=1))
def test_the_median_is_that_of_numpy(values):
    assert median(np.array(values)) == np.median(values)


def test_the_median_of_what_is_no_number_is_none():
    assert np.isnan(median(np.array([1.0, np.nan, 2.0])))


def test_a_regular_expression_is_compiled_when_it_is_used(monkeypatch):
    tried = []
    monkeypatch.setattr(re, "compile", lambda *given, real=re.compile: tried.append(given) or real(*given))
    word = regex("A+", re.IGNORECASE)
    assert tried == []
    assert word.match("aab")[0] == "aa" and word.search("b") is None and word.match("Ab")[0] == "A"
    assert tried == [("A+", re.IGNORECASE)] * 2  # once for each of its methods


def test_whoever_imports_the_package_keeps_the_documentation_of_matplotlib():
    code = (
        "import rocking_cli.plotting.style, matplotlib.patches as p; "
        "assert 'facecolor' in p.Patch.set.__doc__; assert 'facecolor' in p.Rectangle.__init__.__doc__"
    )
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stderr == ""

"""What is released and where it is tested: the script, the workflow, the Makefile and the metadata say the same.

`make release` itself builds, installs and tries; here is what it rests on.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tomllib
from importlib import import_module

import pytest
import yaml

from tests.conftest import PROJECT
from tests.elsewhere import VERSIONS
from tests.test_cli import run

MAKEFILE = (PROJECT / "Makefile").read_text(encoding="utf-8")
README = (PROJECT / "README.md").read_text(encoding="utf-8")
WORKFLOW = yaml.safe_load((PROJECT / ".github" / "workflows" / "tests.yml").read_text(encoding="utf-8"))
PYPROJECT = tomllib.loads((PROJECT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
CLASSIFIERS = PYPROJECT["classifiers"]
NEEDS_MAKE = pytest.mark.skipif(shutil.which("make") is None, reason="no make here")


@pytest.fixture(scope="module")
def release():
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(PROJECT / "scripts")
        yield import_module("release")


class TestScript:
    def test_every_command_that_the_readme_shows_is_run(self, release):
        found = release.commands(README)
        assert len(found) == README.count("\n    rocking ") > 15
        assert all(words[0] == "rocking" and "#" not in words for words in found)
        assert ["rocking", "new", "asymmetric_frame", ">", "frame.yaml"] in found
        assert release.written(["rocking", "draw", "--plot", "a.png", "-o", "b", ">", "c"]) == ["a.png", "b", "c"]

    def test_the_python_that_the_readme_shows_is_run(self, release):
        compile(release.script(README), "README.md", "exec")
        assert "print(respond_many(" in release.script(README)

    def test_a_command_that_fails_ends_it(self, release, tmp_path):
        assert release.run([sys.executable, "-c", "print(1)"], tmp_path, tmp_path / "said") == "1\n"
        assert (tmp_path / "said").read_text(encoding="utf-8") == "1\n"
        with pytest.raises(SystemExit, match="exit code 3"):
            release.run([sys.executable, "-c", "raise SystemExit(3)"], tmp_path)

    def test_the_records_of_the_readme_are_read(self, release, tmp_path):
        release.at2(PROJECT / "examples" / "accel.csv", tmp_path / "a.AT2")
        assert "1201" in run("record", "a.AT2").stdout and "0.55" in run("record", "a.AT2").stdout


class TestWorkflow:
    JOBS = WORKFLOW["jobs"]

    def test_it_runs_on_what_the_metadata_name(self):
        said = [each.rpartition(" :: ")[2] for each in CLASSIFIERS if re.search(r"Python :: 3\.\d", each)]
        matrix = self.JOBS["test"]["strategy"]["matrix"]
        assert matrix["python"] == said == [f"{major}.{minor}" for major, minor in VERSIONS]
        assert PYPROJECT["requires-python"] == f">={said[0]}"
        systems = {"ubuntu-latest": "POSIX :: Linux", "macos-latest": "MacOS", "windows-latest": "Microsoft :: Windows"}
        named = [each.partition(" :: ")[2] for each in CLASSIFIERS if each.startswith("Operating System")]
        assert sorted(systems[each] for each in matrix["os"]) == sorted(named)

    def test_it_calls_targets_of_the_makefile_and_nothing_else(self):
        targets = set(re.findall(r"^([a-z-]+):", MAKEFILE, re.M))
        lines = [step["run"].split() for job in self.JOBS.values() for step in job["steps"] if "run" in step]
        called = [word for make, *words in lines for word in words if "=" not in word]
        assert all(line[0] == "make" and "PYTHON=python" in line for line in lines)
        assert set(called) <= targets
        assert {"test", "selfcheck", "lint", "type", "contracts", "docs", "release", "same-kernels"} == set(called)

    def test_it_keeps_what_pip_fetched_and_may_change_nothing(self):
        assert WORKFLOW["permissions"] == {"contents": "read"}
        for job in self.JOBS.values():
            (python,) = (step["with"] for step in job["steps"] if "setup-python" in step.get("uses", ""))
            assert python["cache"] == "pip"
            assert (PROJECT / python["cache-dependency-path"]).is_file()


@NEEDS_MAKE
class TestMakefile:
    def planned(self, target, tmp_path):
        """The commands of a target where nothing is installed yet."""
        words = ["make", "--no-print-directory", "--dry-run", target, f"VENV={(tmp_path / 'venv').as_posix()}"]
        alone = {key: value for key, value in os.environ.items() if not key.startswith(("MAKE", "MFLAGS"))}
        return subprocess.run(words, cwd=PROJECT, check=True, capture_output=True, encoding="utf-8", env=alone).stdout

    def test_the_demo_installs_the_package_alone(self, tmp_path):
        assert "--editable ." in self.planned("demo", tmp_path)
        assert "[" not in self.planned("demo", tmp_path)
        assert ".[dev]" in self.planned("test", tmp_path)

    def test_a_release_needs_its_own_tools_only(self, tmp_path):
        planned = self.planned("release", tmp_path)
        assert ".[release]" in planned and ".[dev]" not in planned and "scripts/release.py" in planned

    def test_every_target_is_named_as_one(self):
        phony = set(re.search(r"^\.PHONY: ((?:.*\\\n)*.*)$", MAKEFILE, re.M)[1].replace("\\", "").split())
        assert phony == set(re.findall(r"^([a-z-]+):", MAKEFILE, re.M))

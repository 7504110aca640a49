"""What is released and where it is tested: the script, the workflow, the Makefile and the metadata say the same.

`make release` itself builds, installs and tries; here is what it rests on.
"""

import json
import os
import re
import shutil
import subprocess
import sys
import tomllib
import zipfile
from importlib import import_module

import pytest
import yaml
from packaging.requirements import Requirement
from packaging.tags import parse_tag, sys_tags
from packaging.utils import canonicalize_name, parse_wheel_filename

from rocking_cli.dynamics import shipped
from tests.cli.test_cli import run
from tests.conftest import PROJECT
from tests.elsewhere import VERSIONS

MAKEFILE = (PROJECT / "Makefile").read_text(encoding="utf-8")
README = (PROJECT / "README.md").read_text(encoding="utf-8")
WORKFLOW = yaml.safe_load((PROJECT / ".github" / "workflows" / "tests.yml").read_text(encoding="utf-8"))
VERSIONED = yaml.safe_load((PROJECT / ".github" / "workflows" / "versions.yml").read_text(encoding="utf-8"))
SETTINGS = tomllib.loads((PROJECT / "pyproject.toml").read_text(encoding="utf-8"))
PYPROJECT = SETTINGS["project"]
CLASSIFIERS = PYPROJECT["classifiers"]
TARGET = re.compile(r"^([a-z][a-z -]*):", re.M)
NEEDS_MAKE = pytest.mark.skipif(shutil.which("make") is None, reason="no make here")


@pytest.fixture(scope="module")
def release():
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(PROJECT / "scripts")
        yield import_module("release")


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A wheel of the sources, with all libraries."""
    pytest.importorskip("wheel", reason="wheels for each system are made by `wheel`")
    folder = tmp_path_factory.mktemp("whole")
    words = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
    subprocess.run(words, cwd=PROJECT, check=True, capture_output=True)
    (made,) = folder.iterdir()
    return made


class TestScript:
    def test_every_command_that_the_readme_shows_is_run(self, release):
        found = release.commands(README)
        assert len(found) == README.count("\n    rocking ") > 2
        assert all(words[0] == "rocking" and "#" not in words for words in found)
        assert ["rocking", "new", "block", ">", "block.yaml"] in found
        assert release.written(["rocking", "draw", "--plot", "a.png", "-o", "b", ">", "c"]) == ["a.png", "b", "c"]

    def test_the_python_that_the_readme_shows_is_run(self, release):
        compile(release.script(README), "README.md", "exec")
        assert "rk.respond_each(" in release.script(README)

    def test_a_command_that_fails_ends_it(self, release, tmp_path):
        assert release.run([sys.executable, "-c", "print(1)"], tmp_path, tmp_path / "said") == "1\n"
        assert (tmp_path / "said").read_text(encoding="utf-8") == "1\n"
        with pytest.raises(SystemExit, match="exit code 3"):
            release.run([sys.executable, "-c", "raise SystemExit(3)"], tmp_path)

    def test_the_records_of_the_readme_are_read(self, release, tmp_path):
        release.at2(PROJECT / "examples" / "accel.csv", tmp_path / "a.AT2")
        assert "1201" in run("record", "a.AT2", "--all").stdout and "0.55" in run("record", "a.AT2").stdout


class TestWheels:
    def test_every_library_has_its_platforms_and_that_of_this_system_fits_here(self, release):
        assert set(release.LIBRARIES) <= set(release.PLATFORMS)
        tags = {name: parse_tag(f"py3-none-{platforms}") for name, platforms in release.PLATFORMS.items()}
        assert {name for name, each in tags.items() if each & set(sys_tags())} == {shipped.place().name}

    @pytest.mark.rest
    @pytest.mark.parametrize("library", [shipped.place().name, "win32-x86_64.dll", None])
    def test_a_wheel_has_its_library_alone_and_knows_it(self, release, whole, library, tmp_path):
        made = release.with_library(whole, library, tmp_path)
        *_, tags = parse_wheel_filename(made.name)
        assert tags == parse_tag(f"py3-none-{'any' if library is None else release.PLATFORMS[library]}")
        with zipfile.ZipFile(made) as packed, zipfile.ZipFile(whole) as source:
            ready = {name for name in packed.namelist() if "/ready/" in name}
            listed = json.loads(packed.read("rocking_cli/dynamics/ready/manifest.json"))["files"]
            (metadata,) = (packed.read(name).decode() for name in packed.namelist() if name.endswith("/WHEEL"))
            left_out = {name.rpartition("/")[2] for name in {*source.namelist()} - {*packed.namelist()}}
            packed.extractall(tmp_path / "there")
        own = {shipped.FOR_PAGES, *([library] if library else [])}
        assert {name.rpartition("/")[2] for name in ready} == {"manifest.json", *own}
        assert {*listed} == own and left_out == {*shipped.manifest()["files"]} - own
        assert f"Root-Is-Purelib: {str(library is None).lower()}" in metadata
        code = "import rocking_cli; from rocking_cli.dynamics import ways; print(repr(ways.fault_of_shipped()))"
        environment = {**os.environ, "PYTHONPATH": str(tmp_path / "there")}
        words = [sys.executable, "-c", code]
        done = subprocess.run(words, cwd=tmp_path, env=environment, check=True, capture_output=True, encoding="utf-8")
        assert done.stdout.startswith("None" if library == shipped.place().name else f"ImportError('{shipped.FOR_ALL}")

    def test_what_should_warn_and_does_not_ends_it(self, release, tmp_path):
        words = [sys.executable, "-c", "import sys; sys.stderr.write('slow')"]
        assert release.run(words, tmp_path, warned="slow") == ""
        with pytest.raises(SystemExit, match="does not say 'fast'"):
            release.run(words, tmp_path, warned="fast")


def targets():
    """The targets of the Makefile."""
    return {name for names in TARGET.findall(MAKEFILE) for name in names.split()}


class TestWorkflow:
    JOBS = WORKFLOW["jobs"]

    @staticmethod
    def matrix(workflow):
        return workflow["jobs"]["test"]["strategy"]["matrix"]

    def test_it_runs_on_what_the_metadata_name(self):
        said = [each.rpartition(" :: ")[2] for each in CLASSIFIERS if re.search(r"Python :: 3\.\d", each)]
        matrix = self.matrix(WORKFLOW)
        assert matrix["python"] == said == list(VERSIONS)
        assert PYPROJECT["requires-python"] == f">={said[0]}"
        systems = {"ubuntu-latest": "POSIX :: Linux", "macos-latest": "MacOS", "windows-latest": "Microsoft :: Windows"}
        named = [each.partition(" :: ")[2] for each in CLASSIFIERS if each.startswith("Operating System")]
        assert sorted(systems[each] for each in matrix["os"]) == sorted(named)

    def test_it_calls_targets_of_the_makefile_and_nothing_else(self):
        jobs = [*self.JOBS.values(), *VERSIONED["jobs"].values()]
        lines = [step["run"].split() for job in jobs for step in job["steps"] if "run" in step]
        called = {word for make, *words in lines for word in words if "=" not in word}
        assert all(line[0] == "make" and "PYTHON=python" in line for line in lines)
        (chosen,) = (line[1:-1] for line in lines if "matrix.versions" in " ".join(line))
        called = called - set(chosen) | {f"test-{each}" for each in self.matrix(VERSIONED)["versions"]}
        assert called <= targets()
        assert called == {
            "test", "test-all", "test-newest", "test-oldest", "selfcheck", "lint", "type", "contracts", "docs-check",
            "release", "same-kernels",
        }  # fmt: skip

    def test_it_keeps_what_pip_fetched_and_may_change_nothing(self):
        assert WORKFLOW["permissions"] == VERSIONED["permissions"] == {"contents": "read"}
        for job in [*self.JOBS.values(), *VERSIONED["jobs"].values()]:
            (python,) = (step["with"] for step in job["steps"] if "setup-python" in step.get("uses", ""))
            assert python["cache"] == "pip"
            assert (PROJECT / python["cache-dependency-path"]).is_file()


def test_what_is_held_is_what_may_be_installed():
    """Every dependency has a version in constraints.txt, which `make constraints` writes."""
    held = {}
    for line in (PROJECT / "constraints.txt").read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            each = Requirement(line)
            held.setdefault(canonicalize_name(each.name), []).append(each)
    groups = PYPROJECT["dependencies"], *PYPROJECT["optional-dependencies"].values()
    for wanted in map(Requirement, (text for group in groups for text in group)):
        versions = [next(iter(each.specifier)).version for each in held[canonicalize_name(wanted.name)]]
        assert versions and all(wanted.specifier.contains(each) for each in versions), wanted


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

    def test_versions_are_held_wherever_something_is_installed_but_in_two_tests_of_versions(self, tmp_path):
        for target in ("demo", "test", "docs", "release"):
            installs = [line for line in self.planned(target, tmp_path).splitlines() if "pip install" in line]
            assert installs and all("--constraint constraints.txt" in line for line in installs), target
        for target, resolution in (("test-newest", "highest"), ("test-oldest", "lowest-direct")):
            (free,) = (line for line in self.planned(target, tmp_path).splitlines() if "uv pip install" in line)
            assert f"--resolution {resolution}" in free and "constraint" not in free

    def test_every_tier_runs_somewhere_and_is_explained(self, tmp_path):
        tiers = {each.partition(":")[0] for each in SETTINGS["tool"]["pytest"]["ini_options"]["markers"]} - {
            "every(n)",
            "drawn",
            "again",
        }
        later = " or ".join(sorted(tiers))
        named = {target: re.findall(r'-m "(.*?)"', self.planned(target, tmp_path)) for target in ("test", "test-all")}
        first, rest = named["test-all"]
        assert named["test"] == [first] == [f"not ({rest})"]
        assert " or ".join(sorted(rest.split(" or "))) == later
        contributing = (PROJECT / "CONTRIBUTING.md").read_text(encoding="utf-8")
        assert all(f"`{tier}`" in contributing for tier in tiers)

    def test_a_release_needs_its_own_tools_only(self, tmp_path):
        planned = self.planned("release", tmp_path)
        assert ".[release]" in planned and ".[dev]" not in planned and "scripts/release.py" in planned

    def test_every_target_is_named_as_one(self):
        phony = set(re.search(r"^\.PHONY: ((?:.*\\\n)*.*)$", MAKEFILE, re.M)[1].replace("\\", "").split())
        assert phony == targets()

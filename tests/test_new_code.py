"""`rocking new --plugin NAME --code` writes a package that works in an environment of its own."""

from __future__ import annotations

import ast
import builtins
import json
import re
import subprocess
import sys
import sysconfig
import tomllib
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path

import pytest
import yaml

import rocking_cli as rk
from rocking_cli import core
from rocking_cli.cli.new_plugin import CODE, IMPORTED, LONGEST, loaded, package
from rocking_cli.io.yaml_file import parse
from rocking_cli.studies import verification
from rocking_cli.studies.verification.code import Code
from rocking_cli.studies.verification.site_file import site_of
from tests.conftest import PROJECT
from tests.test_cli import run, run_json

NAME = "my_code"
FILES = ["pyproject.toml", "rocking_my_code.py", "tests/test_my_code.py", "README.md", "site.yaml"]


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """The package, and what was printed."""
    folder = tmp_path_factory.mktemp("plugin") / "code"
    return folder, run("new", "--plugin", NAME, "--code", "-o", folder).stdout


def there(folder):
    return sorted(file.relative_to(folder).as_posix() for file in Path(folder).rglob("*") if file.is_file())


def code_in(folder):
    file = folder / f"rocking_{NAME}.py"
    return loaded(file.read_text(encoding="utf-8"), str(file))


class TestPackage:
    def test_it_says_what_it_wrote_and_what_to_type_next(self, written):
        folder, said = written
        assert there(folder) == sorted(FILES) and "template of the code my_code" in said
        assert all(f" {file} " in said for file in FILES)
        commands = [line.strip() for line in said.partition("Next:\n")[2].splitlines()]
        assert commands[0] == f"cd {folder}" and commands[-1].endswith(" -m pytest")
        assert commands[1].endswith('-m pip install --editable ".[test]"')
        assert commands[2:-1] == ["rocking verify --site site.yaml"]

    def test_its_name_is_everywhere(self):
        texts = {file: text.decode() for file, text in package("uni_test", CODE).items()}
        assert not [file for file, text in texts.items() if re.search("my.?code", text, re.I)]
        assert not [file for file in texts if "my" in file]
        declared = tomllib.loads(texts["pyproject.toml"])["project"]
        assert declared["name"] == "rocking-uni-test"
        assert declared["entry-points"]["rocking.codes"] == {"uni_test": "rocking_uni_test:UniTest"}
        assert yaml.safe_load(texts["site.yaml"])["code"] == "uni_test"
        assert "rocking new site --code uni_test > site.yaml" in texts["README.md"]

    def test_it_is_a_complete_code_whose_site_is_one(self, written):
        cls = code_in(written[0])
        assert issubclass(cls, Code) and not cls.__abstractmethods__ and cls.key == NAME
        text = (written[0] / "site.yaml").read_text(encoding="utf-8")
        site = site_of(parse(text, "site.yaml", "site", ""), [NAME], lambda name: cls.site).site
        assert (site.code, site.a_service, site.a_ultimate, site.importance) == (NAME, 0.08, 0.25, 1.0)
        found = cls().verify(rk.Block(width=0.7, height=2.8), site)
        for each in found.directions.values():
            assert each.ratio == pytest.approx(2 * 0.25 / 0.25) and each.governs == "ultimate" and each.remarks == []
            assert [(line.symbol, line.value, line.clause) for line in each.workings] == [
                ("a_[0]", pytest.approx(0.25), "4.1"), ("a_[u]", pytest.approx(0.5), "4.2"),
            ]  # fmt: skip
        rocks = cls().verify(rk.Block(width=0.14, height=2.8), site).directions[core.Direction.POSITIVE]
        assert rocks.remarks == ["The structure rocks at the serviceability limit state."] and not rocks.passed

    @pytest.mark.rest
    @pytest.mark.parametrize("name", ["q", NAME, "a" * LONGEST, "_".join("abcdefghijklmnopqrst")])
    def test_its_code_is_clean_whatever_its_name(self, name, tmp_path):
        pytest.importorskip("ruff", reason="no ruff here")
        for file, content in package(name, CODE).items():
            (tmp_path / file).parent.mkdir(exist_ok=True)
            (tmp_path / file).write_bytes(content)
        ruff = [sys.executable, "-m", "ruff"]
        rules = ["--extend-select", "E,F,W,I,UP,B,SIM,RUF,PTH,C4"]
        for words in (["check", *rules], ["format", "--check"]):
            done = subprocess.run([*ruff, *words, "--no-cache", "."], cwd=tmp_path, capture_output=True, text=True)
            assert done.returncode == 0, done.stdout + done.stderr


class TestNames:
    @pytest.mark.parametrize(
        ("name", "said"),
        [
            (
                "my code",
                "cannot be the name of a code\n  use at most 40 of a-z, 0-9 and _, a letter first, such as my_code",
            ),
            ("EC8", "such as ec8"),
            ("NTC2018", "such as ntc2018"),
            ("9", "such as my_code"),
            ("class", "a code cannot be called class: it is a keyword of Python"),
            ("json", "Python has a module of this name"),
            ("yes", "in a site file this word is not read as text"),
            ("block", "the mechanism block already exists, in rocking-cli"),
            ("method", "its class would be Method"),
            ("site_fields", "its class would be SiteFields"),
            ("verified", "its class would be Verified"),
        ],
    )
    def test_a_name_that_cannot_be_one_is_refused_in_plain_words(self, name, said):
        text = run("new", "--plugin", "--code", "--", name, code=2).stderr
        assert said in text and text.startswith("error: ") and there(".") == []

    def test_an_installed_code_is_refused(self, monkeypatch):
        real = entry_points
        point = EntryPoint("uni_test", "json:dumps", "rocking.codes")
        more = {"rocking.codes": [point]}
        monkeypatch.setattr(
            "rocking_cli.plugins.registry.entry_points", lambda group: [*real(group=group), *more.get(group, [])]
        )
        text = run("new", "--plugin", "uni_test", "--code", code=2).stderr
        assert "the code uni_test already exists, in unknown package" in text and there(".") == []

    def test_the_name_may_stand_at_the_option(self):
        found = run_json("new", "--plugin", "--code", "uni_test")
        assert found["plugin"] == "uni_test" and found["folder"] == "rocking-uni-test"
        assert there("rocking-uni-test") == sorted(file.replace("my_code", "uni_test") for file in FILES)
        assert found["commands"][0] == "cd rocking-uni-test"

    def test_no_class_has_the_name_of_one_that_its_files_import(self):
        known = {*IMPORTED, *vars(core), *vars(verification), *vars(builtins)}
        for content in [text for file, text in package(NAME, CODE).items() if file.endswith(".py")]:
            tree = ast.parse(content)
            names = {
                each.name for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) for each in node.names
            } | {node.name for node in tree.body if isinstance(node, ast.ClassDef)}
            assert {each for each in names if each[0].isupper()} - known <= {"MyCode", "TestContract"}


@pytest.mark.rest
def test_it_works_in_an_environment_of_its_own(written, tmp_path):
    """As a newcomer does it, but for the network: a new environment, installed from its folder, used and tested."""
    pytest.importorskip("hatchling", reason="pip cannot build it without a network: no hatchling here")
    folder, _ = written
    done = subprocess.run(
        [sys.executable, "-m", "venv", "--system-site-packages", "--without-pip", str(tmp_path / "venv")],
        capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    inside = {"base": str(tmp_path / "venv"), "platbase": str(tmp_path / "venv")}
    packages, scripts = (Path(sysconfig.get_path(name, "venv", inside)) for name in ("purelib", "scripts"))
    # What is installed here is there too: rocking-cli and all that it needs.
    ours = dict.fromkeys([str(PROJECT), *map(sysconfig.get_path, ("purelib", "platlib"))])
    (packages / "ours.pth").write_text("".join(f"{each}\n" for each in ours), encoding="utf-8")

    def ran(*words, code=0):
        python = str(scripts / Path(sys.executable).name)
        done = subprocess.run([python, *words], cwd=folder, capture_output=True, text=True, encoding="utf-8")
        assert done.returncode == code, done.stdout + done.stderr
        return done.stdout

    pip = ("-m", "pip", "install", "--quiet", "--no-deps", "--no-build-isolation", "--no-index")
    ran(*pip, ".")
    assert (packages / f"rocking_{NAME}.py").exists() and not (packages / "tests").exists()
    rocking = ("-m", "rocking_cli")
    found = json.loads(ran(*rocking, "verify", "--site", "site.yaml", "--json"))  # a block with lambda = 0.25
    assert found["code"] == NAME
    assert [each["ratio"] for each in found["directions"].values()] == pytest.approx([2.0, 2.0])
    assert (
        ran(*rocking, "new", "site", "--code", NAME).splitlines()[4:]
        == ((folder / "site.yaml").read_text(encoding="utf-8").splitlines()[4:])
    )
    listed = json.loads(ran(*rocking, "info", "--json"))["plugins"]["codes"]
    assert {"name": NAME, "package": "rocking-my-code 0.1.0", "broken": None} in listed
    assert " 12 passed" in f" {ran('-P', '-m', 'pytest', '-q', '-p', 'no:cacheprovider')}".replace("\n", " ")

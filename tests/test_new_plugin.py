"""`rocking new --plugin` writes a package that works as it is, and writes it whole or not at all."""

from __future__ import annotations

import ast
import builtins
import errno
import json
import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
import yaml
from PIL import Image

from rocking_cli import core
from rocking_cli.cli.new import SITE, STARTERS, STUDY
from rocking_cli.cli.new_plugin import IMPORTED, LONGEST, loaded, package
from rocking_cli.core import Direction, equivalent_block
from rocking_cli.testing import contract
from rocking_cli.views.template import template
from tests.test_cli import run, run_json

NAME = "leaning_pier"
FILES = [
    "pyproject.toml", "rocking_leaning_pier.py", "tests/test_leaning_pier.py", "README.md", "leaning_pier.yaml",
    "leaning_pier.png",
]  # fmt: skip


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """The package, and what was printed."""
    folder = tmp_path_factory.mktemp("plugin") / "pier"
    return folder, run("new", "--plugin", NAME, "-o", folder).stdout


def there(folder):
    return sorted(file.relative_to(folder).as_posix() for file in Path(folder).rglob("*") if file.is_file())


def in_this_folder():
    return sorted(each.name for each in Path().iterdir())


def mechanism(folder):
    file = folder / f"rocking_{NAME}.py"
    return loaded(file.read_text(encoding="utf-8"), str(file))


class TestPackage:
    def test_it_says_what_it_wrote_and_what_to_type_next(self, written):
        folder, said = written
        assert there(folder) == sorted(FILES)
        assert all(f" {file} " in said for file in FILES)
        first, *_, last = said.partition("Next:\n")[2].splitlines()
        assert first == f"  cd {folder}" and last.endswith(" -m pytest")
        assert f"  rocking mechanisms --check {NAME}\n" in said

    def test_its_name_is_everywhere(self, written):
        folder, _ = written
        texts = {file: (folder / file).read_text(encoding="utf-8") for file in FILES if not file.endswith(".png")}
        assert not [file for file, text in texts.items() if re.search("my.?mechanism", text, re.I)]
        declared = tomllib.loads(texts["pyproject.toml"])["project"]
        assert declared["name"] == "rocking-leaning-pier"
        assert declared["entry-points"]["rocking.mechanisms"] == {NAME: "rocking_leaning_pier:LeaningPier"}
        assert yaml.safe_load(texts["leaning_pier.yaml"])["mechanism"] == mechanism(folder).mechanism == NAME
        assert texts["leaning_pier.yaml"] == template(mechanism(folder))
        linked = re.findall(r"!\[.+?\]\((.+?)\)", texts["README.md"])
        assert linked == ["leaning_pier.png"]

    @pytest.mark.parametrize("offset", [0.0, 0.15, -0.15])
    def test_its_mechanism_keeps_the_contract(self, written, offset):
        cls = mechanism(written[0])
        made = cls(width=0.8, height=2.0, cap_width=0.5, cap_height=0.6, cap_offset=offset)
        assert [each for each in contract(made) if not each.passed] == []
        laden = made.model_copy(update={"density": 2000.0, "depth": 1.0})
        assert [each for each in contract(laden) if not each.passed] == []
        sides = equivalent_block(made)
        assert (sides[Direction.POSITIVE].lambda_ < sides[Direction.NEGATIVE].lambda_) == (offset > 0)

    def test_what_does_not_fit_is_refused_by_its_field(self, written):
        with pytest.raises(ValueError, match="cap_width: sticks out over the block"):
            mechanism(written[0])(width=0.8, height=2.0, cap_width=0.5, cap_height=0.6, cap_offset=0.2)

    def test_nobody_has_verified_it_yet_and_it_leaves_no_module(self, written):
        assert mechanism(written[0]).verified == ""
        assert f"rocking_{NAME}" not in sys.modules

    def test_its_picture_is_one(self, written):
        with Image.open(written[0] / f"{NAME}.png") as image:
            assert image.format == "PNG" and min(image.size) > 500
            assert len(image.convert("RGB").getcolors(1_000_000)) > 20

    @pytest.mark.rest
    @pytest.mark.parametrize("name", ["q", NAME, "a" * LONGEST, "_".join("abcdefghijklmnopqrst")])
    def test_its_code_is_clean_whatever_its_name(self, name, tmp_path):
        pytest.importorskip("ruff", reason="no ruff here")
        for file, content in package(name).items():
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
            ("my block", "such as my_block"),
            ("a.b", "such as a_b"),
            ("../x", "such as x"),
            ("LeaningPier", "such as leaningpier"),
            ("Wall", "such as leaning_pier"),
            ("brücke", "such as brucke"),
            ("1wall_1_", "such as wall_1"),
            ("a__b", "such as a_b"),
            ("🙂", "such as leaning_pier"),
            ("", "such as leaning_pier"),
            ("a\x1b[31m\nb", r"'a\x1b[31m\nb' cannot be"),
            ("a" * (LONGEST + 1), f"at most {LONGEST} of a-z"),
            ("class", "a keyword of Python"),
            ("match", "a keyword of Python"),
            ("json", "Python has a module of this name"),
            ("yes", "in a structure file this word is not read as text"),
            ("block", "the mechanism block already exists, in rocking-cli"),
            ("cli", "its module would be rocking_cli"),
            ("con", "on Windows"),
            ("ties", "`rocking mechanisms ties` shows something else"),
            ("body", "its class would be Body"),
            ("value_error", "its class would be ValueError"),
            ("test_pier", "its class would be TestPier"),
        ],
    )
    def test_a_name_that_cannot_be_one_is_refused_in_plain_words(self, name, said):
        text = run("new", "--plugin", "--", name, code=2).stderr
        assert said in text and text.startswith("error: ") and there(".") == []
        assert "take another name" in text or "such as " in text

    @pytest.mark.parametrize("name", [STUDY, SITE, *STARTERS])
    def test_what_rocking_prints_already_is_refused(self, name):
        said = run("new", "--plugin", name, code=2).stderr
        assert ("prints something else" in said) != (name == SITE) and there(".") == []  # Python has a module site

    def test_no_class_has_the_name_of_one_that_its_files_import(self):
        known = {*IMPORTED, *vars(core), *vars(builtins)}
        for content in [text for file, text in package(NAME).items() if file.endswith(".py")]:
            tree = ast.parse(content)
            names = {
                each.name for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) for each in node.names
            } | {node.name for node in tree.body if isinstance(node, ast.ClassDef)}
            assert {each for each in names if each[0].isupper()} - known <= {"LeaningPier", "TestContract"}


class TestFolder:
    def test_it_is_named_after_the_mechanism(self):
        found = run_json("new", "--plugin", NAME)
        assert found["folder"] == "rocking-leaning-pier" and found["plugin"] == NAME
        assert found["files"] == FILES and there("rocking-leaning-pier") == sorted(FILES)
        assert found["commands"][0] == "cd rocking-leaning-pier"
        assert in_this_folder() == ["rocking-leaning-pier"]

    def test_an_empty_one_is_filled_also_from_within(self, tmp_path):
        said = run("new", "--plugin", NAME, "--out", ".").stdout
        assert there(tmp_path) == sorted(FILES) and "  cd " not in said
        assert not [each for each in in_this_folder() if each.startswith(".")]

    def test_its_name_is_typed_as_a_shell_takes_it(self, monkeypatch):
        monkeypatch.setenv("COLUMNS", "30")
        said = run("new", "--plugin", NAME, "-o", "my piers").stdout
        assert ("  cd 'my piers'\n" if os.name != "nt" else '  cd "my piers"\n') in said
        table, _, commands = said.partition("Next:\n")
        assert max(map(len, table.splitlines())) <= 30
        assert [line.split()[0] for line in commands.splitlines()][2:4] == ["rocking", "rocking"]

    @pytest.mark.parametrize(
        ("out", "said"),
        [
            ("full", "this folder already exists and is not empty"),
            ("full/file", "there is a file of this name already"),
            ("", "this folder already exists and is not empty"),
            ("no/such", "create it first"),
            ("full/file/x", "does not exist"),
        ],
    )
    def test_where_none_can_be_made_nothing_is_touched(self, out, said):
        Path("full").mkdir()
        Path("full/file").write_text("kept", encoding="utf-8")
        assert said in run("new", "--plugin", NAME, "-o", out, code=2).stderr
        assert there(".") == ["full/file"] and Path("full/file").read_text(encoding="utf-8") == "kept"

    def test_it_goes_with_a_plugin_only(self):
        assert "--out requires --plugin" in run("new", "arch", "-o", "x", code=2).stderr

    @pytest.mark.every(3)
    @pytest.mark.parametrize("empty", [False, True])
    @pytest.mark.parametrize(
        ("raised", "code"), [(OSError(errno.ENOSPC, "No space left"), 1), (OSError(errno.EACCES, "No"), 2),
                             (KeyboardInterrupt(), 130)]
    )  # fmt: skip
    @pytest.mark.parametrize("where", ["write", "rename"])
    def test_of_one_that_fails_nothing_is_left(self, where, raised, code, empty, monkeypatch):
        if empty:
            Path("pier").mkdir()
        calls = []

        def third_time(call):
            def fails(*words):
                calls.append(words)
                if len(calls) == (3 if empty or where == "write" else 1):
                    raise raised
                return call(*words)

            return fails

        if where == "write":
            monkeypatch.setattr(Path, "write_bytes", third_time(Path.write_bytes))
        else:
            monkeypatch.setattr(os, "rename", third_time(os.rename))
        run("new", "--plugin", NAME, "-o", "pier", code=code)
        assert in_this_folder() == (["pier"] if empty else []) and there(".") == []


@pytest.mark.rest
def test_it_can_be_installed_and_is_a_mechanism_like_all_others(written, tmp_path):
    """As a newcomer does it, but for the network: installed from its folder, checked, drawn and tested."""
    pytest.importorskip("hatchling", reason="pip cannot build it without a network: no hatchling here")
    folder, _ = written
    site = tmp_path / "site"
    pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-build-isolation", "--no-index"]
    done = subprocess.run([*pip, "--target", str(site), str(folder)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert (site / f"rocking_{NAME}.py").exists() and not (site / "tests").exists()
    path = [str(site), *filter(None, [os.environ.get("PYTHONPATH")])]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path)}

    def ran(*words):
        python = [sys.executable, *words]
        done = subprocess.run(python, env=environment, cwd=folder, capture_output=True, text=True, encoding="utf-8")
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    listed = json.loads(ran("-m", "rocking_cli", "mechanisms", "--json"))["mechanisms"]
    assert {"name": NAME, "title": "block with a cap on its top", "package": "rocking-leaning-pier 0.1.0"} in listed
    for file in ([], [f"{NAME}.yaml"]):
        assert json.loads(ran("-m", "rocking_cli", "mechanisms", "--check", NAME, *file, "--json"))["passed"]
    before = (folder / f"{NAME}.png").read_bytes()
    ran("-m", "rocking_cli", "draw", f"{NAME}.yaml")
    assert (folder / f"{NAME}.png").read_bytes() == before, "the picture is what `rocking draw` makes"
    assert " passed" in ran("-P", "-m", "pytest", "-q", "-p", "no:cacheprovider")

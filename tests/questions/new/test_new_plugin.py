"""`rocking new --plugin` writes a package that works as it is, and writes it whole or not at all."""

import errno
import json
import os
import re
import subprocess
import sys
import tomllib
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path

import pytest
import yaml

from rocking_cli.io import files
from rocking_cli.io.starters import STARTERS
from rocking_cli.questions.new.command import CODE, MAX_NAME_LENGTH, MECHANISM, SITE, STUDY
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES

NAME = "leaning_pier"
FILES = [
    "pyproject.toml", "rocking_leaning_pier.py", "tests/test_leaning_pier.py", "README.md", "leaning_pier.yaml",
]  # fmt: skip
KINDS = pytest.mark.parametrize("kind", [MECHANISM, CODE], ids=["mechanism", "code"])


def there(folder):
    return sorted(file.relative_to(folder).as_posix() for file in Path(folder).rglob("*") if file.is_file())


def in_this_folder():
    return sorted(each.name for each in Path().iterdir())


def words(kind, name=NAME):
    return "new", "--plugin", name, *(["--code"] if kind is CODE else [])


@KINDS
class TestPackage:
    def test_it_is_the_example_under_another_name(self, kind):
        found = run_json(*words(kind))
        folder = Path("rocking-leaning-pier")
        assert in_this_folder() == [found["folder"]] == [str(folder)] and found["plugin"] == NAME
        assert there(folder) == sorted(found["files"])
        assert found["commands"][0] == f"cd {folder}" and found["commands"][-1].endswith(" -m pytest")
        other = re.compile(kind.example.replace("_", ".?"), re.I)
        for file in found["files"]:
            text = (folder / file).read_text(encoding="utf-8")
            assert not other.search(file + text)
            example = EXAMPLES / kind.folder / file.replace(NAME, kind.example)
            assert text == kind.named(example.read_text(encoding="utf-8"), NAME)
        declared = tomllib.loads((folder / "pyproject.toml").read_text(encoding="utf-8"))["project"]
        assert declared["name"] == str(folder)
        group = "rocking.codes" if kind is CODE else "rocking.mechanisms"
        assert declared["entry-points"][group] == {NAME: "rocking_leaning_pier:LeaningPier"}

    @pytest.mark.rest
    @pytest.mark.parametrize("name", ["q", "a" * MAX_NAME_LENGTH, "_".join("abcdefghijklmnopqrst")])
    def test_its_code_is_clean_whatever_its_name(self, kind, name, tmp_path):
        pytest.importorskip("ruff", reason="no ruff here")
        for file, content in kind.package(name).items():
            (tmp_path / file).parent.mkdir(exist_ok=True)
            (tmp_path / file).write_bytes(content)
        ruff = [sys.executable, "-m", "ruff"]
        rules = ["--extend-select", "E,F,W,I,UP,B,SIM,RUF,PTH,C4"]
        for command in (["check", *rules], ["format", "--check"]):
            done = subprocess.run([*ruff, *command, "--no-cache", "."], cwd=tmp_path, capture_output=True, text=True)
            assert done.returncode == 0, done.stdout + done.stderr


class TestNames:
    @pytest.mark.parametrize(
        ("name", "said"),
        [
            ("my block", "such as my_block"),
            ("../x", "such as x"),
            ("🙂", "such as capped_block"),
            ("a\x1b[31m\nb", r"'a\x1b[31m\nb' cannot be"),
            ("a" * (MAX_NAME_LENGTH + 1), f"at most {MAX_NAME_LENGTH} of a-z"),
            ("yes", "not read as text"),
            ("block", "the mechanism block already exists, in rocking-cli"),
            ("cli", "rocking_cli already means something else"),
            ("ties", "`rocking mechanisms ties` shows something else"),
            ("body", "Body already means something else"),
            *((name, "prints something else") for name in (STUDY, SITE, *STARTERS)),
        ],
    )
    def test_a_name_that_cannot_be_one_is_refused(self, name, said):
        text = run("new", "--plugin", "--", name, code=2).stderr
        assert said in text and there(".") == []
        assert "take another name" in text or "such as " in text

    @pytest.mark.parametrize(
        ("name", "said"), [("EC8", "such as ec8"), ("9", "such as my_code"), ("site_fields", "SiteFields already")]
    )
    def test_so_is_one_of_a_code(self, name, said):
        assert said in run("new", "--plugin", "--code", "--", name, code=2).stderr and there(".") == []

    def test_so_is_that_of_an_installed_code(self, monkeypatch):
        point = EntryPoint("uni_test", "json:dumps", "rocking.codes")
        monkeypatch.setattr(
            "rocking_cli.plugins.registry.entry_points",
            lambda group: [*entry_points(group=group), *([point] if group == point.group else [])],
        )
        text = run("new", "--plugin", "uni_test", "--code", code=2).stderr
        assert "the code uni_test already exists, in unknown package" in text and there(".") == []

    def test_that_of_a_code_may_stand_at_the_option(self):
        assert run_json("new", "--plugin", "--code", "uni_test")["plugin"] == "uni_test"


class TestFolder:
    def test_an_empty_one_is_filled_also_from_within(self, tmp_path):
        said = run("new", "--plugin", NAME, "--out", ".").stdout
        assert there(tmp_path) == sorted(FILES) and "  cd " not in said
        assert not [each for each in in_this_folder() if each.startswith(".")]

    def test_its_name_is_typed_as_a_shell_takes_it(self, monkeypatch):
        monkeypatch.setenv("COLUMNS", "30")
        said = run("new", "--plugin", NAME, "-o", "my piers").stdout
        assert ("  cd 'my piers'\n" if os.name != "nt" else '  cd "my piers"\n') in said

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
    def test_of_one_that_fails_nothing_is_left(self, raised, code, empty, monkeypatch):
        if empty:
            Path("pier").mkdir()
        written = []

        def third_time(path, write, put=files._put):
            written.append(path)
            if len(written) == 3:
                raise raised
            put(path, write)

        monkeypatch.setattr(files, "_put", third_time)
        run("new", "--plugin", NAME, "-o", "pier", code=code)
        assert in_this_folder() == (["pier"] if empty else []) and there(".") == []


@pytest.mark.rest
@KINDS
def test_it_can_be_installed_and_is_a_plugin_like_all_others(kind, tmp_path):
    """As a newcomer does it, but for the network: installed from its folder, checked, used and tested."""
    pytest.importorskip("hatchling", reason="pip cannot build it without a network: no hatchling here")
    site, folder = tmp_path / "site", Path("rocking-leaning-pier").resolve()
    run(*words(kind))
    pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-build-isolation", "--no-index"]
    subprocess.run([*pip, "--target", str(site), str(folder)], check=True, capture_output=True)
    assert (site / f"rocking_{NAME}.py").exists() and not (site / "tests").exists()
    path = [str(site), *filter(None, [os.environ.get("PYTHONPATH")])]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path)}

    def ran(*given):
        command = [sys.executable, *given]
        done = subprocess.run(command, env=environment, cwd=folder, capture_output=True, text=True, encoding="utf-8")
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    rocking = ("-m", "rocking_cli")
    plugins = json.loads(ran(*rocking, "info", "--json"))["plugins"]
    assert {"name": NAME, "package": "rocking-leaning-pier 0.1.0", "broken": None} in plugins[
        "codes" if kind is CODE else "mechanisms"
    ]
    if kind is CODE:
        found = json.loads(ran(*rocking, "verify", "--site", "site.yaml", "--json"))  # a block with lambda = 0.25
        assert [each["ratio"] for each in found["directions"].values()] == pytest.approx([2.0, 2.0])
        made, file = ran(*rocking, "new", "site", "--code", NAME), "site.yaml"
    else:
        assert json.loads(ran(*rocking, "mechanisms", "--check", NAME, "--json"))["passed"]
        made, file = ran(*rocking, "new", NAME), f"{NAME}.yaml"
    text = (folder / file).read_text(encoding="utf-8")
    assert yaml.safe_load(made) == yaml.safe_load(text) and made.splitlines()[4:] == text.splitlines()[4:]
    assert " passed" in ran("-P", "-m", "pytest", "-q", "-p", "no:cacheprovider")

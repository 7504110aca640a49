"""What makes a tool pleasant every day: how it is called, what defaults it assumes, what it says of itself."""

import json
import os
import re
import shutil
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import pytest
from click.shell_completion import BashComplete
from click.testing import CliRunner

from rocking_cli.cli.main import main
from rocking_cli.dynamics import shipped
from tests.cli.test_cli import run, run_json
from tests.cli.test_cli_standard_input import piped
from tests.conftest import EXAMPLES

ACCEL, BLOCK = str(EXAMPLES / "accel.csv"), str(EXAMPLES / "block.yaml")


def test_the_package_runs_as_the_command_does():
    module = [sys.executable, "-m", "rocking_cli", "equiv", BLOCK, "--no"]
    wrong = subprocess.run(module, capture_output=True, text=True)
    assert wrong.returncode == 2 and "Usage: rocking equiv" in wrong.stderr


class TestSwitchesOfTheProgram:
    def debugged(self, *arguments):
        return CliRunner().invoke(main, list(arguments))

    @pytest.mark.parametrize("wrong", [("equiv", "none.yaml"), ("equiv", "--none"), ("respond", BLOCK)])
    def test_debug_shows_the_traceback_of_any_error(self, wrong, monkeypatch):
        assert "Traceback" not in run(*wrong, code=2).stderr
        asked = self.debugged("--debug", *wrong)
        assert asked.exit_code == 2 and "Traceback" in asked.stderr and asked.stdout == ""
        monkeypatch.setenv("ROCKING_DEBUG", "1")
        assert "Traceback" in self.debugged(*wrong).stderr

    def test_verbose_says_which_file_and_how_long(self):
        said = run("-v", "equiv", BLOCK)
        assert f"structure: pedestal (block), of {BLOCK}" in said.stderr.replace("\n", "")
        assert re.search(r"took \d+\.\d\d s", said.stderr)
        assert said.stdout == run("equiv", BLOCK, "--all").stdout and run("equiv", BLOCK, "--all").stderr == ""


class TestInfo:
    def test_it_knows_the_versions_the_extras_and_the_plugins(self, monkeypatch):
        from rocking_cli.questions.info import command as installation

        found = run_json("info")
        assert found["version"] == version("rocking-cli") and found["libraries"]["numpy"] == version("numpy")
        assert {
            "blocks",
            "cluster",
            "docx",
            "drawing",
            "mesh",
            "parquet",
            "pdf",
            "seismo",
            "spreadsheet",
            "xarray",
        } == set(found["extras"])
        names = {kind: {each["name"] for each in plugins} for kind, plugins in found["plugins"].items()}
        assert "arch" in names["mechanisms"] and "peer_at2" in names["records"] and "ricker" in names["pulses"]
        assert found["processors"] >= found["threads"] >= 1
        monkeypatch.setattr(installation, "_version", lambda name: None)
        assert "no pyarrow: pip install 'rocking-cli[parquet]'" in run("info").stdout

    def test_it_knows_the_variables_and_says_which_have_no_effect(self, monkeypatch):
        monkeypatch.setenv("ROCKING_DEBUG", "0")
        monkeypatch.setenv("ROCKING_TAIL", "3")
        assert {"ROCKING_DEBUG", "ROCKING_TAIL"} <= set(run_json("info")["environment"])
        said = run("info").stdout
        assert "The environment variable ROCKING_TAIL is not used by rocking" in said and "ROCKING_TAIL=3" in said
        assert "ROCKING_DEBUG is not used" not in said

    def test_it_knows_what_runs_the_kernels(self, monkeypatch):
        monkeypatch.delenv("ROCKING_KERNELS", raising=False)
        found = run_json("info")
        assert found["slow_kernels"] is None and found["kernels"] == shipped.levels()[0]
        said = run("-v", "respond", BLOCK, "--pulse", "sine:0.4g:0.5s").output
        assert f", kernels {found['kernels']}" in said
        monkeypatch.setenv("ROCKING_KERNELS", "v9")
        found = run_json("info")
        assert found["kernels"] is None and found["slow_kernels"].startswith("ROCKING_KERNELS is 'v9': give one of")
        monkeypatch.delenv("ROCKING_KERNELS")
        monkeypatch.setattr(shipped, "LIBRARIES", ())
        shipped.loaded.cache_clear()
        assert run_json("info")["slow_kernels"].startswith("no kernels are shipped for ")
        monkeypatch.setenv("ROCKING_KERNELS", "python")
        assert "sixty times slower: ROCKING_KERNELS is python" in run("info").stdout


class TestCompletion:
    def asked(self, *words, debug=()):
        environment = {**os.environ, "_ROCKING_COMPLETE": "bash_complete", "COMP_WORDS": "\n".join(words)}
        environment["COMP_CWORD"] = str(len(words) - 1)
        program = [sys.executable, *debug, "-m", "rocking_cli"]
        ran = subprocess.run(program, env=environment, capture_output=True, text=True, check=True)
        return {line.partition(",")[2] for line in ran.stdout.splitlines()}, ran

    @pytest.mark.every(4)
    @pytest.mark.parametrize(
        ("words", "found"),
        [
            (("resp",), {"respond"}),
            (("new", "s"), {"site", "spanning_wall", "statue", "study", "symmetric_frame"}),
            (("pulse", "--shape", "ric"), {"ricker", "ricker_antisymmetric"}),
            (("respond", "--pulse", "s"), {"sine:"}),
            (("respond", "--model", "linear1,"), {"linear1,nonlinear", "linear1,linear2"}),
            (("completion", ""), {"bash", "zsh", "fish"}),
        ],
    )
    def test_names_are_completed_and_no_plugin_is_loaded(self, words, found):
        completed, ran = self.asked("rocking", *words, debug=("-X", "importtime"))
        assert completed == found
        loaded = {line.rpartition("|")[2].strip() for line in ran.stderr.splitlines()}
        assert "click" in loaded and not loaded & {"mechanisms", "numpy", "rocking_cli.excitation.pulses"}

    @pytest.mark.parametrize("words", [("equiv",), ("respond", "--record"), ("draw", "--plot")])
    def test_files_are_left_to_the_shell(self, words):
        shell = BashComplete(main, {}, "rocking", "_ROCKING_COMPLETE")
        assert [shell.format_completion(each) for each in shell.get_completions(list(words), "x")] == ["file,x"]

    @pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
    def test_the_script_is_that_of_the_shell(self, shell):
        script = run_json("completion", shell)["script"]
        assert f"_ROCKING_COMPLETE={shell}_complete" in script
        assert run("completion", shell).stdout.strip() == script.strip()

    @pytest.mark.skipif(shutil.which("bash") is None or sys.platform == "win32", reason="no bash")
    def test_bash_completes_with_it(self, tmp_path):
        program = tmp_path / "rocking"
        program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m rocking_cli "$@"\n', encoding="utf-8")
        program.chmod(0o755)
        (tmp_path / "script").write_text(run("completion", "bash").stdout, encoding="utf-8")
        typed = "COMP_WORDS=(rocking new ar); COMP_CWORD=2; _rocking_completion rocking; echo ${COMPREPLY[@]}"
        environment = {**os.environ, "PATH": f"{tmp_path}:{os.environ['PATH']}"}
        ran = subprocess.run(["bash", "-c", f". ./script; {typed}"], env=environment, capture_output=True, text=True)
        assert ran.stdout == "arch\n", ran.stderr


def test_the_study_to_start_from_runs_beside_a_block(tmp_path):
    (tmp_path / "block.yaml").write_text(run("new", "block").stdout, encoding="utf-8")
    (tmp_path / "study.yaml").write_text(run("new", "study").stdout, encoding="utf-8")
    assert run_json("new", "study")["yaml"] == (tmp_path / "study.yaml").read_text(encoding="utf-8")
    found = run_json("fragility", "study.yaml")
    assert found["finished"] == found["runs"] > 0 and found["failed"] == 0
    assert {each["limit_state"] for each in found["curves"]} == {"uplift", 0.5, "overturning"}


def test_what_is_left_out_of_the_study_to_start_from_can_be_put_in(tmp_path):
    for each in ("block", "wall"):
        (tmp_path / f"{each}.yaml").write_text(run("new", each).stdout, encoding="utf-8")
    (tmp_path / "records").mkdir()
    (tmp_path / "records" / "one.AT2").write_bytes(Path(ACCEL).read_bytes())
    (tmp_path / "accel.txt").write_text("\n".join(f"0.{k % 7}" for k in range(50)), encoding="utf-8")
    head, body = run("new", "study").stdout.split("name:")
    full = re.sub(r"^( *)# ( *(- |[a-z]+:))", r"\1\2", body, flags=re.M)
    assert full.count("\n  - ") > body.count("\n  - ") and "\nsamples: 10" in full and "\nhazard:" in full
    (tmp_path / "study.yaml").write_text(f"{head}name:{full}", encoding="utf-8")
    checked = run_json("fragility", "study.yaml", "--check")
    assert checked["runs"] == 15 * 2 * 11 * (1 + 10)


class TestStandardStreams:
    @pytest.mark.parametrize(
        "command",
        [
            ("respond", BLOCK, "--pulse", "sine:0.5g:1s", "--neighbours", "0"),
            ("overturning", BLOCK, "--points", "6"),
        ],
        ids=lambda command: command[0],
    )
    def test_a_table_goes_to_standard_output_and_nothing_else_does(self, command):
        run(*command, "--out", "there.csv")
        table = Path("there.csv").read_bytes()
        shown = run(*command)
        there = run(*command, "--out", "-")
        assert table and there.stdout_bytes == run(*command, "--out", "-", "--json").stdout_bytes == table
        assert shown.stdout.strip() in there.stderr
        assert not Path("-").exists()

    def test_after_it_results_are_on_standard_output_again(self):
        run("overturning", BLOCK, "--points", "6", "--out", "-")
        assert run("equiv", BLOCK).stdout

    def test_several_motions_have_several_tables_and_a_picture_is_none(self):
        several = ("respond", BLOCK, "--pulse", "sine:0.5g:1s", "--pulse", "sine:0.4g:1s", "--out", "-")
        assert "--out: - takes the table of a single motion" in run(*several, code=2).stderr
        assert "does not end in .html" in run("report", BLOCK, "-o", "-", code=2).stderr

    def test_a_report_holds_what_came_from_there(self, monkeypatch):
        monkeypatch.setattr("rocking_cli.questions.report.study.MAP_POINTS", 3)
        there = json.loads(piped("report", "-", "--json", content=Path(BLOCK).read_bytes()).stdout)["structure"]
        assert there == {**run_json("report", BLOCK)["structure"], "file": "standard input"}

    def test_files_that_are_made_of_it_have_a_name_of_their_own(self):
        piped("draw", "-", content=Path(BLOCK).read_text(encoding="utf-8"))
        assert Path("rocking.png").exists()
        Path("rocking.png").unlink()
        run("draw", "")  # of a variable of a script that is not set
        assert Path("rocking.png").exists()

    def test_what_is_wrong_with_it_is_said_and_it_is_one_thing(self):
        assert "standard input:2:" in piped("equiv", "-", content="mechanism: block\nwidht: 3\n", code=2).stderr
        both = ("respond", "-", "--record", "-")
        said = piped(*both, content=Path(BLOCK).read_text(encoding="utf-8"), code=2).stderr
        assert "can be read once only, and something else has been read from it" in said
        assert "larger than 10 MB" in piped("equiv", "-", content="#" * 10_000_001, code=2).stderr

"""Records on standard input, in archives and in tables, as a user gives them to a command."""

import json
import os
import zipfile

import pytest
from click.testing import CliRunner

from rocking_cli.ask.kinds import PULSE_AMPLITUDE
from rocking_cli.cli.main import main
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES

ACCEL = EXAMPLES / "accel.csv"
BLOCK = EXAMPLES / "block.yaml"


def piped(*arguments, code=0, content=None):
    """Run a command with the example on standard input."""
    content = ACCEL.read_bytes() if content is None else content
    result = CliRunner().invoke(main, [str(argument) for argument in arguments], input=content)
    assert result.exit_code == code, result.output
    assert "Traceback" not in result.stderr
    return result


@pytest.mark.usefixtures("small_maps")
@pytest.mark.parametrize(
    "arguments",
    [
        ("record", "{}", "--json"),
        ("respond", BLOCK, "--record", "{}", "--model", "linear2", "--neighbours", "2", "--json"),
        ("spectrum", BLOCK, "--record", "{}", "--sizes", "2:3", "--count", "2", "--json"),
        ("report", BLOCK, "--record", "{}", "--neighbours", "2", "--json"),
    ],
)
def test_every_command_takes_standard_input(arguments):
    said = piped(*(str(word).format("-") for word in arguments)).stdout
    direct = run(*(str(word).format(ACCEL) for word in arguments)).stdout
    assert "standard input" in said
    kept = {"command": None, "date": None}  # the report repeats the command
    said, direct = ({**json.loads(text), **kept} for text in (said, direct))
    assert json.loads(json.dumps(said).replace("standard input", "X")) == json.loads(
        json.dumps(direct).replace(json.dumps(str(ACCEL))[1:-1], "X").replace("accel.csv", "X")
    )


def test_an_animation_takes_standard_input(tmp_path):
    piped("animate", BLOCK, "--record", "-", "--out", tmp_path / "moving.html")
    assert "standard input" in (tmp_path / "moving.html").read_text(encoding="utf-8")


def test_standard_input_is_there_once():
    found = piped("respond", "--record", "-", "--vertical", "-", code=2)
    assert "standard input: it can be read once only" in found.stderr
    assert found.stdout == ""


def test_a_clean_file_of_standard_input(tmp_path):
    piped("record", "-", "--out", ".")
    assert run_json("record", "standard input.csv")["npts"] == run_json("record", ACCEL)["npts"]


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no pipes that are files")
def test_a_pipe_in_place_of_a_file_is_told_to_be_standard_input(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    end = os.open("pipe", os.O_RDWR)  # so that none waits for the other
    os.write(end, b"0\n1\n")
    assert "give - in its place" in run("record", "pipe", code=2).stderr
    os.close(end)


@pytest.mark.parametrize(
    ("said", "pga"), [("mg", 0.002), ("%g", 0.02), ("G", 2.0), ("M/SEC/SEC", 2 / 9.80665), ("m/s²", 2 / 9.80665)]
)
def test_parts_of_g(said, pga, tmp_path):
    (tmp_path / "bare.txt").write_text("0 1\n0.01 2\n", encoding="utf-8")
    assert run_json("record", "bare.txt", "--units", said)["pga_g"] == pytest.approx(pga, rel=1e-12)


@pytest.mark.parametrize("said", ["300mg", "30%g", "30 % g", "0.3g", "2.941995m/s^2", "294.1995 cm/s²"])
def test_an_amplitude_may_be_in_them_too(said):
    assert PULSE_AMPLITUDE.read(said) == pytest.approx(0.3, rel=1e-12)


def test_the_channel_of_an_archive_is_in_the_results(tmp_path):
    with zipfile.ZipFile(tmp_path / "records.zip", "w") as archive:
        archive.write(ACCEL, "north.csv")
        archive.writestr("both.csv", "t,x [g],y [g]\n0,1,2\n0.01,1,3\n0.02,1,2\n")
    found = run_json("record", "records.zip", "--channel", "both.csv:y")
    assert (found["name"], found["channel"]) == ("records.zip channel both.csv:y [g]", "both.csv:y [g]")
    assert found["pga_g"] == 3.0
    assert "1: north.csv" in run("record", "records.zip", code=2).stderr


def test_hints_name_the_options_of_the_vertical_component(tmp_path):
    column, table = tmp_path / "column.txt", tmp_path / "table.txt"
    column.write_text("a [g]\n0\n0.1\n0\n", encoding="utf-8")
    table.write_text("t,x [g],y [g]\n0,1,2\n0.01,1,3\n0.02,1,2\n", encoding="utf-8")

    def refused(*options):
        return run("respond", "--record", ACCEL, *options, code=2).stderr

    said = refused("--vertical", column)
    assert "give it with --vertical-dt" in said and " --dt" not in said
    said = refused("--vertical", table)
    assert "--vertical-channel" in said and " --channel" not in said
    said = refused("--vertical", table, "--vertical-channel", "z")
    assert "--vertical-channel: there is no channel 'z'" in said
    said = refused("--vertical", ACCEL, "--vertical-dt", "0.5")
    assert "but --vertical-dt says 0.5 s" in said and "leave --vertical-dt out" in said
    said = run("respond", "--record", column, "--dt", "0.5", "--vertical", ACCEL, code=2).stderr
    assert "but --dt says 0.5 s" in said and "interval of the vertical component with --vertical-dt" in said
    assert "leave --dt out" not in said

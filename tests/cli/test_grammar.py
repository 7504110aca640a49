"""One grammar for all commands: quantities with units, one name for one thing, and old names that go on working."""

from pathlib import Path

import click
import pytest

from rocking_cli.ask.asked import told_of
from rocking_cli.ask.read import read_record
from rocking_cli.cli.main import main
from rocking_cli.excitation.pulses import parse_pulse
from rocking_cli.plugins.rooms import commands
from tests.cli.test_cli import run
from tests.conftest import EXAMPLES

ACCEL, BLOCK = str(EXAMPLES / "accel.csv"), str(EXAMPLES / "block.yaml")


@pytest.mark.parametrize(
    ("command", "option", "alike"),
    [
        ("pulse", "--period", ["0.8", "0.8s", "800ms", "1.25Hz", "0.8 s"]),
        ("pulse", "--ag", ["0.4g", "0.4 g", "400mg", "40%g"]),
        ("record", "--target-pga", ["0.25", "0.25g", "250mg"]),
        ("record", "--target-pgv", ["0.5", "0.5m/s", "50 cm/s", "500mm/s"]),
        ("respond", "--tail", ["2", "2s", "2000ms"]),
        ("respond", "--amplitude-deviation", ["0.05", "5%", "5 %"]),
        ("respond", "--slenderness-deviation", ["0.05", "5%", "5 %"]),
        ("respond", "--opening", ["0.01", "1%", "1 %"]),
        ("spectrum", "--fractiles", ["0.1,0.9", "10%,90%"]),
        ("spectrum", "--sizes", ["1:2", "1s:2s", "1000ms:2s"]),
        ("overturning", "--period", ["0.2:4", "0.2s:4s", "200ms:4s"]),
        ("equivalent_pulses", "--period", ["0.5", "500ms", "2Hz"]),
    ],
)
def test_the_same_quantity_in_any_spelling_is_the_same_value(command, option, alike):
    """How a typed text reaches the question is in `test_made.py`."""
    made = imported()[command]
    name = next(each.name for each in made.params if option in each.opts)
    first, *others = map(told_of(made.model.model_fields[name]).kind.read, alike)
    assert others == [first] * len(others)


def test_the_same_pulse_in_any_spelling_gives_the_same():
    first, *others = map(parse_pulse, ["sine:0.4g:0.8s", "sine:0.4g:0.8", "sine:400mg:800ms"])
    assert others == [first] * 2


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("record", ACCEL, "--target-pga", "3m"), "3m is a length, not an acceleration units: m/s2"),
        (("record", ACCEL, "--dt", "10 Hz"), "'Hz' is not a unit of time"),
        (("record", ACCEL, "--dt", "x"), "'x' is not a number, with or without a unit give a value such as 0.01s"),
        (("respond", BLOCK, "--record", ACCEL, "--tail", "61min"),
         "'61min' is outside the supported range: 0 to 3600 s"),
        (("margin", BLOCK, "--record", ACCEL, "--amplitude-deviation", "2x"),
         "'2x' is not a fraction: give a number such as 0.02 or"),
    ],
)  # fmt: skip
def test_what_is_no_such_quantity_is_said(arguments, words):
    assert words in " ".join(run(*arguments, code=2).stderr.split())


# Names


def imported():
    return {name: main.get_command(click.Context(main), name) for name in commands()}


def test_one_name_is_one_thing_in_every_command():
    meant: dict[str, set[str | None]] = {}
    for command in imported().values():
        for each in command.params:
            if isinstance(each, click.Option) and not each.hidden:
                meant.setdefault(max(each.opts, key=len), set()).add(each.metavar)
                assert ("-o" in each.opts) == ("--out" in each.opts)
    assert meant["--pulse"] == {"PULSE"} and meant["--shape"] == {"SHAPE"}
    assert meant["--ag"] == {"AMPLITUDE", "LOW:HIGH"} and meant["--period"] == {"PERIOD", "LOW:HIGH"}
    assert all(kind and kind.startswith(("FILE", "FOLDER")) for kind in meant["--plot"])


def test_a_file_called_like_an_option_is_a_file(tmp_path):
    (tmp_path / "--pulse").write_bytes(Path(ACCEL).read_bytes())
    assert "Arias intensity" in run("record", "--", "--pulse").stdout


# Where a clean record goes


def test_a_clean_record_goes_to_the_file_or_into_the_folder_that_is_named(tmp_path):
    run("record", ACCEL, "-o", "clean.csv", "--scale", "2")
    run("record", ACCEL, "--polarity", "both", "--out", "made/here")
    assert sorted(path.name for path in (tmp_path / "made" / "here").iterdir()) == ["accel-reversed.csv", "accel.csv"]
    twice = read_record("clean.csv").acceleration
    assert twice == pytest.approx(2 * read_record("made/here/accel.csv").acceleration, rel=1e-12)
    (tmp_path / "folder.csv").mkdir()
    run("record", ACCEL, "--out", "folder.csv")
    assert (tmp_path / "folder.csv" / "accel.csv").exists()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((ACCEL, "--polarity", "both", "--out", "one.csv"), "--out FILE.csv takes one record"),
        ((ACCEL, "--out", "taken/x"), "cannot be a folder to write into"),
        ((ACCEL, "--out", "no/one.csv"), "no/one.csv"),
    ],
)
def test_what_cannot_be_written_is_said_and_nothing_is(arguments, words, tmp_path):
    (tmp_path / "taken").write_text("", encoding="utf-8")
    assert words in " ".join(run("record", *arguments, code=2).stderr.split())
    assert [path.name for path in tmp_path.iterdir()] == ["taken"]

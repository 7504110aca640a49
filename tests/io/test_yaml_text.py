"""Plain data written as YAML is read as it was, by this program and by readers of YAML 1.1."""

import re
from pathlib import Path

import pytest
import yaml

from rocking_cli.errors import Problem
from rocking_cli.io import field_problems
from rocking_cli.io.yaml_file import block, in_a_line, parse, placed
from tests.cli.test_cli import run

TEXTS = [
    "plain", "two words",
    "1e3", "012", "0x1F", "1_000", "12:30", "on", "No", "~", "null", "<<", "=", "- x", "? y", "a: b",
    "a # b", "#", "it's", 'say "x"', "[a, b]", "{a}", "*x", "&x", "!x", "%x", "@x", "`x`", "|", ">", "né", "\U0001f600",
    " edge ", "", "two\nlines", "a,b", "x:", "2026-01-01", ".nan", "\\", "---", "...",
]  # fmt: skip


@pytest.mark.parametrize("text", TEXTS)
def test_texts_stay_texts_as_values_and_as_names(text):
    data = {"a": text, text: {text: {"list": [text, {text: [1, 2.5, True, None, 1e-7]}], "b": text}}}
    written = "\n".join(line for key, value in data.items() for line in block(key, value))
    assert len(written.splitlines()) == 3
    document = parse(written, "a.yaml", "file", "")
    assert document.data == data and not document.problems
    assert yaml.safe_load(written) == data


@pytest.mark.parametrize("number", [0.1, -0.0, 1e22, 1e-7, 1.5e300, -3.0, 7, 10**30, float("inf")])
def test_numbers_are_spelled_as_by_pyyaml(number):
    assert f"[{in_a_line(number)}]\n" == yaml.safe_dump([number], default_flow_style=True)


def test_long_lists_stay_in_one_line_and_repeated_ones_are_written_out():
    points = [[0.5, float(k)] for k in range(100)]
    line = in_a_line({"one": points, "other": points})
    assert "\n" not in line and "&" not in line and yaml.safe_load(line) == {"one": points, "other": points}


@pytest.mark.parametrize(
    ("field", "line"),
    [
        ("width", 2), ("loads.far.at", 5), ("loads.1.at", 5), ("`loads[1].mass`", 4), ("loads.far.seat", 5),
        ("loads.2", 4), ("loads[3]", 4), ("width.more", 2), ("floor", None), (None, None),
    ],
)  # fmt: skip
def test_a_problem_found_after_reading_has_the_line_of_its_field_or_of_what_is_around_it(field, line, tmp_path):
    file = tmp_path / "s.yaml"
    file.write_text("mechanism: block\nwidth: 60\nloads:\n  - {name: roof, mass: 10}\n  - {name: far, at: [9, 9]}\n")
    found = placed(Problem("is odd", str(file), field=field, hint="mend it"))
    assert (found.line, found.field, found.message, found.hint) == (line, field, "is odd", "mend it")
    gone = Problem("is odd", str(tmp_path / "no.yaml"), field=field)
    assert placed(gone) == gone and placed(Problem("is odd", field=field)).line is None


MANY = "".join(f"key{k}: 1\n" for k in range(3000))
UNKNOWN = {
    "block.yaml": ("mechanism: block\nwidth: 1\nheight: 4\n", "equiv block.yaml"),
    "site.yaml": ("FC: 1.35\nag: 0.2\nF0: 2.5\nTC: 0.4\nS: 1.2\n", "demand site.yaml"),
    "study.yaml": ("structures: [block.yaml]\n", "fragility study.yaml --check"),
}


@pytest.mark.parametrize("file", UNKNOWN)
def test_twenty_problems_are_told_and_the_others_counted(file, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text, line = UNKNOWN[file]
    Path(file).write_text(text + MANY, encoding="utf-8")
    looked = []
    monkeypatch.setattr(field_problems, "did_you_mean", lambda *_: looked.append(1))
    said = run(*line.split(), code=2).stderr
    assert said.count(f"{file}:") == 20 and len(looked) <= field_problems.MAX_WORDED
    assert 2980 <= int(re.search(r"and ([\d,]+) more problems", said)[1].replace(",", "")) < 2990
    assert "key5" in said and "key2999" not in said

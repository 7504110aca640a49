"""Plain data written as YAML is read as it was, by this program and by readers of YAML 1.1."""

import pytest
import yaml

from rocking_cli.io.yaml_file import block, in_a_line, parse

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

"""Names, keys and lines that would command a terminal, or break a picture or a page, are shown as text.

That files of such names are worked on by all commands is in `test_every_command.py`.
"""

import re
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rocking_cli.errors import Problem
from rocking_cli.text import cut, is_one_line, one_line, printable
from tests.cli.test_cli import run

HARMFUL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\ud800-\udfff]")
BLOCK = "mechanism: block\nwidth: 0.7\nheight: 2.8\n"


@given(st.text(st.characters(), max_size=40))
def test_what_is_printable_harms_nothing_and_stays(text):
    shown = printable(text)
    assert not HARMFUL.search(shown)
    assert printable(shown) == shown
    shown.encode()
    assert is_one_line(one_line(text))
    if is_one_line(text):
        assert shown == one_line(text) == text


def test_characters_are_spelled_as_people_know_them():
    assert printable("a\x1b[31m\x9b\u202e\u2028 é 木 😀\t\n") == r"a\x1b[31m\x9b\u202e\u2028 é 木 😀" + "\t\n"
    assert printable(b"\xff.txt".decode(errors="surrogateescape")) == r"\xff.txt"
    assert cut("x" * 100, 10) == "xxxxxxx..."


def test_the_mark_below_a_line_stands_where_it_belongs():
    for line, column in (("a\x1b\x1bb: 1", 4), ("x" * 500 + "HERE" + "y" * 500, 501), ("short", 1)):
        shown, mark = str(Problem("wrong", "f", 1, column, excerpt=line)).splitlines()[1:]
        assert len(shown) < 140
        assert shown[mark.index("^")] == line[column - 1]


@pytest.mark.parametrize(
    "arguments",
    [
        ["equiv", "no\x1b[31m.yaml"], ["no\x1b[31m"], ["equiv", "--no\x1b[31m"], ["draw", "--at", "\x1b[31m"],
        ["respond", "--pulse", "sine\x1b[31m:1g:1s"], ["mechanisms", "\x1b[31m"], ["equiv", "key.yaml"],
        ["respond", "--record", "no\x1b[31m.txt"], ["spectrum", "--record", "no\x1b[31m*"],
    ],
)  # fmt: skip
def test_no_message_commands_the_terminal(arguments, tmp_path):
    (tmp_path / "key.yaml").write_text(BLOCK + '"\\e[31mkey": 1\n', encoding="utf-8")
    found = run(*arguments, code=2)
    assert r"\x1b[31m" in found.stderr
    assert not HARMFUL.search(found.stderr)


def test_names_in_a_study_are_printable(tmp_path):
    (tmp_path / "b.yaml").write_text(BLOCK, encoding="utf-8")
    (tmp_path / "st.yaml").write_text(
        'name: "a\\e[31m"\nstructures: [{file: b.yaml, name: "\\u202eb"}]\n'
        'records: [{pulse: "sine:1g:1s"}]\nmethod: cloud\n',
        encoding="utf-8",
    )
    said = run("fragility", "st.yaml", "--check", code=2).stderr
    assert "st.yaml:1:7: name must be printable" in said
    assert "st.yaml:2:35: structures[1].name must be printable" in said


def test_what_a_study_varies_may_have_units(tmp_path):
    (tmp_path / "b.yaml").write_text(BLOCK, encoding="utf-8")
    study = (
        "structures:\n  - file: b.yaml\n    vary:\n      width: {uniform: {low: LOW, high: HIGH}}\n"
        "      height: {lognormal: {median: MEDIAN, dispersion: 0.1}}\n"
        "records: [{pulse: 'sine:1g:1s'}]\nmethod: cloud\nsamples: 3\n"
    )

    def samples(low, high, median):
        from rocking_cli.questions.fragility.study import load_study

        text = study.replace("LOW", low).replace("HIGH", high).replace("MEDIAN", median)
        (tmp_path / "st.yaml").write_text(text, encoding="utf-8")
        return [each.mechanism for each in load_study(tmp_path / "st.yaml").samples]

    assert samples("700 mm", "90 cm", "2.8 m") == samples("0.7", "0.9", "2.8")
    from rocking_cli.errors import InputError

    with pytest.raises(InputError) as caught:
        samples("700 kg", "90 cm", "2.8 mm3")
    first, second = caught.value.problems
    assert (first.line, first.field) == (4, "structures[1].vary.width.uniform.low")
    assert "700 kg is a mass, not a length" in first.message and "'mm3' is not a unit of length" in second.message


def test_a_structure_file_that_a_study_does_not_find_has_a_line(tmp_path):
    (tmp_path / "st.yaml").write_text(
        "structures:\n  - nosuch.yaml\nrecords: [{pulse: 'sine:1g:1s'}]\nmethod: cloud\n", encoding="utf-8"
    )
    assert "st.yaml:2:5: structures[1]: nosuch.yaml: no such file" in run(
        "fragility", "st.yaml", "--check", code=2
    ).stderr.replace(str(tmp_path), "").replace("/nosuch", "nosuch")


@pytest.mark.skipif(sys.platform == "win32", reason="no such file names here")
@pytest.mark.parametrize("name", ["a\nerror: b\t.yaml", " .yaml", "\x1b.yaml"])
def test_a_structure_is_called_after_any_file(name, tmp_path):
    (tmp_path / name).write_text(BLOCK, encoding="utf-8")
    assert len(run("equiv", name, "-o", "-").stdout.splitlines()) == 3
    (tmp_path / name).write_text("mechanism: blok\n", encoding="utf-8")
    assert run("equiv", name, code=2).stderr.startswith(f"error: {one_line(name)}:1:12: mechanism: unknown")

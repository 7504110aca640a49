"""Names, keys and lines that would command a terminal, or break a picture or a page, are shown as text."""

from __future__ import annotations

import json
import re
import shutil
import sys
import xml.etree.ElementTree as ElementTree

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rocking_cli.errors import Problem
from rocking_cli.text import cut, is_one_line, one_line, printable
from tests.conftest import EXAMPLES
from tests.test_cli import run

HARMFUL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\ud800-\udfff]")
BLOCK = "mechanism: block\nwidth: 0.7\nheight: 2.8\n"
MATHS = '"$\\\\frac{1$<b>&\'"'  # neither a formula nor markup


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


@pytest.fixture
def hostile(tmp_path):
    """A structure and a record whose files no terminal can spell, and a structure with a name of formulas."""
    bad = b"\xff\x1b[31m$\\frac{1$<b>" if sys.platform == "linux" else "\u202e$\\frac{1$&'".encode()
    import os

    structure, record = (os.fsdecode(bad + suffix) for suffix in (b".yaml", b".csv"))
    (tmp_path / structure).write_text(BLOCK, encoding="utf-8")
    shutil.copy(EXAMPLES / "accel.csv", tmp_path / record)
    (tmp_path / "n.yaml").write_text(BLOCK + f"name: {MATHS}\n", encoding="utf-8")
    return structure, record


COMMANDS = {
    "draw": "draw S --plot out.svg",
    "error": "error S --plot out.svg",
    "record": "record R --plot out.svg",
    "record and pulse": "record R --fit-pulse --plot out.svg",
    "respond": "respond S --record R --plot out.svg --out out.csv",
    "spectrum": "spectrum S n.yaml --record R --sizes 1:3:3 --plot out.svg --out out.csv",
    "overturning": "overturning S n.yaml --compare --points 3 --plot out.svg",
    "overturning map": "overturning n.yaml --points 3 --plot out.svg",
    "equivalent": "equivalent S n.yaml --ag 0.6g --period 0.8 --plot out.svg",
    "figure": "figure 14 --record R --format svg",
    "report": "report S --record R -o out.html",
    "animate": "animate S --record R --out out.html",
    "equiv": "equiv S n.yaml --csv",
    "error of formulas": "error n.yaml --plot out.svg",
    "draw formulas": "draw n.yaml --plot out.svg",
}


@pytest.mark.parametrize("case", COMMANDS)
def test_files_that_nobody_can_spell_are_worked_on(case, hostile, tmp_path):
    words = [dict(zip("SR", hostile, strict=True)).get(word, word) for word in COMMANDS[case].split()]
    found = run(*words)
    assert not HARMFUL.search(found.stdout + found.stderr)
    pictures = list(tmp_path.glob("*.svg"))
    assert len(pictures) == (".svg" in COMMANDS[case] or "svg" in words)
    for picture in pictures:
        ElementTree.parse(picture)
    for text in [*tmp_path.glob("out.csv"), *tmp_path.glob("out.html")]:
        shown = text.read_text(encoding="utf-8")
        assert not HARMFUL.search(shown)
        assert "<b>" not in shown or "csv" in text.name


def test_a_study_of_files_that_nobody_can_spell(hostile, tmp_path):
    (tmp_path / "st.yaml").write_text(
        f"structures: [{{file: n.yaml, name: {MATHS}}}]\nrecords: ['*.csv']\nmethod: stripes\n"
        "levels: {measure: PGA, least: 0.1, most: 1.5, count: 3}\n",
        encoding="utf-8",
    )
    found = run("fragility", "st.yaml", "--plot", "pictures")
    assert not HARMFUL.search(found.stdout + found.stderr)
    run("results", "st.db", "--out", "runs.csv")
    assert printable(hostile[1]) in (tmp_path / "runs.csv").read_text(encoding="utf-8")
    json.loads(run("results", "st.db", "--json").stdout)


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
        from rocking_cli.studies.fragility.study import load_study

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
    assert len(run("equiv", name, "--csv").stdout.splitlines()) == 3
    (tmp_path / name).write_text("mechanism: blok\n", encoding="utf-8")
    assert run("equiv", name, code=2).stderr.startswith(f"error: {one_line(name)}:1:12: mechanism: unknown")

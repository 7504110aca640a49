"""What is shown fits the terminal: sentences, tables and help; nothing is lost, and no word is broken.

The results of all commands are in `test_every_command.py`.
"""

from __future__ import annotations

import os
import sys
from collections import Counter

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from rocking_cli.cli import terminal
from rocking_cli.cli.main import COMMANDS
from rocking_cli.cli.prose import cells, wrapped
from rocking_cli.cli.tables import grid, stacked
from tests.conftest import EXAMPLES
from tests.test_cli import run

ACCEL = EXAMPLES / "accel.csv"
WIDTHS = (40, 60, 80, 100)
FRAME = EXAMPLES / "frame.yaml"


def words(text):
    """How often each word is there; a heading before a value may end in a colon, and rules are none."""
    return Counter(word.rstrip(":") for word in text.replace("─", "").split())


def fits(text, width):
    """Whether no line is wider than the terminal, unless it is a single word."""
    return all(cells(line.rstrip()) <= width for line in text.splitlines() if len(line.split()) > 1)


@pytest.mark.parametrize("name", ["", *COMMANDS])
def test_help_fits_and_uses_a_wide_terminal(name, monkeypatch):
    arguments = [*name.split(), "--help"]
    monkeypatch.setenv("COLUMNS", "200")
    wide = run(*arguments).stdout
    assert max(map(len, wide.splitlines())) in range(60 if name else 90, 101)
    for width in (30, *WIDTHS):
        monkeypatch.setenv("COLUMNS", str(width))
        text = run(*arguments).stdout
        assert fits(text, width), text
        assert words(text) == words(wide)


@pytest.mark.parametrize(
    "arguments",
    [("equiv", "--an-option-that-no-command-has"), ("equiv", "a_file_that_is_not_here.yaml"), ("respond", "--dt", "0")],
)
def test_errors_fit(arguments, monkeypatch):
    wide = run(*arguments, code=2).stderr
    monkeypatch.setenv("COLUMNS", "40")
    text = run(*arguments, code=2).stderr
    assert fits(text, 40) and words(text) == words(wide)
    assert len(text.splitlines()) > len(wide.splitlines())


def test_a_pipe_gets_lines_as_they_are_and_so_do_programs(monkeypatch):
    said = run("equiv", FRAME).stdout
    assert any("frequency parameter: small for large structures" in line for line in said.splitlines())
    assert max(map(len, said.splitlines())) > 100
    whole = [run(*words).stdout for words in (("equiv", FRAME, "--csv"), ("new", "wall"), ("equiv", FRAME, "--json"))]
    monkeypatch.setenv("COLUMNS", "40")
    assert whole == [
        run(*words).stdout for words in (("equiv", FRAME, "--csv"), ("new", "wall"), ("equiv", FRAME, "--json"))
    ]


def test_a_table_that_fits_is_one_and_another_is_stacked(monkeypatch):
    monkeypatch.setenv("COLUMNS", "40")
    assert "─" in run("record", ACCEL).stdout
    text = run("mechanisms", "wall").stdout
    assert "─" not in text
    assert "field: height\n  symbol: 4h\n  unit: m\n  bounds: > 0, <= 1e+06\n" in text
    assert "  meaning: height between foot and top\n    support\n" in text


@pytest.mark.skipif(sys.platform == "win32", reason="pseudo-terminals are of POSIX")
def test_a_terminal_says_how_wide_it_is_and_a_file_does_not(tmp_path):
    import termios

    asked, terminal_of = os.openpty()
    try:
        with os.fdopen(os.dup(terminal_of), "w") as stream:
            for columns in (40, 0):
                termios.tcsetwinsize(terminal_of, (24, columns))
                assert terminal._columns(stream) == (columns or terminal.USUAL)
    finally:
        os.close(asked)
        os.close(terminal_of)
    with (tmp_path / "out.txt").open("w", encoding="utf-8") as stream:
        assert terminal._columns(stream) is None


class TestSentences:
    @example(["1", "%%111111111"], 12)
    @given(st.lists(st.text("ab%1", min_size=1, max_size=12), min_size=1, max_size=30), st.integers(12, 60))
    def test_lines_are_no_wider_and_have_the_same_words(self, said, width):
        text = " ".join(said)
        made = wrapped(text, width)
        assert made.split() == text.split()
        assert fits(made, width)

    @pytest.mark.parametrize(
        "held",
        ["12.5 m/s2", "0.78 %", "`rocking mechanisms NAME`", "dt = 0.01 s", "Eqs. 41-42", "<= 1000", "'my file.yaml'"],
    )
    def test_some_blanks_do_not_end_a_line(self, held):
        text = f"and so on {held} and so on"
        for width in range(len(held) + 2, len(text)):
            assert held in wrapped(text, width), width

    def test_what_goes_on_hangs(self):
        assert wrapped("one two three", 9) == "one two\n  three"
        assert wrapped("    one two three", 13) == "    one two\n      three"
        assert wrapped("one:   two three\nthree: four five", 14) == "one:   two\n       three\nthree: four\n       five"
        assert wrapped("one  two three", 13) == "one  two\n     three"
        assert wrapped("one two", 9, start=4) == "one\n  two"
        assert wrapped("one two three", 3, hang=0) == "one\ntwo\nthree"

    def test_a_traceback_stays_as_it_is(self):
        traced = 'Traceback (most recent call last):\n  File "a file of somebody.py", line 1'
        assert wrapped(f"it fails in a word\n{traced}", 12) == f"it fails in\n  a word\n{traced}"

    def test_wide_characters_take_two_columns(self):
        assert wrapped("木木木 木木木", 12) == "木木木\n  木木木"

    @pytest.mark.parametrize("place", [0, 30, 99])
    def test_a_mark_stays_below_what_it_marks(self, place):
        quoted = "".join(chr(33 + k % 90) for k in range(100))
        line, mark = wrapped(f"said\n    {quoted}\n    {' ' * place}^", 40).splitlines()[1:]
        assert len(line) <= 40 and line[mark.index("^")] == quoted[place]


class TestLayout:
    COLUMNS, ROWS = ["", "long\nheading", "meaning"], [["  first", "1", "what it means, in a word or two"]]

    def test_columns_come_closer_before_cells_wrap_before_rows_are_stacked(self):
        assert grid(self.COLUMNS, self.ROWS, {1}, None)[0] == 3
        assert grid(self.COLUMNS, self.ROWS, {1}, 53)[0] == 3
        assert grid(self.COLUMNS, self.ROWS, {1}, 52) == (2, [self.COLUMNS, *self.ROWS])
        assert grid(self.COLUMNS, self.ROWS, {1}, 50) is None  # too narrow to wrap in
        rows = [["x" * 30, "1", "what it means, in a word or two"]]
        gap, (_, cells) = grid(self.COLUMNS, rows, {1}, 65)
        assert gap == 2 and cells[-1] == "what it means, in a\nword or two"
        assert grid(self.COLUMNS, [["x" * 40, *rows[0][1:]]], {1}, 65) is None

    def test_a_row_is_a_block_below_its_first_cell(self):
        assert stacked(self.COLUMNS, self.ROWS, 30) == [
            "  first", "    long heading: 1", "    meaning: what it means, in\n      a word or two",
        ]  # fmt: skip
        assert stacked(["a", "b", "c"], [["1", "", "2\n3"]], 30) == ["a: 1", "  c: 2 3"]

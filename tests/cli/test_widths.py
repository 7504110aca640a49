"""What is shown fits the terminal: sentences, tables and help; nothing is lost, and no word is broken.

The results of all commands are in `test_every_command.py`.
"""

import os
import re
import sys
from collections import Counter

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

import rocking_cli as rk
from rocking_cli.cli import terminal
from rocking_cli.cli.layout import cells, grid, stacked, wrapped
from rocking_cli.cli.main import main
from rocking_cli.plugins.rooms import commands
from rocking_cli.views.view import ASIDE, Table
from tests.cli.test_cli import run
from tests.conftest import EXAMPLES

ACCEL = EXAMPLES / "accel.csv"
FRAME = EXAMPLES / "frame.yaml"


def words(text):
    """How often each word is there; a heading before a value may end in a colon, and rules are none."""
    return Counter(word.rstrip(":") for word in text.replace("─", "").split())


def fits(text, width):
    """Whether no line is wider than the terminal, unless it is a single word."""
    return all(cells(line.rstrip()) <= width for line in text.splitlines() if len(line.split()) > 1)


@pytest.mark.parametrize("width", [40, 80])  # in tests, click takes any terminal for one of 80
@pytest.mark.parametrize("name", ["", *commands()])
def test_help_fits(name, width, monkeypatch):
    monkeypatch.setenv("COLUMNS", str(width))
    text = run(*name.split(), "--help").stdout
    whole = ("    rocking ", *(["  -"] if width == 40 else []))  # lines to be copied, and the names of an option
    assert fits("\n".join(line for line in text.splitlines() if not line.startswith(whole)), width)


def test_help_uses_a_wide_terminal(monkeypatch):
    monkeypatch.setenv("COLUMNS", "200")
    assert main.context_class(main, **main.context_settings).make_formatter().width == 98


@pytest.mark.parametrize(
    "arguments",
    [
        ("equiv", "--an-option-that-no-command-has"),
        ("equiv", "a_file_that_is_not_here.yaml"),
        ("respond", "--dt", "0.01 kilograms"),
    ],
)
def test_errors_fit(arguments, monkeypatch):
    wide = run(*arguments, code=2).stderr
    monkeypatch.setenv("COLUMNS", "40")
    text = run(*arguments, code=2).stderr
    assert fits(text, 40) and words(text) == words(wide)
    assert len(text.splitlines()) > len(wide.splitlines())


def test_a_pipe_gets_lines_as_they_are_and_so_do_programs(monkeypatch):
    said = run("equiv", FRAME, "--all").stdout
    assert any("frequency parameter: small for large structures" in line for line in said.splitlines())
    assert max(map(len, said.splitlines())) > 100
    whole = [run(*words).stdout for words in (("equiv", FRAME, "-o", "-"), ("new", "wall"), ("equiv", FRAME, "--json"))]
    monkeypatch.setenv("COLUMNS", "40")
    assert whole == [
        run(*words).stdout for words in (("equiv", FRAME, "-o", "-"), ("new", "wall"), ("equiv", FRAME, "--json"))
    ]


def test_a_table_that_fits_is_one_and_another_is_stacked(monkeypatch):
    monkeypatch.setenv("COLUMNS", "40")
    assert "─" in run("record", ACCEL).stdout
    text = run("mechanisms", "wall", "--all").stdout
    assert "─" not in text
    assert "field: height\n  symbol: 4h\n  unit: m\n  bounds: > 0, <= 1e+06\n" in text
    assert "  meaning: height between foot and top\n    support\n" in text


RANKED = Table("", ["", "much", "more", "aside"], [["a", "11111", "22222", "333"], ["b", "1", "2", "3"]], range(1, 4),
               [0, 1, 1, ASIDE], asides=[1])  # fmt: skip


@pytest.mark.parametrize(
    ("width", "in_full", "words"),
    [
        (40, False, "much more a 11111 22222"), (40, True, "much more aside a 11111 22222 333 b 1 2 3"),
        (14, False, "much a 11111 No room for more: use a wider terminal, or --all."),
        (8, False, "a No room for much, more: use a wider terminal, or --all."),
        (14, True, "a much 11111 more 22222 aside 333 b much 1 more 2 aside 3"),
    ],
)  # fmt: skip
def test_the_least_important_columns_leave_first_and_are_named(width, in_full, words, monkeypatch, capsys):
    monkeypatch.setenv("COLUMNS", str(width))
    assert terminal.table(RANKED, in_full=in_full) == (not in_full)
    assert re.sub("[─:]", " ", capsys.readouterr().out).split() == words.replace(":", " ").split()


def test_what_only_explains_is_shown_with_all_alone(monkeypatch):
    short, whole = (run("equiv", FRAME, *more) for more in ((), ("--all",)))
    (aside,) = [each for each in rk.equiv(FRAME).sentences if each.startswith("The rotation phi of the structure is")]
    for text in (aside, "I_eq", "linearised inertia"):
        assert text in whole.stdout and text not in short.stdout
    assert "--all shows more" in short.stderr and "--all" not in whole.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="pseudo-terminals are of POSIX")
def test_a_terminal_says_how_wide_it_is_and_a_file_does_not(tmp_path):
    import termios

    asked, terminal_of = os.openpty()
    try:
        with os.fdopen(os.dup(terminal_of), "w") as stream:
            for columns in (40, 0):
                termios.tcsetwinsize(terminal_of, (24, columns))
                assert terminal._columns(stream) == (columns or terminal.DEFAULT_WIDTH)
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

    def test_what_goes_on_hangs(self):
        assert wrapped("one two three", 9) == "one two\n  three"
        assert wrapped("    one two three", 13) == "    one two\n      three"
        assert wrapped("one two", 9, start=4) == "one\n  two"

    def test_a_traceback_stays_as_it_is(self):
        traced = 'Traceback (most recent call last):\n  File "a file of somebody.py", line 1'
        assert wrapped(f"it fails in a word\n{traced}", 12) == f"it fails in\n  a word\n{traced}"

    def test_a_mark_stays_below_what_it_marks(self):
        text = f"said\n    {'a' * 30} {'b' * 30}\n    {' ' * 35}^"
        assert wrapped(text, 40) == text


class TestLayout:
    COLUMNS, ROWS = ["", "long\nheading", "meaning"], [["  first", "1", "what it means, in a word or two"]]

    def lines(self, width, first="  first"):
        found = grid(self.COLUMNS, [[first, *self.ROWS[0][1:]]], {1}, width, "-")
        return found and [*found[0], *found[1]]

    def test_columns_come_closer_before_cells_wrap_before_rows_are_stacked(self):
        assert self.lines(None) == self.lines(53) == [
            " " * 53,
            " " * 14 + "long" + " " * 35,
            " " * 11 + "heading   meaning" + " " * 25,
            f" {'-' * 51} ",
            "   first         1   what it means, in a word or two ",
            " " * 53,
        ]  # fmt: skip
        assert {len(line) for line in self.lines(52)} == {51}
        assert self.lines(50) is None  # too narrow to wrap in
        assert [line[41:].strip() for line in self.lines(65, "x" * 30)[4:6]] == ["what it means, in a", "word or two"]
        assert self.lines(65, "x" * 40) is None

    def test_wide_characters_take_two_columns(self):
        (_, head), (_, row, _) = grid(["a", "b"], [["木", "1"]], (), None, "-")
        assert (head, row) == (" a    b ", " 木   1 ")

    def test_a_row_is_a_block_below_its_first_cell(self):
        assert stacked(self.COLUMNS, self.ROWS, 30) == [
            "  first", "    long heading: 1", "    meaning: what it means, in\n      a word or two",
        ]  # fmt: skip
        assert stacked(["a", "b", "c"], [["1", "", "2\n3"]], 30) == ["a: 1", "  c: 2 3"]

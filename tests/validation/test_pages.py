"""The pages of this folder: a line a set and version, of which none is lost, and what was given agrees with itself."""

import re

import pytest

from rocking_cli import __version__
from rocking_cli.studies.neighbours import Neighbourhood
from tests import free_blocks
from tests.conftest import PROJECT
from validation import middle, scoreboard, traces, trust
from validation.pages import MADE, renewed
from validation.rules import Stated, scored
from validation.table import ObservedTest


@pytest.fixture
def found():
    """Two tests of which one share is right and one is wrong by a quarter: a Brier score of 1/32."""
    tests = [ObservedTest(k + 2, "a", "b", bool(k), cluster=str(k)) for k in range(2)]
    return scored([Stated(tests[0], 1, 0, 4), Stated(tests[1], 4, 0, 4)], Neighbourhood(4))


@pytest.fixture(scope="module")
def board():
    return scoreboard.PAGE.read_text(encoding="utf-8")


def test_the_page_is_what_its_own_lines_make(board):
    lines = scoreboard.kept(board)
    assert len(lines) > 6 and scoreboard.page(board, lines) == board


def test_a_line_has_the_scores_and_their_drift_since_another_version(found):
    name, row = scoreboard.BOULDERS, scoreboard.row
    first = row(name, found, [])
    assert first.cells[:3] == (name, __version__, "2") and first.cells[4] == "first"
    assert first.brier == pytest.approx(1 / 32, abs=5e-4)
    older = scoreboard.Row((name, "0.0.9", "2", "0.081 [0.060 0.106]", *first.cells[4:]))
    newer = scoreboard.Row((name, "0.0.10", "2", "0.021 [0.010 0.106]", *first.cells[4:]))
    assert row(name, found, [older, newer, first]).cells[4] == "+0.010 since 0.0.10"


def test_the_line_of_assemblies_has_what_both_engines_agree_on(monkeypatch, board):
    alike = free_blocks.Pair("a", False, False, 0.0, 1.0, 1.04, (0.9, 1.1))
    pairs = [alike, alike._replace(free_peak=1.2), alike._replace(exact=None, free=True)]
    monkeypatch.setattr(free_blocks, "forty", list)
    monkeypatch.setattr(free_blocks, "side_by_side", lambda cases, processes: pairs)
    line = scoreboard.assemblies([])
    counts = ("2 of 3", "2 of 2", "1 of 2", "1")
    assert line.cells == (scoreboard.ASSEMBLIES, __version__, *counts, "first", "1", "0", "1", "0")
    older = scoreboard.Row((line.cells[0], "0.0.9", "2 of 3", "2 of 2", "2 of 2", *line.cells[5:]))
    assert scoreboard.assemblies([older, line]).cells[6] == "-1 since 0.0.9"
    assert scoreboard.kept(scoreboard.page(board, [older, line])) == [older, line]


def test_lines_are_replaced_or_stay(found, board):
    Row, row = scoreboard.Row, scoreboard.row
    boulders, shakebot = scoreboard.BOULDERS, scoreboard.SHAKEBOT
    new = row(boulders, found, [])
    old = Row((boulders, "0.0.9", *new.cells[2:]))
    stale = Row((*new.cells[:3], "0.500 [0.4 0.6]", *new.cells[4:]))
    absent = Row((shakebot, "0.0.9", *new.cells[2:]))
    merged = scoreboard.merged([old, stale, absent], [new])
    assert merged == [old, new, absent]
    assert scoreboard.kept(scoreboard.page(board, merged)) == merged


@pytest.fixture(scope="module")
def text():
    return trust.PAGE.read_text(encoding="utf-8")


def test_the_page_is_what_its_data_make(text):
    """All but what is made of the tests, which `make trust-check` scores again."""
    own = {part["name"]: part["text"].strip("\n") for part in MADE.finditer(text)}
    assert trust.stale(text, renewed(text, own | trust.without_tests())) == []
    with pytest.raises(ValueError, match="the page has the parts"):
        renewed(text, trust.without_tests())


@pytest.mark.parametrize(("apart", "named"), [(0.0, 0), (1e-5, 0), (2e-5, 1)])
def test_data_of_another_tool_are_named(monkeypatch, apart, named):
    first, *others = [float(row["first"]) for row in traces.rows()]
    found = iter([first + apart, *others])
    monkeypatch.setattr(traces, "fitted", lambda case, seed: (next(found),))
    monkeypatch.setattr(middle, "RULE", middle.RULE if not named else Neighbourhood(restitution=0.04))
    assert len(trust.outdated()) == 2 * named


def test_a_number_that_changed_is_named(text):
    assert trust.stale(text, text) == []
    row = next(line for line in text.splitlines() if line.startswith("| neighbours |"))
    assert "-" + row in trust.stale(text, text.replace(row, row.replace("0.0", "0.1")))


def test_the_paper_has_the_numbers_of_the_page(text):
    scores = re.findall(r"0\.\d{3}", (PROJECT / "paper.md").read_text(encoding="utf-8"))
    assert len(scores) > 6 and all(each in text for each in scores)


@pytest.mark.parametrize(
    ("now", "same"), [("eta .0303 +- 0.02", True), ("eta .0304 +- 0.02", False), ("eta .0302 + 0.02", False)]
)
def test_a_line_that_differs_by_a_unit_of_its_last_digit_is_not_stale(now, same):
    assert trust.is_same("eta .0302 +- 0.02", now) == same


def test_what_was_given_of_the_other_half_agrees_with_itself(text):
    bins = trust.KEPT_APART
    given = next(row for row in text.split("kept apart by")[1].splitlines() if row.startswith("| neighbours |"))
    assert sum(each.tests for each in bins) == 380
    gap = sum(each.tests * abs(each.stated - each.observed) for each in bins) / 380
    assert gap == pytest.approx(float(given.split("|")[-2]), abs=1.5e-3)  # all are rounded to three digits
    fell = [each.observed * each.tests for each in bins]
    assert all(one == pytest.approx(round(one), abs=6e-4 * each.tests) for one, each in zip(fell, bins, strict=True))

"""The page of scores: a line a set and version, of which none is lost."""

import runpy

import pytest

from rocking_cli.questions.score.study import Stated, scored
from rocking_cli.questions.score.table import ObservedTest
from rocking_cli.studies.neighbours import Neighbourhood
from tests import free_blocks
from tests.conftest import PROJECT

PAGE = PROJECT / "docs" / "scoreboard.md"


@pytest.fixture(scope="module")
def made():
    return runpy.run_path(str(PROJECT / "docs" / "make_scoreboard.py"))


@pytest.fixture
def found():
    """Two tests of which one share is right and one is wrong by a quarter: a Brier score of 1/32."""
    tests = [ObservedTest(k + 2, "a", "b", bool(k), cluster=str(k)) for k in range(2)]
    return scored([Stated(tests[0], 1, 0, 4), Stated(tests[1], 4, 0, 4)], Neighbourhood(4))


def test_the_page_is_what_its_own_lines_make(made):
    text = PAGE.read_text(encoding="utf-8")
    assert made["page"](made["kept"](text)) == text


def test_a_line_has_the_scores_and_their_drift_since_another_version(made, found):
    name, row = made["BOULDERS"], made["row"]
    first = row(name, found, [])
    assert first.cells[:4] == (name, made["__version__"], "2", "2") and first.cells[5] == "first"
    assert first.brier == pytest.approx(1 / 32, abs=5e-4)
    older = made["Row"]((name, "0.0.9", "2", "2", "0.081 [0.060 0.106]", *first.cells[5:]))
    newer = made["Row"]((name, "0.0.10", "2", "2", "0.021 [0.010 0.106]", *first.cells[5:]))
    assert row(name, found, [older, newer, first]).cells[5] == "+0.010 since 0.0.10"


def test_the_line_of_assemblies_has_what_both_engines_agree_on(made, monkeypatch):
    alike = free_blocks.Pair("a", False, False, 0.0, 1.0, 1.04, (0.9, 1.1))
    pairs = [alike, alike._replace(free_peak=1.2), alike._replace(exact=None, free=True)]
    monkeypatch.setattr(free_blocks, "forty", list)
    monkeypatch.setattr(free_blocks, "side_by_side", lambda cases, processes: pairs)
    line = made["assemblies"]([])
    counts = ("2 of 3", "2 of 2", "1 of 2", "1")
    assert line.cells == (made["ASSEMBLIES"], made["__version__"], *counts, "first", "1", "0", "1", "0")
    older = made["Row"]((line.cells[0], "0.0.9", "2 of 3", "2 of 2", "2 of 2", *line.cells[5:]))
    assert made["assemblies"]([older, line]).cells[6] == "-1 since 0.0.9"
    assert made["kept"](made["page"]([older, line])) == [older, line]


def test_lines_are_replaced_or_stay(made, found):
    Row, row = made["Row"], made["row"]
    boulders, shakebot = made["BOULDERS"], made["SHAKEBOT"]
    new = row(boulders, found, [])
    old = Row((boulders, "0.0.9", *new.cells[2:]))
    stale = Row((*new.cells[:4], "0.500 [0.4 0.6]", *new.cells[5:]))
    absent = Row((shakebot, "0.0.9", *new.cells[2:]))
    merged = made["merged"]([old, stale, absent], [new])
    assert merged == [old, new, absent]
    assert made["kept"](made["page"](merged)) == merged

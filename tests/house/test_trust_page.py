"""The page on shake-table tests: it is made of its parts, and what was given agrees with itself."""

import runpy

import pytest

from tests.conftest import PROJECT


@pytest.fixture(scope="module")
def made():
    return runpy.run_path(str(PROJECT / "docs" / "make_trust.py"))


@pytest.fixture(scope="module")
def text(made):
    return made["PAGE"].read_text(encoding="utf-8")


def test_the_page_holds_its_parts(made, text):
    assert all(made["part"](made[name]) in text for name in ("TRACES", "MIDDLE"))


def test_a_number_that_changed_is_named(made, text):
    assert made["stale"](text, text) == []
    row = next(line for line in text.splitlines() if line.startswith("| neighbours |"))
    assert "-" + row in made["stale"](text, text.replace(row, row.replace("0.0", "0.1")))


@pytest.mark.parametrize(
    ("now", "same"), [("eta .0303 +- 0.02", True), ("eta .0304 +- 0.02", False), ("eta .0302 + 0.02", False)]
)
def test_a_line_that_differs_by_a_unit_of_its_last_digit_is_not_stale(made, now, same):
    assert made["is_same"]("eta .0302 +- 0.02", now) == same


def test_what_was_given_of_the_other_half_agrees_with_itself(made):
    bins, scores = made["KEPT_APART"], made["KEPT_APART_SCORES"]
    own = next(line for line in scores.splitlines() if line.startswith("| neighbours |"))
    assert sum(each.tests for each in bins) == 380
    gap = sum(each.tests * abs(each.stated - each.observed) for each in bins) / 380
    assert gap == pytest.approx(float(own.split("|")[-2]), abs=1.5e-3)  # all are rounded to three digits
    fell = [each.observed * each.tests for each in bins]
    assert all(one == pytest.approx(round(one), abs=6e-4 * each.tests) for one, each in zip(fell, bins, strict=True))

"""No folder has more code than its number in `budget.toml`, and the package no more files and short functions."""

import tomllib
from collections import Counter

import pytest

from tests.house import budget

FILE = '''"""Of a module."""

# a comment

def f(x):
    """Of a function,

    in four lines.
    """
    text = """
    not of a docstring

    """  # with a comment
    return (text,
            x); x
'''


def test_no_folder_has_more_code_than_its_number_or_much_less():
    found = list(budget.complaints(tomllib.loads(budget.FILE.read_text(encoding="utf-8")), budget.counted()))
    assert not found, "\n".join(found)


def test_blank_lines_comments_and_docstrings_do_not_count():
    assert budget.code(FILE) == (7, [7])


@pytest.mark.parametrize(
    ("number", "lines", "said"),
    [
        (100, 101, ["docs: 101 lines of code, 1 above"]),
        (100, 96, []),
        (100, 95, ["docs: 95 lines of code, 5 below"]),
        (200, 195, []),
        (200, 194, ["docs: 194 lines of code, 6 below"]),
        (0, 1, ["docs: 1 lines of code, 1 above"]),
    ],
)
def test_what_is_said_of_a_number(number, lines, said):
    found = budget.complaints({"docs": number}, Counter(docs=lines))
    assert [text.partition(" its number")[0] for text in found] == said


def test_who_raises_a_number_lowers_another():
    numbers = {"tests": 300, "tests/cli": 100, "tests/core": 203}
    assert ["3 above its own" in each for each in budget.complaints(numbers, Counter(numbers))] == [True]


def test_a_median_may_rise_and_not_fall():
    said = [list(budget.complaints({budget.MEDIAN: 5}, Counter({budget.MEDIAN: found}))) for found in (4, 5, 9)]
    assert [len(each) for each in said] == [1, 0, 0]
    assert budget.lowered(f'"{budget.MEDIAN}" = 5\n', Counter({budget.MEDIAN: 8})) == f'"{budget.MEDIAN}" = 8\n'


def test_numbers_are_lowered_and_reasons_stay():
    text = '# Why.\n"docs" = 9\n"old" = 5\n"tests" = 3  # paid by docs\n'
    assert budget.lowered(text, Counter(docs=7, tests=4)) == '# Why.\n"docs" = 7\n"tests" = 3  # paid by docs\n'

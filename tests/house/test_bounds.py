"""The list of bounds is that of the code, and no bound decides a sure verdict of a sample of `make bounds`."""

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import pytest

from tests import bounds
from tests.bounds import Verdict
from tests.conftest import PROJECT

TOLD = {name for kind, lines in bounds.listed().items() if kind != "named" for name in lines}


def test_every_constant_has_a_line_and_every_line_a_constant():
    assert set(bounds.names()) == TOLD


def test_no_constant_has_two_lines():
    assert sum(len(lines) for kind, lines in bounds.listed().items() if kind != "named") == len(TOLD)


def test_what_answers_name_is_a_physical_bound():
    assert set(bounds.listed()["named"]) <= set(bounds.listed()["physical"])


@pytest.mark.parametrize(
    ("before", "after", "changed"),
    [
        (Verdict(0.0, 0.0), Verdict(0.0, 0.05), False),
        (Verdict(0.0, 0.0), Verdict(0.1, 0.1), True),
        (Verdict(0.0, 0.0), Verdict(0.0, 0.5), True),
        (Verdict(1.0, 1.0), Verdict(0.0, 1.0), True),
        (Verdict(0.4, 0.4), Verdict(1.0, 1.0), False),
        (Verdict(0.0, 0.0), Verdict(refused="why"), True),
        (Verdict(refused="why"), Verdict(0.0, 0.0), False),
    ],
)
def test_only_a_sure_verdict_changes(before, after, changed):
    assert before.against(after) is changed


def test_doubled_in_defaults_and_in_what_is_derived():
    code = (
        "from tests import bounds; bounds.double(['rocking_cli.names.TAIL_SECONDS']);"
        "import inspect; from rocking_cli.studies.engines.exact import follow;"
        "print(inspect.signature(follow).parameters['tail'].default)"
    )
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=PROJECT).stdout == "20.0\n"


@pytest.mark.rest
def test_no_sure_verdict_of_a_sample_changes():
    numbers = range(len(bounds.KINDS))
    with ThreadPoolExecutor(bounds.AT_ONCE) as pool:
        found = bounds.in_parts(pool, "exact", numbers)
        assert {verdict.word for verdict, _ in found.values()} >= {"stands", "overturns", "unknown"}
        assert not [verdict.refused for verdict, _ in found.values() if verdict.refused.startswith(bounds.BROKEN)]
        assert not [each for each in bounds.changes(pool, found, numbers, "physical") if not each.named]

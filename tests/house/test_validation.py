"""docs/validation.md is what the code gives, and the tests it names are there."""

import re
import runpy

import pytest

from tests.conftest import PROJECT


@pytest.mark.docs
def test_the_page_is_not_stale():
    page = runpy.run_path(str(PROJECT / "docs" / "make_validation.py"))["page"]
    text = (PROJECT / "docs" / "validation.md").read_text(encoding="utf-8")
    assert page(text) == text, "run make validation"


def test_the_tests_it_names_are_there():
    page = (PROJECT / "docs" / "validation.md").read_text(encoding="utf-8")
    named = set(re.findall(r"`(test_\w+\.py)`", page))
    assert len(named) > 5
    assert named <= {file.name for file in (PROJECT / "tests").rglob("test_*.py")}

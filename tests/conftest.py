"""What several test files share."""

from __future__ import annotations

from pathlib import Path

import pytest

PROJECT = Path(__file__).resolve().parents[1]
EXAMPLES = PROJECT / "examples"
RECORDS = PROJECT.parent / "shared" / "records"


@pytest.fixture(autouse=True)
def _in_an_empty_folder(tmp_path, monkeypatch):
    """No test reads a `rocking.yaml` that happens to lie where pytest was started."""
    monkeypatch.chdir(tmp_path)

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


@pytest.fixture(scope="session")
def frame_report(tmp_path_factory):
    """The report on the example of a frame: its file, and what was printed."""
    from tests.test_cli import run

    out = tmp_path_factory.mktemp("report") / "r.html"
    result = run("report", EXAMPLES / "frame.yaml", "--record", EXAMPLES / "accel.csv", "-o", out)
    return out, result.stdout.strip()

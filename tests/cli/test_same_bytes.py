"""The same input gives the same bytes, whatever the day: every kind of file that a command writes."""

import shlex
import time
from datetime import UTC, datetime
from pathlib import Path

import pytest

from rocking_cli.io import browser
from tests.cli.test_cli import run
from tests.cli.test_every_option import BLOCK_FILE, SITE
from tests.conftest import EXAMPLES

pytestmark = pytest.mark.drawn
UNDER = f"{BLOCK_FILE} --pulse sine:0.3g:0.3s --neighbours 0"
SURVEY = "survey few.csv --page p.html --map m.svg"
FEW = "mechanism,name,width,height,longitude,latitude\nblock,low,0.5,1.5,10,45\nblock,high,0.4,2,10.1,45\n"
WRITTEN = {
    ".csv .parquet": [f"respond {UNDER} --out o.csv", f"respond {UNDER} --out o.parquet"],
    ".png": [f"respond {UNDER} --plot o.png"],
    ".svg": [f"respond {UNDER} --plot o.svg", f"draw {BLOCK_FILE} --plot d.svg"],
    ".pdf": [f"draw {BLOCK_FILE} --plot o.pdf", f"verify {BLOCK_FILE} --site {SITE} --sheet s.pdf"],
    ".dxf": [f"draw {BLOCK_FILE} --dxf o.dxf"],
    ".html": [f"verify {BLOCK_FILE} --site {SITE} --sheet s.html", f"animate {UNDER} --out a.html"],
    ".docx": [f"verify {BLOCK_FILE} --site {SITE} --sheet s.docx"],
    ".gif": [f"animate {UNDER} --fps 2 --out a.gif"],
    ".html .svg of a survey": [SURVEY],
    ".yaml": [f"import {EXAMPLES / 'drawings' / 'wall.svg'} --scale 1:50 --depth 1 --density 2000 --out o.yaml"],
    "a folder": ["new odd --plugin --out odd"],
}
NEEDS = {".csv .parquet": "pyarrow", ".pdf": "typst", ".dxf": "ezdxf", ".docx": "docx"}


@pytest.mark.every(4)
@pytest.mark.parametrize(
    "kind", [pytest.param(kind, marks=[pytest.mark.rest] * ("survey" in kind)) for kind in WRITTEN]
)
def test_the_same_input_gives_the_same_bytes(kind, tmp_path, monkeypatch):
    pytest.importorskip(NEEDS.get(kind, "numpy"))
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    written, now = [], time.time
    for later in (0, 100_000):  # s
        monkeypatch.setattr(time, "time", lambda later=later: now() + later)  # as zip archives take it
        (folder := tmp_path / str(later)).mkdir()
        monkeypatch.chdir(folder)
        Path("few.csv").write_text(FEW, encoding="utf-8")
        for line in WRITTEN[kind]:
            run(*shlex.split(line))
        written.append({each.relative_to(folder): each.read_bytes() for each in folder.rglob("*") if each.is_file()})
    assert written[0] and written[0] == written[1]
    if kind == ".html":
        day = datetime.fromtimestamp(1_700_000_000, UTC)
        assert f"{day.day} November 2023" in Path("s.html").read_text("utf-8")


def test_a_page_that_a_browser_prints_keeps_its_length_without_its_dates(monkeypatch):
    made = b"%PDF /CreationDate (D:20240101120000+00'00')\n/ModDate (D:20240101120000+00'00')>> xref"

    def print_page(command, **_):
        Path(next(each for each in command if "print-to-pdf=" in each).partition("=")[2]).write_bytes(made)

    monkeypatch.setattr(browser, "browser", lambda: "browser")
    monkeypatch.setattr(browser.subprocess, "run", print_page)
    printed = browser.as_pdf(b"")
    assert len(printed) == len(made) and b"2024" not in printed and printed.split() == [b"%PDF", b">>", b"xref"]

"""Writes the calculation sheets of examples/verify/sheets, and the pictures of pages of one of them.

All in a sheet follows from the files in examples/, but for the day, the release and the machine. These are given below,
so that a sheet is stale only if the program prints something else. `make_pages.py` renews sheets and pictures.
"""

from __future__ import annotations

import re
import shlex
from contextlib import chdir
from datetime import date
from math import isclose
from pathlib import Path

from make_runs import Content
from parts import NUMBER

import rocking_cli as rk
from rocking_cli.ask.inputs import site_of
from rocking_cli.cli.made import Made
from rocking_cli.documents.sheet_page import render
from rocking_cli.documents.sheet_typst import page_pictures
from rocking_cli.questions.verify.asked import VerifyAsked
from rocking_cli.studies.provenance import RECORDED_PACKAGES, File, TitleBlock
from rocking_cli.views.sheet.build import SheetSources, sheet
from rocking_cli.views.sheet.document import Sheet
from rocking_cli.views.sheet.language import ABSENT, Language

PROJECT = Path(__file__).resolve().parents[1]
KEPT = PROJECT / "examples" / "verify" / "sheets"
DAY, RELEASE = date(2026, 11, 26), "X.Y.Z"
MACHINE = {"system": "Linux, macOS, Windows", "Python": "3.11 ... 3.14", **dict.fromkeys(RECORDED_PACKAGES, ABSENT)}
RECORDS = "examples/verify/records.csv"
COMMANDS = {
    "facade": "rocking verify examples/verify/tied_facade.yaml --site examples/verify/site.yaml --language it",
    "parapet": "rocking verify examples/verify/parapet.yaml --site examples/verify/roof.yaml",
    "arch_on_piers": "rocking verify examples/verify/arch_on_piers.yaml --site examples/verify/site.yaml",
    "buttressed_arch": "rocking verify examples/masonry/buttressed_arch.yaml --site examples/verify/lowland.yaml"
    " --set SLV=examples/verify/slv.yaml --set SLC=examples/verify/slc.yaml --language it",
}
PICTURED = "facade"
PAGES = {"sheet_page_1.png": (1, "summary"), "sheet_page_2.png": (5, "figures"), "sheet_page_3.png": (12, "positive")}
"""Of each picture the page that it shows, and the section of the sheet by whose words a stale one is known."""
ROUNDING = 2e-5  # of a number with six digits, on another machine
PPI = 110  # pixels per inch


def made(name: str) -> Sheet:
    """Return a sheet by the name of its file."""
    call = f"{COMMANDS[name]} --sheet {name}.html"
    with chdir(PROJECT):
        asked = Made("verify", VerifyAsked, "").make_context("verify", shlex.split(call)[2:]).params
        structure, site = (File(file, Path(file).read_bytes()) for file in (asked["structure"][0], asked["site"]))
        sets = dict(each.split("=") for each in asked["sets"])
        found = rk.verify(structure.name, site.name, sets=sets or None).result
        records = {RECORDS: File(RECORDS, Path(RECORDS).read_bytes())} if sets else {}
        own = f"mechanism {found.mechanism.mechanism}"
        packages = {"rocking-cli": RELEASE, own: f"rocking-cli {RELEASE}", **MACHINE}
        say = Language(asked["language"] or "en")
        sources = SheetSources(structure, site, records, packages)
        return sheet(found, site_of(site.name), say, TitleBlock(call, say.day(DAY)), sources)


def pages() -> dict[str, str]:
    """Return every sheet as a page, by the name of its file."""
    return {f"{name}.html": render(made(name)) for name in COMMANDS}


def stale(every: dict[str, str]) -> list[str]:
    """Return the sheets that are missing, or whose words or numbers differ, and those that are none of these."""
    there = {file.name: file.read_text(encoding="utf-8") for file in KEPT.iterdir()}
    return [
        name for name in sorted({*every, *there})
        if name not in every or name not in there or not same(every[name], there[name])
    ]  # fmt: skip


def same(one: str, other: str) -> bool:
    """Return whether two pages say the same, with numbers that are equal but for rounding."""
    texts = [words(each) for each in (one, other)]
    found, kept = ([float(each.replace(",", "")) for each in NUMBER.findall(text)] for text in texts)
    return NUMBER.sub("0", texts[0]) == NUMBER.sub("0", texts[1]) and all(
        isclose(*pair, rel_tol=ROUNDING) for pair in zip(found, kept, strict=True)
    )


def words(page: str) -> str:
    """Return what a page says, in its text and in its pictures, whose lines depend on the fonts of the machine."""
    body = page.partition("</style>")[2]
    return re.sub(r"(?<=\d),(?=\d)", ".", " ".join(re.sub(r"<[^>]*>", " ", body).split()))


def contents() -> dict[str, Content]:
    """Return what each picture of a page shows: its number, and the words of a section of the kept sheet."""
    page = (KEPT / f"{PICTURED}.html").read_text(encoding="utf-8")
    sections = {
        name: page.partition(f'<section id="{key}"')[2].partition("</section>")[0] for name, (_, key) in PAGES.items()
    }
    return {name: [[f"page {PAGES[name][0]}", words(f"</style>{section}")]] for name, section in sections.items()}


def draw(folder: Path) -> None:
    """Draw the pages into a folder."""
    pictures = page_pictures(made(PICTURED), PPI)
    for name, (page, _) in PAGES.items():
        (folder / name).write_bytes(pictures[page - 1])


def main() -> None:
    """Write the sheets that are stale."""
    KEPT.mkdir(exist_ok=True)
    every = pages()
    for name in stale(every):
        if name in every:
            (KEPT / name).write_text(every[name], encoding="utf-8", newline="\n")
        else:
            (KEPT / name).unlink()
        print(f"renewed examples/verify/sheets/{name}")


if __name__ == "__main__":
    main()

"""A document as PDF, laid out by typst, which needs no browser and no fonts of the system."""

from __future__ import annotations

import base64
from collections.abc import Callable, Sequence
from importlib.resources import files
from itertools import count
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from rocking_cli.documents.figures import svg
from rocking_cli.documents.mathematics import Unreadable, formulas_of, pieces
from rocking_cli.documents.sheet_page import ORIGIN_MARKS, figure_of, printed_width, runs
from rocking_cli.errors import Refused
from rocking_cli.io.json_text import json_text
from rocking_cli.text import printable
from rocking_cli.verification.results import Working
from rocking_cli.views.sheet.document import Drawing, Item, Listing, Sheet, SheetPart, Steps
from rocking_cli.views.view import Table

LAYOUT = "document.typ"


def render(sheet: Sheet) -> bytes:
    """Return the PDF of a document.

    Parameters
    ----------
    sheet : Sheet
        The document.

    Raises
    ------
    Refused
        If typst cannot lay it out, such as for a logo that it cannot read.
    """
    document: bytes = _laid_out(sheet, format="pdf")
    return document


def page_pictures(sheet: Sheet, ppi: float) -> list[bytes]:
    """Return the pages of the PDF of a document as pictures, PNG, with a number of pixels per inch."""
    pages: list[bytes] = _laid_out(sheet, format="png", ppi=ppi)
    return pages


def _laid_out(sheet: Sheet, **how: Any) -> Any:
    """Return what typst makes of a sheet. Raises `Refused` if it cannot lay it out."""
    import typst

    with TemporaryDirectory(prefix="rocking-", ignore_cleanup_errors=True) as folder:
        for name, content in _files(sheet).items():
            (Path(folder) / name).write_bytes(content)
        try:
            return typst.compile(Path(folder) / LAYOUT, root=Path(folder), **how)
        except typst.TypstError as error:
            raise Refused(f"the PDF could not be laid out: {printable(error.message)}") from None


def _files(sheet: Sheet) -> dict[str, bytes]:
    """Return the files that typst reads: the layout, the texts as JSON, and the pictures."""
    pictures, steps = dict[str, bytes](), count(1)

    def step(row: Working) -> dict[str, Any]:
        formulas, gives = formulas_of(row)
        return {
            "count": str(next(steps)), "meaning": _runs(row.meaning),
            "clause": printable(f"{row.clause}{ORIGIN_MARKS[row.standing]}"),
            "formulas": [[sign, _formula(text)] for sign, text in formulas], "gives": gives,
            "result": _runs(sheet.language.number(row.value, row.digits)), "unit": printable(row.unit),
        }  # fmt: skip

    def drawing(item: Drawing) -> dict[str, Any]:
        figure, file = figure_of(item, sheet.language), f"{len(pictures)}.svg"
        width = printed_width(figure, item.height)  # before it is drawn
        pictures[file] = svg(figure, file, text_as="path").encode()
        return {
            "kind": "drawing",
            "file": file,
            "width": width,
            "alt": printable(item.label),
            "label": _runs(item.label),
        }

    def item(each: Item) -> dict[str, Any]:
        if isinstance(each, Table):
            rows = [[*map(_runs, row)] for row in each.rows]
            return {"kind": "table", "title": _runs(each.title), "columns": [*map(_runs, each.columns)], "rows": rows,
                    "numbers": [*each.numbers]}  # fmt: skip
        if isinstance(each, Steps):
            return {"kind": "steps", "rows": [*map(step, each.rows)]}
        if isinstance(each, Drawing):
            return drawing(each)
        if isinstance(each, Listing):
            return {"kind": "listing", "text": "\n".join(map(printable, each.text.split("\n")))}
        marks = {"answers": each.answers, "fails": each.fails, "is_open": each.is_open}
        return {"kind": "sentence", "runs": _runs(each.text), **marks}

    say = sheet.language
    content = {
        "language": say.key, "heading": printable(sheet.heading), "running": printable(sheet.running),
        "subtitle": printable(sheet.subtitle),
        "about": [[printable(name), printable(text)] for name, text in sheet.about.items()],
        "signed": [*map(say, sheet.signature)], "contents": say("Contents"), "logo-name": say("Logo"), "logo": None,
        "parts": _parts(sheet, sheet.parts, item),
    }  # fmt: skip
    if sheet.logo:
        kind, _, data = sheet.logo.partition(";base64,")
        content["logo"] = name = f"logo.{kind.rpartition('/')[2].removesuffix('+xml')}"
        pictures[name] = base64.b64decode(data)
    layout = files("rocking_cli") / "documents" / "templates" / LAYOUT
    return {LAYOUT: layout.read_bytes(), "sheet.json": json_text(content).encode(), **pictures}


def _parts(sheet: Sheet, parts: Sequence[SheetPart], item: Callable[[Item], dict[str, Any]]) -> list[dict[str, Any]]:
    return [
        {"own_page": each.key in sheet.own_pages, "heading": _runs(each.heading), "items": [*map(item, each.items)],
         "parts": _parts(sheet, each.parts, item)}
        for each in parts
    ]  # fmt: skip


def _runs(text: str) -> list[tuple[str, str]]:
    return [*runs(printable(text))]


def _formula(text: str) -> dict[str, Any]:
    """Return a formula as trees, or what is no formula as text with sub- and superscripts."""
    try:
        return {"rows": pieces(printable(text))}
    except Unreadable:
        return {"rows": None, "runs": _runs(text)}

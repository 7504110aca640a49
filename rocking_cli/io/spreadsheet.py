"""Tables written by spreadsheets: as text, CSV with commas, semicolons or tabs, and as sheets (.xlsx, .xls, .ods).

Text is in UTF-8, UTF-16 or Windows-1252. Sheets are read by python-calamine, an optional package.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from rocking_cli.errors import InputError, Problem
from rocking_cli.io.files import read_bytes
from rocking_cli.text import cut, one_line

MAX_BYTES = 100_000_000  # a million rows of ten columns take half of it
SEPARATORS = ",;\t"
DECIMAL_COMMA = re.compile(r"[-+]?\d*,\d+(?:[eE][-+]?\d+)?\s*(?:[^\d\s,.;][^,;]*)?", re.ASCII)
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?", re.ASCII)
THOUSANDS = re.compile(r"[-+]?\d{1,3}(\.\d{3})+", re.ASCII)
_BRACKETS = re.compile(r"(.*?)\s*(?:\[([^\]]*)\]|\(([^)]*)\))\s*", re.DOTALL)
_DAMAGED_UTF8 = re.compile(rb"\xc3[\x80-\xbf]")  # accented letters in UTF-8 beside bytes that are not UTF-8
_CONTROL = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f]")
_LINE_END = re.compile("\r\n|\r|\n")


@dataclass(frozen=True)
class Row:
    """A row that is not blank.

    Parameters
    ----------
    line : int
        Line of the file in which the row begins, from 1.
    cells : tuple of str
        A cell for each heading, without outer blanks; cells missing in the file are empty.
    short : bool
        Whether cells are missing in the file.
    too_many : str or None
        Content beyond the last heading, if any.
    """

    line: int
    cells: tuple[str, ...]
    short: bool = False
    too_many: str | None = None


@dataclass(frozen=True)
class Spreadsheet:
    """A table of text.

    Parameters
    ----------
    file : str
        Name of the file in messages.
    line : int
        Line of the headings.
    headings : tuple of str
        Headings without repetition; an empty one heads an empty column.
    rows : tuple of Row
        Rows that are not blank.
    decimal_comma : bool
        Whether numbers may have decimal commas; not if commas separate the cells.
    separator : str
        What separates the cells.
    encoding : str
        Encoding of the file: "UTF-8", "UTF-16" or "Windows-1252".
    unread : tuple of str
        Names of the other sheets of a spreadsheet that have cells.
    """

    file: str
    line: int
    headings: tuple[str, ...]
    rows: tuple[Row, ...]
    decimal_comma: bool
    separator: str = ","
    encoding: str = "UTF-8"
    unread: tuple[str, ...] = ()

    @property
    def columns(self) -> dict[int, str]:
        """Headings of the columns by their places; one without a heading but with cells has its number instead."""
        whole = enumerate(self.headings)
        named = {k: heading or f"column {k + 1}" for k, heading in whole}
        return {k: name for k, name in named.items() if self.headings[k] or any(row.cells[k] for row in self.rows)}

    def number(self, cell: str) -> str | None:
        """Return a cell that is a number alone, with a decimal point; None for other cells, and ambiguous ones."""
        if self.decimal_comma and THOUSANDS.fullmatch(cell):
            return None
        plain = cell.replace(",", ".") if self.decimal_comma else cell
        return plain if NUMBER.fullmatch(plain) else None


def unit_in(heading: str, units: Collection[str]) -> tuple[str, str]:
    """Return the name in a heading and its unit, empty if it gives none: `peak [deg]`, `peak (deg)` or `peak_deg`.

    What follows an underscore is a unit only if it is one of `units`.
    """
    if match := _BRACKETS.fullmatch(heading):
        return match[1], (match[2] or match[3] or "").strip()
    name, _, unit = heading.rpartition("_")
    return (name, unit) if name and unit in units else (heading, "")


def read_sheet(path: Path) -> Spreadsheet:
    """Return the table of a file. Raises `InputError` if it has no table, no headings, or a heading twice."""
    return parse_sheet(read_bytes(path, "table", MAX_BYTES), str(path))


def parse_sheet(raw: bytes, file: str) -> Spreadsheet:
    """Return the table in the content of a file; `file` is its name in messages. Raises as `read_sheet`."""
    if raw.startswith(SPREADSHEETS):
        return _of_book(raw, file)
    (text, encoding), skipped = decoded(raw, file), 0
    if declared := re.match(r"(?i)\s*\"?sep=(.)\"?\r?\n", text):  # some spreadsheets declare their separator
        text, skipped = text[declared.end() :], declared[0].count("\n")
    first = next((line for line in _LINE_END.split(text[:100_000]) if line.strip(" \t,;")), "")
    bare = re.sub(r'"[^"]*"|\[[^\]]*\]', "", first)
    separator = declared[1] if declared else max(SEPARATORS, key=bare.count)
    return _table(_cells(text, separator, file, skipped), file, separator, encoding)


def _of_book(raw: bytes, file: str) -> Spreadsheet:
    """Return the first sheet of a spreadsheet that is not empty; if there are several, its name is that of the file."""
    sheets = _sheets(raw, file)
    name, rows = next(iter(sheets.items()), ("", []))
    typed = (cell for row in rows for cell in row if isinstance(cell, str))
    sign = "," if _has_commas(typed) else "."  # numbers get the sign of those typed as text
    cells = [
        [_text(cell).replace(".", sign) if isinstance(cell, float) else _text(cell) for cell in row] for row in rows
    ]
    lines = ((k, row) for k, row in enumerate(cells, 1) if any(row))
    table = _table(lines, f"{file}, {one_line(name)}" if len(sheets) > 1 else file, "\t", "UTF-8")
    return replace(table, unread=tuple(sheets)[1:])


def _table(lines: Iterator[tuple[int, list[str]]], file: str, separator: str, encoding: str) -> Spreadsheet:
    """Return a table of its rows that are not blank, each with its line, of which the first has the headings."""
    try:
        line, headings = next(lines)
    except StopIteration:
        raise InputError(Problem("the table is empty", file, hint="its first row has the headings")) from None
    while headings and not headings[-1]:
        headings = headings[:-1]
    _check_headings(headings, file, line)
    rows = tuple(_row(number, cells, len(headings)) for number, cells in lines)
    comma = separator != "," and _has_commas(cell for row in rows for cell in row.cells)
    return Spreadsheet(file, line, tuple(headings), rows, comma, separator, encoding)


def _has_commas(cells: Iterable[str]) -> bool:
    """Return whether a cell is a number with a decimal comma, or a list of such numbers."""
    parts = (part for cell in cells if "," in cell for part in cell.strip("[]").split(";"))
    return any(DECIMAL_COMMA.fullmatch(part.strip()) for part in parts)


def decoded(raw: bytes, file: str) -> tuple[str, str]:
    """Return the text of a file and its encoding. Raises `InputError` if it is not text."""
    encoding = "UTF-16" if raw[:2] in (b"\xff\xfe", b"\xfe\xff") else "UTF-8"
    try:
        text = raw.decode("utf-8-sig" if encoding == "UTF-8" else encoding)
    except UnicodeDecodeError as error:
        if encoding == "UTF-8" and (windows := _windows_text(raw)) is not None:
            return windows, "Windows-1252"
        line = raw[: error.start].count(b"\n") + 1
        hint = "save the table as `CSV UTF-8`"
        raise InputError(Problem("not UTF-8 text", file, line, hint=hint)) from None
    if "\0" in text:
        raise InputError(Problem("this is not a table: it is binary", file, hint="save the sheet as CSV"))
    return text, encoding


def _windows_text(raw: bytes) -> str | None:
    """Return a text in Windows-1252, in which spreadsheets write CSV unless told otherwise; None if it is not one."""
    try:
        text = raw.decode("cp1252")
    except UnicodeDecodeError:
        return None
    return None if _DAMAGED_UTF8.search(raw) or _CONTROL.search(text) else text


def _cells(text: str, separator: str, file: str, skipped: int) -> Iterator[tuple[int, list[str]]]:
    """Yield the line in which each row begins, and its cells, without blank rows."""
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=separator, strict=True)
    while True:
        line = reader.line_num + 1 + skipped
        try:
            cells = [cell.strip() for cell in next(reader)]
        except StopIteration:
            return
        except csv.Error as error:
            hint = "a quote that opens a cell must close it, and a quote within is written twice"
            raise InputError(
                Problem(f"the row that starts here is not valid CSV: {error}", file, line, hint=hint)
            ) from None
        if any(cells):
            yield line, cells


def _check_headings(headings: Sequence[str], file: str, line: int) -> None:
    seen: dict[str, int] = {}
    problems = []
    for k, heading in enumerate(headings):
        if heading and heading in seen:
            message = f"is the heading of two columns, number {seen[heading] + 1} and {k + 1}"
            problems.append(Problem(message, file, line, field=cut(one_line(heading)), hint="take one of them away"))
        seen.setdefault(heading, k)
    if problems:
        raise InputError(*problems)


def _row(line: int, cells: list[str], count: int) -> Row:
    beyond = [cell for cell in cells[count:] if cell]
    kept = tuple(cells[:count]) + ("",) * (count - len(cells))
    return Row(line, kept, len(cells) < count, beyond[0] if beyond else None)


OLE = b"\xd0\xcf\x11\xe0"
"""First bytes of a spreadsheet of the older kind (.xls); the others are zip archives."""
SPREADSHEETS = (b"PK\x03\x04", OLE)


def sheets_of(data: bytes, file: str) -> dict[str, list[list[str]]]:
    """Return the rows of cells of each sheet that is not empty, without the empty columns at its left.

    Raises `InputError` if python-calamine is not installed or cannot read the spreadsheet.
    """
    sheets = _sheets(data, file).items()
    return {name: [[one_line(_text(cell)) for cell in row] for row in rows] for name, rows in sheets}


def _text(cell: object) -> str:
    """Return a cell as text, numbers as a CSV file has them: 300 for 300.0."""
    return repr(cell).removesuffix(".0") if isinstance(cell, float) else str(cell).strip()


def _sheets(data: bytes, file: str) -> dict[str, list[list[Any]]]:
    """Return the rows of each sheet, see `sheets_of`; a cell merged over several rows has its value in each of them."""
    try:
        from python_calamine import CalamineError, CalamineWorkbook
    except ImportError:
        hint = "pip install 'rocking-cli[spreadsheet]', or save the sheet with the table as CSV, and give that"
        raise InputError(Problem("is a spreadsheet, which needs another package", file, hint=hint)) from None
    try:
        book = CalamineWorkbook.from_filelike(io.BytesIO(data))
        sheets = {name: book.get_sheet_by_name(name) for name in book.sheet_names}
        read = {name: sheet.to_python(skip_empty_area=False) for name, sheet in sheets.items()}
    except CalamineError as error:
        raise InputError(Problem(f"the spreadsheet cannot be read: {error}", file)) from None
    by_name = {}
    for name, rows in read.items():
        for (top, k), (bottom, _) in sheets[name].merged_cell_ranges or ():
            for row in rows[top + 1 : bottom + 1]:
                row[k] = rows[top][k] if any(cell != "" for cell in row) else ""
        left = min((k for row in rows for k, cell in enumerate(row) if _text(cell)), default=None)
        if left is not None:
            by_name[name] = [row[left:] for row in rows]
    return by_name

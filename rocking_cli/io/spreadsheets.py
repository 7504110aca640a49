"""Sheets of a spreadsheet (.xlsx, .xls, .ods), which python-calamine reads, an optional package."""

from __future__ import annotations

import io

from rocking_cli.errors import InputError, Problem
from rocking_cli.text import one_line

OLE = b"\xd0\xcf\x11\xe0"
"""First bytes of a spreadsheet of the older kind (.xls); the others are zip archives."""


def sheets_of(data: bytes, file: str) -> dict[str, list[list[str]]]:
    """Return the rows of cells of each sheet that is not empty, without the empty columns at its left.

    Raises `InputError` if python-calamine is not installed or cannot read the spreadsheet.
    """
    try:
        from python_calamine import CalamineError, CalamineWorkbook
    except ImportError:
        hint = "pip install 'rocking-cli[spreadsheet]', or save the sheet with the table as CSV, and give that"
        raise InputError(Problem("is a spreadsheet, which needs another package", file, hint=hint)) from None
    try:
        book = CalamineWorkbook.from_filelike(io.BytesIO(data))
        sheets = {name: book.get_sheet_by_name(name).to_python(skip_empty_area=False) for name in book.sheet_names}
    except CalamineError as error:
        raise InputError(Problem(f"the spreadsheet cannot be read: {error}", file)) from None
    by_name = {}
    for name, rows in sheets.items():
        texts = [[str(cell) if isinstance(cell, float) else one_line(str(cell)) for cell in row] for row in rows]
        left = min((k for row in texts for k, cell in enumerate(row) if cell), default=None)
        if left is not None:
            by_name[name] = [row[left:] for row in texts]
    return by_name

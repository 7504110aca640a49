"""PEER AT2: a few header lines with the number of points and the interval, then several values per line."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import NOT_SAID, GroundMotion
from rocking_cli.excitation.records import formats
from rocking_cli.excitation.records.layout import CUT, FIRST_ROW, aligned, lines_of, whole_number
from rocking_cli.excitation.records.lines import PrintedRows, split_numbers
from rocking_cli.excitation.records.record_units import Asked
from rocking_cli.excitation.records.statements import of_peer
from rocking_cli.excitation.records.text import check_interval, numbers_in, only_channel, usable
from rocking_cli.text import regex

_FLOAT = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[EeDd][+-]?\d+)?"
_NPTS = regex(r"\bNPTS\s*=\s*(\d+)", re.IGNORECASE)
_DT = regex(rf"\bDT\s*=\s*({_FLOAT})", re.IGNORECASE)
_OLD_STYLE = regex(rf"^\s*(\d+)[\s,]+({_FLOAT})[\s,]+NPTS\s*,\s*DT\b", re.IGNORECASE)
_SIGNATURE = regex(r"^\s*PEER\b.*\bDATABASE\b", re.IGNORECASE)
_HEADER_LINES = 30  # longest header; four lines are usual


@dataclass(frozen=True)
class _PeerHeader:
    """Content of the header: number of points, interval [s], their line numbers, index of the first data line."""

    npts: int
    dt: float
    npts_line: int
    dt_line: int
    data: int


def read(text: str, file: str, asked: Asked) -> GroundMotion:
    """Read a PEER AT2 file; see `formats.Reader.read`."""
    only_channel(file, asked.channel)
    lines = lines_of(text)
    header = _header(file, lines)
    unit, size = asked.unit(file, list(enumerate(lines[: header.data], start=1)))
    check_interval(file, header.dt_line, header.dt, asked.dt)
    values = np.concatenate([_page_values(file, first, page) for first, page in lines.pages(header.data)])
    rows = PrintedRows(lines, header.data, lambda line: split_numbers(line) if _plain(line) else [])
    remarks = aligned(file, rows)
    if len(values) != header.npts:
        message = f"the header says NPTS = {header.npts}, but the file has {len(values)} values"
        raise InputError(Problem(message, file=file, line=header.npts_line, hint=f"{CUT}, or correct NPTS"))
    if header.npts < 2:
        message = f"a record needs at least two samples, this has {header.npts}"
        raise InputError(Problem(message, file=file, line=header.npts_line))
    # Only in files with the title of the database is the second line known to be the origin.
    origin = of_peer(lines[1]) if len(lines) > 1 and _SIGNATURE.match(lines[0]) else NOT_SAID
    name = Path(file).name
    return GroundMotion(
        name, header.dt, values * size, source_unit=unit, format=formats.peer_at2.TITLE, remarks=remarks, origin=origin
    )


def _header(file: str, lines: Sequence[str]) -> _PeerHeader:
    """Read the number of points and the interval from a header of any length."""
    npts: tuple[str, int] | None = None
    dt: tuple[str, int] | None = None
    for number, line in enumerate(lines[:_HEADER_LINES], start=1):
        if not _plain(line):
            continue
        if old := _OLD_STYLE.match(line):
            npts, dt = (old[1], number), (old[2], number)
        if npts is None and (match := _NPTS.search(line)):
            npts = (match[1], number)
        if dt is None and (match := _DT.search(line)):
            dt = (match[1], number)
        if npts and dt:
            break
    if npts is None or dt is None:
        missing = "number of points (NPTS)" if npts is None else "sample interval (DT)"
        hint = "a PEER AT2 header has a line such as: NPTS=  1991, DT=   .0100 SEC"
        line_number = npts[1] if npts else None
        raise InputError(Problem(f"the header does not state the {missing}", file=file, line=line_number, hint=hint))

    count = whole_number(file, npts[1], lines[npts[1] - 1], npts[0], "number of points", least=0)
    interval = float(dt[0].upper().replace("D", "E"))
    if not (math.isfinite(interval) and interval > 0):
        raise InputError(Problem(f"the sample interval must be positive, DT = {dt[0]}", file=file, line=dt[1]))
    data = max(npts[1], dt[1])
    while data < len(lines) and not FIRST_ROW.match(lines[data]):
        data += 1
    return _PeerHeader(count, interval, npts[1], dt[1], data)


def _page_values(file: str, first: int, page: Sequence[str]) -> Reals:
    """Return the values of the lines from index `first` on; line by line only if there is an error."""
    body = "\n".join(filter(_plain, page))
    if "_" not in body:  # float() would accept 1_000
        try:
            values = np.array([float(token) for token in split_numbers(body.upper().replace("D", "E"))])
        except ValueError:
            pass
        else:
            if usable(values):
                return values
    numbers: list[float] = []
    for number, line in enumerate(page, start=first + 1):
        if _plain(line):
            numbers.extend(numbers_in(file, number, line, split_numbers(line)))
    return np.array(numbers)


def _plain(line: str) -> bool:
    """Return whether a line is not a comment; comments of delimited text may quote the header of its source."""
    return not line.lstrip().startswith(("#", "%"))

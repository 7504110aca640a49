"""COSMOS V0, V1 and V2c (format 1.20): text, integer, real and comment headers that state their lengths; values."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import Doubt, GroundMotion, Origin
from rocking_cli.excitation.records import formats, layout
from rocking_cli.excitation.records.layout import Field, read_head
from rocking_cli.excitation.records.lines import Lines
from rocking_cli.excitation.records.record_units import Asked
from rocking_cli.excitation.records.statements import magnitude, origin, peak_doubts
from rocking_cli.excitation.records.text import numbers_in
from rocking_cli.text import regex

_FIRST_LINE = regex(r"(.*?)\(Format v(\S+) with\s+(\d+) text lines\)", re.I)
_NUMBERS = regex(r"\s*(\d+)\s+(Integer|Real)-header values follow on\s+\d+ lines?[ ,]*Format *=? *(\S+)", re.I)
_COMMENTS = regex(r"\s*(\d+) Comment line", re.I)
# Commas and blanks differ by network: units=cm/sec2(04),Format=(8F10.5) and units=g.     (02)Format=(8f9.6).
_DATA = regex(
    r"\s*(\d+)\s+(\S.*?)\s*pts?\b[ ,]*approx\.?\s+(\S+?)\s*secs?\b[ ,]*"
    r"units? *[=:] *([^(,]*?)[ .]*(?:\( *\d+ *\))?[ ,]*Format *[=:]? *(\(.*?\))",
    re.I,
)
_WIDTH = regex(r"\( *\d*[A-Z](\d+)(?:\.\d+)?(?:E\d*)? *\)", re.I)
_MAX_LINE_CHARACTERS = 300  # the format has 80 characters in a line
_CODE = regex(r"units *=[^(,]*\((\d{1,3})\)", re.I)
_RAW = regex(r"(?:raw|uncor\w*|counts?)\b", re.I)  # numbers of a digitiser, in V0
_UNIT_CODES = {2: "g", 4: "cm/s2"}
_END = regex(r"End-of-data for Chan *(\S+)", re.I)
# Places, from 1, of the interval of processed data [ms] and of raw records [s]; the latter is for unprocessed data.
_DT_MS, _DT_RAW = 62, 34
_PEAK_PLACE, _PEAK_TIME_PLACE = 64, 65  # places of the peak value and its time [s]
_DISTANCE_PLACE = 17  # place of the epicentral distance [km]
_UNSET = -999
_FIELDS = {
    "azimuth": Field(regex(r"^Sta Chan?\.?:? *\S+: *(.*?) *\(", re.I)),
    # Only a line with a year describes an earthquake.
    "event": Field(regex(r"^\s*(?:Rec(?:or)?d of )?(.*\b(?:19|20)\d\d\b.*)", re.I), line=2),
    # The station code, and the name that follows the agency.
    "station": Field(regex(r"^Statn No: *\S+ +Code: *(\S+)(?: +[A-Z]{2,5} +(\S.*))?")),
    "hypocentre": Field(regex(r"^(Hypocenter.*)")),
}
_TEXT_LINES, _HEADER_VALUES, _COMMENT_LINES = 1000, 10_000, 100_000  # limits that no header exceeds


@dataclass(frozen=True)
class _Headers:
    """Content of the headers of a channel: name, real numbers and their first line, first data line, and origin."""

    name: str
    reals: Reals
    reals_line: int
    data: int
    origin: Origin


def read(text: str, file: str, asked: Asked) -> GroundMotion:
    """Read a COSMOS V0, V1 or V2c file; see `formats.Reader.read`."""
    lines = layout.lines_of(text)
    channels: list[layout.Channel] = []
    others: list[str] = []
    index = 0
    while index < len(lines):
        if not lines[index].strip() or lines[index].startswith(("/&", "End-of-data")):
            index += 1
            continue
        headers = _headers(file, lines, index)
        index = headers.data
        while index == headers.data or (index < len(lines) and _announced(lines[index])):
            content, index = _history(file, lines, headers, index, asked)
            if isinstance(content, layout.Channel):
                channels.append(content)
            else:
                others.append(content)
    if not channels:
        raise layout.lacking(file, asked.wanted, others)
    return layout.choose(file, formats.cosmos.TITLE, channels, asked)


def _headers(file: str, lines: Lines, start: int) -> _Headers:
    """Read the headers of a channel, from line index `start` on."""
    first = _FIRST_LINE.match(lines[start])
    if first is None:
        message = "a channel must begin here, with a line that says (Format v01.20 with 13 text lines)"
        raise InputError(Problem(message, file, start + 1, excerpt=lines[start].strip()[:100], hint=layout.CUT))
    count = layout.whole_number(file, start + 1, lines[start], first[3], "number of text lines", most=_TEXT_LINES)
    head, index = read_head(file, lines, _FIELDS, count, start), start + count
    reals, reals_line = np.array([]), start + 1
    for kind in ("integer", "real"):
        match = _NUMBERS.match(lines[index]) if index < len(lines) else None
        if match is None or match[2].lower() != kind:
            message = f"the line that announces the {kind} header must be here"
            hint = "the number of text lines may be wrong: download the file again"
            raise InputError(Problem(message, file, min(index + 1, len(lines)), hint=hint))
        reals_line = index + 1
        line = lines[index]
        count = layout.whole_number(file, reals_line, line, match[1], f"number of {kind} values", most=_HEADER_VALUES)
        block = layout.RecordBlock(reals_line, count, _width(file, reals_line, match[3]), reals_line)
        reals, index, _ = layout.fixed_width(file, lines, block, last=False)
    if index < len(lines) and (match := _COMMENTS.match(lines[index])):
        what = "number of comment lines"
        index += 1 + layout.whole_number(file, index + 1, lines[index], match[1], what, least=0, most=_COMMENT_LINES)
    code, name = head["station"].groups if "station" in head.items else (None, None)
    distance = reals[_DISTANCE_PLACE - 1] if reals.size >= _DISTANCE_PLACE else None
    where = origin(head.text("event"), name or code, magnitude(head.text("hypocentre") or ""), distance)
    return _Headers(head.text("azimuth") or "", reals, reals_line, index, where)


def _history(file: str, lines: Lines, headers: _Headers, index: int, asked: Asked) -> tuple[layout.Channel | str, int]:
    """Read the values announced at line index `index`, and return the index after them.

    If they are not of the requested quantity, the name of theirs is returned in place of the channel.
    """
    line_number = index + 1
    line = lines[index] if index < len(lines) else ""
    match = _announced(line)
    if match is None:
        message = "the line that announces the values, such as 7000 acceleration pts, must be here"
        hint = "the number of comment lines may be wrong: download the file again"
        if "pts" in line and "format" in line.lower():
            message = "the line that announces the values is not understood"
            hint = "it must be such as 7000 acceleration pts, approx 70 secs, units=cm/sec2(04),Format=(8F10.5)"
        raise InputError(Problem(message, file, min(line_number, len(lines)), excerpt=line.strip()[:100], hint=hint))
    count = layout.whole_number(file, line_number, line, match[1], "number of points", least=2)
    block = layout.RecordBlock(line_number, count, _width(file, line_number, match[5]), line_number)
    values, end, remarks = layout.fixed_width(file, lines, block)
    if layout.quantity_called(match[2]) != asked.wanted.quantity and not (asked.wanted.raw and _RAW.match(match[2])):
        return match[2], end
    unit, size = layout.stated_unit(file, line_number, match[4].strip(), asked)
    code = _CODE.search(line)
    coded = _UNIT_CODES.get(int(code[1])) if code else None
    if coded is not None and coded != unit and asked.wanted.quantity == "acceleration":
        message = f"the header says the unit is {unit}, but its code ({code[1] if code else ''}) stands for {coded}"
        hint = "one of the two is damaged: download the file again"
        raise InputError(Problem(message, file, line_number, excerpt=line.strip()[:100], hint=hint))
    (length,) = numbers_in(file, line_number, line, [match[3]])
    interval = _interval(file, headers, count, length)
    mark = _END.match(lines[end]) if end < len(lines) else None
    name = mark[1] if mark and not mark[1].isdecimal() else headers.name
    if not asked.wanted.raw:  # the peak of V0 may be one of accelerations
        remarks += _peak(headers, values, interval, unit)
    return layout.Channel(
        name, interval, values * size, unit, headers.reals_line, remarks=remarks, origin=headers.origin
    ), end


def _peak(headers: _Headers, values: Reals, dt: float, unit: str) -> tuple[Doubt, ...]:
    """Return a doubt if the largest value differs from that in the header."""
    if headers.reals.size < _PEAK_TIME_PLACE or headers.reals[_PEAK_PLACE - 1] == _UNSET:
        return ()
    peak, time = headers.reals[_PEAK_PLACE - 1], headers.reals[_PEAK_TIME_PLACE - 1]
    stated = "" if time == _UNSET else f"{time:.6f}"
    return peak_doubts(values, dt, unit, headers.reals_line, f"{peak:.6f}", stated)


def _announced(line: str) -> re.Match[str] | None:
    """Match a line that announces values; None for other lines, and for long ones, which would take long to search."""
    return _DATA.match(" ".join(line.split())) if len(line) < _MAX_LINE_CHARACTERS else None


def _interval(file: str, headers: _Headers, count: int, length: float) -> float:
    """Return the sampling interval of the header [s] that agrees with the duration of the history [s]."""
    places = ((_DT_MS, 0.001), (_DT_RAW, 1.0))
    stated = [headers.reals[place - 1] * size for place, size in places if place <= headers.reals.size]
    for candidate in stated:
        # The length is rounded to a second; files compute it from the number of intervals, or of samples.
        if candidate > 0 and abs(candidate * count - length) <= 1 + 2 * candidate:
            return float(candidate)
    intervals = " and ".join(f"{candidate:g} s" for candidate in stated if candidate > 0) or "nothing"
    message = (
        f"the sample interval is unclear: the real header gives {intervals}, neither of which makes "
        f"{count} points of {length:g} s"
    )
    raise InputError(Problem(message, file, headers.reals_line, hint=layout.CUT))


def _width(file: str, line_number: int, form: str) -> int:
    """Return the number of characters per number in a Fortran format such as (8F10.5)."""
    match = _WIDTH.match(form)
    if match is None:
        raise InputError(Problem(f"a format such as (8F10.5) is needed, this is {form}", file, line_number))
    return layout.column_width(file, line_number, form, match[1])

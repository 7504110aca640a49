"""CSMIP V1 (CDMG, California): consecutive uncorrected channels, digitised from film or evenly sampled."""

from __future__ import annotations

import re
from dataclasses import replace

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.records import formats, layout
from rocking_cli.excitation.records.header_fields import Field, read_head
from rocking_cli.excitation.records.lines import Lines
from rocking_cli.excitation.records.origins import length_doubts, of_csmip
from rocking_cli.excitation.records.record_units import Asked
from rocking_cli.text import regex

_FIRST_LINE = regex(r"\s*UNCORRECTED ACCELEROGRAM DATA\b", re.I)
_FIELDS = {
    "channel": Field(regex(r"^\s*CHAN(?:NEL)? +\d+: *(.*?) *(?:\(STA CHN.*)?$", re.I)),
    "length": Field(regex(r"RECORD LENGTH *= *(\S+) *SEC", re.I)),
}
_OF_FILM = {
    "count": Field(regex(r"NO\. OF POINTS *= *(\d+)", re.I), "number of points", " (NO. OF POINTS)"),
    "unit": Field(
        regex(r"UNITS OF UNCOR \w+ (?:ARE|IS) (?:SEC AND )?(.*?) *\.? *(?: {2,}.*)?$", re.I),
        "unit",
        " (UNITS OF UNCOR ACCEL ARE SEC AND ...)",
    ),
}
_LENGTH_TOLERANCE, _LENGTH_TOLERANCE_SHARE = 1.0, 0.02  # seconds, and share of the length of the record
# Lines before samples at a constant interval: number of points, quantity, interval or rate, unit and format.
_EVEN_HEADERS = (
    regex(r" *(\d+) +POINTS OF (\w+) +DATA EQUALLY SPACED AT +(?P<dt>\S+) *SEC\b\.?(.*)", re.I),
    regex(r" *(\d+) +(\w+) +POINTS AT +(?P<rate>\S+) +PTS/SEC\b(.*)", re.I),
)
_STATED = regex(r"\bunits(?: of|:) *(.*?) *\.? *(?:\)|format|$)", re.I)
_FORMAT = regex(r"\b\d+F(\d+)\.\d+", re.I)
_TEXT_LINES = 13
_INTEGERS, _REALS = (100, 5), (50, 10)  # count, and characters per number
_PAIRS_WIDTH, _VALUES_WIDTH = 7, 9  # characters per number: 10F7.3 for five points a line, and by default 8F9.6


def read(text: str, file: str, asked: Asked) -> GroundMotion:
    """Read a CSMIP V1 file; see `registry.Reader.read`.

    The points of a digitised film are interpolated to a constant interval by `layout.straight_lines`.
    """
    lines = layout.lines_of(text)
    channels: list[layout.Channel] = []
    start = 0
    while start < len(lines):
        if lines[start].strip() and not lines[start].startswith("/&"):
            head = lines[start : start + _TEXT_LINES]
            part, start = _channel(file, lines, start, asked)
            channels.append(replace(part, origin=of_csmip(head)))
        else:
            start += 1
    return layout.choose(file, formats.csmip_v1.TITLE, channels, asked)


def _channel(file: str, lines: Lines, start: int, asked: Asked) -> tuple[layout.Channel, int]:
    """Read the channel that begins at line index `start`; return it and the index after it."""
    if not _FIRST_LINE.match(lines[start]):
        message = "a channel must begin with the line UNCORRECTED ACCELEROGRAM DATA here"
        raise InputError(Problem(message, file, start + 1, excerpt=lines[start].strip()[:100], hint=layout.CUT))
    head = read_head(file, lines, _FIELDS, _TEXT_LINES, start)
    name = head.text("channel") or ""
    index = start + _TEXT_LINES
    for size, width in (_INTEGERS, _REALS):
        _, index, _ = layout.fixed_width(file, lines, layout.RecordBlock(index, size, width, start + 1), last=False)
    line = lines[index] if index < len(lines) else ""
    for pattern in _EVEN_HEADERS:
        if match := pattern.match(line):
            channel, end = _evenly(file, lines, index, match, name, asked)
            if length := head.items.get("length"):
                lasting = channel.acceleration.size * channel.dt
                tolerance = max(_LENGTH_TOLERANCE, _LENGTH_TOLERANCE_SHARE * lasting)
                doubts = length_doubts(lasting, length.line_number, length.groups[0], tolerance)
                channel = replace(channel, remarks=channel.remarks + doubts)
            return channel, end
    return _film(file, lines, start, index, name, asked)


def _evenly(
    file: str, lines: Lines, index: int, match: re.Match[str], name: str, asked: Asked
) -> tuple[layout.Channel, int]:
    """Read samples at a constant interval, announced at line index `index`; return them and the index after them."""
    line_number, line = index + 1, lines[index]
    if not match[2].lower().startswith("accel"):
        message = f"the values are {match[2]} data, not accelerations"
        raise InputError(Problem(message, file, line_number, excerpt=line.strip()[:100]))
    count = layout.whole_number(file, line_number, line, match[1], "number of points", least=2)
    if "dt" in match.re.groupindex:
        interval = layout.number(file, line_number, line, match["dt"], "sample interval")
    else:
        interval = 1 / layout.number(file, line_number, line, match["rate"], "number of points per second")
    stated, form = _STATED.search(match[4]), _FORMAT.search(match[4])
    unit, size = layout.old_unit(file, line_number, stated[1] if stated else "", asked)
    width = layout.column_width(file, line_number, line, form[1]) if form else _VALUES_WIDTH
    values, end, remarks = layout.fixed_width(file, lines, layout.RecordBlock(line_number, count, width, line_number))
    return layout.Channel(name, interval, values * size, unit, line_number, remarks=remarks), end


def _film(file: str, lines: Lines, start: int, index: int, name: str, asked: Asked) -> tuple[layout.Channel, int]:
    """Read pairs of time and acceleration from line index `index` on; return them and the index after them."""
    head = read_head(file, lines, _OF_FILM, _TEXT_LINES, start)
    unit, size = layout.old_unit(file, head["unit"].line_number, head["unit"].groups[0], asked)
    block = layout.RecordBlock(index, 2 * head.count, _PAIRS_WIDTH, head["count"].line_number)
    pairs, end, remarks = layout.fixed_width(file, lines, block)
    interval, values, points = layout.straight_lines(file, pairs, f"lines {index + 1} to {end}")
    return layout.Channel(name, interval, values * size, unit, points=points, remarks=remarks), end

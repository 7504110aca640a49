"""USC V1 (Volume I, also of Caltech): an uncorrected film record, pairs of time and acceleration at uneven times."""

from __future__ import annotations

import re
from collections.abc import Sequence

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.records.layout import (
    Channel,
    RecordBlock,
    choose,
    fixed_width,
    in_si,
    lines_of,
    old_unit,
    straight_lines,
    whole_number,
)
from rocking_cli.excitation.records.origins import first_match, origin
from rocking_cli.excitation.records.stated import length_doubts
from rocking_cli.patterns import regex

TITLE = "USC V1"
SIGN = "a first line with UNCORRECTED ACCELEROGRAM DATA OF VOLUME I"

_FIRST = regex(r"FILE\s+\d+ OF UNCORRECTED ACCELEROGRAM DATA OF VOLUME I\b")
_COUNT = regex(r"NO\. OF POINTS *= *(\d+)")
_DURATION = regex(r"DURATION *= *(\S+) *SEC")
_UNITS = regex(r"UNITS ARE SEC AND (.*?)(?:\s+\d+|\s{2,}.*)?$")
_COMPONENT = regex(r"COMP\s+(\S+)")
_EVENT = regex(r"^(.*\bEARTHQUAKE\b.*?)(?:\s+\d+)?\s*$")
_STATION = regex(r"^STATION (USC# *\d+)")
_INTEGERS, _REALS = 100, 50


def sniff(text: str) -> bool:
    """Return whether the first line is that of an uncorrected record of Volume I."""
    return _FIRST.match(text[:200]) is not None


def read(
    text: str, file: str, *, dt: float | None = None, units: str | None = None, channel: str | None = None
) -> GroundMotion:
    """Read a USC V1 file; arguments, result and errors are those of `registry.Reader.read`.

    The record is linear between its points, whose times are whole milliseconds. The motion has the largest constant
    interval that includes all of these times: it has more samples than the file has points, but is not an
    approximation.
    """
    lines = lines_of(text)
    count_line, count_text = _find(file, lines, _COUNT, "number of points (NO. OF POINTS)")
    unit_line, spelling = _find(file, lines, _UNITS, "unit (UNITS ARE SEC AND ...)")
    count = whole_number(file, count_line, lines[count_line - 1], count_text, "number of points", least=2)
    unit = old_unit(file, unit_line, spelling, units)

    start = next((index for index, line in enumerate(lines) if not re.search(r"[A-Za-z]", line)), len(lines))
    for size, width in ((_INTEGERS, 5), (_REALS, 10)):
        _, start, _ = fixed_width(file, lines, RecordBlock(start, size, width, 1), last=False)
    pairs, end, remarks = fixed_width(file, lines, RecordBlock(start, 2 * count, 7, count_line, margin=1))
    step, values, points = straight_lines(file, pairs, f"lines {start + 1} to {end}")
    acceleration = in_si(values, unit)
    if match := _DURATION.search(lines[count_line - 1]):
        remarks += length_doubts(float(pairs[-2]), count_line, match[1], 0.0)
    name = next((match[1] for line in lines[:15] if (match := _COMPONENT.match(line))), "")
    where = origin(first_match(_EVENT, lines[7:8]), first_match(_STATION, lines[:15]))
    found = Channel(name, step, acceleration, unit, points=points, remarks=remarks, origin=where)
    return choose(file, TITLE, [found], channel, dt)


def _find(file: str, lines: Sequence[str], pattern: re.Pattern[str], what: str) -> tuple[int, str]:
    """Return line number and value of an item in the text header."""
    for line_number, line in enumerate(lines[:30], start=1):
        if match := pattern.search(line.rstrip()):
            return line_number, match[1]
    raise InputError(Problem(f"the header does not state the {what}", file, 1))

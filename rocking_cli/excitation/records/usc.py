"""USC V1 (Volume I, also of Caltech): an uncorrected film record, pairs of time and acceleration at uneven times."""

from __future__ import annotations

import re

from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.records import formats, layout
from rocking_cli.excitation.records.header_fields import Field, read_head
from rocking_cli.excitation.records.origins import length_doubts
from rocking_cli.excitation.records.record_units import Asked
from rocking_cli.text import regex

_FIELDS = {
    "count": Field(regex(r"NO\. OF POINTS *= *(\d+)"), "number of points", " (NO. OF POINTS)"),
    "unit": Field(regex(r"UNITS ARE SEC AND (.*?)(?:\s+\d+|\s{2,}.*)?$"), "unit", " (UNITS ARE SEC AND ...)"),
    "duration": Field(regex(r"DURATION *= *(\S+) *SEC")),
    "component": Field(regex(r"^COMP\s+(\S+)")),
    "event": Field(regex(r"^(.*\bEARTHQUAKE\b.*?)(?:\s+\d+)?\s*$"), line=8),
    "station": Field(regex(r"^STATION (USC# *\d+)")),
}
_TEXT_LINES = 30  # lines with the items of the header
_INTEGERS, _REALS = 100, 50


def read(text: str, file: str, asked: Asked) -> GroundMotion:
    """Read a USC V1 file; see `registry.Reader.read`.

    The record is linear between its points, whose times are whole milliseconds. The motion has the largest constant
    interval that includes all of these times: it has more samples than the file has points, but is not an
    approximation.
    """
    lines = layout.lines_of(text)
    head = read_head(file, lines, _FIELDS, _TEXT_LINES)
    count, count_line = head.count, head["count"].line_number
    unit, size = layout.old_unit(file, head["unit"].line_number, head["unit"].groups[0], asked)

    start = next((index for index, line in enumerate(lines) if not re.search(r"[A-Za-z]", line)), len(lines))
    for length, width in ((_INTEGERS, 5), (_REALS, 10)):
        _, start, _ = layout.fixed_width(file, lines, layout.RecordBlock(start, length, width, 1), last=False)
    pairs, end, remarks = layout.fixed_width(file, lines, layout.RecordBlock(start, 2 * count, 7, count_line, margin=1))
    layout.check_end(file, lines, end)
    step, values, points = layout.straight_lines(file, pairs, f"lines {start + 1} to {end}")
    if (duration := head.items.get("duration")) and duration.line_number == count_line:
        remarks += length_doubts(float(pairs[-2]), count_line, duration.groups[0], 0.0)
    name = head.text("component") or ""
    only = layout.Channel(name, step, values * size, unit, points=points, remarks=remarks, origin=head.origin)
    return layout.choose(file, formats.usc_v1.TITLE, [only], asked)

"""GeoNet V2A (GNS Science, New Zealand): for each component 16 lines of text, 10 of numbers, and three histories."""

from __future__ import annotations

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.records import layout
from rocking_cli.excitation.records.header_fields import Field, read_head
from rocking_cli.excitation.records.lines import Lines
from rocking_cli.excitation.records.origins import length_doubts, peak_doubts
from rocking_cli.text import regex

TITLE = "GeoNet V2A"
SIGN = "a first line Corrected accelerogram, and Number of points below it"

_TEXT_LINES = 16
_NUMBER_LINES = 10
_WIDTH = 8  # characters per number
_SIZE = regex("[0-9]{1,9}")
_FIRST_LINE = regex(r"Corrected accelerogram\b")
_COUNT = regex(r"Number of points\s+(\d+)")
_FIELDS = {
    "count": Field(_COUNT, "number of points"),
    "dt": Field(regex(r"data at\s+(\S+)\s+sec intervals"), "sample interval"),
    "component": Field(regex(r"Component\s+(\S+)"), "component"),
    "peak": Field(regex(r"Acceleration:\s+peak\s+(\S+)\s+(\S+)"), "unit of the accelerations"),
    "duration": Field(regex(r"Duration\s+(\S+)\s+sec")),
    # The file names no earthquake, so its time stands for it.
    "event": Field(regex(r"^(\d{4} [A-Z][a-z]+ +\d{1,2} +\d{2}:\d{2}:\d{2}(?: UT)?)")),
    "station": Field(regex(r"^Site +(\S+)")),
    "magnitude": Field(regex(r"^Epicentre .*\bM +(\S+)")),
    "distance": Field(regex(r"^Epicentre .*\bDist +(\S+?) *km\b")),
}


def sniff(text: str) -> bool:
    """Return whether the first two lines of the header are those of a corrected GeoNet record."""
    head = text[:5000].expandtabs().split("\n")[:_TEXT_LINES]
    return bool(_FIRST_LINE.match(head[0])) and any(_COUNT.match(line) for line in head)


def read(
    text: str, file: str, *, dt: float | None = None, units: str | None = None, channel: str | None = None
) -> GroundMotion:
    """Read a GeoNet V2A file; arguments, result and errors are those of `registry.Reader.read`."""
    lines = layout.lines_of(text)
    channels = []
    start = 0
    while start < len(lines) and lines[start].strip():
        component, start = _component(file, lines, start, units)
        channels.append(component)
    return layout.choose(file, TITLE, channels, channel, dt)


def _component(file: str, lines: Lines, start: int, units: str | None) -> tuple[layout.Channel, int]:
    """Read one component from line index `start` on; return it and the index after it."""
    if not _FIRST_LINE.match(lines[start]):
        message = "a component must begin with the line Corrected accelerogram here"
        hint = "the file may have been cut or edited, or its number of points is wrong: download it again"
        raise InputError(Problem(message, file, start + 1, excerpt=lines[start].strip()[:100], hint=hint))
    head = read_head(file, lines, _FIELDS, _TEXT_LINES, start)
    unit_line, _, (peak, spelling) = head["peak"]
    unit = layout.stated_unit(file, unit_line, spelling, units)
    interval, npts, count_line = head.number("dt"), head.count, head["count"].line_number

    # The fourth line of numbers has the lengths of the three histories, of which the last two may be absent.
    sizes_line = start + _TEXT_LINES + 3
    sizes = (
        [int(size) for size in lines[sizes_line].split()[3:6] if _SIZE.fullmatch(size)]
        if sizes_line < len(lines)
        else []
    )
    if len(sizes) < 3 or sizes[0] != npts:
        message = f"the numbers of the header do not give the {npts} points of its text, followed by two more counts"
        raise InputError(
            Problem(message, file, sizes_line + 1, hint="the file may have been edited: download it again")
        )
    end = start + _TEXT_LINES + _NUMBER_LINES
    values, end, remarks = layout.fixed_width(
        file, lines, layout.RecordBlock(end, npts, _WIDTH, count_line), last=False
    )
    for size in sizes[1:]:  # skip the velocities and the displacements
        _, end, _ = layout.fixed_width(file, lines, layout.RecordBlock(end, size, _WIDTH, sizes_line + 1), last=False)
    # The time of the peak is not checked, as it excludes the taper before the values.
    remarks += peak_doubts(values, interval, unit, unit_line, peak)
    if (duration := head.items.get("duration")) and duration.line_number == count_line:
        remarks += length_doubts((npts - 1) * interval, count_line, duration.groups[0], interval)
    acceleration, name = layout.in_si(values, unit), head["component"].groups[0]
    return layout.Channel(
        name, interval, acceleration, unit, head["dt"].line_number, remarks=remarks, origin=head.origin
    ), end

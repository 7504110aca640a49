"""GeoNet V2A (GNS Science, New Zealand): for each component 16 lines of text, 10 of numbers, and three histories."""

from __future__ import annotations

import re
from collections.abc import Sequence

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion, Origin
from rocking_cli.excitation.records.layout import (
    Channel,
    RecordBlock,
    choose,
    fixed_width,
    in_si,
    lines_of,
    number,
    stated_unit,
    whole_number,
)
from rocking_cli.excitation.records.lines import Lines
from rocking_cli.excitation.records.origins import first_match, origin
from rocking_cli.excitation.records.stated import length_doubts, peak_doubts
from rocking_cli.patterns import regex

TITLE = "GeoNet V2A"
SIGN = "a first line Corrected accelerogram, and Number of points below it"

_TEXT_LINES = 16
_NUMBER_LINES = 10
_WIDTH = 8
_SIZE = regex("[0-9]{1,9}")
_FIRST = regex(r"Corrected accelerogram\b")
_COUNT = regex(r"Number of points\s+(\d+)")
_DURATION = regex(r"Duration\s+(\S+)\s+sec")
_DT = regex(r"data at\s+(\S+)\s+sec intervals")
_COMPONENT = regex(r"Component\s+(\S+)")
_UNIT = regex(r"Acceleration:\s+peak\s+\S+\s+(\S+)")
_STATION = regex(r"^Site +(\S+)")
_EVENT = regex(r"^(\d{4} [A-Z][a-z]+ +\d{1,2} +\d{2}:\d{2}:\d{2}(?: UT)?)")
_DISTANCE = regex(r"^Epicentre .*\bDist +(\S+?) *km\b")
_MAGNITUDE = regex(r"^Epicentre .*\bM +(\S+)")
_PEAK = regex(r"Acceleration:\s+peak\s+(\S+)")


def sniff(text: str) -> bool:
    """Return whether the first two lines of the header are those of a corrected GeoNet record."""
    head = text[:5000].expandtabs().split("\n")[:_TEXT_LINES]
    return bool(_FIRST.match(head[0])) and any(_COUNT.match(line) for line in head)


def read(
    text: str, file: str, *, dt: float | None = None, units: str | None = None, channel: str | None = None
) -> GroundMotion:
    """Read a GeoNet V2A file; arguments, result and errors are those of `registry.Reader.read`."""
    lines = lines_of(text)
    channels = []
    start = 0
    while start < len(lines) and lines[start].strip():
        found, start = _component(file, lines, start, units)
        channels.append(found)
    return choose(file, TITLE, channels, channel, dt)


def _component(file: str, lines: Lines, start: int, units: str | None) -> tuple[Channel, int]:
    """Read one component from line index `start` on; return it and the index after it."""
    if not _FIRST.match(lines[start]):
        message = "a component must begin with the line Corrected accelerogram here"
        hint = "the file may have been cut or edited, or its number of points is wrong: download it again"
        raise InputError(Problem(message, file, start + 1, excerpt=lines[start].strip()[:100], hint=hint))
    count_line, count = _find(file, lines, start, _COUNT, "number of points")
    dt_line, interval = _find(file, lines, start, _DT, "sample interval")
    _, name = _find(file, lines, start, _COMPONENT, "component")
    unit_line, spelling = _find(file, lines, start, _UNIT, "unit of the accelerations")
    unit = stated_unit(file, unit_line, spelling, units)
    own = number(file, dt_line, lines[dt_line - 1], interval, "sample interval")
    npts = whole_number(file, count_line, lines[count_line - 1], count, "number of points", least=2)

    # The fourth line of numbers says how long each of the three histories is; the last two may be left out.
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
    values, end, remarks = fixed_width(file, lines, RecordBlock(end, npts, _WIDTH, count_line), last=False)
    for size in sizes[1:]:  # velocity and displacement
        _, end, _ = fixed_width(file, lines, RecordBlock(end, size, _WIDTH, sizes_line + 1), last=False)
    if match := _PEAK.search(lines[unit_line - 1]):
        # Not its time: that does not count the taper which was put in front of the values.
        remarks += peak_doubts(values, own, unit, unit_line, match[1])
    if match := _DURATION.search(lines[count_line - 1]):
        remarks += length_doubts((npts - 1) * own, count_line, match[1], own)
    origin = _origin(lines[start : start + _TEXT_LINES])
    return Channel(name, own, in_si(values, unit), unit, dt_line, remarks=remarks, origin=origin), end


def _origin(head: Sequence[str]) -> Origin:
    """Return the origin: the earthquake by its time, as the file has no name, and the site."""
    patterns = (_EVENT, _STATION, _MAGNITUDE, _DISTANCE)
    return origin(*(first_match(pattern, head) for pattern in patterns))


def _find(file: str, lines: Sequence[str], start: int, pattern: re.Pattern[str], what: str) -> tuple[int, str]:
    """Return line number and value of an item in the text header of a component."""
    for line_number, line in enumerate(lines[start : start + _TEXT_LINES], start=start + 1):
        if match := pattern.search(line):
            return line_number, match[1]
    raise InputError(Problem(f"the header does not state the {what}", file, start + 1))

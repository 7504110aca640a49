"""CSMIP V2 (CDMG, California): consecutive channels, each with acceleration, velocity and displacement."""

from __future__ import annotations

import math
import re

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.records import csmip_v1, layout
from rocking_cli.excitation.records.origins import of_csmip, peak_doubts
from rocking_cli.text import regex

TITLE = "CSMIP V2"
SIGN = "a line such as 3251 POINTS OF ACCEL DATA EQUALLY SPACED AT .020 SEC"

_DATA = regex(r"\s*(\d+) +POINTS OF (ACCEL|VELOC|DISPL)\w* +DATA EQUALLY SPACED AT +(\S+?) *SEC\b(.*)", re.I)
_FIRST_LINE = regex(r"\s*CORRECTED ACCELEROGRAM\b", re.I)
_TEXT_LINES = 25
_UNIT = regex(r"(?:\bunits:|\bin) *([^,()]*?\w)\.? *(?:[,()]|$|format)", re.I)
_FORMAT = regex(r"\b\d+F(\d+)\.\d+", re.I)
_CHANNEL = regex(r"\bCHAN(?:NEL)? +\d+: *(.*\S)", re.I)
_PEAK = regex(r"PEAK ACCELERATION *= *(\S+) +CM/SEC/SEC +AT +(\S+) *SEC", re.I)
_DEFAULT_WIDTH = 10  # characters per number, as in 8F10.3
_SEARCHED_CHARACTERS = 100_000  # characters within which the format is recognised


def sniff(text: str) -> bool:
    """Return whether a line announces a history, in a file that is not an uncorrected record."""
    return not csmip_v1.sniff(text) and any(
        _DATA.match(line) for line in text[:_SEARCHED_CHARACTERS].expandtabs().split("\n")
    )


def read(
    text: str, file: str, *, dt: float | None = None, units: str | None = None, channel: str | None = None
) -> GroundMotion:
    """Read a CSMIP V2 file; arguments, result and errors are those of `registry.Reader.read`."""
    lines = layout.lines_of(text)
    channels = []
    name = ""
    peak: tuple[int, str, str] | None = None
    index = start = 0
    while index < len(lines):
        line = lines[index]
        index += 1
        # The first line of a channel also has its name, with more text; a later line begins with the name.
        if _FIRST_LINE.match(line):
            start = index - 1
        if match := _CHANNEL.match(line.strip()):
            name = match[1]
        if match := _PEAK.match(line.strip()):
            peak = (index, match[1], match[2])
        data = _DATA.match(line)
        if data is None:
            continue
        count = layout.whole_number(file, index, line, data[1], "number of points", least=2)
        interval = layout.number(file, index, line, data[3], "sample interval")
        form = _FORMAT.search(data[4])
        width = layout.column_width(file, index, line, form[1]) if form else _DEFAULT_WIDTH
        block = layout.RecordBlock(index, count, width, index)
        values, index, remarks = layout.fixed_width(file, lines, block)
        if data[2].upper() == "ACCEL":
            spelling = _UNIT.search(data[4])
            unit = layout.stated_unit(file, block.header_line, spelling[1] if spelling else "", units)
            if peak is not None:
                remarks += peak_doubts(100 * layout.in_si(values, unit), interval, "cm/s2", *peak)
            origin = of_csmip(lines[start : min(start + _TEXT_LINES, block.header_line)])
            line_number = block.header_line
            channels.append(
                layout.Channel(
                    name, interval, layout.in_si(values, unit), unit, line_number, remarks=remarks, origin=origin
                )
            )
            peak = None
        elif channels and not math.isclose(interval, channels[-1].dt):
            message = f"the interval is {interval:g} s, but that of its accelerations {channels[-1].dt:g} s"
            hint = "one of the two is damaged: download the file again"
            raise InputError(Problem(message, file, block.header_line, excerpt=line.strip()[:100], hint=hint))
    if not channels:
        message = "the file holds no acceleration, only velocity or displacement"
        raise InputError(Problem(message, file, hint="give the file with the corrected acceleration"))
    return layout.choose(file, TITLE, channels, channel, dt)

"""CSMIP V2 (CDMG, California): consecutive channels, each with acceleration, velocity and displacement."""

from __future__ import annotations

import math
import re

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.records import formats, layout
from rocking_cli.excitation.records.record_units import Asked
from rocking_cli.excitation.records.statements import of_csmip, peak_doubts
from rocking_cli.text import regex

_DATA = regex(r"\s*(\d+) +POINTS OF (ACCEL|VELOC|DISPL)\w* +DATA EQUALLY SPACED AT +(\S+?) *SEC\b(.*)", re.I)
_UNCORRECTED = regex(r"\s*UNCORRECTED ACCELEROGRAM DATA\b", re.I)
_FIRST_LINE = regex(r"\s*CORRECTED ACCELEROGRAM\b", re.I)
_TEXT_LINES = 25
_UNIT = regex(r"(?:\bunits:|\bin) *([^,()]*?\w)\.? *(?:[,()]|$|format)", re.I)
_FORMAT = regex(r"\b\d+F(\d+)\.\d+", re.I)
_CHANNEL = regex(r"\bCHAN(?:NEL)? +\d+: *(.*\S)", re.I)
_PEAK = regex(r"PEAK ACCELERATION *= *(\S+) +CM/SEC/SEC +AT +(\S+) *SEC", re.I)
_DEFAULT_WIDTH = 10  # characters per number, as in 8F10.3


def read(text: str, file: str, asked: Asked) -> GroundMotion:
    """Read a CSMIP V2 file; see `formats.Reader.read`."""
    if _UNCORRECTED.match(text):
        message = "this is CSMIP V1, an uncorrected record as digitised, which is not read"
        raise InputError(Problem(message, file, 1, hint="give the corrected record, CSMIP V2, of the same archive"))
    lines = layout.lines_of(text)
    channels: list[layout.Channel] = []
    held: list[str] = []  # quantities in the file
    of_accelerations = math.nan  # s
    name = ""
    peak: tuple[int, str, str] | None = None
    index = start = end = 0
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
        end = index
        held.append(data[2])
        if layout.quantity_called(data[2]) == "acceleration":
            of_accelerations = interval
        elif not math.isnan(of_accelerations) and not math.isclose(interval, of_accelerations):
            message = f"the interval is {interval:g} s, but that of its accelerations {of_accelerations:g} s"
            hint = "one of the two is damaged: download the file again"
            raise InputError(Problem(message, file, block.header_line, excerpt=line.strip()[:100], hint=hint))
        if layout.quantity_called(data[2]) == asked.wanted.quantity:
            spelling = _UNIT.search(data[4])
            unit, size = layout.stated_unit(file, block.header_line, spelling[1] if spelling else "", asked)
            if peak is not None and asked.wanted.of_accelerations:
                remarks += peak_doubts(100 * (values * size), interval, "cm/s2", *peak)
            origin = of_csmip(lines[start : min(start + _TEXT_LINES, block.header_line)])
            line_number = block.header_line
            channels.append(
                layout.Channel(name, interval, values * size, unit, line_number, remarks=remarks, origin=origin)
            )
            peak = None
    if channels and start >= end:
        raise InputError(Problem("the channel that begins here has no values", file, start + 1, hint=layout.CUT))
    if not channels:
        raise layout.lacking(file, asked.wanted, held)
    return layout.choose(file, formats.csmip_v2.TITLE, channels, asked)

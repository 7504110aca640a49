"""CSMIP V2 (CDMG, California): channels one after another, each with acceleration, velocity and displacement."""

from __future__ import annotations

import re

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.records import csmip_v1
from rocking_cli.excitation.records.layout import Block, Channel, choose, fixed_width, in_si, number, stated_unit
from rocking_cli.excitation.records.lines import Lines

TITLE = "CSMIP V2"
SIGN = "a line such as 3251 POINTS OF ACCEL DATA EQUALLY SPACED AT .020 SEC"

_DATA = re.compile(r"\s*(\d+) +POINTS OF (ACCEL|VELOC|DISPL)\w* +DATA EQUALLY SPACED AT +(\S+?) *SEC\b(.*)", re.I)
_UNIT = re.compile(r"(?:\bunits:|\bin) *([^,()]*?\w)\.? *(?:[,()]|$|format)", re.I)
_FORMAT = re.compile(r"\b\d+F(\d+)\.\d+", re.I)
_CHANNEL = re.compile(r"\bCHAN(?:NEL)? +\d+: *(.*\S)", re.I)
_WIDTH = 10  # 8F10.3, unless the line says otherwise
_HEAD = 100_000  # characters looked at to recognise the format


def sniff(text: str) -> bool:
    """Whether the line that announces a history is there, and not of an uncorrected record, which may have it too."""
    return not csmip_v1.sniff(text) and any(_DATA.match(line) for line in text[:_HEAD].split("\n"))


def read(
    text: str, file: str, *, dt: float | None = None, units: str | None = None, channel: str | None = None
) -> GroundMotion:
    """Read a CSMIP V2 file; arguments, result and errors are those of `registry.Reader.read`."""
    lines = Lines(text)
    channels = []
    name = ""
    index = 0
    while index < len(lines):
        line = lines[index]
        index += 1
        # The first line of a channel has it too, followed by more; the one that begins with it comes later.
        if match := _CHANNEL.match(line.strip()):
            name = match[1]
        data = _DATA.match(line)
        if data is None:
            continue
        count = int(number(file, index, line, data[1], "number of points", least=1))
        own = number(file, index, line, data[3], "sample interval")
        form = _FORMAT.search(data[4])
        block = Block(index, count, int(form[1]) if form else _WIDTH, index)
        values, index = fixed_width(file, lines, block)
        if data[2].upper() == "ACCEL":
            spelling = _UNIT.search(data[4])
            unit = stated_unit(file, block.header_line, spelling[1] if spelling else "", units)
            channels.append(Channel(name, own, in_si(values, unit), unit, block.header_line))
    if not channels:
        message = "the file holds no acceleration, only velocity or displacement"
        raise InputError(Problem(message, file, hint="give the file with the corrected acceleration"))
    return choose(file, TITLE, channels, channel, dt)

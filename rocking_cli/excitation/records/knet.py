"""K-NET and KiK-net (NIED, Japan): a header of 17 lines, then digitiser counts with a scale factor and an offset."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion
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
from rocking_cli.excitation.records.origins import first_match, origin
from rocking_cli.excitation.records.stated import peak_doubts
from rocking_cli.excitation.records.text import sensible
from rocking_cli.patterns import regex

TITLE = "K-NET/KiK-net"
SIGN = "header lines Sampling Freq(Hz) and Scale Factor"

_RATE = regex(r"Sampling Freq\.? *\(Hz\)\s+([\d.]+) *Hz\s*$")
_DURATION = regex(r"Duration Time *\(s\)\s+(\S+)\s*$")
_SCALE = regex(r"Scale Factor\s+([\d.]+) *\((.*?)\) */ *([\d.]+)\s*$")
_PEAK = regex(r"Max\. Acc\. *\(.*?\)\s+(\S+)\s*$")
_DIRECTION = regex(r"Dir\.\s+(\S+)")
_EVENT = regex(r"^Origin Time\s+(\d{4}/\d{2}/\d{2} \d{2}:\d{2}:\d{2})")
_MAGNITUDE = regex(r"^Mag\.\s+(\S+)")
_STATION = regex(r"^Station Code\s+(\S+)")
_HEADER_LINES = 17
_WIDTH, _AFTER = 9, 1  # characters to a number, the last of them a blank


def sniff(text: str) -> bool:
    """Return whether the header states the rate and the scale factor by their names in K-NET."""
    head = text[:5000].expandtabs().split("\n")[:_HEADER_LINES]
    return all(any(line.startswith(key) for line in head) for key in ("Sampling Freq", "Scale Factor"))


def read(
    text: str, file: str, *, dt: float | None = None, units: str | None = None, channel: str | None = None
) -> GroundMotion:
    """Read a K-NET or KiK-net file, and subtract the mean, which is the zero of the digitiser.

    Arguments, result and errors are those of `registry.Reader.read`.
    """
    lines = lines_of(text)
    head = lines[:_HEADER_LINES]
    rate_line, (rate_text,) = _find(file, lines, _RATE, "sampling frequency, such as 100Hz")
    scale_line, scale = _find(file, lines, _SCALE, "scale factor, such as 3920(gal)/6182761")
    length_line, (length_text,) = _find(file, lines, _DURATION, "duration")
    unit = stated_unit(file, scale_line, scale[1], units)
    rate = number(file, rate_line, lines[rate_line - 1], rate_text, "sampling frequency")
    length = number(file, length_line, lines[length_line - 1], length_text, "duration")
    full, counts = (number(file, scale_line, lines[scale_line - 1], part, "scale factor") for part in scale[::2])
    # The format has no number of points: it is the rate times the duration.
    line = lines[length_line - 1]
    count = whole_number(file, length_line, line, f"{round(rate * length)}", "number of points", least=2)
    values, _, remarks = fixed_width(file, lines, RecordBlock(_HEADER_LINES, count, _WIDTH, length_line, after=_AFTER))
    if not sensible(float(np.abs(values).max()) * (full / counts)):
        message = "the scale factor makes accelerations beyond all measure"
        raise InputError(Problem(message, file, scale_line, excerpt=lines[scale_line - 1].strip()[:100]))
    scaled = (values - values.mean()) * (full / counts)
    acceleration = in_si(scaled, unit)
    peak = next(((n, match[1]) for n, line in enumerate(head, 1) if (match := _PEAK.match(line))), None)
    if peak is not None:
        remarks += peak_doubts(scaled, 1 / rate, scale[1], *peak)
    direction = next((match[1] for line in head if (match := _DIRECTION.match(line))), "")
    event, station, magnitude = (first_match(pattern, head) for pattern in (_EVENT, _STATION, _MAGNITUDE))
    found = Channel(
        direction, 1 / rate, acceleration, unit, rate_line, remarks=remarks, origin=origin(event, station, magnitude)
    )
    return choose(file, TITLE, [found], channel, dt)


def _find(file: str, lines: Sequence[str], pattern: re.Pattern[str], what: str) -> tuple[int, tuple[str, ...]]:
    """Return line number and values of an item in the header."""
    for line_number, line in enumerate(lines[:_HEADER_LINES], start=1):
        if match := pattern.match(line):
            return line_number, match.groups()
    raise InputError(Problem(f"the header does not state the {what}", file, 1))

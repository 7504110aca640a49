"""K-NET and KiK-net (NIED, Japan): a header of 17 lines, then digitiser counts with a scale factor and an offset."""

from __future__ import annotations

import numpy as np

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.records import formats, layout
from rocking_cli.excitation.records.layout import Field, read_head
from rocking_cli.excitation.records.record_units import Asked
from rocking_cli.excitation.records.statements import peak_doubts
from rocking_cli.excitation.records.text import sensible
from rocking_cli.text import regex

_FIELDS = {
    "rate": Field(regex(r"^Sampling Freq\.? *\(Hz\)\s+([\d.]+) *Hz\s*$"), "sampling frequency", ", such as 100Hz"),
    "scale": Field(
        regex(r"^Scale Factor\s+([\d.]+) *\((.*?)\) */ *([\d.]+)\s*$"),
        "scale factor",
        ", such as 3920(gal)/6182761",
    ),
    "duration": Field(regex(r"^Duration Time *\(s\)\s+(\S+)\s*$"), "duration"),
    "peak": Field(regex(r"^Max\. Acc\. *\(.*?\)\s+(\S+)\s*$")),
    "direction": Field(regex(r"^Dir\.\s+(\S+)")),
    "event": Field(regex(r"^Origin Time\s+(\d{4}/\d{2}/\d{2} \d{2}:\d{2}:\d{2})")),
    "station": Field(regex(r"^Station Code\s+(\S+)")),
    "magnitude": Field(regex(r"^Mag\.\s+(\S+)")),
}
_HEADER_LINES = 17
_NUMBER_WIDTH, _BLANKS_AFTER = 9, 1  # characters per number, and blanks after it


def read(text: str, file: str, asked: Asked) -> GroundMotion:
    """Read a K-NET or KiK-net file, and subtract the mean, which is the zero of the digitiser.

    Arguments, result and errors are those of `formats.Reader.read`.
    """
    lines = layout.lines_of(text)
    head = read_head(file, lines, _FIELDS, _HEADER_LINES)
    scale_line, scale_text, (_, spelling, _) = head["scale"]
    length_line, length_text, _ = head["duration"]
    unit, size = layout.stated_unit(file, scale_line, spelling, asked)
    rate, length = head.number("rate"), head.number("duration")
    full, counts = head.number("scale"), head.number("scale", 2)
    # The format states no number of points; the rate times the duration gives it.
    count = layout.whole_number(file, length_line, length_text, f"{round(rate * length)}", "number of points", least=2)
    values, end, remarks = layout.fixed_width(
        file, lines, layout.RecordBlock(_HEADER_LINES, count, _NUMBER_WIDTH, length_line, after=_BLANKS_AFTER)
    )
    layout.check_end(file, lines, end)
    if not sensible(float(np.abs(values).max()) * (full / counts)):
        message = "the scale factor makes accelerations beyond all measure"
        raise InputError(Problem(message, file, scale_line, excerpt=scale_text.strip()[:100]))
    scaled = (values - values.mean()) * (full / counts)
    if peak := head.items.get("peak"):
        remarks += peak_doubts(scaled, 1 / rate, spelling, peak.line_number, *peak.groups)
    name, rate_line = head.text("direction") or "", head["rate"].line_number
    only = layout.Channel(name, 1 / rate, scaled * size, unit, rate_line, remarks=remarks, origin=head.origin)
    return layout.choose(file, formats.knet.TITLE, [only], asked)

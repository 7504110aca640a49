"""USGS SMC: 11 text lines, 48 integers and 50 reals, comments, then 8 values per line without blanks between them."""

from __future__ import annotations

import numpy as np

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion, Origin
from rocking_cli.excitation.records import formats, layout
from rocking_cli.excitation.records.layout import Field, RecordHead, read_head
from rocking_cli.excitation.records.record_units import Asked, Quantity
from rocking_cli.excitation.records.statements import origin, peak_doubts
from rocking_cli.text import regex

_FIRST_LINE = regex(r"(\d) +([A-Z].*)")
_UNCORRECTED = "1"
# Quantity and unit of each kind, which the format fixes; a program may not have known them (0), and 5 are spectra.
_KINDS: dict[str, tuple[Quantity, str]] = {
    _UNCORRECTED: ("acceleration", "cm/s2"),
    "2": ("acceleration", "cm/s2"),
    "3": ("velocity", "cm/s"),
    "4": ("displacement", "cm"),
}
_UNKNOWN = "0"
_MAX_RATE = 1e6  # samples per second; files without a rate state 1.7e38 or zero
_TEXT_LINES = 11
_INTEGERS = layout.RecordBlock(_TEXT_LINES, 48, 10, 1)
_REALS = layout.RecordBlock(_TEXT_LINES + 6, 50, 15, 1, unset=1.7e38)
_DATA_WIDTH = 10
_FIELDS = {
    "component": Field(regex(r"component *= *(-?\w+)")),
    # Date, time and name of the earthquake.
    "event": Field(regex(r"^ *(\d{4}) +(\d{1,2}) +(\d{1,2}) +(\d{4}) +(\S.*)$"), line=4),
    "station": Field(regex(r"^station *= *(.*?),? *\bcomponent *=")),
    "moment": Field(regex(r"Moment Mag= *([\d.]+)")),
    "local": Field(regex(r"\bMl= *([\d.]+)")),
    "surface": Field(regex(r"\bMs= *([\d.]+)")),
    "distance": Field(regex(r"^epicentral dist *= *([\d.]+)")),
}
# Places among the integers and the reals, counted from 1.
_COMMENTS, _COUNT = 16, 17
_RATE_PLACE = 2  # place of the rate in samples per second
_EXTREMES_PLACES = ((29, 30), (31, 32))  # places of time and value of the largest and of the smallest acceleration


def read(text: str, file: str, asked: Asked) -> GroundMotion:
    """Read a USGS SMC file; see `formats.Reader.read`."""
    lines = layout.lines_of(text)
    kind = _FIRST_LINE.match(lines[0])
    assert kind is not None  # as the format was recognised by it
    quantity, stated = (asked.wanted.quantity, "") if kind[1] == _UNKNOWN else _KINDS.get(kind[1], (None, ""))
    if quantity != asked.wanted.quantity:
        raise layout.lacking(file, asked.wanted, [quantity or lines[0].strip()], 1)
    unit, size = layout.stated_unit(file, 1, stated, asked)
    integers = layout.fixed_width(file, lines, _INTEGERS, last=False).values
    reals, start, _ = layout.fixed_width(file, lines, _REALS, last=False)
    comments, count, rate = int(integers[_COMMENTS - 1]), int(integers[_COUNT - 1]), float(reals[_RATE_PLACE - 1])
    comment_line, count_line, rate_line = _TEXT_LINES + 2, _TEXT_LINES + 3, _REALS.start + 1
    if comments < 0:
        message = f"the header says {comments} comment lines"
        raise InputError(Problem(message, file, comment_line, hint="0 is the least there can be"))
    if start + comments >= len(lines):
        raise InputError(Problem("the file ends before its values", file, len(lines)))
    layout.whole_number(file, count_line, lines[count_line - 1], str(count), "number of points", least=2)
    if kind[1] == _UNCORRECTED and not 0 < rate < _MAX_RATE:  # also refuses NaN, which stands for a missing rate
        message = "an uncorrected film record, points at uneven times: the header has no number of samples per second"
        raise InputError(Problem(message, file, rate_line, hint="give the corrected record of it (kind 2)"))
    layout.number(file, rate_line, lines[rate_line - 1], f"{rate!r}", "number of samples per second")
    if not all(line.startswith("|") for line in lines[start : start + comments]) or lines[start + comments].startswith(
        "|"
    ):
        message = f"the header says {comments} comment lines, but another number begins with |"
        raise InputError(Problem(message, file, comment_line, hint=layout.CUT))
    block = layout.RecordBlock(start + comments, count, _DATA_WIDTH, count_line)
    values, end, remarks = layout.fixed_width(file, lines, block)
    layout.check_end(file, lines, end)
    extremes = [(reals[peak - 1], reals[time - 1]) for time, peak in _EXTREMES_PLACES if not np.isnan(reals[peak - 1])]
    if extremes:
        peak, time = max(extremes, key=lambda extreme: abs(extreme[0]))
        remarks += peak_doubts(values, 1 / rate, unit, _REALS.start + 6, f"{peak:.7E}", f"{time:.7E}")
    head = read_head(file, lines, _FIELDS, _TEXT_LINES)
    name, origin = head.text("component") or "", _origin(head)
    only = layout.Channel(name, 1 / rate, values * size, unit, rate_line, remarks=remarks, origin=origin)
    return layout.choose(file, formats.smc.TITLE, [only], asked)


def _origin(head: RecordHead) -> Origin:
    """Return the origin from the text header: earthquake by name and time, station, magnitude and distance."""
    event = None
    if "event" in head.items:
        year, month, day, time, name = head["event"].groups
        event = f"{name} {year}-{month:0>2}-{day:0>2} {time[:2]}:{time[2:]}"
    magnitude = head.text("moment") or head.text("local") or head.text("surface")
    return origin(event, head.text("station"), magnitude, head.text("distance"))

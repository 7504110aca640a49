"""GeoNet V1A and V2A (GNS Science, New Zealand): components of 16 lines of text, 10 of numbers, and histories.

V1A holds raw accelerations, V2A corrected ones with their velocities and displacements.
"""

from __future__ import annotations

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import Doubt, GroundMotion
from rocking_cli.excitation.records import formats, layout
from rocking_cli.excitation.records.layout import Field, read_head
from rocking_cli.excitation.records.lines import Lines
from rocking_cli.excitation.records.record_units import QUANTITIES, Asked, plural
from rocking_cli.excitation.records.statements import length_doubts, peak_doubts
from rocking_cli.text import regex

_TEXT_LINES = 16
_NUMBER_LINES = 10
_WIDTH = 8  # characters per number
_SIZE = regex("[0-9]{1,9}")
_FIRST_LINE = regex(r"(Uncorrected|Corrected) accelerogram\b")
_MISSING = 999999.9  # in place of values before and after the record
_FIELDS = {
    "count": Field(regex(r"Number of points\s+(\d+)"), "number of points"),
    "dt": Field(regex(r"(?:data at|at intervals of)\s+(\S+)\s+s(?:ec intervals)?\b"), "sample interval"),
    "step": Field(regex(r"Raw readings in units of\s+(\S+)"), ""),
    "component": Field(regex(r"Component\s+(\S+)"), "component"),
    "duration": Field(regex(r"Duration\s+(\S+)\s+s")),
    # The file names no earthquake, so its time stands for it.
    "event": Field(regex(r"^(\d{4} [A-Z][a-z]+ +\d{1,2} +\d{2}:\d{2}:\d{2}(?: UT)?)")),
    "station": Field(regex(r"^Site +(\S+)")),
    "magnitude": Field(regex(r"^Epicentre .*\bM +(\S+)")),
    "distance": Field(regex(r"^Epicentre .*\bDist +(\S+?) *km\b")),
}

_PEAKS = {
    each: Field(regex(rf"{each.capitalize()}:\s+[Pp]eak\s+(\S+)\s+(\S+)"), f"unit of the {plural(each)}")
    for each in QUANTITIES
}


def read(text: str, file: str, asked: Asked) -> GroundMotion:
    """Read a GeoNet V1A or V2A file; see `formats.Reader.read`."""
    lines = layout.lines_of(text)
    channels = []
    start = 0
    while start < len(lines):
        if lines[start].strip():
            component, start = _component(file, lines, start, asked)
            channels.append(component)
        else:
            start += 1
    form = formats.geonet_v1a if text.startswith("U") else formats.geonet_v2a
    return layout.choose(file, form.TITLE, channels, asked)


def _component(file: str, lines: Lines, start: int, asked: Asked) -> tuple[layout.Channel, int]:
    """Read one component from line index `start` on; return it and the index after it."""
    if not _FIRST_LINE.match(lines[start]):
        message = "a component must begin here, with the line Corrected accelerogram, or Uncorrected"
        raise InputError(Problem(message, file, start + 1, excerpt=lines[start].strip()[:100], hint=layout.CUT))
    head = read_head(file, lines, _FIELDS | {"peak": _PEAKS[asked.wanted.quantity]}, _TEXT_LINES, start)
    unit_line, _, (peak, spelling) = head["peak"]
    unit, size = layout.stated_unit(file, unit_line, spelling, asked)
    interval, npts, count_line = head.number("dt"), head.count, head["count"].line_number

    # The fourth line of numbers has the lengths of the three histories, of which the last two may be absent.
    sizes_line = start + _TEXT_LINES + 3
    sizes = (
        [int(each) for each in lines[sizes_line].split()[3:6] if _SIZE.fullmatch(each)]
        if sizes_line < len(lines)
        else []
    )
    if sizes == [0, 0, 0]:  # some raw records leave the numbers of the header empty
        sizes[0] = npts
    if len(sizes) < 3 or sizes[0] != npts:
        message = f"the numbers of the header do not give the {npts} points of its text, followed by two more counts"
        raise InputError(Problem(message, file, sizes_line + 1, hint=layout.CUT))
    end = start + _TEXT_LINES + _NUMBER_LINES
    histories: list[tuple[Reals, tuple[Doubt, ...]]] = []
    for count in sizes:
        block = layout.RecordBlock(end, count, _WIDTH, sizes_line + 1 if histories else count_line, unset=_MISSING)
        values, end, remarks = layout.fixed_width(file, lines, block, last=False)
        histories.append((values, remarks))
    values, remarks = histories[QUANTITIES.index(asked.wanted.quantity)]
    if not values.size:
        raise layout.lacking(file, asked.wanted, ["acceleration"], sizes_line + 1)
    values, missing = _without_missing(file, end, values)
    if "step" in head.items:
        values = values * head.number("step")
    # The time of the peak is not checked, as it excludes the taper before the values.
    remarks += missing + peak_doubts(values, interval, unit, unit_line, peak)
    if (duration := head.items.get("duration")) and duration.line_number == count_line:
        remarks += length_doubts((npts - 1) * interval, count_line, duration.groups[0], interval)
    name, dt_line = head["component"].groups[0], head["dt"].line_number
    return layout.Channel(name, interval, values * size, unit, dt_line, remarks=remarks, origin=head.origin), end


def _without_missing(file: str, line_number: int, values: Reals) -> tuple[Reals, tuple[Doubt, ...]]:
    """Return the values without those missing at both ends, which are NaN, and a doubt if there are some."""
    present = np.flatnonzero(~np.isnan(values))
    if present.size == values.size:
        return values, ()
    if present.size < 2 or np.ptp(present) >= present.size:
        raise InputError(Problem("values are missing within the component", file, line_number))
    text = (
        f"its component begins with {present[0]} missing values and ends with {values.size - 1 - present[-1]}, "
        "which are left out: its time begins later than that of the other components"
    )
    return values[present], (Doubt("count", float(present.size), text),)

"""USC V1 (Volume I, also of Caltech): an uncorrected film record, pairs of time and acceleration at uneven times."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Reals
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.records import formats, layout
from rocking_cli.excitation.records.layout import Field, read_head
from rocking_cli.excitation.records.record_units import Asked
from rocking_cli.excitation.records.statements import length_doubts
from rocking_cli.text import regex
from rocking_cli.units import UNITS

_FIELDS = {
    "count": Field(regex(r"NO\. OF POINTS *= *(\d+)"), "number of points", " (NO. OF POINTS)"),
    "unit": Field(regex(r"UNITS ARE SEC AND (.*?)(?:\s+\d+|\s{2,}.*)?$"), "unit", " (UNITS ARE SEC AND ...)"),
    "duration": Field(regex(r"DURATION *= *(\S+) *SEC")),
    "component": Field(regex(r"^COMP\s+(\S+)")),
    "event": Field(regex(r"^(.*\bEARTHQUAKE\b.*?)(?:\s+\d+)?\s*$"), line=8),
    "station": Field(regex(r"^STATION (USC# *\d+)")),
}
_TENTH_OF_G = "g/10"
_FILM_DT = 1e-3  # s; times of digitised films are printed with three decimals
_MAX_FILM_DURATION = 3600.0  # s; films ran for a minute or two, and each second takes a thousand samples
_TEXT_LINES = 30  # lines with the items of the header
_INTEGERS, _REALS = 100, 50


def read(text: str, file: str, asked: Asked) -> GroundMotion:
    """Read a USC V1 file; see `formats.Reader.read`.

    The record is linear between its points, whose times are whole milliseconds. The motion has the largest constant
    interval that includes all of these times: it has more samples than the file has points, but is not an
    approximation.
    """
    lines = layout.lines_of(text)
    head = read_head(file, lines, _FIELDS, _TEXT_LINES)
    count, count_line = head.count, head["count"].line_number
    unit, size = _unit(file, head["unit"].line_number, head["unit"].groups[0], asked)

    start = next((index for index, line in enumerate(lines) if not re.search(r"[A-Za-z]", line)), len(lines))
    for length, width in ((_INTEGERS, 5), (_REALS, 10)):
        _, start, _ = layout.fixed_width(file, lines, layout.RecordBlock(start, length, width, 1), last=False)
    pairs, end, remarks = layout.fixed_width(file, lines, layout.RecordBlock(start, 2 * count, 7, count_line, margin=1))
    layout.check_end(file, lines, end)
    step, values, points = _straight_lines(file, pairs, f"lines {start + 1} to {end}")
    if (duration := head.items.get("duration")) and duration.line_number == count_line:
        remarks += length_doubts(float(pairs[-2]), count_line, duration.groups[0], 0.0)
    name = head.text("component") or ""
    only = layout.Channel(name, step, values * size, unit, points=points, remarks=remarks, origin=head.origin)
    return layout.choose(file, formats.usc_v1.TITLE, [only], asked)


def _unit(file: str, line_number: int, spelling: str, asked: Asked) -> tuple[str, float]:
    """Return the unit as `layout.stated_unit` does, or a tenth of g, which only digitised films have."""
    if spelling.replace(" ", "").lower() != _TENTH_OF_G:
        return layout.stated_unit(file, line_number, spelling, asked)
    if asked.units is not None:
        unit, _ = asked.unit(file, [])  # refuses an unknown one
        message = f"the header says the unit is {_TENTH_OF_G}, but {named('units')} says {unit}"
        raise InputError(Problem(message, file, line_number, hint=f"leave {named('units')} out"))
    return _TENTH_OF_G, UNITS["g"] / 10


def _straight_lines(file: str, pairs: Reals, where: str) -> tuple[float, Reals, NDArray[np.intp]]:
    """Interpolate a digitised film, with uneven times, to a constant interval that includes all of its times.

    Times are in whole milliseconds, so that such an interval exists and the interpolation is exact: the motion has more
    samples than the film has points, but the same straight lines between these.

    Parameters
    ----------
    file : str
        The file, for the messages.
    pairs : ndarray, shape (2 * points,)
        Time [s] and value of each point.
    where : str
        Lines of the points in the file, for messages.

    Returns
    -------
    dt : float
        The largest interval that includes all times [s].
    values : ndarray, shape (npts,)
        Values at this interval.
    points : ndarray of int, shape (points,)
        Indices of the samples that are points of the film.
    """
    time, values = pairs.reshape(-1, 2).T
    far = np.abs(time) > _MAX_FILM_DURATION
    if far.any():
        point = int(np.argmax(far))
        message = f"point {point + 1} is at {time[point]:g} s: no film runs for more than {_MAX_FILM_DURATION:g} s"
        raise InputError(Problem(message, file, hint=f"it is among {where}"))
    ticks = np.rint(time / _FILM_DT).astype(np.int64)
    steps = np.diff(ticks)
    if (steps <= 0).any():
        point = int(np.argmax(steps <= 0)) + 1
        message = f"time does not increase: point {point + 1} is at {time[point]:g} s, after {time[point - 1]:g} s"
        raise InputError(Problem(message, file, hint=f"it is among {where}"))
    step = int(np.gcd.reduce(steps))
    grid = np.arange(ticks[0], ticks[-1] + 1, step)
    return step * _FILM_DT, np.interp(grid, ticks, values), ((ticks - ticks[0]) // step).astype(np.intp)

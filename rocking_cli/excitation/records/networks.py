"""Networks that print the components of a record side by side: AFAD (Turkey), ASA (Mexico), CWA (Taiwan), JMA (Japan).

A header states the interval, the unit and the components, and as a rule the number of points and the peaks.
"""

from __future__ import annotations

import re
from array import array

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import Doubt, GroundMotion
from rocking_cli.excitation.records import formats, layout
from rocking_cli.excitation.records.formats import Format
from rocking_cli.excitation.records.layout import Field, RecordHead, read_head
from rocking_cli.excitation.records.lines import Lines, PrintedRows, split_numbers
from rocking_cli.excitation.records.record_units import Asked
from rocking_cli.excitation.records.statements import length_doubts, peak_doubts
from rocking_cli.excitation.records.text import numbers_in
from rocking_cli.text import regex

_LIST = r" *C\d+ *- *C\d+[^:]*: *(/.*)"  # of the items of six channels, each behind a slash
_FIELDS: dict[Format, dict[str, Field]] = {
    formats.afad: {
        "count": Field(regex(r"NUMBER OF DATA *: *(\d+)"), "number of points"),
        "dt": Field(regex(r"SAMPLING INTERVAL *\(sec\.?\) *: *(\S+)"), "sample interval"),
        # The values have this unit if their peaks are these.
        "unit": Field(regex(r"RAW PGA VALUES *\(([^)]*)\)"), "peaks", " (RAW PGA VALUES)"),
        "names": Field(regex(r"RAW PGA VALUES *\([^)]*\) *:(.*)"), "peaks"),
        "station": Field(regex(r"STATION ID *: *(\S+)")),
        "event": Field(regex(r"EARTHQUAKE DATE *: *(\S.*)")),
        "labels": Field(regex(r"^\s*(N-?S\s+E-?W\s+U-?D)\b")),
    },
    formats.asa: {
        "dt": Field(regex(rf"INTERVALO DE MUESTREO,{_LIST}"), "sample interval"),
        "count": Field(regex(rf"NUM\. TOTAL DE MUESTRAS,{_LIST}"), "number of points"),
        "names": Field(regex(rf"ORIENTACION,?{_LIST}"), "orientation of the channels"),
        "unit": Field(regex(r"UNIDADES DE LOS DATOS *: *(\S.*)"), "unit"),
        "peaks": Field(regex(rf"ACEL\. MAX\. *\(Gal\),{_LIST}", re.I)),
        "station": Field(regex(r"CLAVE DE LA ESTACION *: *(\S+)")),
        "event": Field(regex(r"FECHA DEL SISMO *[\[(]GMT[\])] *: *(\S.*)")),
        "magnitude": Field(regex(r"MAGNITUD\(ES\) *:.*?\bMw *=? *([\d.]+)", re.I)),
        "labels": Field(regex(r"^\s*(-+\+-+.*)|CANAL-1\b")),
    },
    formats.cwa: {
        "rate": Field(regex(r"^#SampleRate\(Hz\): *(\S+)"), "sampling rate"),
        "unit": Field(regex(r"^#AmplitudeUnit: *([^\s.]+)"), "unit"),
        "duration": Field(regex(r"^#RecordLength\(sec\): *(\S+)"), "duration"),
        "names": Field(regex(r"^#DataSequence: *(.*)"), "components", " (DataSequence)"),
        "station": Field(regex(r"^#StationCode: *(\S+)")),
        "labels": Field(regex(r"^#(Data):")),
    },
    formats.jma: {
        "rate": Field(regex(r"^\s*SAMPLING RATE *= *([\d.]+) *Hz", re.I), "sampling rate"),
        "unit": Field(regex(r"^\s*UNIT *= *([^\s,(]+)"), "unit"),
        "names": Field(regex(r"^\s*([A-Z]{1,2} *,(?: *[A-Z]{1,2} *,)* *[A-Z]{1,2})[ ,]*$"), "components"),
        "station": Field(regex(r"^\s*SITE CODE *= *([!-+\--~]+)")),
    },
}
_HEADER_LINES = 150
_PEAK_OF_CWA = regex(r"^#AmplitudeMAX\. *(\w+): *(\S+?) *~ *(\S+)", re.MULTILINE)


def read(text: str, file: str, asked: Asked) -> GroundMotion:
    """Read a file of one of the networks; see `formats.Reader.read`."""
    form = next(each for each in _FIELDS if each.sniff(text))
    lines = layout.lines_of(text)
    head = read_head(file, lines, _FIELDS[form], _HEADER_LINES)
    names, peaks = _components(text, head, form)
    of_times = 1 if form is formats.cwa else 0  # number of columns before the components
    start = max(item.line_number for item in head.items.values())
    start = next((k for k in range(start, len(lines)) if layout.FIRST_ROW.match(lines[k])), len(lines))
    table, remarks = _table(file, lines, start, of_times + len(names))
    interval = 1 / head.number("rate") if "rate" in head.items else _one(file, head, "dt")
    _check_length(file, head, len(table), interval)
    if of_times and np.abs(table[:, 0] - table[0, 0] - interval * np.arange(len(table))).max() > interval / 2:
        raise InputError(
            Problem(f"the times of the rows are not {interval:g} s apart", file, start + 1, hint=layout.CUT)
        )
    columns = table.T[of_times:]
    unit_line, _, (spelling, *_) = head["unit"]
    doubts = [
        peak_doubts(column, interval, spelling, unit_line, peaks.get(name, ""))
        for name, column in zip(names, columns, strict=True)
    ]
    if form is formats.afad and any(doubts):  # the header states the unit of the peaks alone
        spelling = ""
    unit, size = layout.stated_unit(file, unit_line, spelling, asked)
    dt_line = head["rate" if "rate" in head.items else "dt"].line_number
    channels = [
        layout.Channel(name, interval, column * size, unit, dt_line, remarks=remarks + doubt, origin=head.origin)
        for name, column, doubt in zip(names, columns, doubts, strict=True)
    ]
    return layout.choose(file, form.TITLE, channels, asked)


def _components(text: str, head: RecordHead, form: Format) -> tuple[list[str], dict[str, str]]:
    """Return the names of the components in the order of their columns, and the peaks of some as printed."""
    names = head["names"].groups[0]
    if form is formats.afad:
        peaks = dict(re.findall(r"\(([^)]*)\)\s*(\S+)", names))
        return (head.text("labels") or " ".join(peaks)).split(), peaks
    if form is formats.asa:
        every = [
            _FIELDS[form][each].pattern.findall(text[: form.within]) for each in ("names", "peaks")
        ]  # six in a line
        listed, printed = (_listed("".join(lists)) for lists in every)
        return listed, dict(zip(listed, printed, strict=False))
    if form is formats.cwa:
        both = {name: (largest, least) for name, largest, least in _PEAK_OF_CWA.findall(text[: form.within])}
        peaks = {name: max(each, key=lambda printed: printed.lstrip("-+").zfill(20)) for name, each in both.items()}
        return re.findall(r"(\w+)\s*\([+-]\)", names), peaks
    return [name.strip() for name in names.split(",")], {}


def _listed(printed: str) -> list[str]:
    """Return the entries of a list with slashes, without the empty ones."""
    return [entry for each in printed.split("/") if (entry := each.strip())]


def _one(file: str, head: RecordHead, name: str) -> float:
    """Return the number that an item of the header states, once or for each channel."""
    line_number, line, (printed,) = head[name]
    stated = dict.fromkeys(_listed(printed))
    if len(stated) != 1:
        message = f"the channels have several {head.fields[name].what}s: {', '.join(stated) or 'none'}"
        raise InputError(Problem(message, file, line_number, excerpt=line.strip()[:100]))
    return layout.number(file, line_number, line, next(iter(stated)), head.fields[name].what)


def _table(file: str, lines: Lines, start: int, columns: int) -> tuple[Reals, tuple[Doubt, ...]]:
    """Return the rows of numbers from line index `start` on, and doubts about how they are printed."""
    values = array("d")
    for number, line in enumerate(lines.since(start), start=start + 1):
        if not (cells := _cells(line)):
            continue
        if len(cells) != columns:
            message = f"this row has {len(cells)} numbers, but the header names {columns} columns"
            raise InputError(Problem(message, file, number, excerpt=line.strip()[:100], hint=layout.CUT))
        values.extend(numbers_in(file, number, line, cells))
    rows = PrintedRows(lines, start, _cells)
    doubts = layout.aligned(file, rows)
    if len(values) < 2 * columns:
        raise InputError(
            Problem("a record needs at least two samples", file, min(start + 1, len(lines)), hint=layout.CUT)
        )
    return np.array(values).reshape(-1, columns), doubts


def _cells(row: str) -> list[str]:
    return split_numbers(row.rstrip(", \t").replace(",", " "))


def _check_length(file: str, head: RecordHead, rows: int, interval: float) -> None:
    """Raise `InputError` if the rows are not as many as the header states, or do not last as long."""
    if "count" in head.items and (stated := _one(file, head, "count")) != rows:
        message = f"the header says {stated:g} values, but {rows} follow"
        raise InputError(Problem(message, file, head["count"].line_number, hint=layout.CUT))
    if "duration" in head.items:
        line_number, _, (length,) = head["duration"]
        for doubt in length_doubts(rows * interval, line_number, length, interval):
            raise InputError(Problem(doubt.text, file, line_number, hint=layout.CUT))

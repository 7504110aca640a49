"""ESM ASCII (Engineering Strong-Motion database, ITACA): a header of `KEY: value` lines, then one value per line."""

from __future__ import annotations

from collections.abc import Mapping

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion, Origin
from rocking_cli.excitation.records import formats, layout
from rocking_cli.excitation.records.record_units import Asked
from rocking_cli.excitation.records.statements import length_doubts, origin, peak_doubts
from rocking_cli.text import regex

_KEY = regex(r"([A-Z][A-Z0-9_/^]*):(.*)")
_DAY, _TIME = regex(r"(\d{4})(\d{2})(\d{2})"), regex(r"(\d{2})(\d{2})(\d{2})")


def read(text: str, file: str, asked: Asked) -> GroundMotion:
    """Read an ESM ASCII file; see `formats.Reader.read`."""
    lines = layout.lines_of(text)
    header: dict[str, tuple[int, str]] = {}
    start = 0
    while start < len(lines) and (match := _KEY.match(lines[start])):
        header.setdefault(match[1], (start + 1, match[2].strip()))
        start += 1

    kind_line, kind = header.get("DATA_TYPE", (start, ""))
    if kind and layout.quantity_called(kind) != asked.wanted.quantity:
        raise layout.lacking(file, asked.wanted, [kind], kind_line)
    for key in ("SAMPLING_INTERVAL_S", "NDATA"):
        if key not in header:
            message = f"the header, which ends before this line, does not state {key}"
            excerpt = lines[start].strip()[:100] if start < len(lines) else None
            raise InputError(Problem(message, file, min(start + 1, len(lines)), field=key, excerpt=excerpt))
    unit_line, spelling = header.get("UNITS", (start, ""))
    unit, size = layout.stated_unit(file, unit_line, spelling, asked)
    dt_line, dt_text = header["SAMPLING_INTERVAL_S"]
    interval = layout.number(file, dt_line, lines[dt_line - 1], dt_text, "sampling interval")
    count_line, count_text = header["NDATA"]
    count = layout.whole_number(file, count_line, lines[count_line - 1], count_text, "number of points", least=2)
    values, end, remarks = layout.fixed_width(file, lines, layout.RecordBlock(start, count, None, count_line))
    layout.check_end(file, lines, end)
    peak_line, peak = header.get("PGA_CM/S^2", (0, ""))
    peak_time = header.get("TIME_PGA_S", (0, ""))[1]
    remarks += peak_doubts(100 * (values * size), interval, "cm/s2", peak_line, peak, peak_time)
    length_line, length = header.get("DURATION_S", (0, ""))
    remarks += length_doubts(count * interval, length_line, length, interval)
    _, stream = header.get("STREAM", (0, ""))
    only = layout.Channel(stream, interval, values * size, unit, dt_line, remarks=remarks, origin=_origin(header))
    return layout.choose(file, formats.esm.TITLE, [only], asked)


def _origin(header: Mapping[str, tuple[int, str]]) -> Origin:
    """Return the origin; other formats share the key of the earthquake's name, but not that of its time."""
    values = {key: value for key, (_, value) in header.items()}
    day, time = (
        _DAY.fullmatch(values.get("EVENT_DATE_YYYYMMDD", "")),
        _TIME.fullmatch(values.get("EVENT_TIME_HHMMSS", "")),
    )
    when = [sign.join(match.groups()) for sign, match in (("-", day), (":", time)) if match is not None]
    event = " ".join([values.get("EVENT_NAME", ""), *when]) if day is not None else values.get("EVENT_ID", "")
    station = values.get("STATION_CODE", "")
    if station and values.get("NETWORK"):
        station = f"{values['NETWORK']}.{station}"
    magnitude = values.get("MAGNITUDE_W") or values.get("MAGNITUDE_L")
    return origin(event, station, magnitude, values.get("EPICENTRAL_DISTANCE_KM"))

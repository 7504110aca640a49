"""ESM ASCII (Engineering Strong-Motion database, ITACA): a header of `KEY: value` lines, then one value a line."""

from __future__ import annotations

import re

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.records.layout import Block, Channel, choose, fixed_width, in_si, number, stated_unit
from rocking_cli.excitation.records.lines import Lines

TITLE = "ESM ASCII"
SIGN = "header lines SAMPLING_INTERVAL_S: and NDATA:"

_KEY = re.compile(r"([A-Z][A-Z0-9_/^]*):(.*)")
_HEAD = 20_000  # characters the header is sought in
_WIDE = 100  # one value a line, however wide


def sniff(text: str) -> bool:
    """Whether the header has the interval and the number of points under the names of ESM."""
    return all(re.search(rf"^{key}:", text[:_HEAD], re.MULTILINE) for key in ("SAMPLING_INTERVAL_S", "NDATA"))


def read(
    text: str, file: str, *, dt: float | None = None, units: str | None = None, channel: str | None = None
) -> GroundMotion:
    """Read an ESM ASCII file; arguments, result and errors are those of `registry.Reader.read`."""
    lines = Lines(text)
    header: dict[str, tuple[int, str]] = {}
    start = 0
    while start < len(lines) and (match := _KEY.match(lines[start])):
        header.setdefault(match[1], (start + 1, match[2].strip()))
        start += 1

    kind_line, kind = header.get("DATA_TYPE", (start, ""))
    if kind and not kind.upper().startswith("ACC"):
        message = f"the header says the data are of type {kind}, not ACCELERATION"
        hint = "give the file with the acceleration"
        raise InputError(Problem(message, file, kind_line, field="DATA_TYPE", hint=hint))
    for key in ("SAMPLING_INTERVAL_S", "NDATA"):
        if key not in header:
            message = f"the header, which ends before this line, does not state {key}"
            excerpt = lines[start].strip()[:100] if start < len(lines) else None
            raise InputError(Problem(message, file, min(start + 1, len(lines)), field=key, excerpt=excerpt))
    unit_line, spelling = header.get("UNITS", (start, ""))
    unit = stated_unit(file, unit_line, spelling, units)
    dt_line, dt_text = header["SAMPLING_INTERVAL_S"]
    own = number(file, dt_line, lines[dt_line - 1], dt_text, "sampling interval")
    count_line, count_text = header["NDATA"]
    count = int(number(file, count_line, lines[count_line - 1], count_text, "number of points", least=1))
    values, _ = fixed_width(file, lines, Block(start, count, _WIDE, count_line))
    _, stream = header.get("STREAM", (0, ""))
    return choose(file, TITLE, [Channel(stream, own, in_si(values, unit), unit, dt_line)], channel, dt)

"""SimCenter JSON: an object with the interval `dT` and the list `accel_data`."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import MOST_SAMPLES, Doubt, GroundMotion
from rocking_cli.excitation.records import formats
from rocking_cli.excitation.records.layout import CUT
from rocking_cli.excitation.records.lines import Lines, PrintedRows, odd_digits
from rocking_cli.excitation.records.record_units import Asked
from rocking_cli.excitation.records.statements import of_info
from rocking_cli.excitation.records.text import check_interval, only_channel, sensible


def read(text: str, file: str, asked: Asked) -> GroundMotion:
    """Read a SimCenter JSON file; see `formats.Reader.read`."""
    only_channel(file, asked.channel)
    if text.count(",") > MOST_SAMPLES:
        raise InputError(Problem(f"a record has at most {MOST_SAMPLES} samples, this file has more values", file))

    def each_once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        """Return an object as a mapping; Python's `json` would silently keep the last value of a key."""
        for key, count in Counter(key for key, _ in pairs).items():
            if count > 1:
                last = [None, *(text.count("\n", 0, match.start()) + 1 for match in _places(text, key))][-1]
                hint = "keep one of each: the intended one is not guessed"
                raise InputError(Problem(f"the key {_shown(key)} is there more than once", file, last, hint=hint))
        return dict(pairs)

    try:
        data: dict[str, Any] = json.loads(text, parse_int=_whole, object_pairs_hook=each_once)
    except (json.JSONDecodeError, RecursionError) as error:
        line, column = getattr(error, "lineno", None), getattr(error, "colno", None)
        reason = getattr(error, "msg", "it is nested too deeply")
        raise InputError(Problem(f"not valid JSON: {reason}", file=file, line=line, column=column)) from None
    # JSON may hold lone surrogates, which cannot be printed or written.
    info = str(data.get("info", "")).encode("utf-8", "backslashreplace").decode().replace("\n", " ")
    unit, size = asked.unit(file, [(_line_of(text, "info"), info)])

    interval: Any = data.get("dT")
    if not (_is_number(interval) and 0 < interval < np.inf):
        message = (
            "the interval dT is missing"
            if interval is None
            else f"the interval dT must be positive, this is {_shown(interval)}"
        )
        hint = 'it is the time between samples in seconds, such as "dT": 0.01'
        raise InputError(Problem(message, file=file, line=_line_of(text, "dT"), field="dT", hint=hint))
    check_interval(file, _line_of(text, "dT"), interval, asked.dt)

    values = data.get("accel_data")
    line = _line_of(text, "accel_data")
    if not isinstance(values, list):
        raise InputError(Problem("the accelerations must be a list of numbers", file, line, field="accel_data"))
    for place, value in enumerate(values, start=1):
        if not _is_number(value) or not sensible(value):
            message = f"value {place} is not a finite number: {_shown(value)}"
            raise InputError(Problem(message, file, line, field="accel_data"))
    stated = data.get("numPoints", len(values))
    one_too_many = _is_number(stated) and stated == len(values) + 1
    if not _is_number(stated) or not (stated == len(values) or one_too_many):
        message = f"the file says numPoints = {_shown(stated)}, but has {len(values)} values"
        line, hint = _line_of(text, "numPoints"), f"{CUT}, or correct numPoints"
        raise InputError(Problem(message, file, line, field="numPoints", hint=hint))
    if len(values) < 2:
        message = f"a record needs at least two samples, this has {len(values)}"
        raise InputError(Problem(message, file, line, field="accel_data"))
    remarks = _digits(text)
    if one_too_many:  # files by SimCenter itself state one value too many
        missing = f"it says numPoints = {stated:g} and has one value less, as files of SimCenter do: or was one lost?"
        remarks = (Doubt("count", float(stated), missing), *remarks)
    acceleration = np.array(values, dtype=np.float64) * size
    origin = of_info(info)
    return GroundMotion(
        Path(file).name,
        float(interval),
        acceleration,
        source_unit=unit,
        format=formats.simcenter.TITLE,
        remarks=remarks,
        origin=origin,
    )


def _whole(digits: str) -> int | float:
    """Return the value of an integer of any length; Python would refuse one of some thousand digits."""
    return int(digits) if len(digits) < 40 else float(digits)


def _shown(value: object) -> str:
    """Return a value as JSON text, shortened."""
    if isinstance(value, (list, dict)):  # lists and mappings may be of any size and depth
        return "a list" if isinstance(value, list) else "an object"
    return json.dumps(value)[:40]


def _digits(text: str) -> tuple[Doubt, ...]:
    """Return a doubt if a few of the accelerations have another number of digits than the others."""
    match = re.search(r'"accel_data"\s*:\s*\[([^\]]*)', text)
    if match is None:
        return ()
    lines = Lines(text[: match.end()])
    first = text.count("\n", 0, match.start(1))
    return tuple(odd_digits(PrintedRows(lines, first, lambda row: re.findall(r"[^\s,\[\]]+", row.rpartition("[")[2]))))


def _is_number(value: object) -> bool:
    # An int may be too large for a float, and bool is a kind of int.
    return isinstance(value, float) or (isinstance(value, int) and not isinstance(value, bool) and abs(value) < 1 << 99)


def _line_of(text: str, key: str) -> int:
    """Return the number of the line with a key; 1 if the key is not found."""
    match = next(_places(text, key), None)
    return text.count("\n", 0, match.start()) + 1 if match else 1


def _places(text: str, key: str) -> Iterator[re.Match[str]]:
    """Yield the matches of a key in the text."""
    return re.finditer(rf"{re.escape(json.dumps(key, ensure_ascii=False))}\s*:", text)

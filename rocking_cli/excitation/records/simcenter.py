"""SimCenter JSON: an object with the interval `dT` and the list `accel_data`."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.records.layout import in_si
from rocking_cli.excitation.records.text import check_interval, only_channel, sensible
from rocking_cli.excitation.records.units import resolve_unit

TITLE = "SimCenter JSON"
SIGN = 'a JSON object with "accel_data"'


def sniff(text: str) -> bool:
    """Whether this is a JSON object with accelerations."""
    return text.lstrip().startswith("{") and '"accel_data"' in text


def read(
    text: str, file: str, *, dt: float | None = None, units: str | None = None, channel: str | None = None
) -> GroundMotion:
    """Read a SimCenter JSON file; arguments, result and errors are those of `registry.Reader.read`."""
    only_channel(file, channel)
    try:
        data: dict[str, Any] = json.loads(text)
    except (json.JSONDecodeError, RecursionError) as error:
        line, column = getattr(error, "lineno", None), getattr(error, "colno", None)
        reason = getattr(error, "msg", "it is nested too deeply")
        raise InputError(Problem(f"not valid JSON: {reason}", file=file, line=line, column=column)) from None
    unit = resolve_unit(file, [(_line_of(text, "info"), str(data.get("info", "")).replace("\n", " "))], units)

    own: Any = data.get("dT")
    if not (_is_number(own) and 0 < own < np.inf):
        message = "the interval dT is missing" if own is None else f"the interval dT must be positive, this is {own!r}"
        hint = 'it is the time between samples in seconds, such as "dT": 0.01'
        raise InputError(Problem(message, file=file, line=_line_of(text, "dT"), field="dT", hint=hint))
    check_interval(file, _line_of(text, "dT"), own, dt)

    values = data.get("accel_data")
    line = _line_of(text, "accel_data")
    if not isinstance(values, list):
        raise InputError(Problem("the accelerations must be a list of numbers", file, line, field="accel_data"))
    for place, value in enumerate(values, start=1):
        if not _is_number(value) or not sensible(value):
            message = f"value {place} is not a finite number: {str(value)[:40]}"
            raise InputError(Problem(message, file, line, field="accel_data"))
    stated = data.get("numPoints", len(values))
    if stated not in (len(values), len(values) + 1):  # a file of SimCenter's own says one too many
        message = f"the file says numPoints = {stated}, but has {len(values)} values"
        hint = "the file may have been cut short or edited: download it again, or correct numPoints"
        raise InputError(Problem(message, file, _line_of(text, "numPoints"), field="numPoints", hint=hint))
    if len(values) < 2:
        message = f"a record needs at least two samples, this has {len(values)}"
        raise InputError(Problem(message, file, line, field="accel_data"))
    return GroundMotion(Path(file).name, float(own), in_si(np.array(values, dtype=np.float64), unit), unit, TITLE)


def _is_number(value: object) -> bool:
    # A whole number may be too large for a float; true and false are whole numbers to Python.
    return isinstance(value, float) or (isinstance(value, int) and not isinstance(value, bool) and abs(value) < 1 << 99)


def _line_of(text: str, key: str) -> int:
    """Line number where a key is; 1 if it is nowhere."""
    match = re.search(rf'"{key}"\s*:', text)
    return text.count("\n", 0, match.start()) + 1 if match else 1

"""Plain data as JSON text; all JSON of the package is encoded here."""

from __future__ import annotations

import json
from collections.abc import Mapping
from math import isfinite
from typing import Any


def json_text(data: Any, *, sort_keys: bool = False, compact: bool = False) -> str:
    """Return plain data as JSON on one line.

    Parameters
    ----------
    data : object
        Mappings, sequences, texts, numbers, truth values and None; numpy's arrays and scalars too.
    sort_keys : bool
        Whether to sort the keys of mappings alphabetically.
    compact : bool
        Whether to leave out blanks.

    Returns
    -------
    str
        JSON text, in which NaN and infinity are null.

    Raises
    ------
    TypeError
        If an item has any other type.
    """
    separators = (",", ":") if compact else None
    return json.dumps(_plain(data), allow_nan=False, sort_keys=sort_keys, separators=separators)


def _plain(data: Any) -> Any:
    """Return data with Python's own types, and None for numbers that are not finite."""
    if isinstance(data, float):
        return float(data) + 0.0 if isfinite(data) else None  # + 0.0 turns -0 into 0
    if hasattr(data, "tolist"):  # arrays are recognised without importing numpy, which is slow
        return _plain(data.tolist())
    if isinstance(data, Mapping):
        return {key: _plain(value) for key, value in data.items()}
    if isinstance(data, list | tuple):
        return [_plain(each) for each in data]
    return data

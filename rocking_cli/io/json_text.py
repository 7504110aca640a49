"""Plain data as JSON text: the one encoder of all that is written as JSON."""

from __future__ import annotations

import json
from collections.abc import Mapping
from math import isfinite
from typing import Any


def json_text(data: Any, *, sort_keys: bool = False, compact: bool = False) -> str:
    """JSON of plain data on one line.

    Parameters
    ----------
    data : object
        Mappings, sequences, texts, numbers, truth values and None; numpy's arrays and scalars too.
    sort_keys : bool
        Whether the order of keys in a mapping is that of the alphabet.
    compact : bool
        Whether to leave out blanks.

    Returns
    -------
    str
        NaN and infinity are null: JSON has no such numbers.

    Raises
    ------
    TypeError
        If something in it is none of these.
    """
    separators = (",", ":") if compact else None
    return json.dumps(_plain(data), allow_nan=False, sort_keys=sort_keys, separators=separators)


def _plain(data: Any) -> Any:
    """The same of Python's own types, and None for what is no finite number."""
    if isinstance(data, float):
        return float(data) if isfinite(data) else None
    if hasattr(data, "tolist"):  # of numpy, which takes long to import where it is not needed
        return _plain(data.tolist())
    if isinstance(data, Mapping):
        return {key: _plain(value) for key, value in data.items()}
    if isinstance(data, list | tuple):
        return [_plain(each) for each in data]
    return data

"""Recorded ground motions: find out what a file is by looking inside it, and read it."""

from __future__ import annotations

import math
from pathlib import Path

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.records.registry import load_readers, reader_for, takes_bytes
from rocking_cli.files import read_bytes

__all__ = ["read_record"]

LARGEST = 2_000_000_000  # bytes; ten million samples take some 300 MB

# Bytes no text file holds. Ctrl-Z (0x1a) is allowed: DOS programs end text files with it.
_BINARY = bytes(set(range(0x20)) - set(b"\t\n\v\f\r\x1a"))


def read_record(
    path: str | Path, *, dt: float | None = None, units: str | None = None, channel: str | None = None
) -> GroundMotion:
    """Read a recorded ground motion; the format is found from the content, not from the file's name.

    Parameters
    ----------
    path : str or Path
        A file in the format of a data centre, of any reader of the entry points `rocking.records`, or delimited
        text with one column (acceleration) or two (time, acceleration).
    dt : float, optional
        Interval between samples [s]. Needed for one column; otherwise it must agree with the file.
    units : str, optional
        Unit of the accelerations in the file: g, m/s2, cm/s2, mm/s2 or gal. Needed where the file does not name
        its unit; otherwise it must agree with the file.
    channel : str, optional
        Which channel of a file with several: its place, counted from 1, or its name in the file.

    Returns
    -------
    GroundMotion
        Accelerations [m/s2] at a constant interval [s], named after the file.

    Raises
    ------
    InputError
        If the file cannot be read, or anything in it is missing, contradictory or not a number.
    """
    if dt is not None and not (math.isfinite(dt) and dt > 0):
        raise InputError(Problem(f"the sample interval must be a positive number of seconds, got {dt}", field="--dt"))
    file = str(path)
    data = read_bytes(file, "record file", LARGEST)
    text = _decoded(data, file)
    reader = reader_for(text, file, load_readers(), data)
    content = data if takes_bytes(reader) else text
    del data, text  # one of them is enough: a long record is large
    return reader.read(content, file, dt=dt, units=units, channel=channel)


def _decoded(data: bytes, file: str) -> str | None:
    """Text of a file, with plain newlines; None if it holds bytes that no text does."""
    if len(data.translate(None, _BINARY)) != len(data):
        return None
    try:
        content = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        content = data.decode("latin-1")  # older processing programs write accents and m/s² that way
    content = content.replace("\r\n", "\n").replace("\r", "\n").rstrip("\x1a")
    if not content or content.isspace():
        raise InputError(Problem("the file is empty", file=file))
    return content

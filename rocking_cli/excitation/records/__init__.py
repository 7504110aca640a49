"""Recorded ground motions: find out what a file is by looking inside it, and read it."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.records.decoding import decoded
from rocking_cli.excitation.records.opening import open_record
from rocking_cli.excitation.records.registry import load_readers, reader_for, takes_bytes

__all__ = ["read_record"]

_MESSAGE, _EXCERPT = 500, 100  # characters


def read_record(
    path: str | Path, *, dt: float | None = None, units: str | None = None, channel: str | None = None
) -> GroundMotion:
    """Read a recorded ground motion; the format is found from the content, not from the file's name.

    Parameters
    ----------
    path : str or Path
        A file in the format of a data centre, of any reader of the entry points `rocking.records`, or delimited
        text: a column of accelerations, or several, with or without the time. It may be compressed (gzip), or a file
        in a zip archive. `-` is standard input, which can be read once.
    dt : float, optional
        Interval between samples [s]. Needed for one column; otherwise it must agree with the file.
    units : str, optional
        Unit of the accelerations in the file: g, m/s2, cm/s2, mm/s2, gal, mg (a thousandth of g) or %g. Needed where
        the file does not name its unit; otherwise it must agree with the file.
    channel : str, optional
        Which channel of a file with several: its place, counted from 1, or its name in the file. Of an archive with
        several files the place or name of one, and a channel in it behind a colon: `north.V2:2`.

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
        raise InputError(Problem(f"the sample interval must be a positive number of seconds, got {dt}", field="`dt`"))
    data, file, name, member, channel = open_record(path, channel)
    text = decoded(data, file)
    reader = reader_for(text, file, load_readers(), data)
    content = data if takes_bytes(reader) else text
    del data, text  # one of them is enough: a long record is large
    try:
        motion = reader.read(content, file, dt=dt, units=units, channel=channel)
    except InputError as error:
        if type(error) is not InputError:  # of a plugin that failed: what it says is its own
            raise
        raise InputError(*map(_short, error.problems)) from None
    if Path(file).name == name:
        return motion
    # A file of an archive is named after the archive, and is one of its channels if there are several.
    inside = motion.name.removeprefix(Path(file).name).removeprefix(" channel ")
    said = ":".join(part for part in (member, inside) if part)
    return replace(motion, name=f"{name} channel {said}" if said else name)


def _short(problem: Problem) -> Problem:
    """Cut what a problem quotes of a file: a line of it may be of any length."""
    message, excerpt = problem.message, problem.excerpt
    if len(message) > _MESSAGE:
        message = f"{message[: _MESSAGE * 2 // 3]} ... {message[-_MESSAGE // 3 :]}"
    if excerpt is not None and len(excerpt) > _EXCERPT:
        excerpt = f"{excerpt[:_EXCERPT]} ..."
    return replace(problem, message=message, excerpt=excerpt)

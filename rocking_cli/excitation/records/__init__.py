"""Recorded ground motions: find out what a file is by looking inside it, and read it."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.records.decoding import decoded
from rocking_cli.excitation.records.opening import open_record
from rocking_cli.excitation.records.registry import Reader, load_readers, reader_for, takes_bytes, takes_wanted
from rocking_cli.excitation.records.sensor import QUANTITIES, Gain, Quantity, Wanted, as_acceleration

__all__ = ["read_measured", "read_record"]

_MESSAGE, _EXCERPT = 500, 100  # characters


def read_record(
    path: str | Path,
    *,
    dt: float | None = None,
    units: str | None = None,
    channel: str | None = None,
    quantity: Quantity | None = None,
    gain: str | Gain | None = None,
    uneven: bool = False,
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
        several files the place or name of one, and a channel in it behind a colon: `north.V2:2`. Of a table also
        `column 6`.
    quantity : {"acceleration", "velocity", "displacement"}, optional
        What the file holds: by default accelerations, or what the gain is of. Others are differentiated, by central
        differences; `units` is then of them.
    gain : str, optional
        What one unit of the file stands for, where its numbers are the output of an instrument: `0.05 m/V`.
    uneven : bool, optional
        Take uneven times too: the values are put on an even grid, and a remark of the motion says how uneven.

    Returns
    -------
    GroundMotion
        Accelerations [m/s2] at a constant interval [s], named after the file. Its `processing` says what was done.

    Raises
    ------
    InputError
        If the file cannot be read, or anything in it is missing, contradictory or not a number.
    """
    measured, of = read_measured(path, dt=dt, units=units, channel=channel, quantity=quantity, gain=gain, uneven=uneven)
    return as_acceleration(measured, of)


def read_measured(
    path: str | Path,
    *,
    dt: float | None = None,
    units: str | None = None,
    channel: str | None = None,
    quantity: Quantity | None = None,
    gain: str | Gain | None = None,
    uneven: bool = False,
) -> tuple[GroundMotion, Quantity]:
    """Read what was measured, in SI units in the place of accelerations, and what it is; arguments of `read_record`."""
    if dt is not None and not (math.isfinite(dt) and dt > 0):
        raise InputError(Problem(f"the sample interval must be a positive number of seconds, got {dt}", field="`dt`"))
    gain = Gain.parse(gain) if isinstance(gain, str) else gain
    wanted = _wanted(quantity, gain, units, uneven=uneven)
    data, file, name, member, channel = open_record(path, channel)
    text = decoded(data, file)
    reader = reader_for(text, file, load_readers(), data)
    content = data if takes_bytes(reader) else text
    del data, text  # one of them is enough: a long record is large
    try:
        more = {"wanted": wanted} if _must_be_asked(reader, wanted, file) else {}
        motion = reader.read(content, file, dt=dt, units=units, channel=channel, **more)
    except InputError as error:
        if type(error) is not InputError:  # of a plugin that failed: what it says is its own
            raise
        raise InputError(*map(_short, error.problems)) from None
    motion = _multiplied(motion, gain)
    if Path(file).name == name:
        return motion, wanted.quantity
    # A file of an archive is named after the archive, and is one of its channels if there are several.
    inside = motion.name.removeprefix(Path(file).name).removeprefix(" channel ")
    said = ":".join(part for part in (member, inside) if part)
    return replace(motion, name=f"{name} channel {said}" if said else name), wanted.quantity


def _wanted(quantity: Quantity | None, gain: Gain | None, units: str | None, *, uneven: bool) -> Wanted:
    """What is asked of the reader, once the arguments agree."""
    if quantity is not None and quantity not in QUANTITIES:
        raise InputError(Problem(f"must be one of {', '.join(QUANTITIES)}, got '{quantity}'", field="`from`"))
    if gain is None:
        return Wanted(quantity or "acceleration", uneven=uneven)
    if quantity is not None and quantity != gain.quantity:
        message = f"{gain} is of a {gain.quantity}, but `from` says {quantity}"
        raise InputError(Problem(message, field="`gain`", hint="leave `from` out: the gain says it"))
    if units is not None:
        message = "the gain says what unit the values become"
        raise InputError(Problem(message, field="`units`", hint="leave `units` or `gain` out"))
    return Wanted(gain.quantity, raw=True, uneven=uneven)


def _must_be_asked(reader: Reader, wanted: Wanted, file: str) -> bool:
    """Whether a reader is told what is wanted; one that cannot be asked has accelerations alone, in a unit it knows."""
    if takes_wanted(reader):
        return True
    if wanted.raw or wanted.quantity != "acceleration":
        message = f"a file of this format ({reader.TITLE}) gives accelerations, and says their unit"
        raise InputError(Problem(message, file, hint="leave `gain` and `from` out"))
    return False


def _multiplied(motion: GroundMotion, gain: Gain | None) -> GroundMotion:
    if gain is None:
        return motion
    said = (*motion.processing, f"gain {gain}")
    return replace(motion, acceleration=gain.size * motion.acceleration, unit=gain.text, processing=said)


def _short(problem: Problem) -> Problem:
    """Cut what a problem quotes of a file: a line of it may be of any length."""
    message, excerpt = problem.message, problem.excerpt
    if len(message) > _MESSAGE:
        message = f"{message[: _MESSAGE * 2 // 3]} ... {message[-_MESSAGE // 3 :]}"
    if excerpt is not None and len(excerpt) > _EXCERPT:
        excerpt = f"{excerpt[:_EXCERPT]} ..."
    return replace(problem, message=message, excerpt=excerpt)

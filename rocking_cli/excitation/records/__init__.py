"""Readers of recorded ground motions, chosen by the content of the file."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from rocking_cli.errors import InputError, Problem, named
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.records.formats import Reader, load_readers, reader_for, takes_bytes, takes_wanted
from rocking_cli.excitation.records.lines import Lines
from rocking_cli.excitation.records.opening import decoded, open_record
from rocking_cli.excitation.records.record_units import Gain, Quantity, Wanted
from rocking_cli.excitation.records.text import TITLE, Followed

_MESSAGE, _EXCERPT = 500, 100  # largest numbers of characters that are shown


def read_measured(
    path: str | Path,
    *,
    dt: float | None = None,
    units: str | None = None,
    channel: str | None = None,
    quantity: Quantity | None = None,
    gain: Gain | None = None,
    uneven: bool = False,
    run_on: bool = False,
    despite_header: bool = False,
) -> tuple[GroundMotion, Quantity]:
    """Read measured values and their quantity; the format is found from the content, not from the file's name.

    Parameters
    ----------
    path : str or Path
        A file in the format of a data centre, of any reader of the entry points `rocking.records`, or delimited
        text: a column of accelerations, or several, with or without the time. It may be compressed (gzip), or a file
        in a zip archive. `-` is standard input, which can be read once.
    dt : float, optional
        Sampling interval [s]. Required for a file of one column; otherwise it must agree with the file.
    units : str, optional
        Unit of the accelerations in the file: g, m/s2, cm/s2, mm/s2, gal, mg (a thousandth of g) or %g. Required if the
        file does not state its unit; otherwise it must agree with the file.
    channel : str, optional
        Channel of a file with several: its number, from 1, or its name in the file. For an archive with several files,
        the number or name of a file, with the channel after a colon: `north.V2:2`. For a table also `column 6`.
    quantity : {"acceleration", "velocity", "displacement"}, optional
        Quantity in the file: by default accelerations, or the quantity of the gain. Velocities and displacements, whose
        unit `units` then is, are differentiated by central differences.
    gain : Gain, optional
        Value of one unit of the file, if its numbers are the output of an instrument.
    uneven : bool, optional
        Whether to accept uneven times: the values are interpolated to an even grid, and a remark states how uneven the
        times are.
    run_on : bool, optional
        Whether the values of a text without times are one series that runs on over the rows, from left to right.
    despite_header : bool, optional
        Whether to accept a text with other numbers of points or peaks than its header states; a remark states them.

    Returns
    -------
    GroundMotion
        The values, in SI units in place of accelerations, at a constant interval [s]; it is named after the file.
    str
        Their quantity.

    Raises
    ------
    InputError
        If the file cannot be read, or anything in it is missing, contradictory or not a number.
    """
    if not isinstance(path, str | Path):
        hint = 'samples are a ground motion by GroundMotion("mine", 0.01, samples, unit="g")'
        raise InputError(Problem(f"must be a file, got {type(path).__name__}", field="`path`", hint=hint))
    wanted = _wanted(quantity, gain, units)._replace(uneven=uneven, run_on=run_on, despite_header=despite_header)
    data, file, name, member, channel = open_record(path, channel)
    text = decoded(data, file)
    reader = reader_for(text, file, load_readers(), data)
    content = data if takes_bytes(reader) else text
    del data, text  # frees memory, as a long record is large
    try:
        more: dict[str, Any] = {"wanted": wanted} if _must_be_asked(reader, wanted, file) else {}
        read = partial(reader.read, dt=dt, units=units, **more)
        try:
            motion = read(content, file, channel=channel)
        except Followed as error:
            motion = _of_several(str(content), file, reader, read, channel, error)
    except InputError as error:
        if type(error) is not InputError:  # errors of plugins keep their own message
            raise
        raise InputError(*map(_short, error.problems)) from None
    if gain is not None:
        processing = (*motion.processing, f"gain {gain}")
        motion = replace(
            motion, acceleration=gain.size * motion.acceleration, source_unit=gain.text, processing=processing
        )
    if Path(file).name == name:
        return motion, wanted.quantity
    # A motion from an archive is named after the archive; its file counts as a channel.
    inside = motion.name.removeprefix(Path(file).name).removeprefix(" channel ")
    chosen = ":".join(part for part in (member, inside) if part)
    return replace(motion, name=f"{name} channel {chosen}" if chosen else name), wanted.quantity


def _of_several(
    text: str, file: str, reader: Reader, read: Callable[..., GroundMotion], channel: str | None, error: Followed
) -> GroundMotion:
    """Return the requested one of several records that follow each other, or raise `error` if these are none."""
    lines, starts, followed = Lines(text), [0], error
    while True:
        starts.append(starts[-1] + followed.end)
        rest = "\n".join(lines[starts[-1] :])
        if not reader.sniff(rest):
            raise followed
        try:
            read(rest, file, channel="1")
        except Followed as more:
            followed = more
            continue
        except InputError:  # raised again if this record is chosen
            pass
        break
    number, _, inside = (channel or "").partition(":")
    if not (number.isdecimal() and 1 <= int(number) <= len(starts)):
        wrong = f", none of which is called '{channel}'" if channel else ", and only one can shake a structure"
        listed = "".join(f"\n    {k}: line {start + 1}, {lines[start].strip()}" for k, start in enumerate(starts, 1))
        hint = f"choose one with {named('channel')}, and a channel in it behind a colon:{listed}"
        raise InputError(Problem(f"the file holds {len(starts)} records{wrong}", file, hint=hint))
    start, end = [*starts, len(lines)][int(number) - 1 : int(number) + 1]
    try:
        motion = read("\n".join(lines[start:end]), file, channel=inside or None)
    except InputError as wrong:
        raise InputError(*(replace(each, line=each.line and each.line + start) for each in wrong.problems)) from None
    inside = motion.name.removeprefix(Path(file).name).removeprefix(" channel ")
    return replace(motion, name=f"{Path(file).name} channel {':'.join(filter(None, (number, inside)))}")


def _wanted(quantity: Quantity | None, gain: Gain | None, units: str | None) -> Wanted:
    """Return the request to the reader, after checking that the arguments agree."""
    if gain is None:
        return Wanted(quantity or "acceleration")
    if quantity is not None and quantity != gain.quantity:
        message = f"{gain} is of a {gain.quantity}, but {named('quantity')} says {quantity}"
        raise InputError(Problem(message, field=named("gain"), hint=f"leave {named('quantity')} out: the gain says it"))
    if units is not None:
        message = "the gain says what unit the values become"
        raise InputError(Problem(message, field=named("units"), hint=f"leave {named('units')} or {named('gain')} out"))
    return Wanted(gain.quantity, raw=True)


def _must_be_asked(reader: Reader, wanted: Wanted, file: str) -> bool:
    """Return whether a reader takes a request (`Wanted`).

    Raises `InputError` if it does not, and something other than accelerations is requested.
    """
    for name in ("run_on", "despite_header"):
        if getattr(wanted, name) and reader.TITLE != TITLE:
            message = f"has no effect on a file of this format ({reader.TITLE})"
            raise InputError(Problem(message, file, field=named(name), hint="leave it out"))
    if takes_wanted(reader):
        return True
    if wanted.raw or wanted.quantity != "acceleration":
        message = f"a file of this format ({reader.TITLE}) gives accelerations, and says their unit"
        raise InputError(Problem(message, file, hint=f"leave {named('gain')} and {named('quantity')} out"))
    return False


def _short(problem: Problem) -> Problem:
    """Shorten what a problem quotes from a file, as its lines may have any length."""
    message, excerpt = problem.message, problem.excerpt
    if len(message) > _MESSAGE:
        message = f"{message[: _MESSAGE * 2 // 3]} ... {message[-_MESSAGE // 3 :]}"
    if excerpt is not None and len(excerpt) > _EXCERPT:
        excerpt = f"{excerpt[:_EXCERPT]} ..."
    return replace(problem, message=message, excerpt=excerpt)

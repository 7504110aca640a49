"""Prepared records: ground motions as text below what was done to them, read back with identical numbers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from importlib.metadata import version
from itertools import takewhile
from pathlib import Path
from typing import BinaryIO, NamedTuple

import numpy as np

from rocking_cli.errors import InputError, Problem, named
from rocking_cli.excitation.base import NOT_SAID, Doubt, GroundMotion, Origin
from rocking_cli.excitation.records.statements import origin
from rocking_cli.text import one_line, regex

COLUMNS = "t [s],a [m/s2]\n"  # metres, as any other unit would round the accelerations when read again
MARK = "# Prepared by rocking-cli"
ITEMS = ("from", "done", *NOT_SAID._fields)
"""Items of the lines below the mark: the file, the steps in order, and its origin; further lines have its doubts."""
_NUMBER = r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?"
_LINE = regex(
    rf"# ?(?:(from|done|event|station|(?:magnitude|distance)(?=: *{_NUMBER}$)): *(.+)|"
    rf"doubt: *(\w+) ({_NUMBER}|-?inf|nan) (.+))"
)
LINES_PER_BLOCK = 10_000  # written at a time, so that the text of a long record is never in memory


def is_record_csv(path: Path) -> bool:
    """Return whether a file begins as files of `write_record_csv` do."""
    if not path.is_file():
        return False
    with path.open("rb") as file:
        return file.read(len(MARK)) == MARK.encode()


def write_record_csv(stream: BinaryIO, motion: GroundMotion) -> None:
    """Write time [s] and acceleration [m/s2], one sample per line, below what was done, to which file.

    Parameters
    ----------
    stream : binary file
        Stream to write to.
    motion : GroundMotion
        The motion. Its accelerations are read back identical, and its sampling interval identical or within the last
        bit.

    Raises
    ------
    InputError
        If the motion has a vertical component, which has no place in the file.
    """
    if motion.vertical is not None:
        hint = f"write the component {named('vertical')} of the motion to a file of its own"
        raise InputError(Problem("a file holds one component, and this motion has two", motion.name, hint=hint))
    head = (f"{MARK} {version('rocking-cli')}", *(f"# {name}: {value}" for name, value in _items(motion)))
    stream.write("".join(f"{one_line(line)}\n" for line in head).encode("utf-8", "replace"))
    stream.write(COLUMNS.encode())
    last = motion.npts - 1
    for start in range(0, motion.npts, LINES_PER_BLOCK):
        values = (motion.acceleration[start : start + LINES_PER_BLOCK] + 0.0).tolist()  # + 0.0 turns -0 into 0
        times = [f"{(start + k) * motion.dt:.12g}" for k in range(len(values))]
        if start + len(values) > last:
            times[-1] = _last_time(motion.dt, last)
        lines = (f"{time},{value!r}\n" for time, value in zip(times, values, strict=True))
        stream.write("".join(lines).encode())


def _items(motion: GroundMotion) -> Iterator[tuple[str, object]]:
    """Yield what the header says about a motion, by name."""
    yield "from", motion.prepared_from or motion.name
    yield from (("done", step) for step in motion.processing)
    yield from (("doubt", f"{each.kind} {float(each.value)} {each.text}") for each in motion.remarks)
    yield from ((name, value) for name, value in motion.origin._asdict().items() if value is not None)


class PreparedHeader(NamedTuple):
    """The numbers of the lines of the header of a prepared record, from 1, and what they say, as a `GroundMotion`."""

    lines: range = range(0)
    prepared_from: str = ""
    processing: tuple[str, ...] = ()
    remarks: tuple[Doubt, ...] = ()
    origin: Origin = NOT_SAID


def read_header(file: str, head: Sequence[str]) -> PreparedHeader:
    """Return the header of a prepared record among the lines above the numbers of a file; none says nothing.

    Raises `InputError` at a line that is none of such a header.
    """
    start = next((number for number, line in enumerate(head, 1) if line.startswith(MARK)), None)
    if start is None:
        return PreparedHeader()
    end, doubts, items = start, list[Doubt](), {name: list[str]() for name in ITEMS}
    for line in takewhile(lambda each: each.startswith("#"), head[start:]):
        end += 1
        match = _LINE.fullmatch(line.rstrip(",; \t"))  # spreadsheets fill rows with empty cells
        if match is None:
            hint = (
                f"a line has one of {', '.join(ITEMS)} and doubt, such as `# from: north.AT2`; comments of your own "
                f"go above `{MARK}`, and without the header the file is read as any other"
            )
            message = "this line is none of the header of a prepared record"
            raise InputError(Problem(message, file, end, excerpt=line[:100], hint=hint))
        if match[1]:
            items[match[1]].append(match[2])
        else:
            doubts.append(Doubt(match[3], float(match[4]), match[5]))
    if len(items["from"]) != 1:
        raise InputError(Problem("the header of a prepared record does not name its file, or several", file, start))
    whence = origin(*(next(iter(items[name]), None) for name in NOT_SAID._fields))
    return PreparedHeader(range(start, end + 1), items["from"][0], tuple(items["done"]), tuple(doubts), whence)


def _last_time(dt: float, intervals: int) -> str:
    """Return the last time as text, such that the reader, dividing it by `intervals`, obtains dt if possible."""
    product = dt * intervals
    rounded = float(f"{product:.12g}")
    candidates = (rounded, product, float(np.nextafter(product, 0.0)), float(np.nextafter(product, np.inf)))
    return repr(next((time for time in candidates if time / intervals == dt), product))

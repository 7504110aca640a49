"""Ground motions as comma-separated text, which the reader of delimited text reads back with identical numbers."""

from __future__ import annotations

from pathlib import Path
from typing import BinaryIO

import numpy as np

from rocking_cli.excitation.base import GroundMotion
from rocking_cli.text import one_line

HEADER = "t [s],a [m/s2]\n"  # metres, as any other unit would round the accelerations when read again
DONE_PREFIX = "# processed: "  # starts the line above the header in files of corrected records
MAX_DONE_BYTES = 10_000
LINES_PER_BLOCK = 10_000  # written at a time, so that the text of a long record is never in memory


def is_record_csv(path: Path) -> bool:
    """Return whether a file begins as files of `write_record_csv` do."""
    if not path.is_file():
        return False
    with path.open("rb") as file:
        first = file.readline(MAX_DONE_BYTES)
        return first == HEADER.encode() or (
            first.startswith(DONE_PREFIX.encode()) and file.readline(len(HEADER)) == HEADER.encode()
        )


def write_record_csv(stream: BinaryIO, motion: GroundMotion) -> None:
    """Write time [s] and acceleration [m/s2], one sample per line, below a comment on the processing, if any.

    Parameters
    ----------
    stream : binary file
        Stream to write to.
    motion : GroundMotion
        The motion. Its accelerations are read back identical, and its sampling interval identical or within the last
        bit.
    """
    if motion.processing:
        stream.write(one_line(f"{DONE_PREFIX}{', '.join(motion.processing)}")[: MAX_DONE_BYTES - 1].encode() + b"\n")
    stream.write(HEADER.encode())
    last = motion.npts - 1
    for start in range(0, motion.npts, LINES_PER_BLOCK):
        values = (motion.acceleration[start : start + LINES_PER_BLOCK] + 0.0).tolist()  # + 0.0 turns -0 into 0
        times = [f"{(start + k) * motion.dt:.12g}" for k in range(len(values))]
        if start + len(values) > last:
            times[-1] = _last_time(motion.dt, last)
        lines = (f"{time},{value!r}\n" for time, value in zip(times, values, strict=True))
        stream.write("".join(lines).encode())


def _last_time(dt: float, intervals: int) -> str:
    """Return the last time as text, such that the reader, dividing it by `intervals`, obtains dt if possible."""
    product = dt * intervals
    rounded = float(f"{product:.12g}")
    candidates = (rounded, product, float(np.nextafter(product, 0.0)), float(np.nextafter(product, np.inf)))
    return repr(next((time for time in candidates if time / intervals == dt), product))

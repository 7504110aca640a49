"""Ground motions as comma-separated text, which the reader of delimited text reads back with identical numbers."""

from __future__ import annotations

from pathlib import Path
from typing import BinaryIO

import numpy as np

from rocking_cli.excitation.base import GroundMotion
from rocking_cli.text import one_line

HEADER = "t [s],a [m/s2]\n"  # metres: any other unit would round the accelerations on the way back
DONE = "# processed: "  # begins the line above it, of a record that was corrected
MOST = 10_000  # bytes of the line that says what was done
BLOCK = 10_000  # lines written at a time: a long record never stands in memory as text


def is_record_csv(path: Path) -> bool:
    """Return whether a file begins as files of `write_record_csv` do."""
    with path.open("rb") as file:
        first = file.readline(MOST)
        return first == HEADER.encode() or (
            first.startswith(DONE.encode()) and file.readline(len(HEADER)) == HEADER.encode()
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
        stream.write(one_line(f"{DONE}{', '.join(motion.processing)}")[: MOST - 1].encode() + b"\n")
    stream.write(HEADER.encode())
    last = motion.npts - 1
    for start in range(0, motion.npts, BLOCK):
        values = (motion.acceleration[start : start + BLOCK] + 0.0).tolist()  # no -0
        times = [f"{(start + k) * motion.dt:.12g}" for k in range(len(values))]
        if start + len(values) > last:
            times[-1] = _last_time(motion.dt, last)
        lines = (f"{time},{value!r}\n" for time, value in zip(times, values, strict=True))
        stream.write("".join(lines).encode())


def _last_time(dt: float, intervals: int) -> str:
    """Return the last time as text, such that the reader, dividing it by `intervals`, obtains dt if possible."""
    product = dt * intervals
    rounded = float(f"{product:.12g}")
    near = (rounded, product, float(np.nextafter(product, 0.0)), float(np.nextafter(product, np.inf)))
    return repr(next((time for time in near if time / intervals == dt), product))

"""MiniSEED, version 2: records of a few thousand bytes, each with the channel's code and time, and without a unit."""

from __future__ import annotations

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import MOST_SAMPLES, GroundMotion
from rocking_cli.excitation.records import formats
from rocking_cli.excitation.records.layout import CUT, choose
from rocking_cli.excitation.records.record_units import Asked
from rocking_cli.excitation.records.seismo import channels_of, traces

MAX_BYTES = 4 * MOST_SAMPLES  # four bytes per sample, as without compression


def read(data: bytes, file: str, asked: Asked) -> GroundMotion:
    """Read a miniSEED file; see `registry.Reader.read`."""
    if data.startswith(b"MS\x03"):
        hint = "convert it to miniSEED 2 first"
        raise InputError(Problem("this is miniSEED 3, which obspy does not read", file, hint=hint))
    if len(data) > MAX_BYTES:
        message = f"the file has {len(data) / 1e6:.4g} MB: a record of at most {MOST_SAMPLES} samples has less"
        raise InputError(Problem(message, file, hint="cut the motion out of the file first"))
    unit = asked.unit(file, [])
    traces_read = traces(data, file, "MSEED")
    # obspy ignores an incomplete last record.
    if len(data) % min(trace.stats.mseed.record_length for trace in traces_read):
        raise InputError(Problem("the file ends in the middle of a record", file, hint=CUT))
    return choose(file, formats.miniseed.TITLE, channels_of(file, traces_read, unit, asked.wanted), asked)

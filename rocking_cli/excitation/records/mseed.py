"""MiniSEED, version 2: records of a few thousand bytes, each with the channel's code and time, and without a unit."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import MOST_SAMPLES, GroundMotion
from rocking_cli.excitation.records.layout import choose
from rocking_cli.excitation.records.record_units import Wanted
from rocking_cli.excitation.records.seismo import channel_of, origin_of, traces, velocity_code

TITLE = "miniSEED"
SIGN = "a binary header with six digits and D, R, Q or M, or with MS and 3, then a date"
BINARY = True
TAKES_WANTED = True

_HEADER_BYTES = 48
MAX_BYTES = 4 * MOST_SAMPLES  # four bytes per sample, as without compression
_YEARS = range(1900, 2101)
_DAYS = range(1, 367)


def sniff(data: bytes) -> bool:
    """Return whether the first bytes are the header of a record with a valid date."""
    if len(data) < _HEADER_BYTES:
        return False
    if _version_3(data):
        dates = [struct.unpack_from("<HH", data, 8)]
    elif not data[:6].strip(b"0123456789 \0") and data[6:7] in (b"D", b"R", b"Q", b"M") and data[7:8] in (b" ", b"\0"):
        dates = [struct.unpack_from(f"{order}HH", data, 20) for order in "><"]
    else:
        return False
    return any(year in _YEARS and day in _DAYS for year, day in dates)


def read(
    data: bytes,
    file: str,
    *,
    dt: float | None = None,
    units: str | None = None,
    channel: str | None = None,
    wanted: Wanted = Wanted(),  # noqa: B008 - it does not change
) -> GroundMotion:
    """Read a miniSEED file; arguments, result and errors are those of `registry.Reader.read`."""
    if _version_3(data):
        hint = "convert it to miniSEED 2 first"
        raise InputError(Problem("this is miniSEED 3, which obspy does not read", file, hint=hint))
    if len(data) > MAX_BYTES:
        message = f"the file has {len(data) / 1e6:.4g} MB: a record of at most {MOST_SAMPLES} samples has less"
        raise InputError(Problem(message, file, hint="cut the motion out of the file first"))
    unit = wanted.unit(file, [], units)
    segments: dict[str, list[Any]] = {}
    for trace in traces(data, file, "MSEED"):
        segments.setdefault(trace.id, []).append(trace)
    # obspy ignores an incomplete last record.
    if len(data) % min(trace.stats.mseed.record_length for parts in segments.values() for trace in parts):
        message = "the file ends in the middle of a record"
        raise InputError(Problem(message, file, hint="it was cut short: download it again"))
    codes = {name: parts[0].stats.channel for name, parts in segments.items()}
    if len(set(codes.values())) == len(codes):  # unique channel codes need no station and network
        segments = {codes[name]: parts for name, parts in segments.items()}
    channels = []
    for name, parts in segments.items():  # obspy splits a channel at gaps
        parts = sorted(parts, key=lambda segment: segment.stats.starttime)
        flaw = velocity_code(file, parts[0].stats.channel, wanted) or _gap(file, name, parts)
        samples = np.concatenate([segment.data for segment in parts])
        joined = channel_of(file, name, parts[0].stats.delta, samples, unit, flaw)
        channels.append(replace(joined, origin=origin_of(parts[0])))
    return choose(file, TITLE, channels, channel, dt)


def _version_3(data: bytes) -> bool:
    return data.startswith(b"MS\x03")


def _gap(file: str, name: str, segments: Sequence[Any]) -> Problem | None:
    """Return the problem of the first gap in time between two segments; None if there is none."""
    count = 0
    for one, two in pairwise(segments):
        count += one.stats.npts
        where = f"after sample {count}, at {one.stats.endtime}"
        if not np.isclose(one.stats.delta, two.stats.delta, rtol=1e-6):
            message = f"channel {name} goes from {one.stats.delta:g} s to {two.stats.delta:g} s between samples {where}"
            return Problem(message, file, hint="resample it at a constant interval first")
        missing = two.stats.starttime - one.stats.endtime - one.stats.delta
        if abs(missing) > one.stats.delta / 2:
            message = f"channel {name} has {'a gap' if missing > 0 else 'an overlap'} of {abs(missing):g} s {where}"
            return Problem(message, file, hint="give a file that holds the whole motion without a break")
    return None

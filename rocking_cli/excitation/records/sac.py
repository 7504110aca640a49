"""SAC, versions 6 and 7, binary: a header of 158 words without a unit, then the samples of one component."""

from __future__ import annotations

import struct
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rocking_cli.errors import InputError, Problem, named
from rocking_cli.excitation.base import MOST_SAMPLES, Doubt, GroundMotion
from rocking_cli.excitation.records import formats
from rocking_cli.excitation.records.layout import CUT, choose
from rocking_cli.excitation.records.record_units import Asked
from rocking_cli.excitation.records.seismo import channel_of, origin_of, traces, velocity_code

_HEADER, _FOOTER = 632, 176  # bytes; version 7 repeats part of the header at its end, in double precision
_VERSIONS = (6, 7)
_TIME_SERIES, _XY = 1, 4  # values of the field IFTYPE: time series, and x against y
_ACCELERATION_KIND = 8  # value of the field IDEP for accelerations
_UNSET = -12345.0
_EXTREMES_TOLERANCE = 1e-5  # relative difference; the extremes have 32 bits
_OTHER_QUANTITIES = {6: "displacement", 7: "velocity", 50: "voltage"}
_WITH_ARTICLE = {"acceleration": "an acceleration", "velocity": "a velocity", "displacement": "a displacement"}


@dataclass(frozen=True)
class _SacHeader:
    """Content of the header: interval [s], extremes, version, number of points, kind of file and values, evenness."""

    delta: float
    least: float
    most: float
    version: int
    npts: int
    kind: int
    quantity: int
    even: int


def read(data: bytes, file: str, asked: Asked) -> GroundMotion:
    """Read a SAC file; see `registry.Reader.read`."""
    header = _header(data)
    if not header.even:
        hint = "interpolate it at a constant interval first"
        raise InputError(Problem("the header says the samples are unevenly spaced (LEVEN)", file, hint=hint))
    if header.kind not in (_TIME_SERIES, _XY):
        message = f"the header says this is not a time series (IFTYPE = {header.kind})"
        raise InputError(Problem(message, file, hint="give the file with the acceleration"))
    quantity = _OTHER_QUANTITIES.get(header.quantity, asked.wanted.quantity)
    if quantity != asked.wanted.quantity and not asked.wanted.raw:
        message = f"the header says the values are a {quantity}, not {_WITH_ARTICLE[asked.wanted.quantity]} (IDEP)"
        raise InputError(
            Problem(message, file, hint=f"give the file with the acceleration, or say {named('quantity')} what it is")
        )
    if header.npts > MOST_SAMPLES:
        message = f"the header says {header.npts} points: a record has at most {MOST_SAMPLES}"
        raise InputError(Problem(message, file))
    size = _HEADER + 4 * header.npts
    if len(data) != size + (_FOOTER if header.version == 7 else 0):
        message = f"the header says {header.npts} points, which do not make the {len(data)} bytes of the file"
        raise InputError(Problem(message, file, hint=CUT))
    unit = asked.unit(file, [])
    (trace,) = traces(data[:size], file, "SAC")
    name = trace.stats.channel
    flaw = None if header.quantity == _ACCELERATION_KIND else velocity_code(file, name, asked.wanted)
    # The interval is a 32-bit float, 0.004999999888 for 0.005; its shortest decimal form restores it.
    interval = float(str(np.float32(header.delta)))
    only = channel_of(file, name, interval, trace.data, unit, flaw)
    only = replace(only, remarks=_extremes(header, trace.data), origin=origin_of(trace))
    return choose(file, formats.sac.TITLE, [only], asked)


def _extremes(header: _SacHeader, samples: NDArray[np.float32]) -> tuple[Doubt, ...]:
    """Return a doubt if the smallest or largest sample differs from that in the header, if there is one."""
    if not samples.size or _UNSET in (header.least, header.most):
        return ()
    least, most = float(samples.min()), float(samples.max())
    size = max(abs(header.least), abs(header.most), abs(least), abs(most))
    if max(abs(least - header.least), abs(most - header.most)) <= _EXTREMES_TOLERANCE * size:
        return ()
    text = (
        f"its header says the samples go from {header.least:g} to {header.most:g} (DEPMIN, DEPMAX), they go from "
        f"{least:g} to {most:g}: a damaged file, or processed since?"
    )
    return (Doubt("header_peak", max(abs(least), abs(most)), text),)


def _header(data: bytes) -> _SacHeader:
    """Read the header in the byte order that gives a valid version, as one does for a file of the format."""
    both = (_SacHeader(*struct.unpack_from(f"{order}fff292xi8xi20xii72xi", data)) for order in "<>")
    return next(header for header in both if header.version in _VERSIONS)

"""Seismological formats, which obspy reads and which need not hold accelerations or state a unit.

SAC, versions 6 and 7: a header of 158 words without a unit, then the samples of one component. MiniSEED, version 2:
records of a few thousand bytes, each with the channel's code and time. And SLIST, TSPAIR, GSE, Kinemetrics EVT, REFTEK,
WIN and more.
"""

from __future__ import annotations

import io
import struct
import warnings
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from importlib import import_module
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Reals
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.excitation.base import MOST_SAMPLES, STANDARD_GRAVITY, Doubt, GroundMotion, Origin
from rocking_cli.excitation.records import formats
from rocking_cli.excitation.records.layout import CUT, Channel, choose
from rocking_cli.excitation.records.record_units import Asked, Wanted
from rocking_cli.excitation.records.statements import origin
from rocking_cli.excitation.records.text import sensible, usable
from rocking_cli.plugins.registry import find
from rocking_cli.text import regex
from rocking_cli.units import UNITS

# SEED names a channel by band, instrument and direction; instruments H, L and P measure velocity.
_VELOCITY_CODE = regex(r"[A-Z][HLP][A-Z0-9]")
_MAX_ACCELERATION = (
    10 * STANDARD_GRAVITY
)  # m/s2; larger whole numbers are counts, as no earthquake has reached half of it


def traces(data: bytes, file: str, form: str) -> list[Any]:
    """Read the traces of a file with obspy, by its name of the format; `file` is the path, for messages.

    Raises `InputError` if obspy is not installed, or cannot read the file or a part of it.
    """
    with warnings.catch_warnings(record=True) as warned:
        obspy = obspy_for(file)
        warnings.simplefilter("always", import_module("obspy.io.mseed").InternalMSEEDWarning)  # data that it skips
        try:
            read = list(obspy.read(io.BytesIO(data), format=form))
        except Exception as error:  # obspy raises many kinds of errors, without a common base
            message = f"obspy cannot read this file: {_in_a_line(error)}"
            raise InputError(Problem(message, file, hint=CUT)) from None
    if warned:
        message = f"obspy has doubts about this file: {_in_a_line(warned[0].message)}"
        hint = "it may be damaged: download it again; if you know it is whole, write it again with obspy"
        raise InputError(Problem(message, file, hint=hint))
    return read


def obspy_for(file: str) -> Any:
    """Import obspy for a file, and ignore what it warns of; raise `InputError` if it is not installed."""
    warnings.simplefilter("ignore")  # deprecations in obspy do not concern the user
    try:
        return import_module("obspy")
    except ImportError as error:
        message = f"obspy, which reads such files, cannot be imported: {error}"
        hint = "install it: pip install 'rocking-cli[seismo]'"
        raise InputError(Problem(message, file, hint=hint)) from None


def origin_of(trace: Any) -> Origin:
    """Return network and station of a trace; for SAC also the earthquake, its magnitude and its distance [km]."""
    stats = trace.stats
    station = ".".join(part for part in (str(stats.network).strip(), str(stats.station).strip()) if part)
    sac = stats.get("sac", {})
    return origin(str(sac.get("kevnm", "")), station, sac.get("mag"), sac.get("dist"))


def channel_of(
    file: str, name: str, dt: float, samples: NDArray[Any], unit: tuple[str, float], flaw: Problem | None
) -> Channel:
    """Make a channel of samples, with the flaw of its header or else the first one of its samples.

    `unit` is the name and size of the samples' unit, which these formats do not state.
    """
    values = samples.astype(np.float64) if samples.dtype.kind in "iuf" else np.full(samples.size, np.nan)
    flaw = flaw or _flaw(file, name, values, unit, whole=samples.dtype.kind in "iu")
    return Channel(name, dt, values if flaw else values * unit[1], unit[0], flaw=flaw)


def channels_of(file: str, found: Iterable[Any], unit: tuple[str, float], wanted: Wanted) -> list[Channel]:
    """Make a channel of the traces of each one, which obspy splits at gaps; one with a gap has a flaw."""
    segments: dict[str, list[Any]] = {}
    for trace in found:
        segments.setdefault(trace.id, []).append(trace)
    codes = {name: parts[0].stats.channel for name, parts in segments.items()}
    if len(set(codes.values())) == len(codes):  # unique channel codes need no station and network
        segments = {codes[name]: parts for name, parts in segments.items()}
    channels = []
    for name, parts in segments.items():
        parts = sorted(parts, key=lambda segment: segment.stats.starttime)
        flaw = velocity_code(file, parts[0].stats.channel, wanted) or _gap(file, name, parts)
        samples = np.concatenate([segment.data for segment in parts])
        joined = channel_of(file, name, parts[0].stats.delta, samples, unit, flaw)
        channels.append(replace(joined, origin=origin_of(parts[0])))
    return channels


def velocity_code(file: str, code: str, wanted: Wanted) -> Problem | None:
    """Return the problem that a channel code is that of a velocity instrument, if accelerations are requested."""
    if wanted.quantity != "acceleration" or not _VELOCITY_CODE.fullmatch(code):
        return None
    message = f"channel {code} is of a seismometer, which records velocity, not of an accelerometer"
    hint = (
        "give the accelerometer's channel, such as HNE; name one so that was converted to "
        f"acceleration; or say {named('quantity')} "
        "velocity"
    )
    return Problem(message, file, hint=hint)


def _flaw(file: str, name: str, values: Reals, unit: tuple[str, float], *, whole: bool) -> Problem | None:
    """Return the problem of samples that are not numbers, or are counts of a digitiser; None if there is none."""
    who = f"channel {name}" if name else "the file"
    if not values.size:
        return Problem(f"{who} has no samples", file)
    if not usable(values):
        place = next(index for index, value in enumerate(values.tolist()) if not sensible(value))
        message = f"sample {place + 1} of {who} is not a finite number of sensible size: {values[place]:g}"
        return Problem(message, file, hint="repair the record first: every sample must have a value")
    peak = float(np.abs(values * unit[1]).max())
    if whole and peak > _MAX_ACCELERATION and unit[0] in UNITS:
        message = f"{who} has whole numbers with a peak of {peak / STANDARD_GRAVITY:.4g} g, if in {unit[0]}: raw counts"
        hint = f"give {named('gain')}, such as 4.7e-6 m/s2/count, or convert them: "
        hint += "remove_response(output='ACC') in obspy gives m/s2"
        return Problem(message, file, hint=hint)
    return None


def _in_a_line(reason: object) -> str:
    return " ".join(str(reason).split())


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


MAX_MINISEED_BYTES = 4 * MOST_SAMPLES  # four bytes per sample, as without compression


def read_miniseed(data: bytes, file: str, asked: Asked) -> GroundMotion:
    """Read a miniSEED file; see `formats.Reader.read`."""
    if data.startswith(b"MS\x03"):
        hint = "convert it to miniSEED 2 first"
        raise InputError(Problem("this is miniSEED 3, which obspy does not read", file, hint=hint))
    if len(data) > MAX_MINISEED_BYTES:
        message = f"the file has {len(data) / 1e6:.4g} MB: a record of at most {MOST_SAMPLES} samples has less"
        raise InputError(Problem(message, file, hint="cut the motion out of the file first"))
    unit = asked.unit(file, [])
    traces_read = traces(data, file, "MSEED")
    # obspy ignores an incomplete last record.
    if len(data) % min(trace.stats.mseed.record_length for trace in traces_read):
        raise InputError(Problem("the file ends in the middle of a record", file, hint=CUT))
    return choose(file, formats.miniseed.TITLE, channels_of(file, traces_read, unit, asked.wanted), asked)


_HEADER, _FOOTER = 632, 176  # bytes; version 7 repeats part of the header at its end, in double precision
_SAC_VERSIONS = (6, 7)
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


def read_sac(data: bytes, file: str, asked: Asked) -> GroundMotion:
    """Read a SAC file; see `formats.Reader.read`."""
    # In the byte order that gives a valid version, as one does for a file of the format.
    both = (_SacHeader(*struct.unpack_from(f"{order}fff292xi8xi20xii72xi", data)) for order in "<>")
    header = next(header for header in both if header.version in _SAC_VERSIONS)
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


# Not among them: pickles, which run code when they are read; formats whose files name other files; those without marks.
_NAMES = {
    "SLIST": "SLIST", "TSPAIR": "TSPAIR", "GSE2": "GSE2", "GSE1": "GSE1", "KINEMETRICS_EVT": "Kinemetrics EVT",
    "REFTEK130": "REFTEK 130", "SEISAN": "SEISAN", "SEG2": "SEG-2", "PDAS": "PDAS", "DMX": "DMX", "Y": "Nanometrics Y",
    "AH": "AH", "GCF": "GCF", "WIN": "WIN",
}  # fmt: skip
"""Names of the formats, by those of obspy; formats with weak marks are tried last."""


def form_of(data: bytes) -> str | None:
    """Return the name in obspy of the format of a file; None if it is of none of them, or obspy is not installed."""
    with TemporaryDirectory(ignore_cleanup_errors=True) as folder:  # some formats are recognised in files only
        path = Path(folder) / "record"
        path.write_bytes(data)
        for form in _NAMES:
            if form == "WIN" and int.from_bytes(data[:4]) > len(data):  # the size of its first block
                continue
            for point in find(f"obspy.plugin.waveform.{form}").get("isFormat", []):
                try:
                    if point.load()(str(path)):
                        return form
                except Exception:  # such a file is not of this format
                    continue
    return None


def read_any(data: bytes, file: str, asked: Asked) -> GroundMotion:
    """Read a file of any of the formats; see `formats.Reader.read`."""
    with warnings.catch_warnings():
        obspy_for(file)
        form = form_of(data)
    if form is None:
        raise InputError(Problem("obspy does not recognise this file", file, hint=CUT))
    traces_read = traces(data, file, form)
    # Where a header states no unit, obspy gives what is before it.
    stated = {trace.stats.get("ascii", {}).get("unit", "") for trace in traces_read} - {"", "FLOAT", "INTEGER"}
    unit = asked.unit(file, [(1, f"units: {spelling}") for spelling in sorted(stated)])
    return choose(file, _NAMES[form], channels_of(file, traces_read, unit, asked.wanted), asked)

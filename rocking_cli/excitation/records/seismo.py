"""Common parts of seismological formats, which obspy reads and which need not hold accelerations or state a unit."""

from __future__ import annotations

import io
import warnings
from collections.abc import Iterable, Sequence
from dataclasses import replace
from importlib import import_module
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Reals
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.excitation.base import STANDARD_GRAVITY, Origin
from rocking_cli.excitation.records.layout import CUT, Channel
from rocking_cli.excitation.records.origins import origin
from rocking_cli.excitation.records.record_units import Wanted
from rocking_cli.excitation.records.text import sensible, usable
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

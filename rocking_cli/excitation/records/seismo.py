"""Common parts of seismological formats, which obspy reads and which need not hold accelerations or state a unit."""

from __future__ import annotations

import io
import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Reals
from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import STANDARD_GRAVITY, Origin
from rocking_cli.excitation.records.layout import Channel
from rocking_cli.excitation.records.origins import origin
from rocking_cli.excitation.records.record_units import UNITS, Wanted
from rocking_cli.excitation.records.text import sensible, usable
from rocking_cli.text import regex

# SEED names a channel by band, instrument and direction; instruments H, L and P measure velocity.
_VELOCITY_CODE = regex(r"[A-Z][HLP][A-Z0-9]")
_MAX_ACCELERATION = (
    10 * STANDARD_GRAVITY
)  # m/s2; larger whole numbers are counts, as no earthquake has reached half of it


def traces(data: bytes, file: str, form: str) -> list[Any]:
    """Read the traces of a file with obspy, an optional package that is imported here.

    Parameters
    ----------
    data : bytes
        Content of the file.
    file : str
        Path of the file, for messages.
    form : str
        Name of the format in obspy.

    Returns
    -------
    list of obspy.Trace
        Traces in the order of the file.

    Raises
    ------
    InputError
        If obspy is not installed, or cannot read the file or a part of it.
    """
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("ignore")  # deprecations in obspy do not concern the user
        try:
            import obspy
            from obspy.io.mseed import InternalMSEEDWarning
        except ImportError as error:
            message = f"obspy, which reads such files, cannot be imported: {error}"
            hint = "install it: pip install 'rocking-cli[seismo]'"
            raise InputError(Problem(message, file, hint=hint)) from None
        warnings.simplefilter("always", InternalMSEEDWarning)  # obspy skips data that it cannot read
        try:
            read = list(obspy.read(io.BytesIO(data), format=form))
        except Exception as error:  # obspy raises many kinds of errors, without a common base
            message = f"obspy cannot read this file: {_in_a_line(error)}"
            hint = "the file may have been cut short or damaged: download it again"
            raise InputError(Problem(message, file, hint=hint)) from None
    if warned:
        message = f"obspy has doubts about this file: {_in_a_line(warned[0].message)}"
        hint = "it may be damaged: download it again; if you know it is whole, write it again with obspy"
        raise InputError(Problem(message, file, hint=hint))
    return read


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


def velocity_code(file: str, code: str, wanted: Wanted) -> Problem | None:
    """Return the problem that a channel code is that of a velocity instrument, if accelerations are requested."""
    if wanted.quantity != "acceleration" or not _VELOCITY_CODE.fullmatch(code):
        return None
    message = f"channel {code} is of a seismometer, which records velocity, not of an accelerometer"
    hint = (
        "give the accelerometer's channel, such as HNE; name one so that was converted to acceleration; or say `from` "
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
        hint = (
            "give `gain`, such as 4.7e-6 m/s2/count, or convert them: remove_response(output='ACC') in obspy gives m/s2"
        )
        return Problem(message, file, hint=hint)
    return None


def _in_a_line(reason: object) -> str:
    return " ".join(str(reason).split())

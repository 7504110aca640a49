"""Other formats that obspy reads: SLIST, TSPAIR, GSE, Kinemetrics EVT, REFTEK, WIN and more."""

from __future__ import annotations

import warnings
from pathlib import Path
from tempfile import TemporaryDirectory

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.records.layout import CUT, choose
from rocking_cli.excitation.records.record_units import Asked
from rocking_cli.excitation.records.seismo import channels_of, obspy_for, traces
from rocking_cli.plugins.registry import find

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


def read(data: bytes, file: str, asked: Asked) -> GroundMotion:
    """Read a file of any of the formats; see `registry.Reader.read`."""
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

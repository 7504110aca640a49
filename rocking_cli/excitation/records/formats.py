"""Built-in formats of records: marks by which a file is recognised, and the module that is then imported to read it.

Reading a file of one format thereby imports the reader of no other.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from importlib import import_module
from typing import Any

from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.records.record_units import Asked
from rocking_cli.text import regex


@dataclass(frozen=True)
class Format:
    """A format of records, which acts as its reader (`registry.Reader`).

    Parameters
    ----------
    TITLE, SIGN : str
        Name of the format, and the feature by which a file is recognised, for messages.
    module : str
        Name of the module in this package whose function `read` reads the format.
    marks : tuple of re.Pattern
        Patterns that are all found in a file of the format; of bytes if `BINARY`.
    TAKES_WANTED, BINARY : bool, optional
        As for `registry.Reader`.
    within : int, optional
        Number of characters at the start of a file within which the marks are searched; None for all of them.
    """

    TITLE: str
    SIGN: str
    module: str
    marks: tuple[re.Pattern[Any], ...]
    TAKES_WANTED: bool = False
    BINARY: bool = False
    within: int | None = 100_000

    def sniff(self, content: Any, /) -> bool:
        """Return whether all marks are found."""
        end = len(content) if self.within is None else self.within
        return all(mark.search(content, 0, end) for mark in self.marks)

    def read(self, content: Any, file: str, /, **options: Any) -> GroundMotion:
        """Read a file by the module of the format; arguments, result and errors are those of `registry.Reader.read`."""
        motion: GroundMotion = _module(self).read(content, file, Asked(**options))
        return motion


def _module(form: Format) -> Any:
    return import_module(f"{__package__}.{form.module}")


def _text(title: str, sign: str, module: str, *marks: str, within: int = 5000, wanted: bool = False) -> Format:
    return Format(title, sign, module, tuple(regex(mark, re.MULTILINE) for mark in marks), wanted, within=within)


# fmt: off
cosmos = _text(
    "COSMOS", "a first line with (Format v01.20 with 13 text lines)", "cosmos",
    r"(?i)\A[^\n]{0,9999}?\(Format v\S+ with\s+\d+ text lines\)", within=11_000, wanted=True,
)
csmip_v2 = _text(
    "CSMIP V2", "a line such as 3251 POINTS OF ACCEL DATA EQUALLY SPACED AT .020 SEC", "csmip",
    r"(?i)\A\s*UNCORRECTED ACCELEROGRAM DATA\b|"  # V1, which is refused
    r"^\s*\d+[ \t]+POINTS OF (?:ACCEL|VELOC|DISPL)\w*[ \t]+DATA EQUALLY SPACED AT[ \t]+\S+?[ \t]*SEC\b",
    within=100_000, wanted=True,
)
esm = _text(
    "ESM ASCII", "header lines SAMPLING_INTERVAL_S: and NDATA:", "esm", "^SAMPLING_INTERVAL_S:", "^NDATA:",
    within=20_000, wanted=True,
)
geonet_v1a = _text(
    "GeoNet V1A", "a first line Uncorrected accelerogram, and Raw readings in units of below it", "geonet",
    r"\AUncorrected accelerogram\b", r"^Raw readings in units of\b",
)
geonet_v2a = _text(
    "GeoNet V2A", "a first line Corrected accelerogram, and Number of points below it", "geonet",
    r"\ACorrected accelerogram\b", r"^Number of points\s+\d", wanted=True,
)
knet = _text(
    "K-NET/KiK-net", "header lines Sampling Freq(Hz) and Scale Factor", "knet", "^Sampling Freq", "^Scale Factor",
)
peer_at2 = _text(
    "PEER AT2", "a title with PEER and DATABASE, or a line with NPTS=", "peer",
    r"\A(?!\s*\{)",  # JSON may quote the header of a PEER file
    # One of the first 30 lines; comments of delimited text may quote the header of its source.
    r"(?i)\A(?:[^\n]*\n){0,29}?[^\S\n]*(?![\s#%])(?:PEER\b[^\n]*\bDATABASE\b|[^\n]*\bNPTS[^\S\n]*=[^\S\n]*\d|"
    r"\d+[ \t,]+[+-]?(?:\d+\.?\d*|\.\d+)(?:[ED][+-]?\d+)?[ \t,]+NPTS[^\S\n]*,[^\S\n]*DT\b)",
    within=100_000, wanted=True,
)
simcenter = Format(
    "SimCenter JSON", 'a JSON object with "accel_data"', "simcenter", (regex(r"\A\s*\{"), regex('"accel_data"')),
    within=None,
)
smc = _text(
    "USGS SMC", "a first line such as 2 CORRECTED ACCELEROGRAM, and * on the second", "smc",
    r"\A\d +[A-Z][^\n]*\n[^\S\n]*\*[^\S\n]*(?:\n|\Z)", wanted=True,
)
usc_v1 = _text(
    "USC V1", "a first line with UNCORRECTED ACCELEROGRAM DATA OF VOLUME I", "usc",
    r"\AFILE\s+\d+ OF UNCORRECTED ACCELEROGRAM DATA OF VOLUME I\b",
)

# Tables of networks that print the components of a record side by side.
afad = _text(
    "AFAD", "header lines NUMBER OF DATA and SAMPLING INTERVAL", "networks",
    r"^\s*NUMBER OF DATA\b", r"^\s*SAMPLING INTERVAL\b",
)
asa = _text(
    "ASA", "header lines INTERVALO DE MUESTREO and UNIDADES DE LOS DATOS", "networks",
    r"^\s*INTERVALO DE MUESTREO\b", r"^\s*UNIDADES DE LOS DATOS\b", within=20_000,
)
cwa = _text(
    "CWA", "header lines #SampleRate(Hz): and #AmplitudeUnit:", "networks", r"^#SampleRate\(Hz\):", "^#AmplitudeUnit:",
)
jma = _text(
    "JMA", "a first line with SITE CODE=, and INITIAL TIME = below it", "networks",
    r"\A\s*SITE CODE *=", r"^\s*INITIAL TIME *=",
)


def _bytes(title: str, sign: str, module: str, mark: bytes, of: type[Format] = Format) -> Format:
    return of(title, sign, module, (regex(mark, re.DOTALL | re.MULTILINE),), TAKES_WANTED=True, BINARY=True)


# Seismological formats, which obspy reads.
gse = _bytes("GSE", "a line that begins with WID1, WID2 or XW01", "by_obspy", rb"^(?:WID[12]|XW01) ")
slist = _bytes("SLIST/TSPAIR", "a first line that begins with TIMESERIES", "by_obspy", rb"\ATIMESERIES ")
# The year, from 1900 to 2100, and the day of the year, in either byte order; version 3 has one of them.
miniseed = _bytes(
    "miniSEED", "a binary header with six digits and D, R, Q or M, or with MS and 3, then a date", "mseed",
    rb"\A(?=.{48})(?:[0-9 \0]{6}[DRQM][ \0].{12}(?:\x07[\x6c-\xff]|\x08[\0-\x34])(?:\0[\x01-\xff]|\x01[\0-\x6e])|"
    rb"(?:[0-9 \0]{6}[DRQM][ \0].{12}|MS\x03.{5})(?:[\x6c-\xff]\x07|[\0-\x34]\x08)(?:[\x01-\xff]\0|[\0-\x6e]\x01))",
)
# The interval is above zero, the kind of file from 1 to 199, the evenness 0 or 1; in either byte order.
sac = _bytes(
    "SAC", "a binary header with version 6 or 7 in its 77th word", "sac",
    rb"\A(?!\0{4})(?:.{3}[\0-\x7e].{300}[\x06\x07]\0{3}.{32}[\x01-\xc7]\0{3}.{76}[\0\x01]\0{3}|"
    rb"[\0-\x7e].{303}\0{3}[\x06\x07].{32}\0{3}[\x01-\xc7].{76}\0{3}[\0\x01]).{208}",
)
# fmt: on


class _AnyOfObspy(Format):
    def sniff(self, content: Any, /) -> bool:
        return super().sniff(content) and _module(self).form_of(content) is not None


# Asked last, for binary files that no other reader recognises, as obspy is slow to import.
obspy = _bytes("others of obspy", "obspy recognises it", "by_obspy", rb"[\0-\x08\x0e-\x19\x1b-\x1f]", _AnyOfObspy)

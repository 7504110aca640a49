"""Record readers, found by the entry points `rocking.records`, the built-in formats, and the choice of a file's reader.

The readers of this package are the `Format`s below, and `text`: a format has marks by which a file is recognised, and
the module that is then imported to read it, so that reading a file of one format imports the reader of no other. A
reader is a module, or any object, with a `TITLE` (the name of its format), a `SIGN` (by which it recognises a file, for
messages) and the functions `sniff` and `read` of `Reader`. A reader with `BINARY = True` is given the bytes of a file
instead of its text. A reader with `TAKES_WANTED = True` can read other values than accelerations: its `read` takes
`wanted`, a `record_units.Wanted`.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from importlib import import_module
from importlib.metadata import EntryPoint
from typing import Any, Protocol, cast

from rocking_cli.errors import InputError, MechanismError, PluginError, Problem, RockingError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.records.record_units import Asked
from rocking_cli.plugins.errors import blame
from rocking_cli.plugins.registry import Plugins, leave_out, origin
from rocking_cli.text import regex


@dataclass(frozen=True)
class Format:
    """A format of records, which acts as its reader (`Reader`).

    Parameters
    ----------
    TITLE, SIGN : str
        Name of the format, and the feature by which a file is recognised, for messages.
    module : str
        Name of the module in this package that reads the format by its function `read`, or the function after a point.
    marks : tuple of re.Pattern
        Patterns that are all found in a file of the format; of bytes if `BINARY`.
    TAKES_WANTED, BINARY : bool, optional
        As for `Reader`.
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
        """Read a file by the module of the format; arguments, result and errors are those of `Reader.read`."""
        module, _, function = self.module.partition(".")
        reader = getattr(import_module(f"{__package__}.{module}"), function or "read")
        motion: GroundMotion = reader(content, file, Asked(**options))
        return motion


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
gse = _bytes("GSE", "a line that begins with WID1, WID2 or XW01", "seismo.read_any", rb"^(?:WID[12]|XW01) ")
slist = _bytes("SLIST/TSPAIR", "a first line that begins with TIMESERIES", "seismo.read_any", rb"\ATIMESERIES ")
# The year, from 1900 to 2100, and the day of the year, in either byte order; version 3 has one of them.
miniseed = _bytes(
    "miniSEED", "a binary header with six digits and D, R, Q or M, or with MS and 3, then a date",
    "seismo.read_miniseed",
    rb"\A(?=.{48})(?:[0-9 \0]{6}[DRQM][ \0].{12}(?:\x07[\x6c-\xff]|\x08[\0-\x34])(?:\0[\x01-\xff]|\x01[\0-\x6e])|"
    rb"(?:[0-9 \0]{6}[DRQM][ \0].{12}|MS\x03.{5})(?:[\x6c-\xff]\x07|[\0-\x34]\x08)(?:[\x01-\xff]\0|[\0-\x6e]\x01))",
)
# The interval is above zero, the kind of file from 1 to 199, the evenness 0 or 1; in either byte order.
sac = _bytes(
    "SAC", "a binary header with version 6 or 7 in its 77th word", "seismo.read_sac",
    rb"\A(?!\0{4})(?:.{3}[\0-\x7e].{300}[\x06\x07]\0{3}.{32}[\x01-\xc7]\0{3}.{76}[\0\x01]\0{3}|"
    rb"[\0-\x7e].{303}\0{3}[\x06\x07].{32}\0{3}[\x01-\xc7].{76}\0{3}[\0\x01]).{208}",
)
# fmt: on


class _AnyOfObspy(Format):
    def sniff(self, content: Any, /) -> bool:
        return super().sniff(content) and import_module(f"{__package__}.seismo").form_of(content) is not None


# Asked last, for binary files that no other reader recognises, as obspy is slow to import.
obspy = _bytes(
    "others of obspy", "obspy recognises it", "seismo.read_any", rb"[\0-\x08\x0e-\x19\x1b-\x1f]", _AnyOfObspy
)


FALLBACKS = ("text", "obspy")
"""Names of the readers that are tried last, in this order; delimited text accepts nearly anything with numbers."""


class Reader(Protocol):
    """Interface of a reader of a record format."""

    TITLE: str
    SIGN: str

    # Any, as the content is bytes for a reader with BINARY = True, else str.
    def sniff(self, content: Any, /) -> bool:
        """Return whether a file with this content has this format; fast, and without raising errors."""
        ...

    def read(
        self, content: Any, file: str, /, *, dt: float | None, units: str | None, channel: str | None
    ) -> GroundMotion:
        """Read a file of this format.

        Parameters
        ----------
        content : str or bytes
            Content of the file: its text, lines ending in a plain newline, or its bytes with `BINARY = True`.
        file : str
            Path of the file, for messages and the name of the motion.
        dt : float, optional
            Sampling interval [s]; it must agree with the file, and is required if the file has none.
        units : str, optional
            Unit of the accelerations; it must not contradict the file, and is required if the file states none.
        channel : str, optional
            Channel, by its number, from 1, or its name; required if there are several.

        Returns
        -------
        GroundMotion
            Accelerations [m/s2] at a constant interval [s].

        Raises
        ------
        InputError
            If anything is missing, contradictory, not a number, or not an acceleration.
        """
        ...


def load_readers() -> dict[str, Reader]:
    """Return all readers by name, in alphabetical order.

    A reader that cannot be loaded, is not valid, or has a name that two packages claim is left out with a warning. A
    substitute, which claims no file, states the reason if no reader claims a file.

    Warns
    -----
    PluginWarning
        For each reader that is left out, once in a process.
    """
    installed, readers = Readers(), dict[str, Reader]()
    for name in installed:
        try:
            readers[name] = installed[name]
        except MechanismError as error:
            leave_out(error)
            readers[name] = _Broken(error)
    return readers


class Readers(Plugins[Reader]):
    """Record readers by name. Listing names loads nothing; looking one up loads and checks it.

    Raises
    ------
    InputError
        On looking up an unknown name.
    MechanismError
        On looking up a plugin that cannot be loaded, is no reader, or has a name that two packages claim.
    """

    group = "rocking.records"
    kind = "record reader"

    @staticmethod
    def accept(loaded: object, point: EntryPoint) -> Reader:
        """Return the loaded object, wrapped so that its errors name it, if it is a reader."""
        missing = [word for word in ("sniff", "read") if not callable(getattr(loaded, word, None))]
        missing += [word for word in ("TITLE", "SIGN") if not isinstance(getattr(loaded, word, None), str)]
        if missing:
            raise MechanismError(f"{origin(point)} is not a record reader: it has no {', '.join(missing)}")
        return _Guarded(cast("Reader", loaded), point)


class ReaderError(InputError, PluginError):
    """Error inside a reader for one file; other files can still be read."""

    exit_code = PluginError.exit_code


class _Broken:
    """Substitute for a reader that cannot be used."""

    TITLE = "cannot be used"
    BINARY = True  # lists the broken reader for binary files too

    def __init__(self, error: MechanismError) -> None:
        self.SIGN = str(error)

    def sniff(self, content: object, /) -> bool:
        return False

    def read(self, content: object, file: str, /, **options: object) -> GroundMotion:
        raise MechanismError(self.SIGN)


class _Guarded:
    """A reader wrapped so that its own errors are reported as errors of its package."""

    def __init__(self, reader: Reader, point: EntryPoint) -> None:
        self.TITLE, self.SIGN, self.BINARY = reader.TITLE, reader.SIGN, takes_bytes(reader)
        self.TAKES_WANTED = takes_wanted(reader)
        self._reader, self._point = reader, point
        self._module = point.value.partition(":")[0]

    def sniff(self, content: Any, /) -> bool:
        """Return whether the reader claims a file; False if it fails."""

        def what() -> str:
            return f"{origin(self._point)} failed to say whether a file is of its format"

        try:
            with blame(what, self._module):
                return bool(self._reader.sniff(content))
        except RockingError as error:  # `sniff` must not raise even these errors
            broken = error if isinstance(error, PluginError) else PluginError(f"{what()}: {error}")
            leave_out(broken)
            self.TITLE, self.SIGN = _Broken.TITLE, str(broken)
            return False

    def read(self, content: Any, file: str, /, **options: Any) -> GroundMotion:
        """Return the motion that the reader reads; any other result is an error of the reader."""
        try:
            with blame(lambda: f"{origin(self._point)} failed to read it", self._module):
                motion = self._reader.read(content, file, **options)
                if not isinstance(motion, GroundMotion):
                    raise TypeError(f"read gave a {type(motion).__name__}, not a GroundMotion")
        except PluginError as error:
            raise ReaderError(Problem(str(error), file=file)) from error.__cause__
        return motion


def takes_bytes(reader: Reader) -> bool:
    """Return whether a reader is given the bytes of a file instead of its text."""
    return bool(getattr(reader, "BINARY", False))


def takes_wanted(reader: Reader) -> bool:
    """Return whether a reader can read other values than accelerations, and uneven times."""
    return bool(getattr(reader, "TAKES_WANTED", False))


def reader_for(text: str | None, file: str, readers: dict[str, Reader], data: bytes = b"") -> Reader:
    """Return the one reader that claims a file, or the first fallback that does if none of the others does.

    Parameters
    ----------
    text : str or None
        Content of the file; None if it is not text, so that only readers of bytes are tried.
    file : str
        Path of the file, for messages.
    readers : dict of str to Reader
        The readers to try.
    data : bytes, optional
        The same content as bytes.

    Returns
    -------
    Reader
        The only reader whose `sniff` is True.

    Raises
    ------
    InputError
        If several readers claim the file, or none does.
    """

    def claimed(name: str) -> bool:
        content = data if takes_bytes(readers[name]) else text
        return content is not None and readers[name].sniff(content)

    claims = [name for name in readers if name not in FALLBACKS and claimed(name)]
    for name in FALLBACKS:
        if not claims and name in readers and claimed(name):
            claims = [name]
    if len(claims) == 1:
        return readers[claims[0]]
    if claims:
        why = "; ".join(_described(name, readers[name]) for name in claims)
        hint = "the file holds the marks of both: take out what is not its own, such as another file in its comments"
        raise InputError(Problem(f"more than one format claims this file: {why}", file=file, hint=hint))
    tried = {name: reader for name, reader in readers.items() if text is not None or takes_bytes(reader)}
    broken = [_described(name, reader) for name, reader in tried.items() if reader.TITLE == _Broken.TITLE]
    known = ", ".join(sorted((each.TITLE for each in tried.values() if each.TITLE != _Broken.TITLE), key=str.lower))
    message = "not a record format that can be read: no acceleration values found"
    hint = f"give a file with a number in each line, or of one of these formats: {known}"
    if text is None:
        message = "this is a binary file, and none of a record format that can be read"
        hint = f"first save a spreadsheet, archive or UTF-16 text as plain text (CSV, UTF-8); binary formats: {known}"
    raise InputError(Problem(message, file=file, hint="; ".join([hint, *broken])))


def _described(name: str, reader: Reader) -> str:
    return f"{name} ({reader.TITLE}: {reader.SIGN})"

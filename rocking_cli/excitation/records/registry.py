"""Installed record readers, found by the entry points `rocking.records`, and the choice of the reader of a file.

The readers of this package are the `Format`s of `formats`, and `text`. A reader is a module, or any object, with a
`TITLE` (the name of its format), a `SIGN` (by which it recognises a file, for messages) and the functions `sniff` and
`read` of `Reader`. A reader with `BINARY = True` is given the bytes of a file instead of its text. A reader with
`TAKES_WANTED = True` can read other values than accelerations: its `read` takes `wanted`, a `record_units.Wanted`.
"""

from __future__ import annotations

from importlib.metadata import EntryPoint
from typing import Any, Protocol, cast

from rocking_cli.errors import InputError, MechanismError, PluginError, Problem, RockingError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.plugins.errors import blame
from rocking_cli.plugins.registry import Plugins, leave_out, origin

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
        what = f"{origin(self._point)} failed to say whether a file is of its format"
        try:
            with blame(what, self._module):
                return bool(self._reader.sniff(content))
        except RockingError as error:  # `sniff` must not raise even these errors
            broken = error if isinstance(error, PluginError) else PluginError(f"{what}: {error}")
            leave_out(broken)
            self.TITLE, self.SIGN = _Broken.TITLE, str(broken)
            return False

    def read(self, content: Any, file: str, /, **options: Any) -> GroundMotion:
        """Return the motion that the reader reads; any other result is an error of the reader."""
        try:
            with blame(f"{origin(self._point)} failed to read it", self._module):
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

"""Open a record: a file, standard input, a gzip file, a file in a zip archive, or a sheet of a spreadsheet."""

from __future__ import annotations

import codecs
import gzip
import io
import re
import sys
import zipfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary, WeakSet

from rocking_cli.errors import InputError, Problem, named
from rocking_cli.io.files import read_at_most, read_bytes
from rocking_cli.text import regex

STANDARD_INPUT = "-"
MAX_FILE_BYTES = 2_000_000_000  # ten million samples take about 300 MB
MAX_UNPACKED_BYTES = 500_000_000
MAX_UNPACKED_RATIO = 200  # applies above `UNCHECKED_BYTES`; a ratio of 60 is already high
UNCHECKED_BYTES = 10_000_000  # unpacked size that any packed file may have
MAX_ARCHIVE_FILES = 10_000
MAX_LISTED_FILES = 30

_GZIP = b"\x1f\x8b\x08"
_ZIP = (b"PK\x03\x04", b"PK\x05\x06", b"PK\x07\x08")
_OLE = b"\xd0\xcf\x11\xe0"  # of .xls
_TAR = slice(257, 262), b"ustar"
_OFFICE = "[Content_Types].xml"
_WORKBOOK = frozenset(["xl/workbook.xml", "xl/workbook.bin", "content.xml"])  # of .xlsx, .xlsb and .ods
_HIDDEN = regex(r"^__MACOSX(?:/|$)|(?:^|/)\.[^/]*$")
_UNPACK = "unpack it, and give the record in it"

_taken: WeakKeyDictionary[Any, bytes] = WeakKeyDictionary()
"""Bytes read from standard input, which can be read only once."""
_again: WeakSet[Any] = WeakSet()
"""Standard inputs whose kept bytes may be read once more."""


class Opened(NamedTuple):
    """Content of one record, and its names.

    Parameters
    ----------
    data : bytes
        Content, decompressed.
    file : str
        Name in messages: the path, followed by the name of the file in an archive.
    name : str
        Name of the motion, without its channel.
    member : str
        Name of the file in an archive of several; empty otherwise.
    channel : str or None
        The requested channel, without the name of the file in the archive.
    """

    data: bytes
    file: str
    name: str
    member: str
    channel: str | None


def name_of(path: str | Path) -> str:
    """Return the name of a record file in messages: its path, or standard input."""
    return "standard input" if str(path) == STANDARD_INPUT else str(path)


def original(path: str | Path) -> bytes:
    """Return the bytes of a file, still compressed; for standard input, those read before.

    Raises
    ------
    InputError
        If the file cannot be read.
    """
    if str(path) == STANDARD_INPUT and sys.stdin in _taken:
        return _taken[sys.stdin]
    return _bytes(path)


def allow_again(path: str | Path) -> None:
    """Allow a record from standard input to be read a second time, from the bytes kept."""
    if str(path) == STANDARD_INPUT and sys.stdin in _taken:
        _again.add(sys.stdin)


def open_record(path: str | Path, channel: str | None = None) -> Opened:
    """Return the content of one record, from a file, standard input or an archive.

    Parameters
    ----------
    path : str or Path
        A file, or `-` for standard input. A gzip file is decompressed, and so is one file of a zip archive.
    channel : str, optional
        The requested channel. For an archive with several files, the number, from 1, or the name of a file, followed by
        a colon and the channel if the file has several.

    Raises
    ------
    InputError
        If the file cannot be read, is too large, damaged or compressed twice, or the file of an archive is not clear.
    """
    data, file = _bytes(path), name_of(path)
    name, member = Path(file).name, ""
    if data.startswith(_GZIP):
        data = _of_gzip(data, file)
    elif data.startswith(_ZIP):
        data, inside, several, channel = _of_zip(data, file, channel)
        file, member = f"{file}/{inside}", inside if several else ""
    elif data.startswith(_OLE):
        data, inside, several, channel = _of_spreadsheet(data, file, channel)
        file, member = f"{file}/{inside}", inside if several else ""
    elif data[_TAR[0]] == _TAR[1]:
        raise InputError(Problem("this is a tar archive", file, hint=_UNPACK))
    else:
        return Opened(data, file, name, member, channel)
    if data.startswith((_GZIP, *_ZIP)) or data[_TAR[0]] == _TAR[1]:
        raise InputError(Problem("there is another archive in it", file, hint=_UNPACK))
    return Opened(data, file, name, member, channel)


def _bytes(path: str | Path) -> bytes:
    if str(path) == STANDARD_INPUT:
        return _from_standard_input()
    pipe = "write what it gives to a file first, or give - in its place and the record on standard input"
    return read_bytes(path, "record file", MAX_FILE_BYTES, if_pipe=pipe)


def _from_standard_input() -> bytes:
    """Return all of standard input, which is read only once."""
    file = name_of(STANDARD_INPUT)
    stream: Any = sys.stdin
    if stream is None:
        raise InputError(Problem("there is no standard input", file, hint="give a file"))
    if stream in _again:
        _again.discard(stream)
        return _taken[stream]
    if stream in _taken:
        message = "it can be read once only, and something else has been read from it"
        raise InputError(Problem(message, file, hint="give one of them as a file"))
    try:
        data = read_at_most(getattr(stream, "buffer", stream), MAX_FILE_BYTES)
    except (OSError, ValueError) as error:  # ValueError: standard input is closed
        raise InputError(Problem(f"cannot be read: {getattr(error, 'strerror', None) or error}", file)) from None
    if data is None:
        raise InputError(
            Problem(f"this cannot be a record file: it is larger than {MAX_FILE_BYTES / 1e6:.4g} MB", file)
        )
    _taken[stream] = data
    return data


def _of_gzip(data: bytes, file: str) -> bytes:
    try:
        with gzip.GzipFile(fileobj=io.BytesIO(data)) as stream:
            content = read_at_most(stream, _most(len(data)))
    except Exception as error:  # the library raises many kinds of errors, without a common base
        raise InputError(_damaged("gzip file", error, file)) from None
    if content is None:
        raise InputError(_too_large(file, len(data)))
    return content


def _of_zip(data: bytes, file: str, channel: str | None) -> tuple[bytes, str, bool, str | None]:
    """Return content and name of the requested or only file, whether there are several, and the channel in it."""
    if data.count(b"PK\x01\x02") > MAX_ARCHIVE_FILES:  # refused before zipfile reads the whole list of files at once
        raise InputError(
            Problem(f"the archive has more than {MAX_ARCHIVE_FILES} files: too many for a record", file, hint=_UNPACK)
        )
    try:
        archive = zipfile.ZipFile(io.BytesIO(data))
        # Without folders, and hidden files that a file manager adds.
        members = [each for each in archive.infolist() if not (each.is_dir() or _HIDDEN.search(each.filename))]
    except Exception as error:  # the library raises many kinds of errors, without a common base
        raise InputError(_damaged("zip archive", error, file)) from None
    names = [_printable(member.filename) for member in members]
    if _WORKBOOK.intersection(names):
        if sum(member.file_size for member in members) > _most(len(data)):
            raise InputError(_too_large(file, len(data)))
        return _of_spreadsheet(data, file, channel)
    if _OFFICE in names:
        message = "this is a document of an office program, and no record"
        raise InputError(Problem(message, file, hint="save the table in it as CSV, and give that"))
    if not names:
        raise InputError(Problem("the archive holds no file", file))
    place, channel = _chosen(file, names, channel)
    member, inside = members[place], f"{file}/{names[place]}"
    if member.flag_bits & 1:
        raise InputError(Problem("it needs a password", inside, hint=_UNPACK))
    packed = min(member.compress_size, len(data))
    if member.file_size > _most(packed):
        raise InputError(_too_large(inside, packed))
    try:
        with archive.open(member) as stream:
            content = read_at_most(stream, _most(packed))
    except Exception as error:  # the library raises many kinds of errors, without a common base
        raise InputError(_damaged("zip archive", error, inside)) from None
    if content is None:
        raise InputError(_too_large(inside, packed))
    return content, names[place], len(names) > 1, channel


def _of_spreadsheet(data: bytes, file: str, channel: str | None) -> tuple[bytes, str, bool, str | None]:
    """Return the table of the requested or only sheet as text, its name, whether there are several, and the channel."""
    from rocking_cli.io.spreadsheet import sheets_of

    sheets = sheets_of(data, file)
    if not sheets:
        raise InputError(Problem("the spreadsheet is empty", file))
    place, channel = _chosen(file, list(sheets), channel, of=("spreadsheet", "sheet"))
    name, rows = list(sheets.items())[place]
    return "\n".join(map("\t".join, rows)).encode(), _printable(name), len(sheets) > 1, channel


def _chosen(
    file: str, names: Sequence[str], channel: str | None, of: tuple[str, str] = ("archive", "file")
) -> tuple[int, str | None]:
    """Return the index of the requested file of an archive, or sheet of a spreadsheet, and the channel in it."""
    if channel is not None:
        for requested, rest in ((channel, None), channel.rpartition(":")[::2]):
            if (place := _place(names, requested.strip(), alone=len(names) == 1)) is not None:
                return place, rest
    if len(names) == 1:
        return 0, channel
    listed = [f"\n    {place}: {name}" for place, name in enumerate(names, start=1)]
    if len(names) > MAX_LISTED_FILES:
        listed[MAX_LISTED_FILES:] = [f"\n    and {len(names) - MAX_LISTED_FILES} more"]
    message = f"the {of[0]} holds {len(names)} {of[1]}s, and only one can be the record"
    if channel is not None:
        message = f"there is no {of[1]} '{channel}' in the {of[0]}"
    hint = f"choose one with {named('channel')}, and a channel in it behind a colon:{''.join(listed)}"
    raise InputError(Problem(message, file, field=None if channel is None else named("channel"), hint=hint))


def _place(names: Sequence[str], requested: str, *, alone: bool) -> int | None:
    """Return the index of a file by its name, with or without folder, or by its number; None if not found."""
    for wanted in (names, [name.rsplit("/", 1)[-1] for name in names]):
        places = [place for place, name in enumerate(wanted) if name.lower() == requested.lower()]
        if len(places) == 1:
            return places[0]
    if (
        not alone
        and requested.isascii()
        and requested.isdigit()
        and len(requested) < 9
        and 1 <= int(requested) <= len(names)
    ):
        return int(requested) - 1
    return None


def _damaged(what: str, error: Exception, file: str) -> Problem:
    reason = " ".join(str(error).split()) or type(error).__name__
    hint = "it may have been cut short: download it again, or unpack it with another program"
    return Problem(f"the {what} cannot be unpacked: {_printable(reason)}", file, hint=hint)


def _most(packed: int) -> int:
    """Return the largest size [bytes] to which this many compressed bytes may be decompressed."""
    return min(MAX_UNPACKED_BYTES, max(MAX_UNPACKED_RATIO * packed, UNCHECKED_BYTES))


def _too_large(file: str, packed: int) -> Problem:
    limit = _most(packed)
    size = f"{limit / 1e6:.4g} MB" + (
        f", {MAX_UNPACKED_RATIO} times its packed size" if UNCHECKED_BYTES < limit < MAX_UNPACKED_BYTES else ""
    )
    return Problem(f"this cannot be a record file: unpacked it is larger than {size}", file)


def _printable(text: str) -> str:
    """Return a text with escapes for characters that control a terminal."""
    return "".join(each if each.isprintable() else each.encode("unicode_escape").decode() for each in text)


# Bytes that are in no text file. Ctrl-Z (0x1a) is allowed, as DOS programs end text files with it.
_BINARY = regex(rb"[\x00-\x08\x0e-\x19\x1b-\x1f]")
_LINE_OF_NUL = regex(rb"^[ \t\r]*\0[\0 \t\r]*$", re.MULTILINE)
_ROW = regex(rb"^[ \t\0]*[+-]?\.?[0-9]", re.MULTILINE)
_UTF16_BYTES = 2000  # searched for UTF-16 without a byte order mark


def decoded(data: bytes, file: str) -> str | None:
    r"""Return the text of a file with plain newlines; None if it has bytes that text does not have.

    Parameters
    ----------
    data : bytes
        Content of the file. NUL bytes at the end of the file are removed, and those that fill up lines become blanks.
        A line of NUL bytes alone among the rows of numbers is not padding, as it may have been a value.
    file : str
        Name of the file in messages.

    Raises
    ------
    InputError
        If the file is empty, damaged UTF-16, or has a line of NUL bytes among its rows.
    """
    encoding = _utf_16(data)
    if encoding is None:
        if b"\0" in data:
            data = _without_padding(data, file)
        if _BINARY.search(data):
            return None
        try:
            content = data.decode("utf-8-sig")
        except UnicodeDecodeError:
            content = data.decode("latin-1")  # older processing programs write accents and m/s² that way
    else:
        try:
            content = data.decode(encoding).lstrip("\ufeff").rstrip("\0")
        except UnicodeDecodeError as error:
            message = f"the file is UTF-16 text that is cut or damaged at byte {error.start + 1}"
            raise InputError(Problem(message, file, hint="save it as UTF-8, or download it again")) from None
        if _BINARY.search(content.encode("utf-8")):
            return None
    content = content.replace("\r\n", "\n").replace("\r", "\n").rstrip("\x1a")
    if not content or content.isspace():
        raise InputError(Problem("the file is empty", file=file))
    return content


def _utf_16(data: bytes) -> str | None:
    """Return the name of the UTF-16 encoding, by its mark or by NUL in every other byte; None if it is not UTF-16."""
    if data.startswith(codecs.BOM_UTF16_LE) and not data.startswith(codecs.BOM_UTF32_LE):
        return "utf-16-le"
    if data.startswith(codecs.BOM_UTF16_BE):
        return "utf-16-be"
    head = data[:_UTF16_BYTES]
    for high, low, encoding in ((head[1::2], head[::2], "utf-16-le"), (head[::2], head[1::2], "utf-16-be")):
        if len(head) >= 8 and 0 not in low and high.count(0) > 0.9 * len(high):
            return encoding
    return None


def _without_padding(data: bytes, file: str) -> bytes:
    """Return the bytes without NUL bytes if these are padding of lines of text; else unchanged."""
    stripped = data.rstrip(b"\0 \t\r\n")
    row = _ROW.search(stripped)
    if row is None or b"\n" not in stripped or _BINARY.search(stripped.replace(b"\0", b"")):
        return data
    if lost := _LINE_OF_NUL.search(stripped, row.end()):
        message = "this line has NUL bytes alone: a row of numbers may have been lost here"
        number = stripped.count(b"\n", 0, lost.start()) + 1
        raise InputError(Problem(message, file, number, hint="the file is damaged: download it again"))
    return stripped.replace(b"\0", b" ")


def matching_files(place: str, folder: Path | None = None) -> list[Path]:
    """Return the files that match a name or a pattern.

    Parameters
    ----------
    place : str
        A file, or a pattern: `records/*.AT2`; `**` matches any folders in between. Without a folder, `-` is standard
        input.
    folder : Path, optional
        Folder to which `place` is relative; by default the current one.

    Returns
    -------
    list of Path
        At least one file, sorted by name; relative if `place` is.

    Raises
    ------
    InputError
        If the file does not exist or is a folder, or nothing matches.
    """
    if folder is None and place == STANDARD_INPUT:
        return [Path(STANDARD_INPUT)]
    base = folder if folder is not None else Path()
    path = base / place
    if path.is_dir():
        raise InputError(Problem("this is a folder", place, hint=f"for the files in it give a pattern: {place}/*.AT2"))
    if path.exists():
        return [path]
    if not any(sign in place for sign in "*?["):
        raise InputError(Problem("no such file", place, hint="check the path"))
    pattern = Path(place)
    if pattern.is_absolute():
        base, pattern = Path(pattern.anchor), pattern.relative_to(pattern.anchor)
    try:
        files = sorted(file for file in base.glob(str(pattern)) if file.is_file() and not file.name.startswith("."))
    except (ValueError, NotImplementedError) as error:
        raise InputError(Problem(f"not a pattern of file names: {error}", place)) from None
    if not files:
        raise InputError(Problem("no file matches this pattern", place, hint="check the path"))
    return files

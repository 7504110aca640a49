"""Decoding of record files from bytes to text: UTF-8, UTF-16 or Latin-1, without the padding of old programs."""

from __future__ import annotations

import codecs
import re

from rocking_cli.errors import InputError, Problem
from rocking_cli.patterns import regex

# Bytes no text file holds. Ctrl-Z (0x1a) is allowed: DOS programs end text files with it.
_BINARY = regex(rb"[\x00-\x08\x0e-\x19\x1b-\x1f]")
_BLANK_WITH_NUL = regex(rb"^[ \t\r]*\0[\0 \t\r]*$", re.MULTILINE)
_HEAD = 2000  # bytes looked at for UTF-16 without a mark


def decoded(data: bytes, file: str) -> str | None:
    r"""Return the text of a file with plain newlines; None if it has bytes that text does not have.

    Parameters
    ----------
    data : bytes
        Content of the file. NUL bytes at the end of the file are removed, and those that fill up a line of ASCII text
        become blanks. A line of NUL bytes alone is not padding, as it may have been a value.
    file : str
        Name of the file in messages.

    Raises
    ------
    InputError
        If the file is empty, or damaged UTF-16.
    """
    encoding = _utf_16(data)
    if encoding is None:
        if b"\0" in data:
            data = _without_padding(data)
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
    head = data[:_HEAD]
    for high, low, encoding in ((head[1::2], head[::2], "utf-16-le"), (head[::2], head[1::2], "utf-16-be")):
        if len(head) >= 8 and 0 not in low and high.count(0) > 0.9 * len(high):
            return encoding
    return None


def _without_padding(data: bytes) -> bytes:
    """Return the bytes without NUL bytes if these are padding of lines of ASCII text; else unchanged."""
    stripped = data.rstrip(b"\0")
    if not stripped.isascii() or not re.search(rb"[\r\n]", stripped) or _BLANK_WITH_NUL.search(stripped):
        return data
    return stripped.replace(b"\0", b" ")

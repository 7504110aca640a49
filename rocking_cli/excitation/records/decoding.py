"""From the bytes of a record file to its text: UTF-8, UTF-16 or Latin-1, with the padding of old programs taken off."""

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
    r"""Text of a file, lines ending in a plain newline; None if it holds bytes that no text does.

    Parameters
    ----------
    data : bytes
        Its content. NUL bytes that fill the end of the file are taken off, those that fill up a line of ASCII text are
        blanks; a line of nothing else is no padding, as it may have been a value.
    file : str
        What to call it in messages.

    Raises
    ------
    InputError
        If it is empty, or UTF-16 that is damaged.
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
    """Name of the UTF-16 encoding, by its mark or by every other byte being NUL; None if it is none."""
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
    """The bytes without NUL, if these are padding of lines of ASCII text; else as they are."""
    stripped = data.rstrip(b"\0")
    if not stripped.isascii() or not re.search(rb"[\r\n]", stripped) or _BLANK_WITH_NUL.search(stripped):
        return data
    return stripped.replace(b"\0", b" ")

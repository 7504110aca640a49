"""A logo at the head of a report: a picture within the page, which needs no other file."""

from __future__ import annotations

import base64
import io
from pathlib import Path

from rocking_cli.errors import InputError, Problem
from rocking_cli.io.files import read_bytes
from rocking_cli.text import cut, printable

LARGEST = 1_000_000  # bytes: the page is mailed
KINDS = {"image/png": b"\x89PNG\r\n\x1a\n", "image/jpeg": b"\xff\xd8\xff"}  # and how their files begin


def _check_whole(data: bytes, kind: str, path: Path) -> None:
    """Raise `InputError` if a picture is damaged, so that no browser can show it."""
    from xml.etree.ElementTree import fromstring

    from PIL import Image, UnidentifiedImageError

    try:
        if kind in KINDS:
            Image.open(io.BytesIO(data)).verify()  # its checksums, which end the use of the object
            Image.open(io.BytesIO(data)).load()
        else:
            fromstring(data)
    except Exception as error:  # of many kinds, without a base of their own
        unread = isinstance(error, UnidentifiedImageError)  # its text names an object of Python
        reason = "no picture can be read from it" if unread else " ".join(str(error).split()) or type(error).__name__
        what = f"the logo is damaged: {printable(cut(reason))}"
        raise InputError(Problem(what, str(path), hint="save the picture again")) from None


def embedded(path: Path) -> str:
    """Return a picture as a data URL.

    Parameters
    ----------
    path : Path
        A PNG, JPEG or SVG file; the type is recognised from the content.

    Raises
    ------
    InputError
        If the file cannot be read, is too large, or is of another type.
    """
    data = read_bytes(path, "logo", LARGEST)
    kind = next((kind for kind, begin in KINDS.items() if data.startswith(begin)), None)
    if kind is None and b"<svg" in data[:4096]:
        kind = "image/svg+xml"
    if kind is None:
        raise InputError(
            Problem("the file is not a PNG, JPEG or SVG picture", str(path), hint="convert the logo to one of them")
        )
    _check_whole(data, kind, path)
    return f"data:{kind};base64,{base64.b64encode(data).decode()}"

"""A logo at the head of a report: a picture within the page, which needs no other file."""

from __future__ import annotations

import base64
import io
from pathlib import Path

from rocking_cli.errors import InputError, Problem
from rocking_cli.io.files import read_bytes
from rocking_cli.text import cut, printable

MAX_LOGO_SIZE = 1_000_000  # bytes, as the page is sent by mail
# The first bytes of files, by media type.
SIGNATURES = {"image/png": b"\x89PNG\r\n\x1a\n", "image/jpeg": b"\xff\xd8\xff"}


def _check_whole(data: bytes, kind: str, path: Path) -> None:
    """Raise `InputError` if a picture is damaged, so that no browser can show it."""
    from xml.etree.ElementTree import fromstring

    from PIL import Image, UnidentifiedImageError

    try:
        if kind in SIGNATURES:
            Image.open(io.BytesIO(data)).verify()  # checks the checksums; the object cannot be used afterwards
            Image.open(io.BytesIO(data)).load()
        else:
            fromstring(data)
    except Exception as error:  # Pillow raises errors of many kinds, without a common base
        unread = isinstance(error, UnidentifiedImageError)  # the text of this error names a Python object
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
    data = read_bytes(path, "logo", MAX_LOGO_SIZE)
    kind = next((kind for kind, begin in SIGNATURES.items() if data.startswith(begin)), None)
    if kind is None and b"<svg" in data[:4096]:
        kind = "image/svg+xml"
    if kind is None:
        raise InputError(
            Problem("the file is not a PNG, JPEG or SVG picture", str(path), hint="convert the logo to one of them")
        )
    _check_whole(data, kind, path)
    return f"data:{kind};base64,{base64.b64encode(data).decode()}"

"""The structure file of an import: a head of comments, the fields, and comments on what the drawing does not tell."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from hashlib import sha256
from typing import Any

from rocking_cli.io.yaml_file import block
from rocking_cli.text import one_line


def head(file: str, data: bytes, command: str, sentences: Sequence[str]) -> list[str]:
    """Return the comments that say where a structure comes from.

    Parameters
    ----------
    file : str
        Name of the drawing.
    data : bytes
        Its content.
    command : str
        The command, as typed.
    sentences : sequence of str
        What was mended, assumed and left out.
    """
    return [f"From {file}, SHA-256 {sha256(data).hexdigest()}", f"by `{command}`", *sentences]


def text_of(kind: str, fields: Mapping[str, Any], comments: Sequence[str], end: Sequence[str] = ()) -> str:
    """Return the YAML of a structure below comments."""
    lines = [line for key, value in {"mechanism": kind, **fields}.items() for line in block(key, value)]
    above, below = ([f"# {one_line(each)}" for each in some] for some in (comments, end))
    return "\n".join([*above, *lines, *below, ""])

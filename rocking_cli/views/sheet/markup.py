"""Formulas in a line of text: `d_[0]^[*]` has a subscript and a superscript."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal, NamedTuple

from rocking_cli.studies.verification.working import MARK

Place = Literal["", "sub", "sup"]


class Run(NamedTuple):
    """A piece of text, and whether it is a subscript, a superscript or neither."""

    text: str
    place: Place = ""


def runs(text: str) -> Iterator[Run]:
    """Yield the pieces of a text with sub- and superscripts."""
    end = 0
    for mark in MARK.finditer(text):
        if mark.start() > end:
            yield Run(text[end : mark.start()])
        yield Run(mark[2], "sub" if mark[1] == "_" else "sup")
        end = mark.end()
    if end < len(text):
        yield Run(text[end:])

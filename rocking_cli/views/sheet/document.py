"""A sheet before it is a page or a document: headings, sentences, tables and steps, in one language."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from rocking_cli.studies.verification.working import Working
from rocking_cli.views.sheet.language import Language


@dataclass(frozen=True)
class Sentence:
    """A paragraph; the answer of the sheet stands out, and says whether it is a bad one."""

    text: str
    answers: bool = False
    fails: bool = False


@dataclass(frozen=True)
class Grid:
    """A table: its caption, headings and cells, and which columns hold numbers."""

    caption: str
    columns: Sequence[str]
    rows: Sequence[Sequence[str]]
    numbers: Collection[int] = ()


@dataclass(frozen=True)
class Steps:
    """Lines of a calculation, in the order in which they follow from each other."""

    rows: Sequence[Working]


@dataclass(frozen=True)
class Drawing:
    """The picture of the structure: what it shows."""

    label: str


@dataclass(frozen=True)
class Listing:
    """The content of a file."""

    text: str


Item = Sentence | Grid | Steps | Drawing | Listing


@dataclass(frozen=True)
class SheetPart:
    """A section, or a part of one.

    Parameters
    ----------
    key : str
        Its address on a page.
    heading : str
    items : sequence
        What is in it.
    parts : sequence of SheetPart
        And below it.
    """

    key: str
    heading: str
    items: Sequence[Item]
    parts: Sequence[SheetPart] = ()


def workings(parts: Iterable[SheetPart]) -> Iterator[Working]:
    """The steps of parts in plain characters, each with the heading under which it stands."""
    for part in parts:
        for item in part.items:
            if isinstance(item, Steps):
                yield from (row.in_plain(part.heading) for row in item.rows)
        yield from workings(part.parts)


@dataclass(frozen=True)
class Sheet:
    """A calculation sheet.

    Parameters
    ----------
    language : Language
    heading, subtitle : str
    about : mapping of str to str
        Project, place, author, date, ...
    parts : sequence of SheetPart
    logo : str, optional
        The address of a picture that holds the picture itself.
    """

    language: Language
    heading: str
    subtitle: str
    about: Mapping[str, str]
    parts: Sequence[SheetPart]
    logo: str | None = None

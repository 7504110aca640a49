"""Structure of a document, independent of its output format: headings, sentences, tables, steps and pictures."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from rocking_cli.core import Mechanism
from rocking_cli.verification.results import Working
from rocking_cli.views.sheet.language import Language
from rocking_cli.views.view import Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Sentence:
    """A paragraph; `answers` marks the answer of the sheet, `fails` a negative one, `is_open` what the user writes."""

    text: str
    answers: bool = False
    fails: bool = False
    is_open: bool = False


@dataclass(frozen=True)
class Steps:
    """Lines of a calculation, in the order in which they follow from each other."""

    rows: Sequence[Working]


@dataclass(frozen=True)
class Drawing:
    """A picture with its caption: what `figure` draws, or the structure; at most so high on paper [cm]."""

    label: str
    figure: Callable[[], Figure] | Mechanism
    height: float = 11.0


@dataclass(frozen=True, eq=False)
class Moving(Drawing):
    """A picture that moves on a page of HTML, by the data that `motionView` of data/motion.js reads."""

    data: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Listing:
    """The content of a file."""

    text: str


Item = Sentence | Table | Steps | Drawing | Listing


@dataclass(frozen=True)
class SheetPart:
    """A section of a document, or a subsection.

    Parameters
    ----------
    key : str
        Anchor of the section on a page.
    heading : str
    items : sequence
        Content of the section.
    parts : sequence of SheetPart
        Subsections.
    """

    key: str
    heading: str
    items: Sequence[Item]
    parts: Sequence[SheetPart] = ()


def workings(parts: Iterable[SheetPart]) -> Iterator[Working]:
    """Yield the steps of parts in plain characters, each with the heading of its section."""
    for part in parts:
        for item in part.items:
            if isinstance(item, Steps):
                yield from (row.in_plain(part.heading) for row in item.rows)
        yield from workings(part.parts)


@dataclass(frozen=True)
class Sheet:
    """A document: a calculation sheet, or a report.

    Parameters
    ----------
    language : Language
    heading, subtitle : str
    about : mapping of str to str
        Project, place, client, author, date, ...; an empty one is a blank to be filled in by hand.
    parts : sequence of SheetPart
    logo : str, optional
        The logo as a data URL.
    signature : sequence of str
        What is filled in by hand below the first section, in English; without it, that section has a page of its own.
    own_pages : sequence of str
        Keys of the sections that begin a page.
    author : str, optional
        Whose the logo is.
    running : str
        What stands above each page on paper but the first: what the document is about, where that is, who ordered it.
    """

    language: Language
    heading: str
    subtitle: str
    about: Mapping[str, str]
    parts: Sequence[SheetPart]
    logo: str | None = None
    signature: Sequence[str] = ()
    own_pages: Sequence[str] = ()
    author: str | None = None
    running: str = ""

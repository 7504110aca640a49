"""A document, independent of its output format: headings, sentences, tables, steps and pictures; and its templates.

Templates are Jinja texts of one language with headings, sentences, tables and figures, in blocks that are separated by
blank lines. `# Heading <key>` begins a section, `##` one within it. `|: caption` begins a table: below it stand the
heads, those of numbers with `>` before their `|`, and the rows. `!` before a paragraph marks the answer of the sheet,
`!!` a negative one, `?` what the user completes. Other blocks are paragraphs.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from typing import TYPE_CHECKING, Any

from jinja2 import ChoiceLoader, Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from rocking_cli.core import Mechanism
from rocking_cli.studies.remark import in_plain
from rocking_cli.text import in_short
from rocking_cli.verification.results import Evaluated, Working
from rocking_cli.views.sheet.language import SIGNIFICANT_DIGITS, Language, plain
from rocking_cli.views.view import Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

BLANK_LINES = re.compile(r"\n(?:[ \t]*\n)+")
HEADING = re.compile(r"(#+) (.*) <([^>]*)>")
MARKED = re.compile(r"(!!|!|\?) (.*)", re.DOTALL)
BAR, GUARD = "\ue000", "\ue001"  # stand for a bar within a text that is filled in, and before its first sign
PUT = "@"  # begins a block that stands for an object


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
    """A picture that moves on a page of HTML, by data that `motionView` of data/motion.js reads; or a page in it."""

    data: Mapping[str, Any] = field(default_factory=dict)
    page: str = ""


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


@dataclass
class _OpenSection:
    """A section that is being read."""

    level: int
    key: str
    heading: str
    items: list[Item] = field(default_factory=list)
    below: list[_OpenSection] = field(default_factory=list)

    def part(self) -> SheetPart:
        return SheetPart(self.key, self.heading, self.items, [each.part() for each in self.below])


@cache
def _environment(package: str, language: str) -> Environment:
    loaders = [PackageLoader(each, f"texts/{language}") for each in (package, "rocking_cli.views.sheet")]
    environment = Environment(
        loader=ChoiceLoader(loaders), autoescape=True, finalize=_filled_in, undefined=StrictUndefined,
        trim_blocks=True, lstrip_blocks=True, keep_trailing_newline=True,
    )  # fmt: skip
    environment.filters["in_short"] = in_short
    return environment


def _filled_in(value: Any) -> Any:
    """Return a value that a template prints, so that nothing in it is read as a mark of the template."""
    return value if isinstance(value, Markup) else guarded(plain(str(value)))


def guarded(text: str) -> Markup:
    """Return a text that a template prints unchanged, with its sub- and superscripts: nothing in it is a mark."""
    return Markup(GUARD + re.sub(r"\s+", " ", text.replace("|", BAR)))


def sections(say: Language, package: str, name: str, context: Mapping[str, Any]) -> list[SheetPart]:
    """Return the sections of a template; what stands before its first heading is in a section without one.

    Parameters
    ----------
    say : Language
        The language; its key names the folder of the templates.
    package : str
        The package with a folder `texts/LANGUAGE`; templates that it lacks are those of every sheet.
    name : str
        Name of the template, without its ending.
    context : mapping of str to object
        What the template may use, besides `n` (a number, with its digits), `say` (a text by its key), `recognised` (a
        text of a mechanism, after its family), `steps` (lines of a calculation), `rows` (of a table), `draw` (a figure,
        before its caption), `listing` (the text of a file), `put` (a sentence or table) and `formulas` (each formula so
        far once, with its symbol and text).
    """
    objects: list[Item] = []
    formulas: dict[tuple[str, str], Working] = {}

    def put(item: Item) -> Markup:
        objects.append(item)
        return Markup(f"\n\n{PUT}{len(objects) - 1}\n\n")

    def steps(lines: Sequence[Evaluated | Working]) -> Markup:
        rows = [say.written(each) if isinstance(each, Evaluated) else each for each in lines]
        for each, row in zip(lines, rows, strict=True):
            text = each.formula.text if isinstance(each, Evaluated) else row.formula
            formulas.setdefault((row.clause, text), row)
        return put(Steps(rows)) if rows else Markup("")

    def cell(value: Any) -> str:
        return say.number(value) if value is None or isinstance(value, float) else _filled_in(say.name(value))

    text = _environment(package, say.key).get_template(f"{name}.md").render(
        **context,
        n=lambda value, digits=SIGNIFICANT_DIGITS: guarded(say.number(value, digits)),
        say=lambda key, **values: guarded(say(key, **values)),
        recognised=lambda family, text: guarded(say.recognised(family, text)),
        steps=steps,
        rows=lambda table: Markup("\n".join(f"| {' | '.join(map(cell, row))} |" for row in table)),
        put=put,
        formulas=lambda: [(each, guarded(each.symbol), guarded(each.formula)) for each in formulas.values()],
        draw=lambda of, **how: Markup(put(of if isinstance(of, Drawing) else Drawing("", of, **how)).strip() + " "),
        listing=lambda content: put(Listing(content)),
    )  # fmt: skip
    return _read(say, text, objects)


def tables(say: Language, package: str, name: str, context: Mapping[str, Any]) -> list[Table]:
    """Return the tables of a template that has nothing else; arguments as of `sections`."""
    return [item for part in sections(say, package, name, context) for item in part.items if isinstance(item, Table)]


def _read(say: Language, text: str, objects: Sequence[Item]) -> list[SheetPart]:
    """Return the sections of a text in which a block `@k` stands for `objects[k]`.

    Items before the first heading come first, as a section without a heading.
    """
    whole = _OpenSection(0, "", "")
    open_sections = [whole]  # from the whole to the innermost
    for block in filter(None, map(str.strip, BLANK_LINES.split(text))):
        if match := HEADING.fullmatch(block):
            section = _OpenSection(len(match[1]), match[3].replace(GUARD, ""), _text(say, match[2]))
            while open_sections[-1].level >= section.level:
                open_sections.pop()
            open_sections[-1].below.append(section)
            open_sections.append(section)
        else:
            open_sections[-1].items.append(_item(say, block, objects))
    return [*([_OpenSection(0, "", "", whole.items).part()] if whole.items else []), *(s.part() for s in whole.below)]


def _item(say: Language, block: str, objects: Sequence[Item]) -> Item:
    if block.startswith(PUT):
        index, _, caption = block.removeprefix(PUT).partition(" ")
        item = objects[int(index)]
        return replace(item, label=_text(say, caption)) if isinstance(item, Drawing) else item
    if block.startswith("|:"):
        return _table(say, block)
    mark, text = match.groups() if (match := MARKED.fullmatch(block)) else ("", block)
    return Sentence(_text(say, text), answers=mark in ("!", "!!"), fails=mark == "!!", is_open=mark == "?")


def _table(say: Language, block: str) -> Table:
    caption, heads, *rows = block.split("\n")
    columns = list(_cells(heads))
    return Table(
        _text(say, caption.removeprefix("|:")),
        [_text(say, each.removesuffix(">")).replace("\\n", "\n") for each in columns],
        [[_text(say, each) for each in _cells(row)] for row in rows],
        [k for k, each in enumerate(columns) if each.endswith(">")],
    )


def _cells(line: str) -> Iterator[str]:
    return (each.strip() for each in line.strip().removeprefix("|").removesuffix("|").split("|"))


def _text(say: Language, text: str) -> str:
    text = " ".join(str(text).replace(GUARD, "").replace(BAR, "|").split())
    return in_plain(text) if say.is_plain else text

"""Heading of a document, and the command that wrote it."""

from __future__ import annotations

import shlex
from dataclasses import dataclass, replace
from datetime import UTC, date, datetime
from pathlib import Path
from typing import TYPE_CHECKING

import click

from rocking_cli.cli import complete, defaults, options
from rocking_cli.cli.defaults import from_default

if TYPE_CHECKING:
    from rocking_cli.structure import Structure
    from rocking_cli.studies.assessment import File, TitleBlock
    from rocking_cli.views.sheet.language import Language

LANGUAGES = ("en", "it")


def _today() -> date:
    return datetime.now(UTC).date()


@dataclass(frozen=True)
class Head:
    """Heading of a document."""

    project: str | None
    place: str | None
    author: str | None
    logo: Path | None

    @property
    def inputs(self) -> list[str]:
        """Files that the heading reads."""
        return [str(self.logo)] if self.logo is not None else []

    def block(self, command: str) -> TitleBlock:
        """Return the title block, with the command and the date."""
        from rocking_cli.studies.assessment import TitleBlock

        today = _today().strftime("%d %B %Y").lstrip("0")
        picture = None
        if self.logo is not None:
            from rocking_cli.report.logo import embedded

            picture = embedded(self.logo)
        return TitleBlock(command, today, self.project, self.place, self.author, picture)


@dataclass(frozen=True)
class SheetAsked(Head):
    """Options of a calculation sheet: its file, if one is requested, its language and its heading."""

    sheet: Path | None
    language: str

    def __post_init__(self) -> None:
        if self.sheet is not None:
            return
        given = [name for name in ("project", "place", "author", "logo") if getattr(self, name) is not None]
        typed = [f"--{name}" for name in given if not from_default(name)]
        if typed:
            word = "belongs" if len(typed) == 1 else "belong"
            raise click.UsageError(f"{' and '.join(typed)} {word} to the heading of a sheet: give --sheet FILE.html.")

    @property
    def spoken(self) -> Language:
        """Language of the sheet."""
        from rocking_cli.views.sheet.language import Language

        return Language(self.language)

    def title(self, command: str) -> TitleBlock:
        """Return the title block, with the date in the language of the sheet."""
        return replace(self.block(command), date=self.spoken.day(_today()))


head: options.Decorator = options.in_order(
    click.option("--project", metavar="TEXT", help="Project name, for the heading of the document."),
    click.option("--place", metavar="TEXT", help="Location of the structure, for the heading."),
    click.option("--author", metavar="TEXT", help="Author of the document, for the heading."),
    click.option(
        "--logo",
        type=click.Path(path_type=Path),
        metavar="FILE",
        help="Author's logo (.png, .jpg or .svg), for the heading.",
    ),
)
"""The options of a head: `project`, `place`, `author` and `logo`."""


sheet: options.Decorator = options.in_order(
    click.option(
        "--sheet", callback=options.output_path(".html", ".docx", ".pdf"), metavar="FILE.html",
        shell_complete=complete.files,
        help="Write the calculation sheet (.html; .pdf needs a browser, .docx an extra package).",
    ),
    click.option(
        "--language", type=click.Choice(LANGUAGES), default="en", show_default=True, help="Language of the sheet."
    ),
    head,
)  # fmt: skip
"""The options of a calculation sheet: `sheet`, `language` and those of its head."""


def file_of(structure: Structure, given: str | None) -> File:
    """Return the file of a structure, with its content."""
    from rocking_cli.cli import structures
    from rocking_cli.excitation.records.opening import original
    from rocking_cli.studies.assessment import File

    if structure.file is None:
        return File("default block", structures.DEFAULT.encode())
    return File(structure.file, original(given or structure.file))


def command_line(ctx: click.Context) -> str:
    """Return the command as it was given, for a POSIX shell, with the user's defaults written out."""
    from click.core import ParameterSource

    said = ["rocking", ctx.info_name or ""]
    taken = defaults.of_run(ctx)
    for param in sorted(ctx.command.params, key=lambda each: _place(ctx.params.get(each.name or ""))):
        value = ctx.params.get(param.name or "")
        if default := taken.get(param.name or ""):
            said += [f"--{default.option}", default.value]
        if ctx.get_parameter_source(param.name or "") is not ParameterSource.COMMANDLINE:
            continue
        for each in _typed(value):
            said += [] if isinstance(param, click.Argument) else [param.opts[0]]
            said += [] if each is True else [str(each)]
    places = ", ".join(f"--{each.option} from {each.place}" for each in taken.values())
    return shlex.join(said) + (f"  # {places}" if places else "")


def _typed(value: object) -> tuple[object, ...]:
    """Return the values typed for a parameter, the parts of a point joined."""
    if isinstance(value, tuple) and value and isinstance(value[0], float):
        return (",".join(str(each) for each in value if each is not None),)
    return value if isinstance(value, tuple) else (value,)


def _place(value: object) -> int:
    """Return the place of an option: corrections in their order, all others before them."""
    return value.place if isinstance(value, options.Placed) else 0

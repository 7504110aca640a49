"""What stands at the head of a document that is handed over, and the command that wrote it."""

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
    from rocking_cli.dynamics.prepared import Prepared
    from rocking_cli.studies.assessment import File, TitleBlock
    from rocking_cli.views.sheet.language import Language

LANGUAGES = ("en", "it")


def _today() -> date:
    return datetime.now(UTC).date()


@dataclass(frozen=True)
class Head:
    """What stands at the head of a document."""

    project: str | None
    place: str | None
    author: str | None
    logo: Path | None

    @property
    def inputs(self) -> list[str]:
        """The files that it reads."""
        return [str(self.logo)] if self.logo is not None else []

    def block(self, command: str) -> TitleBlock:
        """With the command and the day."""
        from rocking_cli.studies.assessment import TitleBlock

        today = _today().strftime("%d %B %Y").lstrip("0")
        picture = None
        if self.logo is not None:
            from rocking_cli.report.logo import embedded

            picture = embedded(self.logo)
        return TitleBlock(command, today, self.project, self.place, self.author, picture)


@dataclass(frozen=True)
class SheetAsked(Head):
    """Whether a calculation sheet is asked for, where it goes, in which language, and its head."""

    sheet: Path | None
    language: str

    def __post_init__(self) -> None:
        if self.sheet is not None:
            return
        given = [name for name in ("project", "place", "author", "logo") if getattr(self, name) is not None]
        typed = [f"--{name}" for name in given if not from_default(name)]
        if typed:
            word = "stands" if len(typed) == 1 else "stand"
            raise click.UsageError(f"{' and '.join(typed)} {word} at the head of a sheet: give --sheet FILE.html.")

    @property
    def spoken(self) -> Language:
        """The language."""
        from rocking_cli.views.sheet.language import Language

        return Language(self.language)

    def title(self, command: str) -> TitleBlock:
        """The head, with the day in the language of the sheet."""
        return replace(self.block(command), date=self.spoken.day(_today()))


head: options.Decorator = options.in_order(
    click.option("--project", metavar="TEXT", help="Of the document: its head names it."),
    click.option("--place", metavar="TEXT", help="Where the structure stands."),
    click.option("--author", metavar="TEXT", help="Who hands it over."),
    click.option("--logo", type=click.Path(path_type=Path), metavar="FILE", help="Their logo (.png, .jpg or .svg)."),
)
"""The options of a head: `project`, `place`, `author` and `logo`."""


sheet: options.Decorator = options.in_order(
    click.option(
        "--sheet", callback=options.output_path(".html", ".docx", ".pdf"), metavar="FILE.html",
        shell_complete=complete.files,
        help="Write the calculation sheet (.html, .pdf by a browser, .docx by an extra package).",
    ),
    click.option("--language", type=click.Choice(LANGUAGES), default="en", show_default=True, help="Of the sheet."),
    head,
)  # fmt: skip
"""The options of a calculation sheet: `sheet`, `language` and those of its head."""


def file_of(structure: Prepared, given: str | None) -> File:
    """The content of the file that a structure stands in."""
    from rocking_cli.cli import structures
    from rocking_cli.excitation.records.opening import original
    from rocking_cli.studies.assessment import File

    if structure.file is None:
        return File("default block", structures.DEFAULT.encode())
    return File(structure.file, original(given or structure.file))


def command_line(ctx: click.Context) -> str:
    """The command as it was given, for a POSIX shell, with the user's defaults, which hold nowhere else."""
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
    """What was typed for a parameter, one for each time: of a point, its parts joined."""
    if isinstance(value, tuple) and value and isinstance(value[0], float):
        return (",".join(str(each) for each in value if each is not None),)
    return value if isinstance(value, tuple) else (value,)


def _place(value: object) -> int:
    """Where an option stands among the others: corrections in their order, all else before them."""
    return value.place if isinstance(value, options.Placed) else 0

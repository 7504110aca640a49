"""Groups of options as objects that check themselves; `options.grouped` hands them to a command."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from rocking_cli.cli import terminal
from rocking_cli.cli.options import STANDARD_OUTPUT
from rocking_cli.cli.watching import OnTerminal

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.ask.answer import Answer
    from rocking_cli.ask.ground_motions import Motion, Motions
    from rocking_cli.io.spreadsheet import Spreadsheet
    from rocking_cli.io.tables import Columns
    from rocking_cli.processing.listed import Listed

T = TypeVar("T")


@dataclass(frozen=True)
class ReadingOptions:
    """Options for reading and scaling records as they are typed, in their order, and those of the user's defaults."""

    options: Mapping[str, Any]
    usual: Mapping[str, Any]

    def __post_init__(self) -> None:
        if (scale := self.options.get("scale", 1)) < 0:
            terminal.note(f"--scale {scale:g} is negative: it reverses the motion, as --polarity -1 does")

    def of(self, *given: Motion) -> Motions:
        """Return ground motions together with the options for reading and scaling them. Raises `InputError`."""
        from rocking_cli.ask.ground_motions import Motions

        return Motions.of(given, self.options, usual=self.usual)


@dataclass(frozen=True)
class GroundMotions(ReadingOptions):
    """Ground motions, with the options for reading and scaling them."""

    polarity: str
    records: tuple[str, ...]
    pulses: tuple[str, ...]

    def __bool__(self) -> bool:
        """Return whether any ground motion is given."""
        return bool(self.records or self.pulses)

    @cached_property
    def motions(self) -> Motions:
        """The ground motions, together with the options for reading and scaling them."""
        from rocking_cli.excitation.pulses import parse_pulse

        return self.of(*map(Path, self.records), *map(parse_pulse, self.pulses))

    def structure(self, files: Sequence[str]) -> str | Path:
        """Return the single structure of a command, by default that of `options.structure`."""
        self.check_strays(files)
        if len(files) > 1:
            raise click.UsageError(f"This command takes one structure, but {len(files)} are given: {', '.join(files)}.")
        from rocking_cli.ask.given import LOCAL_FILE

        return files[0] if files else LOCAL_FILE

    def check_strays(self, files: Sequence[str]) -> None:
        """Raise if records stand in the place of a structure: the shell puts the files of a bare pattern there."""
        endings = {Path(place).suffix.lower() for place in self.records} - {"", ".yaml", ".yml"}
        strays = [file for file in files if Path(file).suffix.lower() in endings]
        if strays:
            raise click.UsageError(
                f"{strays[0]} is given where a structure is expected. If it is a record, put --record before each "
                f"file, or use a quoted pattern: --record '*{Path(strays[0]).suffix}'."
            )

    def check(self, vertical: str | None = None) -> None:
        """Raise if an option has no effect; `units` and `dt` also apply to the vertical component beside a pulse."""
        self.motions.check(with_vertical=vertical is not None)


NEIGHBOUR_OPTIONS = ("neighbours", "amplitude_deviation", "slenderness_deviation", "restitution_deviation")
"""Options of the neighbours of a motion."""


@dataclass(frozen=True)
class Output:
    """The files to write, the signs of a table in text, and whether the result is one JSON object."""

    as_json: bool
    out: Path | None = None
    plot: Path | None = None
    animate: Path | None = None
    separator: str | None = None
    decimal: str | None = None

    def check_signs(self) -> None:
        """Raise if the signs of a table in text have no effect, or are the same."""
        typed = {"--separator": self.separator, "--decimal": self.decimal}
        names = " and ".join(name for name, sign in typed.items() if sign is not None)
        if not names:
            return
        writes = f"{names} {'write' if ' and ' in names else 'writes'} a CSV table"
        if self.out is None:
            raise click.UsageError(f"{writes}, and none is requested: add --out FILE.csv.")
        if self.out.suffix.lower() != ".csv" and str(self.out) != STANDARD_OUTPUT:
            raise click.UsageError(f"{writes}, and {self.out.name} is not one: give a name that ends in .csv.")
        if (self.separator or ",") == self.decimal:
            raise click.UsageError("--decimal , cannot be the separator too: add --separator ';'.")

    @cached_property
    def watch(self) -> OnTerminal:
        """The watcher of the verb, which ends the command when its answer is shown."""
        return OnTerminal(as_json=self.as_json)

    def keep_apart(self, *read: str | Path | Listed | None) -> None:
        """Raise `InputError` if an output would overwrite a file that is read, or a table cannot be written."""
        from rocking_cli.io.files import keep_apart
        from rocking_cli.io.tables import check_table

        files = [str(each.path if isinstance(each, tuple) else each) for each in read if each is not None]
        keep_apart([("--out", self.out), ("--plot", self.plot), ("--animate", self.animate)], files)
        check_table(self.out)

    def blocks(self, answer: Answer[Any]) -> Iterable[Columns]:
        """Return the table of an answer that is written to a file, in blocks of rows."""
        return answer.blocks() if answer.blocks is not None else [answer.columns()]

    def show(self, answer: Answer[Any]) -> None:
        """Write the requested files of an answer, each made only if needed, show it, and end the command."""
        if self.out is not None:
            mark = self.separator is not None or self.decimal is not None  # the table is for a spreadsheet
            signs = {"separator": self.separator or ",", "decimal": self.decimal or "."}
            write_table(self.out, self.blocks(answer), **signs, mark=mark)
        if self.plot is not None:
            write_picture(self.plot, answer.figure())
        terminal.show(answer.view, as_json=self.as_json)
        self.watch.end()


def write_picture(path: Path, figure: Figure) -> None:
    """Write a figure, and report it."""
    from rocking_cli.plotting.style import write

    write(path, figure)
    terminal.note(f"wrote {path}")


def write_table(
    out: Path, blocks: Iterable[Columns], *, separator: str = ",", decimal: str = ".", mark: bool = False
) -> None:
    """Write a table to a file and report it, or write CSV to standard output and keep everything else off it."""
    from rocking_cli.io import tables

    if str(out) == STANDARD_OUTPUT:
        with terminal.results_as_bytes() as stream:
            tables.write_csv(stream, blocks, separator=separator, decimal=decimal)
        return
    tables.write_table(out, blocks, separator=separator, decimal=decimal, mark=mark)
    terminal.note(f"wrote {out}")


def read_table(file: str, parse: Callable[[Spreadsheet], T]) -> T | str:
    """Return what `parse` makes of the table on standard input, or the name of any other file."""
    if file != STANDARD_OUTPUT:
        return file
    from rocking_cli.excitation.records.opening import name_of, original
    from rocking_cli.io.spreadsheet import parse_sheet

    return parse(parse_sheet(original(file), name_of(file)))

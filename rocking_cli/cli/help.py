"""The help of commands, heading by heading and in lines that fit a narrow terminal, and completion by the shell.

Completion never loads a plugin.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from shutil import get_terminal_size
from typing import Any

import click
from click.shell_completion import CompletionItem

from rocking_cli.errors import spelled
from rocking_cli.processing.reading_options import CORRECTIONS, corrected_once

MOTIONS_HEADING, OPTIONS_HEADING, OUTPUT_HEADING = "Ground motions", "Options", "Output"
RECORDS_HEADING, DOCUMENTS_HEADING = "Reading of records", "Documents"
CORRECTIONS_HEADING = "Correction of records"
HEADINGS = (
    MOTIONS_HEADING, OPTIONS_HEADING, "Meshes", "Neighbouring motions", OUTPUT_HEADING, DOCUMENTS_HEADING,
    CORRECTIONS_HEADING, RECORDS_HEADING,
)  # fmt: skip
"""Headings of options, in the order of the help."""
FREE_COLUMNS = 2  # number of columns left free at the right, as in click
# Least width of help texts, and least width that click can lay out, in columns of the terminal.
MIN_WIDTH, MIN_WIDTH_OF_CLICK = 20, 52


class HelpFormatter(click.HelpFormatter):
    """Formatter of click, and for terminals that are too narrow for it, with texts below their options."""

    def __init__(self, indent_increment: int = 2, width: int | None = None, max_width: int | None = None) -> None:
        columns = get_terminal_size().columns
        if width is None and columns < MIN_WIDTH_OF_CLICK:
            width = max(columns, MIN_WIDTH) - FREE_COLUMNS
        super().__init__(indent_increment, width, max_width)

    def write_dl(self, rows: Iterable[tuple[str, str]], *layout: Any, **more: Any) -> None:
        """Write options, or commands, and what they mean."""
        if self.width < MIN_WIDTH_OF_CLICK - FREE_COLUMNS:
            layout, more = (2 * self.indent_increment - FREE_COLUMNS,), {}
        super().write_dl(rows, *layout, **more)


class HeadedOption(click.Option):
    """Option that the help lists under a heading."""

    def __init__(self, *names: Any, heading: str = OPTIONS_HEADING, **more: Any) -> None:
        super().__init__(*names, **more)
        self.heading = heading


def heading_of(option: click.Parameter) -> str:
    """Return the heading of an option in the help."""
    return getattr(option, "heading", OPTIONS_HEADING)


class Command(click.Command):
    """Command whose help lists the options heading by heading."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Parse options; for a correction of a command that uses motions, say where records are corrected."""
        try:
            return super().parse_args(ctx, args)
        except click.NoSuchOption as error:
            name = error.option_name.lstrip("-")
            reads = any(heading_of(each) == RECORDS_HEADING for each in self.params)
            if name not in CORRECTIONS or not reads:
                raise
            with spelled("--{}".format):
                raise click.UsageError(f"No such option --{name}: {corrected_once(name)}.", ctx) from None

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the options, heading by heading."""
        listed: dict[str, list[tuple[str, str]]] = {heading: [] for heading in HEADINGS}
        for param in self.get_params(ctx):
            if isinstance(param, click.Option) and (record := param.get_help_record(ctx)) is not None:
                listed[heading_of(param)].append(record)
        for heading, records in listed.items():
            if records:
                with formatter.section(heading):
                    formatter.write_dl(records)


SWITCHES = (
    ("--all", "in_full", "Show all: explanations, notes on the method, and the rows and columns left out otherwise."),
    ("--json", "as_json", "Print the result as one JSON object, and nothing else."),
)
"""What commands show: the switch, its parameter, and its help."""
_how: Any = {"cls": HeadedOption, "heading": OUTPUT_HEADING, "is_flag": True}
in_full, as_json = (click.option(*names, help=text, **_how) for *names, text in SWITCHES)
CODES, MECHANISMS, PULSES = "rocking.codes", "rocking.mechanisms", "rocking.pulses"
"""Entry-point groups, as in the modules of the plugins, which take long to import."""
Completer = Callable[[click.Context, click.Parameter, str], list[CompletionItem]]


def completer(known: str, *more: str, ending: str = "") -> Completer:
    """Return what completes the value of an option.

    Parameters
    ----------
    known : str
        "file" for names of files, the entry-point group of plugins, or words: separated by spaces, or by commas if the
        option takes several of them.
    *more : str
        Further words beside the names of plugins.
    ending : str
        Suffix of each word.
    """

    def complete(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        if known in ("file", "output"):
            return [CompletionItem(incomplete, type="file")]  # the shell completes it
        before, comma, begun = incomplete.rpartition(",") if "," in known else ("", "", incomplete)
        words = known.replace(",", " ").split()
        if known.startswith("rocking."):
            from rocking_cli.plugins.registry import find

            words = sorted({*find(known), *more})
        typed = before.split(",") if comma else []
        return [
            CompletionItem(f"{before}{comma}{word}{ending}")
            for word in words
            if (word + ending).startswith(begun) and word not in typed
        ]

    return complete

"""Lay out the texts of --help in the width of the terminal, up to a width that is easy to read."""

from __future__ import annotations

import re
from collections.abc import Iterable
from shutil import get_terminal_size

import click

from rocking_cli.cli.prose import HANG, wrapped

WIDEST = 100  # columns
READABLE = 24  # columns, at least, of a meaning beside its option; if fewer are free, it stands below the option
MARGIN = 2  # columns that stay free, as in click
LEAST = 18  # columns of the narrowest text
OPTIONS, OF_RECORDS = "Options", "Reading and processing of records"  # headings


class HelpFormatter(click.HelpFormatter):
    """Formatter for narrow terminals too: that of click takes at least 50 columns, and breaks words."""

    def __init__(self, indent_increment: int = 2, width: int | None = None, max_width: int | None = None) -> None:
        room = min(get_terminal_size().columns, max_width or WIDEST) - MARGIN
        super().__init__(indent_increment, width or max(room, LEAST), max_width)

    def write_usage(self, prog: str, args: str = "", prefix: str | None = None) -> None:
        """Write how the command is called."""
        before = "Usage: " if prefix is None else prefix
        called = f"{' ' * self.current_indent}{before}{prog} {args}".rstrip()
        self.write(f"{wrapped(called, self.width, hang=len(before))}\n")

    def write_heading(self, heading: str) -> None:
        """Write the heading of a section."""
        line = f"{' ' * self.current_indent}{heading}:"
        self.write(f"{wrapped(line, self.width + MARGIN)}\n")

    def write_text(self, text: str) -> None:
        r"""Write paragraphs; those after a `\b` keep their lines."""
        indent = " " * self.current_indent
        for k, paragraph in enumerate(re.split(r"\n\s*\n", text)):
            kept = paragraph.startswith("\b")
            lines = paragraph.splitlines()[1:] if kept else [" ".join(paragraph.split())]
            room = self.width + MARGIN if kept else self.width
            self.write("\n" if k else "")
            for line in lines:
                self.write(f"{wrapped(indent + line, room, hang=HANG if kept else 0)}\n")

    def write_dl(self, rows: Iterable[tuple[str, str]], col_max: int = 30, col_spacing: int = 2) -> None:
        """Write options, or commands, and what they mean."""
        rows = list(rows)
        longest = max((len(word) for _, meaning in rows for word in meaning.split()), default=0)
        if self.width - col_max - 2 * col_spacing >= max(READABLE, longest):
            self._write_beside(rows, col_max, col_spacing)
            return
        for term, meaning in rows:
            below = " " * (self.current_indent + 2 * self.indent_increment)
            self.write(f"{wrapped(' ' * self.current_indent + term, self.width + MARGIN)}\n")
            self.write(f"{wrapped(below + meaning, self.width, hang=0)}\n" if meaning else "")

    def _write_beside(self, rows: list[tuple[str, str]], col_max: int, col_spacing: int) -> None:
        """Write meanings beside their terms, as click does, but break no word at its hyphen."""
        first = min(max((len(term) for term, _ in rows), default=0), col_max) + col_spacing
        for term, meaning in rows:
            head = " " * self.current_indent + term
            if not meaning:
                self.write(f"{head}\n")
                continue
            lines = wrapped(meaning, self.width - first - 2, hang=0).splitlines()
            beside = len(term) <= first - col_spacing
            left = " " * (self.current_indent + first)
            self.write(head.ljust(len(left)) if beside else f"{head}\n{left}")
            self.write(f"\n{left}".join(lines) + "\n")


class RecordOption(click.Option):
    """Option that reads or processes records; the help lists it under a heading of its own."""

    heading = OF_RECORDS


class Command(click.Command):
    """Command whose help lists the options of records under a heading of their own."""

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the options, heading by heading."""
        listed: dict[str, list[tuple[str, str]]] = {OPTIONS: [], OF_RECORDS: []}
        for param in self.get_params(ctx):
            if isinstance(param, click.Option) and (record := param.get_help_record(ctx)) is not None:
                listed[getattr(param, "heading", OPTIONS)].append(record)
        for heading, records in listed.items():
            if records:
                with formatter.section(heading):
                    formatter.write_dl(records)


class Context(click.Context):
    """Context of a command that formats its help with `HelpFormatter`."""

    formatter_class = HelpFormatter

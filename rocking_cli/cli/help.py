"""The help of commands: the options of records under a heading of their own, and lines that fit a narrow terminal."""

from __future__ import annotations

from collections.abc import Iterable
from shutil import get_terminal_size
from typing import Any

import click

OPTIONS_HEADING, RECORDS_HEADING = "Options", "Reading and processing of records"
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


class RecordOption(click.Option):
    """Option that reads or processes records; the help lists it under a heading of its own."""


class Command(click.Command):
    """Command whose help lists the options of records under a heading of their own."""

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the options, heading by heading."""
        listed: dict[str, list[tuple[str, str]]] = {OPTIONS_HEADING: [], RECORDS_HEADING: []}
        for param in self.get_params(ctx):
            if isinstance(param, click.Option) and (record := param.get_help_record(ctx)) is not None:
                listed[RECORDS_HEADING if isinstance(param, RecordOption) else OPTIONS_HEADING].append(record)
        for heading, records in listed.items():
            if records:
                with formatter.section(heading):
                    formatter.write_dl(records)

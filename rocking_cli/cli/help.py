"""The options of records under a heading of their own in the help of a command."""

from __future__ import annotations

import click

OPTIONS, OF_RECORDS = "Options", "Reading and processing of records"  # headings


class RecordOption(click.Option):
    """Option that reads or processes records; the help lists it under a heading of its own."""


class Command(click.Command):
    """Command whose help lists the options of records under a heading of their own."""

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the options, heading by heading."""
        listed: dict[str, list[tuple[str, str]]] = {OPTIONS: [], OF_RECORDS: []}
        for param in self.get_params(ctx):
            if isinstance(param, click.Option) and (record := param.get_help_record(ctx)) is not None:
                listed[OF_RECORDS if isinstance(param, RecordOption) else OPTIONS].append(record)
        for heading, records in listed.items():
            if records:
                with formatter.section(heading):
                    formatter.write_dl(records)

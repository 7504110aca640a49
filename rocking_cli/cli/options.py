"""The option `--json` of commands that are no question."""

from __future__ import annotations

import click

from rocking_cli.cli.help import OUTPUT_HEADING, HeadedOption

JSON_HELP = "Print the result as one JSON object, and nothing else."
as_json = click.option("--json", "as_json", cls=HeadedOption, heading=OUTPUT_HEADING, is_flag=True, help=JSON_HELP)

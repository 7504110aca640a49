"""`rocking info`: what is installed here, and what is taken for granted."""

from __future__ import annotations

import os
from typing import Any

import click

from rocking_cli.cli import defaults, options, terminal

OURS = ("ROCKING_", "NUMBA_")
"""How variables of the environment begin that change what a command does."""


@click.command(short_help="What is installed here: versions, plugins, cache, defaults.")
@options.as_json
def command(as_json: bool) -> None:
    """What is installed here: versions, extras, plugins and what is wrong with them, compiled code, own defaults.

    It works whatever is broken, and is what a report of a fault should begin with.

    \b
    Example:
      rocking info
      rocking info --json > info.json
    """
    from rocking_cli.studies.installation import examine
    from rocking_cli.views.info import view

    terminal.show(view(examine(), _defaults()), as_json=as_json)


def _defaults() -> dict[str, Any]:
    """The user's defaults, and what is wrong with them."""
    from rocking_cli.cli.main import COMMANDS
    from rocking_cli.errors import InputError

    found: list[defaults.Default] = []
    problem = None
    try:
        found = defaults.in_force(COMMANDS)
    except InputError as error:
        problem = str(error)
    return {
        "files": [str(each) for each in defaults.files()],
        "user_file": str(defaults.user_file()),
        "set": [
            {"option": each.option, "command": each.command, "value": each.value, "place": each.place} for each in found
        ],
        "environment": {name: value for name, value in sorted(os.environ.items()) if name.startswith(OURS)},
        "unknown": defaults.unknown_variables(),
        "problem": problem,
    }

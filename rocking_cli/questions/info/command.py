"""`rocking info`: show the installation and the defaults in force."""

from __future__ import annotations

import os
from typing import Any

import click

from rocking_cli.cli import defaults, options, terminal
from rocking_cli.cli.help import Command


@click.command(cls=Command, short_help="Show the installation: versions, plugins, kernels, defaults.")
@options.as_json
def command(as_json: bool) -> None:
    """Show the installation: versions, extras, plugins and their faults, kernels, and your defaults.

    The command works even if parts of the installation are broken. Put its output at the head of a bug report.

    \b
    Example:
      rocking info
      rocking info --json > info.json
    """
    from rocking_cli.questions.info.study import examine
    from rocking_cli.questions.info.view import view

    terminal.show(view(examine(), _defaults()), as_json=as_json)


def _defaults() -> dict[str, Any]:
    """Return the user's defaults, and what is wrong with them."""
    from rocking_cli.errors import InputError

    settings: list[defaults.Default] = []
    problem = None
    try:
        settings = defaults.in_force()
    except InputError as error:
        problem = str(error)
    return {
        "files": [str(each) for each in defaults.files()],
        "user_file": str(defaults.user_file()),
        "set": [
            {"option": each.option, "command": each.command, "value": each.value, "place": each.place}
            for each in settings
        ],
        "environment": {name: value for name, value in sorted(os.environ.items()) if name.startswith("ROCKING_")},
        "unknown": defaults.unknown_variables(),
        "problem": problem,
    }

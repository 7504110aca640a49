"""`rocking info`: show the installation."""

from __future__ import annotations

import click

from rocking_cli.cli import terminal
from rocking_cli.cli.help import Command, as_json


@click.command(cls=Command, short_help="Show the installation: versions, plugins, kernels.")
@as_json
def command(as_json: bool) -> None:
    """Show the installation: versions, extras, plugins and their faults, kernels, and variables of the environment.

    The command works even if parts of the installation are broken. Put its output at the head of a bug report.

    \b
    Example:
      rocking info
      rocking info --json > info.json
    """
    from rocking_cli.questions.info.study import examine, view

    terminal.show(view(examine()), as_json=as_json)

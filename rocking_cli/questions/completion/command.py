"""`rocking completion`: print the shell completion script."""

from __future__ import annotations

import click

from rocking_cli.cli import terminal
from rocking_cli.cli.help import Command, as_json

COMPLETION_VARIABLE = "_ROCKING_COMPLETE"
"""Variable of the environment by which the shell requests completions, named as click expects it."""


@click.command(cls=Command, short_help="Print the shell completion script.")
@click.argument("shell", type=click.Choice(["bash", "zsh", "fish"]))
@as_json
def command(shell: str, as_json: bool) -> None:
    """Print a script for the shell that completes commands, options, mechanisms, pulse shapes, models and files.

    \b
    Example:
      rocking completion bash > ~/.local/share/bash-completion/completions/rocking
      rocking completion zsh > ~/.zfunc/_rocking
      rocking completion fish > ~/.config/fish/completions/rocking.fish
    """
    from click.shell_completion import get_completion_class

    maker = get_completion_class(shell)
    assert maker is not None
    completion = maker(click.get_current_context().find_root().command, {}, "rocking", COMPLETION_VARIABLE)
    script = completion.source_template % completion.source_vars()  # `source()` would run bash to find its version
    if as_json:
        terminal.print_json({"shell": shell, "script": script})
    else:
        terminal.result(script.rstrip("\n"))

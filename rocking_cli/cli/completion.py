"""`rocking completion`: what a shell needs to complete command lines."""

from __future__ import annotations

import click

from rocking_cli.cli import options, terminal

VARIABLE = "_ROCKING_COMPLETE"
"""Of the environment: by it the shell asks, and the program answers, as click does for a program of this name."""


@click.command(short_help="Print what makes a shell complete commands, options and names.")
@click.argument("shell", type=click.Choice(["bash", "zsh", "fish"]))
@options.as_json
def command(shell: str, as_json: bool) -> None:
    """Print a script that makes a shell complete commands, options, mechanisms, shapes of pulses, models and files.

    \b
    Example:
      rocking completion bash > ~/.local/share/bash-completion/completions/rocking
      rocking completion zsh > ~/.zfunc/_rocking
      rocking completion fish > ~/.config/fish/completions/rocking.fish
    """
    from click.shell_completion import get_completion_class

    maker = get_completion_class(shell)
    assert maker is not None
    made = maker(click.get_current_context().find_root().command, {}, "rocking", VARIABLE)
    script = made.source_template % made.source_vars()  # `source` runs bash to see how old it is
    if as_json:
        terminal.print_json({"shell": shell, "script": script})
    else:
        terminal.result(script.rstrip("\n"))

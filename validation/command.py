"""Commands of this folder, `python -m validation.NAME`, with the options, messages and exit codes of `rocking`."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import Any

import click

from rocking_cli.ask.asked import AskedModel
from rocking_cli.ask.verbs import Verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.cli.made import Made
from rocking_cli.cli.main import LazyGroup
from rocking_cli.cli.main import main as rocking


class Command(Made):
    """Command that asks a question of this folder.

    Parameters
    ----------
    module : str
        Name of the module that is run.
    model : type
        The model of the question.
    verb : Verb
        The verb that answers it.
    """

    def __init__(self, module: str, model: type[AskedModel], verb: Verb[Any]) -> None:
        super().__init__(f"python -m validation.{module}", model, "")
        self.verb = verb

    def ask(self, given: Mapping[str, Any], usual: Mapping[str, Any], watch: Watcher) -> Any:
        """Ask the verb."""
        return self.verb.ask(given, usual, watch)


class Alone(LazyGroup):
    """The program `rocking` with one command only, whose name is not typed."""

    def __init__(self, command: Command) -> None:
        super().__init__("", params=rocking.params, callback=rocking.callback)
        self.only = command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Return the one command."""
        return self.only.name, self.only, args[1:]


def run(command: Command) -> None:
    """Run a command with the arguments of the process, which it ends."""
    Alone(command).main(args=[f"{command.name}", *sys.argv[1:]], prog_name="")

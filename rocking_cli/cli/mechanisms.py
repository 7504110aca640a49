"""`rocking mechanisms`: what is installed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from rocking_cli.cli import complete, options, terminal

PARTS = ("loads", "ties", "interlock", "strength", "crushing")  # what hangs on any mechanism, and has fields of its own

if TYPE_CHECKING:
    from rocking_cli.core.registry import Registry


@click.command(short_help="List the installed mechanisms, show the fields of one, or check it.")
@click.argument("name", required=False, shell_complete=complete.mechanisms())
@click.argument("file", required=False, type=click.Path())
@click.option("--check", "checked", is_flag=True, help="Hold NAME to the contract: of its examples, or of FILE.")
@options.as_json
def command(name: str | None, file: str | None, checked: bool, as_json: bool) -> None:
    """List the mechanisms that are installed and the package each comes from; with NAME, its fields.

    `loads`, `ties`, `interlock`, `strength` and `crushing` are no mechanisms, and go with any: their fields, by NAME.

    `--check` holds what a mechanism says to its bodies and their motion, prints what passes and what fails with the
    traceback of an error of its own, and ends with 3 if anything fails. FILE is a structure to check it on.

    \b
    Example:
      rocking mechanisms
      rocking mechanisms arch
      rocking mechanisms --check arch
    """
    from rocking_cli.core.registry import Registry

    if checked and name is None:
        raise click.UsageError("--check needs the NAME of a mechanism.")
    if file is not None and not checked:
        raise click.UsageError("FILE goes with --check.")
    registry = Registry()
    if name is not None and checked:
        from rocking_cli.cli.mechanism_check import check

        check(name, file, registry, as_json)
    elif name in PARTS and name not in registry:
        from rocking_cli.views.mechanisms import part

        terminal.show(part(str(name)), as_json=as_json)
    elif name is not None:
        from rocking_cli.views.mechanisms import view

        terminal.show(view(registry[name], registry.package_of(name)), as_json=as_json)
    else:
        _all(registry, as_json)


def _all(registry: Registry, as_json: bool) -> None:
    from rocking_cli.errors import MechanismError
    from rocking_cli.views.mechanisms import Installed, installed

    found = []
    for name in registry:
        try:
            title: str | None = registry[name].title
        except MechanismError as error:  # one broken plugin must not hide the others
            terminal.warning(str(error))
            terminal.debug_traceback(error)
            title = None
        found.append(Installed(name, title, registry.package_of(name)))
    terminal.show(installed(found), as_json=as_json)

"""`rocking mechanisms`: list, describe or check the installed mechanisms."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from rocking_cli.cli import complete, options, terminal

# Additions to any mechanism, with fields of their own.
PARTS = ("loads", "ties", "interlock", "strength", "crushing", "uncertainty")

if TYPE_CHECKING:
    from rocking_cli.core.registry import Registry


@click.command(short_help="List, describe or check the installed mechanisms.")
@click.argument("name", required=False, shell_complete=complete.mechanisms())
@click.argument("file", required=False, type=click.Path())
@click.option(
    "--check",
    "checked",
    is_flag=True,
    help="Check NAME against the contract of mechanisms, on its examples or on FILE.",
)
@options.as_json
def command(name: str | None, file: str | None, checked: bool, as_json: bool) -> None:
    """List the installed mechanisms and the package of each; with NAME, show the fields of one.

    NAME may also be `loads`, `ties`, `interlock`, `strength`, `crushing` or `uncertainty`, which can be added to any
    mechanism.

    With --check, the command compares the coefficients of the mechanism with its bodies and their motion, and prints
    which checks pass and which fail, with the traceback of an error in the mechanism. The exit code is 3 if a check
    fails. FILE is a structure on which to check the mechanism.

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
        raise click.UsageError("FILE requires --check.")
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
    from rocking_cli.views.mechanisms import InstalledMechanism, installed

    found = []
    for name in registry:
        try:
            title: str | None = registry[name].title
        except MechanismError as error:  # one broken plugin must not hide the others
            terminal.warning(str(error))
            terminal.debug_traceback(error)
            title = None
        found.append(InstalledMechanism(name, title, registry.package_of(name)))
    terminal.show(installed(found), as_json=as_json)

"""`rocking mechanisms`: list, describe or check the installed mechanisms."""

from __future__ import annotations

from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING

import click

from rocking_cli.cli import terminal
from rocking_cli.cli.help import MECHANISMS, Command, as_json, completer, in_full
from rocking_cli.errors import InputError, MechanismError, RockingError
from rocking_cli.io.files import check_writable

if TYPE_CHECKING:
    from rocking_cli.core import Mechanism
    from rocking_cli.core.registry import Registry, Verdict
    from rocking_cli.studies.picture import Picture

PARTS = ("loads", "ties", "stops", "interlock", "strength", "crushing", "uncertainty")
"""Additions to any mechanism, with fields of their own."""
LOADS_CHECK = "The plugin can be loaded, and is a mechanism."
TEMPLATE_CHECK = "The file that `rocking new` prints is a structure."


@click.command(cls=Command, short_help="List, describe or check the installed mechanisms.")
@click.argument("name", required=False, shell_complete=completer(MECHANISMS))
@click.argument("file", required=False, type=click.Path())
@click.option(
    "--check",
    "checked",
    is_flag=True,
    help="Check NAME against the contract of mechanisms, on its examples or on FILE.",
)
@click.option(
    "--plot", metavar="FILE.png", type=click.Path(path_type=Path), shell_complete=completer("file"),
    help="Draw all mechanisms, small, to choose one (.png, .svg or .pdf).",
)  # fmt: skip
@in_full
@as_json
def command(
    name: str | None, file: str | None, checked: bool, plot: Path | None, as_json: bool, in_full: bool
) -> None:  # fmt: skip
    """List the installed mechanisms and the structures that each suits; with NAME, show the fields of one.

    NAME may also be `loads`, `ties`, `stops`, `interlock`, `strength`, `crushing` or `uncertainty`, which can be added
    to any mechanism.

    With --check, the command compares the coefficients of the mechanism with its bodies and their motion, and prints
    which checks pass and which fail, with the traceback of an error in the mechanism. The exit code is 3 if a check
    fails. FILE is a structure on which to check the mechanism.

    \b
    Example:
      rocking mechanisms
      rocking mechanisms --plot chooser.png
      rocking mechanisms arch
      rocking mechanisms --check arch
    """
    from rocking_cli.core.registry import Registry

    if checked and name is None:
        raise click.UsageError("--check needs the NAME of a mechanism.")
    if file is not None and not checked:
        raise click.UsageError("FILE requires --check.")
    if name is not None and plot is not None:
        raise click.UsageError(f"--plot draws all mechanisms: leave out {name}, or use rocking draw for a structure.")
    registry = Registry()
    if name is not None and checked:
        check(name, file, registry, as_json)
    elif name in PARTS and name not in registry:
        from rocking_cli.views.mechanisms import part

        terminal.show(part(str(name)), as_json=as_json)
    elif name is not None:
        from rocking_cli.views.mechanisms import view

        terminal.show(view(registry[name], registry.package_of(name)), as_json=as_json)
    else:
        _all(registry, plot, as_json)


def _all(registry: Registry, plot: Path | None, as_json: bool) -> None:
    from rocking_cli.views.mechanisms import InstalledMechanism, installed

    rows = []
    for name in registry:
        package = registry.package_of(name)
        try:
            rows.append(InstalledMechanism(name, registry[name].title, registry[name].suits or None, package))
        except MechanismError as error:  # one broken plugin must not hide the others
            terminal.warning(str(error))
            terminal.debug_traceback(error)
            rows.append(InstalledMechanism(name, None, None, package))
    if plot is not None:
        check_writable(plot, ".png", ".svg", ".pdf")
        from rocking_cli.plotting.style import write
        from rocking_cli.questions.mechanisms.picture import draw_chooser

        write(plot, draw_chooser([(each, drawing(each.name, registry) if each.title else None) for each in rows]))
        terminal.note(f"wrote {plot}")
    terminal.show(installed(rows), as_json=as_json)


def drawing(name: str, registry: Registry) -> Picture | None:
    """Return the drawing of a structure that `rocking new` prints for a mechanism; None if it cannot be drawn.

    It is that of the mechanism's own template, or of a common structure if that template gives no shape.
    """
    from rocking_cli.core.structure_file import parse_structure
    from rocking_cli.io.starters import STARTERS, starter
    from rocking_cli.studies.picture import picture
    from rocking_cli.views.mechanisms import template

    # The later ones are of less regular shape.
    common = (text for text in map(starter, reversed(STARTERS)) if f"mechanism: {name}\n" in text)
    without_shape = None
    try:
        for text in chain([template(registry[name])], common):
            drawn = picture(parse_structure(text, f"rocking new {name}", name, registry))
            if not any(part.assumed for part in drawn.parts):
                return drawn
            without_shape = without_shape or drawn
    except RockingError as error:
        terminal.warning(f"{name} is not drawn: {error}")
    return without_shape


def check(name: str, file: str | None, registry: Registry, as_json: bool) -> None:
    """Print which checks of the contract a mechanism passes; exit with the code of `MechanismError` if one fails.

    Parameters
    ----------
    name : str
        Name of the mechanism.
    file : str or None
        A structure of the mechanism; without one, its examples are checked.
    registry : Registry
        Registry of mechanisms.
    as_json : bool
        Whether to print one JSON object.

    Raises
    ------
    InputError
        If the mechanism does not exist, or the file is not a structure of it.
    """
    from rocking_cli.views.mechanisms import checked

    verdicts = _verdicts(name, file, registry)
    package = registry.package_of(name)
    failed = [each for each in verdicts if not each.passed]
    terminal.show(checked(name, package, file, verdicts), as_json=as_json)
    if not as_json:
        passes = f"fails {len(failed)} of {len(verdicts)} checks" if failed else f"passes all {len(verdicts)} checks"
        terminal.note(f"{name} ({package}), {file or 'its examples'}: {passes}")
    if failed:
        click.get_current_context().exit(MechanismError.exit_code)


def _verdicts(name: str, file: str | None, registry: Registry) -> list[Verdict]:
    from rocking_cli.core.structure_file import load_structure, parse_structure
    from rocking_cli.testing import contract, verdict
    from rocking_cli.views.mechanisms import template

    built: list[Mechanism] = []

    def make() -> None:
        if file is None:
            text = template(registry[name])
            built.append(parse_structure(text, f"rocking new {name}", name, registry))
        else:
            built.append(load_structure(file, registry))

    if name not in registry:
        registry[name]  # raises an error that suggests similar names
    loads = verdict("loads", LOADS_CHECK, lambda: registry[name])
    if not loads.passed:
        return [loads]
    if file is None:
        builds = verdict("makes_a_structure", TEMPLATE_CHECK, make)
        return [loads, builds, *(contract(built[0]) if built else [])]
    make()
    if built[0].mechanism != name:
        raise InputError(f"{file} is a structure of the mechanism {built[0].mechanism}, not of {name}")
    return [loads, *contract(built[0])]

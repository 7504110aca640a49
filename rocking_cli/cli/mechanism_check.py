"""`rocking mechanisms --check`: check an installed mechanism against the contract."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from rocking_cli.cli import terminal
from rocking_cli.errors import InputError, MechanismError

if TYPE_CHECKING:
    from rocking_cli.core import Mechanism
    from rocking_cli.core.contract import Verdict
    from rocking_cli.core.registry import Registry

LOADS = "The plugin can be loaded, and is a mechanism."
MADE = "The file that `rocking new` prints is a structure."


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
        terminal.note(f"{name} ({package}), {file or 'its examples'}: {_count(verdicts, failed)}")
    if failed:
        click.get_current_context().exit(MechanismError.exit_code)


def _verdicts(name: str, file: str | None, registry: Registry) -> list[Verdict]:
    from rocking_cli.structure_file import load_structure
    from rocking_cli.testing import contract, verdict

    found: list[Mechanism] = []

    def make() -> None:
        found.append(load_structure(file, registry) if file is not None else _first(name, registry))

    if name not in registry:
        registry[name]  # raises, with a guess
    loads = verdict("loads", LOADS, lambda: registry[name])
    if not loads.passed:
        return [loads]
    if file is None:
        made = verdict("makes_a_structure", MADE, make)
        return [loads, made, *(contract(found[0]) if found else [])]
    make()
    if found[0].mechanism != name:
        raise InputError(f"{file} is a structure of the mechanism {found[0].mechanism}, not of {name}")
    return [loads, *contract(found[0])]


def _first(name: str, registry: Registry) -> Mechanism:
    from rocking_cli.structure_file import parse_structure
    from rocking_cli.views.template import template

    return parse_structure(template(registry[name]), f"rocking new {name}", name, registry)


def _count(verdicts: list[Verdict], failed: list[Verdict]) -> str:
    return f"passes all {len(verdicts)} checks" if not failed else f"fails {len(failed)} of {len(verdicts)} checks"

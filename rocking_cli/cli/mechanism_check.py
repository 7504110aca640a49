"""`rocking mechanisms --check`: what the contract says of an installed mechanism."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from rocking_cli.cli import terminal
from rocking_cli.errors import InputError, MechanismError

if TYPE_CHECKING:
    from rocking_cli.core import Mechanism
    from rocking_cli.core.registry import Registry
    from rocking_cli.testing import Verdict

LOADS = "The plugin can be loaded, and is a mechanism."
MADE = "The file that `rocking new` prints is a structure."


def check(name: str, file: str | None, registry: Registry, as_json: bool) -> None:
    """Print which checks of the contract a mechanism passes; exits with that of a `MechanismError` if it fails one.

    Parameters
    ----------
    name : str
        The mechanism.
    file : str or None
        A structure of it; without one, its examples.
    registry : Registry
        Where it is looked up.
    as_json : bool
        Whether to print one JSON object.

    Raises
    ------
    InputError
        If there is no such mechanism, or the file is no structure of it.
    """
    verdicts = _verdicts(name, file, registry)
    failed = [each for each in verdicts if not each.passed]
    if as_json:
        checks = [
            {
                "check": each.check,
                "meaning": each.meaning,
                "passed": each.passed,
                "why": each.why,
                "traceback": each.trace,
            }
            for each in verdicts
        ]
        found = {"mechanism": name, "package": registry.package_of(name), "file": file}
        terminal.print_json({**found, "passed": not failed, "checks": checks})
    else:
        _print(verdicts)
        terminal.note(f"{name} ({registry.package_of(name)}), {file or 'its examples'}: {_count(verdicts, failed)}")
    if failed:
        click.get_current_context().exit(MechanismError.exit_code)


def _verdicts(name: str, file: str | None, registry: Registry) -> list[Verdict]:
    from rocking_cli.structure import load_structure
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
    from rocking_cli.cli.new import template
    from rocking_cli.structure import parse_structure

    return parse_structure(template(registry[name]), f"rocking new {name}", name, registry)


def _print(verdicts: list[Verdict]) -> None:
    """A line for each check, and under it the traceback of an error of the plugin's own; an error is told once."""
    told: set[str] = set()
    for each in verdicts:
        if each.why is None:
            terminal.result(f"passes  {each.meaning}")
        elif each.why in told:
            terminal.result(f"FAILS   {each.meaning} The same error.")
        else:
            told.add(each.why)
            terminal.result(f"FAILS   {each.meaning} {_in_a_line(each.why)}")
            if each.trace is not None:
                terminal.result(each.trace)


def _in_a_line(why: str) -> str:
    """An error without the lines that it quotes."""
    return "; ".join(line.strip() for line in why.splitlines() if not line.startswith("    "))


def _count(verdicts: list[Verdict], failed: list[Verdict]) -> str:
    return f"passes all {len(verdicts)} checks" if not failed else f"fails {len(failed)} of {len(verdicts)} checks"

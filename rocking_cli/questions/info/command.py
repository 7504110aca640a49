"""`rocking info`: packages, plugins and compiled kernels on this machine, and which of them work."""

from __future__ import annotations

import os
import platform
import re
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from importlib.metadata import PackageNotFoundError, requires, version
from typing import Any

import click

from rocking_cli.cli import terminal
from rocking_cli.cli.help import Command, as_json
from rocking_cli.core.hung.ties import Laws
from rocking_cli.core.registry import Registry
from rocking_cli.dynamics import ways
from rocking_cli.errors import InputError, RockingError
from rocking_cli.excitation.pulses import PulseShapes
from rocking_cli.excitation.records.formats import Readers
from rocking_cli.plugins.registry import Plugins
from rocking_cli.processing.intensity import IntensityMeasures
from rocking_cli.verification.code import Codes
from rocking_cli.views.column import table_of, text_columns
from rocking_cli.views.view import View

OWN_PACKAGE = "rocking-cli"
IGNORED_EXTRAS = ("dev", "docs", "bench", "release")
"""Extras that add nothing to a command."""
VARIABLES = ("ROCKING_DEBUG", "ROCKING_BROWSER", "ROCKING_KERNELS")
"""Variables of the environment that the program reads."""


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
    terminal.show(view(examine()), as_json=as_json)


@dataclass(frozen=True)
class Plugin:
    """An installed mechanism, record reader, pulse shape, measure of intensity or code of practice.

    Parameters
    ----------
    name, package : str
        Name of the plugin, and the distribution and version that it comes from.
    broken : str or None
        Why the plugin cannot be used; None if it can.
    """

    name: str
    package: str
    broken: str | None


@dataclass(frozen=True)
class Installation:
    """The parts of `rocking` as installed on this machine.

    Parameters
    ----------
    version, python, platform : str
        Versions of this package and of the interpreter, and the platform.
    libraries : mapping of str to str or None
        Version of every required package; None if it is missing.
    extras : mapping of str to mapping
        For each extra of this package, the versions of its packages in the same way.
    plugins : mapping of str to tuple of Plugin
        Plugins by kind: `mechanisms`, `records`, `pulses`, `measures` and `codes`; `laws` only if other packages
        provide some.
    kernels : str or None
        How kernels are run: by machine code at level `v4`, `v3` or `v1` of processors or `scalar`, or by `python`;
        None if the variable of the environment asks for what is not here.
    slow_kernels : str or None
        Why Python runs the kernels, which takes some sixty times longer, or why nothing does; None if the shipped
        machine code is used.
    processors, threads : int
        Number of processors of the machine, and of threads that this process may use.
    environment : mapping of str to str
        Variables of the environment with the prefix of the program.
    """

    version: str
    python: str
    platform: str
    libraries: Mapping[str, str | None]
    extras: Mapping[str, Mapping[str, str | None]]
    plugins: Mapping[str, tuple[Plugin, ...]]
    kernels: str | None
    slow_kernels: str | None
    processors: int
    threads: int
    environment: Mapping[str, str]


def examine() -> Installation:
    """Return what is installed; a broken package or plugin is noted and raises no error."""
    libraries, extras = _packages()
    return Installation(
        version(OWN_PACKAGE),
        f"{platform.python_implementation()} {platform.python_version()}",
        platform.platform(),
        libraries,
        extras,
        {
            "mechanisms": _plugins(Registry()),
            "records": _plugins(Readers()),
            "pulses": _plugins(PulseShapes()),
            "measures": _plugins(IntensityMeasures()),
            "codes": _plugins(Codes()),
            **({"laws": laws} if (laws := _plugins(Laws())) else {}),
        },
        *_kernels(),
        os.cpu_count() or 1,
        len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1,
        {name: value for name, value in sorted(os.environ.items()) if name.startswith("ROCKING_")},
    )


def _kernels() -> tuple[str | None, str | None]:
    """Return how kernels are run, and why not by the shipped machine code."""
    if os.environ.get(ways.KERNELS_VARIABLE) == ways.PYTHON:
        return ways.PYTHON, f"{ways.KERNELS_VARIABLE} is {ways.PYTHON}"
    fault = ways.fault_of_shipped()
    if fault is not None:
        return ways.PYTHON, str(fault)
    try:
        return ways.way(), None
    except InputError as error:
        return None, str(error)


def _packages() -> tuple[dict[str, str | None], dict[str, dict[str, str | None]]]:
    """Return the versions of the packages that this one requires, and of those of each of its extras."""
    needed: dict[str, str | None] = {}
    extras: dict[str, dict[str, str | None]] = {}
    for line in requires(OWN_PACKAGE) or []:
        name, extra = re.match(r"[\w.-]+", line), re.search(r"extra == ['\"]([\w-]+)", line)
        if name is not None and (extra is None or extra[1] not in IGNORED_EXTRAS):
            (needed if extra is None else extras.setdefault(extra[1], {}))[name[0]] = _version(name[0])
    return needed, extras


def _version(name: str) -> str | None:
    try:
        return version(name)
    except PackageNotFoundError:
        return None


def _plugins(installed: Plugins[Any]) -> tuple[Plugin, ...]:
    return tuple(Plugin(name, installed.package_of(name), _broken(installed, name)) for name in installed)


def _broken(installed: Plugins[Any], name: str) -> str | None:
    try:
        installed[name]
    except RockingError as error:
        return str(error)
    return None


def view(found: Installation) -> View:
    """Show what is installed, for users and for fault reports."""
    slow, environment = found.slow_kernels, found.environment
    without = "in Python, some sixty times slower" if found.kernels else "none"
    rows = [
        [OWN_PACKAGE, found.version],
        ["Python", found.python],
        ["platform", found.platform],
        ["processors", f"{found.processors}, {found.threads} of them for this process"],
        *([name, version or "missing"] for name, version in found.libraries.items()),
        *(_extra(name, packages) for name, packages in found.extras.items()),
        *(row for kind, plugins in found.plugins.items() for row in _plugin_rows(kind, plugins)),
        ["kernels", f"shipped machine code, {found.kernels}" if slow is None else f"{without}: {slow}"],
    ]
    if environment:
        rows.append(["environment", " ".join(f"{name}={value}" for name, value in environment.items())])
    unused = [name for name in environment if name not in VARIABLES]
    sentences = [f"The environment variable {name} is not used by rocking." for name in unused]
    return View(asdict(found), [table_of("", text_columns("what", "here"), rows), *sentences])


def _extra(name: str, packages: Mapping[str, str | None]) -> list[str]:
    missing = [package for package, version in packages.items() if version is None]
    if missing:
        return [f"extra {name}", f"no {', '.join(missing)}: pip install '{OWN_PACKAGE}[{name}]'"]
    return [f"extra {name}", ", ".join(f"{package} {version}" for package, version in packages.items())]


def _plugin_rows(kind: str, plugins: Sequence[Plugin]) -> list[list[str]]:
    """Return a row for each package with its plugins, and one for each broken plugin."""
    packages: dict[str, list[str]] = {}
    for each in plugins:
        packages.setdefault(each.package, []).append(each.name)
    rows = [[kind, f"{', '.join(names)} ({package})"] for package, names in packages.items()]
    return rows + [[f"broken: {each.name}", each.broken] for each in plugins if each.broken is not None]

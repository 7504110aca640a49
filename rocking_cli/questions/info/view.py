"""View of the installation on this machine, for users and for fault reports."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from operator import itemgetter
from typing import Any

from rocking_cli.questions.info.study import OWN_PACKAGE, Installation, Plugin
from rocking_cli.views.column import Column, only_shown, table_of, text_columns
from rocking_cli.views.view import Table, View

DEFAULTS: tuple[Column[Mapping[str, Any]], ...] = (
    only_shown("option", itemgetter("option"), text=True),
    only_shown("value", itemgetter("value"), text=True),
    only_shown("of", lambda each: each["command"] or "every command", text=True),
    only_shown("from", itemgetter("place"), text=True),
)
"""Columns of the table of the user's defaults; a row is the plain data of one default."""


def view(found: Installation, defaults: Mapping[str, Any]) -> View:
    """Show what is installed, and the user's defaults.

    Parameters
    ----------
    found : Installation
        What is installed.
    defaults : mapping
        `files`, the files of defaults that exist; `user_file`, path of the user's own file; `set`, each default with
        `option`, `command`, `value` and `place`; `environment`, variables that change what commands do; `unknown`,
        variables without meaning; and `problem`, what is wrong with a file, or None.
    """
    data, slow = {**asdict(found), "defaults": defaults}, found.slow_kernels
    rows = [
        [OWN_PACKAGE, found.version],
        ["Python", found.python],
        ["platform", found.platform],
        ["processors", f"{found.processors}, {found.threads} of them for this process"],
        *([name, version or "missing"] for name, version in found.libraries.items()),
        *(_extra(name, packages) for name, packages in found.extras.items()),
        *(row for kind, plugins in found.plugins.items() for row in _plugins(kind, plugins)),
        ["kernels", "shipped machine code" if slow is None else f"in Python, some sixty times slower: {slow}"],
        ["own defaults", ", ".join(defaults["files"]) or f"none; create {defaults['user_file']} to set some"],
    ]
    if defaults["environment"]:
        rows.append(["environment", " ".join(f"{name}={value}" for name, value in defaults["environment"].items())])
    parts: list[Table | str] = [table_of("", text_columns("what", "here"), rows)]
    if defaults["set"]:
        title = "Defaults (the first entry of an option takes precedence)"
        parts.append(table_of(title, DEFAULTS, defaults["set"]))
    parts += [f"The environment variable {name} is not used by rocking." for name in defaults["unknown"]]
    if defaults["problem"]:
        parts.append(f"The defaults cannot be used: {defaults['problem']}")
    return View(data, parts)


def _extra(name: str, packages: Mapping[str, str | None]) -> list[str]:
    missing = [package for package, version in packages.items() if version is None]
    if missing:
        return [f"extra {name}", f"no {', '.join(missing)}: pip install '{OWN_PACKAGE}[{name}]'"]
    return [f"extra {name}", ", ".join(f"{package} {version}" for package, version in packages.items())]


def _plugins(kind: str, plugins: Sequence[Plugin]) -> list[list[str]]:
    """Return a row for each package with its plugins, and one for each broken plugin."""
    packages: dict[str, list[str]] = {}
    for each in plugins:
        packages.setdefault(each.package, []).append(each.name)
    rows = [[kind, f"{', '.join(names)} ({package})"] for package, names in packages.items()]
    return rows + [[f"broken: {each.name}", each.broken] for each in plugins if each.broken is not None]

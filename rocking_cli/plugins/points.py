"""Entry points of installed packages, read once for each state of the environment.

Reading them with `importlib.metadata` takes longer than most commands compute. So they are kept in the user's cache
folder, under a key of all that they depend on: Python's import path, and the files there that declare entry points. If
the cache cannot be read or written, they are read each time.
"""

from __future__ import annotations

import json
import os
import sys
from contextlib import suppress
from dataclasses import astuple, dataclass
from hashlib import sha256
from importlib import import_module
from operator import attrgetter
from typing import Any

from rocking_cli import cache
from rocking_cli.io.json_text import json_text

OURS = "rocking."
"""What the names of our groups begin with; no others are read."""
FILE = "entry_points.json"
MOST = 20  # environments in the file
BY_PATH = {"_frozen_importlib_external", "importlib_metadata"}
"""Modules whose finders look for packages in `sys.path` alone: Python's own, and the one that goes before it."""


@dataclass(frozen=True)
class Point:
    """An entry point: an object that a package provides.

    Parameters
    ----------
    name, value, group : str
        Name, value and group as the package declares them; a value is "module:object".
    package : str, optional
        Name and version of the package.
    """

    name: str
    value: str
    group: str
    package: str = "unknown package"

    def load(self) -> Any:
        """Import and return the object."""
        module, _, attribute = self.value.partition("[")[0].partition(":")
        imported = import_module(module.strip())
        return attrgetter(attribute.strip())(imported) if attribute else imported


def entry_points(group: str) -> list[Point]:
    """Return the entry points of one of the groups of this package."""
    return [point for point in _all() if point.group == group]


_POINTS: dict[str, list[Point]] = {}
"""Those read in this process, by the state of the environment."""


def _all() -> list[Point]:
    finders = [each for each in sys.meta_path if hasattr(each, "find_distributions")]
    if not {each.__module__ for each in finders} <= BY_PATH:
        return _read()  # packages may be anywhere
    state = _state()
    if state not in _POINTS:
        _POINTS[state] = _load(state)
    return _POINTS[state]


def _state() -> str:
    """Return a key for all files that a search for entry points would read."""
    seen: list[object] = []
    for path in sys.path:
        seen.append(path)
        try:
            with os.scandir(path or ".") as entries:
                folders = sorted(each.path for each in entries if each.name[-5:].lower() == "-info")
        except OSError:  # an archive, or nothing
            seen.append(_stamp(path))
            continue
        for folder in folders:
            declared = _stamp(f"{folder}/entry_points.txt")
            if declared is not None:
                seen += [folder, declared, _stamp(f"{folder}/METADATA"), _stamp(f"{folder}/PKG-INFO")]
    return sha256(repr(seen).encode("utf-8", "surrogateescape")).hexdigest()


def _stamp(file: str) -> tuple[int, int] | None:
    """Return the time of the last change of a file and its size; None if it does not exist."""
    try:
        status = os.stat(file)  # noqa: PTH116  a Path would cost more than the question
    except (OSError, ValueError):
        return None
    return status.st_mtime_ns, status.st_size


def _read() -> list[Point]:
    """Return the entry points of all installed packages by searching them."""
    from importlib.metadata import distributions  # which imports much of what Python has for mail

    points, known = [], set()
    for each in distributions():
        if each.name not in known:  # of two the first one is imported
            known.add(each.name)
            points += [
                Point(point.name, point.value, point.group, f"{each.name} {each.version}")
                for point in each.entry_points
                if point.group.startswith(OURS)
            ]
    return points


def _load(state: str) -> list[Point]:
    """Return the entry points for a state of the environment from the cache, or read them and cache them."""
    file = cache.folder() / FILE
    kept: dict[str, list[list[str]]] = {}
    # Whatever a damaged file, or one of another version, may hold.
    with suppress(OSError, ValueError, TypeError, KeyError, RecursionError):
        kept = dict(json.loads(file.read_text(encoding="utf-8")))
        return [Point(*map(str, each)) for each in kept[state]]
    points = _read()
    kept = dict([*kept.items(), (state, [list(astuple(point)) for point in points])][-MOST:])
    cache.keep(file, json_text(kept).encode())
    return points

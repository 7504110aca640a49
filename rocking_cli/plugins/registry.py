"""Plugins of installed packages, found by their entry points and looked up by name.

Mechanisms, record readers, pulse shapes, intensity measures, laws of ties and codes of practice are all
plugins of one kind each.
"""

from __future__ import annotations

import os
import sys
from abc import abstractmethod
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, redirect_stdout
from functools import cache, lru_cache
from importlib import metadata
from importlib.metadata import EntryPoint, EntryPoints
from io import StringIO
from itertools import chain
from threading import RLock, Timer
from typing import Any, ClassVar, TypeVar

from rocking_cli.errors import InputError, MechanismError, PluginWarning, warn
from rocking_cli.plugins.errors import blame
from rocking_cli.text import cut, did_you_mean, in_short, one_line

T = TypeVar("T")
OWN_MODULES = "rocking_cli", "mechanisms"
SLOW_LOADING = 2.0  # s after which a plugin that is still loading is named


def entry_points(group: str) -> EntryPoints:
    """Return the entry points of a group; they are searched anew once `sys.path`, or a folder of it, has changed."""
    return _of_group(group, (*map(id, sys.meta_path), *((path, *_state(path)) for path in sys.path)))


def _state(path: str) -> tuple[int, ...]:
    """Return values that change when a package is installed in a folder; empty if there is no such folder."""
    try:
        status = os.stat(path or ".")  # noqa: PTH116  os.stat is faster than a Path here
    except OSError:
        return ()
    return status.st_dev, status.st_ino, status.st_mtime_ns


@lru_cache(maxsize=32)
def _of_group(group: str, state: tuple[object, ...]) -> EntryPoints:
    return EntryPoints(point for point in _installed(state) if point.group == group)


@lru_cache(maxsize=1)  # reading the entry points of all packages takes as long as most commands
def _installed(state: tuple[object, ...]) -> EntryPoints:
    try:
        every: Any = metadata.entry_points()
        # Python 3.11 gives them by group, in a dictionary whose own methods are deprecated.
        return EntryPoints(chain.from_iterable(dict.values(every)) if isinstance(every, dict) else every)
    except Exception:  # the file of any package may be broken
        return EntryPoints(_readable())


def _readable() -> Iterator[EntryPoint]:
    """Yield the entry points of all packages except those whose file of them is broken, which are named."""
    seen = set()
    for package in metadata.distributions():
        name = package.metadata["Name"]
        if name in seen:  # shadowed by the same package in a folder before
            continue
        seen.add(name)
        try:
            yield from package.entry_points
        except Exception as error:
            where = f"entry_points.txt of the package {name} in {package.locate_file('')}"
            leave_out(MechanismError(f"{where} cannot be read: {error}"))


def find(group: str) -> dict[str, list[EntryPoint]]:
    """Find the entry points of a group by name; several of one name are a conflict for the caller to report."""
    points: dict[str, list[EntryPoint]] = {}
    for point in entry_points(group=group):
        same_name = points.setdefault(point.name, [])
        # An editable and a normal install of one package list the same entry twice.
        if all(point.value != other.value for other in same_name):
            same_name.append(point)
    return points


@cache  # without it, each call would read the metadata of the package from disk
def package_of(point: EntryPoint) -> str:
    """Return the name and version of the package of a plugin."""
    return f"{point.dist.name} {point.dist.version}" if point.dist is not None else "unknown package"


def origin(point: EntryPoint) -> str:
    """Return the plugin and its package, for a message."""
    return f"plugin {point.name} of {package_of(point)} ({point.value})"


def load(point: EntryPoint) -> object:
    """Load the object of an entry point."""
    with blame(lambda: f"{origin(point)} cannot be loaded", point.value.partition(":")[0]), _watched(point):
        loaded: object = point.load()
    return loaded


@contextmanager
def _watched(point: EntryPoint) -> Iterator[None]:
    """Warn of a plugin of another package whose import takes long, or prints."""
    if point.module in sys.modules or point.module.partition(".")[0] in OWN_MODULES:
        yield
        return
    slow = Timer(SLOW_LOADING, lambda: warn(PluginWarning(f"{origin(point)} is still loading")))
    slow.daemon = True
    with _IMPORTING, redirect_stdout(StringIO()) as printed:
        slow.start()
        try:
            yield
        finally:
            slow.cancel()
    if text := one_line(printed.getvalue().strip()):
        warn(PluginWarning(f"{origin(point)} prints: {cut(text)}"))


_IMPORTING = RLock()
"""Lock around imports whose output is kept, as there is one standard output for all threads."""
_LEFT_OUT: set[str] = set()


def leave_out(error: MechanismError) -> None:
    """Warn, once in this process, that a plugin is left out; the others are used."""
    if str(error) not in _LEFT_OUT:
        _LEFT_OUT.add(str(error))
        warning = PluginWarning(f"{error}; it is left out")
        warning.__cause__ = error
        warn(warning)


class Plugins(Mapping[str, T]):
    """Plugins of an entry-point group. Listing names loads nothing; looking one up loads and checks it.

    A subclass defines their group, their kind and which objects it accepts.

    Raises
    ------
    InputError
        On looking up an unknown name.
    MechanismError
        On looking up a plugin that cannot be loaded, is not accepted, or has a name that two packages claim.
    """

    group: ClassVar[str]
    """Entry-point group."""
    kind: ClassVar[str]
    """Name of the kind, for messages."""
    unknown: ClassVar[type[InputError]] = InputError
    """Error for a name that no package provides."""

    def __init__(self) -> None:
        self._points = find(self.group)

    def __iter__(self) -> Iterator[str]:
        return iter(sorted(self._points))

    def __len__(self) -> int:
        return len(self._points)

    def __contains__(self, name: object) -> bool:
        return name in self._points

    def __getitem__(self, name: str) -> T:
        if name not in self._points:
            hint = self.meant(name)
            raise self.unknown(f"unknown {self.kind}: {name}" + (f" ({hint})" if hint else ""))
        point, *others = self._points[name]
        if others:
            claims = " and ".join(f"{package_of(each)} ({each.value})" for each in (point, *others))
            raise MechanismError(f"{self.kind} {name} is claimed by two packages, {claims}: uninstall one of them")
        return self.accept(load(point), point)

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {in_short(list(self))}>"

    def meant(self, name: str) -> str | None:
        """Return a hint on what an unknown name means."""
        return did_you_mean(name, list(self))

    def package_of(self, name: str) -> str:
        """Return the distribution and version of a plugin; a class of a script has none."""
        return ", ".join(package_of(point) for point in self._points.get(name, ())) or "no package"

    @staticmethod
    @abstractmethod
    def accept(loaded: object, point: EntryPoint) -> T:
        """Return the loaded object if it is valid; otherwise raise a `MechanismError` with all that is missing."""

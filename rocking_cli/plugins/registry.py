"""Plugins of one kind by name: mechanisms, record readers, pulse shapes, intensity measures, codes or engines."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator, Mapping
from importlib.metadata import EntryPoint
from typing import ClassVar, TypeVar

from rocking_cli.errors import InputError
from rocking_cli.plugins.installed import find, load, only, package
from rocking_cli.text import did_you_mean

T = TypeVar("T")


class Plugins(Mapping[str, T]):
    """Plugins of an entry-point group. Listing names loads nothing; looking one up loads and checks it.

    A subclass defines their kind and which objects it accepts.

    Parameters
    ----------
    group : str
        Entry-point group.

    Raises
    ------
    InputError
        On looking up an unknown name.
    MechanismError
        On looking up a plugin that cannot be loaded, is not accepted, or has a name that two packages claim.
    """

    kind: ClassVar[str]
    """Name of the kind, for messages."""
    unknown: ClassVar[type[InputError]] = InputError
    """Error for a name that no package provides."""

    def __init__(self, group: str) -> None:
        self._points = find(group)

    def __iter__(self) -> Iterator[str]:
        return iter(sorted(self._points))

    def __len__(self) -> int:
        return len(self._points)

    def __contains__(self, name: object) -> bool:
        return name in self._points

    def __getitem__(self, name: str) -> T:
        if name not in self._points:
            hint = did_you_mean(name, list(self._points))
            raise self.unknown(f"unknown {self.kind}: {name}" + (f" ({hint})" if hint else ""))
        point = only(self.kind, name, self._points[name])
        return self.accept(load(point), point)

    def package_of(self, name: str) -> str:
        """Return the distribution and version of a plugin."""
        return ", ".join(package(point) for point in self._points[name])

    @staticmethod
    @abstractmethod
    def accept(loaded: object, point: EntryPoint) -> T:
        """Return the loaded object if it is valid; otherwise raise a `MechanismError` with all that is missing."""

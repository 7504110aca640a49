"""Plugins of one kind by name: mechanisms, record readers, pulse shapes, intensity measures, codes or engines."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator, Mapping
from typing import ClassVar, TypeVar

from rocking_cli.errors import InputError
from rocking_cli.plugins.installed import find, load, only
from rocking_cli.plugins.points import Point
from rocking_cli.text import did_you_mean

T = TypeVar("T")


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
            hint = did_you_mean(name, list(self._points))
            raise self.unknown(f"unknown {self.kind}: {name}" + (f" ({hint})" if hint else ""))
        point = only(self.kind, name, self._points[name])
        return self.accept(load(point), point)

    def package_of(self, name: str) -> str:
        """Return the distribution and version of a plugin."""
        return ", ".join(point.package for point in self._points[name])

    @staticmethod
    @abstractmethod
    def accept(loaded: object, point: Point) -> T:
        """Return the loaded object if it is valid; otherwise raise a `MechanismError` with all that is missing."""

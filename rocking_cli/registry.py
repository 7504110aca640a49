"""The mechanisms that are installed, found through the entry points `rocking.mechanisms` and loaded when asked for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from importlib.metadata import EntryPoint
from typing import cast

from rocking_cli import plugins
from rocking_cli.core import Mechanism
from rocking_cli.errors import InputError, MechanismError
from rocking_cli.plugins import did_you_mean

GROUP = "rocking.mechanisms"


class UnknownMechanismError(InputError, KeyError):
    """A name that no installed package gives a mechanism."""

    __str__ = InputError.__str__  # a KeyError would show its message in quotes


class Registry(Mapping[str, type[Mechanism]]):
    """Mechanism classes by name. Listing names loads nothing; looking one up loads and checks it.

    Parameters
    ----------
    group : str
        The entry-point group.

    Raises
    ------
    InputError
        On looking up an unknown name (it is a `KeyError` too).
    MechanismError
        On looking up a plugin that cannot be loaded, breaks the contract, or has a name that two packages claim.
    """

    def __init__(self, group: str = GROUP) -> None:
        self._points = plugins.find(group)

    def __iter__(self) -> Iterator[str]:
        return iter(sorted(self._points))

    def __len__(self) -> int:
        return len(self._points)

    def __contains__(self, name: object) -> bool:
        return name in self._points

    def __getitem__(self, name: str) -> type[Mechanism]:
        points = self._points.get(name)
        if points is None:
            hint = did_you_mean(name, list(self._points))
            raise UnknownMechanismError(f"unknown mechanism: {name}" + (f" ({hint})" if hint else ""))
        return load(plugins.only("mechanism", name, points))

    def package_of(self, name: str) -> str:
        """Distribution and version that a mechanism comes from."""
        return ", ".join(plugins.package(point) for point in self._points[name])


def load(point: EntryPoint) -> type[Mechanism]:
    """Load a plugin and hold it to the contract of `Mechanism`, naming everything that is missing."""
    plugin = plugins.load(point)
    faults = conformance(plugin, point.name)
    if faults:
        raise MechanismError(f"{plugins.origin(point)} is not a mechanism: " + "; ".join(faults))
    return cast("type[Mechanism]", plugin)


def conformance(plugin: object, name: str) -> list[str]:
    """What keeps an object from being the mechanism `name`; empty if nothing does."""
    if not (isinstance(plugin, type) and issubclass(plugin, Mechanism)):
        return ["it must be a class derived from rocking_cli.Mechanism"]
    faults = [f"method {method} is missing" for method in sorted(plugin.__abstractmethods__)]
    for attribute in ("mechanism", "title", "source"):
        if not isinstance(getattr(plugin, attribute, None), str):
            faults.append(f"class attribute {attribute} (a text) is missing")
    if getattr(plugin, "mechanism", name) != name:
        faults.append(f"its class says mechanism = {plugin.mechanism!r}, its entry point says {name!r}")
    return faults

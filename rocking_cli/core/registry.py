"""The installed mechanisms, found by the entry points `rocking.mechanisms` and loaded when they are used.

`Verdict` is the result of a check of their contract.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib.metadata import EntryPoint
from typing import cast

from rocking_cli.core import Mechanism
from rocking_cli.errors import InputError, MechanismError
from rocking_cli.plugins.registry import Plugins, origin


class UnknownMechanismError(InputError, KeyError):
    """Error: no installed package has a mechanism of this name."""

    __str__ = InputError.__str__  # the method of KeyError would show the message in quotes


class Registry(Plugins[type[Mechanism]]):
    """Mechanism classes by name. Listing names loads nothing; looking up a name loads and checks its class.

    Raises
    ------
    InputError
        On looking up an unknown name (it is a `KeyError` too).
    MechanismError
        On looking up a plugin that cannot be loaded, breaks the contract, or has a name that two packages claim.
    """

    group = "rocking.mechanisms"
    kind = "mechanism"
    unknown = UnknownMechanismError

    def meant(self, name: str) -> str | None:
        """Return the template that an unknown name means, or else the mechanism with the nearest name, if any."""
        from rocking_cli.io.starters import instead_of_mechanism

        return instead_of_mechanism(name) or super().meant(name)

    @staticmethod
    def accept(loaded: object, point: EntryPoint) -> type[Mechanism]:
        """Return the loaded object if it fulfils the contract of `Mechanism`."""
        if faults := conformance(loaded, point.name):
            raise MechanismError(f"{origin(point)} is not a mechanism: " + "; ".join(faults))
        return cast("type[Mechanism]", loaded)


def conformance(plugin: object, name: str) -> list[str]:
    """Return the reasons why an object is not a valid mechanism of the name `name`; empty if it is valid."""
    if not (isinstance(plugin, type) and issubclass(plugin, Mechanism)):
        return ["it must be a class derived from rocking_cli.Mechanism"]
    faults = [f"method {method} is missing" for method in sorted(plugin.__abstractmethods__)]
    for attribute in ("mechanism", "title", "source"):
        if not isinstance(getattr(plugin, attribute, None), str):
            faults.append(f"class attribute {attribute} (a text) is missing")
    if getattr(plugin, "mechanism", name) != name:
        faults.append(f"its class says mechanism = {plugin.mechanism!r}, its entry point says {name!r}")
    return faults


@dataclass(frozen=True)
class Verdict:
    """Result of one check of a structure.

    Parameters
    ----------
    check : str
        Name of the check.
    meaning : str
        What the check requires of the structure, one sentence.
    why : str or None
        Why it fails; None if it passes.
    trace : str or None
        Traceback of the plugin's error, if the check failed by one.
    """

    check: str
    meaning: str
    why: str | None = None
    trace: str | None = None

    @property
    def passed(self) -> bool:
        """Whether the structure passes the check."""
        return self.why is None

"""The installed codes of practice, found through the entry points `rocking.codes`."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib.metadata import EntryPoint

from rocking_cli.errors import MechanismError
from rocking_cli.plugins.errors import blame
from rocking_cli.plugins.registry import Plugins, origin
from rocking_cli.studies.verification.code import Code, Number
from rocking_cli.studies.verification.site_file import Site


class Codes(Plugins[Code]):
    """Installed codes, by their names in site files. Listing names loads nothing; looking one up loads it.

    Raises
    ------
    InputError
        On looking up an unknown name.
    MechanismError
        On looking up a plugin that cannot be loaded, is not a code, or has a name that two packages claim.
    """

    group = "rocking.codes"
    kind = "code"

    @staticmethod
    def accept(loaded: object, point: EntryPoint) -> Code:
        """Return an instance of a loaded class if it is a complete code of its name. Raises `MechanismError` if not."""
        if not (isinstance(loaded, type) and issubclass(loaded, Code)) or loaded.__abstractmethods__:
            raise MechanismError(f"{origin(point)} is not a code: it must derive from Code and be complete")
        texts = [getattr(loaded, key, None) for key in ("name", "edition")]
        if getattr(loaded, "key", None) != point.name or not all(isinstance(each, str) for each in texts):
            raise MechanismError(f"{origin(point)} is not a code: it needs key = {point.name!r}, a name and an edition")
        fields = getattr(loaded, "site", None)
        if not (isinstance(fields, type) and issubclass(fields, Site)):
            raise MechanismError(f"{origin(point)} is not a code: its site must be a class derived from Site")
        numbers = getattr(loaded, "numbers", None)
        if not (isinstance(numbers, Mapping) and all(isinstance(each, Number) for each in numbers.values())):
            raise MechanismError(f"{origin(point)} is not a code: its numbers must be a mapping of str to Number")
        with blame(f"{origin(point)} cannot be made", loaded.__module__):
            return loaded()


@cache
def codes() -> Codes:
    """Return the installed codes."""
    return Codes()

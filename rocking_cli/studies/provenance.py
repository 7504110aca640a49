"""What a document that is handed over says of itself: its heading, the files it was made from, and the versions."""

from __future__ import annotations

import platform
from dataclasses import dataclass
from hashlib import sha256
from importlib.metadata import version

from rocking_cli.core import Mechanism
from rocking_cli.core.registry import Registry
from rocking_cli.excitation.records.opening import name_of, original
from rocking_cli.processing.reading import Scaled
from rocking_cli.short_repr import short_repr

RECORDED_PACKAGES = ("numpy", "scipy", "matplotlib")


@short_repr
@dataclass(frozen=True)
class File:
    """An input file as the user gave it: its name and its content, with a checksum of the content."""

    name: str
    content: bytes

    @property
    def checksum(self) -> str:
        """SHA-256, in hexadecimal."""
        return sha256(self.content).hexdigest()

    @property
    def text(self) -> str:
        """The content as text."""
        return self.content.decode("utf-8", errors="replace")


@short_repr
@dataclass(frozen=True)
class TitleBlock:
    """Heading of a report: the project, its place, client and author, and how and when the report was made.

    Parameters
    ----------
    command, date : str
        The command that wrote the report, and the date.
    project, place, client, author : str, optional
        As the user gave them.
    logo : str, optional
        Address of a picture to show in the heading.
    """

    command: str
    date: str
    project: str | None = None
    place: str | None = None
    client: str | None = None
    author: str | None = None
    logo: str | None = None

    @property
    def fields(self) -> dict[str, str]:
        """Project, place, client and author by name; empty where they are not given."""
        return {name: getattr(self, name) or "" for name in ("project", "place", "client", "author")}

    @property
    def known(self) -> dict[str, str]:
        """The fields that are given."""
        return {name: text for name, text in self.fields.items() if text}


def file_of_motion(given: Scaled) -> File | None:
    """Return the file of a ground motion; None for a pulse."""
    return None if given.file is None else File(name_of(str(given.file)), original(str(given.file)))


def versions(mechanism: Mechanism) -> dict[str, str]:
    """Return the versions of this package, of the mechanism's, of the system, of Python and of what computes."""
    registry, name = Registry(), mechanism.mechanism
    return {
        "rocking-cli": version("rocking-cli"),
        f"mechanism {name}": registry.package_of(name) if name in registry else "not installed as a plugin",
        "system": platform.platform(terse=True),
        "Python": platform.python_version(),
        **{package: version(package) for package in RECORDED_PACKAGES},
    }

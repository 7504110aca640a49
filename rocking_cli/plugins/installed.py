"""Find, load and name plugins of installed packages by their entry points."""

from __future__ import annotations

import warnings

from rocking_cli.errors import MechanismError, PluginWarning
from rocking_cli.plugins.errors import blame
from rocking_cli.plugins.points import Point, entry_points


def find(group: str) -> dict[str, list[Point]]:
    """Find the entry points of a group by name; several of one name are a conflict for the caller to report."""
    points: dict[str, list[Point]] = {}
    for point in entry_points(group):
        same_name = points.setdefault(point.name, [])
        # An editable and a normal install of one package list the same entry twice.
        if all(point.value != other.value for other in same_name):
            same_name.append(point)
    return points


def origin(point: Point) -> str:
    """Return the plugin and its package, for a message."""
    return f"plugin {point.name} of {point.package} ({point.value})"


def only(kind: str, name: str, points: list[Point]) -> Point:
    """Return the only entry point of a name; `kind` names the plugins in the message if there are two."""
    if len(points) > 1:
        claims = " and ".join(f"{point.package} ({point.value})" for point in points)
        raise MechanismError(f"{kind} {name} is claimed by two packages, {claims}: uninstall one of them")
    return points[0]


def load(point: Point) -> object:
    """Load the object of an entry point."""
    with blame(f"{origin(point)} cannot be loaded", point.value.partition(":")[0]):
        loaded: object = point.load()
    return loaded


_LEFT_OUT: set[str] = set()


def leave_out(error: MechanismError) -> None:
    """Warn, once in this process, that a plugin is left out; the others are used."""
    if str(error) not in _LEFT_OUT:
        _LEFT_OUT.add(str(error))
        warning = PluginWarning(f"{error}; it is left out")
        warning.__cause__ = error
        warnings.warn(warning, stacklevel=2)

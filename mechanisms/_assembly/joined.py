"""Names joined to groups (a union-find structure)."""

from __future__ import annotations

from collections.abc import Sequence


class JoinedNames:
    """Names joined to groups."""

    def __init__(self, names: Sequence[str | int | None]) -> None:
        self.of = {name: name for name in names}

    def root(self, name: str | int | None) -> str | int | None:
        """Return the name that represents the group of a name."""
        while self.of[name] != name:
            name = self.of[name]
        return name

    def join(self, one: str | int | None, other: str | int | None) -> bool:
        """Join the groups of two names; return whether they were separate."""
        one, other = self.root(one), self.root(other)
        self.of[other] = one
        return one != other

    def all(self) -> list[tuple[str, ...]]:
        """Return the groups, each in the order of their first names."""
        found: dict[str | int | None, list[str]] = {}
        for name in self.of:
            found.setdefault(self.root(name), []).append(str(name))
        return [tuple(group) for group in found.values()]

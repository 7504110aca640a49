"""Names, some of which are joined to one."""

from __future__ import annotations

from collections.abc import Sequence


class JoinedNames:
    """Names, some of which are joined to one."""

    def __init__(self, names: Sequence[str | int | None]) -> None:
        self.of = {name: name for name in names}

    def root(self, name: str | int | None) -> str | int | None:
        """The name that stands for all that are joined to one."""
        while self.of[name] != name:
            name = self.of[name]
        return name

    def join(self, one: str | int | None, other: str | int | None) -> bool:
        """Join two; whether they were apart."""
        one, other = self.root(one), self.root(other)
        self.of[other] = one
        return one != other

    def all(self) -> list[tuple[str, ...]]:
        """Those that are joined, in the order of their first."""
        found: dict[str | int | None, list[str]] = {}
        for name in self.of:
            found.setdefault(self.root(name), []).append(str(name))
        return [tuple(group) for group in found.values()]

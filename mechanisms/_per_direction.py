"""Results that a mechanism computes once for each direction of rocking, and keeps."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any, TypeVar

from rocking_cli.core import Direction

T = TypeVar("T")
KEPT = "kept for each direction"


def per_direction(method: Callable[[Any, Direction], T]) -> Callable[[Any, Direction], T]:
    """Decorate a method of a mechanism so that its result for each direction is kept, as by `cached_property`."""

    @wraps(method)
    def answer(self: Any, direction: Direction) -> T:
        kept = self.__dict__.setdefault(KEPT, {})
        key = method.__name__, direction
        if key not in kept:
            kept[key] = method(self, direction)
        found: T = kept[key]
        return found

    return answer

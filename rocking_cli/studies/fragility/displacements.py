"""Limit states on how far the top of a structure moves: `25 mm`, as they are written and kept.

Whether a run exceeds one is decided by two rotations of its sample, one in either direction, at which the top has moved
so far: `reached` finds them, and a store keeps them, so that its runs can be asked without the structures.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking_cli.units import UnitError, kind_of, read, split

Reals = NDArray[np.float64]
FACT = "displacements"  # the name under which a store keeps the rotations
UNIT = "mm"  # in which limits are written
DIGITS = 10


def spelt(text: str) -> str:
    """A displacement as limit states spell it, in mm: `25 mm` for `2.5 cm`.

    Raises
    ------
    ValueError
        If it is no length above zero.
    """
    try:
        value = read(text, UNIT)
    except UnitError as error:
        raise ValueError(str(error)) from None
    if not 0 < value < float("inf"):
        raise ValueError(f"a displacement must be positive, got {text!r}")
    return f"{value:.{DIGITS}g} {UNIT}"


def is_quantity(value: object) -> bool:
    """Whether something is a text of a number and a unit, so that a displacement may be meant."""
    parts = split(value) if isinstance(value, str) else None
    return parts is not None and bool(parts[1])


def metres(limit: str | float) -> float | None:
    """How far the top moves at a limit state [m]; None for one that is no displacement."""
    if not isinstance(limit, str) or not is_quantity(limit) or kind_of(limit.split()[-1]) != "length":
        return None
    return read(limit, "m")


def asked_for(limits: Sequence[str | float]) -> list[str]:
    """Those among limit states that are displacements."""
    return [limit for limit in limits if isinstance(limit, str) and metres(limit) is not None]


def kept(fact: Callable[[str], Any], limits: Sequence[str | float]) -> dict[str, Reals]:
    """The rotations of every sample [rad] that a store keeps for displacements among limit states.

    Parameters
    ----------
    fact : callable
        `Store.fact`.
    limits : sequence of limit states
        The requested ones; a store whose study requests none keeps none.

    Returns
    -------
    dict of str to ndarray, shape (samples, 2)
        By the limit, positive and negative; infinite where the top does not move so far before the structure ends.
    """
    asked = asked_for(limits)
    found = fact(FACT) if asked else {}

    def table(pairs: Sequence[Sequence[float | None]]) -> Reals:
        return np.array([[np.inf if each is None else each for each in pair] for pair in pairs], dtype=np.float64)

    return {limit: table(found[limit]) for limit in asked}

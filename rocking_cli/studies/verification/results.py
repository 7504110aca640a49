"""What a verification by any code found."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import inf, isclose, isfinite, isnan, nan
from typing import Any

from rocking_cli.core import Direction, Mechanism
from rocking_cli.studies.verification.working import Working

CLOSE = 1e-12  # of a demand: what rounding may take from a capacity that equals it
ALIKE = 1e-9  # of a ratio: of directions that differ by less none governs


@dataclass(frozen=True)
class Method:
    """What a structure has, and what a code asks of it, by one method of verification.

    Parameters
    ----------
    title : str
        What to call it.
    capacity, demand : float or None
        Both in the same unit; None if the site does not give what it depends on.
    clause : str
        Where in the code.
    unit : str
        Of both.
    """

    title: str
    capacity: float | None
    demand: float | None
    clause: str = ""
    unit: str = field(default="", kw_only=True)

    @property
    def ratio(self) -> float | None:
        """Capacity over demand; infinity where nothing is asked, None where one of them is not known."""
        if self.capacity is None or self.demand is None:
            return None
        return self.capacity / self.demand if self.demand else inf

    @property
    def passed(self) -> bool | None:
        """Whether the capacity meets the demand; None where one of them is not known."""
        return None if self.ratio is None else self.ratio >= 1 - CLOSE


def governing(methods: Mapping[str, Method]) -> str:
    """Return the key of the method with the smallest ratio; the first if no ratio is known."""
    return min(methods, key=lambda key: inf if (ratio := methods[key].ratio) is None or isnan(ratio) else ratio)


@dataclass(frozen=True, eq=False)
class Verified:
    """What was found in one direction of rocking.

    A code whose acceptance is another than that of the method that governs overrides `ratio` and `passed`. Both must
    agree: surveys and designs compare the ratio with 1.

    Parameters
    ----------
    direction : Direction
    methods : mapping of str to Method
        What each method of the code found, by its key.
    governs : str
        The key of the method that decides, such as `governing(methods)`.
    workings : sequence of Working
        How the numbers came about.
    remarks : sequence of str
        Sentences on what to know of them.
    """

    direction: Direction
    methods: Mapping[str, Method]
    governs: str
    workings: Sequence[Working] = field(default=(), kw_only=True)
    remarks: Sequence[str] = field(default=(), kw_only=True)

    @property
    def counts(self) -> Method:
        """The method that governs."""
        return self.methods[self.governs]

    @property
    def ratio(self) -> float | None:
        """What the code allows over what it asks for, by what governs; None where the site does not give it."""
        return self.counts.ratio

    @property
    def passed(self) -> bool | None:
        """Whether the code is satisfied; None where the site does not give what is asked for."""
        return self.counts.passed

    def is_like(self, other: Verified) -> bool:
        """Whether another direction has the same numbers, so that one need be shown."""
        if self.methods.keys() != other.methods.keys() or self.governs != other.governs:
            return False
        pairs = [(each, other.methods[key]) for key, each in self.methods.items()]
        return all(_are_close(a.capacity, b.capacity) and _are_close(a.demand, b.demand) for a, b in pairs)


def _are_close(one: float | None, other: float | None) -> bool:
    return one == other if one is None or other is None else isclose(one, other, rel_tol=ALIKE)


@dataclass(frozen=True, eq=False)
class Verification:
    """Verification of a structure by a code.

    Parameters
    ----------
    mechanism : Mechanism
        The structure.
    code, name, edition : str
        By which code, as site files call it and as people do, and which edition of it.
    directions : mapping of Direction to Verified
        What was found in each direction that it can rock in.
    workings : sequence of Working
        Of what is the same in both, such as the ground.
    remarks : sequence of str
        Sentences on the whole.
    taken_otherwise : sequence of str
        Those of them on what was taken otherwise than the structure gives it.
    """

    mechanism: Mechanism
    code: str
    name: str
    edition: str
    directions: Mapping[Direction, Verified]
    workings: Sequence[Working] = field(default=(), kw_only=True)
    remarks: Sequence[str] = field(default=(), kw_only=True)
    taken_otherwise: Sequence[str] = field(default=(), kw_only=True)

    @property
    def governs(self) -> Direction:
        """The direction that is nearer to failure; the first of those that are alike."""
        return next(direction for direction, ratio in self._ratios.items() if ratio <= self._least)

    @property
    def alike(self) -> bool:
        """Whether no direction is nearer to failure than the other."""
        return max(self._ratios.values()) <= self._least

    @property
    def distinct(self) -> Sequence[Any]:
        """What was found in each direction; of two that have the same numbers in the first."""
        each = list(self.directions.values())
        return each[:1] if len(each) == 2 and each[0].is_like(each[1]) else each

    @property
    def ratio(self) -> float:
        """What the code allows over what it asks for, in the direction that governs; NaN where it is not known."""
        found = self.directions[self.governs].ratio
        return nan if found is None else found

    def compared(self, direction: Direction) -> float | None:
        """Return the ratio by which a direction is compared with the other."""
        return self.directions[direction].ratio

    @property
    def _least(self) -> float:
        """The smallest ratio, with what rounding may add to it."""
        least = min(self._ratios.values())
        return least + ALIKE * abs(least)

    @property
    def _ratios(self) -> dict[Direction, float]:
        found = {direction: self.compared(direction) for direction in self.directions}
        return {key: ratio if ratio is not None and isfinite(ratio) else inf for key, ratio in found.items()}

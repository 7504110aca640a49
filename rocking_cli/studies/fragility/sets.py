"""Sets of records: the levels at which each record is run, its weight, and which entries are the same record."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking_cli.studies.fragility.observed import SAME

Reals = NDArray[np.float64]
Integers = NDArray[np.int64]
EVERY = -1


@dataclass(frozen=True, eq=False)
class Sets:
    """The levels at which the records of a study are run; each field is an ndarray with an entry for each record.

    Parameters
    ----------
    level : ndarray of int
        Index of the one level at which the record is run; -1 for a record that is run at all levels.
    weight : ndarray
        Relative weight of the record, positive.
    one : ndarray of int
        Index of the first entry that is the same record, in another set or another direction.
    scaled : bool
        Whether records are scaled to their levels; otherwise they are used as they are, and a level only names its set.
    """

    level: Integers
    weight: Reals
    one: Integers
    scaled: bool = True

    @classmethod
    def of(
        cls,
        levels: Sequence[float],
        at: Sequence[float | None],
        weights: Sequence[float],
        files: Sequence[str],
        *,
        scaled: bool = True,
    ) -> Sets:
        """Build sets from the level (if any), the weight and the file of each record."""
        values = np.array(levels)
        places = [EVERY if each is None else int(np.argmin(np.abs(values - each))) for each in at]
        first = {file: len(files) - 1 - k for k, file in enumerate(reversed(files))}
        return cls(
            np.array(places, dtype=np.int64),
            np.array(weights, dtype=np.float64),
            np.array([first[file] for file in files], dtype=np.int64),
            scaled,
        )

    @classmethod
    def plain(cls, records: int) -> Sets:
        """Build sets in which every record is run at every level with equal weight."""
        return cls.of([0.0], [None] * records, [1.0] * records, [str(k) for k in range(records)])

    @property
    def weighted(self) -> bool:
        """Whether the records have different weights."""
        return bool(np.ptp(self.weight) > SAME * self.weight.max()) if self.weight.size else False

    def there(self, record: int, levels: int) -> NDArray[np.bool_]:
        """Return a mask of the levels at which a record is run."""
        return np.ones(levels, dtype=bool) if self.level[record] == EVERY else np.arange(levels) == self.level[record]


def among(level: float, levels: Sequence[float]) -> bool:
    """Return whether the level of a record is one of the study's levels, within rounding."""
    return any(abs(level - each) <= SAME * abs(each) for each in levels)


def described(description: dict[str, Any], weights: Sequence[float]) -> Sets:
    """Build the sets of a store from the description of its study and the weights last requested."""
    records, levels = description["records"], description["levels"]
    return Sets.of(
        levels["values"],
        [each.get("level") for each in records],
        weights,
        [each.get("file", each["name"]) for each in records],
        scaled=levels.get("scaled", True),
    )

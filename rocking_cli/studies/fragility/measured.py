"""Values measured for a study beyond the peaks that every record has: of records, samples and runs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Reals = NDArray[np.float64]


class Value(NamedTuple):
    """One value as a store keeps it. Indices on which the value does not depend are None; a missing value is None."""

    measure: str
    sample: int | None
    record: int | None
    level: int | None
    value: float | None


@dataclass(frozen=True, eq=False)
class Measured:
    """Values measured for a study, by name; NaN where there is none.

    Parameters
    ----------
    of_record : mapping of str to ndarray, shape (records,)
        Measures of the unscaled motions, by their standard spelling.
    of_sample : mapping of str to ndarray, shape (samples,)
        Fields of `Reference` that trials lack.
    of_run : mapping of str to ndarray, shape (samples, records, levels)
        Measures that are not proportional to a power of the factor on the record.
    """

    of_record: Mapping[str, Reals] = field(default_factory=dict)
    of_sample: Mapping[str, Reals] = field(default_factory=dict)
    of_run: Mapping[str, Reals] = field(default_factory=dict)

    def __bool__(self) -> bool:
        return bool(self.of_record or self.of_sample or self.of_run)

    def values(self) -> Iterator[Value]:
        """Yield all values that are not NaN, one at a time."""
        for name, values in self.of_record.items():
            yield from (Value(name, None, k, None, value) for (k,), value in _there(values))
        for name, values in self.of_sample.items():
            yield from (Value(name, k, None, None, value) for (k,), value in _there(values))
        for name, values in self.of_run.items():
            yield from (Value(name, s, r, k, value) for (s, r, k), value in _there(values))

    @classmethod
    def of(cls, values: Iterator[Value], shape: tuple[int, int, int]) -> Measured:
        """Collect single values of a study with a given number of samples, records and levels.

        Raises
        ------
        ValueError
            If the indices of a value are not those of a record, a sample or a run.
        IndexError
            If an index is out of range.
        """
        samples, records, levels = shape
        kinds: tuple[tuple[dict[str, Reals], tuple[int, ...]], ...] = (
            ({}, (records,)),
            ({}, (samples,)),
            ({}, (samples, records, levels)),
        )
        patterns = ((False, True, False), (True, False, False), (True, True, True))
        for value in values:
            places = (value.sample, value.record, value.level)
            arrays, size = kinds[patterns.index(tuple(place is not None for place in places))]
            if value.measure not in arrays:
                arrays[value.measure] = np.full(size, np.nan)
            place = tuple(place for place in places if place is not None)
            if min(place) < 0:
                raise IndexError(place)
            arrays[value.measure][place] = np.nan if value.value is None else value.value
        return cls(*(arrays for arrays, _ in kinds))


def _there(values: Reals) -> Iterator[tuple[Any, float]]:
    """Return the index and the value of every entry that is not NaN."""
    places = np.argwhere(~np.isnan(values)).tolist()
    return zip((tuple(place) for place in places), values[~np.isnan(values)].tolist(), strict=True)

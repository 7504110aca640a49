"""Labelled arrays of an answer, made of its long tables."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any

import numpy as np
from pandas import factorize
from xarray import Dataset, Variable, merge

from rocking_cli.io.tables import column_of
from rocking_cli.views.column import long_name

Parted = tuple[Mapping[str, Any], Mapping[str, str]]
"""Columns by name, and the units of those that have one."""


def labelled(tables: Sequence[tuple[Any, Parted]]) -> Dataset:
    """Return the columns of long tables as arrays over the dimensions of each table."""
    elsewhere = {name for each, _ in tables for name in (*each.names, *each.of)}
    return merge([_arrays(*each, elsewhere) for each in tables], join="outer", compat="equals")


def _arrays(dimensions: Any, parted: Parted, elsewhere: Collection[str]) -> Dataset:
    """Return columns as arrays: those that are named, or all whose names are not those of columns `elsewhere`."""
    columns, units = {name: column_of(values) for name, values in parted[0].items()}, parted[1]
    names = dimensions.names
    labels = [factorize(columns[name], use_na_sentinel=False) for name in names]
    if np.prod([each.size for _, each in labels]) > columns[names[0]].size:
        # Not every combination exists: numbers are sorted, as what is drawn against them is a curve.
        labels = [
            factorize(columns[name], sort=columns[name].dtype.kind in "if", use_na_sentinel=False) for name in names
        ]
    shape, places = tuple(each.size for _, each in labels), tuple(place for place, _ in labels)
    there = np.zeros(shape, dtype=bool)
    there[places] = True

    def variable(over: tuple[str, ...], name: str, values: Any) -> Variable:
        unit = {"units": units[name]} if name in units else {}
        return Variable(over, values, unit | {"long_name": long_name(name)})

    def filled(values: np.ndarray) -> np.ndarray:
        words = values.dtype.kind in "OUS"
        kind = object if words else values.dtype if there.all() else np.result_type(values, np.float64)
        array = np.full(shape, "" if words else 0 if there.all() else np.nan, dtype=kind)
        array[places] = values + 0.0 if kind == np.float64 else values  # + 0.0 turns -0 into 0
        return array

    chosen = [name for name in columns if (name in dimensions.of if dimensions.of else name not in elsewhere)]
    return Dataset(
        {name: variable(names, name, filled(columns[name])) for name in chosen},
        {name: variable((name,), name, values) for name, (_, values) in zip(names, labels, strict=True)},
    )

"""Arrays as texts of a page, as short as their smoothness allows: `unpacked` of data/kernel.js reads them."""

from __future__ import annotations

import base64
import zlib
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Integers, Reals

How = Literal["plain", "smooth", "cubics", "grid"]
DIFFERENCES = 3  # along the cells: so smooth are the tables
GRID = 44  # bits of the largest number of a column, in whose last one a number on the grid may differ by a half


def deflated(content: bytes) -> str:
    """Return bytes as text, compressed."""
    return base64.b64encode(zlib.compress(content, 9)).decode("ascii")


def packed(values: NDArray[Any], how: How = "plain", cells: int | None = None) -> dict[str, Any]:
    """Return an array of 64-bit numbers as a shape and a text.

    Parameters
    ----------
    values : ndarray
        Real or whole numbers.
    how : {"plain", "smooth", "cubics", "grid"}
        `plain`: any numbers, to the last bit. `smooth`: numbers of both directions, shape (cells, 2), to the last bit.
        `cubics`: cubics of both directions, shape (cells, 2, 4 n), to the last bit: powers 2 and 3 as what they differ
        by from those that the ends of a cell give. `grid`: the same shape, each cubic rounded to `GRID` bits of its
        largest constant.
    cells : int, optional
        Number of cells, if the rows of both directions follow one another; by default that of rows.
    """
    cells, steps = len(values) if cells is None else cells, list[float]()
    if how == "plain":
        bits = np.ascontiguousarray(values).view(np.int64).reshape(1, -1)
    else:
        cubics = values.reshape(cells, 2, -1, 1 if how == "smooth" else 4)
        if how == "grid":
            largest = np.abs(cubics).max(axis=(0, 1, 3), initial=0.0)
            step = np.exp2(np.ceil(np.log2(np.where(largest > 0, largest, 1.0))) - GRID)
            steps, bits = step.tolist(), np.rint(cubics / step[:, None]).astype(np.int64)
        else:
            bits = _but_ends(cubics) if how == "cubics" else np.ascontiguousarray(cubics).view(np.int64).copy()
            bits[:, 1] -= bits[:, 0]
        smooth = bits if how == "grid" else bits[..., :2]
        for _ in range(DIFFERENCES):
            smooth[1:] -= smooth[:-1].copy()
        bits = bits.reshape(cells, -1).T
    planes = np.ascontiguousarray(bits).reshape(-1).view(np.uint8).reshape(-1, 8).T
    kind = "whole" if values.dtype == np.int64 else "real"
    more = {"shape": list(values.shape), "cells": cells, "kind": kind, "how": how, "steps": steps}
    return {**more, "data": deflated(planes.tobytes())}


def _but_ends(cubics: Reals) -> Integers:
    """Return the bits of cubics, less those that values and slopes at the ends of the cells give powers 2 and 3."""
    following = np.zeros_like(cubics)
    following[:-1] = cubics[1:]
    v0, d0, v1, d1 = cubics[..., 0], cubics[..., 1], following[..., 0], following[..., 1]
    bits = np.ascontiguousarray(cubics).view(np.int64).copy()
    for power, given in ((2, 3 * (v1 - v0) - 2 * d0 - d1), (3, 2 * (v0 - v1) + d0 + d1)):
        bits[..., power] -= np.ascontiguousarray(given).view(np.int64)
    return bits

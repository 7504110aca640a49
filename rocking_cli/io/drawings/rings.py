"""Rings of corners, as formats without curves list them, and limits of all drawings that are text."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rocking_cli.arrays import Points

MAX_NUMBER = 1e12
"""Coordinates beyond this are refused."""
MAX_SIDES = 1_000_000
"""Sides of a drawing, at most."""
MAX_ELEMENTS = 60_000
"""Lines, outlines and other elements of a drawing, at most."""


def inside(rings: Sequence[Points]) -> complex:
    """Return a point within a polygon, and outside its holes: the middle of the widest part at one height.

    Parameters
    ----------
    rings : sequence of ndarray of complex
        Corners of the polygon, and of each hole.

    Returns
    -------
    complex
        The point; the mean of the corners if the polygon has no height.
    """
    z = rings[0]
    if np.ptp(z.imag) <= 1e-12 * np.abs(z).max():
        return complex(z.mean())
    heights = np.unique(z.imag)
    k = int(np.diff(heights).argmax())
    y = (heights[k] + heights[k + 1]) / 2
    crossings: list[float] = []
    for ring in rings:
        ends = np.roll(ring, -1)
        across = (ring.imag > y) != (ends.imag > y)
        p, q = ring[across], ends[across]
        crossings += (p.real + (y - p.imag) / (q.imag - p.imag) * (q.real - p.real)).tolist()
    crossings.sort()
    left, right = max(zip(crossings[::2], crossings[1::2], strict=True), key=lambda pair: pair[1] - pair[0])
    return complex((left + right) / 2, y)

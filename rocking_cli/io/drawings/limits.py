"""Limits of drawings that are text, and a place for the names of their shapes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rocking_cli.arrays import Points
from rocking_cli.io.drawings.contract import DrawingError

MAX_NUMBER = 1e12
"""Coordinates beyond this are refused."""
MAX_SIDES = 1_000_000
"""Sides of a drawing, at most."""
MAX_ELEMENTS = 60_000
"""Lines, outlines and other elements of a drawing, at most."""


def check_content(data: bytes, most: int, file: str) -> None:
    """Raise `DrawingError` if a text is blank or has more than `most` bytes."""
    if not data.strip(b"\0 \t\r\n\xef\xbb\xbf\xff\xfe"):
        raise DrawingError("empty", "the file is empty", file)
    if len(data) > most:
        raise DrawingError("too_large", f"the drawing has more than {most / 1e6:g} MB", file)


def check_count(count: int, most: int, what: str, file: str, line: int | None = None) -> None:
    """Raise `DrawingError` if a drawing has more than `most` of something."""
    if count > most:
        raise DrawingError("too_large", f"the drawing has more than {most:,} {what}", file, line=line)


def inside(rings: Sequence[Points]) -> complex:
    """Return a point within a polygon, given by its corners and those of its holes; the middle of a line."""
    import shapely

    if len(rings[0]) < 3:
        return complex(rings[0].mean())
    shell, *holes = (np.stack([z.real, z.imag], axis=1) for z in rings if len(z) > 2)
    at = shapely.point_on_surface(shapely.Polygon(shell, holes))
    return complex(at.x, at.y)

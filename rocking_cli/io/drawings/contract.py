"""What a reader of drawings yields: lines with arcs, points, texts and layers, or the surface of a body.

A reader is a module, or any object, with a `TITLE` (the name of its format), the `ENDINGS` of its files, and the
functions `sniff` and `read` of `DrawingReader`; a reader of meshes has `MESH = True`, one of models in space the names
of their `PLANES`, of which its `read` takes one as `plane`. Points of a drawing are complex
numbers x + iy, x to the right and y up, in the unit of the drawing. A bulge is tan(turn/4) of an arc that turns
anticlockwise by `turn`; 0 is a straight side. Limits of files and the geometry of arcs are here too.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import atan, cbrt, ceil, pi, sin, sqrt, tan
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Points, Reals
from rocking_cli.errors import InputError, Problem


@dataclass(frozen=True, eq=False)
class DrawnLine:
    """A line of straight sides and arcs, as it is drawn.

    Parameters
    ----------
    points : ndarray of complex, shape (n,)
        Its corners; a closed chain does not repeat the first.
    bulges : ndarray, shape (n,)
        Bulge of the side from each corner to the next; that of the last corner of an open chain is 0.
    closed : bool
        Whether a side leads from the last corner to the first.
    layer : str
        Its layer, as the file spells it; in an SVG file the label of its group.
    kind : str
        What it is in the file, such as LWPOLYLINE.
    handle : str
        What the file calls it; empty if it has no name.
    shape : str
        Name that the rings of one shape share: loops of a hatch, rings of a polygon, subpaths of a path. A ring inside
        another one of its shape is an opening. Empty for a chain alone.
    is_fill : bool
        Whether it is the edge of a hatch, which counts only if nothing else is drawn.
    is_straightened : bool
        Whether it stands for a curve that is no arc, such as a spline.
    heights : tuple of float
        Least and greatest z of its corners.
    arcs_found : int
        Number of its arcs that the file has as cubic curves, as it has no arcs.
    """

    points: Points
    bulges: Reals
    closed: bool
    layer: str
    kind: str
    handle: str = ""
    shape: str = ""
    is_fill: bool = False
    is_straightened: bool = False
    heights: tuple[float, float] = (0.0, 0.0)
    arcs_found: int = 0


@dataclass(frozen=True)
class DrawnText:
    """A text of a drawing, in plain characters, at its point of insertion."""

    text: str
    at: complex
    layer: str
    kind: str
    handle: str = ""


@dataclass(frozen=True)
class DrawnPoint:
    """A point of a drawing."""

    at: complex
    layer: str
    kind: str
    handle: str = ""


@dataclass(frozen=True)
class OmittedKind:
    """Things of a file that the reader leaves out: how many of a kind on a layer, and why."""

    kind: str
    layer: str
    why: str
    count: int


@dataclass(frozen=True)
class LineDrawing:
    """Everything in a drawing that may mean something.

    Parameters
    ----------
    format : str
        Name of the format.
    chains, labels, spots : sequence
        Its lines, texts and points, in the order of the file.
    left_out : sequence of OmittedKind
        What is not among them.
    unit : str or None
        Its unit of length, one of `rocking_cli.units`; None if the file does not state a unit that can be believed.
    paper : float or None
        Size of one unit on the paper [m], for a drawing to scale; None if it is not known.
    doubt : str
        Why the unit of the file is not believed; empty if it states none.
    faults : sequence of str
        What was mended, or is at fault, in a damaged file.
    annotations : sequence of ndarray of complex
        Lines of dimensions and leaders, which mean nothing, for the picture.
    depth : float or None
        Depth of its bodies [units], if it is known.
    """

    format: str
    chains: Sequence[DrawnLine]
    labels: Sequence[DrawnText] = ()
    spots: Sequence[DrawnPoint] = ()
    left_out: Sequence[OmittedKind] = ()
    unit: str | None = None
    paper: float | None = None
    doubt: str = ""
    faults: Sequence[str] = ()
    annotations: Sequence[Points] = ()
    depth: float | None = None


@dataclass(frozen=True, eq=False)
class MeshSurface:
    """The surface of a body as triangles, as the file has them.

    Parameters
    ----------
    format : str
        Name of the format.
    points : ndarray, shape (n, 3)
        Corners, in the unit of the file; in single precision if the file has them so.
    triangles : ndarray of int, shape (m, 3)
        Corners of each triangle; none in a cloud of points.
    """

    format: str
    points: Reals
    triangles: NDArray[np.int64]


class DrawingError(InputError):
    """A drawing or mesh from which no structure is made.

    Parameters
    ----------
    refused : str
        Class of the reason, such as "units" or "layers".
    message : str
        What is wrong and what to do.
    file : str, optional
        The file.
    at : sequence of sequence of float
        Where, [x, y] or [x, y, z], in the unit of the message.
    hint : str, optional
        Remedy.
    line : int, optional
        Line of the file, from 1.
    """

    def __init__(
        self,
        refused: str,
        message: str,
        file: str | None = None,
        at: Sequence[Sequence[float]] = (),
        hint: str | None = None,
        line: int | None = None,
    ) -> None:  # fmt: skip
        self.refused, self.at = refused, [list(each) for each in at]
        super().__init__(Problem(message, file, line, hint=hint))


class DrawingReader(Protocol):
    """Interface of a reader of drawings or meshes."""

    TITLE: str
    ENDINGS: tuple[str, ...]

    def sniff(self, data: bytes, ending: str, /) -> bool:
        """Return whether a file with this content, and this ending in small letters, has this format; never raises."""
        ...

    def read(self, data: bytes, file: str, /) -> LineDrawing | MeshSurface:
        """Read a file of this format; `file` is its name in messages. Raises `DrawingError`."""
        ...


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


SIDES_PER_HALF_TURN = 128  # with the area kept: 1e-6 in lambda, phi_cr and inertia, even if all sides are arcs
STRAIGHT_BULGE = 1e-9  # bulge up to which a side counts as straight
Sides = Callable[[float, float], int]
"""Function that gives the number of straight sides of an arc from its radius and its turn [rad]."""


def arc_circle(start: complex, end: complex, bulge: float) -> tuple[complex, float]:
    """Return the centre and the radius of an arc."""
    centre = (start + end) / 2 + 1j * (end - start) * (1 - bulge**2) / (4 * bulge)
    return centre, abs(start - centre)


def level_count(_: float, turn: float) -> int:
    """Return the number of sides of an arc that keep its area: 128 a half turn, and more for flat arcs."""
    share = min(cbrt(abs(tan(turn / 4))), 1.0)
    return max(ceil(SIDES_PER_HALF_TURN * abs(turn) / pi), ceil(SIDES_PER_HALF_TURN * share), 2)


def inner_points(start: complex, end: complex, bulge: float, count: Sides, *, keeps_area: bool = False) -> Points:
    """Return points along an arc between its ends; `count` gives the number of sides from radius and turn."""
    turn = 4 * atan(bulge)
    centre, radius = arc_circle(start, end, bulge)
    n = count(radius, turn)
    out = 1.0
    if keeps_area:  # distance q of the inner points over the radius at which n sides have the area of the arc
        right = abs(turn) / sin(abs(turn) / n)  # = (n - 2) q^2 + 2 q
        out = right / 2 if n == 2 else (sqrt(1 + (n - 2) * right) - 1) / (n - 2)
    points: Points = centre + out * (start - centre) * np.exp(1j * turn * np.arange(1, n) / n)
    return points

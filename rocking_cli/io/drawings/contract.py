"""What a reader of drawings yields: lines with arcs, points, texts and layers, or the surface of a body.

A reader is a module, or any object, with a `TITLE` (the name of its format), the `ENDINGS` of its files, and the
functions `sniff` and `read` of `DrawingReader`; a reader of meshes has `MESH = True`, one of models in space the names
of their `PLANES`, of which its `read` takes one as `plane`. Points of a drawing are complex
numbers x + iy, x to the right and y up, in the unit of the drawing. A bulge is tan(turn/4) of an arc that turns
anticlockwise by `turn`; 0 is a straight side.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
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

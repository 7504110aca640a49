"""Unit, origin and scale of a drawing, and notes on what an import mended, assumed and left out."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import isfinite
from typing import NamedTuple

import numpy as np

from rocking_cli.arrays import Points
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.io.drawings.contract import DrawingError, LineDrawing
from rocking_cli.text import cut
from rocking_cli.units import KINDS


@dataclass(frozen=True)
class ImportNote:
    """A thing that was mended, assumed or left out.

    Parameters
    ----------
    kind : str
        Its kind, such as "joined" or "left out".
    count : int
        How many times.
    words : str
        The sentence, without a full stop.
    at : sequence of complex
        Where [units of the drawing].
    """

    kind: str
    count: int
    words: str
    at: Sequence[complex] = ()


class DrawingFrame(NamedTuple):
    """The unit and the origin of a drawing, its closing distance [m] and its file.

    Metres are (units - origin) times `per`.
    """

    per: float
    origin: complex
    close: float
    file: str

    def to_metres(self, z: Points) -> Points:
        """Return points in metres."""
        return (np.asarray(z) - self.origin) * self.per

    def to_drawing(self, z: complex) -> complex:
        """Return a point in units of the drawing."""
        return complex(z) / self.per + self.origin

    def place(self, z: complex) -> str:
        """Return a point in words, in units of the drawing."""
        at = self.to_drawing(z)
        return f"({at.real:.7g}, {at.imag:.7g})"

    def refusal(self, refused: str, message: str, at: Iterable[complex] = (), hint: str | None = None) -> DrawingError:
        """Return the error of a class, with its places [m]; `<here>` in the message is the first one, in words."""
        points = list(at)
        if points:
            message = message.replace("<here>", self.place(points[0]))
        return DrawingError(refused, message, self.file, [[z.real, z.imag] for z in map(self.to_drawing, points)], hint)


def length_in_words(metres: float) -> str:
    """Return a small length in millimetres, a larger one in metres."""
    return f"{1000 * metres:.3g} mm" if metres < 1 else f"{metres:.4g} m"


def many(count: int, name: str) -> str:
    """Return a number of things: "1 line", "2 lines"."""
    return f"{count:,} {name}{'' if count == 1 else 's'}"


MIN_SIZE, MAX_SIZE = 0.1, 100.0  # sizes between which the unit of a file is believed [m]
SAME_SIZE = 0.01  # difference from the size on paper that a scale cannot be
SHOWN = ("mm", "cm", "m")  # units in which a size without one is shown


def scale_of(text: str) -> float:
    """Return the number of a scale such as `1:50`. Raises `InputError` if it is not one."""
    match = re.fullmatch(r"\s*1\s*:\s*([0-9]+(?:\.[0-9]+)?)\s*", text)
    if match is None or not 0 < float(match[1]) <= 1e6:
        raise InputError(Problem(f"{cut(repr(text))} is not a scale", field=named("scale"), hint="write it as 1:50"))
    return float(match[1])


def metres(unit: str) -> float:
    """Return the length of a unit [m]. Raises `InputError` if it is not a unit of length."""
    units = KINDS["length"]
    if unit not in units:
        raise InputError(
            Problem(
                f"{cut(repr(unit))} is not a unit of length", field=named("units"), hint=f"one of {', '.join(units)}"
            )
        )
    return float(units[unit])


def metres_per_unit(
    drawing: LineDrawing, size: float, units: str | None, scale: str | None, file: str
) -> tuple[float, str]:
    """Return the metres to a unit of a drawing, and the words for where they come from.

    Parameters
    ----------
    drawing : LineDrawing
        The drawing.
    size : float
        Larger of width and height of what is drawn [units].
    units, scale : str or None
        As the user gives them: `mm`, `1:50`.
    file : str
        Name of the file in messages.

    Raises
    ------
    DrawingError
        Of the class "units", if they are not given, and the file states none that can be believed.
    InputError
        If `units` or `scale` are not valid.
    """
    times = scale_of(scale) if scale is not None else 1.0
    if units is not None:
        per, words = metres(units) * times, f"1 unit = 1 {units}" + (f", at {scale}" if scale else "")
        if drawing.paper is not None and abs(per / drawing.paper - 1) < SAME_SIZE:
            words += f", the size on paper (if it is drawn to a scale, give {named('scale')})"
    elif scale is not None and drawing.paper is not None:
        per, words = drawing.paper * times, f"the size on paper, at {scale}"
    elif drawing.unit is not None:
        per, words = (
            metres(drawing.unit) * times,
            f"the unit is {drawing.unit}, as stated in the file" + (f", at {scale}" if scale else ""),
        )
        if not MIN_SIZE <= size * per <= MAX_SIZE:
            what = (
                f"the file says {drawing.unit}, and what is drawn would be {size * per:.3g} m large: give "
                f"{named('units')}"
            )
            raise DrawingError("units", what, file)
    else:
        sizes = ", ".join(f"{size * metres(each):.4g} m if {each}" for each in SHOWN)
        why = drawing.doubt or f"the drawing does not say its units{' or its scale' * (drawing.paper is not None)}"
        more = f" or {named('scale')}" if drawing.paper is not None and scale is None else ""
        raise DrawingError("units", f"{why}: give {named('units')}{more} (it is {size:.4g} units large: {sizes})", file)
    if not isfinite(size * per) or not 1e-3 <= size * per <= 1e4:
        what = (
            f"what is drawn would be {size * per:.3g} m large: give other {named('units')} or another {named('scale')}"
        )
        raise DrawingError("units", what, file)
    return per, words

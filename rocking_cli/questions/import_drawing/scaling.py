"""The size of a drawing: metres to one of its units."""

from __future__ import annotations

import re
from math import isfinite

from rocking_cli.errors import InputError, Problem, named
from rocking_cli.io.drawings.contract import DrawingError, LineDrawing
from rocking_cli.text import cut
from rocking_cli.units import KINDS

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

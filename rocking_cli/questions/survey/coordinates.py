"""Longitudes and latitudes of the structures of a table, from its columns of these names."""

from __future__ import annotations

from dataclasses import dataclass
from math import nan
from typing import TYPE_CHECKING

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.io.spreadsheet import Row, Spreadsheet, unit_in
from rocking_cli.text import cut, one_line

if TYPE_CHECKING:
    from rocking_cli.questions.survey.study import Survey

LONGITUDE, LATITUDE = "longitude", "latitude"
COORDINATES = {LONGITUDE: LONGITUDE, "lon": LONGITUDE, LATITUDE: LATITUDE, "lat": LATITUDE}
"""Which coordinate the column of a heading holds, in degrees."""
MAX_DEGREES = {LONGITUDE: 180.0, LATITUDE: 90.0}
DEGREES = ("", "deg", "°")


def coordinate(heading: str) -> str | None:
    """Return which coordinate a column holds; None if it is another column. A `#` before its name changes nothing.

    Examples
    --------
    >>> coordinate("longitude [deg]"), coordinate("#Lat"), coordinate("width")
    ('longitude', 'latitude', None)
    """
    name, unit = unit_in(heading.lstrip("#").strip().lower(), ())
    return COORDINATES.get(name) if unit in DEGREES else None


@dataclass(frozen=True)
class Coordinates:
    """Where the ranked structures of a survey are.

    Parameters
    ----------
    longitude, latitude : ndarray, shape (n,)
        In degrees, by rank; NaN for a structure without coordinates. All longitudes are within 180 degrees of their
        mean, so that structures on both sides of the date line are beside each other.
    wrong : list of str
        What is wrong with cells that are not coordinates, a sentence each.
    """

    longitude: Reals
    latitude: Reals
    wrong: list[str]

    @property
    def there(self) -> np.ndarray:
        """Indices of the structures that have coordinates, by rank."""
        return np.flatnonzero(np.isfinite(self.longitude))


def columns_of(sheet: Spreadsheet | None) -> dict[str, int]:
    """Return the places of the columns of longitude and latitude. Raises `InputError` if a table lacks one of them."""
    headings = enumerate(sheet.headings if sheet is not None else ())
    columns = {name: k for k, heading in headings if (name := coordinate(heading)) is not None}
    if len(columns) < len(MAX_DEGREES):
        lacks = " and ".join(each for each in MAX_DEGREES if each not in columns)
        file = sheet.file if sheet is not None else None
        hint = f"{named('map')} needs columns longitude and latitude (or lon and lat), in degrees"
        raise InputError(Problem(f"the structures have no {lacks}", file, hint=hint))
    return columns


def coordinates(found: Survey) -> Coordinates:
    """Return where the structures of a survey are.

    Raises
    ------
    InputError
        If the table lacks a column of coordinates, or no structure has both.
    """
    sheet, columns = found.sheet, columns_of(found.sheet)
    assert sheet is not None  # columns of coordinates were found in it
    wrong, degrees = list[str](), np.full((len(found.rows), 2), nan)
    for k, structure in enumerate(found.rows):
        row = sheet.rows[structure.row - 1]
        try:
            point = [_degrees(sheet, row, columns[each], each) for each in MAX_DEGREES]
        except InputError as error:
            wrong.append(str(error))
            continue
        degrees[k] = point if None not in point else nan
    if np.isnan(degrees).all():
        raise InputError(Problem("no structure has both coordinates", sheet.file, hint=wrong[0] if wrong else None))
    x, y = degrees.T
    turns = np.exp(1j * np.radians(x[np.isfinite(x)])).mean()
    mean = float(np.degrees(np.angle(turns)))
    return Coordinates((x - mean + 180.0) % 360.0 - 180.0 + mean, y, wrong)


def _degrees(sheet: Spreadsheet, row: Row, place: int, name: str) -> float | None:
    """Return a coordinate of a row [degrees]; None if it is not given."""
    cell = row.cells[place]
    if not cell:
        return None
    number = sheet.number(cell)
    if number is None or abs(float(number)) > MAX_DEGREES[name]:
        largest = MAX_DEGREES[name]
        what = f"must be a number of degrees from -{largest:g} to {largest:g}, got {cut(one_line(cell))!r}"
        raise InputError(Problem(what, sheet.file, row.line, field=cut(one_line(sheet.headings[place]))))
    return float(number)

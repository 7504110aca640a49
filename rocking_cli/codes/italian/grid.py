"""The reference grid of the seismic hazard of Italy, which users bring, and the hazard at a site in one of its cells.

DM 14/01/2008, Allegato A: each parameter at a site is the mean of those of the four corners of the cell that contains
it, weighted by the inverse of their distances. Allegato B, table 1, has the nodes; a_g is there in tenths of g.
"""

from __future__ import annotations

import csv
import gzip
import io
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import isfinite
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Reals
from rocking_cli.errors import InputError, Problem
from rocking_cli.io.files import read_at_most, read_bytes
from rocking_cli.io.spreadsheet import SPREADSHEETS, sheets_of
from rocking_cli.text import cut, one_line

EARTH_RADIUS = 6371.0  # km
MAX_BYTES = 100_000_000  # the table of the decree has three million
MAX_HEADING_ROWS = 50  # rows of a sheet in which its headings are searched
GZIP = b"\x1f\x8b"
NEIGHBOURS = 25  # nodes about a site, among which the steps of the grid are measured
MAX_ALONG = 0.35  # cosine of the angle between the two directions of the grid, which is 70 to 110 degrees
ON_EDGE = 1e-9  # share of a cell by which rounding may put a site on its edge outside
LARGEST_AG = 1.0  # g; no node of the decree has more, at 2475 years
UNITS_OF_AG = {**dict.fromkeys(("tenths", "tenthsg", "tenthsofg", "decimidig"), 0.1), "g": 1.0}
UNIT_HINT = "name it in the headings of ag: `ag_30 [g/10]` for tenths of g, the unit of the decree, or `ag_30 [g]`"
COLUMNS_HINT = "it needs columns lon, lat, and for each return period such as ag_30, F0_30, TC_30"
BY_HAND = (
    "give instead `hazard`, rows of [return period, ag, F0, TC*]: for Sardinia and the small islands those of table 2 "
    "of Allegato B to DM 14/01/2008, else those of a program such as Spettri-NTC"
)
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")
_PARAMETER = re.compile(r"(?P<before>t?r?\d*)(?P<name>ag|f[0o]|tc)(?:star)?(?P<after>.*)")


class Corner(NamedTuple):
    """A node of the grid at a corner of the cell of a site.

    Parameters
    ----------
    longitude, latitude : float
        Place of the node [deg].
    distance : float
        Distance from the site on a sphere [km].
    share : float
        Weight of the node in the mean, of sum 1.
    """

    longitude: float
    latitude: float
    distance: float
    share: float


class Cell(NamedTuple):
    """The cell of the grid that contains a site.

    Parameters
    ----------
    corners : sequence of Corner
        Its four corners; of a site on a node this node alone.
    rows : list of list of float
        For each return period of the grid [years]: a_g [g], F0 and T_C* [s] at the site.
    unit : str
        Key of the text on the unit of a_g in the file.
    """

    corners: Sequence[Corner]
    rows: list[list[float]]
    unit: str


@dataclass(frozen=True, eq=False)
class Grid:
    """The nodes of a grid.

    Parameters
    ----------
    places : ndarray of complex, shape (n,)
        Longitude + i latitude of each node [deg].
    periods : ndarray, shape (m,)
        Return periods, increasing [years].
    values : ndarray, shape (n, m, 3)
        For each node and return period: a_g [g], F0 and T_C* [s].
    unit : str
        Key of the text on the unit of a_g in the file.
    """

    places: NDArray[np.complex128]
    periods: Reals
    values: Reals
    unit: str

    def cell(self, longitude: float, latitude: float) -> Cell:
        """Return the cell that contains a site [deg]. Raises `InputError` if there is none."""
        away = distances(self.places, longitude, latitude)
        corners = [int(away.argmin())]
        if away[corners[0]] > 0:
            corners = self._corners(longitude, latitude, away)
        weights = 1 / away[corners] if len(corners) > 1 else np.ones(1)
        shares = weights / weights.sum()
        rows = np.column_stack([self.periods, np.tensordot(shares, self.values[corners], 1)]).tolist()
        nodes = zip(self.places[corners].tolist(), away[corners].tolist(), shares.tolist(), strict=True)
        return Cell([Corner(node.real, node.imag, d, share) for node, d, share in nodes], rows, self.unit)

    def _corners(self, longitude: float, latitude: float, away: Reals) -> list[int]:
        """Return the nodes at the corners of the cell around a site. Raises `InputError` if there are not four.

        The nodes about the site are numbered along the two directions of the grid, from the nearest node, which is a
        corner of the cell.
        """
        nearest = away.argsort()[:NEIGHBOURS]
        from_site = self.places[nearest] - complex(longitude, latitude)
        z = from_site.real * np.cos(np.radians(latitude)) + 1j * from_site.imag
        steps = (z[:, None] - z).ravel()
        along = steps[np.where(steps == 0, np.inf, np.abs(steps)).argmin()]
        turned = steps / along
        is_across = (steps != 0) & (np.abs(turned.real) < MAX_ALONG * np.abs(turned))
        width = np.abs(turned.imag[is_across]).min(initial=np.inf)
        numbered = (z - z[0]) / along
        numbered = numbered.real + 1j * numbered.imag / width
        places = dict(zip(numbered.round().tolist(), nearest.tolist(), strict=True))
        for i, j in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
            corners = [places.get(each) for each in (0j, complex(i), complex(i, j), complex(0, j))]
            if None not in corners:
                whole = [k for k in corners if k is not None]
                if _holds(self.places[whole] - complex(longitude, latitude)):
                    return whole
        site = -z[0] / along
        in_step = max(abs(site.real), abs(site.imag) / width) < 1  # else the site is beyond the nodes next to this one
        raise InputError(
            self._uncovered(longitude, latitude, float(away[nearest[0]]), int(nearest[0]), lacks_node=in_step)
        )

    def _uncovered(self, longitude: float, latitude: float, away: float, nearest: int, *, lacks_node: bool) -> Problem:
        """Return the problem of a site that no cell of the grid contains."""
        node, swapped = self.places[nearest], complex(latitude, longitude)
        low, high = (complex(end(self.places.real), end(self.places.imag)) for end in (np.min, np.max))
        if low.real <= swapped.real <= high.real and low.imag <= swapped.imag <= high.imag:
            message = f"is {longitude:g} and latitude {latitude:g}: outside the grid, but inside it the other way round"
            return Problem(message, field="longitude", hint="exchange longitude and latitude")
        message = "is outside the grid: no cell contains"
        if lacks_node:
            message = "is in a hole or at the edge of the grid: a node is missing around"
        nearest_node = f"the nearest node, {node.real:g}, {node.imag:g}, is {away:.3g} km away"
        message = f"{message} the site at {longitude:g}, {latitude:g}; {nearest_node}"
        return Problem(message, field="longitude", hint=BY_HAND)


def _holds(corners: NDArray[np.complex128]) -> bool:
    """Return whether a polygon contains the origin, or has it on its edge."""
    turns = (np.conj(corners) * (np.roll(corners, -1) - corners)).imag
    least = ON_EDGE * np.abs(turns).max()
    return bool((turns >= -least).all() or (turns <= least).all())


def distances(places: NDArray[np.complex128], longitude: float, latitude: float) -> Reals:
    """Return the distances of places [longitude + i latitude, deg] from a site, on a sphere [km; haversine]."""
    one, other = np.radians(places.imag), np.radians(latitude)
    across = np.radians(places.real - longitude)
    half = np.sin((one - other) / 2) ** 2 + np.cos(one) * np.cos(other) * np.sin(across / 2) ** 2
    return np.asarray(2 * EARTH_RADIUS * np.arcsin(np.sqrt(half)))


def read_grid(path: Path) -> Grid:
    """Return the grid of a file, read once as long as it does not change.

    Parameters
    ----------
    path : Path
        The table as CSV, plain or gzip, or as a spreadsheet (.xls, .xlsx, .ods), which needs python-calamine: a row for
        each node, with its longitude and latitude [deg], and a_g, F0 and T_C* [s] of each return period. Columns are
        known by their headings; a row above them may have the return periods.

    Raises
    ------
    InputError
        If the file cannot be read, or lacks a column, or a value is not valid.
    """
    try:
        known = path.stat()
    except (OSError, ValueError):
        known = None
    return _read(path, known and known.st_mtime_ns, known and known.st_size)


@lru_cache(maxsize=4)
def _read(path: Path, changed: int | None, size: int | None) -> Grid:
    del changed, size  # they only tell versions of the file apart in the cache
    file = str(path)
    lines = list(_lines(path))
    first = next((k for k, (_, cells) in enumerate(lines) if _is_of_numbers(cells)), len(lines))
    above, lines = [cells for _, cells in lines[:first]], lines[first:]
    lon, lat, by_period, units = _columns(file, above)
    used = [lon, lat, *(column for period in sorted(by_period) for column in by_period[period])]
    table = np.array([_row(file, number, cells, used) for number, cells in lines], dtype=np.float64)
    if len(table) < 4:
        raise InputError(Problem(f"has {len(table)} nodes, of which a cell needs four", file, hint=COLUMNS_HINT))
    periods = np.array(sorted(by_period), dtype=np.float64)
    values = table[:, 2:].reshape(len(table), periods.size, 3).copy()
    factor, unit = _unit_of_ag(file, units, float(values[:, -1, 0].max()))
    values[:, :, 0] *= factor
    grows = (np.diff(values[:, :, 0], axis=1) > 0).all(axis=1)
    if not (grows & (values > 0).all(axis=(1, 2))).all():
        number = lines[int(np.argmin(grows & (values > 0).all(axis=(1, 2))))][0]
        message = "ag, F0 and TC* must be above 0, and ag must increase with the return period"
        raise InputError(Problem(message, file, number, hint=COLUMNS_HINT))
    return Grid(table[:, 0] + 1j * table[:, 1], periods, values, unit)


def _lines(path: Path) -> Iterator[tuple[int, list[str]]]:
    """Yield the number of each line of a file that is not blank, and its cells, with decimal points."""
    raw: bytes | None = read_bytes(path, "grid file", MAX_BYTES)
    return _of_spreadsheet(path, raw) if raw and raw.startswith(SPREADSHEETS) else _cells(_text(path, raw))


def _of_spreadsheet(path: Path, raw: bytes) -> Iterator[tuple[int, list[str]]]:
    """Yield the lines of the first sheet that has a longitude among its headings."""
    sheets = sheets_of(raw, str(path)).values()
    for rows in sheets:
        if any(cell.lower().startswith("lon") for row in rows[:MAX_HEADING_ROWS] for cell in row):
            for number, row in enumerate(rows, 1):
                if any(row):
                    yield number, row
            return
    raise InputError(Problem("no sheet has a heading that names the longitude", str(path), hint=COLUMNS_HINT))


def _text(path: Path, raw: bytes | None) -> str:
    """Return the text of the table in a file, decompressed."""
    if raw and raw.startswith(GZIP):
        try:
            with gzip.GzipFile(fileobj=io.BytesIO(raw)) as stream:
                raw = read_at_most(stream, MAX_BYTES)
        except (OSError, EOFError) as error:
            raise InputError(Problem(f"the gzip file cannot be unpacked: {error}", str(path))) from None
    if raw is None:
        message = f"this cannot be a grid file: unpacked it is larger than {MAX_BYTES / 1e6:g} MB"
        raise InputError(Problem(message, str(path)))
    encoding = "utf-16" if raw[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig"
    return raw.decode(encoding, errors="replace")  # a heading in another encoding is still known by its letters


def _cells(text: str) -> Iterator[tuple[int, list[str]]]:
    """Yield the number of each line that is not blank, and its cells, with decimal points."""
    separator = next((sign for sign in ";\t," if sign in text), ",")
    quoted = '"' in text
    if separator != ",":
        text = text.replace(",", ".")
    for number, cells in enumerate(csv.reader(io.StringIO(text), delimiter=separator), 1):
        if any(cells):
            yield number, [cell.replace(",", ".") for cell in cells] if quoted else cells


def _is_of_numbers(cells: Sequence[str]) -> bool:
    filled = [cell.strip() for cell in cells if cell.strip()]
    return len(filled) > 2 and all(_NUMBER.fullmatch(cell) for cell in filled)


def _columns(file: str, above: Sequence[list[str]]) -> tuple[int, int, dict[int, list[int]], set[str]]:
    """Return the columns of longitude and latitude, those of each return period, and the units named for a_g."""
    names = [[re.sub(r"[^a-z0-9/]", "", cell.lower()) for cell in cells] for cells in above]
    row = next((k for k, cells in enumerate(names) if any(cell.startswith("lon") for cell in cells)), None)
    if row is None:
        raise InputError(Problem("no heading names the longitude", file, hint=COLUMNS_HINT))
    group, period_above = names[row - 1] if row else [], ""
    below = names[row + 1] if row + 1 < len(names) else []
    lon, lat, units, places = None, None, set[str](), dict[int, dict[str, int]]()
    for k, name in enumerate(names[row]):
        period_above = group[k] if k < len(group) and group[k] else period_above
        lon, lat = (k if name.startswith("lon") else lon), (k if name.startswith("lat") else lat)
        match = _PARAMETER.fullmatch(name + (below[k] if k < len(below) else ""))
        if match is None:
            continue
        more = match["before"] + match["after"].replace("g/10", "tenths")
        years = re.findall(r"\d+", more) or re.findall(r"\d+", period_above)
        if len(years) != 1:
            heading = cut(one_line(above[row][k].strip()))
            message = f"the heading {heading!r} must have one return period, and no unit but g or g/10"
            raise InputError(Problem(message, file, hint=COLUMNS_HINT))
        if match["name"] == "ag":
            units.add(re.sub(r"t?r?\d+(years|anni)?", "", more))
        places.setdefault(int(years[0]), {})[match["name"].replace("o", "0")] = k
    incomplete = [f"{years} years" for years, columns in places.items() if len(columns) < 3]
    if lon is None or lat is None or len(places) < 2 or incomplete:
        what = f"at {incomplete[0]} one of ag, F0 and TC is missing" if incomplete else "columns are missing"
        raise InputError(Problem(what, file, hint=COLUMNS_HINT))
    return lon, lat, {years: [each["ag"], each["f0"], each["tc"]] for years, each in places.items()}, units


def _row(file: str, number: int, cells: Sequence[str], used: Sequence[int]) -> list[float]:
    """Return the numbers of a line. Raises `InputError` if one is missing or not finite."""
    try:
        values = [float(cells[k]) for k in used]
    except (ValueError, IndexError):
        values = [float("nan")]
    if not all(map(isfinite, values)):
        excerpt = one_line(cut(";".join(cells), 100))
        raise InputError(Problem("a number is missing in this line", file, number, excerpt=excerpt, hint=COLUMNS_HINT))
    return values


def _unit_of_ag(file: str, units: set[str], largest: float) -> tuple[float, str]:
    """Return the factor from a_g in a file to g, and the key of a text on its unit.

    `largest` is the largest value of the longest return period. Without a unit in the headings, values that no
    ground has in g are tenths; smaller ones may be either.
    """
    named = {UNITS_OF_AG.get(unit) for unit in units if unit}
    if not named and largest > LARGEST_AG:
        return 0.1, "ag_too_large_for_g"
    if len(named) != 1 or None in named:
        message = f"the headings do not say whether ag is in g or in tenths of g, and it reaches only {largest:.3g}"
        if named:
            message = f"the headings give ag in {' and '.join(sorted(filter(None, units)))}: not one known unit"
        raise InputError(Problem(message, file, hint=UNIT_HINT))
    factor = named.pop() or 1.0
    if factor * largest > LARGEST_AG:
        message = f"by the headings ag reaches {factor * largest:.3g} g, which is more than any ground has"
        raise InputError(Problem(message, file, hint=UNIT_HINT))
    return factor, "ag_in_tenths" if factor < 1 else "ag_in_g"

"""A building from a table of walls, a row for each wall in each storey."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rocking_cli.errors import InputError, Problem
from rocking_cli.io.spreadsheet import Spreadsheet, read_sheet, unit_in
from rocking_cli.io.starters import italian
from rocking_cli.io.yaml_file import block
from rocking_cli.text import did_you_mean
from rocking_cli.units import UnitError, mass_of_weight, read

COLUMNS = {"name": "", "storey": "", "thickness": "m", "height": "m", "length": "m", "bears": "kg/m2", "span": "m",
           "density": "kg/m3"}  # fmt: skip
REQUIRED = ("name", "storey", "thickness", "height", "length")
ITALIAN = {"storeys": "storey", "porta": "bears", "solaio": "bears"}
TWO = {"length": "lengths", "density": "densities"}  # what a wall has one of
MAX_STOREYS = 199
SAME_HEIGHT = 0.01  # m, by which the heights of walls in a storey may differ
USUAL_DENSITY = "18 kN/m3"
Cells = Mapping[int, Mapping[str, Any]]
"""Of a wall the values of its row in each storey."""


def described(path: Path) -> str:
    """Return the text of a building file that is made of a table of walls. Raises as `building_in`."""
    above = f"# The building of {path.name}: add floors, ties, openings and what stands on the walls"
    lines = [line for key, value in building_in(read_sheet(path)).items() for line in block(key, value)]
    return "\n".join([above, *lines, ""])


def building_in(sheet: Spreadsheet) -> dict[str, Any]:
    """Return the fields of the building that a table of walls describes.

    Parameters
    ----------
    sheet : Spreadsheet
        A row for each wall in each storey: name, storey, thickness, height, length; with `bears`, the load of the floor
        on top of it per area, and `span`, that of the floor. Headings may have units, and be Italian.

    Raises
    ------
    InputError
        If a column is missing or unknown, a cell is no number, or rows contradict each other.
    """
    places, walls, heights = _columns(sheet), dict[str, dict[int, Mapping[str, Any]]](), dict[int, float]()
    for row in sheet.rows:
        there = {name: (row.cells[k], unit) for name, (k, unit) in places.items() if row.cells[k]}
        given = {name: _value(sheet, row.line, name, *each) for name, each in there.items()}
        needed = [*REQUIRED, *["span"] * ("bears" in given), *["density"] * ("density" in places)]
        if lacking := [each for each in needed if each not in given]:
            raise InputError(Problem("is missing", sheet.file, row.line, field=lacking[0]))
        storey, rows = given["storey"], walls.setdefault(given["name"], {})
        if abs(heights.setdefault(storey, given["height"]) - given["height"]) > SAME_HEIGHT:
            what = f"is {given['height']:g} m, but storey {storey} is {heights[storey]:g} m high in rows above"
            raise InputError(Problem(what, sheet.file, row.line, field="height", hint="give each storey one height"))
        two = [key for key in TWO if any(each.get(key) != given.get(key) for each in rows.values())]
        if storey in rows or two:
            what = f"{given['name']} has " + (f"storey {storey} twice" if storey in rows else f"two {TWO[two[0]]}")
            hint = "give a wall of another length or density another name, and name what carries it"
            raise InputError(Problem(what, sheet.file, row.line, hint=hint))
        rows[storey] = given
    for name, storeys in {"the building": [*heights], **{name: [*rows] for name, rows in walls.items()}}.items():
        first = 1 if name == "the building" else min(storeys, default=1)
        if lacking_storeys := {*range(first, max(storeys, default=1) + 1)} - {*storeys}:
            raise InputError(Problem(f"{name} has no storey {min(lacking_storeys)}", sheet.file))
    return _fields(walls, heights)


def _columns(sheet: Spreadsheet) -> dict[str, tuple[int, str]]:
    """Return the place and the unit of each column."""
    places = dict[str, tuple[int, str]]()
    for k, heading in enumerate(sheet.headings):
        word, unit = unit_in(heading.strip(), ())
        name = italian()["building"].get(word.lower(), word.lower())
        name = ITALIAN.get(name, name)
        if name not in COLUMNS:
            hint = did_you_mean(name, list(COLUMNS)) or f"columns are {', '.join(COLUMNS)}"
            raise InputError(Problem(f"{heading} is not a column of a table of walls", sheet.file, 1, hint=hint))
        places[name] = k, unit
    if missing := [each for each in REQUIRED if each not in places]:
        raise InputError(Problem(f"the table of walls has no column {', '.join(missing)}", sheet.file, 1))
    return places


def _value(sheet: Spreadsheet, line: int, name: str, cell: str, unit: str) -> Any:
    """Return the value of a cell in the unit of its column."""
    if name == "name":
        return cell
    number = sheet.number(cell)
    text = f"{cell if number is None else number} {unit if number is not None else ''}".strip()
    try:
        value: Any = float(text) if number is not None and not unit else mass_of_weight(text, COLUMNS[name])
        value = read(text, COLUMNS[name]) if value is None else value
    except UnitError as error:
        raise InputError(Problem(error.message, sheet.file, line, field=name, hint=error.hint)) from None
    if not value > 0:
        hint = "leave the cell empty if nothing bears there" if name in ("bears", "span") else None
        raise InputError(Problem(f"must be above 0, got {cell}", sheet.file, line, field=name, hint=hint))
    if name == "storey" and not (1 <= value <= MAX_STOREYS and value.is_integer()):
        raise InputError(
            Problem(f"must be a whole number from 1 to {MAX_STOREYS}, got {cell}", sheet.file, line, field=name)
        )
    return int(value) if name == "storey" else value


def _fields(walls: Mapping[str, Cells], heights: Mapping[int, float]) -> dict[str, Any]:
    levels = [0.0]
    for storey in sorted(heights):
        levels.append(round(levels[-1] + heights[storey], 4))
    entries, floors = list[dict[str, Any]](), dict[tuple[int, float, float], list[str]]()
    for name, rows in walls.items():
        first, *_, top = [*sorted(rows), max(rows)]
        thick = [rows[storey]["thickness"] for storey in sorted(rows)]
        entry = {"name": name, "length": rows[first]["length"], "thickness": thick[0] if len({*thick}) == 1 else thick}
        entry |= {"storeys": [first, top]} if (first, top) != (1, max(heights)) else {}
        entries.append(entry | {key: rows[first][key] for key in ("density",) if key in rows[first]})
        for storey, each in rows.items():
            if "bears" in each:
                floors.setdefault((storey, each["bears"], each["span"]), []).append(name)
    bearing = [
        {"name": f"floor {k}", "level": level, "load": load, "span": span, "walls": names}
        for k, ((level, load, span), names) in enumerate(sorted(floors.items()), 1)
    ]
    masonry = {"density": entries[0].get("density", USUAL_DENSITY)}
    return {"levels": levels, "masonry": masonry, "walls": entries} | ({"floors": bearing} if bearing else {})

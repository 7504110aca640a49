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
SAME_HEIGHT = 0.01  # m, by which the heights of walls in a storey may differ
USUAL_DENSITY = "18 kN/m3"


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
        If a column is missing or unknown, a cell is no number, or walls of a storey differ in height.
    """
    words = {**italian()["building"], "porta": "bears", "solaio": "bears"}
    places, units = dict[str, int](), dict[str, str]()
    for k, heading in enumerate(sheet.headings):
        name, unit = unit_in(heading.strip(), ())
        name = name.lower()
        name = {"storeys": "storey"}.get(word := words.get(name, name), word)
        if name not in COLUMNS:
            hint = did_you_mean(name, list(COLUMNS)) or f"columns are {', '.join(COLUMNS)}"
            raise InputError(Problem(f"{heading} is not a column of a table of walls", sheet.file, 1, hint=hint))
        places[name], units[name] = k, unit
    if missing := [each for each in REQUIRED if each not in places]:
        raise InputError(Problem(f"the table of walls has no column {', '.join(missing)}", sheet.file, 1))
    walls, heights = dict[str, dict[int, Mapping[str, Any]]](), dict[int, float]()
    for row in sheet.rows:
        cells = {name: row.cells[k] for name, k in places.items() if row.cells[k]}
        if lacking := [each for each in REQUIRED if each not in cells]:
            raise InputError(Problem("is missing", sheet.file, row.line, field=lacking[0]))
        given: dict[str, Any] = {name: _value(sheet, row.line, name, cell, units[name]) for name, cell in cells.items()}
        storey = given["storey"]
        if abs(heights.setdefault(storey, given["height"]) - given["height"]) > SAME_HEIGHT:
            what = f"is {given['height']:g} m, but storey {storey} is {heights[storey]:g} m high in rows above"
            raise InputError(Problem(what, sheet.file, row.line, field="height", hint="give each storey one height"))
        of_wall = walls.setdefault(given["name"], {})
        if storey in of_wall:
            raise InputError(Problem(f"{given['name']} has storey {storey} twice", sheet.file, row.line))
        of_wall[storey] = given
    return _fields(sheet, walls, heights)


def _value(sheet: Spreadsheet, line: int, name: str, cell: str, unit: str) -> Any:
    """Return the value of a cell in the unit of its column."""
    if name == "name":
        return cell
    number = sheet.number(cell)
    text = f"{number} {unit}".strip() if number is not None else cell
    try:
        value: Any = float(number) if number is not None and not unit else None
        if value is None:
            value = mass if (mass := mass_of_weight(text, COLUMNS[name])) is not None else read(text, COLUMNS[name])
    except UnitError as error:
        raise InputError(Problem(error.message, sheet.file, line, field=name, hint=error.hint)) from None
    if name != "storey":
        return value
    if not value.is_integer() or value < 1:
        raise InputError(Problem(f"must be a whole number from 1, got {cell}", sheet.file, line, field=name))
    return int(value)


def _fields(
    sheet: Spreadsheet, walls: Mapping[str, Mapping[int, Mapping[str, Any]]], heights: Mapping[int, float]
) -> dict[str, Any]:
    last = max(heights)
    if lacking := [storey for storey in range(1, last + 1) if storey not in heights]:
        raise InputError(Problem(f"no wall has storey {lacking[0]}", sheet.file))
    levels = [0.0]
    for storey in range(1, last + 1):
        levels.append(round(levels[-1] + heights[storey], 4))
    entries, floors = list[dict[str, Any]](), dict[tuple[int, float, float], list[str]]()
    densities = [each["density"] for of in walls.values() for each in of.values() if "density" in each]
    for name, of in walls.items():
        first, top = min(of), max(of)
        if lacking := [storey for storey in range(first, top + 1) if storey not in of]:
            raise InputError(Problem(f"{name} has storeys {first} and {top}, but not {lacking[0]}", sheet.file))
        lengths = {each["length"] for each in of.values()}
        if len(lengths) > 1:
            hint = "give a wall of another length another name, and name what carries it"
            raise InputError(Problem(f"{name} has {len(lengths)} lengths", sheet.file, hint=hint))
        thick = [of[storey]["thickness"] for storey in range(first, top + 1)]
        entry = {"name": name, "length": lengths.pop(), "thickness": thick[0] if len({*thick}) == 1 else thick}
        own = {each["density"] for each in of.values() if "density" in each}
        entries.append(entry | ({"storeys": [first, top]} if (first, top) != (1, last) else {})
                       | ({"density": own.pop()} if own and len({*densities}) > 1 else {}))  # fmt: skip
        for storey, each in of.items():
            if "bears" in each:
                if "span" not in each:
                    what = f"is missing: {name} bears a floor in storey {storey}"
                    raise InputError(Problem(what, sheet.file, field="span"))
                floors.setdefault((storey, each["bears"], each["span"]), []).append(name)
    masonry = {"density": densities[0] if densities else USUAL_DENSITY}
    bearing = [
        {"name": f"floor {k}", "level": level, "load": load, "span": span, "walls": names}
        for k, ((level, load, span), names) in enumerate(sorted(floors.items()), 1)
    ]
    return {"levels": levels, "masonry": masonry, "walls": entries} | ({"floors": bearing} if bearing else {})


def described(path: Path) -> str:
    """Return the text of a building file that is made of a table of walls. Raises as `building_in`."""
    fields = building_in(read_sheet(path))
    above = f"# The building of {path.name}: add floors, ties, openings and what stands on the walls"
    return "\n".join([above, *(line for key, value in fields.items() for line in block(key, value)), ""])

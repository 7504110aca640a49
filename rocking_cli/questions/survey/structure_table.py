"""A table of structures: columns are fields, and each row becomes a structure, with its coordinates."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from copy import deepcopy
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from functools import cache, partial
from math import nan
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
import yaml
from pydantic import BaseModel

from rocking_cli.arrays import Reals
from rocking_cli.ask.inputs import sheet_of
from rocking_cli.core import Mechanism
from rocking_cli.core.registry import Registry
from rocking_cli.core.structure_file import TEMPLATE_HINT, of_document
from rocking_cli.errors import InputError, MechanismError, Problem, named
from rocking_cli.io.field_problems import MEANINGS, by_meaning, fields_at, is_plural, lists_models, types_at
from rocking_cli.io.spreadsheet import DECIMAL_COMMA, NUMBER, THOUSANDS, Row, Spreadsheet, unit_in
from rocking_cli.io.starters import STARTERS, italian, starter, template_of
from rocking_cli.io.yaml_file import Document, Place, closed, parse, put, read_text, replace_at, spell, words
from rocking_cli.questions.survey.inventory import Inventory, is_inventory
from rocking_cli.text import cut, did_you_mean, one_line
from rocking_cli.units import UnitError, number_of
from rocking_cli.verification.check import read_site, site_in
from rocking_cli.verification.code import SiteFile

if TYPE_CHECKING:
    from rocking_cli.processing.oscillator import Floor
    from rocking_cli.questions.survey.study import Survey

T = TypeVar("T")
FILE_COLUMN, MECHANISM_COLUMN, SITE_COLUMN, FLOOR = "file", "mechanism", "site", "floor"
GROUND = "ground"
"""Cell of a column `floor` for a structure that stands on no floor."""
YAML_SUFFIXES = (".yaml", ".yml")
COMMENT_SIGN = "#"
"""First character of the headings of columns that are not read."""
MAX_DIGITS = 308  # digits of the largest whole number that is a float
_UNIT = re.compile(r"(.*?)\s*\[([^\]]*)\]\s*", re.DOTALL)


@dataclass(frozen=True)
class FieldColumn:
    """A column that holds a field.

    Parameters
    ----------
    place : int
        Index of the cell in a row.
    heading : str
        Heading of the column in the table.
    path : tuple of str
        The field, see `rocking_cli.io.yaml_file`.
    unit : str
        Unit of numbers in the column that are given without a unit; empty for the unit of the field.
    """

    place: int
    heading: str
    path: tuple[str, ...]
    unit: str = ""

    @property
    def english(self) -> tuple[str, ...]:
        """The field, of which an Italian first word is in English, and `z` that of the floor."""
        path = (italian()["fields"].get(self.path[0].lower(), self.path[0]), *self.path[1:])
        return (FLOOR, "z") if path == ("z",) else path

    def of(self, cls: type[BaseModel] | None) -> tuple[str, ...]:
        """Return the field of a mechanism or site: `spessore` is the thickness of a wall, and the width of a block."""
        first, *others = self.english
        if first == "thickness" != self.path[0] and cls is not None and first not in cls.model_fields:
            meant = (each for each in MEANINGS[first] if each in cls.model_fields and not is_plural(cls, (each,)))
            first = next(meant, first)
        return (first, *others)


@dataclass
class _RowDocument(Document):
    """The data of a row, whose problems name the table, the line and the heading of the column."""

    line: int = 0
    base: str = ""
    separator: str = ","
    columns: dict[Place, str] = field(default_factory=dict)

    @property
    def mark(self) -> yaml.Mark:
        """Mark of all its values."""
        return yaml.Mark(self.file, 0, self.line - 1, 0, None, 0)

    def problem(
        self, message: str, mark: yaml.Mark | None, name: str | None = None, hint: str | None = None
    ) -> Problem:
        """Return a problem of this row."""
        return Problem(message, self.file, self.line, field=name, hint=hint)

    def at(self, place: Place, message: str, hint: str | None = None, *, key: bool = False) -> Problem:
        """Return a problem with the content of a column, or with a field that has no column."""
        heading = next((self.columns[place[:k]] for k in range(len(place), 0, -1) if place[:k] in self.columns), None)
        of_file = ": ".join(each for each in (cut(one_line(self.base)), spell(place)) if each)
        if heading and message.startswith("must be a list") and self.separator == ";":
            hint = 'in a table with semicolons write the point in quotes: "-6,0;7,5"'
        return self.problem(message, None, heading or of_file, hint)


class _Kept(Registry):
    """All installed mechanisms, each looked up once, as a table looks up the same ones thousands of times."""

    def __init__(self) -> None:
        super().__init__()
        self._kept: dict[str, type[Mechanism]] = {}

    def __getitem__(self, name: str) -> type[Mechanism]:
        if name not in self._kept:
            self._kept[name] = super().__getitem__(name)
        return self._kept[name]


class StructureTable(Sequence["TableRow"]):
    """The structures of a table, each built on demand.

    Parameters
    ----------
    sheet : Spreadsheet
        The table.
    folder : Path
        Folder of the files that the table names.

    Raises
    ------
    InputError
        If a heading is not a field of any mechanism in the rows.
    """

    def __init__(self, sheet: Spreadsheet, folder: Path) -> None:
        self.sheet, self.folder = sheet, folder
        self.registry = _Kept()
        self._kept: dict[str, Any] = {}
        self.columns = self._columns()
        # Columns with one word as heading, such as the name.
        self.by_word = {column.english[0]: column for column in self.columns if len(column.english) == 1}
        self.fields = [each for each in self.columns if each.english[0] not in (MECHANISM_COLUMN, SITE_COLUMN, FLOOR)]
        self.of_floor = [each for each in self.columns if each.english[0] == FLOOR]
        self.of_floor.sort(key=lambda each: each.english)  # `floor` itself first, which the others change
        self.sites = [*dict.fromkeys(file for row in sheet.rows if (file := self.text(row, SITE_COLUMN)))]
        self._check_fields()

    def __len__(self) -> int:
        return len(self.sheet.rows)

    def __getitem__(self, k: Any) -> Any:
        return TableRow(self, k) if isinstance(k, int) else [TableRow(self, each) for each in range(len(self))[k]]

    def __iter__(self) -> Iterator[TableRow]:
        return (TableRow(self, k) for k in range(len(self)))

    def text(self, row: Row, name: str) -> str:
        """Return the text of a row's cell, by the heading of its column; empty without such a column."""
        return row.cells[self.by_word[name].place] if name in self.by_word else ""

    def base_of(self, row: Row) -> str:
        """Return the YAML file that a row modifies; empty for none. Other files are fields of mechanisms."""
        file = self.text(row, FILE_COLUMN)
        return file if file.lower().endswith(YAML_SUFFIXES) else ""

    def starter_of(self, row: Row) -> str:
        """Return the starter that a row names as its mechanism, whose fields the other cells change; empty for none."""
        name = template_of(self.text(row, MECHANISM_COLUMN))
        return name if name in STARTERS and name not in self.registry else ""

    def first_site(self) -> SiteFile | None:
        """Return the first site that a row names and that can be used; None if there is none."""
        for file in self.sites:
            with suppress(InputError):
                return self.kept(file, read_site)
        return None

    def kept(self, file: str, read: Callable[[Path], T]) -> T:
        """Return what a file of the table holds, read once. Raises `InputError` if it cannot be read."""
        if file not in self._kept:
            try:
                self._kept[file] = read(self.folder / file)
            except InputError as error:
                self._kept[file] = error
        held = self._kept[file]
        if isinstance(held, InputError):
            raise held
        return held  # type: ignore[no-any-return]

    def _columns(self) -> list[FieldColumn]:
        columns, problems, used = [], [], dict[tuple[str, ...], str]()
        sheet = self.sheet
        for place, heading in enumerate(sheet.headings):
            if not heading or heading.startswith(COMMENT_SIGN) or coordinate(heading) is not None:
                continue
            name, unit = (match[1], match[2].strip()) if (match := _UNIT.fullmatch(heading)) else (heading, "")
            shown = cut(one_line(heading))
            try:
                path = words(name)
            except InputError as error:
                problems += [Problem(one.message, sheet.file, sheet.line, hint=one.hint) for one in error.problems]
                continue
            column = FieldColumn(place, shown, path, unit)
            if column.english in used:
                message = f"is the same field as {cut(one_line(used[column.english]))}"
                problems.append(Problem(message, sheet.file, sheet.line, field=shown, hint="take one of them away"))
            used[column.english] = heading
            columns.append(column)
        if problems:
            raise InputError(*problems)
        if not columns:
            raise InputError(Problem("the table has no headings", sheet.file, sheet.line, hint="mechanism,name,..."))
        return columns

    def _check_fields(self) -> None:
        """Check the headings against the fields of all mechanisms in the rows."""
        classes = []
        for name in sorted(self._mechanisms()):
            try:
                classes.append(self.registry[name])
            except (InputError, MechanismError):  # the error is reported for each row of this file
                continue
        if not {MECHANISM_COLUMN, FILE_COLUMN} & {column.english[0] for column in self.columns}:
            matches = get_close_matches(MECHANISM_COLUMN, [column.path[0].lower() for column in self.columns], n=1)
            similar = [column.heading for column in self.columns if matches and column.path[0].lower() == matches[0]]
            hint = f"write {MECHANISM_COLUMN} instead of {similar[0]}" if similar else ""
            hint = hint or "add one that names the mechanism of each row, or take rows above the headings away"
            what = f"the table has neither a column {MECHANISM_COLUMN} nor a column {FILE_COLUMN}"
            raise InputError(Problem(what, self.sheet.file, self.sheet.line, hint=hint))
        known = {MECHANISM_COLUMN, FILE_COLUMN, SITE_COLUMN, FLOOR}.union(*(fields_at(cls, ()) for cls in classes))
        problems = []
        for column in self.columns:
            if classes and known.isdisjoint(column.of(cls)[0] for cls in classes):
                fields = {name: info for cls in classes for name, info in fields_at(cls, ()).items()}
                guess = did_you_mean(column.path[0], sorted(known))
                guess = guess if guess and guess.endswith("?") else ""
                guess = by_meaning(column.path[0], fields) or guess
                guess = f"{guess}." if guess and not guess.endswith("?") else guess
                what = "any mechanism in this table" if len(classes) > 1 else classes[0].mechanism
                hint = f"{guess} A column whose heading starts with {COMMENT_SIGN} is ignored".strip()
                message = f"is not a field of {what}"
                problems.append(Problem(message, self.sheet.file, self.sheet.line, field=column.heading, hint=hint))
        if problems:
            raise InputError(*problems)

    def _mechanisms(self) -> set[str]:
        """Return the names of the mechanisms in the rows, known or not."""
        starts = {starter_name for row in self.sheet.rows if (starter_name := self.starter_of(row))}
        mechanisms = {self.text(row, MECHANISM_COLUMN) for row in self.sheet.rows if not self.starter_of(row)}
        mechanisms |= {str(self.kept(each, _starter)[MECHANISM_COLUMN]) for each in starts}
        for file in {self.base_of(row) for row in self.sheet.rows if not self.text(row, MECHANISM_COLUMN)} - {""}:
            try:
                mechanisms.add(str(self.kept(file, _data_in).get(MECHANISM_COLUMN)))
            except InputError:  # the error is reported for each row of this file
                continue
        return mechanisms - {""}


@dataclass(frozen=True)
class TableRow:
    """A row of a table of structures.

    Parameters
    ----------
    table : StructureTable
        The table.
    place : int
        Index of the row, from 0.
    """

    table: StructureTable
    place: int

    @property
    def row(self) -> Row:
        """Cells of the row."""
        return self.table.sheet.rows[self.place]

    @property
    def line(self) -> int:
        """Line number in the file at which the row begins."""
        return self.row.line

    @property
    def name(self) -> str:
        """Name of the structure, whether or not it can be used."""
        return one_line(self.table.text(self.row, "name")) or f"row {self.place + 1}"

    def make(self) -> Mechanism:
        """Build the structure of the row.

        Raises
        ------
        InputError
            With every problem of the row: the file, its line, and the heading of the column.
        MechanismError
            If the mechanism's plugin cannot be used.
        """
        table, row = self.table, self.row
        document = _RowDocument("structure", table.sheet.file, [], line=row.line, base=table.base_of(row))
        document.separator = table.sheet.separator
        document.values[()] = document.values[(MECHANISM_COLUMN,)] = document.mark
        if row.too_many is not None:
            what = f"has more cells than headings; the first extra cell is {cut(one_line(row.too_many))!r}"
            raise InputError(document.problem(what, None, hint="is a separator in a cell without quotes?"))
        based = table.base_of(row)
        folder, default = table.folder, self.name
        if based:
            document.data = deepcopy(self._read(based, _data_in, document, FILE_COLUMN))
            folder = (table.folder / based).parent
            default = one_line(Path(based).stem) or default
        elif starts := table.starter_of(row):
            document.data, document.base = deepcopy(table.kept(starts, _starter)), starts
        cls = self._class_in(document)
        self._fill(document, [each for each in table.fields if not based or each.english != (FILE_COLUMN,)], cls)
        if MECHANISM_COLUMN not in document.data and not based and (file := table.text(row, FILE_COLUMN)):
            what = f"{cut(one_line(file))!r} is not a structure file: its name must end in .yaml or .yml"
            document.problems.append(document.problem(what, None, FILE_COLUMN, "or give the mechanism of the row"))
        document.check()
        document.data = closed(document.data)
        return of_document(document, default, folder, table.registry)

    @property
    def of_floor(self) -> list[FieldColumn]:
        """Columns of the floor in which the row has a cell."""
        return [column for column in self.table.of_floor if self.row.cells[column.place]]

    def site(self, usual: SiteFile | None) -> SiteFile:
        """Return the site of the row, on its floor; `usual` is that of rows that name none.

        Raises
        ------
        InputError
            If there is no site, or its file or a cell of the floor is wrong: the table, its line and the heading.
        """
        table = self.table
        document = _RowDocument("site", table.sheet.file, [], line=self.line, separator=table.sheet.separator)
        file = table.text(self.row, SITE_COLUMN)
        site = self._read(file, read_site, document, SITE_COLUMN) if file else usual
        if site is None:
            hint = f"fill it in, or give {named('site')} for the rows without one"
            raise InputError(document.problem("is empty", None, table.by_word[SITE_COLUMN].heading, hint))
        if not self.of_floor:
            return site
        document.base, document.data = Path(site.document.file).name, deepcopy(site.document.data)
        self._fill(document, self.of_floor, type(site.site))
        document.check()
        floor, heading = document.data[FLOOR], self.of_floor[0].heading
        if isinstance(floor, dict):
            floor = {**(site.document.data.get(FLOOR) or {}), **floor}
            with suppress(UnitError):  # reported with the other fields
                floor = GROUND if number_of(floor.get("z"), "m") == 0 else floor
            document.values = {(FLOOR, name): document.mark for name in floor}
        elif floor != GROUND:
            what = f"must be {GROUND} or fields such as {{z: 6 m}}, got {cut(repr(floor))}"
            raise InputError(document.problem(what, None, heading, "or give the height in a column z"))
        document.data[FLOOR] = None if floor == GROUND else floor
        fields = fields_at(type(site.site), (FLOOR,)).items()
        lacks = [name for name, info in fields if info.is_required() and floor != GROUND and name not in floor]
        if lacks:
            what = f"needs the building, of which {document.base} lacks {', '.join(lacks)}"
            hint = f"add `{FLOOR}: {{{', '.join(f'{name}: ...' for name in lacks)}}}` to it"
            raise InputError(document.problem(what, None, heading, hint))
        on_floor = site_in(document, Path(site.document.file).parent)
        return replace(on_floor, document=replace(site.document, data=document.data), changed=True)

    def _read(self, file: str, read: Callable[[Path], T], document: _RowDocument, column: str) -> T:
        try:
            return self.table.kept(file, read)
        except InputError as error:
            first = error.problems[0]
            line = f"{first.line}: " if first.line is not None else ""
            message = f"{cut(one_line(file))}: {line}{Problem(first.message, field=first.field)}"
            raise InputError(document.problem(message, None, self.table.by_word[column].heading, first.hint)) from None

    def _class_in(self, document: _RowDocument) -> type[Mechanism] | None:
        """Return the mechanism of the row, also to its document; None if it is unknown, which is reported later."""
        mechanism = self.table.text(self.row, MECHANISM_COLUMN)
        if mechanism and not self.table.starter_of(self.row):
            document.data[MECHANISM_COLUMN] = mechanism
        return self.table.registry.get(str(document.data.get(MECHANISM_COLUMN)))

    def _fill(self, document: _RowDocument, columns: Sequence[FieldColumn], cls: type[BaseModel] | None) -> None:
        """Write the non-empty cells to the fields of a document; add problems for those that cannot be written."""
        for column in columns:
            text = self.row.cells[column.place]
            if not text:
                continue
            try:
                place = put(document.data, column.of(cls), None, is_list=partial(_is_list, cls))
                if place in document.columns:
                    hint = "leave one of the two cells empty"
                    raise InputError(Problem(f"is the same field as {document.columns[place]}", hint=hint))
                value = _value(text, column, _types(cls, place), decimal_comma=self.table.sheet.decimal_comma)
                replace_at(document.data, place, value)
                document.columns[place] = column.heading
            except InputError as error:
                problems = error.problems
                document.problems += [document.problem(one.message, None, column.heading, one.hint) for one in problems]


def _starter(path: Path) -> dict[str, Any]:
    """Return the data of a starter, by its name."""
    return parse(starter(path.name), path.name, "structure", TEMPLATE_HINT).data


def _data_in(path: Path) -> dict[str, Any]:
    """Return the data of the YAML file of a structure. Raises `InputError` if it cannot be read."""
    document = parse(read_text(path, "structure"), str(path), "structure", TEMPLATE_HINT)
    document.check()
    return document.data


@cache
def _is_list(cls: type[BaseModel] | None, place: Place) -> bool:
    return cls is not None and lists_models(cls, place)


@cache
def _types(cls: type[BaseModel] | None, place: Place) -> frozenset[Any]:
    return frozenset(types_at(cls, place)) if cls is not None else frozenset()


def _value(text: str, column: FieldColumn, types: frozenset[Any], *, decimal_comma: bool) -> Any:
    """Read a cell: a number, a list of numbers, or a text; texts with units are converted later, at the field."""
    if str in types and not types & {float, int}:
        return text
    if text[0] in "[{" and not (decimal_comma and ";" in text):
        value: Any = parse(f"cell: {text}", "cell", "cell", "").data["cell"]
        return _with_unit(value, column.unit)
    if ";" in text:
        return [_one(part.strip(), column, decimal_comma=decimal_comma) for part in text.strip("[]").split(";")]
    return _one(text, column, decimal_comma=decimal_comma)


def _one(text: str, column: FieldColumn, *, decimal_comma: bool) -> Any:
    if decimal_comma and THOUSANDS.fullmatch(text):
        hint = "write numbers without thousands separators"
        what = "is ambiguous, because other cells use decimal commas: the point may separate decimals or thousands"
        raise InputError(Problem(f"{text} {what}", hint=hint))
    if decimal_comma and DECIMAL_COMMA.fullmatch(text):
        text = text.replace(",", ".")
    if len(text.lstrip("+-")) > MAX_DIGITS and text.lstrip("+-").isdecimal():
        raise InputError(Problem(f"a number of {len(text.lstrip('+-'))} digits is beyond the range of numbers"))
    if NUMBER.fullmatch(text):
        return _with_unit(float(text) if re.search(r"[.eE]", text) else int(text), column.unit)
    return {"true": True, "false": False}.get(text.lower(), text)


def _with_unit(value: Any, unit: str) -> Any:
    """Return a number as text with the unit of its heading, if the heading has one; lists entry by entry."""
    if isinstance(value, list):
        return [_with_unit(each, unit) for each in value]
    return f"{value} {unit}" if unit and isinstance(value, int | float) and not isinstance(value, bool) else value


def table_of(given: str | Path | Mapping[str, Sequence[Any]], floor: Floor | None) -> StructureTable | Inventory:
    """Return the structures of a table, from its file or its columns, or the objects of a list.

    Parameters
    ----------
    given : str, Path or mapping
        The file, or columns such as a frame of pandas; empty texts, None and NaN are cells not given.
    floor : Floor, optional
        The floor to which motions are carried.

    Raises
    ------
    InputError
        If it cannot be used.
    """
    if isinstance(given, str | Path):
        sheet, folder = sheet_of(given), Path(given).parent
    else:
        sheet, folder = _of_columns(given), Path()
    names = {italian()["fields"].get(each.lower(), each.lower()): k for k, each in enumerate(sheet.headings)}
    files = (row.cells[names[FILE_COLUMN]] for row in sheet.rows) if FILE_COLUMN in names else ()
    describes = MECHANISM_COLUMN in names or any(each.lower().endswith(YAML_SUFFIXES) for each in files)
    return StructureTable(sheet, folder) if describes or not is_inventory(sheet) else Inventory(sheet, floor)


def _of_columns(columns: Mapping[str, Sequence[Any]]) -> Spreadsheet:
    """Return the table of columns."""
    headings = tuple(str(each).strip() for each in columns)
    cells = [[_text(value) for value in columns[key]] for key in columns]
    if len({len(each) for each in cells}) > 1:
        raise InputError("the columns of a table must have the same length")
    rows = tuple(Row(k + 1, tuple(row)) for k, row in enumerate(zip(*cells, strict=True)))
    return Spreadsheet("table", 0, headings, rows, decimal_comma=False)


def _text(value: Any) -> str:
    if value is None or value != value:
        return ""
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_text, value))}]"
    return str(value).strip()


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
    return COORDINATES.get(italian()["fields"].get(name, name)) if unit in DEGREES else None


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

"""Views of the installed mechanisms, of the fields of one, and of the checks of its contract, as text and as data."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from operator import itemgetter
from typing import Any, NamedTuple

from pydantic import BaseModel
from pydantic_core import PydanticUndefined, to_jsonable_python

from rocking_cli.core import Mechanism
from rocking_cli.core.hung.element import Interlock, Load
from rocking_cli.core.hung.ties import AnchorPlate, BearingWall, Face, Place, Tie
from rocking_cli.core.registry import Verdict
from rocking_cli.core.structure_fields import Crushing, Stop, Strength, Uncertainty
from rocking_cli.io import starters
from rocking_cli.io.yaml_file import block, in_a_line, is_deep
from rocking_cli.units import units_of
from rocking_cli.verification.code import Code, Site
from rocking_cli.views.column import Column, data_of, of, only_shown, table_of
from rocking_cli.views.view import Table, View

BOUNDS = (
    ("gt", ">"),
    ("ge", ">="),
    ("lt", "<"),
    ("le", "<="),
    ("min_length", "entries >="),
    ("max_length", "entries <="),
)
MAX_INLINE_LENGTH = 40  # characters of a field and its value; a longer one has its comment on the line above
UNITS_NOTE = "A number without a unit is in the unit in brackets; 800 mm, 12 ft or 19 kN/m3 is also accepted."
SITE_UNITS_NOTE = "Numbers are in the unit in brackets."


COLUMNS: tuple[Column[Mapping[str, Any]], ...] = (
    only_shown("field", itemgetter("field"), text=True),
    only_shown("symbol", itemgetter("symbol"), text=True, rank=1),
    only_shown("unit", itemgetter("unit"), text=True),
    only_shown("bounds", itemgetter("bounds"), text=True, rank=2),
    only_shown("default", lambda row: "required" if row["required"] else row["default"], str, text=True),
    only_shown("meaning", itemgetter("description"), text=True),
)
"""Columns of the table of the fields of a structure file; a row is the plain data of one field."""


class InstalledMechanism(NamedTuple):
    """An installed mechanism: name, title and structures that it suits (None if it cannot be loaded), and package."""

    name: str
    title: str | None
    suits: str | None
    package: str

    @property
    def meant_for(self) -> str:
        """Structures that it suits, or its title."""
        return self.suits or self.title or "(cannot be loaded)"


INSTALLED: tuple[Column[InstalledMechanism], ...] = (
    Column("name", of("name"), head="mechanism", text=True),
    Column("title", of("title")),
    Column("suits", of("suits")),
    only_shown("structures", of("meant_for"), text=True),
    Column("package", of("package"), head="package", text=True, rank=1),
)
CHECKS: tuple[Column[Verdict], ...] = (
    Column("check", of("check")),
    Column("meaning", of("meaning")),
    Column("passed", of("passed")),
    Column("why", of("why")),
    Column("traceback", of("trace")),
)


def installed(found: Sequence[InstalledMechanism]) -> View:
    """Show the installed mechanisms."""
    return View(
        {"mechanisms": [data_of(INSTALLED, each) for each in found]},
        [
            table_of("Mechanisms", INSTALLED, found),
            "Next: `rocking new NAME > structure.yaml` prints a file to start from, and `rocking draw structure.yaml` "
            "draws it. `rocking mechanisms NAME` lists the fields of a mechanism. If none fits, list blocks in an "
            "`assembly`, or bodies and joints in a `linkage`. Loads, ties, supports, strengths and uncertainties can "
            "be added to any mechanism: see `rocking mechanisms loads`, `ties`, `stops`, `interlock`, `crushing`, "
            "`strength`, `uncertainty`.",
        ],
    )


def view(cls: type[Mechanism], package: str) -> View:
    """Show a mechanism with the fields of its file."""
    rows = fields(cls)
    data = {
        "mechanism": cls.mechanism,
        "title": cls.title,
        "package": package,
        "source": cls.source,
        "verified": cls.verified,
        "caution": cls.caution or None,
        "fields": rows,
    }
    kinds = dict.fromkeys(tuple(row["units"]) for row in rows if len(row["units"]) > 1)
    taken = "; ".join(", ".join(units) for units in kinds)
    parts: list[Table | str] = [
        table_of(f"{cls.mechanism}: {cls.title}", COLUMNS, rows),
        f"A number without a unit is in the unit of its field. Accepted units, as in 800 mm: {taken}.",
        f"package:  {package}\nsource:   {cls.source}\nverified: {cls.verified or 'not yet'}"
        + (f"\ncaution:  {cls.caution}" if cls.caution else ""),
    ]
    return View(data, parts)


PARTS: dict[str, tuple[str, dict[str, type[BaseModel]]]] = {
    "loads": ("a load, one of the list `loads` of any mechanism", {"": Load}),
    "ties": (
        "a tie, one of the list `ties` of any mechanism",
        {"": Tie, "from, to, path": Place, "bed": Face, "plate": AnchorPlate, "wall": BearingWall},
    ),
    "stops": ("a wall that it meets, one of the list `stops` of any mechanism", {"": Stop}),
    "crushing": ("the strength of pivots, `crushing` of single bodies and walls", {"": Crushing}),
    "interlock": ("the friction of crossing walls, `interlock` of any mechanism", {"": Interlock}),
    "strength": ("the strength of contacts, `strength` of any mechanism", {"": Strength}),
    "uncertainty": ("how well a structure is known, `uncertainty` of any mechanism", {"": Uncertainty}),
}
"""Additions available for every mechanism, by field."""


def part(name: str) -> View:
    """Show the fields of an addition to any mechanism, one of `PARTS`."""
    title, models = PARTS[name]
    tables: list[Table | str] = []
    data: dict[str, Any] = {"part": name, "title": title, "fields": {}}
    for where, model in models.items():
        rows = fields(model)
        data["fields"][where or name] = rows
        tables += [table_of(f"{name}: {title}" if not where else f"{where}: {model.__doc__}", COLUMNS, rows)]
    for kind in Tie.kinds() if name == "ties" else ():
        rows = [row for row in fields(kind, Tie) if not row["common"] and row["field"] != "law"]
        where = f"law: {kind.model_fields['law'].default}"
        data["fields"][where] = rows
        tables += [table_of(f"{where}: {kind.__doc__}", COLUMNS, rows)]
    return View(data, tables)


def fields(cls: type[BaseModel], common: type[BaseModel] = Mechanism) -> list[dict[str, Any]]:
    """Return the fields of a file with unit, symbol, bounds, default and description; common fields last."""
    rows = []
    for key, info in cls.model_fields.items():
        extra = info.json_schema_extra if isinstance(info.json_schema_extra, dict) else {}
        bounds = [
            f"{sign} {getattr(rule, attribute):g}"
            for attribute, sign in BOUNDS
            for rule in info.metadata
            if hasattr(rule, attribute)
        ]
        # Common are fields of the base class that this class does not define again.
        classes = cls.__mro__[: cls.__mro__.index(common)] if issubclass(cls, common) else [cls]
        rows.append(
            {
                "field": info.alias or key,
                "unit": extra.get("unit", ""),
                "units": list(units_of(str(extra.get("unit", "")))),
                "symbol": extra.get("symbol", ""),
                "bounds": ", ".join(bounds),
                "required": info.is_required(),
                "default": None if info.default is PydanticUndefined else info.default,
                "example": info.examples[0] if info.examples else None,
                "description": info.description or "",
                "common": not any(key in vars(each).get("__annotations__", {}) for each in classes),
            }
        )
    return sorted(rows, key=lambda row: row["common"])


def checked(name: str, package: str, file: str | None, verdicts: Sequence[Verdict]) -> View:
    """Show which checks of the contract a mechanism passes, for a structure in a file or for its examples."""
    data = {
        "mechanism": name,
        "package": package,
        "file": file,
        "passed": all(each.passed for each in verdicts),
        "checks": [data_of(CHECKS, each) for each in verdicts],
    }
    return View(data, list(_told(verdicts)))


def _told(verdicts: Sequence[Verdict]) -> Iterator[str]:
    """Yield a line for each check, with the traceback of an error in the plugin; each error appears once."""
    told: set[str] = set()
    for each in verdicts:
        if each.why is None:
            yield f"passes  {each.meaning}"
        elif each.why in told:
            yield f"FAILS   {each.meaning} Same error as above."
        else:
            told.add(each.why)
            yield f"FAILS   {each.meaning} {_in_a_line(each.why)}"
            if each.trace is not None:
                yield each.trace


def _in_a_line(why: str) -> str:
    """Return an error in one line, without the lines that it quotes."""
    return "; ".join(line.strip() for line in why.splitlines() if not line.startswith("    "))


def template(cls: Any) -> str:
    """Return a commented YAML file for a mechanism: its examples, with optional fields commented out.

    A required field without an example has no value, and a comment in the file states this.

    Parameters
    ----------
    cls : type of Mechanism
        The mechanism; its class attribute `starter` names the optional fields that its file needs.

    Returns
    -------
    str
    """
    usual = {"name": f"my {cls.mechanism.replace('_', ' ')}", "restitution": "0.9"}
    lines, missing = _lines(fields(cls), usual, cls.starter)
    fill_in = [f"# Fill in {', '.join(missing)}: the mechanism gives no example."] if missing else []
    head = [f"# {cls.title}", f"# {cls.source}", *fill_in, f"# {UNITS_NOTE}", f"mechanism: {cls.mechanism}"]
    return "\n".join([*head, *lines]) + "\n"


def starter(code: Code, commands: Sequence[str] = ()) -> str:
    """Return a commented site file for a code of practice: its own, or one made from its fields like `template`.

    Parameters
    ----------
    code : Code
        The code.
    commands : sequence of str
        The commands that print the file and use it.

    Returns
    -------
    str
    """
    if code.starter:
        return code.starter
    rows = [row for row in fields(code.site, Site) if row["field"] != "code"]
    rows.sort(key=lambda row: row["field"] != "name")
    empty = {row["field"]: "" for row in rows if not row["required"] and row["example"] is None is row["default"]}
    lines, missing = _lines(rows, {**empty, "name": "my site"})
    fill_in = [f"# Fill in {', '.join(missing)}: the code gives no example."] if missing else []
    head = [f"# A site, to verify a structure by the {' '.join(f'{code.name} ({code.edition})'.split())}."]
    head += [f"#   {each}" for each in commands]
    return "\n".join([*head, *fill_in, f"# {SITE_UNITS_NOTE}", f"code: {in_a_line(code.key)}", *lines]) + "\n"


def comments(cls: Any, code: Code | None) -> frozenset[str]:
    """Return the lines that are comments in the templates of a mechanism, of common structures and of a site."""
    texts = [template(cls), *map(starters.starter, starters.STARTERS), *([] if code is None else [starter(code)])]
    both = [each for text in texts for each in (text, starters.in_italian(text)[0])]
    return frozenset(line for text in both for line in text.splitlines() if line.startswith("#"))


def _lines(
    rows: Sequence[Mapping[str, Any]], usual: Mapping[str, str], needed: Collection[str] = ()
) -> tuple[list[str], list[str]]:
    """Return the lines of some fields, and those of the fields that are needed but have no example.

    Parameters
    ----------
    rows : sequence of mapping
        The fields.
    usual : mapping of str to str
        Values that replace the examples of some fields.
    needed : collection of str
        Optional fields that the file needs.
    """
    lines: list[str] = []
    missing = []
    for row in rows:
        unit = f" [{row['unit']}]" if row["unit"] else ""
        symbol = f", {row['symbol']}" if row["symbol"] else ""
        limits = f" ({row['bounds']})" if row["bounds"] else ""
        used = row["required"] or row["field"] in needed
        value = _plain(row["example"] if row["example"] is not None else row["default"])
        example = usual.get(row["field"], in_a_line(value))
        if used and row["field"] not in usual and row["example"] is None and row["default"] is None:
            missing.append(row["field"])
            example = ""
        entry = f"{'' if used else '# '}{row['field']}: {example}"
        fill_in = "fill in: " if row["field"] in missing else ""
        comment = f"# {fill_in}{' '.join(row['description'].split())}{symbol}{unit}{limits}"
        if is_deep(value):
            lines += [comment, *(f"{'' if used else '# '}{line}" for line in block(row["field"], value))]
            continue
        lines += [f"{entry:<32}  {comment}"] if len(entry) <= MAX_INLINE_LENGTH else [comment, entry]
    return lines, missing


def _plain(value: Any) -> Any:
    """Return a value as plain data, without what is not given."""
    return to_jsonable_python(value, exclude_none=True, by_alias=False, fallback=str)

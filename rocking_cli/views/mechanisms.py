"""Views of the installed mechanisms, of the fields of one, and of the checks of its contract, as text and as data."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from operator import itemgetter
from typing import Any, NamedTuple

from pydantic import BaseModel
from pydantic_core import PydanticUndefined

from rocking_cli.core import Mechanism
from rocking_cli.core.hung.element import Interlock, Load
from rocking_cli.core.hung.ties import AnchorPlate, BearingWall, Face, Place, Tie
from rocking_cli.core.registry import Verdict
from rocking_cli.core.structure_fields import Crushing, Stop, Strength, Uncertainty
from rocking_cli.units import units_of
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


def _default(row: Mapping[str, Any]) -> str | None:
    return "required" if row["required"] else None if row["default"] is None else str(row["default"])


COLUMNS: tuple[Column[Mapping[str, Any]], ...] = (
    only_shown("field", itemgetter("field"), text=True),
    only_shown("symbol", itemgetter("symbol"), text=True),
    only_shown("unit", itemgetter("unit"), text=True),
    only_shown("bounds", itemgetter("bounds"), text=True),
    only_shown("default", _default, text=True),
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
    Column("package", of("package"), head="package", text=True),
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
                "common": _is_common(cls, key, common),
            }
        )
    return sorted(rows, key=lambda row: row["common"])


def _is_common(cls: type[BaseModel], key: str, common: type[BaseModel]) -> bool:
    """Return whether the base class has a field that this class does not define again."""
    classes = cls.__mro__[: cls.__mro__.index(common)] if issubclass(cls, common) else [cls]
    return not any(key in vars(each).get("__annotations__", {}) for each in classes)


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

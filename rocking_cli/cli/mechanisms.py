"""`rocking mechanisms`: what is installed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from rocking_cli.cli import options, terminal
from rocking_cli.views.view import ABSENT

if TYPE_CHECKING:
    from rocking_cli.core import Mechanism

BOUNDS = (
    ("gt", ">"),
    ("ge", ">="),
    ("lt", "<"),
    ("le", "<="),
    ("min_length", "entries >="),
    ("max_length", "entries <="),
)


@click.command(short_help="List the installed mechanisms, show the fields of one, or check it.")
@click.argument("name", required=False)
@click.argument("file", required=False, type=click.Path())
@click.option("--check", "checked", is_flag=True, help="Hold NAME to the contract: of its examples, or of FILE.")
@options.as_json
def command(name: str | None, file: str | None, checked: bool, as_json: bool) -> None:
    """List the mechanisms that are installed and the package each comes from; with NAME, its fields.

    `--check` holds what a mechanism says to its bodies and their motion, prints what passes and what fails with the
    traceback of an error of its own, and ends with 3 if anything fails. FILE is a structure to check it on.

    \b
    Example:
      rocking mechanisms
      rocking mechanisms arch
      rocking mechanisms --check arch
    """
    from rocking_cli.core.registry import Registry

    if checked and name is None:
        raise click.UsageError("--check needs the NAME of a mechanism.")
    if file is not None and not checked:
        raise click.UsageError("FILE goes with --check.")
    registry = Registry()
    if name is not None and checked:
        from rocking_cli.cli.mechanism_check import check

        check(name, file, registry, as_json)
    elif name is not None:
        _one(registry[name], registry.package_of(name), as_json)
    else:
        _all(registry, as_json)


def _all(registry: Any, as_json: bool) -> None:
    from rocking_cli.errors import MechanismError

    rows = []
    for name in registry:
        try:
            title = registry[name].title
        except MechanismError as error:  # one broken plugin must not hide the others
            terminal.warning(str(error))
            terminal.plugin_traceback(error)
            title = None
        rows.append({"name": name, "title": title, "package": registry.package_of(name)})
    if as_json:
        terminal.print_json({"mechanisms": rows})
        return
    cells = [[row["name"], row["title"] or "(cannot be loaded)", row["package"]] for row in rows]
    terminal.table("Mechanisms", ["mechanism", "what it is", "package"], cells)
    terminal.result(
        "`rocking mechanisms NAME` lists the fields of one, `rocking new NAME` prints a file to start from."
    )


def fields(cls: type[Mechanism]) -> list[dict[str, Any]]:
    """The fields of a mechanism's file: name, unit, symbol, bounds, default, description; its own before the common."""
    from pydantic_core import PydanticUndefined

    from rocking_cli.core import Mechanism
    from rocking_cli.units import units_of

    found = []
    for key, info in cls.model_fields.items():
        extra = info.json_schema_extra if isinstance(info.json_schema_extra, dict) else {}
        bounds = [
            f"{sign} {getattr(rule, attribute):g}"
            for attribute, sign in BOUNDS
            for rule in info.metadata
            if hasattr(rule, attribute)
        ]
        found.append(
            {
                "field": key,
                "unit": extra.get("unit", ""),
                "units": list(units_of(str(extra.get("unit", "")))),
                "symbol": extra.get("symbol", ""),
                "bounds": ", ".join(bounds),
                "required": info.is_required(),
                "default": None if info.default is PydanticUndefined else info.default,
                "example": info.examples[0] if info.examples else None,
                "description": info.description or "",
                "common": key in Mechanism.model_fields,
            }
        )
    return sorted(found, key=lambda row: row["common"])


def _one(cls: type[Mechanism], package: str, as_json: bool) -> None:
    rows = fields(cls)
    facts = {
        "mechanism": cls.mechanism,
        "title": cls.title,
        "package": package,
        "source": cls.source,
        "verified": cls.verified,
        "caution": cls.caution or None,
    }
    if as_json:
        terminal.print_json({**facts, "fields": rows})
        return
    cells = [
        [
            row["field"],
            row["symbol"],
            row["unit"],
            row["bounds"],
            "required" if row["required"] else ABSENT if row["default"] is None else str(row["default"]),
            row["description"],
        ]
        for row in rows
    ]
    terminal.table(
        f"{cls.mechanism}: {cls.title}",
        ["field", "symbol", "unit", "bounds", "default", "meaning"],
        cells,
        explained=True,
    )
    kinds = dict.fromkeys(tuple(row["units"]) for row in rows if len(row["units"]) > 1)
    taken = "; ".join(", ".join(units) for units in kinds)
    terminal.result(f"A bare number is in the unit of its field; taken with their unit, as in 800 mm: {taken}.")
    terminal.result(f"package:  {package}\nsource:   {cls.source}\nverified: {cls.verified or 'by nobody yet'}")
    if cls.caution:
        terminal.result(f"caution:  {cls.caution}")

"""Template files: a structure of any mechanism, and a site for any code of practice."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any

from pydantic_core import to_jsonable_python

from rocking_cli.io import starters
from rocking_cli.io.yaml_file import block, in_a_line, is_deep
from rocking_cli.verification.code import Code, Site
from rocking_cli.views.mechanisms import fields

MAX_INLINE_LENGTH = 40  # characters of a field and its value; a longer one has its comment on the line above
UNITS_NOTE = "A number without a unit is in the unit in brackets; 800 mm, 12 ft or 19 kN/m3 is also accepted."
SITE_UNITS_NOTE = "Numbers are in the unit in brackets."


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
    head = [f"# A site, to verify a structure by the {_in_a_line(f'{code.name} ({code.edition})')}."]
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
        value = row["example"] if row["example"] is not None else row["default"]
        value = to_jsonable_python(value, exclude_none=True, by_alias=False, fallback=str)
        example = usual.get(row["field"], in_a_line(value))
        if used and row["field"] not in usual and row["example"] is None and row["default"] is None:
            missing.append(row["field"])
            example = ""
        entry = f"{'' if used else '# '}{row['field']}: {example}"
        fill_in = "fill in: " if row["field"] in missing else ""
        comment = f"# {fill_in}{_in_a_line(row['description'])}{symbol}{unit}{limits}"
        if is_deep(value):
            lines += [comment, *(f"{'' if used else '# '}{line}" for line in block(row["field"], value))]
            continue
        lines += [f"{entry:<32}  {comment}"] if len(entry) <= MAX_INLINE_LENGTH else [comment, entry]
    return lines, missing


def _in_a_line(text: str) -> str:
    return " ".join(text.split())

"""A structure file to start from, of any mechanism."""

from __future__ import annotations

from typing import Any

from rocking_cli.views.mechanisms import fields

LONG = 40  # characters of a field and its value, above which the comment stands
UNITS = "A number without a unit is in the unit in brackets; 800 mm or 12 ft is also accepted."


def template(cls: Any) -> str:
    """A commented YAML file for a mechanism: its examples, with fields that may be left out commented out.

    A field that the file needs and of which there is no example stands there without a value, and the file says so.

    Parameters
    ----------
    cls : type of Mechanism
        The mechanism; its class attribute `starter` names the optional fields that its file needs.

    Returns
    -------
    str
    """
    lines = [f"# {cls.title}", f"# {cls.source}", f"# {UNITS}", f"mechanism: {cls.mechanism}"]
    missing = []
    for row in fields(cls):
        unit = f" [{row['unit']}]" if row["unit"] else ""
        symbol = f", {row['symbol']}" if row["symbol"] else ""
        limits = f" ({row['bounds']})" if row["bounds"] else ""
        used = row["required"] or row["field"] in cls.starter
        value = row["example"] if row["example"] is not None else row["default"]
        example = _yaml(value)
        if row["field"] == "name":
            example = f"my {cls.mechanism.replace('_', ' ')}"
        elif row["field"] == "restitution":
            example = "0.9"
        elif used and row["example"] is None and row["default"] is None:
            missing.append(row["field"])
            example = ""
        entry = f"{'' if used else '# '}{row['field']}: {example}"
        fill_in = "fill in: " if row["field"] in missing else ""
        comment = f"# {fill_in}{row['description']}{symbol}{unit}{limits}"
        if _is_deep(value):
            lines += [comment, *(f"{'' if used else '# '}{line}" for line in _block(row["field"], value))]
            continue
        lines += [f"{entry:<32}  {comment}"] if len(entry) <= LONG else [comment, entry]
    if missing:
        lines.insert(2, f"# Fill in {', '.join(missing)}: the mechanism gives no example.")
    return "\n".join(lines) + "\n"


def _is_deep(value: Any) -> bool:
    """Whether it is a mapping that has mappings in it, which on one line nobody reads."""
    return isinstance(value, dict) and any(isinstance(each, dict) for each in value.values())


def _block(key: str, value: Any) -> list[str]:
    """A field over several lines, down to mappings that fit on one."""
    if not _is_deep(value):
        return [f"{key}: {_yaml(value)}"]
    return [f"{key}:", *(f"  {line}" for name, each in value.items() for line in _block(name, each))]


def _yaml(value: Any) -> str:
    if isinstance(value, list):
        return f"[{', '.join(_yaml(item) for item in value)}]"
    if isinstance(value, dict):
        return f"{{{', '.join(f'{key}: {_yaml(item)}' for key, item in value.items())}}}"
    return str(value)

"""`rocking new`: a structure file to start from."""

from __future__ import annotations

from typing import Any

import click

from rocking_cli.cli import options, terminal


@click.command(short_help="Print a commented structure file that works as it is.")
@click.argument("name")
@options.as_json
def command(name: str, as_json: bool) -> None:
    """Print a commented structure file of the mechanism NAME that works as it is.

    \b
    Example:
      rocking new arch > arch.yaml
    """
    from rocking_cli.registry import Registry

    cls = Registry()[name]
    text = template(cls)
    if as_json:
        terminal.print_json({"mechanism": name, "yaml": text})
    else:
        terminal.result(text.rstrip("\n"))


def template(cls: Any) -> str:
    """A commented YAML file for a mechanism: its examples, with fields that may be left out commented out.

    Parameters
    ----------
    cls : type of Mechanism
        The mechanism; its class attribute `starter` names the optional fields that its file needs.

    Returns
    -------
    str
    """
    from rocking_cli.cli.mechanisms import fields

    lines = [f"# {cls.title}", f"# {cls.source}", f"mechanism: {cls.mechanism}"]
    for row in fields(cls):
        unit = f" [{row['unit']}]" if row["unit"] else ""
        symbol = f", {row['symbol']}" if row["symbol"] else ""
        limits = f" ({row['bounds']})" if row["bounds"] else ""
        used = row["required"] or row["field"] in cls.starter
        example = _yaml(row["example"] if row["example"] is not None else row["default"])
        if row["field"] == "name":
            example = f"my {cls.mechanism.replace('_', ' ')}"
        elif row["field"] == "restitution":
            example = "0.9"
        entry = f"{'' if used else '# '}{row['field']}: {example}"
        lines.append(f"{entry:<32}  # {row['description']}{symbol}{unit}{limits}")
    return "\n".join(lines) + "\n"


def _yaml(value: Any) -> str:
    if isinstance(value, list):
        return f"[{', '.join(_yaml(item) for item in value)}]"
    return str(value)

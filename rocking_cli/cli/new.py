"""`rocking new`: a structure file to start from."""

from __future__ import annotations

from difflib import get_close_matches
from importlib.resources import files
from typing import Any

import click

from rocking_cli.cli import complete, options, terminal

STARTERS = ("facade", "parapet", "gable", "pinnacle", "corner", "bell_cell", "column_with_tendon", "statue")
"""What people have, each a file in the data of the package. A mechanism that a package calls so comes first."""
STUDY = "study"
"""Not a mechanism: a study file is printed for it. A mechanism that a package calls so works, and is not printed."""
SITE = "site"
"""Nor is this: a site file for `rocking verify`."""
LONG = 40  # characters of a field and its value, above which the comment stands
UNITS = "A bare number is in the unit in brackets; 800 mm or 12 ft are read too."


@click.command(short_help="Print a commented structure file, study or site, that works as it is.")
@click.argument("name", shell_complete=complete.mechanisms(STUDY, SITE, *STARTERS))
@options.as_json
def command(name: str, as_json: bool) -> None:
    """Print a commented structure file that works as it is: of the mechanism NAME, or of what people have.

    These are facade, parapet, gable, pinnacle, corner, bell_cell, column_with_tendon and statue. `study` is a fragility
    study, of block.yaml beside it, and `site` a site for `rocking verify`.

    \b
    Example:
      rocking new arch > arch.yaml
      rocking new facade > facade.yaml
      rocking new study > study.yaml
      rocking new site > site.yaml
    """
    if name == STUDY:
        from rocking_cli.cli.new_study import TEMPLATE

        _print({"study": STUDY, "yaml": TEMPLATE}, as_json=as_json)
        return
    if name == SITE:
        from rocking_cli.studies.verification.codes import codes
        from rocking_cli.studies.verification.site_file import USUAL

        _print({"site": USUAL, "yaml": codes()[USUAL].starter}, as_json=as_json)
        return
    from rocking_cli.core.registry import Registry
    from rocking_cli.errors import InputError, Problem, RockingError
    from rocking_cli.structure import parse_structure

    registry = Registry()
    if name in STARTERS and name not in registry:
        text = (files("rocking_cli") / "data" / "starters" / f"{name}.yaml").read_text(encoding="utf-8")
        _print({"starter": name, "yaml": text}, as_json=as_json)
        return
    if name not in registry and (near := get_close_matches(name, STARTERS, n=1)):
        raise InputError(Problem(f"there is no mechanism {name!r}", hint=f"did you mean {near[0]}?"))
    text = template(registry[name])
    try:
        parse_structure(text, f"rocking new {name}", name, registry)
    except RockingError as error:
        terminal.warning(
            f"the examples of the mechanism {name} make no structure, and this file does not work as it is"
        )
        terminal.note(str(error))
        terminal.debug_traceback(error)
    _print({"mechanism": name, "yaml": text}, as_json=as_json)


def _print(made: dict[str, str], *, as_json: bool) -> None:
    if as_json:
        terminal.print_json(made)
    else:
        terminal.result(made["yaml"].rstrip("\n"))


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
    from rocking_cli.views.mechanisms import fields

    lines = [f"# {cls.title}", f"# {cls.source}", f"# {UNITS}", f"mechanism: {cls.mechanism}"]
    missing = []
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
        elif used and row["example"] is None and row["default"] is None:
            missing.append(row["field"])
            example = ""
        entry = f"{'' if used else '# '}{row['field']}: {example}"
        fill_in = "fill in: " if row["field"] in missing else ""
        comment = f"# {fill_in}{row['description']}{symbol}{unit}{limits}"
        lines += [f"{entry:<32}  {comment}"] if len(entry) <= LONG else [comment, entry]
    if missing:
        lines.insert(2, f"# Fill in {', '.join(missing)}: the mechanism gives no example.")
    return "\n".join(lines) + "\n"


def _yaml(value: Any) -> str:
    if isinstance(value, list):
        return f"[{', '.join(_yaml(item) for item in value)}]"
    if isinstance(value, dict):
        return f"{{{', '.join(f'{key}: {_yaml(item)}' for key, item in value.items())}}}"
    return str(value)

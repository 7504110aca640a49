"""`rocking new`: print a template, or create a plugin package."""

from __future__ import annotations

from collections.abc import Mapping
from difflib import get_close_matches
from importlib.resources import files
from typing import Any

import click

from rocking_cli.cli import complete, options, terminal

STARTERS = ("facade", "parapet", "gable", "pinnacle", "corner", "bell_cell", "column_with_tendon", "statue")
"""Common structures, each a file in the data of the package. A mechanism of the same name has priority."""
STUDY = "study"
"""Name of the study file. A mechanism of the same name works, but is not printed."""
SITE = "site"
"""Name of the site file for `rocking verify`."""


@click.command(short_help="Print a template file, or create a plugin package.")
@click.argument(
    "name",
    metavar="NAME",
    required=False,
    shell_complete=complete.plugins(complete.MECHANISMS, STUDY, SITE, *STARTERS),
)
@click.option("--plugin", is_flag=True, help="Create a package for a mechanism of your own, called NAME.")
@click.option(
    "--code",
    is_flag=False,
    flag_value="",
    metavar="[CODE]",
    shell_complete=complete.codes,
    help="With `site`: code of practice of the site file.  [default: NTC2018]  With --plugin, alone: create a package "
    "for a code of practice.",
)
@click.option(
    "-o",
    "--out",
    type=click.Path(),
    metavar="FOLDER",
    shell_complete=complete.files,
    help="New folder for the package.  [default: rocking-NAME, in this folder]",
)
@options.as_json
@click.pass_context
def command(
    ctx: click.Context, name: str | None, plugin: bool, code: str | None, out: str | None, as_json: bool
) -> None:
    """Print a commented template: a working structure file of the mechanism NAME, or a common structure.

    The common structures are facade, parapet, gable, pinnacle, corner, bell_cell, column_with_tendon and statue.
    `study` is a fragility study of a block.yaml in the same folder, and `site` a site file for `rocking verify`: of the
    Italian code, or with --code CODE of any installed code of practice.

    With --plugin, the command writes a package for a mechanism of your own, called NAME: a working mechanism with
    comments for you to change, its tests, and a structure file. `pip install` makes it available like the
    built-in mechanisms. With --plugin and --code, it writes such a package for a code of practice of your own.

    \b
    Example:
      rocking new arch > arch.yaml
      rocking new facade > facade.yaml
      rocking new study > study.yaml
      rocking new site > site.yaml
      rocking new site --code NTC2018 > site.yaml
      rocking new --plugin leaning_pier
      rocking new --plugin my_code --code
    """
    if plugin and code and name is None:
        name, code = code, ""  # `--code NAME` is accepted, too
    if name is None:
        raise click.MissingParameter(ctx=ctx, param=next(each for each in ctx.command.params if each.name == "name"))
    if plugin:
        from rocking_cli.questions.new.new_plugin import CODE, MECHANISM, write

        if code not in (None, "", name):
            raise click.UsageError(f"--plugin creates one package: give one name, not {name} and {code}.")
        write(name, out, MECHANISM if code is None else CODE, printed=(STUDY, SITE, *STARTERS), as_json=as_json)
        return
    if out is not None:
        raise click.UsageError("--out requires --plugin: without it the file is printed; redirect it with > FILE.")
    if code is not None and name != SITE:
        raise click.UsageError("--code requires `site`, as in `rocking new site --code NTC2018`, or --plugin.")
    if name == STUDY:
        _print({"study": STUDY, "yaml": _starter(STUDY)}, as_json=as_json)
        return
    if name == SITE:
        _print_site(code, as_json=as_json)
        return
    from rocking_cli.core.registry import Registry
    from rocking_cli.core.structure_file import parse_structure
    from rocking_cli.errors import InputError, Problem, RockingError
    from rocking_cli.plugins.registry import find
    from rocking_cli.views.template import template

    registry = Registry()
    if name in STARTERS and name not in registry:
        _print({"starter": name, "yaml": _starter(name)}, as_json=as_json)
        return
    if name not in registry and name in find(complete.CODES):
        hint = f"`rocking new site --code {name}` prints a site file"
        raise InputError(Problem(f"{name} is a code of practice, not a mechanism", hint=hint))
    if name not in registry and (near := get_close_matches(name, STARTERS, n=1)):
        raise InputError(Problem(f"the mechanism {name!r} does not exist", hint=f"did you mean {near[0]}?"))
    text = template(registry[name])
    try:
        parse_structure(text, f"rocking new {name}", name, registry)
    except RockingError as error:
        _warn(f"the examples of the mechanism {name} are not a valid structure", error)
    _print({"mechanism": name, "yaml": text}, as_json=as_json)


def _starter(name: str) -> str:
    return (files("rocking_cli") / "data" / "starters" / f"{name}.yaml").read_text(encoding="utf-8")


def _print_site(asked: str | None, *, as_json: bool) -> None:
    """Print the site file of a code, by default the usual one, and in JSON the schema of its fields too."""
    from rocking_cli.errors import RockingError
    from rocking_cli.io.yaml_file import parse
    from rocking_cli.plugins.errors import blame
    from rocking_cli.questions.new.new_plugin import quoted
    from rocking_cli.verification.check import site_in
    from rocking_cli.verification.code import DEFAULT_CODE, SITE_HINT, codes
    from rocking_cli.views.template import starter

    key = DEFAULT_CODE if asked is None else asked
    code = codes()[key]
    getting = f"rocking new site --code {quoted(key)}"
    text = starter(code, [f"{getting} > site.yaml", "rocking verify block.yaml --site site.yaml"])
    try:
        site_in(parse(text, getting, "site", SITE_HINT))
    except RockingError as error:
        _warn(f"the examples of the code {key} are not a valid site", error)
    schema: dict[str, Any] = {}
    if as_json:
        with blame(f"the code {key} failed in the schema of its site", type(code).__module__):
            schema = code.site.model_json_schema()
    _print({"site": key, "yaml": text, "schema": schema}, as_json=as_json)


def _warn(what: str, error: Exception) -> None:
    """Warn that a file cannot be used before something is changed in it, and why."""
    terminal.warning(f"{what}: this file does not work as it is")
    terminal.note(str(error))
    terminal.debug_traceback(error)


def _print(made: Mapping[str, Any], *, as_json: bool) -> None:
    if as_json:
        terminal.print_json(made)
    else:
        terminal.result(made["yaml"].rstrip("\n"))

"""`rocking new`: print a template, or create a plugin package."""

from __future__ import annotations

from difflib import get_close_matches
from importlib.resources import files

import click

from rocking_cli.cli import complete, options, terminal

STARTERS = ("facade", "parapet", "gable", "pinnacle", "corner", "bell_cell", "column_with_tendon", "statue")
"""Common structures, each a file in the data of the package. A mechanism of the same name has priority."""
STUDY = "study"
"""Name of the study file. A mechanism of the same name works, but is not printed."""
SITE = "site"
"""Name of the site file for `rocking verify`."""


@click.command(short_help="Print a template file, or create a plugin package.")
@click.argument("name", shell_complete=complete.mechanisms(STUDY, SITE, *STARTERS))
@click.option("--plugin", is_flag=True, help="Create a package for a mechanism of your own, called NAME.")
@click.option(
    "-o",
    "--out",
    type=click.Path(),
    metavar="FOLDER",
    shell_complete=complete.files,
    help="New folder for the package.  [default: rocking-NAME, in this folder]",
)
@options.as_json
def command(name: str, plugin: bool, out: str | None, as_json: bool) -> None:
    """Print a commented template: a working structure file of the mechanism NAME, or a common structure.

    The common structures are facade, parapet, gable, pinnacle, corner, bell_cell, column_with_tendon and statue.
    `study` is a fragility study of a block.yaml in the same folder, and `site` a site file for `rocking verify`.

    With --plugin, the command writes a package for a mechanism of your own, called NAME: a working mechanism with
    comments for you to change, its tests, a structure file and its drawing. `pip install` makes it available like the
    built-in mechanisms.

    \b
    Example:
      rocking new arch > arch.yaml
      rocking new facade > facade.yaml
      rocking new study > study.yaml
      rocking new site > site.yaml
      rocking new --plugin leaning_pier
    """
    if plugin:
        from rocking_cli.cli.new_plugin import write

        write(name, out, printed=(STUDY, SITE, *STARTERS), as_json=as_json)
        return
    if out is not None:
        raise click.UsageError("--out requires --plugin: without it the file is printed; redirect it with > FILE.")
    if name == STUDY:
        from rocking_cli.cli.new_study import TEMPLATE

        _print({"study": STUDY, "yaml": TEMPLATE}, as_json=as_json)
        return
    if name == SITE:
        from rocking_cli.studies.verification.installed import codes
        from rocking_cli.studies.verification.site_file import USUAL

        _print({"site": USUAL, "yaml": codes()[USUAL].starter}, as_json=as_json)
        return
    from rocking_cli.core.registry import Registry
    from rocking_cli.errors import InputError, Problem, RockingError
    from rocking_cli.structure import parse_structure
    from rocking_cli.views.template import template

    registry = Registry()
    if name in STARTERS and name not in registry:
        text = (files("rocking_cli") / "data" / "starters" / f"{name}.yaml").read_text(encoding="utf-8")
        _print({"starter": name, "yaml": text}, as_json=as_json)
        return
    if name not in registry and (near := get_close_matches(name, STARTERS, n=1)):
        raise InputError(Problem(f"the mechanism {name!r} does not exist", hint=f"did you mean {near[0]}?"))
    text = template(registry[name])
    try:
        parse_structure(text, f"rocking new {name}", name, registry)
    except RockingError as error:
        terminal.warning(
            f"the examples of the mechanism {name} are not a valid structure: this file does not work as it is"
        )
        terminal.note(str(error))
        terminal.debug_traceback(error)
    _print({"mechanism": name, "yaml": text}, as_json=as_json)


def _print(made: dict[str, str], *, as_json: bool) -> None:
    if as_json:
        terminal.print_json(made)
    else:
        terminal.result(made["yaml"].rstrip("\n"))

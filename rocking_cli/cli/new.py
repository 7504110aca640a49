"""`rocking new`: a structure file to start from."""

from __future__ import annotations

from difflib import get_close_matches
from importlib.resources import files

import click

from rocking_cli.cli import complete, options, terminal

STARTERS = ("facade", "parapet", "gable", "pinnacle", "corner", "bell_cell", "column_with_tendon", "statue")
"""What people have, each a file in the data of the package. A mechanism that a package calls so comes first."""
STUDY = "study"
"""Not a mechanism: a study file is printed for it. A mechanism that a package calls so works, and is not printed."""
SITE = "site"
"""Nor is this: a site file for `rocking verify`."""


@click.command(short_help="A structure file, study or site that works, or a plugin.")
@click.argument("name", shell_complete=complete.mechanisms(STUDY, SITE, *STARTERS))
@click.option("--plugin", is_flag=True, help="Write a package with a mechanism of your own instead; NAME is its name.")
@click.option(
    "-o",
    "--out",
    type=click.Path(),
    metavar="FOLDER",
    shell_complete=complete.files,
    help="Where to write the package: a new folder.  [default: rocking-NAME, in this folder]",
)
@options.as_json
def command(name: str, plugin: bool, out: str | None, as_json: bool) -> None:
    """Print a commented structure file that works as it is: of the mechanism NAME, or of what people have.

    These are facade, parapet, gable, pinnacle, corner, bell_cell, column_with_tendon and statue. `study` is a fragility
    study, of block.yaml beside it, and `site` a site for `rocking verify`.

    `--plugin` writes a package for a mechanism of your own, called NAME: a commented one that works, to change into
    yours, with its tests, a structure file and its picture. `pip install` makes it a mechanism like all others.

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
        raise click.UsageError("--out goes with --plugin: a file is printed, for > FILE to take.")
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
    from rocking_cli.views.template import template

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

"""`rocking new`: print a template, or create a plugin package."""

from __future__ import annotations

from difflib import get_close_matches
from typing import Any

import click

from rocking_cli.cli import terminal
from rocking_cli.cli.help import CODES, MECHANISMS, Command, as_json, completer
from rocking_cli.errors import named
from rocking_cli.io.starters import STARTERS, in_italian, italian, starter, template_of
from rocking_cli.names import LANGUAGES

STUDY = "study"
"""Name of the study file. A mechanism of the same name works, but is not printed."""
SITE = "site"
"""Name of the site file for `rocking verify`."""


@click.command(cls=Command, short_help="Print a template file, or create a plugin package.")
@click.argument(
    "name",
    metavar="NAME",
    required=False,
    shell_complete=completer(MECHANISMS, STUDY, SITE, *STARTERS),
)
@click.option("--plugin", is_flag=True, help="Create a package for a mechanism of your own, called NAME.")
@click.option(
    "--code",
    is_flag=False,
    flag_value="",
    metavar="[CODE]",
    shell_complete=completer(CODES),
    help="With `site`: code of practice of the site file.  [default: NTC2018]  With --plugin, alone: create a package "
    "for a code of practice.",
)
@click.option(
    "-o",
    "--out",
    type=click.Path(),
    metavar="FOLDER",
    shell_complete=completer("file"),
    help="New folder for the package.  [default: rocking-NAME, in this folder]",
)
@click.option(
    "--language", type=click.Choice(LANGUAGES), default="en", show_default=True, help="Language of the comments."
)
@as_json
@click.pass_context
def command(
    ctx: click.Context, name: str | None, plugin: bool, code: str | None, out: str | None, language: str, as_json: bool
) -> None:
    """Print a commented template: a working structure file of the mechanism NAME, or a common structure.

    The common structures are facade, parapet, gable, pinnacle, corner, bell_cell, column_with_tendon and statue.
    `study` is a fragility study of a block.yaml in the same folder, and `site` a site file for `rocking verify`: of the
    Italian code, or with --code CODE of any installed code of practice. Italian names find their templates, such as
    facciata, parapetto, timpano, cantonale, arco, muro and portale; --language it prints the comments in Italian.

    With --plugin, the command writes a package for a mechanism of your own, called NAME: a working mechanism with
    comments for you to change, its tests, and a structure file. `pip install` makes it available like the
    built-in mechanisms. With --plugin and --code, it writes such a package for a code of practice of your own.

    \b
    Example:
      rocking new arch > arch.yaml
      rocking new facade > facade.yaml
      rocking new facciata --language it > facciata.yaml
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
        if language != LANGUAGES[0]:
            raise click.UsageError("--language requires a template: a package for --plugin is in English.")
        write(name, out, MECHANISM if code is None else CODE, printed=(STUDY, SITE, *STARTERS), as_json=as_json)
        return
    if out is not None:
        raise click.UsageError("--out requires --plugin: without it the file is printed; redirect it with > FILE.")
    made = _made(name, code, as_json=as_json)
    if language != LANGUAGES[0]:
        made["yaml"], missing = in_italian(made["yaml"])
        if missing:
            terminal.note(f"comments without an Italian text, which stay in English: {len(missing)}")
    if as_json:
        terminal.print_json(made)
    else:
        terminal.result(made["yaml"].rstrip("\n"))


def _made(word: str, code: str | None, *, as_json: bool) -> dict[str, Any]:
    """Return the kind and name of a template, and its text; a warning says if it does not work as it is."""
    from rocking_cli.plugins.registry import find

    mechanisms = find(MECHANISMS)
    name = word if word in mechanisms else template_of(word)
    if code is not None and name != SITE:
        raise click.UsageError(
            f"--code requires {named('site')}, as in `rocking new site --code NTC2018`, or --plugin."
        )
    if name != word:
        terminal.note(f"{word} is the template {name}")
    if name == STUDY:
        return {"study": STUDY, "yaml": starter(STUDY)}
    if name == SITE:
        return _site(code, as_json=as_json)
    if name in STARTERS and name not in mechanisms:
        return {"starter": name, "yaml": starter(name)}
    from rocking_cli.core.registry import Registry
    from rocking_cli.core.structure_file import parse_structure
    from rocking_cli.errors import InputError, Problem, RockingError
    from rocking_cli.views.mechanisms import template

    registry = Registry()
    if name not in registry and name in find(CODES):
        hint = f"`rocking new site --code {name}` prints a site file"
        raise InputError(Problem(f"{name} is a code of practice, not a mechanism", hint=hint))
    if name not in registry and (similar := get_close_matches(name, [*STARTERS, *italian()["templates"]], n=1)):
        raise InputError(Problem(f"the mechanism {name!r} does not exist", hint=f"did you mean {similar[0]}?"))
    text = template(registry[name])
    try:
        parse_structure(text, f"rocking new {name}", name, registry)
    except RockingError as error:
        _warn(f"the examples of the mechanism {name} are not a valid structure", error)
    return {"mechanism": name, "yaml": text}


def _site(asked: str | None, *, as_json: bool) -> dict[str, Any]:
    """Return the site file of a code, by default the usual one, and for JSON the schema of its fields too."""
    from rocking_cli.errors import RockingError
    from rocking_cli.io.yaml_file import parse
    from rocking_cli.plugins.errors import blame
    from rocking_cli.questions.new.new_plugin import quoted
    from rocking_cli.verification.check import site_in
    from rocking_cli.verification.code import DEFAULT_CODE, SITE_HINT, codes
    from rocking_cli.views.mechanisms import starter as site_file

    key = DEFAULT_CODE if asked is None else asked
    code = codes()[key]
    getting = f"rocking new site --code {quoted(key)}"
    text = site_file(code, [f"{getting} > site.yaml", "rocking verify block.yaml --site site.yaml"])
    try:
        site_in(parse(text, getting, "site", SITE_HINT))
    except RockingError as error:
        _warn(f"the examples of the code {key} are not a valid site", error)
    schema: dict[str, Any] = {}
    if as_json:
        with blame(f"the code {key} failed in the schema of its site", type(code).__module__):
            schema = code.site.model_json_schema()
    return {"site": key, "yaml": text, "schema": schema}


def _warn(what: str, error: Exception) -> None:
    """Warn that a file cannot be used before something is changed in it, and why."""
    terminal.warning(f"{what}: this file does not work as it is")
    terminal.note(str(error))
    terminal.debug_traceback(error)

"""`rocking new`: print a template, or create a plugin package."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any

import click

from rocking_cli.cli import terminal
from rocking_cli.cli.help import CODES, MECHANISMS, Command, as_json, completer
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.io.starters import STARTERS, in_italian, italian, starter, template_of
from rocking_cli.names import LANGUAGES
from rocking_cli.text import cut

NAME_PATTERN = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")
MAX_NAME_LENGTH = 40  # characters, so that no line of the package is too long


@dataclass(frozen=True)
class PluginKind:
    """Kind of plugin that a package is written for: a mechanism or a code.

    Parameters
    ----------
    word : str
        Name of the kind.
    folder : str
        Folder of its example package.
    example : str
        Name in the example: capped_block, CappedBlock, capped-block and "capped block" become the given name.
    files : mapping of str to str
        Description of each file of the example, by its path.
    commands : tuple of str
        The commands with which to try the example.
    """

    word: str
    folder: str
    example: str
    files: Mapping[str, str]
    commands: tuple[str, ...]

    def named(self, text: str, name: str) -> str:
        """Return a text of the example with another name."""
        spellings: tuple[Callable[[str], str], ...] = (str, of_class, _hyphened, lambda word: word.replace("_", " "))
        words = {spell(self.example): spell(name) for spell in spellings}
        return re.sub("|".join(words), lambda found: words[found[0]], text)

    def package(self, name: str) -> dict[str, bytes]:
        """Return the files of the package for a plugin of this name, by their paths in the folder."""
        package = Path(__file__).parents[2]
        source = package / "data" / self.folder
        if not source.is_dir():  # a checkout has the files in examples/
            source = package.parent / "examples" / self.folder
        texts = {file: (source / file).read_text(encoding="utf-8") for file in self.files}
        return {self.named(file, name): self.named(text, name).encode() for file, text in texts.items()}


MECHANISM = PluginKind(
    word="mechanism",
    folder="plugin",
    example="capped_block",
    files={
        "pyproject.toml": "package metadata, and the name by which rocking finds it",
        "rocking_capped_block.py": "the mechanism: change this",
        "tests/test_capped_block.py": "tests of the contract, and of a formula by hand",
        "README.md": "how to go on",
        "capped_block.yaml": "a structure of it",
    },
    commands=("rocking mechanisms --check capped_block", "rocking draw capped_block.yaml"),
)
CODE = PluginKind(
    word="code",
    folder="plugin_code",
    example="my_code",
    files={
        "pyproject.toml": "package metadata, and the name by which rocking finds it",
        "rocking_my_code.py": "the code: change this",
        "tests/test_my_code.py": "tests of the contract, and of numbers by hand",
        "README.md": "how to go on",
        "site.yaml": "a site for it",
    },
    commands=("rocking verify --site site.yaml",),
)


def write(name: str, out: str | None, kind: PluginKind, *, printed: Collection[str], as_json: bool) -> None:
    """Write the package, and print its files and the next commands.

    Parameters
    ----------
    name : str
        Name of the mechanism or code.
    out : str or None
        Folder of the package; None for one with its name, in this folder.
    kind : PluginKind
        `MECHANISM` or `CODE`.
    printed : collection of str
        Names of other templates that `rocking new` prints.
    as_json : bool
        Whether to print one JSON object.

    Raises
    ------
    InputError
        If the name is not valid, or the folder cannot be made.
    """
    from rocking_cli.io.files import write_folder
    from rocking_cli.views.column import table_of, text_columns
    from rocking_cli.views.view import View

    check_name(name, kind, printed)
    folder = Path(f"rocking-{_hyphened(name)}" if out is None else out)
    write_folder(folder, kind.package(name))
    interpreter = shutil.which("python")  # the interpreter with rocking-cli
    here = interpreter is not None and Path(interpreter).parent == Path(sys.executable).parent
    python = "python" if here or not sys.executable else quoted(sys.executable)
    commands = [f"cd {quoted(str(folder))}"] if folder.resolve() != Path.cwd() else []
    commands += [f'{python} -m pip install --editable ".[test]"']
    commands += [kind.named(each, name) for each in kind.commands] + [f"{python} -m pytest"]
    described = {kind.named(file, name): what for file, what in kind.files.items()}
    title = f"{folder}: template of the {kind.word} {name}"
    table = table_of(title, text_columns("file", "description"), list(described.items()))
    data = {"plugin": name, "folder": str(folder), "files": list(described), "commands": commands}
    terminal.show(View(data, [table]), as_json=as_json)
    if not as_json:
        terminal.sentence("Next:")
        for each in commands:
            terminal.result(f"  {each}")  # without wrapping, so that it can be copied


def check_name(name: str, kind: PluginKind, printed: Collection[str]) -> None:
    """Raise `InputError` if a text cannot be the name of a mechanism, or code, in a package of its own."""
    import yaml

    from rocking_cli.core.registry import Registry
    from rocking_cli.questions.mechanisms.command import PARTS
    from rocking_cli.verification.code import Codes

    if not NAME_PATTERN.fullmatch(name) or len(name) > MAX_NAME_LENGTH:
        guess = re.sub(r"[^a-z0-9]+", "_", name.lower()).lstrip("_0123456789")[:MAX_NAME_LENGTH].rstrip("_")
        hint = f"use at most {MAX_NAME_LENGTH} of a-z, 0-9 and _, a letter first, such as {guess or kind.example}"
        raise InputError(Problem(f"{cut(repr(name))} cannot be the name of a {kind.word}", hint=hint))
    for word, installed in (("mechanism", Registry()), ("code", Codes())):
        if name in installed:
            owner = installed.package_of(name)
            hint = "take another name" + ("" if owner.startswith("rocking-cli ") else f", or uninstall {owner} first")
            raise InputError(Problem(f"the {word} {name} already exists, in {owner}", hint=hint))
    why, text = None, b"".join(kind.package(kind.example).values()).decode()
    if not isinstance(yaml.safe_load(name), str):
        why = "in a YAML file this word is not read as text"
    elif kind is MECHANISM and name in printed:
        why = f"`rocking new {name}` prints something else"
    elif kind is MECHANISM and name in PARTS:
        why = f"`rocking mechanisms {name}` shows something else"
    elif taken := re.search(rf"\b({of_class(name)}|rocking_{name})\b", text):
        why = f"in the package {taken[0]} already means something else"
    if why is not None and name != kind.example:
        raise InputError(Problem(f"a {kind.word} cannot be called {name}: {why}", hint="take another name"))


def of_class(name: str) -> str:
    """Return the name of the class of a mechanism or code."""
    return "".join(word[0].upper() + word[1:] for word in name.split("_"))


def quoted(word: str) -> str:
    """Return a word as it is typed in a shell."""
    return subprocess.list2cmdline([word]) if os.name == "nt" else shlex.quote(word)


def _hyphened(name: str) -> str:
    return name.replace("_", "-")


STUDY = "study"
"""Name of the study file. A mechanism of the same name works, but is not printed."""
SITE = "site"
"""Name of the site file for `rocking verify`."""
BUILDING, EDIFICIO = "building", "edificio"
"""Name of the file for `rocking building`, whose fields are Italian too."""


@click.command(cls=Command, short_help="Print a template file, or create a plugin package.")
@click.argument(
    "name",
    metavar="NAME",
    required=False,
    shell_complete=completer(MECHANISMS, STUDY, SITE, BUILDING, *STARTERS),
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
    "--walls",
    metavar="TABLE.csv",
    shell_complete=completer("file"),
    help="With `building`: a table of walls of which the file is made: name, storey, thickness, height, length, bears, "
    "span.",
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
    ctx: click.Context, name: str | None, plugin: bool, code: str | None, walls: str | None, out: str | None,
    language: str, as_json: bool,
) -> None:  # fmt: skip
    """Print a commented template: a working structure file of the mechanism NAME, or a common structure.

    The common structures are facade, parapet, gable, pinnacle, corner, bell_cell, column_with_tendon and statue.
    `study` is a fragility study of a block.yaml in the same folder, and `site` a site file for `rocking verify`: of the
    Italian code, or with --code CODE of any installed code of practice; `building` is a house for `rocking building`.
    Italian names find their templates, such as facciata, parapetto, timpano, cantonale, arco, muro, portale and
    edificio; --language it prints the comments in Italian.

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
      rocking new building > house.yaml
      rocking new building --walls walls.csv > house.yaml
      rocking new --plugin leaning_pier
      rocking new --plugin my_code --code
    """
    if plugin and code and name is None:
        name, code = code, ""  # `--code NAME` is accepted, too
    if name is None:
        raise click.MissingParameter(ctx=ctx, param=next(each for each in ctx.command.params if each.name == "name"))
    if plugin:
        if code not in (None, "", name):
            raise click.UsageError(f"--plugin creates one package: give one name, not {name} and {code}.")
        if language != LANGUAGES[0]:
            raise click.UsageError("--language requires a template: a package for --plugin is in English.")
        write(
            name, out, MECHANISM if code is None else CODE, printed=(STUDY, SITE, BUILDING, *STARTERS), as_json=as_json
        )
        return
    if out is not None:
        raise click.UsageError("--out requires --plugin: without it the file is printed; redirect it with > FILE.")
    if walls is not None and template_of(name) != BUILDING:
        raise click.UsageError("--walls requires `building`: the file of a building is made of the table.")
    made = _made(name, code, language, walls, as_json=as_json)
    if language != LANGUAGES[0] and BUILDING not in made:
        made["yaml"], missing = in_italian(made["yaml"])
        if missing:
            terminal.note(f"comments without an Italian text, which stay in English: {len(missing)}")
    if as_json:
        terminal.print_json(made)
    else:
        terminal.result(made["yaml"].rstrip("\n"))


def _made(word: str, code: str | None, language: str, walls: str | None, *, as_json: bool) -> dict[str, Any]:
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
    if walls is not None:
        from rocking_cli.questions.building.walls import described

        return {"building": BUILDING, "yaml": described(Path(walls))}
    if name == BUILDING:
        return {"building": BUILDING, "yaml": starter(BUILDING if language == LANGUAGES[0] else EDIFICIO)}
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

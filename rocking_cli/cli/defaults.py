"""Defaults of a person or a folder for options: from the environment, `rocking.toml` here, and the user's own file.

The command line goes before the environment, that before the file of this folder, that before the user's, and a table
of a command in a file before what the same file says of all.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import click
from click.core import ParameterSource

from rocking_cli.cli import terminal
from rocking_cli.errors import InputError, Problem
from rocking_cli.text import cut, did_you_mean, one_line

FILE = "rocking.toml"
PREFIX = "ROCKING_"
LARGEST = 1_000_000  # bytes of a file

EVERYWHERE = (
    "units", "dt", "channel", "neighbours", "within-amplitude", "within-restitution", "tail", "rtol", "points",
    "fractiles", "fps", "speed", "jobs", "format", "project", "place", "author", "logo",
)  # fmt: skip
"""Options that mean the same in every command that has them. Those that say what is asked, read or written are none."""
IN_TABLES = ("polarity", "model", "eta", "kappa", "shape")
"""Options that differ from command to command: only the table of a command gives them."""
OTHERS = ("DEBUG", "BROWSER")
"""Other variables of the environment that mean something."""


class Default(NamedTuple):
    """One default that somebody set.

    Parameters
    ----------
    option : str
        Its name without dashes in front.
    command : str or None
        The command that it is for; None for all that have the option.
    value : str
        As it would be typed.
    place : str
        The file, or the variable of the environment.
    key : str
        What to call it in messages: the place, and in a file the key.
    """

    option: str
    command: str | None
    value: str
    place: str
    key: str


def user_file() -> Path:
    """The user's own file, there or not."""
    import platformdirs

    return platformdirs.user_config_path("rocking-cli", appauthor=False, roaming=True) / FILE


def files() -> list[Path]:
    """The files that are there, that of this folder first."""
    return [each for each in (Path(FILE), user_file()) if each.is_file()]


def in_force(commands: tuple[str, ...]) -> list[Default]:
    """Every default that is set, those that go before others first.

    Raises
    ------
    InputError
        With every key of a file that is no option, and every value that can be none.
    """
    found = [
        Default(option, None, value, variable, variable)
        for option in EVERYWHERE
        if (value := os.environ.get(variable := PREFIX + option.upper().replace("-", "_")))
    ]
    problems: list[Problem] = []
    for file in files():
        found += _of_file(file, commands, problems)
    if problems:
        raise InputError(*problems)
    return found


def unknown_variables() -> list[str]:
    """Variables of the environment that look like ours and mean nothing."""
    known = {PREFIX + each.upper().replace("-", "_") for each in EVERYWHERE} | {PREFIX + each for each in OTHERS}
    return sorted(each for each in os.environ if each.startswith(PREFIX) and each not in known)


def for_command(command: click.Command, name: str, commands: tuple[str, ...]) -> dict[str, Default]:
    """The defaults that hold for the options of one command, by the name of its parameter. Raises as `in_force`."""
    options = {max(each.opts, key=len)[2:]: each for each in command.params if isinstance(each, click.Option)}
    found: dict[str, Default] = {}
    for each in in_force(commands):
        if each.command == name and each.option not in options:
            hint = did_you_mean(each.option, [*{*EVERYWHERE, *IN_TABLES} & {*options}])
            raise InputError(Problem(f"`rocking {name}` has no option --{each.option}", each.key, hint=hint))
        if each.command in (None, name) and each.option in options:
            found.setdefault(options[each.option].name or "", each)
    return found


def of_run(context: click.Context) -> dict[str, Default]:
    """The defaults that a command runs with, by the name of its parameter: those that nothing typed replaces."""
    defaults: Mapping[str, Default] = context.meta.get(__name__, {})
    return {name: each for name, each in defaults.items() if from_default(name, context)}


def set_for(context: click.Context, defaults: dict[str, Default]) -> None:
    """Have a command take these where its options are not typed."""
    context.meta[__name__] = defaults
    context.default_map = {name: each.value for name, each in defaults.items()}


def from_default(name: str, context: click.Context | None = None) -> bool:
    """Whether the value of a parameter of the running command is such a default, and was not typed."""
    context = context or click.get_current_context(silent=True)
    return context is not None and context.get_parameter_source(name) is ParameterSource.DEFAULT_MAP


def say(context: click.Context) -> None:
    """Say, once, which of them change what this run does."""
    usual = {each.name: each.default for each in context.command.params}
    changed = [each for name, each in of_run(context).items() if each.value != str(usual[name])]
    if changed:
        terminal.note("defaults: " + ", ".join(f"--{each.option} {each.value} ({each.place})" for each in changed))


def blame(error: click.BadParameter) -> InputError | None:
    """What to say of a default that its option refuses: which file or variable has it; None for what was typed."""
    if error.ctx is None or error.param is None:
        return None
    default = of_run(error.ctx).get(error.param.name or "")
    return InputError(Problem(error.message.rstrip("."), default.key)) if default is not None else None


def whose(error: click.UsageError) -> str:
    """Which options that an error names nobody typed, to be said after it; empty if there are none."""
    taken = of_run(error.ctx).values() if error.ctx is not None else ()
    named = [each for each in taken if re.search(rf"--{each.option}(?![\w-])", error.message)]
    return "".join(f" Nobody typed --{each.option} {each.value}: it is a default, {each.key}." for each in named)


def _of_file(file: Path, commands: tuple[str, ...], problems: list[Problem]) -> Iterator[Default]:
    """What a file says, the tables of commands first; what is wrong with it is added to the problems."""
    shown = one_line(str(file))
    data = _read(file)
    tables = {key: value for key, value in data.items() if isinstance(value, dict)}
    for table, pairs in tables.items():
        if table not in commands:
            problems.append(Problem(f"no command is called {cut(table)}", shown, field=f"[{cut(table)}]",
                                    hint=did_you_mean(table, list(commands))))  # fmt: skip
            continue
        for key, value in pairs.items():
            yield from _one(shown, table, key, value, (*EVERYWHERE, *IN_TABLES), problems)
    for key in data.keys() - tables.keys():
        yield from _one(shown, None, key, data[key], EVERYWHERE, problems)


def _one(
    file: str, command: str | None, key: str, value: Any, known: tuple[str, ...], problems: list[Problem]
) -> Iterator[Default]:
    option = key.replace("_", "-")
    place = f"[{command}] {key}" if command else key
    if option not in known:
        only = option in IN_TABLES
        hint = "it differs between commands: put it below one of them, such as [respond]" if only else None
        problems.append(Problem("this is no option that can have a default", file, field=cut(one_line(place)),
                                hint=hint or did_you_mean(option, list(known))))  # fmt: skip
        return
    values = value if isinstance(value, list) else [value]
    if not values or any(isinstance(each, bool) or not isinstance(each, (str, int, float)) for each in values):
        problems.append(Problem("this is neither a text nor a number, nor a list of them", file, field=place))
        return
    yield Default(option, command, ",".join(map(str, values)), file, f"{file}: {place}")


def _read(file: Path) -> dict[str, Any]:
    import tomllib

    from rocking_cli.io.files import read_bytes

    try:
        return tomllib.loads(read_bytes(file, "file of defaults", LARGEST).decode("utf-8-sig"))
    except UnicodeDecodeError:
        raise InputError(Problem("not UTF-8 text", str(file), hint="save the file as UTF-8")) from None
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        hint = "it is written as `option = value` lines, such as tail = 5, and tables of a command, such as [respond]"
        raise InputError(Problem(f"not TOML: {error}", str(file), hint=hint)) from None

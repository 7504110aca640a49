"""Defaults for options, set by a user or in a folder: in the environment, in `rocking.toml` here or in the user's file.

The command line overrides the environment, which overrides the file of this folder, which overrides the user's file.
Within a file, the table of a command overrides the values for all commands.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import click
from click.core import ParameterSource

from rocking_cli.cli import terminal
from rocking_cli.errors import InputError, Problem
from rocking_cli.plugins.rooms import commands
from rocking_cli.text import cut, did_you_mean, one_line

SETTINGS_FILE = "rocking.toml"
VARIABLE_PREFIX = "ROCKING_"
MAX_FILE_SIZE = 1_000_000  # bytes

SHARED_OPTIONS = (
    "units", "dt", "channel", "neighbours", "amplitude-deviation", "slenderness-deviation",
    "restitution-deviation", "tail", "rtol", "points",
    "fractiles", "fps", "speed", "jobs", "project", "place", "client", "author", "logo",
)  # fmt: skip
"""Options with one meaning in all commands; none that choose the question, the input or the output."""
AMBIGUOUS_OPTIONS = ("polarity", "model", "restitution", "kappa", "shape")
"""Options whose meaning differs between commands: only the table of a command may set them."""
AMBIGUOUS_HINT = "its meaning differs between commands: put it in the table of a command, such as [respond]"
OTHER_VARIABLES = ("DEBUG", "BROWSER", "KERNELS")
"""Other variables of the environment that the program reads."""


class Default(NamedTuple):
    """A default that a user or a folder sets.

    Parameters
    ----------
    option : str
        Name without leading dashes.
    command : str or None
        The only command with this default; None for all that have the option.
    value : str
        Value, as it would be typed.
    place : str
        The file, or the variable of the environment.
    key : str
        Name in messages: the place, and in a file also the key.
    """

    option: str
    command: str | None
    value: str
    place: str
    key: str


def user_file() -> Path:
    """Return the path of the user's own file, which may not exist."""
    import platformdirs

    return platformdirs.user_config_path("rocking-cli", appauthor=False, roaming=True) / SETTINGS_FILE


def files() -> list[Path]:
    """Return the existing files, that of this folder first."""
    # pathlib raises where a folder may not be entered.
    return [each for each in (Path(SETTINGS_FILE), user_file()) if os.path.isfile(each)]  # noqa: PTH113


def in_force() -> list[Default]:
    """Return all defaults that are set, in descending priority.

    Raises
    ------
    InputError
        With every key that cannot have a default, table that is not a command, and value that is neither a text nor a
        number nor a list of them.
    """
    existing = [
        Default(option, None, value, variable, variable)
        for option in SHARED_OPTIONS
        if (value := os.environ.get(variable := _variable(option)))
    ]
    problems: list[Problem] = []
    for file in files():
        shown, data = one_line(str(file)), _read(file)
        tables: dict[str | None, Any] = {key: value for key, value in data.items() if isinstance(value, dict)}
        for command in [each for each in tables if each not in commands()]:
            hint = did_you_mean(str(command), list(commands()))
            word = cut(str(command))
            problems.append(Problem(f"{word} is not a command", shown, field=f"[{word}]", hint=hint))
            del tables[command]
        tables[None] = {key: value for key, value in data.items() if not isinstance(value, dict)}
        for command, pairs in tables.items():
            known = [*SHARED_OPTIONS, *(AMBIGUOUS_OPTIONS if command else ())]
            for key, value in pairs.items():
                option, place = key.replace("_", "-"), f"[{command}] {key}" if command else key
                values = value if isinstance(value, list) else [value]
                if option not in known:
                    hint = AMBIGUOUS_HINT if option in AMBIGUOUS_OPTIONS else did_you_mean(option, known)
                    what = "this option cannot have a default"
                    problems.append(Problem(what, shown, field=cut(one_line(place)), hint=hint))
                elif not values or any(
                    isinstance(each, bool) or not isinstance(each, str | int | float) for each in values
                ):
                    what = "the value is neither a text nor a number, nor a list of them"
                    problems.append(Problem(what, shown, field=place))
                else:
                    typed = ",".join(map(str, values))
                    existing.append(Default(option, command, typed, shown, f"{shown}: {place}"))
    if problems:
        raise InputError(*problems)
    return existing


def unknown_variables() -> list[str]:
    """Return variables of the environment with our prefix that the program does not read."""
    known = {*map(_variable, SHARED_OPTIONS), *(VARIABLE_PREFIX + each for each in OTHER_VARIABLES)}
    return sorted(each for each in os.environ if each.startswith(VARIABLE_PREFIX) and each not in known)


def set_for(context: click.Context) -> None:
    """Set the defaults of a command for the options that are not typed. Raises as `in_force`."""
    name, params = context.info_name, context.command.params
    options = {max(each.opts, key=len)[2:]: each for each in params if isinstance(each, click.Option)}
    defaults: dict[str, Default] = {}
    for each in in_force():
        if each.command == name and each.option not in options:
            hint = did_you_mean(each.option, [*{*SHARED_OPTIONS, *AMBIGUOUS_OPTIONS} & {*options}])
            raise InputError(Problem(f"`rocking {name}` has no option --{each.option}", each.key, hint=hint))
        if each.command in (None, name) and each.option in options:
            defaults.setdefault(options[each.option].name or "", each)
    context.meta[__name__] = defaults
    context.default_map = {name: each.value for name, each in defaults.items()}


def of_run(context: click.Context) -> dict[str, Default]:
    """Return the defaults that the command line does not replace, by name of parameter."""
    defaults: Mapping[str, Default] = context.meta.get(__name__, {})
    return {name: each for name, each in defaults.items() if from_default(name, context)}


def from_default(name: str, context: click.Context | None = None) -> bool:
    """Return whether the value of a parameter of the running command is a user's default, and was not typed."""
    context = context or click.get_current_context(silent=True)
    return context is not None and context.get_parameter_source(name) is ParameterSource.DEFAULT_MAP


def say(context: click.Context) -> None:
    """Print a note on the defaults that change this run."""
    usual = {each.name: getattr(each, "usual", each.default) for each in context.command.params}
    changed = [each for name, each in of_run(context).items() if each.value != str(usual[name])]
    if changed:
        terminal.note("defaults: " + ", ".join(f"--{each.option} {each.value} ({each.place})" for each in changed))


def blame(error: click.BadParameter) -> InputError | None:
    """Return the error of a default that its option refuses, naming its file or variable; None if it was typed."""
    if error.ctx is None or error.param is None:
        return None
    default = of_run(error.ctx).get(error.param.name or "")
    return InputError(Problem(error.message.rstrip("."), default.key)) if default is not None else None


def whose(message: str, context: click.Context | None) -> str:
    """Return sentences on the options named in an error message that were not typed; empty if all were."""
    applied = of_run(context).values() if context is not None else ()
    named = [each for each in applied if re.search(rf"--{each.option}(?![\w-])", message)]
    return "".join(f" --{each.option} {each.value} was not typed; it is a default from {each.key}." for each in named)


def _variable(option: str) -> str:
    return VARIABLE_PREFIX + option.upper().replace("-", "_")


def _read(file: Path) -> dict[str, Any]:
    import tomllib

    from rocking_cli.io.files import read_bytes

    try:
        return tomllib.loads(read_bytes(file, "file of defaults", MAX_FILE_SIZE).decode("utf-8-sig"))
    except UnicodeDecodeError:
        raise InputError(Problem("not UTF-8 text", str(file), hint="save the file as UTF-8")) from None
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        hint = "write `option = value` lines, such as tail = 5, and tables of commands, such as [respond]"
        raise InputError(Problem(f"not valid TOML: {error}", str(file), hint=hint)) from None

"""The command as it was given, for the documents that it writes."""

from __future__ import annotations

import shlex
from collections.abc import Sequence

import click
from click.core import ParameterSource

from rocking_cli.cli import defaults


def command_line(ctx: click.Context, without: Sequence[str] = ()) -> str:
    """Return the command as it was given, for a POSIX shell, with the user's defaults; `without` some parameters."""
    words = ["rocking", ctx.info_name or ""]
    applied = defaults.of_run(ctx)
    for param in [each for each in ctx.command.params if each.name not in without]:
        value = ctx.params.get(param.name or "")
        if default := applied.get(param.name or ""):
            words += [f"--{default.option}", default.value]
        if ctx.get_parameter_source(param.name or "") is not ParameterSource.COMMANDLINE:
            continue
        for each in value if isinstance(value, tuple) else (value,):
            words += [] if isinstance(param, click.Argument) else [param.opts[0]]
            words += [] if each is True else [str(each)]
    places = ", ".join(f"--{each.option} from {each.place}" for each in applied.values())
    return shlex.join(words) + (f"  # {places}" if places else "")

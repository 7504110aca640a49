"""Heading of a document, and the command that wrote it."""

from __future__ import annotations

import shlex
from pathlib import Path

import click

from rocking_cli.cli import complete, defaults, options
from rocking_cli.names import LANGUAGES
from rocking_cli.processing.reading_options import CORRECTIONS

HEAD_OPTIONS = ("project", "place", "client", "author", "logo")
"""Options of the heading of a document."""

head: options.Decorator = options.in_order(
    click.option("--project", metavar="TEXT", help="Project name, for the heading of the document."),
    click.option("--place", metavar="TEXT", help="Location of the structure, for the heading."),
    click.option("--client", metavar="TEXT", help="Client who ordered the document, for the heading."),
    click.option("--author", metavar="TEXT", help="Author of the document, for the heading."),
    click.option(
        "--logo",
        type=click.Path(path_type=Path),
        metavar="FILE",
        help="Author's logo (.png, .jpg or .svg), for the heading.",
    ),
)
"""The options of a head: `project`, `place`, `client`, `author` and `logo`."""


language: options.Decorator = click.option(
    "--language",
    type=click.Choice(LANGUAGES),
    help="Language of the answer and of documents.  [default: that of the site, or en]",
)


sheet: options.Decorator = options.in_order(
    click.option(
        "--sheet", callback=options.output_path(".html", ".docx", ".pdf"), metavar="FILE.html",
        shell_complete=complete.files,
        help="Write the calculation sheet (.html; .docx and .pdf need an extra package; a browser does for .pdf).",
    ),
    language,
    head,
)  # fmt: skip
"""The options of a calculation sheet: `sheet`, `language` and those of its head."""


def command_line(ctx: click.Context) -> str:
    """Return the command as it was given, for a POSIX shell, with the user's defaults written out."""
    from click.core import ParameterSource

    words = ["rocking", ctx.info_name or ""]
    applied = defaults.of_run(ctx)
    steps = [name for name in ctx.params if name in CORRECTIONS]  # in the order of the options
    for param in sorted(ctx.command.params, key=lambda each: steps.index(each.name) if each.name in steps else -1):
        value = ctx.params.get(param.name or "")
        if default := applied.get(param.name or ""):
            words += [f"--{default.option}", default.value]
        if ctx.get_parameter_source(param.name or "") is not ParameterSource.COMMANDLINE:
            continue
        for each in _typed(value):
            words += [] if isinstance(param, click.Argument) else [param.opts[0]]
            words += [] if each is True else [str(getattr(each, "value", each))]  # value of a correction
    places = ", ".join(f"--{each.option} from {each.place}" for each in applied.values())
    return shlex.join(words) + (f"  # {places}" if places else "")


def _typed(value: object) -> tuple[object, ...]:
    """Return the values typed for a parameter, the parts of a point joined."""
    if isinstance(value, tuple) and value and isinstance(value[0], float):
        return (",".join(str(each) for each in value if each is not None),)
    return value if isinstance(value, tuple) else (value,)

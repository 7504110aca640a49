"""Writes the parts of the documentation that are in the code: the command line, and the fields of the mechanisms.

    python docs/make_reference.py             # part of make docs

The parts go to docs/_generated, which is not in git, and are included by docs/cli.md and docs/mechanisms/*.md.
"""

from __future__ import annotations

from inspect import cleandoc
from pathlib import Path
from textwrap import dedent, indent
from typing import Any

import click
from make_runs import examples, of_mechanisms

from rocking_cli import Registry
from rocking_cli.cli.main import main
from rocking_cli.views.mechanisms import fields

GENERATED = Path(__file__).resolve().parent / "_generated"
OURS = "rocking-cli"  # the package; a plugin that happens to be installed is documented elsewhere


def command_line() -> str:
    """The group and every command: usage, help and options."""
    group = click.Context(main, info_name="rocking", **main.context_settings)
    parts = [described(main, group)]
    for name in main.list_commands(group):
        command = main.get_command(group, name)
        assert command is not None
        parts.append(f"## rocking {name}\n\n" + described(command, click.Context(command, group, info_name=name)))
    return "\n\n".join(parts) + "\n"


def described(command: click.Command, ctx: click.Context) -> str:
    """Usage, help and options of a command, in Markdown."""
    usage = f"    {ctx.command_path} {' '.join(command.collect_usage_pieces(ctx))}"
    return "\n\n".join([usage, *map(paragraph, cleandoc(command.help or "").split("\n\n")), options(command, ctx)])


def paragraph(text: str) -> str:
    r"""A paragraph of a help text; one that begins with click's \b keeps its lines, and its heading stands above."""
    if not text.startswith("\b"):
        return plain(" ".join(text.split()))
    _, heading, *lines = text.split("\n")
    return f"{plain(heading)}\n\n" + indent(dedent("\n".join(lines)), "    ")


def options(command: click.Command, ctx: click.Context) -> str:
    """A definition list of what `--help` lists."""
    listed = [each for each in command.get_params(ctx) if isinstance(each, click.Option)]
    records = [found for each in listed if (found := each.get_help_record(ctx)) is not None]
    return "\n\n".join(f"`{names}`\n: {plain(meaning)}" for names, meaning in records)


def plain(text: str) -> str:
    """Text that Markdown leaves as it is; code stays code."""
    pieces = text.split("`")
    for k in range(0, len(pieces), 2):
        for sign in "\\*_<[$":
            pieces[k] = pieces[k].replace(sign, "\\" + sign)
    return "`".join(pieces)


def mechanism(name: str, cls: Any, file: str) -> str:
    """Source and verification, fields, the example and its equivalent block."""
    shown = of_mechanisms()
    drawing = f"```{{image}} ../_generated/run/draw_{name}.png\n:alt: {cls.title}, drawn\n```\n\n"
    return (
        drawing
        + f"**Source:** {plain(cls.source)}.\n\n**Verified against:** {plain(cls.verified or 'nothing yet')}.\n\n"
        + (f"**Caution:** {plain(cls.caution)}\n\n" if cls.caution else "")
        + f"## Fields\n\n{table_of_fields(cls)}\n\n"
        + f"## Example\n\n`examples/{file}`:\n\n```{{literalinclude}} ../../examples/{file}\n:language: yaml\n```\n\n"
        + f"Its equivalent block:\n\n    {shown[f'equiv_{name}']}\n\n"
        + f"```{{literalinclude}} ../_generated/run/equiv_{name}.txt\n:language: text\n```\n"
    )


def table_of_fields(cls: Any) -> str:
    """The fields of its own, and by name those that all mechanisms have."""
    rows = ["| field | meaning | symbol | unit | bounds | default |", "|---|---|---|---|---|---|"]
    for row in fields(cls):
        if not row["common"]:
            default = "required" if row["required"] else "" if row["default"] is None else f"`{row['default']}`"
            words = (plain(row[key]) for key in ("description", "symbol", "unit", "bounds"))
            rows.append(f"| `{row['field']}` | {' | '.join(words)} | {default} |")
    common = ", ".join(f"`{row['field']}`" for row in fields(cls) if row["common"])
    return "\n".join(rows) + f"\n\nand {common}, see [what is common to all](../mechanisms.md)."


def write() -> None:
    """Write all parts."""
    (GENERATED / "mechanisms").mkdir(parents=True, exist_ok=True)
    (GENERATED / "cli.md").write_text(command_line(), encoding="utf-8")
    registry, files = Registry(), examples()
    for name in registry:
        if registry.package_of(name).split()[0] == OURS:
            part = mechanism(name, registry[name], files[name])
            (GENERATED / "mechanisms" / f"{name}.md").write_text(part, encoding="utf-8")


if __name__ == "__main__":
    write()

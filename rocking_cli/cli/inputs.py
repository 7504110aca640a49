"""Structure of a command that takes one, beside ground motions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rocking_cli.cli import motion_files

if TYPE_CHECKING:
    from rocking_cli.structure import Structure


def structure(files: Sequence[str], records: Sequence[str]) -> Structure:
    """Return the single structure of a command, prepared."""
    import click

    from rocking_cli.cli import structures
    from rocking_cli.errors import InputError

    if len(files) > 1:
        motion_files.check_strays(files, records)
        raise click.UsageError(f"This command takes one structure, but {len(files)} are given: {', '.join(files)}.")
    try:
        return structures.prepared(files)
    except InputError:
        motion_files.check_strays(files, records)
        raise

"""Files of ground motions on a command line, and records in the place of a structure."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import click


def check_strays(files: Sequence[str], records: Sequence[str]) -> None:
    """Raise if records stand in the place of a structure: the shell puts the files of a bare pattern there."""
    endings = {Path(place).suffix.lower() for place in records} - {"", ".yaml", ".yml"}
    strays = [file for file in files if Path(file).suffix.lower() in endings]
    if strays:
        raise click.UsageError(
            f"{strays[0]} is given where a structure is expected. If it is a record, put --record before each file, "
            f"or use a quoted pattern: --record '*{Path(strays[0]).suffix}'."
        )


def structure(files: Sequence[str], records: Sequence[str]) -> str | Path:
    """Return the single structure of a command, by default that of `options.structure`."""
    check_strays(files, records)
    if len(files) > 1:
        raise click.UsageError(f"This command takes one structure, but {len(files)} are given: {', '.join(files)}.")
    if files:
        return files[0]
    from rocking_cli.ask.given import HERE

    return HERE

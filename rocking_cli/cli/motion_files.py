"""Files of ground motions on a command line: records in the place of a structure, and the output files of several."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from rocking_cli.cli.options import STANDARD_OUTPUT

if TYPE_CHECKING:
    from rocking_cli.processing.scaled import Scaled


def check_strays(files: Sequence[str], records: Sequence[str]) -> None:
    """Raise if records stand in the place of a structure: the shell puts the files of a bare pattern there."""
    endings = {Path(place).suffix.lower() for place in records} - {"", ".yaml", ".yml"}
    strays = [file for file in files if Path(file).suffix.lower() in endings]
    if strays:
        raise click.UsageError(
            f"{strays[0]} is given where a structure is expected. If it is a record, put --record before each file, "
            f"or use a quoted pattern: --record '*{Path(strays[0]).suffix}'."
        )


def separate(path: Path | None, chosen: Sequence[Scaled | None], *, several: bool) -> Sequence[Path | None]:
    """Return the output file of each motion; of several, `out-accel.csv` and so on for `out.csv`."""
    if path is None or not several:
        return [path] * len(chosen)
    if str(path) == STANDARD_OUTPUT:
        raise click.UsageError(
            "--out - works for a single motion only: for several, give a file name; each motion is written to its own "
            "file based on it."
        )
    taken: dict[str, Path] = {}
    for each in chosen:
        assert each is not None
        name = each.motion.name if each.file is None else each.motion.name.replace(each.file.name, each.file.stem, 1)
        word = "-".join(re.findall(r"[\w.+]+", name)) or "motion"
        count = 1
        while (place := f"{path.stem}-{word}{f'-{count}' if count > 1 else ''}{path.suffix}").casefold() in taken:
            count += 1
        taken[place.casefold()] = path.with_name(place)
    return list(taken.values())

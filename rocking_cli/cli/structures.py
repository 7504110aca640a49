"""Structures of a command: read, checked and reported."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from rocking_cli.cli import terminal, waiting
from rocking_cli.cli.options import OPENING
from rocking_cli.core import Mechanism
from rocking_cli.core.size import doubts as odd
from rocking_cli.errors import InputError, MechanismError, Problem, of_structure
from rocking_cli.excitation.records.opening import STANDARD_INPUT, name_of, original
from rocking_cli.io.yaml_file import decoded
from rocking_cli.structure_file import load_structure, parse_structure

if TYPE_CHECKING:
    from rocking_cli.ask.watcher import Watcher
    from rocking_cli.structure import Structure

HERE = "rocking.yaml"
DEFAULT = "mechanism: block\nname: default block, 0.7 m x 2.8 m\nwidth: 0.7\nheight: 2.8\n"


def load(files: Sequence[str]) -> list[Mechanism]:
    """Return the structures of files, - for standard input; without any, `rocking.yaml` here or the default block.

    Raises
    ------
    InputError
        With the problems of all files.
    """
    found: list[Mechanism] = []
    problems: list[Problem] = []
    for file in files or [""]:
        try:
            found.append(_read(file) if files else _unnamed())
        except InputError as error:
            problems += error.problems
        except MechanismError as error:
            raise of_structure(error, name_of(file)) from error
    if problems:
        raise InputError(*problems)
    for mechanism in found:
        warn(mechanism)
    limit = click.get_current_context().meta.get(OPENING)
    return found if limit is None else [each.model_copy(update={"opening": limit}) for each in found]


def warn(mechanism: Mechanism) -> None:
    """Warn of doubts about a structure, for any command."""
    if not mechanism.verified:
        terminal.warning(f"the mechanism {mechanism.mechanism} has not been verified: check its results yourself")
    for doubt in doubts(mechanism):
        terminal.warning(doubt)


def doubts(mechanism: Mechanism) -> list[str]:
    """Return the doubts about the sizes and places that were read."""
    return [f"{mechanism.name}: {doubt}" for doubt in odd(mechanism)]


def place(file: str | None) -> str | None:
    """Return the file of a structure, as named in messages; None for the default block."""
    return name_of(file) if file is not None else HERE if Path(HERE).exists() else None


def prepared(files: Sequence[str]) -> Structure:
    """Return the single structure of a file or of none, as `load`, prepared."""
    from rocking_cli.structure import Structure

    return Structure(load(files)[0], place(files[0] if files else None))


def several(files: Sequence[str], watch: Watcher) -> list[Structure]:
    """Return the structures of several files, prepared; those that cannot be used are left out."""
    from rocking_cli.ask.given import structures_of

    return structures_of(files, watch, lambda file: prepared([file]))


def stem(file: str | None) -> str:
    """Return the default name of files made from a structure, without suffix."""
    return "rocking" if file in (None, "", STANDARD_INPUT) else Path(str(file)).stem


def _read(file: str) -> Mechanism:
    """Return the structure of a file, or of standard input for `-`."""
    if file != STANDARD_INPUT:
        waiting.say_what_blocks_take(file)
        mechanism = load_structure(file)
        terminal.detail(f"structure: {mechanism.name} ({mechanism.mechanism}), of {Path(file).resolve()}")
        return mechanism
    name = name_of(file)
    return parse_structure(decoded(original(file), name, "structure"), name, "structure")


def _unnamed() -> Mechanism:
    if Path(HERE).exists():
        terminal.note(f"structure: {HERE} of this folder")
        return load_structure(HERE)
    terminal.note(f"structure: the default block, 0.7 m wide and 2.8 m high (no FILE given, no {HERE} here)")
    return parse_structure(DEFAULT, "default block", "default block")

"""What the folders of `questions` offer: the commands and the names of Python, found without importing any of them.

A folder `margin` with an `asked.py`, or a `command.py`, is the command `rocking margin`, and with a `verb.py` the verb
`rocking_cli.margin`. A `results_asked.py`, or a `results_command.py`, is a second command. The `__init__.py` says in
its first line what the command does, where it stands among the others (`PLACE`, the hundreds of which are the heading
in the help), which further names its modules offer (`MORE`), and what further commands do (`SHORT_HELP`).
"""

from __future__ import annotations

import re
from functools import cache
from importlib import import_module
from pkgutil import iter_modules
from typing import NamedTuple

QUESTIONS = "rocking_cli.questions"
HEADINGS = "Structures", "Ground motions", "Response", "Decisions", "Studies and installation"
ASKED = "asked"  # module name of the question of a command
COMMAND_SUFFIX = re.compile("_(asked|command)$")  # of the module of a second command of a folder: `results_asked`


class QuestionFolder(NamedTuple):
    """What a folder offers: its name, its place in the help, its modules, further names, and what its commands do."""

    name: str
    place: int
    files: list[str]
    more: dict[str, list[str]]
    shorts: dict[str, str]


@cache
def commands() -> dict[str, str]:
    """Return the module of each command, in the order in which a newcomer needs them."""
    listed = []
    for room in _rooms():
        modules = {room.name: next((file for file in ("command", ASKED) if file in room.files), "")}
        modules |= {COMMAND_SUFFIX.sub("", file): file for file in room.files if COMMAND_SUFFIX.search(file)}
        listed += [(room.place, name, f"{QUESTIONS}.{room.name}.{file}") for name, file in modules.items() if file]
    return {name: module for _, name, module in sorted(listed)}


def short_help(command: str) -> str:
    """Return what a command does, in a few words."""
    return next(room.shorts[command] for room in _rooms() if command in room.shorts)


def headed() -> dict[str, list[tuple[str, str]]]:
    """Return the commands under each heading of the help, and what they do in a few words."""
    place_of = {name: room.place for room in _rooms() for name in room.shorts}
    return {
        heading: [(name, short_help(name)) for name in commands() if place_of[name] // 100 == k]
        for k, heading in enumerate(HEADINGS, 1)
    }


@cache
def names() -> dict[str, str]:
    """Return the module of each name that the folders of `questions` offer in Python."""
    module_of: dict[str, str] = {}
    for room in _rooms():
        modules = {room.name: "verb"} if "verb" in room.files else {}
        modules |= {name: file for file, offered in room.more.items() for name in offered}
        module_of |= {name: f"{QUESTIONS}.{room.name}.{file}" for name, file in modules.items()}
    return module_of


@cache
def _rooms() -> list[QuestionFolder]:
    rooms = []
    for _, name, _ in iter_modules(import_module(QUESTIONS).__path__):
        package = import_module(f"{QUESTIONS}.{name}")
        files = [file for _, file, _ in iter_modules(package.__path__)]
        shorts = {name: package.__doc__ or "", **getattr(package, "SHORT_HELP", {})}
        rooms.append(QuestionFolder(name, package.PLACE, files, getattr(package, "MORE", {}), shorts))
    return rooms

"""What the folders of `questions` offer: the commands and the names of Python, found without importing any of them.

A folder `margin` with a `command.py` is the command `rocking margin`, and with a `verb.py` the verb
`rocking_cli.margin`. Its `__init__.py` says where the command stands among the others (`PLACE`), and which further
names its modules offer (`MORE`).
"""

from __future__ import annotations

from functools import cache
from importlib import import_module
from pkgutil import iter_modules

QUESTIONS = "rocking_cli.questions"
COMMAND_SUFFIX = "_command"  # module name of a second command of a folder: `results_command`


@cache
def commands() -> dict[str, str]:
    """Return the module of each command, in the order in which a newcomer needs them."""
    listed = []
    for room, place, files, _ in _rooms():
        modules = {room: "command"} | {
            file.removesuffix(COMMAND_SUFFIX): file for file in files if file.endswith(COMMAND_SUFFIX)
        }
        listed += [(place, name, f"{QUESTIONS}.{room}.{file}") for name, file in modules.items() if file in files]
    return {name: module for _, name, module in sorted(listed)}


@cache
def names() -> dict[str, str]:
    """Return the module of each name that the folders of `questions` offer in Python."""
    module_of: dict[str, str] = {}
    for room, _, files, more in _rooms():
        modules = {room: "verb"} if "verb" in files else {}
        modules |= {name: file for file, offered in more.items() for name in offered}
        module_of |= {name: f"{QUESTIONS}.{room}.{file}" for name, file in modules.items()}
    return module_of


@cache
def _rooms() -> list[tuple[str, int, list[str], dict[str, list[str]]]]:
    """Return for each folder its name, its place in the help, its modules, and the further names that these offer."""
    rooms = []
    for _, room, _ in iter_modules(import_module(QUESTIONS).__path__):
        package = import_module(f"{QUESTIONS}.{room}")
        files = [file for _, file, _ in iter_modules(package.__path__)]
        rooms.append((room, package.PLACE, files, getattr(package, "MORE", {})))
    return rooms

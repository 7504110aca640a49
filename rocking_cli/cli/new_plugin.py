"""`rocking new --plugin`: create a package for a mechanism of one's own."""

from __future__ import annotations

import builtins
import io
import os
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Collection
from importlib.resources import files
from keyword import iskeyword, issoftkeyword
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING
from unicodedata import normalize

from rocking_cli.cli import terminal
from rocking_cli.errors import InputError, Problem
from rocking_cli.text import cut

if TYPE_CHECKING:
    from rocking_cli.core import Mechanism

NAME = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")
LONGEST = 40  # characters of a name, so that no line of the package is too long
DEVICE = re.compile(r"con|prn|aux|nul|com\d|lpt\d")  # no file can have such a name on Windows
TEMPLATES = {
    "pyproject.toml": "package metadata, and the name by which rocking finds it",
    "rocking_my_mechanism.py": "the mechanism: change this",
    "tests/test_my_mechanism.py": "tests of the contract, and of a formula by hand",
    "README.md": "how to go on",
}
"""Files of the package; the words my_mechanism, MyMechanism and my-mechanism in them become the name."""
MODULE = "rocking_my_mechanism.py"
IMPORTED = ("ClassVar", "MechanismContract", "Self", "Sequence")
"""Classes that these files import, in addition to those of the core."""


def write(name: str, out: str | None, *, printed: Collection[str], as_json: bool) -> None:
    """Write the package, and print its files and the next commands.

    Parameters
    ----------
    name : str
        Name of the mechanism.
    out : str or None
        Folder of the package; None for one with its name, in this folder.
    printed : collection of str
        Names of other templates that `rocking new` prints.
    as_json : bool
        Whether to print one JSON object.

    Raises
    ------
    InputError
        If the name is not valid for a mechanism, or the folder cannot be made.
    """
    from rocking_cli.io.files import check_new_folder, write_folder
    from rocking_cli.views.plugin import view

    check_name(name, printed)
    folder = Path(f"rocking-{_hyphened(name)}" if out is None else out)
    check_new_folder(folder)
    described, contents = {_named(file, name): what for file, what in TEMPLATES.items()}, package(name)
    described |= {f"{name}.yaml": "a structure of it", f"{name}.png": "its picture"}
    write_folder(folder, contents)
    commands = [f"cd {_typed(str(folder))}"] if folder.resolve() != Path.cwd() else []
    commands += [
        f'{_python()} -m pip install --editable ".[test]"',
        f"rocking mechanisms --check {name}",
        f"rocking draw {name}.yaml",
        f"{_python()} -m pytest",
    ]
    terminal.show(view(name, str(folder), described, commands), as_json=as_json)
    if not as_json:
        terminal.sentence("Next:")
        for each in commands:
            terminal.result(f"  {each}")  # as it is: it is copied


def check_name(name: str, printed: Collection[str]) -> None:
    """Raise `InputError` if a text cannot be the name of a mechanism in a package of its own."""
    from rocking_cli.core.registry import Registry

    registry = Registry()
    if not NAME.fullmatch(name) or len(name) > LONGEST:
        guess = _spelled(name)
        free = NAME.fullmatch(guess) and guess not in registry and _taken(guess, printed) is None
        problem = f"{cut(repr(name))} cannot be the name of a mechanism"
        hint = f"use at most {LONGEST} of a-z, 0-9 and _, a letter first, such as {guess if free else 'leaning_pier'}"
        raise InputError(Problem(problem, hint=hint))
    if name in registry:
        owner = registry.package_of(name)
        hint = "take another name" + ("" if owner.startswith("rocking-cli ") else f", or uninstall {owner} first")
        raise InputError(Problem(f"the mechanism {name} already exists, in {owner}", hint=hint))
    if (why := _taken(name, printed)) is not None:
        raise InputError(Problem(f"a mechanism cannot be called {name}: {why}", hint="take another name"))


def _spelled(name: str) -> str:
    """Return a valid name of the same letters, as far as possible."""
    plain = normalize("NFKD", name.lower()).encode("ascii", "ignore").decode()
    return re.sub(r"[^a-z0-9]+", "_", plain).lstrip("_0123456789")[:LONGEST].rstrip("_")


def _taken(name: str, printed: Collection[str]) -> str | None:
    """Return why a well-spelled name is not free, or None if it is."""
    import yaml

    from rocking_cli import core
    from rocking_cli.cli.mechanisms import PARTS

    if name == "cli":
        return "its module would be rocking_cli, the name of this program"
    if iskeyword(name) or issoftkeyword(name):
        return "it is a keyword of Python"
    if not isinstance(yaml.safe_load(name), str):
        return "in a structure file this word is not read as text"
    if name in sys.stdlib_module_names:
        return "Python has a module of this name"
    if name in printed:
        return f"`rocking new {name}` prints something else"
    if name in PARTS:
        return f"`rocking mechanisms {name}` shows something else"
    if DEVICE.fullmatch(name):
        return "it is not a valid file name on Windows"
    cls = _of_class(name)
    if cls.startswith("Test"):
        return f"its class would be {cls}, which pytest collects as tests"
    if cls in IMPORTED or hasattr(core, cls) or hasattr(builtins, cls):
        return f"its class would be {cls}, which already exists"
    return None


def package(name: str) -> dict[str, bytes]:
    """Return the files of the package for a mechanism of this name, with the drawing of its example.

    Parameters
    ----------
    name : str
        Name that has passed `check_name`.

    Returns
    -------
    dict of str to bytes
        Content of each file, by its path in the folder.
    """
    from rocking_cli.views.template import template

    texts = {_named(file, name): _named(_text(file), name) for file in TEMPLATES}
    cls = loaded(texts[_named(MODULE, name)], _named(MODULE, name))
    texts[f"{name}.yaml"] = template(cls)
    return {file: text.encode() for file, text in texts.items()} | {f"{name}.png": _drawn(cls, name)}


def loaded(text: str, file: str) -> type[Mechanism]:
    """Return the mechanism of a module that is not installed yet."""
    from rocking_cli.core import Mechanism

    module = ModuleType(Path(file).stem)
    before = sys.modules.get(module.__name__)
    sys.modules[module.__name__] = module  # where the types of its fields are looked for
    try:
        exec(compile(text, file, "exec", dont_inherit=True), module.__dict__)
    finally:
        del sys.modules[module.__name__]
        if before is not None:
            sys.modules[module.__name__] = before
    (cls,) = (each for each in vars(module).values() if isinstance(each, type) and each.__module__ == module.__name__)
    assert issubclass(cls, Mechanism)
    return cls


def _drawn(cls: type[Mechanism], name: str) -> bytes:
    """Return the drawing by `rocking draw` of the structure of its examples."""
    from rocking_cli.plotting import style
    from rocking_cli.plotting.structure import draw_structure
    from rocking_cli.studies.picture import picture
    from rocking_cli.views.mechanisms import fields
    from rocking_cli.views.view import heading

    examples = {row["field"]: row["example"] for row in fields(cls) if row["required"]}
    structure = cls.from_fields({"name": name, **examples})
    stream = io.BytesIO()
    style.save(draw_structure(picture(structure), heading(structure)), stream, format="png")
    return stream.getvalue()


def _text(file: str) -> str:
    return (files("rocking_cli") / "data" / "plugin" / f"{file}.txt").read_text(encoding="utf-8")


def _named(text: str, name: str) -> str:
    """Return a text of the package with its name instead of that of the template."""
    words = {
        "my_mechanism": name,
        "MyMechanism": _of_class(name),
        "my-mechanism": _hyphened(name),
        "my mechanism": name.replace("_", " "),
    }
    return re.sub("|".join(words), lambda found: words[found[0]], text)


def _hyphened(name: str) -> str:
    return name.replace("_", "-")


def _of_class(name: str) -> str:
    return "".join(word[0].upper() + word[1:] for word in name.split("_"))


def _python() -> str:
    """Return the command of the Python that has rocking-cli: `python`, unless that is another one here."""
    found = shutil.which("python")
    same = found is not None and Path(found).parent == Path(sys.executable).parent
    return "python" if same or not sys.executable else _typed(sys.executable)


def _typed(word: str) -> str:
    """Return a word as it is typed in a shell."""
    return subprocess.list2cmdline([word]) if os.name == "nt" else shlex.quote(word)

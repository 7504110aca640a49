"""`rocking new --plugin`: copy an example package for a mechanism, or a code of practice, under another name."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from pathlib import Path

from rocking_cli.cli import terminal
from rocking_cli.errors import InputError, Problem
from rocking_cli.text import cut

NAME_PATTERN = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")
MAX_NAME_LENGTH = 40  # characters, so that no line of the package is too long


@dataclass(frozen=True)
class PluginKind:
    """Kind of plugin that a package is written for: a mechanism or a code.

    Parameters
    ----------
    word : str
        Name of the kind.
    folder : str
        Folder of its example package.
    example : str
        Name in the example: capped_block, CappedBlock, capped-block and "capped block" become the given name.
    files : mapping of str to str
        Description of each file of the example, by its path.
    commands : tuple of str
        The commands with which to try the example.
    """

    word: str
    folder: str
    example: str
    files: Mapping[str, str]
    commands: tuple[str, ...]

    def named(self, text: str, name: str) -> str:
        """Return a text of the example with another name."""
        spellings: tuple[Callable[[str], str], ...] = (str, of_class, _hyphened, lambda word: word.replace("_", " "))
        words = {spell(self.example): spell(name) for spell in spellings}
        return re.sub("|".join(words), lambda found: words[found[0]], text)

    def package(self, name: str) -> dict[str, bytes]:
        """Return the files of the package for a plugin of this name, by their paths in the folder."""
        package = Path(__file__).parents[2]
        source = package / "data" / self.folder
        if not source.is_dir():  # a checkout has the files in examples/
            source = package.parent / "examples" / self.folder
        return {
            self.named(file, name): self.named((source / file).read_text(encoding="utf-8"), name).encode()
            for file in self.files
        }


MECHANISM = PluginKind(
    word="mechanism",
    folder="plugin",
    example="capped_block",
    files={
        "pyproject.toml": "package metadata, and the name by which rocking finds it",
        "rocking_capped_block.py": "the mechanism: change this",
        "tests/test_capped_block.py": "tests of the contract, and of a formula by hand",
        "README.md": "how to go on",
        "capped_block.yaml": "a structure of it",
    },
    commands=("rocking mechanisms --check capped_block", "rocking draw capped_block.yaml"),
)
CODE = PluginKind(
    word="code",
    folder="plugin_code",
    example="my_code",
    files={
        "pyproject.toml": "package metadata, and the name by which rocking finds it",
        "rocking_my_code.py": "the code: change this",
        "tests/test_my_code.py": "tests of the contract, and of numbers by hand",
        "README.md": "how to go on",
        "site.yaml": "a site for it",
    },
    commands=("rocking verify --site site.yaml",),
)


def write(name: str, out: str | None, kind: PluginKind, *, printed: Collection[str], as_json: bool) -> None:
    """Write the package, and print its files and the next commands.

    Parameters
    ----------
    name : str
        Name of the mechanism or code.
    out : str or None
        Folder of the package; None for one with its name, in this folder.
    kind : PluginKind
        `MECHANISM` or `CODE`.
    printed : collection of str
        Names of other templates that `rocking new` prints.
    as_json : bool
        Whether to print one JSON object.

    Raises
    ------
    InputError
        If the name is not valid, or the folder cannot be made.
    """
    from rocking_cli.io.files import write_folder
    from rocking_cli.views.column import table_of, text_columns
    from rocking_cli.views.view import View

    check_name(name, kind, printed)
    folder = Path(f"rocking-{_hyphened(name)}" if out is None else out)
    write_folder(folder, kind.package(name))
    interpreter = shutil.which("python")  # the interpreter with rocking-cli
    here = interpreter is not None and Path(interpreter).parent == Path(sys.executable).parent
    python = "python" if here or not sys.executable else quoted(sys.executable)
    commands = [f"cd {quoted(str(folder))}"] if folder.resolve() != Path.cwd() else []
    commands += [f'{python} -m pip install --editable ".[test]"']
    commands += [kind.named(each, name) for each in kind.commands] + [f"{python} -m pytest"]
    described = {kind.named(file, name): what for file, what in kind.files.items()}
    title = f"{folder}: template of the {kind.word} {name}"
    table = table_of(title, text_columns("file", "description"), list(described.items()))
    data = {"plugin": name, "folder": str(folder), "files": list(described), "commands": commands}
    terminal.show(View(data, [table]), as_json=as_json)
    if not as_json:
        terminal.sentence("Next:")
        for each in commands:
            terminal.result(f"  {each}")  # without wrapping, so that it can be copied


def check_name(name: str, kind: PluginKind, printed: Collection[str]) -> None:
    """Raise `InputError` if a text cannot be the name of a mechanism, or code, in a package of its own."""
    import yaml

    from rocking_cli.core.registry import Registry
    from rocking_cli.questions.mechanisms.command import PARTS
    from rocking_cli.verification.code import Codes

    if not NAME_PATTERN.fullmatch(name) or len(name) > MAX_NAME_LENGTH:
        guess = (
            re.sub(r"[^a-z0-9]+", "_", name.lower()).lstrip("_0123456789")[:MAX_NAME_LENGTH].rstrip("_") or kind.example
        )
        hint = f"use at most {MAX_NAME_LENGTH} of a-z, 0-9 and _, a letter first, such as {guess}"
        raise InputError(Problem(f"{cut(repr(name))} cannot be the name of a {kind.word}", hint=hint))
    for word, installed in (("mechanism", Registry()), ("code", Codes())):
        if name in installed:
            owner = installed.package_of(name)
            hint = "take another name" + ("" if owner.startswith("rocking-cli ") else f", or uninstall {owner} first")
            raise InputError(Problem(f"the {word} {name} already exists, in {owner}", hint=hint))
    why, text = None, b"".join(kind.package(kind.example).values()).decode()
    if not isinstance(yaml.safe_load(name), str):
        why = "in a YAML file this word is not read as text"
    elif kind is MECHANISM and name in printed:
        why = f"`rocking new {name}` prints something else"
    elif kind is MECHANISM and name in PARTS:
        why = f"`rocking mechanisms {name}` shows something else"
    elif taken := re.search(rf"\b({of_class(name)}|rocking_{name})\b", text):
        why = f"in the package {taken[0]} already means something else"
    if why is not None and name != kind.example:
        raise InputError(Problem(f"a {kind.word} cannot be called {name}: {why}", hint="take another name"))


def of_class(name: str) -> str:
    """Return the name of the class of a mechanism or code."""
    return "".join(word[0].upper() + word[1:] for word in name.split("_"))


def quoted(word: str) -> str:
    """Return a word as it is typed in a shell."""
    return subprocess.list2cmdline([word]) if os.name == "nt" else shlex.quote(word)


def _hyphened(name: str) -> str:
    return name.replace("_", "-")

"""`rocking new --plugin`: create a package for a mechanism, or a code of practice, of one's own."""

from __future__ import annotations

import builtins
import io
import os
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from importlib.resources import files
from keyword import iskeyword, issoftkeyword
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any
from unicodedata import normalize

from rocking_cli.cli import terminal
from rocking_cli.errors import InputError, Problem
from rocking_cli.text import cut

if TYPE_CHECKING:
    from rocking_cli.core import Mechanism
    from rocking_cli.studies.verification.code import Code

NAME = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")
LONGEST = 40  # characters of a name, so that no line of the package is too long
DEVICE = re.compile(r"con|prn|aux|nul|com\d|lpt\d")  # no file can have such a name on Windows
IMPORTED = ("ClassVar", "CodeContract", "MechanismContract", "Self", "Sequence", "SiteFields")
"""Classes of these files, and those that they import, in addition to those of the core and of verifications."""


@dataclass(frozen=True)
class PluginKind:
    """Kind of plugin that a package is written for: a mechanism or a code.

    Parameters
    ----------
    word : str
        Name of the kind.
    folder : str
        Folder of its template files, in the data of this package.
    placeholder : str
        Name in the template files: my_mechanism, MyMechanism, my-mechanism and "my mechanism" are replaced by the given
        name.
    files : mapping of str to str
        Description of each template file, by its name.
    examples : mapping of str to str
        Description of each file that the program generates, by its name.
    made : callable
        Returns the content of the generated files, for a class and its name.
    commands : callable
        Returns the commands with which to try the plugin.
    file : str
        Kind of files in which users write its name.
    example : str
        An example of a valid name.
    """

    word: str
    folder: str
    placeholder: str
    files: Mapping[str, str]
    examples: Mapping[str, str]
    made: Callable[[Any, str], dict[str, bytes]]
    commands: Callable[[str], list[str]]
    file: str
    example: str

    @property
    def module(self) -> str:
        """File name of the module with the class."""
        return f"rocking_{self.placeholder}.py"

    def named(self, text: str, name: str) -> str:
        """Return a text of the package with its name instead of the placeholder."""
        spellings: tuple[Callable[[str], str], ...] = (str, of_class, _hyphened, _spaced)
        words = {spell(self.placeholder): spell(name) for spell in spellings}
        return re.sub("|".join(words), lambda found: words[found[0]], text)

    def text(self, file: str, name: str) -> str:
        """Return a file of the package."""
        content = (files("rocking_cli") / "data" / self.folder / f"{file}.txt").read_text(encoding="utf-8")
        return self.named(content, name)


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
    from rocking_cli.io.files import check_new_folder, write_folder
    from rocking_cli.views.plugin import view

    check_name(name, kind, printed)
    folder = Path(f"rocking-{_hyphened(name)}" if out is None else out)
    check_new_folder(folder)
    described = {kind.named(file, name): what for file, what in {**kind.files, **kind.examples}.items()}
    write_folder(folder, package(name, kind))
    commands = [f"cd {quoted(str(folder))}"] if folder.resolve() != Path.cwd() else []
    commands += [
        f'{_python()} -m pip install --editable ".[test]"',
        *kind.commands(name),
        f"{_python()} -m pytest",
    ]
    terminal.show(view(name, kind.word, str(folder), described, commands), as_json=as_json)
    if not as_json:
        terminal.sentence("Next:")
        for each in commands:
            terminal.result(f"  {each}")  # as it is: it is copied


def check_name(name: str, kind: PluginKind, printed: Collection[str]) -> None:
    """Raise `InputError` if a text cannot be the name of a mechanism, or code, in a package of its own."""
    from rocking_cli.core.registry import Registry
    from rocking_cli.studies.verification.installed import Codes

    registry = Registry()
    if not NAME.fullmatch(name) or len(name) > LONGEST:
        guess = _spelled(name)
        free = NAME.fullmatch(guess) and guess not in registry and _taken(guess, kind, printed) is None
        problem = f"{cut(repr(name))} cannot be the name of a {kind.word}"
        hint = f"use at most {LONGEST} of a-z, 0-9 and _, a letter first, such as {guess if free else kind.example}"
        raise InputError(Problem(problem, hint=hint))
    for word, installed in (("mechanism", registry), ("code", Codes())):
        if name in installed:
            owner = installed.package_of(name)
            hint = "take another name" + ("" if owner.startswith("rocking-cli ") else f", or uninstall {owner} first")
            raise InputError(Problem(f"the {word} {name} already exists, in {owner}", hint=hint))
    if (why := _taken(name, kind, printed)) is not None:
        raise InputError(Problem(f"a {kind.word} cannot be called {name}: {why}", hint="take another name"))


def _spelled(name: str) -> str:
    """Return a valid name of the same letters, as far as possible."""
    plain = normalize("NFKD", name.lower()).encode("ascii", "ignore").decode()
    return re.sub(r"[^a-z0-9]+", "_", plain).lstrip("_0123456789")[:LONGEST].rstrip("_")


def _taken(name: str, kind: PluginKind, printed: Collection[str]) -> str | None:
    """Return why a well-spelled name is not free, or None if it is."""
    import yaml

    from rocking_cli import core
    from rocking_cli.cli.mechanisms import PARTS
    from rocking_cli.studies import verification

    if name == "cli":
        return "its module would be rocking_cli, the name of this program"
    if iskeyword(name) or issoftkeyword(name):
        return "it is a keyword of Python"
    if not isinstance(yaml.safe_load(name), str):
        return f"in a {kind.file} file this word is not read as text"
    if name in sys.stdlib_module_names:
        return "Python has a module of this name"
    if kind is MECHANISM and name in printed:
        return f"`rocking new {name}` prints something else"
    if kind is MECHANISM and name in PARTS:
        return f"`rocking mechanisms {name}` shows something else"
    if DEVICE.fullmatch(name):
        return "it is not a valid file name on Windows"
    cls = of_class(name)
    if cls.startswith("Test"):
        return f"its class would be {cls}, which pytest collects as tests"
    if cls in IMPORTED or any(hasattr(each, cls) for each in (core, verification, builtins)):
        return f"its class would be {cls}, which already exists"
    return None


def package(name: str, kind: PluginKind | None = None) -> dict[str, bytes]:
    """Return the files of the package for a mechanism, or code, of this name, with its example.

    Parameters
    ----------
    name : str
        Name that has passed `check_name`.
    kind : PluginKind, optional
        By default `MECHANISM`.

    Returns
    -------
    dict of str to bytes
        Content of each file, by its path in the folder.
    """
    kind = kind or MECHANISM
    texts = {kind.named(file, name): kind.text(file, name) for file in kind.files}
    module = kind.named(kind.module, name)
    return {file: text.encode() for file, text in texts.items()} | kind.made(loaded(texts[module], module), name)


def loaded(text: str, file: str) -> type[Any]:
    """Return the class of a module that is not installed yet: the last one in it."""
    module = ModuleType(Path(file).stem)
    before = sys.modules.get(module.__name__)
    sys.modules[module.__name__] = module  # where the types of its fields are looked for
    try:
        exec(compile(text, file, "exec", dont_inherit=True), module.__dict__)
    finally:
        del sys.modules[module.__name__]
        if before is not None:
            sys.modules[module.__name__] = before
    own = [each for each in vars(module).values() if isinstance(each, type) and each.__module__ == module.__name__]
    return own[-1]


def _of_mechanism(cls: type[Mechanism], name: str) -> dict[str, bytes]:
    from rocking_cli.views.template import template

    return {f"{name}.yaml": template(cls).encode(), f"{name}.png": _drawn(cls, name)}


def _of_code(cls: type[Code], name: str) -> dict[str, bytes]:
    from rocking_cli.views.template import starter

    commands = [f"rocking new site --code {name} > site.yaml", "rocking verify --site site.yaml"]
    return {"site.yaml": starter(cls(), commands).encode()}


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


def _hyphened(name: str) -> str:
    return name.replace("_", "-")


def _spaced(name: str) -> str:
    return name.replace("_", " ")


def of_class(name: str) -> str:
    """Return the name of the class of a mechanism or code."""
    return "".join(word[0].upper() + word[1:] for word in name.split("_"))


def _python() -> str:
    """Return the command of the Python that has rocking-cli: `python`, unless that is another one here."""
    found = shutil.which("python")
    same = found is not None and Path(found).parent == Path(sys.executable).parent
    return "python" if same or not sys.executable else quoted(sys.executable)


def quoted(word: str) -> str:
    """Return a word as it is typed in a shell."""
    return subprocess.list2cmdline([word]) if os.name == "nt" else shlex.quote(word)


MECHANISM = PluginKind(
    word="mechanism",
    folder="plugin",
    placeholder="my_mechanism",
    files={
        "pyproject.toml": "package metadata, and the name by which rocking finds it",
        "rocking_my_mechanism.py": "the mechanism: change this",
        "tests/test_my_mechanism.py": "tests of the contract, and of a formula by hand",
        "README.md": "how to go on",
    },
    examples={"my_mechanism.yaml": "a structure of it", "my_mechanism.png": "its picture"},
    made=_of_mechanism,
    commands=lambda name: [f"rocking mechanisms --check {name}", f"rocking draw {name}.yaml"],
    file="structure",
    example="leaning_pier",
)
CODE = PluginKind(
    word="code",
    folder="plugin_code",
    placeholder="my_code",
    files={
        "pyproject.toml": "package metadata, and the name by which rocking finds it",
        "rocking_my_code.py": "the code: change this",
        "tests/test_my_code.py": "tests of the contract, and of numbers by hand",
        "README.md": "how to go on",
    },
    examples={"site.yaml": "a site for it"},
    made=_of_code,
    commands=lambda name: ["rocking verify --site site.yaml"],
    file="site",
    example="my_code",
)

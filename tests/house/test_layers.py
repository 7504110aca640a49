"""What layers may say: the import contracts hold what they may know."""

import ast
import re
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

import pytest

import rocking_cli

ROOT = Path(rocking_cli.__file__).resolve().parents[1]
FLAG = re.compile(r"(?<![\w-])--[a-z][a-z-]*")


@pytest.fixture(scope="module")
def package():
    """The text of every file of the package and of its mechanisms, by its place in the project."""
    return texts_of("rocking_cli/**/*.py", "mechanisms/**/*.py")


def texts_of(*patterns):
    """Return the text of every file of some patterns, by its place in the project."""
    files = sorted(file for pattern in patterns for file in ROOT.glob(pattern))
    return {file.relative_to(ROOT).as_posix(): file.read_text(encoding="utf-8") for file in files}


def parsed(files, holding):
    """Return the syntax of the files that hold an expression, as most hold none."""
    return {place: ast.parse(text) for place, text in files.items() if re.search(holding, text)}


def imports(tree, modules):
    """Return whether a file imports one of some modules."""
    nodes = list(ast.walk(tree))
    names = {alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names}
    return not modules.isdisjoint(names | {node.module for node in nodes if isinstance(node, ast.ImportFrom)})


def texts(tree):
    """Yield all texts in a file, with their lines."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.lineno, node.value


def test_no_layer_below_the_command_line_knows_a_flag(package):
    """Messages name arguments, in backticks, and the command line spells them as they are typed."""
    found = [
        f"{place}:{line}: {text}"
        for place, tree in parsed(package, FLAG).items()
        if not (imports(tree, {"click", "rocking_cli.cli"}) or place.endswith(("asked.py", "/options.py")))
        for line, text in texts(tree)  # questions show how their commands are typed
        if FLAG.search(text)
    ]
    assert len(package) > 300 and not found, "\n".join(found)


def test_no_layer_below_the_questions_imports_by_the_name_of_the_package(package):
    """The root fetches its names from the questions, which the contract on layers does not see."""
    modules = {path.stem for path in (ROOT / "rocking_cli").iterdir()}
    found = [
        f"{place}:{node.lineno}: {alias.name}"
        for place, tree in parsed(package, r"from rocking_cli import").items()
        if not place.startswith(("rocking_cli/cli/", "rocking_cli/questions/"))
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and node.module == "rocking_cli" and node.level == 0
        for alias in node.names
        if alias.name not in modules and not alias.name.startswith("__")
    ]
    assert not found, "\n".join(found)


def test_a_question_draws_its_own_pictures(package):
    """A picture is imported by its name when it is drawn, which the contract on questions does not see."""
    found = [
        (place.split("/")[2], part.value.split(".")[1])
        for place, tree in parsed(package, r"drawn\(").items()
        if place.startswith("rocking_cli/questions/")
        for node in ast.walk(tree)
        if isinstance(node, ast.Call) and ast.unparse(node.func) == "drawn"
        for part in ast.walk(node)
        if isinstance(part, ast.Constant) and str(part.value).startswith("questions.")
    ]
    assert len(found) > 10 and {pair for pair in found if pair[0] != pair[1]} == {
        ("animate", "respond"), ("draw", "building"),
    }  # fmt: skip


# Classes that share a name: plugins import the load of `rocking_cli.core`, users the mechanism of `rocking_cli`; the
# shipped kernels are made of the text of theirs.
SHARED = {
    "PointMass": {"mechanisms/point_mass.py", "rocking_cli/core/hung/attached.py"},
    "Structure": {"rocking_cli/dynamics/kernels.py", "rocking_cli/structure.py"},
}


def test_no_class_name_is_defined_in_two_files(package):
    """One name for one thing, see `docs/architecture.md`."""
    homes: dict[str, set[str]] = {}
    for place, text in package.items():
        for name in re.findall(r"(?m)^ *class (\w+)", text):
            homes.setdefault(name, set()).add(place)
    assert {name: files for name, files in homes.items() if len(files) > 1} == SHARED


def test_views_declare_the_rows_of_their_tables(package):
    """Tables are made of columns in `views/column.py`, or read from the templates of a sheet, in each language."""
    by_hand = [place for place, text in package.items() if re.search(r"(?<![.\w])Table\(", text)]
    others = {place for place in by_hand if "/codes/italian/" not in place}
    assert others == {"rocking_cli/views/column.py", "rocking_cli/views/sheet/document.py"}


def imported(tree):
    """Yield line, module and name of what a file imports of the project, also in code that it hands to a process."""
    for line, text in texts(tree):
        for module, names in re.findall(r"from (rocking_cli[\w.]*) import ([\w, ]+)", text):
            yield from ((line, module, name.strip()) for name in names.split(","))
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith(("rocking_cli", "mechanisms")):
            yield from ((node.lineno, node.module, each.name) for each in node.names)


def is_there(module, name):
    """Return whether a module has a name, or a module of that name."""
    try:
        return hasattr(import_module(module), name) or bool(import_module(f"{module}.{name}"))
    except ImportError:
        return False


def test_what_stands_beside_the_package_imports_what_there_is():
    """They run seldom: a name that has changed would be seen late."""
    beside = parsed(texts_of("benchmarks/*.py", "docs/*.py", "scripts/*.py"), "import")
    named = {
        (module, name): f"{place}:{line}: {module} has no {name}"
        for place, tree in beside.items()
        for line, module, name in imported(tree)
    }
    assert len(beside) > 10 and len(named) > 10
    found = [said for each, said in named.items() if not is_there(*each)]
    assert not found, "\n".join(found)


def _imported(path: Path) -> Iterator[str]:
    """All that a file imports, anywhere in it, by full names."""
    package = path.relative_to(ROOT).parent.parts
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (each.name for each in node.names)
        elif isinstance(node, ast.ImportFrom):
            above = package[: len(package) + 1 - node.level] if node.level else ()
            module = ".".join([*above, *filter(None, [node.module])])
            yield from (f"{module}.{each.name}" for each in node.names)
            yield module


def test_the_oracle_shares_no_code_with_the_project():
    """Nor does what it imports of the other tests."""
    files = sorted((ROOT / "tests" / "oracle").glob("*.py"))
    assert len(files) > 5
    for path in files:  # longer by what they import
        for name in _imported(path):
            assert name.split(".")[0] not in ("rocking_cli", "mechanisms"), f"{path.name} imports {name}"
            module = ROOT.joinpath(*name.split("."))
            found = {module.with_suffix(".py"), module / "__init__.py"}
            files += [each for each in sorted(found) if each.is_file() and each not in files]

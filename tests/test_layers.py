"""What layers may say: the import contracts hold what they may know."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

import pytest

import mechanisms
import rocking_cli

FLAG = re.compile(r"(?<![\w-])--[a-z][a-z-]*")
BELOW = [
    path
    for package in (rocking_cli, mechanisms)
    for path in sorted(Path(package.__file__).parent.rglob("*.py"))
    if "cli" not in path.relative_to(Path(package.__file__).parent).parts
]


@pytest.mark.parametrize("path", BELOW, ids=lambda path: "/".join(path.parts[-2:]))
def test_no_layer_below_the_command_line_knows_a_flag(path):
    """Messages name arguments, in backticks, and the command line spells them as they are typed."""
    texts = (node for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))) if isinstance(node, ast.Constant))
    found = [(node.lineno, node.value) for node in texts if isinstance(node.value, str) and FLAG.search(node.value)]
    assert not found


# Classes that share a name: plugins import the load of `rocking_cli.core`, users the mechanism of `rocking_cli`; the
# shipped kernels are made of the text of theirs.
SHARED = {
    "PointMass": {"mechanisms/point_mass.py", "rocking_cli/core/hung/attached.py"},
    "Structure": {"rocking_cli/dynamics/kernels.py", "rocking_cli/structure.py"},
}


def test_no_class_name_is_defined_in_two_files():
    """One name for one thing, see `docs/architecture.md#names`."""
    homes: dict[str, set[str]] = {}
    for package in (rocking_cli, mechanisms):
        folder = Path(package.__file__).parent
        for path in sorted(folder.rglob("*.py")):
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(node, ast.ClassDef):
                    homes.setdefault(node.name, set()).add(path.relative_to(folder.parent).as_posix())
    assert {name: files for name, files in homes.items() if len(files) > 1} == SHARED


ROOT = Path(rocking_cli.__file__).resolve().parents[1]
BESIDE = [path for folder in ("benchmarks", "docs", "scripts") for path in sorted((ROOT / folder).glob("*.py"))]


@pytest.mark.parametrize("path", BESIDE, ids=lambda path: "/".join(path.parts[-2:]))
def test_what_stands_beside_the_package_imports_what_there_is(path):
    """They run seldom: a name that has changed would be seen late, also in code that is handed to another process."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    texts = [node.value for node in ast.walk(tree) if isinstance(node, ast.Constant) and isinstance(node.value, str)]
    handed = [found for text in texts for found in re.findall(r"from (rocking_cli[\w.]*) import ([\w, ]+)", text)]
    named = [(module, name.strip()) for module, names in handed for name in names.split(",")]
    named += [
        (node.module, each.name)
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith(("rocking_cli", "mechanisms"))
        for each in node.names
    ]
    for module, name in named:
        if not hasattr(import_module(module), name):
            import_module(f"{module}.{name}")


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

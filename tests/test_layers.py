"""What layers may say: the import contracts hold what they may know."""

from __future__ import annotations

import ast
import re
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

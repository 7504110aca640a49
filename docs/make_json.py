"""The page on JSON: the keys that each command prints, as the tests hold them, with meanings that the code declares."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator
from importlib import import_module
from inspect import getdoc, isclass
from pathlib import Path
from pkgutil import walk_packages
from typing import Any

from make_reference import plain

import rocking_cli
from rocking_cli.studies.conclusion import Conclusion, NextStep
from rocking_cli.views.column import Column
from rocking_cli.views.conclusion import NEXT_STEPS

HELD = Path(__file__).resolve().parents[1] / "tests" / "json_keys.txt"  # `scripts/outputs.py keys` writes it
INDENT = "  "
FIELD = re.compile(r"^(?P<names>\w+(?:, \w+)*) : .*\n(?P<meaning>(?:    .*\n?)+)", re.M)
HEAD = """\
# JSON of the commands

With `--json`, a command prints one JSON object on a line for each structure, motion or study, and nothing else on
standard output. Values are in SI units and radians, accelerations of the ground whose keys end in `_g` in units of g. A
value that does not exist is null. `given` has the options that were given. Which keys an object has depends on the
question; a meaning is given if the code declares one.
"""
NEXT = "## Values of `next`\n\nWhat to do next, the most useful step first:\n\n{}\n"
Tree = dict[str, Any]


def page() -> str:
    """Return the page."""
    every = [each for module in modules() for each in vars(module).values()]
    groups = [group for each in every if (group := declared(each)) and (not isclass(each) or len(group) > 2)]
    parts = [HEAD]
    for command, tree in sorted(held().items()):
        parts += [f"## rocking {command}", "\n".join(listed(tree, groups))]
    steps = "\n".join(f"- `{each}`: {plain(NEXT_STEPS[each])}" for each in NextStep)
    return "\n\n".join([*parts, NEXT.format(steps)])


def held() -> dict[str, Tree]:
    """Return the keys of each command as trees, those of all its questions together."""
    trees: dict[str, Tree] = defaultdict(dict)
    path: list[Tree] = []
    for line in filter(str.strip, HELD.read_text(encoding="utf-8").splitlines()):
        depth, name = (len(line) - len(line.lstrip())) // len(INDENT), line.split()[0]
        path = [*path[:depth], trees[name] if depth == 0 else path[depth - 1].setdefault(name, {})]
    return trees


def listed(tree: Tree, groups: list[dict[str, str]], depth: int = 0) -> Iterator[str]:
    """Yield the lines of a tree of keys; one that is equal to an earlier one beside it is not repeated."""
    meanings = meant(frozenset(name.removesuffix("[]") for name in tree), groups)
    earlier: list[tuple[str, Tree]] = []
    for name, keys in sorted(tree.items()):
        equal = next((other for other, there in earlier if keys and there == keys), None)
        meaning = f"as `{equal}`" if equal else plain(meanings.get(name.removesuffix("[]"), ""))
        yield f"{INDENT * depth}- `{name}`{': ' * bool(meaning)}{meaning}"
        if equal is None:
            earlier.append((name, keys))
            yield from listed(keys, groups, depth + 1)


def meant(keys: frozenset[str], groups: list[dict[str, str]]) -> dict[str, str]:
    """Return the meanings of keys that stand together.

    They are those of columns, or of three or more fields of a class, that are all among them, and of the class or
    columns that declare most of them, if half.
    """
    best = max(groups, key=lambda group: (len(keys & group.keys()), -len(group)))
    if 2 * len(keys & best.keys()) < max(len(keys), 4):
        best = {}
    inside = (group for group in groups if group.keys() <= keys and all(group.values()))
    return {key: text for group in inside for key, text in group.items()} | best


def modules() -> Iterator[Any]:
    """Yield the modules of the package."""
    for found in walk_packages(rocking_cli.__path__, "rocking_cli."):
        if not found.name.endswith("__main__"):
            yield import_module(found.name)


def declared(each: Any) -> dict[str, str]:
    """Return the keys and meanings that a class or columns declare."""
    if isclass(each) and (each is Column or not each.__module__.startswith("rocking_cli")):
        return {}
    if isclass(each):
        fields = FIELD.finditer(getdoc(each) or "")
        texts = {field["names"]: " ".join(field["meaning"].split()).rstrip(".") for field in fields}
        texts = {names: re.sub(r"\b(None|NaN)\b", "null", text) for names, text in texts.items()}
        texts |= {"next": "What to do next, see the end of this page"} if each is Conclusion else {}
        return {name: text if names == name else "" for names, text in texts.items() for name in names.split(", ")}
    every = each if isinstance(each, tuple | list) else [each]
    columns = [column for column in every if isinstance(column, Column)]
    texts = {column.key or "": (getattr(column, "meaning", "") or column.words, column.unit) for column in columns}
    return {key: " ".join([text.rstrip("."), f"[{unit}]" * bool(unit)]).strip() for key, (text, unit) in texts.items()}

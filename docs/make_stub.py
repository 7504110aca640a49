"""Writes rocking_cli/__init__.pyi, which tells type checkers and editors the names that the package provides.

    python docs/make_stub.py              # part of make pages

The package imports nothing until a name is used, and no mechanism by name; the stub says where each is, and which
arguments a verb has, as its model says.
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Mapping
from importlib import import_module
from importlib.metadata import distribution
from inspect import Parameter, signature
from pathlib import Path
from textwrap import indent
from typing import Any

import rocking_cli
from rocking_cli.ask.asked import choices, owner_of, told_of
from rocking_cli.plugins.rooms import names

SEVERAL = "list[Any] | tuple[Any, ...]"
"""Type of several motions or structures; a sequence may be one text."""
STUB = Path(rocking_cli.__file__).with_suffix(".pyi")


def stub() -> str:
    """Return the text of the stub."""
    own = distribution("rocking-cli").entry_points.select(group="rocking.mechanisms")
    found = [(point.module, point.attr) for point in own]
    homes = {name: f"rocking_cli.{home}" for home, names in rocking_cli._HOME.items() for name in names}
    verbs = {}
    for name, module in (homes | names()).items():
        each = getattr(import_module(module), name)
        if hasattr(each, "model"):
            verbs[name] = each
        else:
            found.append((module, name))
    imports = {name: f"from {module} import {name} as {name}" for module, name in sorted(found)}
    texts = [written(name, each, imports) for name, each in verbs.items()]
    lines = ['"""Written by `make pages`: do not edit."""', "", *sorted(imports.values()), ""]
    return "\n".join([*lines, *texts, "__version__: str", "mechanisms: Registry", ""])


def written(name: str, verb: Any, imports: dict[str, str]) -> str:
    """Return the text of a verb, and add what its types import.

    One that answers several motions or structures by several answers is overloaded: for one of each, for several of
    one of them, and for what may be either, as a pattern of files is.
    """
    parameters = signature(verb).parameters
    types = {each: typed(verb.model, each) for each in parameters if each != "watch"} | {"watch": "Watcher"}
    for each, text in types.items():
        module = "rocking_cli.ask.verbs" if each == "watch" else owner_of(verb.model, each).__module__
        add(text, module, imports)
    answer = verb.__wrapped__.__annotations__["return"]
    add(answer, verb.__module__, imports)
    told = indent(f'"""{verb.__doc__}\n"""', "    ").replace("\\", "\\\\")
    one = re.fullmatch(r"(.+) \| Answers\[\1\]", answer)
    if one is None:
        return defined(name, parameters, types, answer, told)
    imports["overload"] = "from typing import overload as overload"
    many = [each for each in types if each in ("structures", "motions")]
    texts = [({each: re.sub(r" \| (Sequence\[\w+\]|Motions)", "", types[each]) for each in many}, one[1], told)]
    texts += [({each: SEVERAL}, f"Answers[{one[1]}]", "    ...") for each in many]
    text = "\n".join(
        f"@overload\n{defined(name, parameters, types | other, what, body)}"
        for other, what, body in [*texts, ({}, answer, "    ...")]
    )
    overlap = "(  # type: ignore[overload-overlap]\n"  # a `Scaled` is a tuple, but a single motion
    return text.replace("(\n", overlap, 1) if "motions" in many else text


def defined(name: str, parameters: Mapping[str, Parameter], types: dict[str, str], answer: str, body: str) -> str:
    """Return the text of a function."""
    lines, star = [], False
    for each in parameters.values():
        if each.kind is Parameter.KEYWORD_ONLY and not star:
            lines, star = [*lines, "*"], True
        required = each.default is Parameter.empty or types[each.name] == SEVERAL
        lines.append(f"{each.name}: {types[each.name]}{'' if required else ' = ...'}")
    return "\n".join([f"def {name}(", *(f"    {each}," for each in lines), f") -> {answer}:", body, ""])


def typed(model: Any, name: str) -> str:
    """Return the type of a field: words of which it takes one, or its type as it is written."""
    field = model.model_fields[name]
    if choices(field):
        return re.sub(r"^Optional\[(.*)\]$", r"\1 | None", str(field.annotation).replace("typing.", ""))
    text = told_of(field).type or str(vars(owner_of(model, name))["__annotations__"][name])
    text = text.replace("typing.", "")
    text = text if "str" in text else text.replace("Path", "str | Path", 1)
    return text.replace("float", "float | str", 1) if told_of(field).kind is not None and "str" not in text else text


def add(annotation: str, module: str, imports: dict[str, str]) -> None:
    """Add the imports of the names in an annotation, as its module has them."""
    wanted = {each.id for each in ast.walk(ast.parse(annotation)) if isinstance(each, ast.Name)}
    tree = ast.parse(Path(sys.modules[module].__file__ or "").read_text(encoding="utf-8"))
    for statement in ast.walk(tree):
        if isinstance(statement, ast.ImportFrom):
            for alias in statement.names:
                if alias.name in wanted:
                    imports.setdefault(alias.name, f"from {statement.module} import {alias.name} as {alias.name}")
        own = [statement.name] if isinstance(statement, ast.ClassDef) else []
        own += [each.id for each in getattr(statement, "targets", []) if isinstance(each, ast.Name)]  # Range = ...
        for name in wanted.intersection(own):
            imports.setdefault(name, f"from {module} import {name} as {name}")
    for name, home in {"Literal": "typing", "Path": "pathlib", "Any": "typing", "Sequence": "collections.abc"}.items():
        if name in wanted:
            imports.setdefault(name, f"from {home} import {name} as {name}")


def main() -> None:
    """Write it."""
    STUB.write_text(stub(), encoding="utf-8")


if __name__ == "__main__":
    main()

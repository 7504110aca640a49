"""A structure from its YAML file, with every problem placed at file:line:column."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import Path
from typing import Any

import yaml
from pydantic import ValidationError
from pydantic_core import ErrorDetails

from rocking_cli.core import Mechanism
from rocking_cli.errors import InputError, Problem
from rocking_cli.plugins import did_you_mean
from rocking_cli.registry import Registry

LARGEST = 1_000_000  # bytes; a structure takes a few hundred
DEEPEST = 20  # nesting


class _Loader(yaml.SafeLoader):
    """PyYAML with the plain scalars of YAML 1.2: `1e3` is a number, `on` a word and `012` is twelve."""

    yaml_implicit_resolvers: dict[str, Any] = {}  # noqa: RUF012 - so it is declared in PyYAML


for _tag, _first, _pattern in (
    ("bool", "tTfF", r"true|True|TRUE|false|False|FALSE"),
    ("int", "-+0123456789", r"[-+]?[0-9]+"),
    ("float", "-+.0123456789", r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?"),
    ("float", "-+.", r"[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN)"),
    ("null", ["~", "n", "N", ""], r"~|null|Null|NULL|"),
):
    _Loader.add_implicit_resolver(f"tag:yaml.org,2002:{_tag}", re.compile(f"^(?:{_pattern})$"), list(_first))

SCALARS: dict[str, Callable[[str], Any]] = {
    "int": int,
    "float": lambda text: float(text.lower().replace(".inf", "inf").replace(".nan", "nan")),
    "bool": lambda text: ["false", "true"].index(text.lower()) == 1,
    "null": lambda text: None,
    "str": str,
}
Path_ = tuple[str | int, ...]


@dataclass
class _Document:
    """A parsed file: plain data, and where each key and value stands."""

    file: str
    lines: list[str]
    keys: dict[Path_, yaml.Mark] = field(default_factory=dict)
    values: dict[Path_, yaml.Mark] = field(default_factory=dict)
    problems: list[Problem] = field(default_factory=list)

    def problem(
        self, message: str, mark: yaml.Mark | None, name: str | None = None, hint: str | None = None
    ) -> Problem:
        """A problem at a mark, with the line it stands in."""
        if mark is None or mark.line >= len(self.lines):
            return Problem(message, self.file, field=name, hint=hint)
        return Problem(
            message, self.file, mark.line + 1, mark.column + 1, name, self.lines[mark.line].replace("\t", " "), hint
        )

    def plain(self, node: yaml.Node, path: Path_ = ()) -> Any:
        """Plain data of a node; problems are gathered, not raised."""
        self.values.setdefault(path, node.start_mark)
        if len(path) > DEEPEST:
            raise InputError(self.problem("nested too deep to be a structure", node.start_mark))
        if isinstance(node, yaml.SequenceNode):
            return [self.plain(item, (*path, k)) for k, item in enumerate(node.value)]
        if isinstance(node, yaml.MappingNode):
            return self._mapping(node, path)
        kind, text = node.tag.rpartition(":")[2], node.value
        try:
            return SCALARS[kind](text)
        except KeyError:
            message = f"unknown tag {node.tag}"
        except ValueError:  # !!int abc, or thousands of digits
            message = f"not a {kind}"
        raise InputError(self.problem(message, node.start_mark, hint="write plain text or numbers"))

    def _mapping(self, node: yaml.MappingNode, path: Path_) -> dict[str, Any]:
        data: dict[str, Any] = {}
        for key, value in node.value:
            if not isinstance(key, yaml.ScalarNode):
                self.problems.append(self.problem("a key must be a word", key.start_mark))
                continue
            here = (*path, key.value)
            if key.value in data:
                first = self.keys[here].line + 1
                self.problems.append(self.problem(f"given twice, first in line {first}", key.start_mark, key.value))
                continue
            self.keys[here] = key.start_mark
            data[key.value] = self.plain(value, here)
        return data


def load_structure(path: str | Path, registry: Registry | None = None) -> Mechanism:
    """Read a structure from a YAML file.

    Parameters
    ----------
    path : str or Path
        The file: a mapping with `mechanism` and that mechanism's fields.
    registry : Registry, optional
        Where to look up the mechanism; by default all that are installed.

    Returns
    -------
    Mechanism
        Named after the file if it does not give a name.

    Raises
    ------
    InputError
        With every problem of the file: place, field, and what would be right.
    MechanismError
        If the mechanism's plugin cannot be used.
    """
    return parse_structure(_read(Path(path), str(path)), str(path), Path(path).stem, registry)


def parse_structure(text: str, file: str, default_name: str, registry: Registry | None = None) -> Mechanism:
    """Read a structure from YAML text; `file` is what errors call it. Raises as `load_structure`."""
    document = _Document(file, text.splitlines())
    try:
        node = yaml.compose(text, Loader=_Loader)
    except yaml.MarkedYAMLError as error:
        what = " ".join(part for part in (error.context, error.problem) if part)
        raise InputError(document.problem(f"not YAML: {what}", error.problem_mark or error.context_mark)) from None
    except RecursionError:
        raise InputError(Problem("nested too deep to be a structure", file)) from None
    except yaml.YAMLError as error:
        raise InputError(Problem(f"not YAML: {str(error).splitlines()[0]}", file)) from None
    if node is None:
        raise InputError(Problem("the file is empty", file, hint="`rocking new block` prints one to start from"))
    data = document.plain(node)
    if not isinstance(data, dict):
        raise InputError(
            document.problem(
                "a structure is written as `field: value` lines", node.start_mark, hint="`rocking new block` prints one"
            )
        )
    cls = _mechanism(document, data, registry if registry is not None else Registry())
    fields = {key: value for key, value in data.items() if key != "mechanism"}
    if cls is not None:
        try:
            mechanism = cls.model_validate({"name": default_name, **fields})
        except ValidationError as error:
            document.problems += _problems(document, cls, fields, error.errors(include_url=False))
    if document.problems:
        raise InputError(*sorted(document.problems, key=lambda problem: problem.line or 0))
    return mechanism


def _read(path: Path, shown: str) -> str:
    try:
        raw = path.read_bytes()
    except FileNotFoundError:
        raise InputError(Problem("no such file", shown)) from None
    except IsADirectoryError:
        raise InputError(Problem("this is a folder, not a structure file", shown)) from None
    except OSError as error:
        raise InputError(Problem(f"cannot be read: {error.strerror or error}", shown)) from None
    if raw[:2] in (b"\xff\xfe", b"\xfe\xff"):  # what a redirection writes in older shells of Windows
        raw = raw.decode("utf-16", errors="replace").encode()
    if b"\0" in raw or len(raw) > LARGEST:
        raise InputError(Problem("this is not a structure file: it is binary or far too large", shown))
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = raw[: error.start].count(b"\n") + 1
        raise InputError(Problem("not UTF-8 text", shown, line, hint="save the file as UTF-8")) from None


def _mechanism(document: _Document, data: dict[str, Any], registry: Registry) -> type[Mechanism] | None:
    """The class the file asks for; None with a problem noted if there is no such mechanism."""
    if "mechanism" not in data:
        known = ", ".join(registry)
        near = get_close_matches("mechanism", list(data), n=1)
        hint = f"is {near[0]} meant to be mechanism?" if near else f"add a line `mechanism: NAME`; known: {known}"
        document.problems.append(document.problem("is missing", document.values[()], "mechanism", hint))
        return None
    name, mark = data["mechanism"], document.values[("mechanism",)]
    if not isinstance(name, str) or name not in registry:
        guess = did_you_mean(str(name), list(registry))
        document.problems.append(document.problem(f"unknown mechanism {name!r}", mark, "mechanism", guess))
        return None
    return registry[name]


def _problems(
    document: _Document, cls: type[Mechanism], data: dict[str, Any], errors: list[ErrorDetails]
) -> list[Problem]:
    found: dict[Path_, Problem] = {}
    for error in errors:
        if error["type"] == "geometry":
            location: Path_ = (error["ctx"]["field"],)
        else:
            location = _place(data, error)
            if not _concerns(data, location, error):
                continue
        mark = document.keys.get(location) if error["type"] == "extra_forbidden" else document.values.get(location)
        if mark is None:
            mark = document.values.get(location[:-1])
        message, hint = _say(cls, location, error)
        found.setdefault(location, document.problem(message, mark, _spell(location), hint))
    return list(found.values())


def _place(data: Any, error: ErrorDetails) -> Path_:
    """The path of an error in the user's data: pydantic adds the branches of unions to it."""
    path: list[str | int] = []
    for k, part in enumerate(error["loc"]):
        last = k == len(error["loc"]) - 1
        if isinstance(data, dict) and (part in data or (last and error["type"] == "missing")):
            path.append(part)
            data = data.get(part)
        elif isinstance(data, list) and isinstance(part, int) and part < len(data):
            path.append(part)
            data = data[part]
    return tuple(path)


def _concerns(data: Any, location: Path_, error: ErrorDetails) -> bool:
    """Whether an error speaks of the branch of a union that the user meant: a mapping, or a plain value."""
    for part in location:
        data = data.get(part) if isinstance(data, dict) else data[part]
    return not (
        (isinstance(data, dict) and error["type"] in ("float_type", "int_type"))
        or (not isinstance(data, dict) and error["type"] in ("model_type", "model_attributes_type"))
    )


def _spell(location: Path_) -> str | None:
    """A path as the user would write it: `polygon[2]`, `restitution.positive_to_negative`."""
    text = "".join(f"[{part + 1}]" if isinstance(part, int) else f".{part}" for part in location)
    return text.lstrip(".") or None


BOUNDS = {
    "greater_than": ("gt", "more than"),
    "greater_than_equal": ("ge", "at least"),
    "less_than": ("lt", "less than"),
    "less_than_equal": ("le", "at most"),
}


def _got(given: Any) -> str:
    if given is None:
        return "got nothing"
    if isinstance(given, bool):
        return f"got {str(given).lower()}"
    if isinstance(given, str):
        return f"got the text {given!r}"
    if isinstance(given, int | float):
        return f"got {given}"
    return f"got a {'list' if isinstance(given, list) else 'mapping'}"


def _say(cls: type[Mechanism], location: Path_, error: ErrorDetails) -> tuple[str, str | None]:
    """An error in plain words, and a hint."""
    kind, given, ctx = error["type"], error["input"], error.get("ctx", {})
    info = cls.model_fields.get(str(location[0])) if location else None
    extra = info.json_schema_extra if info is not None and isinstance(info.json_schema_extra, dict) else {}
    unit = f" {extra['unit']}" if extra.get("unit") else ""
    got = _got(given)
    if kind == "geometry":
        return ctx["reason"], None
    if kind == "missing":
        what = "is missing"
        if info is not None and len(location) == 1:
            what += f": {info.description}" + (f" [{unit.strip()}]" if unit else "")
        return what, f"`rocking mechanisms {cls.mechanism}` lists the fields"
    if kind == "extra_forbidden":
        known = list(cls.model_fields) if len(location) == 1 else ["positive_to_negative", "negative_to_positive"]
        return f"is not a field of {cls.mechanism if len(location) == 1 else location[-2]}", did_you_mean(
            str(location[-1]), known
        )
    if kind in BOUNDS:
        key, words = BOUNDS[kind]
        return f"must be {words} {ctx[key]:g}{unit}, {got}", None
    if kind == "finite_number":
        return f"must be a finite number, {got}", None
    if kind in ("float_type", "float_parsing"):
        comma = isinstance(given, str) and re.fullmatch(r"\s*[-+]?\d+,\d+\s*", given)
        return f"must be a number{f' in{unit}' if unit else ''}, {got}", "write a decimal point" if comma else None
    if kind in ("int_type", "int_parsing", "int_from_float"):
        return f"must be a whole number, {got}", None
    if kind == "string_type":
        return f"must be text, {got}", "put it in quotes"
    if kind == "literal_error":
        return f"must be {ctx['expected']}, {got}".replace("'", ""), None
    if kind in ("too_short", "too_long"):
        least, most = ctx.get("min_length"), ctx.get("max_length")
        wanted = f"at least {least}" if least is not None else f"at most {most}"
        return f"must have {wanted} entries, has {ctx['actual_length']}", None
    if kind == "list_type":
        return f"must be a list, {got}", None
    return f"{error['msg'][0].lower()}{error['msg'][1:]}", None

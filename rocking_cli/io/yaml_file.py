"""A YAML file as plain data, with the place file:line:column of every problem, and plain data as YAML.

Paths in plain data are as users write them, with dots: `width`, `loads.0.mass`, `ties.bar.prestress`. For a list, a
number is the index of an entry, from 0, and a word is the `name` of an entry.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import lru_cache
from math import inf, isfinite
from pathlib import Path
from typing import Any

import yaml
from yaml.composer import Composer
from yaml.reader import ReaderError

from rocking_cli.errors import InputError, Problem
from rocking_cli.io.files import read_bytes
from rocking_cli.text import cut, did_you_mean, printable, regex

MAX_BYTES = 10_000_000  # most structures take a few hundred, a wall of ten thousand blocks two million
MIN_FAST_CHARACTERS = 100_000  # longer texts take seconds without the parser in C
MAX_DEPTH = 20
NUMBERED_WORD = regex("[A-Za-z]+[0-9]+")
MAX_VALUES = 500_000  # repeats by aliases count, as a few lines of them stand for billions


FIELD_PART = regex(r"([^.\[\]`]+)|\[(\d+)\]")  # `loads[1].at`, and `loads.roof.at` or `loads.0.at`
_LINE_END = regex("\r\n|[\r\n\x85\u2028\u2029]")  # line ends of YAML


class _Loader(yaml.SafeLoader):
    """PyYAML with the plain scalars of YAML 1.2: `1e3` is a number, `on` a word and `012` is twelve."""

    yaml_implicit_resolvers: dict[str, Any] = {}  # noqa: RUF012 - so it is declared in PyYAML


def _fast() -> type[_Loader]:
    """Return the loader with the C parser for events; nodes are composed in Python, as C crashes on deep nesting."""

    class Fast(Composer, yaml.CSafeLoader):
        yaml_implicit_resolvers = _Loader.yaml_implicit_resolvers

        def __init__(self, text: str) -> None:
            yaml.CSafeLoader.__init__(self, text)
            Composer.__init__(self)

    return Fast  # type: ignore[return-value]


def _composed(text: str) -> yaml.Node | None:
    """Return the nodes of a YAML text."""
    if len(text) >= MIN_FAST_CHARACTERS and yaml.__with_libyaml__:
        with suppress(ReaderError):  # the fast parser gives no position for a bad character
            return yaml.compose(text, Loader=_fast())
    return yaml.compose(text, Loader=_Loader)


for _tag, _first, _pattern in (
    ("bool", "tTfF", r"true|True|TRUE|false|False|FALSE"),
    ("int", "-+0123456789", r"[-+]?[0-9]+"),
    ("float", "-+.0123456789", r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?"),
    ("float", "-+.", r"[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN)"),
    ("null", ["~", "n", "N", ""], r"~|null|Null|NULL|"),
):
    _Loader.add_implicit_resolver(f"tag:yaml.org,2002:{_tag}", regex(f"^(?:{_pattern})$"), list(_first))


class _Dumper(yaml.SafeDumper):
    """PyYAML that quotes each text which YAML 1.1 or 1.2 would read as something else."""

    yaml_implicit_resolvers = {  # noqa: RUF012 - so it is declared in PyYAML
        first: [rule for cls in (yaml.SafeDumper, _Loader) for rule in cls.yaml_implicit_resolvers.get(first, [])]
        for first in {*yaml.SafeDumper.yaml_implicit_resolvers, *_Loader.yaml_implicit_resolvers}
    }

    def ignore_aliases(self, data: Any) -> bool:
        return True


def in_a_line(value: Any) -> str:
    """Return plain data as YAML in one line."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{in_a_line(key)}: {in_a_line(each)}" for key, each in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(in_a_line, value)) + "]"
    if type(value) is float and isfinite(value):
        digits = repr(value)  # YAML 1.1 reads a number without a point before its exponent as a text
        return digits if "." in digits else digits.replace("e", ".0e")
    if isinstance(value, str) and NUMBERED_WORD.fullmatch(value):
        return value  # as most names of bodies are
    return _scalar(value)


@lru_cache(maxsize=4096, typed=True)  # 1 and True are equal
def _scalar(value: Any) -> str:
    """Return a scalar as PyYAML writes it in a list, a text of several lines in quotes and one line."""
    style = '"' if "\n" in str(value) else None
    text = yaml.dump(
        [value], Dumper=_Dumper, width=inf, default_flow_style=True, default_style=style, allow_unicode=True
    )
    return str(text).strip()[1:-1]


def is_deep(value: Any) -> bool:
    """Return whether a value is a mapping of mappings, which is hard to read on one line."""
    return isinstance(value, dict) and any(isinstance(each, dict) for each in value.values())


def block(key: str, value: Any) -> list[str]:
    """Return the lines of a field in YAML, with nested mappings on lines of their own."""
    if not is_deep(value):
        return [f"{in_a_line(key)}: {in_a_line(value)}"]
    return [f"{in_a_line(key)}:", *(f"  {line}" for name, each in value.items() for line in block(name, each))]


SCALARS: dict[str, Callable[[str], Any]] = {
    "int": int,
    "float": lambda text: float(text.lower().replace(".inf", "inf").replace(".nan", "nan")),
    "bool": lambda text: ["false", "true"].index(text.lower()) == 1,
    "null": lambda text: None,
    "str": str,
}
KINDS = {"int": "a whole number", "float": "a number", "bool": "true or false"}
Place = tuple[str | int, ...]
"""Where a value stands in a file: keys, and places in lists counted from 0."""


@dataclass
class Document:
    """A parsed file: plain data, with the place of each key and value.

    Parameters
    ----------
    what : str
        Kind of file, for messages: "structure".
    file : str
        Name of the file in messages.
    lines : list of str
        Lines of the file.
    data : dict
        Content of the file.
    keys, values : dict
        Marks of the key and the value at each path.
    problems : list of Problem
        Problems found so far.
    """

    what: str
    file: str
    lines: list[str]
    data: dict[str, Any] = field(default_factory=dict)
    keys: dict[Place, yaml.Mark] = field(default_factory=dict)
    values: dict[Place, yaml.Mark] = field(default_factory=dict)
    problems: list[Problem] = field(default_factory=list)
    count: int = 0

    def problem(
        self, message: str, mark: yaml.Mark | None, name: str | None = None, hint: str | None = None
    ) -> Problem:
        """Return a problem at a mark, with the line of the file."""
        if mark is None or mark.line >= len(self.lines):
            return Problem(message, self.file, field=name, hint=hint)
        return Problem(
            message, self.file, mark.line + 1, mark.column + 1, name, self.lines[mark.line].replace("\t", " "), hint
        )

    def plain(self, node: yaml.Node, path: Place = ()) -> Any:
        """Return the plain data of a node, and add problems to the list."""
        self.values.setdefault(path, node.start_mark)
        if len(path) > MAX_DEPTH:
            raise InputError(self.problem(f"nested too deep to be a {self.what}", node.start_mark))
        self.count += 1
        if self.count > MAX_VALUES:
            hint = "aliases (*name) expand to too many values: write the values out"
            message = f"the file has more than {MAX_VALUES} values: too many for a {self.what}"
            mark = self.values.get(path[:1], node.start_mark)
            raise InputError(self.problem(message, mark, spell(path[:1]), hint))
        if isinstance(node, yaml.SequenceNode):
            return [self.plain(item, (*path, k)) for k, item in enumerate(node.value)]
        if isinstance(node, yaml.MappingNode):
            return self._mapping(node, path)
        kind, text = node.tag.rpartition(":")[2], node.value
        try:
            return SCALARS[kind](text)
        except KeyError:
            message = f"unknown tag {cut(node.tag)}"
        except ValueError:  # such as !!int abc, or thousands of digits
            message = f"{cut(text)!r} is not {KINDS[kind]}"
            if text.lstrip("+-").isdecimal():
                message = f"a number of {len(text.lstrip('+-'))} digits is beyond the range of numbers"
        raise InputError(self.problem(message, node.start_mark, hint="write plain text or numbers"))

    def _mapping(self, node: yaml.MappingNode, path: Place) -> dict[str, Any]:
        data: dict[str, Any] = {}
        for key, value in node.value:
            if not isinstance(key, yaml.ScalarNode):
                self.problems.append(self.problem("a key must be a word", key.start_mark))
                continue
            if key.value == "<<" and key.style is None:
                hint = "write the fields out"
                self.problems.append(self.problem("merge keys (<<) are not supported", key.start_mark, "<<", hint))
                continue
            here = (*path, key.value)
            if key.value in data:
                first = self.keys[here].line + 1
                self.problems.append(self.problem(f"given twice, first in line {first}", key.start_mark, key.value))
                continue
            self.keys[here] = key.start_mark
            data[key.value] = self.plain(value, here)
        return data

    def at(self, place: Place, message: str, hint: str | None = None, *, key: bool = False) -> Problem:
        """Return a problem with the value at a place, or with its key, or else with the nearest item around it."""
        mark = (self.keys if key else self.values).get(place) or self.values.get(place[:-1])
        return self.problem(message, mark, spell(place), hint)

    def located(self, problem: Problem) -> Problem:
        """Return a problem at its field, or at the nearest item around it; unchanged if the file has neither."""
        here: Any = self.data
        place: Place = ()
        for word, number in FIELD_PART.findall(problem.field or ""):
            key: Any = word
            if isinstance(here, list):
                names = {each.get("name"): k for k, each in enumerate(here) if isinstance(each, dict)}
                key = int(number) - 1 if number else names.get(word, int(word) if word.isdecimal() else len(here))
            if not (key < len(here) if isinstance(here, list) else isinstance(here, dict) and key in here):
                break
            here, place = here[key], (*place, key)
        return replace(self.at(place, problem.message, problem.hint), field=problem.field) if place else problem

    def check(self) -> None:
        """Raise `InputError` with every problem found so far, in the order of the lines."""
        if self.problems:
            raise InputError(*sorted(self.problems, key=lambda problem: problem.line or 0))


def spell(place: Place) -> str | None:
    """Return a place as the user would write it: `polygon[2]`, `restitution.positive_to_negative`."""
    text = "".join(f"[{part + 1}]" if isinstance(part, int) else f".{part}" for part in place)
    return text.lstrip(".") or None


def placed(problem: Problem) -> Problem:
    """Return a problem of a field of a file with its line, if the file is YAML that has the field."""
    if problem.file is None or problem.line is not None or problem.field is None:
        return problem
    with suppress(InputError):
        return parse(read_text(Path(problem.file), "structure"), problem.file, "structure", "").located(problem)
    return problem


def read_text(path: Path, what: str) -> str:
    """Return the text of a file; `what` is its kind in messages. Raises `InputError` if it cannot be read."""
    return decoded(read_bytes(path, f"{what} file", MAX_BYTES), str(path), what)


def decoded(raw: bytes, shown_path: str, what: str) -> str:
    """Return the text of a file from its bytes; `shown_path` is its name in messages.

    Raises `InputError` if it is not text.
    """
    if len(raw) > MAX_BYTES:
        raise InputError(
            Problem(f"this cannot be a {what} file: it is larger than {MAX_BYTES / 1e6:.4g} MB", shown_path)
        )
    if raw[:2] in (b"\xff\xfe", b"\xfe\xff"):  # redirection in older shells of Windows writes UTF-16
        raw = raw.decode("utf-16", errors="replace").encode()
    if b"\0" in raw:
        raise InputError(Problem(f"this is not a {what} file: it is binary", shown_path))
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = raw[: error.start].count(b"\n") + 1
        raise InputError(Problem("not UTF-8 text", shown_path, line, hint="save the file as UTF-8")) from None


def parse(text: str, file: str, what: str, hint: str) -> Document:
    """Parse YAML text that should be a mapping.

    Parameters
    ----------
    text, file : str
        The text, and its name in messages.
    what : str
        Kind of file: "structure".
    hint : str
        Hint on where to find a template, if the file is empty.

    Returns
    -------
    Document
        The document; repeated keys and similar errors are in its problems.

    Raises
    ------
    InputError
        If it is not YAML, or not a mapping.
    """
    document = Document(what, file, _LINE_END.split(text))
    too_deep = Problem(f"nested too deep to be a {what}", file)
    try:
        node = _composed(text)
    except yaml.MarkedYAMLError as error:
        if "nesting depth" in (error.problem or ""):  # the parser in Python raises RecursionError
            raise InputError(too_deep) from None
        reason = " ".join(part for part in (error.context, error.problem) if part)
        began, noticed = error.context_mark, error.problem_mark
        if began is not None and (noticed is None or not text[noticed.index :].strip()):
            mark: yaml.Mark | None = began  # an unclosed bracket or quote is noticed at the end of the file
        else:
            mark = noticed
            reason += (
                f" (it begins in line {began.line + 1})" if began and noticed and began.line < noticed.line else ""
            )
        if mark is not None and not text[mark.index :].strip():
            raise InputError(Problem(f"not YAML: {reason}", file, text.rstrip().count("\n") + 1)) from None
        raise InputError(document.problem(f"not YAML: {reason}", mark)) from None
    except ReaderError as error:
        line = len(_LINE_END.findall(text, 0, error.position)) + 1
        message = f"not valid YAML: it contains the character {printable(chr(error.character))}"
        raise InputError(Problem(message, file, line)) from None
    except RecursionError:
        raise InputError(too_deep) from None
    except yaml.YAMLError as error:
        raise InputError(Problem(f"not YAML: {str(error).splitlines()[0]}", file)) from None
    if node is None:
        raise InputError(Problem("the file is empty", file, hint=hint))
    data = document.plain(node)
    if not isinstance(data, dict):
        message = f"a {what} is written as `field: value` lines"
        raise InputError(document.problem(message, node.start_mark, hint=hint))
    document.data = data
    return document


def with_fields(text: str, fields: Mapping[str, str], file: str) -> str:
    """Return the text of a mapping in YAML with other values of some of its keys.

    Parameters
    ----------
    text : str
        The text, which is valid.
    fields : mapping of str to str
        New values as YAML in one line, by key; a comment may follow. Keys that are not there are added at the end.
    file : str
        Name of the file in messages.

    Raises
    ------
    InputError
        If the mapping is written in braces, as in JSON.
    """
    node = yaml.compose(text, Loader=yaml.SafeLoader)
    if not isinstance(node, yaml.MappingNode) or node.flow_style:
        raise InputError(Problem("cannot be changed: it is written in braces", file, hint="write it as `key: value`"))
    places = {key.value: (key.start_mark.index, _end_of(value)) for key, value in node.value}
    newline = "\r\n" if "\r\n" in text else "\n"
    # Backwards through the text, so that earlier places stay valid.
    for key in sorted(fields.keys() & places.keys(), key=lambda each: -places[each][0]):
        start, end = places[key]
        line_end = text.find(newline, end)
        text = f"{text[:start]}{key}: {fields[key]}{text[line_end:] if line_end >= 0 else ''}"
    added = "".join(f"{key}: {value}{newline}" for key, value in fields.items() if key not in places)
    return text + (newline if added and not text.endswith(newline) else "") + added


def _end_of(node: yaml.Node) -> int:
    """Return where a node ends: its last scalar, as the end of a block takes in the comments that follow."""
    if not isinstance(node, yaml.CollectionNode) or not node.value or node.flow_style:
        return int(node.end_mark.index)
    last = node.value[-1]
    return _end_of(last[1] if isinstance(last, tuple) else last)


MAX_LIST_ENTRIES = 10_000
HOLE: Any = ...
"""Placeholder for a list entry that has no value yet."""


def words(text: str) -> tuple[str, ...]:
    """Return the words of a path. Raises `InputError` if there are none."""
    parts = tuple(part.strip() for part in text.strip().split("."))
    if not all(parts):
        hint = "write words with a dot between them, such as loads.0.mass"
        raise InputError(Problem(f"{cut(repr(text))} is not a valid field", hint=hint))
    if len(parts) > MAX_DEPTH:
        raise InputError(Problem(f"{cut(repr(text))} has more than {MAX_DEPTH} parts: no field lies so deep"))
    return parts


def put(
    data: dict[str, Any],
    path: tuple[str, ...],
    value: Any,
    *,
    is_list: Callable[[Place], bool] = lambda place: False,
    grow: bool = True,
) -> Place:
    """Put a value at a path in plain data, which is changed, and return its place.

    Parameters
    ----------
    data : dict
        Nested mappings and lists, which are changed.
    path : tuple of str
        Path, as returned by `words`.
    value : any
        The new value.
    is_list : callable
        Function that returns whether a missing item at a place is a list, even if a name follows and not a number.
    grow : bool
        Whether new entries may be added to lists; an entry added by name gets this name. Entries skipped by a number
        are placeholders, which `closed` removes.

    Returns
    -------
    tuple
        The place: keys of mappings and indices of lists.

    Raises
    ------
    InputError
        If a list has no such entry, or the path goes through a number or a text.
    """
    here: Any = data
    place: Place = ()
    for k, word in enumerate(path):
        key: Any = _entry(here, word, path[:k], grow=grow) if isinstance(here, list) else word
        place = (*place, key)
        if k == len(path) - 1:
            here[key] = value
            break
        inner = here[key] if isinstance(here, list) else here.get(key)
        if inner is None or inner is HOLE:
            inner = here[key] = [] if path[k + 1].isdecimal() or is_list(place) else {}
        if not isinstance(inner, dict | list):
            raise InputError(Problem(f"{'.'.join(path[: k + 1])} is {cut(repr(inner))}, and holds no {path[k + 1]}"))
        here = inner
    return place


def replace_at(data: Any, place: Place, value: Any) -> None:
    """Replace the value at an existing place, as returned by `put`."""
    for part in place[:-1]:
        data = data[part]
    data[place[-1]] = value


def _entry(entries: list[Any], word: str, before: tuple[str, ...], *, grow: bool) -> int:
    """Return the index of an entry by its number or name; a new entry is added if `grow` is True."""
    names = [each.get("name") if isinstance(each, dict) else None for each in entries]
    if word in names:
        return names.index(word)
    of = ".".join(before)
    number = int(word) if word.isdecimal() and len(word) < 10 else MAX_LIST_ENTRIES
    if word.isdecimal() and number < len(entries):
        return number
    if not grow:
        raise InputError(Problem(f"{of} has no entry {cut(word)}", hint=_known(word, names)))
    if word.isdecimal():
        if number >= MAX_LIST_ENTRIES:
            raise InputError(Problem(f"{cut(word)} is not a valid place in a list: at most {MAX_LIST_ENTRIES - 1}"))
        entries += [HOLE] * (number + 1 - len(entries))
        return number
    entries.append({"name": word})
    return len(entries) - 1


def _known(word: str, names: list[Any]) -> str:
    named = [str(each) for each in names if isinstance(each, str)]
    numbers = f"numbers count from 0, here to {len(names) - 1}" if names else "it has none"
    guess = did_you_mean(word, named) if named else None
    return f"{guess} {numbers}" if guess and guess.endswith("?") else f"{guess}; {numbers}" if guess else numbers


def closed(data: Any) -> Any:
    """Return the data without the placeholders of list entries that received no value."""
    if isinstance(data, dict):
        return {key: closed(value) for key, value in data.items()}
    return [closed(each) for each in data if each is not HOLE] if isinstance(data, list) else data

"""Change fields of a YAML file, and leave its comments and all else as they are."""

from __future__ import annotations

from collections.abc import Mapping

import yaml

from rocking_cli.errors import InputError, Problem


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
    places = {key.value: (key.start_mark.index, _end(value)) for key, value in node.value}
    newline = "\r\n" if "\r\n" in text else "\n"
    for key in sorted(fields.keys() & places.keys(), key=lambda each: -places[each][0]):  # from the end of the text
        start, end = places[key]
        line_end = text.find(newline, end)
        text = f"{text[:start]}{key}: {fields[key]}{text[line_end:] if line_end >= 0 else ''}"
    added = "".join(f"{key}: {value}{newline}" for key, value in fields.items() if key not in places)
    return text + (newline if added and not text.endswith(newline) else "") + added


def _end(node: yaml.Node) -> int:
    """Return where a node ends: its last scalar, as the end of a block takes in the comments that follow."""
    if not isinstance(node, yaml.CollectionNode) or not node.value or node.flow_style:
        return int(node.end_mark.index)
    last = node.value[-1]
    return _end(last[1] if isinstance(last, tuple) else last)

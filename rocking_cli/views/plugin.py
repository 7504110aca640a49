"""A package for a mechanism or a code that was written, as people and programs read it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from rocking_cli.views.view import Table, View


def view(name: str, kind: str, folder: str, files: Mapping[str, str], commands: Sequence[str]) -> View:
    """What was written, and what to type next.

    Parameters
    ----------
    name, kind : str
        What it is called, and what it is: a mechanism or a code.
    folder : str
        Where the package is.
    files : mapping of str to str
        What each file is, by its place in the folder.
    commands : sequence of str
        To be typed one after the other.
    """
    data = {"plugin": name, "folder": folder, "files": list(files), "commands": list(commands)}
    rows = [[file, what] for file, what in files.items()]
    return View(data, [Table(f"{folder}: template of the {kind} {name}", ["file", "description"], rows)])

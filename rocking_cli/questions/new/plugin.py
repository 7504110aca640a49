"""View of a new package for a mechanism or a code, as text and as data."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from rocking_cli.views.column import table_of, text_columns
from rocking_cli.views.view import View


def view(name: str, kind: str, folder: str, files: Mapping[str, str], commands: Sequence[str]) -> View:
    """Show the files that were written, and the commands to type next.

    Parameters
    ----------
    name, kind : str
        Name of the plugin, and its kind: a mechanism or a code.
    folder : str
        Folder of the package.
    files : mapping of str to str
        Description of each file, by its path in the folder.
    commands : sequence of str
        The commands to type, in order.
    """
    data = {"plugin": name, "folder": folder, "files": list(files), "commands": list(commands)}
    title = f"{folder}: template of the {kind} {name}"
    return View(data, [table_of(title, text_columns("file", "description"), list(files.items()))])

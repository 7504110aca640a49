"""Record files from names and patterns."""

from __future__ import annotations

from pathlib import Path

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.records.opening import STANDARD_INPUT


def select(place: str, folder: Path | None = None) -> list[Path]:
    """Return the files that match a name or a pattern.

    Parameters
    ----------
    place : str
        A file, or a pattern: `records/*.AT2`; `**` matches any folders in between. Without a folder, `-` is standard
        input.
    folder : Path, optional
        Folder to which `place` is relative; by default the current one.

    Returns
    -------
    list of Path
        At least one file, sorted by name; relative if `place` is.

    Raises
    ------
    InputError
        If the file does not exist or is a folder, or nothing matches.
    """
    if folder is None and place == STANDARD_INPUT:
        return [Path(STANDARD_INPUT)]
    base = folder if folder is not None else Path()
    path = base / place
    if path.is_dir():
        raise InputError(Problem("this is a folder", place, hint=f"for the files in it give a pattern: {place}/*.AT2"))
    if path.exists():
        return [path]
    if not any(sign in place for sign in "*?["):
        raise InputError(Problem("no such file", place, hint="check the path"))
    pattern = Path(place)
    if pattern.is_absolute():
        base, pattern = Path(pattern.anchor), pattern.relative_to(pattern.anchor)
    try:
        files = sorted(file for file in base.glob(str(pattern)) if file.is_file() and not file.name.startswith("."))
    except (ValueError, NotImplementedError) as error:
        raise InputError(Problem(f"not a pattern of file names: {error}", place)) from None
    if not files:
        raise InputError(Problem("no file matches this pattern", place, hint="check the path"))
    return files

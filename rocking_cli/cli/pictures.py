"""Write plots to files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from rocking_cli.cli import terminal

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def save(path: Path, figure: Figure) -> None:
    """Write a figure completely or not at all, in the format of the suffix of the path."""
    from rocking_cli.io.files import write_whole
    from rocking_cli.plotting import style

    write_whole(path, lambda stream: style.save(figure, stream, format=path.suffix[1:].lower()))


def write_picture(path: Path, figure: Figure) -> None:
    """Write a figure, and report it."""
    save(path, figure)
    terminal.note(f"wrote {path}")

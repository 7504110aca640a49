"""Messages during the limit analysis of many blocks, which takes long."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from rocking_cli.cli import terminal
from rocking_cli.errors import InputError

MANY = 500  # blocks that take more than a few seconds
MEASURED = 1000  # blocks, at most, whose analysis was timed

_SAID: set[str] = set()


@contextmanager
def blocks(file: str | None) -> Iterator[None]:
    """Show a spinner while blocks are analysed."""
    count = _count_of_blocks(file)
    with terminal.working(f"analysing {count} polygons" if count else "finding the weakest mechanism"):
        yield


def say_what_blocks_take(file: str | None) -> None:
    """Print a note, before it starts, on the time that the analysis of many blocks will take."""
    count = _count_of_blocks(file)
    if count < MANY or str(file) in _SAID:
        return
    _SAID.add(str(file))  # what is not valid may be read once more
    if count <= MEASURED:
        terminal.note(f"{count} polygons: up to about a minute and 250 MB; Ctrl-C stops it")
        return
    minutes = round((count / 1000) ** 2)  # at a minute for 1000
    least = "a minute" if minutes < 2 else f"{minutes} minutes" if minutes < 120 else f"{minutes / 60:.0f} hours"
    terminal.note(
        f"{count} polygons: {least} and {0.2 * count:.0f} MB at least, and perhaps many times as much, as no more than "
        f"{MEASURED} have been measured; Ctrl-C stops it"
    )


def _count_of_blocks(file: str | None) -> int:
    """Return the number of polygons that a file names, whatever else is in it; 0 if it cannot be read yet."""
    from rocking_cli.io.files import read_bytes
    from rocking_cli.io.yaml_file import LARGEST

    try:
        return read_bytes(file, "structure file", LARGEST).count(b"polygon") if file and file != "-" else 0
    except InputError:
        return 0  # reported when it is loaded

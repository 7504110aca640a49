"""What is said while histories are computed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rocking_cli.cli import terminal


def say_if_compiling() -> None:
    """Say that the first history on a machine takes a while."""
    from rocking_cli.dynamics.compiled import needs_compiling

    if needs_compiling():
        terminal.note("compiling the history kernel, some ten seconds, once for this machine ...")


@contextmanager
def histories(total: int) -> Iterator[Callable[[int], None]]:
    """Show the progress of so many histories."""
    say_if_compiling()
    with terminal.progress(total, "histories") as advance:
        yield advance

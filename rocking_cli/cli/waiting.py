"""What is said while histories are computed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rocking_cli.cli import terminal


def say_if_compiling(*, exact: bool = False) -> None:
    """Say that the first history on a machine takes a while, or the first exact response to many pulses."""
    from rocking_cli.dynamics.compiled import HISTORIES, PULSES, cache_folder, needs_compiling, unwritable

    if needs_compiling(PULSES if exact else HISTORIES):
        what = "the exact response to pulses, some five" if exact else "the history kernel, some ten"
        if unwritable() is None:
            terminal.note(f"compiling {what} seconds, once for this machine ...")
            return
        terminal.note(f"compiling {what} seconds, again in every process: {cache_folder()} cannot be written to")
        terminal.note(f"  ({unwritable()}); name another folder in NUMBA_CACHE_DIR")


@contextmanager
def histories(total: int, *, exact: bool = False) -> Iterator[Callable[[int], None]]:
    """Show the progress of so many histories, or exact responses."""
    say_if_compiling(exact=exact)
    with terminal.progress(total, "histories") as advance:
        yield advance

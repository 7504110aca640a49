"""What is said while histories are computed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rocking_cli.cli import terminal


def say_if_compiling(*, exact: bool = False) -> None:
    """Say that the first history on a machine takes a while, or the first exact response to many pulses."""
    from rocking_cli.dynamics.compiled import HISTORIES, PULSES, needs_compiling

    if needs_compiling(PULSES if exact else HISTORIES):
        what = "the exact response to pulses, some five" if exact else "the history kernel, some ten"
        terminal.note(f"compiling {what} seconds, once for this machine ...")


@contextmanager
def histories(total: int, *, exact: bool = False) -> Iterator[Callable[[int], None]]:
    """Show the progress of so many histories, or exact responses."""
    say_if_compiling(exact=exact)
    with terminal.progress(total, "histories") as advance:
        yield advance

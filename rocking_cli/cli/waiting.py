"""What is said while histories are computed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rocking_cli.cli import terminal

_SAID: set[str] = set()


def compile_first(*, exact: bool = False) -> None:
    """Compile what histories need, or exact responses to many pulses, if this machine has not yet; something moves."""
    from rocking_cli.dynamics.compiled import HISTORIES, PULSES, needs_compiling

    kernel = PULSES if exact else HISTORIES
    if needs_compiling(kernel) and kernel not in _SAID:
        from rocking_cli.studies.compiling import compile_kernel

        _SAID.add(kernel)  # where nothing can be kept it would be asked for again, and is there
        say_that_it_compiles(kernel)
        with terminal.working("compiling"):
            made = compile_kernel(kernel)
        terminal.detail(f"compiled in {made.seconds:.1f} s")


def say_that_it_compiles(kernel: str) -> None:
    """Say that the first history on a machine takes a while, or the first exact response to many pulses."""
    from rocking_cli.dynamics.compiled import PULSES, cache_folder, unwritable

    what = "the exact response to pulses, some five" if kernel == PULSES else "the history kernel, some ten"
    if unwritable() is None:
        terminal.note(f"compiling {what} seconds, once for this machine ...")
        return
    terminal.note(f"compiling {what} seconds, again in every process: {cache_folder()} cannot be written to")
    if "the folder" not in _SAID:
        _SAID.add("the folder")
        terminal.note(f"  ({unwritable()}); name another folder in NUMBA_CACHE_DIR")


@contextmanager
def histories(total: int, *, exact: bool = False) -> Iterator[Callable[[int], None]]:
    """Show the progress of so many histories, or exact responses."""
    compile_first(exact=exact)
    with terminal.progress(total, "histories") as advance:
        yield advance

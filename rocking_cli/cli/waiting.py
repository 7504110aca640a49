"""Messages during the computation of time histories."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rocking_cli.cli import terminal

_SAID: set[str] = set()


def compile_first(*, exact: bool = False) -> None:
    """Compile the kernel of histories or of exact responses if this machine has not yet; show a spinner."""
    from rocking_cli.dynamics.compiled import HISTORIES, PULSES
    from rocking_cli.dynamics.ways import needs_compiling

    kernel = PULSES if exact else HISTORIES
    if needs_compiling(kernel) and kernel not in _SAID:
        from rocking_cli.studies.compiling import compile_kernel

        _SAID.add(kernel)  # without a cache it would be compiled again
        say_that_it_compiles(kernel)
        with terminal.working("compiling"):
            made = compile_kernel(kernel)
        terminal.detail(f"compiled in {made.seconds:.1f} s")


def say_that_it_compiles(kernel: str) -> None:
    """Report that the first history on a machine, or the first exact response to many pulses, takes a while."""
    from rocking_cli.dynamics.compiled import PULSES, cache_folder, unwritable

    what = "the exact response to pulses, about five" if kernel == PULSES else "the history kernel, about ten"
    if unwritable() is None:
        terminal.note(f"compiling {what} seconds, once for this machine ...")
        return
    terminal.note(f"compiling {what} seconds, again in every process: {cache_folder()} cannot be written to")
    if "the folder" not in _SAID:
        _SAID.add("the folder")
        terminal.note(f"  ({unwritable()}); name another folder in NUMBA_CACHE_DIR")


@contextmanager
def histories(total: int, *, exact: bool = False) -> Iterator[Callable[[int], None]]:
    """Show the progress of a number of histories, or of exact responses."""
    compile_first(exact=exact)
    with terminal.progress(total, "histories") as advance:
        yield advance

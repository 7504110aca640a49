"""The terminal as the watcher of a verb: notes and progress, and what was left out."""

from __future__ import annotations

from contextlib import AbstractContextManager
from pathlib import Path

import click

from rocking_cli.ask.watcher import Advance, Watcher
from rocking_cli.cli import terminal
from rocking_cli.errors import INCOMPLETE, InputError, RockingError


class OnTerminal(Watcher):
    """Watcher that prints, and goes on without the motions and structures that cannot be used."""

    def __init__(self) -> None:
        self.left_out = 0
        self.left_out_names: list[str] = []

    def note(self, text: str) -> None:
        """Print a note."""
        terminal.note(text)

    def warn(self, text: str) -> None:
        """Print a warning."""
        terminal.warning(text)

    def leave_out(self, error: RockingError, name: str = "") -> None:
        """Print an error, after the name of what it is about, and count it."""
        terminal.error(f"{name}: {error}" if name else str(error))
        terminal.debug_traceback(error)
        self.left_out += 1
        place = error.problems[0].file if isinstance(error, InputError) else None
        if name or place is not None:
            self.left_out_names.append(name or Path(str(place)).name)

    def incomplete(self, text: str) -> None:
        """Print an error, and count it."""
        terminal.error(text)
        self.left_out += 1

    def progress(
        self, total: int, what: str, *, done: int = 0, failed: int = 0
    ) -> AbstractContextManager[Advance]:  # fmt: skip
        """Show a progress bar."""
        return terminal.progress(total, what, done=done, failed=failed)

    def end(self) -> None:
        """End the command; with the exit code of an incomplete answer if anything was left out."""
        if self.left_out:
            click.get_current_context().exit(INCOMPLETE)

"""The terminal as the watcher of a verb: notes and progress, and what was left out."""

from __future__ import annotations

from contextlib import AbstractContextManager
from typing import TYPE_CHECKING, Any

import click

from rocking_cli.ask.watcher import Advance, Watcher
from rocking_cli.cli import terminal
from rocking_cli.errors import EXIT_INCOMPLETE, Refused, RockingError

if TYPE_CHECKING:
    from rocking_cli.ask.answer import Answer


class OnTerminal(Watcher):
    """Watcher that prints, and goes on without the motions and structures that cannot be used."""

    def __init__(self, *, as_json: bool = False) -> None:
        self.left_out = 0
        self._unwritten: list[RockingError] = []
        self._as_json = as_json

    def speak(self, language: str) -> None:
        """Print notes and warnings in this language from now on, as far as it has them."""
        terminal.speak(language)

    def note(self, text: str) -> None:
        """Print a note."""
        terminal.note(text)

    def warn(self, text: str) -> None:
        """Print a warning."""
        terminal.warning(text)

    def leave_out(self, error: RockingError) -> None:
        """Print an error, and count it; raise one of the system, as that of a full disk is not of this motion."""
        if isinstance(error, Refused):
            raise error
        terminal.error(str(error))
        terminal.debug_traceback(error)
        self.left_out += 1

    def take(self, answer: Answer[Any]) -> bool:
        """Print one of several answers as JSON, if requested: a line each, as soon as it is ready."""
        if self._as_json:
            terminal.show(answer.view, as_json=True)
        return True

    def incomplete(self, text: str) -> None:
        """Print an error, and count it."""
        terminal.error(text)
        self.left_out += 1

    def unwritten(self, error: RockingError) -> None:
        """Keep an error until the answer is shown."""
        self._unwritten.append(error)

    def detail(self, text: str) -> None:
        """Print a detail, with --verbose."""
        terminal.detail(text)

    def working(self, what: str) -> AbstractContextManager[None]:
        """Show a spinner."""
        return terminal.working(what)

    def progress(
        self, total: int, what: str, *, done: int = 0, failed: int = 0
    ) -> AbstractContextManager[Advance]:  # fmt: skip
        """Show a progress bar."""
        return terminal.progress(total, what, done=done, failed=failed)

    def end(self) -> None:
        """End the command; with the exit code of an incomplete answer if anything was left out or is unwritten."""
        for error in self._unwritten:
            self.leave_out(error)
        if self.left_out:
            click.get_current_context().exit(EXIT_INCOMPLETE)

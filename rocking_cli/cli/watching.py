"""The terminal as the watcher of a verb: notes and progress, and what was left out."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING, Any, BinaryIO

import click

from rocking_cli.ask.watcher import Advance, Watcher
from rocking_cli.cli import terminal
from rocking_cli.errors import EXIT_INCOMPLETE, Refused, RockingError, SolverError

if TYPE_CHECKING:
    from rocking_cli.ask.answer import Answer


class OnTerminal(Watcher):
    """Watcher that prints, and goes on without the motions and structures that cannot be used."""

    def __init__(self, *, as_json: bool = False) -> None:
        self.left_out = 0
        self.taken = False  # whether answers were printed as soon as they were ready
        self._unwritten: list[RockingError] = []
        self.as_json, self._failed, self._given = as_json, False, dict[str, Any]()
        self.in_detail = terminal.asked("verbose")

    def begin(self, given: Mapping[str, Any]) -> None:
        """Keep the options for the answers that are taken."""
        self._given = self._given or dict(given)

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
        if self.as_json:
            terminal.show(answer.view.plus(lambda: {"given": self._given}), as_json=True)
            self.taken = True
        return True

    def incomplete(self, text: str) -> None:
        """Print an error, and count it."""
        terminal.error(text)
        self.left_out += 1

    def unwritten(self, error: RockingError) -> None:
        """Keep an error until the answer is shown."""
        self._unwritten.append(error)

    def fail(self, error: Exception | None) -> None:
        """Count a check that failed."""
        terminal.debug_traceback(error)
        self._failed = True

    def detail(self, text: str) -> None:
        """Print a detail, with --verbose."""
        terminal.detail(text)

    def standard_output(self) -> AbstractContextManager[BinaryIO]:
        """Keep all but a table off standard output."""
        return terminal.results_as_bytes()

    def working(self, what: str) -> AbstractContextManager[None]:
        """Show a spinner."""
        return terminal.working(what)

    def progress(
        self, total: int, what: str, *, done: int = 0, failed: int = 0
    ) -> AbstractContextManager[Advance]:  # fmt: skip
        """Show a progress bar."""
        return terminal.progress(total, what, done=done, failed=failed)

    def end(self) -> None:
        """End the command; with the exit code of a failed check, or of an answer that lacks something."""
        for error in self._unwritten:
            self.leave_out(error)
        if self._failed:
            click.get_current_context().exit(SolverError.exit_code)
        if self.left_out:
            click.get_current_context().exit(EXIT_INCOMPLETE)

"""Callbacks of a verb: what it reports while it works, and what it cannot use."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from contextlib import AbstractContextManager, nullcontext
from typing import TYPE_CHECKING, Any, BinaryIO, Protocol

from rocking_cli.errors import DoubtWarning, RockingError, warn

if TYPE_CHECKING:
    from rocking_cli.ask.answer import Answer


class Advance(Protocol):
    """Function that counts work."""

    def __call__(self, count: int, failed: int = 0) -> None:
        """Add pieces done since the last call, and those of them that failed."""


class Watcher:
    """Watcher of a verb. This one only warns, and one motion or structure that cannot be used ends the verb.

    Derive from it to show the progress of a long study, or to leave out bad records and go on:

    >>> class Patient(Watcher):
    ...     def leave_out(self, error):
    ...         print("left out:", error)
    """

    def __repr__(self) -> str:
        return f"{type(self).__name__}()"  # as it stands in the signature of a verb

    in_detail = False
    """Whether the answer is to show every detail."""
    as_json = False
    """Whether the answer is for a program."""

    def begin(self, given: Mapping[str, Any]) -> None:
        """Begin the answer to a question, of which these options are given."""

    def speak(self, language: str) -> None:
        """Take the language of the answer."""

    def note(self, text: str) -> None:
        """Take a note, such as which record was read."""

    def warn(self, text: str) -> None:
        """Take a warning, such as of a record that drifts: here, a `DoubtWarning` of Python."""
        warn(DoubtWarning(text))

    def detail(self, text: str) -> None:
        """Take a detail, for those who ask for it."""

    def leave_out(self, error: RockingError) -> None:
        """Take the error of one of several motions or structures: return to go on without it, or raise."""
        raise error

    def take(self, answer: Answer[Any]) -> bool:
        """Take one of several answers as soon as it is ready; return whether it need not be kept for the end."""
        return False

    def incomplete(self, text: str) -> None:
        """Take a sentence on what the answer lacks, such as motions that could not be simulated."""

    def unwritten(self, error: RockingError) -> None:
        """Take the error of a file that could not be written: raise, or return to go on to the answer, which is known.

        A watcher that returns has to tell of the error beside the answer.
        """
        raise error

    def fail(self, error: Exception | None) -> None:
        """Take a check of the installation that failed, with the error that ended it."""

    def standard_output(self) -> AbstractContextManager[BinaryIO]:
        """Give standard output to a table."""
        return nullcontext(sys.stdout.buffer)

    def working(self, what: str) -> AbstractContextManager[None]:
        """Begin one piece of work that may take long, which `what` names."""
        return nullcontext()

    def progress(
        self, total: int, what: str, *, done: int = 0, failed: int = 0
    ) -> AbstractContextManager[Advance]:  # fmt: skip
        """Begin work of `total` pieces, which `what` names; yields the function that counts them.

        Of these, `done` were done before, and `failed` of them could not be.
        """
        return nullcontext(_count_nothing)


def _count_nothing(count: int, failed: int = 0) -> None:
    """Ignore progress."""


SILENT = Watcher()

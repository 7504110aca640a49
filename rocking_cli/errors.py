"""What can go wrong, as exceptions a person can read.

Every error the package raises on purpose is a `RockingError`; the command line turns it into a message and
the exit code of its class. An overturned structure is a result, not an error.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import ClassVar

from rocking_cli.text import one_line, printable, quoted_line

INCOMPLETE = 5
"""Exit code of a command that did its work except for what it reports: one bad record in a hundred."""


@dataclass(frozen=True)
class Problem:
    """One thing wrong with an input: what, where, and what to do.

    Parameters
    ----------
    message : str
        What is wrong, one sentence without a full stop.
    file : str, optional
        The file it was found in.
    line, column : int, optional
        Its place there, counted from 1.
    field : str, optional
        The field or option concerned.
    excerpt : str, optional
        The offending line of the file.
    hint : str, optional
        What to do about it.
    """

    message: str
    file: str | None = None
    line: int | None = None
    column: int | None = None
    field: str | None = None
    excerpt: str | None = None
    hint: str | None = None

    def __str__(self) -> str:
        place = ":".join(one_line(str(part)) for part in (self.file, self.line, self.column) if part is not None)
        # What is quoted of a file must not command the terminal, nor fill it.
        head = ": ".join(printable(part) for part in (place, self.field, self.message) if part)
        lines = [head]
        if self.excerpt is not None:
            lines += [f"    {line}" for line in quoted_line(self.excerpt, self.column)]
        if self.hint:
            lines.append(f"  {printable(self.hint)}")
        return "\n".join(lines)


class RockingError(Exception):
    """Any error that rocking-cli raises on purpose."""

    exit_code: ClassVar[int] = 1


class InputError(RockingError):
    """A file, field or option that cannot be used; it lists every `Problem` found.

    Parameters
    ----------
    *problems : Problem or str
        At least one.
    """

    exit_code = 2

    def __init__(self, *problems: Problem | str) -> None:
        self.problems = tuple(p if isinstance(p, Problem) else Problem(p) for p in problems)
        super().__init__("\n".join(str(p) for p in self.problems))


def renamed(error: InputError, options: Mapping[str, str]) -> InputError:
    """The same problems, with the names that options have where the user gave them.

    Parameters
    ----------
    error : InputError
        What a reader says, which knows an option by one name only.
    options : mapping of str to str
        That name, such as `--dt`, and the one it has here.

    Returns
    -------
    InputError
        A new one.
    """
    pattern = re.compile("|".join(rf"{re.escape(name)}(?![\w-])" for name in options))

    def change(text: str | None) -> str | None:
        return text and pattern.sub(lambda match: options[match[0]], text)

    return InputError(
        *(
            replace(each, message=change(each.message) or "", field=change(each.field), hint=change(each.hint))
            for each in error.problems
        )
    )


class Refused(RockingError):
    """What the system does not let us do: a full disk."""


class MechanismError(RockingError):
    """A mechanism or plugin that does not hold its side of the contract, or whose mechanics has no answer."""

    exit_code = 3


class PluginError(MechanismError):
    """An error of a plugin's own, raised from whatever its code raised; it says whose it is and where."""


class PluginWarning(UserWarning):
    """A plugin that cannot be used and is left out, while all others go on."""


class SolverError(RockingError):
    """A solver that could not reach an answer it can stand behind."""

    exit_code = 4

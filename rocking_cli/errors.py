"""Exceptions of the package, with messages for users.

Every error the package raises on purpose is a `RockingError`; the command line turns it into a message and
the exit code of its class. An overturned structure is a result, not an error.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from itertools import takewhile
from typing import ClassVar

from rocking_cli.text import one_line, printable, quoted_line

PREDICATES = frozenset({
    "applies", "are", "begins", "belongs", "can", "cannot", "comes", "contains", "cuts", "depends", "does", "ends",
    "exceeds", "fits", "follows", "gives", "goes", "had", "has", "have", "is", "joins", "lacks", "leaves", "lies",
    "makes", "may", "must", "names", "needs", "occurs", "reads", "refers", "repeats", "requires", "runs", "should",
    "stands", "starts", "steps", "takes", "turns", "uses", "was", "were", "would",
})  # fmt: skip
"""First words of messages that are the predicate of the field before them: "FC is missing"."""

EXIT_INCOMPLETE = 5
"""Exit code of a command that did its work except for the parts that it reports, such as one bad record."""

MAX_SHOWN_PROBLEMS = 20  # in the text of an error, which counts the others


_spelling: ContextVar[Callable[[str], str]] = ContextVar("spelling", default="`{}`".format)


def named(argument: str) -> str:
    """Return an argument as it was given: in backticks in Python, with two dashes on the command line."""
    return _spelling.get()(argument)


@contextmanager
def spelled(spell: Callable[[str], str]) -> Iterator[None]:
    """Name arguments by a function of their names within this context."""
    token = _spelling.set(spell)
    try:
        yield
    finally:
        _spelling.reset(token)


def how_to_correct(name: str, value: str = "...") -> str:
    """Return how a record is corrected, as it is typed."""
    if (typed := named(name)).startswith("`"):
        return f"`rk.read_record(FILE, {name}={value})`"
    return f"`rocking record FILE {typed} {value} {named('out')} PREPARED.csv`"


@dataclass(frozen=True)
class Problem:
    """One thing wrong with an input: what is wrong, where, and what to do.

    Parameters
    ----------
    message : str
        What is wrong, one sentence without a full stop.
    file : str, optional
        The file that has the problem.
    line, column : int, optional
        Place of the problem in the file, counted from 1.
    field : str, optional
        The field or option concerned.
    excerpt : str, optional
        The offending line of the file.
    hint : str, optional
        Remedy.
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
        # Text quoted from a file must neither control the terminal nor fill it.
        joint = " " if self.message.partition(" ")[0] in PREDICATES else ": "
        what = joint.join(printable(part) for part in (self.field, self.message) if part)
        lines = [f"{place}: {what}" if place else what]
        if self.excerpt is not None:
            lines += [f"    {line}" for line in quoted_line(self.excerpt, self.column)]
        if self.hint:
            lines.append(f"  {printable(self.hint)}")
        return "\n".join(lines)


class RockingError(Exception):
    """Any error that rocking-cli raises on purpose."""

    exit_code: ClassVar[int] = 1


class InputError(RockingError):
    """A file, field or option that cannot be used, with every `Problem` found.

    Parameters
    ----------
    *problems : Problem or str
        At least one.
    """

    exit_code = 2

    def __init__(self, *problems: Problem | str) -> None:
        self.problems = tuple(p if isinstance(p, Problem) else Problem(p) for p in problems)
        more = len(self.problems) - MAX_SHOWN_PROBLEMS
        rest = [f"and {more:,} more problems"] if more > 0 else []
        super().__init__("\n".join([*map(str, self.problems[:MAX_SHOWN_PROBLEMS]), *rest]))


class FieldError(InputError, ValueError):
    """Unknown fields or invalid values given to a mechanism in Python; also a `ValueError`."""


@contextmanager
def renamed(arguments: Mapping[str, str]) -> Iterator[None]:
    """Name arguments by other names within this context, `vertical_dt` for `dt`."""
    spell = _spelling.get()
    with spelled(lambda name: spell(arguments.get(name, name))):
        yield


def warn(warning: Warning) -> None:
    """Warn at the line outside this package that called it."""
    import traceback  # slow, and needed for a warning alone

    stack = traceback.walk_stack(sys._getframe(1))
    inside = takewhile(lambda each: str(each[0].f_globals.get("__name__")).startswith("rocking_cli"), stack)
    warnings.warn(warning, stacklevel=2 + sum(1 for _ in inside))


class Refused(RockingError):
    """An operation that the operating system refuses, such as a write to a full disk."""


class MechanismError(RockingError):
    """A mechanism or plugin that breaks the contract of `Mechanism`."""

    exit_code = 3


class StructureError(MechanismError):
    """A structure that its mechanism cannot analyse, such as one that cannot stand: change its file."""

    exit_code = InputError.exit_code


def of_structure(error: MechanismError, name: str) -> MechanismError:
    """Return an error of the same class whose message begins with the name of the structure, only once.

    Parameters
    ----------
    error : MechanismError
        The error of the mechanism.
    name : str
        Name of the structure.
    """
    message, begins = str(error), f"{name}: "
    kind = type(error) if isinstance(error, StructureError) else MechanismError
    return kind(message if message.startswith(begins) else begins + message)


class PluginError(MechanismError):
    """An error inside a plugin's code; the message names the plugin and the place."""


class PluginWarning(UserWarning):
    """Warning of a plugin that cannot be used and is left out; the others remain available."""


class BrokenKernels(ImportError):
    """Shipped kernels of this system that are damaged, missing or do not load."""


class DoubtWarning(UserWarning):
    """Warning of an input that is used as it is, though it is doubtful, such as a record that drifts."""


class KernelWarning(UserWarning):
    """Warning of kernels that run far slower than possible."""


class KeptWarning(UserWarning):
    """Warning of what the program kept for itself, which is damaged and is computed anew."""


class SolverError(RockingError):
    """A numerical solution that did not converge to a reliable result."""

    exit_code = 4

"""The only module that writes to the terminal: results on standard output, everything else on standard error.

Texts may quote files and their names, so control characters for the terminal are removed.
"""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, nullcontext, redirect_stdout
from functools import partial
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, Any, BinaryIO, TextIO

import click

from rocking_cli.ask.watcher import Advance, Watcher
from rocking_cli.cli.layout import grid, stacked, wrapped
from rocking_cli.errors import (
    EXIT_INCOMPLETE,
    DoubtWarning,
    KeptWarning,
    KernelWarning,
    PluginWarning,
    Refused,
    RockingError,
    SolverError,
)
from rocking_cli.text import printable
from rocking_cli.views.view import ASIDE, Aside

if TYPE_CHECKING:
    from rocking_cli.ask.answer import Answer
    from rocking_cli.views.view import Table, View

PROGRESS_DELAY = 1.0  # s of work before progress is shown
NOWHERE = Path(os.devnull)
DEFAULT_WIDTH = 80  # columns of a terminal whose width is unknown

_results: TextIO | None = None
_said: Callable[[str], str] = str
"""Returns a note or warning in the language of the answer."""


class _Messages:
    """Standard error; what it cannot write is lost, as messages are not the work."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)

    def write(self, text: str) -> int:
        """Write a text."""
        with _lossy(self._stream):
            self._stream.write(text)
        return len(text)

    def flush(self) -> None:
        """Write what is kept back."""
        with _lossy(self._stream):
            self._stream.flush()


@contextmanager
def _lossy(stream: TextIO) -> Iterator[None]:
    """Lead a stream nowhere, with what it keeps back, if it cannot be written."""
    try:
        yield
    except OSError:
        with NOWHERE.open("wb") as nowhere:
            os.dup2(nowhere.fileno(), stream.fileno())


@contextmanager
def streams() -> Iterator[None]:
    """Give the program its two streams, if they are closed, broken or full as well.

    Python would end with its own exit code, and its own message, if it could not write what a stream keeps back.
    """
    sys.stdout, sys.stderr = (stream or NOWHERE.open("w") for stream in (sys.stdout, sys.stderr))
    out, messages = sys.stdout, sys.stderr
    sys.stderr = _Messages(messages)
    try:
        yield
    finally:
        sys.stdout, sys.stderr = out, messages
        for stream in (out, messages):
            with _lossy(stream):
                stream.flush()


@contextmanager
def results_only() -> Iterator[None]:
    """Reserve standard output for this module; all other output goes to standard error.

    Plugins and their imports may print at any time and in any thread.
    """
    global _results, _said
    before = _results, _said
    try:
        with nullcontext(_results) if _results else _apart(sys.stdout) as _results, redirect_stdout(sys.stderr):
            yield
    finally:
        _results, _said = before


@contextmanager
def _apart(stream: TextIO) -> Iterator[TextIO]:
    """Yield a stream that leads where another does; what others write to its number, as C may, is on standard error."""
    try:
        number, messages = stream.fileno(), sys.stderr.fileno()
    except (OSError, ValueError):  # it is none of the system
        yield stream
        return
    stream.flush()
    with os.fdopen(os.dup(number), "w", encoding=stream.encoding, errors=stream.errors) as results:
        os.dup2(messages, number)
        try:
            yield results
        finally:
            os.dup2(results.fileno(), number)


def speak(language: str) -> None:
    """Print notes and warnings of this run in a language from now on, as far as it has them."""
    from rocking_cli.views.sheet.language import Language

    global _said
    _said = partial(Language(language, is_plain=True).recognised, "shown")


@contextmanager
def plugins_apart() -> Iterator[None]:
    """Keep output of plugins out of the results, and show their warnings like other warnings of this program."""
    with results_only(), warnings.catch_warnings():
        warnings.simplefilter("always", PluginWarning)
        otherwise = warnings.showwarning

        def show(message: Warning | str, category: type[Warning], *where: Any, **more: Any) -> None:
            if issubclass(category, KeptWarning):
                detail(str(message))
            elif issubclass(category, (PluginWarning, KernelWarning, DoubtWarning)):
                warning(str(message))
                debug_traceback(message.__cause__ if isinstance(message, Warning) else None)
            else:
                otherwise(message, category, *where, **more)

        warnings.showwarning = show
        yield


@contextmanager
def results_as_bytes() -> Iterator[BinaryIO]:
    """Give standard output to one result as a file; all later output of this module goes to standard error."""
    global _results
    text: Any = _results or sys.stdout
    text.flush()
    _results = sys.stderr
    yield text.buffer
    text.flush()


def result(text: str = "") -> None:
    """Print a line of the result unchanged: of a file, or for another program to read."""
    click.echo(printable(text), file=_results)


def sentence(text: str) -> None:
    """Print a sentence of the result, in lines of the terminal's width."""
    click.echo(wrapped(printable(text), width()), file=_results)


def print_json(data: Mapping[str, Any]) -> None:
    """Print one JSON object on one line of standard output."""
    from rocking_cli.io.json_text import json_text

    click.echo(json_text(data), file=_results)


def note(text: str) -> None:
    """Print a note that is not part of the result."""
    _say(_said(text))


def warning(text: str) -> None:
    """Print a warning."""
    _say(_said(text), "warning: ", "yellow")


def error(text: str) -> None:
    """Print an error; several problems have a line each."""
    _say(text, "error: ", "red")


def _say(text: str, prefix: str = "", colour: str | None = None) -> None:
    """Print sentences on standard error, in lines of its terminal's width."""
    lines = beside(printable(text), prefix)
    click.echo((click.style(prefix, fg=colour, bold=True) if prefix else "") + lines, err=True)


def beside(text: str, prefix: str) -> str:
    """Return a text in lines of the width of standard error, to be printed after a prefix."""
    return wrapped(text, _columns(sys.stderr), start=len(prefix))


def asked(switch: str) -> bool:
    """Return whether a switch of `rocking` itself is on: `debug` or `verbose`."""
    context = click.get_current_context(silent=True)
    return bool(context is not None and context.find_root().params.get(switch))


def detail(text: str) -> None:
    """Print a detail, with --verbose only."""
    if asked("verbose"):
        note(text)


def debug_traceback(error: BaseException | None) -> None:
    """Print the traceback of an error, with --debug; that of the plugin, if a plugin caused it."""
    from rocking_cli.plugins.errors import own_traceback

    if error is not None and asked("debug"):
        from traceback import format_exception

        click.echo(printable(own_traceback(error) or "".join(format_exception(error)).rstrip("\n")), err=True)


def width() -> int | None:
    """Return the columns of the terminal for results; None for a pipe or a file, in which no line is broken."""
    return _columns(_results or sys.stdout)


def _columns(stream: TextIO) -> int | None:
    """Return the columns of a terminal; COLUMNS in the environment has priority, as in other programs."""
    columns = os.environ.get("COLUMNS", "")
    if columns.isdecimal() and int(columns) > 0:
        return int(columns)
    try:
        return os.get_terminal_size(stream.fileno()).columns or DEFAULT_WIDTH
    except (OSError, ValueError):  # the stream is not a terminal, or is one of unknown size
        return None


@contextmanager
def progress(total: int, what: str, *, done: int = 0, failed: int = 0) -> Iterator[Advance]:
    """Show a progress bar for work of more than a second, on standard error if that is a terminal.

    Parameters
    ----------
    total : int
        Number of pieces of work.
    what : str
        Name of the pieces.
    done, failed : int
        Pieces done before, and those of them that failed.

    Yields
    ------
    Advance
        Function to call as work is done.
    """
    if not sys.stderr.isatty():
        yield lambda count, failed=0: None
        return
    bar: Any = None
    bad, new, began = failed, 0, monotonic()

    def advance(count: int, failed: int = 0) -> None:
        nonlocal bar, bad, new
        bad, new = bad + failed, new + count
        took = monotonic() - began
        if bar is None and took > PROGRESS_DELAY:
            bar = _bar()
            bar.add_task(what, total=total, rate="", failures="")
            bar.start()
        if bar is not None:
            rate = new / took
            bar.update(
                bar.task_ids[0],
                completed=done + new,
                rate=f"{rate:.3g}/s" if rate < 1000 else f"{rate:,.0f}/s",
                failures=f"{bad} failed" if bad else "",
            )

    try:
        yield advance
    finally:
        if bar is not None:
            bar.stop()


def _bar() -> Any:
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    return Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[rate]}"),
        TextColumn("{task.fields[failures]}", style="red"),
        TimeRemainingColumn(),
        console=Console(stderr=True),
        transient=True,
    )


@contextmanager
def working(what: str) -> Iterator[None]:
    """Show a spinner and the seconds during one long piece of work, on a terminal only."""
    if not sys.stderr.isatty():
        yield
        return

    from rich.console import Console
    from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    columns = SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn()
    with Progress(*columns, console=Console(stderr=True), transient=True) as moving:
        moving.add_task(printable(what), total=None)
        yield


def table(shown: Table, *, in_full: bool = True) -> bool:
    """Print a table of the result: a grid, without the least important columns if the terminal is narrow.

    If not even the most important columns fit, or if all are to be shown, it is a block of lines for each row.

    Parameters
    ----------
    shown : Table
        The table; a line break in a heading or a cell is kept in a grid.
    in_full : bool
        Whether all rows and columns are shown.

    Returns
    -------
    bool
        Whether the table has rows or columns that are not shown because they are of little importance.
    """
    room, ranks = width(), shown.ranks or [0] * len(shown.columns)
    rows = [row for k, row in enumerate(shown.rows) if in_full or k not in shown.asides]
    kept = [k for k, rank in enumerate(ranks) if in_full or rank < ASIDE]
    aside = len(rows) < len(shown.rows) or len(kept) < len(ranks)
    if shown.rows and not rows:
        return aside
    if shown.title:
        click.echo(click.style(wrapped(printable(shown.title), room), bold=True), file=_results)
    encoding = getattr(_results or sys.stdout, "encoding", None) or "utf-8"
    rule, left = "─" if encoding.lower().startswith("utf") else "-", list[int]()
    while True:
        columns, *cells = [[printable(line[k]) for k in kept] for line in (shown.columns, *rows)]
        numbers = [k for k, place in enumerate(kept) if place in shown.numbers]
        lines = grid(columns, cells, numbers, room, rule)
        least = max(kept, key=lambda k: (ranks[k], k))
        if lines is not None or in_full or not ranks[least]:
            lines = lines or (grid(columns, cells, numbers, room, rule, narrow=True) if left else None)
            break
        kept.remove(least)
        left.append(least)
    if lines is not None:
        heads, body = lines
        click.echo("\n".join([*(click.style(line, bold=True) for line in heads), *body]), file=_results)
    else:
        assert room is not None  # without a width, every grid fits
        click.echo("\n".join(["", *stacked(columns, cells, room), ""]), file=_results)
    if left:
        names = ", ".join(shown.columns[k].replace("\n", " ") for k in sorted(left))
        sentence(f"No room for {names}: use a wider terminal, or --all.")
    return aside


def show(view: View, *, as_json: bool) -> None:
    """Print a result: as one line of JSON, or as its tables and sentences, with options as they are typed.

    Without --all, a command that has this option leaves out what is of little importance.
    """
    if as_json:
        print_json(view.plain())
        return
    context = click.get_current_context(silent=True)
    in_full = context is None or context.params.get("in_full", True) or asked("verbose")
    more = False
    for part in view.parts:
        if not isinstance(part, str):
            more |= table(part, in_full=in_full)
        elif in_full or not isinstance(part, Aside):
            sentence(part)
        else:
            more = True
    if more:
        note("--all shows more")


class OnTerminal(Watcher):
    """Watcher of a verb that prints, and goes on without the motions and structures that cannot be used."""

    speak, note, warn, detail = staticmethod(speak), staticmethod(note), staticmethod(warning), staticmethod(detail)
    working, progress = staticmethod(working), staticmethod(progress)
    standard_output = staticmethod(results_as_bytes)

    def __init__(self, *, as_json: bool = False) -> None:
        self.left_out = 0
        self.taken = False  # whether answers were printed as soon as they were ready
        self._unwritten: list[RockingError] = []
        self.as_json, self._failed, self._given = as_json, False, dict[str, Any]()
        self.in_detail = asked("verbose")

    def begin(self, given: Mapping[str, Any]) -> None:
        """Keep the options for the answers that are taken."""
        self._given = self._given or dict(given)

    def leave_out(self, error: RockingError) -> None:
        """Print an error, and count it; raise one of the system, as that of a full disk is not of this motion."""
        if isinstance(error, Refused):
            raise error
        self.incomplete(str(error))
        debug_traceback(error)

    def take(self, answer: Answer[Any]) -> bool:
        """Print one of several answers as JSON, if requested: a line each, as soon as it is ready."""
        if self.as_json:
            show(answer.view.plus(lambda: {"given": self._given}), as_json=True)
            self.taken = True
        return True

    def incomplete(self, text: str) -> None:
        """Print an error, and count it."""
        error(text)
        self.left_out += 1

    def unwritten(self, error: RockingError) -> None:
        """Keep an error until the answer is shown."""
        self._unwritten.append(error)

    def fail(self, error: Exception | None) -> None:
        """Count a check that failed."""
        debug_traceback(error)
        self._failed = True

    def end(self) -> None:
        """End the command; with the exit code of a failed check, or of an answer that lacks something."""
        for error in self._unwritten:
            self.leave_out(error)
        if self._failed:
            click.get_current_context().exit(SolverError.exit_code)
        if self.left_out:
            click.get_current_context().exit(EXIT_INCOMPLETE)

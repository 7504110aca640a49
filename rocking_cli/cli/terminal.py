"""The one place that writes to the terminal: results on standard output, everything else on standard error.

What it is given may quote files and their names: nothing in it commands the terminal.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager, redirect_stdout
from time import monotonic
from typing import TYPE_CHECKING, Any, BinaryIO, Protocol, TextIO

import click

from rocking_cli.io.json_text import json_text
from rocking_cli.text import printable

if TYPE_CHECKING:
    from rocking_cli.views.view import View

PATIENCE = 1.0  # s of work before it is shown
NARROW = 76  # columns below which a table's explanations are left out: they would break into syllables


_results: TextIO | None = None


@contextmanager
def results_only() -> Iterator[None]:
    """Keep standard output to what this module prints: whatever else is printed goes to standard error.

    Plugins print, on import or at work, and so may what they import, in any thread.
    """
    global _results
    before, _results = _results, _results or sys.stdout
    try:
        with redirect_stdout(sys.stderr):
            yield
    finally:
        _results = before


@contextmanager
def results_as_bytes() -> Iterator[BinaryIO]:
    """Standard output for one result as a file; all else that this module prints goes to standard error after it."""
    global _results
    text: Any = _results or sys.stdout
    text.flush()
    _results = sys.stderr
    yield text.buffer
    text.flush()


def result(text: str = "") -> None:
    """A line of the result."""
    click.echo(printable(text), file=_results)


def print_json(data: Mapping[str, Any]) -> None:
    """One JSON object on one line of standard output."""
    click.echo(json_text(data), file=_results)


def as_typed(text: str, command: click.Command | None = None) -> str:
    """A text in which arguments stand in backticks, with those that are options of a command as they are typed.

    Without a command, of the one that runs.
    """
    context = click.get_current_context(silent=True)
    command = command or (context.command if context is not None else None)
    options = [each for each in command.params if isinstance(each, click.Option)] if command is not None else []
    typed = {each.name: max(each.opts, key=len) for each in options}
    return re.sub(r"`(\w+)`", lambda match: typed.get(match[1], match[0]), text)


def note(text: str) -> None:
    """Something to know that is not part of the result."""
    click.echo(printable(as_typed(text)), err=True)


def warning(text: str) -> None:
    """Something to be careful about."""
    click.echo(click.style("warning: ", fg="yellow", bold=True) + printable(as_typed(text)), err=True)


def error(text: str) -> None:
    """What went wrong; a line each for several problems."""
    click.echo(click.style("error: ", fg="red", bold=True) + printable(as_typed(text)), err=True)


def asked(switch: str) -> bool:
    """Whether a switch of `rocking` itself is on: `debug` or `verbose`."""
    context = click.get_current_context(silent=True)
    return bool(context is not None and context.find_root().params.get(switch))


def detail(text: str) -> None:
    """Something that only some want to know: with --verbose."""
    if asked("verbose"):
        note(text)


def debug_traceback(error: BaseException | None) -> None:
    """The traceback of an error, with --debug; of what a plugin itself raised, if that is at the bottom of it."""
    from rocking_cli.plugins.errors import own_traceback

    if error is not None and asked("debug"):
        from traceback import format_exception

        note(own_traceback(error) or "".join(format_exception(error)).rstrip("\n"))


def width() -> int:
    """Columns of the terminal."""
    from rich.console import Console

    return Console(file=_results).width


class Advance(Protocol):
    """What moves a bar of work."""

    def __call__(self, count: int, failed: int = 0) -> None:
        """Tell how many pieces are done since the last call, and how many of these failed."""


@contextmanager
def progress(total: int, what: str, *, done: int = 0, failed: int = 0) -> Iterator[Advance]:
    """A bar of work that takes more than a second, on standard error if that is a terminal.

    Parameters
    ----------
    total : int
        How many pieces of work there are.
    what : str
        What they are.
    done, failed : int
        Pieces done, and those that failed, before.

    Yields
    ------
    Advance
        To be called as work is done.
    """
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    console = Console(stderr=True)
    bar = Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[rate]}"),
        TextColumn("{task.fields[failures]}", style="red"),
        TimeRemainingColumn(),
        console=console,
        transient=True,
        disable=not console.is_terminal,
    )
    bad, new, began = failed, 0, monotonic()

    def told() -> dict[str, Any]:
        rate = new / max(monotonic() - began, 1e-9)
        return {
            "rate": f"{rate:.3g}/s" if rate < 1000 else f"{rate:,.0f}/s",
            "failures": f"{bad} failed" if bad else "",
        }

    task = bar.add_task(what, total=total, completed=done, **told())

    def advance(count: int, failed: int = 0) -> None:
        nonlocal bad, new
        bad, new = bad + failed, new + count
        bar.update(task, advance=count, **told())
        if not bar.live.is_started and monotonic() - began > PATIENCE:
            bar.start()

    try:
        yield advance
    finally:
        bar.stop()


@contextmanager
def working(what: str) -> Iterator[None]:
    """Something that moves, and the seconds, while one long piece of work is done; on a terminal only."""
    from rich.console import Console
    from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    console = Console(stderr=True)
    columns = SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn()
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as moving:
        moving.add_task(printable(what), total=None)
        yield


def table(
    title: str,
    columns: Sequence[str],
    rows: Sequence[Sequence[str]],
    *,
    numbers: Collection[int] = (),
    explained: bool = False,
) -> None:
    """A table of the result.

    Parameters
    ----------
    title : str
        Printed above it.
    columns : sequence of str
        Headings; a line break in one, or in a cell, is kept.
    rows : sequence of sequence of str
        Cells.
    numbers : collection of int
        Indexes of columns to align to the right; these and the first never wrap.
    explained : bool
        Whether the last column only explains, and may be left out on a narrow terminal.
    """
    from rich import box
    from rich.console import Console
    from rich.measure import Measurement
    from rich.table import Table
    from rich.text import Text

    title, columns = printable(title), [printable(each) for each in columns]
    rows = [[printable(cell) for cell in row] for row in rows]
    console = Console(file=_results)
    if explained and console.width < NARROW:
        columns, rows = columns[:-1], [row[:-1] for row in rows]
    drawn = Table(
        title=Text(title) if title else None,
        title_justify="left",
        box=box.SIMPLE_HEAD,
        title_style="bold",
        pad_edge=False,
    )
    for k, heading in enumerate(columns):
        whole = k == 0 or k in numbers
        drawn.add_column(
            Text(heading),
            justify="right" if k in numbers else "left",
            no_wrap=whole,
            min_width=max(_widest_line(cell) for cell in [heading, *(row[k] for row in rows)]) if whole else None,
            overflow="fold",
        )
    for row in rows:
        drawn.add_row(*(Text(cell) for cell in row))
    # Wider than the terminal rather than with digits cut off.
    unbounded = console.options.update(max_width=1000)
    console.width = max(console.width, Measurement.get(console, unbounded, drawn).minimum)
    console.print(drawn)


def show(view: View, *, as_json: bool) -> None:
    """Print a result: as one line of JSON, or as its tables and sentences."""
    if as_json:
        print_json(view.data() if callable(view.data) else view.data)
        return
    for part in view.parts:
        if isinstance(part, str):
            result(part)
        else:
            table(part.title, part.columns, part.rows, numbers=part.numbers, explained=part.explained)


def _widest_line(text: str) -> int:
    return max(len(line) for line in text.split("\n"))

"""Several motions or structures in one call: an answer to each, and the files of each."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, TypeVar

from rocking_cli.ask.answer import Answer, Answers, Dimensions, no_plot
from rocking_cli.ask.ground_motions import Motions
from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import RockingError, named
from rocking_cli.processing.reading import Scaled
from rocking_cli.text import numbered
from rocking_cli.views.view import Table, View

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.io.tables import Columns

A = TypeVar("A", bound=Answer[Any])


def are_several(given: object, motions: Motions) -> bool:
    """Return whether several motions are given, or any number of them in a list."""
    return motions.count > 1 or (isinstance(given, list | tuple) and not isinstance(given, Scaled))


def answers(
    question: str,
    what: str,
    found: Mapping[str, A],
    parts: Sequence[Table | str],
    figure: Callable[[], Figure] | None = None,
    tables: Mapping[str, Callable[[], Columns]] = MappingProxyType({}),
) -> Answers[A]:
    """Return the answers to a question about several motions or structures, with the parts of their common view.

    `figure` is their common plot and `tables` are further tables of all, if there are any.
    """
    view = View(lambda: {name: each.to_dict() for name, each in found.items()}, parts)
    tables = {**{name: each.columns for name, each in found.items()}, **tables}
    figure = figure or no_plot(f"several {what}s have no common plot", "plot the answer to each")
    dims = [Dimensions((what, *each.names), each.of) for each in next(iter(found.values())).dims] if found else []
    return Answers(question, found, view, partial(_columns, what, found), figure, None, tables, dims)


def ask_each(
    motions: Sequence[Scaled], one: Callable[[Scaled, int], A], watch: Watcher
) -> tuple[dict[str, A], list[str]]:  # fmt: skip
    """Ask about each of several motions.

    Parameters
    ----------
    motions : sequence of Scaled
        The motions, each with a name of its own.
    one : callable
        Function (motion, place) that asks about one.
    watch : Watcher
        Told of each answer, which it may take; and which motions cannot be used.

    Returns
    -------
    dict of str to Answer
        Answers that the watcher did not take.
    list of str
        Names of the motions that cannot be used.

    Raises
    ------
    RockingError
        If none can be used: the error of the last one.
    """
    by_name: dict[str, A] = {}
    left_out: list[str] = []
    with watch.progress(len(motions), "motions") as advance:
        for k, motion in enumerate(motions):
            name = motion.motion.name
            try:
                answer = one(motion, k)
            except RockingError as error:
                left_out.append(name)
                named = type(error)(f"{name}: {error}")
                named.__cause__ = error
                if len(left_out) == len(motions):
                    raise named from error
                watch.leave_out(named)
            else:
                if not watch.take(answer):
                    by_name[name] = answer
            advance(1)
    return by_name, left_out


def places_of(
    argument: str, file: str | Path | None, motions: Sequence[Scaled], read: Sequence[str | Path | None]
) -> list[Path | None]:  # fmt: skip
    """Return the file of each of several motions, `out-accel.csv` and so on for `out.csv` as an `argument`.

    Raises
    ------
    InputError
        If one of them would replace a file that is read.
    """
    from rocking_cli.io.files import keep_apart

    if file is None:
        return [None] * len(motions)
    path, names = Path(file), list[str]()
    for each in motions:
        name = each.motion.name if each.file is None else each.motion.name.replace(each.file.name, each.file.stem, 1)
        word = "-".join(re.findall(r"[\w.+]+", name)) or "motion"
        names.append(numbered(f"{path.stem}-{word}", path.suffix, names))
    places, inputs = [path.with_name(name) for name in names], [str(each) for each in read if each is not None]
    keep_apart([(named(argument), place) for place in places], inputs)
    return list(places)


def _columns(what: str, found: Mapping[str, Answer[Any]]) -> Columns:
    from rocking_cli.io.tables import stacked

    return stacked({what: name} | dict(each.columns()) | {what: name} for name, each in found.items())

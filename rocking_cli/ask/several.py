"""Several motions or structures in one call: an answer to each, and the files of each."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from math import nan
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Concatenate, ParamSpec, Protocol, TypeVar, cast, overload

from rocking_cli.ask.answer import Answer, MappingAnswer, no_plot
from rocking_cli.ask.ground_motions import Motion, Motions
from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import RockingError
from rocking_cli.processing.listed import Scaled
from rocking_cli.text import numbered
from rocking_cli.views.view import Table, View

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.ask.given import StructureLike
    from rocking_cli.io.tables import Columns

A = TypeVar("A", bound=Answer[Any])
T = TypeVar("T", bound=Answer[Any])
P = ParamSpec("P")


class Answers(MappingAnswer[str, A]):
    """Answers to one question about several motions or structures, by their names.

    The frame has the rows of all answers, one answer after the other; `frames` has the frame of each answer, by its
    name. Each answer has its own plot.
    """


class OfMotions(Protocol[P, T]):
    """Type of a verb that takes one motion or several: one motion gives an answer, a list gives `Answers`.

    A pattern of files gives `Answers` too, if it matches several files, which a type checker cannot know.
    """

    @overload  # a `Scaled` is a tuple, but a single motion
    def __call__(self, motion: Motion, *args: P.args, **options: P.kwargs) -> T: ...  # type: ignore[overload-overlap]
    @overload
    def __call__(self, motion: list[Any] | tuple[Any, ...], *args: P.args, **options: P.kwargs) -> Answers[T]: ...
    @overload
    def __call__(self, motion: Motions, *args: P.args, **options: P.kwargs) -> T | Answers[T]: ...


class UnderMotions(Protocol[P, T]):
    """Type of a verb that takes a structure and one motion or several, as `OfMotions`."""

    @overload
    def __call__(  # type: ignore[overload-overlap]
        self, structure: StructureLike, motion: Motion | None = None, *args: P.args, **options: P.kwargs
    ) -> T: ...
    @overload
    def __call__(
        self, structure: StructureLike, motion: list[Any] | tuple[Any, ...], *args: P.args, **options: P.kwargs
    ) -> Answers[T]: ...
    @overload
    def __call__(
        self, structure: StructureLike, motion: Motions | None, *args: P.args, **options: P.kwargs
    ) -> T | Answers[T]: ...


def of_motions(verb: Callable[Concatenate[Any, P], A | Answers[A]]) -> OfMotions[P, A]:
    """Return a verb unchanged; type checkers then see the type `OfMotions`."""
    return cast("OfMotions[P, A]", verb)


def under_motions(verb: Callable[Concatenate[Any, Any, P], A | Answers[A]]) -> UnderMotions[P, A]:
    """Return a verb unchanged; type checkers then see the type `UnderMotions`."""
    return cast("UnderMotions[P, A]", verb)


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
    return Answers(question, found, view, partial(_columns, what, found), figure, None, tables)


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
    keep_apart([(f"`{argument}`", place) for place in places], inputs)
    return list(places)


def write_files(answer: Answer[Any], table: str | Path | None, plot: str | Path | None, watch: Watcher) -> None:
    """Write the table and the plot of an answer. Raises `InputError` if that is not possible."""
    if table is not None:
        from rocking_cli.io.tables import write_table

        write_table(Path(table), answer.blocks() if answer.blocks is not None else [answer.columns()])
        watch.note(f"wrote {table}")
    if plot is not None:
        answer.plot(plot)
        watch.note(f"wrote {plot}")


def _columns(what: str, found: Mapping[str, Answer[Any]]) -> Columns:
    tables = {name: dict(each.columns()) for name, each in found.items()}
    rows = {name: len(next(iter(table.values()))) for name, table in tables.items()}
    heads = dict.fromkeys(head for table in tables.values() for head in table if head != what)
    joined: dict[str, list[Any]] = {what: [name for name, count in rows.items() for _ in range(count)]}
    for head in heads:
        joined[head] = [value for name, table in tables.items() for value in table.get(head, [nan] * rows[name])]
    return joined

"""Answers that display themselves: as a sentence, as tables in a notebook, as a frame or as a plot."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from importlib.util import find_spec
from inspect import Parameter, signature
from pathlib import Path
from pkgutil import resolve_name
from threading import RLock
from typing import TYPE_CHECKING, Any, Generic, TypeVar, cast

from rocking_cli.errors import InputError, Problem
from rocking_cli.io.files import check_writable
from rocking_cli.text import numbered
from rocking_cli.views.column import table_of, text_columns
from rocking_cli.views.view import Table, View, number

if TYPE_CHECKING:
    import pandas
    import xarray
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure

    from rocking_cli.io.tables import Columns

R = TypeVar("R")
K = TypeVar("K")
V = TypeVar("V")
Parted = tuple[Mapping[str, Any], Mapping[str, str]]
"""Columns by name, and the units of those that have one."""
_NO_NAME = re.compile(r"[^\w.]+")  # what is not in the name of a column
MAX_REPR_LENGTH = 100  # characters of the text that `repr` shows
SHOWN_ROWS = 5  # at either end of a result that has no table of its own


@dataclass(frozen=True)
class Dimensions:
    """Columns of a long table that vary along the same dimensions, for labelled arrays.

    Parameters
    ----------
    names : tuple of str
        Names of the columns whose values label the dimensions; each row has another combination of them.
    of : tuple of str
        Names of the columns; by default all that no other entry of an answer names.
    table : callable, optional
        Returns the long table; by default that of the frame.
    """

    names: tuple[str, ...]
    of: tuple[str, ...] = ()
    table: Callable[[], Columns] | None = field(default=None, repr=False)


@dataclass(frozen=True, eq=False, repr=False)
class Answer(Generic[R]):
    """Answer to a question. The attributes of its result are also attributes of the answer.

    Parameters
    ----------
    question : str
        Short name of the question.
    result : object
        Result of the study: numbers and arrays.
    view : View
        Text and tables of the result.
    columns : callable
        Returns the result as columns by name.
    figure : callable
        Returns the plot of the result. Keyword-only arguments that are not given yet are arguments of `plot` too.
    blocks : callable, optional
        Returns the columns in blocks of rows, one after the other, if there may be very many.
    tables : mapping of str to callable
        Return further tables of the result as columns, by name.
    dims : sequence of Dimensions
        What varies along which dimensions, if the answer is a grid.
    """

    question: str
    result: R
    view: View
    columns: Callable[[], Columns]
    figure: Callable[..., Figure]
    blocks: Callable[[], Iterable[Columns]] | None = None
    tables: Mapping[str, Callable[[], Columns]] = field(default_factory=dict)
    dims: Sequence[Dimensions] = ()

    def __getstate__(self) -> dict[str, Any]:
        """Return what a pickle keeps: everything, with data and columns computed."""
        columns: Any = partial(dict, self.columns())
        tables: dict[str, Any] = {name: partial(dict, each()) for name, each in self.tables.items()}
        view = View(self.view.plain(), self.view.parts)
        tables_of_dims: dict[Any, Any] = {table: partial(dict, table()) for each in self.dims if (table := each.table)}
        dims = [replace(each, table=each.table and tables_of_dims[each.table]) for each in self.dims]
        return {**vars(self), "view": view, "columns": columns, "blocks": None, "tables": tables, "dims": dims}

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name == "result":
            raise AttributeError(name)
        if self.result is None:
            raise AttributeError(f"there is no {name}: {self.sentences[0]}")
        return getattr(self.result, name)

    @property
    def sentences(self) -> list[str]:
        """Result in words."""
        return [part for part in self.view.parts if isinstance(part, str) and part]

    def to_dict(self) -> dict[str, Any]:
        """Return the result as plain data, equal to the JSON of the command line."""
        from rocking_cli.io.json_text import json_text

        plain: dict[str, Any] = json.loads(json_text(self.view.plain()))
        return plain

    def to_frame(self) -> pandas.DataFrame:
        """Return the result as a frame of pandas, which must be installed; `attrs["units"]` has the units of columns.

        Columns are those of the tables that are written, their names without units and blanks; only the histories of
        `respond` stand beside each other in a file, and one below the other here.

        Raises
        ------
        InputError
            If pandas is not installed.
        """
        return framed(self.columns)

    def to_xarray(self) -> xarray.Dataset:
        """Return the numbers of the frame as labelled arrays of xarray, which must be installed.

        Structures, motions, models and the like are dimensions, with their names as coordinates. Variables and
        coordinates have `attrs["units"]`, if they have units, and `attrs["long_name"]`. What does not exist is NaN, or
        an empty text: a size that only another structure has, or times after a shorter history.

        Raises
        ------
        InputError
            If xarray is not installed, or the answer is not a grid.
        """
        if not self.dims:
            raise InputError(Problem(f"an answer of {self.question} is not a grid", hint="`to_frame` has its rows"))
        if find_spec("xarray") is None:
            hint = "pip install 'rocking-cli[xarray]'"
            raise InputError(Problem("labelled arrays require the package xarray", hint=hint))
        # Dimensions without a table of their own share that of the answer, which is computed once.
        computed = {table: parted(table()) for table in {each.table or self.columns for each in self.dims}}
        return labelled([(each, computed[each.table or self.columns]) for each in self.dims])

    @property
    def frames(self) -> dict[str, pandas.DataFrame]:
        """Further tables of the result as frames, by name. Raises as `to_frame`."""
        return {name: framed(each) for name, each in self.tables.items()}

    def plot(
        self,
        file: str | Path | None = None,
        *,
        ax: Axes | None = None,
        figure: Figure | SubFigure | None = None,
        **asked: Any,
    ) -> Figure:
        """Plot the result, in a figure of its own or in one of yours.

        Parameters
        ----------
        file : str or Path, optional
            File to write the whole figure to as well: .png, .svg or .pdf.
        ax : matplotlib.axes.Axes, optional
            Axes to draw in, if the plot has one panel. What they hold stays.
        figure : matplotlib.figure.Figure or SubFigure, optional
            Figure without axes to draw in, whose size stays. Drawings of structures are made larger or smaller as a
            whole.
        **asked
            What to plot, where an answer lets you choose.

        Returns
        -------
        matplotlib.figure.Figure
            Figure to change, or to show in a notebook: that of `ax` or `figure` if one is given.

        Raises
        ------
        InputError
            If there is no plot; if it has several panels and `ax` is given; if `ax` has another projection than the
            plot, or `figure` has axes; if an argument is unknown, or the file cannot be written.

        Notes
        -----
        Room for labels and legends is made by the layout of your figure: give it `layout="constrained"`.

        Examples
        --------
        >>> import matplotlib.pyplot as plt
        >>> import rocking_cli as rk
        >>> figure, (left, right) = plt.subplots(1, 2, layout="constrained")
        >>> rk.overturning_map(points=24).plot(ax=left) is figure
        True
        """
        _check_asked(self.figure, asked)
        if file is not None and not isinstance(file, str | Path):
            raise InputError(
                Problem(f"must be a path, got {type(file).__name__}", field="`file`", hint="axes are `ax=`")
            )
        if file is not None:
            check_writable(Path(file), ".png", ".svg", ".pdf")
        with _DRAWING:
            drawn = self.figure(**asked) if ax is None and figure is None else _draw_in(ax, figure, self.figure, asked)
            if file is not None:
                from rocking_cli.plotting.style import write

                write(Path(file), drawn)
        return drawn

    def __repr__(self) -> str:
        sentence = " ".join(self.sentences)
        text = sentence if len(sentence) <= MAX_REPR_LENGTH else sentence[: MAX_REPR_LENGTH - 3].rstrip() + "..."
        return f"<{self.question}: {text}>"

    def _repr_html_(self) -> str:
        parts = [part for part in self.view.parts if part]
        if not any(isinstance(part, Table) for part in parts) and len(columns := self.columns()) > 1:
            parts.append(_ends_of(columns))
        return "\n".join(map(_html, parts))


class MappingAnswer(Answer[Mapping[K, V]], Mapping[K, V]):
    """Answer that is a mapping, with items by key."""

    def __getitem__(self, key: K) -> V:
        return self.result[key]

    def __iter__(self) -> Iterator[K]:
        return iter(self.result)

    def __len__(self) -> int:
        return len(self.result)


class Answers(MappingAnswer[str, V]):
    """Answers to one question about several motions or structures, by their names.

    The frame has the rows of all answers, one answer after the other; `frames` has the frame of each answer, by its
    name. Each answer has its own plot.
    """


_DRAWING = RLock()
"""Lock around drawing and writing of plots, as matplotlib is not safe for threads."""


def parted(columns: Columns) -> tuple[dict[str, Any], dict[str, str]]:
    """Return columns by names without units and blanks, and the unit of each that has one.

    Examples
    --------
    >>> parted({"phi/phi_cr": [0.5], "t [s]": [1.0], "known to [s]": [2.0]})
    ({'phi_over_phi_cr': [0.5], 't': [1.0], 'known_to': [2.0]}, {'t': 's', 'known_to': 's'})
    """
    named: dict[str, Any] = {}
    units: dict[str, str] = {}
    for head, values in columns.items():
        words, _, unit = head[:-1].rpartition(" [") if " [" in head and head.endswith("]") else (head, "", "")
        name = numbered(_NO_NAME.sub("_", words.replace("/", " over ")).strip("_") or "column", "", named)
        named[name] = values
        if unit:
            units[name] = unit
    return named, units


def framed(columns: Callable[[], Columns]) -> pandas.DataFrame:
    """Return columns as a frame of pandas. Raises `InputError` if pandas is not installed."""
    if find_spec("pandas") is None:
        raise InputError(Problem("a frame requires the package pandas", hint="pip install pandas"))
    from pandas import DataFrame

    named, units = parted(columns())
    frame = DataFrame(named)
    numbers = list(frame.select_dtypes("floating"))
    frame[numbers] += 0.0  # turns -0 into 0
    frame.attrs["units"] = units
    return frame


def _check_asked(figure: Callable[..., Figure], asked: Mapping[str, Any]) -> None:
    """Raise `InputError` if a plot does not take an argument."""
    if not asked:
        return
    given = figure.keywords if isinstance(figure, partial) else {}
    free = [each for each in signature(figure).parameters.values() if each.name not in given]
    known = [each.name for each in free if each.kind is Parameter.KEYWORD_ONLY]
    hint = f"it takes {', '.join(('file', 'ax', 'figure', *known))}"
    unknown = [each for each in asked if each not in known]
    if unknown:
        raise InputError(*(Problem("is not an argument of this plot", field=each, hint=hint) for each in unknown))


def _draw_in(
    ax: Axes | None, figure: Figure | SubFigure | None, draw: Callable[..., Figure], asked: Mapping[str, Any]
) -> Figure:
    """Draw a plot in axes or a figure of the user, and return the whole figure."""
    from matplotlib.axes import Axes
    from matplotlib.figure import FigureBase

    from rocking_cli.plotting.style import drawing_in

    if ax is not None and figure is not None:
        raise InputError(Problem("cannot be combined with `figure`", field="`ax`"))
    target = figure if ax is None else ax
    if not isinstance(target, FigureBase if ax is None else Axes):
        field, kind = ("`figure`", "a Figure or SubFigure") if ax is None else ("`ax`", "an Axes")
        raise InputError(Problem(f"must be {kind} of matplotlib, got {type(target).__name__}", field=field))
    if figure is not None and figure.axes:
        hint = "give `ax` to draw in one of them, or an empty figure or part of one"
        raise InputError(Problem("has axes already", field="`figure`", hint=hint))
    whole = cast("Figure", target.get_figure(root=True))
    with drawing_in(target):
        drawn = draw(**asked)
    if drawn.get_figure(root=True) is not whole:
        raise InputError(Problem("this plot makes a figure of its own", hint="plot it without `ax` and `figure`"))
    return whole


def drawn(function: str, *args: Any, **named: Any) -> Callable[[], Figure]:
    """Return a function that draws a plot by the named one, such as "questions.margin.picture.draw_margins"."""
    return partial(_draw, function, *args, **named)


def _draw(function: str, *args: Any, **named: Any) -> Figure:
    figure: Figure = resolve_name(f"rocking_cli.{function}")(*args, **named)
    return figure


def no_plot(why: str, hint: str | None = None) -> Callable[[], Figure]:
    """Return the plot of an answer that has none: it raises `InputError`."""
    return partial(_refuse, why, hint)


def _refuse(why: str, hint: str | None) -> Figure:
    raise InputError(Problem(why, hint=hint))


def _ends_of(columns: Columns) -> Table:
    """Return the first and the last rows of columns as a table."""
    shown = []
    for column in columns.values():
        ends = column if len(column) <= 2 * SHOWN_ROWS else [*column[:SHOWN_ROWS], "...", *column[-SHOWN_ROWS:]]
        shown.append([number(value, 5) if isinstance(value, float) else str(value) for value in ends])
    return table_of("", text_columns(*columns), list(zip(*shown, strict=True)))


def _html(part: Table | str) -> str:
    from html import escape

    if isinstance(part, str):
        return f"<p>{escape(part)}</p>"

    heads, *rows = (
        "".join(f"<{tag}>{escape(str(cell))}</{tag}>" for cell in row)
        for tag, row in [("th", part.columns), *(("td", row) for row in part.rows)]
    )
    title = f"<caption>{escape(part.title)}</caption>" if part.title else ""
    body = "".join(f"<tr>{row}</tr>" for row in rows)
    return f"<table>{title}<thead><tr>{heads}</tr></thead><tbody>{body}</tbody></table>"


def labelled(tables: Sequence[tuple[Dimensions, Parted]]) -> xarray.Dataset:
    """Return the columns of long tables as labelled arrays over the dimensions of each table."""
    from xarray import merge

    elsewhere = {name for each, _ in tables for name in (*each.names, *each.of)}
    return merge([_arrays(*each, elsewhere) for each in tables], join="outer", compat="equals")


def _arrays(dimensions: Dimensions, parted: Parted, elsewhere: Collection[str]) -> xarray.Dataset:
    """Return columns as arrays: those that are named, or all whose names are not those of columns `elsewhere`."""
    import numpy as np
    from pandas import factorize
    from xarray import Dataset, Variable

    from rocking_cli.io.tables import column_of
    from rocking_cli.views.column import long_name

    columns, units = {name: column_of(values) for name, values in parted[0].items()}, parted[1]
    names = dimensions.names
    labels = [factorize(columns[name], use_na_sentinel=False) for name in names]
    if np.prod([each.size for _, each in labels]) > columns[names[0]].size:
        # Not every combination exists: numbers are sorted, as what is drawn against them is a curve.
        labels = [
            factorize(columns[name], sort=columns[name].dtype.kind in "if", use_na_sentinel=False) for name in names
        ]
    shape, places = tuple(each.size for _, each in labels), tuple(place for place, _ in labels)
    there = np.zeros(shape, dtype=bool)
    there[places] = True

    def variable(over: tuple[str, ...], name: str, values: Any) -> xarray.Variable:
        unit = {"units": units[name]} if name in units else {}
        return Variable(over, values, unit | {"long_name": long_name(name)})

    def filled(values: np.ndarray) -> np.ndarray:
        words = values.dtype.kind in "OUS"
        kind = object if words else values.dtype if there.all() else np.result_type(values, np.float64)
        array = np.full(shape, "" if words else 0 if there.all() else np.nan, dtype=kind)
        array[places] = values + 0.0 if kind == np.float64 else values  # + 0.0 turns -0 into 0
        return array

    chosen = [name for name in columns if (name in dimensions.of if dimensions.of else name not in elsewhere)]
    return Dataset(
        {name: variable(names, name, filled(columns[name])) for name in chosen},
        {name: variable((name,), name, values) for name, (_, values) in zip(names, labels, strict=True)},
    )

"""Answers that display themselves: as a sentence, as tables in a notebook, as a frame or as a plot."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial
from html import escape
from importlib.util import find_spec
from pathlib import Path
from pkgutil import resolve_name
from threading import RLock
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from rocking_cli.errors import InputError, Problem
from rocking_cli.io.json_text import json_text
from rocking_cli.views.column import table_of, text_columns
from rocking_cli.views.view import Table, View, number

if TYPE_CHECKING:
    import pandas
    from matplotlib.figure import Figure

    from rocking_cli.io.tables import Columns

R = TypeVar("R")
K = TypeVar("K")
V = TypeVar("V")
MAX_REPR_LENGTH = 100  # characters of the text that `repr` shows
SHOWN_ROWS = 5  # at either end of a result that has no table of its own


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
        Returns the plot of the result.
    blocks : callable, optional
        Returns the columns in blocks of rows, one after the other, if there may be very many.
    tables : mapping of str to callable
        Return further tables of the result as columns, by name.
    """

    question: str
    result: R
    view: View
    columns: Callable[[], Columns]
    figure: Callable[[], Figure]
    blocks: Callable[[], Iterable[Columns]] | None = None
    tables: Mapping[str, Callable[[], Columns]] = field(default_factory=dict)

    def __getstate__(self) -> dict[str, Any]:
        """Return what a pickle keeps: everything, with data and columns computed."""
        data = self.view.data() if callable(self.view.data) else self.view.data
        columns = partial(_kept, self.columns())
        tables = {name: partial(_kept, each()) for name, each in self.tables.items()}
        view = View(data, self.view.parts)
        return {**vars(self), "view": view, "columns": columns, "blocks": None, "tables": tables}

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
        data = self.view.data() if callable(self.view.data) else self.view.data
        plain: dict[str, Any] = json.loads(json_text(data))
        return plain

    def to_frame(self) -> pandas.DataFrame:
        """Return the result as a frame of pandas, which must be installed.

        Raises
        ------
        InputError
            If pandas is not installed.
        """
        return _frame(self.columns)

    @property
    def frames(self) -> dict[str, pandas.DataFrame]:
        """Further tables of the result as frames, by name. Raises as `to_frame`."""
        return {name: _frame(each) for name, each in self.tables.items()}

    def plot(self, file: str | Path | None = None) -> Figure:
        """Plot the result.

        Parameters
        ----------
        file : str or Path, optional
            File to write the plot to as well: .png, .svg or .pdf.

        Returns
        -------
        matplotlib.figure.Figure
            Figure to change, or to show in a notebook.
        """
        with _DRAWING:
            figure = self.figure()
            if file is not None:
                _write(figure, Path(file))
        return figure

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


_DRAWING = RLock()
"""Lock around drawing and writing of plots, as matplotlib is not safe for threads."""


def _frame(columns: Callable[[], Columns]) -> pandas.DataFrame:
    if find_spec("pandas") is None:
        raise InputError(Problem("a frame requires the package pandas", hint="pip install pandas"))
    from pandas import DataFrame

    return DataFrame(dict(columns()))


def _write(figure: Figure, path: Path) -> None:
    from rocking_cli.io.files import check_writable, write_whole
    from rocking_cli.plotting.style import save

    if path.suffix.lower() not in (".png", ".svg", ".pdf"):
        raise InputError(Problem("give a file name that ends in .png, .svg or .pdf", str(path)))
    check_writable(path)
    write_whole(path, lambda stream: save(figure, stream, format=path.suffix[1:].lower()))


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


def _kept(columns: Columns) -> Columns:
    return columns


def _ends_of(columns: Columns) -> Table:
    """Return the first and the last rows of columns as a table."""

    def cells(column: Any) -> list[str]:
        ends = column if len(column) <= 2 * SHOWN_ROWS else [*column[:SHOWN_ROWS], "...", *column[-SHOWN_ROWS:]]
        return [number(each, 5) if isinstance(each, float) else str(each) for each in ends]

    return table_of("", text_columns(*columns), list(zip(*map(cells, columns.values()), strict=True)))


def _html(part: Table | str) -> str:
    if isinstance(part, str):
        return f"<p>{escape(part)}</p>"

    def row(cells: Any, tag: str) -> str:
        return "<tr>" + "".join(f"<{tag}>{escape(str(each))}</{tag}>" for each in cells) + "</tr>"

    body = "".join(row(each, "td") for each in part.rows)
    title = f"<caption>{escape(part.title)}</caption>" if part.title else ""
    return f"<table>{title}<thead>{row(part.columns, 'th')}</thead><tbody>{body}</tbody></table>"

"""A verb of Python is made of a function of a question: its arguments are the fields of the question's model.

Verbs that take several motions or structures give an answer to each, and write the files of each.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from difflib import get_close_matches
from functools import partial, wraps
from inspect import Parameter, Signature, getdoc, signature
from pathlib import Path
from textwrap import fill, indent
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from rocking_cli.ask.answer import Answer, Answers, Dimensions, no_plot
from rocking_cli.ask.asked import AskedModel, M, checked, choices, in_order, owner_of, told_of
from rocking_cli.ask.groups import WithTable
from rocking_cli.ask.kinds import STANDARD_OUTPUT
from rocking_cli.ask.kinds import each as several_of
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.dynamics.parallel import matrices_by_one_thread
from rocking_cli.errors import InputError, Problem, RockingError, named
from rocking_cli.processing.reading_options import CORRECTIONS, SCALING, corrected_once
from rocking_cli.text import cut, did_you_mean, numbered
from rocking_cli.views.view import Table, View

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.ask.ground_motions import Motions
    from rocking_cli.io.tables import Columns
    from rocking_cli.processing.reading import Scaled

A = TypeVar("A", bound=Answer[Any])
A_co = TypeVar("A_co", covariant=True)
MIN_LIKENESS = 0.8  # of a word and the name of a field that it means
MEANT = {
    "record": "motions", "records": "motions", "motion": "motions", "pulse": "motions", "mechanism": "structure",
    "mechanisms": "structures", "factor": "scale", "factors": "scale", "pga": "target_pga", "pgv": "target_pgv",
    "eta": "restitution", "threads": "jobs", "processes": "jobs", "models": "model", "polarities": "polarity",
    "study": "structures",
}  # fmt: skip
"""Other words for arguments, and those that they mean."""


class Verb(Protocol[A_co]):
    """A function of Python made of a question."""

    model: type[AskedModel]

    def __call__(self, *given: Any, **more: Any) -> A_co:
        """Answer the question."""

    def ask(self, given: Mapping[str, Any], usual: Mapping[str, Any], watch: Watcher) -> A_co:
        """Answer the question of some fields; `usual` are defaults of the command."""


def verb(model: type[M]) -> Callable[[Callable[[M, Watcher], A_co]], Verb[A_co]]:
    """Make a verb of a function of a question and a watcher.

    The verb has the fields of the question as arguments, those with `where="input"` by place too. It refuses unknown
    ones and wrong values, writes the files that are requested, and documents all of them.

    Parameters
    ----------
    model : type
        The model of the question.
    """

    def decorate(function: Callable[[M, Watcher], A_co]) -> Verb[A_co]:
        places = [name for name, field in by_place(model).items() if "input" in told_of(field).where]

        def ask(given: Mapping[str, Any], usual: Mapping[str, Any], watch: Watcher) -> A_co:
            unknown = [name for name in given if name not in model.model_fields]
            if unknown:
                raise InputError(*(_unknown(model, name, given) for name in unknown))
            asked = checked(model, given, usual)
            _keep_apart(asked)
            watch.begin(asked.given())
            answer = function(asked, watch)
            if isinstance(answer, Answer):
                if not model.writes_each:
                    write_files(answer, asked, watch)
                answer = _with_given(answer, asked.given())
            return answer

        @wraps(function)
        def called(*placed: Any, watch: Watcher = SILENT, **given: Any) -> A_co:
            if len(placed) > len(places):
                raise TypeError(f"{function.__name__} takes {len(places)} arguments by place, got {len(placed)}")
            first = dict(zip(places, placed, strict=False))
            if twice := first.keys() & given.keys():
                raise TypeError(f"{function.__name__} got {', '.join(sorted(twice))} twice")
            with matrices_by_one_thread():  # a command has the library start no others
                return ask({**first, **given}, {}, watch)

        made: Any = called
        made.__signature__, made.__doc__ = _signature(model, function), _documented(model, function)
        made.model, made.ask = model, ask
        return made  # type: ignore[no-any-return]

    return decorate


def _with_given(answer: Answer[Any], given: Mapping[str, Any]) -> Any:
    """Return an answer with what was given in its data; those of several answers are those of each, by its name."""
    if not isinstance(answer, Answers):
        return replace(answer, view=answer.view.plus(lambda: {"given": given}))
    each: Any = {name: _with_given(one, given) for name, one in answer.items()}
    view = View(lambda: {name: one.to_dict() for name, one in each.items()}, answer.view.parts)
    return replace(answer, result=each, view=view)


def write_files(answer: Answer[Any], asked: Any, watch: Watcher) -> None:
    """Write the table and the plot of an answer that a question requests. Raises `InputError` if one cannot be."""
    if isinstance(asked, WithTable) and asked.out is not None:
        blocks = answer.blocks() if answer.blocks is not None else [answer.columns()]
        write_rows(asked.out, blocks, watch, asked.separator, asked.decimal)
    if (plot := getattr(asked, "plot", None)) is not None:
        answer.plot(plot)
        watch.note(f"wrote {plot}")


def write_rows(
    out: Path, blocks: Iterable[Columns], watch: Watcher, separator: str | None = None, decimal: str | None = None
) -> None:
    """Write blocks of rows to a table, or to standard output; given signs mark it for a spreadsheet."""
    from rocking_cli.io.tables import write_csv, write_table

    signs: Any = {"separator": "\t" if separator == "tab" else separator or ",", "decimal": decimal or "."}
    if str(out) == STANDARD_OUTPUT:
        with watch.standard_output() as stream:
            write_csv(stream, blocks, **signs)
    else:
        write_table(out, blocks, **signs, mark=bool(separator or decimal))
        watch.note(f"wrote {out}")


def _keep_apart(asked: AskedModel) -> None:
    """Raise `InputError` if a file that is written is one that is read, or cannot be written."""
    fields = type(asked).model_fields
    told = {name: told_of(field) for name, field in fields.items()}
    written = {name: getattr(asked, name) for name, each in told.items() if each.written}
    written = {name: each for name, each in written.items() if isinstance(each, Path)}
    if not written:
        return
    from rocking_cli.io.files import keep_apart
    from rocking_cli.io.tables import check_table

    names = [
        name
        for name, each in told.items()
        if "input" in each.where or (each.kind is not None and each.kind.words == "file")
    ]
    read = [getattr(asked, name) for name in names]
    files = [str(each) for value in read for each in several_of(value) if isinstance(each, str | Path)]
    motions = getattr(asked, "ground_motions", None)
    files += [str(each.path) for each in motions.records] if motions is not None else []
    keep_apart([(named(name), each) for name, each in written.items()], files)
    for name in ("out", "curves"):
        check_table(written.get(name))


def _unknown(model: type[AskedModel], name: str, given: Mapping[str, Any]) -> Problem:
    """Return the problem of an argument that a question does not have, with what is meant."""
    fields, hint = model.model_fields, None
    meant = MEANT.get(name, "")
    known = next((each for each in (meant, f"{meant}s", meant.removesuffix("s")) if each in fields), None)
    if known is not None:
        hint = f"did you mean {known}?"
    elif name in SCALING:
        hint = "the motions of this question are not scaled"
    elif name in CORRECTIONS and "units" in fields:
        hint = corrected_once(name)
    elif structures := [given[each] for each in ("structure", "structures") if each in given]:
        hint = _of_structure(name, given[name], [*fields], structures)
    return Problem("is not an argument", field=named(name), hint=hint or did_you_mean(name, [*fields]))


def _of_structure(name: str, value: object, known: list[str], structures: Sequence[Any]) -> str | None:
    """Return a hint on the field of a structure that an unknown argument means."""
    from rocking_cli.core import Mechanism
    from rocking_cli.io.field_problems import by_meaning

    cls = next((type(each) for one in structures for each in several_of(one) if isinstance(each, Mechanism)), Mechanism)
    fields = cls.model_fields
    if name in cls.refused and name not in fields:
        return str(Problem(cls.refused[name], field=name))
    word = cls.meanings.get(name, name)
    field = next(iter(get_close_matches(word, [*known, *fields], n=1, cutoff=MIN_LIKENESS)), None)
    if field in known:
        return f"did you mean {field}?"
    if field not in fields:
        return by_meaning(name, fields)
    new = cut(repr(value)) if isinstance(value, int | float | str) else "..."
    return f"{field} is a field of the structure: structure.replace({field}={new})"


def by_place(model: type[AskedModel]) -> dict[str, Any]:
    """Return the fields of a question in the order of the verb: those by place first, of which required ones first."""
    fields = in_order(model)
    places = {}
    for name, field in fields.items():
        where = told_of(field).where
        places[name] = "input" not in where, not field.is_required(), where != "input"
    return {name: fields[name] for name in sorted(fields, key=lambda name: places[name])}


def _signature(model: type[AskedModel], function: Callable[..., Any]) -> Signature:
    """Return the signature of a verb."""
    parameters = []
    for name, field in by_place(model).items():
        kind = Parameter.POSITIONAL_OR_KEYWORD if "input" in told_of(field).where else Parameter.KEYWORD_ONLY
        default = Parameter.empty if field.is_required() else field.default
        parameters.append(Parameter(name, kind, default=default, annotation=type_in_words(model, name)))
    watch = Parameter("watch", Parameter.KEYWORD_ONLY, default=SILENT, annotation="Watcher")
    return Signature([*parameters, watch], return_annotation=signature(function).return_annotation)


def type_in_words(model: type[AskedModel], name: str) -> str:
    """Return the type of a field as it is written in the code, and the words of which it takes one."""
    if words := choices(model.model_fields[name]):
        return "{" + ", ".join(f'"{each}"' for each in words) + "}"
    written = told_of(model.model_fields[name]).type or vars(owner_of(model, name))["__annotations__"][name]
    written = written if isinstance(written, str) else getattr(written, "__name__", str(written))
    return written if "str" in written else str(written).replace("Path", "str | Path", 1)


def _documented(model: type[AskedModel], function: Callable[..., Any]) -> str:
    """Return the docstring of a verb: its first paragraphs, the fields of its model, and its other sections."""
    before, line, after = (getdoc(function) or "").partition("\n\nReturns\n-------\n")
    entries = [
        f"{name} : {type_in_words(model, name)}{'' if field.is_required() else ', optional'}\n"
        + indent(fill(described(field), 112), "    ")
        for name, field in by_place(model).items()
    ]
    entries.append("watch : Watcher\n    Told what is read and written, what is doubtful, and how far the work is.")
    return f"{before}\n\nParameters\n----------\n" + "\n".join(entries) + line + after


def described(field: Any) -> str:
    """Return what a field is, with its unit and its default, for docstrings and pages."""
    told = told_of(field)
    unit = f" [{told.kind.unit}]" if told.kind is not None and told.kind.unit else ""
    default = told.usual or (
        "" if field.is_required() or field.default in (None, False, (), [], {}) else f"{field.default}"
    )
    return f"{field.description}{unit}{f' By default {default}.' if default else ''}"


def are_several(given: object, motions: Motions) -> bool:
    """Return whether several motions are given, or any number of them in a list."""
    from rocking_cli.processing.reading import Scaled

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

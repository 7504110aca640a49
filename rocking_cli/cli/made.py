"""Commands made of questions: an option for each field of the model, and a verb that answers."""

from __future__ import annotations

import shlex
from collections.abc import Mapping, Sequence
from importlib import import_module
from pathlib import Path
from typing import Any, get_args

import click
from click.core import ParameterSource
from pydantic.fields import FieldInfo

from rocking_cli.ask.asked import AskedModel, Kind, choices, in_order, no_effect, owner_of, told_of
from rocking_cli.ask.watcher import Watcher
from rocking_cli.cli import terminal
from rocking_cli.cli.help import (
    MOTIONS_HEADING,
    OPTIONS_HEADING,
    OUTPUT_HEADING,
    PULSES,
    SWITCHES,
    Command,
    HeadedOption,
    completer,
)  # fmt: skip
from rocking_cli.errors import InputError, spelled
from rocking_cli.plugins.rooms import names
from rocking_cli.processing.reading_options import CORRECTIONS

STRUCTURES = ("structure", "structures")
BEFORE_RECORDS = " If it is a record, put --record before each file."


class Made(Command):
    """Command that asks a question."""

    def __init__(self, name: str, model: type[AskedModel], short_help: str) -> None:
        params = [*_arguments(model), *_motions(model), *_options(model)]
        for *switch, text in SWITCHES:
            params.append(HeadedOption(switch, heading=OUTPUT_HEADING, is_flag=True, help=text))
        super().__init__(name, params=params, callback=self.run, help=model.__doc__, short_help=short_help)
        self.model = model

    def spell(self, name: str) -> str:
        """Return the option or argument of a field, as it is typed."""
        if name == "motions" and _has_motions(self.model):
            return "--record or --pulse"
        typed = {each.name: max(each.opts, key=len) for each in self.params if isinstance(each, click.Option)}
        typed |= {each.name: f"{each.metavar}".strip("[.]") for each in self.params if isinstance(each, click.Argument)}
        return typed.get(name, f"--{name}" if name in (*CORRECTIONS, "out") else f"`{name}`")

    def run(self, *, as_json: bool, **typed: Any) -> None:
        """Ask the question, and show the answer."""
        watch = terminal.OnTerminal(as_json=as_json)
        with spelled(self.spell):
            given, usual = self._given(typed)
            for name in [name for name, value in usual.items() if callable(value)]:
                if (value := usual.pop(name)({**usual, **given}, as_json=as_json)) is not None:
                    usual[name] = value
            for name in given:
                file = told_of(self.model.model_fields[name]).only_in
                if file and typed[file] is None:
                    raise InputError(no_effect([name], f"without {{{file}}}"))
            answer = self.ask(given, usual, watch)
            if not (as_json and watch.taken):
                self.show(answer, as_json=as_json)
            watch.end()

    def ask(self, given: Mapping[str, Any], usual: Mapping[str, Any], watch: Watcher) -> Any:
        """Ask the verb of the name of the command."""
        verb = (self.name or "").replace("-", "_")
        return getattr(import_module(names()[verb]), verb).ask(given, usual, watch)

    def show(self, answer: Any, *, as_json: bool) -> None:
        """Show an answer."""
        terminal.show(answer.view, as_json=as_json)

    def _given(self, typed: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
        """Return the fields that are given, and the defaults of the command."""
        context, fields = click.get_current_context(), self.model.model_fields
        given: dict[str, Any] = {}
        usual: dict[str, Any] = {}
        for name in sorted(fields, key=[*typed, *fields].index):  # in the order in which they are typed
            told = told_of(fields[name])
            if told.where == "input":
                if (value := self._input(name, typed)) is not None:
                    given[name] = value
                elif told.on_terminal is not None:
                    usual[name] = told.on_terminal
                continue
            if context.get_parameter_source(name) is ParameterSource.COMMANDLINE:
                given[name] = typed[name]
            elif told.on_terminal is not None:
                usual[name] = told.on_terminal
        if "origin" in fields:
            usual["origin"] = command_line(context)
        return given, usual

    def _input(self, name: str, typed: Mapping[str, Any]) -> Any:
        """Return a positional argument of the verb; None if it is not given."""
        if name == "motions":
            motions: list[Any] = [*map(Path, filter(None, typed[name] if name in typed else typed["records"]))]
            if typed.get("pulses"):
                from rocking_cli.excitation.pulses import parse_pulse

                motions += map(parse_pulse, typed["pulses"])
            return (motions[0] if len(motions) == 1 else motions) or None
        if name in STRUCTURES and not told_of(self.model.model_fields[name]).typed:
            files = tuple(filter(None, typed[name]))  # a variable of a script may be empty
            _check_strays(files, typed.get("records", ()))
            if name == "structure" and len(files) > 1:
                raise click.UsageError(
                    f"One structure is expected, but {len(files)} are given: {', '.join(files)}." + BEFORE_RECORDS
                )
            return files if len(files) > 1 else files[0] if files else None
        return typed[name]


def command_line(ctx: click.Context, without: Sequence[str] = ()) -> str:
    """Return the command as it was given, for a POSIX shell, for the documents it writes; `without` some parameters."""
    words = ["rocking", ctx.info_name or ""]
    for param in [each for each in ctx.command.params if each.name not in without]:
        value = ctx.params.get(param.name or "")
        if ctx.get_parameter_source(param.name or "") is not ParameterSource.COMMANDLINE:
            continue
        for each in value if isinstance(value, tuple) else (value,):
            words += [] if isinstance(param, click.Argument) else [param.opts[0]]
            words += [] if each is True else [str(each)]
    return shlex.join(words)


def _check_strays(files: tuple[str, ...], records: tuple[str, ...]) -> None:
    """Raise if records stand in the place of a structure: the shell puts the files of a bare pattern there."""
    endings = {Path(place).suffix.lower() for place in records} - {"", ".yaml", ".yml"}
    strays = [file for file in files if Path(file).suffix.lower() in endings]
    if strays:
        raise click.UsageError(
            f"{strays[0]} is given where a structure is expected.{BEFORE_RECORDS[:-1]}, or use a quoted pattern: "
            f"--record '*{Path(strays[0]).suffix}'."
        )


def _arguments(model: type[AskedModel]) -> list[click.Parameter]:
    """Return the arguments of a command: the inputs of its question but motions, which are options."""
    usual = {"structures": "[FILE]...", "structure": "[FILE]"}
    arguments: list[click.Parameter] = []
    for name, field in model.model_fields.items():
        if (told := told_of(field)).where != "input" or (name == "motions" and not told.typed):
            continue
        kind, usually = told.kind or Kind(str), "" if told.typed else usual.get(name, "")
        metavar = told.typed or usually or kind.metavar or name.upper()
        words = "file" if name in (*STRUCTURES, "motions") else kind.words
        more: dict[str, Any] = {"shell_complete": completer(words)} if words else {}
        more |= {"nargs": -1} if usually or metavar.endswith("...") else {}
        required = field.is_required() and not usually
        arguments.append(click.Argument([name], metavar=metavar, required=required, **more))
    return arguments


def _has_motions(model: type[AskedModel]) -> bool:
    """Return whether a command has options that give ground motions."""
    field = model.model_fields.get("motions")
    return field is not None and told_of(field).where == "input" and not told_of(field).typed


def _motions(model: type[AskedModel]) -> list[click.Parameter]:
    """Return the options that give ground motions."""
    if not _has_motions(model):
        return []
    return [
        HeadedOption(
            ["--record", "records"], heading=MOTIONS_HEADING, multiple=True, metavar="PLACE",
            shell_complete=completer("file"),
            help="Ground motion file, - for standard input, or a quoted pattern such as 'records/*.AT2'. Repeatable.",
        ),
        HeadedOption(
            ["--pulse", "pulses"], heading=MOTIONS_HEADING, multiple=True, metavar="PULSE",
            shell_complete=completer(PULSES, ending=":"),
            help="Pulse instead of a record, NAME:AMPLITUDE:PERIOD, such as sine:0.6g:0.8s. Repeatable.",
        ),
    ]  # fmt: skip


def _options(model: type[AskedModel]) -> list[click.Parameter]:
    """Return the options of the fields of a question."""
    options: list[click.Parameter] = []
    for name, field in in_order(model).items():
        told = told_of(field)
        if told.where not in ("", "input option"):
            continue
        heading = vars(owner_of(model, name)).get("heading", OPTIONS_HEADING)
        options.append(_option(name, field, OUTPUT_HEADING if told.written else heading))
    return options


def _option(name: str, field: FieldInfo, heading: str) -> HeadedOption:
    """Return the option of a field: a switch, or a text that the model reads."""
    told, known = told_of(field), choices(field)
    kind = told.kind or Kind(str)
    words = kind.words or " ".join(known)
    more: dict[str, Any] = {"metavar": kind.metavar or f"[{words.replace(' ', '|')}]", "multiple": told.repeat}
    more["shell_complete"] = completer(words) if words else None
    if {*(get_args(field.annotation) or [field.annotation])} <= {bool, type(None)}:
        more = {"is_flag": True}
    elif told.alone:
        more |= {"is_flag": False, "flag_value": told.alone}
    plain = field.is_required() or field.default in (None, (), [], {}) or isinstance(field.default, bool)
    values = field.default if isinstance(field.default, tuple) else (field.default,)
    typed = ",".join(f"{value:g}" if isinstance(value, float) else f"{value}" for value in values)
    usual = told.usual or (f"{told.on_terminal}" if told.on_terminal else "" if plain else typed)
    text = f"{field.description}{f'  [default: {usual}]' if usual else ''}"
    names = [*(["-o"] if name == "out" else []), f"--{(told.typed or name).replace('_', '-')}", name]
    return HeadedOption(names, heading=heading, help=text, required=field.is_required(), **more)

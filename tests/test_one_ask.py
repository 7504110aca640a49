"""A command asks the verb of its name: what its options say, the arguments of the verb say by the same names."""

from __future__ import annotations

import ast
import inspect
from importlib import import_module
from typing import get_type_hints

import click
import pytest

import rocking_cli as rk
from rocking_cli.ask import watcher as rk_watcher
from rocking_cli.ask.ground_motions import MotionArguments, ReadingArguments
from rocking_cli.cli.main import COMMANDS
from tests.elsewhere import PROJECT

WITHOUT = {
    "figure": "recomputes the figures of the paper into a folder",
    "mechanisms": "lists plugins: `rk.mechanisms`",
    "measures": "lists plugins",
    "new": "prints starters",
    "info": "describes the installation",
    "warm": "compiles kernels",
    "completion": "prints a script for a shell",
}
"""Commands that ask nothing about a structure or a motion."""
OF_THE_TERMINAL = {"as_json", "as_csv", "plot", "out", "page", "curves", "nrml", "sheet", "help", "version"}
"""Options that say where an answer goes, and in which form."""
NAMED = {"records": "motions", "pulses": "motions"}
MOST = 40


def asked(name):
    command = import_module(f"rocking_cli.cli.{name}").command
    return [param for param in command.params if param.name not in OF_THE_TERMINAL and not getattr(param, "hidden", 0)]


def usual(option):
    """The default of an option; None where there is none, which versions of click spell differently."""
    if not isinstance(option.default, str | int | float | tuple):
        return None
    return option.type_cast_value(click.Context(click.Command("command")), option.default)


VERBS = [name for name in COMMANDS if name not in WITHOUT]


@pytest.mark.parametrize("name", VERBS)
def test_what_a_command_can_do_python_can_do_by_the_same_names(name):
    verb = getattr(rk, name)
    arguments = inspect.signature(verb).parameters
    more = MotionArguments if name != "select" else ReadingArguments
    loose = set(get_type_hints(more)) if "options" in arguments else set()
    missing, other = [], []
    for param in asked(name):
        word = NAMED.get(param.name, param.name)
        spelled = next((each for each in (word, word.removesuffix("s"), param.name) if each in arguments), None)
        if isinstance(param, click.Argument):  # a file, of what the verb is given first
            spelled = next(iter(arguments))
        if spelled is None and param.name not in loose:
            missing.append(param.name)
        elif spelled is not None and isinstance(param, click.Option) and param.name not in NAMED and not param.required:
            default = arguments[spelled].default
            if name == "respond" and param.name == "neighbours":
                assert default == 0
            elif (given := usual(param) or None) != (default or None):
                other.append((param.name, given, default))
    assert not missing and not other


@pytest.mark.parametrize("name", VERBS)
def test_the_function_of_a_command_is_short(name):
    tree = ast.parse((PROJECT / "rocking_cli" / "cli" / f"{name}.py").read_text(encoding="utf-8"))
    (function,) = (each for each in tree.body if isinstance(each, ast.FunctionDef) and each.name == "command")
    body = function.body[1:]
    assert body[-1].end_lineno - body[0].lineno + 1 <= MOST


def test_an_argument_that_is_none_or_has_no_effect_is_refused():
    block = rk.Block(width=0.7, height=2.8)
    with pytest.raises(rk.InputError, match="`high` is not an argument"):
        rk.respond(block, "sine:0.3g:0.8s", high=0.1)
    with pytest.raises(rk.InputError, match="`highpass` has no effect, as no ground motion is given"):
        rk.respond(block, release=0.5, highpass=0.1)
    with pytest.raises(rk.InputError, match="`highpass` describes a record, and no record is given"):
        rk.respond(block, "sine:0.3g:0.8s", highpass=0.1)


def test_a_watcher_decides_whether_one_bad_record_ends_an_answer():
    class Patient(rk_watcher.Watcher):
        def __init__(self):
            self.heard = []

        def leave_out(self, error):
            self.heard.append(str(error))

    block, motions = rk.Block(width=0.7, height=2.8), ["nowhere.csv", "sine:0.3g:0.8s"]
    with pytest.raises(rk.InputError, match=r"nowhere\.csv: no such file"):
        rk.margin(block, motions, neighbours=2)
    patient = Patient()
    answer = rk.margin(block, motions, neighbours=2, watch=patient)
    assert list(answer) == ["sine:0.3g:0.8s"] and patient.heard == ["nowhere.csv: no such file\n  check the path"]

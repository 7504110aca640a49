"""A question that is declared once: its verb, its command and all refusals are made of its model."""

import json
from inspect import signature
from pathlib import Path
from typing import Literal

import numpy as np
import pytest
from click.testing import CliRunner

import rocking_cli as rk
from rocking_cli.ask.answer import Answer, no_plot
from rocking_cli.ask.asked import Idle, checked, option, told_of
from rocking_cli.ask.groups import Around, WithTable, table_file
from rocking_cli.ask.kinds import PERIOD, PULSE_AMPLITUDE, several, span
from rocking_cli.ask.verbs import verb
from rocking_cli.cli import made, terminal
from rocking_cli.views.view import View


class ToyAsked(Around, WithTable):
    """Ask a toy.

    \b
    Example:
      rocking toy --period 0.8s
    """

    number: int = option("A number given by place.", where="input", default=1)
    period: float | None = option("Period of a pulse.", PERIOD)
    ag: float | None = option("Amplitude of a pulse.", PULSE_AMPLITUDE)
    sizes: tuple[float, float] | None = option("Two periods.", span(PERIOD, "1s:4s"))
    shares: tuple[float, ...] = option("Periods.", several(PERIOD, "A,B,..."), default=(1.0,))
    kind: Literal["plain", "odd"] = option("A kind.", default="plain")
    quick: bool = option("Whether to be quick.", default=False)
    out: Path | None = table_file("Write a row.")
    idle = (Idle("on a plain toy", lambda asked: asked.kind == "plain", ("quick", "slenderness_deviation")),)


@verb(ToyAsked)
def toy(asked: ToyAsked, watch) -> Answer:
    """Ask a toy.

    Returns
    -------
    Answer
        All that was asked.
    """
    return Answer("toy", asked, View({"period": asked.period}, ["words"]), lambda: {"a": [1.5]}, no_plot("none"))


@pytest.fixture
def typed(monkeypatch):
    monkeypatch.setattr(made, "names", lambda: {"toy": __name__})
    monkeypatch.setattr(terminal, "_results", None)  # which a table on standard output changes
    command = made.Made("toy", ToyAsked, "Ask a toy.")

    def run(*words, **more):
        return CliRunner().invoke(command, [str(word) for word in words], **more)

    return run


@pytest.mark.parametrize(
    ("words", "given"),
    [
        (["--period", "800 ms"], {"period": 0.8}),
        (["--period", "4Hz"], {"period": 0.25}),
        (["--ag", "40%g"], {"ag": 0.4}),
        (["--sizes", "1s:4s"], {"sizes": (1.0, 4.0)}),
        (["--shares", "1,2,3 s"], {"shares": [1, 2, 3]}),
        (["--kind", "odd", "--quick"], {"kind": "odd", "quick": True}),
        (["--neighbours", "7"], {"neighbours": 7}),
    ],
)
def test_a_text_and_a_value_are_the_same_question(typed, words, given):
    asked = checked(ToyAsked, given)
    assert toy(**given).result == asked
    assert json.loads(typed(*words, "--json").stdout)["given"] == json.loads(json.dumps(asked.given()))
    assert asked.given().keys() == given.keys()


WRONG = [
    ({"period": "3 kg"}, "period", ": 3 kg is a mass, not a time"),
    ({"period": -1}, "period", ": -1 is not positive"),
    ({"ag": "0.4"}, "ag", ": '0.4' has no unit"),
    ({"sizes": "4:1"}, "sizes", ": '4:1' is not increasing"),
    ({"kind": "od"}, "kind", " must be plain or odd, got the text od\n  did you mean odd?"),
    ({"neighbours": "2.5"}, "neighbours", " must be a whole number, got the text '2.5'"),
    ({"neighbours": -1}, "neighbours", " must be at least 0, got -1"),
    ({"quick": True}, "quick", " has no effect on a plain toy"),
    ({"slenderness_deviation": "20%"}, "slenderness_deviation", " has no effect on a plain toy"),
    ({"out": "rows.txt"}, "out", ": 'rows.txt' does not end in .csv"),
    ({"decimal": ","}, "decimal", " writes a CSV table, and none is requested"),
]


@pytest.mark.parametrize(("given", "name", "said"), WRONG)
def test_a_refusal_names_the_option_as_it_was_given(typed, given, name, said):
    with pytest.raises(rk.InputError) as refused:
        toy(**given)
    assert str(refused.value).startswith(f"`{name}`{said}")
    dashed = f"--{name.replace('_', '-')}"
    assert str(typed(dashed, *([] if given[name] is True else [given[name]])).exception).startswith(dashed)


def test_all_that_is_wrong_is_said_at_once():
    with pytest.raises(rk.InputError) as refused:
        toy(period="x", kind="x", neighbours="x")
    assert all(f"`{name}`" in str(refused.value) for name in ("period", "kind", "neighbours"))


@pytest.mark.parametrize("value", [True, False, [1], {"a": 1}, np.array([1.0, 2.0])])
def test_a_value_of_another_type_is_refused(value):
    with pytest.raises(rk.InputError, match="`neighbours`"):
        toy(neighbours=value)


def test_an_unknown_argument_is_refused_and_more_by_place_than_there_are():
    with pytest.raises(rk.InputError, match=r"`neighbour` is not an argument\n  did you mean neighbours\?"):
        toy(neighbour=3)
    with pytest.raises(TypeError, match="takes 1 arguments by place, got 2"):
        toy(1, 2)
    with pytest.raises(TypeError, match="got number twice"):
        toy(1, number=2)


def test_a_default_of_the_command_without_effect_is_left_out():
    asked = checked(ToyAsked, {"kind": "plain"}, {"quick": True, "neighbours": 7})
    assert not asked.quick and asked.neighbours == 7
    assert checked(ToyAsked, {"kind": "odd"}, {"quick": True}).quick
    assert checked(ToyAsked, {"neighbours": 3}, {"neighbours": 7}).neighbours == 3


def test_a_question_does_not_change():
    with pytest.raises(ValueError, match="frozen"):
        checked(ToyAsked, {}).period = 3.0


def test_signature_docstring_and_help_have_every_field_once(typed):
    parameters = signature(toy).parameters
    assert next(iter(parameters)) == "number" and list(parameters)[-1] == "watch"
    assert set(parameters) == {*ToyAsked.model_fields, "watch"}
    text, page = toy.__doc__, typed("--help", env={"COLUMNS": "100"}).stdout
    for name, field in ToyAsked.model_fields.items():
        assert text.count(f"\n{name} : ") == 1
        assert name == "number" or f"--{name.replace('_', '-')} " in page
        assert field.description.split(".")[0] in " ".join(text.split())
    assert text.index("Parameters\n---") < text.index("Returns\n---")
    usual = told_of(ToyAsked.model_fields["neighbours"]).usual
    assert usual and f"[default: {usual}]" in " ".join(page.split()) and "Neighbouring motions:" in page


def test_files_are_written_and_no_input_is_replaced(typed, tmp_path):
    assert "wrote rows.csv" in typed("--out", "rows.csv").stderr
    assert (tmp_path / "rows.csv").read_text() == "a\n1.5\n"
    toy(out="again.csv", separator=";", decimal=",")
    assert (tmp_path / "again.csv").read_text("utf-8-sig") == "a\n1,5\n"
    assert typed("--out", "-").stdout == "a\n1.5\n"

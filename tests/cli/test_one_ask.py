"""A command asks the verb of its name: what its options say, the arguments of the verb say by the same names."""

import ast
import inspect
import re
from dataclasses import replace
from importlib import import_module
from pathlib import Path

import click
import pytest

import rocking_cli as rk
from rocking_cli.ask import watcher as rk_watcher
from rocking_cli.plugins.rooms import commands
from rocking_cli.processing.reading_options import READING, SCALING, UNITS
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES
from tests.elsewhere import PROJECT

WITHOUT = {
    "mechanisms": "lists plugins: `rk.mechanisms`",
    "measures": "lists plugins",
    "new": "prints starters",
    "info": "describes the installation",
    "completion": "prints a script for a shell",
    "import": "a word of Python: `rk.import_drawing` and `rk.import_mesh`, held in test_every_option",
}
"""Commands that ask nothing about a structure or a motion."""
OF_THE_TERMINAL = {
    "as_json", "as_csv", "plot", "out", "page", "curves", "nrml", "sheet", "separator", "decimal", "in_full", "help",
    "version",
}  # fmt: skip
"""Options that say where an answer goes, and in which form."""
NAMED = {"records": "motions", "pulses": "motions", "sets": "motions"}
MOST = 40
FLOOR = "T1=0.4,xi=0.05,z/H=0.67,gamma=1.29"


def asked(name):
    command = import_module(commands()[name]).command
    return [param for param in command.params if param.name not in OF_THE_TERMINAL and not getattr(param, "hidden", 0)]


def usual(option):
    """The default of an option; None where there is none, which versions of click spell differently."""
    if not isinstance(option.default, str | int | float | tuple):
        return None
    return option.type_cast_value(click.Context(click.Command("command")), option.default)


VERBS = [name for name in commands() if name not in WITHOUT]


@pytest.mark.parametrize("name", VERBS)
def test_what_a_command_can_do_python_can_do_by_the_same_names(name):
    verb = getattr(rk, name)
    arguments = inspect.signature(verb).parameters
    more = READING if name in ("select", "score", "calibrate") else READING | SCALING
    loose = more if "options" in arguments else {}
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
            elif name == "margin" and param.name == "neighbours":
                assert default is None  # fewer with free blocks
            elif (given := usual(param) or None) != (default or None):
                other.append((param.name, given, default))
    assert not missing and not other


@pytest.mark.parametrize("name", VERBS)
def test_the_function_of_a_command_is_short(name):
    tree = ast.parse((PROJECT / f"{commands()[name].replace('.', '/')}.py").read_text(encoding="utf-8"))
    (function,) = (each for each in tree.body if isinstance(each, ast.FunctionDef) and each.name == "command")
    body = function.body[1:]
    assert body[-1].end_lineno - body[0].lineno + 1 <= MOST


def test_an_argument_that_is_none_or_has_no_effect_is_refused():
    block = rk.Block(width=0.7, height=2.8)
    with pytest.raises(rk.InputError, match="`highpass` has no effect, as no ground motion is given"):
        rk.respond(block, release=0.5, highpass=0.1)
    with pytest.raises(rk.InputError, match="`highpass` describes a record, and no record is given"):
        rk.respond(block, "sine:0.3g:0.8s", highpass=0.1)


def numeric(verb):
    """The arguments of a verb that are numbers, or several."""
    for name, given in verb.__annotations__.items():
        types = set(re.findall(r"\w+", given))
        if types & {"float", "int"} and not types & {"str", "Literal", "Callable"}:
            yield name


@pytest.mark.parametrize("name", [*VERBS, "respond_each", "overturning_map", "overturning_curves", "response_spectrum"])
def test_text_for_a_number_is_refused(name):
    verb = getattr(rk, name)
    for argument in numeric(verb):
        needed = {
            each.name: None
            for each in inspect.signature(verb).parameters.values()
            if each.default is each.empty and each.kind in (each.POSITIONAL_OR_KEYWORD, each.KEYWORD_ONLY)
        }
        for text in ("ten", ("1", "2")):
            with pytest.raises(rk.InputError, match=f"^`{argument}` must be .*number.*, got the text '{text[0]}"):
                verb(**needed | {argument: text})


def test_the_refusal_of_a_text_says_what_to_give():
    block, motion = rk.Block(width=0.7, height=2.8), "sine:0.3g:0.8s"
    for given, said in (
        ({"tail": "500 ms"}, "give 0.5, in s"),
        ({"rtol": "1e-8"}, "give 1e-08$"),
    ):
        with pytest.raises(rk.InputError, match=said):
            rk.respond(block, motion, **given)
    with pytest.raises(
        rk.InputError, match=r"`sizes` must be two numbers, got the text '0\.2:2'\n  give \(low, high\)"
    ):
        rk.spectrum(block, motion, sizes="0.2:2")


@pytest.mark.filterwarnings("ignore::rocking_cli.DoubtWarning")
@pytest.mark.parametrize(
    ("text", "number"),
    [
        ({"dt": "10ms"}, {"dt": 0.01}),
        ({"target_pga": "0.4g"}, {"target_pga": 0.4}),
        ({"target_pgv": "40 cm/s"}, {"target_pgv": 0.4}),
        ({"scale": "2", "units": "M/SEC**2"}, {"scale": 2, "units": "m/s2"}),
        ({"resample": "5 ms", "taper": "5%"}, {"resample": 0.005, "taper": 0.05}),
        ({"other": "east.csv", "azimuth": "0.5 rad"}, {"other": "east.csv", "azimuth": 28.64788975654116}),
    ],
)
def test_an_option_of_a_record_may_be_text_with_its_unit_as_on_the_command_line(tmp_path, monkeypatch, text, number):
    monkeypatch.chdir(tmp_path)
    columns = "0\n1\n2\n-1\n0\n" * 20
    for name in ("north.csv", "east.csv"):
        Path(name).write_text(columns)
    usual = {"dt": 0.01, "units": "g"}
    assert rk.record("north.csv", **usual | text).result == rk.record("north.csv", **usual | number).result


@pytest.mark.parametrize(
    ("option", "said"),
    [
        ({"dt": "10 kg"}, "`dt`: 10 kg is a mass, not a time"),
        ({"target_pga": "0.4 m"}, "`target_pga`: 'm' is not a unit of acceleration"),
        ({"azimuth": "north", "other": "a.csv"}, "`azimuth`: 'north' is not a number"),
        ({"quantity": "speed"}, "`from` must be one of acceleration, velocity, displacement"),
        ({"channel": 1.5}, "`channel` must be a number, from 1, or a name"),
        ({"other": 3}, "`with` must be the file"),
        ({"azimth": 3}, "`azimth` is not an argument\n  did you mean azimuth?"),
    ],
)
def test_an_option_of_a_record_that_is_wrong_is_named(option, said):
    with pytest.raises(rk.InputError) as refused:
        rk.record(EXAMPLES / "accel.csv", **option)
    assert said in str(refused.value)


FIELD = "{0} is a field of the structure: structure.replace({0}={1})"


@pytest.mark.parametrize(
    ("verb", "word", "value", "said"),
    [
        ("respond", "eta", 0.9, FIELD.format("restitution", 0.9)),
        ("respond", "restitution", 0.9, FIELD.format("restitution", 0.9)),
        ("respond", "restitutoin", "0.9", FIELD.format("restitution", "'0.9'")),
        ("margin", "mu", 0.4, FIELD.format("friction", 0.4)),
        ("equiv", "g", 3.7, FIELD.format("gravity", 3.7)),
        ("spectrum", "name", "pillar", FIELD.format("name", "'pillar'")),
        ("respond", "width", 0.8, FIELD.format("width", 0.8)),
        ("respond_each", "heigth", 3, FIELD.format("height", 3)),
        ("design", "ties", [{}], FIELD.format("ties", "...")),
        ("respond", "thickness", 0.8, "its thickness is given by width"),
        ("respond", "damping", 0.05, "damping has no meaning: a structure that rocks loses energy at its impacts"),
        ("respond", "dampers", [], "dampers: a damper is not in this version"),
        ("respond", "polarities", "both", "did you mean polarity?"),
        ("respond", "model", "nonlinear", "did you mean models?"),
        ("animate", "models", "nonlinear", "did you mean model?"),
        ("respond", "record", "a.csv", "did you mean motion?"),
        ("margin", "record", "a.csv", "did you mean motions?"),
        ("respond", "motions", ["a.csv"], "did you mean motion?"),
        ("margin", "motion", "a.csv", "did you mean motions?"),
        ("respond", "scales", [1, 2], "did you mean scale?"),
        ("respond_each", "scale", 2, "did you mean scales?"),
        ("respond", "unit", "g", "did you mean units?"),
        ("respond", "mechanism", None, "did you mean structure?"),
        ("equiv", "structure", None, "did you mean structures?"),
        ("respond", "pga", 0.3, "did you mean target_pga?"),
        ("respond", "nieghbours", 9, "did you mean neighbours?"),
        ("respond", "zzz", 1, "known: amplitude_deviation, azimuth,"),
        ("select", "eta", 0.9, "known: "),
    ],
)
def test_what_is_no_argument_is_told_what_it_may_be(verb, word, value, said):
    block = rk.Block(width=0.7, height=2.8)
    for given in (block, [block]) if verb != "select" else ("a.csv",):
        with pytest.raises(rk.InputError) as refused:
            getattr(rk, verb)(given, **{word: value})
        assert str(refused.value).startswith(f"`{word}` is not an argument\n  {said}")


def test_a_word_for_a_field_of_the_structure_is_an_argument_where_there_is_one():
    assert rk.pulse(a=3.0, omega=4.0, eta=0.5).result
    with pytest.raises(rk.InputError, match=r"structure.replace\(restitution=0.9\)"):
        rk.respond(EXAMPLES / "block.yaml", "sine:0.3g:0.5s", eta=0.9)


def test_of_a_trace_or_a_table_an_option_without_effect_is_refused(monkeypatch):
    block, trace = EXAMPLES / "calibrate" / "block.yaml", EXAMPLES / "calibrate" / "trace.csv"
    for given in ({"highpass": 0.1}, {"neighbours": 40}, {"points": 9}, {"slenderness": (0.8, 1.2)}, {"floor": FLOOR}):
        (name,) = given
        with pytest.raises(rk.InputError, match=f"`{name}` has no effect on a trace"):
            rk.calibrate(block, free=trace, **given)
    said = run("calibrate", block, "--free", trace, "--highpass", "0.1", "--neighbours", "7", code=2).stderr
    assert "--neighbours, --highpass have no effect on a trace (--free): give --tests" in said
    with monkeypatch.context() as patch:  # what a user sets for all commands is no error
        patch.setenv("ROCKING_NEIGHBOURS", "7")
        patch.setenv("ROCKING_DT", "0.1")
        assert "10 impacts are seen" in run("calibrate", block, "--free", trace).stdout
    for ask in (
        lambda: rk.calibrate(block, tests=EXAMPLES / "tests.csv", scale=2),
        lambda: rk.score(EXAMPLES / "tests.csv", scale=2),
        lambda: rk.select("none.csv", EXAMPLES / "target.csv", band=(0.2, 2), count=1, scale=2),
    ):
        with pytest.raises(rk.InputError, match="`scale` is not an argument\n  the motions of this question are not"):
            ask()


def test_the_opening_is_that_of_scored_tests_too(tmp_path):
    arch = "mechanism: arch\nradius: 6\nthickness: 0.8\ninclusion_angle_deg: 150\nvoussoirs: 7\n"
    (tmp_path / "arch.yaml").write_text(arch)
    (tmp_path / "tests.csv").write_text("structure,record,overturned\narch.yaml,sine:0.6g:0.4s,0\n")
    table = tmp_path / "tests.csv"
    for opening in (0.0, 1000.0):
        typed = run_json("score", table, "--neighbours", "2", "--opening", opening)["tests"][0]["unknown"]
        assert typed == rk.score(table, neighbours=2, opening=opening).tests[0].unknown_share == (opening == 0)


def test_an_array_in_another_unit_is_converted_once():
    sizes = {"g": 9.80665, "cm/s^2": 0.01, "gal": 0.01, "m/s2": 1.0, "ft/s2": 0.3048}
    sizes |= {"mg": 9.80665e-3, "%g": 9.80665e-2, "mm/s2": 1e-3, "in/s2": 0.0254}
    assert set(UNITS) <= {unit.replace("^", "") for unit in sizes}  # all that `--units` accepts
    for unit, size in sizes.items():
        motion = rk.GroundMotion("mine", 0.01, [0.0, 0.3, 0.0], unit=unit)
        again = replace(motion.scaled(2), name="again")
        assert motion.acceleration.max() == pytest.approx(0.3 * size, rel=1e-15)
        assert again.acceleration.max() == pytest.approx(0.6 * size, rel=1e-15)
        assert motion.source_unit == again.source_unit == unit and motion.unit == again.unit == "m/s2"
    for unit, said in (("parsec", "not a unit of acceleration"), ("mm", "is a length"), ("", "without a unit")):
        with pytest.raises(rk.InputError, match=f"(?s)`unit`.*{said}"):
            rk.GroundMotion("mine", 0.01, [0.0, 0.3, 0.0], unit=unit)
    with pytest.raises(TypeError):  # not by place, where the unit of the file once was
        rk.GroundMotion("mine", 0.01, [0.0, 0.3, 0.0], "g")
    assert rk.read_record(EXAMPLES / "accel.csv").scaled(2).source_unit == "g"


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


def test_structures_of_one_name_are_told_apart_everywhere():
    walls = [rk.Wall(thickness=0.3, height=height) for height in (2.0, 3.0, 4.0)]
    found = rk.equiv(walls)
    assert list(found) == ["wall", "wall-2", "wall-3"]
    assert [each.positive.lambda_ for each in found.values()] == pytest.approx([0.6, 0.4, 0.3], rel=1e-9)
    assert len(found.to_frame()) == 3 * len(rk.equiv(walls[0]).to_frame())
    curves = rk.overturning_curves(walls[:2], points=3, period=(0.5, 1.0)).to_frame()
    assert {"wall", "wall_2"} <= set(curves) and (curves["wall"] != curves["wall_2"]).all()
    assert list(rk.respond_each(walls[:2], "sine:0.3g:0.5s").grid.axes["structure"]) == ["wall", "wall-2"]

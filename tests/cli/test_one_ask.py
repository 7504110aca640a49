"""What verbs refuse, and what they say of words that are no argument."""

from dataclasses import replace
from pathlib import Path
from typing import get_args

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.ask import watcher as rk_watcher
from rocking_cli.ask.asked import checked
from rocking_cli.plugins.rooms import names
from rocking_cli.units import UNITS
from tests.cli.test_cli import run
from tests.conftest import EXAMPLES


def test_an_argument_that_is_none_or_has_no_effect_is_refused():
    block = rk.Block(width=0.7, height=2.8)
    with pytest.raises(rk.InputError, match="`run_on` has no effect, as no ground motion is given"):
        rk.respond(block, release=0.5, run_on=True)
    with pytest.raises(rk.InputError, match="`run_on` describes a record, and no record is given"):
        rk.respond(block, "sine:0.3g:0.8s", run_on=True)


def test_a_motion_that_is_used_is_not_corrected_any_more():
    block, record = EXAMPLES / "block.yaml", EXAMPLES / "accel.csv"
    with pytest.raises(rk.InputError) as refused:
        rk.respond(block, record, highpass=0.1)
    said = "`highpass` is not an argument\n  records are corrected once, by `rk.read_record(FILE, highpass=...)`"
    assert str(refused.value) == said
    said = run("respond", block, "--record", record, "--highpass=0.1", code=2).stderr
    assert "No such option --highpass: records are corrected once, by `rocking record FILE --highpass ... --out" in said
    assert "corrected once" not in run("equiv", block, "--highpass", "0.1", code=2).stderr


VERBS = {name: verb for name in names() if hasattr(verb := getattr(rk, name), "model")}


@pytest.mark.parametrize("name", VERBS)
def test_a_word_for_a_number_is_refused(name):
    fields = VERBS[name].model.model_fields
    needed = {each: "x" for each, field in fields.items() if field.is_required()}
    for field, info in fields.items():
        types = {*get_args(info.annotation), info.annotation}
        if types & {int, float} and str not in types:
            with pytest.raises(rk.InputError, match=f"(?m)^`{field}`"):
                checked(VERBS[name].model, needed | {field: "ten"})


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
def test_an_option_of_a_record_may_be_text_with_its_unit_as_on_the_command_line(tmp_path, text, number):
    columns = "0\n1\n2\n-1\n0\n" * 20
    for name in ("north.csv", "east.csv"):
        Path(name).write_text(columns)
    usual = {"dt": 0.01, "units": "g"}
    assert rk.record("north.csv", **usual | text).result == rk.record("north.csv", **usual | number).result


@pytest.mark.parametrize(
    ("option", "said"),
    [
        ({"dt": "10 kg"}, "`dt`: 10 kg is a mass, not a time"),
        ({"target_pga": "0.4 m"}, "`target_pga`: 0.4 m is a length, not an acceleration"),
        ({"azimuth": "north", "other": "a.csv"}, "`azimuth`: 'north' is not a number"),
        ({"quantity": "speed"}, "`quantity` must be one of acceleration, velocity, displacement"),
        ({"channel": 1.5}, "`channel` must be a number, from 1, or a name"),
        ({"other": 3}, "`other` must be the file"),
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
        ("respond", "eta", 0.9, "did you mean restitution?"),
        ("respond", "restitutoin", "0.9", "did you mean restitution?"),
        ("shares", "restitution", 0.9, FIELD.format("restitution", 0.9)),
        ("margin", "mu", 0.4, FIELD.format("friction", 0.4)),
        ("spectrum", "name", "pillar", FIELD.format("name", "'pillar'")),
        ("respond_each", "heigth", 3, FIELD.format("height", 3)),
        ("design", "ties", [{}], FIELD.format("ties", "...")),
        ("respond", "thickness", 0.8, "its thickness is given by width"),
        ("respond", "damping", 0.05, "damping has no meaning: a structure that rocks loses energy at its impacts"),
        ("animate", "models", "nonlinear", "did you mean model?"),
        ("margin", "motion", "a.csv", "did you mean motions?"),
        ("respond_each", "scales", 2, "did you mean scale?"),
        ("equiv", "structure", None, "did you mean structures?"),
        ("respond", "pga", 0.3, "did you mean target_pga?"),
        ("respond", "zzz", 1, "known: amplitude_deviation, animate, azimuth,"),
        ("select", "eta", 0.9, "known: "),
    ],
)
def test_what_is_no_argument_is_told_what_it_may_be(verb, word, value, said):
    block = rk.Block(width=0.7, height=2.8)
    with pytest.raises(rk.InputError) as refused:
        getattr(rk, verb)("a.csv" if verb == "select" else [block], **{word: value})
    assert str(refused.value).startswith(f"`{word}` is not an argument\n  {said}")


def test_a_word_for_a_field_of_the_structure_is_an_argument_where_there_is_one():
    assert rk.pulse(a=3.0, omega=4.0, restitution=0.5).result
    with pytest.raises(rk.InputError, match=r"structure.replace\(restitution=0.9\)"):
        rk.shares(EXAMPLES / "block.yaml", "sine:0.3g:0.5s", eta=0.9)


def test_an_option_of_motions_that_are_not_scaled_is_refused():
    with pytest.raises(rk.InputError, match="`scale` is not an argument\n  the motions of this question are not"):
        rk.select("none.csv", EXAMPLES / "target.csv", band=(0.2, 2), count=1, scale=2)


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
    blocks = [rk.Block(width=0.6, height=height) for height in (1.0, 1.5, 2.0)]
    found = rk.equiv(blocks)
    assert list(found) == ["block", "block-2", "block-3"]
    assert [each.positive.lambda_ for each in found.values()] == pytest.approx([0.6, 0.4, 0.3], rel=1e-9)
    assert len(found.to_frame()) == 3 * len(rk.equiv(blocks[0]).to_frame())
    curves = rk.overturning_curves(blocks[:2], points=3, period=(0.5, 1.0), model="linear2").to_frame()
    one, other = (curves[curves.structure == name].least.to_numpy() for name in ("block", "block-2"))
    assert one.size == 3 and (one != other).all()
    assert list(rk.respond_each(blocks[:2], "sine:0.3g:0.5s").grid.axes["structure"]) == ["block", "block-2"]


BLOCK, PULSE = rk.Block(width=0.7, height=2.8), "sine:0.3g:0.8s"


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("scale", []),
        ("restitution", {}),
        ("tail", b""),
        ("release", 10**400),
        ("floor", []),
        ("plot", {}),
        ("out", b""),
    ],
)
def test_what_is_no_value_at_all_is_refused(name, value):
    with pytest.raises(rk.InputError, match=f"`{name}`"):
        rk.respond(BLOCK, PULSE, **{name: value})


def test_numbers_of_numpy_are_numbers_and_a_tilt_is_its_text_in_what_was_given():
    assert rk.respond(BLOCK, PULSE, scale=np.int64(2)).to_dict()["given"] == {"scale": 2.0}
    assert rk.respond(BLOCK, release=0.05).to_dict()["given"] == {"release": "0.05"}


def test_options_of_records_are_named_as_they_are_typed():
    record = EXAMPLES / "accel.csv"
    assert "--azimuth requires" in (said := run("record", record, "--azimuth", 30, code=2).stderr)
    assert "with --with" in said
    assert "error: --units describes" in run("respond", "--pulse", PULSE, "--units", "g", code=2).stderr

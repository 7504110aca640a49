"""Options beyond all sense are refused at once, with the numbers; and small things that were written wrongly."""

import io
import re

import numpy as np
import pytest

from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.records.prepared import write_record_csv
from rocking_cli.io.tables import write_csv
from tests.cli.test_cli import run
from tests.conftest import EXAMPLES

ACCEL, BLOCK = str(EXAMPLES / "accel.csv"), str(EXAMPLES / "block.yaml")
PULSE = "sine:0.4g:1s"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("respond", BLOCK, "--record", ACCEL, "--target-pgv", "1e9"), "PGV = 1e+09 m/s scaled by 1.54"),
        (("respond", BLOCK, "--record", ACCEL, "--scale", "1e9"), "PGA = 5.5e+08 g"),
        (("respond", BLOCK, "--pulse", "sine:2000g:1s"), "PGA = 2000 g"),
        (("animate", BLOCK, "--record", ACCEL, "--scale=-1e308", "--out", "m.html"), "at most 1000 g and 10000 m/s"),
        (("spectrum", BLOCK, "--record", ACCEL, "--scale", "1e9"), "PGA = 5.5e+08 g"),
        (("report", BLOCK, "--record", ACCEL, "--scale", "1e9", "--json"), "PGA = 5.5e+08 g"),
        (("record", ACCEL, "--scale", "1e9"), "PGA = 5.5e+08 g"),
    ],
)
def test_a_motion_that_is_none_is_refused_everywhere(arguments, said):
    result = run(*arguments, code=2)
    assert said in result.stderr and result.stdout == ""


@pytest.mark.parametrize(
    "arguments",
    [
        ("overturning", BLOCK, "--period", "1e-300:1e300"),
        ("overturning", "--a", "1:1e300"),
        ("overturning", BLOCK, "--ag", "0.1g:1e300g"),
        ("spectrum", BLOCK, "--pulse", PULSE, "--sizes", "1e-300:1e300"),
        ("spectrum", BLOCK, "--pulse", PULSE, "--jobs", "100000000"),
        ("equivalent_pulses", BLOCK, BLOCK, "--ag", "1e300g", "--period", "1"),
    ],
)
def test_ranges_have_bounds(arguments):
    result = run(*arguments, code=2)
    assert result.stdout == "" and re.match("error: --.* (is outside the supported range|must be at)", result.stderr)


@pytest.mark.parametrize(("file", "speed"), [("m.gif", "1e-300"), ("m.html", "1e300")])
def test_a_film_has_a_speed_that_can_be_watched(file, speed):
    result = run("animate", BLOCK, "--pulse", PULSE, "--out", file, "--speed", speed, code=2)
    assert result.stdout == "" and re.match("error: --speed must be at (least 0.001|most 1000), got", result.stderr)


def test_a_pulse_too_short_to_be_shown_is_no_question_of_dt():
    assert "is the period in seconds?" in run("respond", BLOCK, "--pulse", "sine:0.5g:1e-300s", code=2).stderr


@pytest.mark.parametrize(
    "command",
    [
        ("respond", "--pulse", PULSE),
        ("animate", "--pulse", PULSE, "--out", "m.html"),
        ("report", "--pulse", PULSE, "--json"),
        ("spectrum", "--pulse", PULSE),
        ("overturning", "--points", "4"),
    ],
)
def test_where_kinematics_give_no_restitution_file_and_field_are_named(command, tmp_path):
    for name in ("slab.yaml", "rocking.yaml"):
        (tmp_path / name).write_text("mechanism: block\nwidth: 3\nheight: 1\n", encoding="utf-8")
    assert "slab.yaml: restitution: " in run(command[0], "slab.yaml", *command[1:], code=2).stderr
    if command[0] != "overturning":
        assert "rocking.yaml: restitution: " in run(*command, code=2).stderr


@pytest.mark.parametrize(
    "command",
    [
        ("spectrum", "--pulse", PULSE, "--sizes", "1:3", "--count", "3"),
        ("equivalent_pulses", "--ag", "0.6g", "--period", "0.5"),
    ],
)
def test_one_bad_structure_of_several_is_reported_and_the_others_are_used(command):
    wall = str(EXAMPLES / "wall.yaml")
    alone = run(command[0], BLOCK, wall, *command[1:], "--json").stdout
    result = run(command[0], BLOCK, "no.yaml", wall, *command[1:], "--json", code=5)
    assert result.stdout == alone and "no.yaml: no such file" in result.stderr


class TestWritten:
    def test_there_is_no_minus_zero_in_a_table(self):
        stream = io.BytesIO()
        write_csv(stream, [{"a": [-0.0, 0.0, -1.5]}])
        assert stream.getvalue() == b"a\n0\n0\n-1.5\n"

    def test_nor_in_a_record(self):
        stream = io.BytesIO()
        write_record_csv(stream, GroundMotion("m", 0.01, np.array([-0.0, -1.0, 0.0]), unit="m/s2"))
        assert [line.split(b",")[1] for line in stream.getvalue().splitlines()[3:]] == [b"0.0", b"-1.0", b"0.0"]

    def test_a_pga_in_g_has_the_digits_of_the_file(self):
        for value in (0.8740596, 0.1234567, 0.3, 0.55):
            motion = GroundMotion("m", 0.01, np.array([0.0, value * STANDARD_GRAVITY, 0.0]), unit="m/s2")
            assert motion.pga_g == value

"""A vertical component on the command line: what it does to the answer, and what is said of it."""

import csv
from dataclasses import replace

import numpy as np
import pytest

from rocking_cli.ask.read import read_record
from rocking_cli.core.structure_file import load_structure
from rocking_cli.dynamics.history import contact_lost
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.views.response import vertical_notes
from tests.cli.test_cli import ACCEL, FRAME, run, run_json
from tests.following import respond

G = 9.80665


@pytest.fixture
def up(tmp_path):
    """A vertical component at another interval than the record's, in its unit."""
    file = tmp_path / "up.csv"
    rows = "".join(f"{0.004 * k:.3f},{0.3 * np.sin(0.1 * k):.6f}\n" for k in range(1500))
    file.write_text("t [s],a [g]\n" + rows, encoding="utf-8")
    return file


def test_it_changes_the_response_as_the_library_says(up):
    data = run_json("respond", FRAME, "--record", ACCEL, "--vertical", up, "--scale", "0.8", "--polarity", "-1")
    motion = replace(read_record(ACCEL), vertical=read_record(up)).scaled(-0.8)
    np.testing.assert_array_equal(motion.vertical.acceleration, 0.8 * read_record(up).acceleration)
    expected = respond(load_structure(FRAME), motion)
    without = run_json("respond", FRAME, "--record", ACCEL, "--scale", "0.8", "--polarity", "-1")
    for name, history in expected.items():
        assert data["responses"][name]["peak_ratio"] == history.peak_ratio
        assert data["responses"][name]["contact_lost"] is None
        assert data["responses"][name]["peak_ratio"] != without["responses"][name]["peak_ratio"]
    assert data["record"]["vertical"] == {
        "name": "up.csv", "npts": 1500, "dt": 0.004, "unit": "g", "pga_g": pytest.approx(0.3, rel=1e-3),
        "format": "text", "processing": [],
    }  # fmt: skip
    assert without["record"]["vertical"] is None
    assert (len(data["notes"]), without["notes"]) == (1, [])


def test_loss_of_contact_is_reported(tmp_path):
    file = tmp_path / "strong.csv"
    file.write_text("t [s],a [g]\n0,0\n1,0.5\n2,-1.5\n3,0\n", encoding="utf-8")
    command = ("respond", FRAME, "--record", ACCEL, "--vertical", file, "--engine", "exact")
    data = run_json(*command)
    assert data["responses"]["nonlinear"]["contact_lost"] == pytest.approx(1.75)
    assert "at 1.75 s v_g'' comes down to -g" in data["notes"][1]
    text = run(*command).stdout
    assert "do not trust the response from then on" in text and "nothing to 1.22 times" not in text
    assert "nothing to 1.22 times" in run(*command, "--all").stdout


@pytest.mark.parametrize(
    ("samples", "lost"),
    [([0.0, -0.99], None), ([0.0, -1.0], 0.1), ([0.0, 0.0, -2.0, -2.0], 0.15), ([-1.0, 0.0], 0.0), ([-3.0, 0.0], 0.0)],
)
def test_contact_is_lost_where_the_ramp_reaches_minus_g(samples, lost):
    up = GroundMotion("up", 0.1, G * np.array(samples), unit="m/s2")
    motion = GroundMotion("both", 0.1, np.zeros(2), vertical=up, unit="m/s2")
    assert contact_lost(motion, G) == (None if lost is None else pytest.approx(lost, rel=1e-12))
    assert len(vertical_notes(motion, G)) == (1 if lost is None else 2)
    assert len(vertical_notes(motion, G, until=0.12)) == (2 if lost is not None and lost < 0.12 else 1)
    assert contact_lost(replace(motion, vertical=None), G) is None
    assert vertical_notes(replace(motion, vertical=None), G) == []


def test_the_history_file_has_it_at_the_samples_of_the_record(up, tmp_path):
    run("respond", FRAME, "--record", ACCEL, "--vertical", up, "--out", tmp_path / "out.csv")
    with (tmp_path / "out.csv").open(encoding="utf-8", newline="") as stream:
        rows = list(csv.reader(stream))
    assert rows[0][:3] == ["t [s]", "a_g [g]", "v_g [g]"]
    values = {round(float(row[0]), 3): float(row[2]) for row in rows[1:]}
    assert values[0.02] == pytest.approx(0.3 * np.sin(0.5), abs=1e-6)  # its sixth sample
    assert values[0.01] == pytest.approx(0.15 * (np.sin(0.2) + np.sin(0.3)), abs=1e-6)  # between two
    assert values[7.0] == 0.0  # after its last


def test_one_column_takes_its_own_interval_or_that_of_the_record(tmp_path):
    file = tmp_path / "column.txt"
    file.write_text("0\n0.1\n-0.2\n0.1\n0\n", encoding="utf-8")
    options = ("respond", "--record", file, "--dt", "0.5", "--units", "g", "--vertical", file)
    assert run_json(*options)["record"]["vertical"]["dt"] == 0.5
    assert run_json(*options, "--vertical-dt", "0.3")["record"]["vertical"]["dt"] == 0.3
    assert "no channel '2'" in run(*options, "--vertical-channel", "2", code=2).stderr


def test_wrong_use_is_refused(up, tmp_path):
    assert "--record" in run("respond", "--release", "0.3", "--vertical", up, code=2).stderr
    assert "without --vertical" in run("respond", "--record", ACCEL, "--vertical-dt", "0.1", code=2).stderr
    assert "no such file" in run("respond", "--record", ACCEL, "--vertical", tmp_path / "none.csv", code=2).stderr
    assert "overwrite" in run("respond", "--record", ACCEL, "--vertical", up, "--out", up, code=2).stderr


def test_the_tolerance_can_be_set_and_holds():
    tight, loose = (
        run_json("respond", FRAME, "--record", ACCEL, "--rtol", rtol)["responses"]["nonlinear"]["peak_ratio"]
        for rtol in ("1e-12", "1e-3")
    )
    usual = run_json("respond", FRAME, "--record", ACCEL)["responses"]["nonlinear"]["peak_ratio"]
    assert usual == pytest.approx(tight, rel=1e-9)
    assert loose == pytest.approx(tight, rel=1e-2) and loose != tight
    for wrong, said in (("1", "must be less than 1"), ("9e-15", "must be at least 1e-14"), ("0", "positive")):
        assert said in run("respond", "--record", ACCEL, "--rtol", wrong, code=2).stderr

"""Pulses on the command line: in place of a record, and found in one."""

from __future__ import annotations

import csv
from dataclasses import replace

import pytest

from rocking_cli.dynamics.history import respond
from rocking_cli.excitation.pulses import PulseShapes, parse_pulse
from rocking_cli.excitation.records import read_record
from rocking_cli.structure import load_structure
from tests.test_cli import ACCEL, FRAME, run, run_json

SINE = "sine:0.3g:0.8s"


class TestInPlaceOfARecord:
    @pytest.mark.parametrize("name", list(PulseShapes()))
    def test_every_shape_gives_the_response_of_the_library(self, name):
        text = f"{name}:0.3g:0.8s"
        data = run_json("respond", FRAME, "--pulse", text, "--scale", "0.9", "--polarity", "-1")
        history = respond(load_structure(FRAME), parse_pulse(text).sampled().scaled(-0.9))["nonlinear"]
        response = data["responses"]["nonlinear"]
        assert (response["peak_ratio"], response["impacts"]) == (history.peak_ratio, history.impact_count)
        assert (response["uplift_time"], response["overturning_time"]) == (
            history.uplift_time, history.overturning_time,
        )  # fmt: skip
        assert response["uplift_time"] is not None

    def test_json_says_which_pulse(self):
        record = run_json("respond", "--pulse", "mavroeidis:0.3g:0.8s:45deg:1.5")["record"]
        assert list(record) == ["name", "npts", "dt", "unit", "pga", "format", "pulse", "vertical", "scale", "polarity"]
        assert (record["name"], record["format"]) == ("mavroeidis:0.3g:0.8s:45deg:1.5", "pulse")
        assert record["pga"] == pytest.approx(0.3, rel=1e-4)
        assert record["pulse"] == {
            "shape": "mavroeidis", "specification": "mavroeidis:0.3g:0.8s:45deg:1.5", "amplitude": pytest.approx(0.3),
            "period": 0.8, "duration": pytest.approx(1.2), "phase": 45, "cycles": 1.5,
        }  # fmt: skip
        assert "pulse" not in run_json("respond", "--record", ACCEL)["record"]

    @pytest.mark.parametrize("name", list(PulseShapes()))
    def test_nothing_is_doubtful_about_a_formula(self, name):
        result = run("respond", FRAME, "--pulse", f"{name}:9g:20s", "--model", "linear1")
        assert "warning" not in result.stderr and "9 g" in result.stderr and "20 s" in result.stderr

    def test_targets_polarities_files_and_pictures_go_with_it(self, tmp_path):
        data = run_json("respond", "--pulse", SINE, "--target-pga", "0.35", "--polarity", "both")
        assert data["record"]["scale"] == pytest.approx(0.35 / 0.3) and data["governs"] is None
        run("respond", FRAME, "--pulse", SINE, "--out", "out.csv", "--plot", "plot.png")
        assert (tmp_path / "plot.png").read_bytes().startswith(b"\x89PNG")
        with (tmp_path / "out.csv").open(encoding="utf-8") as stream:
            rows = list(csv.DictReader(stream))
        assert max(float(row["a_g [g]"]) for row in rows) == pytest.approx(0.3, rel=1e-4)
        assert "0.5" in run("respond", "--pulse", SINE, "--target-pgv", "0.5").stderr
        assert run_json("respond", "--pulse", SINE, "--release", "0.3")["release"] == 0.3

    def test_a_vertical_component_goes_with_it_at_its_own_interval(self, tmp_path):
        (tmp_path / "up.txt").write_text("\n".join(["0", *["0.3", "-0.3"] * 200]) + "\n", encoding="utf-8")
        data = run_json("respond", FRAME, "--pulse", SINE, "--vertical", "up.txt", "--dt", "0.01", "--units", "g")
        up = read_record(tmp_path / "up.txt", dt=0.01, units="g")
        history = respond(load_structure(FRAME), replace(parse_pulse(SINE).sampled(), vertical=up))["nonlinear"]
        assert data["responses"]["nonlinear"]["peak_ratio"] == history.peak_ratio
        assert data["record"]["vertical"]["dt"] == 0.01

    @pytest.mark.parametrize(
        ("options", "words"),
        [
            (["--pulse", SINE, "--record", ACCEL], "exclude each other"),
            (["--pulse", "sin:1g:1s"], "did you mean sine?"),
            (["--pulse", "sine:1:1s"], "no unit of amplitude"),
            (["--pulse", "sine:1g"], "expected sine:AMPLITUDE:PERIOD, such as sine:0.6g:0.8s"),
            (["--pulse", SINE, "--units", "g"], "--units and --dt describe a record"),
            (["--pulse", SINE, "--channel", "1"], "--channel is one of a record"),
            (["--pulse", SINE, "--vertical-dt", "1"], "give --vertical FILE"),
            (["--release", "0.5", "--scale", "2"], "or --pulse"),
            ([], "--pulse"),
        ],
    )
    def test_what_does_not_fit_is_refused(self, options, words):
        assert words in run("respond", *options, code=2).stderr

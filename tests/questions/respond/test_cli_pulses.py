"""Pulses on the command line: in place of a record, and found in one."""

import csv
import json
from typing import get_args

import numpy as np
import pytest
from click.testing import CliRunner

from rocking_cli.ask.read import read_record
from rocking_cli.cli.main import main
from rocking_cli.core.structure_file import load_structure
from rocking_cli.excitation.pulse_fit import FITTED, fit_pulse
from rocking_cli.excitation.pulses import PulseShapes, parse_pulse
from rocking_cli.questions.record.picture import draw_pulses
from rocking_cli.questions.respond.asked import PulseShape
from rocking_cli.questions.respond.picture import draw_history
from tests.cli.test_cli import ACCEL, FRAME, run, run_json
from tests.conftest import rows_of
from tests.following import respond

SINE = "sine:0.3g:0.8s"


class TestInPlaceOfARecord:
    @pytest.mark.every(3)
    @pytest.mark.parametrize("name", list(PulseShapes()))
    def test_every_shape_gives_the_response_of_the_library(self, name):
        text = f"{name}:0.3g:0.8s"
        data = run_json("respond", FRAME, "--pulse", text, "--scale", "0.9", "--polarity", "-1")
        history = respond(load_structure(FRAME), parse_pulse(text).sampled().scaled(-0.9))["nonlinear"]
        response = data["responses"]["nonlinear"]
        assert (response["peak_ratio"], response["impacts_all"]) == (history.peak_ratio, history.impact_count)
        assert response["uplift_time"] == history.uplift_time
        assert response["overturning_time"] is None and np.isnan(history.overturning_time)

    def test_json_says_which_pulse(self):
        record = run_json("respond", "--pulse", "mavroeidis:0.3g:0.8s:45deg:1.5")["record"]
        assert (record["name"], record["format"]) == ("mavroeidis:0.3g:0.8s:45deg:1.5", "pulse")
        assert record["pga_g"] == pytest.approx(0.3, rel=1e-4)
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
        rows = rows_of(tmp_path / "out.csv")
        assert max(float(row["a_g [g]"]) for row in rows) == pytest.approx(0.3, rel=1e-4)
        assert "0.5" in run("respond", "--pulse", SINE, "--target-pgv", "0.5").stderr
        assert run_json("respond", "--pulse", SINE, "--release", "0.3")["release"] == 0.3

    @pytest.mark.parametrize(
        ("options", "words"),
        [
            (["--pulse", "sin:1g:1s"], "did you mean sine?"),
            (["--pulse", "sine:1g"], "expected sine:AMPLITUDE:PERIOD, such as sine:0.6g:0.8s"),
            (["--pulse", SINE, "--channel", "1"], "describes a record"),
            (["--pulse", SINE, "--vertical-dt", "1"], "has no effect without --vertical"),
            (["--release", "0.5", "--scale", "2"], "or --pulse"),
        ],
    )
    def test_what_does_not_fit_is_refused(self, options, words):
        assert words in run("respond", *options, code=2).stderr


KEYS = ["criterion", "captured", "start", "centre", "sign", "shape", "specification", "amplitude", "period", "duration"]


@pytest.fixture
def made(tmp_path):
    """A record that is a reversed sine of 0.4 g and 0.8 s from 2 s on, and a little besides."""
    t = 0.01 * np.arange(1000)
    a = -parse_pulse("sine:0.4g:0.8s").acceleration(t - 2.0) / 9.80665 + 0.01 * np.sin(40 * t) * (t < 8)
    path = tmp_path / "made.csv"
    path.write_text("t,accel_g\n" + "".join(f"{x:.2f},{y:.9f}\n" for x, y in zip(t, a, strict=True)), encoding="utf-8")
    return path


class TestInARecord:
    def test_json_has_every_shape_by_both_criteria(self, made):
        data = run_json("record", made, "--fit-pulse", "--scale", "2")
        assert list(data)[-3:] == ["warnings", "pulses", "given"] and "pulses" not in run_json("record", made)
        assert list(data["pulses"]) == ["acceleration", "velocity"]
        motion = read_record(made).scaled(2)
        for criterion, fits in data["pulses"].items():
            assert list(fits) == ["sine", "ricker", "mavroeidis"] == list(FITTED)
            for shape, found in fits.items():
                assert list(found) == KEYS + (["phase", "cycles"] if shape == "mavroeidis" else [])
                fit = fit_pulse(motion, shape, criterion)
                assert (found["criterion"], found["shape"]) == (criterion, shape)
                assert (found["captured"], found["start"], found["centre"]) == (fit.captured, fit.start, fit.centre)
                assert parse_pulse(found["specification"]).period == pytest.approx(found["period"], rel=1e-5)
            sine = fits["sine"]
            assert (sine["sign"], sine["amplitude"]) == (-1, pytest.approx(0.8, rel=0.03))
            assert (sine["start"], sine["period"]) == (pytest.approx(2, abs=0.03), pytest.approx(0.8, rel=0.03))

    def test_several_files_and_one_without_a_pulse(self, made, tmp_path):
        (tmp_path / "zero.csv").write_text("t,accel_g\n" + "".join(f"{k},0\n" for k in range(40)), encoding="utf-8")
        result = CliRunner().invoke(main, ["record", "zero.csv", str(made), "--fit-pulse", "--json"])
        assert result.exit_code == 5 and "zero throughout" in result.stderr
        assert json.loads(result.stdout)["pulses"]["velocity"]["sine"]["sign"] == -1

    def test_a_long_search_says_how_far_it_is(self, made, monkeypatch):
        monkeypatch.setattr("rocking_cli.questions.record.verb.PROGRESS_DELAY", float("inf"))
        assert "fitted" not in run("record", made, "--fit-pulse").stderr
        monkeypatch.setattr("rocking_cli.questions.record.verb.PROGRESS_DELAY", 0.0)
        assert "made.csv: 3 of 6 pulses fitted" in run("record", made, "--fit-pulse").stderr

    def test_the_picture_shows_the_best_of_each_criterion(self, made, tmp_path):
        run("record", made, "--fit-pulse", "--plot", "plot.png")
        assert (tmp_path / "plot.png").read_bytes().startswith(b"\x89PNG")
        motion = read_record(made)
        fits = [fit_pulse(motion, "sine", "velocity"), fit_pulse(motion, "ricker", "acceleration")]
        above, below = draw_pulses(motion, fits, 9.0).axes
        for axes, of in ((above, "acceleration"), (below, "velocity")):
            thin, _, *bold = axes.get_lines()
            assert [line.get_linewidth() > 2 * thin.get_linewidth() for line in bold] == [True, True]
            assert len({line.get_linestyle() for line in bold}) == 2
            for line, fit in zip(bold, fits, strict=True):
                unit = 9.80665 if of == "acceleration" else 1.0
                np.testing.assert_allclose(line.get_ydata() * unit, getattr(fit, of)(line.get_xdata()))
        assert "fitted in velocity: " in above.get_figure().legends[0].get_texts()[0].get_text()
        assert above.get_xlim() == (0, 9)


class TestWithPulse:
    def test_json_has_the_pulse_and_the_responses_to_it_alone(self, made):
        data = run_json("respond", FRAME, "--record", made, "--with-pulse", "sine", "--polarity", "-1")
        assert list(data["pulse"]) == KEYS and data["pulse"]["sign"] == 1
        motion = read_record(made).scaled(-1)
        alone = fit_pulse(motion, "sine", "velocity").alone(motion)
        for name, motion_of in (("responses", motion), ("pulse_responses", alone)):
            history = respond(load_structure(FRAME), motion_of)
            assert list(data[name]) == list(history)
            assert [each["peak_ratio"] for each in data[name].values()] == [
                run.peak_ratio for run in history.values()
            ]  # fmt: skip
        plain = run_json("respond", FRAME, "--record", made)
        assert "pulse" not in plain and "pulse_responses" not in plain

    def test_without_a_value_the_best_is_taken(self, made):
        data = run_json("respond", "--record", made, "--model", "linear1", "--with-pulse")
        fits = run_json("record", made, "--fit-pulse")["pulses"]["velocity"]
        assert data["pulse"] == max(fits.values(), key=lambda fit: fit["captured"])
        assert list(data["pulse_responses"]) == ["linear1"]

    def test_tables_stand_one_after_the_other_and_say_what_share_is_the_pulse_s(self, made):
        result = run("respond", FRAME, "--record", made, "--with-pulse", "sine", "--impacts")
        words = " ".join(result.stdout.split())
        assert (
            words.index("under the record")
            < words.index("under the full sine alone")
            < words.index("the peak rotation under the full sine alone is")
        )
        assert "pulse: full sine" in result.stderr and "of the energy of the velocity" in result.stderr
        data = run_json("respond", FRAME, "--record", made, "--with-pulse", "sine")
        peaks = [data[name]["nonlinear"]["peak_ratio"] for name in ("responses", "pulse_responses")]
        assert (
            f"the peak rotation under the full sine alone is {100 * peaks[1] / peaks[0]:.3g} % of that under the record"
            in words
        )
        over = run("respond", FRAME, "--record", made, "--with-pulse", "sine", "--scale", "4").stdout
        assert "it overturns under the record; under the full sine alone it overturns" in over
        rest = run("respond", FRAME, "--record", made, "--with-pulse", "sine", "--scale", "0.1").stdout
        assert "does not uplift under the record" in rest

    def test_files_and_pictures_have_both(self, made, tmp_path):
        run("respond", FRAME, "--record", made, "--with-pulse", "--out", "out.csv", "--plot", "plot.png")
        with (tmp_path / "out.csv").open(encoding="utf-8") as stream:
            columns = next(csv.reader(stream))
        assert "nonlinear phi [rad]" in columns and "pulse nonlinear phi [rad]" in columns
        assert (tmp_path / "plot.png").read_bytes().startswith(b"\x89PNG")
        motion = read_record(made)
        fit = fit_pulse(motion, "sine", "velocity")
        structure = load_structure(FRAME)
        whole, alone = respond(structure, motion), respond(structure, fit.alone(motion))
        above, record, pulse = draw_history(whole, motion, "a frame", None, (fit, alone)).axes
        thin, bold = above.get_lines()
        assert bold.get_linewidth() > 3 * thin.get_linewidth() and bold.get_color() != thin.get_color()
        np.testing.assert_allclose(bold.get_ydata() * 9.80665, fit.acceleration(bold.get_xdata()))
        for axes, title, runs in ((record, "record", whole), (pulse, "its pulse alone", alone)):
            assert axes.get_title(loc="left") == title
            np.testing.assert_array_equal(axes.get_lines()[1].get_ydata(), runs["nonlinear"].ratio)

    @pytest.mark.parametrize(
        ("options", "words"),
        [
            (["--pulse", SINE, "--with-pulse"], "--with-pulse has no effect without a record"),
            (["--release", "0.5", "--with-pulse"], "--with-pulse has no effect without a record"),
            (
                ["--record", ACCEL, "--polarity", "both", "--with-pulse"],
                "--with-pulse has no effect with --polarity both",
            ),
            (["--record", ACCEL, "--with-pulse", "cosine"], "must be best, sine, ricker or mavroeidis"),
        ],
    )
    def test_what_does_not_fit_is_refused(self, options, words):
        assert words in run("respond", *options, code=2).stderr

    def test_the_shapes_of_the_help_are_those_of_the_library(self):
        assert ("best", *FITTED) == get_args(PulseShape)

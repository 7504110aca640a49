"""`rocking record` as a user runs it, and the scaling that it shares with `respond`."""

from __future__ import annotations

import csv
import json
import re
import shutil

import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import example, given, settings
from hypothesis import strategies as st

import rocking_cli as rk
from rocking_cli.ask.read import read_record
from rocking_cli.ask.watcher import Watcher
from rocking_cli.cli.main import main
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.measures import measure
from rocking_cli.excitation.records.prepared import write_record_csv
from rocking_cli.processing.oscillator import response_spectrum
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES

ACCEL = str(EXAMPLES / "accel.csv")
ACROSS = EXAMPLES / "accel_transverse.csv"


@pytest.fixture
def odd(tmp_path):
    """A record that is offset, clipped and coarse at once."""
    t = np.arange(200) * 0.02
    a = np.clip(np.sin(2 * np.pi * t), -0.6, 0.6) * 0.5 + 0.05
    lines = [f"{x:.2f},{y:.6f}" for x, y in zip(t, a, strict=True)]
    path = tmp_path / "odd.csv"
    path.write_text("t,accel_g\n" + "\n".join(lines) + "\n", encoding="utf-8")
    return path


class TestWhatIsShown:
    def test_json_has_the_promised_keys_and_the_measures_of_the_library(self):
        data = run_json("record", ACCEL)
        found = measure(read_record(ACCEL))
        assert (data["file"], data["name"], data["format"], data["channel"]) == (ACCEL, "accel.csv", "text", None)
        assert (data["npts"], data["dt"], data["unit"], data["duration"]) == (1201, 0.01, "g", 12)
        assert (data["pga_g"], data["pgv"], data["pgd"]) == (found.pga_g, found.pgv, found.pgd)
        assert (data["arias_intensity"], data["significant_duration"]) == (found.arias, found.significant_duration)
        assert (data["mean_acceleration"], data["warnings"], data["factor"]) == (found.mean, [], 1)

    def test_the_table_has_every_measure_and_no_row_that_says_nothing(self):
        result = run("record", ACCEL, "--all")
        data = run_json("record", ACCEL)
        said = (
            f"accel.csv: PGA {data['pga_g']:.3g} g, PGV {data['pgv']:.3g} m/s; {data['duration']:g} s at dt = 0.01 s. "
        )
        assert result.stdout.startswith(f"{said}No defects found.\n") and not data["warnings"]
        for key in ("pga_g", "pgv", "pgd", "arias_intensity", "significant_duration", "t_5", "t_95"):
            assert f"{data[key]:.4g}" in result.stdout
        assert all(word in result.stdout for word in ("accel.csv", "text", "1201", "m/s", "5-95 %"))
        assert not any(word in result.stdout for word in ("channel", "scaled", "p dt"))
        assert result.stderr == ""

    def test_several_files_in_a_pipe_are_a_row_each(self, monkeypatch):
        monkeypatch.delenv("COLUMNS", raising=False)
        one, other = (run("record", *files, "--scale", "2", "--all").stdout for files in ([ACCEL], [ACCEL, ACROSS]))
        (first,) = [re.split("  +", line.strip()) for line in other.splitlines() if line.startswith(" accel.csv")]
        lines = [re.split("  +", line.strip()) for line in one.splitlines()[4:] if line.strip(" ─-")]
        assert first == ["accel.csv", *(value for _, value, *_ in lines)]
        assert max(map(len, other.splitlines())) < 200 and "95 % of Arias at" in one

    def test_a_channel_is_named(self, tmp_path):
        rows = "".join(f"{value:8.1f}" for value in (0.0, 100.0, -100.0, 0.0))
        header = [
            "Corrected accelerogram made", *[""] * 8, "Number of points     4    Duration 0.03 sec",
            "Instrument corrected data at 0.010 sec intervals", "", "Component {}  axis",
            "Acceleration:  peak    100.0 mm/s/s at  0.01 sec", "", "",
        ]  # fmt: skip
        numbers = ["0 0 0", "0 0 0", "0 0 0", "0 0 0 4 0 0", *["0"] * 6]
        both = "\n".join(("\n".join([*header, *numbers, rows])).format(name) for name in ("N", "UP"))
        (tmp_path / "two.v2a").write_text(both + "\n", encoding="utf-8")
        assert "choose one with --channel" in run("record", "two.v2a", code=2).stderr
        data = run_json("record", "two.v2a", "--channel", "UP")
        assert (data["channel"], data["name"]) == ("UP", "two.v2a channel UP")
        assert " channel " in run("record", "two.v2a", "--channel", "2").stdout
        run("record", "two.v2a", "--channel", "UP", "--out", ".")
        assert (tmp_path / "two-UP.csv").exists()


class TestDoubts:
    def test_each_is_a_warning_with_its_number_and_in_the_json(self, odd):
        result = run("record", odd, "--json")
        warnings = json.loads(result.stdout)["warnings"]
        assert {each["kind"] for each in warnings} >= {"offset", "start", "final_velocity", "clipped"}
        for each in warnings:
            assert f"warning: odd.csv: {each['text']}" in result.stderr
        assert all(each["kind"] != "p_dt" for each in warnings)
        assert "s. Possible defects: see the warnings." in run("record", odd).stdout.splitlines()[0]
        pga = min(run_json("record", odd)["pga_g"], 0.55)
        both = run("record", ACCEL, odd).stdout.splitlines()[0]
        assert both == f"2 records, PGA {pga:.3g} to 0.55 g. Possible defects of odd.csv: see the warnings."

    def test_an_interval_too_coarse_for_a_structure(self, tmp_path):
        (tmp_path / "small.yaml").write_text("mechanism: block\nwidth: 0.02\nheight: 0.06\n", encoding="utf-8")
        result = run("record", ACCEL, "--structure", "small.yaml")
        assert "p dt = 0.15" in result.stderr and "p dt" in result.stdout
        assert "p dt = 0.15" in run("respond", "small.yaml", "--record", ACCEL).stderr
        data = run_json("record", ACCEL, "--structure", EXAMPLES / "frame.yaml")
        p = run_json("equiv", EXAMPLES / "frame.yaml")["directions"]["negative"]["p"]
        assert data["p_dt"] == pytest.approx(0.01 * p) and data["warnings"] == []

    def test_a_motion_of_zeros_has_dashes_and_nulls(self, tmp_path):
        (tmp_path / "zero.txt").write_text("accel_g\n0\n0\n0\n", encoding="utf-8")
        assert run_json("record", "zero.txt", "--dt", "0.01")["significant_duration"] is None
        assert re.search(r"5-95 % duration +- +s", run("record", "zero.txt", "--dt", "0.01", "--all").stdout)


class TestScaling:
    @pytest.mark.parametrize(("option", "key"), [("--target-pga", "pga_g"), ("--target-pgv", "pgv")])
    def test_a_target_is_reached_and_the_factor_said(self, option, key):
        plain, scaled = run_json("record", ACCEL), run_json("record", ACCEL, option, "0.4")
        assert scaled[key] == pytest.approx(0.4, rel=1e-12)
        assert scaled["factor"] == pytest.approx(0.4 / plain[key])
        assert scaled["arias_intensity"] == pytest.approx(scaled["factor"] ** 2 * plain["arias_intensity"])
        assert f"{scaled['factor']:.6g}" in run("record", ACCEL, option, "0.4").stdout

    def test_an_odd_unit_is_not_hidden_by_a_target(self, tmp_path):
        (tmp_path / "cm.csv").write_text("t,accel_g\n0,0\n0.01,300\n0.02,0\n", encoding="utf-8")
        assert "is the unit really g?" in run("record", "cm.csv", "--target-pga", "0.3").stderr

    @pytest.mark.parametrize("command", [("record", ACCEL), ("respond", "--record", ACCEL)])
    def test_wrong_scaling_is_refused(self, command):
        for two in (("--scale", "1", "--target-pga", "1"), ("--target-pgv", "1", "--target-pga", "1")):
            assert "--scale, --target-pga and --target-pgv cannot be combined" in run(*command, *two, code=2).stderr
        assert "positive" in run(*command, "--target-pgv", "0", code=2).stderr

    def test_nothing_cannot_be_scaled_to_a_peak(self, tmp_path):
        (tmp_path / "zero.txt").write_text("accel_g\n0\n0\n0\n", encoding="utf-8")
        assert "zero throughout" in run("record", "zero.txt", "--dt", "1", "--target-pga", "1", code=2).stderr

    def test_both_polarities_stand_side_by_side(self, tmp_path):
        lines = [json.loads(line) for line in run("record", ACCEL, "--polarity", "both", "--json").stdout.splitlines()]
        assert [line.pop("given") for line in lines] == [{"polarity": "both"}] * 2
        alone = [run_json("record", ACCEL, "--polarity", sign) for sign in ("1", "-1")]
        assert lines == [{key: each[key] for key in each if key != "given"} for each in alone]
        text = " ".join(run("record", ACCEL, "--polarity", "both", "--all").stdout.split())
        assert " accel.csv text " in text and "accel.csv, reversed text" in text and "scaled by" in text
        assert "one polarity" in run("record", ACCEL, "--polarity", "both", "--plot", "r.png", code=2).stderr
        shutil.copy(ACCEL, tmp_path / "a.AT2")
        run("record", "a.AT2", "--polarity", "both", "--out", ".")
        one, other = (read_record(tmp_path / f"{name}.csv").acceleration for name in ("a", "a-reversed"))
        assert (one == -other).all() and one.any()


class TestBadFiles:
    def test_one_of_several_is_reported_and_the_others_shown(self, tmp_path):
        (tmp_path / "bad.csv").write_text("t,accel_g\n0,0\n0.01,x\n", encoding="utf-8")
        result = CliRunner().invoke(main, ["record", "bad.csv", ACCEL, "none.csv", "--json"])
        assert result.exit_code == 5
        assert [json.loads(line)["name"] for line in result.stdout.splitlines()] == ["accel.csv"]
        assert "bad.csv:3" in result.stderr and "none.csv: no such file" in result.stderr
        result = CliRunner().invoke(main, ["record", "bad.csv", ACCEL])
        assert result.exit_code == 5 and "0.55" in result.stdout


class TestCleanFile:
    def test_it_goes_into_this_folder_and_its_path_is_said(self, tmp_path):
        source = tmp_path / "motion.txt"
        source.write_text("accel_g\n0\n0.1\n-0.3\n0\n", encoding="utf-8")
        result = run("record", source, "--dt", "0.01", "--out", ".", "--scale", "2")
        assert f"wrote {(tmp_path / 'motion.csv').resolve()}" in result.stderr
        assert (tmp_path / "motion.csv").read_text(encoding="utf-8").splitlines()[1:4] == [
            "# from: motion.txt", "# done: factor 2", "t [s],a [m/s2]",
        ]  # fmt: skip
        back, want = read_record(tmp_path / "motion.csv"), read_record(source, dt=0.01).scaled(2)
        assert back.dt == 0.01 and (back.acceleration == want.acceleration).all()
        run("record", source, "--dt", "0.01", "--out", ".")  # its own file may be renewed

    @pytest.mark.every(3)
    @settings(deadline=None)  # it writes files
    @given(
        st.lists(st.floats(-1e29, 1e29), min_size=2, max_size=60),
        st.sampled_from([0.01, 0.005, 0.02, 1 / 256, 1 / 3, 0.03]) | st.floats(1e-4, 1),
    )
    @example([0.0] * 4, 0.20222855553486224)  # more digits than are written of the other times
    def test_it_reads_back_number_for_number(self, tmp_path_factory, values, dt):
        path = tmp_path_factory.getbasetemp() / "back.csv"
        with path.open("wb") as stream:
            write_record_csv(stream, GroundMotion("any", dt, np.array(values), unit="m/s2"))
        back = read_record(path)
        assert back.acceleration.tolist() == values
        assert abs(back.dt - dt) <= np.spacing(dt)

    @pytest.mark.parametrize("npts", [2, 10_000, 10_001, 34_717])
    def test_usual_intervals_come_back_too_over_block_borders(self, npts, tmp_path):
        with (tmp_path / "back.csv").open("wb") as stream:
            write_record_csv(stream, GroundMotion("any", 0.005, np.linspace(-1, 1, npts), unit="m/s2"))
        back = read_record(tmp_path / "back.csv")
        assert back.dt == 0.005 and (back.acceleration == np.linspace(-1, 1, npts)).all()

    def test_an_input_is_never_replaced(self, tmp_path):
        (tmp_path / "accel.csv").write_bytes((EXAMPLES / "accel.csv").read_bytes())
        assert "would overwrite an input file" in run("record", "accel.csv", "--out", ".", code=2).stderr
        assert (tmp_path / "accel.csv").read_bytes() == (EXAMPLES / "accel.csv").read_bytes()

    def test_a_file_of_somebody_else_is_never_replaced(self, tmp_path):
        (tmp_path / "accel.csv").write_text("precious\n", encoding="utf-8")
        assert "did not write" in run("record", ACCEL, "--out", ".", code=2).stderr
        assert (tmp_path / "accel.csv").read_text(encoding="utf-8") == "precious\n"

    def test_two_records_of_one_name_are_refused(self, tmp_path):
        (tmp_path / "accel.AT2").write_bytes((EXAMPLES / "accel.csv").read_bytes())
        assert "two records would be written" in run("record", ACCEL, "accel.AT2", "--out", ".", code=2).stderr
        assert [path.name for path in tmp_path.iterdir()] == ["accel.AT2"]


class TestPlot:
    def test_of_one_record_only_and_never_over_it(self, tmp_path):
        assert "one FILE" in run("record", ACCEL, ACROSS, "--plot", "x.png", code=2).stderr
        (tmp_path / "a.png").write_bytes((EXAMPLES / "accel.csv").read_bytes())
        assert "would overwrite an input file" in run("record", "a.png", "--plot", "a.png", code=2).stderr


class TestSpectrum:
    def test_the_file_and_json_are_of_the_scaled_record(self, tmp_path):
        result = run("record", ACCEL, "--scale", 2, "--spectrum", "s.csv", "--json", "--damping", "2%")
        found = json.loads(result.stdout)["spectrum"]
        period, damping = np.array(found["period"]), found["damping"]
        assert (period.size, damping) == (200, 0.02) and (period[0], period[-1]) == pytest.approx((0.02, 10))
        expected = response_spectrum(read_record(ACCEL).scaled(2), period, 0.02)
        np.testing.assert_allclose(found["sd"], expected.sd, rtol=1e-12)
        np.testing.assert_allclose(found["sv"], 2 * np.pi / period * found["sd"], rtol=1e-12)
        np.testing.assert_allclose(found["sa"], (2 * np.pi / period) ** 2 * found["sd"] / 9.80665, rtol=1e-12)
        rows = list(csv.DictReader((tmp_path / "s.csv").read_text(encoding="utf-8").splitlines()))
        assert list(rows[0]) == ["motion", "damping", "period [s]", "pseudo Sa [g]", "pseudo Sv [m/s]", "Sd [m]"]
        for key, name in (("pseudo Sa [g]", "sa"), ("pseudo Sv [m/s]", "sv"), ("Sd [m]", "sd")):
            np.testing.assert_allclose([float(row[key]) for row in rows], found[name], rtol=1e-8)

    def test_several_records_and_periods(self, tmp_path):
        asked = ("--spectrum", "s.csv", "--plot", "s.svg", "--period", "0.1:1s")
        run("record", ACCEL, ACROSS, "--polarity", "both", *asked)
        rows = list(csv.DictReader((tmp_path / "s.csv").read_text(encoding="utf-8").splitlines()))
        names = list(dict.fromkeys(row["motion"] for row in rows))
        assert len(rows) == 200 * len(names) and len(names) == 4 and (tmp_path / "s.svg").exists()
        assert {row["period [s]"] for row in rows[::200]} == {"0.1"}

    @pytest.mark.parametrize("option", [("--damping", "2%"), ("--period", "1:2")])
    def test_options_that_need_it(self, option):
        result = CliRunner().invoke(main, ["record", str(ACCEL), *option])
        assert result.exit_code == 2 and "has no effect without --spectrum" in result.stderr


class TestMeasures:
    def test_they_stand_in_the_table_and_in_json(self):
        asked = ("--measures", "sa(1), cav, PGV/v_imp", "--structure", EXAMPLES / "block.yaml", "--target-pga", "0.3")
        found = json.loads(run("record", ACCEL, *asked, "--json").stdout)["measures"]
        assert list(found) == ["Sa(1.0)", "CAV", "PGV/v_imp"]
        expected = response_spectrum(read_record(ACCEL).scaled(0.3 / 0.55), 1.0).sa[0]
        assert found["Sa(1.0)"] == pytest.approx(expected)
        said = run("record", ACCEL, *asked).stdout
        for name, value in found.items():
            assert re.search(rf"{re.escape(name)} +{value:.4g}", said)

    def test_in_python_one_call_has_the_measures_of_a_structure(self):
        """0.5 g for 0.2 s; the step that overturns a block by energy and momentum, with I_O = 4/3 m R^2."""
        step = rk.GroundMotion("step", 0.2, np.array([1.0, 1.0, 0.0, 0.0]) * 0.5 * 9.80665, unit="m/s2")
        block = rk.Block(width=0.7, height=2.8)
        found = rk.record(step, structure=block, measures=["pga/(g lambda)", "PGV/v_imp"]).measures
        R, cosine = np.hypot(0.35, 1.4), 1.4 / np.hypot(0.35, 1.4)
        v_imp = np.sqrt(8 / 3 * 9.80665 * R * (1 - cosine)) / cosine
        pgv = 0.5 * 9.80665 * (0.2 + 0.2 / 2)  # constant, then falling on a straight line
        assert found == pytest.approx({"PGA/(g lambda)": 0.5 / 0.25, "PGV/v_imp": pgv / v_imp}, rel=1e-9)
        both = rk.record([step, ACCEL], structure=block, measures="PGV/v_imp")
        assert [list(each.measures) for each in both.values()] == [["PGV/v_imp"]] * 2
        assert rk.record(step).measures == {}

    def test_all_without_a_structure_are_those_of_the_motion(self):
        found = json.loads(run("record", ACCEL, "--measures", "all", "--json").stdout)["measures"]
        assert {"Tm", "Sa_avg(0.2:2.0)", "D5-75"} <= set(found) and "Du" not in found
        with_one = run("record", ACCEL, "--measures", "all", "--structure", EXAMPLES / "frame.yaml", "--json")
        assert {*found, "Du", "PGA/(g lambda)"} <= set(json.loads(with_one.stdout)["measures"])

    def test_what_is_wrong_is_said_before_anything_is_read(self):
        for asked, said in (("Saa(1)", "did you mean Sa?"), ("Du", "give a --structure")):
            result = CliRunner().invoke(main, ["record", str(ACCEL), "--measures", asked])
            assert result.exit_code == 2 and said in result.stderr and not result.stdout


def test_a_call_in_python_takes_several_records(tmp_path):
    class Patient(Watcher):
        def leave_out(self, error):
            left_out.append(str(error))

    shutil.copy(ACCEL, tmp_path / "accel.csv")
    across, left_out = EXAMPLES / "accel_transverse.csv", []
    asked = [ACCEL, "gone.csv", across, tmp_path / "accel.csv"]
    with pytest.raises(rk.InputError, match=r"gone\.csv: no such file"):
        rk.record(asked)
    answer = rk.record(asked, spectrum=True, watch=Patient())
    first, second, third = answer
    assert (first, second) == ("accel.csv", "accel_transverse.csv") and third == f"accel.csv ({tmp_path / 'accel.csv'})"
    assert len(left_out) == 1 and "gone.csv" in left_out[0]
    alone = rk.record(across, spectrum=True)
    assert answer[second].to_dict() | {"given": alone.to_dict()["given"]} == alone.to_dict()
    assert set(answer.tables["spectrum"]()["motion"]) == set(answer)
    with pytest.raises(rk.InputError, match="no common plot"):
        rk.record([ACCEL, across]).plot()
    rk.record([ACCEL, across], out=tmp_path / "clean")
    for name in (first, second):
        clean = read_record(tmp_path / "clean" / name).acceleration
        np.testing.assert_allclose(clean, answer[name].motions[0].acceleration, atol=1e-6)


def test_a_file_that_is_given_twice_is_shown_once_and_said():
    asked = run("record", ACCEL, ACCEL, "--json")
    assert len(asked.stdout.splitlines()) == 1
    assert "a motion that is given twice is used once: 1 left out" in asked.stderr

"""The commands as a user runs them: results on standard output, everything else on standard error."""

import json
import re
import subprocess
import sys
import warnings
from functools import cache
from itertools import chain
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from rocking_cli.cli.main import main
from rocking_cli.core.registry import Registry
from rocking_cli.plugins.rooms import HEADINGS, commands
from rocking_cli.studies.neighbours import Neighbourhood
from rocking_cli.views.neighbours import deviations
from tests.conftest import EXAMPLES, NEEDS_RECORDS, RECORDS, rows_of
from tests.following import conditions

ACCEL = str(EXAMPLES / "accel.csv")
FRAME = str(EXAMPLES / "frame.yaml")
STACK = """\
mechanism: assembly
name: stack
friction: 5
blocks:
  low: {polygon: [[0, 0], [1, 0], [1, 1], [0, 1]]}
  up: {polygon: [[0.4, 1], [1, 1], [1, 3], [0.4, 3]]}
ground:
  floor: {polygon: [[-3, -1], [6, -1], [6, 0], [-3, 0]]}
"""
RESPOND = "respond", FRAME, "--record", ACCEL, "--neighbours", 0
DRAWN = "count", "amplitude", "restitution", "slenderness"


def run(*arguments, code=0):
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # what is doubtful goes to the terminal
        result = CliRunner().invoke(main, [str(argument) for argument in arguments])
    assert result.exit_code == code, result.output
    assert "Traceback" not in result.stderr
    assert result.stdout == "" or code in (0, 1, 5)  # 1: a file could not be written; 5: a part of the work is done
    return result


def some(*arguments):
    """Of a command that does its work in part."""
    return run(*arguments, code=5)


def run_json(*arguments):
    result = run(*arguments, "--json")
    (line,) = result.stdout.splitlines()
    return json.loads(line)


@cache
def of_frame(*more):
    """The JSON of the frame under the example, for several tests."""
    return run_json(*RESPOND, *more)


def shares(near):
    """What neighbours are said to be, as a sentence has it."""
    number = round(near["count"] * near["overturned"])
    share = f"{number} ({100 * near['overturned']:.3g} %) overturn{'s' * (number == 1)} the structure"
    return {0: "none overturns the structure", 1: "all overturn the structure"}.get(near["overturned"], share)


class TestNeighbours:
    def test_they_are_what_the_study_finds(self):
        from rocking_cli.ask.read import read_record
        from rocking_cli.core.structure_file import load_structure
        from rocking_cli.studies.neighbours import neighbours

        words = ("respond", FRAME, "--record", ACCEL, "--scale", "1.1", "--polarity", "-1", "--neighbours", 50)
        deviations = ("--amplitude-deviation", 0.05, "--restitution-deviation", 0.01, "--slenderness-deviation", "7%")
        found = run_json(*words, *deviations)["neighbours"]
        around = Neighbourhood(50, amplitude=0.05, restitution=0.01, slenderness=0.07)
        alone = neighbours(conditions(load_structure(FRAME), around), read_record(ACCEL).scaled(-1.1))
        assert [found[name] for name in DRAWN] == [50, 0.05, 0.01, 0.07]
        assert [found[name] for name in ("overturned", "unknown", "sensitive")] == [
            alone.overturned, alone.unknown, alone.sensitive,
        ]  # fmt: skip
        assert list(found["peak_ratio"].values()) == [None if np.isinf(each) else each for each in alone.peak_ratio]
        assert list(found["peak_ratio"]) == ["16", "50", "84"]

    def test_each_polarity_has_its_own_and_words_say_the_same(self):
        words = ("respond", FRAME, "--record", ACCEL, "--target-pga", "0.9", "--polarity", "both", "--neighbours", 30)
        found, text = run_json(*words), run(*words).stdout
        said = [each["neighbours"] for each in found["polarities"].values()]
        for near in said:
            assert [near[name] for name in DRAWN] == [30, 0.04, 0.05, 0.1]
            around = Neighbourhood(30, amplitude=0.04, restitution=0.05, slenderness=0.1)
            assert f"Of 30 neighbouring motions, {shares(near)}" in text and f"({deviations(around)})." in text

    def test_none_if_none_are_requested(self):
        assert of_frame()["neighbours"] is None and "neighbouring" not in run(*RESPOND).stdout

    def test_of_linear_models_alone_they_follow_the_first(self):
        words = ("respond", FRAME, "--record", ACCEL, "--scale", "1.2", "--neighbours", 9)
        linear = run_json(*words, "--model", "linear2,linear1")["neighbours"]["peak_ratio"]["50"]
        assert linear == run_json(*words, "--model", "linear2")["neighbours"]["peak_ratio"]["50"]
        assert linear != run_json(*words)["neighbours"]["peak_ratio"]["50"]

    @pytest.mark.parametrize(("of", "wrong"), [("amplitude", "-0.1"), ("slenderness", "1"), ("restitution", "nan")])
    def test_deviations_out_of_range_are_refused(self, of, wrong):
        option = f"--{of}-deviation"
        assert option in run("respond", FRAME, "--record", ACCEL, option, wrong, code=2).stderr


class TestHelp:
    def test_the_group_lists_every_command_and_an_example(self):
        before, *sections = re.split(rf"(?m)^({'|'.join(HEADINGS)}):$", run("--help").stdout)
        assert "rocking respond block.yaml" in before and sections[::2] == [*HEADINGS]
        under = [re.findall(r"(?m)^  (\w+) +[A-Z].*\.$", text) for text in sections[1::2]]
        assert [*chain(*under)] == [*commands()] and "margin" in under[HEADINGS.index("Decisions")] and all(under)

    @pytest.mark.parametrize("name", commands())
    def test_every_command_has_an_example_and_json(self, name):
        text = run(name, "--help").stdout
        assert "Example:" in text and f"rocking {name}" in text and "--json" in text

    def test_a_mistyped_command_gets_a_guess(self):
        assert "did you mean respond?" in run("repsond", code=2).stderr

    @pytest.mark.parametrize("words", [("draw",), ("equiv",), ("respond", "--record"), ("results",)])
    def test_a_name_that_no_file_can_have_is_wrong_input(self, words):
        said = run(*words, "9" * 3000 + ".yaml", code=2).stderr
        assert "long" in said and len(said) < 300

    def test_the_version_is_that_of_the_distribution(self):
        from importlib.metadata import version

        assert version("rocking-cli") in run("--version").stdout


class TestMechanisms:
    @pytest.mark.every(3)
    @pytest.mark.parametrize("name", list(Registry()))
    def test_one_shows_every_field(self, name):
        data = run_json("mechanisms", name)
        fields = {info.alias or key for key, info in Registry()[name].model_fields.items()}
        assert {row["field"] for row in data["fields"]} == fields
        assert data["source"] and data["package"]
        shown = "".join(run("mechanisms", name).stdout.split())
        assert all(field in shown for field in fields)

    @pytest.mark.every(3)
    @pytest.mark.parametrize("name", list(Registry()))
    def test_new_prints_a_file_that_works(self, name, tmp_path):
        file = tmp_path / "new.yaml"
        file.write_text(run("new", name).stdout, encoding="utf-8")
        assert run_json("equiv", file)["mechanism"] == name
        assert run_json("new", name)["yaml"] == file.read_text(encoding="utf-8")

    @pytest.mark.parametrize("name", ["linkage", "assembly"])
    def test_what_is_commented_out_works_too(self, name, tmp_path):
        text = run("new", name).stdout
        for field in ("cracks", "lead", "gap"):
            commented = re.search(rf"^# {field}:.*(\n#   .*)*", text, re.M)
            if commented:
                text = text.replace(commented[0], commented[0].removeprefix("# ").replace("\n# ", "\n"))
        file = tmp_path / "new.yaml"
        file.write_text(text, encoding="utf-8")
        assert run_json("equiv", file)["mechanism"] == name


class TestEquiv:
    def test_several_files_give_one_object_a_line(self):
        names = ["block", "wall", "rigid_body"]
        lines = run("equiv", *(EXAMPLES / f"{name}.yaml" for name in names), "--json").stdout.splitlines()
        assert [json.loads(line)["mechanism"] for line in lines] == names

    def test_a_symmetric_structure_has_one_column_and_another_two(self):
        assert "positive" not in run("equiv", EXAMPLES / "block.yaml").stdout
        text = run("equiv", FRAME).stdout
        assert "positive" in text and "negative" in text
        everything = run("equiv", FRAME, "--all").stdout
        assert [re.findall("[IGB]_eq", each) for each in (text, everything)] == [[], ["I_eq", "G_eq", "B_eq"]]

    @pytest.mark.parametrize("name", ["block", "frame", "arch"])
    def test_it_begins_with_what_the_parameters_mean(self, name):
        sides = run_json("equiv", EXAMPLES / f"{name}.yaml")["directions"].values()
        lines = run("equiv", EXAMPLES / f"{name}.yaml").stdout.splitlines()[:3]
        for side in sides:
            means = f"plift at {side['lambda']:.4g} g, critical rotation {np.degrees(side['phi_cr']):.4g} deg, p = "
            assert any(f"{means}{side['p']:.4g} rad/s. " in line for line in lines)

    def test_another_gravity_is_told_apart_from_the_unit_of_records(self, tmp_path):
        (tmp_path / "moon.yaml").write_text("mechanism: block\nwidth: 1\nheight: 4\ngravity: 1.62\n", encoding="utf-8")
        assert "the structure's own gravity of 1.62 m/s2" in run("equiv", "moon.yaml").stderr

    def test_the_preferred_kappa_follows_effective_slenderness(self):
        assert "either kappa is adequate" in run("equiv", EXAMPLES / "wall.yaml").stdout
        assert "prefer kappa2" in run("equiv", EXAMPLES / "block.yaml").stdout
        assert run_json("equiv", EXAMPLES / "block.yaml")["directions"]["positive"]["prefer"] == "kappa2"

    def test_bad_files_are_reported_with_all_their_problems_and_the_good_ones_shown(self, tmp_path):
        one, two = tmp_path / "one.yaml", tmp_path / "two.yaml"
        one.write_text("mechanism: block\nwidth: 1\n", encoding="utf-8")
        two.write_text("mechanism: block\nwidth: -1\nheight: 2\n", encoding="utf-8")
        for text in (run("equiv", one, two, code=2).stderr, (mixed := some("equiv", FRAME, one, two)).stderr):
            assert "one.yaml:1:1: height is missing" in text and "two.yaml:2:8: width must be more than 0" in text
        assert mixed.stdout == run("equiv", FRAME).stdout
        assert [json.loads(line)["name"] for line in some("equiv", one, FRAME, "--json").stdout.splitlines()] == [
            "valley bridge"
        ]

    def test_a_stocky_block_is_shown_with_a_warning(self, tmp_path):
        (tmp_path / "slab.yaml").write_text("mechanism: block\nwidth: 3\nheight: 1\n", encoding="utf-8")
        said = [
            "It is stocky: its kinematics give eta = -0.35, below 0.7",
            "The kinematics give eta = -0.35 at impacts: the mass inner product",
        ]
        site = EXAMPLES / "verify" / "site.yaml"
        for asked in (("equiv", "slab.yaml"), ("verify", "slab.yaml", "--site", site)):
            shown = " ".join(run(*asked).stdout.split())
            assert f"Caution: {said[0]}" in shown and said[1] in shown
        caution = run_json("equiv", "slab.yaml")["caution"]
        assert caution.startswith(said[0]) and said[1] in caution

    def test_an_eta_above_one_is_said_with_the_energy_that_is_kept(self, tmp_path):
        """A stack that turns as a whole in one direction, and with its upper block only in the other."""
        (tmp_path / "stack.yaml").write_text(STACK, encoding="utf-8")
        respond = "respond", "stack.yaml", "--pulse", "sine:0.5g:0.5s", "--engine", "exact", "--neighbours", 0
        etas = list(run_json(*respond)["restitution"].values())[:2]
        # Of two projections of one velocity on the other mechanism, there and back, both keep the same energy.
        kept = 100 * etas[0] * etas[1]
        said = f"The eta of {etas[0]:.4g} at impacts that end motion in the positive direction compares the rates"
        for asked in (("equiv", "stack.yaml"), respond):
            text = " ".join(run(*asked).stdout.split())
            assert etas[0] > 1 > etas[1] and f"Caution: {said}" in text and "less, about 0.95" not in text
            assert f"keeps {kept:.3g} % of the kinetic energy" in text and text.count("compares the rates") == 1

    def test_without_a_file_it_takes_the_folder_s_or_the_default(self, tmp_path):
        assert "default block" in run("equiv").stderr
        (tmp_path / "rocking.yaml").write_text("mechanism: wall\nthickness: 0.3\nheight: 3\n", encoding="utf-8")
        result = run("equiv", "--json")
        assert "rocking.yaml" in result.stderr and json.loads(result.stdout)["mechanism"] == "wall"


class TestRespond:
    def test_what_was_read_is_said(self):
        text = run(*RESPOND).stderr
        assert all(words in text for words in ("accel.csv", "1201 points", "dt = 0.01 s", "in g", "PGA = 0.55 g"))

    def test_models_can_be_chosen(self):
        data = run_json(*RESPOND, "--model", "linear2, nonlinear")
        assert list(data["responses"]) == ["linear2", "nonlinear"]
        assert (
            "must be one of nonlinear, linear1, linear2, got 'quadratic'"
            in run("respond", "--record", ACCEL, "--model", "quadratic", code=2).stderr
        )

    def test_overturning_is_a_result_with_null_peaks(self):
        words = ("respond", "--record", ACCEL, "--scale", "4", "--neighbours", 0)
        response = run_json(*words)["responses"]["nonlinear"]
        assert response["overturned"] is True and response["peak_ratio"] is None
        assert response["overturning_time"] > response["uplift_time"] > 0
        assert [response["peak_positive"], response["peak_negative"]].count(None) == 1
        assert "overturns" in run(*words).stdout

    def test_polarity_mirrors_the_response_of_a_symmetric_structure(self):
        words = ("respond", "--record", ACCEL, "--neighbours", 0)
        one, other = (run_json(*words, "--polarity", each)["responses"]["nonlinear"] for each in ("1", "-1"))
        assert (one["peak_positive"], one["peak_negative"]) == (other["peak_negative"], other["peak_positive"])
        assert one["peak_positive"] > 0

    def test_release_without_a_record(self, tmp_path):
        (tmp_path / "stack.yaml").write_text(STACK, encoding="utf-8")
        asked = ("respond", "stack.yaml", "--release", "-0.5", "--engine", "exact")
        data = run_json(*asked, "--opening", 1)
        assert data["record"] is None and data["release"] == -0.5
        response = data["responses"]["nonlinear"]
        assert (
            response["peak_ratio"] == pytest.approx(0.5) and response["peak_negative"] > response["peak_positive"] > 0
        )
        assert response["uplift_time"] is None and response["impacts"] > 5 and response["outcome"] == "at_rest"
        response = run_json(*asked)["responses"]["nonlinear"]  # another joint opens at the first impact
        assert (response["outcome"], response["overturned"], response["impacts"]) == ("unknown", None, 1)
        assert response["peak_ratio"] == response["peak_lower_bound"] == pytest.approx(0.5)

    def test_the_history_file_agrees_with_the_peaks(self):
        data = run_json(*RESPOND, "--scale", "2", "--out", "history.csv")
        rows = rows_of("history.csv")
        assert list(rows[0])[:5] == [
            "t [s]", "a_g [g]", "nonlinear phi [rad]", "nonlinear phi_dot [rad/s]", "nonlinear phi_ratio",
        ]  # fmt: skip
        ground = np.array([float(row["a_g [g]"]) for row in rows])
        assert np.abs(ground).max() == pytest.approx(2 * 0.55)
        for model, response in data["responses"].items():
            phi = np.array([float(row[f"{model} phi [rad]"]) for row in rows])
            # Peaks lie between samples: a sample may miss one by the curvature over half an interval.
            assert phi.max() == pytest.approx(response["peak_positive"], rel=1e-3)
            assert phi.max() <= response["peak_positive"]
            assert -phi.min() == pytest.approx(response["peak_negative"], rel=1e-3)

    def test_a_parquet_file_has_the_same_columns_and_numbers(self, tmp_path):
        parquet = pytest.importorskip("pyarrow.parquet", reason="pyarrow, of the extra parquet, is not installed")
        options = ("respond", "--record", ACCEL, "--scale", "4", "--model", "nonlinear,linear2", "--neighbours", 0)
        run(*options, "--out", "history.csv")
        run(*options, "--out", "history.PARQUET")
        table = parquet.read_table("history.PARQUET")
        rows = rows_of(tmp_path / "history.csv")
        assert table.column_names == list(rows[0]) and table.num_rows == len(rows)
        for name in table.column_names:
            texts = ["" if value is None else f"{value:.9g}" for value in table[name].to_pylist()]
            assert texts == [row[name] for row in rows]
        assert table["nonlinear phi [rad]"].null_count > 0  # it overturns

    def test_without_pyarrow_the_way_to_it_is_said_before_any_work(self, tmp_path, monkeypatch):
        monkeypatch.setitem(sys.modules, "pyarrow", None)
        text = run("respond", FRAME, "--record", ACCEL, "--out", "history.parquet", code=2).stderr
        assert "pip install 'rocking-cli[parquet]'" in text and "record:" not in text
        assert list(tmp_path.iterdir()) == []

    @pytest.mark.every(3)
    @pytest.mark.parametrize("suffix", ["png", "svg", "pdf"])
    def test_plots_are_written_by_suffix(self, suffix, tmp_path):
        run(*RESPOND, "--model", "nonlinear", "--plot", f"plot.{suffix}")
        start = (tmp_path / f"plot.{suffix}").read_bytes()[:200]
        assert {"png": b"\x89PNG", "svg": b"<svg", "pdf": b"%PDF"}[suffix] in start or b"<?xml" in start

    @pytest.mark.parametrize(
        ("option", "value", "words"),
        [
            ("--plot", "plot.gif", "does not end in .png or .svg or .pdf"),
            ("--out", "history.txt", "does not end in .csv or .parquet"),
            ("--scale", "nan", "is not a number"),
            ("--release", "1.5", "between 0 and 1"),
            ("--tail", "-1", "is not positive"),
            ("--dt", "0", "positive"),
            ("--units", "km/s2", "gal"),
        ],
    )
    def test_wrong_options_are_refused_and_leave_no_file(self, option, value, words, tmp_path):
        assert words in run("respond", FRAME, "--record", ACCEL, option, value, code=2).stderr
        assert list(tmp_path.iterdir()) == []

    @pytest.mark.parametrize(
        ("command", "suffix"),
        [
            (("respond", "--release", "0.5", "--out"), "csv"),
            (("equivalent_pulses", FRAME, "--ag", "1g", "--period", "1", "--out"), "csv"),
            (("draw", "--plot"), "png"),
            (("report", "--out"), "html"),
            (("verify", "--site", EXAMPLES / "verify" / "site.yaml", "--sheet"), "html"),
        ],
    )
    def test_an_output_never_replaces_an_input(self, command, suffix, tmp_path):
        structure, text = tmp_path / f"block.{suffix}", (EXAMPLES / "block.yaml").read_bytes()
        structure.write_bytes(text)
        said = run(command[0], structure, *command[1:], structure, code=2).stderr
        assert "would overwrite an input file" in said and structure.read_bytes() == text
        record = tmp_path / "record.csv"
        record.write_bytes(Path(ACCEL).read_bytes())
        if command[0] == "respond":
            assert "would overwrite" in run(command[0], "--record", record, "--out", record, code=2).stderr

    def test_options_of_a_record_need_one(self):
        for option in (
            ("--scale", "2"), ("--target-pga", "1"), ("--target-pgv", "1"), ("--polarity", "both"), ("--dt", "0.1"),
            ("--units", "g"),
        ):  # fmt: skip
            assert "give --record" in run("respond", "--release", "0.5", *option, code=2).stderr

    def test_an_impossible_dt_is_refused_before_memory_runs_out(self, tmp_path):
        (tmp_path / "one.txt").write_text("accel_g\n0\n1\n0\n", encoding="utf-8")
        assert "is dt in seconds?" in run("respond", "--record", "one.txt", "--dt", "1e-9", code=2).stderr

    def test_a_wrong_record_leaves_no_file(self, tmp_path):
        (tmp_path / "bad.csv").write_text("time_s,accel_g\n0,0\n0.01,nan\n0.02,0\n", encoding="utf-8")
        text = run("respond", FRAME, "--record", "bad.csv", "--out", "history.csv", "--plot", "plot.png", code=2).stderr
        assert "bad.csv:3" in text
        assert [path.name for path in tmp_path.iterdir()] == ["bad.csv"]

    @NEEDS_RECORDS
    def test_the_rinaldi_record_on_the_asymmetric_frame_nonlinear_and_linear(self):
        """As the paper's Fig. 14: the linear models follow the nonlinear one through the pulse."""
        data = run_json("respond", FRAME, "--record", RECORDS / "Rinaldi228.AT2", "--scale", "0.5")
        assert (data["record"]["npts"], data["record"]["pga_g"]) == (1991, pytest.approx(0.87406, abs=1e-5))
        peaks = [response["peak_ratio"] for response in data["responses"].values()]
        assert 0.1 < peaks[0] < 1
        assert peaks[1:] == pytest.approx([peaks[0]] * 2, rel=0.1)


class TestBothPolarities:
    def test_each_is_what_it_is_alone_and_the_larger_governs(self):
        both = of_frame("--polarity", "both")
        assert list(both) == [
            "structure", "record", "release", "restitution", "conclusion", "polarities", "governs", "notes", "given",
        ]  # fmt: skip
        assert both["record"]["polarity"] == "both"
        peaks = {}
        for polarity in ("1", "-1"):
            alone = of_frame("--polarity", polarity)
            assert both["polarities"][polarity]["responses"] == alone["responses"]
            peaks[int(polarity)] = alone["responses"]["nonlinear"]["peak_ratio"]
        assert both["governs"] == max(peaks, key=peaks.get)
        text = run(*RESPOND, "--polarity", "both").stdout
        assert "polarity 1" in text and "polarity -1" in text
        assert f"Polarity {both['governs']} governs: with the motion " in text.replace("\n", " ")

    def test_neither_governs_a_symmetric_structure(self):
        words = ("respond", "--record", ACCEL, "--polarity", "both", "--neighbours", 0)
        assert run_json(*words)["governs"] is None and "Neither polarity governs" in run(*words).stdout

    def test_the_file_has_columns_of_both(self, tmp_path):
        rows = {}
        for name, polarity in (("one", "1"), ("other", "-1"), ("both", "both")):
            run(*RESPOND, "--model", "linear1", "--polarity", polarity, "--out", f"{name}.csv")
            rows[name] = rows_of(tmp_path / f"{name}.csv")
        for name, column in (("one", "linear1 phi [rad]"), ("other", "reversed linear1 phi [rad]")):
            alone = [row["linear1 phi [rad]"] for row in rows[name]]
            assert [row[column] for row in rows["both"]][: len(alone)] == alone
        ground = "a_g [g]"
        assert [row[ground] for row in rows["one"]] == [row[ground] for row in rows["both"]][: len(rows["one"])]


class TestImpacts:
    def test_json_lists_them_with_the_rates_of_the_restitution(self):
        response = of_frame("--impacts")["responses"]["nonlinear"]
        directions = run_json("equiv", FRAME)["directions"]
        found = response["impact_list"]
        assert len(found) == response["impacts_all"] > response["impacts"] > 12
        fastest = max(each["rate_before"] for each in found)
        assert sum(each["rate_before"] >= 0.02 * fastest for each in found) == response["impacts"]
        assert [each["time"] for each in found] == sorted(each["time"] for each in found)
        for each in found:
            assert list(each) == ["time", "direction", "rate_before", "rate_after"]
            assert each["rate_after"] == pytest.approx(directions[each["direction"]]["eta"] * each["rate_before"])
            assert each["rate_before"] > each["rate_after"] > 0
        assert {each["direction"] for each in found} == {"positive", "negative"}
        assert "impact_list" not in of_frame()["responses"]["nonlinear"]

    def test_the_rates_are_those_of_the_history(self, tmp_path):
        """Of a release without a record: before and after the first impact, the samples tend to its rates."""
        options = ("respond", "--release", "0.5", "--model", "nonlinear", "--impacts", "--out", "history.csv")
        first = run_json(*options)["responses"]["nonlinear"]["impact_list"][0]
        rows = rows_of(tmp_path / "history.csv")
        time = np.array([float(row["t [s]"]) for row in rows])
        rate = np.array([float(row["nonlinear phi_dot [rad/s]"] or "nan") for row in rows])
        k = int(np.searchsorted(time, first["time"]))
        assert first["direction"] == "positive"
        assert -rate[k - 1] == pytest.approx(first["rate_before"], rel=0.05)
        assert -rate[k] == pytest.approx(first["rate_after"], rel=0.05)

    def test_the_table_shows_the_first_and_how_many_follow(self):
        text = run(*RESPOND, "--impacts", "--model", "nonlinear").stdout
        response = of_frame("--impacts")["responses"]["nonlinear"]
        found, fastest = response["impact_list"], max(each["rate_before"] for each in response["impact_list"])
        for each in [each for each in found if each["rate_before"] >= 0.02 * fastest][:12]:
            assert f"{each['time']:.4f}" in text and f"{each['rate_after']:.4g}" in text
        chatter = response["impacts_all"] - response["impacts"]
        said = f"{response['impacts'] - 12} more impacts follow and {chatter} weaker than 2 % of the strongest are left"
        assert re.search(rf"^ impacts +{response['impacts']} *$", text, re.MULTILINE) and said in " ".join(text.split())


MOST_MODULES = 150  # of the package that a response imports


class TestStart:
    def test_a_command_imports_what_it_uses(self):
        """One after the other in one process: each may import more than those before."""
        heavy = ["numba", "scipy", "matplotlib", "rich.console", "multiprocessing", "rocking_cli.plotting"]
        asked = [
            (["--help"], [*heavy, "numpy", "pydantic", "rich", "yaml"]),
            (["pulse", "--a", "2", "--omega", "3"], [*heavy, "numpy"]),
            (["equiv", str(EXAMPLES / "arch.yaml")], heavy),
            (["respond", FRAME, "--record", ACCEL], heavy),
        ]
        code = (
            "import sys, rocking_cli, rocking_cli.cli.main as m\n"
            f"for words, heavy in {asked!r}:\n"
            "    m.main(words, standalone_mode=False)\n"
            "    assert not {*heavy} & {*sys.modules}, (words, {*heavy} & {*sys.modules})\n"
        )
        subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)

    def test_a_response_leaves_alone_what_other_questions_use(self):
        """Nor does it read the entry points of all packages twice, or whose package a plugin is."""
        package = "rocking_cli."
        others = [
            "numpy.ma", "scipy", "html", *(package + each for each in (
                "verification", "studies.picture", "studies.engines.free_blocks", "processing.oscillator",
                "excitation.pulse_fit", "io.spreadsheet", "questions.respond.azimuths",
            )),
        ]  # fmt: skip
        code = (
            "import sys; from importlib import metadata; read, every = [], metadata.entry_points\n"
            "metadata.entry_points = lambda **of: read.append(of) or every(**of)\n"
            "import rocking_cli.cli.main as m\n"
            f"m.main(['respond', {str(EXAMPLES / 'block.yaml')!r}, '--record', {ACCEL!r}], standalone_mode=False)\n"
            "from rocking_cli.plugins.registry import package_of\n"
            f"print([each for each in {others!r} if each in sys.modules], read, package_of.cache_info().currsize,"
            " sum(each.startswith('rocking_cli') for each in sys.modules), file=sys.stderr)"
        )
        result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        *found, count = result.stderr.splitlines()[-1].rsplit(" ", 1)
        assert found == ["[] [{}] 0"] and 100 < int(count) <= MOST_MODULES

    def test_every_public_name_can_be_imported(self):
        import rocking_cli

        assert all(getattr(rocking_cli, name) is not None for name in rocking_cli.__all__)
        with pytest.raises(AttributeError, match="no attribute 'nothing'"):
            rocking_cli.nothing  # noqa: B018


@pytest.mark.parametrize("command", ["respond", "margin"])
def test_where_a_mechanism_is_not_on_the_safe_side_the_verdict_says_so_too(command):
    from rocking_cli.core.structure_file import load_structure

    wall = EXAMPLES / "wall.yaml"
    said = " ".join(run(command, wall, "--pulse", "sine:0.4g:0.8s", "--neighbours", 2).stdout.split())
    assert f"Caution: {load_structure(wall).caution}" in said
    block = EXAMPLES / "block.yaml"
    assert "Caution" not in run(command, block, "--pulse", "sine:0.4g:0.8s", "--neighbours", 2).stdout


@pytest.mark.parametrize(
    "error", [MemoryError(), ValueError("Error: engine error: Could not allocate memory"), ValueError("odd")]
)
def test_without_memory_a_command_ends_in_order_whatever_the_library_calls_it(error, monkeypatch):
    def fails(*_, **__):
        raise error

    monkeypatch.setattr("rocking_cli.questions.equiv.verb.equiv.ask", fails)
    ended = CliRunner().invoke(main, ["equiv", str(EXAMPLES / "block.yaml")])
    if str(error) == "odd":
        assert ended.exception is error
    else:
        assert ended.exit_code == 1 and "error: not enough memory on this machine" in ended.stderr

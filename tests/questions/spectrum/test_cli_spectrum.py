"""`rocking spectrum` as a user runs it."""

import json
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.ask.read import read_record
from rocking_cli.core.structure_file import load_structure
from rocking_cli.questions.spectrum import study
from tests.cli.test_cli import run as command
from tests.cli.test_cli import run_json as command_json
from tests.conftest import EXAMPLES, NEEDS_RECORDS, RECORDS, rows_of
from tests.following import respond

ACCEL, BLOCK, FRAME = (str(EXAMPLES / name) for name in ("accel.csv", "block.yaml", "frame.yaml"))
QUICK = ("--sizes", "1:6", "--count", "5")
run, run_json = partial(command, "spectrum"), partial(command_json, "spectrum")


@pytest.fixture
def records(tmp_path):
    """Three records of different strength."""
    motion = read_record(ACCEL)
    for k, factor in enumerate((0.3, 0.8, 1.5)):
        rows = (f"{motion.dt * i!r},{a!r}" for i, a in enumerate((factor * motion.acceleration).tolist()))
        (tmp_path / f"r{k}.csv").write_text("t,a [m/s2]\n" + "\n".join(rows), encoding="utf-8")
    return "r?.csv"


class TestNumbers:
    def test_the_structure_given_is_that_of_respond(self):
        data = run_json(FRAME, "--record", ACCEL, "--target-pga", "0.3", *QUICK)
        (found,) = data["spectra"]
        place = found["given"]
        motion = read_record(ACCEL).scaled(data["motions"][0]["scale"])
        assert found["scale"][place] == 1.0 and found["size"][place] == pytest.approx(2 * np.pi / found["p"])
        alone = respond(load_structure(FRAME), motion, models=("nonlinear",))["nonlinear"]
        assert found["every_peak_ratio"][0][place] == alone.peak_ratio
        assert found["peaks"][data["fractiles"].index(0.5)] == found["every_peak_ratio"][0]
        assert f"{alone.peak_ratio:.3g} of phi_cr" in found["verdict"]

    def test_csv_and_json_agree_and_overturning_is_inf_and_null(self, records, tmp_path):
        data = run_json(BLOCK, "--slenderness", "0.15", "--record", records, *QUICK, "--out", "s.csv")
        rows = rows_of(tmp_path / "s.csv")
        own, blocks = data["spectra"]
        assert [row["structure"] for row in rows] == ["pedestal"] * 18 + ["alpha = 0.15"] * 15
        assert {row["R [m]"] for row in rows[:18]} == {""} == {row["scale"] for row in rows[18:]}
        assert [row["motion"] for row in rows[:18:6]] == ["r0.csv", "r1.csv", "r2.csv"]
        for place, row in enumerate(rows[:18]):
            m, k = divmod(place, 6)
            assert float(row["size [s]"]) == pytest.approx(own["size"][k])
            peak, fell, written = own["every_peak_ratio"][m][k], own["every_overturned"][m][k], float(row["peak_ratio"])
            assert (peak is None) == fell == np.isinf(written) == (row["overturned"] == "1")
            assert fell or written == pytest.approx(peak)
        asked = {"slenderness": [0.15], "sizes": (1.0, 6.0), "count": 5}
        frame = rk.spectrum(BLOCK, records, **asked).frames["fractiles"].query("structure == 'pedestal'")
        for q, peaks in zip(data["fractiles"][:2], own["peaks"], strict=False):
            rows = frame[frame.fractile == q]
            assert rows.overturned.tolist() == [each / 3 for each in own["overturned"]]
            for found, want in zip(rows.peak_ratio, peaks, strict=True):
                assert found == pytest.approx(want) if want is not None else not np.isfinite(found)
        assert own["overturned"] == np.sum(own["every_overturned"], axis=0).tolist()
        assert {0, 1, 2} == set(own["overturned"])
        assert (blocks["slenderness"], blocks["given"], blocks["scale"], own["R"]) == (0.15, None, None, None)

    def test_the_number_of_processors_changes_nothing(self, records):
        asked = (BLOCK, "--record", records, *QUICK)
        assert run_json(*asked, "--jobs", "1")["spectra"] == run_json(*asked)["spectra"]

    def test_without_anything_it_takes_the_usual_structure_around_its_size(self):
        result = run("--pulse", "sine:0.4g:0.8s", "--pulse", "ricker:0.3g:1s", "--json")
        assert "structure: the default block" in result.stderr
        (found,) = json.loads(result.stdout)["spectra"]
        assert len(found["size"]) == 61
        assert found["scale"][0] == pytest.approx(0.1) and found["scale"][-1] == pytest.approx(10)
        (found,) = run_json("--slenderness", "0.2", "--pulse", "sine:0.4g:0.8s")["spectra"]
        assert (found["size"][0], found["size"][-1]) == (pytest.approx(1), pytest.approx(10))


class TestTables:
    def test_one_motion(self):
        text = run(BLOCK, "--record", ACCEL, *QUICK).stdout
        assert "as given" in text and "[s]" in text and "phi/phi_cr" in text and "median" not in text
        assert "pedestal as given, 2 pi/p = 2.78 s: it rocks to 0.481 of phi_cr." in text

    def test_several_motions(self, records, monkeypatch):
        monkeypatch.setenv("COLUMNS", "60")
        asked = BLOCK, "--slenderness", "0.15,0.3", "--record", records, *QUICK, "--fractiles", "0.25"
        text = run(*asked, "--all").stdout
        assert all(word in text for word in ("median", "25 %", "2 of 3", "as given", " R ", "[m]", "alpha = 0.3:"))
        verdict = "pedestal as given, 2 pi/p = 2.78 s: 1 of 3 motions overturn it (r2.csv)"
        assert " ".join(text.split()).startswith(verdict) and "25 %" not in run(*asked).stdout
        assert max(map(len, text.splitlines())) <= 60
        (row, *_) = (line.split() for line in text.splitlines() if line.endswith("of 3 "))
        assert row[2] == "-" and row[3] != "-" and "'-' under fewer than 18 motions" in " ".join(text.split())

    def test_fractiles_are_given_from_eighteen_motions_on(self):
        pulses = [word for k in range(20) for word in ("--pulse", f"sine:{0.2 + k / 100:g}g:0.8s")]
        for count, told in ((17, False), (18, True)):
            found = run_json(BLOCK, *pulses[: 2 * count], *QUICK, "--fractiles", "0.16")
            low, median = found["spectra"][0]["peaks"]
            assert median[-1] is not None and (low[-1] is not None) == told

    def test_what_larger_and_smaller_ones_do(self):
        weak = run(BLOCK, "--record", ACCEL, "--scale", "0.01").stdout
        assert "it does not uplift. No smaller size down to scale 0.1 overturns. No larger size" in weak
        strong = run(BLOCK, "--record", ACCEL, "--scale", "200", "--opening", "1000").stdout
        assert "Every smaller size down to scale 0.1 overturns. Every larger size up to scale 10" in strong
        between = run_json(BLOCK, "--record", ACCEL, "--scale", "5")["spectra"][0]
        fell = np.array(between["every_overturned"][0]) & (np.array(between["scale"]) > 1)
        least, largest = (f"{np.array(between['scale'])[fell][k]:.3g}" for k in (0, -1))
        assert between["verdict"].endswith(f"{fell.sum()} of 30 overturn, between scale {least} and {largest}.")


class TestReported:
    def test_a_bad_record_among_others(self, tmp_path, records):
        (tmp_path / "bad.csv").write_text("t,accel_g\n0,0\n0.01,x\n", encoding="utf-8")
        result = run(BLOCK, "--record", records, "--record", "bad.csv", "--record", "no.csv", *QUICK, "--json", code=5)
        assert [each["name"] for each in json.loads(result.stdout)["motions"]] == ["r0.csv", "r1.csv", "r2.csv"]
        assert "bad.csv:3" in result.stderr and "no.csv: no such file" in result.stderr
        for one in ("bad.csv", "no.csv"):
            run(BLOCK, "--record", "r0.csv", "--record", one, *QUICK, code=5)

    def test_none_but_bad_ones(self, tmp_path):
        (tmp_path / "zero.csv").write_text("t,accel_g\n0,0\n0.01,0\n", encoding="utf-8")
        result = run(BLOCK, "--record", "no*.csv", "--record", "zero.csv", "--target-pga", "1", code=2)
        assert result.stdout == "" and "no file matches" in result.stderr and "zero throughout" in result.stderr

    def test_a_history_that_fails_is_left_out(self, records, monkeypatch):
        whole = study.respond_many

        def some_fail(*arguments, **options):
            found = whole(*arguments, **options)
            failed = np.zeros(found.failed.size, dtype=bool)
            failed[[0, 7]] = True  # of r0.csv and r1.csv
            return replace(found, failed=failed, fell_to=found.fell_to * ~failed)

        asked = (BLOCK, "--record", records, *QUICK, "--json")
        full = json.loads(run(*asked).stdout)["spectra"][0]
        monkeypatch.setattr(study, "respond_many", some_fail)
        result = run(*asked, code=5)
        assert "2 of 18 responses could not be simulated" in result.stderr
        assert "pedestal at 2 pi/p = 1 s under r0.csv; pedestal at 2 pi/p = 1.565 s under r1.csv" in result.stderr
        found = json.loads(result.stdout)["spectra"][0]
        assert found["motions"] == [2, 2, 3, 3, 3, 3]
        assert found["every_peak_ratio"][0][0] is None and found["every_overturned"][0][0] is False
        assert found["overturned"][0] == full["overturned"][0] - full["every_overturned"][0][0]

    def test_doubts_of_a_few_are_said_and_of_many_summed_up(self, tmp_path):
        for k in range(5):
            (tmp_path / f"d{k}.csv").write_text("t,accel_g\n0,0.3\n0.01,0.5\n0.02,0.4\n0.03,0\n", encoding="utf-8")
        assert "d0.csv: it starts at 0.3 g" in run("--record", "d0.csv", *QUICK).stderr
        many = run("--record", "d?.csv", *QUICK).stderr
        assert many.count("warning") == 1 and "5 records are doubtful" in many and "start (5)" in many

    def test_records_of_one_name_are_told_apart(self, tmp_path):
        for folder in ("a", "b"):
            (tmp_path / folder).mkdir()
            (tmp_path / folder / "x.csv").write_text("t,accel_g\n0,0\n0.01,0.3\n0.02,0\n", encoding="utf-8")
        data = run_json("--record", "*/x.csv", "--record", "a/x.csv", *QUICK)
        assert [each["name"] for each in data["motions"]] == ["x.csv", "x.csv (b)"]


class TestWrongUse:
    @pytest.mark.parametrize(
        ("arguments", "said"),
        [
            ((), "--record or --pulse is missing: give a ground motion"),
            (("--pulse", "sine:0.4:1s"), "no unit of amplitude"),
            (("--record", "a.AT2", "b.AT2"), "--record '*.AT2'"),
            (("--record", ACCEL, "--slenderness", "5"), "alpha = atan(b/h)"),
            (("--record", ACCEL, "--slenderness", "1.2"), "too stocky"),
            (("--record", ACCEL, "--fractiles", "0.16,1"), "1 is not a fractile between 0 and 1"),
            (("--record", ACCEL, "--sizes", "3:1"), "'3:1' is not increasing: give the smaller value first"),
            (("--record", ACCEL, "--sizes", "1:3", "--count", "0"), "--count must be at least 1, got 0"),
            (("--record", ACCEL, "--restitution", "1.5"), "--restitution must be at most 1, got 1.5"),
        ],
    )
    def test_it_is_said(self, arguments, said):
        result = run(*arguments, code=2)
        assert said in result.stderr and result.stdout == ""

    def test_a_record_is_not_written_over(self, records, tmp_path):
        before = (tmp_path / "r0.csv").read_bytes()
        assert "would overwrite" in run("--record", records, "--out", "r0.csv", code=2).stderr
        assert (tmp_path / "r0.csv").read_bytes() == before


@NEEDS_RECORDS
def test_real_records_of_one_station(tmp_path):
    place = str(RECORDS / "Rinaldi[23]*.AT2")
    found = run_json(
        BLOCK, "--record", place, "--polarity", "both", "--sizes", "2:9", "--count", "8", "--plot", "s.png"
    )["spectra"][0]
    assert found["motions"] == [2] * 9
    assert found["overturned"][0] == 2 and found["overturned"][-1] == 0
    assert (tmp_path / "s.png").stat().st_size > 10_000

"""Measures in fragility studies: levels of them, curves over them, and what a store keeps of them."""

import json
import shutil

import numpy as np
import pytest

from rocking_cli import parse_pulse, read_record
from rocking_cli.core import equivalent_block
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.processing.intensity.built_in import SpectralAcceleration
from rocking_cli.processing.oscillator import response_spectrum
from rocking_cli.questions.fragility.store import Store
from rocking_cli.questions.fragility.study import load_study
from tests.conftest import EXAMPLES, rows_of
from tests.stores import command

STUDY = f"""\
structures:
  - file: {EXAMPLES / "block.yaml"}
    vary: {{width: {{normal: {{mean: 0.7, deviation: 0.03}}}}}}
records: [accel.csv, 'pulse: ricker:1g:0.5s', 'pulse: ricker:1g:1.1s']
method: METHOD
levels: {{measure: LEVEL, values: [0.05, 0.3, 0.6, 1.0]}}
limit_states: [uplift, 0.3, overturning]
samples: 2
"""


def write(folder, level="Sa(1.0)", more="", method="stripes"):
    text = STUDY.replace("LEVEL", level).replace("METHOD", method)
    text = text.replace("'pulse: ", "{pulse: '").replace("s']", "s'}]").replace("s', ", "s'}, ")
    (folder / "accel.csv").write_bytes((EXAMPLES / "accel.csv").read_bytes())
    path = folder / "study.yaml"
    path.write_text(text + more, encoding="utf-8")
    return path


def motions():
    return [read_record(EXAMPLES / "accel.csv"), *(parse_pulse(f"ricker:1g:{t}s").sampled(400) for t in (0.5, 1.1))]


def runs_of(folder):
    assert command("results", folder / "study.runs", "--out", folder / "runs.csv").exit_code == 0
    return rows_of(folder / "runs.csv")


@pytest.fixture(scope="module")
def measured(tmp_path_factory):
    """A study over all kinds of measures, whose records are gone."""
    folder = tmp_path_factory.mktemp("measured")
    path = write(folder, more="measures: [sa(1), Du, d5-95, arias, PGV/v_imp]\nbivariate: [[PGV, D5-95]]\n")
    shown = command("fragility", path, "--json", code=0)
    (folder / "accel.csv").unlink()
    return folder, json.loads(shown.stdout)


class TestIntensities:
    def test_levels_of_a_spectral_acceleration_are_reached(self, measured):
        rows = runs_of(measured[0])
        assert len(rows) == 2 * 3 * 4
        for record, motion in zip(("accel.csv", "ricker:1g:0.5s", "ricker:1g:1.1s"), motions(), strict=True):
            for row in (each for each in rows if each["motion"] == record):
                found = response_spectrum(motion.scaled(float(row["scale"])), 1.0).sa[0]
                assert found == pytest.approx(float(row["level"]), rel=1e-6)
                assert row["Sa(1.0) [g]"] == row["level"]

    def test_those_of_each_run_are_those_of_the_motion_it_had(self, measured):
        by_name = dict(zip(("accel.csv", "ricker:1g:0.5s", "ricker:1g:1.1s"), motions(), strict=True))
        study = load_study(write(measured[0]))
        for row in runs_of(measured[0]):
            motion = by_name[row["motion"]].scaled(float(row["scale"]))
            block = equivalent_block(study.samples[int(row["sample"])].mechanism).positive
            t = np.linspace(0, motion.duration, 400_001)
            a = np.abs(np.interp(t, motion.time, motion.acceleration))
            gravity = study.samples[0].mechanism.gravity
            above = (a >= block.lambda_ * gravity).mean() * motion.duration
            assert float(row["Du [s]"]) == pytest.approx(above, abs=2e-3)
            arias = np.pi / (2 * STANDARD_GRAVITY) * np.trapezoid(a * a, t)
            assert float(row["Arias [m/s]"]) == pytest.approx(arias, rel=1e-4)
            assert float(row["PGV/v_imp"]) == pytest.approx(float(row["PGV [m/s]"]) / block.v_imp, rel=1e-6)
        (measured[0] / "accel.csv").unlink()

    def test_levels_of_a_square_are_reached(self, tmp_path):
        assert command("fragility", write(tmp_path, "arias")).exit_code == 0
        for row in runs_of(tmp_path):
            assert row["Arias [m/s]"] == row["level"]
        scale = {row["level"]: float(row["scale"]) for row in runs_of(tmp_path) if row["motion"] == "accel.csv"}
        assert scale["0.6"] / scale["0.3"] == pytest.approx(2**0.5)

    def test_runs_without_any_have_no_part_and_this_is_said(self, measured):
        rows = runs_of(measured[0])
        none = sum(float(row["Du [s]"]) == 0 for row in rows)
        du = [each for each in measured[1]["curves"] if each["measure"] == "Du"]
        assert {(each["left_out"], each["runs"]) for each in du} == {(none, len(rows) - none)} and none
        said = command("results", measured[0] / "study.runs").stdout
        assert f"{none} runs have no Du above zero and are left out of this fit." in said
        assert all(each["left_out"] == 0 for each in measured[1]["curves"] if each["measure"] != "Du")

    def test_no_run_at_all(self, tmp_path):
        path = write(tmp_path, more="measures: [Du]\nbivariate: [[Du, PGA]]\n")
        path.write_text(path.read_text(encoding="utf-8").replace("0.3, 0.6, 1.0]", "0.06]"), encoding="utf-8")
        shown = command("fragility", path, "--json", "--plot", tmp_path / "pictures")
        found = json.loads(shown.stdout)
        (said,) = found["without_curve"]
        assert "no run has a Du above zero" in said and not (found["curves"] or found["surfaces"])

    def test_no_capacity_where_nothing_changes_with_the_level(self, tmp_path):
        shown = command("fragility", write(tmp_path, more="measures: [D5-95, Du, CAV]\n", method="ida"), "--json")
        curves = json.loads(shown.stdout)["curves"]
        of = {name: [each for each in curves if each["measure"] == name] for name in ("D5-95", "CAV")}
        assert all("is the same at every level" in each["why"] and each["kind"] == "none" for each in of["D5-95"])
        assert any(each["exceedances"] for each in of["CAV"]) and shown.exit_code == 0


class TestStudyFile:
    @pytest.mark.parametrize(
        ("level", "said"),
        [
            ("D5-95", "D5-95 is the same however a record is scaled: levels cannot be of it"),
            ("du", "Du is computed of every run"),
            ("Sa", "Sa is given as Sa(PERIOD[, DAMPING])"),
            ("Sx(1)", "unknown measure: Sx(1)"),
        ],
    )
    def test_what_levels_cannot_be_of_is_said_with_its_line(self, tmp_path, level, said):
        with pytest.raises(InputError) as caught:
            load_study(write(tmp_path, level))
        (found,) = caught.value.problems
        assert found.message.startswith(said) and (found.field, found.line) == ("levels.measure", 6)

    def test_a_measure_given_twice_in_two_spellings(self, tmp_path):
        with pytest.raises(InputError, match=r"Sa\(1\.0\) is given twice"):
            load_study(write(tmp_path, more="measures: [sa(1), 'Sa(1 s, 5%)']\n"))
        with pytest.raises(InputError, match=r"D5-95 is given twice"):
            load_study(write(tmp_path, more="measures: [D5-95, d5-95]\n"))

    def test_a_record_that_no_factor_brings_to_the_levels_is_left_out(self, tmp_path, monkeypatch):
        of = SpectralAcceleration.of
        with monkeypatch.context() as patched:
            patched.setattr(SpectralAcceleration, "of", lambda self, it: 0.0 if "0.5s" in it.name else of(self, it))
            for more in (["--check"], []):
                shown = command("fragility", write(tmp_path), *more, "--json")
                (said,) = json.loads(shown.stdout)["left_out"]
                assert shown.exit_code == 5 and "its Sa(1.0) is not above zero" in said
        assert command("results", tmp_path / "study.runs").exit_code == 5
        assert "could not be used when the study was started" in command("fragility", write(tmp_path), code=0).stderr

    def test_a_structure_without_a_block_has_no_v_imp(self, tmp_path):
        wall = EXAMPLES / "walls" / "column_with_tendon.yaml"
        path = write(tmp_path, "PGA", "measures: [PGV/v_imp]\n")
        text = path.read_text(encoding="utf-8").replace(str(EXAMPLES / "block.yaml"), str(wall))
        path.write_text("\n".join(line for line in text.splitlines() if "vary" not in line and "samples" not in line))
        assert "PGV/v_imp cannot be had of it" in command("fragility", path, code=2).stderr


class TestStore:
    def test_a_store_goes_on_and_learns_what_is_asked(self, tmp_path):
        path, place = write(tmp_path, "PGA"), tmp_path / "study.runs"
        assert command("fragility", path).exit_code == 0
        assert not Store.reading(place).plan.measured.of_record and not (place / "measured.npz").exists()
        before = (place / "runs-000000.npz").read_bytes()
        more = write(tmp_path, "PGA", "measures: [Sa(0.5), Du]\n")
        shown = command("fragility", more)
        assert shown.exit_code == 0 and "24 of 24 runs are in the store already" in shown.stderr
        assert (place / "runs-000000.npz").read_bytes() == before
        assert "over Sa(0.5) [g]" in shown.stdout and "over Du [s]" in shown.stdout

    def test_nothing_is_measured_twice(self, measured, tmp_path, monkeypatch):
        path = write(tmp_path, more="measures: [sa(1), Du, d5-95, arias, PGV/v_imp]\n")
        shutil.copytree(measured[0] / "study.runs", tmp_path / "study.runs")

        def never(*given):
            raise AssertionError("measured again")

        monkeypatch.setattr("rocking_cli.processing.intensity.MotionMeasure.value", never)
        monkeypatch.setattr("rocking_cli.processing.intensity.RunMeasure.value", never)
        assert command("fragility", path, "--json").exit_code == 0
        monkeypatch.undo()

    def test_results_needs_no_record(self, measured):
        found = json.loads(command("results", measured[0] / "study.runs", "--json").stdout)
        assert {key: found[key] for key in ("curves", "surfaces")} == {
            key: measured[1][key] for key in ("curves", "surfaces")
        }
        assert {each["measure"] for each in found["curves"]} == {"Sa(1.0)", "Du", "D5-95", "Arias", "PGV/v_imp"}

    def test_values_can_be_read_by_any_program(self, measured):
        place = measured[0] / "study.runs"
        values = json.loads((place / "study.json").read_text("utf-8"))["measured"]["records"]["Sa(1.0)"]
        assert values == pytest.approx([response_spectrum(motion, 1.0).sa[0] for motion in motions()])
        assert np.load(place / "measured.npz")["Du"].shape == (2, 3, 4)

    @pytest.mark.parametrize("damage", ["flipped", "cut", "deleted", "exchanged"])
    def test_damage_is_named_and_mended(self, measured, tmp_path, damage):
        place = shutil.copytree(measured[0] / "study.runs", tmp_path / "study.runs")
        file, whole = place / "measured.npz", (place / "measured.npz").read_bytes()
        file.write_bytes({"flipped": whole[:200] + bytes([whole[200] ^ 1]) + whole[201:], "cut": whole[:300]}.get(
            damage, (place / "runs-000000.npz").read_bytes()
        ))  # fmt: skip
        if damage == "deleted":
            file.unlink()
        said = command("results", place, code=2).stderr
        assert "the store is damaged: measured.npz" in said and "run the study again" in said
        path = write(tmp_path, more="measures: [sa(1), Du, d5-95, arias, PGV/v_imp]\n")
        said = command("fragility", path, "--store", place, code=0).stderr
        assert "damaged, and computed again: measured.npz" in said and file.read_bytes() == whole

    def test_a_measure_that_is_not_installed_any_more_is_said_and_keeps_the_runs(self, measured, tmp_path):
        place = tmp_path / "study.runs"
        shutil.copytree(measured[0] / "study.runs", place)
        kept = Store.writing(place)
        kept.keep(kept.plan, {"definition": {**kept.fact("definition"), "measures": ["Gone(1.0)"]}})
        assert "the definition of its study is not valid in this version" in command("results", place, code=2).stderr
        again = command("fragility", write(tmp_path, more="measures: [Sa(1.0)]\n"), "--store", place)
        assert again.exit_code == 0 and "24 of 24 runs are in the store already" in again.stderr

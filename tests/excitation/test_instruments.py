"""What instruments write: displacements, velocities, volts, counts, uneven clocks."""

import re
from dataclasses import replace

import numpy as np
import pytest

from rocking_cli.ask.read import read_record
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.excitation.records import read_measured
from rocking_cli.excitation.records.record_units import Gain
from rocking_cli.processing.reading import Reading
from rocking_cli.processing.steps import parse_steps
from tests.cli.test_cli import run, run_json
from tests.conftest import SHARED, rows_of

EXPERIMENTS = SHARED / "experiments"
RAW = EXPERIMENTS / "raw_test438.txt"
NEEDS_EXPERIMENTS = pytest.mark.skipif(not RAW.is_file(), reason=f"no shake-table tests in {EXPERIMENTS}")

DT = 0.005
T = np.arange(0, 4 + DT / 2, DT)
# A displacement that begins and ends at rest, and its derivatives by hand: u = A sin^4(pi t/4) sin(w t).
A, W = 0.03, 2 * np.pi * 1.5
S, C = np.sin(np.pi * T / 4), np.cos(np.pi * T / 4)
Q = np.pi / 4
ENVELOPE = S**4, 4 * Q * S**3 * C, Q**2 * (12 * S**2 * C**2 - 4 * S**4)
U = A * ENVELOPE[0] * np.sin(W * T)
V = A * (ENVELOPE[1] * np.sin(W * T) + ENVELOPE[0] * W * np.cos(W * T))
ACC = A * (ENVELOPE[2] * np.sin(W * T) + 2 * ENVELOPE[1] * W * np.cos(W * T) - ENVELOPE[0] * W**2 * np.sin(W * T))


def write(path, header, *columns, sep=","):
    rows = [sep.join(repr(float(x)) for x in row) for row in zip(*columns, strict=True)]
    path.write_text("\n".join([header, *rows]) + "\n", encoding="utf-8")
    return path


@pytest.fixture
def moved(tmp_path):
    return write(tmp_path / "u.csv", "t [s],u [mm]", T, 1000 * U)


class TestDerivatives:
    def test_a_displacement_becomes_its_acceleration(self, moved):
        motion = read_record(moved, quantity="displacement")
        assert motion.acceleration == pytest.approx(ACC, abs=2e-3 * np.abs(ACC).max())
        assert motion.processing == ("from displacement",)
        assert motion.source_unit == "mm"
        back = motion.displacement
        assert back == pytest.approx(U, abs=0.01 * A)

    def test_a_velocity_too(self, tmp_path):
        file = write(tmp_path / "v.csv", "t [s],v [cm/s]", T, 100 * V)
        motion = read_record(file, quantity="velocity")
        assert motion.acceleration == pytest.approx(ACC, abs=2e-3 * np.abs(ACC).max())
        assert motion.velocity == pytest.approx(V, abs=2e-3 * np.abs(V).max())

    @pytest.mark.parametrize(("quantity", "response"), [("displacement", 0.44295), ("velocity", 0.30168)])
    def test_half_is_left_at_the_frequency_that_is_said(self, tmp_path, quantity, response):
        from rocking_cli.processing.reading import in_words

        f = response / DT
        values = np.sin(2 * np.pi * f * T + 0.3)
        file = write(tmp_path / "x.csv", f"t [s],x [{'m' if quantity == 'displacement' else 'm/s'}]", T, values)
        found = read_record(file, quantity=quantity).acceleration[1:-1]
        power = 2 if quantity == "displacement" else 1
        exact = (2 * np.pi * f) ** power * np.sin(2 * np.pi * f * T + 0.3 + power * np.pi / 2)[1:-1]
        assert found == pytest.approx(exact / 2, abs=1e-3 * np.abs(exact).max())
        assert f"{f:.3g} Hz" in in_words(quantity, DT)

    def test_the_unit_must_be_said_and_of_that_quantity(self, tmp_path, moved):
        bare = write(tmp_path / "bare.csv", "t,u", T, U)
        with pytest.raises(InputError, match="does not say what unit its displacements are in"):
            read_record(bare, quantity="displacement")
        assert read_record(bare, quantity="displacement", units="m").pga_g == pytest.approx(
            np.abs(ACC).max() / STANDARD_GRAVITY, rel=5e-3
        )
        with pytest.raises(InputError, match="'g' is not a unit of displacement"):
            read_record(moved, quantity="displacement", units="g")
        with pytest.raises(InputError, match="a velocity or displacement, not an acceleration"):
            read_record(moved)

    def test_coarse_steps_are_said(self, tmp_path):
        file = write(tmp_path / "steps.csv", "t [s],u [m]", T, np.round(U, 3))
        remarks = {each.kind: each for each in read_record(file, quantity="displacement").remarks}
        doubt = remarks["resolution"]
        assert doubt.value == pytest.approx(0.001 / DT**2 / STANDARD_GRAVITY)

    @pytest.mark.parametrize("steps", [["highpass 0.5"], ["factor 2"]])
    def test_corrections_do_not_hide_coarse_steps(self, tmp_path, steps):
        file = write(tmp_path / "steps.csv", "t [s],u [m]", T, np.round(U, 3))
        asked = Reading({"quantity": "displacement"}, parse_steps(steps))
        (doubt,) = (each for each in asked.read(file).remarks if each.kind == "resolution")
        size = 2 if steps == ["factor 2"] else 1
        assert doubt.value == pytest.approx(size * 0.001 / DT**2 / STANDARD_GRAVITY)
        turned = replace(
            asked,
            options=asked.options
            | {"other": write(tmp_path / "b.csv", "t [s],u [m]", T, np.round(U, 4)), "azimuth": 30.0},
        )
        assert doubt.value in [pytest.approx(each.value) for each in turned.read(file).remarks]
        filtered = replace(asked, steps=(*asked.steps, *parse_steps(["lowpass 20"])))
        assert "resolution" not in [each.kind for each in filtered.read(file).remarks]

    @pytest.mark.parametrize(
        ("header", "quantity", "units", "words"),
        [
            ("t [s],u [mm]", "displacement", "m", "the header says the unit is mm, but `units` says m"),
            ("t [s],v [cm/s]", "displacement", "mm", "are in cm/s, a unit of velocities"),
            ("t [s],v [cm/s]", "displacement", None, "is it `quantity` velocity"),
        ],
    )
    def test_a_header_that_says_something_else(self, tmp_path, header, quantity, units, words):
        file = write(tmp_path / "x.csv", header, T, U)
        with pytest.raises(InputError, match=words):
            read_record(file, quantity=quantity, units=units)

    def test_the_command_says_what_differences_leave(self, moved):
        assert f"half of what is at {0.44295 / DT:.3g} Hz" in run("record", moved, "--from", "displacement").stderr

    def test_a_format_of_accelerations_has_no_other(self, tmp_path):
        file = tmp_path / "x.json"
        file.write_text('{"dT": 0.01, "info": "in g", "accel_data": [0, 1, 0]}')
        with pytest.raises(InputError, match="gives accelerations, and says their unit"):
            read_record(file, quantity="displacement")


class TestGain:
    @pytest.mark.parametrize(
        ("text", "size", "quantity"),
        [
            ("0.05 m/V", 0.05, "displacement"),
            ("12 mm/s/V", 0.012, "velocity"),
            ("2 g/V", 2 * STANDARD_GRAVITY, "acceleration"),
            ("-0.1 mg per count", -1e-4 * STANDARD_GRAVITY, "acceleration"),
            ("3 cm/s^2/mV", 0.03, "acceleration"),
        ],
    )
    def test_what_it_is_of(self, text, size, quantity):
        gain = Gain.parse(text)
        assert (gain.size, gain.quantity) == (pytest.approx(size), quantity)
        assert Gain.parse(str(gain)) == gain
        fine = Gain.parse("1.23456789e-5 m/count")
        assert Gain.parse(str(fine)).size == fine.size == 1.23456789e-5

    @pytest.mark.parametrize(
        ("text", "words"),
        [
            ("0.05", "is a gain without a unit"),
            ("m/V", "is not a number with a unit"),
            ("1 kg/V", "'kg' is not a unit of"),
            ("nan m/V", "is not a number"),
            ("1e-320 m/V", "is not a number"),
            ("5 g/s", "'s' is not an output of an instrument"),
        ],
    )
    def test_what_is_none(self, text, words):
        with pytest.raises(InputError, match=words):
            Gain.parse(text)

    def test_it_multiplies_and_says_so(self, tmp_path):
        file = write(tmp_path / "volts.txt", "t [s]\tchannel 1 [V]", T, ACC / 3.0, sep="\t")
        motion = read_record(file, gain="3 m/s2/V")
        assert motion.acceleration == pytest.approx(ACC)
        assert motion.processing == ("gain 3 m/s2/V",)
        with pytest.raises(InputError, match="but `quantity` says velocity"):
            read_record(file, gain="3 m/s2/V", quantity="velocity")
        with pytest.raises(InputError, match="leave `units` or `gain` out"):
            read_record(file, gain="3 m/s2/V", units="g")

    def test_values_with_a_unit_need_none(self, tmp_path):
        file = write(tmp_path / "g.csv", "t [s],a [g]", T, ACC)
        with pytest.raises(InputError, match="are in g already") as error:
            read_record(file, gain="3 m/s2/V")
        assert error.value.problems[0].line == 1


class TestColumns:
    @pytest.fixture
    def table(self, tmp_path):
        return write(tmp_path / "t.txt", "Time\tacc x [g]\tTime 2\tlaser [mm]", T, ACC, T, 1000 * U, sep="\t")

    def test_what_the_label_says_it_is_decides(self, table):
        assert read_record(table).name == "t.txt"  # one column of accelerations
        laser = read_record(table, quantity="displacement")  # and one of displacements
        assert laser.acceleration == pytest.approx(ACC, abs=2e-3 * np.abs(ACC).max())
        with pytest.raises(InputError, match="none of the columns holds velocities"):
            read_record(table, quantity="velocity")


class TestUnevenTimes:
    @pytest.fixture
    def jittered(self, tmp_path):
        jitter = np.random.default_rng(1).uniform(-0.2, 0.2, T.size) * DT
        jitter[[0, -1]] = 0
        t = T + jitter
        return write(tmp_path / "late.csv", "t [s],a [m/s2]", t, np.interp(t, T, ACC)), t

    def test_they_are_refused_unless_asked_for(self, jittered):
        file, _ = jittered
        with pytest.raises(InputError, match=r"`rk.read_record\(FILE, resample=\S+\)` puts it on an even grid"):
            read_record(file)

    def test_a_grid_is_put_over_them(self, jittered):
        file, t = jittered
        motion = read_measured(file, uneven=True)[0]
        assert motion.dt == pytest.approx(DT, rel=0.1)
        wanted = np.interp(motion.time, t, np.interp(t, T, ACC))
        assert motion.acceleration == pytest.approx(wanted)
        (doubt,) = motion.remarks
        assert doubt.kind == "uneven"
        assert doubt.value == pytest.approx(np.abs(np.diff(t) - motion.dt).max())
        assert f"to {np.diff(t).max():.3g} s" in doubt.text

    def test_the_first_of_several_columns_may_be_such_times(self, jittered, tmp_path):
        _, t = jittered
        a = np.interp(t, T, ACC)
        file = write(tmp_path / "three.csv", "# as the logger wrote it", t, a, 2 * a)
        with pytest.raises(InputError):
            read_record(file, channel="column 2", units="m/s2")
        motion = read_measured(file, channel="column 2", units="m/s2", uneven=True)[0]
        assert motion.acceleration == pytest.approx(np.interp(motion.time, t, a))

    def test_a_gap_is_not_filled_with_a_line(self, tmp_path):
        file = write(tmp_path / "gap.csv", "t [s],a [g]", np.array([0, 0.01, 0.02, 1e9]), np.zeros(4))
        with pytest.raises(InputError, match=r"gap.csv:5: gap in the record from 0.02 to 1e\+09 s"):
            read_measured(file, uneven=True)[0]

    def test_the_command_takes_them_with_a_grid(self, jittered):
        file, _ = jittered
        data = run_json("record", file, "--resample", "0.005")
        assert data["dt"] == pytest.approx(0.005)
        assert "uneven" in [each["kind"] for each in data["warnings"]]
        said = run("record", file, code=2).stderr
        assert re.search(r"`rocking record FILE --resample \S+ --out PREPARED.csv` puts it on an even grid", said)


@NEEDS_EXPERIMENTS
class TestLaboratoryFile:
    """As the laboratory wrote it: eight columns, no units, times of six digits at 800 Hz."""

    def row(self):
        return next(each for each in rows_of(EXPERIMENTS / "granite_boulders.csv") if each["test"] == "438")

    def test_its_accelerometer_by_options_alone(self):
        data = run_json(
            "record", RAW, "--channel", "column 2", "--units", "g", "--baseline", "linear", "--highpass", "0.1",
            "--lowpass", "25",
        )  # fmt: skip
        assert data["pga_g"] == pytest.approx(float(self.row()["pga_acc_g"]), rel=0.02)
        assert data["processing"] == ["baseline linear", "highpass 0.1", "lowpass 25"]

    def test_its_transducer_of_displacement(self):
        data = run_json(
            "record", RAW, "--channel", "column 6", "--gain", "1.51884e-5 m/count", "--baseline", "linear",
            "--highpass", "0.1", "--lowpass", "25",
        )  # fmt: skip
        assert data["pgv"] == pytest.approx(float(self.row()["pgv_disp_ms"]), rel=0.1)
        assert data["processing"][0] == "gain 1.51884e-05 m/count" and data["processing"][-1] == "from displacement"

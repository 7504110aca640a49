"""Corrections of motions: each against scipy's own, in the order they are given, and said."""

import json

import numpy as np
import pytest
from scipy import signal

import rocking_cli as rk
from rocking_cli.ask.ground_motions import Motions
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.doubts import doubts
from rocking_cli.excitation.measures import measure
from rocking_cli.processing.oscillator import Floor
from rocking_cli.processing.reading import Reading, reading_of
from rocking_cli.processing.record_list import Entry, of_reading
from rocking_cli.processing.steps import parse_step, parse_steps, process
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES

ACCEL = EXAMPLES / "accel.csv"
TRANSVERSE = EXAMPLES / "accel_transverse.csv"


@pytest.fixture(scope="module")
def motion():
    rng = np.random.default_rng(3)
    t = 0.01 * np.arange(1501)
    samples = np.exp(-(((t - 6) / 3) ** 2)) * rng.normal(size=t.size) + 0.05 * t + 0.2
    return GroundMotion("noise", 0.01, samples, unit="m/s2")


def done(motion, *steps):
    return process(motion, parse_steps(steps)).acceleration


class TestAgainstScipy:
    def test_filters(self, motion):
        for name, f in (("highpass", 0.3), ("lowpass", 20.0)):
            sections = signal.butter(4, f, name, fs=100, output="sos")
            assert done(motion, f"{name} {f}") == pytest.approx(signal.sosfiltfilt(sections, motion.acceleration))

    def test_half_of_the_amplitude_is_left_at_the_corner(self):
        t = 0.005 * np.arange(20_001)
        wave = GroundMotion("wave", 0.005, np.sin(2 * np.pi * 2 * t), unit="m/s2")
        middle = slice(6000, 14000)
        for name in ("highpass", "lowpass"):
            assert done(wave, f"{name} 2")[middle] == pytest.approx(wave.acceleration[middle] / 2, abs=1e-6)

    def test_baselines(self, motion):
        a = motion.acceleration
        assert done(motion, "baseline constant") == pytest.approx(signal.detrend(a, type="constant"), abs=1e-12)
        assert done(motion, "baseline linear") == pytest.approx(signal.detrend(a, type="linear"), abs=1e-12)
        t = motion.time
        left = done(motion, "baseline quadratic")
        for power in range(3):
            assert np.sum(left * t**power) == pytest.approx(0, abs=1e-9 * np.sum(np.abs(a) * t**power))
        parabola = GroundMotion("p", 0.01, 3 + 2 * t - 0.7 * t**2, unit="m/s2")
        assert done(parabola, "baseline quadratic") == pytest.approx(0 * t, abs=1e-9)

    def test_taper(self, motion):
        n = motion.npts
        assert done(motion, "taper 0.05") == pytest.approx(motion.acceleration * signal.windows.tukey(n, 0.1))
        shape = done(GroundMotion("one", 0.01, np.ones(1001), unit="m/s2"), {"taper": "5%"})
        assert shape[25] == pytest.approx(0.5) and shape[0] == 0 and (shape[51:950] == 1).all()

    def test_coarser_samples(self, motion):
        found = process(motion, parse_steps(["resample 0.025"]))
        wanted = signal.resample_poly(motion.acceleration, 2, 5, padtype="line")
        assert found.dt == 0.025 and found.npts == 601
        assert found.acceleration == pytest.approx(wanted[:601])

    def test_coarser_samples_hold_nothing_folded_back(self):
        t = 0.005 * np.arange(8001)
        slow, fast = np.sin(2 * np.pi * t), np.sin(2 * np.pi * 70 * t)
        found = process(GroundMotion("two", 0.005, slow + fast, unit="m/s2"), parse_steps(["resample 0.01"]))
        assert found.acceleration[200:-200] == pytest.approx(slow[::2][200:-200], abs=0.01)


class TestShape:
    def test_finer_samples_lie_on_the_same_lines(self, motion):
        found = process(motion, parse_steps(["resample 0.0025"]))
        assert found.acceleration[::4] == pytest.approx(motion.acceleration)
        assert found.velocity[::4] == pytest.approx(motion.velocity)
        assert measure(found).pgd == pytest.approx(measure(motion).pgd)

    def test_the_same_interval_changes_nothing(self, motion):
        assert done(motion, "resample 0.01") is motion.acceleration

    def test_an_interval_that_is_no_simple_fraction(self, motion):
        found = process(motion, parse_steps(["resample 0.013"]))
        assert found.dt == pytest.approx(0.013, rel=1e-7)
        assert found.duration <= motion.duration * (1 + 1e-9) < found.duration + found.dt

    @pytest.mark.parametrize("count", [100, 101])
    @pytest.mark.parametrize(("dt", "parts", "of"), [(0.015, 2, 3), (0.02, 1, 2), (0.03, 1, 3)])
    def test_a_coarser_interval_keeps_every_sample_within_the_record(self, count, dt, parts, of):
        found = process(GroundMotion("one", 0.01, np.ones(count), unit="m/s2"), parse_steps([{"resample": dt}]))
        assert found.npts == (count - 1) * parts // of + 1

    def test_a_negative_factor_leaves_the_vertical_upright(self, motion, tmp_path):
        from dataclasses import replace

        both = replace(motion, vertical=motion)
        found = process(both, parse_steps(["factor -1.5"]))
        assert (found.acceleration == -1.5 * motion.acceleration).all()
        assert (found.vertical.acceleration == 1.5 * motion.acceleration).all()
        alone = Reading({}, parse_steps(["factor -1.5"])).vertical(ACCEL)
        assert (alone.acceleration == 1.5 * Reading().read(ACCEL).acceleration).all()

    def test_a_floor_is_corrected_with_its_ground(self):
        import rocking_cli as rk

        found = rk.correct(rk.on_floor(ACCEL, "T1=0.4,z/H=1,n=3"), "trim 1:9", "lowpass 5")
        assert found.of_ground.pga_g == rk.correct(ACCEL, "trim 1:9", "lowpass 5").pga_g

    def test_trim_takes_what_is_between(self, motion):
        found = process(motion, parse_steps([{"trim": "2:12.5"}]))
        assert (found.acceleration == motion.acceleration[200:1251]).all()
        assert (done(motion, "trim 2:") == motion.acceleration[200:]).all()
        assert (done(motion, {"trim": ":3 s"}) == motion.acceleration[:301]).all()
        assert (done(motion, {"trim": [2, 12.5]}) == found.acceleration).all()

    def test_the_order_is_the_one_given(self, motion):
        one, other = ["trim 5:8", "baseline linear"], ["baseline linear", "trim 5:8"]
        a, b = done(motion, *one), done(motion, *other)
        assert np.abs(a - b).max() > 1e-3
        assert process(motion, parse_steps(one)).processing == tuple(one)

    def test_the_vertical_component_goes_through_the_same(self, motion):
        from dataclasses import replace

        both = replace(motion, vertical=motion.scaled(0.5))
        found = process(both, parse_steps(["trim 2:8", "lowpass 10"]))
        assert found.vertical.acceleration == pytest.approx(found.acceleration / 2)

    def test_what_a_lowpass_takes_out_is_doubted_no_longer(self, motion):
        from dataclasses import replace

        from rocking_cli.excitation.base import Doubt
        from rocking_cli.processing.reading import as_acceleration

        coarse = replace(motion, acceleration=np.round(0.05 * np.sin(motion.time), 3))  # displacements of whole mm
        (noisy,) = (each for each in as_acceleration(coarse, "displacement").remarks if each.kind == "resolution")
        other = Doubt("columns", 3.0, "three columns")
        remarked = replace(motion, remarks=(noisy, other))
        for step, left in (("lowpass 10", [other]), ("highpass 0.2", [noisy, other]), ("taper 0.05", [noisy, other])):
            kept = [each for each in process(remarked, parse_steps([step])).remarks if each in (noisy, other)]
            assert kept == left, step

    def test_nothing_is_corrected_unless_asked(self, motion):
        assert process(motion, ()) is motion
        assert Reading().read(ACCEL).processing == ()


class TestRefusals:
    def test_a_filter_may_have_as_long_a_period_as_the_record(self, motion):
        """Of 15 s: one period of 1/15 Hz, and 1.2 of .08 Hz."""
        for frequency in (1 / 15, 0.08):
            sections = signal.butter(4, frequency, "highpass", fs=100, output="sos")
            wanted = signal.sosfiltfilt(sections, motion.acceleration)
            assert done(motion, {"highpass": frequency}) == pytest.approx(wanted)
        with pytest.raises(InputError, match="is shorter than one period"):
            done(motion, {"highpass": 0.066})

    @pytest.mark.parametrize(
        ("step", "words"),
        [
            ("lowpass 50", "50 Hz is not below the Nyquist frequency, 50 Hz"),
            ("highpass 0.05", "15 s long, is shorter than one period of 0.05 Hz"),
            ("trim 2:20", "ends at 15 s, before 20 s"),
            ("trim 16:", "fewer than two samples"),
            ("resample 20", "fewer than two samples"),
            ("resample 1e-9", "less than a 1000th"),
        ],
    )
    def test_what_the_record_does_not_allow(self, motion, step, words):
        with pytest.raises(InputError, match=words):
            done(motion, step)

    @pytest.mark.parametrize(
        ("name", "given", "words"),
        [
            ("baseline", "cubic", "is not one of constant, linear, quadratic"),
            ("highpass", "0", "is not a frequency in Hz above zero"),
            ("taper", "0.7", "more than half of the record"),
            ("trim", "2", "is no.* range of times"),
            ("trim", "5:2", "ends before it begins"),
            ("resample", "0.01 kg", "is a mass"),
            ("factor", "0", "is not a factor"),
            ("hipass", "1", "is not a processing step"),
        ],
    )
    def test_what_no_step_takes(self, name, given, words):
        with pytest.raises(InputError, match=words.replace("is no.*", "is not a")):
            parse_step(name, given)

    def test_intervals_that_no_memory_holds(self):
        long = GroundMotion("long", 0.01, np.zeros(200_001), unit="m/s2")
        with pytest.raises(InputError, match=r"would make 2e\+08 samples"):
            done(long, "resample 0.00001")
        with pytest.raises(InputError, match="is more than 100000 of the"):
            done(long, "resample 1500")

    def test_too_few_samples(self):
        with pytest.raises(InputError, match="12 samples are too few for a filter"):
            done(GroundMotion("short", 0.01, np.ones(12), unit="m/s2"), "lowpass 20")
        with pytest.raises(InputError, match="nothing would be left"):
            done(GroundMotion("short", 0.01, np.array([0.0, 1.0, 0.0]), unit="m/s2"), "baseline quadratic")


@pytest.mark.parametrize("name", ["highpass", "lowpass", "taper", "trim", "resample", "factor"])
def test_what_is_said_reads_back_to_the_last_digit(name):
    third = repr(0.1 / 3)
    step = parse_step(name, f"{third}:{1 / 3!r}" if name == "trim" else third)
    assert parse_steps([str(step)]) == (step,)


def test_doubts_of_samples_are_those_of_the_record_as_read():
    samples = np.clip(np.sin(np.arange(800) / 20), -0.6, 0.6)
    clipped = GroundMotion("clipped", 0.01, samples, unit="m/s2")
    kinds = [each.kind for each in doubts(clipped, measure(clipped))]
    filtered = process(clipped, parse_steps(["lowpass 20"]))
    assert "clipped" in kinds
    assert [each.kind for each in doubts(filtered, measure(filtered))].count("clipped") == kinds.count("clipped")


class TestCommands:
    def test_they_are_made_in_the_order_of_the_command_line(self):
        one = run_json("record", ACCEL, "--lowpass", "10", "--trim", "1:9", "--taper", "0.1")
        other = run_json("record", ACCEL, "--taper", "0.1", "--trim", "1:9", "--lowpass", "10")
        assert one["processing"] == ["lowpass 10", "trim 1:9", "taper 0.1"]
        assert other["processing"] == one["processing"][::-1]
        assert one["pgv"] != other["pgv"]

    @pytest.mark.parametrize(
        ("options", "words"),
        [
            (("--highpass", "1", "--highpass", "2"), "is given twice"),
            (("--lowpass", "80"), "--lowpass: 80 Hz is not below the Nyquist frequency, 50 Hz"),
        ],
    )
    def test_wrong_options(self, options, words):
        assert words in run("record", ACCEL, *options, code=2).stderr

    def test_a_list_may_repeat_a_step(self, tmp_path):
        (tmp_path / "set.yaml").write_text(
            f"records:\n  - file: {ACCEL.as_posix()}\n    factor: 1.5\n    processing:\n"
            "      - highpass: 0.2\n      - lowpass: 20\n      - highpass: 0.3\n"
        )
        data = run_json("respond", "--neighbours", 0, "--record", tmp_path / "set.yaml")
        assert data["record"]["processing"] == ["highpass 0.2", "lowpass 20", "highpass 0.3", "factor 1.5"]
        plain = run_json("record", ACCEL, "--highpass", 0.2, "--lowpass", 20)
        assert data["record"]["pga_g"] == pytest.approx(1.5 * plain["pga_g"], rel=0.05)

    @pytest.mark.parametrize(
        ("entry", "words"),
        [
            (f"{{file: '{ACCEL.as_posix()}', azimuth: 30}}", "--azimuth requires a second component"),
            (f"{{file: '{ACCEL.as_posix()}', with: east.csv}}", "--azimuth is missing"),
            (f"{{file: '{ACCEL.as_posix()}', with_channel: '2'}}", "--with-channel requires a second component"),
            ("{file: set.yaml}", "is a list of records itself"),
        ],
    )
    def test_entries_that_say_half_of_it(self, tmp_path, entry, words):
        (tmp_path / "set.yaml").write_text(f"records:\n  - {entry}\n")
        assert words in run("respond", "--record", tmp_path / "set.yaml", code=2).stderr

    def test_an_entry_without_an_azimuth_takes_that_of_the_options(self, tmp_path):
        entry = f"{{file: '{ACCEL.as_posix()}', with: '{TRANSVERSE.as_posix()}'}}"
        (tmp_path / "set.yaml").write_text(f"records:\n  - {entry}\n")
        asked = ("--with", ACCEL, "--azimuth", 40, "--neighbours", 0)
        found = run_json("respond", "--record", tmp_path / "set.yaml", *asked)["record"]
        assert found["processing"] == ["with accel_transverse.csv", "azimuth 40"]

    def test_what_is_written_of_a_reading_reads_so_again(self, tmp_path):
        for azimuth in (0.0, 30.0):
            asked = reading_of({"other": TRANSVERSE, "azimuth": azimuth, "highpass": 0.2})
            entry = Entry.model_validate({"file": ACCEL.name, **of_reading(asked, ACCEL.parent)})
            assert entry.reading(ACCEL.parent).read(ACCEL).processing == asked.read(ACCEL).processing

    def test_a_structure_is_no_list(self, tmp_path):
        said = run("respond", "--record", EXAMPLES / "block.yaml", code=2).stderr
        assert "this is a structure, and no list of records" in said

    def test_entries_that_are_the_same_are_read_once(self, tmp_path):
        one = f"  - {{file: '{ACCEL.as_posix()}', factor: 2}}\n"
        other = f"  - {{file: '{ACCEL.as_posix()}', factor: 1}}\n"
        (tmp_path / "set.yaml").write_text(f"records:\n{one}{other}{one}")
        found = Motions.of([tmp_path / "set.yaml", ACCEL, ACCEL], {}).records
        assert [each.entry.factor if each.entry else None for each in found] == [2, 1, None]

    def test_mistakes_in_a_list_have_their_lines(self, tmp_path):
        (tmp_path / "set.yaml").write_text(
            "records:\n  - file: none.csv\n  - {file: accel.csv, processing: [{hipass: 1}]}\n  - {gain: 3 kg/V}\n"
        )
        said = run("respond", "--record", tmp_path / "set.yaml", code=2).stderr
        assert "set.yaml:3" in said and "did you mean highpass?" in said
        assert "set.yaml:4" in said and "'kg' is not a unit of acceleration, velocity or length" in said


def test_record_takes_lists_and_patterns(tmp_path):
    for name, factor in (("one", 1.0), ("two", 2.0)):
        (tmp_path / f"{name}.csv").write_bytes(ACCEL.read_bytes())
        (tmp_path / f"{name}.yaml").write_text(f"records: [{{file: {name}.csv, factor: {factor}}}]\n")
    said = [json.loads(line) for line in run("record", tmp_path / "*.yaml", "--json").stdout.splitlines()]
    assert [each["pga_g"] for each in said] == pytest.approx([0.55, 1.1])
    run("record", tmp_path / "two.yaml", "-o", tmp_path / "clean")
    assert run_json("record", tmp_path / "clean" / "two.csv")["pga_g"] == pytest.approx(1.1)


@pytest.mark.parametrize(
    "steps", [("highpass 10", "lowpass 5"), ("lowpass 5", "highpass 10"), ("highpass 5", "lowpass 5")]
)
def test_filters_that_leave_nothing_between_them_are_refused(steps):
    with pytest.raises(InputError, match=r"highpass: .* Hz is not below the lowpass of 5 Hz"):
        rk.correct(ACCEL, *steps)


def test_a_floor_of_equal_storeys_is_named_by_their_number():
    said = str(Floor.parse("T1=0.4,z/H=0.67,n=3"))
    assert said.endswith("z/H=0.67,n=3") and Floor.parse(said) == Floor.parse("T1=0.4,z/H=0.67,n=3")
    assert str(Floor.parse("T1=0.4,z/H=0.67,gamma=1.29")).endswith("gamma=1.29")


@pytest.mark.parametrize(("dt", "every"), [(0.004, 2), (0.0005, 16), (0.02, 1)])
def test_a_resampled_pulse_is_shown_as_often_as_before(dt, every):
    """Every eighth sample of 1 ms is shown, one in 8 ms; where samples are farther apart than that, each."""
    pulse = GroundMotion("pulse", 0.001, np.sin(np.linspace(0.0, 6.0, 1001)), every=8, unit="m/s2")
    assert process(pulse, parse_steps([{"resample": dt}])).every == every

"""Two components in one plane, and the motion of a floor."""

import json
from dataclasses import replace
from math import sqrt

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rocking_cli.ask.read import read_record
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.processing.oscillator import Floor
from rocking_cli.processing.reading import turned
from rocking_cli.questions.respond.azimuths import all_around, sectors
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES

ACCEL = EXAMPLES / "accel.csv"
FLOOR = "T1=0.4,xi=0.05,z/H=0.67,gamma=1.29"


@pytest.fixture(scope="module")
def quake():
    return read_record(ACCEL)


@pytest.fixture
def pair(tmp_path, quake):
    other = tmp_path / "east.csv"
    rows = "".join(
        f"{t:.2f},{a!r}\n" for t, a in zip(quake.time, (0.6 * quake.acceleration[::-1]).tolist(), strict=True)
    )
    other.write_text(f"t [s],a [m/s2]\n{rows}")
    return other


class TestFloor:
    def test_against_an_integration_of_another_kind(self, quake):
        """u_z'' = u_g'' + psi gamma u_rel'' by Runge and Kutta's eighth order over each straight line."""
        period, xi, z, gamma = 0.4, 0.05, 0.67, 1.29
        w = 2 * np.pi / period
        found = Floor(period, xi, z, gamma).of(quake)
        state, wanted = np.zeros(2), []
        for k in range(400):
            a0, a1 = quake.acceleration[k : k + 2]
            wanted.append(a0 + z * gamma * (-a0 - 2 * xi * w * state[1] - w * w * state[0]))

            def rate(t, y, a0=a0, a1=a1):
                return [y[1], -(a0 + (a1 - a0) * t / quake.dt) - 2 * xi * w * y[1] - w * w * y[0]]

            state = solve_ivp(rate, (0, quake.dt), state, method="DOP853", rtol=1e-11, atol=1e-13).y[:, -1]
        kept = found.acceleration[:: round(quake.dt / found.dt)][:400]
        assert kept == pytest.approx(np.array(wanted), abs=1e-7 * np.abs(wanted).max())

    def test_a_stiff_building_goes_with_the_ground(self, quake):
        for period, off in ((1e-4, 1e-9), (1e-3, 1e-3)):
            found = Floor(period, 0.05, 1.0, 1.5).of(quake)
            at_samples = found.acceleration[:: found.every]
            assert at_samples == pytest.approx(quake.acceleration, abs=off * np.abs(quake.acceleration).max())

    def test_at_its_foot_a_building_moves_as_the_ground(self, quake):
        found = Floor(0.4, 0.05, 0.0, 1.29).of(quake)
        assert found.acceleration[:: found.every] == pytest.approx(quake.acceleration, abs=1e-12)

    def test_resonance_over_damping(self):
        """Long after the start of a sine of its own period the top is amplified by about gamma/(2 xi)."""
        t = np.arange(0, 40, 0.01)
        wave = GroundMotion("wave", 0.01, np.sin(2 * np.pi * t / 0.5), unit="m/s2")
        found = Floor(0.5, 0.05, 1.0, 1.0).of(wave)
        assert np.abs(found.acceleration[-400:]).max() == pytest.approx(np.hypot(1, 1 / 0.1), rel=5e-3)

    def test_storeys_give_the_participation(self):
        assert Floor.parse("T1=0.4,z/H=1,n=3").participation == pytest.approx(9 / 7)
        assert Floor.parse({"T1": 0.4, "xi": "5%", "z/H": 0.67, "gamma": 1.29}) == Floor.parse(FLOOR)
        for text in (FLOOR, "T1=0.4,z/H=1,n=3"):
            assert Floor.parse(str(Floor.parse(text))) == Floor.parse(text)

    @pytest.mark.parametrize(
        ("text", "words"),
        [
            ("T1=0.4,z/H=0.5", "gamma, or n"),
            ("T1=0.4,z/H=0.5,n=2,gamma=1.2", "one of the two"),
            ("z/H=0.5,n=2", "T1 must be given"),
            ("T1=0.4,z/H=1.5,n=2", "z/H must be from 0 to 1"),
            ("T1=0.4,z/H=0.5,n=2.5", "number of storeys"),
            ("T1=0.4,z/H=0.5,n=inf", "n: 'inf' is not a number"),
            ("T1=0.4,z/H=０.５,n=2", "z/H: "),
            ("T1=1e-300,z/H=0.5,n=2", "T1 must be from 1e-06 to"),
            ("T1=0.4,z/H=0.5,gamma=1e30", "gamma must be a positive number, 100 at most"),
            ("T1=-1,z/H=0.5,n=2", "positive number of seconds"),
            ("T1=0.4,xi=2,z/H=0.5,n=2", "damping ratio"),
            ("T1=0.4,zz=0.5,n=2", "'zz' is not one of"),
            ("T1=0.4,z/H=0.5,z/H=0.6,n=2", "z/H is given twice"),
            ("0.4", "is not of the form T1=0.4"),
            ("T1=0.4 kg,z/H=0.5,n=2", "is a mass"),
            ("T1=0.4,z/H=0.67,H=9,n=2", "z/H cannot be combined with z or H"),
            ("T1=0.4,n=2", "z with H must be given"),
            ("T1=0.4,H=9,n=2", "z with H must be given"),
            ("T1=0.4,z=6,H=9,z/H=0.67,n=2", "z/H cannot be combined with z or H"),
            ("T1=0.4,z=6 kg,H=9,n=2", "z: 6 kg is a mass, not a length"),
            ("T1=0.4,z=9.5,H=9,n=2", "z must be from 0 to H, got 9.5 m of 9 m"),
            ("T1=0.4,z=-1,H=9,n=2", "z must be from 0 to H"),
            ("T1=0.4,z=0,H=0,n=2", "z must be from 0 to H"),
        ],
    )
    def test_what_is_no_floor(self, text, words):
        with pytest.raises(InputError, match=words):
            Floor.parse(text)

    def test_heights_in_metres_are_those_of_a_site(self):
        by_ratio = Floor(0.4, 0.05, 6 / 9, 9 / 7)
        for text in ("T1=0.4,z=6m,H=9m,n=3", "T1=0.4,z=6,H=9,n=3", "T1=400ms, z = 600 cm, H = 9 m, n = 3"):
            assert Floor.parse(text) == by_ratio
        assert Floor.parse({"T1": 0.4, "z": "6 m", "H": 9.0, "n": 3}) == by_ratio
        assert Floor.parse(str(by_ratio)) == by_ratio

    def test_a_height_alone_is_refused_with_both_ways_to_write_it(self):
        z = "0.67"
        shown = run("respond", "--record", ACCEL, "--floor", f"T1=0.4,z={z},n=3", code=2).stderr
        said = " ".join(shown.split())
        assert f"z={z} has two meanings: the height of the floor needs that of the building, H" in said
        assert "give heights in metres, such as z=6m,H=9m, or their ratio, such as z/H=0.67" in said

    def test_a_floor_that_no_memory_holds(self):
        long = GroundMotion("long", 0.01, np.zeros(1_000_001), unit="m/s2")
        with pytest.raises(InputError, match=r"needs 6.4e\+07 samples"):
            Floor(1e-3, 0.05, 1, 1.5).of(long)

    def test_targets_are_of_the_ground(self):
        data = run_json("respond", "--neighbours", 0, "--record", ACCEL, "--target-pga", 0.2, "--floor", FLOOR)
        record = data["record"]
        assert record["scale"] == pytest.approx(0.2 / record["pga_g"])
        assert record["floor_pga"] > 1.1 * record["pga_g"]
        assert record["processing"] == [f"floor {FLOOR}"]

    def test_a_study_runs_on_a_floor(self, tmp_path):
        (tmp_path / "block.yaml").write_text("mechanism: block\nwidth: 0.7\nheight: 2.8\n")
        base = (
            f"structures: [block.yaml]\nrecords: [{ACCEL.as_posix()}]\nmethod: stripes\n"
            "levels: {measure: PGA, values: [0.2, 0.3, 0.5]}\n"
        )
        peaks = {}
        floors = {"ground": "", "floor": f"floor: {FLOOR}\n", "stiff": "floor: {T1: 1.0e-4, z/H: 1, n: 2}\n"}
        for name, more in floors.items():
            (tmp_path / f"{name}.yaml").write_text(base + more)
            run("fragility", tmp_path / f"{name}.yaml", "--jobs", 1)
            run("results", tmp_path / f"{name}.runs", "--out", tmp_path / f"{name}.csv")
            table = np.genfromtxt(tmp_path / f"{name}.csv", delimiter=",", names=True, dtype=None, encoding="utf-8")
            peaks[name] = table["peak_ratio"]
            assert table["PGA_g"] == pytest.approx([0.2, 0.3, 0.5])  # of the ground
        assert peaks["stiff"] == pytest.approx(peaks["ground"], rel=1e-3)
        assert (peaks["floor"] > peaks["ground"]).any()
        record = json.loads(run("results", tmp_path / "floor.runs", "--json").stdout)["records"][0]
        assert record["pga_g"] == pytest.approx(read_record(ACCEL).pga_g)


class TestTurned:
    def test_at_right_angles_they_are_themselves(self, quake):
        other = replace(quake, acceleration=quake.acceleration[::-1].copy())
        assert (turned(quake, other, 0).acceleration == quake.acceleration).all()
        assert (turned(quake, other, 90).acceleration == other.acceleration).all()
        assert (turned(quake, other, 180).acceleration == -quake.acceleration).all()
        assert (turned(quake, other, -90).acceleration == -other.acceleration).all()

    def test_between_them_they_are_a_projection(self, quake):
        other = replace(quake, acceleration=np.roll(quake.acceleration, 100))
        angle = np.radians(30)
        wanted = np.column_stack([quake.acceleration, other.acceleration]) @ [np.cos(angle), np.sin(angle)]
        assert turned(quake, other, 30).acceleration == pytest.approx(wanted)

    def test_pairs_that_do_not_go_together(self, quake):
        with pytest.raises(InputError, match=r"it has 1200 samples, accel\.csv has 1201"):
            turned(quake, replace(quake, acceleration=quake.acceleration[:-1]), 30)
        with pytest.raises(InputError, match=r"its interval is 0\.02 s"):
            turned(quake, replace(quake, dt=0.02), 30)

    @pytest.mark.parametrize(
        ("options", "words"),
        [
            (("--with", "EAST"), "--azimuth is missing"),
            (("--azimuth", "30"), "--azimuth requires a second component"),
            (("--with", "EAST", "--azimuth", "x"), "give a value such as 30"),
            (("--with", str(ACCEL), "--azimuth", "30"), "--with is the first component too"),
            (("--with", "AGAIN", "--azimuth", "30"), "give the channel of the second with --with-channel"),
            (
                ("--with", "EAST", "--azimuth", "all", "--polarity", "both"),
                "--polarity has no effect with --azimuth all",
            ),
        ],
    )
    def test_wrong_options(self, pair, options, words):
        again = EXAMPLES / ".." / EXAMPLES.name / ACCEL.name
        options = [str({"EAST": pair, "AGAIN": again}.get(each, each)) for each in options]
        assert words in run("respond", "--record", ACCEL, *options, code=2).stderr

    def test_all_is_for_respond(self, pair):
        said = run("record", ACCEL, "--with", pair, "--azimuth", "all", code=2).stderr
        assert "--azimuth can be all for `respond` only" in said


class TestAllAround:
    def test_each_direction_is_the_response_in_it(self, pair, tmp_path):
        asked = ("--record", ACCEL, "--with", pair, "--scale", 1.3)
        data = run_json("respond", *asked, "--azimuth", "all", "--out", tmp_path / "a.csv")
        for azimuth in (44, 230):
            k = data["azimuths"].index(azimuth)
            one = run_json("respond", *asked, "--azimuth", azimuth, "--neighbours", 0)["responses"]
            for model in ("nonlinear", "linear1"):
                assert data["responses"][model]["overturned"][k] == one[model]["overturned"]
                if not one[model]["overturned"]:
                    assert data["responses"][model]["peak_ratio"][k] == pytest.approx(one[model]["peak_ratio"])
        assert len((tmp_path / "a.csv").read_text().splitlines()) == 1 + len(data["responses"]) * len(data["azimuths"])

    def test_what_is_said_is_what_was_found(self, pair):
        data = run_json("respond", "--record", ACCEL, "--with", pair, "--scale", 2, "--azimuth", "all")
        for found in data["responses"].values():
            falls = sum(found["overturned"])
            assert 0 < falls < len(data["azimuths"])
            assert f"in {falls} of {len(data['azimuths'])} directions" in found["said"]
            inside = {
                azimuth
                for a, b in found["sectors_that_overturn"]
                for azimuth in data["azimuths"]
                if (a <= azimuth <= b if a <= b else azimuth >= a or azimuth <= b)
            }
            assert inside == {a for a, falls in zip(data["azimuths"], found["overturned"], strict=True) if falls}

    def test_sectors_go_over_the_end_of_the_circle(self):
        azimuths = np.arange(0.0, 360, 45)
        flags = np.array([True, False, False, True, True, False, False, True])
        assert sectors(azimuths, flags) == [(135.0, 180.0), (315.0, 0.0)]
        assert sectors(azimuths, np.ones(8, dtype=bool)) == [(0.0, 315.0)]
        assert sectors(azimuths, np.zeros(8, dtype=bool)) == []

    def test_a_structure_that_mirrors_itself_does_so_after_half_a_turn(self, quake):
        from rocking_cli import Block
        from rocking_cli.structure import Structure

        other = replace(quake, acceleration=np.roll(quake.acceleration, 50))
        found = all_around(Structure(Block(width=0.7, height=2.8)), ["nonlinear"], (quake, other), 1.0)
        peaks = found.outcomes["nonlinear"].peak_ratio
        assert peaks[: peaks.size // 2] == pytest.approx(peaks[peaks.size // 2 :], nan_ok=True)


def test_in_python(quake):
    import rocking_cli as rk

    other = rk.correct(quake, "trim 0:6", {"lowpass": 20})
    assert other.processing == ("trim 0:6", "lowpass 20")
    assert rk.on_floor(quake, FLOOR).pga_g == Floor.parse(FLOOR).of(quake).pga_g
    found = rk.respond_around(rk.Block(width=0.7, height=2.8), quake, rk.correct(quake, "lowpass 3"), model="nonlinear")
    assert list(found.to_dict()["responses"]) == ["nonlinear"]
    assert found.outcomes["nonlinear"].peak_ratio[0] == pytest.approx(
        rk.respond(rk.Block(width=0.7, height=2.8), quake, model="nonlinear")["nonlinear"].peak_ratio
    )
    assert found.figure().axes


def test_the_ground_below_a_floor_is_turned_with_it(quake):
    """Two components of a floor, at 30 degrees: below it is the ground at 30 degrees, by whose peak it is scaled."""
    other = replace(quake, acceleration=0.6 * quake.acceleration[::-1])
    floor = Floor.parse(FLOOR)
    found = turned(floor.of(quake), floor.of(other), 30.0)
    below = sqrt(3) / 2 * quake.acceleration + 0.3 * quake.acceleration[::-1]
    assert found.ground.acceleration == pytest.approx(below, abs=1e-12)
    assert found.of_ground.pga_g == pytest.approx(abs(below).max() / 9.80665, rel=1e-12)

"""The dynamic method: histories with a confidence factor against an integration of their own, and what they say."""

from dataclasses import replace
from math import atan, cos, sin, sqrt, tan

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import rocking_cli as rk
from rocking_cli.codes.italian import dynamic
from rocking_cli.codes.italian.capacity import ExactCurve
from rocking_cli.codes.italian.chain import Chain
from rocking_cli.codes.italian.results import Dynamic, RecordPeak
from rocking_cli.codes.italian.sheet.steps import TERMINAL
from rocking_cli.codes.italian.sheet.summary import histories as items
from rocking_cli.core import Direction
from rocking_cli.dynamics.history import follow
from rocking_cli.structure import Structure
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES

G, B, H = 9.80665, 0.3, 4.0
ALPHA, R = atan(B / H), sqrt(B**2 + H**2)
FACADE = rk.Block(width=2 * B, height=2 * H, one_sided="positive", rebound=0.0)
WALL = Structure(FACADE)
MODEL = WALL.model("nonlinear")
SITE = "FC: 1.35\nag: 0.2\nF0: 2.5\nTC: 0.4\nS: 1.2\n"


def curves(FC):
    chain = Chain(FACADE, Direction.POSITIVE)
    return {Direction.POSITIVE: ExactCurve(chain, chain.barycentre, FC)}


def first_excursion(ag, period, FC):
    """The peak rotation of the block under a half sine to the left: V'/FC holds it back, the rest is its own."""
    start = period / np.pi * np.arcsin(tan(ALPHA) / FC / ag)
    p2 = 3 * G / (4 * R)

    def rates(t, state):
        push = ag * sin(np.pi * t / period) if t < period else 0.0
        return [state[1], p2 * (-sin(ALPHA - state[0]) / FC + cos(ALPHA - state[0]) * push)]

    def top(t, state):
        return state[1]

    top.terminal, top.direction = True, -1
    found = solve_ivp(rates, (start, 60.0), [0.0, 1e-12], events=top, rtol=1e-10, atol=1e-14, max_step=0.01)
    return float(found.y[0, -1])


@pytest.mark.parametrize("FC", [1.0, 1.2, 1.35])
@pytest.mark.parametrize(("ag", "period"), [(0.15, 0.3), (0.1, 0.5)])
def test_the_peak_is_that_of_the_equation_with_what_holds_it_divided(ag, period, FC):
    pulse = rk.parse_pulse(f"half_sine:{ag}g:{2 * period}s")
    lasts = pulse.duration
    found = dynamic.peaks(WALL, curves(FC), pulse.sampled(), (-1,))[Direction.POSITIVE]
    phi = first_excursion(ag, lasts, FC)
    assert found.with_confidence == pytest.approx(H * sin(phi) + B * (1 - cos(phi)), rel=2e-4)
    alone = first_excursion(ag, lasts, 1.0)
    assert found.without == pytest.approx(H * sin(alone) + B * (1 - cos(alone)), rel=2e-4)
    assert (found.with_confidence == found.without) == (FC == 1)


def test_without_the_factor_it_is_respond_on_the_same_runs():
    motion = rk.read_record(EXAMPLES / "accel.csv").scaled(0.2)
    found = dynamic.peaks(WALL, curves(1.35), motion, (1, -1))[Direction.POSITIVE]
    phi = max(follow(MODEL, motion.scaled(sign)).peak_positive for sign in (1, -1))
    assert found.without == pytest.approx(H * sin(phi) + B * (1 - cos(phi)), rel=1e-12)
    one, other = (dynamic.peaks(WALL, curves(1.35), motion, (sign,))[Direction.POSITIVE] for sign in (1, -1))
    assert one.without != other.without and found.without == max(one.without, other.without)
    assert dynamic.peaks(WALL, curves(1.35), motion, (-1, 1))[Direction.POSITIVE].without == found.without


def test_the_vertical_component_keeps_its_size_and_its_pace_with_the_other():
    motion = rk.parse_pulse("sine:0.2g:0.8s").sampled()
    both = dynamic.with_confidence(replace(motion, vertical=motion), 1.44)
    assert both.vertical.duration == pytest.approx(both.duration)
    assert both.duration == pytest.approx(motion.duration / 1.2)
    assert np.allclose(both.acceleration, 1.44 * motion.acceleration)
    assert np.array_equal(both.vertical.acceleration, motion.acceleration)


@pytest.mark.parametrize("FC", [1.0, 1.2, 1.35])
class TestUntilWhen:
    """With FC the motion runs sqrt(FC) times as fast; what is said of it is a time of the record."""

    def test_weight_is_gone_at_the_moment_of_the_record_at_which_the_ground_falls_away(self, FC):
        """v_g'' falls to -2 g in 2 s: nothing holds the block down from 1 s on, whatever FC."""
        up = rk.GroundMotion("up", 0.01, -2 * G * np.linspace(0.0, 1.0, 201), unit="m/s2")
        motion = rk.GroundMotion("falls", 0.01, np.full(201, 0.01 * G), vertical=up, unit="m/s2")
        found = dynamic.peaks(WALL, curves(FC), motion, (1, -1))[Direction.POSITIVE]
        assert found.known_to_without == pytest.approx(1.0, rel=1e-9)
        assert found.known_to_with_confidence == pytest.approx(1.0, rel=1e-9)
        assert found.with_confidence is found.without is None

    @pytest.mark.parametrize("ends", [{1: 150, -1: 90}, {1: 90, -1: 150}, {1: 90}, {-1: 90}])
    def test_of_both_polarities_it_is_the_earlier_one(self, FC, ends, monkeypatch):
        """Either history ends at a sample of the record, or is known to its end."""

        def follows(structure, motion):
            sample = ends.get(int(np.sign(motion.acceleration[1])))
            rested = follow(MODEL, None, release=0.1)
            return replace(rested, unknown=True, known_to=sample * motion.dt) if sample else rested

        monkeypatch.setattr(dynamic, "follow", follows)
        motion = rk.GroundMotion("push", 0.01, np.array([0.0, 1.0, 0.0]), unit="m/s2")
        found = dynamic.peaks(WALL, curves(FC), motion, (1, -1))[Direction.POSITIVE]
        assert found.known_to_without == pytest.approx(0.9)
        assert found.known_to_with_confidence == pytest.approx(0.9)


ALLOWED = {"SLV": 0.12, "SLC": 0.18}


def seen(*pairs, d0=0.3, state="SLV"):
    records = [RecordPeak(f"r{k}", *pair) for k, pair in enumerate(pairs)]
    return Dynamic(state, records, d0, ALLOWED[state], 7)


def test_records_whose_mean_is_below_the_spectrum_of_the_site_are_a_condition():
    """Sa of seven pulses at T_SLV, by an oscillator, over that of the site by the formula of its last branches."""
    site = {"FC": 1.35, "ag": 0.1, "F0": 2.5, "TC": 0.4, "S": 1.2}
    T = rk.verify(FACADE, site).directions[Direction.POSITIVE].states["SLV"].T
    fall = min(1.0, (4 * 0.1 + 1.6) / T)
    target = 0.1 * 1.2 * 2.5 * 0.4 / T * fall
    pulses = [f"sine:{0.03 + k / 1000}g:0.9s" for k in range(7)]
    own = [float(rk.response_spectrum(rk.parse_pulse(each).sampled(), periods=[T]).sa[0]) for each in pulses]
    share = np.mean(own) / target
    for factor, is_one in ((0.89 / share, True), (0.91 / share, False)):
        scaled = [f"sine:{factor * (0.03 + k / 1000)}g:0.9s" for k in range(7)]
        found = rk.verify(FACADE, site, motions=scaled)
        told = {each.key: each for each in found.remarks if hasattr(each, "key")}
        assert ("below_target" in told) == is_one
    few = rk.verify(FACADE, site, motions=pulses[:6])
    assert all(getattr(each, "key", "") != "below_target" for each in few.remarks)


def test_a_tie_that_yields_is_the_reason_why_an_outcome_is_unknown():
    tie = {"name": "bar", "from": {"ground": [-5, 7.5]}, "to": {"at": [-B, 7.5]}, "bars": 1, "diameter": 0.01,
           "steel": "S235"}  # fmt: skip
    tied = rk.Block(name="w", width=2 * B, height=2 * H, density=1800, depth=5, one_sided="positive", rebound=0.4,
                    ties=[tie])  # fmt: skip
    site = {"FC": 1.35, "ag": 0.2, "F0": 2.5, "TC": 0.4, "S": 1.2}
    found = rk.verify(tied, site, motions="sine:0.4g:1s", polarity="-1")
    said = " ".join(found.sentences)
    assert "as the tie bar reaches its strength" in said and "joint opens" not in said


class TestVerdicts:
    def test_the_mean_counts_and_no_record_may_pass(self):
        found = seen((0.10, 0.05), (0.13, 0.05))
        assert found.mean(confident=True) == pytest.approx(0.115)
        assert found.holds(confident=True)
        past = seen((0.10, 0.05), (0.30, 0.05))
        assert past.mean(confident=True) is None and past.passed(confident=True) == ["r1"]
        assert not past.holds(confident=True) and past.holds(confident=False)
        assert seen((None, 0.1)).passed(confident=True) == ["r0"]
        assert not seen((0.15, 0.15)).holds(confident=True)
        assert seen((0.15, 0.15), state="SLC").holds(confident=True)

    @pytest.mark.parametrize(
        ("pairs", "state", "FC", "said"),
        [
            ([(0.15, 0.05)] * 2, "SLV", 1.35, {"exceeds 0.12 m", "within 0.12 m", "FC changes", "Only 2 records"}),
            ([(0.1, 0.05)] * 7, "SLV", 1.35, {"within 0.12 m"}),
            ([(None, 0.05)], "SLV", 1.35, {"exceeded under r0", "within 0.12 m", "FC changes", "Only one record"}),
            ([(0.15, 0.05)], "SLC", 1.35, {"within 0.18 m", "Only one record"}),
            ([(0.1, 0.1)], "SLV", 1.0, {"within 0.12 m", "Only one record"}),
        ],
    )
    def test_words_follow_the_numbers(self, pairs, state, FC, said):
        found = " ".join(getattr(each, "text", "") for each in items(TERMINAL, seen(*pairs, state=state), FC))
        every = {"exceeds 0.12 m", "within 0.12 m", "within 0.18 m", "FC changes", "Only 2 records", "Only one record",
                 "exceeded under r0"}  # fmt: skip
        assert {each for each in every if each in found} == said
        assert {each for each in ("SLV", "SLC") if each in found} == {state} and ("Without FC" in found) == (FC > 1)


class TestTheCommand:
    @pytest.fixture(autouse=True)
    def _files(self, tmp_path):
        (tmp_path / "site.yaml").write_text(SITE, encoding="utf-8")
        text = f"mechanism: block\nwidth: {2 * B}\nheight: {2 * H}\nname: facade\n"
        (tmp_path / "b.yaml").write_text(text, encoding="utf-8")

    def test_every_record_in_both_directions(self):
        pulses = ("--pulse", "half_sine:0.15g:0.6s", "--pulse", "half_sine:0.1g:1s")
        data = run_json("verify", "b.yaml", "--site", "site.yaml", *pulses)
        for side in data["directions"].values():
            found = side["dynamic"]["SLV"]
            assert len(found["records"]) == 2 and found["wanted"] == 7
            peaks = [each["d_with_FC"] for each in found["records"]]
            assert found["with_FC"]["mean"] == pytest.approx(sum(peaks) / 2)
            assert found["with_FC"]["holds"] == (found["with_FC"]["mean"] <= side["states"]["SLV"]["d"])
        # A push to the right tips it to the left.
        negative = data["directions"]["negative"]["dynamic"]["SLV"]["records"]
        assert negative[0]["d_with_FC"] > negative[0]["d_without_FC"] > 0

    def test_histories_have_a_table_and_a_verdict(self):
        text = run(
            "verify", "b.yaml", "--site", "site.yaml", "--pulse", "sine:2g:1.5s", "--polarity", "both", "--all"
        ).stdout
        assert "overturns" in text and "With FC, SLV: not satisfied." in text

    def test_a_polarity_needs_a_motion(self):
        said = run("verify", "--site", "site.yaml", "--polarity", "-1", code=2).stderr
        assert "--polarity has no effect without ground motions" in said


PARAPET = rk.Block(width=0.3, height=1.2, density=1800.0, depth=1.0)
ON_FLOOR = {"FC": 1.35, "ag": 0.2, "F0": 2.5, "TC": 0.4, "S": 1.2, "soil": "B"}
FLOOR = {"z": 6.0, "H": 9.0, "T1": 0.4, "xi1": 0.05, "n": 3}
SLC = {"ag": 0.26, "F0": 2.5, "TC": 0.42, "S": 1.2}


def dynamics(site, *motions, **options):
    found = rk.verify(PARAPET, site, motions=motions, **options)
    (state,) = {state for each in found.directions.values() for state in each.dynamic}
    return [each.dynamic[state] for each in found.directions.values()], found


class TestWhereAndWhen:
    """Records are those of the ground, unless said otherwise, and of one limit state."""

    @pytest.fixture
    def accel(self):
        motion = rk.read_record(EXAMPLES / "accel.csv")
        return motion.scaled(0.24 / motion.pga_g)

    def test_ground_records_go_through_the_floor_of_the_site(self, accel):
        """Against motions carried by `rk.on_floor`: what hardly moves on the ground overturns on the floor."""
        pulse = rk.parse_pulse("sine:0.24g:0.45s").sampled()
        below, _ = dynamics(ON_FLOOR, accel, pulse)
        assert all(each.holds(confident=True) for each in below)
        assert max(each.peaks(confident=True)[0] for each in below) < 0.003
        place = f"T1=0.4,xi=0.05,z/H={6 / 9},n=3"
        wanted, _ = dynamics(ON_FLOOR, rk.on_floor(accel, place), rk.on_floor(pulse, place))
        above, answer = dynamics({**ON_FLOOR, "floor": FLOOR}, accel, pulse)
        assert [each.peaks(confident=True) for each in above] == [each.peaks(confident=True) for each in wanted]
        assert min(each.peaks(confident=True)[0] for each in above) > 0.04
        assert [each.peaks(confident=True)[1] is None for each in above] == [True, False]
        assert not above[0].holds(confident=True)
        said = " ".join(answer.sentences)
        assert "carried to the floor by the first mode of the building: T1=0.4,xi=0.05,z/H=0.66" in said
        found = answer.to_dict()["directions"]["positive"]["dynamic"]["SLV"]
        assert found["motions"] == "carried_to_floor" and found["floor"].startswith("T1=0.4,xi=0.05,z/H=0.66")

    def test_motions_of_the_floor_are_taken_as_they_are(self, accel):
        below, _ = dynamics(ON_FLOOR, accel)
        stated, answer = dynamics({**ON_FLOOR, "floor": FLOOR}, accel, on_floor=True)
        assert [each.records for each in stated] == [each.records for each in below]
        assert "taken as motions of the floor" in " ".join(answer.sentences)
        carried = rk.on_floor(accel, "T1=0.3,xi=0.05,z/H=1,n=3")
        by_option, _ = dynamics({**ON_FLOOR, "floor": FLOOR}, carried)
        assert by_option[0].motions.kind == "carried_by_option" and "T1=0.3" in by_option[0].motions.floor
        wanted, _ = dynamics(ON_FLOOR, carried)
        assert [each.records for each in by_option] == [each.records for each in wanted]

    def test_what_cannot_be_of_the_floor_is_refused(self, accel):
        with pytest.raises(rk.InputError, match="`on_floor` requires a site with a floor"):
            dynamics(ON_FLOOR, accel, on_floor=True)
        carried, site = rk.on_floor(accel, "T1=0.3,xi=0.05,z/H=1,n=3"), {**ON_FLOOR, "floor": FLOOR}
        with pytest.raises(rk.InputError, match="`on_floor` cannot be combined with `floor`"):
            dynamics(site, carried, on_floor=True)
        with pytest.raises(rk.InputError, match="some of the motions are of a floor"):
            dynamics(site, carried, accel)

    def test_the_mode_is_that_of_the_limit_state(self, accel):
        floor = {**FLOOR, "T1": 0.6, "xi1": 0.1, "SLC": {"T1": 0.4, "xi1": 0.05}}
        own, _ = dynamics({**ON_FLOOR, "SLC": SLC, "floor": floor}, accel, state="SLC")
        single, _ = dynamics({**ON_FLOOR, "floor": FLOOR}, accel)
        assert [each.records for each in own] == [each.records for each in single]

    def test_a_set_of_records_verifies_one_limit_state(self, accel):
        for state, found in (("SLV", {}), ("SLC", {"state": "SLC"})):
            sides, answer = dynamics({**ON_FLOOR, "SLC": SLC}, accel, **found)
            data = answer.to_dict()["directions"]["positive"]["dynamic"]
            d = answer.directions[Direction.POSITIVE].states[state].d
            assert list(data) == [state] and data[state]["capacity"] == sides[0].allowed == d
            other = {"SLV": "SLC", "SLC": "SLV"}[state]
            said = [each for each in answer.sentences if "record" in each and "d0*" in each]
            assert said and not any(other in each for each in said)

    def test_a_limit_state_that_the_site_does_not_give_is_refused(self, accel):
        with pytest.raises(rk.InputError, match="SLC is not given by the site"):
            dynamics(ON_FLOOR, accel, state="SLC")
        with pytest.raises(rk.InputError, match="'SLD' is not a limit state of displacement"):
            dynamics(ON_FLOOR, accel, state="SLD")

    def test_both_are_options_of_the_command_and_on_the_sheet(self, tmp_path):
        (tmp_path / "s.yaml").write_text(SITE + f"floor: {FLOOR}\n".replace("'", ""), encoding="utf-8")
        (tmp_path / "b.yaml").write_text("mechanism: block\nwidth: 0.3\nheight: 1.2\n", encoding="utf-8")
        asked = ("verify", tmp_path / "b.yaml", "--site", tmp_path / "s.yaml")
        found = run_json(*asked, "--pulse", "sine:0.1g:0.3s", "--sheet", tmp_path / "o.html")
        assert found["directions"]["positive"]["dynamic"]["SLV"]["motions"] == "carried_to_floor"
        page = (tmp_path / "o.html").read_text(encoding="utf-8")
        assert "carried to the floor by the first mode of the building: T1=0.4" in page and "verify no other" in page
        found = run_json(*asked, "--pulse", "sine:0.1g:0.3s", "--on-floor")
        assert found["directions"]["positive"]["dynamic"]["SLV"]["motions"] == "of_floor"
        assert "--state: SLC is not given by the site" in run(*asked, "--pulse", "sine:0.1g:0.3s", "--state", "SLC",
                                                            code=2).stderr  # fmt: skip
        assert "--on-floor has no effect without ground motions" in run(*asked, "--on-floor", code=2).stderr

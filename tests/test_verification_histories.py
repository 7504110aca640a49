"""The dynamic method: histories with a confidence factor against an integration of their own, and what they say."""

from __future__ import annotations

from dataclasses import replace
from math import atan, cos, sin, sqrt, tan

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import rocking_cli as rk
from rocking_cli.core import Direction
from rocking_cli.dynamics.history import follow
from rocking_cli.dynamics.model import build_model
from rocking_cli.studies.verification import dynamic
from rocking_cli.studies.verification.capacity import ExactCurve
from rocking_cli.studies.verification.chain import Chain
from rocking_cli.studies.verification.results import Dynamic, RecordPeak
from rocking_cli.views.verification_words import of_histories
from tests.conftest import EXAMPLES
from tests.test_cli import run, run_json

G, B, H = 9.80665, 0.3, 4.0
ALPHA, R = atan(B / H), sqrt(B**2 + H**2)
FACADE = rk.Block(width=2 * B, height=2 * H, one_sided="positive", rebound=0.0)
MODEL = build_model(FACADE, "nonlinear")
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
    found = dynamic.peaks(MODEL, curves(FC), pulse.sampled(), (-1,))[Direction.POSITIVE]
    phi = first_excursion(ag, lasts, FC)
    assert found.with_confidence == pytest.approx(H * sin(phi) + B * (1 - cos(phi)), rel=2e-4)
    alone = first_excursion(ag, lasts, 1.0)
    assert found.without == pytest.approx(H * sin(alone) + B * (1 - cos(alone)), rel=2e-4)
    assert (found.with_confidence == found.without) == (FC == 1)


def test_without_the_factor_it_is_respond_on_the_same_runs():
    motion = rk.read_record(EXAMPLES / "accel.csv").scaled(0.2)
    found = dynamic.peaks(MODEL, curves(1.35), motion, (1, -1))[Direction.POSITIVE]
    phi = max(follow(MODEL, motion.scaled(sign)).peak_positive for sign in (1, -1))
    assert found.without == pytest.approx(H * sin(phi) + B * (1 - cos(phi)), rel=1e-12)
    one, other = (dynamic.peaks(MODEL, curves(1.35), motion, (sign,))[Direction.POSITIVE] for sign in (1, -1))
    assert one.without != other.without and found.without == max(one.without, other.without)
    assert dynamic.peaks(MODEL, curves(1.35), motion, (-1, 1))[Direction.POSITIVE].without == found.without


def test_the_vertical_component_keeps_its_size_and_its_pace_with_the_other():
    motion = rk.parse_pulse("sine:0.2g:0.8s").sampled()
    both = dynamic.with_confidence(replace(motion, vertical=motion), 1.44)
    assert both.vertical.duration == pytest.approx(both.duration)
    assert both.duration == pytest.approx(motion.duration / 1.2)
    assert np.allclose(both.acceleration, 1.44 * motion.acceleration)
    assert np.array_equal(both.vertical.acceleration, motion.acceleration)


def seen(*pairs, d0=0.3):
    records = [RecordPeak(f"r{k}", *pair) for k, pair in enumerate(pairs)]
    return Dynamic(records, d0, {"SLV": 0.12, "SLC": 0.18}, 7)


class TestVerdicts:
    def test_the_mean_counts_and_no_record_may_pass(self):
        found = seen((0.10, 0.05), (0.13, 0.05))
        assert found.mean(confident=True) == pytest.approx(0.115)
        assert found.holds("SLV", confident=True) and found.holds("SLC", confident=True)
        past = seen((0.10, 0.05), (0.30, 0.05))
        assert past.mean(confident=True) is None and past.passed(confident=True) == ["r1"]
        assert not past.holds("SLC", confident=True) and past.holds("SLV", confident=False)
        assert seen((None, 0.1)).passed(confident=True) == ["r0"]
        between = seen((0.15, 0.15))
        assert not between.holds("SLV", confident=True) and between.holds("SLC", confident=True)

    def test_words_follow_the_numbers(self):
        said = " ".join(of_histories(seen((0.15, 0.05), (0.15, 0.05)), 1.35))
        assert (
            "With FC: no record takes the structure past d0* = 0.3 m; the mean peak displacement, 0.15 m, is beyond "
            "d_SLV = 0.12 m"
        ) in said
        assert "within d_SLC = 0.18 m." in said and "The confidence factor FC changes the verdict at SLV." in said
        assert "Only 2 records were used: the code requires at least 7" in said
        said = " ".join(of_histories(seen(*[(0.1, 0.05)] * 7), 1.35))
        assert "changes the verdict" not in said and "requires at least" not in said
        said = " ".join(of_histories(seen((None, 0.05)), 1.35))
        assert "not satisfied. r0 takes the structure past d0*" in said and "SLV and SLC" in said
        assert "Only one record was used" in said
        assert "Without FC" not in " ".join(of_histories(seen((0.1, 0.1)), 1.0))


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
            found = side["dynamic"]
            assert len(found["records"]) == 2 and found["wanted"] == 7
            peaks = [each["d_with_FC"] for each in found["records"]]
            assert found["with_FC"]["mean"] == pytest.approx(sum(peaks) / 2)
            assert found["with_FC"]["holds"]["SLV"] == (found["with_FC"]["mean"] <= side["states"]["SLV"]["d"])
        negative = data["directions"]["negative"]["dynamic"]["records"]  # a push to the right tips it to the left
        assert negative[0]["d_with_FC"] > negative[0]["d_without_FC"] > 0

    def test_histories_have_a_table_and_a_verdict(self):
        text = run("verify", "b.yaml", "--site", "site.yaml", "--pulse", "sine:2g:1.5s", "--polarity", "both").stdout
        assert "overturns" in text and "With FC: not satisfied." in text

    def test_a_polarity_needs_a_motion(self):
        assert "--polarity reverses" in run("verify", "--site", "site.yaml", "--polarity", "-1", code=2).stderr

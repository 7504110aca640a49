"""Sets of records for a target spectrum, against all sets tried one by one in the plainest way."""

from itertools import combinations

import numpy as np
import pytest

from rocking_cli.errors import InputError
from rocking_cli.excitation.base import GroundMotion, Origin
from rocking_cli.plotting import style
from rocking_cli.processing.oscillator import response_spectrum
from rocking_cli.questions.select import subsets
from rocking_cli.questions.select.study import (
    Candidates,
    SetRequirements,
    candidates,
    choose,
    coarse,
    log_weights,
    own_factors,
    periods_of,
)
from rocking_cli.questions.select.target_spectrum import TargetSpectrum, read_target
from rocking_cli.questions.select.view import ShownSet, draw_record_set, ratio_in_words, view

BAND = (0.2, 2.0)
CODE = TargetSpectrum("code", np.array([0.0, 0.15, 0.5, 1.0, 2.0, 4.0]), np.array([0.3, 0.75, 0.75, 0.375, 0.19, 0.05]))
POLICIES = {"one per event": {}, "any": {"one_per": "none"}, "narrow factors": {"factors": (0.5, 1.6)},
            "same factor": {"same_factor": True, "factors": (0.01, 100.0)},
            "one per station": {"one_per": "station"},
            "above the target": {"within": (1.2, 1.5), "factors": (0.5, 1.6)}}  # fmt: skip


def motion(name: str, event: str | None = None, station: str | None = None, dt: float = 0.01) -> GroundMotion:
    return GroundMotion(name, dt, np.array([0.0, 1.0, 0.0]), origin=Origin(event, station), unit="m/s2")


def made(count: int, seed: int, rough: float, scatter: float = 0.4) -> Candidates:
    """Smooth random spectra about the code's: every second pair shares an event, every third a station."""
    rng = np.random.default_rng(seed)
    periods = np.geomspace(*BAND, 24)
    target = CODE.at(periods)
    waves = sum(rough / k * np.cos(k * np.log(periods / 0.2) * 2 + rng.uniform(0, 6, (count, 1))) for k in (1, 2, 3, 4))
    spectra = target * np.exp(waves + scatter * rng.standard_normal((count, 1)))
    motions = [
        motion(f"r{k}", None if k % 4 == 3 else f"Event {k // 2}", None if k % 5 == 4 else f"Station {k % 3}")
        for k in range(count)
    ]
    return Candidates(motions, periods, target, spectra)


def by_brute_force(found: Candidates, wanted: SetRequirements) -> tuple[float, float, int]:
    """Excess and rms of the best set, trying common factors one by one; and how many sets there are."""
    periods, target = found.periods, found.target
    low, high = wanted.factors

    def mean(values):  # over ln T
        return np.trapezoid(values, np.log(periods), axis=-1) / np.log(periods[-1] / periods[0])

    own = np.array([np.exp(mean(np.log(target / s))) for s in found.spectra])
    if wanted.same_factor:
        own[:] = 1.0
    usable = [k for k in range(len(own)) if low <= own[k] <= high]
    best, sets = (np.inf, np.inf), 0
    for members in combinations(usable, wanted.count):
        origins = [found.motions[k].origin for k in members]
        said = [name for o in origins if (name := o.event if wanted.one_per == "event" else o.station) is not None]
        if wanted.one_per != "none" and len(set(said)) < len(said):
            continue
        sets += 1
        ratio = np.mean([own[k] * found.spectra[k] / target for k in members], axis=0)
        chosen = own[list(members)]
        common = np.geomspace(low / chosen.min(), high / chosen.max(), 1001 if high > 10 else 401)
        moved = common[:, None] * ratio
        below, above = np.log(wanted.within[0] / moved.min(axis=1)), np.log(moved.max(axis=1) / wanted.within[1])
        excess = np.maximum(np.maximum(below, above), 0.0)
        best = min(best, *zip(excess.tolist(), np.sqrt(mean(np.log(moved) ** 2)).tolist(), strict=True))
    return *best, sets


@pytest.mark.every(2)
@pytest.mark.parametrize("policy", POLICIES)
@pytest.mark.parametrize(("seed", "rough"), [(1, 0.25), (5, 0.9)])
def test_the_best_of_all_sets_is_that_of_brute_force(policy, seed, rough):
    found, wanted = made(8, seed, rough), SetRequirements(3, BAND, **POLICIES[policy])
    try:
        chosen = choose(found, wanted)
    except InputError:
        assert by_brute_force(found, wanted)[2] == 0
        return
    excess, rms, sets = by_brute_force(found, wanted)
    step = np.log(1e4) / 1000 if policy == "same factor" else np.log(25) / 400  # between the factors tried
    ratio = np.log(chosen.ratio)
    ours = max(np.log(wanted.within[0]) - ratio.min(), ratio.max() - np.log(wanted.within[1]), 0.0)
    assert ours <= excess + 1e-9  # no worse than any that was tried
    assert excess <= ours + step
    if chosen.fits and excess == 0:
        spread = np.sqrt(log_weights(found.periods) @ ratio**2)
        assert spread <= rms + 1e-9
        assert rms <= spread + step
    assert chosen.exact
    assert chosen.sets == sets


@pytest.mark.parametrize("policy", ["narrow factors", "same factor", "one per station"])
def test_a_set_keeps_to_what_is_asked(policy):
    found, wanted = made(12, 7, 0.3, scatter=0.6), SetRequirements(4, BAND, **POLICIES[policy])
    chosen = choose(found, wanted)
    assert len(set(chosen.chosen.tolist())) == 4
    assert (chosen.factors >= wanted.factors[0] * (1 - 1e-12)).all()
    assert (chosen.factors <= wanted.factors[1] * (1 + 1e-12)).all()
    if wanted.one_per != "none":
        said = [getattr(found.motions[k].origin, wanted.one_per) for k in chosen.chosen]
        said = [each for each in said if each is not None]
        assert len(set(said)) == len(said)
    if wanted.same_factor:
        assert np.ptp(chosen.factors) < 1e-12
    assert [motion.name.partition(" x ")[0] for motion in chosen.motions] == [f"r{k}" for k in chosen.chosen]
    np.testing.assert_allclose(chosen.mean, (chosen.factors[:, None] * found.spectra[chosen.chosen]).sum(0) / 4)


@pytest.mark.parametrize("seed", [0, 3])
def test_searches_come_close_to_the_best_of_all(seed, monkeypatch):
    found, wanted = made(14, seed, 0.4), SetRequirements(5, BAND, seed=seed)
    best = choose(found, wanted)
    monkeypatch.setattr(subsets, "MAX_SETS", 10)
    searched = choose(found, wanted)
    assert (best.exact, searched.exact) == (True, False)
    again = choose(found, wanted)
    assert searched.chosen.tolist() == again.chosen.tolist()  # the same seed

    def rms(one):
        return np.sqrt(log_weights(found.periods) @ np.log(one.ratio) ** 2)

    assert searched.fits == best.fits
    assert rms(best) <= rms(searched) + 1e-9
    assert rms(searched) <= 1.05 * rms(best)


def test_large_sets_are_not_all_tried(monkeypatch):
    groups = np.arange(602)
    assert subsets.count_sets(groups, 600) == 180901
    assert not subsets.all_tried(groups, 600)
    assert subsets.all_tried(np.arange(20), 7)
    monkeypatch.setattr(subsets, "MEMBERS_PER_BLOCK", 7)  # in small blocks the same set is found
    found, wanted = made(9, 2, 0.3), SetRequirements(3, BAND)
    small = choose(found, wanted).chosen.tolist()
    monkeypatch.undo()
    assert small == choose(found, wanted).chosen.tolist()


def test_of_sets_that_are_alike_the_first_is_taken_whatever_the_last_bits():
    found = made(6, 3, 0.3)
    twice = np.concatenate([found.spectra[:3], found.spectra[:3]])
    motions = [motion(f"r{k}") for k in range(6)]
    for shift in (0.0, 1e-13, -1e-13):
        spectra = twice * np.where(np.arange(6) < 3, 1.0, 1 + shift)[:, None]
        chosen = choose(Candidates(motions, found.periods, found.target, spectra), SetRequirements(2, BAND))
        pair = chosen.chosen.tolist()
        assert pair in ([0, 1], [0, 2], [1, 2], [0, 3], [1, 4], [2, 5])
        exact = choose(Candidates(motions, found.periods, found.target, twice), SetRequirements(2, BAND))
        assert pair == exact.chosen.tolist()


def test_the_better_set_is_within_the_limits_first_then_near_then_first():
    def best(excess, rms, *members):
        return subsets.Best(np.array(members), excess, rms, 1.0)

    assert best(0.0, 0.5, 3, 4).better(best(0.1, 0.1, 1, 2))
    assert best(0.0, 0.1, 3, 4).better(best(0.0, 0.2, 1, 2))
    assert best(1e-12, 0.1, 3, 4).better(best(0.0, 0.2, 1, 2))
    assert not best(0.0, 0.1, 3, 4).better(best(1e-12, 0.1 + 1e-12, 1, 2))
    assert best(1e-12, 0.1 + 1e-12, 1, 2).better(best(0.0, 0.1, 3, 4))
    assert not best(0.0, 0.1, 3, 4).better(best(0.0, 0.1, 3, 4))


def test_each_record_is_the_target_on_logarithmic_average():
    found = made(5, 1, 0.9)
    factors, left_out = own_factors(found, SetRequirements(3, BAND, factors=(0.01, 100.0)))
    off = np.trapezoid(np.log(factors[:, None] * found.spectra / found.target), np.log(found.periods), axis=-1)
    assert not left_out and off == pytest.approx(0, abs=1e-9)


def test_a_record_out_of_reach_is_left_out_and_said():
    found = made(5, 1, 0.1)
    found.spectra[1] /= 100
    found.spectra[2, 3] = 0.0
    chosen = choose(found, SetRequirements(3, BAND))
    assert set(chosen.left_out) == {1, 2}
    assert chosen.left_out[1] > 5 and chosen.left_out[2] is None
    assert chosen.silent == 1
    said = [part for part in view(ShownSet(chosen, CODE, [None] * 5)).parts if isinstance(part, str)]
    assert any("r1: it needs a factor of" in part for part in said)
    assert any("1 of 5 records gives no earthquake; it counts as a separate earthquake." in part for part in said)


@pytest.mark.parametrize(
    ("count", "more", "message", "hint"),
    [
        (6, {}, "5 records are available", "give more records"),
        (4, {"one_per": "station"}, "one per station leaves 4", "`one_per` none"),
        (3, {"factors": (50.0, 60.0)}, "of which 0 can be scaled", "`factors`"),
    ],
)
def test_too_few_records(count, more, message, hint):
    found = made(5, 1, 0.1)
    if more.get("one_per") == "station":
        count = 5
    with pytest.raises(InputError) as caught:
        choose(found, SetRequirements(count, BAND, **more))
    (problem,) = caught.value.problems
    assert message in problem.message
    assert hint in problem.hint
    assert problem.field == "`count`"


# --- words ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("seed", "rough", "fits"), [(1, 0.12, True), (3, 0.9, False)])
def test_the_sentence_says_what_the_numbers_say(seed, rough, fits):
    found = made(8, seed, rough)
    chosen = choose(found, SetRequirements(3, BAND, one_per="none"))
    ratio = np.mean(chosen.factors[:, None] * found.spectra[chosen.chosen], axis=0) / found.target
    shown = view(ShownSet(chosen, CODE, [None] * 8))
    said = shown.data()["verdict"]
    assert chosen.fits is fits
    assert said in shown.parts
    assert f"{ratio.min():#.3g} times the target, at {found.periods[ratio.argmin()]:.3g} s" in said
    assert f"{ratio.max():#.3g} times, at {found.periods[ratio.argmax()]:.3g} s" in said
    assert ("fits: at 24 periods from 0.2 to 2 s" in said) is fits
    assert said.startswith("No set fits") is not fits
    assert (f"below {0.9:g}" in said) == bool((ratio < 0.9).any())
    assert ("above 1.3" in said) == bool((ratio > 1.3).any())
    outside = [f"{period:.3g}" for period, each in zip(found.periods, ratio, strict=True) if not 0.9 <= each <= 1.3]
    if outside:
        spans = said.partition("that is ")[2]
        assert outside[0] in spans
        assert outside[-1] in spans
    assert "best of all 56 sets" in " ".join(part for part in shown.parts if isinstance(part, str))


@pytest.mark.parametrize(
    ("value", "shown"),
    [(1.2345, "1.23"), (0.9, "0.900"), (0.8996, "0.8996"), (1.3004, "1.3004"), (1.3, "1.30"), (0.89999, "0.89999")],
)
def test_a_ratio_is_shown_on_its_side_of_the_limits(value, shown):
    assert ratio_in_words(value, (0.9, 1.3)) == shown


def test_the_picture_shows_the_mean_and_marks_where_it_does_not_fit():
    chosen = choose(made(8, 3, 0.9), SetRequirements(3, BAND, one_per="none"))
    (axes,) = draw_record_set(chosen, "a title").axes
    lines = {line.get_color(): line for line in axes.lines if line.get_linewidth() > 2}
    np.testing.assert_allclose(lines[style.MEAN].get_ydata(), chosen.mean)
    marked = next(line for line in axes.lines if line.get_marker() == "x")
    outside = (chosen.ratio < 0.9) | (chosen.ratio > 1.3)
    np.testing.assert_allclose(marked.get_xdata(), chosen.candidates.periods[outside])
    assert len(axes.lines) == 3 + 3  # the records, and target, mean and marks


# --- periods and spectra --------------------------------------------------------------------------------------------


def test_periods_are_the_band_and_the_points_of_the_target():
    target = TargetSpectrum("t", np.array([0.1, 0.2, 0.3, 1.0, 2.0, 3.0]), np.ones(6))
    periods = periods_of((0.2, 2.0), target)
    assert (periods[0], periods[-1]) == (0.2, 2.0)
    assert {0.3, 1.0} <= set(periods.tolist())
    assert (np.diff(periods) > 1e-7).all()
    assert np.diff(np.log(periods)).max() <= 0.05 + 1e-9
    assert len(periods) >= 50
    assert np.diff(np.log(periods_of((0.2, 2.0), target, 0.02))).max() <= 0.02 + 1e-9  # its peaks are narrower
    assert len(periods_of((0.2, 2.0), target, 0.0)) < 250
    many = TargetSpectrum("t", np.linspace(0.1, 3.0, 2000), np.ones(2000))
    dense = periods_of((0.2, 2.0), many)
    assert 100 < len(dense) < 200
    assert (dense[0], dense[-1]) == (0.2, 2.0)
    # A point of the target next to one of ours, but for rounding, is not there twice.
    close = TargetSpectrum("t", np.array([0.1, np.geomspace(0.2, 2.0, 50)[7] * (1 + 1e-9), 3.0]), np.ones(3))
    assert len(periods_of((0.2, 2.0), close)) == 50


def test_close_points_of_the_target_weigh_no_more_on_average():
    rng = np.random.default_rng(1)
    even = np.geomspace(0.2, 2.0, 2001)
    uneven = np.sort(np.concatenate([even, rng.uniform(0.3, 0.31, 3000)]))
    for power in (0, 1, 2):
        means = [log_weights(periods) @ np.log(periods) ** power for periods in (even, uneven)]
        low, high = np.log(0.2), np.log(2.0)
        exact = (high ** (power + 1) - low ** (power + 1)) / (power + 1) / (high - low)
        assert means == pytest.approx([exact, exact], abs=1e-5)


def test_candidates_have_the_spectra_of_their_motions():
    time = np.arange(400) * 0.01
    motions = [GroundMotion(f"m{k}", 0.01, np.sin((5 + k) * time), unit="m/s2") for k in range(3)]
    done = []
    found = candidates(motions, CODE, SetRequirements(2, BAND, damping=0.02), done.append)
    assert sum(done) == 3
    np.testing.assert_allclose(found.spectra[1], response_spectrum(motions[1], found.periods, 0.02).sa)
    np.testing.assert_allclose(found.target, np.interp(found.periods, CODE.periods, CODE.sa))
    assert coarse(found) == []
    short = SetRequirements(2, (0.03, 2.0))
    assert len(coarse(candidates(motions, CODE, short))) == 3
    with pytest.raises(
        InputError, match="a set of 9 was requested, but 3 records are available"
    ):  # before any spectrum is computed
        candidates(motions, CODE, SetRequirements(9, BAND), lambda done: pytest.fail("too late"))


# --- the target -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "unit", "sa"),
    [
        ("period [s],Sa [g]\n0.1,0.5\n0.2,0.4\n", "g", [0.5, 0.4]),
        ("T;Sa (m/s^2)\n0.1;4.903325\n0.2;3.92266\n", "m/s2", [0.5, 0.4]),
        ("# of a code\n\nsite B\nT_s,Sa_g\n0.1,.5\n0.2,4e-1\n\n", "g", [0.5, 0.4]),
        ("\ufeffT,Sa\r\n0.1,0.5,\r\n0.2,0.4,,\r\n", None, [0.5, 0.4]),
    ],
)
def test_a_target_is_read(tmp_path, text, unit, sa):
    path = tmp_path / "t.csv"
    path.write_text(text, encoding="utf-8", newline="")
    target = read_target(path)
    assert target.unit == unit
    assert target.periods.tolist() == [0.1, 0.2]
    np.testing.assert_allclose(target.sa, sa, rtol=1e-12)
    assert target.at(np.array([0.15]))[0] == pytest.approx(0.45)  # straight in T and Sa


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ("0.1,0.5\n0.2,0.4,0.3\n", 2, "3 columns"),
        ("T,Sa\n0.1,0.5\n0.1,0.4\n", 3, "twice"),
        ("0.1,0.5\n0.2,-0.4\n", 2, "must not be negative"),
        ("T [s],Sa [km/s2]\n0.1,0.5\n", 1, "no unit of acceleration"),
        ("f [Hz],Sa [g]\n0.1,0.5\n", 1, "periods in s"),
        ("0,1;0,5\n0,2;0,4\n", 1, "a comma within a number"),
        ("0.1,0.5\n", None, "1 point: at least two"),
    ],
)
def test_a_wrong_target_is_pointed_at(tmp_path, text, line, message):
    path = tmp_path / "t.csv"
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        read_target(path)
    problem = caught.value.problems[0]
    assert (problem.file, problem.line) == (str(path), line)
    assert message in problem.message
    assert problem.hint


def test_a_target_that_vanishes_in_the_band_is_refused():
    target = TargetSpectrum("t", np.array([0.0, 1.0, 2.0]), np.array([0.0, 0.5, 0.0]))
    target.check((0.1, 1.9))
    with pytest.raises(InputError, match="zero at 2 s"):
        target.check((0.1, 2.0))

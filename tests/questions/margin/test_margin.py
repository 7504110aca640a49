"""Shares of overturning over the factor: against histories followed one by one, and what is said against the shares."""

from __future__ import annotations

import re
from contextlib import nullcontext

import numpy as np
import pytest
from scipy.stats import binomtest

from rocking_cli.ask.read import read_record
from rocking_cli.core import Direction
from rocking_cli.core.structure_file import load_structure, parse_structure
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.pulses import parse_pulse
from rocking_cli.plotting import style
from rocking_cli.questions.margin import study as margins
from rocking_cli.questions.margin.picture import draw_margins
from rocking_cli.questions.margin.study import FACTORS, SHARE_LEVELS, Margin, margin
from rocking_cli.questions.margin.view import in_words, sentences
from rocking_cli.structure import Structure, build_models
from rocking_cli.studies.neighbours import Conditions, Neighbourhood
from rocking_cli.studies.response import of_one_degree
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES
from tests.following import build_model, conditions

BLOCK = parse_structure("mechanism: block\nwidth: 0.7\nheight: 2.8\n", "block", "block")
CORNERS = "mechanism: rigid_body\npolygon: [[0, 0], [0.7, 0], [0.69, 2.8], [0, 2.8]]\n"
SLIDING = CORNERS.replace("0.69", "0.6")  # on little friction
FRAME = load_structure(EXAMPLES / "frame.yaml")
AROUND = Neighbourhood(20)


SINGLE = {}
"""Neighbours by themselves, by their data and restitution: each is made once for all factors."""


def alone(mechanism, motion, factor, slender, etas):
    """One neighbour by itself: the ground pushes the more slender the less."""
    key = mechanism.model_dump_json(), tuple(etas)
    if key not in SINGLE:
        given = {"positive_to_negative": etas[0], "negative_to_positive": etas[1]}
        data = {**mechanism.model_dump(), "restitution": given}
        SINGLE[key] = Structure(type(mechanism).model_validate(data))
    return of_one_degree(Conditions(SINGLE[key], ("nonlinear",)), motion.scaled(factor / slender))["nonlinear"]


def share(mechanism, motion, factor, polarities, around=AROUND):
    """The shares next to one factor that overturn, and that do or are unknown, each of the worse polarity."""
    model = build_model(mechanism, "nonlinear")
    polarities = polarities[:1] if model.symmetric else polarities
    ends = [
        [
            alone(mechanism, motion, sign * factor * each, *others)
            for each, *others in zip(*around.drawn(model), strict=True)
        ]
        for sign in polarities
    ]
    return (
        max(np.mean([each.fell for each in of]) for of in ends),
        max(np.mean([each.fell or each.unknown for each in of]) for of in ends),
    )


@pytest.mark.every(4)
@pytest.mark.parametrize("polarities", [(-1,), (1, -1)])
@pytest.mark.parametrize(
    ("mechanism", "pulse"), [(BLOCK, "sine:0.8g:0.5s"), (FRAME, "sine:0.3g:3s")], ids=["block", "frame"]
)
def test_the_shares_are_those_of_neighbours_followed_alone(mechanism, pulse, polarities):
    motion = parse_pulse(pulse).sampled()
    around = Neighbourhood(8)
    found = margin(conditions(mechanism, around, signs=polarities), motion)
    assert found.around == Neighbourhood(8, 0.04, 0.05, 0.10) and found.checked and not found.unknown.any()
    partly = np.flatnonzero((found.overturned > 0) & (found.overturned < 1))
    assert found.factors.tolist() == sorted([*FACTORS, 1.0]) and partly.size
    for k in [0, *partly[:2], partly[-1], FACTORS.size]:
        assert found.overturned[k] == share(mechanism, motion, found.factors[k], polarities, around)[0]
    assert found.share.lowest == share(mechanism, motion, 1.0, polarities, around)[0]


@pytest.mark.parametrize("polarities", [(-1,), (1, -1)])
def test_the_shares_of_unknown_outcome_are_those_of_neighbours_followed_alone(polarities):
    """Of a body that slides: more overturn for certain under one polarity, and more may do so under the other."""
    body = parse_structure(f"{SLIDING}friction: 0.4\n", "sliding", "sliding")
    motion, around = read_record(EXAMPLES / "accel.csv"), Neighbourhood(10, slenderness=0.0)
    found = margin(conditions(body, around, signs=polarities), motion, factors=np.array([0.5, 2.0, 3.0]))
    assert found.factors.tolist() == [0.5, 1.0, 2.0, 3.0]
    expected = [share(body, motion, factor, polarities, around) for factor in found.factors]
    np.testing.assert_allclose(list(zip(found.overturned, found.at_most, strict=True)), expected, atol=1e-12)
    assert 0 < found.overturned[2] < 1 and found.unknown[-1] > 0
    assert (found.overturned[-1] > 0) == (1 in polarities)


def test_of_joints_that_the_mechanism_does_not_name_nothing_is_said_to_be_unknown():
    curve = load_structure(EXAMPLES / "curve.yaml")
    found = margin(
        conditions(curve, Neighbourhood(2), signs=(1, -1)),
        parse_pulse("sine:0.5g:1s").sampled(),
        factors=np.array([2.0]),
    )
    assert not found.checked and not found.unknown.any()


@pytest.mark.every(2)
def test_a_reversed_motion_is_followed_only_where_it_can_add_something(monkeypatch):
    followed, done = [], []
    simulate = margins.simulate_neighbours
    monkeypatch.setattr(
        margins, "simulate_neighbours", lambda *a, **k: followed.append(len(a[2].amplitude)) or simulate(*a, **k)
    )
    motion = parse_pulse("sine:0.8g:0.5s").sampled()
    around, factors = Neighbourhood(8, 0.02, 0.02, 0.0), np.linspace(0.5, 5, 18)  # and that of the motion as given
    every = 19 * around.count
    # A little heavier at one side, so that a reversed motion is another one.
    leaning = parse_structure(CORNERS, "leaning", "leaning")
    one = margin(conditions(leaning, around), motion, factors=factors)
    certain = int((one.overturned == 1).sum())
    for each, again in ((BLOCK, 0), (leaning, 19 - certain)):
        followed.clear()
        done.clear()
        margin(conditions(each, around, signs=(1, -1)), motion, factors=factors, progress=done.append)
        assert followed == [every, again * around.count]
        assert sum(done) == 2 * every
    assert 3 < certain < 19


@pytest.mark.parametrize(
    ("name", "alike"),
    [("block", True), ("wall", True), ("frame", False), ("rigid_body", False),
     pytest.param("arch", True, marks=pytest.mark.rest)],
)  # fmt: skip
def test_symmetric_structures_are_known(name, alike):
    models = build_models(load_structure(EXAMPLES / f"{name}.yaml"))
    assert {each.name: each.symmetric for each in models} == dict.fromkeys(("nonlinear", "linear1", "linear2"), alike)


def made(*shares, unknown=None) -> Margin:
    doubtful = np.zeros(len(shares)) if unknown is None else np.array(unknown, dtype=float)
    factors = np.arange(1.0, len(shares) + 1)
    return Margin(AROUND, 0.5, factors, np.array(shares, dtype=float), doubtful, pga_g=0.5, polarities=(1,))


class TestLevels:
    def test_none_and_all(self):
        assert made(0, 0).first(0.1) is None and made(0, 0).last_below(0.1) == 2.0
        assert made(1, 1).first(0.9) == 1.0 and made(1, 1).last_below(0.9) is None
        assert made(1, 1).islands(0.9) == [(1.0, 2.0)] and made(0, 0).islands(0.1) == []

    def test_where_unknown_outcomes_count_as_overturning(self):
        found = made(0.0, 0.2, 0.6, 0.3, 1.0, unknown=(0.1, 0.4, 0.0, 0.3, 0.0))
        np.testing.assert_allclose(found.at_most, [0.1, 0.6, 0.6, 0.6, 1.0])
        assert [found.first(level, unknown=True) for level in SHARE_LEVELS] == [1.0, 2.0, 5.0]
        assert [found.first(level) for level in SHARE_LEVELS] == [2.0, 3.0, 5.0]
        assert [found.last_below(level, unknown=True) for level in SHARE_LEVELS] == [None, 1.0, 4.0]
        assert [found.last_below(level) for level in SHARE_LEVELS] == [1.0, 4.0, 4.0]
        assert [found.always(level) for level in SHARE_LEVELS] == [2.0, 5.0, 5.0]
        assert [found.always(level, unknown=True) for level in SHARE_LEVELS] == [1.0, 2.0, 5.0]
        assert found.share[:2] == (0.0, 0.1)


class TestWords:
    @pytest.mark.parametrize(
        ("shares", "unknown", "said"),
        [
            ((0, 0.05, 0), None, ["At no scale factor from 1 to 3 (PGA from 0.5 g to 1.5 g)", "10 % or more"]),
            ((0, 0.2, 0.6), None, ["10 %", "at a factor of 2 (PGA 1 g), 50 % at 3 (1.5 g) and 90 % at none up to 3"]),
            ((0, 0.2, 0.0, 1.0), None, ["not always worse: at a factor of 3 (1.5 g) none does."]),
            ((0, 0.6, 0.3, 1.0), None, ["always worse: at a factor of 3 (1.5 g) only 30 % overturn the structure."]),
            ((0, 0.6, 1.0, 0.7, 0.8), None, ["always worse: at a factor of 4 (2 g) only 70 % overturn"]),
            # Unknown outcomes count as overturning in what is said first.
            ((0, 0, 0), (0, 0.3, 0.6), ["or have an unknown outcome, at a factor of 2 (PGA 1 g), 50 % at 3 (1.5 g)",
                                        "From a factor of 2 (1 g) on", "does not prove that it stands"]),
            ((0, 0, 0), (0, 0.05, 0.05), ["At no scale factor from 1 to 3", "or have an unknown outcome",
                                          "From a factor of 2 (1 g) on", "does not prove that it stands"]),
            ((0, 0.2, 0.0, 1.0), (0, 0.4, 0.3, 0), ["3 (1.5 g) only 30 % overturn", "the structure may overturn",
                                                    "known to overturn it: 10 % from 2 (1 g), 50 % from 4 (2 g)"]),
        ],
    )  # fmt: skip
    def test_it_says_at_which_factors_how_many_overturn(self, shares, unknown, said):
        words, first = in_words(made(*shares, unknown=unknown)), sentences(made(*shares, unknown=unknown))[0]
        assert words.startswith(first) and not re.search("always worse|are unknown|prove", first)
        assert all(each in words for each in said)
        assert ("always worse" in words) == any("always worse" in each or "only 30 %" in each for each in said)
        assert ("unknown" in words) == (unknown is not None)


@pytest.mark.parametrize("polarities", [(1,), (-1,), (1, -1)])
def test_uplift_is_a_quotient(polarities):
    """A ground acceleration to the left lifts a block clockwise, at tan(alpha) g."""
    motion = GroundMotion("two pushes", 0.1, np.array([0.0, 4.0, 0.0, -2.0, 0.0]), unit="m/s2")
    found = margin(conditions(BLOCK, Neighbourhood(1), signs=polarities), motion)
    assert found.uplift == pytest.approx(0.25 * BLOCK.gravity / 4.0, rel=1e-12)
    still = margin(conditions(BLOCK, Neighbourhood(1), signs=polarities), motion.scaled(0))
    assert still.uplift is None and not still.overturned.any()


@pytest.mark.parametrize("wrong", [[], [0.0, 1.0], [1.0, 1.0], [2.0, 1.0], [1.0, np.inf], [[1.0]]])
def test_factors_must_ascend(wrong):
    with pytest.raises(InputError, match="ascending"):
        margin(conditions(BLOCK), parse_pulse("sine:1g:1s").sampled(), factors=np.array(wrong))


@pytest.mark.parametrize(("friction", "rocks"), [(0.15, False), (0.5, True)])
def test_what_only_slides_uplifts_at_no_factor(friction, rocks):
    """A block of 0.4 m x 0.9 m rocks only on friction above 4/9."""
    plinth = BLOCK.model_copy(update={"width": 0.4, "height": 0.9, "friction": friction})
    motion = parse_pulse("sine:0.5g:0.5s").sampled()
    found = margin(conditions(plinth, Neighbourhood(1), signs=(1, -1)), motion)
    assert (found.uplift is not None) == rocks


def test_uplift_is_that_of_the_worse_polarity():
    """Of a stone that leans, under a push one way only."""
    leaning = parse_structure(
        "mechanism: rigid_body\npolygon: [[-0.4, 0], [0.2, 0], [0.35, 2], [-0.4, 2]]\n", "stone", "stone"
    )
    lambdas = [leaning.uplift(direction) for direction in Direction]
    push = GroundMotion(
        "push", 0.01, np.append(0.1 * leaning.gravity * np.sin(np.linspace(0, np.pi, 41)), np.zeros(9)), unit="m/s2"
    )
    for polarities, lam in (((1,), lambdas[1]), ((-1,), lambdas[0]), ((1, -1), min(lambdas))):
        found = margin(conditions(leaning, AROUND, signs=polarities), push)
        assert found.uplift == pytest.approx(lam / 0.1, rel=1e-9)


class TestCommand:
    BLOCK = EXAMPLES / "block.yaml"
    ACCEL = EXAMPLES / "accel.csv"

    def test_json_is_the_study(self):
        data = run_json("margin", self.BLOCK, "--record", self.ACCEL, "--pulse", "sine:0.5g:0.8s", "--neighbours", 6)
        assert data["neighbours"] == {"count": 6, "amplitude": 0.04, "restitution": 0.05, "slenderness": 0.10}
        assert len(data["motions"]) == 2 and data["motions"][0]["name"] == "accel.csv"
        asked = conditions(load_structure(self.BLOCK), Neighbourhood(6), signs=(1, -1))
        found = margin(asked, parse_pulse("sine:0.5g:0.8s").sampled())
        theirs = data["motions"][1]
        assert theirs["shares"] == found.overturned.tolist() and theirs["unknown"] == [0.0] * 61
        assert theirs["factors"] == sorted([*FACTORS.tolist(), 1.0])
        assert theirs["overturned"] == found.share.lowest and theirs["uplift"] == found.uplift
        assert set(theirs["levels"]) == {"10", "50", "90"}
        assert theirs["levels"]["50"]["first"] == found.first(0.5)
        assert theirs["verdict"] == in_words(found)
        assert theirs["pga_g"] == found.pga_g == pytest.approx(0.5, rel=1e-3) and found.polarities == (1, -1)

    def test_options_go_before_the_file(self, tmp_path):
        file = tmp_path / "b.yaml"
        file.write_text(
            self.BLOCK.read_text(encoding="utf-8") + "uncertainty: {slenderness: 0.03, restitution: 0.01}\n"
        )
        words = ("margin", file, "--pulse", "sine:0.5g:0.8s", "--neighbours", 1, "--polarity", 1)
        own = {"count": 1, "amplitude": 0.04, "slenderness": 0.03, "restitution": 0.01}
        assert run_json(*words)["neighbours"] == own
        given = run_json(*words, "--slenderness-deviation", "7%", "--amplitude-deviation", 0.02)
        assert given["neighbours"] == own | {"slenderness": 0.07, "amplitude": 0.02}
        assert run_json(*words, "--restitution-deviation", 0.04)["neighbours"] == own | {"restitution": 0.04}

    def test_unknown_outcomes_are_a_share_of_their_own(self, tmp_path):
        (tmp_path / "stone.yaml").write_text(f"{SLIDING}friction: 0.3\n", encoding="utf-8")
        words = ("margin", "stone.yaml", "--record", self.ACCEL, "--neighbours", 5, "--polarity", 1)
        (ours,) = run_json(*words)["motions"]
        stone = conditions(load_structure(tmp_path / "stone.yaml"), Neighbourhood(5))
        found = margin(stone, read_record(self.ACCEL))
        assert ours["unknown"] == found.unknown.tolist() and max(ours["unknown"]) > 0.5
        assert ours["levels"]["50"]["first_or_unknown"] == found.first(0.5, unknown=True) is not None
        assert ours["levels"]["10"]["last_below_or_unknown"] == found.last_below(0.1, unknown=True) is not None
        rows = [" ".join(line.split()) for line in run(*words).stdout.splitlines()]
        first = next(k for k, row in enumerate(rows) if row.startswith("accel.csv: overturn or unknown"))
        assert f" {found.first(0.5, unknown=True):.3g} " in rows[first] and rows[first + 1].startswith(
            "known to overturn"
        )
        assert any(row.startswith("accel.csv: ") and "outcomes are unknown, as" in row for row in rows)
        assert not any("At least 10 %" in row for row in rows)
        (known,) = run_json(*words, "--opening", "100%")["motions"]
        wider, less = np.array(known["unknown"]), np.array(ours["unknown"])
        assert (wider <= less).all() and wider.sum() < less.sum() - 1

    @pytest.mark.parametrize(
        ("words", "fragment"),
        [
            ((), "--record or --pulse is missing"),
            (("--pulse", "sine:0.4g:0.8s", "--neighbours", 0), "at least 1"),
            (("--record", "x", "--amplitude-deviation", 1), "from 0 up to, but not including, 1"),
            (("--record", "x", "--slenderness-deviation", "100%"), "from 0 up to, but not including, 1"),
            (("--record", "x", "--restitution-deviation", -1), "from 0"),
            (("--record", "x", "--opening", 1001), "from 0 to 1000"),
            (("--record", "no.AT2"), "no such file"),
        ],
    )
    def test_wrong_input(self, words, fragment):
        assert fragment in run("margin", self.BLOCK, *words, code=2).stderr


def shown(uplift=0.5, shares=0.0, unknown=0.0, polarities=(1, -1)) -> Margin:
    zeros = np.zeros(FACTORS.size)
    return Margin(AROUND, uplift, FACTORS, zeros + shares, zeros + unknown, pga_g=0.4, polarities=polarities)


@pytest.mark.parametrize(
    ("shares", "unknown", "ratio"),
    [((0.0, 0.05, 0.2), (0.0, 0.0, 0.0), 3.0), ((0.0, 0.05, 0.2), (0.0, 0.06, 0.0), 2.0),
     ((0.0, 0.0, 0.09), (0.1, 0.0, 0.0), 1.0), ((0.0, 0.05, 0.09), (0.0, 0.0, 0.0), np.inf)],
)  # fmt: skip
def test_the_factor_of_the_conclusion_is_the_first_at_which_a_tenth_overturns_or_may(shares, unknown, ratio):
    motion = parse_pulse("sine:0.05g:0.5s").sampled()
    end = margins.conclusion(conditions(BLOCK), motion, made(*shares, unknown=unknown))
    assert end.ratio == ratio
    assert (end.share.lowest, end.share.highest) == pytest.approx((shares[0], shares[0] + unknown[0]))


@pytest.mark.parametrize(("uplift", "mark"), [(0.05, "<"), (0.5, "|"), (9.0, ">")])
def test_where_it_uplifts_is_marked_on_the_axis_or_pointed_to_and_named(uplift, mark):
    (axes,) = draw_margins({"a": shown(uplift)}, "title").axes
    (drawn,) = (line for line in axes.get_lines() if line.get_marker() in ("<", "|", ">"))
    assert drawn.get_marker() == mark
    assert axes.get_xlim()[0] <= drawn.get_xdata()[0] <= axes.get_xlim()[1]
    assert [each.get_text() for each in axes.texts] == [f"uplift at {uplift:g}"]


def test_both_curves_are_drawn_where_some_outcomes_are_unknown():
    shares, unknown = np.linspace(0, 0.4, FACTORS.size), np.linspace(0, 0.6, FACTORS.size)
    (axes,) = draw_margins({"a": shown(0.5, shares, unknown)}, "title").axes
    curves = [line.get_ydata() for line in axes.get_lines() if len(line.get_xdata()) == FACTORS.size]
    np.testing.assert_allclose(curves, [shares, shares + unknown])
    (band,) = (each for each in axes.collections if each.get_hatch())
    assert "hatched: unknown outcomes" in axes.get_xlabel().replace("\n", " ")
    corners = band.get_paths()[0].vertices
    assert corners[:, 1].max() == pytest.approx(1.0) and corners[:, 1].min() == pytest.approx(0.0)


def test_a_shaded_band_is_what_so_few_neighbours_leave_open():
    shares = np.linspace(0, 1, FACTORS.size).round(1)
    (axes,) = draw_margins({"a": shown(0.5, shares)}, "title").axes
    (band,) = axes.collections
    corners = band.get_paths()[0].vertices
    each = [binomtest(round(share * AROUND.count), AROUND.count).proportion_ci(0.9, "wilson") for share in shares]
    for factor, interval in zip(FACTORS, each, strict=True):
        assert set(corners[np.isclose(corners[:, 0], factor), 1].round(6)) >= {round(end, 6) for end in interval}
    assert f"5 to 95 % interval of a share of {AROUND.count} neighbours" in axes.get_xlabel().replace("\n", " ")


def test_one_motion_is_named_and_has_an_axis_of_its_pga():
    (axes,) = draw_margins({"a.csv": shown()}, "wall").axes
    (top,) = axes.child_axes
    assert axes.get_title(loc="left") == "wall, a.csv" and top.get_xlabel() == "PGA [g]"
    axes.figure.draw_without_rendering()
    np.testing.assert_allclose(top.get_xlim(), 0.4 * np.array(axes.get_xlim()))


@pytest.mark.parametrize("narrow", [False, True])
def test_each_of_several_motions_is_named_with_its_pga_and_uplift_below(narrow):
    found = {"a.csv": shown(0.3, np.linspace(0, 1, FACTORS.size)), "b.csv": shown(None)}
    with style.on_phone() if narrow else nullcontext():
        figure = draw_margins(found, "wall")
    below = [each.get_text() for key in figure.legends for each in key.get_texts()]
    assert below == ["a.csv, PGA 0.4 g, uplift at 0.3", "b.csv, PGA 0.4 g"]
    assert not figure.axes[0].child_axes


def test_where_a_tie_yields_the_factor_is_no_margin_to_overturning(tmp_path):
    """Bare, it overturns from some factor on; tied, nothing is known once the bar yields."""
    wall = "mechanism: block\nname: w\nwidth: 0.55\nheight: 7.2\ndensity: 1900\ndepth: 5\none_sided: positive\n"
    wall += "rebound: 0.4\n"
    tie = "ties:\n- {name: bar, from: {ground: [-5, 7]}, to: {at: [-0.275, 7]}, bars: 1, diameter: 0.018,\n"
    tie += "   steel: S235}\n"
    said = {}
    for name, text in (("bare", wall), ("tied", wall + tie)):
        (tmp_path / "w.yaml").write_text(text)
        asked = ("margin", str(tmp_path / "w.yaml"), "--pulse", "sine:0.3g:1.5s", "--neighbours", "10")
        said[name] = " ".join(run(*asked).stdout.split())
        verdict = run_json(*asked)["motions"][0]
    assert "smallest factor at which 10 % or more may overturn" in said["bare"] and "Not a margin" not in said["bare"]
    assert "may overturn is" not in said["tied"]
    known, ends = (float(each) for each in re.search(
        r"Not a margin to overturning: all outcomes are known up to a factor of ([\d.]+); at ([\d.]+), 10 % or "
        r"more overturn or are unknown, as the tie bar yields", said["tied"]).groups())  # fmt: skip
    unknown = np.array(verdict["unknown"])
    assert known == pytest.approx(verdict["factors"][int((unknown > 0).argmax()) - 1], rel=5e-3) and known < ends

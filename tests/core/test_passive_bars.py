"""Passive bars of steel: they pull while they are longer than at rest, until they yield.

Expected values by hand: a block of b x h about its corners, with a bar from a point of the ground to one of its own.
"""

from math import asin, pi

import numpy as np
import pytest
from scipy.optimize import brentq

import rocking_cli as rk
from rocking_cli.codes.italian.chain import Chain
from rocking_cli.core import Direction
from rocking_cli.core.bounds import Bound
from rocking_cli.dynamics.history import follow
from rocking_cli.dynamics.tables import tabulate
from rocking_cli.structure import build_models
from rocking_cli.studies.engines.free_blocks import free_blocks
from rocking_cli.views.verdict import why_unknown
from tests.conftest import record
from tests.core.test_ties_of_steel import SITE
from tests.oracle import GROUND, Block, Ground, simulate

PLUS, MINUS = Direction.POSITIVE, Direction.NEGATIVE
E, YIELD, G = 210e9, 235e6, 9.80665
B, H, DENSITY, DEPTH = 0.6, 4.0, 1800.0, 3.0
MASS = DENSITY * DEPTH * B * H
BACK = {"from": {"ground": [-5.0, 3.8]}, "to": {"at": [-0.3, 3.8]}}  # horizontal, on the left
STEEP = {"from": {"ground": [-0.9, 8.0]}, "to": {"at": [-0.3, 3.8]}}  # becomes shorter in both directions, then longer
DUCT = {"path": [{"ground": [0.0, 0.0]}, {"at": [0.0, 0.0]}], "length": 4.0}
BOTH = [pytest.param(side, id=side.label) for side in Direction]


def wall(**tie):
    bar = {
        key: value for key, value in {"name": "bar", "area": 2e-5, "yield": YIELD, **tie}.items() if value is not None
    }
    return rk.Block(name="wall", width=B, height=H, density=DENSITY, depth=DEPTH, ties=[bar] if tie else None)


def elongation(place, phi, side):
    """Of a bar between the ground and the block, which turns about its right or its left corner."""
    at, ground = complex(*place["to"]["at"]), complex(*place["from"]["ground"])
    foot = side * B / 2
    return np.abs(foot + (at - foot) * np.exp(-1j * side * phi) - ground) - abs(at - ground)


def first_yield(place, side, strain=YIELD / E):
    long = abs(complex(*place["to"]["at"]) - complex(*place["from"]["ground"]))
    grid = np.linspace(0, 1.5, 30001)
    beyond = np.flatnonzero(elongation(place, grid, side) > strain * long)
    if not beyond.size:
        return None
    return brentq(lambda phi: elongation(place, phi, side) - strain * long, *grid[beyond[0] - 1 :][:2], xtol=1e-15)


def yields_at(phi, name="bar", side=PLUS):
    """The bound of a direction in which a bar yields."""
    return Bound(pytest.approx(phi, abs=1e-11), "yields", name, direction=side)


def comes_taut(side):
    """The rotation at which the steep bar is again as long as at rest."""
    grid = np.linspace(1e-4, 0.3, 3000)
    k = int((elongation(STEEP, grid, side) > 0).argmax())
    return brentq(lambda phi: elongation(STEEP, phi, side), grid[k - 1], grid[k], xtol=1e-15)


@pytest.mark.parametrize("side", BOTH)
@pytest.mark.parametrize("place", [BACK, STEEP], ids=["back", "steep"])
def test_it_pulls_where_it_is_longer_than_at_rest(place, side):
    tied, bare = wall(**place), wall()
    phi = np.linspace(0, 0.3, 2001)
    e = elongation(place, phi, side)
    long = abs(complex(*place["to"]["at"]) - complex(*place["from"]["ground"]))
    added = tied.potential_energy(phi, side) - bare.potential_energy(phi, side)
    np.testing.assert_allclose(added, E * 2e-5 / long * np.maximum(e, 0) ** 2 / 2, rtol=1e-9, atol=1e-9)
    assert (e > 1e-3).any() or side is MINUS


@pytest.mark.parametrize(("side", "shorter"), [(PLUS, 0.000218), (MINUS, 0.02017)])
def test_the_sense_may_change_within_one_direction(side, shorter):
    """The steep bar is slack at first and taut later: the table has a corner there, and it yields after."""
    tied, taut = wall(**STEEP), comes_taut(side)
    e = elongation(STEEP, np.linspace(0, taut, 3000), side)
    assert e.max() < 1e-9 and e.min() == pytest.approx(-shorter, rel=1e-3)
    table = tabulate(tied)[0 if side > 0 else 1]
    (cell, _) = np.flatnonzero(np.diff(table.corners))  # before and behind the cell that holds the corner
    assert table.nodes[cell + 1] <= taut <= table.nodes[cell + 2]
    assert tied.bounds[side].phi > taut


@pytest.mark.parametrize("side", BOTH)
@pytest.mark.parametrize("place", [BACK, STEEP], ids=["back", "steep"])
def test_the_rotation_at_which_it_yields(place, side):
    expected = first_yield(place, side)
    found = wall(**place).bounds[side]
    assert found == (None if expected is None else yields_at(expected, side=side))


@pytest.mark.parametrize("side", BOTH)
def test_a_duct_along_the_axis_stretches_both_ways(side):
    """e = 2 (b/2) sin(phi/2), over 4 m."""
    assert wall(**DUCT).bounds[side] == yields_at(2 * asin(YIELD / E * 4.0 / B), side=side)


def test_of_several_bars_the_first_to_yield_counts():
    bars = [{"name": name, **BACK, "area": 2e-5, "yield": stress} for name, stress in (("a", 3e8), ("b", 2e8))]
    block = rk.Block(name="wall", width=B, height=H, density=DENSITY, depth=DEPTH, ties=bars)
    assert block.bounds[PLUS] == yields_at(first_yield(BACK, PLUS, 2e8 / E), "b")


@pytest.mark.parametrize(
    ("changed", "strain"),
    [
        ({"modulus": "100 GPa"}, YIELD / 1e11),
        ({"length": 9.4}, 2 * YIELD / E),  # over twice the distance of its ends
        ({"area": None, "diameter": 0.016, "bars": 3}, YIELD / E),
        ({"area": None, "diameter": 0.02, "bars": 1, "plate": {"width": 0.1, "height": 0.1},
          "wall": {"thickness": 0.6, "compression": 2e6, "shear": 1e6}}, 2e6 * 0.01 / (pi * 1e-4) / E),
    ],
    ids=["modulus", "length", "bars", "bearing"],
)  # fmt: skip
def test_stiffness_and_strength_follow_from_the_file(changed, strain):
    assert wall(**BACK, **changed).bounds[PLUS] == yields_at(first_yield(BACK, PLUS, strain))


@pytest.mark.parametrize("place", [BACK, STEEP, DUCT], ids=["back", "steep", "duct"])
def test_at_rest_it_has_no_force_however_strong(place):
    strong, bare = wall(**place, area=0.1), wall()
    for side in Direction:
        assert strong.uplift(side) == pytest.approx(bare.uplift(side), rel=1e-12)
        assert strong.borne(side) == pytest.approx(bare.borne(side), rel=1e-12)


def test_equiv_says_until_when():
    answer = rk.equiv(wall(**BACK))
    sides = answer.to_dict()["directions"]
    at = first_yield(BACK, PLUS)
    bound = sides["positive"]["bound"]
    assert (bound["phi"], bound["kind"], bound["name"]) == (pytest.approx(at), "yields", "bar")
    assert sides["negative"]["bound"] is None
    said = " ".join(answer.sentences)
    assert f"the tie bar yields at {at:.4g} rad, before its restoring moment vanishes" in said
    assert f"Clockwise, the tie bar yields at {at:.4g} rad: time histories are unknown from there on." in said
    assert f"{E * 2e-5 / 4.7 / 1e3:.4g} kN/m, tension only, with a strength of 4.7 kN" in said
    bare = rk.equiv(wall()).to_dict()["directions"]["negative"]
    kept = ("lambda", "phi_cr", "p", "kappa1", "kappa2")
    assert [sides["negative"][key] for key in kept] == pytest.approx([bare[key] for key in kept], rel=1e-9)


def test_a_soft_bar_that_yields_beyond_the_critical_rotation_has_an_equivalent_block():
    """Of 1 GPa and a strength that it reaches at .2 rad, beyond b/h."""
    soft = wall(**BACK, area=1e-7, modulus=1e9, **{"yield": 1e9 * 0.2 * 3.8 / 4.7})
    at = first_yield(BACK, PLUS, 0.2 * 3.8 / 4.7)
    assert rk.equiv(soft).positive.phi_cr < at and soft.bounds[PLUS] == yields_at(at)


def second(place, stiffness=E * 2e-5 / 4.7):
    """The wall in the second program, with an elastic bar that pulls only."""
    ends = (GROUND, complex(*place["from"]["ground"])), ("block", complex(*place["to"]["at"]))
    return Block(B, H, MASS).with_tie(*ends, k=stiffness)


def until_yield(motion, history, at):
    """Compare a history, which is unknown from the rotation `at` on, with the second program; return until when [s]."""
    ends = [(a, b) for a, b, side, _ in motion.flights if side > 0]
    grid = np.concatenate([np.linspace(a, b, 400) for a, b in ends])
    phi = np.array([motion.at(t)[0] for t in grid])
    k = int((phi > at).argmax())
    assert phi[k] > at, "it does not yield"
    time = brentq(lambda t: motion.at(t)[0] - at, grid[k - 1], grid[k], xtol=1e-14)
    before = history.time < time
    expected = np.array([motion.at(t)[0] for t in history.time[before]])
    np.testing.assert_allclose(history.phi[before], expected, atol=1e-9)
    assert history.unknown and history.known_to == pytest.approx(time, abs=1e-8)
    assert why_unknown(history) == f"the tie bar yields at {at:.4g} rad"
    left = max((each.phi for each in motion.peaks if each.side < 0 and each.time < time), default=0.0)
    assert (history.peak_positive, history.peak_negative) == pytest.approx((at, left), rel=1e-7)
    return time


@pytest.mark.parametrize("sign", [1, -1])
def test_a_history_until_it_yields(sign):
    """It rocks away from the anchorage first, or towards it, as the bare wall does, and then away."""
    tied = wall(**BACK)
    time = np.arange(0, 1.61, 0.05)
    samples = sign * 2.2 * np.sin(2 * pi * time / 1.6)
    history = follow(build_models(tied, ("nonlinear",))[0], rk.GroundMotion("pulse", 0.05, samples, unit="m/s2"))
    motion = simulate(second(BACK), Ground(time.tolist(), samples.tolist()), until=2.0)
    at = first_yield(BACK, PLUS)
    reached = until_yield(motion, history, at)
    bare = follow(build_models(wall(), ("nonlinear",))[0], rk.GroundMotion("pulse", 0.05, samples, unit="m/s2"))
    away = bare.phi[bare.time < reached].min() < -1e-3
    assert away == (sign > 0)  # the ground moves to the right: the wall rocks to the left, where the bar is slack
    if away:
        some = np.flatnonzero(bare.time < reached)  # until then the bar has been slack, but for the last swing
        slack = some[history.phi[some] < -1e-6]
        np.testing.assert_allclose(history.phi[slack], bare.phi[slack], atol=1e-9)


def test_a_strong_bar_that_never_yields_is_followed_to_the_end():
    strong = wall(**BACK, **{"yield": 9e9, "area": 1e-6})
    time = np.arange(0, 1.21, 0.05)
    samples = 1.9 * np.sin(2 * pi * time / 1.2)
    history = follow(build_models(strong, ("nonlinear",))[0], rk.GroundMotion("pulse", 0.05, samples, unit="m/s2"))
    motion = simulate(second(BACK, E * 1e-6 / 4.7), Ground(time.tolist(), samples.tolist()), until=3.0)
    peaks = [max(each.phi for each in motion.peaks if each.side == side) for side in (1, -1)]
    assert (history.peak_positive, history.peak_negative) == pytest.approx(peaks, rel=1e-7)
    assert 1e-3 < peaks[0] < strong.bounds[PLUS].phi and peaks[1] > 1e-3


def test_a_steep_bar_that_comes_taut_on_the_way():
    """Let go beyond the corner: it is pulled back by the bar, and then by its weight alone."""
    tied = wall(**STEEP, **{"yield": 5e9, "area": 1e-6})
    long = abs(-0.9 + 8j - (-0.3 + 3.8j))
    start = comes_taut(PLUS) + 0.005
    model = build_models(tied, ("nonlinear",))[0]
    history = follow(model, None, release=start / model.phi_cr[0], tail=5.0)
    motion = simulate(second(STEEP, E * 1e-6 / long), release=start, impacts=3)
    assert motion.switched
    for mine, other in zip(history.impacts, motion.impacts, strict=False):
        assert (mine[0], mine[2]) == pytest.approx((other.time, other.before), rel=1e-6)


def test_the_wall_under_a_record_until_its_bar_yields():
    """The bar yields .11 s after the first uplift, at 3 % of the rotation to which the bare wall rocks."""
    motion = rk.read_record(record("Rinaldi228.AT2")).scaled(0.3)
    time = np.arange(motion.npts) * motion.dt
    some = time < 2.7
    bare, tied = (follow(build_models(each, ("nonlinear",))[0], motion) for each in (wall(), wall(**BACK)))
    assert max(bare.peak_positive, bare.peak_negative) == pytest.approx(0.0507, abs=5e-5)
    by_hand = simulate(second(BACK), Ground(time[some].tolist(), motion.acceleration[some].tolist()), until=2.7)
    reached = until_yield(by_hand, tied, first_yield(BACK, PLUS))
    assert reached == pytest.approx(2.6013, abs=1e-4)


def test_codes_keep_the_strength_where_it_resists():
    """alpha0 of a block that may rock to both sides: with the force of the bar to the right, without it to the left."""
    chains = {side: Chain(wall(**BACK).at_strength(), side).alpha0 for side in Direction}
    assert chains[PLUS] == pytest.approx((MASS * G * B / 2 + YIELD * 2e-5 * 3.8) / (MASS * G * H / 2), rel=1e-12)
    assert chains[MINUS] == pytest.approx(B / H, rel=1e-12)
    found = rk.verify(wall(**BACK), SITE).directions
    assert [found[side].a0 for side in Direction] == pytest.approx(
        [chains[side] * G / SITE["FC"] for side in Direction], rel=1e-9
    )
    bare = rk.verify(wall(), SITE).directions[MINUS]
    assert found[MINUS].a0 == bare.a0 and found[MINUS].d0 == bare.d0
    assert rk.verify(wall(**BACK), SITE).conclusion.left_out == []  # no other mechanism starts first


def test_the_switch_has_no_effect_without_steel():
    bare, elastic = wall(), wall(**{**BACK, "yield": None, "area": None, "stiffness": 1e6})
    assert bare.at_strength() is bare and elastic.at_strength() is elastic


def test_histories_of_a_code_are_those_of_the_passive_bar():
    """Its static methods count the strength, and its time histories are known until the bar yields."""
    time = np.arange(0, 1.61, 0.05)
    pulse = rk.GroundMotion("pulse", 0.05, -2.2 * np.sin(2 * pi * time / 1.6), unit="m/s2")
    known_to = follow(build_models(wall(**BACK), ("nonlinear",))[0], pulse).known_to
    found = rk.verify(wall(**BACK), {**SITE, "FC": 1.0}, motions=[pulse], polarity=1)
    (peak,) = found.directions[PLUS].dynamic["SLV"].records
    assert (peak.without, peak.known_to_without) == (None, pytest.approx(known_to, rel=1e-9))
    assert found.directions[PLUS].lambda_ == pytest.approx(Chain(wall(**BACK).at_strength(), PLUS).alpha0, rel=1e-12)


def test_free_blocks_refuse_it_by_name():
    with pytest.raises(rk.InputError, match="free blocks cannot have a tie that yields, as bar"):
        free_blocks(wall(**BACK))


def test_what_is_advised_where_it_yields():
    """A stronger tie or a weaker motion: free blocks cannot go on from there."""
    answer = rk.respond(wall(**BACK), "sine:0.3g:1s", neighbours=3)
    known_to, at = answer["nonlinear"].known_to, first_yield(BACK, PLUS)
    assert list(answer.conclusion.next) == ["stronger_bar", "margin"]
    said = " ".join(answer.sentences)
    assert f"The outcome is unknown after {known_to:.4g} s: then the tie bar yields at {at:.4g} rad." in said
    assert "give the tie a section or a steel with which it does not yield" in said and "free blocks" not in said

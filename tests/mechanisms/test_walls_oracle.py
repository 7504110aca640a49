"""The second program against the printed tables of loads, ties, walls, one-sided rocking and reactions.

A number is right if it agrees to half of the last digit that is printed. What no table has is checked by means of its
own: by hand, by Newton and Euler, by energy, by symmetry.
"""

from dataclasses import replace
from decimal import Decimal
from math import atan, cos, pi, sin, sqrt, tan

import numpy as np
import pytest

from tests.oracle import GROUND, Block, Frame, Ground, Wall, impulses, reactions, simulate

G = 9.80665
TALL = Block(1.0, 5.0)  # of unit mass, as all here unless said
ALPHA = atan(0.2)
WALL = Wall(0.3, 3.0, overburden=G, inertia=0.0)
FRAME = Frame(1.0, 6.0, 8.0, 1.0, column=1000.0, beam=4000.0, right_height=7.5, right_column=1250.0)


def printed(value: float, number: str) -> bool:
    """Whether a value is a number as it is printed."""
    last = Decimal(number).as_tuple().exponent
    assert isinstance(last, int)
    return abs(value - float(number)) <= 0.500001 * 10.0**last


def tendon(n0: float, ea: float) -> Block:
    """In a duct along the axis of the tall block: only where it opens does it become longer."""
    return TALL.with_tie((GROUND, 0j), ("block", 0j), k=ea * G / 5, n0=n0 * G)


# Section 1.


@pytest.mark.every(2)
@pytest.mark.parametrize(
    ("n0", "ea", "uplift", "phi_cr", "p", "kappa1", "time", "rate"),
    [
        (0.0, 0.0, ".20", ".19739556", "1.69848858", "1.00000000", ".776257407", ".28976684"),
        (0.2, 0.0, ".24", ".23635507", "1.69980731", ".99769133", ".668605966", ".32602421"),
        (0.0, 20.0, ".20", ".32175055", "1.33757854", "1.60000000", ".682950262", ".308185754"),
        (0.0, 60.0, ".20", None, None, None, ".568788722", ".342061009"),
        (0.2, 60.0, ".24", None, None, None, ".522438978", ".373272954"),
    ],
)
def test_a_block_with_a_tendon(n0, ea, uplift, phi_cr, p, kappa1, time, rate):
    block = tendon(n0, ea)
    for s in (1, -1):
        assert block.uplift(s) == pytest.approx(float(uplift), rel=1e-12)
    if phi_cr is None:
        assert block.critical(1) is None
    else:
        assert printed(block.critical(1), phi_cr) and printed(block.p(1), p) and printed(block.kappa1(1), kappa1)
    (impact,) = simulate(block, release=ALPHA / 2, impacts=1).impacts
    assert printed(impact.time, time) and printed(impact.before, rate)


def test_a_stiff_tendon_has_no_falling_branch():
    assert tendon(0.0, 50.0).terms(1, 0.0).ddV == pytest.approx(0.0, abs=1e-10)  # 2/tan^2(alpha)
    nearly = tendon(0.0, 49.0)
    assert printed(nearly.uplift(1), ".20") and printed(nearly.critical(1) / nearly.kappa1(1), ".99")


def test_a_straight_tie_to_the_top_is_another_thing():
    slender, stiff = (TALL.with_tie((GROUND, 0j), ("block", 5j), k=ea * G / 5) for ea in (20.0, 60.0))
    assert printed(slender.critical(1), ".31266656") and printed(stiff.critical(1), ".85142217")
    assert printed(simulate(slender, release=ALPHA / 2, impacts=1).impacts[0].time, ".683248162")


def test_a_tendon_through_a_column_opens_at_foot_and_top():
    frame = Frame(1.0, 6.0, 8.0, 1.0).with_tie(
        (GROUND, 0j), ("left column", 0j), ("left column", 6j), ("beam", 6j), k=1.0
    )
    phi = np.array([0.0, 0.1, 0.4])
    for s in (1, -1):
        assert frame.elongations(s, phi)[0] == pytest.approx(4 * 0.5 * np.sin(phi / 2), abs=1e-14)


def test_a_bed_is_one_spring_at_its_radius_of_gyration():
    bed = TALL.with_bed("block", -0.5 + 0j, 0.5 + 0j, k=3e2)
    one = TALL.with_tie((GROUND, 0.5 - 1 / sqrt(3) + 0j), ("block", 0.5 - 1 / sqrt(3) + 0j), k=3e2)
    assert bed.terms(1, 0.1).dV == pytest.approx(one.terms(1, 0.1).dV, rel=1e-12)
    assert pytest.approx(one.terms(1, 0.1).V, rel=1e-12) == bed.terms(1, 0.1).V


def test_loads_with_shares_by_hand():
    # About the right foot x' = y and y' = b - x of a point, b half the width.
    h, v, w, M, x, y = 0.7, 1 / 3, 0.5, 2.0, 0.2, 4.0
    block = TALL.with_load("block", complex(x, y), M, horizontal=h, vertical=v, weight=w)
    it = block.terms(1, 0.0)
    inertia, B, V1 = 26 / 3 + M * (h * y**2 + v * (0.5 - x) ** 2), 2.5 + M * h * y, G * (0.5 + M * w * (0.5 - x))
    assert (it.inertia, it.X, it.dV) == pytest.approx((inertia, B, V1), rel=1e-12)
    assert block.uplift(1) == pytest.approx(V1 / (G * B), rel=1e-12)
    # About the left foot x' = -y and y' = b + x.
    inner = -(26 / 3 - 0.5) - M * (h * y**2 - v * (0.5 - x) * (0.5 + x))
    assert block.eta(1) == pytest.approx(-inner / (26 / 3 + M * (h * y**2 + v * (0.5 + x) ** 2)), rel=1e-12)
    force = reactions(block, 1, 0.0, 0.0, u=-block.uplift(1) * G, v=0.0)["foot"]
    assert force.x / G == pytest.approx(-block.uplift(1) * (1 + h * M), rel=1e-10)
    assert force.y / G == pytest.approx(1 + w * M, rel=1e-10)


def test_a_constant_force_on_a_facade():
    # 5 m of .6 x 8 m at 18 kN/m3; what a bar of 24 mm yields at, 7.5 m up; two side walls, h_b = l = .2, 40 courses.
    facade = Block(0.6, 8.0, 432e3 / G)
    assert printed(facade.uplift(1), ".075")
    bar = pi / 4 * 0.024**2 * 235e6
    assert printed(bar / 1e3, "106.311")
    assert printed(facade.with_force("block", -0.3 + 7.5j, -bar + 0j).uplift(1), ".536421")
    interlock = 0.4 * 40 * 41 * 1.0 * 0.577 * 0.2**2 * 0.5 * 18e3
    assert printed(interlock / 1e3, "136.264")
    assert printed(facade.with_force("block", 8j / 3, -2 * interlock + 0j).uplift(1), ".495569")


# Section 2.


@pytest.mark.parametrize(
    ("seat", "rho", "weakest", "at", "middle"),
    [
        (0.15, 0.5, "7.4641016", ".6339746", "8"),
        (0.15, 1.0, "11.656854", ".5857864", "12"),
        (0.15, 2.0, "19.797959", ".5505103", "20"),
        (0.0, 0.5, "5.9494897", ".7101021", "7"),
        (0.0, 1.0, "9", ".6666667", "10"),
        (0.0, 2.0, "14.928203", ".6339746", "16"),
    ],
)
def test_the_weakest_hinge_of_a_spanning_wall(seat, rho, weakest, at, middle):
    wall = replace(WALL, overburden=rho * G, seat=seat)
    assert wall.uplift(1) * 10 == pytest.approx(float(middle), rel=1e-12)
    xi = wall.weakest(1)
    assert printed(xi, at)
    assert replace(wall, hinge=xi).uplift(1) * 10 == pytest.approx(float(weakest), abs=5e-7)
    k = 0.5 + seat / 0.3
    assert xi == pytest.approx(1 / (1 + sqrt(rho * k / (1 + rho))), abs=1e-7)
    mirrored = replace(wall, seat=-seat)
    assert mirrored.weakest(-1) == pytest.approx(xi, abs=1e-7)


def test_the_rotation_that_overturns_a_spanning_wall():
    outer = replace(WALL, seat=0.15)
    weakest = replace(outer, hinge=outer.weakest(1))
    assert outer.uplift(1) == pytest.approx(1.2) and printed(outer.critical(1), ".19739556")
    assert printed(weakest.uplift(1), "1.1656854") and printed(weakest.critical(1), ".16908079")
    assert WALL.uplift(1) == pytest.approx(1.0) and printed(WALL.critical(1), ".1642801")
    assert printed(replace(WALL, support="pivot").critical(1), ".16514868")
    bare = Wall(0.3, 3.0, support="pivot")
    assert bare.uplift(1) == pytest.approx(0.4) and bare.critical(1) == pytest.approx(ALPHA, rel=1e-12)
    assert bare.p(1) == pytest.approx(sqrt(1.5 * G / (sqrt(0.3**2 + 1.5**2) / 2)), rel=1e-11)
    with pytest.raises(AssertionError, match="the whole wall turns"):
        bare.weakest(1)


@pytest.mark.parametrize(
    ("seat", "b", "inertia", "uplift", "delta"),
    [
        (0.0, "6877.92", "1869.935", ".5127572", ".1970525"),
        (0.115, "8027.92", "1964.335", ".5984911", ".23"),
    ],
)
def test_a_wall_of_the_new_zealand_guidelines(seat, b, inertia, uplift, delta):
    weight = 18e3 * 0.23 * 3.6
    wall = Wall(0.23, 3.6, weight / G, overburden=1e4, seat=seat, support="pivot")
    it = wall.terms(1, 0.0)
    assert printed(it.dV, b) and printed(it.inertia, inertia) and printed(wall.uplift(1), uplift)
    assert printed(-it.ddV, "62827.2") and printed(it.dV / -it.ddV * 3.6 / 2, delta)


def test_two_hinges_make_three_bodies():
    wall = Wall(0.3, 3.0, 1000.0, hinge=(0.6, 0.7), overburden=8e3, seat=0.05)
    assert [piece.name for piece in wall.pieces()] == ["lower", "middle", "upper"]
    one = replace(wall, hinge=0.6)
    assert wall.terms(1, 0.1).inertia == pytest.approx(one.terms(1, 0.1).inertia, rel=1e-10)
    # <t+, t-> is the same both ways, so that only the inertias differ.
    ratio = wall.terms(-1, 0.0).inertia / wall.terms(1, 0.0).inertia
    assert wall.eta(1) * ratio == pytest.approx(wall.eta(-1), rel=1e-12)


# Section 3.


def test_a_facade_that_rocks_outwards_only():
    facade, alpha = Block(0.6, 8.0), atan(0.075)
    r = (1 - 1.5 * sin(alpha) ** 2) ** 2 * abs(1 - 1.5 * cos(alpha) ** 2)
    assert printed(r, ".48339479")
    motion = simulate(facade, release=alpha / 2, rebound=r, impacts=5)
    times = [".972727756", "1.63187712", "1.93513964", "2.08017786"]
    peaks = [".091870027", ".020696678", ".0047977362", ".0011190301"]
    assert all(printed(impact.time, time) for impact, time in zip(motion.impacts, times, strict=False))
    assert all(printed(peak.phi / alpha, phi) for peak, phi in zip(motion.peaks[1:], peaks, strict=True))
    assert motion.impacts[0].time == pytest.approx(simulate(facade, release=alpha / 2, impacts=1).impacts[0].time)


def test_the_factors_of_a_rebound():
    # Of a body that turned about one corner and now turns about another, both seen from its centroid:
    # eta = (I + m a.b)/(I + m b^2). From one foot to the other, and from that to the corner that meets the side wall.
    one, other, top = complex(0.3, -4), complex(-0.3, -4), complex(-0.3, 4)
    base, side = (
        (abs(b) ** 2 / 3 + (a.conjugate() * b).real) / (4 / 3 * abs(b) ** 2) for a, b in ((one, other), (other, top))
    )
    assert base == pytest.approx(Block(0.6, 8.0).eta(1), rel=1e-12)
    assert side < 0 and printed(base**2 * abs(side), ".48339479")


# Section 4.


@pytest.mark.parametrize(
    ("phi", "rate", "u", "along", "normal"),
    [
        (0.0, 0.0, -0.2, "-.20000000", "1.00000000"),
        (0.05, 0.2, -0.3, "-.18727819", "1.00622297"),
        (0.1, -0.25, 0.1, "-.04529637", ".96947789"),
    ],
)
def test_the_reaction_of_a_block(phi, rate, u, along, normal):
    force = reactions(TALL, 1, phi, rate, u * G)["foot"]
    assert printed(force.x / G, along) and printed(force.y / G, normal)


@pytest.mark.parametrize(("alpha", "needed"), [(0.1, ".0750621"), (0.2, ".1504866"), (0.3, ".2265818")])
def test_the_friction_that_an_impact_needs(alpha, needed):
    block = Block(tan(alpha), 1.0)
    assert printed(impulses(block, 1)["foot"].friction, needed)
    assert printed(impulses(block, 1)["whole"].friction, needed)


def test_a_lower_eta_needs_far_more_friction():
    block = Block(tan(0.1), 1.0)
    given = impulses(block, 1, block.eta(1) - 0.05)
    assert list(given) == ["whole"] and printed(given["whole"].friction, ".335")


def linear_system(structure, s, phi, rate, u, v, ends):
    """Forces in the joints by Newton and Euler, body by body; `ends` says what a joint bears, on what, and where."""
    pace = structure.acceleration(s, phi, rate, u, v)
    t = 1e-3 * np.arange(-4, 5)
    second = np.array([-1 / 560, 8 / 315, -1 / 5, 8 / 5, -205 / 72, 8 / 5, -1 / 5, 8 / 315, -1 / 560]) / 1e-6
    moved, now = structure.place(s, phi + rate * t + pace * t**2 / 2), structure.place(s, np.array([phi]))
    names = [piece.name for piece in structure.pieces()]
    matrix, right = np.zeros((3 * len(names), 2 * len(ends))), []
    for i, piece in enumerate(structure.pieces()):
        x, y = moved[i].at(piece.centre)
        spin = np.broadcast_to(moved[i].psi, t.shape)
        right += [piece.mass * (x @ second + u), piece.mass * (y @ second + G + v), piece.inertia * (spin @ second)]
    for j, (upper, lower, point) in enumerate(ends):
        for name, sign in ((upper, 1.0), (lower, -1.0)):
            if name in names:
                i = names.index(name)
                (x,), (y,) = now[i].at(point)
                (cx,), (cy,) = now[i].at(structure.pieces()[i].centre)
                matrix[3 * i, 2 * j] = matrix[3 * i + 1, 2 * j + 1] = sign
                matrix[3 * i + 2, 2 * j : 2 * j + 2] = -sign * (y - cy), sign * (x - cx)
    found, *_ = np.linalg.lstsq(matrix, np.array(right))
    assert matrix @ found == pytest.approx(np.array(right), abs=1e-4)
    return found.reshape(-1, 2)


@pytest.mark.parametrize("s", [1, -1])
def test_reactions_are_those_of_newton_and_euler(s):
    wall = Wall(0.3, 3.0, 1000.0, hinge=0.6, seat=0.05)
    left, right, top = -s * 0.15 + 1.8j, s * 0.15 + 0j, 0.05 + 3j
    ends = [("lower", GROUND, right), ("upper", "lower", left), ("upper", GROUND, top)]
    got = reactions(wall, s, 0.05, 0.2, -3.0, 1.0)
    assert np.array([*got.values()]) == pytest.approx(
        linear_system(wall, s, 0.05, 0.2, -3.0, 1.0, ends) * [[1, 1], [1, 1], [1, 0]], abs=1e-3
    )
    a, b, c, d = s * 0.5 + 0j, -s * 0.5 + 6j, 8 - s * 0.5 + 6j, 8 + s * 0.5 - 1.5j
    ends = [("left column", GROUND, a), ("beam", "left column", b), ("beam", "right column", c)]
    ends.append(("right column", GROUND, d))
    got = reactions(FRAME, s, 0.05, 0.2, -3.0, 1.0)
    assert np.array([*got.values()]) == pytest.approx(linear_system(FRAME, s, 0.05, 0.2, -3.0, 1.0, ends), abs=1e-3)


def test_loads_ties_and_forces_are_borne_by_the_joints():
    # The foot and top of a wall carry all of its loads and ties: the sum over the whole, and a tie pulls down.
    tied = Wall(0.3, 3.0, 1000.0).with_tie((GROUND, 5.0 + 0j), ("lower", 0.15 + 1.4j), k=2e4, n0=500.0)
    tied = tied.with_force("upper", 2j, 100.0 - 30.0j).with_load("lower", 1j, 50.0)
    phi = 0.05
    it = reactions(tied, -1, phi, 0.0)
    still, pace = tied.place(-1, np.array([phi])), tied.acceleration(-1, phi, 0.0)
    (x,), (y,) = still[0].at(0.15 + 1.4j)
    pull = 500.0 + 2e4 * float(tied.elongations(-1, np.array([phi]))[0, 0])
    length = abs(complex(x, y) - 5.0)
    h, _, w, _, _ = tied.masses(still)
    circle = 1e-4 * np.array([1.0, -1.0])
    *_, xs, ys = tied.masses(tied.place(-1, phi + circle))
    rise, drift = ((z[:, 0] - z[:, 1]) @ h / 2e-4 * pace for z in (ys, xs))
    assert it["foot"].y == pytest.approx(w.sum() * G + rise + 30.0 + pull * y / length, abs=0.01)
    assert it["foot"].x + it["top"].x == pytest.approx(drift - 100.0 - pull * (5.0 - x) / length, abs=0.01)
    # Where a tendon's points still touch, it pulls straight down.
    assert reactions(tendon(0.2, 60.0), 1, 0.0, 0.0, -0.24 * G)["foot"].y == pytest.approx(1.2 * G, rel=1e-10)


# Section 10.


def test_the_velocity_that_just_overturns():
    block = Block(0.7, 2.8)
    velocity = block.overturning_velocity(1)
    assert printed(velocity, "1.0941633")
    alpha, R = atan(0.25), sqrt(0.35**2 + 1.4**2)
    assert velocity == pytest.approx(sqrt(8 * G * R * (1 - cos(alpha)) / 3) / cos(alpha), rel=1e-11)
    rest = block.terms(1, 0.0)
    ended = [
        simulate(block, rate=velocity * rest.X / rest.inertia * (1 + miss), impacts=1).ended for miss in (1e-6, -1e-6)
    ]
    assert ended == ["overturned", "impacts"]


# Motions.

TIMES = np.linspace(0.0, 0.9, 10)
SHAKING = Ground(TIMES.tolist(), (-4.5 * np.sin(7 * TIMES)).tolist(), (2 * np.cos(9 * TIMES)).tolist())
HEAVY = Block(1.0, 5.0, 1000.0)
TIED = HEAVY.with_tie((GROUND, -10 + 2j), ("block", -0.5 + 4j), k=2e5)
HANGINGS = {
    "nothing": HEAVY,
    "slack": HEAVY.with_tie((GROUND, 0j), ("block", 5j), k=2e5, n0=-300.0),
    "prop": HEAVY.with_tie((GROUND, 2 + 4j), ("block", 0.5 + 4j), k=2e5, acts="compression"),
    "bed": HEAVY.with_bed("block", -0.5 + 0j, 0.5 + 0j, k=1e5, n0=20.0),
    "frame": FRAME.with_load("beam", 3 + 7j, 500.0, weight=0.5, vertical=1 / 3),
    "wall": Wall(0.3, 3.0, 1000.0, hinge=(0.8, 0.85), overburden=300.0, seat=0.05).with_force("lower", 1j, 40 + 0j),
}


@pytest.mark.every(3)
@pytest.mark.parametrize("name", HANGINGS)
def test_energy_put_in_less_what_is_lost_is_stored(name):
    motion = simulate(HANGINGS[name], SHAKING, until=1.2)
    moved = abs(motion.put_in) + motion.in_impacts
    assert motion.uplifts and moved > 1.0
    assert abs(motion.imbalance) < 1e-9 * moved
    assert {event.what for event in motion.events} >= ({"bears", "slack"} if name == "slack" else set())


def test_a_mirror_image_moves_as_the_mirror_image():
    one = TIED.with_force("block", 3j, 200 + 0j).with_load("block", 0.3 + 5j, 100.0)
    other = HEAVY.with_tie((GROUND, 10 + 2j), ("block", 0.5 + 4j), k=2e5)
    other = other.with_force("block", 3j, -200 + 0j).with_load("block", -0.3 + 5j, 100.0)
    mirrored = Ground(SHAKING.times, [-u for u in SHAKING.horizontal], SHAKING.vertical)
    first, second = simulate(one, SHAKING, until=1.2), simulate(other, mirrored, until=1.2)
    assert first.impacts
    for a, b in zip(first.impacts, second.impacts, strict=True):
        assert (a.time, a.side, a.before) == pytest.approx((b.time, -b.side, b.before), rel=1e-7, abs=1e-9)


def test_a_record_is_followed_across_its_samples():
    # A straight ramp is the same however many samples it has; uplift is where it passes lambda.
    whole, cut = Ground([0.0, 0.5], [0.0, -4.0]), Ground([0.0, 0.1, 0.35, 0.5], [0.0, -0.8, -2.8, -4.0])
    one, other = simulate(HEAVY, whole, until=0.8), simulate(HEAVY, cut, until=0.8)
    assert one.uplifts[0] == pytest.approx(0.5 * 0.2 * G / 4.0, rel=1e-12)
    for t in (0.3, 0.5, 0.7):
        assert one.at(t) == pytest.approx(other.at(t), rel=1e-8)


def test_a_ground_that_rises_makes_heavier():
    # All weight shares alike, and what a tie does is not weight.
    block = TIED.with_load("block", 3j, 400.0, weight=0.5, vertical=1 / 3)
    rising = simulate(block, Ground([0.0, 9.0], [0.0, 0.0], [3.0, 3.0]), release=0.1, impacts=2)
    heavier = simulate(replace(block, gravity=G + 3.0), release=0.1, impacts=2)
    assert [impact.time for impact in rising.impacts] == pytest.approx(
        [each.time for each in heavier.impacts], rel=1e-9
    )
    still, heavy = (
        reactions(each, 1, 0.1, 0.3, v=v) for each, v in ((block, 3.0), (replace(block, gravity=G + 3), 0.0))
    )
    assert still["foot"] == pytest.approx(heavy["foot"], rel=1e-11)


def test_it_comes_to_rest_and_stays_below_uplift():
    motion = simulate(Block(0.6, 2.0), release=-0.1, eta=0.5)
    assert motion.ended == "rest" and motion.end < 20.0 and motion.stored == pytest.approx(0.0, abs=1e-9)
    assert [impact.side for impact in motion.impacts[:4]] == [-1, 1, -1, 1]
    assert simulate(HEAVY, Ground([0.0, 1.0], [0.0, 0.19 * G]), until=2.0).uplifts == []

"""Loads, ties, supports and forces by the tool, held to the printed values and to the second program."""

from decimal import Decimal
from functools import cache
from math import atan

import numpy as np
import pytest
from scipy.optimize import brentq

from rocking_cli import load_structure
from rocking_cli.core import Direction, NoEquivalentBlock, equivalent_block
from rocking_cli.core.equivalence import both_statics, impulse_velocity
from rocking_cli.core.registry import Registry
from rocking_cli.dynamics.history import follow
from rocking_cli.structure import Structure, build_models
from tests.oracle import simulate
from tests.twins import Twin, shaking, twin

G = 9.80665
ALPHA = atan(0.2)
MG = 1000 * G
PLUS, MINUS = Direction
TALL = {"width": 1.0, "height": 5.0, "mass": 1000.0}


def printed(value, number):
    """Whether a value is a number as it is printed: to half of its last digit."""
    return abs(value - float(number)) <= 0.500001 * 10.0 ** Decimal(number).as_tuple().exponent


def made(mechanism, **fields):
    return Registry()[mechanism].from_fields(fields)


def free(structure, release, tail=6.0, model="nonlinear", motion=None):
    """A history from a tilt in radians."""
    (model,) = build_models(structure, (model,))
    side = 0 if release > 0 else 1
    return follow(model, motion, release=release / model.phi_cr[side], tail=tail)


@pytest.mark.parametrize(("floor", "sideways"), [("borne", 1.0), ("sliding", 0.0), ("dragged", 1.0)])
def test_a_floor_that_turns_about_its_far_end(floor, sideways):
    """A rod of mass m whose near end goes at v up: m v^2/3 of inertia, m g v/2 of weight; sideways m or nothing."""
    m, at, phi = 300.0, complex(0.2, 5.0), np.array([0.0, 0.1])
    load = {"name": "floor", "mass": m, "at": [at.real, at.imag], "floor": floor}
    bare, laden = made("block", **TALL), made("block", **TALL, loads=[load])
    one, other = (each.coefficients(phi, PLUS) for each in (laden, bare))
    velocity = -1j * np.exp(-1j * phi) * (at - 0.5)  # about the foot at x = .5
    inertia, weight, push = (getattr(one, key) - getattr(other, key) for key in "IGB")
    assert inertia == pytest.approx(m * (sideways * velocity.real**2 + velocity.imag**2 / 3), rel=1e-9)
    assert weight == pytest.approx(m * velocity.imag / 2, rel=1e-9)
    assert push == pytest.approx(m * sideways * velocity.real, rel=1e-9, abs=1e-9 * m)


def test_loads_with_shares_by_hand():
    # About the right foot x' = y and y' = b - x of a point, b half the width; about the left one x' = -y, y' = b + x.
    h, v, w, M, x, y = 0.7, 1 / 3, 0.5, 2000.0, 0.2, 4.0
    load = {"name": "a", "mass": M, "at": [x, y], "horizontal": h, "vertical": v, "weight": w}
    block = made("block", **TALL, loads=[load])
    at = block.coefficients(np.zeros(1), PLUS)
    assert at.I[0] == pytest.approx(26e3 / 3 + M * (h * y**2 + v * (0.5 - x) ** 2), rel=1e-12)
    assert at.B[0] == pytest.approx(2.5e3 + M * h * y, rel=1e-12)
    assert at.G[0] == pytest.approx(500 + M * w * (0.5 - x), rel=1e-12)
    jump = 26e3 / 3 - 500 + M * (h * y**2 - v * (0.5 - x) * (0.5 + x))
    assert block.eta(PLUS) == pytest.approx(jump / (26e3 / 3 + M * (h * y**2 + v * (0.5 + x) ** 2)), rel=1e-12)


# Section 1: the printed values.

TABLE = [
    (0.0, 0.0, ".20", ".19739556", "1.69848858", "1.00000000", ".776257407", ".28976684"),
    (0.2, 0.0, ".24", ".23635507", "1.69980731", ".99769133", ".668605966", ".32602421"),
    (0.0, 20.0, ".20", ".32175055", "1.33757854", "1.60000000", ".682950262", ".308185754"),
    (0.0, 60.0, ".20", None, None, None, ".568788722", ".342061009"),
    (0.2, 60.0, ".24", None, None, None, ".522438978", ".373272954"),
]


@pytest.mark.parametrize(("n0", "ea", "uplift", "phi_cr", "p", "kappa1", "time", "rate"), TABLE)
def test_a_block_with_a_tendon(n0, ea, uplift, phi_cr, p, kappa1, time, rate, tmp_path):
    file = tmp_path / "tall.yaml"
    spring = f"length: 5\n    area: {ea * MG / 2e11!r}\n    modulus: 2e11" if ea else "stiffness: 0"
    file.write_text(
        "mechanism: block\nwidth: 1\nheight: 5\ndensity: 200\ndepth: 1\nties:\n"
        "  - name: tendon\n    from: {ground: [0, 0]}\n    to: {at: [0, 0]}\n"
        f"    {spring}\n    prestress: {n0 * MG!r}\n",
        encoding="utf-8",
    )
    tall = load_structure(file)
    one, other = both_statics(tall)
    assert one.lambda_ == pytest.approx(float(uplift), rel=1e-12) and other.lambda_ == pytest.approx(one.lambda_)
    if phi_cr is None:
        assert one.phi_cr is None and "does not vanish" in one.why_no_block
        with pytest.raises(NoEquivalentBlock):
            equivalent_block(tall)
    else:
        block = equivalent_block(tall).positive
        assert printed(block.phi_cr, phi_cr) and printed(block.p, p) and printed(block.kappa1, kappa1)
    impact = free(tall, ALPHA / 2).impacts[0]
    assert printed(impact[0], time) and printed(-impact[2] if impact[2] < 0 else impact[2], rate)


def test_a_straight_tie_to_the_top_is_another_thing():
    slender, stiff = (
        made("block", **TALL, ties=[{"name": "t", "from": {"ground": [0.0, 0.0]}, "to": {"at": [0.0, 5.0]},
                                     "area": ea * MG / 2e11, "modulus": 2e11}])
        for ea in (20.0, 60.0)
    )  # fmt: skip
    assert printed(both_statics(slender)[0].phi_cr, ".31266656") and printed(both_statics(stiff)[0].phi_cr, ".85142217")
    assert printed(free(slender, ALPHA / 2).impacts[0, 0], ".683248162")


def test_linear_models_of_a_structure_whose_moment_is_not_straight_are_asked_for():
    tie = {"name": "t", "from": {"ground": [0.0, 0.0]}, "to": {"at": [0.0, 0.0]}, "stiffness": 49 * MG / 5}
    tied = Structure(made("block", **TALL, ties=[tie]))
    block = tied.equivalence.positive
    assert printed(block.lambda_, ".20") and printed(block.lambda_lin, ".99")
    assert tied.misleading is not None and tied.default_models == ("nonlinear",)
    tie["stiffness"] = 50.001 * MG / 5
    assert Structure(made("block", **TALL, ties=[tie])).why_no_block is not None


# Section 3 and 10.


def test_a_facade_that_rocks_outwards_only():
    facade, alpha = made("block", width=0.6, height=8.0, one_sided="negative"), atan(0.075)
    assert printed(facade.eta(MINUS), ".48339479")
    history = free(facade, -alpha / 2)
    times = [".972727756", "1.63187712", "1.93513964", "2.08017786"]
    assert all(printed(impact[0], time) for impact, time in zip(history.impacts, times, strict=False))
    assert (history.impacts[:, 1] == -1).all() and history.phi.max() == 0
    peaks = [".091870027", ".020696678", ".0047977362", ".0011190301"]
    for before, after, peak in zip(history.impacts, history.impacts[1:], peaks, strict=False):
        reached = follow_energy(facade, facade.eta(MINUS) * abs(before[2]))
        assert printed(reached / alpha, peak)
        assert abs(after[2]) == pytest.approx(facade.eta(MINUS) * abs(before[2]), rel=1e-8)


def follow_energy(structure, rate):
    """The rotation at which a rate at rest is used up."""
    energy = structure.kinetic_inertia(np.zeros(1), MINUS)[0] * rate**2 / 2
    left = lambda phi: structure.potential_energy(np.array([phi]), MINUS)[0] - energy  # noqa: E731
    return brentq(left, 0.0, structure.critical_rotation(MINUS), xtol=1e-14)


def test_until_its_first_impact_it_is_the_two_sided_block():
    facade = {"width": 0.6, "height": 8.0}
    one = free(made("block", **facade, one_sided="positive"), 0.03).impacts[0]
    assert one.tolist() == free(made("block", **facade), 0.03).impacts[0].tolist()


def test_the_velocity_that_just_overturns():
    block = made("block", width=0.7, height=2.8)
    assert printed(equivalent_block(block).positive.v_imp, "1.0941633")
    tied = twin("block", ties=[tension_bar("block")])
    for side, phi_cr in zip(Direction, (each.phi_cr for each in both_statics(tied.tool)), strict=True):
        expected = tied.oracle.overturning_velocity(int(side))
        assert impulse_velocity(tied.tool, side, phi_cr) == pytest.approx(expected, rel=1e-9)


# The tool and the second program.

ON = {
    "block": ({}, [0.0, 5.0], [-0.5, 3.0], [0.0, 0.0], 98e3, 0.1),
    "rigid_body": ({}, [0.0, 3.0], [-0.8, 2.0], [0.0, 0.0], 76e3, 0.12),
    "asymmetric_frame": ({"body": "left column AB"}, [0.0, 6.0], [-0.5, 4.0], [0.0, 0.0], 61e3, 0.06),
    "symmetric_frame": ({"body": "columns"}, [0.0, 6.0], [-0.5, 4.0], [0.0, 0.0], 59e3, 0.08),
    "wall": ({"body": "lower block"}, [0.05, 1.5], [-0.15, 1.2], [0.05, 0.0], 14.7e3, 0.08),
}
"""Of each mechanism a body, points at its top, side and foot, the weight of all, and a tilt."""


def bar(mechanism, weight, **more):
    body, _, side, _, own, _ = ON[mechanism]
    ends = {"from": {"ground": [-4.0, 1.0]}, "to": {**body, "at": side}}
    return {"name": "tie", **ends, "stiffness": weight * own, **more}


def tension_bar(mechanism):
    return bar(mechanism, 0.3, only="tension")


def hung(mechanism, kind):
    """Return the loads and ties of a mechanism, by the name of its kind."""
    body, top, side, foot, own, _ = ON[mechanism]
    each = {"each": True} if mechanism == "symmetric_frame" else {}
    column = {**body, "at": foot}
    tendon = [{"ground": foot}, column, {**body, "at": top}]
    if mechanism == "symmetric_frame":
        tendon.append({"body": "beam", "at": top})
    return {
        "masses": {
            "loads": [
                {"name": "mass", **body, "at": top, "mass": own / 400, "horizontal": 0.3, "vertical": 0.7, **each},
                {"name": "floor", **body, "at": side, "mass": own / 600, "floor": "borne"},
            ]
        },
        "force": {"loads": [{"name": "thrust", **body, "at": top, "force": [0.01 * own, -0.05 * own], **each}]},
        "both senses": {"ties": [bar(mechanism, 0.3, prestress=0.01 * own)]},
        "tension": {"ties": [bar(mechanism, 3.0, only="tension")]},
        "goes slack": {"ties": [bar(mechanism, 0.5, only="tension", prestress=0.02 * own)]},
        "prop": {"ties": [bar(mechanism, 3.0, only="compression")]},
        "soft tendon": {"ties": [{"name": "t", "path": tendon[:2], "stiffness": 2 * own, **each}]},
        "stiff tendon": {
            "ties": [
                {"name": "t", "path": tendon, "area": 2e-9 * own, "modulus": 2e11, "length": 5.0, "only": "tension",
                 "prestress": 0.1 * own, **each}
            ]
        },
        "bed": {
            "ties": [
                {"name": "b", "bed": {**body, "from": [foot[0] - 0.1, 0.0], "to": [foot[0] + 0.08, 0.0]},
                 "modulus": 2 * own}
            ]
        },
    }[kind]  # fmt: skip


KINDS = ("masses", "force", "both senses", "tension", "goes slack", "prop", "soft tendon", "stiff tendon", "bed")
ONE_SIDED = ("both senses", "tension", "goes slack", "prop")  # what does not do the same in both directions
SLOW = ("asymmetric_frame", "symmetric_frame")  # for the second program: of those every other kind is shaken
pairs = pytest.mark.parametrize(
    ("mechanism", "kind"),
    [
        (mechanism, kind)
        for mechanism in ON
        for kind in (KINDS[SLOW.index(mechanism) :: 2] if mechanism in SLOW else KINDS)
    ],
)
signed = pytest.mark.parametrize(
    ("mechanism", "kind", "side"),
    [(mechanism, kind, s) for mechanism in ON for kind in KINDS for s in ((1, -1) if kind in ONE_SIDED else (1,))],
)


@cache
def both(mechanism, kind) -> Twin:
    return twin(mechanism, **hung(mechanism, kind))


def agree(history, expected):
    """The first impact is right to 1e-8 s and 1e-6 of its rate."""
    assert expected.ended != "overturned" or history.overturned
    if expected.impacts:
        first, found = expected.impacts[0], history.impacts[0]
        assert found[0] == pytest.approx(first.time, abs=1e-8) and found[1] == first.side
        assert abs(found[2]) == pytest.approx(abs(first.before), rel=1e-6)


@pytest.mark.every(12)
@signed
def test_from_a_tilt_it_moves_as_the_second_program_says(mechanism, kind, side):
    structure, tilt = both(mechanism, kind), ON[mechanism][-1]
    until = 2 if kind in ONE_SIDED else 1
    expected = simulate(structure.oracle, release=side * tilt, impacts=until, until=6.0)
    history = free(structure.tool, side * tilt)
    agree(history, expected)
    back = [each.phi for each in expected.peaks if each.side != side]
    if back:
        assert (history.peak_negative if side > 0 else history.peak_positive) == pytest.approx(max(back), rel=1e-6)


@pytest.mark.every(12)
@pairs
def test_shaken_it_moves_as_the_second_program_says(mechanism, kind):
    """With a vertical component, which changes the weight and no tie."""
    structure = both(mechanism, kind)
    motion, ground = shaking(vertical=kind != "bed", factor=FACTORS.get(mechanism, 1.0))
    expected = simulate(structure.oracle, ground, impacts=1, until=1.25)
    # The other program keeps all joints closed, which those of the wall would not stay here.
    (model,) = build_models(structure.tool, ("nonlinear",), opening=1000.0)
    history = follow(model, motion)
    assert history.uplift_time == pytest.approx(expected.uplifts[0], abs=1e-12)
    agree(history, expected)
    times = motion.dt * np.arange(motion.npts)
    seen = times < (expected.impacts[0].time if expected.impacts else expected.end)
    seen &= np.isfinite(history.phi[: times.size])  # until it falls
    turned = [expected.at(t)[0] for t in times[seen]]
    assert history.phi[: times.size][seen] == pytest.approx(turned, rel=1e-6, abs=1e-10)


FACTORS = {"rigid_body": 1.6, "wall": 2.5}
"""On the motion, so that it lifts a mechanism."""

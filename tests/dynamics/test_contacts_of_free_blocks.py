"""Contacts of free blocks: what they do to motion, energy and forces, against closed forms and other programs."""

import runpy
from dataclasses import replace
from math import sqrt

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli import GroundMotion, Registry
from rocking_cli.errors import SolverError
from rocking_cli.studies.engines.blocks import SOFTNESS, BlockModel, time_constant
from rocking_cli.studies.engines.free_blocks import free_blocks
from tests.conftest import EXAMPLES, PROJECT
from tests.penalty import Plate, stacked

pytest.importorskip("mujoco", reason="free blocks need mujoco")

EVIDENCE = runpy.run_path(str(PROJECT / "docs" / "make_free_blocks.py"))
bounce, fall, halved, heavy, released, simulated, slide, structure = (
    EVIDENCE[name] for name in ("bounce", "fall", "halved", "heavy", "released", "simulated", "slide", "structure")
)
PEDESTAL = rk.Block(width=0.7, height=2.8)
rest = pytest.mark.rest


def quick(cases, *of):
    """Return cases of which all but some are of `make test-all`."""
    return [case if case in of else pytest.param(case, marks=rest) for case in cases]


def assembly(**blocks):
    """Return blocks on a wide floor, by their corners."""
    polygons = {name: {"polygon": corners} for name, corners in blocks.items()}
    ground = {"floor": {"polygon": box(-50, 50, -1, 0)}}
    return Registry()["assembly"](density=2000.0, depth=1.0, friction=0.7, blocks=polygons, ground=ground)


def box(left, right, low, high):
    return [[left, low], [right, low], [right, high], [left, high]]


def test_a_block_that_turns_back_is_not_at_rest():
    free = released(rk.Block(width=0.1, height=0.4), 0.2 * 0.24498)
    assert free.motion.at_rest and free.motion.time[-1] > 2
    assert abs(free.phi[-1]) < 1e-6


def test_what_does_not_stand_is_refused():
    free = free_blocks(PEDESTAL)
    with pytest.raises(SolverError, match="as free blocks it does not stand by itself: block moves"):
        BlockModel(replace(free, ground={})).simulate(None)


@pytest.mark.parametrize("deep", [0.05, 0.2])
def test_a_key_rests_in_its_groove(deep):
    low, high = 1.0 - deep, 2.0
    lower = [[0, 0], [1, 0], [1, 1], [0.7, 1], [0.65, low], [0.35, low], [0.3, 1], [0, 1]]
    upper = [[0, 1], [0.3, 1], [0.35, low], [0.65, low], [0.7, 1], [1, 1], [1, high], [0, high]]
    free = simulated(
        assembly(lower=lower, upper=upper), GroundMotion("still", 0.01, np.zeros(20), unit="m/s2"), most=0.2
    )
    assert np.abs(free.motion.moved).max() < 1e-5


@pytest.mark.parametrize("case", quick(EVIDENCE["HALVED"], ("block.yaml", "cosine:0.45g:0.6s")))
def test_contacts_of_half_the_time_constant_change_no_peak(case):
    exact, (by_rule, stiffer) = halved(*case)
    assert stiffer == pytest.approx(by_rule, rel=0.02) == pytest.approx(exact, rel=0.02)


@pytest.mark.parametrize(
    "case",
    quick(EVIDENCE["BOUNCES"], (5, 0.1, 0.6)),
)
def test_a_block_does_what_its_own_restitution_says_which_is_kinematic(case):
    found = bounce(*case)
    assert found.eta == pytest.approx(found.kinematic, abs=0.002)
    assert found.times < 0.01 and found.peaks < 0.01


@pytest.mark.parametrize("case", quick(EVIDENCE["FALLING"], "walls/floor_wall.yaml", "masonry/wall_of_three.yaml"))
def test_what_is_let_go_falls_as_fast_as_the_exact_one(case):
    exact, free = fall(case)
    assert free == pytest.approx(exact, rel=0.003)


@pytest.mark.parametrize(("finer", "close"), [(1.0, 1e-3), pytest.param(2.0, 3e-3, marks=rest)])
def test_a_block_slides_by_the_closed_form_and_else_creeps_by_microns(finer, close):
    for push in (0.3, 0.39):
        assert slide(push, 0.4, finer)[0] == pytest.approx(0.0, abs=1e-5)
    for push, friction in ((0.5, 0.4), (0.7, 0.6)):
        free, exact = slide(push, friction, finer)
        assert free == pytest.approx(exact, rel=close)


@pytest.mark.parametrize("case", quick([(n, t) for n in EVIDENCE["FREE"] for t in (0.2, 0.4)], ("wall.yaml", 0.2)))
def test_energy_of_a_release_does_not_grow(case):
    name, tilt = case
    of = structure(name)
    assert released(of.mechanism, tilt * of.model("nonlinear").phi_cr[0], most=6.0).growth() < 1e-3


@rest
@pytest.mark.parametrize("name", EVIDENCE["FREE"])
def test_energy_does_not_grow_after_a_pulse(name):
    of = structure(name)
    pulse = rk.parse_pulse(f"sine:{1.5 * min(of.model('nonlinear').lambda_):.3g}g:0.5s").sampled()
    free = simulated(of.mechanism, pulse)
    assert free.motion.at_rest and free.growth(start=pulse.duration) < 1e-3


def test_weight_beside_a_small_block_does_not_stiffen_contacts():
    free = free_blocks(assembly(tower=box(0, 2, 0, 6), pebble=box(5, 5.2, 0, 0.2)))
    assert time_constant(free) == pytest.approx(SOFTNESS * sqrt(0.2 / sqrt(2) / 9.80665))
    on_top = free_blocks(assembly(tower=box(0, 2, 0.2, 6), pebble=box(0, 2, 0, 0.2)))
    assert time_constant(on_top) == pytest.approx(SOFTNESS * sqrt(0.4 / sqrt(4.04) * 10 / 29 / 9.80665))


@rest
def test_weight_on_small_blocks_stiffens_contacts():
    bare = heavy(1.0)[2]
    for ratio in (1.0, 10.0, 100.0, 1000.0):
        exact, free, time_constant = heavy(ratio)
        most = 0.015 if ratio == 100.0 else 0.005  # that second maximum depends on the smallest change
        assert free == pytest.approx(exact, rel=most)
    without = heavy(ratio, time_constant / bare)
    assert abs(without[1] / exact - 1) > 0.01


def portal(scale=1.0, mirrored=False):
    edges = (box(0, 0.9, 0, 3.4), box(2.9, 3.7, 0, 3.4), box(-0.1, 3.9, 3.4, 4.1))
    turned = [[[-x if mirrored else x, y] for x, y in corners] for corners in edges]
    scaled = [[[scale * x, scale * y] for x, y in corners] for corners in turned]
    return assembly(**dict(zip(("left", "right", "lintel"), scaled, strict=True)))


@rest
@pytest.mark.parametrize("scale", [0.1, 10.0])
def test_ten_times_the_size_has_the_same_rotation_in_longer_time(scale):
    found = []
    for factor in (1.0, scale):
        dt = 0.005 * sqrt(factor)
        push = 4.4 * np.sin(2 * np.pi * np.arange(141) * 0.005 / 0.7)
        found.append(simulated(portal(factor), GroundMotion("pulse", dt, push, unit="m/s2")).phi[:400])
    assert found[1] == pytest.approx(found[0], abs=0.01 * np.abs(found[0]).max())


@rest
def test_the_mirrored_structure_has_the_mirrored_motion():
    push = rk.parse_pulse("sine:0.45g:0.7s").sampled()
    one, other = (
        simulated(portal(mirrored=sign < 0), push.scaled(sign)).phi[:400] for sign in (1, -1)
    )  # fmt: skip
    assert other == pytest.approx(-one, abs=1e-3 * np.abs(one).max())


@rest
@pytest.mark.parametrize("pulse", ["sine:0.45g:0.6s", "sine:0.6g:0.4s"])
def test_a_stack_does_as_by_springs_in_its_contacts(pulse):
    """Both blocks rock, the upper one on the lower: two degrees of freedom, by a program of its own."""
    sizes = ((0.8, 2.0), (0.6, 1.8))
    (width, height), (narrow, high) = sizes
    of = assembly(
        lower=box(-width / 2, width / 2, 0, height), upper=box(-narrow / 2, narrow / 2, height, height + high)
    )
    motion = rk.parse_pulse(pulse).sampled()
    free = simulated(of, motion, most=1.3)
    turned = stacked([Plate(*size, 2000.0) for size in sizes], 0.7, motion.dt, motion.acceleration, free.motion.time)
    peak = np.abs(turned).max(axis=0)
    assert peak.min() > 0.01
    assert free.motion.moved[:, :, 2] == pytest.approx(turned, abs=0.02 * peak.max())


@pytest.mark.every(4)
@pytest.mark.parametrize("file", ["block", "arch", "frame", "masonry/buttressed_arch", "walls/floor_wall"])
@pytest.mark.parametrize("phi", [1e-4, -1e-4, 0.05, -0.05])
def test_blocks_that_move_as_the_mechanism_have_its_rotation(file, phi):
    mechanism = rk.load_structure(EXAMPLES / f"{file}.yaml")
    free = free_blocks(mechanism)
    assert free.rotation(free.tilted(mechanism, phi)[None])[0] == pytest.approx(phi, rel=1e-6)

"""Bodies that only slide: the rule, the slip against a loop of small steps, neighbours, edges and walls."""

from __future__ import annotations

from math import log, nan
from statistics import NormalDist

import numpy as np
import pytest

from rocking_cli import GroundMotion, Registry
from rocking_cli.core import Mechanism
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.history import History, follow
from rocking_cli.structure import build_models
from rocking_cli.studies.neighbours import Neighbourhood, neighbours

G = 9.80665


def made(name: str = "block", **fields: object) -> Mechanism:
    return Registry()[name](**fields)


def run(mechanism: Mechanism, motion: GroundMotion, **options: float) -> History:
    (model,) = build_models(mechanism, ("nonlinear",))
    return follow(model, motion, **options)


def noise(seed: int, *, dt: float = 0.05, size: float = 6.0, vertical: float | None = None) -> GroundMotion:
    random = np.random.default_rng(seed)
    up = GroundMotion("up", vertical, random.normal(0.0, 2.0, 200)) if vertical is not None else None
    return GroundMotion("noise", dt, size * random.normal(0.0, 1.0, 120), vertical=up)


def stepped(
    motion: GroundMotion, friction: float, *, mass: float = 1.0, thrust: complex = 0j, h: float = 1e-5
) -> tuple:
    """Return largest and last displacement and path of a mass on a rough floor, step by step."""
    up = motion.vertical
    longest = max(motion.duration, up.duration if up is not None else 0.0)
    time = np.arange(0.0, longest + 8.0, h) + h / 2
    ground = np.interp(time, motion.time, motion.acceleration, right=0.0)
    lift = np.interp(time, up.time, up.acceleration, right=0.0) if up is not None else np.zeros(time.size)
    x = v = path = low = high = 0.0
    for a, g in zip(ground.tolist(), (G + lift).tolist(), strict=True):
        drive, bound = thrust.real / mass - a, friction * (g - thrust.imag / mass)
        if v == 0 and abs(drive) <= bound:
            continue
        sense = np.sign(v) if v else np.sign(drive)
        after, step = v + h * (drive - sense * bound), h
        if v and after * sense < 0:  # it stops on the way
            step, after = h * v / (v - after), 0.0
        x, path, v = x + step * (v + after) / 2, path + step * abs(v + after) / 2, after
        low, high = min(low, x), max(high, x)
    return (high if high >= -low else low), x, path


def test_slip_of_a_flat_block_is_that_of_the_closed_form() -> None:
    motion = GroundMotion("step", 0.01, np.full(41, 0.5 * G))
    found = run(made(width=1.0, height=0.8, friction=0.2), motion)
    speed = 0.3 * G * 0.4
    distance = 0.3 * G * 0.4**2 / 2 + speed**2 / (2 * 0.2 * G)
    assert distance == pytest.approx(0.588399, rel=1e-9)
    assert found.slid is not None
    assert (found.slid.largest, found.slid.residual, found.slid.path) == pytest.approx(
        (-distance, -distance, distance), rel=1e-12
    )
    assert found.words == "does not overturn; slides"
    assert (found.unknown, found.overturned, found.peak_ratio, found.slip) == (
        False,
        False,
        0.0,
        abs(found.slid.largest),
    )
    assert found.end_time == pytest.approx(0.4 + speed / (0.2 * G), rel=1e-12)
    # Its history: even acceleration, and even slowing down to the end.
    t = found.time
    after = np.minimum(t - 0.4, speed / (0.2 * G))
    expected = np.where(t <= 0.4, 0.15 * G * t**2, 0.15 * G * 0.16 + speed * after - 0.1 * G * after**2)
    assert found.slid.displacement == pytest.approx(-expected, abs=1e-12)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("vertical", [None, 0.02, 0.013])
def test_slip_is_that_of_small_steps(seed: int, vertical: float | None) -> None:
    motion = noise(seed, vertical=vertical)
    found = run(made(width=1.0, height=0.8, friction=0.25), motion)
    assert found.slid is not None
    expected = stepped(motion, 0.25)
    assert (found.slid.largest, found.slid.residual, found.slid.path) == pytest.approx(expected, abs=1e-4)
    assert expected[2] > 1.2 * abs(expected[0]) > 0.1  # it slides in both senses
    assert np.nanmax(np.abs(found.slid.displacement)) <= abs(found.slid.largest) + 1e-12


def test_thrusts_push_the_body_on() -> None:
    loads = [{"name": "thrust", "force": [300.0, -500.0], "at": [0.0, 0.1]}]
    found = run(made(width=1.0, height=0.8, mass=200.0, friction=0.3, loads=loads), motion := noise(3, vertical=0.02))
    assert found.slid is not None
    expected = stepped(motion, 0.3, mass=200.0, thrust=300 - 500j)
    assert (found.slid.largest, found.slid.residual, found.slid.path) == pytest.approx(expected, abs=1e-4)

"""Bodies that only slide: the rule, the slip against a loop of small steps, neighbours, edges and walls."""

from __future__ import annotations

from math import isnan, log
from statistics import NormalDist

import numpy as np
import pytest

from rocking_cli import GroundMotion, Registry
from rocking_cli.core import Mechanism
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.history import History, follow
from rocking_cli.dynamics.sliding import sliding_of
from rocking_cli.errors import MechanismError
from rocking_cli.structure import build_models
from rocking_cli.studies.neighbours import Neighbourhood, neighbours
from rocking_cli.views.verdict import why_unknown
from tests.following import build_model, conditions

G = 9.80665


def made(name: str = "block", **fields: object) -> Mechanism:
    return Registry()[name](**fields)


def run(mechanism: Mechanism, motion: GroundMotion, **options: float) -> History:
    (model,) = build_models(mechanism, ("nonlinear",))
    return follow(model, motion, **options)


def noise(seed: int, *, dt: float = 0.05, size: float = 6.0, vertical: float | None = None) -> GroundMotion:
    random = np.random.default_rng(seed)
    up = GroundMotion("up", vertical, random.normal(0.0, 2.0, 200), unit="m/s2") if vertical is not None else None
    return GroundMotion("noise", dt, size * random.normal(0.0, 1.0, 120), vertical=up, unit="m/s2")


def stepped(
    motion: GroundMotion, friction: float, *, mass: float = 1.0, thrust: complex = 0j, h: float = 5e-5
) -> tuple:
    """Return largest and last displacement and path of a mass on a rough floor, step by step."""
    up = motion.vertical
    longest = max(motion.duration, up.duration if up is not None else 0.0)
    time = np.arange(0.0, longest + 3.0, h) + h / 2
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
    assert v == 0
    return (high if high >= -low else low), x, path


def test_slip_of_a_flat_block_is_that_of_the_closed_form() -> None:
    motion = GroundMotion("step", 0.01, np.full(41, 0.5 * G), unit="m/s2")
    found = run(made(width=1.0, height=0.8, friction=0.2), motion)
    speed = 0.3 * G * 0.4
    distance = 0.3 * G * 0.4**2 / 2 + speed**2 / (2 * 0.2 * G)
    assert distance == pytest.approx(0.588399, rel=1e-9)
    assert found.slid is not None
    assert (found.slid.largest, found.slid.residual, found.slid.path) == pytest.approx(
        (-distance, -distance, distance), rel=1e-12
    )
    assert found.words == "does not overturn; slides"
    assert (found.unknown, found.overturned, found.peak_ratio) == (False, False, 0.0)
    assert found.slip == abs(found.slid.largest)
    assert found.end_time == pytest.approx(0.4 + speed / (0.2 * G), rel=1e-12)
    # Its history: even acceleration, and even slowing down to the end.
    t = found.time
    after = np.minimum(t - 0.4, speed / (0.2 * G))
    expected = np.where(t <= 0.4, 0.15 * G * t**2, 0.15 * G * 0.16 + speed * after - 0.1 * G * after**2)
    assert found.slid.displacement == pytest.approx(-expected, abs=1e-12)


@pytest.mark.every(3)
@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("vertical", [None, 0.02, 0.013])
def test_slip_is_that_of_small_steps(seed: int, vertical: float | None) -> None:
    motion = noise(seed, vertical=vertical)
    found = run(made(width=1.0, height=0.8, friction=0.25), motion)
    assert found.slid is not None
    expected = stepped(motion, 0.25)
    assert (found.slid.largest, found.slid.residual, found.slid.path) == pytest.approx(expected, abs=4e-4)
    assert expected[2] > 1.2 * abs(expected[0]) > 0.1  # it slides in both senses
    assert np.nanmax(np.abs(found.slid.displacement)) <= abs(found.slid.largest) + 1e-12


def test_thrusts_push_the_body_on() -> None:
    loads = [{"name": "thrust", "force": [300.0, -500.0], "at": [0.0, 0.1]}]
    found = run(made(width=1.0, height=0.8, mass=200.0, friction=0.3, loads=loads), motion := noise(3, vertical=0.02))
    assert found.slid is not None
    expected = stepped(motion, 0.3, mass=200.0, thrust=300 - 500j)
    assert (found.slid.largest, found.slid.residual, found.slid.path) == pytest.approx(expected, abs=4e-4)


def test_many_runs_are_those_of_single_histories() -> None:
    mechanisms = [made(width=1.0, height=0.8, friction=mu) for mu in (0.2, 0.35)]
    models = [model for each in mechanisms for model in build_models(each, ("nonlinear",))]
    motions = [noise(1, dt=0.01), noise(2, dt=0.05, vertical=0.02)]
    runs = Runs.every(2, 2, scales=(0.5, 1.0), polarities=(1, -1))
    many = respond_many(models, motions, runs)
    for k in range(len(runs)):
        motion = motions[runs.record[k]].scaled(float(runs.scale[k] * runs.polarity[k]))
        alone = follow(models[runs.model[k]], motion)
        assert many.slip[k] == pytest.approx(alone.slip, rel=1e-12)
        assert many.end_time[k] == pytest.approx(alone.end_time, rel=1e-12)
        assert many.warned[k] == pytest.approx(alone.warned, nan_ok=True)
    assert (many.slip > 0).all() and not many.unknown.any() and not many.fell.any()
    halves = many.slip.reshape(2, 2, 2, 2)[..., 0] / many.slip.reshape(2, 2, 2, 2)[..., 1]
    assert halves == pytest.approx(1.0)  # a motion reversed slides as far the other way


def test_a_body_that_may_rock_is_as_before() -> None:
    """The ends of the foot of a block press at T = mu N as long as mu h < b."""
    motion = noise(1)
    (low,), (high,) = (
        build_models(made(width=0.4, height=0.9, friction=mu), ("nonlinear",))
        for mu in (0.4 / 0.9 - 1e-6, 0.4 / 0.9 + 1e-6)
    )
    assert follow(low, motion).slid is not None
    assert follow(high, motion).slid is None
    assert follow(low, motion, release=0.2).slid is None
    assert low.sliding is not None and low.sliding.friction_to_rock == pytest.approx(0.4 / 0.9, rel=1e-12)


def test_a_thrust_decides_at_the_extremes_of_the_vertical_motion() -> None:
    """T = -mu N moves the resultant of weight and inertia by mu h; a thrust F at height z by F (h - z)/N besides."""
    width, height, mass, mu, force, at = 1.0, 2.0, 1000.0, 0.3, 1500.0, 1.8
    loads = [{"name": "thrust", "force": [force, 0.0], "at": [0.0, at]}]
    (model,) = build_models(made(width=width, height=height, mass=mass, friction=mu, loads=loads), ("nonlinear",))

    def far(up: float) -> float:
        """Return how far the reaction is from the middle of the foot as it slides, over half the width."""
        normal = mass * (G + up)
        return max(
            abs(sense * mu * normal * height / 2 + force * (at - height / 2)) / normal / (width / 2)
            for sense in (1, -1)
        )

    light = next(up for up in np.arange(0.0, -G, -1e-3) if far(up) >= 1)
    for up, holds in ((light + 0.01, True), (light - 0.01, False)):
        motion = GroundMotion(
            "both", 0.1, [0.0, 1.0, 0.0], vertical=GroundMotion("up", 0.1, [0.0, up, 0.0], unit="m/s2"), unit="m/s2"
        )
        assert (follow(model, motion).slid is not None) is holds
    weightless = GroundMotion(
        "both", 0.1, [0.0, 1.0, 0.0], vertical=GroundMotion("up", 0.1, [0.0, -G, 0.0], unit="m/s2"), unit="m/s2"
    )
    assert run(made(width=1.0, height=0.8, friction=0.2), weightless).slid is None


def test_ties_and_walls_at_its_side_leave_a_body_as_it_was() -> None:
    tie = {"name": "bar", "from": {"ground": [-3.0, 0.7]}, "to": {"at": [0.0, 0.7]}, "stiffness": 1e4}
    fields = {"width": 1.0, "height": 0.8, "friction": 0.2}
    for mechanism in (
        made(**fields, mass=100.0, ties=[tie]),
        made(**fields, one_sided="positive", rebound=0.3),
        made(width=1.0, height=0.8),
        made("wall", height=3.0, thickness=0.3, friction=0.2),
    ):
        assert build_models(mechanism, ("nonlinear",))[0].sliding is None


def test_each_neighbour_is_judged_with_its_own_slenderness() -> None:
    sliding = made(width=0.4, height=0.9, friction=0.42)
    model = build_model(sliding, "nonlinear")
    motion = GroundMotion("step", 0.01, np.full(60, 0.9 * G), unit="m/s2")
    found = neighbours(conditions(sliding, Neighbourhood(1000)), motion)
    expected = NormalDist().cdf(log(0.42 / (0.4 / 0.9)) / 0.10)
    assert found.unknown == pytest.approx(expected, abs=0.03)
    assert found.slides == pytest.approx(1 - expected, abs=0.03)
    assert (found.overturned, found.at_most) == (0.0, found.unknown)
    two = respond_many([model], [motion], Runs.of(0, 0, slender=[0.94, 0.95]))  # 0.42 h/b is .945
    assert two.unknown.tolist() == [True, False]
    exact = neighbours(conditions(sliding, Neighbourhood(100, slenderness=0.0)), motion)
    assert (exact.unknown, exact.slides) == (0.0, 1.0)
    # x = (a - mu g) t^2/2 (1 + (a - mu g)/(mu g)) for each amplitude.
    draws = Neighbourhood(100, slenderness=0.0).drawn(model)
    drive, grip = 0.9 * G * draws.amplitude - 0.42 * G, 0.42 * G
    slips = np.sort(drive * 0.59**2 / 2 * (1 + drive / grip))
    assert exact.slip == pytest.approx([slips[15], slips[49], slips[83]], rel=1e-9)


ONE_BLOCK = {"b": {"polygon": [[0.0, 0.0], [1.0, 0.0], [0.8, 2.0], [0.2, 2.0]]}}


def assembly(mu: float = 0.2, **ground: list[list[float]]) -> Mechanism:
    return made("assembly", blocks=ONE_BLOCK, friction=mu, ground={name: {"polygon": z} for name, z in ground.items()})


def box(left: float, right: float, low: float, high: float) -> list[list[float]]:
    return [[left, low], [right, low], [right, high], [left, high]]


def test_it_slides_to_what_is_drawn_beside_it() -> None:
    kerb = [[-0.5, 0.0], [-0.15, 0.0], [-0.1, 0.5], [-0.5, 0.5]]
    cases = [
        ({"floor": box(-3, 5, -1, 0)}, (3.0, "the edge of floor"), (4.0, "the edge of floor")),
        (
            {"floor": box(-3, 1.3, -1, 0), "slab": box(1.3, 2, -1, 0)},
            (3.0, "the edge of floor"),
            (1.0, "the edge of slab"),
        ),
        (
            {"floor": box(-3, 1.3, -1, 0), "step": box(1.3, 2, -1, -0.1)},
            (3.0, "the edge of floor"),
            (0.3, "the edge of floor"),
        ),
        ({"floor": box(-3, 5, -1, 0), "kerb": kerb}, (0.15, "kerb"), (4.0, "the edge of floor")),
        ({"floor": box(-3, 5, -1, 0), "shelf": box(1.1, 3, 1.5, 1.7)}, (3.0, "the edge of floor"), (0.25, "shelf")),
        (
            {"floor": box(-3, 5, -1, 0), "roof": box(1.1, 3, 2.0, 2.2)},
            (3.0, "the edge of floor"),
            (4.0, "the edge of floor"),
        ),
    ]
    for ground, *expected in cases:
        sliding = sliding_of(assembly(**ground))
        assert sliding is not None
        for found, (distance, name) in zip(sliding.clear, expected, strict=True):
            assert found.words == name
            assert found.distance == pytest.approx(distance, rel=1e-9)
    assert sliding_of(made(width=1.0, height=0.8, friction=0.2)).clear[0].distance == np.inf


def test_stops_bound_the_slip() -> None:
    stops = [{"point": [0.5, 0.8], "gap": 0.05, "name": "wall"}, {"point": [-0.5, 0.2], "gap": -0.02}]
    (model,) = build_models(made(width=1.0, height=0.8, friction=0.2, stops=stops), ("nonlinear",))
    assert model.sliding is not None
    assert [(each.distance, each.words) for each in model.sliding.clear] == [(0.02, "the stop"), (0.05, "wall")]
    assert not model.symmetric


def test_it_is_known_until_it_arrives() -> None:
    motion = GroundMotion("step", 0.01, np.full(41, 0.5 * G), unit="m/s2")  # it slides to the left
    (model,) = build_models(assembly(floor=box(-0.1, 9, -1, 0)), ("nonlinear",))
    found = follow(model, motion)
    assert found.known_to == pytest.approx((2 * 0.1 / (0.3 * G)) ** 0.5, rel=1e-12)
    assert (found.unknown, found.overturned, found.words) == (True, None, "unknown")
    assert found.slid is not None and isnan(found.slid.residual)
    assert (found.slid.largest, found.slid.path) == pytest.approx((-0.1, 0.1), rel=1e-12)
    assert np.isnan(found.slid.displacement[found.time > found.known_to]).all()
    assert why_unknown(found) == "it slides to the edge of floor, 0.1 m away"
    assert not follow(model, motion.scaled(-1)).unknown
    # On the way after the record, too: v^2/2 = mu g s.
    short = GroundMotion("short", 0.01, np.full(21, 0.5 * G), unit="m/s2")
    late = follow(model, short)
    speed, gone = 0.3 * G * 0.2, 0.15 * G * 0.2**2
    left = (speed**2 - 2 * 0.2 * G * (0.1 - gone)) ** 0.5
    assert late.known_to == pytest.approx(0.2 + (speed - left) / (0.2 * G), rel=1e-12)
    # It turns back before: as far as it goes, it does not arrive.
    assert not follow(model, motion.scaled(0.5)).unknown


def test_a_block_of_an_assembly_slides_as_a_block_does() -> None:
    motion = noise(1)
    one = made("assembly", friction=0.2, ground={"floor": {"polygon": box(-9, 9, -1, 0)}},
               blocks={"b": {"polygon": box(-0.5, 0.5, 0, 2)}})  # fmt: skip
    drawn, block = run(one, motion), run(made(width=1.0, height=2.0, friction=0.2), motion)
    assert drawn.slid is not None and block.slid is not None
    assert drawn.slid.path == pytest.approx(block.slid.path, rel=1e-9)
    assert one.uplift(1) == pytest.approx(0.5, rel=1e-9)
    weakest = one.collapse(1)
    assert weakest is not None and weakest.slides == ["floor and b"] and weakest.lambda_ == pytest.approx(0.2)
    two = {"b": {"polygon": box(-0.5, 0.5, 0, 2)}, "c": {"polygon": box(-0.5, 0.5, 2, 3)}}
    floor = {"floor": {"polygon": box(-9, 9, -1, 0)}}
    upper = made("assembly", friction=0.2, friction_of={"b and c": 0.1}, ground=floor, blocks=two)
    lid = {"lid": {"polygon": box(-2, 2, 2, 3)}}
    confined = made("assembly", friction=0.2, ground=floor | lid, blocks={"b": two["b"]})  # it can only slide
    for slides in (upper, confined):
        with pytest.raises(MechanismError, match="no rocking model exists for sliding"):
            build_models(slides, ("nonlinear",))


def test_a_flat_block_that_only_slides_needs_no_restitution():
    flat = Registry()["block"](width=1.0, height=0.3, friction=0.3)
    (model,) = build_models(flat, ("nonlinear",))
    found = follow(model, GroundMotion("push", 0.2, np.full(3, 0.5 * G), unit="m/s2"))
    speed = 0.2 * G * 0.4
    assert abs(found.slid.largest) == pytest.approx(speed * 0.4 / 2 + speed**2 / (2 * 0.3 * G), rel=1e-12)

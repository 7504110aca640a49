"""Structures at rest: what slides or opens before it rocks, beside sums over time and lever arms of their own."""

import numpy as np
import pytest
import yaml

import rocking_cli as rk
from rocking_cli import GroundMotion
from rocking_cli.core import Direction
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.resting import first_failure, resting
from rocking_cli.structure import build_models
from tests.cli.test_cli import run, run_json
from tests.conftest import YAML_FILES
from tests.following import respond

G = 9.80665
SQUAT = {"width": 0.8, "height": 1.6, "density": 2000.0, "depth": 1.0}
# A spring too weak to matter, with which it is checked as any structure, not followed as a body that only slides.
WEAK = {"ties": [{"name": "hair", "from": {"ground": [-9.0, 0.8]}, "to": {"at": [0.0, 0.8]}, "stiffness": 1e-6}]}
# A slender stone on a base, and a pinnacle on a slender buttress; what is fixed there is no mechanism of its own.
STACKS = {
    "stone": """
mechanism: linkage
density: 2400
depth: 1
friction: 0.7
bodies:
  base: {polygon: [[-0.5, 0], [0.5, 0], [0.5, 1], [-0.5, 1]]}
  top: {polygon: [[-0.1, 1], [0.1, 1], [0.1, 3.0], [-0.1, 3.0]]}
positive:
  lead: base
  joints: {A: {pivot: base, at: [0.5, 0]}, F: {fixed: [base, top]}}
negative: mirror
""",
    "pinnacle": """
mechanism: linkage
density: 2400
depth: 1
friction: 0.7
bodies:
  buttress: {polygon: [[-0.3, 0], [0.3, 0], [0.3, 4], [-0.3, 4]]}
  pin: {polygon: [[-0.3, 4], [0.3, 4], [0.3, 5.2], [-0.3, 5.2]]}
positive:
  lead: pin
  joints: {O: {hinge: [buttress, pin], at: [0.3, 4]}, rest: {fixed: [buttress, ground]}}
negative: mirror
""",
}
CRACKS = """
mechanism: linkage
friction: 0.8
density: 1800
depth: 1.0
bodies:
  lower:  {polygon: [[-0.15, 0.0], [0.15, 0.0], [0.15, 1.6], [-0.15, 1.6]]}
  middle: {polygon: [[-0.15, 1.6], [0.15, 1.6], [0.15, 2.1], [-0.15, 2.1]]}
  upper:  {polygon: [[-0.15, 2.1], [0.15, 2.1], [0.15, 3.2], [-0.15, 3.2]]}
positive:
  lead: lower
  joints:
    A: {pivot: lower, at: [0.15, 0.0]}
    B: {hinge: [middle, upper], at: [-0.15, 2.1]}
    C: {slide: upper, at: [0.15, 3.2], along: [0.0, 1.0]}
    closed: {fixed: [lower, middle]}
negative:
  lead: lower
  joints:
    A': {pivot: lower, at: [-0.15, 0.0]}
    B': {hinge: [lower, middle], at: [0.15, 1.6]}
    C': {slide: upper, at: [-0.15, 3.2], along: [0.0, 1.0]}
    closed: {fixed: [middle, upper]}
"""


# Slender stones on bases carry a beam: statics does not determine the forces of its many joints.
STONES = """
density: 2400
depth: 1
bodies:
  left base: {polygon: [[0, 0], [1, 0], [1, 1], [0, 1]]}
  left stone: {polygon: [[0.4, 1], [0.6, 1], [0.6, 3], [0.4, 3]]}
  right base: {polygon: [[4, 0], [5, 0], [5, 1], [4, 1]]}
  right stone: {polygon: [[4.4, 1], [4.6, 1], [4.6, 3], [4.4, 3]]}
  beam: {polygon: [[0.4, 3], [4.6, 3], [4.6, 3.4], [0.4, 3.4]]}
positive:
  lead: left base
  joints:
    A: {pivot: left base, at: [1, 0]}
    B: {hinge: [left stone, beam], at: [0.4, 3]}
    C: {hinge: [right stone, beam], at: [4.4, 3]}
    D: {pivot: right base, at: [5, 0]}
    one: {fixed: [left base, left stone]}
    two: {fixed: [right base, right stone]}
negative: mirror
"""


def of(text):
    return rk.Linkage(**{key: each for key, each in yaml.safe_load(text).items() if key != "mechanism"})


def slid(time, u, v, friction):
    """How far a body slides in all on rough ground, by sums: of an acceleration straight between its samples."""
    fine = np.linspace(0.0, time[-1] + 5.0, 60 * len(time))
    u, v = (np.interp(fine, time, each, right=0.0) for each in (u, v))
    rate, total, h = 0.0, 0.0, fine[1]
    for push, lift in zip(u.tolist(), v.tolist(), strict=True):
        grip = friction * max(G + lift, 0.0)
        if rate == 0.0 and abs(push) <= grip:
            continue
        way = np.sign(rate) if rate else -np.sign(push)
        then = rate + (-push - way * grip) * h
        then = 0.0 if rate and then * rate <= 0 else then
        total, rate = total + h * abs(rate + then) / 2, then
    return total


def pulse(a, period, dt=0.01, cycles=1, vertical=0.0):
    time = np.arange(int(cycles * period / dt) + 2) * dt
    wave = np.where(time < cycles * period, np.sin(2 * np.pi * time / period), 0.0)
    up = GroundMotion("up", dt, vertical * G * np.cos(9 * time), unit="m/s2") if vertical else None
    return GroundMotion("pulse", dt, a * G * wave, vertical=up, unit="m/s2")


@pytest.mark.parametrize("vertical", [0.0, 0.1])
@pytest.mark.parametrize("a", [0.35, 0.42])
def test_a_squat_block_slides_as_far_as_the_ground_leaves_it(a, vertical):
    motion = pulse(a, 0.8, cycles=2, vertical=vertical)
    block = rk.Block(**SQUAT, **WEAK, friction=0.3)
    found = respond(block, motion, opening=10.0, models=("nonlinear",))["nonlinear"]
    up = motion.vertical.acceleration if vertical else 0 * motion.acceleration
    expected = slid(motion.time, motion.acceleration, up, 0.3)
    assert expected > 0.01 and not found.lifted
    assert found.check.largest == pytest.approx(expected, rel=0.01)
    assert found.check.largest_joint == "the ground and block"
    known = respond(block, motion, models=("nonlinear",))["nonlinear"]
    assert known.unknown and known.check.reason == "slides" and known.warned < known.known_to
    beyond = abs(motion.acceleration) > 0.3 * (G + up)
    assert known.warned == pytest.approx(motion.time[beyond.argmax()], abs=0.011)
    alone = respond(rk.Block(**SQUAT, friction=0.3), motion, models=("nonlinear",))["nonlinear"]
    assert not alone.unknown and alone.slid.path == pytest.approx(expected, rel=0.001)
    assert alone.warned == pytest.approx(known.warned, abs=0.011)
    enough = respond(block.model_copy(update={"friction": 0.6}), motion, models=("nonlinear",))["nonlinear"]
    assert not enough.unknown and np.isnan(enough.warned)


def test_what_slides_at_the_end_of_a_motion_slides_on_until_friction_stops_it():
    """Half a sine leaves it at a speed that friction takes more than half a second to take away."""
    motion = GroundMotion("half", 0.01, np.append(0.45 * G * np.sin(np.linspace(0.0, np.pi, 41)), 0.0), unit="m/s2")
    block = rk.Block(**SQUAT, **WEAK, friction=0.1)
    end, total = motion.time[-1], slid(motion.time, motion.acceleration, 0 * motion.time, 0.1)
    whole = respond(block, motion, opening=10.0, models=("nonlinear",))["nonlinear"]
    assert whole.check.largest == pytest.approx(total, rel=0.01)
    assert end / 2 < whole.check.longest < end + 1.5
    late = 0.99 * total / whole.check.reach
    found = respond(block, motion, opening=late, models=("nonlinear",))["nonlinear"]
    assert found.unknown and end < found.known_to < end + 1.5


def test_each_scale_and_slenderness_of_many_runs_is_its_own_history():
    block = rk.Block(**SQUAT, **WEAK, friction=0.3)
    motion = pulse(1.0, 0.8)
    (model,) = build_models(block, ("nonlinear",))
    scales = [0.2, 0.31, 0.4, 0.6]
    many = respond_many([model], [motion], Runs.of(0, 0, scale=scales))
    for k, scale in enumerate(scales):
        one = respond(block, motion.scaled(scale), models=("nonlinear",))["nonlinear"]
        assert many.unknown[k] == one.unknown == (scale > 0.33)
        assert many.known_to[k] == pytest.approx(one.known_to, abs=1e-9, nan_ok=True)
        assert one.unknown or many.opening[k] == pytest.approx(one.opening, rel=1e-9, abs=1e-15)


def test_on_uneven_ground_of_records_it_slides_between_its_motions_too():
    """Lifted by a first pulse, at rest again, it slides under a second that does not lift it."""
    first, second = pulse(0.6, 0.3).acceleration, pulse(0.45, 0.5).acceleration
    motion = GroundMotion("two", 0.01, np.concatenate([first, np.zeros(400), second, np.zeros(5)]), unit="m/s2")
    block = rk.Block(**SQUAT, **WEAK, friction=0.35, restitution=0.5)
    found = respond(block, motion, opening=10.0, models=("nonlinear",))["nonlinear"]
    began = (len(first) + 400) * 0.01
    assert found.lifted and found.end_time < began
    single = GroundMotion("one", 0.01, motion.acceleration[: len(first) + 300], unit="m/s2")
    alone = respond(block, single, opening=10.0, models=("nonlinear",))
    before = alone["nonlinear"].check.largest
    after = slid(motion.time - began, np.where(motion.time >= began, motion.acceleration, 0.0), 0 * motion.time, 0.35)
    assert after > 1e-3 and found.check.largest == pytest.approx(before + after, rel=0.02)


@pytest.mark.parametrize(
    ("name", "push", "joint"),
    [("stone", 0.2 / 2.0, "base and top"), ("pinnacle", 0.6 / 5.2, "the ground and buttress")],
)
def test_a_joint_that_is_said_to_be_fixed_opens_where_its_lever_says(name, push, joint):
    """Width over height of what stands on it."""
    made = of(STACKS[name])
    for direction in Direction:
        failure = first_failure(resting(made), direction)
        assert (failure.push / G, failure.joint, failure.slides) == (pytest.approx(push, rel=1e-12), joint, False)
        assert made.uplift(direction) > 4 * push
    found = respond(made, rk.parse_pulse("sine:0.27g:1s").sampled(), models=("nonlinear",))["nonlinear"]
    assert found.unknown and found.check.joint == joint and found.check.reason == "opens" and not found.lifted


@pytest.mark.parametrize("name", STACKS)
def test_what_is_bonded_is_not_checked_and_said(name, tmp_path):
    text = STACKS[name].replace("top]}", "top], bonded: true}").replace("ground]}", "ground], bonded: true}")
    made = of(text)
    failure = first_failure(resting(made), Direction.POSITIVE)
    assert failure.push / G == pytest.approx(min(0.7, made.uplift(Direction.POSITIVE)))
    (tmp_path / "x.yaml").write_text(text, encoding="utf-8")
    said = run("respond", "x.yaml", "--pulse", "sine:0.6g:0.3s", "--neighbours", 0, "--model", "nonlinear").stdout
    bond = {"stone": "the bond of base and top", "pinnacle": "the bond of buttress and ground"}[name]
    assert "All checked joints bear" in said and f"Not checked, but assumed to hold: {bond}." in " ".join(said.split())


def test_a_crack_that_a_file_says_is_closed_opens_and_ends_what_is_known():
    """As three free blocks it collapses at 1.31 s under this pulse."""
    motion = rk.parse_pulse("sine:0.37g:1s").sampled()
    found = respond(of(CRACKS), motion, models=("nonlinear",))["nonlinear"]
    assert found.unknown and found.check.joint == "middle and upper" and found.known_to < 1.31
    tied = of(CRACKS.replace("middle]}", "middle], bonded: true}").replace("upper]}", "upper], bonded: true}"))
    assert not respond(tied, motion, models=("nonlinear",))["nonlinear"].unknown


@pytest.mark.parametrize("friction", [None, 0.8, 0.05])
def test_stones_that_rock_on_their_bases_open_first_unless_all_slides_before(friction):
    """Under a level beam each rocks from its width over its height, whatever it carries."""
    made = of(STONES).replace(friction=friction)
    still = resting(made)
    for direction in Direction:
        failure = first_failure(still, direction)
        slides = friction == 0.05
        assert failure.push / G == pytest.approx(0.05 if slides else 0.2 / 2.0, rel=1e-6)
        assert (failure.slides, failure.opens) == (slides, not slides)
        assert made.uplift(direction) > 0.3
    assert len(still.modes) == (0 if slides else 2)  # what would open later than all slides is not looked for


def test_a_frame_on_smooth_feet_slides_as_a_whole():
    frame = {"column_width": 1.0, "column_height": 3.0, "mass_ratio": 1.5, "density": 2400.0, "depth": 1.0}
    motion = pulse(0.3, 1.0)
    made = rk.SymmetricFrame(**frame, friction=0.2)
    found = respond(made, motion, opening=10.0, models=("nonlinear",))["nonlinear"]
    expected = slid(motion.time, motion.acceleration, 0 * motion.time, 0.2)
    assert expected > 0.02 and found.check.largest == pytest.approx(expected, rel=0.01)
    assert found.check.largest_joint == "the ground and the feet"


@pytest.mark.every(6)
@pytest.mark.parametrize("file", YAML_FILES, ids=lambda file: file.stem)
def test_where_the_hinge_is_the_weakest_nothing_opens_before_it_does(file):
    """Of every example, by two ways: the work of rocking, and the forces at rest."""
    if not yaml.safe_load(file.read_text(encoding="utf-8")).get("mechanism"):
        return
    made = rk.load_structure(file)
    found = resting(made)
    for direction in made.directions if found is not None else ():
        failure = first_failure(found, direction)
        assert failure is None or failure.slides or failure.push >= (1 - 1e-9) * made.uplift(direction) * made.gravity


def test_equiv_says_what_comes_before_rocking(tmp_path):
    for name, friction, said in (
        ("slides", 0.3, "The structure slides before it rocks in both directions: at rest the joint between the "
         "ground and block slides from 0.3 g, below lambda = 0.5. Stronger motions make it slide and not rock: "
         "time histories give the slip."),
        ("near", 0.45, "The structure slides before it rocks in both directions: at rest the joint between the ground "
         "and block slides from 0.45 g, below lambda = 0.5. Stronger motions make it slide and not rock: time "
         "histories give the slip. The friction of 0.45 is within 20 % of 0.5, up to which the structure only slides, "
         "and above which it may rock. Neighbours do not vary friction: vary it yourself."),
        ("just rocks", 0.51, "The friction of 0.51 is within 20 % of 0.5, up to which the structure only slides, and "
         "above which it may rock. Neighbours do not vary friction: vary it yourself."),
        ("rocks", 0.61, None),
    ):  # fmt: skip
        file = tmp_path / f"{name}.yaml"
        file.write_text(yaml.safe_dump({"mechanism": "block", **SQUAT, "friction": friction}), encoding="utf-8")
        assert run_json("equiv", file)["caution"] == said
        assert (friction < 0.5) == ("Caution: The structure slides" in run("equiv", file).stdout)
    (tmp_path / "stone.yaml").write_text(STACKS["stone"], encoding="utf-8")
    assert run_json("equiv", tmp_path / "stone.yaml")["caution"] == (
        "Another mechanism starts first in both directions: at rest the joint between base and top opens from 0.1 g, "
        "below lambda = 0.5385. lambda and what follows from it are unconservative: describe the structure so that "
        "this joint can move."
    )
    one = yaml.safe_load(STACKS["stone"]) | {"negative": "none", "one_sided": "positive", "rebound": 0.3}
    (tmp_path / "one.yaml").write_text(yaml.safe_dump(one), encoding="utf-8")
    said = run_json("equiv", tmp_path / "one.yaml")["caution"]
    assert said.startswith("Another mechanism starts first in the positive direction: at rest")


def test_only_what_is_fixed_can_be_bonded(tmp_path):
    (tmp_path / "x.yaml").write_text(
        STACKS["stone"].replace("at: [0.5, 0]}", "at: [0.5, 0], bonded: true}"), encoding="utf-8"
    )
    assert "positive.joints.A.bonded cannot be combined with pivot" in run("equiv", "x.yaml", code=2).stderr


@pytest.mark.parametrize("count", range(2, 9))
def test_of_joints_that_fail_at_the_same_acceleration_the_first_of_the_file_is_named(count):
    """All blocks of a stack slide at once, and the last digits of their forces differ from computer to computer."""
    shapes = {f"b{k}": {"polygon": [[-0.5, k], [0.5, k], [0.5, k + 1], [-0.5, k + 1]]} for k in range(count)}
    fixed = {f"F{k}": {"fixed": [f"b{k - 1}", f"b{k}"]} for k in range(1, count)}
    side = {"lead": "b0", "joints": {**fixed, "A": {"pivot": "b0", "at": [0.5, 0]}}}
    stack = rk.Linkage(bodies=shapes, positive=side, friction=1 / count - 0.01, density=2000.0, depth=1.0)
    for direction in Direction:
        failure = first_failure(resting(stack), direction)
        assert (failure.joint, failure.slides) == ("the ground and b0", True)

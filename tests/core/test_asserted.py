"""What a file asserts is checked: supports, props and equal columns, beside lever arms and other solvers."""

from dataclasses import replace

import numpy as np
import pytest
import yaml

import rocking_cli as rk
from rocking_cli import GroundMotion
from rocking_cli.core import Direction
from rocking_cli.core.contacts import MASONRY_FRICTION
from rocking_cli.core.reactions import reactions
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.resting import first_failure, resting
from rocking_cli.structure import build_models
from rocking_cli.studies.contact import Contacts, _states
from rocking_cli.views.neighbours import neighbours_in_words
from rocking_cli.views.verdict import joints_in_words, why_unknown
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES
from tests.dynamics.test_rest import CRACKS, STACKS, G, of, pulse
from tests.following import respond

SLAB = EXAMPLES / "linkages" / "leaning_slab.yaml"
PORTICO = EXAMPLES / "linkages" / "portico.yaml"
ROOF = {"thickness": 0.4, "height": 3.5, "hinge": 0.8, "overburden": 1000.0, "density": 1800.0, "depth": 1.0}
COLONNADE = {"column_width": 0.8, "column_height": 4.0, "mass_ratio": 0.5, "density": 2400.0, "depth": 1.0}


def nonlinear(mechanism, motion, **how):
    return respond(mechanism, motion, models=("nonlinear",), **how)["nonlinear"]


# Supports


@pytest.mark.parametrize("friction", [0.6, 0.2])
def test_a_top_that_friction_under_a_roof_holds_slides_where_its_levers_say(friction):
    """The wall turns about its foot as one body, and the roof slides on it: moments about the foot."""
    wall = rk.SpanningWall(**ROOF, friction=friction)
    weight, height, half = 1800 * 0.4 * 3.5 * G, 3.5, 0.2
    holds = friction * 1000 * height
    expected = ((weight + 1000) * half + holds) / (weight * height / 2)
    for direction in Direction:
        failure = first_failure(resting(wall), direction)
        assert failure.push / G == pytest.approx(expected, rel=1e-9) and failure.push / G < wall.uplift(direction)
        assert (failure.joint, failure.slides, failure.opens) == ("the load and the top of the wall", True, True)


def test_a_roof_that_slides_ends_what_is_known_and_one_that_is_anchored_does_not():
    """As free blocks it collapses at 1.24 s under this pulse."""
    motion = rk.parse_pulse("sine:0.383g:0.6s").sampled()
    found = nonlinear(rk.SpanningWall(**ROOF, friction=0.6), motion)
    assert found.unknown and found.known_to < 1.24 and not found.lifted
    assert "the joint between the load and the top of the wall has slid by" in why_unknown(found)
    anchored = nonlinear(rk.SpanningWall(**ROOF, friction=0.6, support=0.0), motion)
    assert not anchored.unknown and anchored.lifted
    assert "Not checked, but assumed to hold: the support of upper block." in joints_in_words(anchored)


def test_a_top_slides_from_where_its_force_exceeds_friction_under_what_the_roof_weighs_then():
    """The force by the equations of each body; the weight with the acceleration of the top by difference quotients."""
    wall = rk.SpanningWall(**{**ROOF, "overburden": 6000.0}, friction=0.8)
    motion = GroundMotion("fine", 0.001, 1.3 * G * np.sin(np.pi * np.arange(1001) * 0.001 / 0.5), unit="m/s2")
    assert not resting(wall).modes  # it rocks before its top slides
    found = nonlinear(wall, motion, opening=10.0)
    held = nonlinear(wall.model_copy(update={"support": 0.0}), motion, opening=10.0)
    np.testing.assert_array_equal(found.phi, held.phi)  # what slides is an estimate beside the motion
    first = np.isfinite(found.phi)
    phi, rate, time = np.abs(found.phi[first]), np.gradient(np.abs(found.phi[first]), 0.001), found.time[first]
    direction = Direction.POSITIVE if found.phi[first][-5] > 0 else Direction.NEGATIVE
    at = reactions(wall, direction, phi, rate, np.interp(time, motion.time, motion.acceleration))
    force = np.abs(at.force[-1].real)
    top = wall.motion(phi, direction)[-1].carry(3.5j)[0].imag
    normal = 6000.0 * (1 + np.gradient(np.gradient(top, 0.001), 0.001) / G)
    moves = found.uplift_time + 0.003 < time
    slides = time[moves & (force > 0.8 * normal)]
    assert slides.size and found.warned == pytest.approx(slides[0], abs=0.003)
    assert found.check.warned_joint == "the load and the top of the wall"


def test_a_top_without_given_friction_never_slides_and_what_it_needs_is_said():
    """The friction is the force by the equations of each body, over the weight of the roof with what lifts it."""
    motion = pulse(0.35, 0.6)
    wall = rk.SpanningWall(**ROOF)
    assert not resting(wall).modes
    found = nonlinear(wall, motion)
    held = nonlinear(wall.model_copy(update={"support": 0.0}), motion)
    np.testing.assert_array_equal(found.phi, held.phi)
    assert found.lifted and not found.unknown
    demand = Contacts(wall).check(found, motion)
    k = int(np.argmin(np.abs(found.time - demand.time)))
    phi, rate = np.abs(found.phi[k : k + 1]), np.abs(np.gradient(found.phi, found.time)[k : k + 1])
    direction = Direction.POSITIVE if found.phi[k] > 0 else Direction.NEGATIVE
    at = reactions(wall, direction, phi, rate, np.interp(found.time[k : k + 1], motion.time, motion.acceleration))
    tops = wall.motion(np.abs(found.phi[k - 1 : k + 2]), direction)[-1].carry(3.5j)[0].imag
    normal = 1000.0 * (1 + np.diff(tops, 2)[0] / (found.time[1] - found.time[0]) ** 2 / G)
    assert demand.friction_needed == pytest.approx(abs(at.force[-1, 0]) / normal, rel=0.02)
    assert demand.joint[0] == "C" and demand.assumed_friction == demand.friction_needed > MASONRY_FRICTION
    assert "the result assumes that nothing slides" in joints_in_words(found, demand.assumed_friction)


@pytest.mark.parametrize("overburden", [1000.0, 20000.0])
def test_a_caution_states_the_friction_that_a_top_needs_to_rock(overburden):
    """Moments of the upper block about the hinge, and of both about the foot, as the wall starts to rock."""
    wall = rk.SpanningWall(**{**ROOF, "overburden": overburden})
    weight, height, half = 1800 * 0.4 * 3.5 * G, 3.5, 0.2
    force = wall.uplift(Direction.POSITIVE) * weight / 2 - (weight + overburden) * half / height
    needed, caution = force / overburden, wall.own_caution()
    assert (f"a coefficient of friction of {needed:.3g} between" in caution) == (needed > MASONRY_FRICTION)
    assert "friction" not in wall.model_copy(update={"friction": 0.6}).own_caution()
    assert "friction" not in wall.model_copy(update={"support": 0.0}).own_caution()


def test_forces_of_supports_are_those_of_the_free_bodies():
    """By contacts and the inverse of their matrix, and by the equations of each body."""
    motion = pulse(0.8, 0.5)
    for made in (
        rk.Wall(thickness=0.4, height=3.5, density=1800.0, depth=1.0),
        rk.SpanningWall(**{**ROOF, "support": 0.0}),
        of(CRACKS.replace("]}", "], bonded: true}", 0)),
    ):
        history = nonlinear(made, motion)
        found = Contacts(made).check(history, motion).supports
        states = _states(made, history, motion)
        forces = []
        for direction in Direction:
            mine = states.rocks & (states.sign == direction)
            if mine.any():
                at = reactions(made, direction, states.phi[mine], states.rate[mine], states.ground[mine])
                forces += [each.real for joint, each in zip(at.joints, at.force, strict=True) if joint.is_guide]
        if not forces:
            continue
        (support,) = found
        every = np.concatenate(forces)
        assert (support.most, support.least) == pytest.approx((every.max(), every.min()), rel=1e-9)
        assert support.way == pytest.approx(1) and support.most > 1000


def test_respond_says_what_a_support_must_provide(tmp_path):
    (tmp_path / "w.yaml").write_text("mechanism: wall\nthickness: 0.4\nheight: 3.5\ndensity: 1800\ndepth: 1\n")
    how = ("respond", "w.yaml", "--pulse", "sine:0.8g:0.5s", "--neighbours", 0, "--model", "nonlinear")
    said, data = " ".join(run(*how).stdout.split()), run_json(*how)
    (support,) = data["responses"]["nonlinear"]["contact"]["supports"]
    assert f"must provide up to {support['most'] / 1000:.3g} kN to the right" in said
    assert support["support"] == "the support of upper block" and support["way"] == [1.0, 0.0]


# A prop


def test_what_props_a_structure_is_pushed_back_where_its_levers_say():
    made = rk.load_structure(SLAB)
    slab, pier = 2400 * 0.2 * 3 * G, 2400 * 1.2 * 4 * G
    # The pier about its left foot, the slab about the outer edge of its own: the force between both falls out.
    expected = (pier * 0.6 + slab * 0.7) / (pier * 2 + slab * 1.5)
    failure = first_failure(resting(made), Direction.NEGATIVE)
    assert (failure.push / G, failure.opens) == (pytest.approx(expected, rel=1e-9), True)
    assert expected == pytest.approx(0.314, abs=5e-4) and not made.rocks_both_ways


def test_a_prop_that_is_pushed_back_ends_what_is_known():
    found = nonlinear(rk.load_structure(SLAB), rk.parse_pulse("sine:0.442g:1s").sampled())
    assert found.unknown and found.check.reason == "opens" and found.known_to < 0.5


def test_an_impact_on_a_prop_throws_it_back():
    """Under half a sine that pushes away from the prop alone: nothing fails until the pier comes back."""
    time = np.arange(41) * 0.01
    half = GroundMotion("half", 0.01, np.append(-0.4 * G * np.sin(np.pi * time / 0.4), 0.0), unit="m/s2")
    found = nonlinear(rk.load_structure(SLAB), half)
    wide = nonlinear(rk.load_structure(SLAB), half, opening=100.0)
    hit = wide.first_impact
    assert found.unknown and hit < found.known_to < hit + 0.2
    assert wide.warned == pytest.approx(hit, abs=1e-9)
    (mode,) = resting(rk.load_structure(SLAB)).modes
    assert mode.force[1] < 0 < mode.force[0]


def test_what_leans_on_something_outside_the_file_says_that_this_is_not_checked():
    made = rk.load_structure(EXAMPLES / "masonry" / "cracked_facade.yaml")
    assert not made.propped and "what it leans on" in made.asserted()
    assert not resting(made).modes
    assert rk.load_structure(SLAB).propped and "what it leans on" not in rk.load_structure(SLAB).asserted()
    assert "the smooth contact of pier and slab" in rk.load_structure(SLAB).asserted()


def test_equiv_names_what_is_pushed_back(tmp_path):
    said = "What props the structure is pushed back in the negative direction: the joint between the ground and pier"
    assert said in run_json("equiv", SLAB)["caution"]


def test_a_leaning_block_slides_away_from_what_it_leans_on_and_not_into_it():
    block = rk.Block(width=0.8, height=1.6, density=2000.0, depth=1.0, friction=0.3, one_sided="positive", rebound=0.2)
    outward = GroundMotion("out", 0.01, np.append(-0.4 * G * np.sin(np.pi * np.arange(31) / 30), 0.0), unit="m/s2")
    found = nonlinear(block, outward)
    assert found.unknown and found.check.reason == "slides"
    inward = GroundMotion("in", 0.01, -outward.acceleration, unit="m/s2")
    assert not nonlinear(block, inward).unknown
    assert "slides before it rocks" in " ".join(run_json_of(block))


def run_json_of(mechanism):
    from rocking_cli.views.cautions import before_rocking

    return before_rocking(mechanism)


# Limit analysis at rest


@pytest.mark.parametrize("friction", [0.8, 0.15])
def test_what_starts_first_at_rest_is_the_mechanism_of_the_same_free_blocks(friction):
    """Of the wall with two cracks: as a linkage by the forces at rest, and as an assembly by its own programme."""
    data = {key: each for key, each in yaml.safe_load(CRACKS).items() if key in ("bodies", "density", "depth")}
    blocks = rk.Assembly(
        blocks=data["bodies"], density=1800.0, depth=1.0, friction=friction,
        ground={"g": {"polygon": [[-2, -1], [2, -1], [2, 0], [-2, 0]]}},
        joints={"top": {"slide": "upper", "at": [0.15, 3.2], "along": [0, 1]}},
    )  # fmt: skip
    wall = of(CRACKS.replace("friction: 0.8", f"friction: {friction}"))
    for direction in Direction:
        failure = first_failure(resting(wall), direction)
        push = min(wall.uplift(direction) * G, failure.push if failure else np.inf)
        assert push / G == pytest.approx(blocks._collapse(direction).multiplier, rel=1e-8)


def test_a_joint_that_hinges_at_the_same_corner_in_both_directions_touches_at_rest_on_its_whole_face():
    data = yaml.safe_load(CRACKS)
    data["positive"]["joints"]["B"] = {"hinge": ["lower", "middle"], "at": [-0.15, 1.6]}
    data["positive"]["joints"]["closed"] = {"fixed": ["middle", "upper"]}
    data["negative"] = {"lead": "middle", "joints": {
        "A'": {"hinge": ["lower", "middle"], "at": [-0.15, 1.6]},
        "B'": {"hinge": ["middle", "upper"], "at": [0.15, 2.1]},
        "C'": {"slide": "upper", "at": [-0.15, 3.2], "along": [0, 1]}, "closed": {"fixed": ["lower", "ground"]},
    }}  # fmt: skip
    wall = of(yaml.safe_dump(data))
    blocks = rk.Assembly(
        blocks=data["bodies"], density=1800.0, depth=1.0, friction=0.8,
        ground={"g": {"polygon": [[-2, -1], [2, -1], [2, 0], [-2, 0]]}},
        joints={"top": {"slide": "upper", "at": [0.15, 3.2], "along": [0, 1]}},
    )  # fmt: skip
    for direction in Direction:
        failure = first_failure(resting(wall), direction)
        push = min(wall.uplift(direction) * G, failure.push if failure else np.inf)
        assert push / G == pytest.approx(blocks._collapse(direction).multiplier, rel=1e-8)


def test_a_body_on_two_legs_bears_on_both_and_one_in_a_notch_on_its_side_too():
    legs = [[-0.5, 1], [-0.3, 1], [-0.3, 1.5], [0.3, 1.5], [0.3, 1], [0.5, 1], [0.5, 3], [-0.5, 3]]
    bodies = {"base": [[-0.5, 0], [0.5, 0], [0.5, 1], [-0.5, 1]], "top": legs,
              "prop": [[-1.5, 0], [-0.5, 0], [-0.5, 2], [-1.5, 2]]}  # fmt: skip
    shapes = {name: {"polygon": polygon} for name, polygon in bodies.items()}
    fixed = {name: {"fixed": [name, "ground"]} for name in ("base", "prop")}
    made = rk.Linkage(
        bodies=shapes, density=2000.0, depth=1.0, friction=0.7, one_sided="positive", rebound=0.2, negative="none",
        positive={"lead": "top", "joints": {**fixed, "H": {"hinge": ["base", "top"], "at": [0.5, 1]}}},
    )  # fmt: skip
    ground = {"g": {"polygon": [[-3, -1], [3, -1], [3, 0], [-3, 0]]}}
    blocks = rk.Assembly(blocks=shapes, ground=ground, density=2000.0, depth=1.0, friction=0.7)
    failure = first_failure(resting(made), Direction.NEGATIVE)
    assert failure.push / G == pytest.approx(blocks._collapse(Direction.NEGATIVE).multiplier, rel=1e-8)
    stepped = {"base": {"polygon": [[-1, 0], [1, 0], [1, 1.5], [0.5, 1.5], [0.5, 1], [-1, 1]]},
               "top": {"polygon": [[-0.5, 1], [0.5, 1], [0.5, 2.2], [-0.5, 2.2]]}}  # fmt: skip
    rest = {"fixed": ["base", "ground"], "bonded": True}
    sides = {label: {"lead": "top", "joints": {"G": rest, "H": {"hinge": ["base", "top"], "at": at}}}
             for label, at in (("positive", [0.5, 1.5]), ("negative", [-0.5, 1]))}  # fmt: skip
    made = rk.Linkage(bodies=stepped, density=2000.0, depth=1.0, friction=0.2, **sides)
    failure = first_failure(resting(made), Direction.NEGATIVE)
    assert failure.push / G == pytest.approx(0.2, rel=1e-8)


def test_a_block_on_a_narrow_pedestal_that_is_bonded_bears_on_the_pedestal_alone():
    bodies = {"pedestal": {"polygon": [[-0.3, 0], [0.3, 0], [0.3, 1], [-0.3, 1]]},
              "top": {"polygon": [[-0.9, 1], [0.9, 1], [0.9, 1.4], [-0.9, 1.4]]}}  # fmt: skip
    rest = {"fixed": ["pedestal", "ground"], "bonded": True}
    made = rk.Linkage(
        bodies=bodies, density=2000.0, depth=1.0, one_sided="positive", rebound=0.2, negative="none",
        positive={"lead": "top", "joints": {"G": rest, "H": {"hinge": ["pedestal", "top"], "at": [0.3, 1]}}},
    )  # fmt: skip
    (face,) = made.contacts_at_rest()
    assert set(face.points) == {0.3 + 1j, -0.3 + 1j}


def test_what_a_leaning_structure_fixes_opens_at_its_own_lever_arm_away_from_what_it_leans_on():
    stone = of(STACKS["stone"].replace("negative: mirror", "negative: none\none_sided: positive\nrebound: 0.4"))
    failure = first_failure(resting(stone), Direction.POSITIVE)
    assert (failure.push / G, failure.joint) == (pytest.approx(0.1, rel=1e-9), "base and top") and failure.opens
    assert "opens from 0.1 g" in " ".join(run_json_of(stone))
    time = np.arange(61) * 0.01
    out = GroundMotion("out", 0.01, np.append(-0.3 * G * np.sin(np.pi * time / 0.6), 0.0), unit="m/s2")
    assert nonlinear(stone, out).unknown
    assert not nonlinear(stone, GroundMotion("in", 0.01, -out.acceleration, unit="m/s2")).unknown


def test_of_a_leaning_structure_without_shapes_only_the_sliding_as_a_whole_is_known_at_rest():
    """Where it touches at rest is not known: with its pivot alone it would seem to slide at 0.1 g."""
    made = of("""
bodies: {base: {mass: 2000, centroid: [0, 0.5], inertia: 300}, top: {mass: 900, centroid: [0, 2], inertia: 200}}
friction: 0.3
one_sided: positive
rebound: 0.3
negative: none
positive: {lead: base, joints: {A: {pivot: base, at: [0.5, 0]}, F: {fixed: [base, top]}}}
""")
    failure = first_failure(resting(made), Direction.POSITIVE)
    assert failure.push / G == pytest.approx(0.3, rel=1e-9) and failure.slides


def test_faces_that_lie_on_one_another_without_a_joint_bear_at_rest():
    """Two equal piers side by side: pushed to the left, the right one leans on the other and cannot turn alone."""
    made = rk.load_structure(PORTICO)
    labels = [contact.label for contact in made.contacts_at_rest()]
    assert len(set(labels)) == 6 and not resting(made).modes


# Columns


def test_joints_of_columns_of_any_size_are_checked_alike():
    """A thousand times as large, with a pulse as much longer: the same but for lengths."""
    found = []
    for size in (1.0, 1e3):
        sizes = {"column_width": 0.8, "column_height": 4.0, "spacing": 3.0, "beam_depth": 0.5, "depth": 1.0}
        frame = rk.SymmetricFrame(
            **{key: each * size for key, each in sizes.items()}, columns=3, mass_ratio=0.5, friction=0.6, density=2000.0
        )
        found.append(nonlinear(frame, rk.parse_pulse(f"sine:0.35g:{0.6 * size**0.5}s").sampled()))
    small, large = found
    assert small.lifted and small.check is not None and large.check is not None
    assert large.peak_ratio == pytest.approx(small.peak_ratio, rel=1e-3)
    assert large.opening == pytest.approx(small.opening, rel=0.02)


def test_a_beam_without_mass_loads_no_column():
    with pytest.raises(rk.RockingError, match="its beam has no mass and loads no column"):
        rk.SymmetricFrame(**{**COLONNADE, "mass_ratio": 0.0}, columns=3, spacing=3.0, beam_depth=0.5)
    assert "no mass" in rk.SymmetricFrame(**{**COLONNADE, "mass_ratio": 0.0}, columns=3).unchecked


@pytest.mark.parametrize("a", [0.3, 0.8])
def test_columns_in_step_are_known_only_if_a_column_alone_ends_alike(a):
    """Of the colonnade under 0.8 g, columns fell in six of six runs of free blocks; in step it stands."""
    motion = rk.parse_pulse(f"sine:{a}g:0.6s").sampled()
    alone = nonlinear(rk.Block(width=0.8, height=4.0), motion)
    two = nonlinear(rk.SymmetricFrame(**COLONNADE, columns=2), motion)
    four = nonlinear(rk.SymmetricFrame(**COLONNADE, columns=4), motion)
    assert not two.overturned and not two.unknown and two.lifted
    assert four.unknown == alone.overturned == (a == 0.8)
    if four.unknown:
        assert four.apart and four.impact_count == 1
        assert four.known_to == pytest.approx(two.first_impact, rel=1e-12)  # forces rounded otherwise
        before = two.ratio[two.time <= two.first_impact]
        assert four.peak_ratio == pytest.approx(np.abs(before).max(), rel=1e-3)
        said = joints_in_words(four)
        assert "fall out of step" in said and "linkage" not in said
    else:
        assert four.peak_ratio == pytest.approx(two.peak_ratio, rel=1e-9)


def test_many_runs_of_columns_are_each_its_own_history():
    motion = rk.parse_pulse("sine:1g:0.6s").sampled()
    frames = [rk.SymmetricFrame(**COLONNADE, columns=n) for n in (4, 2)]
    scales, etas, slender = (each.ravel() for each in np.meshgrid([0.3, 0.6, 0.9], [0.85, 0.95], [0.9, 1.1]))
    models = [build_models(frame, ("nonlinear",))[0] for frame in frames]
    runs = Runs.of(np.zeros(12), 0, scale=scales, eta=etas, slender=slender)
    many = respond_many(models, [motion], runs)
    in_step = respond_many(models, [motion], replace(runs, model=np.ones(12, np.int64)))
    column = build_models(rk.Block(width=0.8, height=4.0), ("nonlinear",))
    shift = models[0].eta[0] - column[0].eta[0]
    alone = respond_many(column, [motion], Runs.of(0, 0, scale=scales, eta=etas - shift, slender=slender))
    differs = (alone.overturned != in_step.overturned) & (in_step.impact_count > 0)
    assert 0 < differs.sum() < 12
    assert (many.unknown == differs).all()
    assert (many.fell == in_step.fell & ~differs).all()
    one = nonlinear(frames[0], motion.scaled(0.9))
    again = respond_many(models, [motion], Runs.of(0, 0, scale=[0.9]))
    assert one.unknown and again.unknown[0] and again.known_to[0] == one.known_to


def test_a_linkage_and_an_assembly_of_three_columns_have_the_same_columns_alone():
    portico = rk.load_structure(PORTICO)
    data = yaml.safe_load(PORTICO.read_text(encoding="utf-8"))
    assembly = rk.Assembly(
        blocks=data["bodies"], density=2500.0, depth=0.8, friction=0.8,
        ground={"g": {"polygon": [[-2, -1], [9, -1], [9, 0], [-2, 0]]}},
    )  # fmt: skip
    for made in (portico, assembly):
        (alone,) = made.columns_alone()
        block = rk.Block(width=0.8, height=5.0)
        for direction in Direction:
            assert alone.uplift(direction) == pytest.approx(block.uplift(direction), rel=1e-9)
            assert alone.eta(direction) == pytest.approx(block.eta(direction), rel=1e-9)
        assert "peaks are those of columns in step" in made.own_caution()
    motion = rk.parse_pulse("sine:0.4g:0.8s").sampled()
    found = nonlinear(portico, motion)
    assert found.apart and found.unknown
    two = {**data, "bodies": {name: each for name, each in data["bodies"].items() if name != "middle"}}
    two["positive"]["joints"] = {k: each for k, each in data["positive"]["joints"].items() if k not in "CD"}
    two.pop("mechanism")
    assert not rk.Linkage(**two).columns_alone() and not rk.Linkage(**two).own_caution()


def test_a_structure_whose_faces_at_rest_are_not_known_bears_while_it_rocks_only():
    motion = pulse(0.6, 0.4)
    wall = {**ROOF, "overburden": 20000.0, "support": 0.0}
    both, leans = rk.SpanningWall(**wall), rk.SpanningWall(**wall, one_sided="positive", rebound=0.3)
    assert "bear throughout the motion" in joints_in_words(nonlinear(both, motion))
    assert "bear while the structure rocks" in joints_in_words(nonlinear(leans, motion))
    assert not resting(leans).known and resting(both).known and resting(rk.load_structure(SLAB)).known


def test_neighbours_that_fall_out_of_step_count_though_no_joint_is_checked():
    """Without spacing the joints are not checked; giving less must not make the share look better."""
    answer = rk.respond(rk.SymmetricFrame(**COLONNADE, columns=4), "sine:0.8g:0.6s", model="nonlinear", neighbours=20)
    (near,) = answer.neighbours.values()
    assert answer["nonlinear"].check is None and near.unknown > 0
    assert (answer.conclusion.share.lowest, answer.conclusion.share.highest) == (near.overturned, near.at_most)
    assert f"the outcome under {round(20 * near.unknown)}" in neighbours_in_words(near)
    two = rk.respond(rk.SymmetricFrame(**COLONNADE, columns=2), "sine:0.8g:0.6s", model="nonlinear", neighbours=20)
    assert all(each.unknown is None for each in two.neighbours.values())

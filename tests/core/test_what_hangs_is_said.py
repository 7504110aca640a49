"""What is said and refused of things that hang on structures, where a reader could be misled."""

import numpy as np
import pytest

import rocking_cli as rk
from mechanisms.block import Block
from mechanisms.cone import Cone
from mechanisms.point_mass import PointMass
from mechanisms.rigid_body import RigidBody
from mechanisms.wall import Wall
from rocking_cli.dynamics.history import follow
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.studies.contact import Contacts
from rocking_cli.studies.movements import Watched
from rocking_cli.views.response import apart
from tests.cli.test_cli import run
from tests.following import build_model

TIME = 0.01 * np.arange(400)
WEAK = GroundMotion("weak", 0.01, 3.0 * np.sin(6 * TIME) * np.exp(-TIME), unit="m/s2")
STRONG = GroundMotion("strong", 0.01, 9.0 * np.sin(2 * TIME), unit="m/s2")
FACADE = {"width": 0.6, "height": 8.0, "density": 1800.0, "depth": 5.0}
COURSES = {"courses": 40, "overlap": 0.2, "thickness": 0.5, "walls": 2, "height": 8.0}


@pytest.mark.parametrize(
    ("structure", "name", "at"),
    [
        (Cone(base_radius=1.0, height=6.0), "top", 6j),
        (RigidBody(parts=[{"polygon": [[0.0, 0.0], [1.0, 0.0], [1.0, 3.0], [0.0, 3.0]]}], mass=1.0), "top", 0.5 + 3j),
        (RigidBody(R=1.5, alpha_deg=14.0, inertia_ratio=1.3), "centroid", None),
        (PointMass(base_width=1.0, height=4.0), "centroid", 4j),
        (Wall(thickness=0.3, height=3.0), "top", 3j),
    ],
)
def test_the_top_is_that_of_the_shape_and_a_centroid_is_called_so(structure, name, at):
    points = Watched(structure).points
    assert next(iter(points)) == name
    assert at is None or points[name].at == pytest.approx(at)


def test_a_wall_whose_top_is_held_says_how_far_its_hinge_moves():
    assert "joint B" in Watched(Wall(thickness=0.3, height=3.0)).points


def test_names_of_the_tool_are_no_names_of_loads():
    for name, more in (("top", {}), ("interlock", {"interlock": COURSES})):
        with pytest.raises(InputError, match=f"'{name}' is a reserved name: choose another"):
            Block(**FACADE, **more, loads=[{"name": name, "mass": 100.0, "at": [0.0, 4.0]}])
    Block(**FACADE, loads=[{"name": "interlock", "mass": 100.0, "at": [0.0, 4.0]}])  # there is no other


def test_forces_may_not_lift_a_structure_off_the_ground():
    with pytest.raises(InputError, match="more than all of its weight"):
        Block(**FACADE, loads=[{"name": "vault", "force": [-40e3, 500e3], "at": [0.0, 6.0]}])


def test_crossing_walls_are_no_higher_than_what_they_hold():
    assert Block(**FACADE, interlock=COURSES).uplift(1) > 0.4
    with pytest.raises(InputError, match="outside block"):
        Block(**FACADE, interlock={**COURSES, "height": 9.0})
    with pytest.raises(InputError, match="overlap"):
        Block(**FACADE, interlock={**COURSES, "overlap": 200.0})


def test_blocks_that_have_slid_apart_are_said(tmp_path):
    file = tmp_path / "facade.yaml"
    file.write_text(
        "mechanism: block\nwidth: 0.6\nheight: 8\ndensity: 1800\ndepth: 5\none_sided: positive\n"
        "interlock: {courses: 40, overlap: 0.2, thickness: 0.5, walls: 2, height: 8.0}\n"
    )
    far = run("respond", file, "--pulse", "sine:1.6g:1.2s").stdout
    near = run("respond", file, "--pulse", "sine:0.6g:0.6s").stdout
    assert "more than their overlap of 200 mm" in " ".join(far.split())
    assert "overlap" not in near


def test_one_history_that_tears_it_apart_is_enough_in_whatever_order():
    watched = Watched(Block(**FACADE, interlock=COURSES))
    model = build_model(watched.mechanism, "nonlinear", 1000.0)  # it would leave the ground
    weak, strong = follow(model, WEAK), follow(model, STRONG.scaled(8.0))
    assert strong.overturned and watched.is_torn_apart(strong) and not watched.is_torn_apart(weak)
    for runs in ({"nonlinear": weak, "linear1": strong}, {"nonlinear": strong, "linear1": weak}):
        assert any("more than their overlap" in said for said in apart(watched, {1: runs}))


def test_a_tie_that_acts_in_tension_has_its_elongation_and_its_force_before_a_fall():
    ties = [
        {"name": name, "from": {"ground": [sign * 4.0, 0.0]}, "to": {"at": [sign * 0.3, 6.0]}, "stiffness": 3e4,
         "only": "tension"}
        for name, sign in (("left", -1), ("right", 1))
    ]  # fmt: skip
    block = Block(**FACADE, ties=ties)
    weak, strong = (follow(build_model(block, "nonlinear"), motion) for motion in (WEAK, STRONG))
    for tie in Watched(block).peaks(weak).ties:
        assert tie.force == pytest.approx(3e4 * tie.elongation, rel=1e-9) and tie.elongation > 0
    assert strong.overturned
    fallen = Watched(block).peaks(strong)
    assert np.isnan(fallen.points[0].horizontal) and max(tie.force for tie in fallen.ties) > 0


def test_friction_is_that_before_contact_is_lost():
    block = Block(width=0.6, height=3.0, mass=1000.0)
    lifts = GroundMotion(
        "u",
        0.01,
        WEAK.acceleration,
        vertical=GroundMotion("v", 0.01, -14.0 * np.sin(9 * TIME), unit="m/s2"),
        unit="m/s2",
    )
    history = follow(build_model(block, "nonlinear"), lifts)
    found = Contacts(block).check(history, lifts)
    assert 0 < found.time <= found.lost == found.known_to == history.known_to
    assert not found.stands and (found.times <= found.lost).all()
    assert not found.demand[found.times > found.lost].any()


def test_python_says_why_there_is_no_block_and_takes_tuples_and_arrays():
    tendon = {"name": "tendon", "path": ({"ground": (0.0, 0.0)}, {"at": np.zeros(2)}), "stiffness": 1e8}
    tied = rk.Block(**FACADE, ties=(tendon,))
    with pytest.raises(
        AttributeError, match="The structure has no equivalent single block: its restoring moment does not vanish"
    ):
        _ = rk.equiv(tied).positive
    answer = rk.respond(tied, "sine:0.4g:1s", release="0.01rad")
    assert list(answer) == ["nonlinear"]
    both = rk.respond_each([tied, rk.Block(**FACADE)], "sine:0.4g:1s")
    assert list(both) == ["nonlinear"]


@pytest.mark.every(2)
@pytest.mark.usefixtures("small_maps")
@pytest.mark.parametrize(
    ("checked", "words"),
    [(True, "Then the joint between the ground and block has slid by 1.51 mm"),
     (False, "its joints do not hold")],
)  # fmt: skip
def test_a_report_says_at_its_head_that_joints_do_not_hold(tmp_path, monkeypatch, checked, words):
    if not checked:
        monkeypatch.setattr(Block, "contacts", lambda self, direction: None)
    file = tmp_path / "block.yaml"
    file.write_text("mechanism: block\nwidth: 0.6\nheight: 3\nmass: 1000\nfriction: 0.21\n")
    asked = ("--pulse", "sine:0.4g:0.6s", "--neighbours", 1, "--out", tmp_path / "report.html")
    assert words in " ".join(run("report", file, *asked).stdout.split())

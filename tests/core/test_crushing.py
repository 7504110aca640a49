"""Pivots of finite strength move inwards: single bodies and walls, against sums by hand."""

import numpy as np
import pytest

from mechanisms.arch import Arch
from mechanisms.block import Block
from mechanisms.point_mass import PointMass
from mechanisms.rigid_body import RigidBody
from mechanisms.spanning_wall import SpanningWall
from mechanisms.wall import Wall
from rocking_cli.core import Direction
from rocking_cli.core.structure_file import parse_structure
from rocking_cli.errors import InputError
from rocking_cli.questions.equiv.view import view
from rocking_cli.structure import Structure
from rocking_cli.studies.picture import picture
from rocking_cli.testing import contract

POSITIVE, NEGATIVE = Direction
G = 9.80665
SOFT = {"strength": 1e6}


def facade(**fields):
    return Block(width=0.6, height=8.0, **{"density": 18000 / G, "depth": 5.0, "crushing": SOFT, **fields})


def test_a_facade_of_one_megapascal():
    found = facade()
    assert found.uplift(POSITIVE) == pytest.approx(0.0642, abs=1e-12)  # (.3 - 86400/2e6)/4
    assert found.model_copy(update={"crushing": None}).uplift(POSITIVE) == pytest.approx(0.075)
    assert found.critical_rotation(NEGATIVE) == pytest.approx(np.arctan2(0.3 - 0.0432, 4.0), rel=1e-12)
    assert found.found(POSITIVE)[0].value == pytest.approx(0.0432)
    assert facade(crushing={"strength": 1e12}).uplift(POSITIVE) == pytest.approx(0.075, rel=1e-6)


def test_a_shorter_pivot_moves_further():
    found = facade(crushing={"strength": 2e6, "depth": 2.5})
    assert found.uplift(POSITIVE) == pytest.approx(0.0642, abs=1e-12)
    assert found.enlarged(2.0).crushing.depth == 5.0


def test_loads_and_ties_press_on_it():
    weight = 18000 * 0.6 * 8.0 * 5.0
    loads = [
        {"name": "floor", "mass": 2000.0, "at": [0.0, 6.0], "weight": 0.5},
        {"name": "vault", "force": [3000.0, -7000.0], "at": [0.0, 5.0]},
    ]
    ends = {"tendon": ([0.0, 0.0], [0.0, 0.0], 50e3), "stay": ([-4.0, 5.0], [-0.3, 8.0], 10e3)}
    ties = [
        {"name": name, "from": {"ground": low}, "to": {"at": high}, "stiffness": 1e5, "prestress": force}
        for name, (low, high, force) in ends.items()
    ]
    found = facade(loads=loads, ties=ties)
    stay = 10e3 * 3.0 / np.hypot(3.7, 3.0)
    for direction in Direction:
        pressed = weight + 1000 * G + 7000 + 50e3 + stay
        assert found.inwards(direction, "foot") == pytest.approx(pressed / (2 * 1e6 * 5.0), rel=1e-12)


@pytest.mark.parametrize("xi", [0.5, 0.7])
@pytest.mark.parametrize("direction", Direction)
def test_a_wall_crushes_at_its_foot_and_at_its_hinge(xi, direction):
    t, h, load, x = 0.3, 3.0, 40e3, 0.05
    weight = 1800 * G * t * h
    found = SpanningWall(
        thickness=t, height=h, hinge=xi, overburden=load, overburden_eccentricity=x, density=1800.0, depth=1.0,
        crushing=SOFT,
    )  # fmt: skip
    u_a, u_b = (weight + load) / 2e6, ((1 - xi) * weight + load) / 2e6
    a, b, s = t / 2 - u_a, t / 2 - u_b, int(direction)
    # Virtual work: the lower block turns by 1 about A, the upper one back by xi/(1 - xi).
    moment = weight * (xi * a + (1 - xi) * (a + b + xi / (1 - xi) * b)) + load * (a + b + xi / (1 - xi) * (b + s * x))
    assert found.uplift(direction) == pytest.approx(moment / (weight * xi * h / 2), rel=1e-12)
    assert [each.key for each in found.found(direction)] == ["hinge", "top_force", "inwards_foot", "inwards_hinge"]


def test_the_wall_of_two_blocks_too():
    wall = Wall(thickness=0.3, height=3.0, density=1800.0, depth=1.0, crushing={"strength": 2e5})
    same = SpanningWall(
        thickness=0.3, height=3.0, hinge=0.5, support="pivot", density=1800.0, depth=1.0, crushing={"strength": 2e5}
    )
    for direction in Direction:
        for what in ("uplift", "critical_rotation", "eta", "limit"):
            assert getattr(wall, what)(direction) == pytest.approx(getattr(same, what)(direction), rel=1e-12)
    sound = wall.model_copy(update={"crushing": None})
    assert wall.uplift(POSITIVE) < sound.uplift(POSITIVE)
    assert wall.critical_rotation(POSITIVE) < sound.critical_rotation(POSITIVE)


@pytest.mark.parametrize(
    "structure",
    [
        facade(),
        facade(loads=[{"name": "floor", "mass": 9000.0, "at": [0.1, 8.0]}]),
        Wall(thickness=0.3, height=3.0, density=1800.0, depth=1.0, crushing={"strength": 2e5}),
        SpanningWall(
            thickness=0.3, height=3.0, hinge=0.6, overburden=3e4, density=1800.0, depth=1.0, crushing={"strength": 8e5}
        ),
        RigidBody(polygon=[[0, 0], [1, 0], [0.9, 3.2], [0.2, 3.0]], density=2e3, depth=1.0, crushing={"strength": 5e5}),
        PointMass(base_width=1.0, height=4.0, mass=2e4, crushing={"strength": 1e6, "depth": 1.0}),
    ],
)  # fmt: skip
def test_it_keeps_the_contract(structure):
    assert [each.why for each in contract(structure) if not each.passed] == []


def test_it_is_said():
    found = facade()
    assert "inwards by crushing at 1 MPa" in " ".join(picture(found).sketch.notes)
    shown = view(Structure(found))
    assert shown.data["directions"]["positive"]["inwards_foot"] == pytest.approx(0.0432)
    assert any("Pivots moved inwards by crushing at 1 MPa" in part for part in shown.parts if isinstance(part, str))


FACADE = "mechanism: block\nwidth: 0.6\nheight: 8\n"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (FACADE + "crushing: {strength: 1 MPa}\n", "s.yaml:4:11: crushing needs the weight of the structure"),
        (FACADE + "mass: 100000\ncrushing: {strength: 1 MPa}\n", "crushing.depth is missing: give the length"),
        (
            FACADE + "density: 1800\ndepth: 1\ncrushing: {strength: 0.1 MPa}\n",
            "s.yaml:6:11: crushing: the structure cannot stand on what is left: a pivot moves inwards by 0.4",
        ),
        (FACADE + "density: 1800\ndepth: 1\ncrushing: {strenght: 1 MPa}\n", "did you mean strength?"),
        (
            "mechanism: arch\nradius: 10\nthickness: 1.5\ninclusion_angle_deg: 157.5\ndensity: 1800\ndepth: 1\n"
            "crushing: {strength: 1 MPa}\n",
            "s.yaml:7:11: crushing: its pivots cannot be moved in this version",
        ),
        (
            "mechanism: rigid_body\npolygon: [[0, 0], [1, 0], [0, 2]]\ndensity: 1800\ndepth: 1\ncorner_radius: 0.05\n"
            "crushing: {strength: 1 MPa}\n",
            "corner_radius cannot be combined with crushing",
        ),
    ],
)  # fmt: skip
def test_a_wrong_file_is_told(text, said):
    with pytest.raises(InputError) as caught:
        parse_structure(text, "s.yaml", "s", {"block": Block, "arch": Arch, "rigid_body": RigidBody})
    assert said in " ".join(str(caught.value).split())

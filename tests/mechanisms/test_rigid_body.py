"""A rigid body of parts, by its own numbers, and on rounded feet: against sums and derivations of their own."""

from math import atan2, hypot, pi

import numpy as np
import pytest
import sympy as sp

from mechanisms.block import Block
from mechanisms.rigid_body import RigidBody
from rocking_cli.codes.italian.chain import Chain
from rocking_cli.core import Direction, equivalent_block
from rocking_cli.core.kinematics import area_of
from rocking_cli.core.polygons import lies_within, overlap, pierced
from rocking_cli.core.reactions import reactions
from rocking_cli.core.structure_file import parse_structure
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.studies.contact import Contacts
from rocking_cli.studies.engines.free_blocks import free_blocks
from rocking_cli.testing import contract
from tests.following import respond
from tests.reference_mechanics import polygon_moments

POSITIVE, NEGATIVE = Direction


def box(x, y, width, height):
    return [[x, y], [x + width, y], [x + width, y + height], [x, y + height]]


WALL = {"polygon": box(0.0, 0.0, 4.0, 3.0), "density": 1800.0}
GABLE = {"polygon": [[0.0, 3.0], [4.0, 3.0], [1.5, 5.0]], "density": 1500.0, "depth": 0.3}
PINNACLE = {"polygon": [[1.2, 4.76], [1.5, 5.0], [1.4, 6.0]], "density": 2600.0}
WINDOW = {"polygon": box(1.0, 1.0, 1.0, 1.2), "opening": True}
DOOR = {"polygon": box(2.5, 0.0, 0.9, 2.1), "opening": True}


def facade(*others, **fields):
    return RigidBody(parts=[WALL, GABLE, PINNACLE, WINDOW, DOOR, *others], **{"depth": 0.5, **fields})


def test_its_parts_are_summed_exactly():
    mass = moment = about = 0.0
    for part, per_area in ((WALL, 900), (GABLE, 450), (PINNACLE, 1300), (WINDOW, -900), (DOOR, -900)):
        area, centroid, polar = polygon_moments([complex(*each) for each in part["polygon"]])
        mass += per_area * area
        moment += per_area * area * centroid
        about += per_area * (polar + area * abs(centroid) ** 2)
    found = facade()
    (body,) = found.weighed()
    assert found.total_mass() == body.mass == pytest.approx(mass, rel=1e-13)
    assert body.centroid == pytest.approx(moment / mass, rel=1e-13)
    assert body.inertia == pytest.approx(about - mass * abs(moment / mass) ** 2, rel=1e-12)


def test_one_part_is_the_polygon_and_two_halves_are_the_block():
    whole = equivalent_block(Block(width=0.7, height=2.8)).positive.as_dict()
    lower, upper = box(-0.35, 0.0, 0.7, 1.0), box(-0.35, 1.0, 0.7, 1.8)
    for parts in ([{"polygon": box(-0.35, 0.0, 0.7, 2.8)}], [{"polygon": upper}, {"polygon": lower}]):
        found = RigidBody(parts=parts)
        assert not found.has_mass
        assert equivalent_block(found).negative.as_dict() == pytest.approx(whole, rel=1e-12)


def test_by_its_own_numbers_it_is_the_block_of_that_mass():
    width, height, mass = 0.7, 2.8, 1200.0
    inertia = mass * (width**2 + height**2) / 12
    found = RigidBody(mass=mass, centroid=[0.0, 1.4], inertia=inertia, left_foot=[-0.35, 0.0], right_foot=[0.35, 0.0])
    known = Block(width=width, height=height, mass=mass)
    assert found.has_mass
    for direction in Direction:
        one, other = (equivalent_block(each)[direction].as_dict() for each in (found, known))
        assert one == pytest.approx(other, rel=1e-12)
    larger = equivalent_block(found.enlarged(3.0)).positive
    assert larger.p == pytest.approx(equivalent_block(found).positive.p / np.sqrt(3), rel=1e-12)


def numbers(width=0.6, height=2.4, **fields):
    """Return a block of 1 kg given by its numbers."""
    inertia = (width**2 + height**2) / 12
    feet = {"left_foot": [-width / 2, 0.0], "right_foot": [width / 2, 0.0]}
    return RigidBody(**{"mass": 1.0, "centroid": [0.0, height / 2], "inertia": inertia, **feet, **fields})


def test_drive_is_the_share_of_the_motion_that_moves_it():
    """A body under a motion at 30 degrees to its plane moves as under cos 30 of the motion in its plane."""
    share = 3**0.5 / 2
    plain = RigidBody(**numbers().model_dump(exclude_unset=True), loads=[{"name": "n", "mass": 0.1, "at": [0, 2]}])
    driven = plain.replace(drive=share)
    one, other = (equivalent_block(each).positive for each in (driven, plain))
    assert one.lambda_ == pytest.approx(other.lambda_ / share, rel=1e-14)
    assert one.v_imp == pytest.approx(other.v_imp / share, rel=1e-14)
    assert (one.p, one.phi_cr, one.eta) == (other.p, other.phi_cr, other.eta)
    time = 0.01 * np.arange(300)
    up = GroundMotion("up", 0.01, 2.0 * np.sin(9 * time), unit="m/s2")
    motions = [
        GroundMotion("m", 0.01, each * 4.0 * np.sin(9 * time), vertical=up, unit="m/s2") for each in (1.0, share)
    ]
    histories = [respond(each, motion) for each, motion in zip((driven, plain), motions, strict=True)]
    for model, history in histories[0].items():
        assert history.peak_ratio == pytest.approx(histories[1][model].peak_ratio, rel=1e-5)
        assert 0.2 < history.peak_ratio < 1
    phi, rate = np.array([0.0, 0.1]), np.array([0.0, -0.3])
    one = reactions(driven, POSITIVE, phi, rate, -4.0 + 1j)
    other = reactions(plain, POSITIVE, phi, rate, -4.0 * share + 1j)
    assert one.force == pytest.approx(other.force, rel=1e-13)


def test_what_a_share_of_the_motion_leaves_open_is_refused_or_not_known():
    driven = numbers(drive=0.9, polygon=box(-0.3, 0.0, 0.6, 2.4))
    motion = GroundMotion("m", 0.01, 4.0 * np.sin(0.04 * np.arange(300)), unit="m/s2")
    history = respond(driven, motion)["nonlinear"]
    assert history.check is None
    demand = Contacts(driven).check(history, motion)
    assert np.isnan([demand.friction_needed, demand.base_shear]).all()
    assert np.isnan(Contacts(driven).base_shear(history, motion)).all()
    with pytest.raises(InputError, match="free blocks cannot have a drive below 1"):
        free_blocks(driven)
    with pytest.raises(InputError, match="cannot be verified by the code"):
        Chain(driven, POSITIVE)
    assert [each.why for each in contract(driven) if not each.passed] == []
    whole = driven.replace(drive=1)
    assert not np.isnan(Contacts(whole).check(respond(whole, motion)["nonlinear"], motion).friction_needed)
    assert free_blocks(whole).bodies[0].inertia == whole.inertia


def test_a_silhouette_is_drawn_and_ends_the_motion():
    bare = numbers()
    whole = bare.replace(polygon=box(-0.3, 0.0, 0.6, 2.4))
    assert equivalent_block(whole).positive.as_dict() == pytest.approx(equivalent_block(bare).positive.as_dict())
    assert bare.limit(POSITIVE) == pytest.approx(pi / 2 + atan2(0.3, 1.2))
    assert whole.limit(POSITIVE) == pytest.approx(pi / 2)
    assert whole.sketch().outlines == {"body": [[complex(*each) for each in box(-0.3, 0.0, 0.6, 2.4)]]}
    assert not whole.own_caution()
    # An arm that hangs out 0.6 m at a height of 0.9 m; a corner that is 0.02 m high and 0.4 m before the left foot.
    arm = bare.replace(polygon=[[-0.7, 0.02], [-0.3, 0], [0.3, 0], [0.3, 0.8], [0.9, 0.9], [0.3, 1.0], [-0.3, 2.4]])
    assert arm.limit(POSITIVE) == pytest.approx(atan2(0.9, 0.6))
    assert "reaches the ground beyond its foot at 0.05 rad in the negative direction, before" in arm.own_caution()
    assert arm.limit(NEGATIVE) == pytest.approx(pi / 2)  # its upper left corner
    assert not arm.sketch().at_will
    assert bare.replace(polygon=box(-0.4, 0.0, 0.8, 2.4)).sketch().at_will == ["body"]


def test_feet_may_stand_on_a_step():
    found = RigidBody(mass=1.0, centroid=[0.1, 2.0], inertia=0.5, left_foot=[-0.5, 0.3], right_foot=[0.6, 0.0])
    assert found.uplift(POSITIVE) == pytest.approx(0.5 / 2.0)
    assert found.uplift(NEGATIVE) == pytest.approx(0.6 / 1.7)
    assert [each.why for each in contract(found) if not each.passed] == []


def test_rounded_feet_roll():
    """x_G' = r + |a| cos(alpha - phi), y_G' = |a| sin(alpha - phi), with a from the centre of the circle to G."""
    b, h, r = 0.4, 1.5, 0.06
    R, alpha = hypot(b, h), atan2(b, h)
    found = RigidBody(R=R, alpha_deg=np.degrees(alpha), inertia_ratio=1.3, corner_radius=r)
    a, tilt = hypot(b - r, h - r), atan2(b - r, h - r)
    central = 0.3 * R**2
    phi = np.array([0.0, 0.05, 0.2, 0.5])
    at = found.coefficients(phi, NEGATIVE)
    expected = {
        "I": central + a**2 + r**2 + 2 * a * r * np.cos(tilt - phi),
        "J": a * r * np.sin(tilt - phi),
        "G": a * np.sin(tilt - phi),
        "B": r + a * np.cos(tilt - phi),
        "V": a * (np.cos(tilt - phi) - np.cos(tilt)),
    }
    for name, values in expected.items():
        np.testing.assert_allclose(getattr(at, name), values, rtol=1e-12, err_msg=name)
    assert found.uplift(POSITIVE) == pytest.approx((b - r) / h, rel=1e-12)
    assert found.critical_rotation(POSITIVE) == pytest.approx(tilt, rel=1e-12)


def test_rounded_feet_by_lagrange():
    """The contact without slip as a constraint with a multiplier, in symbols."""
    b, h, r, inertia, g = 0.4, 1.5, 0.06, 0.9, 9.80665
    t = sp.Symbol("t")
    x, angle = (sp.Function(name)(t) for name in ("x", "angle"))
    u = sp.Function("u")(t)
    pull = sp.Symbol("pull")
    centroid = sp.Matrix([x + (-(b - r) * sp.cos(angle) + (h - r) * sp.sin(angle)),
                          r + (b - r) * sp.sin(angle) + (h - r) * sp.cos(angle)])  # fmt: skip
    velocity = centroid.diff(t) + sp.Matrix([u.diff(t), 0])
    T = velocity.dot(velocity) / 2 + sp.Rational(1, 2) * inertia * angle.diff(t) ** 2
    V = g * centroid[1]
    slip = x - r * angle
    equations = [
        T.diff(q.diff(t)).diff(t) - T.diff(q) + V.diff(q) - pull * slip.diff(q) for q in (x, angle)
    ] + [slip.diff(t, 2)]  # fmt: skip
    ddx, ddangle = sp.symbols("ddx ddangle")
    body = RigidBody(
        mass=1.0, centroid=[0.0, h], inertia=inertia, left_foot=[-b, 0.0], right_foot=[b, 0.0], corner_radius=r
    )
    for phi, rate, ground in ((0.0, 0.0, -3.0), (0.1, 0.4, 0.7), (0.25, -0.3, -2.0)):
        values = [(x.diff(t, 2), ddx), (angle.diff(t, 2), ddangle), (u.diff(t, 2), ground), (u.diff(t), 0)]
        values += [(x.diff(t), r * rate), (angle.diff(t), rate), (x, r * phi), (angle, phi)]
        matrix, right = sp.linear_eq_to_matrix([each.subs(values) for each in equations], [ddx, ddangle, pull])
        found = np.linalg.solve(np.array(matrix, float), np.array(right, float))[:, 0]
        at = body.coefficients(np.array([phi]), POSITIVE)
        acceleration = -(at.J * rate**2 + g * at.G + at.B * ground) / at.I
        assert acceleration[0] == pytest.approx(found[1], rel=1e-12)


def test_a_rounded_polygon_loses_what_is_cut_away():
    width, height, r = 0.7, 2.8, 0.1
    body = RigidBody(polygon=box(-width / 2, 0.0, width, height), corner_radius=r)
    angles = np.linspace(0, pi / 2, 201)
    right = width / 2 - r + 1j * r - 1j * r * np.exp(1j * angles)
    outline = [*right, complex(width / 2, height), complex(-width / 2, height), *(-right.conj())[::-1]]
    area, centroid, polar = polygon_moments(outline)
    (found,) = body.bodies()
    assert found.centroid == pytest.approx(centroid, rel=1e-6)
    assert found.inertia == pytest.approx(polar / area, rel=1e-6)
    assert body.limit(POSITIVE) == pytest.approx(pi / 2)  # on its side


def test_a_slanted_side_is_touched_by_its_circle():
    body = RigidBody(polygon=[[0.0, 0.0], [1.0, 0.0], [0.8, 3.0], [0.1, 3.0]], corner_radius=0.05)
    inside = pi - atan2(3.0, -0.2)  # the angle between its base and its side
    assert body.pivot(POSITIVE).real == pytest.approx(1 - 0.05 / np.tan(inside / 2))
    away = abs(((body.centre(POSITIVE) - 1) / complex(-0.2, 3.0)).imag) * hypot(0.2, 3.0)
    assert away == pytest.approx(0.05)


@pytest.mark.parametrize(
    "structure",
    [
        facade(),
        facade(corner_radius=0.1),
        facade(loads=[{"name": "roof", "mass": 3000.0, "at": [2.0, 3.0]}]),
        RigidBody(parts=[{"polygon": box(0.0, 0.0, 4.0, 3.0)}, WINDOW, DOOR]),
        RigidBody(polygon=box(0.0, 0.0, 0.7, 2.8), corner_radius=0.05),
        RigidBody(polygon=[[0.0, 0.0], [1.0, 0.0], [1.1, 3.0], [0.2, 3.2]], corner_radius=0.2),
        RigidBody(R=1.5, alpha_deg=14.0, inertia_ratio=1.3, corner_radius=0.1),
    ],
)
def test_it_keeps_the_contract(structure):
    assert [each.why for each in contract(structure) if not each.passed] == []


def test_polygons_touch_overlap_and_lie_within():
    def z(*args):
        return np.array([complex(*each) for each in box(*args)])

    square = z(0.0, 0.0, 1.0, 1.0)
    assert not overlap(square, z(1.0, 0.0, 1.0, 1.0), 1e-9)
    assert not overlap(square, z(1.0, 1.0, 1.0, 1.0), 1e-9)
    assert overlap(square, square, 1e-9)
    assert overlap(square, z(0.25, -1.0, 0.5, 3.0), 1e-9)
    assert overlap(square, z(0.25, 0.25, 0.5, 0.5), 1e-9)
    assert lies_within(z(0.0, 0.0, 0.5, 1.0), square, 1e-9)
    assert not lies_within(z(0.0, 0.0, 0.5, 1.1), square, 1e-9)
    holes = [z(0.1, 0.1, 0.2, 0.2), z(0.5, 0.0, 0.2, 0.5), z(0.4, 0.7, 0.1, 0.1)[::-1]]
    assert area_of(pierced(square[::-1], holes)) == pytest.approx(1 - 0.04 - 0.1 - 0.01)


BODY = "mechanism: rigid_body\n"
NUMBERS = BODY + "mass: 3\ncentroid: [0.5, 1]\ninertia: 1\nleft_foot: [0, 0]\nright_foot: [1, 0]\n"
PARTS = BODY + "parts:\n  - polygon: [[0, 0], [2, 0], [2, 3], [0, 3]]\n"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (BODY, "inertia_ratio is missing: give R, alpha_deg and inertia_ratio, or a polygon, or parts, or mass,"),
        (BODY + "mass: 3\ncentroid: [0, 1]\n", "inertia: give all of mass, centroid, inertia, left_foot, right_foot"),
        (
            BODY + "mass: 3\ncentroid: [0, 1]\ninertia: 1\nleft_foot: [1, 0]\nright_foot: [0.5, 0]\n",
            "b.yaml:6:13: right_foot is not to the right of left_foot",
        ),
        (
            BODY + "mass: 3\ncentroid: [2, 1]\ninertia: 1\nleft_foot: [0, 0]\nright_foot: [0.5, 0]\n",
            "b.yaml:3:11: centroid: it cannot stand: its centroid (x = 2 m) is not above its foot",
        ),
        (NUMBERS + "polygon: [[0, 0], [1, 1], [1, 0], [0, 1]]\n", "polygon: its sides cross or enclose nothing"),
        (NUMBERS + "drive: 0\n", "b.yaml:7:8: drive must be more than 0"),
        (NUMBERS + "drive: 1.1\n", "b.yaml:7:8: drive must be at most 1"),
        (NUMBERS + "drive: 0.9\nfriction: 0.5\n", "friction cannot be combined with a drive below 1"),
        (PARTS + "R: 1\n", "parts cannot be combined with R: describe the body in one of the two ways"),
        (PARTS + "  - polygon: [[0, 2], [2, 2], [1, 5]]\n", "b.yaml:4:14: parts[2].polygon: it overlaps part 1"),
        (PARTS + "  - polygon: [[0, 4], [2, 4], [1, 5]]\n", "parts[2].polygon: it is joined to no other part: the"),
        (
            PARTS + "  - polygon: [[1, 2], [3, 2], [1, 2.5]]\n    opening: true\n",
            "b.yaml:4:14: parts[2].polygon: this opening lies in no part",
        ),
        (
            PARTS + "  - polygon: [[0, 0], [1, 0], [0, 1]]\n    opening: true\n",
            "parts: an opening takes away its foot at x = 0 m",
        ),
        (PARTS + "    opening: true\n", "parts: all of them are openings"),
        (
            PARTS + "  - {polygon: [[1, 1], [1.5, 1], [1, 2]], opening: true, depth: 1}\n",
            "parts[2].depth: an opening goes through the part it lies in",
        ),
        (
            PARTS + "    density: 1800\n  - polygon: [[0, 3], [2, 3], [1, 5]]\n",
            "parts[2].density is missing: give density to all parts, or to the body",
        ),
        (PARTS + "  - polygon: [[0, 3], [2, 3], [2, 3]]\n", "b.yaml:4:14: parts[2].polygon: two corners are the same"),
        (PARTS + "corner_radius: 1.2\n", "b.yaml:4:16: corner_radius is too large"),
        (BODY + "R: 1\nalpha_deg: 10\ninertia_ratio: 1.3\ncorner_radius: 0.2\n", "corner_radius is too large"),
        (
            BODY + "polygon: [[0, 0], [2, 0], [2, 0.3], [1, 9], [0, 0.3]]\ncorner_radius: 0.4\n",
            "corner_radius is larger than the sides at the foot have room for, 0.3 m",
        ),
    ],
)  # fmt: skip
def test_a_wrong_file_is_told(text, said):
    with pytest.raises(InputError) as caught:
        parse_structure(text, "b.yaml", "b", {"rigid_body": RigidBody})
    assert said in " ".join(str(caught.value).split())


def test_rounded_feet_have_the_mass_of_their_arcs():
    """Each foot loses the corner outside its quarter of a circle: (1 - pi/4) r^2."""
    r, density, depth = 0.2, 2000.0, 0.5
    body = RigidBody(polygon=box(0.0, 0.0, 1.0, 4.0), corner_radius=r, density=density, depth=depth)
    (weighed,) = body.weighed()
    assert weighed.mass == pytest.approx(density * depth * (4.0 - 2 * (1 - pi / 4) * r**2), rel=1e-13)
    sharp = RigidBody(polygon=box(0.0, 0.0, 1.0, 4.0), density=density, depth=depth)
    assert sharp.weighed()[0].mass == pytest.approx(4000.0, rel=1e-13)

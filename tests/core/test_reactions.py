"""Reactions at joints, and impulses, against virtual work with a joint freed: a derivation that shares no code.

A state is a course phi(t) = phi + rate t + acceleration t^2/2 along which bodies are only followed: their
accelerations are differences of their places, and the acceleration is the one with which the linkage needs no drive. A
joint is freed, what is on one side of it moved in every way that its other joints allow, and the work of all is none.
"""

from itertools import pairwise
from math import cos, sin, tan

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mechanisms.arch import Arch
from mechanisms.asymmetric_frame import AsymmetricFrame
from mechanisms.block import Block
from mechanisms.rigid_body import RigidBody
from mechanisms.symmetric_frame import SymmetricFrame
from mechanisms.wall import Wall
from rocking_cli.core import Body, Direction, Joint, Mechanism, rotation
from rocking_cli.core.reactions import acceleration, at_uplift, impulses, parts, reactions
from rocking_cli.core.released import released, tabulated_impulses
from rocking_cli.core.structure_file import load_structure
from tests.conftest import EXAMPLES
from tests.reference_mechanics import deviation

G = 9.80665
BOTH = list(Direction)
FRAME = {"column_width": 1, "left_height": 6, "right_height": 7.5, "spacing": 8, "beam_depth": 1, "mass": 54000.0}
LOADS = [
    {"name": "floor", "mass": 9000.0, "at": [6.0, 6.5], "body": "beam BC", "floor": "sliding"},
    {"name": "vault", "force": [4000.0, -9000.0], "at": [0.3, 4.0], "body": "left column AB"},
]
TIES = [
    {"name": "bar", "from": {"ground": [-3, 0]}, "to": {"body": "beam BC", "at": [0, 6]}, "stiffness": 2e5,
     "prestress": 7000.0},
    {"name": "tendon", "stiffness": 3e5, "prestress": 5000.0, "path": [
        {"ground": [0, 0]}, {"body": "left column AB", "at": [0, 0]}, {"body": "left column AB", "at": [0, 6]},
        {"body": "beam BC", "at": [0, 6]}]},
    {"name": "bed", "bed": {"body": "right column CD", "from": [7.5, -1.5], "to": [8.5, -1.5]}, "modulus": 3e5},
]  # fmt: skip
STRUCTURES = {
    "frame": AsymmetricFrame(**FRAME),
    "tied": AsymmetricFrame(**FRAME, loads=LOADS, ties=TIES),
    "wall": Wall(thickness=0.3, height=3.0),
    "loaded wall": Wall(
        thickness=0.3,
        height=3.0,
        mass=1500.0,
        loads=[{"name": "roof", "mass": 700.0, "at": [0.05, 3.0], "body": "upper block", "vertical": 0.4}],
        ties=[
            {"name": "bar", "from": {"ground": [2, 1]}, "to": {"body": "lower block", "at": [0, 1]}, "stiffness": 9e3}
        ],
    ),
    "arch": Arch(radius=10.0, thickness=1.5, inclusion_angle_deg=157.5, voussoirs=7),
    "loaded arch": Arch(
        radius=10.0,
        thickness=1.5,
        inclusion_angle_deg=157.5,
        voussoirs=7,
        mass=8e4,
        loads=[{"name": "fill", "mass": 5000.0, "at": [0.4, 10.2], "body": "segment 3", "horizontal": 0.5}],
        ties=[
            {"name": "bar", "from": {"body": "segment 2", "at": [-4, 8.6]}, "to": {"body": "segment 4", "at": [4, 8.6]},
             "stiffness": 1e6, "prestress": 2e4}
        ],
    ),
    "symmetric frame": SymmetricFrame(column_width=1.0, column_height=6.0, mass_ratio=1.5, mass=5e4, friction=0.1),
    "block": Block(width=1.0, height=5.0),
}  # fmt: skip


def follow(structure, direction, phi):
    """Where points of bodies are, by their names, and how far these have turned, at one rotation."""
    motions = structure.motion(np.array([phi]), direction)
    named = {body.name: motion for body, motion in zip(structure.bodies(), motions, strict=True)}

    def place(name, point):
        return complex(point) if name is None else complex(named[name].carry(complex(point))[0][0])

    return place, {name: float(motion.psi[0]) for name, motion in named.items()}


def second_difference(values, h):
    """Of five values h apart, right to h^4."""
    return (-values[0] + 16 * values[1] - 30 * values[2] + 16 * values[3] - values[4]) / (12 * h * h)


def forces_on(structure, direction, phi, rate, turning, ground):
    """What the joints must exert on every body: force and place of it, and couple, as (name, place, force, couple)."""
    h = 4e-4
    course = [follow(structure, direction, phi + rate * t + turning * t * t / 2) for t in h * np.arange(-2, 3)]
    now, _ = course[2]
    needed = []
    for body in structure.weighed():
        moved = second_difference([place(body.name, body.centroid) for place, _ in course], h)
        turned = second_difference([turns[body.name] for _, turns in course], h)
        force = body.mass * (moved + ground + 1j * structure.gravity)
        needed.append((body.name, now(body.name, body.centroid), force, body.inertia * turned))
    for load in structure.loads or []:
        if load.mass is None:
            needed.append((load.body, now(load.body, complex(*load.at)), -complex(*load.force), 0.0))
            continue
        shares = {"horizontal": 1.0, "vertical": 1.0, "weight": 1.0}
        if load.floor == "sliding":
            shares = {"horizontal": 0.0, "vertical": 1 / 3, "weight": 0.5}
        shares |= {key: getattr(load, key) for key in shares if getattr(load, key) is not None}
        moved = second_difference([place(load.body, complex(*load.at)) for place, _ in course], h)
        up = shares["vertical"] * moved.imag + shares["weight"] * (ground.imag + structure.gravity)
        force = load.mass * (shares["horizontal"] * (moved.real + ground.real) + 1j * up)
        needed.append((load.body, now(load.body, complex(*load.at)), force, 0.0))
    for tie in structure.ties or []:
        needed += pulls(tie, now)
    return needed


def pulls(tie, place):
    """The opposite of what a tie exerts, an entry for every point of its path, or of its face."""
    if tie.bed is not None:
        nodes, weights = np.polynomial.legendre.leggauss(6)
        start, end = complex(*tie.bed.start), complex(*tie.bed.end)
        for node, weight in zip(nodes, weights, strict=True):
            rest = (start + end) / 2 + (end - start) / 2 * node
            now = place(tie.bed.body, rest)
            yield tie.bed.body, now, tie.modulus * abs(end - start) / 2 * weight * (now - rest), 0.0
        return
    spots = [(each.body, each.point) for each in tie.places]
    now = [place(*spot) for spot in spots]
    longer = sum(abs(b - a) for a, b in pairwise(now)) - tie.span
    tension = tie.prestress + tie.stiffness * longer
    for k, (name, _) in enumerate(spots):
        for other in (k - 1, k + 1):
            if 0 <= other < len(now) and now[other] != now[k]:
                yield name, now[k], -tension * (now[other] - now[k]) / abs(now[other] - now[k]), 0.0


def work(needed, of, about=None, along=None):
    """The virtual work of what some bodies need, in a turn about a point or a shift."""
    total = 0.0
    for name, at, force, couple in needed:
        if name in of:
            moved = along if along is not None else 1j * (at - about)
            total += (np.conj(force) * moved).real + (couple if along is None else 0.0)
    return total


def drive(structure, direction, phi, rate, turning, ground):
    """The generalised force that would have to drive the linkage: its motion by differences of its places."""
    needed, h = forces_on(structure, direction, phi, rate, turning, ground), 1e-5
    (fore, turned), (aft, was) = (follow(structure, direction, phi + each) for each in (h, -h))
    back, _ = follow(structure, direction, phi)
    total = 0.0
    for name, at, force, couple in needed:
        if name is None:
            continue
        point = rest_of(structure, direction, phi, name, at, back)
        total += (np.conj(force) * (fore(name, point) - aft(name, point))).real / (2 * h)
        total += couple * (turned[name] - was[name]) / (2 * h)
    return total


def rest_of(structure, direction, phi, name, at, place):
    """The point of a body that is now at a place."""
    origin = place(name, 0j)
    along = place(name, 1 + 0j) - origin
    return (at - origin) / along


def expected(structure, direction, phi, rate, ground):
    """Force at each joint, by its letter, on the link behind it."""
    still = drive(structure, direction, phi, rate, 0.0, ground)
    turning = -still / (drive(structure, direction, phi, rate, 1.0, ground) - still)
    return freed(structure, direction, phi, forces_on(structure, direction, phi, rate, turning, ground))


def jump_of_momentum(structure, ended, eta):
    """The same for an impact, over the rate before it: what bodies carry after it, less what they carried before."""
    h = 1e-4
    needed = []
    for body in structure.weighed():
        moved = turned = 0.0
        for direction, share in ((ended, 1.0), (ended.opposite, eta)):
            (place, turns), (later, turn) = (follow(structure, direction, each) for each in (h, 2 * h))
            at = 4 * place(body.name, body.centroid) - later(body.name, body.centroid) - 3 * body.centroid
            moved += share * at / (2 * h)
            turned += share * (4 * turns[body.name] - turn[body.name]) / (2 * h)
        needed.append((body.name, body.centroid, body.mass * moved, body.inertia * turned))
    return needed


def freed(structure, direction, phi, needed):
    """The force at each joint from what the bodies need, by virtual work."""
    place, _ = follow(structure, direction, phi)
    joints = structure.joints(direction)
    links = chain(structure, direction)
    points = [place(*where(joint, links)) for joint in joints]
    found = {}
    for j, joint in enumerate(joints):
        if joint.slide:
            continue
        rows, right = [], []
        for k in range(j, len(links)):  # the links behind the joint turn about the next one
            moved = set().union(*links[j : k + 1])
            if k + 1 < len(points):
                rows.append(1j * (points[j] - points[k + 1]))
                right.append(work(needed, moved, about=points[k + 1]))
                if joints[k + 1].slide:
                    rows.append(joints[k + 1].slide)
                    right.append(work(needed, moved, along=joints[k + 1].slide))
            else:  # nothing holds the last link but the joint before it, or what keeps it level
                shifts = [1.0, 1j]
                rows += shifts
                right += [work(needed, moved, along=each) for each in shifts]
        for k in range(j):  # and those before it about the joints before it
            moved = set().union(*links[k:j])
            rows.append(-1j * (points[j] - points[k]))
            right.append(work(needed, moved, about=points[k]))
        matrix = np.array([[row.real, row.imag] for row in rows])
        (x, y), *_ = np.linalg.lstsq(matrix, np.array(right), rcond=None)
        assert deviation(matrix @ [x, y], right) < 2e-6  # more equations than unknowns, and all of them hold
        found[joint.letter] = complex(x, y)
    return found


def chain(structure, direction):
    """The bodies of each link, from the joint A on."""
    number = parts(structure, direction)
    joints = structure.joints(direction)
    order = []
    for joint in joints:
        for name in sorted(joint.bodies, key=list(number).index, reverse=direction < 0 and len(number) > 3):
            if number[name] and number[name] not in order:
                order.append(number[name])
    return [{name for name, each in number.items() if each == k} for k in order]


def where(joint, links):
    """A body that moves at a joint, and the place of the joint in it."""
    name = next(name for link in links for name in joint.bodies if name in link)
    return name, joint.point


def behind(joint, j, links):
    """Whether the last of the bodies of a joint is in the link behind it: else its force is on the link before."""
    return j < len(links) and joint.bodies[-1] in links[j]


@pytest.mark.parametrize("direction", BOTH)
@pytest.mark.parametrize("name", STRUCTURES)
def test_reactions_are_those_of_virtual_work_with_a_joint_freed(name, direction):
    structure = STRUCTURES[name]
    reach = 0.6 * min(structure.limit(direction), 0.3)
    links, joints = chain(structure, direction), structure.joints(direction)
    for share, rate, ground in ((0.0, 0.0, -2.0), (0.3, 0.2, -3 + 0.5j), (0.9, -0.25, 1 - 2j)):
        phi = share * reach + 2e-6  # a difference needs room on both sides
        want = expected(structure, direction, phi, rate, complex(ground))
        found = reactions(structure, direction, np.array([phi]), np.array([rate]), complex(ground))
        size = max(abs(each) for each in want.values())
        assert [joint.letter for joint in found.joints] == [joint.letter for joint in joints]
        for j, (joint, force) in enumerate(zip(joints, found.force[:, 0], strict=True)):
            if not joint.slide:
                sign = 1 if behind(joint, j, links) else -1
                assert abs(sign * force - want[joint.letter]) < 3e-6 * size, joint.letter


ROUND = RigidBody(
    polygon=[[-0.35, 0], [0.35, 0], [0.3, 2.8], [-0.35, 2.8]], corner_radius=0.04, mass=1000.0,
    loads=[{"name": "bust", "mass": 300.0, "at": [0.1, 2.5], "horizontal": 0.9, "vertical": 0.4, "weight": 0.7}],
)  # fmt: skip


@pytest.mark.parametrize("direction", BOTH)
@pytest.mark.parametrize("name", [*STRUCTURES, "rounded"])
def test_the_check_of_histories_sees_the_same_forces(name, direction):
    """Of a joint that hinges; the forces of the check are affine in u_g'', phi.^2 and v_g''."""
    structure = STRUCTURES.get(name, ROUND)
    phi = np.array([0.0, 0.3, 0.9]) * 0.6 * min(structure.limit(direction), 0.3)
    checked = released(structure, direction, phi)
    states = ((0.0, -2.0), (0.2, -3 + 0.5j), (-0.25, 1 - 2j))
    for k, (rate, ground) in enumerate(states):
        force = checked.force[k] @ np.array([1.0, np.real(ground), rate**2, np.imag(ground)])
        own = reactions(structure, direction, phi[k : k + 1], np.array([rate]), complex(ground))
        size, seen = np.abs(own.force).max(), 0
        for contact, (normals, shear) in zip(checked.contacts, checked.rows, strict=True):
            if contact.held is None and len(contact.points) == 1:
                away = [abs(joint.point - contact.points[0]) for joint in own.joints]
                j, seen = int(np.argmin(away)), seen + 1
                assert force[normals[0]] == pytest.approx(own.normal[j, 0], abs=1e-9 * size)
                assert force[shear] == pytest.approx(own.shear[j, 0], abs=1e-9 * size)
        assert seen == sum(not joint.is_guide for joint in own.joints)


@pytest.mark.parametrize("name", ["frame", "wall", "arch", "block"])
def test_the_check_of_histories_sees_the_same_impulses(name):
    structure = STRUCTURES[name]
    for ended in BOTH:
        own = impulses(structure, ended)
        contacts = released(structure, ended.opposite, np.zeros(1))
        constant, factor = tabulated_impulses(structure, ended).T
        struck = constant + structure.eta(ended) * factor
        size = np.abs(own.force).max()
        for contact, (normals, shear) in zip(contacts.contacts, contacts.rows, strict=True):
            if contact.held is None and len(contact.points) == 1:
                j = int(np.argmin([abs(joint.point - contact.points[0]) for joint in own.joints]))
                assert struck[normals[0]] == pytest.approx(own.normal[j, 0], abs=1e-9 * size)
                assert struck[shear] == pytest.approx(own.shear[j, 0], abs=1e-9 * size)


def test_a_block_in_three_states():
    block = Block(width=1, height=5)
    phi, rate, u = np.array([0.0, 0.05, 0.1]), np.array([0.0, 0.2, -0.25]), np.array([-0.2, -0.3, 0.1])
    found = reactions(block, Direction.POSITIVE, phi, rate, u * G)
    assert found.shear[0] / G == pytest.approx([-0.2, -0.18727819, -0.04529637], abs=1e-8)
    assert found.normal[0] / G == pytest.approx([1.0, 1.00622297, 0.96947789], abs=1e-8)


@pytest.mark.parametrize(("alpha", "ratio"), [(0.1, 0.0750621), (0.2, 0.1504866), (0.3, 0.2265818)])
def test_the_impulse_of_a_block(alpha, ratio):
    block = Block(width=2 * sin(alpha), height=2 * cos(alpha))
    for ended in BOTH:
        found = impulses(block, ended)
        assert found.joints[0].letter == ("O'" if ended > 0 else "O")
        assert found.shear[0, 0] / found.normal[0, 0] == pytest.approx(ended * ratio, abs=1e-7)
        assert found.normal[0, 0] > 0
    given_eta = 1 - 1.5 * sin(alpha) ** 2 - 0.05
    found = impulses(block.model_copy(update={"restitution": given_eta}), Direction.POSITIVE)
    assert found.shear[0, 0] / found.normal[0, 0] == pytest.approx((1 - given_eta) / ((1 + given_eta) * tan(alpha)))


def test_at_rest_by_hand():
    """Nothing moves yet: weights above a joint, and the moments of the ground acceleration that starts the rocking."""
    wall, lam = STRUCTURES["wall"], 0.4
    found = at_uplift(wall, Direction.POSITIVE)
    a, b, _ = found.normal[:, 0]
    assert (a, b) == pytest.approx((G, G / 2))
    # The upper half about B: its weight at arm t/2, its inertia at arm h/4, the guide at arm h/2.
    t, h, half = 0.3, 3.0, G / 2
    guide = -(half * t / 2 + half * lam * h / 4) / (h / 2)
    assert found.force[2, 0] == pytest.approx(guide)
    assert found.shear[:2, 0] == pytest.approx([-G * lam - guide, -half * lam - guide])
    assert np.isnan(found.normal[2, 0]) and np.isnan(found.shear[2, 0])
    frame = at_uplift(STRUCTURES["symmetric frame"], Direction.NEGATIVE)
    beam = 0.6 * 5e4 * G
    assert frame.normal[:, 0] == pytest.approx([5e4 * G, beam])
    assert frame.shear[:, 0] == pytest.approx([5e4 * G / 6, beam / 6])
    assert frame.joints[1].level


HEIGHTS, MASSES = st.floats(2.0, 12.0), st.floats(1.0, 50.0)


@given(
    HEIGHTS,
    HEIGHTS,
    st.floats(3.0, 15.0),
    st.floats(0.3, 1.5),
    st.tuples(MASSES, MASSES, MASSES),
    st.sampled_from(BOTH),
    st.floats(0.0, 1.0),
    st.floats(-1.0, 1.0),
    st.complex_numbers(max_magnitude=8.0),
)
def test_any_frame(left, right, spacing, width, masses, direction, share, rate, ground):
    frame = AsymmetricFrame(
        column_width=width, left_height=left, right_height=right, spacing=spacing, beam_depth=0.7 * width,
        left_mass=masses[0], beam_mass=masses[1], right_mass=masses[2],
    )  # fmt: skip
    phi = 0.01 + 0.3 * share * min(frame.limit(direction), 0.5)
    want = expected(frame, direction, phi, rate, ground)
    found = reactions(frame, direction, np.array([phi]), np.array([rate]), ground).force[:, 0]
    behind_it = found * [1, 1, -1, -1]  # at C the right column is behind the beam, at D the ground behind that
    size = max(abs(each) for each in want.values()) + sum(masses)
    for joint, force in zip(frame.joints(direction), behind_it, strict=True):
        assert abs(force - want[joint.letter]) < 1e-4 * size, joint.letter


@pytest.mark.parametrize("ended", BOTH)
@pytest.mark.parametrize("name", ["frame", "wall", "arch", "symmetric frame", "block"])
def test_impulses_are_those_of_virtual_work_with_a_joint_freed(name, ended):
    structure, after = STRUCTURES[name], ended.opposite
    eta = structure.restitution_from_kinematics(ended)
    want = freed(structure, after, 0.0, jump_of_momentum(structure, ended, eta))
    found, links = impulses(structure, ended), chain(structure, after)
    assert not found.is_whole
    size = max(abs(each) for each in want.values())
    for j, (joint, force) in enumerate(zip(found.joints, found.force[:, 0], strict=True)):
        if not joint.slide:
            sign = 1 if behind(joint, j, links) else -1
            assert abs(sign * force - want[joint.letter]) < 1e-5 * size, joint.letter
            assert found.normal[j, 0] > 0


def test_loads_are_thrown_into_the_impulses_by_their_shares():
    """The sum over the joints of the ground is the jump of all momentum."""
    tied = STRUCTURES["tied"]
    for ended in BOTH:
        found, eta = impulses(tied, ended), tied.eta(ended)
        want = sum(force for _, _, force, _ in jump_of_momentum(tied, ended, eta))
        floor, h = 6 + 6.5j, 1e-5
        moved = [(follow(tied, d, h)[0]("beam BC", floor) - floor) / h for d in (ended, ended.opposite)]
        want += 9000 / 3 * 1j * (moved[0] + eta * moved[1]).imag  # it slides, and a third of it moves up
        a, _, _, d = found.force[:, 0]
        assert a + d == pytest.approx(want, rel=1e-4)


@pytest.mark.parametrize(
    ("name", "sums"), [("frame", True), ("wall", False), ("arch", False), ("symmetric frame", True)]
)
def test_with_a_given_restitution_only_sums_are_known(name, sums):
    structure = STRUCTURES[name].model_copy(update={"restitution": 0.7})
    found = impulses(structure, Direction.POSITIVE)
    if not sums:  # the guide takes part of the sum; faces that are not level do not show it
        assert found is None
        return
    assert found.is_whole
    want = sum(force for _, _, force, _ in jump_of_momentum(structure, Direction.POSITIVE, 0.7))
    assert found.force[0, 0] == pytest.approx(want, rel=1e-6)


def test_thrown_back_by_a_wall_nothing_is_known_of_the_impulses():
    assert impulses(Block(width=0.6, height=8.0, one_sided="positive"), Direction.POSITIVE) is None


class NoJoints(Wall):
    """A plugin that does not say where its joints are."""

    def joints(self, direction):
        return ()


class Split(Mechanism):
    """A block of two pieces that move as one, beside one that rests."""

    mechanism = "split"
    title = "block in two pieces"
    source = "none"

    def bodies(self):
        return Body("low", 2.0, 0.5, 1j), Body("high", 3.0, 0.7, 3j), Body("rock", 9.0, 1.0, 5 + 1j)

    def motion(self, phi, direction):
        turn = rotation(phi, 0.5 * direction + 0j, -direction)
        return turn, turn, rotation(phi, 5 + 0j, 0.0)

    def limit(self, direction):
        return 1.5

    def joints(self, direction):
        return (Joint("O", 0.5 * direction + 0j, ("low",)),)


def test_pieces_that_move_as_one_are_one_and_those_at_rest_are_ground():
    split, phi, rate = Split(), np.array([0.1]), np.array([0.4])
    assert dict(parts(split, Direction.POSITIVE)) == {"low": 1, "high": 1, "rock": 0}
    found = reactions(split, Direction.POSITIVE, phi, rate, -1.0)
    want = expected(split, Direction.POSITIVE, 0.1, 0.4, -1.0)
    assert found.force[0, 0] == pytest.approx(want["O"], rel=1e-6)


def test_without_joints_there_are_sums_over_the_whole():
    plugin, wall = NoJoints(thickness=0.3, height=3.0), STRUCTURES["wall"]
    phi, rate = np.array([0.02, 0.05]), np.array([0.1, -0.1])
    found, known = (reactions(each, Direction.POSITIVE, phi, rate, -2.0) for each in (plugin, wall))
    assert found.is_whole and not known.is_whole
    assert found.force[0] == pytest.approx(known.force[0] + known.force[2])
    assert found.normal[0] == pytest.approx(known.normal[0])


@pytest.mark.parametrize(("name", "letter", "body", "ends"), [
    ("frame", "B", "beam BC", (-0.5 + 6j, 8.5 + 6j)),
    ("frame", "C", "beam BC", (-0.5 + 6j, 8.5 + 6j)),
    ("wall", "B", "lower block", (-0.15 + 1.5j, 0.15 + 1.5j)),
])  # fmt: skip
def test_friction_is_along_the_face_as_it_has_turned(name, letter, body, ends):
    structure, phi = STRUCTURES[name], 0.1
    for direction in BOTH:
        found = reactions(structure, direction, np.array([phi]), np.array([0.1]), -1.0)
        j = [joint.letter[0] for joint in found.joints].index(letter)
        place, _ = follow(structure, direction, phi)
        along = place(body, ends[1]) - place(body, ends[0])
        along /= abs(along)
        force = found.force[j, 0]
        assert found.shear[j, 0] == pytest.approx((np.conj(along) * force).real)
        assert found.normal[j, 0] == pytest.approx((np.conj(1j * along) * force).real)
        assert abs(found.shear[j, 0] - force.real) > 1e-3 * abs(force)  # else it would not show


def test_a_tendon_whose_ends_meet_at_rest_pulls_along_its_opening():
    for direction in BOTH:
        at_rest, just_after = (
            reactions(STRUCTURES["tied"], direction, np.array([phi]), np.zeros(1), -2.0) for phi in (0.0, 1e-7)
        )
        assert deviation(at_rest.force, just_after.force) < 1e-5


def by_newton(structure, direction, phi, rate, push, joints, slide):
    """Forces at hinges on their bodies, of two bodies that slide along each other, and phi..: six equations at once.

    `joints`: letter, body and place of each hinge; `slide`: body, and where and along what it slides on the other. The
    path of each body by differences.
    """
    h = 1e-4

    def place(name, z):
        names = [body.name for body in structure.bodies()]
        motions = structure.motion(np.array([phi - h, phi, phi + h]), direction)
        return motions[names.index(name)].carry(z)[0]

    matrix, known = np.zeros((6, 6)), np.zeros(6)
    for k, body in enumerate(structure.weighed()):
        z, beside = place(body.name, body.centroid), place(body.name, body.centroid + 1)
        psi = np.unwrap(np.angle(beside - z))
        for row, path, mass in ((0, z.real, body.mass), (1, z.imag, body.mass), (2, psi, body.inertia)):
            dz, ddz = (path[2] - path[0]) / (2 * h), (path[2] - 2 * path[1] + path[0]) / h**2
            matrix[3 * k + row, 5] = -mass * dz
            known[3 * k + row] = mass * (ddz * rate**2 + (push, structure.gravity, 0)[row])
        for column, (_, name, at) in enumerate(joints):
            if name == body.name:
                arm = place(name, at)[1] - z[1]
                matrix[3 * k : 3 * k + 3, 2 * column : 2 * column + 2] = [[1, 0], [0, 1], [-arm.imag, arm.real]]
        point, line, at, along = slide
        face = place(line, at + along)[1] - place(line, at)[1]
        way = 1j * face / abs(face) * (1 if body.name == point else -1)
        arm = place(point, at)[1] - z[1]
        matrix[3 * k : 3 * k + 3, 4] = way.real, way.imag, (arm.conjugate() * way).imag
    found = np.linalg.solve(matrix, known)
    return {letter: complex(*found[2 * k : 2 * k + 2]) for k, (letter, _, _) in enumerate(joints)}


@pytest.mark.parametrize(("name", "joints", "slide"), [
    ("leaning_slab", [("A", "pier", 1.2), ("B", "slab", -1.2)], ("slab", "pier", 3j, 1j)),
    ("beam_on_pier", [("A", "pier", 7.0), ("B", "beam", 4j)], ("pier", "beam", 6 + 4j, 1.0)),
])  # fmt: skip
@pytest.mark.parametrize(("phi", "rate", "push"), [(0.0, 0.0, -2.5), (0.02, 0.1, -1.0), (0.05, -0.2, 3.0)])
def test_forces_where_a_body_slides_on_another_that_turns(name, joints, slide, phi, rate, push):
    structure = load_structure(EXAMPLES / "linkages" / f"{name}.yaml")
    phi = max(phi, 1e-4)
    found = reactions(structure, Direction.POSITIVE, np.array([phi]), np.array([rate]), push)
    want = by_newton(structure, Direction.POSITIVE, phi, rate, push, joints, slide)
    assert [joint.letter for joint in found.joints] == ["A", "B"] and not found.shared
    for force, letter in zip(found.force[:, 0], want, strict=True):
        assert force == pytest.approx(want[letter], rel=1e-4)


def test_forces_of_a_joint_too_many_are_the_least_that_balance():
    """Of all forces at six hinges: their sum is that of the masses, and no others that balance are smaller."""
    structure = load_structure(EXAMPLES / "linkages" / "portico.yaml")
    phi, rate, push = np.array([0.03]), np.array([0.2]), -1.0
    found = reactions(structure, Direction.POSITIVE, phi, rate, push)
    assert found.shared and not found.is_whole
    feet = [k for k, joint in enumerate(found.joints) if len(joint.bodies) == 1]
    assert len(feet) == 3 and found.total == pytest.approx(found.force[feet].sum(axis=0))
    turning, total = acceleration(structure, Direction.POSITIVE, phi, rate, push), 0j
    for body, motion in zip(structure.weighed(), structure.motion(phi, Direction.POSITIVE), strict=True):
        _, dz, ddz = motion.carry(body.centroid)
        total += body.mass * (dz * turning + ddz * rate**2 + push + 1j * structure.gravity)
    assert found.total == pytest.approx(total, rel=1e-9)
    # The only forces that balance by themselves: the columns push along themselves, the outer ones half of the middle.
    left = structure.motion(phi, Direction.POSITIVE)[[body.name for body in structure.bodies()].index("left")]
    along = left.carry(5j)[0] - left.carry(0.8 + 0j)[0]
    by_itself = [share * along for share in (1, 1, -2, -2, 1, 1)]
    work = sum((each.conj() * force).real for each, force in zip(by_itself, found.force, strict=True))
    assert abs(work) < 1e-9 * abs(along) * abs(total)

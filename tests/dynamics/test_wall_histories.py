"""Histories of walls of many blocks: the velocities at their joints, and modes of pieces that stay stuck together."""

import tracemalloc
from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import linprog

from rocking_cli import Registry, load_structure
from rocking_cli.core import Direction, both_statics
from rocking_cli.core import linkage as of_linkages
from rocking_cli.core import released as of_released
from rocking_cli.core.kinematics import Rates, VelocityTerm
from rocking_cli.core.linkage import Loops
from rocking_cli.core.released import ONE, PUSH, RATE, Pieces, Undetermined, _check_count, released
from rocking_cli.dynamics.joints import joints_of
from rocking_cli.dynamics.modes import _Placed, _thrown, modes, stuck
from rocking_cli.dynamics.tables import tabulate
from rocking_cli.views.verdict import contact_words
from tests.conftest import EXAMPLES
from tests.studies.test_contact import checked, shaking

CHECKED = (
    "assembly.yaml", "arch.yaml", "frame.yaml", "symmetric_frame.yaml", "spanning_wall.yaml", "masonry/portal.yaml",
    "masonry/buttressed_arch.yaml", "masonry/wall_of_three.yaml", "linkages/two_storeys.yaml", "walls/facade.yaml",
)  # fmt: skip
FORWARD = Direction.POSITIVE


def wall(bricks, courses, **given):
    """A wall in running bond whose bricks are .5 x .25 m."""
    blocks = {}
    for course in range(courses):
        edges = [0.5 * k for k in range(bricks + 1)]
        if course % 2:
            edges = [0.0, *(x + 0.25 for x in edges[:-1]), edges[-1]]
        low, high = 0.25 * course, 0.25 * (course + 1)
        for k, (left, right) in enumerate(pairwise(edges)):
            blocks[f"c{course} {k}"] = {"polygon": [[left, low], [right, low], [right, high], [left, high]]}
    floor = [[-1.0, -0.3], [bricks / 2 + 1, -0.3], [bricks / 2 + 1, 0.0], [-1.0, 0.0]]
    given = {"density": 1800.0, "depth": 0.25, "restitution": 0.7, **given}
    return Registry()["assembly"](blocks=blocks, ground={"floor": {"polygon": floor}}, **given)


@pytest.mark.rest
@pytest.mark.parametrize("name", CHECKED)
@pytest.mark.parametrize("direction", list(Direction))
def test_velocities_at_joints_are_those_of_their_points(name, direction):
    """Each row, at the rates of the mechanism, is how its point goes over a small rotation; and all its forms agree."""
    made = load_structure(EXAMPLES / name)
    contacts = made.contacts(direction)
    if direction not in made.directions or contacts is None:
        pytest.skip("its joints are not known")
    phi = 0.3 * made.limit(direction) + np.array([0.0, 1e-5, -1e-5])
    there = Pieces(made, direction, phi)
    rates, rows = there.rates(contacts)
    motions = dict(zip([each.name for each in made.bodies()], made.motion(phi, direction), strict=True))
    of = {each.body.name: each for each in made.pieces(direction)}
    dense = rates.dense()
    assert dense.shape[1] == sum(contact.forces for contact in contacts)
    assert rates.at(there.dq) == pytest.approx(np.einsum("nrq,nq->nr", dense, there.dq), abs=1e-12)

    def at(name, point):
        piece = of.get(name)
        if piece is None or piece.of is None:
            return np.full(3, point)
        return motions[piece.of].carry(point - piece.shift)[0] + piece.shift

    speeds = rates.at(there.dq)[0]
    size = np.abs(there.dq).max()
    for contact, (normals, shear) in zip(contacts, rows, strict=True):
        if contact.held is not None or contact.roll:
            continue
        first, second = contact.pieces
        apart = [at(second, point) - at(first, point) for point in contact.points]
        rate = [(each[1] - each[2]) / 2e-5 for each in apart]
        normal = there.normal(contact)[0]
        for row, each in zip(normals, rate, strict=True):
            assert speeds[row] == pytest.approx((each * np.conj(normal)).real, abs=1e-6 * size)
        along = (np.mean(rate) * np.conj(-1j * normal)).real
        assert speeds[shear] == pytest.approx(along, abs=1e-6 * size)


def test_joints_are_counted_before_any_matrix_is_made():
    """One force too many or too few: only with too many may others be found instead."""
    made = load_structure(EXAMPLES / "masonry/portal.yaml")
    contacts, pieces = made.contacts(FORWARD), made.pieces(FORWARD)
    _check_count(contacts, pieces)
    for given, redundant in (([*contacts, contacts[0]], True), (contacts[1:], False)):
        with pytest.raises(Undetermined) as error:
            _check_count(given, pieces)
        assert error.value.redundant is redundant


def bearable(made, direction, phi, demand, *, jumps=False):
    """Whether some forces at the joints exert a demand at a rotation, but for a share of it if the rate may jump."""
    there = Pieces(made, direction, np.array([phi]))
    contacts = made.contacts(direction)
    rates, rows = there.rates(contacts)
    balance = np.append(rates.dense()[0], there.momentum(there.dq) * jumps, axis=0)
    count = len(balance)
    low, cones = np.full(count, -np.inf), []
    for contact, (normals, shear) in zip(contacts, rows, strict=True):
        low[list(normals)] = 0.0
        for sense in (1.0, -1.0) if contact.friction is not None and shear is not None else ():
            cones.append(np.zeros(count + 1))
            cones[-1][list(normals)], cones[-1][shear] = -contact.friction, sense
    size = np.abs(demand).max()
    balance, demand = (balance / there.scale).T, demand / there.scale / size
    off = np.ones((len(demand), 1))  # the least by which the forces miss it
    above = np.vstack([np.hstack([balance, -off]), np.hstack([-balance, -off]), *cones])
    most = np.concatenate([demand, -demand, np.zeros(len(cones))])
    bounds = [*((each, None) for each in low), (0, None)]
    solved = linprog([*np.zeros(count), 1.0], A_ub=above, b_ub=most, bounds=bounds)
    assert solved.status == 0
    return solved.fun < 1e-8


WALL = wall(2, 3)


@pytest.mark.parametrize("direction", list(Direction))
@pytest.mark.parametrize(
    "made",
    [
        WALL, pytest.param(wall(2, 3, friction=1.5), marks=pytest.mark.rest),
        pytest.param(wall(1, 4, friction=0.9), marks=pytest.mark.rest),
    ],
)  # fmt: skip
def test_modes_say_of_any_state_what_a_programme_of_all_forces_says(made, direction):
    """States on either side of the edges, at the rotations at which these are sought, and the impulses of an impact."""
    critical = made.critical_rotation(direction)
    phi = np.linspace(0.0, critical, 5)
    found = modes(made, direction, phi, critical)
    there = Pieces(made, direction, phi)
    demand = there.demands()
    push = made.uplift(direction) * made.gravity
    fast = 2 * made.potential_energy(phi[-1:], direction)[0] / made.kinetic_inertia(phi[:1], direction)[0]
    rng = np.random.default_rng(5)
    said = []
    for k in range(5):
        force = found.released.force[k][:, [ONE, PUSH, RATE]]
        for factor in (0.98, 1.02, 0.98, 1.02):
            way = np.array([push * rng.uniform(-1, 1), fast * rng.uniform(0, 1)])
            slope = force[:, 1:] @ way
            reach = np.min(-force[slope < 0, 0] / slope[slope < 0], initial=np.inf)
            state = np.array([1.0, *(factor * reach * way if reach < 10 else way)])
            bears = bool((force @ state > 0).all())
            assert bears == bearable(made, direction, phi[k], demand[k][:, [ONE, PUSH, RATE]] @ state)
            said.append(bears)
    assert 5 <= sum(said) <= 18
    if made.rocks_both_ways:
        old = Pieces(made, direction.opposite, np.zeros(1))
        bears = bool((found.struck[:, 0] > -1e-9 * np.abs(found.struck).max()).all())
        assert bears == bearable(made, direction, 0.0, old.momentum(old.dq)[0], jumps=True)


@pytest.mark.parametrize("begins", [1, 5])
def test_a_mode_that_does_not_exist_at_rest_has_no_part_in_impacts(begins, monkeypatch):
    """What no joint could follow says nothing of what they bear; if it exists at no rotation, it is no mode."""
    critical = WALL.critical_rotation(FORWARD)
    phi = np.linspace(0.0, critical, 5)
    if begins == 1:
        assert np.abs(modes(WALL, FORWARD, phi, critical).struck[:, 0]).min() > 0
    monkeypatch.setattr(_Placed, "_closes_nothing", lambda self, speed: np.arange(len(speed)) >= begins)
    found = modes(WALL, FORWARD, phi, critical)
    assert bool(found.released.contacts) == (begins < 5)
    assert not found.struck.any()
    assert not found.released.force[:begins, :, [PUSH, RATE]].any()


def test_an_impact_throws_several_joints_open_one_after_the_other():
    made = load_structure(EXAMPLES / "assembly.yaml")
    there = _Placed(made, FORWARD, made.contacts(FORWARD), np.zeros(1))
    jump = there.jump(made)
    thrown = list(_thrown(there, jump))
    work = np.array([velocity @ jump.sum(axis=1) for velocity in thrown])
    assert len({there.pattern(velocity, 0) for velocity in thrown}) == len(thrown) >= 2
    assert (work < 0).all() and (np.diff(work) > 0).all()


def joined(*rows, count, centres, rotations=1):
    """The parts of pieces between which rows of (piece, piece, point, direction) hold; -1 is the ground."""
    centres = np.array(centres, complex)

    def share(piece, sign, at, way):
        arm = at - centres[piece]
        each = [way.real, way.imag, (np.conj(arm) * way).imag]
        return VelocityTerm(piece, sign * np.tile(each, (rotations, 1)))

    held = [
        [share(one, sign, at, way) for one, sign in ((second, 1.0), (first, -1.0)) if one >= 0]
        for first, second, at, way in rows
    ]
    return Rates.of(held, count, rotations), stuck(Rates.of(held, count, rotations), np.tile(centres, (rotations, 1)))


def test_pieces_are_stuck_where_rows_leave_them_no_motion():
    """A block on the ground, one on it by a hinge, one that only slides on that, and two that a third makes one."""
    ground = [(-1, 0, x, way) for x, way in ((0j, 1j), (1 + 0j, 1j), (0j, 1 + 0j))]
    hinge = [(0, 1, 1 + 1j, 1j), (1, 0, 1 + 1j, 1 + 0j), (0, 1, 1 + 1j, 0.6 + 0.8j)]
    slides = [(1, 2, 2j, 1j), (1, 2, 1 + 2j, 1j)]
    of_two = [(1, 3, 3 + 3j, 1j), (1, 3, 4 + 3j, 1j), (1, 3, 3 + 3j, 1 + 0j), (3, 4, 6j, 1j), (1, 4, 7j, 1 + 0j)]
    centres = [0.5 + 0.5j, 0.5 + 1.5j, 0.5 + 2.5j, 3.5 + 3.5j, 0.5 + 8j]
    _, one = joined(*ground, *hinge, *slides, *of_two, count=5, centres=centres)
    assert one.part[0] == -1 and one.part[1] == one.part[3]
    assert one.count == len({one.part[1], one.part[2], one.part[4]}) == 3
    rates, one = joined(*ground, *hinge, *slides, *of_two, (4, 1, 5 + 7j, 1j), count=5, centres=centres)
    assert one.part[4] == one.part[1] == one.part[3] and one.count == 2  # by rows with either of the two
    rng = np.random.default_rng(1)
    parts = rng.normal(size=(1, 6))
    moved = one.spread(parts)
    speeds = rates.at(moved)[0]
    between = np.abs(speeds) > 1e-12
    assert between.sum() == 5  # the hinge and what slides
    assert one.contracted(rates).at(parts)[0] == pytest.approx(speeds[between])
    momentum = rng.normal(size=(1, 15))
    assert one.gathered(momentum)[0] @ parts[0] == pytest.approx(momentum[0] @ moved[0])


def test_forces_that_statics_does_not_determine_are_said_to_be_sums():
    """Three piers under one beam: where the joints are is known, how they share the forces is not."""
    piers = {f"pier {k}": (2.0 * k, 0.0, 2.0 * k + 0.4, 2.0) for k in range(3)}
    boxes = {**piers, "beam": (0.0, 2.0, 4.4, 2.4)}
    blocks = {name: {"polygon": [[x, y], [x1, y], [x1, y1], [x, y1]]} for name, (x, y, x1, y1) in boxes.items()}
    floor = [[-1.0, -0.3], [6.0, -0.3], [6.0, 0.0], [-1.0, 0.0]]
    made = Registry()["assembly"](blocks=blocks, ground={"floor": {"polygon": floor}}, density=1800.0, depth=0.4)
    _, found = checked(made, shaking(0.3))
    said = contact_words(found, made)
    assert found.whole
    assert "Statics alone does not determine the force at each joint" in said and "sums over the whole" in said
    assert "positions of its joints are not known" not in said


def test_pieces_are_not_stuck_that_move_at_some_rotation():
    rows = [
        [VelocityTerm(0, np.array(each))] for each in ([[0, 1.0, -1]] * 2, [[0, 1.0, 1], [0, 1, -1]], [[1.0, 0, 1]] * 2)
    ]
    assert stuck(Rates.of(rows, 1, 2), np.zeros((2, 1), complex)).count == 1
    assert stuck(Rates.of(rows, 1, 2).rotations([0]), np.zeros((1, 1), complex)).count == 0


@pytest.mark.rest
def test_joints_of_a_wall_take_little_memory():
    """Rows are of two blocks each: no matrix of all blocks and joints is held for every rotation."""
    made = wall(3, 8)
    statics = both_statics(made)
    tables = tabulate(made, statics)
    tracemalloc.start()
    try:
        found = joints_of(made, statics, tables, 1.0)
        most = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert found is not None and found.redundant and found.labels
    assert most < 12e6


@pytest.mark.parametrize("at_once", [10, 2000])  # less than a matrix, and some of them
def test_joints_that_statics_determines_are_solved_in_parts(at_once, monkeypatch):
    made = load_structure(EXAMPLES / "masonry/portal.yaml")
    phi = np.linspace(0.0, 0.1, 7)
    whole = released(made, FORWARD, phi)
    monkeypatch.setattr(of_released, "MAX_ENTRIES", at_once)
    parts = released(made, FORWARD, phi)
    assert parts.force == pytest.approx(whole.force, rel=1e-12, abs=1e-6)
    assert parts.compliance == pytest.approx(whole.compliance, rel=1e-12)


@pytest.mark.parametrize(("at_once", "largest"), [(60, 60), (1, 6)])  # of ten rotations, and of one
def test_a_long_motion_is_solved_in_parts(at_once, largest, monkeypatch):
    """Where the matrices of all rotations would be large; the parts say what the whole says."""
    whole = load_structure(EXAMPLES / "linkages/two_storeys.yaml")
    phi = np.linspace(0.0, 0.9 * whole.limit(FORWARD), 50)
    expected = whole.motion(phi, FORWARD)
    monkeypatch.setattr(of_linkages, "MAX_ENTRIES", at_once)
    solved = []
    plain = of_linkages.LinkageMotion._followed
    monkeypatch.setattr(
        of_linkages.LinkageMotion, "_followed", lambda self, at: solved.append(at.size) or plain(self, at)
    )
    other = load_structure(EXAMPLES / "linkages/two_storeys.yaml")
    other.limit(FORWARD)
    sizes = []
    matrix = Loops.matrix
    monkeypatch.setattr(Loops, "matrix", lambda self, x: sizes.append((found := matrix(self, x)).size) or found)
    found = other.motion(phi, FORWARD)
    assert len(solved) > 2 and sum(solved) == 50
    assert max(sizes) == largest
    for one, other in zip(expected, found, strict=True):
        assert one.q == pytest.approx(other.q, abs=1e-12)
        assert one.ddpsi == pytest.approx(other.ddpsi, abs=1e-9)

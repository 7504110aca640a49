"""The limit analysis of assemblies against hand formulas, statics written out, and programmes that share no code."""

from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from pytest import approx
from scipy.optimize import linprog
from scipy.sparse import csr_array

from mechanisms._assembly import (
    AssemblyBlock,
    AssemblyContact,
    AssemblyFault,
    AssemblyHinge,
    AssemblyLinkage,
    ContactFault,
    DisplacedAssembly,
    DoesNotStand,
    NoAnswer,
    NothingMoves,
    Opening,
    collapse,
    contacts,
    first_violation,
    friction,
    leading,
    linkage,
    remaining,
    thrust,
)
from mechanisms._assembly.problem import Rays, scaled
from mechanisms._assembly.unique import kept_rays, velocity_space
from mechanisms.arch import Arch
from rocking_cli.core import Direction, Guide, annular_sector, four_bar, polygon
from tests.reference_mechanics import Voussoirs

POSITIVE, NEGATIVE = Direction.POSITIVE, Direction.NEGATIVE
g = 9.80665


def rectangle(name, x0, y0, x1, y1, density=1.0):
    corners = (complex(x0, y0), complex(x1, y0), complex(x1, y1), complex(x0, y1))
    return AssemblyBlock(name, corners, density * (x1 - x0) * (y1 - y0), complex(x0 + x1, y0 + y1) / 2)


FLOOR = [rectangle("ground", -10, -1, 10, 0)]
R, T, BETA = 10.0, 1.5, np.radians(157.5)


@cache
def ring(n, edges=8, exact=True):
    """The voussoirs of Oppenheim's arch as polygons, with the mass of those or of the sectors, and its springings."""
    angles = np.pi / 2 + BETA / 2 - np.linspace(0, BETA, n + 1)
    blocks = []
    for k, (a, b) in enumerate(pairwise(angles)):
        turns = np.exp(1j * np.linspace(a, b, edges + 1))
        corners = (*((R + T / 2) * turns).tolist(), *((R - T / 2) * turns[::-1]).tolist())
        body = annular_sector("", 1.0, R - T / 2, R + T / 2, a, b)
        if not exact:
            z = np.array(corners)
            body = polygon("", abs((z.conj() * np.roll(z, -1)).imag.sum()) / 2, corners)
        blocks.append(AssemblyBlock(f"v{k + 1}", corners, body.mass, body.centroid))
    springings = []
    for name, angle, sign in (("left", angles[0], 1), ("right", angles[-1], -1)):
        u = np.exp(1j * angle)
        inner, outer, down = (R - T / 2 - 1) * u, (R + T / 2 + 1) * u, sign * 1j * u
        springings.append(
            AssemblyBlock(name, (complex(inner), complex(outer), complex(outer + down), complex(inner + down)))
        )
    return blocks, springings


@cache
def oppenheim(mu=None):
    blocks, ground = ring(7)
    found = contacts(blocks, ground, friction=mu)
    return blocks, found, collapse(blocks, found)


def weights(blocks):
    w = np.array([block.mass for block in blocks]) * g
    none = 0 * w
    return np.column_stack([none, -w, none]), np.column_stack([w, none, none])


def unbalanced(blocks, joints, found, direction=POSITIVE, guides=()):
    """The largest force or moment left over on any block, by summing what acts on it, over the weight."""
    sums = {block.name: np.array([direction * found.multiplier * block.mass * g, -block.mass * g, 0.0])
            for block in blocks}  # fmt: skip

    def add(name, force, point):
        if name in sums:
            arm = point - next(block.centroid for block in blocks if block.name == name)
            sums[name] += [force.real, force.imag, arm.real * force.imag - arm.imag * force.real]

    for joint, normal, shear in zip(joints, found.normal, found.shear, strict=True):
        along = (joint.end - joint.start) / abs(joint.end - joint.start)
        for force, point in (
            (normal[0] * joint.normal, joint.start), (normal[1] * joint.normal, joint.end), (shear * along, joint.end),
        ):  # fmt: skip
            add(joint.b, force, point)
            add(joint.a, -force, point)
    for guide, force in zip(guides, found.guide, strict=True):
        add(guide.body, force * 1j * guide.along / abs(guide.along), guide.at)
    return max(np.abs(total).max() for total in sums.values()) / sum(block.mass * g for block in blocks)


# --- where blocks touch ----------------------------------------------------------------------------------------------


def only(blocks, ground=FLOOR, **options):
    (joint,) = contacts(blocks, ground, **options)
    return joint


def test_a_block_on_the_ground_touches_it_along_its_foot():
    joint = only([rectangle("block", 1, 0, 3, 4)])
    assert (joint.a, joint.b) == ("ground", "block")
    assert {joint.start, joint.end} == {1, 3}
    assert joint.normal == approx(1j)
    # The second body is on the left of the way from start to end, whichever the order of corners.
    assert 1j * (joint.end - joint.start) / joint.length == approx(joint.normal)
    backwards = replace(rectangle("block", 1, 0, 3, 4), corners=rectangle("block", 1, 0, 3, 4).corners[::-1])
    assert only([backwards]) == joint


def test_the_lower_of_two_blocks_bears_the_other_whatever_their_order():
    low, high = rectangle("low", 0, 0, 2, 1), rectangle("high", 0.5, 1, 1, 2)
    for blocks in ([low, high], [high, low]):
        joint = next(c for c in contacts(blocks, FLOOR) if "high" in (c.a, c.b))
        assert (joint.a, joint.b, joint.start, joint.end) == ("low", "high", 0.5 + 1j, 1 + 1j)
        assert joint.normal == approx(1j)
        assert [joint.face_at(end) for end in (0, 1)] == ["low", "low"]
    wide = next(c for c in contacts([rectangle("low", 0.5, 0, 1, 1), rectangle("high", 0, 1, 2, 2)], FLOOR)
                if "high" in (c.a, c.b))  # fmt: skip
    assert [wide.face_at(end) for end in (0, 1)] == ["high", "high"]  # the corners are those of the lower block


@pytest.mark.parametrize("width", [0.0, 1e-4, 0.9e-2])
def test_a_small_gap_is_a_joint_halfway(width):
    low, high = rectangle("low", 0, 0, 1, 4), rectangle("high", 0, 4 + width, 1, 8)
    joint = next(c for c in contacts([low, high], FLOOR) if c.b == "high")
    assert joint.start == approx((4 + width / 2) * 1j)


def test_a_wider_gap_is_none_and_its_size_is_the_callers():
    low, high = rectangle("low", 0, 0, 1, 4), rectangle("high", 0, 4.02, 1, 8)
    with pytest.raises(ContactFault, match=r"'high' touches nothing along an edge"):
        contacts([low, high], FLOOR)
    assert len(contacts([low, high], FLOOR, gap=0.01)) == 2
    # It is that of the smaller block: neither a large neighbour nor a large ground closes it.
    small = rectangle("small", 5, 0.005, 5.5, 0.5)
    with pytest.raises(ContactFault, match="'small'"):
        contacts([rectangle("large", -9, 0, 4, 8), small], FLOOR)


def test_a_gap_in_metres_is_that_of_small_blocks_beside_large_ones():
    """A voussoir between piers of ten times its size, 4 mm off one of them."""
    blocks = [
        rectangle("left", 0, 0, 2, 8), rectangle("key", 2.004, 7, 2.804, 8), rectangle("right", 2.804, 0, 4.8, 8)
    ]  # fmt: skip
    assert len(contacts(blocks, FLOOR)) == 3
    assert len(contacts(blocks, FLOOR, within=0.005)) == 4
    assert len(contacts(blocks, FLOOR, within=0.003)) == 3


def test_a_corner_on_an_edge_is_no_joint_and_corners_that_meet_are_none():
    with pytest.raises(ContactFault, match="a corner on an edge does not count as a joint") as caught:
        contacts([AssemblyBlock("diamond", (0j, 1 + 1j, 2j, -1 + 1j), 2.0, 1j)], FLOOR)
    assert caught.value.blocks == ("diamond",)
    one, other = rectangle("one", 0, 0, 1, 1), rectangle("other", 1, 1, 2, 2)
    with pytest.raises(ContactFault, match="'other'"):
        contacts([one, other], FLOOR)
    # Drawn to millimetres such corners overlap a little.
    shifted = rectangle("other", 1 - 1e-3, 1 + 1e-3, 2, 2)
    with pytest.raises(ContactFault, match="'other'"):
        contacts([one, shifted], FLOOR)


def test_edges_that_are_not_parallel_are_no_joint():
    leaning = AssemblyBlock("leaning", (1 + 0j, 2 + 0j, 2 + 4j, 1.5 + 4j), 3.0, 1.6 + 1.8j)
    found = contacts([rectangle("one", 0, 0, 1, 4), leaning], FLOOR)
    assert [(c.a, c.b) for c in found] == [("ground", "one"), ("ground", "leaning")]
    for foot, head in ((1.0, 1.1), (1.1, 1.0)):  # by 1.4 degrees, and they touch at one end
        leaning = AssemblyBlock("leaning", (foot + 0j, 2 + 0j, 2 + 4j, head + 4j), 3.0, 1.6 + 1.8j)
        found = contacts([rectangle("one", 0, 0, 1, 4), leaning], FLOOR)
        assert [(c.a, c.b) for c in found] == [("ground", "one"), ("ground", "leaning")]


def test_collinear_parts_of_two_bodies_are_one_joint():
    portal = AssemblyBlock("portal", (0j, 1, 1 + 2j, 3 + 2j, 3, 4, 4 + 3j, 3j), 8.0, 2 + 1.8j)
    joint = only([portal])
    assert {joint.start, joint.end} == {0, 4}
    # Corners along an edge divide nothing, nor do slight bends of a drawing.
    many = AssemblyBlock("many", (0j, 0.3 + 0j, 0.7 + 1e-4j, 1 + 0j, 1 + 4j, 4j), 4.0, 0.5 + 2j)
    assert {z.real for z in only([many]).ends} == {0, 1}
    # A wedge bears on two lines, which are two joints.
    pit = [AssemblyBlock("pit", (-5 - 5j, 5 - 5j, 5 + 5j, 0j, -5 + 5j))]
    step = [AssemblyBlock("step", (-1j, 2 - 1j, 2 + 1j, 1 + 1j, 1 + 0j, 0j))]
    stepped = AssemblyBlock("stepped", (0j, 1 + 0j, 1 + 1j, 2 + 1j, 2 + 4j, 4j), 7.0, 1 + 2j)
    assert sorted(sorted(z.real for z in c.ends) for c in contacts([stepped], step) if abs(c.normal.real) < 0.1) == [
        [0, 1], [1, 2],
    ]  # fmt: skip
    wedge = AssemblyBlock("wedge", (0j, 1 + 1j, -1 + 1j), 1.0, 2j / 3)
    assert len(contacts([wedge], pit)) == 2


def test_blocks_that_overlap_are_named():
    with pytest.raises(ContactFault, match="'one' and 'other' overlap"):
        contacts([rectangle("one", 0, 0, 1, 4), rectangle("other", 0.9, 0, 2, 4)], FLOOR)
    with pytest.raises(ContactFault, match="'sunk' and 'ground' overlap"):
        contacts([rectangle("sunk", 0, -0.1, 1, 4)], FLOOR)
    both = [*FLOOR, rectangle("more ground", -5, -2, 5, 0), rectangle("ground beside", 10, -1, 20, 0)]
    assert len(contacts([rectangle("block", 0, 0, 1, 4)], both)) == 2
    with pytest.raises(ContactFault, match="more than one body is called 'twin'"):
        contacts([rectangle("twin", 0, 0, 1, 1), rectangle("twin", 2, 0, 3, 1)], FLOOR)


@pytest.mark.parametrize("shaken", [False, True])
def test_an_arch_drawn_to_millimetres_keeps_its_joints(shaken):
    rng = np.random.default_rng(1)
    blocks, ground = ring(21)
    drawn = []
    for block in blocks:
        z = np.array(block.corners)
        if shaken:  # each voussoir drawn by itself
            z = z + rng.uniform(-1e-3, 1e-3, z.size) + 1j * rng.uniform(-1e-3, 1e-3, z.size)
        drawn.append(replace(block, corners=tuple(np.round(z, 3).tolist())))
    found = contacts(drawn, ground)
    assert len(found) == 22
    exact = collapse(blocks, contacts(blocks, ground)).multiplier
    assert collapse(drawn, found).multiplier == approx(exact, rel=5e-3)


# --- the multiplier --------------------------------------------------------------------------------------------------


def solved(blocks, ground=FLOOR, direction=POSITIVE, guides=(), **options):
    return collapse(blocks, contacts(blocks, ground, **options), guides, direction)


@pytest.mark.parametrize("direction", list(Direction))
def test_one_block_turns_about_its_toe(direction):
    # A centroid off the middle has another lever in each direction.
    block = replace(rectangle("block", 0, 0, 1, 4), centroid=0.3 + 1.6j)
    found = solved([block], direction=direction)
    lever = 0.7 if direction > 0 else 0.3
    assert found.multiplier == approx(lever / 1.6, rel=1e-12)
    assert found.kinematic == approx(lever / 1.6, rel=1e-12)
    assert found.unique
    assert found.several == ()
    # The velocity of the centroid about the toe, and clockwise where it is thrown to the right.
    assert found.velocity == approx(np.array([[direction * 1.6, lever, -direction]]), abs=1e-12)
    toe = complex(direction > 0)
    ends = found.problem.bearings.rows.points
    assert sorted(found.opening[0]) == approx([0, 1], abs=1e-12)
    assert abs(ends[int(found.opening[0].argmin())] - toe) < 1e-12


def test_shear_that_is_free_glues_a_joint_between_two_blocks_side_by_side():
    blocks = [rectangle("left", 0, 0, 1, 4), rectangle("right", 1, 0, 2, 4)]
    glued = solved(blocks)
    assert glued.multiplier == approx(0.5, rel=1e-12)  # one block, 2 wide
    assert friction(glued).needed == approx(2.0, rel=2e-6)
    smooth = solved(blocks, per_pair={("left", "right"): 0.0})
    assert smooth.multiplier == approx(0.25, rel=1e-12)
    assert not smooth.unique  # the right one alone, or pushed by the left one
    assert {each.moves for each in smooth.several} == {("right",), ("left", "right")}
    assert all(each.multiplier == approx(0.25, rel=1e-9) for each in smooth.several)
    # The least friction jams the joint between feet that never slide: what turns would have to dilate. It is seen.
    jammed = solved(blocks, per_pair={("left", "right"): 1e-3})
    assert jammed.multiplier == approx(0.5, rel=1e-9)
    assert friction(jammed).needed is None


def test_an_overhanging_stack_is_refused_though_pushed_back_it_would_have_an_answer():
    def stack(*shifts):
        return [rectangle(f"b{k}", x, k, x + 1, k + 1) for k, x in enumerate(shifts)]

    with pytest.raises(DoesNotStand, match=r"does not stand by itself: nothing holds 'b2'") as caught:
        solved(stack(0, 0, 0.6), direction=NEGATIVE)
    assert caught.value.blocks == ("b2",)
    # Of two blocks the upper one may reach out by a half, of three by a half and a quarter.
    assert solved(stack(0, 0.24, 0.73)).multiplier > 0
    with pytest.raises(DoesNotStand):
        solved(stack(0, 0.26, 0.75))
    with pytest.raises(DoesNotStand, match="barely stands"):
        solved(stack(0, 0.5))


def test_a_frictionless_foot_slides_at_once():
    with pytest.raises(DoesNotStand, match="the least acceleration sets 'block' in motion"):
        solved([rectangle("block", 0, 0, 1, 4)], friction=0.0)


def test_friction_bounds_the_multiplier_of_one_block():
    for mu in (0.1, 0.2, 0.3):
        found = solved([rectangle("block", 0, 0, 1, 4)], friction=mu)
        assert found.multiplier == approx(min(mu, 0.25), rel=1e-12)
        assert found.kinematic == approx(found.multiplier, rel=1e-9)


def test_what_nothing_can_move_is_said():
    pit = [*FLOOR, rectangle("wall", -2, 0, 0, 4), rectangle("other wall", 1, 0, 2, 4)]
    with pytest.raises(NothingMoves, match="no acceleration"):
        solved([rectangle("block", 0, 0, 1, 4)], pit)
    with pytest.raises(NothingMoves, match="no weight"):
        solved([replace(rectangle("block", 0, 0, 1, 4), mass=0.0)])
    assert issubclass(NothingMoves, AssemblyFault)


# --- mechanisms that share a multiplier ------------------------------------------------------------------------------


def tied(more=0.0):
    """A block whose slenderness is that of the whole: of width w below, lambda (m + M) w/2 over the moments is 1/4."""
    top = rectangle("top", -0.5, 1, 0.5, 5)
    # (w + 4) w/2 = (w/2 + 4 x 3)/4
    w = (-15 / 4 + np.sqrt((15 / 4) ** 2 + 24)) / 2
    return [rectangle("low", -w / 2 - more, 0, w / 2 + more, 1), top]


def test_a_tie_of_a_stack_is_seen():
    found = solved(tied())
    assert found.multiplier == approx(0.25, rel=1e-12)
    assert not found.unique
    assert {each.moves for each in found.several} == {("top",), ("low", "top")}
    for each in found.several:
        assert each.multiplier == approx(0.25, rel=1e-9)
    both = next(each for each in found.several if len(each.moves) == 2)
    assert both.velocity[0, 2] == approx(both.velocity[1, 2], rel=1e-10)  # each alone, no mixture of the two
    # A hair's difference ends it, on either side.
    assert solved(tied(1e-6)).unique
    assert np.abs(solved(tied(1e-6)).velocity[0]).max() == 0
    assert solved(tied(-1e-6)).unique
    assert np.abs(solved(tied(-1e-6)).velocity[0]).max() > 0.5


def test_a_force_that_is_small_beside_another_is_looked_for_alone():
    """g1 + 10 g2 = .001: the most of both counted together is all of g1, yet g2 can carry force too."""
    rates = np.array([[1.0, 0, 0], [10.0, 0, 0], [0, 1.0, 0], [0, 0, 1.0]])
    rays = Rays(csr_array(rates), csr_array(np.eye(4)), np.ones(4, bool), np.arange(4))
    kept = kept_rays(rays, np.array([-1e-3, 0, 0]), np.array([0, -1.0, 0]), np.zeros(3))
    assert kept.tolist() == [True, True, True, False]


@pytest.mark.parametrize("shift", [3.0, 3.1, np.pi])
def test_two_equal_towers_apart_are_two_mechanisms(shift):
    """Their multipliers differ by rounding, by which nothing may be decided."""
    found = solved([rectangle("one", 0.1, 0, 1.1, 3.7), rectangle("other", 0.1 + shift, 0, 1.1 + shift, 3.7)])
    assert not found.unique
    assert {each.moves for each in found.several} == {("one",), ("other",)}


def test_a_vertex_that_is_degenerate_is_still_one_mechanism():
    # A column of ten equal blocks: above the foot all joints are far from opening; below a beam, more forces than
    # equations.
    column = [rectangle(f"b{k}", 0, k, 1, k + 1) for k in range(10)]
    found = solved(column)
    assert found.unique
    assert found.multiplier == approx(0.1, rel=1e-12)
    beam = [*(rectangle(f"c{x}", x, 0, x + 1, 4) for x in (0, 3, 6)), rectangle("beam", 0, 4, 7, 5)]
    found = solved(beam)
    # Three columns that turn alike under a beam that keeps level: 3 M + m of weight, levers 1/2, and 1 of the beam.
    M, m = 4.0, 7.0
    assert found.multiplier == approx((3 * M / 2 + m) / (3 * M * 2 + m * 4), rel=1e-12)
    assert found.unique
    made = linkage(beam, contacts(beam, FLOOR), (), found)
    assert len(made.hinges) == 6  # one more than needed, which the motion satisfies


# --- the arch --------------------------------------------------------------------------------------------------------


def test_an_arch_of_polygons_converges_with_their_edges():
    exact = Voussoirs(BETA, T / R, 7).thrust()[0]
    for edges in (1, 4, 16, 64):
        off = solved(*ring(7, edges, exact=False)).multiplier - exact
        assert off * edges**2 == approx(0.0036, abs=5e-5)


def test_the_hinges_of_oppenheims_arch():
    blocks, joints, found = oppenheim()
    made = linkage(blocks, joints, (), found)
    assert made.groups == (("v1", "v2", "v3"), ("v4", "v5"), ("v6", "v7"))
    assert made.rest == ("left", "right")
    assert [(h.one, h.other) for h in made.hinges] == [(None, 0), (0, 1), (2, 1), (None, 2)]
    expected = Arch(radius=R, thickness=T, inclusion_angle_deg=157.5, voussoirs=7).hinges(POSITIVE)
    assert [h.point for h in made.hinges] == approx(list(expected), rel=1e-9)
    assert (made.lifted, made.slides) == ((), ())
    assert leading(made, POSITIVE) in (0, 2)
    # Groups have the same velocity where they hinge, and none on the ground.
    for h in made.hinges:
        first, second = (
            0j if k is None else complex(*made.velocity[k, :2]) + 1j * made.velocity[k, 2] * h.point
            for k in (h.one, h.other)
        )
        assert abs(first - second) < 1e-9
    # The link that rests on the ground and turns clockwise is that at the left springing, although another is faster.
    assert made.velocity[0, 2] < 0
    assert made.velocity[2, 2] < made.velocity[0, 2]
    assert leading(made, POSITIVE) == 2


def test_the_friction_that_oppenheims_arch_needs():
    blocks, joints, found = oppenheim()
    need = friction(found)
    assert need.needed == approx(0.50, abs=0.006)
    assert need.glued == ()
    # In the state shown no joint needs more.
    assert (np.abs(need.shear) <= need.needed * need.normal.sum(axis=1) * (1 + 1e-9) + 1e-9).all()
    assert unbalanced(blocks, joints, replace(found, normal=need.normal, shear=need.shear)) < 1e-9
    ground = ring(7)[1]
    assert solved(blocks, ground, friction=need.needed).multiplier == approx(found.multiplier, rel=1e-9)
    assert solved(blocks, ground, friction=need.needed - 1e-3).multiplier < found.multiplier * (1 - 1e-6)
    assert round(solved(blocks, ground, friction=0.35).multiplier, 3) == 0.207


def test_the_line_of_thrust_of_the_arch():
    blocks, joints, found = oppenheim()
    made = linkage(blocks, joints, (), found)
    line = thrust(joints, [block.name for block in blocks], found.normal, found.shear)
    assert line.chain
    assert len(line.passages) == 8
    angles = [np.angle(passage.point) for passage in line.passages]
    assert angles == sorted(angles, reverse=True)
    radii = np.abs([passage.point for passage in line.passages])
    assert radii.min() == approx(R - T / 2)
    assert radii.max() == approx(R + T / 2)
    touched = {h.contact: h.point for h in made.hinges}
    for passage in line.passages:
        if passage.contact in touched:
            assert passage.point == approx(touched[passage.contact])
    # The forces on one voussoir, moments about where the first passes.
    first, second = line.passages[:2]
    block = blocks[0]
    push = first.force - second.force * (1 if joints[second.contact].a == "v1" else -1)
    assert push == approx(-complex(found.multiplier, -1) * block.mass * g)


def test_forces_of_a_wall_are_no_line():
    bricks = [rectangle("a", 0, 0, 1, 1), rectangle("b", 1, 0, 2, 1), rectangle("c", 0.5, 1, 1.5, 2)]
    joints = contacts(bricks, FLOOR)
    found = collapse(bricks, joints)
    lines = thrust(joints, [b.name for b in bricks], found.normal, found.shear)
    assert not lines.chain
    tower = [rectangle("low", 0, 0, 1, 1), rectangle("top", 0, 1, 1, 2)]
    joints = contacts(tower, FLOOR)
    found = collapse(tower, joints)
    line = thrust(joints, ["low", "top"], found.normal, found.shear)
    assert line.chain
    assert [passage.force.imag for passage in line.passages] in (approx([g, 2 * g]), approx([2 * g, g]))


# --- states and supports ---------------------------------------------------------------------------------------------


def test_joints_that_carry_shear_without_a_normal_force_are_named():
    """A block hung between two towers on frictionless feet: no force presses it, only glue holds it."""
    blocks = [rectangle("left", 0, 0, 1, 4), rectangle("hung", 1, 2, 2, 3), rectangle("right", 2, 0, 3, 4)]
    joints = contacts(blocks, FLOOR, per_pair={("ground", "left"): 0.0, ("ground", "right"): 0.0})
    live = np.array([[0, 0, 0], [0, 0, 0], [0, 0, -g]])  # turns the right tower away
    found = collapse(blocks, joints, live=live)
    # Half of the hung weight of 1 acts on the tower's near face, its own weight of 4 in its middle.
    assert found.multiplier == approx(4 * 0.5 + 0.5 * 1, rel=1e-9)
    need = friction(found)
    assert need.needed is None
    assert {(joints[k].a, joints[k].b) for k in need.glued} == {("left", "hung"), ("hung", "right")}


def test_what_moves_by_chance_is_one_of_several():
    """Towers on frictionless feet that a moment turns: all can slide both ways at no cost."""
    tower = [rectangle("tower", 0, 0, 1, 4)]
    joints = contacts(tower, FLOOR, friction=0.0)
    found = collapse(tower, joints, live=np.array([[0, 0, -g]]))
    assert found.multiplier == approx(4 * 0.5, rel=1e-9)
    assert found.kinematic == approx(found.multiplier, rel=1e-9)
    assert not found.unique
    turns, slides = found.several
    assert turns.multiplier == approx(2.0, rel=1e-9)
    assert np.isnan(slides.multiplier)
    assert np.abs(slides.velocity) == approx(np.array([[1.0, 0, 0]]), abs=1e-9)


@pytest.mark.parametrize("unit", [1e-9, 1.0, 1e9])
def test_the_unit_of_the_live_forces_decides_nothing(unit):
    tower = [rectangle("tower", 0, 0, 1, 4)]
    live = np.array([[unit, 0, 0]])
    found = collapse(tower, contacts(tower, FLOOR), live=live)
    assert found.multiplier == approx(g / unit, rel=1e-9)
    assert found.kinematic == approx(g / unit, rel=1e-9)
    assert friction(found).needed == approx(0.25, rel=1e-5)
    with pytest.raises(NothingMoves, match="always there"):
        collapse(tower, contacts(tower, FLOOR), live=0 * live)


@pytest.mark.parametrize("k", [0.5, 1.0])
def test_a_wall_held_at_its_top_has_the_weakest_hinge_of_its_formula(k):
    """lambda h/t = 2 (1 + rho (1 + k xi/(1 - xi)))/xi at the courses' joints: 9 at 2/3 for k = 1/2, rho = 1."""
    t, h, n, rho = 0.3, 3.0, 30, 1.0
    courses = [rectangle(f"c{i}", 0, h * i / n, t, h * (i + 1) / n) for i in range(n)]
    dead, live = weights(courses)
    load = rho * dead[:, 1].sum()
    # The hinge of the upper body is on the left face; the load at k t from there, held where it acts.
    top = complex(k * t, h)
    dead[-1] += [0, load, load * (top - courses[-1].centroid).real]
    guide = Guide("floor", ("c29",), top, 1j)
    joints = contacts(courses, FLOOR)
    found = collapse(courses, joints, [guide], dead=dead, live=live)
    xi = np.arange(1, n) / n
    formula = 2 * t / (xi * h) * (1 + rho * (1 + k * xi / (1 - xi)))
    assert found.multiplier == approx(formula.min(), rel=1e-10)
    made = linkage(courses, joints, [guide], found)
    assert made.guides == (guide,)
    assert len(made.groups[0]) == formula.argmin() + 1
    assert [h.point.real for h in sorted(made.hinges, key=lambda h: h.point.imag)] == approx([t, 0.0], abs=1e-9)
    assert leading(made, POSITIVE) == 0


def test_three_groups_about_one_point_are_two_hinges():
    names = [AssemblyBlock(name, (0j, 1 + 0j, 1j), 1.0, 1 + 1j) for name in "abc"]
    joints = [
        AssemblyContact("a", "b", 0j, 1 + 0j, 1j),
        AssemblyContact("b", "c", -1 + 0j, 0j, 1j),
        AssemblyContact("a", "c", 0j, 1j, -1 + 0j),
    ]
    turning = np.array([[1.0, -1.0, 1.0], [2.0, -2.0, 2.0], [-1.0, 1.0, -1.0]])  # all about the origin
    any_state = solved([rectangle("block", 0, 0, 1, 4)])
    fields = replace(any_state, velocity=turning, opening=np.array([[0, 1.0], [1.0, 0], [0, 1.0]]), sliding=np.zeros(3))
    made = linkage(names, joints, (), fields)
    assert len(made.groups) == 3
    assert len(made.hinges) == 2
    # Two joints of the same two groups at one point are one hinge.
    pair = linkage(names, joints, (), replace(fields, velocity=turning[[0, 0, 1]], opening=np.array([[0, 0], [1.0, 0],
                   [0, 1.0]])))  # fmt: skip
    assert pair.groups == (("a", "b"), ("c",))
    assert len(pair.hinges) == 1


def test_what_leads_is_on_the_ground_and_turns_the_right_way():
    hinges = (
        AssemblyHinge(None, 0, 0j, 0),
        AssemblyHinge(0, 1, 1j, 1),
        AssemblyHinge(None, 2, 1 + 0j, 2),
        AssemblyHinge(3, None, 2 + 0j, 3),
    )

    def lead(*turns, direction=POSITIVE):
        velocity = np.column_stack([np.zeros((4, 2)), turns])
        return leading(
            AssemblyLinkage((("a",), ("b",), ("c",), ("d",)), ("ground",), velocity, hinges, (), ()), direction
        )

    assert lead(-0.5, -1.0, -0.7, 0.9) == 2  # not the faster one aloft, nor the one that turns back
    assert lead(-0.5, -1.0, -0.7, 0.9, direction=NEGATIVE) == 3
    assert lead(0.3, -1.0, 0.7, 0.9) == 3
    assert lead(-0.7, 0.0, -0.7 * (1 + 1e-12), 0.0) == 0
    assert lead(0.0, -1.0, 0.0, 0.0) == 1
    assert lead(0.0, 0.0, 0.0, 0.0) is None


# --- random assemblies -----------------------------------------------------------------------------------------------


def cut(rng, x0, y0, x1, y1, depth):
    """A rectangle cut into rectangles."""
    if depth == 0:
        return [(x0, y0, x1, y1)]
    share = 0.5 if rng.random() < 0.5 else rng.uniform(0.3, 0.7)
    if rng.random() < (y1 - y0) / (x1 - x0 + y1 - y0):
        y = y0 + share * (y1 - y0)
        return cut(rng, x0, y0, x1, y, depth - 1) + cut(rng, x0, y, x1, y1, depth - 1)
    x = x0 + share * (x1 - x0)
    return cut(rng, x0, y0, x, y1, depth - 1) + cut(rng, x, y0, x1, y1, depth - 1)


def jumble(seed):
    """A leaning wall of random bricks."""
    rng = np.random.default_rng(seed)
    lean = rng.uniform(-0.1, 0.1)
    blocks = []
    for k, box in enumerate(cut(rng, 0, 0, rng.uniform(1, 3), rng.uniform(2, 6), int(rng.integers(1, 5)))):
        plain = rectangle(f"b{k}", *box, density=rng.uniform(0.5, 2))
        corners = tuple(z + lean * z.imag for z in plain.corners)
        blocks.append(replace(plain, corners=corners, centroid=sum(corners) / 4))
    joints = contacts(blocks, FLOOR)
    mu = [None, 0.0, 0.6, 1.5][int(rng.integers(4))]
    joints = [replace(c, friction=None if c.a == "ground" else mu) for c in joints]
    return blocks, joints, [POSITIVE, NEGATIVE][int(rng.integers(2))]


def greatest(blocks, joints, direction):
    """The static theorem once more, written out in N1, N2 and T with the solver's interior points."""
    n, number = len(joints), {block.name: k for k, block in enumerate(blocks)}
    A, dead, live = np.zeros((3 * len(blocks), 3 * n)), np.zeros(3 * len(blocks)), np.zeros(3 * len(blocks))
    upper, bounds = [], []
    for k, joint in enumerate(joints):
        along = (joint.end - joint.start) / abs(joint.end - joint.start)
        for column, (point, force) in enumerate(
            [(joint.start, joint.normal), (joint.end, joint.normal), (joint.start, along)]
        ):
            for name, sign in ((joint.b, 1), (joint.a, -1)):
                if name in number:
                    i, arm = number[name], point - blocks[number[name]].centroid
                    moment = arm.real * force.imag - arm.imag * force.real
                    A[3 * i : 3 * i + 3, 3 * k + column] = np.array([force.real, force.imag, moment]) * sign
        bounds += [(0, None), (0, None), (None, None)]
        if joint.friction is not None:
            for sign in (1, -1):
                row = np.zeros(3 * n + 1)
                row[3 * k : 3 * k + 3] = -joint.friction, -joint.friction, sign
                upper.append(row)
    for i, block in enumerate(blocks):
        dead[3 * i + 1], live[3 * i] = -block.mass, direction * block.mass
    found = linprog(
        np.append(np.zeros(3 * n), -1), A_ub=np.array(upper) if upper else None,
        b_ub=np.zeros(len(upper)) if upper else None, A_eq=np.column_stack([A, live]), b_eq=-dead,
        bounds=[*bounds, (0, None)], method="highs-ipm",
    )  # fmt: skip
    return found.x[-1]


def test_both_theorems_agree_on_random_assemblies():
    answered = 0
    for seed in range(20):
        blocks, joints, direction = jumble(seed)
        try:
            found = collapse(blocks, joints, (), direction)
        except DoesNotStand:
            continue
        answered += 1
        assert found.kinematic == approx(found.multiplier, rel=1e-9), seed
        assert found.multiplier == approx(greatest(blocks, joints, direction), rel=1e-6), seed
        assert unbalanced(blocks, joints, found, direction) < 1e-9, seed
        assert found.opening.min() >= -1e-9, seed
        for each in found.several:
            assert each.multiplier == approx(found.multiplier, rel=1e-8), seed
        made = linkage(blocks, joints, (), found)
        # Velocities are those of rigid blocks that keep the joints which are said to stay closed.
        number = {block.name: k for k, block in enumerate(blocks)}
        for joint, state, opening, sliding in zip(joints, made.states, found.opening, found.sliding, strict=True):
            for end, point in enumerate(joint.ends):
                apart = 0j
                for name, sign in ((joint.b, 1), (joint.a, -1)):
                    if name in number:
                        vx, vy, omega = found.velocity[number[name]]
                        apart += sign * (complex(vx, vy) + 1j * omega * (point - blocks[number[name]].centroid))
                rate = apart * joint.normal.conjugate()
                assert rate.real == approx(opening[end], abs=1e-9)
                assert -rate.imag == approx(sliding, abs=1e-9)  # the way from start to end is -i times the normal
                if state is Opening.CLOSED:
                    assert abs(apart) < 1e-7
    assert answered > 12


def test_neither_scale_nor_mirror_nor_order_changes_anything():
    for seed in (0, 3, 4):
        blocks, joints, direction = jumble(seed)
        found = collapse(blocks, joints, (), direction)
        small = [replace(b, corners=tuple(1e-3 * z for z in b.corners), centroid=1e-3 * b.centroid, mass=1e6 * b.mass)
                 for b in blocks]  # fmt: skip
        shrunk = [replace(c, start=1e-3 * c.start, end=1e-3 * c.end) for c in joints]
        again = collapse(small, shrunk, (), direction)
        assert again.multiplier == approx(found.multiplier, rel=1e-10)
        assert linkage(small, shrunk, (), again).states == linkage(blocks, joints, (), found).states
        mirrored = [replace(b, corners=tuple(-z.conjugate() for z in b.corners), centroid=-b.centroid.conjugate())
                    for b in blocks]  # fmt: skip
        mirror = [replace(c, start=-c.end.conjugate(), end=-c.start.conjugate(), normal=-c.normal.conjugate())
                  for c in joints]  # fmt: skip
        assert collapse(mirrored, mirror, (), direction.opposite).multiplier == approx(found.multiplier, rel=1e-10)
        backwards = collapse(blocks[::-1], joints[::-1], (), direction)
        assert backwards.multiplier == approx(found.multiplier, rel=1e-10)
        assert backwards.unique == found.unique


# --- displaced -------------------------------------------------------------------------------------------------------


def displaced(blocks, joints, guides, states, moved, weight):
    """What is left of an assembly whose blocks have moved to places and by angles, by their names."""
    places = [moved.get(block.name, (block.centroid, 0.0)) for block in blocks]
    centroids, turned = (np.array(each) for each in zip(*places, strict=True))
    return DisplacedAssembly(remaining(blocks, joints, guides, states).moved(centroids, np.exp(1j * turned)), weight)


def multiplier(place, dead, live):
    """The multiplier of `live` in displaced equilibrium, by virtual work."""
    (free,) = np.linalg.qr(velocity_space(place.bearings.rates, place.frame))[0].T
    work = [float(scaled(forces, place.frame, place.weight) @ free) for forces in (dead, live)]
    return -work[0] / work[1]


def displaced_arch(phi):
    blocks, joints, found = oppenheim()
    made = linkage(blocks, joints, (), found)
    hinges = Arch(radius=R, thickness=T, inclusion_angle_deg=157.5, voussoirs=7).hinges(POSITIVE)
    moved = {}
    for group, link in zip(made.groups, four_bar(np.array([phi]), POSITIVE, *hinges), strict=True):
        for name in group:
            centroid = next(block.centroid for block in blocks if block.name == name)
            moved[name] = complex(link.carry(centroid)[0][0]), float(link.psi[0])
    return displaced(blocks, joints, (), made.states, moved, sum(b.mass for b in blocks) * g)


def held(phi):
    place = displaced_arch(phi)
    dead, live = weights(ring(7)[0])
    return place.admissible(dead + multiplier(place, dead, live) * live)[0]


def test_the_multiplier_that_holds_the_arch_displaced_is_that_of_its_coefficients():
    arch = Arch(radius=R, thickness=T, inclusion_angle_deg=157.5, voussoirs=7)
    for phi in (0.0, 0.01, 0.03, 0.069):
        at = arch.coefficients(np.array([phi]), POSITIVE)
        found = multiplier(displaced_arch(phi), *weights(ring(7)[0]))
        assert found == approx(float(at.G[0] / at.B[0]), rel=1e-9)


def test_oppenheims_arch_is_valid_to_028_of_069():
    assert held(0.0).holds
    end = 0.0690647
    valid = first_violation(lambda phi: held(phi).margin, np.linspace(0, end, 33))
    assert valid == approx(0.028, abs=5e-4)
    assert first_violation(lambda phi: held(phi).margin, np.linspace(0, 0.02, 33)) is None
    assert abs(held(valid).margin) < 1e-8
    beyond = held(valid + 1e-3)
    assert not beyond.holds
    joint = oppenheim()[1][beyond.contact]
    assert (joint.a, joint.b) in {("v1", "v2"), ("v2", "v1")}  # another joint than those that hinge


def test_forces_of_a_block_that_rocks_by_hand():
    """Block 1 x 5 m at (phi, phi., u''/g) = (.1, -.25, .1): H/W = -.04529637, N/W = .96947789."""
    block = rectangle("block", -0.5, 0, 0.5, 5)
    joints = contacts([block], FLOOR)
    made = linkage([block], joints, (), collapse([block], joints))

    def case(phi, speed, ground):
        arm = np.exp(-1j * phi) * (-0.5 + 2.5j)  # from the toe at .5
        inertia = 26 / 12
        # Moments about the toe of the weight and of -u'' turn it by psi, anticlockwise.
        turning = (-arm.real * g + arm.imag * ground * g) / (inertia + abs(arm) ** 2)
        acceleration = 1j * turning * arm - speed**2 * arm + ground * g
        forces = np.array([-acceleration.real, -g - acceleration.imag, -inertia * turning]) * block.mass
        return 0.5 + arm, -phi, forces, acceleration

    q, psi, forces, a = case(0.1, -0.25, 0.1)
    place = displaced([block], joints, (), made.states, {"block": (q, psi)}, block.mass * g)
    assert 1 + a.imag / g == approx(0.96947789, abs=1e-8)
    (answer,) = place.admissible(forces)
    assert answer.margin == approx(0.96947789, abs=1e-8)
    for mu, holds in ((0.3, True), (0.04, False), (0.05, True)):  # |H|/N is .0467
        rough = [replace(joints[0], friction=mu)]
        (answer,) = displaced([block], rough, (), made.states, {"block": (q, psi)}, block.mass * g).admissible(forces)
        assert answer.holds is holds
    # Thrown up faster than gravity pulls, it lifts off; several cases at once.
    up = forces.copy()
    up[1] += 2 * block.mass * g
    with pytest.raises(NoAnswer, match="off their balance"):
        place.admissible(up)
    flung = -forces
    answers = place.admissible(np.array([[forces], [flung]]))
    assert [each.holds for each in answers] == [True, False]
    assert answers[1].contact == 0


def test_a_closed_joint_of_a_displaced_column_opens_by_its_own_moment():
    """The upper half of a rocking column: its joint opens where its resultant passes the edge, by hand."""
    low, top = rectangle("low", 0, 0, 1, 2), rectangle("top", 0, 2, 1, 4)
    blocks = [low, top]
    joints = contacts(blocks, FLOOR)
    made = linkage(blocks, joints, (), collapse(blocks, joints))
    phi = 0.1
    turn = np.exp(-1j * phi)
    moved = {b.name: (1 + turn * (b.centroid - 1), -phi) for b in blocks}
    place = displaced(blocks, joints, (), made.states, moved, 8 * g)

    def forces(push):
        """Weights, a couple on the top block, and on the lower one whatever couple keeps the whole in balance."""
        f = np.array([[0.0, -2 * g, 0.0], [0.0, -2 * g, push]])
        f[0, 2] = -push - sum((moved[b.name][0].real - 1) * -2 * g for b in blocks)
        return f

    # The joint's normals, at its ends at (0, 2) and (1, 2) in the block's own axes: moments of the top block's weight
    # 2 g cos(phi) down and 2 g sin(phi) along, at height 1, and the couple.
    for push in (0.0, 0.5 * g, 1.2 * g, -0.6 * g):
        down, along = 2 * g * np.cos(phi), 2 * g * np.sin(phi)
        right = down / 2 + along - push  # about the left end: N_right 1 = down .5 + along 1 - push
        left = down - right
        (answer,) = place.admissible(forces(push))
        assert answer.holds == (min(left, right) >= 0), push
        least = min(left, right, 4 * g) / (8 * g)
        assert answer.margin == approx(least, rel=1e-9), push
        if not answer.holds:
            assert {joints[answer.contact].a, joints[answer.contact].b} == {"low", "top"}


def test_three_columns_under_a_beam_share_its_weight_as_well_as_can_be():
    """Forces that statics does not determine: tops a, b, c with a + b + c = P and 3 (c - a) = P (1 + lambda)/2 + C."""
    columns = [rectangle(f"c{x}", x, 0, x + 1, 4) for x in (0, 3, 6)]
    beam = rectangle("beam", -0.5, 4, 7.5, 5)
    blocks = [*columns, beam]
    joints = contacts(blocks, FLOOR)
    made = linkage(blocks, joints, (), collapse(blocks, joints))
    dead, live = weights(blocks)
    P, W = beam.mass * g, sum(b.mass for b in blocks) * g
    for phi in (0.0, 0.05):
        turn = np.exp(-1j * phi)
        half, whole = turn * (-0.5 + 2j), turn * (-1 + 4j)  # from the toe to the centroid and to where the beam bears
        moved = {c.name: (c.centroid + 0.5 - 2j + half, -phi) for c in columns}
        moved["beam"] = (beam.centroid + whole - (-1 + 4j), 0.0)
        place = displaced(blocks, joints, (), made.states, moved, W)
        lam = -(12 * half.real + 8 * whole.real) / (12 * half.imag + 8 * whole.imag)
        assert multiplier(place, dead, live) == approx(lam, rel=1e-12)
        forces = dead + lam * live
        for couple in (0.0, P, 4 * P):
            forces[-1, 2] = couple
            (answer,) = place.admissible(forces)
            least = (P - (P * (1 + lam) / 2 - couple) / 3) / 3
            other = (P + (P * (1 + lam) / 2 - couple) / 3) / 3
            assert answer.margin == approx(min(least, other) / W, rel=1e-9)
            assert answer.holds == (min(least, other) >= 0)
            if not answer.holds:
                assert {joints[answer.contact].a, joints[answer.contact].b} == {"c0" if least < other else "c6", "beam"}


def test_a_joint_that_is_lifted_bears_no_more():
    blocks = [rectangle("left", 0, 0, 1, 4), rectangle("right", 1, 0, 2, 4)]
    joints = contacts(blocks, FLOOR)
    made = linkage(blocks, joints, (), collapse(blocks, joints))
    assert [joints[k].b for k in made.lifted] == ["left"]
    phi = 0.1
    moved = {b.name: (2 + np.exp(-1j * phi) * (b.centroid - 2), -phi) for b in blocks}
    place = displaced(blocks, joints, (), made.states, moved, 8 * g)
    assert multiplier(place, *weights(blocks)) == approx(np.tan(np.arctan(0.5) - phi), rel=1e-12)


def test_a_wall_held_at_its_top_stays_held_when_displaced():
    low, top = rectangle("low", 0, 0, 0.3, 2), rectangle("top", 0, 2, 0.3, 3)
    blocks, guide = [low, top], Guide("floor", ("top",), 0.15 + 3j, 1j)
    joints = contacts(blocks, FLOOR)
    made = linkage(blocks, joints, [guide], collapse(blocks, joints, [guide]))

    def places(phi):
        B = 0.3 + np.exp(-1j * phi) * (2j - 0.3)
        arm = 0.15 + 1j  # from the hinge to the top, which stays above .15
        psi = np.arccos((0.15 - B.real) / abs(arm)) - np.angle(arm)
        return {"low": (0.3 + np.exp(-1j * phi) * (low.centroid - 0.3), -phi),
                "top": (B + np.exp(1j * psi) * (top.centroid - 2j), psi)}  # fmt: skip

    for phi in (1e-3, 0.02, 0.05):
        place = displaced(blocks, joints, [guide], made.states, places(phi), 0.9 * g)
        step = 1e-5
        before, after = places(phi - step), places(phi + step)
        work = sum(block.mass * (after[block.name][0] - before[block.name][0]) for block in blocks)
        assert multiplier(place, *weights(blocks)) == approx(work.imag / work.real, rel=1e-6)


def test_parts_on_one_line_that_bear_opposite_ways_are_two_joints():
    """A body stands on a pedestal, and its foot reaches under an arm of the ground on the line of its base."""
    corners = ((0, 0), (5, 0), (5, 2), (2, 2), (2, 1), (4, 1), (4, 0.3), (1, 0.3), (1, 1), (0, 1))
    pedestal = AssemblyBlock("pedestal", tuple(complex(*corner) for corner in corners))
    corners = ((0, 1), (1.1, 1), (1.1, 0.6), (3, 0.6), (3, 1), (1.5, 1), (1.5, 2), (0, 2))
    hook = AssemblyBlock("hook", tuple(complex(*corner) for corner in corners), 2.0, 1.0 + 1.3j)
    on, under = sorted(contacts([hook], [pedestal]), key=lambda joint: joint.start.real)
    for joint, ends, normal in ((on, {0, 1}, 1j), (under, {2, 3}, -1j)):
        assert {round(end.real, 9) for end in joint.ends} == ends
        assert {end.imag for end in joint.ends} == {1.0}
        assert (joint.a, joint.b, joint.normal) == ("pedestal", "hook", approx(normal))

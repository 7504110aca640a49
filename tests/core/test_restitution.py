"""Restitution from kinematics against impulses: momentum balances of rigid bodies with unknown contact impulses.

Just before an impact that ends motion in the direction s the rate of phi is -1, so the velocities are minus the field
of s; just after it they are eta times the field of -s. The new hinges are points, so each carries an impulse with two
components and no moment. Solving the balances gives eta and every impulse at once.
"""

from itertools import pairwise
from math import atan, cos, radians, sin

import numpy as np
import pytest
from pytest import approx

from mechanisms.arch import Arch
from mechanisms.asymmetric_frame import AsymmetricFrame
from mechanisms.block import Block
from mechanisms.cone import Cone
from mechanisms.point_mass import PointMass
from mechanisms.rigid_body import RigidBody
from mechanisms.symmetric_frame import SymmetricFrame
from mechanisms.wall import Wall
from rocking_cli.core import Direction, equivalent_block
from rocking_cli.core.mechanism import why_none
from rocking_cli.core.structure_fields import DirectionalRestitution
from rocking_cli.core.structure_file import load_structure, parse_structure
from rocking_cli.errors import InputError
from rocking_cli.structure import Structure
from rocking_cli.views.cautions import cautions_of
from rocking_cli.views.restitution import restitution_sentences, restitution_used
from rocking_cli.views.view import Aside
from tests.cli.test_cli import run, run_json
from tests.reference_mechanics import cross, link_rates, polygon_moments, sector_moments

BOTH = list(Direction)
POSITIVE, NEGATIVE = Direction.POSITIVE, Direction.NEGATIVE


def turning(pivot, spin, drift=0.0):
    """Velocity field (velocity at a point, spin) of a body that turns about a pivot which moves with `drift`."""
    return lambda z: drift + 1j * spin * (z - pivot), spin


def momentum(mass, inertia, centroid, field):
    """Linear momentum (x, y) and angular momentum about the origin."""
    velocity, spin = field[0](centroid), field[1]
    return np.array([
        mass * velocity.real, mass * velocity.imag, mass * cross(centroid, velocity) + inertia * spin
    ])  # fmt: skip


def eta_by_impulses(before, after, contacts):
    """Solve the balances of every body for eta and the impulses.

    `before` and `after` hold a momentum for each body, the first with the true sign, the second for a rate 1 of phi.
    A contact is (point, body it acts on, body it reacts on or None, "xy" or "x").
    """
    n = len(before)
    columns = [-np.concatenate(after)]
    for point, one, other, axes in contacts:
        for axis in axes:
            push = 1.0 if axis == "x" else 1j
            column = np.zeros(3 * n)
            column[3 * one : 3 * one + 3] = push.real, push.imag, cross(point, push)
            if other is not None:
                column[3 * other : 3 * other + 3] = -column[3 * one : 3 * one + 3]
            columns.append(column)
    matrix = np.array(columns).T
    assert matrix.shape == (3 * n, 3 * n)
    return np.linalg.solve(matrix, -np.concatenate(before))[0]


def single(mass, inertia, centroid, feet, s):
    """eta of one body on two feet (left, right) at the end of motion in the direction s."""
    old, new = (feet[1], feet[0]) if s > 0 else (feet[0], feet[1])
    # Clockwise is a spin of -s for a rate 1 of phi; before the impact phi falls.
    before = momentum(mass, inertia, centroid, turning(old, s))
    after = momentum(mass, inertia, centroid, turning(new, s))
    return eta_by_impulses([before], [after], [(new, 0, None, "xy")])


@pytest.mark.parametrize(("width", "height"), [(0.7, 2.8), (1.0, 12.0), (2.0, 1.5), (3.0, 1.0)])
def test_block_is_housners_and_that_of_impulses(width, height):
    alpha = atan(width / height)
    block = Block(width=width, height=height)
    inertia = (width**2 + height**2) / 12
    feet = complex(-width / 2, 0), complex(width / 2, 0)
    for direction in BOTH:
        eta = block.restitution_from_kinematics(direction)
        assert eta == approx(1 - 1.5 * sin(alpha) ** 2, rel=1e-12, abs=1e-14)
        assert eta == approx(single(1.0, inertia, 0.5j * height, feet, int(direction)), rel=1e-12, abs=1e-13)


def test_point_mass_cone_and_any_body_are_those_of_impulses():
    for mechanism, inertia, width, height in (
        (PointMass(base_width=1.2, height=4.0), 0.0, 1.2, 4.0),
        (Cone(base_radius=1.5, height=12.0, kind="shell"), 12.0**2 / 18 + 1.5**2 / 4, 3.0, 4.0),
        (Cone(base_radius=1.5, height=12.0, kind="solid"), 3 * 12.0**2 / 80 + 3 * 1.5**2 / 20, 3.0, 3.0),
        (
            RigidBody(R=2.0, alpha_deg=20.0, inertia_ratio=1.3), 0.3 * 4,
            4 * sin(radians(20)), 2 * cos(radians(20)),
        ),
    ):  # fmt: skip
        feet = complex(-width / 2, 0), complex(width / 2, 0)
        expected = single(1.0, inertia, complex(0, height), feet, 1)
        assert mechanism.restitution_from_kinematics(POSITIVE) == approx(expected, rel=1e-11)
        assert equivalent_block(mechanism).negative.eta == approx(expected, rel=1e-11)


def test_leaning_polygon_is_that_of_impulses_in_each_direction():
    corners = [0.0, 1.0, 1.3 + 2.0j, 0.9 + 3.0j, 0.4 + 2.2j]
    area, centroid, inertia = polygon_moments(corners)
    body = RigidBody(polygon=[[complex(z).real, complex(z).imag] for z in corners])
    values = []
    for direction in BOTH:
        expected = single(area, inertia, centroid, (0.0 + 0j, 1.0 + 0j), int(direction))
        assert body.restitution_from_kinematics(direction) == approx(expected, rel=1e-11)
        values.append(expected)
    assert abs(values[0] - values[1]) > 1e-2


def frame_fields(b, H, H1, L, s):
    """Rest velocity fields of the left column, the beam and the right column for a rate 1 of phi, and the hinges."""
    hinges = complex(s * b, 0), complex(-s * b, 2 * H), complex(L - s * b, 2 * H), complex(L + s * b, 2 * H - 2 * H1)
    a, b_, _, d = hinges
    beam, right = link_rates(*hinges, -s)
    return [turning(a, -s), turning(b_, beam, -1j * s * (b_ - a)), turning(d, right)], hinges


def frame_eta(b, H, H1, L, h, masses, s):
    sizes = [(2 * b, 2 * H), (L + 2 * b, 2 * h), (2 * b, 2 * H1)]
    centroids = [complex(0, H), complex(L / 2, 2 * H + h), complex(L, 2 * H - H1)]
    inertias = [m * (x**2 + y**2) / 12 for m, (x, y) in zip(masses, sizes, strict=True)]
    old, _ = frame_fields(b, H, H1, L, s)
    new, hinges = frame_fields(b, H, H1, L, -s)
    before = [-momentum(*body) for body in zip(masses, inertias, centroids, old, strict=True)]
    after = [momentum(*body) for body in zip(masses, inertias, centroids, new, strict=True)]
    a, b_, c, d = hinges
    return eta_by_impulses(before, after, [(a, 0, None, "xy"), (b_, 1, 0, "xy"), (c, 1, 2, "xy"), (d, 2, None, "xy")])


@pytest.mark.parametrize(("width", "height", "gamma"), [(1.0, 6.0, 2.0), (1.5, 4.0, 0.3), (0.4, 9.0, 25.0)])
def test_symmetric_frame_is_table_i_and_that_of_impulses(width, height, gamma):
    alpha = atan(width / height)
    frame = SymmetricFrame(column_width=width, column_height=height, mass_ratio=gamma)
    eta = frame.restitution_from_kinematics(POSITIVE)
    assert eta == approx((1 - 1.5 * sin(alpha) ** 2 + 3 * gamma * cos(2 * alpha)) / (1 + 3 * gamma), rel=1e-12)
    impulses = frame_eta(width / 2, height / 2, height / 2, 5 * width, 0.4, (1.0, 2 * gamma, 1.0), 1)
    assert eta == approx(impulses, rel=1e-11)
    assert frame.restitution_from_kinematics(NEGATIVE) == approx(impulses, rel=1e-11)


@pytest.mark.every(5)
@pytest.mark.parametrize("case", range(4))
@pytest.mark.parametrize("direction", BOTH)
def test_asymmetric_frame_is_that_of_impulses(case, direction):
    rng = np.random.default_rng(5000 + case)
    width, left = rng.uniform(0.3, 1.5), rng.uniform(3.0, 12.0)
    right, spacing, depth = left * rng.uniform(0.6, 1.6), width * rng.uniform(1.3, 10.0), rng.uniform(0.1, 2.5)
    masses = tuple(rng.uniform(0.1, 5.0, 3))
    frame = AsymmetricFrame(
        column_width=width, left_height=left, right_height=right, spacing=spacing, beam_depth=depth,
        left_mass=masses[0], beam_mass=masses[1], right_mass=masses[2],
    )  # fmt: skip
    expected = frame_eta(width / 2, left / 2, right / 2, spacing, depth / 2, masses, int(direction))
    assert frame.restitution_from_kinematics(direction) == approx(expected, rel=1e-10, abs=1e-12)
    assert equivalent_block(frame)[direction].eta == approx(expected, rel=1e-10, abs=1e-12)


def wall_fields(b, h, s):
    """Lower and upper block; the wall's foot hinge and top are on one face, its mid hinge on the other.

    The top goes straight up or down above the foot hinge: the upper block's centre of rotation is level with the top
    and on the line of the foot and mid hinges.
    """
    foot, middle, top = complex(s * b, 0), complex(-s * b, 2 * h), complex(s * b, 4 * h)
    centre = foot + (middle - foot) * 2  # at the height 4h
    assert centre.imag == approx(top.imag)
    return [turning(foot, -s), turning(centre, s)], (foot, middle, top)


@pytest.mark.parametrize(("thickness", "height"), [(0.3, 3.0), (0.1, 4.0), (0.6, 2.0)])
@pytest.mark.parametrize("direction", BOTH)
def test_wall_is_that_of_impulses(thickness, height, direction):
    b, h, s = thickness / 2, height / 4, int(direction)
    inertia = ((2 * b) ** 2 + (2 * h) ** 2) / 12
    old, _ = wall_fields(b, h, s)
    new, (foot, middle, top) = wall_fields(b, h, -s)
    before = [-momentum(1.0, inertia, z, field) for z, field in zip((1j * h, 3j * h), old, strict=True)]
    after = [momentum(1.0, inertia, z, field) for z, field in zip((1j * h, 3j * h), new, strict=True)]
    # The support at the top only pushes sideways.
    contacts = [(foot, 0, None, "xy"), (middle, 1, 0, "xy"), (top, 1, None, "x")]
    expected = eta_by_impulses(before, after, contacts)
    wall = Wall(thickness=thickness, height=height)
    assert wall.restitution_from_kinematics(direction) == approx(expected, rel=1e-11)


def arch_parts(angles, beta, inner, outer, s):
    """Edges (rising polar angles) and rest velocity fields of the three links for a rate 1 of phi, and the hinges.

    The mirror image of a velocity field turns x and the spins about; phi keeps its rate.
    """
    polar = [np.pi / 2 + s * (beta / 2 - angle) for angle in angles]
    a, b, c, d = (r * np.exp(1j * x) for r, x in zip((inner, outer) * 2, polar, strict=True))
    two, three = link_rates(a, b, c, d, -s)
    fields = [turning(a, -s), turning(b, two, -1j * s * (b - a)), turning(d, three)]
    edges = [tuple(sorted(pair)) for pair in pairwise(polar)]
    return edges, fields, (a, b, c, d)


def arch_eta(angles, beta, ratio, s):
    """The new links stick together at once: each takes over the momentum that its material had in the old mechanism."""
    inner, outer = 1 - ratio / 2, 1 + ratio / 2
    old_edges, old_fields, _ = arch_parts(angles, beta, inner, outer, s)
    new_edges, new_fields, (a, b, c, d) = arch_parts(angles, beta, inner, outer, -s)

    def carried(start, end, field):
        mass, first, polar = sector_moments(inner, outer, start, end)
        centroid = first / mass
        return momentum(mass, polar - mass * abs(centroid) ** 2, centroid, field)

    before = []
    for start, end in new_edges:
        total = np.zeros(3)
        for (low, high), field in zip(old_edges, old_fields, strict=True):
            if max(start, low) < min(end, high):
                total -= carried(max(start, low), min(end, high), field)
        before.append(total)
    after = [carried(*edge, field) for edge, field in zip(new_edges, new_fields, strict=True)]
    return eta_by_impulses(before, after, [(a, 0, None, "xy"), (b, 1, 0, "xy"), (c, 1, 2, "xy"), (d, 2, None, "xy")])


@pytest.mark.parametrize(
    ("beta", "ratio", "n"),
    [
        (157.5, 0.15, 7), (157.5, 0.15, None), (120.0, 0.12, 12), (120.0, 0.12, None), (180.0, 0.115, None),
        (90.0, 0.08, 40), (140.0, 0.35, None), (60.0, 0.05, 20), (150.0, 0.2, 8),
    ],
)  # fmt: skip
@pytest.mark.parametrize("direction", BOTH)
def test_arch_is_that_of_impulses(beta, ratio, n, direction):
    arch = Arch(radius=10.0, thickness=10 * ratio, inclusion_angle_deg=beta, voussoirs=n)
    expected = arch_eta(arch.hinge_angles, np.radians(beta), ratio, int(direction))
    assert arch.restitution_from_kinematics(direction) == approx(expected, rel=1e-9, abs=1e-11)


# --- what a restitution may do ---------------------------------------------------------------------------------------


def every_mechanism():
    rng = np.random.default_rng(6000)
    for _ in range(8):
        x, y = rng.uniform(0.3, 3.0), rng.uniform(1.0, 9.0)
        yield Block(width=x, height=y)
        yield PointMass(base_width=x, height=y)
        yield Cone(base_radius=x, height=y, kind="solid")
        yield RigidBody(R=x, alpha_deg=rng.uniform(2, 85), inertia_ratio=rng.uniform(1, 3))
        yield RigidBody(polygon=[[0.0, 0.0], [x, 0.0], [x * rng.uniform(0.6, 1.2), y], [x * rng.uniform(0.0, 0.3), y]])
        yield SymmetricFrame(column_width=x, column_height=y, mass_ratio=rng.uniform(0, 10))
        yield Wall(thickness=x, height=4 * y)
        yield AsymmetricFrame(
            column_width=x, left_height=3 * x + y, right_height=3 * x + y * rng.uniform(0.7, 1.4),
            spacing=x * rng.uniform(1.2, 6.0), beam_depth=rng.uniform(0.1, 2.0),
            left_mass=rng.uniform(0.1, 3), beam_mass=rng.uniform(0, 9), right_mass=rng.uniform(0.1, 3),
        )  # fmt: skip
        yield Arch(radius=x, thickness=x * rng.uniform(0.12, 0.25), inclusion_angle_deg=rng.uniform(110, 180))


def test_an_impact_never_adds_energy():
    for mechanism in every_mechanism():
        etas = {}
        for direction in BOTH:
            eta = etas[direction] = mechanism.restitution_from_kinematics(direction)
            before, after = (mechanism.kinetic_inertia(np.zeros(1), way)[0] for way in (direction, direction.opposite))
            assert eta**2 * after < before, mechanism  # T = I phi.^2 / 2, and real corners always cost something
        assert abs(etas[POSITIVE] * etas[NEGATIVE]) < 1


def test_a_given_number_wins_in_both_directions():
    block, wall = Block(width=0.7, height=2.8, restitution=0.83), Wall(thickness=0.3, height=3.0, restitution=0.83)
    for mechanism in (block, wall):
        both = equivalent_block(mechanism)
        assert (both.positive.eta, both.negative.eta) == (0.83, 0.83)
        assert mechanism.restitution_from_kinematics(POSITIVE) != 0.83
    stocky = Block(width=4.0, height=2.0, restitution=0.5)
    assert stocky.eta(POSITIVE) == 0.5
    assert stocky.restitution_from_kinematics(POSITIVE) < 0


@pytest.mark.parametrize("as_mapping", [True, False])
def test_given_numbers_for_each_impact_win_and_are_not_swapped(as_mapping):
    given = {"positive_to_negative": 0.8, "negative_to_positive": 0.9}
    restitution = given if as_mapping else DirectionalRestitution(**given)
    frame = AsymmetricFrame(
        column_width=1.0, left_height=6.0, right_height=7.5, spacing=8.0, beam_depth=1.0, density=2400.0, depth=1.0,
        restitution=restitution,
    )  # fmt: skip
    both = equivalent_block(frame)
    assert (both.positive.eta, both.negative.eta) == (0.8, 0.9)
    assert (frame.eta(POSITIVE), frame.eta(NEGATIVE)) == (0.8, 0.9)


@pytest.mark.parametrize("eta", [0.0, -0.2, 1.01, float("nan")])
def test_a_restitution_outside_0_to_1_is_refused(eta):
    with pytest.raises(InputError, match="restitution"):
        Block(width=0.7, height=2.8, restitution=eta)
    both = {"positive_to_negative": eta, "negative_to_positive": 0.9}
    with pytest.raises(InputError, match="positive_to_negative"):
        Block(width=0.7, height=2.8, restitution=both)


# What is said of it


def test_the_reason_for_no_restitution_is_the_sign_of_the_product():
    for structure in (Block(width=3.0, height=1.0), Block(width=2.0, height=2.0**0.5)):
        t = [structure.motion(np.zeros(1), side)[0] for side in (Direction.POSITIVE, Direction.NEGATIVE)]
        (body,) = structure.bodies()
        one, other = (each.carry(body.centroid)[1][0] for each in t)
        product = body.mass * (one.conjugate() * other).real + body.inertia * t[0].dpsi[0] * t[1].dpsi[0]
        eta = structure.eta(Direction.POSITIVE)
        assert (product >= -1e-12) == (eta <= 1e-12)
    assert "<t+, t->, is positive" in why_none(-0.1) and "is zero" in why_none(0.0)


@pytest.mark.every(3)
@pytest.mark.parametrize(
    ("given", "said"),
    [
        (
            "",
            "Coefficient of restitution eta = 0.9118, from rigid-body kinematics, not measured. Tests found higher "
            "values for concrete and stone (Kalliontzis et al. 2016; Ther and Kollar 2017), and lower ones for soft or "
            "worn feet (ElGawady et al. 2011).",
        ),
        ("restitution: 0.85\n", "Coefficient of restitution eta = 0.85, as given."),
        (
            "restitution: {positive_to_negative: 0.8, negative_to_positive: 0.9}\n",
            "Coefficient of restitution eta = 0.8 at impacts that end clockwise rotation and 0.9 at the others, as "
            "given.",
        ),
    ],
)
def test_the_restitution_used_is_said_with_its_source(given, said):
    text = f"mechanism: block\nwidth: 0.7\nheight: 2.8\n{given}"
    assert restitution_used(Structure(parse_structure(text, "b.yaml", "b"))) == said


@pytest.mark.parametrize("given", ["", "restitution: 0.85\n"])
def test_commands_say_which_restitution_they_used(given, tmp_path):
    file, pulse = tmp_path / "b.yaml", ("--pulse", "sine:0.4g:0.5s")
    file.write_text(f"mechanism: block\nwidth: 0.7\nheight: 2.8\n{given}", encoding="utf-8")
    said = restitution_used(Structure(load_structure(file)))
    first, *more = restitution_sentences(Structure(load_structure(file)))
    assert {first, *more} <= {*run("respond", file, *pulse, "--all").stdout.splitlines()}
    assert {first, *more} & {*run("respond", file, *pulse).stdout.splitlines()} == {first}
    assert said in run("pulse", file, "--ag", "0.4g", "--period", "0.5").stdout.splitlines()
    for data in (
        run_json("respond", file, *pulse, "--neighbours", 0),
        run_json("animate", file, *pulse, "--out", tmp_path / "a.html", "--neighbours", 2),
    ):
        assert data["restitution"]["source"] == ("given" if given else "kinematics")
        assert data["restitution"]["positive_to_negative"] == run_json("equiv", file)["directions"]["positive"]["eta"]
    for text in (run("spectrum", file, *pulse).stdout, run("overturning", file, "--points", 4).stdout):
        assert ("(from kinematics, not measured)" in text) == (not given)


@pytest.mark.parametrize(("height", "slender"), [(0.699, None), (1.0, False), (4.8, False), (5.0, True), (9.0, True)])
def test_tests_are_cited_on_both_sides_of_the_kinematics(height, slender):
    """eta = 1 - 1.5 sin^2(alpha) is .97 at height/width = 7; below 0.707 there is none, and nothing is compared."""
    structure = Structure(Block(width=1.0 if height < 2 else 0.7, height=height))
    said, cited = restitution_used(structure), [*restitution_sentences(structure)][1:]
    assert [isinstance(each, Aside) for each in cited] == [not slender] * (slender is not None)
    assert ("higher values for concrete and stone" in said) == (slender is not None)
    assert ("lower ones for soft or worn feet" in said) == (slender is not None)
    assert ("as slender as this, about 0.95" in said) == bool(slender)
    assert "Tests" not in restitution_used(Structure(Block(width=0.7, height=height, restitution=0.9)))


@pytest.mark.parametrize("given", [{}, {"restitution": 0.6}, {"one_sided": "positive", "rebound": 0.3}])
@pytest.mark.parametrize(("ratio", "stocky"), [(1.0, True), (1.99, True), (2.0, False), (2.01, False), (4.0, False)])
def test_a_body_lower_than_twice_its_width_is_said_to_bounce(ratio, stocky, given):
    """Whatever restitution is given, as bouncing is not a matter of its value."""
    said = [each for each in cautions_of(Block(width=0.8, height=0.8 * ratio, **given)) if "bouncing" in each]
    assert bool(said) == stocky
    if stocky:
        eta = 1 - 1.5 / (1 + ratio**2)
        assert said[0].startswith(f"It is stocky: its kinematics give eta = {eta:.3g}, below 0.7 as for a block")


def test_several_bodies_of_a_low_restitution_are_not_called_stocky():
    arch = Arch(radius=10.0, thickness=1.5, inclusion_angle_deg=157.5, voussoirs=7)
    assert arch.eta(Direction.POSITIVE) < 0.7
    assert not any("stocky" in each for each in cautions_of(arch))

"""Structures with direct equivalence and the wall against closed forms derived here, and energies against themselves.

The formulas are those of Table I and Eqs. 21-23, or follow from R, alpha and the inertia about the pivot.
"""

from math import atan, atan2, cos, degrees, hypot, inf, pi, radians, sin, sqrt, tan

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
from rocking_cli.errors import InputError
from tests.reference_mechanics import derivative, deviation, polygon_moments

CASES = range(5)
BOTH = list(Direction)


def exactly(value):
    return approx(value, rel=1e-10, abs=1e-13)


def draw(case, *ranges):
    """Random numbers of a case, log-uniform over the ranges."""
    rng = np.random.default_rng(1000 + case)
    return [float(np.exp(rng.uniform(np.log(low), np.log(high)))) for low, high in ranges]


def assert_single_block(mechanism, p2, alpha, eta):
    """The parameters of a structure with direct equivalence: the block's, with its own p and eta."""
    both = equivalent_block(mechanism)
    for block in (both.positive, both.negative):
        assert block.p**2 == exactly(p2)
        assert block.phi_cr == exactly(alpha)
        assert block.lambda_ == exactly(tan(alpha))
        assert block.lambda_lin == exactly(alpha)
        assert block.kappa1 == exactly(1.0)
        assert block.kappa2 == exactly(alpha / tan(alpha))
        assert block.theta_cr1 == exactly(alpha)
        assert block.theta_cr2 == exactly(tan(alpha))
        assert block.eta == exactly(eta)
    assert both.symmetric


def assert_swinging(mechanism, R, alpha, ratio, direction):
    """Coefficients of a body of 1 kg that turns about one corner, its inertia there being ratio R^2."""
    phi = np.linspace(0.0, 1.2 * alpha, 9)
    got = mechanism.coefficients(phi, direction)
    assert deviation(got.I, np.full(9, ratio * R**2)) < 1e-10
    for values, expected in (
        (got.J, 0 * phi),
        (got.G, R * np.sin(alpha - phi)),
        (got.B, R * np.cos(alpha - phi)),
        (got.dG, -R * np.cos(alpha - phi)),
        (got.dB, R * np.sin(alpha - phi)),
        (got.V, R * (np.cos(alpha - phi) - cos(alpha))),
    ):
        assert deviation(values, expected, scale=R * max(1.0, R)) < 1e-10


# --- Table I ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("case", CASES)
def test_block_is_housners(case):
    width, height, g = draw(case, (0.05, 5.0), (0.1, 20.0), (1.0, 30.0))
    R, alpha = hypot(width, height) / 2, atan(width / height)
    block = Block(width=width, height=height, gravity=g)
    assert_single_block(block, 3 * g / (4 * R), alpha, 1 - 1.5 * sin(alpha) ** 2)
    for direction in BOTH:
        assert_swinging(block, R, alpha, 4 / 3, direction)


@pytest.mark.parametrize("case", CASES)
def test_point_mass_is_a_pendulum(case):
    base, height, g = draw(case, (0.05, 5.0), (0.1, 20.0), (1.0, 30.0))
    R, alpha = hypot(base / 2, height), atan(base / 2 / height)
    mass = PointMass(base_width=base, height=height, gravity=g)
    assert_single_block(mass, g / R, alpha, cos(2 * alpha))
    for direction in BOTH:
        assert_swinging(mass, R, alpha, 1.0, direction)


@pytest.mark.parametrize("case", CASES)
def test_conical_shell_is_table_i(case):
    r, h, g = draw(case, (0.1, 5.0), (0.3, 40.0), (1.0, 30.0))
    R, alpha = hypot(r, h / 3), atan(3 * r / h)
    c2 = cos(alpha) ** 2
    shell = Cone(base_radius=r, height=h, kind="shell", gravity=g)
    assert_single_block(shell, 4 * g / (R * (5 + c2)), alpha, 1 - 8 * sin(alpha) ** 2 / (5 + c2))
    assert_swinging(shell, R, alpha, (5 + c2) / 4, Direction.NEGATIVE)
    assert equivalent_block(Cone(base_radius=r, height=h, gravity=g)) == equivalent_block(shell)


@pytest.mark.parametrize("case", CASES)
def test_solid_cone_is_table_i(case):
    r, h, g = draw(case, (0.1, 5.0), (0.3, 40.0), (1.0, 30.0))
    alpha = atan(4 * r / h)
    p2 = 5 * g * sqrt(h**2 + 16 * r**2) / (2 * h**2 + 23 * r**2)
    solid = Cone(base_radius=r, height=h, kind="solid", gravity=g)
    assert_single_block(solid, p2, alpha, (2 * h**2 - 17 * r**2) / (2 * h**2 + 23 * r**2))
    assert_swinging(solid, hypot(r, h / 4), alpha, g / (p2 * hypot(r, h / 4)), Direction.POSITIVE)


@pytest.mark.parametrize("case", CASES)
def test_hollow_cone_is_a_solid_cone_less_a_similar_one(case):
    r, h, k = draw(case, (0.1, 5.0), (0.3, 40.0), (0.02, 0.98))
    # Slices of both cones by Gauss quadrature over the height, unit density: mass, first and second moments.
    nodes, weights = np.polynomial.legendre.leggauss(8)
    mass = first = foot = 0.0
    for size, sign in ((1.0, 1.0), (k, -1.0)):
        y, dy = size * h * (1 + nodes) / 2, size * h * weights / 2
        disc = r * (size - y / h)
        mass += sign * np.sum(dy * pi * disc**2)
        first += sign * np.sum(dy * pi * disc**2 * y)
        foot += sign * np.sum(dy * pi * disc**2 * (y**2 + disc**2 / 4))  # about a diameter of the base
    height = first / mass
    R, alpha = hypot(r, height), atan2(r, height)
    inertia = foot / mass + r**2  # the base's middle is r from the pivot, and the centroid above the middle
    g = 9.80665
    hollow = Cone(base_radius=r, height=h, kind="hollow", inner_ratio=k)
    block = equivalent_block(hollow).positive
    # The difference of the two cones loses a few digits as the wall gets thin.
    assert block.p**2 == approx(g * R / inertia, rel=1e-11 / (1 - k))
    assert block.phi_cr == approx(alpha, rel=1e-11 / (1 - k))
    assert block.eta == approx(1 - 2 * r**2 / inertia, rel=1e-10 / (1 - k), abs=1e-11)


def test_a_vanishing_wall_is_not_lost_to_cancellation():
    shell = equivalent_block(Cone(base_radius=1.5, height=12.0, kind="shell")).positive
    thin = equivalent_block(Cone(base_radius=1.5, height=12.0, kind="hollow", inner_ratio=1 - 1e-12)).positive
    assert (thin.p, thin.phi_cr, thin.eta) == approx((shell.p, shell.phi_cr, shell.eta), rel=1e-8)


@pytest.mark.parametrize("case", CASES)
def test_symmetric_frame_is_table_i(case):
    width, height, gamma, g = draw(case, (0.1, 3.0), (0.5, 20.0), (1e-3, 50.0), (1.0, 30.0))
    columns = 1 + case % 5
    R, alpha = hypot(width, height) / 2, atan(width / height)
    frame = SymmetricFrame(column_width=width, column_height=height, columns=columns, mass_ratio=gamma, gravity=g)
    p2 = 3 * g / (4 * R) * (1 + 2 * gamma) / (1 + 3 * gamma)
    eta = (1 - 1.5 * sin(alpha) ** 2 + 3 * gamma * cos(2 * alpha)) / (1 + 3 * gamma)
    assert_single_block(frame, p2, alpha, eta)
    # Per kilogram of the whole: the columns turn, the beam moves on the circle of their tops, 2R from the feet.
    one, beam = 1 / (1 + gamma), gamma / (1 + gamma)
    phi = np.linspace(0.0, 1.2 * alpha, 9)
    for direction in BOTH:
        got = frame.coefficients(phi, direction)
        assert deviation(got.I, np.full(9, one * 4 / 3 * R**2 + beam * 4 * R**2)) < 1e-10
        assert deviation(got.J, 0 * phi, scale=R**2) < 1e-10
        assert deviation(got.G, (one + 2 * beam) * R * np.sin(alpha - phi)) < 1e-10
        assert deviation(got.B, (one + 2 * beam) * R * np.cos(alpha - phi)) < 1e-10
        assert deviation(got.V, (one + 2 * beam) * R * (np.cos(alpha - phi) - cos(alpha)), scale=R) < 1e-10


def test_frame_without_beam_is_a_column_and_with_a_vast_beam_a_pendulum():
    block = equivalent_block(Block(width=1.0, height=6.0)).positive
    bare = equivalent_block(SymmetricFrame(column_width=1.0, column_height=6.0, mass_ratio=0.0)).positive
    assert bare.as_dict() == approx(block.as_dict(), rel=1e-12)
    vast = equivalent_block(SymmetricFrame(column_width=1.0, column_height=6.0, mass_ratio=1e6)).positive
    assert vast.p**2 == approx(9.80665 / hypot(1.0, 6.0), rel=1e-6)  # radius 2R
    assert vast.eta == approx(cos(2 * atan(1 / 6)), rel=1e-6)


# --- the wall --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("case", CASES)
def test_wall_has_the_exact_parameters_of_section_4(case):
    thickness, height, g = draw(case, (0.05, 1.0), (1.0, 10.0), (1.0, 30.0))
    b, h = thickness / 2, height / 4
    R, alpha = hypot(b, h), atan(b / h)
    both = equivalent_block(Wall(thickness=thickness, height=height, gravity=g))
    for wall in (both.positive, both.negative):
        assert wall.phi_cr == exactly(alpha)
        assert wall.kappa1 == exactly(0.5)
        assert wall.lambda_ == exactly(2 * tan(alpha))
        assert wall.lambda_lin == exactly(2 * alpha)
        assert wall.p == exactly(sqrt(3 * g / (2 * R)))
        assert wall.kappa2 == exactly(alpha / (2 * tan(alpha)))
        assert wall.theta_cr1 == exactly(2 * alpha)
        assert wall.theta_cr2 == exactly(2 * tan(alpha))


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("direction", BOTH)
def test_wall_obeys_the_corrected_equation_21(case, direction):
    thickness, height, g = draw(case, (0.05, 1.0), (1.0, 10.0), (1.0, 30.0))
    R, alpha = hypot(thickness / 2, height / 4), atan(2 * thickness / height)
    wall = Wall(thickness=thickness, height=height, gravity=g)
    phi = np.linspace(0.0, 1.3 * alpha, 14)
    got = wall.coefficients(phi, direction)
    m = 0.5  # of one block; Eq. 21 is divided by 4 m g R
    scale, corner = 4 * m * g * R, 4 / 3 * m * R**2
    sine = np.sin(alpha - phi)
    assert deviation(got.I, scale * (corner / (2 * m * g * R) + 2 * R / g * sine**2)) < 1e-10
    assert deviation(got.J, -scale * R / g * np.sin(2 * (alpha - phi))) < 1e-10
    assert deviation(got.G * g, scale * sine) < 1e-10
    assert deviation(got.B * g, scale * np.cos(alpha - phi) / 2) < 1e-10
    assert deviation(got.V * g, scale * (np.cos(alpha - phi) - cos(alpha)), scale) < 1e-10


# --- any rigid body --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("case", CASES)
def test_rigid_body_by_its_numbers(case):
    R, alpha, ratio, g = draw(case, (0.1, 20.0), (0.02, 1.3), (1.0, 4.0), (1.0, 30.0))
    body = RigidBody(R=R, alpha_deg=degrees(alpha), inertia_ratio=ratio, gravity=g)
    assert_single_block(body, g / (ratio * R), alpha, 1 - 2 * sin(alpha) ** 2 / ratio)
    assert_swinging(body, R, alpha, ratio, Direction.POSITIVE)


@pytest.mark.parametrize("case", CASES)
def test_a_rectangular_polygon_is_the_block(case):
    width, height = draw(case, (0.05, 5.0), (0.1, 20.0))
    corners = [[3.0, -2.0], [3.0 + width, -2.0], [3.0 + width, height - 2.0], [3.0, height - 2.0]]
    polygon, block = RigidBody(polygon=corners), Block(width=width, height=height)
    got, expected = equivalent_block(polygon), equivalent_block(block)
    for direction in BOTH:
        assert got[direction].as_dict() == approx(expected[direction].as_dict(), rel=1e-10, abs=1e-12)


def outline(case):
    """A random polygon on two feet, often not convex, that leans; its corners as complex numbers.

    Corners sit at rising angles about the middle of its base, so sides cannot cross.
    """
    rng = np.random.default_rng(2000 + case)
    while True:
        width = rng.uniform(0.5, 3.0)
        angles = np.sort(rng.uniform(0.35, pi - 0.35, rng.integers(2, 7)))
        radii = rng.uniform(1.0, 4.0, angles.size)
        z = np.concatenate([[-width / 2, width / 2], radii * np.exp(1j * angles) + rng.uniform(-0.1, 0.1)])
        _, c, _ = polygon_moments(z)
        falls = [fall(z, s) for s in (1, -1)]
        stands = -0.45 * width < c.real < 0.45 * width and np.diff(angles).min() > 0.05
        leans = abs(c.real) > 0.03 * width
        alphas = [atan2(width / 2 - s * c.real, c.imag) for s in (1, -1)]
        free = all(limit > alpha + 0.02 for limit, alpha in zip(falls, alphas, strict=True))
        if stands and leans and free:
            return z


def fall(z, s):
    """How far an outline on y = 0 turns about its foot on the side s before another corner is on the ground."""
    foot = max(s * corner.real for corner in z if abs(corner.imag) < 1e-12)
    least = inf
    for corner in z:
        if corner.imag > 1e-12:
            beyond = s * corner.real - foot  # turning lowers what is beyond the foot
            least = min(least, atan2(corner.imag, beyond))
    return least


@pytest.mark.parametrize("case", CASES)
def test_a_polygon_has_the_inertia_of_its_area_in_both_directions(case):
    z = outline(case)
    _, c, polar = polygon_moments(z)
    area = polygon_moments(z)[0]
    central = polar / area
    left, right = z[0], z[1]
    body = RigidBody(polygon=[[w.real, w.imag] for w in z])
    both = equivalent_block(body)
    alphas = []
    for direction, pivot, other in ((Direction.POSITIVE, right, left), (Direction.NEGATIVE, left, right)):
        arm, next_arm = c - pivot, c - other
        alpha = atan(abs(arm.real) / arm.imag)
        alphas.append(alpha)
        inertia = central + abs(arm) ** 2
        got = both[direction]
        assert got.lambda_ == exactly(tan(alpha))
        assert got.phi_cr == exactly(alpha)
        assert got.kappa1 == exactly(1.0)
        assert got.p**2 == exactly(9.80665 * abs(arm) / inertia)
        assert body.limit(direction) == exactly(fall(z, int(direction)))
        # Angular momentum about the new pivot: w (I_c + m (c - O').(c - O)) before, w' (I_c + m |c - O'|^2) after.
        before = central + (next_arm * arm.conjugate()).real
        assert got.eta == exactly(before / (central + abs(next_arm) ** 2))
        assert_swinging(body, abs(arm), alpha, inertia / abs(arm) ** 2, direction)
    assert abs(alphas[0] - alphas[1]) > 1e-3  # it leans, so the directions differ
    assert not both.symmetric


@pytest.mark.parametrize("case", CASES)
def test_a_polygon_does_not_depend_on_the_order_of_its_corners_or_its_place(case):
    z = outline(case)
    expected = equivalent_block(RigidBody(polygon=[[w.real, w.imag] for w in z]))
    for other in (z[::-1], np.roll(z, 2), np.roll(z[::-1], 3), z + (5.0 - 3.0j), z + 1e4):
        got = equivalent_block(RigidBody(polygon=[[w.real, w.imag] for w in other]))
        for direction in BOTH:
            # Adding 1e4 to a coordinate costs four of its digits.
            assert got[direction].as_dict() == approx(expected[direction].as_dict(), rel=1e-9, abs=1e-10)


def test_the_mirror_image_of_a_polygon_swaps_its_directions():
    z = outline(3)
    one = equivalent_block(RigidBody(polygon=[[w.real, w.imag] for w in z]))
    two = equivalent_block(RigidBody(polygon=[[-w.real, w.imag] for w in z]))
    assert one.positive.as_dict() == approx(two.negative.as_dict(), rel=1e-12)
    assert one.negative.as_dict() == approx(two.positive.as_dict(), rel=1e-12)


def test_a_polygon_whose_centroid_is_beside_its_foot_is_refused():
    with pytest.raises(InputError, match="centroid"):
        RigidBody(polygon=[[0.0, 0.0], [1.0, 0.0], [4.0, 3.0], [3.0, 3.0]])


# --- energies: that bodies move as their derivatives say is in the contract of every mechanism ------------------------

MECHANISMS = {
    "stocky block": Block(width=2.5, height=2.0),
    "polygon": RigidBody(polygon=[[0.0, 0.0], [1.0, 0.0], [0.8, 3.0], [0.0, 3.0]]),
    "wall": Wall(thickness=0.3, height=3.0),
    "asymmetric_frame, short right column": AsymmetricFrame(
        column_width=1.0, left_height=7.5, right_height=5.0, spacing=4.0, beam_depth=2.0,
        left_mass=3.0, beam_mass=5.0, right_mass=1.0,
    ),
    "thick arch": Arch(radius=2.0, thickness=0.6, inclusion_angle_deg=120.0, voussoirs=20),
}  # fmt: skip


@pytest.mark.parametrize("name", MECHANISMS)
@pytest.mark.parametrize("direction", BOTH)
def test_forces_are_the_derivatives_of_the_energies(name, direction):
    mechanism = MECHANISMS[name]
    limit = mechanism.limit(direction)
    phi = np.linspace(0.01, 0.9, 61) * limit
    h = 1e-3 * limit

    def at(x):
        return mechanism.coefficients(x, direction)

    got = at(phi)
    g = mechanism.gravity
    pairs = [
        (got.G, derivative(lambda x: mechanism.potential_energy(x, direction), phi, h) / g),
        (got.J, derivative(lambda x: mechanism.kinetic_inertia(x, direction), phi, h) / 2),
        (got.dG, derivative(lambda x: at(x).G, phi, h)),
        (got.dB, derivative(lambda x: at(x).B, phi, h)),
    ]
    for exact, numeric in pairs:
        # A constant's derivative is the rounding of the constant over h: hence the scale of the inertia.
        assert np.abs(exact - numeric).max() <= 1e-7 * (np.abs(exact).max() + 1e-3 * np.abs(got.I).max())


@pytest.mark.parametrize("name", MECHANISMS)
@pytest.mark.parametrize("direction", BOTH)
def test_energies_start_at_rest_and_the_critical_rotation_is_the_first_top_of_the_potential(name, direction):
    mechanism = MECHANISMS[name]
    phi = np.linspace(0.0, 0.98, 4001) * mechanism.limit(direction)
    potential = mechanism.potential_energy(phi, direction)
    assert abs(potential[0]) < 1e-13 * np.abs(potential).max()
    tops = 1 + np.flatnonzero((potential[1:-1] > potential[:-2]) & (potential[1:-1] >= potential[2:]))
    assert mechanism.critical_rotation(direction) == approx(phi[tops[0]], abs=phi[1])
    assert np.all(mechanism.kinetic_inertia(phi, direction) > 0)


def test_ground_to_the_left_tips_clockwise():
    # B > 0 in both directions, so u_g'' < 0 drives phi.. > 0 for s = +1, and u_g'' > 0 for s = -1.
    for name, mechanism in MECHANISMS.items():
        for direction in BOTH:
            at_rest = mechanism.coefficients(np.zeros(1), direction)
            assert at_rest.B[0] > 0, name
            assert at_rest.G[0] > 0, name


def test_alpha_in_degrees_is_degrees():
    assert equivalent_block(RigidBody(R=1.0, alpha_deg=30.0, inertia_ratio=2.0)).positive.phi_cr == exactly(radians(30))

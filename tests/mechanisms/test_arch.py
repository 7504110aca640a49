"""The arch against statics (linear programmes of the thrust), all its mechanisms, and Eq. 39 written out.

Masses and centroids come from quadrature in `reference_mechanics`. The greatest multiplier of the static theorem and
the least of the kinematic theorem are dual: they agree to rounding for the same joints. A ring that hinges anywhere has
a lambda below that of any finite set of joints, which excludes mechanisms; the excess falls as 1/n^2 because lambda is
stationary in the hinges.
"""

from functools import cache
from itertools import combinations, product

import numpy as np
import pytest
from pytest import approx
from scipy.optimize import brentq

from mechanisms.arch import Arch
from rocking_cli.core import Direction, equivalent_block
from rocking_cli.errors import InputError, MechanismError
from tests.reference_mechanics import FourBar, Voussoirs, link_rates, sector_moments

BOTH = list(Direction)
POSITIVE, NEGATIVE = Direction.POSITIVE, Direction.NEGATIVE
MANY = 2000  # joints of the thrust programme that stand for a continuous ring

# beta in degrees, t/r, voussoirs
RINGS = [
    (157.5, 0.15, 7), (157.5, 0.15, 31), (120.0, 0.12, 12), (180.0, 0.2, 25), (90.0, 0.1, 40), (60.0, 0.05, 20),
    (140.0, 0.35, 16), (100.0, 0.25, 9), (180.0, 0.115, 60),
]  # fmt: skip
CONTINUOUS = [(157.5, 0.15), (120.0, 0.12), (180.0, 0.2), (90.0, 0.08), (60.0, 0.05), (140.0, 0.35), (180.0, 0.12)]


def arch(beta, ratio, voussoirs=None, radius=1.0, **more):
    return Arch(radius=radius, thickness=ratio * radius, inclusion_angle_deg=beta, voussoirs=voussoirs, **more)


# --- the uplift acceleration -----------------------------------------------------------------------------------------


def test_oppenheims_arch_uplifts_at_0_37_g():
    opp = Arch(radius=10.0, thickness=1.5, inclusion_angle_deg=157.5, voussoirs=7)
    for direction in BOTH:
        assert round(opp.uplift(direction), 2) == 0.37
    assert round(Voussoirs(np.radians(157.5), 0.15, 7).thrust()[0], 2) == 0.37


@pytest.mark.parametrize(("beta", "ratio", "n"), RINGS)
def test_lambda_of_voussoirs_is_the_static_multiplier(beta, ratio, n):
    static = Voussoirs(np.radians(beta), ratio, n).thrust()[0]
    ring = arch(beta, ratio, n)
    for direction in BOTH:
        assert ring.uplift(direction) == approx(static, rel=1e-9)
        rest = ring.coefficients(np.zeros(1), direction)
        assert rest.G[0] / rest.B[0] == approx(static, rel=1e-9)
        assert equivalent_block(ring)[direction].lambda_ == approx(static, rel=1e-9)


@pytest.mark.rest
@pytest.mark.parametrize(("beta", "ratio"), CONTINUOUS)
def test_more_joints_converge_on_the_continuous_ring_from_above(beta, ratio):
    exact = arch(beta, ratio).uplift(POSITIVE)
    counts = np.array([250, 1000, 4000, 16000])
    excess = np.array([Voussoirs(np.radians(beta), ratio, n).thrust()[0] - exact for n in counts])
    assert excess.min() > -1e-10
    # The hinges fall anywhere between joints, so the excess is below, not on, a line C/n^2.
    assert np.all(excess < 20 / counts**2)
    assert excess[-1] < 1e-7
    assert [arch(beta, ratio, int(n)).uplift(POSITIVE) - exact for n in (250, 1000)] == approx(excess[:2], abs=1e-9)


def brute_force(beta, ratio, n):
    """Least multiplier over every set of four hinges at joints and faces that opens and is driven, and its hinges.

    The sense of a mechanism is that in which its hinges open: what is right of a hinge on the intrados turns clockwise
    to what is left of it, on the extrados anticlockwise.
    """
    ring = Voussoirs(beta, ratio, n)
    radii = {"I": 1 - ratio / 2, "E": 1 + ratio / 2}
    best = np.inf, None
    for joints in combinations(range(n + 1), 4):
        for faces in product("IE", repeat=4):
            a, b, c, d = (ring.radial[k] * radii[face] for k, face in zip(joints, faces, strict=True))
            if abs(np.linalg.det([[(c - b).real, (d - c).real], [(c - b).imag, (d - c).imag]])) < 1e-12:
                continue
            for sense in (-1.0, 1.0):
                two, three = link_rates(a, b, c, d, sense)
                jumps = np.diff([0.0, sense, two, three, 0.0])
                if not all(jump * (1 if face == "E" else -1) > 0 for jump, face in zip(jumps, faces, strict=True)):
                    continue
                z = ring.centroid
                velocity = np.zeros(n, complex)
                one, mid, end = (slice(*joints[k : k + 2]) for k in range(3))
                velocity[one] = 1j * sense * (z[one] - a)
                velocity[mid] = 1j * sense * (b - a) + 1j * two * (z[mid] - b)
                velocity[end] = 1j * three * (z[end] - d)
                drive, lift = velocity.sum().real, velocity.sum().imag
                if drive > 0 and lift / drive < best[0]:
                    best = lift / drive, list(zip(joints, faces, strict=True))
    return best


@pytest.mark.parametrize(("beta", "ratio", "n"), [(157.5, 0.15, 7), (120.0, 0.2, 8), (180.0, 0.25, 9), (90.0, 0.06, 6)])
def test_no_set_of_four_hinges_has_a_smaller_lambda(beta, ratio, n):
    ring = arch(beta, ratio, n)
    least, hinges = brute_force(np.radians(beta), ratio, n)
    assert ring.uplift(POSITIVE) == approx(least, rel=1e-9)
    assert [face for _, face in hinges] == list("IEIE")
    assert ring.hinge_angles == approx([k * np.radians(beta) / n for k, _ in hinges], abs=1e-12)


@pytest.mark.parametrize(("beta", "ratio", "n"), RINGS)
def test_hinges_are_where_the_thrust_touches(beta, ratio, n):
    _, hinges = Voussoirs(np.radians(beta), ratio, n).thrust()
    assert [face for _, face in hinges] == list("IEIE")
    ring = arch(beta, ratio, n)
    angles = [k * np.radians(beta) / n for k, _ in hinges]
    assert ring.hinge_angles == approx(angles, abs=1e-12)
    for direction in BOTH:
        # Measured from the left springing (positive) or the right one; the negative mechanism is the mirror image.
        mirror = 1 if direction > 0 else -1
        radii = [1 - ratio / 2 if face == "I" else 1 + ratio / 2 for _, face in hinges]
        expected = [
            r * complex(-mirror * np.sin(np.radians(beta) / 2 - x), np.cos(np.radians(beta) / 2 - x))
            for r, x in zip(radii, angles, strict=True)
        ]
        assert list(ring.hinges(direction)) == approx(expected, abs=1e-12)


# --- the equivalent block: Eq. 39 ------------------------------------------------------------------------------------


class Scan:
    """Eqs. 32 and 39 of the paper, corrected, for the mechanism that throws the arch to the right; ring mass 1 kg."""

    def __init__(self, beta, ratio, angles, radius=1.0):
        inner, outer = radius * (1 - ratio / 2), radius * (1 + ratio / 2)
        polar = [np.pi / 2 + beta / 2 - angle for angle in angles]
        a, b, c, d = (r * np.exp(1j * x) for r, x in zip((inner, outer, inner, outer), polar, strict=True))
        density = 1 / sector_moments(inner, outer, 0.0, beta)[0]
        self.bar = FourBar(a, b, c, d, 1)
        self.AB = abs(b - a)
        hinge = (a, b, d)  # each body's own hinge, and the direction of its bar from it
        bars = (b - a, c - b, c - d)
        self.m, self.r, self.psi, self.I = [], [], [], []
        for k in range(3):
            area, first, second = sector_moments(inner, outer, polar[k + 1], polar[k])
            arm = first / area - hinge[k]
            self.m.append(density * area)
            self.r.append(abs(arm))
            self.psi.append(np.angle(arm / bars[k]))
            # Parallel axes by the integral itself: |z - h|^2 = |z|^2 - 2 z.h + |h|^2.
            self.I.append(density * (second - 2 * (first * hinge[k].conjugate()).real + area * abs(hinge[k]) ** 2))

    def state(self, phi):
        angles = self.bar.angles(phi)
        return angles, self.bar.rates(angles)

    def G(self, phi):
        (v, v_BC, v_CD), (f, k, _, _) = self.state(phi)
        m, r, psi = self.m, self.r, self.psi
        return -(
            m[0] * r[0] * np.cos(v + psi[0]) + m[1] * self.AB * np.cos(v)
            + m[1] * r[1] * np.cos(v_BC + psi[1]) * f + m[2] * r[2] * np.cos(v_CD + psi[2]) * k
        )  # fmt: skip

    def critical(self, end):
        grid = np.linspace(0.0, end, 60)
        values = [self.G(phi) for phi in grid]
        first = next(i for i, value in enumerate(values) if value < 0)
        return brentq(self.G, grid[first - 1], grid[first], xtol=1e-15, rtol=1e-14)

    def eq_39(self, phi):
        (v, v_BC, v_CD), (f, k, df, dk) = self.state(phi)
        m, r, psi, AB = self.m, self.r, self.psi, self.AB
        inertia = (
            self.I[0] + self.I[2] * k**2 + self.I[1] * f**2
            + m[1] * AB * (AB + 2 * r[1] * np.cos(v - v_BC - psi[1]) * f)
        )  # fmt: skip
        G = -(
            m[1] * r[1] * (np.cos(v_BC + psi[1]) * df - np.sin(v_BC + psi[1]) * f**2)
            + m[2] * r[2] * (np.cos(v_CD + psi[2]) * dk - np.sin(v_CD + psi[2]) * k**2)
            - m[0] * r[0] * np.sin(v + psi[0]) - m[1] * AB * np.sin(v)
        )  # fmt: skip
        B = (
            m[0] * r[0] * np.sin(v + psi[0]) + m[2] * r[2] * np.sin(v_CD + psi[2]) * k
            + m[1] * r[1] * np.sin(v_BC + psi[1]) * f + m[1] * AB * np.sin(v)
        )  # fmt: skip
        # Half the derivative of the inertia, in phi = varphi_0 - varphi.
        turn = v - v_BC - psi[1]
        slide = np.cos(turn) * df - np.sin(turn) * (1 - f) * f
        J = -(self.I[2] * k * dk + self.I[1] * f * df + m[1] * AB * r[1] * slide)
        return inertia, J, G, B


@pytest.mark.every(2)
@pytest.mark.parametrize(("beta", "ratio", "n"), [*RINGS, *((b, t, None) for b, t in CONTINUOUS)])
def test_equivalent_block_is_equation_39(beta, ratio, n):
    ring = arch(beta, ratio, n, radius=3.0)
    wide = np.radians(beta)
    # Of voussoirs the hinges are those of statics, so that nothing here is the project's.
    joints = Voussoirs(wide, ratio, n).thrust()[1] if n else []
    scan = Scan(wide, ratio, [k * wide / n for k, _ in joints] or ring.hinge_angles, radius=3.0)
    assert min(abs(scan.psi[0]), abs(scan.psi[2])) > 1e-3  # what Eq. 39 has and Eq. 38 has not
    phi_cr = scan.critical(0.95 * ring.limit(POSITIVE))
    inertia, _, G, B = scan.eq_39(phi_cr)
    both = equivalent_block(ring)
    for got in (both.positive, both.negative):
        assert got.phi_cr == approx(phi_cr, rel=1e-9)
        assert got.I_eq == approx(inertia, rel=1e-9)
        assert got.G_eq == approx(G, rel=1e-9)
        assert got.B_eq == approx(B, rel=1e-9)
        assert got.p == approx(np.sqrt(9.80665 * G / inertia), rel=1e-9)
        assert got.kappa1 == approx(B / G, rel=1e-9)
        assert got.lambda_lin == approx(phi_cr * G / B, rel=1e-9)
        assert got.kappa2 == approx(phi_cr * scan.eq_39(0.0)[3] / scan.G(0.0), rel=1e-9)
    assert both.symmetric


@pytest.mark.parametrize(("beta", "ratio", "n"), RINGS)
@pytest.mark.parametrize("direction", BOTH)
def test_coefficients_are_equation_32_with_the_arch_in_it(beta, ratio, n, direction):
    ring = arch(beta, ratio, n)
    wide = np.radians(beta)
    scan = Scan(wide, ratio, [k * wide / n for k, _ in Voussoirs(wide, ratio, n).thrust()[1]])
    phi = np.array([0.0, 0.2, 0.5, 0.9]) * ring.limit(direction)
    got = ring.coefficients(phi, direction)
    expected = np.array([[*scan.eq_39(x)[:2], scan.G(x), scan.eq_39(x)[3]] for x in phi]).T
    for name, values in zip("IJGB", expected, strict=True):
        scale = np.maximum(np.abs(values), np.abs(values[0]))
        assert getattr(got, name) / scale == approx(values / scale, abs=1e-9), name


# --- what cannot rock ------------------------------------------------------------------------------------------------


@cache
def least_by_statics(beta, n):
    """Least t/r with a thrust line of the weight alone inside the ring, by bisection; for n joints."""
    low, high = 1e-3, 0.12
    while high - low > 1e-7:
        middle = (low + high) / 2
        low, high = (middle, high) if Voussoirs(beta, middle, n).thrust()[0] == "infeasible" else (low, middle)
    return high


def test_a_semicircle_thinner_than_0_1075_is_refused_with_the_least_thickness():
    with pytest.raises(InputError, match=r"0\.1075"):
        arch(180.0, 0.1074)
    with pytest.raises(InputError, match=r"at least 1\.07[45]\d* m"):
        arch(180.0, 0.09, radius=10.0)
    slightly = arch(180.0, 0.1076)
    assert 0 < slightly.uplift(POSITIVE) < 1e-3


@pytest.mark.every(2)
@pytest.mark.parametrize(("beta", "n"), [(180.0, None), (180.0, 12), (150.0, None), (150.0, 9), (120.0, 40)])
def test_the_least_thickness_is_that_of_statics(beta, n):
    least = least_by_statics(np.radians(beta), n or MANY)
    with pytest.raises(InputError) as caught:
        arch(beta, 0.9 * least, n, radius=100.0)
    said = float(str(caught.value).split("at least ")[1].split(" m")[0]) / 100
    assert said == approx(least, abs=2e-6)
    assert said >= least - 1e-7  # rounded up: what it says is enough
    arch(beta, said, n, radius=100.0)
    with pytest.raises(InputError):
        arch(beta, 0.999 * least, n, radius=100.0)


@pytest.mark.parametrize(("beta", "ratio", "n"), [(60.0, 0.4, None), (40.0, 0.3, 10), (20.0, 0.2, 3), (90.0, 0.59, 8)])
def test_an_arch_that_no_push_can_open_is_an_error(beta, ratio, n):
    assert Voussoirs(np.radians(beta), ratio, n or 200).thrust()[0] == "unbounded"
    with pytest.raises((MechanismError, InputError), match="too thick"):
        equivalent_block(arch(beta, ratio, n))


# Random and near the edges; found with a wider search, kept where something once went wrong.
def sweep():
    rng = np.random.default_rng(4000)
    for beta in (20.0, 40.0, 60.0, 80.0, 90.0, 105.0, 120.0, 135.0, 150.0, 165.0, 180.0):
        for n in (None, 3, 4, 7, 16, 60):
            for ratio in np.exp(rng.uniform(np.log(0.01), np.log(0.6), 1 if n is None else 2)):
                yield beta, float(ratio), n
    for beta in (150.0, 180.0):  # whose least thickness is looked for above
        for n in (None, 5, 20):
            for over in (1e-5, 1e-3, 1e-2):
                yield beta, least_by_statics(np.radians(beta), n or MANY) * (1 + over), n


def outcome(beta, ratio, n):
    """What the constructor and uplift say: a number, "infeasible" or "unbounded", and the message."""
    try:
        return arch(beta, ratio, n).uplift(POSITIVE), ""
    except (InputError, MechanismError) as error:
        return "infeasible" if "too thin to stand" in str(error) else "unbounded", str(error)


@pytest.fixture(scope="module")
def swept():
    """Each ring of the sweep with the static answer, its hinges, and the project's."""
    rows = []
    for beta, ratio, n in sweep():
        static, hinges = Voussoirs(np.radians(beta), ratio, n or MANY).thrust()
        rows.append(((beta, ratio, n), static, hinges, *outcome(beta, ratio, n)))
    return rows


def is_four_hinges(hinges, n):
    """Whether a static collapse mechanism is one of four hinges I, E, I, E at four joints.

    Very strong pushes lift the arch off its left springing instead (both faces of joint 0), or throw up its middle
    (faces E, I, I, E): there lambda is finite, but no four-hinge mechanism of three links has it.
    """
    return len({joint for joint, _ in hinges}) == 4 and [face for _, face in hinges] == list("IEIE")


def test_wherever_four_hinges_form_lambda_is_the_static_multiplier(swept):
    checked = 0
    for ring, static, hinges, got, message in swept:
        if isinstance(static, str) or not is_four_hinges(hinges, ring[2]):
            continue
        assert not isinstance(got, str), (ring, static, message)
        assert got == approx(static, rel=1e-9 if ring[2] else 1e-5, abs=1e-10 if ring[2] else 1e-6), ring
        checked += 1
    assert checked > 60


def test_an_arch_too_thin_to_stand_is_always_called_too_thin(swept):
    wrong = [(ring, message) for ring, static, _, got, message in swept if static == "infeasible" and got != static]
    assert sum(static == "infeasible" for _, static, *_ in swept) > 10
    assert not wrong


def test_an_arch_that_cannot_hinge_is_always_refused(swept):
    refused = [
        (ring, got)
        for ring, static, hinges, got, _ in swept
        if static == "unbounded" or (static != "infeasible" and not is_four_hinges(hinges, ring[2]))
    ]
    assert len(refused) > 20
    assert [row for row in refused if row[1] != "unbounded"] == []


def test_a_refusal_says_why(swept):
    # "did not settle" is a failure of the search, not a property of the arch.
    assert [(ring, message) for ring, *_, message in swept if "did not settle" in message] == []


# Rings that stand for nothing but their trouble: shallow and thin, where the first guess of the hinges fails.
@pytest.mark.parametrize(
    ("beta", "ratio", "n"),
    [(106.987, 0.0128, 7), (96.33, 0.0092, None), (116.29, 0.0198, 52), (120.0, 0.015, None), (137.79, 0.01184, 5)],
)
def test_a_very_thin_arch_is_too_thin_not_too_thick(beta, ratio, n):
    assert Voussoirs(np.radians(beta), ratio, n or MANY).thrust()[0] == "infeasible"
    with pytest.raises(InputError, match="too thin to stand"):
        arch(beta, ratio, n)


# The static collapse of these lifts the left springing off (normal force zero there): lambda is finite, four hinges
# do not have it, and the reason must be said.
@pytest.mark.parametrize(
    ("beta", "ratio", "n"),
    [(20.33, 0.01087, 17), (60.34, 0.07193, 6), (56.28, 0.0899, None), (121.09, 0.5479, 38), (85.24, 0.2019, 26)],
)
def test_an_arch_that_lifts_off_its_springing_is_refused_with_a_reason(beta, ratio, n):
    static, hinges = Voussoirs(np.radians(beta), ratio, n or MANY).thrust()
    assert static > 2
    assert not is_four_hinges(hinges, n)
    with pytest.raises((MechanismError, InputError)) as caught:
        arch(beta, ratio, n)
    assert "did not settle" not in str(caught.value)

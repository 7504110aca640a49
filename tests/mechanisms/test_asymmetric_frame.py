"""The asymmetric frame against the paper's Eqs. 27-38, written out here; 27, 32 and 33 corrected.

In the paper's varphi (angle of AB, anticlockwise) the rocking rotation is phi = s (varphi_0 - varphi), so that with
the scan's G_nl and J_nl: G = s G_nl, J = s J_nl, while I and B keep their sign.
"""

from types import SimpleNamespace

import numpy as np
import pytest
import sympy as sp
from pytest import approx
from scipy.optimize import brentq

from mechanisms.asymmetric_frame import AsymmetricFrame
from mechanisms.symmetric_frame import SymmetricFrame
from rocking_cli.core import Direction, equivalent_block
from tests.core.test_lagrange import Piece, agrees, point, t, turned
from tests.reference_mechanics import deviation

CASES = range(8)
BOTH = list(Direction)


def fields(case):
    """A random frame, by masses or by density."""
    rng = np.random.default_rng(3000 + case)
    width = rng.uniform(0.3, 1.5)
    left = rng.uniform(3.0, 12.0)
    values = {
        "column_width": width,
        "left_height": left,
        "right_height": left * rng.uniform(0.6, 1.6),
        "spacing": width * rng.uniform(1.3, 10.0),
        "beam_depth": rng.uniform(0.1, 2.5),
        "gravity": rng.uniform(5.0, 15.0),
    }
    if case % 2:
        values |= {"left_mass": rng.uniform(0.1, 5), "beam_mass": rng.uniform(0, 10), "right_mass": rng.uniform(0.1, 5)}
    else:
        values |= {"density": rng.uniform(500.0, 3000.0), "depth": rng.uniform(0.2, 2.0)}
    return values


class Scan:
    """The paper's equations for one frame and one direction, s = +1 or -1."""

    def __init__(self, values, s):
        v = SimpleNamespace(**{"density": None, **values})
        self.s = s
        self.b, self.H, self.H1 = v.column_width / 2, v.left_height / 2, v.right_height / 2
        self.L, self.h = v.spacing, v.beam_depth / 2
        b, H, H1, L, h = self.b, self.H, self.H1, self.L, self.h
        if v.density is None:
            self.m_AB, self.m_BC, self.m_CD = v.left_mass, v.beam_mass, v.right_mass
        else:
            per_area = v.density * v.depth
            self.m_AB, self.m_CD = 4 * b * H * per_area, 4 * b * H1 * per_area
            self.m_BC = (L + 2 * b) * 2 * h * per_area
        self.R0, self.R1 = np.hypot(b, H), np.hypot(b, H1)
        self.a, self.d = complex(s * b, 0), complex(L + s * b, 2 * H - 2 * H1)
        self.r0, self.phi_AD = abs(self.d - self.a) / 2, np.angle(self.d - self.a)
        self.r_BC, self.psi_BC = np.hypot(L / 2 + s * b, h), np.arctan(h / (L / 2 + s * b))
        self.varphi_0 = np.pi / 2 + s * np.arctan(b / H)
        self.I_AB, self.I_CD = 4 / 3 * self.m_AB * self.R0**2, 4 / 3 * self.m_CD * self.R1**2
        self.I_BC = self.m_BC * (self.r_BC**2 + ((L + 2 * b) ** 2 + (2 * h) ** 2) / 12)

    def angles(self, phi):
        """Eq. 27 with atan2 and |AB| = 2 R0, |CD| = 2 R1, |AD| = 2 r0."""
        v = self.varphi_0 - self.s * phi
        R0, R1, r0, L = self.R0, self.R1, self.r0, self.L
        x, y = 2 * (R0 * np.cos(v) - r0 * np.cos(self.phi_AD)), 2 * (R0 * np.sin(v) - r0 * np.sin(self.phi_AD))
        bd = np.hypot(x, y)
        v_CD = np.arctan2(y, x) - np.arccos((bd * bd + 4 * R1 * R1 - L * L) / (4 * R1 * bd))
        v_BC = np.arctan2(2 * R1 * np.sin(v_CD) - y, 2 * R1 * np.cos(v_CD) - x)
        return v, v_BC, v_CD

    def rates(self, phi):
        """Eqs. 28-29 by the sine rule: f_BC = 2 R0 sin(AB - CD)/(L sin(CD - BC)), likewise f_CD, and derivatives."""
        v, v_BC, v_CD = self.angles(phi)
        sine, cosine = np.sin(v_CD - v_BC), np.cos(v_CD - v_BC)
        f_BC = 2 * self.R0 / self.L * np.sin(v - v_CD) / sine
        f_CD = self.R0 / self.R1 * np.sin(v - v_BC) / sine
        cot = cosine / sine * (f_CD - f_BC)
        df_BC = 2 * self.R0 / self.L * np.cos(v - v_CD) * (1 - f_CD) / sine - f_BC * cot
        df_CD = self.R0 / self.R1 * np.cos(v - v_BC) * (1 - f_BC) / sine - f_CD * cot
        return f_BC, f_CD, df_BC, df_CD

    def coefficients(self, phi):
        """Eq. 32, corrected, in phi."""
        v, v_BC, v_CD = self.angles(phi)
        f, k, df, dk = self.rates(phi)
        turn = v - v_BC - self.psi_BC
        arm = self.m_BC * self.r_BC
        inertia = (
            self.I_AB + self.I_BC * f**2 + self.I_CD * k**2
            + self.m_BC * 4 * self.R0 * (self.R0 + self.r_BC * np.cos(turn) * f)
        )  # fmt: skip
        J = -(
            self.I_BC * f * df + self.I_CD * k * dk
            + 2 * self.R0 * arm * (np.cos(turn) * df - np.sin(turn) * (1 - f) * f)
        )  # fmt: skip
        G = -(
            (self.m_AB + 2 * self.m_BC) * self.R0 * np.cos(v) + arm * np.cos(v_BC + self.psi_BC) * f
            + self.m_CD * self.R1 * np.cos(v_CD) * k
        )  # fmt: skip
        B = (
            self.m_AB * self.R0 * np.sin(v) + self.m_CD * self.R1 * np.sin(v_CD) * k
            + self.m_BC * 2 * self.R0 * np.sin(v) + arm * np.sin(v_BC + self.psi_BC) * f
        )  # fmt: skip
        return inertia, self.s * J, self.s * G, B

    def eq_33(self):
        """Uplift, as corrected in section 6 of the theory."""
        b, H, H1, L, h, s = self.b, self.H, self.H1, self.L, self.h, self.s
        q = H / H1
        return (
            (b / H)
            * (self.m_AB + (1 + q - s * (2 * b / L) * (1 - q)) * self.m_BC + q * self.m_CD)
            / (self.m_AB + 2 * (1 + s * b * h / (L * H) * (1 - q)) * self.m_BC + self.m_CD)
        )

    def eq_34(self, phi):
        """Zero at the critical rotation; multiplied by m_BC, which may be zero."""
        v, v_BC, v_CD = self.angles(phi)
        return (
            (self.m_AB + 2 * self.m_BC) * np.sin(v_CD - v_BC) * np.cos(v)
            + self.m_CD * np.sin(v - v_BC) * np.cos(v_CD)
            + self.m_BC * np.sin(v - v_CD)
            * (np.cos(v_BC) * (1 + self.s * 2 * self.b / self.L) - 2 * self.h / self.L * np.sin(v_BC))
        )  # fmt: skip

    def critical(self, end):
        """First root of Eq. 34 before `end`."""
        grid = np.linspace(0.0, end * (1 - 1e-6), 400)  # at the end itself Eq. 27 is at the edge of its arccos
        signs = np.sign(self.eq_34(grid))
        first = np.flatnonzero(signs[1:] != signs[:-1])[0]
        return brentq(self.eq_34, grid[first], grid[first + 1], xtol=1e-15, rtol=1e-15)

    def eq_38(self, phi):
        v, v_BC, v_CD = self.angles(phi)
        f, k, df, dk = self.rates(phi)
        inertia, _, _, B = self.coefficients(phi)
        arm = self.m_BC * self.r_BC
        G = -(
            arm * (np.cos(v_BC + self.psi_BC) * df - np.sin(v_BC + self.psi_BC) * f**2)
            + self.m_CD * self.R1 * (np.cos(v_CD) * dk - np.sin(v_CD) * k**2)
            - (self.m_AB + 2 * self.m_BC) * self.R0 * np.sin(v)
        )
        return inertia, G, B


def rotations(frame, direction):
    return np.array([0.0, 0.03, 0.1, 0.2, 0.35, 0.5, 0.7, 0.85, 0.93]) * frame.limit(direction)


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("direction", BOTH)
def test_coefficients_are_the_corrected_equation_32(case, direction):
    frame = AsymmetricFrame(**fields(case))
    phi = rotations(frame, direction)
    got = frame.coefficients(phi, direction)
    expected = Scan(fields(case), int(direction)).coefficients(phi)
    for name, values in zip("IJGB", expected, strict=True):
        # Scaled point by point up to rest's size: towards the locking of the linkage I and J grow without bound.
        scale = np.maximum(np.abs(values), np.abs(values[0]))
        assert deviation(getattr(got, name) / scale, values / scale, 1.0) < 1e-10, name


@pytest.mark.every(8)
@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("direction", BOTH)
def test_equivalent_block_is_equations_33_34_and_38(case, direction):
    frame = AsymmetricFrame(**fields(case))
    scan = Scan(fields(case), int(direction))
    got = equivalent_block(frame)[direction]
    assert frame.uplift(direction) == approx(scan.eq_33(), rel=1e-10)
    assert got.lambda_ == approx(scan.eq_33(), rel=1e-10)
    phi_cr = scan.critical(frame.limit(direction))
    assert frame.critical_rotation(direction) == approx(phi_cr, rel=1e-10)
    inertia, G, B = scan.eq_38(phi_cr)
    assert got.phi_cr == approx(phi_cr, rel=1e-10)
    assert got.I_eq == approx(inertia, rel=1e-10)
    assert got.G_eq == approx(G, rel=1e-10)
    assert got.B_eq == approx(B, rel=1e-10)
    assert got.p == approx(np.sqrt(frame.gravity * G / inertia), rel=1e-10)
    assert got.kappa1 == approx(B / G, rel=1e-10)
    assert got.kappa2 == approx(phi_cr / scan.eq_33(), rel=1e-10)
    assert got.lambda_lin == approx(phi_cr * G / B, rel=1e-10)
    assert (got.theta_cr1, got.theta_cr2) == approx((got.lambda_lin, got.lambda_), rel=1e-10)


def first_root(function, end):
    """First root on (0, end], or infinity."""
    grid = np.linspace(0.0, end, 4001)
    changes = np.flatnonzero(np.diff(np.sign(function(grid))))
    if not changes.size:
        return np.inf
    return brentq(function, grid[changes[0]], grid[changes[0] + 1], xtol=1e-15)


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("direction", BOTH)
def test_the_limit_is_where_the_linkage_locks_or_a_column_lies(case, direction):
    scan = Scan(fields(case), int(direction))

    def reach(phi):  # cosine of the angle at D in the triangle B-C-D: beyond 1 it does not close
        bd = abs(scan.a + 2 * scan.R0 * np.exp(1j * (scan.varphi_0 - direction * phi)) - scan.d)
        return abs(bd**2 + 4 * scan.R1**2 - scan.L**2) / (4 * scan.R1 * bd) - 1

    def right_column(phi):  # it lies on its side after a quarter turn, as the left one does
        v_CD = scan.angles(phi)[2]
        return direction * (scan.angles(0.0)[2] - v_CD) - np.pi / 2

    locks = first_root(reach, np.pi / 2)
    lies = first_root(right_column, min(locks, np.pi / 2) * (1 - 1e-9))
    limit = AsymmetricFrame(**fields(case)).limit(direction)
    assert limit == approx(min(locks, lies, np.pi / 2), rel=1e-9)


@pytest.mark.parametrize("case", range(4))
def test_equal_columns_are_the_symmetric_frame(case):
    values = fields(case)
    rng = np.random.default_rng(case)
    left, beam = rng.uniform(0.5, 3.0), rng.uniform(0.0, 9.0)
    frame = AsymmetricFrame(
        column_width=values["column_width"], left_height=values["left_height"], right_height=values["left_height"],
        spacing=values["spacing"], beam_depth=values["beam_depth"],
        left_mass=left, beam_mass=beam, right_mass=left,
    )  # fmt: skip
    symmetric = SymmetricFrame(
        column_width=values["column_width"], column_height=values["left_height"], mass_ratio=beam / (2 * left)
    )
    got, expected = equivalent_block(frame), equivalent_block(symmetric)
    total = 2 * left + beam  # the symmetric frame is per kilogram
    for direction in BOTH:
        one, two = got[direction].as_dict(), expected[direction].as_dict()
        for name in ("I_eq", "G_eq", "B_eq"):
            two[name] *= total
        assert one == approx(two, rel=1e-13 * 20)
        alpha = np.arctan(values["column_width"] / values["left_height"])
        assert one["phi_cr"] == approx(alpha, rel=2e-13)  # Eqs. 36-37
        assert one["lambda"] == approx(np.tan(alpha), rel=2e-13)
    phi = np.linspace(0.0, 1.2, 7)
    for direction in BOTH:
        one, two = frame.coefficients(phi, direction), symmetric.coefficients(phi, direction)
        for name in "IGBV":
            assert deviation(getattr(one, name), total * getattr(two, name)) < 1e-12
        assert deviation(one.J, 0 * phi, one.I.max()) < 1e-12
    assert got.symmetric


def test_lagranges_equation_in_symbols_gives_the_coefficients():
    """No closed form of the linkage: the three rotations are coordinates, the loop closure is two constraints."""
    b, H, H1, L, h = 0.5, 3.0, 3.75, 8.0, 0.6
    frame = AsymmetricFrame(
        column_width=2 * b, left_height=2 * H, right_height=2 * H1, spacing=L, beam_depth=2 * h,
        left_mass=2.0, beam_mass=5.0, right_mass=3.0,
    )  # fmt: skip
    turns = phi, beam, right = tuple(sp.Function(name)(t) for name in ("phi", "beam", "right"))
    # Positive direction: A and D are right foot corners, B and C left top corners.
    a, d = point(complex(b)), point(complex(L + b, 2 * H - 2 * H1))
    B = a + turned(complex(-2 * b, 2 * H), -phi)
    loop = B + turned(complex(L), beam) - d - turned(complex(-2 * b, 2 * H1), right)
    pieces = [
        Piece(m, m * (wide**2 + high**2) / 12, place, turn)
        for m, wide, high, place, turn in (
            (2.0, 2 * b, 2 * H, a + turned(complex(-b, H), -phi), phi),
            (5.0, L + 2 * b, 2 * h, B + turned(complex(L / 2 + b, h), beam), beam),
            (3.0, 2 * b, 2 * H1, d + turned(complex(-b, H1), right), right),
        )
    ]
    phis = [0.02, 0.1, 0.3]
    agrees(frame.coefficients(np.array(phis), Direction.POSITIVE), turns, pieces, list(loop), phis)

"""Reference mechanics for the tests, written from first principles; it imports nothing of the project.

Points are x + iy, rotations anticlockwise, and a rocking rotation phi >= 0 turns clockwise when s = +1.
"""

import cmath
from itertools import pairwise

import numpy as np
from scipy.optimize import linprog

HIGHS = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}


def cross(u, v):
    """The z component of u x v."""
    return (np.conj(u) * v).imag


def deviation(values, expected, scale=None):
    """Greatest difference, over the greatest expected value unless a scale is given."""
    values, expected = np.asarray(values), np.asarray(expected)
    return float(np.abs(values - expected).max() / (np.abs(expected).max() if scale is None else scale))


def derivative(f, x, h):
    """f'(x) by the central difference of sixth order."""
    return sum(w * (f(x + k * h) - f(x - k * h)) for k, w in ((1, 45), (2, -9), (3, 1))) / (60 * h)


def polygon_moments(vertices):
    """Area, centroid and polar moment of inertia about the centroid (unit density), from horizontal slices.

    Between two vertex heights the ends of a slice are linear in y, so four Gauss points are exact.
    """
    z = np.asarray(vertices, complex)
    nodes, weights = np.polynomial.legendre.leggauss(4)
    heights = np.unique(z.imag)
    total = np.zeros(5)
    for low, high in pairwise(heights):
        for node, weight in zip(nodes, weights, strict=True):
            y, dy = (low + high + (high - low) * node) / 2, weight * (high - low) / 2
            ends = sorted(
                a.real + (y - a.imag) / (b.imag - a.imag) * (b.real - a.real)
                for a, b in zip(z, np.roll(z, -1), strict=True)
                if (a.imag < y) != (b.imag < y)
            )
            for left, right in zip(ends[::2], ends[1::2], strict=True):
                width = right - left
                x2 = (right**3 - left**3) / 3
                total += dy * np.array([width, (right**2 - left**2) / 2, width * y, x2, width * y**2])
    area, x, y, xx, yy = total
    centroid = complex(x, y) / area
    return area, centroid, xx + yy - area * abs(centroid) ** 2


def sector_moments(inner, outer, start, end):
    """Area, first moment (complex) and polar moment about the centre of an annular sector, by Gauss quadrature."""
    nodes, weights = np.polynomial.legendre.leggauss(24)
    theta = (start + end) / 2 + (end - start) / 2 * nodes
    rho = (inner + outer) / 2 + (outer - inner) / 2 * nodes
    cell = np.outer(weights * rho * (outer - inner) / 2, weights * abs(end - start) / 2)
    z = np.outer(rho, np.exp(1j * theta))
    return cell.sum(), (cell * z).sum(), (cell * abs(z) ** 2).sum()


def link_rates(a, b, c, d, rate):
    """Rates of BC and CD of a four-bar A-B-C-D whose AB turns at `rate`: the velocity of D vanishes."""
    matrix = np.array([[(c - b).real, (d - c).real], [(c - b).imag, (d - c).imag]])
    return np.linalg.solve(matrix, -rate * np.array([(b - a).real, (b - a).imag]))


class FourBar:
    """A four-bar A-B-C-D followed from rest by Newton's method on its loop closure.

    `angles` are those of AB, BC and DC to the x axis; the paper's varphi, varphi_BC and varphi_CD.
    """

    def __init__(self, a, b, c, d, s):
        self.a, self.d, self.s = a, d, s
        self.lengths = abs(b - a), abs(c - b), abs(c - d)
        self.rest = np.angle(b - a), np.angle(c - b), np.angle(c - d)

    def angles(self, phi):
        """Angles at the rotation phi of AB, continued from rest so that the branch is that of the rest geometry."""
        l1, l2, l3 = self.lengths
        first, two, three = self.rest
        steps = int(abs(phi) / 0.1) + 2
        for one in first - self.s * np.linspace(0.0, phi, steps):
            for _ in range(50):
                u, v = l2 * cmath.exp(1j * two), l3 * cmath.exp(1j * three)
                gap = self.a + l1 * cmath.exp(1j * one) + u - self.d - v
                # gap + i u dtwo - i v dthree = 0, crossed with v and with u.
                area = cross(u, v)
                step_two, step_three = cross(1j * gap, v) / area, cross(1j * gap, u) / area
                two, three = two + step_two, three + step_three
                if abs(step_two) + abs(step_three) < 1e-15:
                    break
        return one, two, three

    def rates(self, angles):
        """f_BC, f_CD and their derivatives in varphi: the sine rule of the velocities, and its derivative by hand."""
        l1, l2, l3 = self.lengths
        one, two, three = angles
        sine, cosine = np.sin(three - two), np.cos(three - two)
        f_bc = l1 / l2 * np.sin(one - three) / sine
        f_cd = l1 / l3 * np.sin(one - two) / sine
        turn = f_cd - f_bc
        df_bc = l1 / l2 * (np.cos(one - three) * (1 - f_cd) * sine - np.sin(one - three) * cosine * turn) / sine**2
        df_cd = l1 / l3 * (np.cos(one - two) * (1 - f_bc) * sine - np.sin(one - two) * cosine * turn) / sine**2
        return f_bc, f_cd, df_bc, df_cd


class Voussoirs:
    """A ring of centre-line radius 1 cut into n equal voussoirs, thrown to the right; total weight 1.

    Joint k is at the angle k beta/n from the left springing. `ratio` is t/r.
    """

    def __init__(self, beta, ratio, n):
        self.n, self.ratio = n, ratio
        self.psi = np.linspace(0.0, beta, n + 1)
        self.radial = np.exp(1j * (np.pi / 2 + beta / 2 - self.psi))
        self.tangent = -1j * self.radial  # to the right of the joint
        # All voussoirs are one voussoir turned about the centre, so one quadrature serves.
        area, first, _ = sector_moments(1 - ratio / 2, 1 + ratio / 2, 0.0, beta / n)
        self.weight = 1 / n
        self.centroid = first / area * np.exp(1j * (np.pi / 2 + beta / 2 - self.psi[1:]))

    def thrust(self):
        """Greatest horizontal multiplier for which equilibrium is possible with the thrust inside every joint.

        Four unknowns: the reaction at the left springing (force, moment) and lambda. The force and moment at a joint
        follow by summing the loads to its left. Returns lambda, or "infeasible" or "unbounded", and the collapse
        mechanism: the (joint, face) whose constraints carry the dual solution, from the left springing; "I" is a hinge
        on the intrados. Both faces of one joint mean that it parts.
        """
        w, n = self.weight, self.n
        count = np.arange(n + 1)
        x = np.concatenate([[0.0], np.cumsum(w * self.centroid.real)])
        y = np.concatenate([[0.0], np.cumsum(w * self.centroid.imag)])
        one, none = np.ones(n + 1), np.zeros(n + 1)
        # Each row times (Fx, Fy, M0, lambda, 1): force and moment about the centre that act across a joint.
        force_x = np.stack([one, none, none, count * w, none])
        force_y = np.stack([none, one, none, none, -count * w])
        moment = np.stack([none, none, one, -y, -x])
        normal = force_x * self.tangent.real + force_y * self.tangent.imag
        # The thrust N at the radius 1 + e has the moment -N (1 + e); |e| <= t/2 also makes N >= 0.
        upper = -moment - (1 + self.ratio / 2) * normal
        lower = moment + (1 - self.ratio / 2) * normal
        rows = np.concatenate([upper.T, lower.T])
        free = [(None, None)] * 3 + [(0, None)]
        value, duals = _solve(np.array([0.0, 0.0, 0.0, -1.0]), rows[:, :4], -rows[:, 4], free)
        if isinstance(value, str):
            return value, []
        active = np.flatnonzero(np.abs(duals) > 1e-9 * np.abs(duals).max())
        return value, sorted((int(k % (n + 1)), "EI"[k // (n + 1)]) for k in active)


def _solve(cost, inside, most, bounds):
    for presolve in (True, False):  # with presolve HiGHS may fail to tell infeasible from unbounded
        answer = linprog(cost, inside, most, bounds=bounds, options={**HIGHS, "presolve": presolve})
        if answer.status in (0, 2, 3):
            break
    if answer.status == 0:
        return -answer.fun, answer.ineqlin.marginals
    return {2: "infeasible", 3: "unbounded"}[answer.status], None

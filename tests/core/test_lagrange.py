"""I, J, G and B of wall and arch from T and V by Lagrange's equation in symbols: no code and no formula is shared.

Each link's rotation is a coordinate of its own, and what holds the links together are constraints with multipliers.
"""

from dataclasses import dataclass
from itertools import pairwise
from math import hypot

import mpmath
import numpy as np
import pytest
import sympy as sp

from mechanisms.arch import Arch
from mechanisms.wall import Wall
from rocking_cli.core import Direction

t, g = sp.symbols("t g")
u = sp.Function("u")(t)  # displacement of the ground


def turned(z, angle):
    """A plane vector, given as a complex number, turned anticlockwise."""
    x, y = sp.Float(z.real, 20), sp.Float(z.imag, 20)
    return sp.Matrix([x * sp.cos(angle) - y * sp.sin(angle), x * sp.sin(angle) + y * sp.cos(angle)])


def point(z):
    return sp.Matrix([sp.Float(z.real, 20), sp.Float(z.imag, 20)])


@dataclass
class Piece:
    """A rigid piece: mass, central inertia, place and rotation as expressions of the coordinates."""

    mass: float
    inertia: float
    place: sp.Matrix
    angle: sp.Expr


def agrees(got, turns, pieces, constraints, phis):
    """Whether the coefficients over `phis` are those of the pieces; the first of `turns` is phi, all zero at rest."""
    T = V = sp.Integer(0)
    for piece in pieces:
        velocity = piece.place.diff(t) + sp.Matrix([u.diff(t), 0])
        T += piece.mass / 2 * velocity.dot(velocity) + piece.inertia / 2 * piece.angle.diff(t) ** 2
        V += piece.mass * g * piece.place[1]
    pulls = sp.symbols(f"pull:{len(constraints)}")
    equations = [
        T.diff(turn.diff(t)).diff(t) - T.diff(turn) + V.diff(turn)
        - sum(pull * constraint.diff(turn) for pull, constraint in zip(pulls, constraints, strict=True))
        for turn in turns
    ]  # fmt: skip
    equations += [constraint.diff(t, 2) for constraint in constraints]
    n = len(turns)
    x, v, w = (sp.symbols(f"{name}:{count}") for name, count in (("x", n), ("v", n), ("w", n + len(pulls))))
    ground = sp.symbols("ground")

    def plain(expression):
        pairs = [(u.diff(t, 2), ground), (u.diff(t), 0), *zip((turn.diff(t, 2) for turn in turns), w, strict=False)]
        pairs += [*zip(pulls, w[n:], strict=True), *zip((turn.diff(t) for turn in turns), v, strict=True)]
        return expression.subs([*pairs, *zip(turns, x, strict=True)])

    matrix, right = sp.linear_eq_to_matrix([plain(each) for each in equations], w)
    matrix, right = (sp.lambdify((x, v, g, ground), each, "mpmath") for each in (matrix, right))
    close = sp.lambdify((x, v), [plain(each) for each in constraints], "mpmath")
    slip = sp.lambdify((x, v), [plain(each.diff(t)) for each in constraints], "mpmath")
    energy = sp.lambdify((x, v), plain(T), "mpmath")
    with mpmath.workdps(30):
        guess = [mpmath.mpf(0)] * (n - 1)
        for i, phi in enumerate(phis):
            found = mpmath.findroot(lambda *y, phi=phi: close((phi, *y), (0,) * n), guess)
            guess = list(found)
            place = (mpmath.mpf(phi), *guess)
            moved = [slip(place, [int(k == j) for j in range(n)]) for k in range(n)]
            rates = mpmath.lu_solve(
                mpmath.matrix([[moved[k][j] for k in range(1, n)] for j in range(n - 1)]),
                mpmath.matrix([-value for value in moved[0]]),
            )
            turning, still = (1, *rates), (0,) * n

            def acceleration(*state, place=place):
                return float(mpmath.lu_solve(matrix(place, *state), right(place, *state))[0])

            assert got.I[i] == pytest.approx(float(2 * energy(place, turning)), rel=1e-11)
            # I phi.. = - J phi.^2 - g G - s B u_g''
            scale = abs(got.G[0] / got.I[0])
            assert got.J[i] / got.I[i] == pytest.approx(-acceleration(turning, 0, 0), rel=1e-10, abs=1e-10)
            assert got.G[i] / got.I[i] == pytest.approx(-acceleration(still, 1, 0), rel=1e-10, abs=1e-11 * scale)
            assert got.B[i] / got.I[i] == pytest.approx(-acceleration(still, 0, 1), rel=1e-10)


def test_the_wall():
    b, h = 0.15, 0.75  # of one block; the foot pivots on the right face, the mid hinge opens on the left
    wall = Wall(thickness=2 * b, height=4 * h)
    phi, upper = (sp.Function(name)(t) for name in ("phi", "upper"))
    foot, middle, top = complex(b, 0), complex(-b, 2 * h), complex(b, 4 * h)
    hinge = point(foot) + turned(middle - foot, -phi)
    head = hinge + turned(top - middle, upper)
    pieces = [
        Piece(0.5, 0.5 * (b * b + h * h) / 3, point(foot) + turned(1j * h - foot, -phi), phi),
        Piece(0.5, 0.5 * (b * b + h * h) / 3, hinge + turned(3j * h - middle, upper), upper),
    ]
    phis = [0.01, 0.1, 0.25]
    agrees(wall.coefficients(np.array(phis), Direction.POSITIVE), (phi, upper), pieces, [head[0] - foot.real], phis)


@pytest.mark.rest
@pytest.mark.parametrize(("thickness", "angle", "voussoirs"), [(1.5, 157.5, 7), (1.8, 130.0, None)])
def test_the_arch(thickness, angle, voussoirs):
    arch = Arch(radius=10.0, thickness=thickness, inclusion_angle_deg=angle, voussoirs=voussoirs)
    inner, outer, beta = 10.0 - thickness / 2, 10.0 + thickness / 2, np.radians(angle)
    density = 2 / (beta * (outer**2 - inner**2))
    a, b, c, d = arch.hinges(Direction.POSITIVE)
    turns = phi, beam, right = tuple(sp.Function(name)(t) for name in ("phi", "beam", "right"))
    first = point(a) + turned(b - a, -phi)
    loop = first + turned(c - b, beam) - point(d) - turned(c - d, right)
    carried = [(point(a), a, -phi), (first, b, beam), (point(d), d, right)]
    pieces = []
    for (start, stop), (base, hinge, turn) in zip(pairwise(arch.hinge_angles), carried, strict=True):
        mass, centre, inertia = sector(density, inner, outer, start, stop, np.pi / 2 + beta / 2)
        pieces.append(Piece(mass, inertia, base + turned(centre - hinge, turn), turn))
    phis = [0.01, 0.05, 0.1]
    agrees(arch.coefficients(np.array(phis), Direction.POSITIVE), turns, pieces, list(loop), phis)


def sector(density, inner, outer, start, stop, left):
    """Mass, centroid and central inertia of a part of the ring, by Gauss's rule over radius and angle."""
    nodes, weights = np.polynomial.legendre.leggauss(20)
    r = inner + (outer - inner) * (1 + nodes) / 2
    at = left - (start + (stop - start) * (1 + nodes) / 2)
    area = np.outer(r * weights, weights) * (outer - inner) / 2 * (stop - start) / 2 * density
    z = np.outer(r, np.exp(1j * at))
    mass = area.sum()
    centre = complex((area * z).sum() / mass)
    return float(mass), centre, float((area * np.abs(z - centre) ** 2).sum())


def test_the_sector_is_a_ring_if_whole():
    mass, centre, inertia = sector(1.0, 1.0, 2.0, 0.0, 2 * np.pi, 0.0)
    assert mass == pytest.approx(3 * np.pi)
    assert hypot(centre.real, centre.imag) < 1e-12
    assert inertia == pytest.approx(np.pi * 15 / 2)

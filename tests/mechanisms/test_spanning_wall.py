"""The spanning wall: closed forms, Lagrange's equation, the wall without a load, and files that are wrong."""

from math import sqrt

import numpy as np
import pytest
import sympy as sp

from mechanisms.spanning_wall import SpanningWall
from mechanisms.wall import Wall
from rocking_cli.core import Direction, equivalent_block
from rocking_cli.core.structure_file import parse_structure
from rocking_cli.errors import InputError
from rocking_cli.questions.equiv.view import view
from rocking_cli.structure import Structure
from rocking_cli.testing import contract
from tests.core.test_lagrange import Piece, agrees, point, t, turned

POSITIVE, NEGATIVE = Direction
G = 9.80665
T, H = 0.3, 3.0


def wall(rho=1.0, k=0.5, hinge=0.5, **fields):
    """A wall .3 x 3 m with rho times its weight at k t from the face of the positive direction's hinge."""
    given = {
        "overburden": rho * 1000 * T * H * G,
        "overburden_eccentricity": (k - 0.5) * T,
        "density": 1000.0,
        "depth": 1.0,
    }
    return SpanningWall(thickness=T, height=H, hinge=hinge, **{**given, "overburden_inertia": 0.0, **fields})


@pytest.mark.parametrize(
    ("k", "rho", "weakest", "at", "middle"),
    [
        (1, 0.5, 7.4641016, 0.6339746, 8),
        (1, 1, 11.656854, 0.5857864, 12),
        (1, 2, 19.797959, 0.5505103, 20),
        (0.5, 0.5, 5.9494897, 0.7101021, 7),
        (0.5, 1, 9, 2 / 3, 10),
        (0.5, 2, 14.928203, 0.6339746, 16),
    ],
)
def test_lambda_at_the_weakest_hinge_and_at_mid_height(k, rho, weakest, at, middle):
    # Above the face of the foot in one direction is above that of the hinge in the other: there it has no weakest.
    found = wall(rho, k, "weakest", one_sided="positive", rebound=0.5)
    assert found.uplift(POSITIVE) * H / T == pytest.approx(weakest, rel=1e-7)
    assert found.extras(POSITIVE)[0].value == pytest.approx(at, rel=1e-7)
    assert wall(rho, k).uplift(POSITIVE) * H / T == pytest.approx(middle, rel=1e-12)
    for shift in (-0.01, 0.01):
        assert wall(rho, k, found.extras(POSITIVE)[0].value + shift).uplift(POSITIVE) > found.uplift(POSITIVE)


@pytest.mark.parametrize("direction", Direction)
@pytest.mark.parametrize(("rho", "k", "hinge"), [(1.0, 0.5, 0.5), (0.5, 0.7, 0.6), (0.0, 0.5, 0.7)])
def test_its_top_is_held_by_the_force_about_its_foot(rho, k, hinge, direction):
    """Moments of the whole wall about its foot: lambda W h/2 = W t/2 + P (its arm) + R h."""
    found, W = wall(rho, k, hinge), 1000 * T * H * G
    arm = T / 2 - direction * (k - 0.5) * T
    R = found.uplift(direction) * W / 2 - (W * T / 2 + rho * W * arm) / H
    assert {each.key: each.value for each in found.extras(direction)}["top_force"] == pytest.approx(R, rel=1e-9)


@pytest.mark.parametrize(
    ("fields", "lambda_", "phi_cr"),
    [
        ({"k": 1}, 1.2, 0.19739556),
        ({"k": 1, "hinge": "weakest", "one_sided": "positive", "rebound": 0.5}, 1.1656854, 0.16908079),
        ({"k": 0.5}, 1.0, 0.1642801),
        ({"k": 0.5, "support": "pivot"}, 1.0, 0.16514868),
    ],
)
def test_uplift_and_critical_rotation(fields, lambda_, phi_cr):
    found = wall(**fields)
    assert found.uplift(POSITIVE) == pytest.approx(lambda_, rel=1e-7)
    assert found.critical_rotation(POSITIVE) == pytest.approx(phi_cr, rel=1e-7)


@pytest.mark.parametrize(("t", "h"), [(0.3, 3.0), (1.2, 2.0)])
def test_without_a_load_it_is_the_wall(t, h):
    found = SpanningWall(thickness=t, height=h, hinge=0.5, support="pivot")
    known = Wall(thickness=t, height=h)
    one, other = (equivalent_block(each).negative.as_dict() for each in (found, known))
    assert one == pytest.approx(other, rel=1e-12)
    assert found.limit(NEGATIVE) == pytest.approx(known.limit(NEGATIVE), rel=1e-15)


@pytest.mark.parametrize(
    ("e_p", "J", "b", "C_m"), [(0.0, 1869.935, 6877.92, 0.5127572), (0.115, 1964.335, 8027.92, 0.5984911)]
)
def test_the_sums_of_the_new_zealand_guidelines(e_p, J, b, C_m):
    found = SpanningWall(
        thickness=0.23, height=3.6, hinge=0.5, support="pivot", density=18000 / G, depth=1.0,
        overburden=10_000.0, overburden_eccentricity=e_p,
    )  # fmt: skip
    at = found.coefficients(np.zeros(1), POSITIVE)
    assert at.I[0] == pytest.approx(J, abs=5e-4)
    assert at.restoring(G)[0] * G == pytest.approx(b, rel=1e-9)
    assert -at.stiffness(G)[0] * G == pytest.approx(62827.2, rel=1e-9)
    assert found.uplift(POSITIVE) == pytest.approx(C_m, abs=5e-8)


@pytest.mark.every(2)
@pytest.mark.parametrize("direction", Direction)
def test_the_equation_of_motion_is_that_of_lagrange(direction):
    s, xi, load = int(direction), 0.62, 0.04
    found = wall(0.7, 0.5 + load / T, xi, overburden_inertia=1.0)
    phi, upper = (sp.Function(name)(t) for name in ("phi", "upper"))
    foot, middle, top = complex(s * T / 2, 0), complex(-s * T / 2, xi * H), complex(load, H)
    hinge = point(foot) + turned(middle - foot, -s * phi)
    head = hinge + turned(top - middle, s * upper)
    mass = 1000 * T * H

    def piece(share, low, high, base, about, turn):
        place = base + turned(0.5j * (low + high) - about, turn)
        return Piece(share * mass, share * mass * (T**2 + (high - low) ** 2) / 12, place, turn)

    pieces = [
        piece(xi, 0.0, xi * H, point(foot), foot, -s * phi),
        piece(1 - xi, xi * H, H, hinge, middle, s * upper),
        Piece(0.7 * mass, 0.0, head, sp.Integer(0)),
    ]
    at = [0.01, 0.08, 0.2]
    got = found.coefficients(np.array(at), direction)
    # The ground pushes the mass on top against the support that holds it: that is no part of B.
    np.multiply(got.B, s, out=got.B)
    agrees(got, (phi, upper), pieces, [head[0] - load], at)


@pytest.mark.parametrize(
    ("fields", "said"),
    [  # lambda h/t = 2 [1 + rho (1 + k xi/(1 - xi))]/xi, at .5 and at xi = 1/(1 + sqrt(rho k/(1 + rho)))
        ({"rho": 0.315}, ["at 0.743 of the height lambda is 0.4765 g instead of 0.589 g.", "weakest`"]),
        ({"k": 0.8}, ["at 0.613 of the height lambda is 1.066 g instead of 1.12 g", "at 0.76 of the height", "Give `"]),
        ({"rho": 0.0}, ["near the top lambda is 0.2 g instead of 0.4 g.", "Check at which"]),
        ({"k": 1.0}, ["at 0.586 of the height", "near the top lambda is 0.4 g instead of 0.8 g in the negative"]),
        ({"k": 1.3, "rho": 0.3}, ["near the top lambda is 0 g instead of"]),
        ({"hinge": 0.667}, []),
        ({"hinge": 0.69}, []),  # less than 1 % above the weakest
        ({"hinge": "weakest"}, []),
        ({"loads": [{"name": "a", "mass": 5.0, "at": [0, 1], "body": "lower block"}]}, ["is not searched with loads"]),
        ({"crushing": {"strength": 2e6}}, ["is not searched"]),
    ],
)
def test_a_hinge_that_is_not_the_weakest_has_a_caution(fields, said):
    found = wall(**fields).own_caution()
    assert all(each in found for each in said) and bool(found) == bool(said)
    # What it advises is not refused.
    if "Give `hinge: weakest`" in found:
        least = wall(**{**fields, "hinge": "weakest"})
        assert all(f"{least.uplift(direction):.4g} g instead" in found for direction in Direction)
    elif said:
        with pytest.raises(ValueError, match="weakest"):
            wall(**{**fields, "hinge": "weakest"})


def test_an_eccentric_load_cuts_it_into_three():
    found = wall(1.0, 0.8, "weakest")
    assert [body.name for body in found.bodies()] == ["lower block", "middle block", "upper block"]
    for direction, k in zip(Direction, (0.8, 0.2), strict=True):
        xi = 1 / (1 + sqrt(k / 2))
        assert found.extras(direction)[0].value == pytest.approx(xi)
        assert found.uplift(direction) == pytest.approx(2 * T / (xi * H) * (2 + k * xi / (1 - xi)), rel=1e-12)
    data = view(Structure(found)).data["directions"]
    assert data["positive"]["hinge"] < data["negative"]["hinge"]


@pytest.mark.parametrize(
    "structure",
    [
        wall(1.0, 0.8, "weakest"),
        wall(0.3, 0.5, "weakest", support="pivot", overburden_inertia=2 / 3),
        wall(1.0, 1.3, 0.4),  # on a bracket
        wall(2.0, 0.6, 0.9, support=-0.15),
        SpanningWall(thickness=T, height=H, hinge=0.95),
        SpanningWall(thickness=2.0, height=H, hinge=0.2),
        wall(1.0, 0.5, 0.6, loads=[{"name": "shelf", "mass": 50.0, "at": [0.1, 2.0], "body": "upper block"}]),
    ],
)
def test_it_keeps_the_contract(structure):
    assert [each.why for each in contract(structure) if not each.passed] == []


FILE = "mechanism: spanning_wall\nthickness: 0.3\nheight: 3\n"


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ("hinge: 1.2", "w.yaml:4:8: hinge is a share of the height: between 0 and 1, or weakest; got 1.2"),
        ("hinge: weakest", "w.yaml:4:8: hinge: without a load on top the weakest hinge of the positive direction runs"),
        ("hinge: weakest\noverburden: 1.0e-300\nmass: 1000", "w.yaml:4:8: hinge: without a load on top the weakest"),
        ("hinge: 0.5\noverburden: 5 kN", "density is missing: with an overburden"),
        ("hinge: 0.5\nsupport: 0.2", "w.yaml:5:10: support is outside the top of the wall: give at most 0.15 m"),
        (
            "hinge: weakest\noverburden: 5 kN\noverburden_eccentricity: 0.15\nmass: 1000",
            "w.yaml:4:8: hinge: with its load on the hinge's face or beyond the weakest hinge of the negative",
        ),
        (
            "hinge: 0.5\noverburden: 50 kN\noverburden_eccentricity: 0.6\nmass: 1000",
            "w.yaml:6:26: overburden_eccentricity: the wall cannot stand: so far off its face",
        ),
        (
            "hinge: weakest\noverburden: 5 kN\nmass: 1000\nloads: [{name: a, mass: 5, at: [0, 1], body: lower block}]",
            "w.yaml:4:8: hinge: weakest knows of the overburden only",
        ),
    ],
)  # fmt: skip
def test_a_wrong_file_is_told(lines, said):
    with pytest.raises(InputError) as caught:
        parse_structure(FILE + lines + "\n", "w.yaml", "w", {"spanning_wall": SpanningWall})
    assert said in " ".join(str(caught.value).split())

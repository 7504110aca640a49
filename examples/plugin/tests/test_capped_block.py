"""Check the contract of all mechanisms, and a formula by hand."""

from math import atan2, hypot, sqrt, tan

import pytest
from rocking_cli.core import Direction, equivalent_block
from rocking_cli.testing import MechanismContract

from rocking_capped_block import CappedBlock

WIDTH, HEIGHT, GRAVITY = 0.8, 2.0, 9.80665


class TestContract(MechanismContract):
    """All checks of `rocking mechanisms --check`, for extreme values of the fields."""

    @pytest.fixture(params=[0.0, 0.5, 10.0])
    def structure(self, request):
        return CappedBlock(width=WIDTH, height=HEIGHT, cap_mass=request.param)


@pytest.mark.parametrize("direction", list(Direction))
@pytest.mark.parametrize("cap", [0.0, 0.5])
def test_it_rocks_as_one_rigid_body(cap, direction):
    """Compare with centroid and inertia of both parts by hand, without code of the mechanism."""
    mass, b = 1 + cap, WIDTH / 2
    y = (HEIGHT / 2 + cap * HEIGHT) / mass
    inertia = (WIDTH**2 + HEIGHT**2) / 12 + (y - HEIGHT / 2) ** 2 + cap * (HEIGHT - y) ** 2
    alpha, radius = atan2(b, y), hypot(b, y)

    structure = CappedBlock(width=WIDTH, height=HEIGHT, cap_mass=cap)
    found = equivalent_block(structure)[direction]
    assert found.phi_cr == pytest.approx(alpha)
    assert found.lambda_ == pytest.approx(tan(alpha))
    assert found.p == pytest.approx(sqrt(mass * GRAVITY * radius / (inertia + mass * radius**2)))
    # Angular momentum about the new pivot, before and after the impact.
    assert found.eta == pytest.approx((inertia + mass * (y**2 - b**2)) / (inertia + mass * radius**2))

"""Where a release may start: short of the critical rotation, or of the limit where there is none."""

import pytest

import rocking_cli as rk
from rocking_cli.errors import InputError
from rocking_cli.structure import Structure
from rocking_cli.studies.neighbours import Release

BLOCK = Structure(rk.Block(width=0.7, height=2.8))
PHI_CR = 0.24497866312686414  # atan(0.7/2.8)


@pytest.mark.parametrize("tilt", [0.999, -0.999, "0.5", "1e-9"])
def test_a_fraction_is_that_of_the_critical_rotation(tilt):
    assert Release.of(tilt).ratio(BLOCK) == float(tilt)


@pytest.mark.parametrize("tilt", [0, 1, -1, 1.001, "1", "0rad", "3.15rad", "-180 deg"])
def test_upright_and_overturned_are_no_releases(tilt):
    with pytest.raises(InputError, match="between 0"):
        Release.of(tilt)


@pytest.mark.parametrize("sign", [1, -1])
def test_an_angle_is_short_of_the_critical_rotation(sign):
    assert Release.of(f"{sign * 0.1}rad").ratio(BLOCK) == pytest.approx(sign * 0.1 / PHI_CR, rel=1e-12)
    assert abs(Release.of(f"{sign * 0.24497}rad").ratio(BLOCK)) < 1
    with pytest.raises(InputError, match="beyond its critical rotation"):
        Release.of(f"{sign * 0.24498}rad").ratio(BLOCK)
    with pytest.raises(InputError, match="in the positive direction only"):
        Release.of("-0.1rad").ratio(Structure(rk.Block(width=0.7, height=2.8, one_sided="positive", rebound=0.3)))

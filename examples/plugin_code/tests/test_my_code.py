"""Check the contract of all codes, and numbers by hand."""

import pytest
import rocking_cli as rk
from rocking_cli.testing import CodeContract

SITE = {"code": "my_code", "a_service": 0.1, "a_ultimate": 0.4, "importance": 1.2}


class TestContract(CodeContract):
    """The code is installed and complete, and its starter, verdicts and output hold together."""

    key = "my_code"


def test_numbers_by_hand():
    """A block uplifts at its width over its height, in either direction."""
    answer = rk.verify(rk.Block(width=0.6, height=2.0), SITE)
    for each in answer.directions.values():
        assert each.methods["service"].capacity == pytest.approx(0.3)
        assert each.methods["service"].demand == pytest.approx(0.12)
        assert each.methods["ultimate"].capacity == pytest.approx(0.6)
        assert each.methods["ultimate"].demand == pytest.approx(0.48)
        assert each.governs == "ultimate"
        assert each.ratio == pytest.approx(1.25)
        assert each.passed


@pytest.mark.parametrize(("width", "passes"), [(0.4801, True), (0.4799, False)])
def test_it_passes_from_the_width_at_which_the_ratio_is_1(width, passes):
    """The ultimate limit state governs: 2 width / height = 1.2 x 0.4."""
    answer = rk.verify(rk.Block(width=width, height=2.0), SITE)
    assert [each.passed for each in answer.directions.values()] == [passes, passes]


def test_a_wrong_value_is_refused_by_its_field():
    with pytest.raises(rk.InputError, match="a_ultimate must be more than 0 g"):
        rk.verify(rk.Block(width=0.6, height=2.0), {**SITE, "a_ultimate": -0.4})

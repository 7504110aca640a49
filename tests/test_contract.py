"""Every installed mechanism, built-in or third-party, keeps the contract: the registry decides, nothing is listed."""

from __future__ import annotations

import pytest

from rocking_cli.cli.new import template
from rocking_cli.registry import Registry
from rocking_cli.structure import load_structure, parse_structure
from rocking_cli.testing import MechanismContract
from tests.conftest import EXAMPLES

BUILT_IN = {"arch", "asymmetric_frame", "block", "cone", "point_mass", "rigid_body", "symmetric_frame", "wall"}


@pytest.mark.parametrize("name", list(Registry()))
class TestEveryInstalledMechanism(MechanismContract):
    """From the file that `rocking new` prints: it must work as it is."""

    @pytest.fixture
    def structure(self, name):
        return parse_structure(template(Registry()[name]), f"{name}.yaml", name)


@pytest.mark.parametrize("file", sorted(path.name for path in EXAMPLES.glob("*.yaml")))
class TestEveryExample(MechanismContract):
    @pytest.fixture
    def structure(self, file):
        return load_structure(EXAMPLES / file)


def test_the_built_in_mechanisms_come_in_through_the_registry():
    assert set(Registry()) >= BUILT_IN


def test_there_is_an_example_of_every_built_in_mechanism():
    assert {load_structure(path).mechanism for path in EXAMPLES.glob("*.yaml")} == BUILT_IN

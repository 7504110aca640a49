"""Plugins written before a structure had `hung` work as they did, unchanged."""

from __future__ import annotations

import importlib.util
from dataclasses import dataclass

import numpy as np
import pytest
from pytest import approx

import rocking_cli as rk
from rocking_cli.codes.italian.chain import Chain
from rocking_cli.core import Direction, equivalent_block
from rocking_cli.testing import MechanismContract, contract
from rocking_cli.views.hung import hung_data, hung_in_words
from tests.conftest import PROJECT
from tests.earlier.pedestal import Pedestal
from tests.earlier.rocking_capped_block import CappedBlock

OWN = {"density": 1900.0, "depth": 1.0, "floor": 400.0}
BAR = {"name": "bar", "from": {"ground": [-3.0, 2.0]}, "to": {"body": "pedestal", "at": [-0.4, 2.0]}}
TIED = {
    "mass": 2000.0,
    "floor": 100.0,
    "ties": [{**BAR, "stiffness": 2e4, "only": "tension"}],
    "loads": [{"name": "sign", "mass": 50.0, "at": [0.0, 2.5], "body": "statue"}],
}
CRUSHED = {**OWN, "crushing": {"strength": 1e6}}
# What the version before gave for lambda, phi_cr, eta, V(.3), the peak over phi_cr under a sine, and what it found.
GAVE = {
    "bare": ({}, 0.2971428571, 0.2888335056, 0.881097561, 0.7404938989, 0.2149137435, [3.0, 1.3]),
    "laden": (OWN, 0.2939434724, 0.2599958073, 0.8888417624, 2102.611442, 0.2346890358, [3.0, 4200.0]),
    "crushed": (
        CRUSHED, 0.2788098185, 0.2471621144, 0.8994323299, 1851.944469, 0.2904122643,
        [3.0, 4200.0, 0.020593965],
    ),
    "tied": (TIED, 0.2898250162, 0.2691833073, 0.8884757901, 5097.491994, 0.2397632963, [3.0, 2150.0]),
}  # fmt: skip


@pytest.mark.parametrize("name", GAVE)
def test_a_plugin_that_uses_all_of_the_earlier_contract_gives_what_it_gave(name):
    fields, uplift, phi_cr, eta, energy, peak, found = GAVE[name]
    made = Pedestal(width=0.8, height=2.0, tall=1.0, friction=0.6, **fields)
    wave = rk.GroundMotion("sine", 0.01, 5 * np.sin(2 * np.pi * np.arange(101) / 100))
    assert made.uplift(Direction.POSITIVE) == approx(uplift, rel=1e-9)
    assert made.critical_rotation(Direction.NEGATIVE) == approx(phi_cr, rel=1e-9)
    assert made.eta(Direction.POSITIVE) == approx(eta, rel=1e-9)
    assert made.potential_energy(np.array([0.3]), Direction.POSITIVE) == approx(energy, rel=1e-9)
    assert rk.respond(made, wave, models="nonlinear")["nonlinear"].peak_ratio == approx(peak, rel=1e-9)
    assert [each.value for each in made.found(Direction.POSITIVE)] == approx(found, rel=1e-9)
    assert [each.check for each in contract(made) if not each.passed] == []


@dataclass(frozen=True)
class Drag:
    """Something attached that this package does not know: a constant moment against the motion [N m]."""

    name: str
    moment: float

    def act(self, total, direction, follow):
        total.Q[:] += self.moment
        total.U[:] += self.moment * total.phi

    def forces(self, direction, follow):
        return ()


class Dragged(Pedestal):
    drag: float = 0.0

    def carries(self):
        return (Drag("drag", self.drag),)


def test_what_a_plugin_attaches_by_a_class_of_its_own_counts_in_statics_and_verification():
    plain, made = (Dragged(width=0.8, height=2.0, tall=1.0, mass=2000.0, drag=drag) for drag in (0.0, 400.0))
    rest = made.coefficients(np.zeros(1), Direction.POSITIVE)
    more = 400.0 / (made.gravity * float(rest.B[0]))
    assert made.uplift(Direction.POSITIVE) == approx(plain.uplift(Direction.POSITIVE) + more, rel=1e-12)
    alpha0 = [Chain(each, Direction.POSITIVE).alpha0 for each in (plain, made)]
    assert alpha0 == approx([plain.uplift(Direction.POSITIVE), made.uplift(Direction.POSITIVE)], rel=1e-12)
    assert rk.equiv(made).to_frame() is not None
    assert list(hung_in_words(made)) == ["With drag: its contribution to the equation of motion."]
    assert hung_data(made) == [{"name": "drag", "kind": "Drag"}]


class TestCappedBlock(MechanismContract):
    @pytest.fixture
    def structure(self):
        return CappedBlock(width=0.8, height=2.0, cap_mass=0.5)


def test_the_example_of_today_is_the_same_block():
    spec = importlib.util.spec_from_file_location(
        "example", PROJECT / "examples" / "plugin" / "rocking_capped_block.py"
    )
    example = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(example)
    sizes = {"width": 0.8, "height": 2.0, "cap_mass": 0.5}
    one, other = (equivalent_block(cls(**sizes)).positive for cls in (CappedBlock, example.CappedBlock))
    assert one == other

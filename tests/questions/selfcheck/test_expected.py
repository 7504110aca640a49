"""The values that `rocking selfcheck` compares with are those of programs that share no code with the package."""

import json

import numpy as np
import pytest

from rocking_cli.dynamics.exact import closed_form
from tests.mechanisms.test_arch import Scan
from tests.reference_mechanics import Voussoirs
from validation import selfcheck as expected


def numbers(value):
    """All numbers of nested lists and mappings, and the words between them."""
    if isinstance(value, dict):
        return [one for key, each in value.items() for one in (key, *numbers(each))]
    if isinstance(value, list | tuple):
        return [one for each in value for one in numbers(each)]
    return [value]


def test_the_file_has_what_the_programs_compute():
    kept = json.loads(expected.FILE.read_text(encoding="utf-8"))
    assert min(len(times) for *_, times in kept["histories"]) < 7  # of one that overturns
    for name, values in expected.expected().items():
        for one, other in zip(numbers(kept.pop(name)), numbers(values), strict=True):
            assert one == (other if isinstance(other, str | bool) else pytest.approx(other, rel=2e-15, abs=2e-11)), name
    assert not kept


def test_the_formula_of_pulses_is_that_of_the_package():
    for a, omega, eta in ((2.0, 5.0, 0.9), (7.0, 5.0, 0.9), (3.0, 1.9, 0.8), (2.0, 3.0, 0.9), (1.5, 0.9, 0.7)):
        closed = closed_form(a, omega, eta)
        falls = closed.conditions["no_overturning_without_impact"] is False or closed.overturns
        assert expected.overturns(a, omega, eta) is falls


def test_the_arch_is_that_of_other_programs():
    hinges = Voussoirs(np.radians(157.5), 0.15, 7).thrust()[1]
    scan = Scan(np.radians(157.5), 0.15, [k * np.radians(157.5) / 7 for k, _ in hinges], radius=10.0)
    phi_cr = scan.critical(0.08)
    inertia, _, G, B = scan.eq_39(phi_cr)
    own = {"lambda_": Voussoirs(np.radians(157.5), 0.15, 7).thrust()[0], "phi_cr": phi_cr, "kappa1": B / G}
    assert own | {"p": (9.80665 * G / inertia) ** 0.5} == pytest.approx(expected.OPPENHEIM, rel=2e-11)

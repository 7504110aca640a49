"""Pulses: Eqs. 41-42 against the linear equation solved with symbols, and the command; see test_exact_pulse.py."""

import re
from collections import Counter
from dataclasses import dataclass
from functools import cache, partial
from itertools import chain, product
from math import asin, exp, inf, isfinite, nan, pi, sqrt

import mpmath
import numpy as np
import pytest
import sympy
from pytest import approx

from rocking_cli.dynamics.exact import closed_form
from rocking_cli.errors import InputError
from rocking_cli.questions.pulse.view import CONDITIONS, why_not_valid
from tests.cli.test_cli import run as command
from tests.cli.test_cli import run_json
from tests.pulses import exact_pulse

NEAR = 1e-6  # of a boundary, where rounding may decide
EXACT_KEYS = {
    "max_ratio",
    "first_excursion",
    "first_rebound",
    "overturns",
    "impacts_before_overturning",
    "first_impact",
    "impact_during_pulse",
}


def draw(rng, count, over, omega, eta, power=0):
    """Random (a, omega, eta), a = 1 + over omega^power, log-uniform over the ranges."""
    for _ in range(count):
        c, w, e = (float(exp(rng.uniform(np.log(low), np.log(high)))) for low, high in (over, omega, eta))
        yield 1 + c * w**power, w, e


# Eqs. 41-42 and their conditions


@cache
def solved():
    """x and x' at the end of the pulse, of a block that has not hit the ground, as functions of a and omega."""
    a, w, t = sympy.symbols("a omega tau", positive=True)
    grow, decay, in_phase, out_of_phase = sympy.symbols("A B C D")
    angle = w * t + sympy.asin(1 / a)
    x = 1 + grow * sympy.exp(t) + decay * sympy.exp(-t) + in_phase * sympy.sin(angle) + out_of_phase * sympy.cos(angle)
    wrong = sympy.expand(sympy.diff(x, t, 2) - (x - 1 + a * sympy.sin(angle)))
    at_rest = [x.subs(t, 0), sympy.diff(x, t).subs(t, 0)]
    found = sympy.solve(
        [wrong.coeff(sympy.sin(angle)), wrong.coeff(sympy.cos(angle)), *at_rest], [grow, decay, in_phase, out_of_phase]
    )
    x = x.subs(found)
    assert sympy.simplify(sympy.diff(x, t, 2) - (x - 1 + a * sympy.sin(angle))) == 0
    ended = (2 * sympy.pi - sympy.asin(1 / a)) / w
    return sympy.lambdify((a, w), [x.subs(t, ended), sympy.diff(x, t).subs(t, ended)], modules="mpmath")


@dataclass
class Free:
    """The motion after the pulse of a block that has not hit the ground, and what follows from it."""

    D0: float  # (1 - x)^2 - x'^2, which stays; at the impact x = 0, so that x'^2 = 1 - D0
    left: float  # 1 - the square of the rate after the impact
    in_the_air: bool
    comes_back: bool  # the coefficient of exp(tau) is negative
    overturns_after_it: bool
    margin: float  # how far from another verdict


def free(a, omega, eta):
    with mpmath.workdps(max(50, 20 + int(8 / omega))):  # exp(2 pi/omega) cancels
        x, v = solved()(mpmath.mpf(a), mpmath.mpf(omega))
        D0 = (1 - x) ** 2 - v**2
        left = 1 - mpmath.mpf(eta) ** 2 * (1 - D0)
        margin = min(abs(x), abs(x + v - 1), abs(left))
        return Free(float(D0), float(left), x > 0, x + v < 1, left <= 0, float(margin))


CLOSED = [*draw(np.random.default_rng(7), 300, (1e-3, 20), (0.25, 20), (0.1, 1))]


def assert_conditions(closed, end):
    assert closed.conditions == {
        "uplift": True,
        "first_impact_after_pulse": end.in_the_air,
        "no_overturning_without_impact": end.comes_back,
    }
    assert closed.valid == (end.in_the_air and end.comes_back)


@pytest.mark.parametrize("point", CLOSED[:15])
def test_D0_is_the_energy_of_the_free_motion(point):
    a, omega, eta = point
    got, wanted = closed_form(*point), free(*point)
    end = (2 * pi - asin(1 / a)) / omega
    # what rounding may do: every term, and the error of a large exponent
    terms = (omega / (omega**2 + 1)) ** 2 * (omega**2 + 2 * a**2 + 1 + 2 * a * (a + omega) * (1 + end) * exp(end))
    assert approx(wanted.D0, rel=1e-12, abs=1e-15 * terms) == got.D0
    assert got.overturns == (wanted.overturns_after_it if got.valid else None)
    if wanted.overturns_after_it:
        assert got.max_ratio is None and got.printed_ratio is None
        return
    root = sqrt(wanted.left)
    ratio = approx(1 - root, rel=1e-12, abs=1e-15 * (1 + eta**2 * terms / root))
    assert got.max_ratio == (ratio if got.valid else None)
    assert got.printed_ratio == (ratio if root <= 1 else None)  # a rotation below zero is none


@pytest.mark.parametrize("point", [*CLOSED[:20], (8, 3, 0.9), (1.3, 8, 0.9), (0.7, 3, 0.9)])
def test_out_of_its_domain_the_closed_form_says_nothing_but_why(point):
    got = closed_form(*point)
    assert (why_not_valid(got) is None) == got.valid
    assert got.printed_ratio is None or 0 <= got.printed_ratio <= 1
    if got.valid:
        assert got.max_ratio == got.printed_ratio
        return
    assert got.max_ratio is None and got.overturns in (None, False)
    assert (got.overturns is False) == (point[0] <= 1)
    for name, words in (("uplift", "a > 1"), ("first_impact_after_pulse", "first impact comes after the pulse"),
                        ("no_overturning_without_impact", "before its first impact")):  # fmt: skip
        assert (words in why_not_valid(got)) == (got.conditions[name] is False)


def test_conditions_are_in_the_air_and_coming_back_at_the_end_of_the_pulse():
    ends = [(closed_form(*point), free(*point)) for point in CLOSED]
    clear = [(closed, end) for closed, end in ends if end.margin > NEAR]
    for closed, end in clear:
        assert_conditions(closed, end)
    held = Counter((end.in_the_air, end.comes_back) for _, end in clear)
    assert len(clear) >= len(CLOSED) - 3
    assert min(held[True, True], held[True, False], held[False, True]) > 20, held


def test_conditions_and_eq_41_are_those_of_the_exact_motion():
    rng, seen, skipped = np.random.default_rng(11), Counter(), 0
    many = draw(rng, 250, (0.05, 20), (0.7, 20), (0.3, 1))
    strong = draw(rng, 150, (0.45, 0.9), (1.7, 7), (0.85, 1), power=1)
    for point in chain(many, strong):
        if free(*point).margin < NEAR:
            skipped += 1
            continue
        closed, exact = closed_form(*point), exact_pulse(*point)
        assert closed.conditions["first_impact_after_pulse"] == (not exact.impact_during_pulse), point
        without = exact.overturns and exact.impacts_before_overturning == 0
        assert closed.conditions["no_overturning_without_impact"] == (not without), point
        if closed.valid:
            assert closed.overturns == exact.overturns, point
            if closed.overturns:
                assert exact.impacts_before_overturning == 1, point
                assert exact.first_rebound is None
            else:
                assert exact.first_rebound == approx(closed.max_ratio, abs=1e-10), point
        seen["valid, overturns" if closed.overturns else "valid, rocks"] += closed.valid
        seen["impact in the pulse"] += exact.impact_during_pulse
        seen["overturns without impact"] += without
    assert skipped <= 3
    assert min(seen.values()) > 10, seen
    assert len(seen) == 4


def test_the_first_excursion_may_be_larger_than_the_closed_form():
    closed, exact = closed_form(6, 9, 0.8), exact_pulse(6, 9, 0.8)
    assert closed.valid
    assert exact.first_rebound == approx(closed.max_ratio, abs=1e-12)
    assert exact.max_ratio == exact.first_excursion > closed.max_ratio + 0.01


@pytest.mark.parametrize("point", [(1.0000001, 1e-3, 0.9), (1e3, 0.009, 0.9)])
def test_closed_form_of_a_very_slow_pulse_keeps_to_its_formulas(point):
    got, end = closed_form(*point), free(*point)
    assert_conditions(got, end)
    assert not got.valid
    assert got.D0 is None  # beyond 1e308
    assert got.overturns is None


# The exact answer, which test_exact_pulse.py compares with one of 50 digits


@pytest.mark.parametrize(("a", "omega"), [(1.0, 3.0), (1e-3, 1e3)])
def test_a_pulse_too_weak_to_lift_moves_nothing(a, omega):
    closed, exact = closed_form(a, omega, 0.9), exact_pulse(a, omega, 0.9)
    assert closed.conditions["uplift"] is False
    assert not closed.valid
    assert not closed.overturns
    assert closed.D0 is None
    assert closed.max_ratio is None
    assert exact.max_ratio == 0
    assert not exact.overturns
    assert not exact.impact_during_pulse
    assert {exact.first_excursion, exact.first_rebound, exact.impacts_before_overturning, exact.first_impact} == {None}


@pytest.mark.parametrize(
    "point",
    [*product((1.0000001, 1e3), (1e-3, 1e3), (1e-6, 0.9)), (1e3, 1e3, 1.0)],
)
def test_extreme_pulses_have_finite_answers_or_none(point):
    for answer in (closed_form(*point), exact_pulse(*point)):
        for name, value in vars(answer).items():
            assert value is None or isinstance(value, dict) or isfinite(value), (name, value)


@pytest.mark.parametrize("function", [closed_form, exact_pulse])
@pytest.mark.parametrize(
    ("name", "value"),
    [
        *product(("a", "omega"), (0.0, nan, inf)),
        *product(("eta",), (0.0, 1.1, nan)),
    ],
)
def test_bad_input_is_refused_by_name(function, name, value):
    with pytest.raises(InputError, match=rf"^{name} must be "):
        function(**({"a": 2.0, "omega": 3.0, "eta": 0.9} | {name: value}))


run = partial(run_json, "pulse")


def words(*arguments):
    return " ".join(command("pulse", *arguments).stdout.split())


def test_the_command_prints_both_answers_as_one_line_of_json():
    got = run("--a", 5, "--omega", 4, "--restitution", 0.8)
    assert set(got) == {"shape", "a", "omega", "eta", "closed_form", "exact", "given"}
    assert (got["a"], got["omega"], got["eta"]) == (5, 4, 0.8)
    assert set(got["closed_form"]) >= {"D0", "max_ratio", "overturns", "valid", "conditions"}
    assert set(got["exact"]) >= EXACT_KEYS
    closed, exact = closed_form(5, 4, 0.8), exact_pulse(5, 4, 0.8)
    for name in ("D0", "max_ratio", "overturns", "valid", "conditions", "printed_ratio"):
        assert got["closed_form"][name] == getattr(closed, name)
    assert got["closed_form"]["off_first_rebound"] == closed.max_ratio - exact.first_rebound
    assert exact.first_excursion > exact.first_rebound
    for name in EXACT_KEYS:
        assert got["exact"][name] == getattr(exact, name)


def test_how_far_off_the_closed_form_is_out_of_its_domain_is_said():
    got = run("--a", 1.3, "--omega", 8)
    closed, peak = got["closed_form"], got["exact"]["max_ratio"]
    assert closed["max_ratio"] is None and closed["overturns"] is None and "after the pulse" in closed["reason"]
    assert closed["off_peak_ratio"] == approx(closed["printed_ratio"] - peak)
    said = words("--a", 1.3, "--omega", 8)
    value, high = re.search(r"Eq. 41 gives ([\d.]+), (\d+) % too high", said).groups()
    assert float(value) == approx(closed["printed_ratio"], rel=1e-3)
    assert float(high) == approx(100 * closed["off_peak_ratio"] / peak, abs=0.5)


@pytest.mark.parametrize(("a", "omega", "failed"), [(4, 6, None), (2, 3, "after the pulse")])
def test_D0_and_all_conditions_are_shown_whether_or_not_they_hold(a, omega, failed):
    said = words("--a", a, "--omega", omega)
    assert f"closed form D0* {closed_form(a, omega, 0.9).D0:.6g} (phi/phi_cr - 1)^2" in said
    for words_of, beginning in CONDITIONS.items():
        holds = "no" if failed and failed in beginning else "yes"
        assert f"condition {holds} {beginning}" in said, words_of
    assert "condition" not in words("--a", 0.5, "--omega", 3)


def test_a_block_that_overturns_without_impact_has_no_closed_form():
    got = run("--a", 8, "--omega", 3)
    assert got["exact"]["overturns"] and got["exact"]["impacts_before_overturning"] == 0
    closed = got["closed_form"]
    assert (closed["max_ratio"], closed["overturns"], closed["printed_ratio"], closed["off_peak_ratio"]) == (None,) * 4
    assert "does not overturn before its first impact" in closed["reason"]
    said = words("--a", 8, "--omega", 3)
    assert "Do not use the closed form" in said and "-2.85" not in said

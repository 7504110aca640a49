"""The error of the equivalent block: its integrals against motions, and against the trends the paper reports."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from math import cos, sin, tan

import numpy as np
import pytest
from mpmath import mp
from scipy.integrate import solve_ivp

import rocking_cli as rk
from mechanisms.arch import Arch
from mechanisms.asymmetric_frame import AsymmetricFrame
from mechanisms.block import Block
from mechanisms.wall import Wall
from rocking_cli.core import Direction, equivalent_block
from rocking_cli.core.equivalence import grade, preferred_kappa
from rocking_cli.core.structure_file import load_structure
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.names import percent
from rocking_cli.questions.equiv.view import kappa_in_words
from rocking_cli.questions.error.study import linearisation, preferred, velocity_ratios
from rocking_cli.questions.error.view import draw_linearisation, trust
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES
from tests.following import respond

FILES = sorted(path.name for path in EXAMPLES.glob("*.yaml"))
every_direction = pytest.mark.parametrize("direction", list(Direction))


def wall_of(alpha):
    return Wall(thickness=2 * sin(alpha), height=4 * cos(alpha))


def frame_of(right):
    return AsymmetricFrame(
        column_width=1.6, left_height=8.0, right_height=right, spacing=10.0, beam_depth=1.5, density=2500.0, depth=2.0
    )


def arch_of(thickness, angle):
    return Arch(radius=10.0, thickness=thickness, inclusion_angle_deg=angle)


def precision_of(mechanism):
    """The derivatives of a moment through measured points have corners."""
    return 2e-9 if mechanism.smooth else 1e-5


def unchecked(mechanism, monkeypatch):
    """The equation of motion knows nothing of joints, which would open under what is asked here."""
    monkeypatch.setattr(type(mechanism), "contacts", lambda self, direction: None)
    return mechanism


# --- the integrals


@pytest.mark.every(6)
@every_direction
@pytest.mark.parametrize("file", FILES)
def test_periods_are_those_of_the_integrated_motion(file, direction, monkeypatch):
    mechanism = unchecked(load_structure(EXAMPLES / file), monkeypatch)
    amplitudes = (0.001, 0.5, 0.99)
    found = linearisation(mechanism, direction, amplitudes)
    for r, period in zip(amplitudes, found.period, strict=True):
        motion = respond(mechanism, release=direction * r, models=("nonlinear",), rtol=1e-12)["nonlinear"]
        assert period == pytest.approx(4 * motion.impacts[0, 0], rel=precision_of(mechanism))


@pytest.mark.every(6)
@every_direction
@pytest.mark.parametrize("file", FILES)
def test_overturning_times_are_those_of_the_integrated_motion(file, direction, monkeypatch):
    mechanism = unchecked(load_structure(EXAMPLES / file), monkeypatch)
    block = equivalent_block(mechanism)[direction]
    accelerations = (1.01, 4.0)
    found = linearisation(mechanism, direction, acceleration=accelerations)
    for a, time in zip(accelerations, found.overturning, strict=True):
        push = np.full(3000, -direction * a * block.lambda_ * mechanism.gravity)
        motion = GroundMotion("constant", 0.005 / block.p, push, unit="m/s2")
        history = respond(mechanism, motion, models=("nonlinear",), rtol=1e-12)["nonlinear"]
        assert history.overturning_time == pytest.approx(time, rel=precision_of(mechanism))


@pytest.mark.parametrize("r", [1e-6, 0.3, 0.9, 0.9999])
def test_the_period_of_a_block_is_an_elliptic_integral(r):
    # theta.^2/2 = p^2 (cos(alpha - theta) - cos(alpha - theta_0)), by mpmath's own quadrature of the pendulum's form.
    block = Block(width=0.7, height=2.8)
    with mp.workdps(30):
        alpha = mp.atan(mp.mpf(7) / 28)
        p = mp.sqrt(3 * mp.mpf("9.80665") / (4 * mp.sqrt(mp.mpf("0.35") ** 2 + mp.mpf("1.4") ** 2)))
        rest = alpha * (1 - mp.mpf(r))  # psi = alpha - theta, from rest to alpha
        k = mp.cos(rest / 2) ** 2  # psi.^2 = 4 p^2 (sin^2(psi/2) - sin^2(rest/2)); cos(psi/2) = cos(rest/2) sin(w)
        w = mp.asin(mp.cos(alpha / 2) / mp.cos(rest / 2))
        quarter = (mp.ellipk(k) - mp.ellipf(w, k)) / p
        found = linearisation(block, Direction.POSITIVE, r)
        assert found.period[0] == pytest.approx(float(4 * quarter), rel=1e-9)
        assert found.period_ratio[0] == pytest.approx(float(mp.acosh(1 / (1 - mp.mpf(r))) / p / quarter), rel=1e-9)


def test_ratios_are_those_of_equations_24_and_25():
    mechanism = load_structure(EXAMPLES / "arch.yaml")
    block = equivalent_block(mechanism).positive
    found = linearisation(mechanism, Direction.POSITIVE, 0.4, (1.2, 3.0))
    assert found.period_ratio[0] * found.period[0] == pytest.approx(4 / block.p * float(mp.acosh(1 / 0.6)), rel=1e-12)
    for k, a in enumerate((1.2, 3.0)):
        one = float(mp.acosh(1 + 1 / (a * block.lambda_ / block.lambda_lin - 1))) / block.p
        two = float(mp.acosh(1 + 1 / (a - 1))) / block.p
        assert found.overturning_ratio1[k] * found.overturning[k] == pytest.approx(one, rel=1e-12)
        assert found.overturning_ratio2[k] * found.overturning[k] == pytest.approx(two, rel=1e-12)
    assert found.uplift_ratio1 == block.lambda_lin / block.lambda_
    assert found.uplift_ratio2 == pytest.approx(1, rel=1e-14)


def test_a_block_that_does_not_uplift_never_overturns():
    # A thick beam on unequal columns: lambda_lin is above lambda, and between them kappa1 keeps the block at rest.
    mechanism = AsymmetricFrame(
        column_width=2.2, left_height=2.9, right_height=5.8, spacing=3.8, beam_depth=6.0, density=2500.0, depth=1.0
    )
    ratio = linearisation(mechanism, Direction.POSITIVE).uplift_ratio1
    assert ratio > 1.1
    found = linearisation(mechanism, Direction.POSITIVE, acceleration=((1 + ratio) / 2, 1.01 * ratio))
    assert np.isinf(found.overturning_ratio1).tolist() == [True, False]
    assert np.isfinite(found.overturning_ratio2).all()


# --- the trends of the paper's text


@pytest.mark.parametrize("alpha", [0.05, 0.2])
def test_errors_are_small_for_slender_walls_and_the_period_s_least_near_phi_cr(alpha):
    found = linearisation(wall_of(alpha), Direction.POSITIVE, np.linspace(0.05, 0.99, 20), (1.5, 2.0, 5.0, 10.0))
    error = np.abs(found.period_ratio - 1)
    assert error.max() < 0.06
    assert (np.diff(error) < 0).all()
    assert np.abs(found.overturning_ratio2 - 1).max() < 0.05
    assert np.abs(found.overturning_ratio1 - 1).max() < 0.06
    assert found.uplift_ratio1 == pytest.approx(alpha / tan(alpha), rel=1e-12)


def test_kappa1_and_kappa2_differ_most_near_uplift():
    found = linearisation(wall_of(0.3), Direction.POSITIVE, acceleration=np.geomspace(1.02, 20, 12))
    assert (np.diff(np.abs(found.overturning_ratio1 - found.overturning_ratio2)) < 0).all()


@pytest.mark.parametrize(("thickness", "angle"), [(2.0, 120.0), (1.5, 157.5)])
def test_kappa2_is_far_better_than_kappa1_for_arches(thickness, angle):
    found = linearisation(arch_of(thickness, angle), Direction.POSITIVE, acceleration=(1.2, 1.5, 2.0, 5.0))
    one, two = (np.abs(ratio - 1) for ratio in (found.overturning_ratio1, found.overturning_ratio2))
    assert (two < 0.7 * one).all()
    assert found.uplift_ratio1 < 0.9


def test_wider_and_thinner_arches_have_lower_phi_cr_and_lambda_and_much_the_same_p():
    by_angle = [equivalent_block(arch_of(1.5, angle)).positive for angle in (90.0, 120.0, 150.0)]
    by_thickness = [equivalent_block(arch_of(t, 150.0)).positive for t in (2.0, 1.6, 1.2)]
    for blocks in (by_angle, by_thickness):
        values = {name: np.array([getattr(block, name) for block in blocks]) for name in ("phi_cr", "lambda_", "p")}
        assert (np.diff(values["phi_cr"]) < 0).all()
        assert (np.diff(values["lambda_"]) < 0).all()
        spread = {name: each.max() / each.min() for name, each in values.items()}
        assert spread["p"] < min(spread["phi_cr"], spread["lambda_"])


def test_the_directions_of_a_frame_differ_more_the_more_asymmetric_it_is():
    apart = []
    for ratio in (1.0, 1.1, 1.25, 1.5):
        equivalence = equivalent_block(frame_of(8.0 * ratio))
        apart.append(abs(equivalence.positive.lambda_ / equivalence.negative.lambda_ - 1))
    assert apart[0] < 1e-12
    assert (np.diff(apart) > 0).all()


# --- the command


def test_the_command_gives_what_the_library_gives():
    data = run_json("error", EXAMPLES / "frame.yaml", "--at", "0.3", "--at", "0.8", "--a", "1.5")
    mechanism = load_structure(EXAMPLES / "frame.yaml")
    assert set(data["directions"]) == {"positive", "negative"}
    for direction in Direction:
        expected = linearisation(mechanism, direction, (0.3, 0.8), 1.5)
        got = data["directions"][direction.label]
        assert [row["ratio"] for row in got["free_period"]] == expected.period_ratio.tolist()
        assert [row["period"] for row in got["free_period"]] == expected.period.tolist()
        assert got["overturning_time"][0]["ratio"]["kappa2"] == expected.overturning_ratio2[0]
        assert got["uplift_ratio"]["kappa1"] == expected.uplift_ratio1


def test_the_words_follow_the_numbers():
    block = run_json("error", EXAMPLES / "block.yaml")
    assert "Kappa2 agrees" in block["verdict"]
    assert block["grades"] == dict.fromkeys(("kappa1", "kappa2"), "agrees") and block["prefer"] == "kappa2"
    arch = run_json("error", EXAMPLES / "arch.yaml")["verdict"]
    assert "prefer kappa2. Base decisions on" in arch and "Kappa2 is good for a first estimate" in arch
    assert "more than 5 %" in arch
    shown = " ".join(run("error", EXAMPLES / "arch.yaml").stdout.split())
    assert (
        "Kappa2 is good for a first estimate (uplift acceleration kept, " in shown and "; disregard kappa1 (" in shown
    )
    stocky = arch_of(3.0, 100.0)
    curves = [linearisation(stocky, Direction.POSITIVE, np.linspace(0.05, 0.95, 9), np.geomspace(1.1, 10, 9))]
    assert "use the nonlinear time history" in trust(curves, [linearisation(stocky, Direction.POSITIVE, 0.1, 1.1)])


GRADES = (("agrees", 0.05), ("first_estimate", 0.15), ("disregard", np.inf))
SENTENCES = {"agrees": "kappa{} agrees (", "first_estimate": "kappa{} is good for a first estimate (",
             "disregard": "disregard kappa{} ("}  # fmt: skip
TALL = AsymmetricFrame(
    column_width=4.0, left_height=3.0, right_height=30.0, spacing=4.5, beam_depth=12.0, density=2500.0, depth=1.0
)
VALLEY = AsymmetricFrame(
    column_width=2.606, left_height=9.0, right_height=15.91, spacing=5.4, beam_depth=4.5, density=2500.0, depth=1.0
)


@pytest.mark.every(4)
@pytest.mark.parametrize("structure", [VALLEY, TALL, wall_of(0.1), arch_of(3.0, 100.0)])
@pytest.mark.parametrize("asked", [(0.5, 2.0), (0.05, 1.1)])
def test_the_verdict_is_that_of_its_own_numbers(structure, asked, tmp_path):
    file = tmp_path / "s.yaml"
    fields = structure.model_dump(exclude_none=True)
    file.write_text(json.dumps({"mechanism": structure.mechanism, **fields}), encoding="utf-8")
    data = run_json("error", file, "--at", asked[0], "--a", asked[1])
    sides = data["directions"].values()
    said, names = data["verdict"], [name for name, _ in GRADES]
    found = {}
    for kappa in ("kappa1", "kappa2"):
        uplift = max((side["uplift_ratio"][kappa] - 1 for side in sides), key=abs)
        period = max(abs(row["ratio"] - 1) for side in sides for row in side["free_period"])
        ratios = [row["ratio"][kappa] for side in sides for row in side["overturning_time"]]
        late = max(np.inf if ratio is None else abs(ratio - 1) for ratio in ratios)
        grade = next(name for name, most in GRADES if max(abs(uplift), period, late) <= most)
        found[kappa] = names.index(grade)
        assert data["grades"][kappa] == grade
        sentence = SENTENCES[grade].format(kappa[-1])
        numbers = said[said.lower().index(sentence) + len(sentence) :]
        way = f"{percent(abs(uplift))} too {'low' if uplift < 0 else 'high'}" if kappa == "kappa1" else "kept"
        time = "infinite" if np.isinf(late) else f"off by {percent(late)}"
        shown = f"uplift acceleration {way}, free period off by {percent(period)}, overturning time {time}"
        assert numbers.startswith(shown)
    assert not re.search(r"\de[+-]", said)  # no powers of ten
    advice = {preferred_kappa(equivalent_block(structure)[side]) for side in Direction}
    better = {"kappa2"} & advice or {"either"}
    expected = None if min(found.values()) == 2 else (
        better.pop() if found["kappa1"] == found["kappa2"] else min(found, key=found.__getitem__)
    )  # fmt: skip
    assert data["prefer"] == expected
    advice = {None: "rely on neither kappa", "either": "either kappa is adequate"}.get(expected, f"prefer {expected}.")
    first, *_ = run("error", file, "--at", asked[0], "--a", asked[1]).stdout.splitlines()
    assert first.startswith(f"At phi/phi_cr = {asked[0]:g} and {asked[1]:g} times") and advice in first
    assert said.startswith(first) and said.count("prefer") == (expected in ("kappa1", "kappa2"))


@pytest.mark.rest
def test_equiv_error_and_respond_disregard_the_same_kappa1(tmp_path):
    for structure in (VALLEY, TALL, wall_of(0.3), arch_of(1.5, 157.5)):
        file = tmp_path / "s.yaml"
        fields = {**structure.model_dump(exclude_none=True), "restitution": 0.6}
        file.write_text(json.dumps({"mechanism": structure.mechanism, **fields}), encoding="utf-8")
        block = equivalent_block(structure)
        off = max((block[side].lambda_lin / block[side].lambda_ - 1 for side in Direction), key=abs)
        unfit = abs(off) > 0.15
        assert ("Disregard kappa1" in run("equiv", file).stdout) == unfit
        assert unfit <= (run_json("error", file)["grades"]["kappa1"] == "disregard")
        top = 0.7 * max(block[side].lambda_ for side in Direction)
        asked = "respond", file, "--neighbours", 0, "--pulse", f"sine:{2 * top:.4g}g:0.5s", "--model"
        data = run_json(*asked, "nonlinear,linear1", "--opening", 1000)
        assert data["agreement"]["linear1"]["uplift_error"] == pytest.approx(off, rel=1e-12)
        assert ("Disregard linear1: its uplift acceleration" in data["verdict"]) == unfit
        alone = run(*asked, "linear1").stdout
        assert ("Disregard linear1: its uplift acceleration" in " ".join(alone.split())) == unfit


@pytest.mark.parametrize(
    ("error", "expected"),
    [(0.05, "agrees"), (0.05 + 1e-9, "first_estimate"), (-0.15, "first_estimate"), (0.15 + 1e-9, "disregard"),
     (float("nan"), "disregard"), (float("inf"), "disregard"), (0.0, "agrees")],
)  # fmt: skip
def test_grades_on_both_sides_of_their_bounds(error, expected):
    assert grade(error).key == expected


@pytest.mark.parametrize(
    ("ratio", "prefer", "words"),
    [(0.98664, "either", "Effectively slender"), (0.9865, "kappa2", "By the uplift prefer kappa2"),
     (0.8501, "kappa2", "By the uplift prefer kappa2"), (0.8499, "kappa2", "Disregard kappa1"),
     (1.1501, "kappa2", "Disregard kappa1: with kappa1 the uplift acceleration is 15 % too high")],
)  # fmt: skip
def test_advice_on_both_sides_of_its_bounds(ratio, prefer, words):
    block = replace(equivalent_block(Block(width=0.7, height=2.8)).positive, lambda_lin=0.25 * ratio)
    said = kappa_in_words(block)
    assert preferred_kappa(block) == prefer and words in said and f"lambda_lin/lambda = {ratio:.4g}" in said


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("name", ["frame", "arch"])
def test_the_ends_of_what_can_be_asked_are_answered(name):
    ends = ["--at", "1e-6", "--at", "0.999999", "--a", "1.000001", "--a", "1e6"]
    found = json.loads(run("error", EXAMPLES / f"{name}.yaml", *ends, "--json").stdout)
    assert found["verdict"]


@pytest.mark.parametrize(
    ("field", "values", "words"),
    [("at", (0.0, 1.0), "between 0 and 1"), ("at", (1e-300, 9e-7, 1 - 9e-7), "away from 0 and 1"),
     ("a", (1 + 9e-7, 1.1e6), r"1\.000001 to 1e"), ("a", (1.0, 0.5), "above 1")],
)  # fmt: skip
def test_wrong_values_are_refused_by_name(field, values, words):
    for value in values:
        with pytest.raises(InputError, match=rf"^`{field}`: an .*{words}"):
            rk.error(Block(width=0.7, height=2.8), **{field: value})


def test_the_preferred_kappa_is_the_boldest_line_and_what_is_not_drawn_is_said():
    arch = load_structure(EXAMPLES / "arch.yaml")
    rho = np.array([1.02, 2.0, 10.0])
    curve = linearisation(arch, Direction.POSITIVE, [0.2, 0.5], rho)
    asked = linearisation(arch, Direction.POSITIVE, [0.5], [2.0])
    assert preferred([asked]) == 2
    right = draw_linearisation([curve], [asked], "arch").axes[1]
    widths = {line.get_label(): line.get_linewidth() for line in right.get_lines()}
    assert widths[r"$\kappa_2$, preferred"] > widths[r"$\kappa_1$"]
    assert {each.get_text() for each in right.get_legend().get_texts()} == {r"$\kappa_2$, preferred", r"$\kappa_1$"}
    assert curve.overturning_ratio1[0] < 0.5 and "beyond 50 %" in " ".join(right.get_xlabel().split())
    right.figure.canvas.draw()
    assert right.xaxis.label.get_window_extent().x1 < right.figure.bbox.x1  # none of it is cut
    close = linearisation(arch, Direction.POSITIVE, [0.2, 0.5], rho[1:])
    assert "50 %" not in draw_linearisation([close], [asked], "arch").axes[1].get_xlabel()


@pytest.mark.parametrize("kappa", [1, 2])
def test_the_velocity_step_of_the_block_just_overturns_it(kappa):
    """Of the linear equation integrated from that rate: a little less comes back, a little more goes on."""
    structure = load_structure(EXAMPLES / "frame.yaml")
    block = equivalent_block(structure).positive
    assert block.v_imp == pytest.approx(1.6108, abs=5e-4)
    scale = block.kappa1 if kappa == 1 else block.kappa2
    step = velocity_ratios(block, structure.gravity)[kappa - 1] * block.v_imp

    def end(share):
        rate = block.p**2 * scale * share * step / structure.gravity
        pull = lambda t, y: [y[1], block.p**2 * (y[0] - block.phi_cr)]  # noqa: E731
        motion = solve_ivp(pull, (0, 12 / block.p), [0, rate], rtol=1e-10)
        return motion.y[0, -1]

    assert end(0.999) < 0 < block.phi_cr < end(1.001)

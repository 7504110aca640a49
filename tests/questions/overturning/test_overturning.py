"""Maps and curves of overturning against single responses and closed forms."""

import json
import re
from dataclasses import replace
from math import asin, exp, log, nan, pi, sqrt
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.path import Path as Path2D

from mechanisms.block import Block
from rocking_cli.core import Direction, equivalent_block
from rocking_cli.core.structure_file import load_structure
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.exact import closed_form, exact_response
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.excitation.pulses import COARSE_POINTS_PER_PERIOD
from rocking_cli.plotting import style
from rocking_cli.questions.overturning import study
from rocking_cli.questions.overturning.edges import FREE_POINTS, edges_of
from rocking_cli.questions.overturning.picture import draw_comparison, draw_map
from rocking_cli.questions.overturning.study import (
    CONTOUR_LEVELS,
    SCAN_AMPLITUDES,
    OutcomeKind,
    Region,
    boundaries,
    compare,
    overturning_map,
    usual_amplitudes,
    usual_periods,
)
from rocking_cli.questions.overturning.view import _smallest
from rocking_cli.structure import Structure, build_models
from rocking_cli.studies.under_pulses import linear_block, outcomes, parse_shape, pulsed_model, weakest_direction
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES, rows_of
from tests.following import respond
from tests.pulses import exact_pulse

SINE = parse_shape("sine")
BLOCK = Block(width=0.7, height=2.8)
PORTAL = load_structure(EXAMPLES / "masonry" / "portal.yaml")
FRAME = str(EXAMPLES / "frame.yaml")
FILES = [str(EXAMPLES / f"{name}.yaml") for name in ("block", "frame", "wall")]


@pytest.fixture(scope="module")
def plane():
    return overturning_map(linear_block(0.9), SINE, np.linspace(0.5, 10, 60), np.linspace(0.5, 10, 61))


@pytest.fixture(scope="module")
def curves():
    structures = [pulsed_model(Structure(load_structure(file)), "linear2", SINE) for file in FILES]
    return compare(structures, SINE, np.linspace(0.3, 3, 6), 3.0)


class TestMap:
    def test_every_point_is_the_single_response(self, plane):
        rng = np.random.default_rng(5)
        for row, column in zip(rng.integers(61, size=100), rng.integers(60, size=100), strict=True):
            alone = exact_pulse(float(plane.a[row]), float(plane.omega[column]), 0.9)
            impacts = impacts_before(plane.outcome)[row, column]
            assert (impacts if impacts >= 0 else None) == alone.impacts_before_overturning
            ratio = plane.outcome.peak_ratio[row, column]
            assert np.isnan(ratio) if alone.max_ratio is None else ratio == pytest.approx(alone.max_ratio, abs=1e-9)

    def test_every_region_is_there_and_the_shares_are_those_of_the_points(self, plane):
        assert sum(plane.shares.values()) == pytest.approx(1.0, abs=1e-12)
        assert {region for region, share in plane.shares.items() if share > 0} == set(Region) - {Region.UNKNOWN}
        assert plane.shares[Region.UNKNOWN] == 0  # an equivalent block has no joints
        assert plane.shares[Region.NO_UPLIFT] == pytest.approx(np.mean(plane.a <= 1))
        assert plane.shares[Region.WITHOUT_IMPACT] == np.mean(impacts_before(plane.outcome) == 0)

    def test_the_curves_are_those_of_the_columns(self, plane):
        falls = plane.outcome.fell
        for k, (least, safe) in enumerate(
            zip(plane.least(Region.AFTER_IMPACT, Region.WITHOUT_IMPACT), plane.safe_again, strict=True)
        ):
            a = plane.a[falls[:, k]]
            assert least == a[0] if a.size else np.isnan(least)
            above = plane.a[~falls[:, k]]
            above = above[above > least] if a.size else above[:0]
            assert safe == above[-1] if above.size else np.isnan(safe)
        assert np.isfinite(plane.safe_again).any()

    @pytest.mark.parametrize(
        ("mechanism", "omega", "a", "missing"),
        [
            (BLOCK, [3.0, 6.0], [0.8, 2.0, 4.0, 9.0], {Region.UNKNOWN}),
            (PORTAL, [0.4, 3.0], [0.8, 1.1, 1.5, 9.0], set()),
        ],
    )
    def test_a_nonlinear_point_is_the_history_of_respond(self, mechanism, omega, a, missing):
        structure = pulsed_model(Structure(mechanism), "nonlinear", SINE)
        found = overturning_map(structure, SINE, np.array(omega), np.array(a))
        for row, ag in enumerate(found.ag * STANDARD_GRAVITY):
            for column, period in enumerate(found.periods):
                motion = replace(SINE, amplitude=float(ag), period=float(period)).sampled(COARSE_POINTS_PER_PERIOD)
                alone = respond(mechanism, motion, models=("nonlinear",))["nonlinear"]
                assert found.outcome.fell[row, column] == alone.fell
                assert found.outcome.unknown[row, column] == alone.unknown
                for name in ("known_to", "lower_bound"):
                    each = getattr(found.outcome, name)[row, column]
                    assert each == pytest.approx(getattr(alone, name), rel=1e-9, nan_ok=True)
                if alone.fell:
                    assert found.outcome.impact_count[row, column] == alone.impact_count
                else:
                    assert found.outcome.peak_ratio[row, column] == pytest.approx(alone.peak_ratio, rel=1e-9)
        assert {int(each) for each in found.regions.ravel()} == set(Region) - missing

    def test_histories_on_samples_agree_with_the_exact_answer(self, plane):
        structure = linear_block(0.9)
        ricker_like = replace(SINE)
        object.__setattr__(ricker_like, "segments", lambda: ())
        found = overturning_map(structure, ricker_like, plane.omega[::6], plane.a[::6])
        exact, impacts = impacts_before(plane.outcome)[::6, ::6], impacts_before(found.outcome)
        assert np.mean(impacts != exact) < 0.02
        both = (impacts < 0) & (exact < 0)
        np.testing.assert_allclose(found.outcome.peak_ratio[both], plane.outcome.peak_ratio[::6, ::6][both], atol=2e-3)

    def test_both_polarities_give_the_worse(self):
        ricker = parse_shape("ricker")
        structure = pulsed_model(Structure(load_structure(FRAME)), "linear2", ricker, (1, -1))
        omega, a = np.linspace(1, 6, 20), np.linspace(0.9, 6, 20)
        one, other, both = (
            overturning_map(structure, ricker, omega, a, polarities=each).outcome for each in ((1,), (-1,), (1, -1))
        )
        assert (one.peak_ratio != other.peak_ratio).any()
        falls = one.fell | other.fell
        np.testing.assert_array_equal(both.fell, falls)
        np.testing.assert_array_equal(both.peak_ratio[~falls], np.fmax(one.peak_ratio, other.peak_ratio)[~falls])
        fewer, more = np.sort([np.where(each.fell, each.impact_count, 99) for each in (one, other)], axis=0)
        assert ((fewer < more) & (more < 99)).any()
        np.testing.assert_array_equal(both.impact_count[falls], fewer[falls])

    def test_uplift_is_at_a_of_one_in_the_weaker_direction(self):
        frame = load_structure(FRAME)
        structure = pulsed_model(Structure(frame), "nonlinear", SINE)
        assert structure.lambda_ == min(frame.uplift(direction) for direction in Direction)
        found = overturning_map(structure, SINE, np.array([4.0]), np.array([0.999, 1.001]))
        assert found.outcome.peak_ratio[0, 0] == 0 and found.outcome.peak_ratio[1, 0] > 0

    def test_kappa1_measures_by_the_lambda_of_the_linearised_mechanism(self):
        block = equivalent_block(BLOCK).positive
        assert pulsed_model(Structure(BLOCK), "linear1", SINE).lambda_ == block.lambda_lin
        assert pulsed_model(Structure(BLOCK), "linear2", SINE).lambda_ == block.lambda_ != block.lambda_lin


class TestOnlyPeaks:
    """A motion that is left some impacts after its record has the peaks of the whole one."""

    def test_all_but_the_end_is_the_same(self):
        models = [build_models(load_structure(file), ("nonlinear",))[0] for file in FILES]
        motions = [replace(SINE, period=period).sampled(50) for period in (0.4, 0.9, 2.0)]
        runs = Runs.every(3, 3, scales=np.linspace(1, 12, 12), polarities=(1, -1), etas=(0.7, 0.95))
        whole, left = (respond_many(models, motions, runs, only_peaks=only) for only in (False, True))
        for column in ("fell_to", "peak_positive", "peak_negative", "peak_ratio", "overturning_time"):
            np.testing.assert_array_equal(getattr(whole, column), getattr(left, column), err_msg=column)
        fell = whole.fell
        np.testing.assert_array_equal(whole.impact_count[fell], left.impact_count[fell])
        assert left.still_rocking.any() and left.impact_count.sum() < whole.impact_count.sum() / 3


class TestBoundaries:
    @pytest.mark.parametrize("shape", ["sine", "rectangular", "cosine"])
    @pytest.mark.parametrize("name", ["without_impact", "after_one_impact"])
    def test_the_responses_differ_on_their_two_sides(self, shape, name):
        shape, eta = parse_shape(shape), 0.9
        (boundary,) = (each for each in boundaries(shape, eta) if each.name == name)
        omega, a = np.meshgrid(np.linspace(0.3, 8, 120), np.geomspace(0.9, 20, 200))
        level = boundary.level(omega, a)
        crosses = (level[:-1] < 0) & (level[1:] >= 0)
        row, column = np.nonzero(crosses)
        if name == "after_one_impact" and shape.name != "sine":
            assert not crosses.any()  # a pulse to one side alone leaves too little; of the cosine no impact is so late
            return
        assert row.size > 20
        low, high, across = a[row, column], a[row + 1, column], omega[row, column]
        for _ in range(40):
            middle = (low + high) / 2
            above = boundary.level(across, middle) >= 0
            low, high = np.where(above, low, middle), np.where(above, middle, high)
        ends = [outcomes(linear_block(eta), shape, 2 * pi / across, high * factor) for factor in (1 - 1e-6, 1 + 1e-6)]
        below, over = (_happens(name, end) for end in ends)
        assert over.all() and not below.any()

    def test_those_of_the_sine_are_the_conditions_of_the_closed_form(self):
        known = {each.name: each for each in boundaries(SINE, 0.8)}
        omega, a = np.meshgrid(np.linspace(0.5, 9, 40), np.linspace(1.05, 9, 41))
        levels = {name: each.level(omega, a) for name, each in known.items()}
        for k in np.ndindex(omega.shape):
            closed = closed_form(float(a[k]), float(omega[k]), 0.8)
            stays, after = (
                closed.conditions[name] for name in ("no_overturning_without_impact", "first_impact_after_pulse")
            )
            assert (levels["without_impact"][k] < 0) == stays
            if stays:
                assert (levels["impact_at_end"][k] >= 0) == after
            if closed.valid:
                assert (levels["after_one_impact"][k] >= 0) == closed.overturns
            else:
                assert np.isnan(levels["after_one_impact"][k])

    def test_overturning_without_impact_in_closed_form(self):
        a, omega = 4.0, 3.0
        s = sqrt(a * a - 1)

        def zero(shape, omega):
            level = next(each.level for each in boundaries(parse_shape(shape), 0.9) if each.name == "without_impact")
            return float(level(np.array([omega]), np.array([a]))[0])

        assert zero("rectangular", 2 * pi / log(a / (a - 1))) == pytest.approx(0, abs=1e-12)
        te = (2 * pi - asin(1 / a)) / omega
        assert zero("sine", omega) * exp(te) == pytest.approx(((s - omega) * exp(te) - a) * omega / (1 + omega**2))
        te = (pi - asin(1 / a)) / omega
        assert zero("half_sine", omega) * exp(te) == pytest.approx(((s - omega) * exp(te) + a) * omega / (1 + omega**2))

    @pytest.mark.parametrize(
        ("shape", "omega"),
        [("sine", 2.0), ("sine", 9.0), ("half_sine", 2.0)],
    )
    def test_the_first_impact_is_at_the_end_of_the_pulse(self, shape, omega):
        shape = parse_shape(shape)
        level = next(each.level for each in boundaries(shape, 0.9) if each.name == "impact_at_end")
        a = np.geomspace(1.001, 40, 4000)
        signs = np.sign(level(np.full(a.size, omega), a))
        (k,) = np.flatnonzero((signs[:-1] < 0) & (signs[1:] >= 0))
        low, high = a[k], a[k + 1]
        while high - low > 1e-12:
            middle = (low + high) / 2
            low, high = (low, middle) if level(np.array([omega]), np.array([middle]))[0] >= 0 else (middle, high)
        pulse = replace(shape, amplitude=float(high), period=2 * pi / omega)
        exact = exact_response(linear_block(0.9).equivalence, pulse, kappa=2, gravity=1.0)
        assert exact.first_impact == pytest.approx(exact.pulse_end, rel=1e-4)

    def test_other_shapes_and_models_have_that_of_uplift(self):
        assert [each.name for each in boundaries(parse_shape("ricker"), 0.9)] == ["uplift"]
        found = overturning_map(
            pulsed_model(Structure(BLOCK), "nonlinear", SINE), SINE, np.array([5.0, 6.0]), np.array([0.5, 2.0])
        )
        assert [each.name for each in found.boundaries] == ["uplift"]


def impacts_before(outcome):
    """Impacts before it overturns; -1 where it does not."""
    return np.where(outcome.fell, outcome.impact_count, -1)


def _happens(name, found):
    return {
        "without_impact": impacts_before(found) == 0,
        "after_one_impact": impacts_before(found) == 1,
    }[name]


class TestCompare:
    def test_nothing_below_overturns_and_what_is_just_above_does(self, curves):
        assert np.isfinite(curves.least).sum() > 10
        for structure, least in zip(curves.structures, curves.least, strict=True):
            for period, ag in zip(curves.periods, least, strict=True):
                top = curves.top if np.isnan(ag) else ag * (1 - 1e-6)
                scan = 1 + (top * STANDARD_GRAVITY / structure.unit - 1) * np.geomspace(0.01, 1, SCAN_AMPLITUDES)
                found = outcomes(structure, SINE, np.full(SCAN_AMPLITUDES, period), scan * structure.unit)
                assert not found.fell.any()
                if np.isfinite(ag):
                    above = np.array([ag * (1 + 1e-6) * STANDARD_GRAVITY])
                    assert outcomes(structure, SINE, np.array([period]), above).fell[0]

    def test_the_first_is_the_one_with_the_least(self, curves):
        for goes, column in zip(curves.firsts.T, curves.least.T, strict=True):
            assert np.flatnonzero(goes).tolist() == ([] if np.isnan(column).all() else [np.nanargmin(column)])
        assert (curves.firsts.sum(axis=1) > 0).sum() > 1

    def test_equal_least_amplitudes_are_a_tie(self):
        one, other, heavy = (
            pulsed_model(Structure(Block(width=0.7 * k, height=2.8)), "linear2", SINE) for k in (1.0, 1.0, 1.5)
        )
        found = compare([one, heavy, other], SINE, np.array([0.5, 0.8]), 4.0)
        assert found.firsts.tolist() == [[True, True], [False, False], [True, True]]
        apart = replace(found, least=found.least * np.array([[1.0], [1.0], [1 + 1e-4]]))
        assert apart.firsts.tolist() == [[True, True], [False, False], [False, False]]

    def test_a_similar_block_overturns_at_the_same_amplitude_of_a_longer_pulse(self):
        small, large = (
            pulsed_model(Structure(Block(width=0.7 * k, height=2.8 * k)), "nonlinear", SINE) for k in (1.0, 4.0)
        )
        one = compare([small], SINE, np.array([0.5, 0.8]), 4.0)
        other = compare([large], SINE, np.array([1.0, 1.6]), 4.0)
        np.testing.assert_allclose(one.least, other.least, rtol=1e-6)


class TestShape:
    def test_the_weakest_pulse_lifts_the_weaker_direction(self):
        frame = equivalent_block(load_structure(FRAME))
        weaker = min(Direction, key=lambda d: frame[d].lambda_)
        assert weakest_direction(frame, SINE) == weakest_direction(frame, SINE, (-1,)) == weaker
        # To one side alone it is that side.
        assert weakest_direction(frame, parse_shape("half_sine")) is Direction.NEGATIVE
        assert weakest_direction(frame, parse_shape("half_sine"), (-1,)) is Direction.POSITIVE
        # Where both are alike, the one that is pushed first.
        assert weakest_direction(equivalent_block(BLOCK), SINE) is Direction.NEGATIVE
        assert weakest_direction(equivalent_block(BLOCK), SINE, (-1,)) is Direction.POSITIVE


class TestCommand:
    @pytest.fixture(autouse=True)
    def _of_few_amplitudes(self, monkeypatch):
        monkeypatch.setattr(study, "SCAN_AMPLITUDES", SCAN_AMPLITUDES // 8)

    def test_a_map_in_every_form(self):
        data = run_json(
            "overturning", FILES[0], "--points", 24, "--out", "map.csv", "--plot", "map.png", "--period", "0.3:2.5",
            "--ag", "0.1g:2g",
        )  # fmt: skip
        assert (data["model"], data["dimensionless"], data["polarity"]) == ("linear2", False, 1)
        assert sum(data["shares"].values()) == pytest.approx(1)
        assert data["period"][0] == pytest.approx(0.3) and data["ag"][-1] == pytest.approx(2)
        rows = rows_of("map.csv")
        assert len(rows) == 24 * 24
        labels = [row["outcome"] for row in rows]
        for region in Region:
            assert labels.count(region.label) / len(rows) == pytest.approx(data["shares"][region.name.lower()])
        for row in rows[::37]:
            ratio = float(row["ag [g]"]) / float(row["a"])
            assert ratio == pytest.approx(data["structure"]["lambda"], rel=1e-6)
            assert float(row["omega"]) * float(row["period [s]"]) == pytest.approx(
                2 * pi / data["structure"]["p"], rel=1e-6
            )
            assert (row["overturned"] == "1") == (row["peak_ratio"] == "inf") == row["outcome"].startswith("overturns")

    def test_curves_in_every_form(self):
        asked = ("overturning", "--compare", *FILES, "--points", 5, "--model", "linear2")
        data = run_json(*asked, "--plot", "c.svg", "--out", "c.csv")
        assert all(each["possible"] == each["least"] for each in data["structures"])
        assert data["undecided"] == [False] * 5
        assert [each["mechanism"] for each in data["structures"]] == ["block", "asymmetric_frame", "wall"]
        rows = rows_of("c.csv")
        assert len(rows) == 15 and data["tied"] == [None] * 5
        firsts = [row["structure"] for k in range(5) for row in rows[k::5] if row["first"] == "1"]
        assert firsts == [name for name in data["first"] if name is not None] and len(firsts) > 2
        assert [row["least [g]"] == "" for row in rows] == [
            value is None for each in data["structures"] for value in each["least"]
        ]
        text = run(*asked).stdout
        assert "overturns first" in text and "Overturned by the smallest amplitude:" in text

    @pytest.mark.parametrize(
        ("least", "unknown", "said"),
        [
            ([nan, 0.8, 0.6, 0.7], [nan] * 4, "overturns tower is 0.6 g (next smaller tried: 0.4 g), at T = 3 s."),
            ([nan, 0.8, 0.6, 0.6], [nan] * 4, "at T = 4 s, the edge of the map: beyond it, less may do."),
            ([nan, 0.2, 0.6, 0.6], [nan] * 4, "at T = 2 s, the edge of the map: beyond it, less may do."),
            ([nan] * 4, [nan] * 4, "No pulse on the map overturns tower, up to 0.9 g, from T = 1 s to T = 4 s."),
            ([nan] * 4, [nan, 0.5, 0.7, nan], "No pulse on the map is known to overturn tower, up to 0.9 g, from T = 1 "
             "s to T = 4 s. The smallest a_g whose outcome is unknown is 0.5 g (next smaller tried: 0.4 g), at T = 2 "
             "s."),
            ([nan, 0.8, 0.6, 0.7], [0.6, nan, nan, nan], "at T = 3 s."),
            ([nan, 0.8, 0.6, 0.7], [0.5, nan, nan, nan], "unknown is 0.5 g (next smaller tried: 0.4 g), at T = 1 s, "
             "the edge of the map: beyond it, less may do."),
        ],
    )  # fmt: skip
    def test_the_smallest_amplitude_is_said_with_the_edges_of_its_map(self, least, unknown, said):
        curves = {Region.UNKNOWN: np.array(unknown), Region.AFTER_IMPACT: np.array(least)}
        found = SimpleNamespace(structure=SimpleNamespace(name="tower"), periods=np.arange(1.0, 5), omega=None,
                                a=np.array([0.2, 0.4, 0.6, 0.9]), least=lambda *of: curves[of[0]])  # fmt: skip
        sentence = _smallest(found, 1.0, dimensionless=False)
        assert sentence.endswith(said) and ("unknown" in sentence) == ("unknown" in said)

    def test_a_map_begins_with_the_smallest_amplitude(self):
        asked = ("overturning", FILES[0], "--points", 16)
        data = run_json(*asked)
        curve = data["least_a"]["overturning"]
        k = min((k for k, a in enumerate(curve) if a is not None), key=lambda k: (curve[k], -k))
        amplitude = curve[k] / data["a"][0] * data["ag"][0]
        first = run(*asked).stdout.splitlines()[0]
        assert first.startswith(f"The smallest a_g on the map that overturns pedestal is {amplitude:.3g} g (")
        assert f", at T = {data['period'][k]:.3g} s, the edge of the map" in first and k == 15

    def test_a_tie_is_said_so(self, tmp_path):
        for name in ("one", "two"):
            (tmp_path / f"{name}.yaml").write_text("mechanism: block\nwidth: 1\nheight: 4\n", encoding="utf-8")
        asked = ("overturning", "--compare", "one.yaml", "two.yaml", "--points", 3, "--model", "linear2")
        data = run_json(*asked, "--out", "c.csv")
        tied = [each is not None for each in data["tied"]]
        assert any(tied) and data["first"] == [None] * 3 and ["one", "two"] in data["tied"]
        text = " ".join(run(*asked).stdout.split())
        assert "several equal" in text and f"one and two together at {100 * sum(tied) / 3:.0f} %" in text
        assert [row["first"] for row in rows_of("c.csv")] == [f"{int(each)}" for each in tied] * 2

    def test_a_bad_file_is_reported_and_the_others_are_compared(self):
        asked = ("overturning", "--compare", *FILES[:2], "no.yaml", "--points", 4, "--model", "linear2", "--json")
        result = run(*asked, code=5)
        assert "no.yaml: no such file" in result.stderr and len(json.loads(result.stdout)["structures"]) == 2
        refused = run("overturning", "--compare", FILES[0], "no.yaml", code=2).stderr
        assert "at least two structures that can be used" in refused

    def test_pulses_beyond_sense_are_refused_with_the_numbers(self):
        structure = pulsed_model(Structure(BLOCK), "linear2", SINE)
        for omega, a in ((1e-7, 2.0), (1e7, 2.0), (1.0, 1e7)):
            with pytest.raises(InputError, match="it must be"):
                overturning_map(structure, SINE, np.array([omega]), np.array([a]))
        with pytest.raises(InputError, match="it must be from"):
            compare([structure], SINE, np.array([1e8]), 4.0)

    def test_a_map_of_pulses_too_weak_to_lift_is_a_result(self, tmp_path):
        arguments = ["overturning", "--a", "0.2:0.9", "--points", 8]
        data = run_json(*arguments, "--plot", "map.png", "--out", "map.csv")
        assert data["shares"] == {
            "no_uplift": 1.0, "rocks": 0.0, "after_impact": 0.0, "without_impact": 0.0, "unknown": 0.0,
        }  # fmt: skip
        assert set(data["least_a"]["overturning"]) == {None} and max(data["a"]) <= 1
        strongest = f"the strongest is {max(data['a']):.4g} times the uplift acceleration"
        assert strongest in " ".join(run(*arguments).stdout.split())
        assert {row["outcome"] for row in rows_of("map.csv")} == {"does not uplift"}

    def test_curves_of_pulses_too_weak_to_lift_are_a_result(self, tmp_path):
        arguments = ["overturning", "--compare", *FILES, "--ag", "0.001g:0.1g", "--points", 2, "--model", "linear2"]
        data = run_json(*arguments, "--plot", "c.png")
        assert data["first"] == [None] * 2
        said = run(*arguments).stdout
        low = re.search(r"0\.1 g, the largest amplitude tried, does not uplift (.*)\.", said)[1].split(", ")
        assert low == [each["name"] for each in data["structures"] if each["lambda"] >= 0.1]

    @pytest.mark.parametrize(
        ("arguments", "complaint"),
        [
            (["--omega", "4"], "give the smallest and the largest value"),
            (["--omega", "1g:2g"], "'1g' has a unit: give a number without one, such as"),
            (["--shape", "sine:0.6g:0.8s"], "give only the shape, sine: amplitude and period are set separately"),
            (["--period", "0.2:4"], "give --omega"),
            (["--model", "nonlinear"], "--model has no effect on the linear block: give a structure"),
            ([FILES[0], "--omega", "1:2"], "give --period and --ag, or --dimensionless"),
            ([FILES[0], FILES[1]], "--compare"),
            (["--compare", *FILES, "--a", "1:2"], "give --ag"),
            (["--compare", *FILES, "--dimensionless"], "--dimensionless has no effect with --compare"),
        ],
    )
    def test_wrong_input_is_told_and_nothing_is_written(self, arguments, complaint, tmp_path):
        arguments = [*arguments, "--plot", "left.png", "--out", "left.csv"]
        assert complaint in " ".join(run("overturning", *arguments, code=2).stderr.split())
        assert list(tmp_path.iterdir()) == []


def painted(edges, place):
    """The kind that the outlines paint at a place u + iv of the grid."""
    inside = [
        kind
        for kind, lines in edges.outlines.items()
        if sum(Path2D(np.column_stack([each.real, each.imag])).contains_point((place.real, place.imag))
               for each in map(closed, lines)) % 2
    ]  # fmt: skip
    return max(inside, default=0)


def closed(line):
    return np.append(line, line[0])


def beside(edges, size, away, rng, count):
    """Random places at both sides of edges, so many cells away from them, and not beside the frame."""
    lines = [closed(each) for lines in edges.outlines.values() for each in lines]
    starts, ends = (np.concatenate([each[part] for each in lines]) for part in (np.s_[:-1], np.s_[1:]))
    middle, normal = (starts + ends) / 2, 1j * (ends - starts) / np.abs(ends - starts)
    inner = (np.minimum(middle.real, middle.imag) > 0.3) & (np.maximum(middle.real, middle.imag) < size - 1.3)
    chosen = rng.choice(np.flatnonzero(inner), count)
    return np.concatenate([middle[chosen] + side * away * normal[chosen] for side in (1, -1)])


@pytest.fixture(scope="module")
def maps():
    block = pulsed_model(Structure(BLOCK), "nonlinear", SINE)
    omega, a = np.linspace(3.5, 8, 50), np.linspace(0.5, 9, 50)
    return [overturning_map(each, SINE, omega, a) for each in (linear_block(0.9), block)]


class TestEdges:
    """The lines on a map, against histories one by one."""

    @pytest.mark.parametrize("k", [0, 1])
    def test_beside_them_the_outcomes_are_those_painted(self, maps, k):
        found, rng = maps[k], np.random.default_rng(4)
        places = beside(found.edges, 50, 0.06, rng, 40 if k else 100)
        kinds = set()
        for place, omega, a in zip(places, *found.at(places), strict=True):
            if k:
                period, ag = float(found.structure.period(omega)), float(a * found.structure.unit)
                motion = replace(SINE, amplitude=ag, period=period).sampled(COARSE_POINTS_PER_PERIOD)
                alone = respond(BLOCK, motion, models=("nonlinear",))["nonlinear"]
                impacts, rocks = alone.impact_count if alone.fell else None, alone.peak_ratio > 0
            else:
                alone = exact_pulse(float(a), float(omega), 0.9)
                impacts, rocks = alone.impacts_before_overturning, alone.max_ratio != 0
            kind = OutcomeKind(int(rocks) if impacts is None else (4, 2, 3)[min(impacts, 2)])
            assert painted(found.edges, place) == kind
            kinds.add(kind)
        assert kinds >= {OutcomeKind.ROCKS, OutcomeKind.AFTER_ONE, OutcomeKind.WITHOUT_IMPACT}
        assert not found.edges.stepped and found.edges.simulated < 4000

    def test_contours_end_at_the_edges_of_where_it_rocks(self, maps):
        for found in maps:
            levels = [np.concatenate(pieces) for pieces in found.edges.contours]
            assert len(levels) == len(CONTOUR_LEVELS)
            for level, pieces in zip(CONTOUR_LEVELS, found.edges.contours, strict=True):
                for piece in pieces:
                    for end in (piece[0], piece[-1]):
                        assert min(end.real, end.imag, 49 - end.real, 49 - end.imag) == pytest.approx(0, abs=1e-12)
                omega, a = found.at(np.concatenate(pieces)[::5])
                again = outcomes(found.structure, SINE, found.structure.period(omega), a * found.structure.unit)
                np.testing.assert_allclose(again.peak_ratio[~again.fell], level, atol=0.06)
                assert again.fell.mean() < 0.1

    def test_islands_are_steps_and_the_work_is_bounded(self):
        rng, simulated = np.random.default_rng(1), []
        kinds = rng.integers(1, 3, (30, 30))

        def at_random(places):
            simulated.append(places.size)
            return rng.integers(1, 3, places.size)

        edges = edges_of(kinds, at_random, np.full(kinds.shape, 0.5), CONTOUR_LEVELS, falls=2, unknown=5)
        assert edges.stepped and edges.simulated == sum(simulated) <= FREE_POINTS
        for row, column in zip(*rng.integers(0, 30, (2, 60)), strict=True):
            place = complex(np.clip(column, 0.01, 28.99), np.clip(row, 0.01, 28.99))
            assert painted(edges, place) == kinds[row, column]
        assert all(not pieces for pieces in edges.contours[:3])  # islands of a point or two have none

    def test_those_in_closed_form_bound_the_colours(self, maps):
        found, _ = maps
        level = {each.name: each.level for each in found.boundaries}
        step, bottom = found.a[1] - found.a[0], min(np.concatenate(found.edges.outlines[OutcomeKind.ROCKS]).imag)
        assert found.at(np.array([1j * bottom]))[1] == pytest.approx(1, abs=step / 32)
        line = np.concatenate(found.edges.outlines[OutcomeKind.WITHOUT_IMPACT])
        line = line[(np.minimum(line.real, line.imag) > 0) & (np.maximum(line.real, line.imag) < 49)]
        below, above = (level["without_impact"](*found.at(line + away)) for away in (0.06 - 0.06j, 0.06j - 0.06))
        assert line.size > 20 and (below < 0).all() and (above > 0).all()

    @pytest.mark.parametrize(("mechanism", "shape"), [(BLOCK, "ricker"), (load_structure(FRAME), "half_sine")])
    def test_the_default_ranges_contain_where_overturning_starts(self, mechanism, shape):
        form = parse_shape(shape)
        structure = pulsed_model(Structure(mechanism), "linear2", form)
        shortest, longest = usual_periods([structure], form)
        low, high = usual_amplitudes([structure])
        periods = np.geomspace(shortest, longest, 9)
        (least,) = compare([structure], form, periods, high).least
        assert np.isnan(least[0]) and np.isfinite(least[2:]).all()
        uplift = structure.unit / STANDARD_GRAVITY
        assert low < 0.75 * uplift and least[-1] < 1.5 * uplift < least[2] < high


class TestPictures:
    def test_a_map_names_its_regions_and_boundaries(self, plane):
        figure = draw_map(plane, "a block", dimensionless=True)
        (axes,) = figure.axes
        (legend,) = figure.legends
        labels = [text.get_text() for text in legend.get_texts()]
        colours = {each.get_label(): to_hex(each.get_facecolor()) for each in legend.get_patches()}
        for name in ("does not uplift", "rocks", "overturns after one impact"):
            assert colours[name] == style.REGIONS[name] and name in labels
        assert "overturning without impact (closed form)" in labels and "uplift (closed form)" in labels
        assert "omega" in axes.get_xlabel() and "lambda" in axes.get_ylabel() and "uplift" in axes.get_ylabel()

    def test_one_of_a_structure_has_units_and_fills_its_axes(self):
        structure = pulsed_model(Structure(BLOCK), "linear2", SINE)
        found = overturning_map(structure, SINE, np.geomspace(1, 8, 20), np.geomspace(0.5, 9, 20))
        (axes,) = draw_map(found, "a block", dimensionless=False).axes
        assert "[s]" in axes.get_xlabel() and "[g]" in axes.get_ylabel()
        assert axes.get_xscale() == axes.get_yscale() == "log"
        assert axes.get_xlim() == pytest.approx((found.periods.min(), found.periods.max()))
        high = replace(found, a=found.a + 1, outcome=found.outcome.by_field(lambda each: each[-5:]))
        for part in (found, replace(high, a=found.a[-5:])):
            paths = list(draw_map(part, "", dimensionless=True).axes[0].patches)
            assert len(paths) == len(set(part.kinds.ravel().tolist()) - {0})

    def test_curves_differ_by_dash_and_mark(self, curves):
        (axes,) = draw_comparison(curves, "sine").axes
        looks = {(line.get_linestyle(), line.get_marker(), line.get_color()) for line in axes.get_lines()}
        assert len({look[0] for look in looks}) == len({look[1] for look in looks}) == 3
        np.testing.assert_array_equal(axes.get_lines()[1].get_ydata(), curves.least[1])

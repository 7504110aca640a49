"""Curves of limit states that imply each other never cross, and that of uplift is a step where it is known."""

from dataclasses import replace

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.questions.fragility import exports as openquake
from rocking_cli.questions.fragility import ranking, tally
from rocking_cli.questions.fragility.assess import Fragility, curves
from rocking_cli.questions.fragility.curves import FragilityCurve
from rocking_cli.questions.fragility.definition import implies
from rocking_cli.questions.fragility.exports import chosen
from rocking_cli.questions.fragility.hazard_curve import HazardCurve, annual_rate
from rocking_cli.questions.fragility.observed import Observations
from rocking_cli.questions.fragility.store import Store
from rocking_cli.questions.fragility.study import load_study
from rocking_cli.questions.fragility.tally import accelerations
from rocking_cli.questions.fragility.view import fit_columns, fits_in_words
from rocking_cli.studies.fit import Fit
from rocking_cli.views.column import data_of
from tests.conftest import EXAMPLES

LIMITS = ["uplift", 0.1, 0.5, "25 mm", "overturning"]
STUDY = {
    "structures": [EXAMPLES / "block.yaml", EXAMPLES / "frame.yaml"],
    "records": [
        EXAMPLES / "accel.csv",
        *({"pulse": f"{shape}:1g:{period}s"} for shape in ("ricker", "sine", "mavroeidis") for period in (0.5, 1, 1.5)),
    ],
    "method": "stripes",
    "levels": {"measure": "PGA", "least": 0.1, "most": 1.3, "count": 17},
    "polarity": "both",
    "limit_states": LIMITS,
    "measures": ["PGA", "PGA/(g lambda)", "PGV"],
}
X = np.geomspace(0.02, 10, 500)


@pytest.fixture(scope="module")
def answer(tmp_path_factory):
    return rk.fragility(STUDY, store=tmp_path_factory.mktemp("order") / "order.runs")


def of(answer, structure, measure):
    return {each.limit: each for each in answer.result if (each.structure, each.measure) == (structure, measure)}


def lines(curve):
    return np.array([curve.probability(X), *curve.band(X)])


def test_what_implies_what():
    found = {(a, b) for a in (*LIMITS, "9 mm", "sliding") for b in (*LIMITS, "9 mm", "sliding") if implies(a, b)}
    rest = [each for each in (*LIMITS, "9 mm", "sliding") if each != "uplift"]
    expected = {(each, "uplift") for each in rest} | {(0.5, 0.1), ("25 mm", "9 mm")}
    assert found == expected | {("overturning", each) for each in (0.1, 0.5, "25 mm", "9 mm")}
    loose = {(a, b) for a, b in found if not implies(a, b, slides=True)}  # what slides need not uplift
    assert loose == {(each, "uplift") for each in ("25 mm", "9 mm", "sliding")}


def test_no_curve_and_no_band_is_above_one_that_it_implies(answer):
    crossed = 0
    for structure in {each.structure for each in answer.result}:
        for measure in STUDY["measures"]:
            found = of(answer, structure, measure)
            for one, other in [(a, b) for a in LIMITS for b in LIMITS if implies(a, b)]:
                assert (lines(found[one].curve) <= lines(found[other].curve)).all(), (structure, measure, one, other)
                crossed += (lines(found[one].curve.own) > lines(found[other].curve.own) + 0.01).any()
    assert crossed  # as fitted, they do cross


def test_uplift_is_a_step_at_lambda_if_both_directions_are_alike(answer):
    block, frame = dict.fromkeys(each.structure for each in answer.result)
    for measure, at in (("PGA", 0.25), ("PGA/(g lambda)", 1.0)):
        uplift = of(answer, block, measure)["uplift"]
        assert uplift.curve.kind == "step" and uplift.curve.median.value == pytest.approx(at, rel=1e-9)
        assert uplift.curve.median.low == uplift.curve.median.high == uplift.curve.median.value
        for each in of(answer, block, measure).values():
            assert not lines(each.curve)[:, at * 0.999 > X].any()
    # One polarity of the frame may not uplift it at its lambda, but none does below.
    weak = of(answer, frame, "PGA")
    at = weak["uplift"].curve.implied["lambda"].step.value
    assert at == answer.plan.trials[1].lambda_ == weak["uplift"].curve.median.low
    assert all(not lines(each.curve)[:, at > X].any() for each in weak.values())
    assert (weak["overturning"].curve.own.band(X[at > X])[1] > 0.2).any()
    assert of(answer, block, "PGV")["uplift"].curve.kind != "step"


def test_what_is_cut_is_said(answer):
    text = " ".join(answer.sentences)
    assert "a motion uplifts the structure exactly if its PGA exceeds 0.25 g, so no curve is fitted." in text
    assert "overturning" in text and "cut by that of uplift, which it implies: by up to" in text
    assert "Curve and band are cut by lambda, up to which nothing uplifts" in text
    for found, shown in zip(answer.result, answer.to_dict()["curves"], strict=True):
        x = np.geomspace(found.seen.x.min(), found.seen.x.max(), 200)
        own, cut = found.curve.own, found.curve
        most = max((own.probability(x) - cut.probability(x)).max(), *(np.array(own.band(x)) - cut.band(x)).max(axis=1))
        assert (shown["cut"] is None) == (most <= 0.001)
        if shown["cut"] is not None:
            assert shown["cut"]["most"] == pytest.approx(most)


def test_the_rate_is_that_of_the_curve_that_is_cut(answer):
    block = next(each.structure for each in answer.result)
    curve = of(answer, block, "PGA")["overturning"].curve
    hazard = HazardCurve(np.array([0.05, 2.0]), np.array([0.05, 0.05 / 40**2]))
    cut, whole = annual_rate(curve, hazard), annual_rate(curve.own, hazard)
    x = np.geomspace(0.05, 2.0, 200_001)
    middle = np.sqrt(x[1:] * x[:-1])
    rate = hazard.rate(x)
    expected = (curve.probability(middle) * -np.diff(rate)).sum() + curve.probability(x[-1]) * rate[-1]
    assert cut.rate == pytest.approx(expected, rel=1e-4) and cut.rate < 0.95 * whole.rate
    assert cut.below == 0 < whole.below


def test_openquake_knows_up_to_where_there_is_no_damage(answer):
    block = next(each.structure for each in answer.result)
    model = chosen([each for each in answer.result if each.structure == block and each.limit in (0.1, "overturning")])
    (function,) = [each for each in model.functions if each.measure == "PGA"]
    assert function.undamaged == pytest.approx(0.25)
    assert function.ends[0] < 0.25


def test_what_is_not_exact_or_contradicted_is_from_the_runs(answer):
    block = next(each.structure for each in answer.result)
    kept = Store.reading(answer.store)
    found = tally.count(kept, answer.plan, block, answer.definition)
    assert found.over("PGA").onset("PGA") == (pytest.approx(0.25), True)
    assert found.over("PGV").onset("PGV") is None
    for wrong in (found.runs, 0 * found.runs):
        other = replace(found, exceeding={**found.exceeding, "uplift": wrong})
        assert other.over("PGA").onset("PGA") is None
    asked = answer.definition.model_copy(update={"measures": ["PGA"]})
    fitted = list(curves(replace(found, uplift=None), block, asked, None))
    assert (fitted[0].curve.step.low, fitted[0].curve.step.high) == pytest.approx((0.25, 0.325))
    assert set(accelerations(load_study(STUDY), answer.plan)) == {each.structure for each in answer.result}
    assert accelerations(load_study({**STUDY, "floor": "T1=0.3,z/H=1,n=3"}), answer.plan) == {}


def test_a_dispersion_without_sense_is_not_shown():
    cov = np.eye(2) * 1e-4
    for slope, told in ((0.19, False), (0.21, True)):
        fit = Fit("probit", np.array([0.0, slope]), cov, 0.0, 0.95)
        curve = FragilityCurve("lognormal", "as it is", 0.95, 9, 4, fit=fit)
        found = Fragility("a", "uplift", "PGV", Observations.of(X, X > 1, np.arange(X.size)), curve, None)
        assert (curve.dispersion is not None) == told == (not np.isnan(ranking._dispersion(found)))
        assert ("Its dispersion is above 5" in view_of(found)) == (not told)
        assert (data_of(fit_columns(), ("", found))["dispersion"] is None) == (not told)
    flat = replace(found, curve=replace(curve, fit=replace(fit, coefficients=np.array([0.0, 0.1]))))
    assert "its dispersion is above 5" in openquake.why_not(flat)


def view_of(found):
    """Return the sentences on one curve."""
    return " ".join(each for each in fits_in_words("a", fit_columns(), "PGV", [found]) if isinstance(each, str))

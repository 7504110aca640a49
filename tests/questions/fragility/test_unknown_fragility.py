"""Runs of unknown outcome in fragility studies: counted twice, a band and never one line, and never a peak."""

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import yaml

from rocking_cli.dynamics.history import follow
from rocking_cli.errors import InputError
from rocking_cli.questions.fragility import assess, quantiles, tally
from rocking_cli.questions.fragility import exports as openquake
from rocking_cli.questions.fragility.assess import Fragility
from rocking_cli.questions.fragility.curves import fit_curve
from rocking_cli.questions.fragility.observed import Observations
from rocking_cli.questions.fragility.picture import draw_curves, draw_ida, draw_quantiles, draw_surface, edges
from rocking_cli.questions.fragility.quantiles import all_quantiles
from rocking_cli.questions.fragility.ranking import judge, rank
from rocking_cli.questions.fragility.store import COLUMNS, UNKNOWN, RunRows, Store
from rocking_cli.studies.contact import Contacts
from rocking_cli.studies.fragility.quantities import kept
from tests.conftest import EXAMPLES, rows_of
from tests.following import build_model
from tests.questions.fragility.test_study_runs import carry_out
from tests.stores import command, every_run

LIMITS = ["uplift", 0.1, "40 mm", "sliding", "overturning"]
GIVEN = {
    "structures": [str(EXAMPLES / "masonry" / "portal.yaml")],
    "records": [str(EXAMPLES / "accel.csv"), {"pulse": "ricker:1g:0.8s"}, {"pulse": "sine:1g:0.6s"}],
    "polarity": "both", "method": "stripes", "limit_states": LIMITS, "bivariate": [["PGA", "PGV"]],
    "levels": {"measure": "PGA", "least": 0.2, "most": 1.5, "count": 6},
    "hazard": {"points": [[0.1, 0.01], [2, 0.0001]]},
}  # fmt: skip


def write(folder, **changes):
    path = folder / "study.yaml"
    path.write_text(yaml.safe_dump({**GIVEN, **changes}), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A study in which many runs are of unknown outcome, its runs, and the histories they are of."""
    folder = tmp_path_factory.mktemp("unknown")
    path = write(folder)
    prepared = carry_out(path, folder / "study.runs", jobs=2)
    plan, study = prepared.plan, prepared.study
    held = Store.reading(folder / "study.runs")
    rows, reach = every_run(folder / "study.runs"), kept(held.facts, LIMITS)["40 mm"]
    _, record, _, level, polarity = plan.places(rows.run)
    (sample,) = study.samples
    motions = [source.read() for source in study.sources]
    shaken = [
        motions[r].scaled(scale * plan.polarities[p])
        for r, p, scale in zip(record, polarity, rows.scale.tolist(), strict=True)
    ]
    model = build_model(sample.mechanism, "nonlinear")  # as `respond` does
    histories = [follow(model, each) for each in shaken]
    contacts = Contacts(sample.mechanism)
    slides = [contacts.check(*each).slides for each in zip(histories, shaken, strict=True)]
    return SimpleNamespace(
        path=path, place=folder / "study.runs", plan=plan, rows=rows, level=level, record=record, polarity=polarity,
        histories=histories, slides=slides, reach=reach[0], phi_cr=model.phi_cr, definition=study.definition,
    )  # fmt: skip


def both(whole, limit):
    """Which runs exceed a limit, as far as is known and at most, by their histories."""
    surely, maybe = [], []
    for k, each in enumerate(whole.histories):
        lifts = np.isfinite(each.uplift_time)
        if limit == "uplift":
            found = lifts
        elif limit == "sliding":
            found = np.isfinite(whole.slides[k])
        elif each.overturned:
            found = True
        elif limit == "overturning":
            found = False
        else:
            before = each.time < (each.warned if each.unknown and np.isfinite(each.warned) else np.inf)
            sides = np.array([np.nanmax(sign * each.phi[before], initial=0.0) for sign in (1, -1)])
            found = (sides > (whole.reach if limit == "40 mm" else limit * np.array(whole.phi_cr))).any()
        surely.append(bool(found))
        maybe.append(bool(found or each.unknown))
    return np.array(surely), np.array(maybe)


def counted(whole, *, ladders=False):
    held = Store.reading(whole.place)
    definition = whole.definition.model_copy(update={"method": "ida" if ladders else "stripes"})
    return tally.count(held, whole.plan, "portal", definition)


def test_each_run_keeps_what_respond_says_of_it(whole):
    rows = whole.rows
    unknown = np.array([each.unknown for each in whole.histories])
    assert np.array_equal(rows.outcome == UNKNOWN, unknown) and 0.2 < unknown.mean() < 0.8
    for name in ("known_to", "peak_ratio", "peak_positive", "uplift_time"):
        expected = [getattr(each, name) for each in whole.histories]
        np.testing.assert_allclose(getattr(rows, name), expected, rtol=1e-12, err_msg=name)
    expected = [each.lower_bound if each.unknown else np.nan for each in whole.histories]
    np.testing.assert_allclose(rows.lower_bound, expected, rtol=1e-12)
    assert (rows.lower_bound[unknown] <= rows.peak_ratio[unknown]).all() and np.isfinite(rows.opening).all()
    assert (rows.opening[unknown] > 0.005).all() and (rows.opening[~unknown] <= 0.005).all()
    assert not (rows.slide_time[unknown] > rows.known_to[unknown]).any()


@pytest.mark.parametrize("limit", LIMITS)
def test_exceedances_are_counted_twice(whole, limit):
    found, (surely, maybe) = counted(whole), both(whole, limit)
    assert found.unknown == sum(each.unknown for each in whole.histories) and found.checked
    for counts, expected in ((found, maybe), (found.lower, surely)):
        table = np.zeros(counts.exceeding[limit].shape)
        np.add.at(table, (0, whole.record, whole.level), expected)
        np.testing.assert_array_equal(counts.exceeding[limit], table)
    if limit in ("uplift", "sliding"):  # in this study all that are unknown slide first
        np.testing.assert_array_equal(surely, maybe)
    else:
        assert 0 < surely.sum() < maybe.sum()


def runs(*, outcome, peaks, uplifts, slides, **more):
    """Runs with these columns; what else there is of a run is not read."""
    nothing = dict.fromkeys(COLUMNS, np.full(outcome.size, np.nan)) | {"slip": np.zeros(outcome.size)}
    times = {"uplift_time": np.where(uplifts, 1.0, np.nan), "slide_time": np.where(slides, 1.0, np.nan)}
    ends = {"outcome": outcome, "peak_positive": peaks[:, 0], "peak_negative": peaks[:, 1]}
    return RunRows(**nothing | times | more | ends)


def test_what_is_known_of_a_run_is_known_of_the_side_on_which_it_was_seen():
    # Of unknown outcome, with a bound of 0.5 of the critical rotations .2 and .1; which side it is of tell the peaks.
    peaks = np.array([[0.15, 0.02], [0.04, 0.06], [0.15, 0.06], [0.15, 0.06]])
    outcome, flags = np.array([UNKNOWN, UNKNOWN, UNKNOWN, 0]), np.array([True, True, False, True])
    bound = np.array([0.5, 0.5, 0.5, np.nan])
    found = runs(
        outcome=outcome, peak_ratio=np.full(4, 0.75), peaks=peaks, uplifts=flags, slides=flags & (np.arange(4) != 1),
        lower_bound=bound,
    )  # fmt: skip
    phi_cr, reach = np.tile([0.2, 0.1], (4, 1)), np.tile([0.09, 0.055], (4, 1))
    known = {limit: tally.known_to_exceed(found, limit, None, phi_cr).tolist() for limit in (*LIMITS[:2], 0.6)}
    assert known == {"uplift": flags.tolist(), 0.1: [True] * 4, 0.6: [False, False, False, True]}
    assert tally.known_to_exceed(found, "40 mm", reach, phi_cr).tolist() == [True, False, False, True]
    assert tally.known_to_exceed(found, "sliding", None, phi_cr).tolist() == [True, False, False, True]
    assert tally.known_to_exceed(found, "overturning", None, phi_cr).tolist() == [False] * 4
    for limit in ("uplift", "sliding", "40 mm", 0.6, 0.8, "overturning"):
        upper = tally.exceeds(found, limit, reach if limit == "40 mm" else None)
        assert upper[:3].all() and upper[3] == (limit not in (0.8, "overturning"))


def test_a_bound_that_is_the_peak_itself_is_known_of_its_side():
    """Nothing larger came after the first warning: .5 of the critical rotation .2 is the peak of .1 that way."""
    peaks, flags = np.array([[0.1, 0.04]]), np.ones(1, bool)
    found = runs(
        outcome=np.array([UNKNOWN]), peak_ratio=np.full(1, 0.5), peaks=peaks, uplifts=flags, slides=flags,
        lower_bound=np.array([0.5]),
    )  # fmt: skip
    phi_cr = np.array([[0.2, 0.1]])
    for reach, known in (([0.09, 0.01], True), ([0.09, 0.045], True), ([0.11, 0.01], False)):
        assert tally.known_to_exceed(found, "40 mm", np.array([reach]), phi_cr).tolist() == [known], reach


def test_a_slip_counts_where_the_outcome_is_known_and_where_it_was_before_it_ended():
    """Two bodies slide by 30 mm, one of them up to what it then meets; the third rocks."""
    outcome, slip = np.array([0, UNKNOWN, 0]), np.array([0.03, 0.03, 0.0])
    peaks = np.array([[0.0, 0.0], [0.0, 0.0], [0.1, 0.0]])
    found = runs(
        outcome=outcome, peak_ratio=peaks[:, 0] / 0.2, peaks=peaks, uplifts=peaks[:, 0] > 0, slides=slip > 0,
        lower_bound=np.array([np.nan, 0.0, np.nan]), slip=slip,
    )  # fmt: skip
    phi_cr, reach = np.full((3, 2), 0.2), np.full((3, 2), 0.05)
    for limit, known, maybe in (
        ("29 mm", [True, True, True], [True, True, True]),
        ("31 mm", [False, False, True], [False, True, True]),
    ):
        assert tally.known_to_exceed(found, limit, reach, phi_cr).tolist() == known
        assert tally.exceeds(found, limit, reach).tolist() == maybe
    assert tally.known_to_exceed(found, 0.1, None, phi_cr).tolist() == [False, False, True]


@pytest.mark.parametrize("limit", LIMITS)
def test_ladders_first_exceed_twice(whole, limit):
    found = counted(whole, ladders=True)
    records, levels = len(whole.plan.records), len(whole.plan.levels)
    for counts, exceeds in zip((found.lower, found), both(whole, limit), strict=True):
        first = np.full((records, 2), levels)
        np.minimum.at(first, (whole.record[exceeds], whole.polarity[exceeds]), whole.level[exceeds])
        np.testing.assert_array_equal(counts.ladders.first[limit][0, :, 0], first)


def test_the_second_curve_is_that_of_the_runs_known_to_exceed(whole):
    found = {each.limit: each for each in assess.curves(counted(whole), "portal", whole.definition, None)}
    x = np.array(whole.plan.levels)[whole.level]
    for limit in LIMITS:
        surely, maybe = both(whole, limit)
        each, undecided = found[limit], int((maybe & ~surely).sum())
        assert (each.unknown, each.is_band) == (undecided, undecided > 0)
        assert (each.lower is None) == (undecided == 0)
        for one, exceeds in ((each, maybe), *([(each.lower, surely)] if undecided else [])):
            expected = fit_curve(Observations.of(x, exceeds, whole.record))
            if limit == "uplift":  # known without runs
                low, high = expected.step.low, expected.step.high
                assert low < one.curve.step.value == one.curve.step.low < high
            else:
                assert (one.curve.why, one.curve.own.median) == (expected.why, expected.median)
    assert found["overturning"].share == pytest.approx(found["overturning"].unknown / whole.plan.size)


def test_few_runs_of_unknown_outcome_leave_one_curve(whole, monkeypatch):
    monkeypatch.setattr(assess, "MAX_UNKNOWN_SHARE", 0.9)
    shown = command("results", whole.place)
    assert "these count as exceeding." in shown.stdout and ", lower" not in shown.stdout
    overturning = json.loads(command("results", whole.place, "--json").stdout)["curves"][-1]
    assert not overturning["band"] and overturning["lower"]["exceedances"] < overturning["exceedances"]
    found = {each.limit: each for each in assess.curves(counted(whole), "portal", whole.definition, None)}
    assert list(edges("a", found["overturning"])) == ["a"]


def half_of(curve):
    """What is said of the median of a curve over PGA, as JSON has it; the levels tried are from 0.2 g to 1.5 g."""
    if curve["median"] is None or (curve["kind"] == "lognormal" and curve["dispersion"] is None):
        return "at no known PGA"
    value, low, high = (np.inf if end is None else end for end in curve["median"].values())
    outside = "" if 0.2 <= value <= 1.5 else ", outside the intensities of the runs"
    most = " g or more" if np.isinf(high) else f" to {high:.3g} g"
    return f"at PGA {value:.3g} g (95 %: {low:.3g}{most}){outside}"


def test_words_and_json_state_a_band_and_how_many_runs_are_unknown(whole):
    shown, data = command("results", whole.place), json.loads(command("results", whole.place, "--json").stdout)
    unknown = int((whole.rows.outcome == UNKNOWN).sum())
    assert f"{whole.plan.size} runs ({unknown} of unknown outcome)" in shown.stdout
    size = whole.plan.size
    expected = {"structure": "portal", "runs": size, "unknown": unknown, "checked": True, "by_blocks": 0, "off_edge": 0}
    assert data["outcomes"] == [expected | {"share": unknown / size}]
    assert f"portal: {unknown} of {whole.plan.size} runs" in data["notes"][0]
    lines = [line.strip() for line in shown.stdout.splitlines()]
    for curve in data["curves"]:
        surely, maybe = both(whole, curve["limit_state"])
        assert (curve["exceedances"], curve["unknown"]) == (maybe.sum(), (maybe & ~surely).sum())
        assert (curve["lower"] or curve)["exceedances"] == surely.sum()
        assert curve["unknown_share"] == curve["unknown"] / whole.plan.size and curve["band"] == (curve["unknown"] > 0)
        if curve["limit_state"] == "overturning":
            assert curve["annual_rate"]["rate"] > curve["lower"]["annual_rate"]["rate"] > 0
            assert lines[0] == f"portal: 50 % overturn {half_of(curve)}, if runs of unknown outcome overturn, and " + (
                f"{half_of(curve['lower'])}, if they do not."
            )
    for edge in ("upper", "lower"):
        assert any(line.startswith(f"overturning, {edge} ") for line in lines)
        assert not any(line.startswith(f"uplift, {edge}") for line in lines)
    for surface in data["surfaces"]:
        surely, maybe = both(whole, surface["limit_state"])
        assert surface["exceedances"] - (surface["lower"] or surface)["exceedances"] == (maybe & ~surely).sum()


def test_quantiles_count_unknown_as_overturned_and_say_so(whole, monkeypatch):
    monkeypatch.setattr(quantiles, "MIN_RECORDS", (1, 1, 1))
    peaks = np.where(whole.rows.outcome == 0, whole.rows.peak_ratio, np.inf)
    held = Store.reading(whole.place)
    (found,) = all_quantiles(held, whole.plan, whole.definition)
    data = json.loads(command("results", whole.place, "--json").stdout)["quantiles"][0]["intensities"]
    doubtful = []
    for k, (group, said) in enumerate(zip(found.groups, data, strict=True)):
        own = whole.level == k
        outcome = whole.rows.outcome[own]
        assert (group.unknown, group.overturned) == ((outcome == UNKNOWN).sum(), (np.abs(outcome) == 1).sum())
        expected = np.quantile(peaks[own], (0.16, 0.5, 0.84), method="inverted_cdf")
        np.testing.assert_array_equal(group.every, expected, err_msg=f"{k}")
        known = np.sort(outcome[np.argsort(peaks[own], kind="stable")] == UNKNOWN)
        assert said["unknown"] == known.mean()
        finite, stands = np.isfinite(group.every), np.isfinite(peaks[own]).sum()
        ranks = np.ceil(np.array([0.16, 0.5, 0.84]) * own.sum() - 1e-9)
        words = [
            value if there else "unknown" if rank <= stands + group.unknown else "overturns"
            for value, there, rank in zip(group.every, finite, ranks, strict=True)
        ]
        assert said["all"] == words
        doubtful += words
    assert {"unknown", "overturns"} <= set(map(str, doubtful))
    assert "unknown" in command("results", whole.place, "--quantiles").stdout


def test_a_ranking_leaves_them_out_and_counts_them(whole):
    held = Store.reading(whole.place)
    (ranking,) = rank(held, whole.plan, whole.definition)
    stands = (whole.rows.outcome == 0) & (whole.rows.peak_ratio > 0)
    assert {each.runs for each in ranking.measures} == {int(stands.sum())}
    assert ranking.unknown == (whole.rows.outcome == UNKNOWN).sum()
    assert f"{ranking.unknown} runs of unknown outcome are left out." in judge(ranking)
    assert all(np.isnan(each.dispersions["overturning"]) for each in ranking.measures)  # a band has none


def test_openquake_gets_no_band(whole, tmp_path):
    refused = command("results", whole.place, "--nrml", tmp_path / "out.xml")
    assert refused.exit_code == 5 and "of unknown outcome: the result is a band" in refused.stderr
    assert not (tmp_path / "out.xml").exists()
    x, records = np.repeat([0.2, 0.4, 0.6, 0.8], 20), np.arange(80)
    seen = Observations.of(x, np.concatenate([np.arange(20) < k for k in (1, 5, 12, 19)]), records)
    curve = Fragility("a", "overturning", "PGA", seen, fit_curve(seen), None, unknown=1)
    assert len(openquake.chosen([curve]).functions) == 1  # up to 2 % count as exceeding
    with pytest.raises(InputError, match=r"2\.5 % of the runs are of unknown outcome"):
        openquake.chosen([replace(curve, unknown=2)])


def test_tables_have_both_curves_and_the_lower_bound(whole, tmp_path):
    curves, runs = tmp_path / "curves.csv", tmp_path / "runs.csv"
    assert command("results", whole.place, "--curves", curves, "--out", runs).exit_code == 0
    rows = rows_of(curves)
    top = [row for row in rows if row["limit_state"] == "overturning"][-1]
    assert float(top["unknown"]) > 0.02 and float(top["lower_probability"]) < float(top["probability"])
    known = next(row for row in rows if row["limit_state"] == "uplift")
    assert known["lower_probability"] == known["probability"] and float(known["unknown"]) == 0
    for row, each in zip(rows_of(runs), whole.histories, strict=True):
        assert (row["outcome"] == "unknown") == each.unknown == bool(row["known_to [s]"])
        assert not each.unknown or float(row["peak_lower_bound"]) == pytest.approx(each.lower_bound, rel=1e-8)


def test_pictures_hatch_what_is_not_known(whole, tmp_path):
    found = list(assess.curves(counted(whole), "portal", whole.definition, None))
    each = next(each for each in found if each.limit == "overturning")
    figure = draw_curves({"overturning": each}, "PGA [g]", "a portal")
    (axes,) = figure.axes
    (band,) = [collection for collection in axes.collections if collection.get_hatch()]
    x, y = band.get_paths()[0].vertices.T
    upper, lower = each.curve.probability(x), each.lower.curve.probability(x)
    inside = (y >= np.minimum(upper, lower) - 1e-9) & (y <= np.maximum(upper, lower) + 1e-9)
    assert inside.all() and y.max() == pytest.approx(upper.max()) and np.ptp(y[x > 1]) > 0.3
    (legend,) = figure.legends
    said = [" ".join(text.get_text().split()) for text in legend.get_texts()]
    assert said[0].startswith("overturning, if unknown runs exceed:")
    assert said[1].startswith("overturning, if unknown runs do not:")
    assert said[2].startswith("runs of unknown outcome: overturning ")
    held = Store.reading(whole.place)
    peaks = tally.peaks(held, whole.plan, "portal")
    (found,) = all_quantiles(held, whole.plan, whole.definition)
    assert np.isinf(peaks).sum() == (whole.rows.outcome == UNKNOWN).sum()
    assert np.isnan(peaks).sum() == (np.abs(whole.rows.outcome) == 1).sum()
    figure = draw_ida(np.array(whole.plan.levels), peaks, "PGA [g]", "a portal")
    assert [text.get_text() for text in figure.axes[0].get_yticklabels()][-2:] == ["unknown", "overturns"]
    shares = draw_quantiles(found, "PGA [g]").axes[1].collections
    assert [each.get_label() for each in shares if each.get_hatch()] == ["unknown"]
    surface = next(each for each in assess.surfaces(counted(whole), "portal", whole.definition) if each.limit == 0.1)
    figure = draw_surface(surface, ("PGA", "PGV"), "a portal")
    assert any(text.get_text() == f"unknown outcome ({surface.unknown})" for text in figure.legends[0].get_texts())
    figure.draw_without_rendering()


def test_joints_that_are_not_known_are_a_caution_and_null(tmp_path):
    structures = [str(EXAMPLES / "curve.yaml"), str(EXAMPLES / "block.yaml")]
    path = write(tmp_path, structures=structures, limit_states=["uplift", "overturning"], bivariate=[])
    data = json.loads(command("fragility", path, "--json").stdout)
    facade, block = data["outcomes"]
    assert (facade["unknown"], facade["share"], block["unknown"], block["share"]) == (None, None, 0, 0)
    assert len(data["notes"]) == 1 and facade["structure"] in data["notes"][0]
    for curve in data["curves"]:
        assert curve["unknown"] == (None if curve["structure"] == facade["structure"] else 0)
        assert not curve["band"] and curve["lower"] is None

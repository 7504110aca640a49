"""Quantiles of the peak rotation: against what the runs of the store say one by one."""

import json
from dataclasses import replace

import numpy as np
import pytest
import yaml
from scipy.stats import binom

from rocking_cli.names import MIN_MOTIONS, MIN_MOTIONS_OF_MEDIAN
from rocking_cli.questions.fragility import quantiles
from rocking_cli.questions.fragility.picture import draw_quantiles
from rocking_cli.questions.fragility.quantiles import Group, Quantiles, all_quantiles
from rocking_cli.questions.fragility.store import Store
from tests.conftest import EXAMPLES
from tests.questions.fragility.test_study_runs import carry_out
from tests.stores import command, every_run

WIDTH = {"normal": {"mean": 0.7, "deviation": 0.05}}
BLOCK = {"file": str(EXAMPLES / "block.yaml"), "name": "uncertain", "vary": {"width": WIDTH}}
PULSES = [{"pulse": f"{shape}:0.6g:{period}s"} for shape in ("sine", "ricker", "mavroeidis") for period in (0.7, 1.2)]
MEASURES = ["PGA", "PGV", "PGA/(g lambda)"]


@pytest.fixture(scope="module", autouse=True)
def however_few():
    """All quantiles of the six records: a test of its own has those that are too few."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(quantiles, "MIN_RECORDS", (1, 1, 1))
        yield


def study(folder, method, measures=MEASURES):
    given = {
        "structures": [str(EXAMPLES / "frame.yaml"), BLOCK], "records": PULSES, "polarity": "both", "samples": 2,
        "measures": measures, "limit_states": ["uplift", "overturning"], "method": method,
        "levels": {"measure": "scale" if method == "cloud" else "PGA", "least": 0.15, "most": 1.5, "count": 5},
    }  # fmt: skip
    path = folder / "study.yaml"
    path.write_text(yaml.safe_dump(given), encoding="utf-8")
    return path


@pytest.fixture(scope="module", params=["stripes", "cloud"])
def whole(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp(request.param)
    path = study(folder, request.param)
    prepared = carry_out(path, folder / "study.runs", jobs=1)
    store = Store.reading(folder / "study.runs")
    definition = prepared.study.definition
    return prepared.plan, definition, folder / "study.runs", list(all_quantiles(store, prepared.plan, definition))


def ranked(place, plan, structure, measure):
    """Intensity and peak of every run of a structure, one by one."""
    rows = every_run(place)
    sample, record, _, level, _ = plan.places(rows.run)
    own = np.array([plan.trials[k].structure == structure for k in sample])
    x = plan.intensities(measure, sample, record, level, rows.scale)
    peak = np.where(rows.outcome != 0, np.inf, np.where(np.isnan(rows.uplift_time), 0.0, rows.peak_ratio))
    return x[own], peak[own], record[own]


def same(found, values):
    if not values.size:
        return all(np.isnan(each) for each in found)
    return found == tuple(np.quantile(values, (0.16, 0.5, 0.84), method="inverted_cdf"))


def test_each_group_has_the_runs_between_its_ends_and_their_quantiles(whole):
    plan, _, place, found = whole
    assert [(each.structure, each.measure) for each in found] == [
        (structure, measure) for structure in ("valley bridge", "uncertain") for measure in MEASURES
    ]
    kinds = set()
    for each in found:
        x, peak, record = ranked(place, plan, each.structure, each.measure)
        for group in each.groups:
            of = (x >= group.low * (1 - 1e-9)) & (x <= group.high * (1 + 1e-9))
            assert group.runs == of.sum() and group.records == len(set(record[of].tolist()))
            assert group.x == pytest.approx(x[of].mean())
            assert (group.no_uplift, group.overturned) == ((peak[of] == 0).sum(), np.isinf(peak[of]).sum())
            assert same(group.rocking, peak[of][(peak[of] > 0) & np.isfinite(peak[of])])
            assert same(group.every, peak[of])
            kinds |= {np.isnan(group.rocking[0]), np.isinf(group.every[2]), group.every[0] == 0}
        assert sum(group.runs for group in each.groups) == x.size
        highs = np.array([group.high for group in each.groups])
        assert (highs[:-1] < [group.low for group in each.groups[1:]]).all()
    assert kinds == {True, False}


@pytest.mark.parametrize(("records", "told"), [(5, "---"), (6, "-m-"), (18, "lmh")])
def test_a_quantile_of_too_few_records_is_not_told(monkeypatch, records, told):
    monkeypatch.setattr(quantiles, "MIN_RECORDS", (MIN_MOTIONS, MIN_MOTIONS_OF_MEDIAN, MIN_MOTIONS))
    peaks, record = np.linspace(0.1, 0.9, 40).reshape(40, 1, 1), np.arange(40) % records
    found = quantiles._group(peaks, record, np.ones(40), 1.0, records)
    for values in (found.rocking, found.every):
        assert "".join("-" if np.isnan(value) else word for value, word in zip(values, "lmh", strict=True)) == told
    half = np.where(record[:, None, None] < records // 2, 0.0, peaks)  # half of the records do not uplift
    found = quantiles._group(half, record, np.ones(40), 1.0, records)
    assert np.isnan(found.rocking[0]) and np.isnan(found.every[0]) == (records < 18)


@pytest.mark.parametrize(("share", "fewest"), [(0.16, MIN_MOTIONS), (0.5, MIN_MOTIONS_OF_MEDIAN)])
def test_the_fewest_records_are_those_whose_range_encloses_the_quantile(share, fewest):
    def enclosed(n):  # neither all peaks below the quantile, nor all above it
        return binom(n, share).cdf(n - 1) - binom(n, share).cdf(0)

    assert enclosed(fewest - 1) < 0.95 <= enclosed(fewest)


def test_json_has_them_always_and_the_terminal_where_they_are_asked_for(whole):
    _, _, place, found = whole
    data = json.loads(command("results", place, "--json").stdout)["quantiles"]
    assert [(each["structure"], each["measure"]) for each in data] == [(each.structure, each.measure) for each in found]
    fallen = 0
    for each, own in zip(data, found, strict=True):
        assert each["shares"] == [0.16, 0.5, 0.84]
        assert each["groups"] == ("stripes" if own.stripes else "tenths")
        for group, what in zip(each["intensities"], own.groups, strict=True):
            assert group["no_uplift"] * group["runs"] == pytest.approx(what.no_uplift)
            assert group["overturned"] * group["runs"] == pytest.approx(what.overturned)
            assert group["rocking"] == [None if np.isnan(value) else value for value in what.rocking]
            assert group["all"] == ["overturns" if np.isinf(value) else value for value in what.every]
            fallen += group["all"].count("overturns")
    assert fallen
    assert "peaks of the runs that rock" not in command("results", place).stdout
    shown = command("results", place, "--quantiles").stdout
    assert shown.count("peaks of the runs that rock, against") == len(found) and "overturns" in shown
    assert ("in tenths" in shown) == any(not each.stripes for each in found)


def test_runs_that_are_not_there_count_for_nothing(whole, monkeypatch):
    plan, definition, place, _ = whole
    store = Store.reading(place)
    gone = plan.size // 3  # all of the first structure, and none of the other
    rows = store.rows

    def some(first, stop):
        for each in rows(max(first, gone), stop) if stop > gone else ():
            yield replace(each, outcome=np.where(each.run % 2 == 1, 2, each.outcome))

    monkeypatch.setattr(store, "rows", some)
    found, *_ = every = list(all_quantiles(store, plan, definition))
    assert {each.structure for each in every} == {"uncertain"}
    assert sum(each.runs for each in found.groups) == (plan.size - gone) / 2


def groups(*rows):
    return [Group(x, x, x, 10, 10, still, fallen, rocking, every) for x, still, fallen, rocking, every in rows]


NONE = (np.nan,) * 3
SOME = groups(
    (0.1, 10, 0, NONE, (0.0, 0.0, 0.0)),
    (0.2, 3, 0, (0.1, 0.2, 0.3), (0.0, 0.1, 0.25)),
    (0.3, 0, 4, (0.2, 0.4, 0.6), (0.3, 0.5, np.inf)),
    (0.4, 0, 10, NONE, (np.inf,) * 3),
)


def test_the_picture_shows_the_quantiles_and_the_shares():
    figure = draw_quantiles(Quantiles("a $block$", "PGA", True, SOME), "PGA [g]")
    figure.draw_without_rendering()
    above, below = figure.axes
    lines = {line.get_label(): line.get_ydata() for line in above.get_lines()}
    np.testing.assert_array_equal(lines["median"][:3], [0.0, 0.1, 0.5])
    band = next(each for each in above.patches).get_extents().transformed(above.transData.inverted())
    assert 1 < band.y0 < lines["median"][3] < band.y1 == pytest.approx(above.get_ylim()[1])
    assert band.y0 < lines["84 % of runs below"][2] < band.y1 and len(lines["84 % of runs below"]) == 3
    assert sorted(line.get_xdata()[0] for line in above.get_lines() if line.get_marker() == "^") == [0.3, 0.4, 0.4]
    assert not above.get_xlabel()
    assert above.get_yticklabels()[-1].get_text() == "overturns" and below.get_xlabel() == "PGA [g]"
    still, rocks, fallen = below.collections
    heights = [each.get_paths()[0].get_extents() for each in (still, rocks, fallen)]
    assert [(each.y0, each.y1) for each in heights] == [(0, 1), (0, 1), (0, 1)]
    top_of_still = {tuple(each) for each in still.get_paths()[0].vertices.round(9).tolist()}
    assert {(0.1, 1.0), (0.2, 0.3), (0.3, 0.0)} <= top_of_still
    low_of_fallen = {tuple(each) for each in fallen.get_paths()[0].vertices.round(9).tolist()}
    assert {(0.2, 1.0), (0.3, 0.6), (0.4, 0.0)} <= low_of_fallen

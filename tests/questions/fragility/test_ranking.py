"""Which measure serves: statistics against statsmodels, a ranking against its runs, words against numbers."""

import json
from dataclasses import replace

import numpy as np
import pytest
import statsmodels.api as sm

from rocking_cli.excitation.base import Origin
from rocking_cli.questions.fragility import study as of_study
from rocking_cli.questions.fragility.ranking import (
    Ranked,
    Ranking,
    deviations_without,
    is_clear,
    judge,
    line,
    serves,
)
from rocking_cli.questions.fragility.store import Store
from tests.conftest import EXAMPLES, rows_of
from tests.stores import command

RNG = np.random.default_rng(7)
STUDY = f"""\
structures:
  - {EXAMPLES / "block.yaml"}
  - file: {EXAMPLES / "frame.yaml"}
    vary: {{column_width: {{normal: {{mean: 1.6, deviation: 0.05}}}}}}
records:
  - pulse: ricker:1g:0.5s
  - pulse: ricker:1g:0.9s
  - pulse: ricker_antisymmetric:1g:0.7s
  - pulse: mavroeidis:1g:0.9s
  - pulse: sine:1g:0.6s
  - pulse: sine:1g:1s
method: stripes
levels: {{measure: PGA, least: 0.2, most: 0.9, count: 6}}
limit_states: [uplift, 0.3, overturning]
polarity: both
samples: 2
"""


def ols(x, y):
    return sm.OLS(y, sm.add_constant(x)).fit()


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """A study that was run and ranked, and what was shown of it."""
    folder = tmp_path_factory.mktemp("ranked")
    path = folder / "study.yaml"
    path.write_text(STUDY, encoding="utf-8")
    shown = command("fragility", path, "--rank-measures", "--json", "--plot", folder / "pictures", code=0)
    return folder, json.loads(shown.stdout)


class TestStatistics:
    def test_a_line_is_that_of_statsmodels(self):
        slope, x = 0.4, RNG.normal(2.0, 1.5, size=40)
        y = 0.7 + slope * x + RNG.normal(scale=0.5, size=40)
        found, expected = line(x, y), ols(x, y)
        assert found is not None
        assert (found.intercept, found.slope) == pytest.approx(tuple(expected.params), rel=1e-9)
        assert found.deviation == pytest.approx(expected.mse_resid**0.5, rel=1e-9)
        assert found.p_value == pytest.approx(expected.pvalues[1], rel=1e-7, abs=1e-15)

    @pytest.mark.parametrize("x", [[], [1.0, 2.0], [3.0, 3.0, 3.0, 3.0]])
    def test_no_line_through_too_few_points(self, x):
        assert line(np.array(x), np.array(x)) is None

    def test_residuals_are_averaged_for_each_record_and_held_against_what_it_is(self):
        records, each = 12, np.arange(3, 15)
        magnitude, distance = RNG.uniform(5, 7, size=records), RNG.normal(size=records)
        record = np.repeat(np.arange(records), each)
        x = RNG.normal(size=record.size)
        y = 1.5 * x + 0.8 * magnitude[record] + RNG.normal(scale=0.2, size=record.size)
        efficiency, slope, runs, of, trends = serves("PGA", x, y, record, {"m": magnitude, "r": distance, "PGA": x})
        line_of_all = ols(x, y)
        assert (efficiency, slope) == pytest.approx((line_of_all.mse_resid**0.5, line_of_all.params[1]), rel=1e-9)
        assert (runs, of) == (record.size, records)
        means = np.array([line_of_all.resid[record == k].mean() for k in range(records)])
        for name, values in (("m", magnitude), ("r", distance)):
            assert trends[name] == pytest.approx(ols(values, means).pvalues[1], rel=1e-6)
        assert trends["m"] < 1e-4 and trends["r"] > 0.01 and np.isnan(trends["PGA"])


@pytest.mark.rest
class TestStudy:
    def test_the_numbers_are_those_of_its_runs(self, study):
        folder, shown = study
        assert command("results", folder / "study.runs", "--out", folder / "runs.csv").exit_code == 0
        found = rows_of(folder / "runs.csv")
        rows = [row for row in found if row["outcome"] == "rocks" and row["structure"] == "pedestal"]
        of = {each["measure"]: each for each in shown["ranking"][0]["measures"]}
        y = np.log([float(row["peak_ratio"]) for row in rows])
        x = np.log([float(row["PGV [m/s]"]) for row in rows])
        expected = ols(x, y)
        name = "PGV" if "PGV" in of else "PGV/v_imp"  # which ranks the same: one structure without samples
        assert of[name]["efficiency"] == pytest.approx(expected.mse_resid**0.5, rel=1e-6)
        assert of[name]["practicality"] == pytest.approx(expected.params[1], rel=1e-6)
        assert of[name]["proficiency"] == pytest.approx(expected.mse_resid**0.5 / expected.params[1], rel=1e-6)
        assert (of[name]["runs"], of[name]["records"]) == (len(rows), len({row["motion"] for row in rows}))
        for each in shown["ranking"]:
            assert [*each["measures"]] == sorted(each["measures"], key=lambda measure: measure["efficiency"])
            assert each["against"] == ["Tm", "D5-95"]

    def test_measures_in_proportion_are_one_where_nothing_varies(self, study):
        pedestal, bridge = study[1]["ranking"]
        assert pedestal["alike"]["PGA/(g lambda)"] == "PGA" and pedestal["alike"]["Sd(1.0)"] == "Sa(1.0)"
        assert "PGA/(g lambda)" not in bridge["alike"]  # its lambda differs from sample to sample
        assert bridge["alike"]["Sd(1.0)"] == "Sa(1.0)"

    def test_results_ranks_what_the_store_knows_and_has_a_picture(self, study):
        folder, shown = study
        again = json.loads(command("results", folder / "study.runs", "--rank-measures", "--json").stdout)
        assert again["ranking"] == shown["ranking"]
        for name in ("which-measure-serves", "PGA-quantiles"):
            assert len(list((folder / "pictures").glob(f"*{name}.png"))) == 2
        said = command("results", folder / "study.runs", "--rank-measures").stdout
        for each in shown["ranking"]:
            assert all(sentence in " ".join(said.split()) for sentence in each["verdict"])

    def test_records_that_state_magnitude_and_distance_are_held_against_these(self, tmp_path, monkeypatch):
        read = of_study.Source.read

        def stated(source):
            k = len(source.name) % 7
            return replace(read(source), origin=Origin("event", "station", 5.0 + k, 10.0 + 3 * k))

        path = tmp_path / "study.yaml"
        path.write_text(STUDY, encoding="utf-8")
        monkeypatch.setattr(of_study.Source, "read", stated)
        found = json.loads(command("fragility", path, "--rank-measures", "--json").stdout)["ranking"][0]
        assert found["against"] == ["magnitude", "distance"]
        assert any("with magnitude or distance" in each for each in found["verdict"])
        kept = Store.reading(tmp_path / "study.runs")
        plan = kept.plan
        values = {name: plan.of_records(name).tolist() for name in ("magnitude", "distance")}
        k = [len(each.name) % 7 for each in plan.records]
        assert values == {"magnitude": [5.0 + each for each in k], "distance": [10.0 + 3 * each for each in k]}

    def test_a_record_of_several_sets_is_one(self, tmp_path):
        motions = [(t, x) for t in (0.7, 0.9, 1.1) for x in (0.3, 0.4, 0.6)]
        sets = "".join(f"  - {{pulse: 'ricker:1g:{t}s', level: {x}}}\n" for t, x in motions)
        text = f"structures: ['{EXAMPLES / 'block.yaml'}']\nrecords:\n{sets}method: stripes\n"
        path = tmp_path / "study.yaml"
        path.write_text(f"{text}levels: {{measure: PGA, values: [0.3, 0.4, 0.6]}}\n", encoding="utf-8")
        found = json.loads(command("fragility", path, "--rank-measures", "--json").stdout)["ranking"][0]
        assert {(each["runs"], each["records"]) for each in found["measures"]} == {(9, 3)}


def test_the_deviation_without_a_record_is_that_of_the_others():
    random = np.random.default_rng(3)
    record = random.permutation(np.repeat(np.arange(7), 5))
    x = random.normal(size=record.size)
    y = 0.7 * x + random.normal(size=record.size) + record
    others = [line(x[record != k], y[record != k]).deviation for k in range(7)]
    np.testing.assert_allclose(deviations_without(x, y, record), others, rtol=1e-12)


def test_a_difference_is_clear_where_leaving_out_a_record_does_not_change_it():
    assert is_clear(0.1, np.full(8, 0.1)) and is_clear(-0.1, np.full(8, -0.1))
    assert not is_clear(0.0, np.zeros(8)) and not is_clear(0.1, np.array([0.1]))
    # The jackknife of a mean has the standard error of the mean: here 2.36 of them are 0.95 of 7 degrees of freedom.
    of_each = np.random.default_rng(5).normal(size=8)
    of_each -= of_each.mean()
    error = of_each.std(ddof=1) / np.sqrt(8)
    for share, clear in ((2.35, False), (2.38, True)):
        mean = share * error
        assert is_clear(mean, mean + (0 - of_each) / 7) is clear


@pytest.mark.parametrize("alike", [False, True])
def test_a_measure_that_is_no_better_is_said_to_be_as_efficient(alike):
    best, other = ranked("PGV", 0.31, 0.4, 0.2), ranked("PGA", 0.33, 0.4, 0.2)
    equal = ("PGA",) if alike else ()
    said = judge(Ranking("block", (best, other), ("Tm", "D5-95"), {}, {}, equal=equal, lacking=("CAV",) * 3))
    text = "PGA (0.33) may be as efficient: leaving out each record in turn, 8 records do not tell it apart from PGV"
    assert (f"{text} at 95 %." in said) is alike is any(each.startswith("PGV, with 0.31") for each in said)
    assert any(each.startswith("Only 2 of 5 measures are in the store: `rocking fragility` with ") for each in said)


def ranked(name, efficiency, *p_values, slope=2.0, against=("Tm", "D5-95")):
    return Ranked(name, efficiency, slope, 40, 8, dict(zip(against, p_values, strict=True)), {})


@pytest.mark.parametrize(
    ("measures", "words", "sufficient"),
    [
        ([ranked("PGV", 0.31, 0.4, 0.2), ranked("PGA", 0.5, 0.01, 0.2)],
         "It is the most efficient of the 1 whose residuals show no trend with Tm or D5-95", [True, False]),
        ([ranked("PGV", 0.31, 0.4, 0.049), ranked("CAV", 0.52, 0.05, 0.7)],
         "CAV, with 0.52, is the most efficient of the 1 ", [False, True]),
        ([ranked("PGV", 0.31, 0.4, 0.01), ranked("CAV", 0.52, 0.02, 0.7)], "none is sufficient", [False, False]),
        ([ranked("PGV", 0.31, np.nan, np.nan, slope=-1.0)], "no trend with Tm and D5-95 can be told", [None]),
        ([], "block: no measure can be ranked", []),
    ],
)  # fmt: skip
def test_words_are_of_the_most_efficient_and_of_those_without_trends(measures, words, sufficient):
    said = judge(Ranking("block", tuple(measures), ("Tm", "D5-95"), {}, {}))
    assert words in " ".join(said) and [each.sufficient for each in measures] == sufficient
    if measures:
        best, count = measures[0], len(measures)
        assert said[0].startswith(f"Of {count} measures PGV is the most efficient over the 40 runs of 8 records that")
        assert best.proficiency == pytest.approx(0.155) or (best.practicality < 0 and np.isnan(best.proficiency))

"""Stripes with a set of records at each level, and weights of records: against statsmodels and by hand."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
import statsmodels.api as sm
from pydantic import ValidationError

from rocking_cli.processing.record_list import Entry
from rocking_cli.questions.fragility.curves import fit_capacities, fit_curve, fit_surface
from rocking_cli.questions.fragility.observed import Observations
from tests.cli.test_cli import run
from tests.conftest import EXAMPLES

PROBIT = sm.families.Binomial(sm.families.links.Probit())
LEVELS = [0.2, 0.35, 0.5, 0.8]
BLOCK = "mechanism: block\nwidth: 0.5\nheight: 2.0\n"


@pytest.fixture
def folder(tmp_path):
    """A block, and five motions: the example's components at other speeds."""
    (tmp_path / "block.yaml").write_text(BLOCK)
    rows = (EXAMPLES / "accel.csv").read_text().splitlines()[1:]
    others = (EXAMPLES / "accel_transverse.csv").read_text().splitlines()[1:]
    for name, lines, dt in (
        ("a", rows, 0.01), ("b", others, 0.01), ("c", rows[::-1], 0.008), ("d", others[::-1], 0.012), ("e", rows, 0.015)
    ):  # fmt: skip
        values = [line.split(",")[1] for line in lines]
        body = "\n".join(f"{k * dt:.6g},{value}" for k, value in enumerate(values))
        (tmp_path / f"{name}.csv").write_text(f"t [s],a [g]\n{body}\n")
    return tmp_path


def study(folder, records, more="", levels=f"{{measure: PGA, values: {LEVELS}}}", method="stripes"):
    path = folder / "study.yaml"
    path.write_text(f"structures: [block.yaml]\nrecords:\n{records}method: {method}\nlevels: {levels}\n{more}")
    return path


SETS = (
    "  - {file: a.csv, level: 0.2}\n  - {file: b.csv, level: 0.2}\n  - {file: c.csv, level: 0.35}\n"
    "  - {file: d.csv, level: 0.35}\n  - {file: e.csv, level: 0.5}\n  - {file: a.csv, level: 0.5}\n"
    "  - {file: b.csv, level: 0.8}\n  - {file: c.csv, level: 0.8}\n"
)


class TestSets:
    def test_every_record_is_run_at_its_level_alone(self, folder):
        data = json.loads(run("fragility", study(folder, SETS), "--jobs", 1, "--json").stdout)
        assert (data["runs"], data["finished"]) == (8, 8)
        assert [each["level"] for each in data["records"]] == [0.2, 0.2, 0.35, 0.35, 0.5, 0.5, 0.8, 0.8]
        run("results", folder / "study.runs", "--out", folder / "runs.csv")
        table = np.genfromtxt(folder / "runs.csv", delimiter=",", names=True, dtype=None, encoding="utf-8")
        assert table["PGA_g"] == pytest.approx(table["level"])
        assert table["motion"].tolist() == [
            "a.csv at 0.2", "b.csv at 0.2", "c.csv at 0.35", "d.csv at 0.35", "e.csv at 0.5", "a.csv at 0.5",
            "b.csv at 0.8", "c.csv at 0.8",
        ]  # fmt: skip
        assert data["curves"][0]["distinct_records"] == 5  # three of them are in two sets
        said = run("results", folder / "study.runs").stdout
        assert "Each level has its own set of records: 2 per level, scaled to the level." in said

    def test_the_runs_are_those_of_a_study_of_all(self, folder):
        run("fragility", study(folder, SETS), "--jobs", 1)
        run("results", folder / "study.runs", "--out", folder / "sets.csv")
        shutil.rmtree(folder / "study.runs")
        run("fragility", study(folder, "".join(f"  - {x}.csv\n" for x in "abcde")), "--jobs", 1)
        run("results", folder / "study.runs", "--out", folder / "all.csv")

        def outcomes(name):
            table = np.genfromtxt(folder / name, delimiter=",", names=True, dtype=None, encoding="utf-8")
            return {
                (each["motion"].partition(" at ")[0], round(float(each["level"]), 9)): float(each["peak_ratio"])
                for each in table
            }

        sets, every = outcomes("sets.csv"), outcomes("all.csv")
        assert len(sets) == 8 and len(every) == 20
        for key, peak in sets.items():
            assert peak == pytest.approx(every[key], nan_ok=True)

    def test_sets_as_they_are_keep_their_own_factors(self, folder):
        for k, (name, factor) in enumerate((("a", 0.4), ("b", 0.7), ("c", 1.1)), start=1):
            (folder / f"set{k}.yaml").write_text(f"records:\n  - {{file: {name}.csv, factor: {factor}}}\n")
        records = "".join(f"  - {{file: set{k}.yaml, level: {level}}}\n" for k, level in ((1, 0.3), (2, 0.5), (3, 0.9)))
        levels = "{measure: Sa(1.0), values: [0.3, 0.5, 0.9], scaled: false}"
        data = json.loads(run("fragility", study(folder, records, levels=levels), "--jobs", 1, "--json").stdout)
        run("results", folder / "study.runs", "--out", folder / "runs.csv")
        table = np.genfromtxt(folder / "runs.csv", delimiter=",", names=True, dtype=None, encoding="utf-8")
        assert table["scale"].tolist() == [1, 1, 1]
        assert table["PGA_g"] == pytest.approx([0.4 * 0.55, 0.7 * 0.4, 1.1 * 0.55])
        assert data["curves"][0]["measure"] == "Sa(1.0)"
        assert "1 per level, not scaled to the level." in run("results", folder / "study.runs").stdout

    def test_a_set_goes_on_where_it_stopped_and_changes_are_named(self, folder):
        path = study(folder, SETS)
        run("fragility", path, "--jobs", 1)
        path.write_text(path.read_text().replace("b.csv, level: 0.8", "b.csv, level: 0.5"))
        assert "b.csv at 0.5" in run("fragility", path, code=2).stderr

    @pytest.mark.parametrize(
        ("records", "more", "words"),
        [
            ("  - {file: a.csv, level: 0.3}\n", {}, "study.yaml:3:26: records[1].level: 0.3 is not one of the levels"),
            ("  - {file: a.csv, level: 0.2}\n", {"method": "ida"}, "are of `method: stripes`"),
            ("  - a.csv\n", {"levels": "{measure: PGA, values: [0.2, 0.4], scaled: false}"}, "each needs the `level`"),
            ("  - {file: a.csv, level: 0.2}\n", {"levels": "{measure: scale, values: [0.2], scaled: false}"},
             "are factors: leave scaled out"),
            ("  - {file: a.csv, level: 0.2}\n  - {file: a.csv, level: 0.2}\n", {}, "two of them are called"),
            ("  - {file: a.csv, weight: 0}\n", {}, "must be more than 0"),
        ],
    )  # fmt: skip
    def test_wrong_sets(self, folder, records, more, words):
        assert words in run("fragility", study(folder, records, **more), code=2).stderr


@pytest.fixture(scope="module")
def runs():
    rng = np.random.default_rng(4)
    x = np.tile([0.2, 0.3, 0.45, 0.7], 12)
    record = np.repeat(np.arange(12), 4)
    beyond = rng.random(x.size) < 1 / (1 + np.exp(-5 * np.log(x / 0.4) - np.repeat(rng.normal(size=12), 4)))
    return x, beyond, record, np.repeat(rng.integers(1, 4, 12).astype(float), 4)


def by_statsmodels(beyond, predictors, weight):
    """Coefficients of a weighted probit regression."""
    return sm.GLM(beyond.astype(float), sm.add_constant(predictors), PROBIT, freq_weights=weight).fit().params


class TestWeights:
    """Records that count otherwise than once."""

    def test_a_curve_is_that_of_a_weighted_regression(self, runs):
        x, beyond, record, weight = runs
        curve = fit_curve(Observations.of(x, beyond, record, weight=weight))
        a, b = by_statsmodels(beyond, np.log(x), weight)
        assert (curve.runs, curve.exceedances, curve.records) == (48, int(beyond.sum()), 12)
        assert curve.median.value == pytest.approx(np.exp(-a / b), rel=1e-6)
        assert curve.dispersion.value == pytest.approx(1 / b, rel=1e-6)

    def test_whole_weights_are_as_many_records_in_its_place(self, runs):
        x, beyond, record, weight = runs
        often = weight.astype(int)
        copies = fit_curve(Observations.of(*(np.repeat(each, often) for each in (x, beyond, record))))
        weighted = fit_curve(Observations.of(x, beyond, record, weight=weight))
        assert weighted.median.value == pytest.approx(copies.median.value, rel=1e-9)
        # Errors are by record, whatever a record counts in all: those of copies are the same.
        assert weighted.median.low == pytest.approx(copies.median.low, rel=1e-6)

    def test_capacities_are_weighted_too(self):
        rng = np.random.default_rng(1)
        levels = np.geomspace(0.1, 2, 16)
        capacity = 0.5 * np.exp(0.4 * rng.normal(size=20))
        place = np.searchsorted(levels, capacity)
        lower = np.where(place > 0, levels[np.maximum(place - 1, 0)], 0.0)
        upper = np.where(place < 16, levels[np.minimum(place, 15)], np.inf)
        weight = rng.integers(1, 4, 20).astype(float)
        often = weight.astype(int)
        weighted = fit_capacities(lower, upper, np.arange(20), weight=weight)
        copies = fit_capacities(np.repeat(lower, often), np.repeat(upper, often), np.repeat(np.arange(20), often))
        assert weighted.median.value == pytest.approx(copies.median.value, rel=1e-9)
        assert weighted.dispersion.value == pytest.approx(copies.dispersion.value, rel=1e-9)
        assert weighted.runs == 20

    def test_surfaces_are_weighted_too(self, runs):
        x, beyond, record, weight = runs
        other = x * np.random.default_rng(9).uniform(0.5, 2, x.size)
        found = fit_surface(x, other, beyond, record, weight=weight)
        expected = by_statsmodels(beyond, np.log(np.column_stack([x, other])), weight)
        assert [each.value for each in found.coefficients] == pytest.approx(expected, rel=1e-5)

    def test_of_a_study_they_may_change_at_any_time(self, folder):
        medians = []
        for weights in ((1, 1, 1, 1, 1), (1, 1, 9, 9, 1), (2, 2, 2, 2, 2)):
            text = "".join(f"  - {{file: {name}.csv, weight: {w}}}\n" for name, w in zip("abcde", weights, strict=True))
            levels = "{measure: PGA, least: 0.1, most: 1.2, count: 12}"
            path = study(folder, text, levels=levels)
            data = json.loads(run("fragility", path, "--jobs", 1, "--json").stdout)
            assert [each["weight"] for each in data["records"]] == list(weights)
            medians.append(data["curves"][-1]["median"]["value"])
        assert medians[0] == pytest.approx(medians[2])
        assert medians[0] != pytest.approx(medians[1], rel=1e-3)
        path.write_text(path.read_text().replace("a.csv, weight: 2", "a.csv, weight: 5"))
        run("fragility", path, "--jobs", 1)
        assert "Records have weights from 2 to 5." in run("results", folder / "study.runs").stdout


def test_a_channel_may_be_a_number_as_messages_list_it():
    for given in (1, "1"):
        entry = Entry.model_validate(
            {"file": "a.V2", "channel": given, "with": "b.V2", "with_channel": given, "azimuth": 0}
        )
        assert (entry.channel, entry.other_channel) == ("1", "1") and entry.reading(Path()).channel == "1"
    for given in (True, 1.5):
        with pytest.raises(ValidationError):
            Entry.model_validate({"file": "a.V2", "channel": given})


def test_channels_and_directions_of_one_file_are_records_of_their_own(folder):
    rows = np.column_stack([0.01 * np.arange(300), np.sin(np.arange(300) / 9), np.cos(np.arange(300) / 7)])
    body = "\n".join(",".join(f"{x:.6g}" for x in row) for row in rows)
    (folder / "two.csv").write_text(f"t [s],x [g],y [g]\n{body}\n")
    (folder / "b.csv").write_text((folder / "a.csv").read_text())  # of one length and interval
    records = (
        "  - {file: two.csv, channel: x}\n  - {file: two.csv, channel: y}\n"
        "  - {file: a.csv, with: 'b*.csv', azimuth: 30}\n  - {file: a.csv, with: b.csv, azimuth: 60}\n"
    )
    data = json.loads(run("fragility", study(folder, records), "--jobs", 1, "--json").stdout)
    assert [each["name"] for each in data["records"]] == [
        "two.csv channel x", "two.csv channel y", "a.csv azimuth 30", "a.csv azimuth 60"
    ]  # fmt: skip
    assert all(each["reason"] is None for each in data["records"])

"""A study file: what it may say, and every problem at once with its line."""

import pytest

from rocking_cli.errors import InputError
from rocking_cli.questions.fragility.study import digest, load_study
from tests.conftest import EXAMPLES

GOOD = f"""\
structures:
  - {EXAMPLES / "frame.yaml"}
  - file: {EXAMPLES / "block.yaml"}
    name: uncertain
    vary:
      width: {{normal: {{mean: 0.7, deviation: 0.05}}}}
      restitution: {{uniform: {{low: 0.85, high: 0.95}}}}
records:
  - {EXAMPLES / "accel.csv"}
  - pulse: sine:0.6g:0.8s
method: stripes
levels: {{measure: pga/(G lambda), least: 0.5, most: 4, count: 8}}
polarity: both
samples: 5
limit_states: [uplift, 0.25, overturning]
"""


NORMAL, RANGE = "normal: {mean: 0.7, deviation: 0.05}", "least: 0.5, most: 4, count: 8"


def load(tmp_path, text):
    (tmp_path / "study.yaml").write_text(text, encoding="utf-8")
    return load_study(tmp_path / "study.yaml")


def problems(tmp_path, text):
    with pytest.raises(InputError) as caught:
        load(tmp_path, text)
    return caught.value.problems


def test_what_it_says_is_what_is_run(tmp_path):
    study = load(tmp_path, GOOD)
    assert study.name == "study"
    assert [each.name for each in study.structures] == ["valley bridge", "uncertain"]
    assert [(each.structure, each.number) for each in study.samples] == [(0, 0), *((1, k) for k in range(5))]
    assert [each.name for each in study.sources] == [(EXAMPLES / "accel.csv").as_posix(), "sine:0.6g:0.8s"]
    assert study.definition.levels.measure == "PGA/(g lambda)"
    assert study.definition.levels.levels() == pytest.approx([0.5 + 0.5 * k for k in range(8)])
    assert study.definition.limit_states == ["uplift", 0.25, "overturning"]
    for sample in study.samples[1:]:
        assert sample.mechanism.width == sample.drawn["width"]
        assert sample.mechanism.restitution == sample.drawn["restitution"] == sample.eta
        assert sample.geometry == (("width", sample.drawn["width"]),)
    assert len({each.drawn["width"] for each in study.samples[1:]}) == 5


def test_the_hash_is_of_what_decides_the_runs(tmp_path):
    def hashed(text):
        return digest(load(tmp_path, text).description())

    assert hashed(GOOD) == hashed(GOOD + "confidence: 0.9\nbivariate: [[PGA, PGV]]\n")
    assert hashed(GOOD) == hashed(GOOD.replace("[uplift, 0.25, overturning]", "[uplift]"))
    others = [
        GOOD + "seed: 3\n",
        GOOD.replace("samples: 5", "samples: 6"),
        GOOD.replace("most: 4", "most: 4.1"),
        GOOD.replace("polarity: both", "polarity: 1"),
        GOOD.replace("0.6g", "0.7g"),
        GOOD.replace("0.05", "0.06"),
        GOOD + "model: linear2\n",
        GOOD + "opening: 0.02\n",
    ]
    assert len({hashed(each) for each in [GOOD, *others]}) == 1 + len(others)


def test_a_plain_study_may_be_short(tmp_path):
    study = load(tmp_path, f"structures: [{EXAMPLES / 'block.yaml'}]\nrecords: ['{EXAMPLES}/*.csv']\nmethod: cloud\n")
    assert study.definition.levels.levels() == [1.0] and study.definition.fitted_measures == ["PGA"]


@pytest.mark.parametrize(
    ("change", "field", "said"),
    [
        (("method: stripes", "method: cloud"), "levels", "scales records by factors"),
        (("levels:", "#"), "levels", "is missing"),
        (("polarity", "restitution: [0.9]\npolarity"), "restitution", "varies its restitution"),
        (("width: {normal", "mechanism: {normal"), "structures[2].vary.mechanism", "not a number among"),
        (("deviation: 0.05", "deviation: 9"), "structures[2].vary", "width must be more than 0 m, got -"),
        ((NORMAL, "lognormal: {median: 1.0e+308, dispersion: 9}"), "structures[2].vary", "samples cannot be built"),
        ((RANGE, "values: [1, 2, 1]"), "levels.values", "1 is given twice"),
        ((RANGE, "values: [2, 1, 1.0000000000000002]"), "levels.values", "differ by rounding alone"),
        (("name: uncertain", "name: valley bridge"), "structures", "two of them are called valley bridge"),
        ((RANGE, "least: 4, most: 4.000000000000002, count: 8"), "levels.most", "too close to least for 8 distinct"),
        (("csv\n", f"csv\n  - {{file: '{EXAMPLES}/*.yaml', vertical: '{EXAMPLES}/*.csv'}}\n"),
         "records[2].vertical", "one"),
        (("csv\n", f"csv\n  - {EXAMPLES}/study/../accel.csv\n"), "records", "two of them"),
        (("count: 8", "values: [1]"), "levels", "give values, or"),
        (("samples: 5", "samples: 5\nhazard: {file: none.csv}"), None, "none.csv"),
        (("      width: {normal: {mean: 0.7, deviation: 0.05}}\n      restitution: {uniform: {low: 0.85, high: 0.95}}",
          "      {}"), "samples", "nothing varies"),
    ],
)  # fmt: skip
def test_one_problem_at_a_time(tmp_path, change, field, said):
    found = problems(tmp_path, GOOD.replace(*change))
    assert len(found) == 1, found
    assert said in str(found[0])
    if field is not None:
        assert found[0].field == field and found[0].line is not None


MANY = f"""\
structures:
  - nosuch.yaml
  - file: {EXAMPLES / "block.yaml"}
    name: uncertain
    vary:
      widht: {{normal: {{mean: 0.7, deviaton: 0.05}}}}
      height: {{uniform: {{low: 3, high: 2}}, colour: red}}
      width: {{normal: {{mean: 1, deviation: 0.1, low: 2, high: x}}}}
  - {{file: other.yaml, nmae: x}}
records:
  - {{pulse: sine:0.6g, dt: 0.1}}
  - {{file: none.AT2, units: foot, vertical: up.AT2}}
method: cloud
levels: {{measure: pga, least: 4, most: 1, count: x}}
hazard: {{points: [[1, 2], [0.5, 1], [2, x], [3, 5], [1]]}}
limit_states: [uplift, -1, 0.5, uplift, 0.5]
bivariate: [[PGA, pga], [PGA, PGV], [PGA, PGX], [pgv, PGA], [PGA, PGV]]
seed: -1
polarity: 2
restitution: [1.2]
measures: [pga, PGA]
confidence: 95
colour: red
method: ida
"""


def test_no_mistake_hides_another(tmp_path):
    found = problems(tmp_path, MANY)
    assert {(each.field, each.line, each.message.partition(",")[0]) for each in found} == {
        ("samples", 1, "is missing: how many structures are drawn from the distributions"),
        ("structures[1]", 2, "nosuch.yaml: no such file"),
        ("structures[2].vary.widht", 6, "is not a number among the fields of block"),
        ("structures[2].vary.widht.normal.deviaton", 6, "is not a field of structures[2].vary.widht.normal"),
        ("structures[2].vary.widht.normal.deviation", 6, "is missing: standard deviation"),
        ("structures[2].vary.height", 7, "give one distribution"),
        ("structures[2].vary.height.uniform.high", 7, "must be more than low (3)"),
        ("structures[2].vary.height.colour", 7, "is not a field of structures[2].vary.height"),
        ("structures[2].vary.width.normal.high", 8, "must be a number"),
        ("structures[3].file", 9, "other.yaml: no such file"),
        ("structures[3].nmae", 9, "is not a field of structures[3]"),
        ("records[1]", 11, "units"),
        ("records[1].pulse", 11, "malformed pulse 'sine:0.6g': expected sine:AMPLITUDE:PERIOD"),
        ("records[2].units", 12, "'foot' is not a known unit; give one of g"),
        ("records[2].file", 12, "none.AT2: no such file"),
        ("records[2].vertical", 12, "up.AT2: no such file"),
        ("levels", 14, "a cloud scales records by factors: `measure: scale`"),
        ("levels.count", 14, "must be a whole number"),
        ("levels.most", 14, "must be more than least (4)"),
        ("hazard.points[2]", 15, "the intensity 0.5 does not exceed the 1 before it"),
        ("hazard.points[3][2]", 15, "must be a number"),
        ("hazard.points[4]", 15, "the annual rate 5 is above the 1 at the lower intensity"),
        ("hazard.points[5]", 15, "must have at least 2 entries"),
        ("limit_states", 16, "uplift is given twice"),
        ("limit_states[2]", 16, "must be uplift"),
        ("bivariate", 17, "PGA and PGV is given twice"),
        ("bivariate[1]", 17, "PGA is paired with itself"),
        ("bivariate[3][2]", 17, "unknown measure: PGX"),
        ("seed", 18, "must be at least 0"),
        ("polarity", 19, "must be 1"),
        ("restitution[1]", 20, "must be at most 1"),
        ("measures", 21, "PGA is given twice"),
        ("confidence", 22, "must be less than 1"),
        ("colour", 23, "is not a field of the study"),
        ("method", 24, "given twice"),
    } | {("limit_states", 16, "0.5 is given twice")}

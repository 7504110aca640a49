"""A study file: what it may say, and every problem at once with its line."""

from __future__ import annotations

import pytest

from rocking_cli.errors import InputError
from rocking_cli.studies.fragility.study import digest, load_study
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
polarities: [1, -1]
samples: 5
limit_states: [uplift, 0.25, overturning]
"""


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


def test_samples_are_the_same_for_the_same_seed_only(tmp_path):
    drawn = [each.drawn for each in load(tmp_path, GOOD).samples]
    assert [each.drawn for each in load(tmp_path, GOOD).samples] == drawn
    assert [each.drawn for each in load(tmp_path, GOOD + "seed: 1\n").samples] != drawn


def test_the_hash_is_of_what_decides_the_runs(tmp_path):
    def hashed(text):
        return digest(load(tmp_path, text).description())

    assert hashed(GOOD) == hashed(GOOD + "confidence: 0.9\nbivariate: [[PGA, PGV]]\n")
    assert hashed(GOOD) == hashed(GOOD.replace("[uplift, 0.25, overturning]", "[uplift]"))
    others = [
        GOOD + "seed: 3\n",
        GOOD.replace("samples: 5", "samples: 6"),
        GOOD.replace("most: 4", "most: 4.1"),
        GOOD.replace("[1, -1]", "[1]"),
        GOOD.replace("0.6g", "0.7g"),
        GOOD.replace("0.05", "0.06"),
        GOOD + "model: linear2\n",
    ]
    assert len({hashed(each) for each in [GOOD, *others]}) == 1 + len(others)


def test_a_plain_study_may_be_short(tmp_path):
    study = load(tmp_path, f"structures: [{EXAMPLES / 'block.yaml'}]\nrecords: ['{EXAMPLES}/*.csv']\nmethod: cloud\n")
    assert study.definition.levels.levels() == [1.0] and study.definition.fitted_measures == ["PGA"]


def test_every_problem_is_listed_at_once(tmp_path):
    (tmp_path / "broken.yaml").write_text("mechanism: block\nwidth: -1\n", encoding="utf-8")
    found = problems(
        tmp_path,
        f"""\
structures:
  - none.yaml
  - broken.yaml
  - file: {EXAMPLES / "block.yaml"}
    vary:
      widht: {{normal: {{mean: 0.7, deviation: 0.05}}}}
      height: {{normal: {{mean: 0.7, deviaton: 0.05}}}}
      width: {{normal: {{mean: 0.7, deviation: 0.05}}, uniform: {{low: 0, high: 1}}}}
  - {{file: 7}}
records:
  - none.AT2
  - '*.nothing'
  - pulse: sine:0.6g
  - {{pulse: sine:0.6g:1s, dt: 0.1}}
  - 3
method: strips
levels: {{measure: PGD, values: [0.1, -1, 0.1, x]}}
polarities: [1, 2]
eta: [1.2]
samples: 1e3
limit_states: [uplift, -0.5, tilt]
measures: [PGA, PGA]
confidence: 95
hazard: {{points: [[1, 2, 3], [1]]}}
colour: red
method: ida
""",
    )
    where = {(each.field, each.line) for each in found}
    assert {
        ("structures[3].vary.height.normal.deviaton", 7),
        ("structures[3].vary.height.normal.deviation", 7),
        ("structures[3].vary.width", 8),
        ("structures[4].file", 9),
        ("records[1]", 11),
        ("records[2]", 12),
        ("records[3].pulse", 13),
        ("records[4]", 14),
        ("records[5]", 15),
        ("method", 16),
        ("levels.measure", 17),
        ("levels.values[2]", 17),
        ("levels.values[4]", 17),
        ("polarities[2]", 18),
        ("eta[1]", 19),
        ("samples", 20),
        ("limit_states[2]", 21),
        ("limit_states[3]", 21),
        ("measures", 22),
        ("confidence", 23),
        ("hazard.points[1]", 24),
        ("hazard.points[2]", 24),
        ("colour", 25),
        ("method", 26),
    } <= where
    said = "\n".join(map(str, found))
    assert "none.yaml: no such file" in said
    assert "broken.yaml:2:8: width" in said and "broken.yaml: height" in said.replace(":1:1", "")
    assert "did you mean deviation?" in said
    assert [each.line for each in found if each.file == str(tmp_path / "study.yaml")] == sorted(
        each.line for each in found if each.file == str(tmp_path / "study.yaml")
    )


@pytest.mark.parametrize(
    ("change", "field", "said"),
    [
        (("method: stripes", "method: cloud"), "levels", "scales records by factors"),
        (("levels:", "#"), "levels", "is missing"),
        (("samples: 5", ""), "samples", "is missing"),
        (("polarities", "eta: [0.9]\npolarities"), "eta", "varies its restitution"),
        (("width: {normal", "mechanism: {normal"), "structures[2].vary.mechanism", "not a number among"),
        (("deviation: 0.05", "deviation: 2"), "structures[2].vary", "of 5 samples cannot be built"),
        (("high: 0.95", "high: 0.5"), "structures[2].vary.restitution.uniform.high", "more than low"),
        (("name: uncertain", "name: valley bridge"), "structures", "two of them are called valley bridge"),
        (("pulse: sine:0.6g:0.8s", f"file: {EXAMPLES / 'accel.csv'}"), "records", "two of them"),
        (("count: 8", "count: 1"), "levels.count", "at least 2"),
        (("least: 0.5, most: 4", "least: 4, most: 4.000000000000002"), "levels.most", "repeat"),
        (("most: 4", "most: 1e300"), "levels.most", "at most 1e+06"),
        (
            ("csv\n", f"csv\n  - {{file: '{EXAMPLES}/*.yaml', vertical: '{EXAMPLES}/*.csv'}}\n"),
            "records[2].vertical",
            "one",
        ),
        (("csv\n", "csv\n  - {file: none.csv}\n"), "records[2].file", "no such file"),
        (("csv\n", f"csv\n  - {EXAMPLES}/study/../accel.csv\n"), "records", "two of them"),
        (("most: 4", "most: 0.4"), "levels.most", "more than least"),
        (("count: 8", "values: [1]"), "levels", "give values, or"),
        (("samples: 5", "samples: 5\nhazard: {file: none.csv}"), None, "none.csv"),
        (("samples: 5", "samples: 5\nhazard: {points: [[1, 0.1], [0.5, 0.01]]}"), "hazard.points", ""),
    ],
)
def test_one_problem_at_a_time(tmp_path, change, field, said):
    found = problems(tmp_path, GOOD.replace(*change))
    assert len(found) == 1, found
    assert said in str(found[0])
    if field is not None:
        assert found[0].field == field and found[0].line is not None


def test_samples_that_cannot_be_built_are_told_in_plain_words(tmp_path):
    (found,) = problems(tmp_path, GOOD.replace("deviation: 0.05", "deviation: 9"))
    assert "width must be more than 0 m, got -" in found.message


def test_nothing_varies_and_yet_samples_are_asked_for(tmp_path):
    text = f"structures: [{EXAMPLES / 'block.yaml'}]\nrecords: ['{EXAMPLES}/*.csv']\nmethod: cloud\nsamples: 3\n"
    (found,) = problems(tmp_path, text)
    assert found.field == "samples" and "nothing varies" in found.message


def test_what_fits_badly_together_is_listed_with_the_rest(tmp_path):
    found = problems(tmp_path, GOOD.replace("method: stripes", "method: cloud").replace("samples: 5", "samples: x"))
    assert {each.field for each in found} == {"levels", "samples"}

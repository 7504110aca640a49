"""Sliding as a limit state of a study: found run by run as `respond` finds it, and kept only on request."""

import json
import pickle

import numpy as np
import pytest
from click.testing import CliRunner

from rocking_cli.cli.main import main
from rocking_cli.errors import InputError, SolverError
from rocking_cli.questions.fragility import workers
from rocking_cli.questions.fragility.campaign import prepare
from rocking_cli.questions.fragility.store import COLUMNS, Store
from rocking_cli.questions.fragility.study import load_study
from rocking_cli.studies.contact import Contacts
from tests.conftest import EXAMPLES
from tests.following import respond
from tests.questions.fragility.test_study_runs import carry_out
from tests.stores import command, contents, every_run
from tests.studies.test_contact import of_a_block

STRUCTURES = {
    "block": "mechanism: block\nwidth: 0.7\nheight: 2.8\nrestitution: 0.9\nfriction: 0.27\n",
    "wall": "mechanism: block\nwidth: 0.5\nheight: 2.5\none_sided: positive\nfriction: 0.25\n",
    "frame": (EXAMPLES / "frame.yaml").read_text(encoding="utf-8") + "friction: 0.33\n",
}
STUDY = f"""\
structures:
  - wall.yaml
  - frame.yaml
  - file: block.yaml
    name: uncertain
    vary:
      width: {{normal: {{mean: 0.7, deviation: 0.05}}}}
      restitution: {{uniform: {{low: 0.85, high: 0.95}}}}
      friction: {{uniform: {{low: 0.24, high: 0.3}}}}
records:
  - {EXAMPLES}/accel.csv
  - pulse: sine:0.6g:0.8s
  - pulse: ricker:0.6g:1.2s
method: stripes
levels: {{measure: PGA/(g lambda), least: 0.8, most: 3, count: COUNT}}
polarity: both
samples: 3
limit_states: [uplift, sliding, overturning]
"""
ETAS = """\
structures: [frame.yaml, block.yaml]
records: [{pulse: sine:0.6g:0.8s}, {pulse: ricker:0.6g:1.2s}, ACCEL]
method: ida
levels: {measure: PGA, least: 0.2, most: 0.6, count: 9}
restitution: [0.8, 0.93]
limit_states: [sliding, uplift]
""".replace("ACCEL", str(EXAMPLES / "accel.csv"))


def write(folder, text=STUDY, count=4, **structures):
    for name, content in {**STRUCTURES, **structures}.items():
        (folder / f"{name}.yaml").write_text(content, encoding="utf-8")
    path = folder / "study.yaml"
    path.write_text(text.replace("COUNT", str(count)), encoding="utf-8")
    return path


def slides_as_responded(path, prepared):
    """When each run slides by the check that `respond` makes, of a structure and a motion made anew."""
    study, plan = load_study(path), prepared.plan
    motions, found = [source.read() for source in study.sources], []
    sample, record, eta, level, polarity = plan.places(np.arange(plan.size))
    factors = plan.factors(sample, record, level)
    for k in range(plan.size):
        mechanism = study.samples[sample[k]].mechanism
        if not np.isnan(given := plan.etas[eta[k]]):
            mechanism = mechanism.model_copy(update={"restitution": given})
        motion = motions[record[k]].scaled(plan.polarities[polarity[k]] * factors[k])
        history = respond(mechanism, motion, models=("nonlinear",))["nonlinear"]
        found.append(history.warned if history.slip else Contacts(mechanism).check(history, motion).slides)
    return np.array(found)


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A study that asks for sliding, and its store."""
    folder = tmp_path_factory.mktemp("whole")
    path = write(folder)
    return path, carry_out(path, folder / "study.runs", jobs=1), folder / "study.runs"


def test_each_run_slides_when_respond_says_so(whole):
    path, prepared, place = whole
    found, expected = every_run(place).slide_time, slides_as_responded(path, prepared)
    assert found == pytest.approx(expected, rel=1e-9, nan_ok=True)
    sample = prepared.plan.places(np.arange(prepared.plan.size))[0]
    shares = [np.isfinite(found[sample == k]).mean() for k in range(len(prepared.plan.trials))]
    assert all(0 < each < 1 for each in shares) and len(set(shares)) > 1


@pytest.mark.rest
def test_restitutions_of_the_study_are_those_of_the_check(tmp_path):
    path = write(
        tmp_path, ETAS, block=STRUCTURES["block"].replace("restitution: 0.9\nfriction: 0.27", "friction: 0.31")
    )
    prepared = carry_out(path, tmp_path / "study.runs", jobs=2)
    found = every_run(tmp_path / "study.runs").slide_time
    assert found == pytest.approx(slides_as_responded(path, prepared), rel=1e-9, nan_ok=True)
    by_eta = found.reshape(prepared.plan.shape)[..., 0]
    assert not np.array_equal(by_eta[:, :, 0], by_eta[:, :, 1], equal_nan=True)


def test_the_block_by_itself_needs_the_friction_that_is_written_out(tmp_path):
    """Without the check of the program: |H|/N of a block at every moment, in `tests/studies/test_contact.py`."""
    text = "structures: [block.yaml]\nrecords: [{pulse: sine:0.6g:0.8s}, {pulse: ricker:0.6g:1.2s}]\nmethod: stripes\n"
    text += "levels: {measure: PGA, least: 0.26, most: 0.5, count: 9}\nlimit_states: [sliding]\n"
    path = write(tmp_path, text)
    prepared = carry_out(path, tmp_path / "study.runs")
    plan, study = prepared.plan, prepared.study
    block, motions = study.samples[0].mechanism, [source.read() for source in study.sources]
    foot, expected = 1e-15, []
    for k in range(plan.size):
        _, record, _, level, _ = (int(place[0]) for place in plan.places(np.array([k])))
        motion = motions[record].scaled(plan.levels[level] / plan.records[record].pga)
        history = respond(block, motion, models=("nonlinear",))["nonlinear"]

        def ground(t, of=motion):
            return np.interp(t, of.time, of.acceleration, right=0.0)

        end = history.overturning_time if history.overturned else np.inf
        rocks = (history.time <= end) & ((history.phi != 0) | (history.rate != 0))
        states = [*zip(history.time[rocks], history.phi[rocks], history.rate[rocks], strict=True)]
        for t, s, rate in history.impacts[history.impacts[:, 0] <= end]:
            states += [(t, s * foot, -s * rate), (t, -s * foot, -s * 0.9 * rate)]
        states.append((history.uplift_time, -np.sign(ground(history.uplift_time)) * foot, 0.0))
        needs = [t for t, phi, rate in states if of_a_block(phi, rate, ground(t), 0, width=0.7, height=2.8)[0] > 0.27]
        expected.append(min(needs, default=np.nan))
    found = every_run(tmp_path / "study.runs").slide_time
    assert found == pytest.approx(expected, abs=0.01, nan_ok=True)  # it comes to slide between two samples
    assert 0 < np.isfinite(found).sum() < plan.size


def test_all_else_is_as_without_it(whole, tmp_path):
    path = write(tmp_path, STUDY.replace("sliding, ", ""))
    carry_out(path, tmp_path / "without.runs", jobs=1)
    with_it, without = every_run(whole[2]), every_run(tmp_path / "without.runs")
    assert np.isnan(without.slide_time).all()
    for name in set(COLUMNS) - {"slide_time"}:
        assert np.array_equal(getattr(with_it, name), getattr(without, name), equal_nan=True), name


def test_a_unit_can_be_sent_elsewhere(whole, tmp_path):
    prepared = prepare(load_study(whole[0]), store := Store.writing(tmp_path / "study.runs"))
    assert store.size <= workers.MOST_CHECKED_RUNS
    found = []
    for k in store.chunks:
        numbers = prepared.plan.numbers(*store.ends(k))
        unit = workers.unit_of(numbers, prepared.plan, prepared.study, store.fact("hash"), prepared.motions, "exact")
        found.append(workers.carry_out(pickle.loads(pickle.dumps(unit))).slide_time)
    assert np.array_equal(np.concatenate(found), every_run(whole[2]).slide_time, equal_nan=True)


def test_a_run_that_cannot_be_followed_to_its_rest_has_failed(whole, tmp_path, monkeypatch):
    def fails(*args, **options):
        raise SolverError("too small steps")

    monkeypatch.setattr(workers, "follow", fails)
    carry_out(whole[0], tmp_path / "other.runs", jobs=1)
    failed, rows = every_run(tmp_path / "other.runs"), every_run(whole[2])
    assert np.array_equal(failed.outcome == 2, np.isfinite(rows.uplift_time))
    assert not np.isfinite(failed.slide_time[failed.outcome == 2]).any()  # what only slides is not followed again


class TestTheStore:
    @pytest.mark.parametrize(
        ("before", "now", "said"),
        [
            ("uplift, ", "uplift, sliding, ", "sliding was absent, is now checked in every run"),
            ("uplift, sliding, ", "uplift, ", "sliding was checked in every run, is now absent"),
        ],
    )
    def test_it_is_not_continued_as_if_it_were_another(self, tmp_path, before, now, said):
        text = STUDY.replace("uplift, sliding, ", "uplift, ")
        carry_out(write(tmp_path, text.replace("uplift, ", before), count=2), tmp_path / "study.runs")
        kept = contents(tmp_path / "study.runs")
        with pytest.raises(InputError) as caught:
            carry_out(write(tmp_path, text.replace("uplift, ", now), count=2), tmp_path / "study.runs")
        assert [said in str(each) for each in caught.value.problems] == [True] and "`restart`" in str(caught.value)
        assert contents(tmp_path / "study.runs") == kept

    @pytest.mark.rest
    def test_results_show_it_with_tables_and_pictures(self, whole, tmp_path):
        shown = command("results", whole[2], "--json", "--out", tmp_path / "runs.csv", "--plot", tmp_path / "pictures")
        assert shown.exit_code == 0, shown.stderr
        rows = every_run(whole[2])
        sliding = [each for each in json.loads(shown.stdout)["curves"] if each["limit_state"] == "sliding"]
        assert sum(each["exceedances"] for each in sliding) == np.isfinite(rows.slide_time).sum() > 0
        header, *lines = (tmp_path / "runs.csv").read_text(encoding="utf-8").splitlines()
        last = header.split(",").index("slide_time [s]")
        found = [float(line.split(",")[last] or "nan") for line in lines]
        assert found == pytest.approx(rows.slide_time.tolist(), nan_ok=True)
        assert any(each.name.startswith("sliding") for each in (tmp_path / "pictures").iterdir())
        assert "sliding  " in command("results", whole[2]).stdout


class TestWhatIsRefused:
    def test_a_structure_without_friction(self, tmp_path):
        bare = {name: "\n".join(line for line in text.splitlines() if "friction" not in line)
                for name, text in STRUCTURES.items()}  # fmt: skip
        result = CliRunner().invoke(main, ["fragility", str(write(tmp_path, **bare)), "--check"])
        assert result.exit_code == 2
        lines = [line for line in result.stderr.splitlines() if "friction is missing" in line]
        assert [line.split("friction ")[0].strip().rstrip(":").split("/")[-1] for line in lines] == [
            "wall.yaml", "frame.yaml",
        ]  # fmt: skip

    def test_a_linear_model(self, tmp_path):
        with pytest.raises(InputError) as caught:
            load_study(write(tmp_path, STUDY + "model: linear2\n"))
        (problem,) = caught.value.problems
        assert problem.field == "limit_states" and "sliding requires `model: nonlinear`" in problem.message

"""Sliding as a limit state of a study: found run by run as `respond` finds it, and kept only on request."""

import pickle
import shutil

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
from tests.stores import contents, every_run
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


def write(folder, text=STUDY, count=3, **structures):
    for name, content in {**STRUCTURES, **structures}.items():
        (folder / f"{name}.yaml").write_text(content, encoding="utf-8")
    path = folder / "study.yaml"
    path.write_text(text.replace("COUNT", str(count)), encoding="utf-8")
    return path


def slides_as_responded(path, prepared, runs):
    """When runs slide by the check that `respond` makes, of a structure and a motion made anew."""
    study, plan = load_study(path), prepared.plan
    motions, found = [source.read() for source in study.sources], []
    sample, record, eta, level, polarity = plan.places(np.arange(plan.size))
    factors = plan.factors(sample, record, level)
    for k in runs:
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
    found, runs = every_run(place).slide_time, range(0, prepared.plan.size, 5)  # of each sample, level and polarity
    expected = slides_as_responded(path, prepared, runs)
    assert found[runs] == pytest.approx(expected, rel=1e-9, nan_ok=True)
    assert 0 < np.isfinite(expected).sum() < len(runs)
    sample = prepared.plan.places(np.arange(prepared.plan.size))[0]
    shares = [np.isfinite(found[sample == k]).mean() for k in range(len(prepared.plan.trials))]
    assert all(0 < each < 1 for each in shares) and len(set(shares)) > 1


def test_the_block_by_itself_needs_the_friction_that_is_written_out(tmp_path):
    """Without the check of the program: |H|/N of a block at every moment, in `tests/studies/test_contact.py`."""
    text = "structures: [block.yaml]\nrecords: [{pulse: sine:0.6g:0.8s}, {pulse: ricker:0.6g:1.2s}]\nmethod: stripes\n"
    text += "levels: {measure: PGA, least: 0.26, most: 0.5, count: 5}\nlimit_states: [sliding]\n"
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
        unit = workers.unit_of(numbers, prepared.plan, prepared.study, store.facts["hash"], prepared.motions, "exact")
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
    def test_it_is_not_continued_as_if_it_were_another(self, whole, tmp_path):
        path, place = write(tmp_path, STUDY.replace("uplift, sliding, ", "uplift, ")), tmp_path / "study.runs"
        shutil.copytree(whole[2], place)
        with pytest.raises(InputError) as caught:
            carry_out(path, place)
        (problem,) = caught.value.problems
        assert "sliding was checked in every run, is now absent" in str(problem) and "`restart`" in str(problem)
        assert contents(place) == contents(whole[2])


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

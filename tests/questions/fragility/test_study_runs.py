"""Running studies: the same runs whatever stops them, however many workers there are, and wherever they run."""

import json
import shutil
from concurrent.futures import Executor, ThreadPoolExecutor
from threading import Barrier

import numpy as np
import pytest

from rocking_cli.errors import InputError
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.processing.reading import Reading
from rocking_cli.questions.fragility import assess, campaign, curves, store, study, tally, workers
from rocking_cli.questions.fragility.campaign import differences, left, prepare, run
from rocking_cli.questions.fragility.definition import RecordEntry
from rocking_cli.questions.fragility.plan import weaker
from rocking_cli.questions.fragility.store import COLUMNS, Store
from rocking_cli.questions.fragility.study import Source, load_study
from rocking_cli.studies.fragility.quantities import USUAL_MEASURES
from tests.cli.test_cli import run as command
from tests.cli.test_cli import run_json
from tests.conftest import EXAMPLES
from tests.following import respond
from tests.stores import contents, every_run

STUDY = f"""\
structures:
  - {EXAMPLES / "frame.yaml"}
  - file: {EXAMPLES / "block.yaml"}
    name: uncertain
    vary:
      width: {{normal: {{mean: 0.7, deviation: 0.05}}}}
      restitution: {{uniform: {{low: 0.85, high: 0.95}}}}
records:
  - '{EXAMPLES}/*accel.csv'
  - pulse: sine:0.6g:0.8s
  - pulse: ricker:0.6g:1.2s
method: stripes
levels: {{measure: PGA/(g lambda), least: 0.8, most: 4, count: COUNT}}
polarity: both
samples: 4
limit_states: [uplift, 0.25, overturning]
"""


def write(folder, text=STUDY, count=5):
    path = folder / "study.yaml"
    path.write_text(text.replace("COUNT", str(count)), encoding="utf-8")
    return path


def carry_out(path, place, make=workers.threads, **options):
    prepared = prepare(load_study(path), Store.writing(place))
    with make(**options) as hands:
        run(prepared, hands, "exact", left(prepared, "exact").chunks, lambda finished, failed: None)
    return prepared


def asking(whole, measures, **changes):
    """The definition of the study with other measures."""
    return whole[1].study.definition.model_copy(update={"measures": list(measures), **changes})


def finished(place):
    """How many runs a store holds so far."""
    return len(every_run(place)) if (place / "study.json").exists() else 0


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A study and its store, run without interruption on one worker."""
    folder = tmp_path_factory.mktemp("whole")
    path = write(folder)
    return path, carry_out(path, folder / "study.runs", jobs=1), folder / "study.runs"


def test_each_run_is_what_respond_gives(whole):
    _, prepared, place = whole
    study, plan = prepared.study, prepared.plan
    rows = every_run(place)
    assert len(rows) == plan.total == 5 * 3 * 5 * 2
    assert set(rows.outcome.tolist()) == {-1, 0, 1}
    motions = [source.read() for source in study.sources]
    for k in range(0, plan.total, 7):
        sample, record, _, level, polarity = (int(place) for place in np.unravel_index(k, plan.shape))
        trial, known = plan.trials[sample], plan.records[record]
        factor = plan.levels[level] * trial.lambda_ * trial.gravity / (known.pga * STANDARD_GRAVITY)
        motion = motions[record].scaled(plan.polarities[polarity] * factor)
        history = respond(study.samples[sample].mechanism, motion)["nonlinear"]
        assert rows.outcome[k] == history.fell_to
        assert rows.scale[k] == pytest.approx(factor, rel=1e-14)
        if not history.overturned:
            assert rows.peak_ratio[k] == pytest.approx(history.peak_ratio, rel=1e-9)


class TestSameResults:
    @pytest.mark.parametrize("size", [7, 1000])
    def test_whatever_the_chunks(self, whole, tmp_path, monkeypatch, size):
        monkeypatch.setattr(campaign, "runs_per_chunk", lambda plan, definition: size)
        carry_out(whole[0], tmp_path / "other.runs", jobs=3)
        assert len(contents(tmp_path / "other.runs")) == 1 + -(-150 // size)
        one, other = every_run(whole[2]), every_run(tmp_path / "other.runs")
        assert all(getattr(one, name).tobytes() == getattr(other, name).tobytes() for name in COLUMNS)

    def test_whatever_memory_there_is_for_records_and_models(self, whole, tmp_path, monkeypatch):
        monkeypatch.setattr(study, "MAX_SAMPLES_IN_MEMORY", 1)
        monkeypatch.setattr(workers, "MAX_MODELS", 1)
        monkeypatch.setattr(workers, "_MODELS", {})
        carry_out(whole[0], tmp_path / "other.runs", jobs=2)
        assert contents(tmp_path / "other.runs") == contents(whole[2]) and len(workers._MODELS) == 1

    def test_in_parts_into_one_folder(self, whole, tmp_path):
        place, told = tmp_path / "other.runs", []
        for k in (3, 1, 2):
            shown = json.loads(command("fragility", whole[0], "--store", place, "--share", f"{k}/3", "--json").stdout)
            told.append((shown["share"], shown["runs"], shown["finished"], shown["failed"]))
            if k == 3:  # others read meanwhile
                assert json.loads(command("results", place, "--json", code=5).stdout)["finished"] == 22
                assert command("results", place, code=5).stdout.startswith("Partial: 22 of 150 runs.\n")
        assert told == [("3/3", 22, 22, 0), ("1/3", 64, 64, 0), ("2/3", 64, 64, 0)]
        assert contents(place) == contents(whole[2])
        said = command("fragility", whole[0], "--store", place, "--share", "2/3").stdout
        assert said.startswith("Part 2/3: 64 of 64 runs are in ")


def test_workers_that_come_later_get_work_too():
    together, counts = Barrier(6), iter([1, *[3] * 20])
    with ThreadPoolExecutor(6) as executor:
        hands = workers.Workers(executor, lambda: next(counts))
        assert sorted(hands.map(lambda item: together.wait(10), range(6))) == [*range(6)]


def test_a_scheduler_that_is_not_there_is_said_so(whole, tmp_path, monkeypatch):
    monkeypatch.setattr(workers, "SCHEDULER_TIMEOUT", 0.3)
    with pytest.raises(workers.ClusterError, match="no scheduler answers"):
        carry_out(whole[0], tmp_path / "x.runs", workers.cluster, scheduler="tcp://127.0.0.1:9")


def test_a_client_of_a_cluster_is_taken_and_stays_open(whole, tmp_path):
    distributed = pytest.importorskip("distributed", reason="dask.distributed, of the extra cluster, is not installed")
    with (
        distributed.LocalCluster(n_workers=1, processes=False, dashboard_address=None) as local,
        local.get_client() as own,
    ):
        carry_out(whole[0], tmp_path / "x.runs", workers.cluster, scheduler=own)
        assert own.submit(int, 3).result() == 3
        carry_out(whole[0], tmp_path / "z.runs", workers.cluster, scheduler=local.scheduler_address)
    assert contents(tmp_path / "x.runs") == contents(tmp_path / "z.runs") == contents(whole[2])
    with pytest.raises(InputError, match=r"`scheduler` must be an address, or a synchronous Client .* got Executor"):
        carry_out(whole[0], tmp_path / "y.runs", workers.cluster, scheduler=Executor())


class TestChanges:
    @pytest.fixture
    def place(self, whole, tmp_path):
        """A copy of the finished store."""
        return shutil.copytree(whole[2], tmp_path / "study.runs")

    @pytest.mark.parametrize(
        ("old", "new", "said"),
        [
            ("most: 4", "most: 5", "levels.values was 5 numbers from 0.8 to 4.0, is now 5 numbers from 0.8 to 5.0"),
            ("mean: 0.7", "mean: 0.8", "structures.uncertain.vary.width.normal.mean was 0.7, is now 0.8"),
            ("  - pulse: ricker:0.6g:1.2s\n", "", "records is now without ricker:0.6g:1.2s"),
        ],
    )
    def test_a_changed_study_is_named(self, whole, tmp_path, place, old, new, said):
        path = write(tmp_path, STUDY.replace("COUNT", "5").replace(old, new))
        with pytest.raises(InputError) as caught:
            carry_out(path, place)
        assert said in str(caught.value) and "`restart`" in str(caught.value)
        assert len(caught.value.problems) == 1
        assert contents(place) == contents(whole[2])

    ENTRY = "{file: a.csv, units: m, from: displacement, with: b.csv, azimuth: 30, processing: [lowpass 20]}"

    def test_a_changed_reading_is_named(self, tmp_path):
        """What a store has of an entry is read back, and checked against the present entry."""
        t = 0.01 * np.arange(401)
        for name in "ab":
            u = 0.05 * np.sin(np.pi * t / 4) ** 2 * np.sin((8 if name == "a" else 9) * t)
            np.savetxt(tmp_path / f"{name}.csv", np.column_stack([t, u]), delimiter=",")
        text = f"structures: ['{EXAMPLES / 'block.yaml'}']\nrecords: [{self.ENTRY}]\nmethod: cloud\n"
        path, place = write(tmp_path, text), tmp_path / "study.runs"
        carry_out(path, place)
        carry_out(path, place)
        path.write_text(text.replace("lowpass 20", "lowpass 15"), encoding="utf-8")
        with pytest.raises(InputError, match=r"processing.1. was lowpass 20, is now lowpass 15"):
            carry_out(path, place)

    @pytest.mark.parametrize(("old", "new"), [("lowpass: 20", "lowpass: 10"), ("factor: 2", "factor: 4")])
    def test_what_an_entry_makes_of_a_list_is_part_of_the_study(self, tmp_path, old, new):
        texts = {
            "study.yaml": f"structures: ['{EXAMPLES / 'block.yaml'}']\nmethod: cloud\n"
            "records: [{file: set.yaml, processing: [{lowpass: 20}], factor: 1.5}]\n",
            "set.yaml": f"records:\n  - {{file: '{EXAMPLES / 'accel.csv'}', processing: [highpass 0.3], factor: 2}}\n",
        }
        for name, text in texts.items():
            (tmp_path / name).write_text(text, encoding="utf-8")
        before = load_study(tmp_path / "study.yaml")
        assert before.sources[0].read().processing == ("highpass 0.3", "factor 2", "lowpass 20", "factor 1.5")
        for name, text in texts.items():
            (tmp_path / name).write_text(text.replace(old, new), encoding="utf-8")
        found = [*differences(before.description(), load_study(tmp_path / "study.yaml").description())]
        assert len(found) == 1

    def test_another_version_is_named(self, whole, tmp_path, place, monkeypatch):
        monkeypatch.setattr("rocking_cli.questions.fragility.campaign.__version__", "9.9")
        with pytest.raises(InputError, match=r"version of rocking-cli was .*, is now 9.9"):
            carry_out(whole[0], place)

    def test_another_mechanics_of_the_same_version_is_named(self, whole, tmp_path, place, monkeypatch):

        def other(equivalence, model):
            p, lambda_ = weaker(equivalence, model)
            return 1.001 * p, lambda_

        monkeypatch.setattr("rocking_cli.questions.fragility.campaign.weaker", other)
        with pytest.raises(InputError, match=r"p of sample 1 of uncertain was .*, is now"):
            carry_out(whole[0], place)

    def test_restart_keeps_the_old_runs_until_new_ones_can_begin(self, whole, tmp_path, place, monkeypatch):
        monkeypatch.setattr(workers, "SCHEDULER_TIMEOUT", 0.3)
        asked = ("fragility", whole[0], "--store", place, "--restart", "--scheduler", "tcp://127.0.0.1:9")
        assert "no scheduler answers" in command(*asked, code=1).stderr
        assert contents(place) == contents(whole[2])
        assert [each.name for each in tmp_path.iterdir()] == ["study.runs"]


class TestBadParts:
    @pytest.fixture
    def with_bad_record(self, tmp_path):
        (tmp_path / "bad.csv").write_text("t,accel_g\n0,0\n0.01,x\n", encoding="utf-8")
        return write(tmp_path, STUDY.replace("method:", "  - bad.csv\nmethod:"), count=2)

    def test_a_bad_record_is_reported_and_the_others_run(self, with_bad_record, tmp_path):
        result = command("fragility", with_bad_record, "--json", code=5)
        assert "bad.csv" in result.stderr and ":3" in result.stderr
        found = json.loads(result.stdout)
        assert found["finished"] == found["runs"] == 5 * 3 * 2 * 2
        assert len(found["left_out"]) == 1 and "bad.csv" in found["left_out"][0]
        # And again when nothing is left to run.
        command("fragility", with_bad_record, code=5)
        command("results", tmp_path / "study.runs", code=5)

    def test_a_record_put_right_is_run(self, with_bad_record, tmp_path):
        command("fragility", with_bad_record, code=5)
        (tmp_path / "bad.csv").write_bytes((EXAMPLES / "accel.csv").read_bytes())
        result = command("fragility", with_bad_record, "--json", code=0)
        assert "bad.csv: could not be used" in result.stderr
        assert json.loads(result.stdout)["finished"] == 5 * 4 * 2 * 2

    def test_nothing_that_can_be_used(self, tmp_path):
        (tmp_path / "zero.csv").write_text("t,accel_g\n0,0\n0.01,0\n0.02,0\n", encoding="utf-8")
        path = write(tmp_path, f"structures: [{EXAMPLES / 'block.yaml'}]\nrecords: [zero.csv]\nmethod: cloud\n")
        assert "no record can be used" in command("fragility", path, code=2).stderr
        assert not (tmp_path / "study.runs").exists()

    def test_a_structure_too_stocky_for_its_kinematics(self, tmp_path):
        (tmp_path / "stocky.yaml").write_text("mechanism: block\nwidth: 3\nheight: 1\n", encoding="utf-8")
        text = STUDY.replace("structures:", "structures:\n  - stocky.yaml")
        result = command("fragility", write(tmp_path, text, count=2), "--json", code=5)
        assert "its kinematics give a restitution of -0.35" in result.stderr
        assert {each["structure"] for each in json.loads(result.stdout)["curves"]} == {"valley bridge", "uncertain"}


def test_the_rate_is_there_though_other_measures_are_asked_for(tmp_path):
    more = "measures: [PGV]\nhazard: {points: [[0.1, 0.01], [1, 0.0001]]}\nmethod:"
    path = write(tmp_path, STUDY.replace("method:", more), count=5)
    curves = run_json("fragility", path)["curves"]
    assert {each["measure"] for each in curves} == {"PGV", "PGA"}
    rates = {name: [each["annual_rate"] for each in curves if each["measure"] == name] for name in ("PGA", "PGV")}
    assert any(rates["PGA"]) and not any(rates["PGV"])


def test_runs_are_grouped_by_level_where_it_decides_their_intensity(whole):
    kept, rows, asked = Store.reading(whole[2]), every_run(whole[2]), asking(whole, USUAL_MEASURES)
    plan = kept.plan
    found = {name: tally.count(kept, plan, name, asked) for name in ("valley bridge", "uncertain")}
    over = {name: {each for each in USUAL_MEASURES if found[name].decided_by_level(each)} for name in found}
    assert over == {"valley bridge": {"PGA", "PGA/(g lambda)"}, "uncertain": {"PGA/(g lambda)"}}  # its lambda varies
    # Of the bridge one sample, of the other four: 3 records at 5 levels each, of both polarities.
    cells = {(name, each): found[name].over(each).runs for name in found for each in ("PGA", "PGA/(g lambda)")}
    assert {key: (runs.size, set(runs.tolist())) for key, runs in cells.items()} == {
        ("valley bridge", "PGA"): (15, {2}),
        ("valley bridge", "PGA/(g lambda)"): (15, {2}),
        ("uncertain", "PGA"): (60, {2}),
        ("uncertain", "PGA/(g lambda)"): (15, {8}),
    }
    fallen = (rows.outcome[30:] != 0).reshape(4, 3, 5, 2)
    of = found["uncertain"]
    together = of.over("PGA/(g lambda)").of(of.exceeding["overturning"])
    assert together.tolist() == fallen.sum(axis=(0, 3)).ravel().tolist()
    assert of.over("PGA").of(of.exceeding["overturning"]).tolist() == fallen.sum(axis=3).ravel().tolist()
    sample, record, level = of.over("PGA").place
    x = of.over("PGA").intensities("PGA")
    expected = rows.scale[30:].reshape(4, 3, 5, 2)[..., 0] * np.array([each.pga for each in plan.records])[:, None]
    np.testing.assert_allclose(x, expected[sample, record, level], rtol=1e-14)


def test_what_is_counted_does_not_depend_on_how_it_is_read(whole, monkeypatch):
    kept, seen = Store.reading(whole[2]), []
    plan, asked = kept.plan, asking(whole, USUAL_MEASURES, method="ida")
    once = tally.count(kept, plan, "uncertain", asked, seen.append)
    monkeypatch.setattr(store, "ROWS_PER_READ", 7)
    piecewise = tally.count(kept, plan, "uncertain", asked, seen.append)
    assert sum(seen) == 2 * 120
    np.testing.assert_array_equal(piecewise.runs, once.runs)
    np.testing.assert_array_equal(piecewise.ladders.there, once.ladders.there)
    for limit in ("uplift", 0.25):
        np.testing.assert_array_equal(piecewise.exceeding[limit], once.exceeding[limit])
        np.testing.assert_array_equal(piecewise.ladders.first[limit], once.ladders.first[limit])


def test_a_file_that_changes_before_it_is_read_again_stops_the_study(tmp_path, monkeypatch):
    monkeypatch.setattr(study, "MAX_SAMPLES_IN_MEMORY", 1)
    (tmp_path / "accel.csv").write_bytes((EXAMPLES / "accel.csv").read_bytes())
    path = write(tmp_path, STUDY.replace(f"{EXAMPLES}/*accel.csv", "accel.csv"))
    prepared = prepare(load_study(path), Store.writing(tmp_path / "study.runs"))
    (tmp_path / "accel.csv").write_text("t,accel_g\n0,0\n0.01,1\n", encoding="utf-8")
    with pytest.raises(InputError, match="has changed while the study ran"), workers.threads(1) as hands:
        run(prepared, hands, "exact", prepared.store.chunks, print)


def test_incremental_analysis_takes_the_first_exceedance(tmp_path):
    path = write(tmp_path, STUDY.replace("method: stripes", "method: ida").replace("most: 4", "most: 2.2"), count=6)
    prepared = carry_out(path, tmp_path / "study.runs")
    kept, definition = Store.reading(tmp_path / "study.runs"), prepared.study.definition
    plan, (rows,) = kept.plan, kept.rows(36, kept.plan.total)
    found = tally.count(kept, plan, "uncertain", definition)
    assert tally.peaks(kept, plan, "uncertain").shape == (24, 6)
    (_, _, overturning) = assess.curves(found, "uncertain", definition, None)
    table = (rows.outcome != 0).reshape(4, 3, 6, 2)
    lower, upper, exceeding = [], [], np.zeros((6, 3))
    for sample, record, polarity in np.ndindex(4, 3, 2):  # samples, records, polarities
        fallen = np.flatnonzero(table[sample, record, :, polarity])
        first = int(fallen[0]) if fallen.size else 6
        lower.append(plan.levels[first - 1] if first else 0)
        upper.append(plan.levels[first] if first < 6 else np.inf)
        exceeding[first:, record] += 1
    expected = curves.fit_capacities(
        np.array(lower), np.array(upper), np.tile(np.repeat(np.arange(3), 2), 4), levels=np.array(plan.levels)
    )
    assert np.isinf(upper).any()
    assert (overturning.curve.runs, overturning.curve.why) == (24, expected.why)
    assert overturning.curve.own.median == expected.median
    assert overturning.seen.exceeding.tolist() == exceeding.ravel().tolist()


def test_check_counts_what_is_left_out_apart(tmp_path):
    (tmp_path / "still.csv").write_text("0,0\n0.01,0\n0.02,0\n", encoding="utf-8")
    path = write(tmp_path, STUDY.replace("records:", "records:\n  - {file: still.csv, units: g}"), count=5)
    data = json.loads(command("fragility", path, "--check", "--json", code=5).stdout)
    assert (data["records"], len(data["left_out"]), data["runs"]) == (3, 1, 150)
    words = command("fragility", path, "--check", code=5).stdout.split("\n")
    assert [line.split() for line in words if "records" in line] == [["records", "3"], ["records", "left", "out", "1"]]


def test_samples_that_differ_in_their_restitution_only(tmp_path):
    """They share a model, whose restitution each run replaces."""
    text = STUDY.replace("      width: {normal: {mean: 0.7, deviation: 0.05}}\n", "").replace("both", "1")
    prepared = carry_out(write(tmp_path, text.replace("samples: 4", "samples: 2"), count=3), tmp_path / "study.runs")
    study, rows = prepared.study, every_run(tmp_path / "study.runs")
    sample, record, *_ = prepared.plan.places(rows.run)
    motion, peaks = study.sources[1].read(), []
    for k in np.flatnonzero((record == 1) & (sample > 0)):
        mechanism = study.samples[sample[k]].mechanism
        history = respond(mechanism, motion.scaled(rows.scale[k]))["nonlinear"]
        assert rows.eta[k] == mechanism.restitution
        peaks.append((rows.peak_ratio[k], history.peak_ratio))
    found, expected = np.transpose(peaks)
    assert found == pytest.approx(expected, rel=1e-9, nan_ok=True) and len(set(found.tolist())) > 3


def test_the_checksum_of_a_pulse_is_of_all_its_digits_and_of_how_it_is_sampled(monkeypatch):
    """A store does not mix runs under pulses that differ in the seventh digit, or in their samples."""

    def checksum(text):
        return Source(text, RecordEntry(pulse=text), Reading(), text).checksum()

    one = checksum("sine:0.3g:1s")
    assert one == checksum("sine:0.3g:1.0s") != checksum("sine:0.30000001g:1s")
    monkeypatch.setattr("rocking_cli.questions.fragility.study.SAMPLING", "otherwise")
    assert checksum("sine:0.3g:1s") != one

"""The folder of a store: what is kept, under which name, and what is never touched."""

import errno
import json
import shutil

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.errors import InputError
from rocking_cli.io import files
from rocking_cli.questions.fragility import store
from rocking_cli.questions.fragility.campaign import prepare
from rocking_cli.questions.fragility.store import COLUMNS, Store
from rocking_cli.questions.fragility.study import load_study
from tests.conftest import EXAMPLES
from tests.stores import RUNS, Sound, command, contents, shown


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    return Sound(tmp_path_factory.mktemp("sound"))


@pytest.fixture
def place(sound, tmp_path):
    return shutil.copytree(sound.store, tmp_path / "study.runs")


def names(folder):
    return sorted(each.name for each in folder.iterdir())


def test_numpy_and_pandas_read_it(place):
    """The six lines of docs/fragility.md."""
    import pandas as pd

    study = json.loads((place / "study.json").read_text(encoding="utf-8"))
    chunks = (np.load(file) for file in sorted(place.glob("runs-*.npz")))
    runs = pd.concat(pd.DataFrame({name: chunk[name] for name in study["columns"]}) for chunk in chunks)
    assert len(runs) == study["runs"] == RUNS and list(runs) == list(COLUMNS)
    shape = [len(study[each]) for each in ("samples", "records", "restitutions", "levels", "polarities")]
    sample, record, _, level, _ = np.unravel_index(runs["run"], shape)
    levels = np.array(study["levels"])[level]
    pga = np.array([each["pga"] for each in study["records"]])[record]
    assert runs["scale"].to_numpy() == pytest.approx(levels / pga)
    assert {study["samples"][k]["structure"] for k in sample} == {"valley bridge", "uncertain"}


def test_ended_before_the_first_run_it_has_said_where_the_old_store_is(sound, place, monkeypatch):
    def end(*arguments):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr("rocking_cli.questions.fragility.campaign.run", end)
        result = command("fragility", sound.study, "--store", place, "--restart", code=130)
    aside = place.with_name("study.before.runs")
    assert str(aside) in result.stderr and contents(aside) == contents(sound.store)
    assert shown(command("fragility", sound.study, "--store", place, "--json").stdout) == sound.shown


def test_a_name_that_another_process_takes_meanwhile_is_left_to_it(sound, place, monkeypatch):
    theirs = place.with_name("study.before.runs")

    def taken_at_once(*arguments):
        name = numbered(*arguments)
        if not theirs.exists():
            shutil.copytree(place, theirs)
        return name

    numbered = store.numbered
    monkeypatch.setattr(store, "numbered", taken_at_once)
    said = command("fragility", sound.study, "--store", place, "--restart", code=0).stderr
    ours = place.with_name("study.before-2.runs")
    assert str(ours) in said and contents(theirs) == contents(ours) == contents(place) == contents(sound.store)


def test_a_full_disk_is_named_and_loses_nothing(sound, place, monkeypatch):
    written = []

    def fills(handle, write):
        if len(written) == 3:
            raise OSError(errno.ENOSPC, "No space left on device")
        written.append(handle)
        return fill(handle, write)

    fill = files._fill
    with monkeypatch.context() as patch:
        patch.setattr(files, "_fill", fills)
        result = command("fragility", sound.study, "--store", place, "--restart", code=1)
    assert ".npz: cannot be written: No space left" in result.stderr and "run the same command again" in result.stderr
    assert len(names(place)) == 3
    assert shown(command("fragility", sound.study, "--store", place, "--json", code=0).stdout) == sound.shown


def test_damaged_files_are_named_and_computed_again(sound, place):
    (place / "runs-000001.npz").write_bytes((place / "runs-000001.npz").read_bytes()[:-1])
    shutil.copyfile(place / "runs-000000.npz", place / "runs-000002.npz")
    (place / "runs-000003.npz").unlink()
    result = command("results", place, code=2)
    assert "runs-000001.npz (File is not a zip file); runs-000002.npz (its runs are not those from 128 to 191)" in (
        " ".join(result.stderr.split())
    )
    assert "64 of 240 runs are whole" in result.stderr and not result.stdout
    result = command("fragility", sound.study, "--store", place, "--json", code=0)
    assert result.stderr.count("damaged, and computed again: runs-00000") == 2
    assert "64 of 240 runs are in the store already" in result.stderr
    assert shown(result.stdout) == sound.shown and contents(place) == contents(sound.store)


def test_runs_under_another_record_of_the_same_name_are_not_taken_for_those_of_this_one(tmp_path):
    """Two folders with one study and a record each: a chunk, or all of them, of the other are refused."""
    text = f"structures: ['{EXAMPLES / 'block.yaml'}']\nrecords: [r.csv]\nmethod: stripes\n"
    text += "levels: {measure: scale, least: 0.5, most: 3, count: 6}\n"
    for name, record in (("a", "accel.csv"), ("b", "accel_transverse.csv")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "s.yaml").write_text(text, encoding="utf-8")
        shutil.copyfile(EXAMPLES / record, tmp_path / name / "r.csv")
        command("fragility", tmp_path / name / "s.yaml", code=0)
    one, other = tmp_path / "a" / "s.runs", tmp_path / "b" / "s.runs"
    own = contents(one)
    shutil.copyfile(other / "runs-000000.npz", one / "runs-000000.npz")
    for words in (["results", one], ["fragility", one.with_suffix(".yaml")]):
        assert "its runs are of another study, of other records" in command(*words, code=2).stderr
    (one / "study.json").unlink()
    assert "its runs are of another study" in command("fragility", one.with_suffix(".yaml"), code=2).stderr
    (one / "study.json").unlink()
    said = command("fragility", one.with_suffix(".yaml"), "--restart", code=0).stderr
    assert "kept as" in said and contents(one) == own
    assert [*contents(one.with_name("s.before.runs"))] == ["runs-000000.npz"]


def test_a_writer_stops_if_its_study_is_restarted_with_another_record(tmp_path):
    text = f"structures: ['{EXAMPLES / 'block.yaml'}']\nrecords: [r.csv]\nmethod: cloud\n"
    (tmp_path / "s.yaml").write_text(text, encoding="utf-8")
    shutil.copyfile(EXAMPLES / "accel.csv", tmp_path / "r.csv")
    answer = rk.fragility(tmp_path / "s.yaml")
    writer = Store.writing(tmp_path / "s.runs")
    rows = writer.chunk(0)
    shutil.copyfile(EXAMPLES / "accel_transverse.csv", tmp_path / "r.csv")
    command("fragility", tmp_path / "s.yaml", "--restart", code=0)
    with pytest.raises(InputError, match="another process has started this study from scratch"):
        writer.add(rows)
    with pytest.raises(InputError, match="has been run again since these results were read"):
        answer.runs()


def test_a_damaged_description_and_one_of_another_layout_are_refused_and_kept_by_restart(sound, place, monkeypatch):
    found = contents(place)
    with monkeypatch.context() as patch:
        patch.setattr(store, "LAYOUT", 10)
        assert "the layout 9, and this version of rocking reads 10 only" in command("results", place, code=2).stderr
    (place / "study.json").write_bytes(found["study.json"].replace(b'"seed": 0', b'"seed": 1'))
    found = contents(place)
    for words in (["results", place], ["fragility", sound.study, "--store", place]):
        said = command(*words, code=2).stderr
        assert "study.json does not match its checksum" in said and "restart" in said
    run = command("fragility", sound.study, "--store", place, "--restart", "--json", code=0)
    assert shown(run.stdout) == sound.shown and contents(place.with_name("study.before.runs")) == found


def test_what_is_no_store_is_refused_and_left_alone(sound, tmp_path):
    (tmp_path / "study.db").write_bytes(b"SQLite format 3\0")
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder" / "thesis.txt").touch()
    for name in ("study.db", "folder"):
        for words in (["results"], ["fragility", sound.study, "--store"]):
            assert "not the store of a study" in command(*words, tmp_path / name, code=2).stderr
        restart = command("fragility", sound.study, "--store", tmp_path / name, "--restart", code=2)
        assert "not the store of a study" in restart.stderr
    assert "no such store" in command("results", tmp_path / "none.runs", code=2).stderr
    (tmp_path / "new.runs").mkdir()
    assert "still empty" in command("results", tmp_path / "new.runs", code=2).stderr
    assert "does not exist" in command("fragility", sound.study, "--store", tmp_path / "no" / "x.runs", code=2).stderr
    assert names(tmp_path) == ["folder", "new.runs", "study.db"] and names(tmp_path / "folder") == ["thesis.txt"]


def test_a_study_that_another_process_begins_meanwhile_is_gone_on_with(sound, tmp_path):
    study = load_study(sound.study)
    late, first = Store.writing(tmp_path / "study.runs"), Store.writing(tmp_path / "study.runs")
    prepare(study, first)
    assert late.empty
    assert prepare(study, late).store.facts == first.facts
    other = Store.writing(tmp_path / "other.runs")
    prepare(load_study(sound.other), Store.writing(tmp_path / "other.runs"))
    with pytest.raises(InputError, match="seed was 1, is now 0"):
        prepare(study, other)


def test_a_writer_whose_store_another_process_has_put_aside_stops(sound, place):
    writer = Store.writing(place)
    rows = writer.chunk(0)
    command("fragility", sound.study, "--store", place, "--restart", code=0)
    writer.add(rows)  # the same study: the same runs
    assert contents(place) == contents(sound.store)
    shutil.rmtree(place)
    with pytest.raises(InputError, match="this store has been moved or deleted"):
        writer.add(rows)
    shutil.copytree(sound.other.with_suffix(".runs"), place)
    with pytest.raises(InputError, match="another process has started this study from scratch"):
        writer.add(rows)


def test_a_store_made_before_peak_rates_were_computed_is_read_and_gone_on_with(sound, place):
    for file in place.glob("runs-*.npz"):
        with np.load(file) as chunk:
            kept = {name: chunk[name] for name in chunk.files if name != "peak_rate"}
        np.savez(file, **kept)
    old, new = Store.reading(place), Store.reading(sound.store)
    first, whole = next(old.rows(0, RUNS)), next(new.rows(0, RUNS))
    assert np.isnan(first.peak_rate).all() and (whole.peak_rate[whole.uplifts & ~whole.overturned] > 0).all()
    np.testing.assert_array_equal(first.peak_ratio, whole.peak_ratio)
    (place / "runs-000001.npz").unlink()
    assert shown(command("fragility", sound.study, "--store", place, "--json", code=0).stdout) == sound.shown
    assert np.isfinite(next(Store.reading(place).rows(0, RUNS)).peak_rate).any()


def test_a_reader_whose_store_is_put_aside_between_two_readings_stops(sound, place):
    """Else the shares would be of all runs, and what is read after them of none."""
    reader = Store.reading(place)
    first = [*reader.rows(0, RUNS)]
    place.rename(place.with_name("aside.runs"))
    with pytest.raises(InputError, match="this store has been moved or deleted"):
        [*reader.rows(0, RUNS)]
    place.mkdir()
    shutil.copyfile(sound.store / "study.json", place / "study.json")  # begun anew, without a run
    with pytest.raises(InputError, match="another process has started this study from scratch"):
        [*reader.rows(0, RUNS)]
    assert sum(map(len, first)) == RUNS and not [*Store.reading(place).rows(0, RUNS)]


def test_a_description_goes_where_another_process_has_made_the_folder_anew(sound, tmp_path, monkeypatch):
    """The first writing fails, as the folder went aside with what was written."""
    write, failures = store.write_whole, [InputError("gone")]

    def written(*given):
        if failures:
            raise failures.pop()
        write(*given)

    monkeypatch.setattr(store, "write_whole", written)
    begun = Store.writing(tmp_path / "study.runs")
    prepare(load_study(sound.study), begun)
    assert (tmp_path / "study.runs" / "study.json").read_bytes() and not failures

"""The file of a store: what is kept, under which name, and what is never touched."""

import os
import re
import sqlite3
import sys
from contextlib import closing

import pytest

from rocking_cli.errors import InputError
from rocking_cli.questions.fragility import store
from rocking_cli.questions.fragility.store import Store, naming_store, open_locked, put_aside, this_process
from tests.stores import Sound, command, shown


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    return Sound(tmp_path_factory.mktemp("sound"))


@pytest.fixture
def place(sound, tmp_path):
    path = tmp_path / "study.db"
    path.write_bytes(sound.store.read_bytes())
    return path


def names(folder):
    return sorted(each.name for each in folder.iterdir())


def test_a_new_name_has_no_journal_that_waits_for_it(tmp_path):
    path = tmp_path / "study.db"
    (tmp_path / "study.before.db-journal").touch()
    (tmp_path / "study.before-2.db").symlink_to("nowhere")
    path.touch()
    assert put_aside(path, open_locked(path)).name == "study.before-3.db"
    assert not path.exists()


def test_restart_leaves_files_of_others_alone(sound, place):
    theirs = place.with_name("study.before.db"), place.with_name("study.db.before")
    for each in theirs:
        each.write_text("precious", encoding="utf-8")
    old = place.read_bytes()
    result = command("fragility", sound.study, "--store", place, "--restart", code=0)
    assert f"the store as it was is kept as {place.with_name('study.before-2.db')}" in result.stderr
    assert all(each.read_text(encoding="utf-8") == "precious" for each in theirs)
    assert place.with_name("study.before-2.db").read_bytes() == old


@pytest.mark.skipif(sys.platform == "win32", reason="links need rights there")
def test_restart_goes_through_a_link(sound, place, tmp_path):
    (tmp_path / "elsewhere").mkdir()
    target = place.rename(tmp_path / "elsewhere" / "far.db")
    place.symlink_to(target)
    old = target.read_bytes()
    assert command("fragility", sound.study, "--store", place, "--restart").exit_code == 0
    assert place.is_symlink() and place.resolve() == target
    assert names(target.parent) == ["far.before.db", "far.db"]
    assert target.with_name("far.before.db").read_bytes() == old


def test_ended_before_the_first_run_it_has_said_where_the_old_store_is(sound, place, monkeypatch):
    def end(*arguments):
        raise KeyboardInterrupt

    old = place.read_bytes()
    with monkeypatch.context() as patch:
        patch.setattr("rocking_cli.questions.fragility.campaign.run", end)
        result = command("fragility", sound.study, "--store", place, "--restart")
    assert result.exit_code == 130
    aside = place.with_name("study.before.db")
    assert str(aside) in result.stderr and aside.read_bytes() == old
    assert shown(command("fragility", sound.study, "--store", place, "--json").stdout) == sound.shown
    assert names(place.parent) == ["study.before.db", "study.db"]


def test_the_old_store_is_kept_where_the_new_one_cannot_be_made(sound, place, monkeypatch):
    def full(*arguments):
        error = sqlite3.OperationalError("database or disk is full")
        error.sqlite_errorcode = sqlite3.SQLITE_FULL
        raise error

    old, aside = place.read_bytes(), place.with_name("study.before.db")
    with monkeypatch.context() as patch:
        patch.setattr(Store, "_fill", full)
        result = command("fragility", sound.study, "--store", place, "--restart")
    assert result.exit_code == 1 and "full" in result.stderr and str(aside) in result.stderr
    assert aside.read_bytes() == old
    assert shown(command("fragility", sound.study, "--store", place, "--json").stdout) == sound.shown


@pytest.mark.parametrize("version", [0, 6, 99])
def test_a_store_of_another_layout_is_refused_and_kept_by_restart(sound, place, version):
    with closing(sqlite3.connect(place, isolation_level=None)) as connection:
        connection.execute(f"PRAGMA user_version = {version}")
    old = place.read_bytes()
    for arguments in (["results", place], ["fragility", sound.study, "--store", place]):
        result = command(*arguments)
        assert result.exit_code == 2 and f"the layout {version}" in result.stderr
        assert "run the study again with" in result.stderr
    run = command("fragility", sound.study, "--store", place, "--restart", "--json")
    assert run.exit_code == 0 and shown(run.stdout) == sound.shown
    assert place.with_name("study.before.db").read_bytes() == old


def test_a_damaged_run_is_named_and_refused(sound, place):
    with closing(sqlite3.connect(place, isolation_level=None)) as connection:
        connection.execute("UPDATE run SET peak_ratio = 0.1 WHERE id = 53")
        connection.execute("UPDATE run SET eta = 'nonsense' WHERE id = 240 - 1")
        connection.execute("UPDATE run SET id = 240 WHERE id = 17")  # of 240, from 0
    old = place.read_bytes()
    for arguments in (["results", place, "--json"], ["fragility", sound.study, "--store", place]):
        result = command(*arguments)
        assert result.exit_code == 2 and not result.stdout
        assert "run 53 (uncertain, sample 0, sine:0.6g:0.8s, level 0.3, polarity -1); run 239" in result.stderr
        assert "run 240, which the study does not have" in result.stderr
        assert "237 of 240 runs are whole" in result.stderr and "restart" in result.stderr
    assert place.read_bytes() == old


def test_what_is_damaged_is_counted_whatever_is_read_at_a_time(place, monkeypatch):
    with closing(sqlite3.connect(place, isolation_level=None)) as connection:
        connection.execute("UPDATE run SET checksum = checksum + 1 WHERE id % 100 = 7")
    monkeypatch.setattr("rocking_cli.questions.fragility.store.RUNS_PER_READ", 9)
    said = command("results", place).stderr
    assert "3 runs do not match" in said and "237 of 240 runs are whole" in said


def test_a_page_that_cannot_be_read_is_named_and_what_can_is_counted(sound, place, monkeypatch):
    content = bytearray(place.read_bytes())
    leaves = [k for k in range(4096, len(content), 4096) if content[k] == 13 and content[k + 4] >= 40]
    content[leaves[-1] : leaves[-1] + 8] = bytes(8)
    place.write_bytes(content)
    monkeypatch.setattr("rocking_cli.questions.fragility.store.RUNS_PER_READ", 20)
    result = command("fragility", sound.study, "--store", place)
    assert result.exit_code == 2 and "malformed" in result.stderr and place.read_bytes() == content
    assert 0 < int(re.search(r"(\d+) of 240 runs are whole", result.stderr)[1]) < 240


def test_who_is_at_work_is_named_while_he_is(sound, place):
    with Store.writing(place):
        other = command("fragility", sound.study, "--store", place)
        assert other.exit_code == 2 and f"another process is at work on this study: {this_process()}" in other.stderr
        assert "--restart" not in other.stderr
        anew = command("fragility", sound.study, "--store", place, "--restart")
        assert anew.exit_code == 2 and "another process is at work" in anew.stderr
    with closing(sqlite3.connect(place)) as connection:
        assert not connection.execute("SELECT * FROM study WHERE key = 'at work'").fetchall()
    assert names(place.parent) == ["study.db"]


@pytest.mark.skipif(sys.platform == "win32", reason="an open file is not replaced there")
@pytest.mark.parametrize("options", [[], ["--restart"]])
@pytest.mark.parametrize("is_at_work", [True, False])
def test_a_store_that_is_replaced_while_it_is_opened_is_left_for_the_new_one(
    sound, place, monkeypatch, options, is_at_work
):
    """Another process restarts the study between the look at the file and its lock: the one locked has moved."""
    open_store, opened = store.open_store, []

    def open_and_lose(path):
        connection = open_store(path)
        if not opened:
            # Open, its number is not used again.
            opened.append(sqlite3.connect(path.rename(path.with_name("study.before.db"))))
            path.write_bytes(sound.store.read_bytes())
            if is_at_work:
                opened.append(sqlite3.connect(path, isolation_level=None))
                opened[-1].execute("BEGIN IMMEDIATE")
        return connection

    monkeypatch.setattr(store, "open_store", open_and_lose)
    result = command("fragility", sound.study, "--store", place, "--json", *options)
    for each in opened:
        each.close()
    if is_at_work:
        assert result.exit_code == 2 and "another process is at work on this study" in result.stderr
        assert names(place.parent) == ["study.before.db", "study.db"]
    else:
        assert result.exit_code == 0 and shown(result.stdout) == sound.shown
        assert ("study.before-2.db" in names(place.parent)) == bool(options)
    assert place.with_name("study.before.db").read_bytes() == sound.store.read_bytes()


def test_a_study_that_another_process_begins_meanwhile_is_left_to_it(sound, tmp_path):
    from rocking_cli.questions.fragility.campaign import prepare
    from rocking_cli.questions.fragility.study import load_study

    place, study = tmp_path / "study.db", load_study(sound.study)
    with Store.writing(place) as late, Store.writing(place) as first:
        assert late.empty and first.empty and not place.exists()
        prepare(study, first)
        with pytest.raises(InputError, match="another process is at work"):
            prepare(study, late)
    with Store.writing(tmp_path / "other.db") as late:
        with Store.writing(tmp_path / "other.db") as first:
            prepare(study, first)
        with pytest.raises(InputError, match="another process has just started this study"):
            prepare(study, late)
    with Store.reading(tmp_path / "other.db") as kept:
        assert kept.count() == (0, 0)


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such pipes")
def test_a_store_is_no_pipe(sound, tmp_path):
    place = tmp_path / "pipe.db"
    os.mkfifo(place)
    for more in ([], ["--restart"]):
        assert "this is a device or a pipe" in command("fragility", sound.study, "--store", place, *more, code=2).stderr
    assert "this is a device or a pipe" in command("results", place).stderr
    assert place.is_fifo() and names(tmp_path) == ["pipe.db"]


@pytest.mark.every(3)
@pytest.mark.parametrize("place_in_header", [16, 18, 19, 21, 47, 59])
def test_restart_puts_a_store_with_a_damaged_header_aside(sound, place, place_in_header):
    content = bytearray(place.read_bytes())
    content[place_in_header] = 99
    place.write_bytes(content)
    assert command("fragility", sound.study, "--store", place).exit_code in (1, 2) and place.read_bytes() == content
    result = command("fragility", sound.study, "--store", place, "--restart", "--json")
    assert result.exit_code == 0 and shown(result.stdout) == sound.shown
    assert place.with_name("study.before.db").read_bytes() == content


def test_a_page_that_lost_its_runs_is_not_written_to(sound, place):
    """The header of a page says how many rows are on it: with a smaller number a reader finds nothing wrong."""
    content = bytearray(place.read_bytes())
    leaf = next(k for k in range(4096, len(content), 4096) if content[k] == 13 and content[k + 4] >= 40)
    content[leaf + 4] -= 5
    place.write_bytes(content)
    assert shown(command("results", place, "--json").stdout)["finished"] == 235
    assert "235 of 240 runs are whole" in command("fragility", sound.study, "--store", place, code=2).stderr
    assert place.read_bytes() == content


@pytest.mark.parametrize("column", [b"outcome", b"peak_ratio", b"number", b"reason"])
def test_a_damaged_name_of_a_column_is_a_damaged_store(sound, place, column):
    content = bytearray(sound.store.read_bytes())
    for name in (b"CREATE TABLE run", b"CREATE TABLE sample"):
        at = content.index(column, content.index(name)) if column in content[content.index(name) :][:400] else 0
        if at:
            content[at + 1] = 0xFF
    place.write_bytes(content)
    assert f"{place}: the store is damaged" in command("results", place, code=2).stderr


@pytest.mark.skipif(os.name == "nt", reason="Windows moves no file that is open")
def test_a_store_that_a_restart_has_moved_is_no_matter_of_rights(tmp_path):
    path = tmp_path / "study.db"
    connection = sqlite3.connect(path, isolation_level=None)
    connection.execute("CREATE TABLE runs (number)")
    path.rename(tmp_path / "study.before.db")
    with (
        pytest.raises(InputError, match=r"study\.db: another process has moved this store") as caught,
        naming_store(path),
    ):
        connection.execute("INSERT INTO runs VALUES (1)")
    connection.close()
    assert "run the same command again" in str(caught.value)

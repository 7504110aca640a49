"""Output files appear whole or not at all."""

import os
import stat
import sys
from pathlib import Path

import pytest

from rocking_cli.errors import InputError, Refused
from rocking_cli.io import files
from rocking_cli.io.files import (
    LISTING,
    check_writable,
    discard,
    keep_apart,
    read_bytes,
    write_files,
    write_folder,
    write_whole,
)


def test_a_file_is_written_with_the_usual_rights(tmp_path):
    path = tmp_path / "a.csv"
    write_whole(path, lambda file: file.write(b"1\n"))
    assert path.read_bytes() == b"1\n"
    plain = tmp_path / "plain"
    plain.touch()
    assert path.stat().st_mode == plain.stat().st_mode


@pytest.mark.skipif(sys.platform == "win32", reason="links need rights there")
def test_a_link_is_written_through(tmp_path):
    target, link = tmp_path / "target.csv", tmp_path / "link.csv"
    target.write_bytes(b"old")
    link.symlink_to(target)
    write_whole(link, lambda file: file.write(b"new"))
    assert link.is_symlink() and target.read_bytes() == b"new"


def test_a_failure_leaves_the_older_file_and_nothing_else(tmp_path):
    path = tmp_path / "a.csv"
    path.write_bytes(b"old")

    def fail(file):
        file.write(b"half")
        raise RuntimeError("stop")

    with pytest.raises(RuntimeError):
        write_whole(path, fail)
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_full_disk_is_refused_by_the_system(tmp_path):
    def full(file):
        raise OSError(28, "No space left on device")

    with pytest.raises(Refused, match="No space left"):
        write_whole(tmp_path / "a.csv", full)
    assert list(tmp_path.iterdir()) == []


def test_places_that_take_no_file_are_refused(tmp_path):
    with pytest.raises(InputError, match="folder"):
        check_writable(tmp_path)
    with pytest.raises(InputError, match="does not exist"):
        check_writable(tmp_path / "none" / "a.csv")


@pytest.mark.skipif(sys.platform == "win32" or os.geteuid() == 0, reason="needs a user whose rights are checked")
def test_a_folder_without_write_permission_is_refused(tmp_path):
    tmp_path.chmod(0o500)
    with pytest.raises(InputError, match="cannot be written"):
        check_writable(tmp_path / "a.csv")
    tmp_path.chmod(0o700)


def test_outputs_are_kept_apart_from_inputs_and_from_each_other(tmp_path):
    read, new = tmp_path / "read.csv", tmp_path / "new.csv"
    read.touch()
    keep_apart([("--out", new), ("--plot", None)], [str(read), None, str(tmp_path / "none")])
    with pytest.raises(InputError, match="--out would overwrite an input file"):
        keep_apart([("--out", tmp_path / "." / "read.csv")], [str(read)])
    with pytest.raises(InputError, match="--out and --plot cannot be the same file"):
        keep_apart([("--out", new), ("--plot", tmp_path / "." / "new.csv")], [])


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has neither there")
class TestReadBytes:
    def test_a_device_is_refused_before_it_is_read(self):
        with pytest.raises(InputError, match="a device or a pipe, not a record file"):
            read_bytes("/dev/zero", "record file", 1000)

    def test_a_pipe_that_nobody_writes_to_is_refused_at_once(self, tmp_path):
        os.mkfifo(tmp_path / "pipe")
        with pytest.raises(InputError, match="a device or a pipe"):
            read_bytes(tmp_path / "pipe", "record file", 1000)

    def test_no_more_is_read_than_may_be(self, tmp_path):
        (tmp_path / "file").write_bytes(b"x" * 1001)
        with pytest.raises(InputError, match=r"larger than 0\.001 MB"):
            read_bytes(tmp_path / "file", "record file", 1000)
        assert len(read_bytes(tmp_path / "file", "record file", 1001)) == 1001


def device(folder, number):
    """A device that tests cannot do harm to: root could put a file in the place of the one of this machine."""
    if not Path("/dev/full").exists():
        pytest.skip("Linux has it")
    if os.geteuid() != 0:
        return Path({3: "/dev/null", 7: "/dev/full"}[number])
    path = folder / "device"
    try:
        os.mknod(path, stat.S_IFCHR | 0o666, os.makedev(1, number))
        path.open("wb").close()
    except OSError:
        pytest.skip("no devices can be made here")
    return path


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has neither there")
class TestSpecialFiles:
    def test_a_device_behind_a_link_is_written_to_and_stays(self, tmp_path):
        (tmp_path / "a.csv").symlink_to(device(tmp_path, 3))
        before = sorted(tmp_path.iterdir())
        write_whole(tmp_path / "a.csv", lambda file: file.write(b"1\n"))
        assert (tmp_path / "a.csv").is_char_device() and (tmp_path / "a.csv").is_symlink()
        assert sorted(tmp_path.iterdir()) == before

    def test_a_full_device_is_refused_by_the_system(self, tmp_path):
        (tmp_path / "a.csv").symlink_to(device(tmp_path, 7))
        with pytest.raises(Refused, match=r"a\.csv: cannot be written: No space left"):
            write_whole(tmp_path / "a.csv", lambda file: file.write(b"1\n"))

    def test_a_pipe_that_is_read_gets_what_is_written(self, tmp_path):
        pipe = tmp_path / "a.csv"
        os.mkfifo(pipe)
        reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
        write_whole(pipe, lambda file: (file.write(b"12345"), file.seek(0), file.write(b"0")))
        assert os.read(reader, 100) == b"02345" and pipe.is_fifo()
        os.close(reader)

    def test_a_pipe_that_nobody_reads_is_refused_at_once(self, tmp_path):
        os.mkfifo(tmp_path / "a.csv")
        with pytest.raises(InputError, match="no program is reading from this pipe"):
            write_whole(tmp_path / "a.csv", lambda file: file.write(b"1"))

    def test_a_link_that_leads_back_to_itself_is_refused(self, tmp_path):
        (tmp_path / "a.csv").symlink_to("b.csv")
        (tmp_path / "b.csv").symlink_to("a.csv")
        with pytest.raises(InputError, match="leads back to itself"):
            write_whole(tmp_path / "a.csv", lambda file: file.write(b"1"))
        assert (tmp_path / "a.csv").is_symlink()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="Linux has it")
def test_what_the_system_refused_is_said_whatever_the_library_makes_of_it(tmp_path, monkeypatch):
    full, really = os.open("/dev/full", os.O_WRONLY), os.open

    def on_a_full_disk(path, *how, **where):
        handle = really(path, *how, **where)
        if not Path(path).name.startswith(".a.csv."):
            return handle
        os.close(handle)
        return full

    monkeypatch.setattr(os, "open", on_a_full_disk)

    def library(file):
        try:
            file.write(bytes(100_000))
        except OSError:
            raise ValueError("inconsistent stream state") from None

    with pytest.raises(Refused, match=r"a\.csv: cannot be written: No space left"):
        write_whole(tmp_path / "a.csv", library)
    assert list(tmp_path.iterdir()) == []


def test_a_name_as_long_as_a_name_may_be(tmp_path):
    path = tmp_path / ("x" * 251 + ".csv")
    write_whole(path, lambda file: file.write(b"1"))
    assert path.read_bytes() == b"1"


LEFT = f".a.csv.0123456789abcdef{files.PART}"


def test_what_a_killed_run_left_goes_at_the_next_write_beside_it_and_nothing_else(tmp_path):
    others = [".a.csv.0123456789abcdef", f".a{files.PART}", f"a.csv.0123456789abcdef{files.PART}"]
    for each in (LEFT, *others):
        (tmp_path / each).touch()
    write_whole(tmp_path / "b.csv", lambda file: file.write(b"1"))
    assert sorted(each.name for each in tmp_path.iterdir()) == sorted([*others, "b.csv"])


def test_what_another_run_is_writing_stays(tmp_path):
    def write(file):
        (beside,) = tmp_path.iterdir()
        write_whole(tmp_path / "b.csv", lambda other: other.write(b"2"))
        assert beside.exists()
        file.write(b"1")

    write_whole(tmp_path / "a.csv", write)
    assert {each.name: each.read_bytes() for each in tmp_path.iterdir()} == {"a.csv": b"1", "b.csv": b"2"}


def test_content_is_on_the_disk_before_it_has_its_name_and_the_name_then(tmp_path, monkeypatch):
    done = []
    monkeypatch.setattr(
        os, "fsync", lambda handle: done.append("folder" if stat.S_ISDIR(os.fstat(handle).st_mode) else "file")
    )
    monkeypatch.setattr(os, "replace", lambda *names, replace=os.replace: (done.append("name"), replace(*names)))
    write_whole(tmp_path / "a.csv", lambda file: file.write(b"1"))
    assert done == ["file", "name", "folder"] or (sys.platform == "win32" and done == ["file", "name"])


class Killed(BaseException):
    """The end of a process, after which nothing is done any more."""


def killed(folder, number, monkeypatch):
    """Write two files into a folder, in a process that ends as it writes the one of a number."""

    def contents():
        yield "a.csv", b"new"
        if number:
            yield "in/b.csv", b"new"
        raise Killed

    with monkeypatch.context() as patch, pytest.raises(Killed):
        patch.setattr(files, "discard", lambda place: None)
        write_files(folder, contents())


@pytest.mark.parametrize("number", [0, 1])
def test_after_a_kill_the_files_of_a_folder_are_known_as_ours(tmp_path, number, monkeypatch):
    place = tmp_path / "new"
    killed(place, number, monkeypatch)
    assert (place / "a.csv").exists() and (place / "in" / "b.csv").exists() == bool(number)
    write_folder(place, {"a.csv": b"whole", "in/c.csv": b""})
    assert {each.relative_to(place).as_posix() for each in place.rglob("*")} == {"a.csv", "in", "in/c.csv"}


def test_what_was_changed_after_a_kill_stays(tmp_path, monkeypatch):
    killed(tmp_path, 1, monkeypatch)
    (tmp_path / "a.csv").write_bytes(b"mine")
    discard(tmp_path)
    assert {each.name: each.read_bytes() for each in tmp_path.iterdir()} == {"a.csv": b"mine"}


def test_while_a_folder_is_being_written_nobody_takes_its_files_away(tmp_path, monkeypatch):
    unlink = Path.unlink

    def at_the_end(path, **how):
        monkeypatch.undo()
        discard(tmp_path)
        unlink(path, **how)

    def contents():
        yield "a.csv", b"1"
        discard(tmp_path)
        assert (tmp_path / "a.csv").exists()
        yield "b.csv", b"2"
        monkeypatch.setattr(
            Path, "unlink", lambda path, **how: (at_the_end if path.name.endswith(LISTING) else unlink)(path, **how)
        )

    write_files(tmp_path, contents())
    assert sorted(each.name for each in tmp_path.iterdir()) == ["a.csv", "b.csv"]


def test_a_folder_that_may_not_be_entered_is_named(tmp_path, monkeypatch):
    def closed(path, *how, really=os.lstat, **where):
        if str(path).endswith("shut.csv"):
            raise PermissionError(13, "Permission denied", str(path))
        return really(path, *how, **where)

    monkeypatch.setattr(os, "lstat", closed)
    monkeypatch.setattr(Path, "lstat", lambda path: closed(path))
    with pytest.raises(InputError, match=r"shut\.csv: cannot be written: Permission denied"):
        check_writable(tmp_path / "shut.csv")

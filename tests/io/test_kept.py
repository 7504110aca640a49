"""Files that the program reads back are read like a stranger's: never a traceback, never another result."""

import shutil
from hashlib import sha256

import pytest

from rocking_cli.ask.ground_motions import files_of
from rocking_cli.errors import InputError, KeptWarning
from rocking_cli.io import files
from rocking_cli.questions.select import verb as select
from rocking_cli.questions.survey.pages import LIST_HEADER, SheetFolder
from rocking_cli.studies.engines import free as memory

OUTCOME = {"overturned": False, "peak": 0.25, "slip": None}
LIST = f"{sha256(b'x').hexdigest()}  a.csv\n{sha256(b'x').hexdigest()}  ../mine.csv\n\nodd\n"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder of the program, with a file of somebody else beside it."""
    monkeypatch.setattr(memory, "place", lambda: tmp_path / "own" / "blocks.sqlite")
    memory.remember([(f"key{k}", OUTCOME) for k in range(40)])
    (tmp_path / "mine.csv").write_bytes(b"x")
    (tmp_path / "own" / "a.csv").write_bytes(b"x")
    return tmp_path / "own"


def cache(file):
    """Use the memory of free blocks, which is always whole again afterwards."""
    keys = [f"key{k}" for k in range(40)]
    for _ in range(2):  # the first that finds it damaged removes it
        found = memory.recall(keys)
        assert all(repr(each) == repr({**OUTCOME, "slip": float("nan")}) for each in found.values())
        memory.remember([(key, OUTCOME) for key in keys if key not in found])
    assert file.is_dir() or len(memory.recall(keys)) == 40


def sheets(file):
    """Read which sheets an earlier survey wrote."""
    assert SheetFolder(file.parent, *[None] * 3)._listed() <= {"a.csv", file.name}


def earlier_set(file):
    """Read which records an earlier set has, and its records."""
    for read in (lambda: select.check_folder(file.parent, []), lambda: files_of(str(file.parent))):
        try:
            read()
        except InputError as error:
            assert str(file.parent) in str(error)


def killed_run(file):
    """Remove what a run that was killed had listed."""
    files.discard(file.parent)
    assert file.is_dir() or not file.exists()


KEPT = {
    "blocks.sqlite": (cache, None),
    "sheets.txt": (sheets, f"{LIST_HEADER}\n{LIST}"),
    "set.yaml": (
        earlier_set,
        f"{select.LIST_HEADER}\n#   a.csv\n#   ../mine.csv\nrecords:\n- {{file: a.csv, factor: 2.0}}\n",
    ),
    f".files.0123456789abcdef{files.LISTING}": (killed_run, LIST),
}


def damages(content):
    """A file as it was, and damaged in many ways; None for one that is a folder."""
    yield content
    for k in range(0, len(content), max(1, len(content) // 15)):
        yield content[:k] + bytes([content[k] ^ 0xFF]) + content[k + 1 :]
        yield content[:k] + bytes([content[k] ^ 1]) + content[k + 1 :]
        yield content[:k]
    yield b"\0\xff\xfe\x1b[31m" * 999
    yield None


@pytest.mark.filterwarnings("ignore::rocking_cli.errors.KeptWarning")
@pytest.mark.parametrize("name", KEPT)
def test_a_file_that_is_read_back(folder, name):
    use, text = KEPT[name]
    file = folder / name
    content = file.read_bytes() if text is None else text.encode()
    for damaged in damages(content):
        shutil.rmtree(file) if file.is_dir() else file.unlink(missing_ok=True)
        file.mkdir() if damaged is None else file.write_bytes(damaged)
        use(file)
        assert (folder.parent / "mine.csv").exists(), damaged
        (folder / "a.csv").write_bytes(b"x")


def test_a_row_of_the_cache_that_was_changed_is_said_and_made_anew(folder):
    known = memory.sqlite3.connect(memory.place())
    known.execute("UPDATE kept SET outcome = replace(outcome, '0.25', '0.5') WHERE key = 'key3'")
    known.execute("UPDATE kept SET outcome = (SELECT outcome FROM kept WHERE key = 'key1') WHERE key = 'key2'")
    known.commit()
    known.close()
    with pytest.warns(KeptWarning, match="simulated again: 2$"):
        assert {*memory.recall([f"key{k}" for k in range(5)])} == {"key0", "key1", "key4"}
    memory.remember([("key2", OUTCOME), ("key3", OUTCOME)])
    assert len(memory.recall(["key2", "key3"])) == 2

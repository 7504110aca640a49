"""Stores under attack: damaged in every way, and written by several processes at once.

The tests try some of it, `make soak` hundreds.
"""

import json
import random
import shutil
import sqlite3
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np
from click.testing import CliRunner

from rocking_cli.cli.main import main
from rocking_cli.questions.fragility.store import APPLICATION_ID, COLUMNS, Store
from tests.conftest import EXAMPLES

STUDY = f"""\
structures:
  - {EXAMPLES / "frame.yaml"}
  - file: {EXAMPLES / "block.yaml"}
    name: uncertain
    vary:
      width: {{normal: {{mean: 0.7, deviation: 0.05}}}}
records:
  - pulse: sine:0.6g:0.8s
  - pulse: ricker:0.6g:1.2s
levels: {{measure: PGA, least: 0.1, most: 1.2, count: LEVELS}}
polarity: both
samples: 4
method: stripes
limit_states: [uplift, overturning]
hazard: {{points: [[0.1, 0.01], [1, 0.0001]]}}
seed: SEED
"""
PAGE = 4096
OTHERS = ("not the store of a study", "another database")  # files that `--restart` leaves alone


def write(folder: Path, seed: int = 0, name: str = "study", levels: int = 12) -> Path:
    """A study in a file."""
    path = folder / f"{name}.yaml"
    path.write_text(STUDY.replace("SEED", str(seed)).replace("LEVELS", str(levels)), encoding="utf-8")
    return path


def command(*arguments: object, code: int | None = None) -> Any:
    """The outcome of a command in this process, which must have this exit code if one is given."""
    result = CliRunner().invoke(main, [str(each) for each in arguments])
    assert code in (None, result.exit_code), result.output
    return result


def shown(text: str) -> dict[str, Any]:
    """What `--json` prints, but where the store is."""
    return {key: value for key, value in json.loads(text).items() if key not in ("store", "given")}


def version_of(place: Path) -> int:
    """The version in the header of a store."""
    with closing(sqlite3.connect(place)) as connection:
        return int(connection.execute("PRAGMA user_version").fetchone()[0])


class Sound:
    """A study, its store, and the store of another study of the same shape."""

    def __init__(self, folder: Path) -> None:
        self.study, self.other = write(folder), write(folder, seed=1, name="other")
        for each in (self.study, self.other):
            assert command("fragility", each).exit_code == 0
        self.store = self.study.with_suffix(".db")
        self.shown = shown(command("results", self.store, "--json").stdout)


def _bytes(change: Callable[[bytearray, random.Random], None]) -> Callable[[Path, random.Random, Sound], str]:
    def damage(place: Path, rng: random.Random, sound: Sound) -> str:
        content = bytearray(place.read_bytes())
        change(content, rng)
        place.write_bytes(content)
        return change.__name__

    return damage


def flips(content: bytearray, rng: random.Random) -> None:
    for _ in range(rng.choice([1, 1, 1, 2, 8, 64])):
        content[rng.randrange(len(content))] ^= 1 << rng.randrange(8)


def headers(content: bytearray, rng: random.Random) -> None:
    """Of the file and of its pages, where a byte says most."""
    start = rng.choice([0, *range(0, len(content), PAGE)])
    content[start + rng.randrange(100 if start == 0 else 12)] = rng.randrange(256)


def pages(content: bytearray, rng: random.Random) -> None:
    start = PAGE * rng.randrange(len(content) // PAGE)
    content[start : start + PAGE] = bytes(PAGE)


def swapped(content: bytearray, rng: random.Random) -> None:
    one, other = (PAGE * k for k in rng.sample(range(1, len(content) // PAGE), 2))
    content[one : one + PAGE], content[other : other + PAGE] = (
        content[other : other + PAGE], content[one : one + PAGE],
    )  # fmt: skip


def copied(content: bytearray, rng: random.Random) -> None:
    one, other = (PAGE * k for k in rng.sample(range(1, len(content) // PAGE), 2))
    content[one : one + PAGE] = content[other : other + PAGE]


def cut(content: bytearray, rng: random.Random) -> None:
    del content[rng.choice([rng.randrange(len(content)), PAGE * rng.randrange(len(content) // PAGE)]) :]


# What somebody may do with another program; K is the number of a run, C a column, V a value.
RUNS = (
    "UPDATE run SET C = V WHERE id = K",
    "UPDATE run SET C = NULL WHERE id = K",
    "UPDATE run SET C = 'nonsense' WHERE id = K",
    "UPDATE run SET C = x'00ff' WHERE id = K",
    "UPDATE run SET C = C + 1 WHERE id % 7 = K % 7",
    "UPDATE run SET checksum = checksum + 1 WHERE id = K",
    "UPDATE run SET id = id + 1000000 WHERE id = K",
    "UPDATE run SET id = -id - 1 WHERE id = K",
    "DELETE FROM run WHERE id > K",
    "DELETE FROM run WHERE id = K + 1; UPDATE run SET id = K + 1 WHERE id = K",
    "ATTACH 'OTHER' AS other; INSERT OR REPLACE INTO run SELECT * FROM other.run; DETACH other",
    "ATTACH 'OTHER' AS other; INSERT OR REPLACE INTO sample SELECT * FROM other.sample; DETACH other",
    "ATTACH 'OTHER' AS other; INSERT OR REPLACE INTO study SELECT * FROM other.study; DETACH other",
    "UPDATE sample SET p = p * 1.01",
    "UPDATE sample SET drawn = '{' WHERE id = 2",
    "UPDATE level SET value = 'high'",
    "DELETE FROM level",
    "INSERT INTO level VALUES (12, 1.3)",
    "UPDATE study SET value = '3' WHERE key = 'hash'",
    "UPDATE study SET value = '[' WHERE key = 'definition'",
    "DELETE FROM study WHERE key = 'seal'",
    "DELETE FROM study",
    "DROP VIEW runs; DROP TABLE run",
    "DROP VIEW runs; DROP TABLE study",
    "DROP VIEW runs; ALTER TABLE run DROP COLUMN C",
    "DROP VIEW runs; ALTER TABLE run RENAME COLUMN peak_positive TO x; ALTER TABLE run RENAME COLUMN peak_negative TO"
    " peak_positive; ALTER TABLE run RENAME COLUMN x TO peak_negative",
    "DROP VIEW runs",
    "PRAGMA user_version = 1",
    "PRAGMA application_id = 0",
    "CREATE TABLE another (x); INSERT INTO another VALUES (1)",
    "PRAGMA journal_mode = wal; UPDATE run SET C = V WHERE id = K",
)  # fmt: skip


def sql(place: Path, rng: random.Random, sound: Sound, statement: str | None = None) -> str:
    statement = statement or rng.choice(RUNS)
    for name, value in (
        ("OTHER", str(sound.other.with_suffix(".db"))), ("K", str(rng.randrange(240))),
        ("C", rng.choice(COLUMNS[1:])), ("V", repr(rng.choice([0.0, 1.0, 0.37, -2.5, 1e300, 7]))),
    ):  # fmt: skip
        for before, after in ((" ", " "), (" ", ";"), ("(", ")"), (" ", ","), ("'", "'"), ("> ", "")):
            statement = f"{statement};".replace(f"{before}{name}{after}", f"{before}{value}{after}").removesuffix(";")
    with closing(sqlite3.connect(place, isolation_level=None)) as connection:
        try:
            connection.executescript(statement)
        except sqlite3.IntegrityError:  # SQLite itself refuses that: then like this
            connection.executescript("UPDATE run SET peak_positive = 0.123")
    return statement


def foreign(place: Path, rng: random.Random, sound: Sound) -> str:
    """Something else altogether."""
    kind = rng.randrange(6)
    place.unlink()
    if kind == 0:
        place.write_bytes(rng.randbytes(5000))
    elif kind == 1:
        place.write_bytes(b"SQLite format 3\0" + rng.randbytes(5000))
    elif kind == 2:
        place.write_bytes(b"")
    else:
        with closing(sqlite3.connect(place, isolation_level=None)) as connection:
            connection.executescript("CREATE TABLE run (id INTEGER PRIMARY KEY, x); INSERT INTO run VALUES (1, 2)")
            if kind > 3:
                connection.execute(f"PRAGMA application_id = {APPLICATION_ID}")
                connection.execute(f"PRAGMA user_version = {kind - 3}")
    return f"foreign {kind}"


def journal(place: Path, rng: random.Random, sound: Sound) -> str:
    """A journal beside it that was not written for it."""
    content = rng.randbytes(3 * PAGE)
    if rng.random() < 0.5:
        content = bytes.fromhex("d9d505f920a163d7") + content
    Path(f"{place}-journal").write_bytes(content)
    return "journal"


DAMAGES = (
    *map(_bytes, (flips, flips, headers, pages, swapped, copied, cut)),
    *(sql, sql, sql, sql, foreign, journal),
)  # fmt: skip


def attack(sound: Sound, folder: Path, number: int, statement: str | None = None) -> str:
    """Damage a copy of a store in one way, and see what becomes of it.

    Returns "sound" if nothing that counts was hit, "fewer" if runs are missing, or "refused".

    Raises
    ------
    AssertionError
        If a command ends with a traceback, gives other results without a word, or loses the file.
    """
    rng = random.Random(number)
    folder.mkdir()
    place = folder / "store.db"
    shutil.copyfile(sound.store, place)
    how = sql(place, rng, sound, statement) if statement else DAMAGES[number % len(DAMAGES)](place, rng, sound)
    content = place.read_bytes()
    told = f"{number}: {how}"

    looked = command("results", place, "--json")
    _no_traceback(looked, told)
    if looked.exit_code == 0:
        assert shown(looked.stdout) == sound.shown, f"{told}: other results without a word"
    elif looked.exit_code == 5:
        found = shown(looked.stdout)
        assert found["finished"] < found["runs"], told
    else:
        assert looked.exit_code in (1, 2) and looked.stderr and not looked.stdout, told

    run = command("fragility", sound.study, "--store", place, "--json")
    _no_traceback(run, told)
    assert not [*folder.glob("store.before*")], told
    if run.exit_code == 0:
        assert shown(run.stdout) == sound.shown, f"{told}: other results after it was run again"
        is_sound(place, sound.store, told)
        return "sound" if looked.exit_code == 0 else "fewer"
    restored = journal.__name__ in how or "wal" in how  # SQLite has put back what it took for interrupted
    assert run.exit_code in (1, 2) and run.stderr, told
    assert restored or place.read_bytes() == content, f"{told}: a file that was refused has changed"
    again = command("fragility", sound.study, "--store", place, "--restart", "--json")
    _no_traceback(again, told)
    if again.exit_code:
        assert any(each in again.stderr for each in OTHERS), f"{told}: {again.stderr}"
        assert restored or place.read_bytes() == content, told
        return "refused"
    assert shown(again.stdout) == sound.shown, told
    kept = [each.read_bytes() for each in folder.glob("store.before*.db")]
    assert len(kept) == 1 and (restored or kept == [content]), f"{told}: the damaged file was not kept"
    is_sound(place, sound.store, told)
    return "refused"


def _no_traceback(result: Any, told: str) -> None:
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise AssertionError(f"{told}: {result.exception!r}") from result.exception


def is_sound(place: Path, sound: Path, told: str) -> None:
    """Check that a store is not damaged and has the runs of another, all once."""
    with Store.reading(place) as one, Store.reading(sound) as other:
        size = one.plan().size
        mine, theirs = one.runs(0, size), other.runs(0, size)
    for name in mine.columns:
        assert np.array_equal(getattr(mine, name), getattr(theirs, name), equal_nan=True), (told, name)


WAITS = """
import sys, time
from pathlib import Path
import rocking_cli.cli.made, rocking_cli.questions.fragility.verb, rocking_cli.questions.fragility.results
import rocking_cli.questions.fragility.campaign
import rocking_cli.dynamics.kernels, rocking_cli.questions.fragility.view
from rocking_cli.cli.main import main
Path(sys.argv[1]).touch()
while not Path(sys.argv[2]).exists():
    time.sleep(0.001)
main(sys.argv[3:])
"""


def race(sound: Sound, folder: Path, *more: str) -> list[int]:
    """Three processes begin one study at the same moment; their exit codes.

    Raises
    ------
    AssertionError
        If no complete store is left, more than it is left, or a process does not say what it should.
    """
    folder.mkdir()
    place, go = folder / "store.db", folder / "go"
    if more:
        shutil.copyfile(sound.store, place)
    ready = [folder / f"ready{k}" for k in range(3)]
    processes = [
        subprocess.Popen(
            [sys.executable, "-c", WAITS, each, go, "fragility", sound.study, "--store", place, "--json", *more],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, encoding="utf-8",
        )
        for each in ready
    ]  # fmt: skip
    while not all(each.exists() for each in ready):
        assert all(each.poll() is None for each in processes), [each.communicate() for each in processes]
        time.sleep(0.01)
    go.touch()
    ended = [(*each.communicate(), each.returncode) for each in processes]
    for out, said, code in ended:
        assert "Traceback" not in said and code in (0, 2), said
        if code == 0:
            assert shown(out) == sound.shown
        else:
            assert "another process" in said and ("wait for it" in said or "run the same command again" in said), said
    codes = sorted(code for *_, code in ended)
    assert codes[0] == 0, ended
    is_sound(place, sound.store, "race")
    known = {"go", "ready0", "ready1", "ready2", "store.db"}
    left = {each.name for each in folder.iterdir()} - known
    assert len(left) == (codes.count(0) if more else 0), left
    assert all(name.startswith("store.before") and any(name in said for _, said, _ in ended) for name in left)
    return codes

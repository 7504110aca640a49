"""A study's runs in an SQLite file beside it: each finished run is there once, whatever stops the work."""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from time import monotonic
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking_cli.errors import InputError, Problem, RockingError
from rocking_cli.json_text import json_text
from rocking_cli.studies.fragility.engines import GOES_ON
from rocking_cli.studies.fragility.plan import Plan, Trial
from rocking_cli.studies.fragility.sources import Record

Reals = NDArray[np.float64]
Integers = NDArray[np.int64]

MARK = 0x526F636B  # "Rock", in the header of the file
VERSION = 1  # of the tables below
PATIENCE = 1.0  # s between transactions: what is finished in between is run again after a crash
READ = 100_000  # runs read at a time
WAITING = 60.0  # s for somebody who reads the store meanwhile
STANDS, FAILED = 0, 2  # outcomes; 1 and -1 for overturning in the positive and the negative direction

TABLES = """
CREATE TABLE study (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE sample (
    id INTEGER PRIMARY KEY, structure TEXT NOT NULL, number INTEGER NOT NULL, drawn TEXT NOT NULL, reason TEXT,
    p REAL, lambda_ REAL, gravity REAL, phi_cr_positive REAL, phi_cr_negative REAL
);
CREATE TABLE record (
    id INTEGER PRIMARY KEY, name TEXT NOT NULL, checksum TEXT NOT NULL, reason TEXT,
    dt REAL, npts INTEGER, pga REAL, pgv REAL, doubts INTEGER
);
CREATE TABLE eta (id INTEGER PRIMARY KEY, value REAL);
CREATE TABLE level (id INTEGER PRIMARY KEY, value REAL NOT NULL);
CREATE TABLE polarity (id INTEGER PRIMARY KEY, value INTEGER NOT NULL);
CREATE TABLE run (
    id INTEGER PRIMARY KEY, scale REAL NOT NULL, eta REAL, outcome INTEGER NOT NULL,
    peak_ratio REAL, peak_positive REAL, peak_negative REAL, uplift_time REAL, overturning_time REAL
);
"""
# Numbers of runs become words and values again for whoever opens the file with another program.
VIEW = """
CREATE VIEW runs AS SELECT
    run.id, sample.structure, sample.number AS sample, record.name AS record, level.value AS level,
    polarity.value AS polarity, run.eta, run.scale, run.scale * record.pga AS pga, run.scale * record.pgv AS pgv,
    CASE WHEN run.outcome = 2 THEN 'failed' WHEN run.outcome != 0 THEN 'overturns'
        WHEN run.uplift_time IS NULL THEN 'does not uplift' ELSE 'rocks' END AS outcome,
    CASE WHEN run.outcome IN (1, -1) THEN run.outcome ELSE 0 END AS fell_to,
    run.peak_ratio, run.peak_positive, run.peak_negative, run.uplift_time, run.overturning_time
FROM run
JOIN sample ON sample.id = run.id / {sample}
JOIN record ON record.id = run.id / {record} % {records}
JOIN level ON level.id = run.id / {level} % {levels}
JOIN polarity ON polarity.id = run.id % {polarities};
"""


HINTS = {
    sqlite3.SQLITE_FULL: f"make room: {GOES_ON}",
    sqlite3.SQLITE_IOERR: f"see to the disk: {GOES_ON}",
    sqlite3.SQLITE_BUSY: f"another program has kept it open for long: {GOES_ON}",
    sqlite3.SQLITE_CORRUPT: "restore a copy of it, or give --restart",
}


class StoreError(RockingError):
    """A store that the system does not let us write or read."""

    exit_code = 1


@dataclass(frozen=True, eq=False)
class Rows:
    """Finished runs, one a place, each an ndarray of one length.

    Parameters
    ----------
    id : ndarray of int
        Their numbers.
    scale : ndarray
        Factor on the record.
    eta : ndarray
        Restitution; NaN for the structure's own.
    outcome : ndarray of int
        `STANDS`, `FAILED`, or the sign of the direction to which it overturned.
    peak_ratio : ndarray
        Largest rotation over the critical one; NaN if it overturned.
    peak_positive, peak_negative : ndarray
        Largest rotation in either direction [rad]; NaN in that in which it overturned.
    uplift_time, overturning_time : ndarray
        When it first uplifted, and when it passed the critical rotation for good [s]; NaN if never.
    """

    id: Integers
    scale: Reals
    eta: Reals
    outcome: Integers
    peak_ratio: Reals
    peak_positive: Reals
    peak_negative: Reals
    uplift_time: Reals
    overturning_time: Reals

    def __len__(self) -> int:
        return len(self.id)

    @property
    def failed(self) -> int:
        """How many could not be followed."""
        return int((self.outcome == FAILED).sum())

    def select(self, which: NDArray[np.bool_]) -> Rows:
        """Some of them."""
        return Rows(*(getattr(self, name)[which] for name in COLUMNS))


COLUMNS = tuple(each.name for each in fields(Rows))


class Store:
    """The runs of one study in a file; `writing` and `reading` open it.

    Parameters
    ----------
    path : Path
        The file.
    connection : sqlite3.Connection
        To it.
    """

    def __init__(self, path: Path, connection: sqlite3.Connection) -> None:
        self.path = path
        self._connection = connection
        self._last = monotonic()

    @classmethod
    @contextmanager
    def writing(cls, path: Path) -> Iterator[Store]:
        """Open or create a store to add runs to; nobody else can write it meanwhile, everybody can read it.

        What is finished is kept also when an error ends the work.

        Raises
        ------
        InputError
            If the file is no store, or another process is at work on it.
        StoreError
            If the system refuses: a full disk.
        """
        unused = not path.exists()
        try:
            with _connected(path) as connection:
                _lock(path, connection)
                store = cls(path, connection)
                try:
                    yield store
                finally:
                    unused = unused and store.empty
                    if connection.in_transaction:  # not after a full disk, which has undone the last one
                        connection.execute("COMMIT")
        finally:
            if unused:  # the study was refused: leave nothing behind
                path.unlink(missing_ok=True)

    @classmethod
    @contextmanager
    def reading(cls, path: Path) -> Iterator[Store]:
        """Open a store to read. Raises `InputError` if it is none, `StoreError` if the system refuses."""
        if path.is_dir():
            raise InputError(Problem("this is a folder, not the store of a study", str(path)))
        if not path.exists():
            raise InputError(Problem("no such store", str(path), hint="`rocking fragility STUDY.yaml` makes one"))
        with _connected(path) as connection:
            connection.execute(f"PRAGMA busy_timeout = {int(1000 * WAITING)}")
            store = cls(path, connection)
            if store.empty:
                raise InputError(Problem("this is not the store of a study, or it is still empty", str(path)))
            yield store  # in short reads: a long one would keep a study that runs from adding to it

    @property
    def empty(self) -> bool:
        """Whether nothing has been written yet."""
        return not self._connection.execute("SELECT count(*) FROM sqlite_master").fetchone()[0]

    def begin(self, plan: Plan, facts: Mapping[str, Any]) -> None:
        """Write what a new store starts with.

        Parameters
        ----------
        plan : Plan
            The runs to come.
        facts : mapping
            Plain data to keep by name: `fact` gives them back.
        """
        for statement in TABLES.split(";"):
            self._connection.execute(statement)
        levels, polarities = plan.shape[3:]
        self._connection.execute(
            VIEW.format(
                sample=len(plan.records) * plan.block,
                record=plan.block,
                records=len(plan.records),
                level=polarities,
                levels=levels,
                polarities=polarities,
            )
        )
        self._connection.execute(f"PRAGMA application_id = {MARK}")
        self._connection.execute(f"PRAGMA user_version = {VERSION}")
        self._insert("sample", [_as_row(each) for each in plan.trials])
        self._insert("record", [tuple(asdict(each).values()) for each in plan.records])
        self._insert("eta", [(None if eta != eta else eta,) for eta in plan.etas])
        self._insert("level", [(each,) for each in plan.levels])
        self._insert("polarity", [(each,) for each in plan.polarities])
        self.note(facts)
        self.commit()

    def note(self, facts: Mapping[str, Any]) -> None:
        """Keep plain data by name, in place of what was there."""
        rows = [(key, json_text(value, sort_keys=True)) for key, value in facts.items()]
        self._connection.executemany("INSERT OR REPLACE INTO study VALUES (?, ?)", rows)

    def _insert(self, table: str, rows: Sequence[tuple[Any, ...]]) -> None:
        marks = ", ".join("?" * (len(rows[0]) + 1))
        numbered = ((k, *row) for k, row in enumerate(rows))
        self._connection.executemany(f"INSERT INTO {table} VALUES ({marks})", numbered)

    def fact(self, key: str) -> Any:
        """What was kept under a name."""
        found = self._connection.execute("SELECT value FROM study WHERE key = ?", (key,)).fetchone()
        return json.loads(found[0])

    def plan(self) -> Plan:
        """The runs that the store is for."""

        def column(table: str) -> list[Any]:
            return [row[0] for row in self._connection.execute(f"SELECT value FROM {table} ORDER BY id")]

        samples = self._connection.execute("SELECT * FROM sample ORDER BY id").fetchall()
        records = self._connection.execute("SELECT * FROM record ORDER BY id").fetchall()
        return Plan(
            [Trial(row[1], row[2], json.loads(row[3]), *row[4:]) for row in samples],
            [Record(*row[1:]) for row in records],
            [float("nan") if eta is None else eta for eta in column("eta")],
            self.fact("description")["levels"]["measure"],
            column("level"),
            column("polarity"),
        )

    def replace_record(self, k: int, record: Record) -> None:
        """Put right what is known of a record that could not be used so far."""
        columns = asdict(record)
        names = ", ".join(f"{name} = ?" for name in columns)
        self._connection.execute(f"UPDATE record SET {names} WHERE id = ?", (*columns.values(), k))

    def finished(self, first: int, stop: int) -> Integers:
        """The numbers of the finished runs from `first` to before `stop`, growing."""
        rows = self._connection.execute("SELECT id FROM run WHERE id >= ? AND id < ?", (first, stop))
        return np.fromiter((row[0] for row in rows), dtype=np.int64)

    def count(self) -> tuple[int, int]:
        """How many runs are finished, and how many of these failed."""
        found = self._connection.execute("SELECT count(*), count(*) FILTER (WHERE outcome = ?) FROM run", (FAILED,))
        done, failed = found.fetchone()
        return done, failed

    def add(self, rows: Rows) -> None:
        """Add finished runs; about every second what has been added is made safe."""
        columns = [getattr(rows, name).tolist() for name in COLUMNS]
        marks = ", ".join("?" * len(columns))
        self._connection.executemany(f"INSERT INTO run VALUES ({marks})", zip(*columns, strict=True))
        if monotonic() - self._last > PATIENCE:
            self.commit()

    def commit(self) -> None:
        """Make safe what has been added, and keep others from writing."""
        self._connection.execute("COMMIT")
        self._connection.execute("BEGIN IMMEDIATE")
        self._last = monotonic()

    def runs(self, first: int, stop: int) -> Rows:
        """The finished runs with numbers from `first` to before `stop`."""
        query = f"SELECT {', '.join(COLUMNS)} FROM run WHERE id >= ? AND id < ?"
        tables = []
        for start in range(first, stop, READ):  # as Python's numbers they take ten times the memory
            found = self._connection.execute(query, (start, min(start + READ, stop))).fetchall()
            tables.append(np.array(found, dtype=np.float64).reshape(-1, len(COLUMNS)))
        table = np.concatenate(tables) if tables else np.empty((0, len(COLUMNS)))
        columns: dict[str, Any] = dict(zip(COLUMNS, table.T, strict=True))
        return Rows(**{**columns, **{name: columns[name].astype(np.int64) for name in ("id", "outcome")}})


def _as_row(trial: Trial) -> tuple[Any, ...]:
    columns = {**asdict(trial), "drawn": json_text(trial.drawn, sort_keys=True)}
    return tuple(columns.values())


@contextmanager
def _connected(path: Path) -> Iterator[sqlite3.Connection]:
    """A connection to a store or an empty file; what the system refuses is said in words."""
    connection = None
    try:
        connection = sqlite3.connect(path, isolation_level=None)
        _check(path, connection)
        yield connection
    except sqlite3.DatabaseError as error:
        if getattr(error, "sqlite_errorcode", None) == sqlite3.SQLITE_NOTADB:
            raise InputError(Problem("this is not the store of a study", str(path))) from None
        hint = HINTS.get(getattr(error, "sqlite_errorcode", 0) & 0xFF)  # the rest says more than is needed here
        raise StoreError(str(Problem(f"the store cannot be used: {error}", str(path), hint=hint))) from error
    finally:
        if connection is not None:
            connection.close()


def _lock(path: Path, connection: sqlite3.Connection) -> None:
    """Begin a transaction that keeps others from writing."""
    try:
        connection.execute("PRAGMA busy_timeout = 0")
        connection.execute("BEGIN IMMEDIATE")
    except sqlite3.OperationalError as error:
        if error.sqlite_errorcode != sqlite3.SQLITE_BUSY:
            raise
        hint = "wait for it to end; `rocking results` shows what is there so far"
        raise InputError(Problem("another process is at work on this study", str(path), hint=hint)) from None
    connection.execute(f"PRAGMA busy_timeout = {int(1000 * WAITING)}")


def _check(path: Path, connection: sqlite3.Connection) -> None:
    """Refuse a database that is something else, or a store of a later version."""
    (mark,), (version,) = (
        connection.execute(f"PRAGMA {name}").fetchone() for name in ("application_id", "user_version")
    )
    filled = connection.execute("SELECT count(*) FROM sqlite_master").fetchone()[0]
    if filled and mark != MARK:
        raise InputError(Problem("this is another database, not the store of a study", str(path)))
    if version > VERSION:
        raise InputError(Problem("this store is of a later version of rocking", str(path), hint="upgrade rocking-cli"))

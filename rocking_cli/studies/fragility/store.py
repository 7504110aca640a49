"""The runs of a study in an SQLite file: each finished run is stored once, even if the work is interrupted.

Damage is found when a store is opened: every run has a checksum, and so has the description of the study.
"""

from __future__ import annotations

import hashlib
import json
import os
import sqlite3
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from time import monotonic
from typing import Any
from zlib import crc32

import numpy as np
from numpy.typing import NDArray
from pydantic import TypeAdapter, ValidationError

from rocking_cli.errors import InputError, Problem
from rocking_cli.io.json_text import json_text
from rocking_cli.studies.fragility.definition import SLIDING, Definition
from rocking_cli.studies.fragility.measured import Measured, Value
from rocking_cli.studies.fragility.plan import Plan, Trial
from rocking_cli.studies.fragility.sets import described
from rocking_cli.studies.fragility.sources import Record
from rocking_cli.studies.fragility.store_file import (
    AT_WORK,
    MARK,
    VERSION,
    damaged,
    exchange,
    header,
    in_words,
    is_beyond_reading,
    open_locked,
    open_store,
    sweep,
    tables,
    this_process,
)
from rocking_cli.studies.fragility.store_file import StoreError as StoreError

Reals = NDArray[np.float64]
Integers = NDArray[np.int64]

PATIENCE = 1.0  # s between transactions: what is finished in between is run again after a crash
READ = 100_000  # runs read at a time
STANDS, FAILED, UNKNOWN = 0, 2, 3  # outcomes; 1 and -1: overturns in the positive or the negative direction
OUTCOMES = (STANDS, FAILED, UNKNOWN, 1, -1)
SEAL = "seal"  # the name in the table `study` of the checksum of all but the runs
OF_MEASURES = ("unit", "value_error")  # problems of a definition with a measure or level that is unknown here
NAMED = 5  # damaged runs named one by one
SLIDE = "slide_time"  # the column of runs that only studies of sliding have

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
    peak_ratio REAL, peak_positive REAL, peak_negative REAL, uplift_time REAL, overturning_time REAL,
    known_to REAL, lower_bound REAL, opening REAL{columns}, checksum INTEGER NOT NULL
);
CREATE TABLE finished (runs INTEGER NOT NULL, checksum INTEGER NOT NULL);
-- What was measured, beyond the peaks of the records; the places that a value does not depend on are NULL.
CREATE TABLE measured (
    id INTEGER PRIMARY KEY, measure TEXT NOT NULL, sample INTEGER, record INTEGER, level INTEGER, value REAL
)
"""
PLAN = ("sample", "record", "eta", "level", "polarity")  # what a run is of
# Numbers of runs become words and values again for whoever opens the file with another program.
VIEW = """
CREATE VIEW runs AS SELECT
    run.id, sample.structure, sample.number AS sample, record.name AS record, level.value AS level,
    polarity.value AS polarity, run.eta, run.scale, run.scale * record.pga AS pga, run.scale * record.pgv AS pgv,
    CASE WHEN run.outcome = 2 THEN 'failed' WHEN run.outcome = 3 THEN 'unknown' WHEN run.outcome != 0 THEN 'overturns'
        WHEN run.uplift_time IS NULL THEN 'does not uplift' ELSE 'rocks' END AS outcome,
    CASE WHEN run.outcome IN (1, -1) THEN run.outcome ELSE 0 END AS fell_to,
    run.peak_ratio, run.peak_positive, run.peak_negative, run.uplift_time, run.overturning_time,
    run.known_to, run.lower_bound, run.opening{columns}
FROM run
JOIN sample ON sample.id = run.id / {sample}
JOIN record ON record.id = run.id / {record} % {records}
JOIN level ON level.id = run.id / {level} % {levels}
JOIN polarity ON polarity.id = run.id % {polarities};
"""

Say = Callable[[str], None]
"""Called with a sentence for the user, before that of which it speaks is done."""


@dataclass(frozen=True, eq=False)
class RunRows:
    """Finished runs; each field is an ndarray with one entry for each run.

    Parameters
    ----------
    id : ndarray of int
        Numbers of the runs.
    scale : ndarray
        Factor on the record.
    eta : ndarray
        Coefficient of restitution; NaN for the one of the structure.
    outcome : ndarray of int
        `STANDS`, `FAILED`, `UNKNOWN`, or the sign of the direction to which it overturned.
    peak_ratio : ndarray
        Peak rotation over the critical one; NaN if the run overturned. For a run of unknown outcome, this and all other
        fields cover the time until `known_to`.
    peak_positive, peak_negative : ndarray
        Peak rotation in either direction [rad]; NaN in the direction in which the run overturned.
    uplift_time, overturning_time : ndarray
        Time of the first uplift, and time of passing the critical rotation for good [s]; NaN if never.
    known_to : ndarray
        Time until which a run of unknown outcome is known [s]; NaN for the others.
    lower_bound : ndarray
        For runs of unknown outcome: peak rotation over the critical one until the first joint would fail; NaN for
        others.
    opening : ndarray
        Largest opening or slip of a joint over D_cr, as far as the run was simulated; NaN if the joints are not known.
    slide_time : ndarray, optional
        Time at which a joint first required more friction than available [s]; NaN if never. None if runs were not
        checked for sliding.
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
    known_to: Reals
    lower_bound: Reals
    opening: Reals
    slide_time: Reals | None = None

    def __len__(self) -> int:
        return len(self.id)

    @property
    def failed(self) -> int:
        """Number of runs that could not be simulated."""
        return int((self.outcome == FAILED).sum())

    def select(self, which: NDArray[np.bool_]) -> RunRows:
        """Return the runs that a mask selects."""
        return RunRows(**{name: getattr(self, name)[which] for name in self.columns})

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the fields that are not None."""
        return tuple(each.name for each in fields(self) if getattr(self, each.name) is not None)

    def checksums(self, salt: int) -> Integers:
        """Return the CRC-32 of each run, over its columns as little-endian doubles, starting from the study's salt."""
        columns = np.stack([getattr(self, name) for name in self.columns], axis=1).astype("<f8")
        columns = np.where(np.isnan(columns), np.nan, columns) + 0.0  # SQLite keeps neither NaNs nor zeros apart
        row = 8 * len(self.columns)
        data = memoryview(columns.tobytes())
        return np.array([crc32(data[k : k + row], salt) for k in range(0, len(data), row)], dtype=np.int64)


COLUMNS = tuple(each.name for each in fields(RunRows) if each.name != SLIDE)


@dataclass(frozen=True, eq=False)
class Endings:
    """The columns of finished runs that fragility needs, with one entry for each run.

    `peaks`, shape (n, 2), holds the peak rotations in the positive and the negative direction [rad]; `uplifts`,
    `slides` and `checked` tell whether a run uplifts, slides, and had its joints checked.
    """

    id: Integers
    outcome: Integers
    peak_ratio: Reals
    peaks: Reals
    uplifts: NDArray[np.bool_]
    slides: NDArray[np.bool_]
    lower_bound: Reals
    checked: NDArray[np.bool_]

    @property
    def overturned(self) -> NDArray[np.bool_]:
        """Whether each run is known to overturn."""
        return np.asarray(np.abs(self.outcome) == 1)

    @property
    def unknown(self) -> NDArray[np.bool_]:
        """Whether the outcome of each run is unknown."""
        return np.asarray(self.outcome == UNKNOWN)

    def select(self, which: NDArray[np.bool_]) -> Endings:
        """Return the runs that a mask selects."""
        return Endings(*(getattr(self, each.name)[which] for each in fields(self)))


class Store:
    """The file with the runs of one study; open it with `writing` or `reading`.

    Parameters
    ----------
    path : Path
        The file.
    connection : sqlite3.Connection
        Connection to the file; to an empty store in memory as long as there is no file.

    Attributes
    ----------
    damaged : list of int
        Numbers of the runs that do not agree with their checksums; they count as not finished.
    unreadable : bool
        Whether pages of the file are damaged, so that runs may be missing.
    missing : int
        Number of finished runs that the store counted and that cannot be found any more.
    columns : tuple of str
        Names of the columns of the runs.
    """

    def __init__(self, path: Path, connection: sqlite3.Connection) -> None:
        self.path = path
        self.damaged: list[int] = []
        self.unreadable = False
        self.missing = 0
        self.columns = COLUMNS
        self._connection = connection
        self._replaced: sqlite3.Connection | None = None  # the store whose place this one takes as it begins
        self._there = False
        self._say: Say = lambda text: None
        self._salt = 0
        self._finished = 0  # runs that are in the file
        self._more = False  # whether there are more than its count says
        self._last = monotonic()

    @classmethod
    @contextmanager
    def writing(cls, path: Path, *, anew: bool = False, say: Say = lambda text: None) -> Iterator[Store]:
        """Open a store to add runs, or make one; meanwhile no other process can write it, but all can read it.

        Finished runs are kept also when an error ends the work. The file is made when the study starts, and no file is
        deleted: one that is damaged, or not wanted any more, is renamed.

        Parameters
        ----------
        path : Path
            The file; a link is followed.
        anew : bool
            Leave the present runs aside: the store is empty, and replaces the old one when the study starts.
        say : callable, optional
            Called with messages on damage, and on the new name of an old file.

        Raises
        ------
        InputError
            If the file is not a store, is damaged beyond its runs, or is in use by another process.
        StoreError
            If the system refuses, for example because the disk is full.
        """
        path = Path(os.path.realpath(path))
        with in_words(path):
            store = cls(path, _nothing())
            store._say = say
            try:
                if path.exists():
                    store._lock_and_check(anew=anew)
                yield store
            finally:
                store._let_go()

    @classmethod
    @contextmanager
    def reading(cls, path: Path) -> Iterator[Store]:
        """Open a store to read. Raises `InputError` if the file is not a store, `StoreError` if the system refuses."""
        if path.is_dir():
            raise InputError(Problem("this is a folder, not the store of a study", str(path)))
        if not path.exists():
            raise InputError(Problem("no such store", str(path), hint="`rocking fragility STUDY.yaml` makes one"))
        with in_words(path):
            store = cls(path, open_store(path))
            try:
                if store.empty:
                    raise InputError(Problem("this is not the store of a study, or it is still empty", str(path)))
                store._check_plan()
                store._check_runs()
                yield store  # in short reads: a long one would keep a study that runs from adding to it
            finally:
                store._connection.close()

    @property
    def empty(self) -> bool:
        """Whether nothing has been written to the store yet."""
        return not tables(self._connection)

    def _lock_and_check(self, *, anew: bool) -> None:
        """Lock the existing store, and check that its runs can be relied upon."""
        self._there = True
        try:
            self._go_on_with(open_locked(self.path))
        except sqlite3.DatabaseError as error:
            if not (anew and is_beyond_reading(self.path, error)):
                raise
            self._replaced = _nothing()
            return
        sweep(self.path)
        if anew and header(self._connection)[0] == MARK:
            self._connection, self._replaced = _nothing(), self._connection
        elif not self.empty:
            self._check_plan()
            try:  # writing to damaged pages would make the damage worse
                self.unreadable = self._connection.execute("PRAGMA quick_check(1)").fetchone()[0] != "ok"
            except sqlite3.DatabaseError as error:
                self._unless_corrupt(error)
            self._check_runs()
            if self.doubts():
                self._rebuild()
            self._name_who_is_at_work()

    def _go_on_with(self, connection: sqlite3.Connection) -> None:
        """Close the present connection and use another one."""
        self._connection.close()
        self._connection = connection

    def _name_who_is_at_work(self) -> None:
        """Write the name of this process to the store, so that others can see who uses it."""
        self._connection.execute("INSERT OR REPLACE INTO study VALUES (?, ?)", (AT_WORK, this_process()))
        self.commit()

    def _let_go(self) -> None:
        """Commit the finished runs, and release the lock."""
        try:
            if self._connection.in_transaction:  # not after a full disk, which has undone the last one
                self._seal_count()
                self._connection.execute("COMMIT")
            with suppress(sqlite3.Error):  # it tells nobody anything any more
                self._connection.execute("PRAGMA busy_timeout = 0")
                self._connection.execute("DELETE FROM study WHERE key = ? AND value = ?", (AT_WORK, this_process()))
        finally:
            self._connection.close()
            if self._replaced is not None:
                self._replaced.close()

    def _rebuild(self) -> None:
        """Copy the undamaged runs to a new store that replaces this one."""
        plan, facts = self.plan(), self.facts()
        for each in self.doubts():
            self._say(f"{self.path}: {each}")
        old = Store(self.path, self._connection)
        old.columns, old._salt = self.columns, self._salt

        def fill(connection: sqlite3.Connection) -> None:
            new = Store(self.path, connection)
            new._fill(plan, facts)
            for rows in old._blocks(0, plan.size):
                new._insert_runs(rows)
            new._seal_count()

        self._connection = _nothing()
        self._go_on_with(exchange(self.path, old._connection, fill, self._say))
        self.damaged, self.unreadable, self.missing = [], False, 0
        self._check_plan()
        self._check_count()

    def doubts(self) -> list[str]:
        """Return sentences on what is wrong with the runs."""
        found = []
        if self.damaged:
            count, plan = len(self.damaged), self.plan()
            named = "; ".join(plan.name(k) for k in self.damaged[:NAMED]) + ("; ..." if count > NAMED else "")
            what = "1 run is damaged and left out" if count == 1 else f"{count} runs are damaged and left out"
            found.append(f"{what}: {named}")
        if self.unreadable:
            what = "1 finished run is" if self.missing == 1 else f"{self.missing} finished runs are"
            how_many = what if self.missing else "finished runs may be"
            found.append(f"parts of the file are damaged: {how_many} missing")
        return found

    def begin(self, plan: Plan, facts: Mapping[str, Any]) -> None:
        """Write the plan and the facts with which a new store starts.

        Parameters
        ----------
        plan : Plan
            The plan of the runs.
        facts : mapping
            Plain data by name, which `fact` returns.

        Raises
        ------
        InputError
            If another process has started the store meanwhile.
        """
        if self._replaced is not None:
            old, self._replaced = self._replaced, None
            fill: Callable[[sqlite3.Connection], None] = lambda new: Store(self.path, new)._fill(plan, facts)  # noqa: E731
            self._go_on_with(exchange(self.path, old, fill, self._say))
            self._check_plan()
        else:
            if not self._there:
                self._go_on_with(open_locked(self.path))
            if not self.empty:
                what = "another process has just started this study"
                raise InputError(Problem(what, str(self.path), hint="run the same command again to continue"))
            self._fill(plan, facts)
        self._name_who_is_at_work()

    def _fill(self, plan: Plan, facts: Mapping[str, Any]) -> None:
        self.columns = _columns(facts["description"])
        slides = SLIDE in self.columns
        for statement in TABLES.format(columns=f", {SLIDE} REAL" if slides else "").split(";\n"):
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
                columns=f", run.{SLIDE}" if slides else "",
            )
        )
        self._connection.execute(f"PRAGMA application_id = {MARK}")
        self._connection.execute(f"PRAGMA user_version = {VERSION}")
        trials = ({**asdict(trial), "drawn": json_text(trial.drawn, sort_keys=True)} for trial in plan.trials)
        self._insert("sample", [tuple(trial.values()) for trial in trials])
        self._insert("record", [tuple(asdict(each).values()) for each in plan.records])
        self._insert("eta", [(None if eta != eta else eta,) for eta in plan.etas])
        self._insert("level", [(each,) for each in plan.levels])
        self._insert("polarity", [(each,) for each in plan.polarities])
        self.note(facts)
        self.keep(plan.measured)
        self._salt = _salt(self.fact("hash"))
        self._connection.execute("INSERT INTO finished VALUES (0, ?)", (self._of_count(0),))

    def keep(self, measured: Measured) -> None:
        """Store measured values, replacing those in the store."""
        if not measured:
            return
        self._connection.execute("DELETE FROM measured")
        self._connection.executemany(
            "INSERT INTO measured (measure, sample, record, level, value) VALUES (?, ?, ?, ?, ?)", measured.values()
        )
        self._seal()

    def _of_count(self, runs: int) -> int:
        """Return the checksum of a number of finished runs."""
        return crc32(str(runs).encode(), self._salt)

    def _seal_count(self) -> None:
        """Store the number of finished runs, so that runs lost with a damaged page can be missed."""
        if self._more:
            sealed = self._finished, self._of_count(self._finished)
            self._connection.execute("UPDATE finished SET runs = ?, checksum = ?", sealed)
        self._more = False

    def _check_count(self) -> None:
        """Find out whether the store has fewer runs than it counted."""
        try:
            sealed = self._connection.execute("SELECT * FROM finished").fetchall()
            # Afterwards, as somebody may be at work.
            self._finished = self._connection.execute("SELECT count(*) FROM run").fetchone()[0]
        except sqlite3.DatabaseError as error:
            self._unless_corrupt(error)
            return
        for runs, checksum in sealed:
            self.unreadable |= checksum != self._of_count(runs) or self._finished < runs
            self.missing = max(runs - self._finished, 0) if checksum == self._of_count(runs) else 0

    def note(self, facts: Mapping[str, Any]) -> None:
        """Store plain data by name, replacing those in the store."""
        rows = [(key, json_text(value, sort_keys=True)) for key, value in facts.items()]
        self._connection.executemany("INSERT OR REPLACE INTO study VALUES (?, ?)", rows)
        self._seal()

    def _seal(self) -> None:
        """Renew the checksum of everything in the store except the runs."""
        self._connection.execute("INSERT OR REPLACE INTO study VALUES (?, ?)", (SEAL, self._digest()))

    def _digest(self) -> str:
        """Return the SHA-256 of everything in the store except the runs."""
        found = hashlib.sha256()
        queries = [f"SELECT * FROM {table} ORDER BY id" for table in PLAN]
        for query in (*queries, f"SELECT * FROM study WHERE key NOT IN ('{SEAL}', '{AT_WORK}') ORDER BY key"):
            found.update(repr(self._connection.execute(query).fetchall()).encode())
        for row in self._connection.execute("SELECT * FROM measured ORDER BY id"):  # there may be millions
            found.update(repr(row).encode())
        return found.hexdigest()

    def facts(self) -> dict[str, Any]:
        """Return all plain data in the store, by name."""
        rows = self._connection.execute("SELECT key, value FROM study WHERE key NOT IN (?, ?)", (SEAL, AT_WORK))
        return {key: json.loads(value) for key, value in rows}

    def _check_plan(self) -> None:
        """Raise an error if the description of the study in the store is damaged, or of another version."""
        if not (alone := self._connection.in_transaction):
            self._connection.execute("BEGIN")  # at one moment: somebody may be at work
        try:
            if header(self._connection)[1] < VERSION:
                what = "this store is of an earlier version of rocking, and cannot be read"
                hint = "run the study again with `restart`, which keeps this file under another name"
                raise InputError(Problem(what, str(self.path), hint=hint))
            names = {row[1] for row in self._connection.execute("PRAGMA table_info(run)")}
            if not names.issuperset((*COLUMNS, "checksum")):
                raise damaged(self.path, "its tables are not those of a store")
            found = self._connection.execute("SELECT value FROM study WHERE key = ?", (SEAL,)).fetchone()
            if found is None or found[0] != self._digest():
                raise damaged(self.path, "the description of the study does not match its checksum")
            try:
                self._salt = _salt(self.facts()["hash"])
                self.columns = _columns(self.fact("description"))
                self._check_definition()
                plan = self.plan()
            except (ValueError, TypeError, KeyError, IndexError, AttributeError, RecursionError) as error:
                raise damaged(self.path, "the description of the study cannot be read") from error
            if not names.issuperset(self.columns):
                raise damaged(self.path, "its tables are not those of a store")
            if not plan.size:
                raise damaged(self.path, "the description of the study is missing from it")
        finally:
            if not alone and self._connection.in_transaction:
                self._connection.execute("COMMIT")

    def _check_definition(self) -> None:
        """Raise an error if the definition of the study is invalid; measures not installed any more are no damage."""
        try:
            Definition.model_validate(self.fact("definition"))
        except ValidationError as error:
            if any(each["type"] not in OF_MEASURES for each in error.errors(include_url=False)):
                raise

    def _check_runs(self) -> None:
        """Find the runs that do not agree with their checksums, and those that are counted but missing."""
        self._check_count()
        size = self.plan().size
        strangers = self._connection.execute("SELECT id FROM run WHERE id < 0 OR id >= ?", (size,))
        try:
            self.damaged = [row[0] for row in strangers]
        except sqlite3.DatabaseError as error:
            self._unless_corrupt(error)
        found = len(self.damaged)
        for first in range(0, size, READ):
            rows, bad = self._read(first, min(first + READ, size))
            self.damaged += bad
            found += len(rows) + len(bad)
        if found < self._finished:  # a damaged number ends the search for those behind it
            self.unreadable, self.missing = True, self.missing + self._finished - found

    def _unless_corrupt(self, error: sqlite3.DatabaseError) -> None:
        """Note that pages are damaged if an error says so; raise any other error."""
        if getattr(error, "sqlite_errorcode", 0) & 0xFF != sqlite3.SQLITE_CORRUPT:
            raise error
        self.unreadable = True

    def _insert(self, table: str, rows: Sequence[tuple[Any, ...]]) -> None:
        marks = ", ".join("?" * (len(rows[0]) + 1))
        numbered = ((k, *row) for k, row in enumerate(rows))
        self._connection.executemany(f"INSERT INTO {table} VALUES ({marks})", numbered)

    def fact(self, key: str) -> Any:
        """Return the plain data stored under a name."""
        found = self._connection.execute("SELECT value FROM study WHERE key = ?", (key,)).fetchone()
        if found is None:
            raise damaged(self.path, f"{key} is missing")
        return json.loads(found[0])

    def plan(self) -> Plan:
        """Return the plan of the runs."""

        def column(table: str, of: Any) -> list[Any]:
            rows = self._connection.execute(f"SELECT value FROM {table} ORDER BY id")
            return TypeAdapter(list[of]).validate_python([row[0] for row in rows])

        def table(name: str, kind: Any) -> list[Any]:
            names = [each.name for each in fields(kind)]
            rows = self._connection.execute(f"SELECT {', '.join(names)} FROM {name} ORDER BY id")
            entries = [dict(zip(names, row, strict=True)) for row in rows]
            for entry in entries if kind is Trial else []:
                entry["drawn"] = json.loads(entry["drawn"])
            return TypeAdapter(list[kind]).validate_python(entries)

        trials, records, levels = table("sample", Trial), table("record", Record), column("level", float)
        measured = self._connection.execute("SELECT measure, sample, record, level, value FROM measured ORDER BY id")
        return Plan(
            trials,
            records,
            [float("nan") if eta is None else eta for eta in column("eta", float | None)],
            self.fact("description")["levels"]["measure"],
            levels,
            column("polarity", int),
            Measured.of((Value(*row) for row in measured), (len(trials), len(records), len(levels))),
            described(self.fact("description"), self.fact("weights")),
        )

    def replace_record(self, k: int, record: Record) -> None:
        """Replace what is stored of a record that could not be used so far."""
        columns = asdict(record)
        names = ", ".join(f"{name} = ?" for name in columns)
        self._connection.execute(f"UPDATE record SET {names} WHERE id = ?", (*columns.values(), k))
        self._seal()

    def finished(self, first: int, stop: int) -> Integers:
        """Return the numbers of the finished runs from `first` to before `stop`, increasing."""
        rows = self._connection.execute("SELECT id FROM run WHERE id >= ? AND id < ?", (first, stop))
        return np.fromiter((row[0] for row in rows), dtype=np.int64)

    def count(self) -> tuple[int, int]:
        """Return the number of finished runs, and of those that failed."""
        if self.damaged or self.unreadable:
            blocks = [(len(rows), rows.failed) for rows in self._blocks(0, self.plan().size)]
            return sum(done for done, _ in blocks), sum(failed for _, failed in blocks)
        found = self._connection.execute("SELECT count(*), count(*) FILTER (WHERE outcome = ?) FROM run", (FAILED,))
        done, failed = found.fetchone()
        return done, failed

    def add(self, rows: RunRows) -> None:
        """Add finished runs; about every second they are committed to the file."""
        self._insert_runs(rows)
        if monotonic() - self._last > PATIENCE:
            self.commit()

    def _insert_runs(self, rows: RunRows) -> None:
        columns = [*(getattr(rows, name).tolist() for name in self.columns), rows.checksums(self._salt).tolist()]
        marks = ", ".join("?" * len(columns))
        self._connection.executemany(f"INSERT INTO run VALUES ({marks})", zip(*columns, strict=True))
        self._finished += len(rows)
        self._more = self._more or len(rows) > 0

    def commit(self) -> None:
        """Commit the runs added, and keep the lock."""
        self._seal_count()
        self._connection.execute("COMMIT")
        self._connection.execute("BEGIN IMMEDIATE")
        self._last = monotonic()

    def runs(self, first: int, stop: int) -> RunRows:
        """Return the undamaged finished runs with numbers from `first` to before `stop`."""
        blocks = list(self._blocks(first, stop)) or [_rows([], self.columns)]
        return RunRows(**{name: np.concatenate([getattr(each, name) for each in blocks]) for name in self.columns})

    def endings(
        self, first: int, stop: int, counted: Callable[[int], None] = lambda numbers: None
    ) -> Iterator[Endings]:
        """Yield how the finished runs with numbers from `first` to before `stop` end, in blocks.

        Parameters
        ----------
        first, stop : int
            Numbers of runs.
        counted : callable, optional
            Called with the number of runs read since the last call.
        """
        names = "id", "outcome", "peak_ratio", "peak_positive", "peak_negative", "uplift_time", "lower_bound", "opening"
        slides = SLIDE in self.columns
        columns = (*names, SLIDE) if slides else names
        query = f"SELECT {', '.join(columns)} FROM run WHERE id >= ? AND id < ?"
        for start in range(first, stop, READ):
            end = min(start + READ, stop)
            if self.damaged or self.unreadable:
                rows = self._read(start, end)[0]
                table = np.stack([getattr(rows, name) for name in columns])
            else:  # all have been checked against their checksums
                found = self._connection.execute(query, (start, end)).fetchall()
                table = np.array(found, dtype=np.float64).reshape(-1, len(columns)).T
            number, outcome = table[:2].astype(np.int64)
            uplifts, checked = np.isfinite(table[5]), np.isfinite(table[7])
            slips = np.isfinite(table[8]) if slides else np.zeros(len(uplifts), dtype=bool)
            yield Endings(number, outcome, table[2], table[3:5].T, uplifts, slips, table[6], checked)
            counted(end - start)

    def _blocks(self, first: int, stop: int) -> Iterator[RunRows]:
        for start in range(first, stop, READ):  # as Python's numbers they take ten times the memory
            yield self._read(start, min(start + READ, stop))[0]

    def _read(self, first: int, stop: int) -> tuple[RunRows, list[int]]:
        """Return the undamaged runs with numbers from `first` to before `stop`, and the numbers of the damaged ones."""
        names = (*self.columns, "checksum")
        found = self._fetch(f"SELECT {', '.join(names)} FROM run WHERE id >= ? AND id < ?", first, stop)
        table, bad = _numbers(found, len(names))
        rows = _rows(table[:, : len(self.columns)], self.columns)
        sound = np.isin(table[:, COLUMNS.index("outcome")], OUTCOMES) & np.isfinite(rows.scale)
        # Where pages are damaged one may be met twice, or out of its place.
        sound &= (rows.id >= first) & (rows.id < stop) & (np.diff(rows.id, prepend=first - 1) > 0)
        sound &= rows.checksums(self._salt) == table[:, -1]
        return rows.select(sound), bad + rows.id[~sound].tolist()

    def _fetch(self, query: str, first: int, stop: int) -> list[tuple[Any, ...]]:
        """Return the rows between two numbers; of damaged pages, the rows that can be reached from either side."""
        try:
            return self._connection.execute(query, (first, stop)).fetchall()
        except sqlite3.DatabaseError as error:
            self._unless_corrupt(error)
        if stop - first == 1:
            return []
        middle = (first + stop) // 2
        return self._fetch(query, first, middle) + self._fetch(query, middle, stop)


def _nothing() -> sqlite3.Connection:
    """Open an empty store in memory."""
    return sqlite3.connect(":memory:", isolation_level=None)


def _columns(description: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the names of the columns of a study's runs."""
    return (*COLUMNS, SLIDE) if SLIDING in description else COLUMNS


def _rows(table: Any, names: tuple[str, ...]) -> RunRows:
    """Return runs from a table of numbers with a column for each name."""
    columns: dict[str, Any] = dict(zip(names, np.array(table, dtype=np.float64).reshape(-1, len(names)).T, strict=True))
    for name in ("id", "outcome"):  # what is no whole number is no number of a run, and no outcome
        columns[name] = np.where(np.abs(columns[name]) < 2.0**53, columns[name], -2).astype(np.int64)
    return RunRows(**columns)


def _numbers(found: Sequence[tuple[Any, ...]], columns: int) -> tuple[Reals, list[int]]:
    """Convert the rows of a query to numbers; also return the run numbers of rows that are not numeric."""
    try:
        return np.array(found, dtype=np.float64).reshape(-1, columns), []
    except (ValueError, TypeError):
        if len(found) == 1:
            return np.empty((0, columns)), [int(found[0][0])]
    middle = len(found) // 2
    one, other = (_numbers(part, columns) for part in (found[:middle], found[middle:]))
    return np.concatenate([one[0], other[0]]), one[1] + other[1]


def _salt(hash_: Any) -> int:
    """Return the start value of the checksums of a study's runs, so that runs of another study do not match."""
    return int(str(hash_)[:8], 16)

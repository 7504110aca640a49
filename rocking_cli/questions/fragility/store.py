"""The runs of a study in an SQLite file: each finished run is stored once, even if the work is interrupted.

Damage is found when a store is opened: every run has a checksum, and so has the description of the study. A damaged
store is refused. No file is ever deleted, and a file is made only when there is something to write.
"""

from __future__ import annotations

import hashlib
import json
import os
import platform
import sqlite3
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass, fields
from itertools import count, pairwise
from math import nan
from pathlib import Path
from time import monotonic
from typing import Any
from zlib import crc32

import numpy as np

from rocking_cli.arrays import Bools, Integers, Reals
from rocking_cli.errors import InputError, Problem, Refused
from rocking_cli.io.json_text import json_text
from rocking_cli.questions.fragility.definition import SLIDING
from rocking_cli.questions.fragility.plan import Measured, Plan, Trial, Value, described
from rocking_cli.questions.fragility.sources import Record
from rocking_cli.questions.fragility.workers import CONTINUE_HINT

COMMIT_INTERVAL = 1.0  # s between two commits; runs that are not committed are repeated after a crash
RUNS_PER_READ = 100_000
MAX_RUN_NUMBER = 2**63 - 1  # larger than the number of any run
STANDS, FAILED, UNKNOWN, OFF_EDGE = 0, 2, 3, 4  # outcomes; 1 and -1: overturns to a side; 4 and -4: off an edge
SEAL = "seal"  # key of the checksum of everything but the runs, in the table `study`
MAX_NAMED_RUNS = 5  # damaged runs that an error message names
SLIDE_COLUMN = "slide_time"  # only studies of sliding have this column
BLOCKS_COLUMN = "by_blocks"  # only studies that may simulate free blocks have this column

CREATE_TABLES = """
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
    known_to REAL, lower_bound REAL, opening REAL, slip REAL{columns}, checksum INTEGER NOT NULL
);
-- What was measured, beyond the peaks of the records; the places that a value does not depend on are NULL.
CREATE TABLE measured (
    id INTEGER PRIMARY KEY, measure TEXT NOT NULL, sample INTEGER, record INTEGER, level INTEGER, value REAL
)
"""
PLAN_COLUMNS = ("sample", "record", "eta", "level", "polarity")  # coordinates of a run in the plan
# A view with words and values, for users who open the file with another program.
CREATE_VIEW = """
CREATE VIEW runs AS SELECT
    run.id, sample.structure, sample.number AS sample, record.name AS record, level.value AS level,
    polarity.value AS polarity, run.eta, run.scale, run.scale * record.pga AS pga, run.scale * record.pgv AS pgv,
    CASE WHEN run.outcome = 2 THEN 'failed' WHEN run.outcome = 3 THEN 'unknown'
        WHEN run.outcome IN (4, -4) THEN 'falls off an edge' WHEN run.outcome != 0 THEN 'overturns'
        WHEN run.uplift_time IS NOT NULL THEN 'rocks' WHEN run.slip > 0 THEN 'does not overturn; slides'
        ELSE 'does not uplift' END AS outcome,
    CASE WHEN run.outcome IN (1, -1, 4, -4) THEN run.outcome / abs(run.outcome) ELSE 0 END AS fell_to,
    run.peak_ratio, run.peak_positive, run.peak_negative, run.uplift_time, run.overturning_time,
    run.known_to, run.lower_bound, run.opening, run.slip{columns}
FROM run
JOIN sample ON sample.id = run.id / {sample}
JOIN record ON record.id = run.id / {record} % {records}
JOIN level ON level.id = run.id / {level} % {levels}
JOIN polarity ON polarity.id = run.id % {polarities};
"""

Say = Callable[[str], None]
"""Called with a sentence for the user."""


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
        `STANDS`, `FAILED`, `UNKNOWN`, or the sign of the direction to which it overturned, times `OFF_EDGE` if off one.
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
    slip : ndarray
        Largest displacement of a body that slides and never rocks [m]; 0 for others.
    slide_time : ndarray, optional
        Time at which a joint first required more friction than available [s]; NaN if never. None if runs were not
        checked for sliding.
    by_blocks : ndarray, optional
        1 for runs that were simulated with free blocks, 0 for others. None if no run of the study can be.
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
    slip: Reals
    slide_time: Reals | None = None
    by_blocks: Reals | None = None

    def __len__(self) -> int:
        return len(self.id)

    @property
    def failed(self) -> int:
        """Number of runs that could not be simulated."""
        return int((self.outcome == FAILED).sum())

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the fields that are not None."""
        return tuple(each.name for each in fields(self) if getattr(self, each.name) is not None)

    def select(self, which: Bools) -> RunRows:
        """Return the runs that a mask selects."""
        return RunRows(**{name: getattr(self, name)[which] for name in self.columns})


COLUMNS = tuple(each.name for each in fields(RunRows) if each.name not in (SLIDE_COLUMN, BLOCKS_COLUMN))


@dataclass(frozen=True, eq=False)
class Endings:
    """The columns of finished runs that fragility needs, with one entry for each run.

    `peaks`, shape (n, 2), holds the peak rotations in the positive and the negative direction [rad]; `uplifts`,
    `slides`, `checked` and `by_blocks` tell whether a run uplifts, slides (by `slip` without uplift [m]), had its
    joints checked, and was simulated with free blocks, which move in every joint and so count as checked.
    """

    id: Integers
    outcome: Integers
    peak_ratio: Reals
    peaks: Reals
    uplifts: Bools
    slides: Bools
    lower_bound: Reals
    slip: Reals
    checked: Bools
    by_blocks: Bools

    @property
    def overturned(self) -> Bools:
        """Whether each run is known to overturn."""
        return np.asarray((np.abs(self.outcome) == 1) | self.off_edge)

    @property
    def off_edge(self) -> Bools:
        """Whether it overturns because a free block falls off an edge."""
        return np.asarray(np.abs(self.outcome) == OFF_EDGE)

    @property
    def unknown(self) -> Bools:
        """Whether the outcome of each run is unknown."""
        return np.asarray(self.outcome == UNKNOWN)

    def select(self, which: Bools) -> Endings:
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
    columns : tuple of str
        Names of the columns of the runs.
    """

    def __init__(self, path: Path, connection: sqlite3.Connection) -> None:
        self.path = path
        self.columns = COLUMNS
        self._connection = connection
        self._old: sqlite3.Connection | None = None  # the previous store, renamed when this one starts
        self._say: Say = lambda text: None
        self._salt = 0
        self._last = monotonic()

    @classmethod
    @contextmanager
    def writing(cls, path: Path, *, anew: bool = False, say: Say = lambda text: None) -> Iterator[Store]:
        """Open a store to add runs, or make one; meanwhile no other process can write it, but all can read it.

        Finished runs are kept also when an error ends the work. The file is made when the study starts, and no file is
        deleted: one that is not wanted any more is renamed.

        Parameters
        ----------
        path : Path
            The file; a link is followed.
        anew : bool
            Leave the present runs aside: the store is empty, and the old one is renamed when the study starts.
        say : callable, optional
            Called with the new name of an old file.

        Raises
        ------
        InputError
            If the file is not a store, is damaged, has another layout, or is in use by another process.
        StoreError
            If the system refuses, for example because the disk is full.
        """
        path = Path(os.path.realpath(path))
        with naming_store(path):
            store = cls(path, sqlite3.connect(":memory:", isolation_level=None))
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
        """Open a store to read.

        Raises
        ------
        InputError
            If the file is not a store, is damaged, or has another layout.
        StoreError
            If the system refuses.
        """
        if path.is_dir():
            raise InputError(Problem("this is a folder, not the store of a study", str(path)))
        if not path.exists():
            raise InputError(Problem("no such store", str(path), hint="`rocking fragility STUDY.yaml` makes one"))
        with naming_store(path):
            store = cls(path, open_store(path))
            try:
                if store.empty:
                    raise InputError(Problem("this is not the store of a study, or it is still empty", str(path)))
                store._check(to_write=False)
                yield store  # a long read would block a running study that adds to the store
            finally:
                store._connection.close()

    @property
    def empty(self) -> bool:
        """Whether nothing has been written to the store yet."""
        return not tables(self._connection)

    def _lock_and_check(self, *, anew: bool) -> None:
        """Lock the existing store, and check that its runs can be relied upon."""
        try:
            locked = open_locked(self.path)
        except sqlite3.DatabaseError as error:
            if not (anew and is_beyond_reading(self.path, error)):
                raise
            self._old = sqlite3.connect(":memory:")
            return
        if anew and tables(locked):
            self._old = locked
            return
        self._go_on_with(locked)
        if not self.empty:
            try:
                self._check(to_write=True)
            except BaseException:
                self._connection.rollback()  # damaged pages make a commit impossible
                raise
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
            if self._connection.in_transaction:  # a full disk has already rolled back the transaction
                self._connection.execute("COMMIT")
            with suppress(sqlite3.Error):  # nothing depends on this entry any more
                self._connection.execute("PRAGMA busy_timeout = 0")
                self._connection.execute("DELETE FROM study WHERE key = ? AND value = ?", (AT_WORK, this_process()))
        finally:
            self._connection.close()
            if self._old is not None:
                self._old.close()

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
        if self._old is not None:
            self._say(f"the store as it was is kept as {put_aside(self.path, self._old)}")
        if not self._connection.in_transaction:
            self._go_on_with(open_locked(self.path))
        if not self.empty:
            what = "another process has just started this study"
            raise InputError(Problem(what, str(self.path), hint="run the same command again to continue"))
        self._fill(plan, facts)
        self._name_who_is_at_work()

    def _fill(self, plan: Plan, facts: Mapping[str, Any]) -> None:
        self.columns = _columns(facts["description"])
        optional = self.columns[len(COLUMNS) :]
        for statement in CREATE_TABLES.format(columns="".join(f", {name} REAL" for name in optional)).split(";\n"):
            self._connection.execute(statement)
        levels, polarities = plan.shape[3:]
        self._connection.execute(
            CREATE_VIEW.format(
                sample=len(plan.records) * plan.block,
                record=plan.block,
                records=len(plan.records),
                level=polarities,
                levels=levels,
                polarities=polarities,
                columns="".join(f", run.{name}" for name in optional),
            )
        )
        self._connection.execute(f"PRAGMA application_id = {APPLICATION_ID}")
        self._connection.execute(f"PRAGMA user_version = {SCHEMA_VERSION}")
        trials = ({**asdict(trial), "drawn": json_text(trial.drawn, sort_keys=True)} for trial in plan.trials)
        self._insert("sample", [tuple(trial.values()) for trial in trials])
        self._insert("record", [tuple(asdict(each).values()) for each in plan.records])
        self._insert("eta", [(None if eta != eta else eta,) for eta in plan.etas])
        self._insert("level", [(each,) for each in plan.levels])
        self._insert("polarity", [(each,) for each in plan.polarities])
        self.note(facts)
        self.keep(plan.measured)
        self._salt = _salt(self.fact("hash"))

    def keep(self, measured: Measured) -> None:
        """Store measured values, replacing those in the store."""
        if not measured:
            return
        self._connection.execute("DELETE FROM measured")
        self._connection.executemany(
            "INSERT INTO measured (measure, sample, record, level, value) VALUES (?, ?, ?, ?, ?)", measured.values()
        )
        self._seal()

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
        digest = hashlib.sha256()
        queries = [f"SELECT * FROM {table} ORDER BY id" for table in PLAN_COLUMNS]
        for query in (*queries, f"SELECT * FROM study WHERE key NOT IN ('{SEAL}', '{AT_WORK}') ORDER BY key"):
            digest.update(repr(self._connection.execute(query).fetchall()).encode())
        # Row by row, as there may be millions.
        for row in self._connection.execute("SELECT * FROM measured ORDER BY id"):
            digest.update(repr(row).encode())
        return digest.hexdigest()

    def facts(self) -> dict[str, Any]:
        """Return all plain data in the store, by name."""
        rows = self._connection.execute("SELECT key, value FROM study WHERE key NOT IN (?, ?)", (SEAL, AT_WORK))
        return {key: json.loads(value) for key, value in rows}

    def _check(self, *, to_write: bool) -> None:
        """Raise an error if the store has another layout, or if its description, a run or a page is damaged.

        Runs that are missing are not finished: they are run again.
        """
        if not (alone := self._connection.in_transaction):
            self._connection.execute("BEGIN")  # a consistent snapshot, as another process may be writing
        layout = self._connection.execute("PRAGMA user_version").fetchone()[0]
        if layout != SCHEMA_VERSION:
            other = f"this store has the layout {layout}, and this version of rocking reads the layout "
            other += f"{SCHEMA_VERSION} only"
            raise InputError(Problem(other, str(self.path), hint=RESTART_HINT))
        seal = self._connection.execute("SELECT value FROM study WHERE key = ?", (SEAL,)).fetchone()
        if seal is None or seal[0] != self._digest():
            raise damaged(self.path, "the description of the study does not match its checksum")
        self._salt = _salt(self.fact("hash"))
        self.columns = _columns(self.fact("description"))
        plan = self.plan()
        if not alone:
            self._connection.execute("COMMIT")
        whole, bad, what = self._count_whole(plan.size)
        if bad:
            named = "; ".join(plan.name(k) for k in bad[:MAX_NAMED_RUNS]) + (
                "; ..." if len(bad) > MAX_NAMED_RUNS else ""
            )
            count = "1 run does not match its checksum" if len(bad) == 1 else f"{len(bad)} runs do not match theirs"
            what.append(f"{count}: {named}")
        if to_write and not what:  # writing to damaged pages would increase the damage
            verdict = self._connection.execute("PRAGMA quick_check(1)").fetchone()[0]
            what += [] if verdict == "ok" else [" ".join(verdict.split())]
        if what:
            raise damaged(self.path, f"{', '.join(what)}; {whole:,} of {plan.total:,} runs are whole")

    def _count_whole(self, size: int) -> tuple[int, list[int], list[str]]:
        """Compare the runs with their checksums.

        Returns
        -------
        whole : int
            Number of runs that match their checksums.
        damaged : list of int
            Numbers of the others.
        unreadable : list of str
            What SQLite says of the parts of the file that it cannot read.
        """
        whole, bad, unreadable = 0, [], []
        query = f"SELECT {', '.join((*self.columns, 'checksum'))} FROM run WHERE id >= ? AND id < ?"
        for first, stop in pairwise([-MAX_RUN_NUMBER, *range(RUNS_PER_READ, size, RUNS_PER_READ), MAX_RUN_NUMBER]):
            rows: list[tuple[Any, ...]] = []
            try:
                # Row by row, up to the first unreadable one.
                rows.extend(self._connection.execute(query, (first, stop)))
            except sqlite3.DatabaseError as error:
                if code_of(error) != sqlite3.SQLITE_CORRUPT:
                    raise
                unreadable = [str(error)]
            table = _numbers(rows, len(self.columns) + 1)
            # Damaged pages may give a run twice, or in the wrong place.
            sound = (np.diff(table[:, 0], prepend=-1.0) > 0) & (_checksums(table[:, :-1], self._salt) == table[:, -1])
            whole += int(sound.sum())
            bad += [row[0] for row, is_sound in zip(rows, sound.tolist(), strict=True) if not is_sound]
        return whole, bad, unreadable

    def _insert(self, table: str, rows: Sequence[tuple[Any, ...]]) -> None:
        marks = ", ".join("?" * (len(rows[0]) + 1))
        numbered = ((k, *row) for k, row in enumerate(rows))
        self._connection.executemany(f"INSERT INTO {table} VALUES ({marks})", numbered)

    def fact(self, key: str) -> Any:
        """Return the plain data stored under a name."""
        (value,) = self._connection.execute("SELECT value FROM study WHERE key = ?", (key,)).fetchone()
        return json.loads(value)

    def plan(self) -> Plan:
        """Return the plan of the runs."""

        def column(table: str) -> list[Any]:
            return [row[0] for row in self._connection.execute(f"SELECT value FROM {table} ORDER BY id")]

        def entries(table: str, kind: type) -> Iterator[dict[str, Any]]:
            names = [each.name for each in fields(kind)]
            for row in self._connection.execute(f"SELECT {', '.join(names)} FROM {table} ORDER BY id"):
                yield dict(zip(names, row, strict=True))

        trials = [Trial(**{**each, "drawn": json.loads(each["drawn"])}) for each in entries("sample", Trial)]
        records = [Record(**each) for each in entries("record", Record)]
        levels = column("level")
        measured = self._connection.execute("SELECT measure, sample, record, level, value FROM measured ORDER BY id")
        return Plan(
            trials,
            records,
            [nan if eta is None else eta for eta in column("eta")],
            self.fact("description")["levels"]["measure"],
            levels,
            column("polarity"),
            Measured.of((Value(*row) for row in measured), (len(trials), len(records), len(levels))),
            described(self.fact("description"), self.fact("weights")),
        )

    def replace_record(self, k: int, record: Record) -> None:
        """Replace what is stored about a record that could not be used so far."""
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
        counts = self._connection.execute("SELECT count(*), count(*) FILTER (WHERE outcome = ?) FROM run", (FAILED,))
        done, failed = counts.fetchone()
        return done, failed

    def add(self, rows: RunRows) -> None:
        """Add finished runs; about every second they are committed to the file."""
        table = np.stack([getattr(rows, name) for name in self.columns], axis=1)
        columns = [*(getattr(rows, name).tolist() for name in self.columns), _checksums(table, self._salt)]
        marks = ", ".join("?" * len(columns))
        self._connection.executemany(f"INSERT INTO run VALUES ({marks})", zip(*columns, strict=True))
        if monotonic() - self._last > COMMIT_INTERVAL:
            self.commit()

    def commit(self) -> None:
        """Commit the runs added, and keep the lock."""
        self._connection.execute("COMMIT")
        self._connection.execute("BEGIN IMMEDIATE")
        self._last = monotonic()

    def runs(self, first: int, stop: int) -> RunRows:
        """Return the finished runs with numbers from `first` to before `stop`."""
        columns = dict(zip(self.columns, self._table(self.columns, first, stop), strict=True))
        whole = {name: columns[name].astype(np.int64) for name in ("id", "outcome")}
        return RunRows(**{**columns, **whole})

    def _table(self, names: Sequence[str], first: int, stop: int) -> Reals:
        """Return some columns of the runs between two numbers, shape (columns, runs)."""
        query = f"SELECT {', '.join(names)} FROM run WHERE id >= ? AND id < ?"
        blocks = [np.empty((0, len(names)))]
        # In parts, as Python numbers take ten times the memory of an array.
        for start in range(first, stop, RUNS_PER_READ):
            rows = self._connection.execute(query, (start, min(start + RUNS_PER_READ, stop))).fetchall()
            blocks.append(np.array(rows, dtype=np.float64).reshape(-1, len(names)))
        return np.concatenate(blocks).T

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
        names = (*COLUMNS[:1], *COLUMNS[3:8], "lower_bound", "opening", "slip")
        optional = self.columns[len(COLUMNS) :]
        for start in range(first, stop, RUNS_PER_READ):
            end = min(start + RUNS_PER_READ, stop)
            table = self._table((*names, *optional), start, end)
            number, outcome = table[:2].astype(np.int64)
            uplifts, checked, never = np.isfinite(table[5]), np.isfinite(table[7]), np.zeros(table.shape[1], dtype=bool)
            slides = np.isfinite(table[9]) if SLIDE_COLUMN in optional else never
            by_blocks = table[9] == 1 if BLOCKS_COLUMN in optional else never
            yield Endings(
                number, outcome, table[2], table[3:5].T, uplifts, slides, table[6], table[8], checked | by_blocks,
                by_blocks,
            )  # fmt: skip
            counted(end - start)


def _columns(description: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the names of the columns of a study's runs."""
    # No study has both, as sliding is not a limit state of free blocks.
    optional = {SLIDING: SLIDE_COLUMN, "engine": BLOCKS_COLUMN}
    return *COLUMNS, *(column for key, column in optional.items() if key in description)


def _numbers(found: Sequence[tuple[Any, ...]], columns: int) -> Reals:
    """Convert the rows of a query to numbers; what is not a number becomes -infinity, which no run has."""
    try:
        return np.array(found, dtype=np.float64).reshape(-1, columns)
    except (ValueError, TypeError):
        return np.array(
            [[-np.inf if isinstance(each, str | bytes) else each for each in row] for row in found], dtype=np.float64
        )


def _checksums(table: Reals, salt: int) -> list[int]:
    """Return the CRC-32 of each row, as little-endian doubles, starting from the salt of the study."""
    # SQLite distinguishes neither kinds of NaN nor signs of zero.
    table = (np.where(np.isnan(table), np.nan, table) + 0.0).astype("<f8")
    row = 8 * table.shape[1]
    data = memoryview(table.tobytes())
    return [crc32(data[k : k + row], salt) for k in range(0, len(data), row)]


def _salt(hash_: Any) -> int:
    """Return the start value of the checksums of a study's runs, so that runs of another study do not match."""
    return int(str(hash_)[:8], 16)


APPLICATION_ID = 0x526F636B  # "Rock", in the header of the file
SCHEMA_VERSION = 8
LOCK_TIMEOUT = 60.0  # s, while another process reads the store
AT_WORK = "at work"  # key of the process that adds runs, in the table `study`

RESTART_HINT = "run the study again with `restart`, which keeps this file under another name"
HINTS = {
    sqlite3.SQLITE_FULL: f"make room: {CONTINUE_HINT}",
    sqlite3.SQLITE_IOERR: f"see to the disk: {CONTINUE_HINT}",
    sqlite3.SQLITE_BUSY: f"another program has kept it open for long: {CONTINUE_HINT}",
    sqlite3.SQLITE_READONLY: f"see to its rights, and whether somebody has moved it: {CONTINUE_HINT}",
}

# Errors of SQLite for a damaged header or missing pages.
BEYOND_READING = (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB, sqlite3.SQLITE_ERROR, sqlite3.SQLITE_READONLY)


class StoreError(Refused):
    """A store that the system does not allow to be written or read."""


def damaged(path: Path, what: str) -> InputError:
    """Return the error for a damaged store."""
    return InputError(
        Problem(f"the store is damaged: {what}", str(path), hint=f"restore a copy of it, or {RESTART_HINT}")
    )


def code_of(error: sqlite3.Error) -> int:
    """Return the primary result code of SQLite; 0 if an error has none."""
    return getattr(error, "sqlite_errorcode", 0) & 0xFF


@contextmanager
def naming_store(path: Path) -> Iterator[None]:
    """Turn errors of SQLite and of the system into errors that name the store."""
    try:
        yield
    except sqlite3.Error as error:
        # Another process has restarted the study.
        if getattr(error, "sqlite_errorcode", 0) == sqlite3.SQLITE_READONLY_DBMOVED:
            what = "another process has moved this store: it has just started the study from scratch"
            raise InputError(Problem(what, str(path), hint="run the same command again to continue")) from None
        if code_of(error) == sqlite3.SQLITE_NOTADB:
            raise InputError(Problem("this is not the store of a study", str(path))) from None
        # SQLITE_ERROR: a table or column is missing.
        if code_of(error) in (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_ERROR):
            raise damaged(path, str(error)) from error
        problem = Problem(f"the store cannot be used: {error}", str(path), hint=HINTS.get(code_of(error)))
        raise StoreError(str(problem)) from error
    except UnicodeDecodeError as error:  # raised by `sqlite3` for a damaged name of a column
        raise damaged(path, "its tables are not those of a store") from error


def open_store(path: Path) -> sqlite3.Connection:
    """Open a file that is the store of a study, or empty, and return the connection."""
    if path.exists() and not path.is_file():
        what = "a folder" if path.is_dir() else "a device or a pipe"
        raise InputError(Problem(f"this is {what}, not the store of a study", str(path)))
    connection = sqlite3.connect(path, isolation_level=None)
    try:
        connection.text_factory = lambda text: text.decode(errors="replace")  # checksums detect the damage
        connection.execute(f"PRAGMA busy_timeout = {int(1000 * LOCK_TIMEOUT)}")
        # Tables are read before the application id, as another process may write both in between.
        if tables(connection) and connection.execute("PRAGMA application_id").fetchone()[0] != APPLICATION_ID:
            raise InputError(Problem("this is another database, not the store of a study", str(path)))
    except BaseException:
        connection.close()
        raise
    return connection


def tables(connection: sqlite3.Connection) -> int:
    """Return the number of tables, views and indices of a database."""
    return int(connection.execute("SELECT count(*) FROM sqlite_master").fetchone()[0])


def is_beyond_reading(path: Path, error: sqlite3.DatabaseError) -> bool:
    """Return whether an error means that a file, which begins like a store, cannot even be locked."""
    with path.open("rb") as file:
        start = file.read(100)
    is_store = start.startswith(b"SQLite format 3\0") and start[68:72] == APPLICATION_ID.to_bytes(4, "big")
    return is_store and code_of(error) in BEYOND_READING


def open_locked(path: Path) -> sqlite3.Connection:
    """Open a store, making it if missing, in a transaction that keeps others from writing; return the connection.

    Whoever puts a store aside lets go of it only afterwards: the file of the connection may have another name by now.
    Then the one that has taken its place is opened.
    """
    while True:
        before = _identity(path)
        connection = _locked(path)
        if before is not None and before == _identity(path):
            return connection
        connection.close()


def _identity(path: Path) -> tuple[int, int] | None:
    """Return numbers that identify a file, and no file that replaces it; None if there is no file."""
    try:
        status = path.stat()
    except FileNotFoundError:
        return None
    return status.st_dev, status.st_ino


def _locked(path: Path) -> sqlite3.Connection:
    """Return a connection to a file in a transaction that keeps others from writing."""
    connection = open_store(path)
    try:
        connection.execute("PRAGMA busy_timeout = 0")
        connection.execute("BEGIN IMMEDIATE")
        connection.execute(f"PRAGMA busy_timeout = {int(1000 * LOCK_TIMEOUT)}")
    except sqlite3.OperationalError as error:
        who = _at_work(connection)
        connection.close()
        if error.sqlite_errorcode != sqlite3.SQLITE_BUSY:
            raise
        hint = "wait for it to end; `rocking results` shows what is there so far"
        raise InputError(Problem(f"another process is at work on this study{who}", str(path), hint=hint)) from None
    except BaseException:
        connection.close()
        raise
    return connection


def this_process() -> str:
    """Return the name of this process and its machine, for messages of other processes."""
    return f"process {os.getpid()} on {platform.node() or 'this machine'}"


def _at_work(connection: sqlite3.Connection) -> str:
    """Return the name of the process that uses a store, if it can be read now; otherwise an empty text."""
    with suppress(sqlite3.Error):
        process = connection.execute("SELECT value FROM study WHERE key = ?", (AT_WORK,)).fetchone()
        return f": {process[0]}" if process is not None else ""
    return ""


def put_aside(path: Path, connection: sqlite3.Connection) -> Path:
    """Give a store an unused name, and let go of it.

    Parameters
    ----------
    path : Path
        Path of the store.
    connection : sqlite3.Connection
        Connection to the store, locked; it is closed.

    Returns
    -------
    Path
        Its new path: study.before.db, study.before-2.db, ...
    """
    names = (path.with_name(f"{path.stem}.before{f'-{k}' if k > 1 else ''}{path.suffix}") for k in count(1))
    # SQLite would apply a journal that is left to any new file of this name.
    ends = ("", "-journal", "-wal", "-shm")
    aside = next(name for name in names if not any(os.path.lexists(f"{name}{end}") for end in ends))
    if os.name == "nt":  # Windows cannot rename an open file
        connection.close()
    path.rename(aside)
    connection.close()
    # While the store is locked, no journal is needed; a stale one must not be applied to the new store.
    with suppress(FileNotFoundError):
        Path(f"{path}-journal").rename(f"{aside}-journal")
    return aside

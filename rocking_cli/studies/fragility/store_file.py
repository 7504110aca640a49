"""The SQLite file of a store: opening, locking, and putting it aside without losing runs.

No file is ever deleted, and a file is made only when there is something to write.
"""

from __future__ import annotations

import os
import platform
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from itertools import count
from pathlib import Path

from rocking_cli.errors import InputError, Problem, Refused
from rocking_cli.studies.fragility.workers import GOES_ON

MARK = 0x526F636B  # "Rock", in the header of the file
VERSION = 7  # of the tables of a store
WAITING = 60.0  # s for somebody who reads the store meanwhile
AT_WORK = "at work"  # the name in the table `study` under which the process is that adds runs

RESTART = "run the study again with `restart`, which keeps this file under another name"
HINTS = {
    sqlite3.SQLITE_FULL: f"make room: {GOES_ON}",
    sqlite3.SQLITE_IOERR: f"see to the disk: {GOES_ON}",
    sqlite3.SQLITE_BUSY: f"another program has kept it open for long: {GOES_ON}",
    sqlite3.SQLITE_READONLY: f"see to its rights, and whether somebody has moved it: {GOES_ON}",
}

# What SQLite says of a damaged header, or of pages that are not there.
BEYOND_READING = (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB, sqlite3.SQLITE_ERROR, sqlite3.SQLITE_READONLY)


class StoreError(Refused):
    """A store that the system does not allow to be written or read."""


def damaged(path: Path, what: str) -> InputError:
    """Return the error for a damaged store."""
    return InputError(Problem(f"the store is damaged: {what}", str(path), hint=f"restore a copy of it, or {RESTART}"))


def code_of(error: sqlite3.Error) -> int:
    """Return the primary result code of SQLite; 0 if an error has none."""
    return getattr(error, "sqlite_errorcode", 0) & 0xFF


@contextmanager
def in_words(path: Path) -> Iterator[None]:
    """Turn errors of SQLite and of the system into errors that name the store."""
    try:
        yield
    except sqlite3.Error as error:
        if getattr(error, "sqlite_errorcode", 0) == sqlite3.SQLITE_READONLY_DBMOVED:  # by a restart elsewhere
            what = "another process has moved this store: it has just started the study from scratch"
            raise InputError(Problem(what, str(path), hint="run the same command again to continue")) from None
        if code_of(error) == sqlite3.SQLITE_NOTADB:
            raise InputError(Problem("this is not the store of a study", str(path))) from None
        if code_of(error) in (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_ERROR):  # the latter: a table or column is missing
            raise damaged(path, str(error)) from error
        problem = Problem(f"the store cannot be used: {error}", str(path), hint=HINTS.get(code_of(error)))
        raise StoreError(str(problem)) from error
    except UnicodeDecodeError as error:  # of a name in its tables, which `sqlite3` reads itself
        raise damaged(path, "its tables are not those of a store") from error


def open_store(path: Path) -> sqlite3.Connection:
    """Open a file that is the store of a study, or empty, and return the connection."""
    if path.exists() and not path.is_file():
        what = "a folder" if path.is_dir() else "a device or a pipe"
        raise InputError(Problem(f"this is {what}, not the store of a study", str(path)))
    connection = sqlite3.connect(path, isolation_level=None)
    try:
        connection.text_factory = lambda text: text.decode(errors="replace")  # what is damaged is told by its checksum
        connection.execute(f"PRAGMA busy_timeout = {int(1000 * WAITING)}")
        # The tables before the mark: somebody may write both between two looks.
        if tables(connection) and connection.execute("PRAGMA application_id").fetchone()[0] != MARK:
            raise InputError(Problem("this is another database, not the store of a study", str(path)))
    except BaseException:
        connection.close()
        raise
    return connection


def tables(connection: sqlite3.Connection) -> int:
    """Return the number of tables, views and indices of a database."""
    return int(connection.execute("SELECT count(*) FROM sqlite_master").fetchone()[0])


def is_beyond_reading(path: Path, error: sqlite3.DatabaseError) -> bool:
    """Return whether an error means that a file, a store by its first bytes, cannot even be locked."""
    with path.open("rb") as file:
        start = file.read(100)
    is_store = start.startswith(b"SQLite format 3\0") and start[68:72] == MARK.to_bytes(4, "big")
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
    """Return what tells a file from any that replaces it; None if there is none."""
    try:
        found = path.stat()
    except FileNotFoundError:
        return None
    return found.st_dev, found.st_ino


def _locked(path: Path) -> sqlite3.Connection:
    """Return a connection to a file in a transaction that keeps others from writing."""
    connection = open_store(path)
    try:
        connection.execute("PRAGMA busy_timeout = 0")
        connection.execute("BEGIN IMMEDIATE")
        connection.execute(f"PRAGMA busy_timeout = {int(1000 * WAITING)}")
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
        found = connection.execute("SELECT value FROM study WHERE key = ?", (AT_WORK,)).fetchone()
        return f": {found[0]}" if found is not None else ""
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
    # A journal that waits for its database would be played into whatever takes this name.
    ends = ("", "-journal", "-wal", "-shm")
    aside = next(name for name in names if not any(os.path.lexists(f"{name}{end}") for end in ends))
    if os.name == "nt":  # where an open file cannot be renamed
        connection.close()
    path.rename(aside)
    connection.close()
    # Locked, a store has no journal that matters; one that is left must not meet the new store.
    with suppress(FileNotFoundError):
        Path(f"{path}-journal").rename(f"{aside}-journal")
    return aside

"""The SQLite file of a store: opening, locking, and replacing it without losing runs.

A store with runs is never deleted, and a file is made only when there is something to write: whoever deletes an empty
file may delete what another process fills at this moment.
"""

from __future__ import annotations

import glob
import os
import platform
import re
import sqlite3
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from itertools import count
from pathlib import Path

from rocking_cli.errors import InputError, Problem, Refused
from rocking_cli.studies.fragility.workers import GOES_ON

MARK = 0x526F636B  # "Rock", in the header of the file
VERSION = 6  # of the tables of a store
WAITING = 60.0  # s for somebody who reads the store meanwhile
AT_WORK = "at work"  # the name in the table `study` under which the process is that adds runs

RESTART = "restore a copy of it, or give `restart`: that keeps this file under another name"
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
    """Return the error for a store of which more than runs is damaged."""
    return InputError(Problem(f"the store is damaged: {what}", str(path), hint=RESTART))


@contextmanager
def in_words(path: Path) -> Iterator[None]:
    """Turn errors of SQLite and of the system into errors that name the store."""
    try:
        yield
    except sqlite3.Error as error:
        if getattr(error, "sqlite_errorcode", 0) == sqlite3.SQLITE_READONLY_DBMOVED:  # by a restart elsewhere
            what = "another process has moved this store: it has just started the study from scratch"
            raise InputError(Problem(what, str(path), hint="run the same command again to continue")) from None
        code = getattr(error, "sqlite_errorcode", 0) & 0xFF  # the rest says more than is needed here
        if code == sqlite3.SQLITE_NOTADB:
            raise InputError(Problem("this is not the store of a study", str(path))) from None
        if code in (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_ERROR):  # the latter of a table or column that is missing
            raise damaged(path, str(error)) from error
        problem = Problem(f"the store cannot be used: {error}", str(path), hint=HINTS.get(code))
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
        filled = tables(connection)  # before the mark: somebody may write both between two looks
        mark, version = header(connection)
        if filled and mark != MARK:
            raise InputError(Problem("this is another database, not the store of a study", str(path)))
        if version > VERSION:
            hint = "upgrade rocking-cli"
            raise InputError(Problem("this store is of a later version of rocking", str(path), hint=hint))
    except BaseException:
        connection.close()
        raise
    return connection


def header(connection: sqlite3.Connection) -> tuple[int, int]:
    """Return the application mark and the version in the header of a database."""
    mark, version = (
        connection.execute(f"PRAGMA {name}").fetchone()[0] for name in ("application_id", "user_version")
    )  # fmt: skip
    return mark, version


def tables(connection: sqlite3.Connection) -> int:
    """Return the number of tables, views and indices of a database."""
    return int(connection.execute("SELECT count(*) FROM sqlite_master").fetchone()[0])


def is_beyond_reading(path: Path, error: sqlite3.DatabaseError) -> bool:
    """Return whether an error means that a file, a store by its first bytes, cannot even be locked."""
    if getattr(error, "sqlite_errorcode", 0) & 0xFF not in BEYOND_READING:
        return False
    with path.open("rb") as file:
        start = file.read(100)
    return start.startswith(b"SQLite format 3\0") and start[68:72] == MARK.to_bytes(4, "big")


def open_locked(path: Path) -> sqlite3.Connection:
    """Open a store, making it if missing, in a transaction that keeps others from writing; return the connection.

    Whoever replaces a store lets go of the old file only afterwards: that of the connection may have another name by
    now. Then the one that has taken its place is opened.
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


def new_name(path: Path, word: str) -> Iterator[Path]:
    """Yield unused file names beside a file: study.before.db, study.before-2.db, ..."""
    for k in count(1):
        name = path.with_name(f"{path.stem}.{word}{f'-{k}' if k > 1 else ''}{path.suffix}")
        # A journal that waits for its database would be played into whatever takes this name.
        if not any(os.path.lexists(f"{name}{end}") for end in ("", "-journal", "-wal", "-shm")):
            yield name


def exchange(
    path: Path, old: sqlite3.Connection, fill: Callable[[sqlite3.Connection], None], say: Callable[[str], None]
) -> sqlite3.Connection:
    """Replace an old store by a new one, and keep the old one under an unused name.

    Parameters
    ----------
    path : Path
        Path of the store.
    old : sqlite3.Connection
        Connection to the old store, locked; it is closed.
    fill : callable
        Called with a connection to the new store, to write its first content.
    say : callable
        Called with a message on where the old store is, before it is replaced.

    Returns
    -------
    sqlite3.Connection
        Connection to the new store, locked.
    """
    locked = old.in_transaction
    fresh = _create(path)
    try:
        connection = sqlite3.connect(fresh, isolation_level=None)
        try:
            connection.execute("BEGIN IMMEDIATE")
            fill(connection)
            connection.execute("COMMIT")
        finally:
            connection.close()
        os.chmod(fresh, path.stat().st_mode & 0o777)  # noqa: PTH101
        worthless = locked and not _has_runs(old)
        if os.name == "nt":  # where an open file cannot be replaced
            old.close()
        if not worthless:
            aside = _keep(path)
            say(f"the store as it was is kept as {aside}{_others(aside)}")
        fresh.replace(path)
    except BaseException:
        for end in ("", "-journal"):
            Path(f"{fresh}{end}").unlink(missing_ok=True)
        raise
    finally:
        old.close()
    return open_locked(path)


def _has_runs(connection: sqlite3.Connection) -> bool:
    """Return whether a store has runs, has counted runs that are missing, or may have runs that cannot be read."""
    found = "SELECT 1 FROM run UNION ALL SELECT 1 FROM finished WHERE runs > 0 LIMIT 1"
    try:
        return not tables(connection) or connection.execute(found).fetchone() is not None
    except sqlite3.Error:
        return True


def sweep(path: Path) -> None:
    """Remove files without runs that a killed process left when it was replacing a store.

    Only the process that has locked the store may do this: nobody else is exchanging it.
    """
    for left in path.parent.glob(f"{glob.escape(path.stem)}.new*{glob.escape(path.suffix)}"):
        if not re.fullmatch(r"\.new(-\d+)?", left.stem.removeprefix(path.stem)) or left.is_symlink():
            continue
        with suppress(sqlite3.Error, OSError, InputError):
            if left.stat().st_size and _is_in_use_or_filled(left):
                continue
            for end in ("", "-journal"):
                Path(f"{left}{end}").unlink(missing_ok=True)


def _is_in_use_or_filled(place: Path) -> bool:
    """Return whether a store has runs. Raises `sqlite3.Error` if it is in use, `InputError` if it is not a store."""
    connection = open_store(place)
    try:
        connection.execute("PRAGMA busy_timeout = 0")
        connection.execute("BEGIN IMMEDIATE")
        return tables(connection) > 0 and _has_runs(connection)
    finally:
        connection.close()


def _others(aside: Path) -> str:
    """Return a note on how many older stores are kept beside this one; empty if there are none."""
    number = aside.stem.rpartition("-")[2]
    if not number.isdecimal():
        return ""
    earlier = "an earlier one is" if number == "2" else f"{int(number) - 1} earlier ones are"
    return f"; {earlier} kept beside it: remove what you do not need"


def _create(path: Path) -> Path:
    """Create a file with an unused name, for a new store."""
    for name in new_name(path, "new"):
        try:
            name.touch(exist_ok=False)
        except FileExistsError:
            continue
        return name
    raise AssertionError


def _keep(path: Path) -> Path:
    """Give a store a second name: while it also has the first, no other process can make a store there."""
    for name in new_name(path, "before"):
        try:
            os.link(path, name)
        except FileExistsError:
            continue
        except OSError:  # a file system without second names
            name.touch(exist_ok=False)
            path.replace(name)
        # Locked, a store has no journal that matters; one that is left must not meet the new store.
        with suppress(FileNotFoundError):
            Path(f"{path}-journal").replace(f"{name}-journal")
        return name
    raise AssertionError

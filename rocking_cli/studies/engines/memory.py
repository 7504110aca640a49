"""Histories of free blocks that were simulated before: a study that was interrupted goes on where it stopped.

The file is read as one of a stranger: a row is taken if its checksum, of key and outcome, is right.
"""

from __future__ import annotations

import json
import os
import sqlite3
from collections.abc import Callable, Iterable, Sequence
from contextlib import closing, suppress
from hashlib import sha256
from math import nan
from pathlib import Path
from typing import Any

from rocking_cli.errors import KeptWarning, warn
from rocking_cli.io.json_text import json_text

DAMAGED = (sqlite3.SQLITE_ERROR, sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB)
"""Errors of a file that has no such tables, or is no database; others, as of a locked file, may pass."""


def place() -> Path:
    """Return the file of the histories, in the user's cache."""
    import platformdirs

    return platformdirs.user_cache_path("rocking-cli", appauthor=False) / "blocks.sqlite"


def recall(keys: Sequence[str]) -> dict[str, Any]:
    """Return what is known of histories, by their keys; nothing if the file cannot be read."""
    outcomes: dict[str, Any] = {}
    if not os.path.isfile(place()):  # noqa: PTH113 - pathlib raises where a folder may not be entered
        return outcomes
    rows, bad = list[tuple[str, Any]](), 0

    def ask(known: sqlite3.Connection) -> None:
        (fault,) = known.execute("PRAGMA quick_check(1)").fetchone()
        if fault != "ok":
            raise sqlite3.DatabaseError(fault)
        for key in keys:
            rows.extend((key, kept) for (kept,) in known.execute("SELECT outcome FROM kept WHERE key = ?", (key,)))

    _opened(ask)
    for key, kept in rows:
        checksum, _, text = str(kept).partition(" ")
        if checksum == _checksum(key, text):
            outcomes[key] = {name: nan if value is None else value for name, value in json.loads(text).items()}
        else:
            bad += 1
    if bad:
        warn(KeptWarning(f"{place()}: rows that are damaged and are simulated again: {bad}"))
    return outcomes


def remember(outcomes: Iterable[tuple[str, Any]]) -> None:
    """Keep outcomes of histories by their keys; in vain if the file cannot be written."""
    texts = [(key, json_text(outcome)) for key, outcome in outcomes]
    rows = [(key, f"{_checksum(key, text)} {text}") for key, text in texts]
    _opened(lambda known: known.executemany("INSERT OR REPLACE INTO kept VALUES (?, ?)", rows))


def _checksum(key: str, text: str) -> str:
    return sha256(f"{key} {text}".encode(errors="replace")).hexdigest()


def _opened(use: Callable[[sqlite3.Connection], object]) -> None:
    """Use the file, as far as that is possible; one that is damaged is removed, so that the next call makes it anew."""
    try:
        place().parent.mkdir(parents=True, exist_ok=True)
        with closing(sqlite3.connect(place(), timeout=10.0)) as known, known:
            known.text_factory = lambda text: text.decode(errors="replace")
            known.execute("CREATE TABLE IF NOT EXISTS kept (key TEXT PRIMARY KEY, outcome TEXT) WITHOUT ROWID")
            use(known)
    except OSError:
        pass
    except (sqlite3.Error, UnicodeDecodeError) as error:  # the second by `sqlite3`, of a damaged name of a column
        if getattr(error, "sqlite_errorcode", sqlite3.SQLITE_CORRUPT) & 0xFF in DAMAGED:
            for ending in ("-journal", "-wal", "-shm", ""):
                with suppress(OSError):
                    Path(f"{place()}{ending}").unlink()
            warn(KeptWarning(f"{place()}: damaged, and made anew: {error}"))

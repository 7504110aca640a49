"""Histories of free blocks that were simulated before: a study that was interrupted goes on where it stopped."""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterable, Sequence
from contextlib import closing
from math import nan
from pathlib import Path
from typing import Any

from rocking_cli.io.json_text import json_text


def place() -> Path:
    """Return the file of the histories, in the user's cache."""
    import platformdirs

    return platformdirs.user_cache_path("rocking-cli", appauthor=False) / "blocks.sqlite"


def recall(keys: Sequence[str]) -> dict[str, Any]:
    """Return what is known of histories, by their keys; nothing if the file cannot be read."""
    if not place().exists():
        return {}
    try:
        with closing(_opened()) as known:
            outcomes = {}
            for key in keys:
                if row := known.execute("SELECT outcome FROM histories WHERE key = ?", (key,)).fetchone():
                    read = json.loads(row[0])
                    outcomes[key] = {name: nan if value is None else value for name, value in read.items()}
            return outcomes
    except sqlite3.Error:
        return {}


def remember(outcomes: Iterable[tuple[str, Any]]) -> None:
    """Keep outcomes of histories by their keys; in vain if the file cannot be written."""
    try:
        place().parent.mkdir(parents=True, exist_ok=True)
        with closing(_opened()) as known, known:
            rows = [(key, json_text(outcome)) for key, outcome in outcomes]
            known.executemany("INSERT OR REPLACE INTO histories VALUES (?, ?)", rows)
    except (OSError, sqlite3.Error):
        pass


def _opened() -> sqlite3.Connection:
    known = sqlite3.connect(place(), timeout=10.0)
    known.execute("CREATE TABLE IF NOT EXISTS histories (key TEXT PRIMARY KEY, outcome TEXT)")
    return known

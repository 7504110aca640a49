"""Studies whose process is killed at a random moment, and which are then run to their end.

The tests try a few, `make soak` dozens.
"""

import random
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

from tests.stores import WAITS, is_sound, shown, write

LEVELS = 500
RESTARTED = 3  # one in so many is started with `--restart`, on a store with all runs
EXCHANGING = 6  # one in so many of all is killed as it puts that store aside
PATIENCE = 120.0  # s


class Whole:
    """A study of about a second, its store, what is shown of it, and how long it took [s]."""

    def __init__(self, folder: Path, levels: int = LEVELS) -> None:
        self.study = write(folder, name="long", levels=levels)
        self.store = self.study.with_suffix(".db")
        process = _ready(folder, "fragility", self.study, "--json")
        began = time.perf_counter()
        (folder / "go").touch()
        out, said = process.communicate(timeout=PATIENCE)
        self.seconds = time.perf_counter() - began
        assert process.returncode == 0, said
        self.shown = shown(out)


def _ready(folder: Path, *arguments: object) -> subprocess.Popen[str]:
    """A process with everything imported, which waits for the file `go`."""
    ready = folder / "ready"
    process = subprocess.Popen(
        [sys.executable, "-c", WAITS, ready, folder / "go", *map(str, arguments)],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, encoding="utf-8",
    )  # fmt: skip
    while not ready.exists():
        assert process.poll() is None, process.communicate()
        time.sleep(0.005)
    return process


def kill(whole: Whole, folder: Path, number: int) -> str:
    """Kill a study, most at a random moment, and run it again to its end.

    Returns
    -------
    str
        How much of the study its store held when it was run again: "none", "some" or "all" of the runs; whether the
        process that was killed had to restart it.

    Raises
    ------
    AssertionError
        If the store has other runs than that of a study that was left alone, the runs from before a restart are lost,
        files are left that nobody needs, or a process ends with a traceback.
    """
    folder.mkdir()
    place, restart = folder / "store.db", number % RESTARTED == RESTARTED - 1
    if restart:
        shutil.copyfile(whole.store, place)
    before = place.stat().st_ino if restart else None
    arguments = ["fragility", whole.study, "--store", place, "--json"]
    process = _ready(folder, *arguments, *(["--restart"] if restart else []))
    (folder / "go").touch()
    if number % EXCHANGING == EXCHANGING - 1:
        while process.poll() is None and not any(folder.glob("store.before*")):
            time.sleep(0.0002)
    else:
        time.sleep(random.Random(number).uniform(0, whole.seconds))
    process.kill()  # on Windows `terminate` is the same
    said = process.communicate()[1]
    assert "Traceback" not in said, said
    kept = [*folder.glob("store.before*.db")]
    assert len(kept) <= 1, kept
    assert kept or not restart or place.stat().st_ino == before, "the runs from before the restart are lost"

    again = subprocess.run(
        [sys.executable, "-m", "rocking_cli", *map(str, arguments)],
        capture_output=True, text=True, encoding="utf-8", timeout=PATIENCE,
    )  # fmt: skip
    assert again.returncode == 0 and "Traceback" not in again.stderr, again.stderr
    assert shown(again.stdout) == whole.shown, "other results after a kill"
    for store in (place, *kept):
        is_sound(store, whole.store, f"kill {number}")
    left = {each.name for each in folder.iterdir()} - {"go", "ready", "store.db", *(each.name for each in kept)}
    assert not left, left
    had = re.search(r"(\d+) of (\d+) runs are in the store already", again.stderr)
    how_many = "none" if had is None else "all" if had[1] == had[2] else "some"
    return how_many + ", restarted" * restart

"""What takes too long for the tests: damaged stores, races, kills, and record readers. `make soak` runs all.

STORES, RACES, KILLS and READERS in the environment are how often: `READERS=20 make soak`.
"""

import os
import sys
import tempfile
import warnings
from collections import Counter
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

from tests import readers
from tests.stores import Sound, attack, kills, race

TIMES = {"STORES": 500, "RACES": 50, "KILLS": 40, "READERS": 3000}
AT_ONCE = 2  # processes that read records


def soak() -> int:
    """Run all; how many went wrong."""
    warnings.simplefilter("error")
    times = {name: int(os.environ.get(name, most)) for name, most in TIMES.items()}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        os.chdir(folder)
        failures = _stores(folder, times["STORES"]) + _races(folder, times["RACES"])
        failures += _count("runs after kills", [partial(kills, folder / "killed", times["KILLS"])])
        return failures + _readers(folder, times["READERS"])


def _stores(folder: Path, times: int) -> int:
    sound = Sound(folder) if times else None
    return _count("damaged stores", (partial(attack, sound, folder / f"attacked{k}", k) for k in range(times)))


def _races(folder: Path, times: int) -> int:
    sound = Sound(folder) if times else None
    more = [["--restart"] if k % 5 == 4 else [] for k in range(times)]
    return _count(
        "races of three processes, by exit codes",
        (partial(race, sound, folder / f"raced{k}", *each) for k, each in enumerate(more)),
    )


def _readers(folder: Path, times: int) -> int:
    """Read spoilt records, some at once."""
    with ThreadPoolExecutor(AT_ONCE) as pool:
        begun = [pool.submit(readers.attack, folder, k) for k in range(times)]
        return _count("spoilt records", (each.result for each in begun))


def _count(what: str, attempts: Iterable[Callable[[], object]]) -> int:
    """Make attempts, print what became of them now and then, and return how many went wrong."""
    ends: Counter[str] = Counter()
    failures = 0
    for k, attempt in enumerate(attempts, start=1):
        try:
            ends[str(attempt())] += 1
        except Exception as error:
            failures += 1
            print(f"FAILED {what}: {error!r}", flush=True)
        if k % 50 == 0:
            print(f"{k} {what}: {dict(ends)}, {failures} failed", flush=True)
    print(f"{sum(ends.values()) + failures} {what}: {dict(ends)}, {failures} failed", flush=True)
    return failures


if __name__ == "__main__":
    sys.exit(1 if soak() else 0)

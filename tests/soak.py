"""What takes too long for the tests: hundreds of damaged stores, and many races. `make soak` runs it."""

from __future__ import annotations

import os
import sys
import tempfile
import warnings
from collections import Counter
from pathlib import Path

from tests.stores import RUNS, Sound, attack, race

ROUNDS, DAMAGED = 50, 500


def soak() -> int:
    """Run all; how many went wrong."""
    warnings.simplefilter("error")
    failures = 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        os.chdir(folder)
        sound = Sound(folder)
        ends: Counter[str] = Counter()
        tried = [*((k, None) for k in range(DAMAGED)), *((k, each) for k, each in enumerate(RUNS))]
        for k, (number, statement) in enumerate(tried):
            try:
                ends[attack(sound, folder / f"attacked{k}", number, statement)] += 1
            except Exception as error:
                failures += 1
                print(f"FAILED {error!r}", flush=True)
            if k % 50 == 49:
                print(f"{k + 1} damaged stores: {dict(ends)}, {failures} failed", flush=True)
        print(f"{len(tried)} damaged stores: {dict(ends)}, {failures} failed", flush=True)
        codes: Counter[tuple[int, ...]] = Counter()
        for k in range(ROUNDS):
            try:
                codes[tuple(race(sound, folder / f"raced{k}", *(["--restart"] if k % 5 == 4 else [])))] += 1
            except Exception as error:
                failures += 1
                print(f"FAILED race {k}: {error!r}", flush=True)
        print(f"{ROUNDS} rounds of three processes: exit codes {dict(codes)}, {failures} failed in all", flush=True)
    return failures


if __name__ == "__main__":
    sys.exit(1 if soak() else 0)

"""Try all commands that write, or those named, at every call: `make crash`. A table of tries and faults by kind."""

import sys
import tempfile
from collections import Counter
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from pathlib import Path

from tests.crash.attacks import LINES, attack
from tests.crash.calls import why_not

AT_ONCE = 2
KINDS = ("calls", "SIGKILL", "SIGTERM", "EIO", "ENOSPC", "memory", "power", "missed", "faults")


def crash(names: list[str]) -> int:
    """Try commands, print what became of them, and return how many faults there are."""
    total = Counter[str]()
    print(f"{'':18}", *(f"{kind:>7}" for kind in KINDS))
    with tempfile.TemporaryDirectory() as folder, ProcessPoolExecutor(AT_ONCE, get_context("spawn")) as pool:
        begun = {pool.submit(attack, name, Path(folder) / name): name for name in names}
        for each in as_completed(begun):
            tries, faults = each.result()
            total += tries
            print(f"{begun[each]:18}", *(f"{tries[kind]:7}" for kind in KINDS), flush=True)
            for fault, times in Counter(faults).most_common():
                print(f"    {times} x {fault}", flush=True)
    print(f"{len(names):11} in all", *(f"{total[kind]:7}" for kind in KINDS))
    return total["faults"]


if __name__ == "__main__":
    sys.exit(why_not() or min(crash(sys.argv[1:] or list(LINES)), 1))

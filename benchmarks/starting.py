"""What starting costs, and how fast both ways run a kernel: ratios within one run.

    python benchmarks/starting.py

Writes its tables into docs/performance.md. Processor time of whole processes, user and system; the least of some runs,
taken by turns, as whatever disturbs a run makes it longer.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median

PROJECT = Path(__file__).resolve().parents[1]
PAGE = PROJECT / "docs" / "performance.md"
BEGIN, END = "<!-- measured -->\n", "<!-- /measured -->"
ROUNDS, PAIRS = 7, 3
MOTION = "--record", "examples/accel.csv"
RESPOND = ("-m", "rocking_cli", "respond", "examples/frame.yaml", *MOTION)
IMPORTS = "import click, numpy.random, threadpoolctl, yaml; from pydantic import BaseModel, Field, field_validator"
LIBRARIES = "importing its libraries"
PROCESSES = {
    "`python -c pass`": ("-c", "pass"),
    "`import rocking_cli`": ("-c", "import rocking_cli"),
    "`import numpy`": ("-c", "import numpy"),
    LIBRARIES: ("-c", IMPORTS),
    "importing them, and scipy's optimisers": ("-c", f"{IMPORTS}; import scipy.optimize"),
    "`rocking --help`": ("-m", "rocking_cli", "--help"),
    "`rocking equiv`": ("-m", "rocking_cli", "equiv", "examples/frame.yaml"),
    "`rocking respond` of a block": ("-m", "rocking_cli", "respond", "examples/block.yaml", *MOTION),
    "`rocking respond` of an assembly": ("-m", "rocking_cli", "respond", "examples/assembly.yaml", *MOTION),
    "`rocking respond`, later": RESPOND,
    "`rocking respond --plot`, later": (*RESPOND, "--plot", "{folder}/picture.png"),
}
FIRST = {"`rocking respond`": RESPOND, "`rocking respond --plot`": PROCESSES["`rocking respond --plot`, later"]}
"""Commands as the first ones on a machine, whose caches are empty."""


def spent(arguments: tuple[str, ...], folder: str) -> float:
    """Processor time of a process whose caches are in a folder [s]."""
    caches = dict.fromkeys(("XDG_CACHE_HOME", "MPLCONFIGDIR"), folder)
    environment = {**os.environ, **caches, "ROCKING_KERNELS": "ready", "OPENBLAS_NUM_THREADS": "1"}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)  # as users have it: the bytecode is there after the first run
    before = _of_children()
    command = [sys.executable, *(each.format(folder=folder) for each in arguments)]
    subprocess.run(command, check=True, env=environment, cwd=PROJECT, capture_output=True)
    return _of_children() - before


def _of_children() -> float:
    try:
        import resource
    except ImportError:  # Windows, which does not tell the times of children
        return time.perf_counter()
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def starts() -> list[list[str]]:
    """Rows of what starting costs."""
    times: dict[str, list[float]] = {name: [] for name in PROCESSES}
    with tempfile.TemporaryDirectory() as kept:
        for name in PROCESSES:
            spent(PROCESSES[name], kept)
        for _ in range(ROUNDS):
            for name in PROCESSES:
                times[name].append(spent(PROCESSES[name], kept))
        for name, arguments in FIRST.items():
            times[f"{name}, first on a machine"] = [_empty(arguments) for _ in range(ROUNDS)]
    least = {name: min(each) for name, each in times.items()}
    python, libraries, later = (least[each] for each in ("`python -c pass`", LIBRARIES, "`rocking respond`, later"))
    return [
        [name, f"{each:.3f}", f"{each / python:.0f}", f"{each / libraries:.2f}", f"{each / later:.2f}"]
        for name, each in least.items()
    ]


def _empty(arguments: tuple[str, ...]) -> float:
    with tempfile.TemporaryDirectory() as folder:
        return spent(arguments, folder)


def speeds() -> list[list[str]]:
    """Rows of how fast the ways run a kernel: medians of ratios of runs that follow each other."""
    import numpy as np

    from rocking_cli import load_structure, read_record
    from rocking_cli.dynamics import ways
    from rocking_cli.dynamics.batch import Runs, respond_many
    from rocking_cli.structure import build_models

    motion = read_record(PROJECT / "examples" / "accel.csv")
    models = [
        build_models(load_structure(PROJECT / "examples" / f"{name}.yaml"), ("nonlinear",))[0]
        for name in ("block", "frame")
    ]

    def run(way: str, scales: int) -> float:
        os.environ[ways.KERNELS_VARIABLE] = way
        ways.forget()
        runs = Runs.every(len(models), 1, scales=tuple(np.linspace(0.5, 3.0, scales)), polarities=(1, -1))
        return _time(lambda: respond_many(models, [motion], runs, threads=1)) / len(runs)

    shipped = run("ready", 200)
    rows = [["shipped", f"{1e3 * shipped:.3f}", "1"]]
    run("python", 2)
    times = [(run("python", 2), run("ready", 2)) for _ in range(PAIRS)]
    ratio = median(theirs / ours for theirs, ours in times)
    rows.append(["in Python", f"{1e3 * median(theirs for theirs, _ in times):.3g}", f"{ratio:.3g}"])
    os.environ.pop(ways.KERNELS_VARIABLE)
    return rows


def _time(work: Callable[[], object]) -> float:
    start = time.process_time()
    work()
    return time.process_time() - start


def table(title: str, columns: list[str], rows: list[list[str]]) -> str:
    lines = [" | ".join(row) for row in (columns, ["---"] * len(columns), *rows)]
    return f"{title}\n\n" + "".join(f"| {line} |\n" for line in lines) + "\n"


def main() -> None:
    made = table(
        "Whole processes, processor time",
        ["process", "s", "of an empty Python", f"of {LIBRARIES}", "of `rocking respond`, later"],
        starts(),
    ) + table(
        "Nonlinear histories of a block and a frame under the shipped record, one thread",
        ["kernel", "ms a history", "of the shipped one"],
        speeds(),
    )
    print(made)
    before, _, rest = PAGE.read_text(encoding="utf-8").partition(BEGIN)
    PAGE.write_text(f"{before}{BEGIN}\n{made}{END}{rest.partition(END)[2]}", encoding="utf-8")


if __name__ == "__main__":
    main()

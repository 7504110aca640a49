"""What a fragility study costs: on one machine, by threads, by worker processes, and what a large one would.

    python benchmarks/fragility.py

Its 100 records are made, not measured: shaking between 0.2 and 15 Hz that rises fast and dies away slowly, of 10 to
40 s. Machines differ, and so does one machine from hour to hour. Each part prints a table in Markdown.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from rocking_cli.questions.fragility import workers as places
from rocking_cli.questions.fragility.campaign import prepare, run
from rocking_cli.questions.fragility.store import RunRows, Store
from rocking_cli.questions.fragility.study import load_study
from rocking_cli.questions.fragility.workers import carry_out, unit_of

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
RECORDS, LEVELS = 100, 20
GOAL = 15.0  # s for the study below on two cores
LARGE = 100_000_000  # runs
CORES = 1000  # of a cluster

STUDY = """\
structures: [{structures}]
records: ['records/*.csv']
method: stripes
levels: {{measure: PGA, least: 0.1, most: 2, count: {levels}}}
polarity: both
limit_states: [uplift, 0.5, overturning]
"""


def write_records(folder: Path) -> None:
    rng = np.random.default_rng(1994)
    folder.mkdir()
    for k in range(RECORDS):
        dt = (0.005, 0.01)[k % 2]
        n = int(rng.uniform(10, 40) / dt)
        spectrum = np.fft.rfft(rng.standard_normal(n))
        frequency = np.fft.rfftfreq(n, dt)
        spectrum *= ((frequency > 0.2) & (frequency < 15)) / np.sqrt(1 + (frequency / rng.uniform(1, 4)) ** 2)
        time_ = dt * np.arange(n)
        motion = np.fft.irfft(spectrum, n) * (time_ / 3) ** 2 * np.exp(-time_ / rng.uniform(1.5, 4))
        motion *= rng.uniform(0.1, 0.8) / np.abs(motion).max()
        lines = "\n".join(f"{t:.3f},{a:.8f}" for t, a in zip(time_, motion, strict=True))
        (folder / f"made{k:03}.csv").write_text(f"time_s,accel_g\n{lines}\n", encoding="utf-8")


def write_study(folder: Path, levels: int = LEVELS) -> Path:
    path = folder / f"study{levels}.yaml"
    files = ", ".join(str(EXAMPLES / f"{name}.yaml") for name in ("block", "frame", "wall"))
    path.write_text(STUDY.format(structures=files, levels=levels), encoding="utf-8")
    return path


def in_process(path: Path, jobs: int | None = None, address: str | None = None) -> tuple[int, float]:
    """Runs of a study, and how long they took without what comes before and after them."""
    with tempfile.TemporaryDirectory() as folder:
        prepared = prepare(load_study(path), Store.writing(Path(folder) / "study.runs"))
        made = places.cluster(address) if address is not None else places.threads(jobs)
        with made as hands:
            start = time.perf_counter()
            run(prepared, hands, "exact", prepared.store.chunks, lambda finished, failed: None)
            return prepared.plan.total, time.perf_counter() - start


def kernel_alone(path: Path) -> float:
    """Seconds that the runs take without a store or workers: units made before, on one thread."""
    with tempfile.TemporaryDirectory() as folder:
        prepared = prepare(load_study(path), store := Store.writing(Path(folder) / "study.runs"))
        study, plan, motions = prepared.study, prepared.plan, prepared.motions
        numbers = (plan.numbers(*store.ends(k)) for k in store.chunks)
        made = [unit_of(each, plan, study, store.facts["hash"], motions, "exact") for each in numbers]
    seconds = []
    for _ in range(3):
        start = time.perf_counter()
        for unit in made:
            carry_out(unit)
        seconds.append(time.perf_counter() - start)
    return min(seconds)


def command(path: Path) -> None:
    seconds = []
    for _ in range(3):
        start = time.perf_counter()
        subprocess.run(
            [sys.executable, "-c", "from rocking_cli.cli.main import main; main()", "fragility", path, "--restart"],
            check=True, capture_output=True,
        )  # fmt: skip
        seconds.append(time.perf_counter() - start)
    runs = 3 * RECORDS * LEVELS * 2
    print(f"\nThe command `rocking fragility`, {RECORDS} records x {LEVELS} levels x 2 polarities x 3 structures\n")
    print("| runs | s, of the command as a whole | goal |\n| --- | --- | --- |")
    print(f"| {runs:,} | {min(seconds):.1f} to {max(seconds):.1f} | {GOAL:g} |", flush=True)


def threads(path: Path) -> None:
    """Scaling by threads."""
    alone = kernel_alone(path)
    runs, _ = in_process(path, 1)
    print(f"\nThe same {runs:,} runs on threads of one process; the kernel alone takes {alone:.2f} s on one\n")
    print("| threads | s | runs a second | over one thread | more than the kernel alone |")
    print("| --- | --- | --- | --- | --- |")
    first = None
    for jobs in (1, 2):
        seconds = min(in_process(path, jobs)[1] for _ in range(3))
        first = first or seconds
        more = f"{100 * (seconds / alone - 1):+.1f} %" if jobs == 1 else ""
        print(f"| {jobs} | {seconds:.2f} | {runs / seconds:,.0f} | {first / seconds:.2f} | {more} |", flush=True)


def workers(path: Path) -> tuple[float, float]:
    """Prints scaling by worker processes; gives seconds a run of the kernel, and the overhead with one worker."""
    import distributed

    alone = kernel_alone(path)

    print(
        f"\n{4 * 3 * RECORDS * LEVELS * 2:,} runs on worker processes of one thread each, on {os.cpu_count()} cores\n"
    )
    print("| workers | s | runs a second | over one worker | more than the kernel alone |")
    print("| --- | --- | --- | --- | --- |")
    first, share = None, 0.0
    for count in (1, 2, 4):
        with distributed.LocalCluster(n_workers=count, threads_per_worker=1, dashboard_address=None) as cluster:
            in_process(path, address=cluster.scheduler_address)  # loads the kernel in each worker
            runs, seconds = min(
                (in_process(path, address=cluster.scheduler_address) for _ in range(2)), key=lambda x: x[1]
            )
        first = first or seconds
        share = share or seconds / alone - 1
        more = f"{100 * share:+.1f} %" if count == 1 else ""
        print(f"| {count} | {seconds:.2f} | {runs / seconds:,.0f} | {first / seconds:.2f} | {more} |", flush=True)
    return alone / runs, share


def large(kernel: float, overhead: float) -> None:
    core_hours = LARGE * kernel * (1 + overhead) / 3600
    print(f"\nA study of {LARGE:,} runs on a cluster of {CORES} cores, from the tables above\n")
    print(f"- {1e3 * kernel:.3f} ms a run of the kernel x {LARGE:,} runs = {LARGE * kernel / 3600:.1f} core hours")
    print(f"- x {1 + overhead:.3f} for handing out and collecting = {core_hours:.1f} core hours")
    print(f"- / {CORES} cores = {60 * core_hours / CORES:.1f} minutes, if the process that collects keeps up:")
    per_second = collecting()
    print(f"- it writes {per_second:,.0f} runs a second, so {LARGE:,} take it {LARGE / per_second / 60:.0f} minutes:")
    enough = per_second * kernel
    print(f"  beyond {enough:,.0f} cores with one process that writes; the jobs of `--share` write each for itself")


def collecting() -> float:
    """Runs a second that one process writes."""
    with tempfile.TemporaryDirectory() as folder:
        path = write_study(Path(folder), 50_000)
        (Path(folder) / "records").mkdir()
        (Path(folder) / "records" / "one.csv").write_bytes((EXAMPLES / "accel.csv").read_bytes())
        store = prepare(load_study(path), Store.writing(Path(folder) / "study.runs")).store
        random = np.random.default_rng(1)
        start, runs = time.perf_counter(), 0
        for k in store.chunks:
            numbers = np.arange(*store.ends(k))
            columns = random.uniform(0.1, 0.9, (13, numbers.size))
            store.add(RunRows(numbers, *columns[:2], np.zeros(numbers.size), *columns[2:], numbers < 0))
            runs += numbers.size
        return runs / (time.perf_counter() - start)


def memory(folder: Path) -> None:
    print("\nMemory of a study as it grows\n")
    print("| runs | peak MiB of the process |\n| --- | --- |")
    for levels in (LEVELS, 4 * LEVELS, 16 * LEVELS):
        path = write_study(folder, levels)
        code = (
            "import sys, resource; sys.path.insert(0, sys.argv[1]); from pathlib import Path; import fragility as f;"
            "runs, _ = f.in_process(Path(sys.argv[2])); print(runs, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)"
        )
        done = subprocess.run(
            [sys.executable, "-c", code, str(Path(__file__).parent), str(path)],
            check=True,
            capture_output=True,
            text=True,
        )
        runs, kilobytes = map(int, done.stdout.split())
        print(f"| {runs:,} | {kilobytes / 1024:.0f} |", flush=True)


def main() -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_records(folder / "records")
        path = write_study(folder)
        command(path)
        threads(path)
        large(*workers(write_study(folder, 4 * LEVELS)))
        memory(folder)


if __name__ == "__main__":
    main()

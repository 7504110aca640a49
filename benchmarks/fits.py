"""What the fits of a fragility study cost beside its runs, and the memory that they take of large studies.

    python benchmarks/fits.py

The records are those of `fragility.py`. Stores of a million runs and more are filled with outcomes that are drawn, not
followed: the fits do not know. Each part prints a table in Markdown.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from fragility import EXAMPLES, in_process, write_records

from rocking_cli.questions.fragility.campaign import prepare, run
from rocking_cli.questions.fragility.store import RunRows, Store
from rocking_cli.questions.fragility.study import load_study
from rocking_cli.questions.fragility.workers import threads

ASKED = "limit_states: [uplift, 0.5, overturning]\n"
METHODS = {
    "stripes": "method: stripes\nlevels: {measure: PGA, least: 0.1, most: 2, count: 50}\n",
    "cloud": "method: cloud\nlevels: {measure: scale, least: 0.2, most: 4, count: 50}\n"
    "measures: [PGA, p PGV/(g lambda)]\n",
    "ida": "method: ida\nlevels: {measure: PGA, least: 0.1, most: 2, count: 50}\n",
}
VARIED = """\
structures:
  - {{file: {block}, name: one, vary: {{width: {{normal: {{mean: 0.7, deviation: 0.05}}}}}}}}
  - {{file: {block}, name: two, vary: {{width: {{normal: {{mean: 0.9, deviation: 0.05}}}}}}}}
records: ['records/*.csv']
samples: {samples}
"""
PEAK = (
    "import resource, sys, time; from rocking_cli.cli.main import main; start = time.perf_counter();"
    "main(['results', sys.argv[1], '--json'], standalone_mode=False);"
    "print(time.perf_counter() - start, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024, file=sys.stderr)"
)


def beside_runs(folder: Path) -> None:
    """The time of fits over that of the runs."""
    print("\nFits of 30,000 runs of 3 structures under 100 records, and the runs themselves on all cores\n")
    print("| method | curves | runs s | fits s | fits / runs | goal |\n| --- | --- | --- | --- | --- | --- |")
    files = ", ".join(str(EXAMPLES / f"{name}.yaml") for name in ("block", "frame", "wall"))
    for method, asked in METHODS.items():
        path = folder / f"{method}.yaml"
        path.write_text(
            f"structures: [{files}]\nrecords: ['records/*.csv']\npolarity: both\n{asked}{ASKED}", encoding="utf-8"
        )
        in_process(path)  # loads the kernel
        place = folder / f"{method}.runs"
        prepared = prepare(load_study(path), Store.writing(place))
        with threads() as hands:
            start = time.perf_counter()
            run(prepared, hands, "exact", prepared.store.chunks, lambda finished, failed: None)
            runs = time.perf_counter() - start
        fits = min(_fits(place) for _ in range(3))
        count = 3 * 3 * len(prepared.study.definition.fitted_measures)
        print(f"| {method} | {count} | {runs:.2f} | {fits:.2f} | {fits / runs:.2f} | 0.5 |", flush=True)


def _fits(place: Path) -> float:
    """Seconds from a finished store to its curves, in a new process but for what every command imports."""
    code = (
        "import sys, time; from rocking_cli.cli.terminal import OnTerminal; from rocking_cli.cli import terminal;"
        "from rocking_cli.questions.fragility.results import results;"
        "import rocking_cli.questions.fragility.campaign; start = time.perf_counter();"
        "terminal.show(results(sys.argv[1], watch=OnTerminal()).view, as_json=True);"
        "print(time.perf_counter() - start, file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", code, str(place)], check=True, capture_output=True, text=True)
    return float(done.stderr.split()[-1])


def memory(folder: Path) -> None:
    """Peak memory and time of `rocking results` on stores that were filled without running."""
    print("\n`rocking results` on large stores of two structures\n")
    print("| study | runs | bytes a run in the store | s | us a run | peak MiB | goal |\n" + "| --- " * 7 + "|")
    asked = "measures: [PGA, PGA/(g lambda), p PGV/(g lambda)]\n" + ASKED
    cloud = "method: cloud\nlevels: {measure: scale, least: 0.2, most: 4, count: 50}\n" + asked
    _large(folder, "cloud, every sample of another shape", 50, cloud, 500)
    stripes = "method: stripes\nlevels: {measure: PGA, least: 0.1, most: 2, count: 50}\n" + ASKED
    _large(folder, "stripes", 500, stripes, 1024)


def _large(folder: Path, name: str, samples: int, asked: str, goal: float) -> None:
    path, place = folder / "large.yaml", folder / "large.runs"
    text = VARIED.format(block=EXAMPLES / "block.yaml", samples=samples)
    path.write_text(text + "polarity: both\n" + asked, encoding="utf-8")
    shutil.rmtree(place, ignore_errors=True)
    store = Store.writing(place)
    plan, random = prepare(load_study(path), store).plan, np.random.default_rng(1)
    for k in store.chunks:
        store.add(_drawn(plan, np.arange(*store.ends(k)), random))
    done = subprocess.run([sys.executable, "-c", PEAK, str(place)], check=True, capture_output=True, text=True)
    seconds, peak = map(float, done.stderr.split()[-2:])
    micro = 1e6 * seconds / plan.size
    size = sum(each.stat().st_size for each in place.iterdir()) / plan.size
    print(f"| {name} | {plan.size:,} | {size:.0f} | {seconds:.1f} | {micro:.1f} | {peak:.0f} | {goal:g} |", flush=True)


def _drawn(plan, runs, random):  # type: ignore[no-untyped-def]
    """Outcomes of runs: uplift and overturning at capacities that scatter."""
    sample, record, _, level, _ = plan.places(runs)
    scale = plan.factors(sample, record, level)
    x = scale * np.array([each.pga for each in plan.records])[record]
    scatter = np.exp(0.5 * random.standard_normal(runs.size))
    fell = x > 1.2 * scatter
    peak = np.where(fell, np.nan, x / (1.2 * scatter))
    nothing = np.full(runs.size, np.nan)
    uplift = np.where(x > 0.3 * scatter, 1.0, np.nan)
    ended, known = np.where(fell, 2.0, np.nan), [nothing] * 5
    return RunRows(runs, scale, nothing, fell.astype(np.int64), peak, peak, peak, uplift, ended, *known, fell & False)


def main() -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_records(folder / "records")
        beside_runs(folder)
        memory(folder)


if __name__ == "__main__":
    main()

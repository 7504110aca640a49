"""What the page of `rocking explore` computes in a browser, over what the native kernels take.

    python benchmarks/pages.py

Needs a Chromium (named in ROCKING_BROWSER, or on the path) and playwright. The page measures itself by `?bench`.
"""

from __future__ import annotations

import os
import shutil
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import rocking_cli as rk

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
GOALS = {"history": 5, "neighbours": 200, "map": 2000}  # ms, on a core of an ordinary laptop


def fastest(work: Callable[[], object]) -> float:
    """Return the least time of three calls [ms]."""
    times = []
    for _ in range(3):
        start = time.perf_counter()
        work()
        times.append(1e3 * (time.perf_counter() - start))
    return min(times)


def main() -> None:
    """Print a table for a block and a frame."""
    from playwright.sync_api import sync_playwright

    found = os.environ.get("ROCKING_BROWSER") or shutil.which("chromium") or shutil.which("google-chrome")
    print("| structure | what | ms in a browser | goal | over the call in Python |\n| --- | --- | --- | --- | --- |")
    with sync_playwright() as driver, tempfile.TemporaryDirectory() as folder:
        browser = driver.chromium.launch(executable_path=found, args=["--no-sandbox"])
        for name in ("block", "frame"):
            file, record, page = EXAMPLES / f"{name}.yaml", EXAMPLES / "accel.csv", Path(folder) / f"{name}.html"
            rk.explore(file, record, out=page)
            structure = rk.load_structure(file)
            native = {
                "history": lambda of=structure, by=record: rk.respond(of, by, engine="exact", model="nonlinear"),
                "neighbours": lambda of=structure, by=record: rk.shares(of, by),
                "map": lambda of=structure: rk.overturning_map(of, model="nonlinear", points=20),
            }
            shown = browser.new_page()
            shown.goto(f"{page.as_uri()}?bench")
            shown.wait_for_selector("#bench", state="attached")
            measured = shown.evaluate("JSON.parse(document.getElementById('bench').textContent)")
            for what, ms in measured.items():
                ratio = ms / fastest(native[what])
                print(f"| {name} | {what} | {ms:.1f} | {GOALS[what]} | {ratio:.2f} |", flush=True)
        browser.close()


if __name__ == "__main__":
    main()

"""Runs the commands that README.md and the documentation show, on examples/, and keeps what they print and draw.

    python docs/make_runs.py              # part of make docs

Output and pictures go to docs/_generated/run, which is not in git: nothing that the site shows can be stale. README.md
is also read where nothing is built. Its pictures are kept in docs/pictures, and written anew when they no longer show
what the commands draw; `tests/test_docs.py` fails until they are.
"""

from __future__ import annotations

import json
import re
import shlex
import shutil
from collections.abc import Iterator
from contextlib import chdir, contextmanager
from itertools import chain
from math import isclose
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
from click.testing import CliRunner
from matplotlib.figure import Figure
from PIL import Image

from rocking_cli.cli.main import main

DOCS = Path(__file__).resolve().parent
EXAMPLES = DOCS.parent / "examples"
RUN = DOCS / "_generated" / "run"
KEPT = DOCS / "pictures"
KEPT_CONTENT = KEPT / "content.json"  # what its pictures show, in numbers: their pixels depend on the machine's fonts
Entry = list[str | float]

# What is shown, in this order and in one folder with examples/ in it: the name of the output, and the command line.
SHOWN = {
    "new": "rocking new block > pedestal.yaml",
    "draw": "rocking draw pedestal.yaml --plot drawing.png",
    "equiv": "rocking equiv pedestal.yaml",
    "error": "rocking error pedestal.yaml",
    "record": "rocking record examples/accel.csv",
    "respond": "rocking respond pedestal.yaml --record examples/accel.csv --plot response.png",
    "stronger": "rocking respond pedestal.yaml --record examples/accel.csv --scale 1.3 --model nonlinear",
    "overturning": "rocking overturning pedestal.yaml --plot map.png",
    "spectrum": "rocking spectrum pedestal.yaml --record examples/accel.csv --plot spectrum.png",
    "animate": "rocking animate examples/frame.yaml --record examples/accel.csv --out moving.gif",
    "report": "rocking report pedestal.yaml --record examples/accel.csv -o report.html",
    "blocks": "rocking spectrum pedestal.yaml --record examples/accel.csv --slenderness 0.2,0.3 --plot blocks.png",
    "frame": "rocking respond examples/frame.yaml --record examples/accel.csv --polarity both --plot frame.png",
}
IN_README = ("draw_asymmetric_frame.png", "response.png", "map.png", "blocks.png")

WIDTH = 100  # columns of the terminal
CLOSE = 1e-2  # of a number, mean or deviation: pictures differ by less from machine to machine


def examples() -> dict[str, str]:
    """The file in examples/ for each mechanism that has one."""
    named = ((re.search(r"^mechanism: (\w+)", file.read_text(encoding="utf-8"), re.M), file.name)
             for file in sorted(EXAMPLES.glob("*.yaml")))  # fmt: skip
    return {found[1]: file for found, file in named if found}


def of_mechanisms() -> dict[str, str]:
    """What the page of each mechanism shows of its example."""
    shown = {}
    for mechanism, file in examples().items():
        shown[f"equiv_{mechanism}"] = f"rocking equiv examples/{file}"
        shown[f"draw_{mechanism}"] = f"rocking draw examples/{file} --plot draw_{mechanism}.png"
    return shown


def run(shown: dict[str, str], folder: Path) -> dict[str, list[Entry]]:
    """Run commands one after the other in a folder, and write the output of each there as NAME.txt.

    Returns
    -------
    dict
        The content of each picture, by its file name.
    """
    contents = {}
    shutil.copytree(EXAMPLES, folder / "examples", dirs_exist_ok=True)
    with chdir(folder), noted_figures() as figures:
        for name, command in shown.items():
            _, *arguments = shlex.split(command)
            into = arguments[arguments.index(">") + 1] if ">" in arguments else None
            done = CliRunner().invoke(main, arguments[:-2] if into else arguments, env={"COLUMNS": str(WIDTH)})
            if done.exit_code != 0:
                raise SystemExit(f"`{command}` ended with exit code {done.exit_code}:\n{done.output}")
            lines = [line.rstrip() for line in done.stdout.splitlines()]
            for file in filter(None, (f"{name}.txt", into)):
                Path(file).write_text("\n".join(lines).rstrip() + "\n", encoding="utf-8")
            if "--plot" in arguments:
                contents[arguments[arguments.index("--plot") + 1]] = content(figures.pop())
    return contents


@contextmanager
def noted_figures() -> Iterator[list[Figure]]:
    """The figures that are saved meanwhile."""
    figures: list[Figure] = []
    save = Figure.savefig

    def note_and_save(figure: Figure, *args: Any, **options: Any) -> None:
        figures.append(figure)
        save(figure, *args, **options)

    with patch.object(Figure, "savefig", note_and_save):
        yield figures


def content(figure: Figure) -> list[Entry]:
    """What a figure shows, without what fonts and their sizes change: words, and size, mean and deviation of data."""
    entries: list[Entry] = []
    for axes in figure.axes:
        entries.append([axes.get_title(loc="left"), axes.get_title(), axes.get_xlabel(), axes.get_ylabel()])
        entries.append([text.get_text() for text in axes.texts])
        for line in axes.lines:
            entries.append([str(line.get_color()), *numbers(line.get_xdata()), *numbers(line.get_ydata())])
        for drawn in (*axes.collections, *axes.images):
            values = drawn.get_array()
            if values is not None:
                entries.append([type(drawn).__name__, *numbers(values)])
    return entries


def numbers(values: Any) -> list[float]:
    """How many there are, their mean and their standard deviation, of those that are finite."""
    found = np.asarray(values, dtype=float).ravel()
    found = found[np.isfinite(found)]
    return [found.size, float(found.mean()), float(found.std())] if found.size else [0]


def alike(one: list[Entry], other: list[Entry]) -> bool:
    """Whether two pictures have the same content."""
    if [len(entry) for entry in one] != [len(entry) for entry in other]:
        return False
    pairs = zip(chain.from_iterable(one), chain.from_iterable(other), strict=True)
    return all(a == b if isinstance(a, str) else isclose(a, b, rel_tol=CLOSE, abs_tol=CLOSE / 10) for a, b in pairs)


def stale(contents: dict[str, list[Entry]]) -> list[str]:
    """The pictures in README.md that are not there, or show something else than these."""
    kept = json.loads(KEPT_CONTENT.read_text(encoding="utf-8")) if KEPT_CONTENT.exists() else {}
    return [
        name
        for name in IN_README
        if name not in kept or not (KEPT / name).exists() or not alike(contents[name], kept[name])
    ]


def keep(contents: dict[str, list[Entry]], folder: Path) -> None:
    """Renew the pictures in README.md if any is stale."""
    if not stale(contents):
        return
    KEPT.mkdir(exist_ok=True)
    for name in IN_README:
        with Image.open(folder / name) as image:  # 128 colours are enough, and a third of the bytes
            image.convert("RGB").quantize(128, dither=Image.Dither.NONE).save(KEPT / name, optimize=True)
    lines = ",\n".join(f" {json.dumps(name)}: {json.dumps(contents[name])}" for name in IN_README)
    KEPT_CONTENT.write_text(f"{{\n{lines}\n}}\n", encoding="utf-8")
    print("renewed docs/pictures")


if __name__ == "__main__":
    RUN.mkdir(parents=True, exist_ok=True)
    keep(run(SHOWN | of_mechanisms(), RUN), RUN)

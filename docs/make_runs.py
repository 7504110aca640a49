"""Runs the commands that README.md and the documentation show, and keeps what they draw in docs/pictures.

What a command plots is kept as SVG in the colours of a light and of a dark page, and once more for a phone; pages of
HTML and animations are kept as pixels. A picture is written anew only when it no longer shows what its command draws:
`content.json` has what each shows, in words and numbers, as pixels depend on the fonts of the machine.
"""

from __future__ import annotations

import json
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterable, Iterator, Sequence
from contextlib import chdir, contextmanager, nullcontext
from dataclasses import dataclass
from importlib import import_module
from itertools import chain
from math import isclose
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
from click.testing import CliRunner
from matplotlib.figure import Figure
from parts import same
from PIL import Image, ImageSequence

from rocking_cli.cli.main import main
from rocking_cli.documents.figures import svg_element
from rocking_cli.plotting import style

DOCS = Path(__file__).resolve().parent
EXAMPLES = DOCS.parent / "examples"
KEPT = DOCS / "pictures"
KEPT_CONTENT = KEPT / "content.json"
Entry = list[str | float]
Content = list[Entry]

WIDTH = 80  # columns of the terminal
CLOSE = 1e-2  # of a number, mean or deviation: pictures differ by less from machine to machine
PHONE = "-phone.svg"  # ending of the drawing of a plot for a phone
LARGEST = 100_000  # bytes of a picture of pixels
# Colours and width of a picture in pixels, the first that make it small enough.
PLAINER = ((128, 1600), (64, 1300), (64, 1000), (64, 480), (32, 480), (32, 360))


@dataclass(frozen=True)
class Run:
    """Output of a command, and the content of each picture that it drew, by the name under which it is kept."""

    output: str
    pictures: dict[str, Content]
    plots: tuple[str, ...]
    """Names of the pictures that are plots, in the order in which they were drawn."""


def run(commands: Iterable[str], folder: Path) -> dict[str, Run]:
    """Run commands one after the other in a folder, with examples/ in it."""
    shutil.copytree(EXAMPLES, folder / "examples", dirs_exist_ok=True)
    with chdir(folder):
        return {command: ran(command) for command in commands}


def ran(command: str) -> Run:
    """Run a command in the current folder: `rocking`, or a script of docs as a command of click."""
    program, *arguments = shlex.split(command)
    called = main
    if program == "python":
        called = import_module(Path(arguments.pop(0)).stem).main
    into = arguments[arguments.index(">") + 1] if ">" in arguments else None
    there = set(Path().rglob("*"))
    with noted_figures() as figures:
        done = CliRunner().invoke(called, arguments[:-2] if into else arguments, env={"COLUMNS": str(WIDTH)})
    if done.exit_code != 0:
        raise SystemExit(f"`{command}` ended with exit code {done.exit_code}:\n{done.output}")
    lines = [line.rstrip() for line in done.stdout.replace(sys.executable, "python").splitlines()]
    output = "\n".join(lines).strip("\n") + "\n"
    if into:
        Path(into).write_text(output, encoding="utf-8")
    made = sorted(set(Path().rglob("*")) - there, key=lambda file: file.stat().st_mtime_ns)
    plots = tuple(f"{file.stem}.svg" for file in made if file.suffix == ".png")
    pictures = dict(zip(plots, map(content, figures), strict=True)) if plots else {}
    pictures |= {file.name: content_of_frames(file) for file in made if file.suffix == ".gif"}
    pictures |= {f"{file.stem}.png": [[output]] for file in made if file.suffix == ".html"}  # a page in a browser
    return Run(output, pictures, plots)


@contextmanager
def noted_figures() -> Iterator[list[Figure]]:
    """Collect the figures that are saved meanwhile."""
    figures: list[Figure] = []
    save = Figure.savefig

    def note_and_save(figure: Figure, *args: Any, **options: Any) -> None:
        figures.append(figure)
        save(figure, *args, **options)

    with patch.object(Figure, "savefig", note_and_save):
        yield figures


def content(figure: Figure) -> Content:
    """Return the content of a figure independently of fonts: words, and size, mean and deviation of data."""
    entries: Content = []
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


def content_of_frames(file: Path) -> Content:
    """Return the number of frames, and their brightness."""
    with Image.open(file) as image:
        frames = [np.asarray(frame.convert("L")) for frame in ImageSequence.Iterator(image)]
    return [["frames", len(frames), *numbers(np.mean(frames, axis=(1, 2)))]]


def numbers(values: Any) -> list[float]:
    """Return number, mean and standard deviation of the finite values."""
    found = np.asarray(values, dtype=float).ravel()
    found = found[np.isfinite(found)]
    return [found.size, *(float(f"{value:.5g}") for value in (found.mean(), found.std()))] if found.size else [0]


def alike(one: Content, other: Content) -> bool:
    """Whether two pictures have the same content."""
    if [len(entry) for entry in one] != [len(entry) for entry in other]:
        return False
    pairs = zip(chain.from_iterable(one), chain.from_iterable(other), strict=True)
    return all(
        same(str(a), str(b)) if isinstance(a, str) or isinstance(b, str)
        else isclose(a, b, rel_tol=CLOSE, abs_tol=CLOSE / 10)
        for a, b in pairs
    )  # fmt: skip


def shown(page: str) -> list[str]:
    """Return the names of the pictures that a page shows."""
    return re.findall(r"!\[[^]]*\]\((?:\.\./|docs/)?pictures/([^)]+)\)", page)


def kept() -> dict[str, Content]:
    """Return the content of the pictures in docs/pictures."""
    found: dict[str, Content] = json.loads(KEPT_CONTENT.read_text(encoding="utf-8")) if KEPT_CONTENT.exists() else {}
    return {name: entries for name, entries in found.items() if (KEPT / name).exists()}


def stale(contents: dict[str, Content]) -> list[str]:
    """Return the pictures that are missing, or whose content differs."""
    there = kept()
    return [name for name, entries in contents.items() if name not in there or not alike(entries, there[name])]


def files(contents: Iterable[str]) -> set[str]:
    """Return the files of pictures."""
    return {file for name in contents for file in (name, name.replace(".svg", PHONE))}


def keep(contents: dict[str, Content], runs: dict[str, Run], folder: Path) -> None:
    """Renew the pictures that are stale, and drop those that are not among these."""
    KEPT.mkdir(exist_ok=True)
    there = kept()
    gone = stale(contents)
    for command, each in runs.items():
        if wanted := set(gone) & set(each.plots):
            draw_again(command, each.plots, wanted, folder)
    for name in gone:
        if not name.endswith(".svg"):
            made = found(folder, name)
            if made is None:
                print(f"docs/pictures/{name} is stale, and there is no chromium here to renew it")
                continue
            write_small(made, KEPT / name)
        there[name] = contents[name]
        print(f"renewed docs/pictures/{name}")
    for file in set(KEPT.iterdir()) - {KEPT_CONTENT, *(KEPT / name for name in files(contents))}:
        file.unlink()
    lines = ",\n".join(f" {json.dumps(name)}: {json.dumps(there[name])}" for name in sorted(there.keys() & contents))
    KEPT_CONTENT.write_text(f"{{\n{lines}\n}}\n", encoding="utf-8")


def draw_again(command: str, plots: Sequence[str], wanted: set[str], folder: Path) -> None:
    """Keep the wanted plots of a command, for a wide page and for a phone."""
    for ending, on_page in ((".svg", nullcontext), (PHONE, style.on_phone)):
        with chdir(folder), on_page(), noted_figures() as figures:
            ran(command)
        for name, figure in zip(plots, figures, strict=True):
            if name in wanted:
                file = KEPT / name.replace(".svg", ending)
                file.write_text(themed(figure, file.stem), encoding="utf-8", newline="\n")


def themed(figure: Figure, name: str) -> str:
    """Return a figure as an SVG file that follows the colours of the page on which it is shown, light or dark."""
    start, _, rest = svg_element(figure, name).partition(">")
    rules = f"<style>@media (prefers-color-scheme: dark) {{\n{style.dark_rules()}\n}}</style>"
    return f"{start}>{rules}{rest}\n"


def found(folder: Path, name: str) -> Path | None:
    """Return the picture that a command drew; for a page, a screenshot by the browser, if there is one."""
    for file in folder.rglob(name):
        return file
    picture, browser = folder / name, shutil.which("chromium") or shutil.which("google-chrome")
    if browser is None:
        return None
    options = ["--headless", "--no-sandbox", "--hide-scrollbars", "--virtual-time-budget=5000"]
    page = picture.with_suffix(".html").as_uri()
    subprocess.run(
        [browser, *options, "--window-size=900,1250", f"--screenshot={picture}", page], check=True, capture_output=True
    )
    return picture


def write_small(picture: Path, into: Path) -> None:
    """Copy a picture, with as many colours and pixels as fit into its size: 128 colours are a third of the bytes."""
    with Image.open(picture) as image:
        frames = [frame.convert("RGB") for frame in ImageSequence.Iterator(image)]
        duration = image.info.get("duration", 0)
    for colours, width in PLAINER:
        share = min(1.0, width / frames[0].width)
        size = (round(frames[0].width * share), round(frames[0].height * share))
        sized = [frame.resize(size, Image.Resampling.LANCZOS) if share < 1 else frame for frame in frames]
        # One palette for all frames: what does not move takes no bytes. This method keeps white.
        palette = sized[0].quantize(colours, method=Image.Quantize.FASTOCTREE)
        first, *others = (frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in sized)
        if others:
            first.save(into, save_all=True, append_images=others, duration=duration, loop=0, optimize=True)
        else:
            first.save(into, optimize=True)
        if into.stat().st_size < LARGEST:
            return

"""Renew docs/scoreboard.md: the scores of this version on every set of tests that is at hand, and on forty assemblies.

    python -m validation.scoreboard EXPERIMENTS     # or make scoreboard ROCKING_EXPERIMENTS=EXPERIMENTS

EXPERIMENTS holds data outside the project: `granite_boulders.csv` and `granite_motions_100hz.npz` (see
validation/granite.py), and `shakebot_pulses.csv`. The page itself keeps the rows: that of this version is written
anew, and a set that is not at hand keeps the rows it has. The assemblies are made by tests/free_blocks.py: they are
always at hand, with MuJoCo, and take some minutes on two processors.
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Callable
from functools import cache
from importlib.util import find_spec
from itertools import groupby, product
from math import cos, pi, sin
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple
from unittest.mock import patch

import numpy as np

from rocking_cli import Block, GroundMotion, __version__, parse_pulse
from rocking_cli.structure import Structure
from rocking_cli.studies.engines import free as memory
from rocking_cli.studies.neighbours import Neighbourhood
from validation import granite
from validation.pages import DOCS, renewed, table
from validation.rules import Scored, Stated, score_tests, scored
from validation.score import score
from validation.table import ObservedTest

PAGE = DOCS / "scoreboard.md"
HEADS = ("set", "version", "tests", "Brier score", "drift", "log loss", "right", "mean gap")
BLOCK_HEADS = (
    "set", "version", "outcome known", "same outcome", "peak agrees", "within 5 %", "drift", "outcome unknown",
    "of these stand", "collapse", "fail",
)  # fmt: skip
ASSEMBLIES, PROCESSES = "forty assemblies", 2
BOULDERS, SHAKEBOT, RATES = "granite boulders", "shakebot pulses", "shakebot pulses, by base rates"
GRID = (np.geomspace(0.02, 0.4, 12), np.geomspace(0.002, 2.0, 13))  # slenderness, and half diagonal [m]
ROUGH = Neighbourhood(20)
SAME = 5e-4  # difference of Brier scores that rounding to three digits hides


class Row(NamedTuple):
    """A line of a table, by its cells."""

    cells: tuple[str, ...]

    @property
    def key(self) -> tuple[str, str]:
        """Set and version."""
        return self.cells[0], self.cells[1]

    @property
    def brier(self) -> float:
        """Brier score."""
        return float(self.cells[3].split()[0])


def boulders(source: Path) -> Scored:
    """Score the shares of the granite boulders."""
    with TemporaryDirectory() as made:
        granite.write(source, Path(made))
        return score(Path(made) / "tests.csv").result


@cache
def structure(name: str) -> Structure:
    """Return a free-standing block by its slenderness and half diagonal."""
    alpha, size = (float(each) for each in name.split())
    return Structure(Block(width=2 * size * sin(alpha), height=2 * size * cos(alpha)))


@cache
def motion(name: str) -> GroundMotion:
    """Return a pulse by its text."""
    return parse_pulse(name).sampled()


@cache
def postures(source: Path) -> dict[str, list[ObservedTest]]:
    """Return the tests of each posture to which a block can be fitted, with the name of this block."""
    found = {}
    with (source / "shakebot_pulses.csv").open(encoding="utf-8") as stream:
        rows = sorted(csv.DictReader(stream), key=lambda row: (row["set"], row["date"], row["time"]))
    for posture, group in groupby(rows, key=lambda row: row["set"]):
        tests = [
            ObservedTest(
                k, "", f"cosine:{row['pga_g']}g:{2 * pi * float(row['pgv_pga_s']):.6g}s", row["toppled"] == "1",
                polarity="1", cluster=f"{posture} {row['pgv_pga_s']}", half="ab"[k % 2], commanded=True,
            )
            for k, row in enumerate(group)
        ]  # fmt: skip
        name, inside = fitted(tests[::2])
        refused = "" if inside else ": left out, as this lies on the edge of the grid"
        print(f"{posture}: slenderness and half diagonal [m] {name}, {len(tests[::2])} tests{refused}", file=sys.stderr)
        if inside:
            found[name] = tests
    return found


def shakebot(source: Path) -> Scored:
    """Fit a block to every other test of each posture, and score the shares of the remaining tests."""
    stated: list[Stated] = []
    for name, tests in postures(source).items():
        found = score_tests(tests[1::2], lambda _, name=name: structure(name), motion)
        stated += found.tests
    return scored(stated, Neighbourhood())


def rates(source: Path) -> Scored:
    """Score the base rate of each posture: the share of every other test that overturned, on the remaining tests."""
    stated: list[Stated] = []
    for tests in postures(source).values():
        outcomes = [bool(each.overturned) for each in tests[::2]]
        stated += [Stated(each, sum(outcomes), 0, len(outcomes)) for each in tests[1::2]]
    return scored(stated, Neighbourhood())


def fitted(tests: list[ObservedTest]) -> tuple[str, bool]:
    """Return the name of the block of the grid to which the outcomes are likeliest, and whether it is off all edges."""

    def likelihood(place: tuple[float, float]) -> float:
        name = f"{place[0]:.4g} {place[1]:.4g}"
        found = score_tests(tests, lambda _: structure(name), motion, ROUGH)
        return -found.scores["tool"].log_loss.value

    best = max(product(*GRID), key=likelihood)
    inside = all(values[0] < each < values[-1] for each, values in zip(best, GRID, strict=True))
    return f"{best[0]:.4g} {best[1]:.4g}", inside


SETS: dict[str, tuple[Callable[[Path], Scored], str]] = {
    BOULDERS: (boulders, "granite_boulders.csv"),
    SHAKEBOT: (shakebot, "shakebot_pulses.csv"),
    RATES: (rates, "shakebot_pulses.csv"),
}


def row(name: str, found: Scored, before: list[Row]) -> Row:
    """Return the line of a set, with the drift of its Brier score since its last line of another version."""
    tool = found.scores["tool"]
    earlier = [each for each in before if each.key[0] == name and each.key[1] != __version__]
    value = round(tool.brier.value, 3)
    drift = f"{value - earlier[-1].brier:+.3f} since {earlier[-1].key[1]}" if earlier else "first"
    scores = [f"{each.value:.3f} [{each.low:.3f} {each.high:.3f}]" for each in (tool.brier, tool.log_loss, tool.right)]
    return Row((name, __version__, str(tool.tests), scores[0], drift, *scores[1:], f"{found.mean_gap:.3f}"))


def assemblies(before: list[Row]) -> Row:
    """Simulate the assemblies by both engines, and return their line, with the drift of the peaks that agree."""
    from tests.free_blocks import agreement, forty, side_by_side

    with TemporaryDirectory() as folder, patch.object(memory, "place", lambda: Path(folder) / "blocks.sqlite"):
        found = agreement(side_by_side(forty(), PROCESSES))
    earlier = [each for each in before if each.key[0] == ASSEMBLIES and each.key[1] != __version__]
    drift = f"{found.near - int(earlier[-1].cells[4].split()[0]):+d} since {earlier[-1].key[1]}" if earlier else "first"
    cells = [ASSEMBLIES, __version__, f"{found.known} of {found.cases}", f"{found.outcomes} of {found.sure}"]
    cells += [f"{found.near} of {found.peaks}", str(found.close), drift, str(found.cases - found.known)]
    return Row((*cells, *map(str, (found.stand, found.collapse, found.failed))))


def kept(text: str) -> list[Row]:
    """Return the lines of a page."""
    lines = (line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("| "))
    return [Row(tuple(map(str.strip, cells))) for cells in lines if cells[0] != HEADS[0]]


def merged(before: list[Row], made: list[Row]) -> list[Row]:
    """Return the lines of all sets and versions, made ones in place of those of the same set and version."""
    new = {each.key: each for each in made}
    old = [new.pop(each.key, each) for each in before]
    return sorted([*old, *new.values()], key=lambda each: [*SETS, ASSEMBLIES].index(each.key[0]))


def page(text: str, rows: list[Row]) -> str:
    """Return a page with these lines."""
    own = [each.cells for each in rows if each.key[0] != ASSEMBLIES]
    blocks = [each.cells for each in rows if each.key[0] == ASSEMBLIES]
    return renewed(text, {"sets": table(HEADS, own), "assemblies": table(BLOCK_HEADS, blocks)})


def main() -> int:
    """Score the sets that are at hand, and write the page."""
    if len(sys.argv) != 2:
        print(__doc__)
        return 2
    source = Path(sys.argv[1])
    text = PAGE.read_text(encoding="utf-8")
    before = kept(text)
    made = []
    for name, (scores, file) in SETS.items():
        if not (source / file).is_file():
            print(f"{name}: not at hand, its lines stay", file=sys.stderr)
            continue
        made.append(row(name, scores(source), before))
        for old in before:
            if old.key == made[-1].key and abs(old.brier - made[-1].brier) > SAME:
                print(f"{name}: Brier score {made[-1].brier}, was {old.brier} of the same version", file=sys.stderr)
    if find_spec("mujoco") is not None:
        made.append(assemblies(before))
    PAGE.write_text(page(text, merged(before, made)), encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())

"""Slenderness and restitution of a structure that explain the outcomes of shake-table tests: their joint region.

python -m validation.region FILE.yaml TESTS.csv [--plot region.png] [--json]
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from rocking_cli.ask.answer import Answer
from rocking_cli.ask.asked import option
from rocking_cli.ask.groups import ReadsRecords, plot_file
from rocking_cli.ask.inputs import structure_of
from rocking_cli.ask.kinds import WHOLE, quantity, span
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import InputError, Problem
from rocking_cli.names import percent
from rocking_cli.plotting import style
from rocking_cli.studies.neighbours import Neighbourhood
from rocking_cli.views.column import only_shown, table_of
from rocking_cli.views.view import Table, View
from validation.command import Command, run
from validation.likelihood import EDGE_DROP, REGION_PROBABILITY, JointRegion, joint_region
from validation.score import motions_of, tests_of
from validation.table import ObservedTest, TableOfTests

LOWER = (-20.0, -15.0, -10.0, -7.0, -5.0)  # log-likelihood, less the largest, of the lines outside the joint region
FACTORS = span(quantity("factor", "", "LOW:HIGH", "0.8", 1e-3, 1e3), "0.8:1.2", "LOW:HIGH")
RESTITUTIONS = span(quantity("restitution", "", "LOW:HIGH", "0.8", 1e-3, 1.0), "0.8:0.99", "LOW:HIGH")


class RegionAsked(ReadsRecords):
    """Find slenderness and restitution of a structure that explain the outcomes of shake-table tests.

    The outcomes give the likelihood over a grid of slenderness and restitution. Outcomes alone leave a ridge of pairs
    that explain them about as well: the region is shown, and nothing is written. A best point on the edge of the grid
    is refused.

    \b
    Example:
      python -m validation.region block.yaml tests.csv --points 13
    """

    structure: Any = option("The structure, or its YAML file.", where="input", default=..., typed="FILE.yaml")
    tests: Any = option(
        "Table of shake-table tests, as it is scored; those of the structure are used.",
        where="input", default=..., typed="TESTS.csv",
    )  # fmt: skip
    slenderness: tuple[float, float] = option(
        "Range of the factor on the slenderness.", FACTORS, default=(0.7, 1.3), usual="0.7:1.3"
    )
    restitution: tuple[float, float] = option(
        "Range of the restitution.", RESTITUTIONS, default=(0.7, 0.99), usual="0.7:0.99"
    )
    points: int = option("Number of values along each axis of the grid.", WHOLE, default=9, ge=3, le=101)
    neighbours: int = option(
        "Number of neighbours of each test at each point of the grid.", WHOLE, default=40, ge=1, le=100_000
    )
    jobs: int | None = option("Number of processor cores to use.", WHOLE, ge=1, usual="one for each processor")
    plot: Path | None = plot_file("Plot the likelihood over the grid")


@verb(RegionAsked)
def region(asked: RegionAsked, watch: Watcher) -> Answer[JointRegion]:
    """Find the joint region of slenderness and restitution from shake-table tests.

    Returns
    -------
    Answer of JointRegion
        The log-likelihood over the grid, the `best` point and the `ranges` of the joint region of 90 %.

    Raises
    ------
    InputError
        If a file is not valid, if no test is of the structure, or if the best point lies on the edge of the grid.
    """
    structure, table = structure_of(asked.structure, watch), tests_of(asked.tests)
    tests = _of_structure(table, structure.file)
    grid = np.geomspace(*asked.slenderness, asked.points), np.linspace(*asked.restitution, asked.points)
    with watch.progress(len(tests), "tests") as advance:
        found = joint_region(
            tests, structure, motions_of(table, asked), Neighbourhood(asked.neighbours), *grid,
            threads=asked.jobs, progress=advance,
        )  # fmt: skip
    shown = view(found, structure.name, table.file, len(table.tests))
    return Answer("region", found, shown, partial(columns, found), partial(draw_region, found, structure.name))


def _of_structure(table: TableOfTests, file: str | None) -> Sequence[ObservedTest]:
    """Return the tests of a structure: those that name its file, or all of a structure without a file."""
    if file is None:
        return table.tests
    kept = [test for test in table.tests if (table.folder / test.structure).resolve() == Path(file).resolve()]
    if not kept:
        names = list(dict.fromkeys(test.structure for test in table.tests))
        what = f"no test is of {file}: its structures are {', '.join(names[:5])}{', ...' * (len(names) > 5)}"
        raise InputError(Problem(what, table.file))
    return kept


def view(found: JointRegion, name: str, file: str, count: int) -> View:
    """Show the joint region of slenderness and restitution; `count` is the number of tests in the table."""
    return View(lambda: _data(found, name), [*_parts(found, name, file, count)])


def columns(found: JointRegion) -> dict[str, list[Any]]:
    """Return the points of the grid as columns by name."""
    points = [(i, k) for i in range(found.slenderness.size) for k in range(found.restitution.size)]
    return {
        "slenderness": [float(found.slenderness[i]) for i, _ in points],
        "restitution": [float(found.restitution[k]) for _, k in points],
        "log_likelihood": [float(found.likelihood[i, k]) for i, k in points],
        "inside": [bool(found.inside[i, k]) for i, k in points],
    }


def _parts(found: JointRegion, name: str, file: str, count: int) -> Iterator[Table | str]:
    yield (
        f"{file}: {found.tests} of {count} tests are of {name} and have an outcome, in {found.clusters} clusters. Grid "
        f"of {found.slenderness.size} x {found.restitution.size} points, {found.around.count} neighbours of each test "
        "at each."
    )
    slender, eta = found.best
    (low, high), (least, most) = found.ranges
    points = int(found.inside.sum())
    yield (
        f"Likeliest: slenderness times {slender:.3g}, restitution {eta:.3g}. Joint region of "
        f"{percent(REGION_PROBABILITY)}, "
        f"{points} of {found.inside.size} points: slenderness times {low:.3g} to {high:.3g}, restitution {least:.3g} "
        f"to {most:.3g}. Not every pair of values from these ranges is in it."
    )
    inside = found.inside
    if inside[[0, -1]].any() or inside[:, [0, -1]].any():
        yield "Caution: the region reaches the edge of the grid, and is wider than the grid shows."
    above = found.likelihood - found.likelihood.max()
    cells = [
        [f"{value:.1f}{'*' * bool(within)}" for value, within in zip(*row, strict=True)]
        for row in zip(above.T, inside.T, strict=True)
    ]
    grid = [
        only_shown("slenderness", lambda i: f"x {found.slenderness[i]:.3g}", text=True),
        *(only_shown(f"{eta:.3g}", column.__getitem__) for eta, column in zip(found.restitution, cells, strict=True)),
    ]
    title = "Log-likelihood less the largest, over restitution; * in the region"
    yield table_of(title, grid, range(found.slenderness.size))
    if found.unknown:
        yield (
            f"Caution: at the likeliest point, the outcome of {percent(found.unknown)} of the neighbours is unknown, "
            "and counted as not overturning."
        )


def _data(found: JointRegion, name: str) -> dict[str, Any]:
    slenderness, restitution = found.best
    ranges = dict(zip(("slenderness", "restitution"), map(list, found.ranges), strict=True))
    return {
        "structure": name,
        "tests": found.tests,
        "clusters": found.clusters,
        "neighbours": found.around.count,
        "best": {"slenderness": slenderness, "restitution": restitution},
        "region": {"probability": REGION_PROBABILITY, **ranges},
        "grid": {
            "slenderness": found.slenderness.tolist(),
            "restitution": found.restitution.tolist(),
            "log_likelihood": found.likelihood.tolist(),
            "inside": found.inside.tolist(),
        },
        "unknown": found.unknown,
    }


def draw_region(found: JointRegion, name: str) -> Figure:
    """Draw the likelihood over slenderness and restitution, and the edge of the joint region.

    Parameters
    ----------
    found : JointRegion
        The likelihood.
    name : str
        Name of the structure.
    """
    figure, axes = style.one_panel(
        4.6, f"{name}: slenderness and restitution from {found.tests} tests in {found.clusters} clusters"
    )
    across, up = found.restitution, found.slenderness
    below = np.maximum(found.likelihood - found.likelihood.max(), -20.0)
    inside: dict[str, Any] = {"facecolor": style.SATISFIED, "edgecolor": style.INK, "linewidth": style.BOLD}
    axes.contourf(across, up, below, levels=[-EDGE_DROP, 1.0], colors=[style.SATISFIED])
    for level in (*LOWER, -EDGE_DROP):
        edge = level == -EDGE_DROP
        look: dict[str, Any] = {
            "colors": [style.INK if edge else style.FAINT],
            "linewidths": style.BOLD if edge else style.THIN,
        }
        if below.min() < level:
            line = axes.contour(across, up, below, levels=[level], linestyles="solid", **look)
            if not edge:
                axes.clabel(line, fmt="%g", fontsize=style.SMALL, colors=style.INK)
    points = axes.plot(*(each.ravel() for each in np.meshgrid(across, up)), ".", color=style.FAINT, markersize=2)
    best = axes.plot(*found.best[::-1], color=style.CURSOR, label="likeliest", **style.STAR)
    region = Patch(label=f"joint region of {percent(REGION_PROBABILITY)}", **inside)
    (less,) = axes.plot([], [], color=style.FAINT, linewidth=style.THIN, label="log-likelihood less the largest")
    points[0].set_label("points computed")
    style.legend_below(figure, [*best, region, less, *points])
    style.tidy(axes, "restitution eta", "factor on slenderness")
    return figure


command = Command("region", RegionAsked, region)

if __name__ == "__main__":
    run(command)

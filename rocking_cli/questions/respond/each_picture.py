"""A quantity of many runs against another, such as the peak rotation against the PGA."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking_cli import names
from rocking_cli.ask.answer import parted
from rocking_cli.dynamics.model import ModelName
from rocking_cli.dynamics.outcome import Outcomes
from rocking_cli.errors import InputError, Problem
from rocking_cli.plotting import style
from rocking_cli.questions.respond.each import RunGrid, columns
from rocking_cli.text import did_you_mean

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LABELS = {
    "pga_g": "PGA [g]",
    "pgv": "PGV [m/s]",
    "scale": "scale factor of the motion",
    "restitution": r"restitution $\eta$",
}
BAND = 0.08  # height of the band of runs without a value, over that of the plane
WIDEST_SPREAD = 20.0  # ratio of the largest and the smallest positive value from which an axis is logarithmic
MARK_SIZE = 18.0  # pt2


def draw_each(grid: RunGrid, outcomes: Mapping[ModelName, Outcomes], x: str, y: str) -> Figure:
    """Plot a column of the frame against another, with a mark for each run of the first model.

    Runs whose value is infinite, as the peak of one that overturns, are crosses above the line; runs of unknown outcome
    are open marks, at their value until `known_to`.

    Parameters
    ----------
    grid : RunGrid
        What was combined.
    outcomes : mapping of str to Outcome
        The outcomes by model.
    x, y : str
        Columns of numbers.

    Raises
    ------
    InputError
        If there is no such column of numbers.
    """
    model = next(iter(outcomes))
    values, units = parted(columns(grid, {model: outcomes[model]}))
    numbers = [name for name, each in values.items() if each.dtype != object]
    for argument, asked in (("x", x), ("y", y)):
        if asked not in numbers:
            what = f"must be a column of numbers, got {asked!r}"
            raise InputError(Problem(what, field=f"`{argument}`", hint=did_you_mean(asked, numbers)))
    figure, axes = style.one_panel(4.4, f"{grid.count:,} runs, {model} model")
    across, up = (np.asarray(values[each], dtype=np.float64) for each in (x, y))
    unknown = values["outcome"] == names.UNKNOWN
    above = np.isinf(up)
    top = 1.05 * float(np.nanmax(up[~above], initial=0.0)) or 1.0
    marks = []
    for k, name in enumerate(grid.axes["structure"]):
        mine, look = values["structure"] == name, style.distinct(k)
        dots: dict[str, Any] = {"s": MARK_SIZE, "color": look["color"], "marker": look["marker"], "linewidth": 0.8}
        known = mine & ~unknown & ~above
        marks.append(axes.scatter(across[known], up[known], label=style.plain(str(name)), **dots))
        open_look = dots | {"color": "none", "edgecolor": look["color"]}
        axes.scatter(across[mine & unknown], up[mine & unknown], **open_look)
        high = np.full(int((mine & above).sum()), top * (1 + BAND * (0.25 + 0.5 * _share(k, grid.shape[0]))))
        axes.scatter(across[mine & above], high, **dots | {"marker": "x"})
    peaks = style.over([side.phi_cr is None for each in grid.structures for side in each.statics], math=True)
    labels = LABELS | {"peak_ratio": f"peak {peaks}"}
    style.tidy(axes, *(labels.get(each) or _label(each, units) for each in (x, y)))
    if above.any():
        axes.axhline(top, color=style.FAINT, linewidth=style.THIN)
        above_it = f"above the line: {names.OVERTURNS}"
        marks.append(axes.scatter([], [], marker="x", color=style.INK, s=MARK_SIZE, label=above_it))
        axes.set_ylim(top=top * (1 + BAND))
    if unknown.any():
        open_one = f"open: {names.UNKNOWN}, value until known_to"
        marks.append(axes.scatter([], [], s=MARK_SIZE, color="none", edgecolor=style.INK, label=open_one))
    positive = across[across > 0]
    if positive.size == across.size and positive.max() > WIDEST_SPREAD * positive.min():
        style.logarithmic(axes.xaxis)
    style.legend_below(figure, marks)
    return figure


def _share(k: int, count: int) -> float:
    return k / (count - 1) if count > 1 else 0.5


def _label(name: str, units: Mapping[str, str]) -> str:
    return name.replace("_", " ") + (f" [{units[name]}]" if name in units else "")

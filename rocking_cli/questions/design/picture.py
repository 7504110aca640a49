"""Plot of a design: the metric against the field that varies, and the required level."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rocking_cli.arrays import Reals
from rocking_cli.plotting import style
from rocking_cli.questions.design.study import Aim, Design

LEAST_BELOW = 0.15  # share of the height that words below a star need
HEADROOM = 0.12  # share of the height above the curve
MAX_MARKED_VALUES = 60  # largest number of values of the scan that are marked one by one
MAX_MILLIMETRES = 0.5  # m; shorter lengths are in millimetres
MIN_TONNES = 1e4  # kg; larger masses are in tonnes
LARGER_UNITS = {"N": (1e-3, "kN"), "N/m": (1e-3, "kN/m"), "Pa": (1e-6, "MPa"), "m2": (1e6, "mm2")}
SYMBOLS = {"lambda": "λ", "phi_cr": "φcr"}
LISTS = {"masses": "mass"} | {f"{entry}s": entry for entry in ("tie", "load", "member", "joint", "support")}
OPERATORS = {"<=": "≤", ">=": "≥"}


def draw_design(found: Design) -> Figure:
    """Draw the scan, the level, the ranges in which the requirement holds and the answer.

    Parameters
    ----------
    found : Design
        The result of the search to plot.
    """
    field, metric = field_in_words(found.field), found.aim.metric
    finite = np.isfinite(found.metric)
    of_field, unit = _unit(found.unit, float(np.abs(found.values).max()))
    largest = max(float(np.abs(found.metric[finite]).max(initial=0)), found.aim.level)
    of_metric, metric_unit = _unit(metric.unit, largest)
    aim = _aim(found.aim, of_metric, metric_unit)
    figure, axes = style.one_panel(3.8, f"{found.structure}: {field} for {aim}")
    x, shown = of_field * found.values, np.where(finite, of_metric * found.metric, np.nan)
    for k, (low, high) in enumerate(found.holds):
        label = "satisfied" if k == 0 else None
        axes.axvspan(of_field * low, of_field * high, color=style.SATISFIED, linewidth=0, label=label)
    level = of_metric * found.aim.level
    axes.axhline(level, color=style.EXCEEDED, linewidth=style.BOLD, linestyle="--", label=f"required: {aim}")
    few = finite.sum() <= MAX_MARKED_VALUES
    axes.plot(
        x, shown, color=style.INK, linewidth=style.BOLD, marker="o" if few else "", markersize=3,
        label=f"{len(found.values)} values tried",
    )  # fmt: skip
    _mark_doubts(axes, found, x, shown)
    axes.set_xlim(float(x[0]), float(x[-1]))
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + HEADROOM * (high - low))
    if found.value is not None:
        at = of_field * found.value
        height = float(np.interp(at, x[finite], shown[finite])) if metric.shaken and finite.any() else level
        axes.plot(at, height, color=style.CURSOR, clip_on=False, **style.STAR)
        end = "or more" if found.is_least else "or less"
        _name_answer(axes, (at, height), f"{at:.5g} {unit}".rstrip() + f" {end}", x, shown)
    if metric.name == "overturned":
        style.in_percent(axes.yaxis)
    meaning = metric.meaning.split(",")[0]
    y = f"{meaning} [{metric_unit}]" if metric_unit else meaning
    style.tidy(axes, style.plain(f"{field} [{unit}]" if unit else field), style.folded(y, 2.4, style.LABEL))
    style.legend_below(figure)
    return figure


def field_in_words(field: str) -> str:
    """Return the path of a field in words; entries of lists by their names, or by their numbers.

    Examples
    --------
    >>> field_in_words("width"), field_in_words("ties.bar.prestress"), field_in_words("masses.0.mass")
    ('width', 'prestress of bar', 'mass of mass 0')
    >>> field_in_words("ties.bar.to.at.1")
    'y of at of to of bar'
    """
    *owners, last = (each.strip().replace("_", " ") for each in field.split("."))
    named = [{"0": "x", "1": "y"}.get(last, last)]
    while owners:
        owner = owners.pop()
        if owners and owners[-1] in LISTS:
            kind = LISTS[owners.pop()]
            owner = f"{kind} {owner}" if owner.isdigit() else owner
        named.append(owner)
    return " of ".join(named)


def _unit(unit: str, largest: float) -> tuple[float, str]:
    """Return the unit in which an engineer gives values up to the largest, and how many of it one of `unit` are."""
    if unit == "kg" and largest >= MIN_TONNES:
        return 1e-3, "t"
    if unit == "m":
        return (1e3, "mm") if largest < MAX_MILLIMETRES else (1.0, "m")
    return LARGER_UNITS.get(unit, (1.0, unit))


def _aim(aim: Aim, factor: float, unit: str) -> str:
    """Return a requirement with symbols, and with its level in the unit of the axis."""
    name = SYMBOLS.get(aim.metric.name, aim.metric.name.replace("_", " "))
    level = f"{100 * aim.level:.6g} %" if aim.metric.name == "overturned" else f"{factor * aim.level:.6g} {unit}"
    return f"{name} {OPERATORS.get(aim.op, aim.op)} {level}".rstrip()


def _name_answer(axes: Axes, at: tuple[float, float], text: str, x: Reals, shown: Reals) -> None:
    """Write the answer beside its star: above the level on the side on which the curve is below it, or opposite."""
    there = shown[np.isfinite(shown)]
    right = there.size > 0 and bool(there[-1] < there[0])
    share = (at[0] - x[0]) / (x[-1] - x[0])
    room = style.inches(axes).real * (1 - share if right else share)
    lowest, highest = axes.get_ylim()
    low = at[1] < lowest + LEAST_BELOW * (highest - lowest)
    above = 1 if low or room > style.size_of(text, style.TICK).real + 0.2 else -1
    right = right == (above > 0)
    axes.annotate(
        text, at, (9 if right else -9, 9 * above), textcoords="offset points", ha="left" if right else "right",
        va="bottom" if above > 0 else "top", fontsize=style.TICK, color=style.CURSOR, zorder=7, parse_math=False,
        path_effects=style.HALO,
    )  # fmt: skip


def _mark_doubts(axes: Axes, found: Design, x: Reals, shown: Reals) -> None:
    """Mark values at which some neighbours are of unknown outcome, most overturn, or the metric does not exist."""
    unknown = [neighbours is not None and bool(neighbours.unknown) for neighbours in found.behind]
    doubtful, across = np.array(unknown, dtype=bool), axes.get_xaxis_transform()
    here = doubtful & np.isfinite(shown)
    if here.any():
        axes.plot(
            x[here], shown[here], linestyle="none", marker="D", markersize=5, color=style.PAPER,
            markeredgecolor=style.INK, label="open: some neighbours of unknown outcome, counted as overturning",
        )  # fmt: skip

    for values, height, marker, label in (
        (x[np.isnan(found.metric)], 0.03, "x", "could not be computed"),
        (x[np.isinf(found.metric) & ~doubtful], 0.97, "^", "at least half of the neighbours overturn"),
        (x[np.isinf(found.metric) & doubtful], 0.97, "D", "at least half overturn or are unknown"),
    ):
        if values.size:
            axes.plot(
                values, np.full(values.size, height), marker, transform=across, color=style.FAINT, markersize=5,
                markerfacecolor=style.PAPER if marker == "D" else style.FAINT, label=label,
            )  # fmt: skip

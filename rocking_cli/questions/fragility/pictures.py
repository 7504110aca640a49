"""Draw all that the store of a fragility study holds: curves and surfaces, peak rotations, and rankings."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rocking_cli import names
from rocking_cli.arrays import Bools, Reals
from rocking_cli.ask.watcher import Watcher
from rocking_cli.plotting import style
from rocking_cli.questions.fragility.definition import SCALE
from rocking_cli.questions.fragility.picture import (
    MIN_LOG_RATIO,
    PANEL_HEIGHT,
    draw_curves,
    draw_surface,
    legend_words,
    limit_in_picture,
)
from rocking_cli.questions.fragility.quantiles import MIN_RECORDS, QUANTILES, Quantiles, not_exceeded
from rocking_cli.questions.fragility.ranking import MIN_P_VALUE, Ranking
from rocking_cli.questions.fragility.store import Store
from rocking_cli.questions.fragility.tally import peaks, samples_of
from rocking_cli.questions.fragility.view import limit_name
from rocking_cli.studies.fragility.quantities import label
from rocking_cli.text import numbered

MAX_DRAWN_LADDERS = 300
MAX_NAMED_RECORDS = 11  # more are not told apart by colour and dash
MAX_COUNTED_LEVELS = 15  # with more levels of shaking, not every one is labelled with its counts
BAND_OPACITY = 0.16  # opacity of the area between the lowest quantile and the highest
DASHES = ("--", "-", "-.")
MIN_DRAWN_P_VALUE = 1e-4  # smaller p-values are drawn at this value


def draw_all(folder: Path, answer: Any, watch: Watcher) -> None:
    """Draw the curves of each structure, the comparison of structures, the data behind them, surfaces and rankings."""
    definition, curves = answer.definition, answer.result
    drawn: dict[str, Figure] = {}

    def add(name: str, figure: Figure) -> None:
        drawn[numbered(re.sub(r"[^\w>.]+", "-", name).strip("-").replace(">", "over"), ".png", drawn)] = figure

    structures = list(dict.fromkeys(each.structure for each in curves))
    for measure in definition.fitted_measures:
        these = [each for each in curves if each.measure == measure]
        for structure in structures:
            by_limit = {limit_in_picture(each.limit, math=True): each for each in these if each.structure == structure}
            add(f"{structure} {measure}", draw_curves(by_limit, label(measure), structure))
        for limit in definition.limit_states if len(structures) > 1 else []:
            by_structure = {style.plain(each.structure): each for each in these if each.limit == limit}
            title = limit_in_picture(limit, math=False)
            add(f"{limit_name(limit)} {measure}", draw_curves(by_structure, label(measure), title))
    if definition.method == "ida":
        for structure in structures:
            add(f"{structure} ida", _increments(answer, structure))
    for quantiles in answer.quantiles:
        add(f"{quantiles.structure} {quantiles.measure} quantiles", draw_quantiles(quantiles, label(quantiles.measure)))
    for surface in answer.surfaces:
        one, other = surface.measures
        title = f"{surface.structure}, {limit_in_picture(surface.limit, math=False)}"
        name = f"{surface.structure}, {limit_name(surface.limit)} {one} {other}"
        add(name, draw_surface(surface, (label(one), label(other)), title))
    for ranking in answer.rankings:
        if ranking.measures:
            add(f"{ranking.structure} which measure serves", draw_ranking(ranking))
    with watch.progress(len(drawn), "pictures") as advance:
        for file, figure in drawn.items():
            style.write(folder / file, figure)
            advance(1)
    watch.note(f"wrote {len(drawn)} plots to {folder}")


def _increments(answer: Any, structure: str) -> Figure:
    plan, measure = answer.plan, answer.definition.levels.measure
    across = "factor on the records" if measure == SCALE else label(measure)
    usable = [k for k, each in enumerate(plan.records) if each.reason is None]
    table = peaks(Store.reading(answer.store), plan, structure)
    records, ladders = np.unique(plan.sets.one[usable]).size, len(samples_of(plan, structure)) * plan.block
    named = [plan.records[k].name for k in usable] if ladders == len(plan.levels) else []
    return draw_ida(np.array(plan.levels), table, across, structure, records, named)


def draw_ida(
    intensity: Reals, peaks: Reals, label: str, title: str, records: int | None = None, named: Sequence[str] = ()
) -> Figure:  # fmt: skip
    """Plot the peak rotation of each record against the intensity, with quantiles over the records.

    Parameters
    ----------
    intensity : ndarray, shape (m,)
        Levels of shaking, ascending.
    peaks : ndarray, shape (n, m)
        Peak phi/phi_cr of each record at each level; NaN for overturning, infinite for an unknown outcome.
    label : str
        The measure of intensity, with its unit in brackets.
    title : str
        Heading.
    records : int, optional
        Number of distinct records, which decides which quantiles are drawn; by default that of the rows.
    named : sequence of str
        Names of the rows, if each is a record; a few records have colours and names of their own.

    Returns
    -------
    matplotlib.figure.Figure
        Runs that overturn are shown in a band above the rotations, with their number at each level; so are unknown
        outcomes, which rank below overturning.
    """
    figure, axes = style.one_panel(PANEL_HEIGHT, title)
    fallen, doubtful = np.isnan(peaks), np.isposinf(peaks)
    floor = 1.05 * max(1.0, float(np.max(peaks, initial=0.0, where=np.isfinite(peaks))))  # lower edge of the bands
    high = 0.15 * floor
    places = {names.UNKNOWN: floor + 0.4 * high} if doubtful.any() else {}
    floor += high * len(places)
    top = floor + high
    places[names.OVERTURNS] = middle = floor + 0.4 * high
    axes.axhspan(floor, top, color=style.SHADE, linewidth=0)
    if doubtful.any():
        axes.axhspan(floor - high, floor, **style.UNKNOWN, alpha=0.5)
    peaks = np.where(fallen, middle, np.where(doubtful, places.get(names.UNKNOWN, middle), peaks))
    axes.axhline(1.0, color=style.FAINT, linewidth=style.CURVE)
    some = np.linspace(0, len(peaks) - 1, min(len(peaks), MAX_DRAWN_LADDERS)).round().astype(int)
    ladders = [np.column_stack([intensity, each]) for each in peaks[some]]
    what = "record" if len(peaks) == records else "run of a record"
    name = f"one {what}" if some.size == len(peaks) else f"one {what}, {some.size} drawn"
    looks: list[dict[str, Any]] = [{"colors": style.FAINT, "linewidths": style.THIN, "alpha": 0.8, "label": name}]
    if len(named) == len(peaks) <= MAX_NAMED_RECORDS:
        looks = [
            {"colors": look["color"], "linestyles": look["linestyle"], "linewidths": style.MEDIUM, "label": each}
            for look, each in zip(map(style.distinct, range(1, len(named) + 1)), map(style.plain, named), strict=True)
        ]
    parts = np.array_split(np.array(ladders), len(looks))
    handles: list[Any] = [
        axes.add_collection(LineCollection(list(part), **look)) for part, look in zip(parts, looks, strict=True)
    ]
    records = len(peaks) if records is None else records
    ranked = np.array([not_exceeded(each, records) for each in np.sort(peaks, axis=0).T]).T
    every = max(1, int(np.ceil(intensity.size / MAX_COUNTED_LEVELS)))
    for which, edge in ((fallen, top), (doubtful, floor)):
        for x, count in list(zip(intensity, which.sum(axis=0), strict=True))[::every]:
            if count:
                axes.annotate(f"{count}", (x, edge), xytext=(0, -2), textcoords="offset points", ha="center", va="top",
                              fontsize=style.SMALL)  # fmt: skip
    if intensity[-1] > MIN_LOG_RATIO * intensity[0]:
        style.logarithmic(axes.xaxis)
    axes.set_xlim(float(intensity[0]), float(intensity[-1]))
    axes.set_ylim(0.0, top)
    ticks = np.arange(0.0, 1.1, 0.2)
    axes.set_yticks([*ticks, *places.values()], [*(f"{y:.1f}" for y in ticks), *places])
    style.tidy(axes, label, r"peak rotation $\phi/\phi_{cr}$")
    handles += draw_fractiles(axes, intensity, ranked, ranked >= min(places.values()) * (1 - 1e-9))
    also = f" or are of {names.UNKNOWN} outcome" if doubtful.any() else ""
    handles.append(legend_words(f"numbers: those that overturn{also}, of {len(peaks)}"))
    style.legend_below(figure, handles, 2, grows=True)
    return figure


def draw_quantiles(found: Quantiles, label: str) -> Figure:
    """Plot the quantiles of the peak rotation, and below them the shares that do not uplift, rock, and overturn.

    The share of unknown outcome is hatched.

    Parameters
    ----------
    found : Quantiles
        The quantiles of one structure over one measure.
    label : str
        The measure, with its unit in brackets.

    Returns
    -------
    matplotlib.figure.Figure
        The quantiles are those of all runs. They end with a mark in the band of overturning, or of unknown outcome.
    """
    figure, ((above,), (below,)) = style.panels(4.7, 2, sharex=True, height_ratios=(3, 1.3))
    style.heading(above, f"{found.structure}: peak rotation")
    x = np.array([each.x for each in found.groups])
    if x[-1] > MIN_LOG_RATIO * x[0]:
        style.logarithmic(below.xaxis)
    else:
        below.set_xlim(0.0, 1.03 * x[-1])
    style.tidy(above, y=r"peak rotation $\phi/\phi_{cr}$")
    style.tidy(below, label + ("" if found.stripes else ", means of tenths of the runs"), "runs")
    shares = _draw_shares(below, x, found)
    handles = _draw_peaks(above, x, found)
    style.legend_below(figure, [*shares, *handles], 4, grows=True)
    return figure


def _draw_peaks(axes: Axes, x: Reals, found: Quantiles) -> list[Any]:
    """Draw the quantiles of all runs; return the entries of the legend."""
    every = np.array([each.every for each in found.groups]).T
    beyond = np.isinf(every)
    largest = float(np.max(every, initial=0.0, where=np.isfinite(every)))
    floor = 1.06 * max(1.0, largest) if beyond.any() or largest > 0.5 else 1.15 * max(largest, 1e-3)
    top = 1.12 * floor if beyond.any() else floor
    ticks = np.arange(0.0, floor, 0.2 if floor > 0.5 else floor / 5).tolist()
    if beyond.any():
        axes.axhspan(floor, top, color=style.SHADE, linewidth=0)
        known = not any(any(each.doubtful) for each in found.groups)
        word = names.OVERTURNS if known else f"{names.OVERTURNS}\nor {names.UNKNOWN}"
        axes.set_yticks([*ticks, (floor + top) / 2], [*(f"{y:.2g}" for y in ticks), word])
    axes.set_ylim(0.0, top)
    return draw_fractiles(axes, x, np.where(beyond, (floor + top) / 2, every), beyond)


def draw_fractiles(axes: Axes, x: Reals, peaks: Reals, beyond: Bools) -> list[Line2D]:
    """Draw the quantiles of peak rotations, shape (3, m), on a panel with its final limits.

    A quantile that too few records give is NaN; the label of the axis then says how many are needed. A line ends with a
    mark from where `beyond` lasts to the largest intensity: its run overturns or is of unknown outcome. Returns the
    lines for a legend; none if they are named at the curves.
    """
    axes.fill_between(x, peaks[0], peaks[2], color=style.INK, alpha=BAND_OPACITY, linewidth=0.0)
    lines: list[Line2D] = []
    for share, line, outside, dash in zip(QUANTILES, peaks, beyond, DASHES, strict=True):
        known = ~np.isnan(line)
        if not known.any():
            continue
        at, y, out = x[known], line[known], outside[known]
        end = min(int(np.flatnonzero(~out).max(initial=-1)) + 2, at.size)
        weight = style.BOLD if share == 0.5 else style.MEDIUM
        lines += axes.plot(
            at[:end], y[:end], color=style.INK, linestyle=dash, linewidth=weight, marker=".", markersize=3, zorder=4,
            label="median" if share == 0.5 else f"{100 * share:g} % of runs below",
        )  # fmt: skip
        if out[end - 1]:
            axes.plot(at[end - 1], y[end - 1], color=style.INK, marker="^", markersize=6, zorder=5)
    if np.isnan(peaks).any():
        needs = f"records needed: {min(MIN_RECORDS)} for the median, {max(MIN_RECORDS)} for 16 and 84 %"
        needs = style.folded(needs, style.page_width() - style.MAX_SIDE_MARGIN, style.TICK)
        axes.set_xlabel(f"{axes.get_xlabel()}\n{needs}".strip(), fontsize=style.TICK)
    return lines


def _draw_shares(axes: Axes, x: Reals, found: Quantiles) -> list[Any]:
    """Draw the shares of the runs, stacked; return the legend entries."""
    runs = np.array([each.runs for each in found.groups])
    still, unknown, fallen = (
        np.array([getattr(each, of) for each in found.groups]) / runs for of in ("no_uplift", "unknown", "overturned")
    )
    stack = {
        names.NO_UPLIFT: (still, style.REGIONS[names.NO_UPLIFT]),
        names.ROCKS: (1 - still - unknown - fallen, style.REGIONS[names.ROCKS]),
        names.UNKNOWN: (unknown, style.SHADE),
        names.OVERTURNS: (fallen, style.OVERTURNED),
    }
    if not found.unknown:
        del stack[names.UNKNOWN]
    shares, colors = zip(*stack.values(), strict=True)
    drawn = axes.stackplot(x, *shares, labels=stack, colors=colors, edgecolor=style.INK, linewidth=style.THIN)
    for each in drawn:
        if each.get_label() == names.UNKNOWN:
            each.set_hatch(style.UNKNOWN["hatch"])
            each.set_edgecolor(style.UNKNOWN["edgecolor"])
    axes.set_ylim(0.0, 1.0)
    style.in_percent(axes.yaxis)
    return list(drawn)


def draw_ranking(ranking: Ranking) -> Figure:
    """Draw the measures of a structure, the most efficient on top.

    Parameters
    ----------
    ranking : Ranking
        The ranking, with at least one measure.

    Returns
    -------
    matplotlib.figure.Figure
    """
    measures = ranking.measures
    figure, drawn = style.panels(1.0 + 0.26 * len(measures), 1, 1 + bool(ranking.against), sharey=True)
    panels = drawn.ravel()
    filled = " (filled: residuals show no trend)" if ranking.against else ""
    style.heading(panels[0], f"{ranking.structure}: which measure predicts best{filled}")
    places = np.arange(len(measures))
    for place, each in zip(places, measures, strict=True):
        face = style.INK if each.sufficient else style.PAPER
        panels[0].plot(each.efficiency, place, "o", color=style.INK, markerfacecolor=face, markersize=6)
    panels[0].set_xlim(left=0.0)
    panels[0].set_xlabel(r"efficiency: dispersion of $\ln(\phi/\phi_{cr})$", fontsize=style.LABEL)
    if ranking.against:
        for k, name in enumerate(ranking.against):
            values = np.array([each.trends[name] for each in measures])
            look = style.distinct(k) | {"linestyle": ""}
            panels[1].plot(np.maximum(values, MIN_DRAWN_P_VALUE), places, **look, label=name)
        panels[1].axvline(MIN_P_VALUE, color=style.INK, linewidth=style.MEDIUM, linestyle="--")
        panels[1].set_xlim(MIN_DRAWN_P_VALUE / 1.3, 1.3)
        panels[1].set_xlabel(f"p-value of no trend; trend if below {MIN_P_VALUE:g}", fontsize=style.LABEL)
        style.logarithmic(panels[1].xaxis, (1.0,))
        style.legend_below(figure, grows=True)
    for axes in panels:
        axes.set_yticks(places, [each.measure for each in measures], parse_math=False)
        axes.set_ylim(len(measures) - 0.4, -0.6)
        style.tidy(axes)
    return figure

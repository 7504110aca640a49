"""Plots of a study: curves with the observed shares, surfaces, peak rotations, and rankings of measures."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.contour import QuadContourSet
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.transforms import ScaledTranslation

from rocking_cli import names
from rocking_cli.arrays import Bools, Integers, Reals
from rocking_cli.ask.watcher import Watcher
from rocking_cli.plotting import style
from rocking_cli.questions.fragility.assess import Bivariate, Fragility
from rocking_cli.questions.fragility.curves import FragilityCurve, Surface
from rocking_cli.questions.fragility.definition import SCALE, Definition, Limit
from rocking_cli.questions.fragility.observed import MIN_RELIABLE_RECORDS, Observations
from rocking_cli.questions.fragility.quantiles import MIN_RECORDS, QUANTILES, Quantiles, not_exceeded
from rocking_cli.questions.fragility.ranking import MIN_P_VALUE, Ranking
from rocking_cli.questions.fragility.store import Store
from rocking_cli.questions.fragility.tally import peaks, samples_of
from rocking_cli.questions.fragility.view import limit_name
from rocking_cli.studies.fragility.quantities import label
from rocking_cli.text import numbered

MIN_LOG_RATIO = 30.0  # ratio of the ends of an axis from which it is logarithmic
CURVE_POINTS = 400
PANEL_HEIGHT = 3.6  # inches of a panel with its axes, without the legend
ASIDE, MARK_ROOM = 4.0, 5.0  # points between the marks of two curves at one intensity, and beside them
BAND_OPACITY = 0.18  # opacity of the band of a single curve; the bands of several are paler
EDGE_OPACITY = 0.6
HATCH_OPACITY = 0.4
HATCHES = ("////", "\\\\\\\\", "||||", "----")
MAX_DRAWN_RUNS = 3000  # runs that are drawn one by one
CONTOUR_LEVELS = (0.1, 0.25, 0.5, 0.75, 0.9)  # probabilities of the contours
EDGE_LABELS = (f"if {names.UNKNOWN} runs exceed", f"if {names.UNKNOWN} runs do not")
LABEL_FREE_MARGIN = 0.08  # share of the plane at its edges without names of contours


def edges(name: str, found: Fragility) -> dict[str, Fragility]:
    """Return a curve, or both edges of a band, by their names."""
    if not found.is_band or found.lower is None:
        return {name: found}
    return {f"{name}, {word}": edge for word, edge in zip(EDGE_LABELS, (found, found.lower), strict=True)}


def draw_curves(drawn: Mapping[str, Fragility], across: str, title: str, *, of: str = "records") -> Figure:
    """Plot fragility curves over their bands, and the observed shares of runs that exceed, with their intervals.

    Parameters
    ----------
    drawn : mapping of str to Fragility
        Several limit states of one structure, or several structures for one limit state, by their names, with
        mathematics between dollars and other dollars escaped. Bands between two curves are hatched.
    across : str
        The measure of intensity, with its unit in brackets.
    title : str
        Heading.
    of : str
        What the intervals count.

    Returns
    -------
    matplotlib.figure.Figure
        Observed shares of several curves are beside one another. Intensities whose marks would lie on each other share
        a mark. A curve that is known exactly has no marks.
    """
    figure, axes = style.one_panel(PANEL_HEIGHT, title)
    reach = np.concatenate([each.seen.x for each in drawn.values()])
    start, stop = float(reach.min()), float(reach.max())
    if stop > MIN_LOG_RATIO * start:
        fine = np.geomspace(start / 1.1, stop * 1.1, CURVE_POINTS)
        style.logarithmic(axes.xaxis)
    else:
        fine = np.linspace(0.0, stop * 1.05, CURVE_POINTS)
    axes.set_xlim(fine[0], fine[-1])
    axes.set_ylim(-0.03, 1.06 if len(drawn) > 1 else 1.1)
    style.in_percent(axes.yaxis)
    style.tidy(axes, across, "probability of exceedance")
    unit = "".join(re.findall(r"(?<= \[)[^\]]+(?=\]$)", across))
    handles: list[Any] = []
    for k, (name, each) in enumerate(drawn.items()):
        look, both = style.distinct(k), edges(name, each)
        hatch, opacity = HATCHES[k % len(HATCHES)], BAND_OPACITY / len(drawn) ** 0.5
        _draw_band(axes, [edge.curve for edge in both.values()], look, fine, hatch, opacity)
        for (words, edge), weight in zip(both.items(), (style.BOLD, style.MEDIUM), strict=False):
            curve, look = edge.curve, look | {"linewidth": weight}
            if curve.kind != "none":
                x = _with_steps(fine, [curve])
                axes.plot(x, curve.probability(x), label=name, **look | {"marker": "none", "zorder": 3})
            without = {"linestyle": "none"} if curve.kind == "none" else {"marker": "none"} if curve.is_exact else {}
            words = _unbroken(f"{words}: {_in_words(curve, unit)}")
            handles.append(Line2D([], [], label=words, **look | without | {"markerfacecolor": style.PAPER}))
    observed = [(each, style.distinct(k)) for k, each in enumerate(drawn.values()) if not each.curve.is_exact]
    merged = [_draw_observed(axes, *each, place, len(observed)) for place, each in enumerate(observed)]
    if shares := [f"{name} {names.percent(each.share or 0.0)}" for name, each in drawn.items() if each.is_band]:
        words = _unbroken(f"runs of {names.UNKNOWN} outcome: {', '.join(shares)}")
        handles.append(Patch(**style.UNKNOWN, label=words))
    if remark := _remark(drawn, of, len(observed), merged=any(merged)):
        handles.append(legend_words(remark))
    style.legend_below(figure, handles, 1, handlelength=4 if len(handles) > 1 else 0, alignment="left", grows=True)
    return figure


def limit_in_picture(limit: Limit, *, math: bool) -> str:
    """Return a limit state as a plot writes it: as mathematics or, in a heading, in plain characters."""
    if not isinstance(limit, float):
        return limit_name(limit)
    return rf"$\phi > {limit:g}\,\phi_{{cr}}$" if math else f"φ > {limit:g} φcr"


def _in_words(curve: FragilityCurve, unit: str) -> str:
    """Return the numbers of a curve, as the table has them, or why there is none."""
    unit = unit and f" {unit}"
    if curve.kind == "none":
        return f"no curve, {style.plain(curve.why)}"
    if curve.step is not None:
        low, high = curve.step.low, curve.step.high
        return f"{low:.4g}{unit}, exact" if curve.is_exact else f"step in the shade, {low:.3g} to {high:.3g}{unit}"
    assert curve.median is not None
    words = "" if curve.kind == "lognormal" else f"{curve.kind}, "
    words += f"median {curve.median.value:.3g}{unit} ({curve.median.low:.3g} to {curve.median.high:.3g})"
    for name, spread in (("dispersion", curve.dispersion), ("scale", curve.scale)):
        if spread is not None:
            words += f", {name} {spread.value:.2g} ({spread.low:.2g} to {spread.high:.2g})"
    return words + (", no confidence band" if curve.unbounded else "")


def _remark(drawn: Mapping[str, Fragility], of: str, observed: int, *, merged: bool) -> str:
    """Return the line that explains bands, bars and marks, and says if there are few records."""
    every = [edge.curve for name, each in drawn.items() for edge in edges(name, each).values()]
    fits = [curve for curve in every if curve.fit is not None]
    parts = []
    if observed:
        parts.append(f"{'bands and ' if fits else ''}bars: {100 * every[0].confidence:.3g} % confidence")
        beside = ", side by side" if observed > 1 else ""
        parts.append(f"marks: observed shares{beside}{', of neighbouring intensities together' if merged else ''}")
    return "; ".join([*parts, *_few(fits, of)])


def _few(fits: Sequence[FragilityCurve | Surface], of: str) -> list[str]:
    """Return words on fits of few records, if there are any."""
    fewest = min((each.records for each in fits if each.fit is not None), default=MIN_RELIABLE_RECORDS)
    return [f"only {fewest} {of}: a rough guide"] if fewest < MIN_RELIABLE_RECORDS else []


def _unbroken(text: str) -> str:
    """Keep numbers and their signs in one line."""
    return text.replace(" %", "\u00a0%")


def legend_words(text: str) -> Line2D:
    """Return an entry of a legend without a handle."""
    return Line2D([], [], linestyle="none", label=_unbroken(text))


def _draw_observed(axes: Axes, each: Fragility, look: dict[str, Any], place: int, beside: int) -> bool:
    """Mark observed shares with their intervals, beside those of other curves; return whether intensities share a mark.

    For a band, both edges are marked, and the interval covers both.
    """
    marks, gap = _marks(axes, each.seen, ASIDE * (beside - 1) + MARK_ROOM)
    both = [edge.seen.parts(each.curve.confidence, marks) for edge in edges("", each).values()]
    seen, least = both[0], both[-1]
    sure = [other.probability(seen.x) for other in each.curve.implied.values() if other.is_exact]
    low, high = np.minimum(least.low, seen.low), np.min([np.maximum(least.high, seen.high), *sure], axis=0)
    aside = ASIDE * (place - (beside - 1) / 2) / style.POINTS_PER_INCH
    moved = axes.transData + ScaledTranslation(aside, 0, axes.figure.dpi_scale_trans)
    axes.vlines(seen.x, low, high, color=look["color"], linewidth=style.CURVE, alpha=0.6, transform=moved)
    for parts in both:
        axes.plot(
            seen.x, parts.part, linestyle="none", marker=look["marker"], color=look["color"], markersize=4,
            markerfacecolor=style.PAPER, zorder=4, transform=moved,
        )  # fmt: skip
    counts = [
        f"{n}/{m}" if n == k else f"{k}-{n}/{m}"
        for n, k, m in zip(seen.exceeding, least.exceeding, seen.runs, strict=True)
    ]
    widest = max(style.size_of(count, style.SMALL).real for count in counts) * style.POINTS_PER_INCH
    for x, top, count in zip(seen.x, high, counts, strict=True) if beside == 1 and widest < gap else ():
        axes.annotate(
            count, (x, top), xytext=(0, 2), textcoords="offset points", ha="center", fontsize=style.SMALL,
            color=style.INK,
        )  # fmt: skip
    return bool(marks.max() < each.seen.group.max())


def _marks(axes: Axes, seen: Observations, least: float) -> tuple[Integers, float]:
    """Return the mark of each group of runs, and the smallest gap of two marks.

    Neighbouring groups share a mark, the closest first, until no gap is less than `least` [pt].
    """
    width = style.page_width() - style.MAX_SIDE_MARGIN if style.given() is None else style.inches(axes).real
    marks = np.arange(int(seen.group.max()) + 1)
    while True:
        x = seen.parts(0.95, marks).x
        shares = (axes.transScale + axes.transLimits).transform(np.column_stack([x, x]))[:, 0]
        gaps = np.diff(shares * width * style.POINTS_PER_INCH).round(2)  # of equal gaps the first, despite rounding
        if gaps.min(initial=np.inf) >= least:
            return marks, float(gaps.min(initial=np.inf))
        marks[marks > gaps.argmin()] -= 1


def _with_steps(fine: Reals, curves: Collection[FragilityCurve]) -> Reals:
    """Add both sides of every step of some curves to the intensities at which they are drawn."""
    ends = [end for curve in curves for step in curve.steps for end in (step.low, step.value, step.high)]
    return np.sort(np.concatenate([fine, *([np.nextafter(at, 0), np.nextafter(at, np.inf)] for at in ends)]))


def _draw_band(
    axes: Axes, curves: Collection[FragilityCurve], look: dict[str, Any], fine: Reals, hatch: str, opacity: float
) -> None:
    """Shade the confidence band of a curve, or of both edges of a band; hatch the area between the edges.

    Where an edge does not exist, the area reaches to 1 or 0.
    """
    fine = _with_steps(fine, curves)
    values: list[Reals] = []
    limits: list[Reals] = []
    for curve, without in zip(curves, (1.0, 0.0), strict=False):
        exists = curve.kind != "none"
        values.append(curve.probability(fine) if exists else np.full(fine.size, without))
        limits += curve.band(fine) if exists and not curve.unbounded else []
    if len(curves) > 1:
        hatched = style.UNKNOWN | {"edgecolor": look["color"], "hatch": hatch, "alpha": HATCH_OPACITY}
        axes.fill_between(fine, np.minimum(*values), np.maximum(*values), **hatched)
        limits += values
    if limits:
        ends = np.min(limits, axis=0), np.max(limits, axis=0)
        axes.fill_between(fine, *ends, color=look["color"], alpha=opacity, linewidth=0.0)
        rim = {"color": look["color"], "alpha": EDGE_OPACITY, "linewidth": style.HAIR}
        axes.add_collection(LineCollection([np.column_stack([fine, end]) for end in ends], **rim), autolim=False)


def draw_surface(found: Bivariate, labels: tuple[str, str], title: str) -> Figure:
    """Plot runs in the plane of two intensities, with contours of the probability of exceedance.

    Parameters
    ----------
    found : Bivariate
        The runs, and the fitted surface.
    labels : tuple of str
        The two measures, with their units in brackets.
    title : str
        Heading.

    Returns
    -------
    matplotlib.figure.Figure
        Of many runs, only every n-th is drawn. If many are of unknown outcome, grey contours show the surface in which
        these count as not exceeding.
    """
    figure, axes = style.one_panel(1.1 * PANEL_HEIGHT, title)
    least = found.lower or found
    circles: dict[str, Any] = {"s": 14, "facecolors": "none", "linewidths": style.CURVE}
    kinds: list[tuple[Integers, str, dict[str, Any]]] = [
        (found.runs - found.exceeding, "does not exceed", circles | {"edgecolors": style.SPARED}),
        (least.exceeding, "exceeds", {"s": 16, "marker": "x", "color": style.EXCEEDED, "linewidths": style.MEDIUM}),
        (found.exceeding - least.exceeding, f"{names.UNKNOWN} outcome",
         circles | {"marker": "D", "edgecolors": style.FAINT}),
    ]  # fmt: skip
    every = max(1, int(np.ceil(sum(np.count_nonzero(runs) for runs, _, _ in kinds) / MAX_DRAWN_RUNS)))
    handles: list[Any] = []
    for runs, words, look in kinds[: 2 + bool(kinds[2][0].any())]:
        there = np.flatnonzero(runs)[::every]
        handles.append(axes.scatter(found.x1[there], found.x2[there], label=f"{words} ({runs.sum()})", **look))
    for axis in (axes.xaxis, axes.yaxis):
        style.logarithmic(axis)
    across, up = (np.geomspace(x.min() / 1.15, x.max() * 1.15, CURVE_POINTS) for x in (found.x1, found.x2))
    if found.is_band:
        handles.append(_contours(axes, least.surface, across, up, style.RECORD_COLOUR, EDGE_LABELS[1]))
    handles.append(_contours(axes, found.surface, across, up, style.INK, EDGE_LABELS[0] if found.is_band else ""))
    notes = [f"one of every {every} runs is drawn"] if every > 1 else []
    handles += [legend_words(each) for each in [*notes, *_few([found.surface], "records")]]
    axes.set_xlim(across[0], across[-1])
    axes.set_ylim(up[0], up[-1])
    style.tidy(axes, labels[0], labels[1])
    style.legend_below(figure, handles, 3, grows=True)
    return figure


def _contours(axes: Axes, surface: Surface, across: Reals, up: Reals, color: str, which: str) -> Line2D:
    """Draw the contours of a surface, and return its entry in the legend."""
    if surface.kind == "none":
        return legend_words(f"no surface{which and f' {which}'}: {style.plain(surface.why)}")
    drawn = axes.contour(
        across, up, surface.probability(*np.meshgrid(across, up)), levels=CONTOUR_LEVELS, colors=color,
        linewidths=[0.8, 0.8, 1.8, 0.8, 0.8], linestyles=["--", "--", "-", "--", "--"],
    )  # fmt: skip
    places = _label_places(drawn, across, up)
    for name in axes.clabel(drawn, manual=places, fmt=lambda level: f"{100 * level:g} %", fontsize=style.TICK):
        name.set_bbox({"facecolor": style.PAPER, "edgecolor": "none", "alpha": 0.8, "pad": 0.5})
        name.set_zorder(6)  # names are drawn above the marks
    return Line2D([], [], color=color, label=f"probability of exceedance{which and f', {which}'}")


def _label_places(drawn: QuadContourSet, across: Reals, up: Reals) -> list[tuple[float, float]]:
    """Return the positions of contour labels, each at another part of its contour and clear of the plot's edges."""
    places = []
    for k, path in enumerate(drawn.get_paths()):
        line = np.asarray(path.vertices, np.float64)
        ends = np.array([[across[0], up[0]], [across[-1], up[-1]]])
        shares = np.log(line / ends[0]) / np.log(ends[1] / ends[0])
        inside = line[(np.abs(shares - 0.5) < 0.5 - LABEL_FREE_MARGIN).all(axis=1)]
        if len(inside):
            x, y = inside[int((k + 0.5) / len(CONTOUR_LEVELS) * len(inside))].tolist()
            places.append((x, y))
    return places


MAX_DRAWN_LADDERS = 300
MAX_NAMED_RECORDS = 11  # more are not told apart by colour and dash
MAX_COUNTED_LEVELS = 15  # with more levels of shaking, not every one is labelled with its counts
QUANTILE_OPACITY = 0.16  # opacity of the area between the lowest quantile and the highest
DASHES = ("--", "-", "-.")
MIN_DRAWN_P_VALUE = 1e-4  # smaller p-values are drawn at this value


def draw_study(definition: Definition, curves: Sequence[Fragility]) -> Figure:
    """Plot all curves of a study over its first measure."""
    measure = definition.fitted_measures[0]
    lines = {
        f"{style.plain(each.structure)}, {limit_in_picture(each.limit, math=True)}": each
        for each in curves
        if each.measure == measure
    }
    return draw_curves(lines, label(measure), "")


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
    lines for a legend.
    """
    axes.fill_between(x, peaks[0], peaks[2], color=style.INK, alpha=QUANTILE_OPACITY, linewidth=0.0)
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
    style.heading_of_all(figure, f"{ranking.structure}: which measure predicts best{filled}")
    places = np.arange(len(measures))
    for place, each in zip(places, measures, strict=True):
        face = style.INK if each.sufficient else style.PAPER
        panels[0].plot(each.efficiency, place, "o", color=style.INK, markerfacecolor=face, markersize=6)
    panels[0].set_xlim(0.0, 1.06 * measures[-1].efficiency)
    style.tidy(panels[0], r"efficiency: dispersion of $\ln(\phi/\phi_{cr})$")
    if ranking.against:
        for k, name in enumerate(ranking.against):
            values = np.array([each.trends[name] for each in measures])
            look = style.distinct(k) | {"linestyle": ""}
            panels[1].plot(np.maximum(values, MIN_DRAWN_P_VALUE), places, **look, label=name)
        panels[1].axvline(MIN_P_VALUE, color=style.INK, linewidth=style.MEDIUM, linestyle="--")
        panels[1].set_xlim(MIN_DRAWN_P_VALUE / 1.3, 1.3)
        style.tidy(panels[1], f"p-value of no trend; trend if below {MIN_P_VALUE:g}")
        style.logarithmic(panels[1].xaxis, (1.0,))
        style.legend_below(figure, grows=True)
    for axes in panels:
        axes.set_yticks(places, [each.measure for each in measures], parse_math=False)
        axes.set_ylim(len(measures) - 0.4, -0.6)
    return figure

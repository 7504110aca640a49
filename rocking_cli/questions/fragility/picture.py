"""Plots of fragility curves with the observed shares, and of fragility surfaces."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
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
from rocking_cli.arrays import Integers, Reals
from rocking_cli.plotting import style
from rocking_cli.questions.fragility.assess import Bivariate, Fragility
from rocking_cli.questions.fragility.curves import FragilityCurve, Surface
from rocking_cli.questions.fragility.definition import Limit
from rocking_cli.questions.fragility.observed import MIN_RELIABLE_RECORDS, Observations
from rocking_cli.questions.fragility.view import limit_name

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


def draw_curves(drawn: Mapping[str, Fragility], label: str, title: str, *, of: str = "records") -> Figure:
    """Plot fragility curves over their bands, and the observed shares of runs that exceed, with their intervals.

    Parameters
    ----------
    drawn : mapping of str to Fragility
        Several limit states of one structure, or several structures for one limit state, by their names, with
        mathematics between dollars and other dollars escaped. Bands between two curves are hatched.
    label : str
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
    style.tidy(axes, label, "probability of exceedance")
    unit = "".join(re.findall(r"(?<= \[)[^\]]+(?=\]$)", label))
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
            words = _unbroken(f"{words}: {_in_words(curve, unit, stop)}")
            handles.append(Line2D([], [], label=words, **look | without | {"markerfacecolor": style.PAPER}))
    observed = {k: each for k, each in enumerate(drawn.values()) if not each.curve.is_exact}
    merged = [
        _draw_observed(axes, each, style.distinct(k), place, len(observed))
        for place, (k, each) in enumerate(observed.items())
    ]
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


def _in_words(curve: FragilityCurve, unit: str, most: float) -> str:
    """Return the numbers of a curve, or why there is none; an intensity beyond the largest of the data has none."""
    unit = unit and f" {unit}"
    if curve.kind == "none":
        return f"no curve, {style.plain(curve.why)}"
    if curve.step is not None:
        low, high = curve.step.low, curve.step.high
        return f"{low:.4g}{unit}, exact" if curve.is_exact else f"step in the shade, {low:.3g} to {high:.3g}{unit}"
    assert curve.median is not None

    def within(value: float) -> str:
        return f"{value:.3g}" if value <= most else f"above {most:.3g}"

    words = "" if curve.kind == "lognormal" else f"{curve.kind}, "
    words += f"median {within(curve.median.value)}{unit}"
    if curve.median.low <= most:
        upper = f" to {within(curve.median.high)}" if curve.median.value <= most else ""
        words += f" ({'' if upper else 'from '}{curve.median.low:.3g}{upper})"
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
        return Line2D(
            [], [], linestyle="none", label=_unbroken(f"no surface{which and f' {which}'}: {style.plain(surface.why)}")
        )
    drawn = axes.contour(
        across, up, surface.probability(*np.meshgrid(across, up)), levels=CONTOUR_LEVELS, colors=color,
        linewidths=[0.8, 0.8, 1.8, 0.8, 0.8], linestyles=["--", "--", "-", "--", "--"],
    )  # fmt: skip
    for name in axes.clabel(
        drawn, manual=_label_places(drawn, across, up), fmt=lambda level: f"{100 * level:g} %", fontsize=style.TICK
    ):
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

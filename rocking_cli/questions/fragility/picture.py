"""Plots of fragility curves with observations, of incremental dynamic analyses, and of fragility surfaces."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from textwrap import wrap
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.contour import QuadContourSet
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from rocking_cli import names
from rocking_cli.plotting import style
from rocking_cli.questions.fragility.assess import Bivariate, Fragility
from rocking_cli.questions.fragility.curves import FragilityCurve, Surface
from rocking_cli.questions.fragility.observed import Observations
from rocking_cli.questions.fragility.own_fit import FittedFragility
from rocking_cli.questions.fragility.quantiles import MIN_RECORDS

Reals = NDArray[np.float64]
Integers = NDArray[np.int64]
MIN_LOG_RATIO = 30.0  # ratio of the ends of an axis from which it is logarithmic
CURVE_POINTS = 400
MAX_MARKS = {True: 25, False: 10}  # observed shares of a single curve (True), and of each of several (False)
MAX_FILLED_BANDS = 2  # if there are more bands, only their edges are drawn
BAND_OPACITY = 0.14
LEGEND_BAND_WIDTH = 0.35  # inches; width of a band between two curves in the legend
HATCH_OPACITY = 0.4
HATCHES = ("////", "\\\\\\\\", "||||", "----")
MAX_LEGEND_LINE = 96  # characters
MAX_DRAWN_RUNS = 3000  # runs and records that are drawn one by one
MAX_DRAWN_LADDERS = 300
CONTOUR_LEVELS = (0.1, 0.25, 0.5, 0.75, 0.9)  # probabilities of the contours
EDGE_LABELS = (f"if {names.UNKNOWN} runs exceed", f"if {names.UNKNOWN} runs do not")
FRACTILES = ((0.16, "16 %"), (0.5, "median"), (0.84, "84 %"))
LABEL_FREE_MARGIN = 0.08  # share of the plane at its edges without names of contours
MAX_COUNTED_LEVELS = 15  # with more levels of shaking, not every one is labelled with its counts


@dataclass(frozen=True, eq=False)
class LabelledCurve:
    """One curve of a plot, or a band between two curves.

    Parameters
    ----------
    name : str
        The limit state, or the structure.
    curve : FragilityCurve
        The fitted curve.
    observations : Observations
        The runs.
    lower : LabelledCurve, optional
        The lower edge of a band: undecided runs count as exceeding in `curve`, and as not exceeding in `lower`.
    share : float
        Share of the runs that are of unknown outcome.
    """

    name: str
    curve: FragilityCurve
    observations: Observations
    lower: LabelledCurve | None = None
    share: float = 0.0

    @classmethod
    def of(cls, name: str, found: Fragility) -> LabelledCurve:
        """Return the curve of a result, or its band if many runs are of unknown outcome."""
        if not found.is_band or found.lower is None:
            return cls(name, found.curve, found.seen)
        return cls(name, found.curve, found.seen, cls.of(name, found.lower), found.share or 0.0)

    @property
    def edges(self) -> list[LabelledCurve]:
        """The curve, or both edges of the band."""
        return [self] if self.lower is None else [self, self.lower]


def draw_curves(drawn: Sequence[LabelledCurve], label: str, title: str) -> Figure:
    """Plot fragility curves with their bands, and the observed shares of runs that exceed, with their intervals.

    Parameters
    ----------
    drawn : sequence of LabelledCurve
        Several limit states of one structure, or several structures for one limit state. Bands between two curves are
        hatched.
    label : str
        The measure of intensity, with its unit in brackets.
    title : str
        Heading.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = style.one_panel(4.6 + LEGEND_BAND_WIDTH * sum(each.lower is not None for each in drawn), title)
    reach = np.concatenate([each.observations.x for each in drawn])
    start, stop = float(reach.min()), float(reach.max())
    if stop > MIN_LOG_RATIO * start:
        fine = np.geomspace(start / 1.1, stop * 1.1, CURVE_POINTS)
        style.logarithmic(axes.xaxis)
    else:
        fine = np.linspace(0.0, stop * 1.05, CURVE_POINTS)
    for k, each in enumerate(drawn):
        look = style.distinct(k)
        if each.lower is not None:
            _draw_band(axes, each, look, fine, HATCHES[k % len(HATCHES)], filled=len(drawn) <= MAX_FILLED_BANDS)
            _draw_observed(axes, each, look, alone=len(drawn) == 1)
            continue
        _draw_observed(axes, each, look, alone=len(drawn) == 1)
        _draw_curve(axes, each, look, fine, filled=len(drawn) <= MAX_FILLED_BANDS)
    axes.set_xlim(fine[0], fine[-1])
    axes.set_ylim(-0.03, 1.06 if len(drawn) > 1 else 1.1)
    style.in_percent(axes.yaxis)
    style.tidy(axes, label, "probability of exceedance")
    handles: list[Any] = [_key(*edge) for k, each in enumerate(drawn) for edge in _named(each, style.distinct(k))]
    if doubtful := [each for each in drawn if each.lower is not None]:
        shares = ", ".join(f"{each.name} {names.percent(each.share)}" for each in doubtful)
        sentence = f"band between the two curves: runs of {names.UNKNOWN} outcome ({shares})"
        handles.append(Patch(**style.UNKNOWN, label=_lines(sentence)))
    bands = "shades" if len(drawn) <= MAX_FILLED_BANDS else "thin lines"
    marks = f"marks: observed shares; bars and {bands}: {100 * drawn[0].curve.confidence:.3g} % confidence, by record"
    groups = max(int(each.observations.group.max()) + 1 for each in drawn)
    if (every := _every(groups, alone=len(drawn) == 1)) > 1:
        marks += f"; one of every {every} intensities is marked"
    handles += [Line2D([], [], linestyle="none", label=_lines(each)) for each in (marks, *_remarks(drawn))]
    style.legend_below(figure, handles, 1, handlelength=4, alignment="left")
    return figure


def draw_own(found: Mapping[str, FittedFragility]) -> Figure:
    """Plot curves of data of one's own, by their names, with their robust bands and the observed shares."""
    curves = [LabelledCurve.of(style.plain(name), each.robustly) for name, each in found.items()]
    return draw_curves(curves, style.plain(next(iter(found.values())).measure), "")


def _remarks(drawn: Sequence[LabelledCurve]) -> list[str]:
    """Return the warnings about the curves of a plot, each once."""
    drawn = [edge for each in drawn for edge in each.edges]
    unbounded = dict.fromkeys(each.name for each in drawn if each.curve.unbounded)
    steps = dict.fromkeys(each.name for each in drawn if (at := each.curve.step) is not None and at.low < at.high)
    step = (
        f"shade of a step: the interval between two levels, not a confidence band: {', '.join(steps)}" if steps else ""
    )
    open_ = f"no confidence band, as the data do not bound it: {', '.join(unbounded)}" if unbounded else ""
    return list(dict.fromkeys(each for each in (step, *(each.curve.warning for each in drawn), open_) if each))


def _lines(text: str) -> str:
    """Break a text into lines that fit the width of a plot."""
    whole = style.plain(text).replace(" %", "\u00a0%")  # no line break between a number and its sign
    return "\n".join(wrap(whole, MAX_LEGEND_LINE, subsequent_indent="    "))


def _draw_observed(axes: Axes, each: LabelledCurve, look: dict[str, Any], *, alone: bool) -> None:
    """Mark the observed share of each group at the mean intensity, with its interval; faint next to other curves.

    For a band, both edges are marked, and the interval covers both.
    """
    seen, least = (edge.observations.parts(each.curve.confidence) for edge in (each, each.lower or each))
    some = slice(None, None, _every(seen.x.size, alone=alone))
    low, high = np.minimum(least.low, seen.low)[some], np.maximum(least.high, seen.high)[some]
    x = seen.x[some]
    axes.vlines(x, low, high, color=look["color"], linewidth=style.CURVE, alpha=1.0 if alone else 0.4)
    for parts in (seen, least) if each.lower is not None else (seen,):
        axes.plot(
            x, parts.part[some], linestyle="none", marker=look["marker"], color=look["color"], markersize=4.5,
            markerfacecolor="white", zorder=4,
        )  # fmt: skip
    if alone:
        counts = [f"{n}" if n == k else f"{k}-{n}" for n, k in zip(seen.exceeding, least.exceeding, strict=True)]
        for place, n, m, top in zip(x, counts[some], seen.runs[some], high, strict=True):
            axes.annotate(
                f"{n}/{m}", (place, top), xytext=(0, 2), textcoords="offset points", ha="center",
                fontsize=style.SMALL if x.size <= MAX_COUNTED_LEVELS else style.TINY, color=style.INK,
            )  # fmt: skip


def _every(groups: int, *, alone: bool) -> int:
    """Return the step at which groups are marked: each group, or only every second, third, ..."""
    return -(-groups // MAX_MARKS[alone])


def _draw_curve(axes: Axes, each: LabelledCurve, look: dict[str, Any], fine: Reals, *, filled: bool) -> None:
    """Draw a curve over its band, filled or as two edges; for a step, the interval in which it lies."""
    curve = each.curve
    if curve.kind == "none":
        return
    fine = _with_steps(fine, [curve])
    if curve.step is not None:
        axes.axvspan(curve.step.low, curve.step.high, color=look["color"], alpha=BAND_OPACITY, linewidth=0.0)
    elif filled and not curve.unbounded:
        axes.fill_between(fine, *curve.band(fine), color=look["color"], alpha=BAND_OPACITY, linewidth=0.0)
    elif not curve.unbounded:
        for edge in curve.band(fine):
            axes.plot(fine, edge, color=look["color"], linestyle=look["linestyle"], linewidth=style.THIN, zorder=2)
    axes.plot(
        fine, curve.probability(fine), color=look["color"], linestyle=look["linestyle"], linewidth=style.BOLD, zorder=3
    )


def _with_steps(fine: Reals, curves: Sequence[FragilityCurve]) -> Reals:
    """Add both sides of every step of some curves to the intensities at which they are drawn."""
    ends = [end for curve in curves for step in curve.steps for end in (step.low, step.value, step.high)]
    return np.sort(np.concatenate([fine, *([np.nextafter(at, 0), np.nextafter(at, np.inf)] for at in ends)]))


def _draw_band(
    axes: Axes, each: LabelledCurve, look: dict[str, Any], fine: Reals, hatch: str, *, filled: bool
) -> None:  # fmt: skip
    """Hatch the area between two curves, with the confidence limits of both; to 1 or 0 if one does not exist."""
    fine = _with_steps(fine, [edge.curve for edge in each.edges])
    values: list[Reals] = []
    bands: list[Reals] = []
    for edge, without in zip(each.edges, (1.0, 0.0), strict=True):
        if edge.curve.kind == "none":
            values.append(np.full(fine.size, without))
            continue
        values.append(edge.curve.probability(fine))
        if not edge.curve.unbounded:
            bands += edge.curve.band(fine)
    hatched = style.UNKNOWN | {"edgecolor": look["color"], "hatch": hatch, "alpha": HATCH_OPACITY}
    axes.fill_between(fine, np.minimum(*values), np.maximum(*values), **hatched)
    ends = [between([*bands, *values], axis=0) for between in (np.min, np.max)]
    if filled:
        axes.fill_between(fine, *ends, color=look["color"], alpha=BAND_OPACITY, linewidth=0.0)
    else:
        for end in ends:
            axes.plot(fine, end, color=look["color"], linestyle=look["linestyle"], linewidth=style.THIN, zorder=2)
    for edge, width in zip(each.edges, (style.BOLD, style.MEDIUM), strict=True):
        if edge.curve.kind != "none":
            line = edge.curve.probability(fine)
            axes.plot(fine, line, color=look["color"], linestyle=look["linestyle"], linewidth=width, zorder=3)


def _named(each: LabelledCurve, look: dict[str, Any]) -> list[tuple[LabelledCurve, dict[str, Any]]]:
    """Return the legend entries of a curve, or of both edges of a band, with their styles."""
    if each.lower is None:
        return [(each, look)]
    upper, lower = (
        replace(edge, name=f"{each.name}, {word}") for edge, word in zip(each.edges, EDGE_LABELS, strict=True)
    )
    return [(upper, look), (lower, look | {"linewidth": style.MEDIUM})]


def _key(each: LabelledCurve, look: dict[str, Any]) -> Line2D:
    """Return the legend entry of a curve, with its numbers."""
    curve = each.curve
    entry: str = curve.kind
    if curve.kind == "none":
        look = look | {"linestyle": "none"}
        entry = f"no curve: {curve.why}"
    elif curve.step is not None:
        low, high = curve.step.low, curve.step.high
        entry += f", between {low:.3g} and {high:.3g}" if low < high else f" at {low:.4g}, exact"
    elif curve.median is not None:
        entry += f", median {curve.median.value:.3g} ({curve.median.low:.3g} to {curve.median.high:.3g})"
        for name, spread in (("dispersion", curve.dispersion), ("scale", curve.scale)):
            if spread is not None:
                entry += f", {name} {spread.value:.2g} ({spread.low:.2g} to {spread.high:.2g})"
    return Line2D([], [], label=_lines(f"{each.name}: {entry}"), markerfacecolor="white", **look)


def draw_ida(intensity: Reals, peaks: Reals, label: str, title: str, records: int | None = None) -> Figure:
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

    Returns
    -------
    matplotlib.figure.Figure
        Runs that overturn are shown in a band above the rotations, with their number at each level; so are unknown
        outcomes, which rank below overturning.
    """
    figure, axes = style.one_panel(4.6, title)
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
    for each in peaks[some]:
        axes.plot(intensity, each, color=style.FAINT, linewidth=style.THIN, alpha=0.8)
    ranked = np.sort(peaks, axis=0)
    name = "one record" if some.size == len(peaks) else f"one record, {some.size} drawn"
    handles = [Line2D([], [], color=style.FAINT, linewidth=style.THIN, label=name)]
    for k, (fractile, name), fewest in zip((1, 0, 2), FRACTILES, MIN_RECORDS, strict=True):
        if (len(peaks) if records is None else records) < fewest:
            continue
        place = int(np.ceil(fractile * len(ranked))) - 1  # the lowest peak that this share of records does not exceed
        look = style.distinct(k) | {"marker": "none", "linewidth": 2.0}
        line = ranked[place].copy()
        above = line > min(places.values()) * (1 - 1e-9)
        line[1:][above[1:] & above[:-1]] = np.nan  # the line ends at overturning or unknown outcomes
        handles += axes.plot(intensity, line, label=name, **look)
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
    also = f" or\nare of {names.UNKNOWN} outcome" if doubtful.any() else ""
    handles.append(Line2D([], [], linestyle="none", label=f"numbers: records that overturn{also}, of {len(peaks)}"))
    style.legend_below(figure, handles, 5)
    return figure


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
    figure, axes = style.one_panel(4.9, title)
    surface, spared, exceeding = found.surface, found.runs - found.exceeding, (found.lower or found).exceeding
    doubtful = found.exceeding - exceeding
    share = max(sum(int(np.count_nonzero(each)) for each in (spared, exceeding, doubtful)), 1)
    every = int(np.ceil(share / MAX_DRAWN_RUNS))
    handles: list[Any] = [
        axes.scatter(*_some(found, spared, every), s=14, facecolors="none", edgecolors=style.SPARED,
                     linewidths=style.CURVE, label=f"does not exceed ({spared.sum()})"),
        axes.scatter(*_some(found, exceeding, every), s=16, marker="x", color=style.EXCEEDED,
                     linewidths=style.MEDIUM, label=f"exceeds ({exceeding.sum()})"),
    ]  # fmt: skip
    if doubtful.any():
        handles.append(
            axes.scatter(*_some(found, doubtful, every), s=14, marker="D", facecolors="none", edgecolors=style.FAINT,
                         linewidths=style.CURVE, label=f"{names.UNKNOWN} outcome ({doubtful.sum()})")
        )  # fmt: skip
    for axis in (axes.xaxis, axes.yaxis):
        style.logarithmic(axis)
    across, up = (np.geomspace(x.min() / 1.15, x.max() * 1.15, CURVE_POINTS) for x in (found.x1, found.x2))
    band = found.is_band and found.lower is not None
    if band and found.lower is not None:
        handles.append(_contours(axes, found.lower.surface, across, up, style.RECORD_COLOUR, EDGE_LABELS[1]))
    handles.append(_contours(axes, surface, across, up, style.INK, EDGE_LABELS[0] if band else ""))
    notes = [surface.warning] if surface.warning else []
    notes += [f"one of every {every} runs is drawn"] if every > 1 else []
    handles += [Line2D([], [], linestyle="none", label=_lines(each)) for each in notes]
    axes.set_xlim(across[0], across[-1])
    axes.set_ylim(up[0], up[-1])
    style.tidy(axes, labels[0], labels[1])
    columns = 1 if surface.kind == "none" or notes or band else 2
    style.legend_below(figure, handles, columns)
    return figure


def _contours(axes: Axes, surface: Surface, across: Reals, up: Reals, color: str, which: str) -> Line2D:
    """Draw the contours of a surface, and return its entry in the legend."""
    if surface.kind == "none":
        return Line2D([], [], linestyle="none", label=_lines(f"no surface{which and f' {which}'}: {surface.why}"))
    drawn = axes.contour(
        across, up, surface.probability(*np.meshgrid(across, up)), levels=CONTOUR_LEVELS, colors=color,
        linewidths=[0.8, 0.8, 1.8, 0.8, 0.8], linestyles=["--", "--", "-", "--", "--"],
    )  # fmt: skip
    for name in axes.clabel(
        drawn, manual=_label_places(drawn, across, up), fmt=lambda level: f"{100 * level:g} %", fontsize=style.TICK
    ):
        name.set_bbox({"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.5})
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


def _some(found: Bivariate, number: Integers, every: int) -> tuple[Reals, Reals]:
    """Return the two intensities of every n-th of some runs, n being `every`."""
    there = np.flatnonzero(number)[::every]
    return found.x1[there], found.x2[there]

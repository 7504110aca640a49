"""Plots of fragility curves with observations, of incremental dynamic analyses, and of fragility surfaces."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.contour import QuadContourSet
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.transforms import ScaledTranslation
from numpy.typing import NDArray

from rocking_cli import names
from rocking_cli.plotting import style
from rocking_cli.plotting.curve_names import name_curves
from rocking_cli.questions.fragility.assess import Bivariate, Fragility
from rocking_cli.questions.fragility.curves import FragilityCurve, Surface
from rocking_cli.questions.fragility.definition import Limit
from rocking_cli.questions.fragility.observed import MIN_RELIABLE_RECORDS, Observations
from rocking_cli.questions.fragility.own_fit import FittedFragility
from rocking_cli.questions.fragility.quantiles import not_exceeded
from rocking_cli.questions.fragility.quantiles_picture import draw_fractiles
from rocking_cli.questions.fragility.view import limit_name

Reals = NDArray[np.float64]
Integers = NDArray[np.int64]
MIN_LOG_RATIO = 30.0  # ratio of the ends of an axis from which it is logarithmic
CURVE_POINTS = 400
PANEL_HEIGHT = 3.6  # inches of a panel with its axes, without the legend
ASIDE, MARK_ROOM = 4.0, 5.0  # points between the marks of two curves at one intensity, and beside them
BAND_OPACITY = 0.18  # opacity of the band of a single curve; the bands of several are paler
EDGE_OPACITY = 0.6
HATCH_OPACITY = 0.4
HATCHES = ("////", "\\\\\\\\", "||||", "----")
MAX_DRAWN_RUNS = 3000  # runs and records that are drawn one by one
MAX_DRAWN_LADDERS = 300
MAX_NAMED_RECORDS = 11  # more are not told apart by colour and dash
CONTOUR_LEVELS = (0.1, 0.25, 0.5, 0.75, 0.9)  # probabilities of the contours
EDGE_LABELS = (f"if {names.UNKNOWN} runs exceed", f"if {names.UNKNOWN} runs do not")
LABEL_FREE_MARGIN = 0.08  # share of the plane at its edges without names of contours
MAX_COUNTED_LEVELS = 15  # with more levels of shaking, not every one is labelled with its counts


@dataclass(frozen=True, eq=False)
class LabelledCurve:
    """One curve of a plot, or a band between two curves.

    Parameters
    ----------
    name : str
        The limit state, or the structure, with mathematics between dollars and other dollars escaped.
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
    def edges(self) -> dict[str, LabelledCurve]:
        """The curve, or both edges of the band, by their names."""
        if self.lower is None:
            return {self.name: self}
        return {f"{self.name}, {word}": edge for word, edge in zip(EDGE_LABELS, (self, self.lower), strict=True)}


def draw_curves(drawn: Sequence[LabelledCurve], label: str, title: str, *, of: str = "records") -> Figure:
    """Plot fragility curves over their bands, and the observed shares of runs that exceed, with their intervals.

    Parameters
    ----------
    drawn : sequence of LabelledCurve
        Several limit states of one structure, or several structures for one limit state. Bands between two curves are
        hatched.
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
    reach = np.concatenate([each.observations.x for each in drawn])
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
    named: list[Line2D] = []
    handles: list[Any] = []
    for k, each in enumerate(drawn):
        look = style.distinct(k)
        _draw_band(axes, each, look, fine, HATCHES[k % len(HATCHES)], BAND_OPACITY / len(drawn) ** 0.5)
        for (name, edge), weight in zip(each.edges.items(), (style.BOLD, style.MEDIUM), strict=False):
            look |= {"linewidth": weight}
            if edge.curve.kind != "none":
                x = _with_steps(fine, [edge.curve])
                (line,) = axes.plot(x, edge.curve.probability(x), **look | {"marker": "none", "zorder": 3})
                line.set_label(each.name)
                named += [line] if edge is each or each.curve.kind == "none" else []
            handles.append(_key(f"{name}: {_in_words(edge.curve, unit, stop)}", edge.curve, look))
    observed = [k for k, each in enumerate(drawn) if not each.curve.is_exact]
    merged = [
        _draw_observed(axes, drawn[k], style.distinct(k), place, len(observed)) for place, k in enumerate(observed)
    ]
    if len(named) > 1:
        name_curves(axes, named)
    if doubtful := [each for each in drawn if each.lower is not None]:
        shares = ", ".join(f"{each.name} {names.percent(each.share)}" for each in doubtful)
        handles.append(Patch(**style.UNKNOWN, label=_unbroken(f"runs of {names.UNKNOWN} outcome: {shares}")))
    if remark := _remark(drawn, of, len(observed), merged=any(merged)):
        handles.append(_words(remark))
    style.legend_below(figure, handles, 1, handlelength=4 if len(handles) > 1 else 0, alignment="left", grows=True)
    return figure


def draw_own(found: Mapping[str, FittedFragility]) -> Figure:
    """Plot curves of data of one's own, by their names, with their robust bands and the observed shares."""
    curves = [LabelledCurve.of(style.plain(name), each.robustly) for name, each in found.items()]
    return draw_curves(curves, style.plain(next(iter(found.values())).measure), "", of="clusters")


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


def _remark(drawn: Sequence[LabelledCurve], of: str, observed: int, *, merged: bool) -> str:
    """Return the line that explains bands, bars and marks, and says if there are few records."""
    fits = [edge.curve for each in drawn for edge in each.edges.values() if edge.curve.fit is not None]
    parts = []
    if observed:
        parts.append(f"{'bands and ' if fits else ''}bars: {100 * drawn[0].curve.confidence:.3g} % confidence")
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


def _words(text: str) -> Line2D:
    """Return an entry of a legend without a handle."""
    return Line2D([], [], linestyle="none", label=_unbroken(text))


def _draw_observed(axes: Axes, each: LabelledCurve, look: dict[str, Any], place: int, beside: int) -> bool:
    """Mark observed shares with their intervals, beside those of other curves; return whether intensities share a mark.

    For a band, both edges are marked, and the interval covers both.
    """
    marks, gap = _marks(axes, each.observations, ASIDE * (beside - 1) + MARK_ROOM)
    seen, least = (edge.observations.parts(each.curve.confidence, marks) for edge in (each, each.lower or each))
    sure = [other.probability(seen.x) for other in each.curve.implied.values() if other.is_exact]
    low, high = np.minimum(least.low, seen.low), np.min([np.maximum(least.high, seen.high), *sure], axis=0)
    aside = ASIDE * (place - (beside - 1) / 2) / style.POINTS_PER_INCH
    moved = axes.transData + ScaledTranslation(aside, 0, axes.figure.dpi_scale_trans)
    axes.vlines(seen.x, low, high, color=look["color"], linewidth=style.CURVE, alpha=0.6, transform=moved)
    for parts in (seen, least) if each.lower is not None else (seen,):
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
    return bool(marks.max() < each.observations.group.max())


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


def _with_steps(fine: Reals, curves: Sequence[FragilityCurve]) -> Reals:
    """Add both sides of every step of some curves to the intensities at which they are drawn."""
    ends = [end for curve in curves for step in curve.steps for end in (step.low, step.value, step.high)]
    return np.sort(np.concatenate([fine, *([np.nextafter(at, 0), np.nextafter(at, np.inf)] for at in ends)]))


def _draw_band(
    axes: Axes, each: LabelledCurve, look: dict[str, Any], fine: Reals, hatch: str, opacity: float
) -> None:  # fmt: skip
    """Shade the confidence band of a curve, or of both edges of a band; hatch the area between the edges.

    Where an edge does not exist, the area reaches to 1 or 0.
    """
    fine = _with_steps(fine, [edge.curve for edge in each.edges.values()])
    values: list[Reals] = []
    limits: list[Reals] = []
    for edge, without in zip(each.edges.values(), (1.0, 0.0), strict=False):
        if edge.curve.kind == "none":
            values.append(np.full(fine.size, without))
            continue
        values.append(edge.curve.probability(fine))
        limits += [] if edge.curve.unbounded else edge.curve.band(fine)
    if each.lower is not None:
        hatched = style.UNKNOWN | {"edgecolor": look["color"], "hatch": hatch, "alpha": HATCH_OPACITY}
        axes.fill_between(fine, np.minimum(*values), np.maximum(*values), **hatched)
        limits += values
    if limits:
        ends = np.min(limits, axis=0), np.max(limits, axis=0)
        axes.fill_between(fine, *ends, color=look["color"], alpha=opacity, linewidth=0.0)
        rim = {"color": look["color"], "alpha": EDGE_OPACITY, "linewidth": style.HAIR}
        axes.add_collection(LineCollection([np.column_stack([fine, end]) for end in ends], **rim), autolim=False)


def _key(words: str, curve: FragilityCurve, look: dict[str, Any]) -> Line2D:
    """Return the legend entry of a curve, without a mark if it has none."""
    if curve.kind == "none":
        look = look | {"linestyle": "none"}
    if curve.is_exact:
        look = look | {"marker": "none"}
    return Line2D([], [], label=_unbroken(words), **look | {"markerfacecolor": style.PAPER})


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
            {
                "colors": each["color"],
                "linestyles": each["linestyle"],
                "linewidths": style.MEDIUM,
                "label": style.plain(name),
            }
            for each, name in zip(map(style.distinct, range(1, len(named) + 1)), named, strict=True)
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
    handles.append(_words(f"numbers: those that overturn{also}, of {len(peaks)}"))
    style.legend_below(figure, handles, 2, grows=True)
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
    figure, axes = style.one_panel(1.1 * PANEL_HEIGHT, title)
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
    notes = [f"one of every {every} runs is drawn"] if every > 1 else []
    notes += _few([surface], "records")
    handles += [_words(each) for each in notes]
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


def _some(found: Bivariate, number: Integers, every: int) -> tuple[Reals, Reals]:
    """Return the two intensities of every n-th of some runs, n being `every`."""
    there = np.flatnonzero(number)[::every]
    return found.x1[there], found.x2[there]

"""Fragility curves with what was observed, incremental dynamic analyses, and fragility over two intensities."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from textwrap import wrap
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.contour import QuadContourSet
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import PercentFormatter
from numpy.typing import NDArray

from rocking_cli.plotting import style
from rocking_cli.studies.fragility.assess import Bivariate
from rocking_cli.studies.fragility.curves import Curve, Observations

Reals = NDArray[np.float64]
Integers = NDArray[np.int64]
WIDEST = 30.0  # ratio of the ends of an axis from which on it is logarithmic
FINE = 400  # points of a curve
MARKS = {True: 25, False: 10}  # observed parts at most, of one curve alone and of each of several
FILLED = 2  # bands in one picture that are filled: of more the edges are drawn
SHADED = 0.14  # how dark they are
WIDEST_LINE = 96  # characters of a line of the legend
DRAWN_RUNS = 3000  # runs and records that are drawn one by one, at most
DRAWN_LADDERS = 300
LEVELS = (0.1, 0.25, 0.5, 0.75, 0.9)  # probabilities of the contours
FRACTILES = ((0.16, "16 %"), (0.5, "median"), (0.84, "84 %"))
MARGIN = 0.08  # of the plane: without names of contours
CROWDED = 15  # levels of shaking from which on not every one is counted out


@dataclass(frozen=True, eq=False)
class LabelledCurve:
    """One curve of a picture.

    Parameters
    ----------
    name : str
        The limit state, or the structure.
    curve : Curve
        What was fitted.
    observations : Observations
        The runs.
    """

    name: str
    curve: Curve
    observations: Observations


def draw_curves(drawn: Sequence[LabelledCurve], label: str, title: str) -> Figure:
    """Draw curves with their bands, and the observed parts that exceed with intervals that count records.

    Parameters
    ----------
    drawn : sequence of LabelledCurve
        Several limit states of one structure, or several structures for one limit state.
    label : str
        The measure of intensity, with its unit in brackets.
    title : str
        Heading.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = style.new_figure(4.6)
    axes = figure.subplots()
    _head(axes, title)
    reach = np.concatenate([each.observations.x for each in drawn])
    start, stop = float(reach.min()), float(reach.max())
    if stop > WIDEST * start:
        fine = np.geomspace(start / 1.1, stop * 1.1, FINE)
        axes.set_xscale("log")
        style.plain_numbers(axes.xaxis)
    else:
        fine = np.linspace(0.0, stop * 1.05, FINE)
    for k, each in enumerate(drawn):
        look = style.distinct(k)
        _draw_observed(axes, each, look, alone=len(drawn) == 1)
        _draw_curve(axes, each, look, fine, filled=len(drawn) <= FILLED)
    axes.set_xlim(fine[0], fine[-1])
    axes.set_ylim(-0.03, 1.06 if len(drawn) > 1 else 1.1)
    axes.yaxis.set_major_formatter(PercentFormatter(1.0))
    axes.set_xlabel(label, fontsize=style.LABEL)
    axes.set_ylabel("probability of exceedance", fontsize=style.LABEL)
    style.tidy(axes)
    handles = [_key(each, style.distinct(k)) for k, each in enumerate(drawn)]
    bands = "shades" if len(drawn) <= FILLED else "thin lines"
    marks = f"marks: observed shares; bars and {bands}: {100 * drawn[0].curve.confidence:.3g} % confidence, by record"
    most = max(int(each.observations.group.max()) + 1 for each in drawn)
    if (every := _every(most, alone=len(drawn) == 1)) > 1:
        marks += f"; one of every {every} intensities is marked"
    handles += [Line2D([], [], linestyle="none", label=_lines(each)) for each in (marks, *_remarks(drawn))]
    figure.legend(
        handles=handles,
        loc="outside lower center",
        ncols=1,
        fontsize=style.TICK,
        frameon=False,
        handlelength=4,
        alignment="left",
    )
    return figure


def _remarks(drawn: Sequence[LabelledCurve]) -> list[str]:
    """What to be careful about in a picture, each thing once."""
    unbounded = [each.name for each in drawn if each.curve.unbounded]
    steps = [each.name for each in drawn if each.curve.step is not None]
    step = (
        f"shade of a step: the interval between two levels, not a confidence band: {', '.join(steps)}" if steps else ""
    )
    open_ = f"no confidence band, as the data do not bound it: {', '.join(unbounded)}" if unbounded else ""
    return list(dict.fromkeys(each for each in (step, *(each.curve.warning for each in drawn), open_) if each))


def _lines(text: str) -> str:
    """A text in lines that are no wider than a picture."""
    whole = style.plain(text).replace(" %", "\u00a0%")  # a number and its sign stay together
    return "\n".join(wrap(whole, WIDEST_LINE, subsequent_indent="    "))


def _draw_observed(axes: Axes, each: LabelledCurve, look: dict[str, Any], *, alone: bool) -> None:
    """Mark the part that exceeds in each group, at the mean intensity, with its interval; faint beside others."""
    seen = each.observations.parts(each.curve.confidence)
    some = slice(None, None, _every(seen.x.size, alone=alone))
    x, part, low, high = (values[some] for values in (seen.x, seen.part, seen.low, seen.high))
    axes.vlines(x, low, high, color=look["color"], linewidth=style.CURVE, alpha=1.0 if alone else 0.4)
    axes.plot(
        x, part, linestyle="none", marker=look["marker"], color=look["color"], markersize=4.5,
        markerfacecolor="white", zorder=4,
    )  # fmt: skip
    if alone:
        for place, n, m, top in zip(x, seen.exceeding[some], seen.runs[some], high, strict=True):
            axes.annotate(
                f"{n}/{m}", (place, top), xytext=(0, 2), textcoords="offset points", ha="center",
                fontsize=style.SMALL if x.size <= CROWDED else style.TINY, color=style.INK,
            )  # fmt: skip


def _every(groups: int, *, alone: bool) -> int:
    """Of so many groups in a picture each is marked, or only every second, third, ..."""
    return -(-groups // MARKS[alone])


def _draw_curve(axes: Axes, each: LabelledCurve, look: dict[str, Any], fine: Reals, *, filled: bool) -> None:
    """Draw a curve over its band, filled or as its two edges; of a step the interval in which it lies."""
    curve = each.curve
    if curve.kind == "none":
        return
    if curve.step is not None:
        axes.axvspan(curve.step.low, curve.step.high, color=look["color"], alpha=SHADED, linewidth=0.0)
        at = curve.step.value
        fine = np.sort(np.concatenate([fine, [np.nextafter(at, 0), np.nextafter(at, np.inf)]]))
    elif filled and not curve.unbounded:
        axes.fill_between(fine, *curve.band(fine), color=look["color"], alpha=SHADED, linewidth=0.0)
    elif not curve.unbounded:
        for edge in curve.band(fine):
            axes.plot(fine, edge, color=look["color"], linestyle=look["linestyle"], linewidth=style.THIN, zorder=2)
    axes.plot(
        fine, curve.probability(fine), color=look["color"], linestyle=look["linestyle"], linewidth=style.BOLD, zorder=3
    )


def _key(each: LabelledCurve, look: dict[str, Any]) -> Line2D:
    """The entry of a curve in the legend, with its numbers."""
    curve = each.curve
    said: str = curve.kind
    if curve.kind == "none":
        look = look | {"linestyle": "none"}
        said = f"no curve: {curve.why}"
    elif curve.step is not None:
        said += f", between {curve.step.low:.3g} and {curve.step.high:.3g}"
    elif curve.median is not None:
        said += f", median {curve.median.value:.3g} ({curve.median.low:.3g} to {curve.median.high:.3g})"
        for name, spread in (("dispersion", curve.dispersion), ("scale", curve.scale)):
            if spread is not None:
                said += f", {name} {spread.value:.2g} ({spread.low:.2g} to {spread.high:.2g})"
    return Line2D([], [], label=_lines(f"{each.name}: {said}"), markerfacecolor="white", **look)


def draw_ida(intensity: Reals, peaks: Reals, label: str, title: str) -> Figure:
    """Draw the peak rotation of each record over the intensity, and what parts of the records stay below.

    Parameters
    ----------
    intensity : ndarray, shape (m,)
        Levels of shaking, ascending.
    peaks : ndarray, shape (n, m)
        Peak phi/phi_cr of each record at each level; NaN where it overturns.
    label : str
        The measure of intensity, with its unit in brackets.
    title : str
        Heading.

    Returns
    -------
    matplotlib.figure.Figure
        Overturning has a band of its own above the rotations, with the number of records at each level.
    """
    figure = style.new_figure(4.6)
    axes = figure.subplots()
    _head(axes, title)
    fallen = np.isnan(peaks)
    floor = 1.05 * max(1.0, float(np.nanmax(peaks, initial=0.0)))  # of the band
    top = 1.15 * floor
    middle = floor + 0.4 * (top - floor)
    axes.axhspan(floor, top, color=style.SHADE, linewidth=0)
    axes.axhline(1.0, color=style.FAINT, linewidth=style.CURVE)
    some = np.linspace(0, len(peaks) - 1, min(len(peaks), DRAWN_LADDERS)).round().astype(int)
    for each in np.where(fallen, middle, peaks)[some]:
        axes.plot(intensity, each, color=style.FAINT, linewidth=style.THIN, alpha=0.8)
    ranked = np.sort(np.where(fallen, np.inf, peaks), axis=0)
    name = "one record" if some.size == len(peaks) else f"one record, {some.size} drawn"
    handles = [Line2D([], [], color=style.FAINT, linewidth=style.THIN, label=name)]
    for k, (fractile, name) in zip((1, 0, 2), FRACTILES, strict=True):
        place = int(np.ceil(fractile * len(ranked))) - 1  # the lowest peak that so many records do not exceed
        look = style.distinct(k) | {"marker": "none", "linewidth": 2.0}
        line = np.minimum(ranked[place], middle)
        line[1:][np.isinf(ranked[place][1:]) & np.isinf(ranked[place][:-1])] = np.nan  # it ends where it overturns
        handles += axes.plot(intensity, line, label=name, **look)
    every = max(1, int(np.ceil(intensity.size / CROWDED)))
    for x, count in list(zip(intensity, fallen.sum(axis=0), strict=True))[::every]:
        if count:
            axes.annotate(f"{count}", (x, top), xytext=(0, -2), textcoords="offset points", ha="center", va="top",
                          fontsize=style.SMALL)  # fmt: skip
    if intensity[-1] > WIDEST * intensity[0]:
        axes.set_xscale("log")
        style.plain_numbers(axes.xaxis)
    axes.set_xlim(float(intensity[0]), float(intensity[-1]))
    axes.set_ylim(0.0, top)
    axes.set_yticks([*np.arange(0.0, 1.1, 0.2), middle], [*(f"{y:.1f}" for y in np.arange(0.0, 1.1, 0.2)), "overturns"])
    axes.set_xlabel(label, fontsize=style.LABEL)
    axes.set_ylabel(r"peak rotation $\phi/\phi_{cr}$", fontsize=style.LABEL)
    style.tidy(axes)
    handles.append(Line2D([], [], linestyle="none", label=f"numbers: records that overturn, of {len(peaks)}"))
    figure.legend(handles=handles, loc="outside lower center", ncols=5, fontsize=style.TICK, frameon=False)
    return figure


def draw_surface(found: Bivariate, labels: tuple[str, str], title: str) -> Figure:
    """Draw runs in the plane of two intensities, with contours of the probability of exceedance.

    Parameters
    ----------
    found : Bivariate
        The runs, and what was fitted.
    labels : tuple of str
        The two measures, with their units in brackets.
    title : str
        Heading.

    Returns
    -------
    matplotlib.figure.Figure
        Of many runs an even share is drawn.
    """
    figure = style.new_figure(4.9)
    axes = figure.subplots()
    _head(axes, title)
    surface, spared = found.surface, found.runs - found.exceeding
    share = max(int(np.count_nonzero(spared)) + int(np.count_nonzero(found.exceeding)), 1)
    every = int(np.ceil(share / DRAWN_RUNS))
    handles: list[Any] = [
        axes.scatter(*_some(found, spared, every), s=14, facecolors="none", edgecolors=style.SPARED,
                     linewidths=style.CURVE, label=f"does not exceed ({spared.sum()})"),
        axes.scatter(*_some(found, found.exceeding, every), s=16, marker="x", color=style.EXCEEDED,
                     linewidths=style.MEDIUM, label=f"exceeds ({found.exceeding.sum()})"),
    ]  # fmt: skip
    axes.set_xscale("log")
    axes.set_yscale("log")
    across, up = (np.geomspace(x.min() / 1.15, x.max() * 1.15, FINE) for x in (found.x1, found.x2))
    if surface.kind == "none":
        handles.append(Line2D([], [], linestyle="none", label=_lines(f"no surface: {surface.why}")))
    else:
        drawn = axes.contour(
            across, up, surface.probability(*np.meshgrid(across, up)), levels=LEVELS, colors=style.INK,
            linewidths=[0.8, 0.8, 1.8, 0.8, 0.8], linestyles=["--", "--", "-", "--", "--"],
        )  # fmt: skip
        for name in axes.clabel(
            drawn, manual=_label_places(drawn, across, up), fmt=lambda level: f"{100 * level:g} %", fontsize=style.TICK
        ):
            name.set_bbox({"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.5})
            name.set_zorder(6)  # over the marks
        handles.append(Line2D([], [], color=style.INK, label="probability of exceedance"))
    said = [surface.warning] if surface.warning else []
    said += [f"one of every {every} runs is drawn"] if every > 1 else []
    handles += [Line2D([], [], linestyle="none", label=_lines(each)) for each in said]
    for axis in (axes.xaxis, axes.yaxis):
        style.plain_numbers(axis)
    axes.set_xlim(across[0], across[-1])
    axes.set_ylim(up[0], up[-1])
    axes.set_xlabel(labels[0], fontsize=style.LABEL)
    axes.set_ylabel(labels[1], fontsize=style.LABEL)
    style.tidy(axes)
    columns = 1 if surface.kind == "none" or said else 2
    figure.legend(handles=handles, loc="outside lower center", ncols=columns, fontsize=style.TICK, frameon=False)
    return figure


def _label_places(drawn: QuadContourSet, across: Reals, up: Reals) -> list[tuple[float, float]]:
    """Where contours are named: each at another part of its way through the middle of the plane, clear of its edges."""
    places = []
    for k, path in enumerate(drawn.get_paths()):
        line = np.asarray(path.vertices, np.float64)
        ends = np.array([[across[0], up[0]], [across[-1], up[-1]]])
        shares = np.log(line / ends[0]) / np.log(ends[1] / ends[0])
        inside = line[(np.abs(shares - 0.5) < 0.5 - MARGIN).all(axis=1)]
        if len(inside):
            x, y = inside[int((k + 0.5) / len(LEVELS) * len(inside))].tolist()
            places.append((x, y))
    return places


def _some(found: Bivariate, number: Integers, every: int) -> tuple[Reals, Reals]:
    """Where some runs are, one of so many."""
    there = np.flatnonzero(number)[::every]
    return found.x1[there], found.x2[there]


def _head(axes: Axes, title: str) -> None:
    style.heading(axes, title)

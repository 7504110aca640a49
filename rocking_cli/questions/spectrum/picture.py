"""Plot of rocking spectra: peak rotation and angular velocity against the size, and the share that overturns."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import degrees
from textwrap import shorten

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from rocking_cli import names
from rocking_cli.arrays import Reals
from rocking_cli.names import MIN_MOTIONS
from rocking_cli.plotting import style
from rocking_cli.questions.spectrum.study import Spectrum

MAX_NAME_LENGTH = 40  # characters of a structure's name in the legend
MAX_TICKED_RATIO = 8.0  # ratio of the ends of an axis up to which it has more ticks
MAX_SHADED_CURVES = 2  # more shades of the spread of motions cannot be told apart
MAX_OPAQUE_LINES = 20  # with more motions, their lines are transparent
MARK_SIZE = 2.6  # points
END_GAP = 1.02  # factor between the outermost sizes and the ends of the axis
MARK_ROW_HEIGHT = 0.06  # share of the height of the peaks, for a row of marks of overturning or unknown outcomes


def draw_spectra(spectra: Sequence[Spectrum], fractiles: Sequence[float], title: str) -> Figure:
    """Plot spectra against sizes in metres, with given structures marked; for several motions also overturned shares.

    Each computed size has a mark, angular velocities only where the median neither overturns nor is unknown. Open marks
    above the peaks mean unknown outcomes; in the panel of shares, a hatched band includes them. Of the smallest sizes,
    those at which all motions overturn every structure are cut to a few.

    Parameters
    ----------
    spectra : sequence of Spectrum
        The spectra to plot, all under the same motions.
    fractiles : sequence of float
        Fractiles over several motions, 0.5 among them; the outermost bound the shade around the median of one or two
        curves.
    title : str
        Heading.
    """
    many = len(spectra[0].peak_ratio) > 1
    low, high = min(fractiles), max(fractiles)
    ratios = [2.4, 1.2, 1][: 2 + many]
    figure, every = style.panels(7.9 if many else 6.4, 2 + many, sharex=True, height_ratios=ratios)
    panels = every[:, 0]
    style.heading(panels[0], title)
    medians = [each.fractile(0.5) for each in spectra]
    falls = [np.isinf(median) & each.fractile_overturns(0.5) for each, median in zip(spectra, medians, strict=True)]
    doubtful = [np.isinf(median) & ~fall for median, fall in zip(medians, falls, strict=True)]
    rows = [(k, True) for k, some in enumerate(falls) if some.any()]
    rows += [(k, False) for k, some in enumerate(doubtful) if some.any()]
    shaded = (
        many
        and low < high
        and len(spectra) <= MAX_SHADED_CURVES
        and any((each.followed >= MIN_MOTIONS).any() for each in spectra)
    )
    top = _top(spectra, high if shaded else 0.5)
    words, sizes = _sizes(spectra)
    curves = []
    for k, (each, size, median) in enumerate(zip(spectra, sizes, medians, strict=True)):
        if shaded:
            _draw_spread(panels[0], each, size, k, (low, high), top, every=len(spectra) == 1)
        if many:
            _draw_doubt(panels[2], each, size, k)
            _draw_line(panels[2], each, size, k, each.share)
        _draw_line(panels[1], each, size, k, each.fractile(0.5, each.rate_over_p))
        heights = {
            known: top * (1 + MARK_ROW_HEIGHT * (place + 0.5)) for place, (of, known) in enumerate(rows) if of == k
        }
        beyond = np.where(falls[k], heights.get(True, np.nan), heights.get(False, np.nan))
        curves.append(_draw_line(panels[0], each, size, k, median, beyond, doubtful[k]))
        if each.given is not None:
            for axes in panels:
                axes.axvline(size[each.given], color=style.INK, linewidth=style.CURVE, linestyle=":", zorder=1)
    _scale_peaks(panels[0], top, [known for _, known in rows])
    if many:
        panels[2].set_ylim(-0.04, 1.04)
        style.in_percent(panels[2].yaxis)
        panels[2].set_ylabel("share that overturns", fontsize=style.LABEL)
    panels[1].set_ylim(bottom=0.0)
    for axes, what in zip(panels, (r"peak $\phi/\phi_{cr}$", r"peak $\dot\phi/p$ [rad]"), strict=False):
        axes.set_ylabel(f"median {what}" if many else what, fontsize=style.LABEL)
    ends = _ends(spectra, sizes)
    for axes in panels:
        axes.set_xscale("log")
        axes.set_xlim(*ends)
        _log_ticks(axes.xaxis, ends[1] / ends[0])
        style.tidy(axes)
    room = style.page_width() - 1.5 * style.MAX_SIDE_MARGIN
    panels[-1].set_xlabel(style.folded(words, room, style.LABEL), fontsize=style.LABEL)
    _second_axis(panels[0], spectra, sizes, ends)
    handles = _legend(spectra, (low, high) if shaded else None, many=many)
    style.legend_below(figure, [*curves, *handles], handlelength=3.5)
    return figure


def _sizes(spectra: Sequence[Spectrum]) -> tuple[str, list[Reals]]:
    """Return in words what the sizes are, and those of each spectrum [m]: heights of a single structure, or else R."""
    height = spectra[0].shape.height
    if len(spectra) == 1 and height is not None:
        return "height of the structure [m]", [spectra[0].scales * height]
    blocks = all(each.shape.slenderness is not None for each in spectra)
    words = "half of the diagonal, R [m]" if blocks else "half of the diagonal of the block with the same p, R [m]"
    return words, [each.radii for each in spectra]


def _ends(spectra: Sequence[Spectrum], sizes: Sequence[Reals]) -> tuple[float, float]:
    """Return the ends of the axis of sizes: of those at which all motions overturn every structure, few are shown."""
    least = [
        size[max(0, rest - max(1, (size.size - rest) // 4))]
        for each, size in zip(spectra, sizes, strict=True)
        for rest in [int(np.append(each.overturned < np.maximum(each.followed, 1), True).argmax())]
    ]
    given = [size[each.given] for each, size in zip(spectra, sizes, strict=True) if each.given is not None]
    low, high = min([*least, *given]), max(size[-1] for size in sizes)
    return float(low / END_GAP), float(high * END_GAP)


def _top(spectra: Sequence[Spectrum], q: float) -> float:
    """Return the peak at which the scale ends: above those drawn, and at least 1 if a motion overturns."""
    drawn = [each.fractile(q) for each in spectra]
    if len(spectra) == 1:
        drawn.append(spectra[0].peak_ratio.ravel())
    peaks = np.concatenate(drawn)
    finite = peaks[np.isfinite(peaks)]
    highest = float(finite.max()) if finite.size else 0.0
    return max(1.05 * highest, 1.0 if np.isinf(peaks).any() else 0.01)


def _within(each: Spectrum) -> Reals:
    """Return 1 for sizes to join by lines, NaN for a given structure outside the requested range."""
    inside = np.ones(each.scales.size)
    if each.given in (0, each.scales.size - 1):
        inside[each.given] = np.nan
    return inside


def _draw_spread(
    axes: Axes, each: Spectrum, size: Reals, k: int, bounds: tuple[float, float], top: float, *, every: bool
) -> None:
    """Shade between two fractiles, up to the top if the upper one overturns; with `every`, each motion faintly."""
    lower, upper = (np.minimum(each.fractile(q), top) * _within(each) for q in bounds)
    colour = style.distinct(k)["color"]
    axes.fill_between(size, lower, upper, color=colour, alpha=0.15, linewidth=0)
    for edge in (lower, upper):  # each edge is drawn up to overturning
        axes.plot(size, np.where(edge < top, edge, np.nan), color=colour, linewidth=style.MEDIUM, zorder=2.2)
    if every:
        curves = np.where(np.isfinite(each.peak_ratio), each.peak_ratio, np.nan) * _within(each)
        clear = min(1.0, MAX_OPAQUE_LINES / len(curves))  # the fractiles must stay visible above many curves
        axes.plot(size, curves.T, color=style.FAINT, linewidth=style.THIN, alpha=max(clear, 0.1))


def _draw_doubt(axes: Axes, each: Spectrum, size: Reals, k: int) -> None:
    """Hatch up to the share that overturns if all motions of unknown outcome do."""
    if not each.unknown.any():
        return
    look = style.distinct(k)
    low, high = each.share * _within(each), each.share_at_most * _within(each)
    axes.fill_between(size, low, high, alpha=0.4, **(style.UNKNOWN | {"edgecolor": look["color"]}))
    axes.plot(size, high, color=look["color"], linestyle=look["linestyle"], linewidth=style.CURVE)


def _draw_line(
    axes: Axes,
    each: Spectrum,
    size: Reals,
    k: int,
    values: Reals,
    beyond: Reals | float = np.nan,
    doubtful: NDArray[np.bool_] | bool = False,
) -> Line2D:
    """Draw a curve with a mark at each size and the given structure on it; return it.

    Infinite values become marks at the heights `beyond`, open ones if the outcome is unknown.
    """
    name = style.plain(shorten(each.shape.structure.name, MAX_NAME_LENGTH, placeholder=" ..."))
    alpha = each.shape.slenderness
    label = name if alpha is None else rf"blocks, $\alpha$ = {alpha:g} rad = {degrees(alpha):.3g}°"
    look = style.distinct(k) | {"markersize": MARK_SIZE, "linewidth": style.MEDIUM}
    finite = np.where(np.isfinite(values), values, np.nan)
    (curve,) = axes.plot(size, finite * _within(each), label=label, **look)
    small = look | {"linestyle": "none"}
    marks = np.where(np.isinf(values), beyond, np.nan)
    unknown = np.broadcast_to(doubtful, marks.shape)
    axes.plot(size, np.where(unknown, np.nan, marks) * _within(each), **small)
    axes.plot(size, np.where(unknown, marks, np.nan) * _within(each), **small, markerfacecolor=style.PAPER)
    finite = np.where(np.isinf(values), beyond, finite)
    if each.given is not None:
        star = style.STAR | {"color": look["color"], "clip_on": False}
        if unknown[each.given]:
            star |= {"markerfacecolor": style.PAPER, "markeredgecolor": look["color"]}
        axes.plot(size[each.given], finite[each.given], **star)
    return curve


def _scale_peaks(axes: Axes, top: float, rows: Sequence[bool]) -> None:
    """Scale the upper panel: peaks, above them a row for overturning of each curve, then for unknown outcomes."""
    ticks = [tick for tick in MaxNLocator(6).tick_values(0.0, top) if 0 <= tick <= top]
    labels = [f"{tick:g}" for tick in ticks]
    middle, roof = (top * (1 + MARK_ROW_HEIGHT * count) for count in (sum(rows), len(rows)))
    if middle > top:
        axes.axhspan(top, middle, color=style.SHADE, zorder=0)
        ticks.append((top + middle) / 2)
        labels.append(names.OVERTURNS)
    if roof > middle:
        axes.axhspan(middle, roof, zorder=0, **style.UNKNOWN)
        ticks.append((middle + roof) / 2)
        labels.append(names.UNKNOWN)
    axes.set_yticks(ticks, labels)
    axes.set_ylim(-0.02 * top, roof)


def _log_ticks(axis: Axis, ratio: float) -> None:
    """Set ticks in plain numbers on a logarithmic axis whose ends have this ratio."""
    style.plain_numbers(axis, (1.0, 2.0, 5.0) if ratio > MAX_TICKED_RATIO else (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0))


def _second_axis(axes: Axes, spectra: Sequence[Spectrum], sizes: Sequence[Reals], ends: tuple[float, float]) -> None:
    """Add an upper axis of 2 pi/p, which is proportional to the root of R, or is known at the computed heights."""
    to = _between(sizes[0], spectra[0].periods, 0.5)
    above = axes.secondary_xaxis("top", functions=(to, _between(spectra[0].periods, sizes[0], 2.0)))  # type: ignore[arg-type]
    above.set_xlabel(r"$2\pi/p$, with frequency parameter $p$ [s]", fontsize=style.LABEL)
    low, high = to(np.array(ends)).tolist()
    _log_ticks(above.xaxis, high / low)
    above.tick_params(labelsize=style.TICK, colors=style.INK)


def _between(x: Reals, y: Reals, power: float) -> Callable[[Reals], Reals]:
    """Return a function y(x) between points of a curve, linear in logarithms; a power of x beyond them."""
    known = np.log(x)

    def at(values: Reals) -> Reals:
        with np.errstate(divide="ignore", invalid="ignore"):
            place = np.log(values)
        inside = np.clip(place, known[0], known[-1])
        result: Reals = np.exp(np.interp(inside, known, np.log(y)) + power * (place - inside))
        return result

    return at


def _legend(spectra: Sequence[Spectrum], bounds: tuple[float, float] | None, *, many: bool) -> list[Line2D | Patch]:
    handles: list[Line2D | Patch] = []
    if any(each.given is not None for each in spectra):
        handles.append(Line2D([], [], label="as given", color=style.INK, **style.STAR))
    if bounds is not None:
        label = f"{100 * bounds[0]:g} to {100 * bounds[1]:g} % of the motions"
        handles.append(Patch(color=style.INK, alpha=0.15, linewidth=0, label=label))
    if many and any(each.unknown.any() for each in spectra):
        handles.append(Patch(label="hatched up to the thin line: unknown outcome", **style.UNKNOWN))
    if bounds is not None and len(spectra) == 1:
        handles.append(Line2D([], [], color=style.FAINT, linewidth=style.THIN, label="each motion"))
    return handles

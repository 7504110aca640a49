"""Common style of plots: legible in print, in grey, and to colour-blind readers."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from textwrap import shorten
from typing import IO, Any
from warnings import catch_warnings, filterwarnings

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.text import Text
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter, PercentFormatter
from numpy.typing import NDArray

from rocking_cli import names
from rocking_cli.text import printable

PAGE_WIDTH = 7.2  # inches of text
DPI = 150
MAX_SIDE_MARGIN = 0.9  # inches at the sides of a panel
MAX_HEADING_LENGTH = 120  # characters
INK, FAINT, SHADE, GRID = "#222222", "#9a9a9a", "#eeeeee", "#dddddd"
TITLE, LABEL, TICK, SMALL, TINY = 10, 9, 8, 7, 5  # sizes of type [pt]
HAIR, THIN, CURVE, MEDIUM, BOLD = 0.4, 0.6, 0.7, 1.0, 1.6  # weights of line [pt]
LEGEND: dict[str, Any] = {"fontsize": TICK, "frameon": True, "framealpha": 0.9, "edgecolor": "none"}
# Structures: bodies differ in darkness too; marks are black, dimensions blue, thrust lines dashed.
BODIES = ("#dfe6ec", "#f1e2c6", "#c2cdd8")
RESTING_COLOUR = "#f4f3f0"  # colour of parts at rest while the links of a structure move
EARTH, MEASURE = "#8a7f70", "#2b5d86"
CURSOR = "#c4371a"
TRACE: dict[str, Any] = {"color": INK, "linestyle": "-", "linewidth": 0.9}
THRUST: dict[str, Any] = {"color": "#b3541e", "linestyle": (0, (3, 1)), "linewidth": 1.8}
TIE: dict[str, Any] = {"color": "#1d6b4f", "linewidth": 1.3}
SLACK = (0, (2.5, 2))
# Curves differ in darkness, dash and weight as well as in hue; the heaviest is visible behind the others.
LINES = {
    "nonlinear": {"color": "#111111", "linestyle": "-", "linewidth": 1.9},
    "linear1": {"color": "#e08a00", "linestyle": "--", "linewidth": 1.3},
    "linear2": {"color": "#1f77b4", "linestyle": "-.", "linewidth": 0.9},
}
RECORD_COLOUR = "#8a8a8a"  # pale, as bold curves are drawn over it
PULSES: tuple[dict[str, Any], ...] = (
    {"color": "#111111", "linestyle": "-", "linewidth": 2.4},
    {"color": "#e08a00", "linestyle": "--", "linewidth": 2.0},
    {"color": "#1f77b4", "linestyle": "-.", "linewidth": 1.6},
)
LABELS = {"nonlinear": "nonlinear", "linear1": r"linear, $\kappa_1$", "linear2": r"linear, $\kappa_2$"}

# Regions of a plane of pulses, and the boundaries between them.
# From white to dark, so that the order is visible in grey; blue to orange to brown for the colour-blind.
REGIONS = {
    names.NO_UPLIFT: "#ffffff",
    names.ROCKS: "#d6e6f2",
    f"{names.OVERTURNS} after one impact": "#f2b04a",
    f"{names.OVERTURNS} after two or more": "#c46a1b",
    f"{names.OVERTURNS} without impact": "#5b3a55",
    names.UNKNOWN: "#c9c9c9",  # grey, and hatched too
}
BOUNDARIES: dict[str, dict[str, Any]] = {
    "uplift": {"color": "#222222", "linestyle": "-", "linewidth": 1.0},
    "without_impact": {"color": "#000000", "linestyle": "-", "linewidth": 2.0},
    "after_one_impact": {"color": "#000000", "linestyle": (0, (4, 1.5)), "linewidth": 1.6},
    "impact_at_end": {"color": "#000000", "linestyle": (0, (1, 1.5)), "linewidth": 1.3},
}

MARKED: dict[str, Any] = {
    "marker": "o", "markersize": 8, "color": "white", "markeredgecolor": "#000000", "markeredgewidth": 1.8
}  # fmt: skip

STAR: dict[str, Any] = {"marker": "*", "markersize": 15, "markeredgecolor": "white", "linestyle": "none", "zorder": 6}

UNKNOWN: dict[str, Any] = {"facecolor": "none", "edgecolor": FAINT, "hatch": "////", "linewidth": 0.0}
"""The look of areas in which the outcome is not known: hatched in grey."""

SPARED, EXCEEDED = "#1f77b4", "#b35900"  # runs below and above a limit; their marks differ, too

# For any number of curves: dashes and marks distinguish them in grey, and where they overlap.
_DASHES = ("-", "--", "-.", ":", (0, (6, 1, 1, 1, 1, 1)), (0, (3, 1)))
_HUES = ("#111111", "#d98200", "#1f77b4", "#8a3b62", "#3c7d3c", "#777777")
_MARKS = ("o", "s", "^", "D", "v", "P")


def distinct(k: int) -> dict[str, Any]:
    """Return the style of curve number k of several."""
    return {
        "color": _HUES[k % len(_HUES)],
        "linestyle": _DASHES[k % len(_DASHES)],
        "marker": _MARKS[k % len(_MARKS)],
        "markersize": 4.5,
        "linewidth": 1.5,
    }


def family(k: int) -> dict[str, Any]:
    """Return the style of curve number k of a family of at most five, without marks, for small panels."""
    dashes = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)))
    return {"color": ("#111111", "#1f77b4", "#e08a00", "#7b4ea3", "#4a8f3c")[k], "linestyle": dashes[k]}


def new_figure(height: float) -> Figure:
    """Return an empty figure of the common width; `height` in inches."""
    return Figure(figsize=(PAGE_WIDTH, height), dpi=DPI, layout="constrained")


def one_panel(height: float, title: str) -> tuple[Figure, Axes]:
    """Return a new figure of this height [in], and its only panel under a heading."""
    figure = new_figure(height)
    axes = figure.subplots()
    heading(axes, title)
    return figure, axes


def size_of(text: str, points: float, weight: str = "normal") -> complex:
    """Return width and height of a text [inches]; mathematics is between dollars, other dollars are escaped."""
    text = printable(text)  # text as it is written to the file
    math = text.count("$") > text.count(r"\$")
    with catch_warnings():
        filterwarnings("ignore", "Glyph .* missing from", UserWarning)
        width, height, _ = _measure().get_text_width_height_descent(
            text if math else text.replace(r"\$", "$"), FontProperties(size=points, weight=weight), math
        )
    return complex(width, height) / DPI


@cache
def _measure() -> Any:
    return RendererAgg(1, 1, DPI)  # type: ignore[no-untyped-call]


def fitted(text: str, width: float = PAGE_WIDTH - 0.3, points: float = TITLE) -> str:
    """Shorten a text, without mathematics, to the words that fit a width [inches]."""
    for most in range(MAX_HEADING_LENGTH, 10, -5):
        short = shorten(text, most, placeholder=" ...")
        if size_of(plain(short), points).real <= width:
            break
    return short


def heading(axes: Axes, text: str) -> None:
    """Write the title of a plot above its first panel; dollars in names are plain characters."""
    axes.set_title(fitted(text, PAGE_WIDTH - MAX_SIDE_MARGIN), loc="left", fontsize=TITLE, color=INK, parse_math=False)


def over(ends_at_limit: Sequence[bool], *, math: bool = False) -> str:
    """Return the axis label of rotations divided by the critical rotation.

    In directions without a critical rotation, rotations are divided by the kinematic limit, and the label says so.
    """
    label = "φ/limit" if all(ends_at_limit) else "φ/φcr or limit" if any(ends_at_limit) else "φ/φcr"
    return label.replace("φcr", r"$\phi_{cr}$").replace("φ", r"$\phi$") if math else label


def plain(text: str) -> str:
    """Escape dollars in a text, so that they are not read as mathematics."""
    return text.replace("$", r"\$")


def save(figure: Figure, stream: IO[Any], **options: Any) -> None:
    """Write a figure; characters that an SVG file cannot hold are spelled out.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        The figure to write.
    stream : file
        Stream to write to.
    **options
        Options of `Figure.savefig`.
    """
    for each in figure.findobj(Text):
        if isinstance(each, Text) and each.get_text() != printable(each.get_text()):
            each.set_text(printable(each.get_text()))
    with catch_warnings():
        filterwarnings("ignore", "Glyph .* missing from", UserWarning)  # a missing glyph is drawn as an empty box
        figure.savefig(stream, **options)


def note(axes: Axes, text: str, height: float = 0.96) -> None:
    """Write a remark at the right edge of a panel, at a fraction of its height, legible over curves."""
    axes.annotate(
        text,
        (1.0, height),
        xycoords="axes fraction",
        ha="right",
        va="top",
        fontsize=TICK,
        parse_math=False,  # a $ in a name is not mathematics
        bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1},
    )


def make_room(axes: Axes, share: float = 0.2) -> None:
    """Raise the upper end of a panel by a share of its height, so that a note does not cover peaks."""
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + share * (high - low))


def plain_numbers(axis: Axis, subs: Sequence[float] = (1.0, 2.0, 5.0)) -> None:
    """Set plain numbers along a logarithmic axis, at given multiples of the powers of ten."""
    axis.set_major_locator(LogLocator(subs=subs))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def logarithmic(axis: Axis, subs: Sequence[float] = (1.0, 2.0, 5.0)) -> None:
    """Make an axis logarithmic, with plain numbers."""
    axes = axis.axes
    (axes.set_xscale if axis is axes.xaxis else axes.set_yscale)("log")
    plain_numbers(axis, subs)


def in_percent(axis: Axis) -> None:
    """Number an axis of shares in per cent."""
    axis.set_major_formatter(PercentFormatter(1.0))


def legend_below(figure: Figure, handles: Sequence[Any] | None = None, ncols: int = 2, **look: Any) -> None:
    """Draw the legend of a figure below its panels."""
    keys = {} if handles is None else {"handles": handles}
    figure.legend(**keys, loc="outside lower center", ncols=ncols, fontsize=TICK, frameon=False, **look)


def tidy(axes: Axes, x: str = "", y: str = "") -> None:
    """Apply the common style to axes."""
    if x:
        axes.set_xlabel(x, fontsize=LABEL)
    if y:
        axes.set_ylabel(y, fontsize=LABEL)
    axes.grid(True, color=GRID, linewidth=THIN)
    axes.set_axisbelow(True)
    axes.tick_params(labelsize=TICK, colors=INK)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


BINS_ACROSS = 4000  # more than the pixels of a picture, so that nothing is lost even enlarged in print


def visible(values: NDArray[np.float64], bins: int = BINS_ACROSS) -> NDArray[np.intp]:
    """Return the indices of the samples to draw: all of a short curve, lowest and highest of each bin of a long one.

    Parameters
    ----------
    values : ndarray, shape (n,)
        Finite values at even times.
    bins : int
        Number of bins.

    Returns
    -------
    ndarray of int
        Increasing indices, including the first and the last sample and the extremes.
    """
    size = values.size // bins
    if size <= 2:
        return np.arange(values.size)
    whole = values[: bins * size].reshape(bins, size)
    starts = np.arange(bins) * size
    rest = np.arange(bins * size, values.size)  # the last values, fewer than the bins
    return np.unique(
        np.concatenate([[0, values.size - 1], starts + whole.argmin(axis=1), starts + whole.argmax(axis=1), rest])
    )


def draw_samples(axes: Axes, values: NDArray[np.float64], dt: float, start: float = 0.0, **look: Any) -> None:
    """Plot even samples against time, those that are visible."""
    shown = visible(values)
    axes.plot(start + shown * dt, values[shown], **look)

"""One style for every picture: legible in print, in grey, and to colour-blind readers."""

from __future__ import annotations

from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

WIDTH = 7.2  # inches: the width of a page of text
DPI = 150
LONGEST = 95  # characters of a heading
INK, FAINT, SHADE = "#222222", "#9a9a9a", "#eeeeee"
TITLE, LABEL, TICK, SMALL = 10, 9, 8, 7  # sizes of type [pt]
THIN, MEDIUM, BOLD = 0.6, 1.0, 1.6  # weights of line [pt]
# A structure: bodies apart by darkness too, marks in ink, what is measured in blue, thrust in a dash of its own.
BODIES = ("#dfe6ec", "#f1e2c6", "#c2cdd8")
EARTH, MEASURE = "#8a7f70", "#2b5d86"
CURSOR = "#c4371a"
TRACE: dict[str, Any] = {"color": INK, "linestyle": "-", "linewidth": 0.9}
THRUST: dict[str, Any] = {"color": "#b3541e", "linestyle": (0, (3, 1)), "linewidth": 1.8}
# Distinct in grey by darkness, dash and weight as well as by hue; the heaviest shows on both sides of the others.
LINES = {
    "nonlinear": {"color": "#111111", "linestyle": "-", "linewidth": 1.9},
    "linear1": {"color": "#e08a00", "linestyle": "--", "linewidth": 1.3},
    "linear2": {"color": "#1f77b4", "linestyle": "-.", "linewidth": 0.9},
}
RECORD = "#8a8a8a"  # what something bold is drawn over
PULSES: tuple[dict[str, Any], ...] = (
    {"color": "#111111", "linestyle": "-", "linewidth": 2.4},
    {"color": "#e08a00", "linestyle": "--", "linewidth": 2.0},
    {"color": "#1f77b4", "linestyle": "-.", "linewidth": 1.6},
)
LABELS = {"nonlinear": "nonlinear", "linear1": r"linear, $\kappa_1$", "linear2": r"linear, $\kappa_2$"}

# For any number of curves: dash and mark tell them apart in grey, and where they lie on one another.
_DASHES = ("-", "--", "-.", ":", (0, (6, 1, 1, 1, 1, 1)), (0, (3, 1)))
_HUES = ("#111111", "#d98200", "#1f77b4", "#8a3b62", "#3c7d3c", "#777777")
_MARKS = ("o", "s", "^", "D", "v", "P")


def distinct(k: int) -> dict[str, Any]:
    """The look of the curve number k of several."""
    return {
        "color": _HUES[k % len(_HUES)],
        "linestyle": _DASHES[k % len(_DASHES)],
        "marker": _MARKS[k % len(_MARKS)],
        "markersize": 4.5,
        "linewidth": 1.5,
    }


def new_figure(height: float) -> Figure:
    """An empty figure of the common width; `height` in inches."""
    return Figure(figsize=(WIDTH, height), dpi=DPI, layout="constrained")


def note(axes: Axes, text: str, height: float = 0.96) -> None:
    """A remark at the right edge of a panel, at this fraction of its height, legible over curves."""
    axes.annotate(
        text,
        (1.0, height),
        xycoords="axes fraction",
        ha="right",
        va="top",
        fontsize=8,
        parse_math=False,  # a $ in a name is a $
        bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1},
    )


def tidy(axes: Axes) -> None:
    """Common look of axes."""
    axes.grid(True, color="#dddddd", linewidth=0.5)
    axes.set_axisbelow(True)
    axes.tick_params(labelsize=8, colors=INK)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)

"""One style for every picture: legible in print, in grey, and to colour-blind readers."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure

WIDTH = 7.2  # inches: the width of a page of text
INK, FAINT = "#222222", "#9a9a9a"
# Distinct in grey by darkness and dash as well as by hue.
LINES = {
    "nonlinear": {"color": "#111111", "linestyle": "-", "linewidth": 1.3},
    "linear1": {"color": "#e08a00", "linestyle": "--", "linewidth": 1.1},
    "linear2": {"color": "#1f77b4", "linestyle": "-.", "linewidth": 1.1},
}
LABELS = {"nonlinear": "nonlinear", "linear1": r"linear, $\kappa_1$", "linear2": r"linear, $\kappa_2$"}


def new_figure(height: float) -> Figure:
    """An empty figure of the common width; `height` in inches."""
    return Figure(figsize=(WIDTH, height), dpi=150, layout="constrained")


def tidy(axes: Axes) -> None:
    """Common look of axes."""
    axes.grid(True, color="#dddddd", linewidth=0.5)
    axes.set_axisbelow(True)
    axes.tick_params(labelsize=8, colors=INK)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)

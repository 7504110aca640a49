"""The error of the equivalent block: free period over amplitude, overturning time over acceleration."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import PercentFormatter
from numpy.typing import NDArray

from rocking_cli.plotting import style
from rocking_cli.studies.linearisation import Linearisation

Reals = NDArray[np.float64]
TALLEST = 0.5  # error shown at most, either way


def draw_linearisation(curves: Sequence[Linearisation], asked: Sequence[Linearisation], title: str) -> Figure:
    """Draw the errors of the equivalent block, a row of panels for each direction.

    Parameters
    ----------
    curves : sequence of Linearisation
        The ratios over their ranges, one for each direction that differs.
    asked : sequence of Linearisation
        The same directions at the amplitudes and accelerations to mark.
    title : str
        Heading.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = style.new_figure(2.9 * len(curves) + 0.3)
    panels = figure.subplots(len(curves), 2, squeeze=False, sharey="col")
    for (left, right), curve, marks in zip(panels, curves, asked, strict=True):
        _line(left, curve.amplitude, curve.period_ratio, "nonlinear", "either kappa")
        _dots(left, marks.amplitude, marks.period_ratio)
        left.set_xlabel(r"amplitude $\phi/\phi_{cr}$", fontsize=style.LABEL)
        left.set_ylabel("error of the free period", fontsize=style.LABEL)
        left.set_xlim(0.0, 1.0)
        for kappa in (1, 2):
            ratio = getattr(curve, f"overturning_ratio{kappa}")
            _line(right, curve.acceleration, ratio, f"linear{kappa}", rf"$\kappa_{kappa}$")
            _dots(right, marks.acceleration, getattr(marks, f"overturning_ratio{kappa}"))
        right.set_xscale("log")
        right.set_xticks([1, 2, 5, 10], ["1", "2", "5", "10"])
        right.minorticks_off()
        right.set_xlim(1.0, curve.acceleration.max())
        right.set_xlabel(r"constant acceleration $a/\lambda$", fontsize=style.LABEL)
        right.set_ylabel("error of the overturning time", fontsize=style.LABEL)
        right.legend(**style.LEGEND, loc="lower right")
        if len(curves) > 1:
            left.set_title(f"{curve.direction.label} direction", fontsize=style.LABEL, loc="left")
        for axes in (left, right):
            axes.axhline(0.0, color=style.FAINT, linewidth=style.THIN)
            axes.yaxis.set_major_formatter(PercentFormatter(1.0))
            style.tidy(axes)
    figure.suptitle(style.plain(style.fitted(title)), fontsize=style.TITLE, x=0.01, ha="left", color=style.INK)
    return figure


def _line(axes: Axes, x: Reals, ratio: Reals, look: str, label: str) -> None:
    error = np.where(np.abs(ratio - 1) <= TALLEST, ratio - 1, np.nan)
    axes.plot(x, error, label=label, **style.LINES[look])  # type: ignore[arg-type]


def _dots(axes: Axes, x: Reals, ratio: Reals) -> None:
    shown = np.abs(ratio - 1) <= TALLEST
    axes.plot(x[shown], ratio[shown] - 1, "o", color=style.INK, markersize=4)

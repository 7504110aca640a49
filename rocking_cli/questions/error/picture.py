"""Plot of the error of the equivalent block: free period against amplitude, overturning time against acceleration."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from rocking_cli.plotting import style
from rocking_cli.questions.error.study import Linearisation, preferred

Reals = NDArray[np.float64]
PREFERRED_STYLE, OTHER_STYLE = {"linestyle": "-", "linewidth": 2.0}, {"linestyle": "--", "linewidth": 1.3}
MAX_SHOWN_ERROR = 0.5  # largest error that is drawn, of either sign


def draw_linearisation(curves: Sequence[Linearisation], asked: Sequence[Linearisation], title: str) -> Figure:
    """Plot the errors of the equivalent block, a row of panels for each direction.

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
    best = preferred(asked)
    bold = best or 2  # if both are equally good, kappa 2, which is exact at uplift
    figure, panels = style.panels(2.9 * len(curves) + 0.3, len(curves), 2, sharey="col")
    for (left, right), curve, marks in zip(panels, curves, asked, strict=True):
        _line(left, curve.amplitude, curve.period_ratio, "either kappa", style.LINES["nonlinear"])
        _dots(left, marks.amplitude, marks.period_ratio)
        left.set_xlim(0.0, 1.0)
        for kappa in (1, 2):
            ratio = getattr(curve, f"overturning_ratio{kappa}")
            label = rf"$\kappa_{kappa}$" + (", preferred" if kappa == best else "")
            look = style.LINES[f"linear{kappa}"] | (PREFERRED_STYLE if kappa == bold else OTHER_STYLE)
            _line(right, curve.acceleration, ratio, label, look)
            _dots(right, marks.acceleration, getattr(marks, f"overturning_ratio{kappa}"))
        right.set_xscale("log")
        right.set_xticks([1, 2, 5, 10], ["1", "2", "5", "10"])
        right.minorticks_off()
        right.set_xlim(1.0, curve.acceleration.max())
        ratios = np.concatenate([curve.overturning_ratio1, curve.overturning_ratio2])
        beyond = (np.abs(ratios - 1) > MAX_SHOWN_ERROR).any()
        cut = f" (not drawn: beyond {100 * MAX_SHOWN_ERROR:g} %)" if beyond else ""
        for axes, x, y in (
            (left, r"amplitude $\phi/\phi_{cr}$ (dots: as in the table)", "error of the free period"),
            (right, rf"constant acceleration $a/\lambda${cut}", "error of the overturning time"),
        ):
            if len(curves) > 1:
                axes.set_title(f"{curve.direction.label} direction", fontsize=style.LABEL, loc="left")
            axes.axhline(0.0, color=style.FAINT, linewidth=style.THIN)
            style.in_percent(axes.yaxis)
            style.tidy(axes, x, y)
    style.heading_of_all(figure, title)
    for _, right in panels:  # the preferred one may differ
        right.legend(loc="best", **style.LEGEND)
    return figure


def _line(axes: Axes, x: Reals, ratio: Reals, label: str, look: Mapping[str, Any]) -> None:
    error = np.where(np.abs(ratio - 1) <= MAX_SHOWN_ERROR, ratio - 1, np.nan)
    axes.plot(x, error, label=label, **look)


def _dots(axes: Axes, x: Reals, ratio: Reals) -> None:
    shown = np.abs(ratio - 1) <= MAX_SHOWN_ERROR
    axes.plot(x[shown], ratio[shown] - 1, "o", color=style.INK, markersize=4)

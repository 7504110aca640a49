"""Plot of the capacity curves of a verification: exact and straight, with capacity and demand at each limit state."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rocking_cli.codes.italian.results import ItalianVerification, ItalianVerified
from rocking_cli.plotting import style
from rocking_cli.views.conclusion import headline
from rocking_cli.views.verification import shown
from rocking_cli.views.view import heading


def draw_verification(found: ItalianVerification) -> Figure:
    """Plot the capacity curve of each direction; one if both are equal.

    Parameters
    ----------
    found : ItalianVerification
        The verification by a code.
    """
    sides = shown(found)
    figure = style.new_figure(3.4 * len(sides))
    axes = figure.subplots(len(sides), 1, squeeze=False)[:, 0]
    for each, (where, side) in zip(axes, sides.items(), strict=True):
        _draw(each, side)
        what = f"{where.lower()}, FC = {side.exact.confidence:g}"
        style.heading(each, f"{heading(found.mechanism)}, {what} ({headline(found.conclusion)})")
        style.tidy(each)
    axes[-1].set_xlabel("displacement d of the single-degree-of-freedom system [m]", fontsize=style.LABEL)
    return figure


def _draw(axes: Axes, side: ItalianVerified) -> None:
    d, a = side.exact.points()
    axes.plot(d, a, color=style.INK, linewidth=style.BOLD, label="exact curve")
    axes.plot(
        [0, side.d0], [side.a0, 0], color=style.MEASURE, linestyle="--", linewidth=style.MEDIUM, label="straight line"
    )
    for k, (name, at) in enumerate(side.states.items()):
        look = style.distinct(k + 1)
        color = look["color"]
        axes.plot(at.d, at.a, marker=look["marker"], color=color, linestyle="none", label=f"capacity d_{name}")
        if at.demand is not None:
            axes.axvline(at.demand, color=color, linestyle=look["linestyle"], linewidth=style.MEDIUM,
                         label=f"demand at {name}")  # fmt: skip
    axes.set_xlim(left=0)
    axes.set_ylim(bottom=0)
    axes.set_ylabel("acceleration a* [m/s2]", fontsize=style.LABEL)
    axes.legend(**style.LEGEND)

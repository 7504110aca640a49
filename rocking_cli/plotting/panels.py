"""Layout of panels that show parts of the plane to scale: their size, and their position on the page."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rocking_cli.plotting import style

PANEL_GAP = 0.12  # inches between panels and to the edge
MAX_PANEL_HEIGHT = 3.6  # inches
MIN_STACKING_GAIN = 1.4  # factor of enlargement from which panels are placed above one another


@dataclass
class Panel:
    """A box of the plane [m], and the space around it: left, right, below, above [inches].

    `lay_out` sets `scale` [inches per metre] and `corner`, the lower left one [inches].
    """

    low: complex
    high: complex
    around: tuple[float, float, float, float]
    scale: float = 1.0
    corner: complex = 0j

    @property
    def plane(self) -> complex:
        """Width and height of the box [m]."""
        return self.high - self.low

    @property
    def room(self) -> complex:
        """Width and height of the space around the box, both sides together [inches]."""
        left, right, below, above = self.around
        return complex(left + right, below + above)

    @property
    def inches(self) -> complex:
        """Width and height of the panel on the page [inches]."""
        return self.plane * self.scale + self.room

    @property
    def depth(self) -> float:
        """Distance from the lower edge of the panel up to the level y = 0 [inches]."""
        return self.around[2] - self.low.imag * self.scale

    def axes(self, figure: Figure) -> Axes:
        """Return axes without a frame at the position of the panel, in m."""
        width, height = figure.get_size_inches()
        x, y, size = self.corner.real, self.corner.imag, self.inches
        axes = figure.add_axes((x / width, y / height, size.real / width, size.imag / height))
        left, right, below, above = (each / self.scale for each in self.around)
        axes.set_xlim(self.low.real - left, self.high.real + right)
        axes.set_ylim(self.low.imag - below, self.high.imag + above)
        axes.set_axis_off()
        return axes


def lay_out(panels: Sequence[Panel], middle: Panel, head: float, foot: float) -> float:
    """Place panels side by side at one scale, or the middle one, larger, above the others.

    Parameters
    ----------
    panels : sequence of Panel
        From left to right. Their scale, corner and room to the sides are set.
    middle : Panel
        The panel that may be placed above the others.
    head, foot : float
        Space that each panel needs above and below itself [inches].

    Returns
    -------
    float
        Total height [inches]; corners are measured from the lower edge.
    """
    together, apart = _largest(panels), _largest([middle])
    if apart < MIN_STACKING_GAIN * together:
        return _row(panels, together, foot) + head
    others = [each for each in panels if each is not middle]
    low = _row(others, _largest(others), foot) + head
    return _row([middle], apart, low + foot) + head


def _largest(panels: Sequence[Panel]) -> float:
    """Return the largest scale at which panels fit side by side [inches per metre]."""
    width = style.PAGE_WIDTH - PANEL_GAP * (len(panels) + 1) - sum(each.room.real for each in panels)
    return min(
        width / sum(each.plane.real for each in panels),
        *((MAX_PANEL_HEIGHT - each.room.imag) / each.plane.imag for each in panels),
    )


def _row(panels: Sequence[Panel], scale: float, base: float) -> float:
    """Place panels at one scale side by side above `base`, with their levels y = 0 in line; return the top [inches]."""
    for each in panels:
        each.scale = scale
    spare = style.PAGE_WIDTH - PANEL_GAP * (len(panels) + 1) - sum(each.inches.real for each in panels)
    depth = max(each.depth for each in panels)
    height = max(each.inches.imag - each.depth for each in panels)  # largest height of a panel above y = 0 [inches]
    x = PANEL_GAP
    for each in panels:
        left, right, below, above = each.around
        wider = spare / len(panels) / 2
        above += height - (each.inches.imag - each.depth)
        each.around = left + wider, right + wider, below + depth - each.depth, above
        each.corner = complex(x, base)
        x += each.inches.real + PANEL_GAP
    return base + depth + height

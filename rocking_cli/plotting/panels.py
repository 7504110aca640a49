"""Layout of panels that show parts of the plane to scale: their size, and their position on the page."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, cast

import numpy as np
from matplotlib.artist import Artist, getp, setp
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Annotation

from rocking_cli.plotting import style

PANEL_GAP = 0.12  # inches between panels and to the edge
MAX_PANEL_HEIGHT = 3.6  # inches
MIN_STACKING_GAIN = 1.4  # factor of enlargement from which panels are placed above one another


@dataclass
class Page:
    """A page of fixed proportions in a figure, on which places are in inches.

    Parameters
    ----------
    figure : Figure
        The figure.
    size : complex
        Width and height of the figure [inches].
    corner : complex
        Place of the lower left corner of the page in the figure [inches].
    times : float
        Enlargement of the page in the figure.
    """

    figure: Figure
    size: complex
    corner: complex = 0j
    times: float = 1.0
    _drawn: list[Artist] = field(default_factory=list)

    @classmethod
    def new(cls, height: float, panels: int) -> Page:
        """Return a page of the common width and a height [inches] in a new figure, or in the middle of the user's.

        Raises
        ------
        InputError
            If the user gave axes and there are several panels.
        """
        page, target = complex(style.page_width(), height), style.given()
        if target is None:
            return cls(Figure(figsize=(style.page_width(), height), dpi=style.DPI), page)
        if isinstance(target, Axes):
            raise style.several(panels)
        size = style.inches(target)
        times = min(size.real / page.real, size.imag / page.imag)
        return cls(cast("Figure", target), size, (size - times * page) / 2, times)

    def share(self, place: complex) -> tuple[float, float]:
        """Return a place on the page [inches] as shares of width and height of the figure."""
        at = self.corner + self.times * place
        return at.real / self.size.real, at.imag / self.size.imag

    def add_axes(self, corner: complex, size: complex) -> Axes:
        """Return new axes on the page, by their lower left corner and their size [inches]."""
        width, height = (self.times * size).real / self.size.real, (self.times * size).imag / self.size.imag
        axes = self.figure.add_axes((*self.share(corner), width, height))
        self._drawn.append(axes)
        return axes

    def text(self, place: complex, text: str, **look: Any) -> None:
        """Write at a place on the page [inches]."""
        self._drawn.append(self.figure.text(*self.share(place), text, **look))

    def finished(self) -> Figure:
        """Return the figure, with letters and lines enlarged as the page, and shapes that stay if it is resized."""
        if style.given() is None:
            return self.figure
        parts = [part for drawn in self._drawn for part in drawn.findobj()]
        arrows = [part.arrow_patch for part in parts if isinstance(part, Annotation) and part.arrow_patch is not None]
        for part in (*parts, *arrows):
            if isinstance(part, Axes):
                part.set_aspect("equal")
            for size in ("fontsize", "linewidth", "markersize", "markeredgewidth"):
                if hasattr(part, f"set_{size}"):
                    setp(part, size, np.multiply(self.times, getp(part, size)))
        return self.figure


@dataclass
class Panel:
    """A box of the plane [m], and the space around it: left, right, below, above [inches].

    `head` and `foot` are the space above and below it, and `heading` the width of its heading [inches]. `lay_out` sets
    `scale` [inches per metre] and `corner`, the lower left one [inches].
    """

    low: complex
    high: complex
    around: tuple[float, float, float, float]
    head: float = 0.0
    foot: float = 0.0
    heading: float = 0.0
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

    def axes(self, page: Page) -> Axes:
        """Return axes without a frame at the position of the panel on a page, in m."""
        axes = page.add_axes(self.corner, self.inches)
        left, right, below, above = (each / self.scale for each in self.around)
        axes.set_xlim(self.low.real - left, self.high.real + right)
        axes.set_ylim(self.low.imag - below, self.high.imag + above)
        axes.set_axis_off()
        return axes


def lay_out(panels: Sequence[Panel], middle: Panel) -> float:
    """Place panels side by side at one scale, or the middle one, larger, above the others; on a phone always above.

    Parameters
    ----------
    panels : sequence of Panel
        From left to right. Their scale, corner and room to the sides are set.
    middle : Panel
        The panel that may be placed above the others.

    Returns
    -------
    float
        Total height [inches]; corners are measured from the lower edge.
    """
    apart, others = _largest([middle]), [each for each in panels if each is not middle]
    if not others or not (style.is_narrow() or apart >= MIN_STACKING_GAIN * _largest(panels)):
        return place_row(panels, _largest(panels), 0.0)
    rows, scale = [others], _largest(others)
    if style.is_narrow() and (alone := min(_largest([each]) for each in others)) >= MIN_STACKING_GAIN * scale:
        rows, scale = [[each] for each in reversed(others)], alone
    top = 0.0
    for row in rows:  # from the lowest
        top = place_row(row, min(scale, apart), top)
    return place_row([middle], apart, top)


def _largest(panels: Sequence[Panel]) -> float:
    """Return the largest scale at which panels fit side by side [inches per metre]."""
    width = style.page_width() - PANEL_GAP * (len(panels) + 1)
    tallest = min((MAX_PANEL_HEIGHT - each.room.imag) / each.plane.imag for each in panels)
    wide = list(panels)  # those whose headings are not wider than what they show
    while wide:
        rest = width - sum(each.heading for each in panels if each not in wide) - sum(each.room.real for each in wide)
        scale = min(tallest, rest / sum(each.plane.real for each in wide))
        wider = [each for each in wide if each.plane.real * scale + each.room.real >= each.heading]
        if len(wider) == len(wide):
            return scale
        wide = wider
    return min([tallest, *((each.heading - each.room.real) / each.plane.real for each in panels)])


def place_row(panels: Sequence[Panel], scale: float, base: float) -> float:
    """Place panels at one scale side by side above `base`, with their levels y = 0 in line; return the top [inches]."""
    for each in panels:
        each.scale = scale
    spare = style.page_width() - PANEL_GAP * (len(panels) + 1)
    spare -= sum(max(each.inches.real, each.heading) for each in panels)
    depth = max(each.depth for each in panels)
    height = max(each.inches.imag - each.depth for each in panels)  # largest height of a panel above y = 0 [inches]
    base += max(each.foot for each in panels)
    x = PANEL_GAP
    for each in panels:
        left, right, below, above = each.around
        wider = (max(0.0, each.heading - each.inches.real) + spare / len(panels)) / 2
        above += height - (each.inches.imag - each.depth)
        each.around = left + wider, right + wider, below + depth - each.depth, above
        each.corner = complex(x, base)
        x += each.inches.real + PANEL_GAP
    return base + depth + height + max(each.head for each in panels)

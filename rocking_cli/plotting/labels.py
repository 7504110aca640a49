"""Placement of labels in a drawing: next to what they name, off the lines, and within their panel.

Each label stands at the cheapest of several places. Curves have legends instead: a legend cannot name a length at its
dimension line, and no library places labels that are turned along lines and keep off other lines.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.transforms import Affine2D

from rocking_cli.arrays import Points, Reals
from rocking_cli.core import Angle, Length
from rocking_cli.plotting import style
from rocking_cli.plotting.panels import Panel

POINT_SPACING = 0.025  # inches between the points of a line that labels avoid
GAPS = (0.03, 0.1, 0.18, 0.28, 0.45)  # inches between a label and what it names
FAR_GAPS = (0.6, 0.8)  # and of a name in a crowd
MAX_LINE_POINTS = 10_000  # limit, as a line may extend far beyond the picture
CLEARANCE, NAME_CLEARANCE = 0.02, 0.035  # inches around a label, and around a name in a crowd
DISTANCE_COST = 8.0  # cost per inch between a label and its object; a covered point of a line costs LINE_COST
OUTSIDE_COST = 1000.0  # cost per inch by which a label leaves the panel
EDGE_COST, LINE_COST, MARK_COST, LABEL_COST = 1.0, 2.0, 6.0, 30.0  # cost per point of each kind that a label covers
LEADING_DISTANCE = 0.09  # inches from which a line leads from a name to its mark
LEADER = {"arrowstyle": "-", "color": style.INK, "linewidth": style.THIN, "shrinkA": 0, "shrinkB": 3}
MARK_RADIUS = 0.07  # inches around a mark that names keep off: a name close to another mark would be taken for its
SUBSCRIPTS = str.maketrans("₀₁₂₃₄₅₆₇₈₉₊₋", "0123456789+-")


def mathematics(each: Length | Angle) -> str:
    """Return symbol, number and unit of a dimension as mathematics with subscripts; other words stay as they are."""
    number = style.plain(each.text.removeprefix(each.symbol))
    match = re.fullmatch(r"(\d*[^\W\d_]'?)(?:_(\w+)|([₀-₉₊₋]+))?", each.symbol)
    if match is None:
        return style.plain(each.symbol) + number
    letter, word, digits = match.groups()
    below = rf"_{{\mathrm{{{word}}}}}" if word else f"_{{{digits.translate(SUBSCRIPTS)}}}" if digits else ""
    return f"${letter}{below}$" + number


class LabelPlace(NamedTuple):
    """A candidate position of a label: its middle [inches], its angle [degrees], and its cost."""

    middle: complex
    turned: float
    cost: float


class Labels:
    """The labels of one panel, each placed where it covers least of the drawing.

    Inches are those of the page of a panel to scale, or else those of the figure, whose layout must be final.
    """

    def __init__(self, axes: Axes, panel: Panel | None = None, clearance: float = CLEARANCE) -> None:
        inches = axes.transData - axes.figure.dpi_scale_trans
        self._axes, self._to_inches = axes, Affine2D().scale(panel.scale) if panel is not None else inches
        corners = self.inches([complex(x, y) for x, y in zip(axes.get_xlim(), axes.get_ylim(), strict=True)])
        self._middle, self._size = corners.mean(), corners[1] - corners[0]
        self._points, self._costs, self._clearance = np.empty(0, np.complex128), np.empty(0), clearance * (1 + 1j)

    def inches(self, z: Iterable[complex] | Points) -> Points:
        """Return points of the plane in inches."""
        plane = np.asarray(z if isinstance(z, np.ndarray) else list(z), np.complex128)
        points: Points = self._to_inches.transform(np.column_stack([plane.real, plane.imag])) @ np.array([1, 1j])
        return points

    def keep_off(self, z: Iterable[complex] | Points, cost: float = LINE_COST) -> None:
        """Reserve the space of a line through points of the plane, or of a single point, against labels."""
        ends = self.inches(z)
        reach = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(ends)))])
        count = min(int(reach[-1] / POINT_SPACING) + 1 + (reach[-1] > 0), MAX_LINE_POINTS)
        along = np.linspace(0.0, reach[-1], count)
        self.reserve(np.interp(along, reach, ends.real) + 1j * np.interp(along, reach, ends.imag), cost)

    def reserve(self, points: Points, cost: float) -> None:
        """Reserve the space of points [inches] against labels."""
        self._points = np.append(self._points, points)
        self._costs = np.append(self._costs, np.full(points.size, cost))

    def write(self, text: str, places: Iterable[LabelPlace], **look: Any) -> None:
        """Write a label at the best of several places."""
        places = list(places)
        size = style.size_of(text, float(look["fontsize"]), str(look.get("fontweight", "normal")))
        self.put(text, places[int(self._cost(places, size).argmin())], size, **look)

    def _cost(self, places: Sequence[LabelPlace], size: complex) -> Reals:
        """Return what a label of a size [inches] costs at each place."""
        middles, turned, cost = (np.array(column) for column in zip(*places, strict=True))
        reach = np.abs(middles - middles.mean()).max() + abs(size)
        within = np.abs(self._points - middles.mean()) < reach
        points, weights, half = self._points[within], self._costs[within], size / 2 + self._clearance
        for angle in np.unique(turned):
            turn, here = np.exp(1j * np.radians(angle)), turned == angle
            away = (points - middles[here, None]) / turn
            cost[here] += ((np.abs(away.real) < half.real) & (np.abs(away.imag) < half.imag)) @ weights
            corners = middles[here, None] + turn * np.array([size, -size, size.conjugate(), -size.conjugate()]) / 2
            off = corners - self._middle
            out = [(np.abs(off.real) - self._size.real / 2).max(1), (np.abs(off.imag) - self._size.imag / 2).max(1)]
            cost[here] += OUTSIDE_COST * np.maximum(0.0, out).sum(0)
        return cost

    def put(self, text: str, place: LabelPlace, size: complex, tip: complex | None = None, **look: Any) -> None:
        """Write a label of a size [inches] at a place, and reserve its space; a line leads to a far tip [inches]."""
        x, y = self._to_inches.inverted().transform((place.middle.real, place.middle.imag))
        end = self._to_inches.inverted().transform((tip.real, tip.imag)) if tip is not None else (x, y)
        off = (tip if tip is not None else place.middle) - place.middle
        leads = max(abs(off.real) - size.real / 2, abs(off.imag) - size.imag / 2) > LEADING_DISTANCE
        self._axes.annotate(
            text, tuple(end), (x, y), ha="center", va="center", rotation=place.turned, rotation_mode="anchor",
            annotation_clip=False, path_effects=style.HALO, arrowprops=LEADER if leads else None, **look,
        )  # fmt: skip
        across = np.linspace(-0.5, 0.5, 2 + int(size.real / POINT_SPACING)) * size.real
        up = np.linspace(-0.5, 0.5, 5) * size.imag
        turn = np.exp(1j * np.radians(place.turned))
        self.reserve((place.middle + turn * (across[:, None] + 1j * up)).ravel(), LABEL_COST)

    def along(self, start: complex, end: complex, size: complex) -> Iterator[LabelPlace]:
        """Yield places for a label next to a line: along it if the label fits, at its sides, and beyond its ends."""
        start, end = self.inches([start, end]).tolist()
        length = abs(end - start)
        unit = (end - start) / length if length > 0 else 1 + 0j
        turned = (float(np.degrees(np.angle(unit))) + 90 + 1e-6) % 180 - 90  # read from below or from the right
        for gap in GAPS:
            for share in np.linspace(0.15, 0.85, 11).tolist():
                at, cost = start + share * (end - start), 3 * abs(share - 0.5) + DISTANCE_COST * gap
                for side in (1.0, -1.0):
                    if min(share, 1 - share) * 2 * length > size.real:
                        yield LabelPlace(at + 1j * side * unit * (gap + size.imag / 2), turned, cost)
                    aside = gap + size.real / 2 + abs(unit.real) * size.imag / 2
                    yield LabelPlace(at + side * aside, 0.0, 1.5 + cost)
                    above = gap + size.imag / 2 + abs(unit.imag) * size.real / 2
                    yield LabelPlace(at + 1j * side * above, 0.0, 2.0 + cost)
            for tip, out in ((start, -unit), (end, unit)):
                reach = gap + abs(out.real) * size.real / 2 + abs(out.imag) * size.imag / 2
                yield LabelPlace(tip + out * reach, 0.0, 8.0 + DISTANCE_COST * gap)

    def around(
        self, apex: complex, towards: complex, radius: float, size: complex, turning: float = 4.0,
        gaps: Sequence[float] = GAPS,
    ) -> Iterator[LabelPlace]:  # fmt: skip
        """Yield places for a label around a point, beyond a radius [inches], best in one direction."""
        (middle,) = self.inches([apex]).tolist()
        for turn in np.linspace(-np.pi, np.pi, 25)[1:].tolist():
            direction = towards / abs(towards) * np.exp(1j * turn)
            sides = size.real / 2 / max(abs(direction.real), 1e-9), size.imag / 2 / max(abs(direction.imag), 1e-9)
            for gap in gaps:
                cost = turning * abs(turn) + DISTANCE_COST * gap
                yield LabelPlace(middle + (radius + gap + min(sides)) * direction, 0.0, cost)


def name_marks(axes: Axes, points: Sequence[tuple[float, float, str]], marks: Reals) -> None:
    """Write a name beside each of some points of a finished panel, with a line to a point that is farther off.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        The panel; its limits and scales must be final.
    points : sequence of (float, float, str)
        Place [data] and name of each point, the most important first.
    marks : ndarray, shape (n, 2)
        Places of all marks [data].
    """
    if style.given() is None and isinstance(axes.figure, Figure):
        style.lay_out(axes.figure)
    labels, named = Labels(axes, clearance=NAME_CLEARANCE), np.array([complex(x, y) for x, y, _ in points])
    inches = labels.inches(named)
    labels.reserve(labels.inches(marks @ np.array([1, 1j])), EDGE_COST)
    labels.reserve((inches[:, None] + MARK_RADIUS * np.exp(2j * np.pi * np.arange(8) / 8)).ravel(), EDGE_COST)
    for text in axes.texts:
        (x0, y0), (x1, y1) = text.get_window_extent().get_points() / axes.figure.dpi
        across, up = np.meshgrid(np.linspace(x0, x1, 12), np.linspace(y0, y1, 4))
        labels.reserve((across + 1j * up).ravel(), LABEL_COST)
    look: dict[str, Any] = {"fontsize": style.TICK, "color": style.INK, "zorder": 7}
    for at, tip, (*_, name) in zip(named.tolist(), inches.tolist(), points, strict=True):
        places = labels.around(at, 1 + 1j, MARK_RADIUS, style.size_of(name, style.TICK), 0.3, GAPS + FAR_GAPS)
        labels.write(name, places, tip=tip, **look)

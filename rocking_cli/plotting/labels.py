"""Placement of labels in a drawing: next to what they name, off the lines, and within their panel."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from rocking_cli.core import Angle, Length
from rocking_cli.plotting import style
from rocking_cli.plotting.panels import Panel

Points = NDArray[np.complex128]
POINT_SPACING = 0.025  # inches between the points of a line that labels avoid
LABEL_GAPS = (0.03, 0.1, 0.18, 0.28, 0.45)  # inches between a label and a line
MAX_LINE_POINTS = 10_000  # limit, as a line may extend far beyond the picture
CLEARANCE = 0.02  # inches around a label
DISTANCE_COST = 8.0  # cost per inch between a label and its object; a covered point of a line costs LINE_COST
OUTSIDE_COST = 1000.0  # cost per inch by which a label leaves the panel
EDGE_COST, LINE_COST, MARK_COST, LABEL_COST = 1.0, 2.0, 6.0, 30.0  # cost per point of each kind that a label covers
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


@dataclass(frozen=True)
class LabelPlace:
    """A candidate position of a label: its middle [inches], its angle [degrees], and its cost."""

    middle: complex
    turned: float
    cost: float


class Labels:
    """The labels of one panel, each placed where it covers least of the drawing."""

    def __init__(self, axes: Axes, panel: Panel) -> None:
        self._axes, self._scale = axes, panel.scale
        (left, right), (below, above) = axes.get_xlim(), axes.get_ylim()
        self._low, self._high = complex(left, below) * self._scale, complex(right, above) * self._scale
        self._points: list[Points] = [np.empty(0, np.complex128)]
        self._costs: list[NDArray[np.float64]] = [np.empty(0)]

    def keep_off(self, z: Iterable[complex] | Points, cost: float = LINE_COST) -> None:
        """Reserve the space of a line through points [m], or of a single point, against labels."""
        ends = np.asarray(z if isinstance(z, np.ndarray) else list(z), np.complex128) * self._scale
        reach = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(ends)))])
        count = min(int(reach[-1] / POINT_SPACING) + 1 + (reach[-1] > 0), MAX_LINE_POINTS)
        along = np.linspace(0.0, reach[-1], count)
        self._note(np.interp(along, reach, ends.real) + 1j * np.interp(along, reach, ends.imag), cost)

    def _note(self, points: Points, cost: float) -> None:
        self._points.append(points)
        self._costs.append(np.full(points.size, cost))

    def write(self, text: str, places: Iterable[LabelPlace], **look: Any) -> None:
        """Write a label at the best of several places."""
        size = style.size_of(text, float(look["fontsize"]), str(look.get("fontweight", "normal")))
        places = list(places)
        self.put(text, places[int(np.argmin(self._cost(places, size)))], size, **look)

    def _cost(self, places: Sequence[LabelPlace], size: complex) -> NDArray[np.float64]:
        """Return what a label of a size [inches] costs at each place."""
        self._points, self._costs = [np.concatenate(self._points)], [np.concatenate(self._costs)]
        (points,), (costs,) = self._points, self._costs
        cost: NDArray[np.float64] = np.array([each.cost for each in places])
        turned = np.array([each.turned for each in places])
        middles = np.array([each.middle for each in places])
        half = size / 2 + CLEARANCE * (1 + 1j)
        for angle in np.unique(turned):
            turn = np.exp(1j * np.radians(angle))
            here = np.flatnonzero(turned == angle)
            at, every = middles[here] / turn, points / turn
            low, high = at.imag.min() - half.imag, at.imag.max() + half.imag
            nearby = np.flatnonzero((low < every.imag) & (every.imag < high))
            nearby = nearby[np.argsort(every.real[nearby])]  # so that a label covers points between two indices
            along, up, of_point = every.real[nearby], every.imag[nearby], costs[nearby]
            starts = np.searchsorted(along, at.real - half.real, "right")
            ends = np.searchsorted(along, at.real + half.real, "left")
            for k, level, start, end in zip(here, at.imag, starts, ends, strict=True):
                cost[k] += of_point[start:end][np.abs(up[start:end] - level) < half.imag].sum()
            # Half of the upright box around the rotated label.
            box = complex(abs(turn.real), abs(turn.imag)) * size.real / 2
            box += complex(abs(turn.imag), abs(turn.real)) * size.imag / 2
            above, below = middles[here] + box - self._high, self._low - (middles[here] - box)
            over = np.maximum(0.0, np.maximum(above.real, below.real)) + np.maximum(
                0.0, np.maximum(above.imag, below.imag)
            )
            cost[here] += OUTSIDE_COST * over
        return cost

    def put(self, text: str, place: LabelPlace, size: complex | None = None, **look: Any) -> None:
        """Write a label at a place, and reserve its space against other labels."""
        size = style.size_of(text, float(look["fontsize"])) if size is None else size
        at = place.middle / self._scale
        self._axes.annotate(
            text, (at.real, at.imag), ha="center", va="center", rotation=place.turned, rotation_mode="anchor",
            annotation_clip=False, path_effects=style.HALO, **look,
        )  # fmt: skip
        across = np.linspace(-0.5, 0.5, 2 + int(size.real / POINT_SPACING)) * size.real
        up = np.linspace(-0.5, 0.5, 5) * size.imag
        turn = np.exp(1j * np.radians(place.turned))
        self._note((place.middle + turn * (across[:, None] + 1j * up)).ravel(), LABEL_COST)

    def along(self, start: complex, end: complex, size: complex) -> Iterator[LabelPlace]:
        """Yield places for a label next to a line [m]: along it if the label fits, otherwise at its sides."""
        start, end = start * self._scale, end * self._scale
        length = abs(end - start)
        unit = (end - start) / length if length > 0 else 1 + 0j
        turned = (float(np.degrees(np.angle(unit))) + 90 + 1e-6) % 180 - 90  # read from below or from the right
        for share in np.linspace(0.15, 0.85, 15):
            at, off_middle = start + share * (end - start), 3 * abs(share - 0.5)
            for gap in LABEL_GAPS:
                if min(share, 1 - share) * 2 * length > size.real:
                    for side in (1j, -1j):
                        yield LabelPlace(
                            at + side * unit * (gap + size.imag / 2), turned, off_middle + DISTANCE_COST * gap
                        )
                for side in (1.0, -1.0):
                    reach = gap + size.real / 2 + abs(unit.real) * size.imag / 2
                    yield LabelPlace(at + side * reach, 0.0, 1.5 + off_middle + DISTANCE_COST * gap)
                    reach = gap + size.imag / 2 + abs(unit.imag) * size.real / 2
                    yield LabelPlace(at + 1j * side * reach, 0.0, 2.0 + off_middle + DISTANCE_COST * gap)
        for tip, out in ((start, -unit), (end, unit)):
            for gap in LABEL_GAPS:
                reach = gap + abs(out.real) * size.real / 2 + abs(out.imag) * size.imag / 2
                yield LabelPlace(tip + out * reach, 0.0, 8.0 + DISTANCE_COST * gap)

    def around(
        self, apex: complex, towards: complex, radius: float, size: complex, turning: float = 4.0
    ) -> Iterator[LabelPlace]:
        """Yield places for a label around a point [m], beyond a radius [inches], best in one direction."""
        apex *= self._scale
        for turn in np.linspace(-np.pi, np.pi, 25)[1:]:
            direction = towards / abs(towards) * np.exp(1j * turn)
            for gap in (0.03, 0.08, 0.15, 0.25, 0.4):
                # Distance from the point to the nearest edge of the label.
                reach = min(
                    size.real / 2 / max(abs(direction.real), 1e-9), size.imag / 2 / max(abs(direction.imag), 1e-9)
                )
                yield LabelPlace(
                    apex + (radius + gap + reach) * direction, 0.0, turning * abs(float(turn)) + DISTANCE_COST * gap
                )

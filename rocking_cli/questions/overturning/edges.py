"""Edges between the regions of an overturning map, and contours of the peak, as lines.

The interval between neighbouring points with different outcomes is bisected. Where the points so found are on no smooth
line, the outcome changes from one pulse to the next: the edge follows the grid there, in steps.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from math import ceil, log2
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Bools, Integers, Points, Reals
from rocking_cli.short_repr import short_repr

V = TypeVar("V", bound=np.generic)
PRECISION = 1024  # parts of an axis to which bisection locates an edge
MAX_SHARE, FREE_POINTS = 0.2, 4000  # limits of further simulations: this share of the points of the map, or this many
MAX_DEVIATION = 0.35  # cells between a point of a smooth edge and the line through its neighbours
MIN_WIDTH = 3.0  # cells: contours around narrower areas, such as islands of a point or two, are not resolved

Simulated = Callable[[Points], Integers]
"""Function that returns the kinds of the outcomes at some places u + iv of the grid."""


@short_repr
@dataclass(frozen=True, eq=False)
class Edges:
    """Lines on a map, as columns u and rows v of its grid, fractions included: u + iv.

    Parameters
    ----------
    outlines : dict of int to list of ndarray
        Closed lines around all points of a kind or a higher one; those around holes turn the other way.
    contours : list of list of ndarray
        Contours of the peak, for each level; they end at the edges of the map and of unknown outcomes.
    stepped : bool
        Whether a part of an edge is known only to the grid, and follows it in steps.
    simulated : int
        Number of pulses simulated to find the edges.
    """

    outlines: dict[int, list[Points]]
    contours: list[list[Points]]
    stepped: bool
    simulated: int


def edges_of(
    kinds: Integers, simulated: Simulated, peaks: Reals, levels: Sequence[float], falls: int, unknown: int
) -> Edges:
    """Find the edges between the kinds of outcomes of a grid, and contours of the peak.

    Parameters
    ----------
    kinds : ndarray of int, shape (m, n)
        Kind of the outcome at each point, 0 for the one that needs no outline.
    simulated : callable
        Simulates further pulses.
    peaks : ndarray, shape (m, n)
        Peak over the critical rotation; without importance where the structure overturns or the outcome is unknown.
    levels : sequence of float
        Peaks of the contours.
    falls, unknown : int
        The kind from which on the structure overturns, and that of unknown outcomes, which is the highest.
    """
    present = [kind for kind in np.unique(kinds).tolist() if kind > 0]
    lines = tuple(_on_lines(_places(kinds.shape), end) for end in (0, 1))
    outlines = {kind: _Outline(kinds >= kind, *lines) for kind in present}
    count = _bisect(outlines, kinds, simulated)
    for each in outlines.values():
        each.step_where_rough()
    stays = next((outlines[kind] for kind in present if kind >= falls), _Outline(kinds >= falls, *lines))
    return Edges(
        {kind: [each.line(*loop) for loop in each.loops()] for kind, each in outlines.items()},
        [list(_contours(stays, kinds, peaks, level, unknown)) for level in levels],
        any(bool(each.stepped.any()) for each in outlines.values()),
        count,
    )


class _Outline:
    """The edge of a set of points of a grid: where it crosses the lines between neighbouring points.

    Crossings are numbered: first those of the lines along rows, then those along columns. Around the grid there is a
    ring of further points, outside the set and at the place of its outermost ones, so that every edge is closed.

    Parameters
    ----------
    inside : ndarray of bool, shape (m, n)
        Which points are in the set.
    start, end : ndarray of complex
        Both ends of each line, by number of the crossing.
    """

    def __init__(self, inside: Bools, start: Points, end: Points) -> None:
        self.inside = np.pad(inside, 1)
        self.stepped = np.zeros((inside.shape[0] + 1, inside.shape[1] + 1), np.bool_)  # cells: the edge has a step
        self.start, self.end, self.at = start, end, (start + end) / 2
        self.differ = _on_lines(self.inside, 0) != _on_lines(self.inside, 1)
        self.in_frame = self.start == self.end

    def loops(self) -> Iterator[tuple[Integers, Integers]]:
        """Yield the closed edges, points inside on the left: numbers of the crossings, and of the cells after them."""
        rows, columns = self.stepped.shape
        row, column = np.indices((rows, columns))
        along_columns = (rows + 1) * columns + row * (columns + 1) + column
        sides = [row * columns + column, along_columns + 1, (row + 1) * columns + column, along_columns]
        inside = self.inside
        corners = [inside[:-1, :-1], inside[:-1, 1:], inside[1:, 1:], inside[1:, :-1]]  # each before the side it is on
        following, cell = np.full((2, self.at.size), -1)
        for side in range(4):
            for count in (1, 2, 3):  # corners inside before the side, and none before them and after the side
                there = np.all([corners[(side - k) % 4] for k in range(count)], axis=0)
                there &= ~(corners[(side - count) % 4] | corners[(side + 1) % 4])
                following[sides[side][there]] = sides[(side - count) % 4][there]
                cell[sides[side][there]] = np.flatnonzero(there)
        ahead = following.tolist()
        for place in np.flatnonzero(following >= 0).tolist():
            loop = []
            while ahead[place] >= 0:
                loop.append(place)
                ahead[place], place = -1, ahead[place]
            if loop:
                yield np.array(loop), cell[loop]

    def step_where_rough(self) -> None:
        """Let the edge follow the grid where its crossings are on no smooth line."""
        rough = np.zeros(self.at.size, np.bool_)
        for loop, _ in self.loops():
            before, after = np.roll(loop, 1), np.roll(loop, -1)
            chord, away = self.at[after] - self.at[before], self.at[loop] - self.at[before]
            deviates = np.abs((chord.conj() * away).imag) > MAX_DEVIATION * np.abs(chord)
            rough[loop] = deviates & ~(self.in_frame[before] | self.in_frame[loop] | self.in_frame[after])
        self.at = np.where(rough, (self.start + self.end) / 2, self.at)
        rows, columns = self.stepped.shape
        across, up = np.split(rough, [(rows + 1) * columns])
        across, up = across.reshape(rows + 1, columns), up.reshape(rows, columns + 1)
        self.stepped = across[:-1] | across[1:] | up[:, :-1] | up[:, 1:]

    def line(self, loop: Integers, cell: Integers) -> Points:
        """Return a closed edge, with a corner in the middle of each cell in which it has a step."""
        row, column = np.divmod(cell, self.stepped.shape[1])
        middle = np.where(self.stepped.ravel()[cell], column - 0.5 + 1j * (row - 0.5), self.at[loop])
        line = np.column_stack([self.at[loop], middle]).ravel()
        line = line[line != np.roll(line, 1)]
        before, after = np.roll(line, 1), np.roll(line, -1)
        straight = (before.real == line.real) & (line.real == after.real)
        straight |= (before.imag == line.imag) & (line.imag == after.imag)
        kept: Points = line[~straight]
        return kept


def _places(shape: tuple[int, ...]) -> Points:
    """Return the places of the points of a grid and of the ring around it."""
    row, column = np.indices(shape)
    return np.pad(column + 1j * row, 1, mode="edge")


def _on_lines(values: NDArray[V], end: int) -> NDArray[V]:
    """Return the values at the start (0) or the end (1) of each line between neighbouring points."""
    along_rows, along_columns = (np.s_[:, :-1], np.s_[:-1]) if end == 0 else (np.s_[:, 1:], np.s_[1:])
    return np.concatenate([values[along_rows].ravel(), values[along_columns].ravel()])


def _bisect(outlines: dict[int, _Outline], kinds: Integers, simulated: Simulated) -> int:
    """Move the crossings of the edges to where the outcome changes; return the number of simulated pulses."""
    crossings = [np.flatnonzero(each.differ & ~each.in_frame) for each in outlines.values()]
    sizes = [each.size for each in crossings]
    if not sum(sizes):
        return 0
    level = np.repeat(list(outlines), sizes)
    start, end, inside = (
        np.concatenate([values[here] for values, here in zip(each, crossings, strict=True)])
        for each in zip(*((each.start, each.end, _on_lines(each.inside, 0)) for each in outlines.values()), strict=True)
    )
    most = int(max(MAX_SHARE * kinds.size, FREE_POINTS))
    steps = min(ceil(log2(PRECISION / max(kinds.shape))), most // sum(sizes))
    count = 0
    for _ in range(steps):
        middle = (start + end) / 2
        different, which = np.unique(middle, return_inverse=True)
        count += different.size
        as_at_start = (simulated(different)[which] >= level) == inside
        start, end = np.where(as_at_start, middle, start), np.where(as_at_start, end, middle)
    for each, here, places in zip(
        outlines.values(), crossings, np.split((start + end) / 2, np.cumsum(sizes)[:-1]), strict=True
    ):
        each.at[here] = places
    return count


def _contours(stays: _Outline, kinds: Integers, peaks: Reals, level: float, unknown: int) -> Iterator[Points]:
    """Yield the contours of a peak, around the edge `stays` of all outcomes that overturn or are unknown.

    Near overturning, 1 - phi/phi_cr is proportional to the root of the distance: its square is interpolated.
    """
    beyond = stays.inside[1:-1, 1:-1]
    contour = _Outline(beyond | (peaks >= level), stays.start, stays.end)
    square = np.pad(np.where(beyond, 0.0, np.maximum(1 - np.where(beyond, 1.0, peaks), 0) ** 2), 1, mode="edge")
    ends = []
    for end, place in enumerate((contour.start, contour.end)):
        ends.append((np.where(_on_lines(stays.inside, end), stays.at, place), _on_lines(square, end)))
    (start, from_), (end_, to) = ends
    with np.errstate(invalid="ignore", divide="ignore"):
        share = np.clip((from_ - (1 - level) ** 2) / (from_ - to), 0, 1)
    hidden = np.pad(kinds == unknown, 1)
    hides = _on_lines(hidden, 0) | _on_lines(hidden, 1)
    moved = np.where(hides, stays.at, start + share * (end_ - start))
    contour.at = np.where(contour.differ & ~contour.in_frame, moved, contour.at)
    for loop, _ in contour.loops():
        line = contour.at[loop]
        ahead = np.roll(line, -1)
        if np.abs((line.conj() * ahead).imag.sum()) < MIN_WIDTH * np.abs(ahead - line).sum():  # twice the area
            continue
        under = hides[loop]
        cut = contour.in_frame[loop] | (under & np.roll(under, 1) & np.roll(under, -1))
        places = np.flatnonzero(cut)
        if not places.size:
            yield np.append(line, line[0])
            continue
        for piece in np.split(np.roll(line, -places[0]), places - places[0]):
            if piece.size > 2:
                yield piece[1:]

"""Closed lines from the lines of a drawing: doubles removed, ends joined, lines split, loops followed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Points, Reals
from rocking_cli.io.drawings.arcs import inner_points
from rocking_cli.io.drawings.contract import DrawingError, DrawnLine
from rocking_cli.questions.import_drawing.notes import DrawingFrame, ImportNote, length_in_words, many
from rocking_cli.questions.import_drawing.rings import (
    CHORD,
    ArcRing,
    RingsInRow,
    anticlockwise,
    chord_count,
    following,
    polygons_of,
    tidied,
)

if TYPE_CHECKING:
    from scipy.spatial import cKDTree

Integers = NDArray[np.intp]
EXACT = 1e-3  # share of the closing distance below which points are one without a search
MOST_NEIGHBOURS = 50  # ends within the closing distance of an end, on average, from which it is too large
TANGLE_SAMPLE, MOST_ACROSS = 200, 200_000  # lines of a sample, and pairs of lines that may cross
MOST_COMPARED = 4000  # ends that are compared with one another for a message
MOST_PLACES = 100  # places of a message


@dataclass(frozen=True, eq=False)
class Placed:
    """A line of a drawing in metres."""

    z: Points
    bulges: Reals
    closed: bool
    source: DrawnLine


@dataclass(frozen=True, eq=False)
class Loop:
    """A closed line, and the lines of the drawing that make it."""

    ring: ArcRing
    sources: Sequence[DrawnLine]


@dataclass
class Mended:
    """Counts and places of what was mended while loops were made [m]."""

    doubles: list[complex] = field(default_factory=list)
    joined: list[complex] = field(default_factory=list)
    widest: float = 0.0
    split: list[complex] = field(default_factory=list)
    faces: int = 0
    arcs_in_faces: int = 0

    def notes(self, frame: DrawingFrame) -> list[ImportNote]:
        """Return a note for each kind."""

        def places(points: Sequence[complex]) -> list[complex]:
            return [frame.to_drawing(each) for each in points]

        notes = []
        if self.doubles:
            words = f"{many(len(self.doubles), 'line')} drawn twice: each counts once"
            notes.append(ImportNote("drawn twice", len(self.doubles), words, places(self.doubles)))
        if self.joined:
            words = f"{many(len(self.joined), 'corner')} joined over gaps up to {length_in_words(self.widest)}"
            notes.append(ImportNote("joined", len(self.joined), words, places(self.joined)))
        if self.split:
            words = f"{many(len(self.split), 'line')} split where another line ends on them"
            notes.append(ImportNote("split", len(self.split), words, places(self.split)))
        if self.faces:
            words = f"{many(self.faces, 'outline')} found as faces between lines that cross or branch"
            words += f"; their {many(self.arcs_in_faces, 'arc')} became chords" if self.arcs_in_faces else ""
            notes.append(ImportNote("faces", self.faces, words))
        return notes


@dataclass(eq=False)
class DrawnEdges:
    """Sides of open lines: their ends, bulges and the lines that they are of."""

    a: Points
    b: Points
    bulge: Reals
    of: Integers

    @classmethod
    def from_lines(cls, lines: Sequence[Placed]) -> DrawnEdges:
        """Take the sides of lines, closed ones too."""
        a, b, bulge, of = [], [], [], []
        for k, line in enumerate(lines):
            z = line.z
            a.append(z if line.closed else z[:-1])
            b.append(following(z) if line.closed else z[1:])
            bulge.append(line.bulges if line.closed else line.bulges[:-1])
            of.append(np.full(len(a[-1]), k, np.intp))
        if not a:
            return cls(np.zeros(0, complex), np.zeros(0, complex), np.zeros(0), np.zeros(0, np.intp))
        return cls(np.concatenate(a), np.concatenate(b), np.concatenate(bulge), np.concatenate(of))

    def chosen(self, which: Any) -> DrawnEdges:
        """Return some of the sides."""
        return DrawnEdges(self.a[which], self.b[which], self.bulge[which], self.of[which])

    def joined(self, other: DrawnEdges) -> DrawnEdges:
        """Return these sides and others."""
        return DrawnEdges(
            np.append(self.a, other.a), np.append(self.b, other.b), np.append(self.bulge, other.bulge),
            np.append(self.of, other.of),
        )  # fmt: skip

    def curves(self, close: float) -> Any:
        """Return the sides as lines of shapely, arcs by chords; an array of objects, shape (n,)."""
        import shapely

        count = np.full(len(self), 2)
        inner: dict[int, Points] = {}
        for k in np.flatnonzero(self.bulge).tolist():
            ends = complex(self.a[k]), complex(self.b[k])
            inner[k] = inner_points(*ends, float(self.bulge[k]), lambda r, turn: chord_count(r, turn, CHORD * close))
            count[k] += len(inner[k])
        last = np.cumsum(count)
        z = np.empty(int(last[-1]) if len(last) else 0, np.complex128)
        z[last - count], z[last - 1] = self.a, self.b
        for k, points in inner.items():
            z[last[k] - count[k] + 1 : last[k] - 1] = points
        of = np.repeat(np.arange(len(self)), count)
        return shapely.linestrings(np.stack([z.real, z.imag], axis=1), indices=of)

    @property
    def middle(self) -> Points:
        """Middle of each side, on its arc."""
        return (self.a + self.b) / 2 - 0.5j * (self.b - self.a) * self.bulge

    def __len__(self) -> int:
        return len(self.a)


def loops(lines: Sequence[Placed], close: float, frame: DrawingFrame, file: str) -> tuple[list[Loop], Mended]:
    """Return the closed lines that lines make, and what was mended.

    Parameters
    ----------
    lines : sequence of Placed
        Open and closed lines of layers with one role.
    close : float
        Distance up to which ends are one point [m].
    frame : DrawingFrame
        The unit of the drawing, for messages.
    file : str
        Name of the file in messages.

    Raises
    ------
    DrawingError
        Of the class "unclosed", if a line closes nothing.
    """
    mended = Mended()
    closed = [line for line in lines if line.closed]
    open_ = [line for line in lines if not line.closed]
    turned = anticlockwise([ArcRing(line.z, line.bulges) for line in closed])
    made = [Loop(ring, [line.source]) for ring, line in zip(turned, closed, strict=True)]
    if open_:
        made = _with_open(made, closed, open_, close, mended, frame, file)
    rings = tidied([loop.ring for loop in made], close)
    made = [Loop(ring, loop.sources) for ring, loop in zip(rings, made, strict=True)]
    return _once(made, close, mended), mended


def _with_open(
    made: list[Loop],
    closed: list[Placed],
    open_: list[Placed],
    close: float,
    mended: Mended,
    frame: DrawingFrame,
    file: str,
) -> list[Loop]:
    """Return the loops of closed lines and of open ones, which may end on closed lines."""
    import shapely

    sources = [line.source for line in (*open_, *closed)]
    more, left = _followed(DrawnEdges.from_lines(open_), sources, close, mended)
    if not len(left):
        return made + more
    rings = [_curve(loop.ring, close) for loop in made]
    if rings:
        tree = shapely.STRtree(rings)
        on_ring = [np.isin(np.arange(len(left)), _near(tree, z, close)[0]) for z in (left.a, left.middle, left.b)]
        lies_on = np.logical_and.reduce(on_ring)
        mended.doubles += left.middle[lies_on].tolist()  # drawn on a closed line
        left = left.chosen(~lies_on)
        if not len(left):
            return made + more
        touched = np.unique(np.concatenate([_near(tree, z, close)[1] for z in (left.a, left.b)]))
        if touched.size:
            sides = DrawnEdges.from_lines([closed[k] for k in touched])
            sides.of = len(open_) + touched[sides.of]
            left = left.joined(sides)
            made = [loop for k, loop in enumerate(made) if k not in set(touched.tolist())]
    last, left = _followed(left, sources, close, mended)
    if len(left):
        raise _unclosed(left, close, frame, file)
    return made + more + last


def _near(tree: Any, z: Points, close: float) -> NDArray[np.intp]:
    """Return pairs of points and geometries of a tree within a distance, shape (2, n)."""
    import shapely

    pairs: NDArray[np.intp] = tree.query(shapely.points(z.real, z.imag), predicate="dwithin", distance=close)
    return pairs


def _curve(ring: ArcRing, close: float) -> Any:
    """Return the boundary of a ring as a line of shapely."""
    import shapely

    z = ring.chords(CHORD * close)
    return shapely.linearrings(np.stack([z.real, z.imag], axis=1))


def _doubles(edges: DrawnEdges, start: Integers, end: Integers, close: float) -> NDArray[np.bool_]:
    """Return which edges are drawn already, in either sense: they have the same nodes and the same middle."""
    low, high, middle = np.minimum(start, end), np.maximum(start, end), edges.middle
    order = np.lexsort((high, low))
    again = np.zeros(len(edges), bool)
    same = (low[order][1:] == low[order][:-1]) & (high[order][1:] == high[order][:-1])
    kept: list[int] = []
    for k, goes_on in zip(order.tolist(), [False, *same.tolist()], strict=True):
        kept = kept if goes_on else []
        again[k] = any(abs(middle[k] - middle[other]) <= close for other in kept)
        if not again[k]:
            kept.append(k)
    return again


def _check_crowd(tree: cKDTree, close: float) -> None:
    """Raise `DrawingError` if so many points are within the closing distance that it cannot be meant."""
    if tree.count_neighbors(tree, close) > MOST_NEIGHBOURS * tree.n:
        what = (
            f"most lines end within {length_in_words(close)} of many others: give a smaller `close`, or other `units`"
        )
        raise DrawingError("unclosed", what)


def _check_tangle(edges: DrawnEdges, close: float) -> None:
    """Raise `DrawingError` if so many lines lie across one another that they are no outlines, by a sample of them."""
    import shapely

    lines = edges.curves(close)
    sample = lines[:: max(len(lines) // TANGLE_SAMPLE, 1)]
    each = len(shapely.STRtree(lines).query(sample)[0]) / len(sample)
    if each > MOST_NEIGHBOURS and each * len(lines) > MOST_ACROSS:
        what = f"too many of its {len(lines):,} lines lie across one another: put what is no outline on another layer"
        raise DrawingError("too_large", what)


def _followed(
    edges: DrawnEdges, sources: Sequence[DrawnLine], close: float, mended: Mended
) -> tuple[list[Loop], DrawnEdges]:
    """Join the ends of edges, split edges where others end on them, and follow the loops.

    Returns the loops, and the edges of parts of the drawing in which an edge closes nothing.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    if not len(edges):
        return [], edges
    _check_tangle(edges, close)
    start, end, nodes = _nodes(edges, close, mended)
    edges, start, end = _split(edges, start, end, nodes, close, mended)
    edges.a, edges.b = nodes[start], nodes[end]
    again = _doubles(edges, start, end, close)
    mended.doubles += edges.middle[again].tolist()
    edges, start, end = edges.chosen(~again), start[~again], end[~again]
    graph = coo_array((np.ones(len(edges)), (start, end)), shape=(len(nodes), len(nodes)))
    parts, part_of = connected_components(graph, directed=False)
    part = part_of[start]
    crossed = np.zeros(parts, bool)
    crossed[part[_crossing(edges, start, end, close)]] = True
    made, loose = _traced(edges, start, end, sources, ~crossed[part], mended)
    if crossed.any():
        more, open_parts = _faces(edges, part, crossed, sources, close, mended)
        made, loose = made + more, loose | open_parts
    is_open = np.zeros(parts, bool)
    is_open[part[list(loose)]] = True
    return [loop for loop, k in made if not is_open[part[k]]], edges.chosen(is_open[part])


def joined_lines(lines: Sequence[Placed], close: float) -> list[Points]:
    """Return the corners of open lines, as one where one ends and another begins; arcs as chords."""
    import shapely

    if not lines:
        return []
    edges = DrawnEdges.from_lines(lines)
    start, end, nodes = _nodes(edges, close, Mended())
    edges.a, edges.b = nodes[start], nodes[end]
    merged = shapely.line_merge(shapely.multilinestrings(edges.chosen(start != end).curves(close)))
    return [shapely.get_coordinates(each) @ [1, 1j] for each in shapely.get_parts(merged)]


def _nodes(edges: DrawnEdges, close: float, mended: Mended) -> tuple[Integers, Integers, Points]:
    """Return the nodes at both ends of each edge, and the nodes: ends within the closing distance are one point."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    ends = np.append(edges.a, edges.b)
    grid = np.round(np.stack([ends.real, ends.imag], axis=1) / (EXACT * close))
    _, first, same = np.unique(grid, axis=0, return_index=True, return_inverse=True)
    points, same = ends[first], same.ravel()
    tree = cKDTree(np.stack([points.real, points.imag], axis=1))
    _check_crowd(tree, close)
    pairs = tree.query_pairs(close, output_type="ndarray")
    graph = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(points), len(points)))
    count, node_of = connected_components(graph, directed=False)
    size = np.bincount(node_of, minlength=count)
    sums = np.bincount(node_of, points.real, count), np.bincount(node_of, points.imag, count)
    nodes = np.asarray((sums[0] + 1j * sums[1]) / size, np.complex128)
    if len(pairs):
        gaps = np.abs(points[pairs[:, 0]] - points[pairs[:, 1]])
        wide = gaps > 2 * EXACT * close
        if wide.any():
            mended.widest = max(mended.widest, float(gaps.max()))
            mended.joined += nodes[np.unique(node_of[pairs[wide, 0]])].tolist()
    node: Integers = node_of[same].astype(np.intp)
    return node[: len(edges)], node[len(edges) :], nodes


def _split(
    edges: DrawnEdges, start: Integers, end: Integers, nodes: Points, close: float, mended: Mended
) -> tuple[DrawnEdges, Integers, Integers]:
    """Split edges at nodes of others that lie on them."""
    import shapely

    pairs = _near(shapely.STRtree(edges.curves(close)), nodes, close)
    node, edge = pairs
    inner = (node != start[edge]) & (node != end[edge])
    z = nodes[node]
    inner &= (np.abs(z - edges.a[edge]) > close) & (np.abs(z - edges.b[edge]) > close)
    node, edge = node[inner], edge[inner]
    if not node.size:
        keep = start != end
        return edges.chosen(keep), start[keep], end[keep]
    mended.split += nodes[node].tolist()
    a, b, bulge, of, s, e = [], [], [], [], [], []
    cuts: dict[int, list[int]] = {}
    for n, k in zip(node.tolist(), edge.tolist(), strict=True):
        cuts.setdefault(k, []).append(n)
    for k, between in cuts.items():
        share = {n: _share(edges, k, complex(nodes[n])) for n in between}
        order = sorted(between, key=share.__getitem__)
        marks = [0.0, *(share[n] for n in order), 1.0]
        chain = [int(start[k]), *order, int(end[k])]
        turn = 4 * np.arctan(edges.bulge[k])
        for (p, q), (u, v) in zip(pairwise(chain), pairwise(marks), strict=True):
            a.append(nodes[p])
            b.append(nodes[q])
            bulge.append(np.tan(turn * (v - u) / 4))
            of.append(edges.of[k])
            s.append(p)
            e.append(q)
    keep = np.ones(len(edges), bool)
    keep[list(cuts)] = False
    keep &= start != end
    kept = edges.chosen(keep)
    return (
        DrawnEdges(
            np.append(kept.a, a), np.append(kept.b, b), np.append(kept.bulge, bulge),
            np.append(kept.of, np.array(of, np.intp)),
        ),
        np.append(start[keep], np.array(s, np.intp)),
        np.append(end[keep], np.array(e, np.intp)),
    )  # fmt: skip


def _share(edges: DrawnEdges, k: int, z: complex) -> float:
    """Return where a point is along an edge, from 0 to 1; along the turn of an arc."""
    a, b, bulge = complex(edges.a[k]), complex(edges.b[k]), float(edges.bulge[k])
    if not bulge:
        return float(((z - a) * (b - a).conjugate()).real / abs(b - a) ** 2)
    centre = (a + b) / 2 + 1j * (b - a) * (1 - bulge**2) / (4 * bulge)
    turn = 4 * np.arctan(bulge)
    way = np.angle((z - centre) / (a - centre)) / turn
    return float(way % (2 * np.pi / abs(turn)))


def _crossing(edges: DrawnEdges, start: Integers, end: Integers, close: float) -> Integers:
    """Return pairs of edges that cross between their ends, shape (2, n)."""
    import shapely

    lines = edges.curves(close)
    one, other = shapely.STRtree(lines).query(lines)
    ends = np.stack([start, end])
    meet = (ends[:, None, one] == ends[None, :, other]).any(axis=(0, 1))
    both = (one < other) & ~(meet & (edges.bulge[one] == 0) & (edges.bulge[other] == 0))  # straight ones meet once
    one, other = one[both], other[both]
    cross = shapely.crosses(lines[one], lines[other])
    return np.stack([one[cross], other[cross]])


def _traced(
    edges: DrawnEdges,
    start: Integers,
    end: Integers,
    sources: Sequence[DrawnLine],
    which: NDArray[np.bool_],
    mended: Mended,
) -> tuple[list[tuple[Loop, int]], set[int]]:
    """Follow the faces between edges that meet only at their ends; arcs stay exact.

    Returns the loops, each with the number of an edge, and edges with the same face on both sides, which close nothing.
    """
    chosen, n = np.flatnonzero(which), len(edges)
    if not len(chosen):
        return [], set()
    # A half edge k runs from start to end, k + n back. The next one of a face is the first to the right at its end.
    tail, ways = np.concatenate([start[chosen], end[chosen]]), np.concatenate([chosen, chosen + n])
    order = np.lexsort((np.angle(_away(edges, start, end)[ways]), tail))
    tail, ways = tail[order], ways[order]
    firsts = np.flatnonzero(np.append(True, tail[1:] != tail[:-1]))
    to_the_right = np.arange(-1, len(ways) - 1)
    to_the_right[firsts] = np.append(firsts[1:], len(ways)) - 1
    following_way = np.empty(2 * n, np.intp)
    following_way[(ways + n) % (2 * n)] = ways[to_the_right]
    face_of, around, faces = _cycles(following_way.tolist(), ways.tolist())
    k, forward = around % n, around < n
    z = np.where(forward, edges.a[k], edges.b[k])
    bulges = np.where(forward, edges.bulge[k], -edges.bulge[k])
    made: list[tuple[Loop, int]] = []
    is_branch = (np.bincount(np.append(start, end)) > 2)[start[k]]
    rings = RingsInRow(z, bulges, np.array(faces[:-1])).rings()
    for ring, (first, last) in zip(rings, pairwise(faces), strict=True):
        if ring.moments.area > 0:
            of = dict.fromkeys(edges.of[k[first:last]].tolist())
            made.append((Loop(ring, [sources[j] for j in of]), int(k[first])))
            mended.faces += bool(is_branch[first:last].any())
    loose = {k for k in chosen.tolist() if face_of[k] == face_of[k + n]}
    return made, loose


def _cycles(following_way: Sequence[int], ways: Sequence[int]) -> tuple[Sequence[int], Integers, Sequence[int]]:
    """Return the cycle of each way, the ways cycle by cycle, and where in them each cycle begins, and the last ends."""
    cycle_of, around, begins = [-1] * len(following_way), [], [0]
    for first in ways:
        way = first
        while cycle_of[way] < 0:
            cycle_of[way] = first
            around.append(way)
            way = following_way[way]
        if len(around) > begins[-1]:
            begins.append(len(around))
    return cycle_of, np.array(around, np.intp), begins


def _reach(edges: DrawnEdges, start: Integers, end: Integers) -> Reals:
    """Return the distance from the nodes of each edge at which directions are compared, less than any edge there."""
    length = np.abs(edges.b - edges.a)
    shortest = np.full(int(max(start.max(), end.max())) + 1, np.inf)
    for nodes in (start, end):
        np.minimum.at(shortest, nodes, length)
    return np.asarray(np.minimum(shortest[start], shortest[end]) / 100)


def _away(edges: DrawnEdges, start: Integers, end: Integers) -> Points:
    """Return the direction of each half edge from its node: that of the point of its arc at a distance."""
    chord = np.concatenate([edges.b - edges.a, edges.a - edges.b])
    turn = 4 * np.arctan(np.concatenate([edges.bulge, -edges.bulge]))
    diameter = np.abs(chord) / np.sin(np.where(turn == 0, 1.0, np.abs(turn) / 2))
    reach = np.tile(_reach(edges, start, end), 2)
    to_chord = np.sign(turn) * 2 * np.arcsin(np.minimum(reach / diameter, 1.0))  # turn of the arc up to the distance
    return np.asarray(chord * np.exp(-0.5j * (turn - to_chord)))


def _faces(
    edges: DrawnEdges,
    part: Integers,
    crossed: NDArray[np.bool_],
    sources: Sequence[DrawnLine],
    close: float,
    mended: Mended,
) -> tuple[list[tuple[Loop, int]], set[int]]:
    """Return the faces between lines that cross, as `_traced` does; their arcs become chords."""
    import shapely

    chosen = np.flatnonzero(crossed[part])
    lines = edges.chosen(chosen).curves(close)
    faces, cuts, dangles, _ = shapely.polygonize_full([shapely.node(shapely.multilinestrings(lines))])
    loose = np.concatenate([shapely.get_parts(dangles), shapely.get_parts(cuts)])
    tree = shapely.STRtree(lines)
    _, at_loose = tree.query(loose[shapely.length(loose) > close], predicate="dwithin", distance=EXACT * close)
    open_parts = set(chosen[at_loose].tolist())
    middles = shapely.STRtree(shapely.line_interpolate_point(lines, 0.5, normalized=True))
    parts = shapely.get_parts(faces)
    parts = parts[shapely.area(parts) > close**2]
    face_of, on = middles.query(parts, predicate="dwithin", distance=close)
    starts = np.searchsorted(face_of, np.arange(len(parts) + 1))
    made = []
    corners = [shapely.get_coordinates(each)[:-1] @ [1, 1j] for each in shapely.get_exterior_ring(parts)]
    rings = anticlockwise([ArcRing(z, np.zeros(len(z))) for z in corners])
    for k, (face, ring) in enumerate(zip(parts, rings, strict=True)):
        sides = chosen[on[starts[k] : starts[k + 1]]]
        sides = sides if len(sides) else chosen[tree.query_nearest(face, all_matches=False)]
        of = dict.fromkeys(edges.of[sides].tolist())
        made.append((Loop(ring, [sources[each] for each in of]), int(sides[0])))
    mended.faces += len(made)
    mended.arcs_in_faces += int(np.count_nonzero(edges.bulge[chosen]))
    return made, open_parts


def _unclosed(edges: DrawnEdges, close: float, frame: DrawingFrame, file: str) -> DrawingError:
    """Return the error of lines that close nothing: the first of them, and the gap to the nearest loose end."""
    import shapely

    ends = np.append(edges.a, edges.b)[:MOST_COMPARED]
    apart = np.abs(ends[:, None] - ends[None, :])
    alone = (apart <= close).sum(axis=1) == 1
    loose = ends[alone] if alone.any() else ends[:2]
    apart = np.abs(loose[:, None] - loose[None, :])
    apart[apart <= close] = np.inf
    merged = shapely.get_parts(shapely.line_merge(shapely.multilinestrings(edges.curves(close))))
    z = shapely.get_coordinates(merged[0])
    one, other = complex(*z[0]), complex(*z[-1])
    gap = float(apart.min())
    gap_in_words = f"; the nearest loose ends are {length_in_words(gap)} apart" if np.isfinite(gap) else ""
    lines = many(len(edges), "line")
    what = f"{lines} close{'s' if len(edges) == 1 else ''} nothing: from {frame.place(one)} to {frame.place(other)}"
    at = frame.pairs(loose[:MOST_PLACES].tolist())
    return DrawingError("unclosed", f"{what}{gap_in_words}: close the outline, or give a larger `close`", file, at=at)


def _once(made: list[Loop], close: float, mended: Mended) -> list[Loop]:
    """Return loops without those that are drawn twice: by lines and as a polyline, or in the other sense."""
    import shapely
    from scipy.spatial import cKDTree

    if len(made) < 2:
        return made
    rings = [loop.ring for loop in made]
    boxes = shapely.bounds(polygons_of(rings, close))
    tree, reach = cKDTree(boxes), (2 + 2 * CHORD) * close
    second: set[int] = set()
    if tree.count_neighbors(tree, reach, p=np.inf) > MOST_NEIGHBOURS * tree.n:
        _, first = np.unique(np.round(boxes / close), axis=0, return_index=True)
        second = {*range(len(made))} - {*first.tolist()}
    for i, j in [] if second else sorted(tree.query_pairs(reach, p=np.inf)):
        room = close * shapely.length(_curve(rings[i], close))
        if i in second or abs(rings[i].moments.area - rings[j].moments.area) > 2 * room:
            continue
        if shapely.hausdorff_distance(_curve(rings[i], close), _curve(rings[j], close)) <= 2 * close:
            second.add(j)
    mended.doubles += [rings[k].moments.centroid for k in sorted(second)]
    return [loop for k, loop in enumerate(made) if k not in second]

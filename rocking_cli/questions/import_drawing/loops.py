"""Closed lines from the lines of a drawing: doubles removed, ends joined, lines split, loops followed."""

from __future__ import annotations

from collections import Counter
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
OVERSHOOT, OVERSHOOT_SHARE = 0.1, 0.1  # length of an end beyond a corner [m], and over the length of the outline


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
    crumbs: list[complex] = field(default_factory=list)
    slivers: list[complex] = field(default_factory=list)
    trimmed: list[complex] = field(default_factory=list)
    longest: float = 0.0
    faces: int = 0
    arcs_cut: int = 0

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
        if self.crumbs:
            words = f"{many(len(self.crumbs), 'line')} left out, shorter than `close` or drawn there and back"
            notes.append(ImportNote("crumbs", len(self.crumbs), words, places(self.crumbs)))
        if self.slivers:
            words = f"{many(len(self.slivers), 'sliver')} between lines left out, as thin as `close`"
            notes.append(ImportNote("slivers", len(self.slivers), words, places(self.slivers)))
        if self.trimmed:
            words = f"{many(len(self.trimmed), 'end')} of lines beyond a corner left out, up to "
            words += length_in_words(self.longest)
            notes.append(ImportNote("trimmed", len(self.trimmed), words, places(self.trimmed)))
        if self.faces:
            words = f"{many(self.faces, 'outline')} found as faces between lines that cross or branch"
            words += f"; their {many(self.arcs_cut, 'arc')} became chords" if self.arcs_cut else ""
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
    is_crumb = [_is_crumb(line, close) for line in lines]
    mended.crumbs = [complex(line.z[0]) for line, left_out in zip(lines, is_crumb, strict=True) if left_out]
    lines = [line for line, left_out in zip(lines, is_crumb, strict=True) if not left_out]
    closed = [line for line in lines if line.closed]
    open_ = [line for line in lines if not line.closed]
    turned = anticlockwise([ArcRing(line.z, line.bulges) for line in closed])
    made = [Loop(ring, [line.source]) for ring, line in zip(turned, closed, strict=True)]
    if open_:
        made = _with_open(made, closed, open_, close, mended, frame, file)
    rings = tidied([loop.ring for loop in made], close)
    made = [Loop(ring, loop.sources) for ring, loop in zip(rings, made, strict=True)]
    return _once(made, close, mended), mended


def _is_crumb(line: Placed, close: float) -> bool:
    """Return whether a line is no longer than the closing distance, or goes straight there and back."""
    there_and_back = line.closed and len(line.z) < 3 and not line.bulges.any()
    return there_and_back or (float(np.ptp(line.z.real) + np.ptp(line.z.imag)) <= close and not line.bulges.any())


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
        touched = np.unique(tree.query(left.curves(close), predicate="dwithin", distance=close)[1])
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
    made, loose = _faces(edges, crossed[part], sources, close, mended)
    is_open = np.zeros(parts, bool)
    is_open[part[loose]] = True
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


def _faces(
    edges: DrawnEdges, crossed: NDArray[np.bool_], sources: Sequence[DrawnLine], close: float, mended: Mended
) -> tuple[list[tuple[Loop, int]], Integers]:
    """Return the faces between edges, each with the number of an edge, and the edges that close nothing.

    Edges that cross others are cut there. An arc that is not cut stays exact; the pieces of one that is are chords.
    """
    import shapely

    lines = edges.curves(close)
    cut = shapely.get_parts(shapely.node(shapely.multilinestrings(lines[crossed])))
    faces, bridges, dangles, _ = shapely.polygonize_full([*lines[~crossed], *cut])
    faces = shapely.get_parts(faces)
    thin = shapely.area(faces) <= close * shapely.length(faces) / 4
    mended.slivers += (shapely.get_coordinates(shapely.centroid(faces[thin])) @ [1, 1j]).tolist()
    faces = faces[~thin]
    loose = np.concatenate([_loose(shapely.get_parts(dangles), faces, mended), shapely.get_parts(bridges)])
    tree = shapely.STRtree(lines)
    _, at_loose = tree.query(loose, predicate="dwithin", distance=EXACT * close)
    ways, degree = dict[tuple[Any, Any], tuple[int, int, float, Any]](), Counter[Any]()
    for k, line in enumerate(lines):
        corners = [*map(tuple, shapely.get_coordinates(line).tolist())]
        for way, bulge in ((corners, edges.bulge[k]), (corners[::-1], -edges.bulge[k])):
            ways[way[0], way[1]] = k, len(way) - 1, float(bulge), way[-1]
            degree[way[0]] += 1
    made, whole = [], set[int]()
    for face in faces:
        corners = [*map(tuple, shapely.get_coordinates(face.exterior)[:-1].tolist())]
        first = next((k for k, each in enumerate(corners) if degree[each]), 0)
        corners = [*corners[first:], *corners[:first], corners[first]]
        z, bulges, of, at = list[complex](), list[float](), list[int](), 0
        while at < len(corners) - 1:
            k, step, bulge, end = ways.get((corners[at], corners[at + 1]), (-1, 1, 0.0, None))
            if at + step >= len(corners) or corners[at + step] != end:  # a piece of an edge that is cut
                k, step, bulge = int(tree.nearest(shapely.LineString(corners[at : at + 2]).centroid)), 1, 0.0
            else:
                whole.add(k)
            z.append(complex(*corners[at]))
            bulges.append(bulge)
            of.append(k)
            at += step
        points, turns = np.array(z), np.array(bulges)
        apart = (np.abs(following(points) - points) > EXACT * close) | (turns != 0)  # a cut may be beside a chord's end
        ring = ArcRing.of(points[apart], turns[apart])
        made.append((Loop(ring, [sources[j] for j in dict.fromkeys(edges.of[of].tolist())]), of[0]))
        mended.faces += bool(crossed[of].any()) or any(degree[each.real, each.imag] > 2 for each in z)
    mended.arcs_cut += len({*np.flatnonzero(edges.bulge * crossed).tolist()} - whole)
    return made, at_loose


def _loose(dangles: Any, faces: Any, mended: Mended) -> Any:
    """Return lines that end freely, without short ones that go on beyond a corner of a face."""
    import shapely

    length = shapely.length(dangles)
    line, face = shapely.STRtree(faces).query(dangles, predicate="intersects")
    short = length[line] <= np.minimum(OVERSHOOT, OVERSHOOT_SHARE * shapely.length(faces[face]))
    beyond = np.unique(line[short])
    if len(beyond):
        mended.longest = max(mended.longest, float(length[beyond].max()))
        mended.trimmed += (shapely.get_coordinates(shapely.centroid(dangles[beyond])) @ [1, 1j]).tolist()
    return np.delete(dangles, beyond)


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

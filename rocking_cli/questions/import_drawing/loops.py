"""Closed lines from the lines of a drawing: doubles removed, ends joined, lines split, loops followed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Points, Reals
from rocking_cli.errors import named
from rocking_cli.io.drawings.contract import DrawingError, DrawnLine, arc_circle, inner_points
from rocking_cli.questions.import_drawing.legend import DrawingFrame, ImportNote, length_in_words, many
from rocking_cli.questions.import_drawing.rings import CHORD, ArcRing, chord_count, following, polygons_of

Integers = NDArray[np.intp]
EXACT = 1e-3  # share of the closing distance below which points are one without a search
MOST_NEIGHBOURS = 50  # ends within the closing distance of an end, on average, from which it is too large
TANGLE_SAMPLE, MOST_ACROSS = 200, 200_000  # lines of a sample, and pairs of lines that may cross
MOST_COMPARED = 4000  # ends that are compared with one another for a message
MOST_PLACES = 100  # places of a message
OVERSHOOT, OVERSHOOT_SHARE = 0.1, 0.1  # length of an end beyond a corner [m], and over the length of the outline
EDGE = np.dtype([("a", complex), ("b", complex), ("bulge", float), ("of", int), ("start", int), ("end", int)])
"""A side of a line: its ends and bulge, the number of its line, and the nodes at its ends."""
MENDED = {
    "drawn twice": ("line", "drawn twice: each counts once"),
    "joined": ("corner", "joined over gaps up to {}"),
    "split": ("line", "split where another line ends on them"),
    "crumbs": ("line", "left out, shorter than `close` or drawn there and back"),
    "slivers": ("sliver", "between lines left out, as thin as `close`"),
    "trimmed": ("end", "of lines beyond a corner left out, up to {}"),
}
"""What is mended while loops are made: the noun of the things, and words in which {} is the largest length."""


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


class Mended:
    """Places [m] of what was mended while loops were made, by kind, and the largest length of each kind [m]."""

    def __init__(self) -> None:
        self.at: dict[str, list[complex]] = {kind: [] for kind in MENDED}
        self.longest = dict.fromkeys(MENDED, 0.0)
        self.faces = self.arcs_cut = 0

    def add(self, kind: str, at: Iterable[complex], length: float = 0.0) -> None:
        """Add places of a kind."""
        self.at[kind] += map(complex, at)
        self.longest[kind] = max(self.longest[kind], length)

    def notes(self, frame: DrawingFrame) -> list[ImportNote]:
        """Return a note for each kind."""
        notes = []
        for kind, at in self.at.items():
            noun, words = MENDED[kind]
            sentence = f"{many(len(at), noun)} {words.format(length_in_words(self.longest[kind]))}"
            notes += [ImportNote(kind, len(at), sentence, [*map(frame.to_drawing, at)])] if at else []
        if self.faces:
            words = f"{many(self.faces, 'outline')} found as faces between lines that cross or branch"
            words += f"; their {many(self.arcs_cut, 'arc')} became chords" if self.arcs_cut else ""
            notes.append(ImportNote("faces", self.faces, words))
        return notes


def edges_of(lines: Sequence[Placed | ArcRing]) -> Any:
    """Return the sides of lines as an array of `EDGE`; their `start` is the place of the corner in its line."""
    count = np.array([len(line.z) for line in lines], int)
    ends = np.cumsum(count)
    of = np.repeat(np.arange(len(lines)), count)
    edges, after, keep = np.zeros(len(of), EDGE), np.arange(1, len(of) + 1), np.ones(len(of), bool)
    after[ends - 1] = ends - count
    is_open = np.array([isinstance(line, Placed) and not line.closed for line in lines], bool)
    keep[ends[is_open] - 1] = False
    edges["a"] = z = np.concatenate([np.zeros(0, complex), *(line.z for line in lines)])
    edges["b"], edges["of"], edges["start"] = z[after], of, np.arange(len(of)) - (ends - count)[of]
    edges["bulge"] = np.concatenate([np.zeros(0), *(line.bulges for line in lines)])
    return edges[keep]


def curves_of(edges: Any, close: float) -> Any:
    """Return sides as lines of shapely, arcs by chords; an array of objects, shape (n,)."""
    import shapely

    z: list[Any] = list(np.stack([edges["a"], edges["b"]], axis=1))
    for k in np.flatnonzero(edges["bulge"]).tolist():
        a, b, bulge = edges[["a", "b", "bulge"]][k].item()
        inner = inner_points(a, b, bulge, lambda r, turn: chord_count(r, turn, CHORD * close))
        z[k] = np.concatenate(([a], inner, [b]))
    of = np.repeat(np.arange(len(z)), [len(each) for each in z])
    points = np.concatenate(z) if z else np.zeros(0, complex)
    return shapely.linestrings(np.stack([points.real, points.imag], axis=1), indices=of)


def _middles(edges: Any) -> Points:
    """Return the middle of each side, on its arc."""
    middles: Points = (edges["a"] + edges["b"]) / 2 - 0.5j * (edges["b"] - edges["a"]) * edges["bulge"]
    return middles


def loops(lines: Sequence[Placed], frame: DrawingFrame) -> tuple[list[Loop], Mended]:
    """Return the closed lines that lines make, and what was mended.

    Parameters
    ----------
    lines : sequence of Placed
        Open and closed lines of layers with one role.
    frame : DrawingFrame
        The drawing, with the distance up to which ends are one point.

    Raises
    ------
    DrawingError
        Of the class "unclosed", if a line closes nothing.
    """
    mended, close = Mended(), frame.close
    is_crumb = [_is_crumb(line, close) for line in lines]
    mended.add("crumbs", [line.z[0] for line, left_out in zip(lines, is_crumb, strict=True) if left_out])
    lines = [line for line, left_out in zip(lines, is_crumb, strict=True) if not left_out]
    closed = [line for line in lines if line.closed]
    open_ = [line for line in lines if not line.closed]
    made = [Loop(ArcRing.of(line.z, line.bulges), [line.source]) for line in closed]
    if open_:
        made = _with_open(made, closed, open_, mended, frame)
    return _once([Loop(loop.ring.tidied(close), loop.sources) for loop in made], close, mended), mended


def _is_crumb(line: Placed, close: float) -> bool:
    """Return whether a line is no longer than the closing distance, or goes straight there and back."""
    z = line.z
    is_small = abs(z[1] - z[0]) <= close and np.ptp(z.real) + np.ptp(z.imag) <= close
    nothing = (line.closed and len(z) < 3) or is_small
    return bool(nothing and not line.bulges.any())


def _with_open(
    made: list[Loop], closed: list[Placed], open_: list[Placed], mended: Mended, frame: DrawingFrame
) -> list[Loop]:
    """Return the loops of closed lines and of open ones, which may end on closed lines."""
    import shapely

    close, sources = frame.close, [line.source for line in (*open_, *closed)]
    more, left = _followed(edges_of(open_), sources, close, mended)
    if len(left) and made:
        tree = shapely.STRtree([_curve(loop.ring, close) for loop in made])
        points = left["a"], _middles(left), left["b"]
        on_ring = [np.isin(np.arange(len(left)), _near(tree, z, close)[0]) for z in points]
        lies_on = np.logical_and.reduce(on_ring)
        mended.add("drawn twice", _middles(left[lies_on]))  # drawn on a closed line
        left = left[~lies_on]
        touched = np.unique(tree.query(curves_of(left, close), predicate="dwithin", distance=close)[1]).tolist()
        sides = edges_of([closed[k] for k in touched])
        sides["of"] = len(open_) + np.array(touched, int)[sides["of"]]
        left = np.append(left, sides)
        made = [loop for k, loop in enumerate(made) if k not in {*touched}]
    last, left = _followed(left, sources, close, mended)
    if len(left):
        raise _unclosed(left, frame)
    return made + more + last


def _near(tree: Any, z: Points, close: float) -> NDArray[np.intp]:
    """Return pairs of points and geometries of a tree within a distance, shape (2, n)."""
    import shapely

    pairs: NDArray[np.intp] = tree.query(shapely.points(z.real, z.imag), predicate="dwithin", distance=close)
    return pairs


def _curve(ring: ArcRing, close: float) -> Any:
    """Return the boundary of a ring as a line of shapely."""
    return polygons_of([ring], close)[0].exterior


def _is_double(edges: Any, close: float) -> NDArray[np.bool_]:
    """Return which edges are drawn already, in either sense: they have the same nodes and the same middle."""
    start, end, middle = edges["start"], edges["end"], _middles(edges)
    low, high = np.minimum(start, end), np.maximum(start, end)
    order = np.lexsort((np.where(start < end, 1, -1) * edges["bulge"], high, low))
    one, other = order[:-1], order[1:]
    again = np.zeros(len(edges), bool)
    again[other] = (low[one] == low[other]) & (high[one] == high[other]) & (abs(middle[one] - middle[other]) <= close)
    return again


def _check_tangle(edges: Any, close: float) -> None:
    """Raise `DrawingError` if so many lines lie across one another that they are no outlines, by a sample of them."""
    import shapely

    lines = curves_of(edges, close)
    sample = lines[:: max(len(lines) // TANGLE_SAMPLE, 1)]
    each = len(shapely.STRtree(lines).query(sample)[0]) / len(sample)
    if each > MOST_NEIGHBOURS and each * len(lines) > MOST_ACROSS:
        what = f"too many of its {len(lines):,} lines lie across one another: put what is no outline on another layer"
        raise DrawingError("too_large", what)


def _followed(edges: Any, sources: Sequence[DrawnLine], close: float, mended: Mended) -> tuple[list[Loop], Any]:
    """Join the ends of edges, split edges where others end on them, and follow the loops.

    Returns the loops, and the edges of parts of the drawing in which an edge closes nothing.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    if not len(edges):
        return [], edges
    _check_tangle(edges, close)
    nodes = _nodes(edges, close, mended)
    edges = _split(edges, nodes, close, mended)
    again = _is_double(edges, close)
    mended.add("drawn twice", _middles(edges[again]))
    edges = edges[~again]
    graph = coo_array((np.ones(len(edges)), (edges["start"], edges["end"])), shape=(len(nodes), len(nodes)))
    parts, part_of = connected_components(graph, directed=False)
    part = part_of[edges["start"]]
    crossed = np.zeros(parts, bool)
    crossed[part[_crossing(edges, close)]] = True
    made, loose = _faces(edges, crossed[part], sources, close, mended)
    is_open = np.zeros(parts, bool)
    is_open[part[loose]] = True
    return [loop for loop, k in made if not is_open[part[k]]], edges[is_open[part]]


def joined_lines(lines: Sequence[Placed], close: float) -> list[Points]:
    """Return the corners of open lines, as one where one ends and another begins; arcs as chords."""
    import shapely

    edges = edges_of(lines)
    if not len(edges):
        return []
    _nodes(edges, close, Mended())
    merged = shapely.line_merge(shapely.multilinestrings(curves_of(edges[edges["start"] != edges["end"]], close)))
    return [shapely.get_coordinates(each) @ [1, 1j] for each in shapely.get_parts(merged)]


def _nodes(edges: Any, close: float, mended: Mended) -> Points:
    """Put the ends of edges on nodes, and return these: ends within the closing distance are one point."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    ends = np.append(edges["a"], edges["b"])
    grid = np.round(np.stack([ends.real, ends.imag], axis=1) / (EXACT * close))
    _, first, same = np.unique(grid, axis=0, return_index=True, return_inverse=True)
    points = ends[first]
    tree = cKDTree(np.stack([points.real, points.imag], axis=1))
    if tree.count_neighbors(tree, close) > MOST_NEIGHBOURS * tree.n:
        what = f"most lines end within {length_in_words(close)} of many others"
        raise DrawingError("unclosed", f"{what}: give a smaller {named('close')}, or other {named('units')}")
    one, other = tree.query_pairs(close, output_type="ndarray").T
    graph = coo_array((np.ones(len(one)), (one, other)), shape=(len(points), len(points)))
    count, node_of = connected_components(graph, directed=False)
    x, y, size = (np.bincount(node_of, weights, count) for weights in (points.real, points.imag, None))
    nodes = np.asarray((x + 1j * y) / size, np.complex128)
    gaps = np.abs(points[one] - points[other])
    wide = gaps > 2 * EXACT * close
    mended.add("joined", nodes[np.unique(node_of[one[wide]])], float(gaps.max(where=wide, initial=0.0)))
    edges["start"], edges["end"] = node_of[same.ravel()].reshape(2, -1)
    edges["a"], edges["b"] = nodes[edges["start"]], nodes[edges["end"]]
    return nodes


def _split(edges: Any, nodes: Points, close: float, mended: Mended) -> Any:
    """Split edges at nodes of others that lie on them."""
    import shapely

    node, edge = _near(shapely.STRtree(curves_of(edges, close)), nodes, close)
    z, by = nodes[node], edges[edge]
    inner = (node != by["start"]) & (node != by["end"]) & (abs(z - by["a"]) > close) & (abs(z - by["b"]) > close)
    mended.add("split", z[inner])
    node, edge = node[inner], edge[inner]
    order = np.argsort(edge, kind="stable")
    cut, first = np.unique(edge[order], return_index=True)
    keep, pieces = edges["start"] != edges["end"], []
    keep[cut] = False
    for k, on in zip(cut.tolist(), np.split(node[order], first[1:]), strict=bool(len(cut))):
        share = _shares(edges[k], nodes[on])
        along = np.argsort(share)
        chain = np.array([edges["start"][k], *on[along], edges["end"][k]])
        piece = np.repeat(edges[k : k + 1], len(on) + 1)
        piece["start"], piece["end"] = chain[:-1], chain[1:]
        piece["a"], piece["b"] = nodes[chain[:-1]], nodes[chain[1:]]
        piece["bulge"] = np.tan(np.arctan(edges["bulge"][k]) * np.diff([0.0, *share[along], 1.0]))
        pieces.append(piece)
    return np.concatenate([edges[keep], *pieces])


def _shares(edge: Any, z: Points) -> Reals:
    """Return where points are along an edge, from 0 to 1; along the turn of an arc."""
    a, b, bulge = edge["a"], edge["b"], edge["bulge"]
    if not bulge:
        return np.asarray(((z - a) * (b - a).conj()).real / abs(b - a) ** 2)
    centre, _ = arc_circle(a, b, bulge)
    turn = 4 * np.arctan(bulge)
    return np.asarray(np.angle((z - centre) / (a - centre)) / turn % (2 * np.pi / abs(turn)))


def _crossing(edges: Any, close: float) -> Integers:
    """Return pairs of edges that cross between their ends, shape (2, n)."""
    import shapely

    lines = curves_of(edges, close)
    one, other = shapely.STRtree(lines).query(lines)
    one, other = one[one < other], other[one < other]
    ends = np.stack([edges["start"], edges["end"]])
    meet = (ends[:, None, one] == ends[None, :, other]).any(axis=(0, 1))
    may = ~meet | (edges["bulge"][one] != 0) | (edges["bulge"][other] != 0)  # straight ones meet once
    one, other = one[may], other[may]
    cross = shapely.crosses(lines[one], lines[other])
    return np.stack([one[cross], other[cross]])


def _faces(
    edges: Any, crossed: NDArray[np.bool_], sources: Sequence[DrawnLine], close: float, mended: Mended
) -> tuple[list[tuple[Loop, int]], Integers]:
    """Return the faces between edges, each with the number of an edge, and the edges that close nothing.

    Edges that cross others are cut there. An arc that is not cut stays exact; the pieces of one that is are chords.
    """
    import shapely

    lines = curves_of(edges, close)
    cut = shapely.get_parts(shapely.node(shapely.multilinestrings(lines[crossed])))
    faces, bridges, dangles, _ = shapely.polygonize_full([*lines[~crossed], *cut])
    faces = shapely.get_parts(faces)
    thin = shapely.area(faces) <= close * shapely.length(faces) / 4
    mended.add("slivers", _middles_of(faces[thin]))
    faces = faces[~thin]
    loose = np.concatenate([_loose(shapely.get_parts(dangles), faces, mended), shapely.get_parts(bridges)])
    tree = shapely.STRtree(lines)
    _, at_loose = tree.query(loose, predicate="dwithin", distance=EXACT * close)
    ways, degree = dict[tuple[complex, complex], tuple[int, int, float, complex]](), Counter[complex]()
    for k, (corners, bulge) in enumerate(zip(_corners(lines), edges["bulge"].tolist(), strict=True)):
        a, b = corners[0], corners[-1]
        ways[a, corners[1]], ways[b, corners[-2]] = (k, len(corners) - 1, bulge, b), (k, len(corners) - 1, -bulge, a)
        degree.update((a, b))
    made, whole = [], set[int]()
    for corners in _corners(shapely.get_exterior_ring(faces)):
        first = next((k for k, each in enumerate(corners) if degree[each]), 0)
        corners = [*corners[first:-1], *corners[: first + 1]]
        sides, at = list[tuple[complex, float, int]](), 0
        while at < len(corners) - 1:
            k, step, bulge, end = ways.get((corners[at], corners[at + 1]), (-1, 1, 0.0, None))
            if at + step >= len(corners) or corners[at + step] != end:  # a piece of an edge that is cut
                middle = (corners[at] + corners[at + 1]) / 2
                k, step, bulge = int(tree.nearest(shapely.Point(middle.real, middle.imag))), 1, 0.0
            else:
                whole.add(k)
            sides.append((corners[at], bulge, k))
            at += step
        z, bulges, of = (np.array(each) for each in zip(*sides, strict=True))
        apart = (np.abs(following(z) - z) > EXACT * close) | (bulges != 0)  # a cut may be beside a chord's end
        ring = ArcRing.of(z[apart], bulges[apart])
        made.append((Loop(ring, [sources[j] for j in dict.fromkeys(edges["of"][of].tolist())]), int(of[0])))
        mended.faces += bool(crossed[of].any()) or any(degree[each] > 2 for each in z.tolist())
    mended.arcs_cut += len({*np.flatnonzero(edges["bulge"] * crossed).tolist()} - whole)
    return made, at_loose


def _corners(lines: Any) -> list[list[complex]]:
    """Return the corners of lines of shapely."""
    import shapely

    points, of = shapely.get_coordinates(lines, return_index=True)
    z = (points @ [1, 1j]).tolist()
    return [z[first:last] for first, last in pairwise(np.searchsorted(of, np.arange(len(lines) + 1)).tolist())]


def _middles_of(shapes: Any) -> list[complex]:
    """Return the centroids of shapes of shapely."""
    import shapely

    middles: list[complex] = (shapely.get_coordinates(shapely.centroid(shapes)) @ [1, 1j]).tolist()
    return middles


def _loose(dangles: Any, faces: Any, mended: Mended) -> Any:
    """Return lines that end freely, without short ones that go on beyond a corner of a face."""
    import shapely

    length = shapely.length(dangles)
    line, face = shapely.STRtree(faces).query(dangles, predicate="intersects")
    short = length[line] <= np.minimum(OVERSHOOT, OVERSHOOT_SHARE * shapely.length(faces[face]))
    beyond = np.unique(line[short])
    mended.add("trimmed", _middles_of(dangles[beyond]), float(length[beyond].max(initial=0.0)))
    return np.delete(dangles, beyond)


def _unclosed(edges: Any, frame: DrawingFrame) -> DrawingError:
    """Return the error of lines that close nothing: the first of them, and the gap to the nearest loose end."""
    import shapely

    ends = np.append(edges["a"], edges["b"])[:MOST_COMPARED]
    alone = (np.abs(ends[:, None] - ends[None, :]) <= frame.close).sum(axis=1) == 1
    loose = ends[alone] if alone.any() else ends[:2]
    apart = np.abs(loose[:, None] - loose[None, :])
    gap = float(apart.min(where=apart > frame.close, initial=np.inf))
    gap_in_words = f"; the nearest loose ends are {length_in_words(gap)} apart" if np.isfinite(gap) else ""
    merged = shapely.get_parts(shapely.line_merge(shapely.multilinestrings(curves_of(edges, frame.close))))
    one, *_, other = map(frame.place, _corners(merged[:1])[0])
    what = f"{many(len(edges), 'line')} close{'s' if len(edges) == 1 else ''} nothing: from {one} to {other}"
    what += f"{gap_in_words}: close the outline, or give a larger {named('close')}"
    return frame.refusal("unclosed", what, loose[:MOST_PLACES].tolist())


def _once(made: list[Loop], close: float, mended: Mended) -> list[Loop]:
    """Return loops without those that are drawn twice: by lines and as a polyline, or in the other sense."""
    import shapely
    from scipy.spatial import cKDTree

    if len(made) < 2:
        return made
    polygons = polygons_of([loop.ring for loop in made], close)
    boxes, lines = shapely.bounds(polygons), shapely.get_exterior_ring(polygons)
    tree, reach = cKDTree(boxes), (2 + 2 * CHORD) * close
    second: set[int] = set()
    if tree.count_neighbors(tree, reach, p=np.inf) > MOST_NEIGHBOURS * tree.n:
        _, first = np.unique(np.round(boxes / close), axis=0, return_index=True)
        second = {*range(len(made))} - {*first.tolist()}
    for i, j in [] if second else sorted(tree.query_pairs(reach, p=np.inf)):
        if i not in second and shapely.hausdorff_distance(lines[i], lines[j]) <= 2 * close:
            second.add(j)
    mended.add("drawn twice", [made[k].ring.moments.centroid for k in sorted(second)])
    return [loop for k, loop in enumerate(made) if k not in second]

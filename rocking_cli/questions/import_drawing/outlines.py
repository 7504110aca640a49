"""The bodies, openings and ground of a drawing: which lines mean what, and what encloses what."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from shlex import quote
from typing import Any

import numpy as np

from rocking_cli.io.drawings.contract import DrawingError, DrawnLine, DrawnPoint, DrawnText, LineDrawing
from rocking_cli.questions.import_drawing.loops import DrawnEdges, Loop, Placed, loops
from rocking_cli.questions.import_drawing.notes import DrawingFrame, ImportNote, length_in_words, many
from rocking_cli.questions.import_drawing.rings import ArcRing, PlaneMoments, polygons_of
from rocking_cli.questions.import_drawing.roles import Role, Roles, counted, proposed
from rocking_cli.text import cut, in_short, seen
from rocking_cli.units import UnitError, mass_of_weight, read

FLATNESS = 1e-9  # area up to which an outline encloses nothing, over the square of its size
SLIVER = 1e-6  # area up to which an outline may enclose nothing, over the square of its length
OF_LINES = {Role.LOADS, Role.TIES, Role.SUPPORTS}  # what is drawn as lines, points and texts
ROUND = {"CIRCLE", "circle", "ellipse"}  # marks of points
MAX_BODIES, MAX_CORNERS = 10_000, 10_000  # of a structure file, and of each body in it
MEETING = 1e-3  # distance of ends that may be one point, over the size of their layer
AT_A_TIME = 100  # outlines compared with all others at a time, as one of 20,000 may lie within all others
LEAST_ENDS = 4  # of lines that may enclose something
MEETING_SHARE = 0.75  # of the ends of a layer that lie on other lines, from which it may hold outlines
MAX_MEETING = 4_000  # lines up to which this is looked for; more may hold outlines
SAME_HEIGHT = 1e-6  # difference of heights of bodies of which the left one comes first [m]
ROW = 0.5  # share of its height by which a body must be above the first one of a row to begin another row
DENSITY = re.compile(r"(?<![\d.,])(\d+(?:[.,' ]\d+)*)\s*([A-Za-z]+\s*/\s*[dc]?m\s*3)")
PER_VOLUME = re.compile(r"/\s*[dc]?m\s*3\b")
THOUSANDS = re.compile(r"\d{1,3}[.,' ]\d{3}")
GRID = 1e-3  # share of the closing distance to which shapes are cut; without a grid GEOS has errors at common sides
TOUCHES = 4  # length of an outline that the corner of an opening alone may reach, over the closing distance


@dataclass(eq=False)
class DrawnBody:
    """A body as it is drawn: its outline, its openings, its name, its density, and the lines of the drawing."""

    ring: ArcRing
    sources: Sequence[DrawnLine]
    openings: list[ArcRing] = field(default_factory=list)
    name: str = ""
    density: float | None = None

    @property
    def layer(self) -> str:
        """Layer of the body."""
        return self.sources[0].layer

    @property
    def moments(self) -> PlaneMoments:
        """Exact moments without the openings."""
        return PlaneMoments.of_sum([self.ring.moments, *(each.moments.negative() for each in self.openings)])

    @property
    def is_plain(self) -> bool:
        """Whether all sides are straight, and there are no openings."""
        return not self.ring.arcs and not self.openings


@dataclass(frozen=True)
class Sorted:
    """The chains of a drawing by role, without those of layers that mean nothing."""

    chains: Mapping[Role, Sequence[DrawnLine]]
    labels: Sequence[DrawnText]
    roles: Roles
    notes: Sequence[ImportNote]


def by_role(drawing: LineDrawing, roles: Roles, file: str) -> Sorted:
    """Sort the lines of a drawing by the roles of their layers.

    Raises
    ------
    DrawingError
        "layers", if it is not clear which layers are bodies; "empty", if nothing is drawn.
    """
    unknown: dict[str, list[DrawnLine]] = {}
    chains: dict[Role, list[DrawnLine]] = {role: [] for role in Role}
    for chain in drawing.chains:
        role = roles(chain.layer)
        if role in OF_LINES and _is_shape(chain) and chain.layer not in roles.given:
            take, leave = (quote(f"{each}={seen(chain.layer)}") for each in (Role.BODIES, role))
            what = f"{described(chain)} is closed, and the name of its layer says {role}, which are drawn as lines"
            raise DrawingError("layers", f"{what}: give `layers` {take}, or {leave}", file)
        (unknown.setdefault(chain.layer, []) if role is None else chains[role]).append(chain)
    of_bodies = chains[Role.BODIES]
    counts = {layer: count for layer, of in unknown.items() if (count := outline_count(of, of_bodies))}
    if counts:  # lines of one layer may close outlines with those of another
        beside = {layer: [each for other in unknown if other != layer for each in unknown[other]] for layer in unknown}
        counts |= {
            layer: count for layer, of in unknown.items()
            if layer not in counts and (count := outline_count(of, [*of_bodies, *beside[layer]]))
        }  # fmt: skip
    notes = []
    if len(counts) == 1 and not of_bodies:
        (layer,) = counts
        roles = Roles({**roles.given, layer: Role.BODIES})
        chains[Role.BODIES] = unknown.pop(layer)
        words = f"the layer {seen(layer) or '(none)'} alone has outlines: they are taken as bodies"
        notes.append(ImportNote("layers", 1, words))
    elif counts:
        named_bodies: dict[str, list[DrawnLine]] = {}
        for chain in of_bodies:
            named_bodies.setdefault(chain.layer, []).append(chain)
        guess, frames = proposed({layer: unknown[layer] for layer in counts} | named_bodies)
        named = {role: ",".join(seen(layer) for layer in of if layer in counts) for role, of in guess.items()}
        give = " ".join(f"`layers` {quote(f'{role}={of}')}" for role, of in named.items() if of)
        some = f"{seen(next(iter(counts)))} has" if len(counts) == 1 else f"{len(counts)} of them have"
        counts |= {layer: outline_count(lines) for layer, lines in named_bodies.items()}
        what = f"which layers are bodies? {counted(counts)}; {some} no known role: by what is drawn there, {give}"
        if around := [seen(layer) for layer in frames if layer in counts and layer in unknown]:
            what += f" ({around[0]} is taken for a frame, as it is around all else"
            if inside := named.get(Role.BODIES):
                take, leave = quote(f"{Role.BODIES}={around[0]}"), quote(f"{Role.OPENINGS}={inside}")
                what += f": if it has openings, `layers` {take} `layers` {leave}"
            what += ")"
        raise DrawingError("layers", f"{what} (other roles: {', '.join(Role)})", file)
    if not chains[Role.BODIES]:
        held: list[DrawnLine | DrawnText | DrawnPoint] = [*drawing.chains, *drawing.labels, *drawing.spots]
        kinds = Counter(each.kind for each in held)
        for each in drawing.left_out:
            kinds[each.kind] += each.count
        what = in_short([f"{count:,} {kind}" for kind, count in kinds.most_common()]) or "an empty page"
        where = in_short([f"{seen(layer) or 'no layer'} ({len(lines)} lines)" for layer, lines in unknown.items()])
        if dropped := sorted({seen(each.layer) for each in chains[Role.NOTHING] if _is_shape(each)}):
            give = quote(f"{Role.BODIES}={','.join(dropped)}")
            what += f", on {in_short(dropped)}, whose name says that nothing on it counts: give `layers` {give}"
        elif where:
            what += f"; lines that do not close are on {where}: give `layers` bodies=LAYER if they are bodies"
        raise DrawingError("empty", f"there is no outline in it, only {what}", file)
    left = Counter((chain.kind, layer) for layer, of in unknown.items() for chain in of)
    left |= Counter((chain.kind, chain.layer) for chain in chains[Role.NOTHING])
    notes += [
        ImportNote("left out", count, f"left out: {count:,} {kind} on {seen(layer) or 'no layer'}")
        for (kind, layer), count in left.items()
    ]
    notes += [
        ImportNote(
            "left out",
            each.count,
            f"left out: {each.count:,} {each.kind} on {seen(each.layer) or 'no layer'}, {each.why}",
        )
        for each in drawing.left_out
    ]
    return Sorted(chains, drawing.labels, roles, notes)


def _is_shape(chain: DrawnLine) -> bool:
    """Return whether a line is an outline: no hatch, and no circle that marks a point."""
    return chain.closed and not chain.is_fill and chain.kind not in ROUND


def outline_count(chains: Sequence[DrawnLine], beside: Sequence[DrawnLine] = ()) -> int:
    """Return how many outlines chains make, at least: closed ones, and one of open lines whose ends mostly meet others.

    Parameters
    ----------
    chains : sequence of DrawnLine
        Lines of a layer.
    beside : sequence of DrawnLine
        Lines of other layers that may close outlines with them.
    """
    closed = sum((chain.closed or _nearly_closed(chain)) and not chain.is_fill for chain in chains)
    fills = len({chain.shape for chain in chains if chain.is_fill})
    open_ = [chain for chain in chains if not chain.closed and len(chain.points) > 1]
    if len(open_) > 1:
        around = [*chains, *beside]
        closed += len(around) > MAX_MEETING or _mostly_meet(open_, around)
    return closed or fills


def _nearly_closed(chain: DrawnLine) -> bool:
    """Return whether an open line of several sides ends next to where it begins."""
    z = chain.points
    return len(z) > 3 and abs(z[0] - z[-1]) <= MEETING * max(float(np.ptp(z.real)), float(np.ptp(z.imag)))


def _mostly_meet(open_: Sequence[DrawnLine], around: Sequence[DrawnLine]) -> bool:
    """Return whether most ends of open lines lie on other lines, so that these may enclose something."""
    import shapely

    lines = [Placed(chain.points, chain.bulges, chain.closed, chain) for chain in around if len(chain.points) > 1]
    z = np.concatenate([chain.points for chain in open_])
    reach = MEETING * max(float(np.ptp(z.real)), float(np.ptp(z.imag)))
    if not reach > 0:
        return False
    edges = DrawnEdges.from_lines(lines)
    ends = np.array([[chain.points[0], chain.points[-1]] for chain in open_])
    point, edge = shapely.STRtree(edges.curves(reach)).query(
        shapely.points(ends.real.ravel(), ends.imag.ravel()), predicate="dwithin", distance=reach
    )
    of = np.array([id(line.source) for line in lines])[edges.of[edge]]
    others = of != np.array([id(chain) for chain in open_])[point // 2]
    met = len(np.unique(point[others]))
    return met >= LEAST_ENDS and met >= MEETING_SHARE * ends.size


def placed(chains: Sequence[DrawnLine], frame: DrawingFrame, close: float, file: str) -> list[Placed]:
    """Return chains in metres. Raises `DrawingError` "not_plane" for one that is not level in z."""
    chains = [chain for chain in chains if len(chain.points) > 1]
    if not chains:
        return []
    z = frame.to_metres(np.concatenate([chain.points for chain in chains]))
    lines, end = [], 0
    for chain in chains:
        begin, end = end, end + len(chain.points)
        if (chain.heights[1] - chain.heights[0]) * frame.per > close:
            depth = length_in_words((chain.heights[1] - chain.heights[0]) * frame.per)
            what = f"{described(chain)} is not plane: its corners differ by {depth} in z. Draw the section in one plane"
            raise DrawingError("not_plane", what, file, at=frame.pairs(z[begin : begin + 1].tolist()))
        lines.append(Placed(z[begin:end], chain.bulges, chain.closed, chain))
    return lines


def described(chain: DrawnLine) -> str:
    """Return what a line is in the file: "LWPOLYLINE 2F on MURO"."""
    return f"{chain.kind}{f' {seen(chain.handle)}' if chain.handle else ''} on {seen(chain.layer) or 'no layer'}"


def bodies_of(
    of: Sorted, frame: DrawingFrame, close: float, nested: str | None, file: str
) -> tuple[list[DrawnBody], list[ImportNote], list[complex]]:
    """Return the bodies of a drawing with their openings, in reading order, and what was mended and where [m].

    Raises
    ------
    DrawingError
        "unclosed", "thin", "crosses", "nested", "opening" or "not_plane".
    """
    drawn = [chain for chain in of.chains[Role.BODIES] if not chain.is_fill]
    fills = [chain for chain in of.chains[Role.BODIES] if chain.is_fill]
    made, mended = loops(placed(drawn, frame, close, file), close, frame, file)
    notes = mended.notes(frame)
    rings = [*mended.doubles, *mended.joined, *mended.split, *mended.slivers, *mended.trimmed]
    cut: list[Loop] = []
    if of.chains[Role.OPENINGS]:
        cut, others = loops(placed(of.chains[Role.OPENINGS], frame, close, file), close, frame, file)
        _check_each(cut, frame, close, file)
        notes += others.notes(frame)
    if fills:
        hatched, holes = _by_shape(loops(placed(fills, frame, close, file), close, frame, file)[0], close)
        hatched, spare = _apart(hatched, made, close)
        islands, drawn_too = _apart(holes, [*made, *cut], close, same=True)
        made, cut = made + hatched, cut + islands
        if left := len(spare) + len(drawn_too):
            notes.append(ImportNote("left out", left, f"{many(left, 'edge')} of hatches left out, as lines are drawn"))
    heights = [each * frame.per for loop in made for chain in loop.sources for each in chain.heights]
    if heights and max(heights) - min(heights) > close:
        spread = length_in_words(max(heights) - min(heights))
        notes.append(ImportNote("flattened", 1, f"outlines that lie up to {spread} apart in z are taken as one plane"))
    _check_size(made, file)
    _check_each(made, frame, close, file)
    outer, inner = _by_shape(made, close)
    straightened = sum(chain.is_straightened for loop in made for chain in loop.sources)
    if straightened:
        words = f"{many(straightened, 'curve')} replaced by straight sides"
        notes.append(ImportNote("straightened", straightened, words))
    if arcs := sum(chain.arcs_found for loop in made for chain in loop.sources):
        notes.append(ImportNote("arcs", arcs, f"{many(arcs, 'arc')} recognised in the curves of the file"))
    bodies, count = _nested(outer, frame, close, nested, file)
    openings = [loop.ring for loop in (*inner, *cut)]
    _cut(bodies, openings, frame, close, file)
    _check_openings(bodies, frame, close, file)
    if total := len(openings) + count:
        notes.append(ImportNote("openings", total, many(total, "opening") + " cut out"))
    return in_rows(bodies), notes, rings


def _apart(
    hatched: Sequence[Loop], made: Sequence[Loop], close: float, *, same: bool = False
) -> tuple[list[Loop], list[Loop]]:
    """Return edges of hatches that lie within nothing drawn, or are the same as nothing drawn, and the others."""
    import shapely

    if not hatched or not made:
        return list(hatched), []
    drawn, edges = (polygons_of([loop.ring for loop in each], close) for each in (made, hatched))
    edge, other = shapely.STRtree(drawn).query(shapely.point_on_surface(edges), predicate="within")
    if same:
        apart = np.abs(shapely.area(drawn[other]) - shapely.area(edges[edge]))
        edge = edge[apart <= 2 * close * shapely.length(edges[edge])]
    spare = set(edge.tolist())
    return [loop for k, loop in enumerate(hatched) if k not in spare], [hatched[k] for k in sorted(spare)]


def _check_each(made: Sequence[Loop], frame: DrawingFrame, close: float, file: str) -> None:
    """Raise `DrawingError` for an outline that crosses itself or encloses nothing."""
    import shapely

    polygons = polygons_of([loop.ring for loop in made], close)
    valid = shapely.is_valid(polygons)
    slivers = shapely.area(polygons) < SLIVER * shapely.length(polygons) ** 2
    for k in np.flatnonzero(~valid | slivers).tolist():
        ring, name = made[k].ring, f"outline {k + 1} ({described(made[k].sources[0])})"
        at = complex(ring.z[0])
        if not ring.arcs and _is_flat(ring):
            raise DrawingError("thin", f"{name} encloses nothing, at {frame.place(at)}", file, at=frame.pairs([at]))
        if not valid[k]:
            reason = shapely.is_valid_reason(polygons[k])
            numbers = re.findall(r"[-+0-9.eE]+", reason.partition("[")[2])
            at = complex(float(numbers[0]), float(numbers[1])) if len(numbers) >= 2 else at
            raise DrawingError("crosses", f"{name} crosses itself at {frame.place(at)}", file, at=frame.pairs([at]))


def _check_size(made: Sequence[Loop], file: str) -> None:
    """Raise `DrawingError` "too_large" for more bodies or corners than a structure file holds."""
    if len(made) > MAX_BODIES:
        what = f"it has {len(made):,} outlines, and a structure has {MAX_BODIES:,} bodies at most: import a part of it"
        raise DrawingError("too_large", what, file)
    largest = max(made, key=lambda loop: len(loop.ring.z))
    if (corners := len(largest.ring.z)) > MAX_CORNERS:
        what = f"{described(largest.sources[0])} has {corners:,} corners: simplify it to {MAX_CORNERS:,} at most"
        raise DrawingError("too_large", what, file)


def _is_flat(ring: ArcRing) -> bool:
    """Return whether all corners are on one line."""
    along = ring.z - ring.z[0]
    far = along[np.abs(along).argmax()]
    return bool(np.abs((along * far.conjugate()).imag).max() <= FLATNESS * abs(far) ** 2) if far else True


def _by_shape(made: Sequence[Loop], close: float) -> tuple[list[Loop], list[Loop]]:
    """Return the outer rings, and the inner ones: those inside an odd number of rings of the same shape."""
    import shapely

    shapes: dict[str, list[int]] = {}
    for k, loop in enumerate(made):
        if loop.sources[0].shape:
            shapes.setdefault(loop.sources[0].shape, []).append(k)
    inner: set[int] = set()
    for members in shapes.values():
        if len(members) < 2:
            continue
        polygons = polygons_of([made[k].ring for k in members], close)
        tree = shapely.STRtree(polygons)
        points = shapely.point_on_surface(polygons)
        point, within = tree.query(points, predicate="within")
        for j, k in enumerate(members):
            around = [other for other in within[point == j] if other != j and _larger(polygons[other], polygons[j])]
            if len(around) % 2:
                inner.add(k)
    return (
        [loop for k, loop in enumerate(made) if k not in inner],
        [loop for k, loop in enumerate(made) if k in inner],
    )


def _larger(one: Any, other: Any) -> bool:
    return bool(one.area > other.area)


def pairs_within(polygons: Any) -> Iterator[tuple[int, int]]:
    """Yield pairs of polygons of which one has a point of the other within, some at a time."""
    import shapely

    tree, points = shapely.STRtree(polygons), shapely.point_on_surface(polygons)
    for first in range(0, len(points), AT_A_TIME):
        inside, around = tree.query(points[first : first + AT_A_TIME], predicate="within")
        yield from sorted(zip((first + inside).tolist(), around.tolist(), strict=True))


def _nested(
    outer: Sequence[Loop], frame: DrawingFrame, close: float, nested: str | None, file: str
) -> tuple[list[DrawnBody], int]:
    """Return the bodies; outlines inside others are refused, or are openings if the user says so."""
    import shapely

    polygons = polygons_of([loop.ring for loop in outer], close)
    holes: dict[int, int] = {}
    for i, j in pairs_within(polygons):
        if i == j or polygons[i].area >= polygons[j].area:
            continue
        if shapely.area(shapely.difference(polygons[i], polygons[j], grid_size=GRID * close)) > close * shapely.length(
            polygons[i]
        ):
            continue  # they overlap, which is said later
        if nested is None:
            one, other = (f"outline {k + 1} ({described(outer[k].sources[0])})" for k in (i, j))
            what = (
                f"{one} lies within {other}: is it an opening (`nested` openings), or is the outer one a frame? Put a "
                "frame on a layer of its own"
            )
            raise DrawingError("nested", what, file, at=frame.pairs([outer[i].ring.moments.centroid]))
        if i in holes or j in holes:
            at = outer[i].ring.moments.centroid
            what = f"outline {i + 1} lies within an outline that is itself an opening, at {frame.place(at)}"
            raise DrawingError("nested", what, file, at=frame.pairs([at]))
        holes[i] = j
    bodies = {k: DrawnBody(loop.ring, loop.sources) for k, loop in enumerate(outer) if k not in holes}
    for i, j in holes.items():
        bodies[j].openings.append(outer[i].ring)
    return list(bodies.values()), len(holes)


def _cut(
    bodies: Sequence[DrawnBody], openings: Sequence[ArcRing], frame: DrawingFrame, close: float, file: str
) -> None:
    """Give each opening to the body that it lies in. Raises `DrawingError` "opening" if there is not just one."""
    import shapely

    if not openings:
        return
    polygons = polygons_of([body.ring for body in bodies], close)
    tree = shapely.STRtree(polygons)
    for ring, hole in zip(openings, polygons_of(openings, close), strict=True):
        hits = tree.query(hole, predicate="intersects")
        shares = {int(k): shapely.area(shapely.intersection(hole, polygons[k], grid_size=GRID * close)) for k in hits}
        home = max(shares, key=shares.__getitem__, default=None)
        if home is None or hole.area - shares[home] > close * hole.length:
            at = ring.moments.centroid
            what = f"the opening at {frame.place(at)} lies in no body, or across several"
            raise DrawingError("opening", what, file, at=frame.pairs([at]))
        bodies[home].openings.append(ring)


def _check_openings(bodies: Sequence[DrawnBody], frame: DrawingFrame, close: float, file: str) -> None:
    """Raise `DrawingError` "opening" if two openings overlap, or leave nothing of a body, or several pieces."""
    import shapely

    for body in bodies:
        if not body.openings:
            continue
        (solid,), holes = polygons_of([body.ring], close), polygons_of(body.openings, close)
        one, other = shapely.STRtree(holes).query(holes, predicate="intersects")
        shared = shapely.intersection(holes[one[one < other]], holes[other[one < other]], grid_size=GRID * close)
        for common in shared[_wider(shared, close)]:
            what = f"openings overlap by {common.area:.3g} m2"
            raise _refused(what, common.centroid, "draw one outline around both", frame, file)
        left = shapely.get_parts(shapely.difference(solid, shapely.union_all(holes), grid_size=GRID * close))
        left = left[_wider(left, close)]
        if not len(left):
            raise _refused("openings leave nothing of the body", solid.centroid, "draw them smaller", frame, file)
        if len(left) > 1:
            what = f"openings cut a body into {len(left)} pieces"
            remedy = "draw each piece as a body, without the opening"
            raise _refused(what, shapely.shortest_line(left[0], left[1]).centroid, remedy, frame, file)


def check_notches(bodies: Sequence[DrawnBody], frame: DrawingFrame, close: float, file: str) -> None:
    """Raise `DrawingError` "opening" if an opening reaches the outline of its body, as a polygon cannot show it."""
    import shapely

    for body in bodies:
        if body.openings:
            (solid,), holes = polygons_of([body.ring], close), polygons_of(body.openings, close)
            for met in shapely.intersection(shapely.boundary(solid), shapely.buffer(holes, close)):
                if met.length > TOUCHES * close:
                    what = f"an opening reaches the outline of {body.name}"
                    remedy = "draw the outline with this notch, without the opening"
                    raise _refused(what, shapely.point_on_surface(met), remedy, frame, file)


def _wider(shapes: Any, close: float) -> Any:
    """Return which shapes are wider than the closing distance."""
    import shapely

    return shapely.area(shapes) > close * shapely.length(shapes) / 2


def _refused(what: str, point: Any, remedy: str, frame: DrawingFrame, file: str) -> DrawingError:
    """Return the refusal of an opening at a point of shapely."""
    at = complex(point.x, point.y)
    return DrawingError("opening", f"{what} at {frame.place(at)}: {remedy}", file, at=frame.pairs([at]))


def in_rows(bodies: Sequence[DrawnBody]) -> list[DrawnBody]:
    """Return bodies by rows from below, each from the left."""
    left = sorted(bodies, key=lambda body: body.ring.moments.centroid.imag)
    height = [body.ring.moments.centroid.imag for body in left]
    ordered: list[DrawnBody] = []
    while len(ordered) < len(left):
        begin = len(ordered)
        lowest = left[begin : bisect_right(height, height[begin] + SAME_HEIGHT)]
        first = min(lowest, key=lambda body: body.ring.moments.centroid.real)
        top = first.ring.moments.centroid.imag + ROW * float(np.ptp(first.ring.z.imag))
        row = left[begin : bisect_right(height, top)]
        ordered += sorted(row, key=lambda body: body.ring.moments.centroid.real)
    return ordered


def name_and_weigh(
    bodies: Sequence[DrawnBody],
    of: Sorted,
    densities: Mapping[str, float],
    frame: DrawingFrame,
    close: float,
    file: str,
) -> list[ImportNote]:
    """Give each body its name and density: by the texts inside it, its layer, or its number.

    Parameters
    ----------
    bodies : sequence of DrawnBody
        The bodies, which are changed.
    of : Sorted
        The drawing.
    densities : mapping of str to float
        Density of each layer [kg/m3]; "" is that of all others.
    frame : DrawingFrame
        Unit of the drawing.
    close : float
        Closing distance [m].
    file : str
        Name of the file in messages.
    """
    import shapely

    layers = {body.layer for body in bodies}
    if unknown := [layer for layer in densities if layer and layer not in layers]:
        where = in_short(sorted(layers))
        what = f"`density` names the layer {seen(unknown[0])!r}, which has no bodies: they are on {where}"
        raise DrawingError("density", what, file)
    for body in bodies:
        body.density = densities.get(body.layer, densities.get(""))
    texts = [
        label for label in of.labels if of.roles(label.layer) not in (Role.LOADS, Role.TIES) and label.text.strip()
    ]
    names: dict[int, list[str]] = {}
    used: set[int] = set()
    if texts:
        at = frame.to_metres(np.array([label.at for label in texts]))
        tree = shapely.STRtree(polygons_of([body.ring for body in bodies], close))
        for k, home in tree.query(shapely.points(at.real, at.imag), predicate="within").T.tolist():
            used.add(k)
            for text in filter(None, map(seen, texts[k].text.splitlines())):
                try:
                    density = density_in(text)
                except UnitError as error:
                    at_text = complex(texts[k].at)
                    raise DrawingError("density", f"{error}", file, [[at_text.real, at_text.imag]]) from None
                if density is not None:
                    bodies[home].density = density
                elif any(each.isalpha() for each in text):
                    names.setdefault(home, []).append(text)
    outside = Counter((label.kind, label.layer) for k, label in enumerate(texts) if k not in used)
    notes = [
        ImportNote("left out", count, f"left out: {count:,} {kind} on {seen(layer) or 'no layer'}")
        for (kind, layer), count in outside.items()
    ]
    taken = {"ground", "floor", *(f"ground {k + 1}" for k in range(len(of.chains[Role.GROUND])))}
    count = Counter[str]()
    for k, body in enumerate(bodies):
        wished = cleaned(names[k][0]) if k in names else ""
        body.name = wished = wished or f"b{k + 1}"
        while body.name.casefold() in taken:
            count[wished] += 1
            body.name = f"{wished}-{count[wished] + 1}"
        taken.add(body.name.casefold())
    if spare := sum(len(each) - 1 for each in names.values()):
        notes.append(
            ImportNote("texts", spare, f"{many(spare, 'more text')} inside bodies than names: the first counts")
        )
    return notes


def density_in(text: str) -> float | None:
    """Return the density [kg/m3] that a text such as `gamma = 22,5 kN/m3` gives; None if it is about none.

    Raises
    ------
    UnitError
        If it has a unit of density, and its number or its unit cannot be read.
    """
    plain = re.sub(r"/\s*mc\b", "/m3", text.replace("\u00b3", "3").replace("^3", "3"))
    if not PER_VOLUME.search(plain):
        return None
    match = DENSITY.search(plain)
    if match is None:
        raise UnitError(f"{cut(repr(text))} is not a density: write it as 2200 kg/m3")
    number, unit = match[1], re.sub(r"\s", "", match[2])
    if THOUSANDS.fullmatch(number) and unit == "kg/m3":  # as no masonry of 2.2 kg/m3 exists
        number = re.sub("[.,' ]", "", number)
    given = f"{number.replace(',', '.')} {unit}"
    weight = mass_of_weight(given, "kg/m3")
    return weight if weight is not None else read(given, "kg/m3")


def cleaned(text: str) -> str:
    """Return a text as a name: no colon and no `and`, which mean something in files."""
    words = [word for word in re.split(r"[\s:]+", text) if word and word.casefold() != "and"]
    return " ".join(words)[:60].strip()

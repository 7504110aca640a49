"""The bodies, openings and ground of a drawing: which lines mean what, and what encloses what."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from shlex import quote
from typing import Any

import numpy as np

from rocking_cli.errors import named
from rocking_cli.io.drawings.contract import DrawingError, DrawnLine, DrawnPoint, DrawnText, LineDrawing
from rocking_cli.questions.import_drawing.legend import (
    DrawingFrame,
    ImportNote,
    Role,
    Roles,
    counted,
    length_in_words,
    many,
    proposed,
)
from rocking_cli.questions.import_drawing.loops import Loop, Placed, curves_of, edges_of, loops
from rocking_cli.questions.import_drawing.rings import ArcRing, PlaneMoments, polygons_of
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
            raise DrawingError("layers", f"{what}: give {named('layers')} {take}, or {leave}", file)
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
        if named_bodies.keys() & {*frames}:  # what is drawn in a wall
            guess[Role.OPENINGS] = guess.pop(Role.BODIES, [])
        by_role = {role: ",".join(seen(layer) for layer in of if layer in counts) for role, of in guess.items()}
        give = " ".join(f"{named('layers')} {quote(f'{role}={of}')}" for role, of in by_role.items() if of)
        some = f"{seen(next(iter(counts)))} has" if len(counts) == 1 else f"{len(counts)} of them have"
        counts |= {layer: outline_count(lines) for layer, lines in named_bodies.items()}
        what = f"which layers are bodies? {counted(counts)}; {some} no known role: by what is drawn there, {give}"
        if around := [seen(layer) for layer in frames if layer in counts and layer in unknown]:
            what += f" ({around[0]} is taken for a frame, as it is around all else"
            if inside := by_role.get(Role.BODIES):
                take, leave = quote(f"{Role.BODIES}={around[0]}"), quote(f"{Role.OPENINGS}={inside}")
                what += f": if it has openings, {named('layers')} {take} {named('layers')} {leave}"
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
            what += (
                f", on {in_short(dropped)}, whose name says that nothing on it counts: give {named('layers')} {give}"
            )
        elif where:
            what += f"; lines that do not close are on {where}: give {named('layers')} bodies=LAYER if they are bodies"
        raise DrawingError("empty", f"there is no outline in it, only {what}", file)
    left = Counter((chain.kind, layer) for layer, of in unknown.items() for chain in of)
    left |= Counter((chain.kind, chain.layer) for chain in chains[Role.NOTHING])
    notes += [_left_out(kind, layer, count) for (kind, layer), count in left.items()]
    notes += [_left_out(each.kind, each.layer, each.count, f", {each.why}") for each in drawing.left_out]
    return Sorted(chains, drawing.labels, roles, notes)


def _left_out(kind: str, layer: str, count: int, why: str = "") -> ImportNote:
    return ImportNote("left out", count, f"left out: {count:,} {kind} on {seen(layer) or 'no layer'}{why}")


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
    edges = edges_of(lines)
    ends = np.array([[chain.points[0], chain.points[-1]] for chain in open_])
    point, edge = shapely.STRtree(curves_of(edges, reach)).query(
        shapely.points(ends.real.ravel(), ends.imag.ravel()), predicate="dwithin", distance=reach
    )
    of = np.array([id(line.source) for line in lines])[edges["of"][edge]]
    others = of != np.array([id(chain) for chain in open_])[point // 2]
    met = len(np.unique(point[others]))
    return met >= LEAST_ENDS and met >= MEETING_SHARE * ends.size


def placed(chains: Sequence[DrawnLine], frame: DrawingFrame) -> list[Placed]:
    """Return chains in metres. Raises `DrawingError` "not_plane" for one that is not level in z."""
    chains = [chain for chain in chains if len(chain.points) > 1]
    if not chains:
        return []
    z = frame.to_metres(np.concatenate([chain.points for chain in chains]))
    lines, end = [], 0
    for chain in chains:
        begin, end = end, end + len(chain.points)
        if (depth := (chain.heights[1] - chain.heights[0]) * frame.per) > frame.close:
            what = f"{described(chain)} is not plane: its corners differ by {length_in_words(depth)} in z"
            raise frame.refusal("not_plane", f"{what}. Draw the section in one plane", z[begin : begin + 1].tolist())
        lines.append(Placed(z[begin:end], chain.bulges, chain.closed, chain))
    return lines


def described(chain: DrawnLine) -> str:
    """Return what a line is in the file: "LWPOLYLINE 2F on MURO"."""
    return f"{chain.kind}{f' {seen(chain.handle)}' if chain.handle else ''} on {seen(chain.layer) or 'no layer'}"


def bodies_of(
    of: Sorted, frame: DrawingFrame, nested: str | None
) -> tuple[list[DrawnBody], list[ImportNote], list[complex]]:
    """Return the bodies of a drawing with their openings, in reading order, and what was mended and where [m].

    Raises
    ------
    DrawingError
        "unclosed", "thin", "crosses", "nested", "opening" or "not_plane".
    """
    close = frame.close
    drawn = [chain for chain in of.chains[Role.BODIES] if not chain.is_fill]
    fills = [chain for chain in of.chains[Role.BODIES] if chain.is_fill]
    made, mended = loops(placed(drawn, frame), frame)
    notes = mended.notes(frame)
    places = [z for kind, at in mended.at.items() if kind != "crumbs" for z in at]
    cut, others = loops(placed(of.chains[Role.OPENINGS], frame), frame)
    _check_each(cut, frame)
    notes += others.notes(frame)
    if fills:
        hatched, holes = _by_shape(loops(placed(fills, frame), frame)[0], close)
        hatched, spare = _apart(hatched, made, close)
        islands, drawn_too = _apart(holes, [*made, *cut], close, same=True)
        made, cut = made + hatched, cut + islands
        if left := len(spare) + len(drawn_too):
            notes.append(ImportNote("left out", left, f"{many(left, 'edge')} of hatches left out, as lines are drawn"))
    heights = [each * frame.per for loop in made for chain in loop.sources for each in chain.heights]
    if (spread := max(heights, default=0.0) - min(heights, default=0.0)) > close:
        words = f"outlines that lie up to {length_in_words(spread)} apart in z are taken as one plane"
        notes.append(ImportNote("flattened", 1, words))
    _check_size(made, frame)
    _check_each(made, frame)
    outer, inner = _by_shape(made, close)
    if straightened := sum(chain.is_straightened for loop in made for chain in loop.sources):
        words = f"{many(straightened, 'curve')} replaced by straight sides"
        notes.append(ImportNote("straightened", straightened, words))
    if arcs := sum(chain.arcs_found for loop in made for chain in loop.sources):
        notes.append(ImportNote("arcs", arcs, f"{many(arcs, 'arc')} recognised in the curves of the file"))
    bodies, count = _nested(outer, frame, nested)
    openings = [loop.ring for loop in (*inner, *cut)]
    _cut(bodies, openings, frame)
    _check_openings(bodies, frame)
    if total := len(openings) + count:
        notes.append(ImportNote("openings", total, many(total, "opening") + " cut out"))
    return in_rows(bodies), notes, places


def _apart(
    hatched: Sequence[Loop], made: Sequence[Loop], close: float, *, same: bool = False
) -> tuple[list[Loop], list[Loop]]:
    """Return edges of hatches that lie within nothing drawn, or are the same as nothing drawn, and the others."""
    import shapely

    drawn, edges = (polygons_of([loop.ring for loop in each], close) for each in (made, hatched))
    edge, other = shapely.STRtree(drawn).query(shapely.point_on_surface(edges), predicate="within")
    if same:
        apart = np.abs(shapely.area(drawn[other]) - shapely.area(edges[edge]))
        edge = edge[apart <= 2 * close * shapely.length(edges[edge])]
    return _parted(hatched, {*edge.tolist()})


def _parted(made: Sequence[Loop], chosen: Collection[int]) -> tuple[list[Loop], list[Loop]]:
    """Return the loops that are not chosen, and those that are, by their numbers."""
    return [each for k, each in enumerate(made) if k not in chosen], [made[k] for k in sorted(chosen)]


def _check_each(made: Sequence[Loop], frame: DrawingFrame) -> None:
    """Raise `DrawingError` for an outline that crosses itself or encloses nothing."""
    import shapely

    polygons = polygons_of([loop.ring for loop in made], frame.close)
    valid = shapely.is_valid(polygons)
    slivers = shapely.area(polygons) < SLIVER * shapely.length(polygons) ** 2
    for k in np.flatnonzero(~valid | slivers).tolist():
        ring, name = made[k].ring, f"outline {k + 1} ({described(made[k].sources[0])})"
        at = complex(ring.z[0])
        if not ring.arcs and _is_flat(ring):
            raise frame.refusal("thin", f"{name} encloses nothing, at <here>", [at])
        if not valid[k]:
            reason = shapely.is_valid_reason(polygons[k])
            numbers = re.findall(r"[-+0-9.eE]+", reason.partition("[")[2])
            at = complex(float(numbers[0]), float(numbers[1])) if len(numbers) >= 2 else at
            raise frame.refusal("crosses", f"{name} crosses itself at <here>", [at])


def _check_size(made: Sequence[Loop], frame: DrawingFrame) -> None:
    """Raise `DrawingError` "too_large" for more bodies or corners than a structure file holds."""
    if len(made) > MAX_BODIES:
        what = f"it has {len(made):,} outlines, and a structure has {MAX_BODIES:,} bodies at most: import a part of it"
        raise frame.refusal("too_large", what)
    largest = max(made, key=lambda loop: len(loop.ring.z))
    if (corners := len(largest.ring.z)) > MAX_CORNERS:
        what = f"{described(largest.sources[0])} has {corners:,} corners: simplify it to {MAX_CORNERS:,} at most"
        raise frame.refusal("too_large", what)


def _is_flat(ring: ArcRing) -> bool:
    """Return whether all corners are on one line."""
    along = ring.z - ring.z[0]
    far = along[np.abs(along).argmax()]
    return bool(np.abs((along * far.conjugate()).imag).max() <= FLATNESS * abs(far) ** 2) if far else True


def _by_shape(made: Sequence[Loop], close: float) -> tuple[list[Loop], list[Loop]]:
    """Return the outer rings, and the inner ones: those inside an odd number of rings of the same shape."""
    shapes: dict[str, list[int]] = {}
    for k, loop in enumerate(made):
        shapes.setdefault(loop.sources[0].shape, []).append(k)
    around = Counter[int]()
    for shape, members in shapes.items():
        if shape and len(members) > 1:
            polygons = polygons_of([made[k].ring for k in members], close)
            around.update(members[i] for i, j in pairs_within(polygons) if polygons[i].area < polygons[j].area)
    return _parted(made, {k for k, count in around.items() if count % 2})


def pairs_within(polygons: Any) -> Iterator[tuple[int, int]]:
    """Yield pairs of polygons of which one has a point of the other within, some at a time."""
    import shapely

    tree, points = shapely.STRtree(polygons), shapely.point_on_surface(polygons)
    for first in range(0, len(points), AT_A_TIME):
        inside, around = tree.query(points[first : first + AT_A_TIME], predicate="within")
        yield from sorted(zip((first + inside).tolist(), around.tolist(), strict=True))


def _nested(outer: Sequence[Loop], frame: DrawingFrame, nested: str | None) -> tuple[list[DrawnBody], int]:
    """Return the bodies; outlines inside others are refused, or are openings if the user says so."""
    import shapely

    polygons = polygons_of([loop.ring for loop in outer], frame.close)
    holes: dict[int, int] = {}
    for i, j in pairs_within(polygons):
        if polygons[i].area >= polygons[j].area:
            continue
        apart = shapely.difference(polygons[i], polygons[j], grid_size=GRID * frame.close)
        if apart.area > frame.close * polygons[i].length:
            continue  # they overlap, which is said later
        at = outer[i].ring.moments.centroid
        if nested is None:
            one, other = (f"outline {k + 1} ({described(outer[k].sources[0])})" for k in (i, j))
            what = (
                f"{one} lies within {other}: is it an opening ({named('nested')} openings), or is the outer "
                "one a frame? Put "
            )
            raise frame.refusal("nested", f"{what}a frame on a layer of its own", [at])
        if i in holes or j in holes:
            what = f"outline {i + 1} lies within an outline that is itself an opening, at <here>"
            raise frame.refusal("nested", what, [at])
        holes[i] = j
    bodies = {k: DrawnBody(loop.ring, loop.sources) for k, loop in enumerate(outer) if k not in holes}
    for i, j in holes.items():
        bodies[j].openings.append(outer[i].ring)
    return list(bodies.values()), len(holes)


def _cut(bodies: Sequence[DrawnBody], openings: Sequence[ArcRing], frame: DrawingFrame) -> None:
    """Give each opening to the body that it lies in. Raises `DrawingError` "opening" if there is not just one."""
    import shapely

    polygons = polygons_of([body.ring for body in bodies], frame.close)
    tree = shapely.STRtree(polygons)
    for ring, hole in zip(openings, polygons_of(openings, frame.close), strict=True):
        hits = tree.query(hole, predicate="intersects")
        shares = shapely.area(shapely.intersection(hole, polygons[hits], grid_size=GRID * frame.close))
        if hole.area - shares.max(initial=-np.inf) > frame.close * hole.length:
            what = "the opening at <here> lies in no body, or across several"
            raise frame.refusal("opening", what, [ring.moments.centroid])
        bodies[hits[shares.argmax()]].openings.append(ring)


def _check_openings(bodies: Sequence[DrawnBody], frame: DrawingFrame) -> None:
    """Raise `DrawingError` "opening" if two openings overlap, or leave nothing of a body, or several pieces."""
    import shapely

    grid = GRID * frame.close
    for body in filter(lambda body: body.openings, bodies):
        (solid,), holes = polygons_of([body.ring], frame.close), polygons_of(body.openings, frame.close)
        one, other = shapely.STRtree(holes).query(holes, predicate="intersects")
        shared = shapely.intersection(holes[one[one < other]], holes[other[one < other]], grid_size=grid)
        for common in shared[_wider(shared, frame.close)]:
            what = f"openings overlap by {common.area:.3g} m2 at <here>: draw one outline around both"
            raise frame.refusal("opening", what, [at_point(common.centroid)])
        left = shapely.get_parts(shapely.difference(solid, shapely.union_all(holes), grid_size=grid))
        left = left[_wider(left, frame.close)]
        if not len(left):
            what = "openings leave nothing of the body at <here>: draw them smaller"
            raise frame.refusal("opening", what, [at_point(solid.centroid)])
        if len(left) > 1:
            what = f"openings cut a body into {len(left)} pieces at <here>"
            what += ": draw each piece as a body, without the opening"
            raise frame.refusal("opening", what, [at_point(shapely.shortest_line(left[0], left[1]).centroid)])


def check_notches(bodies: Sequence[DrawnBody], frame: DrawingFrame) -> None:
    """Raise `DrawingError` "opening" if an opening reaches the outline of its body, as a polygon cannot show it."""
    import shapely

    close = frame.close
    for body in filter(lambda body: body.openings, bodies):
        (solid,), holes = polygons_of([body.ring], close), polygons_of(body.openings, close)
        for met in shapely.intersection(shapely.boundary(solid), shapely.buffer(holes, close)):
            if met.length > TOUCHES * close:
                what = f"an opening reaches the outline of {body.name} at <here>"
                what += ": draw the outline with this notch, without the opening"
                raise frame.refusal("opening", what, [at_point(shapely.point_on_surface(met))])


def _wider(shapes: Any, close: float) -> Any:
    """Return which shapes are wider than the closing distance."""
    import shapely

    return shapely.area(shapes) > close * shapely.length(shapes) / 2


def at_point(point: Any) -> complex:
    """Return the place of a point of shapely."""
    return complex(point.x, point.y)


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
    bodies: Sequence[DrawnBody], of: Sorted, densities: Mapping[str, float], frame: DrawingFrame
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
        The drawing.
    """
    import shapely

    layers = {body.layer for body in bodies}
    if unknown := [layer for layer in densities if layer and layer not in layers]:
        where = in_short(sorted(layers))
        what = f"{named('density')} names the layer {seen(unknown[0])!r}, which has no bodies: they are on {where}"
        raise frame.refusal("density", what)
    for body in bodies:
        body.density = densities.get(body.layer, densities.get(""))
    others = (Role.LOADS, Role.TIES)
    texts = [label for label in of.labels if of.roles(label.layer) not in others and label.text.strip()]
    names: dict[int, list[str]] = {}
    at = frame.to_metres(np.array([label.at for label in texts]))
    tree = shapely.STRtree(polygons_of([body.ring for body in bodies], frame.close))
    inside = tree.query(shapely.points(at.real, at.imag), predicate="within").T.tolist()
    for k, home in inside:
        for text in filter(None, map(seen, texts[k].text.splitlines())):
            try:
                density = density_in(text)
            except UnitError as error:
                raise frame.refusal("density", str(error), [complex(at[k])]) from None
            if density is not None:
                bodies[home].density = density
            elif any(each.isalpha() for each in text):
                names.setdefault(home, []).append(text)
    used = {k for k, _ in inside}
    outside = Counter((label.kind, label.layer) for k, label in enumerate(texts) if k not in used)
    notes = [_left_out(kind, layer, count) for (kind, layer), count in outside.items()]
    outside_texts = [line for k, label in enumerate(texts) if k not in used for line in label.text.splitlines()]
    if stray := [repr(cut(each)) for each in outside_texts if _weighs(each)]:
        words = f"a density in no body gives none its own: put {in_short(stray)} inside it"
        notes.append(ImportNote("density", len(stray), f"{words}, or give {named('density')}"))
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
        words = f"{many(spare, 'more text')} inside bodies than names: the first counts"
        notes.append(ImportNote("texts", spare, words))
    return notes


def _weighs(text: str) -> str:
    """Return a text with its unit of density written plainly; an empty one if it has none."""
    plain = re.sub(r"/\s*mc\b", "/m3", text.replace("\u00b3", "3").replace("^3", "3"))
    return plain if PER_VOLUME.search(plain) else ""


def density_in(text: str) -> float | None:
    """Return the density [kg/m3] that a text such as `gamma = 22,5 kN/m3` gives; None if it is about none.

    Raises
    ------
    UnitError
        If it has a unit of density, and its number or its unit cannot be read.
    """
    plain = _weighs(text)
    if not plain:
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

"""A structure from a drawing: the fields of its file, and what was mended, assumed and left out."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import ceil
from string import ascii_uppercase as LETTERS
from typing import Any

import numpy as np

from rocking_cli.arrays import Points
from rocking_cli.core import Mechanism
from rocking_cli.core.registry import Registry
from rocking_cli.errors import MechanismError, StructureError, named
from rocking_cli.io.drawings.contract import DrawingError, DrawnLine, LineDrawing
from rocking_cli.questions.import_drawing import mortar
from rocking_cli.questions.import_drawing.attached import DECIMALS, BodyFinder, DrawnAttachments, attached, rounded
from rocking_cli.questions.import_drawing.legend import (
    DrawingFrame,
    ImportNote,
    Role,
    Roles,
    length_in_words,
    many,
    metres_per_unit,
)
from rocking_cli.questions.import_drawing.loops import joined_lines
from rocking_cli.questions.import_drawing.options import ImportOptions
from rocking_cli.questions.import_drawing.outlines import (
    AT_A_TIME,
    GRID,
    DrawnBody,
    at_point,
    bodies_of,
    by_role,
    check_notches,
    name_and_weigh,
    placed,
)
from rocking_cli.questions.import_drawing.rings import ArcRing, following, polygons_of
from rocking_cli.text import in_short

GROUND_ROOM = 0.1  # depth of the ground below its lowest point, and its room at the sides, over the size drawn
KINDS = ("rigid_body", "assembly", "linkage")
SAME_NORMAL = 1e-6
MASS_DIGITS, CENTROID_DECIMALS = 12, 10
EXTENT = 1e-5  # to which width and height are known [m]
CIRCLE_SHARE = 0.05  # of the closing distance, to which depths of overlaps are known
MAX_MORTAR = 0.05  # width of gaps that may be joints [m]
MAX_ANALYSED = 60  # bodies up to which it is checked too that they stand, by limit analysis
MAX_SLOPE = 0.01  # of a base that is put level
CURVED_CORNERS = 5  # of a curve that is within the closing distance of the ground, at least
FLAT_SHARE = 0.5  # least width of the base over that of what is within the closing distance of the ground
MAX_CHECKED = 300  # bodies up to which the mechanism checks its fields; of more, this study alone


@dataclass(frozen=True)
class DrawnJoint:
    """A joint between two bodies, or a body and the ground: their names, and both ends of the face [m]."""

    between: tuple[str, str]
    ends: tuple[complex, complex]


@dataclass(frozen=True, eq=False)
class Imported:
    """A structure made from a drawing.

    Parameters
    ----------
    kind : str
        Its mechanism.
    fields : mapping
        Fields of the structure file.
    bodies : sequence of DrawnBody
        The bodies in metres, from the origin of the file.
    ground : sequence of ndarray of complex
        Outlines of the ground [m].
    joints : sequence of DrawnJoint
        Where the bodies touch.
    units : str
        Where the size comes from, in words.
    per_unit : float
        Metres to a unit of the drawing.
    shift : complex
        Origin of the file in the drawing [units].
    notes : sequence of ImportNote
        What was mended, assumed and left out.
    comments : sequence of str
        Comments for the end of the file.
    mended : sequence of complex
        Where something was mended [m].
    grey : sequence of ndarray of complex
        Lines that were left out [m].
    supports : sequence of complex
        Points that supports hold [m].
    text : str
        The structure file.
    """

    kind: str
    fields: Mapping[str, Any]
    bodies: Sequence[DrawnBody]
    ground: Sequence[Points]
    joints: Sequence[DrawnJoint]
    units: str
    per_unit: float
    shift: complex
    notes: Sequence[ImportNote]
    comments: Sequence[str]
    mended: Sequence[complex]
    grey: Sequence[Points]
    supports: Sequence[complex]
    text: str = ""

    @cached_property
    def structure(self) -> Mechanism:
        """The structure. Raises `InputError` if its mechanism refuses it."""
        return Registry()[self.kind](**self.fields)


def structure_from(drawing: LineDrawing, options: ImportOptions, name: str, file: str) -> Imported:
    """Make a structure of a drawing.

    Parameters
    ----------
    drawing : LineDrawing
        What a reader made of the file.
    options : ImportOptions
        How it is read.
    name : str
        Name of the structure.
    file : str
        Name of the file in messages.

    Raises
    ------
    DrawingError
        If it cannot be made, with the class of the reason and the places.
    InputError
        If an option is not valid.
    """
    of = by_role(drawing, Roles.of(drawing, options.layers), file)
    drawn = np.concatenate([chain.points for chain in of.chains[Role.BODIES]])
    size = max(float(np.ptp(drawn.real)), float(np.ptp(drawn.imag)))
    if not np.isfinite(size):
        raise DrawingError("empty", "it has coordinates that are not finite", file)
    per, units = metres_per_unit(drawing, size, options.units, options.scale, file)
    middle = complex((drawn.real.min() + drawn.real.max()) / 2, (drawn.imag.min() + drawn.imag.max()) / 2)
    if options.depth is None and drawing.depth is not None:
        options = options.model_copy(update={"depth": round(per * drawing.depth, DECIMALS)})
    frame, close = DrawingFrame(per, middle, options.close, file), options.close
    bodies, notes, mended = bodies_of(of, frame, options.nested)
    notes = [*of.notes, *notes, *name_and_weigh(bodies, of, options.density, frame)]
    if drawing.faults:
        words = f"{many(len(drawing.faults), 'fault')} of the file mended as it was read: "
        notes.insert(0, ImportNote("faults", len(drawing.faults), words + in_short(drawing.faults, "; ")))
    ground, is_drawn = _ground(of.chains[Role.GROUND], bodies, frame)
    left, low = (float(part.min()) for part in _extent(bodies))
    closed = mortar.close_gaps([body.ring for body in bodies], ground, options.merge_gap, close)
    notes += _closing_notes(closed, frame)
    for body, ring in zip(bodies, closed.rings, strict=True):
        body.ring = ring
    if closed.gaps:
        _check_closed(bodies, frame)
    check_overlaps(bodies, ground if is_drawn else [], frame)
    shift = -complex(left, low)
    frame = frame._replace(origin=frame.to_drawing(-shift))
    mended = [z + shift for z in (*mended, *closed.at)]
    for body in bodies:
        body.ring = body.ring.moved(shift)
        body.openings = [each.moved(shift) for each in body.openings]
    ground = [each.moved(shift) for each in ground]
    if not is_drawn:
        notes.append(ImportNote("ground", 1, "no ground is drawn: a level floor at the lowest point is assumed"))
    x, y = (round(each * per, DECIMALS) / per + 0.0 for each in (frame.origin.real, frame.origin.imag))
    upwards = ", with y upwards from the upper edge of its page" if drawing.format == "SVG" else ""
    words = f"the origin of the structure file is at ({x:.9g}, {y:.9g}) of the drawing{upwards}"
    notes.append(ImportNote("origin", 1, words))
    width, height = (float(np.ptp(part)) for part in _extent(bodies))
    notes.append(ImportNote("units", 1, f"{units}: the structure is {width:.4g} m wide and {height:.4g} m high"))
    extra = attached(drawing, of, BodyFinder(bodies, ground, frame))
    kind = options.kind or _kind(bodies, ground, is_drawn, extra, close)
    if kind == "rigid_body":
        lowest = min(bodies, key=lambda body: float(body.ring.z.imag.min()))
        if is_drawn and not _is_level(lowest.ring, ground, close):
            what = f"the ground below {lowest.name} is not level or does not meet it, as a rigid_body needs"
            raise frame.refusal("below", f"{what}: leave out {named('kind')}, or the ground")
        _check_foot(lowest, frame)
        notes += _levelled(bodies, frame)
    _check_weights(kind, bodies, options, frame, notes)
    if kind != "rigid_body":  # which cuts notches out of its parts
        check_notches(bodies, frame)
    if kind == "assembly" and extra.hinges:
        at = [frame.to_drawing(each[0]) for each in extra.hinges]
        words = f"left out: {many(len(at), 'hinge')}, as an assembly hinges at the joints that open first"
        extra.notes.append(ImportNote("left out", len(at), words, at))
    draft = _Draft(name, bodies, ground, is_drawn, extra, options, frame)
    nothing = [chain for chain in drawing.chains if of.roles(chain.layer) in (None, Role.NOTHING)]
    lines = [chain.points[[*range(len(chain.points)), *([0] * chain.closed)]] for chain in nothing]
    grey = [frame.to_metres(points) for points in (*lines, *drawing.annotations) if len(points) > 1]
    result = Imported(
        kind, draft.fields(kind), bodies, [ring.chords(options.tolerance) for ring in ground],
        _joints(bodies, ground), units, per, frame.origin, [*notes, *extra.notes], extra.comments, mended, grey,
        [at for _, at, _, _ in extra.supports],
    )  # fmt: skip
    try:
        checked = _checked_by_mechanism(result, frame)
    except DrawingError:
        if kind != "assembly" or not options.merge_gap:
            raise
        result = replace(result, fields={**result.fields, "gap": options.merge_gap})
        words = f"joints fitted within {length_in_words(options.merge_gap)}, which the file gives as `gap`"
        checked = [*_checked_by_mechanism(result, frame), ImportNote("gap", 1, words)]
    return replace(result, notes=[*result.notes, *checked])


def _extent(bodies: Sequence[DrawnBody]) -> tuple[Any, Any]:
    z = np.concatenate([body.ring.chords(EXTENT) for body in bodies])
    return z.real, z.imag


def _ground(
    chains: Sequence[DrawnLine], bodies: Sequence[DrawnBody], frame: DrawingFrame
) -> tuple[list[ArcRing], bool]:
    """Return the outlines of the ground, and whether it is drawn; if not, it is a level floor at the lowest point."""
    x, y = _extent(bodies)
    width, height = float(np.ptp(x)), float(np.ptp(y))
    if not chains:
        room, depth = GROUND_ROOM * max(width, height), GROUND_ROOM * height
        low, left, right = float(y.min()), float(x.min()) - room, float(x.max()) + room
        corners = [complex(left, low - depth), complex(right, low - depth), complex(right, low), complex(left, low)]
        return [ArcRing(np.array(corners), np.zeros(4))], False
    lines = placed(chains, frame)
    rings = [ArcRing.of(line.z, line.bulges) for line in lines if line.closed]
    for z in joined_lines([line for line in lines if not line.closed], frame.close):
        rings.append(_below(z, float(y.min()), GROUND_ROOM * height))
    return rings, True


def _below(z: Points, lowest: float, depth: float) -> ArcRing:
    """Return the ground below an open line, to a depth below it and below the lowest body."""
    low = min(float(z.imag.min()), lowest) - depth
    corners = np.concatenate([z, [complex(z[-1].real, low), complex(z[0].real, low)]])
    return ArcRing.of(corners, np.zeros(len(corners)))


def _closing_notes(closed: mortar.Closed, frame: DrawingFrame) -> list[ImportNote]:
    if not closed.gaps:
        return []
    at = [*map(frame.to_drawing, closed.at)]
    least, most = (length_in_words(edge) for edge in (min(closed.gaps), max(closed.gaps)))
    span = least if least == most else f"{least} to {most}"
    notes = [ImportNote("closed", len(at), f"{many(len(at), 'side')} moved to close gaps or overlaps of {span}", at)]
    if closed.uneven:
        words = f"{many(len(closed.uneven), 'side')} faced two different gaps: the larger was closed"
        notes.append(ImportNote("two gaps", len(closed.uneven), words, [*map(frame.to_drawing, closed.uneven)]))
    return notes


def _check_closed(bodies: Sequence[DrawnBody], frame: DrawingFrame) -> None:
    """Raise `DrawingError` "crosses" if closing gaps has made a body cross itself."""
    import shapely

    for k in np.flatnonzero(~shapely.is_valid(polygons_of([body.ring for body in bodies], frame.close))).tolist():
        fault = f"{bodies[k].name} at <here> crosses itself once its gaps are closed"
        at = [bodies[k].ring.moments.centroid]
        raise frame.refusal("crosses", f"{fault}: give a smaller {named('merge_gap')}", at)


def check_overlaps(bodies: Sequence[DrawnBody], ground: Sequence[ArcRing], frame: DrawingFrame) -> None:
    """Raise `DrawingError` "overlap" or "below" for bodies that overlap, or reach into the ground, too deeply."""
    import shapely

    close = frame.close
    solid = polygons_of([body.ring for body in bodies], close)
    tree = shapely.STRtree(solid)
    for first in range(0, len(solid), AT_A_TIME):
        ones, others = tree.query(solid[first : first + AT_A_TIME], predicate="intersects")
        ones, others = ones[first + ones < others] + first, others[first + ones < others]
        shared = shapely.intersection(solid[ones], solid[others], grid_size=GRID * close)
        for k in np.flatnonzero(shapely.area(shared) > 0).tolist():
            if depth := depth_of(shared[k], close):
                one, other = bodies[ones[k]].name, bodies[others[k]].name
                what = f"{one} and {other} overlap by {shared[k].area:.3g} m2 at <here>, {length_in_words(depth)} deep"
                what += f": draw them side by side, or give a larger {named('close')} than {length_in_words(close)}"
                raise frame.refusal("overlap", what, [at_point(shared[k].centroid)])
    for floor in polygons_of(ground, close):
        for k in tree.query(floor, predicate="intersects").tolist():
            common = shapely.intersection(floor, solid[k], grid_size=GRID * close)
            if depth := depth_of(common, close):
                what = f"{bodies[k].name} reaches {length_in_words(depth)} into the ground: the ground line must be "
                raise frame.refusal("below", f"{what}below it", [at_point(common.centroid)])


def depth_of(common: Any, close: float) -> float:
    """Return how deep outlines overlap by what they share [m]: the largest circle in it; 0 if that is below `close`."""
    import shapely

    if 2 * np.sqrt(common.area / np.pi) <= close:
        return 0.0
    parts = (part for part in shapely.get_parts(common) if part.area)
    circles = [shapely.maximum_inscribed_circle(part, CIRCLE_SHARE * close) for part in parts]
    depth = 2 * max(shapely.length(circles))
    return float(depth) if depth > close * (1 + CIRCLE_SHARE) else 0.0


def _joints(bodies: Sequence[DrawnBody], ground: Sequence[ArcRing]) -> list[DrawnJoint]:
    """Return where bodies touch one another or the ground, within the gap that `assembly` allows."""
    rings = [*(body.ring for body in bodies), *ground]
    names = [*(body.name for body in bodies), *("ground" for _ in ground)]
    size = np.array([np.ptp(ring.z.real) + np.ptp(ring.z.imag) for ring in rings])
    size[len(bodies) :] = np.inf
    sides = mortar.sides_of(rings)
    most = mortar.JOINT_GAP * size[: len(bodies)].max()
    pairs = mortar.facing(sides, -most, most)
    one, other = sides["of"][pairs["one"]], sides["of"][pairs["other"]]
    is_joint = (one <= other) & (np.abs(pairs["gap"]) <= mortar.JOINT_GAP * np.minimum(size[one], size[other]))
    is_joint &= one < len(bodies)
    faces = zip(one[is_joint], other[is_joint], pairs[["start", "end"]][is_joint].tolist(), strict=True)
    return [DrawnJoint((names[i], names[j]), ends) for i, j, ends in faces]


def _kind(
    bodies: Sequence[DrawnBody], ground: Sequence[ArcRing], is_drawn: bool, extra: DrawnAttachments, close: float
) -> str:
    if extra.hinges:
        return "linkage"
    if len(bodies) == 1 and not extra.supports and (not is_drawn or _is_level(bodies[0].ring, ground, close)):
        return "rigid_body"
    return "assembly"


def _is_level(ring: ArcRing, ground: Sequence[ArcRing], close: float) -> bool:
    """Return whether the ground is level under the feet of a body, and nowhere above them."""
    low = float(ring.z.imag.min())
    feet = ring.z[ring.z.imag <= low + close]
    left, right = float(feet.real.min()), float(feet.real.max())
    tops = np.concatenate([each.z for each in ground])
    under = tops[(tops.real > left - close) & (tops.real < right + close) & (tops.imag > low - 10 * close)]
    sides = mortar.sides_of(ground)
    flat = sides[(np.abs(mortar.normals_of(sides) - 1j) < SAME_NORMAL) & (np.abs(sides["a"].imag - low) <= close)]
    x = np.stack([flat["a"], flat["b"]]).real
    lies = (x.min(axis=0) <= left + close) & (x.max(axis=0) >= right - close)
    return bool(lies.any() and (under.imag <= low + close).all())


def _levelled(bodies: Sequence[DrawnBody], frame: DrawingFrame) -> list[ImportNote]:
    """Put corners within the closing distance of the level ground, and ends of a sloping base, onto it, and say so."""
    at, most = list[complex](), 0.0
    for body in bodies:
        z = body.ring.z
        off = np.abs(z.imag) <= frame.close
        side, lowest = following(z) - z, int(z.imag.argmin())
        for k, end in ((lowest, (lowest + 1) % len(z)), (lowest - 1, lowest - 1)) if off[lowest] else ():
            is_base = abs(side[k].imag) <= MAX_SLOPE * abs(side[k].real) and abs(side[k]) > np.ptp(z.real) / 2
            off[end] |= is_base and not body.ring.bulges[k]
        moved = z[off & (np.abs(z.imag) > mortar.NO_GAP)]
        at += map(frame.to_drawing, moved)
        most = max(most, float(np.abs(moved.imag).max(initial=0.0)))
        body.ring = ArcRing(np.where(off, z.real, z), body.ring.bulges)
    words = f"{many(len(at), 'corner')} put onto the level ground, by up to {length_in_words(most)}"
    return [ImportNote("levelled", len(at), words, at)] if at else []


def _check_foot(body: DrawnBody, frame: DrawingFrame) -> None:
    """Raise `DrawingError` "point" if a body stands on an arc, or on another curve."""
    ring, z = body.ring, body.ring.level()
    lowest, least = int(ring.z.imag.argmin()), float(z.imag.min())
    below = least < float(ring.z.imag.min()) - CIRCLE_SHARE * frame.close
    on_arc = below or bool(ring.bulges[lowest] and ring.bulges[lowest - 1])
    foot, flat = (z.real[z.imag <= least + reach] for reach in (frame.close, CIRCLE_SHARE * frame.close))
    on_curve = any(each.is_straightened for each in body.sources) and len(foot) >= CURVED_CORNERS
    if on_arc or (on_curve and np.ptp(flat) < FLAT_SHARE * np.ptp(foot)):
        what = f"{body.name} stands on one point of a curve at <here>: a round foot rolls, without a model"
        raise frame.refusal("point", what, [complex(flat.mean(), 0.0)], "draw the foot on which it stands")


# The fields of each kind of structure


def _corners(z: Points) -> list[list[float]]:
    return [rounded(complex(each)) for each in z]


def _key(k: int) -> str:
    """Return the name of joint number k, from 0."""
    return LETTERS[k] if k < len(LETTERS) else f"J{k + 1}"


def _slide(body: str, at: complex, along: complex) -> dict[str, Any]:
    return {"slide": body, "at": rounded(at), "along": rounded(along)}


def _without_body(given: Any) -> Any:
    """Return loads or ties of a structure with one body, which they do not name."""
    if isinstance(given, list):
        return [*map(_without_body, given)]
    if isinstance(given, dict):
        return {key: _without_body(value) for key, value in given.items() if key != "body"}
    return given


@dataclass(frozen=True)
class _Draft:
    """What is drawn, from which the fields of a structure file are made."""

    name: str
    bodies: Sequence[DrawnBody]
    ground: Sequence[ArcRing]
    is_drawn: bool
    extra: DrawnAttachments
    options: ImportOptions
    frame: DrawingFrame

    def fields(self, kind: str) -> dict[str, Any]:
        """Return the fields of a kind of structure."""
        fields: dict[str, Any] = {"name": self.name}
        loads, ties, options = self.extra.loads, self.extra.ties, self.options
        if kind == "rigid_body":
            loads, ties = _without_body(loads), _without_body(ties)
        fields |= {"density": options.density[""]} if "" in options.density else {}
        fields |= {"depth": options.depth} if options.depth is not None else {}
        fields |= ({"loads": loads} if loads else {}) | ({"ties": ties} if ties else {})
        return fields | {"rigid_body": self._rigid_body, "assembly": self._assembly, "linkage": self._linkage}[kind]()

    def _rigid_body(self) -> dict[str, Any]:
        if self.extra.supports or self.extra.hinges:
            raise self.frame.refusal("hinge", f"a rigid_body has no hinges and supports: leave out {named('kind')}")
        bodies = self.bodies
        alike = len({body.density for body in bodies}) == 1
        fields = {} if not alike or bodies[0].density is None else {"density": bodies[0].density}
        if len(bodies) == 1 and not bodies[0].openings:
            return fields | {"polygon": _corners(bodies[0].ring.level())}
        parts: list[dict[str, Any]] = []
        for body in bodies:
            own_density = {} if alike or body.density is None else {"density": body.density}
            parts.append({"polygon": _corners(body.ring.level()), **own_density})
        parts += [{"polygon": _corners(hole.level()), "opening": True} for body in bodies for hole in body.openings]
        return fields | {"parts": parts}

    def _shapes(self) -> dict[str, dict[str, Any]]:
        """Return the blocks: polygons, beside exact mass, centroid and inertia where there are arcs or openings."""
        shapes: dict[str, dict[str, Any]] = {}
        for body in self.bodies:
            shape: dict[str, Any] = {"polygon": _corners(body.ring.chords(self.options.tolerance))}
            if not body.is_plain:
                moments = body.moments
                assert body.density is not None and self.options.depth is not None  # see _check_weights
                per_area = body.density * self.options.depth
                shape |= {
                    "mass": float(f"{per_area * moments.area:.{MASS_DIGITS}g}"),
                    "centroid": rounded(moments.centroid, CENTROID_DECIMALS),
                    "inertia": float(f"{per_area * moments.polar:.{MASS_DIGITS}g}"),
                }
            elif body.density is not None and body.density != self.options.density.get(""):
                shape["density"] = body.density
            shapes[body.name] = shape
        return shapes

    def _assembly(self) -> dict[str, Any]:
        chords = [_corners(ring.chords(self.options.tolerance)) for ring in self.ground]
        names = [f"ground {k + 1}" if self.is_drawn else "floor" for k in range(len(chords))]
        ground = {name: {"polygon": corners} for name, corners in zip(names, chords, strict=True)}
        joints = {_key(k): _slide(*each[:3]) for k, each in enumerate(self.extra.supports)}
        return {"blocks": self._shapes(), "ground": ground} | ({"joints": joints} if joints else {})

    def _linkage(self) -> dict[str, Any]:
        if not self.extra.hinges:
            what = f"a linkage needs hinges: draw points on a layer such as HINGES, or leave out {named('kind')}"
            raise self.frame.refusal("hinge", what)
        touching = dict.fromkeys(joint.between for joint in _joints(self.bodies, self.ground))
        sides: dict[str, Any] = {"positive": "mirror", "negative": "mirror"}
        for direction, sign in (("positive", "+"), ("negative", "-")):
            hinges = [each for each in self.extra.hinges if each[2] in ("", sign)]
            if not hinges:
                continue
            joints: dict[str, Any] = {}
            for at, on, _ in sorted(hinges, key=lambda each: (len(each[1]), each[0].imag, each[0].real)):
                held: dict[str, Any] = {"pivot": on[0]} if len(on) == 1 else {"hinge": list(on)}
                joints[_key(len(joints))] = held | {"at": rounded(at)}
            standing = {pair[0] for pair in touching if "ground" in pair}
            pivots = [joint["pivot"] for joint in joints.values() if "pivot" in joint]
            moving = [body for _, on, _ in hinges for body in on if body not in standing]
            if not (leads := pivots + moving):
                what = f"no hinge of the {direction} direction is on the ground: one must be on a single body"
                raise self.frame.refusal("hinge", what)
            for body, at, along, sense in self.extra.supports:
                if sense in ("", sign):
                    joints[_key(len(joints))] = _slide(body, at, along)
            hinged = {frozenset(on) if len(on) == 2 else frozenset([on[0], "ground"]) for _, on, _ in hinges}
            for pair in touching:  # what touches and has no hinge stays together
                if frozenset(pair) not in hinged:
                    joints[f"{pair[0]} on {pair[1]}"] = {"fixed": list(pair)}
            sides[direction] = {"lead": leads[0], "joints": joints}
        return {"bodies": self._shapes()} | sides


def _check_weights(
    kind: str, bodies: Sequence[DrawnBody], options: ImportOptions, frame: DrawingFrame, notes: Sequence[ImportNote]
) -> None:
    """Raise `DrawingError` "density" if some bodies have none, or if blocks with arcs or openings have no mass."""
    what, blamed = "", [body for body in bodies if body.density is None]
    if 0 < len(blamed) < len(bodies):
        what = f"some bodies have a density and some have none: give {named('density')} for all"
    elif kind != "rigid_body" and (blamed or options.depth is None):
        blamed = [body for body in bodies if not body.is_plain][:1]
        for body in blamed:
            missing = [named("density")] * (body.density is None) + [named("depth")] * (options.depth is None)
            what = f"{body.name} at <here> has {'arcs' if body.ring.arcs else 'openings'}, so that its mass and "
            what += f"inertia are computed: give {' and '.join(missing)}"
    if what:
        what = "; ".join([what, *(note.words for note in notes if note.kind == "density")])
        raise frame.refusal("density", what, [body.ring.moments.centroid for body in blamed])


def _checked_by_mechanism(result: Imported, frame: DrawingFrame) -> list[ImportNote]:
    """Return a note if the structure has no rocking model, as one in which several mechanisms start together.

    Of many bodies the joints are checked, but not whether they stand, as the limit analysis takes long.

    Raises
    ------
    DrawingError
        "density", if the depth is missing; "mechanism", if the mechanism refuses the fields for any other reason.
    """
    from pydantic import ValidationError

    joined = {name for joint in result.joints for name in joint.between}
    if len(result.bodies) > MAX_CHECKED and all(body.name in joined for body in result.bodies):
        return []  # commands check it when they read the file, which takes seconds
    mechanism = Registry()[result.kind]
    try:
        if len(result.bodies) > MAX_ANALYSED:
            mechanism.model_validate(dict(result.fields), context={"folder": None, "weights": []})
            return []
        structure = mechanism.from_fields(result.fields)
    except ValidationError as error:
        faults = error.errors(include_url=False)
        words = [": ".join(filter(None, (".".join(map(str, each["loc"])), each["msg"]))) for each in faults[:3]]
        blamed = [
            body.ring.moments.centroid for body in result.bodies
            if len(result.bodies) == 1 or any(body.name in f["loc"] or repr(body.name) in f["msg"] for f in faults)
        ]  # fmt: skip
        if any(fault.get("ctx", {}).get("field") == ("depth",) for fault in faults):
            what = f"a density needs the depth of the structure: give {named('depth')}"
            raise frame.refusal("density", what, blamed) from None
        what = f"{result.kind} cannot take it: {'; '.join(words)}{_nearest_gap(result, joined)}"
        raise frame.refusal("mechanism", what, blamed) from None
    except StructureError as error:  # the analysis of the assembly found no answer
        raise frame.refusal("mechanism", f"{result.kind} cannot take it: {error}") from None
    try:
        for direction in structure.directions:
            structure.uplift(direction)
    except MechanismError as error:
        return [ImportNote("no_model", 1, f"most commands refuse the file as it is: {error}")]
    return []


def _nearest_gap(result: Imported, joined: Collection[str]) -> str:
    """Return a hint on the widest of the gaps beside bodies without a joint; empty if none is narrow enough."""
    if result.kind == "rigid_body":  # which has no joints
        return ""
    apart = [k for k, body in enumerate(result.bodies) if body.name not in joined]
    ground = [ArcRing.of(z, np.zeros(len(z))) for z in result.ground]
    sides = mortar.sides_of([*(body.ring for body in result.bodies), *ground])
    pairs = mortar.facing(sides, 0.0, MAX_MORTAR)
    gaps = pairs["gap"][np.isin(sides["of"][pairs["one"]], apart)]
    if not len(gaps):
        return ""
    widest = ceil(1e4 * float(gaps.max()) - 1e-6) / 10  # tenths of a millimetre
    return f"; faces beside them are up to {widest:.4g} mm apart: give {named('merge_gap')} {widest:.4g}mm"

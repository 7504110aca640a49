"""The drawing of a structure as a DXF file, R2000 in metres, from which `rocking import` makes the structure again."""

from __future__ import annotations

import io
from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from rocking_cli.arrays import Points
from rocking_cli.core import Body
from rocking_cli.core.hung.element import Load, Stretched
from rocking_cli.core.hung.ties import Tie
from rocking_cli.core.kinematics import distance
from rocking_cli.errors import named
from rocking_cli.io.drawings import dxf
from rocking_cli.io.field_problems import unit_at
from rocking_cli.questions.import_drawing.attached import LOAD_FIELDS, TIE_FIELDS
from rocking_cli.questions.import_drawing.rings import ArcRing, PlaneMoments
from rocking_cli.studies.hung import Carried, Strand
from rocking_cli.studies.picture import DrawnPart, Picture
from rocking_cli.text import in_short

METRES, CIRCLED = 6, 33  # $INSUNITS; $PDMODE, a dot in a circle
TEXT_AROUND, TEXT_ABOVE, TEXT_BELOW = 5, 7, 1  # attachment of texts: around a point, or to the right of it
COLOURS = {"BLOCKS": 7, "OPENINGS": 5, "GROUND": 34, "HINGES": 1, "SUPPORTS": 34, "LOADS": 6, "TIES": 4, "NAMES": 3,
           "ASSUMED": 9, "DISPLACED": 8, "THRUST": 30}  # fmt: skip
"""Colours of the layers, by the first word of their names: numbers of AutoCAD."""
TEXT_SHARE, ARROW_SHARE, ANCHOR_SHARE = 0.02, 0.15, 0.02  # sizes of texts, arrows and anchorages over the size
SAME_SHARE = 1e-6  # relative difference of equal numbers; that of equal points, over the size
UNSAID = ("friction", "friction_of", "restitution", "one_sided", "rebound", "crushing", "interlock", "corner_radius",
          "gap", "gravity", "strength", "uncertainty", "unusual")  # fmt: skip
"""Fields of structures that a drawing does not have."""
DRAWN_FIELDS = {*LOAD_FIELDS, *TIE_FIELDS, "yield_stress", "name", "mass", "mass_per_metre", "mass_per_area", "span",
                "force", "force_per_metre", "at", "start", "end", "path", "each"}  # fmt: skip
"""Fields of loads and ties that it has."""


class _Plate(NamedTuple):
    """A uniform plate: edge and openings [m], a point inside, area and moments, and mass per area [kg/m2]."""

    edge: Points
    openings: Sequence[Points]
    inside: complex
    moments: PlaneMoments
    per_area: float = 0.0


def drawn_file(drawing: Picture, ratio: float | None) -> tuple[bytes, str, str]:
    """Return a structure at rest, displaced, and with its hinges, loads and ties as a DXF file.

    Parameters
    ----------
    drawing : Picture
        The drawing of the structure.
    ratio : float or None
        Rotation of the displaced structure over the reference rotation; None for one that is well visible.

    Returns
    -------
    content : bytes
        The file.
    options : str
        The options that its import needs, in words.
    untold : str
        What the file does not tell of the structure, in words; empty if nothing is missing.

    Raises
    ------
    InputError
        If ezdxf is not installed.
    """
    mechanism, weighed = drawing.mechanism, {body.name: body for body in drawing.mechanism.weighed()}
    ezdxf = dxf.ezdxf_module()
    document = ezdxf.new("R2000", units=METRES)
    document.ezdxf_metadata().discard("CREATED_BY_EZDXF")  # with the moment
    drawn = _Drawn(document, abs(drawing.reach[1] - drawing.reach[0]))
    searched = any(mechanism.collapse(side) for side in drawing.directions) or bool(drawing.sketch.lines)
    has_hinges = len(weighed) > 1 and not searched  # they are not the feet of a body, and no search has found them
    links = drawing.links.values() if has_hinges else ()
    still = {part.name for part in drawing.parts if links and all(each[part.name] is None for each in links)}
    plates = [_plates(part, weighed[part.name], drawing) for part in drawing.parts]
    per_area = [plate.per_area for each, _ in plates for plate in each if plate.per_area]
    counts = bool(per_area) and max(per_area) > (1 + SAME_SHARE) * min(per_area)
    counts |= bool(mechanism.attached) or mechanism.total_mass() is not None or mechanism.density is not None
    depth = mechanism.depth or 1.0
    _bodies(drawn, drawing, [each for each, _ in plates], still, depth if counts else None)
    for line in drawing.sketch.ground or drawing.ground:
        drawn.line("GROUND", np.asarray(line, np.complex128))
    _joints(drawn, drawing, "HINGES" if has_hinges else "")
    for load in drawing.loads:
        if drawing.parts[load.part].name not in still:
            _load(drawn, drawing, load)
    for tie in drawing.ties:
        _tie(drawn, drawing, tie)
    for side in drawing.directions:
        turn = side * (drawing.usual[side] if ratio is None else ratio) * drawing.reference[side]
        for outline in (each for part in drawing.placed(turn)[0] for each in part):
            drawn.line(f"DISPLACED_{side.label.upper()}", outline, closed=True)
    for thrust in (np.asarray(each.points) for each in drawing.sketch.lines):
        if np.abs(thrust - thrust[0]).max() > 0:  # in a single block it may be a point
            drawn.line("THRUST", thrust)
    dated = ezdxf.options.write_fixed_meta_data_for_testing
    ezdxf.options.write_fixed_meta_data_for_testing = True  # the same file each time
    try:
        document.write(stream := io.StringIO())
    finally:
        ezdxf.options.write_fixed_meta_data_for_testing = dated
    odd = [part.name for part, (_, fits) in zip(drawing.parts, plates, strict=True) if not fits and not part.assumed]
    untold = _untold(drawing, odd, still)
    needed = [f"{named('kind')} rigid_body"] if len(weighed) == 1 and len(plates[0][0]) > 1 else []
    needed += [f"{named('depth')} {depth!r} m"] if counts else []
    return document.encode(stream.getvalue()), " and ".join(needed), untold


def _untold(drawing: Picture, odd: Sequence[str], still: Collection[str]) -> str:
    """Return what a drawing does not tell of a structure, in words."""
    mechanism = drawing.mechanism
    guides = [each for side in drawing.directions for each in mechanism.contacts(side) or () if each.held == "slide"]
    slides = [each.pieces[1] for each in guides if None not in each.pieces]
    given: list[Load | Tie] = [*(mechanism.loads or []), *(mechanism.ties or [])]
    at_rest = [load.name for load in drawing.loads if drawing.parts[load.part].name in still]
    groups = {
        "": [key for key in UNSAID if key in mechanism.model_fields_set and getattr(mechanism, key) is not None],
        "the outline of ": [part.name for part in drawing.parts if part.assumed],
        "the mass of ": odd,
        "the body that guides ": slides,
        "the load ": at_rest,
        "the tie ": [tie.name for tie in drawing.ties if tie.name and _path(tie) is None],
        "the further data of ": [each.name for each in given if each.model_fields_set - DRAWN_FIELDS],
    }
    lists = {what: [f"`{name}`" for name in dict.fromkeys(names)] for what, names in groups.items() if names}
    return "; ".join(what + in_short(names) for what, names in lists.items())


class _Drawn:
    """Model space of a file, with a layer for each kind of thing."""

    def __init__(self, document: Any, size: float) -> None:
        self.layers, self.space, self.size = document.layers, document.modelspace(), size
        self.ground: list[Points] = []
        self.names: list[str] = []  # of the parts, in their order; those of copies are numbered
        document.header["$PDMODE"], document.header["$PDSIZE"] = CIRCLED, TEXT_SHARE * size

    def on(self, layer: str) -> dict[str, Any]:
        """Return the attributes of a thing on a layer, which is made if it is new."""
        if layer not in self.layers:
            self.layers.add(layer, color=COLOURS[layer.partition("_")[0]])
        return {"layer": layer}

    def line(self, layer: str, points: Points, *, closed: bool = False) -> None:
        """Draw a line; it is closed if it ends where it begins."""
        ends = len(points) > 2 and points[0] == points[-1]
        if layer == "GROUND":
            self.ground.append(points)
        pairs = [(z.real, z.imag) for z in points[: len(points) - ends].tolist()]
        self.space.add_lwpolyline(pairs, close=bool(closed or ends), dxfattribs=self.on(layer))

    def spot(self, layer: str, at: complex) -> None:
        """Draw a point."""
        self.space.add_point((at.real, at.imag), dxfattribs=self.on(layer))

    def text(self, layer: str, text: str, at: complex, side: int) -> None:
        """Write lines of text beside a point."""
        style = {"char_height": TEXT_SHARE * self.size, "insert": (at.real, at.imag), "attachment_point": side}
        self.space.add_mtext(text, dxfattribs=self.on(layer) | style)


def _bodies(
    drawn: _Drawn, drawing: Picture, plates: Sequence[Sequence[_Plate]], still: Collection[str], depth: float | None
) -> None:
    """Draw the plates of the bodies, with names, and densities at a depth if they count.

    Bodies that are always at rest are ground, so that hinges on them are pivots.
    """
    copies = Counter[str]()
    for part, each in zip(drawing.parts, plates, strict=True):
        drawn.names.append(part.name + f" {copies[part.name] + 1}" * (copies[part.name] > 0))
        layer = "ASSUMED" if part.assumed else "GROUND" if part.name in still else "BLOCKS"
        for k, plate in enumerate(each):
            drawn.line(layer, plate.edge, closed=True)
            for opening in plate.openings:
                drawn.line("OPENINGS" if layer == "BLOCKS" else layer, opening, closed=True)
            if layer == "BLOCKS":
                copies[part.name] += 1
                name = f"{part.name} {copies[part.name]}" if k else drawn.names[-1]
                density = "" if depth is None else f"\n{plate.per_area / depth:.9g} kg/m3"
                drawn.text("NAMES", name + density, plate.inside, TEXT_AROUND)


def _joints(drawn: _Drawn, drawing: Picture, hinges: str) -> None:
    """Draw supports, and hinges on a layer; without one they are results."""
    for pin in drawing.pins:
        if not pin.slide:
            drawn.spot(f"{hinges}_{pin.direction.label.upper()}" if hinges else "THRUST", pin.point)
    supports: dict[tuple[complex, complex], list[str]] = {}
    for side in drawing.directions:
        for each in drawing.mechanism.contacts(side) or ():
            if each.held == "slide" and each.pieces[0] is None:
                supports.setdefault((each.points[0], each.normal), []).append(f"_{side.label.upper()}")
    for (at, normal), sides in supports.items():
        for layer in sides if len(sides) < len(drawing.directions) else [""]:
            drawn.line(f"SUPPORTS{layer}", np.array([at, at + ARROW_SHARE * drawn.size * normal]))


def _load(drawn: _Drawn, drawing: Picture, load: Carried) -> None:
    """Draw a mass as a point, and a force as an arrow to its point, with their sizes."""
    if load.friction or not (load.mass or load.force):
        return
    given = next((each for each in drawing.mechanism.loads or [] if each.name == load.name), None)
    words = _in_words(given, LOAD_FIELDS) if given is not None else []
    words += [f"body {drawn.names[load.part]}"] if len(drawn.names) > 1 else []
    if load.force:
        start = load.point - ARROW_SHARE * drawn.size * load.force / abs(load.force)
        drawn.line("LOADS", np.array([start, load.point]))
    else:
        drawn.spot("LOADS", start := load.point)
    size = f"{abs(load.force):.9g} N" if load.force else f"{load.mass:.9g} kg"
    text = ", ".join([f"{load.name} {size}".strip(), *words])
    drawn.text("LOADS", text, start, TEXT_BELOW if load.force else TEXT_ABOVE)


def _tie(drawn: _Drawn, drawing: Picture, tie: Strand) -> None:
    """Draw a tie as a line over its points, with its data; with its force and stiffness if a text cannot hold them."""
    ends = _path(tie)
    if ends is None or not isinstance(tie.thing, Stretched):
        return
    drawn.line("TIES", ends)
    for end, other in ((ends[0], ends[1]), (ends[-1], ends[-2])):
        on_line = any(distance(np.array([end]), line)[0] <= SAME_SHARE * drawn.size for line in drawn.ground)
        if any(end == anchor.point for anchor in tie.ground) and not on_line:
            away = ANCHOR_SHARE * drawn.size * (end - other) / abs(end - other)
            drawn.line("GROUND", np.array([end, end + away * (1 - 0.5j), end + away * (1 + 0.5j)]), closed=True)
    given = next((each for each in drawing.mechanism.ties or [] if each.name == tie.thing.name), None)
    drawn_whole = given is not None and not given.model_fields_set - DRAWN_FIELDS
    if given is not None and (drawn_whole or given.is_steel):  # without its plates a bar yields where they fail
        words = _in_words(given if drawn_whole else given.enlarged(1.0), TIE_FIELDS)
    else:
        force, stiffness = (tie.thing.count * each for each in tie.thing.at_rest)
        words = [f"stiffness {stiffness:.9g} N/m", f"prestress {force:.9g} N"] + [f"only {tie.only}"] * bool(tie.only)
    drawn.text("TIES", (f"{tie.name}: " if tie.name else "") + ", ".join(words), complex(ends[:2].mean()), TEXT_ABOVE)


def _in_words(given: Load | Tie, known: Mapping[str, str]) -> list[str]:
    """Return the fields of a load or a tie that a text may give, as the import reads them."""
    model = type(given)
    names = {key: model.model_fields[key].alias or key for key in model.model_fields if key in given.model_fields_set}
    return [
        f"{name} {getattr(given, key)} {unit_at(model, (name,))}".strip() for key, name in names.items()
        if name in known and name != "body" and getattr(given, key) is not None
    ]  # fmt: skip


def _path(tie: Strand) -> Points | None:
    """Return the points of a tie; None for a bed of springs, and if its points coincide."""
    path = np.array([tie.pieces[0].start.point, *(piece.end.point for piece in tie.pieces)])
    return path if not tie.is_bed and np.abs(path - path[0]).max() > 0 else None


def _plates(part: DrawnPart, body: Body, drawing: Picture) -> tuple[list[_Plate], bool]:
    """Return the plates as which a body is drawn, and whether they have its centroid and its moment of inertia.

    They are what its outlines enclose together or, if the body is not uniform, each outline alone: the masses are then
    those that give the mass, the centroid and the moment of inertia of the body.
    """
    mass = body.mass / sum(each.name == part.name for each in drawing.parts)
    together = _enclosed(part.outlines)
    if not together:
        return [], False
    for plates in (together, [plate for each in part.outlines for plate in _enclosed([each])]):
        moments = [plate.moments for plate in plates]
        size = max(abs(plate.edge - part.centroid).max() for plate in plates)
        area = np.array([each.area for each in moments])
        away = (np.array([each.centroid for each in moments]) - part.centroid) / size
        turning = np.array([each.polar for each in moments]) / size**2 + area * np.abs(away) ** 2
        rows = np.array([area, area * away.real, area * away.imag, turning])
        wanted = np.array([1.0, 0.0, 0.0, body.inertia / (body.mass or 1.0) / size**2])
        share = np.linalg.lstsq(rows, wanted)[0]
        if np.abs(rows @ share - wanted).max() <= SAME_SHARE and share.min() > 0:
            return [each._replace(per_area=k * mass) for each, k in zip(plates, share.tolist(), strict=True)], True
    whole = sum(plate.moments.area for plate in together)
    return [each._replace(per_area=mass / whole) for each in together], False


def _enclosed(outlines: Sequence[Points]) -> list[_Plate]:
    """Return what outlines enclose together."""
    import shapely

    pieces = [shapely.make_valid(shapely.Polygon(np.stack([z.real, z.imag], axis=1))) for z in outlines]
    united = shapely.get_parts(shapely.get_parts(shapely.union_all(pieces)))

    def corners(ring: Any) -> Points:
        z: Points = shapely.get_coordinates(ring) @ np.array([1.0, 1.0j])
        return z

    plates = []
    for each in (piece for piece in united if piece.geom_type == "Polygon"):
        edge, *openings = rings = [corners(ring)[:-1] for ring in (each.exterior, *each.interiors)]
        outer, *inner = (ArcRing.of(ring, np.zeros(len(ring))).moments for ring in rings)
        moments = PlaneMoments.of_sum([outer, *(hole.negative() for hole in inner)])
        plates.append(_Plate(edge, openings, complex(corners(each.representative_point())[0]), moments))
    return plates

"""The drawing of a structure as a DXF file, R2000 in metres, from which `rocking import` makes the structure again."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from rocking_cli.arrays import Points
from rocking_cli.core import Body, polygon
from rocking_cli.core.hung.element import Load, Stretched
from rocking_cli.core.hung.ties import Tie
from rocking_cli.core.kinematics import area_of, distance
from rocking_cli.io.drawings.dxf_groups import library
from rocking_cli.studies.hung import Carried, Strand
from rocking_cli.studies.picture import DrawnPart, Picture

METRES, CIRCLED = 6, 33  # of $INSUNITS; of $PDMODE, a dot in a circle
COLOURS = {"BLOCKS": 7, "OPENINGS": 5, "GROUND": 34, "HINGES": 1, "SUPPORTS": 34, "LOADS": 6, "TIES": 4, "NAMES": 3,
           "ASSUMED": 9, "DISPLACED": 8, "THRUST": 30}  # fmt: skip
"""Colours of the layers, by the first word of their names: numbers of AutoCAD."""
TEXT_SHARE, ARROW_SHARE, ANCHOR_SHARE = 0.02, 0.15, 0.02  # sizes of texts, arrows and anchorages over the size
SAME_SHARE = 1e-6  # share by which a body may differ from a uniform plate of its outline
NAME_HEIGHT, DENSITY_HEIGHT = 0.53, 0.37  # heights of the texts in a body over that of the body
UNSAID = ("friction", "restitution", "one_sided", "rebound", "crushing", "interlock", "corner_radius", "gap", "gravity")
"""Fields of structures that a drawing does not have."""
DRAWN_FIELDS = {"name", "mass", "force", "at", "body", "start", "end", "path", "stiffness", "area", "modulus", "length",
                "prestress"}  # fmt: skip
"""Fields of loads and ties that it has."""


def unsaid(picture: Picture) -> list[str]:
    """Return what a drawing does not tell of a structure, in words."""
    mechanism = picture.mechanism
    fields = [f"`{key}`" for key in UNSAID if key in mechanism.model_fields_set and getattr(mechanism, key) is not None]
    bodies = {body.name: body for body in mechanism.bodies()}
    odd = dict.fromkeys(part.name for part in picture.parts if not _is_plate(part, bodies[part.name]))
    given: list[Load | Tie] = [*(mechanism.loads or []), *(mechanism.ties or [])]
    acts = [f"how `{each.name}` acts" for each in given if each.model_fields_set - DRAWN_FIELDS]
    lost = [f"the tie `{tie.name}`" for tie in picture.ties if tie.name and _path(tie) is None]
    return [*fields, *(f"the mass of `{name}`" for name in odd), *lost, *acts]


def dxf_of(picture: Picture, ratio: float | None) -> bytes:
    """Return a structure at rest, displaced, and with its hinges, loads and ties as a DXF file.

    Parameters
    ----------
    picture : Picture
        The drawing of the structure.
    ratio : float or None
        Rotation of the displaced structure over the reference rotation; None for one that is well visible.

    Raises
    ------
    InputError
        If ezdxf is not installed.
    """
    ezdxf = library()
    document = ezdxf.new("R2000", units=METRES)
    drawn = _Drawn(document, abs(picture.reach[1] - picture.reach[0]))
    _bodies(drawn, picture)
    for line in picture.sketch.ground or picture.ground:
        drawn.line("GROUND", np.asarray(line, np.complex128))
    _hinges(drawn, picture)
    for load in picture.loads:
        _load(drawn, load)
    for tie in picture.ties:
        _tie(drawn, picture, tie)
    for side in picture.directions:
        turn = side * (picture.usual[side] if ratio is None else ratio) * picture.reference[side]
        for outline in (each for part in picture.placed(turn)[0] for each in part):
            drawn.line(f"DISPLACED_{side.label.upper()}", outline, closed=True)
    for thrust in (np.asarray(each.points) for each in picture.sketch.lines):
        if np.abs(thrust - thrust[0]).max() > 0:  # in a single block it may be a point
            drawn.line("THRUST", thrust)
    document.write(stream := io.StringIO())
    content: bytes = document.encode(stream.getvalue())
    return content


class _Drawn:
    """Model space of a file, with a layer for each kind of thing."""

    def __init__(self, document: Any, size: float) -> None:
        self.layers, self.space, self.size = document.layers, document.modelspace(), size
        self.ground: list[Points] = []
        document.header["$PDMODE"], document.header["$PDSIZE"] = CIRCLED, TEXT_SHARE * size

    def on(self, layer: str) -> dict[str, str]:
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

    def is_on_ground(self, at: complex) -> bool:
        """Return whether a point is on a line of the ground."""
        tolerance = SAME_SHARE * self.size
        return any(distance(np.array([at]), line)[0] <= tolerance for line in self.ground)

    def spot(self, layer: str, at: complex) -> None:
        """Draw a point."""
        self.space.add_point((at.real, at.imag), dxfattribs=self.on(layer))

    def text(self, layer: str, text: str, at: complex) -> None:
        """Write a text whose middle is at a point."""
        from ezdxf.enums import TextEntityAlignment

        drawn = self.space.add_text(text, height=TEXT_SHARE * self.size, dxfattribs=self.on(layer))
        drawn.set_placement((at.real, at.imag), align=TextEntityAlignment.MIDDLE_CENTER)


def _bodies(drawn: _Drawn, picture: Picture) -> None:
    """Draw the outlines and openings of the bodies, with names, and densities where they count.

    Bodies that are always at rest are ground, so that hinges on them are pivots.
    """
    densities = _densities(picture)
    links = picture.links.values() if _has_given_hinges(picture) else ()
    still = {part.name for part in picture.parts if links and all(each[part.name] is None for each in links)}
    copies: dict[str, int] = {}
    for part in picture.parts:
        copies[part.name] = copies.get(part.name, 0) + 1
        layer = "ASSUMED" if part.assumed else "GROUND" if part.name in still else "BLOCKS"
        for edge, openings in _rings(part.outlines):
            drawn.line(layer, edge, closed=True)
            for opening in openings:
                drawn.line("OPENINGS" if layer == "BLOCKS" else layer, opening, closed=True)
            if layer == "BLOCKS":
                count = f" {copies[part.name]}" if copies[part.name] > 1 else ""
                drawn.text("NAMES", f"{part.name}{count}", _within([edge, *openings], NAME_HEIGHT))
                if part.name in densities:
                    at = _within([edge, *openings], DENSITY_HEIGHT)
                    drawn.text("NAMES", f"{densities[part.name]!r} kg/m3", at)


def _has_given_hinges(picture: Picture) -> bool:
    """Return whether hinges are part of a structure: they are not its feet, and no search has found them."""
    mechanism = picture.mechanism
    is_result = picture.sketch.lines or any(mechanism.collapse(side) for side in mechanism.directions)
    return len(mechanism.bodies()) > 1 and not is_result


def _densities(picture: Picture) -> Mapping[str, float]:
    """Return the densities of the bodies [kg/m3], at a depth of 1 m if none is given; empty if they do not count."""
    mechanism = picture.mechanism
    area: dict[str, float] = {}
    for part in picture.parts:
        area[part.name] = area.get(part.name, 0.0) + sum(abs(area_of(each)) for each in part.outlines)
    per_area = {body.name: body.mass / area[body.name] for body in mechanism.weighed() if area.get(body.name)}
    differ = per_area and max(per_area.values()) > (1 + SAME_SHARE) * min(per_area.values())
    weighs = mechanism.total_mass() is not None or mechanism.density is not None or mechanism.attached
    if not (differ or weighs):
        return {}
    return {name: float(f"{each / (mechanism.depth or 1.0):.9g}") for name, each in per_area.items()}


def _hinges(drawn: _Drawn, picture: Picture) -> None:
    """Draw hinges and supports; hinges that are not given are results."""
    given = _has_given_hinges(picture)
    supports: dict[tuple[complex, complex], list[str]] = {}
    for pin in picture.pins:
        if pin.slide:
            supports.setdefault((pin.point, pin.slide), []).append(f"_{pin.direction.label.upper()}")
        else:
            drawn.spot(f"HINGES_{pin.direction.label.upper()}" if given else "THRUST", pin.point)
    for (at, slide), sides in supports.items():
        across = ARROW_SHARE * drawn.size * 1j * slide / abs(slide)
        for side in sides if len(sides) < len(picture.directions) else [""]:
            drawn.line(f"SUPPORTS{side}", np.array([at, at + across]))


def _load(drawn: _Drawn, load: Carried) -> None:
    """Draw a mass as a point, and a force as an arrow to its point, with their sizes."""
    if load.mass is not None:
        drawn.spot("LOADS", load.point)
        drawn.text("LOADS", f"{load.name} {load.mass!r} kg".strip(), load.point)
    elif load.force:
        start = load.point - ARROW_SHARE * drawn.size * load.force / abs(load.force)
        drawn.line("LOADS", np.array([start, load.point]))
        drawn.text("LOADS", f"{load.name} {abs(load.force)!r} N".strip(), start)


def _tie(drawn: _Drawn, picture: Picture, tie: Strand) -> None:
    """Draw a tie as a line over its points, with area and modulus, or with its stiffness."""
    ends = _path(tie)
    if ends is None or not isinstance(tie.thing, Stretched):
        return
    drawn.line("TIES", ends)
    for end, other in ((ends[0], ends[1]), (ends[-1], ends[-2])):
        if any(end == anchor.point for anchor in tie.ground) and not drawn.is_on_ground(complex(end)):
            away = ANCHOR_SHARE * drawn.size * (end - other) / abs(end - other)
            drawn.line("GROUND", np.array([end, end + away * (1 - 0.5j), end + away * (1 + 0.5j)]), closed=True)
    given = next((each for each in picture.mechanism.ties or [] if each.name == tie.name), None)
    force, stiffness = tie.thing.at_rest
    fields = {"stiffness": f"{tie.thing.count * stiffness!r} N/m"}
    if given is not None and given.area is not None and given.modulus is not None:
        fields = {"area": f"{given.area!r} m2", "modulus": f"{given.modulus!r} Pa"}
        fields |= {"length": f"{given.length!r} m"} if given.length is not None else {}
    fields |= {"prestress": f"{tie.thing.count * force!r} N"} if force else {}
    words = ", ".join(f"{key} {value}" for key, value in fields.items())
    drawn.text("TIES", f"{tie.name}: {words}" if tie.name else words, complex(ends[:2].mean()))


def _path(tie: Strand) -> Points | None:
    """Return the points of a tie; None for a bed of springs, and if its points coincide."""
    path = np.array([tie.pieces[0].start.point, *(piece.end.point for piece in tie.pieces)])
    return path if not tie.is_bed and np.abs(path - path[0]).max() > 0 else None


def _is_plate(part: DrawnPart, body: Body) -> bool:
    """Return whether a body is a uniform plate of one outline, as which it is imported."""
    if part.assumed or len(_rings(part.outlines)) != 1:
        return False
    plates = [polygon(body.name, abs(area_of(each)), each.tolist()) for each in part.outlines]
    mass = sum(plate.mass for plate in plates)
    centroid = sum(plate.mass * plate.centroid for plate in plates) / mass
    inertia = sum(plate.inertia + plate.mass * abs(plate.centroid - centroid) ** 2 for plate in plates)
    size = max(abs(each - centroid).max() for each in part.outlines)
    turned = body.inertia / (body.mass or 1.0) - inertia / mass
    return bool(abs(centroid - part.centroid) <= SAME_SHARE * size and abs(turned) <= SAME_SHARE * size**2)


def _rings(outlines: Sequence[Points]) -> list[tuple[Points, list[Points]]]:
    """Return what outlines enclose together: edges, each with its openings."""
    import shapely

    pieces = [shapely.make_valid(shapely.Polygon(np.stack([z.real, z.imag], axis=1))) for z in outlines]
    united = shapely.get_parts(shapely.get_parts(shapely.union_all(pieces)))

    def corners(ring: Any) -> Points:
        z: Points = shapely.get_coordinates(ring)[:-1] @ np.array([1.0, 1.0j])
        return z

    polygons = [each for each in united if each.geom_type == "Polygon"]
    return [(corners(each.exterior), [corners(hole) for hole in each.interiors]) for each in polygons]


def _within(rings: Sequence[Points], share: float) -> complex:
    """Return a point inside an outline but not in its openings, at a share of its height."""
    low, high = (end(ring.imag.min() if end is min else ring.imag.max() for ring in rings) for end in (min, max))
    y = low + share * (high - low)
    crossings = []
    for ring in rings:
        other = np.roll(ring, -1)
        cut = (ring.imag > y) != (other.imag > y)
        one, along = ring[cut], (other - ring)[cut]
        crossings += (one.real + along.real * (y - one.imag) / along.imag).tolist()
    crossings.sort()
    left, right = max(zip(crossings[::2], crossings[1::2], strict=True), key=lambda ends: ends[1] - ends[0])
    return complex((left + right) / 2, y)

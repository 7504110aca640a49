"""What is attached to the bodies of a drawing: hinges, supports, loads and ties, as fields of a structure."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from pydantic import ValidationError

from rocking_cli.arrays import Reals
from rocking_cli.core.hung.ties import Tie
from rocking_cli.io.drawings.contract import DrawnLine, DrawnText, LineDrawing
from rocking_cli.io.field_problems import of_arguments
from rocking_cli.io.yaml_file import in_a_line
from rocking_cli.questions.import_drawing.legend import DrawingFrame, ImportNote, Role, many, plain
from rocking_cli.questions.import_drawing.outlines import DrawnBody, Sorted
from rocking_cli.questions.import_drawing.rings import ArcRing, polygons_of
from rocking_cli.text import in_short, seen
from rocking_cli.units import UnitError, read

NUMBER = r"(?i:[-+]?\d[\d.]*(?:e[-+]?\d+)?)"
QUANTITY, SHARE = rf"{NUMBER}\s*[a-z][^\s,;]*", rf"{NUMBER}(?=\s*(?:[,;]|$))"
TIE_FIELDS = {
    "area": QUANTITY, "modulus": QUANTITY, "stiffness": QUANTITY, "prestress": QUANTITY, "length": QUANTITY,
    "yield": QUANTITY, "diameter": QUANTITY, "spacing": QUANTITY, "bars": r"\d+", "steel": r"\w*\d\w*",
    "only": "tension|compression",
}  # fmt: skip
LOAD_FIELDS = {
    "floor": "borne|sliding|dragged", "seat": QUANTITY, "horizontal": SHARE, "vertical": SHARE, "weight": SHARE,
    "body": "[^,;]+",
}  # fmt: skip
"""Fields of ties and loads that texts may give, with the patterns of their values."""
BARS = re.compile(r"(?:(\d+)\s*)?[\u00d8\u00f8\u2300\u03c6\u03a6]\s*(\d+)(?:\s*mm)?")  # 2\u00d816
STEEL = re.compile(r"(?<!steel )(?<!steel)\b(S\d{3}|Fe\s?\d{3})\b")
DECIMALS = 7  # of coordinates in a file [m]


def rounded(z: complex, decimals: int = DECIMALS) -> list[float]:
    """Return a point as it stands in a file, to a tenth of a micrometre."""
    return [round(z.real, decimals) + 0.0, round(z.imag, decimals) + 0.0]


@dataclass
class DrawnAttachments:
    """Fields of the structure file, joints by direction, and comments on what the drawing does not tell."""

    loads: list[dict[str, Any]] = field(default_factory=list)
    ties: list[dict[str, Any]] = field(default_factory=list)
    supports: list[tuple[str, complex, complex, str]] = field(default_factory=list)
    hinges: list[tuple[complex, tuple[str, ...], str]] = field(default_factory=list)
    comments: list[str] = field(default_factory=list)
    notes: list[ImportNote] = field(default_factory=list)


class BodyFinder:
    """Which bodies, or the ground, are at a point of the drawing."""

    def __init__(self, bodies: Sequence[DrawnBody], ground: Sequence[ArcRing], frame: DrawingFrame) -> None:
        import shapely

        self.names = [body.name for body in bodies]
        self.solid = polygons_of([body.ring for body in bodies], frame.close)
        self.edges = shapely.get_exterior_ring(self.solid)
        self.ground = polygons_of(ground, frame.close)
        self.frame, self.close = frame, frame.close

    def at(self, z: complex) -> complex:
        """Return a point of the drawing in metres, from the origin of the file."""
        return complex(self.frame.to_metres(np.array([z]))[0])

    def away(self, shapes: Any, z: complex) -> Reals:
        """Return the distance of each of `shapes` from a point [m]."""
        import shapely

        distances: Reals = shapely.distance(shapes, shapely.points(z.real, z.imag))
        return distances

    def bodies(self, z: complex) -> list[str]:
        """Return the bodies whose material or edge is at a point [m], the nearest first."""
        away = self.away(self.solid, z)
        return [self.names[k] for k in np.argsort(away, kind="stable").tolist() if away[k] <= self.close]

    def require(self, holds: object, kind: str, what: str, z: complex) -> None:
        """Raise `DrawingError` on something at a point of the drawing if a condition does not hold."""
        if not holds:
            raise self.frame.refusal(kind, f"{what} at <here>", [self.at(z)])

    def straight(self, chain: DrawnLine, kind: str, name: str) -> tuple[complex, complex]:
        """Return both ends of a line of two points. Raises `DrawingError` for other lines."""
        is_straight = len(chain.points) == len(set(chain.points.tolist())) == 2 and not chain.closed
        self.require(is_straight, kind, f"{name} must be one straight line: another shape is", complex(chain.points[0]))
        return complex(chain.points[0]), complex(chain.points[-1])


def attached(drawing: LineDrawing, of: Sorted, places: BodyFinder) -> DrawnAttachments:
    """Return what is attached to the bodies. Raises `DrawingError` "hinge", "support", "load" or "tie"."""
    made = DrawnAttachments()
    _hinges(drawing, of, places, made)
    _supports(of, places, made)
    _loads(drawing, of, places, made)
    _ties(of, places, made)
    for role in (Role.SUPPORTS, Role.TIES):
        for at, layer in _spots(drawing, of, role):
            words = f"left out: a point or closed line on {seen(layer)}, as {role} are open lines"
            made.notes.append(ImportNote("left out", 1, words, [at]))
    counts = {"hinge": len(made.hinges), "support": len(made.supports), "load": len(made.loads), "tie": len(made.ties)}
    if named := [many(count, name) for name, count in counts.items() if count]:
        made.notes.append(ImportNote("attached", sum(counts.values()), f"drawn: {', '.join(named)}"))
    return made


def direction_of(layer: str) -> str:
    """Return the direction that the end of the name of a layer says, + or -; empty for both."""
    name = plain(layer).rstrip()
    match = re.search(r"([+-])$|(positiv[eao])$|negativ[eao]$", name)
    return "" if match is None else match[1] or ("+" if match[2] else "-")


def _spots(drawing: LineDrawing, of: Sorted, role: Role) -> list[tuple[complex, str]]:
    """Return the points of a role, and the centres of its circles, with their layers."""
    spots = [(spot.at, spot.layer) for spot in drawing.spots if of.roles(spot.layer) is role]
    spots += [(complex(each.points.mean()), each.layer) for each in of.chains[role] if each.closed]
    return spots


def _hinges(drawing: LineDrawing, of: Sorted, places: BodyFinder, made: DrawnAttachments) -> None:
    for at, layer in _spots(drawing, of, Role.HINGES):
        z = places.at(at)
        on = [places.names[k] for k in np.flatnonzero(places.away(places.edges, z) <= places.close).tolist()]
        places.require(on, "hinge", "the hinge is on no edge of a body", at)
        places.require(len(on) <= 2, "hinge", "the hinge is on more than two bodies", at)
        made.hinges.append((z, tuple(on), direction_of(layer)))
    for chain in of.chains[Role.HINGES]:
        what = "draw a hinge as a point or a circle: a line is"
        places.require(chain.closed, "hinge", what, complex(chain.points[0]))


def _supports(of: Sorted, places: BodyFinder, made: DrawnAttachments) -> None:
    for chain in of.chains[Role.SUPPORTS]:
        ends = places.straight(chain, "support", "a support")
        z = [places.at(end) for end in ends]
        held = [(on[0], end) for end in z if (on := places.bodies(end))]
        nearest = min(ends, key=lambda end: float(places.away(places.solid, places.at(end)).min()))
        places.require(held, "support", "the support ends on no body: its nearer end is", nearest)
        normal = 1j * (z[1] - z[0]) / abs(z[1] - z[0])
        normal *= 1 if (normal.imag, normal.real) > (0, 0) else -1
        made.supports += [(name, end, normal, direction_of(chain.layer)) for name, end in held]


def _fields_in(text: str, known: Mapping[str, str]) -> tuple[dict[str, Any], list[str]]:
    """Return the known fields that a text such as `chain: area 452 mm2, modulus 210 GPa` gives, and what else it says.

    Parameters
    ----------
    text : str
        The text.
    known : mapping of str to str
        Pattern of the value of each field.
    """
    pieces = (rf"\b{key}\s*[:=]?\s*(?P<{key}>{value})(?!\w)" for key, value in known.items())
    pattern = re.compile("|".join(pieces), re.IGNORECASE)
    texts = {key: value.strip() for each in pattern.finditer(text) for key, value in each.groupdict().items() if value}
    fields = {
        key: int(value) if value.isdigit() else float(value) if re.fullmatch(NUMBER, value) else value
        for key, value in texts.items()
    }
    return fields, [other for each in re.split("[,;:]", pattern.sub(";", text)) if (other := each.strip(" ="))]


def _quantity(text: str) -> tuple[str, str, str]:
    """Return the words before the last quantity of a text, this quantity, and its kind: mass, force or ""."""
    quantity = match[0] if (match := re.search(rf"{NUMBER}\s*[a-zA-Z]+$", text)) else ""
    for kind, unit in (("mass", "kg"), ("force", "N")):
        try:
            read(quantity, unit)
        except UnitError:
            continue
        return text.removesuffix(quantity).strip(" :=,;"), quantity, kind
    return text, "", ""


def _nearest_texts(
    labels: Sequence[DrawnText], lines: Sequence[tuple[complex, complex]], made: DrawnAttachments
) -> dict[int, DrawnText]:
    """Return the text of each symbol: each text is of the nearest one, or of another at the same place.

    Symbols are points, or lines with two ends. Texts for which none is left are noted.
    """
    text_of: dict[int, DrawnText] = {}
    away = [np.array([_distance(label.at, *line) for line in lines]) for label in labels]
    for reach, label in sorted(zip(away, labels, strict=True), key=lambda each: float(each[0].min(initial=np.inf))):
        closest = np.flatnonzero(np.isclose(reach, reach.min(initial=np.inf)))
        free = next((k for k in closest.tolist() if k not in text_of), None)
        if free is not None:
            text_of[free] = label
        else:
            words = f"the text {seen(label.text)!r} on {seen(label.layer)} has no symbol of its own: it is left out"
            made.notes.append(ImportNote("texts", 1, words, [label.at]))
    return text_of


def _distance(z: complex, start: complex, end: complex) -> float:
    along = end - start
    share = min(max(((z - start) * along.conjugate()).real / abs(along) ** 2, 0.0), 1.0) if along else 0.0
    return abs(z - start - share * along)


def _loads(drawing: LineDrawing, of: Sorted, places: BodyFinder, made: DrawnAttachments) -> None:
    points = [at for at, _ in _spots(drawing, of, Role.LOADS)]
    arrows = [chain for chain in of.chains[Role.LOADS] if not chain.closed]
    symbols = [(at, at) for at in points]
    symbols += [places.straight(chain, "load", "an arrow of a load") for chain in arrows]
    texts = _nearest_texts([label for label in of.labels if of.roles(label.layer) is Role.LOADS], symbols, made)
    for k, (start, end) in enumerate(symbols):
        places.require(k in texts, "load", "a load has no text, such as 3 t or 12 kN, beside it", end)
        text = seen(texts[k].text)
        fields, others = _fields_in(text, LOAD_FIELDS)
        name, quantity, kind = _quantity(", ".join(others))
        places.require(kind, "load", f"the text {text!r} of a load is neither a mass nor a force", end)
        is_point = k < len(points)
        what = f"{quantity} at a point: is it the weight of a mass (write its mass) or a force (draw an arrow)? It is"
        places.require(not is_point or kind == "mass", "load", what, end)
        what = f"{quantity} is a mass: draw it as a point, not as an arrow"
        places.require(is_point or kind == "force", "load", what, end)
        tip, tail = places.at(end), places.at(start)
        at, on = next(((z, on) for z in (tip, tail) if (on := places.bodies(z))), (tip, []))
        on = [fields.pop("body")] if "body" in fields else on
        places.require(on, "load", "a load is on no body", end)
        places.require(on[0] in places.names, "load", f"no body has the name {on[0]!r} that a load states", end)
        load: dict[str, Any] = {"name": name or f"load {k + 1}"}
        if kind == "mass":
            load["mass"] = quantity
        else:
            way = (tip - tail) / abs(tip - tail) * read(quantity, "N")
            load["force"] = [round(way.real, 6) + 0.0, round(way.imag, 6) + 0.0]
        made.loads.append(load | {"at": rounded(at), "body": on[0]} | fields)


def _ties(of: Sorted, places: BodyFinder, made: DrawnAttachments) -> None:
    chains = [chain for chain in of.chains[Role.TIES] if not chain.closed]
    labels = [label for label in of.labels if of.roles(label.layer) is Role.TIES]
    texts = _nearest_texts(labels, [(complex(each.points[0]), complex(each.points[-1])) for each in chains], made)
    for k, chain in enumerate(chains):
        ends = [_end_of_tie(complex(z), places) for z in chain.points]
        text = seen(texts[k].text) if k in texts else ""
        # Bars and steel in words: `2\u00d816 S235` is `bars 2, diameter 16 mm, steel S235`.
        in_words = BARS.sub(lambda bars: f"bars {bars[1] or 1}, diameter {bars[2]} mm, ", text)
        fields, others = _fields_in(STEEL.sub(r", steel \1", in_words), TIE_FIELDS)
        name, *unread = others or [""]
        tie: dict[str, Any] = {"name": name or f"tie {k + 1}"}
        tie |= {"from": ends[0], "to": ends[1]} if len(ends) == 2 else {"path": ends}
        at = complex(chain.points[0])
        if unread:
            words = f"of the text {text!r} of the tie {tie['name']}, {in_short(unread)} was not understood"
            made.notes.append(ImportNote("tie", 1, words, [at]))
        if fault := _fault_of(tie | fields, bool(fields)):
            made.comments.append(f"ties: {in_a_line([tie | fields])}")
            made.notes.append(ImportNote("tie", 1, f"the tie {tie['name']} {fault}: it is a comment in the file", [at]))
        else:
            made.ties.append(tie | fields)


def _fault_of(tie: dict[str, Any], described: bool) -> str:
    """Return why a tie cannot act, in words after its name; empty if it can."""
    if not described:
        return "has no text with data, such as `area 452 mm2, modulus 210 GPa`"
    ends = {end.get("body") for end in tie.get("path", [tie.get("from"), tie.get("to")])}
    if len(ends) == 1:
        return f"has all its points on {ends.pop() or 'the ground'}, so that nothing stretches it"
    try:
        Tie.model_validate(tie)
    except ValidationError as error:
        problem = of_arguments(Tie, error.errors(include_url=False), "tie")[0]
        return f"lacks data ({str(problem).partition(chr(10))[0]})"
    return ""


def _end_of_tie(at: complex, places: BodyFinder) -> dict[str, Any]:
    z = places.at(at)
    if on := places.bodies(z):
        return {"body": on[0], "at": rounded(z)}
    is_ground = (places.away(places.ground, z) <= places.close).any()
    places.require(is_ground, "tie", "a tie ends on no body and not on the ground", at)
    return {"ground": rounded(z)}

"""What is attached to the bodies of a drawing: hinges, supports, loads and ties, as fields of a structure."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rocking_cli.io.drawings.contract import DrawingError, DrawnText, LineDrawing
from rocking_cli.io.yaml_file import in_a_line
from rocking_cli.questions.import_drawing.notes import DrawingFrame, ImportNote, many
from rocking_cli.questions.import_drawing.outlines import DrawnBody, Sorted, polygons_of
from rocking_cli.questions.import_drawing.rings import ArcRing
from rocking_cli.questions.import_drawing.roles import Role, plain
from rocking_cli.text import seen
from rocking_cli.units import UnitError, read, split

TIE_FIELDS = ("area", "modulus", "stiffness", "prestress", "length", "yield", "diameter")
DECIMALS = 7  # of coordinates in a file [m]


def rounded(z: complex) -> list[float]:
    """Return a point as it stands in a file, to a tenth of a micrometre."""
    return [round(z.real, DECIMALS) + 0.0, round(z.imag, DECIMALS) + 0.0]


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

    def __init__(
        self,
        bodies: Sequence[DrawnBody],
        ground: Sequence[ArcRing],
        frame: DrawingFrame,
        shift: complex,
        close: float,
        file: str,
    ) -> None:
        import shapely

        self.names = [body.name for body in bodies]
        self.solid = polygons_of([body.ring for body in bodies], close)
        self.ground = polygons_of(ground, close)
        self.frame, self.shift, self.close, self.file = frame, shift, close, file
        self._points = shapely.points

    def at(self, z: complex) -> complex:
        """Return a point of the drawing in metres, from the origin of the file."""
        return complex(self.frame.to_metres(np.array([z]))[0] + self.shift)

    def bodies(self, z: complex) -> list[str]:
        """Return the bodies whose material or edge is at a point [m], the nearest first."""
        away = {
            name: each.distance(self._points(z.real, z.imag)) for name, each in zip(self.names, self.solid, strict=True)
        }
        return sorted((name for name in away if away[name] <= self.close), key=away.__getitem__)

    def on_edges(self, z: complex) -> list[str]:
        """Return the bodies on whose edge a point is [m]."""
        point = self._points(z.real, z.imag)
        return [
            name
            for name, each in zip(self.names, self.solid, strict=True)
            if each.exterior.distance(point) <= self.close
        ]

    def is_ground(self, z: complex) -> bool:
        """Return whether a point is in or on the ground."""
        return any(each.distance(self._points(z.real, z.imag)) <= self.close for each in self.ground)

    def refused(self, kind: str, what: str, z: complex) -> DrawingError:
        """Return the error of something at a point of the drawing."""
        return DrawingError(kind, f"{what} at ({z.real:.7g}, {z.imag:.7g})", self.file, at=[[z.real, z.imag]])


def attached(drawing: LineDrawing, of: Sorted, places: BodyFinder) -> DrawnAttachments:
    """Return what is attached to the bodies. Raises `DrawingError` "hinge", "support", "load" or "tie"."""
    made = DrawnAttachments()
    _hinges(drawing, of, places, made)
    _supports(of, places, made)
    _loads(drawing, of, places, made)
    _ties(of, places, made)
    counts = {"hinge": len(made.hinges), "support": len(made.supports), "load": len(made.loads), "tie": len(made.ties)}
    if named := [many(count, name) for name, count in counts.items() if count]:
        made.notes.append(ImportNote("attached", sum(counts.values()), f"it has {', '.join(named)}"))
    return made


def direction_of(layer: str) -> str:
    """Return the direction that the end of the name of a layer says, + or -; empty for both."""
    name = plain(layer).rstrip()
    for sign, words in (
        ("+", ("+", "positive", "positiva", "positivo")),
        ("-", ("-", "negative", "negativa", "negativo")),
    ):
        if name.endswith(words):
            return sign
    return ""


def _spots(drawing: LineDrawing, of: Sorted, role: Role) -> list[tuple[complex, str]]:
    """Return the points of a role, and the centres of its circles, with their layers."""
    spots = [(spot.at, spot.layer) for spot in drawing.spots if of.roles(spot.layer) is role]
    spots += [(complex(each.points.mean()), each.layer) for each in of.chains[role] if each.closed]
    return spots


def _hinges(drawing: LineDrawing, of: Sorted, places: BodyFinder, made: DrawnAttachments) -> None:
    for at, layer in _spots(drawing, of, Role.HINGES):
        z = places.at(at)
        on = places.on_edges(z)
        if not 1 <= len(on) <= 2:
            what = "the hinge is on no edge of a body" if not on else "the hinge is on more than two bodies"
            raise places.refused("hinge", what, at)
        made.hinges.append((z, tuple(on), direction_of(layer)))
    for chain in of.chains[Role.HINGES]:
        if not chain.closed:
            raise places.refused(
                "hinge", "a line is no hinge: draw a point or a circle. It is", complex(chain.points[0])
            )


def _supports(of: Sorted, places: BodyFinder, made: DrawnAttachments) -> None:
    for chain in of.chains[Role.SUPPORTS]:
        if chain.closed or len(chain.points) != 2:
            raise places.refused(
                "support", "a support is one straight line; something else is", complex(chain.points[0])
            )
        z = [places.at(complex(each)) for each in chain.points]
        along = (z[1] - z[0]) / abs(z[1] - z[0])
        held = [(on[0], end) for end in z if (on := places.bodies(end))]
        if not held:
            raise places.refused("support", "the support ends on no body", complex(chain.points[0]))
        normal = 1j * along
        normal *= 1 if (normal.imag, normal.real) > (0, 0) else -1
        made.supports += [(name, end, normal, direction_of(chain.layer)) for name, end in held]


def _quantity(text: str) -> tuple[str, str, str]:
    """Return the words before the last quantity of a text, this quantity, and its kind: mass, force or ""."""
    match = re.search(r"[-+]?[0-9][0-9.]*(?:[eE][-+]?[0-9]+)?\s*[a-zA-Z]+\s*$", text.strip())
    if match is None:
        return text.strip(), "", ""
    quantity = match[0].strip()
    parts = split(quantity)
    for kind, unit in (("mass", "kg"), ("force", "N")):
        try:
            if parts is not None:
                read(quantity, unit)
                return text.strip()[: match.start()].strip(" :=,;"), quantity, kind
        except UnitError:
            continue
    return text.strip(), "", ""


def _nearest_texts(labels: Sequence[DrawnText], lines: Sequence[tuple[complex, complex]]) -> dict[int, DrawnText]:
    """Return the text of each symbol: each text is of the nearest one. Symbols are points, or lines with two ends."""
    text_of: dict[int, tuple[float, DrawnText]] = {}
    for label in labels:
        away = [_distance(label.at, *line) for line in lines]
        if not away:
            break
        k = int(np.argmin(away))
        if k not in text_of or away[k] < text_of[k][0]:
            text_of[k] = away[k], label
    return {k: label for k, (_, label) in text_of.items()}


def _distance(z: complex, start: complex, end: complex) -> float:
    along = end - start
    share = min(max(((z - start) * along.conjugate()).real / abs(along) ** 2, 0.0), 1.0) if along else 0.0
    return abs(z - start - share * along)


def _loads(drawing: LineDrawing, of: Sorted, places: BodyFinder, made: DrawnAttachments) -> None:
    points = [at for at, _ in _spots(drawing, of, Role.LOADS)]
    arrows = [chain for chain in of.chains[Role.LOADS] if not chain.closed]
    for chain in arrows:
        if len(chain.points) != 2:
            raise places.refused(
                "load", "an arrow of a load is one straight line; something else is", complex(chain.points[0])
            )
    ends = [(complex(each.points[0]), complex(each.points[1])) for each in arrows]
    symbols = [*((at, at) for at in points), *ends]
    labels = [label for label in of.labels if of.roles(label.layer) is Role.LOADS]
    texts = _nearest_texts(labels, symbols)
    for k, (start, end) in enumerate(symbols):
        if k not in texts:
            raise places.refused("load", "a load has no text, such as 3 t or 12 kN, beside it", end)
        name, quantity, kind = _quantity(seen(texts[k].text))
        is_point = k < len(points)
        if not kind:
            raise places.refused(
                "load", f"the text {seen(texts[k].text)!r} of a load is neither a mass nor a force", end
            )
        if is_point and kind == "force":
            what = (
                f"{quantity} at a point: is it the weight of a mass (write its mass) or a force (draw an arrow)? It is"
            )
            raise places.refused("load", what, end)
        if not is_point and kind == "mass":
            raise places.refused("load", f"{quantity} is a mass: draw it as a point, not as an arrow", end)
        tip, tail = places.at(end), places.at(start)
        at, on = next(((z, on) for z in (tip, tail) if (on := places.bodies(z))), (tip, []))
        if not on:
            raise places.refused("load", "a load is on no body", end)
        load: dict[str, Any] = {"name": name or f"load {k + 1}"}
        if kind == "mass":
            load["mass"] = quantity
        else:
            way = (tip - tail) / abs(tip - tail) * read(quantity, "N")
            load["force"] = [round(way.real, 6) + 0.0, round(way.imag, 6) + 0.0]
        made.loads.append(load | {"at": rounded(at), "body": on[0]})


def _ties(of: Sorted, places: BodyFinder, made: DrawnAttachments) -> None:
    chains = [chain for chain in of.chains[Role.TIES] if not chain.closed]
    labels = [label for label in of.labels if of.roles(label.layer) is Role.TIES]
    texts = _nearest_texts(labels, [(complex(each.points[0]), complex(each.points[-1])) for each in chains])
    for k, chain in enumerate(chains):
        ends = [_end_of_tie(complex(z), places) for z in chain.points]
        name, fields = _tie_fields(seen(texts[k].text)) if k in texts else ("", {})
        tie: dict[str, Any] = {"name": name or f"tie {k + 1}"}
        tie |= {"from": ends[0], "to": ends[1]} if len(ends) == 2 else {"path": ends}
        if fields:
            made.ties.append(tie | fields)
            continue
        made.comments.append(f"ties: {in_a_line([tie])}")
        at = complex(chain.points[0])
        words = (
            f"the tie {tie['name']} has no text such as `area 452 mm2, modulus 210 GPa`: it is a comment in the file"
        )
        made.notes.append(ImportNote("tie", 1, words, [at]))


def _end_of_tie(at: complex, places: BodyFinder) -> dict[str, Any]:
    z = places.at(at)
    if on := places.bodies(z):
        return {"body": on[0], "at": rounded(z)}
    if places.is_ground(z):
        return {"ground": rounded(z)}
    raise places.refused("tie", "a tie ends on no body and not on the ground", at)


def _tie_fields(text: str) -> tuple[str, dict[str, str]]:
    """Return the name and the fields of a tie from a text such as `chain: area 452 mm2, modulus 210 GPa`."""
    fields: dict[str, str] = {}
    for part in re.split(r"[,;]", text):
        for key in TIE_FIELDS:
            if match := re.search(rf"\b{key}\s*[:=]?\s*([-+0-9.]+\s*\S+)\s*$", part.strip(), re.IGNORECASE):
                fields[key] = match[1].strip()
    name = re.split(rf"[:,;]|\b(?:{'|'.join(TIE_FIELDS)})\b", text, maxsplit=1, flags=re.IGNORECASE)[0].strip()
    return name, fields
